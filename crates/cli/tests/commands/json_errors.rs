//! Errors as JSON: every command prints them on stdout with `--json`, and keeps its exit code and its text on stderr.

use serde_json::{Value, json};

use super::command::sensitol;

/// Runs a command and returns its exit code, its stdout as JSON, and its stderr.
fn printed(arguments: &[&str]) -> (i32, Value, String) {
    let output = sensitol(arguments).output().unwrap();
    let value = serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{arguments:?}: {error}"));
    (output.status.code().unwrap(), value, String::from_utf8(output.stderr).unwrap())
}

/// A study with two faults: `-2` begins at column 34 of line 2, and at column 32 of line 3, counted by hand.
const WRONG: &str = "[dimensions]\na = { nominal = 1.5, tolerance = -2 }\nb = { nominal = 1, tolerance = -2 }\n[characteristics]\ny = { formula = \"a + b\" }\n";

#[test]
fn every_fault_of_a_study_has_its_place() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wrong.toml");
    std::fs::write(&path, WRONG).unwrap();
    let path = path.to_str().unwrap();
    let commands: [&[&str]; 9] = [
        &["analyze", path],
        &["simulate", path],
        &["allocate", path],
        &["compare", path],
        &["plan", path],
        &["probe", path],
        &["evaluate", path, "--at", "nominal"],
        &["expand", path],
        &["sweep", path, "--over", "a=1:2:3"],
    ];
    for command in commands {
        let (exit, value, told) = printed(&[command, &["--json"]].concat());
        assert_eq!((exit, &value["command"]), (2, &json!(command[0])));
        let places: Vec<Value> = value["errors"]
            .as_array()
            .unwrap()
            .iter()
            .map(|one| json!([one["code"], one["file"], one["line"], one["column"], one["key"]]))
            .collect();
        let first = json!(["dimension", path, 2, 34, "dimensions.a.tolerance"]);
        let second = json!(["dimension", path, 3, 32, "dimensions.b.tolerance"]);
        assert_eq!(places, [first, second], "{command:?}");
        assert!(told.starts_with("error: "), "{command:?}: {told}");
        // Without --json nothing is on stdout.
        let output = sensitol(command).output().unwrap();
        assert!(output.stdout.is_empty() && output.status.code() == Some(2), "{command:?}");
    }
}

#[test]
fn a_misspelt_key_has_its_advice() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wrong.toml");
    std::fs::write(&path, WRONG.replacen("tolerance", "tolerence", 1)).unwrap();
    let (exit, value, _) = printed(&["check", path.to_str().unwrap(), "--json"]);
    let error = &value["errors"][0];
    assert_eq!(
        (exit, &error["code"], &error["line"], &error["column"]),
        (2, &json!("unknown-key"), &json!(2), &json!(22))
    );
    assert_eq!(error["advice"], json!(["did you mean `tolerance`?"]));
}

#[test]
fn check_reports_valid_and_wrong_studies() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("wrong.toml");
    std::fs::write(&path, WRONG).unwrap();
    let path = path.to_str().unwrap();
    let good = "examples/first-study/study.toml";
    let (exit, value, _) = printed(&["check", good, "--json"]);
    assert_eq!((exit, &value["valid"], &value["errors"]), (0, &json!(true), &json!([])));
    assert_eq!((&value["characteristics"], &value["program"]), (&json!(["gap"]), &Value::Null));
    let (exit, value, told) = printed(&["check", path, good, "nowhere.toml", "--json"]);
    let of = |key: &str| value.as_array().unwrap().iter().map(|one| one[key].clone()).collect::<Vec<_>>();
    assert_eq!((exit, of("study")), (2, vec![json!(path), json!(good), json!("nowhere.toml")]));
    assert_eq!(of("valid"), [json!(false), json!(true), json!(false)]);
    // An unknown figure is null, never 0.
    assert_eq!((&value[0]["dimensions"], &value[2]["errors"][0]["code"]), (&Value::Null, &json!("unreadable")));
    assert!(told.contains("nowhere.toml"), "{told}");
}

#[test]
fn errors_beside_a_study_are_json_too() {
    let wrong: [(&[&str], &str, bool); 6] = [
        (&["analyze", "--nonsense"], "command-line", false),
        (&["analyze", "examples/first-study/study.toml", "--method", "fulll"], "command-line", true),
        (&["models", "engine-balanc"], "unknown-name", false),
        (&["examples", "copy", "engine-balanc"], "unknown-example", true),
        (&["import", "no-such.csv"], "import", false),
        (&["analyze", "examples/first-study/study.toml", "-o", "nowhere/report.json"], "unwritable", false),
    ];
    for (arguments, code, advised) in wrong {
        let (exit, value, _) = printed(&[arguments, &["--json"]].concat());
        let error = &value["errors"][0];
        assert_eq!((exit, &error["code"]), (2, &json!(code)), "{arguments:?}: {value:#}");
        assert!(!error["message"].as_str().unwrap().is_empty() && error["line"].is_null(), "{value:#}");
        assert!(!advised || error["advice"].as_array().is_some_and(|advice| !advice.is_empty()), "{value:#}");
    }
}

/// The array of several studies is on stdout even if all of them fail, and a file stays as it was.
#[test]
fn several_studies_that_fail_give_an_array() {
    let (exit, value, _) = printed(&["analyze", "nowhere.toml", "elsewhere.toml", "--json"]);
    assert_eq!((exit, value.as_array().unwrap().len()), (2, 2));
    assert_eq!(value[1]["errors"][0]["file"], "elsewhere.toml");
    let folder = tempfile::tempdir().unwrap();
    let kept = folder.path().join("kept.json");
    std::fs::write(&kept, "{\"schema\": 2, \"command\": \"analyze\"}").unwrap();
    let output =
        sensitol(&["analyze", "nowhere.toml", "elsewhere.toml", "--json", "-o", kept.to_str().unwrap()]).output();
    assert_eq!(output.unwrap().status.code(), Some(2));
    assert!(std::fs::read_to_string(&kept).unwrap().starts_with("{\"schema\": 2, \"command\""));
}
