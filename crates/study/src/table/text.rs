//! Delimited text as rows of cells.

/// The delimiter of a table: the first of the candidates that splits the header and the row after it alike, or else the header alone. A
/// comma where none does: there is one column.
pub fn delimiter(text: &str, candidates: [u8; 3]) -> u8 {
    let cells = |delimiter: u8| {
        let mut rows = records(text, delimiter).map(|(_, row)| row.len());
        (rows.next().unwrap_or(0), rows.next())
    };
    let splits = |delimiter: &u8| cells(*delimiter).0 > 1;
    let alike = |delimiter: &u8| {
        let (header, row) = cells(*delimiter);
        header > 1 && row == Some(header)
    };
    let found = candidates.iter().find(|delimiter| alike(delimiter));
    found.or_else(|| candidates.iter().find(|delimiter| splits(delimiter))).copied().unwrap_or(b',')
}

/// The rows of a text, each with its line, counted from 1. Blank lines are left out, and there are no comments.
pub fn records(text: &str, delimiter: u8) -> impl Iterator<Item = (u64, csv::StringRecord)> + '_ {
    let reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    // UTF-8 in memory, with rows of any length, has no errors left.
    reader.into_records().filter_map(Result::ok).map(|row| (row.position().map_or(0, csv::Position::line), row))
}
