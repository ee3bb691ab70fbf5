//! The output on a terminal: a real one, `tests/children/on_terminal.py`, where colours and progress bars are shown.
//!
//! Texts of others stand in studies, file names, arguments, models and journals. Whatever they hold, no escape sequence of theirs and
//! nothing that turns the direction of text reaches the terminal, on any command.

use std::collections::BTreeSet;
use std::path::Path;
use std::process::Command;

use super::reference::all;
use sensitol_testing::repository;

/// Text that clears the screen, sets the window's title, rings, moves back and turns the direction. C1 codes do so in one character.
const HOSTILE: &str = "\u{1b}[2J\u{1b}]0;title\u{7}\u{8}\u{202e}\u{2066}\u{9b}2J\u{9d}x\u{9c}";

/// Returns the output of a command on a terminal.
fn shown(folder: &Path, arguments: &[&str]) -> String {
    let output = Command::new("python3")
        .arg(repository("tests/children/on_terminal.py"))
        .arg(assert_cmd::cargo::cargo_bin!("sensitol"))
        .args(arguments)
        .current_dir(folder)
        .env("LC_ALL", "C.UTF-8")
        .env("TERM", "xterm-256color")
        .env_remove("NO_COLOR")
        .output()
        .unwrap();
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Returns the first sequence that is neither a colour nor a move of a progress bar within its own lines.
fn obeyed(shown: &str) -> Option<String> {
    let mut rest = shown;
    while let Some(c) = rest.chars().next() {
        let mut taken = c.len_utf8();
        if let Some(after) = rest.strip_prefix("\u{1b}[") {
            let parameters = after.trim_start_matches(|c: char| c.is_ascii_digit() || matches!(c, ';' | '?'));
            let last = parameters.chars().next()?;
            // Allowed: colours, and the cursor of a bar: clear the line (K), up and down (A, B), to a column (G), shown or hidden (h, l).
            if !matches!(last, 'm' | 'K' | 'A' | 'B' | 'G' | 'h' | 'l') {
                return Some(rest.chars().take(8).collect());
            }
            taken = rest.len() - parameters.len() + last.len_utf8();
        } else if c.is_control() && !matches!(c, '\n' | '\r')
            || ('\u{202a}'..='\u{202e}').contains(&c)
            || ('\u{2066}'..='\u{2069}').contains(&c)
        {
            return Some(rest.chars().take(8).collect());
        }
        rest = &rest[taken..];
    }
    None
}

/// Escapes every letter for TOML.
fn escaped(text: &str) -> String {
    text.chars().map(|c| format!("\\u{:04X}", c as u32)).collect()
}

#[test]
fn what_a_terminal_obeys_is_found() {
    assert_eq!(obeyed("plain \u{1b}[1;31mred\u{1b}[0m\r\u{1b}[2K line\n"), None);
    for hostile in ["\u{1b}[2J", "\u{1b}]0;t\u{7}", "\u{7}", "\u{8}", "\u{202e}", "\u{2066}", "\u{9b}2J", "\u{1b}c"] {
        assert!(obeyed(&format!("a{hostile}b")).is_some(), "{hostile:?}");
    }
}

#[test]
fn no_command_obeys_a_name() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).display().to_string();
    let hidden = escaped(HOSTILE);
    let texts =
        format!("title = \"t{hidden}\"\n[dimensions]\na = {{ nominal = 10, tolerance = 0.3, unit = \"m{hidden}\" }}\n");
    // Warnings of every part: an unused dimension, a root without a value, a limit far away.
    let good = format!(
        "{texts}idle = {{ nominal = 1, tolerance = 0.1 }}\n[characteristics]\n\
         gap = {{ formula = \"a + sqrt(a - 9.8)\", lower = 9, require = {{ cpk = 0.5 }}, unit = \"{hidden}\" }}\n\
         [costs]\na = {{ model = \"reciprocal\", b = 1 }}\n"
    );
    // A name that must not appear unchanged in any message.
    let bad = format!("{texts}[characteristics]\n\"y{hidden}\" = {{ formula = \"a + `{hidden}`\" }}\n");
    let json =
        format!("{{\"title\": \"{hidden}\", \"dimensions\": {{\"a{hidden}\": {{\"nominal\": 1}}}}, \"{hidden}\": 1}}");
    std::fs::write(at("good.toml"), &good).unwrap();
    std::fs::write(at("bad.toml"), bad).unwrap();
    std::fs::write(at("bad.json"), json).unwrap();
    // A model that sends the same text as greeting, as failure and on stderr.
    let said = serde_json::to_string(HOSTILE).unwrap();
    std::fs::write(
        at("model.py"),
        format!(
            "import json, sys\nhostile = json.loads({said:?})\nsys.stderr.write(hostile + \"\\n\")\nsys.stdin.readline()\n\
             print(json.dumps({{'ready': True, 'name': 'n' + hostile, 'version': hostile, 'window': 1}}), flush=True)\n\
             for line in sys.stdin:\n    id, x = json.loads(line)['id'], json.loads(line)['x']\n    sys.stderr.write(hostile + \"\\n\")\n    \
             sys.stderr.flush()\n    print(json.dumps({{'id': id, 'y': [x[0]]}} if x[0] < 10.05 else {{'id': id, 'error': hostile}}), flush=True)\n"
        ),
    )
    .unwrap();
    let model = format!(
        "{texts}[characteristics]\ngap = {{ lower = 9 }}\n[model]\ncommand = [\"python3\", \"model.py\", \"{hidden}\"]\nretries = 0\n"
    );
    std::fs::write(at("model.toml"), model).unwrap();
    // A file with a hostile name, as the `*.toml` of a shell returns it.
    let file = format!("{}.toml", HOSTILE.replace('/', ""));
    std::fs::write(at(&file), &good).unwrap();
    let option = format!("--{HOSTILE}");
    // No command writes a file of this name. A study that is there would be watched until an interruption.
    let nowhere = format!("nowhere{HOSTILE}");
    let journal = "model.journal.sqlite";
    let commands: &[&[&str]] = &[
        &["analyze", "good.toml", "-v"],
        &["analyze", "good.toml", "--stack", "text"],
        &["analyze", "good.toml", "--json"],
        &["analyze", "good.toml", "--kc", HOSTILE],
        &["analyze", "bad.toml"],
        &["analyze", "model.toml", "-v"],
        &["simulate", "good.toml", "--samples", "500"],
        &["simulate", "good.toml", "--samples", "500", "--rare"],
        &["simulate", "bad.json"],
        &["merge", "good.toml", HOSTILE],
        &["merge", "good.toml", "bad.json"],
        &["compare", "good.toml", "--samples", "1000"],
        &["compare-lot", "good.toml", HOSTILE],
        &["compare-lot", "bad.toml", "bad.json"],
        &["sweep", "good.toml", "--over", "a=9.9:10.1:2"],
        &["sweep", "good.toml", "--over", HOSTILE],
        &["allocate", "good.toml"],
        &["plan", "good.toml"],
        &["plan", "bad.toml"],
        &["check", "good.toml"],
        &["check", "bad.toml"],
        &["check", "bad.json"],
        &["expand", "good.toml"],
        &["expand", "bad.toml"],
        &["expand", HOSTILE],
        &["check", &file],
        &["check", &file, "good.toml", HOSTILE],
        &["models", HOSTILE],
        &["init", HOSTILE],
        &["examples", "copy", HOSTILE],
        &["schema", "-o", HOSTILE],
        &["schema", &option],
        &["pearson", "--skewness", HOSTILE, "--kurtosis", "3"],
        &["completions", HOSTILE],
        &["man", HOSTILE],
        &["probe", "model.toml"],
        &["workbench", "bad.toml", "--page", HOSTILE],
        &["serve", HOSTILE],
        &["watch", &nowhere],
        &["import", HOSTILE],
        &["evaluate", "bad.toml"],
        &["journal", "show", journal],
        &["journal", "show", HOSTILE],
        &["journal", "export", journal],
        &["journal", "forget", journal, "--yes"],
        &[HOSTILE],
        &[&option],
    ];
    for command in commands {
        let shown = shown(folder.path(), command);
        assert_eq!(obeyed(&shown), None, "{command:?}: {shown:?}");
        assert!(!shown.is_empty() || command[0] == "init" || command[0] == "schema", "{command:?} shows nothing");
    }
    let tried: BTreeSet<&str> = commands.iter().map(|words| words[0]).collect();
    for command in all(&sensitol_cli::command()) {
        let name = command.get_bin_name().unwrap().split(' ').nth(1).unwrap().to_owned();
        assert!(tried.contains(&name[..]), "`{name}` is not tried with hostile texts");
    }
}
