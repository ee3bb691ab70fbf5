//! Numbers that were computed from the decimals of a study.

/// A number without what rounding leaves of sums of decimals.
pub(super) fn decimal(value: f64) -> f64 {
    format!("{value:.14e}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests {
    use super::decimal;

    #[test]
    fn what_rounding_leaves_of_a_sum_goes_and_a_fraction_stays() {
        assert_eq!(decimal(0.1 + 0.2), 0.3);
        assert_eq!(decimal(-(1.1 * 1.1)), -1.21);
        assert!((decimal(1.0 / 3.0) - 1.0 / 3.0).abs() < 1e-15);
        assert!(decimal(f64::NAN).is_nan() && decimal(f64::INFINITY) == f64::INFINITY);
    }
}
