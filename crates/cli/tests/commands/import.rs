//! `sensitol import`: stack-up tables in the styles of English and German spreadsheets.
//!
//! Oracle: the same stack written by hand as a study, and sums of a few numbers.

use std::path::Path;

use assert_cmd::Command;
use sensitol::{Method, analyze};
use sensitol_study::Study;

use super::command::sensitol;

const ENGLISH: &str = "Gearbox play,,,,,,\nname,part,direction,nominal [mm],tolerance,distribution,remark\n\
                       housing depth,housing,+,84.60,±0.10,,bored\nlip,cover,-,4.00,+0.05/-0.02,uniform,\n\
                       gear,gear,-1,18.50,0.04,,\nTotal,,,,,,sum of the above\nshaft,,left,62.0,H7,,turned\n";
const GERMAN: &str = "Bezeichnung;Bauteil;Richtung;Nennmaß;Tol +;Tol -;Einheit;Verteilung\n\
                      housing depth;Gehäuse;+;84,60;0,10;0,10;mm;\nlip;Deckel;-;4,00;0,05;0,02;mm;Gleichverteilung\n\
                      gear;Rad;links;18,50;0,04;0,04;mm;Normalverteilung\nSumme;;;;;;;\nshaft;Welle;-;62,0;+0,03;0;mm;\n";
const BY_HAND: &str = "[dimensions]\n\"housing depth\" = { nominal = 84.6, tolerance = 0.1, unit = \"mm\" }\n\
                       lip = { nominal = 4, tolerance = [-0.02, 0.05], distribution = \"uniform\", unit = \"mm\" }\n\
                       gear = { nominal = 18.5, tolerance = 0.04, unit = \"mm\" }\nshaft = { nominal = 62, SHAFT, unit = \"mm\" }\n\
                       [characteristics]\ngap = { formula = \"`housing depth` - lip - gear - shaft\", unit = \"mm\" }\n";

fn imported(table: &str, more: &[&str]) -> Result<String, String> {
    let mut command = Command::new(env!("CARGO_BIN_EXE_sensitol"));
    let output = command.args(["import", "-", "--color", "never"]).args(more).write_stdin(table).output().unwrap();
    match output.status.code() {
        Some(0) => Ok(String::from_utf8(output.stdout).unwrap()),
        _ => Err(String::from_utf8(output.stderr).unwrap()),
    }
}

/// Mean, sigma and worst case of the only characteristic.
fn figures(text: &str) -> [f64; 4] {
    let study = Study::from_toml(text, "stack").unwrap_or_else(|error| panic!("{error}\n{text}"));
    let one = analyze(&study.problem, &Method::Full.into()).unwrap().characteristics.remove(0);
    let (moments, [low, high]) = (one.moments.unwrap(), one.range.worst_case.unwrap());
    [moments.mean(), moments.sigma(), low, high]
}

#[test]
fn tables_become_studies() {
    let english = imported(ENGLISH, &[]).unwrap();
    insta::assert_snapshot!(english);
    // H7 of 62 mm is 0 .. +0.03 (ISO 286-2, table 6).
    assert_eq!(figures(&english), figures(&BY_HAND.replace("SHAFT", "fit = \"H7\"")));
    let german = imported(GERMAN, &[]).unwrap();
    assert_eq!(figures(&german), figures(&BY_HAND.replace("SHAFT", "tolerance = [0, 0.03]")));
    assert!(german.contains("row 5 has no nominal value and was left out: Summe"), "{german}");
    // Tabs between cells and decimal commas, as copied from a spreadsheet.
    assert_eq!(figures(&imported(&GERMAN.replace(';', "\t"), &[]).unwrap()), figures(&german));
}

#[test]
fn factors_units_and_names_are_kept() {
    let table = "id;factor;nominal;tol\na b;2;10;0,02 %\nc;-0,5;1.234,5;1,5\n";
    let text = imported(table, &["--name", "play"]).unwrap();
    let [mean, sigma, ..] = figures(&text);
    // 2 x 10 - 0.5 x 1234.5. The half-widths are 0.002 and 1.5, each three sigma.
    assert!((mean - (20.0 - 617.25)).abs() < 1e-9, "{text}");
    assert!((sigma - (2.0f64 * 0.002).hypot(0.5 * 1.5) / 3.0).abs() < 1e-12, "{text}");
    assert!(text.contains("play = { formula = \"2*`a b` - 0.5*c\" }"), "{text}");
    // Two deviations of one sign stay unchanged. The header of a column is free.
    let table = "name\tIst\tupper deviation\tlower deviation\nd\t25\t+0,041\t0,020\n";
    let text = imported(table, &["--column", "nominal=Ist"]).unwrap();
    assert!(text.contains("tolerance = [0.02, 0.041]") && text.contains("all dimensions are added"), "{text}");
}

#[test]
fn faults_name_their_cell() {
    let fault = |table: &str, more: &[&str]| imported(table, more).unwrap_err();
    let all = [
        fault("", &[]),
        fault("a,b\n1,2\n", &[]),
        fault("name,nominal\nTotal,\n", &[]),
        fault("name;nominal;tol\na;10;0,1\nb;5.5;0,1\n", &[]),
        fault("name,nominal,tol\na,10,\"0,1\"\n", &[]),
        fault("name,nominal,tol\na,ten,0.1\n", &[]),
        fault("name,nominal,tol\na,10,tight\n", &[]),
        fault("name,nominal,tol\na,10,+0.1/0.2\n", &[]),
        fault("name,nominal,tol ±\na,10,-0.1\n", &[]),
        fault("name,nominal,Tol +,Tol -\na,10,0.1,-0.1\nb,4,0.1,0.02\n", &[]),
        fault("name,nominal,upper deviation,lower deviation\na,10,0.1,0.1\n", &[]),
        fault("name,nominal,upper deviation,lower deviation\na,10,-0.1,0.1\n", &[]),
        fault("name,nominal,upper,lower\na,10,0.1,0.05\n", &[]),
        fault("name,nominal,usl,lsl\na,10,0.1,-0.1\n", &[]),
        fault("name,nominal,tol,max,min\na,10,0.1,10.2,9.9\n", &[]),
        fault("Bezeichnung;Nennmaß;Toleranz [µm]\na;10;100\n", &[]),
        fault("Bezeichnung;Nennmaß [mm];Toleranz [s]\na;10;100\n", &[]),
        fault("Bezeichnung;Nennmaß [mm];Toleranz;Einheit\na;10;0,1;in\n", &[]),
        fault("name,nominal,T1\na,10,0.1\n", &[]),
        fault("name,nominal,tol,\na,10,0.1,0.2\n", &[]),
        fault("name,nominal,tol\na,10,0.1\nb,4,\n", &[]),
        fault("name,nominal,tol,sigma\na,10,0.1,3\n", &[]),
        fault("name,nominal,tol,qty\na,10,0.1,2.5\n", &[]),
        fault("name,nominal,tol\na,10,0.1\nb,4,0.1\nTotal,13,0.2\n", &[]),
        fault("name,nominal,tol\na,10,0.1\nlimits,,\n", &["--lower", "2", "--upper", "1"]),
        fault("name,nominal,tol\n,10,0.1\n", &[]),
        fault("name,nominal,upper,lower\na,10,0.1,\n", &[]),
        fault("name,nominal,upper deviation,lower deviation,tol\na,10,0.1,-0.1,0.1\n", &[]),
        fault("name,nominal,direction\na,10,sideways\n", &[]),
        fault("name,nominal,distribution\na,10,bell\n", &[]),
        fault("name,nominal,Nennmaß\na,10,10\n", &[]),
        fault("name,Ist\na,10\n", &["--column", "nominal=Soll"]),
        fault("name,nominal\na,10\n", &["--column", "nominel=Soll"]),
        fault("name,nominal,tol,factor\na,10,0.1,0\n", &[]),
        fault("name,nominal,tol\na,10,H77\n", &[]),
    ];
    insta::assert_snapshot!(all.join("\n"));
}

#[test]
fn a_file_is_written_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    std::fs::write(path("stack.csv"), ENGLISH).unwrap();
    let arguments = ["import", &path("stack.csv"), "-o", &path("stack.toml")];
    assert_eq!(sensitol(&arguments).output().unwrap().status.code(), Some(0));
    let written = std::fs::read_to_string(path("stack.toml")).unwrap();
    assert!(written.starts_with("#:schema ./study.schema.json\n"), "{written}");
    assert!(written.lines().nth(2).unwrap().starts_with("# Imported from stack.csv."), "{written}");
    assert!(Study::read(Path::new(&path("stack.toml"))).is_ok());
    let again = sensitol(&arguments).output().unwrap();
    assert!(again.status.code() == Some(2) && String::from_utf8(again.stderr).unwrap().contains("is there already"));
    std::fs::write(path("stack.xlsx"), [0x50, 0x4b, 0xff, 0xfe]).unwrap();
    let error = String::from_utf8(sensitol(&["import", &path("stack.xlsx")]).output().unwrap().stderr).unwrap();
    assert!(error.contains("save it as .xlsx or as CSV in UTF-8"), "{error}");
}

/// Points with semicolons and decimal commas, as a German spreadsheet writes them, are read.
#[test]
fn points_are_read_in_both_styles() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let study = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 4, tolerance = 0.6 }\n[model]\ncommand = [\"none\"]\n[characteristics]\ny = { lower = 5 }\n";
    std::fs::write(path("gap.toml"), study).unwrap();
    let run = |arguments: &[&str]| {
        let output = sensitol(arguments).output().unwrap();
        assert_eq!(output.status.code(), Some(0), "{output:?}");
        String::from_utf8(output.stdout).unwrap()
    };
    run(&["plan", &path("gap.toml"), "-m", "full", "--write-points", &path("points.csv")]);
    let points = std::fs::read_to_string(path("points.csv")).unwrap();
    let mut lines = points.lines().map(str::to_owned);
    let mut answers = format!("{},y\n", lines.next().unwrap());
    for line in lines {
        let x: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
        answers += &format!("{line},{}\n", x[0] - x[1]);
    }
    std::fs::write(path("english.csv"), &answers).unwrap();
    std::fs::write(path("german.csv"), answers.replace(',', ";").replace('.', ",")).unwrap();
    let report = |table: &str| {
        let text = run(&["analyze", &path("gap.toml"), "-m", "full", "--points", &path(table), "--json"]);
        let report: serde_json::Value = serde_json::from_str(&text).unwrap();
        report["characteristics"].clone()
    };
    assert_eq!(report("english.csv"), report("german.csv"));
    let wrong = answers.replace(',', ";").replace("10", "10.5x");
    std::fs::write(path("wrong.csv"), wrong).unwrap();
    let output =
        sensitol(&["analyze", &path("gap.toml"), "-m", "full", "--points", &path("wrong.csv")]).output().unwrap();
    let error = String::from_utf8(output.stderr).unwrap();
    assert!(error.contains("line 2, column `a`") && error.contains("is not a finite number"), "{error}");
}
