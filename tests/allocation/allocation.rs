//! Tolerance allocation: against published optima, closed forms, enumeration, and the model itself.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use rayon::prelude::*;
use sensitol::allocation::{
    Allocation, AllocationOptions, AllocationTask, Curve, Kept, Offer, Priced, Status, allocate,
};

use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{
    Characteristic, Closure, Dimension, Method, Options, Problem, Requirement, SpecLimits, StopReason, Verdict,
};
use sensitol_study::Study;
use sensitol_testing::{relative, repository};

/// Returns a problem of linear characteristics of normal dimensions about 0 with these half-widths.
fn linear<const K: usize>(slopes: [Vec<f64>; K], bands: &[f64], limits: [[f64; 2]; K]) -> Problem {
    let dimensions = bands.iter().enumerate().map(|(d, &t)| Dimension::normal(format!("x{d}"), 0.0, t).unwrap());
    let names: [String; K] = std::array::from_fn(|k| format!("y{k}"));
    let asked = names.clone().into_iter().zip(limits).map(|(name, [lower, upper])| {
        Characteristic::new(name).with_limits(SpecLimits::new(Some(lower), Some(upper)).unwrap())
    });
    let function = Closure::new(names.each_ref().map(String::as_str), move |x| {
        std::array::from_fn(|k| slopes[k].iter().zip(x).map(|(slope, x)| slope * x).sum())
    });
    let asked: Vec<Characteristic> = asked.collect();
    Problem::new(dimensions, function).unwrap().asking(asked).unwrap()
}

fn free(d: usize, curve: Curve, min: f64, max: f64) -> Priced {
    Priced::new(vec![d], vec![Offer::between(curve, min, max).unwrap()]).unwrap()
}

/// Options without a sample. Closures have no degree, but the surface of a linear one is exact, and so is its yield.
fn options(method: Method) -> AllocationOptions {
    AllocationOptions::default().with_analysis(Options::from(method).with_verify(0))
}

/// True if a requirement is not missed. Tolerances at the limit are met if errors are negligible, and inconclusive otherwise.
fn kept(one: &Kept) -> bool {
    one.after.is_some_and(|after| after.verdict != Verdict::Missed)
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
    (problem, AllocationTask::new(priced, vec![Some(requirement)]))
}

/// The optima are from Chase, Greenwood, Loosli, Hauglund (1990), as in the project's notes on methods: tolerances to 1e-6, costs to 1e-3.
#[test]
fn the_shaft_and_the_housing_have_their_published_optima() {
    for (requirement, tolerances, cost) in [
        (Requirement::WorstCase, [0.002537, 0.001734, 0.002495], 11.078),
        (Requirement::Rss, [0.008114, 0.006382, 0.007934], 8.054),
    ] {
        let (problem, task) = shaft_and_housing(requirement);
        let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
        assert_eq!(found.status, Status::Optimal, "{found:#?}");
        // The tolerance is half of the last printed digit.
        for (d, expected) in [(1, tolerances[0]), (3, tolerances[1]), (4, tolerances[2]), (5, tolerances[1])] {
            assert!((tolerance(&found, d) - expected).abs() < 0.51e-6, "{} {expected}", tolerance(&found, d));
        }
        assert!((found.cost_before.unwrap() - 9.336).abs() < 0.51e-3, "{:?}", found.cost_before);
        assert!((found.cost_after.unwrap() - cost).abs() < 0.51e-3, "{:?}", found.cost_after);
        assert!(found.proof.residual.unwrap() < 1e-10);
    }
}

/// Closed form with costs a + b/T^k, one k and one requirement: T_g is proportional to (b_g/p_g)^(1/(k+q)), which is computed here
/// independently.
#[test]
fn random_problems_with_a_closed_form_have_it() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
    for case in 0..200 {
        let n = rng.random_range(1..12);
        let k: f64 = rng.random_range(0.3..2.0);
        let slopes: Vec<f64> = (0..n).map(|_| rng.random_range(-2.0..2.0)).collect();
        let b: Vec<f64> = (0..n).map(|_| rng.random_range(0.01..1.0)).collect();
        let limit: f64 = rng.random_range(0.05..1.0);
        let worst = case % 2 == 0;
        let q = if worst { 1.0 } else { 2.0 };
        let ratio: Vec<f64> =
            slopes.iter().zip(&b).map(|(slope, b)| (b / slope.abs().powf(q)).powf(1.0 / (k + q))).collect();
        let used: f64 = slopes.iter().zip(&ratio).map(|(slope, ratio)| (slope * ratio).abs().powf(q)).sum();
        let mu = limit / used.powf(1.0 / q);
        let problem = linear([slopes], &vec![0.1; n], [[-limit, limit]]);
        let curve = |b| Curve::reciprocal_power(1.0, b, k).unwrap();
        let priced = (0..n).map(|d| free(d, curve(b[d]), 1e-9, 1e9)).collect();
        let requirement = if worst { Requirement::WorstCase } else { Requirement::Rss };
        let task = AllocationTask::new(priced, vec![Some(requirement)]);
        let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
        assert_eq!(found.status, Status::Optimal, "case {case}: {:?} {:?}", found.proof, found.requirements);
        assert!(found.proof.closed_form, "case {case}");
        for (d, ratio) in ratio.iter().enumerate() {
            relative(tolerance(&found, d), mu * ratio, 1e-9);
        }
    }
}

fn bands(rng: &mut Xoshiro256PlusPlus, n: usize) -> Vec<f64> {
    (0..n).map(|_| 10f64.powf(rng.random_range(-2.0..0.0))).collect()
}

fn rss(slopes: &[f64], bands: &[f64]) -> f64 {
    slopes.iter().zip(bands).map(|(slope, band)| (slope * band).powi(2)).sum::<f64>().sqrt().max(1e-3)
}

fn slopes_and_limits(rng: &mut Xoshiro256PlusPlus, bands: &[f64]) -> ([Vec<f64>; 3], [[f64; 2]; 3]) {
    let slope =
        |rng: &mut Xoshiro256PlusPlus| if rng.random::<f64>() < 0.3 { 0.0 } else { rng.random_range(-2.0..2.0) };
    let slopes: [Vec<f64>; 3] = std::array::from_fn(|_| bands.iter().map(|_| slope(rng)).collect());
    let limits = slopes.each_ref().map(|slopes| rss(slopes, bands));
    let limits = limits.map(|rss| [-rss * rng.random_range(0.5..2.0), rss * rng.random_range(0.5..2.0)]);
    (slopes, limits)
}

/// Returns the data that [`convex`] makes of the same random numbers.
fn data(rng: &mut Xoshiro256PlusPlus, n: usize) -> ([Vec<f64>; 3], [[f64; 2]; 3]) {
    let bands = bands(rng, n);
    slopes_and_limits(rng, &bands)
}

/// Returns a random convex problem of N dimensions and up to three characteristics, with costs and requirements of every kind.
fn convex(rng: &mut Xoshiro256PlusPlus, n: usize) -> (Problem, AllocationTask) {
    let bands = bands(rng, n);
    let (slopes, limits) = slopes_and_limits(rng, &bands);
    let rss = slopes.each_ref().map(|slopes| rss(slopes, &bands));
    let problem = linear(slopes, &bands, limits);
    let requirements = (0..3)
        .map(|k| match rng.random_range(0..6) {
            0 => Some(Requirement::Yield(rng.random_range(0.9..0.99999))),
            1 => Some(Requirement::Cpk(rng.random_range(0.8..1.6))),
            2 => Some(Requirement::Sigma(rss[k] / 3.0 * rng.random_range(0.5..1.5))),
            3 => Some(Requirement::Rss),
            4 => Some(Requirement::WorstCase),
            _ if k == 0 => Some(Requirement::Rss),
            _ => None,
        })
        .collect();
    let priced = (0..n)
        .map(|d| {
            let t = bands[d];
            let scale = rng.random_range(0.1..10.0);
            let curve = match rng.random_range(0..3) {
                0 => Curve::reciprocal(rng.random_range(0.0..2.0), scale * t),
                1 => Curve::reciprocal_power(0.5, scale * t.powf(0.6), rng.random_range(0.4..1.5)),
                _ => Curve::exponential(0.1, scale, t * rng.random_range(0.3..3.0)),
            };
            free(d, curve.unwrap(), t * 10f64.powf(rng.random_range(-4.0..-2.0)), t * rng.random_range(1.5..30.0))
        })
        .collect();
    (problem, AllocationTask::new(priced, requirements))
}

/// Returns the residual of Lagrange's condition, by independent formulas of this test.
///
/// The condition: the slope of the cost by `ln T`, for every dimension within its bounds, is a sum of the slopes of the binding
/// requirements with factors that are not negative.
fn independent_residual(task: &AllocationTask, slopes: &[Vec<f64>], limits: &[[f64; 2]], t: &[f64]) -> f64 {
    let normal = statrs::distribution::Normal::new(0.0, 1.0).unwrap();
    let cdf = |x: f64| statrs::distribution::ContinuousCDF::cdf(&normal, x);
    let mut columns: Vec<Vec<f64>> = Vec::new();
    for ((requirement, slopes), &[lower, upper]) in task.requirements.iter().zip(slopes).zip(limits) {
        let Some(requirement) = requirement else { continue };
        let parts: Vec<f64> = slopes.iter().zip(t).map(|(slope, t)| (slope * t).abs()).collect();
        let (reach, room) = (parts.iter().sum::<f64>(), upper.min(-lower));
        let rss = parts.iter().map(|part| part * part).sum::<f64>().sqrt();
        let (sigma, squares) = (rss / 3.0, parts.iter().map(|part| part * part).collect());
        // The value is at most 1 if the requirement is met.
        let (value, column) = match *requirement {
            Requirement::WorstCase => (reach / room, parts),
            Requirement::Rss => (rss / room, squares),
            Requirement::Cpk(least) => (least * 3.0 * sigma / room, squares),
            Requirement::Sigma(most) => (sigma / most, squares),
            Requirement::Yield(least) => ((cdf(lower / sigma) + cdf(-upper / sigma)) / (1.0 - least), squares),
        };
        // The tails of statrs are accurate to 1e-10.
        assert!(value <= 1.0 + 1e-6, "{requirement:?} is exceeded: {value}");
        if value > 1.0 - 1e-6 {
            let largest = column.iter().copied().fold(0.0, f64::max);
            columns.push(column.iter().map(|slope| slope / largest).collect());
        }
    }
    let inside: Vec<usize> = (0..t.len())
        .filter(|&d| {
            let offer = &task.priced[d].offers[0];
            t[d] > offer.min * (1.0 + 1e-9) && t[d] < offer.max * (1.0 - 1e-9)
        })
        .collect();
    // The slope of the cost is an independent difference.
    let slope = |d: usize| {
        let curve = &task.priced[d].offers[0].curve;
        let h: f64 = 1e-4;
        let at = |h: f64| curve.cost(t[d] * h.exp());
        (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h)
    };
    let scale = (0..t.len()).map(|d| slope(d).abs()).fold(0.0, f64::max);
    let right: Vec<f64> = inside.iter().map(|&d| -slope(d) / scale).collect();
    // Least squares by the normal equations, slightly regularised for two equal requirements.
    let k = columns.len();
    let mut matrix =
        faer::Mat::<f64>::from_fn(k, k, |a, b| inside.iter().map(|&d| columns[a][d] * columns[b][d]).sum());
    (0..k).for_each(|a| matrix[(a, a)] *= 1.0 + 1e-12);
    let vector = faer::Mat::from_fn(k, 1, |a, _| inside.iter().zip(&right).map(|(&d, r)| columns[a][d] * r).sum());
    let factors = faer::linalg::solvers::Solve::solve(&matrix.partial_piv_lu(), &vector);
    let row = |(&d, r): (&usize, &f64)| (r - (0..k).map(|a| factors[(a, 0)] * columns[a][d]).sum::<f64>()).abs();
    inside.iter().zip(&right).map(row).fold(0.0, f64::max)
}

/// Lagrange's condition holds by independent formulas, on problems whose data the test has.
#[test]
fn lagranges_condition_is_kept_by_other_formulas_too() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(8);
    for case in 0..60 {
        let n = rng.random_range(2..20);
        let mut again = rng.clone();
        let (problem, task) = convex(&mut rng, n);
        let (slopes, limits) = data(&mut again, n);
        let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
        let t: Vec<f64> = found.tolerances.iter().map(|one| one.after).collect();
        let residual = independent_residual(&task, &slopes, &limits, &t);
        // The differences of the cost are accurate to 1e-10. Nearly parallel requirements leave a slightly larger residual.
        assert!(residual < 1e-7, "case {case}: {residual:e}");
    }
}

fn residual(rng: &mut Xoshiro256PlusPlus, n: usize) -> f64 {
    let (problem, task) = convex(rng, n);
    let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
    assert_eq!(found.status, Status::Optimal, "N = {n}: {:?} {:?}", found.proof, found.attainable);
    assert!(found.requirements.iter().all(kept), "N = {n}: {:?}", found.requirements);
    found.proof.residual.unwrap()
}

#[test]
fn a_thousand_random_convex_problems_keep_the_conditions_of_an_optimum() {
    let of = |case: u64| {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(case);
        let n = rng.random_range(1..=100);
        (residual(&mut rng, n), case)
    };
    let (worst, case) = (0..1000).into_par_iter().map(of).reduce(|| (0.0, 0), |a, b| if b.0 > a.0 { b } else { a });
    assert!(worst < 1e-8, "case {case}: {worst:e}");
}

/// Random lists of processes: up to ten dimensions, up to four processes each, up to three linear requirements. A recursion over sums
/// examines every choice.
#[test]
fn processes_are_chosen_as_every_choice_looked_at_would() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let (mut infeasible, mut nodes) = (0, 0);
    for case in 0..500 {
        let n = rng.random_range(1..=10);
        let most = if n > 8 { 3 } else { 4 };
        let lists: Vec<Vec<(f64, f64)>> = (0..n)
            .map(|_| {
                let count = rng.random_range(1..=most);
                let mut t: Vec<f64> = (0..count).map(|_| 10f64.powf(rng.random_range(-2.0..0.0))).collect();
                let mut cost: Vec<f64> = (0..count).map(|_| rng.random_range(1.0..20.0)).collect();
                t.sort_by(f64::total_cmp);
                cost.sort_by(|a, b| b.total_cmp(a));
                t.into_iter().zip(cost).collect()
            })
            .collect();
        let slopes: [Vec<f64>; 2] = std::array::from_fn(|_| (0..n).map(|_| rng.random_range(-2.0..2.0)).collect());
        let requirement = |rng: &mut Xoshiro256PlusPlus| {
            if rng.random::<bool>() { Requirement::WorstCase } else { Requirement::Rss }
        };
        let requirements = [requirement(&mut rng), requirement(&mut rng)];
        let limits: [f64; 2] = std::array::from_fn(|_| 10f64.powf(rng.random_range(-1.2..0.7)));
        let problem = linear(slopes.clone(), &vec![0.1; n], limits.map(|limit| [-limit, limit]));
        let offer = |(index, &(t, cost)): (usize, &(f64, f64))| Offer::process(format!("p{index}"), t, cost).unwrap();
        let priced = (0..n).map(|d| Priced::new(vec![d], lists[d].iter().enumerate().map(offer).collect()).unwrap());
        let task = AllocationTask::new(priced.collect(), requirements.map(Some).to_vec());
        let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();

        let squared = requirements.map(|requirement| requirement == Requirement::Rss);
        let part = |k: usize, d: usize, t: f64| {
            let part = (slopes[k][d] * t / limits[k]).abs();
            if squared[k] { part * part } else { part }
        };
        let mut best = f64::INFINITY;
        fn every(
            lists: &[Vec<(f64, f64)>],
            part: &dyn Fn(usize, usize, f64) -> f64,
            (d, cost, used): (usize, f64, [f64; 2]),
            best: &mut f64,
        ) {
            if used[0] > 1.0 + 1e-12 || used[1] > 1.0 + 1e-12 {
                return;
            }
            let Some(list) = lists.get(d) else {
                *best = best.min(cost);
                return;
            };
            for &(t, price) in list {
                let used = [used[0] + part(0, d, t), used[1] + part(1, d, t)];
                every(lists, part, (d + 1, cost + price, used), best);
            }
        }
        every(&lists, &part, (0, 0.0, [0.0; 2]), &mut best);
        nodes += found.proof.nodes;
        match best.is_finite() {
            true => {
                assert_eq!(found.status, Status::Optimal, "case {case}: {:?}", found.proof);
                relative(found.cost_after.unwrap(), best, 1e-12);
            }
            false => {
                infeasible += 1;
                assert_eq!(found.status, Status::Infeasible, "case {case}");
                assert!(found.attainable.is_some() && found.after.is_none());
            }
        }
    }
    // The cases are not trivial, and the bounds exclude choices: all choices together are some ten million.
    assert!((50..450).contains(&infeasible), "{infeasible} of 500 have no solution");
    assert!(nodes < 100_000, "{nodes} nodes");
}

/// If the tightest tolerances do not meet a requirement, by formulas of the test, it is recognised and named, with the best attainable
/// value.
#[test]
fn what_cannot_be_kept_is_recognised_and_named() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(17);
    for case in 0..100 {
        let n = rng.random_range(1..12);
        let bands = vec![0.1; n];
        let slopes: Vec<f64> = (0..n).map(|_| rng.random_range(0.2..2.0)).collect();
        let min: Vec<f64> = (0..n).map(|_| rng.random_range(0.01..0.1)).collect();
        let parts = slopes.iter().zip(&min).map(|(slope, min)| slope * min);
        let (worst, rss) = (parts.clone().sum::<f64>(), parts.map(|part| part * part).sum::<f64>().sqrt());
        let (requirement, least) =
            if case % 2 == 0 { (Requirement::WorstCase, worst) } else { (Requirement::Rss, rss) };
        // Slightly more than possible, and slightly less.
        for (limit, possible) in [(least * (1.0 - 1e-6), false), (least * (1.0 + 1e-6), true)] {
            let problem = linear([slopes.clone()], &bands, [[-limit, 2.0 * limit]]);
            let priced = (0..n).map(|d| free(d, Curve::reciprocal(0.0, 1.0).unwrap(), min[d], 1.0)).collect();
            let task = AllocationTask::new(priced, vec![Some(requirement)]);
            let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
            match possible {
                true => assert_eq!(found.status, Status::Optimal, "case {case}: {:?}", found.proof),
                false => {
                    assert_eq!(found.status, Status::Infeasible);
                    let attainable = found.attainable.unwrap();
                    assert_eq!((attainable.characteristic, attainable.requirement), (0, requirement));
                    relative(attainable.best.unwrap(), least / limit, 1e-12);
                    assert!(attainable.because.is_empty());
                }
            }
        }
    }
}

#[test]
fn dimensions_without_a_cost_that_break_a_requirement_are_named() {
    let problem = linear([vec![1.0, -3.0, 2.0]], &[0.1, 0.2, 0.1], [[-0.5, 0.5]]);
    let task = AllocationTask::new(
        vec![free(0, Curve::reciprocal(0.0, 1.0).unwrap(), 0.01, 1.0)],
        vec![Some(Requirement::WorstCase)],
    );
    let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
    let attainable = found.attainable.unwrap();
    assert_eq!(attainable.because, ["x1", "x2"], "0.6 and 0.2 of 0.5 by themselves, most harmful first");
    assert_eq!(found.run.evaluations, 14, "the present tolerances were analysed, and the tightest");
}

fn example(path: &str) -> (Study, AllocationTask, AllocationOptions) {
    let study = Study::read(&repository("examples").join(path)).unwrap();
    let task = study.allocation_task();
    let options = AllocationOptions::default().with_analysis(study.options.clone());
    (study, task, options)
}

/// The optimum of curved models is simulated. The yield lies within the interval of its sample about the target.
#[test]
fn the_optimum_of_a_curved_model_holds_when_it_is_simulated() {
    let (study, task, options) = example("engine-balance/allocate.toml");
    let found = allocate(&study.problem, &task, &options).unwrap();
    assert_eq!(found.status, Status::LocalOptimum, "{:?} {:?}", found.proof, found.requirements);
    assert!(found.confirmed && found.cost_after < found.cost_before);
    assert!(found.proof.residual.unwrap() < 1e-7, "{:?}", found.proof);
    // Only derivatives at the optimum come from the method. The sample is a new one of the model itself, with an interval of one
    // ten-thousandth.
    let sample = SimulationOptions::default().with_samples(4_000_000);
    let simulated = simulate(&found.problem, &sample).unwrap();
    let mut binding = 0;
    for (of, one) in found.requirements.iter().zip(&simulated.characteristics) {
        let required = of.requirement.value().unwrap();
        let after = of.after.unwrap().value.unwrap();
        assert!(after >= required);
        let [low, high] = one.yield_.unwrap().interval;
        assert!(after > low && after < high, "{:?} {:?}", of, one.yield_);
        // The requirement includes the uncertainty of the yield. This is the greatest of some rounds, in which a few of 41,984 points of
        // the model (2.4e-5 each) lie on one side of a limit or the other.
        let [least, _] = of.after.unwrap().interval.unwrap();
        binding += usize::from(least < required + 1e-4);
    }
    assert!(binding >= 1, "the optimum is at a limit");
}

#[test]
fn a_limit_costs_what_its_price_says() {
    // min b/T subject to 3 sigma = 3 T/3 <= 0.3 - off: C = b/(0.3 - off), dC/doff = b/(0.3 - off)^2.
    let cost = |upper: f64| {
        let problem = linear([vec![1.0]], &[0.1], [[-1.0, upper]]);
        let task = AllocationTask::new(
            vec![free(0, Curve::reciprocal(0.0, 2.0).unwrap(), 1e-3, 10.0)],
            vec![Some(Requirement::Cpk(1.0))],
        );
        allocate(&problem, &task, &options(Method::Rss)).unwrap()
    };
    let found = cost(0.3);
    relative(found.cost_after.unwrap(), 2.0 / 0.3, 1e-10);
    let [price] = &found.prices[..] else { panic!("{:?}", found.prices) };
    // The slope of the limit is a difference with steps of 1e-5.
    relative(price.upper.unwrap(), 2.0 / 0.09, 1e-8);
    assert_eq!((price.lower, price.both, price.sigma), (None, price.upper, None));
    let slope = (cost(0.3).cost_after.unwrap() - cost(0.3 + 1e-6).cost_after.unwrap()) / 1e-6;
    relative(slope, price.upper.unwrap(), 1e-4);
}

/// Two limits at the same distance bind together, so that widening one of them alone saves nothing.
#[test]
fn limits_that_bind_together_have_one_price() {
    let problem = linear([vec![1.0]], &[0.1], [[-0.3, 0.3]]);
    let task = AllocationTask::new(
        vec![free(0, Curve::reciprocal(0.0, 2.0).unwrap(), 1e-3, 10.0)],
        vec![Some(Requirement::WorstCase)],
    );
    let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
    let [price] = &found.prices[..] else { panic!("{:?}", found.prices) };
    relative(price.both.unwrap(), 2.0 / 0.09, 1e-8);
    assert_eq!((price.lower, price.upper), (None, None));
}

/// The middle of a band stays where it is, and so does the mean: b - a with b of -0.1/+0.3.
#[test]
fn the_middle_of_an_asymmetric_band_stays() {
    let dimensions =
        [Dimension::normal("a", 10.0, 0.1).unwrap(), Dimension::normal_between("b", 20.0, [-0.1, 0.3]).unwrap()];
    let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(9.0), Some(10.25)).unwrap());
    let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[1] - x[0])).unwrap().asking([gap]).unwrap();
    // Only b is free. The worst case above is 10 + 0.1 + 0.1 + T, so that T = 0.05, or +0.05/+0.15.
    let task = AllocationTask::new(
        vec![free(1, Curve::reciprocal(0.0, 1.0).unwrap(), 0.01, 1.0)],
        vec![Some(Requirement::WorstCase)],
    );
    let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
    relative(tolerance(&found, 1), 0.05, 1e-12);
    let [lower, upper] = found.problem.dimensions()[1].tolerance().unwrap();
    relative(lower, 0.05, 1e-12);
    relative(upper, 0.15, 1e-12);
    relative(found.after.as_ref().unwrap().characteristics[0].range.worst_case.unwrap()[1], 10.25, 1e-12);
    // Cpk 1: mean 10.1 and 3 sigma sqrt(0.1^2 + T^2) reach 10.25 together.
    let task = AllocationTask::new(task.priced, vec![Some(Requirement::Cpk(1.0))]);
    let found = allocate(&problem, &task, &options(Method::SecondOrder)).unwrap();
    // The tolerance is the margin that is left after derivatives were computed anew.
    relative(tolerance(&found, 1), 0.0125f64.sqrt(), 1e-6);
    assert_eq!(found.status, Status::Optimal, "{:?}", found.proof);
}

/// Play of a bearing with one-sided bands, as on drawings. The optimum by hand: mean 0.145, sigma so that 0.27 % lie outside 0 and 0.4
/// (0.052116839 by mpmath), and 0.05/S^3 = 0.2/H^3 by Lagrange.
#[test]
fn one_sided_bands_are_allocated() {
    let text = "[dimensions]\nhousing = { nominal = 50.0, tolerance = [0.05, 0.15] }\nb1 = { nominal = 15, tolerance = [-0.12, 0] }\n\
                b2 = { nominal = 15, tolerance = [-0.12, 0] }\nspacer = { nominal = 20.1, tolerance = [-0.05, 0] }\n[characteristics]\n\
                play = { formula = \"housing - b1 - b2 - spacer\", lower = 0, upper = 0.4, target_yield = 0.9973 }\n[costs]\n\
                spacer = { model = \"reciprocal\", a = 1, b = 0.05 }\nhousing = { model = \"reciprocal\", a = 1, b = 0.2 }\n";
    let study = Study::from_toml(text, "play.toml").unwrap();
    let found = allocate(&study.problem, &study.allocation_task(), &options(Method::Full)).unwrap();
    assert_eq!(found.status, Status::Optimal, "{:?}", found.proof);
    relative(tolerance(&found, 3), 0.069_996_464_346_208_95, 1e-6);
    relative(tolerance(&found, 0), 0.111_112_461_137_226_66, 1e-6);
    let mean = found.after.as_ref().unwrap().characteristics[0].moments.unwrap().mean();
    assert!((mean - 0.145).abs() < 1e-12);
}

/// Correlation enters the requirement: the difference a - b has var = sa^2 + sb^2 - 2 rho sa sb.
#[test]
fn correlation_has_its_part_in_the_requirement() {
    let dimensions = [Dimension::normal("a", 10.0, 0.3).unwrap(), Dimension::normal("b", 5.0, 0.3).unwrap()];
    let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(4.9), Some(5.1)).unwrap());
    let pair = sensitol::correlation::Pair { between: ["a".into(), "b".into()], value: 0.6 };
    let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1])).unwrap();
    let problem = problem.asking([gap]).unwrap().correlated(&[pair]).unwrap();
    for requirement in [Requirement::Rss, Requirement::Cpk(1.0)] {
        let curve = || Curve::reciprocal(0.0, 1.0).unwrap();
        let task = AllocationTask::new(
            vec![free(0, curve(), 0.01, 1.0), free(1, curve(), 0.01, 1.0)],
            vec![Some(requirement)],
        );
        let found = allocate(&problem, &task, &options(Method::SecondOrder)).unwrap();
        // A sum of squares with products is convex if its matrix is positive definite, like a correlation matrix.
        assert_eq!(found.status, Status::Optimal, "{:?}", found.proof);
        let [a, b] = [0, 1].map(|d| tolerance(&found, d));
        // By symmetry both are equal: 2 T^2 (1 - 0.6) = 0.01.
        relative(a, b, 1e-6);
        relative(a, (0.01f64 / 0.8).sqrt(), 1e-6);
    }
}

/// Uniform dimensions with a lognormal one: the shape of the sum changes with the tolerances, and that of the lognormal dimension with its
/// own tolerance.
#[test]
fn shapes_that_change_are_followed() {
    let lognormal = sensitol::distribution::Lognormal::new(0.0, 1.0, 0.1).unwrap();
    let uniform = |name: &str| Dimension::uniform(name, 10.0, 0.2).unwrap();
    let lognormal = Dimension::distributed("e", 1.0, None, std::sync::Arc::new(lognormal)).unwrap();
    let dimensions = [uniform("a"), uniform("b"), uniform("c"), uniform("d"), lognormal];
    let sum = Characteristic::new("sum").with_limits(SpecLimits::new(None, Some(41.5)).unwrap());
    let problem = Problem::new(dimensions, Closure::scalar("sum", |x| x.iter().sum())).unwrap().asking([sum]).unwrap();
    let task = AllocationTask::new(
        (0..5).map(|d| free(d, Curve::reciprocal(0.0, 1.0 + d as f64).unwrap(), 0.01, 2.0)).collect(),
        vec![Some(Requirement::Yield(0.995))],
    );
    let found = allocate(&problem, &task, &options(Method::SecondOrder)).unwrap();
    assert_eq!(found.status, Status::LocalOptimum, "{:?} {:?}", found.proof, found.requirements);
    let sample = SimulationOptions::default().with_samples(1_000_000);
    let simulated = simulate(&found.problem, &sample).unwrap();
    let [low, high] = simulated.characteristics[0].yield_.unwrap().interval;
    // Four moments do not determine the tail of a sum of uniforms: the error is a tenth of the rejects.
    assert!(low - 5e-4 < 0.995 && 0.995 < high + 5e-4, "{low} {high}");
}

#[test]
fn a_choice_of_processes_for_a_curved_model_is_what_every_choice_says() {
    let (study, task, options) = example("stacked-blocks/allocate.toml");
    let found = allocate(&study.problem, &task, &options).unwrap();
    assert!(matches!(found.status, Status::Optimal), "{:?}", found.proof);
    // The full analysis of each of the 486 choices.
    let mut best = f64::INFINITY;
    let counts: Vec<usize> = task.priced.iter().map(|group| group.offers.len()).collect();
    for choice in 0..counts.iter().product::<usize>() {
        let (mut rest, mut cost) = (choice, 0.0);
        let mut dimensions = study.problem.dimensions().to_vec();
        for (group, count) in task.priced.iter().zip(&counts) {
            let offer = &group.offers[rest % count];
            rest /= count;
            cost += group.parts * offer.curve.cost(offer.min);
            for &d in &group.members {
                let factor = offer.min / dimensions[d].half_band();
                dimensions[d] = dimensions[d].scaled(factor).unwrap().unwrap();
            }
        }
        if cost < best {
            let problem = study.problem.clone().with_dimensions(dimensions).unwrap();
            let analysis = sensitol::analyze(&problem, &study.options).unwrap();
            if analysis.characteristics[0].met() == Some(true) {
                best = cost;
            }
        }
    }
    relative(found.cost_after.unwrap(), best, 1e-12);
}

/// The difference b - a has limits off the middle. The yield is greatest with the mean in the middle, whichever dimension moves it.
#[test]
fn nominal_values_move_to_the_middle_of_the_limits() {
    let dimensions = || [Dimension::normal("a", 10.0, 0.1).unwrap(), Dimension::normal("b", 30.0, 0.2).unwrap()];
    let problem = |function: fn(&[f64]) -> f64| {
        let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(20.5), Some(21.5)).unwrap());
        Problem::new(dimensions(), Closure::scalar("gap", function)).unwrap().asking([gap]).unwrap()
    };
    let task = AllocationTask::new(Vec::new(), vec![None]);
    let recentred = |problem: &Problem, names: &[&str]| {
        let recentre = names.iter().map(|&name| name.to_owned()).collect();
        allocate(problem, &task, &options(Method::SecondOrder).with_recentre(recentre)).unwrap()
    };
    let found = recentred(&problem(|x| x[1] - x[0]), &["b"]);
    assert_eq!((found.status, found.moved.len()), (Status::Optimal, 1));
    // The maximum is flat, so that its place is accurate to a thousandth of sigma, here 0.07.
    assert!((found.moved[0].after - 31.0).abs() < 1e-4, "{:?}", found.moved);
    let found = recentred(&problem(|x| x[1] - x[0]), &["a", "b"]);
    // Each moves in proportion to its sigma squared, which is the shortest way in sigmas.
    assert!(
        (found.moved[0].after - 9.8).abs() < 1e-3 && (found.moved[1].after - 30.8).abs() < 1e-3,
        "{:?}",
        found.moved
    );
    // The target is far away along a curve: 21 = x1 - 1000/x0^2 at x0 with 20 + ..., found by several rounds of derivatives.
    let found = recentred(&problem(|x| x[1] - 1000.0 / (x[0] * x[0])), &["a"]);
    let expected = (1000.0f64 / 9.0).sqrt();
    assert!((found.moved[0].after - expected).abs() < 5e-3, "{:?} {expected}", found.moved);
    assert!(found.rounds > 1);
}

/// Recentring together with allocation reaches the cost of a centred start from an off-centre one.
#[test]
fn recentring_and_allocating_go_together() {
    let problem = |nominal: f64| {
        let dimensions = [Dimension::normal("a", 10.0, 0.1).unwrap(), Dimension::normal("b", nominal, 0.2).unwrap()];
        let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(20.5), Some(21.5)).unwrap());
        Problem::new(dimensions, Closure::scalar("gap", |x| x[1] - x[0])).unwrap().asking([gap]).unwrap()
    };
    let curve = || Curve::reciprocal(0.0, 1.0).unwrap();
    let task = AllocationTask::new(
        vec![free(0, curve(), 0.01, 3.0), free(1, curve(), 0.01, 3.0)],
        vec![Some(Requirement::Yield(0.9973))],
    );
    let together = options(Method::SecondOrder).with_recentre(vec!["b".into()]);
    let found = allocate(&problem(30.7), &task, &together).unwrap();
    let centred = allocate(&problem(31.0), &task, &options(Method::SecondOrder)).unwrap();
    // A yield is not convex in nominal values and tolerances together.
    assert_eq!(found.status, Status::LocalOptimum, "{:?}", found.proof);
    relative(found.cost_after.unwrap(), centred.cost_after.unwrap(), 1e-5);
}

/// RSS is linear in the factor, so that the loosest scaling is the ratio of the limits to the RSS.
#[test]
fn the_loosest_scaling_is_the_room_that_is_left() {
    let (problem, task) = shaft_and_housing(Requirement::Rss);
    let found = allocate(&problem, &task, &options(Method::Rss)).unwrap();
    let squares: f64 = [0.0015f64, 0.008, 0.0025, 0.002, 0.006, 0.002, 0.0025].iter().map(|t| t * t).sum();
    relative(found.loosest_before.unwrap(), 0.015 / squares.sqrt(), 1e-9);
    relative(found.loosest_after.unwrap(), 1.0, 1e-9);
}

#[test]
fn the_front_rises_with_what_is_required() {
    let (study, task, options) = example("engine-balance/allocate.toml");
    let options = options.with_front(9);
    let found = allocate(&study.problem, &task, &options).unwrap();
    assert_eq!(found.front.len(), 9);
    let costs: Vec<f64> = found.front.iter().map(|point| point.cost.unwrap()).collect();
    assert!(costs.windows(2).all(|pair| pair[0] < pair[1]), "{costs:?}");
    // The target lies between two points, and so does its cost.
    let after = found.cost_after.unwrap();
    let required = |point: &sensitol::allocation::FrontPoint| point.required[0].amount;
    let place = found.front.iter().position(|point| required(point) > 0.9973).unwrap();
    assert!(costs[place - 1] <= after * (1.0 + 1e-6) && after <= costs[place], "{costs:?} {after}");
    assert_eq!(found.front[0].tolerances.as_ref().unwrap().len(), found.tolerances.len());
}

#[test]
fn allocations_do_not_depend_on_the_number_of_threads() {
    let (study, task, options) = example("engine-balance/allocate.toml");
    let options = options.with_confirm(5000);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let found = pool.install(|| allocate(&study.problem, &task, &options).unwrap());
        let yields: Vec<_> = found.confirmation.unwrap().characteristics.iter().map(|one| one.yield_).collect();
        (found.tolerances, found.joint, yields, found.run.evaluations)
    };
    assert_eq!(on(1), on(3));
}

/// Joint yield of independent characteristics, which is the product of their yields.
#[test]
fn the_joint_yield_is_that_of_all_limits_at_once() {
    let problem = linear([vec![1.0, 0.0], vec![0.0, 1.0]], &[0.3, 0.3], [[-0.2, 0.2], [-0.15, 9.0]]);
    let task = AllocationTask::new(
        vec![free(0, Curve::reciprocal(0.0, 1.0).unwrap(), 0.3, 0.3)],
        vec![Some(Requirement::Sigma(1.0)), None],
    );
    let found = allocate(&problem, &task, &options(Method::SecondOrder)).unwrap();
    let joint = found.joint[0].unwrap();
    // 2 Phi(2) - 1 and Phi(1.5).
    let expected = 0.954_499_736_103_641_6 * 0.933_192_798_731_141_9;
    let error = joint.standard_error.unwrap();
    assert!((joint.value - expected).abs() < 4.0 * error, "{joint:?} {expected}");
    assert!(error < 2e-3 && joint.interval[0] < expected && expected < joint.interval[1]);
}

#[test]
fn a_run_that_is_stopped_says_so() {
    let (study, task, options) = example("engine-balance/allocate.toml");
    let stop = || Some(StopReason::TimeLimit);
    let run = sensitol::assembly::Run::to_the_end().stopping_when(&stop);
    let found = sensitol::allocation::allocate_with(&study.problem, &task, &options, &run).unwrap();
    assert_eq!(found.status, Status::OutOfTime);
    assert!(found.run.stopped == Some(StopReason::TimeLimit) && found.after.is_none() && found.cost_after.is_none());
}

#[test]
fn a_budget_that_does_not_reach_is_said() {
    let (study, task, options) = example("engine-balance/allocate.toml");
    let analysis = options.analysis.clone().with_budget(111);
    let found = allocate(&study.problem, &task, &options.clone().with_analysis(analysis)).unwrap();
    assert!(!found.confirmed && found.run.evaluations == 111 && found.cost_after.is_some());
    assert_eq!(found.status, Status::AlmostOptimal);
    // The model was not evaluated there. Unknown figures are not replaced by those of the old tolerances.
    assert!(found.after.is_none() && found.loosest_after.is_none() && found.joint[1].is_none());
    assert!(found.requirements.iter().all(|one| one.after.is_none()));
    let group = &found.tolerances[0];
    assert!((found.problem.dimensions()[group.dimension].half_band() - group.after).abs() < 1e-12 * group.after);
    let analysis = options.analysis.clone().with_budget(110);
    let error = allocate(&study.problem, &task, &options.with_analysis(analysis)).unwrap_err();
    assert!(error.to_string().contains("111 evaluations"), "{error}");
}

/// A model that fails at the wanted tolerances is approached in shorter steps from tolerances at which it has values.
#[test]
fn a_model_that_fails_farther_out_is_approached_in_steps() {
    let dimensions = [Dimension::normal("a", 1.0, 0.1).unwrap(), Dimension::normal("b", 1.0, 0.1).unwrap()];
    // Even the nodes that replace failed ones, at a quarter of sqrt 3 sigma, lie outside for tolerances above 0.7.
    let root = sensitol_testing::refusing(|x| x[1] + 0.01 * x[0], |x| (x[0] - 1.0).abs() > 0.1);
    let y = Characteristic::new("y").with_limits(SpecLimits::new(Some(0.9), Some(1.12)).unwrap());
    let problem = Problem::new(dimensions, root).unwrap().asking([y]).unwrap();
    let curve = || Curve::reciprocal(0.0, 1.0).unwrap();
    let task = AllocationTask::new(
        vec![free(0, curve(), 0.01, 3.0), free(1, curve(), 0.01, 3.0)],
        vec![Some(Requirement::Cpk(1.0))],
    );
    let found = allocate(&problem, &task, &options(Method::SecondOrder)).unwrap();
    assert!(found.cost_after.unwrap() < found.cost_before.unwrap(), "{:?}", found.status);
    assert!(kept(&found.requirements[0]) && found.confirmed);
}

/// Extrapolations from derivatives at wide tolerances to tight ones are evaluated before a requirement is called impossible.
#[test]
fn nothing_is_called_impossible_by_extrapolation() {
    // The function is flat near the middle and steep beyond. Extrapolated from half-widths of 1, its sigma at 0.1 seems larger than it is.
    let steep = |x: &[f64]| x[0].powi(3) + 0.001 * x[0];
    let y = Characteristic::new("y").with_limits(SpecLimits::new(Some(-0.002), Some(0.002)).unwrap());
    let dimensions = [Dimension::normal("a", 0.0, 1.0).unwrap()];
    let problem = Problem::new(dimensions, Closure::scalar("y", steep)).unwrap().asking([y]).unwrap();
    let task = AllocationTask::new(
        vec![free(0, Curve::reciprocal(0.0, 1.0).unwrap(), 0.1, 3.0)],
        vec![Some(Requirement::Cpk(1.0))],
    );
    let found = allocate(&problem, &task, &options(Method::SecondOrder)).unwrap();
    assert_eq!(found.status, Status::Optimal, "{:?} {:?}", found.attainable, found.proof);
    assert!(kept(&found.requirements[0]) && tolerance(&found, 0) > 0.1);
}
