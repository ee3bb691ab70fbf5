//! Warnings about measured values.

use crate::warning::Advice;
use crate::warning::text::{Text, likewise, lines, names, say, values_and_lines};

/// Number of measured values that make a sufficient sample.
const ENOUGH: usize = 30;

pub(super) fn missing_values(dimension: &str, file: &str, missing: &usize, rows: &usize, first: &[u64]) -> Text {
    let are = if *missing == 1 { "is" } else { "are" };
    let (of, first) = (format!("{missing} of {rows} values of `{dimension}`"), lines(first, *missing));
    say(format!("{of} {are} missing in {file} ({first}). The result assumes that the others represent all parts."))
        .advise(Advice::FindMissingValues)
}

pub(super) fn unmatched_rows(dimension: &str, file: &str, unmatched: &usize, first: &[u64]) -> Text {
    let (have, are) = if *unmatched == 1 { ("has", "It is") } else { ("have", "They are") };
    let rows = if *unmatched == 1 { "row" } else { "rows" };
    let of = format!("{unmatched} {rows} of `{dimension}`");
    say(format!("{of} in {file} {have} no partner in the other files ({}). {are} left out.", lines(first, *unmatched)))
        .advise(Advice::FindMissingValues)
}

pub(super) fn rows_by_copula([a, b]: &[String; 2], [rows, taken]: &[f64; 2]) -> Text {
    say(format!(
        "The rows of `{a}` and `{b}` are correlated by {rows:.3}, more than the copula between measured columns can be. The result takes {taken:.3}."
    ))
    .advise(Advice::MeasureMore { values: ENOUGH })
}

pub(super) fn outliers(dimension: &str, file: &str, count: &usize, values: &usize, first: &[(f64, u64)]) -> Text {
    let (lie, which) = if *count == 1 { ("lies", "It is") } else { ("lie", "They are") };
    let first = values_and_lines(first, *count);
    say(format!(
        "{count} of {values} values of `{dimension}` in {file} {lie} farther out than a normal sample of this size reaches: {first}. \
         {which} part of the result and can decide skewness, kurtosis and yield."
    ))
    .advise(Advice::RemoveWrongValues)
}

pub(super) fn small_sample(dimension: &str, values: &usize, enough: &usize, others: &[String]) -> Text {
    let others = likewise(others);
    say(format!(
        "The sample of `{dimension}` has {values} values, fewer than {enough}. Its skewness and kurtosis are unreliable: mind the sampling \
         intervals.{others}"
    ))
    .advise(Advice::MeasureMore { values: *enough })
}

pub(super) fn no_sampling_interval(dimensions: &[String], correlated: &bool) -> Text {
    use crate::method_kind::Method;
    let samples = if dimensions.len() == 1 { "sample" } else { "samples" };
    let (why, advice) = match correlated {
        true => ("dimensions are correlated", Advice::LeaveOutCorrelation),
        false => ("the method has no surrogate", Advice::UseMethod { methods: vec![Method::SixN] }),
    };
    say(format!(
        "The uncertainty from the size of the {samples} of {} is computed for the yield only: {why}. Mean, sigma and Cpk have no sampling interval.",
        names(dimensions)
    ))
    .advise(advice)
}

pub(super) fn coarse_resolution(
    dimension: &str,
    resolution: &f64,
    sigma: &f64,
    distinct: &usize,
    others: &[String],
) -> Text {
    say(format!(
        "The {distinct} different values of `{dimension}` lie {:.2} sigma apart or more. Rounding is part of its sigma.{}",
        resolution / sigma,
        likewise(others)
    ))
    .advise(Advice::MeasureFiner)
}

pub(super) fn outside_band(
    dimension: &str,
    count: &usize,
    values: &usize,
    first: &[(f64, u64)],
    mean_too: &bool,
) -> Text {
    let lie = if *count == 1 { "lies" } else { "lie" };
    let mean = if *mean_too { " Their mean lies outside too." } else { "" };
    let text = say(format!(
        "{count} of {values} measured values of `{dimension}` {lie} outside its tolerance: {}.{mean} Moments use the values; worst case and rss \
         use the tolerance.",
        values_and_lines(first, *count)
    ));
    if *mean_too { text.advise(Advice::CheckColumn) } else { text }
}
