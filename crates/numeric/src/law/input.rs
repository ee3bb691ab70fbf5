//! Standardised input: probabilities, quantiles, and panels on which its density is smooth.

use std::sync::{Arc, LazyLock, OnceLock};

use crate::distribution::{Distribution, Normal, Probability, ScoreTable, Uniform, behind_normal, standard_normal};
use crate::law::LawTail;
use crate::law::polynomial::{MonotonePieces, Quartic, derivative, roots, value};

/// Tail probability at which quadratures over an unbounded input end. What lies beyond adds less than the rounding of a double to a
/// probability of 1e-30.
const FAR: f64 = 1e-40;
/// Relative difference of a panel's mass by Gauss and by the distribution function up to which the panel resolves the density.
const RESOLVED: f64 = 1e-12;
/// Mass below which a panel is not split further. Its weights are scaled to its mass.
const LIGHT: f64 = 1e-18;
/// Greatest number of panels of an input. A density that needs more is not piecewise smooth.
const MOST_PANELS: usize = 600;
/// Radians of phase for each rule of 16 nodes, which is then exact to 1e-15.
const PHASE: f64 = 9.0;
/// Greatest width of a piece, in sigmas: 16 nodes resolve a normal density over it.
const WIDEST: f64 = 1.5;

/// Greatest error of a quantile from a table at the scores between its places, in sigmas. The points that it is for have errors far above it.
const FOLLOWED: f64 = 3e-8;

/// Nodes and weights of the Gauss-Legendre rule with 16 nodes over the interval from 0 to 1.
pub(super) static GAUSS: LazyLock<Vec<(f64, f64)>> = LazyLock::new(|| {
    let rule = Uniform::about(0.0, 1.0).expect("an interval").jacobi(16).gauss();
    rule.nodes.iter().map(|z| 0.5 + 0.5 * z / 3f64.sqrt()).zip(rule.weights.iter().copied()).collect()
});

/// One standardised input with its distribution.
#[derive(Debug, Clone)]
pub(super) struct Input {
    law: Arc<dyn Distribution>,
    mean: f64,
    sigma: f64,
    normal: bool,
    /// Values with a probability of their own, as (value, probability), ascending.
    pub(super) atoms: Vec<(f64, f64)>,
    /// Probability of the part that has a density.
    pub(super) smooth: f64,
    /// Panels, made at the first use: sums of normal inputs need none.
    panels: OnceLock<Vec<Panel>>,
    /// Quantiles for many points, made at the first use. None if a cubic does not follow the quantile function.
    table: OnceLock<Option<ScoreTable>>,
    /// Points at which the density is not smooth.
    corners: Vec<f64>,
    /// Least and greatest value of quadratures.
    pub(super) ends: [f64; 2],
    /// Least and greatest value, infinite if there is none.
    pub(super) support: [f64; 2],
}

/// Interval on which the density is smooth.
#[derive(Debug, Clone, Copy)]
struct Panel {
    from: f64,
    to: f64,
    /// Factor that makes the weights sum to the mass of the panel: 1 if the density is resolved.
    factor: f64,
}

/// Nodes of a quadrature with their probabilities.
#[derive(Debug, Clone, Default)]
pub(super) struct Nodes {
    pub(super) z: Vec<f64>,
    pub(super) weight: Vec<f64>,
}

impl Input {
    /// Input of this distribution. Returns None if only its moments are known.
    pub(super) fn of(law: &Arc<dyn Distribution>) -> Option<Self> {
        let probability = law.probability()?;
        let (mean, sigma) = (law.mean(), law.sigma());
        let scaled = |x: f64| (x - mean) / sigma;
        let atoms: Vec<(f64, f64)> = probability.atoms().into_iter().map(|(x, p)| (scaled(x), p)).collect();
        let smooth = 1.0 - atoms.iter().map(|(_, p)| p).sum::<f64>();
        let smooth = if smooth > 1e-14 { smooth } else { 0.0 };
        let support = law.support().map(scaled);
        let low = if support[0].is_finite() { support[0] } else { scaled(probability.quantile(FAR)) };
        let high = if support[1].is_finite() { support[1] } else { scaled(probability.upper_quantile(FAR)) };
        let normal = law.name() == Normal::NAME;
        let corners = probability.corners().into_iter().map(scaled).collect();
        let law = Arc::clone(law);
        let (panels, table, ends) = (OnceLock::new(), OnceLock::new(), [low, high]);
        Some(Self { law, mean, sigma, normal, atoms, smooth, panels, table, corners, ends, support })
    }

    /// True if the tails fall with so low a power that quadratures extend farther than their nodes resolve. This holds for Student's
    /// distribution with fewer than 18 degrees of freedom.
    pub(super) fn falls_as_a_power(&self) -> bool {
        /// Greatest extent in sigmas. With 18 degrees of freedom the distribution ends at 157.
        const FARTHEST: f64 = 200.0;
        self.law.name() == "student" && self.ends[1] > FARTHEST
    }

    pub(super) fn is_normal(&self) -> bool {
        self.normal
    }

    /// True if every value has a probability of its own.
    pub(super) fn is_discrete(&self) -> bool {
        self.smooth == 0.0
    }

    fn probability(&self) -> &dyn Probability {
        self.law.probability().expect("checked when the input was made")
    }

    fn x(&self, z: f64) -> f64 {
        self.mean + self.sigma * z
    }

    /// Probability of a value of at most `z`.
    pub(super) fn cdf(&self, z: f64) -> f64 {
        match self.normal {
            true => standard_normal::cdf(z),
            // The end itself may be rounded to a point inside the support.
            false if z <= self.support[0] && self.atoms.is_empty() => 0.0,
            false => self.probability().cdf(self.x(z)),
        }
    }

    /// Probability of a value above `z`.
    pub(super) fn sf(&self, z: f64) -> f64 {
        match self.normal {
            true => standard_normal::sf(z),
            false if z >= self.support[1] => 0.0,
            false => self.probability().sf(self.x(z)),
        }
    }

    /// Density per sigma of the part outside the atoms.
    pub(super) fn density(&self, z: f64) -> f64 {
        if self.normal {
            standard_normal::density(z)
        } else {
            self.sigma * self.probability().smooth_density(self.x(z))
        }
    }

    /// Half-widths in sigmas of the uniform variables whose sum the input is. Returns None if it is not such a sum.
    pub(super) fn uniform_halves(&self) -> Option<Vec<f64>> {
        let half = 0.5 * (self.ends[1] - self.ends[0]);
        let middle = 0.5 * (self.ends[1] + self.ends[0]);
        match (self.law.name(), &self.corners[..]) {
            ("uniform", []) => Some(vec![half]),
            ("triangular", [mode]) if (mode - middle).abs() <= 4.0 * f64::EPSILON * half => Some(vec![0.5 * half; 2]),
            ("trapezoidal", [_]) => Some(vec![0.5 * half; 2]),
            ("trapezoidal", [from, to]) => {
                let top = 0.5 * (to - from);
                Some(vec![0.5 * (half + top), 0.5 * (half - top)])
            }
            _ => None,
        }
    }

    /// Probability between two values, from the nearer tail so that it keeps its digits.
    pub(super) fn mass(&self, from: f64, to: f64) -> f64 {
        let mass = if from > 0.0 { self.sf(from) - self.sf(to) } else { self.cdf(to) - self.cdf(from) };
        mass.max(0.0)
    }

    /// Probability between two values, which may be infinite or lie close together.
    pub(super) fn between(&self, from: f64, to: f64) -> f64 {
        /// Width in sigmas below which a difference of probabilities loses digits and the density is integrated.
        const NARROW: f64 = 0.05;
        let width = to - from;
        if from == f64::NEG_INFINITY {
            return if to == f64::INFINITY { 1.0 } else { self.cdf(to) };
        }
        if to == f64::INFINITY {
            return self.sf(from);
        }
        let inner = || from > self.ends[0] + 4.0 * width && to < self.ends[1] - 4.0 * width;
        if width < NARROW && self.atoms.is_empty() && inner() && !self.corners.iter().any(|&z| from < z && z < to) {
            return GAUSS.iter().map(|(x, w)| w * width * self.density(from + width * x)).sum();
        }
        self.mass(from, to)
    }

    /// Probability that a polynomial of the input lies strictly above 0 (upper tail) or below 0 (lower tail).
    pub(super) fn beyond(&self, polynomial: &Quartic, tail: LawTail) -> f64 {
        self.beyond_by(&MonotonePieces::of(polynomial, self.ends), polynomial, tail)
    }

    /// [`beyond`](Self::beyond) with the pieces of the polynomial.
    pub(super) fn beyond_by(&self, pieces: &MonotonePieces, polynomial: &Quartic, tail: LawTail) -> f64 {
        let counts = |z: f64| value(polynomial, z) * tail.sign() > 0.0;
        let places = pieces.roots(polynomial, self.ends);
        let [low, high] = self.ends;
        let (mut from, mut total) = (f64::NEG_INFINITY, 0.0);
        for to in places.as_slice().iter().copied().chain([f64::INFINITY]) {
            if counts(0.5 * (from.max(low) + to.min(high))) {
                total += self.between(from, to);
            }
            from = to;
        }
        total
    }

    /// Density of a polynomial of the input at 0.
    pub(super) fn density_of(&self, pieces: &MonotonePieces, polynomial: &Quartic) -> f64 {
        let slope = derivative(polynomial);
        let at = |&z: &f64| self.density(z) / value(&slope, z).abs();
        pieces.roots(polynomial, self.ends).as_slice().iter().map(at).sum()
    }

    /// Panels on which the density is smooth, with the factor of their weights.
    pub(super) fn panels(&self) -> impl Iterator<Item = ([f64; 2], f64)> + '_ {
        self.smooth_panels().iter().map(|panel| ([panel.from, panel.to], panel.factor))
    }

    fn smooth_panels(&self) -> &[Panel] {
        self.panels.get_or_init(|| if self.smooth > 0.0 { self.resolved() } else { Vec::new() })
    }

    /// Quantile of a probability counted from the nearer end: `p` from below, `-p` from above.
    pub(super) fn at_tail(&self, tail: f64) -> f64 {
        let z = match (self.normal, tail < 0.0) {
            (true, false) => standard_normal::quantile(tail),
            (true, true) => standard_normal::upper_quantile(-tail),
            (false, false) => (self.probability().quantile(tail) - self.mean) / self.sigma,
            (false, true) => (self.probability().upper_quantile(-tail) - self.mean) / self.sigma,
        };
        z.clamp(self.ends[0], self.ends[1])
    }

    /// Value with the same probability below it as `score` has in the standard normal distribution.
    pub(super) fn at_score(&self, score: f64) -> f64 {
        match self.normal {
            true => score,
            false => {
                ((behind_normal(self.probability(), score) - self.mean) / self.sigma).clamp(self.ends[0], self.ends[1])
            }
        }
    }

    /// Turns many normal scores into values with the same probabilities below them, in place.
    ///
    /// Smooth laws have a table if it is right to [`FOLLOWED`] in the middle between its places.
    pub(super) fn at_scores(&self, scores: &mut [f64]) {
        if self.normal {
            return;
        }
        let table = self.table.get_or_init(|| self.followed_table()).as_ref();
        for score in scores {
            *score = match table.filter(|table| table.reaches(*score)) {
                Some(table) => table.value(*score).clamp(self.ends[0], self.ends[1]),
                None => self.at_score(*score),
            };
        }
    }

    /// Table of quantiles, if a cubic follows them between its places.
    fn followed_table(&self) -> Option<ScoreTable> {
        if !self.atoms.is_empty() || !self.corners.is_empty() || self.law.name() == "uniform" {
            return None;
        }
        let table = ScoreTable::new(self.probability(), [self.mean, self.sigma], self.law.support());
        let off = |score: f64| (table.value(score) - self.at_score(score)).abs() > FOLLOWED;
        if ScoreTable::middles().any(off) { None } else { Some(table) }
    }

    /// Points at which the density is not smooth: the ends and the corners.
    pub(super) fn breaks(&self) -> Vec<f64> {
        let mut breaks: Vec<f64> = self.corners.iter().copied().chain(self.ends).collect();
        breaks.retain(|z| (self.ends[0]..=self.ends[1]).contains(z));
        breaks.sort_unstable_by(f64::total_cmp);
        breaks.dedup();
        breaks
    }

    /// Panels on which 16 nodes give the mass of the distribution function. They are halved until they do. This grades them towards an end
    /// where the density behaves like a broken power.
    fn resolved(&self) -> Vec<Panel> {
        let atom_mass = |from: f64, to: f64| -> f64 {
            self.atoms.iter().filter(|(z, _)| *z > from && *z <= to).map(|(_, p)| p).sum()
        };
        let mut open: Vec<(f64, f64)> = self.breaks().windows(2).map(|pair| (pair[0], pair[1])).rev().collect();
        let mut panels = Vec::new();
        let gauss = |from: f64, to: f64| -> f64 {
            GAUSS.iter().map(|(x, w)| w * (to - from) * self.density(from + (to - from) * x)).sum()
        };
        while let Some((from, to)) = open.pop() {
            let mass = self.mass(from, to) - atom_mass(from, to);
            let by_gauss = gauss(from, to);
            // Rounding error of a difference of two probabilities.
            let rounding = 4e-16 * if from > 0.0 { self.sf(from) } else { self.cdf(to) };
            let half = 0.5 * (from + to);
            // Node positions are rounded, which changes the density next to an end of the support.
            let blurred = 4.0 * f64::EPSILON * from.abs().max(to.abs()) / (to - from);
            let resolved = RESOLVED + blurred;
            // Some distribution functions have fewer digits than their densities. Then compare the rule with its two halves.
            let agree =
                || (by_gauss - gauss(from, half) - gauss(half, to)).abs() <= (0.1 * RESOLVED + blurred) * by_gauss;
            if (by_gauss - mass).abs() <= resolved * mass + rounding || agree() {
                panels.push(Panel { from, to, factor: 1.0 });
                continue;
            }
            // Split the panel, or scale its weights to the mass if it is too light or too narrow.
            let middle = 0.5 * (from + to);
            let wide = middle > from && middle < to && to - from > 1e-14 * (self.ends[1] - self.ends[0]);
            if mass > LIGHT && wide && panels.len() + open.len() < MOST_PANELS {
                open.push((middle, to));
                open.push((from, middle));
            } else if mass > 0.0 && by_gauss > 0.0 {
                panels.push(Panel { from, to, factor: mass / by_gauss });
            }
        }
        panels
    }

    /// Nodes and weights of an expectation of `exp(i phase)`. The phase over an interval is taken as `top` times the sum of the change of
    /// the polynomial and `near` for each sigma.
    pub(super) fn nodes(&self, part: &Quartic, top: f64, near: f64) -> Nodes {
        self.nodes_within(part, top, near, [f64::NEG_INFINITY, f64::INFINITY])
    }

    /// Nodes of [`Self::nodes`] inside an interval.
    pub(super) fn nodes_within(&self, part: &Quartic, top: f64, near: f64, [low, high]: [f64; 2]) -> Nodes {
        let mut nodes = Nodes::default();
        let extremes = roots(&derivative(part), self.ends);
        for panel in self.smooth_panels() {
            let inside = extremes.as_slice().iter().copied().filter(|&z| z > panel.from && z < panel.to);
            let mut from = panel.from;
            for to in inside.chain([panel.to]) {
                let (cut_from, cut_to) = (from.max(low), to.min(high));
                if cut_from < cut_to {
                    self.piece(&mut nodes, [cut_from, cut_to], panel.factor, part, top, near);
                }
                from = to;
            }
        }
        for &(z, weight) in &self.atoms {
            nodes.z.push(z);
            nodes.weight.push(weight);
        }
        nodes
    }

    /// Adds nodes of a piece on which the polynomial is monotone, in intervals of small phase.
    fn piece(&self, nodes: &mut Nodes, [from, to]: [f64; 2], factor: f64, part: &Quartic, top: f64, near: f64) {
        let mut open = vec![(from, to)];
        while let Some((from, to)) = open.pop() {
            let phase = top * ((value(part, to) - value(part, from)).abs() + near * (to - from));
            // Far out in a long tail, densities vary with the logarithm of the distance.
            let widest = WIDEST.max(0.2 * from.abs().min(to.abs()));
            let wanted = (phase / PHASE).max((to - from) / widest).ceil();
            let middle = 0.5 * (from + to);
            // A monotone quartic may run through most of its phase in a small part of the interval, so halve it first.
            if wanted > 1.0 && middle > from && middle < to && nodes.z.len() < (1 << 17) {
                open.push((middle, to));
                open.push((from, middle));
                continue;
            }
            let width = to - from;
            for &(x, w) in GAUSS.iter() {
                let z = from + width * x;
                let weight = w * width * factor * self.density(z);
                if weight > 0.0 {
                    nodes.z.push(z);
                    nodes.weight.push(weight);
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::distribution::{
        Beta, Gamma, Lognormal, Mixture, Part, Trapezoidal, Triangular, TruncatedNormal, Weibull,
    };

    fn inputs() -> Vec<Input> {
        let part = |weight: f64, mean: f64| Part {
            name: String::new(),
            weight,
            distribution: Arc::new(Triangular::new(mean - 1.0, mean, mean + 2.0).unwrap()),
        };
        let laws: Vec<Arc<dyn Distribution>> = vec![
            Arc::new(Normal::new(3.0, 2.0).unwrap()),
            Arc::new(Uniform::new(-1.0, 4.0).unwrap()),
            Arc::new(Triangular::new(0.0, 0.3, 1.0).unwrap()),
            Arc::new(Trapezoidal::new(0.0, 1.0, 0.4).unwrap()),
            Arc::new(Beta::new(0.0, 1.0, 1.6, 2.5).unwrap()),
            Arc::new(Gamma::new(0.0, 1.5, 1.2).unwrap()),
            Arc::new(Weibull::new(0.0, 1.5, 0.8).unwrap()),
            Arc::new(Lognormal::new(0.0, 1.0, 0.5).unwrap()),
            Arc::new(TruncatedNormal::new(-1.0, 1.0, 0.1, 0.4).unwrap()),
            Arc::new(Mixture::new(vec![part(1.0, 0.0), part(2.0, 1.7)]).unwrap()),
        ];
        laws.iter().map(|law| Input::of(law).unwrap()).collect()
    }

    /// Mean 0 and variance 1 hold by definition, the third moment by the distribution's closed form. The weights are as exact as the
    /// distribution functions, 1e-12.
    #[test]
    fn nodes_have_the_moments_of_the_input() {
        for input in inputs() {
            let nodes = input.nodes(&[0.0; 5], 0.0, 0.0);
            let moment = |k: i32| -> f64 { nodes.z.iter().zip(&nodes.weight).map(|(z, w)| w * z.powi(k)).sum() };
            let third = input.law.standard_moments().skewness;
            for (k, expected) in [(0, 1.0), (1, 0.0), (2, 1.0), (3, third)] {
                let name = input.law.name();
                assert!(
                    (moment(k) - expected).abs() < 1e-11 * (1.0 + expected),
                    "{name}: {k} {}",
                    moment(k) - expected
                );
            }
        }
    }

    /// `E exp(i t z)` of a uniform input is `sin(t sqrt 3)/(t sqrt 3)`. Nine radians for 16 nodes keep 1e-14.
    #[test]
    fn nodes_resolve_a_phase() {
        let input = &inputs()[1];
        for t in [1.0, 30.0, 900.0] {
            let nodes = input.nodes(&[0.0, 1.0, 0.0, 0.0, 0.0], t, 0.0);
            let mean: f64 = nodes.z.iter().zip(&nodes.weight).map(|(z, w)| w * libm::cos(t * z)).sum();
            let a = t * 3f64.sqrt();
            assert!((mean - libm::sin(a) / a).abs() < 1e-14, "{t}");
        }
    }
}
