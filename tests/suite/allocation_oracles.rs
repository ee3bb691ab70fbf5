//! Allocation against optima that were found without the engine: `tests/data/allocation.json`, with how beside each.

use sensitol::allocation::{Allocation, AllocationOptions, Status, allocate};
use sensitol::{Study, Verdict};
use serde_json::Value;
use statrs::distribution::{Continuous, ContinuousCDF, Normal};

use super::support::repository;

fn problem(name: &str) -> Value {
    let text = std::fs::read_to_string(repository("tests/data/allocation.json")).unwrap();
    let all: Value = serde_json::from_str(&text).unwrap();
    let found = all["problems"].as_array().unwrap().iter().find(|one| one["name"] == name);
    found.unwrap_or_else(|| panic!("no {name}")).clone()
}

fn allocated(of: &Value) -> Allocation {
    let study = Study::from_toml(of["study"].as_str().unwrap(), "study.toml").unwrap();
    let mut options = AllocationOptions::default().with_analysis(study.options.clone());
    if of["arguments"][0] == "--recentre" {
        options = options.with_recentre(vec![of["arguments"][1].as_str().unwrap().to_owned()]);
    }
    allocate(&study.problem, &study.allocation_task(), &options).unwrap()
}

fn band(found: &Allocation, name: &str) -> f64 {
    let all = found.problem.dimensions();
    all.iter().find(|dimension| dimension.name() == name).unwrap().half_band()
}

fn all_met(found: &Allocation) -> bool {
    found.requirements.iter().all(|one| one.after.unwrap().verdict == Verdict::Met)
}

/// What is called optimal is: costs to 1e-6, of which the search itself keeps 1e-7 (tolerances are kept on the good side by 1e-9, and the
/// enclosure of a worst case is a thousandth of a sigma wide at most), and the oracles 1e-8.
#[test]
fn what_is_called_optimal_is() {
    for name in [
        "lever-turning",
        "squares-help",
        "two-uniforms",
        "parabola-and-normal",
        "two-temperatures",
        "twins",
        "list-12x4",
        "grades-of-size",
    ] {
        let of = problem(name);
        let (found, expected) = (allocated(&of), of["optimum"]["cost"].as_f64().unwrap());
        let cost = found.cost_after.unwrap();
        assert_eq!(found.status, Status::Optimal, "{name}: {cost}, {:?}", found.proof);
        assert!((cost / expected - 1.0).abs() < 1e-6, "{name}: {cost} for {expected}");
        assert!(all_met(&found), "{name}: {:?}", found.requirements);
    }
    assert_eq!(allocated(&problem("too-tight")).status, Status::Infeasible);
}

/// A tilt about 0 has no slope there and moves the play by its curvature alone: at both of its ends, where `1 - cos` is greatest, and in its
/// middle. The extremes are those of the closed form.
#[test]
fn a_tilt_without_a_slope_keeps_the_worst_case() {
    let found = allocated(&problem("lever-turning"));
    let [wall, arm, tilt] = ["wall", "arm", "tilt"].map(|name| band(&found, name));
    let greatest = 80.15 + wall - (80.0 - arm) * tilt.to_radians().cos();
    let least = 80.15 - wall - (80.0 + arm);
    assert!(least >= 0.02 - 1e-6 && greatest <= 0.3 + 1e-6, "{least} {greatest}");
}

/// At the means of two offsets the distance is a kink, which no parabola describes: the true worst case is kept all the same, and what is found
/// is no optimum and not called one.
#[test]
fn a_kink_at_the_means_keeps_the_worst_case() {
    let of = problem("pin-about-centre");
    let found = allocated(&of);
    let [hole, pin, x, y] = ["hole", "pin", "px", "py"].map(|name| band(&found, name));
    let used = hole + pin + 2.0 * x.hypot(y);
    assert!(used <= 0.2 * (1.0 + 1e-6), "{used}");
    assert!(found.cost_after.unwrap() >= of["optimum"]["cost"].as_f64().unwrap() * (1.0 - 1e-6));
    assert_ne!(found.status, Status::Optimal);
    assert!(all_met(&found), "{:?}", found.requirements);
}

/// The smaller of two gaps: a parabola through a kink gives another sigma and other slopes than the model has. With samples of the model
/// the cost comes within 0.2 % of the optimum: sigma is required of the upper end of its interval, 1e-3 of it, and slopes are known to 1e-3.
/// The true sigma is that of C. E. Clark, Operations Research 9 (1961).
#[test]
fn a_kink_is_allocated_by_the_model() {
    let of = problem("smaller-gap-shared");
    let found = allocated(&of);
    let expected = of["optimum"]["cost"].as_f64().unwrap();
    let cost = found.cost_after.unwrap();
    assert!(cost > expected * (1.0 - 1e-6) && cost < 1.002 * expected, "{cost} for {expected}");
    let [a, w, b] = ["a", "w", "b"].map(|name| band(&found, name) / 3.0);
    let sigma = of_smaller([0.5, 0.55], [a * a + w * w, b * b + w * w], w * w);
    assert!(sigma <= 0.03 && sigma > 0.03 * 0.998, "{sigma}");
    assert!(all_met(&found), "{:?}", found.requirements);
    // Slopes from samples prove nothing within rounding.
    assert_eq!(found.status, Status::AlmostOptimal);
}

/// Sigma of the smaller of two correlated normal variables.
fn of_smaller(means: [f64; 2], variances: [f64; 2], covariance: f64) -> f64 {
    let normal = Normal::new(0.0, 1.0).unwrap();
    let a = (variances[0] + variances[1] - 2.0 * covariance).sqrt();
    let alpha = (means[1] - means[0]) / a;
    let (p, density) = (normal.cdf(alpha), normal.pdf(alpha));
    let first = means[0] * p + means[1] * (1.0 - p) - a * density;
    let square = |i: usize| means[i] * means[i] + variances[i];
    let second = square(0) * p + square(1) * (1.0 - p) - (means[0] + means[1]) * a * density;
    (second - first * first).sqrt()
}

/// A search that ends at tolerances that miss a requirement does not call them anything else: neither optimal nor almost, nor proven impossible.
#[test]
fn a_search_that_ends_beside_the_requirements_says_so() {
    let found = allocated(&problem("move-the-shoulder"));
    let missed = found.requirements.iter().any(|one| one.after.is_some_and(|after| after.verdict == Verdict::Missed));
    assert_eq!(missed, found.status == Status::NoFeasiblePointFound, "{:?} {:?}", found.status, found.requirements);
    assert_ne!(found.status, Status::Infeasible);
}
