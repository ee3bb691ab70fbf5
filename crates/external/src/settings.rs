//! Settings of an external program, and its greeting.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

/// Callback for every line that a child writes to stderr.
pub type Listener = Arc<dyn Fn(&str) + Send + Sync>;

/// Handling of units of an external program.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ForeignUnits {
    /// Ignores the units of the program.
    Ignored,
    /// Refuses a program with another unit than the study's.
    Refused,
    /// Converts numbers between units of the same kind.
    Converted,
}

/// Settings of an external program.
#[derive(Clone)]
pub struct Settings {
    /// Program and arguments, never a shell line. A program with a folder in its name is relative to `folder`.
    pub argv: Vec<String>,
    /// Working folder.
    pub folder: PathBuf,
    /// Number of children side by side.
    pub workers: usize,
    /// Greatest time of an evaluation.
    pub timeout: Duration,
    /// Greatest time for a child to become ready.
    pub start_timeout: Duration,
    /// Number of further attempts at a failed point.
    pub retries: u32,
    /// True if the nominal point is evaluated again from time to time, to check that the model still gives the same answer.
    pub sentinels: bool,
    /// Number of answers that are replayed in a fresh process, which reaches them from the nominal point in small steps. This finds answers
    /// that depend on the points before them. The default is 5 %, at least 7 and at most 59. No replay for 0, or without `sentinels`.
    pub verify: Option<usize>,
    /// Handling of units that the program declares and that differ from the study's.
    pub units: ForeignUnits,
    /// Callback for every line that a child writes to stderr.
    pub listener: Option<Listener>,
}

impl Settings {
    /// Settings with one child in the current folder, a minute for each answer and for the start, and one retry.
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

    /// True if answers are replayed in a fresh process.
    pub(crate) fn replays(&self) -> bool {
        self.sentinels && self.verify != Some(0)
    }

    /// Sets the working folder.
    #[must_use]
    pub fn with_folder(mut self, folder: impl Into<PathBuf>) -> Self {
        self.folder = folder.into();
        self
    }

    /// Sets the number of children side by side.
    #[must_use]
    pub fn with_workers(mut self, workers: usize) -> Self {
        self.workers = workers;
        self
    }

    /// Sets the greatest time of an evaluation.
    #[must_use]
    pub fn with_timeout(mut self, timeout: Duration) -> Self {
        self.timeout = timeout;
        self
    }

    /// Sets the greatest time for the start.
    #[must_use]
    pub fn with_start_timeout(mut self, timeout: Duration) -> Self {
        self.start_timeout = timeout;
        self
    }

    /// Sets the number of further attempts at a failed point.
    #[must_use]
    pub fn with_retries(mut self, retries: u32) -> Self {
        self.retries = retries;
        self
    }

    /// Turns repeated evaluations of the nominal point on or off.
    #[must_use]
    pub fn with_sentinels(mut self, sentinels: bool) -> Self {
        self.sentinels = sentinels;
        self
    }

    /// Sets the number of answers that are replayed in a fresh process; 0 for none.
    #[must_use]
    pub fn with_verify(mut self, answers: usize) -> Self {
        self.verify = Some(answers);
        self
    }

    /// Sets a callback for every line that a child writes to stderr.
    #[must_use]
    pub fn with_listener(mut self, listener: Listener) -> Self {
        self.listener = Some(listener);
        self
    }
}

/// Values in the first line to a program, besides the requested names.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Greeting {
    /// Nominal value of every dimension.
    pub nominal: Vec<f64>,
    /// Names and values of constants.
    pub constants: Vec<(String, f64)>,
    /// Dimensions and constants that the program does not use.
    pub optional: Vec<String>,
}

impl Greeting {
    /// Greeting with the nominal value of every dimension.
    pub fn new(nominal: Vec<f64>) -> Self {
        Self { nominal, ..Self::default() }
    }

    /// Sets the constants.
    #[must_use]
    pub fn with_constants(mut self, constants: Vec<(String, f64)>) -> Self {
        self.constants = constants;
        self
    }

    /// Sets the dimensions and constants that the program does not use.
    #[must_use]
    pub fn with_optional(mut self, names: Vec<String>) -> Self {
        self.optional = names;
        self
    }
}
