//! Root of a function of one variable by Brent's method, of the crate argmin.
//!
//! Source: R. P. Brent, "Algorithms for Minimization without Derivatives" (1973), chapter 4: inverse quadratic
//! interpolation within a bracket, and bisection if that does not converge.

use argmin::core::{CostFunction, Error, IterState, Problem, Solver, State};
use argmin::solver::brent::BrentRoot;

/// Greatest number of steps. Interpolation takes some 10, and bisection from one power of two to the next 52.
const STEPS: usize = 200;

/// Increasing function with its values at both ends of the bracket.
struct Bracketed<F> {
    function: F,
    ends: [(f64, f64); 2],
}

impl<F: Fn(f64) -> f64> CostFunction for Bracketed<F> {
    type Param = f64;
    type Output = f64;

    fn cost(&self, x: &f64) -> Result<f64, Error> {
        let known = self.ends.iter().find(|(end, _)| end == x);
        Ok(bounded(known.map_or_else(|| (self.function)(*x), |&(_, value)| value)))
    }
}

/// Maps a value to -1 to 1 with the same sign and order, because interpolation cannot use infinite values. NaN is
/// mapped to 1, as an excess.
fn bounded(value: f64) -> f64 {
    match value {
        _ if value.is_nan() => 1.0,
        _ if value.is_infinite() => value.signum(),
        _ => value / (1.0 + value.abs()),
    }
}

/// Root of an increasing function, to `near` and the rounding of its argument. Returns the lower end if the function is
/// not negative there, and the upper end if it is not positive there.
///
/// ```
/// use sensitol_numeric::optimise::root::root;
/// assert!((root(|x| x * x - 2.0, [0.0, 2.0], 0.0) - 2f64.sqrt()).abs() < 1e-15);
/// assert_eq!(root(|x| x + 1.0, [0.0, 5.0], 0.0), 0.0);
/// ```
pub fn root(function: impl Fn(f64) -> f64, [low, high]: [f64; 2], near: f64) -> f64 {
    let at_low = function(low);
    if at_low >= 0.0 {
        return low;
    }
    let at_high = function(high);
    if at_high <= 0.0 {
        return high;
    }
    let mut problem = Problem::new(Bracketed { function, ends: [(low, at_low), (high, at_high)] });
    let mut solver = BrentRoot::new(low, high, near);
    // The executor of argmin is left out, because it takes longer than the functions here.
    let Ok((mut state, _)) = solver.init(&mut problem, IterState::new()) else { return low };
    for _ in 0..STEPS {
        match solver.next_iter(&mut problem, state) {
            Ok((next, _)) => state = next,
            Err(_) => return low,
        }
        if state.terminated() {
            break;
        }
    }
    state.get_param().copied().unwrap_or(low)
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use super::*;

    /// Roots in closed form: a cube, a logarithm over 20 decades, and a function that is infinite beyond its root.
    #[test]
    fn roots_have_their_last_digits() {
        let asked = Cell::new(0);
        let counted = |x: f64| {
            asked.set(asked.get() + 1);
            x * x * x - 2.0
        };
        let found = root(counted, [0.0, 5.0], 0.0);
        // Two roundings of the cube.
        assert!((found - 2f64.cbrt()).abs() <= 4.0 * f64::EPSILON, "{found}");
        // Bisection takes 53.
        assert!(asked.get() <= 20, "{}", asked.get());
        assert!((root(|x| (x / 3e-5f64).ln(), [1e-10, 1e10], 0.0) / 3e-5 - 1.0).abs() < 1e-14);
        let found = root(|x| if x > 2.0 { f64::INFINITY } else { x - 1.5 }, [0.0, 37.0], 1e-12);
        assert!((found - 1.5).abs() <= 1e-12, "{found}");
        // A jump has no root, but its place is found.
        let found = root(|x| if x > 2.0 { f64::INFINITY } else { -1.0 }, [0.0, 37.0], 1e-9);
        assert!((found - 2.0).abs() <= 1e-9, "{found}");
    }

    #[test]
    fn an_end_that_is_beyond_the_root_is_the_answer() {
        assert_eq!(root(|x| x + 1.0, [0.0, 5.0], 0.0), 0.0);
        assert_eq!(root(|x| x - 9.0, [0.0, 5.0], 0.0), 5.0);
    }
}
