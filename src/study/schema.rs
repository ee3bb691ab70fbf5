//! The JSON Schema of study files, from the types that read them.
//!
//! A new key of a study needs nothing here: its type's `derive` and its doc comment make its schema. What is written by hand are
//! the forms that serde does not know, such as a number or a pair of numbers, and the words that a registry knows.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use super::dimension::KINDS;
use super::file::{DistributionEntry, Entries, PairsEntry, StudyFile, ToleranceEntry};
use crate::method::{ALL as METHODS, Pairs};
use crate::models;
use crate::plan::Stencil;

/// The schema of study files, draft 2020-12, in TOML and JSON alike.
///
/// What it accepts is well formed; whether formulas, names and numbers fit each other only [`Study`](super::Study) knows.
pub fn schema() -> Value {
    let schema = SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<StudyFile>();
    let mut schema = schema.to_value();
    tidy(&mut schema);
    schema
}

/// A key that may be left out is not a key that may be null; and the width of a number is ours alone.
fn tidy(value: &mut Value) {
    match value {
        Value::Object(object) => {
            if object.get("format").is_some_and(Value::is_string) && object.contains_key("type") {
                object.remove("format");
            }
            if let Some(Value::Array(types)) = object.get_mut("type") {
                types.retain(|kind| kind != "null");
                if let [only] = &types[..] {
                    object["type"] = only.clone();
                }
            }
            let null = json!({ "type": "null" });
            let present = match object.get("anyOf") {
                Some(Value::Array(forms)) if forms.contains(&null) => {
                    Some(forms.iter().filter(|form| **form != null).cloned().collect::<Vec<_>>())
                }
                _ => None,
            };
            if let Some(present) = present {
                object.remove("anyOf");
                match &present[..] {
                    [Value::Object(only)] => object.extend(only.clone()),
                    _ => _ = object.insert("anyOf".to_owned(), present.into()),
                }
            }
            // What is left out stands for something, but not for null.
            if object.get("default") == Some(&Value::Null) {
                object.remove("default");
            }
            object.values_mut().for_each(tidy);
        }
        Value::Array(items) => items.iter_mut().for_each(tidy),
        _ => {}
    }
}

/// The names of all methods.
pub(super) fn methods() -> Vec<&'static str> {
    METHODS.iter().map(|method| method.name()).collect()
}

/// The names of all built-in models.
pub(super) fn built_in_models() -> Vec<&'static str> {
    models::ALL.iter().map(|model| model.name).collect()
}

/// The names of all stencils.
pub(super) fn stencils() -> Vec<&'static str> {
    Stencil::NAMES.to_vec()
}

/// Which sensitivities can be asked for.
pub(super) fn sensitivities() -> Vec<&'static str> {
    super::options::SENSITIVITIES.to_vec()
}

/// Exactly one of these keys must be there.
pub(super) fn one_of<const N: usize>(keys: [&str; N]) -> Value {
    keys.iter().map(|key| json!({ "required": [key] })).collect()
}

impl<T: JsonSchema> JsonSchema for Entries<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        format!("Entries_{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "type": "object",
            "propertyNames": { "minLength": 1 },
            "additionalProperties": generator.subschema_for::<T>(),
        })
    }
}

impl JsonSchema for ToleranceEntry {
    fn schema_name() -> Cow<'static, str> {
        "Tolerance".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "description": "Half the band: 0.3 is nominal ± 0.3.", "type": "number", "minimum": 0 },
                {
                    "description": "Lower and upper deviation: [-0.1, 0.3].",
                    "allOf": [generator.subschema_for::<[f64; 2]>()],
                },
            ],
        })
    }
}

impl JsonSchema for DistributionEntry {
    fn schema_name() -> Cow<'static, str> {
        "Distribution".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let kind = json!({ "description": "The kind of distribution.", "type": "string", "enum": KINDS });
        json_schema!({
            "anyOf": [
                kind,
                { "type": "object", "properties": { "kind": kind }, "required": ["kind"], "additionalProperties": false },
            ],
        })
    }
}

impl JsonSchema for PairsEntry {
    fn schema_name() -> Cow<'static, str> {
        "Pairs".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "type": "string", "enum": Pairs::NAMES },
                generator.subschema_for::<Vec<(String, String)>>(),
            ],
        })
    }
}
