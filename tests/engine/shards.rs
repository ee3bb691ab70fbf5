//! Shards of a sample: their sums are those of one run, and sums that do not belong together are refused.

use std::sync::atomic::Ordering;

use sensitol::assembly::{Closure, EvaluationError, Run};
use sensitol::method::Method;
use sensitol::simulation::{
    Sampler, Shard, ShardError, ShardSums, Simulation, SimulationOptions, merge_shards, simulate, simulate_shard,
};
use sensitol::summary::StopReason;
use sensitol::{Characteristic, Problem, SpecLimits};
use sensitol_testing::{costly, relative, standard};

/// Two characteristics with limits. A tenth of the assemblies has no value of the second one.
fn problem() -> Problem {
    let model = Closure::fallible(["sum", "product"], |x| {
        if x[0] > 1.2816 {
            return Err(EvaluationError::Refused { message: "does not assemble".into() });
        }
        Ok([x[0] + x[1] + 0.1 * x[2] * x[2], x[1] * x[2]])
    });
    let limits = |low, high| SpecLimits::new(Some(low), Some(high)).unwrap();
    Problem::new(standard(3), model)
        .unwrap()
        .asking([
            Characteristic::new("sum").with_limits(limits(-2.0, 2.5)),
            Characteristic::new("product").with_limits(limits(-1.5, 1.5)),
        ])
        .unwrap()
}

fn shard(problem: &Problem, options: &SimulationOptions, number: u64, count: u64) -> Result<ShardSums, ShardError> {
    simulate_shard(problem, options, Shard::new(number, count)?, &Run::to_the_end(), &|_| {})
}

/// The sums as they are read from a file.
fn through_a_file(sums: &ShardSums) -> ShardSums {
    serde_json::from_str(&serde_json::to_string(sums).unwrap()).unwrap()
}

fn merged(problem: &Problem, options: &SimulationOptions, shards: &[ShardSums]) -> Result<Simulation, ShardError> {
    merge_shards(problem, options, shards, &Run::to_the_end())
}

/// Counts, bins and quantiles of both are the same numbers. Moments differ by the rounding of sums in another order: 1e-12 of a sigma is a
/// thousand times the rounding of 3e5 terms.
fn assert_same(found: &Simulation, whole: &Simulation) {
    assert_eq!((found.samples, found.run.failed), (whole.samples, whole.run.failed));
    for (a, b) in found.characteristics.iter().zip(&whole.characteristics) {
        assert_eq!((a.samples, a.failed, a.below, a.above), (b.samples, b.failed, b.below, b.above));
        assert_eq!((a.range, &a.histogram), (b.range, &b.histogram));
        assert_eq!(a.error.as_ref().map(ToString::to_string), b.error.as_ref().map(ToString::to_string));
        assert_eq!(a.reject_intervals, b.reject_intervals);
        for (a, b) in a.quantiles.iter().zip(&b.quantiles) {
            assert_eq!(a.map(|of| of.value), b.map(|of| of.value));
        }
        let sigma = b.sigma.unwrap().value;
        let [mean, expected] = [a.mean.unwrap(), b.mean.unwrap()];
        assert!((mean.value - expected.value).abs() <= 1e-12 * sigma);
        for (a, b) in [(a.mean, b.mean), (a.sigma, b.sigma), (a.kurtosis, b.kurtosis)] {
            let [a, b] = [a.unwrap(), b.unwrap()];
            assert!((a.value - b.value).abs() <= 1e-10 * b.value.abs().max(sigma));
            // Few values have no error of a high moment.
            assert_eq!(a.standard_error.is_some(), b.standard_error.is_some());
            if let Some((a, b)) = a.standard_error.zip(b.standard_error) {
                relative(a, b, 1e-8);
            }
        }
    }
    let [a, b] = [found.joint.unwrap(), whole.joint.unwrap()];
    assert_eq!((a.value, a.bounds), (b.value, b.bounds));
    for (a, b) in found.correlations.iter().zip(&whole.correlations) {
        assert!((a.value.unwrap() - b.value.unwrap()).abs() < 1e-12);
    }
}

#[test]
fn shards_in_any_order_are_one_run() {
    let problem = problem();
    // No multiple of a portion, and a number of portions that eight does not divide.
    let options = SimulationOptions::default().with_samples(300_001).with_seed(7);
    let whole = simulate(&problem, &options).unwrap();
    for count in [1, 3, 8] {
        let mut shards: Vec<ShardSums> =
            (1..=count).map(|number| shard(&problem, &options, number, count).unwrap()).collect();
        shards.reverse();
        let shards: Vec<ShardSums> = shards.iter().map(through_a_file).collect();
        assert_same(&merged(&problem, &options, &shards).unwrap(), &whole);
        // A shard that was evaluated again has the same sums, on one thread as on several, and counts once.
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        let again = pool.install(|| shard(&problem, &options, count, count).unwrap());
        let twice: Vec<ShardSums> = shards.iter().cloned().chain([again]).collect();
        assert_same(&merged(&problem, &options, &twice).unwrap(), &whole);
    }
}

/// More shards than portions leave some of them without points. Their sums are empty, and change nothing.
#[test]
fn a_shard_may_have_no_points() {
    let problem = problem();
    let options = SimulationOptions::default().with_samples(2000);
    let shards: Vec<ShardSums> = (1..=5).map(|number| shard(&problem, &options, number, 5).unwrap()).collect();
    let shards: Vec<ShardSums> = shards.iter().map(through_a_file).collect();
    assert_same(&merged(&problem, &options, &shards).unwrap(), &simulate(&problem, &options).unwrap());
}

/// Every shard of an external model evaluates its slice of the points, and 64 points for the bins.
#[test]
fn points_of_a_costly_model_are_divided_evenly() {
    let (problem, asked) = costly(&problem());
    let options = SimulationOptions::default().with_samples(1000);
    let mut shards = Vec::new();
    for number in 1..=8 {
        let before = asked.load(Ordering::Relaxed);
        shards.push(through_a_file(&shard(&problem, &options, number, 8).unwrap()));
        let evaluated = asked.load(Ordering::Relaxed) - before;
        assert!((125 + 64..=126 + 64).contains(&evaluated), "{evaluated}");
    }
    let found = merged(&problem, &options, &shards).unwrap();
    let whole = simulate(&problem, &options).unwrap();
    assert_eq!(found.samples, 1000);
    for (a, b) in found.characteristics.iter().zip(&whole.characteristics) {
        assert_eq!((a.samples, a.failed, a.below, a.above, a.range), (b.samples, b.failed, b.below, b.above, b.range));
        relative(a.sigma.unwrap().value, b.sigma.unwrap().value, 1e-10);
    }
}

/// Two portions of a costly model: the slices of both add up to the points of a shard.
#[test]
fn slices_of_several_portions_add_up() {
    let (problem, asked) = costly(&problem());
    let options = SimulationOptions::default().with_samples(5000);
    let shards: Vec<ShardSums> = (1..=3).map(|number| shard(&problem, &options, number, 3).unwrap()).collect();
    assert_eq!(asked.load(Ordering::Relaxed), 5000 + 3 * 64);
    assert_eq!(merged(&problem, &options, &shards).unwrap().samples, 5000);
}

#[test]
fn sums_that_do_not_belong_together_are_refused() {
    let problem = problem();
    let options = SimulationOptions::default().with_samples(5000);
    let first = shard(&problem, &options, 1, 2).unwrap();
    let refused = |shards: &[ShardSums]| merged(&problem, &options, shards).unwrap_err().to_string();
    assert_eq!(refused(&[]), "there are no shards to merge");
    assert_eq!(refused(std::slice::from_ref(&first)), "of 2 shards one is missing: 2");
    let other = shard(&problem, &options.clone().with_seed(3), 2, 2).unwrap();
    assert_eq!(
        refused(&[first.clone(), other]),
        "shard 2 belongs to another sample: its seed is 3, that of the first one 1"
    );
    let other = shard(&problem, &options, 2, 3).unwrap();
    assert!(refused(&[first.clone(), other]).contains("its number of shards is 3, that of the first one 2"));
    let other = shard(&problem, &options.clone().with_samples(6000), 2, 2).unwrap();
    assert!(refused(&[first.clone(), other]).contains("its number of points is 6000"));
    // The same shard of another model has other sums.
    let shifted = Closure::new(["sum", "product"], |x| [x[0] + 1.0, x[1]]);
    let shifted = Problem::new(standard(3), shifted).unwrap().asking(problem.characteristics().to_vec()).unwrap();
    let contradiction = shard(&shifted, &options, 1, 2).unwrap();
    // Every count of a file that was changed by hand contradicts another one.
    let text = serde_json::to_string(&first).unwrap();
    let answered = format!("\"answered\":{}", text.split("\"answered\":").nth(1).unwrap().split(',').next().unwrap());
    for changed in [
        text.replacen(&answered, "\"answered\":10", 1),
        text.replacen(&answered, "\"answered\":18446744073709551615", 1),
        text.replacen("\"failed\":", "\"failed\":7", 1),
        text.replacen("\"bins\":[[", "\"bins\":[[0,500000],[", 1),
    ] {
        assert_ne!(changed, text);
        let changed: ShardSums = serde_json::from_str(&changed).unwrap();
        assert!(refused(&[changed]).contains("shard 1 was changed"));
    }
    assert!(refused(&[first, contradiction]).contains("shard 1 is given twice, and its sums differ"));
}

#[test]
fn options_that_need_one_run_are_refused() {
    let problem = problem();
    let options = SimulationOptions::default().with_samples(5000);
    let mut sobol = options.clone();
    sobol.sobol = Some(64);
    for options in [
        options.clone().with_sampler(Sampler::Sobol),
        options.clone().with_until(0.01),
        options.clone().with_control(Method::Full.into()),
        sobol,
    ] {
        assert!(matches!(shard(&problem, &options, 1, 2), Err(ShardError::OneRun { .. })), "{options:?}");
    }
    for (number, count) in [(0, 3), (4, 3), (1, 0), (1, 1_000_000)] {
        assert!(matches!(Shard::new(number, count), Err(ShardError::NoSuchShard { .. })), "{number} of {count}");
    }
    // A shard that is stopped has no sums.
    let stop = || Some(StopReason::Requested);
    let stopped =
        simulate_shard(&problem, &options, Shard::new(1, 2).unwrap(), &Run::to_the_end().stopping_when(&stop), &|_| {});
    assert!(matches!(stopped, Err(ShardError::Stopped { answered: 0, .. })), "{stopped:?}");
}

/// Values near the largest double are computed in other units within one run, which sums of several runs do not share.
#[test]
fn extreme_values_are_refused() {
    let huge = Problem::new(standard(2), Closure::scalar("y", |x| 1e200 * (x[0] + x[1]))).unwrap();
    let found = shard(&huge, &SimulationOptions::default().with_samples(5000), 1, 2);
    assert_eq!(found.unwrap_err(), ShardError::Extreme);
}
