//! Places of features in the assembly at given poses of the parts.

use crate::assembly::{Assembly, Quantity};
use crate::closure::constant_rotation;
use crate::dual::Dual;
use crate::number::Number;
use crate::part_pose::PartPose;
use crate::placement::{LocalFeature, Place, Pose};

/// Place of a feature in the assembly.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FeaturePlace {
    /// Origin of the feature.
    pub origin: [f64; 3],
    /// Directions x, y, z of the feature; z is the normal or axis.
    pub axes: [[f64; 3]; 3],
    /// Radius of a hole, pin or ball; 0 for a feature without diameter.
    pub radius: f64,
}

impl Assembly {
    /// Places of all features by parts, at the values of the quantities and at given poses, one of each part in their order.
    ///
    /// # Cost
    /// About 200 operations a feature.
    ///
    /// # Example
    /// ```
    /// use sensitol_spatial::{Assembly, Direction, Feature, FeatureKind, PartPose, Quantity, RigidPart};
    /// let tip = Feature {
    ///     name: "tip".into(),
    ///     kind: FeatureKind::Point,
    ///     origin: [10.0, 0.0, 0.0].map(Quantity::constant),
    ///     z: Direction::Along([0.0, 0.0, 1.0].map(Quantity::constant)),
    ///     x: None,
    ///     diameter: None,
    ///     shift: None,
    ///     tilt: None,
    /// };
    /// let arm = RigidPart { name: "arm".into(), ground: false, at: [0.0; 3], turned: [0.0; 3], features: vec![tip] };
    /// let assembly = Assembly { parts: vec![arm], joints: Vec::new(), measures: Vec::new(), length_unit: None, shown_unit: None };
    /// // A quarter turn about z, and 5 along x.
    /// let turn = [0.0, 0.0, std::f64::consts::FRAC_PI_2];
    /// let pose = PartPose { part: "arm".into(), rotation: turn, translation: [5.0, 0.0, 0.0], start: None };
    /// let place = assembly.places(&[pose])[0][0];
    /// assert!((place.origin[0] - 5.0).abs() < 1e-12 && (place.origin[1] - 10.0).abs() < 1e-12);
    /// ```
    pub fn places(&self, poses: &[PartPose]) -> Vec<Vec<FeaturePlace>> {
        let number = |quantity: &Quantity| Dual::constant(quantity.value);
        let mut places = Vec::with_capacity(self.parts.len());
        for (part, pose) in self.parts.iter().zip(poses) {
            let pose: Pose<Dual> =
                Pose::still(&Place { rotation: constant_rotation(pose.rotation), translation: pose.translation });
            let mut of_part = Vec::with_capacity(part.features.len());
            for feature in &part.features {
                let placed = pose.placed(&LocalFeature::new(feature, &number));
                of_part.push(FeaturePlace {
                    origin: placed.origin.values(),
                    axes: placed.axes.each_ref().map(|axis| axis.values()),
                    radius: placed.radius.value(),
                });
            }
            places.push(of_part);
        }
        places
    }
}
