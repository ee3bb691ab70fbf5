//! One characteristic of a cheap model as a function of independent normal variables.

use crate::assembly::{Points, Run};
use crate::estimate::normal_space::{Columns, NormalSpace};
use crate::evaluation::Evaluator;
use crate::problem::Problem;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::surrogate::Surrogate;

/// A characteristic of a cheap model over independent standard normal variables.
pub(crate) struct CheapModel<'p> {
    evaluator: Evaluator<'p>,
    output: usize,
    space: NormalSpace<'p>,
}

impl<'p> CheapModel<'p> {
    /// Creates it over the varying dimensions on which the characteristic can depend.
    pub(crate) fn new(problem: &'p Problem, characteristic: usize) -> Self {
        let dependence = problem.dependence().swap_remove(characteristic);
        let varies = |&d: &usize| dependence[d] && problem.dimensions()[d].sigma() > 0.0;
        let dimensions: Vec<usize> = (0..problem.dimensions().len()).filter(varies).collect();
        Self::over(problem, characteristic, &dimensions)
    }

    /// Creates it over the given dimensions of the problem.
    pub(crate) fn over(problem: &'p Problem, characteristic: usize, dimensions: &[usize]) -> Self {
        let space = NormalSpace::new(problem, dimensions);
        let evaluator = Evaluator::new(problem, &Run::to_the_end());
        Self { evaluator, output: problem.outputs()[characteristic], space }
    }

    /// Evaluates under the conditions of a run: points that are unanswered when it stops have no value.
    pub(crate) fn during(self, run: &Run<'p>) -> Self {
        Self { evaluator: Evaluator::new(self.problem(), &run.quiet()), ..self }
    }

    /// True if the run was stopped, so that some points have no value for that reason.
    pub(crate) fn stopped(&self) -> bool {
        self.evaluator.run().stopped()
    }

    /// Standardised inputs at some points.
    pub(crate) fn standardised(&self, z: &Columns) -> Columns {
        self.space.standardised(z)
    }

    pub(crate) fn len(&self) -> usize {
        self.space.len()
    }

    /// Dimension of the problem of every variable.
    pub(crate) fn dimensions(&self) -> impl Iterator<Item = usize> + '_ {
        self.space.dimensions()
    }

    /// Values at some points, NaN if there is none.
    pub(crate) fn values(&self, z: &Columns) -> Vec<f64> {
        self.points_and_values(z).1
    }

    /// Points in the form of the problem, and the values there.
    pub(crate) fn points_and_values(&self, z: &Columns) -> (Points, Vec<f64>) {
        let points = self.space.points(z);
        let values = self.evaluator.ask_outputs(&points, &[self.output]).column(0).to_vec();
        (points, values)
    }

    /// Values of a surface over the dimensions at `varying`. Dimensions that this characteristic does not depend on stay at their means.
    /// Returns None if a part is unknown.
    pub(crate) fn surface(&self, z: &Columns, varying: &[usize], surrogate: &Surrogate) -> Option<Vec<f64>> {
        let own: Vec<usize> = self.dimensions().collect();
        let columns = self.space.standardised(z);
        let nothing = vec![0.0; z.first().map_or(0, Vec::len)];
        let column = |d: &usize| own.iter().position(|of| of == d).map_or(&nothing, |place| &columns[place]);
        let all: Vec<&Vec<f64>> = varying.iter().map(column).collect();
        Some(surrogate.rises(&all)?.into_iter().map(|rise| surrogate.centre + rise).collect())
    }

    /// Margins of the switches at some points. Returns None if the function does not report them.
    pub(crate) fn margins(&self, z: &Columns) -> Option<Vec<Vec<f64>>> {
        let of = |z: &Columns| self.problem().function().margins(self.output, &self.space.points(z));
        let rows = z.first().map_or(1, Vec::len);
        if rows < 256 {
            return of(z);
        }
        // A quarter of the points at once: with many dimensions all of them would need much memory.
        let quarter = rows.div_ceil(4);
        let block = |index: usize| {
            let (first, end) = (index * quarter, rows.min((index + 1) * quarter));
            of(&z.iter().map(|column| column[first..end].to_vec()).collect())
        };
        let blocks: Vec<Option<Vec<Vec<f64>>>> = (0..4).into_par_iter().map(block).collect();
        blocks.into_iter().reduce(|all, block| {
            let mut all = all?;
            all.iter_mut().zip(block?).for_each(|(all, more)| all.extend(more));
            Some(all)
        })?
    }

    pub(crate) fn problem(&self) -> &'p Problem {
        self.evaluator.problem()
    }

    pub(crate) fn output(&self) -> usize {
        self.output
    }
}
