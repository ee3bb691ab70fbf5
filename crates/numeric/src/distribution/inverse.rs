//! Where an increasing function is 0: Newton's method between bounds that close in.

/// Steps that an iteration may take; five to eight when all is well, sixty when it can only halve.
const STEPS: usize = 200;

/// The root of an increasing function between `low` and `high`, to the last digits. `off` gives the value and the slope,
/// the latter 0, infinite or NaN where it is of no use. Where the function jumps over 0, the place of the jump; where it
/// is 0 on an interval, a place in it.
pub(super) fn root([mut low, mut high]: [f64; 2], start: f64, off: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut x = if start > low && start < high { start } else { 0.5 * low + 0.5 * high };
    let mut width = high - low;
    for _ in 0..STEPS {
        let (error, slope) = off(x);
        if error == 0.0 {
            return x;
        }
        if error > 0.0 {
            high = x;
        } else {
            low = x;
        }
        let newton = x - error / slope;
        // Newton's step must stay inside and at least halve the interval in the long run.
        let next =
            if newton > low && newton < high && (newton - x).abs() < width { newton } else { 0.5 * low + 0.5 * high };
        width = (next - x).abs().max(0.5 * width);
        if (next - x).abs() <= f64::EPSILON * x.abs() || next == low || next == high {
            return next;
        }
        x = next;
    }
    x
}
