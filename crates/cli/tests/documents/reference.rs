//! Pages of `docs/reference` that are generated from the program: study files from their schema, commands from the parser.

use std::collections::BTreeMap;
use std::fmt::Write;

use clap::{Arg, Command};
use sensitol_study::Study;
use sensitol_testing::{example_studies, repository};
use serde_json::Value;

/// Joins the lines of a text.
fn line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}

fn code(text: &str) -> String {
    format!("`{text}`")
}

/// Study shown on top of the page.
const SHOWN: &str = "examples/shaft-and-bore/study.toml";

/// `docs/reference/study-file.md`.
pub fn study_file() -> String {
    let schema = sensitol_study::schema::schema();
    let mut page = Keys { defs: &schema["$defs"], text: String::new(), done: Vec::new(), lines: BTreeMap::new() };
    Study::read(&repository(SHOWN)).unwrap();
    let shown = std::fs::read_to_string(repository(SHOWN)).unwrap();
    page.text = format!(
        "# Study files\n\n\
         TOML, or JSON with the same keys. The page is made from the schema that `sensitol schema` prints. Editors that know the schema\n\
         [complete keys and show these descriptions](../how-to/editors.md). A key that is not on this page is an error, which names the nearest key.\n\n\
         A line has the key, its type, its default in parentheses, and its meaning.\n\n\
         [{SHOWN}](../../{SHOWN}):\n\n```toml\n{shown}```\n\n\
         ## The file\n\n"
    );
    page.overview(&schema);
    for (name, section) in schema["properties"].as_object().unwrap() {
        if section["type"] == "string" {
            continue;
        }
        write!(page.text, "## {name}\n\n{}\n\n", section["description"].as_str().unwrap()).unwrap();
        if let Some(of) = section.get("additionalProperties") {
            let kind = page.kind(of);
            let form = match kind.as_str() {
                "table" => "`NAME = { .. }`".to_owned(),
                "list of table" => "`NAME = [ { .. }, .. ]`".to_owned(),
                _ => format!("`NAME = value`; a value is {kind}"),
            };
            write!(page.text, "{form}. ").unwrap();
        } else if section["type"] == "array" {
            write!(page.text, "`[[{name}]]`. ").unwrap();
        }
        page.text += &in_use(name);
        page.section(section, name);
    }
    page.text.trim_end().to_owned() + "\n"
}

/// Section that is not written by hand: plain studies keep the contacts of joints by it.
const WRITTEN_BY_EXPAND: &str = "contacts";

/// Examples that are named with a section.
const MOST_EXAMPLES: usize = 2;

/// Lists the first examples that have this section.
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
    let links: Vec<String> = found.iter().take(MOST_EXAMPLES).map(link).collect();
    format!("In use: {}.\n\n", links.join(", "))
}

/// Tables of keys, in the order in which they are found.
struct Keys<'s> {
    defs: &'s Value,
    text: String,
    /// Values that have been shown, with their headings.
    done: Vec<(&'s Value, String)>,
    /// Lines of keys that have been shown, with their headings.
    lines: BTreeMap<String, String>,
}

/// Returns the default of a key, or that it must be there.
fn default(object: &Value, key: &str, value: &Value) -> Option<String> {
    let required = object["required"].as_array().is_some_and(|keys| keys.iter().any(|one| one == key));
    match value.get("default") {
        Some(default) => Some(code(&default.to_string())),
        None => required.then(|| "required".to_owned()),
    }
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

    /// Writes the keys of the file: values with their meaning, tables as links to their sections.
    fn overview(&mut self, schema: &'s Value) {
        let mut tables = Vec::new();
        for (key, value) in schema["properties"].as_object().unwrap() {
            if value["type"] == "string" {
                let row = self.row(key, value, default(schema, key, value), None);
                self.text += &row;
            } else {
                tables.push(format!("[`{key}`](#{key})"));
            }
        }
        let required: Vec<String> =
            schema["required"].as_array().unwrap().iter().map(|key| code(key.as_str().unwrap())).collect();
        writeln!(self.text, "- Tables: {}. Required: {}.\n", tables.join(", "), required.join(", ")).unwrap();
    }

    /// Writes the keys below a value, then the tables below these.
    fn section(&mut self, value: &'s Value, path: &str) {
        let objects = self.objects(value);
        if objects.is_empty() {
            return;
        }
        let mut below: Vec<(String, &Value)> = Vec::new();
        for object in &objects {
            for (key, value) in object["properties"].as_object().unwrap() {
                if !self.objects(value).is_empty() && self.place(value).is_none() {
                    let place = format!("{path}: {key}");
                    self.done.push((value, place.clone()));
                    below.push((place, value));
                }
            }
        }
        let kinds: Vec<&Value> =
            objects.iter().copied().filter(|object| object["properties"]["kind"]["const"].is_string()).collect();
        if kinds.is_empty() {
            objects.iter().for_each(|object| self.keys(object, path));
        } else {
            self.kinds(&kinds, path);
        }
        for (path, value) in below {
            write!(self.text, "### {path}\n\n").unwrap();
            self.section(value, &path);
        }
    }

    /// Returns the heading under which a value's keys are already shown, if its tables equal those of an earlier value.
    fn place(&self, value: &Value) -> Option<&str> {
        // Keys may have different descriptions and defaults with the same content.
        let bare = |value: &Value| {
            let mut value = value.clone();
            let keys = value.as_object_mut().unwrap();
            keys.remove("description");
            keys.remove("default");
            value
        };
        self.done.iter().find(|(one, _)| bare(one) == bare(value)).map(|(_, path)| path.as_str())
    }

    /// Returns the line of a key: name, type, default, meaning. A link leads to the table that the value is.
    fn row(&self, key: &str, value: &'s Value, default: Option<String>, table: Option<&str>) -> String {
        let key = match table {
            Some(heading) => format!("[`{key}`](#{})", anchor(heading)),
            None => code(key),
        };
        let default = default.map_or(String::new(), |default| format!(" ({default})"));
        format!("- {key}: {}{default}. {}\n", self.kind(value), line(&self.about(value)))
    }

    /// Writes the keys of a table.
    fn keys(&mut self, object: &'s Value, path: &str) {
        if let Some(one_of) = object["oneOf"].as_array() {
            let keys: Vec<String> = one_of.iter().map(|form| code(form["required"][0].as_str().unwrap())).collect();
            write!(self.text, "Exactly one of {} must be there.\n\n", keys.join(", ")).unwrap();
        }
        let mut rows = Vec::new();
        for (key, value) in object["properties"].as_object().unwrap() {
            let table = if self.objects(value).is_empty() { None } else { self.place(value) };
            rows.push((key.clone(), self.row(key, value, default(object, key, value), table)));
        }
        self.text += &once(rows, path, &mut self.lines);
        self.text.push('\n');
    }

    /// Writes tables that differ by their kind: the keys of each kind, then the meaning of the keys.
    fn kinds(&mut self, kinds: &[&'s Value], path: &str) {
        let mut all: BTreeMap<&str, &Value> = BTreeMap::new();
        let mut without = Vec::new();
        self.text += "Keys beside `kind`:\n\n";
        for kind in kinds {
            let others = kind["properties"].as_object().unwrap().iter().filter(|(key, _)| *key != "kind");
            let keys: Vec<String> = others.clone().map(|(key, _)| code(key)).collect();
            all.extend(others.map(|(key, value)| (key.as_str(), value)));
            let name = code(kind["properties"]["kind"]["const"].as_str().unwrap());
            if keys.is_empty() {
                without.push(name);
            } else {
                writeln!(self.text, "- {name}: {}", keys.join(", ")).unwrap();
            }
        }
        write!(self.text, "- none: {}\n\n", without.join(", ")).unwrap();
        let mut rows = Vec::new();
        for (key, value) in all {
            let default = value.get("default").map(|default| code(&default.to_string()));
            let table = if self.objects(value).is_empty() { None } else { self.place(value) };
            rows.push((key.to_owned(), self.row(key, value, default, table)));
        }
        self.text += &once(rows, path, &mut self.lines);
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
            return kinds.join(" or ");
        }
        if let Some(words) = value["enum"].as_array() {
            if words.len() > MOST_WORDS {
                let known = words.iter().any(|word| word == "truncated-normal");
                return if known {
                    "kind of [distribution](#dimensions-distribution)".to_owned()
                } else {
                    listed(words)
                };
            }
            return listed(words);
        }
        match value["type"].as_str() {
            Some("number") if value["minimum"] == 0 => "number ≥ 0".to_owned(),
            Some("number") => "number".to_owned(),
            Some("integer") => "integer".to_owned(),
            Some("boolean") => "`true|false`".to_owned(),
            Some("string") if value.get("pattern").is_some() => "percent".to_owned(),
            Some("string") => "text".to_owned(),
            Some("array") => {
                let of = value.get("items").or_else(|| value["prefixItems"].get(0)).unwrap();
                let kind = self.kind(of);
                match (value["minItems"].as_u64(), value["maxItems"].as_u64()) {
                    (Some(least), Some(most)) if least == most => format!("list of {least} ({kind})"),
                    _ => format!("list of {kind}"),
                }
            }
            Some("object") if value.get("properties").is_some() => "table".to_owned(),
            Some("object") => format!("names, each with {}", self.kind(&value["additionalProperties"])),
            _ => panic!("what is this: {value}"),
        }
    }
}

/// Enumerations of more words are shown where their words are explained.
const MOST_WORDS: usize = 12;

/// Returns the words of an enumeration as one piece of code.
fn listed(words: &[Value]) -> String {
    code(&words.iter().map(|word| word.to_string()).collect::<Vec<_>>().join("|"))
}

/// Words that a reference to an earlier section has beside the names of section and keys, and those that it must save.
const REFERENCE_WORDS: usize = 6;

/// Returns lines of keys. Those of which an earlier section has equal ones are named with that section, if that is shorter.
pub fn once(rows: Vec<(String, String)>, path: &str, known: &mut BTreeMap<String, String>) -> String {
    let mut places: BTreeMap<String, (Vec<String>, usize)> = BTreeMap::new();
    for (key, line) in &rows {
        if let Some(place) = known.get(line).filter(|place| *place != path) {
            let (keys, words) = places.entry(place.clone()).or_default();
            keys.push(code(key));
            *words += line.split_whitespace().count();
        }
    }
    places.retain(|place, (keys, words)| *words > REFERENCE_WORDS + place.split_whitespace().count() + keys.len());
    let mut text = String::new();
    for (_, line) in rows {
        if !known.get(&line).is_some_and(|place| places.contains_key(place)) {
            writeln!(text, "{}", line.trim_end()).unwrap();
        }
        known.entry(line).or_insert_with(|| path.to_owned());
    }
    for (place, (keys, _)) in places {
        writeln!(text, "- As in [{place}](#{}): {}.", anchor(&place), keys.join(", ")).unwrap();
    }
    text
}

/// Returns the anchor of a heading in the form of code hosts and mdBook.
pub fn anchor(heading: &str) -> String {
    let kept = heading.to_lowercase().replace(' ', "-");
    kept.chars().filter(|letter| letter.is_alphanumeric() || "-_".contains(*letter)).collect()
}

/// `docs/reference/commands.md`: options of several commands once, then each command with its own.
pub fn commands() -> String {
    let command = sensitol_cli::command();
    let mut page = String::from(
        "# Commands\n\n\
         This page is made from the options that the program reads. `sensitol help COMMAND` prints the same. Results go to stdout or to the file\n\
         of `-o`. Progress, warnings and errors go to stderr. Defaults are in parentheses.\n\n\
         | exit code | meaning |\n|--:|---|\n",
    );
    for (code, meaning) in sensitol_cli::exit_codes() {
        writeln!(page, "| {code} | {meaning} |").unwrap();
    }
    page += "\nWith `--json` the report is printed with 1, 3 and 4 too.\n\n## Every command\n\n";
    let mut values = BTreeMap::new();
    for one in command.get_arguments().filter(|one| !one.is_positional()) {
        page += &option(one, &mut values);
    }
    let subcommands = all(&command);
    let of_commands: Vec<Vec<String>> =
        subcommands.iter().map(|one| own(one).map(|one| option(one, &mut values)).collect()).collect();
    let names: Vec<&str> =
        subcommands.iter().map(|one| one.get_bin_name().unwrap().trim_start_matches("sensitol ")).collect();
    let groups = shared(&of_commands);
    let heading = |group: usize| {
        let of: Vec<&str> = groups[group].0.iter().map(|&command| names[command]).collect();
        format!("{}: {}", group + 1, of.join(", "))
    };
    page += "\n## Options of several commands\n\nIn every command `STUDY` is the study, a .toml or .json file.\n";
    for (group, (_, lines)) in groups.iter().enumerate() {
        write!(page, "\n### {}\n\n{}", heading(group), lines.concat()).unwrap();
    }
    page.push('\n');
    for (index, (subcommand, options)) in subcommands.iter().zip(&of_commands).enumerate() {
        let path = subcommand.get_bin_name().unwrap();
        let about = subcommand.get_long_about().or(subcommand.get_about()).unwrap().to_string();
        write!(page, "## {path}\n\n{}\n\n", paragraphs(&about)).unwrap();
        let usage = subcommand.clone().render_usage().to_string();
        let usage = usage.strip_prefix("Usage: ").unwrap();
        write!(page, "```sh\n{usage}\n\n{}\n```\n\n", examples(subcommand).join("\n")).unwrap();
        for one in subcommand.get_arguments().filter(|one| one.is_positional()) {
            let about = line(&help(one).0);
            if !about.starts_with("The study, a .toml") {
                writeln!(page, "- `{}`: {about}", one.get_value_names().unwrap()[0]).unwrap();
            }
        }
        let known = |line: &String| groups.iter().any(|(_, lines)| lines.contains(line));
        options.iter().filter(|line| !known(line)).for_each(|line| page += line);
        let several: Vec<String> = (0..groups.len())
            .filter(|&group| groups[group].0.contains(&index))
            .map(|group| format!("[{}](#{})", group + 1, anchor(&heading(group))))
            .collect();
        if !several.is_empty() {
            writeln!(page, "- Options of several commands: {}", several.join(", ")).unwrap();
        }
        if !page.ends_with("\n\n") {
            page.push('\n');
        }
    }
    page += "## Words\n\nThe meaning of the words that stand for an option.\n";
    for (option, words) in values {
        write!(page, "\n### {option}\n\n").unwrap();
        if option == "--method" {
            page += "[The methods, and their cost](../methods.md).\n";
            continue;
        }
        words.iter().for_each(|(word, help)| writeln!(page, "- `{word}`: {}", line(help)).unwrap());
    }
    page
}

/// Returns the options that a command has beside those of all commands.
fn own(command: &Command) -> impl Iterator<Item = &Arg> {
    command.get_arguments().filter(|one| !one.is_positional() && !one.is_global_set() && one.get_id() != "help")
}

/// Commands by their index, and the lines of the options that they have in common.
type Group = (Vec<usize>, Vec<String>);

/// Groups the lines that several commands have by the commands that have them.
fn shared(of_commands: &[Vec<String>]) -> Vec<Group> {
    let mut groups: Vec<Group> = Vec::new();
    let mut seen: Vec<&String> = Vec::new();
    for line in of_commands.iter().flatten() {
        let with: Vec<usize> = (0..of_commands.len()).filter(|&command| of_commands[command].contains(line)).collect();
        if with.len() < 2 || seen.contains(&line) {
            continue;
        }
        seen.push(line);
        match groups.iter_mut().find(|(commands, _)| *commands == with) {
            Some((_, lines)) => lines.push(line.clone()),
            None => groups.push((with, vec![line.clone()])),
        }
    }
    groups
}

/// Joins the lines of each paragraph.
fn paragraphs(text: &str) -> String {
    text.split("\n\n").map(line).collect::<Vec<_>>().join("\n\n")
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
    // A long help begins with the short one, and says it again with more.
    let short = one.get_help().map(|help| help.to_string()).unwrap_or_default();
    let text = text.strip_prefix(&format!("{short}\n\n")).unwrap_or(&text).to_owned();
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

/// Returns the line of an option. Words with a meaning of their own are explained at the end of the page.
fn option(one: &Arg, values: &mut BTreeMap<String, Vec<(String, String)>>) -> String {
    let mut names: Vec<String> = one.get_short().map(|short| format!("-{short}")).into_iter().collect();
    names.extend(one.get_long().map(|long| format!("--{long}")));
    let value = match one.get_value_names() {
        Some([name]) if one.get_action().takes_values() => format!(" {name}"),
        _ => String::new(),
    };
    let (about, default) = help(one);
    let mut about = line(&about);
    let words: Vec<(String, String)> = one
        .get_possible_values()
        .iter()
        .filter(|_| one.get_action().takes_values())
        .map(|word| (word.get_name().to_owned(), word.get_help().map(|help| help.to_string()).unwrap_or_default()))
        .collect();
    if words.iter().any(|(_, help)| !help.is_empty()) {
        let long = one.get_long().unwrap();
        write!(about, ". [Words](#--{long})").unwrap();
        values.insert(format!("--{long}"), words);
    } else if !words.is_empty() {
        let listed: Vec<&str> = words.iter().map(|(word, _)| word.as_str()).collect();
        write!(about, ": {}", code(&listed.join("|"))).unwrap();
    }
    let default = if default.is_empty() { default } else { format!(" ({})", line(&default)) };
    format!("- {}{default}: {about}\n", code(&(names.join(", ") + &value)))
}
