//! Texts beside the name of a dimension or characteristic, as on drawings. Reports show them, and analyses ignore them.

use serde::Serialize;

/// Keys in a study, in the order in which reports show them.
pub const LABELS: [&str; 5] = ["description", "part", "drawing", "revision", "feature"];

/// Texts without a meaning to the analysis.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Labels {
    /// Description in a few words.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// Part that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// Number of the drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawing: Option<String>,
    /// Revision of the drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub revision: Option<String>,
    /// Feature of the part, or its number on the drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub feature: Option<String>,
}

impl Labels {
    /// The texts in the order of [`LABELS`].
    pub fn texts(&self) -> [Option<&str>; 5] {
        [&self.description, &self.part, &self.drawing, &self.revision, &self.feature].map(|text| text.as_deref())
    }

    /// True if there is no text.
    pub fn is_empty(&self) -> bool {
        self.texts().iter().all(Option::is_none)
    }

    /// Texts in one line: the description first, then the others with their names. Returns None if there is no text.
    pub fn line(&self) -> Option<String> {
        let one = |(name, text): (&str, Option<&str>)| {
            let text = text?.split_whitespace().collect::<Vec<_>>().join(" ");
            Some(if name == LABELS[0] { text } else { format!("{name} {text}") })
        };
        let all: Vec<String> = LABELS.into_iter().zip(self.texts()).filter_map(one).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }
}
