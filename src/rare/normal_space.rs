//! Independent standard normal variables, and the inputs that are functions of them.
//!
//! An input is its own quantile function of a normal variable. Correlated inputs are functions of correlated normal
//! variables (Nataf's law, [`sensitol_numeric::correlation`]). A factor of their correlation matrix makes these of
//! independent ones.

use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::correlation::{Together, Transform};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{Probability, behind_normal};
use sensitol_numeric::sampling::SamplingError;

/// Points as columns, one for every varying dimension.
pub(super) type Columns = Vec<Vec<f64>>;

/// Normal space of the N varying dimensions of a problem.
pub(super) struct Space<'p> {
    inputs: Vec<Input<'p>>,
    /// Correlation of some of the dimensions.
    correlated: Option<Together>,
}

struct Input<'p> {
    dimension: usize,
    mean: f64,
    sigma: f64,
    law: &'p dyn Probability,
    transform: Transform,
}

impl<'p> Space<'p> {
    /// Normal space of the dimensions that vary in the surrogate.
    pub(super) fn new(problem: &'p Problem, outcome: &Outcome) -> Result<Self, SamplingError> {
        let input = |&d: &usize| {
            let dimension: &Dimension = &problem.dimensions()[d];
            let unknown = || SamplingError::MomentsOnly { dimension: dimension.name().to_owned() };
            let distribution = dimension.distribution().ok_or_else(unknown)?;
            Ok(Input {
                dimension: d,
                mean: dimension.mean(),
                sigma: dimension.sigma(),
                law: distribution.probability().ok_or_else(unknown)?,
                transform: Transform::of(distribution).ok_or_else(unknown)?,
            })
        };
        let inputs = outcome.plan.varying().iter().map(input).collect::<Result<_, _>>()?;
        let correlation = outcome.plan.inputs().correlation();
        let correlated = correlation.map(Together::of);
        Ok(Self { inputs, correlated })
    }

    pub(super) fn len(&self) -> usize {
        self.inputs.len()
    }

    /// Dimension of every column.
    pub(super) fn dimensions(&self) -> impl Iterator<Item = usize> {
        self.inputs.iter().map(|input| input.dimension)
    }

    /// Inputs in sigmas off their means, for the surrogate. They are tabulated to 1e-6.
    pub(super) fn standardised(&self, normals: &Columns) -> Columns {
        let mut columns = self.together(normals);
        for (input, column) in self.inputs.iter().zip(&mut columns) {
            if !input.transform.is_normal() {
                column.iter_mut().for_each(|z| *z = input.transform.value(*z));
            }
        }
        columns
    }

    /// Exact values of the inputs, for the model.
    pub(super) fn values(&self, normals: &Columns) -> Columns {
        let mut columns = self.together(normals);
        for (input, column) in self.inputs.iter().zip(&mut columns) {
            let normal = input.transform.is_normal();
            for z in column {
                *z = if normal { input.mean + input.sigma * *z } else { behind_normal(input.law, *z) };
            }
        }
        columns
    }

    /// Normal variables with the correlation of the inputs.
    fn together(&self, normals: &Columns) -> Columns {
        self.correlated.as_ref().map_or_else(|| normals.clone(), |together| together.apply(normals))
    }
}
