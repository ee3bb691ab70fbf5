//! Statistics of a characteristic with their errors, its intervals, and its strongest contributors.

use std::collections::HashMap;
use std::collections::hash_map::Entry;

use crate::DimensionReport;
use crate::analysis::worst_case::KnownWorstCaseFigures;
use crate::document::number::{
    UNKNOWN, beside, carried, carried_ends, known, outward, percent, plain, shape_with, significant, uncertainty,
};
use crate::document::{Blocks, Cell, Columns, DataTable, Section, Value};
use crate::figures::Figures;
use crate::figures::FittedFigures;
use sensitol::analysis::{CharacteristicAnalysis, IndexSource, Sensitivity};
use sensitol::method::{ErrorEstimate, ErrorSource};
use sensitol_numeric::names::element;

/// Greatest number of contributors on a terminal.
const CONTRIBUTORS: usize = 6;
/// Name of the first figure.
const FIRST_FIGURE: &str = "nominal";
/// Name of the first interval.
const FIRST_INTERVAL: &str = "± 3 sigma";
/// Greatest difference, in sigmas, of bounds from the linear worst case that hides the bounds.
const SAME: f64 = 1e-3;
/// Sigmas on either side in place of the band of a dimension without a tolerance.
const BAND: f64 = 3.0;
/// Least share of the variance by a dimension's interactions that is worth a column.
const TOTAL: f64 = 0.01;
/// Derivatives within so many of their rounding errors count as 0.
const ROUNDINGS: f64 = 2.0;

/// Figure as it is printed, with no more decimals than its error supports.
pub(crate) struct Shown {
    name: &'static str,
    value: Option<f64>,
    pub(crate) text: String,
    /// Error as `± ...` or `exact`; empty if it is unknown.
    pub(crate) error: String,
}

impl Shown {
    fn cells(self) -> [Cell; 3] {
        let error = if self.error.is_empty() { Cell::empty() } else { Cell::text(self.error) };
        [Cell::text(self.name), Cell::both(Value::Number(self.value), self.text), error]
    }
}

/// Statistics and contributors of a characteristic.
pub(crate) trait CharacteristicStatistics {
    /// Returns nominal value, mean, mean shift, sigma, skewness and kurtosis.
    fn first_figures(&self) -> [Shown; 6];

    /// Adds the figures with their errors, then the intervals, each in a row of its own.
    fn statistics(&self, section: &mut Section);

    /// Table of the intervals. A terminal leaves out a linear worst case beside a proven one unless everything is requested.
    fn intervals(&self) -> DataTable;

    /// True if the contributions come from points of the model, because the surface is not trusted.
    fn is_of_model(&self) -> bool;

    /// True if the interactions of a dimension add visibly to its contribution.
    fn has_totals(&self) -> bool;

    /// Table of the strongest contributors, each with its own spread and its effect here. The parts of a geometric element are one
    /// contributor.
    fn contributors(&self, dimensions: &[DimensionReport]) -> DataTable;
}

impl CharacteristicStatistics for CharacteristicAnalysis {
    fn first_figures(&self) -> [Shown; 6] {
        let scale = self.scale();
        let estimate = self.error_estimate.as_ref();
        let exact = estimate.is_some_and(|of| matches!(of.sources[..], [ErrorSource::Proven { .. }]));
        let of = |figure: fn(&ErrorEstimate) -> Option<f64>| estimate.and_then(figure);
        let error = |error: Option<f64>| match error {
            Some(_) if exact => "exact".to_owned(),
            error => error.map(|error| format!("± {}", uncertainty(error))).unwrap_or_default(),
        };
        let shown = |name: &'static str, value: Option<f64>, text: &dyn Fn(f64) -> String, error: String| Shown {
            name,
            value,
            text: known(value, text),
            error,
        };
        let [of_mean, of_sigma] = [of(|of| of.mean), of(|of| of.sigma)];
        let [of_skewness, of_kurtosis] = [of(|of| of.skewness), of(|of| of.kurtosis)];
        // Without a sigma the nominal value has its own digits.
        let nominal = |value: f64| match self.sigma() {
            Some(_) => carried(value, scale, None),
            None => significant(value, 6),
        };
        let shift = self.mean().zip(self.nominal).map(|(mean, nominal)| mean - nominal);
        [
            shown(FIRST_FIGURE, self.nominal, &nominal, String::new()),
            shown("mean", self.mean(), &|value| carried(value, scale, of_mean), error(of_mean)),
            shown("shift", shift, &|value| carried(value, scale, of_mean), String::new()),
            shown("sigma", self.sigma(), &|value| carried(value, scale, of_sigma), error(of_sigma)),
            shown("skewness", self.skewness(), &|value| shape_with(value, of_skewness), error(of_skewness)),
            shown("kurtosis", self.kurtosis(), &|value| shape_with(value, of_kurtosis), error(of_kurtosis)),
        ]
    }

    fn statistics(&self, section: &mut Section) {
        let figures = self.first_figures().map(Shown::cells);
        section.table(DataTable::untitled(figures));
        section.table(self.intervals());
    }

    fn intervals(&self) -> DataTable {
        let scale = self.scale();
        let estimate = self.error_estimate.as_ref();
        let [mean_error, sigma_error] = [estimate.and_then(|of| of.mean), estimate.and_then(|of| of.sigma)];
        // Error of an end that is k sigmas from the mean.
        let end_error = |k: f64| mean_error.zip(sigma_error).map(|(mean, sigma)| libm::hypot(mean, k * sigma));
        let interval = |ends: Option<[f64; 2]>, error: Option<f64>| {
            ends.map_or(UNKNOWN.to_owned(), |ends| carried_ends(ends, scale, error).join(" .. "))
        };
        let around = |middle: Option<f64>, reach: Option<f64>, error| {
            interval(middle.zip(reach).map(|(middle, reach)| [middle - reach, middle + reach]), error)
        };
        let same =
            |[a, b]: [[f64; 2]; 2]| (0..2).all(|end| (a[end] - b[end]).abs() <= SAME * self.sigma().unwrap_or(0.0));
        let proven = self.proven_worst_case();
        let linear = ("linear worst case", interval(self.range.worst_case, None));
        // A linear worst case with the same printed ends needs no row of its own.
        let (worst, linear) = match &proven {
            Some(proven) if self.is_shown_as_linear(proven) => (("worst case", proven.texts.join(" .. ")), None),
            Some(proven) => (("proven worst case", proven.texts.join(" .. ")), Some(linear)),
            None => (linear, None),
        };
        // Proven bounds that may not be reached, shown if they differ from the linear worst case.
        let within = (self.range.bounds.as_ref().filter(|_| self.range.extremes.is_none() && proven.is_none()))
            .map(|bounds| bounds.bounds)
            .filter(|within| !self.range.worst_case.is_some_and(|linear| same([*within, linear])));
        let three_sigma = around(self.mean(), self.sigma().map(|sigma| 3.0 * sigma), end_error(3.0));
        let mut rows = vec![(FIRST_INTERVAL, three_sigma)];
        // A characteristic without slopes, as after a choice from stock, has none of these.
        if self.linear.rss.is_some() || self.range.worst_case.is_some() {
            rows.extend([
                ("RSS", around(self.linear.middle, self.linear.rss, None)),
                ("inflated RSS", around(self.linear.middle, self.linear.inflated_rss, None)),
                ("mean-shift RSS", around(self.linear.middle, self.linear.mean_shift_rss, None)),
            ]);
        }
        if self.range.worst_case.is_some() || proven.is_some() {
            rows.push(worst);
        }
        rows.extend(within.map(|within| ("worst case within", outward(within, scale, None).join(" .. "))));
        let most = rows.len();
        rows.extend(linear);
        let table = DataTable::untitled(rows.into_iter().map(|(name, ends)| [Cell::text(name), Cell::text(ends)]));
        table.at_most([most, usize::MAX], String::new())
    }

    fn is_of_model(&self) -> bool {
        let sampled = self.contributions.indices.as_ref().is_some_and(|of| of.source != IndexSource::Surface);
        sampled && self.sensitivities.iter().all(|row| row.linear_share.is_none())
    }

    fn has_totals(&self) -> bool {
        // A linear method has contributions of its own, which indices of the model do not complete.
        if self.contributions.indices.as_ref().is_some_and(|of| of.source != IndexSource::Surface)
            && !self.is_of_model()
        {
            return false;
        }
        let more = |row: &Sensitivity| Some(total(row)? - part(row)?);
        self.sensitivities.iter().filter_map(more).any(|more| more >= TOTAL)
    }

    fn contributors(&self, dimensions: &[DimensionReport]) -> DataTable {
        let all = elements(self, dimensions);
        let view = ranked(&all);
        let rest = &view[view.len().min(CONTRIBUTORS)..];
        let together: f64 = rest.iter().filter_map(|&index| all[index].part()).sum();
        let rest = format!("and {} more with {} % together; -v shows all", rest.len(), percent(together));
        let shown = |value: Option<f64>, text: fn(f64) -> String| Cell::number(value, text);
        let unknown = || Cell::text(UNKNOWN.to_owned());
        // A choice among parts leaves no slopes. Empty columns would push the last one into a second block.
        let has_slopes = all.iter().filter_map(Contributor::alone).any(|(row, _)| row.first.is_some());
        // A tolerance belongs to the nominal value: beside the mean of an unequal one it would be misread. A mean that lies elsewhere than in
        // the middle of its band, such as a measured one, is not left out.
        let alone = || all.iter().filter_map(Contributor::alone).map(|row| row.1);
        let is_nominal = alone().any(DimensionReport::is_unequal) && alone().all(DimensionReport::is_centred);
        let place = move |of: &DimensionReport| match is_nominal && of.tolerance.is_some() {
            true => Cell::number(of.nominal, plain),
            false => Cell::number(of.mean, |mean| own_mean(of, mean)),
        };
        Columns::default()
            .named("", "contributor", |one: &&Contributor<'_>| Cell::name(one.name))
            .shown(if is_nominal { "nominal" } else { "mean" }, move |one| {
                one.alone().map_or_else(unknown, |row| place(row.1))
            })
            .shown("tolerance", |one| {
                let Some((_, dimension)) = one.alone() else { return Cell::text(UNKNOWN.to_owned()) };
                let unit = dimension.unit.as_deref().map_or(String::new(), |unit| format!(" {unit}"));
                Cell::text(format!("{}{unit}", dimension.tolerance()))
            })
            .shown("sigma", move |one| shown(one.alone().map(|row| row.1.sigma), |sigma| significant(sigma, 3)))
            .shown_if(has_slopes, "sensitivity", |one| {
                let Some((row, _)) = one.alone() else { return Cell::text(UNKNOWN.to_owned()) };
                let rounding = row.rounding.map(|rounding| rounding[0]);
                Cell::both(Value::Number(row.first), derivative(row.first, rounding, 4))
            })
            .shown_if(has_slopes, "effect", move |one| {
                shown(one.alone().and_then(effect), |effect| significant(effect, 3))
            })
            .shown("contrib. %", move |one| shown(one.part(), percent))
            // One more column exceeds 80 columns; the details have it.
            .shown_if(self.is_of_model() && self.has_totals(), "total %", move |one| shown(one.total(), percent))
            .table("", all.iter())
            .seen(view)
            .at_most([CONTRIBUTORS, 0], rest)
    }
}

/// True for the tables of figures and intervals, which pages show in another form.
pub(crate) fn is_of_statistics(table: &DataTable) -> bool {
    let first = table.rows.first().and_then(|row| row.first()).map(|cell| cell.line.text());
    let untitled = table.name.is_empty() && table.columns.iter().all(|column| column.heading.is_empty());
    untitled && first.is_some_and(|name| name == FIRST_FIGURE || name == FIRST_INTERVAL)
}

type Row<'r> = (&'r Sensitivity, &'r DimensionReport);

/// Dimension, or geometric element with those of its parts that have an effect here.
struct Contributor<'r> {
    name: &'r str,
    parts: Vec<Row<'r>>,
}

impl<'r> Contributor<'r> {
    /// Returns the single part, or None if there are several.
    fn alone(&self) -> Option<&Row<'r>> {
        if let [row] = &self.parts[..] { Some(row) } else { None }
    }

    /// Share of the variance. None if a part has an unknown share.
    fn part(&self) -> Option<f64> {
        self.parts.iter().map(|row| part(row.0)).sum()
    }

    /// Share with every interaction. None for an element of several parts, whose interactions would count twice.
    fn total(&self) -> Option<f64> {
        self.alone().and_then(|row| total(row.0))
    }

    /// Sort key of the rows.
    fn size(&self) -> f64 {
        self.alone().map_or_else(|| self.part().unwrap_or(-1.0), |row| size(row.0))
    }
}

/// Dimensions and geometric elements that matter, in the order of the study.
fn elements<'r>(one: &'r CharacteristicAnalysis, dimensions: &'r [DimensionReport]) -> Vec<Contributor<'r>> {
    let mut all: Vec<Contributor<'_>> = Vec::new();
    let mut places: HashMap<&str, usize> = HashMap::new();
    for row in one.sensitivities.iter().zip(dimensions).filter(|(row, of)| matters(row, of)) {
        let name = element(&row.0.dimension);
        match places.entry(name) {
            Entry::Occupied(place) => all[*place.get()].parts.push(row),
            Entry::Vacant(place) => {
                place.insert(all.len());
                all.push(Contributor { name, parts: vec![row] });
            }
        }
    }
    // Parts of an element without effect here are dropped if another part has one.
    for one in &mut all {
        if one.parts.iter().any(does) {
            one.parts.retain(does);
        }
    }
    all
}

/// Indices of the contributors with an effect, strongest first.
fn ranked(all: &[Contributor<'_>]) -> Vec<usize> {
    let mut view: Vec<usize> = (0..all.len()).filter(|&index| all[index].parts.iter().any(does)).collect();
    view.sort_by(|&a, &b| all[b].size().total_cmp(&all[a].size()));
    view
}

/// Names of the contributors with a known share of the variance, strongest first, and their shares in percent.
pub(crate) fn strongest<'r>(one: &'r CharacteristicAnalysis, dimensions: &'r [DimensionReport]) -> Vec<(&'r str, f64)> {
    let all = elements(one, dimensions);
    let known = ranked(&all).into_iter().filter_map(|index| Some((all[index].name, 100.0 * all[index].part()?)));
    known.filter(|(_, percent)| *percent >= 0.5).collect()
}

/// True if a dimension has an effect here. If the surface is not trusted, its effect may consist of interactions alone.
fn does(row: &Row<'_>) -> bool {
    let of_model = total(row.0).filter(|_| row.0.linear_share.is_none());
    part(row.0) != Some(0.0) || effect(row) != Some(0.0) || of_model.is_some_and(|total| total > 0.0)
}

/// Greatest shift of the characteristic if this dimension alone goes to an end of its band, by slope and curvature.
fn effect((row, dimension): &(&Sensitivity, &DimensionReport)) -> Option<f64> {
    let ends = match dimension.tolerance {
        Some(ends) => ends.map(|end| dimension.nominal + end - dimension.mean),
        None => [-BAND * dimension.sigma, BAND * dimension.sigma],
    };
    let (first, second) = (row.first?, row.second.unwrap_or(0.0));
    Some(ends.map(|t| (t * (first + 0.5 * second * t)).abs()).into_iter().fold(0.0, f64::max))
}

/// True if a dimension varies, or has an effect without varying.
pub(crate) fn matters(row: &Sensitivity, dimension: &DimensionReport) -> bool {
    dimension.sigma > 0.0 || row.first.is_some_and(|first| first != 0.0)
}

/// Share of the variance of a dimension alone, by slope and curvature, or by the model if the surface is not trusted. Returns None if
/// neither is known.
pub(crate) fn part(row: &Sensitivity) -> Option<f64> {
    let of_surface = row.linear_share.map(|linear| linear + row.curvature_share.unwrap_or(0.0));
    // A negative estimate is 0 within its error. A negative covariance is real, and stays.
    of_surface.or(row.first_order.map(|index| index.value.max(0.0)))
}

/// Share of the variance with every interaction of the dimension.
pub(crate) fn total(row: &Sensitivity) -> Option<f64> {
    row.total.map(|index| index.value)
}

/// Sort key of a row: by the model with interactions, because they may be the whole effect of a dimension.
pub(crate) fn size(row: &Sensitivity) -> f64 {
    let of_model = total(row).filter(|_| row.linear_share.is_none());
    of_model.or(part(row)).unwrap_or(-1.0)
}

/// Formats the mean of a dimension: as the study has it, or beside its sigma if it was computed.
fn own_mean(dimension: &DimensionReport, mean: f64) -> String {
    let written = plain(mean);
    let computed = mean != dimension.nominal && dimension.sigma > 0.0;
    let rounded = if computed { beside(mean, dimension.sigma) } else { written.clone() };
    if rounded.len() < written.len() { rounded } else { written }
}

/// Formats a derivative with `digits` digits, or as 0 if it lies within its rounding error.
pub(crate) fn derivative(value: Option<f64>, rounding: Option<f64>, digits: usize) -> String {
    match (value, rounding) {
        (None, _) => UNKNOWN.to_owned(),
        (Some(value), Some(rounding)) if value.abs() <= ROUNDINGS * rounding => "0".to_owned(),
        (Some(value), _) => significant(value, digits),
    }
}
