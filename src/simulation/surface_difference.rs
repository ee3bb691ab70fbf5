//! Sums of the differences of model and surrogate at the same points, and their combination with the exact moments.
//!
//! `v` and `t` are the values of model and surrogate, standardised by the surrogate. With `n_k = v^k` if the model has a value and 0 if it
//! has none, k = 0 to 4,
//!
//! ```text
//! E[n_k] = E[t^k] + E[n_k - t^k] - sum_j b_kj (mean t^j - E[t^j])        j = 1 to 4
//! ```
//!
//! `b` comes from least squares over all points of a random sample. It is 0 for Sobol' points, whose errors depend on other properties of a
//! function than its variance. Moments are the ratios to `E[n_0]`, the share of points that have a value. Numerators and denominator are
//! controlled alike, so that points without a value cause no bias. Differences over only the points with a value would compare the model of
//! some assemblies with the surrogate of all.
//!
//! Sources: Glynn and Szechtman (2002); Owen and Zhou (2000).

use faer::{Mat, Side};

use crate::simulation::control_variate::{Outside, Twin};
use crate::simulation::replicate_error::of_replicates;
use sensitol_numeric::moments::Sampled;
use sensitol_numeric::sampling::{Estimate, FEWEST, Joint, LargestShare, LargestTerms, clopper_pearson, wilson};

/// Number of powers of the surrogate that serve as controls.
const CONTROLS: usize = 4;
/// Columns of the joint sums: `n_k - t^k` for k = 0 to 4, then the controls.
const COLUMNS: usize = 1 + 2 * CONTROLS;
/// Smallest number of points for a fit of coefficients. With fewer, the differences are used as they are.
const FITTED: u64 = 64;
/// Smallest eigenvalue of the controls that is used, relative to the greatest: smaller ones are rounding errors.
const SINGULAR: f64 = 1e-10;

/// Joint sums of all points, and counts of points at which model and surrogate disagree about the limits.
#[derive(Clone, Default)]
pub(super) struct Difference {
    sums: Joint<COLUMNS>,
    /// Points without a value of the model.
    lost: u64,
    /// Points below, and above, the limits for the model only, and for the surrogate only.
    sides: [[u64; 2]; 2],
    /// Points outside the limits for the model only, and for the surrogate only.
    only: [u64; 2],
    /// Number of points that carry the sums of `v^k`, and those of `n_k - t^k`.
    carried: [Carried; 2],
    /// Largest of the `n_k - t^k`.
    largest: [LargestTerms; CONTROLS],
}

/// Sums of the squares and the fourth powers of four terms: `(sum r^2)^2 / sum r^4` points carry a sum (Kish 1965).
#[derive(Clone, Copy, Default)]
struct Carried([[f64; 2]; CONTROLS]);

impl Carried {
    fn count(&mut self, terms: [f64; CONTROLS]) {
        for ([squares, fourths], term) in self.0.iter_mut().zip(terms) {
            let square = term * term;
            (*squares, *fourths) = (*squares + square, *fourths + square * square);
        }
    }

    fn merge(&mut self, other: &Self) {
        for (own, more) in self.0.iter_mut().zip(&other.0) {
            own.iter_mut().zip(more).for_each(|(own, more)| *own += more);
        }
    }

    /// Number of points that carry each sum, at least 1.
    fn points(&self) -> [f64; CONTROLS] {
        let points =
            |[squares, fourths]: [f64; 2]| if fourths > 0.0 { (squares * squares / fourths).max(1.0) } else { 1.0 };
        self.0.map(points)
    }
}

impl Difference {
    /// Sums of values, NaN if there is none, and the surrogate's rises at the same points.
    pub(super) fn of(values: &[f64], rises: &[f64], twin: &Twin) -> Self {
        let mut difference = Self::default();
        let mut rows = Vec::with_capacity(values.len());
        for (&value, &rise) in values.iter().zip(rises) {
            let t = (rise - (twin.moments.mean - twin.centre)) / twin.moments.sigma;
            let powers = [t, t * t, t * t * t, t * t * t * t];
            if value.is_nan() {
                difference.lost += 1;
                let [p1, p2, p3, p4] = powers;
                rows.push([-1.0, -p1, -p2, -p3, -p4, p1, p2, p3, p4]);
                difference.count(powers);
                continue;
            }
            let d = ((value - twin.centre) - rise) / twin.moments.sigma;
            let v = t + d;
            // Factorised, so that large numbers are not subtracted from each other.
            let differences = [d, d * (v + t), d * (v * v + v * t + t * t), d * (v + t) * (v * v + t * t)];
            let [d1, d2, d3, d4] = differences;
            let [p1, p2, p3, p4] = powers;
            rows.push([0.0, d1, d2, d3, d4, p1, p2, p3, p4]);
            difference.carried[0].count([v, v * v, v * v * v, v * v * v * v]);
            difference.count(differences);
            let (model, surrogate) = (twin.limits.broken(value), twin.sides(rise));
            for (side, only) in difference.sides.iter_mut().enumerate() {
                apart(model[side], surrogate[side], only);
            }
            apart(model.contains(&true), surrogate.contains(&true), &mut difference.only);
        }
        difference.sums = Joint::of(&rows);
        difference
    }

    /// Counts the differences of one point.
    fn count(&mut self, differences: [f64; CONTROLS]) {
        self.carried[1].count(differences);
        self.largest.iter_mut().zip(differences).for_each(|(largest, difference)| largest.add(difference));
    }

    pub(super) fn merge(&mut self, other: &Self) {
        self.largest.iter_mut().zip(&other.largest).for_each(|(own, more)| own.merge(more));
        self.sums.merge(&other.sums);
        self.lost += other.lost;
        let own = self.sides.iter_mut().flatten().chain(&mut self.only);
        own.zip(other.sides.iter().flatten().chain(&other.only)).for_each(|(own, more)| *own += more);
        self.carried.iter_mut().zip(&other.carried).for_each(|(own, more)| own.merge(more));
    }

    /// Share of an event for the model minus that for the surrogate, from the counts of points at which only one of them has it.
    fn net(&self, [model, surrogate]: [u64; 2]) -> f64 {
        (model as f64 - surrogate as f64) / self.sums.count() as f64
    }

    /// Number of points at which the model has a value.
    fn valid(&self) -> u64 {
        self.sums.count() - self.lost
    }
}

/// Coefficients of the controls for every `n_k`.
struct Coefficients([[f64; CONTROLS]; 1 + CONTROLS]);

impl Coefficients {
    /// Zero coefficients, which leave the differences as they are.
    fn none() -> Self {
        Self([[0.0; CONTROLS]; 1 + CONTROLS])
    }

    /// Least-squares coefficients over these points, 0 if there are too few.
    fn of(sums: &Joint<COLUMNS>) -> Self {
        let mut coefficients = [[0.0; CONTROLS]; 1 + CONTROLS];
        let products = sums.products();
        let control = |j: usize| 1 + CONTROLS + j;
        let size: [f64; CONTROLS] = std::array::from_fn(|j| products[control(j)][control(j)].sqrt());
        let constant = size.iter().any(|size| !(*size > 0.0 && size.is_finite()));
        if sums.count() < FITTED || constant {
            return Self(coefficients);
        }
        let matrix = Mat::from_fn(CONTROLS, CONTROLS, |i, j| products[control(i)][control(j)] / (size[i] * size[j]));
        let Ok(eigen) = matrix.self_adjoint_eigen(Side::Lower) else { return Self(coefficients) };
        let (vectors, values) = (eigen.U(), eigen.S());
        let greatest = (0..CONTROLS).fold(0.0, |greatest: f64, i| greatest.max(values[i]));
        for (k, row) in coefficients.iter_mut().enumerate() {
            for e in (0..CONTROLS).filter(|&e| values[e] > SINGULAR * greatest) {
                let along: f64 = (0..CONTROLS).map(|j| vectors[(j, e)] * products[k][control(j)] / size[j]).sum();
                (0..CONTROLS).for_each(|j| row[j] += vectors[(j, e)] * along / (values[e] * size[j]));
            }
        }
        Self(coefficients)
    }

    fn fitted(&self) -> bool {
        self.0.iter().flatten().any(|coefficient| *coefficient != 0.0)
    }

    /// `E[n_k]/E[n_0] - E[t^k]` from the means of some points, with their gradients by these means.
    fn moments(&self, means: &[f64; COLUMNS], twin: &Twin) -> ([f64; CONTROLS], [[f64; COLUMNS]; CONTROLS]) {
        let exact = [0.0, 1.0, twin.moments.skewness, twin.moments.kurtosis];
        let off: [f64; CONTROLS] = std::array::from_fn(|j| means[1 + CONTROLS + j] - exact[j]);
        let controlled = |k: usize| means[k] - self.0[k].iter().zip(&off).map(|(b, off)| b * off).sum::<f64>();
        let lost = controlled(0);
        let valid = 1.0 + lost;
        let differences = std::array::from_fn(|i| (controlled(i + 1) - exact[i] * lost) / valid);
        let gradient = |i: usize| -> [f64; COLUMNS] {
            let mean = exact[i] + differences[i];
            let mut by = [0.0; COLUMNS];
            (by[0], by[i + 1]) = (-mean / valid, 1.0 / valid);
            for j in 0..CONTROLS {
                by[1 + CONTROLS + j] = (mean * self.0[0][j] - self.0[i + 1][j]) / valid;
            }
            by
        };
        (differences, std::array::from_fn(gradient))
    }
}

/// Mean, sigma, skewness and kurtosis with their gradients by the four means of the differences. All but the mean are None if the variance
/// is not positive.
fn standardised(differences: &[f64; 4], twin: &Twin) -> [Option<(f64, [f64; 4])>; 4] {
    let [d1, d2, d3, d4] = *differences;
    let (m, m2, m3, m4) = (d1, 1.0 + d2, twin.moments.skewness + d3, twin.moments.kurtosis + d4);
    let mean = Some((twin.moments.mean + twin.moments.sigma * m, [twin.moments.sigma, 0.0, 0.0, 0.0]));
    let c2 = m2 - m * m;
    let c3 = m3 - 3.0 * m * m2 + 2.0 * m.powi(3);
    let c4 = m4 - 4.0 * m * m3 + 6.0 * m * m * m2 - 3.0 * m.powi(4);
    if c2.is_nan() || c2 <= 0.0 {
        return [mean, None, None, None];
    }
    // Gradients of the central moments by the four raw moments.
    let by2 = [-2.0 * m, 1.0, 0.0, 0.0];
    let by3 = [6.0 * m * m - 3.0 * m2, -3.0 * m, 1.0, 0.0];
    let by4 = [12.0 * m * m2 - 4.0 * m3 - 12.0 * m.powi(3), 6.0 * m * m, -4.0 * m, 1.0];
    let root = c2.sqrt();
    let (skewness, kurtosis) = (c3 / (c2 * root), c4 / (c2 * c2));
    let sum = |by: &[f64; 4], factor: f64, less: f64| std::array::from_fn(|i| by[i] * factor - by2[i] * less);
    [
        mean,
        Some((twin.moments.sigma * root, sum(&by2, 0.5 * twin.moments.sigma / root, 0.0))),
        Some((skewness, sum(&by3, 1.0 / (c2 * root), 1.5 * skewness / c2))),
        Some((kurtosis, sum(&by4, 1.0 / (c2 * c2), 2.0 * kurtosis / c2))),
    ]
}

/// Number of points that carry mean, sigma, skewness and kurtosis, without the surrogate and with it. A sum that a handful of points
/// carries has an uncertain error, regardless of the scatter of the replicates.
pub(super) fn carried(replicates: &[&Difference]) -> [[f64; CONTROLS]; 2] {
    pooled(replicates).carried.map(|carried| carried.points())
}

/// Shares of the largest differences in the sum of squares of each moment, and the mean square.
pub(super) fn largest(replicates: &[&Difference]) -> [(LargestShare, f64); CONTROLS] {
    /// Mean square of differences that are only rounding, in units of sigma: the largest of them are meaningless.
    const ROUNDING: f64 = 1e-20;
    pooled(replicates).largest.map(|terms| match terms.mean() {
        rounding if rounding <= ROUNDING => (LargestShare::default(), rounding),
        mean => (terms.share(), mean),
    })
}

/// Squares of `n_k - t^k` at one point, k = 1 to 4, from the value of the model and the rise of the surrogate.
pub(super) fn squares(value: f64, rise: f64, twin: &Twin) -> [f64; CONTROLS] {
    let t = (rise - (twin.moments.mean - twin.centre)) / twin.moments.sigma;
    let v = t + ((value - twin.centre) - rise) / twin.moments.sigma;
    std::array::from_fn(|k| (v.powi(k as i32 + 1) - t.powi(k as i32 + 1)).powi(2))
}

/// A moment with the surrogate as control variate.
#[derive(Debug, Clone, Copy)]
pub(super) struct Controlled {
    pub(super) estimate: Estimate,
    /// Standard error if all points were random ones.
    pub(super) random: Option<f64>,
    /// Standard error of random points without fitted coefficients.
    pub(super) unfitted: Option<f64>,
}

/// Rounding errors of mean, sigma, skewness and kurtosis, in units of double precision. The exact moments of the surrogate carry them.
const ROUNDED: f64 = 8.0;

/// Four moments from exact ones of the surrogate and sampled differences of all replicates. The standard errors come from the sample if it
/// is random, else from the replicates. Returns None if no point has a value.
pub(super) fn moments(replicates: &[&Difference], twin: &Twin) -> [Option<Controlled>; 4] {
    let all = pooled(replicates);
    if all.valid() == 0 {
        return [None; 4];
    }
    let own =
        twin.sampled.map_or([0.0; 4], |Sampled { sigma, skewness, kurtosis, .. }| [0.0, sigma, skewness, kurtosis]);
    let coefficients = if replicates.len() == 1 { Coefficients::of(&all.sums) } else { Coefficients::none() };
    let (differences, by_means) = coefficients.moments(all.sums.means(), twin);
    let found = standardised(&differences, twin);
    let known = replicates.iter().all(|one| one.valid() >= FEWEST);
    // Fitting the coefficients takes degrees of freedom from the residuals.
    let n = all.sums.count() as f64;
    let fitted = if coefficients.fitted() { ((n - 1.0) / (n - 1.0 - CONTROLS as f64)).sqrt() } else { 1.0 };
    std::array::from_fn(|moment| {
        let (value, gradient) = found[moment]?;
        let by =
            std::array::from_fn(|column| gradient.iter().zip(&by_means).map(|(by, of)| by * of[column]).sum::<f64>());
        let random = all.sums.standard_error(&by);
        let standard_error = match replicates.len() {
            1 => random,
            _ => of_replicates(replicates.iter().map(|one| {
                let means = Some(one.sums.means()).filter(|_| one.valid() > 0)?;
                standardised(&coefficients.moments(means, twin).0, twin)[moment].map(|(value, _)| value)
            })),
        };
        let plain = Coefficients::none().moments(all.sums.means(), twin).1;
        let by = std::array::from_fn(|column| gradient.iter().zip(&plain).map(|(by, of)| by * of[column]).sum::<f64>());
        let unfitted = all.sums.standard_error(&by);
        let size = value.abs() + if moment == 0 { twin.moments.sigma } else { 0.0 };
        let own = libm::hypot(own[moment], ROUNDED * f64::EPSILON * size);
        let whole = |error: Option<f64>| error.filter(|_| known).map(|error| libm::hypot(fitted * error, own));
        let estimate = Estimate { value, standard_error: whole(standard_error) };
        Some(Controlled { estimate, random: whole(random), unfitted: whole(unfitted) })
    })
}

fn pooled(replicates: &[&Difference]) -> Difference {
    let mut all = Difference::default();
    replicates.iter().for_each(|one| all.merge(one));
    all
}

/// Counts a point that has an event for the model only, or for the surrogate only.
fn apart(model: bool, surrogate: bool, only: &mut [u64; 2]) {
    match (model, surrogate) {
        (true, false) => only[0] += 1,
        (false, true) => only[1] += 1,
        _ => {}
    }
}

/// Shares outside the limits, and the interval of the share within.
pub(super) struct Shares {
    /// Shares below and above the limits.
    pub(super) outside: [f64; 2],
    /// Intervals of `outside`.
    pub(super) intervals: [[f64; 2]; 2],
    pub(super) interval: [f64; 2],
}

/// Shares outside the limits: the surrogate's own share, and the difference of the model's.
///
/// The interval combines Wilson's intervals of the surrogate's share, and of the points that only the model and only the surrogate rejects
/// (Zou and Donner 2008). So zero disagreements in the sample still leave an uncertainty. With `enough` disagreements and replicates, the
/// scatter of the replicates gives the interval. The rejects of one side have the interval of their own counts, by Clopper and Pearson.
///
/// Returns None if some points have no value, because the surrogate's share refers to all assemblies.
pub(super) fn shares(replicates: &[&Difference], outside: &Outside, enough: u64) -> Option<Shares> {
    let all = pooled(replicates);
    let (n, points) = (all.sums.count() as f64, outside.points as f64);
    if n == 0.0 || all.lost > 0 {
        return None;
    }
    let within = |hits: u64, only: &dyn Fn(&Difference) -> [u64; 2], interval: fn(f64, f64) -> [f64; 2]| {
        let (own, ends) = (hits as f64 / points, interval(hits as f64, points));
        let counts = only(&all);
        let rejected = own + all.net(counts);
        let [gained, lost] = counts.map(|count| (count as f64 / n, interval(count as f64, n)));
        let mut below = libm::hypot(gained.0 - gained.1[0], lost.1[1] - lost.0);
        let mut above = libm::hypot(gained.1[1] - gained.0, lost.0 - lost.1[0]);
        if counts[0] + counts[1] >= enough {
            let nets = replicates.iter().map(|one| (one.sums.count() > 0).then(|| one.net(only(one))));
            if let Some(error) = of_replicates(nets).filter(|&error| error > 0.0) {
                (below, above) = (2.0 * error, 2.0 * error);
            }
        }
        [rejected - libm::hypot(below, own - ends[0]), rejected + libm::hypot(above, ends[1] - own)]
    };
    let [least, most] = within(outside.hits[0] + outside.hits[1], &|one| one.only, wilson);
    let side = |side: usize| {
        let ends = within(outside.hits[side], &|one| one.sides[side], clopper_pearson);
        ends.map(|end| end.clamp(0.0, 1.0))
    };
    let share = |side: usize| (outside.hits[side] as f64 / points + all.net(all.sides[side])).clamp(0.0, 1.0);
    Some(Shares {
        outside: [0, 1].map(share),
        intervals: [0, 1].map(side),
        interval: [1.0 - most, 1.0 - least].map(|end| end.clamp(0.0, 1.0)),
    })
}
