//! Surface of a formula that is a polynomial. It consists of the terms of the formula, so that no derivative is evaluated or estimated.
//!
//! A surface holds powers of one dimension up to the fourth, and products of two dimensions. A formula without other terms is its own
//! surface, and has the moments of that surface.

use std::collections::BTreeMap;

use crate::method::{DerivativeSource, Fitted, Options, Order};
use crate::plan::{Mixed, Plan};
use crate::problem::Problem;
use sensitol_numeric::distribution::StandardMoments;
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{InputShape, Surrogate, Univariate};

/// Terms of one characteristic's formula, over the varying dimensions in sigmas.
#[derive(Debug, Clone)]
pub(super) struct PolynomialSurface {
    /// Powers of every varying dimension by itself.
    pub(super) parts: Vec<Univariate>,
    /// Products of two dimensions, without those that are 0.
    pub(super) products: BTreeMap<(usize, usize), Mixed>,
    /// Highest degree of the terms.
    pub(super) degree: u32,
    /// Bounds of the errors of mean and sigma from rounding of the coefficients.
    pub(super) rounding: [f64; 2],
}

impl PolynomialSurface {
    /// Returns the surfaces of all characteristics. Returns None for a formula that is not known to be a polynomial, for one with terms
    /// that no surface holds, and if differences are requested.
    pub(super) fn all(problem: &Problem, plan: &dyn Plan, options: &Options) -> Vec<Option<Self>> {
        if options.derivatives == Some(DerivativeSource::Difference) {
            return vec![None; problem.characteristics().len()];
        }
        let dimensions = problem.dimensions();
        let centre: Vec<f64> = dimensions.iter().map(|dimension| dimension.mean()).collect();
        let scale: Vec<f64> = dimensions.iter().map(|dimension| dimension.sigma()).collect();
        let surface = |&output: &usize| {
            let polynomial = problem.function().polynomial(output, &centre, &scale)?;
            let mut terms = Terms::new(plan.varying(), plan.inputs().shapes());
            polynomial.terms().try_for_each(|(inputs, of)| terms.add(inputs, of.value, of.error))?;
            Some(terms.finished())
        };
        problem.outputs().iter().map(surface).collect()
    }

    /// Returns the mixed derivative of two positions.
    pub(super) fn mixed(&self, pair: (usize, usize)) -> Mixed {
        self.products.get(&pair).copied().unwrap_or(Mixed::exact(0.0))
    }

    /// Replaces the coefficients that points have determined already by exact ones, so that they change by rounding only.
    pub(super) fn replace(&self, fitted: &mut Fitted, plan: &dyn Plan, order: Order, pairs: &[(usize, usize)]) {
        for (own, &d) in self.parts.iter().zip(plan.varying()) {
            // A polynomial through as many nodes as its degree is the part itself.
            if fitted.parts[d].is_some_and(|part| part.degree() >= own.highest_power()) {
                fitted.parts[d] = Some(*own);
            }
        }
        for (&pair, mixed) in pairs.iter().zip(&mut fitted.mixed) {
            *mixed = mixed.map(|mixed| if mixed.complete { self.mixed(pair) } else { mixed });
        }
        let parts: Vec<Option<Univariate>> =
            plan.varying().iter().map(|&d| fitted.parts[d].map(|part| order.used(part))).collect();
        let products =
            pairs.iter().zip(&fitted.mixed).filter_map(|(&(j, k), mixed)| Some((j, k, mixed.as_ref()?.value)));
        let interactions = Interactions::of_pairs(parts.len(), products.filter(|&(.., value)| value != 0.0));
        if let Some(surrogate) = &mut fitted.surrogate {
            (surrogate.parts, surrogate.interactions) = (parts, interactions);
        }
    }

    /// True if a surface has all of these terms, and no other.
    pub(super) fn is(&self, surface: &Surrogate) -> bool {
        let same = |(own, part): (&Univariate, &Option<Univariate>)| {
            part.is_some_and(|part| part.coefficients() == own.coefficients())
        };
        let products = self.products.iter().map(|(&(j, k), of)| (j, k, of.value));
        self.parts.iter().zip(&surface.parts).all(same) && products.eq(surface.interactions.each_pair())
    }
}

/// Terms of a formula, while they are collected.
struct Terms<'a> {
    varying: &'a [usize],
    shapes: &'a [InputShape],
    coefficients: Vec<[f64; Univariate::DEGREE]>,
    products: BTreeMap<(usize, usize), Mixed>,
    degree: u32,
    rounding: [f64; 2],
}

impl<'a> Terms<'a> {
    fn new(varying: &'a [usize], shapes: &'a [InputShape]) -> Self {
        let coefficients = vec![[0.0; Univariate::DEGREE]; varying.len()];
        Self { varying, shapes, coefficients, products: BTreeMap::new(), degree: 0, rounding: [0.0; 2] }
    }

    /// Adds a term. Returns None if no surface can hold it.
    fn add(&mut self, inputs: &[u32], value: f64, error: f64) -> Option<()> {
        let position = |input: &u32| self.varying.binary_search(&(*input as usize)).ok();
        let positions: Vec<usize> = inputs.iter().map(position).collect::<Option<_>>()?;
        // A coefficient smaller than its own rounding error is left out. The error then includes its size.
        let (value, error) = if value.abs() <= error { (0.0, error + value.abs()) } else { (value, error) };
        if error > 0.0 {
            let powers = positions.chunk_by(|a, b| a == b).map(|of| (of[0], of.len()));
            let moments = powers.map(|(position, power)| of_power(&self.shapes[position].moments, power));
            let [mean, square] = moments.fold([1.0, 1.0], |[mean, square], [a, b]| [mean * a, square * b]);
            self.rounding[0] += error * mean.abs();
            self.rounding[1] += error * (square - mean * mean).max(0.0).sqrt();
        }
        if value == 0.0 || positions.is_empty() {
            return Some(());
        }
        self.degree = self.degree.max(positions.len() as u32);
        match positions[..] {
            [j, k] if j != k => {
                self.products.insert((j, k), Mixed::exact(value));
            }
            [first, ..] if positions.iter().all(|&other| other == first) => {
                self.coefficients[first][positions.len() - 1] = value;
            }
            _ => return None,
        }
        Some(())
    }

    fn finished(self) -> PolynomialSurface {
        let Self { coefficients, products, degree, rounding, .. } = self;
        // A straight line is stored as a parabola with curvature 0.
        let known = |of: &[f64]| of.iter().rposition(|of| *of != 0.0).map_or(0, |place| place + 1).max(2);
        let part = |of: &[f64; Univariate::DEGREE]| Univariate::of_coefficients(&of[..known(of)]);
        PolynomialSurface { parts: coefficients.iter().map(part).collect(), products, degree, rounding }
    }
}

/// Returns `E u^power` and `E u^(2 power)` of a standardised input.
fn of_power(moments: &StandardMoments, power: usize) -> [f64; 2] {
    let raw = moments.raw();
    [raw[power], raw[2 * power]]
}
