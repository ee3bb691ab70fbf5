//! Facts about an assembly in space that its plain lines do not hold.

use std::collections::BTreeMap;

use super::entry_uses::{AssemblyUses, OpenZone};
use sensitol_spatial::{Assembly, Direction, Feature, FeatureId, Mobility, PartPose, Quantity};

/// Extent of a feature over which its zones hold.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum ExtentQuantity<T> {
    Unknown,
    Length(T),
    /// Components along x and y of the feature.
    Rectangle([T; 2]),
    /// Diameter of a round face.
    Round(T),
}

impl<T> ExtentQuantity<T> {
    /// All numbers of an extent.
    pub(crate) fn all(&mut self) -> &mut [T] {
        match self {
            Self::Unknown => &mut [],
            Self::Length(one) | Self::Round(one) => std::slice::from_mut(one),
            Self::Rectangle(size) => size,
        }
    }
}

/// Facts about an assembly in space that its plain lines do not hold.
#[derive(Debug, Clone)]
pub(crate) struct SpatialFacts {
    /// Parts, joints and measures, with lengths in `length_unit`.
    pub(crate) assembly: Assembly,
    /// Extents of the features of all parts.
    pub(crate) extents: Vec<ExtentQuantity<Quantity>>,
    /// Freedoms that each joint takes, in words.
    pub(crate) freedoms: Vec<Vec<String>>,
    pub(crate) mobility: Mobility,
    pub(crate) poses: Vec<PartPose>,
    /// Unit of lengths; None if the study names none.
    pub(crate) length_unit: Option<String>,
    /// True if formulas convert units.
    pub(crate) converts: bool,
    /// Features and joints as written.
    pub(crate) written: AssemblyUses,
    /// Zones whose datums leave something free that they bound.
    pub(crate) open_zones: Vec<OpenZone>,
    /// Dimensions without a tolerance to which a general one would apply, with half of it.
    pub(crate) general: Vec<(String, f64)>,
    /// Names of dimensions that entries of the assembly have made, each with the key of its entry.
    pub(crate) makers: Vec<(String, String)>,
    /// Formulas and characteristics by name, with the names that they use.
    pub(crate) formulas: BTreeMap<String, Vec<String>>,
}

/// Quantity that a number of a feature measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum NumberKind {
    Length,
    /// An angle in radians.
    Angle,
    Plain,
}

impl SpatialFacts {
    /// Index of a feature in the scene.
    pub(super) fn index(&self, id: FeatureId) -> usize {
        self.assembly.parts[..id.part].iter().map(|part| part.features.len()).sum::<usize>() + id.feature
    }

    /// Index of a feature in the scene by its full name.
    pub(super) fn feature_named(&self, name: &str) -> Option<usize> {
        let mut names = self
            .assembly
            .parts
            .iter()
            .flat_map(|part| part.features.iter().map(|of| format!("{}.{}", part.name, of.name)));
        names.position(|other| other == name)
    }

    /// Extent of a feature at its nominal value.
    pub(super) fn extent(&self, feature: usize) -> ExtentQuantity<f64> {
        match self.extents.get(feature) {
            None | Some(ExtentQuantity::Unknown) => ExtentQuantity::Unknown,
            Some(ExtentQuantity::Length(length)) => ExtentQuantity::Length(length.value),
            Some(ExtentQuantity::Rectangle(size)) => ExtentQuantity::Rectangle(size.each_ref().map(|one| one.value)),
            Some(ExtentQuantity::Round(diameter)) => ExtentQuantity::Round(diameter.value),
        }
    }
}

/// Numbers of a feature, each with the quantity that it measures.
pub(super) fn numbers(feature: &mut Feature) -> Vec<(&mut Quantity, NumberKind)> {
    fn of_direction(direction: &mut Direction) -> Vec<(&mut Quantity, NumberKind)> {
        match direction {
            Direction::Along(parts) => parts.iter_mut().map(|part| (part, NumberKind::Plain)).collect(),
            Direction::Turned { angle, .. } => vec![(angle, NumberKind::Angle)],
        }
    }
    let lengths = feature.origin.iter_mut().chain(&mut feature.diameter).chain(feature.shift.iter_mut().flatten());
    let mut all: Vec<(&mut Quantity, NumberKind)> = lengths.map(|one| (one, NumberKind::Length)).collect();
    all.extend(of_direction(&mut feature.z));
    all.extend(feature.x.iter_mut().flat_map(of_direction));
    all.extend(feature.tilt.iter_mut().flatten().map(|one| (one, NumberKind::Plain)));
    all
}

/// Divides all lengths of an assembly by a factor.
pub(crate) fn in_unit(mut assembly: Assembly, factor: f64) -> Assembly {
    for feature in assembly.parts.iter_mut().flat_map(|part| &mut part.features) {
        for (number, kind) in numbers(feature) {
            if kind == NumberKind::Length {
                number.value /= factor;
            }
        }
    }
    assembly
}
