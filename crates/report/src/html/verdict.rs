//! Verdict of every report: a sentence, and a gauge for every characteristic.

use crate::analysis::worst_case::KnownWorstCaseFigures;
use std::fmt::Write;

use crate::WarningReport;
use crate::analysis::analysis_document::CharacteristicSections;
use crate::analysis::statistics::part;
use crate::analysis::worst_case::{KnownWorstCase, WorstCaseKind};
use crate::analysis::yield_source::least_yield;
use crate::document::number::{FEWEST, index, known, plain, plural, significant, yielded};
use crate::document::rejects::Rejects;
use crate::document::svg::escaped;
use crate::figures::{Figures, Named};
use crate::reject_rate::{rejects, yield_text};
use crate::requirement::{demand, short_measure};
use crate::sweep::{SweptPointReport, SweptReport};
use sensitol::analysis::CharacteristicAnalysis;
use sensitol::rare::{Beyond, RareCharacteristic};
use sensitol::simulation::{SimulatedCharacteristic, YieldEstimate};
use sensitol_numeric::capability::Capability;
use sensitol_numeric::json_form::finite;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::sampling::one_error;
use sensitol_numeric::verdict::{Judged, Verdict};

/// Greatest number of claims of one kind in the sentence.
const NAMED: usize = 6;
/// Least reject rate that the sentence prints as a number.
const NONE: f64 = 1e-9;

/// Findings of one characteristic with limits or requirements, from any command.
pub(super) struct JudgedCharacteristic<'r> {
    name: &'r str,
    unit: Option<&'r str>,
    /// Index of its section on the page. None if it has no section.
    place: Option<usize>,
    /// Number of warnings in that section.
    warned: usize,
    limits: [Option<f64>; 2],
    /// Line below the name, such as the value of a sweep.
    pub(super) at: String,
    pub(super) target: Option<f64>,
    /// Verdict on the target yield.
    pub(super) verdict: Option<Verdict>,
    /// Further requirements.
    pub(super) asked: Vec<Asked>,
    yield_: Option<f64>,
    interval: Option<[f64; 2]>,
    /// Yield before an allocation.
    pub(super) before: Option<f64>,
    yield_text: Option<String>,
    /// All rejects in parts per million, as text.
    all_ppm: Option<String>,
    /// Rejects below and above, in parts per million.
    ppm: [Option<f64>; 2],
    /// Rejects below and above, as text.
    sides: Vec<String>,
    cpk: Option<f64>,
    worst: Option<KnownWorstCase>,
    /// Dimension with the largest share of the variance, and this share.
    driver: Option<(&'r str, f64)>,
}

/// Requirement other than a yield: its text, the value found, and the verdict.
pub(super) struct Asked {
    what: String,
    found: String,
    verdict: Verdict,
}

/// Yield of all limits at once.
pub(super) struct Together<'r> {
    value: f64,
    ends: [f64; 2],
    rejects: Rejects,
    judged: Option<&'r Judged>,
}

/// Words of a page around the verdict.
#[derive(Default)]
pub(super) struct Words {
    /// Sentence before the others, as markup.
    pub(super) before: String,
    /// Sentence after the others.
    pub(super) after: String,
    /// Note on the gauges.
    pub(super) gauge: &'static str,
    /// Warnings without a section, after the table.
    pub(super) warnings: String,
}

impl<'r> JudgedCharacteristic<'r> {
    fn of(one: &'r impl Named, place: usize) -> Self {
        Self { unit: one.unit(), target: one.target(), ..Self::named(one.name(), Named::limits(one), place) }
    }

    /// Returns an entry with a section and without any findings.
    fn named(name: &'r str, limits: [Option<f64>; 2], place: usize) -> Self {
        Self {
            name,
            unit: None,
            place: Some(place),
            warned: 0,
            limits,
            at: String::new(),
            target: None,
            verdict: None,
            asked: Vec::new(),
            yield_: None,
            interval: None,
            before: None,
            yield_text: None,
            all_ppm: None,
            ppm: [None; 2],
            sides: Vec::new(),
            cpk: None,
            worst: None,
            driver: None,
        }
    }

    /// Adds the texts of reject rates.
    fn rejecting(mut self, rejects: Rejects) -> Self {
        self.yield_text = rejects.yield_text();
        self.all_ppm = rejects.all_ppm();
        self.sides = rejects.sides().split(", ").filter(|side| !side.is_empty()).map(str::to_owned).collect();
        self
    }

    /// Findings of an analysis.
    pub(super) fn analysed(place: usize, one: &'r CharacteristicAnalysis) -> Self {
        let all = one.sensitivities.iter().filter_map(|row| Some((row.dimension.as_str(), part(row)?)));
        let rejecting = Self::of(one, place).rejecting(one.rejects());
        let free = one.distribution.distribution_free_yield.as_ref().and_then(least_yield);
        Self {
            yield_text: free.or(rejecting.yield_text),
            verdict: one.verdict(),
            asked: asked(one.requirements()),
            yield_: one.yield_(),
            interval: one.yield_interval(),
            ppm: [one.ppm_below(), one.ppm_above()],
            cpk: one.distribution.capability.as_ref().and_then(|of: &Capability| of.cpk),
            worst: one.known_worst_case(),
            driver: all.max_by(|a, b| a.1.total_cmp(&b.1)),
            ..rejecting
        }
    }

    /// Findings of a simulation.
    pub(super) fn simulated(place: usize, one: &'r SimulatedCharacteristic) -> Self {
        Self {
            verdict: one.verdict(),
            asked: asked(one.requirements()),
            yield_: one.yield_(),
            interval: one.yield_interval(),
            ppm: [one.ppm_below(), one.ppm_above()],
            cpk: one.cpk,
            ..Self::of(one, place)
                .rejecting(Rejects::new(one.below, one.above, one.yield_error()).within(one.reject_intervals))
        }
    }

    /// Findings of rare events.
    pub(super) fn rare(place: usize, one: &'r RareCharacteristic) -> Self {
        let value = |of: &Option<Beyond>| of.as_ref()?.probability;
        let sides = [("below", &one.below), ("above", &one.above)];
        let is_known =
            |of: &Beyond| of.probability.is_some_and(|value| of.unmet.is_none_or(|unmet| unmet.most < value));
        let known = sides.iter().all(|(_, of)| of.as_ref().is_none_or(is_known));
        let all: f64 = sides.iter().filter_map(|(_, of)| value(of)).sum();
        Self {
            verdict: one.verdict(),
            asked: asked(one.requirements()),
            yield_: one.yield_,
            interval: one.yield_interval,
            yield_text: one.yield_.map(|_| yield_text(one)),
            all_ppm: (known && one.limited()).then(|| match all > 0.0 && all < FEWEST {
                true => format!("< {}", significant(1e6 * FEWEST, 2)),
                false => significant(1e6 * all, 3),
            }),
            ppm: [&one.below, &one.above].map(|of| value(of).map(|share| 1e6 * share)),
            sides: sides.into_iter().filter_map(|(side, of)| Some(beyond(side, of.as_ref()?))).collect(),
            ..Self::of(one, place)
        }
    }

    /// Findings of a sweep, at the value with the worst verdict and yield. Returns None if there are no points.
    pub(super) fn swept(place: usize, one: &'r SweptReport, parameter: &str) -> Option<Self> {
        let rank = |point: &SweptPointReport| {
            let worst = point.requirements.iter().map(|judged| match judged.verdict {
                Verdict::Missed => 2,
                Verdict::Inconclusive => 1,
                Verdict::Met => 0,
            });
            (worst.max().unwrap_or(0), point.yield_.map_or(0.0, |yield_| 1.0 - yield_))
        };
        let worst = one.points.iter().max_by(|a, b| {
            let (a, b) = (rank(a), rank(b));
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        })?;
        let target = worst.requirements.iter().find_map(|judged| judged.requirement.target_yield());
        Some(Self {
            unit: one.unit.as_deref(),
            target,
            verdict: worst.verdict,
            asked: asked(worst.requirements.clone()),
            at: format!("at {parameter} = {}", plain(worst.at)),
            yield_: worst.yield_,
            interval: worst.yield_interval,
            ppm: [worst.ppm_below, worst.ppm_above],
            ..Self::named(&one.name, [one.lower, one.upper], place).rejecting(worst.rejects())
        })
    }

    /// Counts the warnings that concern the characteristic.
    pub(super) fn warned(self, warnings: &[WarningReport]) -> Self {
        let concerned = warnings.iter().filter(|one| one.asks() && one.characteristic.as_deref() == Some(self.name));
        Self { warned: concerned.count(), ..self }
    }

    /// Removes the link to a section.
    pub(super) fn nowhere(self) -> Self {
        Self { place: None, ..self }
    }

    fn limited(&self) -> bool {
        self.limits != [None, None]
    }

    /// True if there are limits or requirements to judge.
    pub(super) fn counts(&self) -> bool {
        self.limited() || !self.asked.is_empty()
    }
}

/// Formats the rejects on one side, or their bound.
fn beyond(side: &str, of: &Beyond) -> String {
    format!("{} ppm {side}", rejects(of, 3))
}

/// Returns all requirements except the target yield.
pub(super) fn asked(judged: Vec<Judged>) -> Vec<Asked> {
    judged.into_iter().filter_map(|one| Asked::of(one.requirement, &one)).collect()
}

impl Asked {
    /// Returns the requirement, or None if it is a yield.
    pub(super) fn of(requirement: Requirement, judged: &Judged) -> Option<Self> {
        if requirement.target_yield().is_some() {
            return None;
        }
        let found = known(judged.value.and_then(finite), |value| short_measure(requirement, value));
        Some(Self { what: demand(requirement), found, verdict: judged.verdict })
    }
}

impl<'r> Together<'r> {
    /// Yield with its standard error.
    pub(super) fn about(value: f64, error: f64, judged: Option<&'r Judged>) -> Self {
        let ends = [value - 2.0 * error, value + 2.0 * error].map(|end| end.clamp(0.0, 1.0));
        Self { value, ends, rejects: Rejects::all(1.0 - value, Some(error)), judged }
    }

    /// Yield with its interval.
    pub(super) fn within(share: &YieldEstimate, judged: Option<&'r Judged>) -> Self {
        let error = one_error(share.value, share.interval);
        let rejects = Rejects::all(1.0 - share.value, Some(error));
        Self { value: share.value, ends: share.interval, rejects, judged }
    }
}

/// Writes the section of the verdict, empty except for warnings if nothing is required.
pub(super) fn verdict(all: &[JudgedCharacteristic<'_>], together: Option<Together<'_>>, words: &Words) -> String {
    let lead = [words.before.as_str(), &sentence(all), &words.after];
    let lead: Vec<&str> = lead.into_iter().filter(|part| !part.is_empty()).collect();
    let lead = lead.join(" ");
    let rows: Vec<&JudgedCharacteristic<'_>> = all.iter().filter(|one| one.counts()).collect();
    if lead.is_empty() && rows.is_empty() {
        return words.warnings.clone();
    }
    let mut text =
        "<section aria-labelledby=\"verdict\" class=\"verdict\">\n<h2 id=\"verdict\">Verdict</h2>\n".to_owned();
    if !lead.is_empty() {
        let _ = writeln!(text, "<p class=\"lead\">{lead}</p>");
    }
    if !rows.is_empty() {
        let table = Table {
            gauge: Gauge::of(all),
            cpk: rows.iter().any(|one| one.cpk.is_some()),
            worst: rows.iter().any(|one| one.worst.is_some()),
        };
        text += &table.head();
        text.extend(rows.iter().map(|one| table.row(one)));
        if let Some(together) = together {
            let limited = rows.iter().filter(|one| one.limited()).count();
            text += &table.together(&together, limited);
        }
        let _ = writeln!(
            text,
            "</tbody></table></div>\n<p class=\"note\">Gauge: dot and bar, the yield and its interval; tick, the target; tinted, the side of a missed target.{}</p>",
            words.gauge
        );
    }
    text + &words.warnings + "</section>\n"
}

/// Sentence on the verdicts: missed targets first, with number, side and cause, then the others.
fn sentence(all: &[JudgedCharacteristic<'_>]) -> String {
    let mut parts = Vec::new();
    for (wanted, more) in [
        (Verdict::Missed, "more targets are missed"),
        (Verdict::Inconclusive, "more targets may be missed"),
        (Verdict::Met, "more targets are met"),
    ] {
        let of_yield = all.iter().filter(|one| one.target.is_some() && one.verdict == Some(wanted));
        let mut claims: Vec<String> = of_yield.map(|one| of_target(one, wanted)).collect();
        let others = all.iter().flat_map(|one| one.asked.iter().map(move |asked| (one.name, asked)));
        claims.extend(others.filter(|(_, asked)| asked.verdict == wanted).map(|(name, asked)| of_asked(name, asked)));
        let left = claims.len().saturating_sub(NAMED);
        parts.extend(claims.into_iter().take(NAMED));
        parts.extend((left > 0).then(|| format!("{left} {more}.")));
    }
    parts.join(" ")
}

fn of_asked(name: &str, Asked { what, found, verdict }: &Asked) -> String {
    let (name, what, found) = (escaped(name), escaped(what), escaped(found));
    match verdict {
        Verdict::Missed => format!("<strong>{name} misses {what}:</strong> it has {found}."),
        Verdict::Inconclusive => format!("<strong>{name} may or may not keep {what}</strong>: it has {found}."),
        Verdict::Met => format!("{name} keeps {what}: it has {found}."),
    }
}

fn of_target(one: &JudgedCharacteristic<'_>, wanted: Verdict) -> String {
    let name = escaped(one.name);
    let ppm = |target: f64| significant(1e6 * (1.0 - target), 4);
    let allowed = one.target.map(ppm).unwrap_or_default();
    let at = if one.at.is_empty() { String::new() } else { format!("{} ", escaped(&one.at)) };
    match wanted {
        Verdict::Missed => {
            let rejected = one.all_ppm.clone().unwrap_or_else(|| "an unknown number of".to_owned());
            let side = side(one).unwrap_or_default();
            let cause = driver(one).map(|cause| format!(" {cause}")).unwrap_or_default();
            format!(
                "<strong>{name} misses its target:</strong> {at}{} ppm are rejected where {allowed} are allowed{side}.{cause}",
                escaped(&rejected)
            )
        }
        Verdict::Inconclusive => {
            let between = one.interval.map_or(String::new(), |[low, high]| {
                let [most, least] = [low, high].map(|end| significant(1e6 * (1.0 - end), 2));
                format!(": {at}{least} to {most} ppm are rejected where {allowed} are allowed")
            });
            format!("<strong>{name} may or may not meet its target</strong>{between}.")
        }
        Verdict::Met => {
            let none = one.yield_.is_some_and(|yield_| 1.0 - yield_ < NONE);
            let rejected = match &one.all_ppm {
                Some(_) if none => " with fewer than 0.001 ppm".to_owned(),
                Some(ppm) => match ppm.strip_prefix("< ") {
                    Some(most) => format!(" with fewer than {most} ppm"),
                    None => format!(" with {ppm} ppm"),
                },
                None => String::new(),
            };
            let at = if one.at.is_empty() { String::new() } else { format!(" {}", escaped(&one.at)) };
            format!("{name} meets its target{rejected}{at}.")
        }
    }
}

/// Names the side with most of the rejects. Returns None if there is only one limit, or no side has more than 60 %.
fn side(one: &JudgedCharacteristic<'_>) -> Option<String> {
    let [lower, upper] = one.limits;
    let [below, above] = one.ppm.map(|ppm| ppm.unwrap_or(0.0));
    let unit = one.unit.map(|unit| format!(" {}", escaped(unit))).unwrap_or_default();
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

/// Names the dimension with the largest share of the variance if it has at least 20 %.
fn driver(one: &JudgedCharacteristic<'_>) -> Option<String> {
    let (name, share) = one.driver?;
    let percent = (100.0 * share).round();
    (share >= 0.2).then(|| format!("<em>{}</em> makes {percent} % of its variance.", escaped(name)))
}

/// Logarithmic scale of all gauges: from 10 % rejected to 10 ppm, or further if a target needs it.
struct Gauge {
    /// Exponent of ten of the least reject rate.
    least: f64,
}

impl Gauge {
    /// Width in pixels.
    const WIDTH: f64 = 150.0;

    fn of(all: &[JudgedCharacteristic<'_>]) -> Self {
        let targets = all.iter().filter_map(|one| one.target);
        let least = targets.map(|target| libm::log10(1.0 - target).floor() - 1.0).fold(-5.0, f64::min);
        Self { least: least.max(-9.0) }
    }

    /// Returns the place of a reject rate. Many rejects are on the left.
    fn at(&self, rejected: f64) -> f64 {
        let share = (-1.0 - libm::log10(rejected.max(1e-300))) / (-1.0 - self.least);
        (10.0 * Self::WIDTH * share.clamp(0.0, 1.0)).round() / 10.0
    }

    fn svg(&self, value: Option<f64>, interval: Option<[f64; 2]>, target: Option<f64>, before: Option<f64>) -> String {
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
        if let Some(before) = before {
            let x = self.at(1.0 - before);
            let _ = write!(svg, "<path class=\"was\" d=\"M{x} 5l5 5l-5 5l-5 -5z\"/>");
        }
        if let Some(value) = value {
            let _ = write!(svg, "<circle cx=\"{}\" cy=\"10\" r=\"4\"/>", self.at(1.0 - value));
        }
        let names = [(-1.0, "10 %", "start"), (-3.0, "0.1 %", "middle"), (-5.0, "10 ppm", "middle")];
        for (exponent, name, anchor) in names {
            let x = self.at(libm::pow(10f64, exponent));
            let anchor = if x >= width { "end" } else { anchor };
            let _ = write!(svg, "<text x=\"{x}\" y=\"28\" text-anchor=\"{anchor}\">{name}</text>");
        }
        svg + "</svg>"
    }
}

/// Writes a verdict as a shape and a word, so that it does not depend on colour.
fn badge(verdict: Option<Verdict>) -> String {
    let (class, shape, word) = match verdict {
        None => return "<span class=\"note\">no target</span>".to_owned(),
        Some(Verdict::Met) => {
            ("met", "<circle cx=\"8\" cy=\"8\" r=\"6.5\"/><path d=\"M4.8 8.2L7 10.5L11.2 5.8\"/>", "Met")
        }
        Some(Verdict::Missed) => ("missed", "<path d=\"M8 1.8L15 14H1ZM8 6V10M8 11.5V12.6\"/>", "Missed"),
        Some(Verdict::Inconclusive) => {
            ("unknown", "<circle cx=\"8\" cy=\"8\" r=\"6.5\" stroke-dasharray=\"3 2\"/>", "Inconclusive")
        }
    };
    format!("<span class=\"st {class}\"><svg viewBox=\"0 0 16 16\" aria-hidden=\"true\">{shape}</svg>{word}</span>")
}

/// Formats an interval with the digits that its width supports.
pub(super) fn interval(ends: [f64; 2]) -> String {
    let width = 100.0 * (ends[1] - ends[0]);
    // Least width that is printed, in percent: a narrower interval equals the yield.
    const NARROW: f64 = 1e-7;
    if width < NARROW {
        return String::new();
    }
    let decimals = (1.0 - libm::log10(width).floor()).clamp(0.0, 9.0) as usize;
    let [low, high] = ends.map(|end| format!("{:.decimals$}", 100.0 * end));
    format!("{low} – {high} %")
}

/// Writes a cell of figures, with the label that it has on a phone.
fn labelled(label: &str, text: &str) -> String {
    if text.is_empty() {
        return "<td class=\"n\"></td>".to_owned();
    }
    format!("<td class=\"n\" data-label=\"{label}\">{text}</td>")
}

/// Optional columns of the table, and the scale of its gauges.
struct Table {
    gauge: Gauge,
    cpk: bool,
    worst: bool,
}

impl Table {
    fn head(&self) -> String {
        let mut titles = vec![
            ("characteristic", false),
            ("verdict", false),
            ("rejects, log scale", false),
            ("yield, 95 %", true),
            ("target", true),
            ("rejects", true),
        ];
        titles.extend(self.cpk.then_some(("Cpk", true)));
        titles.extend(self.worst.then_some(("worst case", true)));
        let title = |(name, right): (&str, bool)| {
            format!("<th scope=\"col\"{}>{name}</th>", if right { " class=\"n\"" } else { "" })
        };
        format!(
            "<div class=\"wide\" tabindex=\"0\" role=\"region\" aria-label=\"Verdicts\"><table class=\"gauges\"><thead><tr>{}</tr></thead><tbody>\n",
            titles.into_iter().map(title).collect::<String>()
        )
    }

    fn row(&self, one: &JudgedCharacteristic<'_>) -> String {
        let unit = one.unit.map(|unit| format!(" <small>{}</small>", escaped(unit))).unwrap_or_default();
        let name = escaped(one.name);
        let name = one.place.map_or(name.clone(), |place| format!("<a href=\"#kc-{place}\">{name}</a>"));
        let warned = one.place.filter(|_| one.warned > 0).map_or(String::new(), |place| {
            let count = plural(one.warned, "warning", "warnings");
            format!("<br><small><a class=\"warned\" href=\"#warned-{place}\">{count}</a></small>")
        });
        let at = if one.at.is_empty() { String::new() } else { format!("<br><small>{}</small>", escaped(&one.at)) };
        let mut verdicts = Vec::new();
        if one.target.is_some() || one.asked.is_empty() {
            verdicts.push(badge(one.verdict));
        }
        verdicts.extend(one.asked.iter().map(|asked| badge(Some(asked.verdict))));
        let mut targets: Vec<String> = one.target.map(yielded).into_iter().collect();
        targets.extend(one.asked.iter().map(|asked| escaped(&asked.what)));
        let unknown = || if one.limited() { "unknown".to_owned() } else { String::new() };
        let sides: Vec<String> = one.sides.iter().map(|side| escaped(side)).collect();
        let mut cells = format!(
            "<tr><th scope=\"row\">{name}{unit}{at}{warned}</th><td>{}</td><td>{}</td><td class=\"n\" data-label=\"yield\"><strong>{}</strong><br><small>{}</small></td>{}{}",
            verdicts.join("<br>"),
            if one.limited() {
                self.gauge.svg(one.yield_, one.interval, one.target, one.before)
            } else {
                String::new()
            },
            escaped(&one.yield_text.clone().unwrap_or_else(unknown)),
            one.interval.map(interval).unwrap_or_default(),
            labelled("target", &targets.join("<br>")),
            labelled("rejects", &sides.join("<br>")),
        );
        if self.cpk {
            cells += &labelled("Cpk", &one.cpk.map(index).unwrap_or_default());
        }
        if self.worst {
            let ends = one.worst.as_ref().map(|KnownWorstCase { kind, texts: [low, high], .. }| {
                let known = match kind {
                    WorstCaseKind::Proven => "",
                    WorstCaseKind::Found => "<br><small>found</small>",
                    WorstCaseKind::Linear => "<br><small>linear</small>",
                };
                format!("{low} –<br>{high}{known}")
            });
            let ends = ends.unwrap_or_default();
            cells += &labelled("worst case", &ends);
        }
        cells + "</tr>\n"
    }

    /// Writes the row of all limits at once.
    fn together(&self, of: &Together<'_>, limited: usize) -> String {
        let target = of.judged.and_then(|judged| judged.requirement.target_yield());
        let rest = "<td></td>".repeat(usize::from(self.cpk) + usize::from(self.worst));
        format!(
            "<tr class=\"all\"><th scope=\"row\">{} together</th><td>{}</td><td>{}</td><td class=\"n\" data-label=\"yield\"><strong>{}</strong><br><small>{}</small></td>{}{}{rest}</tr>\n",
            if limited == 2 { "Both" } else { "All" },
            badge(of.judged.map(|judged| judged.verdict)),
            self.gauge.svg(Some(of.value), Some(of.ends), target, None),
            escaped(&of.rejects.yield_text().unwrap_or_else(|| "unknown".to_owned())),
            interval(of.ends),
            labelled("target", &target.map(yielded).unwrap_or_default()),
            labelled("rejects", &of.rejects.all_ppm().map(|ppm| format!("{} ppm", escaped(&ppm))).unwrap_or_default()),
        )
    }
}
