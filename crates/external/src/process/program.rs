//! The external program as an assembly function.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use super::pool::Pool;
use super::protocol::{Hello, VERSION};
use super::replay::Confirmation;
use super::suspicion::most_replays;
use super::walk::STEPS;
use crate::settings::{Greeting, Settings};
use sensitol::assembly::EvaluatorAccount;
use sensitol::assembly::ProcessError;
use sensitol::assembly::{AssemblyFunction, EvaluationError, ModelInfo, Request, Responses, Run, Signature};

/// An external program as an assembly function.
///
/// Evaluations: one for each point, and one more for each retry. Children start with the first point or with
/// [`prepare`](AssemblyFunction::prepare), and end with this value.
pub struct Process {
    signature: Signature,
    settings: Settings,
    greeting: Greeting,
    pool: Mutex<Option<Pool>>,
    /// True once an answer was found to depend on the points before it, in this run or in an earlier one.
    flips: Arc<AtomicBool>,
}

impl Process {
    /// A program that evaluates the outputs of `signature` at points of its inputs.
    ///
    /// # Panics
    /// Panics if `argv` is empty, or if the number of nominal values differs from that of the inputs.
    pub fn new(signature: Signature, greeting: Greeting, settings: Settings) -> Self {
        assert!(!settings.argv.is_empty(), "a program has a name");
        assert_eq!(signature.inputs.len(), greeting.nominal.len(), "every dimension has a nominal value");
        let signature = Signature { costly: true, cheap: false, ..signature };
        Self { signature, settings, greeting, pool: Mutex::new(None), flips: Arc::default() }
    }

    /// Description of the program by itself. Starts the program if it is not running.
    ///
    /// # Errors
    /// Fails if the program does not start or cannot serve the study.
    pub fn adapter(&self, outputs: &[usize]) -> Result<ModelInfo, ProcessError> {
        self.with_pool(outputs, |pool| pool.prepare().cloned())
    }

    /// True if numbers are converted on their way to the program and back. It is known once the program has started.
    pub(crate) fn converts(&self) -> bool {
        let pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        pool.as_ref().is_some_and(|pool| pool.converts)
    }

    /// Account of the processes so far; empty if none was started.
    pub(crate) fn account(&self) -> EvaluatorAccount {
        let pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        pool.as_ref().map(|pool| pool.account.clone()).unwrap_or_default()
    }

    /// True once an answer was found to depend on the points before it.
    pub(crate) fn flips(&self) -> bool {
        self.flips.load(Ordering::Relaxed)
    }

    /// Notes that an earlier run found answers that depend on the points before them, so that every answer is replayed.
    pub(crate) fn expect_flips(&self) {
        self.flips.store(true, Ordering::Relaxed);
    }

    /// Adds answers of an earlier run that are used now. That run confirmed each of them, or the usual part.
    pub(crate) fn remember(&self, outputs: &[usize], points: &[Vec<f64>], values: &[Vec<Option<f64>>]) {
        let each_confirmed = self.flips();
        self.with_pool(outputs, |pool| pool.remember(points, values, each_confirmed));
    }

    /// Points with answers that a fresh process confirmed since the last call.
    pub(crate) fn take_confirmed(&self) -> Vec<Vec<f64>> {
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        pool.as_mut().map(|pool| pool.answers.take_confirmed()).unwrap_or_default()
    }

    pub(crate) fn settings(&self) -> &Settings {
        &self.settings
    }

    /// Values of the first line to the program.
    pub(crate) fn greeting(&self) -> &Greeting {
        &self.greeting
    }

    fn with_pool<T>(&self, outputs: &[usize], act: impl FnOnce(&mut Pool) -> T) -> T {
        let names: Vec<String> = outputs.iter().map(|&output| self.signature.outputs[output].name.clone()).collect();
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        // A child gets the requested outputs once, at its start. Other outputs need other children.
        if pool.as_ref().is_none_or(|pool| !pool.asks(&names)) {
            let account = pool.take().map(|pool| pool.account.clone()).unwrap_or_default();
            let mut fresh = Pool::new(self.settings.clone(), self.hello(names), Arc::clone(&self.flips));
            fresh.account = account;
            *pool = Some(fresh);
        }
        act(pool.as_mut().expect("it was just made"))
    }

    fn hello(&self, characteristics: Vec<String>) -> Hello {
        let unit = |name: &String| self.signature.outputs.iter().find(|output| output.name == *name)?.unit.clone();
        let asked_units = characteristics.iter().map(unit).collect();
        let value = |value: f64| serde_json::Number::from_f64(value).map_or(serde_json::Value::Null, Into::into);
        Hello {
            sensitol: VERSION,
            dimensions: self.signature.inputs.iter().map(|input| input.name.clone()).collect(),
            units: self.signature.inputs.iter().map(|input| input.unit.clone()).collect(),
            nominal: self.greeting.nominal.clone(),
            constants: self.greeting.constants.iter().map(|(name, number)| (name.clone(), value(*number))).collect(),
            characteristics,
            optional: self.greeting.optional.clone(),
            asked_units,
        }
    }
}

/// Result of the comparison of an earlier run's answers with the model. All but the last hold the values of the nominal point.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Recheck {
    /// The nominal point has the same value.
    Same(Vec<Option<f64>>),
    /// The nominal point has another value, so the model has changed.
    Changed(Vec<Option<f64>>),
    /// The run was stopped before the comparison ended.
    Stopped,
}

impl Process {
    /// Compares the answer of an earlier run to the nominal point with the model. Other answers of that run, `values`, have the range that
    /// distinguishes noise from a difference.
    pub(crate) fn recheck(
        &self,
        outputs: &[usize],
        nominal: Option<&[Option<f64>]>,
        values: &[Vec<Option<f64>>],
        run: &Run<'_>,
        out: &mut Responses,
    ) -> Recheck {
        self.with_pool(outputs, |pool| {
            values.iter().for_each(|values| pool.reference.learn(values));
            match pool.is_as_kept(nominal, out, run) {
                Some((true, found)) => Recheck::Same(found),
                Some((false, found)) => Recheck::Changed(found),
                None => Recheck::Stopped,
            }
        })
    }
}

impl AssemblyFunction for Process {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        self.adapter(outputs).map(Some).map_err(|error| Box::new(error).into())
    }

    fn account(&self) -> Option<EvaluatorAccount> {
        Some(Process::account(self))
    }

    fn own_checks(&self, answers: usize) -> usize {
        if !self.settings.replays() {
            return 0;
        }
        // Each walk begins at the nominal point.
        most_replays(answers, self.settings.verify).min(answers) * (STEPS + 1)
    }

    fn evaluate(&self, ask: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.with_pool(ask.outputs, |pool| {
            pool.evaluate(ask.points, run, out);
            let Confirmation { changed, unchecked } = pool.confirm(ask.points, out, run);
            out.leave_unchecked(unchecked);
            if !changed.is_empty() {
                run.withdraw(&changed);
                run.finished(&changed, out);
            }
        });
    }
}
