//! Numbers as spreadsheets write them: decimal points or commas, thousands apart, signs of typesetters.
//!
//! The style belongs to a list of cells, a column or a file, because one cell alone may be read in two ways: `1.234` is 1.234, unless
//! another cell shows that points separate thousands (`1.234,50`, `1.234.567`). A comma is a decimal one, unless it separates columns or
//! another cell shows that it separates thousands. A cell that contradicts the others is a fault.

/// How the numbers of some cells are written.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Style {
    /// The first cell that shows which mark is the decimal one, by its place; and whether that is the comma.
    shown: Option<(usize, bool)>,
    /// Whether commas separate columns, so that one in a cell means nothing by itself.
    commas_separate: bool,
    /// The first cell with one point, and with one comma, by their places.
    seen: [Option<usize>; 2],
}

/// Why a cell is not a number.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum NumberFault {
    /// It is none; whether a decimal comma in a table with commas between columns is the reason.
    NoNumber {
        /// Whether a comma is the reason.
        comma: bool,
    },
    /// It is infinite, or beyond a double.
    NotFinite,
    /// Its decimal mark is another one than that of the cell at this place.
    TwoMarks {
        /// Whether its own is the comma.
        comma: bool,
        /// The other cell.
        other: usize,
    },
}

/// A cell without the characters that mean nothing to a number: spaces that do not break, apostrophes between digits, and with the minus of
/// typesetters as a hyphen.
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

/// The digits between two marks of thousands are three, and one to three before the first.
fn grouped(text: &str, mark: char) -> bool {
    let digits = text.trim_start_matches(['+', '-']);
    let mut groups = digits.split(mark);
    let figures = |group: &str| group.bytes().all(|byte| byte.is_ascii_digit());
    groups.next().is_some_and(|first| (1..=3).contains(&first.len()) && figures(first))
        && groups.all(|group| group.len() == 3 && figures(group))
}

/// Whether marks of thousands stand before the decimal mark only, three digits apart.
fn fits(text: &str, decimal: char, mark: char) -> bool {
    let (before, after) = text.split_once(decimal).unwrap_or((text, ""));
    grouped(before, mark) && !after.contains(mark)
}

/// Whether a cell by itself shows that its decimal mark is the comma, or the point; None where it may be either, or no number at all.
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

impl Style {
    /// Of these cells, of a table in which commas separate columns or do not.
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

    /// The number in a cell at this place.
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
        let style = Style::of(cells.iter().copied(), commas_separate);
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
        // Either is a thousand and more, or one and a bit: nothing shows which.
        assert_eq!(read(&["1.234", "0,5"], false), Err((1, NumberFault::TwoMarks { comma: true, other: 0 })));
        assert_eq!(read(&["1.234,5", "1.25"], false), Err((1, NumberFault::TwoMarks { comma: false, other: 0 })));
        assert_eq!(read(&["1,234.5", "1.234,5"], false), Err((1, NumberFault::TwoMarks { comma: true, other: 0 })));
        assert_eq!(read(&["0,5"], true), Err((0, NumberFault::NoNumber { comma: true })));
        assert_eq!(read(&["abc"], false), Err((0, NumberFault::NoNumber { comma: false })));
        assert_eq!(read(&["1e999"], false), Err((0, NumberFault::NotFinite)));
        assert_eq!(read(&["1.2.3"], false), Err((0, NumberFault::NoNumber { comma: false })));
    }
}
