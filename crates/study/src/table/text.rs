//! Splits delimited text into rows of cells.

/// Delimiter of a table: the first candidate that splits the header and the next row into equally many cells, else the header alone.
/// Returns a comma if no candidate does, since there is one column then.
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

/// Rows of a text with their lines, counted from 1. Blank lines are skipped. There is no syntax for comments.
pub fn records(text: &str, delimiter: u8) -> impl Iterator<Item = (u64, csv::StringRecord)> + '_ {
    let reader = csv::ReaderBuilder::new()
        .delimiter(delimiter)
        .has_headers(false)
        .flexible(true)
        .trim(csv::Trim::All)
        .from_reader(text.as_bytes());
    // Reading UTF-8 from memory, with rows of any length, cannot fail.
    reader.into_records().filter_map(Result::ok).map(|row| (row.position().map_or(0, csv::Position::line), row))
}
