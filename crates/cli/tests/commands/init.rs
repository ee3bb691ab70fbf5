//! The first study, completions and the manual page.

use std::path::Path;
use std::process::{Command, Output};

use sensitol_models::ALL;

use super::command::{run, sensitol};
use sensitol_testing::repository;

fn within(folder: &Path, arguments: &[&str]) -> Output {
    sensitol(arguments).current_dir(folder).output().unwrap()
}

/// Returns stdout if the command succeeded, else panics with its stderr.
#[track_caller]
fn done(output: &Output) -> String {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout.clone()).unwrap()
}

/// The study of `init` is valid and runs unchanged, and its printed next commands work.
#[test]
fn every_first_study_runs() {
    let folder = tempfile::tempdir().unwrap();
    let said = done(&within(folder.path(), &["init"]));
    assert_eq!(said, "written: study.toml\nnext: sensitol analyze study.toml\n      sensitol allocate study.toml\n");
    done(&within(folder.path(), &["check", "study.toml"]));
    // The tutorial explains the missed target.
    assert!(done(&within(folder.path(), &["analyze", "study.toml"])).contains("target 99.73 %: MISSED"));
    assert_eq!(within(folder.path(), &["analyze", "study.toml", "--check"]).status.code(), Some(1));
    assert!(done(&within(folder.path(), &["allocate", "study.toml"])).starts_with("local-optimum: cost"));
    // The example and the tutorial show the same study, without the two lines on its schema.
    let example = std::fs::read_to_string(repository("examples/first-study/study.toml")).unwrap();
    let written = std::fs::read_to_string(folder.path().join("study.toml")).unwrap();
    assert_eq!(written.splitn(3, '\n').nth(2), Some(&*example));
    done(&within(folder.path(), &["init", "gap", "--process"]));
    done(&within(folder.path(), &["probe", "gap.toml"]));
    assert!(done(&within(folder.path(), &["analyze", "gap.toml"])).contains("gap [mm]"));
    let said = done(&within(folder.path(), &["init", "cover", "--assembly"]));
    assert!(said.ends_with("next: sensitol check cover.toml\n      sensitol analyze cover.toml\n"), "{said}");
    let said = done(&within(folder.path(), &["check", "cover.toml"]));
    assert!(said.contains("2 parts, 3 joints: 6 unknowns, 6 equations"), "{said}");
    assert!(done(&within(folder.path(), &["analyze", "cover.toml"])).contains("target 99.73 %: met"));
    for model in ALL {
        let name = format!("{}.toml", model.name);
        done(&within(folder.path(), &["init", &name, "--model", model.name]));
        let report = done(&within(folder.path(), &["analyze", &name, "--method", "second-order"]));
        assert!(report.contains("sigma"), "{name}: {report}");
    }
}

/// Every kind runs as it is without a warning, keeps its target, and names the commands that follow. A drawing shows what it is about.
#[test]
fn every_kind_runs() {
    let folder = tempfile::tempdir().unwrap();
    let kinds: [(&str, &[&str]); 5] = [
        ("stack", &["analyze", "allocate"]),
        ("fit", &["analyze"]),
        ("measured", &["analyze"]),
        ("position", &["analyze"]),
        ("loop", &["analyze"]),
    ];
    for (kind, next) in kinds {
        let said = done(&within(folder.path(), &["init", kind, &format!("--{kind}")]));
        let commands: Vec<String> = next.iter().map(|command| format!("sensitol {command} {kind}.toml")).collect();
        assert_eq!(said, format!("written: {kind}.toml\nnext: {}\n", commands.join("\n      ")));
        let text = std::fs::read_to_string(folder.path().join(format!("{kind}.toml"))).unwrap();
        assert!(kind == "measured" || text.lines().any(|line| line.starts_with("#   ")), "{kind} has no drawing");
        assert!(text.lines().all(|line| line.chars().count() <= 160), "{kind}");
        for command in next {
            let output = within(folder.path(), &[command, &format!("{kind}.toml")]);
            assert!(output.stderr.is_empty(), "{kind}: {}", String::from_utf8_lossy(&output.stderr));
            done(&output);
        }
        done(&within(folder.path(), &["analyze", &format!("{kind}.toml"), "--check"]));
    }
    // The clearance of H7/g6 at 25 mm lies between 7 and 41 um, by the tables of ISO 286.
    let fit = done(&within(folder.path(), &["analyze", "fit.toml"]));
    assert!(fit.contains("worst case      0.0070000 .. 0.0410000"), "{fit}");
    // Two kinds at once are a mistake.
    assert_eq!(within(folder.path(), &["init", "both", "--fit", "--stack"]).status.code(), Some(2));
    assert!(!folder.path().join("both.toml").exists());
}

/// The printed next command can be typed unchanged.
#[test]
fn a_name_with_a_space_is_quoted() {
    let folder = tempfile::tempdir().unwrap();
    let said = done(&within(folder.path(), &["init", "cad gap", "--process"]));
    assert!(said.starts_with("written: cad gap.toml\nnext: sensitol probe "), "{said}");
    if cfg!(unix) {
        let next = "probe 'cad gap.toml'\n      sensitol analyze 'cad gap.toml'\n";
        assert!(said.ends_with(next), "{said}");
    }
    done(&within(folder.path(), &["probe", "cad gap.toml"]));
}

/// No existing file is overwritten, and none is left incomplete.
#[test]
fn what_is_there_stays() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("gap.py"), "mine").unwrap();
    let output = within(folder.path(), &["init", "gap", "--process"]);
    assert_eq!(output.status.code(), Some(2));
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(said, "error: gap.py is there already and stays as it is: name another file, or remove it\n");
    assert!(!folder.path().join("gap.toml").exists());
    assert_eq!(std::fs::read_to_string(folder.path().join("gap.py")).unwrap(), "mine");
    insta::assert_snapshot!(
        "init-wrong",
        [
            &["init", "--model", "engine-balanse"][..],
            &["init", "--model", "engine-balance", "--process"],
            &["init", "no-such-folder/gap"],
            &["completions", "tcsh"],
            &["completions"],
        ]
        .map(run)
        .join("\n")
    );
}

#[test]
fn completions_load_and_the_manual_is_whole() {
    let folder = tempfile::tempdir().unwrap();
    for shell in ["bash", "zsh", "fish"] {
        let script = done(&within(folder.path(), &["completions", shell]));
        assert!(script.contains("allocate") && script.contains("control-variate"), "{shell}");
        std::fs::write(folder.path().join(shell), script).unwrap();
    }
    let words = "source ./bash; COMP_WORDS=(sensitol allo); COMP_CWORD=1; _sensitol sensitol allo sensitol; echo ${COMPREPLY[*]}";
    let completed = Command::new("bash").args(["-c", words]).current_dir(folder.path()).output().unwrap();
    assert_eq!(String::from_utf8(completed.stdout).unwrap(), "allocate\n");
    let page = done(&within(folder.path(), &["man"]));
    assert!(page.contains(".TH sensitol 1"), "{page}");
    for command in
        ["ANALYZE", "SIMULATE", "COMPARE", "SWEEP", "ALLOCATE", "PLAN", "CHECK", "PROBE", "JOURNAL", "INIT", "WATCH"]
    {
        assert!(page.contains(&format!(".SH \"SENSITOL {command}\"")), "{command}");
    }
}
