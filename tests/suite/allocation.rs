//! Tolerance allocation: against published optima, closed forms, enumeration, and the model itself.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::allocation::{
    Allocation, AllocationOptions, AllocationTask, Curve, Offer, Priced, Requirement, Status, allocate,
};
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Characteristic, Closure, Dimension, Method, Options, Problem, SpecLimits};

use super::support::{close, relative};

/// A linear characteristic of normal dimensions with these half bands.
fn linear(slopes: &[Vec<f64>], bands: &[f64], limits: &[[f64; 2]]) -> Problem {
    let dimensions: Vec<Dimension> =
        bands.iter().enumerate().map(|(d, &t)| Dimension::normal(format!("x{d}"), 0.0, t).unwrap()).collect();
    let names: Vec<String> = (0..slopes.len()).map(|k| format!("y{k}")).collect();
    let slopes = slopes.to_vec();
    let function = Closure::new(names.clone(), move |x, out| {
        for (out, slopes) in out.iter_mut().zip(&slopes) {
            *out = slopes.iter().zip(x).map(|(slope, x)| slope * x).sum();
        }
    });
    let asked = names.iter().zip(limits).map(|(name, &[lower, upper])| {
        Characteristic::new(name).with_limits(SpecLimits::new(Some(lower), Some(upper)).unwrap())
    });
    Problem::new(dimensions, function).unwrap().asking(asked).unwrap()
}

fn options(method: Method) -> AllocationOptions {
    AllocationOptions { analysis: Options::from(method), ..AllocationOptions::default() }
}

fn tolerance(found: &Allocation, d: usize) -> f64 {
    found.tolerances.iter().find(|one| one.dimension == d).unwrap().after
}

/// Chase and Greenwood's shaft and housing: gap = -A + B - C + D - E + F - G.
fn shaft_and_housing(requirement: Requirement) -> (Problem, AllocationTask) {
    let nominal = [0.0505, 8.0, 0.5093, 0.4, 7.711, 0.4, 0.5093];
    let bands = [0.0015, 0.008, 0.0025, 0.002, 0.006, 0.002, 0.0025];
    let dimensions: Vec<Dimension> = (0..7)
        .map(|d| Dimension::normal(["A", "B", "C", "D", "E", "F", "G"][d], nominal[d], bands[d]).unwrap())
        .collect();
    let gap = Closure::scalar("gap", |x| -x[0] + x[1] - x[2] + x[3] - x[4] + x[5] - x[6]);
    let middle: f64 = -nominal[0] + nominal[1] - nominal[2] + nominal[3] - nominal[4] + nominal[5] - nominal[6];
    let limits = SpecLimits::new(Some(middle - 0.015), Some(middle + 0.015)).unwrap();
    let problem =
        Problem::new(dimensions, gap).unwrap().asking([Characteristic::new("gap").with_limits(limits)]).unwrap();
    let offer = |b, k| vec![Offer::between(Curve::reciprocal_power(1.0, b, k).unwrap(), 1e-4, 0.05).unwrap()];
    let priced = vec![
        Priced::new(vec![1], offer(0.15997, 0.43899)).unwrap(),
        Priced::new(vec![3, 5], offer(0.07202, 0.46823)).unwrap(),
        Priced::new(vec![4], offer(0.12576, 0.46537)).unwrap(),
    ];
    (problem, AllocationTask { priced, requirements: vec![Some(requirement)] })
}

/// Published: Chase, Greenwood, Loosli, Hauglund (1990), as the project's notes on methods give it, tolerances to 1e-6, costs to 1e-3.
#[test]
fn the_shaft_and_the_housing_have_their_published_optima() {
    for (requirement, tolerances, cost) in [
        (Requirement::WorstCase, [0.002537, 0.001734, 0.002495], 11.078),
        (Requirement::Rss, [0.008114, 0.006382, 0.007934], 8.054),
    ] {
        let (problem, task) = shaft_and_housing(requirement);
        let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
        assert_eq!(found.status, Status::Optimal, "{found:#?}");
        // The printed digits and half of the last.
        for (d, expected) in [(1, tolerances[0]), (3, tolerances[1]), (4, tolerances[2]), (5, tolerances[1])] {
            close(tolerance(&found, d), expected, 0.0, 0.0 + 1.0);
            assert!((tolerance(&found, d) - expected).abs() < 0.51e-6, "{} {expected}", tolerance(&found, d));
        }
        close(found.cost_before.unwrap(), 9.336, 0.51e-3, 1.0 / 9.336);
        assert!((found.cost_before.unwrap() - 9.336).abs() < 0.51e-3, "{:?}", found.cost_before);
        assert!((found.cost_after.unwrap() - cost).abs() < 0.51e-3, "{:?}", found.cost_after);
        assert!(found.proof.residual.unwrap() < 1e-10);
    }
}
