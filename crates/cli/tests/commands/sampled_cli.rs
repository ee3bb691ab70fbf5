//! `simulate` and `compare` on the command line.

use serde_json::Value;

use super::command::{ENGINE, run, sensitol};
use sensitol_testing::repository;

const BLOCKS: &str = "examples/stacked-blocks/study.toml";
const PYTHON: &str = "examples/external-python/study.toml";

fn json(arguments: &[&str]) -> Value {
    let output = sensitol(arguments).output().unwrap();
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"))
}

#[test]
fn a_simulation_prints_estimates_with_standard_errors() {
    insta::assert_snapshot!("simulate", run(&["simulate", BLOCKS, "--samples", "20000", "--threads", "1"]));
    insta::assert_snapshot!(
        "simulate-sobol",
        run(&["simulate", BLOCKS, "--sampler", "sobol", "--samples", "20000", "--color", "never"])
    );
    let report = json(&["simulate", BLOCKS, "--samples", "5000", "--json", "--seed", "9"]);
    assert_eq!(
        (&report["samples"], &report["seed"], &report["method"]),
        (&5000.into(), &9.into(), &"monte-carlo".into())
    );
    let one = &report["characteristics"][0];
    let counts: u64 = one["histogram"]["counts"].as_array().unwrap().iter().map(|count| count.as_u64().unwrap()).sum();
    assert_eq!(counts, 5000);
    assert_eq!(
        one["histogram"]["edges"].as_array().unwrap().len(),
        one["histogram"]["counts"].as_array().unwrap().len() + 1
    );
    let [low, high] = [0, 1].map(|end| one["standard_error"]["yield"][end].as_f64().unwrap());
    assert!(low < one["yield"].as_f64().unwrap() && one["yield"].as_f64().unwrap() <= high);
    assert!(one["standard_error"]["quantiles"]["0.5"].as_f64().unwrap() > 0.0);
}

/// If no value of the sample is expected beyond a quantile, the quantile is unknown, and not the least value of the sample.
#[test]
fn quantiles_beyond_a_small_sample_are_unknown() {
    let report = json(&["simulate", BLOCKS, "--samples", "13", "--json"]);
    let one = &report["characteristics"][0];
    let known: Vec<bool> = ["0.00135", "0.01", "0.05", "0.5", "0.95", "0.99", "0.99865"]
        .iter()
        .map(|p| one["distribution"]["quantiles"][p].is_f64())
        .collect();
    assert_eq!(known, [false, false, false, true, false, false, false]);
    // Twenty values have one beyond five percent on average. The quantile has no standard error then. The histogram is still there.
    let report = json(&["simulate", BLOCKS, "--samples", "2e1", "--json"]);
    let one = &report["characteristics"][0];
    assert!(one["distribution"]["quantiles"]["0.05"].is_f64() && one["standard_error"]["quantiles"]["0.05"].is_null());
    assert_eq!(one["histogram"]["counts"].as_array().unwrap().iter().filter_map(Value::as_u64).sum::<u64>(), 20);
    let text = run(&["simulate", BLOCKS, "--samples", "13", "-v"]);
    let line = text.lines().find(|line| line.contains("quantile 0.00135")).unwrap();
    assert_eq!(line.split_whitespace().collect::<Vec<_>>(), ["quantile", "0.00135", "-", "-"]);
}

/// Answers of a costly model are kept: the second run evaluates almost nothing.
#[test]
fn samples_of_programs_are_journaled() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("a.sqlite");
    let arguments = ["simulate", PYTHON, "--samples", "300", "--json", "--journal", journal.to_str().unwrap()];
    let (first, second) = (json(&arguments), json(&arguments));
    assert_eq!((&first["cached"], &second["cached"]), (&0.into(), &300.into()));
    // The second run evaluates only the nominal point, which the sentinel repeats.
    assert!(second["evaluations"].as_u64().unwrap() <= 2, "{}", second["evaluations"]);
    assert_eq!(first["characteristics"][0]["mean"], second["characteristics"][0]["mean"]);
}

#[test]
fn a_comparison_measures_every_method() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let (svg, csv) = (path("trade.svg"), path("tables"));
    let report = json(&["compare", BLOCKS, "--samples", "65536", "--json", "--svg", &svg, "--csv", &csv]);
    let one = &report["characteristics"][0];
    let methods = one["methods"].as_array().unwrap();
    let named = |name: &str| methods.iter().find(|method| method["method"] == name).unwrap();
    assert_eq!(named("rss")["evaluations"], 17);
    assert_eq!(named("full")["evaluations"], 73);
    assert_eq!(named("monte-carlo 1000")["evaluations"], 1000);
    let error = |name: &str| named(name)["error_vs_reference"]["overall"].as_f64().unwrap();
    assert!(error("full") < error("rss") && error("full") < error("monte-carlo 100"));
    // The cheapest method is on the front. A method that is both dearer and worse than another is not.
    assert_eq!(methods[0]["evaluations"], 17);
    assert!(methods.iter().any(|method| method["evaluations"] == 17 && method["pareto"] == true));
    assert_eq!(named("monte-carlo 100")["pareto"], false);
    let skipped = |name: &str| report["not_run"].as_array().unwrap().iter().any(|one| one["method"] == name);
    assert!(skipped("monte-carlo 100000"), "as long as the reference");
    let table = std::fs::read_to_string(folder.path().join("tables/comparison.csv")).unwrap();
    assert_eq!(table.lines().count(), 1 + methods.len());
    let chart = std::fs::read_to_string(svg).unwrap();
    assert!(chart.starts_with("<svg") && chart.trim_end().ends_with("</svg>"));
    assert_eq!(chart.matches("<circle").count(), methods.len());
    assert!(chart.contains(">monte-carlo 1000<"));
}

/// The output of the program, with the seconds left out.
#[test]
fn a_comparison_is_a_table() {
    let text = run(&["compare", BLOCKS, "--samples", "65536", "--budget", "5000", "--threads", "1"]);
    let seconds = |word: &str| word.parse::<f64>().is_ok();
    let line = |line: &str| {
        let words: Vec<&str> = line.split_whitespace().collect();
        // Columns are method, points, and two times, which differ between runs.
        let times = words.iter().position(|word| seconds(word)).filter(|_| words.len() > 7 && !line.contains("points"));
        // These names contain a number of points, and are shortened on a narrow page.
        let sampled = words.first().is_some_and(|name| name.starts_with("monte") || *name == "sobol");
        let kept = words.iter().enumerate().map(|(i, word)| match times {
            Some(first) if !sampled && (i == first + 1 || i == first + 2) => "T",
            Some(first) if sampled && (i == first + 2 || i == first + 3) => "T",
            _ => *word,
        });
        kept.collect::<Vec<_>>().join(" ")
    };
    let table: Vec<String> = text.lines().filter(|line| !line.starts_with("not run")).map(line).collect();
    insta::assert_snapshot!("compare", table.join("\n"));
}

#[test]
fn a_comparison_of_a_program_shares_its_points() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("a.sqlite");
    let report = json(&["compare", PYTHON, "--samples", "200", "--json", "--journal", journal.to_str().unwrap()]);
    let methods = report["characteristics"][0]["methods"].as_array().unwrap();
    let named = |name: &str| methods.iter().find(|method| method["method"] == name).unwrap();
    // Points that rss has evaluated are reused by the other methods. Only rss has the nominal point once more as a sentinel, and seven
    // answers replayed by walks of four evaluations.
    assert_eq!((&named("rss")["evaluations"], &named("second-order")["evaluations"]), (&46.into(), &17.into()));
    assert!(named("second-order")["cached"].as_u64().unwrap() >= 17);
    assert!(named("second-order")["evaluation_s"].as_f64().unwrap() > 0.0);
    let projected =
        report["not_run"].as_array().unwrap().iter().find(|one| one["method"] == "monte-carlo 10000").unwrap();
    assert!(projected["projected_s"].as_f64().unwrap() > 0.0);
}

#[test]
fn wrong_wishes() {
    let folder = tempfile::tempdir().unwrap();
    let study = |text: &str| {
        let path = folder.path().join(format!("{}.toml", text.len()));
        std::fs::write(&path, text).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let nowhere = study(
        "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"sqrt(a - 9)\" }\n",
    );
    let moments = study(
        "[dimensions]\na = { nominal = 1, moments = [1, 0, 3, 0, 15, 0, 105] }\n[characteristics]\ny = { formula = \"a\", lower = 0 }\n",
    );
    let hide = |text: String| text.replace(folder.path().to_str().unwrap(), "DIR");
    let mut all = String::new();
    for arguments in [
        &["simulate", BLOCKS, "--samples", "0"][..],
        &["simulate", BLOCKS, "--samples", "1.5"],
        &["simulate", BLOCKS, "--samples", "-3"],
        &["simulate", BLOCKS, "--until", "-1"],
        &["simulate", BLOCKS, "--sampler", "halton"],
        &["simulate", BLOCKS, "--kc", "gab"],
        &["simulate", &moments],
        &["simulate", &nowhere, "--samples", "100"],
        &["simulate", ENGINE, "--check"],
        &["compare", &moments],
        &["compare", &nowhere, "--samples", "100"],
        &["compare", BLOCKS, "--svg", "/nowhere/a.svg"],
        &["compare", BLOCKS, "--budget", "many"],
    ] {
        let mut text = hide(run(arguments));
        if arguments[0] == "compare" && arguments[1] == nowhere {
            // The seconds differ between runs.
            let kept = |line: &&str| ["exit", "---", "warning"].iter().any(|start| line.starts_with(start));
            text = text.lines().filter(kept).collect::<Vec<_>>().join("\n");
        }
        all += &format!("$ {}\n{text}\n", hide(arguments.join(" ")));
    }
    insta::assert_snapshot!("wrong-wishes", all);
}

/// The number of rounds determines the useful size of a cluster: `analyze`, `compare` and `allocate` print it as in their JSON.
#[test]
fn the_rounds_of_a_program_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    let program = "import json, sys\nfor line in sys.stdin:\n    said = json.loads(line)\n    if 'sensitol' in said:\n        \
                   print(json.dumps({'ready': True, 'window': 64}), flush=True)\n    elif 'x' in said:\n        a, b = said['x']\n        \
                   print(json.dumps({'id': said['id'], 'y': [a * b]}), flush=True)\n";
    std::fs::write(folder.path().join("product.py"), program).unwrap();
    let study = folder.path().join("study.toml");
    let text = "[model]\ncommand = [\"python3\", \"product.py\"]\n[dimensions]\na = { nominal = 3, tolerance = 0.1 }\n\
                b = { nominal = 5, tolerance = 0.1 }\n[characteristics]\narea = { lower = 14, upper = 16, target_yield = 0.99 }\n";
    std::fs::write(&study, text).unwrap();
    let study = study.to_str().unwrap();
    let cases: [(&[&str], &str); 3] = [
        (&["analyze", study, "-m", "auto"], "evaluations in {} rounds"),
        (&["compare", study, "--samples", "100"], "evaluations in {} rounds"),
        (&["allocate", study], "sent in {} batches"),
    ];
    for (arguments, words) in cases {
        let arguments = [arguments, &["--journal", "none"]].concat();
        let report = json(&[&arguments[..], &["--json"]].concat());
        let rounds = report["stages"].as_u64().unwrap();
        assert!(rounds > 1, "{arguments:?}: {rounds}");
        let text = run(&arguments).split_whitespace().collect::<Vec<_>>().join(" ");
        assert!(text.contains(&words.replace("{}", &rounds.to_string())), "{rounds}: {text}");
    }
}

/// The system's mathematical library rounds differently without FMA. With FMA hidden from it, every figure stays the same.
#[cfg(all(target_os = "linux", target_env = "gnu", target_arch = "x86_64"))]
#[test]
fn figures_are_the_same_on_every_processor() {
    let folder = tempfile::tempdir().unwrap();
    let formulas = folder.path().join("study.toml");
    let text = r#"
[dimensions]
a = { nominal = 1.3, tolerance = 0.1 }
b = { nominal = 0.7, tolerance = 0.02, distribution = { kind = "student", degrees = 12 } }
c = { nominal = 0.4, sigma = 0.03, distribution = { kind = "weibull", origin = 0.3 } }

[characteristics]
powers = { formula = "a^1.5 + b^a", lower = 1.9 }
angles = { formula = "atan2(a, b) + asin(c) + acos(b/2) + atan(a)", upper = 3.9 }
waves = { formula = "sin(a)*cos(b) + tan(c)", upper = 1.4 }
hyperbolas = { formula = "sinh(a) + cosh(b)*tanh(c)", upper = 2.4 }
logarithms = { formula = "hypot(a, b)*log10(a + b) + ln(c)*exp(a)", upper = 0 }
"#;
    std::fs::write(&formulas, text).unwrap();
    let formulas = formulas.to_str().unwrap();
    let figures = |command: &[&str], hidden: Option<&str>| {
        let mut program = sensitol(command);
        program.arg("--json").envs(hidden.map(|hidden| ("GLIBC_TUNABLES", hidden)));
        let output = program.output().unwrap();
        let mut report: Value =
            serde_json::from_slice(&output.stdout).unwrap_or_else(|error| panic!("{error}: {output:?}"));
        (report["wall_s"], report["in_model_s"]) = (Value::Null, Value::Null);
        report
    };
    let commands: [&[&str]; 7] = [
        &["simulate", formulas, "--samples", "20000"],
        &["simulate", ENGINE, "--samples", "20000"],
        &["simulate", "examples/spot-weld/study.toml", "--samples", "20000"],
        &["simulate", "examples/connecting-rod/study.toml", "--samples", "2000"],
        &["analyze", formulas],
        &["analyze", ENGINE],
        &["allocate", "examples/door-hinge/study.toml"],
    ];
    for command in commands {
        let hidden = "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-AVX512F";
        assert_eq!(figures(command, None), figures(command, Some(hidden)), "{command:?}");
    }
}

/// Control variate of `simulate`, with its reduction of the standard errors.
#[test]
fn simulate_reports_its_control_variate() {
    let study = repository("examples/engine-balance/study.toml");
    let run = |more: &[&str]| {
        let mut command = assert_cmd::Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        command.arg("simulate").arg(&study).args(["--samples", "2000"]).args(more).assert()
    };
    let json = run(&["--control-variate", "--json"]).success().get_output().stdout.clone();
    let report: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let surrogate = report["surrogate_evaluations"].as_u64().unwrap();
    assert_eq!(report["evaluations"].as_u64().unwrap(), 2000 + surrogate);
    let control = &report["characteristics"][0]["control"];
    assert_eq!((control["method"].as_str(), control["evaluations"].as_u64()), (Some("six-n"), Some(surrogate)));
    // The study's method examines the ten strongest interactions. Method full examines all and explains more.
    let strongest = control["reduction"]["sigma"].as_f64().unwrap();
    let json = run(&["--control-variate", "--method", "full", "--json"]).success().get_output().stdout.clone();
    let report: serde_json::Value = serde_json::from_slice(&json).unwrap();
    let control = &report["characteristics"][0]["control"];
    assert_eq!(control["evaluations"], 111);
    assert!(control["reduction"]["sigma"].as_f64().unwrap() > strongest && strongest > 10.0, "{control} {strongest}");
    let text = run(&["--control-variate", "--method", "full"]).success().get_output().stdout.clone();
    assert!(String::from_utf8(text).unwrap().contains("control: full surrogate, 111 evaluations"));
    let plain = run(&["--json"]).success().get_output().stdout.clone();
    let plain: serde_json::Value = serde_json::from_slice(&plain).unwrap();
    assert!(plain["surrogate_evaluations"].is_null() && plain["characteristics"][0]["control"].is_null());
    // `--method` without a surrogate is an error.
    run(&["--method", "full"]).failure().code(2);
}

/// Eight processes share a sample. One is killed and starts again, one runs twice. What is merged prints the figures of one run.
#[test]
fn shards_of_eight_processes_are_one_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).display().to_string();
    let shard = |number: u64, name: &str| {
        let (number, file) = (number.to_string(), path(name));
        let arguments = ["simulate", BLOCKS, "--samples", "200000", "--shards", "8", "--shard", &number, "-o", &file];
        sensitol(&arguments)
    };
    let files: Vec<String> = (1..=8).map(|number| format!("{number}.json")).collect();
    for (number, name) in (1..).zip(&files) {
        if number == 3 {
            let mut killed = shard(number, name).spawn().unwrap();
            killed.kill().unwrap();
            killed.wait().unwrap();
        }
        assert!(shard(number, name).status().unwrap().success());
    }
    assert!(shard(5, "again.json").status().unwrap().success());
    let all: Vec<String> = files.iter().map(|name| path(name)).chain([path("again.json")]).collect();
    let merge = |files: &[String], json: bool| {
        let mut arguments = vec!["merge", BLOCKS];
        arguments.extend(files.iter().map(String::as_str));
        arguments.extend(json.then_some("--json"));
        sensitol(&arguments).output().unwrap()
    };
    let found: Value = serde_json::from_slice(&merge(&all, true).stdout).unwrap();
    let whole = json(&["simulate", BLOCKS, "--samples", "200000", "--json"]);
    for key in ["samples", "seed", "method", "failed", "study_sha256"] {
        assert_eq!(found[key], whole[key], "{key}");
    }
    let [a, b] = [&found, &whole].map(|of| &of["characteristics"][0]);
    for key in ["yield", "ppm_below", "ppm_above", "histogram", "range", "samples", "verdict"] {
        assert_eq!(a[key], b[key], "{key}");
    }
    let [a, b] = [a, b].map(|of| of["sigma"].as_f64().unwrap());
    assert!((a - b).abs() < 1e-12 * b, "{a} {b}");

    let refused = |files: &[String]| {
        let output = merge(files, false);
        assert_eq!((output.status.code(), output.stdout.len()), (Some(2), 0));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(refused(&all[1..4]).contains("of 8 shards 5 are missing: 1, 5, 6, 7, 8"));
    let text = std::fs::read_to_string(path("2.json")).unwrap();
    std::fs::write(path("cut.json"), &text[..text.len() / 2]).unwrap();
    assert!(refused(&[path("cut.json")]).contains("it is not complete or was changed"));
    std::fs::write(path("other.json"), text.replacen("\"study_sha256\":\"", "\"study_sha256\":\"0", 1)).unwrap();
    assert!(refused(&[path("other.json")]).contains("the study or its data files were changed since"));
    assert!(refused(&[BLOCKS.to_owned()]).contains("it is no file of `sensitol simulate --shard`"));
    assert!(refused(&[path("none.json")]).contains("none.json: No such file"));
    // A result of another program is not written over, and a shard may be written again.
    std::fs::write(path("letter.txt"), "Dear reader").unwrap();
    assert_eq!(shard(1, "letter.txt").output().unwrap().status.code(), Some(2));
    assert!(shard(1, "1.json").status().unwrap().success());
}
