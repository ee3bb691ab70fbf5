//! Facts of a characteristic, beside its density.

use std::fmt::Write;

use crate::analysis::analysis_document::CharacteristicSections;
use crate::analysis::statistics::CharacteristicStatistics;
use crate::document::number::{index, index_with};
use crate::document::svg::escaped;
use crate::figures::{Figures, Named};
use crate::html::verdict::interval;
use sensitol::analysis::CharacteristicAnalysis;
use sensitol_numeric::capability::Capability;

/// Names of the moments.
const FIRST: [&str; 6] = ["Nominal", "Mean", "Mean − nominal", "Sigma", "Skewness", "Kurtosis"];

/// Table of yield, rejects and indices if there are limits, and of mean to kurtosis with their errors.
pub(super) fn facts(one: &CharacteristicAnalysis) -> String {
    let mut text =
        format!("<table class=\"figures\"><caption class=\"sr\">Figures of {}</caption><tbody>\n", escaped(one.name()));
    let mut row = |name: &str, value: String, below: String, key: bool| {
        let class = if key { " class=\"key\"" } else { "" };
        let below = if below.is_empty() { below } else { format!(" <small>{}</small>", escaped(&below)) };
        let _ = writeln!(text, "<tr{class}><th scope=\"row\">{name}</th><td>{}{below}</td></tr>", escaped(&value));
    };
    if one.limited() && one.mean().is_some() {
        let ends = one.yield_interval().map(interval).unwrap_or_default();
        row("Yield", one.rejects().yield_text().unwrap_or_else(|| "unknown".to_owned()), ends, true);
        for (name, side) in ["Rejects below", "Rejects above"].into_iter().zip(one.rejects().by_side()) {
            side.into_iter().for_each(|ppm| row(name, ppm, String::new(), false));
        }
        let of = |figure: fn(&Capability) -> Option<f64>| one.distribution.capability.as_ref().and_then(figure);
        // Indices of measured values are performance indices (Pp, Ppk), not those of a process in control (Cp, Cpk).
        let [cp, cpk] = if one.evidence.sampling.is_some() { ["Pp", "Ppk"] } else { ["Cp", "Cpk"] };
        let mut index_row = |name: &str, value: Option<f64>, key| {
            value.into_iter().for_each(|value| row(name, index(value), String::new(), key))
        };
        index_row(cpk, of(|of| of.cpk), true);
        index_row(cp, of(|of| of.cp), false);
        if let Some(value) = of(|of| of.cpk_percentile) {
            let error = one.distribution.quantiles.and_then(|of| of.cpk_percentile_error);
            row(&format!("{cpk}, by quantiles"), index_with(value, error), String::new(), false);
        }
    }
    for (name, shown) in FIRST.into_iter().zip(one.first_figures()) {
        row(name, shown.text, shown.error, false);
    }
    text + "</tbody></table>\n"
}
