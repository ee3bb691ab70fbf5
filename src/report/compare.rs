//! The report of a comparison: as data and as CSV.

use serde::Serialize;

use super::simulation::SimulatedReport;
use super::{About, Head};
use crate::compare::{Comparison, Contender, Errors, Figures, NotRunReason, Ran};
use crate::summary::RunSummary;
use crate::verdict::Verdict;

/// The report of a comparison, as `--json` prints it. What is unknown is null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct CompareReport {
    /// What every report begins with.
    #[serde(flatten)]
    pub head: Head,
    /// What all of it came to in points and time, the reference included, and why it ended early.
    #[serde(flatten)]
    pub run: RunSummary,
    /// Points of the reference.
    pub reference_samples: u64,
    /// How they were drawn.
    pub reference_method: &'static str,
    /// What was asked.
    pub characteristics: Vec<ComparedReport>,
    /// Methods that were not run, and why.
    pub not_run: Vec<NotRunReport>,
}

/// One characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ComparedReport {
    /// Its name.
    pub name: String,
    /// What the methods are measured by.
    pub reference: SimulatedReport,
    /// The methods, fewest evaluations first.
    pub methods: Vec<MethodReport>,
}

/// One method on one characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct MethodReport {
    /// Its name; of samples with the number of points.
    pub method: String,
    /// Points that it takes.
    pub evaluations: u64,
    /// Those of them that were known already.
    pub cached: u64,
    /// What its run came to by itself.
    pub run: RunSummary,
    /// Seconds within the model.
    pub evaluation_s: f64,
    /// Seconds besides.
    pub engine_s: f64,
    /// What it says.
    #[serde(flatten)]
    pub figures: FiguresReport,
    /// How far that is off the reference.
    pub error_vs_reference: ErrorReport,
    /// Whether no other method has a smaller error for as many evaluations or fewer.
    pub pareto: bool,
    /// What it says of the target yield; null without one.
    pub verdict: Option<Verdict>,
}

/// Moments and yield.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct FiguresReport {
    /// First moment.
    pub mean: Option<f64>,
    /// Standard deviation.
    pub sigma: Option<f64>,
    /// Third standardised moment.
    pub skewness: Option<f64>,
    /// Fourth standardised moment.
    pub kurtosis: Option<f64>,
    /// Share within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
}

/// How far a method is off.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ErrorReport {
    /// The mean in sigmas, sigma relative, the others as they are.
    #[serde(flatten)]
    pub off: FiguresReport,
    /// The reference's own standard errors in the same units.
    pub reference_standard_error: FiguresReport,
    /// Root of the sum of squares of the errors of mean and sigma.
    pub overall: Option<f64>,
    /// Whether the reference tells that from 0.
    pub resolved: bool,
    /// What of it the reference may be off itself.
    #[serde(skip)]
    pub floor: f64,
}

/// A method that was not run.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct NotRunReport {
    /// Its name.
    pub method: String,
    /// What it would have taken.
    pub evaluations: Option<u64>,
    /// Seconds that the model would have taken.
    pub projected_s: Option<f64>,
    /// Why not.
    pub reason: NotRunReason,
}

impl CompareReport {
    /// The report of a comparison.
    pub fn of(comparison: &Comparison, about: About) -> Self {
        let reference = &comparison.reference;
        let characteristics = reference.characteristics.iter().enumerate().map(|(c, one)| ComparedReport {
            name: one.characteristic.name().to_owned(),
            reference: SimulatedReport::of(one),
            methods: comparison.ran.iter().map(|ran| MethodReport::of(ran, c)).collect(),
        });
        Self {
            head: Head::of("compare", &about),
            run: comparison.run,
            reference_samples: reference.samples,
            reference_method: super::simulation::names(reference.sampler).0,
            characteristics: characteristics.collect(),
            not_run: (comparison.not_run.iter())
                .map(|one| NotRunReport {
                    method: one.contender.name(),
                    evaluations: one.evaluations,
                    projected_s: one.projected_s,
                    reason: one.reason.clone(),
                })
                .collect(),
        }
    }
}

impl MethodReport {
    fn of(ran: &Ran, c: usize) -> Self {
        let Errors { off, reference } = &ran.errors[c];
        Self {
            method: Contender::name(ran.contender),
            evaluations: ran.evaluations,
            cached: ran.run.cached,
            run: ran.run,
            evaluation_s: ran.evaluation.as_secs_f64(),
            engine_s: ran.engine.as_secs_f64(),
            figures: FiguresReport::of(&ran.figures[c]),
            error_vs_reference: ErrorReport {
                off: FiguresReport::of(off),
                reference_standard_error: FiguresReport::of(reference),
                overall: ran.errors[c].overall(),
                resolved: ran.errors[c].resolved(),
                floor: ran.errors[c].floor(),
            },
            pareto: ran.pareto[c],
            verdict: ran.verdicts[c],
        }
    }
}

impl FiguresReport {
    fn of(figures: &Figures) -> Self {
        let Figures { mean, sigma, skewness, kurtosis, yield_ } = *figures;
        Self { mean, sigma, skewness, kurtosis, yield_ }
    }
}
