//! Peak memory of a run, as the kernel counts it: `tests/children/peak.py`.

use std::path::Path;
use std::process::Command;

use sensitol::Method;
use sensitol_testing::repository;

/// Greatest peak memory, in kilobytes: 200 MB, of which the program itself takes some 20 in a test build.
const ENOUGH: u64 = 200_000;
/// Dimensions of the largest study that is promised to work.
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

/// Returns the exit code and the peak memory in kilobytes.
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

/// A method that would need more than a million points is refused before any of them exists.
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
    // 3^n points, 16 for every pair, and the corners of a response surface. For the other methods `plan` prints the cost.
    assert_eq!(refused, ["bivariate-dimension-reduction", "three-point", "response-surface"]);
}

/// `--budget` lifts the limit, and the plan still takes little memory.
#[test]
fn a_plan_above_the_limit_is_small_too() {
    let folder = tempfile::tempdir().unwrap();
    let path = study(folder.path());
    for method in ["full", "classic"] {
        let (code, kilobytes) = peak(&["plan", &path, "--method", method, "--budget", "10000000"]);
        assert!(code == 0 && kilobytes < ENOUGH, "{method}: exit {code}, {kilobytes} kB");
    }
}
