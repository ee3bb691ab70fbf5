//! Failed points of earlier runs that the journal holds: a later analysis counts those within its bands.

use std::path::PathBuf;
use std::process::{Command, Output};

use sensitol_external::journal::store::Store;
use sensitol_testing::repository;

/// Study of three dimensions whose model has no value where a and b together exceed their nominal values by `edge`.
struct Corner {
    folder: tempfile::TempDir,
}

impl Corner {
    fn new(edge: f64) -> Self {
        let study = Self { folder: tempfile::tempdir().unwrap() };
        study.write("study.toml", edge, 0.1);
        study
    }

    fn write(&self, name: &str, edge: f64, tolerance: f64) {
        let script = repository("tests/children/corner.py").display().to_string();
        let dimension =
            |name: &str, nominal: f64| format!("{name} = {{ nominal = {nominal:?}, tolerance = {tolerance} }}\n");
        let cost = |name: &str| format!("{name} = {{ model = \"reciprocal\", b = 1 }}\n");
        let (a, b, c) = (dimension("a", 10.0), dimension("b", 10.0), dimension("c", 19.0));
        let text = format!(
            "[model]\ncommand = [\"python3\", {script:?}, \"{edge:?}\"]\nverify = 0\n\
             [dimensions]\n{a}{b}{c}[characteristics]\ngap = {{ lower = 0.8, upper = 1.2, target_yield = 0.999 }}\n\
             [costs]\n{}{}{}",
            cost("a"),
            cost("b"),
            cost("c")
        );
        std::fs::write(self.path(name), text).unwrap();
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, command: &str, name: &str, more: &[&str]) -> Output {
        let mut run = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        run.arg(command)
            .arg(self.path(name))
            .arg("--journal")
            .arg(self.path("kept.sqlite"))
            .args(more)
            .output()
            .unwrap()
    }

    /// Report of `analyze --check`, and true if it found the requirement to be met.
    fn check(&self, name: &str) -> (serde_json::Value, bool) {
        let output = self.run("analyze", name, &["--check", "--json"]);
        let report = serde_json::from_slice(&output.stdout).unwrap();
        (report, output.status.code() == Some(0))
    }

    /// Failed points of the journal whose deviations all lie within this tolerance.
    fn recorded(&self, tolerance: f64) -> usize {
        let store = Store::open(&self.path("kept.sqlite")).unwrap();
        let model = store.models().unwrap().remove(0).id;
        let within =
            |point: &[f64]| point.iter().zip([10.0, 10.0, 19.0]).all(|(x, nominal)| (x - nominal).abs() <= tolerance);
        store.answers(model).unwrap().iter().filter(|kept| kept.answer.is_err() && within(&kept.point)).count()
    }
}

/// Numbers of points without a value: those that the report counts, and those in the warning of recorded failures.
fn counts(report: &serde_json::Value) -> (u64, Option<u64>) {
    let warnings = report["warnings"].as_array().unwrap();
    let recorded = warnings.iter().find(|warning| warning["code"] == "recorded-failures");
    let without = report["characteristics"][0]["without_value"].as_u64().unwrap();
    (without, recorded.map(|warning| warning["data"]["failed"].as_u64().unwrap()))
}

/// The check of an allocation evaluates no point of the corner. It must not state a yield that the journal contradicts.
#[test]
fn a_check_counts_the_failures_that_an_allocation_left() {
    let study = Corner::new(0.13);
    let new = study.path("new.toml");
    let allocated = study.run("allocate", "study.toml", &["--confirm", "400", "--write", new.to_str().unwrap()]);
    // The points that confirm it have failures, so that its end is open as well.
    assert_eq!(allocated.status.code(), Some(4), "{}", String::from_utf8_lossy(&allocated.stderr));
    let text = std::fs::read_to_string(&new).unwrap();
    let tolerance: f64 = text.split("tolerance = ").nth(1).unwrap().split([' ', '}']).next().unwrap().parse().unwrap();
    let recorded = study.recorded(tolerance) as u64;
    assert!(recorded > 0);
    let (report, met) = study.check("new.toml");
    assert_eq!(counts(&report), (recorded, Some(recorded)));
    assert_eq!((report["characteristics"][0]["verdict"].as_str(), met), (Some("inconclusive"), false));
    assert_eq!(report["characteristics"][0]["yield_interval"][0].as_f64(), Some(0.0));
    // Bands that leave out the corner leave out its failures.
    study.write("narrow.toml", 0.13, 0.06);
    assert_eq!(study.recorded(0.06), 0);
    let (report, met) = study.check("narrow.toml");
    assert_eq!((counts(&report), met), ((0, None), true));
}

/// A run that evaluates the failed points itself counts them once.
#[test]
fn failures_of_the_run_itself_count_once() {
    let study = Corner::new(0.08);
    let (first, met) = study.check("study.toml");
    assert!(counts(&first).0 > 0 && !met);
    assert_eq!(counts(&first), (study.recorded(0.1) as u64, None));
    // The refinement goes on from the answers of the journal, and meets all failures of it.
    let (second, _) = study.check("study.toml");
    assert_eq!(counts(&second), (study.recorded(0.1) as u64, None));
    // Another method evaluates some of these points, and more of its own.
    let output = study.run("analyze", "study.toml", &["--method", "second-order", "--json"]);
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(counts(&report).0, study.recorded(0.1) as u64);
}

/// Report of `analyze` on a program that has a value where this condition on `x` holds, and the number of points that it was asked.
fn asked(condition: &str) -> (Option<i32>, serde_json::Value, usize) {
    let folder = tempfile::tempdir().unwrap();
    let script = format!(
        "import json, sys\n\
         sys.stdin.readline()\n\
         print(json.dumps({{'ready': True}}), flush=True)\n\
         for line in sys.stdin:\n    \
             open('asked', 'a').write('x')\n    \
             point = json.loads(line)\n    \
             x = point['x']\n    \
             answer = {{'y': [sum(x)]}} if {condition} else {{'error': 'no licence at %r' % x}}\n    \
             print(json.dumps({{'id': point['id'], **answer}}), flush=True)\n"
    );
    std::fs::write(folder.path().join("model.py"), script).unwrap();
    let dimension = |d: usize| format!("x{d} = {{ nominal = 1, tolerance = 0.1 }}\n");
    let dimensions: String = (0..6).map(dimension).collect();
    let text = format!(
        "[model]\ncommand = [\"python3\", \"model.py\"]\nverify = 0\n[dimensions]\n{dimensions}[characteristics]\ny = {{ lower = 0 }}\n"
    );
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    let output = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"))
        .args(["analyze", "--method", "full", "--journal", "none", "--json"])
        .arg(&path)
        .output()
        .unwrap();
    let asked = std::fs::read(folder.path().join("asked")).unwrap().len();
    (output.status.code(), serde_json::from_slice(&output.stdout).unwrap_or_default(), asked)
}

/// A program that fails everywhere for one reason is asked the nominal point and five others, each with a sentinel after it.
#[test]
fn a_program_that_fails_everywhere_is_asked_few_points() {
    let (code, report, count) = asked("False");
    let error = &report["errors"][0];
    assert_eq!((code, error["code"].as_str()), (Some(2), Some("model-fails")), "{report}");
    let message = error["message"].as_str().unwrap_or_default();
    assert!(message.contains("no licence") && message.contains("sensitol probe"), "{message}");
    assert!(count <= 12, "{count}");
}

/// A program with values elsewhere is asked all 37 points, even if it has none at the nominal dimensions.
#[test]
fn a_program_that_fails_at_the_nominal_point_alone_is_asked_all() {
    let (code, report, count) = asked("any(one != 1 for one in x)");
    assert_ne!(code, Some(2), "{report}");
    assert!(count >= 37, "{count}");
}
