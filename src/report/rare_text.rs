//! The report of rare events for people.

use super::head;
use super::number::{UNKNOWN, plain, share, significant};
use super::page::{Grid, Page, Style, clean, short};
use super::rare::{BeyondReport, RareCharacteristicReport, RareReport};
use super::requirement::RequirementReport;
use super::simulation_text::{judged, seed};

/// Dimensions of a design point that are shown: those that move farthest.
const SHOWN: usize = 6;

/// Rare events as text: every probability with its interval, and the assembly in which it most likely comes about.
pub fn rare_text(report: &RareReport, style: Style) -> String {
    let mut page = Page::new(style);
    if let Some(title) = &report.head.title {
        page.line(&clean(title));
    }
    page.line(&format!(
        "importance sampling: {} points, {} evaluations with the {} surrogate{}{}",
        report.samples,
        report.run.evaluations,
        report.surrogate,
        seed(&report.run),
        head::beside(&report.run)
    ));
    for one in &report.characteristics {
        page.line("");
        characteristic(&mut page, one, report);
    }
    page.finish()
}

fn characteristic(page: &mut Page, one: &RareCharacteristicReport, report: &RareReport) {
    let unit = one.unit.as_deref().map(|unit| format!(" [{}]", clean(unit))).unwrap_or_default();
    page.line(&format!("{}{unit}", short(&one.name)));
    let sides: Vec<(&str, &BeyondReport)> = [("below", &one.below), ("above", &one.above)]
        .into_iter()
        .filter_map(|(side, of)| Some((side, of.as_ref()?)))
        .collect();
    if sides.is_empty() {
        let why = if one.lower.or(one.upper).is_some() { "its surrogate does not vary" } else { "no limit" };
        return page.line(&format!("  {why}"));
    }
    let mut table =
        Grid::new(["", "ppm", "standard error", "95 % interval", "", "points there", "plain sampling"], "<>>>>>>");
    for (side, of) in &sides {
        let ppm = |value: f64| significant(1e6 * value, 3);
        let cell =
            |value: Option<f64>, digits: usize| value.map_or(UNKNOWN.to_owned(), |value| significant(value, digits));
        table.row([
            format!("{side} {}", plain(of.limit)),
            cell(of.ppm, 4),
            cell(of.standard_error.map(|error| 1e6 * error), 2),
            ppm(of.interval[0]),
            ppm(of.interval[1]),
            of.hits.to_string(),
            cell(of.plain_samples, 2),
        ]);
    }
    page.print(&table);
    for (side, of) in &sides {
        if let Some([low, high]) = of.bounds {
            let [low, high] = [low, high].map(|bound| significant(1e6 * bound, 3));
            page.line(&format!(
                "  {side}: {low} ppm if no point without a value lies there, {high} if all {} do",
                one.failed
            ));
        }
    }
    if let Some([low, high]) = one.yield_interval {
        let target = judged(one.target_yield, one.verdict);
        let value = one.yield_.map_or(UNKNOWN.to_owned(), |value| share(1.0 - value));
        page.line(&format!("  yield {value}, 95 % interval {} to {}{target}", share(1.0 - low), share(1.0 - high)));
    }
    one.requirements.iter().filter_map(RequirementReport::line).for_each(|line| page.line(&format!("  {line}")));
    for (side, of) in sides {
        design_point(page, side, of, report);
    }
}

/// In sigmas off the means, farthest first.
fn design_point(page: &mut Page, side: &str, of: &BeyondReport, report: &RareReport) {
    let Some(point) = &of.design_point else { return };
    let mut moved: Vec<(f64, String)> = (report.dimensions.iter().zip(&point.values))
        .filter(|(dimension, _)| dimension.sigma > 0.0)
        .map(|(dimension, value)| ((value - dimension.mean) / dimension.sigma, short(&dimension.name)))
        .collect();
    moved.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let rest = moved.len().saturating_sub(SHOWN);
    let words: Vec<String> = (moved.iter().take(SHOWN)).map(|(sigmas, name)| format!("{name} {sigmas:+.2}")).collect();
    let rest = if rest > 0 { format!(" and {rest} less") } else { String::new() };
    page.line(&format!("  most likely {side}, in sigmas off the means: {}{rest}", words.join(", ")));
}
