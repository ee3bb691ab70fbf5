//! Sums without the terms that they add and subtract again.
//!
//! Interval arithmetic takes the two `s` of `(a + s) - (b + s)` for different numbers: bounds of a pitch between two places that share a
//! datum shift would hold the shift twice. Only what rounding leaves as it is happens here: terms with factors that are powers of two.

use std::collections::BTreeMap;

use super::functions::{Binary, Unary};
use super::graph::{Graph, GraphNode, NodeId};

/// The graph of `root` without what cancels; None where nothing does.
pub(super) fn cancelled(graph: &Graph, root: NodeId) -> Option<(Graph, NodeId)> {
    let (needed, total) = (graph.needed([root]), total(graph));
    let nodes = || (0..graph.nodes().len()).filter(|&id| needed[id]).map(|id| (id as NodeId, graph.nodes()[id]));
    // The sums that are not terms of another one.
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

/// The terms of a node that is a sum, or a term times a power of two; None of any other.
fn terms(graph: &Graph, id: NodeId) -> Option<Vec<(NodeId, f64)>> {
    let power = |node: NodeId| {
        let value = graph.constant_value(node)?;
        // Mantissa 0: doubling and halving round nothing.
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

/// The terms that are left of a sum, with their factors; None where nothing cancels, and where a factor would be rounded.
fn collected(graph: &Graph, sum: NodeId, total: &[bool]) -> Option<Vec<(NodeId, f64)>> {
    // Of the greatest index first: all uses of a node come before it.
    let mut open = BTreeMap::from([(sum, 1.0)]);
    let (mut left, mut any) = (Vec::new(), false);
    while let Some((id, factor)) = open.pop_last() {
        if factor == 0.0 {
            // A term without a value leaves its sum without one.
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
            // The sum of two doubles is exact if either is what the other leaves of it.
            if !more.is_normal() || after - before != more || after - more != before {
                return None;
            }
            open.insert(term, after);
        }
    }
    any.then_some(left)
}

/// A sum of these terms, the earliest first.
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

/// The nodes that have a value wherever their variables have one.
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
