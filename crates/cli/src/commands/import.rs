//! `sensitol import`: a stack-up table, or the parts of a STEP file, as a study.

use std::path::{Path, PathBuf};

use clap::Args;

use crate::commands::import_step;
use crate::failure::{Exit, Failure};
use crate::output::{Destination, Look};
use crate::shared_args::OUTPUT;
use crate::table::{TableArgs, bytes, measured_of, study_of_bytes};
use sensitol_study::{Study, StudyText};

/// Heading of the options for STEP files.
const STEP: &str = "STEP files";
/// Name of the characteristic without the option.
pub(super) const DEFAULT_NAME: &str = "gap";

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// The table: .xlsx, .csv, .tsv, .txt, a list of rows in .json, or - for what stands on stdin, such as cells copied from a spreadsheet; or
    /// a part with semantic tolerances: .stp, .step or .p21
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

pub(crate) fn run(asked: &ImportArgs, look: Look) -> Result<Exit, Failure> {
    let bytes = if asked.measured { Vec::new() } else { bytes(&asked.table)? };
    if !asked.measured && import_step::is_step_file(&asked.table, &bytes) {
        return import_step::run(asked, &bytes);
    }
    let of_step = [(asked.part.is_some(), "--part"), (asked.into.is_some(), "--into"), (asked.joints, "--joints")];
    if let Some((_, option)) = of_step.into_iter().find(|(given, _)| *given) {
        let reason = format!("{option} is for STEP files, and this is a table");
        return Err(Failure::Import { path: asked.table.clone(), reason, help: None });
    }
    let destination = match &asked.output {
        Some(path) if path.exists() => return Err(Failure::Exists { path: path.clone() }),
        Some(path) => Destination::file(path)?,
        None => Destination::Stdout,
    };
    if asked.measured {
        return of_measured(asked, destination, look);
    }
    let table = study_of_bytes(&asked.table, bytes, &asked.meaning, &asked.name)?;
    // The study is parsed here, so that errors appear at the import and not at the analysis.
    let name = asked.output.as_deref().unwrap_or(Path::new("imported study")).display().to_string();
    Study::from_toml(&table.text, &name)?;
    destination.write(&table.text)?;
    look.note(&table.summary, &table.notes);
    Ok(Exit::Done)
}

/// Writes a study of measured values, with its warnings of blanks and outliers.
fn of_measured(asked: &ImportArgs, destination: Destination, look: Look) -> Result<Exit, Failure> {
    let folder = |path: &Path| path.parent().filter(|folder| !folder.as_os_str().is_empty()).map(Path::to_owned);
    let of_table = folder(&asked.table);
    let of_study = asked.output.as_deref().and_then(folder);
    // Paths in a study start from its own folder; on stdout it has none, so that it is that of the table.
    let file = match asked.output.is_none() || of_study == of_table {
        true => Path::new(asked.table.file_name().unwrap_or_default()).to_owned(),
        false => std::path::absolute(&asked.table).unwrap_or_else(|_| asked.table.clone()),
    };
    let table = measured_of(&asked.table, &file, &asked.meaning, &asked.name, asked.formula.as_deref())?;
    let name = asked.output.as_deref().unwrap_or(Path::new("imported study")).display().to_string();
    let text = StudyText::toml(name, table.text.as_str());
    let study = Study::from_text(text.in_folder(of_table.as_deref().unwrap_or(Path::new("."))))?;
    destination.write(&table.text)?;
    look.note(&table.summary, &table.notes);
    look.warn_all(&study.warnings);
    Ok(Exit::Done)
}
