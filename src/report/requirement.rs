//! What is required, as every report has it.

use serde::Serialize;

use super::number::{UNKNOWN, share, significant};
use crate::requirement::Requirement;
use crate::verdict::{Judged, Verdict};

/// Something that a characteristic must keep, and whether it does.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RequirementReport {
    /// `yield`, `cpk`, `sigma`, `rss` or `worst-case`.
    pub requirement: &'static str,
    /// How much of it; of `rss` and `worst-case` at most all of the room that the limits leave, 1.
    pub required: f64,
    /// What there is.
    pub value: Option<f64>,
    /// Within which that is known, an end null where there is none; null where it is not known at all.
    pub interval: Option<[Option<f64>; 2]>,
    /// Whether it is kept; null where that is not known.
    pub met: Option<bool>,
    /// The same in a word.
    pub verdict: Verdict,
}

impl RequirementReport {
    pub(super) fn of(judged: &Judged) -> Self {
        Self {
            requirement: word(judged.requirement),
            required: amount(judged.requirement),
            value: judged.value.filter(|value| value.is_finite()),
            interval: judged.interval.map(ends),
            met: judged.verdict.met(),
            verdict: judged.verdict,
        }
    }

    /// In a line: what there is, what is required, and the verdict. Of a target yield, which stands beside the yield, None.
    pub(super) fn line(&self) -> Option<String> {
        let number = |value: f64| if self.requirement == "yield" { share(1.0 - value) } else { significant(value, 4) };
        let found = self.value.map_or(UNKNOWN.to_owned(), number);
        let required = match self.requirement {
            "yield" => return None,
            "cpk" => format!("Cpk of at least {}: {found}", number(self.required)),
            "sigma" => format!("sigma of at most {}: {found}", number(self.required)),
            name => format!("{name} within the limits: {found} of the room"),
        };
        Some(format!("requires {required}, {}", loud(self.verdict)))
    }
}

/// The ends of an interval that there are.
pub(super) fn ends(interval: [f64; 2]) -> [Option<f64>; 2] {
    interval.map(|end| Some(end).filter(|end| end.is_finite()))
}

/// A verdict in a text, where a missed target is to be seen at once.
pub(super) fn loud(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Missed => "MISSED",
        other => other.name(),
    }
}

pub(super) fn word(requirement: Requirement) -> &'static str {
    match requirement {
        Requirement::Cpk(_) => "cpk",
        other => other.name(),
    }
}

/// How much is required; of limits, all of the room that they leave.
pub(super) fn amount(requirement: Requirement) -> f64 {
    requirement.value().unwrap_or(1.0)
}
