//! `sensitol import` refuses to guess: signs, units, columns, quantities, totals and limits of stack-up tables.
//!
//! Oracle: sums and worst cases in decimal arithmetic (`tests/data/stack-tables`), and sums of a few numbers written beside the tests.

use assert_cmd::Command;
use rust_xlsxwriter::{Format, Workbook};
use sensitol::{Method, analyze};
use sensitol_study::Study;
use serde_json::Value;

use super::command::sensitol;
use sensitol_testing::{close, repository};

/// Relative rounding errors of sums of four doubles.
const ROUNDING: f64 = 1e-14;

/// Result of `sensitol import -`: stdout, or stderr of a refusal; and what was read.
fn import(table: &str, more: &[String]) -> Result<[String; 2], String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sensitol"));
    let output = command.args(["import", "-", "--color", "never"]).args(more).write_stdin(table).output().unwrap();
    let [out, error] = [output.stdout, output.stderr].map(|bytes| String::from_utf8(bytes).unwrap());
    if output.status.code() == Some(0) { Ok([out, error]) } else { Err(error) }
}

fn imported(table: &str, more: &[&str]) -> [String; 2] {
    let more: Vec<String> = more.iter().map(|word| (*word).to_owned()).collect();
    import(table, &more).unwrap_or_else(|error| panic!("{table}\n{error}"))
}

/// Nominal value and worst case of the only characteristic, and its unit.
fn figures(text: &str) -> ([f64; 3], Option<String>) {
    let study = Study::from_toml(text, "stack").unwrap_or_else(|error| panic!("{error}\n{text}"));
    let one = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    let ([low, high], unit) = (one.range.worst_case.unwrap(), one.characteristic.unit().map(str::to_owned));
    let nominal = one.nominal.unwrap();
    ([nominal, low, high], unit)
}

/// Compares nominal value, worst case and unit to a case of `headers.json` or `three-tables.json`.
fn agrees(text: &str, case: &Value, of: &str) {
    let (found, unit) = figures(text);
    let expected = [&case["gap"], &case["worst_case"][0], &case["worst_case"][1]].map(|value| value.as_f64().unwrap());
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() <= ROUNDING * 40.0, "{of}: {found} is not {expected}\n{text}");
    }
    assert_eq!(unit.as_deref(), case["unit"].as_str(), "{of}\n{text}");
}

fn data(name: &str) -> String {
    std::fs::read_to_string(repository("tests/data/stack-tables").join(name)).unwrap()
}

#[test]
fn three_tables_that_were_read_wrongly() {
    let cases: Value = serde_json::from_str(&data("three-tables.json")).unwrap();
    for (name, case) in cases.as_object().unwrap() {
        let [text, _] = imported(&data(name), &[]);
        agrees(&text, case, name);
    }
}

#[test]
fn header_rows_of_public_tools_are_read_or_refused_with_the_way_out() {
    let cases: Value = serde_json::from_str(&data("headers.json")).unwrap();
    let cases = cases["cases"].as_array().unwrap();
    assert!(cases.len() >= 30);
    let mut whole = 0;
    for case in cases {
        let (source, table) = (case["source"].as_str().unwrap(), case["table"].as_str().unwrap());
        let Some(refused) = case["refused"].as_str() else {
            let [text, _] = import(table, &[]).unwrap_or_else(|error| panic!("{source}: {error}"));
            agrees(&text, case, source);
            whole += 1;
            continue;
        };
        let error = import(table, &[]).expect_err(source);
        assert!(error.contains(refused) && error.contains("help:"), "{source}: {error}");
        let Some(way_out) = case["way_out"].as_array() else { continue };
        assert!(error.contains("--column"), "{source}: {error}");
        let way_out: Vec<String> = way_out.iter().map(|word| word.as_str().unwrap().to_owned()).collect();
        let [text, _] = import(table, &way_out).unwrap_or_else(|error| panic!("{source}: {error}"));
        agrees(&text, case, source);
    }
    assert!(whole >= 15, "{whole}");
}

#[test]
fn one_signed_deviation_is_one_sided() {
    let table = "Bezeichnung;Nennmaß;Toleranz\na;10;-0,12\nb;20;+0,14\nc;30;0,1/0,2\nd;5;0,1\ne;6;+0,3/+0,1\n";
    let [text, read] = imported(table, &[]);
    for line in [
        "tolerance = [-0.12, 0.0]",
        "tolerance = [0.0, 0.14]",
        "tolerance = [-0.2, 0.1]",
        "tolerance = 0.1",
        "tolerance = [0.1, 0.3]",
    ] {
        assert!(text.contains(line), "{line}: {text}");
    }
    assert!(read.contains("5 rows, 2 one-sided, no unit, no limits"), "{read}");
    // Numbers of a workbook: the sign, or a format that shows one.
    let folder = tempfile::tempdir().unwrap();
    let mut book = Workbook::new();
    let sheet = book.add_worksheet();
    for (column, header) in (0u16..).zip(["name", "nominal [mm]", "tolerance"]) {
        sheet.write_string(0, column, header).unwrap();
    }
    for (line, name) in (1..).zip(["a", "b", "c"]) {
        sheet.write_string(line, 0, name).unwrap();
        sheet.write_number(line, 1, 10.0).unwrap();
    }
    sheet.write_number(1, 2, -0.12).unwrap();
    sheet.write_number_with_format(2, 2, 0.14, &Format::new().set_num_format("+0.00;-0.00")).unwrap();
    sheet.write_number(3, 2, 0.1).unwrap();
    let path = folder.path().join("signs.xlsx");
    book.save(&path).unwrap();
    let output = sensitol(&["import", path.to_str().unwrap()]).output().unwrap();
    let text = String::from_utf8(output.stdout).unwrap();
    for line in ["tolerance = [-0.12, 0.0]", "tolerance = [0.0, 0.14]", "tolerance = 0.1"] {
        assert!(text.contains(line), "{line}: {text}");
    }
}

#[test]
fn units_of_columns_are_converted() {
    let table = "Bezeichnung;Nennmaß [mm];Toleranz [µm];Sigma [µm]\na;10;5;\nb;20;-12;2\n";
    let [text, _] = imported(table, &[]);
    assert!(text.contains("tolerance = 0.005, unit = \"mm\""), "{text}");
    assert!(text.contains("tolerance = [-0.012, 0.0], unit = \"mm\", sigma = 0.002"), "{text}");
    let [text, _] = imported("name,nominal,tol mil,unit\na,1,2,in\n", &[]);
    assert!(text.contains("tolerance = 0.002, unit = \"in\""), "{text}");
    let [text, _] = imported("name,nominal,tol %\na,50,2\n", &[]);
    assert!(text.contains("tolerance = \"2%\""), "{text}");
    let [text, _] = imported("Alle Maße in mm;;\nBezeichnung;Nennmaß;Toleranz [µm]\na;10;5\n", &[]);
    assert!(text.contains("tolerance = 0.005, unit = \"mm\""), "{text}");
}

#[test]
fn equal_parts_and_equal_names_are_dimensions_of_their_own() {
    let [text, read] = imported("name,qty,nominal,tol,dir\ndisc,3,2,0.1,+\nspace,,7,0.2,-\nspace,,1,0.2,+\n", &[]);
    // 3 x 2 - 7 + 1, and 3 x 0.1 + 0.2 + 0.2.
    let ([nominal, low, high], _) = figures(&text);
    close(nominal, 0.0, 1e-14, 1.0);
    close(low, -0.7, 1e-14, 1.0);
    close(high, 0.7, 1e-14, 1.0);
    let study = Study::from_toml(&text, "stack").unwrap();
    let found = analyze(&study.problem, &Method::Full.into()).unwrap();
    let sigma = found.characteristics[0].moments.unwrap().sigma();
    // Independent: sqrt(3 x 0.1^2 + 2 x 0.2^2)/3, where 3 times one dimension has sqrt(0.3^2 + 2 x 0.2^2)/3.
    close(sigma, 0.11f64.sqrt() / 3.0, 1e-12, 1.0);
    assert!(read.contains("3 rows, 5 dimensions, 1 subtracted"), "{read}");
    assert!(text.contains("\"space 2\"") && read.contains("equal names were numbered: `space 2` of row 4"), "{read}");
}

/// Many rows with one name take one pass, and messages name a few of them.
#[test]
fn many_equal_names_are_numbered_in_one_pass() {
    let rows: String = (0..100_000).map(|_| "plate,1,0.1\n").collect();
    let [text, read] = imported(&format!("name,nominal,tolerance\n{rows}"), &[]);
    assert!(text.contains("\"plate 100000\" = "), "{read}");
    assert!(read.contains("`plate 13` of row 14 and 99987 more"), "{read}");
    let bare = rows.replace(",0.1", ",");
    let error = import(&format!("name,nominal,tolerance\n{bare}"), &[]).unwrap_err();
    assert!(error.contains("`plate 12` and 99988 more") && error.len() < 1000, "{}", error.len());
}

#[test]
fn totals_and_limits_stand_below_the_rows() {
    let table = "name,nominal,tol,dir\na,10,0.1,+\nb,4,0.05,-\nGap,6,,\nLimits: 5.9 .. 6.1,,,\n";
    let [text, read] = imported(table, &[]);
    assert!(text.contains("lower = 5.9, upper = 6.1 }"), "{text}");
    assert!(read.contains("2 rows, 1 subtracted, no unit, limits 5.9 .. 6.1 from row 5"), "{read}");
    assert!(read.contains("row 4 is the sum of the others and was left out: Gap"), "{read}");
    let [text, _] = imported(table, &["--lower", "5.8", "--target-yield", "0.99", "--title", "Play"]);
    assert!(
        text.contains("lower = 5.8, upper = 6.1, target_yield = 0.99 }") && text.contains("title = \"Play\""),
        "{text}"
    );
    // Limits in the columns of limits, and a worst case there.
    let stack = "name,nominal,max,min,dir\na,10,10.1,9.9,+\nb,4,4.05,3.95,-\n";
    let [text, _] = imported(&format!("{stack}gap,,6.2,5.9,\n"), &[]);
    assert!(text.contains("lower = 5.9, upper = 6.2 }"), "{text}");
    let [text, read] = imported(&format!("{stack}gap,,6.15,5.85,\n"), &[]);
    assert!(!text.contains("lower =") && read.contains("row 4 holds the worst case of the rows"), "{read}\n{text}");
    let [text, _] = imported("Grenzen;0,2;0,8\nBezeichnung;Nennmaß;Toleranz\na;0,5;0,1\n", &[]);
    assert!(text.contains("lower = 0.2, upper = 0.8"), "{text}");
}

/// Limits in the row of the nominal values, and in one cell of their own.
#[test]
fn rows_of_limits_are_no_dimensions() {
    let stack = "Bezeichnung;Richtung;Nennmaß;Toleranz\na;+;10;0,1\nb;-;9,5;0,1\n";
    for row in ["Grenzmaße;;0,1;0,9", "Grenzen;0,1 .. 0,9", "Grenzwerte;;0,1 .. 0,9;", "Grenzen;;;0,1 .. 0,9"] {
        let [text, read] = imported(&format!("{stack}{row}\n"), &[]);
        assert!(text.contains("lower = 0.1, upper = 0.9 }"), "{row}: {text}");
        assert!(read.contains("2 rows, 1 subtracted, no unit, limits 0.1 .. 0.9 from row 4"), "{row}: {read}");
    }
    let error = import(&format!("{stack}Grenzen;;0,5;±0,4\n"), &[]).unwrap_err();
    assert!(error.contains("this row does not hold two numbers") && error.contains("another name"), "{error}");
}

/// The sign of a nominal value without a column of directions is its direction, so that +0/-0.013 are deviations of the shaft itself.
#[test]
fn a_negative_nominal_keeps_its_own_deviations() {
    let table = "Bezeichnung;Nennmaß;Toleranz\nBohrung;25,02;0,01\nWelle;-24,98;+0/-0,013\n";
    let [text, read] = imported(table, &[]);
    let study = Study::from_toml(&text, "stack").unwrap();
    let found = analyze(&study.problem, &Method::Full.into()).unwrap();
    // Independent: 25.02 - (24.98 - 0.0065); with mirrored deviations it would be 0.0335.
    close(found.characteristics[0].moments.unwrap().mean(), 0.0465, 1e-13, 25.0);
    // 25.01 - 24.98 and 25.03 - 24.967.
    let ([nominal, low, high], _) = figures(&text);
    close(nominal, 0.04, 1e-13, 25.0);
    close(low, 0.03, 1e-13, 25.0);
    close(high, 0.063, 1e-13, 25.0);
    assert!(text.contains("nominal = 24.98") && text.contains("tolerance = [-0.013, 0.0]"), "{text}");
    assert!(read.contains("taken as its direction: `Welle` of row 3 is 24.98, subtracted"), "{read}");
    assert!(read.contains("2 rows, 1 one-sided, 1 subtracted"), "{read}");
    // A column of directions says the direction, so that a negative value is one.
    let table = "name,nominal,tol,dir\na,-1,+0.2/0,+\nb,3,0.1,-\n";
    let [text, _] = imported(table, &[]);
    assert!(text.contains("nominal = -1.0") && text.contains("tolerance = [0.0, 0.2]"), "{text}");
}

#[test]
fn dimensions_without_tolerance_are_asked_for() {
    let table = "name,nominal,tol\na,10,0.1\nshim,2,\n";
    let error = import(table, &[]).unwrap_err();
    assert!(error.contains("a dimension has no tolerance: `shim`") && error.contains("--allow-fixed"), "{error}");
    let [text, read] = imported(table, &["--allow-fixed"]);
    assert!(text.contains("shim = { nominal = 2.0 }") && read.contains("without tolerance: shim"), "{read}");
}

/// A German workbook with twelve rows, one-sided tolerances and a title: yield and page by one command.
#[test]
fn a_german_workbook_is_analysed_by_one_command() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let rows: [(&str, f64, &str, f64); 12] = [
        ("+", 120.0, "0,15", 0.0),
        ("-", 12.0, "-0,12", 0.0),
        ("-", 18.0, "", -0.1),
        ("-", 25.0, "±0,05", 0.0),
        ("-", 12.0, "-0,12", 0.0),
        ("-", 5.0, "+0,02/-0,04", 0.0),
        ("-", 8.0, "0,03", 0.0),
        ("-", 15.0, "+0,06", 0.0),
        ("-", 4.5, "0/-0,05", 0.0),
        ("-", 10.0, "0,05", 0.0),
        ("-", 6.0, "0,04", 0.0),
        ("-", 4.2, "+0,02", 0.0),
    ];
    let mut book = Workbook::new();
    let sheet = book.add_worksheet().set_name("Kette").unwrap();
    sheet.write_string(0, 0, "Axialspiel der Welle").unwrap();
    sheet.write_string(1, 0, "Zeichnung:").unwrap();
    sheet.write_string(1, 1, "4711-B").unwrap();
    for (column, header) in (0u16..).zip(["Pos.", "Bezeichnung", "Richtung", "Nennmaß [mm]", "Toleranz"]) {
        sheet.write_string(3, column, header).unwrap();
    }
    for (line, (direction, nominal, text, number)) in (4u32..).zip(rows) {
        sheet.write_number(line, 0, f64::from(line - 3)).unwrap();
        sheet.write_string(line, 1, format!("Maß {}", line - 3)).unwrap();
        sheet.write_string(line, 2, direction).unwrap();
        sheet.write_number(line, 3, nominal).unwrap();
        if text.is_empty() {
            sheet.write_number(line, 4, number).unwrap();
        } else {
            sheet.write_string(line, 4, text).unwrap();
        }
    }
    sheet.write_string(16, 1, "Summe").unwrap();
    book.save(at("kette.xlsx")).unwrap();
    let arguments =
        ["analyze", &at("kette.xlsx"), "--lower", "0.2", "--upper", "0.8", "--html", &at("seite.html"), "--json"];
    let output = sensitol(&arguments).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{error}");
    assert!(error.contains("12 rows, 6 one-sided, 11 subtracted, mm, limits 0.2 .. 0.8"), "{error}");
    let report: Value = serde_json::from_str(&String::from_utf8(output.stdout).unwrap()).unwrap();
    // Independent: NormalDist of Python 3.11 with the mean 0.3 + 0.06 + 0.05 + 0.06 + 0.01 - 0.03 + 0.025 - 0.01 = 0.465 and the root of the
    // sum of the squared half widths, over 3.
    let one = &report["characteristics"][0];
    close(one["mean"].as_f64().unwrap(), 0.465, 1e-13, 120.0);
    close(one["sigma"].as_f64().unwrap(), 0.068_495_741_960_115_06, 1e-12, 1.0);
    close(one["yield"].as_f64().unwrap(), 0.999_944_823_775_030_6, 1e-9, 1.0);
    let page = std::fs::read_to_string(at("seite.html")).unwrap();
    assert!(page.contains("Axialspiel der Welle") && page.contains("4711-B"));
    // Options of tables are for tables.
    std::fs::write(
        at("gap.toml"),
        "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ng = { formula = \"a\" }\n",
    )
    .unwrap();
    let output = sensitol(&["analyze", &at("gap.toml"), "--lower", "0.2"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(String::from_utf8(output.stderr).unwrap().contains("--lower is for tables"));
}

/// A measured table: a column a dimension, with a blank, a slip of the pen and a number of the part.
#[test]
fn a_measured_table_becomes_a_study() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let mut table = "Serial;housing [mm];bearing [mm]\n".to_owned();
    for part in 0..200 {
        let housing = match part {
            7 | 90 => String::new(),
            50 => "13,9".to_owned(),
            part => format!("12,{}", 39 + part % 5),
        };
        table += &format!("S{part};{housing};5,{}\n", 18 + part % 4);
    }
    std::fs::write(at("lot.csv"), table).unwrap();
    let arguments = [
        "import",
        &at("lot.csv"),
        "--measured",
        "--formula",
        "housing - bearing",
        "--lower",
        "7",
        "-o",
        &at("lot.toml"),
    ];
    let output = sensitol(&arguments).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{error}");
    assert!(error.contains("200 rows, 2 measured dimensions, 2 of 200 blank in `housing [mm]`"), "{error}");
    assert!(error.contains("missing-values") && error.contains("outliers") && error.contains("13.9"), "{error}");
    assert!(error.contains("columns without measured values were left out: Serial"), "{error}");
    let study = Study::read(std::path::Path::new(&at("lot.toml"))).unwrap();
    // Independent: the mean of 198 rows, less that of the bearings in these rows.
    let rows: Vec<usize> = (0..200).filter(|part| ![7, 90].contains(part)).collect();
    let housing = |part: usize| if part == 50 { 13.9 } else { 12.0 + 0.01 * (39 + part % 5) as f64 };
    let bearing = |part: usize| 5.0 + 0.01 * (18 + part % 4) as f64;
    let mean = rows.iter().map(|&part| housing(part) - bearing(part)).sum::<f64>() / rows.len() as f64;
    let found = analyze(&study.problem, &Method::Full.into()).unwrap();
    close(found.characteristics[0].moments.unwrap().mean(), mean, 1e-13, 1.0);
    let output = sensitol(&["import", &at("lot.csv"), "--measured", "--formula", "housing - pin"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    std::fs::write(at("numbers.csv"), "1,2\n3,4\n").unwrap();
    let output = sensitol(&["import", &at("numbers.csv"), "--measured"]).output().unwrap();
    assert!(String::from_utf8(output.stderr).unwrap().contains("the first row names the columns"));
}

/// Numbers of parts are no measured values: whole numbers in steps of 1 below a header of parts.
#[test]
fn numbers_of_parts_are_left_out_of_measured_tables() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("lot.csv");
    let measured = |header: &str, step: usize| {
        let rows: String = (0..20).map(|row| format!("{};12,{}\n", 7 + step * row, 39 + row % 5)).collect();
        std::fs::write(&path, format!("{header};width\n{rows}")).unwrap();
        let output = sensitol(&["import", path.to_str().unwrap(), "--measured"]).output().unwrap();
        String::from_utf8(output.stderr).unwrap()
    };
    for header in ["Teil", "part", "Bauteil", "Teile-Nr", "Teile-Nr.", "Nr", "ID"] {
        let read = measured(header, 1);
        assert!(read.contains("20 rows, 1 measured dimensions"), "{header}: {read}");
        assert!(read.contains(&format!("columns without measured values were left out: {header}")), "{read}");
    }
    assert!(measured("Teil", 2).contains("20 rows, 2 measured dimensions"));
}
