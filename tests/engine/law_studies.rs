//! Studies without a slope at their means, which have products and fourth powers only. Shares and quantiles are compared with quadrature
//! and closed forms.

use sensitol::analysis::{Analysis, CharacteristicAnalysis};
use sensitol::distribution::{Distribution, Normal};
use sensitol::{Options, analyze};
use sensitol_study::Study;
use serde_json::json;

/// Sigma of the angles.
const ANGLE: f64 = 0.02;

/// Returns the analysis of a formula of normal angles `a`, `b`, `c` and a normal length `d` of this sigma.
fn analyzed(formula: &str, lower: f64, length: Option<f64>) -> Analysis {
    let mut dimensions = json!({});
    for (name, used) in [("a", "a"), ("b", "b)"), ("c", "+ c)")] {
        if !formula.contains(used) {
            continue;
        }
        dimensions[name] = json!({ "nominal": 0.0, "sigma": ANGLE });
    }
    if let Some(sigma) = length {
        dimensions["d"] = json!({ "nominal": 0.0, "sigma": sigma });
    }
    let study = json!({ "dimensions": dimensions, "characteristics": { "y": { "formula": formula, "lower": lower } } });
    let study = Study::from_json(&study.to_string(), "testing").unwrap();
    let mut options = Options::default();
    options.coverage = Some(0.95);
    analyze(&study.problem, &options).unwrap()
}

/// Returns the probability of `y + d` below a limit, over a grid of angles. The trapezoidal rule converges faster than any power of its
/// step, once the step resolves the length.
fn below(limit: f64, angles: usize, length: f64, y: impl Fn([f64; 3]) -> f64) -> f64 {
    let step = if angles == 2 { 0.0125 } else { 0.05 };
    let reach = (7.0 / step) as i32;
    let normal = Normal::new(0.0, length).unwrap();
    let cdf = |x: f64| normal.probability().unwrap().cdf(x);
    let nodes: Vec<(f64, f64)> = (-reach..=reach)
        .map(|i| step * f64::from(i))
        .map(|z| (ANGLE * z, step * (-0.5 * z * z).exp() / (2.0 * std::f64::consts::PI).sqrt()))
        .collect();
    let still = [(0.0, 1.0)];
    let of = |angle: usize| if angle < angles { &nodes[..] } else { &still[..] };
    let mut sum = 0.0;
    for (a, u) in of(0) {
        for (b, v) in of(1) {
            for (c, w) in of(2) {
                sum += u * v * w * cdf(limit - y([*a, *b, *c]));
            }
        }
    }
    sum
}

/// Checks that the share below the limit is right within three of its errors, and that the surface distribution has passed its tests.
fn agrees(analysis: &Analysis, right: f64) {
    let one: &CharacteristicAnalysis = &analysis.characteristics[0];
    let (below, error) =
        (one.distribution.capability.unwrap().below.unwrap(), one.error_estimate.as_ref().unwrap().yield_.unwrap());
    assert!((below - right).abs() <= 3.0 * error, "{below} ± {error}, right {right}");
    assert!(error < 0.02 * right, "{error} of {right}");
    let law = one.evidence.surface_law.unwrap();
    assert!(law.refuted.is_none() && law.counted.is_none(), "{law:?}");
    let quantiles = law.quantiles.unwrap().map(|figure| figure.value);
    assert!(quantiles.is_sorted(), "{quantiles:?}");
}

/// The count is 28 249 ppm, as in the quadrature of the study's author.
#[test]
fn an_arm_of_two_links_has_the_rejects_of_a_quadrature() {
    let analysis = analyzed("300*(cos(a) - 1) + 200*(cos(a + b) - 1) + d", -0.6, Some(0.01));
    let right = below(-0.6, 2, 0.01, |[a, b, _]| 300.0 * (a.cos() - 1.0) + 200.0 * ((a + b).cos() - 1.0));
    assert!((right - 0.028_248_859_7).abs() < 1e-8, "{right}");
    agrees(&analysis, right);
}

#[test]
fn an_arm_of_three_links_has_the_rejects_of_a_quadrature() {
    let formula = "300*(cos(a) - 1) + 200*(cos(a + b) - 1) + 100*(cos(a + b + c) - 1) + d";
    let right = below(-0.6, 3, 0.01, |[a, b, c]| {
        300.0 * (a.cos() - 1.0) + 200.0 * ((a + b).cos() - 1.0) + 100.0 * ((a + b + c).cos() - 1.0)
    });
    agrees(&analyzed(formula, -0.6, Some(0.01)), right);
}

#[test]
fn an_exact_rotation_has_the_rejects_of_a_quadrature() {
    let formula = "100*cos(a) - 60*sin(a)*sin(b) + 80*cos(a + b) + d";
    let right = below(179.8, 2, 0.02, |[a, b, _]| 100.0 * a.cos() - 60.0 * a.sin() * b.sin() + 80.0 * (a + b).cos());
    agrees(&analyzed(formula, 179.8, Some(0.02)), right);
}

/// `a + b` is normal, so that every quantile of its cosine is known. The density is infinite at the greatest value.
#[test]
fn a_cosine_at_its_top_has_quantiles_in_closed_form() {
    let analysis = analyzed("cos(a + b) - 1", -0.002, None);
    let one = &analysis.characteristics[0];
    let sum = Normal::new(0.0, ANGLE * 2f64.sqrt()).unwrap();
    let quantile = |p: f64| sum.probability().unwrap().quantile(1.0 - 0.5 * p).cos() - 1.0;
    let right = 2.0 * sum.probability().unwrap().cdf(-(0.998f64).acos());
    agrees(&analysis, right);
    let near = 0.01 * one.moments.unwrap().sigma();
    let coverage = one.distribution.coverage.unwrap();
    let expected = [[quantile(0.025), quantile(0.975)], [quantile(0.05), 0.0]];
    for (found, expected) in [coverage.equal_tails, coverage.shortest].iter().flatten().zip(expected.iter().flatten()) {
        assert!((found - expected).abs() < near, "{coverage:?}, right {expected:?}");
    }
}
