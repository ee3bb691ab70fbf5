//! Point by name: all dimensions at their means, except a few at one of their nodes.

use std::sync::Arc;

/// Dimension at one of its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AtNode {
    /// Index of the dimension in the problem.
    pub dimension: u32,
    /// Index of the node in the dimension's axis.
    pub node: u32,
}

/// Point of a plan: every dimension is at its mean, except those named, each once and ascending.
///
/// The usual kinds allocate no memory: a full stencil of a thousand dimensions has a million points.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Point {
    /// Every dimension at its mean.
    Centre,
    /// One dimension at a node.
    One([AtNode; 1]),
    /// Two dimensions at nodes.
    Two([AtNode; 2]),
    /// Three or more dimensions at nodes. Copies in the plan, the stage and the answers share them.
    Many(Arc<[AtNode]>),
}

impl Point {
    /// Point with these dimensions at nodes, in any order, each once.
    pub(crate) fn of(at: &[AtNode]) -> Self {
        match *at {
            [] => Self::Centre,
            [one] => Self::One([one]),
            [one, two] if one < two => Self::Two([one, two]),
            [one, two] => Self::Two([two, one]),
            _ => Self::many(at),
        }
    }

    // Separate and cold, so that the usual kinds are inlined.
    #[cold]
    fn many(at: &[AtNode]) -> Self {
        if at.is_sorted() {
            return Self::Many(at.into());
        }
        let mut at = at.to_vec();
        at.sort_unstable();
        Self::Many(at.into())
    }

    /// Dimensions that are at nodes.
    pub fn at(&self) -> &[AtNode] {
        match self {
            Self::Centre => &[],
            Self::One(at) => at,
            Self::Two(at) => at,
            Self::Many(at) => at,
        }
    }

    /// Hash of the point. Its bits show no pattern of the nodes.
    pub(crate) fn mixed(&self) -> u64 {
        self.at().iter().fold(1 << 63, |hash, at| folded(hash ^ u64::from(at.dimension) << 32 ^ u64::from(at.node)))
    }
}

/// Exclusive or of both halves of a 128-bit product, as a hash.
pub(super) fn folded(word: u64) -> u64 {
    let product = u128::from(word) * 0x9e37_79b9_7f4a_7c15;
    product as u64 ^ (product >> 64) as u64
}

impl std::hash::Hash for Point {
    /// Writes one word only, since sets hold a million points.
    fn hash<H: std::hash::Hasher>(&self, state: &mut H) {
        state.write_u64(self.mixed());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_order_of_the_dimensions_does_not_matter() {
        let at = |dimension, node| AtNode { dimension, node };
        assert_eq!(Point::of(&[at(4, 0), at(2, 1)]), Point::of(&[at(2, 1), at(4, 0)]));
    }
}
