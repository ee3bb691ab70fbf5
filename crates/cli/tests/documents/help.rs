//! The whole command line: every command has its help, an example that can be typed, and an error with its exit code. Completions load,
//! and the manual page is typeset without a warning.

use std::collections::BTreeSet;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

use super::command::{run, sensitol};
use super::reference::{all, examples};
use sensitol_testing::repository;

/// Returns the words of every command, such as `["journal", "show"]`.
fn commands() -> Vec<Vec<String>> {
    let words = |command: &clap::Command| -> Vec<String> {
        command.get_bin_name().unwrap().split(' ').skip(1).map(str::to_owned).collect()
    };
    all(&sensitol_cli::command()).iter().map(words).collect()
}

/// Prints on the terminal, even if output is captured, that something could not be tested.
#[expect(clippy::explicit_write, reason = "what eprintln! says is not shown when a test passes")]
pub fn skipped(what: &str) {
    writeln!(std::io::stderr(), "SKIPPED: {what}").unwrap();
}

pub fn installed(program: &str) -> bool {
    let found = Command::new(program).arg("--version").stdout(Stdio::null()).stderr(Stdio::null()).status();
    found.is_ok()
}

#[test]
fn every_command_has_help() {
    for words in commands() {
        let arguments: Vec<&str> = words.iter().map(String::as_str).chain(["--help"]).collect();
        insta::assert_snapshot!(format!("help-{}", words.join("-")), run(&arguments));
    }
    insta::assert_snapshot!("help-all", run(&["--help"]));
    insta::assert_snapshot!("help-of-journal", run(&["journal", "--help"]));
}

/// `-h` lists the common options and fits into a window. `--help` lists all of them, with longer texts.
#[test]
fn short_help_fits_a_window() {
    for words in commands() {
        let [short, long] = ["-h", "--help"].map(|flag| {
            let arguments: Vec<&str> = words.iter().map(String::as_str).chain([flag]).collect();
            let output = sensitol(&arguments).env("COLUMNS", "100").output().unwrap();
            String::from_utf8(output.stdout).unwrap().lines().count()
        });
        // Lines of a terminal with the height of a common screen.
        assert!(short <= 60, "{words:?}: {short} lines");
        assert!(short < long || long <= 60, "{words:?}: {short} lines and {long}");
    }
    let short = run(&["analyze", "-h"]);
    assert!(short.contains("--accuracy <R>") && !short.contains("--accuracy-skewness"), "{short}");
    assert!(short.contains("see more with '--help'"), "{short}");
}

/// One likely mistake for each command: exit code 2, nothing on stdout.
#[test]
fn every_command_refuses_what_is_wrong() {
    let wrong: &[&[&str]] = &[
        &["analyze", "nowhere.toml"],
        &["simulate", "nowhere.toml"],
        &["merge", "examples/stacked-blocks/study.toml", "nowhere.json"],
        &["compare", "nowhere.toml"],
        &["compare-lot", "examples/housing-lot/study.toml", "nowhere.csv"],
        &["sweep", "examples/stacked-blocks/study.toml"],
        &["allocate", "nowhere.toml"],
        &["plan", "nowhere.toml"],
        &["check", "nowhere.toml"],
        &["models", "rocket"],
        &["expand", "nowhere.toml"],
        &["init", "no-such-folder/gap"],
        &["examples", "list", "rocket"],
        &["examples", "copy", "rocket"],
        &["import", "no-such.csv"],
        &["workbench", "nowhere.toml"],
        &["serve", "nowhere"],
        &["watch", "nowhere.toml"],
        &["schema", "-o", "/nowhere/study.schema.json"],
        &["pearson", "--skewness", "1", "--kurtosis", "1.9"],
        &["completions", "tcsh"],
        &["man", "analyze"],
        &["probe", "nowhere.toml"],
        &["evaluate", "nowhere.toml"],
        &["journal", "show", "nowhere.sqlite"],
        &["journal", "export", "nowhere.sqlite"],
        &["journal", "forget", "nowhere.sqlite"],
    ];
    let mut known = BTreeSet::new();
    let mut all = String::new();
    for arguments in wrong {
        let output = sensitol(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(error.starts_with("error: "), "{arguments:?}: {error}");
        all += &format!("$ sensitol {}\n{error}\n", arguments.join(" "));
        known.insert(
            arguments[0].to_owned() + if ["journal", "examples"].contains(&arguments[0]) { arguments[1] } else { "" },
        );
    }
    insta::assert_snapshot!("every-command-refuses", all);
    let expected: BTreeSet<String> = commands().iter().map(|words| words.concat()).collect();
    assert_eq!(known, expected, "a command without a test of its errors");
    for words in commands() {
        let arguments: Vec<&str> = words.iter().map(String::as_str).chain(["--nonsense"]).collect();
        assert_eq!(sensitol(&arguments).output().unwrap().status.code(), Some(2), "{arguments:?}");
    }
}

/// Every example belongs to its command and can be parsed. Files below `examples` that it names exist.
#[test]
fn every_command_has_an_example_that_can_be_typed() {
    for command in all(&sensitol_cli::command()) {
        let name = command.get_bin_name().unwrap();
        let lines = examples(&command);
        assert!(!lines.is_empty(), "{name} has no `Examples:`");
        for line in lines {
            assert!(line.starts_with(name), "{name}: {line}");
            // Split as a shell does. Only commands of this program are parsed, without their redirection.
            for part in line.split(" && ").flat_map(|part| part.split(" | ")) {
                let own = part.split(" > ").next().unwrap();
                let words: Vec<&str> = own.split_whitespace().collect();
                if words[0] == "sensitol" {
                    let parsed = sensitol_cli::command().try_get_matches_from(&words);
                    assert!(parsed.is_ok(), "{line}: {}", parsed.unwrap_err());
                    for file in words.iter().filter(|word| word.starts_with("examples/")) {
                        assert!(repository(file).exists(), "{line}: there is no {file}");
                    }
                }
            }
        }
    }
}

/// Returns the output of a shell for a script on the command line, with the completions for this shell in its folder.
fn shell(folder: &Path, name: &str, arguments: &[&str]) -> Option<String> {
    let output = sensitol(&["completions", name]).output().unwrap();
    assert!(output.status.success());
    std::fs::write(folder.join(name), output.stdout).unwrap();
    if !installed(name) {
        skipped(&format!("completions of {name}, which is not installed"));
        return None;
    }
    let output = Command::new(name).args(arguments).current_dir(folder).env("HOME", folder).output().unwrap();
    assert!(output.stderr.is_empty(), "{name}: {}", String::from_utf8_lossy(&output.stderr));
    Some(String::from_utf8(output.stdout).unwrap())
}

#[test]
fn completions_load_in_zsh_and_fish() {
    let folder = tempfile::tempdir().unwrap();
    let zsh =
        "autoload -U compinit; compinit -u -D; source ./zsh; print -r -- ${_comps[sensitol]}; whence -w _sensitol";
    if let Some(said) = shell(folder.path(), "zsh", &["-f", "-c", zsh]) {
        assert_eq!(said, "_sensitol\n_sensitol: function\n");
    }
    let fish = "source ./fish; complete -C 'sensitol allo'";
    if let Some(said) = shell(folder.path(), "fish", &["--no-config", "-c", fish]) {
        assert!(said.starts_with("allocate\t") && said.lines().count() == 1, "{said}");
    }
}

#[test]
fn the_manual_page_is_set_without_a_warning() {
    let page = sensitol(&["man"]).output().unwrap().stdout;
    let text = String::from_utf8(page.clone()).unwrap();
    for section in [".SH NAME", ".SH SYNOPSIS", ".SH DESCRIPTION", ".SH OPTIONS", ".SH SUBCOMMANDS"] {
        assert!(text.lines().any(|line| line == section), "{section}");
    }
    if !installed("groff") {
        return skipped("the setting of the manual page: groff is not installed");
    }
    // Plain text without overstriking and escapes.
    let mut groff = Command::new("groff")
        .args(["-man", "-ww", "-Tutf8", "-P-cbou"])
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let mut input = groff.stdin.take().unwrap();
    let writing = std::thread::spawn(move || input.write_all(&page).unwrap());
    let output = groff.wait_with_output().unwrap();
    writing.join().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    let set = String::from_utf8(output.stdout).unwrap();
    for section in [
        "NAME",
        "SYNOPSIS",
        "DESCRIPTION",
        "OPTIONS",
        "SENSITOL ANALYZE",
        "SENSITOL JOURNAL",
        "EXIT STATUS",
        "ENVIRONMENT",
    ] {
        assert!(set.lines().any(|line| line == section), "{section}: {set}");
    }
    // Lines are justified: spaces between words do not count.
    let words = set.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(words.contains("Statistical tolerance analysis for anything you can compute"), "{set}");
}
