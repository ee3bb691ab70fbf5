//! Placements: a place and a rotation.

use crate::part21::{EntityTable, Part21Error, StepValue};

/// A rotation and a place: a point `p` of a part is at `rotation p + place`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Rows of the rotation matrix.
    pub rotation: [[f64; 3]; 3],
    /// Place of the origin.
    pub place: [f64; 3],
}

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn minus(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a + factor b`.
pub(crate) fn plus(a: [f64; 3], factor: f64, b: [f64; 3]) -> [f64; 3] {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

/// Unit vector. Returns None for a vector without a direction.
pub(crate) fn unit(a: [f64; 3]) -> Option<[f64; 3]> {
    let length = dot(a, a).sqrt();
    (length.is_finite() && length > 1e-12).then(|| a.map(|part| part / length))
}

impl Placement {
    /// Placement that moves nothing.
    pub const IDENTITY: Self = Self { rotation: [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]], place: [0.0; 3] };

    /// Direction of a part after the rotation.
    pub fn direction(&self, v: [f64; 3]) -> [f64; 3] {
        self.rotation.map(|row| dot(row, v))
    }

    /// Point of a part at its place.
    pub fn point(&self, p: [f64; 3]) -> [f64; 3] {
        plus(self.direction(p), 1.0, self.place)
    }

    /// Placement of `inner` within this one.
    pub fn of(&self, inner: &Self) -> Self {
        let columns = [0, 1, 2].map(|column| self.direction(inner.rotation.map(|row| row[column])));
        let rotation = [0, 1, 2].map(|row| [0, 1, 2].map(|column: usize| columns[column][row]));
        Self { rotation, place: self.point(inner.place) }
    }

    /// Placement that undoes this one.
    pub fn inverse(&self) -> Self {
        let rotation = [0, 1, 2].map(|row: usize| self.rotation.map(|of| of[row]));
        let turned = Self { rotation, place: [0.0; 3] };
        Self { rotation, place: turned.direction(self.place).map(|part| -part) }
    }

    /// Rotation vector in radians.
    ///
    /// # Source
    /// Quaternion of a rotation matrix by its largest component (Shepperd, 1978).
    pub fn rotation_vector(&self) -> [f64; 3] {
        let r = &self.rotation;
        let trace = r[0][0] + r[1][1] + r[2][2];
        let candidates = [trace, r[0][0], r[1][1], r[2][2]];
        let largest = (0..4).fold(0, |best, at| if candidates[at] > candidates[best] { at } else { best });
        let off = [r[2][1] - r[1][2], r[0][2] - r[2][0], r[1][0] - r[0][1]];
        let (mut w, mut v) = (off, [0.0; 3]);
        let scalar;
        if largest == 0 {
            scalar = 1.0 + trace;
            v = w;
        } else {
            let i = largest - 1;
            scalar = off[i];
            for (j, part) in v.iter_mut().enumerate() {
                *part = if i == j { 1.0 + 2.0 * r[i][i] - trace } else { r[i][j] + r[j][i] };
            }
        }
        let length = dot(v, v).sqrt();
        if length < 1e-15 {
            return [0.0; 3];
        }
        let angle = 2.0 * length.atan2(scalar);
        // The shorter way around.
        let angle = if angle > std::f64::consts::PI { angle - 2.0 * std::f64::consts::PI } else { angle };
        w = v.map(|part| part / length * angle);
        w
    }
}

/// Coordinates of a CARTESIAN_POINT or DIRECTION. Returns None if they are not three numbers.
pub(super) fn triple(table: &EntityTable<'_>, from: u64, to: u64) -> Result<Option<[f64; 3]>, Part21Error> {
    let entity = table.referred(from, to)?;
    if !entity.is("CARTESIAN_POINT") && !entity.is("DIRECTION") {
        return Ok(None);
    }
    let arguments = entity.all()?.swap_remove(0).1;
    let numbers: Vec<f64> =
        arguments.last().map_or(&[][..], StepValue::items).iter().filter_map(StepValue::number).collect();
    Ok(numbers.try_into().ok())
}

/// Reads an AXIS2_PLACEMENT_3D. Returns None for other entities and for one whose directions are parallel.
pub(super) fn placement(table: &EntityTable<'_>, from: u64, to: u64) -> Result<Option<Placement>, Part21Error> {
    let entity = table.referred(from, to)?;
    let Some(arguments) = entity.arguments("AXIS2_PLACEMENT_3D")? else { return Ok(None) };
    let part = |index: usize| arguments.get(index).and_then(StepValue::reference);
    let Some(place) = part(1) else { return Ok(None) };
    let Some(place) = triple(table, to, place)? else { return Ok(None) };
    let z = match part(2) {
        Some(z) => triple(table, to, z)?.and_then(unit),
        None => Some([0.0, 0.0, 1.0]),
    };
    let Some(z) = z else { return Ok(None) };
    let reference = match part(3) {
        Some(x) => triple(table, to, x)?,
        // Without a reference the first axis is used, or the second one if z lies along it (ISO 10303-42, first_proj_axis).
        None if z[0].abs() < 1.0 - 1e-9 => Some([1.0, 0.0, 0.0]),
        None => Some([0.0, 1.0, 0.0]),
    };
    let Some(x) = reference.and_then(|x| unit(plus(x, -dot(x, z), z))) else { return Ok(None) };
    let y = cross(z, x);
    Ok(Some(Placement { rotation: [0, 1, 2].map(|row: usize| [x[row], y[row], z[row]]), place }))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rotation_vectors_give_their_rotation_back() {
        // Rodrigues' formula is the other way round.
        for vector in [[0.3, -1.2, 0.4], [0.0, 0.0, 3.1], [2.0, 2.0, 0.5], [0.0; 3], [1e-9, 0.0, 0.0]] {
            let angle = dot(vector, vector).sqrt();
            let axis = unit(vector).unwrap_or([1.0, 0.0, 0.0]);
            let column = |v: [f64; 3]| {
                let along = dot(axis, v) * (1.0 - angle.cos());
                plus(plus(v.map(|part| part * angle.cos()), angle.sin(), cross(axis, v)), along, axis)
            };
            let columns = [column([1.0, 0.0, 0.0]), column([0.0, 1.0, 0.0]), column([0.0, 0.0, 1.0])];
            let rotation = [0, 1, 2].map(|row: usize| [columns[0][row], columns[1][row], columns[2][row]]);
            let found = Placement { rotation, place: [0.0; 3] }.rotation_vector();
            for (found, expected) in found.iter().zip(vector) {
                // Rounding of a matrix near half a turn is amplified to some 1e-15.
                assert!((found - expected).abs() < 1e-12, "{vector:?}: {found:?}");
            }
        }
    }

    #[test]
    fn inverses_undo() {
        let turned =
            Placement { rotation: [[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]], place: [1.0, 2.0, 3.0] };
        assert_eq!(turned.of(&turned.inverse()), Placement::IDENTITY);
        assert_eq!(turned.point([1.0, 0.0, 0.0]), [1.0, 3.0, 3.0]);
    }
}
