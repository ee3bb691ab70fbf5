//! Formulas: against a tree evaluator of the tests' own, errors with positions, laziness, and batches.

use proptest::prelude::*;
use sensitol::assembly::formula::{FailureReason, Formula, FormulaError, FormulaFault};

use sensitol::assembly::formula::set::{FormulaSet, Meaning};
use sensitol_testing::close;

/// Returns the value of one formula of `x0`, `x1`, `x2` at one point.
fn value(text: &str, x: [f64; 3]) -> f64 {
    let set = set(&[("y", text)]);
    let columns = x.map(|x| [x]);
    let mut result = f64::NAN;
    set.evaluate(&[0], 1, |variable| &columns[variable], |_, _, value| result = value);
    result
}

fn names() -> [(&'static str, Meaning); 5] {
    let variable = Meaning::Variable;
    [
        ("x0", variable(0)),
        ("x1", variable(1)),
        ("x2", variable(2)),
        ("g", Meaning::Constant(9.81)),
        ("e", Meaning::Constant(2.0)),
    ]
}

fn try_set(formulas: &[(&str, &str)]) -> Result<FormulaSet, (usize, FormulaError)> {
    let parse = |(index, (name, text)): (usize, &(&str, &str))| {
        Formula::parse(text).map(|formula| ((*name).to_owned(), formula)).map_err(|error| (index, error))
    };
    FormulaSet::new(formulas.iter().enumerate().map(parse).collect::<Result<_, _>>()?, names())
}

fn set(formulas: &[(&str, &str)]) -> FormulaSet {
    try_set(formulas).unwrap_or_else(|(index, error)| panic!("{}: {error}", formulas[index].1))
}

#[test]
fn precedence_and_constants() {
    for (text, expected) in [
        ("1 + 2*3", 7.0),
        ("(1 + 2)*3", 9.0),
        ("2^3^2", 512.0),
        ("-2^2", -4.0),
        ("2^-1", 0.5),
        ("2*-3", -6.0),
        ("8/4/2", 1.0),
        ("8 - 4 - 2", 2.0),
        ("1e3 + .5 + 2.", 1002.5),
        ("180*deg - pi", 0.0),
        ("1 < 2", 1.0),
        ("2 <= 1", 0.0),
        ("1 + 1 == 2", 1.0),
        ("1 != 1", 0.0),
        ("min(3, 1, 2) + max(1, 5, 4)", 6.0),
        ("if(2 > 1, 10, 20)", 10.0),
        ("hypot(3, 4) + atan2(0, 1) + abs(-2) + sign(-7) + floor(1.7) + ceil(1.2)", 5.0 + 2.0 - 1.0 + 1.0 + 2.0),
        ("e*g", 19.62),
        ("  +1\n\t+ 1 ", 2.0),
    ] {
        assert_eq!(value(text, [0.0; 3]), expected, "{text}");
    }
    assert_eq!(value("x0*x1 - `x2`", [3.0, 4.0, 5.0]), 7.0);
}

/// Formula as a tree, with its text in full parentheses, and its value by Rust's own operators, one row at a time.
#[derive(Debug, Clone)]
enum Tree {
    Number(f64),
    Variable(usize),
    Call(&'static str, Box<Tree>),
    Operator(&'static str, Box<Tree>, Box<Tree>),
    Pair(&'static str, Box<Tree>, Box<Tree>),
    If(Box<Tree>, Box<Tree>, Box<Tree>),
}

impl Tree {
    fn text(&self) -> String {
        match self {
            Self::Number(value) => format!("{value:?}"),
            Self::Variable(index) => format!("x{index}"),
            Self::Call("-", a) => format!("(-{})", a.text()),
            Self::Call(name, a) => format!("{name}({})", a.text()),
            Self::Operator(sign, a, b) => format!("({} {sign} {})", a.text(), b.text()),
            Self::Pair(name, a, b) => format!("{name}({}, {})", a.text(), b.text()),
            Self::If(c, a, b) => format!("if({}, {}, {})", c.text(), a.text(), b.text()),
        }
    }

    fn value(&self, x: [f64; 3]) -> f64 {
        let truth = |is: bool| if is { 1.0 } else { 0.0 };
        match self {
            Self::Number(value) => *value,
            Self::Variable(index) => x[*index],
            Self::Call(name, a) => {
                let a = a.value(x);
                match *name {
                    "-" => -a,
                    "atan" => libm::atan(a),
                    "tanh" => libm::tanh(a),
                    "abs" => a.abs(),
                    "sqrt" => a.sqrt(),
                    "floor" => a.floor(),
                    // The last digit differs from Rust's (see the tests of `elementary`), but this test concerns the evaluator only.
                    _ => value(&format!("{name}(x0)"), [a, 0.0, 0.0]),
                }
            }
            Self::Operator(sign, a, b) | Self::Pair(sign, a, b) => {
                let (a, b) = (a.value(x), b.value(x));
                let nan = a.is_nan() || b.is_nan();
                match *sign {
                    "+" => a + b,
                    "-" => a - b,
                    "*" => a * b,
                    "/" => a / b,
                    "atan2" => libm::atan2(a, b),
                    _ if nan => f64::NAN,
                    "<" => truth(a < b),
                    ">=" => truth(a >= b),
                    "min" => a.min(b),
                    "max" => a.max(b),
                    "hypot" => libm::hypot(a, b),
                    _ => unreachable!(),
                }
            }
            Self::If(c, a, b) => match c.value(x) {
                c if c.is_nan() => f64::NAN,
                0.0 => b.value(x),
                _ => a.value(x),
            },
        }
    }
}

fn trees() -> impl Strategy<Value = Tree> {
    let leaf = prop_oneof![(0.0..10.0f64).prop_map(Tree::Number), (0..3usize).prop_map(Tree::Variable)];
    leaf.prop_recursive(8, 60, 3, |inner| {
        let call = prop::sample::select(
            &["-", "sin", "cos", "tan", "atan", "tanh", "abs", "exp", "sqrt", "ln", "acos", "floor"][..],
        );
        let operator = prop::sample::select(&["+", "-", "*", "/", "<", ">="][..]);
        let pair = prop::sample::select(&["min", "max", "hypot", "atan2"][..]);
        prop_oneof![
            (call, inner.clone()).prop_map(|(name, a)| Tree::Call(name, a.into())),
            (operator, inner.clone(), inner.clone()).prop_map(|(sign, a, b)| Tree::Operator(sign, a.into(), b.into())),
            (pair, inner.clone(), inner.clone()).prop_map(|(name, a, b)| Tree::Pair(name, a.into(), b.into())),
            (inner.clone(), inner.clone(), inner).prop_map(|(c, a, b)| Tree::If(c.into(), a.into(), b.into())),
        ]
    })
}

fn same(a: f64, b: f64) -> bool {
    a == b || (a.is_nan() && b.is_nan())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// Values agree to the last bit, on a batch that ends within a block, with both branches of every `if` taken by some rows.
    #[test]
    fn batches_equal_the_tree(trees in prop::collection::vec(trees(), 1..4), seed in 0..1000u32) {
        let texts: Vec<(String, String)> =
            trees.iter().enumerate().map(|(index, tree)| (format!("y{index}"), tree.text())).collect();
        let formulas: Vec<(&str, &str)> = texts.iter().map(|(name, text)| (name.as_str(), text.as_str())).collect();
        let set = set(&formulas);
        let rows = 300;
        let x = |variable: usize, row: usize| ((row as f64 + 1.0) * (variable as f64 + 1.3) + f64::from(seed)).sin() * 4.0;
        let columns: Vec<Vec<f64>> = (0..3).map(|variable| (0..rows).map(|row| x(variable, row)).collect()).collect();
        let asked: Vec<usize> = (0..trees.len()).rev().collect();
        let mut wrong = Vec::new();
        set.evaluate(&asked, rows, |variable| &columns[variable], |position, row, found| {
            let expected = trees[asked[position]].value([0, 1, 2].map(|variable| columns[variable][row]));
            if !same(found, expected) {
                wrong.push((position, row, found, expected));
            }
        });
        prop_assert!(wrong.is_empty(), "{wrong:?} in {texts:?}");
    }

    /// A formula without a value is explained, and one with a value is not.
    #[test]
    fn what_fails_is_explained(tree in trees()) {
        let text = tree.text();
        let set = set(&[("y", &text)]);
        let x = [0.3, -2.0, 5.0];
        let explained = set.explain(0, |variable| x[variable]);
        prop_assert_eq!(explained.is_some(), !tree.value(x).is_finite(), "{}", text);
        if let Some(failure) = explained {
            prop_assert!(!failure.text[failure.span].is_empty());
        }
    }

    /// Any text is parsed or refused without a panic, and the position of a refusal lies within the text.
    #[test]
    fn any_text_is_read_or_refused(text in "[a-z0-9+*/^()<>=!`., -]{0,40}|\\PC{0,40}") {
        if let Err(error) = Formula::parse(&text) {
            prop_assert!(text.get(error.span.clone()).is_some(), "{:?} of {text:?}", error.span);
            prop_assert!(!error.to_string().is_empty());
        }
    }
}

/// Powers that are written as products are as exact as the general power.
#[test]
fn powers() {
    for exponent in ["-1", "0.5", "1", "2", "3", "4", "5", "2.7"] {
        for x in [0.3, 1.7, 12.5] {
            let found = value(&format!("x0^{exponent}"), [x, 0.0, 0.0]);
            close(found, x.powf(exponent.parse().unwrap()), 1e-15, 0.0);
        }
    }
    assert_eq!(value("(-2)^3", [0.0; 3]), -8.0);
    assert_eq!(value("x0^x1", [2.0, 10.0, 0.0]), 1024.0);
}

/// NaN is never lost, although IEEE 754 would drop it in some operations.
#[test]
fn nan_never_vanishes() {
    for text in [
        "max(acos(2), 1)",
        "min(1, acos(2))",
        "if(acos(2) > 1, 3, 4)",
        "acos(2)^0",
        "1^acos(2)",
        "hypot(1/0, acos(2))",
        "acos(2) != 1",
    ] {
        assert!(value(text, [0.0; 3]).is_nan(), "{text}");
    }
    assert_eq!(value("1/(1/x0 + 1/x1)", [0.0, 3.0, 0.0]), 0.0, "an infinity on the way is no error");
}

#[test]
fn only_the_branch_taken_can_fail() {
    let set = set(&[("y", "if(x0 > 1, safe, acos(x0))"), ("safe", "sqrt(x0 - 1)")]);
    let column = [2.0, 0.5, -3.0];
    let mut values = [0.0; 3];
    set.evaluate(&[0], 3, |_| &column, |_, row, value| values[row] = value);
    assert_eq!(values[..2], [1.0, 0.5f64.acos()]);
    assert!(values[2].is_nan());
    assert!(set.explain(0, |_| 2.0).is_none());
    let failure = set.explain(0, |_| -3.0).unwrap();
    assert_eq!(&failure.text[failure.span], "acos(x0)");
}

/// A failure names the part that fails, its formula and its argument.
#[test]
fn failures_name_their_cause() {
    let set = set(&[
        ("gap", "x0 + 2*sin(phi)"),
        ("phi", "acos((x1 + 1)/x2)"),
        ("ratio", "x0/(x1 - x1)"),
        ("root", "(x0 - 10)^0.5"),
        ("harmless", "1/(1/(x1 - x1)) + ln(x1 - 5)"),
        ("big", "exp(x2*1000)"),
    ]);
    let explain = |formula: usize| set.explain(formula, |variable| [1.0, 2.0, 2.5][variable]).unwrap();
    let phi = explain(0);
    assert_eq!((phi.name.as_str(), &phi.text[phi.span.clone()]), ("phi", "acos((x1 + 1)/x2)"));
    assert_eq!(phi.to_string(), "`acos((x1 + 1)/x2)` in formula `phi`: the argument must lie in -1 .. 1, but is 1.2");
    assert_eq!(explain(2).reason, FailureReason::DivisionByZero);
    assert_eq!(explain(3).reason, FailureReason::Power { base: -9.0, exponent: 0.5 });
    let logarithm = explain(4);
    assert_eq!(&logarithm.text[logarithm.span], "ln(x1 - 5)", "the infinity before it does no harm");
    assert_eq!(explain(5).reason, FailureReason::NotFinite { value: f64::INFINITY });
}

/// Every fault has the position of its text.
#[test]
fn faults_have_their_place() {
    for (text, place, message) in [
        ("", "", "the formula is empty"),
        ("a - (b + 1", "(", "this `(` is never closed"),
        ("a - b)", ")", "this `)` closes nothing"),
        ("a + * b", "*", "a number, a name or `(` is missing before `*`"),
        ("a +", "", "a number, a name or `(` is missing before the end"),
        ("2 a", "a", "an operator is missing before `a`"),
        ("2e", "e", "an operator is missing before `e`"),
        ("a ** 2", "**", "`**` means nothing in a formula"),
        ("a = 2", "=", "`=` means nothing in a formula"),
        ("a && b", "&&", "`&&` means nothing in a formula"),
        ("a # b", "#", "`#` means nothing in a formula"),
        ("1e999", "1e999", "`1e999` is not a number that fits a double"),
        ("`a + b", "`", "the name that starts here has no closing backquote"),
        ("a, b", ",", "a comma stands between the arguments of a function only"),
        ("(a, b)", ",", "a comma stands between the arguments of a function only"),
        ("a < b < c", "<", "comparisons cannot be chained"),
        ("sine(a)", "sine", "there is no function `sine`"),
        ("sin + 1", "sin", "`sin` is a function and needs its arguments in parentheses"),
        ("atan2(a)", "atan2(a)", "`atan2` takes 2 argument(s), not 1"),
        ("min(a)", "min(a)", "`min` takes 2 or more argument(s), not 1"),
        ("if(a, b)", "if(a, b)", "`if` takes 3 (condition, then, else) argument(s), not 2"),
        ("sin()", "sin()", "`sin` takes 1 argument(s), not 0"),
    ] {
        let error = Formula::parse(text).unwrap_err();
        assert_eq!((&text[error.span.clone()], error.to_string().as_str()), (place, message), "{text}");
    }
    let last = Formula::parse("a < b < c").unwrap_err();
    assert_eq!(last.span, 6..7, "the second comparison is one too many");
    assert_eq!(Formula::parse("sine(a)").unwrap_err().fault.help().unwrap(), "did you mean `sin`?");
}

#[test]
fn undefined_names_and_cycles_have_their_place() {
    let (index, error) = try_set(&[("y", "x0 + 1"), ("z", "2*X1")]).unwrap_err();
    assert_eq!((index, error.span), (1, 2..4));
    assert_eq!(error.fault, FormulaFault::UndefinedName { name: "X1".into(), nearest: Some("x1".into()) });
    let (index, error) = try_set(&[("y", "x0 + u"), ("u", "v + 1"), ("v", "2*w"), ("w", "1 + u")]).unwrap_err();
    assert_eq!((index, error.to_string().as_str()), (1, "`u` needs its own value: u -> v -> w -> u"));
    assert_eq!(error.span, 0..1);
    let (_, error) = try_set(&[("y", "1 + y")]).unwrap_err();
    assert_eq!(error.to_string(), "`y` needs its own value: y -> y");
}

/// Deep nesting is refused. Long sums and chains are parsed, evaluated and explained with little stack.
#[test]
fn size_is_no_danger() {
    let deep = |depth: usize| format!("{}x0{}", "(".repeat(depth), ")".repeat(depth));
    assert!(Formula::parse(&deep(200)).is_ok());
    assert!(matches!(Formula::parse(&deep(100_000)).unwrap_err().fault, FormulaFault::TooDeep { .. }));
    let powers = vec!["x0"; 100_000].join("^");
    assert!(matches!(Formula::parse(&powers).unwrap_err().fault, FormulaFault::TooDeep { .. }));
    let sum = vec!["x0"; 100_000].join(" + ");
    assert_eq!(value(&sum, [1.0, 0.0, 0.0]), 100_000.0);
    // A thousand formulas, each an `if` in a branch of the next one.
    let names: Vec<String> = (0..1000).map(|i| format!("f{i}")).collect();
    let texts: Vec<String> = (0..1000)
        .map(|i| if i == 0 { "x0".into() } else { format!("if(x1 > {i}, f{}, sqrt(x1 - {i}))", i - 1) })
        .collect();
    let formulas: Vec<(&str, &str)> = names.iter().map(String::as_str).zip(texts.iter().map(String::as_str)).collect();
    let set = set(&formulas);
    let columns = [[7.0], [1e6], [0.0]];
    set.evaluate(&[999], 1, |variable| &columns[variable], |_, _, value| assert_eq!(value, 7.0));
    assert!(set.explain(999, |_| 3.0).is_some());
}

/// Formulas that are not asked for do not count as dependencies.
#[test]
fn dependence_is_known() {
    let set = set(&[("y", "a1 + x0"), ("a1", "2*x1"), ("z", "x2"), ("never", "if(1 < 2, x0, x1)")]);
    assert_eq!(set.variables(0), [0, 1]);
    assert_eq!(set.variables(2), [2]);
    assert_eq!(set.variables(3), [0], "a branch that is never taken needs nothing");
    assert_eq!(set.used([0]), [true, true, false, false]);
}
