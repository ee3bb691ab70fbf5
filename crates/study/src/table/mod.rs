//! Tables that people write: their delimiters, and the styles of their numbers.

mod number;
mod text;

pub(crate) use number::clean;
pub use number::{NumberFault, Style};
pub use text::{delimiter, records};

/// Between columns, in the order in which they are tried: a comma may be a decimal one.
pub(crate) const DELIMITERS: [u8; 3] = [b'\t', b';', b','];
