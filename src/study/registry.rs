//! What the schema of a type takes from elsewhere: the names that are registered, and forms that serde does not know.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use super::words::{self, MEASURED_MODELS, SENSITIVITIES};
use crate::allocation::CurveKind;
use crate::assembly::process::Settings;
use crate::method::{ALL as METHODS, DerivativeSource};
use crate::models;
use crate::plan::Stencil;

/// The names of all methods.
pub(super) fn methods() -> Vec<&'static str> {
    METHODS.iter().map(|method| method.name()).collect()
}

/// The names of all built-in models.
pub(super) fn built_in_models() -> Vec<&'static str> {
    models::ALL.iter().map(|model| model.name).collect()
}

/// How units are held.
pub(super) fn unit_modes() -> Vec<&'static str> {
    words::UNIT_MODES.to_vec()
}

/// The names of all stencils.
pub(super) fn stencils() -> Vec<&'static str> {
    Stencil::NAMES.to_vec()
}

/// Which sensitivities can be asked for.
pub(super) fn sensitivities() -> Vec<&'static str> {
    SENSITIVITIES.to_vec()
}

/// The sources of derivatives.
pub(super) fn derivatives() -> Vec<&'static str> {
    DerivativeSource::NAMES.to_vec()
}

/// How external programs are run unless the study says otherwise.
pub(super) fn program() -> Settings {
    Settings::new([""])
}

/// The kinds of distribution.
pub(super) fn kinds() -> Vec<&'static str> {
    words::kinds().map(|(name, _)| name).collect()
}

/// What can be made of measured values.
pub(super) fn measured_models() -> Vec<&'static str> {
    MEASURED_MODELS.to_vec()
}

/// The zones of a joint block.
pub(super) fn zones() -> Vec<&'static str> {
    words::ZONES.to_vec()
}

/// The names of all cost models.
pub(super) fn cost_models() -> Vec<&'static str> {
    CurveKind::NAMED.iter().map(|(name, _)| *name).collect()
}

/// Exactly one of these keys must be there.
pub(super) fn one_of<const N: usize>(keys: [&str; N]) -> Value {
    keys.iter().map(|key| json!({ "required": [key] })).collect()
}

/// A name, or a list of names.
pub(super) fn names(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" }, "minItems": 1 }] })
}

/// Tables of numbers by name, or a file of them.
pub(super) fn configurations(_: &mut SchemaGenerator) -> Schema {
    let place = json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
    let values = json!({ "type": "object", "additionalProperties": { "anyOf": [{ "type": "number" }, place] } });
    json_schema!({
        "type": "object",
        "properties": {
            "file": { "description": "A CSV file with a configuration a row, or a configuration of this name.", "anyOf": [{ "description": "A CSV file with a configuration a row.", "type": "string" }, values] },
        },
        "additionalProperties": values,
    })
}

/// The name of a kind, or a table with the parameters that it knows, of the type that has those of all kinds.
pub(super) fn distribution<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let all = T::json_schema(generator).to_value();
    let table = |(name, knows): (&'static str, &'static [&'static str])| {
        let mut properties: Map<String, Value> =
            knows.iter().map(|&key| (key.to_owned(), all["properties"][key].clone())).collect();
        properties.insert(
            "kind".to_owned(),
            json!({ "description": all["properties"]["kind"]["description"], "const": name }),
        );
        json!({ "type": "object", "properties": properties, "required": ["kind"], "additionalProperties": false })
    };
    let mut forms = vec![json!({ "description": "The kind of distribution.", "type": "string", "enum": kinds() })];
    forms.extend(words::kinds().map(table));
    json_schema!({ "anyOf": forms })
}
