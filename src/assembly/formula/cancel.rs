//! Removal of terms that a sum adds and subtracts again.
//!
//! Interval arithmetic treats the two `s` of `(a + s) - (b + s)` as different numbers. Bounds of a pitch between two places that share a
//! datum shift would include the shift twice. Only terms whose factors are powers of two are removed, so that rounding does not change.

use std::collections::BTreeMap;

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::graph::{Graph, GraphNode, NodeId};

/// Returns the graph of `root` without the terms that cancel, or None if no term cancels.
pub(super) fn cancelled(graph: &Graph, root: NodeId) -> Option<(Graph, NodeId)> {
    let (needed, total) = (graph.needed([root]), total(graph));
    let nodes = || (0..graph.nodes().len()).filter(|&id| needed[id]).map(|id| (id as NodeId, graph.nodes()[id]));
    // Sums that are not terms of another sum.
    let mut whole = vec![false; graph.nodes().len()];
    whole[root as usize] = true;
    for (id, node) in nodes().filter(|&(id, _)| terms(graph, id).is_none()) {
        debug_assert!(node.operands().all(|operand| operand < id));
        node.operands().for_each(|operand| whole[operand as usize] = true);
    }
    let (mut clean, mut places, mut any) = (Graph::default(), vec![0; graph.nodes().len()], false);
    for (id, node) in nodes() {
        let at = |operand: NodeId| places[operand as usize];
        let sum = Some(id).filter(|&id| whole[id as usize]).and_then(|id| collected(graph, id, &total));
        any |= sum.is_some();
        places[id as usize] = match (sum, node) {
            (Some(sum), _) => {
                let terms: Vec<(NodeId, f64)> = sum.into_iter().map(|(term, factor)| (at(term), factor)).collect();
                add(&mut clean, &terms)
            }
            (None, GraphNode::Constant(bits)) => clean.constant(f64::from_bits(bits)),
            (None, GraphNode::Variable(index)) => clean.variable(index),
            (None, GraphNode::Unary(function, a)) => clean.unary(function, at(a)),
            (None, GraphNode::Binary(function, a, b)) => clean.binary(function, at(a), at(b)),
            (None, GraphNode::If(condition, then, otherwise)) => clean.branch(at(condition), at(then), at(otherwise)),
        };
    }
    any.then_some((clean, places[root as usize]))
}

/// Returns the terms of a sum, or of a term times a power of two. Returns None for any other node.
fn terms(graph: &Graph, id: NodeId) -> Option<Vec<(NodeId, f64)>> {
    let power = |node: NodeId| {
        let value = graph.constant_value(node)?;
        // The mantissa is 0 for powers of two, which multiply without rounding.
        (value.is_normal() && value.to_bits() << 12 == 0).then_some(value)
    };
    match graph.nodes()[id as usize] {
        GraphNode::Binary(Binary::Add, a, b) => Some(vec![(a, 1.0), (b, 1.0)]),
        GraphNode::Binary(Binary::Subtract, a, b) => Some(vec![(a, 1.0), (b, -1.0)]),
        GraphNode::Unary(Unary::Negate, a) => Some(vec![(a, -1.0)]),
        GraphNode::Binary(Binary::Multiply, a, b) => {
            power(a).map(|factor| (b, factor)).or(power(b).map(|factor| (a, factor))).map(|term| vec![term])
        }
        GraphNode::Binary(Binary::Divide, a, b) => power(b).map(|divisor| vec![(a, 1.0 / divisor)]),
        _ => None,
    }
}

/// Returns the remaining terms of a sum, with their factors. Returns None if no term cancels, or if a factor would be rounded.
fn collected(graph: &Graph, sum: NodeId, total: &[bool]) -> Option<Vec<(NodeId, f64)>> {
    // The greatest index comes first, so that all uses of a node come before it.
    let mut open = BTreeMap::from([(sum, 1.0)]);
    let (mut left, mut any) = (Vec::new(), false);
    while let Some((id, factor)) = open.pop_last() {
        if factor == 0.0 {
            // A term may have no value at some point. Its sum has none there either, so the term must stay.
            if !total[id as usize] {
                return None;
            }
            any = true;
            continue;
        }
        let Some(terms) = terms(graph, id) else {
            left.push((id, factor));
            continue;
        };
        for (term, times) in terms {
            let more: f64 = factor * times;
            let before = open.get(&term).copied().unwrap_or(0.0);
            let after = before + more;
            // The sum of two doubles is exact if each is recovered from it by subtracting the other.
            if !more.is_normal() || after - before != more || after - more != before {
                return None;
            }
            open.insert(term, after);
        }
    }
    any.then_some(left)
}

/// Adds a sum of these terms to the graph, the earliest term first.
fn add(graph: &mut Graph, terms: &[(NodeId, f64)]) -> NodeId {
    let mut sum = None;
    for &(term, factor) in terms.iter().rev() {
        let size = match factor.abs() {
            1.0 => term,
            size => {
                let size = graph.constant(size);
                graph.binary(Binary::Multiply, size, term)
            }
        };
        sum = Some(match sum {
            None if factor < 0.0 => graph.unary(Unary::Negate, size),
            None => size,
            Some(sum) if factor < 0.0 => graph.binary(Binary::Subtract, sum, size),
            Some(sum) => graph.binary(Binary::Add, sum, size),
        });
    }
    sum.unwrap_or_else(|| graph.constant(0.0))
}

/// Returns a flag for each node that has a value wherever its variables have one.
fn total(graph: &Graph) -> Vec<bool> {
    let mut total: Vec<bool> = Vec::with_capacity(graph.nodes().len());
    for &node in graph.nodes() {
        let itself = match node {
            GraphNode::Constant(bits) => f64::from_bits(bits).is_finite(),
            GraphNode::Variable(_) => true,
            GraphNode::Unary(function, _) => matches!(
                function,
                Unary::Negate | Unary::Abs | Unary::Sin | Unary::Cos | Unary::Atan | Unary::Tanh | Unary::Sign
            ),
            GraphNode::Binary(Binary::Divide, _, b) => {
                graph.constant_value(b).is_some_and(|divisor| divisor.is_finite() && divisor != 0.0)
            }
            GraphNode::Binary(function, ..) => matches!(
                function,
                Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Min | Binary::Max | Binary::Hypot
            ),
            GraphNode::If(..) => false,
        };
        total.push(itself && node.operands().all(|operand| total[operand as usize]));
    }
    total
}
