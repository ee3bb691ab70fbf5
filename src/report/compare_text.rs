//! The report of a comparison for people.

use super::compare::{CompareReport, ComparedReport};
use super::head;
use super::number::{UNKNOWN, significant};
use super::page::{Grid, Page, Style, clean, short};
use crate::compare::RESOLVED;

/// A comparison as text: a table for every characteristic, fewest evaluations first.
pub fn compare_text(report: &CompareReport, style: Style) -> String {
    let mut page = Page::new(style);
    if let Some(title) = &report.head.title {
        page.line(&clean(title));
    }
    let stopped = head::beside(&report.run);
    page.line(&format!("reference: {} with {} points{stopped}", report.reference_method, report.reference_samples));
    for one in &report.characteristics {
        page.line("");
        compared(&mut page, one);
    }
    if !report.not_run.is_empty() {
        page.line("");
        for one in &report.not_run {
            let cost = one
                .evaluations
                .map_or(String::new(), |count| format!(" ({count} evaluations{})", time(one.projected_s)));
            page.line(&format!("not run: {}{cost}: {}", one.method, one.reason));
        }
    }
    page.finish()
}

fn time(seconds: Option<f64>) -> String {
    seconds.map_or(String::new(), |seconds| format!(", {} s", significant(seconds, 2)))
}

fn compared(page: &mut Page, one: &ComparedReport) {
    let unit = one.reference.unit.as_deref().map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default();
    page.line(&format!("{}{unit}: how far off the reference, and which no other beats", short(&one.name)));
    let header = ["", "points", "model s", "engine s", "mean/sigma", "sigma %", "skew", "kurtosis", "yield %", ""];
    let mut table = Grid::new(header, "<>>>>>>>><");
    let mark = if page.style().unicode { "●" } else { "*" };
    for method in &one.methods {
        let off = &method.error_vs_reference;
        let own = &off.reference_standard_error;
        table.row([
            method.method.clone(),
            method.evaluations.to_string(),
            significant(method.evaluation_s, 2),
            significant(method.engine_s, 2),
            error(off.off.mean, own.mean, 1.0),
            error(off.off.sigma, own.sigma, 100.0),
            error(off.off.skewness, own.skewness, 1.0),
            error(off.off.kurtosis, own.kurtosis, 1.0),
            error(off.off.yield_, own.yield_, 100.0),
            if method.pareto { mark.to_owned() } else { String::new() },
        ]);
    }
    page.print(&table);
    if one.methods.iter().any(|method| !method.error_vs_reference.resolved) {
        page.line("  <: the reference is itself no surer than this, and does not tell the difference");
    }
}

/// An error with two digits; below two standard errors of the reference, these.
fn error(off: Option<f64>, own: Option<f64>, factor: f64) -> String {
    match (off, own) {
        (None, _) => UNKNOWN.to_owned(),
        (Some(off), Some(own)) if off <= RESOLVED * own => format!("<{}", brief(RESOLVED * own * factor)),
        (Some(off), _) => brief(off * factor),
    }
}

fn brief(value: f64) -> String {
    if value == 0.0 || (1e-3..1e4).contains(&value) { significant(value, 2) } else { format!("{value:.0e}") }
}
