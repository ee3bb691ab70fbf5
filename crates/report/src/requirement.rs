//! Requirements in the words of every document. No other file of this package distinguishes their kinds.

use crate::document::number::{index, known, plain, share, significant, target_yield, within, yielded};
use crate::document::rejects::Rejects;
use crate::document::{Line, Tone};
use sensitol_numeric::json_form::finite;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::sampling::one_error;
use sensitol_numeric::verdict::{Judged, Verdict};

/// Greatest number of significant digits of a value beside its requirement.
const MOST_DIGITS: usize = 6;

/// Returns a line for each requirement: the value, the required one, and the verdict. The target yield is left out, because it stands
/// beside the yield.
pub(super) fn lines(judged: Vec<Judged>) -> impl Iterator<Item = Line> {
    judged.into_iter().filter_map(|one| {
        let number = |value: f64| significant(value, 4);
        let found = known(one.value.and_then(finite), number);
        let required = match one.requirement {
            Requirement::Yield(_) => return None,
            Requirement::Cpk(least) => format!("Cpk of at least {}: {found}", number(least)),
            Requirement::Sigma(most) => format!("sigma of at most {}: {found}", number(most)),
            other => format!("{} within the limits: {found} of the room", other.name()),
        };
        Some(Line::from(format!("requires {required}, ")).and(loud(one.verdict)))
    })
}

/// Returns a verdict in its tone. A missed target is in capitals, to stand out without colours.
pub(super) fn loud(verdict: Verdict) -> Line {
    match verdict {
        Verdict::Met => Line::toned("met", Tone::Good),
        Verdict::Missed => Line::toned("MISSED", Tone::Bad),
        Verdict::Inconclusive => Line::toned("inconclusive", Tone::Doubtful),
    }
}

/// Returns the target yield with its verdict, to follow the yield; empty without a target.
pub(super) fn judged(target: Option<f64>, verdict: Option<Verdict>) -> Line {
    let Some((target, verdict)) = target.zip(verdict) else { return Line::default() };
    Line::from(format!(", target {}: ", target_yield(target))).and(loud(verdict))
}

/// Returns the requirement as a demand in a sentence: `a Cpk of 1.33`.
pub(super) fn demand(requirement: Requirement) -> String {
    match requirement {
        Requirement::Yield(least) => format!("a yield of {}", target_yield(least)),
        Requirement::Cpk(least) => format!("a Cpk of {}", plain(least)),
        Requirement::Sigma(most) => format!("a sigma of {}", plain(most)),
        Requirement::Rss => "its limits by rss".to_owned(),
        Requirement::WorstCase => "its limits in the worst case".to_owned(),
    }
}

/// Returns the requirement in a cell of a table: `Cpk 1.33`.
pub(super) fn brief(requirement: Requirement) -> String {
    match requirement {
        Requirement::Yield(least) => format!("yield {}", target_yield(least)),
        Requirement::Cpk(number) | Requirement::Sigma(number) => format!("{} {}", requirement.name(), plain(number)),
        Requirement::Rss | Requirement::WorstCase => requirement.name().to_owned(),
    }
}

/// Returns the label of a point of a Pareto front. For rss and worst case it is the usable part of the room.
pub(super) fn front_label(requirement: Requirement, amount: f64) -> String {
    match requirement {
        Requirement::Yield(least) => target_yield(least),
        Requirement::Cpk(least) => format!("Cpk {}", significant(least, 4)),
        Requirement::Sigma(most) => format!("sigma {}", significant(most, 4)),
        Requirement::Rss | Requirement::WorstCase => of_the_room(amount, 4),
    }
}

/// Returns the place of a requirement on the axis of a front, and its label: the logarithm of the reject rate for a yield, else the amount.
pub(super) fn axis_place(requirement: Requirement, amount: f64) -> (f64, String) {
    if requirement.target_yield().is_none() {
        return (amount, significant(amount, 3));
    }
    let rejected = (1.0 - amount).max(f64::MIN_POSITIVE);
    (-libm::log10(rejected), share(rejected))
}

/// Formats a value in the measure of its requirement.
pub(super) fn measure(requirement: Requirement, value: f64) -> String {
    match requirement {
        Requirement::Yield(_) => yielded(value),
        Requirement::Cpk(_) => format!("{value:.4}"),
        Requirement::Sigma(_) => significant(value, 6),
        Requirement::Rss | Requirement::WorstCase => of_the_room(value, 5),
    }
}

/// Formats a value in the measure of its requirement, with the few digits of a summary.
pub(super) fn short_measure(requirement: Requirement, value: f64) -> String {
    match requirement {
        Requirement::Yield(_) => yielded(value),
        Requirement::Cpk(_) => index(value),
        Requirement::Sigma(_) => significant(value, 4),
        Requirement::Rss | Requirement::WorstCase => of_the_room(value, 4),
    }
}

/// Formats a judged value in the measure of its requirement, with no digit beyond its interval.
pub(super) fn found(judged: &Judged) -> String {
    let Some(value) = judged.value.and_then(finite) else { return "unknown".to_owned() };
    let Some([low, high]) = judged.interval.filter(|ends| ends.iter().all(|end| end.is_finite())) else {
        return measure(judged.requirement, value);
    };
    let (full, error) = (measure(judged.requirement, value), one_error(value, [low, high]));
    match judged.requirement {
        Requirement::Yield(_) => Rejects::all(1.0 - value, Some(error)).yield_text().unwrap_or(full),
        Requirement::Cpk(_) | Requirement::Sigma(_) => {
            let carried = within(value, MOST_DIGITS, Some(error));
            if carried.len() < full.len() { carried } else { full }
        }
        Requirement::Rss | Requirement::WorstCase => full,
    }
}

fn of_the_room(part: f64, digits: usize) -> String {
    format!("{} % of the room", significant(100.0 * part, digits))
}
