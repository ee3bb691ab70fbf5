//! The report of rare events.

use serde::Serialize;

use super::{About, CorrelationReport, DimensionReport, Head, WarningReport, correlation};
use crate::analysis::history;
use crate::problem::Problem;
use crate::rare::{Beyond, RareCharacteristic, RareEvents};
use crate::warning::Warning;

/// More of an estimate than this on one point is a warning.
const HEAVY: f64 = 0.25;

/// The report of rare events, as `--json` prints it. What is unknown is null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
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
    /// Every point sent to the model.
    pub evaluations: u64,
    /// Those of the surrogate.
    pub surrogate_evaluations: u64,
    /// Answers taken from an earlier run.
    pub reused: u64,
    /// Points that lost at least one asked characteristic.
    pub failed: u64,
    /// Whether it ended before all points were drawn, or what was wanted was reached.
    pub stopped: bool,
    /// Whether the wanted standard errors were reached; null where none were wanted.
    pub reached: Option<bool>,
    /// Seconds from the first evaluation to the finished result.
    pub wall_s: f64,
    /// The seed.
    pub seed: u64,
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
pub struct RareCharacteristicReport {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Points at which it has no value.
    pub failed: u64,
    /// Lower limit.
    pub lower: Option<f64>,
    /// Upper limit.
    pub upper: Option<f64>,
    /// The share of assemblies that must keep the limits.
    pub target_yield: Option<f64>,
    /// Whether the interval of the yield lies above that (true), below (false), or around it (null).
    pub met: Option<bool>,
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
    /// Points of a plain random sample that would have the same standard error.
    pub plain_samples: Option<f64>,
    /// The most likely assembly at the limit, as the surrogate has it.
    pub design_point: Option<DesignPointReport>,
}

/// The most likely assembly at a limit.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct DesignPointReport {
    /// Its distance from the middle in standard deviations of independent normal variables.
    pub distance: f64,
    /// Every dimension's value, in the order of `dimensions`.
    pub values: Vec<f64>,
}

impl RareReport {
    /// The report of rare events.
    pub fn of(problem: &Problem, found: &RareEvents, about: About) -> Self {
        let doubts = history(problem, &found.doubts);
        let warnings: Vec<Warning> =
            found.characteristics.iter().flat_map(|one| warnings(one, found)).chain(doubts).collect();
        Self {
            head: Head::of("simulate", &about),
            method: "importance-sampling",
            surrogate: found.method.name(),
            samples: found.samples,
            evaluations: found.evaluations,
            surrogate_evaluations: found.surrogate_evaluations,
            reused: found.reused,
            failed: found.failed,
            stopped: found.stopped,
            reached: found.reached,
            wall_s: about.wall_s,
            seed: found.seed,
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            characteristics: found.characteristics.iter().map(RareCharacteristicReport::of).collect(),
            warnings: about.warnings.iter().chain(&warnings).map(WarningReport::of).collect(),
        }
    }
}

fn warnings(one: &RareCharacteristic, found: &RareEvents) -> Vec<Warning> {
    let characteristic = || one.characteristic.name().to_owned();
    let mut warnings: Vec<Warning> = (one.error.iter())
        .map(|error| Warning::FailedSamples {
            characteristic: characteristic(),
            failed: one.failed,
            samples: found.samples,
            error: error.to_string(),
        })
        .collect();
    for beyond in [&one.below, &one.above].into_iter().flatten() {
        let limit = beyond.limit;
        if beyond.probability.is_none() {
            let (points, most) = (found.samples, beyond.interval[1]);
            warnings.push(Warning::NothingBeyond { characteristic: characteristic(), limit, points, most });
        }
        if let Some(part) = beyond.greatest_part.filter(|&part| part > HEAVY) {
            warnings.push(Warning::HeavyPoint { characteristic: characteristic(), limit, part });
        }
        let evaluations = found.evaluations;
        if let Some(plain) = beyond.plain_samples.filter(|&plain| plain < evaluations as f64) {
            warnings.push(Warning::PlainSampling { characteristic: characteristic(), limit, plain, evaluations });
        }
    }
    warnings
}

impl RareCharacteristicReport {
    fn of(one: &RareCharacteristic) -> Self {
        let limits = one.characteristic.limits();
        let sides: Vec<&Beyond> = [&one.below, &one.above].into_iter().flatten().collect();
        let whole = sides.len() == [limits.lower(), limits.upper()].iter().flatten().count() && !sides.is_empty();
        let value = |beyond: &Beyond| beyond.probability.map(|probability| probability.value);
        let rejected: Option<f64> = sides.iter().map(|beyond| value(beyond)).sum();
        // Two independent errors are joined as Zou and Donner (2008) do.
        let apart = |end: usize| {
            let distances = sides.iter().map(|beyond| beyond.interval[end] - value(beyond).unwrap_or(0.0));
            distances.fold(0.0, f64::hypot)
        };
        let sum: f64 = sides.iter().filter_map(|beyond| value(beyond)).sum();
        let interval = whole.then(|| [1.0 - sum - apart(1), 1.0 - sum + apart(0)].map(|end| end.clamp(0.0, 1.0)));
        let target_yield = one.characteristic.target_yield();
        // What has no value may be rejected.
        let unknown: f64 = sides.iter().map(|beyond| beyond.bounds[1] - beyond.bounds[0]).sum();
        Self {
            name: one.characteristic.name().to_owned(),
            unit: one.characteristic.unit().map(str::to_owned),
            failed: one.failed,
            lower: limits.lower(),
            upper: limits.upper(),
            target_yield,
            met: target_yield.zip(interval).and_then(|(target, [low, high])| {
                if low - unknown >= target { Some(true) } else { (high < target).then_some(false) }
            }),
            yield_: rejected.filter(|_| whole).map(|rejected| 1.0 - rejected),
            yield_interval: interval,
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
            plain_samples: beyond.plain_samples,
            design_point: beyond
                .design_point
                .as_ref()
                .map(|point| DesignPointReport { distance: point.distance, values: point.values.clone() }),
        }
    }
}
