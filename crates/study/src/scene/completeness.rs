//! Completeness of an assembly in space: tolerances and datums that its drawings leave out.

use super::{DimensionOwner, SpatialFacts};
use crate::Study;

/// Statement that the drawings of an assembly leave out.
#[derive(Debug, Clone, PartialEq)]
pub enum CompletenessGap {
    /// Measures depend on a feature that carries no tolerance.
    FeatureWithoutTolerance {
        /// Full name of the feature.
        feature: String,
    },
    /// The datums of a zone leave free a displacement or a tilt that the zone bounds.
    OpenDatums {
        /// Full name of the feature.
        feature: String,
        /// Key of the zone.
        zone: &'static str,
        /// Datums in their order.
        datums: Vec<String>,
        /// Freedoms that are left, in words.
        open: Vec<String>,
    },
    /// A dimension has no tolerance, and a general tolerance would apply.
    GeneralTolerance {
        /// Name of the dimension.
        dimension: String,
        /// Half tolerance by ISO 2768-m.
        half: f64,
        /// Unit of the dimension.
        unit: Option<String>,
    },
}

impl Study {
    /// Gaps of the drawings of an assembly in space. Returns an empty list if the study has none.
    ///
    /// A feature on a part that stands still, from which measures are taken and which no joint uses, is a reference and needs no tolerance.
    ///
    /// # Cost
    /// Closes the joints six times for each feature.
    pub fn completeness(&self) -> Vec<CompletenessGap> {
        let Some(facts) = &self.spatial else { return Vec::new() };
        let mut gaps = self.features_without_tolerance(facts);
        for zone in &facts.open_zones {
            gaps.push(CompletenessGap::OpenDatums {
                feature: zone.feature.clone(),
                zone: zone.zone,
                datums: zone.datums.clone(),
                open: zone.open.clone(),
            });
        }
        for (dimension, half) in &facts.general {
            let found = self.problem.dimensions().iter().find(|one| one.name() == dimension);
            let unit = found.and_then(|one| one.unit()).map(str::to_owned);
            gaps.push(CompletenessGap::GeneralTolerance { dimension: dimension.clone(), half: *half, unit });
        }
        gaps
    }

    fn features_without_tolerance(&self, facts: &SpatialFacts) -> Vec<CompletenessGap> {
        let Some(influences) = facts.assembly.influences() else { return Vec::new() };
        let mut toleranced = vec![false; facts.extents.len()];
        for dimension in self.problem.dimensions().iter().filter(|dimension| dimension.sigma() > 0.0) {
            match facts.owner(dimension.name()) {
                DimensionOwner::Feature(index) => toleranced[index] = true,
                DimensionOwner::Shared { features, .. } => features.iter().for_each(|&index| toleranced[index] = true),
                DimensionOwner::Joint(_) | DimensionOwner::Formula => {}
            }
        }
        let mut gaps = Vec::new();
        for (part, of) in facts.assembly.parts.iter().enumerate() {
            for (feature, own) in of.features.iter().enumerate() {
                let id = sensitol_spatial::FeatureId { part, feature };
                let in_joint = facts.assembly.joints.iter().any(|joint| joint.features().any(|other| other == id));
                let is_reference = of.ground && !in_joint;
                if influences[part][feature] && !toleranced[facts.index(id)] && !is_reference {
                    let feature = format!("{}.{}", of.name, own.name);
                    gaps.push(CompletenessGap::FeatureWithoutTolerance { feature });
                }
            }
        }
        gaps
    }
}
