//! Cells of a sheet by row and column, with their names in a spreadsheet.

use crate::table::{DELIMITERS, delimiter, records};

/// Content of a cell.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Content {
    /// An empty cell.
    Empty,
    /// Text. Numbers of a text file are also text, since their style follows from the whole table.
    Text(String),
    /// A number of a workbook.
    Number {
        /// Value: 0.02 for 2 %.
        value: f64,
        /// True if the cell shows 0.02 as 2 %.
        percent: bool,
        /// True if the cell shows a positive number with a plus sign.
        plus: bool,
    },
    /// A date or a time in days as workbooks count them; None if it is unknown.
    Date(Option<f64>),
    /// Error value of a spreadsheet formula, such as #REF!.
    Error(String),
}

impl Content {
    /// Text of a cell, and that of a number. Returns None for other cells.
    pub(crate) fn text(&self) -> Option<String> {
        self.words()
    }

    /// Text or plain number, for a column of words. Returns None for other cells.
    pub(super) fn words(&self) -> Option<String> {
        match self {
            Self::Text(text) => Some(text.clone()),
            Self::Number { value, .. } => Some(value.to_string()),
            Self::Empty | Self::Date(_) | Self::Error(_) => None,
        }
    }
}

/// Rows of a table that becomes a study.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    /// Rows with their numbers in the file, from 1.
    pub(crate) rows: Vec<(u64, Vec<Content>)>,
    /// True if commas separate the columns, so that a comma in a cell is not a decimal one.
    pub(crate) commas_separate: bool,
}

impl Sheet {
    /// Sheet of a text with tabs, semicolons or commas between the columns. A first line `sep=;` of a spreadsheet names the separator and is no
    /// row.
    pub fn of_text(text: &str) -> Self {
        let text = text.strip_prefix('\u{feff}').unwrap_or(text);
        let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
        let told = first.trim_end().strip_prefix("sep=").and_then(|mark| mark.bytes().next());
        if let Some(told) = told.filter(|mark| DELIMITERS.contains(mark)) {
            return Self::separated(rest, told);
        }
        Self::separated(text, delimiter(text, DELIMITERS))
    }

    /// Sheet of a text with this delimiter.
    pub(super) fn separated(text: &str, delimiter: u8) -> Self {
        let content = |cell: &str| match cell.trim_matches([' ', '\u{a0}']) {
            "" => Content::Empty,
            text => Content::Text(text.to_owned()),
        };
        let rows = records(text, delimiter).map(|(line, row)| (line, row.iter().map(content).collect())).collect();
        Self { rows, commas_separate: delimiter == b',' }
    }
}

/// Name of a cell, such as B7. Columns count from 0, rows from 1.
pub(crate) fn address(row: u64, column: usize) -> String {
    let (mut letters, mut left) = (String::new(), column + 1);
    while left > 0 {
        letters.insert(0, char::from(b'A' + ((left - 1) % 26) as u8));
        left = (left - 1) / 26;
    }
    format!("{letters}{row}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_have_the_names_of_spreadsheets() {
        let names = [(7, 1, "B7"), (1, 0, "A1"), (3, 25, "Z3"), (3, 26, "AA3"), (2, 701, "ZZ2"), (2, 702, "AAA2")];
        names.into_iter().for_each(|(row, column, name)| assert_eq!(address(row, column), name));
    }
}
