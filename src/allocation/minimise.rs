//! Smooth unconstrained minimisation: L-BFGS with the line search of Moré and Thuente, of the crate argmin.
//!
//! The best point seen is kept here: a line search that gives up loses nothing. A value that is not a number, or cannot be
//! computed, is infinite before argmin sees it.

use std::cell::RefCell;

use argmin::core::{CostFunction, Error, Executor, Gradient, State};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;

use super::vector::Vector;

/// Vectors that L-BFGS remembers.
const MEMORY: usize = 12;

/// Value and gradient together; None where there is none.
type Function<'a> = dyn Fn(&[f64]) -> Option<(f64, Vec<f64>)> + 'a;

/// A point with value and gradient.
struct Answer {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
}

struct Watched<'a> {
    function: &'a Function<'a>,
    /// The last point asked, which argmin asks twice: for its value and for its gradient.
    last: RefCell<Option<Answer>>,
    best: RefCell<(f64, Vec<f64>)>,
}

impl Watched<'_> {
    fn at(&self, x: &[f64]) -> (f64, Vec<f64>) {
        if let Some(known) = self.last.borrow().as_ref().filter(|known| known.x == x) {
            return (known.value, known.gradient.clone());
        }
        let found = (self.function)(x)
            .filter(|(value, gradient)| value.is_finite() && gradient.iter().all(|slope| slope.is_finite()));
        let (value, gradient) = found.unwrap_or_else(|| (f64::INFINITY, vec![0.0; x.len()]));
        if value < self.best.borrow().0 {
            *self.best.borrow_mut() = (value, x.to_vec());
        }
        *self.last.borrow_mut() = Some(Answer { x: x.to_vec(), value, gradient: gradient.clone() });
        (value, gradient)
    }
}

/// The function as argmin asks for it.
struct Asked<'a>(&'a Watched<'a>);

impl CostFunction for Asked<'_> {
    type Param = Vector;
    type Output = f64;

    fn cost(&self, x: &Self::Param) -> Result<f64, Error> {
        Ok(self.0.at(&x.0).0)
    }
}

impl Gradient for Asked<'_> {
    type Param = Vector;
    type Gradient = Vector;

    fn gradient(&self, x: &Self::Param) -> Result<Self::Gradient, Error> {
        Ok(Vector(self.0.at(&x.0).1))
    }
}

/// The best point of a descent from `start`, where the gradient is shorter than `tolerance`, or `iterations` are over, or the
/// line search finds nothing better. `start` itself where nothing is.
pub(super) fn minimised(function: &Function<'_>, start: &[f64], tolerance: f64, iterations: u64) -> Vec<f64> {
    let watched = Watched { function, last: RefCell::new(None), best: RefCell::new((f64::INFINITY, start.to_vec())) };
    let solver = LBFGS::new(MoreThuenteLineSearch::new(), MEMORY)
        .with_tolerance_grad(tolerance)
        .and_then(|solver| solver.with_tolerance_cost(0.0));
    if let (Ok(solver), true) = (solver, watched.at(start).0.is_finite()) {
        let descent = Executor::new(Asked(&watched), solver).ctrlc(false);
        // Its own end is of no interest: a point at which nothing is defined ends a line search with an error.
        let _ = descent
            .configure(|state| state.param(Vector(start.to_vec())).max_iters(iterations))
            .run()
            .map(|end| end.state.get_iter());
    }
    watched.best.into_inner().1
}
