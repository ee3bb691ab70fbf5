//! Statistics of a lot, compared with SciPy and statsmodels, and the coverage of the intervals.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol_numeric::distribution::{Distribution, Normal, Uniform, standard_normal};
use sensitol_numeric::lot::{
    Departure, LotSample, LotTest, MeasuredPart, NormalPrior, PredictedVariance, anderson_darling_normal,
    compare_groups, compare_means, compare_spreads, correlation_estimate, cramer_von_mises_of_shape, fisher_quantile,
    fisher_sf, holm, likeliest_departure, linear_trend, performance,
};
use sensitol_testing::{close, data};

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

fn column(value: &serde_json::Value) -> LotSample {
    LotSample::new(&numbers(value)).unwrap()
}

/// Closed forms: 1e-9 is far above the rounding of both programs, far below any slip of a formula. Values near 1e6 with a sigma of 1e-3
/// lose six digits before they are compared.
#[test]
fn figures_and_tests_of_columns_are_those_of_scipy() {
    for case in data("lot.json")["columns"].as_array().unwrap() {
        let (column, assumed) = (column(&case["values"]), numbers(&case["assumed"]));
        let near = |a: f64, b: f64| close(a, b, if assumed[0] > 1e5 { 1e-5 } else { 1e-9 }, 1e-9);
        let tests = column.tests(&Normal::new(assumed[0], assumed[1]).unwrap());
        let pairs = |found: [f64; 2], expected: &serde_json::Value| {
            found.into_iter().zip(numbers(expected)).for_each(|(a, b)| near(a, b));
        };
        pairs(column.mean_figure().interval, &case["mean"]);
        pairs(column.sigma_figure(0.0).interval, &case["sigma"]);
        near(tests.mean.p, case["mean_p"].as_f64().unwrap());
        near(tests.sigma.p, case["sigma_p"].as_f64().unwrap());
        let (statistic, p) = anderson_darling_normal(&column);
        pairs([statistic, p], &case["anderson"]);
        assert_eq!(tests.shape.map(|test| test.p), Some(p));
        let order: Vec<f64> = (0..column.count()).map(|place| place as f64).collect();
        let trend = linear_trend(&order, column.values()).unwrap();
        let expected = numbers(&case["trend"]);
        pairs([trend.change.value, trend.test.p], &serde_json::json!([expected[0], expected[3]]));
        pairs(trend.change.interval, &serde_json::json!([expected[1], expected[2]]));
    }
}

#[test]
fn correlations_groups_and_families_are_those_of_scipy() {
    let all = data("lot.json");
    for case in all["pairs"].as_array().unwrap() {
        let rows: Vec<[f64; 2]> =
            case["rows"].as_array().unwrap().iter().map(|row| [0, 1].map(|side| row[side].as_f64().unwrap())).collect();
        let found = correlation_estimate(&rows, 0.3).unwrap();
        close(found.figure.value, case["r"].as_f64().unwrap(), 1e-9, 1.0);
        numbers(&case["ends"]).into_iter().zip(found.figure.interval).for_each(|(a, b)| close(a, b, 1e-9, 1.0));
        close(found.test.p, case["p_against_0.3"].as_f64().unwrap(), 1e-9, 1e-9);
    }
    for case in all["groups"].as_array().unwrap() {
        let parts: Vec<(&str, f64)> = (case["parts"].as_array().unwrap().iter())
            .map(|part| (part[0].as_str().unwrap(), part[1].as_f64().unwrap()))
            .collect();
        let found = compare_groups(&parts).unwrap();
        close(found.test.p, case["p"].as_f64().unwrap(), 1e-9, 1e-9);
        numbers(&case["within"]).into_iter().zip(found.within.interval).for_each(|(a, b)| close(a, b, 1e-9, 1.0));
    }
    let [raw, adjusted] = [0, 1].map(|place| numbers(&all["holm"][place]));
    let mut tests: Vec<LotTest> = raw.into_iter().map(LotTest::of).collect();
    holm(&mut tests.iter_mut().collect::<Vec<_>>());
    tests.iter().zip(adjusted).for_each(|(test, expected)| close(test.adjusted, expected, 1e-12, 1.0));
    for case in all["fisher"].as_array().unwrap() {
        let [p, above, below, quantile, sf] = numbers(case)[..] else { panic!("five numbers") };
        // The beta quantile behind it has eight digits.
        close(fisher_quantile(p, [above, below]), quantile, 1e-6, 1e-9);
        close(fisher_sf(quantile, [above, below]), sf, 1e-8, 1e-9);
    }
}

/// A prediction from one sample is Welch's comparison of two samples, and Fisher's test of two variances.
#[test]
fn a_prediction_from_one_sample_is_a_comparison_of_two() {
    let case = &data("lot.json")["prediction"];
    let (part, own) = (column(&case["part"]), column(&case["own"]));
    let measured = MeasuredPart { effect: part.sigma(), curvature: 0.0, count: part.count(), excess: 0.0 };
    let variance = PredictedVariance::of(part.sigma().powi(2), &[measured], &[]);
    close(compare_means(&own, part.mean(), &variance).p, case["welch"].as_f64().unwrap(), 1e-9, 1e-9);
    close(compare_spreads(&own, &variance, 0.0).p, case["fisher"].as_f64().unwrap(), 1e-9, 1e-9);
}

/// The grid of the oracle leaves 1e-3 of a sigma.
#[test]
fn posteriors_are_those_of_an_integration() {
    for case in data("lot.json")["posteriors"].as_array().unwrap() {
        let prior = numbers(&case["prior"]);
        let found = NormalPrior { mean: prior[0], sigma: prior[1], parts: prior[2] }.updated(&column(&case["values"]));
        let near = |a: f64, b: f64| assert!((a - b).abs() < 2e-3 * prior[1], "{a} {b}");
        near(found.mean.value, case["mean"].as_f64().unwrap());
        numbers(&case["mean_ends"]).into_iter().zip(found.mean.interval).for_each(|(a, b)| near(a, b));
        numbers(&case["sigma_ends"]).into_iter().zip(found.sigma.interval).for_each(|(a, b)| near(a, b));
    }
}

/// 2000 samples leave a standard error of 0.011 at a share of one half.
#[test]
fn the_shape_of_a_uniform_distribution_is_tested() {
    for case in data("lot.json")["uniform_shapes"].as_array().unwrap() {
        let found = cramer_von_mises_of_shape(&column(&case["values"]), &Uniform::about(5.0, 2.0).unwrap()).unwrap();
        close(found, case["p"].as_f64().unwrap(), 0.035, 1.0);
    }
    // Two far groups cannot come from a uniform distribution: the tail beyond the samples is continued.
    let far: Vec<f64> = (0..60).map(|i| f64::from(i % 2) * 10.0 + f64::from(i % 7) * 0.01).collect();
    let p = cramer_von_mises_of_shape(&LotSample::new(&far).unwrap(), &Uniform::about(0.0, 1.0).unwrap()).unwrap();
    assert!(p > 0.0 && p < 1e-5, "{p}");
}

fn normals(rng: &mut Xoshiro256PlusPlus, count: usize, mean: f64, sigma: f64) -> Vec<f64> {
    (0..count).map(|_| mean + sigma * standard_normal::quantile(rng.random_range(1e-12..1.0))).collect()
}

/// 1000 lots have a standard error of 0.7 % at 95 %, so that a right interval stays within 93 to 97 % with 99.6 % for each figure.
fn held(counts: &[(&str, usize)], lots: usize) {
    for (figure, held) in counts {
        let share = *held as f64 / lots as f64;
        assert!((0.93..=0.97).contains(&share), "{figure}: {share}");
    }
}

/// Lots of 10 to 300 parts with known shifts and spreads, without a prior.
#[test]
fn intervals_of_lots_hold_as_often_as_they_say() {
    const LOTS: usize = 1000;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(59);
    let mut found = [("mean", 0), ("sigma", 0), ("Pp", 0), ("Ppk", 0), ("posterior mean", 0), ("posterior sigma", 0)];
    for lot in 0..LOTS {
        let count = 10 + lot * 29 % 291;
        let (mean, sigma) = (rng.random_range(-3.0..3.0), rng.random_range(0.5..2.0));
        let column = LotSample::new(&normals(&mut rng, count, mean, sigma)).unwrap();
        let after = NormalPrior { mean: 0.0, sigma: 1.0, parts: 0.0 }.updated(&column);
        let indices = performance(&column, [Some(-6.0), Some(6.0)]).unwrap();
        let truth = [
            (column.mean_figure().interval, mean),
            (column.sigma_figure(0.0).interval, sigma),
            (indices.pp.unwrap().interval, 2.0 / sigma),
            (indices.ppk.interval, (6.0 - mean.abs()) / (3.0 * sigma)),
            (after.mean.interval, mean),
            (after.sigma.interval, sigma),
        ];
        for ((_, held), ([low, high], value)) in found.iter_mut().zip(truth) {
            *held += usize::from(low <= value && value <= high);
        }
    }
    held(&found, LOTS);
}

/// Processes that differ from their study as the prior of 30 parts says: the posterior intervals hold, and are narrower than those of
/// the lot alone.
#[test]
fn posterior_intervals_hold_for_processes_of_the_prior() {
    const LOTS: usize = 1000;
    let prior = NormalPrior { mean: 10.0, sigma: 0.1, parts: 30.0 };
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(60);
    let mut found = [("mean", 0), ("sigma", 0)];
    let (mut widths, mut alone) = (0.0, 0.0);
    for lot in 0..LOTS {
        let count = 10 + lot * 29 % 291;
        let squares: f64 = normals(&mut rng, 29, 0.0, 1.0).iter().map(|z| z * z).sum();
        let sigma = prior.sigma * (29.0 / squares).sqrt();
        let mean = normals(&mut rng, 1, prior.mean, sigma / 30f64.sqrt())[0];
        let column = LotSample::new(&normals(&mut rng, count, mean, sigma)).unwrap();
        let after = prior.updated(&column);
        for ((_, held), ([low, high], value)) in
            found.iter_mut().zip([(after.mean.interval, mean), (after.sigma.interval, sigma)])
        {
            *held += usize::from(low <= value && value <= high);
        }
        widths += after.mean.interval[1] - after.mean.interval[0];
        let own = column.mean_figure().interval;
        alone += own[1] - own[0];
    }
    held(&found, LOTS);
    assert!(widths < 0.9 * alone, "{widths} {alone}");
}

/// Components of 12 lots of 8 parts: the interval of the rest is exact, that of the lots is at least 95 % and hardly more.
#[test]
fn intervals_of_components_hold() {
    const LOTS: usize = 1000;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(61);
    let (mut within, mut between) = (0, 0);
    for _ in 0..LOTS {
        let means = normals(&mut rng, 12, 0.0, 0.7);
        let values: Vec<Vec<f64>> = means.iter().map(|mean| normals(&mut rng, 8, *mean, 1.0)).collect();
        let names: Vec<String> = (0..12).map(|group| group.to_string()).collect();
        let parts: Vec<(&str, f64)> = names
            .iter()
            .zip(&values)
            .flat_map(|(name, parts)| parts.iter().map(|part| (name.as_str(), *part)))
            .collect();
        let found = compare_groups(&parts).unwrap();
        let holds = |[low, high]: [f64; 2], value: f64| usize::from(low <= value && value <= high);
        within += holds(found.within.interval, 1.0);
        between += holds(found.between.interval, 0.7);
    }
    held(&[("within", within)], LOTS);
    assert!((930..=990).contains(&between), "{between}");
}

/// A family of right assumptions is refuted in 5 % of all lots at most: 1000 lots have a standard error of 0.7 %.
#[test]
fn a_right_study_is_refuted_as_seldom_as_stated() {
    const LOTS: usize = 1000;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(62);
    let law = Normal::new(2.0, 0.5).unwrap();
    let mut refuted = 0;
    for _ in 0..LOTS {
        let mut tests = Vec::new();
        for _ in 0..4 {
            let column = LotSample::new(&normals(&mut rng, 40, 2.0, 0.5)).unwrap();
            let found = column.tests(&law);
            tests.extend([Some(found.mean), Some(found.sigma), found.shape].into_iter().flatten());
        }
        holm(&mut tests.iter_mut().collect::<Vec<_>>());
        refuted += usize::from(tests.iter().any(|test| test.refutes(0.05)));
    }
    assert!((20..=70).contains(&refuted), "{refuted}");
}

#[test]
fn forms_are_named() {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(63);
    let name = |values: &[f64]| likeliest_departure(&LotSample::new(values).unwrap());
    let mut two = normals(&mut rng, 60, 0.0, 1.0);
    two.extend(normals(&mut rng, 40, 6.0, 1.0));
    let Some(Departure::Mixture { means, share }) = name(&two) else { panic!("{:?}", name(&two)) };
    // Standard errors 0.2 and 0.05.
    close(means[1] - means[0], 6.0, 0.1, 1.0);
    close(share, 0.4, 0.25, 0.1);
    let all = normals(&mut rng, 600, 0.0, 1.0);
    let sorted: Vec<f64> = all.iter().copied().filter(|value| *value > -0.5).collect();
    assert!(matches!(name(&sorted), Some(Departure::Truncation { ends: [Some(_), None] })), "{:?}", name(&sorted));
    let mut far = all[..80].to_vec();
    far.push(9.0);
    assert_eq!(name(&far), Some(Departure::Outliers { values: vec![9.0] }));
    assert_eq!(name(&all[..10]), None);
}

/// The interval of sigma for a uniform distribution has the width that its kurtosis gives.
#[test]
fn sigma_of_a_known_shape_has_the_freedom_of_its_kurtosis() {
    const LOTS: usize = 1000;
    let law = Uniform::about(0.0, 1.0).unwrap();
    let excess = law.standard_moments().kurtosis() - 3.0;
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(64);
    let mut inside = 0;
    for _ in 0..LOTS {
        let values: Vec<f64> = (0..50).map(|_| rng.random_range(-1.0..1.0)).collect();
        let [low, high] = LotSample::new(&values).unwrap().sigma_figure(excess).interval;
        inside += usize::from(low <= law.sigma() && law.sigma() <= high);
    }
    held(&[("sigma", inside)], LOTS);
}

/// A gauge that is coarser than the parts of a tool: the means are 0 and 1, whose standard deviation is the root of 0.5, and nothing is
/// left within. The interval is that of a variance with one degree of freedom: chi-squared quantiles 5.02389 and 0.000982069 of tables.
#[test]
fn groups_without_inner_spread_have_all_the_variance() {
    let parts: Vec<(&str, f64)> = (0..20).map(|part| if part % 2 == 0 { ("T0", 0.0) } else { ("T1", 1.0) }).collect();
    let found = compare_groups(&parts).unwrap();
    close(found.between.value, 0.5_f64.sqrt(), 1e-12, 1.0);
    close(found.between.interval[0], (0.5_f64 / 5.023_89).sqrt(), 1e-5, 1.0);
    close(found.between.interval[1], (0.5_f64 / 0.000_982_069).sqrt(), 1e-5, 1.0);
    assert_eq!((found.within.value, found.within.interval, found.test.p), (0.0, [0.0, 0.0], 0.0));
    assert!(compare_groups(&[("T0", 1.0), ("T0", 1.0), ("T1", 1.0)]).is_none());
}
