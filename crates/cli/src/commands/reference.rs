//! `sensitol completions` and `sensitol man`, generated from the definition of the command line.

use clap::CommandFactory;

use crate::args::{Arguments, CompletionsArgs};
use crate::failure::{Exit, Failure};
use crate::output::Destination;

pub(crate) fn completions(asked: &CompletionsArgs) -> Result<Exit, Failure> {
    let mut script = Vec::new();
    clap_complete::generate(asked.shell, &mut Arguments::command(), "sensitol", &mut script);
    print(&script)
}

/// Definition of the command line, from which the manual page and `docs/reference/commands.md` are generated.
///
/// ```
/// let analyze = sensitol_cli::command().find_subcommand("analyze").cloned().unwrap();
/// assert!(analyze.get_arguments().any(|option| option.get_long() == Some("method")));
/// ```
pub fn command() -> clap::Command {
    let mut command = Arguments::command();
    command.build();
    command
}

/// Exit codes with their meaning, in ascending order.
///
/// ```
/// assert_eq!(sensitol_cli::exit_codes().next().unwrap().0, 0);
/// ```
pub fn exit_codes() -> impl Iterator<Item = (u8, &'static str)> {
    Exit::ALL.into_iter().map(|(exit, meaning)| (exit as u8, meaning))
}

/// Environment variables that the program reads, with their meaning.
const ENVIRONMENT: [(&str, &str); 3] = [
    ("COLUMNS", "width of a report that is not written to a terminal, 80 without it"),
    ("NO_COLOR", "when set, no colours where --color does not ask for them"),
    (
        "LC_ALL, LC_CTYPE, LANG",
        "the first that is set says whether signs beyond ASCII are printed: where it names UTF-8",
    ),
];

/// Prints the manual as one page: the command, then every subcommand.
pub(crate) fn man() -> Result<Exit, Failure> {
    let mut page = Vec::new();
    let command = command();
    clap_mangen::Man::new(command.clone()).render(&mut page).map_err(Failure::Stdout)?;
    for subcommand in command.get_subcommands().filter(|one| one.get_name() != "help") {
        let man = clap_mangen::Man::new(subcommand.clone());
        page.extend(format!(".SH \"SENSITOL {}\"\n", subcommand.get_name().to_uppercase()).bytes());
        man.render_description_section(&mut page).map_err(Failure::Stdout)?;
        man.render_synopsis_section(&mut page).map_err(Failure::Stdout)?;
        man.render_options_section(&mut page).map_err(Failure::Stdout)?;
        if let Some(examples) = subcommand.get_after_help() {
            let examples = examples.to_string();
            let lines = examples.lines().filter(|line| line.starts_with(' ')).map(str::trim);
            page.extend(
                format!(".SS EXAMPLES\n.nf\n{}\n.fi\n", lines.map(roff).collect::<Vec<_>>().join("\n")).bytes(),
            );
        }
    }
    page.extend(b".SH \"EXIT STATUS\"\n");
    for (code, meaning) in exit_codes() {
        page.extend(format!(".TP\n{code}\n{}\n", roff(&meaning.replace('`', ""))).bytes());
    }
    page.extend(b".SH ENVIRONMENT\n");
    for (name, meaning) in ENVIRONMENT {
        page.extend(format!(".TP\n{name}\n{}\n", roff(meaning)).bytes());
    }
    print(&page)
}

/// Escapes text for roff, so that no line of it is a request.
fn roff(text: &str) -> String {
    let text = text.replace('\\', "\\e").replace('-', "\\-");
    if text.starts_with(['.', '\'']) { format!("\\&{text}") } else { text }
}

fn print(text: &[u8]) -> Result<Exit, Failure> {
    Destination::Stdout.write(&String::from_utf8_lossy(text))?;
    Ok(Exit::Done)
}
