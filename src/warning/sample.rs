//! Warnings about samples and rare events.

use crate::method_kind::Method;
use crate::warning::Advice;
use crate::warning::text::{Text, number, say};

pub(super) fn heavy_point(characteristic: &str, limit: &f64, part: &f64) -> Text {
    let limit = number(*limit);
    say(format!(
        "One point carries {:.0} % of the estimated probability of `{characteristic}` beyond {limit}. The surrogate does not show where rejects \
         lie. The probability may be above its interval.",
        100.0 * part
    ))
    .advise(Advice::MorePoints)
    .advise(Advice::UseMethod { methods: vec![Method::Full] })
}

pub(super) fn nothing_beyond(characteristic: &str, limit: &f64, points: &u64, most: &f64) -> Text {
    let limit = number(*limit);
    say(format!(
        "None of {points} points of `{characteristic}` lies beyond {limit}. The probability has no estimate, only the upper bound {most:.1e}."
    ))
    .advise(Advice::MorePoints)
}

pub(super) fn plain_sampling(characteristic: &str, limit: &f64, plain: &f64, evaluations: &u64) -> Text {
    let limit = number(*limit);
    say(format!(
        "`{characteristic}` is often beyond {limit}: a plain sample of {plain:.0} points has the same standard error as these {evaluations} \
         evaluations. The result is right."
    ))
    .advise(Advice::SamplePlainly)
}

pub(super) fn plain_fallback(characteristic: &str, limit: &f64, points: &u64) -> Text {
    let limit = number(*limit);
    say(format!(
        "Importance sampling does not find where `{characteristic}` lies beyond {limit}: its interval is wider than that of plain sampling. The \
         estimate is that of {points} plain points."
    ))
    .advise(Advice::SamplePlainly)
}

pub(super) fn unsettled_moments(
    characteristic: &str,
    figures: &[&'static str],
    points: &u64,
    largest: &f64,
    ten_largest: &f64,
    switch: &Option<String>,
) -> Text {
    let (names, have) = match figures {
        [most @ .., last] if !most.is_empty() => (format!("{} and {last}", most.join(", ")), "have"),
        _ => (figures.concat(), "has"),
    };
    let first = figures.first().copied().unwrap_or_default();
    let why = match switch {
        Some(switch) => format!("Assemblies beyond {switch} decide the {first}, and the sample hardly has any of them"),
        None => format!(
            "The largest point carries {:.0} % of the sum behind the error of the {first}, and the ten largest {:.0} %",
            100.0 * largest,
            100.0 * ten_largest
        ),
    };
    say(format!(
        "The {names} of `{characteristic}` {have} not settled after {points} points. {why}. No standard error is known, and the true value may \
         be far off."
    ))
    .advise(Advice::MorePoints)
    .advise(Advice::Analyze)
}

pub(super) fn target_error_missed(points: &u64) -> Text {
    say(format!("The standard errors are larger than wanted after {points} points.")).advise(Advice::MorePoints)
}
