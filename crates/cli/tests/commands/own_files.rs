//! Files of others stay: only empty files and reports of the program are written over.

use std::path::Path;

use super::command::sensitol;

const STUDY: &str = "title = \"A title\"\n[dimensions]\na = { nominal = 1, tolerance = 0.1 }\nb = { nominal = 2, tolerance = 0.1 }\n\
                     [characteristics]\ng = { formula = \"a + b\", lower = 2.8, upper = 3.2, target_cpk = 1 }\n";

/// Runs in a folder with the study `gap.toml` and `more.toml`, and returns exit code and stderr.
fn run(folder: &Path, line: &str) -> (i32, String) {
    let arguments: Vec<&str> = line.split(' ').collect();
    let output = sensitol(&arguments).current_dir(folder).output().unwrap();
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("gap.toml"), STUDY).unwrap();
    std::fs::write(folder.path().join("more.toml"), STUDY.replace("2.8", "2.7")).unwrap();
    folder
}

/// Every form of every report is known again: the same command succeeds twice, and in empty files.
#[test]
fn own_reports_are_written_over() {
    let folder = folder();
    for line in [
        "analyze gap.toml -o FILE --csv DIR --html page.html --xlsx book.xlsx",
        "analyze gap.toml --json -o FILE",
        "analyze gap.toml --stack=text -o FILE",
        "analyze gap.toml --stack=csv -o FILE",
        "analyze gap.toml --stack=markdown -o FILE",
        "analyze gap.toml --gum=text -o FILE",
        "analyze gap.toml --gum=csv -o FILE",
        "analyze gap.toml --gum=markdown -o FILE",
        "analyze gap.toml more.toml -o FILE --csv DIR --html pages --xlsx books",
        "analyze gap.toml more.toml --json -o FILE",
        "analyze gap.toml more.toml --stack=csv -o FILE",
        "analyze gap.toml more.toml --stack=markdown -o FILE",
        "analyze gap.toml more.toml --gum=csv -o FILE",
        "analyze gap.toml more.toml --compare -o FILE --csv DIR --html page.html",
        "analyze gap.toml more.toml --compare --json -o FILE",
        "simulate gap.toml --samples 1000 -o FILE --csv DIR --html page.html",
        "simulate gap.toml --samples 1000 --sobol -o FILE --csv DIR",
        "simulate gap.toml --samples 1000 --json -o FILE",
        "simulate gap.toml --rare -o FILE --csv DIR --html page.html",
        "simulate gap.toml --rare --json -o FILE",
        "compare gap.toml --samples 1000 -o FILE --csv DIR --svg chart.svg --html page.html",
        "compare gap.toml --samples 1000 --json -o FILE",
        "sweep gap.toml --over a=0.9:1.1:3 -o FILE --csv DIR --svg chart.svg --html page.html",
        "sweep gap.toml --over a=0.9:1.1:3 --json -o FILE",
        "allocate gap.toml --confirm 0 --front 3 -o FILE --csv DIR --svg chart.svg --html page.html",
        "allocate gap.toml --confirm 0 --json -o FILE",
        "plan gap.toml -o FILE --write-points points.csv",
        "plan gap.toml --method rss -o FILE",
        "plan gap.toml --json -o FILE",
        "probe gap.toml -o FILE",
        "probe gap.toml --json -o FILE",
        "pearson --skewness 0.3 --kurtosis 3 -o FILE",
        "pearson --skewness 0 --kurtosis 3 -o FILE",
        "pearson --skewness 0 --kurtosis 3 --json -o FILE",
        "models -o FILE",
        "models --json -o FILE",
        "models connecting-rod -o FILE",
        "models connecting-rod --json -o FILE",
        "schema -o FILE",
        "schema --report -o FILE",
    ] {
        std::fs::write(folder.path().join("report"), "").unwrap();
        for (index, _) in ["empty", "own", "own"].iter().enumerate() {
            let (code, error) = run(folder.path(), &line.replace("FILE", "report").replace("DIR", "tables"));
            assert!(code == 0, "{line}, time {index}: {error}");
        }
        let _ = std::fs::remove_dir_all(folder.path().join("tables"));
    }
}

/// A text, table, workbook, page, chart, list or study of someone else stays, whatever the option, unless `--force` is given.
#[test]
fn files_of_others_stay() {
    let folder = folder();
    let at = |name: &str| folder.path().join(name);
    let mut book = rust_xlsxwriter::Workbook::new();
    book.add_worksheet().write_string(0, 0, "Order list").unwrap();
    let book = book.save_to_buffer().unwrap();
    let others: [(&str, &[u8]); 9] = [
        ("theirs.xlsx", &book),
        ("theirs.zip", b"PK\x03\x04 no workbook at all"),
        ("theirs.txt", b"to do: order pins\n"),
        ("theirs.csv", b"part,a,b\n1,0.98,2.01\n"),
        ("theirs.html", b"<!DOCTYPE html><html><head><meta name=\"generator\" content=\"Hugo\"></head></html>"),
        ("theirs.svg", b"<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 9 9\"><title>Mine</title></svg>"),
        ("theirs.json", b"{\"schema\": 2, \"orders\": []}"),
        ("theirs.toml", STUDY.as_bytes()),
        ("theirs.bin", &[0xff, 0, 1, 2]),
    ];
    for (name, bytes) in others {
        std::fs::write(at(name), bytes).unwrap();
        let lines = [
            "analyze gap.toml -o FILE",
            "analyze gap.toml --json -o FILE",
            "analyze gap.toml --html FILE",
            "analyze gap.toml --xlsx FILE",
            "sweep gap.toml --over a=0.9:1.1:3 --svg FILE",
            "plan gap.toml --write-points FILE",
            "allocate gap.toml --confirm 0 --write FILE",
            "schema -o FILE",
        ];
        for line in lines {
            let (code, error) = run(folder.path(), &line.replace("FILE", name));
            // A workbook is not written under the name of another kind of file, forced or not.
            let is_forced = error.contains(&format!("`{name}`")) && error.contains("--force");
            let is_misnamed = ["--html", "--xlsx", "-o "].iter().any(|option| line.contains(option))
                && error.contains("theirs.")
                && ["write --", "write -o", "is written as"].iter().any(|right| error.contains(right));
            assert!(code == 2 && (is_forced || is_misnamed), "{line}: {error}");
            assert_eq!(std::fs::read(at(name)).unwrap(), bytes, "{line} {name}");
        }
    }
    // Tables of --csv are no exception.
    std::fs::create_dir(at("tables")).unwrap();
    std::fs::write(at("tables/warnings.csv"), "part,value\n1,2\n").unwrap();
    let (code, error) = run(folder.path(), "analyze gap.toml --csv tables");
    assert!(code == 2 && error.contains("warnings.csv"), "{error}");
    assert_eq!(std::fs::read_dir(at("tables")).unwrap().count(), 1);
    // Force is the user's word, except against files that the command reads.
    assert_eq!(run(folder.path(), "analyze gap.toml --csv tables --xlsx theirs.xlsx --force").0, 0);
    assert_ne!(std::fs::read(at("theirs.xlsx")).unwrap(), book);
    assert_eq!(run(folder.path(), "allocate gap.toml --confirm 0 --write theirs.toml --force").0, 0);
    let (code, error) = run(folder.path(), "analyze gap.toml -o gap.toml --force");
    assert!(code == 2 && error.contains("the study itself"), "{error}");
}

/// Measured data in the place of a table of `--csv` stay, even with `--force`.
#[test]
fn measured_data_stay_in_the_folder_of_tables() {
    let folder = folder();
    let data = "d\n0.9\n1.0\n1.1\n1.2\n0.8\n1.05\n";
    std::fs::write(folder.path().join("dimensions.csv"), data).unwrap();
    let study = STUDY.replace("a = { nominal = 1, ", "a = { measured = \"dimensions.csv\", nominal = 1, ");
    std::fs::write(folder.path().join("gap.toml"), study).unwrap();
    for line in ["analyze gap.toml --csv .", "analyze gap.toml --csv . --force"] {
        let (code, error) = run(folder.path(), line);
        assert!(code == 2 && error.contains("measured data of the study"), "{error}");
        assert_eq!(std::fs::read_to_string(folder.path().join("dimensions.csv")).unwrap(), data);
        assert!(!folder.path().join("characteristics.csv").exists());
    }
}

/// A disk that is full at one of the tables leaves none of them.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_leaves_no_table() {
    let folder = folder();
    let tables = folder.path().join("tables");
    std::fs::create_dir(&tables).unwrap();
    std::os::unix::fs::symlink("/dev/full", tables.join("quantiles.csv")).unwrap();
    let (code, error) = run(folder.path(), "analyze gap.toml --csv tables");
    assert!(code == 2 && error.contains("cannot be written"), "{error}");
    let left: Vec<_> = std::fs::read_dir(&tables).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(left, ["quantiles.csv"]);
}

/// Texts of a study and of a program are clipped in messages and reports.
#[cfg(unix)]
#[test]
fn long_texts_of_others_are_clipped() {
    let folder = folder();
    let long = "n".repeat(300_000);
    let texts = [
        format!("[dimensions]\na = {{ nominal = 1, {long} = 3 }}\n[characteristics]\ng = {{ formula = \"a\" }}\n"),
        format!(
            "[dimensions]\na = {{ nominal = 1, distribution = \"{long}\" }}\n[characteristics]\ng = {{ formula = \"a\" }}\n"
        ),
        format!("[dimensions]\na = {{ nominal = 1 }}\n[characteristics]\ng = {{ formula = \"a + {long}\" }}\n"),
        format!("[dimensions]\na = {{ nominal = 1 }}\n[characteristics]\ng = {{ formula = \"a + {long}(a)\" }}\n"),
        format!("[dimensions]\na = {{ nominal = \"{long}\n[characteristics]\n"),
        format!(
            "[dimensions]\na = {{ nominal = 1, tolerance = 1, cp = \"{long}\" }}\n[characteristics]\ng = {{ formula = \"a\" }}\n"
        ),
    ];
    for text in &texts {
        std::fs::write(folder.path().join("long.toml"), text).unwrap();
        let (code, error) = run(folder.path(), "check long.toml");
        let part: String = text.chars().take(60).collect();
        assert!(code == 2 && error.len() < 8000, "{} bytes: {part}", error.len());
    }
    // A program with a name of a megabyte refuses each point with as long an error.
    let script = "import json, sys\nsys.stdin.readline()\n\
                  print(json.dumps({'ready': True, 'sensitol': 1, 'name': 'n' * 1000000}), flush=True)\n\
                  for line in sys.stdin:\n    print(json.dumps({'id': json.loads(line)['id'], 'error': 'e' * 1000000}), flush=True)\n";
    std::fs::write(folder.path().join("model.py"), script).unwrap();
    let study = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[model]\ncommand = [\"python3\", \"model.py\"]\n[characteristics]\ng = {}\n";
    std::fs::write(folder.path().join("model.toml"), study).unwrap();
    for line in ["analyze model.toml --journal none", "analyze model.toml --json --journal none", "probe model.toml"] {
        let arguments: Vec<&str> = line.split(' ').collect();
        let output = sensitol(&arguments).current_dir(folder.path()).output().unwrap();
        let said = [output.stdout, output.stderr].concat();
        assert!(said.len() < 60_000, "{line}: {} bytes", said.len());
    }
}

/// A page, a text and a workbook are never written into a file of another kind: nothing is evaluated or written, and the right option is named.
#[test]
fn endings_of_other_kinds_are_refused() {
    let folder = folder();
    let cases = [
        ("analyze gap.toml --html page.pdf", "--pdf page.pdf"),
        ("analyze gap.toml --html page.json", "--json -o page.json"),
        ("analyze gap.toml --html study.toml", "--html study.html"),
        ("analyze gap.toml --pdf page.html", "--html page.html"),
        ("simulate gap.toml --html book.xlsx", "--html book.html"),
        ("allocate gap.toml --pdf page.htm", "--html page.htm"),
        ("compare gap.toml --html table.csv", "--html table.html"),
        ("analyze gap.toml --xlsx book.html", "book.xlsx"),
        ("analyze gap.toml -o page.html", "--html page.html"),
        ("simulate gap.toml -o page.PDF", "--pdf page.PDF"),
        ("analyze gap.toml -o book.xlsx", "--xlsx book.xlsx"),
        ("analyze gap.toml -o result.json", "--json -o result.json"),
        ("plan gap.toml -o page.html", "-o page.txt"),
        ("simulate gap.toml -o book.xlsx", "-o book.txt"),
        ("sweep gap.toml --over a=0.9:1.1:3 -o book.xlsx", "-o book.txt"),
        ("models -o models.json", "--json -o models.json"),
    ];
    for (line, right) in cases {
        let (code, fault) = run(folder.path(), line);
        assert!(code == 2 && fault.contains(right), "{line}: {code} {fault}");
        // Only `analyze` has the option for a workbook.
        assert!(line.starts_with("analyze") || !fault.contains("--xlsx"), "{line}: {fault}");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 2, "{line} wrote a file");
    }
    // The right ending, other endings and none are free.
    for line in [
        "analyze gap.toml --html page.htm",
        "analyze gap.toml -o report.txt",
        "analyze gap.toml -o report",
        "analyze gap.toml --json -o a.json",
    ] {
        let (code, fault) = run(folder.path(), line);
        assert_eq!(code, 0, "{line}: {fault}");
    }
}
