//! Requirements in the words of every document.

use crate::document::number::{known, significant, target_yield};
use crate::document::{Line, Tone};
use sensitol_numeric::json_form::finite;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::verdict::{Judged, Verdict};

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
