//! `sensitol examples`, and the schema that new studies name.

use std::path::Path;

use super::command::sensitol;
use sensitol_testing::repository;

#[test]
fn every_example_is_listed_with_its_title() {
    let printed = |arguments: &[&str]| String::from_utf8(sensitol(arguments).output().unwrap().stdout).unwrap();
    let listed = printed(&["examples"]);
    let folders =
        std::fs::read_dir(repository("examples")).unwrap().filter(|one| one.as_ref().unwrap().path().is_dir());
    let names: Vec<String> = folders.map(|one| one.unwrap().file_name().into_string().unwrap()).collect();
    assert_eq!(listed.lines().count(), names.len());
    for name in names {
        let line = listed.lines().find(|line| line.starts_with(&format!("{name} "))).unwrap();
        assert!(line.len() > name.len() + 5, "{line}");
    }
    assert_eq!(listed, printed(&["examples", "list"]));
}

/// Lists files and their bytes below a folder.
fn files(folder: &Path) -> Vec<(String, Vec<u8>)> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            found.extend(files(&path).into_iter().map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else if !name.contains(".journal.sqlite") {
            found.push((name, std::fs::read(path).unwrap()));
        }
    }
    found.sort();
    found
}

#[test]
fn a_copy_has_every_file_and_runs() {
    let folder = tempfile::tempdir().unwrap();
    let within = |arguments: &[&str]| sensitol(arguments).current_dir(folder.path()).output().unwrap();
    let told = String::from_utf8(within(&["examples", "copy", "engine-balance"]).stdout).unwrap();
    assert!(told.contains("next: sensitol analyze engine-balance/study.toml"), "{told}");
    assert_eq!(files(&folder.path().join("engine-balance")), files(&repository("examples/engine-balance")));
    assert!(within(&["analyze", "engine-balance/study.toml", "--brief"]).status.success());
    // A folder that is there stays as it is, and a missing one around it is an error. Neither leaves anything.
    let before = files(folder.path());
    for arguments in
        [&["examples", "copy", "first-study", "engine-balance"], &["examples", "copy", "first-study", "no/way"]]
    {
        assert_eq!(within(arguments).status.code(), Some(2));
    }
    assert_eq!(files(folder.path()), before);
    let told = String::from_utf8(within(&["examples", "copy", "oscillator-fmi", "fmi"]).stdout).unwrap();
    assert!(told.contains("study.toml needs ../../adapters/fmi/sensitol_fmi.py"), "{told}");
}

/// A new study names its schema by a file beside it, and is valid by that file's schema.
#[test]
fn new_studies_name_their_schema() {
    let folder = tempfile::tempdir().unwrap();
    let within = |arguments: &[&str]| {
        let output = sensitol(arguments).current_dir(folder.path()).output().unwrap();
        assert!(output.status.success(), "{arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
    };
    std::fs::write(folder.path().join("stack.csv"), "name,nominal,tolerance,direction\na,10,0.1,+\nb,4,0.05,-\n")
        .unwrap();
    within(&["init", "gap"]);
    within(&["import", "stack.csv", "-o", "stack.toml"]);
    within(&["schema", "-o", "study.schema.json"]);
    let schema: serde_json::Value =
        serde_json::from_str(&std::fs::read_to_string(folder.path().join("study.schema.json")).unwrap()).unwrap();
    assert_eq!(schema["$id"], sensitol_study::schema::SCHEMA_ID);
    let validator = jsonschema::validator_for(&schema).unwrap();
    for study in ["gap.toml", "stack.toml"] {
        let text = std::fs::read_to_string(folder.path().join(study)).unwrap();
        let named = text.lines().next().unwrap().strip_prefix("#:schema ").unwrap();
        assert!(folder.path().join(named).is_file(), "{named}");
        let value = serde_json::to_value(toml::from_str::<toml::Table>(&text).unwrap()).unwrap();
        assert!(validator.is_valid(&value), "{study}");
        within(&["check", study]);
        // The key of JSON editors does the same and changes nothing.
        std::fs::write(folder.path().join(study), format!("\"$schema\" = \"./study.schema.json\"\n{text}")).unwrap();
        within(&["check", study]);
    }
}
