//! Outputs of extreme size: each is divided by a power of two, so that all computed figures are of ordinary size.
//!
//! A sigma of 1e-200 has a variance of 0 in double precision, and one of 1e160 an infinite variance. The remedy is a layer between the
//! assembly function and its callers. The first values of a function give the size of its outputs ([`Watch`]). If one is of extreme size,
//! its answers are held back. The run starts again with a function whose outputs are divided by powers of two ([`ScaledFunction`]), and
//! with limits divided by the same powers. Its results are multiplied again at the end. Division by a power of two is exact, so that every
//! figure has the same digits as in another unit. A function of ordinary size is not changed.

/// Methods of an assembly function that do not depend on the size of outputs, forwarded to `self.function`.
macro_rules! forward_unscaled {
    () => {
        fn signature(&self) -> &Signature {
            self.function.signature()
        }

        fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
            self.function.prepare(outputs)
        }

        fn sent(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
            self.function.sent(points)
        }

        fn driven(&self) -> Option<&Composite> {
            self.function.driven()
        }

        fn switches(&self, output: usize) -> Option<Switches> {
            self.function.switches(output)
        }

        fn choice(&self, output: usize) -> Option<String> {
            self.function.choice(output)
        }

        fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
            self.function.margins(output, points)
        }

        fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
            self.function.degree(output, varying)
        }

        fn account(&self) -> Option<EvaluatorAccount> {
            self.function.account()
        }

        fn evaluations_per_point(&self, outputs: &[usize]) -> usize {
            self.function.evaluations_per_point(outputs)
        }

        fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
            self.failures.without_own(self.function.recorded_failures(outputs))
        }

        fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
            self.function.warnings(outputs)
        }
    };
}

mod failure_log;
mod scaled;
mod store;
mod watch;

pub(crate) use scaled::ScaledFunction;
pub(crate) use watch::{Watch, WatchedFunction};

use std::sync::Arc;

use crate::assembly::AssemblyFunction;
use failure_log::FailureLog;
use sensitol_numeric::power::Power;
use store::Store;

/// Sizes of the outputs of a function during a run.
#[derive(Debug, Clone)]
pub(crate) struct Magnitudes {
    /// Power of two of each output of the function.
    powers: Arc<[Power]>,
    /// Watch for outputs of extreme size. None if outputs are divided.
    watch: Option<Arc<Watch>>,
    /// Answers of a costly function that were held back, and those of the model within it.
    stores: [Arc<Store>; 2],
    /// Failed points of this run, for each store.
    failures: [Arc<FailureLog>; 2],
}

impl Magnitudes {
    /// Magnitudes of a run that determines the size of the outputs.
    pub(crate) fn watching(outputs: usize) -> Self {
        Self {
            powers: vec![Power::ONE; outputs].into(),
            watch: Some(Arc::new(Watch::new(outputs))),
            stores: Default::default(),
            failures: Default::default(),
        }
    }

    /// Magnitudes of a run with outputs of these powers, which starts with the answers that this one has held back.
    pub(crate) fn known(&self, powers: Vec<Power>) -> Self {
        Self { powers: powers.into(), watch: None, stores: self.stores.clone(), failures: self.failures.clone() }
    }

    /// Power of two by which an output of the function is divided.
    pub(crate) fn power(&self, output: usize) -> Power {
        self.powers[output]
    }

    /// Watch of a run that determines the size of the outputs. Returns None if the powers are known.
    pub(crate) fn watch(&self) -> Option<&Arc<Watch>> {
        self.watch.as_ref()
    }

    /// Wraps a function with these outputs for the run: watched or divided.
    pub(crate) fn wrapped(&self, function: Arc<dyn AssemblyFunction>) -> Arc<dyn AssemblyFunction> {
        let (store, failures) = (Arc::clone(&self.stores[0]), Arc::clone(&self.failures[0]));
        match &self.watch {
            Some(watch) => Arc::new(WatchedFunction::new(function, Arc::clone(watch), store, failures)),
            None => Arc::new(ScaledFunction::new(function, Arc::clone(&self.powers), store, failures)),
        }
    }

    /// Wraps a model within the function such that nothing is evaluated twice: the next run reuses the answers of a run that was stopped.
    pub(crate) fn remembering(&self, model: Arc<dyn AssemblyFunction>) -> Arc<dyn AssemblyFunction> {
        let ones = vec![Power::ONE; model.signature().outputs.len()];
        let (store, failures) = (Arc::clone(&self.stores[1]), Arc::clone(&self.failures[1]));
        match &self.watch {
            Some(watch) => Arc::new(WatchedFunction::within(model, Arc::clone(watch), store, failures)),
            None => Arc::new(ScaledFunction::new(model, ones.into(), store, failures)),
        }
    }

    /// Time that the model needed for answers that were held back.
    pub(crate) fn held_back(&self) -> std::time::Duration {
        self.stores.iter().map(|store| store.took()).sum()
    }
}
