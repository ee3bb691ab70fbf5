//! Documents that the program writes or that quote it.

mod book;
mod claims;
#[path = "../support/command.rs"]
#[allow(dead_code, reason = "each test binary uses a part of it")]
mod command;
mod docs;
mod figures;
mod help;
mod recalculated;
mod reference;
mod report_reference;
mod sentences;
#[cfg(unix)]
mod terminals;
mod words;
