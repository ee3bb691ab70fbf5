//! Outputs of extreme size: each is divided by a power of two, so that everything computed from it is of ordinary size.
//!
//! A sigma of 1e-200 has a variance of 0 among doubles, and one of 1e160 an infinite variance. The mend stands between the assembly function and all
//! that asks it. The first values of a function say how large its outputs are ([`Watch`]). Where one is of extreme size, its answers are held
//! back, and the run begins anew with a function whose outputs are divided by powers of two ([`ScaledFunction`]) and with limits divided
//! alike. Its results are multiplied again at the end. Division by a power of two is exact, so that every figure has the digits that it has in another
//! unit. A function of ordinary size is left as it is.

/// Methods of an assembly function that the size of outputs leaves as they are, forwarded to `self.function`.
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

        fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
            self.function.margins(output, points)
        }

        fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
            self.function.degree(output, varying)
        }

        fn account(&self) -> Option<EvaluatorAccount> {
            self.function.account()
        }

        fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
            self.function.warnings(outputs)
        }
    };
}

mod scaled;
mod store;
mod watch;

pub(crate) use scaled::ScaledFunction;
pub(crate) use watch::{Watch, WatchedFunction};

use std::sync::Arc;

use crate::assembly::AssemblyFunction;
use sensitol_numeric::power::Power;
use store::Store;

/// The sizes of the outputs of a function during a run.
#[derive(Debug, Clone)]
pub(crate) struct Magnitudes {
    /// By output of the function.
    powers: Arc<[Power]>,
    /// While nothing is divided: the watch for outputs of extreme size.
    watch: Option<Arc<Watch>>,
    /// Answers of a costly function that were held back, and those of the model within it.
    stores: [Arc<Store>; 2],
}

impl Magnitudes {
    /// Those of a run that finds out how large the outputs are.
    pub(crate) fn watching(outputs: usize) -> Self {
        Self {
            powers: vec![Power::ONE; outputs].into(),
            watch: Some(Arc::new(Watch::new(outputs))),
            stores: Default::default(),
        }
    }

    /// Those of a run with outputs of these powers, which begins with the answers that this one has held back.
    pub(crate) fn known(&self, powers: Vec<Power>) -> Self {
        Self { powers: powers.into(), watch: None, stores: self.stores.clone() }
    }

    /// The power of two by which an output of the function is divided.
    pub(crate) fn power(&self, output: usize) -> Power {
        self.powers[output]
    }

    /// The watch of a run that finds out how large the outputs are.
    pub(crate) fn watch(&self) -> Option<&Arc<Watch>> {
        self.watch.as_ref()
    }

    /// A function with the outputs of the one that this is about, as the run sees it: watched or divided.
    pub(crate) fn wrapped(&self, function: Arc<dyn AssemblyFunction>) -> Arc<dyn AssemblyFunction> {
        let store = Arc::clone(&self.stores[0]);
        match &self.watch {
            Some(watch) => Arc::new(WatchedFunction::new(function, Arc::clone(watch), store)),
            None => Arc::new(ScaledFunction::new(function, Arc::clone(&self.powers), store)),
        }
    }

    /// A model within the function, whose answers are not asked for twice: those of a run that was broken off stand for the next one.
    pub(crate) fn remembering(&self, model: Arc<dyn AssemblyFunction>) -> Arc<dyn AssemblyFunction> {
        let ones = vec![Power::ONE; model.signature().outputs.len()];
        let store = Arc::clone(&self.stores[1]);
        match &self.watch {
            Some(watch) => Arc::new(WatchedFunction::within(model, Arc::clone(watch), store)),
            None => Arc::new(ScaledFunction::new(model, ones.into(), store)),
        }
    }

    /// The time that the model took for answers that were held back.
    pub(crate) fn held_back(&self) -> std::time::Duration {
        self.stores.iter().map(|store| store.took()).sum()
    }
}
