//! `sensitol import` of STEP files.
//!
//! Oracles: the text of NIST's files as read by eye, and figures of an assembly that are written here by hand.

use std::io::Read;
use std::path::{Path, PathBuf};

use super::command::sensitol;

/// Unpacks a file of `crates/step/tests/data` into a folder.
fn unpacked(folder: &Path, name: &str) -> PathBuf {
    let data = Path::new(env!("CARGO_MANIFEST_DIR")).join("../step/tests/data").join(format!("{name}.stp.gz"));
    let mut bytes = Vec::new();
    flate2::read::GzDecoder::new(&std::fs::read(data).unwrap()[..]).read_to_end(&mut bytes).unwrap();
    let path = folder.join(format!("{name}.stp"));
    std::fs::write(&path, bytes).unwrap();
    path
}

/// Exit code, stdout and stderr of a command.
fn run(arguments: &[&str]) -> (i32, String, String) {
    let output = sensitol(arguments).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap(), text(output.stdout), text(output.stderr))
}

#[test]
fn a_part_becomes_a_table_of_features() {
    let folder = tempfile::tempdir().unwrap();
    let part = unpacked(folder.path(), "nist_ctc_05_asme1_ap242-e1");
    let (code, text, error) = run(&["import", part.to_str().unwrap(), "--part", "shaft"]);
    assert_eq!((code, error.as_str()), (0, ""));
    insta::assert_snapshot!(text);
}

/// Every file with tolerances gives features that the reader of studies takes, under any case of the extension.
#[test]
fn all_parts_are_accepted() {
    let folder = tempfile::tempdir().unwrap();
    let names = [
        ("nist_ctc_01_asme1_ap242-e1", "P21", 6),
        ("nist_ctc_03_asme1_ap242-e2", "Stp", 13),
        ("nist_ftc_06_asme1_ap242-e2", "STEP", 28),
        ("nist_ftc_11_asme1_ap242-e2", "step", 4),
        ("nist_stc_06_asme1_ap242-e3", "stp", 25),
    ];
    for (name, extension, tolerances) in names {
        let part = unpacked(folder.path(), name).with_extension(extension);
        std::fs::rename(folder.path().join(format!("{name}.stp")), &part).unwrap();
        let study = folder.path().join(format!("{name}.toml"));
        let (code, said, error) = run(&["import", part.to_str().unwrap(), "-o", study.to_str().unwrap()]);
        assert_eq!((code, error.as_str()), (0, ""), "{name}");
        let last = std::fs::read_to_string(&study).unwrap().lines().last().unwrap().to_owned();
        assert!(
            said.contains(last.trim_start_matches("# ")) && last.starts_with(&format!("# {tolerances} tolerances: "))
        );
    }
}

/// Two parts of NIST, joined by hand: the shaft stands with its foot on the plate of the other part.
#[test]
fn two_parts_become_an_assembly_that_runs() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let plate = unpacked(folder.path(), "nist_stc_06_asme1_ap242-e3");
    let shaft = unpacked(folder.path(), "nist_ctc_05_asme1_ap242-e1");
    let study = at("assembly.toml");
    assert_eq!(run(&["import", plate.to_str().unwrap(), "--part", "plate", "-o", &study]).0, 0);
    let (code, said, error) = run(&["import", shaft.to_str().unwrap(), "--part", "shaft", "--into", &study]);
    assert_eq!((code, error.as_str()), (0, ""));
    assert!(said.starts_with("[parts.shaft]\n10 tolerances: "), "{said}");
    // Before a joint holds the shaft, check names what is missing.
    let (code, _, error) = run(&["check", &study]);
    assert!(code == 2 && error.contains("`[joints]` is missing"), "{error}");
    let text = std::fs::read_to_string(&study).unwrap();
    // Inches of the shaft are millimetres of the plate's study: diameter 10 in, its axis at 2.1875 in.
    assert!(text.contains("shaft_B_diameter = { nominal = 254, tolerance = 0.0254, unit = \"mm\" }"), "{text}");
    assert!(text.contains("axis = [0, 0, 55.5625], along = \"z\", diameter = \"shaft_B_diameter\", "), "{text}");
    let joints = "[joints]\nfoot = { on = \"plate.D\", against = \"shaft.face_4\", takes = 3 }\n\
                  way = { hole = \"plate.hole_2_1\", pin = \"shaft.A\", takes = 2 }\n\
                  [characteristics]\nheight = { of = \"shaft.face_1\", from = \"plate.A\", unit = \"mm\" }\n";
    std::fs::write(&study, text + joints).unwrap();
    let (code, said, error) = run(&["check", &study]);
    assert_eq!(code, 0, "{error}");
    assert!(said.contains("2 parts, 2 joints"), "{said}");
    // Plane D is at 31.75 mm above the origin and A below at 0 looks down; the top of the shaft's flange is at 5 in.
    let (_, report, _) = run(&["analyze", &study, "--json"]);
    let report: serde_json::Value = serde_json::from_str(&report).unwrap();
    let nominal = report["characteristics"][0]["nominal"].as_f64().unwrap();
    // 12 digits of 158.75: the joints close to 1e-12 of the size.
    assert!((nominal + 158.75).abs() < 1e-9, "{report}");
    // A part is added once, and the study stays as it was.
    let before = std::fs::read_to_string(&study).unwrap();
    let (code, _, error) = run(&["import", shaft.to_str().unwrap(), "--part", "shaft", "--into", &study]);
    assert!(
        code == 2 && error.contains("part `shaft` is in the study already") && error.contains("--part NAME"),
        "{error}"
    );
    assert_eq!(std::fs::read_to_string(&study).unwrap(), before);
}

#[test]
fn wrong_files_are_refused_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let drawn = unpacked(folder.path(), "nist_ftc_08_asme1_ap242-e1-tg");
    let drawn = drawn.to_str().unwrap();
    let whole = std::fs::read(unpacked(folder.path(), "nist_ctc_01_asme1_ap242-e1")).unwrap();
    std::fs::write(at("cut.stp"), &whole[..200_000]).unwrap();
    std::fs::write(at("packed.stpZ"), b"PK\x03\x04").unwrap();
    std::fs::write(at("mesh.stp"), "solid cube").unwrap();
    std::fs::write(at("table.csv"), "name,nominal\na,10\n").unwrap();
    std::fs::write(at("broken.toml"), "[parts\n").unwrap();
    std::fs::write(at("whole.stp"), whole).unwrap();
    let cases: [(&[&str], &str); 11] = [
        (&["import", drawn], "no semantic tolerances; 60 drawn annotations: export with semantic PMI"),
        (&["import", &at("cut.stp")], "the file ends here, before END-ISO-10303-21: it was cut off"),
        (&["import", &at("packed.stpZ")], "the file is compressed: unpack it first"),
        (&["import", &at("mesh.stp")], "does not begin with ISO-10303-21: export the part as STEP AP242"),
        (&["import", &at("none.stp")], "No such file"),
        (&["import", &at("whole.stp"), "--sheet", "A"], "--sheet is for tables, and this is a STEP file"),
        (&["import", &at("whole.stp"), "--part", "a.b"], "`a.b` is no name of a part"),
        (&["import", &at("whole.stp"), "--into", &at("broken.toml")], "broken.toml: it is not TOML"),
        (&["import", &at("whole.stp"), "--into", &at("none.toml")], "takes a study that is there"),
        (&["import", &at("table.csv"), "--joints"], "--joints is for STEP files, and this is a table"),
        (&["import", &at("whole.stp"), "--into", &at("x.toml"), "-o", &at("y.toml")], "cannot be used with"),
    ];
    for (arguments, expected) in cases {
        let (code, said, error) = run(arguments);
        assert_eq!((code, said.as_str()), (2, ""), "{arguments:?}");
        assert!(error.contains(expected), "{arguments:?}: {error}");
    }
    assert_eq!(std::fs::read_to_string(at("broken.toml")).unwrap(), "[parts\n");
}
