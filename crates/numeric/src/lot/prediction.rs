//! Measured assemblies against a prediction from parts, both with the uncertainty of their numbers.

use crate::distribution::standard_normal;
use crate::lot::reference_law::{fisher_sf, student_two_sided};
use crate::lot::{LotSample, LotTest, SIDE};
use crate::sampling::student_quantile;

/// Degrees of freedom that count as infinitely many.
const MANY: f64 = 1e9;

/// Predicted variance of a characteristic, as a sum of parts known by samples and of parts that are assumed.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PredictedVariance {
    /// Variance that each measured dimension adds, and the number of its values.
    pub measured: Vec<(f64, usize)>,
    /// Variance of everything else, taken as known.
    pub assumed: f64,
}

impl PredictedVariance {
    /// Predicted variance.
    pub fn total(&self) -> f64 {
        self.assumed + self.measured.iter().map(|(variance, _)| variance).sum::<f64>()
    }

    /// Variance of the predicted mean.
    fn of_mean(&self) -> f64 {
        self.measured.iter().map(|(variance, count)| variance / *count as f64).sum()
    }

    /// 95 % interval of a predicted mean, from the numbers of measured parts.
    pub fn mean_interval(&self, mean: f64) -> [f64; 2] {
        let half = student_quantile(1.0 - SIDE, self.freedom()) * self.of_mean().sqrt();
        [mean - half, mean + half]
    }

    /// Degrees of freedom of the predicted variance.
    ///
    /// Source: F. E. Satterthwaite, An approximate distribution of estimates of variance components, Biometrics Bulletin 2 (1946).
    fn freedom(&self) -> f64 {
        let parts: f64 =
            self.measured.iter().map(|(variance, count)| variance * variance / (*count as f64 - 1.0)).sum();
        if parts > 0.0 { (self.total().powi(2) / parts).min(MANY) } else { MANY }
    }
}

/// Test of the mean of measured assemblies against a predicted mean.
///
/// Source: B. L. Welch, The generalization of "Student's" problem when several different population variances are involved,
/// Biometrika 34 (1947).
pub fn compare_means(measured: &LotSample, predicted: f64, variance: &PredictedVariance) -> LotTest {
    let n = measured.count() as f64;
    let own = measured.sigma().powi(2) / n;
    let whole = own + variance.of_mean();
    let parts: f64 =
        (variance.measured.iter()).map(|(part, count)| (part / *count as f64).powi(2) / (*count as f64 - 1.0)).sum();
    let freedom = (whole * whole / (own * own / (n - 1.0) + parts)).min(MANY);
    LotTest::of(student_two_sided((measured.mean() - predicted) / whole.sqrt(), freedom))
}

/// Two-sided test of the variance of measured assemblies against a predicted one.
pub fn compare_spreads(measured: &LotSample, variance: &PredictedVariance) -> LotTest {
    let freedom = [measured.count() as f64 - 1.0, variance.freedom()];
    let ratio = measured.sigma().powi(2) / variance.total();
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
    let freedom = variance.freedom();
    let sigma_of_mean = (variance.of_mean() / variance.total()).sqrt();
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
