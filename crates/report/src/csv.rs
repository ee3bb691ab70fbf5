//! CSV files of the tables in reports.

use crate::Report;
use crate::analysis::budget::Budget;
use crate::analysis::stack::{Stack, stack_document};
use crate::document::csv::{csv, joined};
use crate::document::{DataTable, Document};
use crate::figures::Named;

/// Tables of an analysis, except the stacks.
const TABLES: [&str; 6] = ["dimensions", "characteristics", "sensitivities", "interactions", "quantiles", "warnings"];

/// Greatest number of bytes of a characteristic's name in a file name. File systems allow 255 in all.
const LONGEST: usize = 100;

/// One file: its name and its text.
#[derive(Debug, Clone, PartialEq)]
pub struct CsvFile {
    /// Name that is safe on every file system, such as `sensitivities.csv`.
    pub name: String,
    /// Text of the whole table.
    pub text: String,
}

/// Writes the tables of these names in a document, a file each.
pub fn csv_tables(document: &Document, names: &[&str]) -> Vec<CsvFile> {
    names.iter().map(|name| CsvFile { name: format!("{name}.csv"), text: csv(document, name) }).collect()
}

/// Writes the tables of a report: `dimensions.csv`, `characteristics.csv`, `sensitivities.csv`, `interactions.csv`, `quantiles.csv`,
/// `warnings.csv`, and `stack-NAME.csv` for every characteristic.
pub fn csv_files(report: &Report) -> Vec<CsvFile> {
    let names = csv_file_names(report.analysis.characteristics.iter().map(|one| one.name()));
    let document = report.document();
    let tables = TABLES.iter().map(|name| csv(&document, name));
    let stacks = report.stacks().into_iter().map(|stack| stack_csv(&[stack]));
    names.into_iter().zip(tables.chain(stacks)).map(|(name, text)| CsvFile { name, text }).collect()
}

/// Names of the files that [`csv_files`] writes for a report on these characteristics.
pub fn csv_file_names<'n>(characteristics: impl IntoIterator<Item = &'n str>) -> Vec<String> {
    TABLES.iter().map(|name| format!("{name}.csv")).chain(stack_file_names(characteristics)).collect()
}

/// Returns `stack-NAME.csv` for each name. Letters, digits, `-`, `_` and `.` stay, everything else becomes `_`. Names that differ only in
/// case get a number.
fn stack_file_names<'n>(characteristics: impl IntoIterator<Item = &'n str>) -> Vec<String> {
    let mut taken: Vec<String> = Vec::new();
    let safe = |c: char| if c.is_alphanumeric() || ['-', '_', '.'].contains(&c) { c } else { '_' };
    for name in characteristics {
        let kept = name.char_indices().take_while(|(at, c)| at + c.len_utf8() <= LONGEST);
        let stem: String = kept.map(|(_, c)| safe(c)).collect();
        let numbered = |number: usize| match number {
            1 => format!("stack-{stem}.csv"),
            number => format!("stack-{stem}-{number}.csv"),
        };
        let free = |name: &String| !taken.iter().any(|taken| taken.to_lowercase() == name.to_lowercase());
        let name = (1..).map(numbered).find(free).expect("numbers do not end");
        taken.push(name);
    }
    taken
}

/// Writes stacks as one table: dimensions and totals of every characteristic, told apart by the column `row`. In a total, `nominal` is
/// the middle, and `lower` and `upper` are the half-width as deviations.
pub fn stack_csv(stacks: &[Stack]) -> String {
    csv(&stack_document(stacks), "stack")
}

/// Writes the budgets of one or several studies as one table. Several studies add a first column with the study's name.
pub fn budget_csv_of_studies(studies: &[(String, Vec<Budget>)]) -> String {
    let several = studies.len() > 1;
    let tables: Vec<(&str, DataTable)> = studies
        .iter()
        .flat_map(|(study, budgets)| budgets.iter().flat_map(Budget::tables).map(move |table| (study.as_str(), table)))
        .collect();
    joined(tables.iter().map(|(study, table)| (several.then_some(["study", *study]), table)))
}

/// Writes the stacks of several studies as one table, with the study's name before the columns of [`stack_csv`].
pub fn stack_csv_of_studies(studies: &[(String, Vec<Stack>)]) -> String {
    let tables: Vec<(&str, DataTable)> = studies
        .iter()
        .flat_map(|(study, stacks)| stacks.iter().flat_map(Stack::tables).map(move |table| (study.as_str(), table)))
        .collect();
    joined(tables.iter().map(|(study, table)| (Some(["study", *study]), table)))
}
