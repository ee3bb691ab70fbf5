//! Texts of numbers, directions and names.

use std::collections::BTreeSet;

/// Digits after the point of a coordinate: 1e-9 of the unit is below every accuracy of a CAD system, and hides noise of conversions.
const DECIMALS: i32 = 9;
/// Greatest number of characters of a name.
const LONGEST_NAME: usize = 40;

/// Number with at most nine digits after the point.
pub(super) fn number(value: f64) -> String {
    let scale = 10f64.powi(DECIMALS);
    let rounded = if value.abs() < 1e6 { (value * scale).round() / scale } else { value };
    let rounded = if rounded == 0.0 { 0.0 } else { rounded };
    format!("{rounded}")
}

/// Point as a list.
pub(super) fn point(values: [f64; 3]) -> String {
    list(&values)
}

/// Numbers as a list.
pub(super) fn list(values: &[f64]) -> String {
    format!("[{}]", values.iter().map(|&value| number(value)).collect::<Vec<_>>().join(", "))
}

/// Direction as a word such as "-z", or as a list.
pub(super) fn direction(values: [f64; 3]) -> String {
    for (index, letter) in ["x", "y", "z"].into_iter().enumerate() {
        if values[index].abs() > 1.0 - 1e-12 {
            return format!("\"{}{letter}\"", if values[index] < 0.0 { "-" } else { "" });
        }
    }
    point(values)
}

/// Text of a file in a comment: one line without control characters.
pub(super) fn comment(text: &str) -> String {
    let clean: String = text.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    let words: Vec<&str> = clean.split_whitespace().collect();
    words.join(" ").chars().take(80).collect()
}

/// Name of letters, digits and underscores that begins with a letter.
pub(super) fn name_of(text: &str, otherwise: &str) -> String {
    let mut found = String::new();
    for c in text.trim().chars().take(LONGEST_NAME) {
        match c {
            c if c.is_ascii_alphanumeric() => found.push(c.to_ascii_lowercase()),
            _ if found.ends_with('_') || found.is_empty() => {}
            _ => found.push('_'),
        }
    }
    let found = found.trim_matches('_').to_owned();
    match found.chars().next() {
        None => otherwise.to_owned(),
        Some(c) if c.is_ascii_digit() => format!("{otherwise}_{found}"),
        Some(_) => found,
    }
}

/// Names that are given once.
#[derive(Debug, Default)]
pub(super) struct UniqueNames {
    taken: BTreeSet<String>,
    /// Next number of each name, so that many equal names take no search.
    next: std::collections::HashMap<String, usize>,
}

impl UniqueNames {
    pub(super) fn with(taken: &BTreeSet<String>) -> Self {
        Self { taken: taken.clone(), next: std::collections::HashMap::new() }
    }

    /// The requested name, or with a number if it is taken.
    pub(super) fn take(&mut self, wanted: &str) -> String {
        if self.taken.insert(wanted.to_owned()) {
            return wanted.to_owned();
        }
        loop {
            let next = self.next.entry(wanted.to_owned()).or_insert(1);
            *next += 1;
            let name = format!("{wanted}_{next}");
            if self.taken.insert(name.clone()) {
                return name;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_and_numbers_are_plain() {
        assert_eq!(name_of("NIST PMI FTC 06 ASME1", "part"), "nist_pmi_ftc_06_asme1");
        assert_eq!(name_of("  /\u{e4}\u{f6}", "part"), "part");
        assert_eq!(name_of("4X hole", "part"), "part_4x_hole");
        assert_eq!(number(-1e-12), "0");
        assert_eq!(number(0.1 + 0.2), "0.3");
        assert_eq!(direction([0.0, -1.0, 0.0]), "\"-y\"");
        let mut names = UniqueNames::default();
        assert_eq!(
            [names.take("a"), names.take("a"), names.take("a_2"), names.take("a")],
            ["a", "a_2", "a_2_2", "a_3"]
        );
    }
}
