//! Settings that a study file does not hold: where the answers of external programs are kept, who hears them, and which
//! configuration is meant.

use std::fmt;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use sensitol::assembly::{AssemblyFunction, Signature, Table};
use sensitol_external::{Greeting, Listener};

/// Makes the function that answers a study's model from the names and units of its inputs and outputs, nominal values and constants.
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

/// How the external programs of a study are treated.
#[derive(Clone)]
pub struct Externals {
    /// Where their answers are kept.
    pub journal: JournalPlace,
    /// Who hears every line that they write to stderr.
    pub listener: Option<Listener>,
    /// Answers that were evaluated elsewhere: nothing is started then.
    pub points: Option<Arc<Table>>,
    /// Whether they are asked again and again for the nominal point, to see whether they still answer as they did.
    pub sentinels: bool,
    /// Which of the study's configurations is meant; the study as written where it is None.
    pub configuration: Option<String>,
    /// Whether only the points are wanted that something else is to answer: nothing is started then either.
    pub unanswered: bool,
    /// Who answers in place of a program.
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
    /// With answers kept there.
    #[must_use]
    pub fn with_journal(mut self, place: JournalPlace) -> Self {
        self.journal = place;
        self
    }

    /// With someone who hears every line that they write to stderr.
    #[must_use]
    pub fn with_listener(mut self, listener: Listener) -> Self {
        self.listener = Some(listener);
        self
    }

    /// With answers that were evaluated elsewhere in place of programs.
    #[must_use]
    pub fn with_points(mut self, table: Arc<Table>) -> Self {
        self.points = Some(table);
        self
    }

    /// Of this configuration of the study.
    #[must_use]
    pub fn with_configuration(mut self, name: impl Into<String>) -> Self {
        self.configuration = Some(name.into());
        self
    }

    /// With a function of the calling program as the study's model: in place of the program that its `[model]` names, and where it
    /// has no `[model]`. `host` gets names and units of inputs and outputs, nominal values and constants. Formulas may use its outputs.
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
    /// # Ok::<(), sensitol::Error>(())
    /// ```
    #[must_use]
    pub fn with_host(
        mut self,
        host: impl Fn(Signature, Greeting) -> Arc<dyn AssemblyFunction> + Send + Sync + 'static,
    ) -> Self {
        self.host = Some(Host(Arc::new(host)));
        self
    }

    /// To say which points something else is to answer.
    #[must_use]
    pub fn with_unanswered(mut self, unanswered: bool) -> Self {
        self.unanswered = unanswered;
        self
    }

    /// Whether nothing that this program starts answers.
    pub(super) fn elsewhere(&self) -> bool {
        self.points.is_some() || self.unanswered
    }

    /// With evaluations of the nominal point again and again, or without.
    #[must_use]
    pub fn with_sentinels(mut self, sentinels: bool) -> Self {
        self.sentinels = sentinels;
        self
    }
}

/// Where the answers of external programs are kept.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum JournalPlace {
    /// Nowhere: they are gone with the run.
    #[default]
    Nowhere,
    /// Beside the study: `gap.journal.sqlite` for `gap.toml`.
    BesideStudy,
    /// In this file.
    At(PathBuf),
}

impl JournalPlace {
    /// The command line's choice: a file, `none`, or nothing.
    pub fn asked(path: Option<&Path>) -> Self {
        match path {
            None => Self::BesideStudy,
            Some(path) if path.as_os_str() == "none" => Self::Nowhere,
            Some(path) => Self::At(path.to_owned()),
        }
    }

    /// The file for the study of this name.
    pub fn path(&self, study: &str) -> Option<PathBuf> {
        match self {
            Self::Nowhere => None,
            Self::BesideStudy => Some(Path::new(study).with_extension("journal.sqlite")),
            Self::At(path) => Some(path.clone()),
        }
    }
}
