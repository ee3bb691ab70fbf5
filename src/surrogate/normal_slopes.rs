//! How the moments of a surface of normal inputs grow with the tolerances: all of them from one product of matrices.
//!
//! ```text
//! y = c + b'z + z'Az/2,   P = A A,   by ln T_j, which scales b_j, and the row and the column j of A:
//! k1 = c + tr A/2          A_jj
//! k2 = b'b + tr P/2        2 b_j^2 + 2 P_jj
//! k3 = 3 b'Ab + tr PA      12 b_j (Ab)_j + 6 sum_k P_jk A_jk
//! k4 = 12 b'Pb + 3 |P|^2   48 b_j (Pb)_j + 24 (Ab)_j^2 + 24 sum_k P_jk^2
//! ```
//!
//! Source of the cumulants: A. M. Mathai, S. B. Provost, "Quadratic forms in random variables", Dekker (1992), section 3.2b.

use faer::Mat;

use super::{Inputs, Surrogate};
use crate::distribution::StandardMoments;

impl Surrogate {
    /// Derivatives of mean, `ln sigma`, skewness and excess by the logarithm of every input's scale, at fixed means. None where an input is not
    /// normal, inputs are correlated, a part is unknown or not a parabola, or nothing varies.
    ///
    /// Cost: one product of N by N matrices where inputs interact.
    pub(crate) fn normal_slopes(&self, inputs: &Inputs) -> Option<Vec<[f64; 4]>> {
        let normal = inputs.shapes().iter().all(|shape| shape.moments == StandardMoments::NORMAL);
        if !normal || inputs.correlation().is_some() {
            return None;
        }
        let n = self.parts.len();
        let (mut b, mut diagonal) = (vec![0.0; n], vec![0.0; n]);
        for (j, part) in self.parts.iter().enumerate() {
            let [slope, square, cube, fourth] = (*part)?.coefficients();
            if cube != 0.0 || fourth != 0.0 {
                return None;
            }
            (b[j], diagonal[j]) = (slope, 2.0 * square);
        }
        let pairs = self.interactions.pairs();
        // For every input: (Ab)_j, (Pb)_j, P_jj, sum P A, sum P P, with |A|^2, b'Ab and so on as sums of them.
        let of: Vec<[f64; 5]> = match pairs.iter().all(|&(_, _, product)| product == 0.0) {
            true => (0..n)
                .map(|j| {
                    let (a, b) = (diagonal[j], b[j]);
                    [a * b, a * a * b, a * a, a * a * a, a * a * a * a]
                })
                .collect(),
            false => {
                let mut a = Mat::<f64>::zeros(n, n);
                (0..n).for_each(|j| a[(j, j)] = diagonal[j]);
                for (j, k, product) in pairs {
                    (a[(j, k)], a[(k, j)]) = (product, product);
                }
                let p = &a * &a;
                let column = Mat::from_fn(n, 1, |j, _| b[j]);
                let (ab, pb) = (&a * &column, &p * &column);
                let sum = |j: usize, of: &dyn Fn(usize) -> f64| (0..n).map(|k| p[(k, j)] * of(k)).sum::<f64>();
                (0..n)
                    .map(|j| [ab[(j, 0)], pb[(j, 0)], p[(j, j)], sum(j, &|k| a[(k, j)]), sum(j, &|k| p[(k, j)])])
                    .collect()
            }
        };
        let total = |of: &dyn Fn(usize) -> f64| (0..n).map(of).sum::<f64>();
        let k2 = total(&|j| b[j] * b[j] + 0.5 * of[j][2]);
        let k3 = total(&|j| 3.0 * b[j] * of[j][0] + of[j][3]);
        let k4 = total(&|j| 12.0 * b[j] * of[j][1] + 3.0 * of[j][4]);
        if k2.is_nan() || k2 <= 0.0 {
            return None;
        }
        let (skewness, excess) = (k3 / k2.powf(1.5), k4 / (k2 * k2));
        let slope = |j: usize| {
            let [ab, pb, pp, pa, p2] = of[j];
            let by2 = 2.0 * b[j] * b[j] + 2.0 * pp;
            let by3 = 12.0 * b[j] * ab + 6.0 * pa;
            let by4 = 48.0 * b[j] * pb + 24.0 * ab * ab + 24.0 * p2;
            [
                diagonal[j],
                0.5 * by2 / k2,
                by3 / k2.powf(1.5) - 1.5 * skewness * by2 / k2,
                by4 / (k2 * k2) - 2.0 * excess * by2 / k2,
            ]
        };
        Some((0..n).map(slope).collect())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moments::Interactions;
    use crate::surrogate::{InputShape, Relocation, Univariate, shapes};

    /// Against central differences of the moments, whose truncation and rounding are both near 1e-10 at this step.
    #[test]
    fn slopes_are_those_of_differences() {
        let n = 5;
        let parts = (0..n).map(|j| Some(Univariate::of_coefficients(&[1.0 - 0.3 * j as f64, 0.1 * j as f64])));
        let pairs = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k, 0.05 * (j as f64 - 2.0) + 0.02 * k as f64)));
        let straight = Interactions::none(n);
        for interactions in [Interactions::of_pairs(n, pairs), straight] {
            let surface = Surrogate { centre: 1.0, parts: parts.clone().collect(), interactions };
            let law = crate::distribution::Normal::new(0.0, 1.0).unwrap();
            let laws: Vec<&dyn crate::distribution::Distribution> = vec![&law; n];
            let shapes: Vec<InputShape> = shapes(laws);
            let inputs = Inputs::independent(shapes);
            let found = surface.normal_slopes(&inputs).unwrap();
            for j in 0..n {
                let figures = |step: f64| {
                    let mut moved = vec![Relocation::NONE; n];
                    moved[j].stretch = f64::exp(step);
                    let moments = surface.relocated(&moved).contributions(&inputs).unwrap().moments;
                    [moments.mean(), moments.sigma().ln(), moments.skewness().unwrap(), moments.excess().unwrap()]
                };
                let (up, down) = (figures(3e-5), figures(-3e-5));
                for i in 0..4 {
                    let slope = (up[i] - down[i]) / 6e-5;
                    assert!((found[j][i] - slope).abs() < 1e-8, "{j} {i}: {} for {slope}", found[j][i]);
                }
            }
        }
    }
}
