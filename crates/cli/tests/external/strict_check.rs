//! Verdicts of external models: what they rest on, and a strict check of it.

use std::process::{Command, Output};

use sensitol_testing::repository;

/// Study of an external model `a + b - c` that has a value everywhere, with a limit that hardly any assembly breaks.
fn external(target: f64) -> String {
    let script = repository("tests/children/corner.py").display().to_string();
    format!(
        "[model]\ncommand = [\"python3\", {script:?}, \"9.0\"]\n[dimensions]\na = {{ nominal = 10.0, tolerance = 0.1 }}\n\
         b = {{ nominal = 10.0, tolerance = 0.1 }}\nc = {{ nominal = 19.0, tolerance = 0.1 }}\n\
         [characteristics]\ngap = {{ lower = 0.7, upper = 1.3, target_yield = {target} }}\n"
    )
}

const FORMULA: &str = "[dimensions]\na = { nominal = 10.0, tolerance = 0.1 }\nb = { nominal = 20.0, tolerance = 0.1 }\n\
                       [characteristics]\ngap = { formula = \"b - a\", lower = 9.7, upper = 10.3, target_yield = 0.999 }\n";

fn analyze(study: &str, more: &[&str]) -> Output {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    Command::new(assert_cmd::cargo::cargo_bin!("sensitol")).arg("analyze").arg(path).args(more).output().unwrap()
}

fn report(output: &Output) -> serde_json::Value {
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    report["characteristics"][0].clone()
}

/// A requirement that is met by the surface passes a check, and a strict one names it. A formula is proven and passes both.
#[test]
fn a_strict_check_accepts_proof_and_points_only() {
    let study = external(0.999);
    assert_eq!(analyze(&study, &["--check"]).status.code(), Some(0));
    let strict = analyze(&study, &["--check", "--strict"]);
    assert_eq!(strict.status.code(), Some(3));
    let errors = String::from_utf8_lossy(&strict.stderr).into_owned();
    assert!(errors.contains("conditional-verdict") && errors.contains("`gap`"), "{errors}");
    // The report in JSON has the warning too.
    let json = analyze(&study, &["--check", "--strict", "--json"]);
    let json: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let codes: Vec<&str> = json["warnings"].as_array().unwrap().iter().filter_map(|one| one["code"].as_str()).collect();
    assert!(codes.contains(&"conditional-verdict"), "{codes:?}");
    assert_eq!(analyze(FORMULA, &["--check", "--strict"]).status.code(), Some(0));
    // The option means nothing without a check.
    assert_eq!(analyze(&study, &["--strict"]).status.code(), Some(2));
}

/// The report names the basis of the figures, and the price of a verdict by points. None of 3688 points beyond a limit shows that at most
/// 0.1 % are: 0.025^(1/n) = 0.999.
#[test]
fn a_report_names_the_basis_of_its_figures() {
    let found = report(&analyze(&external(0.999), &["--json"]));
    let basis = serde_json::json!({ "moments": "surface", "yield": "surface", "quantiles": "surface" });
    assert_eq!(found["basis"], basis);
    let points = found["points_to_decide"].as_u64().unwrap();
    // Some assemblies are rejects, so that it takes a little more.
    assert!((3688..5000).contains(&points), "{points}");
    let proven = report(&analyze(FORMULA, &["--json"]));
    let basis = serde_json::json!({ "moments": "proof", "yield": "proof", "quantiles": "proof" });
    assert_eq!(proven["basis"], basis);
    assert!(proven["points_to_decide"].is_null());
}

/// No digit is printed that some dozen points cannot carry: 3.4 ppm lie beyond 4.5 sigma, the farthest check point.
#[test]
fn the_yield_of_a_surface_ends_at_its_farthest_point() {
    let text = String::from_utf8(analyze(&external(0.999), &[]).stdout).unwrap();
    let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(text.contains("if the surface holds between the check points"), "{text}");
    let high = report(&analyze(&external(0.9999999), &["--json"]));
    let [low, _] = [0, 1].map(|end| high["yield_interval"][end].as_f64().unwrap());
    assert!(low <= 1.0 - 3.3e-6 && high["verdict"] != "met", "{high}");
}

/// A characteristic without a limit and one that does not vary have no failed points, and the check points of the other one are the same.
#[test]
fn a_constant_characteristic_has_no_failed_point() {
    let child = "import json, sys\nhello = json.loads(sys.stdin.readline())\n\
                 print(json.dumps({'ready': True, 'name': 'two', 'version': '1'}), flush=True)\n\
                 for line in sys.stdin:\n    q = json.loads(line)\n    \
                 print(json.dumps({'id': q['id'], 'y': [q['x'][0] * q['x'][1], 7.0]}), flush=True)\n";
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("two.py"), child).unwrap();
    let study = "[model]\ncommand = [\"python3\", \"two.py\"]\n[dimensions]\na = { nominal = 2.0, tolerance = 0.1 }\n\
                 b = { nominal = 3.0, tolerance = 0.1 }\n[characteristics]\narea = {}\nfixed = {}\n";
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).unwrap();
    let program = assert_cmd::cargo::cargo_bin!("sensitol");
    let output = Command::new(program).arg("analyze").arg(path).arg("--json").output().unwrap();
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let codes: Vec<&str> =
        report["warnings"].as_array().unwrap().iter().filter_map(|warning| warning["code"].as_str()).collect();
    assert!(!codes.contains(&"domain-edge-within"), "{codes:?}");
    assert_eq!(report["characteristics"][1]["without_value"], 0);
    assert_eq!(report["characteristics"][1]["sigma"], 0.0);
}
