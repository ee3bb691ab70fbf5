//! Comparison of model and surrogate at check points, which no fit has used.

use crate::assembly::EvaluationError;
use crate::plan::{DifferencePlan, KnownAnswers, Point};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::surrogate::{InputShape, Surrogate, Univariate};

/// Greatest difference three sigma out, in sigmas, that is ignored: higher powers cause such differences, and the other check points show
/// them.
const FAR: f64 = 0.1;

/// True if the model has no value at a point. An answer that was not given does not count.
pub(super) fn failed(known: &KnownAnswers, point: &Point, characteristic: usize) -> bool {
    known.error(point, characteristic).is_some_and(|error| !matches!(error, EvaluationError::NotGiven))
}

/// Statistics of the difference between model and surrogate at points of the dimensions' own distribution.
///
/// Let `d` be the model minus the surrogate and `z` the standardised surrogate. To first order in `d`, the moments of the model are those
/// of the surrogate plus
///
/// ```text
/// mean      E d
/// sigma     E [z d]
/// skewness  E [(3 z^2 - 3 - 3 g z) d] / sigma            g: skewness
/// kurtosis  E [(4 z^3 - 4 g - 4 k z) d] / sigma          k: kurtosis
/// ```
///
/// An omitted effect that is uncorrelated with these terms, such as an interaction that was not examined, adds its own variance.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct SurrogateCheck {
    /// Number of points with a value.
    pub points: usize,
    /// Number of points at which the model failed.
    pub failed: usize,
    /// Mean of the differences.
    pub mean: f64,
    /// Variance of the differences.
    pub variance: f64,
    /// Mean square of the even part of the differences at mirrored points, about the mean: interactions and even powers.
    pub even: f64,
    /// Mean square of the odd part of the differences at mirrored points: odd powers.
    pub odd: f64,
    /// Largest absolute difference.
    pub largest: f64,
    /// Share of the surrogate's own variance that is curved.
    pub curved: f64,
    /// First-order effects on mean, sigma, skewness and kurtosis, each with its standard error.
    pub effects: [(f64, f64); 4],
}

impl SurrogateCheck {
    /// Compares model and surrogate at these pairs of mirrored points. Returns None if no point has a value, or if the surrogate has none.
    pub(super) fn of(
        plan: &DifferencePlan,
        known: &KnownAnswers,
        characteristic: usize,
        pairs: &[[Point; 2]],
        (surrogate, moments): (&Surrogate, &Moments),
    ) -> Option<Self> {
        let points: Vec<&Point> = pairs.iter().flatten().collect();
        let places: Vec<Vec<f64>> = points.iter().map(|point| plan.standardised(point)).collect();
        let column = |position: usize| places.iter().map(|place| place[position]).collect::<Vec<f64>>();
        let inputs: Vec<Vec<f64>> = (0..plan.varying().len()).map(column).collect();
        let rises = surrogate.rises(&inputs)?;
        let sigma = moments.sigma();
        let [skewness, kurtosis] = [moments.skewness(), moments.kurtosis()].map(|moment| moment.unwrap_or(0.0));
        let off = moments.mean() - surrogate.centre;
        let mut differences: Vec<Option<f64>> = Vec::with_capacity(points.len());
        let mut rows: Vec<[f64; 4]> = Vec::with_capacity(points.len());
        for (point, rise) in points.iter().zip(&rises) {
            let difference = known.value(point, characteristic).map(|value| (value - surrogate.centre) - rise);
            differences.push(difference);
            let Some(d) = difference else { continue };
            let z = if sigma > 0.0 { (rise - off) / sigma } else { 0.0 };
            let per_sigma = if sigma > 0.0 { d / sigma } else { 0.0 };
            rows.push([
                d,
                z * d,
                (3.0 * z * z - 3.0 - 3.0 * skewness * z) * per_sigma,
                (4.0 * z.powi(3) - 4.0 * skewness - 4.0 * kurtosis * z) * per_sigma,
            ]);
        }
        if rows.is_empty() {
            return None;
        }
        let curved =
            |(part, shape): (&Option<Univariate>, &InputShape)| part.map(|part| part.term(shape).part(1.0).curved);
        let curved: f64 = surrogate.parts.iter().zip(plan.inputs().shapes()).filter_map(curved).sum();
        let n = rows.len() as f64;
        let effects = [0, 1, 2, 3].map(|i| {
            let mean = rows.iter().map(|row| row[i]).sum::<f64>() / n;
            let square = rows.iter().map(|row| (row[i] - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0);
            (mean, (square / n).sqrt())
        });
        let mean = effects[0].0;
        let both: Vec<[f64; 2]> = differences.chunks(2).filter_map(|pair| Some([pair[0]?, pair[1]?])).collect();
        let share = |part: &dyn Fn(&[f64; 2]) -> f64| {
            both.iter().map(|pair| part(pair).powi(2)).sum::<f64>() / both.len().max(1) as f64
        };
        Some(Self {
            points: rows.len(),
            failed: points.iter().filter(|point| failed(known, point, characteristic)).count(),
            mean,
            variance: rows.iter().map(|row| (row[0] - mean).powi(2)).sum::<f64>() / (n - 1.0).max(1.0),
            even: share(&|[a, b]| 0.5 * (a + b) - mean),
            odd: share(&|[a, b]| 0.5 * (a - b)),
            largest: rows.iter().map(|row| row[0].abs()).fold(0.0, f64::max),
            curved: if sigma > 0.0 { (curved / (sigma * sigma)).min(1.0) } else { 0.0 },
            effects,
        })
    }

    /// Size of an effect beyond its standard error, plus two thirds of the standard error for the part that the sample cannot exclude.
    pub(super) fn effect(&self, moment: usize) -> f64 {
        let (value, error) = self.effects[moment];
        (value.abs() - error).max(0.0) + 2.0 / 3.0 * error
    }

    /// Relative error of sigma that is caused three sigma out only, if the surrogate is off by `off` sigmas there. A bend that begins two
    /// sigma out and comes to 1 sigma at three takes 6 % of the variance along a line, and more across it.
    pub(super) fn far_out(off: f64) -> f64 {
        if off > FAR { 0.08 * off.min(1.0) } else { 0.0 }
    }

    /// Relative error of sigma caused by slopes and curvatures that the check points cannot exclude. Odd residuals may be correlated with
    /// the surrogate's lines, even ones with its curves, and a few points do not show this.
    pub(super) fn unseen(&self, variance: f64) -> f64 {
        let along = self.odd * (1.0 - self.curved) + self.even * self.curved;
        if variance > 0.0 { (along / variance / self.points as f64).sqrt() } else { 0.0 }
    }

    /// Size of an effect beyond two standard errors. It serves effects that residuals do not have unless the sample shows them.
    pub(super) fn shown(&self, moment: usize) -> f64 {
        let (value, error) = self.effects[moment];
        (value.abs() - 2.0 * error).max(0.0)
    }
}
