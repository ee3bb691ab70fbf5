//! Rare events against results from other methods.

use sensitol::assembly::Run;
use sensitol::correlation::Pair;
use sensitol::distribution::Exponential;
use sensitol::rare::{Beyond, RareError, RareEvents, RareOptions, rare, rare_with};
use sensitol::simulation::{SimulationError, SimulationOptions, simulate};
use sensitol::{Characteristic, Closure, Dimension, Method, Options, Problem, SpecLimits, StopReason};
use sensitol_study::Study;
use serde_json::Value;

use super::command::{run, sensitol};
use sensitol_testing::{Asked, data, refusing, relative, repository, standard};

const SEEDS: u64 = 100;

fn tail(z: f64) -> f64 {
    0.5 * libm::erfc(z / 2f64.sqrt())
}

fn limited(problem: Problem, lower: Option<f64>, upper: Option<f64>) -> Problem {
    let name = problem.characteristics()[0].name().to_owned();
    let limits = SpecLimits::new(lower, upper).unwrap();
    problem.asking([Characteristic::new(name).with_limits(limits)]).unwrap()
}

fn found(problem: &Problem, samples: u64, seed: u64, method: Method) -> RareEvents {
    rare(problem, &RareOptions::default().with_samples(samples).with_seed(seed).with_surrogate(Options::from(method)))
        .unwrap()
}

/// Returns both sides of the first characteristic.
fn sides(found: &RareEvents) -> [Option<Beyond>; 2] {
    [found.characteristics[0].below.clone(), found.characteristics[0].above.clone()]
}

/// Estimates of a probability with a hundred seeds.
#[derive(Debug, Default)]
struct Record {
    covered: usize,
    /// Mean of the relative standard error over the seeds.
    /// Mean of the interval's width over the seeds, relative to the truth.
    error: f64,
    width: f64,
}

/// Returns a record for each side that has a known truth.
fn records(problem: &Problem, samples: u64, method: Method, truth: [Option<f64>; 2]) -> [Record; 2] {
    let mut records = [Record::default(), Record::default()];
    for seed in 0..SEEDS {
        for ((record, beyond), truth) in
            records.iter_mut().zip(sides(&found(problem, samples, seed, method))).zip(truth)
        {
            let (Some(beyond), Some(truth)) = (beyond, truth) else { continue };
            let [low, high] = beyond.interval;
            record.covered += usize::from(low <= truth && truth <= high);
            record.width += (high - low) / truth / SEEDS as f64;
            let error = |value: f64| beyond.standard_error.unwrap() / value;
            record.error += beyond.probability.map_or(1.0, error) / SEEDS as f64;
        }
    }
    records
}

/// At least 90 of a hundred 95 % intervals contain the truth. Fewer have probability 1/40 if the intervals are right.
#[track_caller]
fn holds(record: &Record) {
    assert!(record.covered >= 90, "{record:?}");
}

/// Engine balance with F limited 4.5 sigma above and below its mean, on one side and on both. The truth is a sample by another program
/// (tests/data) with an error of a tenth of a percent.
#[test]
fn the_engine_beyond_four_and_a_half_sigma() {
    let study = Study::read(&repository("examples/engine-balance/study.toml")).unwrap();
    let exact = &data("engine-balance.json")["table-3"]["F"];
    let [mean, sigma] = ["mean", "sigma"].map(|name| exact[name].as_f64().unwrap());
    let force = study.problem.asking([Characteristic::new("F")]).unwrap();
    let ends = [mean - 4.5 * sigma, mean + 4.5 * sigma];
    let tails = data("engine-balance-tails.json");
    let truth = ["below", "above"].map(|side| tails[side]["probability"].as_f64().unwrap());
    let both = limited(force.clone(), Some(ends[0]), Some(ends[1]));
    // The surrogate takes 91 evaluations: N = 9 of the ten dimensions affect F.
    assert_eq!(found(&both, 409, 1, Method::Full).run.evaluations, 500);
    for record in records(&both, 909, Method::Full, truth.map(Some)) {
        holds(&record);
        assert!(record.error < 0.05, "{record:?}");
    }
    let above = limited(force, None, Some(ends[1]));
    let [_, record] = records(&above, 909, Method::Full, [None, Some(truth[1])]);
    holds(&record);
    assert!(record.error < 0.035, "{record:?}");
}

/// A product of two lognormal variables is lognormal: `exp(s z)`. The probability beyond `exp(+-s k)` is that of k sigma.
fn lognormal(s: f64, k: f64) -> Problem {
    let y = Closure::scalar("y", move |x| (0.6 * s * x[0]).exp() * (0.8 * s * x[1]).exp());
    limited(Problem::new(standard(2), y).unwrap(), Some((-s * k).exp()), Some((s * k).exp()))
}

/// Slopes alone place the upper limit twice as far away as it is, which points of the model on the way correct. Curvatures without
/// interactions give a wrong direction: intervals are wide, and contain the truth slightly less often than stated.
#[test]
fn a_poor_surrogate_costs_accuracy_and_not_truth() {
    for (s, k) in [(0.15, 4.5), (0.5, 4.5), (0.5, 3.0)] {
        let problem = lognormal(s, k);
        let of = |method: Method| records(&problem, 900, method, [Some(tail(k)); 2]);
        let (good, slopes, wrong) = (of(Method::Full), of(Method::Rss), of(Method::SecondOrder));
        for (record, name) in good.iter().chain(&slopes).zip(["full", "full", "rss", "rss"]) {
            assert!(record.covered >= 90, "{name} {s} {k}: {record:?}");
        }
        for (wrong, good) in wrong.iter().zip(&good) {
            assert!(wrong.covered >= 80 && wrong.width > 2.0 * good.width, "{s} {k}: {wrong:?} {good:?}");
        }
    }
}

/// `sqrt(x^2 + y^2 + z^2)` of normal x, y, z has Maxwell's distribution. `x y` beyond 12 has two design points, on the diagonal. Its
/// probability is `2 int phi(x) Phi(-12/x) dx`, here by the trapezoidal rule, which converges faster than any power.
#[test]
fn several_places_at_once() {
    let norm = Closure::scalar("y", |x| (x[0] * x[0] + x[1] * x[1] + x[2] * x[2]).sqrt());
    let r = 5.5f64;
    let maxwell = 2.0 * tail(r) + (2.0 / std::f64::consts::PI).sqrt() * r * (-0.5 * r * r).exp();
    let norm = limited(Problem::new(standard(3), norm).unwrap(), None, Some(r));
    let [_, record] = records(&norm, 400, Method::SecondOrder, [None, Some(maxwell)]);
    holds(&record);
    let product = Problem::new(standard(2), Closure::scalar("y", |x| x[0] * x[1])).unwrap();
    let step = 1e-3;
    let density = |x: f64| (-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let beyond: f64 = (1..12_000).map(|i| step * f64::from(i)).map(|x| 2.0 * step * density(x) * tail(12.0 / x)).sum();
    let [_, record] = records(&limited(product, None, Some(12.0)), 400, Method::Full, [None, Some(beyond)]);
    holds(&record);
    assert!(record.error < 0.05, "{record:?}");
}

/// Sums with known tails: three exponentials beyond 25 (Erlang), three uniforms within 0.03 of their greatest sum (a corner of the cube:
/// `d^3/6`), correlated normals (a normal).
#[test]
fn any_distribution_and_correlation() {
    let sum = || Closure::scalar("y", |x: &[f64]| x.iter().sum());
    let check = |problem: Problem, truth: f64| {
        let [_, record] = records(&problem, 1000, Method::Full, [None, Some(truth)]);
        holds(&record);
        assert!(record.error < 0.1, "{record:?}");
    };
    let exponential = |name: &str| {
        Dimension::distributed(name, 1.0, None, std::sync::Arc::new(Exponential::new(0.0, 1.0).unwrap())).unwrap()
    };
    let problem = Problem::new(["a", "b", "c"].map(exponential), sum()).unwrap();
    check(limited(problem, None, Some(25.0)), (-25f64).exp() * (1.0 + 25.0 + 0.5 * 625.0));
    let uniform = ["a", "b", "c"].map(|name| Dimension::uniform(name, 0.5, 0.5).unwrap());
    let problem = Problem::new(uniform, sum()).unwrap();
    check(limited(problem, None, Some(2.97)), 0.03f64.powi(3) / 6.0);
    let pair = Pair { between: ["x0".to_owned(), "x1".to_owned()], value: 0.6 };
    let problem = Problem::new(standard(2), sum()).unwrap().correlated(&[pair]).unwrap();
    check(limited(problem, None, Some(5.0 * 3.2f64.sqrt())), tail(5.0));
}

/// For an event that plain sampling can resolve, both methods agree, and the report states that plain sampling would have sufficed.
#[test]
fn it_agrees_with_plain_sampling() {
    let problem = lognormal(0.5, 2.0);
    let plain = simulate(&problem, &SimulationOptions::default().with_samples(1_000_000)).unwrap();
    let plain = &plain.characteristics[0];
    let one = found(&problem, 4000, 1, Method::Full);
    for (beyond, share) in sides(&one).into_iter().zip([plain.below.unwrap(), plain.above.unwrap()]) {
        let beyond = beyond.unwrap();
        let error = (share / 1e6).sqrt().hypot(beyond.standard_error.unwrap());
        // Four standard errors of the difference.
        assert!((beyond.probability.unwrap() - share).abs() < 4.0 * error, "{beyond:?} {share}");
    }
    // Half of all assemblies: the event is not rare.
    let half = limited(Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap(), None, Some(0.0));
    let [_, above] = sides(&found(&half, 1000, 1, Method::Full));
    let above = above.unwrap();
    assert!(above.interval[0] < 0.5 && 0.5 < above.interval[1] && above.plain_samples.unwrap() < 1100.0, "{above:?}");
}

/// A linear characteristic of two normals: the design point equals that of calculus.
#[test]
fn the_design_point_is_the_most_likely_one() {
    let dimensions = [
        Dimension::normal("a", 10.0, 0.3).unwrap(),
        Dimension::normal("b", 5.0, 0.4).unwrap(),
        Dimension::fixed("c", 2.0).unwrap(),
    ];
    let y = Closure::scalar("y", |x| x[0] - x[1] + x[2]);
    let problem = limited(Problem::new(dimensions, y).unwrap(), None, Some(7.75));
    let [_, above] = sides(&found(&problem, 200, 1, Method::Full));
    let point = above.unwrap().design_point.unwrap();
    // sigma^2 = 0.1^2 + (0.4/3)^2 = (1/6)^2. The limit is 4.5 sigma away, distributed in proportion to the variances. The crossing is
    // searched in steps of 0.02.
    relative(point.distance, 4.5, 0.02);
    for (value, expected) in point.values.iter().zip([10.0 + 0.75 * 0.36, 5.0 - 0.75 * 0.64, 2.0]) {
        assert!((value - expected).abs() < 0.01, "{point:?}");
    }
}

#[test]
fn the_number_of_threads_and_the_scale_change_nothing() {
    let problem = lognormal(0.5, 4.0);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| sides(&found(&problem, 3000, 3, Method::Full)))
    };
    assert_eq!(with(1), with(3));
    // A power of two as scale changes no digit.
    let y = |scale: f64| Closure::scalar("y", move |x: &[f64]| scale * (0.3 * x[0]).exp());
    let of = |scale: f64| {
        let problem = limited(Problem::new(standard(1), y(scale)).unwrap(), None, Some(4.0 * scale));
        sides(&found(&problem, 500, 1, Method::Full))[1].clone().unwrap().probability
    };
    assert_eq!(of(1.0), of(2f64.powi(100)));
}

/// Every evaluation is requested once and counted: those of the surrogate, those on the way to the limit, and the samples.
#[test]
fn every_evaluation_is_counted() {
    let asked = Asked::default();
    let problem = Problem::new(standard(2), asked.watching(|x| x[0] * x[1] + x[0])).unwrap();
    let found = found(&limited(problem, None, Some(15.0)), 300, 1, Method::Full);
    assert_eq!((found.surrogate_evaluations, found.run.evaluations), (7, 307));
    assert!(found.samples < 300 && found.run.stopped.is_none());
    // The distance of a place may coincide with a point of a second search.
    assert!((300..=307).contains(&asked.distinct()), "{}", asked.distinct());
}

/// Sampling continues until the standard errors are as wanted, and the result states if they are.
#[test]
fn until_it_is_known_that_well() {
    let problem = lognormal(0.15, 4.5);
    let until = |wanted: f64, samples: u64| {
        let found = rare(&problem, &RareOptions::default().with_samples(samples).with_until(wanted)).unwrap();
        let relative = |beyond: &Beyond| beyond.standard_error.unwrap() / beyond.probability.unwrap();
        let worst = sides(&found).into_iter().flatten().map(|beyond| relative(&beyond));
        (found.reached, found.run.stopped.is_some(), worst.fold(0.0, f64::max))
    };
    let (reached, stopped, worst) = until(0.02, 100_000);
    assert!(reached == Some(true) && !stopped && worst <= 0.02, "{worst}");
    let (reached, stopped, worst) = until(0.001, 500);
    assert!(reached == Some(false) && !stopped && worst > 0.001, "{worst}");
}

/// Points without a value may lie beyond the limit or not.
#[test]
fn failed_points_bound_the_probability() {
    let model = refusing(|x| x[0] + x[1], |x| x[0] - x[1] > 1.5);
    let problem = limited(Problem::new(standard(2), model).unwrap(), None, Some(4.0 * 2f64.sqrt()));
    let found = found(&problem, 4000, 1, Method::Full);
    let one = &found.characteristics[0];
    assert!(one.failed > 0 && one.error.is_some() && found.run.failed >= one.failed, "{one:?}");
    let above = one.above.clone().unwrap();
    // Sum and difference are independent.
    let lost = tail(1.5 / 2f64.sqrt());
    let truth = tail(4.0) * (1.0 - lost);
    assert!(above.interval[0] < truth && truth < above.interval[1], "{above:?}");
    // The bounds hold for any values of the failed points: at least the observed probability, at most that and all failed points.
    let [least, most] = above.bounds.unwrap();
    assert!(least == above.probability.unwrap() && most > tail(4.0), "{above:?}");
    assert!(most < truth + 1.5 * lost, "{above:?}");
}

#[test]
fn it_stops_when_told_to() {
    let problem = lognormal(0.15, 4.5);
    let run = Run::to_the_end().stopping_when(&|| Some(StopReason::Requested));
    let found = rare_with(&problem, &RareOptions::default(), &run, &|_| {}).unwrap();
    assert!(found.run.stopped.is_some() && found.samples == 0 && sides(&found) == [None, None]);
    // After the surrogate and some points, the results so far are reported.
    let seen = std::sync::atomic::AtomicUsize::new(0);
    let later = || (seen.fetch_add(1, std::sync::atomic::Ordering::Relaxed) > 40).then_some(StopReason::TimeLimit);
    let run = Run::to_the_end().stopping_when(&later);
    let options = RareOptions::default().with_samples(1_000_000);
    let found = rare_with(&problem, &options, &run, &|_| {}).unwrap();
    assert!(found.run.stopped.is_some() && found.samples < 1_000_000);
}

#[test]
fn what_cannot_be_sought_is_refused() {
    let line = || Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap();
    let options = RareOptions::default();
    assert_eq!(rare(&line(), &options).unwrap_err(), RareError::NoLimits);
    let problem = limited(line(), None, Some(4.0));
    for samples in [0, 49, 10_000_001] {
        let error = rare(&problem, &options.clone().with_samples(samples)).unwrap_err();
        assert!(matches!(error, RareError::Samples { .. }), "{error}");
    }
    for wanted in [0.0, -1.0, f64::NAN] {
        let error = rare(&problem, &options.clone().with_until(wanted)).unwrap_err();
        assert!(matches!(error, RareError::Simulation(SimulationError::Wanted { .. })), "{error}");
    }
    // Nothing varies: the result is None.
    let still = limited(Problem::new(standard(1), Closure::scalar("y", |_| 4.0)).unwrap(), None, Some(5.0));
    assert_eq!(sides(&rare(&still, &options).unwrap()), [None, None]);
    let nowhere =
        limited(Problem::new(standard(1), refusing(|x| x[0], |x| x[0].abs() < 0.1)).unwrap(), None, Some(5.0));
    assert!(matches!(
        rare(&nowhere, &options).unwrap_err(),
        RareError::Simulation(SimulationError::NoSurrogate { .. })
    ));
    // The limit is so far away that no double holds its probability. No point lies there, and the result states it.
    let far = rare(&limited(line(), None, Some(60.0)), &options).unwrap();
    let [_, above] = sides(&far);
    assert!(above.clone().is_some_and(|above| above.probability.is_none() && above.interval[0] == 0.0), "{above:?}");
}

#[test]
fn the_command_reports_it() {
    let blocks = "examples/stacked-blocks/study.toml";
    let mut all = run(&["simulate", blocks, "--rare", "--samples", "2000"]);
    for wrong in [
        &["simulate", blocks, "--rare", "--control-variate"][..],
        &["simulate", blocks, "--rare", "--sampler", "sobol"],
        &["simulate", blocks, "--rare", "--target-yield-error", "0.1"],
        &["simulate", blocks, "--rare", "--samples", "20"],
        &["simulate", "examples/engine-balance/study.toml", "--rare"],
        &["simulate", blocks, "--method", "full"],
        &["simulate", blocks, "--rare", "--method", "three-point"],
    ] {
        all += &format!("$ {}\n{}", wrong.join(" "), run(wrong));
    }
    insta::assert_snapshot!("rare", all);
    let folder = tempfile::tempdir().unwrap();
    let csv = folder.path().join("rare");
    let to = csv.display().to_string();
    let output =
        sensitol(&["simulate", blocks, "--rare", "--samples", "2000", "--json", "--csv", &to]).output().unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["method"], "importance-sampling");
    let above = &report["characteristics"][0]["above"];
    assert!(above["probability"].as_f64().unwrap() > 0.0 && above["design_point"]["distance"].as_f64().unwrap() > 1.0);
    let table = std::fs::read_to_string(csv.join("rare.csv")).unwrap();
    assert_eq!(table.lines().count(), 3);
}

/// Limits on the far side of the means: nearly everything lies below the lower one. The remainder has an estimate of its own, not 1 minus
/// another one.
#[test]
fn limits_on_the_far_side() {
    let function = Closure::scalar("gap", |x: &[f64]| 0.3 * x[0] + 0.4 * x[1]);
    let problem = limited(Problem::new(standard(2), function).unwrap(), Some(2.0), Some(2.5));
    let truth = tail(4.0) - tail(5.0);
    let mut held = 0;
    for seed in 0..20 {
        let found = found(&problem, 900, seed, Method::Full);
        let one = &found.characteristics[0];
        let [low, high] = one.yield_interval.unwrap();
        assert!(0.0 < low && high < 2.0 * truth, "{low} {high}");
        assert!(low <= one.yield_.unwrap() && one.yield_.unwrap() <= high);
        held += usize::from(low <= truth && truth <= high);
        let below = one.below.as_ref().unwrap();
        assert!(below.probability.unwrap() <= 1.0 && below.interval[1] <= 1.0 && below.hits > 0, "{below:?}");
    }
    // 20 seeds of 95 % intervals: fewer than 16 have probability 1/400.
    assert!(held >= 16, "{held}");
}

/// Weights of 1e-250, whose squares underflow: estimates beyond 27 sigma are bounds, and the yield is that of the other side.
#[test]
fn a_limit_that_is_out_of_reach_is_a_bound() {
    let line = || Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap();
    for distance in [28.0, 33.0, 100.0] {
        let found = found(&limited(line(), Some(-distance), Some(4.0)), 500, 1, Method::Full);
        let one = &found.characteristics[0];
        let (below, above) = (one.below.as_ref().unwrap(), one.above.as_ref().unwrap());
        assert!(below.probability.is_none() && below.interval[0] == 0.0 && below.interval[1] < 1e-7, "{below:?}");
        let rejected = 1.0 - one.yield_.unwrap();
        assert!((rejected / above.probability.unwrap() - 1.0).abs() < 1e-9, "{rejected}");
        let [low, high] = one.yield_interval.unwrap();
        assert!(low <= 1.0 - tail(4.0) && 1.0 - tail(4.0) <= high, "{low} {high}");
    }
    // A physical limit 100 sigma away. 75 of the explored points have eight times the spread. A half-space that none of them meets is at
    // least 8 Phi^-1(0.025^(1/75)) = 13 sigma away, which has probability 6e-39.
    let size = Problem::new([Dimension::normal("size", 10.0, 0.3).unwrap()], Closure::scalar("y", |x| x[0])).unwrap();
    let natural = found(&limited(size, Some(0.0), Some(10.4)), 500, 1, Method::Full);
    let one = &natural.characteristics[0];
    let below = one.below.as_ref().unwrap();
    assert!(below.probability.is_none() && below.hits == 0 && below.interval[1] < 4e-16, "{below:?}");
    let [low, high] = one.yield_interval.unwrap();
    assert!(low <= 1.0 - tail(4.0) && 1.0 - tail(4.0) <= high && 1.0 - low < 2.0 * tail(4.0), "{low} {high}");
    assert!(one.yield_.is_some_and(|value| low <= value && value <= high));
    // If the surrogate reaches the limit, its points have the bound of the smallest probability. The interval has what the explored
    // points leave open: a half-space that none of them met, because nothing but the surrogate excludes it.
    let [below, _] = sides(&found(&limited(line(), Some(-28.0), None), 500, 1, Method::Full));
    let below = below.unwrap();
    assert!(below.hits > 0 && below.probability.is_none() && below.interval[1] < 1e-7, "{below:?}");
    assert_eq!(below.interval, [0.0, below.unmet.unwrap().most]);
    // At 20 sigma there is an estimate, with finite figures.
    let [below, _] = sides(&found(&limited(line(), Some(-20.0), None), 500, 1, Method::Full));
    let (below, truth) = (below.unwrap(), tail(20.0));
    assert!(below.interval[0] <= truth && truth <= below.interval[1], "{below:?}");
    assert!(below.effective_samples > 30.0 && below.greatest_part.unwrap() < 0.1, "{below:?}");
}
