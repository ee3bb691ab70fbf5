//! Model that reuses known answers: points of a sample that is continued.

use std::collections::HashMap;

use crate::assembly::{AssemblyFunction, Points, Request, Responses, Run, Signature};
use crate::problem::Problem;

/// Stored answers for all outputs that a problem uses, and the model for every other point.
pub(in crate::analysis) struct KnownAnswersFunction {
    problem: Problem,
    /// Batch that answered a point, and the row in it, by the bits of the coordinates.
    places: HashMap<Vec<u64>, (usize, usize)>,
    batches: Vec<Responses>,
}

fn key(points: &Points, row: usize) -> Vec<u64> {
    (0..points.dimensions()).map(|d| points.column(d)[row].to_bits()).collect()
}

impl KnownAnswersFunction {
    pub(in crate::analysis) fn new(problem: &Problem) -> Self {
        Self { problem: problem.clone(), places: HashMap::new(), batches: Vec::new() }
    }

    /// Stores the answers of these points, for all outputs of the problem.
    pub(in crate::analysis) fn keep(&mut self, points: &Points, answers: Responses) {
        let batch = self.batches.len();
        self.places.extend((0..points.rows()).map(|row| (key(points, row), (batch, row))));
        self.batches.push(answers);
    }
}

impl AssemblyFunction for KnownAnswersFunction {
    fn signature(&self) -> &Signature {
        self.problem.function().signature()
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        self.problem.function().magnitudes(outputs, point)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let model = self.problem.function();
        if request.outputs != self.problem.outputs() {
            return model.evaluate(request, run, out);
        }
        let points = request.points;
        let mut missing = Vec::new();
        for row in 0..points.rows() {
            let Some(&(batch, from)) = self.places.get(&key(points, row)) else {
                missing.push(row);
                continue;
            };
            (0..out.outputs()).for_each(|output| out.pass_on(row, output, &self.batches[batch], from, output));
        }
        // Stored points were counted when they were evaluated.
        out.spent(missing.len() as i64 - points.rows() as i64);
        if missing.is_empty() {
            return;
        }
        let others = Points::written(missing.len(), points.dimensions(), |d, column| {
            column.iter_mut().zip(&missing).for_each(|(value, &row)| *value = points.column(d)[row]);
        });
        let mut own = Responses::open(missing.len(), out.outputs());
        model.evaluate(&Request::values(&others, request.outputs), &run.quiet(), &mut own);
        for (from, &row) in missing.iter().enumerate() {
            (0..out.outputs()).for_each(|output| out.pass_on(row, output, &own, from, output));
        }
        out.spent(own.extra());
        out.retried(own.count_retried());
        out.leave_unchecked(own.count_unchecked());
        out.note_non_repeatable(own.non_repeatable().iter().cloned());
        own.revoked().iter().for_each(|point| out.revoke(point.clone()));
    }
}
