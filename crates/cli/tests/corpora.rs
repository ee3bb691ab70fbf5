//! Replays the corpora of the fuzz targets on every `cargo test`. `fuzz/` searches for more inputs.

#[path = "../../../fuzz/src/targets.rs"]
mod targets;

use std::path::{Path, PathBuf};

/// Returns the files of a folder in order, or none if the folder is missing.
fn files(folder: PathBuf) -> Vec<PathBuf> {
    let mut files: Vec<PathBuf> =
        std::fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    files.sort();
    files
}

/// Runs the corpus of a target. A target that panics prints its input; this function adds the file's name.
fn replay(name: &str) {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let target = targets::TARGETS.iter().find(|target| target.name == name).unwrap();
    let mut inputs = files(root.join("fuzz/corpus").join(name));
    assert!(!inputs.is_empty(), "{name} has no corpus");
    if name == "study_toml" {
        let examples = files(root.join("examples")).into_iter().flat_map(files);
        inputs.extend(examples.filter(|path| path.extension().is_some_and(|ending| ending == "toml")));
    }
    for input in inputs {
        let bytes = std::fs::read(&input).unwrap();
        let kept = std::panic::catch_unwind(|| (target.run)(&bytes));
        assert!(kept.is_ok(), "{} breaks a promise of {name}", input.display());
    }
}

macro_rules! replayed {
    ($($name:ident),*) => {
        $(#[test]
        fn $name() {
            replay(stringify!($name));
        })*

        /// A target that is missing from the list would not be replayed.
        #[test]
        fn every_target_is_replayed() {
            assert_eq!(targets::TARGETS.map(|target| target.name), [$(stringify!($name)),*]);
        }
    };
}

replayed!(
    study_toml,
    study_json,
    assembly,
    formula,
    measured_csv,
    protocol,
    journal,
    pearson,
    fits,
    command_line,
    import,
    step
);
