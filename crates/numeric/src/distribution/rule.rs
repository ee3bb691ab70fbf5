//! Gauss rules of a distribution, from the recurrence of its orthogonal polynomials (Golub and Welsch 1969).

use faer::{Mat, Side};

use crate::distribution::{Distribution, DistributionError, StandardMoments};

/// Recurrence of the monic orthogonal polynomials of a standardised variable:
/// `p[n+1] = (u - alpha[n]) p[n] - beta[n] p[n-1]`, with `alpha[0..n]` and `beta[1..=n]`.
///
/// A last beta of 0 means that the distribution consists of exactly as many atoms as the order.
#[derive(Debug, Clone, PartialEq)]
pub struct Jacobi {
    alpha: Vec<f64>,
    beta: Vec<f64>,
}

/// Relative pivot below which a leading moment matrix counts as singular. The moments of a distribution with few atoms are only as exact as
/// they were typed. The pivot is relative to the last diagonal element.
const SINGULAR: f64 = 1e-12;
/// Relative size of a negative pivot above which the moments are impossible.
const IMPOSSIBLE: f64 = 1e-9;

impl Jacobi {
    /// Recurrence with `alpha[0 ..= n-1]` and `beta[1 ..= n]`, equally many of both.
    pub fn new(alpha: Vec<f64>, beta: Vec<f64>) -> Self {
        assert_eq!(alpha.len(), beta.len(), "a Jacobi matrix needs as many alphas as betas");
        Self { alpha, beta }
    }

    /// Recurrence of order 4, or of as many atoms as there are, from moments 3 to 8 by the Chebyshev algorithm (Gautschi 1982).
    ///
    /// # Errors
    /// [`DistributionError::ImpossibleMoments`] if a leading moment matrix has a negative determinant.
    pub fn from_moments(moments: &StandardMoments) -> Result<Self, DistributionError> {
        let raw = moments.raw();
        let (mut alpha, mut beta) = (vec![0.0], Vec::new());
        // Row n holds E[p_n u^l]; its diagonal element is E[p_n^2], the pivot of the moment matrix of order 2n.
        let (mut previous, mut current) = ([0.0; 9], raw);
        for n in 1..=4 {
            let mut next = [0.0; 9];
            let before = beta.last().copied().unwrap_or(0.0);
            for l in n..=8 - n {
                next[l] = current[l + 1] - alpha[n - 1] * current[l] - before * previous[l];
            }
            let (pivot, scale) = (next[n], raw[2 * n]);
            if pivot < -IMPOSSIBLE * scale {
                return Err(DistributionError::ImpossibleMoments { moment: 2 * n, pivot });
            }
            if pivot <= SINGULAR * scale {
                beta.push(0.0);
                break;
            }
            beta.push(pivot / current[n - 1]);
            if n < 4 {
                alpha.push(next[n + 1] / next[n] - current[n] / current[n - 1]);
            }
            (previous, current) = (current, next);
        }
        Ok(Self { alpha, beta })
    }

    /// Number of coefficients of each kind.
    pub fn order(&self) -> usize {
        self.alpha.len()
    }

    /// Recurrence of the mirrored variable `-u`.
    pub(super) fn mirrored(mut self) -> Self {
        self.alpha.iter_mut().for_each(|alpha| *alpha = -*alpha);
        self
    }

    /// First `order` coefficients, or all if there are fewer.
    pub(crate) fn truncated(&self, order: usize) -> Self {
        let order = order.min(self.order());
        Self { alpha: self.alpha[..order].to_vec(), beta: self.beta[..order].to_vec() }
    }

    /// Copy with every alpha 0. In the recurrence of a symmetric distribution they differ from 0 only by rounding.
    pub(super) fn symmetric(mut self) -> Self {
        self.alpha.fill(0.0);
        self
    }

    /// True if the recurrence describes the whole distribution: one of as many atoms as its order.
    pub(crate) fn is_whole(&self) -> bool {
        self.beta.last() == Some(&0.0)
    }

    /// Gauss rule with as many nodes as the order, exact for polynomials up to degree `2 order - 1`.
    pub fn gauss(&self) -> Rule {
        Rule::of_matrix(&self.alpha, &self.beta[..self.order() - 1])
    }

    /// Rule with one node more than the order, one of them at the mean, exact up to degree `2 order`.
    ///
    /// Returns None if no such rule exists. The Gauss rule then already has a node there, as for an odd number of atoms about its mean. Or
    /// it nearly has one, so that the extra node would lie far out.
    pub fn gauss_with_mean(&self) -> Option<Rule> {
        let (mut before, mut at_mean) = (0.0, 1.0);
        for n in 0..self.order() {
            let beta = if n == 0 { 0.0 } else { self.beta[n - 1] };
            (before, at_mean) = (at_mean, -self.alpha[n] * at_mean - beta * before);
        }
        let last = self.beta[self.order() - 1];
        let corner = -last * before / at_mean;
        let mut alpha = self.alpha.clone();
        alpha.push(corner);
        if last == 0.0 || !corner.is_finite() {
            return None;
        }
        let mut rule = Rule::of_matrix(&alpha, &self.beta);
        let centre = (0..rule.nodes.len()).min_by(|&i, &j| rule.nodes[i].abs().total_cmp(&rule.nodes[j].abs()))?;
        rule.nodes[centre] = 0.0;
        Some(rule)
    }
}

/// Nodes and weights of a quadrature over a standardised variable; the weights sum to 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Rule {
    /// Nodes in units of sigma about the mean, ascending.
    pub nodes: Vec<f64>,
    /// Probabilities of the nodes.
    pub weights: Vec<f64>,
}

impl Rule {
    /// Gauss rule of a distribution with this number of nodes, exact for polynomials up to degree `2 nodes - 1`. A distribution with fewer
    /// atoms gives all of its atoms.
    ///
    /// Moments 2 to 8 alone determine rules of at most five nodes. Of five nodes one is the mean, and the rule is exact up to degree 8.
    ///
    /// ```
    /// use sensitol_numeric::distribution::{Distribution, Exponential};
    /// use sensitol_numeric::distribution::rule::Rule;
    /// // E u^5 = 44 of an exponential distribution, by three nodes.
    /// let rule = Rule::of(&Exponential::new(0.0, 1.0)?, 3);
    /// assert!((rule.mean(|u| u.powi(5)) - 44.0).abs() < 1e-12);
    /// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
    /// ```
    pub fn of(distribution: &dyn Distribution, nodes: usize) -> Self {
        let jacobi = distribution.jacobi(nodes);
        match jacobi.order() < nodes && !jacobi.is_whole() {
            true => jacobi.gauss_with_mean().unwrap_or_else(|| jacobi.gauss()),
            false => jacobi.gauss(),
        }
    }

    /// Rule with the mean and one node on either side that match moments 1 to 4. If one of these would lie outside the support, the Gauss
    /// rule of three nodes, which matches five.
    ///
    /// The nodes are `s/2 +- sqrt(f - 3 s^2/4)` with skewness `s` and kurtosis `f`. A distribution of two or three atoms gives its atoms.
    ///
    /// Source: Seo and Kwak (2002), equations for the levels and weights of an input.
    pub fn three_point(distribution: &dyn Distribution) -> Self {
        let all = distribution.jacobi(3);
        if all.is_whole() {
            return all.gauss();
        }
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        let [lower, upper] = distribution.support().map(|edge| (edge - mean) / sigma);
        let matched = distribution.jacobi(2).gauss_with_mean();
        let inside = |rule: &Self| rule.nodes.iter().all(|&u| lower <= u && u <= upper);
        matched.filter(inside).unwrap_or_else(|| Self::of(distribution, 3))
    }

    /// Expectation `E[f(u)]` by this rule.
    ///
    /// ```
    /// use sensitol_numeric::distribution::{Distribution, Normal};
    /// let rule = Normal::new(0.0, 1.0)?.jacobi(5).gauss();
    /// assert!((rule.mean(|u| u.powi(8)) - 105.0).abs() < 1e-11);
    /// # Ok::<(), sensitol_numeric::distribution::DistributionError>(())
    /// ```
    pub fn mean(&self, f: impl Fn(f64) -> f64) -> f64 {
        self.nodes.iter().zip(&self.weights).map(|(&u, &weight)| weight * f(u)).sum()
    }

    /// Node at the probability `level` from below. For powers that the rule integrates exactly it is as good as a quantile of the
    /// distribution.
    pub fn at_level(&self, level: f64) -> f64 {
        let mut below = 0.0;
        for (node, weight) in self.nodes.iter().zip(&self.weights) {
            below += weight;
            if level < below {
                return *node;
            }
        }
        self.nodes[self.nodes.len() - 1]
    }

    fn of_matrix(diagonal: &[f64], squared_off_diagonal: &[f64]) -> Self {
        let n = diagonal.len();
        let matrix = Mat::from_fn(n, n, |i, j| match i.abs_diff(j) {
            0 => diagonal[i],
            1 => squared_off_diagonal[i.min(j)].sqrt(),
            _ => 0.0,
        });
        let eigen = matrix
            .self_adjoint_eigen(Side::Lower)
            .expect("the eigenvalues of a small symmetric matrix of finite numbers");
        let mut nodes: Vec<f64> = (0..n).map(|i| eigen.S()[i]).collect();
        let mut weights: Vec<f64> = (0..n).map(|i| eigen.U()[(0, i)].powi(2)).collect();
        // Eigenvalues are exact relative to the largest of them, weights relative to 1. A far node of a long tail needs relative accuracy
        // of its own, because high powers of it count. Heavier nodes have it already, and for nodes close together the polynomials would
        // lose digits.
        let light: Vec<usize> = (0..n).filter(|&i| weights[i] < LIGHT).collect();
        for i in light {
            let left = if i > 0 { nodes[i] - nodes[i - 1] } else { f64::INFINITY };
            let right = if i + 1 < n { nodes[i + 1] - nodes[i] } else { f64::INFINITY };
            if let Some((node, weight)) = polished(nodes[i], 1e-3 * left.min(right), diagonal, squared_off_diagonal) {
                (nodes[i], weights[i]) = (node, weight);
            }
        }
        if diagonal.iter().all(|&alpha| alpha == 0.0) {
            // A symmetric distribution gets a rule that is symmetric to the last bit, so that its odd moments are exactly 0.
            for i in 0..n.div_ceil(2) {
                let (node, weight) = (0.5 * (nodes[n - 1 - i] - nodes[i]), 0.5 * (weights[i] + weights[n - 1 - i]));
                (nodes[i], nodes[n - 1 - i]) = (-node, node);
                (weights[i], weights[n - 1 - i]) = (weight, weight);
            }
        }
        let total: f64 = weights.iter().sum();
        weights.iter_mut().for_each(|weight| *weight /= total);
        Self { nodes, weights }
    }
}

/// Weight below which the square of an eigenvector's component has lost digits.
const LIGHT: f64 = 1e-4;

/// Node after one step of Newton's method towards the root of the last orthogonal polynomial, and its weight. The weight is one over the
/// sum of the squares of the orthonormal polynomials below it (Christoffel), in which nothing cancels. Returns None if the step is longer
/// than `within`, or if a double does not hold the result.
fn polished(node: f64, within: f64, alpha: &[f64], beta: &[f64]) -> Option<(f64, f64)> {
    let at = |u: f64| {
        let ([mut before, mut p], [mut slope_before, mut slope]) = ([0.0, 1.0], [0.0, 0.0]);
        let mut sum = 1.0;
        for n in 0..alpha.len() {
            let root = if n == 0 { 0.0 } else { beta[n - 1].sqrt() };
            // The last polynomial has no norm of its own. Its root does not depend on one.
            let norm = beta.get(n).map_or(1.0, |beta| beta.sqrt());
            let next = ((u - alpha[n]) * p - root * before) / norm;
            let next_slope = (p + (u - alpha[n]) * slope - root * slope_before) / norm;
            (before, p, slope_before, slope) = (p, next, slope, next_slope);
            sum += if n + 1 < alpha.len() { p * p } else { 0.0 };
        }
        (p / slope, 1.0 / sum)
    };
    let (step, _) = at(node);
    let node = node - step;
    let weight = at(node).1;
    (step.abs() <= within && node.is_finite() && weight.is_finite() && weight > 0.0).then_some((node, weight))
}
