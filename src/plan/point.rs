//! A point by name: the means, but for a few dimensions that stand at one of their nodes.

use std::sync::Arc;

/// One dimension at one of its nodes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct AtNode {
    /// Index of the dimension in the problem.
    pub dimension: u32,
    /// Index of the node in the dimension's axis.
    pub node: u32,
}

/// A point of the plan: every dimension at its mean but those named, each named once, ascending.
///
/// The usual kinds take no memory of their own: a full stencil of a thousand dimensions has a million points.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub enum Point {
    /// All at their means.
    Centre,
    /// One dimension elsewhere.
    One([AtNode; 1]),
    /// Two dimensions elsewhere.
    Two([AtNode; 2]),
    /// Three or more dimensions elsewhere. Copies share them: a point stands in a plan, a stage and among the answers.
    Many(Arc<[AtNode]>),
}

impl Point {
    /// With these dimensions elsewhere, in any order, each once.
    pub(crate) fn of(at: &[AtNode]) -> Self {
        match *at {
            [] => Self::Centre,
            [one] => Self::One([one]),
            [one, two] if one < two => Self::Two([one, two]),
            [one, two] => Self::Two([two, one]),
            _ => Self::many(at),
        }
    }

    // Apart, so that the usual kinds are made where they are wanted.
    #[cold]
    fn many(at: &[AtNode]) -> Self {
        if at.is_sorted() {
            return Self::Many(at.into());
        }
        let mut at = at.to_vec();
        at.sort_unstable();
        Self::Many(at.into())
    }

    /// The dimensions that are elsewhere.
    pub fn at(&self) -> &[AtNode] {
        match self {
            Self::Centre => &[],
            Self::One(at) => at,
            Self::Two(at) => at,
            Self::Many(at) => at,
        }
    }

    /// A hash: no pattern of places is left in any bit.
    pub(crate) fn mixed(&self) -> u64 {
        self.at().iter().fold(1 << 63, |hash, at| folded(hash ^ u64::from(at.dimension) << 32 ^ u64::from(at.node)))
    }
}

/// Both halves of a product of 128 bits.
pub(super) fn folded(word: u64) -> u64 {
    let product = u128::from(word) * 0x9e37_79b9_7f4a_7c15;
    product as u64 ^ (product >> 64) as u64
}

impl std::hash::Hash for Point {
    /// One word for the hasher: sets of a million points are made of it.
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
