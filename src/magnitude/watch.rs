//! Watch for outputs of extreme size among the first answers of a function.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::failure_log::FailureLog;
use super::store::Store;
use crate::assembly::EvaluatorAccount;
use crate::assembly::{
    AssemblyFunction, Bounds, Composite, Derivatives, Directions, EvaluationError, Input, ModelInfo, Points,
    Polynomial, RecordedFailure, Request, Responses, Run, Signature, Switches,
};
use crate::warning::Warning;
use sensitol_numeric::power::Power;
use sensitol_numeric::time::Instant;

/// Points with values that are needed to judge the size of an output. A single point may be one where a characteristic vanishes, as a
/// deviation does at the nominal dimensions.
const ENOUGH: usize = 2;

/// Sizes of the first values of every output.
#[derive(Debug)]
pub(crate) struct Watch {
    /// True if enough values were seen.
    settled: AtomicBool,
    /// True if some output is of extreme size.
    extreme: AtomicBool,
    seen: Mutex<Seen>,
}

#[derive(Debug)]
struct Seen {
    /// Number of points with a value.
    points: usize,
    /// Greatest absolute value of each output.
    sizes: Vec<f64>,
    /// Greatest absolute derivative of each output. It gives the size of an output whose values so far are 0.
    slopes: Vec<f64>,
}

impl Watch {
    /// Watch for a function with this number of outputs, without any value yet.
    pub(super) fn new(outputs: usize) -> Self {
        let seen = Mutex::new(Seen { points: 0, sizes: vec![0.0; outputs], slopes: vec![0.0; outputs] });
        Self { settled: AtomicBool::new(false), extreme: AtomicBool::new(false), seen }
    }

    /// True if some output is of extreme size, so that the run must start again.
    pub(crate) fn is_extreme(&self) -> bool {
        self.extreme.load(Ordering::Relaxed)
    }

    /// Ends the watch with the answers seen so far. Returns true if some output is of extreme size.
    pub(crate) fn settle(&self) -> bool {
        self.settled.store(true, Ordering::Relaxed);
        let extreme = self.powers().iter().any(|power| !power.is_one());
        self.extreme.fetch_or(extreme, Ordering::Relaxed) || extreme
    }

    /// Power of two of every output, by its greatest value so far.
    pub(crate) fn powers(&self) -> Vec<Power> {
        let seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        let size = |(&size, &slope): (&f64, &f64)| Power::of(if size > 0.0 { size } else { slope });
        seen.sizes.iter().zip(&seen.slopes).map(size).collect()
    }

    fn is_settled(&self) -> bool {
        self.settled.load(Ordering::Relaxed)
    }

    /// Updates the sizes with the values of these outputs.
    fn look(&self, outputs: &[usize], answers: &Responses) {
        let enough = {
            let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
            for (column, &output) in outputs.iter().enumerate() {
                let size = answers.column(column).iter().fold(0.0f64, |size, value| size.max(value.abs()));
                seen.sizes[output] = seen.sizes[output].max(size);
            }
            seen.points += answers.answered().count();
            seen.points >= ENOUGH && seen.sizes.iter().any(|&size| size > 0.0)
        };
        if enough {
            self.settle();
        }
    }

    /// Updates the sizes with the derivatives of these outputs, each per unit of an ordinary input.
    fn look_at_slopes(&self, outputs: &[usize], found: &[Option<Derivatives>]) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        for (&output, found) in outputs.iter().zip(found) {
            let Some(Derivatives { first, second, mixed }) = found else { continue };
            let values = first.iter().chain(second).chain(mixed).flatten();
            seen.slopes[output] = values.fold(seen.slopes[output], |size, value| size.max(value.abs()));
        }
    }
}

/// Function whose first answers are watched. Once an output is of extreme size, every point stays unanswered, as in a run that is stopped.
pub(crate) struct WatchedFunction {
    function: Arc<dyn AssemblyFunction>,
    watch: Arc<Watch>,
    /// True if the outputs are watched, false for a model within the watched function.
    looks: bool,
    store: Arc<Store>,
    /// Failed points of this run.
    failures: Arc<FailureLog>,
}

impl WatchedFunction {
    pub(super) fn new(
        function: Arc<dyn AssemblyFunction>,
        watch: Arc<Watch>,
        store: Arc<Store>,
        failures: Arc<FailureLog>,
    ) -> Self {
        Self { function, watch, looks: true, store, failures }
    }

    /// Model within the watched function, whose answers are only stored.
    pub(super) fn within(
        function: Arc<dyn AssemblyFunction>,
        watch: Arc<Watch>,
        store: Arc<Store>,
        failures: Arc<FailureLog>,
    ) -> Self {
        Self { looks: false, ..Self::new(function, watch, store, failures) }
    }
}

impl AssemblyFunction for WatchedFunction {
    forward_unscaled!();

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        self.function.bounds(output, region)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        if self.watch.is_extreme() {
            return;
        }
        if self.watch.is_settled() {
            self.function.evaluate(request, run, out);
            if self.signature().costly {
                self.failures.note(request, out);
            }
            return;
        }
        let begun = Instant::now();
        self.function.evaluate(request, run, out);
        if self.signature().costly {
            self.failures.note(request, out);
            self.store.keep(request, out, begun.elapsed());
        }
        if self.looks {
            self.watch.look(request.outputs, out);
        }
        if self.watch.is_extreme() {
            out.reopen(out.rows(), out.outputs());
        }
    }

    fn evaluate_columns(
        &self,
        rows: usize,
        columns: &[&[f64]],
        outputs: &[usize],
        run: &Run<'_>,
        out: &mut Responses,
    ) -> bool {
        // While answers are watched, they must come through `evaluate`.
        let settled = self.watch.is_settled() && !self.watch.is_extreme();
        settled && self.function.evaluate_columns(rows, columns, outputs, run, out)
    }

    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        self.function.derivatives(outputs, directions)
    }

    fn derivatives_per(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: &[i32],
    ) -> Vec<Option<Derivatives>> {
        let found = self.function.derivatives_per(outputs, directions, exponents);
        if self.looks && !self.watch.is_settled() {
            self.watch.look_at_slopes(outputs, &found);
        }
        found
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        self.function.magnitudes(outputs, point)
    }

    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        self.function.polynomial(output, centre, scale)
    }
}
