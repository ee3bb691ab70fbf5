//! Short text reports: first a line for every characteristic, then at most 30 lines for each, within 80 columns.

use super::command::sensitol;

/// Most lines of a characteristic unless everything is asked for: a row for each of its figures, and a picture of ten rows.
const MOST: usize = 30;

fn text(arguments: &[&str]) -> String {
    let output = sensitol(arguments).arg("-q").output().unwrap();
    assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    String::from_utf8(output.stdout).unwrap()
}

/// Splits a report into parts. Each begins with a line at the margin below an empty line.
fn parts(report: &str) -> Vec<Vec<&str>> {
    let (mut parts, mut before): (Vec<Vec<&str>>, &str) = (Vec::new(), "head");
    for line in report.lines() {
        if before.is_empty() && !line.starts_with(' ') {
            parts.push(Vec::new());
        }
        parts.iter_mut().next_back().into_iter().for_each(|part| part.push(line));
        before = line;
    }
    parts
}

#[test]
fn the_verdict_comes_first_and_a_characteristic_fits_a_screen() {
    let rod = "examples/connecting-rod/crank-angle.toml";
    let cases: [(&[&str], &[&str]); 6] = [
        (&["simulate", "examples/first-study/study.toml"], &["gap", "0.752", "MISSED"]),
        (&["simulate", "examples/ishigami/study.toml", "--sobol", "--samples", "16384"], &["y"]),
        (&["simulate", "examples/first-study/study.toml", "--rare"], &["gap", "MISSED"]),
        (&["compare", "examples/shaft-and-bore/study.toml", "--samples", "65536"], &["clearance", "0.0436"]),
        (&["sweep", rod, "--over", "theta=-180:180:73"], &["F_axial", ".."]),
        (&["sweep", "examples/first-study/study.toml", "--over", "housing=50.1:50.3:5"], &["gap", "MISSED"]),
    ];
    for (arguments, words) in cases {
        let report = text(arguments);
        let table: Vec<&str> = report.lines().skip_while(|line| !line.is_empty()).skip(1).collect();
        let first =
            table.iter().take_while(|line| !line.is_empty()).find(|line| words.iter().all(|word| line.contains(word)));
        assert!(first.is_some(), "{arguments:?}: no line of {words:?}\n{report}");
        let all = text(&[arguments, &["-v"]].concat());
        let parts = parts(&report);
        assert!(!parts.is_empty(), "{arguments:?}\n{report}");
        for part in parts {
            assert!(part.len() <= MOST, "{arguments:?}: {} lines\n{report}", part.len());
        }
        assert!(all.len() >= report.len(), "{arguments:?}");
        for line in report.lines().chain(all.lines()) {
            assert!(line.chars().count() <= 80, "{arguments:?}: {line}");
        }
    }
}

/// A long sweep has all rows with -v and in CSV. The short report contains the worst one.
#[test]
fn a_long_sweep_is_thinned() {
    let folder = tempfile::tempdir().unwrap();
    let tables = folder.path().to_str().unwrap();
    let asked = ["sweep", "examples/first-study/study.toml", "--over", "housing=50.1:50.37:101"];
    let brief = text(&[&asked[..], &["--csv", tables]].concat());
    assert!(brief.contains("of 101 values; -v shows all"), "{brief}");
    let csv = std::fs::read_to_string(folder.path().join("sweep.csv")).unwrap();
    let yields: Vec<(f64, f64)> = {
        let mut reader = csv::Reader::from_reader(csv.as_bytes());
        let names = reader.headers().unwrap().clone();
        let place = |name: &str| names.iter().position(|known| known == name).unwrap();
        let (at, yield_) = (place("at"), place("yield"));
        reader
            .records()
            .map(|row| row.unwrap())
            .map(|row| (row[at].parse().unwrap(), row[yield_].parse().unwrap()))
            .collect()
    };
    assert_eq!(yields.len(), 101);
    let worst = yields.iter().copied().reduce(|a, b| if b.1 < a.1 { b } else { a }).unwrap().0;
    let values = |report: &str| -> Vec<f64> {
        report.lines().filter_map(|line| line.split_whitespace().next()?.parse().ok()).collect()
    };
    let shown = |report: &str, at: f64| values(report).iter().any(|value| (value - at).abs() < 1e-9);
    assert!(shown(&brief, worst), "{worst}\n{brief}");
    let all = text(&[&asked[..], &["-v"]].concat());
    assert!(yields.iter().all(|&(at, _)| shown(&all, at)), "{all}");
}

/// An allocation begins with the characteristics before and after, each with its verdict.
#[test]
fn an_allocation_begins_with_what_is_kept() {
    let report = text(&["allocate", "examples/first-study/study.toml"]);
    let place = |words: &[&str]| {
        let found = report.lines().position(|line| words.iter().all(|word| line.contains(word)));
        found.unwrap_or_else(|| panic!("{words:?}\n{report}"))
    };
    let before = place(&["gap [mm]", "before", "MISSED"]);
    assert!(before < place(&["housing", "±"]));
    assert!(report.lines().nth(before + 1).unwrap().contains("met"), "{report}");
    for words in ["KKT residual below", "shadow price of gap per 0.001 mm", "margin: tolerances can be scaled by"] {
        assert!(report.contains(words), "{words}\n{report}");
    }
}

/// The verdict comes first, then contributors, then moments and intervals. A study without limits has no empty columns, and a
/// characteristic without limits or without a target says so.
#[test]
fn a_report_answers_in_the_order_of_the_questions() {
    let report = text(&["analyze", "examples/first-study/study.toml"]);
    let place = |words: &str| report.find(words).unwrap_or_else(|| panic!("{words}\n{report}"));
    let order = [
        "MISSED\n\ngap [mm]",
        "\n  yield 99.659 %",
        "contrib. %",
        "\n  nominal ",
        "\n  ± 3 sigma",
        "\n\ngap 99.659 % (",
    ];
    let places: Vec<usize> = order.iter().map(|words| place(words)).collect();
    assert!(places.is_sorted(), "{places:?}\n{report}");
    let folder = tempfile::tempdir().unwrap();
    let head = |characteristics: &str| {
        let path = folder.path().join("gap.toml");
        let dimensions = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\n[characteristics]\n";
        std::fs::write(&path, format!("{dimensions}{characteristics}")).unwrap();
        let report = text(&["analyze", path.to_str().unwrap()]);
        report.split("\n\n").nth(1).unwrap().to_owned()
    };
    let free = "free = { formula = \"2*a\" }\n";
    let limited = "limited = { formula = \"a\", lower = 9.8 }\n";
    let wanted = "wanted = { formula = \"a\", lower = 9.8, target_yield = 0.9 }\n";
    let none = head(free);
    assert!(["Cpk", "yield", "verdict"].iter().all(|title| !none.contains(title)), "{none}");
    let some = head(&format!("{free}{limited}"));
    assert!(some.contains("yield") && some.contains("no limits") && !some.contains("verdict"), "{some}");
    let all = head(&format!("{free}{limited}{wanted}"));
    assert!(all.contains("no limits") && all.contains("no target") && all.contains("met"), "{all}");
}

/// COLUMNS sets the width of a pipe. No label of the program is shortened at any width.
#[test]
fn columns_count_in_a_pipe() {
    let of = |width: &str| {
        let output = sensitol(&["compare", "examples/shaft-and-bore/study.toml", "--samples", "65536"])
            .env("COLUMNS", width)
            .output()
            .unwrap();
        String::from_utf8(output.stdout).unwrap()
    };
    let (narrow, usual, wide) = (of("60"), of("80"), of("120"));
    let widest = |text: &str| text.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(widest(&narrow) <= 60 && widest(&usual) <= 80 && widest(&wide) > 80, "{narrow}\n{usual}\n{wide}");
    for text in [narrow, usual, wide] {
        assert!(text.contains("bivariate-dimension-reduction") && !text.contains('…'), "{text}");
    }
}

/// `--brief` prints a line for every characteristic. Its figures are those of the report, without digits that the error does not carry.
#[test]
fn one_line_where_one_is_asked() {
    let line = |study: &str| text(&["analyze", study, "--brief"]);
    // Right by hand: sigma of clearance, and Phi(-5) on either side of the limits at 5 sigma, 0.287 ppm.
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("gap.toml");
    std::fs::write(
        &path,
        "[dimensions]\na = { nominal = 10, tolerance = 0.3, unit = \"mm\" }\nb = { nominal = 4, tolerance = 0.4, unit = \"mm\" }\n\
         [characteristics]\ngap = { formula = \"a - b\", unit = \"mm\", lower = 5.66, target_yield = 0.9999 }\n\
         sum = { formula = \"a + b\", unit = \"mm\" }\n",
    )
    .unwrap();
    // P(gap < 5.66) = Phi(-2.04) = 0.020675; shares 9/25 and 16/25; sigma = 0.5/3.
    assert_eq!(
        line(path.to_str().unwrap()),
        "gap 97.93 % (target 99.99 %) MISSED: 20675 ppm below 5.66; b 64 %, a 36 %\n\
         sum mean 14.0000, sigma 0.16667 mm, no limits; b 64 %, a 36 %\n"
    );
    // A long report ends with the same lines, below an empty one.
    let report = text(&["analyze", path.to_str().unwrap()]);
    assert!(report.ends_with(&format!("\n\n{}", line(path.to_str().unwrap()))), "{report}");
    let refused = sensitol(&["analyze", path.to_str().unwrap(), "--brief", "--json"]).output().unwrap();
    assert_eq!(refused.status.code(), Some(2));
}
