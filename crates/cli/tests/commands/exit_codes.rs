//! Table of exit codes: every code results from a command, and has its own word.

use std::collections::BTreeMap;
use std::process::Stdio;

use super::command::sensitol;
use sensitol_testing::repository;

const DIMENSION: &str = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\n";

/// Returns the exit code of a command on a study with this text. `STUDY` among its words stands for the path.
fn code(words: &[&str], characteristic: &str, more: &str) -> i32 {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(&study, format!("{DIMENSION}[characteristics]\ny = {{ {characteristic} }}\n{more}")).unwrap();
    let path = study.display().to_string();
    let words: Vec<&str> = words.iter().map(|&word| if word == "STUDY" { &path } else { word }).collect();
    sensitol(&words).output().unwrap().status.code().unwrap()
}

/// Interrupts a run after it has begun to evaluate, and returns its exit code.
fn interrupted() -> i32 {
    let folder = tempfile::tempdir().unwrap();
    let script = repository("tests/children/storm.py").display().to_string();
    let path = folder.path().display().to_string();
    let study = folder.path().join("study.toml");
    let text = format!(
        "[model]\ncommand = [\"python3\", {script:?}, {path:?}, \"0.05\"]\n{DIMENSION}b = {{ nominal = 1, tolerance = 0.1 }}\n\
         [characteristics]\ny = {{ lower = 0 }}\n"
    );
    std::fs::write(&study, text).unwrap();
    let study = study.display().to_string();
    let mut run = sensitol(&["simulate", &study, "--samples", "100000", "--journal", "none"])
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    // The model's file shows that the run has begun.
    while std::fs::read_dir(&folder).unwrap().count() < 2 {
        assert!(run.try_wait().unwrap().is_none(), "it ended by itself");
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    sensitol_testing::interrupt(run.id());
    run.wait().unwrap().code().unwrap()
}

#[test]
fn every_exit_code_is_met() {
    let costs = "[costs]\na = { model = \"reciprocal\", b = 1, min = 0.2, max = 1 }\n";
    let cases: [(&str, i32, i32); 12] = [
        ("done", code(&["analyze", "STUDY"], "formula = \"a\", lower = 9", ""), 0),
        ("done with a warning", code(&["analyze", "STUDY"], "formula = \"abs(a - 10)\", lower = 0", ""), 0),
        ("met", code(&["analyze", "STUDY", "--check"], "formula = \"a\", lower = 9, target_yield = 0.9", ""), 0),
        ("missed", code(&["analyze", "STUDY", "--check"], "formula = \"a\", lower = 10, target_yield = 0.9", ""), 1),
        ("unknown option", code(&["analyze", "STUDY", "--nonsense"], "formula = \"a\"", ""), 2),
        ("wrong study", code(&["check", "STUDY"], "formula = \"b\"", ""), 2),
        ("no study", code(&["analyze", "nowhere.toml"], "formula = \"a\"", ""), 2),
        ("unwritable", code(&["analyze", "STUDY", "-o", "/nowhere/report"], "formula = \"a\"", ""), 2),
        ("no result", code(&["analyze", "STUDY"], "formula = \"sqrt(a - 20)\"", ""), 3),
        ("allocated", code(&["allocate", "STUDY"], "formula = \"a\", lower = 9, require = { cpk = 1 }", costs), 0),
        ("infeasible", code(&["allocate", "STUDY"], "formula = \"a\", lower = 9.9, require = { cpk = 1 }", costs), 4),
        ("interrupted", interrupted(), 130),
    ];
    for (name, found, expected) in cases {
        assert_eq!(found, expected, "{name}");
    }
    let met: Vec<i32> = BTreeMap::from_iter(cases.map(|(_, _, code)| (code, ()))).into_keys().collect();
    let table: Vec<i32> = sensitol_cli::exit_codes().map(|(code, _)| i32::from(code)).collect();
    assert_eq!(met, table, "a code without a case, or a case without a code");
}

/// The manual page and the reference are generated from the table, in which each code has its own word.
#[test]
fn each_code_has_its_own_word() {
    let words = BTreeMap::from([
        (0, "done"),
        (1, "missed"),
        (2, "wrong"),
        (3, "no result"),
        (4, "no tolerances"),
        (130, "interrupted"),
    ]);
    for (code, meaning) in sensitol_cli::exit_codes() {
        let word = words[&i32::from(code)];
        assert!(meaning.contains(word), "{code}: {meaning}");
    }
}
