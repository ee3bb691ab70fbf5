//! Warnings as a page shows them: what happened, and what to do in sentences.

use serde::Serialize;

use super::super::WarningReport;

/// A warning with its advice in words.
#[derive(Serialize)]
pub(super) struct Warned<'r> {
    code: &'static str,
    message: &'r str,
    actions: Vec<String>,
}

impl<'r> Warned<'r> {
    /// Those of this characteristic.
    pub(super) fn about(all: &'r [WarningReport], name: &str) -> Vec<Self> {
        all.iter().filter(|warning| warning.characteristic.as_deref() == Some(name)).map(Self::of).collect()
    }

    pub(super) fn of(warning: &'r WarningReport) -> Self {
        let actions = warning.advice.iter().map(ToString::to_string).collect();
        Self { code: warning.code, message: &warning.message, actions }
    }
}
