//! What a sweep says, as one table.

use super::csv::CsvFile;
use super::distribution::NAMES;
use super::sweep::SweepReport;
use super::table::{Table, number, optional, text};

/// `sweep.csv`: a row for every characteristic and value of the parameter.
pub fn sweep_csv(report: &SweepReport) -> CsvFile {
    let quantiles: Vec<String> = NAMES.iter().map(|name| format!("quantile {name}")).collect();
    let header = format!(
        "characteristic,unit,parameter,at,nominal,mean,sigma,skewness,kurtosis,rss,{},yield",
        quantiles.join(",")
    );
    let mut table = Table::new(&header);
    for one in &report.characteristics {
        for point in &one.points {
            let quantiles: Vec<String> = point.quantiles.0.iter().map(|(_, value)| number(*value)).collect();
            table.row([
                text(&one.name),
                optional(one.unit.as_deref()),
                text(&report.parameter.name),
                number(point.at),
                number(point.nominal),
                number(point.mean),
                number(point.sigma),
                number(point.skewness),
                number(point.kurtosis),
                number(point.rss),
                quantiles.join(","),
                number(point.yield_),
            ]);
        }
    }
    CsvFile { name: "sweep.csv".to_owned(), text: table.text }
}
