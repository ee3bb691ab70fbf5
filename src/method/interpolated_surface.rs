//! Surface through the points of a method that integrates, for comparison with check points.
//!
//! A method that integrates has no surface of its own: its figures follow from values at nodes. Check points are compared with this surface
//! instead. The error of a figure therefore includes the difference to the moments of this surface.
//!
//! If each dimension is moved by itself, its part is the polynomial through these points. The product of two dimensions is the one that
//! fits the points which move both:
//!
//! ```text
//! A_jk = sum (y - f0 - g_j - g_k) u_j u_k / sum (u_j u_k)^2
//! ```
//!
//! Correlated dimensions move along the eigenvectors of their correlation. The surface is then the quadratic of least squares over the
//! columns `1, u_j, u_j^2, sqrt(2) u_j u_k`. If several quadratics fit equally well, it is the one with the smallest coefficients (Penrose
//! 1956). The size of these coefficients does not change when the axes turn, so that every direction that is moved gets its own parabola.

use std::collections::BTreeMap;

use faer::Mat;

use crate::method::Outcome;
use sensitol_numeric::moments::Interactions;
use sensitol_numeric::surrogate::{DerivativeOrigin, Surrogate, Univariate};

/// A singular value below this part of the largest belongs to a direction without points.
const SINGULAR: f64 = 1e-9;
/// Greatest number of multiplications of a decomposition, about a second. Beyond it the surface is linear.
const WORK: usize = 1_000_000_000;

/// Positions that a point moves, in sigmas, and the value at the point.
type Moved = (Vec<(usize, f64)>, f64);

/// Returns the surface of a characteristic. Returns None if the method does not integrate, or if its points determine no surface.
pub(crate) fn interpolated(outcome: &Outcome, c: usize) -> Option<Surrogate> {
    outcome.fitted[c].integrated.as_ref()?;
    let (plan, known) = (&outcome.plan, &outcome.evaluated.known);
    let moved = |point: &crate::plan::Point| -> Option<Vec<(usize, f64)>> {
        let at = point.at().iter().map(|at| {
            let position = plan.varying().binary_search(&(at.dimension as usize)).ok()?;
            Some((position, plan.axis(at.dimension as usize).nodes[at.node as usize].u))
        });
        at.collect()
    };
    let points = known.points().iter();
    let values: Vec<Moved> = points.filter_map(|point| Some((moved(point)?, known.value(point, c)?))).collect();
    by_axes(outcome, c, &values).or_else(|| least_squares(plan.varying().len(), &values))
}

/// Returns the surface from points on axes and planes, or None if a dimension is not moved by itself.
fn by_axes(outcome: &Outcome, c: usize, values: &[Moved]) -> Option<Surrogate> {
    let fitted = &outcome.fitted[c];
    let centre = fitted.centre?;
    let parts: Vec<Univariate> = outcome.plan.varying().iter().map(|&d| fitted.parts[d]).collect::<Option<_>>()?;
    let mut sums: BTreeMap<(usize, usize), [f64; 2]> = BTreeMap::new();
    for (at, value) in values {
        let [(j, u), (k, v)] = at[..] else { continue };
        let joint = value - centre - parts[j].value(u) - parts[k].value(v);
        let [product, square] = sums.entry((j, k)).or_default();
        *product += joint * u * v;
        *square += (u * v).powi(2);
    }
    let products = sums.into_iter().map(|((j, k), [product, square])| (j, k, product / square));
    let products: Vec<(usize, usize, f64)> = products.filter(|(.., value)| *value != 0.0).collect();
    let interactions = Interactions::of_pairs(parts.len(), products);
    Some(Surrogate { centre, parts: parts.into_iter().map(Some).collect(), interactions })
}

/// Returns the quadratic of least squares over `n` dimensions, or the plane if a quadratic takes too long. Returns None if there is no
/// value, or if even the plane takes too long.
fn least_squares(n: usize, values: &[Moved]) -> Option<Surrogate> {
    let quadratic = (n + 1) * (n + 2) / 2;
    let work = |columns: usize| values.len() * columns * values.len().min(columns);
    let curved = work(quadratic) <= WORK;
    let columns = if curved { quadratic } else { 1 + n };
    if work(columns) > WORK {
        return None;
    }
    let pairs: Vec<(usize, usize)> = (0..n).flat_map(|j| (j + 1..n).map(move |k| (j, k))).collect();
    // One row per point: constant, slopes, squares, products.
    let mut rows = Mat::<f64>::zeros(values.len(), columns);
    for (row, (at, _)) in values.iter().enumerate() {
        let mut u = vec![0.0; n];
        at.iter().for_each(|&(j, value)| u[j] = value);
        rows[(row, 0)] = 1.0;
        (0..n).for_each(|j| rows[(row, 1 + j)] = u[j]);
        if curved {
            (0..n).for_each(|j| rows[(row, 1 + n + j)] = u[j] * u[j]);
            for (place, &(j, k)) in pairs.iter().enumerate() {
                rows[(row, 1 + 2 * n + place)] = std::f64::consts::SQRT_2 * u[j] * u[k];
            }
        }
    }
    // The fit takes values relative to the first point, in units of the largest rise, so that neither a large mean nor the unit matters.
    let base = values.first()?.1;
    let largest = values.iter().map(|(_, value)| (value - base).abs()).fold(0.0, f64::max);
    let decomposed = rows.thin_svd().ok()?;
    let (left, s, right) = (decomposed.U(), decomposed.S().column_vector(), decomposed.V());
    let mut found = vec![0.0; columns];
    if largest > 0.0 {
        // Pseudo-inverse: directions without points get the coefficient 0.
        for k in (0..s.nrows()).filter(|&k| s[k] > SINGULAR * s[0]) {
            let along = values.iter().enumerate().map(|(row, (_, value))| left[(row, k)] * ((value - base) / largest));
            let along = largest * along.sum::<f64>() / s[k];
            found.iter_mut().enumerate().for_each(|(column, value)| *value += along * right[(column, k)]);
        }
    }
    let part = |j: usize| {
        let part = match curved {
            true => Univariate::of_coefficients(&[found[1 + j], found[1 + n + j]]),
            false => Univariate::of_coefficients(&[found[1 + j]]),
        };
        part.with_origin(DerivativeOrigin::Evaluated)
    };
    let product = |(place, &(j, k)): (usize, &(usize, usize))| {
        (j, k, found.get(1 + 2 * n + place).map_or(0.0, |value| std::f64::consts::SQRT_2 * value))
    };
    let products: Vec<(usize, usize, f64)> =
        pairs.iter().enumerate().map(product).filter(|(.., value)| *value != 0.0).collect();
    let parts = (0..n).map(|j| Some(part(j))).collect();
    Some(Surrogate { centre: base + found[0], parts, interactions: Interactions::of_pairs(n, products) })
}
