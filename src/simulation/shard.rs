//! Samples that several processes share: each evaluates a shard, and the sums of all shards give the figures of one run.
//!
//! A shard has its own points of the one sample that the seed defines. The points of all shards together are those of a single run. Counts
//! and bins are whole numbers, which add up exactly. Means and central sums are merged pairwise (Pébay 2008), so that moments differ from
//! those of one run by rounding alone. Few points choose the bins of a costly model, so that its quantiles may differ within a bin.

use crate::assembly::{Points, Responses, Run};
use crate::evaluation::{Evaluator, Restoration, Restore, at_any_size};
use crate::problem::Problem;
use crate::simulation::portions::Portions;
use crate::simulation::sample_groups::MeasuredGroups;
use crate::simulation::shard_sums::{Shard, ShardError, ShardSums, ShardWork};
use crate::simulation::tally::Tally;
use crate::simulation::{MOST, Pace, Sample, Simulation, SimulationError, SimulationOptions, keep_rows};
use crate::summary::RunSummary;
use sensitol_numeric::sampling::{Draws, Room, Sampler, all_known};
use sensitol_numeric::time::Instant;

impl Restore for ShardSums {
    fn restore(&mut self, back: &Restoration<'_>) {
        self.rescaled = !back.is_nothing();
    }
}

impl Restore for ShardError {
    fn restore(&mut self, back: &Restoration<'_>) {
        if let Self::Simulation(error) = self {
            error.restore(back);
        }
    }
}

/// Evaluates one shard of a sample of random points.
///
/// Evaluations: the points of the shard, about `samples/count`, and those that choose the bins of its histograms: the first 65 536 points of
/// the sample, of an external model the first 64. Memory: as [`simulate`](crate::simulation::simulate).
///
/// # Errors
/// If the options need all points in one run, the run is stopped, the model is not repeatable, or its values are extreme.
///
/// ```
/// use sensitol::simulation::{Shard, SimulationOptions, merge_shards, simulate, simulate_shard};
/// use sensitol::assembly::Run;
/// use sensitol::{Closure, Dimension, Problem};
/// let dimensions = [Dimension::normal("a", 10.0, 0.3)?, Dimension::uniform("b", 5.0, 0.3)?];
/// let gap = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?;
/// let (options, run) = (SimulationOptions::default(), Run::to_the_end());
/// let shard = |number| simulate_shard(&gap, &options, Shard::new(number, 3).unwrap(), &run, &|_| {}).unwrap();
/// let merged = merge_shards(&gap, &options, &[shard(2), shard(1), shard(3)], &run).unwrap();
/// let whole = simulate(&gap, &options)?;
/// assert_eq!(merged.samples, whole.samples);
/// assert_eq!(merged.characteristics[0].quantiles, whole.characteristics[0].quantiles);
/// // A missing shard is an error, not a smaller sample.
/// assert!(merge_shards(&gap, &options, &[shard(2)], &run).unwrap_err().to_string().contains("2 are missing: 1, 3"));
/// # Ok::<(), sensitol::Error>(())
/// ```
pub fn simulate_shard(
    problem: &Problem,
    options: &SimulationOptions,
    shard: Shard,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<ShardSums, ShardError> {
    check(options)?;
    let sums = at_any_size(problem, run, |problem, run| evaluated(problem, options, shard, run, pace))?;
    if sums.rescaled { Err(ShardError::Extreme) } else { Ok(sums) }
}

/// Checks that the options allow a division of the points.
fn check(options: &SimulationOptions) -> Result<(), ShardError> {
    if !(2..=MOST).contains(&options.samples) {
        return Err(SimulationError::Samples { samples: options.samples, most: MOST }.into());
    }
    let whole = [
        (options.sampler == Sampler::Sobol, "Sobol' points"),
        (options.until.is_some() || options.until_yield.is_some(), "a requested accuracy"),
        (options.control.is_some(), "a control variate"),
        (options.sobol.is_some(), "Sobol' indices"),
    ];
    match whole.into_iter().find(|(asked, _)| *asked) {
        Some((_, option)) => Err(ShardError::OneRun { option }),
        None => Ok(()),
    }
}

fn evaluated(
    problem: &Problem,
    options: &SimulationOptions,
    shard: Shard,
    run: &Run<'_>,
    pace: &dyn Fn(Pace),
) -> Result<ShardSums, ShardError> {
    let begun = Instant::now();
    all_known(problem.dimensions()).map_err(SimulationError::from)?;
    let draws = Draws::new(problem.dimensions(), problem.correlation(), options.sampler, options.seed)
        .map_err(SimulationError::from)?;
    problem.function().prepare(problem.outputs()).map_err(|error| SimulationError::Model { error })?;
    let measured = MeasuredGroups::of(problem, options.samples);
    let evaluator = Evaluator::new(problem, run).with_seed(options.seed);
    let mut tally = Tally::new(problem, None, options.sampler);
    let portions = Portions::new(options, problem.function().signature().costly, problem.dimensions().len());
    // All shards choose their bins by the same points, so that counts in bins add up.
    let values = first_values(&evaluator, &draws, &portions);
    tally.choose_bins(values);
    let mut portions = portions.of_shard(shard);
    let sample = Sample { options, draws: &draws, control: None, measured: measured.as_ref(), watched: false };
    sample.fill(&evaluator, &mut portions, &mut tally, (begun, pace));
    if tally.samples() < portions.total {
        let (answered, points) = (tally.samples(), portions.total);
        return Err(ShardError::Stopped { answered, points, reason: run.why_open() });
    }
    if problem.evaluator().is_some_and(|evaluator| evaluator.unconfirmed > 0) {
        return Err(ShardError::Unconfirmed);
    }
    let ledger = evaluator.into_ledger();
    let (characteristics, together, answered, drawn) = tally.into_sums();
    if let Some(first) = ledger.non_repeatable.iter().chain(&drawn.non_repeatable).next() {
        return Err(ShardError::NotRepeatable { output: first.output.clone() });
    }
    // The points that choose the bins belong to the sample of another shard, which counts their failures.
    let spent = RunSummary { failed: drawn.run.failed, ..drawn.run.and(&ledger.run) };
    Ok(ShardSums {
        shard,
        samples: options.samples,
        seed: options.seed,
        answered,
        characteristics,
        together,
        work: ShardWork::of(&spent),
        rescaled: false,
    })
}

/// Values of every characteristic at the points that choose the bins.
fn first_values(evaluator: &Evaluator<'_>, draws: &Draws<'_>, portions: &Portions) -> Vec<Vec<f64>> {
    let outputs = evaluator.problem().outputs();
    let mut values: Vec<Vec<f64>> = outputs.iter().map(|_| Vec::new()).collect();
    let (mut room, mut points, mut out) = (Room::default(), Points::repeated(&[], 0), Responses::open(0, 0));
    for (portion, rows) in portions.first_batch() {
        draws.write(portion, &mut room, &mut points);
        keep_rows(&mut points, 0..rows);
        evaluator.ask_into(&points, outputs, &mut out);
        for (output, values) in values.iter_mut().enumerate() {
            values.extend(out.column(output).iter().filter(|value| !value.is_nan()));
        }
    }
    values
}

/// Figures of a sample from the sums of all its shards, in any order. A shard may be given twice with the same sums.
///
/// `options` gives the target for the joint yield. Evaluations: the search for assemblies that the sample hardly contains, as
/// [`simulate`](crate::simulation::simulate) does.
///
/// # Errors
/// If shards are missing, contradict each other, or belong to different samples.
pub fn merge_shards(
    problem: &Problem,
    options: &SimulationOptions,
    shards: &[ShardSums],
    run: &Run<'_>,
) -> Result<Simulation, ShardError> {
    let begun = Instant::now();
    let first = shards.first().ok_or(ShardError::Nothing)?;
    let mut ordered: Vec<&ShardSums> = Vec::new();
    for one in shards {
        same_sample(problem, first, one)?;
        match ordered.binary_search_by_key(&one.shard.number(), |known| known.shard.number()) {
            Ok(known) if !ordered[known].equals(one) => {
                return Err(ShardError::Contradiction { number: one.shard.number() });
            }
            Ok(_) => {}
            Err(place) => ordered.insert(place, one),
        }
    }
    let given = |number: &u64| ordered.binary_search_by_key(number, |known| known.shard.number()).is_ok();
    let missing: Vec<u64> = (1..=first.shard.count()).filter(|number| !given(number)).collect();
    if !missing.is_empty() {
        return Err(ShardError::Missing { count: first.shard.count(), missing });
    }
    let options = SimulationOptions { samples: first.samples, seed: first.seed, ..options.clone() };
    let measured = MeasuredGroups::of(problem, options.samples);
    let mut tally = Tally::new(problem, None, Sampler::Random);
    let mut work = RunSummary::default();
    for one in ordered {
        tally.add_sums(&one.characteristics, &one.together, one.answered)?;
        work = one.work.add_to(work);
    }
    tally.watch(options.seed, run);
    let found = tally.finish(&options, measured.as_ref(), None, None);
    Ok(Simulation {
        run: RunSummary { wall: begun.elapsed(), seed: Some(options.seed), ..found.run.and(&work) },
        ..found
    })
}

/// Checks that a shard belongs to the sample of the first one, and to the problem.
fn same_sample(problem: &Problem, first: &ShardSums, one: &ShardSums) -> Result<(), ShardError> {
    let (number, count) = (one.shard.number(), one.shard.count());
    Shard::new(number, count)?;
    if !one.add_up() {
        return Err(ShardError::Inconsistent { number });
    }
    let names = |sums: &ShardSums| {
        let names: Vec<&str> = sums.characteristics.iter().map(|one| one.name.as_str()).collect();
        names.join(", ")
    };
    let asked: Vec<&str> = problem.characteristics().iter().map(|one| one.name()).collect();
    let compared = [
        ("number of shards", count.to_string(), first.shard.count().to_string()),
        ("number of points", one.samples.to_string(), first.samples.to_string()),
        ("seed", one.seed.to_string(), first.seed.to_string()),
        ("list of characteristics", names(one), asked.join(", ")),
    ];
    match compared.into_iter().find(|(_, found, expected)| found != expected) {
        Some((what, found, expected)) => Err(ShardError::Other { number, what, found, expected }),
        None => Ok(()),
    }
}
