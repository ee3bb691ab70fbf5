//! Reports of results: a versioned value with serde, and its document for readers.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

mod allocation;
mod allocation_document;
mod analysis;
mod assembly;
mod compare;
#[cfg(test)]
mod completeness;
pub mod csv;
mod difference;
pub mod document;
mod figures;
mod head;
pub mod html;
mod inspection;
mod labels;
mod lot;
mod output_correlation;
mod overview;
mod rare;
mod reject_rate;
mod requirement;
mod sampling;
mod simulation;
mod sweep;
pub mod task;
mod to_document;
#[cfg(feature = "xlsx")]
mod xlsx;

pub use crate::analysis::analysis_document::law_text;
pub use crate::analysis::budget::budget_document;
pub use crate::analysis::budget::{Budget, BudgetRow};
pub use crate::analysis::stack::{Stack, StackNote, StackRow, StackTotal, TotalKind, stack_document};
pub use crate::document::csv::csv;
pub use crate::document::markdown::markdown;
pub use crate::document::svg::svg;
pub use crate::document::terminal::text;
pub use crate::document::{Detail, Document, Style};
pub use allocation::{AllocationReport, WrittenAnew};
pub use compare::CompareReport;
pub use csv::{CsvFile, csv_files};
pub use csv::{budget_csv_of_studies, csv_file_names, csv_tables, stack_csv, stack_csv_of_studies};
pub use difference::DifferenceReport;
pub(crate) use head::Head;
pub use lot::LotReport;
pub use rare::RareReport;
pub use simulation::SimulationReport;
pub use sweep::SweepReport;
pub use sweep::SweptReport;
pub use to_document::ToDocument;
#[cfg(feature = "xlsx")]
pub use xlsx::{AUTHOR, analyze_xlsx};

use serde::Serialize;

use crate::assembly::ReportedAssembly;
use crate::document::number::{UNKNOWN, band, significant};
use sensitol::analysis::Analysis;
use sensitol::problem::Problem;
use sensitol::warning::{Advice, Warning};
use sensitol_numeric::correlation::Pair;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::labels::Labels;
use sensitol_study::AssemblyScene;

/// Version of the JSON report's structure.
pub const SCHEMA: u32 = 2;

/// The report of an analysis, as `--json` prints it. Unknown values are null, never 0.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Report {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// The analysis.
    #[serde(flatten, serialize_with = "Analysis::serialize")]
    #[cfg_attr(feature = "schema", schemars(with = "Analysis"))]
    pub analysis: Analysis,
    /// The dimensions, in the study's order.
    pub(crate) dimensions: Vec<DimensionReport>,
    /// The dimensions that vary together.
    pub(crate) correlation: Vec<Pair>,
    /// Warnings about assumptions that fail, in the study or in the analysis.
    pub warnings: Vec<WarningReport>,
    /// Assembly in space, for pages and tables; None if the study has none.
    #[serde(skip)]
    pub(crate) assembly: Option<ReportedAssembly>,
}

/// One dimension as the analysis took it.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct DimensionReport {
    /// Name of the dimension.
    pub name: String,
    /// Unit of the dimension.
    pub unit: Option<String>,
    /// The value on the drawing.
    pub nominal: f64,
    /// Lower and upper deviation from the nominal.
    pub tolerance: Option<[f64; 2]>,
    /// The circular zone of which it is a coordinate.
    pub zone: Option<String>,
    /// The kind of its distribution; null when it does not vary.
    pub distribution: Option<&'static str>,
    /// Mean.
    pub mean: f64,
    /// Standard deviation.
    pub sigma: f64,
    /// Texts beside its name.
    #[serde(flatten)]
    pub(crate) labels: Labels,
    /// Degrees of freedom of its standard uncertainty; null if the study gives none.
    pub degrees: Option<f64>,
    /// True if only its band is known, so that its distribution stands in for any.
    #[serde(skip)]
    pub(crate) promised: bool,
}

/// A warning.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct WarningReport {
    /// The kind.
    pub code: &'static str,
    /// The characteristic concerned.
    pub characteristic: Option<String>,
    /// The dimension concerned.
    pub dimension: Option<String>,
    /// Cause and consequence.
    pub message: String,
    /// The fields of the warning.
    pub(crate) data: serde_json::Map<String, serde_json::Value>,
    /// Remedies, the most promising first.
    pub advice: Vec<Advice>,
    /// Values of the parameter of a sweep at which the warning holds.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub(crate) at: Vec<f64>,
}

/// Facts about the study that a report shows beside the analysis.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct About {
    /// Title of the study.
    pub title: Option<String>,
    /// SHA-256 of the study file.
    pub sha256: String,
    /// Warnings of the study itself.
    pub warnings: Vec<Warning>,
    /// Cells of the title block of pages: name and text.
    pub block: Vec<(&'static str, String)>,
    /// Scene of an assembly in space; None if the study has none.
    pub scene: Option<AssemblyScene>,
}

impl Report {
    /// Builds the report of an analysis, with a copy of it.
    pub fn of(problem: &Problem, analysis: &Analysis, about: About) -> Self {
        Self::keeping(problem, analysis.clone(), about)
    }

    /// Builds the report without a copy of the analysis: half a million interactions have a million names.
    pub fn keeping(problem: &Problem, analysis: Analysis, about: About) -> Self {
        Self {
            head: Head::of("analyze", &about),
            dimensions: problem.dimensions().iter().map(DimensionReport::of).collect(),
            correlation: correlation(problem),
            warnings: about.warnings.iter().chain(&analysis.warnings).map(WarningReport::of).collect(),
            analysis,
            assembly: about.scene.map(|scene| ReportedAssembly { scene, deviations: Vec::new() }),
        }
    }

    /// Drops the interactions that hardly matter. Their sum stays in the report.
    pub fn shortened(self) -> Self {
        Self { analysis: self.analysis.shortened(), ..self }
    }
}

/// Returns every correlated pair whose coefficient is not 0.
fn correlation(problem: &Problem) -> Vec<Pair> {
    let Some(correlation) = problem.correlation() else { return Vec::new() };
    let name = |&d: &usize| problem.dimensions()[d].name().to_owned();
    let members = correlation.members();
    let pairs = members.iter().enumerate().flat_map(|(i, a)| members[i + 1..].iter().map(move |b| (a, b)));
    pairs
        .map(|(a, b)| Pair { between: [name(a), name(b)], value: correlation.of(*a, *b) })
        .filter(|pair| pair.value != 0.0)
        .collect()
}

impl DimensionReport {
    /// Distribution as the study names it: `any` if only the band is known.
    pub(crate) fn kind(&self) -> Option<&'static str> {
        if self.promised { Some("any") } else { self.distribution }
    }

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
            labels: dimension.labels().clone(),
            degrees: dimension.convention().degrees,
            promised: dimension.convention().promise.is_some(),
        }
    }

    /// True if its band has deviations of different size.
    pub(crate) fn is_unequal(&self) -> bool {
        self.tolerance.is_some_and(|[lower, upper]| lower != -upper)
    }

    /// True if its mean is the middle of its band, or if it has none.
    pub(crate) fn is_centred(&self) -> bool {
        let off = |[lower, upper]: [f64; 2]| self.mean - (self.nominal + (lower + upper) / 2.0);
        self.tolerance.is_none_or(|band| off(band).abs() <= 1e-9 * (band[1] - band[0]))
    }

    /// Formats the tolerance as on drawings.
    fn tolerance(&self) -> String {
        match self.tolerance {
            Some(ends) => band(ends),
            None if self.sigma > 0.0 => format!("sigma {}", significant(self.sigma, 4)),
            None => UNKNOWN.to_owned(),
        }
    }
}

/// Code of a warning that needs no action: the printed yield is not that of the Pearson fit.
const PEARSON_DIFFERS: &str = "pearson-differs";

impl WarningReport {
    /// True if the warning needs attention. Documents state a Pearson fit that differs as a detail, because no printed figure rests on the
    /// fit then.
    pub fn asks(&self) -> bool {
        self.code != PEARSON_DIFFERS
    }

    /// Builds the report of a warning.
    pub fn of(warning: &Warning) -> Self {
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

fn fields(warning: &Warning) -> serde_json::Map<String, serde_json::Value> {
    match serde_json::to_value(warning.data()) {
        Ok(serde_json::Value::Object(fields)) => fields,
        other => unreachable!("the fields of warnings are plain data: {other:?}"),
    }
}
