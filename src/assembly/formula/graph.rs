//! Graph of all formulas, in which nothing is computed twice.

use std::collections::HashMap;

use crate::assembly::formula::functions::{Binary, Unary};

/// Index of a node. Operands have smaller indices than the operations that use them.
pub(super) type NodeId = u32;

#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum GraphNode {
    /// Constant, by the bits of its value.
    Constant(u64),
    /// Column that the formulas receive.
    Variable(usize),
    Unary(Unary, NodeId),
    Binary(Binary, NodeId, NodeId),
    If(NodeId, NodeId, NodeId),
}

impl GraphNode {
    pub(super) fn operands(self) -> impl Iterator<Item = NodeId> {
        let operands = match self {
            Self::Constant(_) | Self::Variable(_) => [None; 3],
            Self::Unary(_, a) => [Some(a), None, None],
            Self::Binary(_, a, b) => [Some(a), Some(b), None],
            Self::If(a, b, c) => [Some(a), Some(b), Some(c)],
        };
        operands.into_iter().flatten()
    }
}

/// Graph of operations. Equal operations share a node. Parts without variables are evaluated when they are added, so that a branch of an
/// `if` that can never be taken does not exist.
#[derive(Debug, Clone, Default)]
pub(super) struct Graph {
    nodes: Vec<GraphNode>,
    index: HashMap<GraphNode, NodeId>,
}

impl Graph {
    pub(super) fn nodes(&self) -> &[GraphNode] {
        &self.nodes
    }

    fn add(&mut self, node: GraphNode) -> NodeId {
        *self.index.entry(node).or_insert_with(|| {
            self.nodes.push(node);
            NodeId::try_from(self.nodes.len() - 1).expect("fewer than four billion operations")
        })
    }

    pub(super) fn constant_value(&self, node: NodeId) -> Option<f64> {
        match self.nodes[node as usize] {
            GraphNode::Constant(bits) => Some(f64::from_bits(bits)),
            _ => None,
        }
    }

    pub(super) fn constant(&mut self, value: f64) -> NodeId {
        self.add(GraphNode::Constant(value.to_bits()))
    }

    pub(super) fn variable(&mut self, index: usize) -> NodeId {
        self.add(GraphNode::Variable(index))
    }

    pub(super) fn unary(&mut self, function: Unary, a: NodeId) -> NodeId {
        match self.constant_value(a) {
            Some(a) => self.constant(function.apply(a)),
            None => self.add(GraphNode::Unary(function, a)),
        }
    }

    pub(super) fn binary(&mut self, function: Binary, a: NodeId, b: NodeId) -> NodeId {
        match (self.constant_value(a), self.constant_value(b)) {
            (Some(a), Some(b)) => self.constant(function.apply(a, b)),
            (None, Some(exponent)) if function == Binary::Power => self.power(a, exponent),
            _ => self.add(GraphNode::Binary(function, a, b)),
        }
    }

    /// Replaces small whole powers by products, which are faster and at least as exact as the general power.
    fn power(&mut self, base: NodeId, exponent: f64) -> NodeId {
        let product = |graph: &mut Self, a, b| graph.add(GraphNode::Binary(Binary::Multiply, a, b));
        match exponent {
            1.0 => base,
            2.0 => product(self, base, base),
            3.0 => {
                let square = product(self, base, base);
                product(self, square, base)
            }
            4.0 => {
                let square = product(self, base, base);
                product(self, square, square)
            }
            -1.0 => {
                let one = self.constant(1.0);
                self.add(GraphNode::Binary(Binary::Divide, one, base))
            }
            _ => {
                let exponent = self.constant(exponent);
                self.add(GraphNode::Binary(Binary::Power, base, exponent))
            }
        }
    }

    pub(super) fn branch(&mut self, condition: NodeId, then: NodeId, otherwise: NodeId) -> NodeId {
        match self.constant_value(condition) {
            Some(condition) if condition.is_nan() => self.constant(f64::NAN),
            Some(condition) => {
                if condition != 0.0 {
                    then
                } else {
                    otherwise
                }
            }
            None => self.add(GraphNode::If(condition, then, otherwise)),
        }
    }

    /// Returns a flag for each node that `roots` need, including the roots.
    pub(super) fn needed(&self, roots: impl IntoIterator<Item = NodeId>) -> Vec<bool> {
        let mut needed = vec![false; self.nodes.len()];
        for root in roots {
            needed[root as usize] = true;
        }
        for id in (0..self.nodes.len()).rev() {
            if needed[id] {
                for operand in self.nodes[id].operands() {
                    needed[operand as usize] = true;
                }
            }
        }
        needed
    }

    /// Returns the variables that `root` needs, ascending.
    pub(super) fn variables(&self, root: NodeId) -> Vec<usize> {
        let needed = self.needed([root]);
        let mut variables: Vec<usize> = (self.nodes.iter().zip(needed))
            .filter_map(|(node, needed)| match node {
                GraphNode::Variable(index) if needed => Some(*index),
                _ => None,
            })
            .collect();
        variables.sort_unstable();
        variables
    }
}
