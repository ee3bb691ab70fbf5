//! Distribution that is known by a table of its quantiles.

use crate::distribution::family::discretised::{Discretised, ORDER, legendre};
use crate::distribution::inverse::root;
use crate::distribution::probability::{checked, clamped};
use crate::distribution::{
    Distribution, DistributionError, Jacobi, Probability, StandardMoments, finite, standard_normal,
};

/// Table of quantiles over normal scores: the value at the score `z` has the probability `Phi(z)` below it.
///
/// Between the lines of the table the value is a monotone cubic of the score (Fritsch and Carlson 1980). Its slopes are those of the
/// polynomial through five lines. With lines `h` apart, a smooth distribution is met to the order `h^4`.
///
/// The table's first and last line are the ends of the support. A normal distribution has a little probability beyond their scores, which
/// is spread over the table, so that the total is 1. Over scores most distributions are nearly straight, over probabilities they are not.
///
/// ```
/// use sensitol_numeric::distribution::{Distribution, Tabulated};
/// // A straight line over the scores is a normal distribution, cut at the ends of the table.
/// let pin = Tabulated::new(&[-6.0, 0.0, 6.0], &[9.94, 10.0, 10.06])?;
/// assert!((pin.sigma() - 0.01).abs() < 1e-8);
/// let law = pin.probability().expect("a table is known whole");
/// assert!((law.sf(10.03) - 1.349_898e-3).abs() < 1e-8);
/// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Tabulated {
    scores: Vec<f64>,
    values: Vec<f64>,
    /// Slope of the value by the score, at every line.
    slopes: Vec<f64>,
    /// Probability of a normal distribution below the table. `within` and `above` are those inside and above it.
    below: f64,
    within: f64,
    above: f64,
    mean: f64,
    sigma: f64,
    moments: StandardMoments,
    jacobi: Jacobi,
}

/// Greatest score. Beyond it a double cannot distinguish the probability from 0.
const FARTHEST: f64 = 37.0;
/// Greatest number of lines at which the joints count as corners. A longer table is smooth enough for a quadrature.
const JOINTS: usize = 33;
/// Widest piece, in scores, that one rule of quadrature covers.
const WIDEST: f64 = 0.25;
/// Least slope as a fraction of the lesser secant beside it, so that no density is infinite.
const LEAST: f64 = 1e-3;

impl Tabulated {
    /// Distribution from equally many scores and values, at least two, both ascending.
    ///
    /// # Errors
    /// Returns an error if the two differ in length, a number is not finite, or one is not above the previous one.
    pub fn new(scores: &[f64], values: &[f64]) -> Result<Self, DistributionError> {
        let wrong = |reason: String| Err(DistributionError::NoLaw { reason });
        if scores.len() != values.len() || scores.len() < 2 {
            return wrong(format!(
                "a table needs as many scores as values, two at least, and has {} and {}",
                scores.len(),
                values.len()
            ));
        }
        for (name, column) in [("score", scores), ("value", values)] {
            for &one in column {
                finite(name, one)?;
            }
            if let Some(pair) = column.windows(2).find(|pair| pair[1] <= pair[0]) {
                return wrong(format!(
                    "every {name} of a table must be above that before it, and {} follows {}",
                    pair[1], pair[0]
                ));
            }
        }
        if let Some(score) = scores.iter().find(|score| score.abs() > FARTHEST) {
            return wrong(format!(
                "scores of a table are those of a normal distribution, from -{FARTHEST} to {FARTHEST}, not {score}"
            ));
        }
        // The table covers only this part of the normal distribution's probability; take it from the nearer tail to keep its digits.
        let (first, last) = (scores[0], scores[scores.len() - 1]);
        let (below, above) = (standard_normal::cdf(first), standard_normal::sf(last));
        let within = if first > 0.0 { standard_normal::sf(first) - above } else { standard_normal::cdf(last) - below };
        let mut law = Self {
            slopes: slopes(scores, values),
            scores: scores.to_vec(),
            values: values.to_vec(),
            below,
            within,
            above,
            mean: 0.0,
            sigma: 0.0,
            moments: StandardMoments::from_standard([0.0; 6]),
            jacobi: Jacobi::new(Vec::new(), Vec::new()),
        };
        // Moments and recurrence follow from the finished cubics.
        let mut fine = law.discretised();
        [law.mean, law.sigma] = fine.standardise();
        (law.moments, law.jacobi) = (fine.moments(), fine.jacobi(ORDER));
        if !(law.sigma > 0.0 && law.sigma.is_finite() && law.mean.is_finite() && law.moments.are_finite()) {
            return wrong("its moments are beyond the range of a double".to_owned());
        }
        Ok(law)
    }

    /// Quadrature by Gauss-Legendre over the scores, piece by piece. On each piece the value is a cubic and the density is entire.
    fn discretised(&self) -> Discretised {
        let rule = legendre(16);
        let mut fine = Discretised::default();
        for piece in 0..self.scores.len() - 1 {
            let [from, to] = [self.scores[piece], self.scores[piece + 1]];
            let parts = ((to - from) / WIDEST).ceil().max(1.0);
            let half = 0.5 * (to - from) / parts;
            for part in 0..parts as usize {
                let middle = from + half * (2 * part + 1) as f64;
                for (node, weight) in &rule {
                    let z = middle + half * node;
                    fine.push(self.at(piece, z)[0], weight * half * standard_normal::density(z));
                }
            }
        }
        fine
    }

    /// Value and slope at a score of this piece, by Hermite's cubic.
    fn at(&self, piece: usize, z: f64) -> [f64; 2] {
        let width = self.scores[piece + 1] - self.scores[piece];
        let rise = self.values[piece + 1] - self.values[piece];
        let (a, b) = (self.slopes[piece] * width, self.slopes[piece + 1] * width);
        let t = (z - self.scores[piece]) / width;
        let (square, cube) = (3.0 * rise - 2.0 * a - b, a + b - 2.0 * rise);
        let value = self.values[piece] + t * (a + t * (square + t * cube));
        [value, (a + t * (2.0 * square + 3.0 * t * cube)) / width]
    }

    fn value_at(&self, z: f64) -> f64 {
        let last = self.scores.len() - 1;
        if z <= self.scores[0] {
            return self.values[0];
        }
        if z >= self.scores[last] {
            return self.values[last];
        }
        let piece = self.scores.partition_point(|&score| score <= z) - 1;
        self.at(piece, z)[0].clamp(self.values[piece], self.values[piece + 1])
    }

    /// Score of a value within the support, and the slope at that score.
    fn score(&self, x: f64) -> [f64; 2] {
        let piece = self.values.partition_point(|&value| value <= x).clamp(1, self.values.len() - 1) - 1;
        let [from, to] = [self.scores[piece], self.scores[piece + 1]];
        let share = (x - self.values[piece]) / (self.values[piece + 1] - self.values[piece]);
        let off = |z: f64| {
            let [value, slope] = self.at(piece, z);
            (value - x, slope)
        };
        let z = root([from, to], from + share * (to - from), off).clamp(from, to);
        [z, self.at(piece, z)[1]]
    }
}

/// Slope at every line: that of the polynomial through the five lines about it, limited so that the cubics stay ascending.
fn slopes(scores: &[f64], values: &[f64]) -> Vec<f64> {
    let lines = scores.len();
    let secant = |i: usize| (values[i + 1] - values[i]) / (scores[i + 1] - scores[i]);
    (0..lines)
        .map(|i| {
            let from = i.saturating_sub(2).min(lines.saturating_sub(5));
            let stencil = from..lines.min(from + 5);
            let slope = polynomial_slope(&scores[stencil.clone()], &values[stencil], i - from);
            let beside = [i.checked_sub(1).map(secant), (i + 1 < lines).then(|| secant(i))];
            let least = beside.into_iter().flatten().fold(f64::INFINITY, f64::min);
            // Three times the lesser secant is the bound of Fritsch and Carlson.
            slope.clamp(LEAST * least, 3.0 * least)
        })
        .collect()
}

/// Slope of the polynomial through all points, at one of them.
fn polynomial_slope(x: &[f64], y: &[f64], at: usize) -> f64 {
    let others = |j: usize| (0..x.len()).filter(move |&m| m != j && m != at);
    (0..x.len())
        .filter(|&j| j != at)
        .map(|j| {
            // Term of the rise from `at` to `j` in Lagrange's basis. Rises instead of values avoid cancellation.
            let basis: f64 = others(j).map(|m| (x[at] - x[m]) / (x[j] - x[m])).product();
            (y[j] - y[at]) / (x[j] - x[at]) * basis
        })
        .sum()
}

impl Distribution for Tabulated {
    fn name(&self) -> &'static str {
        "tabulated"
    }

    fn mean(&self) -> f64 {
        self.mean
    }

    fn sigma(&self) -> f64 {
        self.sigma
    }

    fn standard_moments(&self) -> StandardMoments {
        self.moments
    }

    fn support(&self) -> [f64; 2] {
        [self.values[0], self.values[self.values.len() - 1]]
    }

    /// Coefficients up to order 16.
    fn jacobi(&self, order: usize) -> Jacobi {
        self.jacobi.truncated(order)
    }

    fn probability(&self) -> Option<&dyn Probability> {
        Some(self)
    }
}

impl Probability for Tabulated {
    fn density(&self, x: f64) -> Option<f64> {
        let [lower, upper] = self.support();
        if x.is_nan() {
            return Some(f64::NAN);
        }
        if x < lower || x > upper {
            return Some(0.0);
        }
        let [z, slope] = self.score(x);
        Some(standard_normal::density(z) / (slope * self.within))
    }

    fn cdf(&self, x: f64) -> f64 {
        let [lower, upper] = self.support();
        match x {
            _ if x.is_nan() => f64::NAN,
            _ if x <= lower => 0.0,
            _ if x >= upper => 1.0,
            _ => clamped((standard_normal::cdf(self.score(x)[0]) - self.below) / self.within),
        }
    }

    fn sf(&self, x: f64) -> f64 {
        let [lower, upper] = self.support();
        match x {
            _ if x.is_nan() => f64::NAN,
            _ if x <= lower => 1.0,
            _ if x >= upper => 0.0,
            _ => clamped((standard_normal::sf(self.score(x)[0]) - self.above) / self.within),
        }
    }

    fn quantile(&self, p: f64) -> f64 {
        match checked(p) {
            p if p.is_nan() => p,
            0.0 => self.values[0],
            1.0 => self.values[self.values.len() - 1],
            p => self.value_at(standard_normal::quantile(self.below + p * self.within)),
        }
    }

    fn upper_quantile(&self, p: f64) -> f64 {
        match checked(p) {
            p if p.is_nan() => p,
            0.0 => self.values[self.values.len() - 1],
            1.0 => self.values[0],
            p => self.value_at(standard_normal::upper_quantile(self.above + p * self.within)),
        }
    }

    fn corners(&self) -> Vec<f64> {
        match self.values.len() {
            lines if lines <= JOINTS => self.values[1..lines - 1].to_vec(),
            _ => Vec::new(),
        }
    }
}
