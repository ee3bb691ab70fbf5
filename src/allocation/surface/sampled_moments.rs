//! Moments near a linearization point of a characteristic whose surface the model refutes: those of the surface,
//! corrected by samples of the model.
//!
//! ```text
//! mean = mean_q + s0 (a_0 + sum_g b_g0 ln T_g)    ln sigma = ln sigma_q + a_1 + sum_g b_g1 ln T_g    skewness, excess alike
//! ```
//!
//! `a` is the difference of the verified moments from those of the surface at the linearization point. `b` is the
//! difference of the slopes. It comes from two samples of the model with the same random numbers, with every tolerance
//! of a group a little wider and a little tighter. At the end of the search values and slopes are those of the model.
//! Source: N. M. Alexandrov, R. M. Lewis, Optimization and Engineering 2 (2001).
//!
//! Cost: two samples of 16 384 points for every group, for cheap models and at most 128 groups.

use crate::allocation::cost::priced_group::Priced;
use crate::assembly::Run;
use crate::problem::Problem;
use crate::simulation::{SimulationOptions, simulate_with};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::sampling::Sampler;

/// Points of a sample.
const POINTS: u64 = 1 << 14;
/// Half of the difference in `ln T`. Its truncation is of the order of `STEP^2/6`, 4e-4.
const STEP: f64 = 0.05;
/// Half of the difference in `ln T` for moments by derivatives, which are smooth. Its truncation is of the order of
/// `WIDTH_STEP^2/6`, 2e-5 of a slope.
const WIDTH_STEP: f64 = 0.01;
/// Greatest distance from the linearization point, in `ln T`, at which a slope is followed.
const FAR: f64 = 0.7;

/// Correction by the model of the moments of a surface near a linearization point.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct SampledCorrection {
    sigma: f64,
    offset: [f64; 4],
    /// Slopes by the first dimension of every group.
    slopes: Vec<(usize, [f64; 4])>,
}

/// Mean in sigmas of the linearization point, `ln sigma`, skewness and excess.
fn figures(moments: &Moments, sigma: f64) -> Option<[f64; 4]> {
    let all = [moments.mean() / sigma, libm::log(moments.sigma()), moments.skewness()?, moments.excess()?];
    all.iter().all(|figure| figure.is_finite()).then_some(all)
}

fn difference(a: [f64; 4], b: [f64; 4]) -> [f64; 4] {
    std::array::from_fn(|i| a[i] - b[i])
}

impl SampledCorrection {
    /// Correction of the slopes by groups whose widths stand in formulas too, for these do not grow as the surface has
    /// it. `moments` are those of the surface at the linearization point. `model` gives those of the model with a group
    /// at a factor, and `surface` those of the surface there. Returns None if moments are unknown.
    pub(in crate::allocation) fn of_widths(
        moments: &Moments,
        groups: &[(usize, usize)],
        model: &dyn Fn(usize, f64) -> Option<Moments>,
        surface: &dyn Fn(usize, f64) -> Option<Moments>,
    ) -> Option<Self> {
        let sigma = moments.sigma();
        let slope = |&(g, d): &(usize, usize)| {
            let [low, high] = Self::width_factors().map(|factor| {
                Some(difference(figures(&model(g, factor)?, sigma)?, figures(&surface(g, factor)?, sigma)?))
            });
            let apart = difference(high?, low?);
            Some((d, apart.map(|apart| apart / (2.0 * WIDTH_STEP))))
        };
        Some(Self { sigma, offset: [0.0; 4], slopes: groups.iter().map(slope).collect::<Option<_>>()? })
    }

    /// Factors at which [`of_widths`](Self::of_widths) requests moments: below and above 1.
    pub(in crate::allocation) fn width_factors() -> [f64; 2] {
        [-WIDTH_STEP, WIDTH_STEP].map(libm::exp)
    }

    /// Greatest number of groups. More would take over four million points for every round. Their surfaces stay uncorrected, and no optimum
    /// is claimed.
    pub(in crate::allocation) const MOST_GROUPS: usize = 128;
    /// Greatest factor to which slopes are followed. A search within it stays clear of the kink where slopes end.
    pub(in crate::allocation) const REACH: f64 = 2.0;

    /// Corrections of the listed characteristics, with their verified moments, and the number of points of all samples.
    /// A correction is None if a sample has no moments.
    ///
    /// `at` returns the problem with a group's tolerances at a factor, and `surface` the moments of a characteristic's
    /// surface there.
    pub(in crate::allocation) fn of(
        verified: &[(usize, Moments)],
        priced: &[Priced],
        at: &dyn Fn(usize, f64) -> Option<Problem>,
        surface: &dyn Fn(usize, usize, f64) -> Option<Moments>,
        seed: u64,
        run: &Run<'_>,
    ) -> (Vec<(usize, Option<Self>)>, u64) {
        let options =
            SimulationOptions { samples: POINTS, sampler: Sampler::Sobol, seed, ..SimulationOptions::default() };
        let mut points = 0;
        // Four moments of all characteristics on both sides of every group.
        let sides: Vec<[Option<Vec<Option<Moments>>>; 2]> = (0..priced.len())
            .map(|g| {
                [-STEP, STEP].map(|step| {
                    // An error occurs before the first point.
                    let found = simulate_with(&at(g, libm::exp(step))?, &options, run, &|_| {}).ok()?;
                    points += found.run.evaluations;
                    let moments = |of: &crate::simulation::SimulatedCharacteristic| {
                        let value = |of: Option<sensitol_numeric::sampling::Estimate>| of.map(|of| of.value);
                        let [mean, sigma] = [value(of.mean)?, value(of.sigma)?];
                        Some(Moments::new(mean, sigma, value(of.skewness)?, value(of.kurtosis)? - 3.0))
                    };
                    Some(found.characteristics.iter().map(moments).collect())
                })
            })
            .collect();
        let one = |&(c, moments): &(usize, Moments)| {
            let sigma = moments.sigma();
            let offset = difference(figures(&moments, sigma)?, figures(&surface(c, 0, 1.0)?, sigma)?);
            let slope = |(g, group): (usize, &Priced)| {
                let side = |side: usize, step: f64| {
                    let model = sides[g][side].as_ref()?[c]?;
                    Some(difference(figures(&model, sigma)?, figures(&surface(c, g, libm::exp(step))?, sigma)?))
                };
                let apart = difference(side(1, STEP)?, side(0, -STEP)?);
                Some((group.members[0], apart.map(|apart| apart / (2.0 * STEP))))
            };
            let slopes = priced.iter().enumerate().map(slope).collect::<Option<_>>()?;
            Some(Self { sigma, offset, slopes })
        };
        (verified.iter().map(|of| (of.0, one(of))).collect(), points)
    }

    /// Moments of the surface at factors of all tolerances, corrected.
    pub(in crate::allocation) fn corrected(&self, moments: &Moments, factors: &[f64]) -> Option<Moments> {
        let mut by = self.offset;
        for (d, slopes) in &self.slopes {
            let ln = libm::log(factors[*d]).clamp(-FAR, FAR);
            by.iter_mut().zip(slopes).for_each(|(by, slope)| *by += slope * ln);
        }
        let (mean, sigma) = (moments.mean() + self.sigma * by[0], moments.sigma() * libm::exp(by[1]));
        let skewness = moments.skewness()? + by[2];
        // No distribution has a smaller excess.
        let excess = (moments.excess()? + by[3]).max(skewness * skewness - 2.0);
        Some(Moments::new(mean, sigma, skewness, excess))
    }
}
