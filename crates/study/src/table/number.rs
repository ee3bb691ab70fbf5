//! Numbers as spreadsheets write them: decimal points or commas, separators of thousands, typographic minus signs.
//!
//! The style belongs to a list of cells (a column or a file), because one cell alone may be read in two ways. `1.234` is 1.234, unless
//! another cell shows that points separate thousands (`1.234,50`, `1.234.567`). A comma is a decimal comma, unless it separates columns or
//! another cell shows that it separates thousands. A cell that contradicts the others is a fault.

/// Style of the numbers in a list of cells.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct NumberStyle {
    /// Index of the first cell that shows the decimal mark, and true if that mark is the comma. None if no cell shows it.
    shown: Option<(usize, bool)>,
    /// True if commas separate columns, so that one within a cell has no meaning by itself.
    commas_separate: bool,
    /// Indices of the first cell with one point and of the first with one comma.
    seen: [Option<usize>; 2],
}

/// Reasons why a cell is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberFault {
    /// The cell is not a number.
    NoNumber {
        /// True if the reason is a decimal comma in a table with commas between columns.
        comma: bool,
    },
    /// The number is infinite or beyond the range of a double.
    NotFinite,
    /// The decimal mark differs from that of another cell.
    TwoMarks {
        /// True if the mark of this cell is the comma.
        comma: bool,
        /// Index of the other cell.
        other: usize,
    },
}

/// Cell without characters that have no meaning in a number. Non-breaking spaces and apostrophes between digits are removed, and a
/// typographic minus becomes a hyphen.
pub(crate) fn clean(cell: &str) -> String {
    let all: Vec<char> = cell.trim().chars().collect();
    let digit = |place: Option<usize>| place.and_then(|place| all.get(place)).is_some_and(char::is_ascii_digit);
    let kept = |(place, &c): (usize, &char)| match c {
        '\u{a0}' | '\u{202f}' | '\u{2009}' => None,
        '\'' | '\u{2019}' if digit(place.checked_sub(1)) && digit(Some(place + 1)) => None,
        '\u{2212}' => Some('-'),
        c => Some(c),
    };
    all.iter().enumerate().filter_map(kept).collect()
}

/// True if marks separate groups of three digits, the first of them of one to three.
fn grouped(text: &str, mark: char) -> bool {
    let digits = text.trim_start_matches(['+', '-']);
    let mut groups = digits.split(mark);
    let figures = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    groups.next().is_some_and(|first| (1..=3).contains(&first.len()) && figures(first))
        && groups.all(|group| group.len() == 3 && figures(group))
}

/// True if all marks of thousands stand before the decimal mark, three digits apart.
fn fits(text: &str, decimal: char, mark: char) -> bool {
    let (before, after) = text.split_once(decimal).unwrap_or((text, ""));
    grouped(before, mark) && !after.contains(mark)
}

/// True if the cell by itself shows that its decimal mark is the comma, false if the point. Returns None if it may be either or is no
/// number.
fn shows(text: &str) -> Option<bool> {
    let count = |mark: char| text.matches(mark).count();
    let whole = |decimal: char, mark: char| fits(text, decimal, mark).then_some(decimal == ',');
    match (count('.'), count(',')) {
        (1.., 1) if text.rfind('.') < text.rfind(',') => whole(',', '.'),
        (1, 1..) if text.rfind(',') < text.rfind('.') => whole('.', ','),
        (2.., 0) if grouped(text, '.') => Some(true),
        (0, 2..) if grouped(text, ',') => Some(false),
        _ => None,
    }
}

impl NumberStyle {
    /// Style of these cells. `commas_separate` is true if commas separate the columns of their table.
    pub fn of<'c>(cells: impl IntoIterator<Item = &'c str>, commas_separate: bool) -> Self {
        let mut style = Self { commas_separate, ..Self::default() };
        for (place, cell) in cells.into_iter().enumerate() {
            let text = clean(cell);
            if style.shown.is_none() {
                style.shown = shows(&text).map(|comma| (place, comma));
            }
            for (mark, c) in ['.', ','].into_iter().enumerate() {
                if text.matches(c).count() == 1 {
                    style.seen[mark].get_or_insert(place);
                }
            }
        }
        style
    }

    /// Number in the cell with this index.
    pub fn number(&self, place: usize, cell: &str) -> Result<f64, NumberFault> {
        let text = clean(cell);
        let has = |mark: char| text.contains(mark);
        let no_number = NumberFault::NoNumber { comma: false };
        let plain = match self.shown {
            Some((other, true)) if has('.') && !fits(&text, ',', '.') => {
                return Err(if other == place { no_number } else { NumberFault::TwoMarks { comma: false, other } });
            }
            Some((other, false)) if has(',') && !fits(&text, '.', ',') => {
                return Err(if other == place { no_number } else { NumberFault::TwoMarks { comma: true, other } });
            }
            Some((_, true)) => text.replace('.', "").replacen(',', ".", 1),
            Some((_, false)) => text.replace(',', ""),
            None if has(',') && self.commas_separate => return Err(NumberFault::NoNumber { comma: true }),
            None => {
                let comma = has(',');
                let before = self.seen[usize::from(!comma)].filter(|&other| other < place);
                if let Some(other) = before.filter(|_| comma || has('.')) {
                    return Err(NumberFault::TwoMarks { comma, other });
                }
                text.replacen(',', ".", 1)
            }
        };
        match plain.parse::<f64>() {
            Ok(value) if value.is_finite() => Ok(value),
            Ok(_) => Err(NumberFault::NotFinite),
            Err(_) => Err(no_number),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(cells: &[&str], commas_separate: bool) -> Result<Vec<f64>, (usize, NumberFault)> {
        let style = NumberStyle::of(cells.iter().copied(), commas_separate);
        cells
            .iter()
            .enumerate()
            .map(|(place, cell)| style.number(place, cell).map_err(|fault| (place, fault)))
            .collect()
    }

    #[test]
    fn english_and_german_numbers_are_read() {
        assert_eq!(read(&["1.234,50", "2,5", "1.234"], false).unwrap(), [1234.5, 2.5, 1234.0]);
        assert_eq!(read(&["1.234", "2.5"], false).unwrap(), [1.234, 2.5]);
        assert_eq!(read(&["1,234.50", "1,234", "7"], true).unwrap(), [1234.5, 1234.0, 7.0]);
        assert_eq!(read(&["1.234.567", "0,5"], false).unwrap(), [1_234_567.0, 0.5]);
        assert_eq!(
            read(&["\u{2212}0,12", "1'234,5", "1\u{a0}234", "+0,1", "1,5e-3"], false).unwrap(),
            [-0.12, 1234.5, 1234.0, 0.1, 1.5e-3]
        );
        assert_eq!(
            read(&["\u{2212}0.12", "1\u{2019}234.5", ".5", "5.", "1e5"], true).unwrap(),
            [-0.12, 1234.5, 0.5, 5.0, 1e5]
        );
    }

    #[test]
    fn contradictions_name_both_cells() {
        assert_eq!(read(&["0,5", "1.25"], false), Err((1, NumberFault::TwoMarks { comma: false, other: 0 })));
        assert_eq!(read(&["1.25", "0,5"], false), Err((1, NumberFault::TwoMarks { comma: true, other: 0 })));
        // Each may be above a thousand or between one and two: nothing shows which.
        assert_eq!(read(&["1.234", "0,5"], false), Err((1, NumberFault::TwoMarks { comma: true, other: 0 })));
        assert_eq!(read(&["1.234,5", "1.25"], false), Err((1, NumberFault::TwoMarks { comma: false, other: 0 })));
        assert_eq!(read(&["1,234.5", "1.234,5"], false), Err((1, NumberFault::TwoMarks { comma: true, other: 0 })));
        assert_eq!(read(&["0,5"], true), Err((0, NumberFault::NoNumber { comma: true })));
        assert_eq!(read(&["abc"], false), Err((0, NumberFault::NoNumber { comma: false })));
        assert_eq!(read(&["1e999"], false), Err((0, NumberFault::NotFinite)));
        assert_eq!(read(&["1.2.3"], false), Err((0, NumberFault::NoNumber { comma: false })));
    }
}
