//! Sweeps against single analyses, gathered into batches; the command with its files and wrong input.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

use sensitol::assembly::{AssemblyFunction, EvaluationError, Request, Responses, Run, Signature};

use sensitol::sweep::{SweepError, sweep, sweep_with};
use sensitol::{Closure, Dimension, Method, Options, Problem, StopReason, analyze};
use sensitol_study::Study;

use super::command::{run, sensitol};

/// Product of two dimensions that records its batches.
struct Counted {
    inner: Closure,
    batches: Arc<Mutex<Vec<usize>>>,
}

impl AssemblyFunction for Counted {
    fn signature(&self) -> &Signature {
        self.inner.signature()
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.batches.lock().unwrap().push(request.points.rows());
        self.inner.evaluate(request, run, out);
    }
}

fn problem() -> (Problem, Arc<Mutex<Vec<usize>>>) {
    let batches = Arc::new(Mutex::new(Vec::new()));
    let inner = Closure::scalar("y", |x| (x[0] * 0.3).sin() * x[1] + 0.1 * x[1] * x[2]);
    let dimensions = [
        Dimension::normal("a", 1.0, 0.3).unwrap(),
        Dimension::normal_between("b", 2.0, [-0.1, 0.3]).unwrap(),
        Dimension::uniform("c", 3.0, 0.2).unwrap(),
    ];
    (Problem::new(dimensions, Counted { inner, batches: Arc::clone(&batches) }).unwrap(), batches)
}

/// A yield of nearly 100 % is not printed as 100 %: it has as many digits as the rejects, and is a bound below 1e-9 rejects.
#[test]
fn nearly_all_is_not_all() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    // Limits at 5 sigma and at 6: 0.287 and 0.000987 ppm.
    let text =
        "[dimensions]\na = { nominal = 5, tolerance = 3 }\n[characteristics]\ny = { formula = \"a\", lower = 0 }\n";
    std::fs::write(&study, text).unwrap();
    let table = run(&["sweep", study.to_str().unwrap(), "--over", "a=5:6:2"]);
    assert!(table.contains("99.9999713\n") && table.contains("> 99.9999999\n"), "{table}");
    let nothing = run(&["sweep", study.to_str().unwrap(), "--over", "a=50:60:2"]);
    assert!(nothing.contains("  100\n"), "{nothing}");
}

/// A sweep gives the same bits as single analyses, for every method, in one batch for each stage.
#[test]
fn a_sweep_is_its_analyses() {
    let (problem, batches) = problem();
    let values = [0.5, 1.0, 1.5, 4.0];
    for method in sensitol::method::registry::ALL.iter().map(|procedure| procedure.method()) {
        batches.lock().unwrap().clear();
        let swept = sweep(&problem, "a", &values, &method.into()).unwrap();
        let gathered = std::mem::take(&mut *batches.lock().unwrap());
        let mut stages = 0;
        let mut alone = 0;
        for (value, found) in values.iter().zip(&swept.analyses) {
            let dimensions = problem.dimensions().iter().enumerate();
            let moved = dimensions.map(|(d, of)| if d == 0 { of.moved(*value).unwrap().unwrap() } else { of.clone() });
            let inner = Closure::scalar("y", |x| (x[0] * 0.3).sin() * x[1] + 0.1 * x[1] * x[2]);
            let expected = analyze(&Problem::new(moved, inner).unwrap(), &method.into()).unwrap();
            let found = found.as_ref().unwrap();
            assert_eq!(found.characteristics, expected.characteristics, "{method:?} {value}");
            assert_eq!(found.warnings, expected.warnings);
            stages = stages.max(expected.run.stages);
            alone += expected.run.evaluations;
        }
        assert!(swept.run.stopped.is_none() && swept.run.failed == 0);
        assert_eq!(
            (swept.run.evaluations, swept.run.stages),
            (gathered.iter().sum::<usize>() as u64, gathered.len() as u64)
        );
        // Points of two values that coincide are evaluated once.
        assert!(swept.run.evaluations <= alone, "{method:?}");
        if method != Method::Auto {
            assert_eq!(gathered.len() as u64, stages, "{method:?}: {gathered:?}");
        }
    }
}

/// A characteristic without a value at one value of the parameter is unknown there only.
#[test]
fn a_failing_value_costs_only_itself() {
    let function = Closure::fallible(["y"], |x: &[f64]| {
        if x[0] > 1.9 {
            return Err(EvaluationError::Refused { message: "does not assemble".into() });
        }
        Ok([x[0] + x[1]])
    });
    let dimensions = [Dimension::fixed("a", 1.0).unwrap(), Dimension::normal("b", 0.0, 0.3).unwrap()];
    let problem = Problem::new(dimensions, function).unwrap();
    let swept = sweep(&problem, "a", &[1.0, 1.5, 2.0], &Method::SecondOrder.into()).unwrap();
    let moments = |at: usize| swept.analyses[at].as_ref().unwrap().characteristics[0].moments;
    assert!(moments(0).is_some() && moments(1).is_some() && moments(2).is_none());
    assert!(swept.run.failed >= 3);
}

#[test]
fn a_stop_leaves_what_is_done() {
    let (problem, _) = problem();
    let asked = AtomicUsize::new(0);
    let stop = || (asked.fetch_add(1, Ordering::Relaxed) > 0).then_some(StopReason::TimeLimit);
    let run = Run::to_the_end().stopping_when(&stop);
    let swept = sweep_with(&problem, "a", &[1.0, 2.0], &Method::SecondOrder.into(), &run).unwrap();
    assert!(
        swept.run.stopped == Some(StopReason::TimeLimit)
            && swept.analyses.iter().all(Option::is_none)
            && swept.run.evaluations == 0
    );
}

#[test]
fn what_cannot_be_swept() {
    let (problem, _) = problem();
    let options = Options::from(Method::Rss);
    let of = |name: &str, values: &[f64]| sweep(&problem, name, values, &options).unwrap_err();
    let unknown = of("A1", &[1.0]).to_string();
    assert!(unknown.starts_with("there is no dimension `A1` to sweep; known: a, b, c"), "{unknown}");
    assert_eq!(of("a", &[]), SweepError::NoValue);
    assert!(matches!(of("a", &[1.0, f64::NAN]), SweepError::NotFinite { .. }));
    assert!(matches!(of("a", &[1e300]), SweepError::Dimension(_)));
    // Seven evaluations at each of two values.
    let budget = |budget| Options::from(Method::Rss).with_budget(budget);
    assert!(matches!(sweep(&problem, "a", &[1.0, 2.0], &budget(15)), Err(SweepError::Method(_))));
    assert!(sweep(&problem, "a", &[1.0, 2.0], &budget(16)).is_ok());
    let study = Study::from_toml(
        "[dimensions]\noil = { nominal = 0.5, distribution = { kind = \"exponential\" }, sigma = 0.5 }\n\
         film = { nominal = 0.5, tolerance = 0.1, distribution = \"lognormal\" }\n\
         [characteristics]\ny = { formula = \"oil + film\" }\n",
        "oil.toml",
    );
    let problem = study.unwrap().problem;
    for name in ["oil", "film"] {
        let error = sweep(&problem, name, &[1.0], &options).unwrap_err();
        assert!(matches!(error, SweepError::Unmoved { .. }), "{error}");
    }
}

fn written(folder: &tempfile::TempDir, text: &str) -> String {
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    path.to_str().unwrap().to_owned()
}

const PLATE: &str = "title = \"Plate\"\n[constants]\nk = 2.0\n[dimensions]\na = { nominal = 4.0, tolerance = 0.3, unit = \"mm\" }\n\
                     b = { nominal = 1.0, tolerance = 0.1 }\n[characteristics]\n\
                     y = { formula = \"k*a + sqrt(b)\", unit = \"mm\", lower = 5.0 }\n[analysis]\nmethod = \"second-order\"\n";

#[test]
fn the_command() {
    let folder = tempfile::tempdir().unwrap();
    let study = written(&folder, PLATE);
    for over in ["k=1:3:5", "a=4:2:3", "b=-0.5:1:4"] {
        let name = format!("sweep-{}", &over[..1]);
        insta::assert_snapshot!(name, run(&["sweep", &study, "--over", over]));
    }
    let (table, chart) = (folder.path().join("csv"), folder.path().join("band.svg"));
    let arguments = ["--csv", table.to_str().unwrap(), "--svg", chart.to_str().unwrap(), "--json", "--threads", "1"];
    let output = sensitol(&[&["sweep", &study, "--over", "k=1:3:5"], &arguments[..]].concat()).output().unwrap();
    assert_eq!(output.status.code(), Some(0));
    let mut report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["wall_s"].as_f64().unwrap() > 0.0);
    report["wall_s"] = 0.0.into();
    report["in_model_s"] = 0.0.into();
    super::command::rounded(&mut report);
    insta::assert_json_snapshot!("sweep-json", report);
    insta::assert_snapshot!("sweep-svg", std::fs::read_to_string(chart).unwrap());
    let csv = std::fs::read_to_string(table.join("sweep.csv")).unwrap();
    let lines: Vec<&str> = csv.lines().collect();
    assert_eq!((lines.len(), lines[0].split(',').count()), (6, lines[1].split(',').count()));
    assert!(lines[1].starts_with("y,mm,k,1,5,") && lines[5].starts_with("y,mm,k,3,13,"), "{csv}");
}

#[test]
fn wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    let study = written(&folder, PLATE);
    let wrong = |over: &str| {
        let output = sensitol(&["sweep", &study, "--over", over]).output().unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{over}");
        let text = String::from_utf8(output.stderr).unwrap().replace(&study, "study.toml");
        assert!(!text.contains("panicked"), "{text}");
        text
    };
    let all =
        ["kk=1:2:3", "k=1:2:0", "k=1:2:1", "k=1:1:3", "k=nan:2:3", "k=1:2", "k", "=1:2:3", "k=1:2:2.5", "k=1:x:3"];
    insta::assert_snapshot!("sweep-wrong", all.map(wrong).concat());
    let measured = run(&["sweep", "examples/measured-pin/study.toml", "--over", "pin=1:2:3"]);
    assert!(measured.starts_with("exit 2") && measured.contains("does not move with its nominal"), "{measured}");
    let nothing = run(&["sweep", &study, "--over", "b=-2:-1:3"]);
    assert!(nothing.starts_with("exit 3"), "{nothing}");
    let constant = "[constants]\ng = 1.0\n[dimensions]\na = { nominal = 1.0, tolerance = 0.1 }\n[characteristics]\ny = {}\n\
                    [model]\ncommand = [\"true\"]\n";
    let text = run(&["sweep", &written(&folder, constant), "--over", "g=1:2:3"]);
    assert!(text.starts_with("exit 2") && text.contains("make it a dimension without tolerance"), "{text}");
}

/// An input of a built-in model that the study does not list can be swept, and the results do not depend on threads.
#[test]
fn inputs_of_models_and_threads() {
    let engine = "examples/engine-balance/study.toml";
    let of =
        |threads: &str| run(&["sweep", engine, "--over", "omega=100:600:3", "--kc", "F", "--threads", threads, "-q"]);
    let one = of("1");
    assert!(one.starts_with("exit 0") && one.contains("F [N] over omega [rad/s]"), "{one}");
    assert_eq!(one, of("3"));
}
