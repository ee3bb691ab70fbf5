//! Reads the rows of a stack-up table and writes a study from them.

use std::collections::HashMap;
use std::fmt::Write;

use crate::import::columns::{ColumnRole, LABELLED, ROLES, role};
use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::sheet::{Content, Sheet, address};
use crate::import::tolerance::{Written, written};
use crate::table::{NumberFault, NumberStyle};
use crate::write::{inline, name as key, number, quoted};
use sensitol::assembly::formula::is_plain;
use sensitol_numeric::labels::LABELS;

/// Number of rows in which the header is searched for.
const HEADER: usize = 30;
/// Words for distributions in tables, by the name of the kind in a study.
const DISTRIBUTIONS: [(&str, &[&str]); 5] = [
    ("normal", &["normal", "gauss", "gaussian", "normalverteilung", "n"]),
    ("uniform", &["uniform", "rectangular", "gleich", "gleichverteilung", "rechteck", "r"]),
    ("triangular", &["triangular", "triangle", "dreieck", "dreieckverteilung"]),
    ("beta", &["beta"]),
    ("trapezoidal", &["trapezoidal", "trapez", "trapezoid"]),
];
/// Words for the direction of a dimension that is added.
const PLUS: [&str; 8] = ["+", "+1", "1", "right", "rechts", "up", "plus", "add"];
/// Words for the direction of a dimension that is subtracted.
const MINUS: [&str; 7] = ["-", "-1", "left", "links", "down", "minus", "subtract"];

/// A study made from a table.
#[derive(Debug, Clone, PartialEq)]
pub struct Imported {
    /// Text of the study as TOML.
    pub study: String,
    /// Notes for the user: rows and columns that were left out, and assumptions.
    pub notes: Vec<String>,
}

/// A number and the name of its cell.
struct Figure {
    cell: String,
    /// Text of the cell; empty for a number of a workbook, which is not text.
    text: String,
    value: Option<f64>,
}

/// Numbers that are parsed together, since the style of decimals and thousands follows from all of them.
#[derive(Default)]
struct Figures(Vec<Figure>);

impl Figures {
    /// Keeps a text to be parsed later. Returns its index.
    fn keep(&mut self, cell: &str, text: &str) -> usize {
        self.0.push(Figure { cell: cell.to_owned(), text: text.to_owned(), value: None });
        self.0.len() - 1
    }

    /// Keeps a number of a workbook. Returns its index.
    fn keep_value(&mut self, cell: &str, value: f64) -> usize {
        self.0.push(Figure { cell: cell.to_owned(), text: String::new(), value: Some(value) });
        self.0.len() - 1
    }

    fn keep_content(&mut self, cell: &str, content: &Content) -> Result<Option<usize>, ImportFault> {
        Ok(match content {
            Content::Empty | Content::Date | Content::Error(_) => None,
            Content::Text(text) => Some(self.keep(cell, text)),
            Content::Number { value, percent: false } => Some(self.keep_value(cell, *value)),
            Content::Number { value, percent: true } => {
                let text = in_percent(*value).to_string();
                return Err(ImportFault::of(cell.to_owned(), ImportProblem::Percent { text }));
            }
        })
    }

    fn read(self, commas_separate: bool) -> Result<Vec<f64>, ImportFault> {
        let style = NumberStyle::of(self.0.iter().map(|figure| figure.text.as_str()), commas_separate);
        let of = |(place, figure): (usize, &Figure)| {
            if let Some(value) = figure.value {
                return Ok(value);
            }
            style.number(place, &figure.text).map_err(|fault| {
                let text = figure.text.clone();
                let problem = match fault {
                    NumberFault::TwoMarks { other, .. } => {
                        ImportProblem::TwoMarks { text, other: self.0[other].cell.clone() }
                    }
                    NumberFault::NoNumber { comma } => ImportProblem::NoNumber { text, comma },
                    NumberFault::NotFinite => ImportProblem::NoNumber { text, comma: false },
                };
                ImportFault::of(figure.cell.clone(), problem)
            })
        };
        self.0.iter().enumerate().map(of).collect()
    }
}

/// Percentage of a fraction: 0.02 is 2 %. Thirteen decimals of the mantissa remove the error of the product.
fn in_percent(value: f64) -> f64 {
    format!("{:.13e}", 100.0 * value).parse().unwrap_or(100.0 * value)
}

/// Tolerance of a row. Its numbers are indices into [`Figures`].
enum Band {
    None,
    Half(usize),
    Two([usize; 2]),
    Deviations { upper: usize, lower: usize, unsigned: bool },
    Percent(usize),
    Class(String),
}

/// Dimension of a row. Its numbers are indices into [`Figures`].
struct Row {
    name: String,
    nominal: usize,
    band: Band,
    sign: f64,
    factor: Option<usize>,
    sigma: Option<usize>,
    cp: Option<usize>,
    unit: Option<String>,
    distribution: Option<&'static str>,
    /// Texts for description, part, drawing, revision and feature, in this order.
    labels: [Option<String>; 5],
}

/// Header row of a table: columns by their roles.
struct Header {
    row: u64,
    columns: Vec<(ColumnRole, usize)>,
    /// Unit in the header of the nominal value; None if there is none.
    unit: Option<String>,
    unknown: Vec<String>,
    /// Index in the sheet of the first row below the header.
    next: usize,
}

/// Reads a table. `named` gives roles to unknown headers. The characteristic gets the name `output`.
pub fn import(sheet: &Sheet, named: &[(ColumnRole, String)], output: &str) -> Result<Imported, ImportFault> {
    let header = header(sheet, named)?;
    let mut figures = Figures::default();
    let (mut rows, mut notes): (Vec<Row>, Vec<String>) = (Vec::new(), Vec::new());
    // Rows by the names of their dimensions.
    let mut lines: HashMap<String, u64> = HashMap::new();
    if !header.unknown.is_empty() {
        notes.push(format!("columns without a meaning here were left out: {}", header.unknown.join(", ")));
    }
    for (line, content) in &sheet.rows[header.next..] {
        match row(&header, *line, content, &mut figures)? {
            Read::Blank => {}
            Read::Heading(text) => notes.push(format!("row {line} has no nominal value and was left out: {text}")),
            Read::Dimension(found) => {
                let cell = header.cell(ColumnRole::Name, *line);
                if let Some(other) = lines.insert(found.name.clone(), *line) {
                    let other = header.cell(ColumnRole::Name, other);
                    let problem = ImportProblem::NameTwice { name: found.name.clone(), other };
                    return Err(ImportFault::of(cell, problem));
                }
                rows.push(*found);
            }
        }
    }
    if rows.is_empty() {
        return Err(ImportFault { cell: None, problem: ImportProblem::NoDimension });
    }
    if header.column(ColumnRole::Direction).is_none() && header.column(ColumnRole::Factor).is_none() {
        notes.push("no column has a direction or a factor: all dimensions are added".to_owned());
    }
    // Numbers are parsed only now, since their style follows from all cells together.
    let values = figures.read(sheet.commas_separate)?;
    let fixed: Vec<&str> = rows
        .iter()
        .filter(|row| matches!(row.band, Band::None) && row.sigma.is_none())
        .map(|row| row.name.as_str())
        .collect();
    if !fixed.is_empty() {
        notes.push(format!("without tolerance: {}", fixed.join(", ")));
    }
    Ok(Imported { study: study(&rows, &values, output)?, notes })
}

impl Header {
    fn column(&self, role: ColumnRole) -> Option<usize> {
        self.columns.iter().find(|(known, _)| *known == role).map(|(_, column)| *column)
    }

    /// Name of the cell of a role in a row, such as B7.
    fn cell(&self, role: ColumnRole, row: u64) -> String {
        address(row, self.column(role).unwrap_or(0))
    }
}

/// True if a row of the sheet names the required columns.
pub fn has_header(sheet: &Sheet, named: &[(ColumnRole, String)]) -> bool {
    header(sheet, named).is_ok()
}

/// First row with columns for the name and the nominal value.
fn header(sheet: &Sheet, named: &[(ColumnRole, String)]) -> Result<Header, ImportFault> {
    let none = |problem| ImportFault { cell: None, problem };
    if sheet.rows.is_empty() {
        return Err(none(ImportProblem::Empty));
    }
    let is = |content: &Content, header: &str| matches!(content, Content::Text(text) if text.trim() == header);
    let holds = |content: &[Content], wanted: ColumnRole| {
        let given = named.iter().find(|(role, _)| *role == wanted);
        content.iter().any(|cell| match given {
            Some((_, header)) => is(cell, header),
            None => role(cell).is_some_and(|(role, _)| role == wanted),
        })
    };
    let found = sheet
        .rows
        .iter()
        .take(HEADER)
        .position(|(_, row)| holds(row, ColumnRole::Name) && holds(row, ColumnRole::Nominal));
    let Some(place) = found else {
        // A header given by the user that stands in no row is most likely misspelt.
        let texts = |row: &[Content]| -> Vec<String> {
            row.iter()
                .filter_map(|cell| if let Content::Text(text) = cell { Some(text.clone()) } else { None })
                .collect()
        };
        let slip =
            named.iter().find(|(_, header)| !sheet.rows.iter().any(|(_, row)| row.iter().any(|cell| is(cell, header))));
        return Err(none(match slip {
            Some((_, header)) => ImportProblem::NoColumn { header: header.clone(), known: texts(&sheet.rows[0].1) },
            None => ImportProblem::NoHeader,
        }));
    };
    let (line, content) = &sheet.rows[place];
    let mut header = Header { row: *line, columns: Vec::new(), unit: None, unknown: Vec::new(), next: place + 1 };
    for (column, cell) in content.iter().enumerate() {
        let Content::Text(text) = cell else { continue };
        let given = named.iter().find(|(_, header)| text.trim() == header).map(|(role, _)| (*role, None));
        // A role that the user has given to another header is not taken by this one.
        let own = role(cell).filter(|(role, _)| !named.iter().any(|(given, _)| given == role));
        let Some((role, unit)) = given.or(own) else {
            header.unknown.push(text.clone());
            continue;
        };
        if let Some(other) = header.column(role) {
            let name = ROLES.iter().find(|(known, ..)| *known == role).map_or("value", |(_, name, _)| name);
            let problem = ImportProblem::Twice { role: name, other: address(header.row, other) };
            return Err(ImportFault::of(address(header.row, column), problem));
        }
        if role == ColumnRole::Nominal {
            header.unit = unit;
        }
        header.columns.push((role, column));
    }
    Ok(header)
}

enum Read {
    Blank,
    Heading(String),
    Dimension(Box<Row>),
}

fn row(header: &Header, line: u64, content: &[Content], figures: &mut Figures) -> Result<Read, ImportFault> {
    let of = |role: ColumnRole| header.column(role).and_then(|column| content.get(column)).unwrap_or(&Content::Empty);
    let at = |role: ColumnRole, problem: ImportProblem| ImportFault::of(header.cell(role, line), problem);
    let text = |role: ColumnRole| of(role).words();
    if matches!(of(ColumnRole::Nominal), Content::Empty) {
        let words: Vec<&str> = content
            .iter()
            .filter_map(|cell| if let Content::Text(text) = cell { Some(text.as_str()) } else { None })
            .collect();
        let blank = content.iter().all(|cell| *cell == Content::Empty);
        return Ok(if blank { Read::Blank } else { Read::Heading(words.join(" ")) });
    }
    for &(_, column) in &header.columns {
        let problem = match content.get(column) {
            Some(Content::Date) => ImportProblem::Date,
            Some(Content::Error(text)) => ImportProblem::Error { text: text.clone() },
            _ => continue,
        };
        return Err(ImportFault::of(address(line, column), problem));
    }
    let name = text(ColumnRole::Name).ok_or_else(|| at(ColumnRole::Name, ImportProblem::NoName))?;
    // A backquote ends a name in formulas, so it is replaced.
    let name = name.replace('`', "'").split_whitespace().collect::<Vec<_>>().join(" ");
    let nominal = figures.keep_content(&header.cell(ColumnRole::Nominal, line), of(ColumnRole::Nominal))?;
    let nominal = nominal.ok_or_else(|| at(ColumnRole::Nominal, ImportProblem::NoDimension))?;
    let sign = match text(ColumnRole::Direction) {
        None => 1.0,
        Some(word) => {
            let word = crate::table::clean(&word).to_lowercase();
            match (PLUS.contains(&word.as_str()), MINUS.contains(&word.as_str())) {
                (true, _) => 1.0,
                (_, true) => -1.0,
                _ => {
                    let known = "+, -, 1, -1, right or left";
                    return Err(at(
                        ColumnRole::Direction,
                        ImportProblem::Unknown { text: word, what: "direction", known },
                    ));
                }
            }
        }
    };
    let distribution = match text(ColumnRole::Distribution) {
        None => None,
        Some(word) => {
            let plain = word.to_lowercase();
            let found = DISTRIBUTIONS.iter().find(|(_, words)| words.contains(&plain.as_str())).map(|(kind, _)| *kind);
            let known = "normal, uniform, triangular, beta or trapezoidal";
            let unknown =
                || at(ColumnRole::Distribution, ImportProblem::Unknown { text: word, what: "distribution", known });
            Some(found.ok_or_else(unknown)?)
        }
    };
    let mut figure = |role: ColumnRole| figures.keep_content(&header.cell(role, line), of(role));
    let (factor, sigma, cp) = (figure(ColumnRole::Factor)?, figure(ColumnRole::Sigma)?, figure(ColumnRole::Cp)?);
    let one_line = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let labels = LABELLED.map(|role| text(role).map(one_line));
    let unit = text(ColumnRole::Unit).or_else(|| header.unit.clone());
    let band = band(header, line, &of, figures)?;
    Ok(Read::Dimension(Box::new(Row { name, nominal, band, sign, factor, sigma, cp, unit, distribution, labels })))
}

fn band<'c>(
    header: &Header,
    line: u64,
    of: &dyn Fn(ColumnRole) -> &'c Content,
    figures: &mut Figures,
) -> Result<Band, ImportFault> {
    let cell = |role: ColumnRole| header.cell(role, line);
    let lower_role =
        if matches!(of(ColumnRole::Minus), Content::Empty) { ColumnRole::Lower } else { ColumnRole::Minus };
    let upper = figures.keep_content(&cell(ColumnRole::Upper), of(ColumnRole::Upper))?;
    let lower = figures.keep_content(&cell(lower_role), of(lower_role))?;
    let tolerance = of(ColumnRole::Tolerance);
    if *tolerance != Content::Empty && (upper.is_some() || lower.is_some()) {
        let other = cell(if upper.is_some() { ColumnRole::Upper } else { lower_role });
        return Err(ImportFault::of(cell(ColumnRole::Tolerance), ImportProblem::ToleranceTwice { other }));
    }
    match (upper, lower) {
        (Some(upper), Some(lower)) => {
            let signed = match of(lower_role) {
                Content::Text(text) => text.trim().starts_with(['+', '-', '\u{2212}']),
                Content::Number { value, .. } => *value < 0.0,
                _ => false,
            };
            return Ok(Band::Deviations { upper, lower, unsigned: lower_role == ColumnRole::Minus && !signed });
        }
        (None, None) => {}
        (upper, _) => {
            let missing = if upper.is_some() { lower_role } else { ColumnRole::Upper };
            return Err(ImportFault::of(cell(missing), ImportProblem::OneDeviation));
        }
    }
    let at = cell(ColumnRole::Tolerance);
    let text = match tolerance {
        Content::Text(text) => text,
        Content::Number { value, percent: false } => return Ok(Band::Half(figures.keep_value(&at, *value))),
        Content::Number { value, percent: true } => {
            return Ok(Band::Percent(figures.keep_value(&at, in_percent(*value))));
        }
        Content::Empty | Content::Date | Content::Error(_) => return Ok(Band::None),
    };
    let found =
        written(text).ok_or_else(|| ImportFault::of(at.clone(), ImportProblem::NoTolerance { text: text.clone() }))?;
    Ok(match found {
        Written::Half(half) => Band::Half(figures.keep(&at, &half)),
        Written::Percent(percent) => Band::Percent(figures.keep(&at, &percent)),
        Written::Two(both) => Band::Two(both.map(|one| figures.keep(&at, &one))),
        Written::Class(class) => Band::Class(class),
    })
}

fn study(rows: &[Row], values: &[f64], output: &str) -> Result<String, ImportFault> {
    let mut text = "[dimensions]\n".to_owned();
    let wide = rows.iter().map(|row| key(&row.name).chars().count()).max().unwrap_or(0);
    for row in rows {
        let mut pairs = vec![format!("nominal = {}", number(values[row.nominal]))];
        let both = |low: f64, high: f64| match low == -high {
            true => format!("tolerance = {}", number(high.abs())),
            false => format!("tolerance = [{}, {}]", number(low.min(high)), number(low.max(high))),
        };
        pairs.extend(match &row.band {
            Band::None => None,
            Band::Half(half) => Some(format!("tolerance = {}", number(values[*half].abs()))),
            Band::Percent(part) => Some(format!("tolerance = {}", quoted(&format!("{}%", values[*part])))),
            Band::Two([a, b]) => Some(both(values[*a], values[*b])),
            Band::Deviations { upper, lower, unsigned } => {
                let lower = values[*lower];
                Some(both(if *unsigned { -lower.abs() } else { lower }, values[*upper]))
            }
            Band::Class(class) => Some(format!("fit = {}", quoted(class))),
        });
        pairs.extend(row.unit.as_ref().map(|unit| format!("unit = {}", quoted(unit))));
        pairs.extend(
            row.distribution.filter(|kind| *kind != "normal").map(|kind| format!("distribution = {}", quoted(kind))),
        );
        pairs.extend(row.sigma.map(|sigma| format!("sigma = {}", number(values[sigma]))));
        pairs.extend(row.cp.map(|cp| format!("cp = {}", number(values[cp]))));
        let labels = LABELS.into_iter().zip(&row.labels);
        pairs.extend(labels.filter_map(|(key, text)| Some(format!("{key} = {}", quoted(text.as_ref()?)))));
        let pad = wide - key(&row.name).chars().count();
        let _ = writeln!(text, "{}{:pad$} = {}", key(&row.name), "", inline(pairs));
    }
    let mut formula = String::new();
    for row in rows {
        let factor = row.sign * row.factor.map_or(1.0, |factor| values[factor]);
        if factor == 0.0 {
            continue;
        }
        let name = if is_plain(&row.name) { row.name.clone() } else { format!("`{}`", row.name) };
        let sign = match (formula.is_empty(), factor < 0.0) {
            (true, false) => "",
            (true, true) => "-",
            (false, false) => " + ",
            (false, true) => " - ",
        };
        let by = if factor.abs() == 1.0 { String::new() } else { format!("{}*", factor.abs()) };
        let _ = write!(formula, "{sign}{by}{name}");
    }
    if formula.is_empty() {
        return Err(ImportFault { cell: None, problem: ImportProblem::NoEffect });
    }
    let units: Vec<&String> = rows.iter().filter_map(|row| row.unit.as_ref()).collect();
    let alike = units.len() == rows.len() && units.iter().all(|unit| *unit == units[0]);
    let unit = units.first().filter(|_| alike).map_or(String::new(), |unit| format!(", unit = {}", quoted(unit)));
    let _ = write!(text, "\n[characteristics]\n{} = {{ formula = {}{unit} }}\n", key(output), quoted(&formula));
    Ok(text)
}
