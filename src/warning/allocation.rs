//! Warnings about extremes and allocated tolerances.

use crate::warning::text::{Text, names, say};
use crate::warning::{Advice, Ended};

pub(super) fn not_proven(
    characteristic: &str,
    evaluations: &usize,
    ended: &Ended,
    failed: &usize,
    failure: &Option<String>,
    bounds: &Option<([f64; 2], usize)>,
) -> Text {
    let doubt = match bounds {
        Some(([lower, upper], boxes)) => {
            format!(
                "Interval arithmetic on {boxes} boxes proves only that no assembly lies outside {lower} .. {upper}."
            )
        }
        None => "Assemblies beyond them cannot be ruled out, as they can for formulas.".to_owned(),
    };
    let cut = match ended {
        Ended::Converged => "",
        Ended::Budget => " The budget ended the search.",
        Ended::Stopped => " The search was stopped before its end.",
    };
    let lost = match failure {
        Some(error) => format!(" {failed} of its points have no value and were left out: {error}."),
        None => String::new(),
    };
    let text = say(format!(
        "The extremes of `{characteristic}` are the best of {evaluations} evaluations and are not proven. {doubt}{cut}{lost}"
    ));
    match (ended, bounds) {
        (Ended::Budget, _) => text.advise(Advice::RaiseBudget),
        (Ended::Stopped, _) => text.advise(Advice::RaiseTimeLimit),
        (Ended::Converged, None) => text.advise(Advice::UseFormula),
        (Ended::Converged, Some(_)) => text,
    }
}

pub(super) fn fit_replaced(dimensions: &[String]) -> Text {
    let (was, now) = match dimensions {
        [_] => ("was a fit", "It is a plain tolerance now."),
        _ => ("were fits", "They are plain tolerances now."),
    };
    say(format!("{} {was} of ISO 286. {now}", names(dimensions))).advise(Advice::NearestFit)
}

pub(super) fn not_confirmed() -> Text {
    say("Budget or time did not allow to evaluate the model at the tolerances found. They depend on derivatives taken at the present ones.")
        .advise(Advice::RaiseBudget)
        .advise(Advice::AnalyzeWrittenStudy)
}

pub(super) fn cost_not_convex(dimensions: &[String]) -> Text {
    let (cost, tolerance) = match dimensions {
        [_] => ("cost", "is not convex in its tolerance"),
        _ => ("costs", "are not convex in their tolerances"),
    };
    say(format!(
        "The {cost} of {} {tolerance}. Several tolerances may keep the conditions of an optimum; the cheapest one that was found is reported.",
        names(dimensions)
    ))
}

pub(super) fn confirmation_misses(
    characteristic: &str,
    requirement: &&'static str,
    required: &f64,
    [low, high]: &[f64; 2],
) -> Text {
    if *requirement == "worst-case" {
        return say(format!(
            "A point of the model within the tolerance bands refutes the worst case of `{characteristic}`. It takes {:.3} % of the room that the limits leave.",
            100.0 * low
        ))
        .advise(Advice::RequireMore);
    }
    let (name, low, high, required) = match *requirement {
        "yield" => {
            let percent = |share: f64| format!("{:.4} %", 100.0 * share);
            ("yield", percent(*low), percent(*high), percent(*required))
        }
        name => {
            let name = if name == "cpk" { "Cpk" } else { name };
            (name, format!("{low:.5}"), format!("{high:.5}"), required.to_string())
        }
    };
    say(format!(
        "A sample of the model refutes the {name} of `{characteristic}`. Its interval is {low} .. {high}, and {required} is required."
    ))
    .advise(Advice::RequireMore)
}

pub(super) fn joint_confirmation_misses(required: &f64, [low, high]: &[f64; 2]) -> Text {
    let percent = |share: &f64| format!("{:.4} %", 100.0 * share);
    say(format!(
        "A sample of the model refutes the joint yield. Its interval is {} .. {}, and {} is required.",
        percent(low),
        percent(high),
        percent(required)
    ))
    .advise(Advice::RequireMore)
}

pub(super) fn nothing_to_write() -> Text {
    say("No tolerances were found. The file to be written stays as it was.")
}

pub(super) fn not_written(reason: &str) -> Text {
    say(format!("The study cannot be written with the new tolerances: {reason}.")).advise(Advice::EditStudy)
}
