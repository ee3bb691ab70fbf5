//! `compare-lot`: a lot against its study, the study updated, and what is refused.

use std::path::Path;

use serde_json::Value;

use super::command::sensitol;
use sensitol_testing::{close, read};

const FILES: [&str; 2] = ["examples/housing-lot/parts.csv", "examples/housing-lot/assemblies.csv"];
const STUDY: &str = "examples/housing-lot/study.toml";

fn folder(lot: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("study.toml"), read(STUDY)).unwrap();
    std::fs::write(folder.path().join("lot.csv"), lot).unwrap();
    folder
}

fn run(folder: &Path, arguments: &[&str]) -> (i32, String, String) {
    let output = sensitol(arguments).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8(bytes.to_vec()).unwrap();
    (output.status.code().unwrap(), text(&output.stdout), text(&output.stderr))
}

/// Mean and sigma of a column of the example, by hand.
fn figures(column: &str) -> (f64, f64) {
    let text = read(FILES[0]).replace(',', ".");
    let mut lines = text.lines().map(|line| line.split(';').collect::<Vec<_>>());
    let place = lines.next().unwrap().iter().position(|name| *name == column).unwrap();
    let values: Vec<f64> = lines.map(|line| line[place].parse().unwrap()).collect();
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    (mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / (n - 1.0)).sqrt())
}

/// The housings of the example are 0.03 mm too deep, and nothing else is off.
#[test]
fn the_shifted_dimension_is_found_named_and_updated() {
    let lot = read(FILES[0]);
    let folder = folder(&lot);
    std::fs::write(folder.path().join("assemblies.csv"), read(FILES[1])).unwrap();
    let arguments = ["compare-lot", "study.toml", "lot.csv", "assemblies.csv"];
    let all = ["--json", "--html", "page.html", "--csv", "tables", "--update", "new.toml", "--assumed-parts", "0"];
    let (code, stdout, stderr) = run(folder.path(), &[&arguments[..], &all].concat());
    assert_eq!(code, 0, "{stderr}");
    let report: Value = serde_json::from_str(&stdout).unwrap();
    let play = &report["characteristics"][0];
    assert_eq!(play["verdict"], serde_json::json!({ "kind": "by-parts", "dimension": "depth" }));
    assert_eq!(report["dimensions"][0]["parts"], 60);
    let (mean, sigma) = figures("depth");
    close(report["dimensions"][0]["mean"]["value"].as_f64().unwrap(), mean, 1e-9, 1.0);
    close(report["dimensions"][0]["sigma"]["value"].as_f64().unwrap(), sigma, 1e-9, 1.0);
    let refuted = |one: &Value| one["mean_test"]["adjusted"].as_f64().unwrap() <= 0.05;
    let shifted: Vec<&Value> = report["dimensions"].as_array().unwrap().iter().filter(|one| refuted(one)).collect();
    assert!(shifted.len() == 1 && shifted[0]["name"] == "depth");
    // The linear model: means add up, and variances add up.
    let names = ["depth", "bearing", "spacer", "ring"];
    let predicted = mean - names[1..].iter().map(|name| figures(name).0).sum::<f64>();
    close(play["by_parts"]["mean"].as_f64().unwrap(), predicted, 1e-9, 1.0);
    let page = std::fs::read_to_string(folder.path().join("page.html")).unwrap();
    assert!(page.contains("measured assemblies") && page.contains("<svg"));
    for table in ["parts", "assemblies", "differences", "groups"] {
        assert!(folder.path().join(format!("tables/{table}.csv")).exists(), "{table}");
    }
    // The updated study predicts what the parts do. Without a prior it has their figures, with six digits.
    let (code, stdout, stderr) = run(folder.path(), &["analyze", "new.toml", "--json"]);
    assert_eq!(code, 0, "{stderr}");
    let analysis: Value = serde_json::from_str(&stdout).unwrap();
    close(analysis["characteristics"][0]["mean"].as_f64().unwrap(), predicted, 1e-6, 1.0);
    let variance: f64 = names.iter().map(|name| figures(name).1.powi(2)).sum();
    close(analysis["characteristics"][0]["sigma"].as_f64().unwrap(), variance.sqrt(), 1e-4, 1.0);
    // Everything else is as it was.
    let new = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    assert!(new.contains("[costs]") && new.contains("target_yield = 0.9973"));
}

/// Twenty parts whose correlation is near 1, against a study that assumes -0.5.
fn correlated_lot() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let study = "[dimensions]\na = { nominal = 10, tolerance = 0.06 }\nb = { nominal = 9, tolerance = 0.06 }\n\
                 [characteristics]\ngap = { formula = \"a - b\" }\n\
                 [[correlation]]\nbetween = [\"b\", \"a\"]\nvalue = -0.5 # by experience\n";
    // Values with the mean 0 and the sigma 0.0203, in an order without a trend.
    let order = [3, -7, 9, 0, -4, 6, -10, 2, 8, -1, -6, 5, 10, -9, 1, -3, 7, -8, 4, -5, -2];
    let mut lot = "a,b\n".to_owned();
    for (row, place) in order.into_iter().enumerate() {
        let off = 0.0033 * f64::from(place);
        let noise = if row % 2 == 0 { 0.001 } else { -0.001 };
        lot += &format!("{},{}\n", 10.0 + off, 9.0 + off + noise);
    }
    std::fs::write(folder.path().join("study.toml"), study).unwrap();
    std::fs::write(folder.path().join("lot.csv"), lot).unwrap();
    folder
}

/// The new value stands in the place of the old one, and the study has one correlation as before.
#[test]
fn a_refuted_correlation_is_replaced() {
    let folder = correlated_lot();
    let (code, _, stderr) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv", "--update", "new.toml"]);
    assert_eq!(code, 0, "{stderr}");
    let new = std::fs::read_to_string(folder.path().join("new.toml")).unwrap();
    let value = new.split("value = ").nth(1).unwrap().split(' ').next().unwrap();
    assert!(value.parse::<f64>().unwrap() > 0.9, "{new}");
    assert!(new.matches("[[correlation]]").count() == 1 && new.contains("# by experience"), "{new}");
    let (code, ..) = run(folder.path(), &["analyze", "new.toml"]);
    assert_eq!(code, 0);
}

/// The marginal figures of this lot are those of the study, and the correlation is not.
#[test]
fn a_refuted_correlation_is_a_finding() {
    let folder = correlated_lot();
    let (code, stdout, stderr) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv", "--check"]);
    assert_eq!(code, 1, "{stderr}");
    let before_table = stdout.split("Ppk").next().unwrap();
    assert!(before_table.contains("correlation of a and b: 0.9"), "{stdout}");
    assert_eq!(stdout.matches("correlation of a and b").count(), 1, "{stdout}");
}

/// `--check` ends with 1 if an assumption is refuted, and with 0 if none is.
#[test]
fn check_ends_with_one_where_the_study_is_refuted() {
    let folder = folder(&read(FILES[0]));
    let (code, ..) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv", "--check"]);
    assert_eq!(code, 1);
    let right = "bearing\n15.003\n14.99\n15.012\n14.995\n15.001\n14.987\n15.008\n15.0\n";
    std::fs::write(folder.path().join("right.csv"), right).unwrap();
    let (code, stdout, _) = run(folder.path(), &["compare-lot", "study.toml", "right.csv", "--check"]);
    assert_eq!(code, 0, "{stdout}");
    assert!(stdout.contains("no measured dimension departs from its assumption"), "{stdout}");
}

/// A verdict says the same as the departures that are listed below it.
#[test]
fn verdicts_and_departures_agree() {
    let folder = folder("bearing\n15.003\n14.99\n15.012\n14.995\n15.001\n14.987\n15.008\n15.0\n");
    let (_, stdout, _) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv"]);
    assert!(stdout.contains("play: no assemblies were measured: no measured part of it departs"), "{stdout}");
    assert!(stdout.contains("no measured dimension departs from its assumption"), "{stdout}");
    // Assemblies alone say nothing about parts.
    std::fs::write(folder.path().join("lot.csv"), read(FILES[1])).unwrap();
    let (_, stdout, _) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv"]);
    assert!(!stdout.contains("measured parts") && !stdout.contains("their parts"), "{stdout}");
    let unwrapped = stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(unwrapped.contains("and no part of it was measured"), "{stdout}");
    // The shifted depth of the example changes the prediction, and is the one that is named.
    std::fs::write(folder.path().join("lot.csv"), read(FILES[0])).unwrap();
    let (_, stdout, _) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv"]);
    let unwrapped = stdout.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(unwrapped.contains("the parts change the prediction, most by `depth`"), "{stdout}");
}

#[test]
fn wrong_lots_are_refused() {
    let refused = |lot: &str| {
        let folder = folder(lot);
        let (code, stdout, stderr) =
            run(folder.path(), &["compare-lot", "study.toml", "lot.csv", "--html", "page.html"]);
        assert!(code == 2 && stdout.is_empty() && !folder.path().join("page.html").exists(), "{lot}: {stderr}");
        stderr
    };
    let says = |lot: &str, words: &[&str]| {
        let told = refused(lot);
        assert!(words.iter().all(|words| told.contains(words)), "{told}");
    };
    says("depht\n1\n2\n3\n4\n5\n", &["no column bears the name", "did you mean `depth` by `depht`?"]);
    says("depth;ring\n42,01;2\n42,02;2\n42,0x;2\n", &["line 4", "`42,0x` is not a number"]);
    says("depth\n42,01\n42,02\n", &["line 2 has 2 cells, and the header 1", "semicolons"]);
    says("depth;ring;depth\n1;2;3\n", &["the column `depth` stands twice"]);
    says("depth [kg]\n42\n", &["in kg, and the study has mm"]);
    says("depth\n42.01\n42.02\n", &["2 measured values", "at least 5"]);
    says("depth\n42\n42\n42\n42\n42\n", &["all measured values of `depth` are 42 in lot.csv", "more digits"]);
    says("depth\n42.01\n", &["`depth` has 1 measured value in lot.csv", "leave the column out"]);
    says("depth\n42.01\n1e300\n-1e300\n42.02\n42.03\n", &["`depth` in lot.csv go from -1", "too far apart"]);
    says("time;depth\n6 am;42.01\n", &["`6 am` is not a time", "06:30"]);
    says("time;depth\n25:71;42.01\n", &["`25:71` is not a time", "28.11.2026 06:30"]);
    says("date;depth\n2026-02-31;42.01\n", &["`2026-02-31` is not a time"]);
    says("time;depth\n06:30;42.01\n28.11.2026 06:30;42.02\n", &["line 3", "all without one"]);
    says("depth\n", &["a first row with the names of the columns"]);
}

/// Lots of the same parts belong in one table, and the error says how.
#[test]
fn two_tables_of_the_same_parts_are_named() {
    let folder = folder("depth\n42.01\n42.02\n42.03\n42.02\n42.00\n");
    std::fs::copy(folder.path().join("lot.csv"), folder.path().join("next.csv")).unwrap();
    let (code, _, stderr) = run(folder.path(), &["compare-lot", "study.toml", "lot.csv", "next.csv"]);
    assert_eq!(code, 2);
    let words = ["`depth` is measured in two columns, in lot.csv and next.csv", "a column `lot`"];
    assert!(words.iter().all(|words| stderr.contains(words)), "{stderr}");
}
