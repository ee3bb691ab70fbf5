//! Distribution as a fine quadrature with positive weights, a stable way to moments and recurrences without a closed form.

use crate::distribution::{Distribution, Jacobi, StandardMoments, Uniform};
use crate::power::Power;

/// Greatest order of recurrences that are computed once and kept.
pub(in crate::distribution) const ORDER: usize = 16;

/// Points and their probabilities, which need not sum to 1.
#[derive(Debug, Clone, Default)]
pub(in crate::distribution) struct Discretised {
    pub(in crate::distribution) points: Vec<f64>,
    pub(in crate::distribution) weights: Vec<f64>,
}

impl Discretised {
    pub(in crate::distribution) fn push(&mut self, point: f64, weight: f64) {
        if weight > 0.0 {
            self.points.push(point);
            self.weights.push(weight);
        }
    }

    /// Adds a density over an interval by this Gauss-Legendre rule of [`legendre`].
    pub(in crate::distribution) fn piece(
        &mut self,
        [from, to]: [f64; 2],
        rule: &[(f64, f64)],
        density: impl Fn(f64) -> f64,
    ) {
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        for (node, weight) in rule {
            let x = middle + half * node;
            self.push(x, half * weight * density(x));
        }
    }

    /// Moves and scales the points to mean 0 and variance 1. Returns their previous mean and sigma.
    pub(in crate::distribution) fn standardise(&mut self) -> [f64; 2] {
        let total: f64 = self.weights.iter().sum();
        self.weights.iter_mut().for_each(|weight| *weight /= total);
        let mean = self.mean(|x| x);
        self.points.iter_mut().for_each(|point| *point -= mean);
        // Remove the rest that the rounding of the mean has left.
        let rest = self.mean(|x| x);
        self.points.iter_mut().for_each(|point| *point -= rest);
        // Scale to a unit of their own, so that squares of extreme points do not overflow.
        let unit = Power::of(self.points.iter().fold(0.0, |size: f64, point| size.max(point.abs())));
        self.points.iter_mut().for_each(|point| *point = unit.inverse().times(*point));
        let sigma = self.mean(|x| x * x).sqrt();
        self.points.iter_mut().for_each(|point| *point /= sigma);
        [mean + rest, unit.times(sigma)]
    }

    fn mean(&self, f: impl Fn(f64) -> f64) -> f64 {
        self.points.iter().zip(&self.weights).map(|(&x, &weight)| weight * f(x)).sum()
    }

    /// Moments of the standardised points.
    pub(in crate::distribution) fn moments(&self) -> StandardMoments {
        StandardMoments::from_standard([3, 4, 5, 6, 7, 8].map(|order| self.mean(|u| u.powi(order))))
    }

    /// Recurrence of the standardised points, by the procedure of Stieltjes (Gautschi 2004, 2.2.3.1) with orthonormal polynomials. It ends
    /// early if there are fewer points than `order`.
    pub(in crate::distribution) fn jacobi(&self, order: usize) -> Jacobi {
        let (mut alpha, mut beta) = (Vec::with_capacity(order), Vec::with_capacity(order));
        let (mut before, mut current) = (vec![0.0; self.points.len()], vec![1.0; self.points.len()]);
        let mut root = 0.0;
        let inner = |p: &[f64], f: &dyn Fn(f64) -> f64| -> f64 {
            p.iter().zip(&self.points).zip(&self.weights).map(|((p, &u), weight)| weight * p * p * f(u)).sum()
        };
        for n in 0..order {
            let centre = inner(&current, &|u| u);
            let next: Vec<f64> = (current.iter().zip(&before).zip(&self.points))
                .map(|((p, before), u)| (u - centre) * p - root * before)
                .collect();
            let norm = inner(&next, &|_| 1.0);
            alpha.push(centre);
            if n + 1 >= self.points.len() {
                beta.push(0.0);
                break;
            }
            beta.push(norm);
            root = norm.sqrt();
            before = std::mem::replace(&mut current, next);
            current.iter_mut().for_each(|p| *p /= root);
        }
        Jacobi::new(alpha, beta)
    }

    /// [`jacobi`](Self::jacobi) of a symmetric distribution, made symmetric to the last bit.
    pub(in crate::distribution) fn symmetric_jacobi(&self, order: usize) -> Jacobi {
        self.jacobi(order).symmetric()
    }
}

/// Nodes and weights of Gauss-Legendre on -1 ..= 1, with weights that sum to 2.
pub(in crate::distribution) fn legendre(nodes: usize) -> Vec<(f64, f64)> {
    let uniform = Uniform::about(0.0, 1.0).expect("a valid interval");
    let rule = uniform.jacobi(nodes).gauss();
    rule.nodes.iter().map(|node| node / 3f64.sqrt()).zip(rule.weights.iter().map(|weight| 2.0 * weight)).collect()
}
