//! Brent's search for a minimum in a bracket, one place at a time.

/// Width of the bracket at the end, as part of the range: half the digits of a double, which give the minimum all digits.
const TOLERANCE: f64 = 1e-9;
/// Smaller part of the golden section.
const GOLDEN: f64 = 0.381_966_011_250_105_1;

/// Search in a bracket. The caller evaluates each place: [`next_place`](Self::next_place), then [`observe`](Self::observe).
///
/// Source: R. P. Brent, Algorithms for Minimization Without Derivatives (1973), chapter 5.
#[derive(Debug, Clone)]
pub(super) struct BrentSearch {
    /// Ends of the bracket.
    bracket: [f64; 2],
    /// The three lowest places with their values, the lowest first.
    lowest: [(f64, f64); 3],
    /// Last step, and the one before it.
    steps: [f64; 2],
    tolerance: f64,
    done: bool,
}

impl BrentSearch {
    /// Search between two places, from a third one with a value that is not above theirs. `range` is the whole range.
    pub(super) fn new(ends: [(f64, f64); 2], lowest: (f64, f64), range: f64) -> Self {
        let [low, high] = ends;
        let width = high.0 - low.0;
        let (second, third) = if low.1 <= high.1 { (low, high) } else { (high, low) };
        let mut search = Self {
            bracket: [low.0, high.0],
            lowest: [lowest, second, third],
            steps: [width; 2],
            tolerance: TOLERANCE * range,
            done: false,
        };
        search.check();
        search
    }

    pub(super) fn is_done(&self) -> bool {
        self.done
    }

    /// Lowest place so far, with its value.
    pub(super) fn best(&self) -> (f64, f64) {
        self.lowest[0]
    }

    /// Place to evaluate next: the vertex of a parabola through the three lowest places, or a golden section of the bracket.
    pub(super) fn next_place(&mut self) -> f64 {
        let [low, high] = self.bracket;
        let [(x, fx), (w, fw), (v, fv)] = self.lowest;
        let middle = 0.5 * (low + high);
        let mut step = None;
        let (r, q) = ((x - w) * (fx - fv), (x - v) * (fx - fw));
        let (above, below) = ((x - v) * q - (x - w) * r, 2.0 * (q - r));
        let parabolic = -above / below;
        let short = parabolic.abs() < 0.5 * self.steps[1].abs();
        if short && low < x + parabolic && x + parabolic < high {
            let near = x + parabolic - low < 2.0 * self.tolerance || high - x - parabolic < 2.0 * self.tolerance;
            step = Some(if near { self.tolerance.copysign(middle - x) } else { parabolic });
        }
        let longer = if x < middle { high - x } else { low - x };
        let (taken, before) = match step {
            Some(step) => (step, self.steps[0]),
            None => (GOLDEN * longer, longer),
        };
        self.steps = [taken, before];
        let moved = if taken.abs() < self.tolerance { self.tolerance.copysign(taken) } else { taken };
        (x + moved).clamp(low, high)
    }

    /// Takes the value of the place that was evaluated.
    pub(super) fn observe(&mut self, place: f64, value: f64) {
        let [(x, fx), second, third] = self.lowest;
        if value <= fx {
            self.bracket[usize::from(place < x)] = x;
            self.lowest = [(place, value), (x, fx), second];
        } else {
            self.bracket[usize::from(place > x)] = place;
            if value <= second.1 || second.0 == x {
                self.lowest = [(x, fx), (place, value), second];
            } else if value <= third.1 || third.0 == x || third.0 == second.0 {
                self.lowest[2] = (place, value);
            }
        }
        self.check();
    }

    /// Ends the search once both ends of the bracket are near the lowest place.
    fn check(&mut self) {
        let [low, high] = self.bracket;
        let x = self.lowest[0].0;
        self.done = (x - low).max(high - x) <= 2.0 * self.tolerance;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn minimum(function: impl Fn(f64) -> f64, ends: [f64; 2], start: f64) -> (f64, f64, usize) {
        let at = |x: f64| (x, function(x));
        let mut search = BrentSearch::new(ends.map(at), at(start), 1.0);
        let mut count = 0;
        while !search.is_done() && count < 100 {
            let place = search.next_place();
            search.observe(place, function(place));
            count += 1;
        }
        (search.best().0, search.best().1, count)
    }

    /// The least of `cosh(x - c)` is 1. Rounding of the value leaves its place open by `sqrt(2 epsilon)`, 2e-8.
    #[test]
    fn a_smooth_minimum_is_found_in_a_dozen_places() {
        let (x, value, count) = minimum(|x| (x - 0.0123f64).cosh(), [-0.1, 0.1], 0.0);
        assert!((x - 0.0123).abs() < 3e-8, "{x}");
        assert!((value - 1.0).abs() < 1e-15 && count <= 20, "{count}");
    }

    /// The golden section takes `ln(1e-8)/ln(0.618)`, 39 places.
    #[test]
    fn a_kink_is_found_by_the_golden_section() {
        let (x, value, count) = minimum(|x| (x - 0.0123f64).abs(), [-0.1, 0.1], 0.0);
        assert!((x - 0.0123).abs() < 3e-9 && value < 3e-9, "{x}");
        assert!(count <= 60, "{count}");
    }

    /// The lowest place is the end itself, where the search began.
    #[test]
    fn a_minimum_at_an_end_stays_there() {
        let (x, value, _) = minimum(f64::exp, [0.0, 0.1], 0.0);
        assert_eq!((x, value), (0.0, 1.0));
    }
}
