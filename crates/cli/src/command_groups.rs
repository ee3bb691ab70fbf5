//! Groups of the commands in `sensitol --help`.

use std::fmt::Write;

use clap::{CommandFactory, builder::StyledStr};

use crate::args::Arguments;

/// Commands by task, in the order in which people need them.
const GROUPS: [(&str, &[&str]); 5] = [
    ("Analyse", &["analyze", "simulate", "merge", "compare", "compare-lot", "sweep", "watch", "pearson"]),
    ("Allocate tolerances", &["allocate"]),
    ("Write a study", &["init", "examples", "import", "check", "expand", "models", "workbench", "serve", "schema"]),
    ("External models", &["probe", "plan", "evaluate", "journal"]),
    ("Shell", &["completions", "man", "help"]),
];

/// Returns the definition of the command line, with the commands in groups.
pub(crate) fn grouped() -> clap::Command {
    let mut command = Arguments::command();
    command.build();
    let template = template(&command);
    // The built definition stays as it was parsed: only its help has another form.
    Arguments::command().help_template(template)
}

/// Template of the help: about, usage, groups, options, examples.
fn template(command: &clap::Command) -> StyledStr {
    let styles = command.get_styles();
    let (header, literal) = (styles.get_header(), styles.get_literal());
    let widest = command.get_subcommands().map(|one| one.get_name().len()).max().unwrap_or(0);
    let mut text = "{about-with-newline}\n{usage-heading} {usage}\n".to_owned();
    for (title, names) in GROUPS {
        let _ = write!(text, "\n{header}{title}:{header:#}\n");
        for name in names {
            let Some(one) = command.find_subcommand(name) else { continue };
            let about = one.get_about().map(ToString::to_string).unwrap_or_default();
            let _ = writeln!(text, "  {literal}{name:<widest$}{literal:#}  {about}");
        }
    }
    let _ = write!(text, "\n{header}Options:{header:#}\n{{options}}{{after-help}}");
    StyledStr::from(text)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every command belongs to one group, and every name in a group is a command.
    #[test]
    fn every_command_is_in_one_group() {
        let mut command = Arguments::command();
        command.build();
        let mut grouped: Vec<&str> = GROUPS.iter().flat_map(|(_, names)| names.iter().copied()).collect();
        let mut known: Vec<&str> = command.get_subcommands().map(clap::Command::get_name).collect();
        grouped.sort_unstable();
        known.sort_unstable();
        assert_eq!(grouped, known);
    }
}
