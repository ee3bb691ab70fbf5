//! Points that `auto` evaluates beside the axes.

use crate::method::polynomial_surface::PolynomialSurface;
use crate::plan::{Mixed, Point};

/// Point with every dimension up or down. If odd powers may be left, the opposite point is added.
#[derive(Debug, Clone)]
pub(super) struct Probe {
    pub(super) signs: Vec<f64>,
    pub(super) points: Vec<Point>,
}

/// Points that are evaluated beside the axes, and pairs that are known without evaluation.
#[derive(Debug, Clone, Default)]
pub(super) struct ChosenPoints {
    /// Points of the distribution, in mirrored pairs.
    pub(super) checks: Vec<[Point; 2]>,
    /// Two points next to the means, opposite to each other, that measure the scatter of answers.
    pub(super) noise: Option<[Point; 2]>,
    /// Points far out along the steepest line of a characteristic, for every characteristic that is examined there.
    pub(super) tails: Vec<(usize, [Point; 2])>,
    /// Pairs with evaluations of their own.
    pub(super) direct: Vec<(usize, usize)>,
    /// Pairs that are known to interact, with their exact mixed derivatives, for every characteristic.
    pub(super) given: Vec<Vec<((usize, usize), Mixed)>>,
    /// Surface of the formula of every characteristic; None if the formula is not a polynomial.
    pub(super) polynomials: Vec<Option<PolynomialSurface>>,
    /// Probes that judge the fits.
    pub(super) judging: Vec<Probe>,
    /// Probes that the interactions are fitted to.
    pub(super) fitted: Vec<Probe>,
}

impl ChosenPoints {
    /// Returns the surface of a characteristic whose formula is a polynomial.
    pub(super) fn polynomial(&self, c: usize) -> Option<&PolynomialSurface> {
        self.polynomials.get(c)?.as_ref()
    }

    /// True if the interaction of a pair is known in one characteristic, so that no evaluation is needed.
    pub(super) fn knows(&self, c: usize, pair: (usize, usize)) -> bool {
        self.direct.binary_search(&pair).is_ok() || self.gives(c, pair) || self.polynomial(c).is_some()
    }

    /// True if the exact mixed derivative of a pair is given.
    fn gives(&self, c: usize, pair: (usize, usize)) -> bool {
        self.given.get(c).is_some_and(|given| given.iter().any(|(known, _)| *known == pair))
    }

    /// Returns the pairs whose interaction is known in one characteristic.
    pub(super) fn known(&self, c: usize) -> Vec<(usize, usize)> {
        let given = self.given.get(c).into_iter().flatten().map(|(pair, _)| *pair);
        let mut all: Vec<(usize, usize)> = self.direct.iter().copied().chain(given).collect();
        all.sort_unstable();
        all.dedup();
        all
    }
}
