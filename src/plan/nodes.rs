//! Where on its axis a dimension is evaluated, in units of its sigma about its mean.

use crate::distribution::Distribution;

/// How many nodes an axis has beside the mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Spread {
    /// None: derivatives come from elsewhere.
    Bare,
    /// Two: slope and curvature.
    Pair,
    /// Four: up to the fourth derivative.
    Five,
}

/// The nodes that suit a distribution, and what had to be moved.
#[derive(Debug, Clone, PartialEq)]
pub struct Nodes {
    /// In sigmas, ascending, without the mean.
    pub u: Vec<f64>,
    /// Nodes that would have lain outside the support.
    pub moved: Vec<Moved>,
}

/// A node that was moved into the support.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Moved {
    /// Where the moments want it, in sigmas.
    pub from: f64,
    /// Where it is, in sigmas.
    pub to: f64,
}

/// A node outside the support goes this far of the way from the mean to the edge.
const INSIDE: f64 = 0.95;
/// Moments alone may want a node farther out than any model should be asked.
const FARTHEST: f64 = 8.0;

impl Nodes {
    /// The moment-optimal nodes.
    ///
    /// A pair is matched to the moments up to the fourth: `u± = s/2 ± sqrt(f - 3 s^2/4)` with skewness `s` and kurtosis
    /// `f`, normal ±sqrt 3. Five points are matched to the moments up to the eighth, with the mean among them: for a
    /// normal the Gauss-Hermite nodes. With fewer than five atoms, or where the fifth point would lie too far out, five
    /// points fall back to the pair.
    pub fn matched(distribution: &dyn Distribution, spread: Spread) -> Self {
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        let support = distribution.support().map(|edge| (edge - mean) / sigma);
        match spread {
            Spread::Bare => Self { u: Vec::new(), moved: Vec::new() },
            Spread::Pair => Self::pair(distribution, support),
            Spread::Five => Self::five(distribution, support),
        }
    }

    /// At one and, for five points, two times the step on either side.
    pub fn stepped(step: f64, spread: Spread) -> Self {
        let u = match spread {
            Spread::Bare => Vec::new(),
            Spread::Pair => vec![-step, step],
            Spread::Five => vec![-2.0 * step, -step, step, 2.0 * step],
        };
        Self { u, moved: Vec::new() }
    }

    fn pair(distribution: &dyn Distribution, [lower, upper]: [f64; 2]) -> Self {
        let moments = distribution.standard_moments();
        let s = moments.skewness;
        let half = (moments.kurtosis() - 0.75 * s * s).sqrt();
        let wanted = [0.5 * s - half, 0.5 * s + half];
        // The other node goes to s - u, which keeps the third moment, if the support allows.
        let within = |u: f64| u.clamp(INSIDE * lower, INSIDE * upper);
        let u = match wanted {
            [left, _] if left <= lower => [within(left), within(s - within(left))],
            [_, right] if right >= upper => [within(s - within(right)), within(right)],
            inside => inside,
        };
        Self { u: u.to_vec(), moved: moved(&wanted, &u) }
    }

    fn five(distribution: &dyn Distribution, support: [f64; 2]) -> Self {
        let [lower, upper] = support;
        let rule = distribution.jacobi(4).gauss_with_mean();
        let wanted: Vec<f64> = match rule {
            Some(rule) if rule.nodes.len() == 5 => rule.nodes.into_iter().filter(|&u| u != 0.0).collect(),
            _ => return Self::pair(distribution, support),
        };
        let beyond = |u: f64| u <= lower || u >= upper;
        let spread_out = wanted.iter().any(|u| u.abs() > FARTHEST) || wanted[0] > 0.0 || wanted[3] < 0.0;
        if spread_out {
            return Self::pair(distribution, support);
        }
        if !wanted.iter().any(|&u| beyond(u)) {
            return Self { u: wanted, moved: Vec::new() };
        }
        // All nodes of a side shrink together, so that they stay apart.
        let factor = |edge: f64, outermost: f64| {
            if beyond(outermost) { INSIDE * edge / outermost } else { 1.0 }
        };
        let (left, right) = (factor(lower, wanted[0]), factor(upper, wanted[3]));
        let u: Vec<f64> = wanted.iter().map(|&u| if u < 0.0 { left * u } else { right * u }).collect();
        Self { moved: moved(&wanted, &u), u }
    }
}

fn moved(wanted: &[f64], u: &[f64]) -> Vec<Moved> {
    wanted.iter().zip(u).filter(|(from, to)| from != to).map(|(&from, &to)| Moved { from, to }).collect()
}
