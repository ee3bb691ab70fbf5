//! Tables of a measured lot: a row for each part or assembly, columns by the names of dimensions and characteristics.
//!
//! A header may carry a unit, `bore [mm]`. A column of another unit than the study's is converted. Columns for lot, machine, operator and
//! time are known by their headers, in English or German. All other columns are left out and named.

mod row_time;

use self::row_time::{RowTime, in_order};
use crate::Study;
use crate::import::{Content, Sheet};
use crate::table::NumberStyle;
use sensitol::lot::{GroupKind, LotColumn, LotGrouping, LotTable};
use sensitol_numeric::names::nearest;
use sensitol_numeric::unit::Unit;

/// Cells that stand for a missing value, compared in lower case.
const MISSING: [&str; 5] = ["", "-", "na", "n/a", "nan"];
/// Headers of columns that group parts, compared in lower case.
const GROUPS: [(&str, GroupKind); 14] = [
    ("lot", GroupKind::Lot),
    ("batch", GroupKind::Lot),
    ("charge", GroupKind::Lot),
    ("los", GroupKind::Lot),
    ("machine", GroupKind::Machine),
    ("tool", GroupKind::Machine),
    ("cavity", GroupKind::Machine),
    ("maschine", GroupKind::Machine),
    ("werkzeug", GroupKind::Machine),
    ("nest", GroupKind::Machine),
    ("operator", GroupKind::Operator),
    ("inspector", GroupKind::Operator),
    ("bediener", GroupKind::Operator),
    ("prüfer", GroupKind::Operator),
];
/// Headers of the time of a row, compared in lower case.
const TIMES: [&str; 8] = ["time", "date", "datetime", "timestamp", "zeit", "datum", "uhrzeit", "date and time"];

/// A measured table, with its omitted and converted columns.
#[derive(Debug, Clone, PartialEq)]
pub struct ReadLot {
    /// Rows of the table.
    pub table: LotTable,
    /// Notes for the user.
    pub notes: Vec<String>,
}

/// Fault of a measured table.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LotTableFault {
    /// The table has no header with a row below it.
    #[error("the table needs a first row with the names of the columns, and rows of measured values below it")]
    NoRows,
    /// No column bears the name of a dimension or a characteristic.
    #[error("no column bears the name of a dimension or of a characteristic; the columns are {}", columns.join(", "))]
    NoColumn {
        /// Headers of the table.
        columns: Vec<String>,
        /// A header and the most similar name of the study, if any.
        nearest: Option<(String, String)>,
        /// Names of the study.
        known: Vec<String>,
    },
    /// A header stands twice.
    #[error("the column `{name}` stands twice")]
    LotColumnTwice {
        /// The header.
        name: String,
    },
    /// A row has more cells than the header.
    #[error("line {line} has {found} cells, and the header {expected}")]
    MoreCells {
        /// Line of the table.
        line: u64,
        /// Number of cells in it.
        found: usize,
        /// Number of cells in the header.
        expected: usize,
    },
    /// A cell is not a number.
    #[error("line {line}, column `{column}`: `{text}` is not a number")]
    NotANumber {
        /// Line of the table.
        line: u64,
        /// Header of the column.
        column: String,
        /// Text of the cell.
        text: String,
    },
    /// A time cannot be read.
    #[error("line {line}, column `{column}`: `{text}` is not a time")]
    NotATime {
        /// Line of the table.
        line: u64,
        /// Header of the column.
        column: String,
        /// Text of the cell.
        text: String,
    },
    /// Times with a date, times without one and numbers stand in one column.
    #[error("line {line}, column `{column}`: this time has another form than those above it")]
    MixedTimes {
        /// Line of the table.
        line: u64,
        /// Header of the column.
        column: String,
    },
    /// The unit of a column is not one of the same kind as that of the study.
    #[error("the column `{column}` is in {found}, and the study has {expected}")]
    LotUnit {
        /// Header of the column.
        column: String,
        /// Unit of the column.
        found: String,
        /// Unit of the study.
        expected: String,
    },
}

impl LotTableFault {
    /// Advice for the user. Returns None if there is none.
    pub fn help(&self) -> Option<String> {
        Some(match self {
            Self::NoRows => return None,
            Self::NoColumn { nearest: Some((header, name)), .. } => {
                format!("did you mean `{name}` by `{header}`? Headers are the names of the study")
            }
            Self::NoColumn { known, .. } => format!("headers are the names of the study: {}", known.join(", ")),
            Self::LotColumnTwice { .. } => "one of the two needs another name".to_owned(),
            Self::MoreCells { .. } => {
                "where commas are decimal ones, separate columns by semicolons or tabs".to_owned()
            }
            Self::NotANumber { .. } => "leave a cell empty, or write NA, where nothing was measured".to_owned(),
            Self::NotATime { .. } => {
                "times are numbers, 06:30, 06:30:15, 2026-11-28, 2026-11-28 06:30 or 28.11.2026 06:30".to_owned()
            }
            Self::MixedTimes { .. } => "write all times with a date, or all without one".to_owned(),
            Self::LotUnit { .. } => "write the column in a unit of the same kind".to_owned(),
        })
    }
}

/// Reads a measured table for a study.
///
/// # Errors
/// If a value or a time cannot be read, a name stands twice, a unit does not fit, or no column belongs to the study.
///
/// ```
/// use sensitol_study::{Study, import::Sheet, read_lot};
/// let text = "[dimensions]\na = { nominal = 10, tolerance = 0.3, unit = \"mm\" }\n[characteristics]\ny = { formula = \"2*a\" }\n";
/// let study = Study::from_toml(text, "study.toml")?;
/// let read = read_lot(&Sheet::of_text("part;a [um];machine\n1;10012,5;M1\n2;;M2\n"), &study).unwrap();
/// assert!((read.table.columns[0].values[0].unwrap() - 10.0125).abs() < 1e-12 && read.table.columns[0].values[1].is_none());
/// assert_eq!(read.table.groupings[0].labels[1].as_deref(), Some("M2"));
/// # Ok::<(), sensitol_study::StudyError>(())
/// ```
pub fn read_lot(sheet: &Sheet, study: &Study) -> Result<ReadLot, LotTableFault> {
    let Some(((_, header), rows)) = sheet.rows.split_first().filter(|(_, rows)| !rows.is_empty()) else {
        return Err(LotTableFault::NoRows);
    };
    let headers: Vec<String> = header.iter().map(|cell| cell.text().unwrap_or_default()).collect();
    if let Some(place) = (1..headers.len()).find(|&at| !headers[at].is_empty() && headers[..at].contains(&headers[at]))
    {
        return Err(LotTableFault::LotColumnTwice { name: headers[place].clone() });
    }
    if let Some((line, row)) = rows.iter().find(|(_, row)| row.len() > headers.len()) {
        return Err(LotTableFault::MoreCells { line: *line, found: row.len(), expected: headers.len() });
    }
    let (mut table, mut notes, mut left_out) = (LotTable::default(), Vec::new(), Vec::new());
    for (place, header) in headers.iter().enumerate().filter(|(_, header)| !header.is_empty()) {
        let column = Cells { header, place, rows, commas_separate: sheet.commas_separate };
        let lower = header.to_lowercase();
        let group = GROUPS.iter().find(|(name, _)| *name == lower);
        if let Some((name, unit, of_study)) = named(study, header) {
            let factor = factor(header, unit, of_study.as_deref())?;
            if factor != 1.0 {
                let to = of_study.unwrap_or_default();
                notes.push(format!("`{header}` is converted to {to}: times {factor}"));
            }
            let values = column.numbers()?.into_iter().map(|value| value.map(|value| value * factor)).collect();
            table.columns.push(LotColumn { name, values });
        } else if let Some((_, kind)) = group {
            table.groupings.push(LotGrouping { name: header.clone(), kind: *kind, labels: column.labels() });
        } else if TIMES.contains(&lower.as_str()) && table.times.is_none() {
            let (times, note) = column.times()?;
            table.times = Some(times);
            notes.extend(note);
        } else {
            left_out.push(header.clone());
        }
    }
    if table.columns.is_empty() {
        let known = names(study);
        let close = |header: &String| {
            let name = nearest(header, known.iter().map(String::as_str))?;
            Some((header.clone(), name.to_owned()))
        };
        let columns: Vec<String> = headers.iter().filter(|header| !header.is_empty()).cloned().collect();
        return Err(LotTableFault::NoColumn { nearest: columns.iter().find_map(close), columns, known });
    }
    if !left_out.is_empty() {
        notes.push(format!("columns that are not of the study were left out: {}", left_out.join(", ")));
    }
    Ok(ReadLot { table, notes })
}

/// Names of the dimensions and characteristics.
fn names(study: &Study) -> Vec<String> {
    let dimensions = study.problem.dimensions().iter().map(|one| one.name().to_owned());
    dimensions.chain(study.problem.characteristics().iter().map(|one| one.name().to_owned())).collect()
}

/// Name in the study, unit of the header and unit of the study. Returns None if the header names nothing of the study.
fn named<'h>(study: &Study, header: &'h str) -> Option<(String, Option<&'h str>, Option<String>)> {
    let of_study = |name: &str| {
        let dimension = study.problem.dimensions().iter().find(|one| one.name() == name).map(|one| one.unit());
        let characteristic = || study.problem.characteristics().iter().find(|one| one.name() == name);
        let unit = dimension.or_else(|| characteristic().map(|one| one.unit()))?;
        Some(unit.map(str::to_owned))
    };
    if let Some(unit) = of_study(header) {
        return Some((header.to_owned(), None, unit));
    }
    let (name, unit) = header.strip_suffix(']').and_then(|rest| rest.rsplit_once('['))?;
    Some((name.trim().to_owned(), Some(unit.trim()), of_study(name.trim())?))
}

/// Factor from the unit of a column to that of the study.
fn factor(header: &str, unit: Option<&str>, of_study: Option<&str>) -> Result<f64, LotTableFault> {
    let (Some(unit), Some(of_study)) = (unit, of_study) else { return Ok(1.0) };
    if unit == of_study {
        return Ok(1.0);
    }
    match (Unit::parse(unit), Unit::parse(of_study)) {
        (Some(found), Some(own)) if found.same_kind(&own) && !found.point && !own.point => Ok(found.scale / own.scale),
        _ => {
            let (column, found, expected) = (header.to_owned(), unit.to_owned(), of_study.to_owned());
            Err(LotTableFault::LotUnit { column, found, expected })
        }
    }
}

/// Cells of one column.
struct Cells<'s> {
    header: &'s str,
    place: usize,
    rows: &'s [(u64, Vec<Content>)],
    commas_separate: bool,
}

impl Cells<'_> {
    fn cells(&self) -> impl Iterator<Item = (u64, &Content)> {
        self.rows.iter().map(|(line, row)| (*line, row.get(self.place).unwrap_or(&Content::Empty)))
    }

    fn labels(&self) -> Vec<Option<String>> {
        let label = |(_, cell): (u64, &Content)| {
            cell.text()
                .map(|text| text.trim().to_owned())
                .filter(|text| !MISSING.contains(&text.to_lowercase().as_str()))
        };
        self.cells().map(label).collect()
    }

    fn numbers(&self) -> Result<Vec<Option<f64>>, LotTableFault> {
        let texts: Vec<(u64, String)> = self
            .cells()
            .filter_map(|(line, cell)| match cell {
                Content::Text(text) if !MISSING.contains(&text.to_lowercase().as_str()) => Some((line, text.clone())),
                _ => None,
            })
            .collect();
        let style = NumberStyle::of(texts.iter().map(|(_, text)| text.as_str()), self.commas_separate);
        let mut next = 0;
        let number = |(line, cell): (u64, &Content)| {
            let fault = |text: String| LotTableFault::NotANumber { line, column: self.header.to_owned(), text };
            match cell {
                Content::Empty => Ok(None),
                Content::Number { value, .. } => Ok(Some(*value)),
                Content::Text(text) if MISSING.contains(&text.to_lowercase().as_str()) => Ok(None),
                Content::Text(text) => {
                    next += 1;
                    style.number(next - 1, text).map(Some).map_err(|_| fault(text.clone()))
                }
                Content::Date(_) => Err(fault("a date".to_owned())),
                Content::Error(text) => Err(fault(text.clone())),
            }
        };
        self.cells().map(number).collect()
    }

    /// Times of the rows in order, and a note on clock times that fall.
    fn times(&self) -> Result<(Vec<Option<f64>>, Option<String>), LotTableFault> {
        let (mut times, mut first): (Vec<Option<RowTime>>, Option<RowTime>) = (Vec::new(), None);
        for (line, cell) in self.cells() {
            let fault = |text: String| LotTableFault::NotATime { line, column: self.header.to_owned(), text };
            let time = match cell {
                Content::Empty => None,
                Content::Text(text) if MISSING.contains(&text.to_lowercase().as_str()) => None,
                Content::Number { value, .. } => Some(RowTime::Number(*value)),
                Content::Text(text) => Some(RowTime::of_text(text.trim()).ok_or_else(|| fault(text.clone()))?),
                Content::Date(days) => {
                    let time = days.and_then(RowTime::of_workbook);
                    Some(time.ok_or_else(|| fault("a date of a workbook".to_owned()))?)
                }
                Content::Error(text) => return Err(fault(text.clone())),
            };
            if let Some(time) = time
                && !first.get_or_insert(time).like(time)
            {
                return Err(LotTableFault::MixedTimes { line, column: self.header.to_owned() });
            }
            times.push(time);
        }
        let (placed, falls) = in_order(&times);
        let header = self.header;
        let note = match falls {
            0 => None,
            1 => Some(format!("`{header}` has no date and falls once: the rows from there on are of the next day")),
            _ => Some(format!(
                "`{header}` has no date and falls {falls} times: all rows are taken as of one day; write the date too if they are not"
            )),
        };
        Ok((placed, note))
    }
}
