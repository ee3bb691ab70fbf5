//! The source files of all packages, as the tests of their structure read them.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use sensitol_testing::repository;

/// A source file of a package.
pub struct SourceFile {
    /// The package: `engine` for `src`, else the folder of `crates`.
    pub package: String,
    /// The path below the package's `src`, such as `allocation/choose.rs`.
    pub path: String,
    /// The text as it is.
    pub text: String,
}

impl SourceFile {
    /// The module path, with `/` between modules: `allocation/choose`, and `allocation` for `allocation/mod.rs`.
    pub fn module(&self) -> String {
        let stem = self.path.strip_suffix(".rs").unwrap_or(&self.path);
        stem.strip_suffix("/mod").unwrap_or(stem).to_owned()
    }

    /// The path from the top of the repository.
    pub fn name(&self) -> String {
        match self.package.as_str() {
            "engine" => format!("src/{}", self.path),
            package => format!("crates/{package}/src/{}", self.path),
        }
    }

    /// The code without comments and without the module of tests at its end.
    pub fn code(&self) -> String {
        code(&self.text)
    }
}

/// Every source file of `src` and `crates`, in the order of their paths. The package of test helpers is not among them.
pub fn sources() -> Vec<SourceFile> {
    let mut found = package("engine", &repository("src"));
    let mut packages: Vec<PathBuf> =
        std::fs::read_dir(repository("crates")).unwrap().map(|entry| entry.unwrap().path()).collect();
    packages.sort();
    for folder in packages {
        let name = folder.file_name().unwrap().to_str().unwrap().to_owned();
        if name != "testing" {
            found.extend(package(&name, &folder.join("src")));
        }
    }
    assert!(found.len() > 300, "{} source files were read", found.len());
    found
}

/// The code of every module of one package.
pub fn modules(package: &str) -> BTreeMap<String, String> {
    let of_package = sources().into_iter().filter(|file| file.package == package);
    of_package.map(|file| (file.module(), file.code())).collect()
}

/// The names of all packages.
pub fn packages() -> Vec<String> {
    let mut names: Vec<String> = sources().into_iter().map(|file| file.package).collect();
    names.dedup();
    names
}

fn package(name: &str, root: &Path) -> Vec<SourceFile> {
    let mut paths = Vec::new();
    let mut folders = vec![root.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in std::fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                paths.push(path);
            }
        }
    }
    paths.sort();
    let file = |path: PathBuf| SourceFile {
        package: name.to_owned(),
        path: path.strip_prefix(root).unwrap().display().to_string().replace('\\', "/"),
        text: std::fs::read_to_string(&path).unwrap(),
    };
    paths.into_iter().map(file).collect()
}

/// The code of a file without comments and without the module of tests at its end.
pub fn code(text: &str) -> String {
    let lines: Vec<&str> = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
    // A module of tests stands at the end of its file; one that is a file of its own is declared above the others.
    let begins_tests = |pair: &[&str]| pair[0] == "#[cfg(test)]" && pair[1].ends_with('{');
    lines[..lines.windows(2).position(begins_tests).unwrap_or(lines.len())].join("\n")
}
