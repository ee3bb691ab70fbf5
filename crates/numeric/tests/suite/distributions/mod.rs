//! Distributions: moments compared with integrals of the density, Gauss rules, and impossible parameters.

mod drifting;
mod extremes;
mod units;

use proptest::prelude::*;
use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol_numeric::distribution::{
    CentralMoments, Distribution, DistributionError, Jacobi, Normal, Probability, StandardMoments, Uniform,
};

use sensitol_testing::densities::{Case, cases};
use sensitol_testing::{close, fields, relative};

/// Moments of one distribution are compared relative to their sizes. The integrator is accurate to 1e-13 of the largest term.
#[test]
fn moments_are_those_of_the_density() {
    for case in cases() {
        let distribution = &case.distribution;
        relative(case.mean(|_| 1.0), 1.0, 1e-12);
        let mean = case.mean(|x| x);
        close(distribution.mean(), mean, 1e-12, distribution.sigma());
        let sigma = case.mean(|x| (x - mean).powi(2)).sqrt();
        relative(distribution.sigma(), sigma, 1e-11);
        let standard = |order: i32| case.mean(|x| ((x - mean) / sigma).powi(order));
        let expected = StandardMoments::from_standard([3, 4, 5, 6, 7, 8].map(standard));
        let scales =
            [1.0, 1.0, expected.m6, expected.m6, expected.m8, expected.m8, expected.m6, expected.m8, expected.m8];
        for ((found, expected), scale) in
            fields(distribution.standard_moments()).into_iter().zip(fields(expected)).zip(scales)
        {
            close(found, expected, 1e-10, scale.max(10.0));
        }
        let [lower, upper] = distribution.support();
        assert!(lower <= distribution.mean() && distribution.mean() <= upper);
    }
}

/// The distribution function is the integral of the density. Quantiles invert it in both tails.
#[test]
fn probabilities_are_those_of_the_density() {
    for case in cases() {
        let distribution = &case.distribution;
        let law = distribution.probability().unwrap();
        let (name, mean, sigma) = (distribution.name(), distribution.mean(), distribution.sigma());
        let [lower, upper] = distribution.support();
        assert!(law.cdf(f64::NAN).is_nan() && law.sf(f64::NAN).is_nan(), "{name}");
        for p in [f64::NAN, 1.1, -0.1] {
            assert!(law.quantile(p).is_nan() && law.upper_quantile(p).is_nan(), "{name}: {p}");
        }
        assert_eq!((law.cdf(lower), law.sf(lower), law.cdf(upper), law.sf(upper)), (0.0, 1.0, 1.0, 0.0), "{name}");
        assert_eq!((law.quantile(0.0), law.upper_quantile(0.0)), (lower, upper), "{name}");
        assert_eq!((law.quantile(1.0), law.upper_quantile(1.0)), (upper, lower), "{name}");
        for i in 0..40 {
            let x = mean + (f64::from(i) / 4.0 - 4.9) * sigma;
            if x <= lower || x >= upper {
                assert_eq!(law.cdf(x) + law.sf(x), 1.0, "{name} outside its support");
                continue;
            }
            // The rounding of x matters where the density is steep.
            close(law.density(x).unwrap(), case.density(x), 1e-12, 1e-12 / sigma);
            // The integral is accurate to 1e-13 of the whole, in the tails too.
            close(law.cdf(x), case.integral([f64::NEG_INFINITY, x], |_| 1.0), 1e-12, 1.0);
            close(law.sf(x), case.integral([x, f64::INFINITY], |_| 1.0), 1e-12, 1.0);
        }
        for p in [1e-12, 1e-9, 1e-6, 1.35e-3, 0.1, 0.3, 0.5] {
            let (low, high) = (law.quantile(p), law.upper_quantile(p));
            assert!(lower <= low && low <= high && high <= upper, "{name}: {low} {high}");
            // A step in the last digit of x moves the probability. Next to a singular end this is the largest error.
            let inverts = |x: f64, tail: &dyn Fn(f64) -> f64| {
                let step = 4.0 * f64::EPSILON * x.abs().max(sigma);
                let (a, b) = (tail(x - step), tail(x + step));
                assert!(
                    a.min(b) <= p * (1.0 + 1e-12) && a.max(b) >= p * (1.0 - 1e-12),
                    "{name}: {p} at {x}: {}",
                    tail(x)
                );
            };
            inverts(low, &|x| law.cdf(x));
            inverts(high, &|x| law.sf(x));
        }
    }
}

/// Samples follow the distribution function: Kolmogorov's statistic of 20 000 of them stays below its 1e-5 quantile.
#[test]
fn samples_follow_the_distribution() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(5);
    for case in cases() {
        let law = case.distribution.probability().unwrap();
        let mut sample = vec![0.0; 20_000];
        law.fill(&mut rng, &mut sample);
        sample.sort_unstable_by(f64::total_cmp);
        let n = sample.len() as f64;
        let distance = |(i, &x): (usize, &f64)| {
            let p = law.cdf(x);
            (p - i as f64 / n).abs().max(((i + 1) as f64 / n - p).abs())
        };
        let statistic = n.sqrt() * sample.iter().enumerate().map(distance).fold(0.0, f64::max);
        // P(sqrt(n) D > 2.47) = 2 exp(-2 x 2.47^2) = 1e-5, for 28 distributions.
        assert!(statistic < 2.47, "{}: {statistic}", case.distribution.name());
    }
}

/// Values of a generator never change: three of each distribution, to twelve digits.
#[test]
fn samples_are_stable() {
    let sample = |case: &Case| {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(11);
        let mut values = [0.0; 3];
        case.distribution.probability().unwrap().fill(&mut rng, &mut values);
        format!("{}: {:.12} {:.12} {:.12}", case.distribution.name(), values[0], values[1], values[2])
    };
    insta::assert_snapshot!(cases().iter().map(sample).collect::<Vec<_>>().join("\n"));
}

/// Tails of the normal distribution, `ncdf(-z)`, to the digits of mpmath 1.3 with 30 digits.
#[test]
fn the_normal_law_keeps_its_tails() {
    let law = Normal::new(0.0, 1.0).unwrap();
    let tails = [
        (1.0, 0.158_655_253_931_457_05),
        (6.0, 9.865_876_450_376_98e-10),
        (10.0, 7.619_853_024_160_526e-24),
        (20.0, 2.753_624_118_606_233_7e-89),
        (37.0, 5.725_571_222_524_576e-300),
    ];
    for (z, p) in tails {
        for (found, expected) in [
            (law.cdf(-z), p),
            (law.sf(z), p),
            (law.probability().unwrap().quantile(p), -z),
            (law.probability().unwrap().upper_quantile(p), z),
        ] {
            // The erfc of libm is accurate to 1 ulp, for an argument that is rounded to 1 ulp. This gives z^2 ulp of the probability.
            relative(found, expected, 2e-16 * (2.0 + z * z));
        }
    }
}

/// The recurrence and the moments describe the same distribution.
#[test]
fn recurrence_and_moments_agree() {
    for case in cases() {
        let moments = case.distribution.standard_moments();
        let (known, derived) = (case.distribution.jacobi(4), Jacobi::from_moments(&moments).unwrap());
        for (a, b) in known.gauss().nodes.iter().zip(derived.gauss().nodes) {
            // The longer the tail, the less exactly moments determine the nodes.
            close(*a, b, 1e-12 * moments.m8.max(100.0).sqrt(), 1.0);
        }
    }
}

/// An n-point Gauss rule is exact up to degree 2n-1, and one with the mean among its nodes up to degree 2n-2.
#[test]
fn rules_integrate_polynomials_exactly() {
    for case in cases() {
        let distribution = &case.distribution;
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        let moments: Vec<f64> = (0..20).map(|order| case.mean(|x| ((x - mean) / sigma).powi(order))).collect();
        let moment = |order: i32| moments[order as usize];
        for order in 1..=9usize {
            let gauss = distribution.jacobi(order).gauss();
            assert_eq!(gauss.nodes.len(), order);
            assert!(gauss.weights.iter().all(|&weight| weight > 0.0));
            for degree in 0..2 * order as i32 {
                close(gauss.mean(|u| u.powi(degree)), moment(degree), 1e-10, moment(degree + degree % 2));
            }
            let Some(rule) = distribution.jacobi(order).gauss_with_mean() else { continue };
            assert_eq!(rule.nodes.len(), order + 1);
            assert!(rule.nodes.contains(&0.0));
            // A node very far out costs all others digits.
            let far = rule.nodes.iter().fold(1.0f64, |far, u| far.max(u.abs()));
            let gauss = distribution.jacobi(order + 1).gauss().nodes.iter().fold(1.0f64, |far, u| far.max(u.abs()));
            for degree in 0..=2 * order as i32 {
                let scale = moment(degree + degree % 2) * (far / gauss).max(1.0).powi(2);
                close(rule.mean(|u| u.powi(degree)), moment(degree), 1e-9, scale);
            }
        }
    }
}

/// Gauss-Hermite nodes to the digits of Abramowitz and Stegun, table 25.10 (times sqrt 2).
#[test]
fn five_points_of_a_normal_are_gauss_hermite() {
    let rule = Normal::new(0.0, 1.0).unwrap().jacobi(4).gauss_with_mean().unwrap();
    let expected =
        [-2.856_970_013_872_805_8, -1.355_626_179_974_265_8, 0.0, 1.355_626_179_974_265_8, 2.856_970_013_872_805_8];
    for (found, expected) in rule.nodes.iter().zip(expected) {
        close(*found, expected, 1e-14, 1.0);
    }
    for (found, expected) in rule.weights.iter().zip([0.011_257_411_327_720_69, 0.222_075_922_005_612_7, 8.0 / 15.0]) {
        relative(*found, expected, 1e-13);
    }
}

/// A distribution known by moments only gives the rules of the distribution with these moments.
#[test]
fn moments_alone_determine_five_points() {
    let uniform = CentralMoments::new(0.0, [1.0 / 3.0, 0.0, 0.2, 0.0, 1.0 / 7.0, 0.0, 1.0 / 9.0]).unwrap();
    let five = uniform.jacobi(9).gauss_with_mean().unwrap();
    let legendre = Uniform::new(-1.0, 1.0).unwrap().jacobi(4).gauss_with_mean().unwrap();
    assert_eq!(uniform.jacobi(9).order(), 4, "eight moments know no more");
    for (a, b) in five.nodes.iter().zip(legendre.nodes) {
        close(*a, b, 1e-12, 1.0);
    }
}

#[test]
fn few_atoms_have_few_nodes() {
    // Values +-1 with equal probability, and -1, 0, 1 with the probabilities 1/8, 3/4, 1/8.
    let two = CentralMoments::new(5.0, [1.0, 0.0, 1.0, 0.0, 1.0, 0.0, 1.0]).unwrap();
    assert_eq!(two.jacobi(9).order(), 2);
    assert_eq!(two.jacobi(9).gauss().nodes, [-1.0, 1.0]);
    let three = CentralMoments::new(0.0, [0.25, 0.0, 0.25, 0.0, 0.25, 0.0, 0.25]).unwrap();
    assert_eq!(three.jacobi(9).order(), 3);
    assert!(three.jacobi(9).gauss_with_mean().is_none(), "the three atoms have the mean among them");
}

#[test]
fn impossible_parameters_are_refused() {
    let moments = |m: [f64; 7]| CentralMoments::new(0.0, m).unwrap_err();
    assert!(matches!(Normal::new(0.0, 0.0), Err(DistributionError::NotPositive { .. })));
    assert!(matches!(Normal::new(f64::NAN, 1.0), Err(DistributionError::NotFinite { .. })));
    assert!(matches!(Normal::new(0.0, f64::INFINITY), Err(DistributionError::NotFinite { .. })));
    assert!(matches!(Uniform::new(2.0, 1.0), Err(DistributionError::EmptyInterval { .. })));
    assert!(matches!(Uniform::new(1.0, 1.0), Err(DistributionError::EmptyInterval { .. })));
    assert!(matches!(moments([-1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0]), DistributionError::NotPositive { .. }));
    assert!(matches!(
        moments([1.0, 0.0, 0.9, 0.0, 15.0, 0.0, 105.0]),
        DistributionError::ImpossibleMoments { moment: 4, .. }
    ));
    assert!(matches!(
        moments([1.0, 0.0, 3.0, 0.0, 8.0, 0.0, 105.0]),
        DistributionError::ImpossibleMoments { moment: 6, .. }
    ));
    assert!(matches!(
        moments([1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 80.0]),
        DistributionError::ImpossibleMoments { moment: 8, .. }
    ));
}

proptest! {
    /// Sigma may be of any size, since moments are scaled by one power at a time.
    #[test]
    fn central_moments_scale(power in -36..38i32) {
        let sigma = 10f64.powi(power);
        let central: [f64; 7] = [1.0, 0.0, 3.0, 0.0, 15.0, 0.0, 105.0];
        let scaled: Vec<f64> = central.iter().zip(2..).map(|(moment, order)| moment * sigma.powi(order)).collect();
        let found = CentralMoments::new(1.0, scaled.try_into().unwrap()).unwrap();
        relative(found.sigma(), sigma, 1e-15);
        close(found.standard_moments().m8, 105.0, 1e-13, 0.0);
    }
}
