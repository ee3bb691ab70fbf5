//! Poses of parts, and features at their places in the assembly.

use crate::assembly::{Direction, Feature, Quantity};
use crate::number::Number;
use crate::vector::Vector;

/// A rotation matrix of constants.
pub(crate) type Rotation = [[f64; 3]; 3];

/// No rotation.
pub(crate) const STILL: Rotation = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];

/// Pose of a part that the search starts from or has reached.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Place {
    pub(crate) rotation: Rotation,
    pub(crate) translation: [f64; 3],
}

/// Product of two rotations.
pub(crate) fn product(a: &Rotation, b: &Rotation) -> Rotation {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()))
}

/// A rotated vector.
pub(crate) fn turned(rotation: &Rotation, vector: [f64; 3]) -> [f64; 3] {
    [0, 1, 2].map(|i| (0..3).map(|k| rotation[i][k] * vector[k]).sum())
}

/// Half-angle vector of a rotation vector: its direction, with the tangent of half the angle as length.
pub(crate) fn half_angle(vector: [f64; 3]) -> [f64; 3] {
    let angle = vector.iter().map(|part| part * part).sum::<f64>().sqrt();
    if angle == 0.0 {
        return vector;
    }
    vector.map(|part| part / angle * libm::tan(0.5 * angle))
}

/// Rotation vector of a rotation matrix, of an angle of at most pi.
pub(crate) fn rotation_vector(r: &Rotation) -> [f64; 3] {
    let twist = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
    let (sine, cosine) =
        (0.5 * twist.iter().map(|part| part * part).sum::<f64>().sqrt(), 0.5 * (r[0][0] + r[1][1] + r[2][2] - 1.0));
    let angle = libm::atan2(sine, cosine);
    if sine > 1e-6 {
        return twist.map(|part| 0.5 * part * angle / sine);
    }
    if cosine > 0.0 {
        return twist.map(|part| 0.5 * part);
    }
    // Near half a turn the axis follows from the symmetric part: R + 1 = 2 a a^T.
    let k = (0..3).max_by(|&i, &j| r[i][i].total_cmp(&r[j][j])).unwrap_or(0);
    let column = [0, 1, 2].map(|i| r[i][k] + f64::from(u8::from(i == k)));
    let length = column.iter().map(|part| part * part).sum::<f64>().sqrt();
    column.map(|part| part / length * angle)
}

/// Rotation by a half-angle vector `g`: `((1 - g.g) I + 2 g g^T + 2 [g]) / (1 + g.g)`, by rows. It is rational, and singular only at half a
/// turn (Rodrigues, 1840).
pub(crate) fn rodrigues<S: Number>(g: &Vector<S>) -> [Vector<S>; 3] {
    let [x, y, z] = &g.0;
    let (one, two) = (S::constant(1.0), S::constant(2.0));
    let squares = g.0.each_ref().map(|part| part.times(part));
    let sum = one.plus(&squares[0]).plus(&squares[1]).plus(&squares[2]);
    let diagonal = |i: usize| {
        let others = [(i + 1) % 3, (i + 2) % 3];
        one.plus(&squares[i]).minus(&squares[others[0]]).minus(&squares[others[1]]).over(&sum)
    };
    let beside = |a: &S, b: &S, c: &S| two.times(&a.times(b).plus(c)).over(&sum);
    [
        Vector([diagonal(0), beside(x, y, &z.negative()), beside(x, z, y)]),
        Vector([beside(x, y, z), diagonal(1), beside(y, z, &x.negative())]),
        Vector([beside(x, z, &y.negative()), beside(y, z, x), diagonal(2)]),
    ]
}

/// Pose of a part: its constant place at the start, then a rotation, then a displacement.
#[derive(Debug, Clone)]
pub(crate) struct Pose<S> {
    /// Rotation from the start, by rows; None for a part that does not turn.
    pub(crate) rotation: Option<[Vector<S>; 3]>,
    pub(crate) start: Rotation,
    pub(crate) translation: Vector<S>,
}

impl<S: Number> Pose<S> {
    /// Pose of a part that stands still.
    pub(crate) fn still(place: &Place) -> Self {
        Self { rotation: None, start: place.rotation, translation: Vector::constant(place.translation) }
    }

    /// A direction of the part in the assembly.
    fn direction(&self, vector: &Vector<S>) -> Vector<S> {
        let started = match self.start == STILL {
            true => vector.clone(),
            false => Vector(self.start.map(|row| Vector::constant(row).dot(vector))),
        };
        match &self.rotation {
            None => started,
            Some(rows) => Vector(rows.each_ref().map(|row| row.dot(&started))),
        }
    }

    /// A feature at its place in the assembly.
    pub(crate) fn placed(&self, feature: &LocalFeature<S>) -> PlacedFeature<S> {
        PlacedFeature {
            origin: self.translation.plus(&self.direction(&feature.origin)),
            axes: feature.axes.each_ref().map(|axis| self.direction(axis)),
            radius: feature.radius.clone(),
        }
    }
}

/// A feature in the frame of its part.
#[derive(Debug, Clone)]
pub(crate) struct LocalFeature<S> {
    origin: Vector<S>,
    axes: [Vector<S>; 3],
    radius: S,
}

/// A feature at its place in the assembly.
#[derive(Debug, Clone)]
pub(crate) struct PlacedFeature<S> {
    pub(crate) origin: Vector<S>,
    /// The directions x, y, z.
    pub(crate) axes: [Vector<S>; 3],
    pub(crate) radius: S,
}

impl<S: Number> LocalFeature<S> {
    /// Reads a feature. `number` makes a number of a quantity.
    pub(crate) fn new(feature: &Feature, number: &impl Fn(&Quantity) -> S) -> Self {
        let vector = |parts: &[Quantity; 3]| Vector(parts.each_ref().map(number));
        let direction = |direction: &Direction| match direction {
            Direction::Along(parts) => vector(parts).unit(),
            Direction::Turned { angle, about, from } => {
                let [about, from] = [about, from].map(|axis| Vector::<S>::constant(*axis).unit());
                let (sine, cosine) = (number(angle).sine(), number(angle).cosine());
                // Rodrigues' formula for a rotated vector.
                let along = about.dot(&from).times(&S::constant(1.0).minus(&cosine));
                from.scaled(&cosine).plus(&about.cross(&from).scaled(&sine)).plus(&about.scaled(&along))
            }
        };
        let z = direction(&feature.z);
        let wanted = match &feature.x {
            Some(x) => direction(x),
            None => Vector::constant(farthest_axis(z.values())),
        };
        let x = wanted.minus(&z.scaled(&wanted.dot(&z))).unit();
        let mut axes = [x.clone(), z.cross(&x), z];
        let mut origin = vector(&feature.origin);
        // The displacement is along the directions before the tilt.
        if let Some(shift) = &feature.shift {
            for (axis, part) in axes.iter().zip(shift) {
                origin = origin.plus(&axis.scaled(&number(part)));
            }
        }
        if let Some(tilt) = &feature.tilt {
            let half = vector(tilt).scaled(&S::constant(0.5));
            let rows = rodrigues(&half);
            let column = |j: usize| {
                let parts = [0, 1, 2].map(|i| axes[i].scaled(&rows[i].0[j]));
                parts[0].plus(&parts[1]).plus(&parts[2])
            };
            axes = [column(0), column(1), column(2)];
        }
        let radius = feature.diameter.as_ref().map_or(S::constant(0.0), number).times(&S::constant(0.5));
        Self { origin, axes, radius }
    }
}

/// The axis of the part that is farthest from a direction. The first one wins a tie.
fn farthest_axis(z: [f64; 3]) -> [f64; 3] {
    let mut best = 0;
    for axis in 1..3 {
        if z[axis].abs() < z[best].abs() - 1e-9 {
            best = axis;
        }
    }
    [0, 1, 2].map(|axis| f64::from(u8::from(axis == best)))
}
