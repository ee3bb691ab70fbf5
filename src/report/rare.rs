//! The report of rare events.

use serde::Serialize;

use super::{About, CorrelationReport, DimensionReport, Head, RequirementReport, WarningReport, correlation};
use crate::problem::Problem;
use crate::rare::{Beyond, RareCharacteristic, RareEvents};
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
    pub design_point: Option<DesignPointReport>,
}

/// The most likely assembly at a limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct DesignPointReport {
    /// Its distance from the middle in standard deviations of independent normal variables.
    pub distance: f64,
    /// Every dimension's value, in the order of `dimensions`.
    pub values: Vec<f64>,
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
            design_point: beyond
                .design_point
                .as_ref()
                .map(|point| DesignPointReport { distance: point.distance, values: point.values.clone() }),
        }
    }
}
