//! The report of a comparison with a lot: as data and as a document.

mod overlay;
mod sections;
mod words;

use serde::Serialize;

use crate::document::Document;
use crate::{About, Head};
use sensitol::lot::LotComparison;

/// The report of a comparison with a lot, as `--json` prints it. Unknown values are null, never 0.
#[derive(Debug, Clone, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct LotReport {
    /// The common head of every report.
    #[serde(flatten)]
    pub(crate) head: Head,
    /// Files of the lot.
    pub(crate) lot: Vec<String>,
    /// The comparison.
    #[serde(flatten)]
    pub(crate) comparison: LotComparison,
}

impl LotReport {
    /// The report of a comparison with a lot that was read from these files.
    pub fn of(comparison: &LotComparison, lot: Vec<String>, about: About) -> Self {
        Self { head: Head::of("compare-lot", &about), lot, comparison: comparison.clone() }
    }

    /// The text of the comparison: verdicts, a table of the parts, and a section for every characteristic.
    pub fn document(&self) -> Document {
        sections::document(self)
    }
}
