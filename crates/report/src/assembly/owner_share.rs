//! Contributions to the variance by features and joints: the sum over the dimensions that belong to each.

use std::collections::HashMap;

use super::ReportedAssembly;
use crate::analysis::statistics::CharacteristicStatistics;
use sensitol::analysis::CharacteristicAnalysis;
use sensitol_study::{AssemblyScene, DimensionOwner, FeatureOutline};

/// Bearer of a contribution in an assembly in space.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum ShareOwner {
    /// A feature, by its index in the scene.
    Feature(usize),
    /// A joint, by its index.
    Joint(usize),
    /// Features that share a dimension or a pattern.
    Shared(Vec<usize>),
    /// Formulas alone.
    Formula,
}

/// Contribution of a feature, a joint or a shared dimension.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct OwnerShare {
    pub(crate) name: String,
    pub(crate) owner: ShareOwner,
    /// Part of the variance. Half of each interaction counts for each of its two dimensions.
    pub(crate) value: f64,
    /// Contributions of the dimensions, the strongest first.
    pub(crate) components: Vec<(String, f64)>,
}

impl OwnerShare {
    /// Kind of the bearer, in words.
    pub(crate) fn kind(&self, scene: &AssemblyScene) -> String {
        match &self.owner {
            ShareOwner::Feature(index) => match scene.features[*index].outline {
                FeatureOutline::Rectangle(_) | FeatureOutline::Disc(_) => "plane".to_owned(),
                FeatureOutline::Cylinder { .. } => "axis".to_owned(),
                FeatureOutline::Ball(_) => "point".to_owned(),
                FeatureOutline::Triad => "frame".to_owned(),
            },
            ShareOwner::Joint(index) => format!("joint, {}", scene.joints[*index].kind),
            ShareOwner::Shared(features) => {
                let names: Vec<&str> = features.iter().map(|&feature| scene.features[feature].name.as_str()).collect();
                format!("of {}", names.join(", "))
            }
            ShareOwner::Formula => "in formulas".to_owned(),
        }
    }
}

/// Contributions by owner, the strongest first. Returns None if no contribution is known.
pub(crate) fn owner_shares(assembly: &ReportedAssembly, one: &CharacteristicAnalysis) -> Option<Vec<OwnerShare>> {
    let scene = &assembly.scene;
    let mut shares: Vec<OwnerShare> = Vec::new();
    let mut known = false;
    let interactions = interactions(one);
    for (row, owner) in one.sensitivities.iter().zip(&scene.owners) {
        let own = match row.first_order {
            Some(index) => Some(index.value),
            None => row.linear_share.map(|linear| linear + row.curvature_share.unwrap_or(0.0)),
        };
        known |= own.is_some();
        let value = own.unwrap_or(0.0) + interactions.get(&*row.dimension).copied().unwrap_or(0.0);
        let (name, bearer) = match owner {
            DimensionOwner::Feature(index) => (scene.features[*index].name.clone(), ShareOwner::Feature(*index)),
            DimensionOwner::Joint(index) => (scene.joints[*index].name.clone(), ShareOwner::Joint(*index)),
            DimensionOwner::Shared { name, features } => (name.clone(), ShareOwner::Shared(features.clone())),
            DimensionOwner::Formula => (row.dimension.clone(), ShareOwner::Formula),
        };
        let component = (row.dimension.clone(), value);
        match shares.iter_mut().find(|share| share.owner == bearer && share.name == name) {
            Some(share) => {
                share.value += value;
                share.components.push(component);
            }
            None => shares.push(OwnerShare { name, owner: bearer, value, components: vec![component] }),
        }
    }
    shares.iter_mut().for_each(|share| share.components.sort_by(|a, b| b.1.total_cmp(&a.1)));
    shares.sort_by(|a, b| b.value.total_cmp(&a.value));
    known.then_some(shares)
}

/// Half of the interactions of every dimension, in one pass over the list.
fn interactions(one: &CharacteristicAnalysis) -> HashMap<String, f64> {
    let mut halves = HashMap::new();
    if one.is_of_model() {
        return halves;
    }
    for pair in one.contributions.interactions.iter() {
        for name in pair.dimensions {
            *halves.entry(name.to_string()).or_insert(0.0) += 0.5 * pair.share.unwrap_or(0.0);
        }
    }
    halves
}
