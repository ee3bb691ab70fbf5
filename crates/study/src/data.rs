//! Measured values from CSV files beside a study.

use std::collections::{HashMap, HashSet};
use std::sync::Arc;

use crate::files::{FileRole, NamedFile};
use crate::folder::{Place, UnreadableFile};
use crate::table::{DELIMITERS, NumberFault, NumberStyle, delimiter, records};
use sensitol::warning::Warning;
use sensitol_numeric::names::nearest;

/// Cells of a column with their lines.
pub(crate) type NumberedCells = Vec<(u64, String)>;

/// Cells that stand for a missing value, compared in lower case.
const MISSING: [&str; 5] = ["", "-", "na", "n/a", "nan"];

/// A file of measured values that cannot be used: file, line, column, fault, and the text to write instead.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{}{}{}: {problem}", self.file, self.line.map(|line| format!(", line {line}")).unwrap_or_default(), self.column())]
#[non_exhaustive]
pub struct DataFault {
    /// Name of the file in the study.
    pub file: String,
    /// Line in the file, from 1; None if the fault has none.
    pub line: Option<u64>,
    /// Name of the column; None if the fault has none.
    pub column: Option<String>,
    /// The fault.
    pub problem: Box<DataProblem>,
}

/// The faults of a file of measured values.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DataProblem {
    /// The file cannot be read.
    #[error("the file cannot be read: {reason}")]
    Unreadable {
        /// Message of the operating system.
        reason: String,
    },
    /// The study was given as text in memory, without this file.
    #[error("no file of this name was given with the text of the study")]
    NotGiven {
        /// The most similar name.
        nearest: Option<String>,
        /// The names that were given.
        known: Vec<String>,
    },
    /// The file is outside the folder that files of the study are read from.
    #[error("the file is outside the folder of studies")]
    Outside,
    /// The file is not text in UTF-8.
    #[error("the file is not UTF-8 text")]
    NotUtf8,
    /// The first line holds numbers instead of column names.
    #[error("the first line names the columns, but `{cell}` is a number")]
    NoHeader {
        /// First number in it.
        cell: String,
    },
    /// The file has no header line.
    #[error("the file is empty")]
    Empty,
    /// A line with another number of cells than the header.
    #[error("columns: {expected} in the header, {found} in this line")]
    Ragged {
        /// Number of cells in the line.
        found: usize,
        /// Number of cells in the header.
        expected: usize,
    },
    /// A cell that is neither a number nor empty.
    #[error("`{text}` is not a number")]
    NoNumber {
        /// Text of the cell.
        text: String,
        /// True if a decimal comma is the reason.
        comma: bool,
    },
    /// A number that is infinite or beyond the range of a double.
    #[error("`{text}` is not finite")]
    NotFinite {
        /// Text of the cell.
        text: String,
    },
    /// Decimal commas and decimal points in the same column.
    #[error("`{text}` has a decimal {}, but line {other} a {}", mark(*comma), mark(!*comma))]
    TwoMarks {
        /// Text of the cell.
        text: String,
        /// True if this cell has the comma.
        comma: bool,
        /// First line with the other mark.
        other: u64,
    },
    /// There is no such column.
    #[error("there is no column `{name}`")]
    UnknownColumn {
        /// Name of the column in the study.
        name: String,
        /// Most similar column.
        nearest: Option<String>,
        /// Columns of the file.
        known: Vec<String>,
    },
    /// Two columns with the same name.
    #[error("the column `{name}` stands twice")]
    ColumnTwice {
        /// The name.
        name: String,
    },
    /// The study names no column of a file with several, and not exactly one of them holds numbers.
    #[error("there are several columns, and the study names none")]
    WhichColumn {
        /// Columns of the file.
        known: Vec<String>,
    },
    /// A row of influence coefficients without a name of its own.
    #[error("{}", match other { Some(other) => format!("the output `{text}` stands in line {other} already"), None => "the output has no name".to_owned() })]
    OutputName {
        /// Text of the first cell.
        text: String,
        /// Line of the same name; None if the cell is empty.
        other: Option<u64>,
    },
    /// An influence coefficient that is not given.
    #[error("the cell is empty")]
    EmptyCoefficient,
    /// Too few values for a distribution.
    #[error("there are {found} values{}, and at least {least} are needed", besides(*.missing))]
    TooFew {
        /// Number of values in the column.
        found: usize,
        /// Number of cells without a value.
        missing: usize,
        /// Least permitted number of values.
        least: usize,
    },
    /// A part number that occurs twice.
    #[error("`{text}` stands in line {other} already: it joins rows of several files")]
    SerialTwice {
        /// The part number.
        text: String,
        /// Line in which it occurs first.
        other: u64,
    },
    /// All values are equal.
    #[error("all {count} values are {value}: nothing varies")]
    Constant {
        /// Number of values.
        count: usize,
        /// The value.
        value: f64,
    },
}

fn mark(comma: bool) -> &'static str {
    if comma { "comma" } else { "point" }
}

fn besides(count: usize) -> String {
    if count == 0 { String::new() } else { format!(" ({count} are missing)") }
}

impl DataFault {
    fn column(&self) -> String {
        self.column.as_ref().map(|column| format!(", column `{column}`")).unwrap_or_default()
    }
}

impl DataProblem {
    /// Advice on how to correct the data. Returns None if no general advice exists.
    pub fn help(&self) -> Option<String> {
        let columns = |known: &[String]| {
            format!("its columns are {}", known.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "))
        };
        match self {
            Self::Unreadable { .. } => Some("the path starts from the study file's folder".into()),
            Self::NotGiven { nearest: Some(name), .. } => Some(format!("did you mean `{name}`?")),
            Self::NotGiven { known, .. } => Some(format!("the files given are {}", known.join(", "))),
            Self::Outside => Some("copy it into the folder, and name it by its path from the study".into()),
            Self::NotUtf8 => Some("save it as CSV in UTF-8".into()),
            Self::NoHeader { .. } => Some("write a line with names, such as d_mm, above the values".into()),
            Self::Empty => Some("the first line names the columns, such as d_mm".into()),
            Self::Ragged { .. } => {
                Some("a decimal comma needs semicolons or tabs between the columns, a comma in text quotes".into())
            }
            Self::NoNumber { comma: true, .. } => {
                Some("decimal commas need semicolons or tabs between the columns".into())
            }
            Self::NoNumber { .. } => Some("leave a cell empty, or write NA, where nothing was measured".into()),
            Self::TwoMarks { .. } => Some("write all numbers of a column alike".into()),
            Self::UnknownColumn { nearest: Some(name), known, .. } => {
                Some(format!("did you mean `{name}`? {}", columns(known)))
            }
            Self::UnknownColumn { known, .. } => Some(columns(known)),
            Self::WhichColumn { known } => Some(format!("write column = \"...\"; {}", columns(known))),
            Self::Constant { value, .. } => Some(format!("a dimension that does not vary is {{ nominal = {value} }}")),
            Self::TooFew { .. } => {
                Some("measure more parts, or write nominal and tolerance instead of measured".into())
            }
            Self::NotFinite { .. } => Some("leave a cell empty, or write NA, where nothing was measured".into()),
            Self::SerialTwice { .. } => {
                Some("every part has a number of its own: leave one of the two rows out".into())
            }
            Self::OutputName { .. } => Some("the first column names every output once".into()),
            Self::EmptyCoefficient => Some("write 0 where an input has no influence".into()),
            Self::ColumnTwice { .. } => Some("one of the two needs another name".into()),
        }
    }
}

/// Files that the dimensions of a study read, with their warnings.
pub(super) struct Data<'s> {
    place: &'s Place,
    /// Files without duplicates, in the order of the dimensions.
    files: Vec<(NamedFile, Arc<[u8]>)>,
    pub(super) warnings: Vec<Warning>,
    /// Lines to keep of a dimension whose rows belong together with others: those in which all of them have a value.
    kept: HashMap<String, HashSet<u64>>,
}

/// One column of measured values.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) values: Vec<f64>,
    /// Line of each value.
    pub(super) lines: Vec<u64>,
    /// Lines without a value.
    pub(super) missing: Vec<u64>,
}

/// A table whose first column names the rows.
pub(super) struct Cells {
    /// Names of the columns after the first.
    pub(super) names: Vec<String>,
    /// Rows with their name and their numbers; None for an empty cell.
    pub(super) rows: Vec<(String, Vec<Option<f64>>)>,
}

impl<'s> Data<'s> {
    pub(super) fn of(place: &'s Place) -> Self {
        Self { place, files: Vec::new(), warnings: Vec::new(), kept: HashMap::new() }
    }

    /// Contents of all files that were read.
    pub(super) fn bytes(&self) -> Vec<Arc<[u8]>> {
        self.files.iter().map(|(_, bytes)| Arc::clone(bytes)).collect()
    }

    /// Names and paths of all files that were read.
    pub(super) fn files(&self) -> Vec<NamedFile> {
        self.files.iter().map(|(file, _)| file.clone()).collect()
    }

    /// A column of a file. Without a name it is the only column, or the only one with nothing but numbers.
    pub(super) fn column(&mut self, file: &str, name: Option<&str>) -> Result<Column, DataFault> {
        let table = self.table(file)?;
        let fault = |line, problem| DataFault { file: file.to_owned(), line, column: None, problem: Box::new(problem) };
        let index = table.index(name).map_err(|problem| fault(None, problem))?;
        table.numbers(index).map_err(|(line, problem)| {
            let column = Some(table.names[index].clone());
            DataFault { column, ..fault(Some(line), problem) }
        })
    }

    /// Restricts the column of a dimension to these lines.
    pub(super) fn keep(&mut self, dimension: &str, lines: HashSet<u64>) {
        self.kept.insert(dimension.to_owned(), lines);
    }

    /// Column of a dimension, without the rows in which another dimension of the same parts has no value. Without a name it is that of the
    /// dimension's own name, if the file has one.
    pub(super) fn column_of(&mut self, dimension: &str, file: &str, name: Option<&str>) -> Result<Column, DataFault> {
        let own = match name {
            Some(name) => Some(name),
            None => Some(dimension)
                .filter(|own| self.table(file).is_ok_and(|table| table.names.iter().any(|name| name == own))),
        };
        let mut column = self.column(file, own)?;
        if let Some(lines) = self.kept.get(dimension) {
            let all: Vec<(f64, u64)> = column.values.iter().copied().zip(column.lines.iter().copied()).collect();
            // The warning of a missing value belongs to the dimension that lacks it, so these rows are left out silently.
            (column.values, column.lines) = all.into_iter().filter(|(_, line)| lines.contains(line)).unzip();
        }
        Ok(column)
    }

    /// Column names of a file, and the text of one column with its lines. The column is None if the file has none of this name.
    pub(super) fn texts(&mut self, file: &str, name: &str) -> Result<(Vec<String>, Option<NumberedCells>), DataFault> {
        let table = self.table(file)?;
        let texts = table.names.iter().position(|known| known == name).map(|index| {
            table.rows.iter().map(|(line, row)| (*line, row.get(index).unwrap_or("").to_owned())).collect()
        });
        Ok((table.names, texts))
    }

    /// Cells of a file whose first column names the rows.
    pub(super) fn cells(&mut self, file: &str) -> Result<Cells, DataFault> {
        let table = self.table(file)?;
        let mut rows: Vec<(String, Vec<Option<f64>>)> =
            table.rows.iter().map(|(_, row)| (row.get(0).unwrap_or("").to_owned(), Vec::new())).collect();
        for index in 1..table.names.len() {
            let column = table.numbers(index).map_err(|(line, problem)| DataFault {
                file: file.to_owned(),
                line: Some(line),
                column: Some(table.names[index].clone()),
                problem: Box::new(problem),
            })?;
            for ((line, _), (_, cells)) in table.rows.iter().zip(&mut rows) {
                let found = column.lines.iter().position(|known| known == line);
                cells.push(found.map(|place| column.values[place]));
            }
        }
        Ok(Cells { names: table.names[1..].to_vec(), rows })
    }

    fn table(&mut self, file: &str) -> Result<Table, DataFault> {
        let text = self.text(file)?;
        Table::parse(&text).map_err(|(line, problem)| DataFault {
            file: file.to_owned(),
            line,
            column: None,
            problem: Box::new(problem),
        })
    }

    pub(super) fn text(&mut self, file: &str) -> Result<String, DataFault> {
        let bytes = self.read(file)?;
        let text = std::str::from_utf8(&bytes).map_err(|error| {
            let line = bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count() as u64 + 1;
            let problem = Box::new(DataProblem::NotUtf8);
            DataFault { file: file.to_owned(), line: Some(line), column: None, problem }
        })?;
        Ok(text.to_owned())
    }

    fn read(&mut self, file: &str) -> Result<Arc<[u8]>, DataFault> {
        let path = self.place.path().join(file);
        if let Some((_, bytes)) = self.files.iter().find(|(known, _)| known.path == path) {
            return Ok(Arc::clone(bytes));
        }
        let bytes = self.place.read(file).map_err(|unread| {
            let problem = Box::new(match unread {
                UnreadableFile::Failed(error) => DataProblem::Unreadable { reason: error.to_string() },
                UnreadableFile::NotGiven { known } => {
                    let nearest = nearest(file, known.iter().map(String::as_str)).map(str::to_owned);
                    DataProblem::NotGiven { nearest, known }
                }
                UnreadableFile::Outside { .. } => DataProblem::Outside,
            });
            DataFault { file: file.to_owned(), line: None, column: None, problem }
        })?;
        let named = NamedFile { role: FileRole::Measured, written: file.to_owned(), path };
        self.files.push((named, Arc::clone(&bytes)));
        Ok(bytes)
    }
}

/// A table with a header. Every row has the number of its line.
struct Table {
    names: Vec<String>,
    rows: Vec<(u64, csv::StringRecord)>,
    /// True if commas do not separate columns, so that one in a cell can only be a decimal comma.
    decimal_commas: bool,
}

impl Table {
    /// Reads CSV text. Blank lines are skipped. There is no syntax for comments.
    fn parse(text: &str) -> Result<Self, (Option<u64>, DataProblem)> {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let delimiter = delimiter(text, DELIMITERS);
        let mut rows = records(text, delimiter);
        let Some((_, header)) = rows.next() else { return Err((None, DataProblem::Empty)) };
        let names: Vec<String> = header.iter().map(str::to_owned).collect();
        let number = |name: &&String| name.replace(',', ".").parse::<f64>().is_ok_and(f64::is_finite);
        let mut written = names.iter().filter(|name| !name.is_empty());
        if let Some(cell) = written.clone().next().filter(|_| written.all(|name| number(&name))) {
            return Err((Some(1), DataProblem::NoHeader { cell: cell.clone() }));
        }
        let rows: Vec<(u64, csv::StringRecord)> = rows.collect();
        let expected = names.len();
        if let Some((line, row)) = rows.iter().find(|(_, row)| row.len() != expected) {
            return Err((Some(*line), DataProblem::Ragged { found: row.len(), expected }));
        }
        Ok(Self { names, rows, decimal_commas: delimiter != b',' })
    }

    fn index(&self, name: Option<&str>) -> Result<usize, DataProblem> {
        let known = || self.names.iter().filter(|name| !name.is_empty()).cloned().collect::<Vec<_>>();
        let Some(name) = name else {
            let numeric = |&index: &usize| self.numbers(index).is_ok_and(|column| !column.values.is_empty());
            let mut numeric = (0..self.names.len()).filter(|_| self.names.len() > 1).filter(numeric);
            return match (self.names.len(), numeric.next(), numeric.next()) {
                (1, _, _) => Ok(0),
                (_, Some(index), None) => Ok(index),
                _ => Err(DataProblem::WhichColumn { known: known() }),
            };
        };
        let mut found = (0..self.names.len()).filter(|&index| self.names[index] == name.trim());
        match (found.next(), found.next()) {
            (Some(index), None) => Ok(index),
            (Some(_), Some(_)) => Err(DataProblem::ColumnTwice { name: name.to_owned() }),
            (None, _) => {
                let nearest = nearest(name, self.names.iter().map(String::as_str)).map(str::to_owned);
                Err(DataProblem::UnknownColumn { name: name.to_owned(), nearest, known: known() })
            }
        }
    }

    /// Numbers of a column, or the first line with a cell that is not a number.
    fn numbers(&self, index: usize) -> Result<Column, (u64, DataProblem)> {
        let name = self.names[index].clone();
        let mut column = Column { name, values: Vec::new(), lines: Vec::new(), missing: Vec::new() };
        let mut cells: Vec<(u64, &str)> = Vec::new();
        for (line, row) in &self.rows {
            let text = row.get(index).unwrap_or("");
            match MISSING.contains(&text.to_lowercase().as_str()) {
                true => column.missing.push(*line),
                false => cells.push((*line, text)),
            }
        }
        let style = NumberStyle::of(cells.iter().map(|(_, text)| *text), !self.decimal_commas);
        for (place, &(line, text)) in cells.iter().enumerate() {
            let value = style.number(place, text).map_err(|found| {
                let text = text.to_owned();
                let problem = match found {
                    NumberFault::NoNumber { comma } => DataProblem::NoNumber { text, comma },
                    NumberFault::NotFinite => DataProblem::NotFinite { text },
                    NumberFault::TwoMarks { comma, other } => {
                        DataProblem::TwoMarks { text, comma, other: cells[other].0 }
                    }
                };
                (line, problem)
            })?;
            column.values.push(value);
            column.lines.push(line);
        }
        Ok(column)
    }
}
