//! `analyze OLD NEW --compare`: changes from one revision to the next.

use serde_json::Value;

use super::command::sensitol;

const OLD: &str = "title = \"Gap\"\n[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 4, tolerance = 0.3 }\nc = { nominal = 1, tolerance = 0.1 }\n\
                   [characteristics]\ny = { formula = \"a - b\", lower = 5.7, upper = 6.3, target_yield = 0.99 }\n";

fn new() -> String {
    OLD.replace("a = { nominal = 10, tolerance = 0.3 }", "a = { nominal = 10, tolerance = 0.1 }")
        .replace("c = { nominal = 1, tolerance = 0.1 }", "d = { nominal = 2, tolerance = 0.1 }")
        .replace("upper = 6.3", "upper = 6.4")
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("old.toml"), OLD).unwrap();
    std::fs::write(folder.path().join("new.toml"), new()).unwrap();
    folder
}

/// Sigmas of sums of normal dimensions are roots of sums of squares: 0.1 and 0.1, then 0.1/3 and 0.1.
#[test]
fn inputs_results_and_contributions_are_compared() {
    let folder = folder();
    let run = |more: &[&str]| {
        let output = sensitol(&[&["analyze", "old.toml", "new.toml", "--compare"], more].concat())
            .current_dir(folder.path())
            .output()
            .unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    let report: Value = serde_json::from_str(&run(&["--json", "--html", "page.html", "--csv", "tables"])).unwrap();
    let changes: Vec<[&str; 4]> = (report["changes"].as_array().unwrap().iter())
        .map(|one| ["name", "key", "old", "new"].map(|key| one[key].as_str().unwrap_or("-")))
        .collect();
    assert_eq!(
        changes,
        [
            ["a", "tolerance", "± 0.3", "± 0.1"],
            ["c", "all", "1 ± 0.1", "-"],
            ["d", "all", "-", "2 ± 0.1"],
            ["y", "limits", "5.7 .. 6.3", "5.7 .. 6.4"]
        ]
    );
    let one = &report["characteristics"][0];
    assert_eq!(one["verdicts"], serde_json::json!(["missed", "met"]));
    let sigma = &one["figures"][1];
    let [was, is] = [0, 1].map(|place| sigma["values"][place].as_f64().unwrap());
    // Rounding of closed forms.
    assert!(
        (was - 0.02f64.sqrt()).abs() < 1e-12 && (is - (0.1f64.powi(2) + (0.1f64 / 3.0).powi(2)).sqrt()).abs() < 1e-12
    );
    assert_eq!((sigma["figure"].as_str(), sigma["differs"].as_bool()), (Some("sigma"), Some(true)));
    assert_eq!(one["figures"][0]["differs"].as_bool(), Some(false), "the mean has not moved");
    let shares: Vec<&str> =
        one["shares"].as_array().unwrap().iter().map(|row| row["dimension"].as_str().unwrap()).collect();
    assert_eq!(shares.len(), 2);
    assert!(shares.contains(&"a") && shares.contains(&"b"));
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains("<title>Gap") && page.contains("± 0.3") && page.contains("default-src"));
    for table in ["changes", "results", "contributions"] {
        assert!(folder.path().join("tables").join(format!("{table}.csv")).exists());
    }
    let text = run(&[]);
    for said in ["from old.toml to new.toml: 4 inputs differ", "± 0.3", "not there", "was missed"] {
        assert!(text.contains(said), "{said}: {text}");
    }
}

#[test]
fn a_study_beside_itself_has_not_changed() {
    let folder = folder();
    let output =
        sensitol(&["analyze", "old.toml", "old.toml", "--compare"]).current_dir(folder.path()).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("no input differs"), "{text}");
    assert!(text.contains("unchanged") && !text.contains("contribution of"), "{text}");
}

/// `--check` applies to the newer study.
#[test]
fn the_second_study_is_checked() {
    let folder = folder();
    let code = |studies: [&str; 2]| {
        let arguments = ["analyze", studies[0], studies[1], "--compare", "--check"];
        sensitol(&arguments).current_dir(folder.path()).output().unwrap().status.code()
    };
    assert_eq!(code(["old.toml", "new.toml"]), Some(0));
    assert_eq!(code(["new.toml", "old.toml"]), Some(1));
}

#[test]
fn what_cannot_be_compared_is_said() {
    let folder = folder();
    let refused = |arguments: &[&str], code: i32, said: &str| {
        let output = sensitol(arguments).current_dir(folder.path()).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{error}");
        assert!(error.contains(said), "{error}");
    };
    refused(&["analyze", "old.toml", "--compare"], 2, "name two files, not 1");
    refused(&["analyze", "old.toml", "new.toml", "old.toml", "--compare"], 2, "name two files, not 3");
    refused(&["analyze", "old.toml", "none.toml", "--compare"], 2, "none.toml");
    refused(&["analyze", "old.toml", "new.toml", "--compare", "-o", "new.toml"], 2, "which would be lost");
    refused(&["analyze", "old.toml", "new.toml", "--compare", "--stack", "csv"], 2, "--stack");
}
