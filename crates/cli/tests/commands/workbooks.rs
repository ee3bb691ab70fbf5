//! Workbooks in and out: `sensitol import FILE.xlsx` and `analyze --xlsx`.
//!
//! Oracles: rust_xlsxwriter and LibreOffice write what calamine reads here, and calamine reads what rust_xlsxwriter writes here; studies
//! written by hand; the JSON report; sums of a few numbers.

use std::path::Path;

use calamine::{Data, Reader, Xlsx, open_workbook};
use rust_xlsxwriter::{ExcelDateTime, Format, Formula, Workbook, Worksheet};
use sensitol::{Method, analyze};
use sensitol_study::Study;
use serde_json::Value;

use super::command::sensitol;
use sensitol_testing::{close, repository};

/// Returns stdout and stderr of a call that must end with this code.
fn run(code: i32, arguments: &[&str]) -> [String; 2] {
    let output = sensitol(arguments).args(["--color", "never"]).output().unwrap();
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    assert_eq!(output.status.code(), Some(code), "{arguments:?}: {error}");
    [out, error]
}

/// Writes a workbook whose first sheet is filled by `fill`.
fn made(folder: &Path, name: &str, fill: impl FnOnce(&mut Worksheet)) -> String {
    let mut book = Workbook::new();
    fill(book.add_worksheet());
    let path = folder.join(name);
    book.save(&path).unwrap();
    path.to_str().unwrap().to_owned()
}

fn imported(path: &str, more: &[&str]) -> String {
    let [study, _] = run(0, &[&["import", path], more].concat());
    study
}

/// Mean, sigma and worst case of the only characteristic.
fn figures(text: &str) -> [f64; 4] {
    let study = Study::from_toml(text, "stack").unwrap_or_else(|error| panic!("{error}\n{text}"));
    let one = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    let (moments, [low, high]) = (one.moments.unwrap(), one.range.worst_case.unwrap());
    [moments.mean(), moments.sigma(), low, high]
}

fn row(sheet: &mut Worksheet, line: u32, texts: &[&str]) {
    for (column, text) in (0u16..).zip(texts) {
        match text.parse::<f64>() {
            _ if text.is_empty() => {}
            Ok(value) => _ = sheet.write_number(line, column, value).unwrap(),
            Err(_) => _ = sheet.write_string(line, column, *text).unwrap(),
        }
    }
}

#[test]
fn a_workbook_becomes_a_study() {
    let folder = tempfile::tempdir().unwrap();
    let path = made(folder.path(), "stack.xlsx", |sheet| {
        row(sheet, 0, &["Axial play"]);
        row(
            sheet,
            2,
            &["name", "part", "drawing", "feature", "direction", "nominal [mm]", "tolerance", "distribution"],
        );
        row(sheet, 3, &["housing depth", "housing", "4711", "7", "1", "84.6", "0.1", ""]);
        row(sheet, 4, &["lip", "cover", "", "", "-", "", "+0,05/-0,02", "uniform"]);
        // Last computed value of a formula.
        sheet.write_formula(4, 5, Formula::new("=8/2").set_result("4")).unwrap();
        row(sheet, 5, &["gear", "", "", "", "-1", "18.5", "", ""]);
        sheet.write_number_with_format(5, 6, 0.002, &Format::new().set_num_format("0.0%")).unwrap();
        row(sheet, 6, &["sum", "", "", "", "", "", "", ""]);
        row(sheet, 7, &["shaft", "", "", "", "-", "62", "H7", ""]);
    });
    let study = imported(&path, &[]);
    assert!(study.starts_with("# Imported from stack.xlsx, sheet Sheet1."), "{study}");
    assert!(study.contains("part = \"housing\", drawing = \"4711\", feature = \"7\""), "{study}");
    let by_hand = "[dimensions]\n\"housing depth\" = { nominal = 84.6, tolerance = 0.1, unit = \"mm\" }\n\
                   lip = { nominal = 4, tolerance = [-0.02, 0.05], distribution = \"uniform\", unit = \"mm\" }\n\
                   gear = { nominal = 18.5, tolerance = \"0.2 %\", unit = \"mm\" }\nshaft = { nominal = 62, fit = \"H7\", unit = \"mm\" }\n\
                   [characteristics]\ngap = { formula = \"`housing depth` - lip - gear - shaft\", unit = \"mm\" }\n";
    assert_eq!(figures(&study), figures(by_hand), "{study}");
    // The same table, typed and saved in LibreOffice with German headers.
    let german = imported(repository("tests/data/workbooks/libreoffice.xlsx").to_str().unwrap(), &[]);
    assert_eq!(figures(&german), figures(by_hand), "{german}");
    assert!(german.contains("row 6 has no nominal value and was left out: Summe"), "{german}");
    // From stdin the table has no file name.
    let bytes = std::fs::read(&path).unwrap();
    let output =
        assert_cmd::Command::new(env!("CARGO_BIN_EXE_sensitol")).args(["import", "-"]).write_stdin(bytes).output();
    assert_eq!(figures(&String::from_utf8(output.unwrap().stdout).unwrap()), figures(by_hand));
}

#[test]
fn a_sheet_is_found_or_named() {
    let folder = tempfile::tempdir().unwrap();
    let mut book = Workbook::new();
    row(book.add_worksheet().set_name("Notes").unwrap(), 0, &["nothing here"]);
    for (name, nominal) in [("Stack", "10"), ("Old stack", "20")] {
        let sheet = book.add_worksheet().set_name(name).unwrap();
        row(sheet, 0, &["name", "nominal", "tol"]);
        row(sheet, 1, &["a", nominal, "0.1"]);
    }
    book.add_worksheet().set_name("Hidden").unwrap().set_hidden(true);
    let path = folder.path().join("book.xlsx").to_str().unwrap().to_owned();
    book.save(&path).unwrap();
    assert_eq!(figures(&imported(&path, &[]))[0], 10.0);
    assert_eq!(figures(&imported(&path, &["--sheet", "Old stack"]))[0], 20.0);
    let [_, error] = run(2, &["import", &path, "--sheet", "Old stak"]);
    assert!(error.contains("did you mean `Old stack`?") && error.contains("`Notes`, `Stack`"), "{error}");
}

#[test]
fn faults_of_workbooks_name_their_cell() {
    let folder = tempfile::tempdir().unwrap();
    let header = ["name", "nominal", "tol"];
    let fault = |name: &str, fill: &dyn Fn(&mut Worksheet)| {
        let path = made(folder.path(), &format!("{name}.xlsx"), |sheet| {
            row(sheet, 0, &header);
            row(sheet, 1, &["a", "10", "0.1"]);
            row(sheet, 2, &["b", "20", "0.1"]);
            fill(sheet);
        });
        let [_, error] = run(2, &["import", &path]);
        error.split_once(".xlsx: ").unwrap_or_else(|| panic!("{error}")).1.to_owned()
    };
    let date = |sheet: &mut Worksheet| {
        let day = ExcelDateTime::from_ymd(2026, 2, 1).unwrap();
        sheet.write_datetime_with_format(2, 2, &day, &Format::new().set_num_format("d-mmm")).unwrap();
    };
    let percent = |sheet: &mut Worksheet| {
        sheet.write_number_with_format(2, 1, 0.02, &Format::new().set_num_format("0%")).unwrap();
    };
    let broken = |sheet: &mut Worksheet| {
        sheet.write_formula(2, 1, Formula::new("=#REF!+1").set_result("#REF!")).unwrap();
    };
    let all = [
        fault("date", &date),
        fault("percent", &percent),
        fault("broken", &broken),
        fault("truth", &|sheet| {
            sheet.write_boolean(2, 1, true).unwrap();
        }),
        fault("styles", &|sheet| {
            sheet.write_string(1, 2, "0.5").unwrap();
            sheet.write_string(2, 2, "0,5").unwrap();
        }),
        fault("limits", &|sheet| {
            sheet.write_string(3, 0, "total").unwrap();
            sheet.write_number(3, 1, 31.0).unwrap();
        }),
        fault("header", &|sheet| {
            sheet.write_string(0, 1, "Ist").unwrap();
        }),
    ];
    insta::assert_snapshot!(all.join("\n"));
}

/// Returns a compound file with the directory of an encrypted workbook ([MS-CFB] 2.2 to 2.6, [MS-OFFCRYPTO] 2.3): a table of sectors, a
/// directory of three entries, and eight empty sectors of the package.
fn encrypted() -> Vec<u8> {
    let [free, end, table] = [0xffff_ffff_u32, 0xffff_fffe, 0xffff_fffd];
    let mut file = b"\xd0\xcf\x11\xe0\xa1\xb1\x1a\xe1".to_vec();
    file.extend([0; 16]);
    // Version 3, little-endian, sectors of 2^9 and 2^6 bytes.
    file.extend([0x3e, 0, 3, 0, 0xfe, 0xff, 9, 0, 6, 0, 0, 0, 0, 0, 0, 0]);
    file.extend([0, 1, 1, 0, 4096, end, 0, end, 0, 0].map(u32::to_le_bytes).concat());
    file.resize(512, 0xff);
    let table = [table, end].into_iter().chain(3..10).chain([end]).map(u32::to_le_bytes);
    file.extend(table.flatten());
    file.resize(1024, free as u8);
    for (name, kind, start, size) in
        [("Root Entry", 5, end, 0), ("EncryptionInfo", 2, end, 0), ("EncryptedPackage", 2, 2, 4096u32)]
    {
        let mut entry: Vec<u8> = name.encode_utf16().flat_map(u16::to_le_bytes).collect();
        entry.resize(64, 0);
        entry.extend([(name.len() * 2 + 2) as u8, 0, kind, 1]);
        entry.extend([free, free, free].map(u32::to_le_bytes).concat());
        entry.resize(116, 0);
        entry.extend([start, size, 0].map(u32::to_le_bytes).concat());
        file.extend(entry);
    }
    file.resize(512 * 11, 0);
    file
}

#[test]
fn files_that_are_no_workbook_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let whole = made(folder.path(), "whole.xlsx", |sheet| {
        row(sheet, 0, &["name", "nominal"]);
        (1..200).for_each(|line| row(sheet, line, &[&format!("d{line}"), "10"]));
    });
    let bytes = std::fs::read(&whole).unwrap();
    std::fs::write(at("half.xlsx"), &bytes[..bytes.len() / 2]).unwrap();
    std::fs::write(at("nothing.xlsx"), "").unwrap();
    made(folder.path(), "empty.xlsx", |_| {});
    std::fs::write(at("stack.csv"), "name,nominal\na,10\n").unwrap();
    std::fs::write(at("picture.xlsx"), [0x89, 0x50, 0x4e, 0x47, 0xff]).unwrap();
    std::fs::write(at("protected.xlsx"), encrypted()).unwrap();
    let data = |name: &str| repository("tests/data/workbooks").join(name).to_str().unwrap().to_owned();
    for (path, more, words) in [
        (at("protected.xlsx"), vec![], ["protected by a password", "save a copy without the password"]),
        (data("excel-97.xls"), vec![], ["in the format of Excel 97 to 2003, .xls", "save it as .xlsx"]),
        (data("open-document.ods"), vec![], ["an OpenDocument spreadsheet", "save it as .xlsx"]),
        (at("half.xlsx"), vec![], ["damaged", "save it as .xlsx again"]),
        (at("nothing.xlsx"), vec![], ["the table is empty", ""]),
        (at("empty.xlsx"), vec![], ["the table is empty", ""]),
        (at("picture.xlsx"), vec![], ["neither a workbook nor text", "save it as .xlsx or as CSV"]),
        (at("stack.csv"), vec!["--sheet", "Stack"], ["--sheet is for workbooks", ""]),
        (at("missing.xlsx"), vec![], ["No such file", ""]),
    ] {
        let [_, error] = run(2, &[&["import", path.as_str()], more.as_slice()].concat());
        assert!(words.iter().all(|word| error.contains(word)), "{path}: {error}");
        // One error, without details of the program.
        assert!(error.lines().count() <= 4 && !error.contains("panicked"), "{error}");
    }
    // A single cell in the last corner takes no memory for the empty ones before it.
    let corner = made(folder.path(), "corner.xlsx", |sheet| {
        row(sheet, 0, &["name", "nominal"]);
        row(sheet, 1, &["a", "10"]);
        sheet.write_string(1_048_575, 16_383, "far away").unwrap();
    });
    assert!(imported(&corner, &["--allow-fixed"]).contains("row 1048576 has no nominal value"));
}

const STACK: &str = "title = \"=1+1\"\n[about]\npart = \"Gearbox\"\n[dimensions]\n\
                     \"housing depth\" = { nominal = 84.6, tolerance = 0.1, unit = \"mm\", part = \"=HYPERLINK(A1)\", drawing = \"4711\" }\n\
                     lip = { nominal = 4, tolerance = [-0.02, 0.05], distribution = \"uniform\", unit = \"mm\" }\n\
                     gear = { nominal = 18.5, tolerance = 0.04, sigma = 0.01, unit = \"mm\" }\n\
                     ring = { nominal = 2, sigma = 0.02, unit = \"mm\" }\nshim = { nominal = 0.5, unit = \"mm\" }\n\
                     [characteristics]\nplay = { formula = \"`housing depth` - lip - 2*gear - ring - shim\", unit = \"mm\", lower = 40.7, upper = 41.4, target_yield = 0.99 }\n";

/// Writes a report as JSON and as a workbook.
fn reported(folder: &Path, study: &str) -> (Value, Xlsx<std::io::BufReader<std::fs::File>>, String) {
    let at = |name: &str| folder.join(name).to_str().unwrap().to_owned();
    std::fs::write(at("study.toml"), study).unwrap();
    let [json, _] = run(0, &["analyze", &at("study.toml"), "-m", "full", "--json", "-v", "--xlsx", &at("report.xlsx")]);
    (serde_json::from_str(&json).unwrap(), open_workbook(at("report.xlsx")).unwrap(), at("report.xlsx"))
}

/// Returns the rows of a sheet as pairs of header and cell.
fn objects(book: &mut Xlsx<std::io::BufReader<std::fs::File>>, sheet: &str) -> Vec<Vec<(String, Data)>> {
    let range = book.worksheet_range(sheet).unwrap();
    let mut rows = range.rows();
    let header: Vec<String> = rows.next().unwrap().iter().map(ToString::to_string).collect();
    rows.map(|row| header.iter().cloned().zip(row.iter().cloned()).collect()).collect()
}

/// Returns the cell of a column.
fn cell(row: &[(String, Data)], column: &str) -> Data {
    row.iter().find(|(name, _)| name == column).unwrap_or_else(|| panic!("no column {column}")).1.clone()
}

#[test]
fn a_workbook_is_the_report() {
    let folder = tempfile::tempdir().unwrap();
    let (json, mut book, _) = reported(folder.path(), STACK);
    assert_eq!(
        book.sheet_names(),
        ["Stack", "Results", "Contributions", "Joint", "Inputs", "Study"],
        "warnings have a sheet where there are some: {:?}",
        json["warnings"]
    );
    // Numbers are written with all their digits.
    let same = |found: Data, expected: &Value| match (&found, expected) {
        (Data::Empty, Value::Null) => true,
        (Data::Float(found), Value::Number(expected)) => Some(*found) == expected.as_f64(),
        (Data::String(found), Value::String(expected)) => found == expected,
        (Data::Bool(found), Value::Bool(expected)) => found == expected,
        _ => false,
    };
    let one = &json["characteristics"][0];
    let results = objects(&mut book, "Results");
    assert_eq!(results.len(), 1);
    for (column, pointer) in [
        ("name", "/name"),
        ("mean", "/mean"),
        ("sigma", "/sigma"),
        ("rss", "/rss"),
        ("worst_case_lower", "/worst_case/linear/0"),
        ("yield", "/yield"),
        ("cpk", "/cpk"),
        ("lower", "/lower"),
        ("met", "/met"),
    ] {
        let expected = one.pointer(pointer).unwrap_or_else(|| panic!("{pointer}: {one:#}"));
        assert!(same(cell(&results[0], column), expected), "{column}: {:?} {expected}", cell(&results[0], column));
    }
    let contributions = objects(&mut book, "Contributions");
    for (row, expected) in contributions.iter().zip(one["sensitivities"].as_array().unwrap()) {
        for column in ["dimension", "first", "second", "linear_share", "mean_shift"] {
            assert!(same(cell(row, column), &expected[column]), "{column}: {row:?}");
        }
    }
    let inputs = objects(&mut book, "Inputs");
    assert_eq!(inputs.len(), 5);
    for (row, expected) in inputs.iter().zip(json["dimensions"].as_array().unwrap()) {
        for column in ["name", "unit", "nominal", "mean", "sigma", "distribution"] {
            assert!(same(cell(row, column), &expected[column]), "{column}: {row:?}");
        }
    }
    // Text that looks like a formula is written as text, in the title and in a part. Only the stack has formulas.
    assert_eq!(cell(&inputs[0], "part"), Data::String("=HYPERLINK(A1)".to_owned()));
    for sheet in ["Results", "Contributions", "Joint", "Inputs", "Study"] {
        assert!(book.worksheet_formula(sheet).unwrap().used_cells().next().is_none(), "{sheet}");
    }
    let study = objects(&mut book, "Study");
    let of = |name: &str| study.iter().find(|row| row[0].1 == Data::String(name.to_owned())).unwrap()[1].1.clone();
    assert_eq!((of("title"), of("Part")), (Data::String("=1+1".to_owned()), Data::String("Gearbox".to_owned())));
    assert!(same(of("study_sha256"), &json["study_sha256"]));
}

/// Returns the number in a column of the row that begins with this name.
fn total(book: &mut Xlsx<std::io::BufReader<std::fs::File>>, sheet: &str, name: &str, column: &str) -> f64 {
    let range = book.worksheet_range(sheet).unwrap();
    let is = |data: &Data, text: &str| matches!(data, Data::String(found) if found == text);
    let place = range.rows().find_map(|row| row.iter().position(|cell| is(cell, column))).unwrap();
    let row = range.rows().find(|row| is(&row[0], name)).unwrap_or_else(|| panic!("no row {name}"));
    match row[place] {
        Data::Float(value) => value,
        ref other => panic!("{name}, {column}: {other:?}"),
    }
}

#[test]
fn the_stack_has_formulas_with_their_values() {
    let folder = tempfile::tempdir().unwrap();
    let (json, mut book, _) = reported(folder.path(), STACK);
    let one = &json["characteristics"][0];
    let number = |pointer: &str| one.pointer(pointer).unwrap().as_f64().unwrap();
    let formulas: Vec<String> =
        book.worksheet_formula("Stack").unwrap().used_cells().map(|cell| cell.2.clone()).collect();
    // Four dimensions with six formulas each, a constant with two, five totals with four, and Cpk.
    assert!(formulas.len() == 47 && formulas.iter().any(|formula| formula.contains("SUMSQ")), "{formulas:?}");
    let [low, high] = [number("/worst_case/linear/0"), number("/worst_case/linear/1")];
    // Sums of five numbers below 100 in another order: some units in the last place.
    const CLOSE: f64 = 1e-13;
    let mut is =
        |row: &str, column: &str, expected: f64| close(total(&mut book, "Stack", row, column), expected, CLOSE, 100.0);
    is("worst case", "mean", low);
    is("worst case", "standard dev", high);
    is("rss", "half band", number("/rss"));
    is("inflated rss", "half band", 1.5 * number("/rss"));
    is("mean-shift rss", "half band", number("/mean_shift_rss"));
    is("second order, 3 sigma", "middle", number("/mean"));
    is("second order, 3 sigma", "half band", 3.0 * number("/sigma"));
    is("Cpk", "middle", number("/cpk"));
    is("gear", "standard dev", 0.01);
    // Uniform distribution: a third of the range times sqrt 3.
    is("lip", "standard dev", 0.035 / 3f64.sqrt());
    // The shim does not vary, and makes the remainder.
    is("constant", "nominal", -0.5);
}

#[test]
fn what_a_sheet_cannot_compute_is_a_number() {
    let folder = tempfile::tempdir().unwrap();
    let study = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 5, tolerance = 0.4 }\n\
                 c = { nominal = 5, tolerance = 0.4 }\n[[correlation]]\nbetween = [\"b\", \"c\"]\nvalue = 0.5\n[characteristics]\n\
                 \"a*b/[1]\" = { formula = \"a*b\" }\nsum = { formula = \"b + c\" }\nA_B__1_ = { formula = \"a\" }\n";
    let (json, mut book, _) = reported(folder.path(), study);
    assert_eq!(book.sheet_names()[..3], ["Stack a_b__1_", "Stack sum", "Stack A_B__1_ 2"]);
    let number = |place: usize, key: &str| json["characteristics"][place][key].as_f64().unwrap();
    // The product is nonlinear: the tangent has formulas, the moments are those of the report.
    let sheet = "Stack a_b__1_";
    close(
        total(&mut book, sheet, "first order, 3 sigma", "half band"),
        3.0 * (5.0f64 * 0.1).hypot(10.0 * 0.4 / 3.0),
        1e-13,
        1.0,
    );
    assert_eq!(total(&mut book, sheet, "second order, 3 sigma, as reported", "half band"), 3.0 * number(0, "sigma"));
    // The sum varies more than its parts would independently.
    assert_eq!(total(&mut book, "Stack sum", "rss, as reported", "half band"), number(1, "rss"));
    let worst = total(&mut book, "Stack sum", "worst case", "half band");
    close(worst, 0.8, 1e-13, 1.0);
    let joint = book.worksheet_range("Joint").unwrap();
    let pairs = json["characteristic_correlation"].as_array().unwrap();
    assert!(
        !pairs.is_empty()
            && pairs.iter().all(|pair| {
                let value = pair["value"].as_f64();
                joint.rows().any(|row| matches!(row[2], Data::Float(found) if Some(found) == value))
            }),
        "{pairs:?} {joint:?}"
    );
}

#[test]
fn a_stack_goes_round() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(
        at("stack.csv"),
        "name;Bauteil;Beschreibung;Faktor;Nennmaß;Tol +;Tol -;Einheit;Verteilung;Merkmal\n\
         Tiefe;Gehäuse;gebohrt;1;84,6;0,1;0,1;mm;;7\nSteg;Deckel;;-1;4;0,05;0,02;mm;Gleichverteilung;\nRad 2;;;-0,5;18,55;0,04;0,04;mm;;\n",
    )
    .unwrap();
    run(0, &["import", &at("stack.csv"), "-o", &at("first.toml")]);
    let first = std::fs::read_to_string(at("first.toml")).unwrap();
    let (_, _, book) = reported(folder.path(), &first);
    run(0, &["import", &book, "-o", &at("second.toml")]);
    let second = std::fs::read_to_string(at("second.toml")).unwrap();
    // The title of the sheet becomes that of the study.
    let is_key = |line: &&str| !line.starts_with('#') && !line.starts_with("title") && !line.is_empty();
    let keys = |text: &str| text.lines().filter(is_key).map(str::to_owned).collect::<Vec<_>>();
    assert_eq!(keys(&first), keys(&second));
    // A dimension with a sigma of its own, one without a band, and a fixed one.
    let study = STACK.replace("=HYPERLINK(A1)", "housing");
    let (_, _, book) = reported(folder.path(), &study);
    let again = imported(&book, &["--name", "play", "--allow-fixed"]);
    for (found, expected) in figures(&again).into_iter().zip(figures(&study)) {
        // Sums in the same order; the formula has another form.
        close(found, expected, 1e-14, 100.0);
    }
}

#[test]
fn workbooks_are_written_as_other_files_are() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(at("a.toml"), STACK).unwrap();
    std::fs::write(at("b.toml"), STACK).unwrap();
    // Several studies: a folder.
    run(0, &["analyze", &at("a.toml"), &at("b.toml"), "--xlsx", &at("books")]);
    for name in ["a", "b"] {
        let book: Xlsx<_> = open_workbook(at(&format!("books/{name}.xlsx"))).unwrap();
        assert_eq!(book.sheet_names()[0], "Stack");
    }
    let [_, error] = run(2, &["analyze", &at("a.toml"), &at("b.toml"), "--xlsx", &at("one.xlsx")]);
    assert!(error.contains("--xlsx") && error.contains("need a folder for their workbooks"), "{error}");
    let [_, error] = run(2, &["analyze", &at("a.toml"), "--xlsx", &at("a.toml")]);
    assert!(error.contains("a workbook is written as .xlsx"), "{error}");
    assert_eq!(std::fs::read_to_string(at("a.toml")).unwrap(), STACK);
    let [_, error] = run(2, &["analyze", &at("a.toml"), "--xlsx", &at("x.xlsx"), "-o", &at("x.xlsx")]);
    assert!(error.contains("x.xlsx") && !Path::new(&at("x.xlsx")).exists(), "{error}");
    let [_, error] = run(2, &["analyze", &at("a.toml"), "--xlsx", &at("nowhere/x.xlsx")]);
    assert!(error.contains("there is no folder"), "{error}");
    // No temporary file is left beside the workbook.
    run(0, &["analyze", &at("a.toml"), "--xlsx", &at("x.xlsx")]);
    let left = std::fs::read_dir(folder.path())
        .unwrap()
        .filter(|file| file.as_ref().unwrap().file_name().to_string_lossy().starts_with(".sensitol"));
    assert_eq!(left.count(), 0);
}
