//! The account of a model's processes, beside its answers.

use std::collections::BTreeMap;

use super::process_error::{ProcessError, ProcessFault};
use crate::summary::EvaluatorSummary;

/// Starts, failures and what they cost, since the model was made.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct EvaluatorAccount {
    /// Starts, failures and what they cost.
    pub counts: EvaluatorSummary,
    /// The last failure, with the last lines of stderr.
    pub last: Option<ProcessError>,
    /// For every place that answers named: how many points, and the seconds that the program says they took.
    pub places: BTreeMap<String, (u64, f64)>,
    /// How the model differs from the one whose answers the journal holds; None where it does not.
    pub outdated: Option<OutdatedJournal>,
    /// Why answers could not be kept, in a line; None where they could. Nothing was evaluated after that.
    pub not_kept: Option<String>,
}

/// A journal whose answers are those of another model than the one that runs now.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct OutdatedJournal {
    /// The first output that differs at the nominal dimensions.
    pub output: String,
    /// Its value in the journal; None where it had none.
    pub expected: Option<f64>,
    /// Its value now.
    pub found: Option<f64>,
    /// Answers that were forgotten.
    pub answers: usize,
}

impl OutdatedJournal {
    /// An output that was `expected` and is now `found`, so that so many answers were forgotten.
    pub fn new(output: impl Into<String>, [expected, found]: [Option<f64>; 2], answers: usize) -> Self {
        Self { output: output.into(), expected, found, answers }
    }
}

impl EvaluatorAccount {
    /// With that of another model of the same run.
    pub(crate) fn and(mut self, other: Self) -> Self {
        self.counts = self.counts.and(other.counts);
        for (name, (points, seconds)) in other.places {
            let place = self.places.entry(name).or_default();
            *place = (place.0 + points, place.1 + seconds);
        }
        Self {
            last: other.last.or(self.last),
            outdated: self.outdated.or(other.outdated),
            not_kept: self.not_kept.or(other.not_kept),
            ..self
        }
    }

    /// Whether any process failed.
    pub(crate) fn has_failures(&self) -> bool {
        self.counts.failures() > 0
    }

    /// Counts a failure of a process.
    pub fn failed(&mut self, error: &ProcessError) {
        match error.fault {
            ProcessFault::TimedOut { .. } | ProcessFault::SilentAtStart { .. } => self.counts.timeouts += 1,
            ProcessFault::Crashed { .. } | ProcessFault::EndedAtStart { .. } => self.counts.crashes += 1,
            _ => self.counts.garbage += 1,
        }
        self.last = Some(error.clone());
    }

    /// Counts an answer of a place.
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
