//! The most memory that a run holds. The kernel counts it: `tests/children/peak.py`.

use std::path::Path;
use std::process::Command;

use sensitol::Method;
use sensitol_testing::repository;

/// In kilobytes: 200 MB, of which the program itself takes some 20 in a test build.
const ENOUGH: u64 = 200_000;
/// Dimensions of a study as large as is promised.
const MANY: usize = 1000;

/// A study of many dimensions whose characteristic has every interaction.
fn study(folder: &Path) -> String {
    let dimensions: String = (0..MANY).map(|d| format!("d{d} = {{ nominal = 1, tolerance = 0.1 }}\n")).collect();
    let sum = (0..MANY).map(|d| format!("d{d}")).collect::<Vec<_>>().join(" + ");
    let path = folder.join("study.toml");
    let text = format!("[dimensions]\n{dimensions}[characteristics]\ny = {{ formula = \"({sum})^3\", lower = 0 }}\n");
    std::fs::write(&path, text).unwrap();
    path.display().to_string()
}

/// Exit code and peak in kilobytes.
fn peak(arguments: &[&str]) -> (i32, u64) {
    let output = Command::new("python3")
        .arg(repository("tests/children/peak.py"))
        .arg(assert_cmd::cargo::cargo_bin!("sensitol"))
        .args(arguments)
        .output()
        .unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    let (code, kilobytes) = text.trim().split_once(' ').unwrap_or_else(|| panic!("{text}{:?}", output.stderr));
    (code.parse().unwrap(), kilobytes.parse().unwrap())
}

/// A method that would evaluate more than a million points says so before it has made any of them.
#[test]
fn a_plan_of_a_thousand_dimensions_is_small() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path());
    let mut refused = Vec::new();
    for method in Method::ALL {
        let (code, kilobytes) = peak(&["plan", &path, "--method", method.name()]);
        assert!(kilobytes < ENOUGH, "{method}: {kilobytes} kB");
        match code {
            0 => {}
            2 => refused.push(method.name()),
            _ => panic!("{method}: exit {code}"),
        }
    }
    // 3^n points, 16 for every pair, and the corners of a response surface. Of the others `plan` says what they would cost.
    assert_eq!(refused, ["bivariate-dimension-reduction", "three-point", "response-surface"]);
}

/// `--budget` lifts the limit, and the plan stays small.
#[test]
fn a_plan_above_the_limit_is_small_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path());
    for method in ["full", "classic"] {
        let (code, kilobytes) = peak(&["plan", &path, "--method", method, "--budget", "10000000"]);
        assert!(code == 0 && kilobytes < ENOUGH, "{method}: exit {code}, {kilobytes} kB");
    }
}
