//! Schemas of assemblies in space, which are expanded before the study is read into types.

use schemars::{Schema, SchemaGenerator, json_schema};
use serde_json::{Value, json};

/// Schema of a number, the name of a dimension, or a formula.
fn quantity(what: &str) -> Value {
    json!({ "description": what, "anyOf": [{ "type": "number" }, { "type": "string" }] })
}

/// Schema of three numbers.
fn place(what: &str) -> Value {
    json!({ "description": what, "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 3, "maxItems": 3 })
}

/// Schema of a direction.
fn direction(what: &str) -> Value {
    let word = json!({ "type": "string", "enum": ["x", "y", "z", "-x", "-y", "-z"] });
    let turned = json!({
        "type": "object",
        "properties": {
            "turned": quantity("The angle: a number in degrees, a dimension in its unit, or a formula in radians."),
            "about": { "description": "The axis about which it is turned.", "type": "string" },
            "from": { "description": "The direction before it is turned.", "type": "string" },
        },
        "required": ["turned", "about", "from"],
        "additionalProperties": false,
    });
    let vector = json!({ "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 3, "maxItems": 3 });
    json!({ "description": what, "anyOf": [word, vector, turned] })
}

/// Schema of `[parts]`.
pub(crate) fn parts(_: &mut SchemaGenerator) -> Schema {
    let feature = json!({
        "type": "object",
        "properties": {
            "plane": place("A plane through this point; its size has no meaning."),
            "normal": direction("The normal of a plane, out of the material."),
            "axis": place("The axis of a hole or pin, with the middle of its length."),
            "along": direction("The direction of an axis."),
            "point": place("A point, or the centre of a ball."),
            "frame": place("A frame: the way of a slide, a slot, or a datum frame."),
            "z": direction("The third direction of a frame, along its axis or out of its face."),
            "x": direction("The first direction of the feature. Without it, the part's axis that is farthest from the normal or axis."),
            "diameter": quantity("The diameter of a hole, pin or ball."),
            "shift": place("A displacement in the frame of the feature."),
            "tilt": place("A rotation vector in the frame of the feature, in radians."),
        },
        "additionalProperties": false,
    });
    let numbers = |what: &str| json!({ "description": what, "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
    json_schema!({
        "type": "object",
        "additionalProperties": {
            "type": "object",
            "properties": {
                "ground": { "description": "True for the part that stands still.", "type": "boolean" },
                "at": numbers("Where the search for the part starts."),
                "turned": numbers("How the part is turned at the start: a rotation vector in degrees."),
            },
            "additionalProperties": feature,
        },
    })
}

/// Schema of `[joints]`.
pub(crate) fn joints(_: &mut SchemaGenerator) -> Schema {
    let feature = |what: &str| json!({ "description": what, "type": "string" });
    let two = |what: &str| json!({ "description": what, "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 });
    let one_or_two = |what: &str| {
        let list = json!({ "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 });
        json!({ "description": what, "anyOf": [{ "type": "string" }, list] })
    };
    json_schema!({
        "type": "object",
        "additionalProperties": {
            "type": "object",
            "properties": {
                "on": feature("The plane of a contact."),
                "against": feature("The plane, axis or point that lies on it."),
                "hole": feature("The axis of a hole."),
                "pin": feature("The axis of the pin in a hole or slot."),
                "slot": feature("The frame of a slot: x along it, y across it."),
                "ball": feature("The centre of a ball, in a socket or a hole."),
                "socket": feature("The point that holds a ball."),
                "inside": feature("The axis of a round surface, in or around the other one."),
                "outside": one_or_two("The axis of the other round surface; a list of two for surfaces side by side."),
                "crossed": two("Two skew axes whose surfaces touch."),
                "revolute": two("Two frames or axes that turn about z."),
                "slide": two("Two frames that slide along z."),
                "rigid": two("Two frames that are one."),
                "fixed": two("The same as rigid."),
                "rod": two("Two points at a distance of `length`."),
                "angle": two("Two frames: x of the second one is turned about z of the first one by `value`."),
                "takes": { "description": "How many freedoms it takes.", "type": "integer", "minimum": 1, "maximum": 6 },
                "gap": quantity("A distance between the two."),
                "offset": { "description": "Offsets across the axis of a hole, along x and y of the hole.", "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 2, "maxItems": 2 },
                "length": quantity("The length of a rod."),
                "value": quantity("The angle: a number in degrees, a dimension in its unit, or a formula in radians."),
            },
            "additionalProperties": false,
        },
    })
}

/// Schema of the name of a feature.
pub(crate) fn feature(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string" })
}

/// Schema of a coordinate.
pub(crate) fn coordinate(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "string", "enum": ["x", "y", "z"] })
}

/// Schema of the names of two features.
pub(crate) fn pair(_: &mut SchemaGenerator) -> Schema {
    json_schema!({ "type": "array", "items": { "type": "string" }, "minItems": 2, "maxItems": 2 })
}

/// Schema of a profile.
pub(crate) fn profile(_: &mut SchemaGenerator) -> Schema {
    json_schema!({
        "type": "object",
        "properties": {
            "of": { "description": "The face.", "type": "string" },
            "at": { "description": "Points of the face by their coordinates in its frame.", "type": "array", "items": { "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 2, "maxItems": 2 } },
        },
        "required": ["of", "at"],
        "additionalProperties": false,
    })
}
