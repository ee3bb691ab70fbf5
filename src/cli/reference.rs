//! `sensitol completions` and `sensitol man`: made from what can be typed.

use clap::CommandFactory;

use super::args::{Arguments, CompletionsArgs, OutputArgs};
use super::failure::{Exit, Failure};
use super::output::Destination;

pub(super) fn completions(asked: &CompletionsArgs) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(asked.shell, &mut Arguments::command(), "sensitol", &mut script);
    print(&script)
}

/// The command line as it is parsed: what the manual page and `docs/reference/commands.md` are made from.
///
/// ```
/// let analyze = sensitol::cli::command().find_subcommand("analyze").cloned().unwrap();
/// assert!(analyze.get_arguments().any(|option| option.get_long() == Some("method")));
/// ```
pub fn command() -> clap::Command {
    let mut command = Arguments::command();
    command.build();
    command
}

/// One page: the command, and every subcommand below it.
pub(super) fn man() -> Result<Exit, Failure> {
    let mut page = Vec::new();
    let command = command();
    clap_mangen::Man::new(command.clone()).render(&mut page).map_err(Failure::Stdout)?;
    for subcommand in command.get_subcommands().filter(|one| one.get_name() != "help") {
        let man = clap_mangen::Man::new(subcommand.clone());
        page.extend(format!(".SH \"SENSITOL {}\"\n", subcommand.get_name().to_uppercase()).bytes());
        man.render_description_section(&mut page).map_err(Failure::Stdout)?;
        man.render_synopsis_section(&mut page).map_err(Failure::Stdout)?;
        man.render_options_section(&mut page).map_err(Failure::Stdout)?;
    }
    print(&page)
}

fn print(text: &[u8]) -> Result<Exit, Failure> {
    let destination = Destination::open(&OutputArgs { json: false, output: None })?;
    destination.write(&String::from_utf8_lossy(text))?;
    Ok(Exit::Done)
}
