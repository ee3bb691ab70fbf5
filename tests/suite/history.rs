//! Models that remember the points before: no wrong number without a word. The child is `tests/children/flips.c`.

use sensitol::assembly::process::{Greeting, Process, Settings};
use sensitol::assembly::{Ask, AssemblyFunction, Points, Responses, Run, Signature};
use sensitol::probe::probe;
use sensitol::{Dimension, Method, Problem, analyze};

use super::support::child_in_c;

/// Seeds of every kind of model.
const SEEDS: usize = 40;
const DIMENSIONS: usize = 4;

fn process(mode: &str, seed: usize) -> Process {
    with(mode, seed, true)
}

/// Without sentinels, which would hide what a probe looks for.
fn probed(mode: &str, seed: usize) -> Process {
    with(mode, seed, false)
}

fn with(mode: &str, seed: usize, sentinels: bool) -> Process {
    let names: Vec<String> = (0..DIMENSIONS).map(|d| format!("x{d}")).collect();
    let greeting = Greeting { nominal: vec![1.0; DIMENSIONS], ..Greeting::default() };
    let settings = Settings { sentinels, ..Settings::new([child_in_c(), mode.into(), seed.to_string()]) };
    Process::new(Signature::of_names(names, ["y"]), greeting, settings)
}

/// What a method says of a model: sigma, and the codes of its warnings.
struct Said {
    sigma: Option<f64>,
    codes: Vec<&'static str>,
}

impl Said {
    fn of(mode: &str, seed: usize, method: Method) -> Self {
        // A tenth is a sigma, as the child has it.
        let dimension = |d: usize| Dimension::normal(format!("x{d}"), 1.0, 0.3).unwrap();
        let problem = Problem::new((0..DIMENSIONS).map(dimension), process(mode, seed)).unwrap();
        let Ok(analysis) = analyze(&problem, &method.into()) else { return Self { sigma: None, codes: Vec::new() } };
        let sigma = analysis.characteristics[0].moments.map(|moments| moments.sigma());
        Self { sigma, codes: analysis.warnings.iter().map(|warning| warning.code()).collect() }
    }

    fn warns(&self) -> bool {
        ["branch-flip", "not-repeatable"].iter().any(|code| self.codes.contains(code))
    }

    /// Whether sigma is that of the right assembly: the same arithmetic at the same points.
    fn right(&self, plain: &Self) -> bool {
        self.sigma.zip(plain.sigma).is_some_and(|(found, expected)| (found - expected).abs() <= 1e-9 * expected)
    }
}

/// The other assembly after a long way, until the next long way: the answers come out right, and the report says so.
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

/// A model that is another one with every point has no number that could be trusted.
#[test]
fn a_drift_is_never_silent() {
    for seed in 0..SEEDS {
        let said = Said::of("drift", seed, Method::Full);
        assert!(said.warns() || said.sigma.is_none(), "{seed}: {:?} {:?}", said.sigma, said.codes);
    }
}

/// Errors at random in 3 of 100 answers: wherever they reach the result they are named.
#[test]
fn random_flips_are_never_silent() {
    let mut silent = 0;
    for seed in 0..SEEDS {
        let (plain, said) = (Said::of("plain", seed, Method::Full), Said::of("random", seed, Method::Full));
        silent += usize::from(!said.right(&plain) && !said.warns());
    }
    // Each run has 21 answers, half of the runs none that is wrong. A wrong one is several sigma off, so that it is among the
    // seven that are replayed; a replay that is wrong in the same way is rarer than one run in 200.
    assert!(silent <= 1, "{silent} of {SEEDS}");
}

/// Functions without a memory, however curved, and with a jump: nothing is said of a memory, and no value is changed.
#[test]
fn functions_raise_no_alarm() {
    for mode in ["smooth", "jump", "plain"] {
        for seed in 0..SEEDS {
            let said = Said::of(mode, seed, Method::Full);
            assert!(said.sigma.is_some() && !said.warns(), "{mode} {seed}: {:?} {:?}", said.sigma, said.codes);
        }
    }
}

/// Seven answers are replayed, each in three steps from the nominal point; more of many, as many as are asked for, or none.
#[test]
fn what_a_replay_costs() {
    let extra = |points: usize, verify: Option<usize>| {
        let names: Vec<String> = (0..DIMENSIONS).map(|d| format!("x{d}")).collect();
        let greeting = Greeting { nominal: vec![1.0; DIMENSIONS], ..Greeting::default() };
        let settings = Settings { verify, ..Settings::new([child_in_c(), "plain".into(), "1".into()]) };
        let process = Process::new(Signature::of_names(names, ["y"]), greeting, settings);
        let rows: Vec<[f64; DIMENSIONS]> = (1..=points).map(|i| [1.0 + 1e-3 * i as f64, 1.0, 1.0, 1.0]).collect();
        let mut out = Responses::open(points, 1);
        process.evaluate(&Ask::values(&Points::from_rows(&rows), &[0]), &Run::to_the_end(), &mut out);
        assert!((0..points).all(|row| out.value(row, 0).is_some()) && out.non_repeatable().is_empty());
        out.extra()
    };
    // Without any, sentinels alone: one at the end, and one for every 64 points of a window of four.
    let sentinels = extra(20, Some(0));
    assert_eq!(extra(20, None) - sentinels, 7 * 4);
    assert_eq!(extra(20, Some(3)) - sentinels, 3 * 4);
    assert_eq!(extra(400, None) - extra(400, Some(0)), (20 + 2) * 4);
}

/// `probe` fails what an analysis would have to mend, and nothing else.
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
