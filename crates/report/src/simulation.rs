//! The report of a simulation: the same names as in an analysis, each number with its standard error.

use serde::Serialize;

use crate::document::number::{
    estimated, estimated_beside, index, known, limits, percent, plain, significant, uncertainty, yielded,
};
use crate::document::rejects::Rejects;
use crate::document::{Blocks, Cell, Chart, Columns, DataTable, Document, Element, Line, Section, SpreadChart};
use crate::figures::{Figures, Named, QUANTILES};
use crate::head;
use crate::head::{findings, seed};
use crate::inspection::inspected;
use crate::output_correlation::{all_limits_within, conditional, together};
use crate::overview as glance;
use crate::overview::OverviewLine;
use crate::requirement::{judged, lines};
use crate::sampling::{index_names, sampled};
use crate::{About, DimensionReport, Head, WarningReport, correlation};
use sensitol::analysis::{EstimatedShare, InspectionRisks};
use sensitol::problem::Problem;
use sensitol::simulation::{IndexEstimate, SampledFactor, SimulatedCharacteristic, Simulation, YieldEstimate};
use sensitol_numeric::capability::Law;
use sensitol_numeric::correlation::Pair;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::pearson::Pearson;
use sensitol_numeric::sampling::Estimate;

/// The report of a simulation, as `--json` prints it. Unknown values are null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SimulationReport {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// `monte-carlo` or `quasi-monte-carlo`.
    pub(crate) method: &'static str,
    /// The results.
    #[serde(flatten, serialize_with = "Simulation::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "Simulation"))]
    pub(crate) simulation: Simulation,
    /// The dimensions, in the study's order.
    pub(crate) dimensions: Vec<DimensionReport>,
    /// The dimensions that vary together.
    pub(crate) correlation: Vec<Pair>,
    /// Warnings about assumptions that fail.
    pub warnings: Vec<WarningReport>,
}

impl SimulationReport {
    /// Builds the report of a simulation.
    pub fn of(problem: &Problem, simulation: &Simulation, about: About) -> Self {
        Self {
            head: Head::of("simulate", &about),
            method: simulation.sampler.method(),
            simulation: simulation.clone(),
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            warnings: about.warnings.iter().chain(&simulation.warnings).map(WarningReport::of).collect(),
        }
    }
}

/// Greatest number of inputs whose Sobol' indices a terminal shows.
const FACTORS: usize = 8;
/// Smallest number of intervals of a histogram that is drawn.
const INTERVALS: usize = 5;

impl SimulationReport {
    /// Builds the document: every number with its standard error (table `estimates`), and the histogram (table `histogram`).
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        let Simulation { sampler, run, samples, characteristics, .. } = &self.simulation;
        let (seed, rest) = (seed(run), head::beside(run));
        document.line(format!("{}: {samples} points{seed}{rest}; ± is one standard error", sampler.method()));
        document.gap();
        document.table(glance::table(characteristics.iter().map(OverviewLine::sampled)));
        if let Some(joint) = &self.simulation.joint {
            document.note(all_limits_within(joint, self.simulation.joint_requirement.as_ref()));
        }
        if let Some(line) = together(&self.simulation.correlations) {
            document.wrapped(2, line);
        }
        document.sections = characteristics.iter().map(|one| one.section(&self.warnings)).collect();
        document
    }
}

/// Estimate: its name, its value with its standard error, its interval.
type Row = (&'static str, Option<Estimate>, Option<[f64; 2]>);

pub(crate) trait SimulationSection {
    fn section(&self, warnings: &[WarningReport]) -> Section;

    fn kept(&self, section: &mut Section, yield_: YieldEstimate);

    /// Table of moments and quantiles, one a row.
    fn brief_estimates(&self) -> DataTable;

    fn estimates(&self) -> DataTable;

    /// Adds Sobol' indices with their 95 % intervals (table `sobol`), the strongest first.
    fn sobol(&self, section: &mut Section);

    fn histogram_table(&self) -> DataTable;

    /// Adds the histogram with the Pearson curve of the sample's moments.
    fn picture(&self, section: &mut Vec<Element>);

    /// Returns the Pearson distribution with the sample's moments.
    fn own_law(&self) -> Option<Pearson>;
}

impl SimulationSection for SimulatedCharacteristic {
    fn section(&self, warnings: &[WarningReport]) -> Section {
        let mut section = Section::of(self.name(), self.unit());
        if self.limited() {
            section.words = format!(", limits {}", limits(self.lower(), self.upper()));
        }
        section.blocks = findings(warnings, |name| name == Some(self.name()));
        if self.samples == 0 {
            section.detail(vec![Element::Table(self.estimates()), Element::Table(self.histogram_table())]);
            section.note("no point has a value");
            return section;
        }
        if let Some(yield_) = self.yield_ {
            self.kept(&mut section, yield_);
        }
        lines(self.requirements()).for_each(|line| section.note(line));
        if let Some(of) = &self.inspection {
            inspected(&mut section, of);
        }
        self.sobol(&mut section);
        section.gap();
        section.detail(vec![Element::Table(self.estimates())]);
        section.brief(vec![Element::Table(self.brief_estimates())]);
        section.table(self.histogram_table());
        if let Some(control) = &self.control {
            let times = |value: Option<f64>, name: &str| value.map(|value| format!("{name} {}", significant(value, 3)));
            let shrunk = [times(control.reduction.mean, "mean"), times(control.reduction.sigma, "sigma")];
            let shrunk: Vec<String> = shrunk.into_iter().flatten().collect();
            let shrunk = match shrunk.is_empty() {
                true => String::new(),
                false => format!(": standard errors shrunk by {}", shrunk.join(", ")),
            };
            let (method, evaluations) = (control.method, control.evaluations);
            section.note(format!("control: {method} surrogate, {evaluations} evaluations{shrunk}"));
        }
        let sigma = self.sigma.map_or(0.0, |of| of.value);
        self.sampling.iter().for_each(|of| sampled(&mut section, of, sigma, self.limited()));
        let mut picture = Vec::new();
        self.picture(&mut picture);
        match self.indices {
            None => section.blocks.extend(picture),
            // Sobol' indices take the space of the picture, which becomes a detail.
            Some(_) => section.detail(picture),
        }
        section
    }

    fn kept(&self, section: &mut Section, yield_: YieldEstimate) {
        let [low, high] = self.yield_interval().unwrap_or(yield_.interval).map(yielded);
        let target = judged(self.target(), self.verdict());
        let rejects = Rejects::new(self.below, self.above, self.yield_error()).within(self.reject_intervals);
        let text = rejects.yield_text().unwrap_or_else(|| yielded(yield_.value));
        let of_all = Line::from(format!("yield {text}, 95 % interval {low} to {high}"));
        let conditional =
            conditional(&self.characteristic, self.conditional.as_ref(), "no assembly of the sample keeps it");
        // The target is that of the assemblies that count.
        section.note(if conditional.is_some() { of_all } else { of_all.and(target.clone()) });
        conditional.into_iter().for_each(|line| section.note(Line::from(line).and(target.clone())));
        if let Some([low, high]) = self.yield_bounds() {
            let (points, [low, high]) = (self.failed, [low, high].map(yielded));
            section
                .note(format!("{points} points have no value: {low} if all of these are rejected, {high} if none is"));
        }
        let named = |value: Option<f64>, name: &str| value.map(|value| format!("{name} {}", index(value)));
        let sides = Some(rejects.sides()).filter(|sides| !sides.is_empty());
        let [cp, cpk] = index_names(self.sampling.is_some());
        let figures = [sides, named(self.cp, cp), named(self.cpk, cpk)];
        section.note(figures.into_iter().flatten().collect::<Vec<_>>().join("  "));
        section.remark(format!(
            "Limits {}; values seen from {} to {}.",
            limits(self.lower(), self.upper()),
            known(self.range.map(|[least, _]| least), plain),
            known(self.range.map(|[_, greatest]| greatest), plain),
        ));
    }

    fn brief_estimates(&self) -> DataTable {
        let own = |of: Option<Estimate>| of.and_then(|of| of.standard_error);
        let [mean, sigma] = self.errors();
        let moments = [
            ("mean", self.mean, mean),
            ("sigma", self.sigma, sigma),
            ("skewness", self.skewness, own(self.skewness)),
            ("kurtosis", self.kurtosis, own(self.kurtosis)),
        ];
        let names = ["0.135 %", "1 %", "5 %", "median", "95 %", "99 %", "99.865 %"];
        let quantiles = names.into_iter().zip(self.quantiles).map(|(name, of)| (name, of, own(of)));
        let scale = self.sigma.map(|of| of.value);
        let cells = |(name, of, digits): (&'static str, Option<Estimate>, Option<f64>)| {
            let error = own(of);
            // Skewness and kurtosis have no unit, so sigma does not set their digits.
            let scale = scale.filter(|_| !["skewness", "kurtosis"].contains(&name));
            let value = Cell::number(of.map(|of| of.value), |value| estimated_beside(value, scale, digits));
            let error = error.map_or(String::new(), |error| format!("± {}", uncertainty(error)));
            [Cell::text(name), value, Cell::text(error)]
        };
        DataTable::untitled(moments.into_iter().chain(quantiles).map(cells))
    }

    fn estimates(&self) -> DataTable {
        let moments: [Row; 4] = [
            ("mean", self.mean, None),
            ("sigma", self.sigma, None),
            ("skewness", self.skewness, None),
            ("kurtosis", self.kurtosis, None),
        ];
        let quantiles = QUANTILES.into_iter().zip(self.quantiles).map(|(name, estimate)| (name, estimate, None));
        let seen = if self.samples == 0 { 0 } else { moments.len() + QUANTILES.len() };
        let plain = |value: Option<f64>| value.map(|value| Estimate { value, standard_error: None });
        let millionths = |interval: Option<[f64; 2]>| interval.map(|ends| ends.map(|end| 1e6 * end));
        let risk = |name: &'static str, share: fn(&InspectionRisks) -> Option<EstimatedShare>| {
            let of = self.inspection.as_ref()?;
            Some((name, share(of).map(|of| Estimate { value: of.value, standard_error: of.error }), None))
        };
        let risks: [Option<Row>; 4] = [
            risk("false_accept", |of| of.false_accept),
            risk("false_reject", |of| of.false_reject),
            risk("accepted", |of| of.accepted),
            risk("bad_among_accepted", |of| of.bad_among_accepted),
        ];
        let rest: [Row; 3] = [
            ("yield", plain(self.yield_()), self.yield_interval()),
            ("ppm_below", plain(self.ppm_below()), millionths(self.reject_intervals[0])),
            ("ppm_above", plain(self.ppm_above()), millionths(self.reject_intervals[1])),
        ];
        let error = |row: &Row| row.1.and_then(|estimate| estimate.standard_error);
        let sigma = self.sigma.map(|of| of.value);
        let scale =
            move |row: &Row| sigma.filter(|_| ["mean", "sigma"].contains(&row.0) || row.0.starts_with("quantile"));
        Columns::default()
            .data("characteristic", |_| Cell::text(self.name()))
            .data("unit", |_| Cell::optional(self.unit()))
            .named("estimate", "", |row: &Row| Cell::text(row.0))
            .named("value", "value", move |row| {
                Cell::number(row.1.map(|estimate| estimate.value), |value| {
                    estimated_beside(value, scale(row), error(row))
                })
            })
            .column("standard_error", "standard error", move |row| Cell::number(error(row), uncertainty))
            .data("interval_low", |row| Cell::data(row.2.map(|[low, _]| low)))
            .data("interval_high", |row| Cell::data(row.2.map(|[_, high]| high)))
            .table("estimates", moments.into_iter().chain(quantiles).chain(rest).chain(risks.into_iter().flatten()))
            .seen((0..seen).collect())
    }

    fn sobol(&self, section: &mut Section) {
        let Some(of) = &self.indices else { return };
        let mut order: Vec<usize> = (0..of.len()).collect();
        order.sort_by(|&a, &b| of[b].total.value.total_cmp(&of[a].total.value));
        let value = |of: IndexEstimate| Cell::number(of.value, |value| estimated(value, Some(of.standard_error)));
        let interval = |of: IndexEstimate| {
            let [low, high] = of.interval.map(|end| estimated(end, Some(of.standard_error)));
            Cell::text(format!("{low} .. {high}"))
        };
        section.gap();
        section.table(
            Columns::default()
                .data("characteristic", |_| Cell::text(self.name()))
                .named("inputs", "input", |factor: &&SampledFactor| Cell::name(&factor.dimensions.join(", ")))
                .column("first_order", "first order", move |factor| value(factor.first_order))
                .shown("95 % interval", move |factor| interval(factor.first_order))
                .column("total", "total", move |factor| value(factor.total))
                .shown("95 % interval", move |factor| interval(factor.total))
                .data("first_order_error", |factor| Cell::data(factor.first_order.standard_error))
                .data("first_order_low", |factor| Cell::data(factor.first_order.interval[0]))
                .data("first_order_high", |factor| Cell::data(factor.first_order.interval[1]))
                .data("total_error", |factor| Cell::data(factor.total.standard_error))
                .data("total_low", |factor| Cell::data(factor.total.interval[0]))
                .data("total_high", |factor| Cell::data(factor.total.interval[1]))
                .table("sobol", of)
                .seen(order)
                .at_most(
                    [FACTORS, usize::MAX],
                    format!("and {} weaker; -v shows all", of.len().saturating_sub(FACTORS)),
                ),
        );
        let rest = 1.0 - of.iter().map(|factor| factor.first_order.value).sum::<f64>();
        // A negative estimate is 0 within its error.
        section.note(format!("Sobol' indices, parts of the variance: interactions have {} %", percent(rest.max(0.0))));
    }

    fn histogram_table(&self) -> DataTable {
        let rows = self.histogram.iter().flat_map(|of| of.edges.windows(2).zip(&of.counts));
        Columns::default()
            .data("characteristic", |_| Cell::text(self.name()))
            .data("from", |row: &(&[f64], &u64)| Cell::data(row.0[0]))
            .data("to", |row| Cell::data(row.0[1]))
            .data("count", |row| Cell::count(*row.1))
            .table("histogram", rows)
    }

    fn picture(&self, section: &mut Vec<Element>) {
        let Some(of) = self.histogram.as_ref().filter(|of| of.counts.len() >= INTERVALS) else { return };
        let law = self.own_law();
        let law_name = law.as_ref().map_or(String::new(), |law| match law.kind().name() {
            "normal" => "normal fit of the four moments".to_owned(),
            kind => format!("Pearson fit of the four moments, type {kind}"),
        });
        section.gap();
        section.chart(Chart::Spread(Box::new(SpreadChart {
            bins: Some(of.clone()),
            curve: None,
            law,
            sampled: true,
            limits: Named::limits(self),
            rejects: [None, None],
            ranges: Vec::new(),
            nominal: None,
            places: self.mean().map(|mean| (mean, "mean", "mean")).into_iter().collect(),
            sigma: self.sigma().unwrap_or(0.0),
            label: format!("Histogram of {} with the standard error of every bar", self.name()),
            curve_name: String::new(),
            law_name,
        })));
    }

    fn own_law(&self) -> Option<Pearson> {
        let moments = Moments::new(self.mean()?, self.sigma()?, self.skewness()?, self.kurtosis()? - 3.0);
        match Law::fit(&moments).ok()? {
            Law::Pearson(law) => Some(*law),
            Law::Point { .. } => None,
        }
    }
}
