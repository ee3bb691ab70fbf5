//! Uncertainty of results that comes from the finite size of measured samples.
//!
//! Every measured sample is drawn anew from itself, many times. The surrogate stays the same function of the dimensions, and its moments
//! are computed exactly for the distribution of each resample: no point is evaluated. The scatter of the resamples estimates that of other
//! samples of the same size. Rows of one file are drawn as a whole. Everything else is drawn independently.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::sampling::resample_interval::{acceleration, bca};
use crate::method::Outcome;
use crate::problem::Problem;
use crate::verification::CONFIDENCE;
use sensitol_numeric::capability::{Capability, Law, cpk};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::correlation::JointLaw;
use sensitol_numeric::distribution::{Distribution, Resample, Reweighted, StandardMoments};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::surrogate::{BlockMoments, InputShape, Inputs, Relocation, Surrogate};

/// Number of resamples with which an end of an interval is known to about a tenth of the width.
const RESAMPLES: usize = 1000;
/// Smallest number of resamples with which an interval is still meaningful.
const LEAST: usize = 200;
/// Budget of multiplications for all resamples together, a second or two. Above it there are fewer resamples.
const WORK: usize = 3_000_000_000;
/// Cost of a fit of a Pearson distribution, in multiplications.
const FIT: usize = 30_000;
/// Cost of a univariate part other than a parabola at one value, in multiplications.
const VALUE: usize = 50;
/// Groups of values that are left out in turn, of all samples together.
const GROUPS: usize = 400;
/// Smallest number of groups of values of each sample, even if there are many samples.
const LEAST_GROUPS: usize = 20;
/// Curvature below this part of the slope is rounding, and needs no higher moment.
const STRAIGHT: f64 = 1e-9;

/// Number of figures that get intervals: mean, sigma, skewness, kurtosis, reject rate, Cpk.
const FIGURES: usize = 6;
type Figures = [f64; FIGURES];

/// A measured dimension, or several dimensions measured together as rows.
struct Measurement<'p> {
    /// Positions of its dimensions among the varying ones.
    positions: Vec<usize>,
    kind: MeasurementKind<'p>,
}

enum MeasurementKind<'p> {
    One(&'p dyn Resample),
    /// Block with this index, with the number of its rows.
    Rows {
        block: usize,
        rows: usize,
    },
}

/// A resample of a measured sample.
enum Redrawn {
    Law(Reweighted),
    /// Weights of the rows of the block.
    Rows(Vec<f64>),
}

impl Measurement<'_> {
    /// Number of measured values or rows.
    fn len(&self) -> usize {
        match &self.kind {
            MeasurementKind::One(law) => law.sample().len(),
            MeasurementKind::Rows { rows, .. } => *rows,
        }
    }

    /// Counts of each distinct value, or of each row (1).
    fn counts(&self) -> Vec<u32> {
        match &self.kind {
            MeasurementKind::One(law) => law.sample().counts().to_vec(),
            MeasurementKind::Rows { rows, .. } => vec![1; *rows],
        }
    }

    fn drawn(&self, rng: &mut Xoshiro256PlusPlus) -> Redrawn {
        let mut counts = Vec::new();
        match &self.kind {
            MeasurementKind::One(law) => law.sample().draw(rng, &mut counts),
            MeasurementKind::Rows { rows, .. } => {
                counts.resize(*rows, 0);
                (0..*rows).for_each(|_| counts[rng.random_range(0..*rows)] += 1);
            }
        }
        self.reweighted(&counts)
    }

    fn reweighted(&self, counts: &[u32]) -> Redrawn {
        match &self.kind {
            MeasurementKind::One(law) => Redrawn::Law(law.reweighted(counts)),
            MeasurementKind::Rows { .. } => {
                let all: f64 = counts.iter().map(|&count| f64::from(count)).sum();
                Redrawn::Rows(counts.iter().map(|&count| f64::from(count) / all).collect())
            }
        }
    }
}

/// Intervals from resamples, in the order mean, sigma, skewness, kurtosis, reject rate, Cpk.
pub(in crate::analysis) struct ResampledIntervals {
    pub(in crate::analysis) intervals: [Option<[f64; 2]>; FIGURES],
    pub(in crate::analysis) resamples: usize,
}

/// Intervals of every characteristic that depends on a measured dimension.
///
/// None for a characteristic without such a dimension or without a surface. All are None if dimensions are correlated other than by rows
/// and zones.
///
/// The rejects are those of the Pearson fit. The numbers depend on the seed alone, not on the number of threads.
pub(in crate::analysis) fn resampled_intervals(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    seed: u64,
) -> Vec<Option<ResampledIntervals>> {
    let plan = &outcome.plan;
    let correlation = plan.inputs().correlation();
    let mut found: Vec<Option<ResampledIntervals>> = characteristics.iter().map(|_| None).collect();
    if correlation.is_some_and(|correlation| correlation.without_blocks().is_some()) {
        // A resample of one dimension would not move the dimensions that vary with it. `warnings` reports such dimensions.
        return found;
    }
    let of_blocks = correlation.iter().flat_map(|correlation| correlation.blocks().iter().enumerate());
    let of_blocks = of_blocks.filter_map(|(index, block)| {
        let JointLaw::Rows(rows) = &block.law else { return None };
        let kind = MeasurementKind::Rows { block: index, rows: rows.len() };
        Some(Measurement { positions: block.members.clone(), kind })
    });
    let alone = plan.varying().iter().enumerate().filter_map(|(position, &d)| {
        let in_block = correlation.is_some_and(|correlation| correlation.block_of(position).is_some());
        let law = problem.dimensions()[d].distribution().filter(|_| !in_block).and_then(Distribution::measured)?;
        Some(Measurement { positions: vec![position], kind: MeasurementKind::One(law) })
    });
    let measured: Vec<Measurement<'_>> = of_blocks.chain(alone).collect();
    let concerned = |c: usize| {
        measured.iter().flat_map(|one| &one.positions).any(|&position| plan.depends(c, plan.varying()[position]))
    };
    let targets: Vec<Target<'_>> = (characteristics.iter().enumerate())
        .filter(|&(c, analysis)| analysis.moments.is_some() && concerned(c))
        .filter_map(|(index, analysis)| {
            let surrogate = outcome.fitted[index].surrogate.as_ref()?;
            let pooled = surrogate.pooled(plan.inputs());
            (correlation.is_none() || pooled.is_some()).then(|| Target {
                index,
                surrogate,
                pooled,
                limits: analysis.characteristic.limits(),
            })
        })
        .collect();
    if targets.is_empty() {
        return found;
    }
    // Left-out groups give the acceleration of the intervals, resamples their scatter.
    let setting = Setting { inputs: plan.inputs(), measured: &measured, targets: &targets };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let groups = setting.groups(&mut rng);
    let resampled = setting.resampled(&mut rng);
    let left_out = setting.left_out(&groups);
    for (t, target) in targets.iter().enumerate() {
        let analysis = &characteristics[target.index];
        let estimate = {
            let moments = analysis.moments.expect("a target has moments");
            // From the Pearson fit, like the figures of the resamples.
            figures(&moments, analysis.evidence.pearson.as_ref(), target.limits)
        };
        let interval = |figure: usize| {
            let mut values: Vec<f64> = resampled.iter().map(|of| of[t][figure]).collect();
            let influences: Vec<Vec<f64>> = (left_out.iter().zip(&measured).zip(&groups))
                .map(|((of, one), groups)| influences(of.iter().map(|of| of[t][figure]), one, groups))
                .collect();
            bca(estimate[figure], &mut values, acceleration(&influences), CONFIDENCE)
        };
        let intervals = std::array::from_fn(interval);
        found[target.index] = Some(ResampledIntervals { intervals, resamples: resampled.len() });
    }
    found
}

/// A characteristic for which intervals are computed.
struct Target<'o> {
    index: usize,
    surrogate: &'o Surrogate,
    /// Surrogate evaluated at the rows of the blocks of correlated inputs.
    pooled: Option<BlockMoments>,
    limits: SpecLimits,
}

struct Setting<'s> {
    inputs: &'s Inputs,
    measured: &'s [Measurement<'s>],
    targets: &'s [Target<'s>],
}

/// Counts of the measured values in each of several groups, by distinct value of a sample.
type Groups = Vec<Vec<u32>>;

impl Setting<'_> {
    /// Figures of every resample and target.
    fn resampled(&self, rng: &mut Xoshiro256PlusPlus) -> Vec<Vec<Figures>> {
        let streams: Vec<Xoshiro256PlusPlus> = (0..self.resamples())
            .map(|_| {
                rng.jump();
                rng.clone()
            })
            .collect();
        let one = |mut rng: Xoshiro256PlusPlus| {
            let drawn: Vec<Option<Redrawn>> = self.measured.iter().map(|one| Some(one.drawn(&mut rng))).collect();
            self.figures(&drawn)
        };
        streams.into_par_iter().map(one).collect()
    }

    /// Number of resamples that the budget of work allows.
    fn resamples(&self) -> usize {
        let values: usize = self.measured.iter().map(Measurement::len).sum();
        let target = |target: &Target<'_>| {
            let fit = if target.limits.exist() { FIT } else { 0 };
            let pooled = target.pooled.as_ref().map_or(0, BlockMoments::work);
            let own = target.surrogate.interactions.work().saturating_add(pooled);
            VALUE.saturating_mul(values).saturating_add(fit).saturating_add(own)
        };
        let work = self.targets.iter().map(target).fold(1usize, usize::saturating_add);
        (WORK / work).clamp(LEAST, RESAMPLES)
    }

    /// Random groups of values that are left out together. Each value is a group of its own if there are few.
    fn groups(&self, rng: &mut Xoshiro256PlusPlus) -> Vec<Groups> {
        let most = (GROUPS / self.measured.len()).max(LEAST_GROUPS);
        let of = |one: &Measurement<'_>| {
            let counts = one.counts();
            let mut atoms: Vec<usize> = (counts.iter().enumerate())
                .flat_map(|(atom, &count)| std::iter::repeat_n(atom, count as usize))
                .collect();
            atoms.shuffle(rng);
            let groups = most.min(atoms.len());
            let mut counted = vec![vec![0; counts.len()]; groups];
            atoms.iter().enumerate().for_each(|(i, &atom)| counted[i % groups][atom] += 1);
            counted
        };
        self.measured.iter().map(of).collect()
    }

    /// Figures of every target without a group of values, by measured dimension and group.
    fn left_out(&self, groups: &[Groups]) -> Vec<Vec<Vec<Figures>>> {
        let without = |m: usize, group: &Vec<u32>| {
            let one = &self.measured[m];
            let counts: Vec<u32> = one.counts().iter().zip(group).map(|(all, out)| all - out).collect();
            let drawn: Vec<Option<Redrawn>> =
                (0..self.measured.len()).map(|other| (other == m).then(|| one.reweighted(&counts))).collect();
            self.figures(&drawn)
        };
        let of = |(m, groups): (usize, &Groups)| groups.par_iter().map(|group| without(m, group)).collect();
        groups.iter().enumerate().map(of).collect()
    }

    /// Figures of every target with the given resamples. A sample without one (None) keeps its measured values.
    fn figures(&self, drawn: &[Option<Redrawn>]) -> Vec<Figures> {
        let mut moved = vec![Relocation::NONE; self.inputs.shapes().len()];
        let mut shapes = self.inputs.shapes().to_vec();
        let mut weights: Vec<(usize, &[f64])> = Vec::new();
        let mut alone: Vec<usize> = Vec::new();
        for (one, drawn) in self.measured.iter().zip(drawn) {
            match (&one.kind, drawn) {
                (MeasurementKind::Rows { block, .. }, Some(Redrawn::Rows(own))) => weights.push((*block, own)),
                (MeasurementKind::One(_), Some(Redrawn::Law(Reweighted { shift, stretch, moments, rule }))) => {
                    let position = one.positions[0];
                    moved[position] = Relocation { shift: *shift, stretch: *stretch };
                    shapes[position] = InputShape { moments: *moments, rule: rule.clone().into() };
                    alone.push(position);
                }
                _ => {}
            }
        }
        let weight = |block: usize, place: usize| {
            weights.iter().find(|(own, _)| *own == block).map(|(_, weights)| weights[place])
        };
        let of = |target: &Target<'_>| {
            let moments = match &target.pooled {
                Some(pooled) if alone.is_empty() => Some(pooled.moments(&weight)),
                _ => {
                    let surrogate = target.surrogate.relocated(&moved);
                    let mut shapes = shapes.clone();
                    for &position in &alone {
                        let part = surrogate.parts[position].as_ref();
                        // A straight line does not use the higher moments, so an infinite one does no harm.
                        if shapes[position].moments.m8.is_nan() && part.is_some_and(|part| part.is_straight(STRAIGHT)) {
                            shapes[position].moments = of_a_line(&shapes[position].moments);
                        }
                    }
                    let inputs = Inputs::new(shapes, self.inputs.correlation().cloned());
                    match &target.pooled {
                        Some(_) => surrogate.pooled(&inputs).map(|pooled| pooled.moments(&weight)),
                        None => surrogate.contributions(&inputs).map(|contributions| contributions.moments),
                    }
                }
            };
            let Some(moments) = moments else {
                return [f64::NAN; FIGURES];
            };
            let law = target.limits.exist().then(|| Law::fit(&moments).ok()).flatten();
            let capability = law.map(|law| Capability::of(&law, moments.mean(), moments.sigma(), target.limits));
            figures(&moments, capability.as_ref(), target.limits)
        };
        self.targets.iter().map(of).collect()
    }
}

/// Moments that a straight line uses. The others are multiplied by 0 and need only be finite.
fn of_a_line(moments: &StandardMoments) -> StandardMoments {
    let kurtosis = moments.kurtosis();
    let known = StandardMoments::from_standard([moments.skewness, kurtosis, 0.0, 0.0, 0.0, 0.0]);
    StandardMoments { excess: moments.excess, ..known }
}

fn figures(moments: &Moments, capability: Option<&Capability>, limits: SpecLimits) -> Figures {
    [
        moments.mean(),
        moments.sigma(),
        moments.skewness().unwrap_or(f64::NAN),
        moments.kurtosis().unwrap_or(f64::NAN),
        capability.and_then(Capability::rejected).unwrap_or(f64::NAN),
        cpk(moments.mean(), moments.sigma(), limits).unwrap_or(f64::NAN),
    ]
}

/// Influence of each group of values on a figure, from the figure without that group.
fn influences(without: impl Iterator<Item = f64>, one: &Measurement<'_>, groups: &Groups) -> Vec<f64> {
    let n = one.len() as f64;
    let left = |group: &Vec<u32>| n - group.iter().map(|&count| f64::from(count)).sum::<f64>();
    without.zip(groups).map(|(figure, group)| -left(group) / n * figure).collect()
}
