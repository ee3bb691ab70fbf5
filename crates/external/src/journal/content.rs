//! Content of a journal: its version, and the answer to a point.

/// Version of the content, in `PRAGMA user_version`.
pub(super) const VERSION: i32 = 1;

/// Answer to a point: a value, or the reason why there is none.
pub type Answer = Result<f64, String>;
