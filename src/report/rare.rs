//! The report of rare events.

use serde::Serialize;

use super::head::{self, seed};
use super::requirement::judged;
use super::{About, CorrelationReport, DimensionReport, Head, RequirementReport, WarningReport, correlation};
use crate::document::number::{known, plain, short, significant, yielded};
use crate::document::{Blocks, Cell, Columns, Document, Line, Section, Table, Value};
use crate::problem::Problem;
use crate::rare::{Beyond, DesignPoint, RareCharacteristic, RareEvents};
use crate::summary::RunSummary;
use crate::verdict::Verdict;

/// The report of rare events, as `--json` prints it. What is unknown is null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RareReport {
    /// What every report begins with.
    #[serde(flatten)]
    pub head: Head,
    /// `importance-sampling`.
    pub method: &'static str,
    /// The method of the surrogate that it was placed with.
    pub surrogate: &'static str,
    /// Points that were drawn and answered.
    pub samples: u64,
    /// What it came to in points and time, and why it ended early.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Those of the surrogate.
    pub surrogate_evaluations: u64,
    /// Whether the wanted standard errors were reached; null where none were wanted.
    pub reached: Option<bool>,
    /// The dimensions, in the study's order.
    pub dimensions: Vec<DimensionReport>,
    /// The dimensions that vary together.
    pub correlation: Vec<CorrelationReport>,
    /// What was asked.
    pub characteristics: Vec<RareCharacteristicReport>,
    /// Where an assumption fails.
    pub warnings: Vec<WarningReport>,
}

/// One characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct RareCharacteristicReport {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Points at which it has no value.
    pub failed: u64,
    /// Why not, of the first of them.
    pub error: Option<String>,
    /// Whether the search was stopped before all points were drawn.
    pub unfinished: bool,
    /// Lower limit.
    pub lower: Option<f64>,
    /// Upper limit.
    pub upper: Option<f64>,
    /// The share of assemblies that must keep the limits.
    pub target_yield: Option<f64>,
    /// Whether the interval of the yield lies above that (true), below (false), or around it (null).
    pub met: Option<bool>,
    /// The same in a word; null without a target.
    pub verdict: Option<Verdict>,
    /// Everything that is required of it, the target yield included.
    pub requirements: Vec<RequirementReport>,
    /// The share of assemblies within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// 95 % interval of that.
    pub yield_interval: Option<[f64; 2]>,
    /// What lies below the lower limit; null without one.
    pub below: Option<BeyondReport>,
    /// What lies above the upper limit; null without one.
    pub above: Option<BeyondReport>,
}

/// What lies beyond one limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct BeyondReport {
    /// The limit.
    pub limit: f64,
    /// The probability of an assembly beyond it; null where none was seen.
    pub probability: Option<f64>,
    /// Its standard error.
    pub standard_error: Option<f64>,
    /// 95 % interval.
    pub interval: [f64; 2],
    /// If no point without a value lies beyond, and if all do; null where every point has a value.
    pub bounds: Option<[f64; 2]>,
    /// The probability in millionths.
    pub ppm: Option<f64>,
    /// Points beyond.
    pub hits: u64,
    /// Equally weighted points that would tell as much.
    pub effective_samples: f64,
    /// The part of the estimate that the heaviest point has.
    pub greatest_part: Option<f64>,
    /// Points of a plain random sample that would have the same standard error.
    pub plain_samples: Option<f64>,
    /// The most likely assembly at the limit, as the surrogate has it.
    pub design_point: Option<DesignPoint>,
}

impl RareReport {
    /// The report of rare events.
    pub fn of(problem: &Problem, found: &RareEvents, about: About) -> Self {
        Self {
            head: Head::of("simulate", &about),
            method: "importance-sampling",
            surrogate: found.method.name(),
            samples: found.samples,
            run: found.run,
            surrogate_evaluations: found.surrogate_evaluations,
            reached: found.reached,
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            characteristics: found.characteristics.iter().map(RareCharacteristicReport::of).collect(),
            warnings: about.warnings.iter().chain(&found.warnings).map(WarningReport::of).collect(),
        }
    }
}

impl RareCharacteristicReport {
    fn of(one: &RareCharacteristic) -> Self {
        let limits = one.characteristic.limits();
        Self {
            name: one.characteristic.name().to_owned(),
            unit: one.characteristic.unit().map(str::to_owned),
            failed: one.failed,
            error: one.error.as_ref().map(ToString::to_string),
            unfinished: one.unfinished,
            lower: limits.lower(),
            upper: limits.upper(),
            target_yield: one.characteristic.target_yield(),
            met: one.verdict().and_then(Verdict::met),
            verdict: one.verdict(),
            requirements: one.requirements().iter().map(RequirementReport::of).collect(),
            yield_: one.yield_,
            yield_interval: one.yield_interval,
            below: one.below.as_ref().map(|beyond| BeyondReport::of(beyond, one.failed)),
            above: one.above.as_ref().map(|beyond| BeyondReport::of(beyond, one.failed)),
        }
    }
}

impl BeyondReport {
    fn of(beyond: &Beyond, failed: u64) -> Self {
        let value = beyond.probability.map(|probability| probability.value);
        Self {
            limit: beyond.limit,
            probability: value,
            standard_error: beyond.probability.and_then(|probability| probability.standard_error),
            interval: beyond.interval,
            bounds: (failed > 0).then_some(beyond.bounds),
            ppm: value.map(|value| 1e6 * value),
            hits: beyond.hits,
            effective_samples: beyond.effective_samples,
            greatest_part: beyond.greatest_part,
            plain_samples: beyond.plain_samples,
            design_point: beyond.design_point.clone(),
        }
    }
}

/// Dimensions of a design point that are shown: those that move farthest.
const SHOWN: usize = 6;

impl RareReport {
    /// What it says: every probability with its interval (table `rare`), and the assembly in which it most likely comes about.
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        document.line(format!(
            "importance sampling: {} points, {} evaluations with the {} surrogate{}{}",
            self.samples,
            self.run.evaluations,
            self.surrogate,
            seed(&self.run),
            head::beside(&self.run)
        ));
        document.sections = self.characteristics.iter().map(|one| one.section(&self.dimensions)).collect();
        document
    }
}

/// A side of the limits: `below` or `above`, and what lies there.
type Side<'r> = (&'static str, &'r BeyondReport);

impl RareCharacteristicReport {
    fn section(&self, dimensions: &[DimensionReport]) -> Section {
        let mut section = Section::of(&self.name, self.unit.as_deref());
        let sides = [("below", &self.below), ("above", &self.above)];
        let sides: Vec<Side<'_>> = sides.into_iter().filter_map(|(side, of)| Some((side, of.as_ref()?))).collect();
        section.table(self.table(&sides));
        if sides.is_empty() {
            let limited = self.lower.or(self.upper).is_some();
            section.note(if limited { "its surrogate does not vary" } else { "no limit" });
            return section;
        }
        for (side, of) in &sides {
            if let Some([low, high]) = of.bounds {
                let ([low, high], failed) = ([low, high].map(ppm), self.failed);
                let all = format!("{high} if all {failed} do");
                section.note(format!("{side}: {low} ppm if no point without a value lies there, {all}"));
            }
        }
        if let Some([low, high]) = self.yield_interval {
            let interval = format!("95 % interval {} to {}", yielded(low), yielded(high));
            let target = judged(self.target_yield, self.verdict);
            section.note(Line::from(format!("yield {}, {interval}", known(self.yield_, yielded))).and(target));
        }
        self.requirements.iter().filter_map(RequirementReport::line).for_each(|line| section.note(line));
        for (side, of) in sides {
            if let Some(point) = &of.design_point {
                section.note(format!("most likely {side}, in sigmas off the means: {}", farthest(point, dimensions)));
            }
        }
        section
    }

    fn table(&self, sides: &[Side<'_>]) -> Table {
        let limit = |(side, of): &Side<'_>| Cell::both(Value::Empty, format!("{side} {}", plain(of.limit)));
        let millionths =
            |value: Option<f64>, digits: usize| Cell::number(value, |value| significant(1e6 * value, digits));
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .data("unit", |_| Cell::optional(self.unit.as_deref()))
            .data("side", |row: &Side<'_>| Cell::text(row.0))
            .shown("", limit)
            .data("limit", |row| Cell::data(row.1.limit))
            .column("probability", "ppm", move |row| millionths(row.1.probability, 4))
            .column("standard_error", "standard error", move |row| millionths(row.1.standard_error, 2))
            .column("interval_low", "95 % interval", |row| Cell::number(row.1.interval[0], ppm))
            .named("interval_high", "to", |row| Cell::number(row.1.interval[1], ppm))
            .column("hits", "points there", |row| Cell::count(row.1.hits))
            .data("effective_samples", |row| Cell::data(row.1.effective_samples))
            .column("plain_samples", "plain sampling", |row| {
                Cell::number(row.1.plain_samples, |samples| significant(samples, 2))
            })
            .table("rare", sides.iter().copied())
    }
}

fn ppm(value: f64) -> String {
    significant(1e6 * value, 3)
}

/// A design point in sigmas off the means, farthest first.
fn farthest(point: &DesignPoint, dimensions: &[DimensionReport]) -> String {
    let mut moved: Vec<(f64, String)> = (dimensions.iter().zip(&point.values))
        .filter(|(dimension, _)| dimension.sigma > 0.0)
        .map(|(dimension, value)| ((value - dimension.mean) / dimension.sigma, short(&dimension.name)))
        .collect();
    moved.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()));
    let rest = moved.len().saturating_sub(SHOWN);
    let words = moved.iter().take(SHOWN).map(|(sigmas, name)| format!("{name} {sigmas:+.2}"));
    let rest = if rest > 0 { format!(" and {rest} less") } else { String::new() };
    format!("{}{rest}", words.collect::<Vec<_>>().join(", "))
}
