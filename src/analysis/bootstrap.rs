//! How far results may be off because measured dimensions are known by samples only.
//!
//! Every measured sample is drawn anew from itself, many times. Each time the surrogate stays the function of the
//! dimensions that it is, and its moments are computed exactly for the law that the resample makes: no point is
//! evaluated. The scatter of the resamples estimates that of other samples of the same size. Rows of one file are drawn as a
//! whole, and everything else apart from one another.

use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use super::CharacteristicAnalysis;
use super::interval::{acceleration, bca};
use crate::method::Outcome;
use crate::problem::Problem;
use crate::verification::CONFIDENCE;
use sensitol_numeric::capability::{Capability, Law, cpk};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::correlation::JointLaw;
use sensitol_numeric::distribution::{Distribution, Resample, Reweighted, StandardMoments};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::surrogate::{InputShape, Inputs, Pooled, Relocation, Surrogate};

/// As many resamples as an end of the interval needs to be known to a tenth of its width or so;
const RESAMPLES: usize = 1000;
/// with so many it still means something.
const LEAST: usize = 200;
/// Multiplications that all resamples together may take, before there are fewer of them: a second or two.
const WORK: usize = 3_000_000_000;
/// Multiplications that a fit of a Pearson law, and a part that is not a parabola at one value, are worth.
const FIT: usize = 30_000;
const VALUE: usize = 50;
/// Groups of values that are left out in turn, of all samples together and of each at least.
const GROUPS: usize = 400;
const LEAST_GROUPS: usize = 20;
/// A curvature below this part of the slope is rounding, and asks for no higher moment.
const STRAIGHT: f64 = 1e-9;

/// The results whose intervals are known: mean, sigma, skewness, kurtosis, rejected share, Cpk.
const FIGURES: usize = 6;
type Figures = [f64; FIGURES];

/// A dimension that was measured, or several by rows.
struct Measurement<'p> {
    /// Among the varying dimensions.
    positions: Vec<usize>,
    kind: MeasurementKind<'p>,
}

enum MeasurementKind<'p> {
    One(&'p dyn Resample),
    /// The block of this number, of so many rows.
    Rows {
        block: usize,
        rows: usize,
    },
}

/// A sample that was drawn anew.
enum Redrawn {
    Law(Reweighted),
    /// Weights of the rows.
    Rows(Vec<f64>),
}

impl Measurement<'_> {
    /// How many values or rows there are.
    fn len(&self) -> usize {
        match &self.kind {
            MeasurementKind::One(law) => law.sample().len(),
            MeasurementKind::Rows { rows, .. } => *rows,
        }
    }

    /// How often each distinct value, or each row, was measured.
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

/// Intervals from resamples: mean, sigma, skewness, kurtosis, rejected share and Cpk.
pub(super) struct ResampledIntervals {
    pub(super) intervals: [Option<[f64; 2]>; FIGURES],
    pub(super) resamples: usize,
}

/// The intervals of every characteristic that depends on a measured dimension. None for any other one, without a surface, and where
/// dimensions are correlated otherwise than by rows and zones.
///
/// The rejects are those of the Pearson fit. The numbers depend on the seed alone, not on the number of threads.
pub(super) fn resampled_intervals(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &[CharacteristicAnalysis],
    seed: u64,
) -> Vec<Option<ResampledIntervals>> {
    let plan = &outcome.plan;
    let correlation = plan.inputs().correlation();
    let mut found: Vec<Option<ResampledIntervals>> = characteristics.iter().map(|_| None).collect();
    if correlation.is_some_and(|correlation| correlation.without_blocks().is_some()) {
        // A resample of one dimension would leave those that vary with it where they are; `warnings` tells of it.
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
    let setting = Setting { inputs: plan.inputs(), measured: &measured, targets: &targets };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let groups = setting.groups(&mut rng);
    let resampled = setting.resampled(&mut rng);
    let left_out = setting.left_out(&groups);
    for (t, target) in targets.iter().enumerate() {
        let analysis = &characteristics[target.index];
        let estimate = {
            let moments = analysis.moments.expect("a target has moments");
            // As the resamples: by the Pearson fit.
            figures(&moments, analysis.pearson.as_ref(), target.limits)
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

/// A characteristic whose intervals are wanted.
struct Target<'o> {
    index: usize,
    surrogate: &'o Surrogate,
    /// At the places of its blocks.
    pooled: Option<Pooled>,
    limits: SpecLimits,
}

struct Setting<'s> {
    inputs: &'s Inputs,
    measured: &'s [Measurement<'s>],
    targets: &'s [Target<'s>],
}

/// For every distinct value of a sample, how many of its measured values are in each of several groups.
type Groups = Vec<Vec<u32>>;

impl Setting<'_> {
    /// For every resample and target its figures.
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

    /// As many as there is time for.
    fn resamples(&self) -> usize {
        let values: usize = self.measured.iter().map(Measurement::len).sum();
        let target = |target: &Target<'_>| {
            let fit = if target.limits.exist() { FIT } else { 0 };
            let pooled = target.pooled.as_ref().map_or(0, Pooled::work);
            let own = target.surrogate.interactions.work().saturating_add(pooled);
            VALUE.saturating_mul(values).saturating_add(fit).saturating_add(own)
        };
        let work = self.targets.iter().map(target).fold(1usize, usize::saturating_add);
        (WORK / work).clamp(LEAST, RESAMPLES)
    }

    /// Values that are left out together: at random, each by itself where there are few.
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

    /// For every measured dimension and group of its values, the figures of every target without them.
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

    /// The figures of every target where the samples are these; None for one that stays as it is.
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
                        // An infinite moment does no harm to a straight line, which has no use for it.
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

/// The moments of which a straight line makes use; the others are multiplied by 0 and need only be numbers.
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

/// The part that each group of values adds to a figure, from the figure without it: for a mean of `n` values the sum of the
/// deviations in the group, by `n`.
fn influences(without: impl Iterator<Item = f64>, one: &Measurement<'_>, groups: &Groups) -> Vec<f64> {
    let n = one.len() as f64;
    let left = |group: &Vec<u32>| n - group.iter().map(|&count| f64::from(count)).sum::<f64>();
    without.zip(groups).map(|(figure, group)| -left(group) / n * figure).collect()
}
