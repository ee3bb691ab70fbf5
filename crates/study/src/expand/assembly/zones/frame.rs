//! Constant frames of features, in which zones are carried from a datum to the features that are measured from it.

use super::lines::Extent;
use crate::expand::{Tree, Value, quoted};

/// Directions of a feature in its part that do not vary.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::expand::assembly) struct ConstantFrame {
    /// The directions x, y, z.
    pub(in crate::expand::assembly) axes: [[f64; 3]; 3],
}

pub(super) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(super) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Vector of length 1. Returns None for a vector of no length.
pub(super) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length > 0.0 && length.is_finite()).then(|| a.map(|part| part / length))
}

impl ConstantFrame {
    /// Frame of a feature with the keys of its direction. Returns None if a direction varies.
    pub(in crate::expand::assembly) fn of(feature: &Tree, direction: &str) -> Option<Self> {
        let z = match feature.get(direction) {
            Some(given) => constant(given)?,
            None => [0.0, 0.0, 1.0],
        };
        let wanted = match feature.get("x") {
            Some(given) => constant(given)?,
            None => farthest_axis(z),
        };
        let along = dot(wanted, z);
        let x = unit([0, 1, 2].map(|i| wanted[i] - along * z[i]))?;
        Some(Self { axes: [x, cross(z, x), z] })
    }
}

/// Direction of a word or of three numbers. Returns None for others.
pub(super) fn constant(tree: &Tree) -> Option<[f64; 3]> {
    match &tree.value {
        Value::Text(text) => word(text),
        Value::Array(items) => {
            let parts: Vec<f64> = items.iter().map(number).collect::<Option<_>>()?;
            unit(parts.try_into().ok()?)
        }
        _ => None,
    }
}

/// Number of a tree. Returns None for other values.
pub(in crate::expand::assembly) fn number(tree: &Tree) -> Option<f64> {
    match tree.value {
        Value::Number(value) => Some(value),
        Value::Integer(value) => Some(value as f64),
        _ => None,
    }
}

/// The axis of the part that is farthest from a direction. The first one wins a tie, as for the feature itself.
fn farthest_axis(z: [f64; 3]) -> [f64; 3] {
    let mut best = 0;
    for axis in 1..3 {
        if z[axis].abs() < z[best].abs() - 1e-9 {
            best = axis;
        }
    }
    [0, 1, 2].map(|axis| f64::from(u8::from(axis == best)))
}

/// Constant direction of a word such as "-z". Returns None for other words.
pub(in crate::expand::assembly) fn word(text: &str) -> Option<[f64; 3]> {
    let (sign, letter) = match text.strip_prefix('-') {
        Some(letter) => (-1.0, letter),
        None => (1.0, text.strip_prefix('+').unwrap_or(text)),
    };
    let index = ["x", "y", "z"].iter().position(|axis| *axis == letter)?;
    Some([0, 1, 2].map(|i| if i == index { sign } else { 0.0 }))
}

/// Coordinates of a feature in its part. Wrong ones are reported where they are read.
pub(super) fn place(feature: &Tree) -> [Extent; 3] {
    let items = ["plane", "axis", "point", "frame"].iter().find_map(|key| match feature.get(key).map(|of| &of.value) {
        Some(Value::Array(items)) if items.len() == 3 => Some(items),
        _ => None,
    });
    let coordinate = |tree: &Tree| match (&tree.value, number(tree)) {
        (_, Some(value)) => Extent::Number(value),
        (Value::Text(text), None) if sensitol::assembly::formula::is_plain(text) => Extent::Formula(quoted(text)),
        (Value::Text(text), None) => Extent::Formula(format!("({text})")),
        _ => Extent::Number(0.0),
    };
    match items.map(|items| &items[..]) {
        Some([x, y, z]) => [x, y, z].map(coordinate),
        _ => [0.0; 3].map(Extent::Number),
    }
}
