//! LibreOffice computes the stack of `analyze --xlsx` anew, and what it gives is the report; also where an input was changed in it.
//!
//! Skipped by name where LibreOffice is not installed.

use std::path::Path;
use std::process::Command;

use calamine::{Data, Reader, Xlsx, open_workbook};
use serde_json::Value;

use super::command::sensitol;
use super::help::{installed, skipped};
use sensitol_testing::close;

const STUDY: &str = "[dimensions]\ndepth = { nominal = 84.6, tolerance = 0.1, unit = \"mm\" }\n\
                     lip = { nominal = 4, tolerance = [-0.02, 0.05], distribution = \"uniform\", unit = \"mm\" }\n\
                     gear = { nominal = 18.5, tolerance = 0.0625, sigma = 0.01, unit = \"mm\" }\nring = { nominal = 2, sigma = 0.02, unit = \"mm\" }\n\
                     [characteristics]\nplay = { formula = \"depth - lip - 0.5*gear - ring\", unit = \"mm\", lower = 68.9, upper = 69.6 }\n";

/// Setting of LibreOffice to compute formulas when a file is opened, whatever values it has.
const ALWAYS: &str = r#"<?xml version="1.0" encoding="UTF-8"?>
<oor:items xmlns:oor="http://openoffice.org/2001/registry" xmlns:xs="http://www.w3.org/2001/XMLSchema" xmlns:xsi="http://www.w3.org/2001/XMLSchema-instance">
<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="OOXMLRecalcMode" oor:op="fuse"><value>0</value></prop></item>
<item oor:path="/org.openoffice.Office.Calc/Formula/Load"><prop oor:name="ODFRecalcMode" oor:op="fuse"><value>0</value></prop></item>
</oor:items>
"#;

/// Opens a file in LibreOffice and saves it in this format, in a folder below its own.
fn converted(file: &Path, format: &str) -> std::path::PathBuf {
    let folder = file.parent().unwrap();
    let profile = folder.join("profile/user");
    std::fs::create_dir_all(&profile).unwrap();
    if !profile.join("registrymodifications.xcu").exists() {
        std::fs::write(profile.join("registrymodifications.xcu"), ALWAYS).unwrap();
    }
    let to = folder.join(format!("to-{format}"));
    let output = Command::new("soffice")
        .arg(format!("-env:UserInstallation=file://{}", folder.join("profile").display()))
        .args(["--headless", "--norestore", "--convert-to", format, "--outdir"])
        .arg(&to)
        .arg(file)
        .output()
        .unwrap();
    let made = to.join(file.file_stem().unwrap()).with_extension(format);
    assert!(made.exists(), "{output:?}");
    made
}

/// Returns the number in a column of the row that begins with this name.
fn cell(path: &Path, name: &str, column: &str) -> f64 {
    let mut book: Xlsx<_> = open_workbook(path).unwrap();
    let range = book.worksheet_range("Stack").unwrap();
    let is = |data: &Data, text: &str| matches!(data, Data::String(found) if found == text);
    let place = range.rows().find_map(|row| row.iter().position(|cell| is(cell, column))).unwrap();
    let row = range.rows().find(|row| is(&row[0], name)).unwrap_or_else(|| panic!("no row {name}"));
    match row[place] {
        Data::Float(value) => value,
        Data::Int(value) => value as f64,
        ref other => panic!("{name}, {column}: {other:?}"),
    }
}

/// Compares every total of the sheet with the only characteristic of a report.
#[track_caller]
fn same(path: &Path, report: &Value) {
    let one = &report["characteristics"][0];
    let number = |pointer: &str| one.pointer(pointer).unwrap().as_f64().unwrap();
    // Sums of some numbers below 100, in another order and with 15 digits in the file.
    let is = |row: &str, column: &str, expected: f64| close(cell(path, row, column), expected, 1e-12, 1.0);
    is("worst case", "mean", number("/worst_case/linear/0"));
    is("worst case", "standard dev", number("/worst_case/linear/1"));
    is("rss", "half band", number("/rss"));
    is("inflated rss", "half band", number("/inflated_rss"));
    is("mean-shift rss", "half band", number("/mean_shift_rss"));
    is("second order, 3 sigma", "middle", number("/mean"));
    is("second order, 3 sigma", "half band", 3.0 * number("/sigma"));
    is("Cpk", "middle", number("/cpk"));
}

#[test]
fn libreoffice_computes_the_same_stack() {
    if !installed("soffice") {
        return skipped("LibreOffice is not installed: the formulas of --xlsx are not computed anew");
    }
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let report = |study: &str| -> Value {
        std::fs::write(at("study.toml"), study).unwrap();
        let (study, book) = (at("study.toml").display().to_string(), at("stack.xlsx").display().to_string());
        let output = sensitol(&["analyze", &study, "-m", "full", "--json", "--xlsx", &book]).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        serde_json::from_slice(&output.stdout).unwrap()
    };
    let as_it_was = report(STUDY);
    same(&at("stack.xlsx"), &as_it_was);
    // Saved as text, in which an input can be changed: both deviations of a dimension.
    let flat = converted(&at("stack.xlsx"), "fods");
    let text = std::fs::read_to_string(&flat).unwrap();
    std::fs::write(at("stack.fods"), &text).unwrap();
    same(&converted(&at("stack.fods"), "xlsx"), &as_it_was);
    let changed = text
        .replace("office:value=\"0.0625\"", "office:value=\"0.1875\"")
        .replace("office:value=\"-0.0625\"", "office:value=\"-0.1875\"");
    // Input and result of the half-width.
    assert!(text.matches("\"0.0625\"").count() >= 2 && changed != text);
    std::fs::write(at("stack.fods"), changed).unwrap();
    same(&converted(&at("stack.fods"), "xlsx"), &report(&STUDY.replace("0.0625", "0.1875")));
}
