//! Stack-up tables that the command reads: workbooks, CSV, JSON and text from stdin.

use std::io::Read;
use std::path::{Path, PathBuf};

use clap::Args;

use crate::failure::Failure;
use crate::values::{finite, probability};
use sensitol_numeric::names::nearest;
use sensitol_study::import::{
    ColumnRole, ImportFault, ImportOptions, ImportProblem, Imported, ROLES, Sheet, WorkbookFault, has_header, import,
    is_workbook, measured, named, sheet_of, workbook,
};

/// Help heading of the options on tables.
const TABLE: &str = "Stack-up table";

/// Meaning of a stack-up table.
#[derive(Debug, Clone, Default, Args)]
pub(super) struct TableArgs {
    /// The header of a column with this role, such as nominal=Wert, or ignore=HEADER to leave a column out (repeatable); roles: name, part,
    /// description, drawing, revision, feature, direction, factor, quantity, nominal, upper, lower, minus, tolerance, plus-minus, max, min,
    /// unit, distribution, cp, cpk, sigma, sigmas, shift, ignore
    #[arg(long, value_name = "ROLE=HEADER", value_parser = column, help_heading = TABLE, hide_short_help = true)]
    pub(super) column: Vec<(ColumnRole, String)>,

    /// The sheet of a workbook [default: the first with known columns]
    #[arg(long, value_name = "NAME", help_heading = TABLE, hide_short_help = true)]
    pub(super) sheet: Option<String>,

    /// The lower limit of the characteristic, in place of that of the table
    #[arg(long, value_name = "VALUE", value_parser = finite, allow_negative_numbers = true, help_heading = TABLE, hide_short_help = true)]
    pub(super) lower: Option<f64>,

    /// The upper limit of the characteristic, in place of that of the table
    #[arg(long, value_name = "VALUE", value_parser = finite, allow_negative_numbers = true, help_heading = TABLE, hide_short_help = true)]
    pub(super) upper: Option<f64>,

    /// The yield that is required, such as 0.9973
    #[arg(long, value_name = "YIELD", value_parser = probability, allow_negative_numbers = true, help_heading = TABLE, hide_short_help = true)]
    pub(super) target_yield: Option<f64>,

    /// The title of the study, in place of that of the table
    #[arg(long, value_name = "TEXT", help_heading = TABLE, hide_short_help = true)]
    pub(super) title: Option<String>,

    /// Take dimensions without a tolerance as fixed
    #[arg(long, help_heading = TABLE, hide_short_help = true)]
    pub(super) allow_fixed: bool,
}

impl TableArgs {
    fn options(&self, name: &str) -> ImportOptions {
        ImportOptions {
            columns: self.column.clone(),
            name: name.to_owned(),
            title: self.title.clone(),
            lower: self.lower,
            upper: self.upper,
            target_yield: self.target_yield,
            allow_fixed: self.allow_fixed,
        }
    }

    /// Name of the first option that is given. Returns None if none is.
    pub(super) fn first_given(&self) -> Option<&'static str> {
        let given = [
            ("--column", !self.column.is_empty()),
            ("--sheet", self.sheet.is_some()),
            ("--lower", self.lower.is_some()),
            ("--upper", self.upper.is_some()),
            ("--target-yield", self.target_yield.is_some()),
            ("--title", self.title.is_some()),
            ("--allow-fixed", self.allow_fixed),
        ];
        given.into_iter().find(|(_, given)| *given).map(|(flag, _)| flag)
    }
}

/// A table as text of a study.
pub(super) struct TableStudy {
    /// Text of the study as TOML, with the notes of the import as comments.
    pub(super) text: String,
    /// One line on the content of the table.
    pub(super) summary: String,
    pub(super) notes: Vec<String>,
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

/// True for the name of a file that holds a table, not a study.
pub(super) fn is_table(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default().to_lowercase();
    ["xlsx", "xlsm", "csv", "tsv"].contains(&ending.as_str())
}

/// Reads a table as a study whose characteristic has this name.
pub(super) fn study_of(path: &Path, asked: &TableArgs, name: &str) -> Result<TableStudy, Failure> {
    study_of_bytes(path, bytes(path)?, asked, name)
}

/// Makes a study of the bytes of a table.
pub(super) fn study_of_bytes(
    path: &Path,
    bytes: Vec<u8>,
    asked: &TableArgs,
    name: &str,
) -> Result<TableStudy, Failure> {
    let (of_book, sheet) = sheet(path, bytes, asked)?;
    let imported = import(&sheet, &asked.options(name)).map_err(|fault| refused(path, &fault))?;
    let text = commented(path, of_book.as_deref(), &imported);
    Ok(TableStudy { text, summary: imported.summary, notes: imported.notes })
}

/// Reads a table of measured values as a study that names it `file`.
pub(super) fn measured_of(
    path: &Path,
    file: &Path,
    asked: &TableArgs,
    name: &str,
    formula: Option<&str>,
) -> Result<TableStudy, Failure> {
    let bytes = bytes(path)?;
    if is_workbook(&bytes) || path.to_str() == Some("-") {
        let help = "save the sheet as CSV in UTF-8, and name that file: the study reads it again".to_owned();
        return Err(failed(path, "--measured reads a CSV file".to_owned(), Some(help)));
    }
    let sheet = Sheet::of_text(&text(path, bytes)?);
    let file = file.display().to_string();
    let imported = measured(&sheet, &file, formula, &asked.options(name)).map_err(|fault| refused(path, &fault))?;
    let text = commented(path, None, &imported);
    Ok(TableStudy { text, summary: imported.summary, notes: imported.notes })
}

fn refused(path: &Path, fault: &ImportFault) -> Failure {
    let help = [fault.problem.help(), options_of(&fault.problem)].into_iter().flatten().collect::<Vec<_>>().join("; ");
    failed(path, fault.to_string(), Some(help).filter(|help| !help.is_empty()))
}

/// Options that end a fault. Returns None if there are none.
fn options_of(problem: &ImportProblem) -> Option<String> {
    Some(match problem {
        ImportProblem::NoHeader | ImportProblem::NoNominal { .. } => "or --column nominal=HEADER".to_owned(),
        ImportProblem::Twice { role, .. } => format!("or --column {role}=HEADER"),
        ImportProblem::LimitsOrDeviations { upper, lower } => {
            let pair = |one: &str, other: &str| format!("--column {one}=\"{upper}\" --column {other}=\"{lower}\"");
            format!("{}, {} or {}", pair("max", "min"), pair("upper", "lower"), pair("upper", "minus"))
        }
        ImportProblem::NominalOutside { text, .. } => {
            format!("--column upper=\"{text}\" for deviations, --column max=\"{text}\" if it is right")
        }
        ImportProblem::Numbers { headers } => {
            let header = &headers[0];
            format!("such as --column upper=\"{header}\" or --column ignore=\"{header}\"")
        }
        ImportProblem::WideSigma { .. } => "--column sigmas=HEADER".to_owned(),
        ImportProblem::Fixed { .. } => "or pass --allow-fixed where they do not vary".to_owned(),
        _ => return None,
    })
}

/// Study with the origin and the notes of the import as comments.
fn commented(path: &Path, of_book: Option<&str>, imported: &Imported) -> String {
    let from = file_name(path, "a table");
    let of_book = of_book.map(|name| format!(", sheet {}", one_line(name))).unwrap_or_default();
    let mut text = format!("# Imported from {from}{of_book}.");
    if !imported.has_limits {
        text += " Limits of the characteristic are not in the table: write lower, upper or both.";
    }
    text += &format!("\n# {}\n", one_line(&imported.summary));
    imported.notes.iter().for_each(|note| text += &format!("# {}\n", one_line(note)));
    text + "\n" + &imported.study
}

/// Name of a file without its folder, or these words for stdin.
pub(super) fn file_name(path: &Path, stdin: &str) -> String {
    match path.to_str() {
        Some("-") | None => stdin.to_owned(),
        Some(_) => path.file_name().unwrap_or_default().to_string_lossy().into_owned(),
    }
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Bytes of a file, or of stdin.
pub(super) fn bytes(path: &Path) -> Result<Vec<u8>, Failure> {
    let mut bytes = Vec::new();
    let read = match path.to_str() {
        Some("-") => std::io::stdin().lock().read_to_end(&mut bytes).map(|_| ()),
        _ => std::fs::read(path).map(|all| bytes = all),
    };
    read.map_err(|error| failed(path, error.to_string(), None))?;
    Ok(bytes)
}

/// Text of a table that is not a workbook.
pub(super) fn text(path: &Path, bytes: Vec<u8>) -> Result<String, Failure> {
    String::from_utf8(bytes).map_err(|_| {
        let help = "save it as .xlsx or as CSV in UTF-8, or copy the cells and paste them into `sensitol import -`";
        failed(path, "it is neither a workbook nor text in UTF-8".to_owned(), Some(help.to_owned()))
    })
}

/// Error of a file that cannot be imported.
pub(super) fn failed(path: &Path, reason: String, help: Option<String>) -> Failure {
    Failure::Import { path: PathBuf::from(path), reason, help }
}

/// Reads the table, and the name of its sheet if it is in a workbook.
fn sheet(path: &Path, bytes: Vec<u8>, asked: &TableArgs) -> Result<(Option<String>, Sheet), Failure> {
    if is_workbook(&bytes) {
        let fits = |sheet: &Sheet| has_header(sheet, &asked.column);
        let found = workbook(bytes, asked.sheet.as_deref(), fits);
        return found
            .map(|(name, sheet)| (Some(name), sheet))
            .map_err(|fault: WorkbookFault| failed(path, fault.to_string(), fault.help()));
    }
    if asked.sheet.is_some() {
        return Err(failed(path, "--sheet is for workbooks, and this is a table of text".to_owned(), None));
    }
    Ok((None, sheet_of(&text(path, bytes)?)))
}
