//! Errors as data with their place in the study, for pages.

use serde_json::{Value, json};

use sensitol_numeric::names::clipped;
use sensitol_study::AnyError;
use sensitol_study::StudyError;

/// Faults of a study, each with its place in the text in bytes.
pub(super) fn of_study(error: &StudyError) -> Value {
    let all: Vec<Value> = std::iter::once(error).chain(&error.more).map(one).collect();
    json!({ "faults": all })
}

fn one(error: &StudyError) -> Value {
    let mut alone = error.clone();
    alone.more.clear();
    let whole = AnyError::from(alone);
    let advice: Vec<String> = whole.advice().iter().map(ToString::to_string).collect();
    json!({
        "key": error.place_name(),
        "fault": error.message(),
        "help": whole.help().or_else(|| (!advice.is_empty()).then(|| advice.join(" "))),
        "start": error.span.as_ref().map(|span| span.start),
        "end": error.span.as_ref().map(|span| span.end),
        "line": error.line_column().map(|(line, _)| line),
        "column": error.line_column().map(|(_, column)| column),
    })
}

/// Refusal of a run that would start a program without permission.
pub(super) fn not_asked(program: &[String]) -> Value {
    let program = program.join(" ");
    json!({
        "error": format!("the model is a program, `{program}`, and it starts only when it is asked for"),
        "advice": ["ask for the run with programs=yes"],
    })
}

/// Fault of a study, or any other error.
pub(super) fn of_engine(error: &AnyError) -> Value {
    if let AnyError::Study(error) = error {
        return of_study(error);
    }
    let advice: Vec<String> = error.advice().iter().map(ToString::to_string).collect();
    json!({ "error": clipped(&error.to_string()), "advice": advice })
}
