//! What every report begins with.

use serde::Serialize;

use super::{About, SCHEMA};

/// Versions, the study, and the command.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Head {
    /// The version of this shape.
    pub schema: u32,
    /// The version of the program.
    pub sensitol: &'static str,
    /// The study's title.
    pub title: Option<String>,
    /// SHA-256 of the study file and the files of measured values that it reads.
    pub study_sha256: String,
    /// The command that made the report.
    pub command: &'static str,
}

impl Head {
    pub(super) fn of(command: &'static str, about: &About) -> Self {
        let (title, study_sha256) = (about.title.clone(), about.sha256.clone());
        Self { schema: SCHEMA, sensitol: env!("CARGO_PKG_VERSION"), title, study_sha256, command }
    }
}
