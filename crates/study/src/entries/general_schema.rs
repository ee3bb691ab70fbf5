//! Schema of `[general]`, which is expanded before the study is read into types.

/// The section `[general]`.
#[derive(schemars::JsonSchema)]
#[schemars(deny_unknown_fields)]
#[allow(dead_code, reason = "only its schema is used")]
pub(crate) struct GeneralEntry {
    /// ISO 2768-1 for lengths, and for angles with a `leg`: "ISO 2768-f", m, c or v. An added H, K or L of part 2 has no effect.
    standard: Option<String>,
    /// Half the tolerance of all lengths in mm, in place of a standard.
    length: Option<f64>,
    /// Half the tolerance of all angles in degrees.
    angle: Option<f64>,
}
