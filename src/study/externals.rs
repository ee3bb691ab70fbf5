//! What a study file does not say: where the answers of external programs are kept, who hears them, and which configuration is meant.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::assembly::Table;
use crate::assembly::process::Listener;

/// How the external programs of a study are treated.
#[derive(Clone)]
#[non_exhaustive]
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
}

impl Default for Externals {
    fn default() -> Self {
        Self { journal: JournalPlace::Nowhere, listener: None, points: None, sentinels: true, configuration: None }
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
    /// What the command line asks for: a file, `none`, or nothing.
    pub(crate) fn asked(path: Option<&Path>) -> Self {
        match path {
            None => Self::BesideStudy,
            Some(path) if path.as_os_str() == "none" => Self::Nowhere,
            Some(path) => Self::At(path.to_owned()),
        }
    }

    /// The file for the study of this name.
    pub(crate) fn path(&self, study: &str) -> Option<PathBuf> {
        match self {
            Self::Nowhere => None,
            Self::BesideStudy => Some(Path::new(study).with_extension("journal.sqlite")),
            Self::At(path) => Some(path.clone()),
        }
    }
}
