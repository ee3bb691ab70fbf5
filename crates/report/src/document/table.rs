//! Tables with typed cells: each column is declared once, with its name in CSV, its title for people, and its cell for a row.

use super::number::{UNKNOWN, short};
use super::{Line, Tone};

/// The content of a cell, for programs.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Nothing.
    Empty,
    /// Text.
    Text(String),
    /// A number, or None where it is unknown.
    Number(Option<f64>),
    /// A count.
    Count(u64),
    /// Whether something is so, or None where that is unknown.
    Truth(Option<bool>),
}

/// A cell: what it holds, and how people read it.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// For programs.
    pub value: Value,
    /// For people.
    pub line: Line,
    /// The text of pages, where terminals have room for less: the whole name, a remark.
    pub full: Option<String>,
    /// The section that it names, by its place in the document: pages lead there.
    pub leads_to: Option<usize>,
}

/// A column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Its name in CSV; empty where CSV does without it.
    pub key: &'static str,
    /// Its title in a terminal.
    pub title: &'static str,
    /// Its title on a page.
    pub heading: &'static str,
    /// Whether a terminal shows it.
    pub terminal: bool,
    /// Whether pages show it.
    pub page: bool,
    /// Whether it holds labels of the columns after it. A terminal without room for all columns keeps these beside it.
    pub label: bool,
}

/// A table.
#[derive(Debug, Clone, PartialEq)]
pub struct DataTable {
    /// The name of its CSV file without the ending; empty where it has none.
    pub name: &'static str,
    /// Its columns.
    pub columns: Vec<Column>,
    /// Its rows, each with a cell for every column.
    pub rows: Vec<Vec<Cell>>,
    /// The rows that people see, in their order; CSV has all.
    pub view: Vec<usize>,
    /// How many of these a terminal shows unless everything is asked for, and how many a page.
    pub most: [usize; 2],
    /// The hint of a terminal where it does not show all.
    pub rest: String,
}

/// A column and its cell for a row.
type Filled<'a, T> = (Column, Box<dyn Fn(&T) -> Cell + 'a>);

/// The columns of a table whose rows are made from values of type `T`.
pub struct Columns<'a, T>(Vec<Filled<'a, T>>);

impl<T> Default for Columns<'_, T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'a, T> Columns<'a, T> {
    fn with(
        mut self,
        [key, title, heading]: [&'static str; 3],
        [terminal, page]: [bool; 2],
        cell: impl Fn(&T) -> Cell + 'a,
    ) -> Self {
        self.0.push((Column { key, title, heading, terminal, page, label: false }, Box::new(cell)));
        self
    }

    /// A column that needs no title in a terminal, as that of names.
    pub fn named(self, key: &'static str, heading: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, "", heading], [true, true], cell)
    }

    /// A column for people and programs.
    pub fn column(self, key: &'static str, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, title, title], [true, true], cell)
    }

    /// A column for which a terminal has no room.
    pub fn wide(self, key: &'static str, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, title, title], [false, true], cell)
    }

    /// A column for people, on pages and in terminals.
    pub fn shown(self, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [true, true], cell)
    }

    /// A column for a terminal, where there is something to show.
    pub fn terminal(self, shows: bool, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [shows, false], cell)
    }

    /// A column for people, where there is something to show.
    pub fn shown_if(self, shows: bool, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [shows; 2], cell)
    }

    /// A column for people, for which a terminal has no room.
    pub fn page(self, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [false, true], cell)
    }

    /// A column for programs.
    pub fn data(self, key: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, "", ""], [false, false], cell)
    }

    /// The table of these rows. People see all of them.
    pub fn table(self, name: &'static str, rows: impl IntoIterator<Item = T>) -> DataTable {
        let rows: Vec<Vec<Cell>> =
            rows.into_iter().map(|row| self.0.iter().map(|(_, cell)| cell(&row)).collect()).collect();
        let columns = self.0.iter().map(|(column, _)| *column).collect();
        DataTable { name, columns, view: (0..rows.len()).collect(), rows, most: [usize::MAX; 2], rest: String::new() }
    }
}

impl DataTable {
    /// The table whose rows are about the sections of its document, in their order: the names lead there.
    pub fn of_sections(mut self) -> Self {
        for (index, row) in self.rows.iter_mut().enumerate() {
            if let Some(name) = row.first_mut() {
                name.leads_to = Some(index);
            }
        }
        self
    }

    /// The table of which people see these rows in this order.
    pub fn seen(mut self, view: Vec<usize>) -> Self {
        self.view = view;
        self
    }

    /// The table of which a terminal shows this many rows unless all are asked for, and a page so many; a terminal then
    /// says what the rest is.
    pub fn at_most(mut self, most: [usize; 2], rest: String) -> Self {
        (self.most, self.rest) = (most, rest);
        self
    }

    /// The table for a terminal that has no room for the columns of these titles, and no file of its own.
    pub fn without(mut self, titles: &[&str]) -> Self {
        self.name = "";
        for column in &mut self.columns {
            column.terminal &= !titles.contains(&column.title);
        }
        self
    }

    /// A table without titles, for terminals and pages.
    pub fn untitled<const N: usize>(rows: impl IntoIterator<Item = [Cell; N]>) -> Self {
        let column = Column { key: "", title: "", heading: "", terminal: true, page: true, label: false };
        let rows: Vec<Vec<Cell>> = rows.into_iter().map(Vec::from).collect();
        Self {
            name: "",
            columns: vec![column; N],
            view: (0..rows.len()).collect(),
            rows,
            most: [usize::MAX; 2],
            rest: String::new(),
        }
    }

    /// The table of which these columns label those after them, beside the first one.
    pub fn labelled_by(mut self, places: &[usize]) -> Self {
        places.iter().for_each(|&place| self.columns[place].label = true);
        self
    }

    /// The places of the columns that are wanted.
    pub fn places(&self, wanted: impl Fn(&Column) -> bool) -> Vec<usize> {
        self.columns.iter().enumerate().filter(|(_, column)| wanted(column)).map(|(place, _)| place).collect()
    }

    /// Whether a column holds numbers, which stand below one another at their right ends.
    pub fn right(&self, place: usize) -> bool {
        let cells = || self.rows.iter().map(|row| &row[place]);
        let number = |cell: &Cell| matches!(cell.value, Value::Number(_) | Value::Count(_));
        cells().any(number) && cells().all(|cell| number(cell) || cell.line.is_empty())
    }
}

impl Cell {
    /// An empty cell.
    pub fn empty() -> Self {
        Self::both(Value::Empty, "")
    }

    /// A number, shown by `show`; the sign for unknown where there is none.
    pub fn number(value: impl Into<Option<f64>>, show: impl FnOnce(f64) -> String) -> Self {
        let value = value.into();
        Self::both(Value::Number(value), value.map_or(UNKNOWN.to_owned(), show))
    }

    /// A number that is left out where it is unknown.
    pub fn known(value: impl Into<Option<f64>>, show: impl FnOnce(f64) -> String) -> Self {
        let value = value.into();
        Self::both(Value::Number(value), value.map_or(String::new(), show))
    }

    /// A number for programs.
    pub fn data(value: impl Into<Option<f64>>) -> Self {
        Self::both(Value::Number(value.into()), "")
    }

    /// A count.
    pub fn count(value: u64) -> Self {
        Self::both(Value::Count(value), value.to_string())
    }

    /// Text.
    pub fn text(text: impl Into<String>) -> Self {
        let text = text.into();
        Self::both(Value::Text(text.clone()), text)
    }

    /// Text, where there is any.
    pub fn optional(text: Option<&str>) -> Self {
        text.map_or_else(Self::empty, Self::text)
    }

    /// A name, which terminals shorten.
    pub fn name(name: &str) -> Self {
        Self { full: Some(name.to_owned()), ..Self::both(Value::Text(name.to_owned()), short(name)) }
    }

    /// A cell with one content for people and another for programs.
    pub fn both(value: Value, line: impl Into<Line>) -> Self {
        Self { value, line: line.into(), full: None, leads_to: None }
    }

    /// The same with more on pages.
    pub fn on_pages(mut self, text: String) -> Self {
        self.full = Some(text);
        self
    }

    /// The text of a page, which has room for whole names.
    pub fn on_page(&self) -> Line {
        self.full.as_deref().map_or_else(|| self.line.clone(), Line::from)
    }

    /// The same in another tone.
    pub fn toned(mut self, tone: Tone) -> Self {
        self.line.0.iter_mut().for_each(|span| span.tone = tone);
        self
    }
}
