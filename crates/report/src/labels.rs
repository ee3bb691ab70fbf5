//! Labels beside the names of dimensions and characteristics: columns for programs, and a table for readers.

use crate::Report;
use crate::document::{Cell, Columns, DataTable, Element};
use sensitol_numeric::labels::{LABELS, Labels};

impl<'a, T: 'a> Columns<'a, T> {
    /// Adds a column for each label, for programs.
    pub(super) fn labels(self, of: fn(&T) -> &Labels) -> Self {
        (0..LABELS.len())
            .fold(self, |columns, place| columns.data(LABELS[place], move |row| Cell::optional(of(row).texts()[place])))
    }
}

type Labelled<'r> = (&'r str, &'r Labels);

/// Longest description that a terminal shows, in characters.
const SHORT: usize = 24;

impl Report {
    /// Table of the dimensions with labels, in the columns that are not empty. None if there are none. Those of a characteristic are
    /// in its section.
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
                // Descriptions may be long.
                Some(long) if place == 0 && long > SHORT => columns.page(LABELS[place], cell),
                Some(_) => columns.shown(LABELS[place], cell),
            }
        });
        let table: DataTable = columns.table("", rows.iter().copied());
        (!rows.is_empty()).then(|| vec![Element::Gap, Element::Table(table)])
    }
}
