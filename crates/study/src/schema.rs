//! JSON Schema of study files, from the types that read them.
//!
//! A new key of a study needs nothing here: the `derive` and the doc comment of its type make its schema. Some schemas are written by hand:
//! forms that serde does not derive, such as a number or a pair of numbers, and the words of a registry.

use std::borrow::Cow;

use schemars::generate::SchemaSettings;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

use crate::entries::adjust_entry::{AdjustEntry, Adjustments};
use crate::entries::correlation_entry::{CorrelationEntry, Correlations, JointEntry, Joints};
use crate::entries::cost_entry::{RequireEntry, RequireTable};
use crate::entries::file::{
    ConstantEntry, Entries, FactorEntry, FormulaEntry, PairsEntry, StudyFile, TermEntry, UnknownEntry,
};
use crate::entries::guard::{GuardEntry, GuardTable};
use crate::entries::values::{Deviation, NominalEntry, ToleranceEntry};
use crate::entries::vocabulary::REQUIREMENTS;
use sensitol::method::Pairs;

/// The schema of study files, draft 2020-12, in TOML and JSON alike.
///
/// A study that it accepts is well formed. Only [`Study`](crate::Study) checks that formulas, names and numbers fit each other.
pub fn schema() -> Value {
    let schema = SchemaSettings::draft2020_12().into_generator().into_root_schema_for::<StudyFile>();
    let mut schema = schema.to_value();
    tidy(&mut schema);
    schema["$id"] = SCHEMA_ID.into();
    schema
}

/// Name of the schema of study files. It is not an address: editors read the schema from a file, and nothing is fetched. The number rises
/// when a study that was valid becomes invalid.
pub const SCHEMA_ID: &str = "urn:sensitol:study:1";

/// File of the schema that new studies name, from their own folder.
pub const SCHEMA_FILE: &str = "study.schema.json";

/// Removes the parts that schemars adds for Rust types: null for optional keys, and the formats of numbers.
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
            // An omitted key has a default other than null.
            if object.get("default") == Some(&Value::Null) {
                object.remove("default");
            }
            object.values_mut().for_each(tidy);
        }
        Value::Array(items) => items.iter_mut().for_each(tidy),
        _ => {}
    }
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
                { "description": "Half the band in percent of the nominal.", "type": "string", "pattern": PERCENT },
                {
                    "description": "Lower and upper deviation: [-0.1, 0.3].",
                    "type": "array",
                    "items": generator.subschema_for::<Deviation>(),
                    "minItems": 2,
                    "maxItems": 2,
                },
            ],
        })
    }
}

/// Pattern of a number with a percent sign.
const PERCENT: &str = r"^\s*[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?\s*%\s*$";

impl JsonSchema for Deviation {
    fn schema_name() -> Cow<'static, str> {
        "Deviation".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number" }, { "type": "string", "pattern": PERCENT }] })
    }
}

impl JsonSchema for NominalEntry {
    fn schema_name() -> Cow<'static, str> {
        "Nominal".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "type": "number" },
                { "description": "The place of a position.", "allOf": [generator.subschema_for::<[f64; 2]>()] },
            ],
        })
    }
}

impl JsonSchema for UnknownEntry {
    fn schema_name() -> Cow<'static, str> {
        "Unknown".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let number = |what: &str| json!({ "description": what, "type": "number" });
        json_schema!({
            "anyOf": [
                { "description": "Start value of the search.", "type": "number" },
                {
                    "type": "object",
                    "properties": {
                        "start": number("Start value of the search."),
                        "lower": number("It does not lie below."),
                        "upper": number("It does not lie above."),
                        "unit": { "description": "The unit of these numbers.", "type": "string" },
                    },
                    "required": ["start"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

impl JsonSchema for ConstantEntry {
    fn schema_name() -> Cow<'static, str> {
        "Constant".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "type": "number" },
                {
                    "type": "object",
                    "properties": {
                        "value": { "description": "The number.", "type": "number" },
                        "unit": { "description": "Its unit.", "type": "string" },
                    },
                    "required": ["value"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

impl JsonSchema for FormulaEntry {
    fn schema_name() -> Cow<'static, str> {
        "Formula".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [
                { "type": "string" },
                {
                    "type": "object",
                    "properties": {
                        "formula": { "description": "The formula.", "type": "string" },
                        "unit": { "description": "The unit of its value.", "type": "string" },
                    },
                    "required": ["formula"],
                    "additionalProperties": false,
                },
            ],
        })
    }
}

impl JsonSchema for TermEntry {
    fn schema_name() -> Cow<'static, str> {
        "Term".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "description": "A formula.", "type": "string" }, { "type": "number" }] })
    }
}

impl JsonSchema for Correlations {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Correlations".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": generator.subschema_for::<CorrelationEntry>() })
    }
}

impl JsonSchema for Adjustments {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Adjustments".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": generator.subschema_for::<AdjustEntry>() })
    }
}

impl JsonSchema for Joints {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Joints".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({ "type": "array", "items": generator.subschema_for::<JointEntry>() })
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

impl JsonSchema for FactorEntry {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> Cow<'static, str> {
        "Factor".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "anyOf": [{ "type": "number", "exclusiveMinimum": 0 }, { "type": "string", "enum": ["modified"] }] })
    }
}

impl JsonSchema for RequireEntry {
    fn schema_name() -> Cow<'static, str> {
        "Require".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [{ "type": "string", "enum": REQUIREMENTS }, generator.subschema_for::<RequireTable>()],
        })
    }
}

impl JsonSchema for GuardEntry {
    fn schema_name() -> Cow<'static, str> {
        "Guard".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "anyOf": [{ "type": "number", "minimum": 0 }, generator.subschema_for::<GuardTable>()],
        })
    }
}
