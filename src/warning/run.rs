//! Warnings about the course of a run.

use crate::summary::StopReason;
use crate::warning::text::{Text, lines, say};
use crate::warning::{Advice, Counted};

pub(super) fn stopped(
    cause: &StopReason,
    limit_s: &Option<f64>,
    done: &u64,
    planned: &Option<u64>,
    counted: &Counted,
) -> Text {
    let amount = match planned {
        Some(planned) => format!("{done} of {planned} {}", counted.noun(*planned)),
        None => format!("{done} {}", counted.noun(*done)),
    };
    let rest = if *done == 0 { "There is no result." } else { "The result covers only what was done until then." };
    match cause {
        StopReason::TimeLimit => {
            let limit = limit_s.map(|limit| format!(" of {limit} s")).unwrap_or_default();
            say(format!("The time limit{limit} ended the run after {amount}. {rest}")).advise(Advice::RaiseTimeLimit)
        }
        StopReason::Budget => {
            say(format!("The budget ended the run after {amount}. {rest}")).advise(Advice::RaiseBudget)
        }
        StopReason::Interrupted => say(format!("The run was interrupted after {amount}. {rest}")),
        StopReason::Requested => say(format!("The calling program ended the run after {amount}. {rest}")),
    }
}

pub(super) fn long(expected_s: &f64) -> Text {
    say(format!("This run will take about {}.", span(*expected_s))).advise(Advice::LimitTime)
}

/// Duration in the largest unit of which it has at least two.
fn span(seconds: f64) -> String {
    const UNITS: [(f64, &str); 4] =
        [(365.25 * 86400.0, "years"), (86400.0, "days"), (3600.0, "hours"), (60.0, "minutes")];
    let (size, name) = UNITS.into_iter().find(|(size, _)| seconds >= 2.0 * size).unwrap_or((1.0, "seconds"));
    let value = seconds / size;
    if value < 1e4 { format!("{value:.0} {name}") } else { format!("{value:.0e} {name}") }
}

pub(super) fn missing_points(count: &usize, written: &Option<String>) -> Text {
    let have = if *count == 1 { "1 point has" } else { &format!("{count} points have") };
    say(format!("{have} no answer. The result lacks whatever depends on them.")).advise(match written {
        None => Advice::WriteMissingPoints,
        Some(file) => Advice::AppendAnswers { file: file.clone() },
    })
}

pub(super) fn unmatched_points(count: &usize, first: &[usize]) -> Text {
    let belong = if *count == 1 { "1 answer belongs" } else { &format!("{count} answers belong") };
    say(format!("{belong} to no point of the evaluation plan: {}. The result does not use them.", lines(first, *count)))
}

pub(super) fn first_stage_only() -> Text {
    say("These are the points of the first stage. Those of later stages depend on its answers.")
        .advise(Advice::AnalyzeStages)
}
