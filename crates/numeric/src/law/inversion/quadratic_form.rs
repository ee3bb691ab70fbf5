//! Quadratic forms of normal inputs: the logarithm of `E exp(s y)` in closed form.
//!
//! Notation: `R = L L'` is the correlation of a component. `H` has its curvatures on the diagonal and half the products beside them. `Q`
//! diagonalises it: `Q'L'H L Q = diag(a)`, and `beta = Q'L'b`.
//!
//! ```text
//! K(s) = sum_i beta_i^2 s^2/(2 (1 - 2 a_i s)) - 1/2 log(1 - 2 a_i s)
//! ```
//!
//! The logarithm is the principal one of every factor, never of a product. This replaces the inversions of Imhof (1961) and Davies (1980),
//! whose errors are absolute.

use faer::{Mat, Side};

use crate::law::inversion::complex::Complex;
use crate::law::surface::Surface;

/// Relative size below which an eigenvalue is rounding of 0, by the largest one of its component.
const ZERO: f64 = 1e-15;

/// All components that are parabolas and products of normal inputs.
#[derive(Debug, Clone, Default)]
pub(in crate::law) struct Forms {
    pub(in crate::law) blocks: Vec<Block>,
    /// Sum of `beta^2` over the axes without curvature.
    straight: f64,
    /// Curvature and slope of every curved axis.
    curved: Vec<[f64; 2]>,
}

/// Quadratic form of one component.
#[derive(Debug, Clone)]
pub(in crate::law) struct Block {
    /// Indices of the inputs in the surface.
    pub members: Vec<usize>,
    /// `L Q`: the inputs as combinations of independent normal variables; None for a single input.
    pub(in crate::law) axes: Option<Mat<f64>>,
    /// `a_i`, set to 0 if it is only rounding.
    pub(in crate::law) curvatures: Vec<f64>,
    /// Slopes `beta_i` along the axes.
    pub(in crate::law) slopes: Vec<f64>,
    /// Slopes `b_j` by the inputs.
    pub(in crate::law) linear: Vec<f64>,
    /// Matrix `H`; None for a single input.
    form: Option<Mat<f64>>,
}

impl Block {
    /// Quadratic form of the members. Returns None if the eigenvalues cannot be computed.
    pub(in crate::law) fn of(surface: &Surface, members: &[usize]) -> Option<Self> {
        let slope = |j: usize| surface.parts[j][1];
        if let [j] = *members {
            let members = vec![j];
            let (curvatures, slopes) = (vec![surface.parts[j][2]], vec![slope(j)]);
            return Some(Self { members, axes: None, curvatures, linear: slopes.clone(), slopes, form: None });
        }
        let m = members.len();
        let form = form(surface, members);
        let factor = factor(surface, members)?;
        let eigen = match &factor {
            Some(factor) => (factor.transpose() * &form * factor).self_adjoint_eigen(Side::Lower),
            None => form.self_adjoint_eigen(Side::Lower),
        };
        let eigen = eigen.ok()?;
        let axes = match &factor {
            Some(factor) => factor * eigen.U(),
            None => eigen.U().to_owned(),
        };
        let largest = (0..m).map(|i| eigen.S()[i].abs()).fold(0.0, f64::max);
        let curvatures = (0..m).map(|i| if eigen.S()[i].abs() > ZERO * largest { eigen.S()[i] } else { 0.0 }).collect();
        let slopes = (0..m).map(|i| (0..m).map(|a| axes[(a, i)] * slope(members[a])).sum()).collect();
        let linear = members.iter().map(|&j| slope(j)).collect();
        Some(Self { members: members.to_vec(), axes: Some(axes), curvatures, slopes, linear, form: Some(form) })
    }

    /// Product `H L Q`. Returns None for a single input.
    pub(in crate::law) fn images(&self) -> Option<Mat<f64>> {
        Some(self.form.as_ref()? * self.axes.as_ref()?)
    }
}

/// `H` of the members: curvatures on the diagonal, half the products beside it.
pub(in crate::law) fn form(surface: &Surface, members: &[usize]) -> Mat<f64> {
    let m = members.len();
    let mut form = Mat::<f64>::zeros(m, m);
    for (a, &j) in members.iter().enumerate() {
        form[(a, a)] = surface.parts[j][2];
        for &(k, product) in &surface.neighbours[j] {
            if let Ok(b) = members.binary_search(&k) {
                form[(a, b)] = 0.5 * product;
            }
        }
    }
    form
}

/// `L` with `L L'` the correlation of the members. The inner option is None if they are uncorrelated, the outer one if there is no factor.
pub(in crate::law) fn factor(surface: &Surface, members: &[usize]) -> Option<Option<Mat<f64>>> {
    let Some(correlated) = &surface.correlated else { return Some(None) };
    if !members.iter().any(|&j| correlated.place(j).is_some()) {
        return Some(None);
    }
    let m = members.len();
    let matrix = Mat::from_fn(m, m, |a, b| correlated.between(members[a], members[b]));
    if let Ok(cholesky) = matrix.llt(Side::Lower) {
        let lower = cholesky.L();
        return Some(Some(Mat::from_fn(m, m, |a, b| if b <= a { lower[(a, b)] } else { 0.0 })));
    }
    let eigen = matrix.self_adjoint_eigen(Side::Lower).ok()?;
    Some(Some(Mat::from_fn(m, m, |a, b| eigen.U()[(a, b)] * eigen.S()[b].max(0.0).sqrt())))
}

impl Forms {
    pub(in crate::law) fn push(&mut self, block: Block) {
        for (&a, &slope) in block.curvatures.iter().zip(&block.slopes) {
            match a == 0.0 {
                true => self.straight += slope * slope,
                false => self.curved.push([a, slope]),
            }
        }
        self.blocks.push(block);
    }

    /// True if there is no curvature, so that the distribution is normal.
    pub(in crate::law) fn is_normal(&self) -> bool {
        self.curved.is_empty()
    }

    pub(in crate::law) fn mean(&self) -> f64 {
        self.curved.iter().map(|[a, _]| a).sum()
    }

    pub(in crate::law) fn variance(&self) -> f64 {
        self.straight + self.curved.iter().map(|[a, slope]| 2.0 * a * a + slope * slope).sum::<f64>()
    }

    /// Lowest and highest `s` at which `E exp(s y)` exists.
    pub(in crate::law) fn domain(&self) -> [f64; 2] {
        self.curved.iter().fold([f64::NEG_INFINITY, f64::INFINITY], |[low, high], &[a, _]| {
            if a > 0.0 { [low, high.min(0.5 / a)] } else { [low.max(0.5 / a), high] }
        })
    }

    /// Value at the common vertex of all parabolas. Returns None unless every axis is curved so much that the transform decays only like a
    /// power. The density then has a corner at the vertex, and on either side of it the contour can be bent.
    ///
    /// `more` holds curvatures and slopes of further forms.
    pub(in crate::law) fn vertex(&self, more: &[[f64; 2]]) -> Option<f64> {
        let all = || self.curved.iter().chain(more).filter(|parabola| **parabola != [0.0, 0.0]);
        let least = all().map(|[a, _]| a.abs()).fold(f64::INFINITY, f64::min);
        let steepest = all().map(|[_, slope]| slope.abs()).fold(0.0, f64::max);
        // Slopes far beyond the curvatures first decay like those of a normal distribution.
        let bent = self.straight == 0.0 && all().count() > 0 && 30.0 * least > steepest;
        bent.then(|| -all().map(|[a, slope]| slope * slope / (4.0 * a)).sum::<f64>())
    }

    /// `[K, K', K'']` at a real `s` within the domain.
    pub(in crate::law) fn cumulants(&self, s: f64) -> [f64; 3] {
        let start = [0.5 * self.straight * s * s, self.straight * s, self.straight];
        self.curved.iter().fold(start, |[k, k1, k2], &[a, slope]| {
            let (q, square) = (1.0 - 2.0 * a * s, slope * slope);
            [
                k + square * s * s / (2.0 * q) - 0.5 * libm::log1p(-2.0 * a * s),
                k1 + square * s * (1.0 - a * s) / (q * q) + a / q,
                k2 + square / (q * q * q) + 2.0 * a * a / (q * q),
            ]
        })
    }

    /// Logarithm `K(s)` of the transform.
    pub(in crate::law) fn log(&self, s: Complex) -> Complex {
        let square = s * s;
        let (mut sum, mut modulus, mut angle) = (square * (0.5 * self.straight), 1.0, 0.0);
        let mut logs = 0.0;
        for &[a, slope] in &self.curved {
            let q = Complex::new(1.0 - 2.0 * a * s.re, -2.0 * a * s.im);
            let norm = q.square();
            if slope != 0.0 {
                // s^2 conj(q)/(2 |q|^2)
                let factor = 0.5 * slope * slope / norm;
                sum += Complex::new(
                    (square.re * q.re + square.im * q.im) * factor,
                    (square.im * q.re - square.re * q.im) * factor,
                );
            }
            // Multiply the moduli and take one logarithm for many, before the product overflows.
            angle += libm::atan2(q.im, q.re);
            modulus *= norm;
            if !(1e-200..=1e200).contains(&modulus) {
                logs += libm::log(modulus);
                modulus = 1.0;
            }
        }
        logs += libm::log(modulus);
        sum - Complex::new(0.25 * logs, 0.5 * angle)
    }
}
