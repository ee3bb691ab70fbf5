//! Warnings about the answers of the model.

use crate::method_kind::Method;
use crate::warning::Advice;
use crate::warning::text::{Text, say};

pub(super) fn failed_points(characteristic: &str, failed: &usize, points: &usize, point: &str, error: &str) -> Text {
    say(format!(
        "`{characteristic}` has no value at {failed} of {points} points. The first is at {point}: {error}. The share of assemblies without a \
         value is unknown."
    ))
    .advise(Advice::RepairModel)
}

pub(super) fn recorded_failures(characteristic: &str, failed: &usize, point: &str) -> Text {
    let (points, lie) =
        if *failed == 1 { ("1 point", "It is at") } else { (&*format!("{failed} points"), "The first is at") };
    say(format!(
        "The journal holds {points} within the tolerance bands at which `{characteristic}` had no value in earlier runs. {lie} {point}. The share \
         of assemblies without a value is unknown."
    ))
    .advise(Advice::Sample { points: None })
}

pub(super) fn failed_samples(characteristic: &str, failed: &u64, samples: &u64, error: &str) -> Text {
    say(format!(
        "`{characteristic}` has no value at {failed} of {samples} sampled points. The first error: {error}. The results are those of the other \
         points."
    ))
    .advise(Advice::RepairModel)
}

pub(super) fn overflow(characteristic: &str, value: &f64, limit: &f64) -> Text {
    say(format!(
        "Values of `{characteristic}` reach {value:.1e}. Beyond {limit:.0e} their powers overflow: moments, yield and error estimates may be unknown \
         or wrong."
    ))
    .advise(Advice::LargerUnit)
}

pub(super) fn unrepresentable(characteristic: &str) -> Text {
    say(format!(
        "Some figures of `{characteristic}`, such as its second derivatives, lie outside the range of double-precision numbers, 1e-308 to 1.8e308. \
         They are unknown here. All other figures hold."
    ))
    .advise(Advice::OrdinaryUnit)
}

pub(super) fn outside_model(output: &str, reason: &str) -> Text {
    say(format!(
        "Evaluated values of `{output}` lie outside the model: {reason}. Results that use them describe no real part."
    ))
}

pub(super) fn not_repeatable(
    output: &str,
    expected: &Option<f64>,
    found: &Option<f64>,
    times: &usize,
    points: &usize,
    suspects: &[String],
) -> Text {
    let cause = "Its answers depend on the points evaluated before.";
    nominal(output, [expected, found], *times, cause, *points, suspects).advise(Advice::ResetModel)
}

pub(super) fn branch_flip(
    output: &str,
    expected: &Option<f64>,
    found: &Option<f64>,
    times: &usize,
    points: &usize,
    suspects: &[String],
) -> Text {
    let cause = "The model has settled in another solution.";
    nominal(output, [expected, found], *times, cause, *points, suspects)
        .advise(Advice::ResetModel)
        .advise(Advice::SignedMeasure)
}

/// Warning about answers that depend on the points before.
fn nominal(
    output: &str,
    [expected, found]: [&Option<f64>; 2],
    times: usize,
    cause: &str,
    points: usize,
    suspects: &[String],
) -> Text {
    let value = |value: &Option<f64>| value.map_or("no value".to_owned(), |value| value.to_string());
    let times = if times == 1 { "once".to_owned() } else { format!("{times} times") };
    let among = if suspects.is_empty() { String::new() } else { format!(", among them {}", suspects.join("; ")) };
    let points = if points == 1 { "1 point".to_owned() } else { format!("{points} points") };
    say(format!(
        "`{output}` is {} or {} at the same dimensions, depending on the points before ({times}). {cause} A fresh process evaluated {points} again{among}.",
        value(expected),
        value(found)
    ))
}

#[allow(clippy::too_many_arguments, reason = "one argument for each field of the warning")]
pub(super) fn restarts(
    starts: &u64,
    crashes: &u64,
    timeouts: &u64,
    garbage: &u64,
    retried: &u64,
    lost_s: &f64,
    cause: &str,
    stderr: &[String],
) -> Text {
    let count = |count: u64, one: &str, many: &str| match count {
        0 => None,
        1 => Some(format!("1 {one}")),
        count => Some(format!("{count} {many}")),
    };
    let failures = [
        count(*crashes, "crash", "crashes"),
        count(*timeouts, "time-out", "time-outs"),
        count(*garbage, "invalid line", "invalid lines"),
    ];
    let failures = failures.into_iter().flatten().collect::<Vec<_>>().join(", ");
    let again = count(*retried, "evaluation was", "evaluations were").unwrap_or("no evaluation was".to_owned());
    let words =
        if stderr.is_empty() { String::new() } else { format!(" Its stderr ended with: {}.", stderr.join(" | ")) };
    say(format!(
        "Processes of the model failed: {failures}, {starts} starts in all. Because of that {again} repeated, and {lost_s:.1} s were lost. The \
         last cause: {cause}.{words}"
    ))
    .advise(Advice::ReadModelLog)
}

pub(super) fn unconfirmed(answers: &u64, changed: &bool) -> Text {
    let (answers, them) = if *answers == 1 { ("1 answer", "it") } else { (&*format!("{answers} answers"), "them") };
    let (why, advice) = match changed {
        true => ("the model gives other values after other points", Advice::ResetModel),
        false => ("the run ended before that check", Advice::RunAgain),
    };
    say(format!("No fresh process confirmed {answers}: {why}. Results that use {them} may be wrong.")).advise(advice)
}

pub(super) fn outdated_journal(output: &str, expected: &Option<f64>, found: &Option<f64>, answers: &usize) -> Text {
    let value = |value: &Option<f64>| value.map_or("no value".to_owned(), |value| value.to_string());
    say(format!(
        "`{output}` is {} at the nominal dimensions, and the journal has {}: the model has changed. Its {answers} answers in the journal \
         were removed.",
        value(found),
        value(expected)
    ))
    .advise(Advice::NameModelFiles)
}

pub(super) fn damaged_journal(file: &str, answers: &usize) -> Text {
    let (answers, them) =
        if *answers == 1 { ("1 answer", "it was") } else { (&*format!("{answers} answers"), "they were") };
    say(format!(
        "The journal {file} has {answers} with a wrong checksum: the file was damaged on its disk. Where this run needs them, {them} evaluated again."
    ))
}

pub(super) fn no_reaction(characteristic: &str) -> Text {
    say(format!("`{characteristic}` is the same at every evaluated point. Its sigma is 0, unless an interaction that was not examined moves it."))
        .advise(Advice::CheckInputs)
        .advise(Advice::UseMethod { methods: vec![Method::Full] })
}

pub(super) fn atom(characteristic: &str, points: &usize) -> Text {
    say(format!(
        "`{characteristic}` is exactly 0 at {points} points. A distance that ends at contact hides interference, so the lower tail is missing."
    ))
    .advise(Advice::SignedMeasure)
}

pub(super) fn noise(characteristic: &str, rounding: &f64) -> Text {
    say(format!("One rounding error of `{characteristic}` is {rounding:.1e} of its sigma. Derivatives are no more accurate than that."))
        .advise(Advice::NearerDatum)
}

pub(super) fn scatter(characteristic: &str, scatter: &f64, drowned: &usize) -> Text {
    let drowned = match drowned {
        0 => String::new(),
        1 => " It hides the curvature along one dimension.".to_owned(),
        many => format!(" It hides the curvature along {many} dimensions."),
    };
    say(format!(
        "Answers of `{characteristic}` next to the means scatter by {scatter:.1e} of its sigma.{drowned} The result is no more accurate than \
         the scatter."
    ))
    .advise(Advice::TightenSolver)
}
