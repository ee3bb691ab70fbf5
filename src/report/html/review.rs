//! What a review asks first: a sentence, a gauge for every characteristic, the map of interactions, and the terms.

use std::fmt::Write;

use super::super::Report;
use super::super::figures::{Figures, Named};
use super::super::statistics::part;
use crate::analysis::CharacteristicAnalysis;
use crate::capability::Capability;
use crate::document::number::{beside, index, percent, plain, significant, yielded};
use crate::document::rejects::Rejects;
use crate::document::svg::escaped;
use crate::requirement::Requirement;
use crate::verdict::Verdict;

/// Characteristics that a sentence names.
const NAMED: usize = 6;
/// Dimensions of a map of interactions, the most influential first.
const MAPPED: usize = 16;
/// A share of the variance below which an interaction is not drawn.
const SEEN: f64 = 1e-4;
/// A rejected share below this is none in a sentence.
const NONE: f64 = 1e-9;
/// Shares of the variance at which the map becomes darker.
const GREYS: [f64; 4] = [1e-3, 1e-2, 0.1, 0.5];

/// The section that answers whether it works.
pub(super) fn verdict(report: &Report) -> String {
    let all = &report.analysis.characteristics;
    let mut text =
        "<section aria-labelledby=\"verdict\" class=\"verdict\">\n<h2 id=\"verdict\">Verdict</h2>\n".to_owned();
    let lead = sentence(all);
    if !lead.is_empty() {
        let _ = writeln!(text, "<p class=\"lead\">{lead}</p>");
    }
    if all.iter().any(Named::limited) {
        let scale = Gauge::of(report);
        text += "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Verdicts\"><table class=\"gauges\"><thead><tr><th scope=\"col\">characteristic</th><th scope=\"col\">verdict</th><th scope=\"col\">rejects, log scale</th><th scope=\"col\" class=\"n\">yield, 95 %</th><th scope=\"col\" class=\"n\">target</th><th scope=\"col\" class=\"n\">rejects</th><th scope=\"col\" class=\"n\">Cpk</th><th scope=\"col\" class=\"n\">worst case</th></tr></thead><tbody>\n";
        for (i, one) in all.iter().enumerate().filter(|(_, one)| one.limited()) {
            text += &row(i, one, &scale);
        }
        text += &together(report, &scale);
        text += "</tbody></table></div>\n<p class=\"note\">Gauge: dot and bar, the yield and its interval; tick, the target; tinted, the side of a missed target.</p>\n";
    }
    text + "</section>\n"
}

/// What fails first, by how much, on which side and why; then what is met.
fn sentence(all: &[CharacteristicAnalysis]) -> String {
    let of = |wanted: Verdict| all.iter().filter(move |one| one.verdict() == Some(wanted));
    let ppm = |target: f64| significant(1e6 * (1.0 - target), 4);
    let mut parts = Vec::new();
    for one in of(Verdict::Missed).take(NAMED) {
        let name = escaped(one.name());
        let allowed = one.target().map(ppm).unwrap_or_default();
        let rejected = one.rejects().all_ppm().unwrap_or_else(|| "an unknown number of".to_owned());
        let side = side(one).unwrap_or_default();
        let cause = driver(one).map(|cause| format!(" {cause}")).unwrap_or_default();
        parts.push(format!(
            "<strong>{name} misses its target:</strong> {rejected} ppm are rejected where {allowed} are allowed{side}.{cause}"
        ));
    }
    for one in of(Verdict::Inconclusive).take(NAMED) {
        let name = escaped(one.name());
        let between = one.yield_interval().map_or(String::new(), |[low, high]| {
            let [most, least] = [low, high].map(|end| significant(1e6 * (1.0 - end), 2));
            let allowed = one.target().map(ppm).unwrap_or_default();
            format!(": {least} to {most} ppm are rejected where {allowed} are allowed")
        });
        parts.push(format!("<strong>{name} may or may not meet its target</strong>{between}."));
    }
    let met: Vec<String> = of(Verdict::Met)
        .take(NAMED)
        .map(|one| {
            let none = one.yield_().is_some_and(|yield_| 1.0 - yield_ < NONE);
            let rejected = match one.rejects().all_ppm() {
                Some(_) if none => " with fewer than 0.001 ppm".to_owned(),
                Some(ppm) => format!(" with {ppm} ppm"),
                None => String::new(),
            };
            format!("{} meets its target{rejected}.", escaped(one.name()))
        })
        .collect();
    parts.extend(met);
    for (wanted, word) in [(Verdict::Missed, "miss"), (Verdict::Inconclusive, "may miss"), (Verdict::Met, "meet")] {
        let more = of(wanted).count().saturating_sub(NAMED);
        if more > 0 {
            parts.push(format!("{more} more {word} their targets."));
        }
    }
    parts.join(" ")
}

/// On which side most of the rejects lie.
fn side(one: &CharacteristicAnalysis) -> Option<String> {
    let (lower, upper) = (one.lower(), one.upper());
    let (below, above) = (one.ppm_below().unwrap_or(0.0), one.ppm_above().unwrap_or(0.0));
    let unit = one.unit().map(|unit| format!(" {}", escaped(unit))).unwrap_or_default();
    let (share, word, limit) = if below > above {
        (below / (below + above), "below", lower?)
    } else {
        (above / (below + above), "above", upper?)
    };
    let part = match share {
        _ if lower.is_none() || upper.is_none() => return None,
        share if share > 0.995 => "all of them".to_owned(),
        share if share > 0.6 => format!("{:.0} % of them", 100.0 * share),
        _ => return None,
    };
    Some(format!(", {part} {word} {}{unit}", plain(limit)))
}

/// What makes most of the variance.
fn driver(one: &CharacteristicAnalysis) -> Option<String> {
    let all = one.sensitivities.iter().filter_map(|row| Some((&row.dimension, part(row)?)));
    let (name, share) = all.max_by(|a, b| a.1.total_cmp(&b.1))?;
    let percent = (100.0 * share).round();
    (share >= 0.2).then(|| format!("<em>{}</em> makes {percent} % of its variance.", escaped(name)))
}

/// The scale that all gauges share: from 10 % rejected down to 10 ppm, or as far as a target needs.
struct Gauge {
    /// The exponent of ten of the least share.
    least: f64,
}

impl Gauge {
    const WIDTH: f64 = 150.0;

    fn of(report: &Report) -> Self {
        let targets = report.analysis.characteristics.iter().filter_map(Named::target);
        let least = targets.map(|target| (1.0 - target).log10().floor() - 1.0).fold(-5.0, f64::min);
        Self { least: least.max(-9.0) }
    }

    /// Left is bad.
    fn at(&self, rejected: f64) -> f64 {
        let share = (-1.0 - rejected.max(1e-300).log10()) / (-1.0 - self.least);
        (10.0 * Self::WIDTH * share.clamp(0.0, 1.0)).round() / 10.0
    }

    fn svg(&self, value: Option<f64>, interval: Option<[f64; 2]>, target: Option<f64>) -> String {
        let mut svg = format!("<svg class=\"gauge\" viewBox=\"-6 0 {} 30\" aria-hidden=\"true\">", Self::WIDTH + 12.0);
        let width = Self::WIDTH;
        let _ = write!(svg, "<rect class=\"track\" y=\"6\" width=\"{width}\" height=\"8\"/>");
        if let Some(target) = target {
            let x = self.at(1.0 - target);
            let _ = write!(
                svg,
                "<rect class=\"zone\" y=\"6\" width=\"{x}\" height=\"8\"/><path class=\"tick\" d=\"M{x} 2V18\"/>"
            );
        }
        if let Some([low, high]) = interval {
            let (from, to) = (self.at(1.0 - low), self.at(1.0 - high));
            let _ = write!(svg, "<path class=\"reach\" d=\"M{from} 10H{to}\"/>");
        }
        if let Some(value) = value {
            let _ = write!(svg, "<circle cx=\"{}\" cy=\"10\" r=\"4\"/>", self.at(1.0 - value));
        }
        let names = [(-1.0, "10 %", "start"), (-3.0, "0.1 %", "middle"), (-5.0, "10 ppm", "middle")];
        for (exponent, name, anchor) in names {
            let x = self.at(10f64.powf(exponent));
            let anchor = if x >= width { "end" } else { anchor };
            let _ = write!(svg, "<text x=\"{x}\" y=\"28\" text-anchor=\"{anchor}\">{name}</text>");
        }
        svg + "</svg>"
    }
}

/// A verdict as a shape and a word, so that no colour is needed.
fn badge(verdict: Option<Verdict>) -> String {
    let (class, shape, word) = match verdict {
        None => return "<span class=\"note\">no target</span>".to_owned(),
        Some(Verdict::Met) => {
            ("met", "<circle cx=\"8\" cy=\"8\" r=\"6.5\"/><path d=\"M4.8 8.2L7 10.5L11.2 5.8\"/>", "Met")
        }
        Some(Verdict::Missed) => ("missed", "<path d=\"M8 1.8L15 14H1ZM8 6V10M8 11.5V12.6\"/>", "Missed"),
        Some(Verdict::Inconclusive) => {
            ("unknown", "<circle cx=\"8\" cy=\"8\" r=\"6.5\" stroke-dasharray=\"3 2\"/>", "Not known")
        }
    };
    format!("<span class=\"st {class}\"><svg viewBox=\"0 0 16 16\" aria-hidden=\"true\">{shape}</svg>{word}</span>")
}

/// The ends of an interval with the digits that its width leaves.
fn interval(ends: [f64; 2]) -> String {
    let width = 100.0 * (ends[1] - ends[0]);
    // Narrower than this it is the yield itself.
    const NARROW: f64 = 1e-7;
    if width < NARROW {
        return String::new();
    }
    let decimals = (1.0 - width.log10().floor()).clamp(0.0, 9.0) as usize;
    let [low, high] = ends.map(|end| format!("{:.decimals$}", 100.0 * end));
    format!("{low} – {high} %")
}

fn row(place: usize, one: &CharacteristicAnalysis, gauge: &Gauge) -> String {
    let unit = one.unit().map(|unit| format!(" <small>{}</small>", escaped(unit))).unwrap_or_default();
    let rejects = one.rejects();
    let ends = one.yield_interval();
    let worst = one.extremes.as_ref().map(|found| [found.least.value, found.greatest.value]).or(one.worst_case);
    let scale = one.scale();
    let cpk = one.capability.as_ref().and_then(|of: &Capability| of.cpk);
    format!(
        "<tr><th scope=\"row\"><a href=\"#kc-{place}\">{}</a>{unit}</th><td>{}</td><td>{}</td><td class=\"n\"><strong>{}</strong><br><small>{}</small></td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td><td class=\"n\">{}</td></tr>\n",
        escaped(one.name()),
        badge(one.verdict()),
        gauge.svg(one.yield_(), ends, one.target()),
        escaped(&rejects.yield_text().unwrap_or_else(|| "unknown".to_owned())),
        ends.map(interval).unwrap_or_default(),
        one.target().map(yielded).unwrap_or_default(),
        escaped(&rejects.sides()).replace(", ", "<br>"),
        cpk.map(index).unwrap_or_default(),
        worst.map(|[low, high]| format!("{} –<br>{}", beside(low, scale), beside(high, scale))).unwrap_or_default(),
    )
}

/// The row of all limits at once.
fn together(report: &Report, gauge: &Gauge) -> String {
    let Some(joint) = &report.analysis.joint else { return String::new() };
    let limited = report.analysis.characteristics.iter().filter(|one| one.limited()).count();
    let rejects = Rejects::all(1.0 - joint.value, Some(joint.error));
    let ends = [joint.value - 2.0 * joint.error, joint.value + 2.0 * joint.error].map(|end| end.clamp(0.0, 1.0));
    let judged = report.analysis.joint_requirement;
    let target = judged.and_then(|judged| match judged.requirement {
        Requirement::Yield(target) => Some(target),
        _ => None,
    });
    format!(
        "<tr class=\"all\"><th scope=\"row\">{} together</th><td>{}</td><td>{}</td><td class=\"n\"><strong>{}</strong><br><small>{}</small></td><td class=\"n\">{}</td><td class=\"n\">{} ppm</td><td></td><td></td></tr>\n",
        if limited == 2 { "Both" } else { "All" },
        badge(judged.map(|judged| judged.verdict)),
        gauge.svg(Some(joint.value), Some(ends), target),
        escaped(&rejects.yield_text().unwrap_or_else(|| "unknown".to_owned())),
        interval(ends),
        target.map(yielded).unwrap_or_default(),
        escaped(&rejects.all_ppm().unwrap_or_default()),
    )
}

/// Which dimensions act jointly, a triangle below their own shares; nothing where no interaction is seen or left out.
pub(super) fn map(one: &CharacteristicAnalysis) -> Option<String> {
    let examined = one.interactions.len();
    let strongest = one.interactions.iter().filter_map(|pair| pair.share).fold(0.0, f64::max);
    // What all that was examined leaves out may be interactions.
    let left_out = one.left_out_share.unwrap_or(0.0);
    if one.possible_interactions == 0 || strongest.max(left_out) < 5.0 * SEEN {
        return None;
    }
    let own =
        |row: &crate::analysis::Sensitivity| row.linear_share.map(|linear| linear + row.curvature_share.unwrap_or(0.0));
    let mut rows: Vec<(&str, f64)> =
        one.sensitivities.iter().filter_map(|row| Some((row.dimension.as_str(), own(row)?))).collect();
    let in_pair = |name: &str| one.interactions.iter().any(|pair| pair.dimensions.iter().any(|of| of == name));
    rows.retain(|(name, share)| *share > SEEN || in_pair(name));
    rows.sort_by(|a, b| b.1.total_cmp(&a.1));
    let left = rows.len().saturating_sub(MAPPED);
    rows.truncate(MAPPED);
    if rows.len() < 2 {
        return None;
    }
    let shade = |share: f64| GREYS.iter().filter(|&&from| share >= from).count();
    let mut text = format!(
        "<table class=\"map\"><caption>Interactions of {}, % of the variance: {examined} of {} examined</caption><tbody>\n",
        escaped(one.name()),
        one.possible_interactions
    );
    for (i, (name, share)) in rows.iter().enumerate() {
        let _ = write!(text, "<tr><th scope=\"row\">{}</th>", escaped(name));
        for (other, _) in &rows[..i] {
            let pair = one.interactions.iter().find(|pair| {
                let [a, b] = &pair.dimensions;
                (a == name && b == other) || (a == other && b == name)
            });
            text += &match pair.map(|pair| pair.share) {
                Some(Some(share)) if share >= SEEN => {
                    let level = shade(share);
                    format!(
                        "<td class=\"g{level}\" title=\"{} × {}\">{}</td>",
                        escaped(name),
                        escaped(other),
                        percent(share)
                    )
                }
                Some(Some(_)) => "<td class=\"g0\"></td>".to_owned(),
                Some(None) => "<td class=\"hatched\">?</td>".to_owned(),
                None if examined < one.possible_interactions => {
                    "<td class=\"hatched\"><span class=\"sr\">not examined</span></td>".to_owned()
                }
                None => "<td></td>".to_owned(),
            };
        }
        let level = shade(*share);
        let _ = writeln!(text, "<td class=\"own g{level}\">{}</td></tr>", percent(*share));
    }
    text += "</tbody></table>\n";
    let more = if left > 0 { format!(" {left} dimensions of less influence are not shown.") } else { String::new() };
    let hatched =
        if examined < one.possible_interactions { " Hatched: not examined, or without a joint effect." } else { "" };
    Some(
        text + &format!(
            "<p class=\"note\">On the diagonal what a dimension makes alone, below what two make jointly; darker is more.{hatched}{more}</p>\n"
        ),
    )
}

/// Terms of the page.
const TERMS: [(&str, &str); 10] = [
    ("Yield", "Share of the assemblies that lie within the limits."),
    ("Rejects", "Assemblies outside a limit, per million."),
    (
        "95 % interval",
        "Holds the true value in 95 of 100 repetitions of the analysis. A target within it is neither met nor missed.",
    ),
    (
        "Cpk",
        "Distance from the mean to the nearer limit, in units of three sigma. It says nothing about the shape of the distribution.",
    ),
    ("Surface law", "Distribution of the fitted second-order surface with the inputs' own distributions."),
    ("Pearson fit", "Distribution of the Pearson system with the computed mean, sigma, skewness and kurtosis."),
    (
        "Share",
        "Part of the variance that a dimension makes alone. Shares, interactions and what is not resolved add up to 100 %.",
    ),
    ("Interaction", "Part of the variance that two dimensions make jointly, beyond the sum of their own."),
    (
        "Worst case",
        "Least and greatest value over the whole box of tolerances. Proven: no assembly lies beyond. Linear: by slopes alone.",
    ),
    ("RSS", "Root of the sum of squares of slope times half tolerance."),
];

/// The section of terms, for paper too.
pub(super) fn terms() -> String {
    let all: String =
        TERMS.iter().map(|(term, meaning)| format!("<div><dt>{term}</dt><dd>{meaning}</dd></div>\n")).collect();
    format!(
        "<section aria-labelledby=\"terms\">\n<h2 id=\"terms\">Terms</h2>\n<dl class=\"terms\">\n{all}</dl>\n</section>\n"
    )
}
