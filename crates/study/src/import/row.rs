//! Rows of a table: a dimension, a heading, or nothing.

use crate::import::columns::{ColumnRole, LABELLED};
use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::figures::Figures;
use crate::import::header::Header;
use crate::import::sheet::{Content, address};
use crate::import::spread::{Band, band};
use crate::import::units::Scales;
use crate::import::words::{KNOWN_DIRECTIONS, KNOWN_DISTRIBUTIONS, direction, distribution, is_subtotal, is_total};

/// Dimension of a row. Its numbers are indices into [`Figures`].
#[derive(Debug)]
pub(super) struct Row {
    pub(super) line: u64,
    pub(super) name: String,
    pub(super) nominal: usize,
    pub(super) band: Band,
    /// Greatest and least value, of a row that has a tolerance beside them.
    pub(super) limits: Option<[usize; 2]>,
    pub(super) sign: f64,
    pub(super) factor: Option<usize>,
    pub(super) quantity: Option<usize>,
    pub(super) sigma: Option<usize>,
    pub(super) sigmas: Option<usize>,
    pub(super) shift: Option<usize>,
    pub(super) cp: Option<usize>,
    pub(super) cpk: Option<usize>,
    pub(super) unit: Option<String>,
    pub(super) distribution: Option<&'static str>,
    /// Texts for description, part, drawing, revision and feature, in this order.
    pub(super) labels: [Option<String>; 5],
}

/// Meaning of a row.
pub(super) enum Read {
    Blank,
    /// A row without a nominal value, with its words.
    Heading(String),
    Dimension(Box<Row>),
}

/// Words of a row.
pub(super) fn words(content: &[Content]) -> String {
    let words =
        content.iter().filter_map(|cell| if let Content::Text(text) = cell { Some(text.as_str()) } else { None });
    words.collect::<Vec<_>>().join(" ")
}

/// Name of a dimension in a row. Returns None if the cell has no words, unless another cell names a total. A backquote ends a name in
/// formulas, so it is replaced.
pub(super) fn name(header: &Header, content: &[Content]) -> Option<String> {
    let total = || content.iter().filter_map(Content::words).find(|text| is_total(text) || is_subtotal(text));
    let name = header.of(ColumnRole::Name, content).words().or_else(total)?;
    Some(name.replace('`', "'").split_whitespace().collect::<Vec<_>>().join(" "))
}

/// True if a row has a nominal value.
pub(super) fn is_dimension(header: &Header, content: &[Content]) -> bool {
    *header.of(ColumnRole::Nominal, content) != Content::Empty
}

/// Reads a row. `unit` is that of all numbers of the table, if a title says one.
pub(super) fn row(
    header: &Header,
    line: u64,
    content: &[Content],
    unit: Option<&str>,
    figures: &mut Figures,
) -> Result<Read, ImportFault> {
    let at = |role: ColumnRole, problem: ImportProblem| ImportFault::of(header.cell(role, line), problem);
    if !is_dimension(header, content) {
        let blank = content.iter().all(|cell| *cell == Content::Empty);
        return Ok(if blank { Read::Blank } else { Read::Heading(words(content)) });
    }
    refuse_errors(header, line, content)?;
    let of = |role: ColumnRole| header.of(role, content);
    let name = name(header, content).ok_or_else(|| at(ColumnRole::Name, ImportProblem::NoName))?;
    let scales = Scales::of_row(header, line, content, unit)?;
    let nominal = figures.keep_content(&header.cell(ColumnRole::Nominal, line), of(ColumnRole::Nominal), 1.0)?;
    let nominal = nominal.ok_or_else(|| at(ColumnRole::Nominal, ImportProblem::NoDimension))?;
    let mut sign = match of(ColumnRole::Direction).words() {
        None => 1.0,
        Some(text) => direction(&text).ok_or_else(|| {
            at(ColumnRole::Direction, ImportProblem::Unknown { text, what: "direction", known: KNOWN_DIRECTIONS })
        })?,
    };
    let kind = match of(ColumnRole::Distribution).words() {
        None => None,
        Some(text) => Some(distribution(&text).ok_or_else(|| {
            let problem = ImportProblem::Unknown { text, what: "distribution", known: KNOWN_DISTRIBUTIONS };
            at(ColumnRole::Distribution, problem)
        })?),
    };
    let mut figure = |role: ColumnRole| figures.keep_content(&header.cell(role, line), of(role), scales.of(role));
    let (sigma, sigmas) = (figure(ColumnRole::Sigma)?, figure(ColumnRole::Sigmas)?);
    let (shift, cp, cpk) = (figure(ColumnRole::Shift)?, figure(ColumnRole::Cp)?, figure(ColumnRole::Cpk)?);
    let quantity = figure(ColumnRole::Quantity)?;
    // A column of factors may hold signs alone.
    let sign_alone = match of(ColumnRole::Factor) {
        Content::Text(text) if ["+", "-", "\u{2212}"].contains(&text.as_str()) => direction(text),
        _ => None,
    };
    sign *= sign_alone.unwrap_or(1.0);
    let factor = if sign_alone.is_some() { None } else { figure(ColumnRole::Factor)? };
    let one_line = |text: String| text.split_whitespace().collect::<Vec<_>>().join(" ");
    let own = header.name_role();
    let labels = LABELLED.map(|role| of(role).words().filter(|_| role != own).map(one_line));
    let (band, limits) = band(header, line, content, &scales, figures)?;
    let unit = scales.unit;
    Ok(Read::Dimension(Box::new(Row {
        line,
        name,
        nominal,
        band,
        limits,
        sign,
        factor,
        quantity,
        sigma,
        sigmas,
        shift,
        cp,
        cpk,
        unit,
        distribution: kind,
        labels,
    })))
}

/// Refuses dates and errors of spreadsheets in the columns that count.
fn refuse_errors(header: &Header, line: u64, content: &[Content]) -> Result<(), ImportFault> {
    for place in header.places() {
        let problem = match content.get(place) {
            Some(Content::Date(_)) => ImportProblem::Date,
            Some(Content::Error(text)) => ImportProblem::Error { text: text.clone() },
            _ => continue,
        };
        return Err(ImportFault::of(address(line, place), problem));
    }
    Ok(())
}
