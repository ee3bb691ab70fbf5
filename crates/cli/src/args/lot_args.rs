//! Options of `sensitol compare-lot`.

use std::path::PathBuf;

use clap::Args;

use crate::args::shared_args::{OUTPUT, OutputArgs, StudyArgs, WorkArgs};
use crate::values::{html_file, part, pdf_file, samples_or_none};

#[derive(Debug, Args)]
pub(crate) struct CompareLotArgs {
    #[command(flatten)]
    pub(crate) study: StudyArgs,

    /// The lot: tables (.csv, .tsv, .xlsx) with a row for each part or assembly. Columns have the names of dimensions and characteristics;
    /// a header may have a unit, `bore [mm]`. Columns lot, machine, operator and time are known
    #[arg(value_name = "LOT", required = true)]
    pub(crate) lot: Vec<PathBuf>,

    /// Probability that any of the tests refutes a right assumption [default: 0.05]
    #[arg(long, value_name = "P", value_parser = part, allow_negative_numbers = true)]
    pub(crate) level: Option<f64>,

    /// The weight of the study in --update, in parts: 0 for none [default: 30]
    #[arg(long, value_name = "N", value_parser = samples_or_none, allow_negative_numbers = true)]
    pub(crate) assumed_parts: Option<u64>,

    /// Write the study with mean and sigma of every measured dimension, and with significant correlations; nothing else changes
    #[arg(long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) update: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) work: WorkArgs,

    /// Threads that evaluate formulas and built-in models [default: one per core]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024), hide_short_help = true)]
    pub(crate) threads: Option<u16>,

    /// Exit with 1 when an assumption is refuted
    #[arg(long)]
    pub(crate) check: bool,

    /// Write the report as one HTML page
    #[arg(long, value_name = "FILE.html", value_parser = html_file, help_heading = OUTPUT)]
    pub(crate) html: Option<PathBuf>,

    /// Print that page to a PDF by an installed Chromium
    #[arg(long, value_name = "FILE.pdf", value_parser = pdf_file, help_heading = OUTPUT)]
    pub(crate) pdf: Option<PathBuf>,

    /// Write parts, assemblies, differences and groups as CSV files into DIR, which is created if missing
    #[arg(long, value_name = "DIR", help_heading = OUTPUT)]
    pub(crate) csv: Option<PathBuf>,

    #[command(flatten)]
    pub(crate) output: OutputArgs,
}
