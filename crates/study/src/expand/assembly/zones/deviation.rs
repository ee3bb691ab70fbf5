//! Deviation of a feature as terms of dimensions.

/// Deviation of a feature in its own frame. A part without a term is 0.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Torsor {
    pub(super) shift: [Option<String>; 3],
    pub(super) tilt: [Option<String>; 3],
}

impl Torsor {
    pub(super) fn is_zero(&self) -> bool {
        self.shift.iter().chain(&self.tilt).all(Option::is_none)
    }
}
