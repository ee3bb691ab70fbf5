//! The page of a sweep.

use serde::Serialize;

use super::super::number::{UNKNOWN, beside, plain, plural, share, unsigned_zero};
use super::super::{SweepReport, SweptPointReport, SweptReport, sweep_svg};
use super::analysis::limits;
use super::warned::Warned;
use super::{fact, inline, provenance, render};

#[derive(Serialize)]
struct Swept<'r> {
    chart: String,
    parameter: String,
    characteristics: Vec<One<'r>>,
}

#[derive(Serialize)]
struct One<'r> {
    name: &'r str,
    unit: &'r str,
    limits: String,
    rows: Vec<[String; 8]>,
    warnings: Vec<Warned<'r>>,
}

/// A sweep as one page of HTML: mean and band over the parameter, and a table for every characteristic.
pub fn sweep_html(report: &SweepReport) -> String {
    let unit = report.parameter.unit.as_deref().map(|unit| format!(" [{unit}]")).unwrap_or_default();
    let swept = Swept {
        // It escapes the names in it.
        chart: inline(&sweep_svg(report)),
        parameter: format!("{}{unit}", report.parameter.name),
        characteristics: report.characteristics.iter().map(|one| characteristic(report, one)).collect(),
    };
    let mut facts = vec![
        fact("method", report.method.unwrap_or("none was run")),
        fact("swept", format!("{}, {} values", report.parameter.name, report.parameter.values.len())),
        fact(
            "evaluations",
            format!(
                "{} in {}, {} of them failed",
                report.run.evaluations,
                plural(report.run.stages as usize, "batch", "batches"),
                report.run.failed
            ),
        ),
    ];
    facts.extend(provenance(&report.head, &report.run));
    let warnings = report.warnings.iter().filter(|warning| warning.characteristic.is_none()).collect();
    render("sweep.html", &report.head, facts, warnings, None, swept)
}

fn characteristic<'r>(report: &'r SweepReport, one: &'r SweptReport) -> One<'r> {
    One {
        name: &one.name,
        unit: one.unit.as_deref().unwrap_or_default(),
        limits: limits(one.lower, one.upper),
        rows: one.points.iter().map(point).collect(),
        warnings: Warned::about(&report.warnings, &one.name),
    }
}

fn point(point: &SweptPointReport) -> [String; 8] {
    let scale = point.sigma.unwrap_or(0.0);
    let number = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| beside(value, scale));
    let shape = |value: Option<f64>| value.map_or(UNKNOWN.to_owned(), |value| unsigned_zero(format!("{value:.4}")));
    [
        plain(point.at),
        number(point.nominal),
        number(point.mean),
        number(point.sigma),
        shape(point.skewness),
        shape(point.kurtosis),
        number(point.rss),
        point.yield_.map(|yield_| share(1.0 - yield_)).unwrap_or_default(),
    ]
}
