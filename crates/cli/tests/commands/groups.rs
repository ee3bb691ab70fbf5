//! Groups of equal parts: `count` of a dimension and `sum` in formulas.
//!
//! Oracle: the same parts written one by one.

use sensitol::{Method, analyze};
use sensitol_study::Study;

use super::command::sensitol;
use sensitol_testing::close;

const GROUP: &str = "[dimensions]\nhousing = { nominal = 9, tolerance = 0.2, unit = \"mm\" }\n\
                     disc = { nominal = 2, tolerance = [-0.1, 0.05], count = 4, unit = \"mm\", part = \"stack\" }\n\
                     [characteristics]\ngap = { formula = \"housing - sum(disc)\", unit = \"mm\", lower = 0.6 }\n";
const ONE_BY_ONE: &str = "[dimensions]\nhousing = { nominal = 9, tolerance = 0.2, unit = \"mm\" }\n\
                          a = { nominal = 2, tolerance = [-0.1, 0.05], unit = \"mm\" }\nb = { nominal = 2, tolerance = [-0.1, 0.05], unit = \"mm\" }\n\
                          c = { nominal = 2, tolerance = [-0.1, 0.05], unit = \"mm\" }\nd = { nominal = 2, tolerance = [-0.1, 0.05], unit = \"mm\" }\n\
                          [characteristics]\ngap = { formula = \"housing - a - b - c - d\", unit = \"mm\", lower = 0.6 }\n";

/// Mean, sigma and worst case of the only characteristic.
fn figures(text: &str) -> [f64; 4] {
    let study = Study::from_toml(text, "group.toml").unwrap_or_else(|error| panic!("{error}"));
    let one = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    let (moments, [low, high]) = (one.moments.unwrap(), one.range.worst_case.unwrap());
    [moments.mean(), moments.sigma(), low, high]
}

#[test]
fn equal_parts_vary_independently() {
    let expected = figures(ONE_BY_ONE);
    for units in ["", "units = \"convert\"\n"] {
        for (found, expected) in figures(&format!("{units}{GROUP}")).into_iter().zip(expected) {
            close(found, expected, 1e-13, 9.0);
        }
    }
    // Independent: sqrt(0.2^2 + 4 x 0.075^2)/3. Four times one part would have sqrt(0.2^2 + 0.3^2)/3.
    close(expected[1], (0.04f64 + 4.0 * 0.075 * 0.075).sqrt() / 3.0, 1e-12, 1.0);
    let study = Study::from_toml(GROUP, "group.toml").unwrap();
    for (found, expected) in figures(&study.expanded).into_iter().zip(expected) {
        close(found, expected, 1e-13, 9.0);
    }
}

#[test]
fn a_group_is_in_the_stack_and_refused_as_one_dimension() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("group.toml").to_str().unwrap().to_owned();
    std::fs::write(&path, GROUP).unwrap();
    let output = sensitol(&["analyze", &path, "--stack", "csv"]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!((1..=4).all(|part| text.contains(&format!("disc.{part}"))), "{text}");
    for (wrong, words) in [
        (GROUP.replace("sum(disc)", "4*disc"), "write sum(disc)"),
        (GROUP.replace("count = 4", "count = 0"), "1 to 1000"),
        (GROUP.replace("count = 4", "count = 2.5"), "a number of equal parts"),
    ] {
        std::fs::write(&path, &wrong).unwrap();
        let output = sensitol(&["check", &path, "--color", "never"]).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && error.contains(words), "{error}");
    }
}
