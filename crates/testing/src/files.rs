//! Files of the repository that tests read.

use std::path::{Path, PathBuf};

/// Path of a file of the repository.
pub fn repository(path: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).unwrap().join(path)
}

/// Text of a file of the repository.
pub fn read(path: &str) -> String {
    let file = repository(path);
    std::fs::read_to_string(&file).unwrap_or_else(|error| panic!("{}: {error}", file.display()))
}

/// Examples that need installed programs. `tests/adapters/run` runs their console blocks where those are installed.
pub const INSTALLED: [&str; 7] = [
    "stacked-blocks-freecad",
    "stack-up-workbook",
    "spot-weld-opencascade",
    "cantilever-umbridge",
    "four-bar-octave",
    "oscillator-fmi",
    "stacked-blocks-dask",
];

/// Studies of all examples, with the names of their folders. Settings files of adapters are left out.
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

/// Content of a JSON file of `tests/data`.
pub fn data(name: &str) -> serde_json::Value {
    let text = std::fs::read_to_string(repository("tests/data").join(name)).unwrap();
    serde_json::from_str(&text).unwrap()
}

/// Problem of this name in a file of `tests/data` that lists `problems`.
pub fn problem(file: &str, name: &str) -> serde_json::Value {
    let all = data(file);
    let found = all["problems"].as_array().unwrap().iter().find(|one| one["name"] == name);
    found.unwrap_or_else(|| panic!("no {name}")).clone()
}

/// Case of this name in the tests of geometric elements.
pub fn case(name: &str) -> serde_json::Value {
    let cases = data("elements.json");
    let found = cases["cases"].as_array().unwrap().iter().find(|case| case["name"] == name).cloned();
    found.unwrap_or_else(|| panic!("no case {name}"))
}

/// Asserts that the part of a document between the marks of this name is the given text. With `SENSITOL_UPDATE_DOCS` it writes the text
/// instead.
pub fn generated(document: &str, name: &str, text: &str) {
    let path = repository(document);
    let found = read(document);
    let (begin, end) = (format!("<!-- {name}: begin -->\n"), format!("<!-- {name}: end -->"));
    let start = found.find(&begin).unwrap() + begin.len();
    let stop = found.find(&end).unwrap();
    if std::env::var_os("SENSITOL_UPDATE_DOCS").is_some() {
        std::fs::write(path, format!("{}{text}{}", &found[..start], &found[stop..])).unwrap();
        return;
    }
    assert_eq!(&found[start..stop], text, "{document}: SENSITOL_UPDATE_DOCS=1 writes it anew");
}

/// Asserts that a page contains a sentence, regardless of line breaks and of marks of emphasis.
#[track_caller]
pub fn says(document: &str, sentence: &str) {
    let plain = |text: &str| text.replace("**", "").split_whitespace().collect::<Vec<_>>().join(" ");
    let text = std::fs::read_to_string(repository(document)).unwrap();
    assert!(plain(&text).contains(&plain(sentence)), "{document} does not say: {sentence}");
}
