//! `--pdf`: the page printed by a browser, which a script stands for here. `tests/browser` prints by Chromium itself.

use std::os::unix::fs::PermissionsExt;
use std::path::Path;

use super::command::sensitol;

const STUDY: &str = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\nb = { nominal = 2, tolerance = 0.1 }\n\
                     [characteristics]\ng = { formula = \"a + b\", lower = 2.8, upper = 3.2 }\n";

/// Browser that copies the page behind the first line of a PDF.
const COPIES: &str = "#!/bin/sh\nfor word in \"$@\"; do case $word in --print-to-pdf=*) to=${word#--print-to-pdf=} ;; esac; from=$word; done\n\
                      { echo %PDF-1.4; cat \"$from\"; } > \"$to\"\n";

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("gap.toml"), STUDY).unwrap();
    std::fs::write(folder.path().join("more.toml"), STUDY).unwrap();
    program(&folder.path().join("copies"), COPIES);
    folder
}

fn program(path: &Path, text: &str) {
    std::fs::write(path, text).unwrap();
    std::fs::set_permissions(path, std::fs::Permissions::from_mode(0o755)).unwrap();
}

/// Runs in a folder with the browser of this name, and returns exit code and stderr.
fn run(folder: &Path, browser: &str, line: &str) -> (i32, String) {
    let arguments: Vec<&str> = line.split(' ').collect();
    let output = sensitol(&arguments)
        .current_dir(folder)
        .env("SENSITOL_CHROMIUM", folder.join(browser))
        .env("LC_ALL", "C")
        .output()
        .unwrap();
    (output.status.code().unwrap(), String::from_utf8(output.stderr).unwrap())
}

/// Every command with `--html` prints. The print has the paper of the locale, which the policy of the page allows.
#[test]
fn pages_are_printed() {
    let folder = folder();
    for line in [
        "analyze gap.toml --pdf FILE",
        "analyze gap.toml --html page.html --pdf FILE",
        "simulate gap.toml --samples 500 --pdf FILE",
        "simulate gap.toml --rare --samples 200 --pdf FILE",
        "compare gap.toml --samples 500 --budget 50 --pdf FILE",
        "sweep gap.toml --over a=0.9:1.1:3 --pdf FILE",
        "analyze gap.toml more.toml --compare --pdf FILE",
    ] {
        let (code, said) = run(folder.path(), "copies", line);
        assert_eq!(code, 0, "{line}: {said}");
        let print = std::fs::read_to_string(folder.path().join("FILE")).unwrap();
        assert!(print.starts_with("%PDF-1.4\n<!DOCTYPE html>") && print.contains("size: A4; }"), "{line}: {print}");
        assert!(print.ends_with("% report of sensitol\n"), "{line}");
    }
    let output = sensitol(&["analyze", "gap.toml", "--pdf", "FILE", "-q"])
        .current_dir(folder.path())
        .env("SENSITOL_CHROMIUM", folder.path().join("copies"))
        .env("LC_ALL", "en_US.UTF-8")
        .output()
        .unwrap();
    assert!(output.status.success(), "{output:?}");
    assert!(std::fs::read_to_string(folder.path().join("FILE")).unwrap().contains("size: letter; }"));
}

#[test]
fn several_studies_are_printed_into_a_folder() {
    let folder = folder();
    let (code, said) = run(folder.path(), "copies", "analyze gap.toml more.toml --pdf prints");
    assert_eq!(code, 0, "{said}");
    for name in ["gap.pdf", "more.pdf"] {
        assert!(std::fs::read(folder.path().join("prints").join(name)).unwrap().starts_with(b"%PDF"), "{name}");
    }
    let (code, said) = run(folder.path(), "copies", "analyze gap.toml more.toml --pdf both.pdf");
    assert!(code == 2 && said.contains("--pdf both.pdf is the name of one print"), "{said}");
}

/// A print of somebody else stays, unless `--force` is given.
#[test]
fn prints_of_others_stay() {
    let folder = folder();
    let file = folder.path().join("drawing.pdf");
    std::fs::write(&file, "%PDF-1.7\n%%EOF\n").unwrap();
    let (code, said) = run(folder.path(), "copies", "analyze gap.toml --pdf drawing.pdf");
    assert!(code == 2 && said.contains("no report of sensitol that may be written over"), "{said}");
    assert_eq!(std::fs::read_to_string(&file).unwrap(), "%PDF-1.7\n%%EOF\n");
    let (code, said) = run(folder.path(), "copies", "analyze gap.toml --pdf drawing.pdf --force");
    assert_eq!(code, 0, "{said}");
    assert!(std::fs::read_to_string(&file).unwrap().contains("<!DOCTYPE html>"));
}

/// Without a browser nothing is evaluated and nothing is written.
#[test]
fn no_browser_is_one_error() {
    let folder = folder();
    let (code, said) = run(folder.path(), "nowhere", "analyze gap.toml --html page.html --pdf print.pdf");
    assert!(
        code == 2 && said.contains("which SENSITOL_CHROMIUM names") && said.contains("print it from a browser"),
        "{said}"
    );
    let output = sensitol(&["analyze", "gap.toml", "--pdf", "print.pdf"])
        .current_dir(folder.path())
        .env_remove("SENSITOL_CHROMIUM")
        .env("PATH", folder.path())
        .output()
        .unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{said}");
    assert!(output.stdout.is_empty() && said.contains("there is none on PATH"), "{said}");
    assert!(!folder.path().join("print.pdf").exists() && !folder.path().join("page.html").exists());
}

/// A browser that fails, and one that writes something else, leave no print. The report is printed on stdout all the same.
#[test]
fn a_failed_print_is_one_error() {
    let folder = folder();
    program(&folder.path().join("fails"), "#!/bin/sh\nexit 3\n");
    program(&folder.path().join("idle"), "#!/bin/sh\n");
    for (browser, reason) in [("fails", "it ended with exit status: 3"), ("idle", "it wrote no PDF")] {
        let (code, said) = run(folder.path(), browser, "analyze gap.toml --pdf print.pdf");
        assert!(code == 2 && said.contains("did not print the page") && said.contains(reason), "{browser}: {said}");
        assert!(!folder.path().join("print.pdf").exists(), "{browser}");
    }
}
