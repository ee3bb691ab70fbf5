//! The report of a simulation for people.

use super::head;
use super::number::{UNKNOWN, beside, plain, share, significant};
use super::page::{Grid, Page, Style, clean, short};
use super::requirement::{RequirementReport, loud};
use super::simulation::{SimulatedReport, SimulationReport};
use crate::summary::RunSummary;
use crate::verdict::Verdict;

/// Characters of the longest bar of a histogram.
const BAR: usize = 50;

/// A simulation as text: every number with its standard error.
pub fn simulation_text(report: &SimulationReport, style: Style) -> String {
    let mut page = Page::new(style);
    if let Some(title) = &report.head.title {
        page.line(&clean(title));
    }
    page.line(&format!(
        "{}: {} points{}{}",
        report.method,
        report.samples,
        seed(&report.run),
        head::beside(&report.run)
    ));
    for one in &report.characteristics {
        page.line("");
        characteristic(&mut page, one);
    }
    page.finish()
}

fn characteristic(page: &mut Page, one: &SimulatedReport) {
    let unit = one.unit.as_deref().map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default();
    page.line(&format!("{}{unit}", short(&one.name)));
    if one.samples == 0 {
        return page.line("  no point has a value");
    }
    let errors = &one.standard_error;
    let mut table = Grid::new(["", "", "standard error"], "<>>");
    for (name, value, error) in [
        ("mean", one.mean, errors.mean),
        ("sigma", one.sigma, errors.sigma),
        ("skewness", one.skewness, errors.skewness),
        ("kurtosis", one.kurtosis, errors.kurtosis),
    ] {
        table.row([name.to_owned(), digits(value, error), uncertainty(error)]);
    }
    for ((p, value), (_, error)) in one.distribution.quantiles.0.iter().zip(&errors.quantiles.0) {
        table.row([format!("quantile {p}"), digits(*value, *error), uncertainty(*error)]);
    }
    page.print(&table);
    if let Some(control) = &one.control {
        let times = |value: Option<f64>, name: &str| value.map(|value| format!("{name} {}", significant(value, 3)));
        let shrunk: Vec<String> = [times(control.reduction.mean, "mean"), times(control.reduction.sigma, "sigma")]
            .into_iter()
            .flatten()
            .collect();
        let shrunk = if shrunk.is_empty() {
            String::new()
        } else {
            format!(": standard errors shrunk by {}", shrunk.join(", "))
        };
        page.line(&format!("  control: {} surrogate, {} evaluations{shrunk}", control.method, control.evaluations));
    }
    if let Some(yield_) = one.yield_ {
        limits(page, one, yield_);
    }
    one.requirements.iter().filter_map(RequirementReport::line).for_each(|line| page.line(&format!("  {line}")));
    histogram(page, one);
}

fn limits(page: &mut Page, one: &SimulatedReport, yield_: f64) {
    let interval = one
        .standard_error
        .yield_
        .map_or(String::new(), |[low, high]| format!(", 95 % interval {} to {}", share(1.0 - low), share(1.0 - high)));
    let target = judged(one.target_yield, one.verdict);
    page.line(&format!("  yield {}{interval}{target}", share(1.0 - yield_)));
    if let Some([low, high]) = one.yield_bounds {
        let points = one.failed;
        let [low, high] = [low, high].map(|bound| share(1.0 - bound));
        page.line(&format!("  {points} points have no value: {low} if all of these are rejected, {high} if none is"));
    }
    let ppm = |value: Option<f64>, side: &str| value.map(|value| format!("{} ppm {side}", significant(value, 4)));
    let index = |value: Option<f64>, name: &str| value.map(|value| format!("{name} {value:.3}"));
    let figures =
        [ppm(one.ppm_below, "below"), ppm(one.ppm_above, "above"), index(one.cp, "Cp"), index(one.cpk, "Cpk")];
    page.line(&format!("  {}", figures.into_iter().flatten().collect::<Vec<_>>().join("  ")));
}

/// Whether a sample shows that a target is met.
pub(super) fn judged(target: Option<f64>, verdict: Option<Verdict>) -> String {
    let Some((target, verdict)) = target.zip(verdict) else { return String::new() };
    format!(", target {}: {}", share(1.0 - target), loud(verdict))
}

/// The seed, where there is one.
pub(super) fn seed(run: &RunSummary) -> String {
    run.seed.map_or(String::new(), |seed| format!(", seed {seed}"))
}

/// As many digits as the standard error leaves: two of its own.
fn digits(value: Option<f64>, error: Option<f64>) -> String {
    match (value, error) {
        (None, _) => UNKNOWN.to_owned(),
        (Some(value), Some(error)) if error > 0.0 => {
            let decimals = (1.0 - error.log10().floor()).clamp(0.0, 15.0) as usize;
            let text = format!("{value:.decimals$}");
            if text.trim_start_matches('-').chars().all(|c| c == '0' || c == '.') {
                text.replace('-', "")
            } else {
                text
            }
        }
        (Some(value), Some(_)) => plain(value),
        (Some(value), None) => significant(value, 4),
    }
}

fn uncertainty(error: Option<f64>) -> String {
    error.map_or(UNKNOWN.to_owned(), |error| significant(error, 2))
}

/// Bars of the sample, turned by a right angle, one interval of four a line.
fn histogram(page: &mut Page, one: &SimulatedReport) {
    let Some(histogram) = one.histogram.as_ref().filter(|histogram| histogram.counts.len() > 4) else { return };
    let sigma = one.sigma.unwrap_or(0.0);
    let groups: Vec<(f64, f64)> = (histogram.counts.chunks(2).zip(histogram.edges.chunks(2)))
        .map(|(counts, edges)| (edges[0], counts.iter().sum::<u64>() as f64))
        .collect();
    let most = groups.iter().map(|&(_, count)| count).fold(1.0, f64::max);
    let mark = if page.style().unicode { "█" } else { "#" };
    page.line("");
    let total = one.samples as f64;
    let mut table = Grid::new(["from", "%", ""], ">><");
    for (edge, count) in groups {
        let bar = mark.repeat((BAR as f64 * count / most).round() as usize);
        table.row([beside(edge, sigma), format!("{:.2}", 100.0 * count / total), bar]);
    }
    page.print(&table);
}
