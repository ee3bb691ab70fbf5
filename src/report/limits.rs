//! The part of the text report that is about distribution and limits.

use super::distribution::{DistributionReport, Quantiles};
use super::number::{beside, plain, share, significant};
use super::page::{Grid, Page, Style};
use super::requirement::{RequirementReport, loud};
use super::sketch::sketch;
use super::surface_law::source;
use super::{CharacteristicReport, FitReport};
use crate::capability::Law;
use crate::pearson::Pearson;

/// A rejected share that the normal fit has wrong by more than this part is worth a line.
const DIFFERENT: f64 = 0.05;

/// Distribution, quantiles, and how they keep the limits.
pub(super) fn distribution(page: &mut Page, one: &CharacteristicReport) {
    match &one.distribution {
        None if one.sigma.is_some() => {
            return page.line("  no distribution has this skewness and kurtosis: its yield is unknown");
        }
        None => return,
        Some(DistributionReport::Point { at }) => {
            page.line(&format!("  every assembly has the same value: {}", plain(*at)));
        }
        Some(DistributionReport::Pearson { kind, quantiles, .. }) => {
            page.line("");
            if let Some(Law::Pearson(law)) = &one.law {
                sketch(page, law, [one.lower, one.upper]);
            }
            page.line("");
            let sigma = one.sigma.unwrap_or(0.0);
            match one.surface_law.as_ref().and_then(|law| law.quantiles.as_ref()) {
                Some(law) => quantile_table(page, "surface law", law, sigma),
                None => quantile_table(page, &named(kind), quantiles, sigma),
            }
        }
    }
    if one.lower.is_some() || one.upper.is_some() {
        limits(page, one);
    }
}

/// A law by itself: its type, its support, its density, its quantiles.
pub fn law_text(law: &Pearson, style: Style) -> String {
    let mut page = Page::new(style);
    let end = |end: f64| match end.is_finite() {
        true => beside(end, law.sigma()),
        false => format!("{}infinity", if end < 0.0 { "-" } else { "" }),
    };
    let [lower, upper] = law.support().map(end);
    page.line(&format!("{}, from {lower} to {upper}", named(law.kind().name())));
    page.line("");
    sketch(&mut page, law, [None, None]);
    page.line("");
    quantile_table(&mut page, &named(law.kind().name()), &Quantiles::of(law), law.sigma());
    page.finish()
}

fn named(kind: &str) -> String {
    if kind == "normal" { kind.to_owned() } else { format!("Pearson {kind}") }
}

fn quantile_table(page: &mut Page, law: &str, quantiles: &Quantiles, sigma: f64) {
    let mut table = Grid::new([""; 8], "<>>>>>>>");
    let row = |name: String, cell: &dyn Fn(&(&'static str, f64)) -> String| {
        let mut cells = std::iter::once(name).chain(quantiles.0.iter().map(cell));
        std::array::from_fn(|_| cells.next().unwrap_or_default())
    };
    table.row(row(law.to_owned(), &|(p, _)| format!("{} %", significant_percent(p))));
    table.row(row("quantiles".to_owned(), &|(_, value)| beside(*value, sigma)));
    page.print(&table);
}

/// `0.00135` as `0.135`.
fn significant_percent(p: &str) -> String {
    plain((1e5 * p.parse::<f64>().unwrap_or(f64::NAN)).round() / 1e3)
}

fn limits(page: &mut Page, one: &CharacteristicReport) {
    let target = one
        .target_yield
        .zip(one.verdict)
        .map_or(String::new(), |(target, verdict)| format!(", target {}: {}", share(1.0 - target), loud(verdict)));
    let (below, above) = (one.ppm_below, one.ppm_above);
    page.line(&format!("  yield {}{}{target}", rejected(below, above), outside(below, above)));
    source(one).into_iter().for_each(|line| page.line(&format!("  {line}")));
    let index = |name: &str, value: Option<f64>| value.map(|value| format!("{name} {value:.3}"));
    let indices = [
        index("Cp", one.cp),
        index("Cpk", one.cpk),
        index("by percentiles Cp", one.cp_percentile),
        index(if one.cp_percentile.is_some() { "Cpk" } else { "by percentiles Cpk" }, one.cpk_percentile),
        index("sigma level", one.sigma_level),
    ];
    let indices: Vec<String> = indices.into_iter().flatten().collect();
    if !indices.is_empty() {
        page.line(&format!("  {}", indices.join("  ")));
    }
    one.requirements.iter().filter_map(RequirementReport::line).for_each(|line| page.line(&format!("  {line}")));
    if let Some(normal) = one.normal_fit.as_ref().filter(|normal| differs(one, normal)) {
        let (below, above) = (normal.ppm_below, normal.ppm_above);
        page.line(&format!("  a normal fit would say: yield {}{}", rejected(below, above), outside(below, above)));
    }
}

/// Whether the normal fit rejects visibly more or fewer, on either side.
fn differs(one: &CharacteristicReport, normal: &FitReport) -> bool {
    let far = |a: Option<f64>, b: Option<f64>| match (a, b) {
        (Some(a), Some(b)) => (a - b).abs() > DIFFERENT * a.max(b),
        (None, None) => false,
        _ => true,
    };
    // What nobody would count, a millionth part of a millionth, is the same.
    let seen = |ppm: Option<f64>| ppm.map(|ppm| if ppm < 1e-6 { 0.0 } else { ppm });
    far(seen(one.ppm_below), seen(normal.ppm_below)) || far(seen(one.ppm_above), seen(normal.ppm_above))
}

/// The yield that leaves these parts per million.
pub(super) fn rejected(below: Option<f64>, above: Option<f64>) -> String {
    match (below, above) {
        (None, None) => "unknown".to_owned(),
        (below, above) => share(1e-6 * (below.unwrap_or(0.0) + above.unwrap_or(0.0))),
    }
}

fn outside(below: Option<f64>, above: Option<f64>) -> String {
    let side = |ppm: Option<f64>, name: &str| ppm.map(|ppm| format!("{} ppm {name}", significant(ppm, 4)));
    let sides: Vec<String> = [side(below, "below"), side(above, "above")].into_iter().flatten().collect();
    if sides.is_empty() { String::new() } else { format!(" ({})", sides.join(", ")) }
}

/// The yield of a characteristic for the table at the top, and whether that is enough.
pub(super) fn verdict(one: &CharacteristicReport) -> String {
    if one.lower.is_none() && one.upper.is_none() || one.mean.is_none() {
        return String::new();
    }
    let met = one.verdict.map_or(String::new(), |verdict| format!(", target {}", loud(verdict)));
    format!("yield {}{met}", rejected(one.ppm_below, one.ppm_above))
}
