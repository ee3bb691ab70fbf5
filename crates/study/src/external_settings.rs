//! Settings that a study file does not hold: the journal of external programs, the callback for their messages, and the configuration.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sensitol::assembly::{AssemblyFunction, Signature, Table};
use sensitol_external::{Greeting, Listener};

/// Makes the function that answers a study's model, from the names and units of its inputs and outputs, nominal values and constants.
#[derive(Clone)]
pub struct Host(Arc<dyn Fn(Signature, Greeting) -> Arc<dyn AssemblyFunction> + Send + Sync>);

impl Host {
    pub(super) fn function(&self, signature: Signature, greeting: Greeting) -> Arc<dyn AssemblyFunction> {
        self.0(signature, greeting)
    }
}

impl fmt::Debug for Host {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Host")
    }
}

/// Settings of the external programs of a study.
#[derive(Clone)]
pub struct Externals {
    /// Place of the journal that keeps their answers.
    pub journal: JournalPlace,
    /// Callback for every line that they write to stderr.
    pub listener: Option<Listener>,
    /// Answers that were evaluated elsewhere. No program is started then.
    pub points: Option<Arc<Table>>,
    /// True if the nominal point is evaluated again from time to time, to check that the programs still give the same answer.
    pub sentinels: bool,
    /// Name of the configuration; None for the study as written.
    pub configuration: Option<String>,
    /// True if only the points are requested, which something else will answer. No program is started then.
    pub unanswered: bool,
    /// Function that answers in place of a program.
    pub host: Option<Host>,
}

impl Default for Externals {
    fn default() -> Self {
        Self {
            journal: JournalPlace::Nowhere,
            listener: None,
            points: None,
            sentinels: true,
            configuration: None,
            unanswered: false,
            host: None,
        }
    }
}

impl Externals {
    /// Keeps answers in a journal at this place.
    #[must_use]
    pub fn with_journal(mut self, place: JournalPlace) -> Self {
        self.journal = place;
        self
    }

    /// Sets a callback for every line that the programs write to stderr.
    #[must_use]
    pub fn with_listener(mut self, listener: Listener) -> Self {
        self.listener = Some(listener);
        self
    }

    /// Uses answers that were evaluated elsewhere, in place of programs.
    #[must_use]
    pub fn with_points(mut self, table: Arc<Table>) -> Self {
        self.points = Some(table);
        self
    }

    /// Selects a configuration of the study.
    #[must_use]
    pub fn with_configuration(mut self, name: impl Into<String>) -> Self {
        self.configuration = Some(name.into());
        self
    }

    /// Uses a function of the calling program as the study's model, in place of the program of its `[model]`, or if it has no `[model]`.
    /// `host` gets names and units of inputs and outputs, nominal values and constants. Formulas may use its outputs.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use sensitol_study::{Externals, Study, StudyText};
    /// use sensitol::{Closure, analyze};
    /// let text = r#"
    ///     [dimensions]
    ///     bore = { nominal = 25.02, tolerance = 0.01 }
    ///     shaft = { nominal = 24.98, tolerance = 0.01 }
    ///     [characteristics]
    ///     gap = { unit = "mm" }
    ///     microns = { formula = "1000*gap" }
    /// "#;
    /// let externals = Externals::default().with_host(|signature, greeting| {
    ///     assert_eq!((signature.outputs[0].name.as_str(), greeting.nominal[1]), ("gap", 24.98));
    ///     Arc::new(Closure::scalar("gap", |x| x[0] - x[1]))
    /// });
    /// let study = Study::from_text(StudyText::toml("gap.toml", text).with_externals(externals))?;
    /// let found = analyze(&study.problem, &study.options)?;
    /// assert!((found.characteristics[1].moments.unwrap().mean() - 40.0).abs() < 1e-9);
    /// # Ok::<(), sensitol_study::AnyError>(())
    /// ```
    #[must_use]
    pub fn with_host(
        mut self,
        host: impl Fn(Signature, Greeting) -> Arc<dyn AssemblyFunction> + Send + Sync + 'static,
    ) -> Self {
        self.host = Some(Host(Arc::new(host)));
        self
    }

    /// Sets that only the points are requested, which something else will answer.
    #[must_use]
    pub fn with_unanswered(mut self, unanswered: bool) -> Self {
        self.unanswered = unanswered;
        self
    }

    /// True if nothing that this program starts gives the answers.
    pub(super) fn elsewhere(&self) -> bool {
        self.points.is_some() || self.unanswered
    }

    /// Turns repeated evaluations of the nominal point on or off.
    #[must_use]
    pub fn with_sentinels(mut self, sentinels: bool) -> Self {
        self.sentinels = sentinels;
        self
    }
}

/// Place of the journal of external programs.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum JournalPlace {
    /// No journal: the answers are lost after the run.
    #[default]
    Nowhere,
    /// A file beside the study: `gap.journal.sqlite` for `gap.toml`.
    BesideStudy,
    /// The given file.
    At(PathBuf),
}

impl JournalPlace {
    /// Place that the command line requests: a file, `none`, or by default beside the study.
    pub fn asked(path: Option<&Path>) -> Self {
        match path {
            None => Self::BesideStudy,
            Some(path) if path.as_os_str() == "none" => Self::Nowhere,
            Some(path) => Self::At(path.to_owned()),
        }
    }

    /// Path of the journal for the study of this name. Returns None if there is no journal.
    pub fn path(&self, study: &str) -> Option<PathBuf> {
        match self {
            Self::Nowhere => None,
            Self::BesideStudy => Some(Path::new(study).with_extension("journal.sqlite")),
            Self::At(path) => Some(path.clone()),
        }
    }
}
