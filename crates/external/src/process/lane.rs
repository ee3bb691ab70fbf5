//! Places at which walks are made side by side.

/// Place of a walk: a child, or one of the places at which a child evaluates.
#[derive(Debug)]
pub(super) struct Lane {
    pub(super) slot: usize,
    pub(super) place: Option<String>,
    /// True if a walk has ended here since the child was started, so that the way back to the nominal point is a long step.
    pub(super) used: bool,
}
