//! What is required, as every report has it.

use serde::Serialize;

use crate::document::number::{known, significant, yielded};
use crate::document::{Line, Tone};
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
    pub(super) fn line(&self) -> Option<Line> {
        let number = |value: f64| if self.requirement == "yield" { yielded(value) } else { significant(value, 4) };
        let found = known(self.value, number);
        let required = match self.requirement {
            "yield" => return None,
            "cpk" => format!("Cpk of at least {}: {found}", number(self.required)),
            "sigma" => format!("sigma of at most {}: {found}", number(self.required)),
            name => format!("{name} within the limits: {found} of the room"),
        };
        Some(Line::from(format!("requires {required}, ")).and(loud(self.verdict)))
    }
}

/// The ends of an interval that there are.
pub(super) fn ends(interval: [f64; 2]) -> [Option<f64>; 2] {
    interval.map(|end| Some(end).filter(|end| end.is_finite()))
}

/// A verdict in its tone; a missed target is to be seen at once, with colours or without.
pub(super) fn loud(verdict: Verdict) -> Line {
    match verdict {
        Verdict::Met => Line::toned("met", Tone::Good),
        Verdict::Missed => Line::toned("MISSED", Tone::Bad),
        Verdict::Inconclusive => Line::toned("inconclusive", Tone::Doubtful),
    }
}

/// The target yield and whether it is met, after the yield; empty without a target.
pub(super) fn judged(target: Option<f64>, verdict: Option<Verdict>) -> Line {
    let Some((target, verdict)) = target.zip(verdict) else { return Line::default() };
    Line::from(format!(", target {}: ", yielded(target))).and(loud(verdict))
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
