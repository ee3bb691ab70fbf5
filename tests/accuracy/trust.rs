//! Coverage of the error estimates: three times the estimate should reach the true error of every printed figure. The functions have kinks,
//! jumps, edges, rare events, heavy tails and correlation. `docs/accuracy.md` shows the same numbers.

use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};

use rayon::prelude::*;
use sensitol::analysis::{Crossing, VerificationKind, Verified};
use sensitol::assembly::Run;
use sensitol::correlation::Pair;
use sensitol::evaluation::Evaluator;

use sensitol::method::registry::procedure;
use sensitol::verification::{
    SampledFigures, Target, check_points, variance_shares, verify_by_checks, verify_by_sampling,
};
use sensitol::{
    Characteristic, Closure, Dimension, Method, Options, Problem, SpecLimits, StopReason, Verdict, analyze,
    analyze_with,
};
use sensitol_study::Study;
use sensitol_testing::{costly, counted, repository};
use serde_json::{Value, json};

/// Smallest relevant errors of mean and sigma (in sigmas), skewness, kurtosis, a share of the tails, and a central share. The references
/// were computed for these thresholds of the design.
const FELT: [f64; 6] = [1e-4, 1e-4, 1e-3, 0.01, 2e-6, 1e-4];
/// Names of the figures in the reference; `mid` is a central share.
const FIGURES: [&str; 6] = ["mean", "sigma", "skewness", "kurtosis", "yield", "mid"];

/// Test function with its reference values.
pub(super) struct Truth {
    pub(super) name: String,
    pub(super) study: Study,
    /// Value and uncertainty of each of [`FIGURES`].
    pub(super) figures: [(f64, f64); 6],
    valid: f64,
}

pub(super) fn truths() -> Vec<Truth> {
    let text = std::fs::read_to_string(repository("tests/data/trust.jsonl")).unwrap();
    text.lines().map(|line| truth(&serde_json::from_str(line).unwrap())).collect()
}

fn truth(entry: &Value) -> Truth {
    let pairs: Vec<Value> = (entry["correlation"].as_array().unwrap().iter())
        .map(|pair| json!({ "between": [pair[0], pair[1]], "value": pair[2] }))
        .collect();
    let formula = &entry["formula"];
    let reference = &entry["reference"];
    let study = json!({
        "dimensions": entry["dimensions"],
        "correlation": pairs,
        "characteristics": {
            "y of it": { "formula": formula, "lower": entry["lower"], "upper": entry["upper"] },
            "z of it": { "formula": formula, "upper": reference["mid"]["upper"] },
        },
    });
    let name = entry["name"].as_str().unwrap().to_owned();
    let study = Study::from_json(&study.to_string(), &name).unwrap_or_else(|error| panic!("{name}: {error}"));
    let figure = |of: &Value| (of["value"].as_f64().unwrap(), of["uncertainty"].as_f64().unwrap());
    let of = |name: &str| figure(if name == "mid" { &reference["mid"]["yield"] } else { &reference[name] });
    Truth { study, figures: FIGURES.map(of), valid: entry["valid_share"].as_f64().unwrap(), name }
}

impl Truth {
    /// Returns the ratio of the error to the allowed one, which is at most 1 for a covered error.
    pub(super) fn excess(&self, figure: usize, found: Verified) -> f64 {
        let felt = FELT[figure] * if figure < 2 { self.figures[1].0 } else { 1.0 };
        (self.off(figure, found.value) - felt).max(0.0) / (3.0 * found.error + 3.0 * self.figures[figure].1)
    }

    /// Returns the absolute error of a figure.
    pub(super) fn off(&self, figure: usize, value: f64) -> f64 {
        (value - self.figures[figure].0).abs()
    }
}

fn figures(found: &[SampledFigures]) -> [Option<Verified>; 6] {
    let [one, middle] = [&found[0], &found[1]];
    [one.mean, one.sigma, one.skewness, one.kurtosis, one.yield_, middle.yield_]
}

/// A cheap model is sampled: all 390 figures are covered, and the errors are small enough to be useful.
#[test]
fn a_sample_of_a_cheap_model_covers_every_figure() {
    let truths = truths();
    let of = |truth: &Truth| {
        let found = verify_by_sampling(&truth.study.problem, 1);
        let lost = (found[0].valid.value - truth.valid).abs();
        // The reference of this share has five digits at least.
        assert!(lost <= 3.0 * found[0].valid.error + 1e-5, "{}: {:?} for {}", truth.name, found[0].valid, truth.valid);
        let figures = figures(&found).map(|figure| figure.unwrap_or_else(|| panic!("{}: no figure", truth.name)));
        (figures[1].error / figures[1].value, figures)
    };
    let found: Vec<_> = truths.par_iter().map(of).collect();
    let mut wrong = Vec::new();
    for (truth, (_, figures)) in truths.iter().zip(&found) {
        for (figure, name) in FIGURES.iter().enumerate() {
            let excess = truth.excess(figure, figures[figure]);
            if excess > 1.0 {
                wrong.push(format!(
                    "{} {name}: {:?} for {:?}: {excess:.2}",
                    truth.name, figures[figure], truth.figures[figure]
                ));
            }
        }
    }
    assert!(wrong.is_empty(), "not covered: {wrong:#?}");
    let mut errors: Vec<f64> = found.iter().map(|(error, _)| *error).collect();
    errors.sort_by(f64::total_cmp);
    // The design measured 4.2e-4 in the median of 88 characteristics.
    assert!(errors[errors.len() / 2] < 1e-3, "sigma is known to {} of it", errors[errors.len() / 2]);
}

/// A costly model is checked: surfaces of three methods at their check points, two seeds each. The design measured 98.3 % of 3584 figures,
/// including functions with a switch that so few points cannot find.
#[test]
fn a_dozen_points_cover_the_figures_of_a_surface() {
    let truths = truths();
    let methods = [Method::SecondOrder, Method::SixN, Method::Full];
    let of = |truth: &Truth| -> Vec<(String, f64)> {
        let mut excesses = Vec::new();
        for method in methods {
            let problem = &truth.study.problem;
            let outcome = procedure(method).run(problem, &Options::from(method), &Run::to_the_end()).unwrap();
            let contributions: Vec<_> = (outcome.fitted.iter())
                .map(|fitted| fitted.surrogate.as_ref()?.contributions(outcome.plan.inputs()))
                .collect();
            let Some(contributions) = contributions.into_iter().collect::<Option<Vec<_>>>() else { continue };
            let shares: Vec<Vec<f64>> = (contributions.iter())
                .map(|one| one.linear.iter().zip(&one.curvature).map(|(linear, curved)| linear + curved).collect())
                .collect();
            let targets: Vec<Target<'_>> = (outcome.fitted.iter().zip(&shares))
                .map(|(fitted, shares)| Target { surrogate: fitted.surrogate.as_ref(), shares, nodes: &[] })
                .collect();
            for seed in [1, 2] {
                let run = Run::to_the_end();
                let varying = outcome.plan.varying();
                let found = verify_by_checks(
                    &Evaluator::new(problem, &run).with_seed(seed),
                    varying,
                    &targets,
                    check_points(None, varying.len()),
                )
                .unwrap();
                assert!((12..=12 + 18 + 8).contains(&found.count), "{}: {} points", truth.name, found.count);
                let [one, middle] = [&found.characteristics[0], &found.characteristics[1]];
                let Some(errors) = one.errors else { continue };
                let moments = contributions[0].moments;
                let values =
                    [moments.mean(), moments.sigma(), moments.skewness().unwrap(), moments.kurtosis().unwrap()];
                let figures = values.into_iter().zip(errors).map(|(value, error)| Verified { value, error });
                let figures = figures.chain([one.yield_.unwrap(), middle.yield_.unwrap()]);
                for (figure, found) in figures.enumerate() {
                    let excess = truth.excess(figure, found);
                    excesses.push((format!("{} {} {} {seed}", truth.name, method.name(), FIGURES[figure]), excess));
                }
            }
        }
        excesses
    };
    let found: Vec<(String, f64)> = truths.par_iter().flat_map_iter(of).collect();
    let wrong: Vec<&(String, f64)> = found.iter().filter(|(_, excess)| *excess > 1.0).collect();
    let covered = 1.0 - wrong.len() as f64 / found.len() as f64;
    assert!(
        covered >= 0.97,
        "{} of {} figures covered, {covered:.4}: {wrong:#?}",
        found.len() - wrong.len(),
        found.len()
    );
}

/// Switches that 65 536 plain points cross once or never are found by their margins, with their probability by the normal distribution: the
/// cut of atan2 4.2 sigma off, a step at 3.9 and a contact at 3.8 sigma.
#[test]
fn seldom_switches_are_found_and_named() {
    let expected = [
        ("wrap-far", "`atan2(q, p)`", Crossing::Jump, 1.335e-5),
        ("step-rare", "`b > 3.9`", Crossing::Jump, 4.810e-5),
        ("max-rare", "`max(0, b - 3.8)`", Crossing::Kink, 7.235e-5),
        ("max-far", "`max(a, b + 4)`", Crossing::Kink, 2.339e-3), // Phi(-4/sqrt 2)
        ("edge-sqrt", "`sqrt(a - b)`", Crossing::Edge, 0.012674), // Phi(-1/sqrt 0.2)
    ];
    let truths = truths();
    for (name, text, crossing, probability) in expected {
        let truth = truths.iter().find(|truth| truth.name == name).unwrap();
        let found = &verify_by_sampling(&truth.study.problem, 1)[0];
        let switches = found.switches.as_ref().unwrap();
        let [switch] = &switches[..] else { panic!("{name}: {switches:?}") };
        assert_eq!((switch.switch.name("y of it").as_str(), switch.crossing), (text, crossing), "{name}");
        // The share comes from 4096 points in the half-space of a rare side, or from 2048 plain ones for a side that is not rare.
        let tolerance = if probability < 0.004 { 0.02 } else { 0.2 };
        assert!((switch.probability / probability - 1.0).abs() < tolerance, "{name}: {}", switch.probability);
    }
}

/// A smooth function has no switch, and one that is never crossed causes no warning.
#[test]
fn smooth_formulas_have_no_switches() {
    let smooth = [
        "linear-five",
        "ratio-tame",
        "exp-steep",
        "triple",
        "belt",
        "spring",
        "lens",
        "bridge",
        "crank",
        "norm-ten",
        "sine-two",
    ];
    for truth in truths().iter().filter(|truth| smooth.contains(&truth.name.as_str())) {
        let found = &verify_by_sampling(&truth.study.problem, 1)[0];
        assert_eq!(found.switches.as_deref(), Some(&[][..]), "{}", truth.name);
        assert!(found.switches_complete);
    }
}

/// A function has no moments if a divisor changes its sign within reach. A squared divisor does not even change its sign.
#[test]
fn a_divisor_through_zero_is_a_pole() {
    for formula in ["a/b", "1/(b*b)", "b^-2 + a", "tan(b + a/10)"] {
        let study = serde_json::json!({
            "dimensions": { "a": { "nominal": 1, "sigma": 0.1 }, "b": { "nominal": 0.5, "sigma": 0.2 } },
            "characteristics": { "y": { "formula": formula } },
        });
        let study = Study::from_json(&study.to_string(), "pole").unwrap();
        let found = &verify_by_sampling(&study.problem, 1)[0];
        let crossings: Vec<_> = found.switches.iter().flatten().map(|switch| switch.crossing).collect();
        assert_eq!(crossings, [Crossing::Pole], "{formula}");
    }
}

/// The numbers depend on problem and seed alone.
#[test]
fn samples_and_checks_do_not_depend_on_the_number_of_threads() {
    let truths = truths();
    let truth = truths.iter().find(|truth| truth.name == "kink-chain").unwrap();
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| (verify_by_sampling(&truth.study.problem, 3), variance_shares(&truth.study.problem, 0, 3)))
    };
    assert_eq!(with(1), with(3));
}

/// Estimates have the unit of their figure: a characteristic a thousand times as large has errors a thousand times as large.
#[test]
fn estimates_scale_with_the_unit() {
    let of = |factor: f64| {
        let dimensions = [Dimension::normal("a", 1.0, 0.9).unwrap(), Dimension::uniform("b", 2.0, 0.5).unwrap()];
        let function = Closure::scalar("y", move |x| factor * (x[0] * x[1]).max(1.5));
        verify_by_sampling(&Problem::new(dimensions, function).unwrap(), 1).swap_remove(0)
    };
    // A power of two changes no digit.
    let (one, other) = (of(1.0), of(1024.0));
    let scaled = |of: Option<Verified>, by: f64| of.map(|of| Verified { value: by * of.value, error: by * of.error });
    assert_eq!(scaled(one.mean, 1024.0), other.mean);
    assert_eq!(scaled(one.sigma, 1024.0), other.sigma);
    assert_eq!((one.skewness, one.kurtosis), (other.skewness, other.kurtosis));
}

/// Shares of the variance against closed forms: Ishigami's function (Ishigami and Homma 1990) with a = 7 and b = 0.1, whose variance is
/// 1/2 + a^2/8 + b pi^4/5 + b^2 pi^8/18, and Sobol's g function (1993) with a = 0, 1, 4.5, 9.
#[test]
fn shares_of_the_variance_have_their_closed_forms() {
    use std::f64::consts::PI;
    let (a, b) = (7.0, 0.1);
    let parts = [0.5 * (1.0 + b * PI.powi(4) / 5.0).powi(2), a * a / 8.0, 0.0];
    let together = b * b * PI.powi(8) * (1.0 / 18.0 - 1.0 / 50.0);
    let variance = parts.iter().sum::<f64>() + together;
    let ishigami: Vec<[f64; 2]> = [[parts[0], parts[0] + together], [parts[1], parts[1]], [0.0, together]]
        .iter()
        .map(|of| of.map(|v| v / variance))
        .collect();
    let of_g: Vec<f64> = [0.0f64, 1.0, 4.5, 9.0].iter().map(|a| 1.0 / (3.0 * (1.0 + a).powi(2))).collect();
    let whole: f64 = of_g.iter().map(|v| 1.0 + v).product::<f64>() - 1.0;
    let g: Vec<[f64; 2]> = (0..4)
        .map(|j| {
            let others: f64 = (0..4).filter(|&k| k != j).map(|k| 1.0 + of_g[k]).product();
            [of_g[j] / whole, of_g[j] * others / whole]
        })
        .collect();
    let uniform = |n: usize, half: f64| -> Vec<Dimension> {
        (0..n).map(|j| Dimension::uniform(format!("x{j}"), 0.0, half).unwrap()).collect()
    };
    let first = Closure::scalar("y", move |x| x[0].sin() + a * x[1].sin().powi(2) + b * x[2].powi(4) * x[0].sin());
    let second = Closure::scalar("y", |x| {
        [0.0, 1.0, 4.5, 9.0].iter().zip(x).map(|(a, x)| ((4.0 * (x + 0.5) - 2.0).abs() + a) / (1.0 + a)).product()
    });
    let cases =
        [(Problem::new(uniform(3, PI), first).unwrap(), ishigami), (Problem::new(uniform(4, 0.5), second).unwrap(), g)];
    for (problem, expected) in cases {
        let found = variance_shares(&problem, 0, 1).unwrap();
        for ((_, found), expected) in found.iter().zip(&expected) {
            for (found, expected) in found.iter().zip(expected) {
                let off = (found.value - expected).abs();
                // The design's largest error of 312 shares was 0.026. The tolerance is 1e-9 for a share of 0.
                assert!(off <= 3.0 * found.error + 1e-9 && off < 0.026, "{found:?} for {expected}");
            }
        }
    }
}

pub(super) fn verified(method: Method, points: usize) -> Options {
    Options::from(method).with_verify(points)
}

fn study(dimensions: Value, formula: &str) -> Study {
    let study = json!({ "dimensions": dimensions, "characteristics": { "y": { "formula": formula } } });
    Study::from_json(&study.to_string(), "test").unwrap()
}

/// Every figure of every method has an error estimate that covers the true error, even if its surface is useless.
#[test]
fn three_estimates_of_any_method_reach_the_truth() {
    let names =
        ["random-direction", "hypot-zero", "max-off", "wrap-far", "exp-steep", "ratio-wild", "edge-sqrt", "random-9"];
    let methods =
        [Method::Rss, Method::SecondOrder, Method::SixN, Method::Full, Method::DimensionReduction, Method::Auto];
    let truths: Vec<Truth> = truths().into_iter().filter(|truth| names.contains(&truth.name.as_str())).collect();
    truths.par_iter().flat_map_iter(|truth| methods.map(|method| (truth, method))).for_each(|(truth, method)| {
        let found = analyze(&truth.study.problem, &verified(method, 18)).unwrap();
        let one = &found.characteristics[0];
        let Some(moments) = one.moments else { return };
        let estimate = one.error_estimate.as_ref().unwrap();
        let values = [Some(moments.mean()), Some(moments.sigma()), moments.skewness(), moments.kurtosis()];
        let errors = [estimate.mean, estimate.sigma, estimate.skewness, estimate.kurtosis];
        for (figure, (value, error)) in values.into_iter().zip(errors).enumerate() {
            let Some(value) = value else { continue };
            let error = error.unwrap_or_else(|| panic!("{} {}: no error", truth.name, method.name()));
            let excess = truth.excess(figure, Verified { value, error });
            assert!(excess <= 1.0, "{} {} {}: {value} {error}", truth.name, method.name(), FIGURES[figure]);
        }
    });
}

/// `full` on an angle through a full turn has an error of 22 %, which its own estimate states. The model contradicts the figure, and `auto`
/// takes the model's figure.
#[test]
fn a_figure_that_the_model_contradicts_is_named_or_replaced() {
    let truths = truths();
    let truth = truths.iter().find(|truth| truth.name == "random-direction").unwrap();
    let full = analyze(&truth.study.problem, &verified(Method::Full, 18)).unwrap();
    assert!(full.warnings.iter().any(|warning| warning.code() == "figure-off"), "{:?}", full.warnings);
    let auto = analyze(&truth.study.problem, &verified(Method::Auto, 18)).unwrap();
    assert!(auto.warnings.iter().all(|warning| warning.code() != "figure-off"), "{:?}", auto.warnings);
    let sigma = auto.characteristics[0].moments.unwrap().sigma();
    // The error of the sample itself is a thousandth.
    assert!((sigma / truth.figures[1].0 - 1.0).abs() < 3e-3, "{sigma}");
}

/// Only the degree of a formula proves a surface. The errors are then roundings, and nothing is sampled.
#[test]
fn a_polynomial_that_the_surface_holds_is_exact() {
    let dimensions = json!({ "a": { "nominal": 10, "sigma": 0.1 }, "b": { "nominal": 5, "tolerance": 0.2, "distribution": "uniform" } });
    let cases = [
        ("2*a - b/4 + 3", Method::Rss, Some(1)),
        ("2*a - b/4 + 3", Method::SecondOrder, Some(1)),
        ("a*b + (a - 1)^2", Method::Full, Some(2)),
        ("a*b + (a - 1)^2", Method::SecondOrder, None), // without the interaction
        ("a*b + (a - 1)^2", Method::Rss, None),
        ("a*b^2", Method::Full, None),
        ("a + 0*abs(b)", Method::Full, None),
    ];
    for (formula, method, degree) in cases {
        let found = analyze(&study(dimensions.clone(), formula).problem, &verified(method, 18)).unwrap();
        let one = &found.characteristics[0];
        let verification = one.evidence.verification.as_ref().unwrap();
        let kind = verification.kind;
        let error = one.error_estimate.as_ref().unwrap().sigma.unwrap() / one.moments.unwrap().sigma();
        match degree {
            Some(degree) => {
                assert_eq!((kind, verification.degree), (VerificationKind::Exact, Some(degree)), "{formula}");
                assert!(error > 0.0 && error < 1e-12, "{formula}: {error}");
            }
            None => {
                assert_eq!(kind, VerificationKind::Sample, "{formula} {}", method.name());
                assert!(error > 1e-6, "{formula}: {error}");
            }
        }
    }
}

/// A costly model gets the check points of its plan, none if verification is off, as many as asked for by number, and no more than its
/// budget.
#[test]
fn checks_cost_as_many_evaluations_as_stated() {
    let study = study(
        json!({ "a": { "nominal": 1, "sigma": 0.1 }, "b": { "nominal": 2, "sigma": 0.3 }, "c": { "nominal": 0, "sigma": 1 } }),
        "a*exp(b/4) + 0.1*sin(c)",
    );
    let run = |options: &Options| {
        let (problem, asked) = costly(&study.problem);
        let found = analyze(&problem, options).unwrap();
        assert_eq!(found.run.evaluations as usize, asked.load(Ordering::Relaxed));
        found
    };
    let plain = run(&Method::Full.into());
    let off = run(&verified(Method::Full, 0));
    // N^2 + N + 1, and the check points: 12 near the means and 6 where decisions fall. A parabola is no sine at three sigmas, so that two
    // residuals are located by four points more each.
    assert_eq!((plain.run.evaluations, off.run.evaluations), (13 + check_points(None, 3) as u64 + 8, 13));
    assert!(off.characteristics[0].evidence.verification.is_none());
    let checked = run(&verified(Method::Full, 18));
    let more = checked.run.evaluations - 13;
    assert!((12..=18).contains(&more), "{more}");
    let verification = checked.characteristics[0].evidence.verification.as_ref().unwrap();
    assert_eq!((verification.kind, verification.points as u64), (VerificationKind::Checks, more));
    // 1 - 0.05^(1/n)
    assert!((verification.unseen.unwrap() - (1.0 - 0.05f64.powf(1.0 / more as f64))).abs() < 1e-12);
    let [error, truth] = [checked.characteristics[0].error_estimate.as_ref().unwrap().sigma.unwrap(), {
        let sampled = verify_by_sampling(&study.problem, 1)[0].sigma.unwrap();
        (checked.characteristics[0].moments.unwrap().sigma() - sampled.value).abs() - 3.0 * sampled.error
    }];
    assert!(3.0 * error >= truth, "{error} for {truth}");
    let budget = run(&verified(Method::Full, 18).with_budget(20));
    assert!(budget.run.evaluations <= 20);
}

/// Methods that integrate have no surface, so that check points judge the one through their points. Errors cover the true ones, and are
/// small if the method is right.
///
/// With `r` the correlation of two standard normal inputs, `a + b + a b` has mean `r` and variance `2 + 2 r + 1 + r^2` (Isserlis 1918).
#[test]
fn methods_that_integrate_are_verified_at_check_points() {
    let dimensions = json!({ "a": { "nominal": 0, "sigma": 1 }, "b": { "nominal": 0, "sigma": 1 } });
    let (cuts, planes, grid) = (Method::DimensionReduction, Method::BivariateDimensionReduction, Method::ThreePoint);
    for r in [0.0, 0.6] {
        for method in [cuts, planes, grid] {
            let formula = study(dimensions.clone(), "a + b + a*b").problem;
            let formula = match r {
                0.0 => formula,
                r => formula.correlated(&[Pair { between: ["a".into(), "b".into()], value: r }]).unwrap(),
            };
            let (problem, asked) = costly(&formula);
            let found = analyze(&problem, &verified(method, 18)).unwrap();
            assert_eq!(found.run.evaluations as usize, asked.load(Ordering::Relaxed));
            let one = &found.characteristics[0];
            assert_eq!(one.evidence.verification.as_ref().unwrap().kind, VerificationKind::Checks);
            let (moments, estimate) = (one.moments.unwrap(), one.error_estimate.as_ref().unwrap());
            let (mean, sigma) = (r, (3.0 + 2.0 * r + r * r).sqrt());
            let (off_mean, off_sigma) = ((moments.mean() - mean).abs(), (moments.sigma() - sigma).abs());
            let (of_mean, of_sigma) = (estimate.mean.unwrap(), estimate.sigma.unwrap());
            let name = method.name();
            assert!(3.0 * of_mean >= off_mean, "{name} {r}: {of_mean} for {off_mean}");
            assert!(3.0 * of_sigma >= off_sigma, "{name} {r}: {of_sigma} for {off_sigma}");
            // Along eigenvectors `a b` is a difference of squares, so that cuts show all of it: the smallest error of a dozen points is
            // 0.004 sigma.
            let blind = method == cuts && r == 0.0;
            assert_eq!(of_sigma > 0.01 * sigma, blind, "{name} {r}: {of_sigma}");
            assert!(estimate.skewness.is_some() && estimate.kurtosis.is_some(), "{name} {r}");
        }
    }
}

/// The switch of a formula causes a warning with its probability.
#[test]
fn a_seldom_switch_is_warned_of() {
    let truths = truths();
    let truth = truths.iter().find(|truth| truth.name == "wrap-far").unwrap();
    let found = analyze(&truth.study.problem, &verified(Method::Full, 18)).unwrap();
    let warning = found.warnings.iter().find(|warning| warning.code() == "switch").unwrap().message();
    assert!(warning.contains("`atan2(q, p)`") && warning.contains("13 ppm"), "{warning}");
}

/// The answers of a formula next to the means do not scatter, even at a kink or a root.
#[test]
fn an_exact_formula_does_not_scatter() {
    let dimensions = || json!({ "a": { "nominal": 0, "sigma": 0.1 }, "b": { "nominal": 0, "sigma": 0.2 } });
    for formula in ["abs(a) + b", "hypot(a, b)", "max(a, b)"] {
        let found = analyze(&study(dimensions(), formula).problem, &Method::Auto.into()).unwrap();
        let codes: Vec<_> = found.warnings.iter().map(|warning| warning.code()).collect();
        assert!(!codes.contains(&"scatter"), "{formula}: {codes:?}");
    }
}

/// A sample ends with the time limit of a run. The method's figures remain, without verification and without a verdict.
#[test]
fn a_sample_ends_with_the_time() {
    let asked = Arc::new(AtomicUsize::new(0));
    let counted = Arc::clone(&asked);
    let dimensions = [Dimension::normal("a", 1.0, 0.3).unwrap(), Dimension::normal("b", 0.0, 0.6).unwrap()];
    let function = Closure::scalar("y", move |x| {
        counted.fetch_add(1, Ordering::Relaxed);
        x[0] * x[1].exp()
    });
    let wanted = Characteristic::new("y")
        .with_limits(SpecLimits::new(Some(0.0), Some(9.0)).unwrap())
        .with_target_yield(0.5)
        .unwrap();
    let problem = Problem::new(dimensions, function).unwrap().asking([wanted]).unwrap();
    // With one thread it is at one part of 2048 points when the time is over, and a whole sample has 42 000.
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let analyzed = |most: usize| {
        asked.store(0, Ordering::Relaxed);
        let stop = || (asked.load(Ordering::Relaxed) > most).then_some(StopReason::TimeLimit);
        let run = Run::to_the_end().stopping_when(&stop);
        pool.install(|| analyze_with(&problem, &verified(Method::SecondOrder, 18), &run)).unwrap()
    };
    for most in [10, 3000, 20_000] {
        let found = analyzed(most);
        let one = &found.characteristics[0];
        assert_eq!(found.run.stopped, Some(StopReason::TimeLimit), "{most}");
        assert!(one.moments.is_some() && one.evidence.verification.is_none(), "{most}");
        assert!(one.requirements().iter().all(|judged| judged.verdict != Verdict::Met), "{most}");
        assert!(asked.load(Ordering::Relaxed) <= most + 4096, "{most}: {}", asked.load(Ordering::Relaxed));
    }
    let found = analyzed(usize::MAX);
    assert!(found.run.stopped.is_none() && found.characteristics[0].evidence.verification.is_some());
    assert!(found.characteristics[0].requirements().iter().all(|judged| judged.verdict == Verdict::Met));
}

/// A budget counts every evaluation of a cheap model, including those of its verification. If it is too small for a sample, check points
/// are used.
#[test]
fn a_budget_holds_what_verifies_a_cheap_model() {
    let dimensions = json!({ "a": { "nominal": 1.0, "tolerance": 0.3 }, "b": { "nominal": 2.0, "tolerance": 0.6 } });
    // The surface leaves variance unexplained, so that shares are computed if the budget allows it.
    let study = study(dimensions, "a*b + 0.4*sin(9*a)*b");
    for (budget, kind) in [
        (40, VerificationKind::Checks),
        (5_000, VerificationKind::Checks),
        (70_000, VerificationKind::Sample),
        (300_000, VerificationKind::Sample),
    ] {
        for method in [Method::Full, Method::Auto] {
            let (problem, asked) = counted(&study.problem, false);
            let found = analyze(&problem, &Options::from(method).with_budget(budget)).unwrap();
            let asked = asked.load(Ordering::Relaxed);
            assert!(asked <= budget, "{}: {asked} of {budget}", method.name());
            let verified = found.characteristics[0].evidence.verification.as_ref();
            assert!(verified.is_none_or(|verified| verified.kind == kind), "{budget}: {verified:?}");
            assert!(verified.is_some() || method == Method::Auto, "{budget}");
            assert!(found.characteristics[0].error_estimate.as_ref().unwrap().sigma.is_some(), "{budget}");
        }
    }
}
