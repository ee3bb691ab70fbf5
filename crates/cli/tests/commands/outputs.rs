//! Correlations of characteristics, and bounds by interval arithmetic that need no option.

use sensitol::{Analysis, Closure, Dimension, Method, Problem, analyze};
use sensitol_study::Study;

use super::command::sensitol;

const UNITS: &str = "[dimensions]\nu = { nominal = 0, sigma = 1 }\nv = { nominal = 0, sigma = 1 }\n[characteristics]\n";

fn of(characteristics: &str, verify: Option<usize>) -> Analysis {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    std::fs::write(&path, format!("{UNITS}{characteristics}")).unwrap();
    let study = Study::read(&path).unwrap();
    let mut options = study.options.clone();
    options.verify = verify;
    analyze(&study.problem, &options).unwrap()
}

/// `Var(u + u v) = 2` and `Var(v + 2 u v + u^2) = 7`. Of the products of their terms, only `E[u v 2 u v] = 2` is not 0.
#[test]
fn quadratics_correlate_as_by_hand() {
    let exact = 2.0 / 14f64.sqrt();
    let text = "p = { formula = \"u + u*v\" }\nq = { formula = \"v + 2*u*v + u^2\" }\n";
    let proven = &of(text, None).correlations[0];
    assert_eq!(proven.between, ["p", "q"].map(str::to_owned));
    // Error of a dozen roundings of numbers near 1. It is that small because the formulas' degree proves the surfaces.
    assert!((proven.value.unwrap() - exact).abs() < 1e-14 && proven.error.unwrap() < 1e-14, "{proven:?}");
    let unasked = &of(text, Some(0)).correlations[0];
    assert!((unasked.value.unwrap() - exact).abs() < 1e-14 && unasked.error.is_none(), "{unasked:?}");
}

/// The greater and the lesser of two standard normal variables have variances `1 - 1/pi` and the covariance `1/pi` (Clark 1961).
#[test]
fn kinked_characteristics_are_asked_themselves() {
    let pi = std::f64::consts::PI;
    let exact = 1.0 / pi / (1.0 - 1.0 / pi);
    let found = &of("p = { formula = \"max(u, v)\" }\nq = { formula = \"min(u, v)\" }\n", None).correlations[0];
    let error = found.error.unwrap();
    assert!((found.value.unwrap() - exact).abs() < 3.0 * error && error < 0.01, "{found:?} for {exact}");
}

/// A constant has no correlation, and a single characteristic has no other to be correlated with.
#[test]
fn what_is_not_known_is_null() {
    let still = &of("p = { formula = \"u\" }\nq = { formula = \"7\" }\n", None).correlations;
    assert_eq!((still.len(), still[0].value, still[0].error), (1, None, None));
    assert!(of("p = { formula = \"u\" }\n", None).correlations.is_empty());
}

/// A characteristic and its multiples, with any unit and sign, have correlation 1 or -1.
#[test]
fn multiples_are_wholly_correlated() {
    let dimensions = [Dimension::normal("u", 3.0, 0.3).unwrap(), Dimension::normal("v", 5.0, 0.6).unwrap()];
    let three = |x: &[f64]| {
        let y = x[0] * x[1];
        [y, 1e9 * y, -1e-9 * y]
    };
    let problem = Problem::new(dimensions, Closure::new(["a", "b", "c"], three)).unwrap();
    let found = analyze(&problem, &Method::Full.into()).unwrap().correlations;
    for (one, exact) in found.iter().zip([1.0, -1.0, -1.0]) {
        assert!((one.value.unwrap() - exact).abs() < 1e-14, "{one:?}");
    }
}

/// `u^2` over ± 3 sigma lies between 0 and 9. The slope at the mean is 0, which would mean no variation at all.
#[test]
fn bounds_of_a_formula_cost_nothing() {
    let found = of("p = { formula = \"u^2\" }\n", None);
    let one = &found.characteristics[0];
    let bounds = one.range.bounds.as_ref().unwrap();
    assert!(bounds.proven && bounds.bounds[0] <= 0.0 && bounds.bounds[1] >= 9.0, "{bounds:?}");
    // Within a thousandth of sigma, which is sqrt 2.
    assert!(bounds.bounds[0] > -0.0015 && bounds.bounds[1] < 9.0015, "{bounds:?}");
    assert_eq!(one.range.worst_case, Some([0.0; 2]));
    assert!(of("p = { formula = \"u^2\" }\n", Some(0)).characteristics[0].range.bounds.is_none());
}

/// A position lies within its circle: `3 x + 4 y` reaches 5 radii. The corners of the box around the circle would give 7.
#[test]
fn corners_of_the_box_of_a_circle_are_no_worst_case() {
    let text = "[dimensions]\nhole = { nominal = [0, 0], position = 0.2 }\n\
                [characteristics]\ny = { formula = \"3*hole_x + 4*hole_y\" }\n";
    let study = Study::from_toml(text, "study.toml").unwrap();
    let one = analyze(&study.problem, &study.options).unwrap().characteristics.remove(0);
    let bounds = one.range.bounds.as_ref().unwrap();
    let [least, most] = one.range.worst_case.unwrap();
    // Five radii of 0.1, with each end within the rounding of the proof.
    assert_eq!([least, most], [-0.5, 0.5]);
    assert!(bounds.proven && bounds.bounds[0] <= least && bounds.bounds[1] >= most, "{bounds:?} {least} {most}");
    assert!(bounds.bounds[0] > least - 1e-12 && bounds.bounds[1] < most + 1e-12, "{bounds:?}");
}

/// Beside a kink or a curvature, the worst case by slopes is named linear, with the proven one below it. If both agree there is a single
/// worst case, and without bounds it is named linear again.
#[test]
fn a_linear_worst_case_is_named_as_linear() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml").display().to_string();
    let cases = [
        ("max(u, 2*v - 1)", "", [true, true]),
        ("u^2 + v", "", [true, true]),
        ("u + 2*v", "", [false, false]),
        ("u + 2*v", "--verify=0", [true, false]),
    ];
    for (formula, option, expected) in cases {
        let text = format!(
            "[dimensions]\nu = {{ nominal = 0, tolerance = 3 }}\nv = {{ nominal = 0, tolerance = 3 }}\n\
             [characteristics]\ny = {{ formula = \"{formula}\" }}\n"
        );
        std::fs::write(&path, text).unwrap();
        let words: Vec<&str> = ["analyze", &path, "-v", option].into_iter().filter(|word| !word.is_empty()).collect();
        let out = sensitol(&words).output().unwrap();
        let shown = String::from_utf8(out.stdout).unwrap();
        assert!(shown.contains("worst case"), "{formula}: {shown}");
        assert_eq!(["linear worst case", "proven worst case"].map(|name| shown.contains(name)), expected, "{shown}");
    }
}
