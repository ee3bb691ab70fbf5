//! Influence of features on measures: whether a small displacement or tilt of a feature changes one.

use crate::assembly::{Assembly, FeatureId, FeatureKind, Quantity};
use crate::closure::Closure;
use crate::dual::Dual;
use crate::number::Number;
use crate::placement::{LocalFeature, Pose};

/// Displacement over the size of the assembly, and rotation in radians, of a feature that is tried. The square is far below `FELT`.
const TRIED: f64 = 1e-6;
/// Change of a measure over the change of a feature that counts. Rounding of a closed state is a millionth of it.
const FELT: f64 = 1e-4;

impl Assembly {
    /// True for each feature of each part if some measure depends on its place or direction, through the joints or directly. Returns None if
    /// the joints do not close.
    ///
    /// # Cost
    /// Closes the joints six times for each feature, from the nominal state.
    pub fn influences(&self) -> Option<Vec<Vec<bool>>> {
        let mut closure = Closure::new(self);
        if !closure.close() {
            return None;
        }
        let nominal = measured(self, &closure);
        let mut found = Vec::with_capacity(self.parts.len());
        for (part, of) in self.parts.iter().enumerate() {
            let features = 0..of.features.len();
            found.push(features.map(|feature| self.is_felt(&closure, &nominal, FeatureId { part, feature })).collect());
        }
        Some(found)
    }

    /// True if a displacement or tilt of a feature changes a measure.
    fn is_felt(&self, closure: &Closure<'_>, nominal: &[Vec<f64>], id: FeatureId) -> bool {
        let in_joint = self.joints.iter().any(|joint| joint.features().any(|other| other == id));
        if !in_joint && !self.measures.iter().any(|measure| measure.between.contains(&id)) {
            return false;
        }
        // A point has no direction.
        let freedoms = if self.feature(id).kind == FeatureKind::Point { 3 } else { 6 };
        (0..freedoms).any(|freedom| {
            let mut moved = self.clone();
            let feature = &mut moved.parts[id.part].features[id.feature];
            let (of, by) = match freedom < 3 {
                true => (&mut feature.shift, TRIED * closure.size),
                false => (&mut feature.tilt, TRIED),
            };
            let numbers = of.get_or_insert_with(|| [0.0; 3].map(Quantity::constant));
            numbers[freedom % 3].value += by;
            let mut other = Closure {
                assembly: &moved,
                moving: closure.moving.clone(),
                places: closure.places.clone(),
                used: closure.used.clone(),
                size: closure.size,
            };
            // A point at which the joints do not close is felt.
            if !other.search() {
                return true;
            }
            let changed = measured(&moved, &other);
            let pairs = nominal.iter().flatten().zip(changed.iter().flatten());
            pairs.into_iter().any(|(a, b)| (a - b).abs() > FELT * TRIED)
        })
    }
}

/// Smooth numbers of all measures at the present poses: directions as they are, lengths in units of the size.
fn measured(assembly: &Assembly, closure: &Closure<'_>) -> Vec<Vec<f64>> {
    let number = |quantity: &Quantity| Dual::constant(quantity.value);
    let mut found = Vec::with_capacity(assembly.measures.len());
    for measure in &assembly.measures {
        let kinds = measure.between.map(|id| assembly.feature(id).kind);
        let [of, from] = measure.between.map(|id| {
            let pose: Pose<Dual> = Pose::still(&closure.places[id.part]);
            pose.placed(&LocalFeature::new(assembly.feature(id), &number))
        });
        let smooth = crate::measure::measured(&measure.kind, kinds, [&of, &from], (&number, &Dual::constant)).smooth;
        let unit = if measure.kind == crate::assembly::MeasureKind::Angle { 1.0 } else { closure.size };
        found.push(smooth.iter().map(|number| number.value() / unit).collect());
    }
    found
}
