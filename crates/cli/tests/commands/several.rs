//! Several studies in one call of `analyze` and `check`: each has its report, independently of the others.

use std::path::Path;

use serde_json::Value;

use super::command::{run, sensitol};
use sensitol_testing::repository;

const CLEARANCE: &str = "examples/shaft-and-bore/study.toml";
const BLOCKS: &str = "examples/stacked-blocks/study.toml";

/// Returns exit code, stdout and stderr.
fn parts(arguments: &[&str]) -> (i32, String, String) {
    let output = sensitol(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

fn json(arguments: &[&str]) -> (i32, Value) {
    let (code, printed, _) = parts(arguments);
    (code, serde_json::from_str(&printed).unwrap_or_else(|error| panic!("{error}: {printed}")))
}

/// Writes a study with one characteristic `y`, and returns its path.
fn study(folder: &Path, name: &str, formula: &str, more: &str) -> String {
    let path = folder.join(name);
    let text = format!(
        "[dimensions]\na = {{ nominal = 1, tolerance = 0.3 }}\n[characteristics]\ny = {{ formula = \"{formula}\" {more} }}\n"
    );
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

fn names(folder: &Path) -> Vec<String> {
    let files = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<String> = files.map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

#[test]
fn reports_follow_each_other() {
    insta::assert_snapshot!("several-analyze", run(&["analyze", CLEARANCE, "nowhere.toml", BLOCKS, "-m", "rss"]));
    insta::assert_snapshot!("several-check", run(&["check", CLEARANCE, "nowhere.toml", BLOCKS]));
    let markdown = run(&["analyze", CLEARANCE, BLOCKS, "-m", "rss", "--stack", "markdown"]);
    insta::assert_snapshot!("several-markdown", markdown);
}

/// The output for a study equals that of a call of its own, in JSON too.
#[test]
fn a_report_is_that_of_a_call_of_its_own() {
    let alone = [CLEARANCE, BLOCKS].map(|study| parts(&["analyze", study]).1);
    let (code, together, _) = parts(&["analyze", CLEARANCE, BLOCKS]);
    assert_eq!(code, 0);
    assert_eq!(together, format!("==> {CLEARANCE} <==\n{}\n==> {BLOCKS} <==\n{}", alone[0], alone[1]));
    let (code, reports) = json(&["analyze", BLOCKS, CLEARANCE, BLOCKS, "--json"]);
    assert_eq!((code, reports.as_array().unwrap().len()), (0, 3));
    for (report, study) in reports.as_array().unwrap().iter().zip([BLOCKS, CLEARANCE, BLOCKS]) {
        let (_, mut own) = json(&["analyze", study, "--json"]);
        let mut report = report.clone();
        assert_eq!(report.as_object_mut().unwrap().remove("study").unwrap(), study);
        // Times differ between runs.
        (report["wall_s"], own["wall_s"]) = (Value::Null, Value::Null);
        (report["in_model_s"], own["in_model_s"]) = (Value::Null, Value::Null);
        assert_eq!(report, own);
    }
}

/// A study that fails, at reading or later, does not stop the others. The exit code is the worst one, and every error names its study.
#[test]
fn the_worst_is_the_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let study = |name: &str, formula: &str, more: &str| study(folder.path(), name, formula, more);
    let good = study("good.toml", "a", ", lower = 0.5, target_yield = 0.99");
    let missed = study("missed.toml", "a", ", lower = 0.99, target_yield = 0.99");
    let nothing = study("nothing.toml", "sqrt(-a)", ", lower = 0.5, target_yield = 0.99");
    let wrong = study("wrong.toml", "b", ", lower = 0.5, target_yield = 0.99");
    let missing = folder.path().join("missing.toml");
    let missing = missing.to_str().unwrap();
    for (expected, studies) in [
        (0, vec![&*good, &good]),
        (1, vec![&missed, &good]),
        (3, vec![&missed, &nothing, &good]),
        (2, vec![&nothing, &wrong, &missed]),
        (2, vec![missing, &wrong]),
    ] {
        assert_eq!(parts(&[&["analyze", "--check"][..], &studies].concat()).0, expected, "{studies:?}");
    }
    let all = [&*wrong, &good, missing, &nothing, &missed];
    let (code, text, errors) = parts(&[&["analyze", "--check"][..], &all].concat());
    assert_eq!((code, text.matches("==> ").count()), (2, 3), "{text}");
    for (study, told) in [(&*wrong, "nothing is named `b`"), (missing, "No such file")] {
        assert!(errors.contains(study) && errors.contains(told), "{told}: {errors}");
    }
    let warnings = errors.lines().filter(|line| line.starts_with("warning["));
    assert!(warnings.clone().count() > 0 && warnings.clone().all(|line| line.contains(&nothing)), "{errors}");
    let (code, reports) = json(&[&["analyze", "--check", "--json"][..], &all].concat());
    let reports = reports.as_array().unwrap();
    assert_eq!((code, reports.len()), (2, 5));
    for (report, study) in reports.iter().zip(all) {
        let failed = [&wrong, missing].contains(&study);
        assert_eq!((&report["study"], report["error"].is_string()), (&study.into(), failed));
        assert_eq!(report["characteristics"].is_array(), !failed);
    }
    // Only one study has the characteristic, and only one fits the budget.
    let (code, text, error) = parts(&["analyze", &good, CLEARANCE, "--kc", "clearance"]);
    assert!(code == 2 && text.starts_with(&format!("==> {CLEARANCE}")), "{text}");
    assert!(error.starts_with(&format!("error: {good}: ")), "{error}");
    let (code, text, error) = parts(&["analyze", &good, BLOCKS, "-m", "second-order", "--budget", "4"]);
    assert!(code == 2 && text.matches("==> ").count() == 1, "{text}");
    assert!(error.starts_with(&format!("error: {BLOCKS}: ")), "{error}");
    assert_eq!(parts(&["check", &good, &wrong, &good]).1.matches(": valid").count(), 2);
}

#[test]
fn files_are_written_for_every_study() {
    let folder = tempfile::tempdir().unwrap();
    let (gap, play) = (study(folder.path(), "gap.toml", "a", ""), study(folder.path(), "play.toml", "2*a", ""));
    let missing = folder.path().join("missing.toml");
    let to = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (html, csv, file) = (to("a/pages"), to("tables"), to("all.txt"));
    let studies = ["analyze", &gap, missing.to_str().unwrap(), &play];
    let (code, printed, _) = parts(&[&studies[..], &["--html", &html, "--csv", &csv, "-o", &file]].concat());
    assert_eq!((code, printed.as_str()), (2, ""));
    assert_eq!(names(Path::new(&html)), ["gap.html", "play.html"]);
    assert!(
        std::fs::read_to_string(Path::new(&html).join("play.html"))
            .unwrap()
            .to_lowercase()
            .starts_with("<!doctype html>")
    );
    assert_eq!(names(Path::new(&csv)), ["gap", "play"]);
    let alone = to("alone");
    parts(&["analyze", &play, "--csv", &alone]);
    for name in names(Path::new(&alone)) {
        let of = |folder: &str| std::fs::read_to_string(Path::new(folder).join(&name)).unwrap();
        assert_eq!(of(&alone), of(&(csv.clone() + "/play")), "{name}");
    }
    let whole = std::fs::read_to_string(&file).unwrap();
    assert_eq!(whole, parts(&studies).1);
    // An existing folder is used. If every study fails, nothing is written.
    assert_eq!(parts(&["analyze", &gap, &play, "--html", &html]).0, 0);
    let (code, ..) = parts(&["analyze", "nowhere.toml", "elsewhere.toml", "-o", &file]);
    assert_eq!((code, std::fs::read_to_string(&file).unwrap()), (2, whole));
    // The stacks are one table, with the study's name in each row.
    let (_, stacks, _) = parts(&["analyze", &gap, &play, "--stack", "csv"]);
    let own = [&gap, &play].map(|study| parts(&["analyze", study, "--stack", "csv"]).1);
    let mut expected = format!("study,{}\n", own[0].lines().next().unwrap());
    for (study, own) in [&gap, &play].iter().zip(&own) {
        own.lines().skip(1).for_each(|line| expected += &format!("{study},{line}\n"));
    }
    assert_eq!(stacks, expected);
}

/// Studies of the same name in several folders get the folders' names too.
#[test]
fn pages_of_one_name_have_their_folders() {
    let folder = tempfile::tempdir().unwrap();
    let of = |name: &str, file: &str| {
        let inside = folder.path().join(name);
        std::fs::create_dir(&inside).unwrap();
        study(&inside, file, "a", "")
    };
    let (gear, pump, other) = (of("gear", "study.toml"), of("pump", "Study.toml"), of("other", "alone.toml"));
    let pages = folder.path().join("pages");
    let (code, ..) = parts(&["analyze", &gear, &pump, &other, "--html", pages.to_str().unwrap()]);
    assert_eq!((code, names(&pages).join(" ")), (0, "alone.html gear-study.html pump-Study.html".to_owned()));
}

/// A file that cannot be written, or would be written twice, is reported before any evaluation.
#[test]
fn wrong_calls_evaluate_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let below = folder.path().join("below");
    std::fs::create_dir(&below).unwrap();
    let first = study(folder.path(), "gap.toml", "a", "");
    let same = study(&below, "Gap.json", "a", "");
    let other = study(folder.path(), "play.toml", "a", "");
    let pages = folder.path().join("pages");
    let shown = folder.path().to_str().unwrap();
    let mut all = String::new();
    for arguments in [
        &[&*same, &same, "--html", pages.to_str().unwrap()][..],
        &[&first, &same, &same, "--csv", pages.to_str().unwrap()],
        &[&first, &other, "--html", &first],
        &[&first, &other, "--html", &format!("{shown}/report.html")],
        &[&first, &other, "--html", &format!("{first}/pages")],
        &[&first, &other, "--csv", &first],
        &[&first, &other, "-o", &format!("{shown}/nowhere/report.txt")],
        &[&first, &other, "--points", &first],
    ] {
        let (code, printed, error) = parts(&[&["analyze"], arguments].concat());
        assert_eq!((code, printed.as_str()), (2, ""), "{arguments:?}");
        let arguments = arguments.join(" ");
        all += &format!("$ sensitol analyze {arguments}\n{error}\n");
    }
    insta::assert_snapshot!("several-wrong", all.replace(shown, "FOLDER"));
    assert_eq!(names(folder.path()), ["below", "gap.toml", "play.toml"], "nothing is left behind");
}

/// The second of two external models does not start after the first one was interrupted. Every answer is kept.
#[cfg(unix)]
#[test]
fn an_interrupt_ends_the_whole_call() {
    let folder = tempfile::tempdir().unwrap();
    let slow = "import json, sys, time\nprint(json.dumps({\"ready\": True}) if sys.stdin.readline() else \"\", flush=True)\nfor line in sys.stdin:\n    ask = json.loads(line)\n    time.sleep(0.02)\n    open(\"asked\", \"a\").write(\"x\")\n    print(json.dumps({\"id\": ask[\"id\"], \"y\": [sum(ask[\"x\"])]}), flush=True)\n";
    std::fs::write(folder.path().join("slow.py"), slow).unwrap();
    let studies = ["first.toml", "second.toml"].map(|name| folder.path().join(name));
    let dimensions: String = (0..20).map(|index| format!("d{index} = {{ nominal = 1, tolerance = 0.1 }}\n")).collect();
    for study in &studies {
        let model = "[model]\ncommand = [\"python3\", \"slow.py\"]\n[characteristics]\ny = {}\n";
        std::fs::write(study, format!("[dimensions]\n{dimensions}{model}")).unwrap();
    }
    let shown = studies.clone().map(|study| study.to_str().unwrap().to_owned());
    let mut command = sensitol(&["analyze", &shown[0], &shown[1], "--json", "-m", "full"]);
    let engine = command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    let asked = folder.path().join("asked");
    while std::fs::metadata(&asked).map_or(0, |file| file.len()) < 20 {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    sensitol_testing::interrupt(engine.id());
    let output = engine.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let reports: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(reports[0]["evaluations"].as_u64().unwrap() < 421, "{reports}");
    assert_eq!(reports[1]["error"], "interrupted before it was analysed");
    assert!(!folder.path().join("second.journal.sqlite").exists());
    assert!(String::from_utf8(output.stderr).unwrap().contains(&format!("warning[stopped]: {}: ", shown[1])));
}

/// A reader that closes the pipe ends the call without an error.
#[test]
fn a_closed_pipe_ends_the_call() {
    let mut command = sensitol(&["analyze", CLEARANCE, BLOCKS]);
    let mut child = command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped()).spawn().unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty(), "{output:?}");
    assert!(repository(CLEARANCE).exists());
}
