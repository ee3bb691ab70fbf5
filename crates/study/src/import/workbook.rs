//! Reads workbooks: the values of the cells of a sheet. Formulas give the values that were computed last.

use std::io::Cursor;

use calamine::{DataRef, Reader, SheetType, SheetVisible, Xlsx, XlsxError};

use crate::import::sheet::{Content, Sheet};
use sensitol_numeric::names::nearest;

/// Greatest number of cells of a sheet, with the empty ones before the last of each row. It bounds the memory.
const MOST: usize = 2_000_000;
/// First bytes of a zip archive, which workbooks are.
const ARCHIVE: &[u8] = b"PK\x03\x04";
/// First bytes of a compound file: the format of Excel until 2003, which also wraps encrypted workbooks.
const COMPOUND: &[u8] = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1";

/// Reasons why a workbook cannot be read.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum WorkbookFault {
    /// The workbook is encrypted.
    #[error("the workbook is protected by a password")]
    Password,
    /// The file is a spreadsheet in another format.
    #[error("the file is {what}")]
    Format {
        /// Name of the format.
        what: &'static str,
    },
    /// The file cannot be read as a workbook.
    #[error("the workbook is damaged, or the file is not a workbook: {reason}")]
    Damaged {
        /// Message of the reader.
        reason: String,
    },
    /// The workbook has no sheet of this name.
    #[error("there is no sheet `{name}`")]
    NoSheet {
        /// Name of the sheet that was requested.
        name: String,
        /// Names of the sheets.
        known: Vec<String>,
    },
    /// The workbook has no visible sheet with cells.
    #[error("the workbook has no visible sheet of cells")]
    NoCells,
    /// The sheet has more cells than are permitted.
    #[error("the sheet `{name}` is larger than {MOST} cells")]
    TooLarge {
        /// Name of the sheet.
        name: String,
    },
}

impl WorkbookFault {
    /// Advice for the user. Returns None if there is none.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::Password => "open it and save a copy without the password".to_owned(),
            Self::Format { .. } => "open it in its program and save it as .xlsx".to_owned(),
            Self::Damaged { .. } => {
                "open it in a spreadsheet and save it as .xlsx again, or save the sheet as CSV in UTF-8".to_owned()
            }
            Self::NoSheet { name, known } => {
                let meant = nearest(name, known.iter().map(String::as_str));
                let meant = meant.map(|name| format!("did you mean `{name}`? ")).unwrap_or_default();
                let known: Vec<String> = known.iter().map(|name| format!("`{name}`")).collect();
                format!("{meant}its sheets are {}", known.join(", "))
            }
            Self::NoCells => return None,
            Self::TooLarge { .. } => "copy the cells of the stack to a sheet of their own".to_owned(),
        })
    }
}

/// True if a file begins like one of a spreadsheet program.
pub fn is_workbook(bytes: &[u8]) -> bool {
    bytes.starts_with(ARCHIVE) || bytes.starts_with(COMPOUND)
}

/// A sheet with its name: the one that is requested, or else the first visible one that `fits`, or else the first visible one.
pub fn workbook(
    bytes: Vec<u8>,
    wanted: Option<&str>,
    fits: impl Fn(&Sheet) -> bool,
) -> Result<(String, Sheet), WorkbookFault> {
    let begins = |head: &[u8]| bytes.starts_with(head);
    let compound = begins(COMPOUND);
    // An OpenDocument archive holds its type in its first entry.
    let open_document = bytes.get(30..).is_some_and(|rest| rest.starts_with(b"mimetypeapplication/vnd.oasis"));
    let mut book: Xlsx<_> = Xlsx::new(Cursor::new(bytes)).map_err(|error| match error {
        XlsxError::Password => WorkbookFault::Password,
        _ if compound => WorkbookFault::Format { what: "a workbook in the format of Excel 97 to 2003, .xls" },
        _ if open_document => WorkbookFault::Format { what: "an OpenDocument spreadsheet" },
        error => damaged(&error),
    })?;
    let of_cells = |sheet: &&calamine::Sheet| sheet.typ == SheetType::WorkSheet;
    let sheets: Vec<&calamine::Sheet> = book.sheets_metadata().iter().filter(of_cells).collect();
    let known: Vec<String> = sheets.iter().map(|sheet| sheet.name.clone()).collect();
    let visible: Vec<String> = (sheets.iter())
        .filter(|sheet| sheet.visible == SheetVisible::Visible)
        .map(|sheet| sheet.name.clone())
        .collect();
    if let Some(name) = wanted {
        if !known.iter().any(|sheet| sheet == name) {
            return Err(WorkbookFault::NoSheet { name: name.to_owned(), known });
        }
        return Ok((name.to_owned(), read(&mut book, name)?));
    }
    let mut first = None;
    for name in visible {
        let sheet = read(&mut book, &name)?;
        if fits(&sheet) {
            return Ok((name, sheet));
        }
        first.get_or_insert((name, sheet));
    }
    first.ok_or(WorkbookFault::NoCells)
}

/// Reads the cells one by one. A sheet with a single cell in its last corner then takes no more memory than others.
fn read(book: &mut Xlsx<Cursor<Vec<u8>>>, name: &str) -> Result<Sheet, WorkbookFault> {
    let mut reader = book.worksheet_cells_reader(name).map_err(|error| damaged(&error))?;
    let shown: Vec<Shown> = (reader.styles().iter())
        .map(|style| style.number_format.as_ref().map_or(Shown::default(), |format| Shown::of(&format.format_code)))
        .collect();
    let (mut rows, mut size): (Vec<(u64, Vec<Content>)>, usize) = (Vec::new(), 0);
    while let Some((cell, style)) = reader.next_cell_with_style_id().map_err(|error| damaged(&error))? {
        let content = content(cell.get_value(), shown.get(style).copied().unwrap_or_default());
        if content == Content::Empty {
            continue;
        }
        let (row, column) = cell.get_position();
        let (line, column) = (u64::from(row) + 1, column as usize);
        if rows.last().is_none_or(|(last, _)| *last < line) {
            rows.push((line, Vec::new()));
        }
        // Rows that go backwards do not occur in files of spreadsheet programs, so such a cell is left out.
        let place = rows.partition_point(|(other, _)| *other < line);
        let Some((_, cells)) = rows.get_mut(place).filter(|(other, _)| *other == line) else { continue };
        if cells.len() <= column {
            size += column + 1 - cells.len();
            if size > MOST {
                return Err(WorkbookFault::TooLarge { name: name.to_owned() });
            }
            cells.resize(column + 1, Content::Empty);
        }
        cells[column] = content;
    }
    Ok(Sheet { rows, commas_separate: false })
}

/// Signs that a number format adds to a positive number.
#[derive(Debug, Clone, Copy, Default)]
struct Shown {
    percent: bool,
    plus: bool,
}

impl Shown {
    fn of(format: &str) -> Self {
        Self { percent: is_percent(format), plus: format.trim_start_matches(['"', '\\']).starts_with('+') }
    }
}

fn content(cell: &DataRef<'_>, Shown { percent, plus }: Shown) -> Content {
    let text = |text: &str| match text.trim_matches([' ', '\u{a0}', '\t', '\r', '\n']) {
        "" => Content::Empty,
        text => Content::Text(text.to_owned()),
    };
    match cell {
        DataRef::Empty => Content::Empty,
        DataRef::Int(value) => Content::Number { value: *value as f64, percent, plus },
        DataRef::Float(value) => Content::Number { value: *value, percent, plus },
        DataRef::String(found) => text(found),
        DataRef::SharedString(found) => text(found),
        DataRef::Bool(true) => Content::Text("TRUE".to_owned()),
        DataRef::Bool(false) => Content::Text("FALSE".to_owned()),
        DataRef::DateTime(date) => Content::Date(Some(date.as_f64())),
        DataRef::DateTimeIso(_) | DataRef::DurationIso(_) => Content::Date(None),
        DataRef::Error(error) => Content::Error(error.to_string()),
    }
}

/// True if a number format shows percent: it has a percent sign that is neither quoted nor escaped.
fn is_percent(format: &str) -> bool {
    let (mut quoted, mut escaped) = (false, false);
    for c in format.chars() {
        match c {
            _ if escaped => escaped = false,
            '"' => quoted = !quoted,
            '\\' | '_' | '*' if !quoted => escaped = true,
            '%' if !quoted => return true,
            _ => {}
        }
    }
    false
}

fn damaged(error: &XlsxError) -> WorkbookFault {
    let reason = error.to_string();
    WorkbookFault::Damaged { reason: reason.split_whitespace().collect::<Vec<_>>().join(" ") }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn plus_signs_are_part_of_a_format() {
        for format in ["+0.00;-0.00", "\\+0.00;\\-0.00;0", "\"+\"0.0"] {
            assert!(Shown::of(format).plus, "{format}");
        }
        assert!(!Shown::of("0.00;-0.00").plus);
    }

    #[test]
    fn percent_is_what_a_format_shows() {
        for format in ["0%", "0.00 %", "0.0%;[Red]-0.0%", "\"tol \"0%"] {
            assert!(is_percent(format), "{format}");
        }
        for format in ["General", "0.00", "0\"%\"", "0\\%", "0_%", "@"] {
            assert!(!is_percent(format), "{format}");
        }
    }
}
