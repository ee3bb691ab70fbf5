//! Likely mistakes get the right word, on the command line and in studies.

use super::command::sensitol;

fn refused(arguments: &[&str]) -> String {
    let output = sensitol(arguments).args(["--color", "never"]).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?}: {error}");
    error
}

#[test]
fn options_name_the_right_one() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let study = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ng = { formula = \"a\" }\n";
    std::fs::write(at("gap.toml"), study).unwrap();
    std::fs::write(at("stack.csv"), "name,nominal,tol\na,1,0.1\n").unwrap();
    for (arguments, words) in [
        (vec!["analyze", &at("gap.toml"), "-m", "monte-carlo"], "`sensitol simulate STUDY`"),
        (vec!["analyze", &at("gap.toml"), "--gum", "text"], "write --gum=text"),
        (vec!["analyze", &at("gap.toml"), "--xlsx", &at("report.xls")], "written as .xlsx"),
        (vec!["simulate", &at("stack.csv")], "`sensitol import`"),
    ] {
        let error = refused(&arguments);
        assert!(error.contains(words), "{arguments:?}: {error}");
    }
}

#[test]
fn studies_name_the_right_key_and_value() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gap.toml").to_str().unwrap().to_owned();
    for (dimension, characteristic, words) in [
        ("tolerance = 0.1", "formula = \"a\", LSL = 0.9", "the lower limit is `lower`"),
        ("tolerance = 0.1", "formula = \"a\", USL = 0.9", "the upper limit is `upper`"),
        ("tolerance = 0.1", "formula = \"a\", min = 0.9", "the lower limit is `lower`"),
        ("tolerance = 0.1", "formula = \"a\", max = 0.9", "the upper limit is `upper`"),
        ("min = 0.9, max = 1.1", "formula = \"a\"", "write limits = [lower, upper]"),
        ("tolerance = \"±0.01\"", "formula = \"a\"", "write 0.01, without quotes"),
        ("tolerance = \"0.01\"", "formula = \"a\"", "write 0.01, without quotes"),
        ("tolerance = \"H7\"", "formula = \"a\"", "write fit = \"H7\" in place of the tolerance"),
        ("tolerance = 0.1, distribution = \"gauss\"", "formula = \"a\"", "write \"normal\""),
        ("tolerance = 0.1, distribution = \"gaussian\"", "formula = \"a\"", "write \"normal\""),
        ("tolerance = 0.1, distribution = \"Normal\"", "formula = \"a\"", "did you mean `normal`?"),
        ("tolerance = 0.1", "formula = \"=a\"", "leave out the `=`"),
        ("tolerance = 0.1, sigma = 0.02, distribution = \"truncated-normal\"", "formula = \"a\"", "write sigmas"),
    ] {
        let study = format!(
            "[dimensions]\na = {{ nominal = 1, {dimension} }}\n[characteristics]\ng = {{ {characteristic} }}\n"
        );
        std::fs::write(&path, &study).unwrap();
        let error = refused(&["check", &path]);
        assert!(error.contains(words), "{study}: {error}");
    }
}
