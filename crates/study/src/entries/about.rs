//! The title block of a study.

use serde::Deserialize;

/// The section `[about]`.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, default)]
pub(crate) struct AboutEntry {
    /// The part or assembly.
    part: Option<String>,
    /// The number of the drawing.
    drawing: Option<String>,
    /// The revision of the drawing.
    revision: Option<String>,
    /// Author of the study.
    author: Option<String>,
    /// Anything else, in one line.
    note: Option<String>,
}

impl AboutEntry {
    /// Cells of the title block that have a text, in their order on a drawing.
    pub(crate) fn cells(self) -> Vec<(&'static str, String)> {
        let Self { part, drawing, revision, author, note } = self;
        let all = [("Part", part), ("Drawing", drawing), ("Revision", revision), ("Author", author), ("Note", note)];
        all.into_iter().filter_map(|(name, text)| Some((name, text?))).collect()
    }
}
