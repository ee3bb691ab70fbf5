//! A report as a workbook: the stack with live formulas, and the tables of the report.

mod book;
mod stack;

use rust_xlsxwriter::{DocProperties, Workbook, XlsxError};

use crate::Report;
use crate::document::{Cell, Columns, DataTable, Document, Element, Value};
use crate::output_correlation::together_table;
use book::{Names, tables};

/// Author of a workbook in its properties, and the one who saved it last. A spreadsheet program writes its user's name instead.
pub const AUTHOR: &str = "sensitol";

/// Error of a report that does not fit into a workbook.
#[derive(Debug, thiserror::Error)]
#[error("a workbook cannot hold this report: {0}")]
pub struct WorkbookError(#[from] XlsxError);

/// Writes the sheets `Stack` (one for each characteristic), `Results`, `Contributions`, `Joint`, `Inputs`, `Warnings` and `Study`.
/// Formulas of the stack store the values of the report. If a formula would give another value, the cell holds the reported number
/// instead.
pub fn analyze_xlsx(report: &Report) -> Result<Vec<u8>, WorkbookError> {
    let mut book = Workbook::new();
    book.set_properties(&DocProperties::new().set_author(AUTHOR));
    let mut names = Names::default();
    let stacks = report.stacks();
    for (stack, one) in stacks.iter().zip(&report.analysis.characteristics) {
        let name = if stacks.len() == 1 { "Stack".to_owned() } else { format!("Stack {}", stack.characteristic) };
        stack::write(book.add_worksheet().set_name(names.free(&name))?, stack, one)?;
    }
    let document = report.document();
    for (name, table) in [
        ("Results", "characteristics"),
        ("Contributions", "sensitivities"),
        ("Inputs", "dimensions"),
        ("Warnings", "warnings"),
    ] {
        let found: Vec<&DataTable> = of_name(&document, table).collect();
        if name != "Warnings" || found.iter().any(|table| !table.rows.is_empty()) {
            tables(book.add_worksheet().set_name(names.free(name))?, &found)?;
        }
        if name == "Contributions" {
            let correlations = together_table(&report.analysis.correlations);
            let joint = joint(report);
            let sheet = book.add_worksheet().set_name(names.free("Joint"))?;
            tables(sheet, &[&joint])?;
            book::table(sheet, joint.rows.len() as u32 + 2, &correlations, true)?;
        }
    }
    tables(book.add_worksheet().set_name(names.free("Study"))?, &[&study(report)])?;
    Ok(book.save_to_buffer()?)
}

/// Returns the tables of this name.
fn of_name<'d>(document: &'d Document, name: &'static str) -> impl Iterator<Item = &'d DataTable> {
    document.all().filter_map(move |element| match element {
        Element::Table(table) if table.name == name => Some(table),
        _ => None,
    })
}

/// Builds a table of names and values.
fn pairs(rows: Vec<(&str, Value)>) -> DataTable {
    Columns::default()
        .data("name", |row: &(&str, Value)| Cell::text(row.0))
        .data("value", |row| Cell::both(row.1.clone(), ""))
        .table("", rows)
}

fn joint(report: &Report) -> DataTable {
    let joint = report.analysis.joint.as_ref();
    let verdict = report.analysis.joint_requirement.as_ref().map(|judged| judged.verdict.name().to_owned());
    pairs(vec![
        ("joint_yield", Value::Number(joint.map(|joint| joint.value))),
        ("joint_yield_error", Value::Number(joint.map(|joint| joint.error))),
        ("verdict", verdict.map_or(Value::Empty, Value::Text)),
    ])
}

/// Table of the title block and the origin of the report.
fn study(report: &Report) -> DataTable {
    let text = |text: &str| Value::Text(text.to_owned());
    let head = &report.head;
    let mut rows = vec![("title", head.title.as_deref().map_or(Value::Empty, text))];
    rows.extend(head.block.iter().map(|(name, cell)| (*name, text(cell))));
    rows.extend([
        ("study_sha256", text(&head.study_sha256)),
        ("sensitol", text(head.sensitol)),
        ("schema", Value::Count(u64::from(head.schema))),
        ("method", text(&report.analysis.method.to_string())),
        ("evaluations", Value::Count(report.analysis.run.evaluations)),
        ("failed", Value::Count(report.analysis.run.failed)),
    ]);
    pairs(rows)
}
