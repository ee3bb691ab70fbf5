//! The common head of every report.

use serde::Serialize;

use crate::document::number::plural;
use crate::document::{Element, Notice, Tone};
use crate::{About, SCHEMA, WarningReport};
use sensitol::summary::RunSummary;

/// Versions, the study, and the command.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct Head {
    /// The version of this shape.
    pub(crate) schema: u32,
    /// The version of the program.
    pub(crate) sensitol: &'static str,
    /// The study's title.
    pub(crate) title: Option<String>,
    /// SHA-256 of the study file and the files of measured values that it reads.
    pub(crate) study_sha256: String,
    /// The command that made the report.
    pub(crate) command: &'static str,
    /// The cells of the title block of pages.
    #[serde(skip)]
    pub(crate) block: Vec<(&'static str, String)>,
}

impl Head {
    pub(super) fn of(command: &'static str, about: &About) -> Self {
        let (title, study_sha256) = (about.title.clone(), about.sha256.clone());
        let block = about.block.clone();
        Self { schema: SCHEMA, sensitol: env!("CARGO_PKG_VERSION"), title, study_sha256, command, block }
    }
}

/// Returns facts of a run for the end of a line: known, repeated and failed points, and the stop reason.
pub(super) fn beside(run: &RunSummary) -> String {
    let some = |count: u64, text: String| if count > 0 { text } else { String::new() };
    let stopped = run.stopped.map_or(String::new(), |reason| format!(", stopped by {reason}"));
    some(run.cached, format!(", {} known already", run.cached))
        + &some(run.retried, format!(", {} sent again", run.retried))
        + &some(run.failed, format!(", {} failed", plural(run.failed as usize, "point", "points")))
        + &stopped
}

/// Formats the evaluations, with the number of rounds if the model is external. Every round waits for the answers of the round before, so
/// workers beyond the points of a round stay idle. A model in this process has no such waits.
pub(super) fn evaluations(run: &RunSummary) -> String {
    let evaluations = plural(run.evaluations as usize, "evaluation", "evaluations");
    match run.evaluator {
        Some(_) if run.evaluations > 0 => format!("{evaluations} in {}", rounds(run)),
        _ => evaluations,
    }
}

/// Formats the number of rounds in which points were sent.
pub(super) fn rounds(run: &RunSummary) -> String {
    plural(run.stages as usize, "round", "rounds")
}

/// Formats the seed of a run for the end of a line, empty if there is none.
pub(super) fn seed(run: &RunSummary) -> String {
    run.seed.map_or(String::new(), |seed| format!(", seed {seed}"))
}

/// Returns the warnings that need attention and whose characteristic (None for the whole study) `about` accepts.
pub(super) fn findings(all: &[WarningReport], about: impl Fn(Option<&str>) -> bool) -> Vec<Element> {
    let found = |one: &WarningReport| {
        let actions = one.advice.iter().map(ToString::to_string).collect();
        Element::Finding(Notice { code: one.code, message: one.message.clone(), actions, tone: Tone::Doubtful })
    };
    all.iter().filter(|one| one.asks() && about(one.characteristic.as_deref())).map(found).collect()
}
