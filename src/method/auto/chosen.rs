//! The points that `auto` evaluates beside the axes.

use crate::method::polynomial_surface::PolynomialSurface;
use crate::plan::{Mixed, Point};

/// Every dimension up or down, and all turned round where odd powers may be left.
#[derive(Debug, Clone)]
pub(super) struct Probe {
    pub(super) signs: Vec<f64>,
    pub(super) points: Vec<Point>,
}

/// Points evaluated beside the axes.
#[derive(Debug, Clone, Default)]
pub(super) struct ChosenPoints {
    /// Points of the distribution, in mirrored pairs.
    pub(super) checks: Vec<[Point; 2]>,
    /// Two points next to the means, opposite to each other.
    pub(super) noise: Option<[Point; 2]>,
    /// For every characteristic that is looked at so, points far out along its steepest line.
    pub(super) tails: Vec<(usize, [Point; 2])>,
    /// Pairs with two evaluations of their own.
    pub(super) direct: Vec<(usize, usize)>,
    /// For every characteristic, pairs that are known to interact, with their exact mixed derivatives.
    pub(super) given: Vec<Vec<((usize, usize), Mixed)>>,
    /// For every characteristic the surface of its formula, where that is a polynomial.
    pub(super) polynomials: Vec<Option<PolynomialSurface>>,
    /// Probes that judge, and probes that are fitted.
    pub(super) judging: Vec<Probe>,
    pub(super) fitted: Vec<Probe>,
}

impl ChosenPoints {
    /// The surface of a characteristic whose formula is a polynomial.
    pub(super) fn polynomial(&self, c: usize) -> Option<&PolynomialSurface> {
        self.polynomials.get(c)?.as_ref()
    }

    /// Whether nothing is left to find out about a pair of one characteristic.
    pub(super) fn knows(&self, c: usize, pair: (usize, usize)) -> bool {
        self.direct.binary_search(&pair).is_ok() || self.gives(c, pair) || self.polynomial(c).is_some()
    }

    /// Whether a pair is known to interact, and how.
    fn gives(&self, c: usize, pair: (usize, usize)) -> bool {
        self.given.get(c).is_some_and(|given| given.iter().any(|(known, _)| *known == pair))
    }

    /// The pairs of one characteristic about which nothing is left to find out.
    pub(super) fn known(&self, c: usize) -> Vec<(usize, usize)> {
        let given = self.given.get(c).into_iter().flatten().map(|(pair, _)| *pair);
        let mut all: Vec<(usize, usize)> = self.direct.iter().copied().chain(given).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
