//! `sensitol schema`.

use schemars::generate::{Contract, SchemaSettings};
use schemars::{JsonSchema, SchemaGenerator};
use serde_json::{Map, Value, json as value};

use crate::args::{OutputArgs, SchemaArgs};
use crate::commands::{check, examples, journal, models, pearson, plan, point_report, probe, several};
use crate::failure::{Exit, Failure};
use crate::failure_report::ErrorDocument;
use crate::files::Files;
use crate::output::json;
use sensitol_report::{
    AllocationReport, CompareReport, DifferenceReport, LotReport, RareReport, Report, SCHEMA, SimulationReport,
    SweepReport,
};
use sensitol_study::schema;

pub(crate) fn run(asked: &SchemaArgs) -> Result<Exit, Failure> {
    let output = OutputArgs { json: true, output: asked.output.clone(), force: asked.force };
    let destination = Files::default().forced(asked.force).output_text(&output)?;
    destination.write(&json(&if asked.report { reports() } else { schema() }))?;
    Ok(Exit::Done)
}

/// Returns the schema of all `--json` output, draft 2020-12, with one entry in `$defs` for each command.
///
/// The schema lists every key and allows no others.
fn reports() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|settings| settings.contract = Contract::Serialize);
    let mut generator = settings.into_generator();
    let commands: [(&str, Value); 17] = [
        ("analyze", of::<Report>(&mut generator)),
        ("analyze-compare", of::<DifferenceReport>(&mut generator)),
        ("simulate", of::<SimulationReport>(&mut generator)),
        ("simulate-rare", of::<RareReport>(&mut generator)),
        ("compare", of::<CompareReport>(&mut generator)),
        ("compare-lot", of::<LotReport>(&mut generator)),
        ("sweep", of::<SweepReport>(&mut generator)),
        ("allocate", of::<AllocationReport>(&mut generator)),
        ("plan", of::<plan::PlanReport>(&mut generator)),
        ("evaluate", of::<point_report::EvaluationReport>(&mut generator)),
        ("probe", of::<probe::ProbeReport>(&mut generator)),
        ("models", of::<Vec<models::ModelReport>>(&mut generator)),
        ("pearson", of::<pearson::Answers>(&mut generator)),
        ("journal-show", of::<Vec<journal::ModelReport>>(&mut generator)),
        ("check", of::<check::StudyCheck>(&mut generator)),
        ("examples", of::<Vec<examples::ExampleReport>>(&mut generator)),
        ("errors", of::<ErrorDocument>(&mut generator)),
    ];
    let mut definitions: Map<String, Value> = generator.take_definitions(true);
    let all: Vec<Value> = commands.iter().map(|(name, _)| value!({ "$ref": format!("#/$defs/{name}") })).collect();
    definitions.extend(commands.map(|(name, schema)| (name.to_owned(), schema)));
    let mut schema = value!({
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        // The identifier is a name and not an address: other versions have other schemas, and none is fetched.
        "$id": format!("urn:sensitol:report:{SCHEMA}"),
        "title": format!("Reports of sensitol, schema {SCHEMA}"),
        "anyOf": all,
        "$defs": definitions,
    });
    close(&mut schema);
    describe_json(&mut schema);
    // Added after `close`: a report within an entry stays open, because the entry adds the name of its study.
    schema["anyOf"].as_array_mut().expect("a list").push(value!({ "$ref": "#/$defs/analyze-several" }));
    schema["$defs"]["analyze-several"] = several_reports();
    schema
}

/// Schema of an array of entries: each is a report or an error, with the name of its study.
fn several_reports() -> Value {
    let settings = SchemaSettings::draft2020_12().with(|settings| {
        settings.contract = Contract::Serialize;
        settings.inline_subschemas = true;
    });
    let mut schema = of::<Vec<several::Entry>>(&mut settings.into_generator());
    close(&mut schema);
    describe_json(&mut schema);
    for outcome in schema["items"]["anyOf"].as_array_mut().into_iter().flatten() {
        outcome.as_object_mut().map(|object| object.remove("unevaluatedProperties"));
    }
    schema
}

fn of<T: JsonSchema>(generator: &mut SchemaGenerator) -> Value {
    generator.subschema_for::<T>().to_value()
}

/// Forbids unlisted keys in all objects.
fn close(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            object.values_mut().for_each(close);
            if object.contains_key("properties") && !object.contains_key("additionalProperties") {
                object.insert("unevaluatedProperties".to_owned(), false.into());
            }
        }
        Value::Array(items) => items.iter_mut().for_each(close),
        _ => {}
    }
}

/// Says `null` for `None` in all descriptions, and removes the links of rustdoc: the descriptions are those of the Rust types.
fn describe_json(schema: &mut Value) {
    match schema {
        Value::Object(object) => {
            object.values_mut().for_each(describe_json);
            if let Some(Value::String(text)) = object.get_mut("description") {
                *text = without_links(text).split(' ').map(json_word).collect::<Vec<_>>().join(" ");
            }
        }
        Value::Array(items) => items.iter_mut().for_each(describe_json),
        _ => {}
    }
}

/// Word of a description of Rust as one of JSON.
fn json_word(word: &str) -> String {
    match word.strip_prefix("None") {
        Some(rest) if !rest.starts_with(char::is_alphanumeric) => format!("null{rest}"),
        _ => word.to_owned(),
    }
}

/// Text with the links of rustdoc as plain words: ``[`Name`]`` and ``[`Name`](path)`` become `Name`.
fn without_links(text: &str) -> String {
    let mut parts = text.split("[`");
    let mut plain = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let Some((name, rest)) = part.split_once("`]") else {
            plain += "[`";
            plain += part;
            continue;
        };
        let target = rest.strip_prefix('(').and_then(|rest| rest.split_once(')'));
        plain += &format!("`{name}`{}", target.map_or(rest, |(_, rest)| rest));
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::{json_word, reports, without_links};
    use serde_json::Value;

    /// All descriptions of a schema.
    fn descriptions<'v>(schema: &'v Value, found: &mut Vec<&'v str>) {
        match schema {
            Value::Object(object) => {
                found.extend(object.get("description").and_then(Value::as_str));
                object.values().for_each(|value| descriptions(value, found));
            }
            Value::Array(items) => items.iter().for_each(|value| descriptions(value, found)),
            _ => {}
        }
    }

    #[test]
    fn words_of_rust_become_words_of_json() {
        assert_eq!(["None", "None,", "NoneType", "none"].map(json_word), ["null", "null,", "NoneType", "none"]);
        assert_eq!(without_links("a [`B`](c::B) d [`E::f`], and [`g"), "a `B` d `E::f`, and [`g");
    }

    #[test]
    fn descriptions_of_reports_name_no_rust() {
        let schema = reports();
        let mut all = Vec::new();
        descriptions(&schema, &mut all);
        assert!(all.len() > 500, "{}", all.len());
        let wrong =
            |text: &&&str| text.contains("[`") || text.split(|c: char| !c.is_alphanumeric()).any(|word| word == "None");
        let wrong: Vec<&&str> = all.iter().filter(wrong).collect();
        assert!(wrong.is_empty(), "{wrong:#?}");
    }
}
