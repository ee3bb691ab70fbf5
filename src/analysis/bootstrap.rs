//! How far results may be off because measured dimensions are known by samples only.
//!
//! Every measured sample is drawn anew from itself, many times. Each time the surrogate stays the function of the
//! dimensions that it is, and its moments are computed exactly for the law that the resample makes: no point is
//! evaluated. What the resamples scatter by is what other samples of the same size would. Dimensions are drawn apart from
//! one another, columns of one file too, as they are taken for independent everywhere.

use rand::SeedableRng;
use rand::seq::SliceRandom;
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;

use super::interval::{acceleration, bca};
use super::{CharacteristicAnalysis, SamplingInterval};
use crate::capability::{Capability, Law, cpk};
use crate::characteristic::SpecLimits;
use crate::distribution::{Distribution, Resample, Reweighted, StandardMoments};
use crate::method::Outcome;
use crate::moments::Moments;
use crate::problem::Problem;
use crate::surrogate::{InputShape, Inputs, Relocation, Surrogate};
use crate::verdict::including;

/// The probability with which an interval covers the truth.
const LEVEL: f64 = 0.95;
/// As many resamples as an end of the interval needs to be known to a tenth of its width or so;
const RESAMPLES: usize = 1000;
/// with so many it still means something.
const LEAST: usize = 200;
/// Multiplications that all resamples together may take, before there are fewer of them: a second or two.
const WORK: usize = 3_000_000_000;
/// Multiplications that a fit of a Pearson law, and a part that is no parabola at one value, are worth.
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

/// A dimension that was measured.
struct Measurement<'p> {
    /// Among the varying dimensions.
    position: usize,
    name: &'p str,
    law: &'p dyn Resample,
}

/// Fills in the intervals of every characteristic that depends on a measured dimension; whether there is one. Not where
/// dimensions are correlated.
///
/// The numbers depend on the seed alone, not on the number of threads.
pub(super) fn intervals(
    problem: &Problem,
    outcome: &Outcome,
    characteristics: &mut [CharacteristicAnalysis],
    seed: u64,
) -> bool {
    let plan = &outcome.plan;
    if plan.inputs().correlation().is_some() {
        // A resample of one dimension would leave those that vary with it where they are; `warnings` tells of it.
        return false;
    }
    let measured: Vec<Measurement<'_>> = (plan.varying().iter().enumerate())
        .filter_map(|(position, &d)| {
            let dimension = &problem.dimensions()[d];
            let law = dimension.distribution().and_then(Distribution::measured)?;
            Some(Measurement { position, name: dimension.name(), law })
        })
        .collect();
    let concerned = |c: usize| measured.iter().any(|one| plan.depends(c, plan.varying()[one.position]));
    let targets: Vec<Target<'_>> = (characteristics.iter().enumerate())
        .filter(|&(c, analysis)| analysis.moments.is_some() && concerned(c))
        .filter_map(|(index, analysis)| {
            let surrogate = outcome.fitted[index].surrogate.as_ref()?;
            Some(Target { index, surrogate, limits: analysis.characteristic.limits() })
        })
        .collect();
    if targets.is_empty() {
        return false;
    }
    let setting = Setting { shapes: plan.inputs().shapes(), measured: &measured, targets: &targets };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
    let groups = setting.groups(&mut rng);
    let resampled = setting.resampled(&mut rng);
    let left_out = setting.left_out(&groups);
    for (t, target) in targets.iter().enumerate() {
        let analysis = &mut characteristics[target.index];
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
            bca(estimate[figure], &mut values, acceleration(&influences), LEVEL)
        };
        let depends = |one: &&Measurement<'_>| plan.depends(target.index, plan.varying()[one.position]);
        let samples = measured.iter().filter(depends).map(|one| (one.name.to_owned(), one.law.sample().len()));
        analysis.sampling = Some(SamplingInterval {
            mean: interval(0),
            sigma: interval(1),
            skewness: interval(2),
            kurtosis: interval(3),
            rejected: interval(4).map(|of_fit| {
                let rejected = |of: Option<Capability>| of.and_then(|of| of.rejected());
                match (rejected(analysis.pearson), rejected(analysis.capability)) {
                    (Some(fit), Some(printed)) => in_proportion(of_fit, fit, printed),
                    _ => of_fit,
                }
            }),
            cpk: interval(5),
            level: LEVEL,
            resamples: resampled.len(),
            samples: samples.collect(),
        });
    }
    true
}

/// The interval of the rejects of the Pearson fit, by which resamples are judged, as one of the rejects that are reported: both ends
/// in the same proportion, so that the size of the sample leaves as many times more and fewer open.
fn in_proportion([low, high]: [f64; 2], fit: f64, reported: f64) -> [f64; 2] {
    let by = reported / fit;
    if by.is_finite() && by > 0.0 { [low * by, (high * by).min(1.0)] } else { including([low, high], reported) }
}

/// A characteristic whose intervals are wanted.
struct Target<'o> {
    index: usize,
    surrogate: &'o Surrogate,
    limits: SpecLimits,
}

struct Setting<'s> {
    shapes: &'s [InputShape],
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
            let mut counts = Vec::new();
            let mut draw = |one: &Measurement<'_>| {
                one.law.sample().draw(&mut rng, &mut counts);
                Some(one.law.reweighted(&counts))
            };
            let laws: Vec<Option<Reweighted>> = self.measured.iter().map(&mut draw).collect();
            self.figures(&laws)
        };
        streams.into_par_iter().map(one).collect()
    }

    /// As many as there is time for.
    fn resamples(&self) -> usize {
        let values: usize = self.measured.iter().map(|one| one.law.sample().len()).sum();
        let target = |target: &Target<'_>| {
            let fit = if target.limits.exist() { FIT } else { 0 };
            VALUE.saturating_mul(values).saturating_add(fit).saturating_add(target.surrogate.interactions.work())
        };
        let work = self.targets.iter().map(target).fold(1usize, usize::saturating_add);
        (WORK / work).clamp(LEAST, RESAMPLES)
    }

    /// Values that are left out together: at random, each by itself where there are few.
    fn groups(&self, rng: &mut Xoshiro256PlusPlus) -> Vec<Groups> {
        let most = (GROUPS / self.measured.len()).max(LEAST_GROUPS);
        let of = |one: &Measurement<'_>| {
            let sample = one.law.sample();
            let counts = sample.counts().iter().enumerate();
            let mut atoms: Vec<usize> =
                counts.flat_map(|(atom, &count)| std::iter::repeat_n(atom, count as usize)).collect();
            atoms.shuffle(rng);
            let groups = most.min(atoms.len());
            let mut counted = vec![vec![0; sample.counts().len()]; groups];
            atoms.iter().enumerate().for_each(|(i, &atom)| counted[i % groups][atom] += 1);
            counted
        };
        self.measured.iter().map(of).collect()
    }

    /// For every measured dimension and group of its values, the figures of every target without them.
    fn left_out(&self, groups: &[Groups]) -> Vec<Vec<Vec<Figures>>> {
        let without = |m: usize, group: &Vec<u32>| {
            let law = self.measured[m].law;
            let counts: Vec<u32> = law.sample().counts().iter().zip(group).map(|(all, out)| all - out).collect();
            let laws: Vec<Option<Reweighted>> =
                (0..self.measured.len()).map(|other| (other == m).then(|| law.reweighted(&counts))).collect();
            self.figures(&laws)
        };
        let of = |(m, groups): (usize, &Groups)| groups.par_iter().map(|group| without(m, group)).collect();
        groups.iter().enumerate().map(of).collect()
    }

    /// The figures of every target where the measured dimensions have these laws; None for one that stays as it is.
    fn figures(&self, laws: &[Option<Reweighted>]) -> Vec<Figures> {
        let mut moved = vec![Relocation::NONE; self.shapes.len()];
        let mut shapes = self.shapes.to_vec();
        for (one, law) in self.measured.iter().zip(laws) {
            if let Some(Reweighted { shift, stretch, moments, rule }) = law {
                moved[one.position] = Relocation { shift: *shift, stretch: *stretch };
                shapes[one.position] = InputShape { moments: *moments, rule: rule.clone().into() };
            }
        }
        let of = |target: &Target<'_>| {
            let surrogate = target.surrogate.relocated(&moved);
            let mut shapes = shapes.clone();
            for one in self.measured {
                let part = surrogate.parts[one.position].as_ref();
                // An infinite moment does no harm to a straight line, which has no use for it.
                if shapes[one.position].moments.m8.is_nan() && part.is_some_and(|part| part.is_straight(STRAIGHT)) {
                    shapes[one.position].moments = of_a_line(&shapes[one.position].moments);
                }
            }
            let contributions = surrogate.contributions(&Inputs::independent(shapes));
            let Some(moments) = contributions.map(|contributions| contributions.moments) else {
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

/// What each group of values adds to a figure, from the figure without it: for a mean of `n` values the sum of the
/// deviations in the group, by `n`.
fn influences(without: impl Iterator<Item = f64>, one: &Measurement<'_>, groups: &Groups) -> Vec<f64> {
    let n = one.law.sample().len() as f64;
    let left = |group: &Vec<u32>| n - group.iter().map(|&count| f64::from(count)).sum::<f64>();
    without.zip(groups).map(|(figure, group)| -left(group) / n * figure).collect()
}
