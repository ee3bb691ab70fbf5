//! Fuzz targets: functions of bytes that must not panic, hang, or break a promise on any input.

mod targets;

pub use targets::{TARGETS, Target};
