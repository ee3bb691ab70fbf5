//! The failures that no input may cause: panic, hang, or break a promise. Each target is a function of bytes.

mod targets;

pub use targets::{TARGETS, Target};
