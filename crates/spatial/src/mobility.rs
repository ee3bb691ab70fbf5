//! Mobility: which motions the joints leave free, and which joints repeat others.

use crate::assembly::{Assembly, FeatureKind, JointKind};
use crate::closure::{Closure, RANK, add_orthogonal, new_part, norm, rest};
use crate::error::SpatialError;
use crate::placement::turned;

/// Motion that no joint stops: a rotation and a displacement of every moving part.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct FreeMotion {
    /// The motion in words.
    pub(crate) text: String,
    /// Parts by the unknowns, scaled to the length 1.
    pub(crate) vector: Vec<f64>,
}

/// Numbers of unknowns and equations of an assembly, and its free motions.
#[derive(Debug, Clone, PartialEq)]
pub struct Mobility {
    /// Number of parts.
    pub parts: usize,
    /// Number of joints.
    pub joints: usize,
    /// Number of unknowns: six for every part that moves.
    pub unknowns: usize,
    /// Number of equations of the joints, all of them independent.
    pub equations: usize,
    /// Motions that no joint stops and no measure depends on, in words.
    pub free: Vec<String>,
    /// Equations that hardly add to those before them, in words. Rounding decides whether they repeat these.
    pub doubtful: Vec<String>,
}

/// New part of an equation below which its rank is doubtful.
const DOUBTFUL: f64 = 1e-7;

/// Greatest part of a motion's effect that counts as none.
const UNFELT: f64 = 1e-9;

impl Closure<'_> {
    /// Checks that no joint repeats others. Returns the equations whose rank is doubtful, in words.
    pub(crate) fn check_redundancy(&self) -> Result<Vec<String>, SpatialError> {
        let linear = self.linear();
        let row = |i: usize| (0..linear.jacobian.ncols()).map(|j| linear.jacobian[(i, j)]).collect::<Vec<f64>>();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        let mut first: Option<(usize, Vec<&'static str>)> = None;
        let mut doubtful = Vec::new();
        for (index, _) in self.assembly.joints.iter().enumerate() {
            let rows: Vec<usize> = (0..linear.joints.len()).filter(|&i| linear.joints[i] == index).collect();
            let mut new = Vec::new();
            for &i in &rows {
                let part = new_part(&mut basis, &row(i));
                if part > RANK {
                    new.push(linear.names[i]);
                }
                if part > RANK && part < DOUBTFUL {
                    let name = &self.assembly.joints[index].name;
                    doubtful.push(format!("joint `{name}` ({}) adds only {part:.1e}", linear.names[i]));
                }
            }
            if new.len() < rows.len() && first.is_none() {
                first = Some((index, new));
            }
        }
        let Some((index, free)) = first else { return Ok(doubtful) };
        let left = free.len();
        let joint = &self.assembly.joints[index];
        let names: Vec<String> =
            self.assembly.joints[..index].iter().map(|joint| format!("`{}`", joint.name)).collect();
        Err(SpatialError::OverConstrained {
            joint: joint.name.clone(),
            index,
            takes: self.used[index].len(),
            left,
            free: free.into(),
            before: if names.is_empty() { "the start".into() } else { names.join(", ").into() },
            equations: linear.joints.len(),
            unknowns: linear.jacobian.ncols(),
            rank: basis.len(),
            instead: instead(self.assembly, index, left).into(),
        })
    }

    /// Motions that no joint stops, those of a single part first.
    pub(crate) fn free_motions(&self) -> Vec<FreeMotion> {
        let linear = self.linear();
        let (rows, columns) = (linear.jacobian.nrows(), linear.jacobian.ncols());
        let count = columns.saturating_sub(rows);
        let scale = (0..rows).map(|i| norm(&(0..columns).map(|j| linear.jacobian[(i, j)]).collect::<Vec<_>>()));
        let scale = scale.fold(1.0, f64::max);
        let is_free = |vector: &[f64]| {
            let effect = |i: usize| (0..columns).map(|j| linear.jacobian[(i, j)] * vector[j]).sum::<f64>();
            norm(&(0..rows).map(effect).collect::<Vec<_>>()) <= UNFELT * scale
        };
        let mut found: Vec<FreeMotion> = Vec::new();
        let mut basis: Vec<Vec<f64>> = Vec::new();
        for candidate in self.simple_motions() {
            if found.len() < count && is_free(&candidate.vector) && is_new(&mut basis, &candidate.vector) {
                found.push(candidate);
            }
        }
        // The others are combined motions: what the rows and the found motions leave.
        let mut span = basis;
        for i in 0..rows {
            add_orthogonal(&mut span, &(0..columns).map(|j| linear.jacobian[(i, j)]).collect::<Vec<_>>());
        }
        for j in 0..columns {
            if found.len() >= count {
                break;
            }
            let unit: Vec<f64> = (0..columns).map(|k| f64::from(u8::from(k == j))).collect();
            let left = rest(&span, &unit);
            if norm(&left) > 1e-6 {
                let vector: Vec<f64> = left.iter().map(|part| part / norm(&left)).collect();
                found.push(FreeMotion { text: self.combined(&vector), vector: vector.clone() });
                add_orthogonal(&mut span, &vector);
            }
        }
        number_alike(&mut found);
        found
    }

    /// Names the parts of a combined motion.
    fn combined(&self, vector: &[f64]) -> String {
        let moves = |index: &usize| norm(&vector[6 * index..6 * index + 6]) > 1e-6;
        let names: Vec<String> = (0..self.moving.len())
            .filter(moves)
            .map(|index| self.assembly.parts[self.moving[index]].name.clone())
            .collect();
        match &names[..] {
            [one] => format!("{one} moves along a screw"),
            names => format!("{} move together", names.join(", ")),
        }
    }

    /// Rotations and displacements of one part along its features and along the axes of the assembly.
    fn simple_motions(&self) -> Vec<FreeMotion> {
        let mut motions = Vec::new();
        for (index, &part) in self.moving.iter().enumerate() {
            let name = &self.assembly.parts[part].name;
            let place = &self.places[part];
            let mut add = |text: String, turn: [f64; 3], shift: [f64; 3]| {
                let mut vector = vec![0.0; 6 * self.moving.len()];
                vector[6 * index..6 * index + 3].copy_from_slice(&turn);
                (0..3).for_each(|i| vector[6 * index + 3 + i] = shift[i] / self.size);
                let length = norm(&vector);
                vector.iter_mut().for_each(|part| *part /= length);
                motions.push(FreeMotion { text, vector });
            };
            let axes = self.feature_axes(part);
            for (axis, origin, direction) in &axes {
                // A rotation about an axis through `origin` moves the part's origin too.
                let arm = [0, 1, 2].map(|i| place.translation[i] - origin[i]);
                add(format!("{name} turns about {axis}"), *direction, cross(*direction, arm));
            }
            for (letter, direction) in ["x", "y", "z"].iter().zip(WORLD) {
                add(format!("{name} slides along {letter}"), [0.0; 3], direction.map(|part| part * self.size));
            }
            for (axis, _, direction) in &axes {
                add(format!("{name} slides along {axis}"), [0.0; 3], direction.map(|part| part * self.size));
            }
            for (axis, origin, _) in &axes {
                for (letter, direction) in ["x", "y", "z"].iter().zip(WORLD) {
                    let arm = [0, 1, 2].map(|i| place.translation[i] - origin[i]);
                    let at = axis.split(" of ").last().unwrap_or(axis);
                    add(format!("{name} turns about {letter} at {at}"), direction, cross(direction, arm));
                }
            }
        }
        motions
    }

    /// Axes about which a part may turn: of its own features, of those that it is joined to, and between two balls.
    fn feature_axes(&self, part: usize) -> Vec<(String, [f64; 3], [f64; 3])> {
        let mut axes = Vec::new();
        let mut points: Vec<(String, [f64; 3])> = Vec::new();
        for joint in self.assembly.joints.iter().filter(|joint| joint.between.iter().any(|id| id.part == part)) {
            let mut features = joint.between;
            features.sort_by_key(|id| id.part != part);
            for id in features {
                let feature = self.assembly.feature(id);
                let place = &self.places[id.part];
                let (origin, axis) = self.feature_line(id);
                let name = self.assembly.feature_name(id);
                match feature.kind {
                    FeatureKind::Point if id.part == part => {
                        let at = turned(&place.rotation, feature.origin.each_ref().map(|part| part.value));
                        points.push((name, [0, 1, 2].map(|i| at[i] + place.translation[i])));
                    }
                    FeatureKind::Point => {}
                    FeatureKind::Axis => axes.push((format!("the axis of {name}"), origin, axis)),
                    FeatureKind::Plane => axes.push((format!("the normal of {name}"), origin, axis)),
                    FeatureKind::Frame => axes.push((format!("z of {name}"), origin, axis)),
                }
            }
        }
        // A part on two balls turns about the line between them.
        if let Some((first, others)) = points.split_first() {
            for other in others {
                let line = [0, 1, 2].map(|i| other.1[i] - first.1[i]);
                let length = norm(&line);
                if length > 0.0 {
                    let text = format!("the line from {} to {}", first.0, other.0);
                    axes.push((text, first.1, line.map(|part| part / length)));
                }
            }
        }
        axes
    }

    /// Origin and z of a feature in the assembly.
    fn feature_line(&self, id: crate::assembly::FeatureId) -> ([f64; 3], [f64; 3]) {
        let number = |quantity: &crate::assembly::Quantity| {
            <crate::dual::Dual as crate::number::Number>::constant(quantity.value)
        };
        let local = crate::placement::LocalFeature::new(self.assembly.feature(id), &number);
        let placed = crate::placement::Pose::still(&self.places[id.part]).placed(&local);
        (placed.origin.values(), placed.axes[2].values())
    }

    /// Checks that no measure depends on a free motion.
    pub(crate) fn check_free(&self, motions: &[FreeMotion]) -> Result<(), SpatialError> {
        for (index, measure) in self.assembly.measures.iter().enumerate() {
            for gradient in self.measure_gradients(index) {
                for motion in motions {
                    let along: f64 = gradient.iter().zip(&motion.vector).map(|(a, b)| a * b).sum();
                    // A measure that no part moves has no gradient, and one with the size of a length is compared with that.
                    if along.abs() > 10.0 * RANK * norm(&gradient) && along.abs() > 10.0 * RANK {
                        let (motion, measure) = (motion.text.clone(), measure.name.clone());
                        return Err(SpatialError::Free { motion, measure, index });
                    }
                }
            }
        }
        Ok(())
    }
}

/// Numbers motions with the same words, so that each has a name of its own.
fn number_alike(motions: &mut [FreeMotion]) {
    let texts: Vec<String> = motions.iter().map(|motion| motion.text.clone()).collect();
    for (place, motion) in motions.iter_mut().enumerate() {
        let before = texts[..place].iter().filter(|&text| *text == texts[place]).count();
        if before > 0 {
            motion.text = format!("{} ({})", texts[place], before + 1);
        }
    }
}

const WORLD: [[f64; 3]; 3] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

fn is_new(basis: &mut Vec<Vec<f64>>, vector: &[f64]) -> bool {
    norm(&rest(basis, vector)) > 1e-6 && add_orthogonal(basis, vector)
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Text to write instead of a joint that repeats others.
fn instead(assembly: &Assembly, index: usize, left: usize) -> String {
    let joint = &assembly.joints[index];
    let kinds = joint.between.map(|id| assembly.feature(id).kind);
    let known = joint.kind.freedoms(kinds).unwrap_or(&[]);
    let moving = joint.between.map(|id| id.part);
    let same_pair = |other: &&crate::assembly::PartJoint| {
        other.kind == JointKind::Pin && other.between.iter().all(|id| moving.contains(&id.part))
    };
    if joint.kind == JointKind::Pin && assembly.joints[..index].iter().any(|other| same_pair(&other)) {
        return "takes = 2 on both makes it a shaft in two bores".into();
    }
    match known.iter().find(|&&takes| takes <= left && takes > 0) {
        Some(takes) => format!("write takes = {takes} for `{}`", joint.name),
        None => format!("remove `{}`, or let a joint before it take less", joint.name),
    }
}
