//! The command line: the only place that prints.
//!
//! Results go to stdout; progress, warnings and errors to stderr. A closed pipe is no error.

mod allocate;
mod analyze;
mod args;
mod check;
mod compare;
mod csv;
mod failure;
mod files;
mod init;
mod interrupt;
mod journal;
mod models;
mod output;
mod pairs;
mod pearson;
mod plan;
mod points;
mod probe;
mod progress;
mod rare;
mod reference;
mod running;
mod schema;
mod simulate;
mod study;
mod sweep;
mod values;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::Parser;

use args::{Arguments, Command};
use failure::{Exit, Failure};

/// Runs the command with these arguments, the program's name first, and says how it went.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    let arguments = match Arguments::try_parse_from(arguments) {
        Ok(arguments) => arguments,
        Err(error) => {
            // Help and version are results, everything else is a usage error; a closed pipe is neither.
            let _ = error.print();
            return if error.use_stderr() { Exit::Usage } else { Exit::Done }.into();
        }
    };
    output::set_color(arguments.color);
    let style = output::Look { color: arguments.color, quiet: arguments.quiet, verbose: arguments.verbose };
    let result = match &arguments.command {
        Command::Analyze(asked) => analyze::run(asked, style),
        Command::Simulate(asked) => simulate::run(asked, style),
        Command::Compare(asked) => compare::run(asked, style),
        Command::Sweep(asked) => sweep::run(asked, style),
        Command::Allocate(asked) => allocate::run(asked, style),
        Command::Plan(asked) => plan::run(asked, style),
        Command::Check(asked) => check::run(asked, style),
        Command::Models(asked) => models::run(asked, style),
        Command::Probe(asked) => probe::run(asked, style),
        Command::Journal(asked) => journal::run(asked, style),
        Command::Init(asked) => init::run(asked),
        Command::Schema(asked) => schema::run(asked),
        Command::Completions(asked) => reference::completions(asked),
        Command::Man => reference::man(),
        Command::Pearson(asked) => pearson::run(asked, style),
    };
    let exit = result.unwrap_or_else(|failure| {
        if let Some(message) = failure.render() {
            output::error(&message);
        }
        Failure::exit(&failure)
    });
    exit.into()
}
