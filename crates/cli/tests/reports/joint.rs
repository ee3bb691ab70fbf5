//! Measured columns with common rows, joint yields and their target.

use assert_cmd::Command;
use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::rare::{RareOptions, rare};
use sensitol::simulation::{Sampler, SimulationOptions, simulate};
use sensitol::{Analysis, Method, Verdict, analyze};
use sensitol_study::StudyText;
use sensitol_study::{Study, StudyError};
use sensitol_testing::{case, close, faults, relative};

fn read(text: &str, files: &[(&str, &str)]) -> Result<Study, StudyError> {
    let study = StudyText::toml("study.toml", text);
    Study::from_text(files.iter().fold(study, |study, (name, content)| study.with_file(*name, *content)))
}

fn analysed(text: &str, files: &[(&str, &str)]) -> Analysis {
    let study = read(text, files).unwrap_or_else(|error| panic!("{error}"));
    analyze(&study.problem, &Method::SecondOrder.into()).unwrap()
}

fn codes(text: &str, files: &[(&str, &str)]) -> Vec<String> {
    read(text, files).unwrap().warnings.iter().map(|warning| warning.code().to_owned()).collect()
}

/// Returns bores and pins of 60 assemblies that wear together: correlation of about 0.99.
fn lot() -> (String, Vec<[f64; 2]>) {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(7);
    let mut rows = Vec::new();
    for _ in 0..60 {
        let [common, own]: [f64; 2] = [random.random(), random.random()];
        rows.push([10.0 + common, 9.5 + common + 0.1 * own]);
    }
    let text = rows.iter().fold("bore,pin\n".to_owned(), |text, [a, b]| text + &format!("{a},{b}\n"));
    (text, rows)
}

const PAIR: &str = "[dimensions]\nbore = { measured = \"lot.csv\", column = \"bore\" }\npin = { measured = \"lot.csv\", column = \"pin\" }\n\
                    [characteristics]\nplay = { formula = \"bore - pin\" }\n";

/// The variance of the difference is that of the differences row by row, exactly so in a linear characteristic. For independent columns
/// it would be the sum of both.
#[test]
fn columns_of_one_file_are_the_same_parts() {
    let (csv, rows) = lot();
    let variance = |values: &[f64]| {
        let mean = values.iter().sum::<f64>() / values.len() as f64;
        values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / values.len() as f64
    };
    let play: Vec<f64> = rows.iter().map(|[a, b]| a - b).collect();
    let files = [("lot.csv", csv.as_str())];
    let sigma = |text: &str| analysed(text, &files).characteristics[0].moments.unwrap().sigma();
    // Rounding in a difference of variances that are a hundred times as large.
    relative(sigma(PAIR), variance(&play).sqrt(), 1e-9);
    let apart = PAIR.replace("column = \"pin\" }", "column = \"pin\", joint = false }");
    let of = |column: usize| variance(&rows.iter().map(|row| row[column]).collect::<Vec<_>>());
    relative(sigma(&apart), (of(0) + of(1)).sqrt(), 1e-12);
    assert!(sigma(&apart) > 10.0 * sigma(PAIR));
}

/// A row with a missing cell is left out of both columns, and named.
#[test]
fn rows_with_a_missing_cell_are_left_out_of_all() {
    let (csv, rows) = lot();
    let holes = csv.replacen(&format!("{},{}\n", rows[3][0], rows[3][1]), &format!("{},\n", rows[3][0]), 1);
    let without = csv.replacen(&format!("{},{}\n", rows[3][0], rows[3][1]), "", 1);
    let moments = |csv: &str| analysed(PAIR, &[("lot.csv", csv)]).characteristics[0].moments.unwrap();
    assert_eq!(moments(&holes), moments(&without));
    let warnings = codes(PAIR, &[("lot.csv", &holes)]);
    assert_eq!(warnings.iter().filter(|code| *code == "missing-values").count(), 1, "{warnings:?}");
    let missing = read(PAIR, &[("lot.csv", &holes)]).unwrap().warnings[0].message();
    assert!(missing.contains("line 5"), "{missing}");
}

/// Two files joined by a serial number, in different orders, with one part that only one of them has.
#[test]
fn serial_numbers_join_files() {
    let (csv, rows) = lot();
    let bores =
        rows.iter().enumerate().fold("part,d\n".to_owned(), |text, (i, row)| text + &format!("P{i},{}\n", row[0]));
    let pins = rows
        .iter()
        .enumerate()
        .rev()
        .fold("d;part\n".to_owned(), |text, (i, row)| text + &format!("{};P{i}\n", row[1]));
    let pins = pins + "9.5;P99\n";
    let text = "[dimensions]\nbore = { measured = \"bores.csv\", column = \"d\", match = \"part\" }\n\
                pin = { measured = \"pins.csv\", column = \"d\", match = \"part\" }\n[characteristics]\nplay = { formula = \"bore - pin\" }\n";
    let sigma = |text: &str, files: &[(&str, &str)]| analysed(text, files).characteristics[0].moments.unwrap().sigma();
    let files = [("bores.csv", bores.as_str()), ("pins.csv", pins.as_str())];
    relative(sigma(text, &files), sigma(PAIR, &[("lot.csv", &csv)]), 1e-9);
    assert!(codes(text, &files).contains(&"unmatched-rows".to_owned()));
}

/// Five simultaneous readings of GUM H.2: the law of propagation over their rows. The sigma of a part is u sqrt(5) sqrt(4/5) = 2 u,
/// because each row has the probability 1/5.
#[test]
fn readings_of_gum_h2() {
    let case = case("gum-h2");
    let column =
        |name: &str| case["inputs"][name].as_array().unwrap().iter().map(|x| x.as_f64().unwrap()).collect::<Vec<_>>();
    let (v, i, phi) = (column("V"), column("I mA"), column("phi"));
    let csv = (0..5).fold("V,I,phi\n".to_owned(), |text, row| text + &format!("{},{},{}\n", v[row], i[row], phi[row]));
    let text = "[dimensions]\nV = { measured = \"h2.csv\", column = \"V\" }\nI = { measured = \"h2.csv\", column = \"I\" }\n\
                phi = { measured = \"h2.csv\", column = \"phi\" }\n[characteristics]\nR = { formula = \"1000*V/I*cos(phi)\" }\n\
                X = { formula = \"1000*V/I*sin(phi)\" }\nZ = { formula = \"1000*V/I\" }\n";
    let holds = |found: f64, key: &str| {
        let printed = &case["printed"][key];
        let (value, tolerance) = (printed["value"].as_f64().unwrap(), printed["tolerance"].as_f64().unwrap());
        assert!((found - value).abs() <= tolerance, "{key}: {found}, printed {value}");
    };
    let study = read(text, &[("h2.csv", &csv)]).unwrap();
    let inputs = study.problem.correlation().unwrap();
    holds(inputs.of(0, 1), "r(V,I)");
    holds(inputs.of(0, 2), "r(V,phi)");
    holds(inputs.of(1, 2), "r(I,phi)");
    close(inputs.of(0, 2), 0.858, 5e-4, 1.0);
    let options = sensitol::Options::from(Method::SecondOrder).with_verify(0);
    let analysis = analyze(&study.problem, &options).unwrap();
    for (index, (mean, u)) in [("R", "u(R) of the mean"), ("X", "u(X)"), ("Z", "u(Z)")].into_iter().enumerate() {
        let one = &analysis.characteristics[index];
        holds(one.nominal.unwrap(), mean);
        holds(one.moments.unwrap().sigma() / 2.0, u);
    }
    for (index, key) in ["r(R,X)", "r(R,Z)", "r(X,Z)"].into_iter().enumerate() {
        holds(analysis.correlations[index].value.unwrap(), key);
    }
}

/// GUM-S2, 9.2: two sums with a common term. Their correlation is 1/2, and both lie below their means with probability 1/3.
#[test]
fn sums_with_a_common_term() {
    let case = case("gum-s2-additive");
    let text = "[dimensions]\nX1 = { nominal = 0, sigma = 1 }\nX2 = { nominal = 0, sigma = 1 }\nX3 = { nominal = 0, sigma = 1 }\n\
                [characteristics]\nY1 = { formula = \"X1 + X3\", upper = 0 }\nY2 = { formula = \"X2 + X3\", upper = 0 }\n";
    let analysis = analysed(text, &[]);
    let exact = |key: &str| case["exact"][key].as_f64().unwrap();
    close(analysis.characteristics[0].moments.unwrap().sigma(), exact("sigma"), 1e-12, 1.0);
    // Correlation from points of the model: within three of its stated errors.
    let correlation = &analysis.correlations[0];
    assert!(
        (correlation.value.unwrap() - 0.5).abs() <= 3.0 * correlation.error.unwrap_or(0.0) + 1e-9,
        "{correlation:?}"
    );
    let joint = analysis.joint.unwrap();
    assert!((joint.value - exact("P(Y1 < 0 and Y2 < 0)")).abs() <= 3.0 * joint.error + 1e-4, "{joint:?}");
}

/// The target of the joint yield counts for --check, and is printed in JSON and text.
#[test]
fn a_joint_yield_has_a_target() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("study.toml");
    let run = |target: f64, json: bool| {
        let text = format!(
            "[dimensions]\na = {{ nominal = 0, sigma = 1 }}\nb = {{ nominal = 0, sigma = 1 }}\n[characteristics]\n\
             y = {{ formula = \"a\", lower = -2, upper = 2 }}\nz = {{ formula = \"b\", lower = -2, upper = 2 }}\n\
             [analysis]\ntarget_joint_yield = {target}\nmethod = \"second-order\"\n"
        );
        std::fs::write(&path, text).unwrap();
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        command.arg("analyze").arg(&path).arg("--check");
        let output = if json { command.arg("--json") } else { &mut command }.output().unwrap();
        (output.status.code().unwrap(), String::from_utf8(output.stdout).unwrap())
    };
    // 0.9545² = 0.9111.
    assert_eq!((run(0.90, false).0, run(0.92, false).0), (0, 1));
    let report: serde_json::Value = serde_json::from_str(&run(0.92, true).1).unwrap();
    let joint = &report["joint_requirement"];
    assert_eq!((joint["verdict"].as_str(), joint["met"].as_bool()), (Some("missed"), Some(false)));
    // Two standard errors of some 40 000 points are 0.003.
    close(joint["value"].as_f64().unwrap(), 0.954_499_736_103_642_f64.powi(2), 5e-3, 1.0);
    assert!(run(0.90, false).1.contains("; target 90 %: met"), "{}", run(0.90, false).1);
}

#[test]
fn wrong_joint_data_is_said() {
    let errors = |text: &str, files: &[(&str, &str)]| {
        let error = read(text, files).err().unwrap_or_else(|| panic!("valid: {text}"));
        error.to_string()
    };
    let (csv, _) = lot();
    let twice = "part,d\nP1,3\nP2,4\nP1,5\nP4,2\nP5,7\nP6,8\n";
    let serial = "[dimensions]\na = { measured = \"a.csv\", column = \"d\", match = \"part\" }\nb = { measured = \"b.csv\", column = \"d\", match = \"part\" }\n[characteristics]\ny = { formula = \"a - b\" }\n";
    let pair = "[[correlation]]\nbetween = [\"bore\", \"pin\"]\nvalue = 0.5\n";
    let outside = PAIR.replace("[characteristics]", "c = { nominal = 1, tolerance = 0.1 }\n[characteristics]");
    let found = [
        errors(serial, &[("a.csv", twice), ("b.csv", "part,d\nP1,3\nP2,4\nP4,5\nP5,1\nP6,9\n")]),
        errors(
            &serial.replacen("match = \"part\"", "match = \"prt\"", 1).replace("match = \"part\"", "match = \"prt\""),
            &[("a.csv", twice), ("b.csv", twice)],
        ),
        errors(
            &serial.replacen("match = \"part\"", "match = \"part\", joint = false", 1),
            &[("a.csv", twice), ("b.csv", twice)],
        ),
        errors(&format!("{PAIR}{pair}"), &[("lot.csv", &csv)]),
        errors(&format!("{outside}{}", pair.replace("\"pin\"", "\"c\"")), &[("lot.csv", &csv)]),
    ];
    insta::assert_snapshot!(found.join("\n"));
    insta::assert_snapshot!(
        "joint_keys",
        faults(&[
            "[dimensions]\na = { nominal = 1, tolerance = 0.1, joint = false }\n[characteristics]\ny = { formula = \"a\" }\n",
            "[dimensions]\na = { nominal = 1, tolerance = 0.1, match = \"part\" }\n[characteristics]\ny = { formula = \"a\" }\n",
            "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a\", lower = 0 }\nz = { formula = \"a\" }\n[analysis]\ntarget_joint_yield = 0.9\n",
            "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = { formula = \"a\", lower = 0 }\nz = { formula = \"a\", lower = 0 }\n[analysis]\ntarget_joint_yield = 99\n",
        ])
    );
}

/// Two independent characteristics: their joint yield is the product, by points of the model and by importance sampling.
#[test]
fn samples_know_the_joint_yield() {
    let text = |limit: f64| {
        format!(
            "[dimensions]\na = {{ nominal = 0, sigma = 1 }}\nb = {{ nominal = 0, sigma = 1 }}\n[characteristics]\n\
             y = {{ formula = \"a\", lower = -{limit}, upper = {limit} }}\nz = {{ formula = \"b\", lower = -{limit}, upper = {limit} }}\n\
             w = {{ formula = \"a + b\" }}\n"
        )
    };
    for sampler in [Sampler::Random, Sampler::Sobol] {
        let options = SimulationOptions::default().with_sampler(sampler).with_target_joint_yield(0.9);
        let found = simulate(&read(&text(2.0), &[]).unwrap().problem, &options).unwrap();
        let joint = found.joint.unwrap();
        let exact = 0.954_499_736_103_642_f64.powi(2);
        assert!(joint.interval[0] <= exact && exact <= joint.interval[1], "{joint:?}");
        assert!(joint.interval[1] - joint.interval[0] < 0.01, "{joint:?}");
        assert_eq!(found.joint_requirement.unwrap().verdict, Verdict::Met);
        // Correlations of y with z, y with w, z with w.
        for (one, exact) in found.correlations.iter().zip([0.0, 0.5f64.sqrt(), 0.5f64.sqrt()]) {
            assert!((one.value.unwrap() - exact).abs() <= 3.0 * one.error.unwrap(), "{one:?}");
        }
    }
    // Beyond four sigma on either side of one: 6.334e-5.
    let beyond = 2.0 * 3.167_124_183_311_992e-5;
    let found = rare(&read(&text(4.0), &[]).unwrap().problem, &RareOptions::default().with_samples(2000)).unwrap();
    let exact = (1.0 - beyond) * (1.0 - beyond);
    let [low, high] = found.joint_interval.unwrap();
    assert!(low <= exact && exact <= high && high - low < beyond, "{low} {high} for {exact}");
    assert!(found.joint.is_some() && found.joint_requirement.is_none());
}
