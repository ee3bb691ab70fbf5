//! Datum frames: which datums fix something, and which features are measured from each other.

use super::cluster::{FeatureShape, frame};
use super::features::TableFeature;
use super::zone_keys::DatumNames;
use crate::semantic::{dot, plus, unit};

/// Part of a squared direction below which it counts as 0: roundings of directions. The reader of studies has the same.
const NOTHING: f64 = 1e-9;

/// Directions that are fixed: orthonormal, at most three.
#[derive(Default)]
struct Span(Vec<[f64; 3]>);

impl Span {
    /// Adds a direction. Returns false if the span has it.
    fn add(&mut self, direction: [f64; 3]) -> bool {
        let left = self.0.iter().fold(direction, |left, own| plus(left, -dot(left, *own), *own));
        match unit(left).filter(|_| dot(left, left) > NOTHING) {
            Some(new) => {
                self.0.push(new);
                true
            }
            None => false,
        }
    }
}

/// Freedoms that datums have fixed.
#[derive(Default)]
struct FixedFreedoms {
    rotations: Span,
    displacements: Span,
}

impl FixedFreedoms {
    /// Adds the freedoms that a datum fixes. Returns false if there are none.
    fn add(&mut self, shape: &FeatureShape) -> bool {
        let (rotations, displacements) = match shape {
            FeatureShape::Plane { normal, .. } => (frame(*normal).to_vec(), vec![*normal]),
            FeatureShape::Axis { along, .. } => (frame(*along).to_vec(), frame(*along).to_vec()),
            FeatureShape::Point { .. } => (Vec::new(), vec![[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
        };
        // A second axis or point stops a rotation by its distance from the first.
        let by_distance = !matches!(shape, FeatureShape::Plane { .. })
            && self.rotations.0.len() < 3
            && !self.displacements.0.is_empty();
        let added = rotations.iter().filter(|&&direction| self.rotations.add(direction)).count()
            + displacements.iter().filter(|&&direction| self.displacements.add(direction)).count();
        if by_distance && added == 0 {
            for axis in 0..3 {
                self.rotations.add([0, 1, 2].map(|other| if other == axis { 1.0 } else { 0.0 }));
            }
        }
        added > 0 || by_distance
    }
}

/// Datums that a feature can have, without those that fix nothing, whose names are the second value.
///
/// # Errors
/// Returns why it can have none: it is its own datum, or a datum is measured from it.
pub(super) fn datum_names(
    features: &[TableFeature],
    feature: usize,
    datums: &[usize],
) -> Result<(DatumNames, Vec<String>), String> {
    let mut fixed = FixedFreedoms::default();
    let mut found = DatumNames::default();
    let mut idle = Vec::new();
    for &datum in datums {
        let of = &features[datum];
        if datum == feature {
            return Err(format!("{} is its own datum", of.name));
        }
        if is_measured_from(features, datum, feature) {
            return Err(format!("datum {} is measured from {}", of.name, features[feature].name));
        }
        if !fixed.add(&of.shape) {
            idle.push(of.name.clone());
            continue;
        }
        found.has_axis |= matches!(of.shape, FeatureShape::Axis { .. });
        found.features.push(datum);
    }
    let names: Vec<&str> = found.features.iter().map(|&datum| features[datum].name.as_str()).collect();
    found.text = names.join(" ");
    Ok((found, idle))
}

/// True if a feature is measured from another one, directly or by its datums.
fn is_measured_from(features: &[TableFeature], feature: usize, from: usize) -> bool {
    let mut seen = std::collections::HashSet::new();
    let mut open = vec![feature];
    while let Some(at) = open.pop() {
        if at == from {
            return true;
        }
        if seen.insert(at) {
            open.extend(features[at].zones.datum_features());
        }
    }
    false
}
