//! Interface for calling programs: a function as the model, keys of `[analysis]`, folders, and the exit code.

use std::sync::{Arc, Mutex};

use sensitol::assembly::Closure;
use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_study::{Externals, StudyText};

const GAP: &str = r#"
    [dimensions]
    bore = { nominal = 25.02, tolerance = 0.01 }
    shaft = { nominal = 24.98, tolerance = 0.02 }
    [constants]
    k = 1000.0
    [characteristics]
    gap = { lower = 0 }
    microns = { formula = "k*gap" }
"#;

fn hosted(text: &str) -> Result<Study, sensitol_study::StudyError> {
    let externals = Externals::default().with_host(|_, _| Arc::new(Closure::scalar("gap", |x| x[0] - x[1])));
    Study::from_text(StudyText::toml("gap.toml", text).with_externals(externals))
}

#[test]
fn a_function_answers_what_no_formula_says() {
    let told = Arc::new(Mutex::new(None));
    let heard = Arc::clone(&told);
    let externals = Externals::default().with_host(move |signature, greeting| {
        *heard.lock().unwrap() = Some((signature, greeting));
        Arc::new(Closure::scalar("gap", |x| x[0] - x[1]))
    });
    let study = Study::from_text(StudyText::toml("gap.toml", GAP).with_externals(externals)).unwrap();
    let told = told.lock().unwrap().take().unwrap();
    let names = |names: Vec<String>| names.join(" ");
    assert_eq!(names(told.0.inputs.iter().map(|one| one.name.clone()).collect()), "bore shaft");
    assert_eq!(names(told.0.outputs.iter().map(|one| one.name.clone()).collect()), "gap");
    assert_eq!(told.1.nominal, [25.02, 24.98]);
    assert_eq!(told.1.constants, [("k".to_owned(), 1000.0)]);
    let found = analyze(&study.problem, &study.options).unwrap();
    // Two normal dimensions whose sigmas are tolerance/3.
    let sigma = (0.01f64.powi(2) + 0.02f64.powi(2)).sqrt() / 3.0;
    let got = found.characteristics[1].moments.unwrap().sigma();
    assert!((got / (1000.0 * sigma) - 1.0).abs() < 1e-9, "{got}");
}

/// Without the function, the characteristic has neither formula nor model.
#[test]
fn the_same_study_without_a_function_is_wrong() {
    let error = Study::from_toml(GAP, "gap.toml").unwrap_err();
    assert_eq!(error.key, "characteristics.gap");
}

#[test]
fn a_function_stands_in_place_of_a_program_and_not_of_a_built_in_model() {
    let program = GAP.to_owned() + "[model]\ncommand = [\"no-such-program\"]\n";
    let study = hosted(&program).unwrap();
    assert!(analyze(&study.problem, &study.options).unwrap().characteristics[0].moments.is_some());
    let built_in = GAP.to_owned() + "[model]\nbuiltin = \"engine-balance\"\n";
    let error = hosted(&built_in).unwrap_err();
    assert_eq!(error.key, "model.builtin");
    assert!(error.to_string().contains("leave out [model], or the function"), "{error}");
}

/// A study that an allocation writes can be read again, with the function.
#[test]
fn a_study_with_a_function_is_written_anew() {
    let study = hosted(GAP).unwrap();
    let dimensions = study.problem.dimensions();
    let half = dimensions[0].scaled(0.5).unwrap().unwrap();
    let wanted = study.problem.clone().with_dimensions(vec![half, dimensions[1].clone()]).unwrap();
    let anew = study.rewritten(&wanted).unwrap();
    assert!(anew.text.contains("tolerance = 0.005"), "{}", anew.text);
}

#[test]
fn keys_of_the_analysis_win_and_what_belongs_to_another_method_goes() {
    let own = GAP.to_owned()
        + "[analysis]\nmethod = \"six-n\"\npairs = [[\"bore\", \"shaft\"]]\nstep = 1.5\naccuracy = 0.02\nseed = 3\n";
    let study = hosted(&own).unwrap();
    let same = study.with_analysis("{}").unwrap();
    assert_eq!((same.options, same.seed), (study.options.clone(), study.seed));
    let full = study.with_analysis(r#"{"method": "full", "budget": 90, "seed": 4}"#).unwrap();
    assert_eq!((full.options.method, full.options.budget, full.seed), (Method::Full, Some(90), Some(4)));
    assert_eq!((full.options.pairs, full.options.step, full.options.accuracy), (None, Some(1.5), Some(0.02)));
    let reduced = study.with_analysis(r#"{"method": "dimension-reduction", "nodes": 3}"#).unwrap();
    assert_eq!((reduced.options.step, reduced.options.nodes), (None, Some(3)));
}

#[test]
fn keys_of_the_analysis_that_are_wrong_have_their_name_and_no_place() {
    let study = hosted(GAP).unwrap();
    let wrong = [
        (r#"{"method": "fool"}"#, "analysis.method"),
        (r#"{"accuracy": -1}"#, "analysis.accuracy"),
        (r#"{"budget": "many"}"#, "analysis.budget"),
        (r#"{"pair": "strongest"}"#, "analysis.pair"),
    ];
    for (keys, key) in wrong {
        let error = study.with_analysis(keys).unwrap_err();
        assert_eq!((error.key.as_str(), error.span.clone()), (key, None), "{error}");
    }
    assert!(study.with_analysis("no json").is_err());
}

#[test]
fn measured_values_are_sought_in_the_folder_that_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("pin.csv"), "pin\n7.99\n8.01\n8.02\n7.98\n8.00\n8.01\n7.99\n8.00\n").unwrap();
    let text = "[dimensions]\npin = { measured = \"pin.csv\" }\n[characteristics]\ny = { formula = \"pin\" }\n";
    assert!(Study::from_toml(text, "pin.toml").is_err());
    let study = Study::from_text(StudyText::toml("pin.toml", text).in_folder(folder.path())).unwrap();
    assert!((study.problem.dimensions()[0].mean() - 8.0).abs() < 1e-12);
}

/// A study converted to JSON is the same study, in the same order.
#[test]
fn a_study_of_toml_is_one_of_json() {
    let text = include_str!("../../../../examples/shaft-and-bore/study.toml");
    let study = Study::from_toml(text, "study.toml").unwrap();
    let json = Study::from_json(&study.as_json(), "study.json").unwrap();
    let names = |study: &Study| study.problem.dimensions().iter().map(|one| one.name().to_owned()).collect::<Vec<_>>();
    assert_eq!(names(&json), names(&study));
    let of = |study: &Study| analyze(&study.problem, &study.options).unwrap().characteristics[0].moments;
    assert_eq!(of(&json), of(&study));
}

#[test]
fn the_exit_code_is_a_number_too() {
    assert_eq!(sensitol_cli::run_code(["sensitol", "check", "no-such-study.toml"].map(Into::into)), 2);
}
