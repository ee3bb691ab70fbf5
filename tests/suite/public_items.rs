//! The public interface is counted, so that it does not grow unseen.
//!
//! Counted is what a user of the library can name: modules, structures, enumerations, traits, functions, constants, statics and
//! types that are reached from `lib.rs` by `pub mod` and `pub use`, each once, and the public functions and constants of these
//! types. Fields, variants, functions of traits and implementations belong to their item and are not counted; neither is what is
//! `#[doc(hidden)]`. Source files are formatted, so that a line begins an item or an implementation.

use std::collections::{BTreeMap, BTreeSet};

use super::circles::{Sources, code, paths, uses};

/// As many as there are. A change that takes some away lowers it; one that adds some says why.
///
/// `SimulationOptions::with_target_joint_yield` came with the joint yield of samples. `Externals::with_configuration` came before: a library reads the sizes of a study too.
/// `Externals::with_host`, `Study::with_analysis` and `StudyText::in_folder` came too: what a calling program needs.
///
/// `AllocationOptions::with_confirm_or_default` and `AllocationTask::relative_or_default` hold what the command line and Python both do.
///
/// Ten came with the questions that an allocation answers: `QualityLoss`, `SetUp`, `JointKept`, `FrontRequirement`, costs as formulas and
/// tables, `Offer::on`, and `Study::in_configurations`, which requires the same in several states.
///
/// `Tabulated`, and `DifferenceReport` of two revisions, made four more.
///
/// Seven are distributions: `Student` by sigma or by scale, `UShaped` and `CurvilinearTrapezoid`.
///
/// Nine came with Sobol' indices: `EstimatedShare`, `FactorIndices`, `IndexSource` and `SobolIndices` of analyses, `IndexEstimate` and `SampledFactor` of
/// simulations, and their two options. Ten came with inspection: its module, `Inspection` with four functions, `Guard`, `InspectionError`, `InspectionRisks`,
/// and two functions of `Characteristic`.
///
/// `TwoValues` and its `new` came with play that lies on either side.
///
/// `Drifting` and its `new` are processes whose mean drifts. Five came with measurement uncertainty: `CoverageIntervals` and their option, `Budget`,
/// `BudgetRow`, and `Report::budgets`. `AllocationSolver` names the solver of an allocation.
const MOST: usize = 589;

const KINDS: &[&str] = &["fn", "const fn", "struct", "enum", "trait", "const", "static", "type"];

/// An item that a file defines, or a module that it declares.
struct Item {
    name: String,
    hidden: bool,
    public: bool,
    module: bool,
}

/// The items of a file, and for every type the names of its public functions and constants.
type Defined = (Vec<Item>, Vec<(String, String)>);

/// The items that the code of a file defines beside functions of types, and for every type its public functions and constants.
fn defined(code: &str) -> Defined {
    let (mut items, mut members) = (Vec::new(), Vec::new());
    let (mut hidden, mut of): (bool, Option<(String, String)>) = (false, None);
    for line in code.lines() {
        let indent = &line[..line.len() - line.trim_start().len()];
        let line = line.trim();
        if line.starts_with("#[") {
            hidden |= line == "#[doc(hidden)]";
            continue;
        }
        if of.as_ref().is_some_and(|(end, _)| indent == end && line == "}") {
            of = None;
        } else if of.is_none() && (line.starts_with("impl ") || line.starts_with("impl<")) && line.ends_with('{') {
            of = Some((indent.to_owned(), if line.contains(" for ") { String::new() } else { implemented(line) }));
        } else if let Some((name, module)) = begun(line.strip_prefix("pub ").unwrap_or(line)) {
            match &of {
                None => items.push(Item { name, hidden, public: line.starts_with("pub "), module }),
                Some((_, of)) if line.starts_with("pub ") && !hidden => members.push((of.clone(), name)),
                Some(_) => {}
            }
        }
        hidden = false;
    }
    (items, members)
}

/// The code without what stands inside modules of the same file, and without names that are passed on within the crate only.
fn outside(code: &str) -> String {
    let mut inside = false;
    let keeps = |line: &&str| {
        let begins = line.trim_start_matches("pub ").starts_with("mod ") && line.ends_with('{');
        inside = (inside || begins) && *line != "}";
        !inside
    };
    let code = code.lines().filter(keeps).collect::<Vec<_>>().join("\n");
    code.replace("pub(crate) use ", "use ").replace("pub(super) use ", "use ")
}

/// The type of an `impl<'a> Type<'a> {`.
fn implemented(line: &str) -> String {
    let mut depth = 0;
    let after = line["impl".len()..].find(|c: char| {
        depth += i32::from(c == '<') - i32::from(c == '>');
        depth == 0 && c == ' '
    });
    name(after.map_or("", |at| &line["impl".len() + at + 1..]))
}

fn name(text: &str) -> String {
    text.chars().take_while(|c| c.is_alphanumeric() || *c == '_').collect()
}

/// The name of the item that a line begins, and whether it is a module.
fn begun(line: &str) -> Option<(String, bool)> {
    if let Some(module) = line.strip_prefix("mod ").and_then(|rest| rest.strip_suffix(';')) {
        return Some((module.to_owned(), true));
    }
    let rest = KINDS.iter().find_map(|kind| line.strip_prefix(kind)?.strip_prefix(' '))?;
    Some((name(rest), false))
}

/// Everything public, by its module and name, with the functions of types as `Type::function`.
struct Surface<'s> {
    sources: &'s Sources,
    defined: BTreeMap<&'s str, Defined>,
    found: BTreeSet<(String, String)>,
}

impl<'s> Surface<'s> {
    fn of(sources: &'s Sources) -> BTreeSet<(String, String)> {
        let defined = sources.0.iter().map(|(module, code)| (module.as_str(), defined(code))).collect();
        let mut surface = Self { sources, defined, found: BTreeSet::new() };
        surface.module("lib");
        let types: BTreeSet<String> = surface.found.iter().map(|(_, name)| name.clone()).collect();
        for (module, (_, members)) in &surface.defined {
            let public = members.iter().filter(|(of, _)| types.contains(of));
            surface.found.extend(public.map(|(of, name)| ((*module).to_owned(), format!("{of}::{name}"))));
        }
        surface.found
    }

    fn module(&mut self, module: &str) {
        let sources = self.sources;
        let Some((items, _)) = self.defined.get(module) else { return };
        let public: Vec<(String, bool)> = items
            .iter()
            .filter(|item| item.public && !item.hidden)
            .map(|item| (item.name.clone(), item.module))
            .collect();
        for (name, is_module) in public {
            let inner = if module == "lib" { name.clone() } else { format!("{module}/{name}") };
            if self.found.insert((module.to_owned(), name)) && is_module {
                self.module(&inner);
            }
        }
        for path in uses(&outside(&sources.0[module])).filter(|(public, _)| *public).flat_map(|(_, tree)| paths(tree)) {
            self.passed_on(module, &path, 0);
        }
    }

    /// The item that a `use` names, in the module that defines it.
    fn passed_on(&mut self, module: &str, path: &[String], depth: usize) {
        let root = [vec!["crate".to_owned()], path.to_vec()].concat();
        let path = if module == "lib" && path[0] != "crate" { &root } else { path };
        let Some((target, Some(name))) = self.sources.resolved(module, path) else { return };
        let Some((items, _)) = self.defined.get(target.as_str()) else { return };
        if items.iter().any(|item| item.name == name && !item.module) {
            self.found.insert((target, name));
        } else if depth < self.sources.0.len() {
            let all = uses(&self.sources.0[&target]).flat_map(|(_, tree)| paths(tree));
            let next = all.into_iter().find(|path| path.last() == Some(&name) && path.len() > 1);
            match next {
                Some(next) => self.passed_on(&target, &next, depth + 1),
                // An item that a macro defines stands in its file.
                None => {
                    let within = |module: &&str| module.starts_with(&format!("{target}/"));
                    let defines = |module: &&str| self.defined[*module].0.iter().any(|item| item.name == name);
                    if let Some(&module) = self.defined.keys().find(|module| within(module) && defines(module)) {
                        self.found.insert((module.to_owned(), name));
                    }
                }
            }
        }
    }
}

#[test]
fn the_public_interface_does_not_grow_unseen() {
    let sources = Sources::read();
    let found = Surface::of(&sources);
    let mut by_module: BTreeMap<&str, usize> = BTreeMap::new();
    for (module, _) in &found {
        *by_module.entry(module.split('/').next().unwrap_or_default()).or_default() += 1;
    }
    assert!(found.len() <= MOST, "{} public items, more than {MOST}: {by_module:#?}", found.len());
    assert!(found.len() + 10 >= MOST, "only {} public items: lower MOST from {MOST}", found.len());
}

#[test]
fn the_count_sees_every_form() {
    let of = |files: &[(&str, &str)]| {
        let sources = Sources(files.iter().map(|&(path, text)| (path.to_owned(), code(text))).collect());
        Surface::of(&sources).into_iter().map(|(module, name)| format!("{module}/{name}")).collect::<Vec<String>>()
    };
    let root = "pub mod a;\nmod b;\n#[doc(hidden)]\npub mod c;\npub use b::{B, f};\npub mod i {\n    pub use crate::b::Unseen;\n}\n";
    let a = "mod d;\npub use d::D;\npub(crate) use d::E;\npub struct A;\nimpl<'a> A<'a> {\n    pub fn new() {}\n    fn own() {}\n}\n";
    let b = "pub struct B;\npub fn f() {}\npub struct Unseen;\nimpl B {\n    pub const fn one() {}\n    #[doc(hidden)]\n    \
             pub fn two() {}\n}\nimpl Unseen {\n    pub fn three() {}\n}\nimpl Trait for B {\n    fn four() {}\n}\n";
    let d = "pub enum D {}\npub enum E {}\n#[cfg(test)]\nmod tests {\n    pub struct T;\n}\n";
    let found = of(&[("lib", root), ("a", a), ("a/d", d), ("b", b), ("c", "pub struct C;")]);
    assert_eq!(found, ["a/A", "a/A::new", "a/d/D", "b/B", "b/B::one", "b/f", "lib/a"]);
}
