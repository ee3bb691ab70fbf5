//! Inspection with a gauge that errs: risks of consumer and producer.
//!
//! Oracles: tables of NCSLI RP-19 and Deaver as `tests/data/elements.json` has them, simulation of parts and readings, closed forms.

use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::analysis::{EstimatedShare, InspectionRisks};
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{Method, Options, analyze};
use serde_json::Value;
use statrs::distribution::{ContinuousCDF, Normal};

use super::command::{run, sensitol};
use sensitol_testing::{case, costly, faults, parse};

/// Returns a study of a normal part with this sigma about 0, with limits and inspection as written.
fn study(sigma: f64, rest: &str) -> String {
    format!(
        "[dimensions]\nx = {{ nominal = 0, tolerance = {} }}\n[characteristics]\ny = {{ formula = \"x\", {rest} }}\n",
        3.0 * sigma
    )
}

fn inspected(text: &str, options: &Options) -> InspectionRisks {
    let study = parse(text).unwrap_or_else(|error| panic!("{error}"));
    analyze(&study.problem, options).unwrap().characteristics.remove(0).distribution.inspection.unwrap()
}

fn value(of: Option<EstimatedShare>) -> f64 {
    of.unwrap().value
}

/// Twelve printed values, to the 1e-6 percent that the source states.
#[test]
fn tables_of_rp_19_are_reproduced() {
    let case = case("rp19");
    let shares = case["inputs"]["in-tolerance probability"].as_array().unwrap();
    let printed = |key: &str, row: usize| {
        let of = &case["printed"][key][row];
        (of["value"].as_f64().unwrap(), of["tolerance"].as_f64().unwrap())
    };
    for (row, share) in shares.iter().enumerate() {
        let sigma = 1.0 / Normal::standard().inverse_cdf(0.5 * (1.0 + share.as_f64().unwrap()));
        let text = study(sigma, &format!("lower = -1, upper = 1, gauge = {}", 0.25 * sigma));
        let found = inspected(&text, &Method::Full.into());
        for (found, key) in [(found.false_accept, "false accept %"), (found.bad_among_accepted, "of the accepted %")] {
            let (expected, tolerance) = printed(key, row);
            assert!((100.0 * value(found) - expected).abs() <= tolerance, "{found:?} for {expected}");
            // The formula proves its surface, whose distribution is exact.
            assert!(found.unwrap().error.unwrap() < 1e-9, "{found:?}");
        }
    }
}

#[test]
fn deavers_example_has_both_risks() {
    let case = case("deaver-7");
    let exact = |key: &str| case["exact"][key].as_f64().unwrap();
    let found = inspected(&study(4.0, "lower = -8, upper = 8, gauge = 1"), &Method::Full.into());
    // Integrals of both are computed to 1e-10.
    assert!((value(found.false_accept) - exact("false accept")).abs() < 1e-9);
    assert!((value(found.false_reject) - exact("false reject")).abs() < 1e-9);
    let accepted = 0.9544997361036416 - exact("false reject") + exact("false accept");
    assert!((value(found.accepted) - accepted).abs() < 1e-9);
    // A guard band that was solved for gives the same result if it is given.
    let solved = inspected(
        &study(4.0, "lower = -8, upper = 8, gauge = 1, guard = { false_accept = 0.001 }"),
        &Method::Full.into(),
    );
    let guard = solved.guard.unwrap();
    assert!((value(solved.false_accept) - 0.001).abs() < 1e-9);
    let given =
        inspected(&study(4.0, &format!("lower = -8, upper = 8, gauge = 1, guard = {guard}")), &Method::Full.into());
    assert_eq!((given.false_accept, given.false_reject), (solved.false_accept, solved.false_reject));
    assert_eq!(given.acceptance, [Some(-8.0 + guard), Some(8.0 - guard)]);
}

#[test]
fn a_perfect_gauge_makes_no_mistake() {
    let found = inspected(&study(1.0, "upper = 1, gauge = 0"), &Method::Full.into());
    assert_eq!((value(found.false_accept), value(found.false_reject)), (0.0, 0.0));
    assert_eq!(found.acceptance, [None, Some(1.0)]);
    // The guard band rejects parts between 0.5 and 1.
    let found = inspected(&study(1.0, "upper = 1, gauge = 0, guard = 0.5"), &Method::Full.into());
    let between = Normal::standard().cdf(1.0) - Normal::standard().cdf(0.5);
    assert!(value(found.false_accept) == 0.0 && (value(found.false_reject) - between).abs() < 1e-9);
    // A fixed part lies one sigma of the gauge below its limit: one reading of six rejects it.
    let fixed = "[dimensions]\nx = { nominal = 1 }\nw = { nominal = 0, tolerance = 1 }\n[characteristics]\ny = { formula = \"2*x\", upper = 2.1, gauge = 0.1 }\nz = { formula = \"w\" }\n";
    let found = inspected(fixed, &Method::Full.into());
    // statrs computes the tails to 1e-10.
    assert!((value(found.false_reject) - Normal::standard().cdf(-1.0)).abs() < 1e-9, "{found:?}");
}

/// Parts and readings drawn one by one, a million each, for a product of two inputs and for a clearance with a kink. The surface of the
/// clearance is not trusted, so the figures come from the model's sample. A costly model uses its check points.
#[test]
fn risks_are_those_of_parts_and_readings() {
    let two = "[dimensions]\na = { nominal = 0, tolerance = 3 }\nb = { nominal = 1, tolerance = 2, distribution = \"uniform\" }\n";
    let rest = "lower = -1.5, upper = 2, gauge = 0.3, guard = 0.1";
    type Part = fn(f64, f64) -> f64;
    let cases: [(&str, Part); 2] = [("a*b", |a, b| a * b), ("max(a, 2*b - 2)", |a, b| a.max(2.0 * b - 2.0))];
    for (formula, part) in cases {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
        let n = 1_000_000;
        let (mut accepted, mut rejected) = (0, 0);
        for _ in 0..n {
            let y = part(rng.sample(StandardNormal), -1.0 + 4.0 * rng.random::<f64>());
            let reading: f64 = y + 0.3 * rng.sample::<f64, _>(StandardNormal);
            let (good, passes) = ((-1.5..=2.0).contains(&y), (-1.4..=1.9).contains(&reading));
            accepted += usize::from(!good && passes);
            rejected += usize::from(good && !passes);
        }
        let text = format!("{two}[characteristics]\ny = {{ formula = \"{formula}\", {rest} }}\n");
        let study = parse(&text).unwrap();
        let (dear, _) = costly(&study.problem);
        let cheap = analyze(&study.problem, &Options::from(Method::Auto)).unwrap().characteristics.remove(0);
        let dear = analyze(&dear, &Options::from(Method::Full)).unwrap().characteristics.remove(0);
        for one in [cheap, dear] {
            let found = one.distribution.inspection.unwrap();
            for (found, count) in [(found.false_accept, accepted), (found.false_reject, rejected)] {
                let (truth, found) = (count as f64 / n as f64, found.unwrap());
                let scatter = (truth / n as f64).sqrt();
                // Three errors of the estimate, and three of a million draws.
                let error = found.error.unwrap();
                assert!((found.value - truth).abs() <= 3.0 * (error + scatter), "{formula}: {found:?} for {truth}");
            }
        }
    }
}

/// A normal part by quasi-random and by random points, against the integrals of its distribution: within three errors, which are small.
#[test]
fn samples_have_the_risks() {
    for (sampler, useful) in [(Sampler::Sobol, 0.02), (Sampler::Random, 0.1)] {
        // Limits at one sigma of the process, and at two.
        for (limit, gauge, process) in [(0.02, 0.005, 0.02), (8.0, 1.0, 4.0)] {
            let text = format!(
                "[dimensions]\nx = {{ nominal = 0, sigma = {process} }}\n[characteristics]\ny = {{ formula = \"x\", lower = -{limit}, upper = {limit}, gauge = {gauge}, guard = {} }}\n",
                0.1 * gauge
            );
            let exact = inspected(&text, &Method::Full.into());
            let options = SimulationOptions::default().with_samples(100_000).with_sampler(sampler);
            let found = simulate(&parse(&text).unwrap().problem, &options).unwrap().characteristics.remove(0);
            let found = found.inspection.unwrap();
            let shares = |of: &InspectionRisks| [of.false_accept, of.false_reject, of.accepted, of.bad_among_accepted];
            for (found, exact) in shares(&found).into_iter().zip(shares(&exact)) {
                let (found, exact) = (found.unwrap(), exact.unwrap().value);
                let error = found.error.unwrap();
                assert!((found.value - exact).abs() <= 3.0 * error && error < useful * exact, "{found:?} for {exact}");
            }
        }
    }
}

/// A solved guard band keeps the wanted share among the points of the sample. Points on a limit lie within it. A perfect gauge accepts no
/// bad part.
#[test]
fn samples_solve_for_a_guard() {
    let simulated = |text: &str| {
        let options = SimulationOptions::default().with_samples(20_000);
        simulate(&parse(text).unwrap().problem, &options).unwrap().characteristics.remove(0).inspection.unwrap()
    };
    let wanted = study(0.02, "lower = -0.03, upper = 0.03, gauge = 0.005, guard = { false_accept = 0.001 }");
    let (found, exact) = (simulated(&wanted), inspected(&wanted, &Method::Full.into()));
    assert!(value(found.false_accept) <= 0.001, "{found:?}");
    // Some hundred of 20,000 points are bad and near the limits.
    assert!((found.guard.unwrap() / exact.guard.unwrap() - 1.0).abs() < 0.05, "{found:?} {exact:?}");
    assert_eq!(
        simulated(&study(0.02, "lower = -1e-6, upper = 1e-6, gauge = 0.005, guard = { false_accept = 1e-9 }")).guard,
        None
    );
    let perfect = simulated(&study(0.02, "lower = -0.03, upper = 0.03, gauge = 0"));
    assert_eq!((value(perfect.false_accept), value(perfect.false_reject)), (0.0, 0.0));
    // Half of the values lie on the upper limit, where half of the readings pass.
    let two = "[dimensions]\nx = { nominal = 0, tolerance = 1, distribution = \"two-point\" }\n[characteristics]\ny = { formula = \"x\", upper = 1, gauge = 0.1 }\n";
    let found = simulated(two);
    assert_eq!(value(found.false_accept), 0.0);
    // The bin of the values is 1/1000 wide: 1/100 of the gauge's sigma.
    assert!((value(found.false_reject) - 0.25).abs() < 0.005, "{found:?}");
}

#[test]
fn an_inspection_stands_in_every_report() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gap.toml");
    std::fs::write(&path, study(0.02, "lower = -0.05, upper = 0.05, gauge = 0.005, guard = 0.01")).unwrap();
    let (path, csv) = (path.to_str().unwrap(), folder.path().join("csv"));
    let text = run(&["analyze", path, "--csv", csv.to_str().unwrap()]);
    assert!(text.contains("inspection with gauge sigma 0.005, guard 0.01: accepted -0.04 .. 0.04"), "{text}");
    assert!(text.contains("bad and accepted"), "{text}");
    let sampled = run(&["simulate", path, "--samples", "4096"]);
    assert!(sampled.contains("inspection with gauge sigma 0.005, guard 0.01: accepted -0.04 .. 0.04"), "{sampled}");
    let table = std::fs::read_to_string(csv.join("characteristics.csv")).unwrap();
    assert!(table.lines().next().unwrap().contains(",guard,false_accept,false_reject,"), "{table}");
    let output = sensitol(&["analyze", path, "--json"]).output().unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    let one = &report["characteristics"][0]["inspection"];
    assert_eq!((&one["gauge"], &one["guard"]), (&0.005.into(), &0.01.into()));
    assert!(one["false_accept"]["value"].as_f64().unwrap() > 0.0 && one["accepted"]["error"].is_f64());
    std::fs::write(path, study(0.02, "lower = -1e-6, upper = 1e-6, gauge = 0.005, guard = { false_accept = 1e-9 }"))
        .unwrap();
    let text = run(&["analyze", path]);
    assert!(text.contains("no guard band reaches the wanted share"), "{text}");
}

#[test]
fn impossible_inspections_are_refused() {
    let of = |rest: &str| study(0.02, rest);
    insta::assert_snapshot!(faults(&[
        &of("lower = 9.95, upper = 10.05, gauge = 0.015, guard = 0.06"),
        &of("upper = 1, gauge = -0.1"),
        &of("gauge = 0.1"),
        &of("gauge = 0.1, guard = 0.1"),
        &of("upper = 1, guard = 0.1"),
        &of("upper = 1, gauge = 0.1, guard = -0.1"),
        &of("upper = 1, gauge = 0.1, guard = { false_accept = 1 }"),
        &of("upper = 1, gauge = 0.1, guard = \"wide\""),
        &of("upper = 1, gauge = 0.1, guard = {}"),
        &of("upper = 1, gauge = 0.1, guard = { false_reject = 0.1 }"),
    ]));
}
