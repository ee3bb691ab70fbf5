//! Stack-up tables and CSV files: their content, and that programs can read it.

use std::path::Path;
use std::process::Command;

use sensitol::{Method, Options, analyze};
use sensitol_report::csv::{csv_file_names, stack_csv};
use sensitol_report::markdown;
use sensitol_report::{About, Report, StackNote, TotalKind, csv_files, stack_document};
use sensitol_study::Study;
use sensitol_testing::{close, relative, repository};

fn report(text: &str, options: impl Into<Options>) -> Report {
    let study = Study::from_toml(text, "study.toml").unwrap();
    let analysis = analyze(&study.problem, &options.into()).unwrap();
    Report::of(&study.problem, &analysis, About::default())
}

/// Returns exit code, stdout and stderr.
fn run(arguments: &[&str]) -> (i32, String, String) {
    let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
    let output = command.args(arguments).current_dir(repository("")).env("LC_ALL", "C.UTF-8").output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

/// Returns rows of cells, as read by an independent CSV reader.
fn read(text: &str) -> Vec<Vec<String>> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    let rows = reader.records().map(|row| row.unwrap().iter().map(str::to_owned).collect());
    rows.collect()
}

const GAP: &str = r#"
[dimensions]
housing = { nominal = 60.0, tolerance = [0.0, 0.2], unit = "mm" }
bearing = { nominal = 20.0, tolerance = 0.05, unit = "mm" }
spacer = { nominal = 18.0, limits = [17.9, 18.0], unit = "mm" }
ring = { nominal = 1.5, tolerance = 0.03, unit = "mm" }
[characteristics]
gap = { formula = "housing - bearing - spacer - 2*ring", unit = "mm", lower = 18.7, upper = 19.42 }
"#;

/// Values by hand: half-widths 0.1, 0.05, 0.05 and twice 0.03. The band middles differ from the nominals by 0.1 and 0.05.
#[test]
fn a_linear_stack_by_hand() {
    let stack = report(GAP, Method::Full).stacks().remove(0);
    assert_eq!((stack.characteristic.as_str(), stack.limits), ("gap", [Some(18.7), Some(19.42)]));
    assert_eq!(stack.notes, [], "linear, and everything was examined");
    let slopes = [1.0, -1.0, -1.0, -2.0];
    let contributions = [0.1, 0.05, 0.05, 0.06];
    let squares: f64 = contributions.iter().map(|part| part * part).sum();
    assert_eq!(stack.rows.len(), 4);
    for ((row, slope), contribution) in stack.rows.iter().zip(slopes).zip(contributions) {
        // Differences of values near 60 over steps of 0.01 are accurate to 1e-12.
        close(row.slope.unwrap(), slope, 1e-11, 1.0);
        relative(row.contribution.unwrap(), contribution, 1e-11);
        relative(row.share.unwrap(), contribution * contribution / squares, 1e-11);
    }
    let rss = squares.sqrt();
    let expected = [
        (TotalKind::WorstCase, 0.26, true),
        (TotalKind::Rss, rss, true),
        (TotalKind::InflatedRss, 1.5 * rss, true),
        (TotalKind::MeanShiftRss, 0.5 * (0.26 + rss), true),
        (TotalKind::SecondOrder, rss, true),
    ];
    assert_eq!(stack.totals.len(), expected.len());
    for (total, (kind, half_width, keeps)) in stack.totals.iter().zip(expected) {
        assert_eq!((total.kind, stack.keeps(total)), (kind, Some(keeps)));
        close(total.middle.unwrap(), 19.15, 1e-12, 0.0);
        relative(total.half_width.unwrap(), half_width, 1e-11);
    }
    let narrow = GAP.replace("upper = 19.42", "upper = 19.35");
    let stack = report(&narrow, Method::Full).stacks().remove(0);
    let kept: Vec<Option<bool>> = stack.totals.iter().map(|total| stack.keeps(total)).collect();
    assert_eq!(
        kept,
        [Some(false), Some(true), Some(false), Some(true), Some(true)],
        "to 19.41, 19.286, 19.355, 19.348, 19.286"
    );
}

/// A worst case that ends exactly at a limit is within it, whatever the last bits are: 25 H7/g6 has a clearance of 0.007 to 0.041.
#[test]
fn a_stack_that_reaches_its_limit_keeps_it() {
    let fit = |lower: f64, upper: f64| {
        let text = format!(
            "[dimensions]\nbore = {{ nominal = 25, fit = \"H7\", unit = \"mm\" }}\nshaft = {{ nominal = 25, fit = \"g6\", unit = \"mm\" }}\n\
             [characteristics]\nc = {{ formula = \"bore - shaft\", lower = {lower}, upper = {upper} }}\n"
        );
        let stack = report(&text, Method::SecondOrder).stacks().remove(0);
        stack.keeps(&stack.totals[0])
    };
    assert_eq!(fit(0.007, 0.041), Some(true));
    assert_eq!(fit(0.007_000_1, 0.041), Some(false));
    assert_eq!(fit(0.007, 0.040_999_9), Some(false));
}

/// Facts that a table cannot show are in notes below it.
#[test]
fn notes_say_what_a_stack_leaves_out() {
    let notes = |study: &str, options: Options| report(study, options).stacks().remove(0).notes;
    let full = || Options::from(Method::Full);
    let with = |dimensions: &str, formula: &str| {
        format!("[dimensions]\n{dimensions}\n[characteristics]\ny = {{ formula = \"{formula}\" }}\n")
    };
    let two = "a = { nominal = 3, tolerance = 0.3 }\nb = { nominal = 2, tolerance = 0.3 }";
    // A parabola with curvature 1 at sigma 0.1 moves the mean by 0.01 and has 2 (0.01)^2 of the variance.
    match &notes(&with(two, "a^2 + b"), full())[..] {
        [StackNote::Curved { share, mean_shift }] => {
            relative(*mean_shift, 0.01, 1e-9);
            relative(*share, 2e-4 / (0.36 + 2e-4 + 0.01), 1e-9);
        }
        other => panic!("{other:?}"),
    }
    // The interaction is a part of the variance, but not of the squared RSS.
    match &notes(&with(two, "a*b"), full())[..] {
        [StackNote::Curved { share, mean_shift }, StackNote::SharesOfRss] => {
            relative(*share, 1e-4 / (0.04 + 0.09 + 1e-4), 1e-9);
            assert_eq!(*mean_shift, 0.0);
        }
        other => panic!("{other:?}"),
    }
    // The moments of a kink come from points of the model, and so no share of the surface is that of the variance.
    assert_eq!(notes(&with(two, "max(a, b + 1)"), Options::default())[0], StackNote::Sampled);
    assert_eq!(notes(&with(two, "a*b"), Method::SecondOrder.into()), [StackNote::InteractionsNotExamined { count: 1 }]);
    assert_eq!(notes(&with(two, "a - b"), Method::Rss.into()), [StackNote::NotExamined]);
    assert_eq!(notes(&with(two, "a - b"), full()), []);
    let kinds = "a = { nominal = 3, sigma = 0.1 }\nf = { nominal = 1 }\nhole = { position = 0.2, nominal = [5, 3] }";
    let names = |names: &[&str]| names.iter().map(|&name| name.to_owned()).collect::<Vec<_>>();
    assert_eq!(
        notes(&with(kinds, "a + f + hole_x - hole_y"), full()),
        [
            StackNote::ThreeSigma { dimensions: names(&["a"]) },
            StackNote::Zone { zone: "hole".into(), dimensions: names(&["hole_x", "hole_y"]) },
            StackNote::Fixed { dimensions: names(&["f"]) },
        ]
    );
    let all = full().with_all_sensitivities(true);
    let stack = report(&with(kinds, "a + f + hole_x"), all).stacks().remove(0);
    assert_eq!(stack.notes, [StackNote::ThreeSigma { dimensions: names(&["a"]) }], "one coordinate alone is no zone");
    let shown: Vec<&str> = stack.rows.iter().map(|row| row.dimension.name.as_str()).collect();
    assert_eq!((shown, stack.rows[1].contribution), (vec!["a", "f", "hole_x"], Some(0.0)));
    relative(stack.rows[0].contribution.unwrap(), 0.3, 1e-11);
    // Without a slope the totals are unknown.
    let lost = report(
        &with("a = { nominal = -1, tolerance = 0.1 }\nb = { nominal = 2, tolerance = 0.1 }", "sqrt(a) + b"),
        full(),
    );
    let stack = lost.stacks().remove(0);
    assert!(matches!(stack.notes[0], StackNote::SlopeUnknown { .. }));
    assert!(stack.totals.iter().all(|total| total.half_width.is_none() && stack.keeps(total).is_none()));
    assert!(stack_csv(&[stack]).contains("y,total,rss,,,,,,,,,,\n"), "unknown is an empty cell");
}

/// Every number of the CSV files equals that of the JSON report, to the last bit.
#[test]
fn csv_and_json_say_the_same() {
    let study = Study::read(&repository("examples/stacked-blocks/study.toml")).unwrap();
    let analysis = analyze(&study.problem, &study.options).unwrap();
    let report = Report::of(&study.problem, &analysis, About::default());
    let json = serde_json::to_value(&report).unwrap();
    let files = csv_files(&report);
    let names: Vec<String> = files.iter().map(|file| file.name.clone()).collect();
    assert_eq!(names, csv_file_names(["gap"]));
    let table = |name: &str| read(&files.iter().find(|file| file.name == name).unwrap().text);
    let same = |cell: &str, value: &serde_json::Value| match value {
        serde_json::Value::Null => cell.is_empty(),
        serde_json::Value::Number(number) => cell.parse() == Ok(number.as_f64().unwrap()),
        serde_json::Value::String(text) => cell == text,
        serde_json::Value::Bool(truth) => cell == truth.to_string(),
        _ => false,
    };
    let compare = |name: &str, rows: &[serde_json::Value], skip: &[&str]| {
        let table = table(name);
        assert_eq!(table.len() - 1, rows.len(), "{name}");
        let mut compared = 0;
        for (cells, row) in table[1..].iter().zip(rows) {
            for (key, cell) in table[0].iter().zip(cells).filter(|(key, _)| !skip.contains(&key.as_str())) {
                let found = match key.as_str() {
                    "lower" | "upper" if name == "dimensions.csv" => &row["tolerance"][usize::from(key == "upper")],
                    "worst_case_lower" => &row["worst_case"]["linear"][0],
                    "worst_case_upper" => &row["worst_case"]["linear"][1],
                    "distribution" if name == "characteristics.csv" => &row["distribution"]["family"],
                    "type" => &row["distribution"]["type"],
                    "dimension_a" => &row["dimensions"][0],
                    "dimension_b" => &row["dimensions"][1],
                    "rounding_first" => &row["rounding"][0],
                    "rounding_second" => &row["rounding"][1],
                    "first_order" | "total" => &row[key]["value"],
                    "first_order_error" => &row["first_order"]["error"],
                    "total_error" => &row["total"]["error"],
                    _ => match key.strip_prefix("normal_") {
                        Some(of_normal) => &row["normal_fit"][of_normal],
                        None => &row[key],
                    },
                };
                assert!(same(cell, found), "{name}: {key} is {cell}, not {found}");
                compared += 1;
            }
        }
        assert!(compared > 0 || rows.is_empty());
    };
    let list = |value: &serde_json::Value| value.as_array().unwrap().clone();
    let gap = &json["characteristics"][0];
    compare("dimensions.csv", &list(&json["dimensions"]), &[]);
    compare("characteristics.csv", &list(&json["characteristics"]), &[]);
    compare("sensitivities.csv", &list(&gap["sensitivities"]), &["characteristic"]);
    compare("interactions.csv", &list(&gap["interactions"]), &["characteristic"]);
    compare("warnings.csv", &list(&json["warnings"]), &[]);
    for row in &table("quantiles.csv")[1..] {
        let found = &gap["quantiles"]["values"][&row[1]];
        assert!(row[0] == "gap" && same(&row[2], &found["value"]) && same(&row[3], &found["error"]), "{row:?}");
        assert_eq!(row[4], gap["quantiles"]["source"].as_str().unwrap());
    }
    let stack = table("stack-gap.csv");
    let total = stack.iter().find(|row| row[2] == "rss").unwrap();
    assert!(same(&total[6], &gap["rss"]) && same(&total[4], &gap["middle"]));
    assert_eq!(stack.iter().filter(|row| row[1] == "dimension").count(), 8, "the gap does not know d and g");
}

/// Names that would leave the folder, break a row or be the same file.
#[test]
fn names_are_safe_in_files() {
    let names = csv_file_names(["gap", "GAP", "../../etc", "a,b \"c\"", "größe", "", "x/y", "x:y", &"n".repeat(500)]);
    let stacks: Vec<&str> = names[6..].iter().map(String::as_str).collect();
    assert_eq!(
        stacks[..8],
        [
            "stack-gap.csv",
            "stack-GAP-2.csv",
            "stack-.._.._etc.csv",
            "stack-a_b__c_.csv",
            "stack-größe.csv",
            "stack-.csv",
            "stack-x_y.csv",
            "stack-x_y-2.csv"
        ]
    );
    assert!(stacks[8].len() < 120);
    assert!(
        csv_file_names([&*"\u{20bb7}".repeat(500)]).last().unwrap().len() < 120,
        "a file name has 255 bytes at most"
    );
    let study = "[dimensions]\n\"a,\\\"b\\\"\" = { nominal = 1, tolerance = 0.1, unit = \"m|m\" }\n\
                 [characteristics]\n\"y|z_\" = { formula = \"2*`a,\\\"b\\\"`\", unit = \"\\u001b[1m\" }\n";
    let report = report(study, Method::Full);
    let rows = read(&stack_csv(&report.stacks()));
    assert!(rows.iter().all(|row| row.len() == 13) && rows[1][2] == "a,\"b\"", "{rows:?}");
    let markdown = markdown(&stack_document(&report.stacks()));
    assert!(!markdown.contains('\u{1b}') && markdown.contains("y\\|z\\_") && markdown.contains("m\\|m"), "{markdown}");
    for table_line in markdown.lines().filter(|line| line.starts_with('|')) {
        let bars = table_line.matches('|').count() - table_line.matches("\\|").count();
        assert!(bars == 8 || bars == 7, "{table_line}");
    }
}

#[test]
fn stacks_are_printed() {
    let folder = tempfile::tempdir().unwrap();
    let study = folder.path().join("study.toml");
    let second = "sum = { formula = \"2*ring + 0.5*spacer\" }\narea = { formula = \"ring*bearing\", upper = 31 }\n";
    std::fs::write(&study, format!("{GAP}{second}")).unwrap();
    let study = study.to_str().unwrap();
    for format in ["text", "csv", "markdown"] {
        let (code, printed, _) = run(&["analyze", study, "--stack", format, "-m", "full"]);
        assert_eq!(code, 0);
        if format == "csv" {
            // The last digits depend on the machine, so only rows are counted: a header, dimensions and five totals of each, and the
            // proven worst case of the nonlinear one.
            assert_eq!(read(&printed).len(), 1 + (4 + 5) + (2 + 5) + (2 + 6));
        } else {
            insta::assert_snapshot!(format!("stack-{format}"), printed);
        }
        let to = folder.path().join("stack.out");
        let (code, nothing, _) = run(&["analyze", study, "--stack", format, "-m", "full", "-o", to.to_str().unwrap()]);
        assert_eq!((code, nothing.as_str(), std::fs::read_to_string(&to).unwrap()), (0, "", printed));
    }
    let (_, plain, _) = run(&["analyze", study, "--stack", "text", "--kc", "sum", "--color", "never"]);
    assert!(
        plain.is_ascii() && plain.starts_with("stack of sum\n") && plain.matches("stack of").count() == 1,
        "{plain}"
    );
    for line in run(&["analyze", "examples/stacked-blocks/study.toml", "--stack", "text"]).1.lines() {
        assert!(line.chars().count() <= 100, "{line}");
    }
}

#[test]
fn csv_files_are_written() {
    let folder = tempfile::tempdir().unwrap();
    let to = folder.path().join("a/b");
    let shown = to.to_str().unwrap();
    let blocks = "examples/stacked-blocks/study.toml";
    let written = |path: &Path| {
        let mut names: Vec<String> =
            std::fs::read_dir(path).unwrap().map(|file| file.unwrap().file_name().into_string().unwrap()).collect();
        names.sort();
        names
    };
    let (code, report, _) = run(&["analyze", blocks, "--csv", shown]);
    assert!(code == 0 && report.contains("gap [mm]"), "the report is printed beside");
    let all = ["characteristics", "dimensions", "interactions", "quantiles", "sensitivities", "stack-gap", "warnings"];
    assert_eq!(written(&to), all.map(|name| format!("{name}.csv")));
    let before = std::fs::read_to_string(to.join("characteristics.csv")).unwrap();
    // A failing run leaves the earlier files unchanged, and no other file.
    let (code, _, _) = run(&["analyze", blocks, "--csv", shown, "--budget", "3"]);
    assert_eq!((code, written(&to).len()), (2, 7));
    assert_eq!(std::fs::read_to_string(to.join("characteristics.csv")).unwrap(), before);
    let (code, json, _) = run(&["analyze", blocks, "--csv", shown, "--json", "--method", "rss"]);
    assert!(code == 0 && serde_json::from_str::<serde_json::Value>(&json).is_ok());
    assert_ne!(std::fs::read_to_string(to.join("characteristics.csv")).unwrap(), before);
    // A file in the place of a folder, at the end of the path or within it.
    let file = to.join("characteristics.csv");
    for wrong in [file.clone(), file.join("below")] {
        let (code, nothing, error) = run(&["analyze", blocks, "--csv", wrong.to_str().unwrap()]);
        assert!(code == 2 && nothing.is_empty(), "{error}");
        assert!(error.contains("characteristics.csv is a file, and --csv needs a folder"), "{error}");
    }
    for wrong in [&["--stack"][..], &["--stack", "html"], &["--stack", "text", "--json"], &["--csv"]] {
        let (code, nothing, error) = run(&[&["analyze", blocks], wrong].concat());
        // With --json the errors are on stdout too.
        let json = wrong.contains(&"--json");
        assert!(code == 2 && nothing.is_empty() != json && error.starts_with("error: "), "{wrong:?}: {error}");
    }
}
