//! Correlations and joint yield of characteristics, for readers.

use crate::document::number::{short, target_yield, unsigned_zero, yielded};
use crate::document::rejects::Rejects;
use crate::document::{Cell, Columns, DataTable};
use sensitol::analysis::{ConditionalYield, OutputCorrelation};
use sensitol::simulation::YieldEstimate;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::sampling::one_error;
use sensitol_numeric::verdict::Judged;

/// Greatest number of correlations in the sentence. The table has all.
const TOGETHER: usize = 6;

/// Sentence with the strongest correlations of characteristics, or None if all are unknown.
pub(super) fn together(correlations: &[OutputCorrelation]) -> Option<String> {
    let mut known: Vec<(f64, &OutputCorrelation)> =
        correlations.iter().filter_map(|one| Some((one.value?, one))).collect();
    known.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let said = known.iter().take(TOGETHER).map(|(value, one)| {
        let [first, second] = [&one.between[0], &one.between[1]].map(|name| short(name));
        format!("{first} with {second} {}", coefficient(*value, one.error))
    });
    let said: Vec<String> = said.collect();
    let more = known.len().saturating_sub(TOGETHER);
    let more = if more > 0 { format!("; {more} weaker") } else { String::new() };
    (!said.is_empty()).then(|| format!("correlation of characteristics: {}{more}", said.join(", ")))
}

/// Table of all correlations of characteristics.
pub(super) fn together_table(correlations: &[OutputCorrelation]) -> DataTable {
    Columns::default()
        .data("first", |one: &&OutputCorrelation| Cell::text(&one.between[0]))
        .data("second", |one| Cell::text(&one.between[1]))
        .data("correlation", |one| Cell::data(one.value))
        .data("error", |one| Cell::data(one.error))
        .table("characteristic_correlation", correlations)
}

/// Formats a correlation with the decimals that its error supports, at most three.
fn coefficient(value: f64, error: Option<f64>) -> String {
    let decimals =
        error.filter(|error| *error > 0.0).map_or(3, |error| (-libm::log10(error).floor()).clamp(1.0, 3.0) as usize);
    unsigned_zero(format!("{value:.decimals$}"))
}

/// Sentence with the joint yield, its error if that is not empty, and the target.
pub(super) fn all_limits(yield_: &str, error: &str, requirement: Option<&Judged>) -> String {
    let target = requirement.map_or_else(String::new, |judged| {
        let Some(target) = judged.requirement.target_yield() else { return String::new() };
        format!("; target {}: {}", target_yield(target), judged.verdict.name())
    });
    let error = if error.is_empty() { String::new() } else { format!(", {error}") };
    format!("all limits at once: yield {yield_}{error}{target}")
}

/// Sentence with the yield of the assemblies that keep another characteristic's limits, or with the reason why it is unknown. None if the
/// characteristic is given no other.
pub(super) fn conditional(one: &Characteristic, found: Option<&ConditionalYield>, reason: &str) -> Option<String> {
    let given = short(one.given()?);
    let Some(of) = found else { return Some(format!("yield of those that keep {given} unknown: {reason}")) };
    let text = conditional_yield(of);
    let interval = of.interval.map(|ends| ends.map(yielded));
    let interval = interval.map_or_else(String::new, |[low, high]| format!(", 95 % interval {low} to {high}"));
    Some(format!("yield of those that keep {given} {text}{interval}"))
}

/// Conditional yield with the digits that its interval supports.
pub(super) fn conditional_yield(of: &ConditionalYield) -> String {
    let error = of.interval.map(|interval| one_error(of.value, interval));
    Rejects::all(1.0 - of.value, error).yield_text().unwrap_or_else(|| yielded(of.value))
}

/// Sentence with a joint yield that has a 95 % interval.
pub(super) fn all_limits_within(share: &YieldEstimate, requirement: Option<&Judged>) -> String {
    let error = one_error(share.value, share.interval);
    let text = Rejects::all(1.0 - share.value, Some(error)).yield_text().unwrap_or_else(|| yielded(share.value));
    let [low, high] = share.interval.map(yielded);
    all_limits(&text, &format!("95 % interval {low} to {high}"), requirement)
}
