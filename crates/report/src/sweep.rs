//! The report of a sweep.

use crate::analysis::analysis_document::CharacteristicSections;
use std::collections::BTreeMap;

use serde::Serialize;

use crate::analysis::yield_source::least_yield;
use crate::document::number::{
    UNKNOWN, beside, carried, carried_ends, known, limits, plain, plural, shape, short, significant,
};
use crate::document::rejects::Rejects;
use crate::document::{
    Blocks, Cell, Chart, Columns, DataTable, Document, Element, Layer, Paragraph, Plot, PlotAxis, PlotScale, Section,
    Stroke, Value,
};
use crate::figures::{Figures, QUANTILES};
use crate::head;
use crate::head::findings;
use crate::overview::{NO_LIMITS, verdict, verdict_cell};
use crate::{About, Head, WarningReport};
use sensitol::analysis::{CharacteristicAnalysis, YieldSource};
use sensitol::method::ErrorEstimate;
use sensitol::problem::Problem;
use sensitol::summary::RunSummary;
use sensitol::sweep::Sweep;
use sensitol_numeric::capability::Quantiles;
use sensitol_numeric::json_form::{RejectIntervals, through};
use sensitol_numeric::verdict::{Judged, Verdict};

/// The report of a sweep, as `--json` prints it. Unknown values are null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweepReport {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// The swept parameter.
    pub(crate) parameter: ParameterReport,
    /// The method that was run; null where nothing was done.
    pub(crate) method: Option<&'static str>,
    /// Points, time, and the reason of an early end.
    #[serde(flatten)]
    pub(crate) run: RunSummary,
    /// The results of every characteristic requested.
    pub characteristics: Vec<SweptReport>,
    /// Warnings, each once, with the values of the parameter at which an assumption fails.
    pub warnings: Vec<WarningReport>,
}

/// The parameter.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct ParameterReport {
    /// Name of the parameter.
    pub(crate) name: String,
    /// Unit of the parameter.
    pub(crate) unit: Option<String>,
    /// Standard deviation of the parameter, the same at every value.
    pub(crate) sigma: f64,
    /// Values of the parameter.
    pub(crate) values: Vec<f64>,
}

/// One characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweptReport {
    /// Name of the characteristic.
    pub(crate) name: String,
    /// Unit of the characteristic.
    pub(crate) unit: Option<String>,
    /// Lower limit.
    pub(crate) lower: Option<f64>,
    /// Upper limit.
    pub(crate) upper: Option<f64>,
    /// Points in the order of the parameter's values.
    pub points: Vec<SweptPointReport>,
}

/// One characteristic at one value of the characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SweptPointReport {
    /// The parameter.
    pub(crate) at: f64,
    /// Value with every dimension at its nominal value.
    pub(crate) nominal: Option<f64>,
    /// First moment.
    pub mean: Option<f64>,
    /// Standard deviation.
    pub(crate) sigma: Option<f64>,
    /// Third standardised moment.
    pub(crate) skewness: Option<f64>,
    /// Fourth standardised moment.
    pub(crate) kurtosis: Option<f64>,
    /// Estimated errors of the figures; null without moments.
    pub(crate) error_estimate: Option<ErrorEstimate>,
    /// Root of the sum of squares.
    pub(crate) rss: Option<f64>,
    /// Quantiles; null at a probability that their source does not resolve.
    pub(crate) quantiles: Quantiles<Option<f64>>,
    /// Errors of the quantiles; null if unknown.
    pub(crate) quantile_errors: Quantiles<Option<f64>>,
    /// Source of the quantiles; null if there are none.
    pub(crate) quantile_source: Option<YieldSource>,
    /// Share of assemblies within the limits.
    #[serde(rename = "yield")]
    pub(crate) yield_: Option<f64>,
    /// Interval of the yield, with the uncertainty of measured samples; null if unknown.
    pub(crate) yield_interval: Option<[f64; 2]>,
    /// Source of the yield; null without limits.
    pub(crate) yield_source: Option<YieldSource>,
    /// Rejected below the lower limit, in parts per million.
    pub(crate) ppm_below: Option<f64>,
    /// Rejected above the upper limit.
    pub(crate) ppm_above: Option<f64>,
    /// The intervals of both.
    #[serde(flatten, serialize_with = "through::<RejectIntervals, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "RejectIntervals"))]
    pub(crate) reject_intervals: [Option<[f64; 2]>; 2],
    /// True if the target yield is met; null if that is unknown, and without a target.
    pub(crate) met: Option<bool>,
    /// The same in a word.
    pub(crate) verdict: Option<Verdict>,
    /// Everything that is required of it, the target yield included.
    pub(crate) requirements: Vec<Judged>,
    /// The rejects with their error, for readers.
    #[serde(skip)]
    rejects: Rejects,
    /// Least yield over all distributions of dimensions of which only the band is known, with its text.
    #[serde(skip)]
    least: Option<(f64, String)>,
}

impl SweepReport {
    /// Builds the report of a sweep of this problem.
    pub fn of(problem: &Problem, sweep: &Sweep, about: About) -> Self {
        let dimension = &problem.dimensions()[sweep.dimension];
        let characteristics = problem.characteristics().iter().enumerate().map(|(c, one)| SweptReport {
            name: one.name().to_owned(),
            unit: one.unit().map(str::to_owned),
            lower: one.limits().lower(),
            upper: one.limits().upper(),
            points: (sweep.values.iter().zip(&sweep.analyses))
                .map(|(&at, analysis)| SweptPointReport::of(at, analysis.as_ref().map(|all| &all.characteristics[c])))
                .collect(),
        });
        Self {
            head: Head::of("sweep", &about),
            parameter: ParameterReport {
                name: dimension.name().to_owned(),
                unit: dimension.unit().map(str::to_owned),
                sigma: dimension.sigma(),
                values: sweep.values.clone(),
            },
            method: sweep.analyses.iter().flatten().next().map(|analysis| analysis.method.name()),
            run: sweep.run,
            characteristics: characteristics.collect(),
            warnings: warnings(sweep, dimension.name(), &about),
        }
    }
}

impl SweepReport {
    /// Builds the document: for every characteristic a chart, and a table (`sweep`) with a row for every value of the parameter.
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        document.line(format!(
            "{}: {} in {} for {} of {}{}",
            self.method.unwrap_or("nothing was done"),
            plural(self.run.evaluations as usize, "evaluation", "evaluations"),
            plural(self.run.stages as usize, "batch", "batches"),
            plural(self.parameter.values.len(), "value", "values"),
            short(&self.parameter.name),
            head::beside(&self.run),
        ));
        document.gap();
        document.table(self.glance());
        document.sections = self.characteristics.iter().map(|one| self.section(one)).collect();
        document
    }

    /// Table with one line for every characteristic: the range of its mean, and its worst value.
    fn glance(&self) -> DataTable {
        let all = &self.characteristics;
        let limited = all.iter().any(|one| one.points.iter().any(|point| point.least_yield().is_some()));
        let judged = all.iter().any(|one| one.points.iter().any(|point| !point.requirements.is_empty()));
        let greatest = |one: &SweptReport| one.points.iter().filter_map(|point| point.sigma).reduce(f64::max);
        let means = move |one: &&SweptReport| {
            let ends = one.points.iter().filter_map(|point| point.mean).map(|mean| [mean, mean]);
            let ends = ends.reduce(|[low, high], [mean, _]| [low.min(mean), high.max(mean)]);
            let sigma = greatest(one).unwrap_or(0.0);
            Cell::text(ends.map_or(UNKNOWN.to_owned(), |ends| carried_ends(ends, sigma, None).join(" .. ")))
        };
        let worst = |one: &SweptReport| one.worst().map(|place| one.points[place].clone());
        Columns::default()
            .terminal(true, "", |one: &&SweptReport| Cell::name(&one.name))
            .terminal(true, "mean", means)
            .terminal(true, "sigma up to", move |one| Cell::number(greatest(one), |sigma| significant(sigma, 5)))
            .terminal(true, "", |one| Cell::optional(one.unit.as_deref()))
            .terminal(limited, "least yield", move |one| match one.lower.or(one.upper) {
                Some(_) => Cell::text(worst(one).map_or_else(String::new, |point| point.yield_words())),
                None => Cell::text(NO_LIMITS),
            })
            .terminal(limited, "at", move |one| {
                worst(one).map_or_else(Cell::empty, |point| Cell::number(point.at, plain))
            })
            .terminal(judged, "verdict", |one| {
                let judged: Vec<Judged> = one.points.iter().flat_map(|point| point.requirements.clone()).collect();
                verdict_cell(verdict(&judged), one.lower.or(one.upper).is_some())
            })
            .table("", all)
    }

    fn section(&self, one: &SweptReport) -> Section {
        let of = &self.parameter;
        let mut section = Section::of(&one.name, one.unit.as_deref());
        section.words = format!(" over {}", with_unit(&short(&of.name), of.unit.as_deref()));
        if one.lower.or(one.upper).is_some() {
            section.remark(format!("Limits {}.", limits(one.lower, one.upper)));
        }
        section.blocks.extend(findings(&self.warnings, |name| name == Some(&one.name)));
        section.chart(Chart::Plot(one.plot(with_unit(&of.name, of.unit.as_deref()))));
        section.detail(vec![Element::Table(one.table(&of.name))]);
        section.brief(one.brief(&of.name));
        if let Some(source) = one.source() {
            section.note(source);
        }
        section
    }
}

fn with_unit(name: &str, unit: Option<&str>) -> String {
    unit.map_or(name.to_owned(), |unit| format!("{name} [{unit}]"))
}

/// Greatest number of values of the parameter on a terminal.
const ROWS: usize = 19;

impl SweptReport {
    /// Index of the value with the least yield. None if there are no limits.
    fn worst(&self) -> Option<usize> {
        let known = self.points.iter().enumerate().filter_map(|(place, point)| Some((place, point.least_yield()?)));
        known.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
    }

    /// Table for a terminal: mean, sigma and band at evenly spaced values, and at the worst one.
    fn brief(&self, parameter: &str) -> Vec<Element> {
        let table = self.table(parameter).without(&["nominal", "50 %"]);
        let count = table.rows.len();
        if count <= ROWS {
            return vec![Element::Table(table)];
        }
        let even = (0..count).step_by((count - 1).div_ceil(ROWS - 1));
        let mut view: Vec<usize> = even.chain([count - 1]).chain(self.worst()).collect();
        view.sort_unstable();
        view.dedup();
        let rest = Paragraph::note(format!("{} of {count} values; -v shows all", view.len()));
        vec![Element::Table(table.seen(view)), Element::Paragraph(rest)]
    }

    fn table(&self, parameter: &str) -> DataTable {
        let rounded = |value: Option<f64>, point: &SweptPointReport| {
            Cell::number(value, |value| match point.sigma.filter(|sigma| *sigma > 0.0) {
                Some(sigma) => beside(value, sigma),
                None => significant(value, 6),
            })
        };
        let yielded = |point: &&SweptPointReport| {
            let text = known(point.least_yield(), |_| point.yield_words());
            Cell::both(Value::Number(point.yield_), text.trim_end_matches(" %"))
        };
        let mut columns = Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .data("unit", |_| Cell::optional(self.unit.as_deref()))
            .data("parameter", |_| Cell::text(parameter))
            .named("at", "at", |point: &&SweptPointReport| Cell::number(point.at, plain))
            .column("nominal", "nominal", |point| rounded(point.nominal, point))
            .column("mean", "mean", |point| rounded(point.mean, point))
            .column("sigma", "sigma", |point| Cell::number(point.sigma, |sigma| significant(sigma, 5)))
            .wide("skewness", "skewness", |point| Cell::number(point.skewness, shape))
            .wide("kurtosis", "kurtosis", |point| Cell::number(point.kurtosis, shape))
            .wide("rss", "rss", |point| rounded(point.rss, point));
        for (index, key) in QUANTILES.into_iter().enumerate() {
            let quantile = move |point: &&SweptPointReport| {
                let error = point.quantile_errors.0[index];
                Cell::number(point.quantiles.0[index], |value| match point.sigma.filter(|sigma| *sigma > 0.0) {
                    Some(sigma) => carried(value, sigma, error),
                    None => significant(value, 6),
                })
            };
            columns = match index {
                0 => columns.column(key, "0.135 %", quantile),
                3 => columns.column(key, "50 %", quantile),
                6 => columns.column(key, "99.865 %", quantile),
                _ => columns.data(key, quantile),
            };
        }
        let columns = match self.lower.or(self.upper) {
            Some(_) => columns.column("yield", "yield %", yielded),
            None => columns.data("yield", yielded),
        };
        columns.table("sweep", &self.points)
    }

    /// Sentence with the sources of the yields, or None if there are no yields.
    fn source(&self) -> Option<String> {
        let mut sources: Vec<&str> = self.points.iter().filter_map(|point| Some(point.yield_source?.words())).collect();
        sources.sort_unstable();
        sources.dedup();
        (!sources.is_empty()).then(|| format!("yields by {}", sources.join(", or by ")))
    }

    /// Plot of mean, nominal value and band of all but 0.27 % over the parameter.
    fn plot(&self, parameter: String) -> Plot {
        let over = |value: fn(&SweptPointReport) -> Option<f64>| {
            self.points.iter().map(|point| (point.at, value(point))).collect::<Vec<_>>()
        };
        let mut layers = vec![
            Layer::Band(self.points.iter().map(|point| (point.at, point.band())).collect()),
            Layer::Curve(over(|point| point.nominal), Stroke::Dotted),
            Layer::Curve(over(|point| point.mean), Stroke::Strong),
        ];
        layers.extend(self.lower.map(|limit| Layer::Mark(limit, "lower limit")));
        layers.extend(self.upper.map(|limit| Layer::Mark(limit, "upper limit")));
        let named = |point: &SweptPointReport| Some((point.band()?, point.mean?));
        if let Some(([low, high], mean)) = self.points.iter().rev().find_map(named) {
            let ends = [(mean, "mean"), (high, "99.865 %"), (low, "0.135 %")];
            layers.extend(ends.map(|(at, name)| Layer::End(at, name)));
        }
        Plot {
            name: self.name.clone(),
            x: PlotAxis::new(parameter, PlotScale::Linear(0.0)),
            y: PlotAxis::new(with_unit(&self.name, self.unit.as_deref()), PlotScale::Linear(0.05)),
            layers,
            words: format!(
                "Line: the mean. Band: from the 0.135 % to the 99.865 % quantile, which holds all but 0.27 % of the assemblies. Dotted: the value of \
                 the nominal dimensions.{}",
                if self.lower.or(self.upper).is_some() { " Dashed: the limits." } else { "" }
            ),
        }
    }
}

/// Returns the warnings of the study, then those of the analyses. Analyses with the same kind of warning about the same subject share the
/// first one, with the number of values.
fn warnings(sweep: &Sweep, parameter: &str, about: &About) -> Vec<WarningReport> {
    let mut kinds: BTreeMap<(usize, &str), (WarningReport, Vec<f64>)> = BTreeMap::new();
    let mut order: Vec<(&'static str, Option<String>, Option<String>)> = Vec::new();
    for (&at, analysis) in sweep.values.iter().zip(&sweep.analyses) {
        for warning in analysis.iter().flat_map(|analysis| &analysis.warnings).map(WarningReport::of) {
            let kind = (warning.code, warning.characteristic.clone(), warning.dimension.clone());
            let place = order.iter().position(|known| *known == kind).unwrap_or_else(|| {
                order.push(kind);
                order.len() - 1
            });
            kinds.entry((place, warning.code)).or_insert_with(|| (warning, Vec::new())).1.push(at);
        }
    }
    let all = sweep.analyses.iter().flatten().count();
    let of_values = kinds.into_values().map(|(warning, at)| {
        let share = if at.len() == all { "every value".to_owned() } else { format!("{} of {all} values", at.len()) };
        let message = format!("At {share}, first at {parameter} = {}: {}", plain(at[0]), warning.message);
        WarningReport { message, at, ..warning }
    });
    about.warnings.iter().map(WarningReport::of).chain(of_values).collect()
}

impl SweptPointReport {
    fn of(at: f64, analysis: Option<&CharacteristicAnalysis>) -> Self {
        let of = |figure: fn(&CharacteristicAnalysis) -> Option<f64>| analysis.and_then(figure);
        let quantiles = analysis.and_then(|one| one.distribution.quantiles);
        let values = quantiles.map_or([None; 7], |of| of.values.0);
        Self {
            at,
            nominal: of(|one| one.nominal),
            mean: of(Figures::mean),
            sigma: of(Figures::sigma),
            skewness: of(Figures::skewness),
            kurtosis: of(Figures::kurtosis),
            error_estimate: analysis.and_then(|one| one.error_estimate.clone()),
            rss: of(|one| one.linear.rss),
            quantiles: Quantiles(values.map(|found| found.map(|of| of.value))),
            quantile_errors: Quantiles(values.map(|found| found.and_then(|of| of.error))),
            quantile_source: quantiles.map(|of| of.source),
            yield_: of(Figures::yield_),
            yield_interval: analysis.and_then(CharacteristicAnalysis::yield_interval),
            yield_source: analysis.and_then(|one| one.distribution.yield_source),
            ppm_below: of(Figures::ppm_below),
            ppm_above: of(Figures::ppm_above),
            reject_intervals: analysis.map_or([None; 2], |one| one.distribution.reject_intervals),
            met: analysis.and_then(CharacteristicAnalysis::met),
            verdict: analysis.and_then(CharacteristicAnalysis::verdict),
            requirements: analysis.map_or(Vec::new(), CharacteristicAnalysis::requirements),
            least: analysis.and_then(|one| one.distribution.distribution_free_yield.as_ref()).and_then(|of| {
                let [least, _] = of.interval?;
                Some((least, least_yield(of)?))
            }),
            rejects: analysis.map_or(Rejects::new(None, None, None), CharacteristicAnalysis::rejects),
        }
    }

    pub(super) fn rejects(&self) -> Rejects {
        self.rejects
    }

    /// Yield, or its least value over all distributions.
    fn least_yield(&self) -> Option<f64> {
        self.least.as_ref().map(|(least, _)| *least).or(self.yield_)
    }

    /// Yield in words. Empty if it is unknown.
    fn yield_words(&self) -> String {
        let least = self.least.as_ref().map(|(_, text)| text.clone());
        least.or_else(|| self.yield_.and_then(|_| self.rejects.yield_text())).unwrap_or_default()
    }

    /// Ends of the band that holds all but 0.27 %. None if they are unknown.
    pub(crate) fn band(&self) -> Option<[f64; 2]> {
        let all = self.quantiles.0;
        Some([all[0]?, all[6]?])
    }
}
