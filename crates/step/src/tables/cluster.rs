//! Faces that are one surface: the halves of a cylinder, the pieces of a plane.

use std::collections::{BTreeMap, HashSet};

use crate::semantic::{FaceSurface, StepFace, StepPart, cross, dot, minus, plus, unit};

/// Greatest distance of two surfaces that are one, in metres: the accuracy of a CAD system.
pub(super) const SAME_LENGTH: f64 = 1e-6;
/// Greatest sine of the angle of two directions that are one.
pub(super) const SAME_DIRECTION: f64 = 1e-5;
/// Name of a round face for sorting: pieces of one surface have equal names, up to rounding.
type RoundKey = [i64; 4];
/// Greatest number of comparisons of two faces of a part: some seconds.
const MOST_COMPARISONS: usize = 20_000_000;
/// Greatest number of faces of a group that are compared with each other. Larger groups are whole parts, whose faces stay apart.
const MOST_COMPARED: usize = 2000;

/// True if two lines are one line.
pub(super) fn same_line(a: [f64; 3], along: [f64; 3], b: [f64; 3], other: [f64; 3], tolerance: f64) -> bool {
    let off = minus(b, a);
    let across = plus(off, -dot(off, along), along);
    let turned = cross(along, other);
    dot(turned, turned).sqrt() < SAME_DIRECTION && dot(across, across).sqrt() < tolerance
}

/// True if two faces are pieces of one surface. `tolerance` is a length in the unit of the part.
fn same_surface(a: &StepFace, b: &StepFace, tolerance: f64) -> bool {
    use FaceSurface::{Cone, Cylinder, Plane, Sphere, Torus};
    if a.convex != b.convex {
        return false;
    }
    match (&a.surface, &b.surface) {
        (Plane { point: p, normal: n }, Plane { point: q, normal: m }) => {
            let turned = cross(*n, *m);
            dot(*n, *m) > 0.0 && dot(turned, turned).sqrt() < SAME_DIRECTION && dot(minus(*q, *p), *n).abs() < tolerance
        }
        (Cylinder { point: p, axis: d, radius: r }, Cylinder { point: q, axis: e, radius: s }) => {
            (r - s).abs() < tolerance && same_line(*p, *d, *q, *e, tolerance)
        }
        (
            Cone { point: p, axis: d, radius: r, half_angle: f },
            Cone { point: q, axis: e, radius: s, half_angle: g },
        ) => {
            let off = minus(*q, *p);
            dot(off, off).sqrt() < tolerance
                && (f - g).abs() < 1e-6
                && (r - s).abs() < tolerance
                && same_line(*p, *d, *q, *e, tolerance)
        }
        (Sphere { centre: p, radius: r }, Sphere { centre: q, radius: s }) => {
            let off = minus(*q, *p);
            dot(off, off).sqrt() < tolerance && (r - s).abs() < tolerance
        }
        (Torus { centre: p, axis: d, major: r, minor: s }, Torus { centre: q, axis: e, major: t, minor: u }) => {
            let off = minus(*q, *p);
            dot(off, off).sqrt() < tolerance
                && (r - t).abs() < tolerance
                && (s - u).abs() < tolerance
                && same_line(*p, *d, *q, *e, tolerance)
        }
        _ => false,
    }
}

/// Name of a round face for sorting: its radius and the foot of its axis, in steps that rounding hardly ever separates.
fn round_key(face: &StepFace, tolerance: f64) -> Option<RoundKey> {
    let (point, axis, radius) = match &face.surface {
        FaceSurface::Cylinder { point, axis, radius } => (*point, Some(*axis), *radius),
        FaceSurface::Sphere { centre, radius } => (*centre, None, *radius),
        FaceSurface::Cone { point, axis, radius, .. } => (*point, Some(*axis), *radius),
        FaceSurface::Torus { centre, axis, minor, .. } => (*centre, Some(*axis), *minor),
        FaceSurface::Plane { .. } | FaceSurface::Other(_) => return None,
    };
    let foot = axis.map_or(point, |axis| plus(point, -dot(point, axis), axis));
    let step = |value: f64| (value / (1000.0 * tolerance)).round() as i64;
    Some([step(radius), step(foot[0]), step(foot[1]), step(foot[2])])
}

/// True if two faces of one surface cover a common part of its axis, or have no axis.
fn beside(a: &StepFace, b: &StepFace) -> bool {
    let axis = match &a.surface {
        FaceSurface::Cylinder { axis, .. } | FaceSurface::Cone { axis, .. } => *axis,
        _ => return true,
    };
    match (a.extent(axis), b.extent(axis)) {
        (Some([low, high]), Some([from, to])) => low.max(from) < high.min(to),
        _ => false,
    }
}

/// Number of comparisons that are left.
struct Comparisons(usize);

impl Comparisons {
    /// Takes the comparisons of all pairs of some faces. Returns false if there are too many.
    fn take(&mut self, faces: usize) -> bool {
        if faces > MOST_COMPARED {
            return false;
        }
        match self.0.checked_sub(faces * faces / 2) {
            Some(left) => {
                self.0 = left;
                true
            }
            None => false,
        }
    }
}

/// Faces of a part by the surface to which they belong.
#[derive(Debug)]
pub(super) struct Clusters {
    /// Parent of each face.
    parents: BTreeMap<u64, u64>,
}

impl Clusters {
    /// Joins the faces of each group that are one surface. Faces that no group names together stay apart.
    pub(super) fn new(part: &StepPart, groups: &[Vec<u64>], tolerance: f64) -> Self {
        let mut found = Self { parents: part.faces.keys().map(|&face| (face, face)).collect() };
        let mut left = Comparisons(MOST_COMPARISONS);
        let mut seen: HashSet<&[u64]> = HashSet::new();
        for group in groups.iter().filter(|group| seen.insert(group.as_slice())) {
            let faces: Vec<&StepFace> = group.iter().filter_map(|face| part.faces.get(face)).collect();
            if !left.take(faces.len()) {
                continue;
            }
            for (index, a) in faces.iter().enumerate() {
                for b in &faces[index + 1..] {
                    if same_surface(a, b, tolerance) {
                        found.join(a.entity, b.entity);
                    }
                }
            }
        }
        found.join_halves(part, tolerance, &mut left);
        found
    }

    /// Joins pieces of round surfaces that lie around the same part of an axis, whether anything names them together or not.
    fn join_halves(&mut self, part: &StepPart, tolerance: f64, left: &mut Comparisons) {
        let mut rounds: BTreeMap<RoundKey, Vec<&StepFace>> = BTreeMap::new();
        for face in part.faces.values() {
            if let Some(key) = round_key(face, tolerance) {
                rounds.entry(key).or_default().push(face);
            }
        }
        for faces in rounds.values().filter(|faces| faces.len() > 1) {
            if !left.take(faces.len()) {
                continue;
            }
            for (index, a) in faces.iter().enumerate() {
                for b in &faces[index + 1..] {
                    if same_surface(a, b, tolerance) && beside(a, b) {
                        self.join(a.entity, b.entity);
                    }
                }
            }
        }
    }

    fn root(&self, face: u64) -> u64 {
        let mut at = face;
        while let Some(&parent) = self.parents.get(&at)
            && parent != at
        {
            at = parent;
        }
        at
    }

    fn join(&mut self, a: u64, b: u64) {
        let (a, b) = (self.root(a), self.root(b));
        // The smaller number is the root, so that the order of joining has no effect.
        self.parents.insert(a.max(b), a.min(b));
    }

    /// Clusters of some faces in their order, each once.
    pub(super) fn of(&self, faces: &[u64]) -> Vec<u64> {
        let mut found = Vec::new();
        let mut seen = HashSet::new();
        for face in faces.iter().filter(|face| self.parents.contains_key(face)) {
            let root = self.root(*face);
            if seen.insert(root) {
                found.push(root);
            }
        }
        found
    }

    /// Faces of every cluster.
    pub(super) fn members(&self) -> BTreeMap<u64, Vec<u64>> {
        let mut found: BTreeMap<u64, Vec<u64>> = BTreeMap::new();
        self.parents.keys().for_each(|&face| found.entry(self.root(face)).or_default().push(face));
        found
    }
}

/// Shape of a feature, in the unit of the study.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum FeatureShape {
    /// A plane through its middle, with its extents along its own first and second direction.
    Plane { point: [f64; 3], normal: [f64; 3], size: Option<[f64; 2]> },
    /// An axis through its middle.
    Axis { point: [f64; 3], along: [f64; 3], length: Option<f64>, radius: Option<f64> },
    /// A ball, or a point.
    Point { point: [f64; 3], radius: Option<f64> },
}

/// First and second direction of the frame of a feature: the part's axis that is farthest from `z`, of which the first wins a tie.
pub(super) fn frame(z: [f64; 3]) -> [[f64; 3]; 2] {
    let mut best = 0;
    for axis in 1..3 {
        if z[axis].abs() < z[best].abs() - 1e-9 {
            best = axis;
        }
    }
    let wanted = [0, 1, 2].map(|axis| if axis == best { 1.0 } else { 0.0 });
    let x = unit(plus(wanted, -dot(wanted, z), z)).unwrap_or(wanted);
    [x, cross(z, x)]
}

/// Extent of some faces along a direction.
fn extent(faces: &[&StepFace], along: [f64; 3]) -> Option<[f64; 2]> {
    let all: Vec<[f64; 2]> = faces.iter().filter_map(|face| face.extent(along)).collect();
    let first = *all.first()?;
    Some(all.iter().fold(first, |[low, high], [a, b]| [low.min(*a), high.max(*b)]))
}

/// Middle of some faces in a plane through a point, and their extents in it.
fn middle(faces: &[&StepFace], point: [f64; 3], normal: [f64; 3]) -> ([f64; 3], Option<[f64; 2]>) {
    let mut at = point;
    let mut size = [0.0; 2];
    for (index, direction) in frame(normal).into_iter().enumerate() {
        let Some([low, high]) = extent(faces, direction) else { return (point, None) };
        at = plus(at, 0.5 * (low + high) - dot(at, direction), direction);
        size[index] = high - low;
    }
    (at, Some(size))
}

/// Shape of the faces of a cluster, in the unit of the part. Returns None without a face.
pub(super) fn shape(faces: &[&StepFace]) -> Option<FeatureShape> {
    let first = faces.first()?;
    Some(match &first.surface {
        FaceSurface::Plane { point, normal } => {
            let (point, size) = middle(faces, *point, *normal);
            FeatureShape::Plane { point, normal: *normal, size }
        }
        FaceSurface::Cylinder { point, axis, radius } => line(faces, *point, *axis, Some(*radius)),
        FaceSurface::Cone { point, axis, .. } => line(faces, *point, *axis, None),
        FaceSurface::Torus { centre, axis, .. } => line(faces, *centre, *axis, None),
        FaceSurface::Sphere { centre, radius } => FeatureShape::Point { point: *centre, radius: Some(*radius) },
        FaceSurface::Other(_) => {
            let mut point = [0.0; 3];
            for (index, at) in point.iter_mut().enumerate() {
                let along = [0, 1, 2].map(|axis| if axis == index { 1.0 } else { 0.0 });
                let [low, high] = extent(faces, along)?;
                *at = 0.5 * (low + high);
            }
            FeatureShape::Point { point, radius: None }
        }
    })
}

/// Axis of some faces, which points to the positive side.
fn line(faces: &[&StepFace], point: [f64; 3], axis: [f64; 3], radius: Option<f64>) -> FeatureShape {
    let largest = (0..3).fold(0, |best, at| if axis[at].abs() > axis[best].abs() + 1e-9 { at } else { best });
    let along = if axis[largest] < 0.0 { axis.map(|part| -part) } else { axis };
    match extent(faces, along) {
        Some([low, high]) => {
            let point = plus(point, 0.5 * (low + high) - dot(point, along), along);
            FeatureShape::Axis { point, along, length: Some(high - low), radius }
        }
        None => FeatureShape::Axis { point, along, length: None, radius },
    }
}

/// Middle plane of two planes that face away from or towards each other. Returns None for other shapes.
pub(super) fn median(a: &FeatureShape, b: &FeatureShape, tolerance: f64) -> Option<FeatureShape> {
    let (FeatureShape::Plane { point: p, normal: n, size }, FeatureShape::Plane { point: q, normal: m, .. }) = (a, b)
    else {
        return None;
    };
    let turned = cross(*n, *m);
    let width = dot(minus(*p, *q), *n);
    if dot(*n, *m) > 0.0 || dot(turned, turned).sqrt() > SAME_DIRECTION || width.abs() < tolerance {
        return None;
    }
    let point = [0, 1, 2].map(|axis: usize| 0.5 * (p[axis] + q[axis]));
    Some(FeatureShape::Plane { point, normal: *n, size: *size })
}

impl FeatureShape {
    /// The shape with all lengths times a factor.
    pub(super) fn scaled(&self, scale: f64) -> Self {
        let at = |point: &[f64; 3]| point.map(|part| part * scale);
        match self {
            Self::Plane { point, normal, size } => {
                Self::Plane { point: at(point), normal: *normal, size: size.map(|size| size.map(|one| one * scale)) }
            }
            Self::Axis { point, along, length, radius } => Self::Axis {
                point: at(point),
                along: *along,
                length: length.map(|length| length * scale),
                radius: radius.map(|radius| radius * scale),
            },
            Self::Point { point, radius } => {
                Self::Point { point: at(point), radius: radius.map(|radius| radius * scale) }
            }
        }
    }
}
