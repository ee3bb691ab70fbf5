//! Yield and capability, against closed forms and against Monte Carlo of the models themselves.

use proptest::prelude::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::assembly::{Points, Request, Responses, Run};
use sensitol::capability::{Capability, Law};
use sensitol_numeric::capability::TAIL;

use sensitol::pearson::{Pearson, PearsonError};
use sensitol::{Closure, Dimension, Method, Moments, Problem, SpecLimits, analyze};
use sensitol_study::Study;
use sensitol_testing::{normals, relative, repository};

fn limits(lower: Option<f64>, upper: Option<f64>) -> SpecLimits {
    SpecLimits::new(lower, upper).unwrap()
}

fn of(moments: Moments, limits: SpecLimits) -> Capability {
    Capability::of(&Law::fit(&moments).unwrap(), moments.mean(), moments.sigma(), limits)
}

/// Every index of a normal distribution is known. Tails are from tables (Abramowitz and Stegun 1964, table 26.2: Q(3), Q(4.5)).
#[test]
fn a_normal_has_the_indices_of_the_textbook() {
    let normal = Moments::new(10.0, 2.0, 0.0, 0.0);
    let both = of(normal, limits(Some(4.0), Some(19.0)));
    relative(both.below.unwrap(), 1.349_898_031_630_1e-3, 1e-12);
    relative(both.above.unwrap(), 3.397_673_124_730_1e-6, 1e-12);
    relative(both.cp.unwrap(), 1.25, 1e-12);
    relative(both.cpk.unwrap(), 1.0, 1e-12);
    relative(both.cp_percentile.unwrap(), 1.25, 1e-12);
    relative(both.cpk_percentile.unwrap(), 1.0, 1e-12);
    relative(TAIL, 1.349_898_031_630_1e-3, 1e-12);
    // With one limit there is no width, and no reject beyond the missing limit.
    let lower = of(normal, limits(Some(4.0), None));
    assert_eq!((lower.above, lower.cp, lower.cp_percentile), (None, None, None));
    relative(lower.cpk.unwrap(), 1.0, 1e-12);
    relative(lower.sigma_level().unwrap(), 3.0, 1e-12);
    let none = of(normal, SpecLimits::default());
    assert_eq!((none.yield_(), none.cpk, none.sigma_level()), (None, None, None));
}

/// Indices of the exponential distribution by hand: median log 2, quantiles -log p.
#[test]
fn percentile_indices_follow_the_shape() {
    let exponential = Moments::new(1.0, 1.0, 2.0, 6.0);
    let found = of(exponential, limits(Some(0.0), Some(9.0)));
    let [low, middle, high] = [-(-TAIL).ln_1p(), std::f64::consts::LN_2, -TAIL.ln()];
    assert_eq!(found.below, Some(0.0));
    relative(found.above.unwrap(), (-9.0f64).exp(), 1e-12);
    relative(found.cp_percentile.unwrap(), 9.0 / (high - low), 1e-12);
    relative(found.cpk_percentile.unwrap(), (middle / (middle - low)).min((9.0 - middle) / (high - middle)), 1e-12);
    // The indices of the normal form depend on mean and sigma only.
    relative(found.cpk.unwrap(), 1.0 / 3.0, 1e-12);
}

/// A characteristic with sigma 0 has one value, on the limit or beside it.
#[test]
fn what_does_not_vary_is_a_point() {
    for (value, expected) in [(5.0, 1.0), (7.0, 1.0), (6.0, 1.0), (4.9, 0.0), (7.1, 0.0)] {
        let found = of(Moments::constant(value), limits(Some(5.0), Some(7.0)));
        assert_eq!(found.yield_(), Some(expected), "{value}");
        assert_eq!((found.cp, found.cpk, found.cp_percentile, found.sigma_level()), (None, None, None, None));
    }
    assert_eq!(Law::fit(&Moments::constant(5.0)).unwrap().quantile(0.01), 5.0);
}

/// A dimension with two values of 50 % each has a distribution, but not one of the Pearson system.
#[test]
fn two_values_have_no_pearson_law() {
    let study = "[dimensions]\nx = { nominal = 10, moments = [0.01, 0, 1e-4, 0, 1e-6, 0, 1e-8] }\n\
                 [characteristics]\ny = { formula = \"2*x\", lower = 19.9, target_yield = 0.99 }";
    let study = Study::from_toml(study, "coin.toml").unwrap();
    let analysis = analyze(&study.problem, &Method::SecondOrder.into()).unwrap();
    let found = &analysis.characteristics[0];
    let Some(Err(PearsonError::Infeasible { bound, law, .. })) = &found.evidence.law else {
        panic!("{:?}", found.evidence.law)
    };
    assert_eq!((*bound, law.values, law.probabilities), (1.0, [-1.0, 1.0], [0.5, 0.5]));
    assert_eq!((found.distribution.capability, found.met()), (None, None));
    let warning = analysis.warnings.iter().find(|warning| warning.code() == "infeasible-moments").unwrap();
    assert!(warning.message().contains("two values") && warning.characteristic() == Some("y"), "{}", warning.message());
    // A small normal dimension makes it nearly a member.
    let mixed = Study::from_toml(
        "[dimensions]\nx = { nominal = 10, moments = [0.01, 0, 1e-4, 0, 1e-6, 0, 1e-8] }\nz = { nominal = 0, tolerance = 0.03 }\n\
         [characteristics]\ny = { formula = \"2*x + z\", lower = 19.9 }",
        "coin.toml",
    );
    let analysis = analyze(&mixed.unwrap().problem, &Method::SecondOrder.into()).unwrap();
    assert!(analysis.warnings.iter().any(|warning| warning.code() == "near-infeasible-moments"));
    assert!(analysis.characteristics[0].distribution.capability.is_some());
}

/// Share of rejects beyond the quantiles of one in ten thousand, from ten million assemblies of the model: 1000 beyond each, with a
/// standard error of 3 %. A difference of 20 % is allowed.
#[test]
fn yields_are_those_of_monte_carlo() {
    for (path, name) in [("engine-balance/study.toml", "F"), ("stacked-blocks/study.toml", "gap")] {
        let study = Study::read(&repository("examples").join(path)).unwrap();
        let problem = study.problem.only(&[name]).unwrap();
        let analysis = analyze(&problem, &Method::Full.into()).unwrap();
        let Some(Ok(law)) = &analysis.characteristics[0].evidence.law else { panic!("{name} has a law") };
        let bounds = [law.quantile(1e-4), law.upper_quantile(1e-4)];
        let (batches, rows) = (1000, 10_000);
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(1);
        let mut beyond = [0; 2];
        for _ in 0..batches {
            let column = |dimension: &Dimension| -> Vec<f64> {
                // Every dimension of the two studies is normal.
                let one =
                    |_| dimension.mean() + dimension.sigma() * Distribution::<f64>::sample(&StandardNormal, &mut rng);
                (0..rows).map(one).collect()
            };
            let columns: Vec<Vec<f64>> = problem.dimensions().iter().map(column).collect();
            let points = Points::from_columns(rows, &columns);
            let mut out = Responses::open(rows, 1);
            problem.function().evaluate(&Request::values(&points, problem.outputs()), &Run::to_the_end(), &mut out);
            assert_eq!(out.errors().count(), 0);
            for value in out.column(0) {
                beyond[0] += u32::from(*value < bounds[0]);
                beyond[1] += u32::from(*value > bounds[1]);
            }
        }
        for count in beyond {
            let share = f64::from(count) / (batches * rows) as f64;
            assert!((share / 1e-4 - 1.0).abs() < 0.2, "{name}: {share:e} instead of 1e-4");
        }
    }
}

proptest! {
    /// Other units change no share and no index. A mirror image exchanges the two sides.
    #[test]
    fn units_and_mirrors_do_not_matter(
        skewness in -1.5..1.5f64, above in 0.2..6.0f64, lower in -5.0..-0.5f64, upper in 0.5..5.0f64, power in -9..9i32, mean in -2.0..2.0f64,
    ) {
        let excess = skewness * skewness - 2.0 + above;
        let one = of(Moments::new(0.0, 1.0, skewness, excess), limits(Some(lower), Some(upper)));
        let unit = 10f64.powi(power);
        let place = |z: f64| unit * (mean + z);
        let scaled = of(Moments::new(place(0.0), unit, skewness, excess), limits(Some(place(lower)), Some(place(upper))));
        let mirrored = of(Moments::new(0.0, 1.0, -skewness, excess), limits(Some(-upper), Some(-lower)));
        let same = |a: Option<f64>, b: Option<f64>| {
            let (a, b) = (a.unwrap(), b.unwrap());
            // Next to an end of the support a share depends on the last digits of its place.
            (a - b).abs() <= 1e-9 * a.abs().max(1e-3)
        };
        prop_assert!(same(one.below, scaled.below) && same(one.above, scaled.above));
        prop_assert!(same(one.cpk_percentile, scaled.cpk_percentile) && same(one.cp, scaled.cp));
        prop_assert_eq!((one.below, one.above), (mirrored.above, mirrored.below));
        prop_assert!((one.yield_().unwrap() + one.rejected().unwrap() - 1.0).abs() < 1e-15);
    }
}

/// The distributions of a study's characteristic and of a Pearson fit with the same moments are the same.
#[test]
fn an_analysis_carries_the_law_of_its_moments() {
    let product = Problem::new(normals(&[3.0, 2.0], &[0.3, 0.6]), Closure::scalar("y", |x| x[0] * x[1])).unwrap();
    let found = &analyze(&product, &Method::Full.into()).unwrap().characteristics[0];
    let Some(Ok(Law::Pearson(law))) = &found.evidence.law else { panic!("a law") };
    let moments = found.moments.unwrap();
    let [skewness, excess] = [moments.skewness(), moments.excess()].map(Option::unwrap);
    assert_eq!(**law, Pearson::with_excess(moments.mean(), moments.sigma(), skewness, excess).unwrap());
    assert_eq!((found.distribution.capability.unwrap().yield_(), found.met()), (None, None));
}
