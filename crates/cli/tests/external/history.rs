//! Models that remember earlier points: no wrong number without a warning. The child is `tests/children/flips.c`.

use std::sync::atomic::{AtomicUsize, Ordering};

use sensitol::assembly::{AssemblyFunction, Points, Request, Responses, Run, Signature};
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};

use sensitol::probe::probe;
use sensitol::{Dimension, Method, Options, Problem, Warning, analyze};
use sensitol_external::journal::Journaled;

use super::command::sensitol;
use sensitol_testing::{child_in_c, repository};

/// Number of seeds for every kind of model.
const SEEDS: usize = 40;
const DIMENSIONS: usize = 4;

fn process(mode: &str, seed: usize) -> Process {
    with(mode, seed, true, 1)
}

fn processes(mode: &str, seed: usize, workers: usize) -> Process {
    with(mode, seed, true, workers)
}

/// Returns a model without sentinels, which would hide the differences that a probe looks for.
fn probed(mode: &str, seed: usize) -> Process {
    with(mode, seed, false, 1)
}

fn with(mode: &str, seed: usize, sentinels: bool, workers: usize) -> Process {
    let names: Vec<String> = (0..DIMENSIONS).map(|d| format!("x{d}")).collect();
    let greeting = Greeting::new(vec![1.0; DIMENSIONS]);
    let settings = Settings::new([child_in_c(), mode.into(), seed.to_string()]).with_sentinels(sentinels);
    let settings = settings.with_workers(workers);
    Process::new(Signature::of_names(names, ["y"]), greeting, settings)
}

/// Report of a method on a model: sigma, and the codes of its warnings.
struct Said {
    sigma: Option<f64>,
    codes: Vec<&'static str>,
}

impl Said {
    fn of(mode: &str, seed: usize, method: Method) -> Self {
        Self::of_process(process(mode, seed), method)
    }

    fn of_process(process: Process, method: Method) -> Self {
        // A tenth is one sigma, as in the child.
        let dimension = |d: usize| Dimension::normal(format!("x{d}"), 1.0, 0.3).unwrap();
        let problem = Problem::new((0..DIMENSIONS).map(dimension), process).unwrap();
        let Ok(analysis) = analyze(&problem, &method.into()) else { return Self { sigma: None, codes: Vec::new() } };
        let sigma = analysis.characteristics[0].moments.map(|moments| moments.sigma());
        Self { sigma, codes: analysis.warnings.iter().map(|warning| warning.code()).collect() }
    }

    fn warns(&self) -> bool {
        ["branch-flip", "not-repeatable"].iter().any(|code| self.codes.contains(code))
    }

    /// True if sigma is that of the right assembly, from the same arithmetic at the same points.
    fn right(&self, plain: &Self) -> bool {
        self.sigma.zip(plain.sigma).is_some_and(|(found, expected)| (found - expected).abs() <= 1e-9 * expected)
    }
}

/// A long move leads to the other assembly until the next long move. The answers are corrected, and the report contains a warning.
#[test]
fn flips_are_found_and_mended() {
    for mode in ["toggle", "pairs"] {
        for seed in 0..SEEDS {
            let (plain, said) = (Said::of("plain", seed, Method::Full), Said::of(mode, seed, Method::Full));
            assert!(said.right(&plain), "{mode} {seed}: {:?} for {:?}, {:?}", said.sigma, plain.sigma, said.codes);
            assert!(said.warns(), "{mode} {seed}: {:?}", said.codes);
        }
    }
}

/// Walks side by side in four children find and correct the same answers.
#[test]
fn flips_are_found_by_several_children() {
    for mode in ["toggle", "pairs"] {
        for seed in 0..SEEDS / 4 {
            let plain = Said::of("plain", seed, Method::Full);
            let said = Said::of_process(processes(mode, seed, 4), Method::Full);
            assert!(said.right(&plain), "{mode} {seed}: {:?} for {:?}, {:?}", said.sigma, plain.sigma, said.codes);
        }
    }
}

/// Walks take place in as many fresh children as there are, up to the number of walks.
#[test]
fn walks_are_side_by_side() {
    for (workers, walks, expected) in [(1, 4, 2), (3, 4, 4), (8, 4, 5), (8, 2, 3)] {
        let process = processes("plain", 1, workers);
        // One window of four points needs one child, once the window is known.
        process.prepare(&[0]).unwrap();
        let rows: Vec<[f64; DIMENSIONS]> = (1..=walks).map(|i| [1.0 + 1e-3 * i as f64, 1.0, 1.0, 1.0]).collect();
        let mut out = Responses::open(walks, 1);
        process.evaluate(&Request::values(&Points::from_rows(&rows), &[0]), &Run::to_the_end(), &mut out);
        let starts = process.account().map(|account| account.counts.starts);
        assert_eq!((starts, out.extra()), (Some(expected), 1 + 4 * walks as i64), "{workers} workers, {walks} walks");
    }
}

/// Classic differences over steps of three sigma, and a plan without pairs.
#[test]
fn flips_are_found_by_other_plans() {
    for method in [Method::Classic, Method::SecondOrder, Method::Rss] {
        for seed in 0..SEEDS / 4 {
            let (plain, said) = (Said::of("plain", seed, method), Said::of("toggle", seed, method));
            assert!(said.right(&plain) && said.warns(), "{method:?} {seed}: {:?} for {:?}", said.sigma, plain.sigma);
        }
    }
}

/// A model that changes with every point has no trusted number.
#[test]
fn a_drift_is_never_silent() {
    for seed in 0..SEEDS {
        let said = Said::of("drift", seed, Method::Full);
        assert!(said.warns() || said.sigma.is_none(), "{seed}: {:?} {:?}", said.sigma, said.codes);
    }
}

/// Random errors in 3 of 100 answers: whenever they affect the result, they are named.
#[test]
fn random_flips_are_never_silent() {
    let mut silent = 0;
    for seed in 0..SEEDS {
        let (plain, said) = (Said::of("plain", seed, Method::Full), Said::of("random", seed, Method::Full));
        silent += usize::from(!said.right(&plain) && !said.warns());
    }
    // Each run has 21 answers, and half of the runs have no wrong one. A wrong answer is several sigma off, so that it is among the seven
    // replayed ones. A replay that is wrong in the same way is rarer than one run in 200.
    assert!(silent <= 1, "{silent} of {SEEDS}");
}

/// Functions without memory, however curved, and with a jump: no warning about memory, and no changed value.
#[test]
fn functions_raise_no_alarm() {
    for mode in ["smooth", "jump", "plain"] {
        for seed in 0..SEEDS {
            let said = Said::of(mode, seed, Method::Full);
            assert!(said.sigma.is_some() && !said.warns(), "{mode} {seed}: {:?} {:?}", said.sigma, said.codes);
        }
    }
}

/// Seven answers are replayed, each in three steps from the nominal point. Many answers need more replays, up to 59. A given number is used, 0 for
/// none.
#[test]
fn what_a_replay_costs() {
    let extra = |points: usize, verify: Option<usize>| {
        let names: Vec<String> = (0..DIMENSIONS).map(|d| format!("x{d}")).collect();
        let greeting = Greeting::new(vec![1.0; DIMENSIONS]);
        let mut settings = Settings::new([child_in_c(), "plain".into(), "1".into()]);
        settings.verify = verify;
        let process = Process::new(Signature::of_names(names, ["y"]), greeting, settings);
        let rows: Vec<[f64; DIMENSIONS]> = (1..=points).map(|i| [1.0 + 1e-3 * i as f64, 1.0, 1.0, 1.0]).collect();
        let mut out = Responses::open(points, 1);
        process.evaluate(&Request::values(&Points::from_rows(&rows), &[0]), &Run::to_the_end(), &mut out);
        assert!((0..points).all(|row| out.value(row, 0).is_some()) && out.non_repeatable().is_empty());
        out.extra()
    };
    // Without replays there are only sentinels: one at the end, and one for every 64 points of a window of four, in any order of the
    // answers.
    let [of_20, of_400, of_2000] = [20, 400, 2000].map(|points| extra(points, Some(0)));
    assert_eq!([of_20, of_400, of_2000], [1, 7, 32]);
    assert_eq!(extra(20, None) - of_20, 7 * 4);
    assert_eq!(extra(20, Some(3)) - of_20, 3 * 4);
    assert_eq!(extra(400, None) - of_400, 20 * 4);
    // At most 59 replays.
    assert_eq!(extra(2000, None) - of_2000, 59 * 4);
}

/// `probe` fails for models whose answers an analysis would have to correct, and for no others.
#[test]
fn a_probe_fails_models_that_flip() {
    for (mode, passes) in [("toggle", false), ("plain", true), ("smooth", true), ("jump", true)] {
        for seed in 0..SEEDS {
            let dimension = |d: usize| Dimension::normal(format!("x{d}"), 1.0, 0.3).unwrap();
            let process = probed(mode, seed);
            let problem = Problem::new((0..DIMENSIONS).map(dimension), process).unwrap();
            let found = probe(&problem, &Run::to_the_end()).unwrap();
            assert_eq!(found.passed(), passes, "{mode} {seed}: {:?}", found.checks);
        }
    }
}

/// Returns a model of sums and products by `child.py`, whose first process answers wrongly. `verify` answers are replayed.
fn first_lies(mode: &str, folder: &std::path::Path, verify: Option<usize>) -> Process {
    let script = repository("tests/children/child.py").display().to_string();
    let seen = folder.join("seen").display().to_string();
    let settings = Settings::new(["python3".to_owned(), script, mode.to_owned(), seen]);
    let settings = verify.map_or(settings.clone(), |verify| settings.with_verify(verify));
    Process::new(Signature::of_names(["a", "b"], ["sum", "product"]), Greeting::new(vec![1.0, 2.0]), settings)
}

fn sums(process: &dyn AssemblyFunction, a: impl Iterator<Item = usize>) -> Responses {
    let rows: Vec<[f64; 2]> = a.map(|a| [a as f64, 2.0]).collect();
    let mut out = Responses::open(rows.len(), 2);
    process.evaluate(&Request::values(&Points::from_rows(&rows), &[0, 1]), &Run::to_the_end(), &mut out);
    out
}

/// Steps of 0.4 sigmas never lead to the other assembly, but check points do: their finding is reported too.
#[test]
fn flips_of_check_points_are_told() {
    let dimension = |d: usize| Dimension::normal(format!("x{d}"), 1.0, 0.3).unwrap();
    let problem = || Problem::new((0..DIMENSIONS).map(dimension), process("toggle", 1)).unwrap();
    let codes = |points: usize| -> Vec<&'static str> {
        let options = Options::from(Method::SecondOrder).with_step(0.4).with_verify(points);
        analyze(&problem(), &options).unwrap().warnings.iter().map(|warning| warning.code()).collect()
    };
    assert!(!codes(0).contains(&"branch-flip"), "{:?}", codes(0));
    assert!(codes(12).contains(&"branch-flip"), "{:?}", codes(12));
}

/// A flip found in a later batch causes a check of earlier answers: the wrong one is named, and no other.
#[test]
fn a_late_flip_looks_back() {
    let folder = tempfile::tempdir().unwrap();
    // One replay, of a point in the middle: the wrong answer of the first batch is not among it.
    let process = first_lies("first-lies-once", folder.path(), Some(1));
    let first = sums(&process, 2..60);
    assert_eq!((first.value(11, 0), first.non_repeatable().len()), (Some(13.0 + 2.0 + 7.0), 0));
    assert_eq!(process.account().unwrap().counts.unconfirmed, 0);
    let second = sums(&process, 90..110);
    assert!((0..20).all(|row| second.value(row, 0) == Some((90 + row + 2) as f64)));
    assert!(!second.non_repeatable().is_empty());
    assert_eq!(second.revoked(), [[13.0, 2.0]]);
    assert_eq!(process.account().unwrap().counts.unconfirmed, 1);
}

/// A study of a drifting model: its figures are unreliable, and the exit code is 3 even without `--check`.
#[test]
fn what_nothing_confirms_ends_with_3() {
    let run = |mode: &str, more: &[&str]| {
        let folder = tempfile::tempdir().unwrap();
        let dimensions: String =
            (0..DIMENSIONS).map(|d| format!("x{d} = {{ nominal = 1, tolerance = 0.3 }}\n")).collect();
        let study = format!(
            "[model]\ncommand = [{:?}, {mode:?}, \"1\"]\n[dimensions]\n{dimensions}[characteristics]\ny = {{ lower = -20 }}\n",
            child_in_c()
        );
        let path = folder.path().join("study.toml");
        std::fs::write(&path, study).unwrap();
        let output = sensitol(&[&[more[0], path.to_str().unwrap(), "--json"], &more[1..]].concat()).output().unwrap();
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap_or_default();
        (output.status.code(), report, String::from_utf8(output.stderr).unwrap())
    };
    for more in
        [&["analyze", "--method", "full"][..], &["analyze", "--method", "rss"], &["simulate", "--samples", "40"]]
    {
        let (code, report, error) = run("drift", more);
        assert_eq!(code, Some(3), "{more:?}: {error}");
        assert!(report["evaluator"]["unconfirmed"].as_u64().unwrap() > 0, "{more:?}: {}", report["evaluator"]);
        assert!(error.contains("[unconfirmed]"), "{error}");
        let (code, report, error) = run("plain", more);
        assert_eq!((code, &report["evaluator"]["unconfirmed"]), (Some(0), &0.into()), "{more:?}: {error}");
        assert_eq!(report["evaluator"]["crashes"], 0);
    }
    // A shard has no verdict that could be withheld: its sums are not written.
    let shard = ["simulate", "--samples", "40", "--shards", "2", "--shard", "1"];
    let (code, report, error) = run("drift", &shard);
    let codes: Vec<&str> =
        report["errors"].as_array().unwrap().iter().map(|one| one["code"].as_str().unwrap()).collect();
    assert_eq!((code, codes), (Some(2), vec!["shard"]), "{error}");
    let (code, _, error) = run("plain", &shard);
    assert_eq!(code, Some(0), "{error}");
    // All answers are right in the end, by fresh processes.
    let (code, report, error) = run("toggle", &["analyze", "--method", "full"]);
    assert_eq!((code, &report["evaluator"]["unconfirmed"]), (Some(0), &0.into()), "{error}");
}

/// A batch that ended before its check is checked by the next run as any batch: by the nominal point and seven replays of four evaluations.
#[test]
fn a_stage_that_was_not_checked_is_checked_when_it_is_used() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("a.sqlite");
    let model = |mode: &str, seen: &str| {
        let folder = folder.path().join(seen);
        std::fs::create_dir_all(&folder).unwrap();
        Journaled::new(first_lies(mode, &folder, None), journal.clone(), Vec::new())
    };
    let ended = |model: &Journaled| {
        let answered = AtomicUsize::new(0);
        let finished = |rows: &[usize], _: &Responses| {
            answered.fetch_add(rows.len(), Ordering::Relaxed);
        };
        let stop = || (answered.load(Ordering::Relaxed) >= 20).then_some(sensitol::StopReason::Requested);
        let rows: Vec<[f64; 2]> = (2..22).map(|a| [f64::from(a), 2.0]).collect();
        let mut out = Responses::open(rows.len(), 2);
        let run = Run::to_the_end().telling(&finished).stopping_when(&stop);
        model.evaluate(&Request::values(&Points::from_rows(&rows), &[0, 1]), &run, &mut out);
        assert_eq!(answered.load(Ordering::Relaxed), 20);
    };
    // An honest model: its answers are used after 29 evaluations, and after one from then on.
    ended(&model("good", "a"));
    let again = sums(&model("good", "a"), 2..22);
    assert_eq!((again.count_reused(), again.extra()), (20, 1 + 7 * 4 - 20));
    let again = sums(&model("good", "a"), 2..22);
    assert_eq!((again.count_reused(), again.extra()), (20, 1 - 20));
    // A model whose first process was wrong: fresh processes replace its answers.
    ended(&model("first-lies", "b"));
    let again = sums(&model("first-lies", "b"), 2..22);
    assert!(!again.non_repeatable().is_empty());
    assert!((0..20).all(|row| again.value(row, 0) == Some((row + 4) as f64)));
    let last = sums(&model("first-lies", "b"), 2..22);
    assert_eq!((last.count_reused(), last.extra()), (20, 1 - 20));
    assert!((0..20).all(|row| last.value(row, 0) == Some((row + 4) as f64)));
}

/// A jump just above a nominal value, as in a CAD body with two pads that become flush. Every method of differences names it with
/// dimension and value, and none reports one for smooth functions, however curved.
#[test]
fn a_jump_beside_the_nominal_point_is_named() {
    for method in [Method::Rss, Method::SecondOrder, Method::Full, Method::Classic] {
        for seed in 0..SEEDS / 8 {
            let dimension = |d: usize| Dimension::normal(format!("x{d}"), 1.0, 0.3).unwrap();
            let problem = Problem::new((0..DIMENSIONS).map(dimension), process("edge", seed)).unwrap();
            let analysis = analyze(&problem, &method.into()).unwrap();
            let jump = analysis.warnings.iter().find(|warning| warning.code() == "discontinuity");
            let Some(Warning::Discontinuity { dimension, at: Some([from, to]), .. }) = jump else {
                panic!("{method:?} {seed}: {:?}", analysis.warnings)
            };
            // Two hundredths of a sigma above the nominal value: 1.002. The last interval is at most 1/64 of three sigma.
            assert!(dimension == "x0" && (*from..=*to).contains(&1.002) && to - from <= 0.3 / 64.0, "{jump:?}");
        }
    }
    for mode in ["smooth", "plain"] {
        for seed in 0..SEEDS {
            for method in [Method::SecondOrder, Method::Classic] {
                let said = Said::of(mode, seed, method);
                assert!(!said.codes.contains(&"discontinuity"), "{mode} {method:?} {seed}: {:?}", said.codes);
            }
        }
    }
}
