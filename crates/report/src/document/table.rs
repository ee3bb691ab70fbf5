//! Tables with typed cells. Each column is declared once: its key in CSV, its title for readers, and its cell for a row.

use crate::document::number::{UNKNOWN, short};
use crate::document::{Line, Tone};

/// Content of a cell for CSV and JSON.
#[derive(Debug, Clone, PartialEq)]
pub enum Value {
    /// Empty cell.
    Empty,
    /// Text.
    Text(String),
    /// A number, or None if it is unknown.
    Number(Option<f64>),
    /// A count.
    Count(u64),
    /// True or false, or None if that is unknown.
    Truth(Option<bool>),
}

/// Cell of a table: a value for programs and a text for readers.
#[derive(Debug, Clone, PartialEq)]
pub struct Cell {
    /// Value for programs.
    pub value: Value,
    /// Text for readers.
    pub line: Line,
    /// Longer text for pages if terminals have less space: the whole name, a remark.
    pub full: Option<String>,
    /// Index of the section that the cell links to on pages.
    pub leads_to: Option<usize>,
}

/// A column of a table.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name of the column in CSV; empty if CSV leaves it out.
    pub key: &'static str,
    /// Title in a terminal.
    pub title: &'static str,
    /// Title on a page.
    pub heading: &'static str,
    /// True if a terminal shows the column.
    pub terminal: bool,
    /// True if pages show the column.
    pub page: bool,
    /// True if the column labels the columns after it. A terminal that is too narrow for all columns keeps a label beside its columns.
    pub label: bool,
}

/// Table of cells, with its name and its visible rows.
#[derive(Debug, Clone, PartialEq)]
pub struct DataTable {
    /// Name of the CSV file without the extension; empty if there is none.
    pub name: &'static str,
    /// Columns in order.
    pub columns: Vec<Column>,
    /// Rows, each with a cell for every column.
    pub rows: Vec<Vec<Cell>>,
    /// Indices of the rows that readers see, in their order. CSV has all rows.
    pub view: Vec<usize>,
    /// Greatest number of rows that a terminal shows unless everything is requested, and on a page.
    pub most: [usize; 2],
    /// Hint that a terminal prints if it does not show all rows.
    pub rest: String,
}

/// Column with the function that returns its cell for a row.
type Filled<'a, T> = (Column, Box<dyn Fn(&T) -> Cell + 'a>);

/// Columns of a table whose rows are made from values of type `T`.
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

    /// Adds a column without a title in a terminal, such as that of names.
    pub fn named(self, key: &'static str, heading: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, "", heading], [true, true], cell)
    }

    /// Adds a column for readers and CSV.
    pub fn column(self, key: &'static str, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, title, title], [true, true], cell)
    }

    /// Adds a column for pages and CSV, for which a terminal has no space.
    pub fn wide(self, key: &'static str, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, title, title], [false, true], cell)
    }

    /// Adds a column for pages and terminals.
    pub fn shown(self, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [true, true], cell)
    }

    /// Adds a column for terminals if `shows` is true.
    pub fn terminal(self, shows: bool, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [shows, false], cell)
    }

    /// Adds a column for pages and terminals if `shows` is true.
    pub fn shown_if(self, shows: bool, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [shows; 2], cell)
    }

    /// Adds a column for pages only.
    pub fn page(self, title: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with(["", title, title], [false, true], cell)
    }

    /// Adds a column for CSV only.
    pub fn data(self, key: &'static str, cell: impl Fn(&T) -> Cell + 'a) -> Self {
        self.with([key, "", ""], [false, false], cell)
    }

    /// Builds the table of these rows, all of them visible.
    pub fn table(self, name: &'static str, rows: impl IntoIterator<Item = T>) -> DataTable {
        let rows: Vec<Vec<Cell>> =
            rows.into_iter().map(|row| self.0.iter().map(|(_, cell)| cell(&row)).collect()).collect();
        let columns = self.0.iter().map(|(column, _)| *column).collect();
        DataTable { name, columns, view: (0..rows.len()).collect(), rows, most: [usize::MAX; 2], rest: String::new() }
    }
}

impl DataTable {
    /// Links the first cell of each row to the section of the same index.
    pub fn of_sections(mut self) -> Self {
        for (index, row) in self.rows.iter_mut().enumerate() {
            if let Some(name) = row.first_mut() {
                name.leads_to = Some(index);
            }
        }
        self
    }

    /// Sets the visible rows and their order.
    pub fn seen(mut self, view: Vec<usize>) -> Self {
        self.view = view;
        self
    }

    /// Sets the most rows of a terminal (unless all are requested) and of a page, and the terminal's hint at the rest.
    pub fn at_most(mut self, most: [usize; 2], rest: String) -> Self {
        (self.most, self.rest) = (most, rest);
        self
    }

    /// Hides the columns of these titles in a terminal, and drops the CSV name.
    pub fn without(mut self, titles: &[&str]) -> Self {
        self.name = "";
        for column in &mut self.columns {
            column.terminal &= !titles.contains(&column.title);
        }
        self
    }

    /// Builds a table without titles, for terminals and pages.
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

    /// Marks these columns as labels of the columns after them, in addition to the first one.
    pub fn labelled_by(mut self, places: &[usize]) -> Self {
        places.iter().for_each(|&place| self.columns[place].label = true);
        self
    }

    /// Returns the indices of the requested columns.
    pub fn places(&self, wanted: impl Fn(&Column) -> bool) -> Vec<usize> {
        self.columns.iter().enumerate().filter(|(_, column)| wanted(column)).map(|(place, _)| place).collect()
    }

    /// True if a column holds numbers, which are right-aligned.
    pub fn right(&self, place: usize) -> bool {
        let cells = || self.rows.iter().map(|row| &row[place]);
        let number = |cell: &Cell| matches!(cell.value, Value::Number(_) | Value::Count(_));
        cells().any(number) && cells().all(|cell| number(cell) || cell.line.is_empty())
    }
}

impl Cell {
    /// Returns an empty cell.
    pub fn empty() -> Self {
        Self::both(Value::Empty, "")
    }

    /// Returns a cell with a number, shown by `show`, or by the sign for unknown.
    pub fn number(value: impl Into<Option<f64>>, show: impl FnOnce(f64) -> String) -> Self {
        let value = value.into();
        Self::both(Value::Number(value), value.map_or(UNKNOWN.to_owned(), show))
    }

    /// Returns a cell with a number, left empty if it is unknown.
    pub fn known(value: impl Into<Option<f64>>, show: impl FnOnce(f64) -> String) -> Self {
        let value = value.into();
        Self::both(Value::Number(value), value.map_or(String::new(), show))
    }

    /// Returns a cell with a number for CSV only.
    pub fn data(value: impl Into<Option<f64>>) -> Self {
        Self::both(Value::Number(value.into()), "")
    }

    /// Returns a cell with a count.
    pub fn count(value: u64) -> Self {
        Self::both(Value::Count(value), value.to_string())
    }

    /// Returns a cell with text.
    pub fn text(text: impl Into<String>) -> Self {
        let text = text.into();
        Self::both(Value::Text(text.clone()), text)
    }

    /// Returns a cell with text, or an empty one.
    pub fn optional(text: Option<&str>) -> Self {
        text.map_or_else(Self::empty, Self::text)
    }

    /// Returns a cell with a name, which terminals shorten.
    pub fn name(name: &str) -> Self {
        Self { full: Some(name.to_owned()), ..Self::both(Value::Text(name.to_owned()), short(name)) }
    }

    /// Returns a cell with one content for programs and another for readers.
    pub fn both(value: Value, line: impl Into<Line>) -> Self {
        Self { value, line: line.into(), full: None, leads_to: None }
    }

    /// Sets a longer text for pages.
    pub fn on_pages(mut self, text: String) -> Self {
        self.full = Some(text);
        self
    }

    /// Returns the text for a page: the longer text if one is set, otherwise the line.
    pub fn on_page(&self) -> Line {
        self.full.as_deref().map_or_else(|| self.line.clone(), Line::from)
    }

    /// Sets the tone of the whole text.
    pub fn toned(mut self, tone: Tone) -> Self {
        self.line.0.iter_mut().for_each(|span| span.tone = tone);
        self
    }
}
