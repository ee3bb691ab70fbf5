//! The command line: the only place that prints.
//!
//! Results go to stdout. Progress, warnings and errors go to stderr. A closed pipe is not an error.

mod advice;
mod args;
mod calendar_date;
mod chromium;
mod command_groups;
mod commands;
mod csv;
mod failure;
mod failure_report;
mod files;
mod interrupt;
mod new_study;
mod output;
mod own_file;
mod page_files;
mod pairs;
mod points;
mod progress;
mod running;
mod sampling;
mod study;
mod table;
mod values;

use crate::commands::allocate;
use crate::commands::analyze;
use crate::commands::check;
use crate::commands::compare;
use crate::commands::difference;
use crate::commands::evaluate;
use crate::commands::examples;
use crate::commands::expand;
use crate::commands::import;
use crate::commands::init;
use crate::commands::journal;
use crate::commands::lot;
use crate::commands::models;
use crate::commands::pearson;
use crate::commands::plan;
use crate::commands::probe;
use crate::commands::reference;
use crate::commands::schema;
use crate::commands::serve;
use crate::commands::several;
use crate::commands::simulate;
use crate::commands::sweep;
use crate::commands::watch;
use crate::commands::workbench;
use std::ffi::OsString;
use std::io::Write;
use std::process::ExitCode;

use clap::error::{ContextKind, ContextValue};
use clap::{CommandFactory, FromArgMatches};

use args::{Arguments, Command};
use failure::{Exit, Failure};
use failure_report::{ErrorDocument, ErrorReport};

pub use crate::commands::reference::{command, exit_codes};
use sensitol_numeric::names::nearest;

/// Prints messages of the argument parser. Help and version are results, everything else is a usage error.
fn told(error: clap::Error, as_json: bool) -> Exit {
    if error.use_stderr() {
        if as_json {
            report_errors(None, vec![ErrorReport::of_usage(&error)]);
        }
        output::usage(&error.render().ansi().to_string());
        return Exit::Usage;
    }
    let printed = error.print().and_then(|()| std::io::stdout().flush());
    match printed {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            let failure = Failure::Stdout(error);
            failure.render().iter().for_each(|message| output::error(message));
            failure.exit()
        }
        _ => Exit::Done,
    }
}

/// Prints errors as JSON on stdout. The text on stderr stays, so that a person reads what a program parses.
fn report_errors(command: Option<String>, errors: Vec<ErrorReport>) {
    if !errors.is_empty() {
        // Nothing is left to do where stdout is closed: the exit code tells the error.
        let _ = output::Destination::Stdout.write(&output::json(&ErrorDocument::of(command, errors)));
    }
}

/// Adds the nearest command to the error of `help analize`, as the parser does for `analize`.
fn with_suggestion(mut error: clap::Error) -> clap::Error {
    let Some(ContextValue::String(found)) = error.get(ContextKind::InvalidSubcommand) else {
        return with_other_command(error);
    };
    if error.get(ContextKind::SuggestedSubcommand).is_none() {
        let command = Arguments::command();
        let known: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        if let Some(nearest) = nearest(found, known) {
            let nearest = ContextValue::Strings(vec![nearest.to_owned()]);
            error.insert(ContextKind::SuggestedSubcommand, nearest);
        }
    }
    error
}

/// Names of Monte Carlo simulation where a method of analysis belongs.
const SIMULATIONS: [&str; 6] = ["monte-carlo", "montecarlo", "monte_carlo", "mc", "simulation", "simulate"];

/// Adds the command `simulate` to the error of `--method monte-carlo`.
fn with_other_command(mut error: clap::Error) -> clap::Error {
    let value = match error.get(ContextKind::InvalidValue) {
        Some(ContextValue::String(value)) => value.to_lowercase(),
        _ => return error,
    };
    let of_method =
        matches!(error.get(ContextKind::InvalidArg), Some(ContextValue::String(arg)) if arg.contains("--method"));
    if of_method && SIMULATIONS.contains(&value.as_str()) {
        let advice = "points are drawn by `sensitol simulate STUDY`".into();
        error.insert(ContextKind::Suggested, ContextValue::StyledStrs(vec![advice]));
    }
    error
}

/// Runs `sensitol analyze` on one study, on several, or on two that are compared.
fn analyze_all(asked: &args::AnalyzeArgs, style: output::Look) -> Result<Exit, Failure> {
    // The format of a budget behind a space is read as a study.
    let format = |study: &std::path::Path| {
        ["text", "csv", "markdown"].into_iter().find(|format| study == std::path::Path::new(format))
    };
    let misplaced = asked.studies.iter().find_map(|study| format(study).filter(|_| !study.exists()));
    match (&asked.studies[..], misplaced) {
        (_, Some(format)) if asked.gum.is_some() => Err(Failure::GumFormat { format }),
        ([old, new], _) if asked.compare => difference::run([old, new], asked, style),
        (studies, _) if asked.compare => Err(Failure::NotTwo { count: studies.len() }),
        ([study], _) if asked.how.configuration.as_deref() != Some(study::ALL) => analyze::run(study, asked, style),
        (studies, _) => several::analyze(studies, asked, style),
    }
}

/// Runs the command with these arguments, the program's name first, and returns its exit code.
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> ExitCode {
    run_code(arguments).into()
}

/// Runs the command like [`run`], and returns the exit code as a number.
pub fn run_code(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let given: Vec<OsString> = arguments.into_iter().collect();
    let as_json = given.iter().any(|argument| argument == "--json");
    let parsed = command_groups::grouped().try_get_matches_from(given);
    let command = parsed.as_ref().ok().and_then(clap::ArgMatches::subcommand_name).map(str::to_owned);
    let arguments = match parsed.and_then(|mut matches| Arguments::from_arg_matches_mut(&mut matches)) {
        Ok(arguments) => arguments,
        Err(error) => return told(with_suggestion(error), as_json) as u8,
    };
    output::set_color(arguments.color);
    let style =
        output::Look { color: arguments.color, quiet: arguments.quiet, verbose: arguments.verbose, study: None };
    let result = match &arguments.command {
        Command::Analyze(asked) => analyze_all(asked, style),
        Command::Simulate(asked) => simulate::run(asked, style),
        Command::Merge(asked) => simulate::shard::merge(asked, style),
        Command::Compare(asked) => compare::run(asked, style),
        Command::CompareLot(asked) => lot::run(asked, style),
        Command::Sweep(asked) => sweep::run(asked, style),
        Command::Watch(asked) => watch::run(asked, style),
        Command::Allocate(asked) => allocate::run(asked, style),
        Command::Plan(asked) => plan::run(asked, style),
        Command::Check(asked) => check::run(asked, arguments.json, style),
        Command::Expand(asked) => expand::run(asked, style),
        Command::Models(asked) => models::run(asked, style),
        Command::Probe(asked) => probe::run(asked, style),
        Command::Examples(asked) => examples::run(asked, arguments.json),
        Command::Evaluate(asked) => evaluate::run(asked, style),
        Command::Journal(asked) => journal::run(asked, style),
        Command::Init(asked) => init::run(asked),
        Command::Import(asked) => import::run(asked, style),
        Command::Workbench(asked) => workbench::run(asked, style),
        Command::Serve(asked) => serve::run(asked),
        Command::Schema(asked) => schema::run(asked),
        Command::Completions(asked) => reference::completions(asked),
        Command::Man => reference::man(),
        Command::Pearson(asked) => pearson::run(asked, style),
    };
    // Errors that were not printed so far are printed here.
    let exit = result.unwrap_or_else(|failure| {
        if let Some(message) = failure.render() {
            output::error(&message);
        }
        if arguments.json {
            report_errors(command, ErrorReport::all(&failure));
        }
        Failure::exit(&failure)
    });
    exit as u8
}
