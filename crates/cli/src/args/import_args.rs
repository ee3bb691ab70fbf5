//! Options of `sensitol import`.

use std::borrow::Cow;
use std::path::PathBuf;

use clap::Args;

use crate::args::shared_args::OUTPUT;
use crate::failure::Failure;
use crate::new_study::with_schema;
use crate::output::Destination;
use crate::table::TableArgs;

/// Heading of the options for STEP files.
const STEP: &str = "STEP files";
/// Name of the characteristic without the option.
pub(crate) const DEFAULT_NAME: &str = "gap";

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// The table: .xlsx, .csv, .tsv, .txt, rows in .json, or - for stdin; or a part with semantic tolerances: .stp, .step or .p21
    pub(crate) table: PathBuf,

    #[command(flatten)]
    pub(crate) meaning: TableArgs,

    /// The name of the characteristic that the dimensions add up to
    #[arg(long, value_name = "NAME", default_value = DEFAULT_NAME)]
    pub(crate) name: String,

    /// Read measured values: each column of numbers is a dimension, and the study names the table, a CSV file
    #[arg(long)]
    pub(crate) measured: bool,

    /// The formula of the characteristic of measured dimensions; without it they are added up
    #[arg(long, value_name = "FORMULA", requires = "measured")]
    pub(crate) formula: Option<String>,

    /// The name of the part of a STEP file, or of the first of several; without it the name of the product
    #[arg(long, value_name = "NAME", help_heading = STEP)]
    pub(crate) part: Option<String>,

    /// Add the parts of a STEP file to a study in TOML; a part of that name is never replaced
    #[arg(long, value_name = "FILE", conflicts_with = "output", help_heading = STEP)]
    pub(crate) into: Option<PathBuf>,

    /// Propose joints, as comments, where faces of two placed parts of a STEP file coincide
    #[arg(long, help_heading = STEP)]
    pub(crate) joints: bool,

    /// Write to a file instead of stdout; an existing file is never overwritten
    #[arg(short, long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) output: Option<PathBuf>,
}

impl ImportArgs {
    /// Returns the text of a new study. A file names its schema, and text on stdout has no folder for one.
    pub(crate) fn study_text<'t>(&self, text: &'t str) -> Cow<'t, str> {
        if self.output.is_some() { Cow::Owned(with_schema(text)) } else { Cow::Borrowed(text) }
    }

    /// Destination of a new study. An existing file is refused.
    pub(crate) fn destination(&self) -> Result<Destination, Failure> {
        match &self.output {
            Some(path) if path.exists() => Err(Failure::Exists { path: path.clone() }),
            Some(path) => Destination::file(path),
            None => Ok(Destination::Stdout),
        }
    }
}
