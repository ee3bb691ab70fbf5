//! Exact derivatives of formulas: against differences with 100 digits, closed forms at difficult points, and points without a derivative.

use proptest::prelude::*;
use sensitol::assembly::formula::Formula;
use sensitol::assembly::formula::jet::Jet;
use sensitol::assembly::formula::set::{FormulaSet, Meaning};
use sensitol_testing::data;

fn set(text: &str) -> FormulaSet {
    let names = [("x0", Meaning::Variable(0)), ("x1", Meaning::Variable(1)), ("x2", Meaning::Variable(2))];
    FormulaSet::new(vec![("y".to_owned(), Formula::parse(text).unwrap())], names).unwrap()
}

fn along(set: &FormulaSet, x: [f64; 3], u: [f64; 3], v: [f64; 3]) -> Jet {
    set.jets(&[0], |d| Jet::variable(x[d], [u[d], v[d]]))[0]
}

fn unit(d: usize) -> [f64; 3] {
    [0, 1, 2].map(|e| if e == d { 1.0 } else { 0.0 })
}

/// Returns the first and second derivative along x0.
fn of_first(text: &str, x: [f64; 3]) -> (Option<f64>, Option<f64>) {
    let jet = along(&set(text), x, unit(0), unit(0));
    (jet.first(0), jet.second())
}

/// All functions, in written and random formulas. The factor by which a formula amplifies the rounding of its parts holds for its
/// derivatives too. Errors are relative to the largest derivative of that order, or to the value (at most 1e-14 was found).
#[test]
fn derivatives_are_exact() {
    let cases = data("formula-derivatives.json");
    let number = |value: &serde_json::Value| value.as_f64().unwrap();
    let (mut worst, mut count) = (0.0f64, 0);
    for case in cases.as_array().unwrap() {
        let (text, x) = (case["formula"].as_str().unwrap(), [0, 1, 2].map(|d| number(&case["x"][d])));
        let set = set(text);
        let numbers = |value: &serde_json::Value| value.as_array().unwrap().iter().map(number).collect::<Vec<f64>>();
        let (first, second) = (numbers(&case["first"]), case["second"].as_array().unwrap().iter().map(numbers));
        let second: Vec<Vec<f64>> = second.collect();
        let largest = |numbers: &[f64]| numbers.iter().fold(number(&case["value"]).abs(), |m, v| m.max(v.abs()));
        let scales = [largest(&first), largest(&second.concat())];
        for j in 0..3 {
            for k in 0..3 {
                let jet = along(&set, x, unit(j), unit(k));
                let found = [jet.first(0), jet.first(1), jet.second()];
                let expected = [first[j], first[k], second[j][k]];
                for ((found, expected), scale) in found.into_iter().zip(expected).zip([scales[0], scales[0], scales[1]])
                {
                    let found = found.unwrap_or_else(|| panic!("none for {text} at {x:?}"));
                    let error = (found - expected).abs() / scale.max(f64::MIN_POSITIVE);
                    assert!(error < 1e-13, "{text} at {x:?}, {j} {k}: {found} is not {expected}");
                    worst = worst.max(error);
                    count += 1;
                }
            }
        }
    }
    assert!(count > 9000, "{count} derivatives");
    assert!(worst > 0.0, "nothing was compared");
}

#[test]
fn where_there_is_none() {
    for (text, x0) in [
        ("sqrt(x0)", 0.0),
        ("sqrt(x0^2)", 0.0),
        ("abs(x0)", 0.0),
        ("asin(x0)", 1.0),
        ("acos(x0)", -1.0),
        ("min(x0, 2)", 2.0),
        ("max(x0, 2 - x0, 0)", 1.0),
        ("floor(x0)", 3.0),
        ("ceil(x0)*2", -1.0),
        ("sign(x0)", 0.0),
        ("hypot(x0, 0)", 0.0),
        ("atan2(x0, -1)", 0.0),
        ("x0^0.5", 0.0),
        ("x0^2.5", 0.0),
        ("x0^x0", 0.0),
        ("(0 - 2)^x0", 2.0),
        ("ln(x0)", 0.0),
        ("1/x0", 0.0),
        ("x0 < 1", 1.0),
        ("x0 == 1", 1.0),
        ("if(x0 < 1, x0, 2 - x0)", 1.0),
        ("if(x0 == 0, 1, sin(x0)/x0)", 0.0),
        ("if(x0, 1, 2)", 0.0),
        ("if(x0^3 < 0, 1, 2)", 0.0),
        ("if((x0 < 1)*(x1 < 1), x0, 2*x0)", 1.0),
        ("exp(1e3*x0)", 1.0),
        ("1/(1/x0 + 1)", 0.0),
        ("0*abs(x0 - 1) + x0", 1.0),
    ] {
        assert_eq!(of_first(text, [x0, 0.5, 0.0]), (None, None), "{text}");
        // The formula does not depend on the other dimension there, so that the derivative along it is 0.
        let other = along(&set(&format!("1*({text})")), [x0, 0.5, 0.0], unit(2), unit(2));
        if other.value().is_finite() {
            assert_eq!((other.first(0), other.second()), (Some(0.0), Some(0.0)), "{text}");
        }
    }
    // The slope exists, but the curvature does not.
    assert_eq!(of_first("x0*abs(x0)", [0.0; 3]).1, None);
    assert_eq!(of_first("if(x0 < 1, x0, x0 + (x0 - 1)^2)", [1.0, 0.0, 0.0]), (Some(1.0), None));
    assert_eq!(of_first("min(x0, x0 + (x0 - 1)^2)", [1.0, 0.0, 0.0]), (Some(1.0), None));
}

#[test]
fn where_there_is_one_all_the_same() {
    for (text, x0, first, second) in [
        ("if(x0 < 1, x0^2, 2*x0 - 1 + (x0 - 1)^2)", 1.0, 2.0, 2.0),
        ("max(x0^3, 0 - x0^3)", 0.0, 0.0, 0.0),
        ("abs(x0^3)", 0.0, 0.0, 0.0),
        ("min(x0, x0)", 1.0, 1.0, 0.0),
        ("atan2(0, x0)", -1.0, 0.0, 0.0),
        ("atan2(x0, 1)", 0.0, 1.0, 0.0),
        ("x0^0", 0.0, 0.0, 0.0),
        ("x0^1", 0.0, 1.0, 0.0),
        ("x0^2", 0.0, 0.0, 2.0),
        ("x0^5", 0.0, 0.0, 0.0),
        ("x0^3", -2.0, 12.0, -12.0),
        ("x0^5", -1.0, 5.0, -20.0),
        ("x0^-5", -1.0, -5.0, -30.0),
        ("0^x0", 2.0, 0.0, 0.0),
        ("floor(x0)*x0", 2.5, 2.0, 0.0),
        ("if(floor(x0) == 2, x0^2, 0)", 2.5, 5.0, 2.0),
        ("if(2 == 2, x0^2, acos(7))", 2.5, 5.0, 2.0),
        ("sqrt(x0)", 1e-200, 0.5e100, -0.25e300),
        ("1/x0", 1e200, -0.0, 0.0),
        ("sqrt(x0)*sqrt(x0)", 1e200, 1.0, 0.0),
        ("tanh(x0)", 400.0, 0.0, 0.0),
        ("atan(x0)", 1e300, 0.0, 0.0),
    ] {
        let (found, curvature) = of_first(text, [x0, 0.0, 0.0]);
        let near = |found: Option<f64>, expected: f64| {
            found.is_some_and(|found| (found - expected).abs() <= 1e-14 * expected.abs().max(f64::from(x0 < 1e100)))
        };
        assert!(near(found, first), "{text}: {found:?} is not {first}");
        assert!(near(curvature, second), "{text}: {curvature:?} is not {second}");
    }
}

/// Smooth pieces of moderate size, whose nesting is smooth except at kinks.
fn texts() -> impl Strategy<Value = String> {
    let leaf = prop_oneof![(0..3usize).prop_map(|d| format!("x{d}")), (0.1..3.0f64).prop_map(|c| format!("{c:.3}"))];
    leaf.prop_recursive(5, 40, 3, |inner| {
        let calls = &["sin({})", "cos({})", "atan({})", "tanh({})", "sqrt(1 + ({})^2)", "abs({})", "exp(0 - abs({}))"];
        let pairs = &["({} + {})", "({} - {})", "({}*{})", "({}/(2 + sin({})))", "min({}, {})", "hypot({}, 1 + {})"];
        let fill = |form: &str, parts: [&str; 3]| {
            parts.iter().fold(form.to_owned(), |text, part| text.replacen("{}", part, 1))
        };
        let call = (prop::sample::select(&calls[..]), inner.clone());
        let pair = (prop::sample::select(&pairs[..]), inner.clone(), inner.clone());
        prop_oneof![
            call.prop_map(move |(form, a)| fill(form, [&a, "", ""])),
            pair.prop_map(move |(form, a, b)| fill(form, [&a, &b, ""])),
            (inner.clone(), inner.clone(), inner).prop_map(move |(c, a, b)| fill("if({} < 0.5, {}, {})", [&c, &a, &b])),
        ]
    })
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// The value is that of the batch to the last bit, and the derivatives are bilinear in the directions. They are also those of the value
    /// along a line: the error of the Taylor polynomial falls with the third power of the step.
    #[test]
    fn jets_are_taylor_polynomials(text in texts(), x in prop::array::uniform3(-2.0..2.0f64), u in prop::array::uniform3(-1.0..1.0f64)) {
        let set = set(&text);
        let value = |x: [f64; 3]| {
            let (columns, mut found) = (x.map(|x| [x]), f64::NAN);
            set.evaluate(&[0], 1, |d| &columns[d], |_, _, value| found = value);
            found
        };
        let jet = along(&set, x, u, u);
        prop_assert_eq!(jet.value().to_bits(), value(x).to_bits());
        let (Some(first), Some(second)) = (jet.first(0), jet.second()) else { return Ok(()) };
        let size = [jet.value(), first, second, 1.0].into_iter().fold(0.0f64, |m, v| m.max(v.abs()));

        let parts: Vec<Vec<Jet>> = (0..3).map(|j| (0..3).map(|k| along(&set, x, unit(j), unit(k))).collect()).collect();
        let slope: Option<f64> = (0..3).map(|d| Some(u[d] * parts[d][d].first(0)?)).sum();
        let curvature: Option<f64> =
            (0..9).map(|i| Some(u[i / 3] * u[i % 3] * parts[i / 3][i % 3].second()?)).sum();
        if let (Some(slope), Some(curvature)) = (slope, curvature) {
            prop_assert!((slope - first).abs() < 1e-9 * size && (curvature - second).abs() < 1e-8 * size, "{text} at {x:?}");
        }

        // If a kink lies within the step, or the third derivative is huge, the comparison is skipped.
        let miss = |h: f64| value([0, 1, 2].map(|d| x[d] + h * u[d])) - jet.value() - h * first - 0.5 * h * h * second;
        let (h, third) = (1e-4, 1e4 * size);
        if [miss(h), miss(-h)].iter().any(|miss| miss.abs() > third * h.powi(3) + 1e-13 * size) {
            let closer = [miss(h * 1e-2), miss(-h * 1e-2)].into_iter().fold(0.0f64, |m, v| m.max(v.abs()));
            prop_assert!(closer <= 100.0 * third * (h * 1e-2).powi(3) + 1e-13 * size, "{text} at {x:?} along {u:?}: {closer:e}");
        }
    }
}
