//! Exact derivatives that replace differences.

use std::collections::HashMap;

use crate::assembly::{Derivatives, Directions};
use crate::method::{DerivativeSource, MethodError, Options, Order};
use crate::plan::{DifferencePlan, Mixed, Plan};
use crate::problem::Problem;
use sensitol_numeric::power::{Power, Wide};
use sensitol_numeric::surrogate::Univariate;

/// Exact derivatives of one characteristic at the means; None for a derivative that does not exist.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct ExactDerivatives {
    /// First derivatives by every dimension of the problem, in order; None also for dimensions that were not requested.
    pub first: Vec<Option<f64>>,
    /// Second derivatives by every dimension of the problem, in order.
    pub second: Vec<Option<f64>>,
    /// Mixed derivatives of every pair that was examined.
    pub mixed: Vec<Option<f64>>,
    /// Unit of every dimension in which the derivatives are taken, a power of two; 1 for a dimension of ordinary size.
    pub(crate) units: Vec<Power>,
}

/// Returns the units of all dimensions in which exact derivatives are taken.
pub(super) fn units(plan: &dyn Plan) -> Vec<Power> {
    (0..plan.centre().len()).map(|d| Power::of(plan.axis(d).scale)).collect()
}

/// Returns the exact derivatives of all characteristics in these units.
fn derivatives(problem: &Problem, directions: &Directions<'_>, units: &[Power]) -> Vec<Option<Derivatives>> {
    let exponents: Vec<i32> = units.iter().map(|unit| unit.exponent()).collect();
    problem.function().derivatives_per(problem.outputs(), directions, &exponents)
}

impl ExactDerivatives {
    /// Returns the exact derivatives of every characteristic; None for one whose function has no derivatives.
    pub(super) fn of(problem: &Problem, plan: &dyn Plan) -> Vec<Option<Self>> {
        let (inputs, point, units) = (plan.moved(), plan.centre(), units(plan));
        let directions = Directions { point: &point, inputs: &inputs, pairs: &[] };
        let known = |derivatives: Derivatives| {
            let spread = |values: &[Option<f64>]| {
                let mut spread = vec![None; point.len()];
                inputs.iter().zip(values).for_each(|(&d, &value)| spread[d] = value);
                spread
            };
            let (first, second) = (spread(&derivatives.first), spread(&derivatives.second));
            Self { first, second, mixed: Vec::new(), units: units.clone() }
        };
        derivatives(problem, &directions, &units).into_iter().map(|derivatives| derivatives.map(known)).collect()
    }

    /// Returns the exact derivatives that a report shows beside evaluated ones, with the mixed derivatives of these pairs of positions.
    /// Returns None for every characteristic if only differences are requested.
    pub(super) fn beside(
        problem: &Problem,
        plan: &dyn Plan,
        options: &Options,
        pairs: &[(usize, usize)],
    ) -> Vec<Option<Self>> {
        if options.derivatives == Some(DerivativeSource::Difference) {
            return vec![None; problem.characteristics().len()];
        }
        let mut all = Self::of(problem, plan);
        Self::add_pairs(&mut all, problem, plan, pairs);
        all
    }

    /// Adds the mixed derivatives of these pairs of positions.
    pub(super) fn add_pairs(all: &mut [Option<Self>], problem: &Problem, plan: &dyn Plan, pairs: &[(usize, usize)]) {
        let dimensions: Vec<(usize, usize)> =
            pairs.iter().map(|&(j, k)| (plan.varying()[j], plan.varying()[k])).collect();
        let directions = Directions { point: &plan.centre(), inputs: &[], pairs: &dimensions };
        let derivatives = derivatives(problem, &directions, &units(plan));
        for (exact, derivatives) in all.iter_mut().zip(derivatives) {
            if let (Some(exact), Some(derivatives)) = (exact, derivatives) {
                exact.mixed = derivatives.mixed;
            }
        }
    }

    /// Returns the pairs of positions that the problem lists as interacting, in order.
    pub(super) fn known_pairs(problem: &Problem, plan: &DifferencePlan, options: &Options) -> Vec<(usize, usize)> {
        if options.derivatives == Some(DerivativeSource::Difference) {
            return Vec::new();
        }
        let positions: HashMap<&str, usize> = plan
            .varying()
            .iter()
            .enumerate()
            .map(|(position, &d)| (problem.dimensions()[d].name(), position))
            .collect();
        let pair = |(a, b): &(String, String)| {
            let (j, k) = (*positions.get(a.as_str())?, *positions.get(b.as_str())?);
            (j != k).then_some((j.min(k), j.max(k)))
        };
        let mut pairs: Vec<(usize, usize)> = problem.products().iter().filter_map(pair).collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// Returns the mixed derivatives of these pairs in sigmas, for every characteristic whose function has derivatives.
    pub(super) fn mixed_of(
        problem: &Problem,
        plan: &DifferencePlan,
        pairs: &[(usize, usize)],
    ) -> Vec<Vec<((usize, usize), Mixed)>> {
        let nothing = Self { first: Vec::new(), second: Vec::new(), mixed: Vec::new(), units: units(plan) };
        let mut all = vec![Some(nothing); problem.characteristics().len()];
        Self::add_pairs(&mut all, problem, plan, pairs);
        let of = |exact: &Self| {
            let mixed = exact.mixed(plan, pairs).into_iter();
            pairs.iter().zip(mixed).filter_map(|(&pair, mixed)| Some((pair, mixed?))).collect()
        };
        all.iter().map(|exact| exact.as_ref().map_or_else(Vec::new, of)).collect()
    }

    /// Returns the univariate part of one dimension, in sigmas: a parabola, or a straight line if the curvature does not exist.
    pub(super) fn part(&self, plan: &DifferencePlan, dimension: usize) -> Option<Univariate> {
        let scale = self.units[dimension].inverse().times(plan.axis(dimension).scale);
        let slope = scale * self.first[dimension]?;
        Some(match self.second[dimension] {
            Some(second) => Univariate::of_coefficients(&[slope, 0.5 * scale * scale * second]),
            None => Univariate::of_coefficients(&[slope]),
        })
    }

    /// Returns the mixed derivatives of these pairs, in sigmas.
    pub(super) fn mixed(&self, plan: &DifferencePlan, pairs: &[(usize, usize)]) -> Vec<Option<Mixed>> {
        let in_sigmas = |(&(j, k), value): (&(usize, usize), &Option<f64>)| {
            let scale = |position: usize| {
                let d = plan.varying()[position];
                self.units[d].inverse().times(plan.axis(d).scale)
            };
            value.map(|value| Mixed::exact(scale(j) * scale(k) * value))
        };
        pairs.iter().zip(&self.mixed).map(in_sigmas).collect()
    }

    /// Returns the first derivative by a dimension, per unit of 1, or None if it does not exist.
    pub(crate) fn slope(&self, dimension: usize) -> Option<Wide> {
        Some(Wide::of(self.first[dimension]?).times_power(self.units[dimension].inverse()))
    }

    /// Returns the second derivative by a dimension, per unit of 1, or None if it does not exist.
    pub(crate) fn curvature(&self, dimension: usize) -> Option<Wide> {
        Some(Wide::of(self.second[dimension]?).times_power(self.units[dimension].inverse().squared()))
    }

    /// Returns the mixed derivative of the pair at this place, of these two dimensions, per unit of 1, or None if it does not exist.
    pub(crate) fn interaction(&self, place: usize, [j, k]: [usize; 2]) -> Option<Wide> {
        let unit = self.units[j].and(self.units[k]);
        Some(Wide::of(self.mixed[place]?).times_power(unit.inverse()))
    }

    /// Returns an error that names the first derivative that is missing for the moments of this characteristic, or None if none is missing.
    pub(super) fn lacking(
        &self,
        problem: &Problem,
        plan: &DifferencePlan,
        c: usize,
        order: Order,
        pairs: &[(usize, usize)],
    ) -> Option<MethodError> {
        let name = |d: usize| problem.dimensions()[d].name().to_owned();
        let none = |dimensions: Vec<String>| MethodError::NoDerivative {
            characteristic: problem.characteristics()[c].name().to_owned(),
            dimensions,
        };
        let lacks = |d: usize| self.first[d].is_none() || order == Order::Second && self.second[d].is_none();
        if let Some(&d) = plan.varying().iter().find(|&&d| lacks(d)) {
            return Some(none(vec![name(d)]));
        }
        let pair = pairs.iter().zip(&self.mixed).find(|(_, mixed)| mixed.is_none()).map(|(pair, _)| pair);
        pair.map(|&(j, k)| none(vec![name(plan.varying()[j]), name(plan.varying()[k])]))
    }
}

/// Checks before any evaluation that the function has derivatives of every characteristic.
pub(super) fn known(problem: &Problem, plan: &DifferencePlan) -> Result<(), MethodError> {
    let directions = Directions { point: &plan.centre(), inputs: &[], pairs: &[] };
    let derivatives = problem.function().derivatives(problem.outputs(), &directions);
    match derivatives.iter().position(Option::is_none) {
        None => Ok(()),
        Some(c) => {
            Err(MethodError::DerivativesUnknown { characteristic: problem.characteristics()[c].name().to_owned() })
        }
    }
}

/// Refuses an option of differences if the derivatives are exact, because there are no steps then.
pub(super) fn fits(source: Option<DerivativeSource>, option: &'static str, given: bool) -> Result<(), MethodError> {
    if source == Some(DerivativeSource::Exact) && given {
        return Err(MethodError::NoDifferences { option });
    }
    Ok(())
}
