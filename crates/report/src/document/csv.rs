//! Tables as CSV: a header, then a row for each thing. Numbers have full precision, unknown values are empty cells.
//!
//! RFC 4180, except that lines end without a carriage return.

use crate::document::{Cell, DataTable, Document, Element, Value};

/// Writes all tables of this name in a document as one table. They must have the same columns.
pub fn csv(document: &Document, name: &str) -> String {
    let tables: Vec<&DataTable> = document
        .all()
        .filter_map(|block| match block {
            Element::Table(table) if table.name == name => Some(table),
            _ => None,
        })
        .collect();
    joined(tables.iter().map(|table| (None, *table)))
}

/// Joins tables with the same columns. An optional pair adds a first column to the rows of a table: heading and cell.
pub fn joined<'t>(tables: impl IntoIterator<Item = (Option<[&'t str; 2]>, &'t DataTable)>) -> String {
    let mut text = String::new();
    for (lead, table) in tables {
        let places = table.places(|column| !column.key.is_empty());
        let row = |first: Option<String>, cells: &mut dyn Iterator<Item = String>| {
            first.into_iter().chain(cells).collect::<Vec<_>>().join(",") + "\n"
        };
        if text.is_empty() {
            let titles = &mut places.iter().map(|&place| quoted(table.columns[place].key));
            text = row(lead.map(|[key, _]| quoted(key)), titles);
        }
        for cells in &table.rows {
            text +=
                &row(lead.map(|[_, of]| quoted(&guarded(of))), &mut places.iter().map(|&place| cell(&cells[place])));
        }
    }
    text
}

fn cell(cell: &Cell) -> String {
    match &cell.value {
        Value::Empty | Value::Number(None) | Value::Truth(None) => String::new(),
        Value::Text(text) => quoted(&guarded(text)),
        Value::Number(Some(value)) => number(*value),
        Value::Count(count) => count.to_string(),
        Value::Truth(Some(truth)) => truth.to_string(),
    }
}

/// First characters of a text that a spreadsheet takes for a formula.
const FORMULA: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];

/// Puts an apostrophe before a text that a spreadsheet would take for a formula.
pub fn guarded(text: &str) -> String {
    if text.starts_with(FORMULA) { format!("'{text}") } else { text.to_owned() }
}

/// Returns a text as it was before [`guarded`].
pub fn unguarded(text: &str) -> &str {
    text.strip_prefix('\'').filter(|text| text.starts_with(FORMULA)).unwrap_or(text)
}

fn quoted(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) { format!("\"{}\"", text.replace('"', "\"\"")) } else { text.to_owned() }
}

/// Prints the shortest decimal that reads back as the same double.
fn number(value: f64) -> String {
    if !value.is_finite() {
        return String::new();
    }
    // Adding 0.0 removes the sign of a negative zero.
    let text = format!("{:?}", value + 0.0);
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::document::{Columns, Section};

    /// Tables of one name follow each other below one header. Numbers keep every digit and their sign, and no text is a formula.
    #[test]
    fn tables_of_one_name_are_one() {
        let table = |name: &'static str, value: f64| {
            Columns::default()
                .column("name", "", move |_: &()| Cell::name(name))
                .column("value", "", move |_| Cell::number(value, |_| "rounded".to_owned()))
                .shown("for people", |_| Cell::text("not here"))
                .data("unknown", |_| Cell::data(None))
                .table("both", [()])
        };
        let section = |table| Section { blocks: vec![Element::Table(table)], ..Section::default() };
        let sections = vec![section(table("=1+1", -0.1)), section(table("a, \"b\"", 1e300))];
        let document = Document { sections, ..Document::default() };
        let expected = "name,value,unknown\n'=1+1,-0.1,\n\"a, \"\"b\"\"\",1e300,\n";
        assert_eq!(csv(&document, "both"), expected);
        assert_eq!(csv(&document, "none"), "");
    }
}
