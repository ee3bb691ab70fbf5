//! Account of a model's processes.

use std::collections::BTreeMap;
use std::path::PathBuf;

use crate::assembly::process_error::{ProcessError, ProcessFault};
use crate::summary::EvaluatorSummary;

/// Starts, failures and their cost, since the model was created.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct EvaluatorAccount {
    /// Counts of starts and failures, with their cost.
    pub counts: EvaluatorSummary,
    /// Last failure, with the last lines of stderr.
    pub last: Option<ProcessError>,
    /// Number of points and seconds (as the program states) for every place that answers named.
    pub places: BTreeMap<String, (u64, f64)>,
    /// Difference between the model and the one whose answers the journal holds; None if there is none.
    pub outdated: Option<OutdatedJournal>,
    /// Damaged answers in the journal; None if there were none. They are evaluated again.
    pub damaged: Option<DamagedJournal>,
    /// Reason in one line why answers could not be stored; None if all were stored. Nothing was evaluated after that.
    pub not_kept: Option<String>,
    /// Error of a model that failed at every point so far; None for others. Nothing was evaluated after that.
    pub fails_everywhere: Option<ProcessError>,
}

/// Journal whose answers belong to another model than the one that runs now.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutdatedJournal {
    /// Name of the first output that differs at the nominal dimensions.
    pub output: String,
    /// Value in the journal; None if it had none.
    pub expected: Option<f64>,
    /// Value of the model that runs now.
    pub found: Option<f64>,
    /// Number of answers that were discarded.
    pub answers: usize,
}

/// Journal with answers whose checksums do not agree.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct DamagedJournal {
    /// Path of the file.
    pub file: PathBuf,
    /// Number of damaged answers.
    pub answers: usize,
}

impl DamagedJournal {
    /// Creates the finding that so many answers of this file are damaged.
    pub fn new(file: PathBuf, answers: usize) -> Self {
        Self { file, answers }
    }
}

impl OutdatedJournal {
    /// Creates the finding that an output was `expected` and is now `found`, so that `answers` answers were discarded.
    pub fn new(output: impl Into<String>, [expected, found]: [Option<f64>; 2], answers: usize) -> Self {
        Self { output: output.into(), expected, found, answers }
    }
}

impl EvaluatorAccount {
    /// Adds the account of another model of the same run.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.counts = self.counts.and(other.counts);
        for (name, (points, seconds)) in other.places {
            let place = self.places.entry(name).or_default();
            *place = (place.0 + points, place.1 + seconds);
        }
        Self {
            last: other.last.or(self.last),
            outdated: self.outdated.or(other.outdated),
            damaged: self.damaged.or(other.damaged),
            not_kept: self.not_kept.or(other.not_kept),
            fails_everywhere: self.fails_everywhere.or(other.fails_everywhere),
            ..self
        }
    }

    pub(crate) fn has_failures(&self) -> bool {
        self.counts.failures() > 0
    }

    /// Counts a failure of a process.
    pub fn failed(&mut self, error: &ProcessError) {
        match error.fault {
            ProcessFault::TimedOut { .. } | ProcessFault::SilentAtStart { .. } | ProcessFault::EndlessLine { .. } => {
                self.counts.timeouts += 1
            }
            ProcessFault::Crashed { .. } | ProcessFault::EndedAtStart { .. } => self.counts.crashes += 1,
            _ => self.counts.garbage += 1,
        }
        self.last = Some(error.clone());
    }

    /// Counts an answer, with the place and the cost that it states.
    pub fn answered(&mut self, place: Option<&String>, cost_s: Option<f64>) {
        if place.is_some() || cost_s.is_some() {
            let name = place.map_or("", String::as_str);
            if !self.places.contains_key(name) {
                self.places.insert(name.to_owned(), (0, 0.0));
            }
            if let Some((points, seconds)) = self.places.get_mut(name) {
                *points += 1;
                *seconds += cost_s.filter(|cost| cost.is_finite() && *cost >= 0.0).unwrap_or(0.0);
            }
        }
    }
}
