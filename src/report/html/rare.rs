//! The page of rare events.

use serde::Serialize;

use super::super::number::{UNKNOWN, plain, share, significant};
use super::super::{BeyondReport, DesignPointReport, RareCharacteristicReport, RareReport};
use super::analysis::limits;
use super::warned::Warned;
use super::{fact, provenance, render};

#[derive(Serialize)]
struct One<'r> {
    name: &'r str,
    unit: &'r str,
    met: &'static str,
    yield_: String,
    interval: String,
    target: String,
    limits: String,
    sides: Vec<Side>,
    warnings: Vec<Warned<'r>>,
}

/// What lies beyond one limit.
#[derive(Serialize)]
struct Side {
    name: String,
    cells: [String; 5],
    bounds: Option<String>,
    distance: String,
    /// Name, value and sigmas off the mean of every dimension that varies, the farthest first.
    point: Vec<[String; 3]>,
}

/// Rare events as one page of HTML: every probability with its interval, and the assembly in which it most likely comes about.
pub fn rare_html(report: &RareReport) -> String {
    let mut facts = vec![
        fact("method", format!("{}, placed with the {} surrogate", report.method, report.surrogate)),
        fact("points", report.samples.to_string()),
        fact("evaluations", format!("{}, {} of them failed", report.run.evaluations, report.run.failed)),
        fact("evaluations of the surrogate", report.surrogate_evaluations.to_string()),
    ];
    if let Some(reached) = report.reached {
        facts.push(fact("wanted standard errors", if reached { "reached" } else { "not reached" }));
    }
    facts.extend(provenance(&report.head, &report.run));
    let warnings = report.warnings.iter().filter(|warning| warning.characteristic.is_none()).collect();
    let all: Vec<One<'_>> = report.characteristics.iter().map(|one| characteristic(report, one)).collect();
    render("rare.html", &report.head, facts, warnings, None, all)
}

fn characteristic<'r>(report: &'r RareReport, one: &'r RareCharacteristicReport) -> One<'r> {
    let interval = one.yield_interval.map(|[low, high]| format!("{} to {}", share(1.0 - low), share(1.0 - high)));
    let sides = [("below", &one.below), ("above", &one.above)];
    One {
        name: &one.name,
        unit: one.unit.as_deref().unwrap_or_default(),
        met: one.verdict.map_or("none", crate::verdict::Verdict::name),
        yield_: one.yield_.map_or(UNKNOWN.to_owned(), |value| share(1.0 - value)),
        interval: interval.unwrap_or_default(),
        target: one.target_yield.map(|target| share(1.0 - target)).unwrap_or_default(),
        limits: limits(one.lower, one.upper),
        sides: sides.into_iter().filter_map(|(name, of)| Some(side(report, one, name, of.as_ref()?))).collect(),
        warnings: Warned::about(&report.warnings, &one.name),
    }
}

fn side(report: &RareReport, one: &RareCharacteristicReport, name: &str, of: &BeyondReport) -> Side {
    let ppm = |value: f64, digits: usize| significant(1e6 * value, digits);
    let cell = |value: Option<String>| value.unwrap_or_else(|| UNKNOWN.to_owned());
    let [low, high] = of.interval.map(|end| ppm(end, 3));
    Side {
        name: format!("{name} {}", plain(of.limit)),
        cells: [
            cell(of.probability.map(|value| ppm(value, 4))),
            cell(of.standard_error.map(|error| ppm(error, 2))),
            format!("{low} to {high}"),
            of.hits.to_string(),
            cell(of.plain_samples.map(|points| significant(points, 2))),
        ],
        bounds: of.bounds.map(|bounds| {
            let [low, high] = bounds.map(|bound| ppm(bound, 3));
            format!("{low} ppm if no point without a value lies there, {high} if all {} do", one.failed)
        }),
        distance: of.design_point.as_ref().map(|point| format!("{:.2}", point.distance)).unwrap_or_default(),
        point: of.design_point.as_ref().map(|point| rows(report, point)).unwrap_or_default(),
    }
}

fn rows(report: &RareReport, point: &DesignPointReport) -> Vec<[String; 3]> {
    let varying = report.dimensions.iter().zip(&point.values).filter(|(dimension, _)| dimension.sigma > 0.0);
    let mut rows: Vec<(f64, [String; 3])> = varying
        .map(|(dimension, &value)| {
            let sigmas = (value - dimension.mean) / dimension.sigma;
            (sigmas, [dimension.name.clone(), significant(value, 6), format!("{sigmas:+.2}")])
        })
        .collect();
    rows.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    rows.into_iter().map(|(_, row)| row).collect()
}
