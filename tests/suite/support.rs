//! The common part of the themes.

use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

use sensitol::assembly::EvaluationError;
use sensitol::{Closure, Dimension};

/// A file of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join(path)
}

/// Examples that need more than the repository has; `tests/adapters/run` runs their console blocks where that is installed.
pub const INSTALLED: [&str; 7] = [
    "stacked-blocks-freecad",
    "stack-up-workbook",
    "spot-weld-opencascade",
    "cantilever-umbridge",
    "four-bar-octave",
    "oscillator-fmi",
    "stacked-blocks-dask",
];

/// The studies of all examples, with the folder's name; what an adapter wants to know of its document is no study.
pub fn example_studies() -> Vec<(String, PathBuf)> {
    let mut studies = Vec::new();
    for folder in std::fs::read_dir(repository("examples")).unwrap() {
        let folder = folder.unwrap();
        for file in std::fs::read_dir(folder.path()).unwrap() {
            let path = file.unwrap().path();
            let study = path.extension().is_some_and(|extension| extension == "toml" || extension == "json");
            let own = |line: &str| ["document =", "servers ="].iter().any(|key| line.starts_with(key));
            if study && !std::fs::read_to_string(&path).unwrap().lines().any(own) {
                studies.push((folder.file_name().to_string_lossy().into_owned(), path));
            }
        }
    }
    studies
}

/// A JSON file of `tests/data`.
pub fn data(name: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(repository("tests/data").join(name)).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// The problem of this name in a file of `tests/data` that lists `problems`.
pub fn problem(file: &str, name: &str) -> serde_json::Value {
    let all = data(file);
    let found = all["problems"].as_array().unwrap().iter().find(|one| one["name"] == name);
    found.unwrap_or_else(|| panic!("no {name}")).clone()
}

/// Asserts `|found - expected| <= tolerance max(|expected|, scale)`.
#[track_caller]
pub fn close(found: f64, expected: f64, tolerance: f64, scale: f64) {
    let error = (found - expected).abs();
    let allowed = tolerance * expected.abs().max(scale);
    assert!(error <= allowed, "{found} is {error:e} off {expected}, more than {allowed:e}");
}

/// Asserts a relative error.
#[track_caller]
pub fn relative(found: f64, expected: f64, tolerance: f64) {
    close(found, expected, tolerance, 0.0);
}

/// Normal dimensions `x0`, `x1` and so on with these means and tolerances.
pub fn normals(means: &[f64], tolerances: &[f64]) -> Vec<Dimension> {
    let dimension = |(index, (&mean, &tolerance)): (usize, (&f64, &f64))| {
        Dimension::normal(format!("x{index}"), mean, tolerance).unwrap()
    };
    means.iter().zip(tolerances).enumerate().map(dimension).collect()
}

/// `n` normal dimensions with mean 0 and sigma 1.
pub fn standard(n: usize) -> Vec<Dimension> {
    normals(&vec![0.0; n], &vec![3.0; n])
}

/// Every point that a function was asked for.
#[derive(Clone, Default)]
pub struct Asked(Arc<Mutex<Vec<Vec<f64>>>>);

impl Asked {
    /// The points so far, in order of their coordinates.
    pub fn points(&self) -> Vec<Vec<f64>> {
        let mut points = self.0.lock().unwrap().clone();
        points.sort_by(|a, b| a.partial_cmp(b).unwrap());
        points
    }

    /// How many points were asked, each of them once.
    #[track_caller]
    pub fn distinct(&self) -> usize {
        let points = self.points();
        let mut once = points.clone();
        once.dedup();
        assert_eq!(once.len(), points.len(), "a point was evaluated twice");
        points.len()
    }

    /// A characteristic `y` that remembers its points.
    pub fn watching(&self, function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Closure {
        let asked = self.clone();
        Closure::scalar("y", move |x| {
            asked.0.lock().unwrap().push(x.to_vec());
            function(x)
        })
    }
}

/// A function with one output that refuses some points.
pub fn refusing(
    function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static,
    refuses: impl Fn(&[f64]) -> bool + Send + Sync + 'static,
) -> Closure {
    Closure::fallible(["y"], move |x| {
        if refuses(x) {
            return Err(EvaluationError::Refused { message: "does not assemble".into() });
        }
        Ok([function(x)])
    })
}

/// The child of `tests/children` in C, compiled: a linker for C is there wherever this was built.
pub fn child_in_c() -> String {
    static BUILT: std::sync::OnceLock<PathBuf> = std::sync::OnceLock::new();
    let built = BUILT.get_or_init(|| {
        let program = Path::new(env!("CARGO_TARGET_TMPDIR")).join(format!("flips-{}", std::process::id()));
        let source = repository("tests/children/flips.c");
        let done = std::process::Command::new("cc").arg("-O1").arg("-o").arg(&program).arg(source).arg("-lm").status();
        assert!(done.is_ok_and(|status| status.success()), "cc compiles tests/children/flips.c");
        program
    });
    built.display().to_string()
}
