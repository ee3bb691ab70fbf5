//! Text of new studies, and their paths in the commands to try next.

use std::path::Path;

use sensitol_study::SCHEMA_FILE;

/// Adds the lines that name the schema to the text of a new study in TOML.
pub(crate) fn with_schema(text: &str) -> String {
    format!(
        "#:schema ./{SCHEMA_FILE}\n# Editors complete and check keys by that file: sensitol schema -o {SCHEMA_FILE}\n{text}"
    )
}

/// Quotes a path for a shell.
pub(crate) fn shell(path: &Path) -> String {
    let text = path.display().to_string();
    let plain = |c: char| c.is_alphanumeric() || "_-./:+,@%".contains(c) || cfg!(windows) && c == '\\';
    match text.chars().all(plain) {
        true => text,
        false if cfg!(windows) => format!("\"{text}\""),
        false => format!("'{}'", text.replace('\'', "'\\''")),
    }
}
