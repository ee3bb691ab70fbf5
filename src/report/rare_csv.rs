//! Rare events as CSV.

use super::rare::RareReport;
use super::table::{Table, number, optional, text};

/// A limit a row.
pub fn rare_csv(report: &RareReport) -> String {
    let mut table = Table::new(
        "characteristic,unit,side,limit,probability,standard_error,interval_low,interval_high,hits,effective_samples,plain_samples",
    );
    for one in &report.characteristics {
        for (side, of) in [("below", &one.below), ("above", &one.above)] {
            let Some(of) = of else { continue };
            table.row([
                text(&one.name),
                optional(one.unit.as_deref()),
                side.to_owned(),
                number(of.limit),
                number(of.probability),
                number(of.standard_error),
                number(of.interval[0]),
                number(of.interval[1]),
                of.hits.to_string(),
                number(of.effective_samples),
                number(of.plain_samples),
            ]);
        }
    }
    table.text
}
