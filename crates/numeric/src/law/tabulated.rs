//! An input as a table of nodes, for those who compute laws elsewhere: the pages of reports.

use std::sync::Arc;

use serde::Serialize;

use super::input::{Input, Nodes};
use crate::distribution::Distribution;

/// Phase per sigma that the nodes of a bounded input resolve, and of an unbounded one.
const TOP: [f64; 2] = [100.0, 14.0];
/// The part of an unbounded input beyond these tails is left out: a page shows no probability of that size.
const FAR: f64 = 1e-22;
/// Nodes at most: a table of twice as many numbers.
const MOST: usize = 3000;
/// Numbers nearer to each other are the same.
const SAME: f64 = 1e-11;
/// The slope alone.
const LINE: [f64; 5] = [0.0, 1.0, 0.0, 0.0, 0.0];

/// A standardised input.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TabulatedInput {
    normal: bool,
    /// Least and greatest value; null where there is none.
    support: [Option<f64>; 2],
    /// Half widths of the uniform variables whose sum it is; empty where it is not such a sum.
    halves: Vec<f64>,
    /// Places, and their weights.
    z: Vec<f64>,
    w: Vec<f64>,
    /// The phase per sigma that the nodes resolve; null where they are all its values.
    top: Option<f64>,
}

impl TabulatedInput {
    /// Of this distribution, without nodes where a closed form serves polynomials of this degree; None where only its moments are
    /// known, and where it takes too many nodes.
    pub fn of(law: &Arc<dyn Distribution>, degree: usize) -> Option<Self> {
        let input = Input::of(law)?;
        let end = |end: f64| Some(end).filter(|end| end.is_finite());
        let support = input.support.map(end);
        let [low, high] =
            [(support[0], FAR), (support[1], -FAR)].map(|(end, tail)| end.unwrap_or_else(|| input.at_tail(tail)));
        let top = TOP[usize::from(support.contains(&None))];
        let halves = input.uniform_halves().unwrap_or_default();
        let closed = if input.is_normal() { 2 } else { usize::from(!halves.is_empty()) };
        let nodes = match degree <= closed {
            true => Nodes::default(),
            false => input.nodes_within(&LINE, top, 0.0, [low, high]),
        };
        let top = (!input.is_discrete()).then_some(top);
        let found = Self { normal: input.is_normal(), support, halves, z: nodes.z, w: nodes.weight, top };
        (found.z.len() <= MOST).then_some(found)
    }

    /// Whether both are the same but for the rounding of their units.
    pub fn is_near(&self, other: &Self) -> bool {
        let near = |a: &[f64], b: &[f64]| {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() <= SAME * a.abs().max(b.abs()).max(1.0))
        };
        let ends = |of: &Self| of.support.map(|end| end.unwrap_or(f64::MAX));
        self.normal == other.normal
            && self.top == other.top
            && near(&ends(self), &ends(other))
            && near(&self.halves, &other.halves)
            && near(&self.z, &other.z)
            && near(&self.w, &other.w)
    }

    /// Whether it is a normal distribution.
    pub fn is_normal(&self) -> bool {
        self.normal
    }
}
