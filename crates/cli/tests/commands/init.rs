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
    assert!(done(&within(folder.path(), &["analyze", "study.toml"])).contains("target 99.730 %: MISSED"));
    assert_eq!(within(folder.path(), &["analyze", "study.toml", "--check"]).status.code(), Some(1));
    assert!(done(&within(folder.path(), &["allocate", "study.toml"])).starts_with("local-optimum: cost"));
    // The example and the tutorial show the same study.
    let example = std::fs::read_to_string(repository("examples/first-study/study.toml")).unwrap();
    assert_eq!(std::fs::read_to_string(folder.path().join("study.toml")).unwrap(), example);
    done(&within(folder.path(), &["init", "gap", "--process"]));
    done(&within(folder.path(), &["probe", "gap.toml"]));
    assert!(done(&within(folder.path(), &["analyze", "gap.toml"])).contains("gap [mm]"));
    let said = done(&within(folder.path(), &["init", "cover", "--assembly"]));
    assert!(said.ends_with("next: sensitol check cover.toml\n      sensitol analyze cover.toml\n"), "{said}");
    let said = done(&within(folder.path(), &["check", "cover.toml"]));
    assert!(said.contains("2 parts, 3 joints: 6 unknowns, 6 equations"), "{said}");
    assert!(done(&within(folder.path(), &["analyze", "cover.toml"])).contains("target 99.730 %: met"));
    for model in ALL {
        let name = format!("{}.toml", model.name);
        done(&within(folder.path(), &["init", &name, "--model", model.name]));
        let report = done(&within(folder.path(), &["analyze", &name, "--method", "second-order"]));
        assert!(report.contains("sigma"), "{name}: {report}");
    }
}

/// The printed next command can be typed unchanged.
#[test]
fn a_name_with_a_space_is_quoted() {
    let folder = tempfile::tempdir().unwrap();
    let said = done(&within(folder.path(), &["init", "cad gap", "--process"]));
    assert!(said.starts_with("written: cad gap.toml\nnext: sensitol probe "), "{said}");
    if cfg!(unix) {
        assert!(said.ends_with("probe 'cad gap.toml'\n"), "{said}");
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
    for command in ["ANALYZE", "SIMULATE", "COMPARE", "SWEEP", "ALLOCATE", "PLAN", "CHECK", "PROBE", "JOURNAL", "INIT"]
    {
        assert!(page.contains(&format!(".SH \"SENSITOL {command}\"")), "{command}");
    }
}
