//! Source of a yield, and its agreement with the share within the limits.

use sensitol::analysis::YieldSource;

use sensitol::{CharacteristicAnalysis, analyze};
use sensitol_study::Study;
use sensitol_testing::relative;

fn study(text: &str) -> Study {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, text).unwrap();
    Study::read(&path).unwrap()
}

fn only(text: &str, verify: Option<usize>) -> CharacteristicAnalysis {
    let study = study(text);
    let mut options = study.options.clone();
    options.verify = verify;
    analyze(&study.problem, &options).unwrap().characteristics.remove(0)
}

/// Two triangular parts of ± 0.2 and ± 0.9 within ± 0.452. The Pearson fit with their exact moments keeps 74.83 %.
#[test]
fn triangles_keep_what_they_keep() {
    let text = "[dimensions]\na = { nominal = 0, tolerance = 0.2, distribution = \"triangular\" }\n\
                b = { nominal = 0, tolerance = 0.9, distribution = \"triangular\" }\n\
                [characteristics]\ny = { formula = \"a + b\", lower = -0.452, upper = 0.452 }\n";
    // P(y > 0.452) is the mean over a of (0.9 - 0.452 + a)^2/(2 0.9^2), as 0.452 - a stays between 0 and 0.9. The density of a is a line on
    // either side of 0. The product is a cubic, which Simpson's rule integrates exactly.
    let tail = |a: f64| (0.2 - a.abs()) / 0.04 * (0.448 + a).powi(2) / (2.0 * 0.81);
    let simpson = |from: f64, to: f64| (to - from) / 6.0 * (tail(from) + 4.0 * tail(0.5 * (from + to)) + tail(to));
    let exact = 1.0 - 2.0 * (simpson(-0.2, 0.0) + simpson(0.0, 0.2));
    assert!((exact - 0.7440).abs() < 5e-5, "{exact}");
    for (verify, source) in [(None, YieldSource::Proof), (Some(0), YieldSource::SurfaceLaw)] {
        let found = only(text, verify);
        assert_eq!(found.distribution.yield_source, Some(source));
        let error = found.error_estimate.as_ref().unwrap().yield_.unwrap();
        let own = found.distribution.capability.unwrap();
        // Three errors, and a few roundings of numbers near 1.
        assert!(
            (own.yield_().unwrap() - exact).abs() <= 3.0 * error + 1e-14 && error < 1e-9,
            "{own:?} {exact} {error}"
        );
        relative(own.below.unwrap(), own.above.unwrap(), 1e-9);
        assert!((found.evidence.pearson.unwrap().yield_().unwrap() - 0.74828).abs() < 5e-6);
    }
}

/// If the worst case of bounded parts keeps the limits, all assemblies keep them.
#[test]
fn a_worst_case_within_the_limits_is_a_proof() {
    let text = "[dimensions]\na = { nominal = 1, tolerance = 0.1, distribution = \"uniform\" }\n\
                b = { nominal = 2, tolerance = 0.2, distribution = \"uniform\" }\n\
                [characteristics]\ny = { formula = \"a + b\", lower = 2.69, upper = 3.31, target_yield = 0.999999999 }\n";
    let found = only(text, None);
    assert_eq!((found.distribution.yield_source, found.yield_interval()), (Some(YieldSource::Proof), Some([1.0; 2])));
    assert_eq!((found.distribution.capability.unwrap().rejected(), found.met()), (Some(0.0), Some(true)));
}

/// A formula that is not a polynomial is sampled, with the surface distribution as control variate. With a kink the sample alone gives the
/// yield.
#[test]
fn a_cheap_model_is_asked_itself() {
    let of = |formula: &str, limits: &str| {
        let text = format!(
            "[analysis]\nmethod = \"full\"\n[dimensions]\na = {{ nominal = 0, tolerance = 3 }}\nb = {{ nominal = 0, tolerance = 3 }}\n\
             [characteristics]\ny = {{ formula = \"{formula}\", {limits} }}\n"
        );
        only(&text, None)
    };
    let normal = |z: f64| 0.5 * libm::erfc(-z / 2f64.sqrt());
    // exp(a/10) <= exp(0.2) holds if a <= 2, and max(a, b) <= 2 if both are.
    for (formula, limits, exact) in [
        ("exp(a/10) + 0*b", format!("upper = {}", 0.2f64.exp()), normal(2.0)),
        ("max(a, b)", "upper = 2".to_owned(), normal(2.0).powi(2)),
    ] {
        let found = of(formula, &limits);
        assert_eq!(found.distribution.yield_source, Some(YieldSource::Samples), "{formula}");
        let error = found.error_estimate.as_ref().unwrap().yield_.unwrap();
        let own = found.distribution.capability.unwrap().yield_().unwrap();
        assert!((own - exact).abs() <= 3.0 * error && error < 1e-3, "{formula}: {own} for {exact}, {error}");
    }
}

/// A dimension that is known by its moments has no distribution, and neither has the surface.
#[test]
fn moments_alone_leave_the_pearson_fit() {
    let text = "[dimensions]\na = { nominal = 10, moments = [0.01, 0, 3e-4, 0, 1.5e-5, 0, 1.05e-6] }\n\
                b = { nominal = 2, tolerance = 0.2 }\n[characteristics]\ny = { formula = \"a + b\", upper = 12.3 }\n";
    let found = only(text, Some(0));
    assert_eq!(found.distribution.yield_source, Some(YieldSource::Pearson));
    assert_eq!(found.distribution.capability.unwrap().above, found.evidence.pearson.unwrap().above);
}

/// Characteristics without a common dimension are independent: the joint yield is the product of their yields.
#[test]
fn the_joint_yield_of_independent_characteristics_is_their_product() {
    let text = "[dimensions]\na = { nominal = 0, tolerance = 3 }\nb = { nominal = 0, tolerance = 3, distribution = \"uniform\" }\n\
                [characteristics]\nx = { formula = \"a\", upper = 1 }\ny = { formula = \"2*b\", lower = -5, upper = 4 }\n";
    let study = study(text);
    let found = analyze(&study.problem, &study.options).unwrap();
    let product: f64 =
        found.characteristics.iter().map(|one| one.distribution.capability.unwrap().yield_().unwrap()).product();
    let joint = found.joint.unwrap();
    assert!((joint.value - product).abs() <= 3.0 * joint.error && joint.error < 1e-2, "{joint:?} {product}");
    // A single characteristic has no joint yield.
    let text = text.replace("x = { formula = \"a\", upper = 1 }\n", "");
    let one = self::study(&text);
    assert_eq!(analyze(&one.problem, &one.options).unwrap().joint, None);
}
