//! The report of a simulation: the names of an analysis, each number with its standard error.

use serde::Serialize;

use super::distribution::{NAMES, OptionalQuantiles, QUANTILES};
use super::head::{self, findings, seed};
use super::requirement::judged;
use super::{About, CorrelationReport, DimensionReport, Head, RequirementReport, WarningReport, correlation};
use crate::capability::Law;
use crate::document::number::{estimated, index, known, limits, plain, significant, uncertainty, yielded};
use crate::document::{Blocks, Cell, Chart, Columns, Document, Line, Section, Spread, Table};
use crate::moments::Moments;
use crate::pearson::Pearson;
use crate::problem::Problem;
use crate::sampling::{Estimate, Sampler};
use crate::simulation::{Histogram, SimulatedCharacteristic, Simulation};
use crate::summary::RunSummary;
use crate::verdict::Verdict;

/// The report of a simulation, as `--json` prints it. What is unknown is null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SimulationReport {
    /// What every report begins with.
    #[serde(flatten)]
    pub head: Head,
    /// `monte-carlo` or `quasi-monte-carlo`.
    pub method: &'static str,
    /// `random` or `sobol`.
    pub sampler: &'static str,
    /// Points that were answered.
    pub samples: u64,
    /// What it came to in points and time, and why it ended early.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Those of the surrogate that stands beside the model; null where there is none.
    pub surrogate_evaluations: Option<u64>,
    /// Whether the wanted standard errors were reached; null where none were wanted.
    pub reached: Option<bool>,
    /// The dimensions, in the study's order.
    pub dimensions: Vec<DimensionReport>,
    /// The dimensions that vary together.
    pub correlation: Vec<CorrelationReport>,
    /// What was asked.
    pub characteristics: Vec<SimulatedReport>,
    /// Where an assumption fails.
    pub warnings: Vec<WarningReport>,
}

/// One characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SimulatedReport {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Points at which it has a value.
    pub samples: u64,
    /// Points at which it has none.
    pub failed: u64,
    /// Why not, of the first of them.
    pub error: Option<String>,
    /// Whether the sample was stopped before all its points were drawn.
    pub unfinished: bool,
    /// First moment.
    pub mean: Option<f64>,
    /// Standard deviation.
    pub sigma: Option<f64>,
    /// Third standardised moment.
    pub skewness: Option<f64>,
    /// Fourth standardised moment, 3 for a normal.
    pub kurtosis: Option<f64>,
    /// How uncertain the sample leaves all this.
    pub standard_error: StandardErrors,
    /// The sample's own distribution.
    pub distribution: EmpiricalReport,
    /// The least and the greatest value seen.
    pub range: Option<[f64; 2]>,
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
    /// The share that does, among the points that have a value.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// If all points without a value are rejected, and if none is; null where every point has one.
    pub yield_bounds: Option<[f64; 2]>,
    /// Assemblies below the lower limit, per million.
    pub ppm_below: Option<f64>,
    /// Assemblies above the upper limit, per million.
    pub ppm_above: Option<f64>,
    /// Width of the limits by six sigma.
    pub cp: Option<f64>,
    /// Distance of the nearer limit by three sigma.
    pub cpk: Option<f64>,
    /// The sample in intervals.
    pub histogram: Option<Histogram>,
    /// The surrogate as control variate; null where there is none.
    pub control: Option<ControlReport>,
}

/// What a surrogate as control variate has done.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ControlReport {
    /// The method that it comes from.
    pub method: &'static str,
    /// The evaluations that it took, of all characteristics together.
    pub evaluations: usize,
    /// By how much standard errors have shrunk.
    pub reduction: Reduction,
}

/// The standard error without the surrogate by that with it; null where that is unknown or 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Reduction {
    /// Of the mean.
    pub mean: Option<f64>,
    /// Of sigma.
    pub sigma: Option<f64>,
}

/// Standard errors, and the 95 % interval of the yield.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct StandardErrors {
    /// Of the mean.
    pub mean: Option<f64>,
    /// Of sigma.
    pub sigma: Option<f64>,
    /// Of the skewness.
    pub skewness: Option<f64>,
    /// Of the kurtosis.
    pub kurtosis: Option<f64>,
    /// 95 % interval.
    #[serde(rename = "yield")]
    pub yield_: Option<[f64; 2]>,
    /// Of the quantiles.
    pub quantiles: OptionalQuantiles,
}

/// A distribution that is known by a sample.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct EmpiricalReport {
    /// Always `empirical`.
    pub family: &'static str,
    /// Quantiles.
    pub quantiles: OptionalQuantiles,
}

impl SimulationReport {
    /// The report of a simulation.
    pub fn of(problem: &Problem, simulation: &Simulation, about: About) -> Self {
        let (method, sampler) = names(simulation.sampler);
        Self {
            head: Head::of("simulate", &about),
            method,
            sampler,
            samples: simulation.samples,
            run: simulation.run,
            surrogate_evaluations: simulation.surrogate_evaluations,
            reached: simulation.reached,
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            characteristics: simulation.characteristics.iter().map(SimulatedReport::of).collect(),
            warnings: about.warnings.iter().chain(&simulation.warnings).map(WarningReport::of).collect(),
        }
    }
}

/// A sampler as a method and as itself.
pub(super) fn names(sampler: Sampler) -> (&'static str, &'static str) {
    match sampler {
        Sampler::Random => ("monte-carlo", "random"),
        Sampler::Sobol => ("quasi-monte-carlo", "sobol"),
    }
}

impl SimulatedReport {
    pub(super) fn of(one: &SimulatedCharacteristic) -> Self {
        let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
        let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
        let quantiles = |of: &dyn Fn(Option<Estimate>) -> Option<f64>| {
            OptionalQuantiles(NAMES.into_iter().zip(one.quantiles.map(of)).collect())
        };
        let limits = one.characteristic.limits();
        let (lower, upper) = (limits.lower(), limits.upper());
        let target_yield = one.characteristic.target_yield();
        Self {
            name: one.characteristic.name().to_owned(),
            unit: one.characteristic.unit().map(str::to_owned),
            samples: one.samples,
            failed: one.failed,
            error: one.error.as_ref().map(ToString::to_string),
            unfinished: one.unfinished,
            mean: value(one.mean),
            sigma: value(one.sigma),
            skewness: value(one.skewness),
            kurtosis: value(one.kurtosis),
            standard_error: StandardErrors {
                mean: error(one.mean),
                sigma: error(one.sigma),
                skewness: error(one.skewness),
                kurtosis: error(one.kurtosis),
                yield_: one.yield_.map(|share| share.interval),
                quantiles: quantiles(&error),
            },
            distribution: EmpiricalReport { family: "empirical", quantiles: quantiles(&value) },
            range: one.range,
            lower,
            upper,
            target_yield,
            met: one.verdict().and_then(Verdict::met),
            verdict: one.verdict(),
            requirements: one.requirements().iter().map(RequirementReport::of).collect(),
            yield_: one.yield_.map(|share| share.value),
            yield_bounds: one.yield_.filter(|_| one.failed > 0).map(|share| share.bounds),
            ppm_below: one.below.map(|share| 1e6 * share),
            ppm_above: one.above.map(|share| 1e6 * share),
            cp: one.cp,
            cpk: one.cpk,
            histogram: one.histogram.clone(),
            control: one.control.map(|control| ControlReport {
                method: control.method.name(),
                evaluations: control.evaluations,
                reduction: Reduction { mean: control.mean, sigma: control.sigma },
            }),
        }
    }
}

/// Fewer intervals are no picture.
const INTERVALS: usize = 5;

impl SimulationReport {
    /// What it says: every number with its standard error (table `estimates`), and the histogram (table `histogram`).
    pub fn document(&self) -> Document {
        let mut document = Document::titled(self.head.title.as_deref());
        let (seed, rest) = (seed(&self.run), head::beside(&self.run));
        document.line(format!("{}: {} points{seed}{rest}", self.method, self.samples));
        document.sections = self.characteristics.iter().map(|one| one.section(&self.warnings)).collect();
        document
    }
}

/// An estimate: its name, its value, its standard error, its interval.
type Row = (&'static str, Option<f64>, Option<f64>, Option<[f64; 2]>);

impl SimulatedReport {
    fn section(&self, warnings: &[WarningReport]) -> Section {
        let mut section = Section::of(&self.name, self.unit.as_deref());
        section.blocks = findings(warnings, |name| name == Some(&self.name));
        section.table(self.estimates());
        section.table(self.histogram_table());
        if self.samples == 0 {
            section.note("no point has a value");
            return section;
        }
        if let Some(control) = &self.control {
            let times = |value: Option<f64>, name: &str| value.map(|value| format!("{name} {}", significant(value, 3)));
            let shrunk = [times(control.reduction.mean, "mean"), times(control.reduction.sigma, "sigma")];
            let shrunk: Vec<String> = shrunk.into_iter().flatten().collect();
            let shrunk = match shrunk.is_empty() {
                true => String::new(),
                false => format!(": standard errors shrunk by {}", shrunk.join(", ")),
            };
            section.note(format!("control: {} surrogate, {} evaluations{shrunk}", control.method, control.evaluations));
        }
        if let Some(yield_) = self.yield_ {
            self.limits(&mut section, yield_);
        }
        self.requirements.iter().filter_map(RequirementReport::line).for_each(|line| section.note(line));
        self.picture(&mut section);
        section
    }

    fn limits(&self, section: &mut Section, yield_: f64) {
        let interval = self
            .standard_error
            .yield_
            .map_or(String::new(), |[low, high]| format!(", 95 % interval {} to {}", yielded(low), yielded(high)));
        let target = judged(self.target_yield, self.verdict);
        section.note(Line::from(format!("yield {}{interval}", yielded(yield_))).and(target));
        if let Some([low, high]) = self.yield_bounds {
            let (points, [low, high]) = (self.failed, [low, high].map(yielded));
            section
                .note(format!("{points} points have no value: {low} if all of these are rejected, {high} if none is"));
        }
        let ppm = |value: Option<f64>, side: &str| value.map(|value| format!("{} ppm {side}", significant(value, 4)));
        let named = |value: Option<f64>, name: &str| value.map(|value| format!("{name} {}", index(value)));
        let figures =
            [ppm(self.ppm_below, "below"), ppm(self.ppm_above, "above"), named(self.cp, "Cp"), named(self.cpk, "Cpk")];
        section.note(figures.into_iter().flatten().collect::<Vec<_>>().join("  "));
        section.remark(format!(
            "Limits {}; values seen from {} to {}.",
            limits(self.lower, self.upper),
            known(self.range.map(|[least, _]| least), plain),
            known(self.range.map(|[_, greatest]| greatest), plain),
        ));
    }

    fn estimates(&self) -> Table {
        let errors = &self.standard_error;
        let moments: [Row; 4] = [
            ("mean", self.mean, errors.mean, None),
            ("sigma", self.sigma, errors.sigma, None),
            ("skewness", self.skewness, errors.skewness, None),
            ("kurtosis", self.kurtosis, errors.kurtosis, None),
        ];
        let quantiles = QUANTILES.into_iter().zip(self.distribution.quantiles.0.iter().zip(&errors.quantiles.0));
        let quantiles = quantiles.map(|(name, (value, error))| (name, value.1, error.1, None));
        let seen = if self.samples == 0 { 0 } else { moments.len() + QUANTILES.len() };
        let rest: [Row; 3] = [
            ("yield", self.yield_, None, errors.yield_),
            ("ppm_below", self.ppm_below, None, None),
            ("ppm_above", self.ppm_above, None, None),
        ];
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .data("unit", |_| Cell::optional(self.unit.as_deref()))
            .named("estimate", "", |row: &Row| Cell::text(row.0))
            .named("value", "value", |row| Cell::number(row.1, |value| estimated(value, row.2)))
            .column("standard_error", "standard error", |row| Cell::number(row.2, uncertainty))
            .data("interval_low", |row| Cell::data(row.3.map(|[low, _]| low)))
            .data("interval_high", |row| Cell::data(row.3.map(|[_, high]| high)))
            .table("estimates", moments.into_iter().chain(quantiles).chain(rest))
            .seen((0..seen).collect())
    }

    fn histogram_table(&self) -> Table {
        let rows = self.histogram.iter().flat_map(|of| of.edges.windows(2).zip(&of.counts));
        Columns::default()
            .data("characteristic", |_| Cell::text(&self.name))
            .data("from", |row: &(&[f64], &u64)| Cell::data(row.0[0]))
            .data("to", |row| Cell::data(row.0[1]))
            .data("count", |row| Cell::count(*row.1))
            .table("histogram", rows)
    }

    /// The sample, and the Pearson curve of its own moments.
    fn picture(&self, section: &mut Section) {
        let Some(of) = self.histogram.as_ref().filter(|of| of.counts.len() >= INTERVALS) else { return };
        let law = self.fitted();
        let curve = law.as_ref().map_or(String::new(), |law| {
            format!(" The line: the Pearson curve of its four moments ({}).", law.kind().name())
        });
        section.gap();
        section.chart(Chart::Spread(Box::new(Spread {
            bins: Some(of.clone()),
            law,
            sampled: true,
            limits: [self.lower, self.upper],
            places: self.mean.map(|mean| (mean, "mean", "mean")).into_iter().collect(),
            sigma: self.sigma.unwrap_or(0.0),
            label: format!("Histogram of {} with the standard error of every bar", self.name),
            words: format!("The sample; each bar with one standard error.{curve}"),
        })));
    }

    /// The distribution of the sample's own moments.
    fn fitted(&self) -> Option<Pearson> {
        let moments = Moments::new(self.mean?, self.sigma?, self.skewness?, self.kurtosis? - 3.0);
        match Law::fit(&moments).ok()? {
            Law::Pearson(law) => Some(*law),
            Law::Point { .. } => None,
        }
    }
}
