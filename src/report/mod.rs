//! Reports: a versioned value with serde, and the document that it is for people.

mod allocation;
mod allocation_document;
mod analysis_document;
mod bars;
mod compare;
#[cfg(test)]
mod complete;
mod csv;
mod distribution;
mod estimate;
mod head;
#[cfg(feature = "html")]
pub mod html;
mod rare;
mod remainder;
mod requirement;
mod sampling;
#[cfg(feature = "cli")]
mod schema;
mod simulation;
mod stack;
mod surface_law;
mod sweep;
mod verification;

pub use allocation::{
    AllocatedCharacteristic, AllocatedReport, AllocationReport, AttainableReport, BeforeAfter, ConfirmationReport,
    ContributionReport, FrontReport, FrontRequirement, KeptReport, PriceReport, ProofReport, RecentredReport,
    WrittenAnew,
};
pub use analysis_document::law_text;
pub use compare::{CompareReport, ComparedReport, ErrorReport, MethodReport, NotRunReport};
pub use csv::{CsvFile, csv_file_names, csv_files, csv_tables, stack_csv, stack_csv_of_studies};
pub use distribution::{DistributionReport, OptionalQuantiles, Quantiles};
pub use estimate::ModelSamplingReport;
pub use head::Head;
pub use rare::{BeyondReport, RareCharacteristicReport, RareReport};
pub use remainder::RemainderReport;
pub use requirement::RequirementReport;
pub use sampling::SamplingReport;
pub use simulation::{EmpiricalReport, SimulatedReport, SimulationReport, StandardErrors};
pub use stack::{Stack, StackNote, StackRow, StackTotal, TotalKind, stack_document};
pub use surface_law::SurfaceLawReport;
pub use sweep::{ParameterReport, SweepReport, SweptPointReport, SweptReport};
pub use verification::{SwitchReport, VarianceShareReport, VerificationReport, VerifiedFiguresReport};

use serde::Serialize;

use crate::analysis::{Account, Analysis, CharacteristicAnalysis, Interaction, Sensitivity, YieldSource};
use crate::capability::{Capability, Law};
use crate::dimension::Dimension;
use crate::document::number::{UNKNOWN, band, significant};
use crate::extremes::{Extreme, Extremes};
use crate::method::{Basis, DerivativeSource, ErrorEstimate, Residual};
use crate::moments::Sampled;
use crate::problem::Problem;
use crate::summary::RunSummary;
use crate::verdict::Verdict;
use crate::verification::Verified;
use crate::warning::{Advice, Warning};

/// The version of the JSON report's shape.
pub const SCHEMA: u32 = 2;

/// The report of an analysis, as `--json` prints it. What is unknown is null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Report {
    /// What every report begins with.
    #[serde(flatten)]
    pub head: Head,
    /// The method that was run.
    pub method: &'static str,
    /// Dimensions that vary and matter, N.
    pub varying: usize,
    /// What `auto` found, and what its points went to; null for any other method.
    pub account: Option<Account>,
    /// Where the derivatives that the moments rest on come from: `exact` or `difference`; null where they rest on none.
    pub derivatives: Option<&'static str>,
    /// What the moments rest on.
    pub basis: Basis,
    /// What it came to in points and time, and why it ended early.
    #[serde(flatten)]
    pub run: RunSummary,
    /// The dimensions, in the study's order.
    pub dimensions: Vec<DimensionReport>,
    /// The dimensions that vary together.
    pub correlation: Vec<CorrelationReport>,
    /// What was asked.
    pub characteristics: Vec<CharacteristicReport>,
    /// The share of assemblies that keep the limits of all characteristics at once; null with fewer than two that have limits, and
    /// where it is not known.
    pub joint_yield: Option<Verified>,
    /// Where an assumption fails.
    pub warnings: Vec<WarningReport>,
}

/// One dimension as the analysis took it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct DimensionReport {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// The value on the drawing.
    pub nominal: f64,
    /// Lower and upper deviation from the nominal.
    pub tolerance: Option<[f64; 2]>,
    /// The circular zone of which it is a coordinate.
    pub zone: Option<String>,
    /// The kind of its distribution; null when it does not vary.
    pub distribution: Option<&'static str>,
    /// Its mean.
    pub mean: f64,
    /// Its standard deviation.
    pub sigma: f64,
}

/// Two dimensions that vary together.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct CorrelationReport {
    /// The two.
    pub between: [String; 2],
    /// Their coefficient of correlation.
    pub value: f64,
}

/// One characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct CharacteristicReport {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: Option<String>,
    /// Its value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// First moment.
    pub mean: Option<f64>,
    /// Standard deviation.
    pub sigma: Option<f64>,
    /// Third standardised moment.
    pub skewness: Option<f64>,
    /// Fourth standardised moment, 3 for a normal.
    pub kurtosis: Option<f64>,
    /// What sampling left uncertain of these; null where they are exact for the surrogate.
    pub surrogate_sampling: Option<Sampled>,
    /// How well a surface of least squares fits; null where none was fitted.
    pub least_squares: Option<Residual>,
    /// How far the results may be off, by what the method did not see; null without moments.
    pub error_estimate: Option<ErrorEstimate>,
    /// Points of the model that the moments rest on, where `auto` did not trust its surrogate.
    pub model_sampling: Option<ModelSamplingReport>,
    /// What the model itself says of them; null where they were not verified.
    pub verification: Option<VerificationReport>,
    /// How far they may be off because measured dimensions are known by samples; null where nothing is measured.
    pub sampling_interval: Option<SamplingReport>,
    /// What the law of its surface says; null where its moments follow from no surface.
    pub surface_law: Option<SurfaceLawReport>,
    /// Whether planned points of it were not evaluated because the run was stopped.
    pub unfinished: bool,
    /// Evaluated points at which it has no value.
    pub without_value: usize,
    /// Whether it can depend on nothing that varies.
    pub constant: bool,
    /// Intervals that no assembly leaves.
    pub worst_case: WorstCaseReport,
    /// The value of a linear model with every dimension in the middle of its band.
    pub middle: Option<f64>,
    /// Root of the sum of squares, about the middle.
    pub rss: Option<f64>,
    /// 1.5 times that (Bender).
    pub inflated_rss: Option<f64>,
    /// With every mean off by half its half band, 1.5 sigma of 3, all the wrong way.
    pub mean_shift_rss: Option<f64>,
    /// Every dimension, in the study's order.
    pub sensitivities: Vec<Sensitivity>,
    /// The interactions examined, strongest first.
    pub interactions: Vec<Interaction>,
    /// What the interactions make that are not listed one by one; null where all are.
    pub interactions_remainder: Option<RemainderReport>,
    /// How many interactions there can be.
    pub possible_interactions: usize,
    /// Share of the variance that nothing above accounts for.
    pub left_out_share: Option<f64>,
    /// The distribution that has these moments; None where they are unknown, or none has.
    pub distribution: Option<DistributionReport>,
    /// The same, to be drawn.
    #[serde(skip)]
    pub law: Option<Law>,
    /// Lower limit.
    pub lower: Option<f64>,
    /// Upper limit.
    pub upper: Option<f64>,
    /// The share of assemblies that must keep the limits.
    pub target_yield: Option<f64>,
    /// Whether they do; null where that is not known.
    pub met: Option<bool>,
    /// The same in a word; null without a target.
    pub verdict: Option<Verdict>,
    /// Everything that is required of it, the target yield included.
    pub requirements: Vec<RequirementReport>,
    /// Within which the share is known that does; null where that is not known.
    pub yield_interval: Option<[f64; 2]>,
    /// What the yield comes from: `proof`, `samples` of the model, `surface-law` or `pearson`; null without a yield.
    pub yield_source: Option<YieldSource>,
    /// The share that does.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// Assemblies below the lower limit, per million.
    pub ppm_below: Option<f64>,
    /// Assemblies above the upper limit, per million.
    pub ppm_above: Option<f64>,
    /// Width of the limits by six sigma.
    pub cp: Option<f64>,
    /// Distance of the nearer limit by three sigma.
    pub cpk: Option<f64>,
    /// Width of the limits by that between the quantiles 0.00135 and 0.99865.
    pub cp_percentile: Option<f64>,
    /// Distance of the nearer limit from the median by that of the quantile on its side.
    pub cpk_percentile: Option<f64>,
    /// Sigmas of a normal beyond which, on one side, as many lie as are rejected.
    pub sigma_level: Option<f64>,
    /// What the Pearson distribution with the same moments would make of the limits.
    pub pearson_fit: Option<FitReport>,
    /// What a normal distribution with the same mean and sigma would make of the limits.
    pub normal_fit: Option<FitReport>,
}

/// Intervals that no assembly leaves.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct WorstCaseReport {
    /// Of the linear model.
    pub linear: Option<[f64; 2]>,
    /// Of the model itself, where they were searched.
    pub extremes: Option<[f64; 2]>,
    /// Whether it is proven that no assembly lies beyond the extremes.
    pub proven: Option<bool>,
    /// Where the extremes are: every dimension that matters by name.
    pub at: Option<ExtremesAtReport>,
    /// An interval that no assembly leaves, by interval arithmetic; of formulas only.
    pub bounds: Option<[f64; 2]>,
    /// What the search evaluated; a point that serves several characteristics counts for each.
    pub evaluations: Option<usize>,
    /// The same, to be printed.
    #[serde(skip)]
    pub found: Option<Extremes>,
}

/// Where the extremes are.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct ExtremesAtReport {
    /// The dimensions at the least value.
    pub lower: PointReport,
    /// The dimensions at the greatest value.
    pub upper: PointReport,
}

/// A point by the names of its dimensions, in the study's order.
#[derive(Debug, Clone, PartialEq)]
pub struct PointReport(pub Vec<(String, f64)>);

impl Serialize for PointReport {
    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().map(|(name, x)| (name, x)))
    }
}

/// What a distribution with the same moments would make of the limits.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct FitReport {
    /// The share of assemblies within them.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// Assemblies below the lower limit, per million.
    pub ppm_below: Option<f64>,
    /// Assemblies above the upper limit, per million.
    pub ppm_above: Option<f64>,
}

/// A warning.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct WarningReport {
    /// What kind.
    pub code: &'static str,
    /// The characteristic concerned.
    pub characteristic: Option<String>,
    /// The dimension concerned.
    pub dimension: Option<String>,
    /// Cause and consequence.
    pub message: String,
    /// The fields of the warning.
    pub data: serde_json::Map<String, serde_json::Value>,
    /// What to do, the most promising first.
    pub advice: Vec<Advice>,
    /// Of a sweep, the values of the parameter at which it is so.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub at: Vec<f64>,
}

/// What a report says of the study beside the analysis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// The study's title.
    pub title: Option<String>,
    /// SHA-256 of the study file.
    pub sha256: String,
    /// Warnings of the study itself.
    pub warnings: Vec<Warning>,
}

impl Report {
    /// The report of an analysis.
    pub fn of(problem: &Problem, analysis: &Analysis, about: About) -> Self {
        Self {
            head: Head::of("analyze", &about),
            method: analysis.method.name(),
            varying: analysis.varying,
            account: analysis.account.clone(),
            derivatives: match analysis.basis {
                Basis::Exact => Some(DerivativeSource::Exact.name()),
                Basis::Differences => Some(DerivativeSource::Difference.name()),
                Basis::LeastSquares | Basis::Quadrature => None,
            },
            basis: analysis.basis,
            run: analysis.run,
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            characteristics: analysis.characteristics.iter().map(CharacteristicReport::of).collect(),
            joint_yield: analysis.joint,
            warnings: about.warnings.iter().chain(&analysis.warnings).map(WarningReport::of).collect(),
        }
    }
}

/// Every pair that is not 0.
fn correlation(problem: &Problem) -> Vec<CorrelationReport> {
    let Some(correlation) = problem.correlation() else { return Vec::new() };
    let name = |&d: &usize| problem.dimensions()[d].name().to_owned();
    let members = correlation.members();
    let pairs = members.iter().enumerate().flat_map(|(i, a)| members[i + 1..].iter().map(move |b| (a, b)));
    pairs
        .map(|(a, b)| CorrelationReport { between: [name(a), name(b)], value: correlation.of(*a, *b) })
        .filter(|pair| pair.value != 0.0)
        .collect()
}

impl DimensionReport {
    fn of(dimension: &Dimension) -> Self {
        Self {
            name: dimension.name().to_owned(),
            unit: dimension.unit().map(str::to_owned),
            nominal: dimension.nominal(),
            tolerance: dimension.tolerance(),
            zone: dimension.zone().map(str::to_owned),
            distribution: dimension.distribution().map(|distribution| distribution.name()),
            mean: dimension.mean(),
            sigma: dimension.sigma(),
        }
    }

    /// Its tolerance as drawings have it.
    fn tolerance(&self) -> String {
        match self.tolerance {
            Some(ends) => band(ends),
            None if self.sigma > 0.0 => format!("sigma {}", significant(self.sigma, 4)),
            None => UNKNOWN.to_owned(),
        }
    }
}

impl CharacteristicReport {
    fn of(analysis: &CharacteristicAnalysis) -> Self {
        let (characteristic, moments) = (&analysis.characteristic, analysis.moments);
        let law = analysis.law.clone().and_then(Result::ok);
        let of = |what: fn(&Capability) -> Option<f64>| analysis.capability.as_ref().and_then(what);
        fn ppm(share: f64) -> f64 {
            1e6 * share
        }
        Self {
            name: characteristic.name().to_owned(),
            unit: characteristic.unit().map(str::to_owned),
            nominal: analysis.nominal,
            mean: moments.map(|moments| moments.mean()),
            sigma: moments.map(|moments| moments.sigma()),
            skewness: moments.and_then(|moments| moments.skewness()),
            kurtosis: moments.and_then(|moments| moments.kurtosis()),
            surrogate_sampling: analysis.sampled,
            least_squares: analysis.residual,
            error_estimate: analysis.error_estimate.clone(),
            model_sampling: analysis.model_sampled.as_ref().map(ModelSamplingReport::of),
            verification: VerificationReport::of(analysis),
            sampling_interval: analysis.sampling.as_ref().map(SamplingReport::of),
            surface_law: analysis.surface_law.as_ref().map(SurfaceLawReport::of),
            unfinished: analysis.unfinished,
            without_value: analysis.without_value,
            constant: analysis.constant,
            worst_case: WorstCaseReport::of(analysis),
            middle: analysis.middle,
            rss: analysis.rss,
            inflated_rss: analysis.inflated_rss,
            mean_shift_rss: analysis.mean_shift_rss,
            sensitivities: analysis.sensitivities.clone(),
            interactions: analysis.interactions.clone(),
            interactions_remainder: None,
            possible_interactions: analysis.possible_interactions,
            left_out_share: analysis.left_out_share,
            distribution: law.as_ref().map(DistributionReport::of),
            law,
            lower: characteristic.limits().lower(),
            upper: characteristic.limits().upper(),
            target_yield: characteristic.target_yield(),
            met: analysis.met(),
            verdict: analysis.verdict(),
            requirements: analysis.requirements().iter().map(RequirementReport::of).collect(),
            yield_interval: analysis.yield_interval(),
            yield_source: analysis.yield_source,
            yield_: of(|capability| capability.yield_()),
            ppm_below: of(|capability| capability.below.map(ppm)),
            ppm_above: of(|capability| capability.above.map(ppm)),
            cp: of(|capability| capability.cp),
            cpk: of(|capability| capability.cpk),
            cp_percentile: of(|capability| capability.cp_percentile),
            cpk_percentile: of(|capability| capability.cpk_percentile),
            sigma_level: of(|capability| capability.sigma_level()),
            pearson_fit: analysis.pearson.as_ref().map(FitReport::of),
            normal_fit: analysis.normal.as_ref().map(FitReport::of),
        }
    }
}

impl FitReport {
    fn of(fit: &Capability) -> Self {
        let ppm = |share: Option<f64>| share.map(|share| 1e6 * share);
        Self { yield_: fit.yield_(), ppm_below: ppm(fit.below), ppm_above: ppm(fit.above) }
    }
}

impl WorstCaseReport {
    fn of(analysis: &CharacteristicAnalysis) -> Self {
        let found = analysis.extremes.as_ref();
        let point = |extreme: &Extreme| PointReport(extreme.at.iter().map(|at| (at.dimension.clone(), at.x)).collect());
        Self {
            linear: analysis.worst_case,
            extremes: found.map(|found| [found.least.value, found.greatest.value]),
            proven: found.map(Extremes::proven),
            at: found.map(|found| ExtremesAtReport { lower: point(&found.least), upper: point(&found.greatest) }),
            bounds: found.and_then(|found| found.proof.as_ref()).map(|proof| proof.bounds),
            evaluations: found.map(|found| found.evaluations),
            found: found.cloned(),
        }
    }
}

impl WarningReport {
    pub(crate) fn of(warning: &Warning) -> Self {
        Self {
            code: warning.code(),
            characteristic: warning.characteristic().map(str::to_owned),
            dimension: warning.dimension().map(str::to_owned),
            message: warning.message(),
            data: fields(warning),
            advice: warning.advice(),
            at: Vec::new(),
        }
    }
}

/// The fields of a warning.
fn fields(warning: &Warning) -> serde_json::Map<String, serde_json::Value> {
    match serde_json::to_value(warning.data()) {
        Ok(serde_json::Value::Object(fields)) => fields,
        other => unreachable!("the fields of warnings are plain data: {other:?}"),
    }
}
