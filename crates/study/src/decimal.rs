//! Rounds numbers that were computed from the decimals of a study.

/// Significant digits of numbers in formulas and tables.
pub(super) const KEPT: usize = 15;
/// Significant digits of numbers in messages. Fewer, since a difference of decimals may have lost some.
pub(super) const SAID: usize = 13;

/// Number rounded to significant digits, which removes the rounding errors of sums of decimals.
pub(super) fn decimal(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::{KEPT, SAID, decimal};

    #[test]
    fn what_rounding_leaves_of_a_sum_goes_and_a_fraction_stays() {
        assert_eq!(decimal(0.1 + 0.2, KEPT), 0.3);
        assert_eq!(decimal(-(1.1 * 1.1), KEPT), -1.21);
        assert_eq!(decimal(9.9 - 10.0, SAID), -0.1);
        assert!((decimal(1.0 / 3.0, KEPT) - 1.0 / 3.0).abs() < 1e-15);
        assert!(decimal(f64::NAN, KEPT).is_nan() && decimal(f64::INFINITY, KEPT) == f64::INFINITY);
    }
}
