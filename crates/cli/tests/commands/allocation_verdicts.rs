//! An allocation and `analyze --check` of the study that it wrote agree, with and without derivatives that follow the model.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use sensitol::allocation::{Allocation, AllocationOptions, Status, allocate};
use sensitol::{Problem, Verdict, analyze};
use sensitol_study::Study;
use serde_json::Value;

use super::command::sensitol;
use sensitol_testing::repository;

fn cases() -> serde_json::Map<String, Value> {
    let text = std::fs::read_to_string(repository("tests/data/allocation-verdicts.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    all.as_object().unwrap().clone()
}

fn read(text: &str) -> Study {
    Study::from_toml(text, "study.toml").unwrap_or_else(|error| panic!("{error}\n{text}"))
}

fn allocated(study: &Study) -> Allocation {
    let options = AllocationOptions::default().with_analysis(study.options.clone());
    allocate(&study.problem, &study.allocation_task(), &options).unwrap()
}

/// True if a study meets every requirement that `--check` tests.
fn keeps(study: &Study) -> bool {
    is_kept(&study.problem, study)
}

/// True if a problem meets every requirement, analysed with the options of the study.
fn is_kept(problem: &Problem, study: &Study) -> bool {
    let found = analyze(problem, &study.options).unwrap();
    let own = found.characteristics.iter().flat_map(|one| one.requirements());
    own.chain(found.joint_requirement).all(|one| one.verdict == Verdict::Met)
}

fn is_done(status: Status) -> bool {
    matches!(status, Status::Optimal | Status::LocalOptimum | Status::AlmostOptimal)
}

/// Costs are at most 1 % above those from quadrature, because the lower end of the yield's interval must meet the requirement. They are
/// not lower, except by two standard errors of a yield.
#[test]
fn searches_end_near_the_right_cost() {
    let of = |(name, case): (&String, &Value)| {
        let study = read(case["study"].as_str().unwrap());
        let found = allocated(&study);
        let (cost, right) = (found.cost_after.unwrap(), case["cost"].as_f64().unwrap());
        assert!(is_done(found.status), "{name}: {:?}", found.status);
        assert!(cost < 1.01 * right && cost > 0.998 * right, "{name}: {cost} for {right}");
        assert!(cost < found.cost_before.unwrap(), "{name}");
        assert!(found.requirements[0].after.unwrap().verdict == Verdict::Met, "{name}");
        assert!(is_kept(&found.problem, &study), "{name}: {:?}", found.tolerances);
    };
    cases().iter().collect::<Vec<_>>().into_par_iter().for_each(of);
}

/// Returns a random study: formula, dimensions, requirements and costs.
fn random(rng: &mut Xoshiro256PlusPlus) -> String {
    const FORMULAS: [(&str, f64); 7] = [
        ("a - b - c", 1.0),
        ("a - b - c + 0.8*a*c + 2*b^2", 1.0),
        ("a - b + 4*max(0, c - 0.06)", 1.0),
        ("a + b + if(c > 0.09, 0.2, 0)", 0.0),
        ("a - b - 2*abs(c)", 1.0),
        ("hypot(a, b) + c", 0.0),
        ("sqrt(4 + a) - 0.5*b - c", 0.0),
    ];
    let (formula, below) = FORMULAS[rng.random_range(0..FORMULAS.len())];
    let mut text = "[dimensions]\n".to_owned();
    let mut costs = "[costs]\n".to_owned();
    for name in ["a", "b", "c"] {
        let t: f64 = rng.random_range(0.02..0.06);
        let (band, side) = match rng.random_range(0..4) {
            0 => (format!("[0.0, {t:.4}]"), ", fixed_side = \"lower\""),
            1 => (format!("[-{t:.4}, 0.0]"), ", fixed_side = \"upper\""),
            _ => (format!("{t:.4}"), ""),
        };
        let law = ["", "", ", distribution = \"uniform\"", ", distribution = \"triangular\""][rng.random_range(0..4)];
        text += &format!("{name} = {{ nominal = 0.0, tolerance = {band}{law} }}\n");
        let b: f64 = rng.random_range(0.01..0.05);
        costs += &match rng.random_range(0..5) {
            0 => {
                let process = |factor: f64| {
                    let (t, cost) = (factor * t, 1.0 + b / (factor * t));
                    format!("{{ name = \"p{factor}\", tolerance = {t:.4}, cost = {cost:.4} }}")
                };
                format!("{name} = {{ processes = [{}] }}\n", [0.4, 0.8, 1.3, 2.5].map(process).join(", "))
            }
            _ => format!("{name} = {{ model = \"reciprocal\", a = 1.0, b = {b:.4}, min = 0.004, max = 0.5{side} }}\n"),
        };
    }
    let plain = read(&format!("{text}[characteristics]\ny = {{ formula = \"{formula}\" }}\n"));
    let found = analyze(&plain.problem, &plain.options).unwrap();
    let moments = found.characteristics[0].moments.unwrap();
    let room = moments.sigma() * rng.random_range(2.6..7.0);
    let upper = format!("upper = {:.4}", moments.mean() + room);
    let lower = format!("lower = {:.4}, ", moments.mean() - rng.random_range(0.8..1.5) * room);
    let limits = if below > 0.0 && rng.random() { lower + &upper } else { upper };
    let required = match rng.random_range(0..6) {
        0 | 1 => format!("target_yield = {}", [0.99, 0.998, 0.9999, 0.999_999][rng.random_range(0..4)]),
        2 => format!("require = {{ cpk = {:.3} }}", rng.random_range(0.8..1.5)),
        3 => format!("require = {{ sigma = {:.5} }}", moments.sigma() * rng.random_range(0.8..2.0)),
        4 => "require = \"rss\"".to_owned(),
        _ => "require = \"worst-case\"".to_owned(),
    };
    text += "[characteristics]\n";
    if rng.random_range(0..5) == 0 {
        let other = format!("z = {{ formula = \"a + b\", lower = -0.2, upper = {:.3} }}\n", rng.random_range(0.1..0.2));
        let least = [0.99, 0.9973][rng.random_range(0..2)];
        text + &format!(
            "y = {{ formula = \"{formula}\", {limits} }}\n{other}[analysis]\ntarget_joint_yield = {least}\n{costs}"
        )
    } else {
        text + &format!("y = {{ formula = \"{formula}\", {limits}, {required} }}\n{costs}")
    }
}

/// The result is never more expensive than a start that meets every requirement, and there always is a result then. Tolerances with the
/// status that every requirement is met do meet them.
#[test]
fn an_allocation_is_never_worse_than_its_start() {
    const CASES: u64 = 16;
    let of = |case: u64| {
        let text = random(&mut Xoshiro256PlusPlus::seed_from_u64(4800 + case));
        let study = read(&text);
        let kept = keeps(&study);
        let found = allocated(&study);
        let (before, after) = (found.cost_before, found.cost_after);
        let offered = found.requirements.iter().all(|one| (one.before.verdict == Verdict::Met) == kept)
            || found.joint_requirement.is_some();
        assert!(offered || !kept, "case {case}: the verdict before is that of an analysis\n{text}");
        if kept {
            assert!(is_done(found.status), "case {case}: {:?} {:?}\n{text}", found.status, found.attainable);
            assert!(
                after.unwrap() <= before.unwrap() * (1.0 + 1e-9),
                "case {case}: {after:?} after {before:?}\n{text}"
            );
        }
        let met = found.requirements.iter().all(|one| one.after.is_some_and(|after| after.verdict == Verdict::Met))
            && found
                .joint_requirement
                .as_ref()
                .is_none_or(|one| one.after.is_some_and(|after| after.verdict == Verdict::Met));
        assert_eq!(is_done(found.status), met, "case {case}: {:?} {:?}\n{text}", found.status, found.requirements);
        if is_done(found.status) {
            assert!(is_kept(&found.problem, &study), "case {case}: {:?} {:?}\n{text}", found.status, found.tolerances);
        }
        [u64::from(kept), u64::from(is_done(found.status)), u64::from(found.status == Status::AlmostOptimal)]
    };
    let all: Vec<[u64; 3]> = (0..CASES).into_par_iter().map(of).collect();
    let [kept, done, almost] = [0, 1, 2].map(|place| all.iter().map(|case| case[place]).sum::<u64>());
    // Both outcomes occur among the cases.
    assert!(kept > CASES / 4 && kept < CASES, "{kept} of {CASES} starts keep everything");
    assert!(done >= kept && almost > 0 && almost < done, "{done} are done, {almost} of them by trials");
}

/// The command line rounds the tolerances that it writes: its exit code equals that of `analyze --check` on that file.
#[test]
fn the_written_study_passes_its_check() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    for case in 0..6 {
        let text = random(&mut Xoshiro256PlusPlus::seed_from_u64(4900 + case));
        let (study, written) = (at("study.toml"), at("written.toml"));
        std::fs::write(&study, &text).unwrap();
        let output =
            sensitol(&["allocate", &study, "--write", &written, "--force", "--confirm", "0", "-q"]).output().unwrap();
        if output.status.success() {
            let check = sensitol(&["analyze", &written, "--check", "-q"]).output().unwrap();
            assert_eq!(check.status.code(), Some(0), "{text}{}", String::from_utf8_lossy(&check.stdout));
        }
    }
    for (name, case) in cases() {
        let (study, written) = (at("study.toml"), at(&format!("{name}.toml")));
        std::fs::write(&study, case["study"].as_str().unwrap()).unwrap();
        let output =
            sensitol(&["allocate", &study, "--write", &written, "--confirm", "0", "--json", "-q"]).output().unwrap();
        let report: Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!(output.status.code(), Some(0), "{name}: {report}");
        assert_eq!(report["requirements"][0]["verdict"], "met", "{name}");
        let check = sensitol(&["analyze", &written, "--check", "-q"]).output().unwrap();
        assert_eq!(check.status.code(), Some(0), "{name}: {}", String::from_utf8_lossy(&check.stdout));
    }
}

/// A target yield beside a `require` is tested by `--check` as well, and met.
#[test]
fn a_target_yield_beside_a_requirement_is_kept_too() {
    // The required sigma alone would allow three times as wide tolerances of a and b.
    let text = "[dimensions]\na = { nominal = 1, tolerance = 0.05 }\nb = { nominal = 0, tolerance = 0.05 }\n[characteristics]\n\
                y = { formula = \"a + b\", upper = 1.15, target_yield = 0.999, require = { sigma = 0.08 } }\n[costs]\n\
                a = { model = \"reciprocal\", b = 0.1 }\nb = { model = \"reciprocal\", b = 0.1 }\n";
    let study = read(text);
    let found = allocated(&study);
    assert!(is_done(found.status), "{:?}", found.status);
    assert_eq!(found.requirements.len(), 2);
    assert!(
        found.requirements.iter().all(|one| one.after.unwrap().verdict == Verdict::Met),
        "{:?}",
        found.requirements
    );
    assert!(keeps(&read(&study.rewritten(&found.problem).unwrap().text)));
    // 0.15 equals 3.0902 sigmas of a normal distribution: both half-widths are 3 (0.15/3.0902)/sqrt 2.
    let right = 2.0 * 0.1 / (3.0 * 0.15 / 3.090_232_306 / 2f64.sqrt());
    let cost = found.cost_after.unwrap();
    assert!(cost < 1.01 * right && cost > right * (1.0 - 1e-6), "{cost} for {right}");
}

/// A list of processes on both sides of the study's own tolerance. If no process keeps the limits for less, the study stays unchanged.
#[test]
fn a_start_that_nothing_undercuts_stays() {
    let text = "[dimensions]\na = { nominal = 0, tolerance = 0.05 }\n[characteristics]\n\
                y = { formula = \"a + 6*max(0, a - 0.051)\", upper = 0.052, require = \"worst-case\" }\n[costs]\n\
                a = { processes = [{ name = \"fine\", tolerance = 0.05, cost = 3.0 }, { name = \"rough\", tolerance = 0.08, cost = 1.0 }] }\n";
    let study = read(text);
    let found = allocated(&study);
    assert!(is_done(found.status), "{:?} {:?}", found.status, found.attainable);
    assert_eq!((found.cost_before, found.cost_after), (Some(3.0), Some(3.0)));
    assert!((found.problem.dimensions()[0].half_band() - 0.05).abs() < 1e-12);
}
