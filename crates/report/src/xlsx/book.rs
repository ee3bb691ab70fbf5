//! Names of sheets, texts and tables within the rules of a workbook.

use rust_xlsxwriter::{Format, Worksheet, XlsxError};

use crate::document::{Cell, DataTable, Value};

/// Greatest length of a cell's text, in UTF-16 units: a rule of the file format.
const TEXT: usize = 32_767;
/// Greatest length of a sheet's name, in UTF-16 units: a rule of the file format.
const NAME: usize = 31;
/// Width of a column in letters.
const WIDE: f64 = 16.0;

/// Names of sheets that differ by more than case.
#[derive(Default)]
pub(super) struct Names(Vec<String>);

impl Names {
    /// Returns a name of at most 31 letters, without forbidden signs, that no other sheet has.
    pub(super) fn free(&mut self, wanted: &str) -> String {
        let letter = |c: char| if c.is_control() || "[]:*?/\\'".contains(c) { '_' } else { c };
        let wanted: Vec<char> = wanted.chars().map(letter).collect();
        let numbered = |number: usize| {
            let end = if number == 1 { String::new() } else { format!(" {number}") };
            // Letters beyond U+FFFF count twice.
            let (mut name, mut left) = (String::new(), NAME - end.len());
            for c in &wanted {
                let Some(rest) = left.checked_sub(c.len_utf16()) else { break };
                left = rest;
                name.push(*c);
            }
            name + &end
        };
        let free = |name: &String| !self.0.iter().any(|other| other.to_lowercase() == name.to_lowercase());
        let name = (1..).map(numbered).find(free).expect("numbers do not end");
        self.0.push(name.clone());
        name
    }
}

/// Writes text, never a formula. A text that is too long for a cell is cut.
pub(super) fn text(sheet: &mut Worksheet, row: u32, column: u16, text: &str, format: &Format) -> Result<(), XlsxError> {
    let mut left = TEXT;
    let kept = |c: &char| {
        let fits = left.checked_sub(c.len_utf16());
        left = fits.unwrap_or(0);
        fits.is_some()
    };
    let text: String = text.chars().take_while(kept).collect();
    sheet.write_string_with_format(row, column, text, format).map(|_| ())
}

/// Writes the headers of a table if `header` is set, then its rows, from row `from` on.
pub(super) fn table(sheet: &mut Worksheet, from: u32, table: &DataTable, header: bool) -> Result<(), XlsxError> {
    let places = table.places(|column| !column.key.is_empty());
    let (bold, plain) = (Format::new().set_bold(), Format::new());
    let mut row = from;
    if header {
        for (column, &place) in (0u16..).zip(&places) {
            text(sheet, row, column, table.columns[place].key, &bold)?;
        }
        row += 1;
    }
    for cells in &table.rows {
        for (column, &place) in (0u16..).zip(&places) {
            cell(sheet, row, column, &cells[place], &plain)?;
        }
        row += 1;
    }
    Ok(())
}

/// Writes tables with the same columns below one frozen header.
pub(super) fn tables(sheet: &mut Worksheet, all: &[&DataTable]) -> Result<(), XlsxError> {
    let mut row = 0;
    for (place, one) in all.iter().enumerate() {
        table(sheet, row, one, place == 0)?;
        row += one.rows.len() as u32 + u32::from(place == 0);
    }
    sheet.set_freeze_panes(1, 1)?;
    let columns = all.iter().map(|table| table.columns.len()).max().unwrap_or(0);
    (0..columns as u16).try_for_each(|column| sheet.set_column_width(column, WIDE).map(|_| ()))
}

fn cell(sheet: &mut Worksheet, row: u32, column: u16, cell: &Cell, plain: &Format) -> Result<(), XlsxError> {
    match &cell.value {
        Value::Empty | Value::Number(None) | Value::Truth(None) => Ok(()),
        Value::Text(found) => text(sheet, row, column, found, plain),
        Value::Number(Some(value)) => number(sheet, row, column, *value, plain),
        Value::Count(count) => number(sheet, row, column, *count as f64, plain),
        Value::Truth(Some(truth)) => sheet.write_boolean(row, column, *truth).map(|_| ()),
    }
}

/// Writes a number; the cell stays empty if it is not finite.
pub(super) fn number(
    sheet: &mut Worksheet,
    row: u32,
    column: u16,
    value: f64,
    format: &Format,
) -> Result<(), XlsxError> {
    if !value.is_finite() {
        return Ok(());
    }
    sheet.write_number_with_format(row, column, value, format).map(|_| ())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sheets_have_names_of_their_own() {
        let mut names = Names::default();
        assert_eq!(names.free("Stack gap"), "Stack gap");
        assert_eq!(names.free("stack GAP"), "stack GAP 2");
        assert_eq!(names.free("a/b:c[d]'"), "a_b_c_d__");
        let long = names.free(&"x".repeat(40));
        assert_eq!(long.len(), 31);
        assert_eq!(names.free(&"x".repeat(40)), format!("{} 2", "x".repeat(29)));
        // Each of these letters takes two units.
        assert_eq!(names.free(&"\u{1d70e}".repeat(20)).chars().count(), 15);
    }
}
