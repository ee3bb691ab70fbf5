//! Studies in memory: text with the files that it names, as a browser page or a script supplies them.

use sensitol::{Method, analyze};
use sensitol_study::Study;
use sensitol_study::{DataProblem, StudyFault, StudyText};
use sensitol_testing::repository;

fn file(path: &str) -> String {
    std::fs::read_to_string(repository(path)).unwrap()
}

/// The study of an example with its table. The names that it uses are not on the disk.
fn pins() -> StudyText {
    StudyText::toml("pins.toml", file("examples/measured-pin/study.toml"))
        .with_file("pin.csv", file("examples/measured-pin/pin.csv"))
}

/// A study from a folder and one from the same bytes in memory agree: every number is the same double.
#[test]
fn text_and_files_are_one_study() {
    let read = Study::read(&repository("examples/measured-pin/study.toml")).unwrap();
    let text = Study::from_text(pins()).unwrap();
    assert_eq!((&text.sha256, &text.title, &text.lines), (&read.sha256, &read.title, &read.lines));
    let of = |study: &Study| analyze(&study.problem, &Method::Full.into()).unwrap().characteristics[0].moments;
    assert_eq!(of(&text), of(&read));
    assert!(of(&text).is_some());
}

/// A rewritten study in memory still has its table.
#[test]
fn a_study_in_memory_is_written_anew() {
    let text = Study::from_text(pins()).unwrap();
    assert!(text.rewritten(&text.problem).unwrap().text.contains("measured = \"pin.csv\""));
}

/// A name that was not given is not searched in the current folder. The most similar given name is suggested.
#[test]
fn a_file_that_was_not_given_is_named() {
    let table = file("examples/measured-pin/pin.csv");
    let study = StudyText::toml("pins.toml", file("examples/measured-pin/study.toml"));
    let problem = |study: StudyText| match *Study::from_text(study).unwrap_err().fault {
        StudyFault::Data(fault) => *fault.problem,
        other => panic!("{other:?}"),
    };
    let near = problem(study.clone().with_file("pins.csv", &table));
    assert_eq!(near, DataProblem::NotGiven { nearest: Some("pins.csv".into()), known: vec!["pins.csv".into()] });
    assert_eq!(near.help().unwrap(), "did you mean `pins.csv`?");
    // The repository's root, where tests run, has a file of this name.
    let text = study.with_file("other", &table);
    assert!(matches!(problem(text), DataProblem::NotGiven { nearest: None, .. }));
    let root = StudyText::toml("a.toml", "[dimensions]\na = { measured = \"Cargo.toml\" }").with_file("other", "");
    assert!(matches!(problem(root), DataProblem::NotGiven { .. }));
}

/// Text in memory has the formats, parameters and faults of files.
#[test]
fn text_is_read_as_files_are() {
    let json = r#"{ "dimensions": { "a": { "nominal": 1, "tolerance": 0.1 } },
        "constants": { "k": 2 }, "characteristics": { "y": { "formula": "k*a" } } }"#;
    let study = Study::from_text(StudyText::json("a.json", json).sweeping("k")).unwrap();
    let names: Vec<&str> = study.problem.dimensions().iter().map(|dimension| dimension.name()).collect();
    assert!(names.contains(&"a") && names.contains(&"k"), "{names:?}");
    let wrong = Study::from_text(StudyText::toml("wrong.toml", "[dimensions]\na = {")).unwrap_err();
    assert!(wrong.to_string().contains("wrong.toml"), "{wrong}");
}
