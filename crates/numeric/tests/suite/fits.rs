//! ISO 286 fits, compared with printed tables and the standard's formulas, and sizes without a fit.

use proptest::prelude::*;
use sensitol_numeric::fits::{FitError, deviations};
use sensitol_testing::{data, repository};

const SHAFTS: [&str; 28] = [
    "a", "b", "c", "cd", "d", "e", "ef", "f", "fg", "g", "h", "js", "j", "k", "m", "n", "p", "r", "s", "t", "u", "v",
    "x", "y", "z", "za", "zb", "zc",
];
const GRADES: [&str; 20] =
    ["01", "0", "1", "2", "3", "4", "5", "6", "7", "8", "9", "10", "11", "12", "13", "14", "15", "16", "17", "18"];
/// Upper ends of the size ranges, in mm.
const RANGES: [f64; 13] = [3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0, 120.0, 180.0, 250.0, 315.0, 400.0, 500.0];
/// Upper ends of the finer size ranges, in mm.
const STEPS: [f64; 25] = [
    3.0, 6.0, 10.0, 14.0, 18.0, 24.0, 30.0, 40.0, 50.0, 65.0, 80.0, 100.0, 120.0, 140.0, 160.0, 180.0, 200.0, 225.0,
    250.0, 280.0, 315.0, 355.0, 400.0, 450.0, 500.0,
];

/// Deviations in micrometres, rounded to the tenths of the tables (js and JS: to twentieths).
#[track_caller]
fn um(nominal: f64, class: &str) -> [f64; 2] {
    deviations(nominal, class).unwrap().map(|mm| (mm * 2e4).round() / 20.0)
}

/// Width of a grade, in micrometres.
fn it(nominal: f64, grade: &str) -> f64 {
    um(nominal, &format!("h{grade}"))[0].abs()
}

/// Distance of the shaft's nearer limit from the zero line, in micrometres. Returns None if there is no such shaft.
fn fundamental(nominal: f64, letter: &str) -> Option<f64> {
    let [lower, upper] = deviations(nominal, &format!("{letter}7")).ok()?.map(|mm| (mm * 1e4).round() / 10.0);
    Some(if letter <= "h" { -upper } else { lower })
}

/// Geometric mean of a size range. The first range begins at 1 mm.
fn mean_size(ends: &[f64], place: usize) -> f64 {
    let begin = if place == 0 { 1.0 } else { ends[place - 1] };
    (begin * ends[place]).sqrt()
}

#[test]
fn printed_limit_deviations() {
    let table = std::fs::read_to_string(repository("tests/data/iso286.csv")).unwrap();
    let mut rows = 0;
    for line in table.lines().skip(1) {
        let [class, nominal, lower, upper, _] = line.split(',').collect::<Vec<_>>()[..] else { panic!("{line}") };
        let [lower, upper] = [lower, upper].map(|text| text.parse::<f64>().unwrap());
        let found = deviations(nominal.parse().unwrap(), class).unwrap_or_else(|error| panic!("{line}: {error}"));
        // The doubles nearest to the printed values, without tolerance.
        assert_eq!(found, [lower / 1000.0, upper / 1000.0], "{line}");
        rows += 1;
    }
    assert!(rows >= 300, "{rows} rows");
}

/// All values of a textbook's tables, except its two misprints.
#[test]
fn printed_tolerances_and_fundamental_deviations() {
    let book = data("iso286-tables.json");
    let number = |value: &serde_json::Value| value.as_f64();
    let mut compared = 0;
    for (size, row) in book["sizes"].as_array().unwrap().iter().zip(book["tolerances"].as_array().unwrap()) {
        for (grade, printed) in book["grades"].as_array().unwrap().iter().zip(row.as_array().unwrap()) {
            assert_eq!(
                it(size.as_f64().unwrap(), grade.as_str().unwrap()),
                number(printed).unwrap(),
                "IT{grade} {size}"
            );
            compared += 1;
        }
    }
    let misprint = |letter: &str, size: f64| {
        book["misprints"].as_array().unwrap().iter().any(|of| of[0] == letter && number(&of[1]) == Some(size))
    };
    for (side, class) in [("shafts", "7"), ("holes", "7")] {
        let letters = book[side]["letters"].as_array().unwrap();
        for (size, row) in book[side]["lower"].as_object().unwrap() {
            let size: f64 = size.parse().unwrap();
            for (letter, printed) in letters.iter().zip(row.as_array().unwrap()) {
                let letter = letter.as_str().unwrap();
                let found = deviations(size, &format!("{letter}{class}"));
                match number(printed) {
                    Some(printed) if !misprint(letter, size) => {
                        assert_eq!(um(size, &format!("{letter}{class}"))[0], printed, "{letter} {size}");
                        compared += 1;
                    }
                    Some(_) => {}
                    None => assert!(matches!(found, Err(FitError::SizeOfLetter { .. })), "{letter} {size}"),
                }
            }
        }
    }
    for (size, row) in book["holes"]["deltas"].as_object().unwrap() {
        let size: f64 = size.parse().unwrap();
        for (grade, printed) in (3..).zip(row.as_array().unwrap()) {
            // ES of K is -ei + delta. The ei of k in any grade is that of grade 7.
            let delta = um(size, &format!("K{grade}"))[1] + um(size, "k7")[0];
            assert_eq!(Some(delta), number(printed), "delta of grade {grade} at {size}");
            compared += 1;
        }
    }
    for (size, row) in book["holes"]["j6_j7_j8"].as_object().unwrap() {
        for (grade, printed) in (6..).zip(row.as_array().unwrap()) {
            assert_eq!(Some(um(size.parse().unwrap(), &format!("J{grade}"))[1]), number(printed), "J{grade} {size}");
            compared += 1;
        }
    }
    assert!(compared > 600, "{compared} values");
}

/// All fundamental deviations, compared with the standard's formula at the mean size. The standard rounds to whole micrometres at first,
/// and to tens and fifties above. Entries that it prints differently are listed. The tests above compare those with printed tables.
#[test]
fn fundamental_deviations_follow_their_formulas() {
    let mut entries = 0;
    for (letter, ends) in letters_with_formulas() {
        for (place, &size) in ends.iter().enumerate() {
            let Some(found) = fundamental(size, letter) else { continue };
            entries += 1;
            let [least, most] = formula(letter, size, mean_size(ends, place));
            let rounding = rounding(letter, found);
            let agrees = (least - rounding..=most + rounding).contains(&found);
            assert_eq!(
                agrees,
                !printed_otherwise(letter, size),
                "{letter} to {size} mm: {found}, formula {least} to {most}"
            );
        }
    }
    assert_eq!(entries, 3 * 25 + 3 * 6 + 4 * 13 + 4 * 13 + 25 * 8 + 19 + 21 + 20, "the whole table");
}

/// Rounding of a value. The standard rounds to 1 um at first, to 5 and 10 above 200 (a to g: above 60), to 20 and 50 above 600, and a to c
/// always to tens.
fn rounding(letter: &str, value: f64) -> f64 {
    match value {
        _ if letter <= "b" => 0.05 * value,
        _ if letter == "c" => (0.03 * value).max(2.0),
        value if value <= 600.0 && letter > "g" => (0.01 * value).max(1.25),
        value => (0.025 * value).max(1.05),
    }
}

/// Letters with formulas, with the ends of the size ranges of their values.
fn letters_with_formulas() -> Vec<(&'static str, &'static [f64])> {
    let by_range = ["cd", "d", "e", "ef", "f", "fg", "g", "k", "m", "n", "p"];
    let ends = |letter: &'static str| if by_range.contains(&letter) { &RANGES[..] } else { &STEPS[..] };
    SHAFTS
        .into_iter()
        .filter(|letter| !["h", "js", "j"].contains(letter))
        .map(|letter| (letter, ends(letter)))
        .collect()
}

/// Fundamental deviation at the mean size `d` by ISO 286-1:1988, table 5. Most have one value, p and s an interval.
fn formula(letter: &str, size: f64, d: f64) -> [f64; 2] {
    let it = |grade: &str| it(size, grade);
    let one = |value: f64| [value, value];
    let mean = |a: &str, b: &str| one((fundamental(size, a).unwrap() * fundamental(size, b).unwrap()).sqrt());
    match letter {
        "a" => one(if size <= 120.0 { 265.0 + 1.3 * d } else { 3.5 * d }),
        "b" => one(if size <= 160.0 { 140.0 + 0.85 * d } else { 1.8 * d }),
        "c" => one(if size <= 40.0 { 52.0 * d.powf(0.2) } else { 95.0 + 0.8 * d }),
        "cd" => mean("c", "d"),
        "d" => one(16.0 * d.powf(0.44)),
        "e" => one(11.0 * d.powf(0.41)),
        "ef" => mean("e", "f"),
        "f" => one(5.5 * d.powf(0.41)),
        "fg" => mean("f", "g"),
        "g" => one(2.5 * d.powf(0.34)),
        "k" => one(0.6 * d.cbrt()),
        "m" => one(it("7") - it("6")),
        "n" => one(5.0 * d.powf(0.34)),
        "p" => [it("7"), it("7") + 5.0],
        "r" => mean("p", "s"),
        "s" if size <= 50.0 => [it("8") + 1.0, it("8") + 4.0],
        "s" => one(it("7") + 0.4 * d),
        "t" => one(it("7") + 0.63 * d),
        "u" => one(it("7") + d),
        "v" => one(it("7") + 1.25 * d),
        "x" => one(it("7") + 1.6 * d),
        "y" => one(it("7") + 2.0 * d),
        "z" => one(it("7") + 2.5 * d),
        "za" => one(it("8") + 3.15 * d),
        "zb" => one(it("9") + 4.0 * d),
        "zc" => one(it("10") + 5.0 * d),
        _ => unreachable!(),
    }
}

/// True if the printed value differs from the formula: for c between its two branches, and for transition and interference at the smallest
/// sizes, where the standard keeps the letters apart.
fn printed_otherwise(letter: &str, size: f64) -> bool {
    match letter {
        "c" => size > 10.0 && size <= 40.0,
        "m" | "n" | "p" => size <= 3.0,
        "t" => size <= 30.0,
        "u" => size <= 14.0,
        "x" | "z" => size <= 18.0,
        "za" => size <= 10.0,
        "zb" => size <= 6.0 || size == 18.0,
        "zc" => size <= 6.0,
        _ => false,
    }
}

/// Formulas of the grades: IT5 to IT18 are 7 to 2500 tolerance units, IT01 to IT1 are linear in the size, and IT2 to IT4 lie between IT1
/// and IT5.
#[test]
fn tolerances_follow_their_formulas() {
    let units = [7.0, 10.0, 16.0, 25.0, 40.0, 64.0, 100.0, 160.0, 250.0, 400.0, 640.0, 1000.0, 1600.0, 2500.0];
    for (place, &size) in RANGES.iter().enumerate() {
        let d = mean_size(&RANGES, place);
        let i = 0.45 * d.cbrt() + 0.001 * d;
        for (grade, factor) in (5..).zip(units) {
            let found = it(size, &grade.to_string());
            // Values below 60 are rounded to 1 um, and those above to preferred numbers up to 4.5 % away. To 3 mm the standard prints up to
            // a sixth more.
            let (more, rounding) = (if place == 0 { 1.16 } else { 1.0 }, (0.045 * found).max(0.72));
            let formula = factor * i;
            let printed = formula - rounding..=more * formula + rounding;
            assert!(printed.contains(&found), "IT{grade} {size}: {found} {formula}");
        }
        for (grade, formula) in [("01", 0.3 + 0.008 * d), ("0", 0.5 + 0.012 * d), ("1", 0.8 + 0.02 * d)] {
            // Printed in steps of preferred numbers, a quarter apart: 1, 1.2, 1.5, 2, 2.5, 3, 4.
            let found = it(size, grade);
            assert!((found - formula).abs() <= 0.25 * found.max(formula), "IT{grade} {size}: {found} {formula}");
        }
        let [first, last] = ["1", "5"].map(|grade| it(size, grade));
        for (step, grade) in (1..).zip(["2", "3", "4"]) {
            let between = first * (last / first).powf(f64::from(step) / 4.0);
            let found = it(size, grade);
            assert!((found / between - 1.0).abs() <= 0.2, "IT{grade} {size}: {found} {between}");
        }
        assert!(GRADES.windows(2).all(|pair| it(size, pair[0]) < it(size, pair[1])), "wider from grade to grade");
    }
    for grade in GRADES {
        // The finest grades are constant over some neighbouring ranges.
        assert!(RANGES.windows(2).all(|pair| it(pair[0], grade) <= it(pair[1], grade)), "wider from size to size");
    }
}

/// Every class at every size: existing ones have the width of their grade and the position of their letter.
#[test]
fn every_class_keeps_the_rules() {
    let mut offered = 0;
    for (letter, grade, nominal) in every_class() {
        let class = format!("{letter}{grade}");
        let (shaft, hole) = (deviations(nominal, &class), deviations(nominal, &class.to_uppercase()));
        for [lower, upper] in [&shaft, &hole].into_iter().flatten() {
            assert_eq!(((upper - lower) * 1e4).round() / 10.0, it(nominal, grade), "{class} {nominal}");
            offered += 1;
        }
        match (shaft, hole) {
            (Ok(shaft), Ok(hole)) if letter == "h" => assert!(shaft[1] == 0.0 && hole[0] == 0.0),
            (Ok(shaft), Ok(hole)) if letter == "js" => assert!(shaft == hole && shaft[0] == -shaft[1]),
            // With clearance the hole is the mirrored shaft.
            (Ok([lower, upper]), Ok(hole)) if letter < "h" => assert_eq!(hole, [-upper, -lower], "{class} {nominal}"),
            (_, Ok([_, upper])) if letter > "k" => interference(nominal, letter, grade, (upper * 1e4).round() / 10.0),
            _ => {}
        }
    }
    assert!(offered > 20_000, "{offered} classes");
}

fn every_class() -> impl Iterator<Item = (&'static str, &'static str, f64)> {
    let sized = |letter, grade| STEPS.into_iter().map(move |nominal| (letter, grade, nominal));
    SHAFTS.into_iter().flat_map(move |letter| GRADES.into_iter().flat_map(move |grade| sized(letter, grade)))
}

/// Checks the upper deviation of a hole from M on. For equal fits on hole and shaft basis, such as H7/p6 and P7/h6, the greatest clearance
/// is the same. In coarse grades the hole is the mirrored shaft.
fn interference(nominal: f64, letter: &str, grade: &str, upper: f64) {
    let number: u32 = grade.parse().unwrap();
    let matched = number <= if letter <= "n" { 8 } else { 7 };
    let ei = fundamental(nominal, letter).unwrap();
    let expected = match (letter, number) {
        ("m", 6) if nominal > 250.0 && nominal <= 315.0 => -9.0,
        ("n", _) if !matched && nominal > 3.0 => 0.0,
        _ if !matched || nominal <= 3.0 => -ei,
        _ => {
            let of_shaft = it(nominal, &(number - 1).to_string());
            it(nominal, grade) - ei - of_shaft
        }
    };
    assert!((upper - expected).abs() < 1e-9, "{letter}{grade} {nominal}: {upper}, not {expected}");
}

/// The distance from the zero line grows with the letter and with the size.
#[test]
fn letters_and_sizes_are_in_order() {
    for size in STEPS {
        let of = |letters: &[&str]| letters.iter().filter_map(|letter| fundamental(size, letter)).collect::<Vec<_>>();
        let (clearance, interference) = (of(&SHAFTS[..11]), of(&SHAFTS[13..]));
        assert!(clearance.windows(2).all(|pair| pair[0] > pair[1]), "{size}: {clearance:?}");
        assert!(interference.windows(2).all(|pair| pair[0] < pair[1]), "{size}: {interference:?}");
    }
    for letter in SHAFTS {
        let over: Vec<f64> = STEPS.iter().filter_map(|&size| fundamental(size, letter)).collect();
        let grows = over.windows(2).all(|pair| pair[0] <= pair[1]);
        // The lower deviations of js and j are below the zero line, and that of k starts on it.
        assert!(grows || letter == "js" || letter == "j", "{letter}: {over:?}");
    }
}

proptest! {
    /// A size range includes its upper end.
    #[test]
    fn sizes_within_a_range_are_alike(place in 0usize..25, part in 0.001f64..1.0) {
        let begin = if place == 0 { 1.0 } else { STEPS[place - 1] };
        let within = begin + part * (STEPS[place] - begin);
        for letter in SHAFTS {
            for class in [format!("{letter}7"), format!("{letter}7").to_uppercase()] {
                prop_assert_eq!(deviations(within, &class).ok(), deviations(STEPS[place], &class).ok(), "{}", class);
            }
        }
    }

    /// Any text gives a result or an error, and the error has a message.
    #[test]
    fn any_text_is_answered(nominal in proptest::num::f64::ANY, class in "\\PC{0,5}|[A-Za-z]{1,2}[0-9]{1,2}") {
        match deviations(nominal, &class) {
            Ok([lower, upper]) => prop_assert!(lower < upper && nominal > 0.0 && nominal <= 500.0),
            Err(error) => prop_assert!(!error.to_string().is_empty()),
        }
    }
}

#[test]
fn what_there_is_not() {
    let cases = [
        (25.0, ""),
        (25.0, "H"),
        (25.0, "7"),
        (25.0, "H7/g6"),
        (25.0, "H 7"),
        (25.0, "H7.5"),
        (25.0, "øH7"),
        (25.0, "I7"),
        (25.0, "l6"),
        (25.0, "Js7"),
        (25.0, "zd7"),
        (25.0, "H19"),
        (25.0, "H00"),
        (25.0, "h007"),
        (0.0, "H7"),
        (-5.0, "H7"),
        (f64::NAN, "H7"),
        (500.1, "H7"),
        (24.0, "t7"),
        (14.0, "V7"),
        (18.0, "y6"),
        (50.1, "cd8"),
        (1.0, "A11"),
        (25.0, "j8"),
        (3.0, "j9"),
        (25.0, "J5"),
        (25.0, "K9"),
        (25.0, "P2"),
        (0.8, "h14"),
        (0.8, "N9"),
    ];
    let told: Vec<String> = (cases.iter())
        .map(|(nominal, class)| {
            let error = deviations(*nominal, class).unwrap_err();
            let help = error.help().map_or(String::new(), |help| format!("\n  help: {help}"));
            format!("{nominal} {class}: {error}{help}")
        })
        .collect();
    insta::assert_snapshot!(told.join("\n"));
}
