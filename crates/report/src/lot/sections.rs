//! Document of a comparison with a lot.

use crate::document::number::{known, percent, plural, significant, yielded};
use crate::document::{Blocks, Cell, Columns, DataTable, Document, Element, Section, Tone};
use crate::lot::LotReport;
use crate::lot::overlay::overlay;
use crate::lot::words::{correlation, departures, figure, placed, verdict};
use sensitol::lot::{
    CharacteristicInLot, DifferenceShare, DimensionInLot, LotComparison, LotVerdict, PredictedFigures,
};

/// Greatest number of dimensions whose part in a difference is listed in a terminal.
const LISTED: usize = 8;

/// Row of a table of predictions and measurements.
struct SourceRow {
    source: &'static str,
    mean: String,
    sigma: String,
    yield_: String,
    values: [Option<f64>; 3],
}

/// Builds the document with the tables `parts`, `assemblies` and `differences`.
pub(super) fn document(report: &LotReport) -> Document {
    let found = &report.comparison;
    let mut document = Document::titled(report.head.title.as_deref());
    let tests = plural(found.tests, "test", "tests");
    let level = percent(found.family_wise_level);
    document.line(format!("{}: {tests}, wrong together with at most {level} % (Holm)", report.lot.join(", ")));
    document.gap();
    for one in &found.characteristics {
        document.line(format!("{}: {}", one.name, verdict(one, found)));
    }
    for one in &found.dimensions {
        for phrase in departures(one, found.family_wise_level) {
            document.note(format!("{}: {phrase}", one.name));
        }
    }
    let level = found.family_wise_level;
    for pair in found.correlations.iter().filter(|pair| pair.departs(level)) {
        document.note(correlation(pair));
    }
    let named = found.dimensions.iter().filter(|one| one.departs(level)).count();
    if named == 0 && !found.dimensions.is_empty() {
        document.note("no measured dimension departs from its assumption");
    }
    document.gap();
    if !found.dimensions.is_empty() {
        document.table(parts(&found.dimensions, found.family_wise_level));
    }
    for pair in found.correlations.iter().filter(|pair| !pair.departs(level)) {
        document.note(correlation(pair));
    }
    if !found.not_measured.is_empty() {
        document.list("not measured, as assumed", found.not_measured.clone());
    }
    document.sections = found.characteristics.iter().map(|one| section(one, found)).collect();
    document.sections.extend(groups(&found.dimensions));
    document
}

fn parts(dimensions: &[DimensionInLot], level: f64) -> DataTable {
    let ends = |ends: [f64; 2], sigma: f64| {
        let [low, high] = ends.map(|end| placed(end, sigma));
        format!("{low} .. {high}")
    };
    let refuted = |refuted: bool| if refuted { Tone::Bad } else { Tone::Plain };
    Columns::default()
        .column("dimension", "", |one: &&DimensionInLot| Cell::name(&one.name))
        .column("parts", "parts", |one| Cell::count(one.parts as u64))
        .column("assumed_mean", "assumed", |one| {
            Cell::number(one.assumed_mean, |value| placed(value, one.assumed_sigma))
        })
        .column("mean", "mean", move |one| {
            Cell::number(one.mean.value, |value| placed(value, one.sigma.value))
                .toned(refuted(one.mean_test.refutes(level)))
        })
        .shown("95 %", move |one| Cell::text(ends(one.mean.interval, one.sigma.value)))
        .data("mean_low", |one| Cell::data(one.mean.interval[0]))
        .data("mean_high", |one| Cell::data(one.mean.interval[1]))
        .column("assumed_sigma", "assumed", |one| Cell::number(one.assumed_sigma, |value| significant(value, 3)))
        .column("sigma", "sigma", move |one| {
            Cell::number(one.sigma.value, |value| significant(value, 3)).toned(refuted(one.sigma_test.refutes(level)))
        })
        .shown("95 %", |one| Cell::text(one.sigma.interval.map(|end| significant(end, 3)).join(" .. ")))
        .data("sigma_low", |one| Cell::data(one.sigma.interval[0]))
        .data("sigma_high", |one| Cell::data(one.sigma.interval[1]))
        .data("p_mean", |one| Cell::data(one.mean_test.adjusted))
        .data("p_sigma", |one| Cell::data(one.sigma_test.adjusted))
        .data("p_shape", |one| Cell::data(one.shape_test.map(|test| test.adjusted)))
        .data("p_trend", |one| Cell::data(one.trend_test.map(|test| test.adjusted)))
        .data("pp", |one| Cell::data(one.pp.map(|pp| pp.value)))
        .column("ppk", "Ppk", |one| Cell::number(one.ppk.map(|ppk| ppk.value), |value| significant(value, 3)))
        .shown("95 %", |one| {
            Cell::text(one.ppk.map_or("-".to_owned(), |ppk| ppk.interval.map(|end| significant(end, 3)).join(" .. ")))
        })
        .data("ppk_low", |one| Cell::data(one.ppk.map(|ppk| ppk.interval[0])))
        .data("ppk_high", |one| Cell::data(one.ppk.map(|ppk| ppk.interval[1])))
        .data("posterior_mean", |one| Cell::data(one.posterior.map(|of| of.mean.value)))
        .data("posterior_sigma", |one| Cell::data(one.posterior.map(|of| of.sigma.value)))
        .table("parts", dimensions)
}

fn section(one: &CharacteristicInLot, found: &LotComparison) -> Section {
    let mut section = Section::of(&one.name, one.unit.as_deref());
    section.words = format!(": {}", verdict(one, found));
    section.table(sources(one));
    if !one.differences.is_empty() {
        section.table(difference_table(one));
        if let Some(left) = one.mean_remainder.filter(|left| left.abs() > 1e-3 * sigma(one)) {
            section.note(format!("curvature, spread and interactions change the mean by {}", significant(left, 3)));
        }
    }
    section.blocks.extend(overlay(one).map(Element::Chart));
    if let (LotVerdict::Unexplained { .. }, Some(_)) = (&one.verdict, &one.against_parts) {
        section.note("compare the assemblies of single measured parts with the model, and look for what is not in it");
    }
    section
}

fn sigma(one: &CharacteristicInLot) -> f64 {
    one.by_parts.or(one.assumed).map_or(1.0, |of| of.sigma)
}

fn sources(one: &CharacteristicInLot) -> DataTable {
    let spread = sigma(one);
    let share = |value: Option<f64>, ends: Option<[f64; 2]>| match (value, ends) {
        (Some(value), Some([low, high])) => format!("{} ({} .. {})", yielded(value), yielded(low), yielded(high)),
        (value, _) => known(value, yielded),
    };
    let predicted = |source: &'static str, of: &PredictedFigures| {
        let mean = match of.mean_interval {
            Some([low, high]) => {
                format!("{} ({} .. {})", placed(of.mean, spread), placed(low, spread), placed(high, spread))
            }
            None => placed(of.mean, spread),
        };
        let (sigma, yield_) = (significant(of.sigma, 4), share(of.yield_, of.yield_interval));
        SourceRow { source, mean, sigma, yield_, values: [Some(of.mean), Some(of.sigma), of.yield_] }
    };
    let mut rows: Vec<SourceRow> = Vec::new();
    rows.extend(one.assumed.as_ref().map(|of| predicted("assumed parts", of)));
    rows.extend(one.by_parts.as_ref().map(|of| predicted("measured parts", of)));
    rows.extend(one.assemblies.as_ref().map(|of| {
        let [low, high] = of.mean.interval.map(|end| placed(end, spread));
        SourceRow {
            source: "measured assemblies",
            mean: format!("{} ({low} .. {high})", placed(of.mean.value, spread)),
            sigma: figure(&of.sigma, 4),
            yield_: share(of.within.map(|within| within.value), of.within.map(|within| within.interval)),
            values: [Some(of.mean.value), Some(of.sigma.value), of.within.map(|within| within.value)],
        }
    }));
    Columns::default()
        .data("characteristic", |_: &SourceRow| Cell::text(&one.name))
        .column("source", "", |row| Cell::text(row.source))
        .column("mean", "mean", |row| Cell::number(row.values[0], |_| row.mean.clone()))
        .column("sigma", "sigma", |row| Cell::number(row.values[1], |_| row.sigma.clone()))
        .column("yield", "within limits", |row| Cell::number(row.values[2], |_| row.yield_.clone()))
        .table("assemblies", rows)
}

fn difference_table(one: &CharacteristicInLot) -> DataTable {
    let spread = sigma(one);
    Columns::default()
        .data("characteristic", |_: &&DifferenceShare| Cell::text(&one.name))
        .column("dimension", "difference by", |row| Cell::name(&row.dimension))
        .column("mean", "of the mean", |row| Cell::number(row.mean, |value| placed(value, spread)))
        .column("variance", "of the variance", |row| Cell::number(row.variance, |value| significant(value, 3)))
        .table("differences", &one.differences)
        .at_most([LISTED, usize::MAX], "further dimensions change less".to_owned())
}

/// Sections of the columns that group the parts.
fn groups(dimensions: &[DimensionInLot]) -> Option<Section> {
    let rows: Vec<(&DimensionInLot, &sensitol::lot::GroupsInLot)> =
        dimensions.iter().flat_map(|one| one.groups.iter().map(move |of| (one, of))).collect();
    if rows.is_empty() {
        return None;
    }
    let mut section = Section::of("between and within", None);
    let table = Columns::default()
        .column("dimension", "", |(one, _): &(&DimensionInLot, &sensitol::lot::GroupsInLot)| Cell::name(&one.name))
        .column("column", "column", |(_, of)| Cell::text(&of.column))
        .column("groups", "groups", |(_, of)| Cell::count(of.groups.len() as u64))
        .column("between", "sigma between", |(_, of)| Cell::number(of.between.value, |_| figure(&of.between, 3)))
        .column("within", "sigma within", |(_, of)| Cell::number(of.within.value, |_| figure(&of.within, 3)))
        .column("p", "p", |(_, of)| Cell::number(of.test.adjusted, |p| significant(p, 2)))
        .table("groups", rows);
    section.table(table);
    Some(section)
}
