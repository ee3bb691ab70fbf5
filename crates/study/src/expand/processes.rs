//! Expands `[processes]`: copies the capability of a named process to the dimensions and cost processes that name it.

use std::ops::Range;

use crate::data::Data;
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Tree, Value, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;

/// Keys that a process may have.
const KEYS: [&str; 7] = ["cp", "cpk", "sigma", "sigmas", "side", "drift", "distribution"];
/// Keys of the spread. One of them at the dimension replaces all of those of the process.
const SPREADS: [&str; 4] = ["sigma", "sigmas", "cp", "cpk"];

/// Gives every dimension and every process of a cost with the key `process` the keys of that process which it lacks. Removes the section.
pub(super) fn expand(expanded: &mut Expanded, data: &mut Data<'_>) -> Result<(), Faults> {
    let processes = match expanded.tree.get("processes") {
        Some(section) => read(section, data)?,
        None => Vec::new(),
    };
    if let Some(sections) = expanded.tree.entries_mut() {
        sections.retain(|(key, _)| key.name != "processes");
    }
    let mut faults = Faults::default();
    for (dimension, line) in expanded.tree.get_mut("dimensions").and_then(Tree::entries_mut).into_iter().flatten() {
        taken(line, &processes, &format!("dimensions.{}", dimension.name), &mut faults);
    }
    for (dimension, line) in expanded.tree.get_mut("costs").and_then(Tree::entries_mut).into_iter().flatten() {
        let Some(Value::Array(list)) = line.get_mut("processes").map(|list| &mut list.value) else { continue };
        for (index, process) in list.iter_mut().enumerate() {
            let at = format!("costs.{}.processes[{}]", dimension.name, index + 1);
            taken(process, &processes, &at, &mut faults);
        }
    }
    faults.none()
}

/// Fills a line that has the key `process` with the keys of that process that it leaves out.
fn taken(line: &mut Tree, processes: &Processes, at: &str, faults: &mut Faults) {
    let Some(line) = line.entries_mut() else { return };
    let Some(place) = line.iter().position(|(key, _)| key.name == "process") else { return };
    let (_, named) = line.remove(place);
    let at = format!("{at}.process");
    let Value::Text(name) = &named.value else {
        faults.0.push(wrong_type(&named, at, "the name of a process such as \"turning\""));
        return;
    };
    match processes.iter().find(|(known, _)| known == name) {
        Some((_, keys)) => merge(line, keys),
        None => faults.0.push(unknown(name, named.span.clone(), at, processes)),
    }
}

/// Processes by name, with their keys.
type Processes = Vec<(String, Vec<(Key, Tree)>)>;

fn unknown(name: &str, span: Range<usize>, at: String, processes: &Processes) -> Fault {
    if processes.is_empty() {
        let instead =
            "a process is a line of [processes], or of a file: write processes = \"shop.toml\" at the top".into();
        return fault(span, at, StudyFault::MissingKey { key: "processes".into(), instead });
    }
    let known: Vec<String> = processes.iter().map(|(name, _)| name.clone()).collect();
    let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
    fault(span, at, StudyFault::UnknownWord { what: "process", found: name.to_owned(), nearest, known })
}

/// Copies keys to a line. Keys that the line has take precedence.
fn merge(line: &mut Vec<(Key, Tree)>, keys: &[(Key, Tree)]) {
    let has = |line: &[(Key, Tree)], names: &[&str]| line.iter().any(|(key, _)| names.contains(&key.name.as_str()));
    let own = has(line, &SPREADS);
    for (key, value) in keys {
        let spread = SPREADS.contains(&key.name.as_str()) || key.name == "side";
        if !(spread && own || has(line, &[key.name.as_str()])) {
            line.push((key.clone(), value.clone()));
        }
    }
}

/// Reads the section, or the file that it names.
fn read(section: &Tree, data: &mut Data<'_>) -> Result<Processes, Faults> {
    match &section.value {
        Value::Table(entries) => checked(entries),
        Value::Text(file) => {
            let at = |found| fault(section.span.clone(), "processes", found);
            let text = data.text(file).map_err(|found| at(StudyFault::Data(found)))?;
            let of_file = |fault: &Fault| {
                let line = fault.span.as_ref().map(|span| 1 + text[..span.start.min(text.len())].matches('\n').count());
                StudyFault::ProcessFile { file: file.clone(), line, key: fault.key.clone(), fault: fault.fault.clone() }
            };
            let tree = Tree::of_toml(&text).map_err(|fault| at(of_file(&fault)))?;
            let mut found = checked(tree.entries())
                .map_err(|faults| Faults(faults.0.iter().map(|found| at(of_file(found))).collect()))?;
            // Places in that file are not places in the study, so the section stands for them.
            found.iter_mut().flat_map(|(_, keys)| keys).for_each(|(key, value)| {
                key.span = section.span.clone();
                replace(value, &section.span);
            });
            Ok(found)
        }
        _ => {
            Err(wrong_type(section, "processes".into(), "a table of processes, or the name of a file with one,").into())
        }
    }
}

fn replace(tree: &mut Tree, span: &Range<usize>) {
    tree.span = span.clone();
    match &mut tree.value {
        Value::Table(entries) => entries.iter_mut().for_each(|(key, value)| {
            key.span = span.clone();
            replace(value, span);
        }),
        Value::Array(items) => items.iter_mut().for_each(|item| replace(item, span)),
        _ => {}
    }
}

fn checked(entries: &[(Key, Tree)]) -> Result<Processes, Faults> {
    let (mut processes, mut faults) = (Vec::new(), Faults::default());
    for (name, process) in entries {
        let at = format!("processes.{}", name.name);
        let Value::Table(keys) = &process.value else {
            faults.0.push(wrong_type(process, at, "a table such as { cp = 1.33, cpk = 1.0 }"));
            continue;
        };
        for (key, _) in keys.iter().filter(|(key, _)| !KEYS.contains(&key.name.as_str())) {
            let nearest = nearest(&key.name, KEYS).map(str::to_owned);
            let valid = KEYS.map(str::to_owned).to_vec();
            let found = StudyFault::UnknownKey { key: key.name.clone(), nearest, valid };
            faults.0.push(fault(key.span.clone(), format!("{at}.{}", key.name), found));
        }
        processes.push((name.name.clone(), keys.clone()));
    }
    faults.none().map(|()| processes)
}
