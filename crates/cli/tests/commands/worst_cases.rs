//! Worst cases as printed on a terminal, against the extremes of the model.

use sensitol_study::Study;
use sensitol_testing::{among, random_points, repository, vertices};

use super::command::sensitol;

/// Returns the printed worst cases with their names.
fn shown(study: &str) -> Vec<(String, [f64; 2])> {
    let mut command = sensitol(&["analyze", "-q", study]);
    let output = command.output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let of = |line: &str| {
        let at = ["proven worst case", "linear worst case", "worst case"]
            .iter()
            .find_map(|name| Some((name, line.find(name)?)));
        let (name, at) = at?;
        let (low, high) = line[at + name.len()..].trim().split_once(" .. ")?;
        Some(((*name).to_owned(), [low.parse().ok()?, high.parse().ok()?]))
    };
    text.lines().filter_map(of).collect()
}

/// Proven ends are rounded outward: no value lies beyond the printed numbers, which differ by a digit at most. A linear worst case of a
/// product is not conservative, and is not shown.
#[test]
fn printed_ends_are_proven() {
    let study = Study::read(&repository("tests/data/worst-case-label.toml")).unwrap();
    let corners = among(&study.problem, &vertices(&study.problem));
    let shown = shown(&repository("tests/data/worst-case-label.toml").display().to_string());
    let names: Vec<&str> = shown.iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(names, ["worst case", "proven worst case"], "a linear one, and one that is not");
    for ((name, [low, high]), [least, greatest]) in shown.iter().zip(corners) {
        // A difference of a millionth of the last digit is rounding.
        assert!(*low <= least + 1e-13 && greatest <= high + 1e-13, "{name}: {low} .. {high}, {least} .. {greatest}");
        assert!(least - low <= 1.01e-7 && high - greatest <= 1.01e-7, "{name}: {low} .. {high}, {least} .. {greatest}");
    }
}

/// Formulas at random points, at any scale: no value lies beyond the printed ends.
#[test]
fn no_value_lies_beyond_printed_ends() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml").display().to_string();
    for scale in [1e-9, 1e-3, 1.0, 777.0, 3e7, 2e12] {
        for formula in ["a*b - c", "sin(a) + b*c", "a/(2 + b) + c^3"] {
            let text = format!(
                "[dimensions]\na = {{ nominal = 0.3, tolerance = 0.137 }}\nb = {{ nominal = 0.7, tolerance = 0.211 }}\n\
                 c = {{ nominal = 0.1, tolerance = 0.0531 }}\n[characteristics]\ny = {{ formula = \"{scale:e}*({formula})\" }}\n"
            );
            std::fs::write(&path, &text).unwrap();
            let study = Study::read(std::path::Path::new(&path)).unwrap();
            let mut points = vertices(&study.problem);
            points.extend(random_points(&study.problem, 20_000));
            let [least, greatest] = among(&study.problem, &points)[0];
            let found = shown(&path);
            let [(name, [low, high])] = &found[..] else { panic!("{found:?}") };
            assert!(name.ends_with("worst case") && name != "linear worst case", "{name}");
            let slack = 1e-9 * scale;
            assert!(*low <= least + slack && greatest <= high + slack, "{text}{low} .. {high}, {least} .. {greatest}");
            // The extremes of these formulas are at corners. The ends differ by at most two units of the last of five digits of sigma.
            assert!(
                least - low <= 4e-5 * scale && high - greatest <= 4e-5 * scale,
                "{text}{low} .. {high}, {least} .. {greatest}"
            );
        }
    }
}
