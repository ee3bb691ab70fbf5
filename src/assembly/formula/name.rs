//! Plain names, which formulas contain without backquotes.

/// Returns the length in bytes of the plain name that a text begins with: a letter or `_`, then letters, digits and `_`.
pub(super) fn plain_length(text: &str) -> Option<usize> {
    let begins = text.starts_with(|c: char| c.is_alphabetic() || c == '_');
    begins.then(|| text.find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(text.len()))
}

/// True if a name can be written in a formula without backquotes.
pub fn is_plain(name: &str) -> bool {
    plain_length(name) == Some(name.len())
}
