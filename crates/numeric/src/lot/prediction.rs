//! Measured assemblies against a prediction from parts, both with the uncertainty of their numbers.

use crate::distribution::standard_normal;
use crate::lot::column::box_freedom;
use crate::lot::reference_law::{chi_squared_two_sided, fisher_sf, student_two_sided};
use crate::lot::{LotSample, LotTest, SIDE};
use crate::sampling::student_quantile;

/// Degrees of freedom that count as infinitely many.
const MANY: f64 = 1e9;

/// A measured dimension in the variance of a characteristic.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPart {
    /// Change of the characteristic by one measured sigma, with its sign.
    pub effect: f64,
    /// Variance that the curvature adds.
    pub curvature: f64,
    /// Number of measured values.
    pub count: usize,
    /// Excess kurtosis of the dimension.
    pub excess: f64,
}

/// Two measured dimensions that vary together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MeasuredPair {
    /// Places of the two among the measured parts.
    pub parts: [usize; 2],
    /// Correlation in the prediction.
    pub correlation: f64,
    /// True if the correlation is that of the rows, and not an assumed one.
    pub estimated: bool,
    /// Rows in which both are measured; 0 if they are of different tables.
    pub rows: usize,
}

/// Predicted variance of a characteristic, with the uncertainty of the numbers of measured parts.
///
/// The predicted variance is a linear form `sum w_ij S_ij` of the measured covariances, as far as their errors go. Its own variance is
/// `2 tr(W S W S)/(n - 1)` for normal parts, also if the parts are correlated.
///
/// Source: F. E. Satterthwaite, An approximate distribution of estimates of variance components, Biometrics Bulletin 2 (1946);
/// T. W. Anderson, An Introduction to Multivariate Statistical Analysis, 3rd edition (2003), section 7.3.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PredictedVariance {
    total: f64,
    of_mean: f64,
    freedom: f64,
    freedom_of_mean: f64,
}

impl PredictedVariance {
    /// Variance without measured parts, taken as known.
    pub fn known(total: f64) -> Self {
        Self { total, of_mean: 0.0, freedom: MANY, freedom_of_mean: MANY }
    }

    /// Variance with measured parts. All that they do not explain is taken as known.
    ///
    /// ```
    /// use sensitol_numeric::lot::{MeasuredPair, MeasuredPart, PredictedVariance};
    /// // A difference of two parts of the same rows, which cancel each other almost.
    /// let part = |effect| MeasuredPart { effect, curvature: 0.0, count: 51, excess: 0.0 };
    /// let pair = MeasuredPair { parts: [0, 1], correlation: 0.96, estimated: true, rows: 51 };
    /// let found = PredictedVariance::of(0.08, &[part(1.0), part(-1.0)], &[pair]);
    /// assert!((found.of_mean() - 0.08 / 51.0).abs() < 1e-15 && (found.freedom() - 50.0).abs() < 1e-9);
    /// ```
    pub fn of(total: f64, parts: &[MeasuredPart], pairs: &[MeasuredPair]) -> Self {
        let size = parts.len();
        let zeros = vec![vec![0.0; size]; size];
        let (mut spread, mut mean, mut errors) = (zeros.clone(), zeros.clone(), zeros);
        let mut of_mean = 0.0;
        for (place, part) in parts.iter().enumerate() {
            let count = part.count as f64;
            // The variance by the curvature goes with the fourth power of sigma, so that its relative error is twice as large.
            spread[place][place] = part.effect.powi(2) + 2.0 * part.curvature;
            mean[place][place] = spread[place][place] / count;
            errors[place][place] = (1.0 / box_freedom(count, part.excess)).sqrt();
            of_mean += (part.effect.powi(2) + part.curvature) / count;
        }
        for pair in pairs {
            let [a, b] = pair.parts;
            let (rows, counts) = (pair.rows as f64, [a, b].map(|place| parts[place].count as f64));
            let product = parts[a].effect * parts[b].effect;
            let common = rows / (counts[0] * counts[1]);
            of_mean += 2.0 * product * pair.correlation * common;
            if pair.estimated {
                for (row, column) in [(a, b), (b, a)] {
                    spread[row][column] += product;
                    mean[row][column] += product * common;
                }
            } else {
                for place in [a, b] {
                    spread[place][place] += product * pair.correlation;
                    mean[place][place] += product * pair.correlation * common;
                }
            }
            let both = (rows - 1.0).max(0.0) / ((counts[0] - 1.0) * (counts[1] - 1.0));
            errors[a][b] = pair.correlation * both.sqrt();
            errors[b][a] = errors[a][b];
        }
        let of_mean = of_mean.max(0.0);
        Self {
            total,
            of_mean,
            freedom: freedom_of(total, &spread, &errors),
            freedom_of_mean: freedom_of(of_mean, &mean, &errors),
        }
    }

    /// Predicted variance.
    pub fn total(&self) -> f64 {
        self.total
    }

    /// Variance of the predicted mean.
    pub fn of_mean(&self) -> f64 {
        self.of_mean
    }

    /// Degrees of freedom of the predicted variance.
    pub fn freedom(&self) -> f64 {
        self.freedom
    }

    /// 95 % interval of a predicted mean, from the numbers of measured parts.
    pub fn mean_interval(&self, mean: f64) -> [f64; 2] {
        let half = student_quantile(1.0 - SIDE, self.freedom_of_mean) * self.of_mean.sqrt();
        [mean - half, mean + half]
    }

    /// True for mean and sigma each if the measured parts alone show a change from an assumed prediction, at 5 % each.
    pub fn changes(&self, mean: f64, assumed_mean: f64, assumed_variance: f64) -> [bool; 2] {
        let [low, high] = self.mean_interval(mean);
        let ratio = self.freedom * self.total / assumed_variance;
        let measured = self.of_mean > 0.0;
        [
            measured && !(low..=high).contains(&assumed_mean),
            measured && chi_squared_two_sided(ratio, self.freedom) <= 2.0 * SIDE,
        ]
    }
}

/// Degrees of freedom of an estimate that is a linear form of measured covariances, by the trace of `W S W S`.
fn freedom_of(total: f64, weights: &[Vec<f64>], errors: &[Vec<f64>]) -> f64 {
    let size = weights.len();
    let product = |row: usize, column: usize| (0..size).map(|k| weights[row][k] * errors[k][column]).sum::<f64>();
    let products: Vec<Vec<f64>> = (0..size).map(|row| (0..size).map(|column| product(row, column)).collect()).collect();
    let trace: f64 =
        (0..size).flat_map(|a| (0..size).map(move |b| (a, b))).map(|(a, b)| products[a][b] * products[b][a]).sum();
    if trace > 0.0 && total > 0.0 { (total * total / trace).min(MANY) } else { MANY }
}

/// Test of the mean of measured assemblies against a predicted mean.
///
/// Source: B. L. Welch, The generalization of "Student's" problem when several different population variances are involved,
/// Biometrika 34 (1947).
pub fn compare_means(measured: &LotSample, predicted: f64, variance: &PredictedVariance) -> LotTest {
    let n = measured.count() as f64;
    let own = measured.sigma().powi(2) / n;
    let whole = own + variance.of_mean;
    let parts = variance.of_mean.powi(2) / variance.freedom_of_mean;
    let freedom = (whole * whole / (own * own / (n - 1.0) + parts)).min(MANY);
    LotTest::of(student_two_sided((measured.mean() - predicted) / whole.sqrt(), freedom))
}

/// Two-sided test of the variance of measured assemblies against a predicted one, with the [degrees of freedom](LotSample::freedom) of the
/// predicted excess kurtosis.
pub fn compare_spreads(measured: &LotSample, variance: &PredictedVariance, excess: f64) -> LotTest {
    let freedom = [measured.freedom(excess), variance.freedom];
    let ratio = measured.sigma().powi(2) / variance.total;
    let above = fisher_sf(ratio, freedom);
    let below = fisher_sf(1.0 / ratio, [freedom[1], freedom[0]]);
    LotTest::of((2.0 * above.min(below)).min(1.0))
}

/// Points of the distribution of mean and sigma.
const POINTS: u32 = 4096;
/// Steps of the lattice in the unit square: powers of the inverse of the plastic number, whose multiples are spread evenly.
const STEPS: [f64; 2] = [0.754_877_666_246_692_8, 0.569_840_290_998_053_3];

/// 95 % interval of a predicted yield from the number of measured parts, with the predicted reject rates below and above. Returns None
/// without a reject rate.
///
/// Mean and variance of the characteristic are drawn around their predictions, the variance by its degrees of freedom (chi-squared, by
/// Wilson and Hilferty 1931) and the mean as a normal variable. Each reject rate moves as that of a normal tail at the same distance.
pub fn predicted_yield_interval(rejects: [Option<f64>; 2], variance: &PredictedVariance) -> Option<[f64; 2]> {
    rejects.iter().flatten().next()?;
    let freedom = variance.freedom;
    let sigma_of_mean = (variance.of_mean / variance.total).sqrt();
    let distances = rejects.map(|rejected| rejected.map(|p| standard_normal::upper_quantile(p.clamp(1e-300, 1.0))));
    let ninth = 2.0 / (9.0 * freedom);
    let mut yields: Vec<f64> = (1..=POINTS)
        .map(|point| {
            let [a, b] = STEPS.map(|step| standard_normal::quantile((0.5 + f64::from(point) * step).fract().max(1e-9)));
            let cube = (1.0 - ninth + a * ninth.sqrt()).max(1e-3);
            let spread = 1.0 / (cube * cube * cube).sqrt();
            let off = b * sigma_of_mean * spread;
            let rejected = |(distance, side): (Option<f64>, f64)| {
                distance.map_or(0.0, |distance| standard_normal::sf((distance + side * off) / spread))
            };
            1.0 - distances.into_iter().zip([1.0, -1.0]).map(rejected).sum::<f64>()
        })
        .collect();
    yields.sort_unstable_by(f64::total_cmp);
    let place = |share: f64| yields[(share * f64::from(POINTS)) as usize];
    Some([place(SIDE).max(0.0), place(1.0 - SIDE).min(1.0)])
}
