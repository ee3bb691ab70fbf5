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

/// Schema of a zone: its width, or a table of this zone.
fn zone(what: &str, more: &[(&str, Value)]) -> Value {
    let mut properties = serde_json::Map::new();
    properties
        .insert("zone".into(), quantity("The number in the feature control frame: the diameter or width of the zone."));
    properties.insert(
        "distribution".into(),
        json!({ "description": "The law of this zone, in place of that of the feature.", "type": "string", "enum": ["normal", "uniform"] }),
    );
    for (key, text) in [("sigmas", "Sigmas in half the zone."), ("cp", "Process capability.")] {
        properties.insert(key.into(), json!({ "description": text, "type": "number" }));
    }
    properties.extend(more.iter().map(|(key, schema)| ((*key).to_owned(), schema.clone())));
    let table =
        json!({ "type": "object", "properties": properties, "required": ["zone"], "additionalProperties": false });
    json!({ "description": what, "anyOf": [{ "type": "number", "minimum": 0 }, { "type": "string" }, table] })
}

/// Schemas of the zones of a feature, and of its datums and extent.
fn zones() -> Vec<(&'static str, Value)> {
    let name = |what: &str| json!({ "description": what, "type": "string" });
    let position = [
        ("at", json!({ "description": "The modifier.", "type": "string", "enum": ["RFS", "MMC", "LMC"] })),
        ("hole", name("The diameter whose size gives the bonus of a hole.")),
        ("pin", name("The diameter whose size gives the bonus of a pin.")),
        ("most", json!({ "description": "Cap of the bonus.", "type": "number", "minimum": 0 })),
        (
            "outward",
            json!({ "description": "Part of the zone out of the material, of a plane.", "type": "number", "minimum": 0 }),
        ),
    ];
    let orientation = [("datums", name("Datums of the orientation, if they are not those of the feature: \"A D\"."))];
    let form = [(
        "side",
        json!({ "description": "All of the zone lies out of the material.", "type": "string", "enum": ["out"] }),
    )];
    let extent = json!({ "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 2, "maxItems": 2 });
    let mut size = extent;
    size["description"] = json!("Extents of a face along its x and y, over which its zones hold.");
    vec![
        (
            "position",
            zone("Position: the diameter of the zone of an axis or point, its width for a plane or slot.", &position),
        ),
        ("profile", zone("Profile of a plane.", &position[4..])),
        ("coaxiality", zone("Coaxiality of an axis or point, a diameter.", &[])),
        ("concentricity", zone("The same as coaxiality.", &[])),
        ("runout", zone("Runout of an axis, point or round face about the datum axis.", &[])),
        ("total_runout", zone("The same as runout, of the whole surface.", &[])),
        ("perpendicularity", zone("Perpendicularity: a diameter for an axis, a width for a plane.", &orientation)),
        ("parallelism", zone("Parallelism.", &orientation)),
        ("angularity", zone("Angularity.", &orientation)),
        ("flatness", zone("Flatness: it moves the face at a contact, not its frame.", &form)),
        ("straightness", zone("Straightness, likewise.", &form)),
        ("roundness", zone("Roundness, likewise.", &form)),
        ("cylindricity", zone("Cylindricity, likewise.", &form)),
        (
            "targets",
            json!({ "description": "Datum targets of a plane, one to three places along its x and y: a joint touches there.", "type": "array",
                "items": { "type": "array", "items": { "type": "number" }, "minItems": 2, "maxItems": 2 }, "minItems": 1, "maxItems": 3 }),
        ),
        (
            "datums",
            name(
                "Features of this part from which the zones are measured, in their order: \"A B C\". \"A-B\" are two that make one datum.",
            ),
        ),
        ("length", quantity("The length over which the zones hold: of an axis, or across the tilt of a face.")),
        ("size", size),
        (
            "distribution",
            json!({ "description": "The law of the zones: \"normal\" with 3 sigma at half the zone, or \"uniform\".", "type": "string", "enum": ["normal", "uniform"] }),
        ),
    ]
}

/// Schema of the patterns of a part.
fn patterns() -> Value {
    json!({
        "description": "Patterns: features that move as one body within a wide zone, and each within a narrow one.",
        "type": "object",
        "additionalProperties": {
            "type": "object",
            "properties": {
                "of": { "description": "The axes of the pattern.", "type": "array", "items": { "type": "string" }, "minItems": 2 },
                "position": zone("The zone of the pattern as one body: the upper segment.", &[]),
                "within": zone("The zone of each feature within the pattern: the lower segment.", &[]),
            },
            "required": ["of", "position"],
            "additionalProperties": false,
        },
    })
}

/// Schema of `[parts]`.
pub(crate) fn parts(_: &mut SchemaGenerator) -> Schema {
    let mut feature = json!({
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
            "diameter": quantity("The diameter of a hole, pin, ball or round face."),
            "shift": place("A displacement in the frame of the feature."),
            "tilt": place("A rotation vector in the frame of the feature, in radians."),
        },
        "additionalProperties": false,
    });
    for (key, schema) in zones() {
        feature["properties"][key] = schema;
    }
    let numbers = |what: &str| json!({ "description": what, "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 });
    json_schema!({
        "type": "object",
        "additionalProperties": {
            "type": "object",
            "properties": {
                "ground": { "description": "True for the part that stands still.", "type": "boolean" },
                "at": numbers("Start of the search for the place of the part."),
                "turned": numbers("Rotation of the part at the start: a rotation vector in degrees."),
                "patterns": patterns(),
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
    let force = json!({
        "description": "The direction of the force that presses the part against its contacts, in the assembly.",
        "anyOf": [
            { "type": "string", "enum": ["x", "y", "z", "-x", "-y", "-z"] },
            { "type": "array", "items": { "type": "number" }, "minItems": 3, "maxItems": 3 },
        ],
    });
    json_schema!({
        "type": "object",
        "additionalProperties": {
            "type": "object",
            "properties": {
                "on": feature("The plane of a contact."),
                "against": feature("The plane, axis or point that lies on it; with `press` a plane with flatness and size, which touches at its corners."),
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
                "rod": two("Two points at a distance of `length`."),
                "angle": two("Two frames: x of the second one is turned about z of the first one by `value`."),
                "takes": { "description": "Number of freedoms that it takes.", "type": "integer", "minimum": 1, "maximum": 6 },
                "gap": quantity("A distance between the two."),
                "offset": { "description": "Offsets across the axis of a hole, along x and y of the hole.", "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 2, "maxItems": 2 },
                "tilt": { "description": "Slopes of the axis of a pin along x and y of its hole.", "type": "array", "items": { "anyOf": [{ "type": "number" }, { "type": "string" }] }, "minItems": 2, "maxItems": 2 },
                "float": { "description": "Place of the pin in its hole: anywhere in it, on its wall, or along one direction.", "type": "string", "enum": ["disc", "rim", "uniform", "contact", "+", "-"] },
                "toward": direction("The direction of a float in the frame of the hole's part; without `float` the pin lies on that side."),
                "tilt_float": { "description": "True for a pin that tilts by the clearance over the length of its hole.", "type": "boolean" },
                "press": force,
                "weight_at": feature("The feature of the pressed part at which the force acts; without it the middle of the contacts."),
                "targets": { "description": "The points of a part that can touch the plane, 3 to 12.", "type": "array", "items": { "type": "string" }, "minItems": 3, "maxItems": 12 },
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
