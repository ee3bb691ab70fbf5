//! Incomplete gamma and beta functions next to an end of the support, as functions of the distance to it.

use crate::distribution::inverse::root;

/// Distribution near an end where its density behaves like `t^(a-1)`, with the distance `t` in the distribution's own unit.
///
/// ```text
/// gamma  P(t) = t^a e^-t / Gamma(a+1)           sum t^n / ((a+1) ... (a+n))
/// beta   P(t) = t^a (1-t)^b Gamma(a+b)/(Gamma(a+1) Gamma(b))  sum t^n (a+b) ... (a+b+n-1) / ((a+1) ... (a+n))
/// ```
///
/// Formulas: DLMF 8.7.1 and 8.17.8. Every term is positive. Exponents are small enough for the gamma functions to keep their digits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct End {
    a: f64,
    /// Exponent at the other end of a beta distribution; None for a gamma distribution.
    b: Option<f64>,
    log_factor: f64,
    /// Greatest distance for which the series is used.
    pub(super) border: f64,
}

/// `log(Gamma(b + a)/Gamma(b))`. For a large `b` it is the difference of two Stirling series, because logarithms of gamma functions have
/// lost digits there.
fn log_gamma_rise(a: f64, b: f64) -> f64 {
    if b <= LARGEST {
        return libm::lgamma(a + b) - libm::lgamma(b);
    }
    let rest = |x: f64| (1.0 / 12.0 - (1.0 / 360.0 - 1.0 / (1260.0 * x * x)) / (x * x)) / x;
    (b - 0.5) * libm::log1p(a / b) + a * (libm::log(a + b) - 1.0) + rest(a + b) - rest(b)
}

/// Greatest exponent. Above it logarithms of gamma functions lose digits, and the probability next to the end is negligible.
const LARGEST: f64 = 200.0;
/// Logarithm of the smallest positive double.
const LEAST: f64 = -745.0;

impl End {
    pub(super) fn of_gamma(a: f64) -> Option<Self> {
        (a <= LARGEST).then(|| Self { a, b: None, log_factor: -libm::lgamma(a + 1.0), border: 1.0 })
    }

    pub(super) fn of_beta(a: f64, b: f64) -> Option<Self> {
        (a <= LARGEST).then(|| {
            let log_factor = log_gamma_rise(a, b) - libm::lgamma(a + 1.0);
            // Border up to which each term is at most half the previous one.
            Self { a, b: Some(b), log_factor, border: 0.5 * ((a + 1.0) / (a + b)).min(1.0) }
        })
    }

    /// Logarithm of the constant factor of the density by `t`.
    pub(super) fn log_density_factor(&self) -> f64 {
        self.log_factor + libm::log(self.a)
    }

    fn sum(&self, t: f64) -> f64 {
        let (mut term, mut sum, mut n) = (1.0, 1.0, 0.0);
        while term > 1e-17 * sum {
            term *= t * self.b.map_or(1.0, |b| self.a + b + n) / (self.a + 1.0 + n);
            sum += term;
            n += 1.0;
        }
        sum
    }

    /// Logarithm of the mass between the end and `t`, and its slope by `log t`.
    fn log_mass(&self, t: f64) -> (f64, f64) {
        let (sum, a) = (self.sum(t), self.a);
        let (fall, slope) = match self.b {
            None => (-t, a / sum),
            Some(b) => (b * libm::log1p(-t), a / ((1.0 - t) * sum)),
        };
        (self.log_factor + a * libm::log(t) + fall + libm::log(sum), slope)
    }

    /// Mass between the end and `t`. Returns None if `t` is beyond the border.
    pub(super) fn mass(&self, t: f64) -> Option<f64> {
        let held = t <= self.border;
        held.then(|| if t > 0.0 { libm::exp(self.log_mass(t).0) } else { 0.0 })
    }

    /// Distance within which the mass is `p`. Returns None if it is beyond the border.
    pub(super) fn quantile(&self, p: f64) -> Option<f64> {
        let log_p = libm::log(p);
        if p == 0.0 {
            return Some(0.0);
        }
        if log_p.is_nan() || log_p > self.log_mass(self.border).0 {
            return None;
        }
        let top = libm::log(self.border);
        let start = (log_p - self.log_factor) / self.a;
        if start < LEAST {
            return Some(0.0);
        }
        let off = |log_t: f64| {
            let (log_mass, slope) = self.log_mass(libm::exp(log_t));
            (log_mass - log_p, slope)
        };
        Some(libm::exp(root([LEAST, top], start, off)))
    }
}
