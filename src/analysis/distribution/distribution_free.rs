//! Least and greatest yield over all distributions of dimensions of which only the band is promised.
//!
//! | characteristic | yield at a value of the dimension | bounds |
//! |---|---|---|
//! | linear by proof | distribution of the sum of all other inputs | proven |
//! | another one of a cheap model, one such dimension | points of the model at [`PLACES`] values | from points |
//! | others | unknown | unknown |

use std::cell::{Cell, RefCell};
use std::collections::HashMap;

use crate::analysis::distribution::surface_law::{law_over, surface};
use crate::analysis::result::characteristic::CharacteristicAnalysis;
use crate::analysis::sampling::measured_interval::samples_of;
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::estimate::{DistributionFreeYield, most_points_at, yields_at};
use crate::method::{Options, Outcome};
use crate::problem::Problem;
use sensitol_numeric::distribution_bounds::{DistributionPromise, LinearYield, YieldAtValue, yield_bounds};
use sensitol_numeric::law::{Branch, SurfaceLaw};
use sensitol_numeric::surrogate::Univariate;

/// Number of values of a dimension at which the yield of a nonlinear characteristic is counted. With 64 over a band of one sigma, a yield
/// that falls from 1 to 0 over half a sigma has some on its slope.
const PLACES: u32 = 65;

/// Bounds of the yields by the places of their characteristics.
pub(in crate::analysis) fn distribution_free_yields(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
) -> Vec<(usize, DistributionFreeYield)> {
    let each = characteristics.iter().enumerate();
    each.filter_map(|(c, one)| Some((c, distribution_free(problem, outcome, options, left, (c, one))?))).collect()
}

/// Bounds of the yield of a characteristic. Returns None if it has no limits, or if all of its dimensions have a distribution.
fn distribution_free(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    left: &mut SampleBudget,
    (c, one): (usize, &CharacteristicAnalysis),
) -> Option<DistributionFreeYield> {
    let promised = |&d: &usize| outcome.plan.depends(c, d) && problem.dimensions()[d].convention().promise.is_some();
    let linear = outcome.fitted[c].proof.is_some_and(|proof| proof.degree <= 1);
    // A slope of 0 leaves a linear characteristic as it is, whatever the distribution.
    let acts = |d: &usize| !(linear && one.sensitivities[*d].first == Some(0.0));
    let free: Vec<usize> = outcome.plan.varying().iter().copied().filter(promised).filter(acts).collect();
    if free.is_empty() || !one.characteristic.limits().exist() {
        return None;
    }
    let found = match linear {
        // Measured values leave the distribution of the rest uncertain, and bounds would be those of the sample.
        _ if !samples_of(problem, outcome, c).is_empty() => None,
        true => of_sum(problem, outcome, (c, one), &free),
        false if options.verifies(problem.function().signature()) => counted(problem, options, left, c, &free),
        false => None,
    };
    let dimensions = free.iter().map(|&d| problem.dimensions()[d].name().to_owned()).collect();
    let unknown = DistributionFreeYield { dimensions, interval: None, proven: false, worst: None };
    Some(match found {
        Some(Bounded { interval, proven, worst }) => {
            DistributionFreeYield { interval: Some(interval), proven, worst, ..unknown }
        }
        None => unknown,
    })
}

/// Bounds that were found.
struct Bounded {
    interval: [f64; 2],
    proven: bool,
    worst: Option<Vec<[f64; 2]>>,
}

/// Bounds of a linear characteristic. The inputs of any distribution are one input, their sum in half of its band.
fn of_sum(
    problem: &Problem,
    outcome: &Outcome,
    (c, one): (usize, &CharacteristicAnalysis),
    free: &[usize],
) -> Option<Bounded> {
    let half = |d: usize| problem.dimensions()[d].half_band();
    let slopes = free.iter().map(|&d| Some(one.sensitivities[d].first? * half(d))).collect::<Option<Vec<f64>>>()?;
    let reach: f64 = slopes.iter().map(|slope| slope.abs()).sum();
    let promise = |(&d, slope): (&usize, &f64)| {
        let facts = problem.dimensions()[d].convention().promise?;
        Some((slope / reach, DistributionPromise::over([-1.0, 1.0], &facts).ok()?))
    };
    let promises = free.iter().zip(&slopes).map(promise);
    let sum = DistributionPromise::of_sum(&promises.collect::<Option<Vec<_>>>()?).ok()?;
    let rest = law_of_rest(problem, outcome, c, free)?;
    let (known, error) = (RefCell::new(HashMap::new()), Cell::new(0.0f64));
    // The cells of the band meet at the same places again and again, and a tail of the rest is an integral.
    let tails = |y: f64| {
        *known.borrow_mut().entry(y.to_bits()).or_insert_with(|| {
            let (below, above) = (rest.below(y), rest.above(y));
            error.set(error.get().max(below.error + above.error));
            [below.value, above.value]
        })
    };
    let limits = one.characteristic.limits();
    let within = LinearYield { slope: reach, offset: 0.0, limits: [limits.lower(), limits.upper()], tails: &tails };
    let found = yield_bounds(&sum, &within);
    let [least, greatest] = found.certified;
    let interval = [(least - error.get()).max(0.0), (greatest + error.get()).min(1.0)];
    let worst = match free {
        &[d] => Some(in_units(problem, d, slopes[0].signum(), &found.distributions[0])),
        _ => None,
    };
    Some(Bounded { interval, proven: rest.branch() != Branch::Sampled, worst })
}

/// Distribution of a linear characteristic with some dimensions at the middles of their bands.
fn law_of_rest(problem: &Problem, outcome: &Outcome, c: usize, free: &[usize]) -> Option<SurfaceLaw> {
    let (mut surrogate, inputs) = surface(problem, outcome, c, None)?;
    for (part, d) in surrogate.parts.iter_mut().zip(outcome.plan.varying()) {
        if free.contains(d) {
            *part = Some(Univariate::of_coefficients(&[0.0]));
        }
    }
    law_over(&surrogate, &inputs, outcome.plan.inputs().correlation(), problem.kept_limits(c).rounding()).ok()
}

/// Bounds from points of a cheap model, with one dimension of any distribution.
fn counted(problem: &Problem, options: &Options, left: &mut SampleBudget, c: usize, free: &[usize]) -> Option<Bounded> {
    let &[d] = free else { return None };
    let dimension = &problem.dimensions()[d];
    let promise = DistributionPromise::over([-1.0, 1.0], &dimension.convention().promise?).ok()?;
    if problem.function().signature().costly || !left.take(most_points_at(PLACES as usize)) {
        return None;
    }
    let places: Vec<f64> = (0..PLACES).map(|at| 2.0 * f64::from(at) / f64::from(PLACES - 1) - 1.0).collect();
    let values: Vec<f64> = places.iter().map(|place| dimension.mean() + dimension.half_band() * place).collect();
    let counted = yields_at(problem, c, d, &values, options.seed.unwrap_or(Options::SEED));
    let [least, greatest] = [0, 1].map(|end| {
        let shares = counted.iter().map(|interval| interval[end]).collect();
        yield_bounds(&promise, &CountedYield { shares })
    });
    let worst = Some(in_units(problem, d, 1.0, &least.distributions[0]));
    Some(Bounded { interval: [least.certified[0], greatest.certified[1]], proven: false, worst })
}

/// Points of a distribution over half bands, in the unit of the dimension, ascending.
fn in_units(problem: &Problem, d: usize, sign: f64, points: &[[f64; 2]]) -> Vec<[f64; 2]> {
    let dimension = &problem.dimensions()[d];
    let mut points: Vec<[f64; 2]> =
        points.iter().map(|[place, share]| [dimension.mean() + sign * dimension.half_band() * place, *share]).collect();
    points.sort_by(|a, b| a[0].total_cmp(&b[0]));
    points
}

/// Yield at values of a dimension by counted points, in half bands: a straight line between two values.
struct CountedYield {
    /// Shares at equal distances from -1 to 1.
    shares: Vec<f64>,
}

impl CountedYield {
    /// Place of a value among the shares.
    fn place(&self, x: f64) -> f64 {
        let last = (self.shares.len() - 1) as f64;
        (0.5 * (x + 1.0) * last).clamp(0.0, last)
    }
}

impl YieldAtValue for CountedYield {
    fn at(&self, x: f64) -> f64 {
        let place = self.place(x);
        let (first, part) = (place.floor() as usize, place.fract());
        let next = self.shares[(first + 1).min(self.shares.len() - 1)];
        self.shares[first] + part * (next - self.shares[first])
    }

    fn over(&self, interval: [f64; 2]) -> [f64; 2] {
        let [first, last] = [self.place(interval[0]).floor() as usize, self.place(interval[1]).ceil() as usize];
        let touched = &self.shares[first..=last];
        [touched.iter().copied().fold(1.0, f64::min), touched.iter().copied().fold(0.0, f64::max)]
    }
}
