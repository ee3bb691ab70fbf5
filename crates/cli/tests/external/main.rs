//! Commands with external models and their journal.

#[path = "../support/command.rs"]
#[allow(dead_code, reason = "each test binary uses a part of it")]
mod command;
mod failures;
mod history;
mod journal;
mod long_runs;
mod spatial;
#[cfg(unix)]
mod stops;
#[cfg(unix)]
mod storm;
mod strict_check;
