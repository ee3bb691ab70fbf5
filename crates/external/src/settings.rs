//! How a program is run, and what it is told first.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Hears every line that a child writes to stderr.
pub type Listener = Arc<dyn Fn(&str) + Send + Sync>;

/// How a program's units that are not the study's are taken.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForeignUnits {
    /// Numbers are taken as they are.
    Ignored,
    /// The program is not used.
    Refused,
    /// Numbers of the same kind are converted on their way.
    Converted,
}

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
    /// How units that the program says it has, and that are not the study's, are taken.
    pub units: ForeignUnits,
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
            units: ForeignUnits::Refused,
            listener: None,
        }
    }

    /// In this working folder.
    #[must_use]
    pub fn with_folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = folder.into();
        self
    }

    /// With so many children side by side.
    #[must_use]
    pub fn with_workers(mut self, workers: usize) -> Self {
        self.workers = workers;
        self
    }

    /// With so much time for an answer.
    #[must_use]
    pub fn with_timeout(mut self, timeout: Duration) -> Self {
        self.timeout = timeout;
        self
    }

    /// With so much time for the start.
    #[must_use]
    pub fn with_start_timeout(mut self, timeout: Duration) -> Self {
        self.start_timeout = timeout;
        self
    }

    /// With so many further tries of a point that failed.
    #[must_use]
    pub fn with_retries(mut self, retries: u32) -> Self {
        self.retries = retries;
        self
    }

    /// With evaluations of the nominal point again and again, or without.
    #[must_use]
    pub fn with_sentinels(mut self, sentinels: bool) -> Self {
        self.sentinels = sentinels;
        self
    }

    /// With so many answers replayed in a fresh process; 0 for none.
    #[must_use]
    pub fn with_verify(mut self, answers: usize) -> Self {
        self.verify = Some(answers);
        self
    }

    /// With someone who hears every line that a child writes to stderr.
    #[must_use]
    pub fn with_listener(mut self, listener: Listener) -> Self {
        self.listener = Some(listener);
        self
    }
}

/// The content of the first line to a process beside the names that are asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Greeting {
    /// The nominal value of every dimension.
    pub nominal: Vec<f64>,
    /// Names and values of constants.
    pub constants: Vec<(String, f64)>,
    /// Dimensions and constants that the program need not know.
    pub optional: Vec<String>,
}

impl Greeting {
    /// These nominal values, one for every dimension.
    pub fn new(nominal: Vec<f64>) -> Self {
        Self { nominal, ..Self::default() }
    }

    /// With these constants.
    #[must_use]
    pub fn with_constants(mut self, constants: Vec<(String, f64)>) -> Self {
        self.constants = constants;
        self
    }

    /// With these dimensions and constants that the program need not know.
    #[must_use]
    pub fn with_optional(mut self, names: Vec<String>) -> Self {
        self.optional = names;
        self
    }
}
