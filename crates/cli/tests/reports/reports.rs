//! The output of `--json` matches `sensitol schema --report`.

use serde_json::{Value, json};

use super::command::{run, sensitol};

fn printed(arguments: &[&str]) -> Value {
    let output = sensitol(arguments).output().unwrap();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{arguments:?}: {error}: {output:?}"))
}

/// Returns a validator for the output of one command.
fn validator(schema: &Value, command: &str) -> jsonschema::Validator {
    let mut one = schema.clone();
    one.as_object_mut().unwrap().remove("anyOf");
    one["$ref"] = json!(format!("#/$defs/{command}"));
    jsonschema::validator_for(&one).unwrap()
}

#[test]
fn every_report_keeps_its_schema() {
    const GAP: &str = "examples/first-study/study.toml";
    const ENGINE: &str = "examples/engine-balance/allocate.toml";
    const HOUSING: &str = "examples/shaft-and-housing/worst-case.toml";
    let schema = printed(&["schema", "--report"]);
    assert_eq!(schema["$id"], format!("urn:sensitol:report:{}", sensitol_report::SCHEMA));
    let cases: [(&str, &[&str]); 23] = [
        ("analyze", &["analyze", GAP, "--json"]),
        ("analyze", &["analyze", GAP, "--json", "--extremes", "-m", "six-n"]),
        ("analyze", &["analyze", ENGINE, "--json", "-m", "three-point"]),
        ("analyze", &["analyze", ENGINE, "--json", "-m", "response-surface", "--verbose"]),
        ("analyze", &["analyze", "examples/measured-pin/study.toml", "--json"]),
        ("analyze", &["analyze", HOUSING, "--json", "--time", "0.001"]),
        ("analyze-several", &["analyze", GAP, "nowhere.toml", HOUSING, "--json"]),
        ("check", &["check", GAP, "--json"]),
        ("check", &["check", "examples/four-legged-table/study.toml", "--json"]),
        ("check", &["check", "nowhere.toml", "--json"]),
        ("examples", &["examples", "--json"]),
        ("errors", &["analyze", "nowhere.toml", "--json"]),
        ("errors", &["simulate", "--nonsense", "--json"]),
        ("simulate", &["simulate", GAP, "--json", "--samples", "2000"]),
        ("simulate", &["simulate", HOUSING, "--json", "--samples", "2000", "--surrogate-control"]),
        ("simulate-rare", &["simulate", GAP, "--json", "--rare", "--samples", "400"]),
        ("compare", &["compare", HOUSING, "--json", "--samples", "500"]),
        ("sweep", &["sweep", GAP, "--json", "--over", "housing=50:50.4:3"]),
        ("allocate", &["allocate", ENGINE, "--json", "--front", "3", "--confirm", "1000"]),
        ("allocate", &["allocate", HOUSING, "--json"]),
        ("plan", &["plan", GAP, "--json"]),
        ("models", &["models", "--json"]),
        ("pearson", &["pearson", "--skewness", "0.5", "--kurtosis", "3.4", "--sf", "4", "--json"]),
    ];
    for (command, arguments) in cases {
        let report = printed(arguments);
        let validator = validator(&schema, command);
        let wrong: Vec<String> =
            validator.iter_errors(&report).map(|error| format!("{}: {error}", error.instance_path())).collect();
        assert!(wrong.is_empty(), "{arguments:?}: {wrong:#?}");
    }
    // The schema rejects faults: a missing key, an additional key, a number as text.
    let validator = validator(&schema, "analyze");
    let report = printed(&["analyze", GAP, "--json"]);
    let changed = |change: &dyn Fn(&mut Value)| {
        let mut report = report.clone();
        change(&mut report);
        validator.is_valid(&report)
    };
    assert!(changed(&|_| {}));
    assert!(!changed(&|report| drop(report.as_object_mut().unwrap().remove("stopped"))));
    assert!(!changed(&|report| report["reused"] = json!(1)));
    assert!(!changed(&|report| report["characteristics"][0]["verdict"] = json!("not known")));
    assert!(!changed(&|report| report["characteristics"][0]["sigma"] = json!("0.1")));
}

/// Eleven thousand equal interactions: ten thousand are listed, the sum of all is kept, and `--verbose` lists every one.
#[test]
fn interactions_that_hardly_matter_are_one_sum() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let n = 150;
    let dimensions: String = (0..n).map(|i| format!("x{i} = {{ nominal = 0, tolerance = 0.3 }}\n")).collect();
    let sum = (0..n).map(|i| format!("x{i}")).collect::<Vec<_>>().join(" + ");
    // The square of a sum has every interaction, all equal.
    let text = format!("[dimensions]\n{dimensions}[characteristics]\ny = {{ formula = \"{sum} + ({sum})^2\" }}\n");
    std::fs::write(&study, text).unwrap();
    let study = study.to_str().unwrap();
    let short = printed(&["analyze", study, "--json", "-m", "full"]);
    let all = printed(&["analyze", study, "--json", "-m", "full", "--verbose"]);
    let of = |report: &Value| {
        let one = &report["characteristics"][0];
        let listed = one["interactions"].as_array().unwrap().clone();
        let share: f64 = listed.iter().map(|pair| pair["share"].as_f64().unwrap()).sum();
        (listed.len(), share, one["interactions_remainder"].clone())
    };
    let ((listed, share, remainder), (every, total, nothing)) = (of(&short), of(&all));
    assert_eq!((listed, every, nothing), (10_000, n * (n - 1) / 2, Value::Null));
    assert_eq!(remainder["count"], every - listed);
    // Sums of ten thousand numbers near 1e-5.
    assert!((share + remainder["share"].as_f64().unwrap() - total).abs() < 1e-9);
}

/// Interactions that vanish at every evaluated point leave the value of the surface. It is no statement about assemblies: `2 c^2 b` varies.
#[test]
fn one_value_of_a_surface_is_no_value_of_all_assemblies() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    for (formula, constant) in [("2*c^2*b", false), ("2*k", true)] {
        let study = format!(
            "[constants]\nk = 3\n[dimensions]\nb = {{ nominal = 0, sigma = 1 }}\nc = {{ nominal = 0, sigma = 1 }}\n[characteristics]\ny = {{ formula = \"{formula}\" }}\n"
        );
        std::fs::write(&path, study).unwrap();
        let text = run(&["analyze", path.to_str().unwrap(), "-m", "full", "--verify", "0"]);
        assert_eq!(text.contains("every assembly has the same value"), constant, "{text}");
        assert_eq!(text.contains("all evaluated points have the same value"), !constant, "{text}");
    }
}
