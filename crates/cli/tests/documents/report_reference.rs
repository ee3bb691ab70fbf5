//! `docs/reference/json-report.md`, generated from the schema of reports.

use std::collections::BTreeMap;
use std::fmt::Write;

use serde_json::Value;

use super::command::sensitol;
use super::reference::{anchor, once};

const INTRODUCTION: &str = "# JSON reports\n\n\
    `--json` prints one object, or a list if a command says so. This page is made from the JSON Schema that `sensitol schema --report` prints,\n\
    with the type and the description of every key.\n\n\
    - A line has the key, its type and its meaning. `?` means that the value may be `null`; objects are a list of them.\n\
    - Objects within objects have their keys only. Parentheses have the keys of a further object.\n\
    - Numbers have all their digits. An unknown value is `null`, never 0; no key is left out.\n\
    - `schema` is the version of the shape. Keys are added without a new version; a key that changes its meaning or is removed raises it.\n\
    - Several studies in one call give a list: each report has the key `study`, or it is `{ \"study\": .., \"error\": .., \"errors\": [{ .. }] }`.\n\
    - An error gives the object [errors](#errors) on stdout, and its text on stderr. `check` gives a report of a study with errors too.\n\
    - Exit codes are those of the text report: [commands](commands.md).\n\n";

/// Returns the text of the page.
pub fn json_report() -> String {
    let output = sensitol(&["schema", "--report"]).output().unwrap();
    let schema: Value = serde_json::from_slice(&output.stdout).unwrap();
    let mut page =
        Page { defs: &schema["$defs"], text: INTRODUCTION.to_owned(), done: Vec::new(), lines: BTreeMap::new() };
    for command in schema["anyOf"].as_array().unwrap() {
        let name = name(command).unwrap();
        // The list of several reports contains no new keys.
        if name == "analyze-several" {
            continue;
        }
        let of = page.resolved(command);
        write!(page.text, "## {name}\n\n").unwrap();
        if of["type"] == "array" {
            page.text += "A list of objects.\n\n";
        }
        let objects = page.objects(of);
        page.section(&objects, name);
    }
    page.text.trim_end().to_owned() + "\n"
}

/// Returns the target of a reference.
fn name(value: &Value) -> Option<&str> {
    value["$ref"].as_str().map(|path| path.strip_prefix("#/$defs/").unwrap())
}

struct Page<'s> {
    defs: &'s Value,
    text: String,
    /// Objects that have been shown, with their headings, and the key whose line has their keys.
    done: Vec<(Vec<&'s Value>, String, Option<&'s str>)>,
    /// Lines of keys that have been shown, with their headings.
    lines: BTreeMap<String, String>,
}

impl<'s> Page<'s> {
    fn resolved(&self, mut value: &'s Value) -> &'s Value {
        while let Some(name) = name(value) {
            value = &self.defs[name];
        }
        value
    }

    /// Returns the alternatives of a value.
    fn forms(&self, value: &'s Value) -> Vec<&'s Value> {
        let value = self.resolved(value);
        let parts = ["anyOf", "oneOf", "allOf"].iter().find_map(|key| value[*key].as_array());
        parts.map_or(vec![value], |parts| parts.iter().flat_map(|part| self.forms(part)).collect())
    }

    /// Returns the objects with keys that a value may be, or is a list of.
    fn objects(&self, value: &'s Value) -> Vec<&'s Value> {
        let mut found = Vec::new();
        for form in self.forms(value) {
            if form.get("properties").is_some() {
                found.push(form);
            } else if let Some(within) = form.get("items").or(form.get("additionalProperties")) {
                found.extend(self.objects(within));
            }
        }
        found
    }

    /// Writes a table of the keys of these objects, then the tables of keys that are objects themselves.
    fn section(&mut self, objects: &[&'s Value], path: &str) {
        let mut keys: BTreeMap<&'s str, Vec<&'s Value>> = BTreeMap::new();
        for object in objects {
            for (key, value) in object["properties"].as_object().unwrap() {
                keys.entry(key).or_default().push(value);
            }
        }
        let mut below = Vec::new();
        let mut rows = Vec::new();
        for (key, values) in keys {
            let mut kind = self.kind(&values);
            let objects: Vec<&'s Value> = values.iter().copied().flat_map(|value| self.objects(value)).collect();
            let mut within = String::new();
            if let Some((_, place, of)) = self.done.iter().find(|(known, ..)| *known == objects) {
                kind = linked(&kind, place);
                within = of.map_or(String::new(), |of| format!(" (keys as of `{of}`)"));
            } else if !objects.is_empty() && path.contains(": ") {
                within = format!(": {}", self.names(&objects));
                self.done.push((objects, path.to_owned(), Some(key)));
            } else if !objects.is_empty() {
                let heading = format!("{path}: {key}");
                kind = linked(&kind, &heading);
                self.done.push((objects.clone(), heading.clone(), None));
                below.push((heading, objects));
            }
            let line = format!("- `{key}`: {kind}. {}", self.about(values[0])).trim_end_matches(" .").to_owned();
            rows.push((key.to_owned(), line.trim_end_matches('.').to_owned() + &within + "."));
        }
        self.text += &once(rows, path, &mut self.lines);
        self.text.push('\n');
        for (heading, objects) in below {
            write!(self.text, "### {heading}\n\n").unwrap();
            self.section(&objects, &heading);
        }
    }

    /// Lists the keys of these objects, and of the objects within them.
    fn names(&self, objects: &[&'s Value]) -> String {
        let mut keys: BTreeMap<&str, Vec<&'s Value>> = BTreeMap::new();
        for (key, value) in objects.iter().flat_map(|object| object["properties"].as_object().unwrap()) {
            keys.entry(key).or_default().push(value);
        }
        let name = |(key, values): (&&str, &Vec<&'s Value>)| {
            let null = if self.kind(values).ends_with('?') { "?" } else { "" };
            let within: Vec<&'s Value> = values.iter().copied().flat_map(|value| self.objects(value)).collect();
            let known = within.is_empty() || self.done.iter().any(|(known, ..)| *known == within);
            if known { format!("`{key}{null}`") } else { format!("`{key}{null}` ({})", self.names(&within)) }
        };
        keys.iter().map(name).collect::<Vec<_>>().join(", ")
    }

    /// Returns the first sentence of a description, with JSON words.
    fn about(&self, value: &'s Value) -> String {
        let text = value["description"].as_str().or_else(|| self.resolved(value)["description"].as_str());
        let text = text.unwrap_or_default().split("\n\n").next().unwrap();
        let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
        let words = without_links(&words).replace("None", "null");
        let first = words.split_once(". ").map_or(&words[..], |(first, _)| first);
        // The type says that the value may be null.
        let first = first.split_once("; null").map_or(first, |(first, _)| first);
        format!("{}.", first.trim_end_matches('.'))
    }

    /// Returns the types that one of these values may have.
    fn kind(&self, values: &[&'s Value]) -> String {
        let mut kinds: Vec<String> = Vec::new();
        for form in values.iter().copied().flat_map(|value| self.forms(value)) {
            for kind in self.kinds(form) {
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                }
            }
        }
        let (words, others): (Vec<String>, Vec<String>) = kinds.into_iter().partition(|kind| kind.starts_with('"'));
        let (nulls, mut types): (Vec<String>, Vec<String>) = others.into_iter().partition(|kind| kind == "null");
        if !words.is_empty() {
            types.push(format!("`{}`", words.join("|")));
        }
        types.join(" or ") + if nulls.is_empty() { "" } else { "?" }
    }

    fn kinds(&self, form: &'s Value) -> Vec<String> {
        if let Some(word) = form.get("const") {
            return vec![word.to_string()];
        }
        if let Some(words) = form["enum"].as_array() {
            return words.iter().map(Value::to_string).collect();
        }
        if form.get("properties").is_some() {
            return vec!["object".to_owned()];
        }
        let types = match &form["type"] {
            Value::String(one) => vec![one.as_str()],
            Value::Array(several) => several.iter().map(|one| one.as_str().unwrap()).collect(),
            _ => vec!["any"],
        };
        let named = |kind: &str| match kind {
            "array" => {
                let of = form.get("items").or_else(|| form["prefixItems"].get(0)).unwrap();
                let of = self.kind(&[of]);
                if of.ends_with('?') { format!("list of ({of})") } else { format!("list of {of}") }
            }
            "object" => format!("names, each with {}", self.kind(&[&form["additionalProperties"]])),
            "boolean" => "`true|false`".to_owned(),
            "string" => "text".to_owned(),
            other => other.to_owned(),
        };
        types.into_iter().map(named).collect()
    }
}

/// Returns a kind whose word for objects leads to the table of their keys.
fn linked(kind: &str, heading: &str) -> String {
    let target = anchor(heading);
    match kind.contains("list of object") {
        true => kind.replacen("list of object", &format!("[objects](#{target})"), 1),
        false => kind.replacen("object", &format!("[object](#{target})"), 1),
    }
}

/// Replaces links of rustdoc, which have no target here, by their text.
fn without_links(text: &str) -> String {
    let mut left = text;
    let mut plain = String::new();
    while let Some((before, after)) = left.split_once("[`") {
        let Some((name, rest)) = after.split_once("`]") else { break };
        write!(plain, "{before}`{name}`").unwrap();
        left = match rest.strip_prefix('(').and_then(|target| target.split_once(')')) {
            Some((_, rest)) => rest,
            None => rest,
        };
    }
    plain + left
}
