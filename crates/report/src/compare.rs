//! The report of a comparison: as data and as a document.

use serde::Serialize;

use crate::document::number::{beside, known, plural, significant, yielded};
use crate::document::{
    Blocks, Cell, Chart, Columns, DataTable, Document, Element, Layer, Plot, PlotAxis, PlotPoint, PlotScale, Section,
    Stroke, Tone, Value,
};
use crate::figures::{Figures as _, Named};
use crate::overview as glance;
use crate::overview::OverviewLine;
use crate::{About, Head, head};
use sensitol::compare::{Comparison, Errors, Figures, NotRun, RESOLVED, Ran};
use sensitol::simulation::SimulatedCharacteristic;
use sensitol::summary::RunSummary;
use sensitol_numeric::verdict::Verdict;

/// The report of a comparison, as `--json` prints it. Unknown values are null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CompareReport {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// The points and time of all of it, the reference included, and why it ended early.
    #[serde(flatten)]
    pub(crate) run: RunSummary,
    /// Points of the reference.
    pub(crate) reference_samples: u64,
    /// Sampler that drew them.
    pub(crate) reference_method: &'static str,
    /// The results of every characteristic requested.
    pub(crate) characteristics: Vec<ComparedReport>,
    /// Methods that were not run, and why.
    pub(crate) not_run: Vec<NotRun>,
}

/// One characteristic.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct ComparedReport {
    /// Name of the characteristic.
    pub(crate) name: String,
    /// The reference for all methods.
    pub(crate) reference: SimulatedCharacteristic,
    /// The methods, fewest evaluations first.
    pub(crate) methods: Vec<MethodReport>,
}

/// One method on one characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(crate) struct MethodReport {
    /// Name of the method; that of samples has the number of points.
    pub(crate) method: String,
    /// Points that it takes.
    pub(crate) evaluations: u64,
    /// Evaluations that were known already.
    pub(crate) cached: u64,
    /// The cost of its run by itself.
    pub(crate) run: RunSummary,
    /// Seconds within the model.
    pub(crate) evaluation_s: f64,
    /// Seconds besides.
    pub(crate) engine_s: f64,
    /// Figures of the method.
    #[serde(flatten)]
    pub(crate) figures: Figures,
    /// Difference from the reference.
    pub(crate) error_vs_reference: Errors,
    /// True if no other method has a smaller error for as many evaluations or fewer.
    pub(crate) pareto: bool,
    /// Verdict on the target yield; null without a target.
    pub(crate) verdict: Option<Verdict>,
}

impl CompareReport {
    /// The report of a comparison.
    pub fn of(comparison: &Comparison, about: About) -> Self {
        let reference = &comparison.reference;
        let characteristics = reference.characteristics.iter().enumerate().map(|(c, one)| ComparedReport {
            name: one.characteristic.name().to_owned(),
            reference: one.clone(),
            methods: comparison.ran.iter().map(|ran| MethodReport::of(ran, c)).collect(),
        });
        Self {
            head: Head::of("compare", &about),
            run: comparison.run,
            reference_samples: reference.samples,
            reference_method: reference.sampler.method(),
            characteristics: characteristics.collect(),
            not_run: comparison.not_run.clone(),
        }
    }
}

impl MethodReport {
    fn of(ran: &Ran, c: usize) -> Self {
        Self {
            method: ran.contender.name(),
            evaluations: ran.evaluations,
            cached: ran.run.cached,
            run: ran.run,
            evaluation_s: ran.evaluation.as_secs_f64(),
            engine_s: ran.engine.as_secs_f64(),
            figures: ran.figures[c],
            error_vs_reference: ran.errors[c],
            pareto: ran.pareto[c],
            verdict: ran.verdicts[c],
        }
    }
}

impl CompareReport {
    /// The text of the comparison: for every characteristic a table (`comparison`), fewest evaluations first, and a chart of
    /// error over evaluations.
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        let (reference, samples, more) = (self.reference_method, self.reference_samples, head::beside(&self.run));
        // Methods share their requests to an external model. The total of points and batches shows the size that a cluster needs.
        let all = self.run.evaluator.map_or(String::new(), |_| format!("; all: {}", head::evaluations(&self.run)));
        document.line(format!("reference: {reference} with {samples} points{all}{more}"));
        document.gap();
        document.table(glance::table(self.characteristics.iter().map(|one| OverviewLine::sampled(&one.reference))));
        document.sections = self.characteristics.iter().map(ComparedReport::section).collect();
        if !self.not_run.is_empty() {
            let mut section = Section::default();
            for one in &self.not_run {
                let time = one.projected_s.map_or(String::new(), |time| format!(", {} s", significant(time, 2)));
                let cost = one.evaluations.map_or(String::new(), |count| {
                    format!(" ({}{time})", plural(count as usize, "evaluation", "evaluations"))
                });
                section.line(format!("not run: {}{cost}: {}", one.contender.name(), one.reason));
            }
            document.sections.push(section);
        }
        document
    }
}

impl ComparedReport {
    fn section(&self) -> Section {
        let mut section = Section::of(&self.name, self.reference.unit());
        section.words = ": errors against the reference; ● no other method beats it".to_owned();
        let of = &self.reference;
        section.remark(format!(
            "Reference: mean {}, sigma {}, skewness {}, kurtosis {}, yield {}.",
            known(of.mean(), |mean| beside(mean, of.sigma().unwrap_or(0.0))),
            known(of.sigma(), |sigma| significant(sigma, 6)),
            known(of.skewness(), |skewness| significant(skewness, 4)),
            known(of.kurtosis(), |kurtosis| significant(kurtosis, 5)),
            known(of.yield_(), yielded),
        ));
        section.chart(Chart::Plot(self.plot()));
        section.detail(vec![Element::Table(self.table())]);
        section.brief(vec![Element::Table(self.table().without(&["model s", "engine s"]))]);
        if self.methods.iter().any(|method| !method.error_vs_reference.resolved) {
            section.note("<: below two standard errors of the reference");
        }
        section
    }

    fn table(&self) -> DataTable {
        let error = |off: Option<f64>, own: Option<f64>, factor: f64| {
            // Errors below two standard errors of the reference are printed as `<` and these two errors.
            let own = own.map(|own| RESOLVED * own);
            Cell::number(off, |off| match own {
                Some(own) if off <= own => format!("<{}", brief(own * factor)),
                _ => brief(off * factor),
            })
        };
        macro_rules! off {
            ($figure:ident, $factor:expr) => {
                move |method: &&MethodReport| {
                    let of = &method.error_vs_reference;
                    error(of.off.$figure, of.reference.$figure, $factor)
                }
            };
        }
        let seconds = |seconds: f64| significant(seconds, 2);
        let best = |method: &&MethodReport| {
            let mark = if method.pareto { "●" } else { "" };
            Cell::both(Value::Truth(Some(method.pareto)), mark).toned(Tone::Good)
        };
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .named("method", "method", |method: &&MethodReport| Cell::text(&method.method))
            .column("evaluations", "points", |method| Cell::count(method.evaluations))
            .data("cached", |method| Cell::count(method.cached))
            .column("evaluation_s", "model s", move |method| Cell::number(method.evaluation_s, seconds))
            .column("engine_s", "engine s", move |method| Cell::number(method.engine_s, seconds))
            .data("mean", |method| Cell::data(method.figures.mean))
            .data("sigma", |method| Cell::data(method.figures.sigma))
            .data("skewness", |method| Cell::data(method.figures.skewness))
            .data("kurtosis", |method| Cell::data(method.figures.kurtosis))
            .data("yield", |method| Cell::data(method.figures.yield_))
            .column("mean_off_sigmas", "mean/sigma", off!(mean, 1.0))
            .column("sigma_off_relative", "sigma %", off!(sigma, 100.0))
            .column("skewness_off", "skew", off!(skewness, 1.0))
            .column("kurtosis_off", "kurt", off!(kurtosis, 1.0))
            .column("yield_off", "yield %", off!(yield_, 100.0))
            .data("overall", |method| Cell::data(method.error_vs_reference.overall))
            .data("resolved", |method| Cell::both(Value::Truth(Some(method.error_vs_reference.resolved)), ""))
            .named("pareto", "no other beats it", best)
            .table("comparison", &self.methods)
    }

    /// Plot of error over evaluations. Open circles are methods whose error the reference does not resolve, below the dashed line. The
    /// solid line joins the methods that no other method beats.
    fn plot(&self) -> Plot {
        let floor = self.methods.first().map_or(0.0, |method| method.error_vs_reference.floor());
        let point = |method: &MethodReport| {
            let error = method.error_vs_reference.overall?.max(floor);
            (error > 0.0 && method.evaluations > 0).then(|| PlotPoint {
                at: [method.evaluations as f64, error],
                name: method.method.clone(),
                tip: String::new(),
                strong: method.pareto,
                filled: method.error_vs_reference.resolved,
            })
        };
        let points: Vec<PlotPoint> = self.methods.iter().filter_map(point).collect();
        let front: Vec<_> =
            points.iter().filter(|point| point.strong).map(|point| (point.at[0], Some(point.at[1]))).collect();
        let mut layers = Vec::new();
        layers.extend((floor > 0.0).then_some(Layer::Mark(floor, "reference resolves")));
        layers.extend((front.len() > 1).then_some(Layer::Curve(front, Stroke::Thin)));
        layers.push(Layer::Points(points));
        Plot {
            name: self.name.clone(),
            x: PlotAxis::new("evaluations", PlotScale::Decades),
            y: PlotAxis::new("error of mean and sigma, in sigmas", PlotScale::Decades),
            layers,
            words: "Each circle is a method: farther left is cheaper, farther down is more accurate. Blue, and joined by the line: no other \
                    method has a smaller error for as many evaluations. Open: its error is below what the reference resolves, the dashed line."
                .to_owned(),
        }
    }
}

/// Formats an error with two digits.
fn brief(value: f64) -> String {
    if value == 0.0 || (1e-3..1e4).contains(&value) { significant(value, 2) } else { format!("{value:.0e}") }
}
