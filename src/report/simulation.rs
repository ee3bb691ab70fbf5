//! The report of a simulation: the names of an analysis, each number with its standard error.

use serde::Serialize;

use super::distribution::{NAMES, OptionalQuantiles};
use super::{About, CorrelationReport, DimensionReport, Head, RequirementReport, WarningReport, correlation};
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
    pub histogram: Option<HistogramReport>,
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

/// A sample in intervals.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct HistogramReport {
    /// One more than there are intervals, ascending.
    pub edges: Vec<f64>,
    /// How many values in each.
    pub counts: Vec<u64>,
}

impl HistogramReport {
    pub(super) fn of(Histogram { edges, counts }: &Histogram) -> Self {
        Self { edges: edges.clone(), counts: counts.clone() }
    }
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
            histogram: one.histogram.as_ref().map(HistogramReport::of),
            control: one.control.map(|control| ControlReport {
                method: control.method.name(),
                evaluations: control.evaluations,
                reduction: Reduction { mean: control.mean, sigma: control.sigma },
            }),
        }
    }
}
