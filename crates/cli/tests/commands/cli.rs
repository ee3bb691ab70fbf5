//! The command line: output to the letter, exit codes, files, pipes and wrong input.

pub use std::collections::BTreeSet;
use std::path::Path;
use std::process::Stdio;

use super::command::{ENGINE, rounded, run, sensitol};
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol_report::text;
use sensitol_report::{About, Report, SimulationReport};
use sensitol_report::{Detail, Style};
use sensitol_testing::repository;

#[test]
fn analyze_prints_the_report() {
    insta::assert_snapshot!("analyze-engine", run(&["analyze", ENGINE]));
    insta::assert_snapshot!(
        "analyze-one",
        run(&["analyze", ENGINE, "--kc", "M", "--method", "rss", "--color", "never"])
    );
    insta::assert_snapshot!(
        "analyze-all",
        run(&["analyze", "examples/stacked-blocks/study.toml", "-v", "--sensitivities", "all"])
    );
}

/// The whole output except the times, which differ between runs.
#[test]
fn analyze_prints_json() {
    let output =
        sensitol(&["analyze", "examples/shaft-and-bore/study.toml", "--json", "--seed", "5"]).output().unwrap();
    let mut report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["wall_s"].as_f64().unwrap() > 0.0);
    report["wall_s"] = 0.0.into();
    report["in_model_s"] = 0.0.into();
    rounded(&mut report);
    insta::assert_json_snapshot!("analyze-json", report);
}

#[test]
fn plan_says_what_would_be_evaluated() {
    insta::assert_snapshot!("plan-six-n", run(&["plan", ENGINE]));
    insta::assert_snapshot!("plan-full", run(&["plan", "examples/shaft-and-bore/study.toml", "-m", "full", "--json"]));
    insta::assert_snapshot!("plan-auto", run(&["plan", ENGINE, "-m", "auto"]));
    insta::assert_snapshot!("analyze-auto", run(&["analyze", "examples/stacked-blocks/study.toml", "-m", "auto"]));
    insta::assert_snapshot!("plan-dimension-reduction", run(&["plan", ENGINE, "-m", "dimension-reduction"]));
    insta::assert_snapshot!("plan-response-surface", run(&["plan", ENGINE, "-m", "response-surface"]));
    let matched = "examples/matched-pair/study.toml";
    insta::assert_snapshot!("plan-bivariate", run(&["plan", matched, "-m", "bivariate-dimension-reduction"]));
    insta::assert_snapshot!("check", run(&["check", "examples/stacked-blocks/study.toml"]));
    insta::assert_snapshot!("models", run(&["models"]) + &run(&["models", "engine-balance"]));
}

/// Reports of the alternatives to derivatives, with their gaps.
#[test]
fn alternatives_are_reported() {
    let clearance = "examples/shaft-and-bore/study.toml";
    for method in ["dimension-reduction", "bivariate-dimension-reduction", "three-point", "response-surface"] {
        insta::assert_snapshot!(format!("analyze-{method}"), run(&["analyze", clearance, "-m", method]));
    }
}

/// The search of the extremes is counted, its points depend on the answers, and the report names the places of the extremes.
#[test]
fn extremes_are_reported() {
    let thermal = "examples/thermal-clearance/study.toml";
    let output = sensitol(&["analyze", thermal, "--extremes", "--json"]).output().unwrap();
    assert!(output.stderr.is_empty());
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut worst_case = report["characteristics"][0]["worst_case"].clone();
    rounded(&mut worst_case);
    insta::assert_json_snapshot!("extremes-json", worst_case);
    insta::assert_snapshot!(
        "extremes-not-proven",
        run(&["analyze", ENGINE, "--extremes", "--method", "rss", "--kc", "F"])
    );

    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let text = std::fs::read_to_string(repository(thermal)).unwrap() + "extremes = true\n";
    std::fs::write(&study, text).unwrap();
    let plan = run(&["plan", study.to_str().unwrap()]);
    assert!(plan.contains("then the search of the extremes"), "{plan}");
    let searched = run(&["analyze", study.to_str().unwrap()]);
    assert!(searched.contains("  extremes  0.040856 .. 0.408908  proven, "), "{searched}");
}

/// Wrong input gives one error with fault, place and remedy, nothing on stdout, and exit code 2.
#[test]
fn wrong_input() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(
        &study,
        "[dimensions]\na = { nominal = 1, tolerance = -0.1 }\n[characteristics]\ny = { formula = \"a\" }\n",
    )
    .unwrap();
    let study = study.to_str().unwrap();
    let commands: &[&[&str]] = &[
        &[],
        &["analyse", ENGINE],
        &["analyze"],
        &["analyze", "nowhere.toml"],
        &["analyze", "examples/engine-balance"],
        &["analyze", "README.md"],
        &["analyze", study],
        &["check", study],
        &["plan", study],
        &["analyze", ENGINE, "--method", "seven-n"],
        &["analyze", ENGINE, "--kc", "f"],
        &["analyze", ENGINE, "--budget", "20"],
        &["analyze", ENGINE, "--budget", "-1"],
        &["analyze", ENGINE, "--budget", "2.5"],
        &["help", "analize"],
        &["check", "examples/engine-balance/study"],
        &["analyze", ENGINE, "--step", "0"],
        &["analyze", ENGINE, "--step", "nan"],
        &["analyze", ENGINE, "--accuracy", "much"],
        &["analyze", ENGINE, "--accuracy", "0"],
        &["analyze", ENGINE, "--method", "auto", "--budget", "18"],
        &["analyze", ENGINE, "--method", "auto", "--pairs", "adjacent"],
        &["analyze", ENGINE, "--threads", "0"],
        &["analyze", ENGINE, "--pairs", "R"],
        &["analyze", ENGINE, "--pairs", "R:Q"],
        &["analyze", ENGINE, "--pairs", "R:`L"],
        &["analyze", ENGINE, "--method", "full", "--pairs", "adjacent"],
        &["analyze", ENGINE, "--stencil", "nine"],
        &["analyze", ENGINE, "--method", "dimension-reduction", "--nodes", "4"],
        &["analyze", ENGINE, "--method", "bivariate-dimension-reduction", "--budget", "10"],
        &["analyze", ENGINE, "--method", "full", "--nodes", "5"],
        &["analyze", ENGINE, "--extremes=all"],
        &["analyze", ENGINE, "--extremes", "--points", "points.csv"],
        &["schema", ENGINE],
        &["schema", "-o", "/nowhere/study.schema.json"],
        &["analyze", ENGINE, "-o", "/nowhere/report.txt"],
        &["analyze", ENGINE, "-o", "examples"],
        &["plan", ENGINE, "--write-points", "/nowhere/points.csv"],
        &["analyze", ENGINE, "--check"],
        &["pearson"],
        &["pearson", "--skewness", "1", "--kurtosis", "three"],
        &["pearson", "--skewness", "1", "--kurtosis", "1.9"],
        &["pearson", "--skewness", "-1", "--kurtosis", "2"],
        &["pearson", "--skewness", "nan", "--kurtosis", "3"],
        &["pearson", "--skewness", "0", "--kurtosis", "1e200"],
        &["pearson", "--skewness", "0", "--kurtosis", "3", "--sigma", "0"],
        &["pearson", "--skewness", "0", "--kurtosis", "3", "--quantile", "0.5,1.5"],
        &["pearson", "--skewness", "0", "--kurtosis", "3", "--cdf", "1;2"],
        &["pearson", "--skewness", "0", "--kurtosis", "3", "-o", "/nowhere/law.txt"],
        &["models", "engine-ballance"],
        &["models", "rocket"],
    ];
    let mut all = String::new();
    for arguments in commands {
        let output = sensitol(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(output.stdout.is_empty(), "{arguments:?}");
        let shown = arguments.join(" ").replace(study, "STUDY");
        let error = String::from_utf8(output.stderr).unwrap().replace(study, "STUDY");
        all += &format!("$ sensitol {shown}\n{error}\n");
    }
    insta::assert_snapshot!("wrong-input", all);
}

/// A probe of the example passes. A probe of a failing model names the fault and exits with 1.
#[test]
fn probe_answers_by_the_exit_code() {
    let output = sensitol(&["probe", "examples/external-python/study.toml", "--json"]).output().unwrap();
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // 2N + 55 with eight dimensions.
    assert_eq!((output.status.code(), &report["passed"], &report["evaluations"]), (Some(0), &true.into(), &71.into()));
    assert_eq!((&report["adapter"]["name"], &report["adapter"]["window"]), (&"gap".into(), &64.into()));
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(
        &study,
        "[dimensions]\na = { nominal = 1, tolerance = 0.3 }\n[characteristics]\ny = { formula = \"0*a\" }",
    )
    .unwrap();
    let output = sensitol(&["probe", study.to_str().unwrap()]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.code() == Some(1) && text.contains("FAIL  every characteristic reacts"), "{text}");
}

#[test]
fn pearson_is_a_calculator() {
    let exponential = ["pearson", "--skewness", "2", "--kurtosis", "9"];
    let asked = |more: &[&str]| run(&[&exponential[..], more].concat());
    insta::assert_snapshot!(
        "pearson-law",
        asked(&[]) + &asked(&["--color", "never", "--mean", "-3", "--sigma", "0.5"])
    );
    insta::assert_snapshot!("pearson-infinite", run(&["pearson", "--skewness", "-0.5", "--kurtosis", "4"]));
    let asked = ["--mean", "1", "--sf", "0,3", "--cdf", "-1,1e-3", "--upper-quantile", "1e-9,0", "--json"];
    let output = sensitol(&[&exponential[..], &asked[..]].concat()).output().unwrap();
    let answers: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    // Answers in the order of the options; the exponential distribution by hand.
    let [sf, cdf, quantile] = ["sf", "cdf", "upper_quantile"].map(|name| answers[name].as_array().unwrap().clone());
    let close = |found: &serde_json::Value, expected: f64| (found.as_f64().unwrap() / expected - 1.0).abs() < 1e-13;
    assert!(sf[0] == 1.0 && close(&sf[1], (-3.0f64).exp()));
    assert!(cdf[0] == 0.0 && close(&cdf[1], -(-1e-3f64).exp_m1()));
    assert!(close(&quantile[0], 1e9f64.ln()) && quantile[1].is_null(), "infinite is null");
    assert_eq!((answers["type"].as_str(), &answers["support"]), (Some("III"), &serde_json::json!([0.0, null])));
}

/// `--check` exits with 0 if every target is met and with 1 if one is missed. The report is printed in both cases.
#[test]
fn check_answers_by_the_exit_code() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let code = |target: &str, more: &[&str]| {
        let text = format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.3 }}\n[characteristics]\ny = {{ formula = \"a\", lower = 0.7 {target} }}\nz = {{ formula = \"2*a\" }}"
        );
        std::fs::write(&study, text).unwrap();
        let output = sensitol(&[&["analyze", study.to_str().unwrap(), "--check"], more].concat()).output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
    };
    // Three sigma: 99.865 %.
    assert_eq!(code(", target_yield = 0.998", &[]).0, 0);
    let (missed, report) = code(", target_yield = 0.999", &[]);
    assert_eq!(missed, 1);
    assert!(report.contains("99.865 %   MISSED") && report.contains("target 99.9 %: MISSED"), "{report}");
    let (missed, report) = code(", target_yield = 0.999", &["--json"]);
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    assert_eq!((missed, &report["characteristics"][0]["met"]), (1, &false.into()));
    // Nothing to check is an error, even if another characteristic misses its target.
    assert_eq!(code("", &[]).0, 2);
    assert_eq!(code(", target_yield = 0.999", &["--kc", "z"]).0, 2);
}

/// A characteristic without result: the report is printed anyway, and the exit code is 3.
#[test]
fn a_characteristic_without_result() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let text = "[dimensions]\na = { nominal = -1, tolerance = 0.1 }\nb = { nominal = 1, tolerance = 0.1 }\n\
                [characteristics]\nroot = { formula = \"sqrt(a) + b\", upper = 3 }\nsum = { formula = \"a + b\", unit = \"mm\" }\n";
    std::fs::write(&study, text).unwrap();
    insta::assert_snapshot!("no-result", run(&["analyze", study.to_str().unwrap(), "-m", "full"]));
    let json = sensitol(&["analyze", study.to_str().unwrap(), "--json"]).output().unwrap();
    assert_eq!(json.status.code(), Some(3));
    let report: serde_json::Value = serde_json::from_slice(&json.stdout).unwrap();
    let root = &report["characteristics"][0];
    for key in ["nominal", "mean", "sigma", "skewness", "kurtosis", "rss"] {
        assert!(root[key].is_null(), "{key}");
    }
    assert!(root["sensitivities"][0]["first"].is_null() && root["worst_case"]["linear"].is_null());
}

#[test]
fn files_are_written_whole_or_not_at_all() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.json");
    let to = path.to_str().unwrap();
    let output = sensitol(&["analyze", ENGINE, "--json", "-o", to]).output().unwrap();
    assert!(output.status.success() && output.stdout.is_empty());
    let report: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
    assert_eq!(report["evaluations"], 61);
    // A failing command leaves the file unchanged and no other file behind.
    let output = sensitol(&["analyze", ENGINE, "--budget", "3", "-o", to]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(serde_json::from_slice::<serde_json::Value>(&std::fs::read(&path).unwrap()).unwrap(), report);
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    #[cfg(unix)]
    {
        let mode = std::os::unix::fs::PermissionsExt::mode(&std::fs::metadata(&path).unwrap().permissions());
        assert_eq!(mode & 0o444, 0o444 & mode, "as readable as the user's other files");
        assert_ne!(mode & 0o044, 0, "not private");
        // A link stays a link, and its target is new. A device stays a device, and a full one is an error.
        let link = folder.path().join("link.json");
        std::os::unix::fs::symlink(&path, &link).unwrap();
        let output =
            sensitol(&["analyze", ENGINE, "--json", "--method", "rss", "-o", link.to_str().unwrap()]).output().unwrap();
        assert!(output.status.success() && std::fs::symlink_metadata(&link).unwrap().is_symlink());
        let report: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        assert_eq!(report["evaluations"], 21);
        if Path::new("/dev/full").exists() {
            let output = sensitol(&["analyze", ENGINE, "-o", "/dev/full"]).output().unwrap();
            assert_eq!(output.status.code(), Some(2));
            assert!(!std::fs::metadata("/dev/full").unwrap().is_file());
        }
    }
}

/// No option overwrites a file that the command reads, by whatever path, and no two options write the same file. Nothing is evaluated
/// then.
#[test]
fn what_is_read_is_never_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let text = "[dimensions]\na = { measured = \"data.csv\", tolerance = 0.5, nominal = 1 }\nb = { nominal = 2, tolerance = 0.1 }\n\
                [characteristics]\ny = { formula = \"a + b\", lower = 2, target_yield = 0.9 }\n\
                [costs]\nb = { model = \"reciprocal\", b = 1 }\n";
    let data = "d\n0.9\n1.0\n1.1\n1.2\n0.8\n1.05\n";
    let (study, csv) = (at("study.toml"), at("data.csv"));
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    let around = at("sub/../study.toml");
    let mut tries: Vec<(Vec<&str>, &str, &str)> = vec![
        (vec!["analyze", &study, "-o", &study], &study, "the study itself"),
        (vec!["analyze", &study, "-o", &around], &around, "the study itself"),
        (vec!["analyze", &study, "-o", &csv], &csv, "measured data of the study"),
        (vec!["plan", &study, "--write-points", &study], &study, "the study itself"),
        (vec!["plan", &study, "-o", &csv], &csv, "measured data of the study"),
        (vec!["sweep", &study, "--over", "b=1:2:3", "--svg", &study], &study, "the study itself"),
        (vec!["compare", &study, "--svg", &study], &study, "the study itself"),
        (vec!["simulate", &study, "-o", &csv], &csv, "measured data of the study"),
        (vec!["simulate", &study, "--rare", "-o", &study], &study, "the study itself"),
        (vec!["allocate", &study, "--write", &csv], &csv, "measured data of the study"),
        (vec!["probe", &study, "-o", &study], &study, "the study itself"),
    ];
    let link = at("link.html");
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink(&study, &link).unwrap();
        tries.push((vec!["analyze", &study, "--html", &link], &link, "the study itself"));
    }
    std::fs::write(&study, text).unwrap();
    std::fs::write(&csv, data).unwrap();
    let kept = || {
        let read = |path: &str| std::fs::read_to_string(path).unwrap();
        read(&study) == text && read(&csv) == data
    };
    for (arguments, path, what) in tries {
        let output = sensitol(&arguments).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0), "{arguments:?}: {error}");
        assert!(error.contains(&format!("`{path}` is {what}, which would be lost")), "{arguments:?}: {error}");
        assert!(kept(), "{arguments:?}");
    }
    // One file for two reports: neither is written.
    let twice = at("twice");
    for second in [twice.clone(), at("sub/../twice")] {
        let output = sensitol(&["analyze", &study, "-o", &twice, "--html", &second]).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(
            output.status.code() == Some(2) && error.contains(&format!("`{second}` is asked for twice")),
            "{error}"
        );
        assert!(!Path::new(&twice).exists());
    }
    // Tables of --csv are protected files as well.
    std::fs::rename(&csv, at("sweep.csv")).unwrap();
    std::fs::write(&study, text.replace("data.csv", "sweep.csv")).unwrap();
    let here = folder.path().to_str().unwrap();
    let output = sensitol(&["sweep", &study, "--over", "b=1:2:3", "--csv", here]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert_eq!(std::fs::read_to_string(at("sweep.csv")).unwrap(), data);
}

/// The points of a stage are exact numbers, with a column per dimension.
#[test]
fn points_can_be_written() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("points.csv");
    let output = sensitol(&["plan", ENGINE, "--write-points", path.to_str().unwrap()]).output().unwrap();
    assert!(output.status.success());
    assert!(String::from_utf8(output.stderr).unwrap().contains("first-stage-only"));
    let text = std::fs::read_to_string(&path).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines.len(), lines[0]), (42, "a,R,L,hp,hc,t,phi1,phi2,phi3,phi4"));
    assert_eq!(lines[1], "0.05,0.0425,0.1345,0.0973,0.0372,0,0,3.141592653589793,9.42477796076938,6.283185307179586");
    let moved: f64 = lines[2].split(',').next().unwrap().parse().unwrap();
    assert!((moved - (0.05 - 2.856_970_013_872_806 * 0.0001 / 3.0)).abs() < 1e-16);
}

/// A study with answers from elsewhere has no model: its points are written, and their answers are read.
#[test]
fn points_need_no_model() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let study = |formula: &str| {
        format!(
            "[dimensions]\na = {{ nominal = 1.0, tolerance = 0.3 }}\nb = {{ nominal = 2.0, tolerance = 0.3 }}\n\
             [characteristics]\ny = {{ {formula}lower = 1.5, upper = 2.5 }}\nz = {{ formula = \"2*a\" }}\n"
        )
    };
    std::fs::write(path("open.toml"), study("")).unwrap();
    std::fs::write(path("written.toml"), study("formula = \"a*b\", ")).unwrap();
    let ok = |arguments: &[&str]| {
        let output = sensitol(arguments).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        String::from_utf8(output.stdout).unwrap()
    };
    ok(&["plan", &path("open.toml"), "--method", "full", "--write-points", &path("points.csv")]);
    let points = std::fs::read_to_string(path("points.csv")).unwrap();
    let mut rows = points.lines();
    assert_eq!(rows.next(), Some("a,b"));
    let answers = rows.map(|row| {
        let x: Vec<f64> = row.split(',').map(|cell| cell.parse().unwrap()).collect();
        format!("{row},{}\n", x[0] * x[1])
    });
    std::fs::write(path("answers.csv"), format!("a,b,y\n{}", answers.collect::<String>())).unwrap();
    let result = |arguments: &[&str]| -> Vec<[f64; 2]> {
        let report: serde_json::Value = serde_json::from_str(&ok(arguments)).unwrap();
        let figures = |one: &serde_json::Value| ["mean", "sigma"].map(|figure| one[figure].as_f64().unwrap());
        report["characteristics"].as_array().unwrap().iter().map(figures).collect()
    };
    let full = ["--method", "full", "--json", "--verify", "0"];
    let answered = result(&[&["analyze", &path("open.toml"), "--points", &path("answers.csv")][..], &full].concat());
    // Product of independent inputs: a² s² + b² s² + s⁴.
    let sigma = (0.1_f64.powi(2) * (1.0 + 4.0) + 0.1_f64.powi(4)).sqrt();
    assert!((answered[0][0] - 2.0).abs() < 1e-12 && (answered[0][1] - sigma).abs() < 1e-9, "{answered:?}");
    assert_eq!(answered[1], result(&[&["analyze", &path("written.toml")][..], &full].concat())[1]);
    // Without answers the formula is missing. Answers are an error if no characteristic is open.
    let error = |arguments: &[&str]| String::from_utf8(sensitol(arguments).output().unwrap().stderr).unwrap();
    assert!(error(&["analyze", &path("open.toml")]).contains("`formula` is missing"));
    let nothing = error(&["analyze", &path("written.toml"), "--points", &path("answers.csv")]);
    assert!(nothing.contains("the study has neither"), "{nothing}");
}

#[test]
fn a_closed_pipe_is_no_error() {
    for arguments in [&["analyze", ENGINE, "--json"][..], &["models"], &["plan", ENGINE], &["analyze", "--help"]] {
        let mut child = sensitol(arguments).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.success(), "{arguments:?}: {error}");
        assert!(!error.contains("panic") && !error.contains("pipe"), "{error}");
    }
}

/// Escape sequences go to terminals only, unless they are always on.
#[test]
fn colours_are_for_terminals() {
    let coloured = |arguments: &[&str], set: &[(&str, &str)]| {
        let output = sensitol(arguments).envs(set.iter().copied()).output().unwrap();
        output.stderr.contains(&0x1b)
    };
    let warns = ["analyze", ENGINE];
    assert!(!coloured(&warns, &[]));
    assert!(coloured(&[&warns[..], &["--color", "always"]].concat(), &[]));
    assert!(!coloured(&[&warns[..], &["--color", "never"]].concat(), &[("CLICOLOR_FORCE", "1")]));
    assert!(!coloured(&warns, &[("NO_COLOR", "1")]));
}

/// A name that equals a verdict has no colour: the page differs from that of other names of the same length in the names only.
#[test]
fn names_that_are_verdicts_are_plain() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let shown = |command: &[&str], dimension: &str, characteristic: &str| {
        let text = format!(
            "[dimensions]\n{dimension} = {{ nominal = 1, tolerance = 0.3 }}\nother = {{ nominal = 2, tolerance = 0.1 }}\n\
             [characteristics]\n{characteristic} = {{ formula = \"{dimension} + other\", lower = 2.7, target_yield = 0.9 }}\n\
             [costs]\n{dimension} = {{ model = \"reciprocal\", b = 1 }}\n"
        );
        std::fs::write(&study, text).unwrap();
        let (study, [name, rest @ ..]) = (study.to_str().unwrap(), command) else {
            unreachable!("a command has a name")
        };
        let over = format!("{dimension}=0.9:1.1:3");
        let rest: Vec<&str> = rest.iter().map(|&word| if word == "OVER" { &over } else { word }).collect();
        let arguments = [&[*name, study, "--color", "always", "-v"][..], &rest].concat();
        String::from_utf8(sensitol(&arguments).output().unwrap().stdout).unwrap()
    };
    let commands: [&[&str]; 6] = [
        &["analyze"],
        &["analyze", "--stack", "text"],
        &["simulate", "--samples", "1000"],
        &["simulate", "--rare"],
        &["sweep", "--over", "OVER"],
        &["allocate"],
    ];
    let mut coloured = 0;
    for (dimension, characteristic) in [("met", "MISSED"), ("optimal", "met"), ("infeasible", "inconclusive")] {
        let plain = |name: &str, letter: &str| letter.repeat(name.len());
        let [a, b] = [plain(dimension, "q"), plain(characteristic, "Q")];
        for command in commands {
            let named = shown(command, dimension, characteristic);
            let other = shown(command, &a, &b);
            coloured += other.matches('\u{1b}').count();
            assert!(named.contains(characteristic), "{command:?}: {named}");
            assert_eq!(named, other.replace(&a, dimension).replace(&b, characteristic), "{command:?}");
        }
    }
    assert!(coloured > 0, "verdicts are coloured all the same");
}

/// Verdicts have a colour on a terminal and with `--color always`, never in a file or a pipe otherwise.
#[test]
fn verdicts_are_coloured() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let text = |target: f64| {
        format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 0.3 }}\n[characteristics]\n\
             y = {{ formula = \"a\", lower = 0.7, target_yield = {target} }}\n[costs]\na = {{ model = \"reciprocal\", b = 1 }}\n"
        )
    };
    let study = |target: f64| {
        std::fs::write(&study, text(target)).unwrap();
        study.to_str().unwrap().to_owned()
    };
    let stdout = |arguments: &[&str]| String::from_utf8(sensitol(arguments).output().unwrap().stdout).unwrap();
    let always = |command: &str, target: f64| stdout(&[command, &study(target), "--color", "always"]);
    let (red, green, yellow) = ("\u{1b}[1;31mMISSED\u{1b}[0m", "\u{1b}[32mmet\u{1b}[0m", "\u{1b}[33m");
    assert!(always("analyze", 0.9999).contains(&format!("%: {red}")));
    assert!(always("analyze", 0.99).contains(&format!("%: {green}")));
    assert!(always("simulate", 0.9999).contains(red) && always("simulate", 0.99).contains(green));
    // 99.865 % of the assemblies: a hundred points cannot decide if 99 % are reached.
    let few = stdout(&["simulate", &study(0.99), "--samples", "100", "--color", "always"]);
    assert!(few.contains(&format!("{yellow}inconclusive")), "{few}");
    assert!(always("allocate", 0.99).starts_with("\u{1b}[32moptimal\u{1b}[0m: cost"));
    // Colours are the only addition.
    let plain = stdout(&["analyze", &study(0.9999)]);
    assert!(!plain.contains('\u{1b}'));
    let bare = |text: String| {
        ["\u{1b}[1;31m", "\u{1b}[32m", "\u{1b}[33m", "\u{1b}[0m"].iter().fold(text, |text, code| text.replace(code, ""))
    };
    assert_eq!(bare(always("analyze", 0.9999)), plain);
    for command in ["analyze", "simulate", "allocate"] {
        let json = stdout(&[command, &study(0.99), "--json", "--color", "always"]);
        assert!(!json.contains('\u{1b}'), "{command}");
    }
}

/// Counts may have exponents, and parts may be in percent.
#[test]
fn numbers_may_be_written_short() {
    let json = |arguments: &[&str]| -> serde_json::Value {
        serde_json::from_slice(&sensitol(arguments).output().unwrap().stdout).unwrap()
    };
    assert_eq!(json(&["simulate", ENGINE, "--samples", "1e3", "--json"])["samples"], 1000);
    let percent = json(&["analyze", ENGINE, "-m", "auto", "--accuracy", "1%", "--budget", "1e3", "--json"]);
    let share = json(&["analyze", ENGINE, "-m", "auto", "--accuracy", "0.01", "--budget", "1000", "--json"]);
    assert_eq!(
        (&percent["evaluations"], &percent["characteristics"]),
        (&share["evaluations"], &share["characteristics"])
    );
}

/// Help that cannot be printed is an error, like any other result.
#[test]
#[cfg(target_os = "linux")]
fn help_into_a_full_device_is_an_error() {
    for arguments in [&["help"][..], &["--help"], &["--version"], &["analyze", "--help"]] {
        let full = std::fs::OpenOptions::new().write(true).open("/dev/full").unwrap();
        let output = sensitol(arguments).stdout(full).output().unwrap();
        let error = String::from_utf8(output.stderr).unwrap();
        assert!(output.status.code() == Some(2) && error.contains("cannot write to standard output"), "{error}");
    }
}

/// `--color never` and a locale without UTF-8 get plain ASCII.
#[test]
fn plain_terminals_get_ascii() {
    let stdout = |locale: &str, color: &str| {
        sensitol(&["analyze", "examples/quick-return-published/study.toml", "--color", color])
            .env("LC_ALL", locale)
            .output()
            .unwrap()
            .stdout
    };
    assert!(stdout("C", "auto").is_ascii());
    assert!(stdout("C.UTF-8", "never").is_ascii());
    assert!(!stdout("C.UTF-8", "auto").is_ascii());
}

#[test]
fn no_line_is_too_long() {
    for path in ["engine-balance/study.toml", "quick-return-published/study.toml", "stacked-blocks/study.toml"] {
        for extra in [&[][..], &["-v"], &["-v", "--method", "full"]] {
            let study = format!("examples/{path}");
            let output = sensitol(&[&["analyze", &study][..], extra].concat()).output().unwrap();
            for line in String::from_utf8(output.stdout).unwrap().lines() {
                assert!(line.chars().count() <= 100, "{} columns: {line}", line.chars().count());
            }
        }
    }
}

/// Thirty dimensions fit on a page: the contributions in order, the rest as a sum.
#[test]
fn many_dimensions_stay_readable() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let dimensions: String = (0..40)
        .map(|i| format!("part_{i} = {{ nominal = {i}, tolerance = {} }}\n", 1.0 / (1.0 + f64::from(i))))
        .collect();
    let sum = (0..40).map(|i| format!("part_{i}")).collect::<Vec<_>>().join(" + ");
    std::fs::write(&study, format!("[dimensions]\n{dimensions}[characteristics]\nstack = {{ formula = \"{sum}\" }}\n"))
        .unwrap();
    let report = run(&["analyze", study.to_str().unwrap(), "-q"]);
    // Of the sum of 1/k^2 to 40, the terms from 7 on make 7.95 %.
    assert!(report.contains("  and 34 more with 7.95 % together; -v shows all"), "{report}");
    let rows: Vec<&str> = report.lines().filter(|line| line.starts_with("  part_")).collect();
    assert_eq!((rows.len(), rows[0].split_whitespace().next()), (6, Some("part_0")));
    let all = run(&["analyze", study.to_str().unwrap(), "-q", "-v"]);
    // Columns without room stand in a second table.
    assert_eq!(all.lines().filter(|line| line.starts_with("  part_")).count(), 80);
}

/// Names from a file cannot forge lines or move the cursor.
#[test]
fn names_cannot_disturb_the_terminal() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let text = "title = \"one\\ntwo\"\n[dimensions]\na = { nominal = 1, tolerance = 0.1, unit = \"m\\nm\\u001b[2J\" }\n\
                [characteristics]\ny = { formula = \"a\", unit = \"\\r\" }\n";
    std::fs::write(&study, text).unwrap();
    let output = sensitol(&["analyze", study.to_str().unwrap()]).output().unwrap();
    assert!(output.status.success());
    let printed = String::from_utf8([output.stdout, output.stderr].concat()).unwrap();
    assert!(!printed.contains('\u{1b}') && !printed.contains('\r') && !printed.contains("one\ntwo"), "{printed:?}");
}

/// `--time` ends a longer analysis with the results so far.
#[test]
fn time_is_kept() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let dimensions: String = (0..600).map(|i| format!("x{i} = {{ nominal = 1, tolerance = 0.1 }}\n")).collect();
    let formula = (0..600).map(|i| format!("sin(x{i})")).collect::<Vec<_>>().join("*");
    std::fs::write(&study, format!("[dimensions]\n{dimensions}[characteristics]\ny = {{ formula = \"{formula}\" }}\n"))
        .unwrap();
    let output =
        sensitol(&["analyze", study.to_str().unwrap(), "-m", "full", "--time", "0.001", "--json"]).output().unwrap();
    assert_eq!(output.status.code(), Some(3));
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert!(report["evaluations"].as_u64().unwrap() < 360_601);
    assert!(String::from_utf8(output.stderr).unwrap().contains("The time limit of 0.001 s ended the run after "));
}

#[test]
fn the_number_of_threads_does_not_show() {
    let of = |threads: &str| {
        sensitol(&["analyze", ENGINE, "--method", "full", "--threads", threads]).output().unwrap().stdout
    };
    assert_eq!(of("1"), of("3"));
}

#[test]
fn studies_run_from_any_folder() {
    let absolute = repository(ENGINE);
    let output = sensitol(&["analyze", absolute.to_str().unwrap(), "-q"]).current_dir(Path::new("/")).output().unwrap();
    assert!(output.status.success() && output.stderr.is_empty());
}

/// On a narrow terminal a report takes more lines with the same content: no line is too wide, and no number is lost.
#[test]
fn reports_fit_their_width() {
    for name in ["stacked-blocks", "engine-balance", "first-study"] {
        let study = sensitol_study::Study::read(&repository(&format!("examples/{name}/study.toml"))).unwrap();
        let analysis = sensitol::analyze(&study.problem, &study.options).unwrap();
        let report = Report::of(&study.problem, &analysis, About::default());
        let of =
            |width: usize| text(&report.document(), Style { detail: Detail::Full, unicode: true, color: false, width });
        let numbers = |text: &str| -> BTreeSet<String> {
            let words = text.split(|c: char| c.is_whitespace() || ",;:()".contains(c));
            words.filter(|word| word.parse::<f64>().is_ok()).map(str::to_owned).collect()
        };
        let usual = numbers(&of(Style::WIDTH));
        assert!(usual.len() > 20, "{name}: {usual:?}");
        for width in [60, 72, 80, 120] {
            let text = of(width);
            let wide = text.lines().map(|line| line.chars().count()).max().unwrap();
            assert!(wide <= width, "{name}: {wide} columns of {width}\n{text}");
            assert_eq!(numbers(&text), usual, "{name} at {width}");
        }
    }
}

/// Splits a line of a table into cells at two spaces or more.
fn cells(line: &str) -> Vec<&str> {
    line.split("  ").map(str::trim).filter(|cell| !cell.is_empty()).collect()
}

/// Numbers with many digits or with exponents: at every width, a value stands to the right of its own whole label, as on a wide
/// terminal.
#[test]
fn values_stand_beside_their_labels_at_every_width() {
    let study = sensitol_study::Study::read(&repository("tests/data/any-size/wide-numbers.toml")).unwrap();
    let analysis = sensitol::analyze(&study.problem, &study.options).unwrap();
    let sample = SimulationOptions::default().with_samples(2000);
    let simulation = simulate(&study.problem, &sample).unwrap();
    let documents = [
        Report::of(&study.problem, &analysis, About::default()).document(),
        SimulationReport::of(&study.problem, &simulation, About::default()).document(),
    ];
    let labels: [&[&str]; 2] = [
        &["± 3 sigma", "RSS", "inflated RSS", "mean-shift RSS", "nominal", "mean", "shift", "sigma", "skewness"],
        &["0.135 %", "1 %", "5 %", "median", "95 %", "99 %", "99.865 %", "mean", "sigma", "skewness", "kurtosis"],
    ];
    for (document, labels) in documents.iter().zip(labels) {
        let of = |width: usize| text(document, Style { detail: Detail::Short, unicode: true, color: false, width });
        let whole = of(400);
        // The figures, below the name of the characteristic and the contributors, whose titles have a sigma too.
        let of_diff = whole.split("\ndiff").nth(1).unwrap();
        let figures = &of_diff[of_diff.find("\n  nominal ").or_else(|| of_diff.find("\n  mean ")).unwrap()..];
        let value = |label: &str| {
            let at = |line: &&str| cells(line).iter().position(|cell| *cell == label).is_some();
            let line = figures.lines().find(at).unwrap_or_else(|| panic!("{label} in {whole}"));
            let cells = cells(line);
            cells[cells.iter().position(|cell| *cell == label).unwrap() + 1]
        };
        for width in 40..200 {
            let page = of(width);
            let page = page.split("\ndiff").nth(1).unwrap();
            for &label in labels {
                let stands = |line: &str| cells(line).windows(2).any(|two| two[0] == label && two[1] == value(label));
                assert!(page.lines().any(stands), "{label} {} at {width}:\n{page}", value(label));
            }
        }
    }
}
