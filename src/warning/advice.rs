//! Actions advised by a warning or an error.

use std::fmt;

use serde::Serialize;

use crate::method_kind::Method;

/// Action advised by a warning or an error.
///
/// Every front end shows it in its own words: the command line as options, a page as sentences, JSON as `{ "action": ... }` with the
/// fields. `Display` writes a plain sentence without the name of any option.
///
/// ```
/// use sensitol::Method;
/// use sensitol::warning::Advice;
/// let advice = Advice::UseMethod { methods: vec![Method::Full] };
/// assert_eq!(advice.to_string(), "Use the method `full`.");
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "action", rename_all = "kebab-case")]
#[non_exhaustive]
pub enum Advice {
    /// Analyse with one of these methods, the best first.
    UseMethod {
        /// The methods, the best first.
        #[cfg_attr(feature = "schema", schemars(with = "Vec<String>"))]
        methods: Vec<Method>,
    },
    /// Allow more evaluations.
    RaiseBudget,
    /// Check nominal values and limits.
    CheckLimits,
    /// Allow the number of evaluations that is needed.
    SetBudget,
    /// Allow more time.
    RaiseTimeLimit,
    /// Limit the time.
    LimitTime,
    /// Sample the model itself (Monte Carlo).
    Sample {
        /// The number of points. None if the usual number suffices.
        points: Option<u64>,
    },
    /// Sample the model by importance sampling, for small probabilities.
    SampleRareEvents,
    /// Sample the model without importance sampling.
    SamplePlainly,
    /// Draw more points.
    MorePoints,
    /// Analyse the study: its sample covers the tails.
    Analyze,
    /// Take differences over a shorter step.
    SmallerStep {
        /// The dimension with the shorter step. None for all.
        dimension: Option<String>,
    },
    /// Take derivatives from differences of evaluated points.
    UseDifferences,
    /// Examine dimensions without tolerance too.
    IncludeFixedDimensions,
    /// Leave the correlation of dimensions out of the study.
    LeaveOutCorrelation,
    /// Replace the model by a formula.
    UseFormula,

    /// Look for wrong names in the formulas, or leave the unused ones out.
    CheckNames,
    /// Convert units within the formula, or correct them.
    CheckUnits,
    /// Write a direction at random as two dimensions on a rim.
    WriteDirectionAsRim,
    /// Check the nominal dimensions.
    CheckNominal,
    /// Check whether the mechanism is at a dead centre.
    CheckPosition,
    /// Check that the model uses its inputs.
    CheckInputs,
    /// Check whether the model changes its configuration.
    CheckConfiguration,
    /// Check the moments that the study gives for a dimension.
    CheckMoments,
    /// Check column and unit of measured values.
    CheckColumn,
    /// Find out why values are missing.
    FindMissingValues,
    /// Remove values that were measured wrongly.
    RemoveWrongValues,
    /// Measure more parts.
    MeasureMore {
        /// The total number of parts.
        values: usize,
    },
    /// Measure with a finer resolution.
    MeasureFiner,
    /// Let the model return a value at the points without one, or count such assemblies as rejects.
    RepairModel,
    /// Read the stderr output of the model's processes.
    ReadModelLog,
    /// Name every file that the model's answers depend on.
    NameModelFiles,
    /// Keep the model defined around the means.
    KeepDefined,
    /// Reset the external model before every point.
    ResetModel,
    /// Run again with the journal, which has the answers so far.
    RunAgain,
    /// Let the model return a signed measure.
    SignedMeasure,
    /// Measure from a nearer datum.
    NearerDatum,
    /// Choose a larger unit, so that the values are smaller.
    LargerUnit,
    /// Choose units in which values are of ordinary size.
    OrdinaryUnit,
    /// Solve the model with a tighter tolerance.
    TightenSolver,
    /// Define a characteristic for each branch of the model.
    SplitBranches,
    /// Let the model return the two components of a distance or an angle, and write their length as a formula.
    ReturnComponents,

    /// Choose the nearest class of ISO 286, and write classes as processes.
    NearestFit,
    /// Require a higher yield, or a Cpk.
    RequireMore,
    /// Analyse the study that the allocation writes.
    AnalyzeWrittenStudy,
    /// Write costs into the study.
    WriteCosts,
    /// Name dimensions whose nominal values may move.
    NameMovableDimensions,

    /// Write the points without an answer into a file.
    WriteMissingPoints,
    /// Add the answers of the written points to the table of answers, and run again.
    AppendAnswers {
        /// The file of the written points.
        file: String,
    },
    /// Analyse with the answers of the first stage, which gives the points of the next.
    AnalyzeStages,
    /// Change the table of tolerances in the study by hand.
    EditStudy,
}

impl fmt::Display for Advice {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::UseMethod { methods } => {
                let names: Vec<String> = methods.iter().map(|method| format!("`{method}`")).collect();
                return write!(f, "Use the method {}.", names.join(" or "));
            }
            Self::Sample { points: Some(points) } => return write!(f, "Sample the model at {points} points."),
            Self::SmallerStep { dimension: Some(name) } => return write!(f, "Give `{name}` a smaller step."),
            Self::MeasureMore { values } => return write!(f, "Measure at least {values} parts."),
            Self::AppendAnswers { file } => {
                return write!(f, "Append the answers to the points of {file}, and run again.");
            }
            Self::RaiseBudget => "Allow more evaluations.",
            Self::CheckLimits => "Check nominal value and limits.",
            Self::SetBudget => "Allow that many evaluations.",
            Self::RaiseTimeLimit => "Allow more time.",
            Self::LimitTime => "Set a time limit.",
            Self::Sample { points: None } => "Sample the model itself (Monte Carlo).",
            Self::SampleRareEvents => "Sample the model by importance sampling.",
            Self::SamplePlainly => "Sample without importance sampling.",
            Self::MorePoints => "Draw more points.",
            Self::Analyze => "Analyse the study, which samples the tails by themselves.",
            Self::SmallerStep { dimension: None } => "Use a smaller step.",
            Self::UseDifferences => "Take derivatives from differences.",
            Self::IncludeFixedDimensions => "Ask for the sensitivities of all dimensions.",
            Self::LeaveOutCorrelation => {
                "Leave `[[correlation]]` or `[[joint]]` out, or write `joint = false`, to see the interval."
            }
            Self::UseFormula => "Replace the model by a formula.",
            Self::CheckNames => "Look for a wrong name in the formulas, or leave the unused ones out.",
            Self::CheckUnits => {
                "Convert in the formula (`deg` is pi/180, `25.4[mm/in]` a factor with a unit), or correct a unit."
            }
            Self::WriteDirectionAsRim => "Write the direction as two dimensions with `[[joint]] law = \"rim\"`.",
            Self::CheckNominal => "Check the nominal dimensions.",
            Self::CheckPosition => "Check whether the mechanism is at a dead centre.",
            Self::CheckInputs => "Check that the model uses the dimensions.",
            Self::CheckConfiguration => "Check whether the model changes its configuration.",
            Self::CheckMoments => "Check for rounded `moments` of a dimension.",
            Self::CheckColumn => "Check column and unit.",
            Self::FindMissingValues => "Find out why they are missing: these may be the bad parts.",
            Self::RemoveWrongValues => "Remove values that were measured wrongly, and keep the others.",
            Self::MeasureFiner => "Measure with a finer resolution.",
            Self::RepairModel => "Let the model return a value there, or find out whether such assemblies are rejects.",
            Self::ReadModelLog => "Read all that the model writes to stderr.",
            Self::NameModelFiles => "Name every file that the answers depend on in `files` of `[model]`.",
            Self::KeepDefined => "Keep the model defined around the means.",
            Self::ResetModel => "Reset the model before every point.",
            Self::RunAgain => "Run it again: it continues with the answers in the journal.",
            Self::SignedMeasure => "Let the model return a signed measure.",
            Self::NearerDatum => "Measure the characteristic from a nearer datum.",
            Self::LargerUnit => "Choose a larger unit, so that the values are smaller.",
            Self::OrdinaryUnit => "Choose units in which the values are of ordinary size.",
            Self::TightenSolver => "Solve the model with a tighter tolerance.",
            Self::ReturnComponents => {
                "Let the model return the two components, and write the characteristic as a formula: hypot(x, y)."
            }
            Self::SplitBranches => "Give each branch a characteristic of its own.",
            Self::NearestFit => "Choose the nearest class, and write classes as processes where one is required.",
            Self::RequireMore => "Require more than is needed, and confirm again.",
            Self::AnalyzeWrittenStudy => "Analyse the study with the new tolerances.",
            Self::WriteCosts => "Write the costs of tolerances below `[costs]`.",
            Self::NameMovableDimensions => "Name dimensions whose nominal values may move.",
            Self::WriteMissingPoints => "Write the missing points into a file.",
            Self::AnalyzeStages => "Analyse with the answers to these points to get the next ones.",
            Self::EditStudy => "Change the tolerances in the study by hand.",
        })
    }
}
