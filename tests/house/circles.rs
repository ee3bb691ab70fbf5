//! Files do not import each other in circles: each can be read after those that it imports.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::{code, modules, packages};

/// Modules by their path (`allocation/choose`, and `allocation` for its `mod.rs`), with their code without comments and tests.
struct Sources {
    code: BTreeMap<String, String>,
    /// True if circles are sought among all files of the package; false if only among those of one top module, as layers order the others.
    whole: bool,
}

impl Sources {
    /// Modules of one package.
    fn of(package: &str) -> Self {
        Self { code: modules(package), whole: !["engine", "numeric"].contains(&package) }
    }

    /// The module that a path leads to from this one, and the name that is taken of it; None where it leads out of the crate.
    fn resolved(&self, from: &str, path: &[String]) -> Option<(String, Option<String>)> {
        let mut at: Vec<&str> = from.split('/').collect();
        let mut rest = path.iter().map(String::as_str).peekable();
        match *rest.peek()? {
            "crate" => {
                at.clear();
                rest.next();
            }
            "self" => {
                rest.next();
            }
            "super" => {
                while rest.next_if_eq(&"super").is_some() {
                    at.pop();
                }
            }
            child if self.code.contains_key(&format!("{from}/{child}")) => {}
            _ => return None,
        }
        while let Some(&next) = rest.peek() {
            at.push(next);
            if !self.code.contains_key(&at.join("/")) {
                at.pop();
                break;
            }
            rest.next();
        }
        Some((at.join("/"), rest.next().map(str::to_owned)))
    }

    /// The imports of each module from the same top module, by the module in which a name is defined rather than one that passes
    /// it on.
    fn imports(&self) -> BTreeMap<&str, BTreeSet<String>> {
        let mut passed: BTreeMap<(String, String), String> = BTreeMap::new();
        for (module, code) in &self.code {
            for path in uses(code).filter(|(public, _)| *public).flat_map(|(_, tree)| paths(tree)) {
                if let Some((target, Some(name))) = self.resolved(module, &path) {
                    passed.insert((module.clone(), name), target);
                }
            }
        }
        let imports = |(module, code): (&'_ String, &String)| {
            let in_uses = uses(code).flat_map(|(_, tree)| paths(tree));
            let targets = in_uses.chain(inline(code)).filter_map(|path| {
                let (mut target, name) = self.resolved(module, &path)?;
                let name = name.unwrap_or_default();
                // No name is passed on more often than there are modules.
                for _ in 0..self.code.len() {
                    match passed.get(&(target.clone(), name.clone())) {
                        Some(next) if *next != target => target.clone_from(next),
                        _ => break,
                    }
                }
                Some(target)
            });
            let within = |target: &String| {
                let apart = |a: &str, b: &str| !a.starts_with(&format!("{b}/"));
                let top = |path: &str| path.split('/').next().unwrap_or_default().to_owned();
                // A folder's `mod.rs` and its files belong together.
                let together = self.whole || top(target) == top(module);
                !target.is_empty() && target != module && together && apart(target, module) && apart(module, target)
            };
            targets.filter(within).collect()
        };
        self.code.iter().map(|entry| (entry.0.as_str(), imports(entry))).collect()
    }
}

/// The trees of all `use` items, and whether others may use what they name.
fn uses(code: &str) -> impl Iterator<Item = (bool, &str)> {
    code.split(';').filter_map(|item| {
        let at = item.find("use ").filter(|&at| at == 0 || item[..at].ends_with([' ', '\n']))?;
        let line = item[..at].rsplit('\n').next().unwrap_or_default();
        Some((line.trim_start().starts_with("pub"), item[at + 4..].trim()))
    })
}

/// The paths of a tree such as `a::{b, c::{d, e}}`.
fn paths(tree: &str) -> Vec<Vec<String>> {
    let tree = tree.trim();
    if let Some(list) = tree.strip_prefix('{') {
        let mut found = Vec::new();
        let (mut depth, mut start) = (0, 0);
        for (at, c) in list.char_indices() {
            match c {
                '{' => depth += 1,
                '}' if depth > 0 => depth -= 1,
                ',' | '}' if depth == 0 => {
                    let part = list[start..at].trim();
                    found.extend(if part.is_empty() { Vec::new() } else { paths(part) });
                    start = at + 1;
                    if c == '}' {
                        break;
                    }
                }
                _ => {}
            }
        }
        return found;
    }
    match tree.split_once("::") {
        Some((first, rest)) => {
            let begun = |path: Vec<String>| [vec![first.trim().to_owned()], path].concat();
            paths(rest).into_iter().map(begun).collect()
        }
        None => vec![vec![tree.split(" as ").next().unwrap_or_default().trim().to_owned()]],
    }
}

/// Paths in the code itself, such as `super::a::b`.
fn inline(code: &str) -> impl Iterator<Item = Vec<String>> {
    ["crate::", "super::", "self::"].into_iter().flat_map(move |start| {
        code.match_indices(start).filter_map(move |(at, _)| {
            let before = code[..at].chars().last();
            let whole = before.is_none_or(|c| !c.is_alphanumeric() && c != '_' && c != ':');
            let path: String =
                code[at..].chars().take_while(|c| c.is_alphanumeric() || *c == '_' || *c == ':').collect();
            whole.then(|| path.split("::").filter(|name| !name.is_empty()).map(str::to_owned).collect())
        })
    })
}

/// Sets of modules each of which reaches each other of the set.
fn circles(imports: &BTreeMap<&str, BTreeSet<String>>) -> Vec<Vec<String>> {
    let reached = |from: &str| {
        let mut seen: BTreeSet<&str> = BTreeSet::new();
        let mut open = vec![from];
        while let Some(module) = open.pop() {
            for next in imports.get(module).into_iter().flatten() {
                if seen.insert(next) {
                    open.push(next);
                }
            }
        }
        seen
    };
    let reaches: BTreeMap<&str, BTreeSet<&str>> = imports.keys().map(|&module| (module, reached(module))).collect();
    let mut found: BTreeSet<Vec<String>> = BTreeSet::new();
    for (&module, seen) in reaches.iter().filter(|(module, seen)| seen.contains(*module)) {
        let back = |other: &&&str| reaches.get(**other).is_some_and(|of| of.contains(module));
        found.insert(seen.iter().filter(back).map(|&other| other.to_owned()).collect());
    }
    found.into_iter().collect()
}

#[test]
fn files_do_not_import_each_other_in_circles() {
    for package in packages() {
        let sources = Sources::of(&package);
        let found = circles(&sources.imports());
        assert!(found.is_empty(), "circles of files in {package}: {found:#?}");
    }
}

#[test]
fn the_check_of_circles_sees_every_form() {
    let of = |files: &[(&str, &str)]| {
        let code = files.iter().map(|&(path, text)| (path.to_owned(), code(text))).collect();
        let sources = Sources { code, whole: false };
        circles(&sources.imports())
    };
    let both = vec![vec!["a/b".to_owned(), "a/c".to_owned()]];
    assert_eq!(of(&[("a", "mod b;"), ("a/b", "use super::c::{C, D};"), ("a/c", "use crate::a::b::B;")]), both);
    // By a name that the folder passes on, and by a path in the code.
    let passed = "pub use b::B;\npub(crate) use c::{C, D as E};";
    assert_eq!(of(&[("a", passed), ("a/b", "use super::{C};"), ("a/c", "fn f() -> super::B {}")]), both);
    assert_eq!(
        of(&[("a", ""), ("a/b", "use super::c::C;"), ("a/c", "// use super::b::B;\nuse std::fmt;")]),
        [[""; 0]; 0]
    );
    assert_eq!(
        of(&[("a", "mod b;"), ("a/b", "use super::c;"), ("a/c", "use super::b::{self, B};")]),
        both,
        "whole modules"
    );
    assert_eq!(of(&[("a", "use b::B;"), ("a/b", "use super::A;")]), [[""; 0]; 0], "a folder and its own file");
}
