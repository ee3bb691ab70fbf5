//! Pages of `docs/reference` that are generated from the program: study files from their schema, commands from the parser.

use std::collections::BTreeMap;
use std::fmt::Write;

use clap::{Arg, Command};
use sensitol_study::Study;
use sensitol_testing::{example_studies, repository};
use serde_json::Value;

/// Removes line ends and bars, which a cell of a table cannot have.
fn cell(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ").replace('|', "\\|")
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

/// Study shown on top of the page.
const SHOWN: &str = "examples/stacked-blocks/study.toml";

/// `docs/reference/study-file.md`.
pub fn study_file() -> String {
    let schema = sensitol_study::schema::schema();
    let mut page = Keys { defs: &schema["$defs"], text: String::new(), done: Vec::new() };
    Study::read(&repository(SHOWN)).unwrap();
    let shown = std::fs::read_to_string(repository(SHOWN)).unwrap();
    page.text = format!(
        "# Study files\n\n\
         TOML, or JSON with the same keys. This page is made from the schema that `sensitol schema` prints; editors that know it complete\n\
         keys and show these descriptions. A key that stands nowhere on this page is an error that names the nearest one that does.\n\n\
         [{SHOWN}](../../{SHOWN}):\n\n```toml\n{shown}```\n\n\
         ## The file\n\n"
    );
    page.keys(&schema, "");
    for (name, section) in schema["properties"].as_object().unwrap() {
        if section["type"] == "string" {
            continue;
        }
        write!(page.text, "## {name}\n\n{}\n\n", section["description"].as_str().unwrap()).unwrap();
        if let Some(of) = section.get("additionalProperties") {
            let kind = page.kind(of);
            let form = match kind.as_str() {
                "table" => "`NAME = { .. }`, any name".to_owned(),
                "[any number of: table]" => "`NAME = [ { .. }, .. ]`, any name".to_owned(),
                _ => format!("`NAME = value`, any name; a value is: {kind}"),
            };
            write!(page.text, "{form}.\n\n").unwrap();
        } else if section["type"] == "array" {
            write!(page.text, "`[[{name}]]`, as often as there are any.\n\n").unwrap();
        }
        page.text += &in_use(name);
        page.section(section, name);
    }
    page.text.trim_end().to_owned() + "\n"
}

/// Section that is not written by hand: plain studies keep the contacts of joints by it.
const WRITTEN_BY_EXPAND: &str = "contacts";

/// Lists at most three examples that have this section.
fn in_use(section: &str) -> String {
    if section == WRITTEN_BY_EXPAND {
        return "Written by `sensitol expand`.\n\n".to_owned();
    }
    let mut studies = example_studies();
    // The main study of an example comes before its variants.
    studies.sort_by_key(|(folder, path)| (folder.clone(), !path.ends_with("study.toml"), path.clone()));
    let has = |path: &std::path::Path| {
        let text = std::fs::read_to_string(path).unwrap();
        toml::from_str::<Value>(&text).is_ok_and(|study| study.get(section).is_some())
    };
    let mut found: Vec<(&str, String)> = Vec::new();
    for (folder, path) in studies.iter().filter(|(_, path)| has(path)) {
        if !found.iter().any(|(known, _)| known == folder) {
            found.push((folder, path.file_name().unwrap().to_string_lossy().into_owned()));
        }
    }
    assert!(!found.is_empty(), "no example has [{section}]");
    let link = |(folder, file): &(&str, String)| format!("[{folder}](../../examples/{folder}/{file})");
    let links: Vec<String> = found.iter().take(3).map(link).collect();
    format!("In use: {}.\n\n", links.join(", "))
}

/// Tables of keys, in the order in which they are found.
struct Keys<'s> {
    defs: &'s Value,
    text: String,
    /// Values that have been shown, with their headings.
    done: Vec<(&'s Value, String)>,
}

impl<'s> Keys<'s> {
    fn resolved(&self, value: &'s Value) -> &'s Value {
        match value["$ref"].as_str() {
            Some(path) => &self.defs[path.strip_prefix("#/$defs/").unwrap()],
            None => value,
        }
    }

    /// Returns the tables with keys that a value may be, or consist of.
    fn objects(&self, value: &'s Value) -> Vec<&'s Value> {
        let value = self.resolved(value);
        if value.get("properties").is_some() {
            return vec![value];
        }
        let parts = ["anyOf", "allOf"].iter().filter_map(|key| value[*key].as_array()).flatten();
        let within =
            ["items", "additionalProperties"].iter().filter_map(|key| value.get(*key)).filter(|of| of.is_object());
        parts.chain(within).flat_map(|part| self.objects(part)).collect()
    }

    /// Writes the keys below a value, then the tables below these.
    fn section(&mut self, value: &'s Value, path: &str) {
        let objects = self.objects(value);
        if objects.is_empty() {
            return;
        }
        let kinds: Vec<&Value> =
            objects.iter().copied().filter(|object| object["properties"]["kind"]["const"].is_string()).collect();
        if kinds.is_empty() {
            objects.iter().for_each(|object| self.keys(object, path));
        } else {
            self.kinds(&kinds);
        }
        let mut below: Vec<(String, &Value)> = Vec::new();
        for object in objects {
            for (key, value) in object["properties"].as_object().unwrap() {
                let new = !self.objects(value).is_empty() && self.place(value).is_none();
                if new && !below.iter().any(|(known, _)| known == key) {
                    below.push((key.clone(), value));
                }
            }
        }
        for (key, value) in below {
            let path = format!("{path}: {key}");
            self.done.push((value, path.clone()));
            let about = self.about(value);
            write!(self.text, "### {path}\n\n{about}\n\n").unwrap();
            self.section(value, &path);
        }
    }

    /// Returns the heading under which a value's keys are already shown, if its tables equal those of an earlier value.
    fn place(&self, value: &Value) -> Option<&str> {
        let same = |one: &Value| {
            // Keys may have different descriptions with the same content.
            let bare = |value: &Value| {
                let mut value = value.clone();
                value.as_object_mut().unwrap().remove("description");
                value
            };
            bare(one) == bare(value)
        };
        self.done.iter().find(|(one, _)| same(one)).map(|(_, path)| path.as_str())
    }

    /// Writes a table of keys.
    fn keys(&mut self, object: &'s Value, path: &str) {
        if let Some(one_of) = object["oneOf"].as_array() {
            let keys: Vec<String> = one_of.iter().map(|form| code(form["required"][0].as_str().unwrap())).collect();
            write!(self.text, "Exactly one of {} must be there.\n\n", keys.join(", ")).unwrap();
        }
        self.text += "| key | value | default | meaning |\n|---|---|---|---|\n";
        for (key, value) in object["properties"].as_object().unwrap() {
            let required = object["required"].as_array().is_some_and(|keys| keys.iter().any(|one| one == key));
            let default = match value.get("default") {
                Some(default) => code(&default.to_string()),
                None if required => "required".to_owned(),
                None => String::new(),
            };
            let (kind, about) = (self.kind(value), self.about(value));
            let key =
                if path.is_empty() && value["type"] != "string" { format!("[`{key}`](#{key})") } else { code(key) };
            writeln!(self.text, "| {key} | {} | {default} | {} |", cell(&kind), cell(&about)).unwrap();
        }
        self.text.push('\n');
    }

    /// Writes tables that differ by their kind: the keys of each kind, then the meaning of the keys.
    fn kinds(&mut self, kinds: &[&'s Value]) {
        self.text += "| kind | keys beside `kind` |\n|---|---|\n";
        let mut all: BTreeMap<&str, &Value> = BTreeMap::new();
        for kind in kinds {
            let others = kind["properties"].as_object().unwrap().iter().filter(|(key, _)| *key != "kind");
            let keys: Vec<String> = others.clone().map(|(key, _)| code(key)).collect();
            all.extend(others.map(|(key, value)| (key.as_str(), value)));
            let name = kind["properties"]["kind"]["const"].as_str().unwrap();
            writeln!(self.text, "| `{name}` | {} |", keys.join(", ")).unwrap();
        }
        self.text += "\n| key | value | default | meaning |\n|---|---|---|---|\n";
        for (key, value) in all {
            let default = value.get("default").map_or(String::new(), |default| code(&default.to_string()));
            let (kind, about) = (self.kind(value), self.about(value));
            writeln!(self.text, "| `{key}` | {} | {default} | {} |", cell(&kind), cell(&about)).unwrap();
        }
        self.text.push('\n');
    }

    /// Returns the description of a value, or that of its type.
    fn about(&self, value: &'s Value) -> String {
        let own = value["description"].as_str().or_else(|| self.resolved(value)["description"].as_str());
        own.unwrap_or_else(|| panic!("no description: {value}")).to_owned()
    }

    /// Returns the values that a key may have.
    fn kind(&self, value: &'s Value) -> String {
        let value = self.resolved(value);
        if let Some(forms) = value["anyOf"].as_array().or_else(|| value["allOf"].as_array()) {
            let mut kinds: Vec<String> = Vec::new();
            for kind in forms.iter().map(|form| self.kind(form)) {
                if !kinds.contains(&kind) {
                    kinds.push(kind);
                }
            }
            return kinds.join(", or ");
        }
        if let Some(words) = value["enum"].as_array() {
            return words.iter().map(|word| code(&word.to_string())).collect::<Vec<_>>().join(", ");
        }
        match value["type"].as_str() {
            Some("number") if value["minimum"] == 0 => "number, 0 or above".to_owned(),
            Some("number") => "number".to_owned(),
            Some("integer") => "whole number".to_owned(),
            Some("boolean") => "`true`, `false`".to_owned(),
            Some("string") if value.get("pattern").is_some() => "percent such as `\"2 %\"`".to_owned(),
            Some("string") => "text".to_owned(),
            Some("array") => {
                let of = value.get("items").or_else(|| value["prefixItems"].get(0)).unwrap();
                let kind = self.kind(of);
                match (value["minItems"].as_u64(), value["maxItems"].as_u64()) {
                    (Some(least), Some(most)) if least == most => format!("[{least} of: {kind}]"),
                    _ => format!("[any number of: {kind}]"),
                }
            }
            Some("object") if value.get("properties").is_some() => "table".to_owned(),
            Some("object") => format!("table of names, each with: {}", self.kind(&value["additionalProperties"])),
            _ => panic!("what is this: {value}"),
        }
    }
}

/// `docs/reference/commands.md`.
pub fn commands() -> String {
    let command = sensitol_cli::command();
    let mut page = String::from(
        "# Commands\n\n\
         This page is made from what the program parses; `sensitol help COMMAND` prints the same. Results go to stdout, or to the file of\n\
         `-o`; progress, warnings and errors to stderr.\n\n\
         | exit code | meaning |\n|--:|---|\n",
    );
    for (code, meaning) in sensitol_cli::exit_codes() {
        writeln!(page, "| {code} | {meaning} |").unwrap();
    }
    page += "\nWith `--json` the report is printed with 1, 3 and 4 too.\n\n";
    let mut values = BTreeMap::new();
    page += "## Every command\n\n";
    options(&mut page, command.get_arguments().filter(|one| !one.is_positional()), &mut values);
    for subcommand in all(&command) {
        let path = subcommand.get_bin_name().unwrap();
        let about = subcommand.get_long_about().or(subcommand.get_about()).unwrap().to_string();
        write!(page, "## {path}\n\n{}\n\n", paragraphs(&about)).unwrap();
        let usage = subcommand.clone().render_usage().to_string();
        let usage = usage.strip_prefix("Usage: ").unwrap();
        write!(page, "```text\n{usage}\n```\n\n").unwrap();
        for (positional, heading) in [(true, "argument"), (false, "")] {
            let own = |one: &&Arg| one.is_positional() == positional && !one.is_global_set() && one.get_id() != "help";
            let arguments: Vec<&Arg> = subcommand.get_arguments().filter(own).collect();
            if positional && !arguments.is_empty() {
                write!(page, "| {heading} | meaning |\n|---|---|\n").unwrap();
                for one in arguments {
                    let name = one.get_value_names().unwrap()[0].as_str();
                    let more = if one.get_num_args().is_some_and(|count| count.max_values() > 1) { " .." } else { "" };
                    let optional = if one.is_required_set() { "" } else { ", or nothing" };
                    writeln!(page, "| `{name}`{more}{optional} | {} |", cell(&help(one).0)).unwrap();
                }
                page.push('\n');
            } else if !positional && !arguments.is_empty() {
                options(&mut page, arguments.into_iter(), &mut values);
            }
        }
        write!(page, "```sh\n{}\n```\n\n", examples(&subcommand).join("\n")).unwrap();
    }
    page += "## Words\n\nThe meaning of the words that stand for an option.\n";
    for (option, words) in values {
        write!(page, "\n### {option}\n\n| word | meaning |\n|---|---|\n").unwrap();
        words.iter().for_each(|(word, help)| writeln!(page, "| `{word}` | {} |", cell(help)).unwrap());
    }
    page
}

/// Joins the lines of each paragraph.
fn paragraphs(text: &str) -> String {
    text.split("\n\n").map(cell).collect::<Vec<_>>().join("\n\n")
}

/// Returns every command that does something, in the order of the help.
pub fn all(command: &Command) -> Vec<Command> {
    let mut found = Vec::new();
    for one in command.get_subcommands().filter(|one| one.get_name() != "help") {
        match one.has_subcommands() {
            true => found.extend(all(one)),
            false => found.push(one.clone()),
        }
    }
    found
}

/// Returns the lines below `Examples:` in a command's help.
pub fn examples(command: &Command) -> Vec<String> {
    let text = command.get_after_help().map(|text| text.to_string()).unwrap_or_default();
    let lines =
        text.strip_prefix("Examples:\n").map(|lines| lines.lines().map(|line| line.trim().to_owned()).collect());
    lines.unwrap_or_default()
}

/// Returns the meaning of an option and its default: `[default: ..]` within the help, or the parser's default.
fn help(one: &Arg) -> (String, String) {
    let text = one.get_long_help().or(one.get_help()).unwrap().to_string();
    let of_parser: Vec<String> = one.get_default_values().iter().map(|value| code(value.to_str().unwrap())).collect();
    match text.split_once(" [default: ") {
        Some((before, rest)) if one.get_action().takes_values() => {
            let (default, after) = rest.split_once(']').unwrap();
            (before.to_owned() + after, default.to_owned())
        }
        _ if one.get_action().takes_values() => (text, of_parser.join(", ")),
        _ => (text, String::new()),
    }
}

/// Writes a table of options. Words with a meaning of their own are explained at the end of the page.
fn options<'a>(
    page: &mut String,
    arguments: impl Iterator<Item = &'a Arg>,
    values: &mut BTreeMap<String, Vec<(String, String)>>,
) {
    *page += "| option | default | meaning |\n|---|---|---|\n";
    for one in arguments {
        let mut names: Vec<String> = one.get_short().map(|short| format!("-{short}")).into_iter().collect();
        names.extend(one.get_long().map(|long| format!("--{long}")));
        let value = match one.get_value_names() {
            Some([name]) if one.get_action().takes_values() => format!(" {name}"),
            _ => String::new(),
        };
        let (mut about, default) = help(one);
        let words: Vec<(String, String)> = one
            .get_possible_values()
            .iter()
            .filter(|_| one.get_action().takes_values())
            .map(|word| (word.get_name().to_owned(), word.get_help().map(|help| help.to_string()).unwrap_or_default()))
            .collect();
        if !words.is_empty() {
            let listed: Vec<String> = words.iter().map(|(word, _)| code(word)).collect();
            let long = one.get_long().unwrap();
            let explained = words.iter().any(|(_, help)| !help.is_empty());
            let lead = if explained { format!("[Words](#--{long})") } else { "Words".to_owned() };
            about += &format!(". {lead}: {}", listed.join(", "));
            if explained {
                values.insert(format!("--{long}"), words);
            }
        }
        let names = names.iter().map(|name| code(name)).collect::<Vec<_>>().join(", ");
        let value = if value.is_empty() { value } else { format!(" {}", code(value.trim())) };
        writeln!(page, "| {names}{value} | {} | {} |", cell(&default), cell(&about)).unwrap();
    }
    page.push('\n');
}
