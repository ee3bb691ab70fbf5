//! What a comparison says, as one table.

use super::compare::CompareReport;
use super::csv::CsvFile;
use super::table::{Table, number, text};

/// `comparison.csv`: a row for every characteristic and method, fewest evaluations first.
pub fn compare_csv(report: &CompareReport) -> CsvFile {
    let mut table = Table::new(
        "characteristic,method,evaluations,cached,evaluation_s,engine_s,mean,sigma,skewness,kurtosis,yield,\
         mean_off_sigmas,sigma_off_relative,skewness_off,kurtosis_off,yield_off,overall,resolved,pareto",
    );
    for one in &report.characteristics {
        for method in &one.methods {
            let (found, off) = (&method.figures, &method.error_vs_reference);
            table.row([
                text(&one.name),
                text(&method.method),
                method.evaluations.to_string(),
                method.cached.to_string(),
                number(method.evaluation_s),
                number(method.engine_s),
                number(found.mean),
                number(found.sigma),
                number(found.skewness),
                number(found.kurtosis),
                number(found.yield_),
                number(off.off.mean),
                number(off.off.sigma),
                number(off.off.skewness),
                number(off.off.kurtosis),
                number(off.off.yield_),
                number(off.overall),
                off.resolved.to_string(),
                method.pareto.to_string(),
            ]);
        }
    }
    CsvFile { name: "comparison.csv".to_owned(), text: table.text }
}
