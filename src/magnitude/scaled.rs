//! Function whose outputs are divided by powers of two.

use std::sync::Arc;

use super::failure_log::FailureLog;
use super::store::Store;
use crate::assembly::EvaluatorAccount;
use crate::assembly::{
    AssemblyFunction, Bounds, Composite, Derivatives, Directions, EvaluationError, Input, ModelInfo, Points,
    Polynomial, RecordedFailure, Request, Responses, Run, Signature, Switches,
};
use crate::warning::Warning;
use sensitol_numeric::power::Power;

/// Function with every output divided by its power of two.
pub(crate) struct ScaledFunction {
    function: Arc<dyn AssemblyFunction>,
    /// Power of two of each output.
    powers: Arc<[Power]>,
    /// Answers of the first run that were held back.
    store: Arc<Store>,
    /// Failed points of this run.
    failures: Arc<FailureLog>,
}

impl ScaledFunction {
    pub(super) fn new(
        function: Arc<dyn AssemblyFunction>,
        powers: Arc<[Power]>,
        store: Arc<Store>,
        failures: Arc<FailureLog>,
    ) -> Self {
        Self { function, powers, store, failures }
    }

    fn divide(&self, outputs: &[usize], out: &mut Responses) {
        for (column, &output) in outputs.iter().enumerate().filter(|&(_, &output)| !self.powers[output].is_one()) {
            out.multiply_by(column, self.powers[output].inverse());
        }
    }
}

impl AssemblyFunction for ScaledFunction {
    forward_unscaled!();

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        let bounds = self.function.bounds(output, region)?;
        let power = self.powers[output].inverse();
        Some(if power.is_one() { bounds } else { bounds.times(power) })
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        let sizes = self.function.magnitudes(outputs, point).into_iter().zip(outputs);
        sizes.map(|(size, &output)| Some(self.powers[output].inverse().times(size?))).collect()
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        match self.store.take(request) {
            Some(answers) => *out = answers,
            None => self.function.evaluate(request, run, out),
        }
        if self.signature().costly {
            self.failures.note(request, out);
        }
        self.divide(request.outputs, out);
    }

    fn evaluate_columns(
        &self,
        rows: usize,
        columns: &[&[f64]],
        outputs: &[usize],
        run: &Run<'_>,
        out: &mut Responses,
    ) -> bool {
        let answered = self.function.evaluate_columns(rows, columns, outputs, run, out);
        if answered {
            self.divide(outputs, out);
        }
        answered
    }

    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        self.divided(outputs, self.function.derivatives(outputs, directions))
    }

    fn derivatives_per(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: &[i32],
    ) -> Vec<Option<Derivatives>> {
        self.divided(outputs, self.function.derivatives_per(outputs, directions, exponents))
    }

    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        let polynomial = self.function.polynomial(output, centre, scale)?;
        Some(polynomial.times_power(self.powers[output].inverse()))
    }
}

impl ScaledFunction {
    fn divided(&self, outputs: &[usize], derivatives: Vec<Option<Derivatives>>) -> Vec<Option<Derivatives>> {
        let divided = |(&output, derivatives): (&usize, Option<Derivatives>)| {
            derivatives.map(|derivatives| derivatives.times(self.powers[output].inverse()))
        };
        outputs.iter().zip(derivatives).map(divided).collect()
    }
}
