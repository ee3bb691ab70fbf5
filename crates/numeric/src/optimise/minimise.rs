//! Minimisation by the crate argmin: L-BFGS with the line search of Moré and Thuente for smooth functions, and a
//! particle swarm over a box.
//!
//! The best point of a descent is kept here, so that a failed line search loses nothing. A value that is not a number,
//! or cannot be computed, is passed to argmin as infinite.
//!
//! ```text
//! v <- w v + c1 r1 (best of the particle - x) + c2 r2 (best of all - x),   x <- x + v      w = 1/(2 ln 2), c1 = c2 = 1/2 + ln 2
//! ```
//!
//! Each coordinate gets new random numbers `r1`, `r2`. A particle that leaves the box stops at its face. The swarm of
//! argmin needs random numbers of the operating system and five further crates. This one has a seed. Sources of the
//! swarm: M. Clerc, "Standard particle swarm optimisation" (2012), for the coefficients; J. Kennedy, R. C. Eberhart,
//! "Particle swarm optimization", ICNN (1995).

use std::cell::RefCell;

use argmin::core::{CostFunction, Error, Executor, Gradient, KV, PopulationState, Problem, Solver, State};
use argmin::solver::linesearch::MoreThuenteLineSearch;
use argmin::solver::quasinewton::LBFGS;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::optimise::vector::Vector;

/// Number of vectors that L-BFGS stores.
const MEMORY: usize = 12;

/// Function with value and gradient. It returns None if it is not defined.
type Function<'a> = dyn Fn(&[f64]) -> Option<(f64, Vec<f64>)> + 'a;

/// Point with value and gradient.
struct Answer {
    x: Vec<f64>,
    value: f64,
    gradient: Vec<f64>,
}

struct Watched<'a> {
    function: &'a Function<'a>,
    /// Last point. argmin evaluates it twice: for its value and for its gradient.
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

/// Wrapper with the traits of argmin.
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

/// Best point of a descent from `start`. The descent ends when the gradient is shorter than `tolerance`, after
/// `iterations`, or when the line search finds nothing better. Returns `start` if nothing is better.
///
/// ```
/// use sensitol_numeric::optimise::minimise::minimise;
/// let parabola = |x: &[f64]| Some(((x[0] - 3.0).powi(2), vec![2.0 * (x[0] - 3.0)]));
/// assert!((minimise(&parabola, &[0.0], 1e-9, 50)[0] - 3.0).abs() < 1e-9);
/// ```
pub fn minimise(function: &Function<'_>, start: &[f64], tolerance: f64, iterations: u64) -> Vec<f64> {
    let watched = Watched { function, last: RefCell::new(None), best: RefCell::new((f64::INFINITY, start.to_vec())) };
    let solver = LBFGS::new(MoreThuenteLineSearch::new(), MEMORY)
        .with_tolerance_grad(tolerance)
        .and_then(|solver| solver.with_tolerance_cost(0.0));
    if let (Ok(solver), true) = (solver, watched.at(start).0.is_finite()) {
        let descent = Executor::new(Asked(&watched), solver).ctrlc(false);
        // The end of the descent is ignored: a point without a value ends a line search with an error.
        let _ = descent
            .configure(|state| state.param(Vector(start.to_vec())).max_iters(iterations))
            .run()
            .map(|end| end.state.get_iter());
    }
    watched.best.into_inner().1
}

/// Number of particles of the swarm.
const PARTICLES: usize = 40;
/// Number of moves of each particle.
const MOVES: u64 = 60;
/// Fixed seed, so that the result depends only on the function and the bounds.
const SEED: u64 = 0x5eed_5a4a;

/// Function of a place to minimise. It is infinite if the place has no value.
type PlaceValue<'a> = dyn Fn(&[f64]) -> f64 + 'a;

#[derive(Clone)]
struct Particle {
    at: Vec<f64>,
    velocity: Vec<f64>,
    best: Vec<f64>,
    least: f64,
}

struct OfPlaces<'a>(&'a PlaceValue<'a>);

impl CostFunction for OfPlaces<'_> {
    type Param = Vector;
    type Output = f64;

    fn cost(&self, x: &Self::Param) -> Result<f64, Error> {
        let value = (self.0)(&x.0);
        Ok(if value.is_nan() { f64::INFINITY } else { value })
    }
}

struct Swarm<'a> {
    bounds: &'a [[f64; 2]],
    rng: Xoshiro256PlusPlus,
}

impl Swarm<'_> {
    fn anywhere(&mut self) -> Vec<f64> {
        let rng = &mut self.rng;
        self.bounds.iter().map(|&[low, high]| low + rng.random::<f64>() * (high - low)).collect()
    }
}

type SwarmStep = (PopulationState<Particle, f64>, Option<KV>);

impl<'a> Solver<OfPlaces<'a>, PopulationState<Particle, f64>> for Swarm<'_> {
    fn name(&self) -> &'static str {
        "particle swarm"
    }

    fn init(
        &mut self,
        problem: &mut Problem<OfPlaces<'a>>,
        state: PopulationState<Particle, f64>,
    ) -> Result<SwarmStep, Error> {
        let mut particles = Vec::with_capacity(PARTICLES);
        for _ in 0..PARTICLES {
            let (at, to) = (self.anywhere(), self.anywhere());
            // Half of the way to another place.
            let velocity = at.iter().zip(&to).map(|(at, to)| 0.5 * (to - at)).collect();
            let least = problem.cost(&Vector(at.clone()))?;
            particles.push(Particle { best: at.clone(), at, velocity, least });
        }
        Ok((with_best(state, particles), None))
    }

    fn next_iter(
        &mut self,
        problem: &mut Problem<OfPlaces<'a>>,
        mut state: PopulationState<Particle, f64>,
    ) -> Result<SwarmStep, Error> {
        let mut particles = state.take_population().unwrap_or_default();
        let best = least_of(&particles).map(|particle| particle.best.clone()).unwrap_or_default();
        let (inertia, pull) = (0.5 / std::f64::consts::LN_2, 0.5 + std::f64::consts::LN_2);
        for particle in &mut particles {
            for (j, &[low, high]) in self.bounds.iter().enumerate() {
                let x = particle.at[j];
                let own = pull * self.rng.random::<f64>() * (particle.best[j] - x);
                let all = pull * self.rng.random::<f64>() * (best[j] - x);
                let to = x + inertia * particle.velocity[j] + own + all;
                particle.at[j] = to.clamp(low, high);
                particle.velocity[j] = if to == particle.at[j] { to - x } else { 0.0 };
            }
            let value = problem.cost(&Vector(particle.at.clone()))?;
            if value < particle.least {
                (particle.least, particle.best) = (value, particle.at.clone());
            }
        }
        Ok((with_best(state, particles), None))
    }
}

fn least_of(particles: &[Particle]) -> Option<&Particle> {
    particles.iter().min_by(|a, b| a.least.total_cmp(&b.least))
}

fn with_best(state: PopulationState<Particle, f64>, particles: Vec<Particle>) -> PopulationState<Particle, f64> {
    match least_of(&particles).cloned() {
        Some(best) => state.cost(best.least).individual(best).population(particles),
        None => state,
    }
}

/// Best place of a swarm within these bounds. Returns None if no particle found a value.
pub fn minimise_by_swarm(function: &PlaceValue<'_>, bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
    let swarm = Swarm { bounds, rng: Xoshiro256PlusPlus::seed_from_u64(SEED) };
    let flight = Executor::new(OfPlaces(function), swarm).ctrlc(false).configure(|state| state.max_iters(MOVES));
    let best = flight.run().ok()?.state.best_individual?;
    best.least.is_finite().then_some(best.best)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Rastrigin's function has 11 minima along every coordinate. A descent ends at the nearest, the swarm in the
    /// valley of the least.
    #[test]
    fn a_swarm_leaves_valleys_that_a_descent_ends_in() {
        let turn = std::f64::consts::TAU;
        let rastrigin = |x: &[f64]| -> f64 {
            x.iter().map(|x| (x - 1.0) * (x - 1.0) + 10.0 - 10.0 * (turn * (x - 1.0)).cos()).sum()
        };
        let found = minimise_by_swarm(&rastrigin, &[[-5.0, 5.0]; 2]).unwrap();
        assert!(found.iter().all(|x| (x - 1.0).abs() < 0.5), "{found:?}");
        // The result is reproducible, keeps its bounds, and needs no values in most of the box.
        assert_eq!(found, minimise_by_swarm(&rastrigin, &[[-5.0, 5.0]; 2]).unwrap());
        let partly = |x: &[f64]| if x[0] > 3.0 { f64::NAN } else { -x[0] };
        let found = minimise_by_swarm(&partly, &[[0.0, 8.0]]).unwrap();
        assert!(found[0] <= 3.0 && found[0] > 2.9, "{found:?}");
        assert!(minimise_by_swarm(&|_| f64::NAN, &[[0.0, 1.0]]).is_none());
    }
}
