//! Nodes: places on the axis of a dimension at which it is evaluated, in its sigmas about its mean.
//!
//! A discrete dimension, with two values or measured ones, is evaluated at some of its values and at its mean. For a dimension of two
//! values, a polynomial through both is exact.

use sensitol_numeric::distribution::{Distribution, Jacobi, Rule};

/// Number of nodes of an axis beside the mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// No node: derivatives come from elsewhere.
    Bare,
    /// One node, the upper one of a pair: the model returns slopes with its values.
    Upper,
    /// Two nodes, for slope and curvature.
    Pair,
    /// Four nodes, for derivatives up to the fourth.
    Five,
}

/// Nodes that suit a distribution, and the moves that its support required.
#[derive(Debug, Clone, PartialEq)]
pub struct Nodes {
    /// Places in sigmas, ascending, without the mean.
    pub u: Vec<f64>,
    /// Nodes that would have been outside the support.
    pub moved: Vec<MovedNode>,
    /// Tail that is too long for the nodes. None if it is not.
    pub tail: Option<Tail>,
}

/// Tail that reaches so far beyond the nodes that a polynomial through them is inaccurate for high moments.
#[derive(Debug, Clone, PartialEq)]
pub struct Tail {
    /// Distance in sigmas up to which values matter for the moments: the farthest node of the distribution's nine-point Gauss rule.
    pub reach: f64,
    /// Distance of the farthest node from the mean, in sigmas.
    pub farthest: f64,
    /// Rule with positive weights at five-point nodes. It integrates the evaluated values directly, instead of the quartic through them.
    pub rule: Option<Rule>,
}

/// Node that was moved into the support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MovedNode {
    /// Place that the moments require, in sigmas.
    pub from: f64,
    /// Place inside the support, in sigmas.
    pub to: f64,
}

/// Place of a node that was moved into the support, as a part of the way from the mean to the edge.
const INSIDE: f64 = 0.95;
/// Greatest distance of an atom from the mean, in sigmas, that is taken as rounding.
const AT_THE_MEAN: f64 = 1e-9;
/// Greatest distance of a node from the mean, in sigmas. Moments alone may require a node at which no model should be evaluated.
const FARTHEST: f64 = 20.0;
/// Least distance of a node of five from the mean, in sigmas: the noise of the model dominates the slope of a shorter chord.
const NEAREST: f64 = 0.35;
/// Nodes of the Gauss rule that gives the reach of a distribution's moments: it integrates the fourth power of a quartic.
const REACH: usize = 9;
/// Least ratio of the reach to the farthest of five nodes that makes a long tail.
///
/// The ratio of a normal distribution is 1.6 with five points and 2.6 with a pair, that of an exponential one 2.5 and 8.6. Errors of the
/// kurtosis with five points were measured on eight functions (exponentials, sine, root, cube, reciprocal, arcs), by the quartic and by the
/// rule: 5e-3 and 5e-2 for the exponential distribution, 0.1 and 0.07 for a gamma of shape 1/2 (ratio 3.1), 2 and 0.2 for a lognormal with
/// tau = 1/2 (ratio 12). Mean and sigma are the same by both. A parabola has 2 to 10 times the errors of sigma of either.
const LONG_FIVE: f64 = 3.0;
/// Least ratio of the reach to the farther node of a pair that makes a long tail.
const LONG_PAIR: f64 = 8.0;

impl Nodes {
    /// Nodes that are matched to the moments of the distribution.
    ///
    /// A pair is matched to the moments up to the fourth: `u± = s/2 ± sqrt(f - 3 s^2/4)` with skewness `s` and kurtosis `f`, normal ±sqrt
    /// 3. Five points are matched to the moments up to the eighth, with the mean among them: for a normal the Gauss-Hermite nodes. If one
    /// of these is outside the support, or very far out, the other four are the nodes of the distribution's four-point Gauss rule, which
    /// lie inside. With fewer than five atoms, or if even that is too far out, five points fall back to the pair. Nodes of a discrete
    /// distribution are the atoms next to these places.
    pub fn matched(distribution: &dyn Distribution, spread: Spread) -> Self {
        Self::matched_with(distribution, spread, &mut Reaches::default())
    }

    /// Matched nodes, with the reaches computed for earlier dimensions.
    pub(super) fn matched_with(distribution: &dyn Distribution, spread: Spread, reaches: &mut Reaches) -> Self {
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        let support = distribution.support().map(|edge| (edge - mean) / sigma);
        if spread == Spread::Bare {
            return Self { u: Vec::new(), moved: Vec::new(), tail: None };
        }
        let atoms: Vec<f64> = values(distribution).into_iter().map(|x| (x - mean) / sigma).collect();
        let five = if spread == Spread::Five { five(distribution, support) } else { None };
        let five = match &atoms[..] {
            [] => five.map(|(u, rule)| (u, Some(rule))),
            atoms => five.and_then(|(u, _)| four_of(atoms, &u)).map(|u| {
                let rule = rule_at(distribution, &u);
                (u, rule)
            }),
        };
        let reach = reaches.of(distribution);
        let (u, moved, rule, long) = match five {
            Some((u, rule)) => (u, Vec::new(), rule, LONG_FIVE),
            None => {
                let (u, moved) = pair(distribution, support);
                let (mut u, moved) = match &atoms[..] {
                    [] => (u, moved),
                    atoms => (u.iter().map(|&u| nearest(atoms, u).unwrap_or(u)).collect(), Vec::new()),
                };
                if spread == Spread::Upper {
                    u.retain(|&u| u > 0.0);
                }
                (u, moved, None, LONG_PAIR)
            }
        };
        let farthest = u.iter().fold(0.0f64, |farthest, u| farthest.max(u.abs()));
        Self { u, moved, tail: (reach > long * farthest).then_some(Tail { reach, farthest, rule }) }
    }

    /// Nodes at the step on either side and, for five points, also at two times the step.
    pub(crate) fn stepped(step: f64, spread: Spread) -> Self {
        let u = match spread {
            Spread::Bare => Vec::new(),
            Spread::Upper => vec![step],
            Spread::Pair => vec![-step, step],
            Spread::Five => vec![-2.0 * step, -step, step, 2.0 * step],
        };
        Self { u, moved: Vec::new(), tail: None }
    }
}

/// Values of a discrete distribution, ascending. Empty if the distribution has a density.
pub(super) fn values(distribution: &dyn Distribution) -> Vec<f64> {
    /// Least sum of the shares of all atoms, allowing for rounding.
    const WHOLE: f64 = 1.0 - 1e-12;
    let atoms = distribution.probability().map_or_else(Vec::new, |law| law.atoms());
    let all: f64 = atoms.iter().map(|(_, share)| share).sum();
    if all >= WHOLE { atoms.into_iter().map(|(x, _)| x).collect() } else { Vec::new() }
}

/// Atom nearest to a place, on its side of the mean. Returns None if there is none.
pub(super) fn nearest(atoms: &[f64], place: f64) -> Option<f64> {
    let beside = atoms.iter().copied().filter(|u| u.signum() == place.signum() && u.abs() > AT_THE_MEAN);
    beside.min_by(|a, b| (a - place).abs().total_cmp(&(b - place).abs()))
}

/// Two atoms on either side, next to these places. Returns None if a side has no two atoms with enough distance from each other and from
/// the mean.
fn four_of(atoms: &[f64], places: &[f64]) -> Option<Vec<f64>> {
    let &[left, inner_left, inner_right, right] = places else { return None };
    let side = |outer: f64, inner: f64| {
        let outer = nearest(atoms, outer)?;
        let apart = |u: &f64| u.abs() >= NEAREST && (u - outer).abs() >= 0.5 * NEAREST;
        let others: Vec<f64> = atoms.iter().copied().filter(apart).collect();
        let inner = nearest(&others, inner)?;
        Some([outer.min(inner), outer.max(inner)])
    };
    Some([side(left, inner_left)?, side(right, inner_right)?].concat())
}

/// Rule with these nodes and the mean that matches the moments up to the fourth. Returns None if one of its weights is negative.
fn rule_at(distribution: &dyn Distribution, u: &[f64]) -> Option<Rule> {
    let moments = distribution.standard_moments();
    let mut nodes: Vec<f64> = u.iter().copied().chain([0.0]).collect();
    nodes.sort_unstable_by(f64::total_cmp);
    let moments = [1.0, 0.0, 1.0, moments.skewness, moments.kurtosis()];
    // The weight of a node is the mean of its Lagrange polynomial, by its coefficients.
    let weight = |i: usize| {
        let mut coefficients = vec![1.0];
        for j in (0..nodes.len()).filter(|&j| j != i) {
            let scale = 1.0 / (nodes[i] - nodes[j]);
            coefficients.push(0.0);
            for k in (0..coefficients.len()).rev() {
                let below = if k > 0 { coefficients[k - 1] } else { 0.0 };
                coefficients[k] = (below - nodes[j] * coefficients[k]) * scale;
            }
        }
        coefficients.iter().zip(moments).map(|(c, moment)| c * moment).sum::<f64>()
    };
    let weights: Vec<f64> = (0..nodes.len()).map(weight).collect();
    weights.iter().all(|&weight| weight >= 0.0).then_some(Rule { nodes, weights })
}

/// Reaches of the moments of distributions. Equal distributions share the computation of eigenvalues.
#[derive(Debug, Default)]
pub(super) struct Reaches(Vec<(Jacobi, f64)>);

impl Reaches {
    fn of(&mut self, distribution: &dyn Distribution) -> f64 {
        let jacobi = distribution.jacobi(REACH);
        if let Some((_, reach)) = self.0.iter().find(|(of, _)| *of == jacobi) {
            return *reach;
        }
        let reach = jacobi.gauss().nodes.iter().fold(0.0f64, |reach, u| reach.max(u.abs()));
        self.0.push((jacobi, reach));
        reach
    }
}

fn pair(distribution: &dyn Distribution, [lower, upper]: [f64; 2]) -> (Vec<f64>, Vec<MovedNode>) {
    let moments = distribution.standard_moments();
    // Replace an infinite moment by that of a normal distribution, so that the model can be evaluated.
    let known = |moment: f64, normal: f64| if moment.is_finite() { moment } else { normal };
    let (s, kurtosis) = (known(moments.skewness, 0.0), known(moments.kurtosis(), 3.0));
    let half = (kurtosis - 0.75 * s * s).sqrt();
    let wanted = [0.5 * s - half, 0.5 * s + half];
    // If the support allows, the other node goes to s - u, which keeps the third moment.
    let within = |u: f64| u.clamp(INSIDE * lower, INSIDE * upper);
    let u = match wanted {
        [left, _] if left <= lower => [within(left), within(s - within(left))],
        [_, right] if right >= upper => [within(s - within(right)), within(right)],
        inside => inside,
    };
    (u.map(|u| u.clamp(-FARTHEST, FARTHEST)).to_vec(), moved(&wanted, &u, [lower, upper]))
}

/// Four nodes beside the mean, and the rule with positive weights that they belong to. Returns None if they do not suit the support.
fn five(distribution: &dyn Distribution, [lower, upper]: [f64; 2]) -> Option<(Vec<f64>, Rule)> {
    let jacobi = distribution.jacobi(4);
    let usable = |u: &[f64]| {
        let [first, .., last] = u else { return false };
        let inside = *first > lower && *last < upper && first.abs().max(last.abs()) <= FARTHEST;
        u.len() == 4 && inside && *first < 0.0 && *last > 0.0
    };
    if let Some(rule) = jacobi.gauss_with_mean() {
        let u: Vec<f64> = rule.nodes.iter().copied().filter(|&u| u != 0.0).collect();
        if usable(&u) {
            return Some((u, rule));
        }
    }
    let rule = jacobi.gauss();
    let apart = |&u: &f64| {
        let away = if u.abs() < NEAREST { NEAREST.copysign(u) } else { u };
        away.clamp(INSIDE * lower, INSIDE * upper)
    };
    let u: Vec<f64> = rule.nodes.iter().map(apart).collect();
    (usable(&u) && u.windows(2).all(|pair| pair[1] - pair[0] >= 0.5 * NEAREST)).then_some((u, rule))
}

/// Nodes that are outside the support before the move. A partner that moves with one of them does not count.
fn moved(wanted: &[f64], u: &[f64], [lower, upper]: [f64; 2]) -> Vec<MovedNode> {
    let outside = |from: f64| from <= lower || from >= upper;
    let both = wanted.iter().zip(u).filter(|(from, _)| outside(**from));
    both.map(|(&from, &to)| MovedNode { from, to }).collect()
}
