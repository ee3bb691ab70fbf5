//! Facts of a characteristic, beside its density.

use std::fmt::Write;

use crate::analysis::statistics::CharacteristicStatistics;
use crate::document::number::{index, index_with};
use crate::document::svg::escaped;
use crate::figures::{Figures, Named};
use crate::sampling::index_names;
use sensitol::analysis::CharacteristicAnalysis;

/// Names of the moments.
const FIRST: [&str; 6] = ["Nominal", "Mean", "Mean − nominal", "Sigma", "Skewness", "Kurtosis"];

/// Table of the figures that the verdict leaves out: further indices, and nominal value to kurtosis with their errors.
pub(super) fn facts(one: &CharacteristicAnalysis) -> String {
    let mut text =
        format!("<table class=\"figures\"><caption class=\"sr\">Figures of {}</caption><tbody>\n", escaped(one.name()));
    let mut row = |name: &str, value: String, error: String| {
        let error = if error.is_empty() { error } else { format!(" <small>{}</small>", escaped(&error)) };
        let _ = writeln!(text, "<tr><th scope=\"row\">{name}</th><td>{}{error}</td></tr>", escaped(&value));
    };
    for (name, shown) in FIRST.into_iter().zip(one.first_figures()) {
        row(name, shown.text, shown.error);
    }
    if let Some(found) = one.distribution.capability.as_ref().filter(|_| one.limited() && one.mean().is_some()) {
        // Indices of measured values are performance indices (Pp, Ppk), not those of a process in control (Cp, Cpk).
        let [cp, cpk] = index_names(one.evidence.sampling.is_some());
        found.cp.into_iter().for_each(|value| row(cp, index(value), String::new()));
        if let Some(value) = found.cpk_percentile {
            let error = one.distribution.quantiles.and_then(|of| of.cpk_percentile_error);
            row(&format!("{cpk}, by quantiles"), index_with(value, error), String::new());
        }
    }
    text + "</tbody></table>\n"
}
