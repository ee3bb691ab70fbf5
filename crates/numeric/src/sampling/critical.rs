//! Quantiles of beta and Student distributions for intervals, for arguments at which the library's own search does not converge.
//!
//! Newton's method for the inverse of the incomplete beta function (Algorithm AS 109) starts at 0.0001 or above. It stays there if the
//! quantile is far smaller. Here the quantile is bracketed and bisected.

use statrs::distribution::{ContinuousCDF, Gamma, StudentsT};
use statrs::function::beta::beta_reg;

use crate::distribution::standard_normal;

/// Sum of the shapes above which the gamma or the normal distribution replaces continued fractions.
const MANY: f64 = 1e7;
/// Lesser shape above which a beta distribution with that sum is normal except for its skewness.
const LARGE: f64 = 1e4;
/// Bisections of a bracket whose ends differ by a factor of two, down to the last digit.
const BISECTIONS: usize = 54;
/// Degrees of freedom from which on four terms about the normal quantile have an error of at most 1e-12.
const NEARLY_NORMAL: f64 = 1000.0;

/// Quantile of the beta distribution with the shapes `a` and `b`, for `p` between 0 and 1.
///
/// Accuracy: 1e-8 of the quantile up to `a + b` of 1e7, 1e-5 above.
///
/// Source: M. E. Wise, Biometrika 37 (1950), for many points with few hits; the expansion of Cornish and Fisher (1938) for many hits.
pub(crate) fn beta_quantile(a: f64, b: f64, p: f64) -> f64 {
    if a > b {
        return 1.0 - beta_quantile(b, a, 1.0 - p);
    }
    if a + b > MANY && a > LARGE {
        return nearly_normal_quantile(a, b, p);
    }
    if a + b > MANY {
        let gamma = Gamma::new(a, 1.0).map_or(f64::NAN, |law| law.inverse_cdf(p));
        return 2.0 * gamma / (2.0 * b + a - 1.0 + gamma);
    }
    // Bracket the quantile between two numbers that differ by a factor of two.
    let mut low = a / (a + b);
    while low > f64::MIN_POSITIVE && beta_reg(a, b, low) > p {
        low *= 0.5;
    }
    let mut high = (2.0 * low).min(1.0);
    while high < 1.0 && beta_reg(a, b, high) < p {
        (low, high) = (high, (2.0 * high).min(1.0));
    }
    for _ in 0..BISECTIONS {
        let middle = 0.5 * (low + high);
        *if beta_reg(a, b, middle) < p { &mut low } else { &mut high } = middle;
    }
    0.5 * (low + high)
}

/// Quantile of a beta distribution with large shapes, from its mean, sigma and skewness.
fn nearly_normal_quantile(a: f64, b: f64, p: f64) -> f64 {
    let (z, sum) = (standard_normal::quantile(p), a + b);
    let sigma = (a / sum * (b / sum) / (sum + 1.0)).sqrt();
    let skewness = 2.0 * (b - a) / (sum + 2.0) * ((sum + 1.0) / a / b).sqrt();
    a / sum + sigma * (z + skewness * (z * z - 1.0) / 6.0)
}

/// Quantile of Student's distribution with this number of degrees of freedom; infinite if there are none.
///
/// Source: Abramowitz and Stegun (1964), equation 26.7.5, for many degrees of freedom.
pub fn student_quantile(p: f64, freedom: f64) -> f64 {
    if freedom < NEARLY_NORMAL {
        return StudentsT::new(0.0, 1.0, freedom).map_or(f64::INFINITY, |law| law.inverse_cdf(p));
    }
    let z = standard_normal::quantile(p);
    let square = z * z;
    let first = z * (square + 1.0) / 4.0;
    let second = z * ((5.0 * square + 16.0) * square + 3.0) / 96.0;
    let third = z * (((3.0 * square + 19.0) * square + 17.0) * square - 15.0) / 384.0;
    z + (first + (second + third / freedom) / freedom) / freedom
}

#[cfg(test)]
mod tests {
    use super::*;

    /// `I_x(1, b) = 1 - (1 - x)^b` and `I_x(a, 1) = x^a` have quantiles in closed form, however small.
    #[test]
    fn quantiles_with_a_shape_of_one_are_powers() {
        for shape in [0.5, 1.0, 3.0, 1e3, 1e6] {
            for p in [0.025, 0.5, 0.975] {
                let first = -libm::expm1(libm::log1p(-p) / shape);
                assert!((beta_quantile(1.0, shape, p) / first - 1.0).abs() < 1e-8, "1 and {shape} at {p}");
                let second = libm::pow(p, 1.0 / shape);
                assert!((beta_quantile(shape, 1.0, p) - second).abs() < 1e-8, "{shape} and 1 at {p}");
            }
        }
    }

    /// `P(X <= k)` of a Poisson variable approximates a binomial one with very many points. It is summed directly.
    #[test]
    fn many_points_are_those_of_poisson() {
        let n = 1e12;
        let high = n * beta_quantile(3.0 + 1.0, n - 3.0, 0.975);
        let sum: f64 = libm::exp(-high) * (1.0 + high + high * high / 2.0 + high * high * high / 6.0);
        assert!((sum - 0.025).abs() < 1e-8, "{high}: {sum}");
    }

    /// If half of very many points are hits, the interval is normal, about 1/2 with sigma `1/(2 sqrt(2 a + 1))`. Both methods agree where
    /// they switch.
    #[test]
    fn many_hits_among_many_points_are_normal() {
        let a: f64 = 5e7;
        let exact = 0.5 + standard_normal::quantile(0.975) / (2.0 * (2.0 * a + 1.0).sqrt());
        assert!((beta_quantile(a, a, 0.975) - exact).abs() < 1e-10);
        for [below, above] in [[[1e3, MANY - 1e3 - 1.0], [1e3, MANY - 1e3 + 1.0]], [[LARGE, 1e8], [LARGE + 1e-3, 1e8]]]
        {
            let [below, above] = [below, above].map(|[a, b]| beta_quantile(a, b, 0.975));
            assert!((below / above - 1.0).abs() < 1e-5, "{below} {above}");
        }
    }

    /// Table values (Abramowitz and Stegun, table 26.10): 2.228 with 10 degrees of freedom, 1.980 with 120, 1.960 with any number.
    #[test]
    fn student_quantiles_are_those_of_the_table() {
        for (freedom, value) in [(10.0, 2.228), (120.0, 1.980), (1e9, 1.960)] {
            assert!((student_quantile(0.975, freedom) - value).abs() < 5e-4, "{freedom}");
        }
        // Both methods agree where they switch.
        let [below, above] = [NEARLY_NORMAL - 1e-6, NEARLY_NORMAL].map(|freedom| student_quantile(0.999, freedom));
        assert!((below - above).abs() < 1e-8, "{below} {above}");
    }
}
