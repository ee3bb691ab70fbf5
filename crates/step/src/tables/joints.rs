//! Joints proposed from faces of two placed parts that coincide.

use super::cluster::{FeatureShape, SAME_DIRECTION, SAME_LENGTH, frame, same_line};
use super::part::PartWriter;
use crate::semantic::{Placement, cross, dot, minus, plus};

/// Greatest clearance of a pin in its hole, of the diameter of the hole.
const MOST_CLEARANCE: f64 = 0.1;
/// Greatest number of joints that are proposed. A list that is longer is read by nobody.
const MOST_JOINTS: usize = 200;

/// A face at its place.
struct PlacedFace {
    part: usize,
    root: u64,
    /// Shape in the unit of the study and in the frame of the assembly.
    shape: FeatureShape,
    convex: bool,
    /// Coordinate along which faces that coincide are neighbours.
    order: f64,
}

/// Two faces that coincide.
struct Coincidence {
    parts: [usize; 2],
    roots: [u64; 2],
    kind: CoincidenceKind,
    /// Rows of the motions that a joint stops, about the origin of the assembly: rotation, then displacement.
    rows: Vec<[f64; 6]>,
}

/// Kind of a coincidence.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum CoincidenceKind {
    Faces,
    HoleAndPin,
}

/// Shape at a placement.
fn placed(shape: &FeatureShape, placement: &Placement) -> FeatureShape {
    match shape {
        FeatureShape::Plane { point, normal, size } => {
            FeatureShape::Plane { point: placement.point(*point), normal: placement.direction(*normal), size: *size }
        }
        FeatureShape::Axis { point, along, length, radius } => FeatureShape::Axis {
            point: placement.point(*point),
            along: placement.direction(*along),
            length: *length,
            radius: *radius,
        },
        FeatureShape::Point { point, radius } => {
            FeatureShape::Point { point: placement.point(*point), radius: *radius }
        }
    }
}

/// Direction whose sign does not matter.
fn unsigned(direction: [f64; 3]) -> [f64; 3] {
    let largest = (0..3).fold(0, |best, at| if direction[at].abs() > direction[best].abs() + 1e-9 { at } else { best });
    if direction[largest] < 0.0 { direction.map(|part| -part) } else { direction }
}

/// Faces of all parts at their places.
fn faces(writers: &[PartWriter<'_>]) -> Vec<PlacedFace> {
    let mut found = Vec::new();
    for (index, writer) in writers.iter().enumerate() {
        let Some(placement) = &writer.placement else { continue };
        for root in writer.features.all_roots() {
            let Some((shape, convex)) = writer.features.shape(writer.part, root) else { continue };
            let shape = placed(&shape, placement).scaled(writer.scale);
            let order = match &shape {
                FeatureShape::Plane { point, normal, .. } => dot(*point, unsigned(*normal)),
                FeatureShape::Axis { point, along, radius: Some(_), .. } => {
                    let across = plus(*point, -dot(*point, *along), *along);
                    dot(across, across).sqrt()
                }
                _ => continue,
            };
            found.push(PlacedFace { part: index, root, shape, convex, order });
        }
    }
    found.sort_by(|a, b| a.order.total_cmp(&b.order));
    found
}

/// True if two rectangles of planes or two pieces of an axis lie over each other. Extents of the second are taken as a circle.
fn overlaps(a: &FeatureShape, b: &FeatureShape) -> bool {
    match (a, b) {
        (
            FeatureShape::Plane { point: p, normal, size: Some(size) },
            FeatureShape::Plane { point: q, size: Some(other), .. },
        ) => {
            let off = minus(*q, *p);
            let reach = 0.5 * other[0].hypot(other[1]);
            frame(*normal).iter().zip(size).all(|(axis, size)| dot(off, *axis).abs() < 0.5 * size.max(0.0) + reach)
        }
        (
            FeatureShape::Axis { point: p, along, length: Some(length), .. },
            FeatureShape::Axis { point: q, length: Some(other), .. },
        ) => dot(minus(*q, *p), *along).abs() < 0.5 * (length + other) * (1.0 - 1e-6),
        _ => true,
    }
}

/// Coincidence of two faces. Returns None if they do not coincide.
fn coincidence(a: &PlacedFace, b: &PlacedFace, tolerance: f64) -> Option<Coincidence> {
    if a.part == b.part || !overlaps(&a.shape, &b.shape) || !overlaps(&b.shape, &a.shape) {
        return None;
    }
    let row = |direction: [f64; 3], at: [f64; 3]| {
        let turn = cross(at, direction);
        [turn[0], turn[1], turn[2], direction[0], direction[1], direction[2]]
    };
    let tilt = |axis: [f64; 3]| [axis[0], axis[1], axis[2], 0.0, 0.0, 0.0];
    match (&a.shape, &b.shape) {
        (FeatureShape::Plane { point: p, normal: n, .. }, FeatureShape::Plane { point: q, normal: m, .. }) => {
            let turned = cross(*n, *m);
            let apart = dot(minus(*q, *p), *n).abs();
            if dot(*n, *m) > 0.0 || dot(turned, turned).sqrt() > SAME_DIRECTION || apart > tolerance {
                return None;
            }
            let [x, y] = frame(*n);
            let rows = vec![row(*n, *p), tilt(x), tilt(y)];
            let (parts, roots) = ([a.part, b.part], [a.root, b.root]);
            Some(Coincidence { parts, roots, kind: CoincidenceKind::Faces, rows })
        }
        (
            FeatureShape::Axis { point: p, along: d, radius: Some(r), .. },
            FeatureShape::Axis { point: q, along: e, radius: Some(s), .. },
        ) => {
            if a.convex == b.convex || !same_line(*p, *d, *q, *e, tolerance) {
                return None;
            }
            let (hole, pin, clearance) = if a.convex { (b, a, s - r) } else { (a, b, r - s) };
            if clearance < -tolerance || clearance > MOST_CLEARANCE * r.max(*s) {
                return None;
            }
            let [x, y] = frame(*d);
            let rows = vec![row(x, *p), row(y, *p), tilt(x), tilt(y)];
            let (parts, roots) = ([hole.part, pin.part], [hole.root, pin.root]);
            Some(Coincidence { parts, roots, kind: CoincidenceKind::HoleAndPin, rows })
        }
        _ => None,
    }
}

/// Motions that are stopped, as orthonormal rows of which rotations are times a length.
struct StoppedMotions {
    rows: Vec<[f64; 6]>,
    length: f64,
}

impl StoppedMotions {
    /// Adds the rows of a joint. Returns how many of them are new.
    fn add(&mut self, rows: &[[f64; 6]]) -> usize {
        let mut new = 0;
        for row in rows {
            let mut left = *row;
            // Both parts of a row then are lengths of equal size.
            let is_tilt = left[3..].iter().all(|part| *part == 0.0);
            left[..3].iter_mut().for_each(|part| *part /= if is_tilt { 1.0 } else { self.length });
            for known in &self.rows {
                let along: f64 = left.iter().zip(known).map(|(a, b)| a * b).sum();
                left.iter_mut().zip(known).for_each(|(part, known)| *part -= along * known);
            }
            let size = left.iter().map(|part| part * part).sum::<f64>().sqrt();
            // A hundredth of the size of the assembly is a lever of no worth.
            if size > 1e-2 {
                self.rows.push(left.map(|part| part / size));
                new += 1;
            }
        }
        new
    }
}

/// Joints of parts that coincide, as comments. Names the features that they use.
pub(super) fn propose(writers: &mut [PartWriter<'_>]) -> Vec<String> {
    let faces = faces(writers);
    let metres = writers.iter().find_map(|writer| match writer.part.unit {
        crate::semantic::StepUnit::Length(scale) => Some(scale / writer.scale),
        _ => None,
    });
    let tolerance = 10.0 * SAME_LENGTH / metres.unwrap_or(1e-3);
    let mut found: Vec<Coincidence> = Vec::new();
    let mut left_out = 0_usize;
    for (index, a) in faces.iter().enumerate() {
        for b in faces[index + 1..].iter().take_while(|b| b.order - a.order <= tolerance) {
            let Some(one) = coincidence(a, b, tolerance) else { continue };
            if found.len() < MOST_JOINTS { found.push(one) } else { left_out += 1 }
        }
    }
    // In the order of the parts, faces before pins: a part is laid down and then turned into place.
    found.sort_by_key(|one| ([one.parts[0].min(one.parts[1]), one.parts[0].max(one.parts[1])], one.kind, one.roots));
    let size = faces.iter().map(|face| face.order.abs()).fold(1e-9, f64::max);
    let mut lines = lines(&found, writers, size);
    if left_out > 0 {
        lines.push(format!("# {left_out} more faces coincide."));
    }
    lines
}

fn lines(found: &[Coincidence], writers: &mut [PartWriter<'_>], size: f64) -> Vec<String> {
    let mut lines = Vec::new();
    let mut stopped = StoppedMotions { rows: Vec::new(), length: size };
    let mut of = [usize::MAX; 2];
    for one in found {
        let pair = [one.parts[0].min(one.parts[1]), one.parts[0].max(one.parts[1])];
        if pair != of {
            of = pair;
            stopped.rows.clear();
            lines.push(format!("# {} and {}:", writers[pair[0]].name, writers[pair[1]].name));
        }
        let mut names = Vec::new();
        for (part, root) in one.parts.into_iter().zip(one.roots) {
            let writer = &mut writers[part];
            let feature = writer.features.of(writer.part, &[root]).first().copied();
            let Some(feature) = feature else { continue };
            names.push(format!("{}.{}", writer.name, writer.features.all[feature].name));
        }
        let [a, b] = &names[..] else { continue };
        let new = stopped.add(&one.rows);
        let (keys, takes) = match (one.kind, new) {
            (CoincidenceKind::Faces, new) => (["on", "against"], Some(new).filter(|new| *new > 0)),
            (CoincidenceKind::HoleAndPin, 4) => (["hole", "pin"], Some(4)),
            (CoincidenceKind::HoleAndPin, 2 | 3) => (["hole", "pin"], Some(2)),
            (CoincidenceKind::HoleAndPin, _) => (["hole", "pin"], None),
        };
        let [first, second] = keys;
        let number = lines.iter().filter(|line| line.contains(" = { ")).count() + 1;
        let (takes, remark) = match (takes, new) {
            (Some(takes), _) => (format!(", takes = {takes}"), ""),
            (None, 0) => (String::new(), "  # the joints above stop all that it would"),
            (None, _) => (String::new(), "  # one motion is left: a slot"),
        };
        lines.push(format!("# joint_{number} = {{ {first} = \"{a}\", {second} = \"{b}\"{takes} }}{remark}"));
    }
    lines
}
