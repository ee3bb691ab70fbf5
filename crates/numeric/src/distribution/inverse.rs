//! Root of an increasing function: Newton's method between bounds that close in.

/// Greatest number of steps. Five to eight are usual, sixty if only halving is possible.
const STEPS: usize = 200;

/// Root of an increasing function between `low` and `high`, to the last digits. `off` gives the value and the slope. A slope of 0, infinity
/// or NaN is not used. If the function jumps over 0, the result is the position of the jump. If it is 0 on an interval, the result lies in
/// that interval.
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
