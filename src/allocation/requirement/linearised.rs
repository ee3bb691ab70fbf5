//! Value and slopes of a requirement, and the sum of powers that has them.

use sensitol_numeric::optimise::separable::{PowerRow, PowerTerm};

/// Value and slopes of a requirement at some tolerances. It is kept if `value` is at most 1.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct Linearised {
    pub(in crate::allocation) value: f64,
    /// Derivatives of the value by `ln T` of every group.
    pub(in crate::allocation) slopes: Vec<f64>,
    /// True if the value is linear in the tolerances, false if it is quadratic.
    linear: bool,
}

impl Linearised {
    /// Linearised requirement from its used part and the slopes of that.
    pub(in crate::allocation) fn of_uses(value: f64, slopes: Vec<f64>, linear: bool) -> Self {
        Self { value, slopes, linear }
    }

    /// Linearised requirement that grows with the squares of the tolerances.
    pub(in crate::allocation) fn of_squares(value: f64, slopes: Vec<f64>) -> Self {
        Self { value, slopes, linear: false }
    }

    /// Linearised square of a ratio, from the slopes of its logarithm. These are not read if the ratio is 0. Returns
    /// None if the ratio or a slope is not finite or unknown.
    pub(super) fn of_ratio(ratio: f64, groups: usize, ln_slopes: impl FnOnce() -> Option<Vec<f64>>) -> Option<Self> {
        if !ratio.is_finite() {
            return None;
        }
        let value = ratio * ratio;
        if value == 0.0 {
            // Nothing varies here.
            return Some(Self::of_squares(value, vec![0.0; groups]));
        }
        let slopes = ln_slopes()?.into_iter().map(|slope| 2.0 * value * slope).collect::<Vec<f64>>();
        slopes.iter().all(|slope| slope.is_finite()).then(|| Self::of_squares(value, slopes))
    }

    /// Sum of powers of the tolerances with the same value and slopes at `at`. It is exact for worst cases and for sums
    /// of squares. A term that grows as a tolerance shrinks gets its inverse square, so that the sum is convex.
    pub(in crate::allocation) fn row(&self, at: &[f64]) -> PowerRow {
        let mut constant = self.value;
        let terms = self.slopes.iter().zip(at).map(|(&slope, &t)| {
            let power = match (self.linear, slope < 0.0) {
                (true, _) => 1.0,
                (false, false) => 2.0,
                (false, true) => -2.0,
            };
            let coefficient = slope / power;
            constant -= coefficient;
            PowerTerm { coefficient, power, at: t }
        });
        let terms = terms.collect();
        PowerRow { constant, terms }
    }
}
