//! Limits of the characteristic in rows of a table that hold no dimension.

use crate::import::columns::ColumnRole;
use crate::import::fault::ImportFault;
use crate::import::figures::Figures;
use crate::import::header::Header;
use crate::import::sheet::{Content, address};
use crate::import::words::limit;

/// Limits that rows state, as indices into [`Figures`].
#[derive(Debug, Default)]
pub(super) struct LimitRows {
    pub(super) lower: Option<usize>,
    pub(super) upper: Option<usize>,
    /// Last row with a limit.
    pub(super) line: u64,
}

impl LimitRows {
    /// Limits in a row without a dimension. Returns true if it has one.
    pub(super) fn read(
        &mut self,
        header: &Header,
        line: u64,
        content: &[Content],
        figures: &mut Figures,
    ) -> Result<bool, ImportFault> {
        if self.read_words(line, content, figures)? {
            return Ok(true);
        }
        let found = self.in_columns(header, line, content, figures)?;
        if found {
            self.line = line;
        }
        Ok(found)
    }

    /// Limits behind words in a row. Returns true if it has one.
    pub(super) fn read_words(
        &mut self,
        line: u64,
        content: &[Content],
        figures: &mut Figures,
    ) -> Result<bool, ImportFault> {
        let found = self.named(line, content, figures)?;
        if found {
            self.line = line;
        }
        Ok(found)
    }

    /// Limits in the columns of greatest and least value.
    fn in_columns(
        &mut self,
        header: &Header,
        line: u64,
        content: &[Content],
        figures: &mut Figures,
    ) -> Result<bool, ImportFault> {
        let mut found = [None, None];
        for (place, role) in [ColumnRole::Min, ColumnRole::Max].into_iter().enumerate() {
            let cell = header.of(role, content);
            if is_number(cell) {
                found[place] = figures.keep_content(&header.cell(role, line), cell, 1.0)?;
            }
        }
        if found == [None, None] {
            return Ok(false);
        }
        [self.lower, self.upper] = found;
        Ok(true)
    }

    /// Limits behind a word: `lower limit; 0,2`, `Grenzen; 0,2; 0,8`, `Grenzen; 0,2 .. 0,8`, `limits 0.2 .. 0.8`.
    fn named(&mut self, line: u64, content: &[Content], figures: &mut Figures) -> Result<bool, ImportFault> {
        let mut any = false;
        for (place, cell) in content.iter().enumerate() {
            let Content::Text(text) = cell else { continue };
            let (word, inside) = word_and_numbers(text);
            let Some(which) = limit(&word) else { continue };
            let at = address(line, place);
            let mut found: Vec<usize> = inside.iter().map(|number| figures.keep(&at, number, 1.0)).collect();
            for (place, cell) in content.iter().enumerate().skip(place + 1) {
                match cell {
                    Content::Empty => {}
                    cell if is_number(cell) => found.extend(figures.keep_content(&address(line, place), cell, 1.0)?),
                    Content::Text(text) => {
                        let (word, both) = word_and_numbers(text);
                        if !word.is_empty() || both.len() != 2 {
                            break;
                        }
                        found.extend(both.iter().map(|number| figures.keep(&address(line, place), number, 1.0)));
                    }
                    _ => break,
                }
            }
            match (which, found.as_slice()) {
                ([true, true], [lower, upper]) => (self.lower, self.upper) = (Some(*lower), Some(*upper)),
                ([true, false], [lower]) => self.lower = Some(*lower),
                ([false, true], [upper]) => self.upper = Some(*upper),
                _ => continue,
            }
            any = true;
        }
        Ok(any)
    }
}

fn is_number(cell: &Content) -> bool {
    match cell {
        Content::Number { percent, .. } => !percent,
        Content::Text(text) => crate::import::tolerance::is_number(&crate::table::clean(text)),
        Content::Empty | Content::Date(_) | Content::Error(_) => false,
    }
}

/// Word at the beginning of a text, and the numbers behind it: `Grenzen: 0,2 .. 0,8`, `min = 0.2`.
fn word_and_numbers(text: &str) -> (String, Vec<String>) {
    let text = crate::table::clean(text);
    let begins = |c: char| c.is_ascii_digit();
    let Some(first) = text.find(begins) else { return (text, Vec::new()) };
    let first = text[..first]
        .rfind(|c: char| !['+', '-', '.', ','].contains(&c))
        .map_or(0, |at| at + text[at..].chars().next().map_or(1, char::len_utf8));
    let (word, rest) = text.split_at(first);
    let rest = rest.replace("...", " ").replace("..", " ").replace("\u{2026}", " ");
    let numbers = rest.split_whitespace().filter(|part| crate::import::tolerance::is_number(part));
    (word.trim_end_matches([':', '=', ' ']).to_owned(), numbers.map(str::to_owned).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn limits_stand_behind_words() {
        let of = |text: &str| word_and_numbers(text);
        let numbers = |all: &[&str]| all.iter().map(|one| (*one).to_owned()).collect::<Vec<_>>();
        assert_eq!(of("Grenzen: 0,2 .. 0,8"), ("Grenzen".to_owned(), numbers(&["0,2", "0,8"])));
        assert_eq!(of("min = -0.2"), ("min".to_owned(), numbers(&["-0.2"])));
        assert_eq!(of("limits 0.2 to 0.8"), ("limits".to_owned(), numbers(&["0.2", "0.8"])));
        assert_eq!(of("lower limit"), ("lower limit".to_owned(), Vec::new()));
    }
}
