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
    let destination = Files::default().forced(asked.force).output(&output)?;
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
