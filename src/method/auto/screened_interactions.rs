//! Estimate of all interactions that were not examined by a single factor, from residuals at the check points.
//!
//! A product of functions of one dimension each, and a function of a sum, have these coefficients, with slopes `b`, curvatures `a` and one
//! factor `l`:
//!
//! ```text
//! A_jk = l b_j b_k                       u_j u_k
//! B_jjk = t l a_j b_k                    u_j^2 u_k          t = 1 for products, F' F'''/F''^2 for F of a sum
//! C_ijk = t l^2 b_i b_j b_k              u_i u_j u_k
//! ```
//!
//! `l` is fitted to the even part of the residuals at mirrored points, `t` to the odd part. Each is used only if it explains nearly all of
//! its part. `u_j^2 u_k` is the most important of these terms: its mean is a slope `B_jjk u_k` that no difference about the means shows.

use crate::method::auto::chosen_points::ChosenPoints;
use crate::plan::{Corner, DifferencePlan};
use sensitol_numeric::surrogate::Univariate;

/// Greatest unexplained share of the even part for which the fitted products are used.
const EXPLAINS: f64 = 0.2;
/// Greatest unexplained share of the odd part for which the fitted odd terms are used.
const EXPLAINS_ODD: f64 = 0.5;
/// Ratio of a product of curvatures to that of the slopes above which a pair needs all four corners.
const SQUARE: f64 = 0.1;
/// Smallest number of pairs of mirrored points for a fit.
const FEWEST: usize = 4;
/// Greatest plausible `t`. A larger one indicates a bad fit: a root has 3.
const LARGEST: f64 = 6.0;

/// Slopes and curvatures of the parts of all dimensions.
pub(super) struct Bends {
    slopes: Vec<f64>,
    curvatures: Vec<f64>,
    parabola: Vec<bool>,
}

impl Bends {
    pub(super) fn of(parts: &[Option<Univariate>]) -> Self {
        let coefficient = |i: usize| move |part: &Option<Univariate>| part.map_or(0.0, |part| part.coefficients()[i]);
        Self {
            slopes: parts.iter().map(coefficient(0)).collect(),
            curvatures: parts.iter().map(coefficient(1)).collect(),
            parabola: parts.iter().map(|part| part.is_some_and(|part| part.degree() == 2)).collect(),
        }
    }

    pub(super) fn slope(&self, j: usize) -> f64 {
        self.slopes[j]
    }

    /// Component of the line along which a function of a sum is curved. The curvatures of such a function are proportional to the squares
    /// of the terms.
    pub(super) fn bend(&self, j: usize) -> f64 {
        self.curvatures[j].abs().sqrt().copysign(self.slopes[j])
    }

    /// Returns `sum of b_j b_k u_j u_k` over all pairs except `but`.
    fn products(&self, u: &[f64], but: &[(usize, usize)]) -> f64 {
        let term = |j: usize| self.slopes[j] * u[j];
        let [sum, squares] =
            (0..u.len()).fold([0.0; 2], |[sum, squares], j| [sum + term(j), squares + term(j).powi(2)]);
        0.5 * (sum * sum - squares) - but.iter().map(|&(j, k)| term(j) * term(k)).sum::<f64>()
    }

    /// Returns the sum of the odd terms for `t = 1`. Pairs in `but` are left out of the terms `u_j^2 u_k`.
    fn thirds(&self, u: &[f64], together: f64, but: &[(usize, usize)]) -> f64 {
        let line = |j: usize| self.slopes[j] * u[j];
        let bend = |j: usize| self.curvatures[j] * u[j] * u[j];
        let [mut p1, mut p2, mut p3, mut bends, mut own, mut cubes] = [0.0; 6];
        for (j, &at) in u.iter().enumerate() {
            let term = line(j);
            (p1, p2, p3) = (p1 + term, p2 + term * term, p3 + term.powi(3));
            (bends, own) = (bends + bend(j), own + bend(j) * term);
            if self.parabola[j] && self.slopes[j] != 0.0 {
                cubes += 2.0 / 3.0 * self.curvatures[j].powi(2) / self.slopes[j] * (at.powi(3) - 3.0 * at);
            }
        }
        let direct: f64 = but.iter().map(|&(j, k)| bend(j) * line(k) + bend(k) * line(j)).sum();
        let triples = (p1.powi(3) - 3.0 * p1 * p2 + 2.0 * p3) / 6.0;
        together * (bends * p1 - own - direct) + together * together * triples + cubes
    }

    /// Returns the contribution of the terms `u_j^2 u_k` to the slopes.
    fn slopes_of_thirds(&self, factor: f64, but: &[(usize, usize)]) -> Vec<f64> {
        let all: f64 = self.curvatures.iter().sum();
        let mut bends: Vec<f64> = self.curvatures.iter().map(|own| all - own).collect();
        for &(j, k) in but {
            bends[j] -= self.curvatures[k];
            bends[k] -= self.curvatures[j];
        }
        bends.iter().zip(&self.slopes).map(|(bends, slope)| factor * bends * slope).collect()
    }

    /// True if `u_j^2 u_k^2` may be so large beside the product that two corners do not separate them.
    pub(super) fn square(&self, j: usize, k: usize) -> bool {
        (self.curvatures[j] * self.curvatures[k]).abs() > SQUARE * (self.slopes[j] * self.slopes[k]).abs()
    }

    /// Returns the terms that the corners of an examined pair show beside its product. The terms `u_j^2 u_k` and `u_j u_k^2` have the ratio
    /// of `a_j b_k` to `a_k b_j`. The term `u_j^2 u_k^2` is included if all four corners are known.
    pub(super) fn twist(&self, (j, k): (usize, usize), corners: &[Option<Corner>; 4]) -> Option<Twist> {
        let [Some((u1, v1, d1)), Some((u2, v2, d2)), ..] = *corners else { return None };
        let [first, second] = [self.curvatures[j] * self.slopes[k], self.curvatures[k] * self.slopes[j]];
        let twist = |u: f64, v: f64| first * u * u * v + second * u * v * v;
        let (t1, t2) = (twist(u1, v1), twist(u2, v2));
        let square = match *corners {
            [.., Some((u3, v3, d3)), Some((u4, v4, d4))] => {
                // Odd terms cancel if the nodes are opposite to each other, and nearly cancel otherwise.
                let all = [(u1, v1), (u2, v2), (u3, v3), (u4, v4)];
                (d1 + d2 + d3 + d4) / all.iter().map(|(u, v)| (u * v).powi(2)).sum::<f64>()
            }
            _ => 0.0,
        };
        let (d1, d2) = (d1 - square * (u1 * v1).powi(2), d2 - square * (u2 * v2).powi(2));
        let determinant = u1 * v1 * t2 - u2 * v2 * t1;
        let size = (u1 * v1 * t2).abs() + (u2 * v2 * t1).abs();
        if size == 0.0 || determinant.abs() < 0.1 * size {
            let product = (d1 + d2) / (u1 * v1 + u2 * v2);
            return (square != 0.0).then_some(Twist { product, slopes: [0.0; 2], square });
        }
        let product = (d1 * t2 - d2 * t1) / determinant;
        let factor = (u1 * v1 * d2 - u2 * v2 * d1) / determinant;
        // A factor beyond this ratio belongs neither to a product nor to a function of a sum.
        let plausible = (factor * self.slopes[j] * self.slopes[k]).abs() <= LARGEST * product.abs();
        plausible.then_some(Twist { product, slopes: [factor * second, factor * first], square })
    }
}

/// Terms that the corners of a pair show.
#[derive(Debug, Clone, Copy)]
pub(super) struct Twist {
    /// Coefficient `A_jk` of the product.
    pub(super) product: f64,
    /// Contribution of the odd terms to the slopes of `j` and `k`.
    pub(super) slopes: [f64; 2],
    /// Coefficient of `u_j^2 u_k^2 = 1 + (u_j^2 - 1) + (u_k^2 - 1) + (u_j^2 - 1)(u_k^2 - 1)`, which is added to both curvatures.
    pub(super) square: f64,
}

/// Estimate of the interactions that were not examined, from the check points.
pub(super) struct Atoms {
    /// Factor `l`, if this fit determined it.
    pub(super) together: Option<f64>,
    /// Amounts that are added to the slopes; None if the odd terms are not plausible.
    pub(super) slopes: Option<Vec<f64>>,
}

/// Estimates the interactions that were not examined. `left` has a residual for each check point, None if it is unknown. `together` is `l`
/// if the probes have determined it, and `pairs` are the examined ones.
pub(super) fn atoms(
    plan: &DifferencePlan,
    bought: &ChosenPoints,
    pairs: &[(usize, usize)],
    bends: &Bends,
    left: &[Option<f64>],
    together: Option<f64>,
) -> Atoms {
    let places: Vec<Vec<f64>> = bought.checks.iter().flatten().map(|point| plan.standardised(point)).collect();
    let mut left: Vec<Option<f64>> = left.to_vec();
    let mut found = None;
    if together.is_none() {
        let products: Vec<f64> = places.iter().map(|u| bends.products(u, pairs)).collect();
        found = factor(&left, &products, true).filter(|fit| fit.left <= EXPLAINS).map(|fit| fit.factor);
        if let Some(factor) = found {
            left.iter_mut().zip(&products).for_each(|(left, product)| *left = left.map(|left| left - factor * product));
        }
    }
    let all = together.or(found).filter(|together| *together != 0.0);
    let slopes = all.and_then(|together| {
        let thirds: Vec<f64> = places.iter().map(|u| bends.thirds(u, together, pairs)).collect();
        let fit = factor(&left, &thirds, false)?;
        let fits = fit.left <= EXPLAINS_ODD && fit.factor > 0.0 && fit.factor <= LARGEST;
        fits.then(|| bends.slopes_of_thirds(fit.factor * together, pairs))
    });
    Atoms { together: found, slopes }
}

struct OneFactor {
    factor: f64,
    /// Share of the values that the fit does not explain.
    left: f64,
}

/// Fits the factor of `shape` to the even, centred parts or to the odd parts of values at mirrored pairs of points.
fn factor(values: &[Option<f64>], shape: &[f64], even: bool) -> Option<OneFactor> {
    let sign = if even { 1.0 } else { -1.0 };
    let half = |(values, shape): (&[Option<f64>], &[f64])| {
        Some([0.5 * (values[0]? + sign * values[1]?), 0.5 * (shape[0] + sign * shape[1])])
    };
    let mut halves: Vec<[f64; 2]> = values.chunks(2).zip(shape.chunks(2)).filter_map(half).collect();
    if halves.len() < FEWEST {
        return None;
    }
    if even {
        let n = halves.len() as f64;
        let mean = halves.iter().fold([0.0; 2], |[a, b], [x, y]| [a + x / n, b + y / n]);
        halves.iter_mut().for_each(|half| *half = [half[0] - mean[0], half[1] - mean[1]]);
    }
    let sum = |f: &dyn Fn(&[f64; 2]) -> f64| halves.iter().map(f).sum::<f64>();
    let [own, both, whole] = [sum(&|[_, y]| y * y), sum(&|[x, y]| x * y), sum(&|[x, _]| x * x)];
    if own == 0.0 || whole == 0.0 {
        return None;
    }
    let factor = both / own;
    Some(OneFactor { factor, left: 1.0 - both * both / (own * whole) })
}
