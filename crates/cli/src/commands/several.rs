//! Several studies in one call: all are read before any is evaluated, and a failed study does not stop the others.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::Serialize;

use crate::args::{AnalyzeArgs, StackArg};
use crate::commands::analyze::{Beside, analyzed, printed, read};
use crate::csv::CsvFolder;
use crate::failure::{Exit, Failure};
use crate::failure_report::ErrorReport;
use crate::files::Files;
use crate::interrupt;
use crate::output::{Destination, Look, error, json};
use crate::study::ALL;
use sensitol::summary::StopReason;
use sensitol::warning::{Counted, Warning};
use sensitol_report::document::terminal::text;
use sensitol_report::{Budget, Report, Stack, budget_csv_of_studies, stack_csv_of_studies};
use sensitol_study::{Externals, Study};

/// Prints the error of one study and returns its exit code. Only an output that cannot be written ends the whole call.
pub(crate) fn outcome(study: &str, result: Result<Exit, Failure>) -> Result<Exit, Failure> {
    match result {
        Err(failure @ (Failure::ClosedPipe | Failure::Stdout(_))) => Err(failure),
        Err(failure) => {
            tell(study, &failure);
            Ok(failure.exit())
        }
        done => done,
    }
}

fn tell(study: &str, failure: &Failure) {
    if let Some(message) = failure.render_of(study) {
        error(&message);
    }
}

/// Study, or one of its configurations.
struct Asked<'a> {
    path: &'a Path,
    configuration: Option<String>,
}

/// Lists every study, or every configuration of each.
fn of_configurations<'a>(paths: &'a [PathBuf], asked: &AnalyzeArgs) -> Result<Vec<Asked<'a>>, Failure> {
    let named = asked.how.configuration.as_deref();
    let mut all = Vec::new();
    for path in paths {
        match named {
            Some(ALL) => {
                let configurations = Study::read(path)?.configurations;
                if configurations.is_empty() {
                    // Reading with the name `all` gives the error that the study has no configurations.
                    Study::read_with(path, Externals::default().with_configuration(ALL))?;
                }
                all.extend(configurations.into_iter().map(|name| Asked { path, configuration: Some(name) }));
            }
            named => all.push(Asked { path, configuration: named.map(str::to_owned) }),
        }
    }
    Ok(all)
}

/// Runs `sensitol analyze` on several studies or configurations.
pub(crate) fn analyze(paths: &[PathBuf], asked: &AnalyzeArgs, look: Look) -> Result<Exit, Failure> {
    let all = of_configurations(paths, asked)?;
    if asked.points.is_some() {
        return Err(Failure::PointsOfOne { count: all.len() });
    }
    let stems = match [&asked.csv, &asked.html, &asked.pdf, &asked.xlsx].into_iter().any(Option::is_some) {
        true => {
            let of_paths = stems(paths)?;
            let of = |one: &Asked<'_>| {
                let place = paths.iter().position(|path| path == one.path).unwrap_or(0);
                match asked.how.configuration.as_deref() {
                    Some(ALL) => format!("{}-{}", of_paths[place], one.configuration.as_deref().unwrap_or_default()),
                    _ => of_paths[place].clone(),
                }
            };
            all.iter().map(of).collect()
        }
        false => vec![String::new(); all.len()],
    };
    let name = |one: &Asked<'_>| match (&one.configuration, asked.how.configuration.as_deref()) {
        (Some(name), Some(ALL)) => format!("{} ({name})", one.path.display()),
        _ => one.path.display().to_string(),
    };
    let names: Vec<String> = all.iter().map(name).collect();
    let studies = (all.iter().zip(&names))
        .map(|(one, name)| read(one.path, one.configuration.as_deref(), asked, None, look.of(name)));
    let studies: Vec<Result<Study, Failure>> = studies.collect();
    // Every faulty study is reported before the first evaluation.
    for (name, study) in names.iter().zip(&studies) {
        if let Err(failure) = study {
            tell(name, failure);
        }
    }
    let mut files = Files::default().forced(asked.output.force);
    for (one, study) in all.iter().zip(&studies) {
        study.iter().for_each(|study| files.study(one.path, study, asked.work.journal.as_deref()));
    }
    let mut printer = Printer::open(asked, look, &mut files)?;
    let studies = open(&stems, studies, asked, &mut files)?;
    let mut exit = Exit::Done;
    for ((name, one), study) in names.iter().zip(&all).zip(studies) {
        let row = one.configuration.as_deref().filter(|_| asked.how.configuration.as_deref() == Some(ALL));
        let (study, beside) = match study {
            Ok(ready) => ready,
            Err(failure) => {
                printer.failed(name, &failure);
                exit = exit.worse(failure.exit());
                continue;
            }
        };
        if interrupt::stopped() {
            let (cause, counted) = (StopReason::Interrupted, Counted::Evaluations);
            look.of(name).warn(&Warning::Stopped { cause, limit_s: None, done: 0, planned: None, counted });
            printer.entry_of_error(name, "interrupted before it was analysed".to_owned(), Vec::new());
            exit = Exit::Interrupted;
            continue;
        }
        let shown = printer.shown;
        let result = analyzed(&study, asked, beside, None, look.of(name), |report| {
            printer.keep(row, report);
            printer.show(name, report)
        });
        // A report whose files could not be written is still printed: the study counts as shown.
        if let (Err(failure), false) = (&result, printer.shown > shown) {
            printer.failed(name, failure);
        }
        exit = exit.worse(outcome(name, result)?);
    }
    printer.finish()?;
    Ok(exit)
}

/// Returns the base names of the studies' files: the study's name, with its folder's name if several have the same. No two of them agree
/// on any file system.
fn stems(paths: &[PathBuf]) -> Result<Vec<String>, Failure> {
    let text = |part: Option<&OsStr>| part.map(|part| part.to_string_lossy().into_owned()).unwrap_or_default();
    let own: Vec<String> = paths.iter().map(|path| text(path.file_stem())).collect();
    let same = |a: &String, b: &String| a.to_lowercase() == b.to_lowercase();
    let full = |(path, stem): (&PathBuf, &String)| {
        // The path is made absolute, so that a study in the current folder has a folder's name too.
        let folder = path.canonicalize().ok().and_then(|path| Some(text(path.parent()?.file_name())));
        match own.iter().filter(|other| same(other, stem)).count() {
            1 => stem.clone(),
            _ => format!("{}-{stem}", folder.unwrap_or_default()),
        }
    };
    let stems: Vec<String> = paths.iter().zip(&own).map(full).collect();
    for (index, name) in stems.iter().enumerate() {
        if let Some(first) = stems[..index].iter().position(|other| same(other, name)) {
            let [first, second] = [first, index].map(|place| paths[place].clone());
            return Err(Failure::SameName { first, second, name: name.clone() });
        }
    }
    Ok(stems)
}

/// Study with its open files, or the error.
type Ready = Result<(Study, Beside), Failure>;

/// Opens the files of every study, so that a file that cannot be written costs no evaluation.
fn open(
    stems: &[String],
    studies: Vec<Result<Study, Failure>>,
    asked: &AnalyzeArgs,
    files: &mut Files,
) -> Result<Vec<Ready>, Failure> {
    let pages = |path: &Path| folder_of(path, "--html", ["the name of one page", "pages"], &["html", "htm"]);
    asked.html.as_deref().map(pages).transpose()?;
    let prints = |path: &Path| folder_of(path, "--pdf", ["the name of one print", "prints"], &["pdf"]);
    asked.pdf.as_deref().map(prints).transpose()?;
    let books = |path: &Path| folder_of(path, "--xlsx", ["the name of one workbook", "workbooks"], &["xlsx"]);
    asked.xlsx.as_deref().map(books).transpose()?;
    asked.csv.as_deref().map(CsvFolder::make).transpose()?;
    let of = |(stem, study): (&String, Result<Study, Failure>)| {
        let study = match study {
            Ok(study) => study,
            Err(failure) => return Ok(Err(failure)),
        };
        let tables = asked.csv.as_deref().map(|folder| folder.join(stem));
        let page = asked.html.as_deref().map(|folder| folder.join(format!("{stem}.html")));
        let print = asked.pdf.as_deref().map(|folder| folder.join(format!("{stem}.pdf")));
        let mut beside = Beside::open(files, &study, tables.as_deref(), [page.as_deref(), print.as_deref()])?;
        let workbook = asked.xlsx.as_deref().map(|folder| folder.join(format!("{stem}.xlsx")));
        beside.workbook = files.file(workbook.as_deref())?;
        Ok(Ok((study, beside)))
    };
    stems.iter().zip(studies).map(of).collect()
}

/// Creates the folder if it is missing. A name with the extension of a single file is refused, because it is probably a mistake.
fn folder_of(
    path: &Path,
    flag: &'static str,
    [one, files]: [&'static str; 2],
    endings: &[&str],
) -> Result<(), Failure> {
    if path.is_dir() {
        return Ok(());
    }
    let wrong = |what| Err(Failure::NoFolderOfPages { flag, path: path.to_owned(), what, files });
    if path.exists() {
        return wrong("a file");
    }
    if path.extension().and_then(|ending| ending.to_str()).is_some_and(|ending| endings.contains(&ending)) {
        return wrong(one);
    }
    std::fs::create_dir_all(path).map_err(|error| Failure::Unwritable { path: path.to_owned(), error })
}

/// A study in the array of reports.
#[derive(Serialize, JsonSchema)]
pub(crate) struct Entry {
    study: String,
    #[serde(flatten)]
    outcome: Outcome,
}

#[derive(Serialize, JsonSchema)]
#[serde(untagged)]
pub(crate) enum Outcome {
    Report(Box<Report>),
    Failed {
        error: String,
        /// The errors with their places.
        errors: Vec<ErrorReport>,
    },
}

/// Prints reports one by one, or collects them if the output is a single value or file.
struct Printer<'a> {
    asked: &'a AnalyzeArgs,
    look: Look<'a>,
    /// Destination of collected reports. None if reports are printed one by one.
    destination: Option<Destination>,
    text: String,
    entries: Vec<Entry>,
    stacks: Vec<(String, Vec<Stack>)>,
    budgets: Vec<(String, Vec<Budget>)>,
    /// Configurations with their reports, for the table at the end.
    rows: Vec<(String, Report)>,
    shown: usize,
}

/// Returns the format of a table that replaces the report.
fn table(asked: &AnalyzeArgs) -> Option<StackArg> {
    asked.stack.or(asked.gum)
}

impl<'a> Printer<'a> {
    fn open(asked: &'a AnalyzeArgs, look: Look<'a>, files: &mut Files) -> Result<Self, Failure> {
        let whole = asked.output.json || asked.output.output.is_some() || table(asked) == Some(StackArg::Csv);
        let destination = whole.then(|| files.output_beside_workbook(&asked.output)).transpose()?;
        let (text, entries, stacks, budgets, rows) = (String::new(), Vec::new(), Vec::new(), Vec::new(), Vec::new());
        Ok(Self { asked, look, destination, text, entries, stacks, budgets, rows, shown: 0 })
    }

    fn show(&mut self, name: &str, report: &Report) -> Result<(), Failure> {
        let first = self.shown == 0;
        self.shown += 1;
        if self.asked.output.json {
            let report = if self.look.verbose { report.clone() } else { report.clone().shortened() };
            let outcome = Outcome::Report(Box::new(report));
            self.entries.push(Entry { study: name.to_owned(), outcome });
            return Ok(());
        }
        let heading = match table(self.asked) {
            Some(StackArg::Csv) if self.asked.gum.is_some() => {
                self.budgets.push((name.to_owned(), report.budgets()));
                return Ok(());
            }
            Some(StackArg::Csv) => {
                self.stacks.push((name.to_owned(), report.stacks()));
                return Ok(());
            }
            Some(StackArg::Markdown) => format!("## `{name}`\n\n"),
            None | Some(StackArg::Text) => format!("==> {name} <==\n"),
        };
        let gap = if first { "" } else { "\n" };
        let text = format!("{gap}{heading}{}", printed(report, self.asked, self.look));
        match self.destination {
            None => Destination::Stdout.write(&text),
            Some(_) => {
                self.text += &text;
                Ok(())
            }
        }
    }

    /// Keeps the report of a configuration for its row in the table.
    fn keep(&mut self, configuration: Option<&str>, report: &Report) {
        let shown = !self.asked.output.json && table(self.asked).is_none();
        self.rows.extend(configuration.filter(|_| shown).map(|name| (name.to_owned(), report.clone())));
    }

    fn failed(&mut self, name: &str, failure: &Failure) {
        self.entry_of_error(name, failure.to_string(), ErrorReport::all(failure));
    }

    fn entry_of_error(&mut self, name: &str, error: String, errors: Vec<ErrorReport>) {
        let entry = Entry { study: name.to_owned(), outcome: Outcome::Failed { error, errors } };
        self.entries.push(entry);
    }

    /// Writes the collected output. If there is no report, an existing file stays unchanged.
    fn finish(mut self) -> Result<(), Failure> {
        if self.rows.len() > 1 {
            let rows = text(&Report::rows_of_all(&self.rows), self.look.style(&self.asked.output));
            let rows = format!("\n==> all configurations <==\n{rows}");
            match self.destination {
                None => Destination::Stdout.write(&rows)?,
                Some(_) => self.text += &rows,
            }
        }
        // Without a report an existing file stays as it is, and stdout still gets the errors.
        let errors_alone = self.asked.output.json && self.asked.output.output.is_none();
        let Some(destination) = self.destination.filter(|_| self.shown > 0 || errors_alone) else { return Ok(()) };
        destination.write(&match table(self.asked) {
            Some(StackArg::Csv) if self.asked.gum.is_some() => budget_csv_of_studies(&self.budgets),
            Some(StackArg::Csv) => stack_csv_of_studies(&self.stacks),
            _ if self.asked.output.json => json(&self.entries),
            _ => self.text,
        })
    }
}
