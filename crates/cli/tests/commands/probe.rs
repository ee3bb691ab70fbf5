//! Findings of a probe for models that behave well, drift, flip, or have noise.

use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use sensitol::assembly::Run;
use sensitol::probe::{Finding, Probe, evaluations, probe};
use sensitol::{Closure, Problem};

use super::command::sensitol;
use sensitol_testing::{normals, refusing};

fn of(function: Closure) -> Probe {
    probe(&Problem::new(normals(&[3.0, 2.0], &[0.3, 0.6]), function).unwrap(), &Run::to_the_end()).unwrap()
}

fn scalar(function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Probe {
    of(Closure::scalar("y", function))
}

fn failed(probe: &Probe) -> Vec<&'static str> {
    probe.checks.iter().filter(|check| matches!(check.verdict, Finding::Failed(_))).map(|check| check.what).collect()
}

#[test]
fn a_model_that_behaves_passes() {
    let found = scalar(|x| x[0] * x[1]);
    assert!(found.passed(), "{:?}", found.checks);
    assert_eq!((found.run.evaluations, found.adapter.is_none()), (2 * 2 + 55, true));
    assert_eq!(found.characteristics[0].nominal, Some(6.0));
    // A rounding error of 6 is 9e-16. Its noise is of that size, if it is visible at all.
    assert!(found.characteristics[0].noise.is_none_or(|noise| noise < 1e-14));
    // A symmetric parabola has no slope, but it reacts.
    let parabola = scalar(|x| (x[0] - 3.0).powi(2));
    assert!(parabola.passed());
    assert_eq!(parabola.characteristics[0].silent, ["x1"]);
}

/// Noise of known size: a hash of the coordinates, uniform with sigma 1e-6.
#[test]
fn noise_is_measured() {
    let hiss = |x: &[f64]| {
        let mut bits = x[0].to_bits() ^ x[1].to_bits().rotate_left(17);
        for _ in 0..3 {
            bits = (bits ^ (bits >> 31)).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        }
        ((bits >> 11) as f64 / (1u64 << 53) as f64 - 0.5) * 12f64.sqrt() * 1e-6
    };
    let found = scalar(move |x| x[0] - 2.0 * x[1] + hiss(x));
    assert!(found.passed(), "{:?}", found.checks);
    // Nine values give a standard deviation within a factor of about two.
    let noise = found.characteristics[0].noise.unwrap();
    assert!((2e-7..5e-6).contains(&noise), "{noise}");
    // A step of h sigmas changes y by 0.1 h for x0. The noise is a thousandth of that at h = 1e-2.
    let step = found.characteristics[0].least_step[0].unwrap();
    assert!((step / (noise / 0.1 / 1e-3) - 1.0).abs() < 1e-3, "{step}");
}

#[test]
fn models_that_remember_are_found_out() {
    // Drift with every point.
    let count = AtomicUsize::new(0);
    let drift = scalar(move |x| x[0] + 1e-3 * count.fetch_add(1, Ordering::Relaxed) as f64);
    assert!(failed(&drift).contains(&"the same point twice has the same values"), "{:?}", drift.checks);
    // Mirrored solution from some point on.
    let mirrored = AtomicBool::new(false);
    let flip = scalar(move |x| {
        if x[0] > 3.2 {
            mirrored.store(true, Ordering::Relaxed);
        }
        if mirrored.load(Ordering::Relaxed) { -x[0] } else { x[0] }
    });
    assert!(failed(&flip).contains(&"the nominal values are the same after other points"), "{:?}", flip.checks);
    // A failed point changes the later answers.
    let poisoned = std::sync::Arc::new(AtomicBool::new(false));
    let (seen, kept) = (std::sync::Arc::clone(&poisoned), poisoned);
    let function = refusing(
        move |x| x[0] + if kept.load(Ordering::Relaxed) { 0.1 } else { 0.0 },
        move |x| {
            let fails = x[0] > 10.0;
            seen.fetch_or(fails, Ordering::Relaxed);
            fails
        },
    );
    assert_eq!(failed(&of(function)), ["the nominal values are the same after points where it may fail"]);
}

#[test]
fn models_without_values_or_reaction_fail() {
    let none = of(refusing(|x| x[0], |_| true));
    // No further point is evaluated, and no other check has a verdict.
    assert_eq!((failed(&none), none.run.evaluations), (vec!["the nominal dimensions have values"], 1));
    assert!(none.checks[1..].iter().all(|check| check.verdict == Finding::NotChecked), "{:?}", none.checks);
    assert!(!none.passed());
    let mute = scalar(|_| 7.0);
    assert_eq!(failed(&mute), ["every characteristic reacts to some dimension"]);
}

/// Points of the plan without a value are named. Few of them are a doubt, many are a fault. A check without any values has no verdict.
#[test]
fn points_without_values_are_named() {
    // x0 has mean 3 and sigma 0.1. Only the step up and some of the scattered points reach beyond.
    let verdict =
        |found: &Probe, what: &str| found.checks.iter().find(|check| check.what == what).unwrap().verdict.clone();
    let within = "every point within the tolerances has values";
    let one = of(refusing(|x| x[0] * x[1], |x| x[1] == 2.0 && x[0] > 3.05));
    let Finding::Doubtful(fault) = verdict(&one, within) else { panic!("{:?}", one.checks) };
    assert!(fault.starts_with("1 of 21 points had no value: x0 = 3.1: "), "{fault}");
    assert!(one.passed() && failed(&one).is_empty());
    let half = of(refusing(|x| x[0] * x[1], |x| x[0] > 3.0));
    let Finding::Failed(fault) = verdict(&half, within) else { panic!("{:?}", half.checks) };
    // Four of the nine points on the line, a step, and some of the scattered points lie above. Five are named.
    assert!(fault.matches("x0 = ").count() == 5 && fault.contains("; and "), "{fault}");
    // With values at the nominal dimensions only, neither order nor reaction can be checked.
    let lonely = of(refusing(|x| x[0], |x| x[0] != 3.0 || x[1] != 2.0));
    for what in ["the order of the points does not matter", "every characteristic reacts to some dimension"] {
        assert_eq!(verdict(&lonely, what), Finding::NotChecked);
    }
    assert_eq!(verdict(&lonely, "the nominal values are the same after other points"), Finding::Passed);
    assert!(!lonely.passed());
    let problem = Problem::new(normals(&[3.0, 2.0], &[0.3, 0.6]), Closure::scalar("y", |x| x[0])).unwrap();
    assert_eq!((evaluations(&problem), half.run.evaluations), (59, 59));
}

/// Runs a command on a study of one dimension with sigma 1/30, whose model executes `does` at the point `x`.
fn program(does: &str, arguments: &[&str]) -> (Option<i32>, String, String) {
    let folder = tempfile::tempdir().unwrap();
    let script = format!(
        "import json, os, sys\nhello = json.loads(sys.stdin.readline())\nprint(json.dumps({{'ready': True}}), flush=True)\n\
         for line in sys.stdin:\n    request = json.loads(line)\n    x = request['x'][0]\n    {does}\n    \
         print(json.dumps({{'id': request['id'], 'y': [2 * x]}}), flush=True)\n"
    );
    std::fs::write(folder.path().join("model.py"), script).unwrap();
    let study = folder.path().join("study.toml");
    let text = "[model]\ncommand = [\"python3\", \"model.py\"]\nretries = 0\n[dimensions]\n\
                hub_od = { nominal = 70, tolerance = 0.1 }\n[characteristics]\npressure = { lower = 139 }\n";
    std::fs::write(&study, text).unwrap();
    let output = sensitol(&[&[arguments[0], study.to_str().unwrap()], &arguments[1..]].concat()).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    // Joins long lines that were wrapped.
    (output.status.code(), text(output.stdout).replace("\n    ", " "), text(output.stderr))
}

/// A model that crashes beyond 1.7 sigma is reported, with the point and the exit status.
#[test]
fn a_program_that_crashes_at_a_point_is_told_of() {
    let crashes = "if 70.057 < x < 71: sys.exit(3)";
    let (code, text, _) = program(crashes, &["probe"]);
    let line = text.lines().find(|line| line.contains("every point within the tolerances")).unwrap();
    assert!(line.starts_with("  WARN  ") && line.contains(" of 19 points had no value: hub_od = 70.0"), "{text}");
    assert!(line.contains("the model ended while it evaluated this point (exit code 3)"), "{text}");
    assert_eq!(code, Some(0));
}

/// A model that prints between its answers: one point is evaluated, no check passes, and the error names the remedy.
#[test]
fn a_program_that_prints_is_told_where_to() {
    let prints = "print('rebuilding', flush=True)";
    let hint = "`rebuilding`; stdout belongs to the protocol: print to stderr";
    let (code, text, _) = program(prints, &["probe"]);
    assert!(code == Some(1) && text.contains("; 1 evaluation\n") && text.contains(hint), "{text}");
    assert!(text.contains("FAIL  the nominal dimensions have values: ") && !text.contains("  ok  "), "{text}");
    assert_eq!(text.matches(": not checked, as there are no values").count(), 8, "{text}");
    let (_, text, _) = program(prints, &["probe", "--json"]);
    let report: serde_json::Value = serde_json::from_str(&text).unwrap();
    let checks = report["checks"].as_array().unwrap();
    assert_eq!((&checks[0]["passed"], &checks[0]["verdict"]), (&false.into(), &"fail".into()));
    assert!(checks[1..].iter().all(|check| check["passed"].is_null() && check["verdict"] == "not-checked"));
    assert_eq!(report["passed"], false);
    let (code, _, error) = program(prints, &["analyze", "--method", "rss", "--journal", "none"]);
    assert!(code == Some(3) && error.contains(hint), "{error}");
}

/// Answers that differ in the last digits are a doubt. If the difference is close to the effect of the tolerances, it is a fault. So is
/// noise of that size, or a jump at the nominal dimensions.
#[test]
fn noise_is_judged_by_what_the_tolerances_move() {
    let verdict =
        |found: &Probe, what: &str| found.checks.iter().find(|check| check.what == what).unwrap().verdict.clone();
    let (twice, noise) = ("the same point twice has the same values", "noise is small beside what the tolerances move");
    let hiss = |size: f64| {
        let count = AtomicUsize::new(0);
        // Multiples of the golden ratio are as good as random and never repeat.
        let next = move || (count.fetch_add(1, Ordering::Relaxed) as f64 * 0.618_033_988_749_894_9).fract() - 0.5;
        scalar(move |x| x[0] - 2.0 * x[1] + size * next())
    };
    // A good CAD body repeats to some 1e-13. The tolerances move this model by about 2.
    let good = hiss(1e-11);
    assert!(matches!(verdict(&good, twice), Finding::Doubtful(_)), "{:?}", good.checks);
    assert!(good.passed(), "{:?}", good.checks);
    let bad = hiss(0.1);
    assert!(!bad.passed() && matches!(verdict(&bad, noise), Finding::Failed(_)), "{:?}", bad.checks);
    let doubtful = scalar(|x| x[0] - 2.0 * x[1] + 3e-5 * (1e9 * x[0]).sin());
    assert!(matches!(verdict(&doubtful, noise), Finding::Doubtful(_)) && doubtful.passed(), "{:?}", doubtful.checks);
    let jump = scalar(|x| x[0] - 2.0 * x[1] + if x[0] > 3.0 { 0.5 } else { 0.0 });
    assert!(matches!(verdict(&jump, noise), Finding::Failed(_)) && !jump.passed(), "{:?}", jump.checks);
}

/// Restarts are counted and reported, by a probe and by every other command.
#[test]
fn restarts_are_told_of() {
    let folder = tempfile::tempdir().unwrap();
    let died = folder.path().join("died").display().to_string();
    let crashes = format!(
        "if x > 70.01 and not os.path.exists({died:?}): open({died:?}, 'w').close(); print('no licence', file=sys.stderr); os._exit(7)"
    );
    let fresh = || drop(std::fs::remove_file(&died));
    let (code, text, _) = program(&crashes, &["probe"]);
    let line = text.lines().find(|line| line.contains("its processes go on running")).unwrap();
    // The point of the crash is lost here, because the helper never retries.
    assert!(code == Some(1) && line.starts_with("  WARN  ") && line.contains("no licence"), "{text}");
    for command in [
        &["analyze", "--method", "full", "--journal", "none", "--json"][..],
        &["simulate", "--samples", "30", "--journal", "none", "--json"],
    ] {
        fresh();
        let (_, text, error) = program(&crashes, command);
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        let evaluator = &report["evaluator"];
        assert!(evaluator["crashes"] == 1 && evaluator["starts"].as_u64().unwrap() >= 2, "{evaluator}");
        assert_eq!((&evaluator["timeouts"], &evaluator["garbage"]), (&0.into(), &0.into()));
        let warnings = report["warnings"].as_array().unwrap();
        let warning = warnings.iter().find(|warning| warning["code"] == "restarts").unwrap();
        assert_eq!((&warning["data"]["crashes"], &warning["data"]["stderr"][0]), (&1.into(), &"no licence".into()));
        assert!(error.contains("[restarts]") && error.contains("exit code 7"), "{error}");
        let (_, text, error) = program(&crashes, command);
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        assert!(report["evaluator"]["crashes"] == 0 && !error.contains("restarts"), "{error}");
    }
}
