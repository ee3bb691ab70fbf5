//! Arguments of the commands that draw points.

use std::path::PathBuf;

use clap::{ArgGroup, Args};

use crate::args::shared_args::{OUTPUT, OutputArgs, WorkArgs};
use crate::values::{MethodArg, SamplerArg, count, html_file, part, pdf_file, samples, whole};

/// A study of which points are drawn.
#[derive(Debug, Args)]
pub(crate) struct SampledArgs {
    /// The study, a .toml or .json file
    pub(crate) study: PathBuf,

    /// Analyse this characteristic only (repeatable)
    #[arg(long = "characteristic", alias = "kc", value_name = "NAME")]
    pub(crate) characteristics: Vec<String>,

    /// Use this configuration of the study
    #[arg(long, value_name = "NAME")]
    pub(crate) configuration: Option<String>,

    /// Seed of the random numbers [default: that of the study, or 1]
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true)]
    pub(crate) seed: Option<u64>,

    #[command(flatten)]
    pub(crate) work: WorkArgs,

    /// Threads that evaluate formulas and built-in models [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub(crate) threads: Option<u16>,
}

#[derive(Debug, Args)]
#[group(skip)]
#[command(group = ArgGroup::new("surrogate").args(["surrogate_control", "rare"]))]
pub(crate) struct SimulateArgs {
    #[command(flatten)]
    pub(crate) of: SampledArgs,

    /// Number of points [default: 100000, or as many as --target-error takes; with --rare 10000, of an external model 1000]; for Sobol'
    /// rounded up to 16 times a power of two
    #[arg(long, value_name = "N", value_parser = samples, allow_negative_numbers = true)]
    pub(crate) samples: Option<u64>,

    /// Kind of points: random, or sobol for scrambled Sobol' points
    #[arg(long, value_name = "SAMPLER", default_value = "random")]
    pub(crate) sampler: SamplerArg,

    /// Draw points until the standard error of every sigma (with --rare: of every probability) is below this part of it
    #[arg(long = "target-error", alias = "until", value_name = "R", value_parser = part, allow_negative_numbers = true)]
    pub(crate) until: Option<f64>,

    /// Draw points until half the 95 % interval of every yield is below this
    #[arg(long = "target-yield-error", alias = "until-yield", value_name = "R", value_parser = part, allow_negative_numbers = true)]
    pub(crate) until_yield: Option<f64>,

    /// Use the surrogate of an analysis as control variate: the same standard errors with fewer points
    #[arg(long = "control-variate", alias = "surrogate-control")]
    pub(crate) surrogate_control: bool,

    /// Sobol' indices of every input too, by exchanging inputs: n (N + 2) evaluations more for N inputs, with n = --samples [default: 16384]
    #[arg(long, conflicts_with = "rare")]
    pub(crate) sobol: bool,

    /// Most evaluations of --sobol [default: 10000 of an external model]
    #[arg(long, value_name = "N", value_parser = samples, allow_negative_numbers = true, requires = "sobol")]
    pub(crate) budget: Option<u64>,

    /// Probability beyond each limit by importance sampling
    #[arg(long, conflicts_with_all = ["surrogate_control", "until_yield", "sampler"])]
    pub(crate) rare: bool,

    /// The method of the surrogate [default: that of the study, or full to 20 dimensions and six-n beyond]
    #[arg(short, long, value_name = "METHOD", requires = "surrogate")]
    pub(crate) method: Option<MethodArg>,

    /// Number of processes that share the points; `sensitol merge` joins their sums
    #[arg(long, value_name = "K", value_parser = whole, allow_negative_numbers = true, requires = "shard", conflicts_with_all = ["rare", "sobol", "surrogate_control", "until", "until_yield", "check", "html", "pdf", "csv"])]
    pub(crate) shards: Option<u64>,

    /// Number of this process, from 1 to --shards; the output is a JSON file
    #[arg(long, value_name = "N", value_parser = whole, allow_negative_numbers = true, requires = "shards")]
    pub(crate) shard: Option<u64>,

    #[command(flatten)]
    pub(crate) report: SampleReportArgs,
}

/// Report of a sample, and the exit code that follows from it.
#[derive(Debug, Args)]
pub(crate) struct SampleReportArgs {
    /// Exit with 1 unless the sample shows that every target_yield is met
    #[arg(long)]
    pub(crate) check: bool,

    /// Write the report as one HTML page
    #[arg(long, value_name = "FILE.html", value_parser = html_file, help_heading = OUTPUT)]
    pub(crate) html: Option<PathBuf>,

    /// Print that page to a PDF by an installed Chromium
    #[arg(long, value_name = "FILE.pdf", value_parser = pdf_file, help_heading = OUTPUT, hide_short_help = true)]
    pub(crate) pdf: Option<PathBuf>,

    /// Write estimates and histogram as CSV files into DIR, which is created if missing
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub(crate) csv: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}

#[derive(Debug, Args)]
pub(crate) struct MergeArgs {
    #[command(flatten)]
    pub(crate) of: SampledArgs,

    /// Files of all shards, in any order
    #[arg(value_name = "SHARD.json", required = true)]
    pub(crate) shards: Vec<PathBuf>,

    #[command(flatten)]
    pub(crate) report: SampleReportArgs,
}

#[derive(Debug, Args)]
pub(crate) struct CompareArgs {
    #[command(flatten)]
    pub(crate) of: SampledArgs,

    /// Greatest number of evaluations of one method
    #[arg(long, value_name = "N", value_parser = count, allow_negative_numbers = true)]
    pub(crate) budget: Option<usize>,

    /// Points of the reference [default: 1048576, or 2000 of an external model]
    #[arg(long, value_name = "N", value_parser = samples, allow_negative_numbers = true)]
    pub(crate) samples: Option<u64>,

    /// Write the report as one HTML page
    #[arg(long, value_name = "FILE.html", value_parser = html_file, help_heading = OUTPUT)]
    pub(crate) html: Option<PathBuf>,

    /// Print that page to a PDF by an installed Chromium
    #[arg(long, value_name = "FILE.pdf", value_parser = pdf_file, help_heading = OUTPUT)]
    pub(crate) pdf: Option<PathBuf>,

    /// Write the table as comparison.csv into DIR, which is created if missing
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub(crate) csv: Option<PathBuf>,

    /// Draw evaluations against error
    #[arg(long, value_name = "FILE.svg", help_heading = OUTPUT)]
    pub(crate) svg: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}
