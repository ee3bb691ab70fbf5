//! Features and joints to which the dimensions of an assembly in space belong.

use super::SpatialFacts;
use super::entry_uses::EntryUses;

/// Owner of a dimension in an assembly in space.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum DimensionOwner {
    /// A feature, by its index in the scene: the dimension is of its zone, or gives its place or size.
    Feature(usize),
    /// A joint, by its index: the dimension is of its float, or gives its length, gap or angle.
    Joint(usize),
    /// Several features, by their indices.
    Shared {
        /// Name of the dimension or pattern.
        name: String,
        /// Indices of the features in the scene.
        features: Vec<usize>,
    },
    /// Formulas alone.
    Formula,
}

impl SpatialFacts {
    /// Owner of a dimension of the problem. An entry that makes a dimension owns it. Other dimensions belong to the features that use them,
    /// or to the joint if no feature does.
    pub(super) fn owner(&self, dimension: &str) -> DimensionOwner {
        if let Some(found) = self.maker(dimension) {
            return found;
        }
        let users = |entries: &[EntryUses]| -> Vec<usize> {
            let uses =
                |entry: &EntryUses| entry.uses.iter().any(|name| self.leads_to(name, dimension, &mut Vec::new()));
            entries.iter().enumerate().filter(|(_, entry)| uses(entry)).map(|(index, _)| index).collect()
        };
        let features: Vec<usize> = (users(&self.written.features).into_iter())
            .filter_map(|index| self.feature_named(&self.written.features[index].name))
            .collect();
        match (&features[..], &users(&self.written.joints)[..]) {
            (&[only], _) => DimensionOwner::Feature(only),
            (&[], &[joint, ..]) => DimensionOwner::Joint(joint),
            (&[], &[]) => DimensionOwner::Formula,
            _ => DimensionOwner::Shared { name: dimension.to_owned(), features },
        }
    }

    /// True if a joint has made a dimension, such as the place of a pin in its hole.
    pub(crate) fn is_made_by_joint(&self, dimension: &str) -> bool {
        matches!(self.maker(dimension), Some(DimensionOwner::Joint(_)))
    }

    /// Entry of the assembly that has made a dimension, such as a zone or a float.
    fn maker(&self, dimension: &str) -> Option<DimensionOwner> {
        let is_of = |name: &str| {
            let rest = dimension.strip_prefix(name);
            rest.is_some_and(|rest| rest.is_empty() || rest.starts_with('_') || rest.starts_with('.'))
        };
        let made = self.makers.iter().filter(|(name, _)| is_of(name));
        let (_, key) = made.max_by_key(|(name, _)| name.len())?;
        // The key may have a comment behind it.
        let key = key.split(" (").next().unwrap_or(key);
        if let Some(joint) = key.strip_prefix("joints.") {
            let index = self.assembly.joints.iter().position(|of| of.name == joint)?;
            return Some(DimensionOwner::Joint(index));
        }
        let name = key.strip_prefix("parts.")?;
        if let Some((_, of)) = self.written.patterns.iter().find(|(pattern, _)| pattern == name) {
            let features = of.iter().filter_map(|feature| self.feature_named(feature)).collect();
            return Some(DimensionOwner::Shared { name: name.replace(".patterns.", "."), features });
        }
        self.feature_named(name).map(DimensionOwner::Feature)
    }

    /// True if a name is the dimension, or a formula that uses it.
    fn leads_to(&self, name: &str, dimension: &str, seen: &mut Vec<String>) -> bool {
        if name == dimension {
            return true;
        }
        if seen.iter().any(|other| other == name) {
            return false;
        }
        seen.push(name.to_owned());
        let uses = self.formulas.get(name);
        uses.is_some_and(|uses| uses.iter().any(|other| self.leads_to(other, dimension, seen)))
    }

    /// Measures of a characteristic: its own, or those that its formula uses.
    pub(super) fn measures_of(&self, characteristic: &str) -> Vec<usize> {
        let measures = &self.assembly.measures;
        if let Some(own) = measures.iter().position(|measure| measure.name == characteristic) {
            return vec![own];
        }
        let used = |name: &str| self.leads_to(characteristic, name, &mut Vec::new());
        (0..measures.len()).filter(|&index| used(&measures[index].name)).collect()
    }
}
