//! Rejects on each side of the limits: intervals from their own counts, and proofs for one side.

use assert_cmd::Command;
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{Characteristic, Closure, Method, Options, Problem, SpecLimits, analyze};
use sensitol_study::Study;
use sensitol_study::StudyText;

use sensitol_testing::{data, repository, standard};

const PROOF: &str = "tests/data/discrete/one-sided-proof.toml";

fn output(arguments: &[&str]) -> String {
    let done = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"))
        .current_dir(repository("."))
        .args(arguments)
        .output()
        .unwrap();
    String::from_utf8_lossy(&done.stdout).into_owned()
}

fn json(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&output(arguments)).unwrap()
}

fn interval(of: &serde_json::Value, side: &str) -> [f64; 2] {
    let ends = of[format!("ppm_{side}_interval")].as_array().unwrap();
    [ends[0].as_f64().unwrap(), ends[1].as_f64().unwrap()]
}

/// A product of positive parts is never below 0, however much of it exceeds its upper limit: in text and JSON, by analysis and by
/// samples.
#[test]
fn a_side_is_proven_where_the_other_is_not() {
    let above = data("discrete.json")["one-sided-proof"]["ppm_above"].as_f64().unwrap();
    for command in ["analyze", "simulate"] {
        let text = output(&[command, PROOF, "-v"]);
        assert!(text.contains("0 ppm below") && !text.contains("< 0") && !text.contains("ppm below, < "), "{text}");
        assert!(!text.lines().any(|line| line.contains("ppm below") && line.contains("< ")), "{text}");
        let found = json(&[command, PROOF, "--json"]);
        let one = &found["characteristics"][0];
        assert_eq!(one["ppm_below"].as_f64(), Some(0.0));
        assert_eq!(interval(one, "below"), [0.0, 0.0]);
        let [low, high] = interval(one, "above");
        assert!(low < above && above < high && high < 1.1 * low, "{command}: {low} {above} {high}");
    }
}

/// x(1 - x) is at most 1/4 and x^2 at least 0. The first is proven by branch and bound over a bounded part, the second over an unbounded
/// one.
#[test]
fn proofs_of_one_side_need_neither_bounds_of_both_nor_bounded_parts() {
    let text = "[dimensions]\nx = { nominal = 0.5, tolerance = 0.5, distribution = \"uniform\" }\nz = { nominal = 0, tolerance = 1 }\n\
                [characteristics]\nbent = { formula = \"x*(1 - x)\", lower = 0.1, upper = 0.25 }\n\
                square = { formula = \"z^2\", lower = 0, upper = 0.3 }\n\
                open = { formula = \"z\", lower = -1.5, upper = 0.3 }\n";
    let problem = Study::from_text(StudyText::toml("study.toml", text)).unwrap().problem;
    let analysed = analyze(&problem, &Method::Full.into()).unwrap();
    let sampled = simulate(&problem, &SimulationOptions::default().with_samples(20_000)).unwrap();
    let sides = |c: usize| {
        [analysed.characteristics[c].distribution.reject_intervals, sampled.characteristics[c].reject_intervals]
    };
    for [below, above] in sides(0) {
        assert!(above == Some([0.0; 2]) && below.unwrap()[0] > 0.2, "{below:?} {above:?}");
    }
    for [below, above] in sides(1) {
        assert!(below == Some([0.0; 2]) && above.unwrap()[0] > 0.05, "{below:?} {above:?}");
    }
    // 4.5 sigma below: no proof, and some ppm.
    for [below, above] in sides(2) {
        assert!(below.unwrap()[1] > 0.0 && above.unwrap()[0] > 0.1, "{below:?} {above:?}");
    }
}

/// In at most 2.5 % of all samples the share lies beyond either end of its interval. None of 100,000 means fewer than 37 ppm.
#[test]
fn a_side_has_the_interval_of_its_own_count() {
    let limits = SpecLimits::new(Some(-6.0), Some(1.4)).unwrap();
    let y = Characteristic::new("y").with_limits(limits);
    let problem = Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap().asking([y]).unwrap();
    let found = simulate(&problem, &SimulationOptions::default().with_samples(100_000)).unwrap();
    let [below, above] = found.characteristics[0].reject_intervals.map(Option::unwrap);
    assert!(below[0] == 0.0 && (below[1] - 36.888e-6).abs() < 1e-9, "{below:?}");
    // sf(1.4) = 0.0807567.
    assert!(above[0] < 0.080_756_7 && 0.080_756_7 < above[1] && above[1] - above[0] < 0.004, "{above:?}");
    // Of 500 points, 1.35 lie beyond three sigma. 300 samples miss the share 15 times on average, and 31 times with probability 1/10,000.
    let tail = 1.349_898e-3;
    for sampler in [Sampler::Random, Sampler::Sobol] {
        let limits = SpecLimits::new(Some(-3.0), Some(1.4)).unwrap();
        let y = Characteristic::new("y").with_limits(limits);
        let problem = problem.clone().asking([y]).unwrap();
        let misses = (0..300).filter(|&seed| {
            let wish = SimulationOptions::default().with_samples(500).with_sampler(sampler).with_seed(seed);
            let [low, high] = simulate(&problem, &wish).unwrap().characteristics[0].reject_intervals[0].unwrap();
            !(low..=high).contains(&tail)
        });
        let misses = misses.count();
        assert!(misses <= 31, "{sampler:?}: {misses}");
    }
}

/// A surface as control variate changes the interval of the yield, and each side has an interval of its own.
#[test]
fn a_side_beside_a_surrogate_has_its_own_interval() {
    let limits = SpecLimits::new(Some(-4.5), Some(1.4)).unwrap();
    let y = Characteristic::new("y").with_limits(limits);
    let problem = Problem::new(standard(2), Closure::scalar("y", |x| (x[0] + 0.01 * x[1] * x[1]) * 0.999)).unwrap();
    let problem = problem.asking([y]).unwrap();
    let wish = SimulationOptions::default().with_samples(4096).with_control(Method::Full.into());
    let found = simulate(&problem, &wish).unwrap();
    let [below, above] = found.characteristics[0].reject_intervals.map(Option::unwrap);
    let share = found.characteristics[0].above.unwrap();
    // None of 4096 points: at most 0.09 %. The error of the yield is far larger, because of the other side.
    assert!(below[0] == 0.0 && below[1] < 1.5e-3, "{below:?}");
    assert!(above[0] < share && share < above[1] && above[1] < 1.5 * above[0], "{above:?} {share}");
}

/// The interval of a side from a stratified sample of the model contains the tail probability. It is small for an empty side.
#[test]
fn a_side_of_weighted_points_has_an_effective_count() {
    // The larger of two normal variables exceeds 2.5 with probability 1 - cdf(2.5)^2 = 1.2381 %, and is below -6 with 1e-18.
    let text = "[dimensions]\na = { nominal = 0, tolerance = 3 }\nb = { nominal = 0, tolerance = 3 }\n\
                [characteristics]\ny = { formula = \"max(a, b)\", lower = -6, upper = 2.5 }\n";
    let problem = Study::from_text(StudyText::toml("study.toml", text)).unwrap().problem;
    let mut held = 0;
    for seed in 1..=20 {
        let options = Options::from(Method::SecondOrder).with_seed(seed);
        let found = analyze(&problem, &options).unwrap();
        let [below, above] = found.characteristics[0].distribution.reject_intervals.map(Option::unwrap);
        // Equivalent to none of the 32 768 points of the core: 3.7 of them.
        assert!(below[0] == 0.0 && below[1] > 0.0 && below[1] < 2e-4, "{below:?}");
        held += u32::from(above[0] <= 0.012_380_8 && 0.012_380_8 <= above[1]);
        assert!(above[1] - above[0] < 2e-3, "{above:?}");
    }
    // Sixteen or fewer of twenty 95 % intervals contain the truth with probability 1/3000.
    assert!(held >= 17, "{held}");
}

/// Every value of a sweep has the intervals of its two sides.
#[test]
fn a_sweep_has_the_intervals_of_its_sides() {
    let found = json(&["sweep", PROOF, "--over", "a=0.5:0.7:3", "--json"]);
    let points = found["characteristics"][0]["points"].as_array().unwrap();
    assert!(!points.is_empty());
    for point in points {
        let [low, high] = interval(point, "above");
        assert!(low < high, "{point}");
        assert_eq!(interval(point, "below"), [0.0, 0.0]);
    }
}
