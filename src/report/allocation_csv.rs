//! The tabular parts of an allocation as CSV.

use super::allocation::AllocationReport;
use super::csv::CsvFile;
use super::table::{Table, number, optional, text, truth};
use crate::verdict::Verdict;

/// The names of the files of [`allocation_csv`].
pub fn allocation_csv_names() -> [String; 3] {
    ["tolerances.csv", "requirements.csv", "front.csv"].map(str::to_owned)
}

/// `tolerances.csv`, a dimension a row, `requirements.csv`, and `front.csv`, a row for every dimension at every point.
pub fn allocation_csv(report: &AllocationReport) -> Vec<CsvFile> {
    let tables = [tolerances(report), requirements(report), front(report)];
    allocation_csv_names().into_iter().zip(tables).map(|(name, table)| CsvFile { name, text: table.text }).collect()
}

fn tolerances(report: &AllocationReport) -> Table {
    let mut table = Table::new(
        "dimension,unit,before,after,lower_before,upper_before,lower_after,upper_after,cost_before,cost_after,process,at_bound",
    );
    for one in &report.tolerances {
        let side = |band: Option<[f64; 2]>, end: usize| number(band.map(|band| band[end]));
        let (before, after) = (one.deviations.before, one.deviations.after);
        table.row([
            text(&one.dimension),
            optional(one.unit.as_deref()),
            number(one.before),
            number(one.after),
            side(before, 0),
            side(before, 1),
            side(after, 0),
            side(after, 1),
            number(one.cost_before),
            number(one.cost_after),
            optional(one.process.as_deref()),
            optional(one.at_bound),
        ]);
    }
    table
}

fn requirements(report: &AllocationReport) -> Table {
    let mut table = Table::new(
        "characteristic,requirement,required,before,after,met_before,met,verdict,price_both,price_lower,price_upper,price_sigma",
    );
    for one in &report.requirements {
        let price = report.shadow_prices.iter().find(|price| price.characteristic == one.characteristic);
        table.row([
            text(&one.characteristic),
            one.requirement.to_owned(),
            number(one.required),
            number(one.before),
            number(one.after),
            truth(one.met_before),
            truth(one.met),
            optional(one.verdict.map(Verdict::name)),
            number(price.and_then(|price| price.both)),
            number(price.and_then(|price| price.lower)),
            number(price.and_then(|price| price.upper)),
            number(price.and_then(|price| price.sigma)),
        ]);
    }
    table
}

fn front(report: &AllocationReport) -> Table {
    let mut table = Table::new("point,characteristic,requirement,required,cost,dimension,tolerance");
    for (index, point) in report.front.iter().enumerate() {
        for wanted in &point.required {
            let mut row = |dimension: &str, tolerance: Option<f64>| {
                table.row([
                    (index + 1).to_string(),
                    text(&wanted.characteristic),
                    wanted.requirement.to_owned(),
                    number(wanted.required),
                    number(point.cost),
                    text(dimension),
                    number(tolerance),
                ]);
            };
            match &point.tolerances {
                None => row("", None),
                Some(tolerances) => {
                    for (one, &tolerance) in report.tolerances.iter().zip(tolerances) {
                        row(&one.dimension, Some(tolerance));
                    }
                }
            }
        }
    }
    table
}
