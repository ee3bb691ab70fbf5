//! External programs as assembly functions, and the journal that keeps their answers on disk.
//!
//! In a browser there are no programs: the settings of one can be read there, and nothing else.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub mod journal;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub mod process;
mod settings;

pub use settings::{ForeignUnits, Greeting, Listener, Settings};
