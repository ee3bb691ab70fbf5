//! How characteristics vary together, for people.

use super::Report;
use crate::analysis::OutputCorrelation;
use crate::document::number::{short, unsigned_zero};
use crate::document::{Cell, Columns, DataTable};

/// Correlations that are said; a file has all.
const TOGETHER: usize = 6;

impl Report {
    /// The strongest correlations of characteristics.
    pub(super) fn together(&self) -> Option<String> {
        let mut known: Vec<(f64, &OutputCorrelation)> =
            self.analysis.correlations.iter().filter_map(|one| Some((one.value?, one))).collect();
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

    pub(super) fn together_table(&self) -> DataTable {
        Columns::default()
            .data("first", |one: &&OutputCorrelation| Cell::text(&one.between[0]))
            .data("second", |one| Cell::text(&one.between[1]))
            .data("correlation", |one| Cell::data(one.value))
            .data("error", |one| Cell::data(one.error))
            .table("characteristic_correlation", &self.analysis.correlations)
    }
}

/// A coefficient of correlation with the decimals that its error carries, three of them at most.
fn coefficient(value: f64, error: Option<f64>) -> String {
    let decimals =
        error.filter(|error| *error > 0.0).map_or(3, |error| (-error.log10().floor()).clamp(1.0, 3.0) as usize);
    unsigned_zero(format!("{value:.decimals$}"))
}
