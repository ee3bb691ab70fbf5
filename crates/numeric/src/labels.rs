//! Texts beside the name of a dimension or characteristic, as drawings have them. No analysis reads them; reports show them.

use serde::Serialize;

/// The keys of a study, in the order in which reports show them.
pub const LABELS: [&str; 5] = ["description", "part", "drawing", "revision", "feature"];

/// Texts without a meaning to the analysis.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Labels {
    /// A few words on its meaning.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub description: Option<String>,
    /// The part that it belongs to.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub part: Option<String>,
    /// The number of its drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub drawing: Option<String>,
    /// The revision of the drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub revision: Option<String>,
    /// The feature of the part, or its number on the drawing.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub feature: Option<String>,
}

impl Labels {
    /// The texts in the order of [`LABELS`].
    pub fn texts(&self) -> [Option<&str>; 5] {
        [&self.description, &self.part, &self.drawing, &self.revision, &self.feature].map(|text| text.as_deref())
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.texts().iter().all(Option::is_none)
    }

    /// All of them as a line: the description, then the others with their names.
    pub fn line(&self) -> Option<String> {
        let one = |(name, text): (&str, Option<&str>)| {
            let text = text?.split_whitespace().collect::<Vec<_>>().join(" ");
            Some(if name == LABELS[0] { text } else { format!("{name} {text}") })
        };
        let all: Vec<String> = LABELS.into_iter().zip(self.texts()).filter_map(one).collect();
        (!all.is_empty()).then(|| all.join(", "))
    }
}
