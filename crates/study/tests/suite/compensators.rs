//! Faults of `[[adjust]]`, extremes over motions and conditions: one each, with the line and its words.

use sensitol_testing::faults;

/// Asserts that a study has one fault with these words in message or help, at the line of `at`.
fn refused(text: &str, at: &str, words: &[&str]) {
    let found = faults(&[text]);
    let line = 1 + text[..text.find(at).unwrap()].matches('\n').count();
    assert!(found.starts_with(&format!("{line}:")), "line {line}: {found}");
    for word in words {
        assert!(found.contains(word), "{word}: {found}");
    }
}

const DIMENSIONS: &str = "[dimensions]\nroom = { nominal = 1.1, tolerance = 0.1 }\nshim = { nominal = 1.0 }\n\
    other = { nominal = 1.0 }\n[characteristics]\ngap = { formula = \"room - shim\", lower = 0.05, upper = 0.2 }\n\
    sum = { formula = \"room + shim\" }\n";

#[test]
fn a_stock_is_usable() {
    let adjust = |keys: &str| format!("{DIMENSIONS}[[adjust]]\n{keys}\n");
    let stock = |values: &str| adjust(&format!("dimension = \"shim\"\nto = \"gap\"\n{values}"));
    for (text, at, words) in [
        (
            adjust("dimension = \"shimm\"\nvalues = [1]\nto = \"gap\""),
            "\"shimm\"",
            &["no dimension `shimm`", "`shim`"][..],
        ),
        (adjust("dimension = \"shim\"\nvalues = [1]\nto = \"gab\""), "\"gab\"", &["no characteristic `gab`", "`gap`"]),
        (adjust("dimension = \"other\"\nvalues = [1]\nto = \"gap\""), "\"other\"", &["does not depend on `other`"]),
        (
            adjust("dimension = \"shim\"\nvalues = [1]\nto = \"sum\""),
            "\"sum\"",
            &["`target` is missing", "both limits"],
        ),
        (stock("values = []"), "[]", &["stock of `shim` is empty", "step = 0.1"]),
        (stock("values = [1.0, 1.1, 1.0]"), "[1.0, 1.1", &["1 is in stock twice", "leave one"]),
        (stock("values = [1.0]\nstep = 0.1"), "[1.0]", &["`values` and `step`"]),
        (stock("range = [0.5, 1.5]"), "[0.5", &["`step` is missing", "step = 0.1"]),
        (stock("values = \"0.1\""), "\"0.1\"", &["its numbers as a list: [0.1]"]),
        (stock("values = [1.0]\ntarget = nan"), "nan", &["not a finite number"]),
        (stock("step = 0.1"), "0.1\n", &["`range` is missing", "range = [0.5, 1.5]"]),
        (stock("step = -0.1\nrange = [0.5, 1.5]"), "-0.1", &["-0.1 is not above 0"]),
        (stock("step = 0.1\nrange = [1.5, 0.5]"), "[1.5", &["write [0.5, 1.5]"]),
        (stock("step = 1e-6\nrange = [0.5, 1.5]"), "1e-6", &["1000001 values", "coarser"]),
        (stock("values = [1.0]\ntarget = 0.3"), "0.3", &["target 0.3 lies outside the limits of `gap`"]),
        (stock("values = [1.0]\nresponse = \"linear\""), "\"linear\"", &["`gap` is a formula", "leave `response` out"]),
        (stock("values = [1.0]\nresponse = \"monotone\""), "\"monotone\"", &["`gap` is a formula"]),
        (stock("values = [1.0]\nresponse = \"straight\""), "\"straight\"", &["form of a response", "linear"]),
    ] {
        refused(&text, at, words);
    }
    let many: Vec<String> = (0..1001).map(|index| format!("{index}")).collect();
    refused(&stock(&format!("values = [{}]", many.join(", "))), "[0, 1", &["1001 values", "1000 is the most"]);
    let twice = stock("values = [1.0, 1.1]\n[[adjust]]\ndimension = \"shim\"\nto = \"gap\"\nvalues = [1.2]");
    refused(&twice, "\"shim\"\nto = \"gap\"\nvalues = [1.2]", &["adjusted by another [[adjust]] already"]);
    let table = format!("{DIMENSIONS}[adjust]\ndimension = \"shim\"\nto = \"gap\"\nvalues = [1.0]\n");
    refused(&table, "[adjust]", &["below its own [[adjust]]"]);
}

#[test]
fn a_motion_has_a_range_and_a_dimension_of_its_own() {
    let text = |keys: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 1.0, tolerance = 0.1 }}\nt = {{ nominal = 0.0 }}\nb = {{ nominal = 0.0 }}\n\
             [characteristics]\ngap = {{ formula = \"a*cos(t)\", unit = \"mm\" }}\nleast = {{ {keys} }}\n"
        )
    };
    let motion =
        |of: &str, over: &str, range: &str| text(&format!("minimum = {{ of = \"{of}\", over = \"{over}\", {range} }}"));
    for (text, words) in [
        (motion("gab", "t", "from = 0, to = 1"), &["no characteristic `gab`", "`gap`"][..]),
        (motion("least", "t", "from = 0, to = 1"), &["`least` is an extreme over a motion itself"]),
        (motion("gap", "u", "from = 0, to = 1"), &["no dimension `u`"]),
        (motion("gap", "a", "from = 0, to = 1"), &["`a` has a tolerance", "dimension without tolerance"]),
        (motion("gap", "b", "from = 0, to = 1"), &["does not depend on `b`"]),
        (motion("gap", "t", "from = 1, to = 1"), &["from 1 to 1", "greater one as `to`"]),
        (motion("gap", "t", "from = 0, to = 1, steps = 2"), &["2 is not from 4 to 10000 steps"]),
        (
            motion("gap", "t", "from = 0, to = 1").replace("least = {", "least = { unit = \"m\","),
            &["`gap`, mm", "leave `unit` out"],
        ),
        (
            text("formula = \"a\", minimum = { of = \"gap\", over = \"t\", from = 0, to = 1 }"),
            &["`minimum` and `formula`"],
        ),
        (text("minimum = 0.2"), &["a limit is `lower` or `upper`"]),
    ] {
        refused(&text, "least = ", words);
    }
}

#[test]
fn a_condition_is_another_characteristic_with_limits() {
    let text = |a: &str, b: &str| {
        format!(
            "[dimensions]\nx = {{ nominal = 1.0, tolerance = 0.1 }}\n[characteristics]\n\
             a = {{ formula = \"x\"{a} }}\nb = {{ formula = \"2*x\"{b} }}\n"
        )
    };
    let limits = ", lower = 0.5";
    let given = |name: &str| format!("{limits}, given = \"{name}\"");
    for (text, words) in [
        (text(&given("c"), limits), &["no characteristic `c`", "a, b"][..]),
        (text(&given("a"), limits), &["`a` is given itself"]),
        (text(&given("b"), &given("a")), &["`a` and `b` are given each other"]),
        (text(&given("b"), ""), &["`b` has no limits", "write lower"]),
        (text(", given = \"b\"", limits), &["`a` has no limits", "write lower"]),
    ] {
        refused(&text, "a = {", words);
    }
}

#[test]
fn a_circle_of_three_conditions_is_shown_whole() {
    let one = |name: &str, given: &str| format!("{name} = {{ formula = \"x\", lower = 0.5, given = \"{given}\" }}\n");
    let text = format!(
        "[dimensions]\nx = {{ nominal = 1.0, tolerance = 0.1 }}\n[characteristics]\n{}{}{}",
        one("p", "q"),
        one("q", "r"),
        one("r", "p")
    );
    refused(&text, "p = {", &["`p` -> `q` -> `r` -> `p` are given each other", "one of them"]);
}
