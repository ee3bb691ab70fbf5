//! Interval arithmetic: bounds contain every value of a formula over a box.

use proptest::prelude::*;
use sensitol::assembly::formula::Formula;
use sensitol::assembly::formula::interval::Interval;
use sensitol::assembly::formula::jet::Jet;
use sensitol::assembly::formula::set::{FormulaSet, Meaning};

const NAMES: [&str; 3] = ["a", "b", "c"];

fn set(text: &str) -> FormulaSet {
    let meanings = NAMES.iter().enumerate().map(|(index, &name)| (name, Meaning::Variable(index)));
    FormulaSet::new(vec![("y".to_owned(), Formula::parse(text).unwrap())], meanings).unwrap()
}

fn value(set: &FormulaSet, x: [f64; 3]) -> f64 {
    let (columns, mut y) = (x.map(|x| [x]), f64::NAN);
    set.evaluate(&[0], 1, |variable| &columns[variable], |_, _, value| y = value);
    y
}

/// Formulas of three variables with every function and operator.
fn formulas() -> impl Strategy<Value = String> {
    let number = prop_oneof![
        Just("0".to_owned()),
        Just("2".to_owned()),
        Just("-1.5".to_owned()),
        (-3.0..3.0).prop_map(|x: f64| format!("({x})"))
    ];
    let leaf = prop_oneof![3 => prop::sample::select(&NAMES[..]).prop_map(str::to_owned), 1 => number];
    leaf.prop_recursive(4, 24, 3, |inner| {
        let unary = prop::sample::select(
            &[
                "-", "abs", "sqrt", "exp", "ln", "log10", "sin", "cos", "tan", "asin", "acos", "atan", "sinh", "cosh",
                "tanh", "floor", "ceil", "sign",
            ][..],
        );
        let infix = prop::sample::select(&["+", "-", "*", "/", "<", "<=", ">", ">=", "==", "!="][..]);
        let call = prop::sample::select(&["min", "max", "atan2", "hypot"][..]);
        let exponent = prop::sample::select(&["2", "3", "4", "-1", "-2", "0.5", "1.5", "-0.5", "0", "1"][..]);
        prop_oneof![
            2 => (unary, inner.clone()).prop_map(|(f, x)| format!("{f}({x})")),
            3 => (infix, inner.clone(), inner.clone()).prop_map(|(f, x, y)| format!("(({x}) {f} ({y}))")),
            1 => (call, inner.clone(), inner.clone()).prop_map(|(f, x, y)| format!("{f}({x}, {y})")),
            1 => (inner.clone(), exponent).prop_map(|(x, n)| format!("({x})^({n})")),
            1 => (inner.clone(), inner.clone()).prop_map(|(x, y)| format!("({x})^({y})")),
            1 => inner.clone().prop_map(|x| format!("({x})*({x})")),
            1 => (inner.clone(), inner.clone(), inner).prop_map(|(c, x, y)| format!("if({c}, {x}, {y})")),
        ]
    })
}

/// Boxes as middles and half-widths, some of which are 0.
fn boxes() -> impl Strategy<Value = [[f64; 2]; 3]> {
    let half = prop_oneof![Just(0.0), 1e-9..1e-3, 1e-3..1.0, 1.0..4.0];
    let band =
        (prop_oneof![Just(0.0), Just(1.0), -4.0..4.0], half).prop_map(|(x, half): (f64, f64)| [x - half, x + half]);
    [band.clone(), band.clone(), band]
}

fn within(interval: Interval, value: f64) -> bool {
    interval.lower() <= value && value <= interval.upper()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, ..ProptestConfig::default() })]

    /// Random formulas at random points and at the corners of the box. Exact derivatives by jets have rounding errors of 1e-9 of their
    /// size, and 1e-12 if terms cancel.
    #[test]
    fn values_and_slopes_are_enclosed(text in formulas(), region in boxes(), parts in prop::collection::vec([0.0..=1.0, 0.0..=1.0, 0.0..=1.0], 12)) {
        let set = set(&text);
        let bounds = set.bounds(0, &region);
        let corners = (0..8usize).map(|bits| [bits & 1, bits >> 1 & 1, bits >> 2 & 1].map(|bit| bit as f64));
        for part in parts.iter().copied().chain(corners) {
            let x: [f64; 3] = std::array::from_fn(|d| (region[d][0] + part[d] * (region[d][1] - region[d][0])).clamp(region[d][0], region[d][1]));
            let y = value(&set, x);
            if y.is_finite() {
                prop_assert!(within(bounds.value, y), "{text} is {y} at {x:?}, outside {:?}", bounds.value);
            } else {
                // A result without a value somewhere is not whole. One that is too large for a double has no break.
                prop_assert!(y.is_infinite() || !bounds.value.is_whole(), "{text} has no value at {x:?}");
            }
            if !bounds.value.is_whole() {
                continue;
            }
            for (d, band) in region.iter().enumerate() {
                let along = |e: usize| if e == d { [1.0; 2] } else { [0.0; 2] };
                let jet = set.jets(&[0], |e| Jet::variable(x[e], along(e)))[0];
                if let (true, Some(slope)) = (band[0] < band[1], jet.first(0)) {
                    let allowed = 1e-9 * slope.abs() + 1e-12;
                    let slopes = bounds.slopes[d];
                    prop_assert!(
                        slopes.lower() - allowed <= slope && slope <= slopes.upper() + allowed,
                        "{text} changes by {slope} at {x:?}, outside {slopes:?}"
                    );
                }
            }
        }
    }
}

fn ends(text: &str, a: [f64; 2], b: [f64; 2]) -> [f64; 2] {
    let value = set(text).bounds(0, &[a, b, [0.0; 2]]).value;
    [value.lower(), value.upper()]
}

/// Bounds of single operations are as narrow as possible, up to the last digits.
#[test]
fn single_operations_are_tight() {
    use std::f64::consts::PI;
    type Ends = [f64; 2];
    let cases: &[(&str, Ends, Ends, Ends)] = &[
        ("a + b", [1.0, 2.0], [-0.5, 0.25], [0.5, 2.25]),
        ("a - b", [1.0, 2.0], [-0.5, 0.25], [0.75, 2.5]),
        ("a*b", [-1.0, 2.0], [-3.0, 5.0], [-6.0, 10.0]),
        ("a/b", [1.0, 2.0], [-4.0, -2.0], [-1.0, -0.25]),
        ("a/b", [1.0, 2.0], [0.0, 4.0], [f64::NEG_INFINITY, f64::INFINITY]),
        ("a/b", [0.0, 0.0], [-4.0, -1.0], [0.0, 0.0]),
        ("a/b", [1.0, 2.0], [-1.0, 4.0], [f64::NEG_INFINITY, f64::INFINITY]),
        ("a*a", [-1.0, 2.0], [0.0; 2], [0.0, 4.0]),
        ("a^4", [-2.0, 1.0], [0.0; 2], [0.0, 16.0]),
        // Multiplied out, the dependency of the factors is lost.
        ("a^3", [-2.0, 1.0], [0.0; 2], [-8.0, 4.0]),
        ("a^5.0", [-2.0, -1.0], [0.0; 2], [-32.0, -1.0]),
        ("a^(-2)", [-2.0, -0.5], [0.0; 2], [0.25, 4.0]),
        ("a^b", [0.25, 4.0], [-1.0, 2.0], [0.0625, 16.0]),
        ("sqrt(a)", [-1.0, 4.0], [0.0; 2], [0.0, 2.0]),
        ("abs(a)", [-3.0, 2.0], [0.0; 2], [0.0, 3.0]),
        ("cos(a)", [-0.1, 0.2], [0.0; 2], [0.2f64.cos(), 1.0]),
        ("cos(a)", [3.0, 3.5], [0.0; 2], [-1.0, 3.5f64.cos()]),
        ("sin(a)", [1.0, 5.0], [0.0; 2], [-1.0, 1.0]),
        ("sin(a)", [100.0 * PI - 0.1, 100.0 * PI + 0.2], [0.0; 2], [-0.1f64.sin(), 0.2f64.sin()]),
        ("sin(a)", [1e9, 1e9 + 1e-3], [0.0; 2], [-1.0, 1.0]),
        ("tan(a)", [-1.0, 1.5], [0.0; 2], [(-1f64).tan(), 1.5f64.tan()]),
        ("tan(a)", [1.5, 1.6], [0.0; 2], [f64::NEG_INFINITY, f64::INFINITY]),
        ("asin(a)", [-2.0, 0.5], [0.0; 2], [-PI / 2.0, 0.5f64.asin()]),
        ("acos(a)", [-0.5, 0.5], [0.0; 2], [0.5f64.acos(), (-0.5f64).acos()]),
        ("ln(a)", [0.0, 1.0], [0.0; 2], [f64::NEG_INFINITY, 0.0]),
        ("cosh(a)", [-1.0, 0.5], [0.0; 2], [1.0, 1f64.cosh()]),
        ("atan2(a, b)", [1.0, 2.0], [-1.0, 1.0], [1f64.atan2(1.0), 1f64.atan2(-1.0)]),
        ("atan2(a, b)", [-1.0, 1.0], [-1.0, 1.0], [-PI, PI]),
        ("hypot(a, b)", [-3.0, 1.0], [4.0, 5.0], [4.0, 34f64.sqrt()]),
        ("floor(a)", [0.5, 2.5], [0.0; 2], [0.0, 2.0]),
        ("sign(a)", [-0.5, 2.5], [0.0; 2], [-1.0, 1.0]),
        ("min(a, b)", [0.0, 3.0], [1.0, 2.0], [0.0, 2.0]),
        ("max(a, b)", [0.0, 3.0], [1.0, 2.0], [1.0, 3.0]),
        ("a < b", [0.0, 1.0], [2.0, 3.0], [1.0, 1.0]),
        ("a < b", [0.0, 2.0], [1.0, 3.0], [0.0, 1.0]),
        ("if(a < b, a, 7)", [0.0, 1.0], [2.0, 3.0], [0.0, 1.0]),
        ("if(a < b, a, 7)", [0.0, 2.0], [1.0, 3.0], [0.0, 7.0]),
    ];
    for &(text, a, b, expected) in cases {
        for (found, expected) in ends(text, a, b).into_iter().zip(expected) {
            // The tolerance is eight units in the last place: a library function and its widening, twice.
            let near = found == expected || (found - expected).abs() <= 8.0 * f64::EPSILON * expected.abs().max(1e-300);
            // Near a multiple of pi the place itself is rounded.
            let near = near || text == "sin(a)" && (found - expected).abs() <= 1e-13;
            assert!(near, "{text} over {a:?}, {b:?}: {found} and {expected}");
        }
    }
}

/// Rounding is outward for sums, products, quotients and roots of numbers that are not exact doubles.
#[test]
fn rounding_is_outward() {
    for text in ["a + b", "a*b", "a/b", "sqrt(a)", "a*a"] {
        let [lower, upper] = ends(text, [0.1; 2], [0.3; 2]);
        assert!(lower < upper && upper <= lower.next_up(), "{text}: {lower} .. {upper}");
    }
    for (text, exact) in [("a + b", 0.75), ("a*b", 0.125), ("b/a", 2.0), ("sqrt(a)", 0.5), ("a - a", 0.0)] {
        assert_eq!(ends(text, [0.25; 2], [0.5; 2]), [exact; 2], "{text}");
    }
    // A value below the least double is enclosed too.
    let [lower, upper] = ends("exp(a)", [-800.0; 2], [0.0; 2]);
    assert!(lower == 0.0 && upper > 0.0);
    let [lower, upper] = ends("a*a*a*a", [-1e-100; 2], [0.0; 2]);
    assert!(lower <= 0.0 && upper > 0.0);
}

#[test]
fn what_has_no_value_anywhere_is_empty() {
    for text in ["sqrt(a)", "ln(a)", "a^0.5", "asin(a)", "min(sqrt(a), 1)", "if(sqrt(a) < 1, 1, 2)"] {
        assert!(set(text).bounds(0, &[[-3.0, -2.0], [0.0; 2], [0.0; 2]]).value.is_empty(), "{text}");
    }
    // The formula has a value in part of the box only: this part is enclosed and marked as not whole.
    let half = set("sqrt(a)").bounds(0, &[[-3.0, 4.0], [0.0; 2], [0.0; 2]]).value;
    assert_eq!((half.lower(), half.upper(), half.is_whole()), (0.0, 2.0, false));
}
