//! Texts beside the names of dimensions and characteristics: columns for programs, and a table for people.

use super::Report;
use crate::document::{Cell, Columns, DataTable, Element};
use sensitol_numeric::labels::{LABELS, Labels};

impl<'a, T: 'a> Columns<'a, T> {
    /// A column for each text, for programs.
    pub(super) fn labels(self, of: fn(&T) -> &Labels) -> Self {
        (0..LABELS.len())
            .fold(self, |columns, place| columns.data(LABELS[place], move |row| Cell::optional(of(row).texts()[place])))
    }
}

/// A name with its texts.
type Labelled<'r> = (&'r str, &'r Labels);

/// Letters of a description that a terminal has room for.
const SHORT: usize = 24;

impl Report {
    /// The dimensions that have such texts, in the columns that are not empty; None where none has. Those of a characteristic stand in its section.
    pub(super) fn labels(&self) -> Option<Vec<Element>> {
        let all = self.dimensions.iter().map(|one| (one.name.as_str(), &one.labels));
        let rows: Vec<Labelled<'_>> = all.filter(|(_, labels)| !labels.is_empty()).collect();
        let longest = |place: usize| {
            rows.iter().filter_map(|(_, labels)| labels.texts()[place]).map(|text| text.chars().count()).max()
        };
        let named = Columns::default().named("", "dimension", |row: &Labelled<'_>| Cell::name(row.0));
        let columns = (0..LABELS.len()).fold(named, |columns, place| {
            let cell = move |row: &Labelled<'_>| Cell::optional(row.1.texts()[place]);
            match longest(place) {
                None => columns,
                // A description is as long as its writer likes.
                Some(long) if place == 0 && long > SHORT => columns.page(LABELS[place], cell),
                Some(_) => columns.shown(LABELS[place], cell),
            }
        });
        let table: DataTable = columns.table("", rows.iter().copied());
        (!rows.is_empty()).then(|| vec![Element::Gap, Element::Table(table)])
    }
}
