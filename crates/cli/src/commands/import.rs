//! `sensitol import`: a stack-up table as a study.

use std::io::Read;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::failure::{Exit, Failure};
use crate::output::Destination;
use crate::shared_args::OUTPUT;
use sensitol_numeric::names::nearest;
use sensitol_study::Study;
use sensitol_study::import::{
    ColumnRole, ImportFault, ImportProblem, ROLES, Sheet, WorkbookFault, has_header, import, is_workbook, named,
    workbook,
};

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// The table: .xlsx, .csv, .tsv or .txt, or - for what stands on stdin, such as cells copied from a spreadsheet
    pub(crate) table: PathBuf,

    /// The header of a column in the table's own words, such as nominal=Wert; of name, part, description, drawing, revision, feature, direction, factor, nominal, upper,
    /// lower, minus, tolerance, unit, distribution, cp and sigma (repeatable)
    #[arg(long, value_name = "ROLE=HEADER", value_parser = column)]
    pub(crate) column: Vec<(ColumnRole, String)>,

    /// The sheet of a workbook; without it the first one whose columns are known
    #[arg(long, value_name = "NAME")]
    pub(crate) sheet: Option<String>,

    /// The name of the characteristic that the dimensions add up to
    #[arg(long, value_name = "NAME", default_value = "gap")]
    pub(crate) name: String,

    /// Write to a file instead of stdout; an existing file is never overwritten
    #[arg(short, long, value_name = "FILE", help_heading = OUTPUT)]
    pub(crate) output: Option<PathBuf>,
}

fn column(text: &str) -> Result<(ColumnRole, String), String> {
    let Some((role, header)) = text.split_once('=') else {
        return Err("write a role and a header, such as nominal=Nennmaß".to_owned());
    };
    let found = named(role.trim()).ok_or_else(|| {
        let known = ROLES.map(|(_, name, _)| name);
        let meant = nearest(role, known).map(|name| format!("did you mean `{name}`? ")).unwrap_or_default();
        format!("{meant}the roles are {}", known.join(", "))
    })?;
    Ok((found, header.trim().to_owned()))
}

pub(crate) fn run(asked: &ImportArgs) -> Result<Exit, Failure> {
    let destination = match &asked.output {
        Some(path) if path.exists() => return Err(Failure::Exists { path: path.clone() }),
        Some(path) => Destination::file(path)?,
        None => Destination::Stdout,
    };
    let (of_book, sheet) = sheet(asked)?;
    let imported = import(&sheet, &asked.column, &asked.name).map_err(|fault: ImportFault| Failure::Import {
        path: asked.table.clone(),
        reason: fault.to_string(),
        help: fault.problem.help().map(|help| match fault.problem {
            ImportProblem::NoHeader => format!("{help}; or --column nominal=HEADER"),
            _ => help,
        }),
    })?;
    let from = match asked.table.to_str() {
        Some("-") | None => "a table".to_owned(),
        Some(_) => asked.table.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    };
    let mut text = format!(
        "# Imported from {from}{}. Limits of the characteristic are not in the table: write lower, upper or both.\n",
        of_book.map(|name| format!(", sheet {}", one_line(&name))).unwrap_or_default()
    );
    imported.notes.iter().for_each(|note| text += &format!("# {}\n", one_line(note)));
    text += "\n";
    text += &imported.study;
    // The study is parsed here, so that errors appear at the import and not at the analysis.
    Study::from_toml(&text, &asked.output.as_deref().unwrap_or(Path::new("imported study")).display().to_string())?;
    destination.write(&text)?;
    Ok(Exit::Done)
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Reads the table, and the name of its sheet if it is in a workbook.
fn sheet(asked: &ImportArgs) -> Result<(Option<String>, Sheet), Failure> {
    let failed = |reason: String, help: Option<String>| Failure::Import { path: asked.table.clone(), reason, help };
    let mut bytes = Vec::new();
    let read = match asked.table.to_str() {
        Some("-") => std::io::stdin().lock().read_to_end(&mut bytes).map(|_| ()),
        _ => std::fs::read(&asked.table).map(|all| bytes = all),
    };
    read.map_err(|error| failed(error.to_string(), None))?;
    if is_workbook(&bytes) {
        let fits = |sheet: &Sheet| has_header(sheet, &asked.column);
        let found = workbook(bytes, asked.sheet.as_deref(), fits);
        return found
            .map(|(name, sheet)| (Some(name), sheet))
            .map_err(|fault: WorkbookFault| failed(fault.to_string(), fault.help()));
    }
    if asked.sheet.is_some() {
        return Err(failed("--sheet is for workbooks, and this is a table of text".to_owned(), None));
    }
    let text = String::from_utf8(bytes).map_err(|_| {
        let help = "save it as .xlsx or as CSV in UTF-8, or copy the cells and paste them into `sensitol import -`";
        failed("it is neither a workbook nor text in UTF-8".to_owned(), Some(help.to_owned()))
    })?;
    Ok((None, Sheet::of_text(&text)))
}
