//! Runs external programs as assembly functions, with a journal that keeps their answers on disk.
//!
//! A browser runs no programs. Only their settings are available there.

#![cfg_attr(not(test), deny(clippy::disallowed_methods))]

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub mod journal;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub mod process;
mod settings;

pub use settings::{ForeignUnits, Greeting, Listener, Settings};
