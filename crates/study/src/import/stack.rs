//! Reads the rows of a stack-up table and writes a study from them.

use std::collections::{HashMap, HashSet};

use crate::import::columns::ColumnRole;
use crate::import::fault::{ImportFault, ImportProblem, NAMED};
use crate::import::figures::Figures;
use crate::import::header::{Header, header};
use crate::import::limits::LimitRows;
use crate::import::row::{Read, Row, is_dimension, name, row};
use crate::import::sheet::{Content, Sheet};
use crate::import::spread::{Band, LimitReading, Spread, limit_reading, refuse_mixed_signs, same_limits, spread};
use crate::import::study_text::{Part, Target, characteristics, dimensions, head, sum};
use crate::import::title::TitleRows;
use crate::import::words::{is_subtotal, is_total, names_both_limits};
use sensitol_numeric::names::first_of;

/// Greatest number of equal parts of a row: more are a typing error.
const MOST_EQUAL: f64 = 1000.0;
/// Difference of a total from the sum of its rows, in parts of the largest nominal value: rounding errors of a spreadsheet.
const SUM_ERROR: f64 = 1e-6;
/// Difference of limits from the worst case of the rows, in parts of the worst case: rounding errors of a spreadsheet.
const WORST_CASE_ERROR: f64 = 1e-6;

/// Distributions that are not symmetric, so that a mirrored one is another one.
const SKEWED: [&str; 4] = ["lognormal", "exponential", "rayleigh", "beta"];

/// Choices of an import.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct ImportOptions {
    /// Roles of columns by their headers.
    pub columns: Vec<(ColumnRole, String)>,
    /// Name of the characteristic.
    pub name: String,
    /// Title of the study, in place of that of the table.
    pub title: Option<String>,
    /// Lower limit of the characteristic, in place of that of the table.
    pub lower: Option<f64>,
    /// Upper limit of the characteristic, in place of that of the table.
    pub upper: Option<f64>,
    /// Target yield of the characteristic.
    pub target_yield: Option<f64>,
    /// True if dimensions without a tolerance are fixed. Otherwise they are a fault.
    pub allow_fixed: bool,
}

/// A study made from a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Text of the study as TOML.
    pub study: String,
    /// One line on the rows, tolerances, units and limits that were read.
    pub summary: String,
    /// Notes for the user: rows and columns that were left out, and assumptions.
    pub notes: Vec<String>,
    /// True if the characteristic has a limit.
    pub has_limits: bool,
}

/// Rows of a table with their numbers.
struct Table {
    header: Header,
    titles: TitleRows,
    rows: Vec<Row>,
    limits: LimitRows,
    figures: Figures,
    notes: Vec<String>,
}

/// Reads a table.
///
/// # Errors
/// Fails if a cell has more than one meaning, if a column of numbers has none, or if a dimension has no tolerance.
pub fn import(sheet: &Sheet, options: &ImportOptions) -> Result<Imported, ImportFault> {
    let mut table = read(sheet, options)?;
    // Numbers are parsed only now, since their style follows from all cells together.
    let values = table.figures.read(sheet.commas_separate)?;
    let spreads = spreads(&table, &values)?;
    take_out_totals(&mut table, &values)?;
    let lines: HashSet<u64> = table.rows.iter().map(|row| row.line).collect();
    let spreads: Vec<Spread> =
        spreads.into_iter().filter(|(line, _)| lines.contains(line)).map(|(_, spread)| spread).collect();
    if table.rows.is_empty() {
        return Err(ImportFault { cell: None, problem: ImportProblem::NoDimension });
    }
    let parts = parts(&mut table, &values, &spreads)?;
    refuse_fixed(&parts, options, &mut table.notes)?;
    let formula = sum(&parts);
    if formula.is_empty() {
        return Err(ImportFault { cell: None, problem: ImportProblem::NoEffect });
    }
    let has = |role: ColumnRole| table.header.column(role).is_some();
    let is_added = |part: &Part| part.nominal >= 0.0 && part.factor >= 0.0;
    if !has(ColumnRole::Direction) && !has(ColumnRole::Factor) && parts.iter().all(is_added) {
        table.notes.push("no column has a direction or a factor: all dimensions are added".to_owned());
    }
    let [lower, upper] = limits(&mut table, &values, &parts);
    let from_table = lower.is_some() || upper.is_some();
    let (lower, upper) = (options.lower.or(lower), options.upper.or(upper));
    if let (Some(lower), Some(upper)) = (lower, upper)
        && lower >= upper
    {
        return Err(ImportFault { cell: None, problem: ImportProblem::SwappedLimits { lower, upper } });
    }
    let units: Vec<&String> = parts.iter().filter_map(|part| part.unit.as_ref()).collect();
    let alike = units.len() == parts.len() && units.iter().all(|unit| *unit == units[0]);
    let unit = units.first().filter(|_| alike).map(|unit| unit.as_str());
    let place = if from_table && (options.lower.is_none() || options.upper.is_none()) {
        format!(" from row {}", table.limits.line)
    } else {
        String::new()
    };
    let summary = summary(&table, &spreads, &values, &parts, unit, (lower, upper, &place));
    let target = Target { name: options.name.clone(), lower, upper, target_yield: options.target_yield };
    let title = options.title.as_deref().or(table.titles.title.as_deref());
    let mut study = head(title, &table.titles.about);
    study += &dimensions(&parts);
    study += &characteristics(&target, &formula, unit);
    Ok(Imported { study, summary, notes: table.notes, has_limits: lower.is_some() || upper.is_some() })
}

/// Reads all rows.
fn read(sheet: &Sheet, options: &ImportOptions) -> Result<Table, ImportFault> {
    let header = header(sheet, &options.columns)?;
    let mut figures = Figures::default();
    let (mut limits, mut notes, mut rows) = (LimitRows::default(), Vec::new(), Vec::new());
    let mut above = Vec::new();
    for (line, content) in &sheet.rows[..header.place] {
        if !limits.read_words(*line, content, &mut figures)? {
            above.push((*line, content.clone()));
        }
    }
    let titles = TitleRows::of(&above);
    let below = &sheet.rows[header.end..];
    let of_dimensions: Vec<&[Content]> =
        below.iter().map(|(_, row)| row.as_slice()).filter(|row| is_dimension(&header, row)).collect();
    header.refuse_numbers(&of_dimensions)?;
    let left_out = header.left_out();
    if !left_out.is_empty() {
        notes.push(format!("columns without a meaning here were left out: {}", left_out.join(", ")));
    }
    let own = &sheet.rows[header.place].1;
    for (line, content) in below {
        if content == own {
            notes.push(format!("row {line} repeats the header and was left out"));
            continue;
        }
        if !is_dimension(&header, content) && limits.read(&header, *line, content, &mut figures)? {
            continue;
        }
        if let Some(name) = name(&header, content).filter(|name| names_both_limits(name)) {
            if limits.read_words(*line, content, &mut figures)? {
                continue;
            }
            if is_dimension(&header, content) {
                return Err(ImportFault::of(header.cell(ColumnRole::Name, *line), ImportProblem::NoLimits { name }));
            }
        }
        match row(&header, *line, content, titles.unit.as_deref(), &mut figures)? {
            Read::Blank => {}
            Read::Heading(text) => notes.push(format!("row {line} has no nominal value and was left out: {text}")),
            Read::Dimension(found) => rows.push(*found),
        }
    }
    if rows.is_empty() {
        return Err(ImportFault { cell: None, problem: ImportProblem::NoDimension });
    }
    Ok(Table { header, titles, rows, limits, figures, notes })
}

/// Spread of every row, with its line.
fn spreads(table: &Table, values: &[f64]) -> Result<Vec<(u64, Spread)>, ImportFault> {
    let Table { header, rows, figures, .. } = table;
    refuse_mixed_signs(rows.iter().map(|row| &row.band), values, figures)?;
    let limited: Vec<(&Row, [f64; 3])> = rows
        .iter()
        .filter_map(|row| match row.band {
            Band::Limits([high, low]) => Some((row, [values[row.nominal], values[high], values[low]])),
            _ => None,
        })
        .collect();
    let numbers: Vec<[f64; 3]> = limited.iter().map(|(_, numbers)| *numbers).collect();
    let reading = limit_reading(header, &numbers)?;
    let given = header.is_given(ColumnRole::Max) || header.is_given(ColumnRole::Min);
    for (row, [nominal, high, low]) in limited.iter().filter(|_| reading == LimitReading::Limits && !given) {
        if low < high && !(low <= nominal && nominal <= high) {
            let text = header.text(ColumnRole::Max);
            let problem = ImportProblem::NominalOutside { nominal: *nominal, lower: *low, upper: *high, text };
            return Err(ImportFault::of(figures.cell(row.nominal), problem));
        }
    }
    let mut found = Vec::with_capacity(rows.len());
    for row in rows {
        let nominal = values[row.nominal];
        let spread = spread(&row.band, nominal, reading, values, figures)?;
        if let Some(limits) = row.limits {
            same_limits(&spread, nominal, limits, values, figures)?;
        }
        refuse_wide_sigma(row, &spread, values, figures)?;
        found.push((row.line, spread));
    }
    Ok(found)
}

/// Refuses a sigma beyond the tolerance: it is a number of sigmas then.
fn refuse_wide_sigma(row: &Row, spread: &Spread, values: &[f64], figures: &Figures) -> Result<(), ImportFault> {
    let (Some(sigma), Some([low, high])) = (row.sigma, spread.deviations(values[row.nominal])) else { return Ok(()) };
    let value = values[sigma];
    if high > low && value > high - low {
        return Err(ImportFault::of(figures.cell(sigma), ImportProblem::WideSigma { value }));
    }
    Ok(())
}

/// Part of a row in the sum of all rows.
fn addend(row: &Row, values: &[f64]) -> f64 {
    let count = row.quantity.map_or(1.0, |place| values[place]);
    count * row.sign * row.factor.map_or(1.0, |place| values[place]) * values[row.nominal]
}

/// Leaves out rows with the sum of the rows above, or of those since the last such row.
fn take_out_subtotals(table: &mut Table, values: &[f64]) -> Result<(), ImportFault> {
    let (mut sum, mut since, mut largest) = (0.0, 0.0, 0.0f64);
    let mut left_out = Vec::new();
    for row in &table.rows {
        let value = values[row.nominal];
        if !is_subtotal(&row.name) {
            sum += addend(row, values);
            since += addend(row, values);
            largest = largest.max(value.abs());
            continue;
        }
        let is = |of: f64| (value.abs() - of.abs()).abs() <= SUM_ERROR * largest;
        if !is(sum) && !is(since) {
            let problem = ImportProblem::NoSum { name: row.name.clone(), value, sum };
            return Err(ImportFault::of(table.figures.cell(row.nominal), problem));
        }
        since = 0.0;
        left_out.push(row.line);
        table.notes.push(format!("row {} is a sum of rows above and was left out: {}", row.line, row.name));
    }
    table.rows.retain(|row| !left_out.contains(&row.line));
    Ok(())
}

/// Leaves out the last rows if they hold the sum of the others.
fn take_out_totals(table: &mut Table, values: &[f64]) -> Result<(), ImportFault> {
    take_out_subtotals(table, values)?;
    while let Some((last, others)) = table.rows.split_last() {
        let has_sign = table.header.column(ColumnRole::Direction).is_some() && last.sign < 0.0;
        if others.is_empty() || !is_total(&last.name) || has_sign || last.quantity.is_some() {
            return Ok(());
        }
        let sum: f64 = others.iter().map(|row| addend(row, values)).sum();
        let largest = others.iter().map(|row| values[row.nominal].abs()).fold(0.0, f64::max);
        let value = values[last.nominal];
        if (value.abs() - sum.abs()).abs() > SUM_ERROR * largest {
            let problem = ImportProblem::NoSum { name: last.name.clone(), value, sum };
            return Err(ImportFault::of(table.figures.cell(last.nominal), problem));
        }
        table.notes.push(format!("row {} is the sum of the others and was left out: {}", last.line, last.name));
        table.rows.pop();
    }
    Ok(())
}

/// Dimensions with names of their own: equal names are numbered, and n equal parts are n dimensions.
fn parts(table: &mut Table, values: &[f64], spreads: &[Spread]) -> Result<Vec<Part>, ImportFault> {
    // Every name with the number that is tried next, so that many equal names are numbered in one pass.
    let mut taken: HashMap<String, usize> = HashMap::new();
    let (mut parts, mut numbered, mut mirrored) = (Vec::new(), Vec::new(), Vec::new());
    for (row, spread) in table.rows.iter().zip(spreads) {
        if let (Spread::Class(class), None) = (spread, &row.unit) {
            let (class, nominal) = (class.clone(), table.header.text(ColumnRole::Nominal));
            let problem = ImportProblem::ClassWithoutUnit { class, nominal };
            return Err(ImportFault::of(table.header.cell(ColumnRole::Nominal, row.line), problem));
        }
        let count = match row.quantity.map(|place| (values[place], place)) {
            None => 1,
            Some((value, _)) if value.fract() == 0.0 && (1.0..=MOST_EQUAL).contains(&value) => value as usize,
            Some((value, place)) => {
                return Err(ImportFault::of(table.figures.cell(place), ImportProblem::NoQuantity { value }));
            }
        };
        // Those of other kinds follow from their bands.
        let is_normal = row.distribution.is_none_or(|kind| kind == "normal");
        let numbers = [
            ("sigma", row.sigma),
            ("sigmas", row.sigmas.filter(|place| is_normal && values[*place] != 3.0 && row.sigma.is_none())),
            ("cp", row.cp),
            ("cpk", row.cpk),
            ("shift", row.shift.filter(|place| is_normal && values[*place] != 0.0)),
        ];
        let numbers = numbers.into_iter().filter_map(|(key, place)| Some((key, values[place?]))).collect();
        let nominal = values[row.nominal];
        let is_mirrored = sign_is_direction(&table.header, row, spread, values);
        if is_mirrored {
            mirrored.push(format!("`{}` of row {} is {}", row.name, row.line, -nominal));
        }
        let part = Part {
            name: String::new(),
            nominal: if is_mirrored { -nominal } else { nominal },
            spread: spread.clone(),
            factor: if is_mirrored { -1.0 } else { row.sign * row.factor.map_or(1.0, |place| values[place]) },
            unit: row.unit.clone(),
            distribution: row.distribution,
            numbers,
            labels: row.labels.clone(),
        };
        for index in 1..=count {
            let wanted = if count == 1 { row.name.clone() } else { format!("{} {index}", row.name) };
            let name = free(&wanted, &mut taken);
            if name != wanted {
                numbered.push(format!("`{name}` of row {}", row.line));
            }
            parts.push(Part { name, ..part.clone() });
        }
    }
    if !numbered.is_empty() {
        table.notes.push(format!("equal names were numbered: {}", first_of(&numbered, NAMED)));
    }
    if !mirrored.is_empty() {
        let which = first_of(&mirrored, NAMED);
        table
            .notes
            .push(format!("the sign of a negative nominal value is taken as its direction: {which}, subtracted"));
    }
    Ok(parts)
}

/// True if the sign of a nominal value is its direction, so that the tolerance is that of the positive value. A tolerance on both sides is
/// the same either way, and limits beside the nominal value have its sign.
fn sign_is_direction(header: &Header, row: &Row, spread: &Spread, values: &[f64]) -> bool {
    let nominal = values[row.nominal];
    let has = |role: ColumnRole| header.column(role).is_some();
    if nominal >= 0.0 || has(ColumnRole::Direction) || has(ColumnRole::Factor) {
        return false;
    }
    let negative_limits = row.limits.is_some_and(|[_, low]| values[low] < 0.5 * nominal);
    let is_even = match spread {
        Spread::Deviations([low, high]) => *low == -high,
        Spread::None | Spread::Percent(_) | Spread::Limits(_) => true,
        Spread::Class(_) => false,
    };
    let is_shifted = row.shift.is_some_and(|shift| values[shift] != 0.0) && !matches!(spread, Spread::Limits(_));
    let is_skewed = row.distribution.is_some_and(|kind| SKEWED.contains(&kind)) && !matches!(spread, Spread::Limits(_));
    !negative_limits && (!is_even || is_shifted || is_skewed)
}

/// Takes a name with the first number that is free, or as it is.
fn free(name: &str, taken: &mut HashMap<String, usize>) -> String {
    let mut number = taken.get(name).copied().unwrap_or(1);
    let mut found = name.to_owned();
    while taken.contains_key(&found) {
        number += 1;
        found = format!("{name} {number}");
    }
    taken.insert(name.to_owned(), number);
    taken.entry(found.clone()).or_insert(1);
    found
}

/// Refuses dimensions without a tolerance, unless they are permitted.
fn refuse_fixed(parts: &[Part], options: &ImportOptions, notes: &mut Vec<String>) -> Result<(), ImportFault> {
    let varies = |part: &Part| part.spread != Spread::None || part.numbers.iter().any(|(key, _)| *key == "sigma");
    let fixed: Vec<String> = parts.iter().filter(|part| !varies(part)).map(|part| part.name.clone()).collect();
    if !fixed.is_empty() && !options.allow_fixed {
        return Err(ImportFault { cell: None, problem: ImportProblem::Fixed { names: fixed } });
    }
    if !fixed.is_empty() {
        notes.push(format!("without tolerance: {}", first_of(&fixed, NAMED)));
    }
    Ok(())
}

/// Lower and upper limit that the table states. Limits that are the worst case of the rows are a result of the table.
fn limits(table: &mut Table, values: &[f64], parts: &[Part]) -> [Option<f64>; 2] {
    let found = [table.limits.lower, table.limits.upper].map(|place| place.map(|place| values[place]));
    let Some([low, high]) = worst_case(parts) else { return found };
    let error = WORST_CASE_ERROR * low.abs().max(high.abs()).max(high - low);
    let same = |limit: Option<f64>, result: f64| limit.is_none_or(|limit| (limit - result).abs() <= error);
    if found == [None, None] || !same(found[0], low) || !same(found[1], high) {
        return found;
    }
    let line = table.limits.line;
    table.notes.push(format!("row {line} holds the worst case of the rows, not limits, and was left out"));
    [None, None]
}

/// Least and greatest sum of the dimensions. Returns None if a tolerance is not in the table.
fn worst_case(parts: &[Part]) -> Option<[f64; 2]> {
    let mut sum = [0.0, 0.0];
    for part in parts {
        let ends = part.spread.deviations(part.nominal)?.map(|deviation| part.factor * (part.nominal + deviation));
        sum = [sum[0] + ends[0].min(ends[1]), sum[1] + ends[0].max(ends[1])];
    }
    Some(sum)
}

/// One line on the content of the table.
fn summary(
    table: &Table,
    spreads: &[Spread],
    values: &[f64],
    parts: &[Part],
    unit: Option<&str>,
    (lower, upper, place): (Option<f64>, Option<f64>, &str),
) -> String {
    let plural = |count: usize, one: &str| format!("{count} {one}{}", if count == 1 { "" } else { "s" });
    let mut words = vec![plural(table.rows.len(), "row")];
    if parts.len() != table.rows.len() {
        words.push(plural(parts.len(), "dimension"));
    }
    let one_sided =
        table.rows.iter().zip(spreads).filter(|(row, spread)| spread.is_one_sided(values[row.nominal])).count();
    words.extend((one_sided > 0).then(|| format!("{one_sided} one-sided")));
    let subtracted = parts.iter().filter(|part| part.factor < 0.0).count();
    words.extend((subtracted > 0).then(|| format!("{subtracted} subtracted")));
    words.push(unit.map_or_else(
        || if parts.iter().all(|part| part.unit.is_none()) { "no unit" } else { "several units" }.to_owned(),
        str::to_owned,
    ));
    words.push(match (lower, upper) {
        (Some(lower), Some(upper)) => format!("limits {lower} .. {upper}{place}"),
        (Some(lower), None) => format!("lower limit {lower}{place}"),
        (None, Some(upper)) => format!("upper limit {upper}{place}"),
        (None, None) => "no limits".to_owned(),
    });
    words.join(", ")
}
