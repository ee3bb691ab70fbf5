//! `sensitol import`: a stack-up table, or the parts of a STEP file, as a study.

use std::io::Read;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::failure::{Exit, Failure};
use crate::output::Destination;
use crate::shared_args::OUTPUT;
use sensitol_numeric::names::nearest;
use sensitol_study::Study;
use sensitol_study::import::{
    ColumnRole, ImportFault, ImportProblem, ROLES, Sheet, StepImportFault, StepRequest, WorkbookFault, has_header,
    import, is_step, is_workbook, named, step_into, step_study, workbook,
};

#[derive(Debug, Args)]
pub(crate) struct ImportArgs {
    /// The table: .xlsx, .csv, .tsv or .txt, or - for what stands on stdin, such as cells copied from a spreadsheet; or a part with semantic
    /// tolerances: .stp, .step or .p21
    pub(crate) table: PathBuf,

    /// The header of a column in the table's own words, such as nominal=Wert; of name, part, description, drawing, revision, feature, direction, factor, nominal, upper,
    /// lower, minus, tolerance, unit, distribution, cp and sigma (repeatable)
    #[arg(long, value_name = "ROLE=HEADER", value_parser = column)]
    pub(crate) column: Vec<(ColumnRole, String)>,

    /// The sheet of a workbook; without it the first one whose columns are known
    #[arg(long, value_name = "NAME")]
    pub(crate) sheet: Option<String>,

    /// The name of the characteristic that the dimensions add up to
    #[arg(long, value_name = "NAME", default_value = DEFAULT_NAME)]
    pub(crate) name: String,

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

/// Heading of the options for STEP files.
const STEP: &str = "STEP files";
/// Ends of names of STEP files, also of packed ones, which are refused with a reason.
const STEP_ENDS: [&str; 7] = [".stp", ".step", ".p21", ".stpz", ".stp.gz", ".step.gz", ".p21.gz"];
/// Name of the characteristic without the option.
const DEFAULT_NAME: &str = "gap";

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
    let name = asked.table.to_string_lossy().to_lowercase();
    let bytes = read(asked)?;
    if STEP_ENDS.iter().any(|end| name.ends_with(end)) || is_step(&bytes) {
        return step(asked, &bytes);
    }
    for (given, option) in
        [(asked.part.is_some(), "--part"), (asked.into.is_some(), "--into"), (asked.joints, "--joints")]
    {
        if given {
            return Err(failed(asked, format!("{option} is for STEP files, and this is a table"), None));
        }
    }
    table(asked, bytes)
}

/// Imports a table.
fn table(asked: &ImportArgs, bytes: Vec<u8>) -> Result<Exit, Failure> {
    let destination = match &asked.output {
        Some(path) if path.exists() => return Err(Failure::Exists { path: path.clone() }),
        Some(path) => Destination::file(path)?,
        None => Destination::Stdout,
    };
    let (of_book, sheet) = sheet(asked, bytes)?;
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

/// Imports the parts of a STEP file.
fn step(asked: &ImportArgs, bytes: &[u8]) -> Result<Exit, Failure> {
    let table_options = [
        (!asked.column.is_empty(), "--column"),
        (asked.sheet.is_some(), "--sheet"),
        (asked.name != DEFAULT_NAME, "--name"),
    ];
    if let Some((_, option)) = table_options.into_iter().find(|(given, _)| *given) {
        return Err(failed(asked, format!("{option} is for tables, and this is a STEP file"), None));
    }
    let file = match asked.table.to_str() {
        Some("-") | None => "a STEP file".to_owned(),
        Some(_) => asked.table.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    };
    let next = [
        "Next: add the other parts with `sensitol import PART.stp --into THIS.toml`, then write [joints] and [characteristics].",
        "Until a joint holds every part, `sensitol check` tells which part has none.",
    ];
    let request =
        StepRequest { file, part: asked.part.clone(), joints: asked.joints, next: next.map(str::to_owned).to_vec() };
    let refused = |fault: StepImportFault| {
        let help = fault.is_of_name().then(|| "choose another name: --part NAME".to_owned());
        match fault {
            StepImportFault::Target(reason) => {
                Failure::Import { path: asked.into.clone().unwrap_or_default(), reason, help }
            }
            fault => failed(asked, fault.to_string(), help),
        }
    };
    let (destination, imported) = match &asked.into {
        Some(into) => {
            let unread = |error: std::io::Error| Failure::Import {
                path: into.clone(),
                reason: error.to_string(),
                help: Some("the option --into takes a study that is there; -o writes a new one".to_owned()),
            };
            let study = std::fs::read_to_string(into).map_err(unread)?;
            (Destination::file(into)?, step_into(bytes, &request, &study).map_err(refused)?)
        }
        None => {
            let destination = match &asked.output {
                Some(path) if path.exists() => return Err(Failure::Exists { path: path.clone() }),
                Some(path) => Destination::file(path)?,
                None => Destination::Stdout,
            };
            (destination, step_study(bytes, &request).map_err(refused)?)
        }
    };
    let says = asked.output.is_some() || asked.into.is_some();
    destination.write(&imported.text)?;
    if says {
        let parts = imported.parts.iter().map(|part| format!("[parts.{part}]")).collect::<Vec<_>>().join(", ");
        Destination::Stdout.write(&format!("{parts}\n{}\n", imported.summary))?;
    }
    Ok(Exit::Done)
}

fn failed(asked: &ImportArgs, reason: String, help: Option<String>) -> Failure {
    Failure::Import { path: asked.table.clone(), reason, help }
}

/// Bytes of the file, or of stdin.
fn read(asked: &ImportArgs) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let read = match asked.table.to_str() {
        Some("-") => std::io::stdin().lock().read_to_end(&mut bytes).map(|_| ()),
        _ => std::fs::read(&asked.table).map(|all| bytes = all),
    };
    read.map_err(|error| failed(asked, error.to_string(), None))?;
    Ok(bytes)
}

/// Reads the table, and the name of its sheet if it is in a workbook.
fn sheet(asked: &ImportArgs, bytes: Vec<u8>) -> Result<(Option<String>, Sheet), Failure> {
    let failed = |reason: String, help: Option<String>| failed(asked, reason, help);
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
