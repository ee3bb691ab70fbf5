//! Poses of parts: rotation vectors and places of their origins.

use crate::closure::constant_rotation;
use crate::placement::{product, rodrigues, rotation_vector};
use crate::vector::Vector;

/// Pose of a part: a rotation, then a displacement of its origin.
#[derive(Debug, Clone, PartialEq)]
pub struct PartPose {
    /// Name of the part.
    pub part: String,
    /// Rotation vector in radians.
    pub rotation: [f64; 3],
    /// Place of the part's origin.
    pub translation: [f64; 3],
    /// Rotation vector from which the unknowns of the part start. None if the part stands still and has no unknowns.
    pub start: Option<[f64; 3]>,
}

impl PartPose {
    /// Names of the six unknowns of the part: a half-angle vector and the place of the origin. Returns None if the part stands still.
    pub fn unknowns(&self) -> Option<[String; 6]> {
        self.start?;
        Some(["rx", "ry", "rz", "x", "y", "z"].map(|letters| format!("{}.{letters}", self.part)))
    }

    /// Directions x, y, z of the part in the assembly.
    pub fn axes(&self) -> [[f64; 3]; 3] {
        let rows = constant_rotation(self.rotation);
        [0, 1, 2].map(|axis| rows.map(|row| row[axis]))
    }

    /// Pose of the part at other values of its unknowns.
    ///
    /// ```
    /// use sensitol_spatial::PartPose;
    /// let pose = PartPose { part: "arm".into(), rotation: [0.0; 3], translation: [0.0; 3], start: Some([0.0; 3]) };
    /// // The tangent of half of 60 degrees, about z.
    /// let moved = pose.at([0.0, 0.0, (1.0f64 / 3.0).sqrt(), 5.0, 0.0, 0.0]);
    /// assert!((moved.rotation[2].to_degrees() - 60.0).abs() < 1e-12);
    /// assert_eq!(moved.translation, [5.0, 0.0, 0.0]);
    /// ```
    pub fn at(&self, unknowns: [f64; 6]) -> Self {
        let Some(start) = self.start else { return self.clone() };
        let [rx, ry, rz, x, y, z] = unknowns;
        let turn = rodrigues::<crate::dual::Dual>(&Vector::constant([rx, ry, rz])).map(|row| row.values());
        let rotation = rotation_vector(&product(&turn, &constant_rotation(start)));
        Self { rotation, translation: [x, y, z], ..self.clone() }
    }
}
