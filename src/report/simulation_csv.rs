//! The tabular parts of a simulation as CSV.

use super::csv::CsvFile;
use super::simulation::SimulationReport;
use super::table::{Table, number, optional, text};

/// `estimates.csv`, an estimate a row with its standard error, and `histogram.csv`.
pub fn simulation_csv(report: &SimulationReport) -> Vec<CsvFile> {
    let file = |name: &str, table: Table| CsvFile { name: name.to_owned(), text: table.text };
    vec![file("estimates.csv", estimates(report)), file("histogram.csv", histogram(report))]
}

fn estimates(report: &SimulationReport) -> Table {
    let mut table = Table::new("characteristic,unit,estimate,value,standard_error,interval_low,interval_high");
    for one in &report.characteristics {
        let errors = &one.standard_error;
        let mut row = |name: &str, value: Option<f64>, error: Option<f64>, interval: Option<[f64; 2]>| {
            let [low, high] = [0, 1].map(|end| number(interval.map(|interval| interval[end])));
            table.row([
                text(&one.name),
                optional(one.unit.as_deref()),
                name.to_owned(),
                number(value),
                number(error),
                low,
                high,
            ]);
        };
        row("mean", one.mean, errors.mean, None);
        row("sigma", one.sigma, errors.sigma, None);
        row("skewness", one.skewness, errors.skewness, None);
        row("kurtosis", one.kurtosis, errors.kurtosis, None);
        for ((p, value), (_, error)) in one.distribution.quantiles.0.iter().zip(&errors.quantiles.0) {
            row(&format!("quantile {p}"), *value, *error, None);
        }
        row("yield", one.yield_, None, errors.yield_);
        row("ppm_below", one.ppm_below, None, None);
        row("ppm_above", one.ppm_above, None, None);
    }
    table
}

fn histogram(report: &SimulationReport) -> Table {
    let mut table = Table::new("characteristic,from,to,count");
    for one in &report.characteristics {
        let Some(histogram) = &one.histogram else { continue };
        for (edges, count) in histogram.edges.windows(2).zip(&histogram.counts) {
            table.row([text(&one.name), number(edges[0]), number(edges[1]), count.to_string()]);
        }
    }
    table
}
