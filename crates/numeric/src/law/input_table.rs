//! Input as a table of nodes, for programs that compute distributions elsewhere, such as the pages of reports.

use std::sync::Arc;

use serde::Serialize;

use crate::distribution::Distribution;
use crate::law::input::{Input, Nodes};

/// Phase per sigma that the nodes resolve, for a bounded and for an unbounded input.
const TOP: [f64; 2] = [100.0, 14.0];
/// Tail probability at which the nodes of an unbounded input end. A page shows no probability of that size.
const FAR: f64 = 1e-22;
/// Greatest number of nodes. The table has twice as many numbers.
const MOST: usize = 3000;
/// Relative difference below which two numbers count as equal.
const SAME: f64 = 1e-11;
/// Polynomial `z` itself.
const LINE: [f64; 5] = [0.0, 1.0, 0.0, 0.0, 0.0];

/// Standardised input as a table.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TabulatedInput {
    normal: bool,
    /// Least and greatest value; null if there is none.
    support: [Option<f64>; 2],
    /// Half-widths of the uniform variables whose sum the input is; empty if it is not such a sum.
    halves: Vec<f64>,
    /// Nodes, in sigmas. Their weights are in `w`.
    z: Vec<f64>,
    w: Vec<f64>,
    /// Phase per sigma that the nodes resolve; null if the nodes are all values of the input.
    top: Option<f64>,
}

impl TabulatedInput {
    /// Table of this distribution, without nodes if a closed form covers polynomials of this degree. Returns None if only the moments of
    /// the distribution are known, or if it takes too many nodes.
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

    /// True if both tables are equal except for rounding from different units.
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

    /// True if the distribution is normal.
    pub fn is_normal(&self) -> bool {
        self.normal
    }
}
