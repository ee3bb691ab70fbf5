//! Accumulation of the values of a sample. The result does not depend on the order in which threads finish.

use std::borrow::Cow;

use crate::assembly::{EvaluationError, NonRepeatable, Responses, Run};
use crate::estimate::conditions;
use crate::evaluation::{Ledger, history};
use crate::problem::Problem;
use crate::simulation::characteristic::{Evidence, SimulatedCharacteristic};
use crate::simulation::control_variate::{Control, Twin};
use crate::simulation::count::{Count, CountingScale, Replicate};
use crate::simulation::joint_result as together;
use crate::simulation::joint_result::Together;
use crate::simulation::rare_switch_side::RareSwitchSides;
use crate::simulation::sample_groups::{GroupSums, MeasuredGroups};
use crate::simulation::shard_sums::{CharacteristicSums, ShardError, failure};
use crate::simulation::surface_difference::Difference;
use crate::simulation::{REPLICATES, Simulation, SimulationOptions, TASKS};
use crate::summary::{RunSummary, StopReason};
use crate::warning::Warning;
use sensitol_numeric::sampling::LargestPoints;
use sensitol_numeric::sampling::{Fine, Portion, Sampler, Scale, Summary};
use sensitol_numeric::verdict::Judged;

/// Answers of one portion, counted.
pub(super) struct Block {
    columns: Vec<Column>,
    answered: u64,
    ledger: Ledger,
    together: Option<Together>,
}

/// Answers of one portion for one characteristic.
struct Column {
    summary: Summary,
    largest: LargestPoints,
    outside: [u64; 2],
    difference: Difference,
    groups: GroupSums,
    values: Values,
    failed: u64,
    error: Option<EvaluationError>,
}

/// Raw values until the scale is known, then histogram bins.
enum Values {
    Plain(Vec<f64>),
    Binned(Vec<u32>),
}

impl Block {
    /// Sums of one portion. `beside` has the surrogate of every output and its rises at the same points, if there is one. `groups` has the
    /// measured samples, with the group of every point for each.
    pub(super) fn of(
        out: &Responses,
        ledger: Ledger,
        (lenses, sampler, replicate): (&[CountingScale], Sampler, u64),
        beside: &[Option<(&Twin, Vec<f64>)>],
        groups: Option<&(&MeasuredGroups<'_>, Vec<Vec<usize>>)>,
    ) -> Self {
        let answered = match ledger.stopped() {
            None => out.rows(),
            Some(_) => out.answered().count(),
        };
        Self {
            columns: (lenses.iter().enumerate())
                .map(|(output, lens)| {
                    let column = Column::of(out, output, lens, beside.get(output).and_then(Option::as_ref));
                    let sums = groups.map(|(measured, groups)| GroupSums::of(measured, groups, out, output));
                    Column { groups: sums.unwrap_or_default(), ..column }
                })
                .collect(),
            answered: answered as u64,
            ledger,
            together: Together::of(out, lenses, sampler, replicate),
        }
    }
}

impl Column {
    fn of(out: &Responses, output: usize, lens: &CountingScale, beside: Option<&(&Twin, Vec<f64>)>) -> Self {
        let mut values = Cow::Borrowed(out.column(output));
        if values.iter().fold(false, |any, value| any | value.is_nan()) {
            values.to_mut().retain(|value| !value.is_nan());
        }
        let count = |beyond: &dyn Fn(f64) -> bool| values.iter().filter(|&&value| beyond(value)).count() as u64;
        let mut errors = out.errors().filter(|&(_, of, _)| of == output).map(|(_, _, error)| error);
        let error = errors.next().cloned();
        Self {
            summary: Summary::of(&values),
            largest: LargestPoints::of(&values),
            outside: [0, 1].map(|side| count(&|value| lens.limits.broken(value)[side])),
            difference: beside
                .map_or_else(Difference::default, |(twin, rises)| Difference::of(out.column(output), rises, twin)),
            groups: GroupSums::default(),
            failed: u64::from(error.is_some()) + errors.count() as u64,
            error,
            values: match lens.scale {
                None => Values::Plain(values.into_owned()),
                Some(scale) => Values::Binned(scale.bins(&values)),
            },
        }
    }
}

pub(super) struct Tally<'a> {
    problem: &'a Problem,
    control: Option<&'a Control<'a>>,
    lenses: Vec<CountingScale>,
    counts: Vec<Count>,
    together: Together,
    /// Seldom sides of every characteristic, after the search for them. None if standard errors are not watched.
    seldom: Option<Vec<Option<RareSwitchSides>>>,
    answered: u64,
    /// Cost of the points drawn so far.
    ledger: Ledger,
}

impl<'a> Tally<'a> {
    pub(super) fn new(problem: &'a Problem, control: Option<&'a Control<'a>>, sampler: Sampler) -> Self {
        let replicates = match sampler {
            Sampler::Random => 1,
            Sampler::Sobol => REPLICATES as usize,
        };
        let nothing = Replicate {
            summary: Summary::default(),
            largest: LargestPoints::default(),
            outside: [0, 0],
            difference: Difference::default(),
            fine: None,
        };
        let count = || Count {
            replicates: vec![nothing.clone(); replicates],
            groups: GroupSums::default(),
            failed: 0,
            error: None,
        };
        let characteristics = problem.characteristics();
        let conditions = conditions(problem);
        Self {
            problem,
            control,
            lenses: (0..characteristics.len())
                .map(|c| {
                    let given = conditions.iter().find(|[own, _]| *own == c).map(|[_, given]| *given);
                    CountingScale { limits: problem.kept_limits(c), given, scale: None }
                })
                .collect(),
            counts: characteristics.iter().map(|_| count()).collect(),
            together: Together::default(),
            seldom: None,
            answered: 0,
            ledger: Ledger::default(),
        }
    }

    pub(super) fn lenses(&self) -> &[CountingScale] {
        &self.lenses
    }

    /// True if points of the sample were not evaluated.
    pub(super) fn stopped(&self) -> bool {
        self.ledger.stopped().is_some()
    }

    pub(super) fn samples(&self) -> u64 {
        self.answered
    }

    /// Adds the blocks of these portions in their order. The result is the same for any division into batches.
    pub(super) fn add(&mut self, portions: &[Portion], blocks: Vec<Block>) {
        let mut blocks = blocks.into_iter();
        for portions in portions.chunks(TASKS) {
            self.add_stage(portions, blocks.by_ref().take(portions.len()).collect());
        }
    }

    fn add_stage(&mut self, portions: &[Portion], blocks: Vec<Block>) {
        if self.lenses.iter().any(|lens| lens.scale.is_none()) {
            self.look(&blocks);
        }
        let mut uncounted: Vec<(usize, usize, Values)> = Vec::with_capacity(portions.len() * self.counts.len());
        let mut parts = Vec::with_capacity(portions.len());
        for (portion, block) in portions.iter().zip(blocks) {
            self.answered += block.answered;
            parts.push(block.ledger);
            block.together.iter().for_each(|parts| self.together.merge(parts));
            for (c, (count, column)) in self.counts.iter_mut().zip(block.columns).enumerate() {
                count.groups.merge(&column.groups);
                count.failed += column.failed;
                count.error = count.error.take().or(column.error);
                let place = portion.replicate as usize;
                let replicate = &mut count.replicates[place];
                replicate.summary.merge(&column.summary);
                replicate.largest.merge(&column.largest);
                replicate.outside[0] += column.outside[0];
                replicate.outside[1] += column.outside[1];
                replicate.difference.merge(&column.difference);
                uncounted.push((c, place, column.values));
            }
        }
        self.ledger.add(Ledger::of_batch(parts));
        // The counts of all replicates exceed a nearby cache: each replicate is counted as a whole before the next.
        uncounted.sort_by_key(|&(c, replicate, _)| (c, replicate));
        for (c, replicate, values) in uncounted {
            let Some(scale) = self.lenses[c].scale else { continue };
            let fine = self.counts[c].replicates[replicate].fine.get_or_insert_with(|| Fine::new(scale));
            match values {
                Values::Plain(values) => fine.count(&scale.bins(&values)),
                Values::Binned(bins) => fine.count(&bins),
            }
        }
    }

    /// Chooses the bins of a characteristic from its first values.
    fn look(&mut self, blocks: &[Block]) {
        for (c, lens) in self.lenses.iter_mut().enumerate().filter(|(_, lens)| lens.scale.is_none()) {
            let mut values: Vec<f64> = Vec::new();
            for block in blocks {
                if let Values::Plain(plain) = &block.columns[c].values {
                    values.extend(plain);
                }
            }
            if !values.is_empty() {
                lens.scale = Some(scale(values));
            }
        }
    }

    /// Chooses the bins of every characteristic from these values.
    pub(super) fn choose_bins(&mut self, values: Vec<Vec<f64>>) {
        for (lens, values) in self.lenses.iter_mut().zip(values) {
            lens.scale = (!values.is_empty()).then(|| scale(values));
        }
    }

    /// Sums of all points, for a file: those of every characteristic and of all together, the number of points, and their cost.
    pub(super) fn into_sums(self) -> (Vec<CharacteristicSums>, Together, u64, Ledger) {
        let one = |(c, count): (usize, Count)| CharacteristicSums {
            name: self.problem.characteristics()[c].name().to_owned(),
            summary: count.summary(),
            largest: count.largest(),
            outside: [0, 1].map(|side| count.replicates.iter().map(|of| of.outside[side]).sum()),
            groups: count.groups,
            failed: count.failed,
            error: count.error.map(|error| error.to_string()),
            bins: count.replicates.into_iter().next().and_then(|first| first.fine),
        };
        (self.counts.into_iter().enumerate().map(one).collect(), self.together, self.answered, self.ledger)
    }

    /// Adds the sums of a shard.
    pub(super) fn add_sums(
        &mut self,
        characteristics: &[CharacteristicSums],
        together: &Together,
        answered: u64,
    ) -> Result<(), ShardError> {
        self.answered += answered;
        self.together.merge(together);
        for ((count, lens), sums) in self.counts.iter_mut().zip(&mut self.lenses).zip(characteristics) {
            count.groups.merge(&sums.groups);
            count.failed += sums.failed;
            count.error = count.error.take().or_else(|| sums.error.as_deref().map(failure));
            let replicate = &mut count.replicates[0];
            replicate.summary.merge(&sums.summary);
            replicate.largest.merge(&sums.largest);
            replicate.outside[0] += sums.outside[0];
            replicate.outside[1] += sums.outside[1];
            let Some(bins) = &sums.bins else { continue };
            let scale = *lens.scale.get_or_insert_with(|| bins.scale());
            if scale != bins.scale() {
                return Err(ShardError::NoCommonBins { characteristic: sums.name.clone() });
            }
            replicate.fine.get_or_insert_with(|| Fine::new(scale)).merge(bins);
        }
        Ok(())
    }

    /// Searches for assemblies that the sample hardly contains, once it has values. Standard errors that depend on these or on a few points
    /// are left out from then on.
    pub(super) fn watch(&mut self, seed: u64, run: &Run<'_>) {
        if self.seldom.is_some() || self.answered == 0 || run.stopped() {
            return;
        }
        let seldom = |(c, count): (usize, &Count)| {
            RareSwitchSides::of(self.problem, c, self.control, (seed, count.summary().sigma()), run)
        };
        let found: Vec<Option<RareSwitchSides>> = self.counts.iter().enumerate().map(seldom).collect();
        self.ledger.run.evaluations += found.iter().flatten().map(RareSwitchSides::evaluations).sum::<u64>();
        self.seldom = Some(found);
    }

    fn evidence<'t>(&'t self, c: usize, count: &'t Count) -> Evidence<'t> {
        let evidence = Evidence::of(count, self.twin(c), self.answered);
        match &self.seldom {
            Some(seldom) => evidence.watched(seldom[c].as_ref()),
            None => evidence,
        }
    }

    /// Greatest ratio of an uncertainty to its requested accuracy. Returns None if no accuracy is requested.
    pub(super) fn shortfall(&self, options: &SimulationOptions) -> Option<f64> {
        if options.until.is_none() && options.until_yield.is_none() {
            return None;
        }
        let ratio = |(c, count): (usize, &Count)| {
            let evidence = self.evidence(c, count);
            let sigma = options.until.map(|wanted| {
                let [_, sigma, ..] = evidence.moments();
                let known = sigma.and_then(|sigma| Some((sigma.value, sigma.standard_error?)));
                known.map_or(f64::INFINITY, |(value, error)| if error == 0.0 { 0.0 } else { error / value / wanted })
            });
            let limits = self.problem.characteristics()[c].limits();
            let shares = options.until_yield.filter(|_| limits.exist()).map(|wanted| {
                evidence
                    .yield_of(limits)
                    .map_or(f64::INFINITY, |share| 0.5 * (share.interval[1] - share.interval[0]) / wanted)
            });
            sigma.into_iter().chain(shares).fold(0.0, f64::max)
        };
        Some(self.counts.iter().enumerate().map(ratio).fold(0.0, f64::max))
    }

    fn characteristic(&self, c: usize, count: &Count) -> SimulatedCharacteristic {
        let limited = (&self.problem.characteristics()[c], self.lenses[c].limits);
        SimulatedCharacteristic::of(limited, &self.evidence(c, count))
    }

    /// Surrogate of a characteristic, if there is one.
    fn twin(&self, c: usize) -> Option<&Twin> {
        self.control?.twins.get(c)?.as_ref()
    }

    pub(super) fn finish(
        self,
        options: &SimulationOptions,
        measured: Option<&MeasuredGroups<'_>>,
        stopped: Option<StopReason>,
        reached: Option<bool>,
    ) -> Simulation {
        let of = |(c, count): (usize, &Count)| {
            let found = SimulatedCharacteristic { unfinished: stopped.is_some(), ..self.characteristic(c, count) };
            match measured.and_then(|measured| measured.interval(c, &found, &count.groups)) {
                // Measured values that keep a limit prove nothing about the process: the proof is for other inputs only.
                Some(interval) => found.with_sampling(interval),
                None => found.with_proof(self.problem, c),
            }
        };
        let mut characteristics: Vec<SimulatedCharacteristic> = self.counts.iter().enumerate().map(of).collect();
        together::condition(&self.together, options.sampler, &self.lenses, &mut characteristics);
        let joint = together::joint(&self.together, options.sampler, self.answered)
            .map(|joint| together::with_sampling(joint, &characteristics));
        let joint_requirement = options.target_joint_yield.zip(joint).map(|(target, joint)| {
            let interval = [joint.interval[0].min(joint.bounds[0]), joint.interval[1]];
            Judged::of_yield(target, Some(joint.value), Some(interval)).unless(stopped.is_some())
        });
        let correlations = together::correlations(self.problem, &self.together);
        let surrogate = self.control.map(|control| &control.outcome.evaluated);
        let spent = surrogate.map(|evaluated| evaluated.ledger.run).unwrap_or_default();
        let drawn = RunSummary { seed: Some(options.seed), ..self.ledger.run };
        // Points of the surrogate are evaluated before those of the sample.
        let before = surrogate.iter().flat_map(|evaluated| &evaluated.ledger.non_repeatable).cloned();
        let non_repeatable: Vec<NonRepeatable> = before.chain(self.ledger.non_repeatable).collect();
        let failures =
            characteristics.iter().flat_map(|one| [one.failures(), one.overflow(), one.unsettled()]).flatten();
        let seldom = self.seldom.iter().flatten().zip(&characteristics);
        let switches = seldom.filter_map(|(seldom, one)| Some((seldom.as_ref()?, one)));
        let switches = switches.flat_map(|(seldom, one)| seldom.warnings(one.characteristic.name(), one.samples));
        let warnings: Vec<Warning> = failures.chain(switches).chain(history(self.problem, &non_repeatable)).collect();
        Simulation {
            sampler: options.sampler,
            run: RunSummary { stopped, ..drawn.and(&spent) },
            samples: self.answered,
            surrogate_evaluations: surrogate.map(|_| spent.evaluations),
            reached,
            warnings,
            non_repeatable,
            joint,
            joint_requirement,
            correlations,
            characteristics,
        }
    }
}

/// Scale about the median by the spread of the middle half: a long tail must not make the bins of the bulk coarse.
fn scale(mut values: Vec<f64>) -> Scale {
    values.sort_unstable_by(f64::total_cmp);
    let at = |share: f64| values[((values.len() - 1) as f64 * share) as usize];
    let half = at(0.75) - at(0.25);
    let spread = if half > 0.0 { half } else { Summary::of(&values).sigma() };
    Scale::about(at(0.5), spread)
}
