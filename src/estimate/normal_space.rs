//! Independent standard normal variables, and the inputs as functions of them.
//!
//! An input is its own quantile function of a normal variable, `T(z) = F^-1(Phi(z))`. Correlated inputs are functions of correlated normal
//! variables (Nataf's distribution, [`sensitol_numeric::correlation`]), which are computed from independent ones by a factor of their
//! matrix. Correlated inputs need no case of their own: all estimators work in `z`.

use crate::assembly::Points;
use crate::problem::Problem;
use sensitol_numeric::correlation::{Together, Transform};
use sensitol_numeric::distribution::{Distribution, Normal, PearsonLaw, Probability, ScoreTable, behind_normal};
use sensitol_numeric::sampling::{SamplingError, all_known};

/// Ends of normal variables, in sigmas.
const BEHIND: [f64; 2] = [-9.0, 9.0];
/// Accuracy of a normal variable behind an input, in sigmas.
const FINE: f64 = 1e-3;

/// Points as columns, one for every variable.
pub(crate) type Columns = Vec<Vec<f64>>;

/// Some of the varying dimensions of a problem, N of them.
pub(crate) struct NormalSpace<'p> {
    inputs: Vec<Input<'p>>,
    /// Correlation of some of the inputs.
    correlated: Option<Together>,
    /// All dimensions of the problem at their means.
    centre: Vec<f64>,
}

struct Input<'p> {
    dimension: usize,
    mean: f64,
    sigma: f64,
    law: Law<'p>,
}

/// Transformation `T` of a normal variable into a standardised input.
enum Law<'p> {
    Normal,
    Table(ScoreTable),
    /// Measured values, between which nothing may be interpolated.
    Atoms(&'p dyn Probability),
    /// Exact values for the model, without an end of the tails. Surfaces get values from a table that is continuous even between measured
    /// values, because the search for a likeliest point takes differences.
    FarTails(&'p dyn Probability, Transform),
}

impl<'p> NormalSpace<'p> {
    /// Creates the space of these dimensions, which vary, up to 9 sigma.
    ///
    /// A dimension that is known by its moments only has the Pearson distribution with the first four of them.
    pub(crate) fn new(problem: &'p Problem, dimensions: &[usize]) -> Self {
        let law = |&d: &usize| problem.dimensions()[d].distribution().map_or(Law::Normal, Law::of);
        Self::with_laws(problem, dimensions, dimensions.iter().map(law).collect())
    }

    /// Creates the space of these dimensions, which vary, without an end of the tails. Points of the model are exact, which costs a quantile
    /// function each.
    pub(crate) fn with_far_tails(problem: &'p Problem, dimensions: &[usize]) -> Result<Self, SamplingError> {
        all_known(problem.dimensions())?;
        let law = |&d: &usize| {
            let dimension = &problem.dimensions()[d];
            let law = dimension.distribution().and_then(Law::with_far_tails);
            law.ok_or_else(|| SamplingError::MomentsOnly { dimension: dimension.name().to_owned() })
        };
        let laws = dimensions.iter().map(law).collect::<Result<_, _>>()?;
        Ok(Self::with_laws(problem, dimensions, laws))
    }

    fn with_laws(problem: &'p Problem, dimensions: &[usize], laws: Vec<Law<'p>>) -> Self {
        let input = |(&d, law): (&usize, Law<'p>)| {
            let dimension = &problem.dimensions()[d];
            Input { dimension: d, mean: dimension.mean(), sigma: dimension.sigma(), law }
        };
        let correlation = problem.correlation().and_then(|correlation| correlation.among(dimensions));
        Self {
            inputs: dimensions.iter().zip(laws).map(input).collect(),
            correlated: correlation.as_ref().map(Together::of),
            centre: problem.dimensions().iter().map(|dimension| dimension.mean()).collect(),
        }
    }

    pub(crate) fn len(&self) -> usize {
        self.inputs.len()
    }

    /// Dimension of the problem of every variable.
    pub(crate) fn dimensions(&self) -> impl Iterator<Item = usize> + '_ {
        self.inputs.iter().map(|input| input.dimension)
    }

    /// Standardised inputs at some points, for surfaces.
    pub(crate) fn standardised(&self, normals: &Columns) -> Columns {
        let mut columns = self.correlated.as_ref().map_or_else(|| normals.clone(), |together| together.apply(normals));
        for (input, column) in self.inputs.iter().zip(&mut columns) {
            input.standardise(column);
        }
        columns
    }

    /// Normal variable behind a standardised input, to a thousandth of a sigma. Returns None if inputs are correlated.
    pub(crate) fn behind(&self, variable: usize, standardised: f64) -> Option<f64> {
        if self.correlated.is_some() {
            return None;
        }
        let [mut low, mut high] = BEHIND;
        while high - low > FINE {
            let middle = 0.5 * (low + high);
            let mut value = [middle];
            self.inputs[variable].standardise(&mut value);
            if value[0] < standardised { low = middle } else { high = middle }
        }
        Some(0.5 * (low + high))
    }

    /// Points in the form of the problem, for the model.
    pub(crate) fn points(&self, normals: &Columns) -> Points {
        let mut points = Points::repeated(&self.centre, normals.first().map_or(1, Vec::len));
        let together = self.correlated.as_ref().map(|together| together.apply(normals));
        for (input, column) in self.inputs.iter().zip(together.as_ref().unwrap_or(normals)) {
            let values = points.column_mut(input.dimension);
            values.copy_from_slice(column);
            // A measured value is reproduced to the last digit.
            if let Law::Atoms(law) | Law::FarTails(law, _) = &input.law {
                values.iter_mut().for_each(|x| *x = behind_normal(*law, *x));
                continue;
            }
            input.standardise(values);
            values.iter_mut().for_each(|x| *x = input.mean + input.sigma * *x);
        }
        points
    }
}

impl Input<'_> {
    fn standardise(&self, column: &mut [f64]) {
        match &self.law {
            Law::Normal => {}
            Law::Table(table) => column.iter_mut().for_each(|z| *z = table.value(*z)),
            Law::Atoms(law) => {
                for z in column {
                    *z = (behind_normal(*law, *z) - self.mean) / self.sigma;
                }
            }
            Law::FarTails(_, transform) => column.iter_mut().for_each(|z| *z = transform.value(*z)),
        }
    }
}

impl<'p> Law<'p> {
    fn of(distribution: &'p dyn Distribution) -> Self {
        if distribution.name() == Normal::NAME {
            return Self::Normal;
        }
        let Some(law) = distribution.probability() else {
            let moments = distribution.standard_moments();
            let stand_in = PearsonLaw::new(0.0, 1.0, moments.skewness, moments.excess);
            let stand_in = stand_in.ok().filter(|law| law.probability().is_some());
            return stand_in.map_or(Self::Normal, |law| match law.probability() {
                Some(probability) => Self::Table(ScoreTable::new(probability, [0.0, 1.0], law.support())),
                None => Self::Normal,
            });
        };
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        match law.density(mean) {
            Some(_) => Self::Table(ScoreTable::new(law, [mean, sigma], distribution.support())),
            None => Self::Atoms(law),
        }
    }

    /// Returns None if only moments are known.
    fn with_far_tails(distribution: &'p dyn Distribution) -> Option<Self> {
        let (law, transform) = (distribution.probability()?, Transform::of(distribution)?);
        Some(if transform.is_normal() { Self::Normal } else { Self::FarTails(law, transform) })
    }
}
