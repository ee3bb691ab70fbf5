//! `sensitol import`: a stack-up table, or the parts of a STEP file, as a study.

use std::path::Path;

use crate::args::import_args::ImportArgs;
use crate::commands::import_step;
use crate::failure::{Exit, Failure};
use crate::output::{Destination, Look};
use crate::table::{bytes, failed, measured_of, study_of_bytes};
use sensitol_study::{Study, StudyText};

pub(crate) fn run(asked: &ImportArgs, look: Look) -> Result<Exit, Failure> {
    let bytes = if asked.measured { Vec::new() } else { bytes(&asked.table)? };
    if !asked.measured && import_step::is_step_file(&asked.table, &bytes) {
        return import_step::run(asked, &bytes);
    }
    let of_step = [(asked.part.is_some(), "--part"), (asked.into.is_some(), "--into"), (asked.joints, "--joints")];
    if let Some((_, option)) = of_step.into_iter().find(|(given, _)| *given) {
        let reason = format!("{option} is for STEP files, and this is a table");
        return Err(failed(&asked.table, reason, None));
    }
    let destination = asked.destination()?;
    if asked.measured {
        return of_measured(asked, destination, look);
    }
    let table = study_of_bytes(&asked.table, bytes, &asked.meaning, &asked.name)?;
    // The study is parsed here, so that errors appear at the import and not at the analysis.
    let name = asked.output.as_deref().unwrap_or(Path::new("imported study")).display().to_string();
    let text = asked.study_text(&table.text);
    Study::from_toml(&text, &name)?;
    destination.write(&text)?;
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
    let written = asked.study_text(&table.text);
    let text = StudyText::toml(name, &*written);
    let study = Study::from_text(text.in_folder(of_table.as_deref().unwrap_or(Path::new("."))))?;
    destination.write(&written)?;
    look.note(&table.summary, &table.notes);
    look.warn_all(&study.warnings);
    Ok(Exit::Done)
}
