//! Tolerance allocation: free tolerances and lists of processes, from the first analysis to the confirmed optimum.

use criterion::{Criterion, criterion_group, criterion_main};
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::allocation::{AllocationOptions, AllocationTask, Curve, Offer, Priced, Status, allocate};
use sensitol::{Characteristic, Closure, Dimension, Method, Options, Problem, Requirement, SpecLimits};

fn numbers(rng: &mut Xoshiro256PlusPlus, n: usize, low: f64, high: f64) -> Vec<f64> {
    (0..n).map(|_| rng.random_range(low..high)).collect()
}

/// Three sums with a little curvature and, of neighbours, interaction.
fn curved(n: usize) -> Problem {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(n as u64);
    let slopes: [Vec<f64>; 3] = std::array::from_fn(|_| numbers(&mut rng, n, -2.0, 2.0));
    let reach = slopes.each_ref().map(|slopes| 0.1 * slopes.iter().map(|slope| slope * slope).sum::<f64>().sqrt());
    let function = Closure::new(["u", "v", "w"], move |x| {
        std::array::from_fn(|k| {
            let line: f64 = slopes[k].iter().zip(x).map(|(slope, x)| slope * x).sum();
            let around: f64 = x.iter().zip(x.iter().skip(1)).map(|(a, b)| a * b).sum();
            let bent: f64 = x.iter().map(|x| x * x).sum();
            line + 0.3 * around + 0.2 * bent
        })
    });
    let asked = ["u", "v", "w"].into_iter().zip(reach).map(|(name, reach)| {
        Characteristic::new(name).with_limits(SpecLimits::new(Some(-0.9 * reach), Some(0.9 * reach)).unwrap())
    });
    let dimensions = (0..n).map(|d| Dimension::normal(format!("x{d}"), 0.0, 0.1).unwrap());
    Problem::new(dimensions, function).unwrap().asking(asked).unwrap()
}

/// A sum with room for tolerances of 0.08, by the root of the sum of squares or by the sum itself.
fn linear(n: usize, worst_case: bool) -> Problem {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(n as u64);
    let slopes = numbers(&mut rng, n, 0.2, 2.0);
    let squares = slopes.iter().map(|slope| slope * slope).sum::<f64>();
    let room = 0.08 * if worst_case { slopes.iter().sum() } else { squares.sqrt() };
    let function = Closure::scalar("y", move |x| slopes.iter().zip(x).map(|(slope, x)| slope * x).sum());
    let limits = SpecLimits::new(Some(-room), Some(room)).unwrap();
    let dimensions = (0..n).map(|d| Dimension::normal(format!("x{d}"), 0.0, 0.1).unwrap());
    Problem::new(dimensions, function).unwrap().asking([Characteristic::new("y").with_limits(limits)]).unwrap()
}

fn free(n: usize) -> Vec<Priced> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(7);
    let one = |d: usize| {
        let curve = Curve::reciprocal_power(1.0, rng.random_range(0.05..0.5), rng.random_range(0.4..1.2)).unwrap();
        Priced::new(vec![d], vec![Offer::between(curve, 0.01, 1.0).unwrap()]).unwrap()
    };
    (0..n).map(one).collect()
}

fn processes(n: usize, count: usize) -> Vec<Priced> {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(9);
    let one = |d: usize| {
        let mut tolerances = numbers(&mut rng, count, 0.02, 0.3);
        let mut costs = numbers(&mut rng, count, 1.0, 20.0);
        tolerances.sort_by(|a, b| b.total_cmp(a));
        costs.sort_by(f64::total_cmp);
        let offers = tolerances.iter().zip(&costs).enumerate();
        let offer = |(index, (&t, &cost)): (usize, (&f64, &f64))| Offer::process(format!("p{index}"), t, cost).unwrap();
        Priced::new(vec![d], offers.map(offer).collect()).unwrap()
    };
    (0..n).map(one).collect()
}

fn allocation(c: &mut Criterion) {
    let mut group = c.benchmark_group("allocation");
    group.sample_size(10);
    let mut run = |name: &str, problem: Problem, method: Method, priced: Vec<Priced>, requirement: Requirement| {
        // Nothing proves that several curved yields have no other optimum.
        let curved_yield = problem.characteristics().len() > 1;
        let requirements = vec![Some(requirement); problem.characteristics().len()];
        let task = AllocationTask::new(priced, requirements);
        let options = AllocationOptions::default().with_analysis(Options::from(method));
        let found = allocate(&problem, &task, &options).unwrap();
        let expected = if curved_yield { Status::LocalOptimum } else { Status::Optimal };
        assert_eq!(found.status, expected, "{name}: {:?}", found.proof);
        println!(
            "{name}: {} rounds, {} evaluations, residual {:?}, {} nodes",
            found.rounds, found.run.evaluations, found.proof.residual, found.proof.nodes
        );
        group.bench_function(name, |b| b.iter(|| allocate(&problem, &task, &options).unwrap()));
    };
    run("yield of 3, N = 20, full", curved(20), Method::Full, free(20), Requirement::Yield(0.9973));
    run("yield of 3, N = 100, six-n", curved(100), Method::SixN, free(100), Requirement::Yield(0.9973));
    run("rss, N = 20", linear(20, false), Method::Rss, free(20), Requirement::Rss);
    run("rss, N = 200", linear(200, false), Method::Rss, free(200), Requirement::Rss);
    run("rss, N = 1000", linear(1000, false), Method::Rss, free(1000), Requirement::Rss);
    run("yield, N = 200", linear(200, false), Method::SecondOrder, free(200), Requirement::Yield(0.9973));
    run("rss, 20 x 5 processes", linear(20, false), Method::Rss, processes(20, 5), Requirement::Rss);
    run("worst case, 20 x 5 processes", linear(20, true), Method::Rss, processes(20, 5), Requirement::WorstCase);
    group.finish();
}

criterion_group!(benches, allocation);
criterion_main!(benches);
