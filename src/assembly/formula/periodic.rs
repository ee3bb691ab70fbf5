//! Variables inside a sine or cosine, with their factors there.

use std::collections::BTreeMap;

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{GraphNode, NodeId};
use crate::assembly::formula::set::FormulaSet;

/// Variables of a sum with their factors.
type Linear = BTreeMap<usize, f64>;

impl FormulaSet {
    /// Returns every variable of a sine or cosine whose argument is linear, with its factor: radians per unit.
    pub(crate) fn turning(&self) -> Vec<(usize, f64)> {
        let nodes = self.graph.nodes();
        let turned = |node: &GraphNode| match *node {
            GraphNode::Unary(Unary::Sin | Unary::Cos, a) => Some(a),
            _ => None,
        };
        // Only nodes inside a sine or cosine are collected: a sum of a thousand variables has five hundred thousand terms in its partial
        // sums.
        let needed = self.graph.needed(nodes.iter().filter_map(turned));
        let mut linear: Vec<Option<Linear>> = Vec::with_capacity(nodes.len());
        let mut found = Vec::new();
        for (node, needed) in nodes.iter().zip(needed) {
            if let Some(a) = turned(node) {
                found.extend(linear[a as usize].iter().flatten().map(|(&variable, &factor)| (variable, factor)));
            }
            let of = if needed { self.linear(*node, &linear) } else { None };
            linear.push(of);
        }
        found
    }

    /// Returns the linear terms of a node, or None if it is not linear.
    fn linear(&self, node: GraphNode, known: &[Option<Linear>]) -> Option<Linear> {
        let of = |id: NodeId| known[id as usize].as_ref();
        let times = |terms: &Linear, by: f64| {
            let mut scaled = terms.clone();
            scaled.values_mut().for_each(|factor| *factor *= by);
            scaled
        };
        match node {
            GraphNode::Constant(_) => Some(Linear::new()),
            GraphNode::Variable(index) => Some(Linear::from([(index, 1.0)])),
            GraphNode::Unary(Unary::Negate, a) => Some(times(of(a)?, -1.0)),
            GraphNode::Binary(Binary::Add, a, b) => Some(sum(of(a)?, of(b)?, 1.0)),
            GraphNode::Binary(Binary::Subtract, a, b) => Some(sum(of(a)?, of(b)?, -1.0)),
            GraphNode::Binary(Binary::Multiply, a, b) => {
                match (self.graph.constant_value(a), self.graph.constant_value(b)) {
                    (Some(by), _) => Some(times(of(b)?, by)),
                    (_, Some(by)) => Some(times(of(a)?, by)),
                    _ => None,
                }
            }
            GraphNode::Binary(Binary::Divide, a, b) => Some(times(of(a)?, 1.0 / self.graph.constant_value(b)?)),
            _ => None,
        }
    }
}

fn sum(a: &Linear, b: &Linear, sign: f64) -> Linear {
    let mut sum = a.clone();
    b.iter().for_each(|(&variable, factor)| *sum.entry(variable).or_default() += sign * factor);
    sum
}
