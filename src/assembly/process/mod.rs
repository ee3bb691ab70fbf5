//! An external program as assembly function: JSON lines over stdin and stdout, `workers` children side by side.
//!
//! A program that a CAD system runs in crashes, hangs and lies. Nothing of it is trusted: every child is a process group of
//! its own that is ended on every way out, every point has a deadline, every line is checked, and what goes wrong is an error of
//! one point with what the program wrote to stderr. The protocol is in `adapters/PROTOCOL.md`.
//!
//! A solver that starts from its last solution may settle in a mirrored assembly and stay there, with status "solved". So
//! every child evaluates the nominal point again after some points, after every error and at the end of every batch; where the
//! answer is another than before, it is ended, and what it has answered since is evaluated again by a fresh one.
//!
//! A point that fails is tried again `retries` times, in a fresh child and alone, so that a point that crashes children is
//! found out and takes no other with it. A child that fails is started again, after a pause that doubles every time.

mod account;
mod batch;
mod child;
mod error;
mod pool;
mod protocol;
mod replay;
mod sentinel;
mod suspicion;
mod worker;

pub use account::EvaluatorAccount;
pub use child::Listener;
pub use error::{Exit, ProcessError, ProcessFault, Quoted, StderrTail};

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use super::{Ask, AssemblyFunction, EvaluationError, ModelInfo, Responses, Run, Signature};
use pool::Pool;
use protocol::{Hello, VERSION};

/// How a program is run.
#[derive(Clone)]
pub struct Settings {
    /// The program and its arguments; never a shell line. A program with a folder in its name is looked for from `folder`.
    pub argv: Vec<String>,
    /// Its working folder.
    pub folder: PathBuf,
    /// Children side by side.
    pub workers: usize,
    /// How long the oldest point under way in a child may take.
    pub timeout: Duration,
    /// How long a child may take to say that it is ready.
    pub start_timeout: Duration,
    /// How often a point that failed is tried again.
    pub retries: u32,
    /// Whether the nominal point is evaluated again every so often, to see whether the model still answers as it did.
    pub sentinels: bool,
    /// How many answers are replayed in a fresh process, reached from the nominal point in small steps, to see whether they depend on
    /// the points before them: by default 5 %, 5 at the least, and 2 more. 0 for none; only with `sentinels`.
    pub verify: Option<usize>,
    /// Hears every line that a child writes to stderr.
    pub listener: Option<Listener>,
}

impl Settings {
    /// One child in the current folder, a minute for each answer and for the start, one retry.
    pub fn new(argv: impl IntoIterator<Item = impl Into<String>>) -> Self {
        Self {
            argv: argv.into_iter().map(Into::into).collect(),
            folder: PathBuf::from("."),
            workers: 1,
            timeout: Duration::from_secs(60),
            start_timeout: Duration::from_secs(60),
            retries: 1,
            sentinels: true,
            verify: None,
            listener: None,
        }
    }
}

/// What the first line to a child says beside the names that are asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Greeting {
    /// The nominal value of every dimension.
    pub nominal: Vec<f64>,
    /// Names and values of constants.
    pub constants: Vec<(String, f64)>,
    /// Dimensions and constants that the program need not know.
    pub optional: Vec<String>,
}

/// An external program as assembly function.
///
/// Evaluations: one for each point, and one more for each time that it is tried again. Children start with the first
/// point or with [`prepare`](AssemblyFunction::prepare), and end with this value.
pub struct Process {
    signature: Signature,
    settings: Settings,
    greeting: Greeting,
    pool: Mutex<Option<Pool>>,
}

impl Process {
    /// A program that is asked for the outputs of `signature` at points of its inputs.
    ///
    /// # Panics
    /// When `argv` is empty, or there are not as many nominal values as inputs.
    pub fn new(signature: Signature, greeting: Greeting, settings: Settings) -> Self {
        assert!(!settings.argv.is_empty(), "a program has a name");
        assert_eq!(signature.inputs.len(), greeting.nominal.len(), "every dimension has a nominal value");
        let signature = Signature { costly: true, ..signature };
        Self { signature, settings, greeting, pool: Mutex::new(None) }
    }

    /// What the program says of itself; starts it if need be.
    ///
    /// # Errors
    /// When it does not start, or does not serve the study.
    pub fn adapter(&self, outputs: &[usize]) -> Result<ModelInfo, ProcessError> {
        self.with_pool(outputs, |pool| pool.prepare().cloned())
    }

    /// What became of its processes so far: nothing where none was started.
    pub fn account(&self) -> EvaluatorAccount {
        let pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        pool.as_ref().map(|pool| pool.account.clone()).unwrap_or_default()
    }

    /// How it is run.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// What its first line says beside names.
    pub fn greeting(&self) -> &Greeting {
        &self.greeting
    }

    fn with_pool<T>(&self, outputs: &[usize], act: impl FnOnce(&mut Pool) -> T) -> T {
        let names: Vec<String> = outputs.iter().map(|&output| self.signature.outputs[output].name.clone()).collect();
        let mut pool = self.pool.lock().unwrap_or_else(PoisonError::into_inner);
        // Children are told once what they are asked for; another question takes others.
        if pool.as_ref().is_none_or(|pool| !pool.asks(&names)) {
            let account = pool.take().map(|pool| pool.account.clone()).unwrap_or_default();
            let mut fresh = Pool::new(self.settings.clone(), self.hello(names));
            fresh.account = account;
            *pool = Some(fresh);
        }
        act(pool.as_mut().expect("it was just made"))
    }

    fn hello(&self, characteristics: Vec<String>) -> Hello {
        let value = |value: f64| serde_json::Number::from_f64(value).map_or(serde_json::Value::Null, Into::into);
        Hello {
            sensitol: VERSION,
            dimensions: self.signature.inputs.iter().map(|input| input.name.clone()).collect(),
            units: self.signature.inputs.iter().map(|input| input.unit.clone()).collect(),
            nominal: self.greeting.nominal.clone(),
            constants: self.greeting.constants.iter().map(|(name, number)| (name.clone(), value(*number))).collect(),
            characteristics,
            optional: self.greeting.optional.clone(),
        }
    }
}

impl AssemblyFunction for Process {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        self.adapter(outputs).map(Some).map_err(|error| Box::new(error).into())
    }

    fn evaluate(&self, ask: &Ask<'_>, run: &Run<'_>, out: &mut Responses) {
        self.with_pool(ask.outputs, |pool| {
            pool.evaluate(ask.points, run, out);
            if run.stopped() || run.abandoned() {
                return;
            }
            if let Some(changed) = pool.confirm(ask.points, out, run)
                && !changed.is_empty()
            {
                run.withdraw(&changed);
                run.finished(&changed, out);
            }
        });
    }
}
