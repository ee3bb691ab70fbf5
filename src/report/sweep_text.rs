//! The report of a sweep for people.

use super::head;
use super::limits::rejected;
use super::number::{UNKNOWN, beside, plain, plural, significant};
use super::page::{Grid, Page, Style, clean, short};
use super::sweep::{SweepReport, SweptReport};

/// A sweep as text: a table for every characteristic, a row for every value.
pub fn sweep_text(report: &SweepReport, style: Style) -> String {
    let mut page = Page::new(style);
    if let Some(title) = &report.head.title {
        page.line(&clean(title));
    }
    page.line(&format!(
        "{}: {} in {} for {} of {}{}",
        report.method.unwrap_or("nothing was done"),
        plural(report.run.evaluations as usize, "evaluation", "evaluations"),
        plural(report.run.stages as usize, "batch", "batches"),
        plural(report.parameter.values.len(), "value", "values"),
        short(&report.parameter.name),
        head::beside(&report.run),
    ));
    for one in &report.characteristics {
        page.line("");
        swept(&mut page, report, one);
    }
    page.finish()
}

fn unit(unit: Option<&str>) -> String {
    unit.map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default()
}

fn swept(page: &mut Page, report: &SweepReport, one: &SweptReport) {
    let of = &report.parameter;
    page.line(&format!(
        "{}{} over {}{}",
        short(&one.name),
        unit(one.unit.as_deref()),
        short(&of.name),
        unit(of.unit.as_deref())
    ));
    let limited = one.lower.is_some() || one.upper.is_some();
    let header = ["", "nominal", "mean", "sigma", "0.135 %", "50 %", "99.865 %", if limited { "yield %" } else { "" }];
    let mut table = Grid::new(header, ">>>>>>>>");
    for point in &one.points {
        let sigma = point.sigma.filter(|sigma| *sigma > 0.0);
        let rounded = |value: Option<f64>| {
            value.map_or(UNKNOWN.to_owned(), |value| match sigma {
                Some(sigma) => beside(value, sigma),
                None => significant(value, 6),
            })
        };
        let [low, high] = [0, 1].map(|end| rounded(point.band().map(|band| band[end])));
        table.row([
            plain(point.at),
            rounded(point.nominal),
            rounded(point.mean),
            point.sigma.map_or(UNKNOWN.to_owned(), |sigma| significant(sigma, 5)),
            low,
            rounded(point.median()),
            high,
            match point.yield_ {
                _ if !limited => String::new(),
                Some(_) => rejected(point.ppm_below, point.ppm_above).trim_end_matches(" %").to_owned(),
                None => UNKNOWN.to_owned(),
            },
        ]);
    }
    page.print(&table);
}
