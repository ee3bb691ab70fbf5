//! Common factor of all tolerances.

use std::cell::Cell;

use crate::allocation::requirement::constraint::{Constraint, kept};
use crate::allocation::surface::response::Responses;
use sensitol_numeric::optimise::root::root;

/// Accuracy of the factor, in its logarithm.
const NEAR: f64 = 1e-10;
/// Ratio of successive factors in the search for the first one at which a requirement is broken.
const STEP: f64 = 1.02;
/// Least and greatest factor of the search.
const RANGE: [f64; 2] = [1e-4, 100.0];

/// Largest common factor of all tolerances that keeps every requirement, searched upwards or downwards from 1. Returns None if no factor
/// keeps them all, or every one does.
///
/// Derivatives are fixed, so that factors far from 1 are extrapolated.
pub(in crate::allocation) fn loosest(responses: &Responses, constraints: &[Constraint]) -> Option<f64> {
    let all: Vec<usize> = (0..responses.dimensions.len()).collect();
    loosest_of(responses, constraints, &all)
}

/// Largest common factor of these dimensions alone.
pub(in crate::allocation) fn loosest_of(
    responses: &Responses,
    constraints: &[Constraint],
    of: &[usize],
) -> Option<f64> {
    let greatest = |factor: f64| {
        let mut factors: Vec<f64> = vec![1.0; responses.dimensions.len()];
        of.iter().for_each(|&d| factors[d] = factor);
        constraints.iter().map(|constraint| constraint.value_at(responses, &factors)).fold(0.0, f64::max)
    };
    let keeps = |factor: f64| kept(greatest(factor));
    if constraints.is_empty() {
        return None;
    }
    let up = keeps(1.0);
    let (mut inside, mut outside) = (1.0, 1.0);
    loop {
        if up {
            outside = inside * STEP;
            if outside > RANGE[1] {
                return None;
            }
            if !keeps(outside) {
                break;
            }
            inside = outside;
        } else {
            inside = outside / STEP;
            if inside < RANGE[0] {
                return None;
            }
            if keeps(inside) {
                break;
            }
            outside = inside;
        }
    }
    // End of the bracket that keeps everything.
    let loosest = Cell::new(inside);
    let excess = |ln: f64| {
        let (factor, value) = (libm::exp(ln), greatest(libm::exp(ln)));
        if kept(value) && factor > loosest.get() {
            loosest.set(factor);
        }
        value - 1.0
    };
    root(excess, [libm::log(inside), libm::log(outside)], NEAR);
    Some(loosest.get())
}
