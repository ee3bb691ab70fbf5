//! Parts of the schema that no `derive` can make: names from registries, and forms that serde does not derive.

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde_json::{Map, Value, json};

use crate::entries::vocabulary as words;
use crate::entries::vocabulary::{MEASURED_MODELS, SENSITIVITIES};
use sensitol::allocation::CurveKind;
use sensitol::method::{ALL as METHODS, DerivativeSource};
use sensitol::plan::Stencil;
use sensitol_external::Settings;

pub(crate) fn methods() -> Vec<&'static str> {
    METHODS.iter().map(|method| method.name()).collect()
}

pub(crate) fn built_in_models() -> Vec<&'static str> {
    sensitol_models::ALL.iter().map(|model| model.name).collect()
}

/// Modes of the check of units.
pub(crate) fn unit_modes() -> Vec<&'static str> {
    words::UNIT_MODES.to_vec()
}

pub(crate) fn stencils() -> Vec<&'static str> {
    Stencil::NAMES.to_vec()
}

/// Names of the choices of sensitivities.
pub(crate) fn sensitivities() -> Vec<&'static str> {
    SENSITIVITIES.to_vec()
}

pub(crate) fn derivatives() -> Vec<&'static str> {
    DerivativeSource::NAMES.to_vec()
}

/// Default settings of external programs.
pub(crate) fn program() -> Settings {
    Settings::new([""])
}

/// Names of the kinds of distribution.
pub(crate) fn kinds() -> Vec<&'static str> {
    words::kinds().map(|(name, _)| name).collect()
}

/// Names of the distributions for measured values.
pub(crate) fn measured_models() -> Vec<&'static str> {
    MEASURED_MODELS.to_vec()
}

/// Names of the forms of a characteristic along an adjusted dimension.
pub(crate) fn stock_responses() -> [&'static str; 3] {
    sensitol::assembly::StockResponse::ALL.map(sensitol::assembly::StockResponse::name)
}

/// Names of the zones of a joint block.
pub(crate) fn zones() -> Vec<&'static str> {
    words::ZONES.to_vec()
}

pub(crate) fn cost_models() -> Vec<&'static str> {
    CurveKind::NAMED.iter().map(|(name, _)| *name).collect()
}

/// Condition that exactly one of these keys is given.
pub(crate) fn one_of<const N: usize>(keys: [&str; N]) -> Value {
    keys.iter().map(|key| json!({ "required": [key] })).collect()
}

/// Schema of a name or a list of names.
pub(crate) fn names(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "anyOf": [{ "type": "string" }, { "type": "array", "items": { "type": "string" }, "minItems": 1 }] })
}

/// Schema of the shorter leg of an angle: a length in mm, or the name of a dimension.
pub(crate) fn leg(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "anyOf": [{ "type": "number", "exclusiveMinimum": 0 }, { "type": "string" }] })
}

/// Schema of a zone or a length.
pub(crate) fn zone(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "number", "minimum": 0 })
}

/// Schema of a distribution as a word or a table with parameters.
pub(crate) fn word_or_table(_: &mut SchemaGenerator) -> Schema {
    let kind = json!({ "description": "The kind of distribution; beside it its parameters, as of a dimension.", "type": "string", "enum": kinds() });
    let table = json!({ "type": "object", "properties": { "kind": kind }, "required": ["kind"] });
    json_schema!({ "anyOf": [{ "type": "string", "enum": kinds() }, table] })
}

pub(crate) fn truth(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "boolean" })
}

/// Schema of the number of equal parts.
pub(crate) fn count(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "integer", "minimum": 1, "maximum": 1000 })
}

/// Schema of a standard deviation, or of two on either side of the nominal.
pub(crate) fn sigma(_: &mut SchemaGenerator) -> Schema {
    let pair = json!({ "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 });
    json_schema!({ "anyOf": [{ "type": "number" }, pair] })
}

/// Schema of the side of a form deviation or of the mean of a process.
pub(crate) fn side(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": ["out", "+", "-"] })
}

fn size(what: &str) -> Value {
    json!({ "description": what, "type": "number", "minimum": 0 })
}

fn diameter(what: &str) -> Value {
    json!({ "description": what, "anyOf": [{ "type": "string" }, { "type": "number", "minimum": 0 }] })
}

/// Schema of a table with these keys only, some of them required.
fn table(properties: Value, required: &[&str]) -> Value {
    json!({ "type": "object", "properties": properties, "required": required, "additionalProperties": false })
}

/// Schema of `position`: a diameter, or a table with a feature whose size widens the zone.
pub(crate) fn position(_: &mut SchemaGenerator) -> Schema {
    let name = |what: &str| json!({ "description": what, "type": "string" });
    let frame = table(
        json!({
            "zone": size("Diameter of the zone at the size that `at` names."),
            "hole": name("A hole whose size gives the bonus."),
            "pin": name("A pin whose size gives the bonus."),
            "at": { "description": "Regardless of size, at maximum or at least material.", "enum": ["RFS", "MMC", "LMC"], "default": "RFS" },
            "form": diameter("Form or orientation of the feature, by which its mating envelope differs from its size: it lessens the bonus."),
            "most": size("The most that the bonus adds."),
        }),
        &["zone"],
    );
    json_schema!({ "anyOf": [{ "type": "number" }, frame] })
}

/// Schema of `float`, the play between a hole and a pin.
pub(crate) fn float(_: &mut SchemaGenerator) -> Schema {
    let laws = json!({
        "description": "Place of the pin: evenly along a line, on either side, always on one, evenly in the hole, on its wall in any direction.",
        "enum": ["uniform", "contact", "+", "-", "disc", "rim"],
        "default": "uniform",
    });
    let sizes = json!({ "hole": diameter("The hole."), "pin": diameter("The pin."), "law": laws });
    Schema::try_from(table(sizes, &["hole", "pin"])).unwrap_or_default()
}

/// Schema of `locate`, a round pin and a slot.
pub(crate) fn locate(_: &mut SchemaGenerator) -> Schema {
    let sizes = json!({
        "hole": diameter("The round hole."),
        "pin": diameter("The pin in it."),
        "slot": diameter("The width of the slot."),
        "pin2": diameter("The pin in the slot."),
        "distance": diameter("Distance of the two pins."),
    });
    Schema::try_from(table(sizes, &["hole", "pin", "slot", "pin2", "distance"])).unwrap_or_default()
}

/// Schema of `profile`: a zone, or a table with its part outside of the material.
pub(crate) fn profile(_: &mut SchemaGenerator) -> Schema {
    let frame = table(
        json!({ "zone": size("Width of the zone."), "outward": size("Part of the zone outside the material.") }),
        &["zone"],
    );
    json_schema!({ "anyOf": [{ "type": "number", "minimum": 0 }, frame] })
}

/// Schema of `fastener`, fixed or floating.
pub(crate) fn fastener(_: &mut SchemaGenerator) -> Schema {
    let two = |what: &str| json!({ "description": what, "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 });
    let keys = json!({
        "kind": { "description": "A pin or stud that stands in one part, or a bolt through holes of two.", "enum": ["fixed", "floating"] },
        "hole": diameter("The clearance hole of a fixed fastener."),
        "holes": two("The two holes of a floating fastener."),
        "pin": diameter("The pin, stud or bolt."),
        "places": two("The positions of the two features; of a fixed fastener that of the threads is the second."),
        "projection": size("Projection of a fixed fastener from its threads, unless the zone is projected."),
        "depth": size("The depth of the threads."),
    });
    Schema::try_from(table(keys, &["kind", "pin", "places"])).unwrap_or_default()
}

/// Schema of `[configurations]`: tables of numbers by name, or a file of them.
pub(crate) fn configurations(_: &mut SchemaGenerator) -> Schema {
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

/// Schema of `[processes]`: lines with keys like those of a dimension, or a file of such lines.
pub(crate) fn processes<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
    let mut law = distribution::<T>(generator).to_value();
    law["description"] = json!("Its distribution.");
    let number = |what: &str| json!({ "description": what, "type": "number" });
    let process = json!({
        "type": "object",
        "properties": {
            "cp": number("Process capability: half a band over 3 sigma."),
            "cpk": number("Process capability with the place of the mean."),
            "sigma": number("Its standard deviation."),
            "sigmas": number("Number of sigmas in half a band."),
            "drift": number("Greatest distance of the mean of a lot from the mean of all."),
            "side": { "description": "Side of the mean.", "type": "string", "enum": ["+", "-"] },
            "distribution": law,
        },
        "additionalProperties": false,
    });
    json_schema!({ "anyOf": [
        { "description": "A file of lines such as turning = { cp = 1.33, cpk = 1.0 }.", "type": "string" },
        { "type": "object", "additionalProperties": process },
    ] })
}

/// Schema of `distribution`: the name of a kind, or one table for each kind with its own parameters. `T` has the parameters of all kinds.
pub(crate) fn distribution<T: JsonSchema>(generator: &mut SchemaGenerator) -> Schema {
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
