//! Header row of a table: columns by their roles, with the units that stand in it.

use crate::import::columns::{ColumnRole, Heading, LABELLED, NAMES, heading, plain, rank, role_name, unit_of};
use crate::import::fault::{ImportFault, ImportProblem};
use crate::import::sheet::{Content, Sheet, address};
use crate::import::tolerance::{Written, is_number, written};
use crate::import::words::direction;

/// Number of rows in which the header is searched for.
const HEADER: usize = 30;

/// A column with a role.
#[derive(Debug, Clone)]
struct Column {
    role: ColumnRole,
    place: usize,
    header: String,
    /// Unit in the header.
    unit: Option<String>,
    /// True if the user gave the role.
    given: bool,
}

/// Header row of a table.
#[derive(Debug)]
pub(super) struct Header {
    row: u64,
    columns: Vec<Column>,
    /// True if the columns of the limits may hold deviations instead.
    pub(super) either: bool,
    /// Role of the column with the names.
    name: ColumnRole,
    /// Columns without a meaning here, by place and header.
    unknown: Vec<(usize, String)>,
    /// Index of the header in the sheet.
    pub(super) place: usize,
    /// Index of the first row below the header, which may have two rows.
    pub(super) end: usize,
}

impl Header {
    /// Place of the column of a role. Returns None if there is none.
    pub(super) fn column(&self, role: ColumnRole) -> Option<usize> {
        self.find(role).map(|column| column.place)
    }

    fn find(&self, role: ColumnRole) -> Option<&Column> {
        let role = if role == ColumnRole::Name { self.name } else { role };
        self.columns.iter().find(|column| column.role == role)
    }

    /// Unit in the header of a role.
    pub(super) fn unit(&self, role: ColumnRole) -> Option<&str> {
        self.find(role)?.unit.as_deref()
    }

    /// Text of the header of a role, for messages.
    pub(super) fn text(&self, role: ColumnRole) -> String {
        self.find(role).map_or_else(String::new, |column| column.header.clone())
    }

    /// True if the user gave the role.
    pub(super) fn is_given(&self, role: ColumnRole) -> bool {
        self.find(role).is_some_and(|column| column.given)
    }

    /// Name of the cell of a role in a row, such as B7.
    pub(super) fn cell(&self, role: ColumnRole, row: u64) -> String {
        address(row, self.column(role).unwrap_or(0))
    }

    /// Name of the cell of a header.
    pub(super) fn own_cell(&self, role: ColumnRole) -> String {
        self.cell(role, self.row)
    }

    /// Cell of a role in a row.
    pub(super) fn of<'c>(&self, role: ColumnRole, content: &'c [Content]) -> &'c Content {
        self.column(role).and_then(|column| content.get(column)).unwrap_or(&Content::Empty)
    }

    /// Role of the text that names the dimensions.
    pub(super) fn name_role(&self) -> ColumnRole {
        self.name
    }

    /// Places of the columns whose cells count.
    pub(super) fn places(&self) -> impl Iterator<Item = usize> {
        self.columns.iter().filter(|column| column.role != ColumnRole::Ignore).map(|column| column.place)
    }

    /// Headers of columns that are left out.
    pub(super) fn left_out(&self) -> Vec<&str> {
        self.unknown.iter().map(|(_, header)| header.as_str()).filter(|header| !header.is_empty()).collect()
    }

    /// Refuses columns of numbers without a meaning here. `rows` are those of the dimensions.
    pub(super) fn refuse_numbers(&self, rows: &[&[Content]]) -> Result<(), ImportFault> {
        let width = rows.iter().map(|row| row.len()).max().unwrap_or(0);
        let taken = |place: usize| self.columns.iter().any(|column| column.place == place);
        let mut headers = Vec::new();
        for place in (0..width).filter(|place| !taken(*place)) {
            let cells: Vec<&Content> =
                rows.iter().filter_map(|row| row.get(place)).filter(|cell| **cell != Content::Empty).collect();
            let numbers = cells.iter().filter(|cell| is_figure(cell)).count();
            if numbers > 0 && 2 * numbers >= cells.len() {
                let header = self.unknown.iter().find(|(other, _)| *other == place).map(|(_, header)| header.clone());
                headers.push(header.filter(|header| !header.is_empty()).ok_or_else(|| address(self.row, place)));
            }
        }
        if headers.is_empty() {
            return Ok(());
        }
        let nameless = headers.iter().find_map(|header| header.clone().err());
        if let Some(cell) = nameless {
            return Err(ImportFault::of(cell, ImportProblem::NumbersWithoutHeader));
        }
        let headers = headers.into_iter().flatten().collect();
        Err(ImportFault { cell: None, problem: ImportProblem::Numbers { headers } })
    }
}

/// True for a cell with a number or a tolerance.
fn is_figure(cell: &Content) -> bool {
    match cell {
        Content::Number { .. } => true,
        Content::Text(text) => {
            let text: String = crate::table::clean(text);
            is_number(text.trim_end_matches(['%', ' '])) || !matches!(written(&text), None | Some(Written::Class(_)))
        }
        Content::Empty | Content::Date(_) | Content::Error(_) => false,
    }
}

/// True if a row of the sheet names the required columns.
pub fn has_header(sheet: &Sheet, given: &[(ColumnRole, String)]) -> bool {
    header(sheet, given).is_ok()
}

/// First row with columns for the name and the nominal value.
pub(super) fn header(sheet: &Sheet, given: &[(ColumnRole, String)]) -> Result<Header, ImportFault> {
    let none = |problem| ImportFault { cell: None, problem };
    if sheet.rows.is_empty() {
        return Err(none(ImportProblem::Empty));
    }
    let found = sheet.rows.iter().take(HEADER).position(|(_, row)| {
        holds(row, ColumnRole::Nominal, given) && NAMES.iter().any(|role| holds(row, *role, given))
    });
    let Some(place) = found else {
        // `Maß` and `dimension` head the names of some tables, and the nominal values of others.
        return match nominal_by_numbers(sheet, given) {
            Some(nominal) => header(sheet, &[given, &[(ColumnRole::Nominal, nominal)]].concat()),
            None => Err(none(no_header(sheet, given))),
        };
    };
    let (line, content) = &sheet.rows[place];
    let both = two_rows(content, sheet.rows.get(place + 1).map(|(_, row)| row.as_slice()));
    let end = place + 1 + usize::from(both.is_some());
    let content = both.as_ref().unwrap_or(content);
    let (columns, unknown) = (Vec::new(), Vec::new());
    let mut header = Header { row: *line, columns, either: false, name: ColumnRole::Name, unknown, place, end };
    let mut sign_or_band = None;
    for (place, cell) in content.iter().enumerate() {
        let Content::Text(text) = cell else { continue };
        if let Some((role, _)) = given.iter().find(|(_, header)| text.trim() == header) {
            let unit = heading(cell).and_then(|(_, unit)| unit);
            let column = Column { role: *role, place, header: text.clone(), unit, given: true };
            add(&mut header, column)?;
            continue;
        }
        let (role, unit) = match heading(cell) {
            Some((Heading::Role(role), unit)) => (Some(role), unit),
            Some((Heading::UpperOrMax, unit)) => (Some(ColumnRole::Max), unit),
            Some((Heading::LowerOrMin, unit)) => (Some(ColumnRole::Min), unit),
            Some((Heading::SignOrBand, unit)) => {
                sign_or_band = Some((place, text.clone(), unit));
                continue;
            }
            None => (None, None),
        };
        header.either |= matches!(heading(cell), Some((Heading::UpperOrMax | Heading::LowerOrMin, _)));
        match role {
            Some(role) => add(&mut header, Column { role, place, header: text.clone(), unit, given: false })?,
            None => header.unknown.push((place, text.clone())),
        }
    }
    if let Some((place, text, unit)) = sign_or_band {
        let role = sign_or_band_role(&header, &sheet.rows, place);
        add(&mut header, Column { role, place, header: text, unit, given: false })?;
    }
    leave_out_numbers_of_rows(&mut header, &sheet.rows);
    let has = |role: &ColumnRole| header.columns.iter().any(|column| column.role == *role);
    header.name = NAMES.into_iter().find(|role| has(role)).unwrap_or(ColumnRole::Name);
    Ok(header)
}

/// Header of two rows in one: units below the header, or parts of a header, such as plus and minus below `Tolerance`. Returns None if the second
/// row is another one.
fn two_rows(first: &[Content], second: Option<&[Content]>) -> Option<Vec<Content>> {
    let second = second.filter(|row| row.iter().any(|cell| *cell != Content::Empty))?;
    let width = first.len().max(second.len());
    let joined = |place: usize| {
        let above = first.get(place).unwrap_or(&Content::Empty);
        let text = match second.get(place) {
            None | Some(Content::Empty) => return Some(above.clone()),
            Some(Content::Text(text)) => text,
            Some(_) => return None,
        };
        let role = heading(above);
        let is_name = matches!(role, Some((Heading::Role(role), _)) if NAMES.contains(&role));
        let unit = unit_of(text.trim_matches(['[', ']', '(', ')']));
        match (role, unit) {
            (Some((_, None)), Some(unit)) if !is_name => {
                Some(Content::Text(format!("{} [{unit}]", above.words().unwrap_or_default())))
            }
            _ if is_name => None,
            _ => heading(&second[place]).map(|_| second[place].clone()),
        }
    };
    (0..width).map(joined).collect()
}

/// Header of the nominal values if it is one that heads names elsewhere, beside another column of names and above numbers alone.
fn nominal_by_numbers(sheet: &Sheet, given: &[(ColumnRole, String)]) -> Option<String> {
    /// Headers of names that head nominal values too.
    const EITHER: [&str; 4] = ["mass", "masz", "dimension", "size"];
    if given.iter().any(|(role, _)| *role == ColumnRole::Nominal) {
        return None;
    }
    sheet.rows.iter().take(HEADER).enumerate().find_map(|(place, (_, row))| {
        let of = |column: usize| sheet.rows.iter().skip(place + 1).filter_map(move |(_, row)| row.get(column));
        let is_nominal = |column: &usize| {
            let Some(Content::Text(text)) = row.get(*column) else { return false };
            let mut cells = of(*column).filter(|cell| **cell != Content::Empty).peekable();
            EITHER.contains(&plain(text).as_str()) && cells.peek().is_some() && cells.all(is_figure)
        };
        let column = (0..row.len()).find(is_nominal)?;
        let others = row.iter().enumerate().filter(|(other, _)| *other != column);
        let is_name = |cell: &Content| matches!(heading(cell), Some((Heading::Role(role), _)) if NAMES.contains(&role));
        others.into_iter().any(|(_, cell)| is_name(cell)).then(|| row[column].words()).flatten()
    })
}

/// Leaves out a column `id` of numbers where another column names the dimensions.
fn leave_out_numbers_of_rows(header: &mut Header, rows: &[(u64, Vec<Content>)]) {
    let other = |column: &Column| NAMES.contains(&column.role) && column.role != ColumnRole::Name;
    let has_other = header.columns.iter().any(other);
    let Some(column) = header.columns.iter_mut().find(|column| column.role == ColumnRole::Name) else { return };
    let mut cells = rows.iter().skip(header.end).filter_map(|(_, row)| row.get(column.place));
    let numbers = cells.all(|cell| *cell == Content::Empty || is_figure(cell));
    if has_other && !column.given && plain(&column.header) == "id" && numbers {
        column.role = ColumnRole::Ignore;
    }
}

/// True if a cell of the row is the header of a role.
fn holds(content: &[Content], wanted: ColumnRole, given: &[(ColumnRole, String)]) -> bool {
    let given = given.iter().find(|(role, _)| *role == wanted);
    content.iter().any(|cell| match given {
        Some((_, header)) => is(cell, header),
        None => heading(cell).is_some_and(|(heading, _)| heading == Heading::Role(wanted)),
    })
}

fn is(cell: &Content, header: &str) -> bool {
    matches!(cell, Content::Text(text) if text.trim() == header)
}

/// Fault of a sheet without a header row. A header given by the user that stands in no row is most likely misspelt.
fn no_header(sheet: &Sheet, given: &[(ColumnRole, String)]) -> ImportProblem {
    let stands = |header: &str| sheet.rows.iter().any(|(_, row)| row.iter().any(|cell| is(cell, header)));
    let known = sheet.rows[0].1.iter().filter_map(|cell| match cell {
        Content::Text(text) => Some(text.clone()),
        _ => None,
    });
    if let Some((_, header)) = given.iter().find(|(_, header)| !stands(header)) {
        return ImportProblem::NoColumn { header: header.clone(), known: known.collect() };
    }
    // A row with a name and figures lacks only the nominal value.
    let is = |cell: &Content, name: bool| match heading(cell) {
        Some((Heading::Role(role), _)) => NAMES.contains(&role) == name,
        Some(_) => !name,
        None => false,
    };
    let lacks = |row: &&Vec<Content>| [true, false].iter().all(|name| row.iter().any(|cell| is(cell, *name)));
    match sheet.rows.iter().take(HEADER).map(|(_, row)| row).find(lacks) {
        Some(row) => ImportProblem::NoNominal { headers: row.iter().filter_map(Content::words).collect() },
        None => ImportProblem::NoHeader,
    }
}

/// Adds a column. Of two with the same text role the better header counts, and a role of the user counts before others.
fn add(header: &mut Header, column: Column) -> Result<(), ImportFault> {
    let role = column.role;
    let Some(place) = header.columns.iter().position(|other| other.role == role && role != ColumnRole::Ignore) else {
        header.columns.push(column);
        return Ok(());
    };
    let other = &header.columns[place];
    let text = role == ColumnRole::Name || LABELLED.contains(&role);
    if other.given == column.given && !text {
        let problem = ImportProblem::Twice { role: role_name(role), other: address(header.row, other.place) };
        return Err(ImportFault::of(address(header.row, column.place), problem));
    }
    let better = column.given || !other.given && rank(role, &column.header) < rank(role, &other.header);
    let mut loser = if better { std::mem::replace(&mut header.columns[place], column) } else { column };
    loser.role = ColumnRole::Ignore;
    header.unknown.push((loser.place, loser.header.clone()));
    header.columns.push(loser);
    Ok(())
}

/// Role of a column with the header `+/-`: the direction, unless another column has it or a cell holds something else.
fn sign_or_band_role(header: &Header, rows: &[(u64, Vec<Content>)], place: usize) -> ColumnRole {
    let has = |role: ColumnRole| header.columns.iter().any(|column| column.role == role);
    let below = rows.iter().skip(header.end).filter_map(|(_, row)| row.get(place)?.words());
    let mut words = below.peekable();
    let signs = words.peek().is_some() && words.all(|word| direction(&word).is_some());
    match signs && !has(ColumnRole::Direction) && !has(ColumnRole::Factor) {
        true => ColumnRole::Direction,
        false => ColumnRole::PlusMinus,
    }
}
