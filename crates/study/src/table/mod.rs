//! Tables that people write: their delimiters, and the style of their numbers.

mod number;
mod text;

#[cfg(feature = "import")]
pub(crate) use number::clean;
pub use number::{NumberFault, NumberStyle};
pub use text::{delimiter, records};

/// Delimiters between columns, in the order of trial. The comma is last, since it may be a decimal one.
pub(crate) const DELIMITERS: [u8; 3] = [b'\t', b';', b','];
