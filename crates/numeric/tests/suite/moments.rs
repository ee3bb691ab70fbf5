//! Moments, compared with exact rationals and with enumeration, and their properties.

use proptest::prelude::*;
use sensitol_numeric::distribution::StandardMoments;
use sensitol_numeric::moments::Moments;

use sensitol_numeric::distribution::rule::Rule;
use sensitol_numeric::moments::{Interactions, Term, contributions, of_quadratic};
use sensitol_testing::{close, data, relative};

/// Double of a decimal or of a fraction `p/q`.
fn number(value: &serde_json::Value) -> f64 {
    let text = value.as_str().unwrap();
    match text.split_once('/') {
        None => text.parse().unwrap(),
        Some((p, q)) => p.parse::<f64>().unwrap() / q.parse::<f64>().unwrap(),
    }
}

fn numbers(value: &serde_json::Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(number).collect()
}

/// The oracle gives coefficients in the inputs' own units. The engine needs them per sigma.
#[test]
fn exact_rationals_are_met() {
    let cases = data("moments.json");
    let cases = cases["cases"].as_array().unwrap();
    assert_eq!(cases.len(), 10);
    for case in cases {
        let n = case["N"].as_u64().unwrap() as usize;
        let central: Vec<[f64; 7]> = (case["inputs"].as_array().unwrap().iter())
            .map(|input| numbers(&input["central_moments_2_8_dec"]).try_into().unwrap())
            .collect();
        let sigma: Vec<f64> = central.iter().map(|moments| moments[0].sqrt()).collect();
        let inputs: Vec<StandardMoments> = central.iter().map(StandardMoments::from_central).collect();
        let linear: Vec<f64> = numbers(&case["b"]).iter().zip(&sigma).map(|(b, sd)| b * sd).collect();
        let curved: Vec<f64> = numbers(&case["a"]).iter().zip(&sigma).map(|(a, sd)| a * sd * sd).collect();
        let upper = pairs(&case["A_upper"]);
        let pairs = upper.iter().map(|&(j, k, value)| (j, k, value * sigma[j] * sigma[k]));
        let moments = of_quadratic(number(&case["c"]), &linear, &curved, &Interactions::of_pairs(n, pairs), &inputs);
        let exact = &case["exact"];
        relative(moments.mean(), number(&exact["mean"]), 1e-12);
        relative(moments.sigma(), number(&exact["sigma"]), 1e-12);
        relative(moments.skewness().unwrap(), number(&exact["skewness"]), 1e-12);
        relative(moments.kurtosis().unwrap(), number(&exact["kurtosis"]), 1e-12);
        relative(moments.excess().unwrap() * moments.variance().powi(2), number(&exact["kappa4"]), 1e-11);
    }
}

/// Parses triplets `[j, k, "value"]`.
fn pairs(value: &serde_json::Value) -> Vec<(usize, usize, f64)> {
    let index = |value: &serde_json::Value| value.as_u64().unwrap() as usize;
    value.as_array().unwrap().iter().map(|pair| (index(&pair[0]), index(&pair[1]), number(&pair[2]))).collect()
}

/// A discrete input: standardised points and their probabilities.
#[derive(Debug, Clone)]
struct Discrete {
    rule: Rule,
    moments: StandardMoments,
}

impl Discrete {
    fn new(points: &[f64], weights: &[f64]) -> Self {
        let total: f64 = weights.iter().sum();
        let weights: Vec<f64> = weights.iter().map(|weight| weight / total).collect();
        let mean: f64 = points.iter().zip(&weights).map(|(x, w)| x * w).sum();
        let variance: f64 = points.iter().zip(&weights).map(|(x, w)| w * (x - mean).powi(2)).sum();
        let nodes: Vec<f64> = points.iter().map(|x| (x - mean) / variance.sqrt()).collect();
        let rule = Rule { nodes, weights };
        let moment = |order: i32| rule.mean(|u| u.powi(order));
        let moments = StandardMoments::from_standard([3, 4, 5, 6, 7, 8].map(moment));
        Self { rule, moments }
    }
}

/// Mean, sigma, skewness and kurtosis by enumeration of all combinations of the inputs' points.
fn enumerated(inputs: &[Discrete], value: impl Fn(&[f64]) -> f64) -> [f64; 4] {
    let mut all = vec![(Vec::new(), 1.0)];
    for input in inputs {
        let step = |(point, weight): &(Vec<f64>, f64)| -> Vec<(Vec<f64>, f64)> {
            let nodes = input.rule.nodes.iter().zip(&input.rule.weights);
            nodes.map(|(&u, w)| ([point.as_slice(), &[u]].concat(), weight * w)).collect()
        };
        all = all.iter().flat_map(step).collect();
    }
    let values: Vec<(f64, f64)> = all.iter().map(|(point, weight)| (value(point), *weight)).collect();
    let mean: f64 = values.iter().map(|(y, w)| w * y).sum();
    let central = |order: i32| values.iter().map(|(y, w)| w * (y - mean).powi(order)).sum::<f64>();
    let sigma = central(2).sqrt();
    [mean, sigma, central(3) / sigma.powi(3), central(4) / sigma.powi(4)]
}

#[track_caller]
fn same(found: Moments, [mean, sigma, skewness, kurtosis]: [f64; 4], tolerance: f64) {
    close(found.mean(), mean, tolerance, sigma);
    relative(found.sigma(), sigma, tolerance);
    close(found.skewness().unwrap(), skewness, tolerance, 1.0);
    close(found.kurtosis().unwrap(), kurtosis, tolerance, 1.0);
}

fn discrete() -> impl Strategy<Value = Discrete> {
    (prop::collection::vec(0.1..1.0f64, 2..4), prop::collection::vec(0.5..2.0f64, 3)).prop_map(|(weights, gaps)| {
        let mut at = 0.0;
        let points: Vec<f64> = (weights.iter().zip(gaps))
            .map(|(_, gap)| {
                at += gap;
                at
            })
            .collect();
        Discrete::new(&points, &weights)
    })
}

/// Coefficients of a quadratic of `inputs.len()` inputs: linear, curved, and a matrix whose upper half is used.
fn quadratic(inputs: std::ops::Range<usize>) -> impl Strategy<Value = (Vec<Discrete>, Vec<f64>, Vec<f64>, Vec<f64>)> {
    prop::collection::vec(discrete(), inputs).prop_flat_map(|inputs| {
        let n = inputs.len();
        let coefficients = |count| prop::collection::vec(-2.0..2.0f64, count);
        (Just(inputs), coefficients(n), coefficients(n), coefficients(n * n))
    })
}

fn upper(n: usize, matrix: &[f64]) -> Vec<(usize, usize, f64)> {
    (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k, matrix[j * n + k]))).collect()
}

/// True unless line and parabola of an input with two values cancel. The rounded moments of the input are then too inexact, and a kurtosis
/// has the fourth power of their error.
fn nothing_cancels(found: &Moments, linear: &[f64], curved: &[f64]) -> bool {
    let largest = linear.iter().chain(curved).fold(0.0f64, |largest, value| largest.max(value.abs()));
    found.sigma() > 0.1 * largest
}

fn value(u: &[f64], linear: &[f64], curved: &[f64], pairs: &[(usize, usize, f64)]) -> f64 {
    let own: f64 = (0..u.len()).map(|j| linear[j] * u[j] + curved[j] * (u[j] * u[j] - 1.0)).sum();
    own + pairs.iter().map(|&(j, k, a)| a * u[j] * u[k]).sum::<f64>()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]

    /// Both products are tested with 1 to 9 inputs: the sparse one and, from 8 on, the dense one. The tolerance is 1e-9, since the
    /// enumeration itself sums up to 2e4 terms and subtracts the mean.
    #[test]
    fn enumeration_is_met((inputs, linear, curved, matrix) in quadratic(1..10)) {
        let n = inputs.len();
        let pairs = upper(n, &matrix);
        let moments: Vec<StandardMoments> = inputs.iter().map(|input| input.moments).collect();
        let found = of_quadratic(0.0, &linear, &curved, &Interactions::of_pairs(n, pairs.clone()), &moments);
        prop_assume!(nothing_cancels(&found, &linear, &curved));
        same(found, enumerated(&inputs, |u| value(u, &linear, &curved, &pairs)), 1e-9);
    }

    /// Univariate parts of any shape, given as tables.
    #[test]
    fn tables_are_met((inputs, linear, curved, matrix) in quadratic(1..6)) {
        let n = inputs.len();
        let pairs = upper(n, &matrix);
        let own = |j: usize, u: f64| (linear[j] * u).exp() + curved[j] * u.powi(3);
        let terms: Vec<Term<'_>> = (inputs.iter().enumerate())
            .map(|(j, input)| Term::Tabulated {
                values: input.rule.nodes.iter().map(|&u| own(j, u)).collect(),
                rule: &input.rule,
                moments: &input.moments,
            })
            .collect();
        let found = contributions(3.0, &terms, &Interactions::of_pairs(n, pairs.clone()));
        prop_assume!(nothing_cancels(&found.moments, &linear, &curved));
        let exact = enumerated(&inputs, |u| {
            3.0 + (0..n).map(|j| own(j, u[j])).sum::<f64>() + value(u, &vec![0.0; n], &vec![0.0; n], &pairs)
        });
        same(found.moments, exact, 1e-9);
        let shares: f64 = found.linear.iter().chain(&found.curvature).sum();
        let products: f64 = pairs.iter().map(|(_, _, a)| (a * found.per_sigma).powi(2)).sum();
        close(shares + products, 1.0, 1e-12, 1.0);
    }

    /// A parabola as a table has the same moments as by the input's moments.
    #[test]
    fn a_parabola_is_a_parabola(input in discrete(), b in -2.0..2.0f64, a in -2.0..2.0f64) {
        let values = input.rule.nodes.iter().map(|&u| b * u + a * u * u).collect();
        let table = Term::Tabulated { values, rule: &input.rule, moments: &input.moments }.part(1.0);
        let parabola = Term::Quadratic { linear: b, curvature: a, moments: &input.moments }.part(1.0);
        for (found, expected) in [(table.k3, parabola.k3), (table.k4, parabola.k4), (table.c22, parabola.c22),
            (table.c13, parabola.c13), (table.w, parabola.w), (table.q, parabola.q), (table.curved, parabola.curved)]
        {
            close(found, expected, 1e-10, 10.0);
        }
    }

    /// Coefficients times a factor: sigma is multiplied by its size, and a negative factor mirrors the shape.
    #[test]
    fn scale_does_not_matter((inputs, linear, curved, matrix) in quadratic(1..6), power in -150..150i32, minus: bool) {
        let factor = 10f64.powi(power) * if minus { -1.0 } else { 1.0 };
        let n = inputs.len();
        let moments: Vec<StandardMoments> = inputs.iter().map(|input| input.moments).collect();
        let of = |factor: f64| {
            let scaled = |values: &[f64]| values.iter().map(|value| factor * value).collect::<Vec<f64>>();
            let pairs = Interactions::of_pairs(n, upper(n, &scaled(&matrix)));
            of_quadratic(0.0, &scaled(&linear), &scaled(&curved), &pairs, &moments)
        };
        let (one, other) = (of(1.0), of(factor));
        prop_assume!(nothing_cancels(&one, &linear, &curved));
        relative(other.sigma(), one.sigma() * factor.abs(), 1e-13);
        close(other.skewness().unwrap(), factor.signum() * one.skewness().unwrap(), 1e-12, 1.0);
        close(other.excess().unwrap(), one.excess().unwrap(), 1e-12, 1.0);
    }

    /// The result depends neither on the order of the inputs nor on their direction.
    #[test]
    fn order_and_direction_of_inputs_do_not_matter((inputs, linear, curved, matrix) in quadratic(2..6)) {
        let n = inputs.len();
        let pairs = upper(n, &matrix);
        let moments: Vec<StandardMoments> = inputs.iter().map(|input| input.moments).collect();
        let one = of_quadratic(0.0, &linear, &curved, &Interactions::of_pairs(n, pairs.clone()), &moments);
        prop_assume!(nothing_cancels(&one, &linear, &curved));
        // In reverse order, and with the first input in the opposite direction.
        let back = |values: &[f64]| values.iter().rev().copied().collect::<Vec<f64>>();
        let mut turned = back(&linear);
        turned[n - 1] = -turned[n - 1];
        let mut mirrored: Vec<StandardMoments> = moments.iter().rev().copied().collect();
        let m = mirrored[n - 1];
        mirrored[n - 1] =
            StandardMoments::from_standard([-m.skewness, m.kurtosis(), -m.m5, m.m6, -m.m7, m.m8]);
        let signed = pairs.iter().map(|&(j, k, a)| (n - 1 - j, n - 1 - k, if j == 0 { -a } else { a }));
        let other = of_quadratic(0.0, &turned, &back(&curved), &Interactions::of_pairs(n, signed), &mirrored);
        relative(other.sigma(), one.sigma(), 1e-13);
        close(other.skewness().unwrap(), one.skewness().unwrap(), 1e-12, 1.0);
        close(other.excess().unwrap(), one.excess().unwrap(), 1e-12, 1.0);
    }

    /// A quadratic of normal inputs has kurtosis - 3 >= (4/3) skewness^2.
    #[test]
    fn normal_inputs_keep_their_bound((inputs, linear, curved, matrix) in quadratic(1..12)) {
        let n = inputs.len();
        let pairs = Interactions::of_pairs(n, upper(n, &matrix));
        let moments = of_quadratic(0.0, &linear, &curved, &pairs, &vec![StandardMoments::NORMAL; n]);
        let bound = 4.0 / 3.0 * moments.skewness().unwrap().powi(2);
        prop_assert!(moments.excess().unwrap() >= bound - 1e-12);
    }

    /// An input without effect changes no bit.
    #[test]
    fn an_idle_input_changes_nothing((inputs, linear, curved, matrix) in quadratic(1..6)) {
        let n = inputs.len();
        let mut moments: Vec<StandardMoments> = inputs.iter().map(|input| input.moments).collect();
        let of = |linear: &[f64], curved: &[f64], moments: &[StandardMoments]| {
            of_quadratic(0.0, linear, curved, &Interactions::of_pairs(moments.len(), upper(n, &matrix)), moments)
        };
        let one = of(&linear, &curved, &moments);
        moments.push(StandardMoments::NORMAL);
        let other = of(&[linear.as_slice(), &[0.0]].concat(), &[curved.as_slice(), &[0.0]].concat(), &moments);
        prop_assert_eq!(one, other);
    }
}

/// Skewness and excess of `b u + a (u^2 - 1)` with normal u, relative to themselves, so that no larger term hides an error.
#[test]
fn a_tiny_curvature_keeps_its_digits() {
    for a in [1e-3, 1e-6, 1e-9, 1e-12] {
        let moments = of_quadratic(0.0, &[1.0], &[a], &Interactions::none(1), &[StandardMoments::NORMAL]);
        let variance = 1.0 + 2.0 * a * a;
        relative(moments.skewness().unwrap(), (6.0 * a + 8.0 * a.powi(3)) / variance.powf(1.5), 1e-14);
        relative(moments.excess().unwrap(), (48.0 * a * a + 48.0 * a.powi(4)) / variance.powi(2), 1e-14);
    }
}

/// One input has a million times the effect of the others.
#[test]
fn a_dominating_input_does_not_drown_the_others() {
    let n = 20;
    let mut linear = vec![1.0; n];
    linear[7] = 1e6;
    let inputs = vec![StandardMoments::NORMAL; n];
    let moments = of_quadratic(5.0, &linear, &vec![0.0; n], &Interactions::none(n), &inputs);
    relative(moments.sigma(), (1e12 + 19.0f64).sqrt(), 1e-15);
    assert_eq!((moments.skewness(), moments.excess()), (Some(0.0), Some(0.0)));
}

/// The sum of a thousand equal chi-squared variables has the skewness sqrt(8/n) and the excess 12/n.
#[test]
fn a_thousand_squares() {
    let n = 1000;
    let moments =
        of_quadratic(0.0, &vec![0.0; n], &vec![1.0; n], &Interactions::none(n), &vec![StandardMoments::NORMAL; n]);
    relative(moments.sigma(), 2000f64.sqrt(), 1e-14);
    relative(moments.skewness().unwrap(), 0.008f64.sqrt(), 1e-13);
    relative(moments.excess().unwrap(), 0.012, 1e-13);
}

/// The square `(sum u)^2` of n normal inputs is n times a chi-squared variable with one degree of freedom, for any n. All pairs interact,
/// so the dense product is used.
#[test]
fn the_square_of_a_sum() {
    for n in [2, 7, 8, 30, 300, 1000] {
        let pairs = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k, 2.0)));
        let interactions = Interactions::of_pairs(n, pairs);
        let inputs = vec![StandardMoments::NORMAL; n];
        let moments = of_quadratic(0.0, &vec![0.0; n], &vec![1.0; n], &interactions, &inputs);
        relative(moments.sigma(), n as f64 * 2f64.sqrt(), 1e-13);
        relative(moments.skewness().unwrap(), 8f64.sqrt(), 1e-13);
        relative(moments.kurtosis().unwrap(), 15.0, 1e-13);
    }
}

/// Heavily skewed input: an exponential variable is its own linear function.
#[test]
fn a_heavily_skewed_input_passes_through() {
    let exponential = StandardMoments::from_standard([2.0, 9.0, 44.0, 265.0, 1854.0, 14833.0]);
    let moments = of_quadratic(0.0, &[-3.0], &[0.0], &Interactions::none(1), &[exponential]);
    assert_eq!((moments.sigma(), moments.skewness(), moments.kurtosis()), (3.0, Some(-2.0), Some(9.0)));
}

#[test]
fn a_characteristic_that_does_not_vary_has_no_shape() {
    let moments = of_quadratic(4.0, &[0.0], &[0.0], &Interactions::none(1), &[StandardMoments::NORMAL]);
    assert_eq!((moments.mean(), moments.sigma(), moments.skewness(), moments.kurtosis()), (4.0, 0.0, None, None));
}

/// Sparse and dense products agree: a ring of interactions, alone and with all other pairs at 0.
#[test]
fn sparse_and_dense_agree() {
    let n = 60;
    let ring: Vec<_> = (0..n).map(|j| (j, (j + 1) % n, 0.1 + 0.01 * j as f64)).collect();
    let zeros = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k)));
    let zeros = zeros.filter(|&(j, k)| k - j != 1 && (j, k) != (0, n - 1)).map(|(j, k)| (j, k, 0.0));
    let skewed = StandardMoments::from_standard([0.7, 4.0, 8.0, 40.0, 120.0, 700.0]);
    let linear: Vec<f64> = (0..n).map(|j| (j as f64).sin()).collect();
    let curved: Vec<f64> = (0..n).map(|j| 0.3 * (j as f64).cos()).collect();
    let of = |interactions| of_quadratic(0.0, &linear, &curved, &interactions, &vec![skewed; n]);
    let sparse = of(Interactions::of_pairs(n, ring.clone()));
    let dense = of(Interactions::of_pairs(n, ring.into_iter().chain(zeros)));
    relative(dense.sigma(), sparse.sigma(), 1e-14);
    close(dense.skewness().unwrap(), sparse.skewness().unwrap(), 1e-13, 1.0);
    close(dense.excess().unwrap(), sparse.excess().unwrap(), 1e-13, 1.0);
}
