//! Documents that the program writes or that quote it.

#[path = "../support/command.rs"]
#[allow(dead_code, reason = "each test binary uses a part of it")]
mod command;
mod book;
mod claims;
mod docs;
mod figures;
mod help;
mod recalculated;
mod reference;
mod report_reference;
#[cfg(unix)]
mod terminals;
mod words;
