//! Rows above the header of a table: title, title block, and the unit of all numbers.

use crate::import::columns::{plain, unit_of};
use crate::import::sheet::Content;

/// Words for the cells of the title block, by their keys in a study.
const ABOUT: [(&str, &[&str]); 5] = [
    ("part", &["part", "assembly", "product", "baugruppe", "teil", "bauteil", "produkt", "benennung"]),
    (
        "drawing",
        &[
            "drawing",
            "drawing no",
            "drawing number",
            "zeichnung",
            "zeichnungsnummer",
            "zeichnungsnr",
            "zeichnungs nr",
            "sachnummer",
        ],
    ),
    ("revision", &["revision", "rev", "index", "anderungsindex", "anderungsstand", "stand"]),
    (
        "author",
        &["author", "engineer", "autor", "ersteller", "erstellt von", "bearbeiter", "prepared by", "created by"],
    ),
    ("note", &["note", "notes", "remark", "bemerkung", "notiz"]),
];
/// Words for the title.
const TITLE: [&str; 6] = ["title", "titel", "study", "analysis", "project", "projekt"];
/// Words for the unit of all numbers.
const UNIT: [&str; 6] = ["unit", "units", "einheit", "einheiten", "all dimensions", "alle masse"];

/// Facts that stand above the header.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct TitleRows {
    pub(super) title: Option<String>,
    /// Keys of `[about]` with their texts.
    pub(super) about: Vec<(&'static str, String)>,
    /// Unit of all numbers.
    pub(super) unit: Option<String>,
}

impl TitleRows {
    /// Reads the rows above the header.
    pub(super) fn of(rows: &[(u64, Vec<Content>)]) -> Self {
        let mut found = Self::default();
        let mut notes: Vec<String> = Vec::new();
        for (_, row) in rows {
            let cells: Vec<String> = row.iter().filter_map(text).collect();
            let Some((first, rest)) = cells.split_first() else { continue };
            let (key, value) = match first.split_once(':') {
                Some((key, value)) if !value.trim().is_empty() => (
                    key.to_owned(),
                    std::iter::once(value.trim().to_owned()).chain(rest.iter().cloned()).collect::<Vec<_>>().join(" "),
                ),
                _ => (first.trim_end_matches(':').to_owned(), rest.join(" ")),
            };
            found.add(&key, &value, &cells.join(" "), &mut notes);
        }
        if !notes.is_empty() && !found.about.iter().any(|(key, _)| *key == "note") {
            found.about.push(("note", notes.join(", ")));
        }
        found
    }

    fn add(&mut self, key: &str, value: &str, whole: &str, notes: &mut Vec<String>) {
        let word = plain(key);
        let known = ABOUT.iter().find(|(_, words)| words.contains(&word.as_str()));
        let last = whole.rsplit(' ').next().unwrap_or_default();
        let in_unit = plain(whole).contains(" in ").then(|| unit_of(last)).flatten();
        if UNIT.contains(&word.as_str()) && unit_of(value).is_some() {
            self.unit = unit_of(value);
        } else if in_unit.is_some() && (plain(whole).contains("mass") || plain(whole).contains("dimension")) {
            self.unit = in_unit;
        } else if TITLE.contains(&word.as_str()) && !value.is_empty() {
            self.title = Some(value.to_owned());
        } else if let Some((key, _)) =
            known.filter(|(key, _)| !value.is_empty() && !self.about.iter().any(|(own, _)| own == key))
        {
            self.about.push((key, value.to_owned()));
        } else if self.title.is_none() {
            self.title = Some(whole.to_owned());
        } else {
            notes.push(whole.to_owned());
        }
    }
}

/// Words of a cell in one line. Returns None for an empty cell.
fn text(cell: &Content) -> Option<String> {
    Some(cell.words()?.split_whitespace().collect::<Vec<_>>().join(" "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_above_the_header_fill_the_title_block() {
        let row = |cells: &[&str]| {
            (
                1,
                cells
                    .iter()
                    .map(|text| if text.is_empty() { Content::Empty } else { Content::Text((*text).to_owned()) })
                    .collect(),
            )
        };
        let rows = [
            row(&["Axialspiel Getriebe"]),
            row(&["Zeichnung:", "4711-B"]),
            row(&["Bearbeiter: Muster", ""]),
            row(&["Alle Maße in mm"]),
            row(&["Stand 3 der Serie"]),
        ];
        let found = TitleRows::of(&rows);
        assert_eq!(found.title.as_deref(), Some("Axialspiel Getriebe"));
        assert_eq!(found.unit.as_deref(), Some("mm"));
        let about = [("drawing", "4711-B"), ("author", "Muster"), ("note", "Stand 3 der Serie")];
        assert_eq!(found.about, about.map(|(key, text)| (key, text.to_owned())));
    }
}
