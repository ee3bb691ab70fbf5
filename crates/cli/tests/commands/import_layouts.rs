//! `sensitol import`: rows around the header and sums between the dimensions, as spreadsheets write them.
//!
//! Oracle: the plain table with the same dimensions, whose study has to be the same but for notes and title.

use assert_cmd::Command;

use super::command::sensitol;

const PLAIN: &str = "name;direction;nominal [mm];upper [mm];lower [mm]\nhousing;+;84,6;0,1;-0,1\ncover;-;4,0;0,05;-0,02\ngear;-;80,2;0,04;-0,04\n";

/// Exit code, study and messages of an import.
fn import(table: &str) -> (i32, String, String) {
    let output = Command::from_std(sensitol(&["import", "-", "--color", "never"])).write_stdin(table).output().unwrap();
    let [study, messages] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
    (output.status.code().unwrap(), study, messages)
}

/// Study of a table without comments and without its title.
fn study(table: &str) -> String {
    let (code, text, messages) = import(table);
    assert_eq!(code, 0, "{table}\n{messages}");
    let kept =
        |line: &&str| !line.starts_with('#') && !line.starts_with("title") && !line.is_empty() && *line != "[about]";
    text.lines().filter(kept).collect::<Vec<_>>().join("\n")
}

/// Plain table with another header, and with rows before the row `before`.
fn table(header: &str, before: usize, rows: &str) -> String {
    let plain: Vec<&str> = PLAIN.lines().skip(1).collect();
    let [above, below] = [&plain[..before], &plain[before..]].map(|rows| rows.join("\n"));
    [header, &above, rows, &below].into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join("\n") + "\n"
}

const HEADER: &str = "name;direction;nominal [mm];upper [mm];lower [mm]";

#[test]
fn lines_above_the_header_are_no_dimensions() {
    let plain = study(PLAIN);
    assert_eq!(study(&format!("sep=;\n{PLAIN}")), plain);
    // A title holds no separator, or one that the table does not use.
    assert_eq!(study(&format!("Gearbox play\n{PLAIN}")), plain);
    assert_eq!(study(&format!("Gearbox, second draft, play\n{PLAIN}")), plain);
}

#[test]
fn a_header_may_have_two_rows() {
    let plain = study(PLAIN);
    for header in [
        "name;direction;nominal;upper;lower\n;;mm;mm;mm",
        "name;direction;nominal;upper;lower\n;;[mm];[mm];[mm]",
        "name;direction;nominal [mm];tolerance;\n;;;upper [mm];lower [mm]",
    ] {
        assert_eq!(study(&table(header, 0, "")), plain, "{header}");
    }
    // Units of two kinds in the second row are converted as those of the header are.
    let text = study("name;nominal;tolerance\n;mm;µm\na;10;50\n");
    assert_eq!(text, study("name;nominal [mm];tolerance [µm]\na;10;50\n"));
    assert!(text.contains("0.05"), "{text}");
}

#[test]
fn repeated_headers_and_sums_are_left_out() {
    let plain = study(PLAIN);
    let repeated = table(HEADER, 2, HEADER);
    assert_eq!(study(&repeated), plain);
    assert!(import(&repeated).1.contains("row 4 repeats the header and was left out"));
    // 84.6 - 4 = 80.6, and 80.6 - 80.2 = 0.4.
    for sums in ["Subtotal;;80,6;;", "Zwischensumme;;80,6;;", "sub-total =;;80,6;;"] {
        assert_eq!(study(&table(HEADER, 2, sums)), plain, "{sums}");
    }
    assert_eq!(study(&format!("{PLAIN}Total;;0,4;;\n")), plain);
    let remarked = "remark;name;direction;nominal [mm];upper [mm];lower [mm]\n;a;+;5;0,1;-0,1\n;b;-;4;0,1;-0,1\n";
    assert_eq!(study(&format!("{remarked}Summe;;;1;;\n")), study(remarked));
    // A second subtotal may hold the sum since the first.
    let header = "name;nominal;tol";
    let rows = "a;10;0,1\nb;5;0,1\nSubtotal;15;\nc;2;0,1\nd;3;0,1\nSubtotal;5;\n";
    assert_eq!(study(&format!("{header}\n{rows}")), study(&format!("{header}\na;10;0,1\nb;5;0,1\nc;2;0,1\nd;3;0,1\n")));
    let (code, _, fault) = import(&table(HEADER, 2, "Subtotal;;80,0;;"));
    assert!(code == 2 && fault.contains("Subtotal") && fault.contains("80.6"), "{code} {fault}");
}

#[test]
fn a_header_of_names_or_values_is_told_by_its_cells() {
    assert_eq!(
        study("Bezeichnung;Maß;Toleranz\na;10,5;0,1\nb;5;0,1\n"),
        study("Bezeichnung;Nennmaß;Toleranz\na;10,5;0,1\nb;5;0,1\n")
    );
    assert_eq!(study("part,size,tolerance\na,10.5,0.1\n"), study("part,nominal,tolerance\na,10.5,0.1\n"));
    let (code, _, fault) = import("name;tolerance;remark\na;0,1;x\n");
    assert!(
        code == 2 && fault.contains("no column holds the nominal value") && fault.contains("--column nominal="),
        "{fault}"
    );
}

#[test]
fn a_class_needs_a_unit() {
    let (code, _, fault) = import("name;nominal;tolerance\nbore;62;H7\n");
    assert!(code == 2 && fault.contains("H7") && fault.contains("nominal [mm]"), "{fault}");
    assert!(study("name;nominal [mm];tolerance\nbore;62;H7\n").contains("H7"));
}
