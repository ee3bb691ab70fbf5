//! One number for all interactions that were not examined, from the points that check.
//!
//! A product of functions of one dimension each, and a function of a sum, have with slopes `b`, curvatures `a` and one `l`
//!
//! ```text
//! A_jk = l b_j b_k                       u_j u_k
//! B_jjk = t l a_j b_k                    u_j^2 u_k          t = 1 for products, F' F'''/F''^2 for F of a sum
//! C_ijk = t l^2 b_i b_j b_k              u_i u_j u_k
//! ```
//!
//! `l` is fitted to the even part of what is left at mirrored points, `t` to the odd part; each is taken only where it explains
//! nearly all of that. `u_j^2 u_k` is the one that matters most: with its mean it is a slope `B_jjk u_k` that no difference about the
//! means has seen.

use super::chosen::ChosenPoints;
use crate::plan::{Corner, DifferencePlan};
use sensitol_numeric::surrogate::Univariate;

/// The rest of a part after a fit must be below this part of it, for the products,
const EXPLAINS: f64 = 0.2;
/// and for the powers beyond.
const EXPLAINS_ODD: f64 = 0.5;
/// Products of curvatures above this part of those of slopes want all four corners.
const SQUARE: f64 = 0.1;
/// With fewer pairs of points than that nothing is fitted to them.
const FEWEST: usize = 4;
/// A larger `t` indicates a bad fit: a root has 3.
const LARGEST: f64 = 6.0;

/// Slopes and curvatures of all parts.
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

    /// Of the line along which a function of a sum is bent: its curvatures go like the squares of the terms.
    pub(super) fn bend(&self, j: usize) -> f64 {
        self.curvatures[j].abs().sqrt().copysign(self.slopes[j])
    }

    /// `sum of b_j b_k u_j u_k` over all pairs but these.
    fn products(&self, u: &[f64], but: &[(usize, usize)]) -> f64 {
        let term = |j: usize| self.slopes[j] * u[j];
        let [sum, squares] =
            (0..u.len()).fold([0.0; 2], |[sum, squares], j| [sum + term(j), squares + term(j).powi(2)]);
        0.5 * (sum * sum - squares) - but.iter().map(|&(j, k)| term(j) * term(k)).sum::<f64>()
    }

    /// The odd terms for `t = 1`.
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

    /// The contribution of the terms `u_j^2 u_k` to the slopes.
    fn slopes_of_thirds(&self, factor: f64, but: &[(usize, usize)]) -> Vec<f64> {
        let all: f64 = self.curvatures.iter().sum();
        let mut bends: Vec<f64> = self.curvatures.iter().map(|own| all - own).collect();
        for &(j, k) in but {
            bends[j] -= self.curvatures[k];
            bends[k] -= self.curvatures[j];
        }
        bends.iter().zip(&self.slopes).map(|(bends, slope)| factor * bends * slope).collect()
    }

    /// Whether `u_j^2 u_k^2` may be so large beside the product that two corners do not tell them apart.
    pub(super) fn square(&self, j: usize, k: usize) -> bool {
        (self.curvatures[j] * self.curvatures[k]).abs() > SQUARE * (self.slopes[j] * self.slopes[k]).abs()
    }

    /// The terms that the corners of an examined pair show beside its product: `u_j^2 u_k` and `u_j u_k^2`, which are to each
    /// other as `a_j b_k` to `a_k b_j`, and `u_j^2 u_k^2` where all four are known.
    pub(super) fn twist(&self, (j, k): (usize, usize), corners: &[Option<Corner>; 4]) -> Option<Twist> {
        let [Some((u1, v1, d1)), Some((u2, v2, d2)), ..] = *corners else { return None };
        let [first, second] = [self.curvatures[j] * self.slopes[k], self.curvatures[k] * self.slopes[j]];
        let twist = |u: f64, v: f64| first * u * u * v + second * u * v * v;
        let (t1, t2) = (twist(u1, v1), twist(u2, v2));
        let square = match *corners {
            [.., Some((u3, v3, d3)), Some((u4, v4, d4))] => {
                // Odd terms cancel where the nodes are opposite to each other, nearly so elsewhere.
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
        // As in a product or a function of a sum, or it is something else.
        let plausible = (factor * self.slopes[j] * self.slopes[k]).abs() <= LARGEST * product.abs();
        plausible.then_some(Twist { product, slopes: [factor * second, factor * first], square })
    }
}

/// The terms that the corners of a pair show.
#[derive(Debug, Clone, Copy)]
pub(super) struct Twist {
    /// `A_jk`
    pub(super) product: f64,
    /// The contribution of the odd terms to the slopes of `j` and `k`.
    pub(super) slopes: [f64; 2],
    /// The factor of `u_j^2 u_k^2 = 1 + (u_j^2 - 1) + (u_k^2 - 1) + (u_j^2 - 1)(u_k^2 - 1)`: what it adds to both curvatures.
    pub(super) square: f64,
}

/// The estimate of the interactions that were not examined, by the points that check.
pub(super) struct Atoms {
    /// `l`, where it was not known before.
    pub(super) together: Option<f64>,
    /// The amounts that are added to the slopes.
    pub(super) slopes: Option<Vec<f64>>,
}

/// From what is left at the points that check, a value for each, None where it is unknown; `together` is `l` where the probes
/// have told it, and `pairs` are those that were examined.
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
    /// The part that it leaves of the values.
    left: f64,
}

/// The factor of a shape in the even, centred, or odd parts of values at mirrored pairs of points.
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
