//! Stores evaluated points of a costly model for later statistics.

use std::sync::{Mutex, PoisonError};

use crate::assembly::{AssemblyFunction, Request, Responses, Run, Signature};
use crate::estimate::Share;
use crate::plan::Plan;
use crate::problem::Problem;
use sensitol_numeric::sampling::rank_first;

/// Greatest number of stored points: a costly model is seldom evaluated more often.
const MOST: usize = 1 << 14;

/// Model that stores its points and answers.
///
/// A costly model is evaluated one batch after the other, so that the order of the points does not depend on threads.
pub(in crate::analysis) struct RecordingModel {
    problem: Problem,
    kept: Mutex<Kept>,
}

/// Columns of all dimensions of the problem, and of all outputs.
#[derive(Default)]
struct Kept {
    x: Vec<Vec<f64>>,
    y: Vec<Vec<f64>>,
}

impl RecordingModel {
    pub(in crate::analysis) fn new(problem: &Problem) -> Self {
        Self { problem: problem.clone(), kept: Mutex::default() }
    }

    /// Removes all points, for another sample.
    pub(in crate::analysis) fn clear(&self) {
        *self.kept.lock().unwrap_or_else(PoisonError::into_inner) = Kept::default();
    }

    /// First-order indices of the varying dimensions on which a characteristic can depend.
    pub(in crate::analysis) fn ranks(&self, c: usize, plan: &dyn Plan) -> Vec<(usize, Share)> {
        let kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let of = |&d: &usize| ranked(d, kept.x.get(d)?, kept.y.get(c)?);
        plan.varying().iter().filter(|&&d| plan.depends(c, d)).filter_map(of).collect()
    }
}

/// First-order index of a dimension, by the ranks of a sample.
pub(in crate::analysis) fn ranked(dimension: usize, x: &[f64], y: &[f64]) -> Option<(usize, Share)> {
    let (value, error) = rank_first(x, y)?;
    Some((dimension, Share { value, error }))
}

impl AssemblyFunction for RecordingModel {
    fn signature(&self) -> &Signature {
        self.problem.function().signature()
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        self.problem.function().magnitudes(outputs, point)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.problem.function().evaluate(request, run, out);
        if request.outputs != self.problem.outputs() {
            return;
        }
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        let kept = &mut *kept;
        kept.x.resize_with(request.points.dimensions(), Vec::new);
        kept.y.resize_with(out.outputs(), Vec::new);
        let rows = out.rows().min(MOST.saturating_sub(kept.y.first().map_or(0, Vec::len)));
        for (d, column) in kept.x.iter_mut().enumerate() {
            column.extend_from_slice(&request.points.column(d)[..rows]);
        }
        for (output, column) in kept.y.iter_mut().enumerate() {
            column.extend((0..rows).map(|row| out.value(row, output).unwrap_or(f64::NAN)));
        }
    }
}
