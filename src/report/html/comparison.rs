//! The page of a comparison.

use serde::Serialize;

use super::super::number::{UNKNOWN, share, significant};
use super::super::{CompareReport, ComparedReport, MethodReport, compare_svg};
use super::{fact, inline, provenance, render};

#[derive(Serialize)]
struct Compared<'r> {
    chart: String,
    characteristics: Vec<One<'r>>,
    not_run: Vec<[String; 3]>,
}

#[derive(Serialize)]
struct One<'r> {
    name: &'r str,
    reference: [String; 5],
    rows: Vec<Row<'r>>,
}

#[derive(Serialize)]
struct Row<'r> {
    method: &'r str,
    evaluations: u64,
    model: String,
    engine: String,
    errors: [String; 5],
    overall: String,
    resolved: bool,
    front: bool,
}

/// A comparison as one page of HTML: evaluations against error, and a table for every characteristic.
pub fn compare_html(report: &CompareReport) -> String {
    let compared = Compared {
        // It escapes the names in it.
        chart: inline(&compare_svg(report)),
        characteristics: report.characteristics.iter().map(characteristic).collect(),
        not_run: (report.not_run.iter())
            .map(|one| {
                let evaluations = one.evaluations.map_or(UNKNOWN.to_owned(), |count| count.to_string());
                [one.method.clone(), evaluations, one.reason.to_string()]
            })
            .collect(),
    };
    let mut facts =
        vec![fact("reference", format!("{} with {} points", report.reference_method, report.reference_samples))];
    facts.extend(provenance(&report.head, &report.run));
    render("comparison.html", &report.head, facts, Vec::new(), None, compared)
}

fn number(value: Option<f64>, digits: usize) -> String {
    value.map_or(UNKNOWN.to_owned(), |value| significant(value, digits))
}

fn characteristic(one: &ComparedReport) -> One<'_> {
    let reference = &one.reference;
    One {
        name: &one.name,
        reference: [
            number(reference.mean, 7),
            number(reference.sigma, 6),
            number(reference.skewness, 4),
            number(reference.kurtosis, 5),
            reference.yield_.map_or(UNKNOWN.to_owned(), |yield_| share(1.0 - yield_)),
        ],
        rows: one.methods.iter().map(method).collect(),
    }
}

fn method(one: &MethodReport) -> Row<'_> {
    let off = &one.error_vs_reference;
    let seconds = |seconds: f64| format!("{} s", significant(seconds, 2));
    let errors = [off.off.mean, off.off.sigma, off.off.skewness, off.off.kurtosis, off.off.yield_];
    Row {
        method: &one.method,
        evaluations: one.evaluations,
        model: seconds(one.evaluation_s),
        engine: seconds(one.engine_s),
        errors: errors.map(|error| number(error, 2)),
        overall: number(off.overall, 2),
        resolved: off.resolved,
        front: one.pareto,
    }
}
