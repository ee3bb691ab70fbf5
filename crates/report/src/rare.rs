//! The report of rare events.

use serde::Serialize;

use crate::document::number::{UNKNOWN, known, plain, plural, short, significant, yielded};
use crate::document::{Blocks, Cell, Columns, DataTable, Document, Element, Line, Section, Value};
use crate::figures::Named;
use crate::head;
use crate::head::seed;
use crate::output_correlation::all_limits;
use crate::overview as glance;
use crate::overview::OverviewLine;
use crate::reject_rate::{rejects, yield_text};
use crate::requirement::{judged, lines};
use crate::sampling::samples;
use crate::{About, DimensionReport, Head, WarningReport, correlation};
use sensitol::problem::Problem;
use sensitol::rare::{Beyond, DesignPoint, RareCharacteristic, RareEvents, Unmet};
use sensitol_numeric::correlation::Pair;

/// The report of rare events, as `--json` prints it. Unknown values are null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RareReport {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// `importance-sampling`.
    pub(crate) method: &'static str,
    /// The results.
    #[serde(flatten, serialize_with = "RareEvents::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "RareEvents"))]
    pub(crate) found: RareEvents,
    /// The dimensions, in the study's order.
    pub(crate) dimensions: Vec<DimensionReport>,
    /// The dimensions that vary together.
    pub(crate) correlation: Vec<Pair>,
    /// Warnings about assumptions that fail.
    pub warnings: Vec<WarningReport>,
}

impl RareReport {
    /// Builds the report of rare events.
    pub fn of(problem: &Problem, found: &RareEvents, about: About) -> Self {
        Self {
            head: Head::of("simulate", &about),
            method: "importance-sampling",
            found: found.clone(),
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            warnings: about.warnings.iter().chain(&found.warnings).map(WarningReport::of).collect(),
        }
    }
}

/// Greatest number of dimensions of a design point that are shown: those that move farthest.
const SHOWN: usize = 6;

impl RareReport {
    /// Builds the document: every probability with its interval (table `rare`), and its design point.
    pub fn document(&self) -> Document {
        let found = &self.found;
        let mut document = Document::titled(self.head.title.as_deref());
        document.line(format!(
            "importance sampling: {} points, {} with the {} surrogate{}{}",
            found.samples,
            plural(found.run.evaluations as usize, "evaluation", "evaluations"),
            found.method.name(),
            seed(&found.run),
            head::beside(&found.run)
        ));
        document.gap();
        document.table(glance::table(found.characteristics.iter().map(OverviewLine::sought)));
        if let Some([low, high]) = found.joint_interval {
            let interval = format!("95 % interval {} to {}", yielded(low), yielded(high));
            document.note(all_limits(&known(found.joint, yielded), &interval, found.joint_requirement.as_ref()));
        }
        document.sections = found.characteristics.iter().map(|one| one.section(&self.dimensions)).collect();
        document
    }
}

/// Side of the limits: `below` or `above`, and its result.
type Side<'r> = (&'static str, &'r Beyond);

/// Section on a characteristic with rare rejects.
pub(crate) trait RareSection {
    fn section(&self, dimensions: &[DimensionReport]) -> Section;

    fn table(&self, sides: &[Side<'_>]) -> DataTable;
}

impl RareSection for RareCharacteristic {
    fn section(&self, dimensions: &[DimensionReport]) -> Section {
        let mut section = Section::of(self.name(), self.unit());
        let sides = [("below", &self.below), ("above", &self.above)];
        let sides: Vec<Side<'_>> = sides.into_iter().filter_map(|(side, of)| Some((side, of.as_ref()?))).collect();
        if sides.is_empty() {
            section.detail(vec![Element::Table(self.table(&sides))]);
            section.note(if self.limited() { "its surrogate does not vary" } else { "no limit" });
            return section;
        }
        if let Some([low, high]) = self.yield_interval {
            let interval = format!("95 % interval {} to {}", yielded(low), yielded(high));
            let target = judged(self.target(), self.verdict());
            section.note(Line::from(format!("yield {}, {interval}", yield_text(self))).and(target));
        }
        if let Some(measured) = &self.sampling {
            section.note(format!("the interval includes what {} leave open", samples(measured)));
        }
        lines(self.requirements()).for_each(|line| section.note(line));
        section.gap();
        section.detail(vec![Element::Table(self.table(&sides))]);
        section.brief(vec![Element::Table(self.table(&sides).without(&["plain sampling"]))]);
        for (side, of) in &sides {
            if let Some([low, high]) = of.bounds {
                let ([low, high], failed) = ([low, high].map(ppm), self.failed);
                let all = format!("{high} if all {failed} do");
                section.note(format!("{side}: {low} ppm if no point without a value lies there, {all}"));
            }
        }
        for (side, of) in &sides {
            if let Some(Unmet { most, points, directions, .. }) = of.unmet {
                let dimensions =
                    if directions == 1 { "a dimension".to_owned() } else { format!("up to {directions} dimensions") };
                section.note(format!(
                    "{side}: up to {} ppm may lie where no point was, where {dimensions} must be off at once ({points} points)",
                    significant(1e6 * most, 2)
                ));
            }
        }
        for (side, of) in sides {
            if let Some(point) = &of.design_point {
                section.note(format!("most likely {side}, in sigmas off the means: {}", farthest(point, dimensions)));
            }
        }
        section
    }

    fn table(&self, sides: &[Side<'_>]) -> DataTable {
        let limit = |(side, of): &Side<'_>| Cell::both(Value::Empty, format!("{side} {}", plain(of.limit)));
        Columns::default()
            .data("characteristic", |_| Cell::text(self.name()))
            .data("unit", |_| Cell::optional(self.unit()))
            .data("side", |row: &Side<'_>| Cell::text(row.0))
            .shown("", limit)
            .data("limit", |row| Cell::data(row.1.limit))
            .column("probability", "ppm", |row| {
                let value = row.1.probability;
                Cell::both(Value::Number(value), value.map_or(UNKNOWN.to_owned(), |_| rejects(row.1, 4)))
            })
            .column("standard_error", "standard error", |row| {
                let error = row.1.standard_error;
                Cell::number(error, |error| significant(1e6 * error, 2))
            })
            .column("interval_low", "95 % interval", |row| Cell::number(row.1.interval[0], ppm))
            .named("interval_high", "to", |row| Cell::number(row.1.interval[1], ppm))
            .column("hits", "points there", |row| Cell::count(row.1.hits))
            .data("unmet", |row| Cell::data(row.1.unmet.map(|unmet| unmet.most)))
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

/// Formats a design point in sigmas off the means, farthest dimensions first.
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
