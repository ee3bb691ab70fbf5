//! Distribution of a surface, compared with independent results for 78 surfaces, and its properties.

use std::sync::{Arc, LazyLock};

use sensitol_numeric::correlation::{Correlation, Pair};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{
    Beta, Distribution, Exponential, Gamma, Lognormal, Measured, Mixture, Normal, Part, Trapezoidal, Triangular,
    Uniform, Weibull,
};
use sensitol_numeric::law::LawTail;
use sensitol_numeric::law::{Branch, LawError, LawFigure};

use sensitol_numeric::distribution::rule::Rule;
use sensitol_numeric::law::{LawOptions, SurfaceLaw};
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{Inputs, Surrogate, Univariate, shapes};
use sensitol_testing::repository;
use serde_json::Value;

type Law = Arc<dyn Distribution>;

fn number(value: &Value) -> f64 {
    value.as_f64().unwrap()
}

fn list(value: &Value) -> &[Value] {
    value.as_array().map_or(&[], Vec::as_slice)
}

/// Input distribution of the oracles' file. The surface standardises it.
fn input(law: &Value) -> Law {
    let of = |key: &str| number(&law[key]);
    match law["kind"].as_str().unwrap() {
        "normal" => Arc::new(Normal::new(0.0, 1.0).unwrap()),
        "uniform" => Arc::new(Uniform::new(-1.0, 1.0).unwrap()),
        "exponential" => Arc::new(Exponential::new(0.0, 1.0).unwrap()),
        "triangular" => Arc::new(Triangular::new(0.0, law["mode"].as_f64().unwrap_or(0.5), 1.0).unwrap()),
        "trapezoidal" => Arc::new(Trapezoidal::new(0.0, 1.0, of("top")).unwrap()),
        "beta" => Arc::new(Beta::new(0.0, 1.0, of("alpha"), of("beta")).unwrap()),
        "gamma" => Arc::new(Gamma::new(0.0, of("shape"), of("shape").sqrt()).unwrap()),
        "weibull" => {
            let moment = |k: f64| libm::tgamma(1.0 + k / of("shape"));
            let (mean, square) = (moment(1.0), moment(2.0));
            Arc::new(Weibull::new(0.0, mean, (square - mean * mean).sqrt()).unwrap())
        }
        "lognormal" => {
            let variance = of("s") * of("s");
            let mean = (0.5 * variance).exp();
            Arc::new(Lognormal::new(0.0, mean, mean * variance.exp_m1().sqrt()).unwrap())
        }
        "mixture" => {
            let part = |part: &Value| {
                assert_eq!(part["law"]["kind"], "normal");
                let distribution = Arc::new(Normal::new(number(&part["mean"]), number(&part["sigma"])).unwrap());
                Part { name: String::new(), weight: number(&part["weight"]), distribution }
            };
            Arc::new(Mixture::new(list(&law["parts"]).iter().map(part).collect()).unwrap())
        }
        other => panic!("a law that is not read: {other}"),
    }
}

/// A surface of the oracles' file, with its inputs.
fn surface(of: &Value) -> (Surrogate, Vec<Law>) {
    let inputs = list(&of["inputs"]);
    let coefficients = |input: &Value| list(&input["g"]["poly"]).iter().map(number).collect::<Vec<_>>();
    let parts = inputs.iter().map(|input| Some(Univariate::of_coefficients(&coefficients(input)))).collect();
    let place = |value: &Value| value.as_u64().unwrap() as usize;
    let pairs = list(&of["pairs"]).iter().map(|pair| (place(&pair[0]), place(&pair[1]), number(&pair[2])));
    let interactions = Interactions::of_pairs(inputs.len(), pairs);
    let centre = of["c"].as_f64().unwrap_or(0.0);
    (Surrogate { centre, parts, interactions }, inputs.iter().map(|spec| input(&spec["law"])).collect())
}

fn law_of(of: &(Surrogate, Vec<Law>)) -> SurfaceLaw {
    SurfaceLaw::of(&of.0, &of.1, None, &LawOptions::default()).unwrap()
}

static ORACLES: LazyLock<Vec<Value>> = LazyLock::new(|| {
    let text = std::fs::read_to_string(repository("tests/data/law.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
});

/// Group of the table that states the accuracy of the distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Group {
    Uniforms,
    UniformsAndNormal,
    Forms,
    Trees,
    Pairs,
    Cycles,
}

fn group(oracle: &Value) -> Group {
    let inputs = list(&oracle["surface"]["inputs"]);
    let (n, pairs) = (inputs.len(), list(&oracle["surface"]["pairs"]).len());
    let all = |kinds: &[&str]| inputs.iter().all(|i| kinds.contains(&i["law"]["kind"].as_str().unwrap()));
    let parabolas = inputs.iter().all(|i| list(&i["g"]["poly"]).len() <= 2);
    match () {
        _ if all(&["normal"]) && parabolas => Group::Forms,
        _ if n <= 2 => Group::Pairs,
        _ if all(&["uniform"]) && pairs == 0 => Group::Uniforms,
        _ if all(&["uniform", "normal"]) && pairs == 0 => Group::UniformsAndNormal,
        _ if pairs < n => Group::Trees,
        _ => Group::Cycles,
    }
}

/// Errors of a distribution against an oracle: the largest errors, and their ratio to the stated error.
#[derive(Debug, Default, Clone, Copy)]
struct Worst {
    absolute: f64,
    /// Largest relative error in a tail of at most 0.01.
    relative: f64,
    /// Error less that of the oracle, divided by the stated error.
    covered: f64,
    stated: f64,
}

impl Worst {
    fn with(self, other: Self) -> Self {
        Self {
            absolute: self.absolute.max(other.absolute),
            relative: self.relative.max(other.relative),
            covered: self.covered.max(other.covered),
            stated: self.stated.max(other.stated),
        }
    }

    fn of(found: LawFigure, expected: f64, own: f64) -> Self {
        let off = (found.value - expected).abs();
        assert!(!off.is_nan(), "{found:?} for {expected}");
        let excess = (off - own).max(0.0);
        Self {
            absolute: off,
            relative: if expected < 0.01 { off / expected } else { 0.0 },
            covered: if excess == 0.0 { 0.0 } else { excess / found.error },
            stated: found.error,
        }
    }
}

fn limits(oracle: &Value, law: &SurfaceLaw) -> Worst {
    let relative = number(&oracle["relative"]);
    let of = |limit: &Value| {
        let y = number(&limit["y"]);
        [("cdf", LawTail::Lower), ("sf", LawTail::Upper)].map(|(key, tail)| {
            let (found, expected) = (law.tail(y, tail), number(&limit[key]));
            // Limits in the file have the 10 digits that were used. Probabilities are exact to a double's last digit.
            let worst = Worst::of(found, expected, (relative + 3e-16) * expected);
            if std::env::var("SENSITOL_LAW_TABLE").is_ok() && worst.covered > 0.5 {
                println!("  {} {key} at {y}: {found:?} for {expected}: {worst:?}", oracle["name"]);
            }
            worst
        })
    };
    list(&oracle["limits"]).iter().flat_map(of).fold(Worst::default(), Worst::with)
}

/// Largest errors of all oracles of a group. Prints the table of accuracies if SENSITOL_LAW_TABLE is set.
fn worst(group_of: Group, covered: f64) -> Worst {
    let mut all = Worst::default();
    for oracle in ORACLES.iter().filter(|oracle| group(oracle) == group_of) {
        let law = law_of(&surface(&oracle["surface"]));
        let worst = limits(oracle, &law);
        if std::env::var("SENSITOL_LAW_TABLE").is_ok() {
            println!("{group_of:?} {:?} {} {worst:?}", law.branch(), oracle["name"]);
        }
        assert!(worst.covered <= covered, "{}: {worst:?}", oracle["name"]);
        all = all.with(worst);
    }
    all
}

#[test]
fn sums_of_uniforms_agree_with_sums_of_corners() {
    let worst = worst(Group::Uniforms, 1.0);
    assert!(worst.absolute < 1e-9 && worst.relative < 1e-7, "{worst:?}");
}

#[test]
fn uniforms_and_a_normal_agree_with_repeated_integrals() {
    let worst = worst(Group::UniformsAndNormal, 1.0);
    assert!(worst.absolute < 1e-11 && worst.relative < 1e-10, "{worst:?}");
}

#[test]
fn quadratic_forms_agree_with_partial_fractions() {
    let worst = worst(Group::Forms, 1.0);
    assert!(worst.absolute < 1e-6 && worst.relative < 1e-8, "{worst:?}");
}

#[test]
fn trees_agree_with_tensor_quadrature() {
    let worst = worst(Group::Trees, 1.0);
    assert!(worst.absolute < 1e-9 && worst.relative < 1e-7, "{worst:?}");
}

#[test]
fn two_inputs_agree_with_graded_panels() {
    let worst = worst(Group::Pairs, 1.0);
    assert!(worst.absolute < 1e-7 && worst.relative < 1e-5, "{worst:?}");
}

#[test]
fn cycles_agree_with_tensor_quadrature() {
    // One in a hundred figures may exceed the stated error. The worst of 108 figures may exceed it by half.
    let worst = worst(Group::Cycles, 1.5);
    // With 2^13 points. At 1e-9 of the lower tail the error is a sixth: a corner of the support is near, which no single tilt reaches.
    assert!(worst.absolute < 1e-4 && worst.relative < 0.3, "{worst:?}");
}

/// Quantiles of every oracle. Their error is at most the stated one and the uncertainty of the oracle's own probability.
#[test]
fn quantiles_agree_with_those_of_the_other_routes() {
    for oracle in ORACLES.iter() {
        let law = law_of(&surface(&oracle["surface"]));
        for quantile in list(&oracle["quantiles"]) {
            let p = number(&quantile["p"]);
            let tail = if quantile["upper"].as_bool().unwrap() { LawTail::Upper } else { LawTail::Lower };
            let (found, expected) = (law.quantile(tail, p), number(&quantile["y"]));
            let density = law.density(expected).value;
            // Quantiles of the file are accurate to 1e-12 sigma. If their probabilities are known to 1e-9 only, that accuracy counts. The
            // limit itself is rounded.
            let own = 1e-8 * p / density + 1e-11 * law.sigma();
            let off = (found.value - expected).abs();
            let factor = if law.branch() == Branch::Sampled { 1.5 } else { 1.0 };
            assert!(
                off <= factor * found.error + own,
                "{} at {p} {tail:?}: {found:?} for {expected}, off {off:e}, own {own:e}",
                oracle["name"]
            );
        }
    }
}

fn normal() -> Law {
    Arc::new(Normal::new(3.0, 0.5).unwrap())
}

fn uniform() -> Law {
    Arc::new(Uniform::new(-1.0, 1.0).unwrap())
}

fn triangular() -> Law {
    Arc::new(Triangular::new(0.0, 0.2, 1.0).unwrap())
}

fn of(centre: f64, parts: &[&[f64]], pairs: &[(usize, usize, f64)]) -> Surrogate {
    let interactions = Interactions::of_pairs(parts.len(), pairs.iter().copied());
    let parts = parts.iter().map(|part| Some(Univariate::of_coefficients(part))).collect();
    Surrogate { centre, parts, interactions }
}

fn made(surrogate: &Surrogate, inputs: &[Law]) -> SurfaceLaw {
    SurfaceLaw::of(surrogate, inputs, None, &LawOptions::default()).unwrap()
}

/// One case of each method of the exact branch: a form, hats, panels, a tree, and all of them together.
fn exact_laws() -> Vec<(Surrogate, Vec<Law>)> {
    let pairs = [(0, 1, 0.3), (1, 2, -0.2), (0, 2, 0.4)];
    vec![
        (of(1.0, &[&[1.0, 0.2], &[0.5, -0.1], &[0.3]], &pairs), vec![normal(), normal(), normal()]),
        (of(-2.0, &[&[1.0], &[0.4], &[0.7]], &[]), vec![uniform(), uniform(), uniform()]),
        (of(0.0, &[&[1.0, 0.1], &[0.4, 0.1], &[0.7, 0.0, 0.05]], &[]), vec![triangular(), uniform(), triangular()]),
        (of(5.0, &[&[1.0], &[0.4], &[0.7]], &[(0, 1, 0.2), (1, 2, 0.1)]), vec![uniform(), triangular(), normal()]),
        (
            of(0.0, &[&[1.0], &[0.4, 0.1], &[0.7], &[0.3, 0.05], &[0.2]], &[(2, 3, 0.1)]),
            vec![uniform(), triangular(), normal(), normal(), uniform()],
        ),
    ]
}

/// Within 1.5 sigma of the mean the two tails have different contours. They sum to 1 within their stated errors: 1e-12, and more next to a
/// corner of the distribution.
#[test]
fn both_tails_sum_to_1() {
    for (surrogate, inputs) in exact_laws() {
        let law = made(&surrogate, &inputs);
        assert_eq!(law.branch(), Branch::Exact);
        for k in -4..=4 {
            let y = law.mean() + 0.35 * f64::from(k) * law.sigma();
            let (below, above) = (law.below(y), law.above(y));
            let off = (below.value + above.value - 1.0).abs();
            assert!(off < 1e-12, "{off:e} at {y}: {below:?} {above:?}");
        }
    }
}

#[test]
fn a_cdf_rises_and_its_slope_is_the_density() {
    for (surrogate, inputs) in exact_laws() {
        let law = made(&surrogate, &inputs);
        let at = |k: i32| law.mean() + 0.9 * f64::from(k) * law.sigma();
        for k in -4..4 {
            let (low, high) = (law.below(at(k)), law.below(at(k + 1)));
            assert!(low.value <= high.value + low.error + high.error);
            let (y, step) = (at(k) + 0.3 * law.sigma(), 1e-3 * law.sigma());
            let cdf = |by: f64| law.below(y + by * step).value;
            // Central differences of fourth order: the truncation error is about 1e-12 (step to the fourth power),
            // and rounding is divided by the step.
            let slope = (8.0 * (cdf(1.0) - cdf(-1.0)) - (cdf(2.0) - cdf(-2.0))) / (12.0 * step);
            let off = (slope - law.density(y).value).abs() * law.sigma();
            // Densities with uniform inputs have corners.
            assert!(off < 1e-6, "{off:e} at {y}");
        }
    }
}

#[test]
fn a_quantile_inverts_its_tail() {
    for (surrogate, inputs) in exact_laws() {
        let law = made(&surrogate, &inputs);
        for p in [0.5, 0.3, 1e-2, 1e-5, 1e-8] {
            for tail in [LawTail::Lower, LawTail::Upper] {
                let y = law.quantile(tail, p).value;
                // A limit is a double. Its rounding times the density matters next to an end of the support, where the density is large
                // relative to p.
                let rounding = 4e-16 * (y.abs() + law.sigma()) * law.density(y).value;
                let off = (law.tail(y, tail).value - p).abs();
                assert!(off < 1e-11 * p + 4.0 * rounding, "{tail:?} {p}: {off:e}");
            }
        }
        // A probability above one half is computed from the other tail.
        let (a, b) = (law.quantile(LawTail::Lower, 0.75).value, law.quantile(LawTail::Upper, 0.25).value);
        assert_eq!(a, b);
    }
}

fn scaled(surrogate: &Surrogate, by: f64) -> Surrogate {
    let parts = surrogate.parts.iter().map(|part| {
        let coefficients = part.unwrap().coefficients().map(|c| c * by);
        Some(Univariate::of_coefficients(&coefficients))
    });
    let pairs = surrogate.interactions.pairs().into_iter().map(|(j, k, b)| (j, k, b * by));
    let interactions = Interactions::of_pairs(surrogate.parts.len(), pairs);
    Surrogate { centre: surrogate.centre * by, parts: parts.collect(), interactions }
}

/// Another unit and a reflection change rounding only. The sampled branch has the same points in any unit. In a reflection it has them too,
/// since its direction changes its sign only.
#[test]
fn units_and_reflections_change_nothing() {
    let cycle = of(0.0, &[&[1.0], &[0.8, 0.1], &[0.6]], &[(0, 1, 0.1), (1, 2, 0.1), (0, 2, -0.1)]);
    let mut all = exact_laws();
    all.push((cycle, vec![uniform(), triangular(), triangular()]));
    for (surrogate, inputs) in all {
        let law = made(&surrogate, &inputs);
        for by in [1e-6, 1e7, -1.0] {
            let other = made(&scaled(&surrogate, by), &inputs);
            for k in [-4.0, -2.0, -0.5, 0.5, 3.0] {
                let y = law.mean() + k * law.sigma();
                let (one, same) = (law.above(y), if by > 0.0 { other.above(y * by) } else { other.below(y * by) });
                // Exact distributions agree to 1e-12. Sampled ones agree within the errors, since reflected points may differ.
                let allowed = if law.branch() == Branch::Sampled { one.error + same.error } else { 2e-11 * one.value };
                assert!((one.value - same.value).abs() <= allowed + 1e-15, "{by} {k}: {one:?} {same:?}");
            }
        }
    }
}

#[test]
fn the_order_of_inputs_changes_nothing() {
    for (surrogate, inputs) in exact_laws() {
        let n = inputs.len();
        let parts: Vec<_> = (0..n).map(|j| surrogate.parts[n - 1 - j]).collect();
        let pairs = surrogate.interactions.pairs().into_iter().map(|(j, k, b)| (n - 1 - j, n - 1 - k, b));
        let interactions = Interactions::of_pairs(n, pairs);
        let turned: Vec<Law> = inputs.iter().rev().cloned().collect();
        let (one, other) =
            (made(&surrogate, &inputs), made(&Surrogate { centre: surrogate.centre, parts, interactions }, &turned));
        for k in [-3.0, -1.0, 0.2, 2.0, 4.0] {
            let y = one.mean() + k * one.sigma();
            let (a, b) = (one.above(y), other.above(y));
            // Trees start from another root. Both results are accurate to 1e-12.
            assert!((a.value - b.value).abs() <= 2e-12 * a.value + 1e-15, "{k}: {a:?} {b:?}");
        }
    }
}

/// Moments of the distribution, by panels over its density, equal the exact moments of the surface.
#[test]
fn moments_of_the_law_are_those_of_the_surface() {
    // The last two have a normal input with a slope only, so their density is smooth. A form has a corner at its vertex, and uniform inputs
    // have corners too, which cost these panels digits.
    let [form, uniforms, _, _, mixed] = <[(Surrogate, Vec<Law>); 5]>::try_from(exact_laws()).unwrap();
    let pairs = [(0, 1, 0.3), (1, 2, -0.2), (0, 2, 0.4)];
    let smooth = of(1.0, &[&[1.0, 0.2], &[0.5, -0.1], &[0.3], &[0.8]], &pairs);
    let smooth = (smooth, vec![normal(), normal(), normal(), normal()]);
    for ((surrogate, inputs), allowed) in [(form, 1e-8), (uniforms, 1e-5), (smooth, 1e-9), (mixed, 1e-9)] {
        let law = made(&surrogate, &inputs);
        let shapes = Inputs::independent(shapes(inputs.iter().map(|law| law.as_ref())));
        let moments = surrogate.contributions(&shapes).unwrap().moments;
        let (mean, sigma) = (moments.mean(), moments.sigma());
        assert!((law.mean() - mean).abs() < 1e-12 * sigma && (law.sigma() / sigma - 1.0).abs() < 1e-12);
        let expected = [1.0, 0.0, 1.0, moments.skewness().unwrap(), moments.kurtosis().unwrap()];
        // Integration by parts: E u^k = k int u^(k-1) sf(u) - k int u^(k-1) (-1)^k cdf(-u), with Gauss panels of a quarter sigma.
        let gauss = Rule::of(&Uniform::new(-1.0, 1.0).unwrap(), 12);
        let mut found = [1.0, 0.0, 0.0, 0.0, 0.0];
        for panel in 0..160 {
            for (node, weight) in gauss.nodes.iter().zip(&gauss.weights) {
                let u = 0.25 * (f64::from(panel) + 0.5 + 0.5 * node / 3f64.sqrt());
                let (above, below) = (law.above(mean + u * sigma).value, law.below(mean - u * sigma).value);
                for (k, found) in found.iter_mut().enumerate().skip(1) {
                    let power = k as f64 * u.powi(k as i32 - 1) * 0.25 * weight;
                    *found += power * (above + if k % 2 == 0 { below } else { -below });
                }
            }
        }
        for (k, (found, expected)) in found.iter().zip(expected).enumerate() {
            assert!((found - expected).abs() < allowed, "moment {k} of {surrogate:?}: {found} for {expected}");
        }
    }
}

/// Linear functions of normal inputs, correlated ones too, are normal to the last digits, also in the tails.
#[test]
fn a_line_of_normals_is_normal() {
    let pair = |a: &str, b: &str, value| Pair { between: [a.into(), b.into()], value };
    let dimensions: Vec<Dimension> = ["a", "b", "c"].map(|name| Dimension::normal(name, 1.0, 0.3).unwrap()).to_vec();
    let correlation = Correlation::new(&dimensions, &[pair("a", "b", 0.6)]).unwrap();
    let surrogate = of(2.0, &[&[1.0], &[-0.5], &[0.3]], &[]);
    let law = SurfaceLaw::of(&surrogate, &[normal(), normal(), normal()], Some(&correlation), &LawOptions::default())
        .unwrap();
    let sigma = (1.0f64 + 0.25 + 0.09 - 0.6).sqrt();
    for z in [-9.0, -6.0, -1.0, 0.0, 2.5, 5.0, 8.5] {
        let exact = 0.5 * libm::erfc(z / 2f64.sqrt());
        let found = law.above(2.0 + z * sigma);
        // The effect of the limit's rounding grows with the square of z.
        assert!((found.value / exact - 1.0).abs() < 1e-14 * (1.0 + z * z), "{z}: {found:?}");
    }
}

/// Derivatives equal Richardson's differences of distributions with other tolerances.
#[test]
fn derivatives_are_those_of_differences() {
    let mut all = exact_laws();
    // Two inputs use panels.
    all.push((of(0.0, &[&[1.0, 0.1], &[0.6]], &[(0, 1, 0.2)]), vec![uniform(), triangular()]));
    for (surrogate, inputs) in all {
        let law = made(&surrogate, &inputs);
        for (k, tail) in [(-2.0, LawTail::Lower), (0.7, LawTail::Lower), (2.2, LawTail::Upper)] {
            let y = law.mean() + k * law.sigma();
            let found = law.tail_derivatives(y, tail).unwrap();
            for (j, found) in found.iter().enumerate() {
                let at = |by: f64| made(&wider(&surrogate, j, 1.0 + by), &inputs).tail(y, tail).value;
                let h = 1e-3;
                let slope = (8.0 * (at(h) - at(-h)) - (at(2.0 * h) - at(-2.0 * h))) / (12.0 * h);
                // Fourth-order differences of figures that are accurate to 1e-12.
                assert!((found.value - slope).abs() < 1e-7, "{j} at {k}: {found:?} for {slope}");
            }
        }
    }
}

fn wider(surrogate: &Surrogate, input: usize, by: f64) -> Surrogate {
    let parts = surrogate.parts.iter().enumerate().map(|(j, part)| {
        let mut coefficients = part.unwrap().coefficients();
        if j == input {
            coefficients.iter_mut().enumerate().for_each(|(k, c)| *c *= by.powi(k as i32 + 1));
        }
        Some(Univariate::of_coefficients(&coefficients))
    });
    let factor = |j: usize, k: usize| if j == input || k == input { by } else { 1.0 };
    let pairs = surrogate.interactions.pairs().into_iter().map(|(j, k, b)| (j, k, b * factor(j, k)));
    let interactions = Interactions::of_pairs(surrogate.parts.len(), pairs);
    Surrogate { centre: surrogate.centre, parts: parts.collect(), interactions }
}

fn cycle() -> (Surrogate, Vec<Law>) {
    cycle_with(0.9)
}

/// A cycle with a normal input. A wide one is summed by an exact distribution in place of the direction, a narrow one is not.
fn cycle_with(slope: f64) -> (Surrogate, Vec<Law>) {
    let surrogate = of(0.0, &[&[1.0], &[0.8, 0.1], &[0.6], &[slope]], &[(0, 1, 0.1), (1, 2, 0.1), (0, 2, -0.1)]);
    (surrogate, vec![uniform(), triangular(), triangular(), normal()])
}

/// The derivative along each point's own direction is the derivative of the estimate. It agrees with differences at held points within
/// their accuracy. Both sample the same coordinates.
#[test]
fn derivatives_of_sampled_laws_are_within_their_errors() {
    for slope in [0.9, 0.1] {
        sampled_derivatives(slope);
    }
}

fn sampled_derivatives(slope: f64) {
    let (surrogate, inputs) = cycle_with(slope);
    let law = made(&surrogate, &inputs);
    assert_eq!(law.branch(), Branch::Sampled);
    for (k, tail) in [(-2.0, LawTail::Lower), (2.2, LawTail::Upper)] {
        let y = law.mean() + k * law.sigma();
        let held = law.hold(y, tail);
        for (j, found) in law.tail_derivatives(y, tail).unwrap().iter().enumerate() {
            let at = |by: f64| held.tail(&made(&wider(&surrogate, j, 1.0 + by), &inputs), y).value;
            let slope = (at(1e-3) - at(-1e-3)) / 2e-3;
            // Only one of the two estimates uses the control variate, so they differ by the errors of the derivative.
            assert!((found.value - slope).abs() < 2.0 * found.error + 1e-4 * slope.abs(), "{j}: {found:?} {slope}");
        }
    }
}

/// Along a tolerance, a cubic through figures at held points leaves rounding errors only. A cubic through independently computed figures
/// may leave more.
#[test]
fn held_figures_are_smooth_in_a_tolerance() {
    // Sampled along a normal direction, in which a root never leaves its support.
    let along = of(0.0, &[&[1.0], &[0.4, 0.1], &[0.3]], &[(0, 1, 0.1), (1, 2, 0.1), (0, 2, -0.1)]);
    // With an exact distribution, the table of which is a piecewise cubic: 1e-8.
    let mut all: Vec<(Surrogate, Vec<Law>, f64)> =
        exact_laws().into_iter().map(|(surrogate, inputs)| (surrogate, inputs, 1e-12)).collect();
    all.push((along, vec![normal(), triangular(), triangular()], 1e-12));
    let (beside, laws) = cycle();
    all.push((beside, laws, 1e-7));
    for (surrogate, inputs, allowed) in all {
        let law = made(&surrogate, &inputs);
        let y = law.mean() + 2.0 * law.sigma();
        let held = law.hold(y, LawTail::Upper);
        let own = law.above(y);
        assert!((held.tail(&law, y).value - own.value).abs() < 1e-13, "{:?} {own:?}", held.tail(&law, y));
        let values: Vec<f64> = (0..21)
            .map(|i| held.tail(&made(&wider(&surrogate, 0, 1.0 + 1e-4 * f64::from(i)), &inputs), y).value)
            .collect();
        // Fourth differences are at most 70 times the rounding of a value. The fourth derivative contributes 1e-16.
        for five in values.windows(5) {
            let fourth = five[0] - 4.0 * five[1] + 6.0 * five[2] - 4.0 * five[3] + five[4];
            assert!(fourth.abs() < allowed, "{fourth:e} of {:?}", law.branch());
        }
    }
}

/// Both signs of `z1 z2` are equally far out, so a mean field that starts in the middle does not find them.
#[test]
fn a_symmetric_product_is_tilted_to_both_sides() {
    // A product of two uniform inputs, with a tiny effect of two more products in a cycle.
    let tiny = 1e-9;
    let pairs = [(0, 1, 1.0), (0, 2, tiny), (1, 2, tiny)];
    let law = made(&of(0.0, &[&[], &[], &[tiny]], &pairs), &[uniform(), uniform(), uniform()]);
    assert_eq!(law.branch(), Branch::Sampled);
    // Two uniform inputs on +-1 have P(3 u v > y) = (1 - c + c log c)/2 with c = y/3.
    for y in [1.0, 2.0, 2.9, 2.99] {
        let c: f64 = y / 3.0;
        let exact = 0.5 * (1.0 - c + c * c.ln());
        for tail in [LawTail::Upper, LawTail::Lower] {
            let found = law.tail(tail_sign(tail) * y, tail);
            assert!((found.value - exact).abs() <= 1.5 * found.error, "{y}: {found:?} for {exact:e}");
            assert!(found.error < 0.05 * exact, "{y}: {found:?} for {exact:e}");
        }
    }
}

fn tail_sign(tail: LawTail) -> f64 {
    if tail == LawTail::Upper { 1.0 } else { -1.0 }
}

#[test]
fn atoms_make_a_step_function() {
    let coin: Law = Arc::new(Measured::new(&[0.0, 1.0]).unwrap());
    let law = made(&of(10.0, &[&[1.0], &[2.0]], &[]), &[Arc::clone(&coin), coin]);
    assert!(law.is_step_function());
    // The values 7, 9, 11 and 13 have a quarter each. A limit at a value is kept.
    assert_eq!([law.below(9.0).value, law.below(9.1).value, law.above(9.0).value], [0.25, 0.5, 0.5]);
    assert_eq!([law.above(13.0).value, law.below(7.0).value], [0.0, 0.0]);
    assert!(law.above(13.0).proven);
    assert_eq!(law.quantile(LawTail::Lower, 0.3).value, 9.0);
    assert_eq!(law.quantile(LawTail::Upper, 0.3).value, 11.0);
    assert_eq!(law.density(9.0).value, 0.0);
    assert_eq!((law.mean(), law.sigma()), (10.0, 5f64.sqrt()));
    assert!(law.tail_derivatives(9.0, LawTail::Lower).is_none());
}

/// Sum of 20 and 30 measured values and a narrow normal input: 600 narrow peaks, whose probabilities are counted.
#[test]
fn measured_values_beside_a_normal_keep_their_masses() {
    let values = |n: u32, step: f64| -> Vec<f64> { (0..n).map(|i| f64::from(i * i % 31) * step).collect() };
    let (a, b) = (values(20, 1.0), values(30, 0.7));
    let laws: Vec<Law> = vec![Arc::new(Measured::new(&a).unwrap()), Arc::new(Measured::new(&b).unwrap()), normal()];
    let (sa, sb) = (laws[0].sigma(), laws[1].sigma());
    let law = made(&of(0.0, &[&[sa], &[sb], &[0.05]], &[]), &laws);
    let (ma, mb) = (laws[0].mean(), laws[1].mean());
    for y in [-20.0, -3.3, 0.0, 5.21, 17.0] {
        let count =
            |a: &f64| b.iter().map(|b| 0.5 * libm::erfc((y - (a - ma) - (b - mb)) / (0.05 * 2f64.sqrt()))).sum::<f64>();
        let exact = a.iter().map(count).sum::<f64>() / 600.0;
        let found = law.above(y);
        assert!((found.value - exact).abs() <= found.error + 1e-13 && found.error < 1e-9, "{y}: {found:?} for {exact}");
    }
}

#[test]
fn one_input_none_and_limits_beyond_the_support() {
    let law = made(&of(1.0, &[&[1.0, 1.0]], &[]), &[uniform()]);
    assert_eq!(law.branch(), Branch::Single);
    let u = 3f64.sqrt();
    // The function 1 + z + z^2 on +-sqrt 3 has the least value 3/4 and the greatest 4 + sqrt 3. Between the roots of y it lies below y.
    let found = law.below(2.0);
    assert!((found.value - 5f64.sqrt() / (2.0 * u)).abs() < 1e-14, "{found:?}");
    assert!(law.below(0.74).proven && law.below(0.74).value == 0.0);
    assert!(law.below(5.8).proven && law.below(5.8).value == 1.0);
    assert!(law.above(5.8).proven && law.above(5.8).value == 0.0);
    let point = made(&of(3.0, &[&[]], &[]), &[uniform()]);
    assert_eq!((point.sigma(), point.below(3.0).value, point.above(2.9).value), (0.0, 0.0, 1.0));
    assert_eq!(point.quantile(LawTail::Lower, 0.1).value, 3.0);
    assert!(law.below(f64::NAN).value.is_nan() && law.quantile(LawTail::Upper, 2.0).value.is_nan());
    let wrong = SurfaceLaw::of(&of(f64::NAN, &[&[1.0]], &[]), &[uniform()], None, &LawOptions::default());
    assert_eq!(wrong.unwrap_err(), LawError::NotFinite);
    let wrong = SurfaceLaw::of(&of(0.0, &[&[1.0]], &[]), &[], None, &LawOptions::default());
    assert_eq!(wrong.unwrap_err(), LawError::Shapes { parts: 1, inputs: 0 });
}

/// A lognormal input too heavy for a tilt, with a normal and a uniform one: panels over the exact distribution of these two. The reference
/// by tensor panels of the other two is accurate to 1e-9.
#[test]
fn a_heavy_tail_is_summed_beside_an_exact_law() {
    let heavy: Law = Arc::new(Lognormal::new(0.0, 1.0, 1.3).unwrap());
    let law = made(&of(0.0, &[&[1.0], &[0.5], &[0.6]], &[]), &[heavy, normal(), uniform()]);
    assert_eq!(law.branch(), Branch::Sampled);
    let tau = (1.0f64 + 1.69).ln().sqrt();
    for y in [-1.5, 0.0, 3.0, 12.0] {
        // Reference: integral over the normal variable behind the lognormal one and over the uniform one, with the normal one in closed
        // form.
        let (mut exact, n) = (0.0, 4000);
        for i in 0..n {
            let v = -10.0 + 20.0 * (f64::from(i) + 0.5) / f64::from(n);
            let z = ((tau * v - 0.5 * tau * tau).exp() - 1.0) / 1.3;
            let weight = 20.0 / f64::from(n) * (-0.5 * v * v).exp() / (2.0 * std::f64::consts::PI).sqrt();
            // Mean of the normal tail function over a uniform of half-width 0.6 sqrt 3, by the integral of the tail.
            let a = 0.6 * 3f64.sqrt();
            let tail = |x: f64| {
                let x = x / 0.5;
                0.5 * ((-0.5 * x * x).exp() / (2.0 * std::f64::consts::PI).sqrt()
                    - x * 0.5 * libm::erfc(x / 2f64.sqrt()))
            };
            exact += weight * (tail(y - z - a) - tail(y - z + a)) / (2.0 * a);
        }
        let found = law.above(y);
        assert!((found.value - exact).abs() < 1e-7 * exact + 1e-12, "{y}: {found:?} for {exact}");
    }
}

/// Figures do not depend on earlier calls or on the number of threads.
#[test]
fn figures_depend_on_nothing_but_the_surface() {
    let (surrogate, inputs) = cycle();
    let one = made(&surrogate, &inputs);
    let y = one.mean() + 3.0 * one.sigma();
    let first = one.above(y);
    let other = made(&surrogate, &inputs);
    for k in [-3.0, 5.0, 0.0, 4.0] {
        other.above(other.mean() + k * other.sigma());
    }
    assert_eq!(first, other.above(y));
    let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    assert_eq!(first, pool.install(|| made(&surrogate, &inputs).above(y)));
}
