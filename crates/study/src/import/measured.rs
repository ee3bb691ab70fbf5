//! Measured tables: a column for each dimension, a row for each part or assembly.

use crate::import::columns::{ColumnRole, Heading, heading, plain, unit_of};
use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::sheet::{Content, Sheet, address};
use crate::import::stack::{ImportOptions, Imported};
use crate::import::study_text::{Target, characteristics, head};
use crate::import::tolerance::is_number;
use crate::write::{inline, name as key, quoted};
use sensitol::assembly::formula::is_plain;

/// Cells that stand for a missing value, compared in lower case, as files of measured values have them.
const MISSING: [&str; 4] = ["-", "na", "n/a", "nan"];
/// Headers of columns with the number of a part.
const SERIALS: [&str; 8] = ["serial", "serial no", "sn", "part no", "part id", "teilenummer", "seriennummer", "id"];

/// Headers of columns with the number of a part, where the numbers are whole and rise by 1. Other numbers are measured values of the part.
const COUNTED: [&str; 15] = [
    "part",
    "part number",
    "part nr",
    "item",
    "component",
    "sample",
    "teil",
    "teile",
    "teil nr",
    "teile nr",
    "teilenr",
    "bauteil",
    "bauteil nr",
    "bauteilnr",
    "probe",
];

/// A column of measured values.
struct MeasuredColumn {
    name: String,
    unit: Option<String>,
    blanks: usize,
}

/// Reads a table of measured values. The study names the file as `file`. Each column of numbers is a dimension, and the characteristic
/// adds them up unless `formula` says otherwise.
///
/// # Errors
/// Fails if the first row holds no names, or if no column holds numbers.
pub fn measured(
    sheet: &Sheet,
    file: &str,
    formula: Option<&str>,
    options: &ImportOptions,
) -> Result<Imported, ImportFault> {
    let none = |problem| ImportFault { cell: None, problem };
    let Some(((line, header), rows)) = sheet.rows.split_first() else { return Err(none(ImportProblem::Empty)) };
    let (mut columns, mut left_out) = (Vec::new(), Vec::new());
    for (place, cell) in header.iter().enumerate() {
        let Content::Text(name) = cell else {
            if rows.iter().any(|(_, row)| row.get(place).is_some_and(|cell| *cell != Content::Empty)) {
                return Err(ImportFault::of(address(*line, place), ImportProblem::NumbersWithoutHeader));
            }
            continue;
        };
        if is_number(name) {
            return Err(ImportFault::of(address(*line, place), ImportProblem::NoNames));
        }
        match column(name, place, rows) {
            Some(column) if !is_left_out(name, cell, options) && !counts_parts(name, place, rows, options) => {
                columns.push(column);
            }
            _ => left_out.push(name.clone()),
        }
    }
    if columns.is_empty() {
        return Err(none(ImportProblem::NoMeasured));
    }
    let mut notes = Vec::new();
    if !left_out.is_empty() {
        notes.push(format!("columns without measured values were left out: {}", left_out.join(", ")));
    }
    if columns.len() > 1 {
        notes.push(
            "values of one row are taken as those of one assembly: joint = false where they are of other parts"
                .to_owned(),
        );
    }
    let units: Vec<&String> = columns.iter().filter_map(|column| column.unit.as_ref()).collect();
    let alike = units.len() == columns.len() && units.iter().all(|unit| *unit == units[0]);
    let unit = units.first().filter(|_| alike).map(|unit| unit.as_str());
    if formula.is_none() && columns.len() > 1 {
        notes.push("no formula is given: all dimensions are added".to_owned());
    }
    let formula = formula.map_or_else(|| sum(&columns), str::to_owned);
    let target = Target {
        name: options.name.clone(),
        lower: options.lower,
        upper: options.upper,
        target_yield: options.target_yield,
    };
    let mut study = head(options.title.as_deref(), &[]);
    study += "[dimensions]\n";
    for column in &columns {
        let mut pairs = vec![format!("measured = {}", quoted(file)), format!("column = {}", quoted(&column.name))];
        pairs.extend(column.unit.as_ref().map(|unit| format!("unit = {}", quoted(unit))));
        study += &format!("{} = {}\n", key(&plain_name(&column.name)), inline(pairs));
    }
    study += &characteristics(&target, &formula, unit);
    let blanks: Vec<String> = (columns.iter().filter(|column| column.blanks > 0))
        .map(|column| format!("{} of {} blank in `{}`", column.blanks, rows.len(), column.name))
        .collect();
    let blanks = if blanks.is_empty() { "no blanks".to_owned() } else { blanks.join(", ") };
    let summary = format!("{} rows, {} measured dimensions, {blanks}", rows.len(), columns.len());
    let has_limits = options.lower.is_some() || options.upper.is_some();
    Ok(Imported { study, summary, notes, has_limits })
}

/// True for a column that holds numbers of rows or of parts, or that the user leaves out.
fn is_left_out(name: &str, cell: &Content, options: &ImportOptions) -> bool {
    let given = options.columns.iter().find(|(_, header)| header == name.trim()).map(|(role, _)| *role);
    let own = || matches!(heading(cell), Some((Heading::Role(ColumnRole::Ignore), _)));
    given == Some(ColumnRole::Ignore)
        || given.is_none() && (own() || SERIALS.contains(&name.trim().to_lowercase().as_str()))
}

/// True for a column that counts the parts, by its header and by whole numbers that rise by 1.
fn counts_parts(name: &str, place: usize, rows: &[(u64, Vec<Content>)], options: &ImportOptions) -> bool {
    if !COUNTED.contains(&plain(name).as_str()) || options.columns.iter().any(|(_, header)| header == name.trim()) {
        return false;
    }
    let whole = |cell: &Content| match cell {
        Content::Number { value, percent: false, .. } if value.fract() == 0.0 => Some(*value),
        Content::Text(text) => crate::table::clean(text).parse::<u32>().ok().map(f64::from),
        _ => None,
    };
    let numbers: Option<Vec<f64>> = rows.iter().map(|(_, row)| row.get(place).and_then(whole)).collect();
    numbers.is_some_and(|numbers| numbers.windows(2).all(|pair| pair[1] - pair[0] == 1.0))
}

/// Column of measured values. Returns None if a cell is neither a number nor missing, or if no cell is a number.
fn column(name: &str, place: usize, rows: &[(u64, Vec<Content>)]) -> Option<MeasuredColumn> {
    let (mut blanks, mut values) = (0, 0);
    for (_, row) in rows {
        match row.get(place).unwrap_or(&Content::Empty) {
            Content::Empty => blanks += 1,
            Content::Number { .. } => values += 1,
            Content::Text(text) if MISSING.contains(&text.to_lowercase().as_str()) => blanks += 1,
            Content::Text(text) if is_number(&crate::table::clean(text)) => values += 1,
            Content::Text(_) | Content::Date(_) | Content::Error(_) => return None,
        }
    }
    let open = name.rfind(['[', '(']).filter(|_| name.ends_with([']', ')']));
    let unit = open.and_then(|open| unit_of(name[open..].trim_matches(['[', ']', '(', ')', ' '])));
    (values > 0).then(|| MeasuredColumn { name: name.to_owned(), unit, blanks })
}

/// Name of a dimension: the header without its unit, and without backquotes, which end a name in formulas.
fn plain_name(header: &str) -> String {
    let open = header.rfind(['[', '(']).filter(|_| header.ends_with([']', ')']));
    let bare = match open {
        Some(open) if unit_of(header[open..].trim_matches(['[', ']', '(', ')', ' '])).is_some() => {
            header[..open].trim()
        }
        _ => header.trim(),
    };
    bare.replace('`', "'")
}

fn sum(columns: &[MeasuredColumn]) -> String {
    let names = columns.iter().map(|column| plain_name(&column.name));
    let names = names.map(|name| if is_plain(&name) { name } else { format!("`{name}`") });
    names.collect::<Vec<_>>().join(" + ")
}
