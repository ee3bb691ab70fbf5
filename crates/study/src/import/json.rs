//! Tables in JSON: a list of rows, each an object, as other stack-up programs save them.

use serde_json::{Map, Value};

use crate::import::sheet::{Content, Sheet};
use crate::import::text_sheet::stack_sheet;

/// Deepest nesting of objects in a row. The leaves of a deeper one are left out.
const DEEPEST: usize = 4;

/// Sheet of a text: a list of rows in JSON, or columns between tabs, semicolons or commas.
pub fn sheet_of(text: &str) -> Sheet {
    of_json(text.strip_prefix('\u{feff}').unwrap_or(text)).unwrap_or_else(|| stack_sheet(text))
}

/// Sheet of a list of objects, which may stand in an object. Returns None if the text is no JSON of this form.
fn of_json(text: &str) -> Option<Sheet> {
    if !text.trim_start().starts_with(['{', '[']) {
        return None;
    }
    let value: Value = serde_json::from_str(text).ok()?;
    let rows = list(&value, 0)?;
    let flat: Vec<Vec<(String, Content)>> = rows.iter().map(|row| leaves(row)).collect();
    let mut keys: Vec<&String> = Vec::new();
    for (key, _) in flat.iter().flatten() {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    let mut sheet = Sheet::default();
    if let Some(Value::String(title)) = ["title", "name"].iter().find_map(|key| value.get(key)) {
        sheet.rows.push((1, vec![Content::Text(title.clone())]));
    }
    let first = sheet.rows.len() as u64 + 1;
    sheet.rows.push((first, keys.iter().map(|key| Content::Text((*key).clone())).collect()));
    for (line, row) in (first + 1..).zip(&flat) {
        let cell =
            |key: &&String| row.iter().find(|(own, _)| own == *key).map_or(Content::Empty, |(_, cell)| cell.clone());
        sheet.rows.push((line, keys.iter().map(cell).collect()));
    }
    Some(sheet)
}

/// First list of objects in a value.
fn list(value: &Value, depth: usize) -> Option<Vec<&Map<String, Value>>> {
    match value {
        Value::Array(items) if !items.is_empty() => items.iter().map(Value::as_object).collect(),
        Value::Object(entries) if depth < DEEPEST => entries.values().find_map(|entry| list(entry, depth + 1)),
        _ => None,
    }
}

/// Values of an object and of the objects in it, by their own keys.
fn leaves(row: &Map<String, Value>) -> Vec<(String, Content)> {
    let mut found = Vec::new();
    let mut open: Vec<(&Map<String, Value>, usize)> = vec![(row, 0)];
    while let Some((entries, depth)) = open.pop() {
        for (key, value) in entries {
            let cell = match value {
                Value::String(text) if !text.trim().is_empty() => Content::Text(text.trim().to_owned()),
                Value::Number(number) => {
                    let value = number.as_f64().unwrap_or(f64::NAN);
                    Content::Number { value, percent: false, plus: false }
                }
                Value::Bool(truth) => Content::Text(truth.to_string()),
                Value::Object(inner) if depth < DEEPEST => {
                    open.push((inner, depth + 1));
                    continue;
                }
                _ => continue,
            };
            if !found.iter().any(|(known, _)| known == key) {
                found.push((key.clone(), cell));
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_objects_are_tables() {
        let text =
            r#"{ "title": "Play", "rows": [{ "name": "a", "size": { "nominal": 10, "tol": 0.1 } }, { "name": "b" }] }"#;
        let sheet = of_json(text).unwrap();
        assert_eq!(sheet.rows[0].1, [Content::Text("Play".to_owned())]);
        let words = |place: usize| sheet.rows[place].1.iter().map(Content::words).collect::<Vec<_>>();
        assert_eq!(words(1), ["name", "nominal", "tol"].map(|text| Some(text.to_owned())));
        assert_eq!(words(2), ["a", "10", "0.1"].map(|text| Some(text.to_owned())));
        assert_eq!(words(3), [Some("b".to_owned()), None, None]);
        assert!(of_json("name,nominal\n").is_none() && of_json("[1, 2]").is_none() && of_json("{").is_none());
    }
}
