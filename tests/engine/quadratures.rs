//! Dimension reduction and three-point products: exact cases, brute-force sums for other cases, and lost points.

use std::sync::Arc;

use proptest::prelude::*;
use sensitol::correlation::Pair;
use sensitol::distribution::{
    CentralMoments, Distribution, Exponential, Lognormal, Measured, Mixture, Normal, Part, Triangular, Uniform,
};

use sensitol::method::registry::procedure;
use sensitol::method::{Basis, MethodError, Pairs, Stencil};
use sensitol::{
    Analysis, Closure, DerivativeSource, Dimension, Method, Moments, Options, Problem, RunSummary, Warning, analyze,
};
use sensitol_numeric::distribution::rule::Rule;
use sensitol_numeric::moments::Tables;
use sensitol_testing::{Asked, close, data, normals, refusing, relative, standard};

const REDUCTIONS: [Method; 2] = [Method::DimensionReduction, Method::BivariateDimensionReduction];
const QUADRATURES: [Method; 3] = [Method::DimensionReduction, Method::BivariateDimensionReduction, Method::ThreePoint];

fn with_nodes(method: Method, nodes: usize) -> Options {
    Options::from(method).with_nodes(nodes)
}

fn analysis(
    dimensions: Vec<Dimension>,
    options: &Options,
    f: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
) -> Analysis {
    analyze(&Problem::new(dimensions, Closure::scalar("y", f)).unwrap(), options).unwrap()
}

fn moments(analysis: &Analysis) -> Moments {
    analysis.characteristics[0].moments.unwrap()
}

fn of(name: &str, law: impl Distribution + 'static) -> Dimension {
    let mean = law.mean();
    Dimension::distributed(name, mean, None, Arc::new(law)).unwrap()
}

fn pair(a: &str, b: &str, value: f64) -> Pair {
    Pair { between: [a.to_owned(), b.to_owned()], value }
}

/// Compares moments with the mean and the cumulants 2 to 4.
#[track_caller]
fn cumulants(found: Moments, [mean, variance, third, fourth]: [f64; 4], tolerance: f64) {
    close(found.mean(), mean, tolerance, variance.sqrt());
    relative(found.sigma(), variance.sqrt(), tolerance);
    close(found.skewness().unwrap(), third / variance.powf(1.5), tolerance, 1.0);
    close(found.excess().unwrap(), fourth / variance.powi(2), tolerance, 1.0);
}

/// Rules have moments 1 to 5 with three nodes, 1 to 8 with five and seven, and the three-point rule 1 to 4. The expected moments are the
/// closed forms of each distribution. The tolerance 1e-11 is some units in the last place of the rule, times the power.
#[test]
fn rules_have_the_moments_of_their_distributions() {
    let parts = vec![
        Part { name: "left".into(), weight: 0.3, distribution: Arc::new(Normal::new(-1.0, 0.2).unwrap()) },
        Part { name: "right".into(), weight: 0.7, distribution: Arc::new(Uniform::new(0.0, 2.0).unwrap()) },
    ];
    let laws: Vec<Arc<dyn Distribution>> = vec![
        Arc::new(Normal::new(7.0, 0.2).unwrap()),
        Arc::new(Uniform::new(-1.0, 3.0).unwrap()),
        Arc::new(Triangular::new(1.0, 1.5, 4.0).unwrap()),
        Arc::new(Exponential::new(0.5, 2.0).unwrap()),
        Arc::new(Lognormal::new(0.0, 1.0, 0.3).unwrap()),
        Arc::new(Mixture::new(parts).unwrap()),
        Arc::new(Measured::new(&[9.98, 10.00, 10.00, 10.01, 10.03, 10.07, 9.9, 9.97]).unwrap()),
        Arc::new(Measured::new(&[1.0, 2.0, 2.0]).unwrap()),
        // Moments of an exponential distribution.
        Arc::new(CentralMoments::new(10.0, [1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0]).unwrap()),
    ];
    for law in laws {
        let expected = law.standard_moments().raw();
        let holds = |rule: &Rule, degree: usize| {
            relative(rule.weights.iter().sum(), 1.0, 1e-14);
            assert!(rule.weights.iter().all(|&weight| weight > 0.0));
            for (order, &expected) in expected.iter().enumerate().take(degree + 1) {
                let scale = expected.max(rule.mean(|u| u.abs().powi(order as i32)));
                close(rule.mean(|u| u.powi(order as i32)), expected, 1e-11, scale);
            }
        };
        holds(&Rule::of(&*law, 3), 5);
        holds(&Rule::of(&*law, 5), 8);
        holds(&Rule::of(&*law, 7), 8);
        holds(&Rule::three_point(&*law), 4);
        let [lower, upper] = law.support();
        let rules = [Rule::of(&*law, 3), Rule::of(&*law, 5), Rule::of(&*law, 7), Rule::three_point(&*law)];
        let nodes = rules.iter().flat_map(|rule| &rule.nodes).map(|u| law.mean() + u * law.sigma());
        let slack = 1e-12 * law.sigma();
        assert!(nodes.clone().all(|x| lower - slack <= x && x <= upper + slack), "{} leaves its support", law.name());
    }
    let nodes = |law: &dyn Distribution, nodes: usize| Rule::of(law, nodes).nodes.len();
    let few = Measured::new(&[1.0, 2.0, 2.0]).unwrap();
    assert_eq!([3, 5, 7].map(|m| nodes(&few, m)), [2, 2, 2]);
    let known = CentralMoments::new(10.0, [1.0, 2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0]).unwrap();
    assert_eq!([3, 5, 7].map(|m| nodes(&known, m)), [3, 5, 5], "eight moments make a rule of five nodes at most");
}

/// Cumulants of a squared normal, a uniform and an exponential input add. The rule of five nodes is exact for the fourth power of a square,
/// of degree 8.
#[test]
fn sums_are_exact() {
    let half = 0.7f64;
    let expected = [
        1.0 + 2.0 * 0.3 + 3.0 * 2.0,
        2.0 + 4.0 * half * half / 3.0 + 9.0,
        8.0 + 27.0 * 2.0,
        48.0 - 16.0 * 2.0 / 15.0 * half.powi(4) + 81.0 * 6.0,
    ];
    for method in REDUCTIONS {
        for nodes in [5, 7] {
            let dimensions = vec![
                Dimension::normal("n", 0.0, 3.0).unwrap(),
                Dimension::uniform("u", 0.3, half).unwrap(),
                of("e", Exponential::new(1.0, 2.0).unwrap()),
            ];
            let found = analysis(dimensions, &with_nodes(method, nodes), |x| x[0] * x[0] + 2.0 * x[1] + 3.0 * x[2]);
            cumulants(moments(&found), expected, 1e-12);
            let one = &found.characteristics[0];
            close(one.sensitivities[0].curvature_share.unwrap(), 2.0 / expected[1], 1e-12, 1.0);
            close(one.sensitivities[2].linear_share.unwrap(), 9.0 / expected[1], 1e-12, 1.0);
            close(one.sensitivities[0].mean_shift.unwrap(), 1.0, 1e-13, 1.0);
            // Derivatives come from the nodes next to the means.
            close(one.sensitivities[1].first.unwrap(), 2.0, 1e-11, 1.0);
            close(one.sensitivities[0].second.unwrap(), 2.0, 1e-10, 1.0);
            assert_eq!(found.basis, Basis::Quadrature);
        }
    }
}

/// Shares sum to 1, together with the part that is left out if that is known.
#[test]
fn shares_sum_to_one() {
    for method in QUADRATURES {
        let found = analysis(standard(4), &method.into(), |x| (x[0] + 0.3 * x[1] * x[2]).exp() + x[3] * x[0]);
        let one = &found.characteristics[0];
        let own: f64 = (0..4).map(|d| one.share(d).unwrap()).sum();
        let together: f64 = one.contributions.interactions.iter().map(|interaction| interaction.share.unwrap()).sum();
        close(own + together + one.contributions.left_out_share.unwrap_or(0.0), 1.0, 1e-12, 1.0);
        assert_eq!(one.contributions.interactions.len(), if method == Method::DimensionReduction { 0 } else { 6 });
        assert_eq!(one.contributions.left_out_share.is_none(), method == Method::DimensionReduction);
    }
}

/// Functions whose terms have two dimensions each, in closed form: forms of normals by their eigenvalues.
#[test]
fn products_of_two_are_exact() {
    let bivariate = |n: usize, f: fn(&[f64]) -> f64| {
        moments(&analysis(standard(n), &Method::BivariateDimensionReduction.into(), f))
    };
    // A triangle: eigenvalues 1, -1/2, -1/2.
    cumulants(bivariate(3, |x| x[0] * x[1] + x[1] * x[2] + x[0] * x[2]), [0.0, 3.0, 6.0, 54.0], 1e-13);
    // Two products without a common dimension.
    cumulants(bivariate(4, |x| x[0] * x[1] + x[2] * x[3]), [0.0, 2.0, 0.0, 12.0], 1e-13);
    // A cycle of four dimensions: (x0 + x2)(x1 + x3).
    cumulants(bivariate(4, |x| x[0] * x[1] + x[1] * x[2] + x[2] * x[3] + x[3] * x[0]), [0.0, 4.0, 0.0, 96.0], 1e-13);
    // Lines and parabolas: (x0 + x1)^2 is twice a chi-square variable of one degree.
    cumulants(bivariate(2, |x| (x[0] + x[1]).powi(2)), [2.0, 8.0, 64.0, 768.0], 1e-12);
    // Inputs that are not normal: a product of independent inputs has products of raw moments.
    let dimensions = vec![of("e", Exponential::new(0.0, 2.0).unwrap()), Dimension::uniform("u", 1.0, 1.0).unwrap()];
    let raw = [1.0, 2.0, 8.0, 48.0, 384.0].iter().zip([1.0, 1.0, 4.0 / 3.0, 2.0, 16.0 / 5.0]).map(|(e, u)| e * u);
    let raw: Vec<f64> = raw.collect();
    let (mean, variance) = (raw[1], raw[2] - raw[1] * raw[1]);
    let third = raw[3] - 3.0 * raw[2] * mean + 2.0 * mean.powi(3);
    let fourth = raw[4] - 4.0 * raw[3] * mean + 6.0 * raw[2] * mean * mean - 3.0 * mean.powi(4);
    for (method, nodes) in [(Method::BivariateDimensionReduction, 3), (Method::BivariateDimensionReduction, 5)] {
        let found = analysis(dimensions.clone(), &with_nodes(method, nodes), |x| x[0] * x[1]);
        cumulants(moments(&found), [mean, variance, third, fourth - 3.0 * variance * variance], 1e-12);
        let one = &found.characteristics[0];
        close(one.contributions.interactions.get(0).unwrap().mixed.unwrap(), 1.0, 1e-12, 1.0);
        // Variances 4 and 1/3, and a joint part. The curvatures are 0.
        close(one.contributions.interactions.get(0).unwrap().share.unwrap(), 4.0 / 3.0 / variance, 1e-12, 1.0);
        assert_eq!(one.contributions.left_out_share, Some(0.0));
    }
}

/// A general function of four inputs of four kinds, against sums over whole grids in 60 digits.
#[test]
fn reductions_are_those_of_brute_force() {
    let truth = data("dimension-reduction.json");
    let dimensions = || {
        vec![
            of("a", Normal::new(0.5, 0.4).unwrap()),
            of("b", Uniform::new(0.3, 1.7).unwrap()),
            of("c", Exponential::new(0.0, 0.8).unwrap()),
            of("d", Triangular::new(0.0, 0.25, 1.0).unwrap()),
        ]
    };
    let function = |x: &[f64]| {
        (0.3 * x[0]).exp() * (x[1] + 0.2 * x[2]).sin()
            + x[0] * x[1] * x[3] / 5.0
            + (1.0 + x[2] * x[2] + x[3]).sqrt()
            + x[1] * x[2] * x[3] / 4.0
    };
    let check = |options: &Options, expected: &serde_json::Value| {
        let found = moments(&analysis(dimensions(), options, function));
        let expected = |key: &str| expected[key].as_str().unwrap().parse::<f64>().unwrap();
        relative(found.mean(), expected("mean"), 1e-12);
        relative(found.sigma(), expected("sigma"), 1e-11);
        relative(found.skewness().unwrap(), expected("skewness"), 1e-11);
        relative(found.kurtosis().unwrap(), expected("kurtosis"), 1e-11);
    };
    for nodes in [3, 5, 7] {
        check(&with_nodes(Method::DimensionReduction, nodes), &truth["univariate"][nodes.to_string()]);
    }
    for nodes in [3, 5] {
        check(&with_nodes(Method::BivariateDimensionReduction, nodes), &truth["bivariate"][nodes.to_string()]);
    }
    check(&Method::ThreePoint.into(), &truth["three-point"]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Random tables with random probabilities, some pairs without any, against the enumeration of every combination.
    #[test]
    fn tables_are_summed_as_enumerated(
        numbers in prop::collection::vec(-1.0..1.0f64, 120),
        present in prop::collection::vec(any::<bool>(), 10),
        offset in -1e3..1e3f64,
    ) {
        let nodes = [2usize, 3, 2, 3, 2];
        let mut next = numbers.iter().cycle().copied();
        let mut take = |count: usize| next.by_ref().take(count).collect::<Vec<f64>>();
        let weights: Vec<Vec<f64>> = nodes.iter().map(|&m| {
            let raw: Vec<f64> = take(m).iter().map(|x| x.abs() + 0.05).collect();
            let total: f64 = raw.iter().sum();
            raw.iter().map(|x| x / total).collect()
        }).collect();
        let own: Vec<Vec<f64>> = nodes.iter().map(|&m| take(m)).collect();
        let all = (0..5usize).flat_map(|j| (j + 1..5).map(move |k| (j, k)));
        let pairs: Vec<(usize, usize, Vec<f64>)> = all.zip(&present).filter(|(_, present)| **present)
            .map(|((j, k), _)| (j, k, take(nodes[j] * nodes[k]))).collect();
        let tables = Tables {
            constant: offset,
            weights: weights.iter().map(|weights| &weights[..]).collect(),
            own: own.clone(),
            pairs: pairs.clone(),
        };
        let mut cells = Vec::new();
        for place in 0..nodes.iter().product::<usize>() {
            let (mut rest, mut at) = (place, [0; 5]);
            for j in 0..5 {
                (at[j], rest) = (rest % nodes[j], rest / nodes[j]);
            }
            let weight: f64 = (0..5).map(|j| weights[j][at[j]]).product();
            let value: f64 = (0..5).map(|j| own[j][at[j]]).sum::<f64>()
                + pairs.iter().map(|(j, k, table)| table[at[*j] * nodes[*k] + at[*k]]).sum::<f64>();
            cells.push((weight, value));
        }
        let mean = |f: &dyn Fn(f64) -> f64| cells.iter().map(|(weight, value)| weight * f(*value)).sum::<f64>();
        let middle = mean(&|y| y);
        let sigma = mean(&|y| (y - middle).powi(2)).sqrt();
        let found = tables.moments();
        // The tolerance covers sums of a hundred roundings. The offset costs as many digits as it has beside 1.
        close(found.moments.mean(), offset + middle, 1e-14, 1e2);
        relative(found.moments.sigma(), sigma, 1e-12);
        close(found.moments.skewness().unwrap(), mean(&|y| ((y - middle) / sigma).powi(3)), 1e-11, 1.0);
        close(found.moments.kurtosis().unwrap(), mean(&|y| ((y - middle) / sigma).powi(4)), 1e-11, 1.0);
        let own: f64 = found.own.iter().zip(&weights)
            .map(|(own, weights)| own.iter().zip(weights).map(|(a, w)| w * a * a).sum::<f64>()).sum();
        close(own + found.shares.iter().sum::<f64>(), 1.0, 1e-12, 1.0);
    }
}

/// Functions for which a product of three levels is exact: one without interactions, and one that mixes all three dimensions.
#[test]
fn three_levels_are_exact_where_they_claim_it() {
    let found =
        moments(&analysis(standard(3), &Method::ThreePoint.into(), |x| (1.0 + x[0]) * (2.0 + x[1]) * (3.0 + x[2])));
    let raw = |order: i32, about: f64| match order {
        1 => about,
        2 => 1.0 + about * about,
        3 => about.powi(3) + 3.0 * about,
        _ => about.powi(4) + 6.0 * about * about + 3.0,
    };
    let raw: Vec<f64> = (1..=4).map(|order| [1.0, 2.0, 3.0].iter().map(|&about| raw(order, about)).product()).collect();
    let (mean, variance) = (raw[0], raw[1] - raw[0] * raw[0]);
    let third = raw[2] - 3.0 * raw[1] * mean + 2.0 * mean.powi(3);
    let fourth = raw[3] - 4.0 * raw[2] * mean + 6.0 * raw[1] * mean * mean - 3.0 * mean.powi(4);
    cumulants(found, [mean, variance, third, fourth - 3.0 * variance * variance], 1e-12);
    // At a mean of 1e6 sigmas a raw fourth moment would have no digit left. The tolerance is 1e-9, because the function itself has ten
    // digits.
    let far = analysis(standard(2), &Method::ThreePoint.into(), |x| 1e6 + x[0] * x[1]);
    cumulants(moments(&far), [1e6, 1.0, 0.0, 6.0], 1e-9);
}

/// Skewness and kurtosis of a parabola need powers beyond a rule of three nodes, which causes a warning. A rule of five is exact.
#[test]
fn shallow_rules_are_named() {
    let of = |options: &Options| analysis(standard(2), options, |x| x[0] + 0.2 * x[0] * x[0] + x[1]);
    let warns = |options: &Options| of(options).warnings.iter().any(|warning| warning.code() == "shallow-rules");
    let shallow = [with_nodes(Method::DimensionReduction, 3), Method::ThreePoint.into()];
    assert!(shallow.iter().all(warns));
    assert!(!warns(&Method::DimensionReduction.into()));
    // Variance b^2 (1 + 1) + 2 a^2, third moment 6 a b^2 + 8 a^3.
    let expected = (6.0 * 0.2 + 8.0 * 0.008) / 2.08f64.powf(1.5);
    relative(moments(&of(&Method::DimensionReduction.into())).skewness().unwrap(), expected, 1e-12);
    assert!((moments(&of(&shallow[1])).skewness().unwrap() - expected).abs() > 1e-3, "the warning is needed");
    let straight = analysis(standard(2), &Method::ThreePoint.into(), |x| x[0] + 3.0 * x[1] + 0.5 * x[0] * x[1]);
    assert!(straight.warnings.iter().all(|warning| warning.code() != "shallow-rules"));
}

/// Correlated normals are integrated along their eigenvectors: a line, and a parabola along one of them.
#[test]
fn correlated_inputs_go_by_eigenvectors() {
    let problem = |f: fn(&[f64]) -> f64| {
        let dimensions = normals(&[5.0, -2.0, 1.0], &[3.0, 3.0, 3.0]);
        Problem::new(dimensions, Closure::scalar("y", f)).unwrap().correlated(&[pair("x0", "x1", 0.6)]).unwrap()
    };
    let found = |f: fn(&[f64]) -> f64, options: &Options| analyze(&problem(f), options).unwrap();
    for method in QUADRATURES {
        let line = found(|x| 2.0 * x[0] - x[1] + x[2], &method.into());
        cumulants(moments(&line), [13.0, 4.0 + 1.0 - 2.4 + 1.0, 0.0, 0.0], 1e-12);
    }
    // The variance of x0 + x1 is 3.2.
    let expected = [3.2 + 1.0, 2.0 * 3.2f64.powi(2) + 1.0, 8.0 * 3.2f64.powi(3), 48.0 * 3.2f64.powi(4)];
    for method in REDUCTIONS {
        let parabola = found(|x| (x[0] + x[1] - 3.0).powi(2) + x[2], &method.into());
        cumulants(moments(&parabola), expected, 1e-12);
        let one = &parabola.characteristics[0];
        assert_eq!(one.sensitivities[0].linear_share, None, "a correlated dimension has no share by itself");
        close(one.sensitivities[2].linear_share.unwrap(), 1.0 / expected[1], 1e-12, 1.0);
        assert_eq!(one.contributions.left_out_share, None);
    }
    // Cumulants of a product of the two: r, 1 + r^2, 6 r + 2 r^3, 6 (1 + 6 r^2 + r^4).
    let r = 0.6f64;
    let product = found(|x| (x[0] - 5.0) * (x[1] + 2.0), &Method::BivariateDimensionReduction.into());
    let expected = [r, 1.0 + r * r, 6.0 * r + 2.0 * r.powi(3), 6.0 * (1.0 + 6.0 * r * r + r.powi(4))];
    cumulants(moments(&product), expected, 1e-12);
    // Three levels give mean and sigma, a polynomial of degree 4.
    let levels = moments(&found(|x| (x[0] - 5.0) * (x[1] + 2.0), &Method::ThreePoint.into()));
    close(levels.mean(), r, 1e-12, 1.0);
    relative(levels.variance(), 1.0 + r * r, 1e-12);
    // The counts are 2N+1 and 4N+1, and nothing for a direction that does not vary.
    assert_eq!([3, 5].map(|m| found(|x| x[0], &with_nodes(Method::DimensionReduction, m)).run.evaluations), [7, 13]);
    let tied = Problem::new(standard(2), Closure::scalar("y", |x| x[0] + x[1])).unwrap();
    let tied = tied.correlated(&[pair("x0", "x1", 1.0)]).unwrap();
    let tied = analyze(&tied, &Method::DimensionReduction.into()).unwrap();
    assert_eq!(tied.run.evaluations, 5);
    cumulants(moments(&tied), [0.0, 4.0, 0.0, 0.0], 1e-12);
}

/// The units of correlated dimensions do not matter, in contrast to eigenvectors of a covariance.
#[test]
fn eigenvectors_know_no_units() {
    let found = |unit: f64, method: Method| {
        let dimensions = normals(&[0.4, 0.3 * unit, 1.0], &[0.3, 0.6 * unit, 0.3]);
        let f = move |x: &[f64]| (x[0] * x[1] / unit).sin() + (x[1] / unit).exp() * x[2];
        let problem = Problem::new(dimensions, Closure::scalar("y", f)).unwrap();
        let problem = problem.correlated(&[pair("x0", "x1", 0.5), pair("x1", "x2", -0.3)]).unwrap();
        moments(&analyze(&problem, &method.into()).unwrap())
    };
    for method in REDUCTIONS {
        let (one, other) = (found(1.0, method), found(1024.0, method));
        relative(other.mean(), one.mean(), 1e-12);
        relative(other.sigma(), one.sigma(), 1e-11);
        close(other.excess().unwrap(), one.excess().unwrap(), 1e-10, 1.0);
    }
}

/// A sum of logarithms of lognormal inputs is normal for every correlation. The correlation of the underlying normal variables has the
/// closed form `ln(1 + r sqrt((e^(s^2) - 1)(e^(t^2) - 1)))/(s t)`.
#[test]
fn correlated_lognormals_have_normal_logarithms() {
    let (s, t, r) = (0.3f64, 0.5f64, 0.4f64);
    let lognormal = |name: &str, s: f64| {
        let mean = (0.5 * s * s).exp();
        of(name, Lognormal::new(0.0, mean, mean * (s * s).exp_m1().sqrt()).unwrap())
    };
    let asked = Asked::default();
    let function = asked.watching(|x| x[0].ln() + 2.0 * x[1].ln());
    let problem = Problem::new([lognormal("a", s), lognormal("b", t)], function).unwrap();
    let problem = problem.correlated(&[pair("a", "b", r)]).unwrap();
    let behind = (1.0 + r * ((s * s).exp_m1() * (t * t).exp_m1()).sqrt()).ln() / (s * t);
    let variance = s * s + 4.0 * t * t + 4.0 * behind * s * t;
    let found = analyze(&problem, &Method::DimensionReduction.into()).unwrap();
    // Quantiles are accurate to 1e-14, the correlation of the normal variables to 1e-12.
    cumulants(moments(&found), [0.0, variance, 0.0, 0.0], 1e-10);
    // The reference is at the medians, and the means are evaluated only as the nominal point.
    assert_eq!(found.run.evaluations, asked.distinct() as u64);
    assert!(asked.points().iter().any(|x| (x[0] - 1.0).abs() < 1e-12 && (x[1] - 1.0).abs() < 1e-12), "the medians");
    assert_eq!(found.characteristics[0].sensitivities[0].first, None, "no derivative at the means was had");
}

/// The number of evaluations is as stated, and each point is evaluated once: with symmetric inputs, and with others.
#[test]
fn counts_are_stated() {
    let count = |dimensions: Vec<Dimension>, options: &Options| {
        let asked = Asked::default();
        let problem = Problem::new(dimensions, asked.watching(|x| x.iter().sum())).unwrap();
        let procedure = procedure(options.method);
        let fits = procedure.fits(&problem, options).unwrap();
        assert_eq!(fits.evaluations, procedure.plan(&problem, options).unwrap().cost().0);
        let found = analyze(&problem, options).unwrap();
        assert_eq!(found.run.evaluations, asked.distinct() as u64);
        assert_eq!((found.run.evaluations, found.run.stages), (fits.evaluations as u64, fits.stages as u64));
        found.run.evaluations as usize
    };
    let skewed = |n: usize| -> Vec<Dimension> {
        (0..n).map(|j| of(&format!("x{j}"), Exponential::new(0.0, 1.0).unwrap())).collect()
    };
    for n in 1..=6 {
        for nodes in [3, 5, 7] {
            let (m, pairs) = (nodes - 1, n * (n - 1) / 2);
            assert_eq!(count(standard(n), &with_nodes(Method::DimensionReduction, nodes)), m * n + 1);
            assert_eq!(count(skewed(n), &with_nodes(Method::DimensionReduction, nodes)), nodes * n + 1);
            assert_eq!(
                count(standard(n), &with_nodes(Method::BivariateDimensionReduction, nodes)),
                1 + m * n + m * m * pairs
            );
        }
        assert_eq!(count(standard(n), &Method::ThreePoint.into()), 3usize.pow(n as u32));
        // If the mean is not among its levels, the nominal point is one more.
        assert_eq!(count(skewed(n), &Method::ThreePoint.into()), 3usize.pow(n as u32) + 1);
    }
    // A nominal value at a level, and one beside it. A dimension that does not vary has steps too.
    let normal = Normal::new(0.0, 1.0).unwrap();
    let level = Rule::three_point(&normal).nodes[2];
    let with_nominal = |nominal: f64| {
        let law = Arc::new(Normal::new(0.0, 1.0).unwrap());
        [standard(1), vec![Dimension::distributed("a", nominal, None, law).unwrap()]].concat()
    };
    let three = Options::from(Method::ThreePoint);
    assert_eq!(count(with_nominal(level), &three), 9);
    assert_eq!(count(with_nominal(0.9 * level), &three), 10);
    let still = [with_nominal(level), vec![Dimension::fixed("b", 3.0).unwrap()]].concat();
    assert_eq!(count(still.clone(), &three), 9);
    assert_eq!(count(still, &three.clone().with_all_sensitivities(true)), 11);
}

/// If a point is lost, the moments are unknown and the report names the point and the reason. All other results remain.
#[test]
fn a_lost_point_is_not_made_up() {
    for method in QUADRATURES {
        let function = refusing(|x| x[0] + x[1] * x[1] + x[2], |x| x[1] > 1.0);
        let found = analyze(&Problem::new(standard(3), function).unwrap(), &method.into()).unwrap();
        let one = &found.characteristics[0];
        assert_eq!((one.moments, one.distribution.capability, one.contributions.left_out_share), (None, None, None));
        assert!(one.sensitivities.iter().all(|row| row.linear_share.is_none()));
        close(one.sensitivities[0].first.unwrap(), 1.0, 1e-12, 1.0);
        assert!(found.run.failed > 0);
        let codes: Vec<&str> = found.warnings.iter().map(Warning::code).collect();
        assert!(codes.contains(&"failed-points") && codes.contains(&"lost-moments"), "{codes:?}");
    }
    let centre = refusing(|x| x[0], |x| x[0] == 0.0);
    let found = analyze(&Problem::new(standard(1), centre).unwrap(), &Method::DimensionReduction.into()).unwrap();
    assert_eq!((found.characteristics[0].moments, found.run.failed), (None, 1));
    let text = found.warnings.iter().find(|warning| warning.code() == "lost-moments").unwrap().message();
    assert_eq!(
        text,
        "Mean and sigma of `y` are unknown, and so is the rest: 1 of the 6 values of its quadrature is missing. Methods based on \
         derivatives tolerate lost points."
    );
}

/// A value that the options do not allow is one error, before any evaluation.
#[test]
fn wrong_wishes_are_refused() {
    let asked = Asked::default();
    let problem = |n: usize| Problem::new(standard(n), asked.watching(|x| x[0])).unwrap();
    let refused = |n: usize, options: Options| analyze(&problem(n), &options).unwrap_err().to_string();
    let three = |n: usize| refused(n, Method::ThreePoint.into());
    let errors = [
        three(30),
        three(100),
        refused(13, Options::from(Method::ThreePoint).with_budget(100)),
        refused(5, Options::from(Method::ThreePoint).with_budget(100)),
        refused(3, with_nodes(Method::DimensionReduction, 4)),
        refused(3, with_nodes(Method::BivariateDimensionReduction, 0)),
        refused(3, with_nodes(Method::ThreePoint, 5)),
        refused(3, with_nodes(Method::Full, 5)),
        refused(5, Options::from(Method::BivariateDimensionReduction).with_budget(10)),
        refused(400, Method::BivariateDimensionReduction.into()),
        refused(3, Options::from(Method::DimensionReduction).with_step(1.0)),
        refused(3, Options::from(Method::ThreePoint).with_pairs(Pairs::Adjacent)),
        refused(3, Options::from(Method::ResponseSurface).with_stencil(Stencil::FourPoint)),
        refused(3, Options::from(Method::DimensionReduction).with_derivatives(DerivativeSource::Exact)),
        refused(60, Method::ResponseSurface.into()),
        refused(5, Options::from(Method::ResponseSurface).with_budget(20)),
        refused(3, Options::from(Method::ResponseSurface).with_step(-1.0)),
    ];
    insta::assert_snapshot!(errors.join("\n"));
    let error = analyze(&problem(30), &Method::ThreePoint.into()).unwrap_err();
    assert_eq!(error.needed(), Some(205_891_132_094_649));
    assert!(matches!(error, MethodError::TooMany { dimensions: 30, .. }));
    assert!(asked.points().is_empty(), "something was evaluated");
}

/// Without varying dimensions the distribution is one value.
#[test]
fn zero_tolerance_everywhere() {
    for method in QUADRATURES.into_iter().chain([Method::ResponseSurface]) {
        let still = normals(&[2.0, 3.0], &[0.0, 0.0]);
        let found = analysis(still, &method.into(), |x| x[0] * x[1]);
        assert_eq!((found.run.evaluations, found.varying), (1, 0));
        assert_eq!(moments(&found), Moments::constant(6.0));
        // A dimension with zero tolerance changes no bit of the result.
        let f = |x: &[f64]| (x[0] * x[1]).sin() + x[1].exp();
        let two = analysis(normals(&[0.4, -0.3], &[0.3, 0.2]), &method.into(), f);
        let three = analysis(normals(&[0.4, -0.3, 7.0], &[0.3, 0.2, 0.0]), &method.into(), f);
        assert_eq!((moments(&two), two.run.evaluations), (moments(&three), three.run.evaluations));
        let constant = analysis(standard(2), &method.into(), |_| 0.1);
        assert_eq!(moments(&constant), Moments::constant(0.1));
        // A dimension without tolerance gets a sensitivity if one is asked for.
        let options = Options::from(method).with_all_sensitivities(true);
        let asked = analysis(normals(&[0.4, -0.3, 7.0], &[0.3, 0.2, 0.0]), &options, |x| x[0] + x[1] + 3.0 * x[2]);
        assert_eq!(asked.run.evaluations, three.run.evaluations + 2);
        close(asked.characteristics[0].sensitivities[2].first.unwrap(), 3.0, 1e-9, 1.0);
    }
}

/// Results have the same bits for any number of threads.
#[test]
fn threads_do_not_matter() {
    for method in QUADRATURES.into_iter().chain([Method::ResponseSurface]) {
        let on = |threads: usize| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
            let f = |x: &[f64]| (x[0] * x[1] + x[2]).sin() + (x[3] * x[4]).exp() + x[5] * x[0] * x[2];
            let mut found = pool.install(|| analysis(standard(6), &method.into(), f));
            found.run = RunSummary::default();
            found
        };
        assert_eq!(on(1), on(3));
    }
}
