//! Normal distribution with a drifting mean, compared with integrals of its density.

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol_numeric::distribution::StandardMoments;

use sensitol_testing::densities::drifting;
use sensitol_testing::{close, fields, relative};

/// Drifts below and above the sigma of a lot, 0.2, on both sides of the range of the closed forms.
const DRIFTS: [f64; 4] = [0.02, 0.15, 0.4, 1.0];

#[test]
fn moments_and_tails_are_those_of_the_density() {
    for drift in DRIFTS {
        let case = drifting(drift);
        let (law, mean, sigma) = (&case.distribution, case.distribution.mean(), case.distribution.sigma());
        relative(case.mean(|_| 1.0), 1.0, 1e-11);
        close(case.mean(|x| x), mean, 1e-11, 1.0);
        // The density of the test is a difference of distribution functions. Its error is 1e-15 divided by the drift.
        relative(case.mean(|x| (x - mean).powi(2)).sqrt(), sigma, 1e-10);
        let standard = |order: i32| case.mean(|x| ((x - mean) / sigma).powi(order));
        let expected = StandardMoments::from_standard([3, 4, 5, 6, 7, 8].map(standard));
        for (found, expected) in fields(law.standard_moments()).into_iter().zip(fields(expected)) {
            close(found, expected, 1e-9, 100.0);
        }
        let law = law.probability().unwrap();
        for i in 1..50 {
            let x = mean + f64::from(i) / 10.0 * sigma;
            close(law.density(x).unwrap(), case.density(x), 1e-11, 1.0 / sigma);
            close(law.sf(x), case.integral([x, f64::INFINITY], |_| 1.0), 1e-11, 1.0);
            relative(law.cdf(2.0 * mean - x), law.sf(x), 1e-9);
        }
        for p in [1e-12, 1e-6, 1.35e-3, 0.1, 0.45] {
            // The last digits of a value near 3 move a tail by 1e-15 sigmas times its logarithmic slope.
            relative(law.sf(law.upper_quantile(p)), p, 1e-11);
            relative(law.cdf(law.quantile(p)), p, 1e-11);
        }
        let mut sample = vec![0.0; 20_000];
        law.fill(&mut Xoshiro256PlusPlus::seed_from_u64(5), &mut sample);
        sample.sort_unstable_by(f64::total_cmp);
        let n = sample.len() as f64;
        let distance = |(i, &x): (usize, &f64)| (law.cdf(x) - (i as f64 + 0.5) / n).abs() + 0.5 / n;
        let statistic = n.sqrt() * sample.iter().enumerate().map(distance).fold(0.0, f64::max);
        // Kolmogorov's statistic exceeds 2.47 with the probability 1e-5.
        assert!(statistic < 2.47, "{drift}: {statistic}");
    }
}
