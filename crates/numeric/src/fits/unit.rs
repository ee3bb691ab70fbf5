//! Standard tolerance unit of ISO 286-1.

/// Bounds of the steps of nominal sizes, in mm.
const STEPS: [f64; 14] = [0.0, 3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0];

/// Tolerance unit of a size in mm, itself in mm. A tolerance of a given number of units is equally hard to hold at any size.
///
/// ```text
/// i = 0.45 D^(1/3) + 0.001 D      up to 500 mm; D: the geometric mean of the ends of the size's step, i in micrometres, D in mm
/// I = 0.004 D + 2.1               above, with D the size itself
/// ```
///
/// Up to 3 mm, D is the root of 3. Grade IT6 is 10 units, and each further grade has 1.6 times as many. Source: ISO 286-1:2010, annex B.
pub fn tolerance_unit(nominal_mm: f64) -> f64 {
    let size = nominal_mm.abs();
    let micrometres = match STEPS.windows(2).find(|ends| size <= ends[1]) {
        Some(&[low, high]) => {
            let mean = (low.max(1.0) * high).sqrt();
            0.45 * libm::cbrt(mean) + 0.001 * mean
        }
        _ => 0.004 * size + 2.1,
    };
    1e-3 * micrometres
}

#[cfg(test)]
mod tests {
    use super::tolerance_unit;
    use crate::fits::deviations;

    /// Reference: the table of IT6 in the standard. Its values are rounded and, for the smallest and the largest sizes, raised to preferred
    /// numbers: by 0.7 um up to 6 mm, and by 1.1 um from 400 mm.
    #[test]
    fn ten_units_are_the_grade_six_of_the_tables() {
        for size in [2.0, 5.0, 8.0, 15.0, 25.0, 40.0, 60.0, 100.0, 150.0, 200.0, 300.0, 350.0, 450.0] {
            let [lower, upper] = deviations(size, "H6").unwrap();
            assert!((upper - lower - 10.0 * tolerance_unit(size)).abs() <= 1.2e-3, "{size}: {upper} {lower}");
        }
    }
}
