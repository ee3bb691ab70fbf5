//! `sensitol analyze OLD NEW --compare`: two revisions of a study side by side.

use std::path::Path;

use crate::args::AnalyzeArgs;
use crate::commands::analyze::{Beside, analyzed, read};
use crate::csv::CsvFolder;
use crate::failure::{Exit, Failure};
use crate::files::Files;
use crate::output::{Look, json};
use crate::page_files::PageFiles;
use sensitol_report::csv::csv_tables;
use sensitol_report::document::terminal::text;
use sensitol_report::{DifferenceReport, Report, ToDocument};

/// Tables that `--csv` writes.
const TABLES: [&str; 3] = ["changes", "results", "contributions"];

pub(crate) fn run([old, new]: [&Path; 2], asked: &AnalyzeArgs, look: Look) -> Result<Exit, Failure> {
    let configuration = asked.how.configuration.as_deref();
    let names = [old, new].map(|path| path.display().to_string());
    let mut files = Files::default().forced(asked.output.force);
    let mut studies = Vec::new();
    for (path, name) in [old, new].into_iter().zip(&names) {
        let study = read(path, configuration, asked, None, look.of(name))?;
        files.study(path, &study, asked.work.journal.as_deref());
        studies.push(study);
    }
    let destination = files.output(&asked.output)?;
    let page = PageFiles::open(&mut files, asked.html.as_deref(), asked.pdf.as_deref())?;
    let tables: Vec<String> = TABLES.iter().map(|name| format!("{name}.csv")).collect();
    let folder: Option<CsvFolder> = files.folder(asked.csv.as_deref(), &tables)?;
    let (mut reports, mut exit): (Vec<Report>, _) = (Vec::new(), Exit::Done);
    for (study, name) in studies.iter().zip(&names) {
        // Only the difference has files. The two reports have none.
        let nothing = Beside::open(&mut files, study, None, [None, None])?;
        let ended = analyzed(study, asked, nothing, None, look.of(name), |report| {
            reports.push(report.clone());
            Ok(())
        })?;
        // `--check` applies to the newer study only: a miss of the older one does not count.
        exit = if ended == Exit::Missed && reports.len() == 1 { exit } else { exit.worse(ended) };
        if exit == Exit::Interrupted {
            return Ok(exit);
        }
    }
    let [old, new] = &reports[..] else { return Ok(exit) };
    let difference = DifferenceReport::of([old, new], names);
    let document = difference.document();
    destination.write(&match asked.output.json {
        true => json(&difference),
        false => text(&document, look.style(&asked.output)),
    })?;
    folder.map_or(Ok(()), |folder| folder.write(&csv_tables(&document, &TABLES)))?;
    page.write(|| difference.html())?;
    Ok(exit)
}
