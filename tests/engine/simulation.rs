//! Simulation: standard errors cover the deviations, and no point is lost.

use std::sync::atomic::{AtomicUsize, Ordering};

use sensitol::assembly::Run;

use sensitol::simulation::{
    Estimate, Sampler, Simulation, SimulationError, SimulationOptions, simulate, simulate_with,
};
use sensitol::{Characteristic, Closure, Problem, SpecLimits, StopReason};
use sensitol_study::Study;
use sensitol_testing::{data, normals, refusing, relative, repository, standard};

const SEEDS: u64 = 200;
/// Number of runs in which the true value lies within two standard errors: 90 to 99 % (95.4 % if they are normal, with a standard deviation
/// of 1.5 % for 200 runs).
const COVERED: std::ops::RangeInclusive<usize> = 180..=199;

fn run(problem: &Problem, samples: u64, sampler: Sampler, seed: u64) -> Simulation {
    simulate(problem, &SimulationOptions::default().with_samples(samples).with_sampler(sampler).with_seed(seed))
        .unwrap()
}

/// True values of a characteristic: mean, sigma, skewness, kurtosis, the 0.00135 quantile, the yield.
pub type Truth = [f64; 6];

/// Returns the number of runs in which each true value lies within two standard errors, or in the interval. Runs without a standard error,
/// because few points decide a figure, are left out, and the others are scaled to as many.
fn covered(problem: &Problem, truth: Truth, samples: u64, sampler: Sampler) -> [usize; 6] {
    let (mut hits, mut told) = ([0; 6], [0; 6]);
    for seed in 0..SEEDS {
        let found = &run(problem, samples, sampler, seed).characteristics[0];
        let moments = [found.mean, found.sigma, found.skewness, found.kurtosis, found.quantiles[0]];
        for (index, estimate) in moments.into_iter().enumerate() {
            let Estimate { value, standard_error } = estimate.unwrap();
            let Some(error) = standard_error else { continue };
            told[index] += 1;
            hits[index] += usize::from((value - truth[index]).abs() <= 2.0 * error);
        }
        let [low, high] = found.yield_.unwrap().interval;
        told[5] += 1;
        hits[5] += usize::from(low <= truth[5] && truth[5] <= high);
    }
    // Every run of these functions has a standard error of mean and sigma.
    assert_eq!(told[..2], [SEEDS as usize; 2]);
    std::array::from_fn(|index| hits[index] * SEEDS as usize / told[index].max(1))
}

/// Product of two lognormal factors with log-sd 0.09 and 0.12: a lognormal distribution with log-sd 0.15, whose moments are known. With a
/// longer tail, a sample of this size does not estimate the error of the kurtosis: at 0.25 two standard errors cover 86 %.
fn lognormal() -> (Problem, Truth) {
    let s: f64 = 0.15;
    let e = (s * s).exp();
    let product = Closure::scalar("y", |x| (0.09 * x[0]).exp() * (0.12 * x[1]).exp());
    let upper = 1.25f64;
    let limits = SpecLimits::new(None, Some(upper)).unwrap();
    let problem = Problem::new(standard(2), product).unwrap().asking([Characteristic::new("y").with_limits(limits)]);
    let truth = [
        (0.5 * s * s).exp(),
        (e * (e - 1.0)).sqrt(),
        (e + 2.0) * (e - 1.0).sqrt(),
        e.powi(4) + 2.0 * e.powi(3) + 3.0 * e.powi(2) - 3.0,
        (-2.999_976_992_703_393 * s).exp(),
        1.0 - 0.5 * libm::erfc(upper.ln() / s / 2f64.sqrt()),
    ];
    (problem.unwrap(), truth)
}

/// Engine balance, with moments by quadrature (tests/data). Quantile and yield of this nearly normal distribution follow from the series of
/// Cornish and Fisher and of Edgeworth. Their error is of the order of the squared skewness, 4e-7.
pub fn engine() -> (Problem, Truth) {
    let study = Study::read(&repository("examples/engine-balance/study.toml")).unwrap();
    let exact = &data("engine-balance.json")["table-3"]["F"];
    let [mean, sigma, skewness, kurtosis] =
        ["mean", "sigma", "skewness", "kurtosis"].map(|name| exact[name].as_f64().unwrap());
    let z = -2.999_976_992_703_393f64;
    let quantile = z + (z * z - 1.0) * skewness / 6.0 + (z.powi(3) - 3.0 * z) * (kurtosis - 3.0) / 24.0;
    let u = 1.5f64;
    let density = (-0.5 * u * u).exp() / (2.0 * std::f64::consts::PI).sqrt();
    let upper_tail = 0.5 * libm::erfc(u / 2f64.sqrt())
        + density * (skewness / 6.0 * (u * u - 1.0) + (kurtosis - 3.0) / 24.0 * (u.powi(3) - 3.0 * u));
    let limits = SpecLimits::new(None, Some(mean + u * sigma)).unwrap();
    let problem = study.problem.asking([Characteristic::new("F").with_limits(limits)]).unwrap();
    (problem, [mean, sigma, skewness, kurtosis, mean + sigma * quantile, 1.0 - upper_tail])
}

#[test]
fn random_standard_errors_cover_the_truth() {
    for (problem, truth) in [engine(), lognormal()] {
        let hits = covered(&problem, truth, 20_000, Sampler::Random);
        assert!(hits.iter().all(|hits| COVERED.contains(hits)), "{hits:?} of {SEEDS}");
    }
}

#[test]
fn quasi_random_standard_errors_cover_the_truth() {
    // The kurtosis of the lognormal distribution needs more points before its replicates estimate the error well.
    for ((problem, truth), samples) in [(engine(), 65_536), (lognormal(), 262_144)] {
        let hits = covered(&problem, truth, samples, Sampler::Sobol);
        assert!(hits.iter().all(|hits| COVERED.contains(hits)), "{hits:?} of {SEEDS}");
    }
}

/// Root mean square errors over 20 seeds, from 2^10 to 2^16 points, fall at least like n^-0.9 for the mean and n^-0.85 for sigma. Random
/// points have n^-0.5.
#[test]
fn quasi_random_errors_fall_faster() {
    let (problem, truth) = engine();
    let errors = |samples: u64| {
        let mut squares = [0.0; 2];
        for seed in 0..20 {
            let found = &run(&problem, samples, Sampler::Sobol, seed).characteristics[0];
            squares[0] += (found.mean.unwrap().value - truth[0]).powi(2);
            squares[1] += (found.sigma.unwrap().value - truth[1]).powi(2);
        }
        squares.map(f64::sqrt)
    };
    let (few, many) = (errors(1 << 10), errors(1 << 16));
    let slopes = [0, 1].map(|i| (few[i] / many[i]).log2() / 6.0);
    assert!(slopes[0] >= 0.9 && slopes[1] >= 0.85, "n^-{:.2} and n^-{:.2}", slopes[0], slopes[1]);
}

#[test]
fn the_number_of_threads_changes_nothing() {
    let (problem, _) = engine();
    for sampler in [Sampler::Random, Sampler::Sobol] {
        let with = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let found = pool.install(|| run(&problem, 100_001, sampler, 3)).characteristics.remove(0);
            (found.mean, found.sigma, found.skewness, found.kurtosis, found.quantiles, found.yield_, found.histogram)
        };
        assert_eq!(with(1), with(3));
    }
}

#[test]
fn every_point_is_counted() {
    let (problem, _) = lognormal();
    let odd = run(&problem, 12_345, Sampler::Random, 1);
    assert_eq!(
        (odd.samples, odd.run.evaluations, odd.run.failed, odd.run.stopped, odd.reached),
        (12_345, 12_345, 0, None, None)
    );
    let histogram = odd.characteristics[0].histogram.as_ref().unwrap();
    assert_eq!(histogram.counts.iter().sum::<u64>(), 12_345);
    // The number of points is 16 replicates of a power of two, at least as many as asked.
    assert_eq!(run(&problem, 12_345, Sampler::Sobol, 1).samples, 16 * 1024);
    assert_eq!(run(&problem, 2, Sampler::Random, 1).samples, 2);
    assert_eq!(run(&problem, 2, Sampler::Sobol, 1).samples, 16);
}

/// A point without a value is counted and reported, and widens the interval of the yield.
#[test]
fn failed_points_bound_the_yield() {
    let limits = SpecLimits::new(Some(-1.0), None).unwrap();
    let problem = Problem::new(standard(1), refusing(|x| x[0], |x| x[0] > 1.0)).unwrap();
    let problem = problem.asking([Characteristic::new("y").with_limits(limits)]).unwrap();
    let found = run(&problem, 50_000, Sampler::Random, 2);
    let one = &found.characteristics[0];
    assert_eq!(one.failed, found.run.failed);
    assert_eq!(one.samples + one.failed, 50_000);
    assert!(one.error.is_some());
    let share = one.yield_.unwrap();
    let rejected = 50_000.0 * one.below.unwrap() * one.samples as f64 / 50_000.0;
    relative(share.bounds[1], 1.0 - rejected / 50_000.0, 1e-12);
    relative(share.bounds[0], 1.0 - (rejected + one.failed as f64) / 50_000.0, 1e-12);
    // The share is Phi(1) - Phi(-1) of Phi(1), within four standard errors.
    relative(share.value, 0.682_689_492 / 0.841_344_746, 4.0 * 0.0019);
}

#[test]
fn nothing_known_is_none() {
    let nowhere = Problem::new(standard(1), refusing(|x| x[0], |_| true)).unwrap();
    let found = run(&nowhere, 1000, Sampler::Random, 1);
    let one = &found.characteristics[0];
    assert_eq!((one.mean, one.sigma, one.yield_, one.range), (None, None, None, None));
    assert_eq!((one.samples, one.failed, found.run.failed), (0, 1000, 1000));
    let still = Problem::new(standard(1), Closure::scalar("y", |_| 4.0)).unwrap();
    let one = run(&still, 1000, Sampler::Random, 1).characteristics.remove(0);
    assert_eq!((one.mean.unwrap().value, one.sigma.unwrap().value, one.skewness, one.kurtosis), (4.0, 0.0, None, None));
    // Ten points do not determine the 0.00135 quantile, and two thousand do not determine its error.
    let (problem, _) = lognormal();
    let quantile = |samples| run(&problem, samples, Sampler::Random, 1).characteristics[0].quantiles[0];
    assert!(quantile(10).is_none());
    assert_eq!(quantile(2000).unwrap().standard_error, None);
}

/// Quantiles of distributions whose sigma does not describe most of the values: a rare part far away, and a tail of a hundred sigmas'
/// width.
#[test]
fn quantiles_do_not_mind_long_tails() {
    // One in a thousand values lies a thousand away. The others are normal with sigma 0.01.
    let far = Closure::scalar("y", |x| if x[1] > 3.090_232_306 { 1000.0 } else { 10.0 + 0.01 * x[0] });
    let problem = Problem::new(standard(2), far).unwrap();
    let found = run(&problem, 1_000_000, Sampler::Random, 1).characteristics.remove(0);
    for (index, z) in [(2, -1.643_8), (3, 0.001_253), (4, 1.648_2)] {
        let quantile = found.quantiles[index].unwrap();
        // The quantile is that of 0.999 of a normal distribution. The standard error is about 0.01 sigma/100.
        let expected = 10.0 + 0.01 * z;
        assert!(
            (quantile.value - expected).abs() <= 4.0 * quantile.standard_error.unwrap() + 1e-6,
            "{index}: {quantile:?}"
        );
        assert!(quantile.standard_error.unwrap() < 1e-4);
    }
    // exp(3 u) has sigma 90 times its mean, and a median of 1.
    let heavy = Problem::new(standard(1), Closure::scalar("y", |x| (3.0 * x[0]).exp())).unwrap();
    let found = run(&heavy, 200_000, Sampler::Random, 1).characteristics.remove(0);
    let [least, _] = found.range.unwrap();
    for (quantile, z) in found.quantiles.into_iter().zip([-3.0f64, -2.326_348, -1.644_854, 0.0]) {
        let quantile = quantile.unwrap();
        assert!(quantile.value >= least && quantile.value > 0.0);
        let off = (quantile.value - (3.0 * z).exp()).abs();
        assert!(off <= 4.0 * quantile.standard_error.unwrap() + 1e-9, "{z}: {quantile:?} {off}");
    }
    let still = Problem::new(standard(1), Closure::scalar("y", |_| 10.0)).unwrap();
    let found = run(&still, 1000, Sampler::Random, 1).characteristics.remove(0);
    assert!(found.quantiles.iter().all(|quantile| quantile.unwrap().value == 10.0));
}

/// A handful of points has estimates, but no standard errors.
#[test]
fn a_handful_has_no_standard_errors() {
    let (problem, _) = lognormal();
    for sampler in [Sampler::Random, Sampler::Sobol] {
        let found = run(&problem, 2, sampler, 1).characteristics.remove(0);
        assert!(found.mean.is_some());
        for estimate in [found.mean, found.sigma, found.skewness, found.kurtosis].into_iter().flatten() {
            assert_eq!(estimate.standard_error, None, "{sampler:?}");
        }
    }
}

#[test]
fn it_goes_on_until_it_is_sure() {
    let (problem, _) = lognormal();
    let options = SimulationOptions::default().with_samples(1 << 40).with_until(0.002);
    let found = simulate(&problem, &options).unwrap();
    let sigma = found.characteristics[0].sigma.unwrap();
    assert!(sigma.standard_error.unwrap() <= 0.002 * sigma.value);
    assert_eq!((found.reached, found.run.stopped), (Some(true), None));
    assert!(found.samples < 1_000_000, "{}", found.samples);
    let options = SimulationOptions::default().with_samples(1 << 40).with_until_yield(0.001);
    let share = simulate(&problem, &options).unwrap().characteristics[0].yield_.unwrap();
    assert!(0.5 * (share.interval[1] - share.interval[0]) <= 0.001);
    // An accuracy for which the points are not enough is reported.
    let options = SimulationOptions::default().with_until(1e-9);
    let short = simulate(&problem, &options).unwrap();
    assert_eq!((short.reached, short.samples), (Some(false), 100_000));
}

#[test]
fn it_stops_when_told_to_and_tells_its_pace() {
    let (problem, _) = lognormal();
    let looks = AtomicUsize::new(0);
    let stop = || (looks.fetch_add(1, Ordering::SeqCst) > 200).then_some(StopReason::Interrupted);
    let run = Run::to_the_end().stopping_when(&stop);
    let options = SimulationOptions::default().with_samples(1 << 40);
    let told = AtomicUsize::new(0);
    let found = simulate_with(&problem, &options, &run, &|pace| {
        told.fetch_add(1, Ordering::SeqCst);
        assert!(pace.samples > 0 && pace.expected == (1u64 << 40) as f64 && pace.expected_s() > 0.0);
    })
    .unwrap();
    assert!(found.run.stopped == Some(StopReason::Interrupted) && found.samples > 0 && told.load(Ordering::SeqCst) > 0);
}

#[test]
fn absurd_wishes_are_refused() {
    let (problem, _) = lognormal();
    let asked = |options: SimulationOptions| simulate(&problem, &options).unwrap_err();
    let default = SimulationOptions::default;
    assert!(matches!(asked(default().with_samples(0)), SimulationError::Samples { .. }));
    assert!(matches!(asked(default().with_samples(u64::MAX)), SimulationError::Samples { .. }));
    assert!(matches!(asked(default().with_until(0.0)), SimulationError::Wanted { .. }));
    let without = Problem::new(standard(1), Closure::scalar("y", |x| x[0])).unwrap();
    let wanted = default().with_until_yield(0.1);
    assert_eq!(simulate(&without, &wanted).unwrap_err(), SimulationError::NoLimits);
    assert!(matches!(asked(default().with_until_yield(f64::NAN)), SimulationError::Wanted { .. }));
}

/// Dimensions that no characteristic depends on, and characteristics that were not asked for, change nothing.
#[test]
fn what_is_not_asked_changes_nothing() {
    let of = |text: &str| {
        let study = Study::from_toml(text, "study.toml").unwrap();
        let found = run(&study.problem, 5000, Sampler::Random, 1).characteristics.remove(0);
        (found.mean, found.sigma)
    };
    let text = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\nb = { nominal = 2, tolerance = 0.1 }\n\
                z = { nominal = 2, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a*b\" }\nw = { formula = \"z\" }\n";
    assert_eq!(
        of(text),
        of(&text.replace("z = { nominal = 2, tolerance = 0.1 }\n", "").replace("w = { formula = \"z\" }\n", ""))
    );
    let problem = Problem::new(normals(&[1.0, 2.0], &[0.1, 0.1]), Closure::scalar("y", |x| x[0] * x[1])).unwrap();
    let found = run(&problem, 5000, Sampler::Random, 1).characteristics.remove(0);
    assert_eq!(of(text), (found.mean, found.sigma));
}
