//! Options that several commands share.

use std::path::PathBuf;

use clap::Args;

use crate::values::{DerivativesArg, MethodArg, SensitivitiesArg, StencilArg, count, part, positive};

/// Help heading of the options on output.
pub(crate) const OUTPUT: &str = "Output";

#[derive(Debug, Args)]
pub(crate) struct StudyArgs {
    /// The study, a .toml or .json file
    pub(crate) study: PathBuf,

    #[command(flatten)]
    pub(crate) how: HowArgs,
}

/// Method and accuracy of an analysis.
#[derive(Debug, Args)]
pub(crate) struct HowArgs {
    /// The method [default: that of the study, or auto]; auto evaluates where the error of sigma falls most, until `--accuracy` is met
    #[arg(short, long, value_name = "METHOD")]
    pub(crate) method: Option<MethodArg>,

    /// Analyse this characteristic only (repeatable)
    #[arg(long = "characteristic", alias = "kc", value_name = "NAME")]
    pub(crate) characteristics: Vec<String>,

    /// Use this configuration of the study; `all`: each in turn, in allocate all at once
    #[arg(long, value_name = "NAME")]
    pub(crate) configuration: Option<String>,

    /// Target relative error of sigma, for auto [default: that of the study, or 0.01]
    #[arg(long, value_name = "R", value_parser = part, allow_negative_numbers = true)]
    pub(crate) accuracy: Option<f64>,

    /// Target error of the skewness, for auto
    #[arg(long, value_name = "E", value_parser = positive, hide_short_help = true)]
    pub(crate) accuracy_skewness: Option<f64>,

    /// Target error of the kurtosis, for auto
    #[arg(long, value_name = "E", value_parser = positive, hide_short_help = true)]
    pub(crate) accuracy_kurtosis: Option<f64>,

    /// Target error of the yield, a share such as 1e-5, for auto
    #[arg(long, value_name = "E", value_parser = part, allow_negative_numbers = true, hide_short_help = true)]
    pub(crate) accuracy_yield: Option<f64>,

    /// Evaluate the model at most N times; unless given, a method that needs more than 1000000 is refused
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    pub(crate) budget: Option<usize>,

    /// Evaluate at K sigma on either side instead of at the nodes that suit each distribution
    #[arg(long, value_name = "K", value_parser = positive, hide_short_help = true)]
    pub(crate) step: Option<f64>,

    /// The interactions that six-n examines: strongest, adjacent, or A:B,C:D (names with : or , in backquotes)
    #[arg(long, value_name = "PAIRS", hide_short_help = true)]
    pub(crate) pairs: Option<String>,

    /// Stencil of an interaction in six-n: two-point, or four-point as in the papers
    #[arg(long, value_name = "STENCIL", hide_short_help = true)]
    pub(crate) stencil: Option<StencilArg>,

    /// Nodes of the quadrature rules of dimension-reduction, univariate or bivariate: 3, 5 or 7 [default: 5]
    #[arg(long, value_name = "M", hide_short_help = true)]
    pub(crate) nodes: Option<usize>,

    /// Sensitivities of varying dimensions, or of all: two evaluations each for those without tolerance
    #[arg(long, value_name = "WHICH", hide_short_help = true)]
    pub(crate) sensitivities: Option<SensitivitiesArg>,

    /// Source of derivatives [default: exact sensitivities if formulas give them, moments by differences]
    #[arg(long, value_name = "SOURCE", hide_short_help = true)]
    pub(crate) derivatives: Option<DerivativesArg>,
}

/// Time limit and journal of a run.
#[derive(Debug, Args)]
pub(crate) struct WorkArgs {
    /// Stop after S seconds and report the results so far
    #[arg(long, value_name = "S", value_parser = positive)]
    pub(crate) time: Option<f64>,

    /// Keep the answers of an external model in FILE, or nowhere with `none` [default: STUDY.journal.sqlite beside the study]
    #[arg(long, value_name = "FILE")]
    pub(crate) journal: Option<PathBuf>,
}

#[derive(Debug, Args)]
pub(crate) struct OutputArgs {
    /// Print JSON
    #[arg(long, help_heading = OUTPUT)]
    pub(crate) json: bool,

    /// Write to a file instead of stdout
    #[arg(short, long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) output: Option<PathBuf>,

    /// Write over files that sensitol did not write
    #[arg(long, help_heading = OUTPUT)]
    pub(crate) force: bool,
}
