//! Datum frames: which datums fix something, and which features are measured from each other.

use super::cluster::{FeatureShape, SAME_DIRECTION, frame, same_line};
use super::features::TableFeature;
use super::zone_keys::DatumNames;
use crate::semantic::{cross, dot, minus, plus, unit};

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

/// Datums that a feature can have, without those that fix nothing, whose names are the second value. Two features are a common datum.
/// `tolerance` is the greatest distance of two lines that are one, in the unit of the part.
///
/// # Errors
/// Returns why it can have none: it is its own datum, a datum is measured from it, or two features make no common datum.
pub(super) fn datum_names(
    features: &[TableFeature],
    feature: usize,
    datums: &[Vec<usize>],
    tolerance: f64,
) -> Result<(DatumNames, Vec<String>), String> {
    let mut fixed = FixedFreedoms::default();
    let mut found = DatumNames::default();
    let (mut names, mut idle) = (Vec::new(), Vec::new());
    for datum in datums {
        let name = datum.iter().map(|&one| features[one].name.as_str()).collect::<Vec<_>>().join("-");
        for &one in datum {
            if one == feature {
                return Err(format!("{} is its own datum", features[one].name));
            }
            if is_measured_from(features, one, feature) {
                return Err(format!("datum {} is measured from {}", features[one].name, features[feature].name));
            }
        }
        let shape = match datum[..] {
            [only] => &features[only].shape,
            [first, second] => {
                let shapes = [&features[first].shape, &features[second].shape];
                is_common(shapes, tolerance).map_err(|why| format!("{name} is no common datum: {why}"))?;
                shapes[0]
            }
            _ => return Err(format!("{name} is a common datum of {} features", datum.len())),
        };
        if !fixed.add(shape) {
            idle.push(name);
            continue;
        }
        found.has_axis |= matches!(shape, FeatureShape::Axis { .. });
        found.features.extend(datum);
        names.push(name);
    }
    found.text = names.join(" ");
    Ok((found, idle))
}

/// Checks that two features make a common datum as the reader of studies has it: axes on one line, or parallel planes beside each other.
fn is_common(shapes: [&FeatureShape; 2], tolerance: f64) -> Result<(), &'static str> {
    match shapes {
        [FeatureShape::Axis { point: a, along, .. }, FeatureShape::Axis { point: b, along: other, .. }] => {
            if !same_line(*a, *along, *b, *other, tolerance) {
                return Err("its axes are not one line");
            }
            let apart = dot(minus(*b, *a), *along).abs() > tolerance;
            if apart { Ok(()) } else { Err("its middles are not apart") }
        }
        [FeatureShape::Plane { point: a, normal, .. }, FeatureShape::Plane { point: b, normal: other, .. }] => {
            let turned = cross(*normal, *other);
            if dot(turned, turned).sqrt() > SAME_DIRECTION {
                return Err("its planes are not parallel");
            }
            let off = minus(*b, *a);
            let aside = plus(off, -dot(off, *normal), *normal);
            let apart = dot(aside, aside).sqrt() > tolerance;
            if apart { Ok(()) } else { Err("its middles are not apart") }
        }
        _ => Err("it is not two axes or two planes"),
    }
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
