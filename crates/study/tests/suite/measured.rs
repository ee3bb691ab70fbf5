//! Measured dimensions: their distribution, data files, outliers, and the effect of the sample size on the result.

use std::sync::Arc;

use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::Distribution as _;
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::analysis::Relocation;
use sensitol::distribution::{Distribution, DistributionError, Jacobi, Measured, PearsonLaw, Probability};

use sensitol::{Characteristic, Closure, Dimension, Method, Options, Problem, SpecLimits, analyze};
use sensitol_numeric::distribution::outliers::{extreme, outliers};
use sensitol_numeric::distribution::sample::{Resample, Sample};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Inputs, Surrogate, Univariate};
use sensitol_study::{Study, StudyError};
use sensitol_testing::{close, data, relative, repository};

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// All samples of the oracle with their distributions.
fn oracle() -> Vec<(serde_json::Value, Measured)> {
    let cases = data("measured.json").as_array().unwrap().clone();
    cases
        .into_iter()
        .map(|case| (Measured::new(&numbers(&case["values"])).unwrap(), case))
        .map(|(a, b)| (b, a))
        .collect()
}

#[test]
fn moments_and_quantiles_are_those_of_exact_arithmetic() {
    for (case, law) in oracle() {
        let of = |key: &str| case[key].as_f64().unwrap();
        // The mean is rounded once. The deviations from it do not share that rounding.
        relative(law.mean(), of("mean"), 3e-16);
        relative(law.sigma(), of("sigma"), 1e-15);
        let m = law.standard_moments();
        let found = [m.skewness, m.kurtosis(), m.m5, m.m6, m.m7, m.m8];
        for (order, (found, expected)) in found.into_iter().zip(numbers(&case["moments"])).enumerate() {
            // Odd moments are differences of terms as large as the even moment above them.
            let scale = if order % 2 == 0 { [m.kurtosis(), m.m6, m.m8][order / 2] } else { 0.0 };
            close(found, expected, 2e-14, scale);
        }
        for pair in case["quantiles"].as_array().unwrap() {
            let [p, x] = numbers(pair)[..] else { panic!("a probability and a quantile") };
            assert_eq!(law.quantile(p), x, "{}: {p}", case["name"]);
        }
    }
}

/// A step function has the share of each value, both tails, and both quantile functions at the steps themselves.
#[test]
fn a_staircase_has_its_steps_where_the_values_are() {
    let law = Measured::new(&[3.0, 1.0, 2.0, 2.0, 5.0, 2.0, 1.0]).unwrap();
    let seventh = |k: u32| f64::from(k) / 7.0;
    for (x, below) in [(0.9, 0), (1.0, 2), (1.5, 2), (2.0, 5), (3.0, 6), (4.0, 6), (5.0, 7), (9.0, 7)] {
        assert_eq!((law.cdf(x), law.sf(x)), (seventh(below), seventh(7 - below)), "{x}");
    }
    for (k, x) in [(0, 1.0), (1, 1.0), (2, 1.0), (3, 2.0), (5, 2.0), (6, 3.0), (7, 5.0)] {
        assert_eq!(law.quantile(seventh(k)), x, "{k}/7");
    }
    for (k, x) in [(0, 5.0), (1, 3.0), (2, 2.0), (4, 2.0), (5, 1.0), (7, 1.0)] {
        assert_eq!(law.upper_quantile(seventh(k)), x, "{k}/7");
    }
    assert_eq!((law.quantile(0.3), law.upper_quantile(0.15), law.upper_quantile(1e-12)), (2.0, 3.0, 5.0));
    assert!(law.quantile(1.1).is_nan() && law.upper_quantile(-0.1).is_nan() && law.cdf(f64::NAN).is_nan());
    assert_eq!((law.density(2.0), law.support(), law.name()), (None, [1.0, 5.0], "measured"));
}

proptest! {
    /// `quantile` is the least value with at least this probability, `upper_quantile` the least with at most this probability above it.
    #[test]
    fn quantiles_are_the_least_values(values in prop::collection::vec(-5..5i32, 5..40), p in 0.0..1.0f64, n in 0..40u32) {
        let values: Vec<f64> = values.into_iter().map(f64::from).collect();
        prop_assume!(values.iter().any(|&value| value != values[0]));
        let law = Measured::new(&values).unwrap();
        let step = f64::from(n).min(values.len() as f64) / values.len() as f64;
        for p in [p, step] {
            let enough = |x: &&f64| law.cdf(**x) >= p;
            let least = values.iter().filter(enough).copied().fold(f64::INFINITY, f64::min);
            prop_assert_eq!(law.quantile(p), least);
            let least = values.iter().filter(|&&x| law.sf(x) <= p).copied().fold(f64::INFINITY, f64::min);
            prop_assert_eq!(law.upper_quantile(p), least);
        }
    }

    /// Shifted and scaled values change mean and sigma only.
    #[test]
    fn shape_has_no_unit(values in prop::collection::vec(-1.0..1.0f64, 5..60), power in -6..6i32, offset in -10.0..10.0f64) {
        let base = Measured::new(&values);
        prop_assume!(base.as_ref().is_ok_and(|law| law.sigma() > 1e-3));
        let base = base.unwrap();
        let scale = 10f64.powi(power);
        let moved: Vec<f64> = values.iter().map(|value| scale * (value + offset)).collect();
        let moved = Measured::new(&moved).unwrap();
        relative(moved.sigma(), scale * base.sigma(), 1e-11);
        // The moved values are rounded to 1e-15 of 11, in sigmas of 1e-3 at worst 1e-11, eightfold in the eighth moment.
        close(moved.standard_moments().m8, base.standard_moments().m8, 1e-9, 0.0);
    }
}

/// Gauss rules of atoms integrate the atoms' moments. A rule with as many nodes as atoms consists of the atoms.
#[test]
fn rules_of_atoms_are_exact() {
    for (case, law) in oracle() {
        let sample = law.sample();
        for order in 1..=9 {
            let jacobi = law.jacobi(order);
            let rule = jacobi.gauss();
            assert_eq!(jacobi.order(), order.min(sample.values().len()), "{}", case["name"]);
            for degree in 0..2 * order as i32 {
                let power = |u: f64| u.powi(degree);
                let counted = sample.standard().iter().zip(sample.counts());
                let exact: f64 =
                    counted.map(|(&u, &count)| f64::from(count) * power(u)).sum::<f64>() / sample.len() as f64;
                let size: f64 = rule.mean(|u| u.abs().powi(degree));
                // Nodes are accurate to about 1e-15, and their powers to `degree` times that, 17 at most.
                close(rule.mean(power), exact, 1e-12, size.max(1.0));
            }
        }
        let whole = law.jacobi(1000);
        assert_eq!(whole.order(), sample.values().len());
        for (node, u) in whole.gauss().nodes.iter().zip(sample.standard()) {
            close(*node, *u, 1e-12, 1.0);
        }
        assert!(whole.gauss_with_mean().is_none() || sample.values().len() > 5, "the atoms are all that there is");
        // The same five points follow from the moments, if there are enough atoms.
        if sample.values().len() > 5 {
            let by_moments = Jacobi::from_moments(&law.standard_moments()).unwrap();
            for (a, b) in law.jacobi(4).gauss().nodes.iter().zip(by_moments.gauss().nodes) {
                close(*a, b, 1e-9, 1.0);
            }
        }
    }
}

/// Resamples consist of the sample's own values, each with the same probability.
#[test]
fn resamples_are_of_the_values() {
    let law = Measured::new(&[1.0, 2.0, 2.0, 4.0]).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(3);
    let mut drawn = vec![0.0; 40_000];
    law.fill(&mut rng, &mut drawn);
    for (value, share) in [(1.0, 0.25), (2.0, 0.5), (4.0, 0.25)] {
        let found = drawn.iter().filter(|&&x| x == value).count() as f64 / 40_000.0;
        // Four standard errors of a share of one half.
        close(found, share, 0.01, 1.0);
    }
    let mut counts = Vec::new();
    law.sample().draw(&mut rng, &mut counts);
    assert_eq!((counts.len(), counts.iter().sum::<u32>()), (3, 4));
    // A resample with the original counts is the sample itself.
    let same = law.reweighted(law.sample().counts());
    close(same.shift, 0.0, 1e-15, 1.0);
    relative(same.stretch, 1.0, 1e-15);
    relative(same.moments.m8, law.standard_moments().m8, 1e-14);
    let one = law.reweighted(&[0, 3, 0]);
    assert_eq!(one.stretch, 0.0);
    relative(one.shift, (2.0 - law.mean()) / law.sigma(), 1e-15);
}

#[test]
fn values_that_are_no_sample_are_refused() {
    let error = |values: &[f64]| Sample::new(values).unwrap_err().to_string();
    assert_eq!(error(&[]), "there are no values");
    assert_eq!(error(&[2.5]), "one value, 2.5, does not vary");
    assert_eq!(error(&[2.5, 2.5, 2.5]), "all 3 values are 2.5: nothing varies");
    assert_eq!(error(&[2.5, f64::NAN]), "a measured value must be a finite number, not NaN");
    assert_eq!(error(&[1.0, f64::INFINITY]), "a measured value must be a finite number, not inf");
    assert!(matches!(Measured::new(&[-1.5e308, 1.5e308]), Err(DistributionError::NotFinite { .. })));
    let fit = |values: &[f64]| PearsonLaw::fitted(values).unwrap_err().to_string();
    assert!(fit(&[1.0, 1.0, 2.0, 2.0, 2.0]).starts_with("no Pearson law fits: with skewness"), "{}", fit(&[1.0, 2.0]));
    let mut long: Vec<f64> = (0..100).map(|i| f64::from(i % 10)).collect();
    long.extend([-60.0, 60.0, -70.0, 70.0]);
    assert!(fit(&long).contains("so long that its moment of order 5 is infinite"), "{}", fit(&long));
    // Student's t with 7 degrees of freedom has an infinite seventh moment, and an excess of 6/(7 - 4).
    let edge = |freedom: f64| PearsonLaw::new(0.0, 1.0, 0.0, 6.0 / (freedom - 4.0)).err();
    assert!(matches!(edge(7.0), Some(DistributionError::InfiniteMoment { order: 7, .. })));
    assert!(matches!(edge(7.9), Some(DistributionError::InfiniteMoment { order: 8, .. })));
    assert!(edge(8.1).is_none());
}

/// Moment by Simpson's rule in `t` with `z = sinh t`, so that a power tail decays exponentially: accurate to 1e-11 here.
fn integrated(law: &PearsonLaw, order: i32) -> f64 {
    let (mean, sigma) = (law.mean(), law.sigma());
    let steps = 40_000;
    let term = |i: i32| {
        let t = -40.0 + 80.0 * f64::from(i) / f64::from(steps);
        let z = t.sinh();
        let density = sigma * law.density(mean + sigma * z).unwrap();
        if density == 0.0 { 0.0 } else { z.powi(order) * density * t.cosh() }
    };
    let sum: f64 = (1..steps).map(|i| term(i) * if i % 2 == 0 { 2.0 } else { 4.0 }).sum();
    sum * 80.0 / f64::from(steps) / 3.0
}

/// One distribution of each type with a density that is smooth at its ends, as Simpson's rule requires.
#[test]
fn moments_of_a_pearson_law_are_those_of_its_density() {
    for (skewness, excess) in
        [(0.0, 0.0), (0.3, -0.2), (-0.3, 0.0), (0.0, -0.4), (0.2, 0.06), (-0.4, 0.5), (0.0, 0.8), (0.6, 0.75)]
    {
        let law = PearsonLaw::new(2.0, 0.5, skewness, excess).unwrap();
        let m = law.standard_moments();
        assert_eq!(
            (law.name(), law.mean(), law.sigma(), m.skewness, m.excess),
            ("pearson", 2.0, 0.5, skewness, excess)
        );
        let found = [m.skewness, m.kurtosis(), m.m5, m.m6, m.m7, m.m8];
        for (order, found) in (3..).zip(found) {
            close(found, integrated(&law, order), 1e-9, 1.0);
        }
        // The closed form of the recurrence against the recurrence from the moments.
        let by_moments = Jacobi::from_moments(&m).unwrap().gauss();
        let rule = law.jacobi(4).gauss();
        for (a, b) in rule.nodes.iter().zip(by_moments.nodes) {
            close(*a, b, 1e-10, 1.0);
        }
        for degree in 0..=8 {
            let expected = [1.0, 0.0, 1.0, found[0], found[1], found[2], found[3], found[4], found[5]][degree];
            close(law.jacobi(5).gauss().mean(|u| u.powi(degree as i32)), expected, 1e-11, m.m8);
        }
        // Degree 16 of nine nodes, beyond the moments in closed form, if that moment exists.
        if law.jacobi(9).order() == 9 {
            let sixteen = law.jacobi(9).gauss().mean(|u| u.powi(16));
            relative(sixteen, integrated(&law, 16), 1e-8);
        }
    }
}

/// Uniform, beta and gamma distributions belong to the system. Their moments are known in closed form.
#[test]
fn known_members_have_their_moments() {
    let uniform = PearsonLaw::new(0.0, 1.0, 0.0, -1.2).unwrap();
    let m = uniform.standard_moments();
    for (found, expected) in [(m.m5, 0.0), (m.m6, 27.0 / 7.0), (m.m7, 0.0), (m.m8, 9.0)] {
        close(found, expected, 1e-14, 1.0);
    }
    for (n, beta) in (1..=9).zip(sensitol::distribution::Uniform::new(0.0, 1.0).unwrap().jacobi(9).gauss().nodes) {
        close(uniform.jacobi(9).gauss().nodes[n - 1], beta, 1e-13, 1.0);
    }
    // Gamma with shape 4: skewness 1, excess 1.5; cumulants (r-1)! 4 / 2^r about the mean.
    let gamma = PearsonLaw::new(4.0, 2.0, 1.0, 1.5).unwrap();
    let [k3, k4, k5, k6] = [1.0, 1.5, 3.0, 7.5];
    relative(gamma.standard_moments().m5, k5 + 10.0 * k3, 1e-14);
    relative(gamma.standard_moments().m6, k6 + 15.0 * k4 + 10.0 * k3 * k3 + 15.0, 1e-14);
    // Laguerre: alpha_n = 2n + a + 1, beta_n = n (n + a) with a = 3, in sigmas of 2 about 4.
    for n in 1..=3 {
        let nodes = gamma.jacobi(n).gauss();
        let trace: f64 = nodes.nodes.iter().sum();
        let expected: f64 = (0..n).map(|i| i as f64).sum();
        close(trace, expected, 1e-13, 1.0);
    }
}

#[test]
fn a_fitted_law_has_the_moments_of_the_values() {
    for (case, law) in oracle() {
        if ["normal", "gamma", "offset", "rounded"].contains(&case["name"].as_str().unwrap()) {
            let fitted = PearsonLaw::fitted(&numbers(&case["values"])).unwrap();
            let (own, of_values) = (fitted.standard_moments(), law.standard_moments());
            assert_eq!((fitted.mean(), fitted.sigma()), (law.mean(), law.sigma()));
            assert_eq!((own.skewness, own.excess), (of_values.skewness, of_values.excess));
            let fit = fitted.measured().unwrap();
            let same = fit.reweighted(fit.sample().counts());
            relative(same.moments.m8, own.m8, 1e-11);
            // A step in the last digit of x moves the probability by the density times that step.
            let x = fitted.quantile(0.01);
            let last = f64::EPSILON * x.abs() * fitted.density(x).unwrap();
            close(fitted.cdf(x), 0.01, 1e-10 + last / 0.01, 0.0);
        }
    }
}

/// Samples follow the fitted distribution: Kolmogorov's statistic of 20 000 values stays below its 1e-4 quantile.
#[test]
fn samples_follow_the_fitted_law() {
    let law = PearsonLaw::new(1.0, 0.2, 0.8, 1.1).unwrap();
    let mut sample = vec![0.0; 20_000];
    law.fill(&mut Xoshiro256PlusPlus::seed_from_u64(8), &mut sample);
    sample.sort_unstable_by(f64::total_cmp);
    let n = sample.len() as f64;
    let distance =
        |(i, &x): (usize, &f64)| (law.cdf(x) - i as f64 / n).abs().max(((i + 1) as f64 / n - law.cdf(x)).abs());
    let statistic = n.sqrt() * sample.iter().enumerate().map(distance).fold(0.0, f64::max);
    // P(sqrt(n) D > 2.23) = 2 exp(-2 x 2.23^2) = 1e-4.
    assert!(statistic < 2.23, "{statistic}");
}

/// Rosner's data (1983), as in the NIST/SEMATECH e-Handbook of Statistical Methods, 1.3.5.17.3: three outliers at 5 %.
const ROSNER: [f64; 54] = [
    -0.25, 0.68, 0.94, 1.15, 1.20, 1.26, 1.26, 1.34, 1.38, 1.43, 1.49, 1.49, 1.55, 1.56, 1.58, 1.65, 1.69, 1.70, 1.76,
    1.77, 1.81, 1.91, 1.94, 1.96, 1.99, 2.06, 2.09, 2.10, 2.14, 2.15, 2.23, 2.24, 2.26, 2.35, 2.37, 2.40, 2.47, 2.54,
    2.62, 2.64, 2.90, 2.92, 2.92, 2.93, 3.21, 3.26, 3.30, 3.59, 3.68, 4.30, 4.64, 5.34, 5.42, 6.01,
];

#[test]
fn outliers_are_those_of_the_published_example() {
    assert_eq!(extreme(&ROSNER, 0.05, 10), [53, 52, 51]);
    assert_eq!(extreme(&ROSNER, 0.05, 2), Vec::<usize>::new(), "the first two hide behind the third");
    assert_eq!(outliers(&[1.0; 40]), Vec::<usize>::new());
    assert_eq!(outliers(&[1.0, 2.0, 3.0, 90.0]), Vec::<usize>::new(), "too few to tell");
}

/// Outliers are reported in 1 % of clean samples of any size. Of 400 samples these are 4. A count of 14 or more has the probability 1/15
/// 000.
#[test]
fn clean_samples_are_rarely_named() {
    for (n, seed) in [(20, 1), (100, 2), (1000, 3)] {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut clean = || (0..n).map(|_| rand_distr::StandardNormal.sample(&mut rng)).collect::<Vec<f64>>();
        let alarms = (0..400).filter(|_| !outliers(&clean()).is_empty()).count();
        assert!((0..14).contains(&alarms), "{alarms} of 400 samples of {n}");
        let mut two = clean();
        (two[4], two[11]) = (9.0, 9.1);
        assert_eq!(outliers(&two)[..2], [11, 4], "two that hide one another");
    }
}

/// A problem with one measured dimension `x` and a normal `z`: a straight and a curved characteristic with an interaction.
fn problem(x: Dimension) -> Problem {
    let both = Closure::new(["straight", "curved"], |x| [x[0] - x[1], x[0] + 0.3 * x[0] * x[0] + 0.2 * x[0] * x[1]]);
    Problem::new([x, Dimension::normal("z", 0.0, 3.0).unwrap()], both).unwrap()
}

/// Number of samples whose intervals hold the true mean, sigma, skewness and kurtosis, for both characteristics.
fn coverage(truth: &PearsonLaw, n: usize, samples: usize) -> [[usize; 4]; 2] {
    let dimension = |law: Arc<dyn Distribution>| Dimension::distributed("x", 0.0, None, law).unwrap();
    let exact = analyze(&problem(dimension(Arc::new(truth.clone()))), &Method::Full.into()).unwrap();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(n as u64);
    let mut held = [[0; 4]; 2];
    let mut values = vec![0.0; n];
    for _ in 0..samples {
        truth.fill(&mut rng, &mut values);
        let measured = Measured::new(&values).unwrap();
        let found = analyze(&problem(dimension(Arc::new(measured))), &Method::Full.into()).unwrap();
        for ((held, exact), found) in held.iter_mut().zip(&exact.characteristics).zip(&found.characteristics) {
            let (exact, found) = (exact.moments.unwrap(), found.evidence.sampling.as_ref().unwrap());
            let truths = [exact.mean(), exact.sigma(), exact.skewness().unwrap(), exact.kurtosis().unwrap()];
            let intervals = [found.mean, found.sigma, found.skewness, found.kurtosis];
            for ((held, truth), interval) in held.iter_mut().zip(truths).zip(intervals) {
                let [low, high] = interval.unwrap();
                *held += usize::from(low <= truth && truth <= high);
            }
        }
    }
    held
}

/// The intervals hold the true value in the share that the documentation of `SamplingInterval` states, less four standard errors of a share
/// of 100 samples. The worst case is sigma of a curved characteristic with a skewed sample of 50.
#[test]
fn intervals_cover_the_truth() {
    let mut cells = Vec::new();
    for (shape, n, least) in [
        ((0.0, 0.0), 50, [[82, 82], [79, 72]]),
        ((0.0, 0.0), 200, [[86, 82], [82, 78]]),
        ((1.2, 2.16), 50, [[84, 76], [81, 62]]),
        ((1.2, 2.16), 200, [[84, 79], [80, 69]]),
    ] {
        let truth = PearsonLaw::new(0.0, 1.0, shape.0, shape.1).unwrap();
        let held = coverage(&truth, n, 300);
        for (held, least) in held.iter().zip(least) {
            assert!(held[0] >= 3 * least[0] && held[1] >= 3 * least[1], "{shape:?} {n}: {held:?} of 300");
        }
        cells.push(held);
    }
    let mut table =
        String::from("| | | normal, 50 values | 200 | skewed, 50 values | 200 |\n|---|---|--:|--:|--:|--:|\n");
    for (which, what) in ["linear", "quadratic"].into_iter().enumerate() {
        for (moment, name) in ["mean", "sigma"].into_iter().enumerate() {
            let shares: Vec<String> =
                cells.iter().map(|held| format!("{:.0} %", held[which][moment] as f64 / 3.0)).collect();
            let what = if moment == 0 { format!(" {what} ") } else { " ".to_owned() };
            table += &format!("|{what}| {name} | {} |\n", shares.join(" | "));
        }
    }
    sensitol_testing::generated("docs/how-to/measured-data.md", "coverage", &table);
}

/// The characteristic is one measured dimension. The intervals are compared with another implementation with 100 000 resamples.
#[test]
fn intervals_are_those_of_another_implementation() {
    for (case, law) in oracle().into_iter().take(2) {
        let x = Dimension::distributed("x", 0.0, None, Arc::new(law)).unwrap();
        let problem = Problem::new([x], Closure::scalar("y", |x| x[0])).unwrap();
        let found = analyze(&problem, &Method::SecondOrder.into())
            .unwrap()
            .characteristics
            .remove(0)
            .evidence
            .sampling
            .unwrap();
        assert_eq!((found.resamples, found.level, found.rejected, found.cpk), (1000, 0.95, None, None));
        for (name, interval) in
            [("mean", found.mean), ("sigma", found.sigma), ("skewness", found.skewness), ("kurtosis", found.kurtosis)]
        {
            let expected = numbers(&case["bca"][name]);
            for (found, expected_end) in interval.unwrap().into_iter().zip(&expected) {
                // The end of an interval from 1000 resamples scatters by some hundredths of its width. The end for a kurtosis, far out in a
                // long tail, scatters by a tenth.
                let far = if name == "kurtosis" { 0.3 } else { 0.1 };
                assert!(
                    (found - expected_end).abs() <= far * (expected[1] - expected[0]),
                    "{name}: {found} for {expected:?}"
                );
            }
        }
    }
}

proptest! {
    /// A surrogate with moved inputs is the same function, with parts of any degree and with dense or sparse products.
    #[test]
    fn a_relocated_surrogate_is_the_same_function(
        numbers in prop::collection::vec(-1.0..1.0f64, 200),
        n in 1..10usize,
        dense in any::<bool>(),
    ) {
        let mut numbers = numbers.into_iter();
        let mut next = || numbers.next().unwrap();
        let parts: Vec<_> = (0..n).map(|j| Some(Univariate::of_coefficients(&[next(), next(), next(), next()][..1 + j % 4]))).collect();
        let pairs: Vec<_> = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k)))
            .filter(|(j, k)| dense || (j + k) % 5 == 0)
            .map(|(j, k)| (j, k, next()))
            .collect();
        let surrogate = Surrogate { centre: next(), parts, interactions: Interactions::of_pairs(n, pairs) };
        let moved: Vec<Relocation> = (0..n)
            .map(|j| if j % 3 == 2 { Relocation::NONE } else { Relocation { shift: next(), stretch: 1.0 + 0.5 * next() } })
            .collect();
        let v: Vec<f64> = (0..n).map(|_| 3.0 * next()).collect();
        let u: Vec<f64> = moved.iter().zip(&v).map(|(to, v)| to.shift + to.stretch * v).collect();
        let value = |surrogate: &Surrogate, at: &[f64]| {
            let own: f64 = surrogate.parts.iter().zip(at).map(|(part, &u)| part.unwrap().value(u)).sum();
            let products: f64 = surrogate.interactions.pairs().into_iter().map(|(j, k, a)| a * at[j] * at[k]).sum();
            surrogate.centre + own + products
        };
        // The sum has some hundred terms of up to 5^4.
        close(value(&surrogate.relocated(&moved), &v), value(&surrogate, &u), 1e-12, 1000.0);
    }
}

/// Moments of a resample by the surrogate, a cubic with a product, equal those of enumeration over the resampled values.
#[test]
fn resampled_moments_are_those_of_enumeration() {
    let values = [1.0, 1.5, 2.0, 2.0, 2.5, 4.0, 4.5, 3.0];
    let law = Measured::new(&values).unwrap();
    let coin = Measured::new(&[-1.0, 1.0]).unwrap();
    let surrogate = Surrogate {
        centre: 2.0,
        parts: vec![
            Some(Univariate::of_coefficients(&[1.0, 0.4, -0.2])),
            Some(Univariate::of_coefficients(&[0.5, 0.3])),
        ],
        interactions: Interactions::of_pairs(2, [(0, 1, 0.7)]),
    };
    let counts = [3, 0, 1, 2, 0, 1, 1];
    let to = law.reweighted(&counts);
    let moved = [Relocation { shift: to.shift, stretch: to.stretch }, Relocation::NONE];
    let shapes = [
        sensitol_numeric::surrogate::InputShape { moments: to.moments, rule: Arc::new(to.rule) },
        sensitol_numeric::surrogate::shapes([&coin as &dyn Distribution]).remove(0),
    ];
    let found = surrogate.relocated(&moved).contributions(&Inputs::independent(shapes.to_vec())).unwrap().moments;
    let mut outcomes = Vec::new();
    for (&u, &count) in law.sample().standard().iter().zip(&counts) {
        for z in [-1.0f64, 1.0] {
            let y = 2.0 + u + 0.4 * u * u - 0.2 * u.powi(3) + 0.5 * z + 0.3 * z * z + 0.7 * u * z;
            outcomes.push((f64::from(count) / 16.0, y));
        }
    }
    let expected = |f: &dyn Fn(f64) -> f64| outcomes.iter().map(|(p, y)| p * f(*y)).sum::<f64>();
    let mean = expected(&|y| y);
    let variance = expected(&|y| (y - mean).powi(2));
    relative(found.mean(), mean, 1e-13);
    relative(found.variance(), variance, 1e-13);
    relative(found.skewness().unwrap(), expected(&|y| (y - mean).powi(3)) / variance.powf(1.5), 1e-12);
    relative(found.kurtosis().unwrap(), expected(&|y| (y - mean).powi(4)) / variance.powi(2), 1e-12);
}

fn measured_problem(model: fn(&[f64]) -> Arc<dyn Distribution>) -> Problem {
    let case = &data("measured.json")[1];
    let x = Dimension::distributed("x", 10.0, None, model(&numbers(&case["values"]))).unwrap();
    let z = Dimension::normal("z", 10.0, 0.03).unwrap();
    let limits = SpecLimits::new(Some(-0.04), Some(0.1)).unwrap();
    let gap = Closure::new(["gap", "other"], |x| [x[0] - x[1], x[1]]);
    Problem::new([x, z], gap)
        .unwrap()
        .asking([Characteristic::new("gap").with_limits(limits), Characteristic::new("other")])
        .unwrap()
}

fn empirical(values: &[f64]) -> Arc<dyn Distribution> {
    Arc::new(Measured::new(values).unwrap())
}

/// The numbers do not depend on the number of threads, but do on the seed. There are none without measured values.
#[test]
fn intervals_hang_on_the_seed_alone() {
    let problem = measured_problem(empirical);
    let of = |seed| {
        let mut options = Options::from(Method::Full);
        options.seed = seed;
        analyze(&problem, &options).unwrap()
    };
    let on =
        |threads: usize| rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap().install(|| of(None));
    let first = of(None);
    assert_eq!(first.run.seed, Some(Options::SEED));
    assert_eq!(on(1).characteristics, first.characteristics);
    assert_eq!(on(3).characteristics, first.characteristics);
    assert_eq!(of(Some(Options::SEED)).characteristics, first.characteristics);
    let interval = |seed| of(seed).characteristics.remove(0).evidence.sampling.unwrap();
    assert_ne!(interval(Some(2)).mean, interval(None).mean);
    let [gap, other] = &first.characteristics[..] else { panic!("two characteristics") };
    let sampling = gap.evidence.sampling.as_ref().unwrap();
    assert_eq!(sampling.samples, [("x".to_owned(), 200)]);
    let [low, high] = sampling.rejected.map(|[low, high]| [1.0 - high, 1.0 - low]).unwrap();
    let kept = gap.distribution.capability.unwrap().yield_().unwrap();
    assert!(low < kept && kept < high && 0.9 < low && high < 1.0, "{low} {kept} {high}");
    let cpk = gap.distribution.capability.unwrap().cpk.unwrap();
    assert!(sampling.cpk.unwrap()[0] < cpk && cpk < sampling.cpk.unwrap()[1]);
    // `other` does not declare its dependencies. Its interval has no width, since it does not depend on measured values.
    let nothing = other.evidence.sampling.as_ref().map(|sampling| sampling.sigma.unwrap());
    assert!(nothing.is_none_or(|[low, high]| (high - low).abs() < 1e-12), "{nothing:?}");
    let known = Problem::new([Dimension::normal("x", 1.0, 0.1).unwrap()], Closure::scalar("y", |x| x[0])).unwrap();
    let known = analyze(&known, &Method::Full.into()).unwrap();
    assert_eq!((known.run.seed, &known.characteristics[0].evidence.sampling), (None, &None));
}

/// A fitted distribution with infinite moments in some resamples. A straight characteristic does not need them, but a curved one does.
#[test]
fn resamples_without_moments_leave_their_intervals_unknown() {
    let fitted = |values: &[f64]| -> Arc<dyn Distribution> { Arc::new(PearsonLaw::fitted(values).unwrap()) };
    // Five far values in sixty give a kurtosis near the limit beyond which the eighth moment is infinite.
    let mut values: Vec<f64> = (0..55).map(|i| f64::from(i % 11) - 5.0).collect();
    values.extend([-11.0, -10.0, 10.0, 11.0, 12.0]);
    let law = fitted(&values);
    let x = Dimension::distributed("x", 0.0, None, law).unwrap();
    let y = Closure::new(["straight", "curved"], |x| [x[0], x[0] + 0.05 * x[0] * x[0]]);
    let analysis = analyze(&Problem::new([x], y).unwrap(), &Method::SecondOrder.into()).unwrap();
    let [straight, curved] = &analysis.characteristics[..] else { panic!("two characteristics") };
    let (straight, curved) = (straight.evidence.sampling.as_ref().unwrap(), curved.evidence.sampling.as_ref().unwrap());
    assert!(straight.kurtosis.is_some() && straight.skewness.is_some());
    assert!(curved.mean.is_some() && curved.sigma.is_some());
    assert_eq!(curved.kurtosis, None);
    // For a straight characteristic the fitted distribution and the values have the same four moments in every resample.
    let x = Dimension::distributed("x", 0.0, None, empirical(&values)).unwrap();
    let same = Problem::new([x], Closure::new(["straight"], |x| [x[0]])).unwrap();
    let same =
        analyze(&same, &Method::SecondOrder.into()).unwrap().characteristics.remove(0).evidence.sampling.unwrap();
    for (a, b) in [(same.sigma, straight.sigma), (same.kurtosis, straight.kurtosis)] {
        for (a, b) in a.unwrap().into_iter().zip(b.unwrap()) {
            relative(a, b, 1e-9);
        }
    }
}

/// Many dimensions with all their interactions get fewer resamples, and the result states their number.
#[test]
fn large_problems_are_resampled_less() {
    let values = numbers(&data("measured.json")[0]["values"]);
    let resamples = |n: usize| {
        let x = Dimension::distributed("m", 25.0, None, empirical(&values)).unwrap();
        let dimensions = std::iter::once(x).chain(sensitol_testing::standard(n - 1));
        let y = Closure::scalar("y", |x| x.iter().sum::<f64>().powi(2));
        let analysis = analyze(&Problem::new(dimensions, y).unwrap(), &Method::Full.into()).unwrap();
        analysis.characteristics[0].evidence.sampling.as_ref().unwrap().resamples
    };
    assert_eq!((resamples(20), resamples(160)), (1000, 731));
}

/// Reads a study of one dimension with this line, in a folder with the file `d.csv`.
fn read(csv: impl AsRef<[u8]>, line: &str) -> Result<Study, StudyError> {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("d.csv"), csv).unwrap();
    let study = folder.path().join("study.toml");
    let text = format!("[dimensions]\na = {{ {line} }}\n[characteristics]\ny = {{ formula = \"a\" }}\n");
    std::fs::write(&study, text).unwrap();
    Study::read(&study)
}

/// Place, key, message and help of the fault.
fn fault(csv: impl AsRef<[u8]>, line: &str) -> String {
    let error = read(csv, line).err().unwrap_or_else(|| panic!("valid: {line}"));
    let (row, column) = error.line_column().unwrap();
    let help = error.help().map_or(String::new(), |help| format!("\n  help: {help}"));
    format!("{row}:{column} [{}] {}: {}{help}", &error.text[error.span.clone().unwrap()], error.key, error.fault)
}

const PLAIN: &str = "measured = \"d.csv\"";

#[test]
fn tables_are_read_in_every_usual_form() {
    let expected = [1.5, 2.5, -3.0, 0.25, 1000.0];
    let tables: [(&str, &[u8]); 10] = [
        (PLAIN, b"d\n1.5\n2.5\n-3\n.25\n1e3\n"),
        (PLAIN, b"\xef\xbb\xbfd\r\n1.5\r\n2.5\r\n-3\r\n0.25\r\n1000\r\n"),
        ("measured = \"d.csv\", column = \"d\"", b"n,d\n1, 1.5\n2,+2.5\n3,-3\n4,0.25\n5,1000"),
        ("measured = \"d.csv\", column = \"d\"", b"n;d\n1;1,5\n2;2,5\n3;-3\n4;0,25\n5;1000\n"),
        ("measured = \"d.csv\", column = \"d\"", b"n\td\n1\t1,5\n2\t2,5\n3\t-3\n4\t0,25\n5\t1000\n"),
        (
            "measured = \"d.csv\", column = \"b, d\"",
            b"a,\"b, d\"\nx,1.5\n\"y, z\",2.5\n,-3\n\"\"\"q\"\"\",0.25\nx,1000\n",
        ),
        (
            "measured = \"d.csv\", column = \"Breite, mm\"",
            "Länge, mm;Breite, mm\n1,0;1,5\n1,0;2,5\n1,0;-3\n1,0;0,25\n1,0;1000\n".as_bytes(),
        ),
        // The only column that holds numbers.
        (PLAIN, b"who,d\nMK,1.5\nMK,2.5\nJT,-3\nJT,0.25\nJT,1000\n"),
        // Blank lines are skipped. Empty cells are missing values.
        (PLAIN, b"d;who\n\n1.5;a\nNA;a\n2.5;a\n;b\n-3;b\nnan;b\n0.25;b\n-;b\nn/a;b\n1000;b\n"),
        ("measured = \"d.csv\", model = \"empirical\"", b"\"d\"\n\"1.5\"\n2.5\n-3\n0.25\n1000\n"),
    ];
    for (line, table) in tables {
        let text = String::from_utf8_lossy(table);
        let study = read(table, line).unwrap_or_else(|error| panic!("{error}: {text}"));
        let dimension = &study.problem.dimensions()[0];
        let law = dimension.distribution().unwrap().measured().unwrap();
        let mut sorted = expected;
        sorted.sort_unstable_by(f64::total_cmp);
        assert_eq!(law.sample().values(), sorted, "{text}");
        assert_eq!((dimension.nominal(), dimension.tolerance()), (dimension.mean(), None));
        relative(dimension.mean(), expected.iter().sum::<f64>() / 5.0, 1e-15);
    }
}

#[test]
fn tables_at_fault() {
    let column = "measured = \"d.csv\", column = \"d\"";
    let values = "1\n2\n3\n4\n5\n";
    let all = [
        fault("", PLAIN),
        fault("\n\n", PLAIN),
        fault("9.98\n9.99\n10.01\n10.02\n10.00\n9.97\n", PLAIN),
        fault("n;d\n1;9,98\n", "measured = \"d.csv\", column = \"1\""),
        fault("d\n1\n2\n", "measured = \"e.csv\""),
        fault(b"d\n1\n2\n\xff3\n", PLAIN),
        fault(b"\xff\xfed\0\n\0", PLAIN),
        fault("n,d\n1,1.5\n2,1.4\n3\n", column),
        fault("n,d\n1,1.5\n2,1,4\n3,1.3\n", column),
        fault("d\n1,5\n1,4\n", PLAIN),
        fault("n,d\n1,\"1,5\"\n", column),
        fault("n,d\n1,1.5\n2,1.4 mm\n", column),
        fault("n,d\n1,1.5\n2,--\n", column),
        fault("n;d\n1;1.234,5\n", column),
        fault("n;d\n1;1,5\n2;1.4\n", column),
        fault("n,d\n1,inf\n", column),
        fault("n,d\n1,1e999\n", column),
        fault("n,dd\n1,1.5\n2,1.4\n", column),
        fault("n,D_mm\n1,1.5\n2,1.4\n", "measured = \"d.csv\", column = \"d_m\""),
        fault("d,d\n1,1.5\n2,1.4\n", column),
        fault("n,d\n1,1.5\n2,1.4\n", PLAIN),
        fault("who,when\nMK,early\n", PLAIN),
        fault("d\n1\n2\n3\n4\n", PLAIN),
        fault("n,d\n1,1\n2,\n3,2\n4,NA\n", column),
        fault("d\n", PLAIN),
        fault("d\n7.5\n7.5\n7.5\n7.5\n7.5\n7.5\n", PLAIN),
        fault(format!("d\n# comment\n{values}"), PLAIN),
    ];
    insta::assert_snapshot!(all.join("\n"));
}

#[test]
fn measured_dimensions_at_fault() {
    let values = "d\n1\n2\n3\n4\n5\n";
    let long = (0..100).map(|i| format!("{}\n", i % 10)).fold("d\n-60\n60\n70\n".to_owned(), |a, b| a + &b);
    let beside = |keys: &str| fault(values, &format!("measured = \"d.csv\", {keys}"));
    let all = [
        beside("sigma = 1"),
        beside("sigmas = 3"),
        beside("cp = 1"),
        beside("distribution = \"normal\""),
        beside("moments = [1, 0, 3, 0, 15, 0, 105]"),
        beside("shift = 0.1"),
        beside("model = \"pearsn\""),
        beside("model = \"gauss\""),
        beside("tolerance = 0.1"),
        beside("colum = \"d\""),
        beside("nominal = 1, tolerance = [0.2, 0.1]"),
        fault(values, "measured = 3"),
        fault(values, "nominal = 1, column = \"d\""),
        fault(values, "nominal = 1, model = \"pearson\""),
        fault("d\n1\n1\n1\n2\n2\n2\n", "measured = \"d.csv\", model = \"pearson\""),
        fault(long, "measured = \"d.csv\", model = \"pearson\""),
        fault("d\n1e12\n1000000000000.0001\n1000000000000.0001\n1e12\n1e12\n1000000000000.0001\n", PLAIN),
    ];
    insta::assert_snapshot!(all.join("\n"));
}

/// Odd values give a warning with their lines. None of them is dropped.
#[test]
fn odd_values_are_named() {
    let mut table = String::from("n,d\n");
    for i in 0..40 {
        let cell = match i {
            7 | 8 | 21..=25 => "NA".to_owned(),
            30 => "10.9".to_owned(),
            i => format!("{}", 10.0 + 0.001 * f64::from(i * 7 % 11)),
        };
        table += &format!("{i},{cell}\n");
    }
    let messages = |csv: &str, keys: &str| {
        let study = read(csv, &format!("measured = \"d.csv\", column = \"d\"{keys}")).unwrap();
        study.warnings.iter().map(|warning| format!("{}: {}", warning.code(), warning.message())).collect::<Vec<_>>()
    };
    let study = read(&table, "measured = \"d.csv\", column = \"d\"").unwrap();
    let law = study.problem.dimensions()[0].distribution().unwrap();
    assert_eq!((law.measured().unwrap().sample().len(), law.support()[1]), (33, 10.9));
    let mut all = messages(&table, ", nominal = 10, tolerance = 0.005");
    all.extend(messages("d\n10\n11\n10\n11\n10\n12\n11\n10\n", ""));
    all.extend(messages("d\n10\n11\n13\n14\n12.5\n", ", limits = [0.39, 0.55]"));
    assert!(messages(&table.replace("NA", "10.003").replace("10.9", "10.004"), "").is_empty());
    insta::assert_snapshot!(all.join("\n"));
}

/// The hash covers the study and its data, like the output of `cat study.toml d.csv | sha256sum`.
#[test]
fn the_hash_is_of_study_and_data() {
    use sha2::{Digest, Sha256};
    let line = "measured = \"d.csv\"";
    let text = format!("[dimensions]\na = {{ {line} }}\n[characteristics]\ny = {{ formula = \"a\" }}\n");
    for csv in ["d\n1\n2\n3\n4\n5\n", "d\n1\n2\n3\n4\n6\n"] {
        let expected: String =
            Sha256::digest(format!("{text}{csv}")).iter().map(|byte| format!("{byte:02x}")).collect();
        assert_eq!(read(csv, line).unwrap().sha256, expected);
    }
}

/// From the file to the report: mean and sigma of a difference, computed by hand from the file's values.
#[test]
fn the_example_is_analysed() {
    let path = repository("examples/measured-pin/study.toml");
    let study = Study::read(&path).unwrap();
    let text = std::fs::read_to_string(path.with_file_name("pin.csv")).unwrap();
    let values: Vec<f64> = (text.lines().skip(1))
        .filter_map(|line| line.split(';').nth(2).unwrap().replace(',', ".").parse().ok())
        .collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / n;
    let pin = &study.problem.dimensions()[1];
    assert_eq!((values.len(), pin.distribution().unwrap().name()), (123, "measured"));
    relative(pin.mean(), mean, 1e-15);
    relative(pin.sigma(), variance.sqrt(), 1e-12);
    assert_eq!((pin.nominal(), pin.half_band()), (9.99, 0.005));
    let analysis = analyze(&study.problem, &Method::Full.into()).unwrap();
    let clearance = &analysis.characteristics[0];
    // hole*cos(tilt) - pin with a uniform tilt: E cos = sin(1 deg)/1 deg, and its square by E cos^2.
    let one = 1f64.to_radians();
    let cosine = one.sin() / one;
    let square = 0.5 + 0.25 * (2.0 * one).sin() / one;
    let hole = 0.0025f64.powi(2) * square + 10.0075f64.powi(2) * (square - cosine * cosine);
    // The tilt moves the mean by a fraction of 1e-5. It gives 2 % of the variance, of which its parabola misses some 1e-3.
    relative(clearance.moments.unwrap().mean(), 10.0075 * cosine - mean, 1e-6);
    relative(clearance.moments.unwrap().variance(), hole + variance, 1e-4);
    let [low, high] = clearance.evidence.sampling.as_ref().unwrap().mean.unwrap();
    // Only the standard error of the pin's mean contributes: 1.96 of it on either side, slightly skewed.
    relative(high - low, 2.0 * 1.96 * (variance / n).sqrt(), 0.15);
}
