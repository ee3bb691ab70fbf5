//! `allocate` on the command line, `[costs]` and `require` in studies, and rewritten studies.

use std::path::Path;

use serde_json::Value;

use super::command::{run, sensitol};
use sensitol_testing::{relative, repository};

const SHAFT: &str = "examples/shaft-and-housing/study.toml";
const WORST: &str = "examples/shaft-and-housing/worst-case.toml";
const ENGINE: &str = "examples/engine-balance/allocate.toml";
const BLOCKS: &str = "examples/stacked-blocks/allocate.toml";

fn json(arguments: &[&str]) -> Value {
    let output = sensitol(arguments).output().unwrap();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

fn at(folder: &tempfile::TempDir, name: &str) -> String {
    folder.path().join(name).to_str().unwrap().to_owned()
}

#[test]
fn an_allocation_prints_what_it_came_to() {
    insta::assert_snapshot!("allocate", run(&["allocate", WORST, "--color", "never"]));
    insta::assert_snapshot!("allocate-front", run(&["allocate", ENGINE, "--front", "5", "--threads", "1"]));
}

#[test]
fn an_allocation_prints_json_tables_and_a_chart() {
    let folder = tempfile::tempdir().unwrap();
    let (csv, svg) = (at(&folder, "tables"), at(&folder, "front.svg"));
    let report = json(&["allocate", ENGINE, "--json", "--front", "7", "--csv", &csv, "--svg", &svg]);
    assert_eq!((&report["command"], &report["status"]), (&"allocate".into(), &"local-optimum".into()));
    assert_eq!((&report["schema"], &report["confirmed"]), (&2.into(), &true.into()));
    assert_eq!(report["tolerances"].as_array().unwrap().len(), 10);
    for key in ["dimension", "before", "after", "cost_before", "cost_after", "process"] {
        assert!(report["tolerances"][0].get(key).is_some(), "{key}");
    }
    let cost = |key: &str| report[key].as_f64().unwrap();
    let sum = |key: &str| {
        let all = report["tolerances"].as_array().unwrap().iter();
        all.map(|one| one[key].as_f64().unwrap()).sum::<f64>()
    };
    relative(cost("cost_before"), sum("cost_before"), 1e-12);
    relative(cost("cost_after"), sum("cost_after"), 1e-12);
    assert!(cost("cost_after") < cost("cost_before"));
    assert!(report["proof"]["kkt_residual"].as_f64().unwrap() < 1e-7);
    assert!(report["characteristics"][0]["before"]["sigma"].is_f64());
    assert!(report["characteristics"][0]["after"]["yield"].as_f64().unwrap() >= 0.9973);
    assert!(report["attainable"].is_null());
    assert_eq!(report["confirmation"]["samples"], 100_000);
    assert!(report["joint_yield"]["after"]["standard_error"].is_f64());
    let read = |name: &str| std::fs::read_to_string(folder.path().join("tables").join(name)).unwrap();
    assert_eq!(read("tolerances.csv").lines().count(), 11);
    assert_eq!(read("requirements.csv").lines().count(), 3);
    assert_eq!(read("front.csv").lines().count(), 1 + 7 * 2 * 10);
    let chart = std::fs::read_to_string(svg).unwrap();
    assert!(chart.starts_with("<svg") && chart.trim_end().ends_with("</svg>"));
    // Seven points of the front and the present tolerances.
    assert_eq!(chart.matches("<circle").count(), 8);
}

/// Only the tolerances change. The rewritten study gives the same result, with the requirement met.
#[test]
fn a_study_written_anew_is_the_same_but_for_its_tolerances() {
    let folder = tempfile::tempdir().unwrap();
    for (study, path) in [(SHAFT, "shaft.toml"), (ENGINE, "engine.toml"), (BLOCKS, "blocks.toml")] {
        let written = at(&folder, path);
        let first = json(&["allocate", study, "--json", "--write", &written]);
        let (old, new) =
            (std::fs::read_to_string(repository(study)).unwrap(), std::fs::read_to_string(&written).unwrap());
        assert_eq!(old.lines().count(), new.lines().count());
        let skeleton = |text: &str| -> String {
            let line = |line: &str| match line.split_once("tolerance = ") {
                Some((before, after)) if !line.contains("processes") => {
                    let rest = after.trim_start_matches(|c: char| c.is_ascii_digit() || ".e-".contains(c));
                    format!("{before}tolerance = {rest}\n")
                }
                _ => format!("{line}\n"),
            };
            text.lines().map(line).collect()
        };
        assert_eq!(skeleton(&old), skeleton(&new));
        let second = json(&["allocate", &written, "--json"]);
        // Tolerances are written with six digits, cut off. The written ones meet the requirement at nearly the same cost.
        assert_eq!(second["requirements"][0]["verdict_before"], "met", "{study}");
        let cost = |report: &Value, key: &str| report[key].as_f64().unwrap();
        relative(cost(&second, "cost_before"), cost(&first, "cost_after"), 1e-5);
        // The error of the yield comes from a sample, which depends on the start of the search.
        relative(cost(&second, "cost_after"), cost(&first, "cost_after"), 1e-4);
    }
}

/// Every form of a tolerance, in both formats: the rewritten study contains the result.
#[test]
fn every_form_of_a_tolerance_is_written_anew() {
    let folder = tempfile::tempdir().unwrap();
    let dimensions = [
        ("plain", "{ nominal = 10, tolerance = 0.1 }", r#"{ "nominal": 10, "tolerance": 0.1 }"#),
        ("sided", "{ nominal = 10, tolerance = [-0.05, 0.15] }", r#"{ "nominal": 10, "tolerance": [-0.05, 0.15] }"#),
        ("above", "{ nominal = 10, tolerance = [0.05, 0.15] }", r#"{ "nominal": 10, "tolerance": [0.05, 0.15] }"#),
        ("limits", "{ limits = [9.9, 10.1] }", r#"{ "limits": [9.9, 10.1] }"#),
        ("percent", "{ nominal = 10, tolerance = \"1 %\" }", r#"{ "nominal": 10, "tolerance": "1 %" }"#),
        ("fit", "{ nominal = 10, fit = \"H7\", unit = \"mm\" }", r#"{ "nominal": 10, "fit": "H7", "unit": "mm" }"#),
        ("hole", "{ nominal = [10, 10], position = 0.2 }", r#"{ "nominal": [10, 10], "position": 0.2 }"#),
        ("spread", "{ nominal = 10, sigma = 0.03 }", r#"{ "nominal": 10, "sigma": 0.03 }"#),
        (
            "leaning",
            "{ nominal = 10, tolerance = 0.1, distribution = { kind = \"triangular\", mode = 10.05 } }",
            r#"{ "nominal": 10, "tolerance": 0.1, "distribution": { "kind": "triangular", "mode": 10.05 } }"#,
        ),
        (
            "both",
            "{ nominal = 10, tolerance = 0.1, sigma = 0.025, sigmas = 4 }",
            r#"{ "nominal": 10, "tolerance": 0.1, "sigma": 0.025, "sigmas": 4 }"#,
        ),
    ];
    for (name, toml, as_json) in dimensions {
        let used = if name == "hole" { "hole_x + hole_y" } else { name };
        let toml = format!(
            "[dimensions] # kept\nother = {{ nominal = 1, tolerance = 0.01 }}\n{name} = {toml} # kept too\n\
             [characteristics]\ny = {{ formula = \"{used}\", require = {{ sigma = 0.011 }} }}\n\
             [costs]\n{name} = {{ model = \"reciprocal\", b = 0.1 }}\n"
        );
        let as_json = format!(
            r#"{{ "dimensions": {{ "{name}": {as_json} }}, "characteristics": {{ "y": {{ "formula": "{used}", "require": {{ "sigma": 0.011 }} }} }},
  "costs": {{ "{name}": {{ "model": "reciprocal", "b": 0.1 }} }} }}"#
        );
        for (text, extension) in [(toml, "toml"), (as_json, "json")] {
            let (study, written) = (at(&folder, &format!("a.{extension}")), at(&folder, &format!("b.{extension}")));
            std::fs::write(&study, &text).unwrap();
            let report = json(&["allocate", &study, "--json", "--write", &written, "--force"]);
            // There is no proof for a shape that changes with its tolerance, or for a mean that moves with it.
            let status = report["status"].as_str().unwrap();
            assert!(["optimal", "local-optimum"].contains(&status), "{name}: {report}");
            let new = std::fs::read_to_string(&written).unwrap();
            let again = sensitol_study::Study::read(Path::new(&written)).unwrap();
            let analysis = sensitol::analyze(&again.problem, &again.options).unwrap();
            let sigma = analysis.characteristics[0].moments.unwrap().sigma();
            // The last digit may differ because of the order of summation.
            assert!(sigma <= 0.011 * (1.0 + 1e-13) && sigma > 0.011 * (1.0 - 2e-5), "{name}: {sigma}\n{new}");
            assert!(extension == "json" || new.contains("# kept\n") && new.contains(" # kept too\n"), "{new}");
            let fits = report["warnings"].as_array().unwrap().iter().filter(|one| one["code"] == "fit-replaced");
            assert_eq!(fits.count(), usize::from(name == "fit"));
        }
    }
}

/// A changed nominal value of a model's input is written as a new entry, and an existing entry is replaced.
#[test]
fn nominal_values_are_written_too() {
    let folder = tempfile::tempdir().unwrap();
    let study = at(&folder, "a.toml");
    let text = "[dimensions]\na = { nominal = 10.0, tolerance = 0.1 } # here\nb = { nominal = 6.0, tolerance = 0.1 }\n\
                [characteristics]\ngap = { formula = \"a - b\", lower = 4.1, upper = 4.5 }\n";
    std::fs::write(&study, text).unwrap();
    let written = at(&folder, "b.toml");
    let output = run(&["allocate", &study, "--recentre", "a", "--write", &written, "--color", "never"]);
    assert!(output.starts_with("exit 0"), "{output}");
    let new = std::fs::read_to_string(&written).unwrap();
    assert!(new.contains("a = { nominal = 10.3000") && new.contains("} # here"), "{new}");
    let engine = at(&folder, "c.toml");
    std::fs::write(
        &engine,
        "[model]\nbuiltin = \"engine-balance\"\n[dimensions]\nR = { tolerance = 0.00004 }\n[characteristics]\n\
         F = { lower = 12590.0, upper = 12610.0 }\n",
    )
    .unwrap();
    let output =
        run(&["allocate", &engine, "--recentre", "R", "--write", &written, "--force", "--method", "second-order"]);
    assert!(output.starts_with("exit 0"), "{output}");
    let new = std::fs::read_to_string(&written).unwrap();
    assert!(new.contains("R = { nominal = 0.04257"), "{new}");
}

#[test]
fn what_cannot_be_kept_is_exit_4_with_a_report() {
    let folder = tempfile::tempdir().unwrap();
    let study = at(&folder, "study.toml");
    let text = std::fs::read_to_string(repository(WORST)).unwrap();
    std::fs::write(&study, text.replace("lower = 0.0049, upper = 0.0349", "lower = 0.012, upper = 0.0278")).unwrap();
    let written = at(&folder, "written.toml");
    let output = sensitol(&["allocate", &study, "--json", "--write", &written]).output().unwrap();
    assert_eq!(output.status.code(), Some(4));
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["status"], "infeasible");
    assert_eq!(report["attainable"]["characteristic"], "gap");
    // Of the 0.0079, dimensions without a cost use 0.0065 and four others at least 0.0005 each.
    relative(report["attainable"]["best"].as_f64().unwrap(), 0.0085 / 0.0079, 1e-9);
    assert!(report["cost_after"].is_null() && report["characteristics"][0]["after"].is_null());
    assert!(!Path::new(&written).exists());
    // The limits are too narrow even without the dimensions that have a cost.
    std::fs::write(&study, text.replace("lower = 0.0049, upper = 0.0349", "lower = 0.014, upper = 0.0258")).unwrap();
    let output = run(&["allocate", &study]);
    assert!(output.starts_with("exit 4"), "{output}");
    assert!(output.contains("dimensions without a cost break it by themselves: `C`, `G`, `A`"), "{output}");
}

fn wrong(text: &str, more: &[&str]) -> String {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    std::fs::write(&study, text).unwrap();
    let study = study.to_str().unwrap();
    let more = more.iter().map(|&argument| if argument == "STUDY" { study } else { argument });
    let arguments: Vec<&str> = ["allocate", study].into_iter().chain(more).collect();
    run(&arguments).replace(folder.path().to_str().unwrap(), "")
}

/// Each mistake gives one clear error, exit code 2, and no other output.
#[test]
fn wrong_costs_and_requirements_are_refused() {
    let study = |dimension: &str, costs: &str, characteristic: &str| {
        format!(
            "[dimensions]\nlength = {{ nominal = 10, {dimension} }}\nwidth = {{ nominal = 5, tolerance = 0.1 }}\n\
             [characteristics]\ngap = {{ formula = \"length - width\", {characteristic} }}\n[costs]\n{costs}\n"
        )
    };
    let limits = "lower = 4.5, upper = 5.5, target_yield = 0.9973";
    let plain = "tolerance = 0.1";
    let good = "length = { model = \"reciprocal\", b = 1 }";
    let cases: [(&str, &str, &str); 27] = [
        (plain, "length = { model = \"reciprocal\", a = -1, b = 1 }", limits),
        (plain, "length = { model = \"reciprocal\", b = -1 }", limits),
        (plain, "length = { model = \"reciprocal-power\", b = 1, k = 0 }", limits),
        (plain, "length = { model = \"reciprocal-power\", b = 1 }", limits),
        (plain, "length = { model = \"exponential\", b = 1, k = 2 }", limits),
        (plain, "length = { model = \"reciprocl\", b = 1 }", limits),
        (plain, "length = { model = \"reciprocal\", b = 1, min = 0.2, max = 0.1 }", limits),
        (plain, "length = { model = \"reciprocal\", b = 1, min = 0 }", limits),
        (plain, "length = { a = 1 }", limits),
        (plain, "length = { model = \"reciprocal\", b = 1, same_as = \"width\" }", limits),
        (plain, "length = { same_as = \"length\" }", limits),
        (plain, "length = { same_as = \"width\" }\nwidth = { same_as = \"length\" }", limits),
        (plain, "length = { same_as = \"width\" }", limits),
        (plain, "lenght = { model = \"reciprocal\", b = 1 }", limits),
        (plain, "length = { processes = [] }", limits),
        (plain, "length = { processes = [{ name = \"saw\", tolerance = 0.1 }] }", limits),
        (
            plain,
            "length = { processes = [{ name = \"saw\", tolerance = 0.1, cost = 5 }, { name = \"mill\", tolerance = 0.05, cost = 4 }] }",
            limits,
        ),
        (plain, "length = { processes = [{ name = \"saw\", tolerance = 0.1, cost = -5 }] }", limits),
        (plain, good, "lower = 4.5, target_yield = 1.0"),
        (plain, good, "lower = 4.5, require = { yield = 1 }"),
        (plain, good, "require = \"rss\""),
        (plain, good, "lower = 4.5, require = \"worst case\""),
        (plain, good, "lower = 4.5, require = { cpk = 1, yield = 0.9 }"),
        (plain, good, "lower = 4.5, require = { cpk = 0 }"),
        (plain, good, "lower = 4.5, upper = 5.5"),
        ("moments = [0.01, 0, 3e-4, 0, 1.5e-5, 0, 1.05e-6]", good, limits),
        ("tolerance = 0", good, limits),
    ];
    let all: Vec<String> = cases
        .iter()
        .map(|(dimension, costs, characteristic)| {
            let output = wrong(&study(dimension, costs, characteristic), &[]);
            assert!(output.starts_with("exit 2\n--- stderr\n"), "{costs} {characteristic}: {output}");
            assert_eq!(output.matches("error: ").count(), 1, "{output}");
            format!("{dimension} | {costs} | {characteristic}\n{output}")
        })
        .collect();
    insta::assert_snapshot!("allocate-wrong-study", all.join("\n"));
}

#[test]
fn wrong_wishes_are_refused() {
    let none = "[dimensions]\na = { nominal = 10, tolerance = 0.1 }\nb = { nominal = 5 }\n\
                [characteristics]\ngap = { formula = \"a - b\", lower = 4.8 }\n";
    let known = "[dimensions]\na = { nominal = 10, moments = [0.01, 0, 3e-4, 0, 1.5e-5, 0, 1.05e-6] }\n\
                 b = { nominal = 5, tolerance = 0.1 }\n[characteristics]\n\
                 gap = { formula = \"a - b\", lower = 4.5, target_yield = 0.99 }\n\
                 [costs]\nb = { model = \"reciprocal\", b = 1 }\n";
    let cases: [(&str, &[&str]); 13] = [
        (none, &[]),
        (none, &["--recentre", "aa"]),
        (none, &["--recentre", "b"]),
        (none, &["--recentre", "a", "--front", "5"]),
        (known, &["--front", "1"]),
        (known, &["--front", "0"]),
        (known, &["--recentre", "a"]),
        (known, &["--confirm", "1000"]),
        (known, &["--confirm", "1"]),
        (known, &["--method", "three-point"]),
        (known, &["--seed", "-1"]),
        (known, &["--write", "STUDY"]),
        (known, &["--write", "no/such/folder/new.toml"]),
    ];
    let all: Vec<String> = cases
        .iter()
        .map(|(text, more)| {
            let output = wrong(text, more);
            assert!(output.starts_with("exit 2\n--- stderr\n"), "{more:?}: {output}");
            format!("{}\n{output}", more.join(" "))
        })
        .collect();
    insta::assert_snapshot!("allocate-wrong-wishes", all.join("\n"));
    // A dimension known by its moments keeps them, and the other dimensions are chosen around it.
    assert!(wrong(known, &[]).starts_with("exit 0"));
}

/// Paths in a study start from its folder. In another folder they would name missing files.
#[test]
fn a_study_with_files_stays_in_its_folder() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::create_dir(folder.path().join("sub")).unwrap();
    std::fs::write(at("data.csv"), "d\n0.9\n1.0\n1.1\n1.2\n0.8\n1.05\n").unwrap();
    let text = |file: &str| {
        format!(
            "[dimensions]\na = {{ measured = {file:?} }}\nb = {{ nominal = 2, tolerance = 0.1 }}\n[characteristics]\n\
             y = {{ formula = \"a + b\", lower = 2, target_yield = 0.9 }}\n[costs]\nb = {{ model = \"reciprocal\", b = 1 }}\n"
        )
    };
    std::fs::write(at("study.toml"), text("data.csv")).unwrap();
    let write = |to: &str| sensitol(&["allocate", &at("study.toml"), "--write", &at(to)]).output().unwrap();
    let refused = write("sub/new.toml");
    let error = String::from_utf8(refused.stderr).unwrap();
    assert_eq!((refused.status.code(), refused.stdout.len()), (Some(2), 0), "{error}");
    assert!(error.contains("the study names `data.csv`") && !Path::new(&at("sub/new.toml")).exists(), "{error}");
    // A study is written if its folder stays the same, or if its paths are absolute.
    assert_eq!(write("new.toml").status.code(), Some(0));
    std::fs::write(at("study.toml"), text(&at("data.csv"))).unwrap();
    assert_eq!(write("sub/new.toml").status.code(), Some(0));
    for new in ["new.toml", "sub/new.toml"] {
        assert!(sensitol(&["check", &at(new)]).output().unwrap().status.success());
    }
}

/// `--time` ends the run with the results so far and exit code 4.
#[test]
fn a_time_that_is_too_short_is_exit_4() {
    let output = sensitol(&["allocate", ENGINE, "--time", "1e-9", "--json"]).output().unwrap();
    let report: Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(report["status"], "out-of-time");
    assert_eq!(output.status.code(), Some(4), "{output:?}");
}

/// A program in two configurations at once. The tolerances equal those of the formula, and every configuration is evaluated at every
/// point. A second run finds all answers in the journal.
#[test]
fn a_program_is_allocated_in_all_configurations() {
    const PLAY: &str = r#"
import json, sys
for line in sys.stdin:
    told = json.loads(line)
    if "id" not in told:
        names, shrinks = told["dimensions"], told["constants"]["shrinks"]
        print(json.dumps({"ready": True, "name": "play"}), flush=True)
    else:
        x = dict(zip(names, told["x"]))
        print(json.dumps({"id": told["id"], "y": [x["bore"] - x["pin"] - shrinks]}), flush=True)
"#;
    let folder = tempfile::tempdir().unwrap();
    let study = |model: &str, play: &str| {
        format!(
            "{model}[dimensions]\nbore = {{ nominal = 30.0, tolerance = 0.02 }}\npin = {{ nominal = 29.9, tolerance = 0.02 }}\n\
             [constants]\nshrinks = 0.0\n[characteristics]\nplay = {{ {play}lower = 0.0, upper = 0.2, target_yield = 0.999 }}\n\
             [costs]\nbore = {{ model = \"reciprocal\", b = 0.02, min = 0.002, max = 0.2 }}\n\
             pin = {{ model = \"reciprocal\", b = 0.05, min = 0.002, max = 0.2 }}\n\
             [configurations]\ncold = {{ shrinks = 0.04 }}\nhot = {{ bore = 30.02 }}\n[analysis]\nverify = 0\n"
        )
    };
    std::fs::write(folder.path().join("play.py"), PLAY).unwrap();
    let program = "[model]\ncommand = [\"python3\", \"play.py\"]\nverify = 0\n";
    std::fs::write(folder.path().join("program.toml"), study(program, "")).unwrap();
    std::fs::write(folder.path().join("formula.toml"), study("", "formula = \"bore - pin - shrinks\", ")).unwrap();
    let run = |name: &str| {
        let arguments = "allocate --configuration all --json -q -m second-order --confirm 0".split(' ').chain([name]);
        let output = sensitol(&arguments.collect::<Vec<_>>()).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        serde_json::from_slice::<serde_json::Value>(&output.stdout).unwrap()
    };
    let [found, known] = ["program.toml", "formula.toml"].map(run);
    let cost = |report: &serde_json::Value| report["cost_after"].as_f64().unwrap();
    // Differences of a linear program against exact slopes: rounding of values near 0.1 over steps of 0.01.
    relative(cost(&found), cost(&known), 1e-6);
    assert_eq!(found["evaluations"].as_u64().unwrap() % 2, 0, "every configuration is asked");
    let again = run("program.toml");
    // The nominal point of every program is compared with the journal.
    assert_eq!(again["evaluations"], 2);
    assert_eq!(cost(&again), cost(&found));
}
