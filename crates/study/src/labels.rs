//! Texts of dimensions and characteristics that have no effect on an analysis.

use crate::entries::file::{CharacteristicEntry, DimensionEntry};
use sensitol_numeric::labels::Labels;

/// Labels of these texts. An empty text counts as none.
fn labels([description, part, drawing, revision, feature]: [&Option<String>; 5]) -> Labels {
    let text = |text: &Option<String>| text.clone().filter(|text| !text.trim().is_empty());
    Labels {
        description: text(description),
        part: text(part),
        drawing: text(drawing),
        revision: text(revision),
        feature: text(feature),
    }
}

impl DimensionEntry {
    pub(super) fn labels(&self) -> Labels {
        labels([&self.description, &self.part, &self.drawing, &self.revision, &self.feature])
    }
}

impl CharacteristicEntry {
    pub(super) fn labels(&self) -> Labels {
        labels([&self.description, &self.part, &self.drawing, &self.revision, &self.feature])
    }
}
