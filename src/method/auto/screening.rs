//! Search for interactions by probes that move every dimension at once.
//!
//! A probe is a vector of signs `e`. With the nodes `u+` and `u-` of a pair, `r = (u+ - u-)/2`, and evaluations at `e` and `-e`,
//!
//! ```text
//! y(e) = [f(e) + f(-e)]/2 - f0 - sum_j G_j = const + sum_{j<k} r_j r_k A_jk e_j e_k + (products of four)
//! G_j  = [f(+_j) + f(-_j)]/2 - f0
//! ```
//!
//! If almost no odd residuals are left, `e` is evaluated alone. Then `y(e) = f(e) - f0 - sum_j [f(e_j) - f0]` also contains products of
//! three, which the judging probes count as unexplained.
//!
//! Three kinds of terms are fitted by orthogonal matching pursuit (Pati, Rezaiifar and Krishnaprasad 1993): a constant, the one product
//! `((b'e)^2 - b'b)/2` of a function of a sum, and single pairs. The scores of all pairs are the matrix `E' diag(residual) E`, so that
//! their N(N-1)/2 columns are never stored. The fit without any interaction always competes. Probes that no fit has used judge.

use faer::linalg::matmul::matmul;
use faer::linalg::solvers::SolveLstsqCore;
use faer::{Accum, Conj, Mat, Par};

use sensitol_numeric::surrogate::DEPENDENT;

/// Signs of the probes, and the values `y(e)` there.
pub(super) struct Probed<'a> {
    pub(super) signs: Vec<&'a [f64]>,
    pub(super) seen: Vec<f64>,
}

/// Fit of the interactions of one characteristic.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Fit {
    /// Factor of the product of all slopes.
    pub(super) together: f64,
    /// Single pairs, in units of the signs.
    pub(super) pairs: Vec<(usize, usize, f64)>,
    /// Mean square of the residuals at the probes that judge.
    pub(super) left: f64,
}

/// Number of fitted probes that allow one more pair in the fit.
const PROBES_PER_PAIR: f64 = 2.5;

/// Returns the best fit to `fitted`, judged by `judging`. `slopes` are in units of the signs, and `enough` is the mean square that may be
/// left.
pub(super) fn fit(fitted: &Probed<'_>, judging: &Probed<'_>, slopes: &[f64], enough: f64) -> Fit {
    let most = (fitted.seen.len() as f64 / PROBES_PER_PAIR) as usize;
    let none = Fit { left: mean_square(&judging.seen), ..Fit::default() };
    let candidates = [0, most.max(1)].map(|most| pursued(fitted, judging, slopes, most, 0.25 * enough));
    candidates.into_iter().fold(none, |best, fit| if fit.left < best.left { fit } else { best })
}

fn mean_square(values: &[f64]) -> f64 {
    values.iter().map(|value| value * value).sum::<f64>() / values.len().max(1) as f64
}

/// Returns the product of all slopes at a vector of signs.
fn together(signs: &[f64], slopes: &[f64]) -> f64 {
    let sum: f64 = signs.iter().zip(slopes).map(|(e, b)| e * b).sum();
    0.5 * (sum * sum - slopes.iter().map(|b| b * b).sum::<f64>())
}

fn pursued(fitted: &Probed<'_>, judging: &Probed<'_>, slopes: &[f64], most: usize, enough: f64) -> Fit {
    let (rows, n) = (fitted.seen.len(), slopes.len());
    let largest = slopes.iter().fold(0.0f64, |largest, b| largest.max(b.abs()));
    let scaled: Vec<f64> = slopes.iter().map(|b| if largest > 0.0 { b / largest } else { 0.0 }).collect();
    let mut columns: Vec<Vec<f64>> = vec![vec![1.0; rows]];
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let mut left = fitted.seen.clone();
    let ones = columns[0].clone();
    // The constant and the product of all slopes enter first: they cost two columns and may explain all pairs.
    project(&mut basis, &mut left, &ones);
    let atom: Vec<f64> = fitted.signs.iter().map(|signs| together(signs, &scaled)).collect();
    let has_atom = project(&mut basis, &mut left, &atom);
    if has_atom {
        columns.push(atom);
    }
    let mut chosen: Vec<(usize, usize)> = Vec::new();
    let signs = Mat::from_fn(rows, n, |i, j| fitted.signs[i][j]);
    while chosen.len() < most && basis.len() < rows && mean_square(&left) > enough {
        let weighted = Mat::from_fn(rows, n, |i, j| left[i] * fitted.signs[i][j]);
        let mut scores = Mat::<f64>::zeros(n, n);
        matmul(&mut scores, Accum::Replace, signs.transpose(), &weighted, 1.0, Par::Seq);
        let mut ranked: Vec<(f64, usize, usize)> = (0..n)
            .flat_map(|k| (0..k).map(move |j| (j, k)))
            .map(|(j, k)| (scores[(j, k)].abs(), j, k))
            .filter(|(_, j, k)| !chosen.contains(&(*j, *k)))
            .collect();
        // Several pairs at a time, because large fits have many pairs to find.
        let batch = (rows / 256).max(1).min(most - chosen.len()).min(ranked.len());
        if batch == 0 {
            break;
        }
        let order = |a: &(f64, usize, usize), b: &(f64, usize, usize)| {
            b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2))
        };
        ranked.select_nth_unstable_by(batch - 1, order);
        let mut found = false;
        let mut best = ranked[..batch].to_vec();
        best.sort_by(order);
        for (_, j, k) in best {
            let column: Vec<f64> = fitted.signs.iter().map(|signs| signs[j] * signs[k]).collect();
            if project(&mut basis, &mut left, &column) {
                columns.push(column);
                chosen.push((j, k));
                found = true;
            }
        }
        if !found {
            break;
        }
    }
    // A final fit of all columns at once gives the coefficients. The judging probes then measure it.
    let coefficients = least_squares(&columns, &fitted.seen);
    let offset = 1 + usize::from(has_atom);
    // The product was fitted with slopes divided by the largest.
    let factor = if has_atom { coefficients[1] / (largest * largest) } else { 0.0 };
    let pairs: Vec<(usize, usize, f64)> =
        chosen.iter().zip(&coefficients[offset..]).map(|(&(j, k), &value)| (j, k, value)).collect();
    let predicted = |signs: &[f64]| {
        let own: f64 = pairs.iter().map(|&(j, k, value)| value * signs[j] * signs[k]).sum();
        coefficients[0] + factor * together(signs, slopes) + own
    };
    let misses: Vec<f64> =
        judging.signs.iter().zip(&judging.seen).map(|(signs, seen)| seen - predicted(signs)).collect();
    Fit { together: factor, pairs, left: mean_square(&misses) }
}

/// Orthogonalises a column against the basis, adds it, and removes the part that it explains from `left`. Returns false if it depends on
/// the basis.
fn project(basis: &mut Vec<Vec<f64>>, left: &mut [f64], column: &[f64]) -> bool {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let size = dot(column, column).sqrt();
    let mut rest = column.to_vec();
    // Two passes are enough (Parlett 1980).
    for _ in 0..2 {
        for known in basis.iter() {
            let along = dot(known, &rest);
            rest.iter_mut().zip(known).for_each(|(rest, known)| *rest -= along * known);
        }
    }
    let norm = dot(&rest, &rest).sqrt();
    if norm.is_nan() || norm <= DEPENDENT * size || size == 0.0 {
        return false;
    }
    rest.iter_mut().for_each(|value| *value /= norm);
    let along = dot(&rest, left);
    left.iter_mut().zip(&rest).for_each(|(left, rest)| *left -= along * rest);
    basis.push(rest);
    true
}

fn least_squares(columns: &[Vec<f64>], seen: &[f64]) -> Vec<f64> {
    let matrix = Mat::from_fn(seen.len(), columns.len(), |i, j| columns[j][i]);
    let mut right = Mat::from_fn(seen.len(), 1, |i, _| seen[i]);
    matrix.col_piv_qr().solve_lstsq_in_place_with_conj(Conj::No, right.as_mut());
    (0..columns.len()).map(|j| right[(j, 0)]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pseudo-random signs by a linear congruential generator.
    fn signs(rows: usize, n: usize, seed: u64) -> Vec<Vec<f64>> {
        let mut state = seed;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            if state >> 63 == 0 { 1.0 } else { -1.0 }
        };
        (0..rows).map(|_| (0..n).map(|_| next()).collect()).collect()
    }

    fn probed(signs: &[Vec<f64>], seen: impl Fn(&[f64]) -> f64) -> Probed<'_> {
        Probed { signs: signs.iter().map(Vec::as_slice).collect(), seen: signs.iter().map(|e| seen(e)).collect() }
    }

    /// Two of the 780 pairs of forty dimensions are found exactly from sixty probes.
    #[test]
    fn single_pairs_are_found() {
        let (fitted, judging) = (signs(60, 40, 1), signs(12, 40, 2));
        let seen = |e: &[f64]| 0.3 + 2.0 * e[3] * e[17] - 0.5 * e[0] * e[39];
        let found = fit(&probed(&fitted, seen), &probed(&judging, seen), &[1.0; 40], 1e-12);
        assert!(found.left < 1e-20 && found.together.abs() < 1e-12, "{found:?}");
        let mut pairs = found.pairs;
        pairs.sort_by_key(|&(j, ..)| j);
        assert_eq!(pairs.iter().map(|&(j, k, _)| (j, k)).collect::<Vec<_>>(), [(0, 39), (3, 17)]);
        assert!((pairs[0].2 + 0.5).abs() < 1e-12 && (pairs[1].2 - 2.0).abs() < 1e-12);
    }

    /// The square of a sum of two hundred dimensions is one product, found from six probes.
    #[test]
    fn a_function_of_a_sum_is_one_product() {
        let slopes: Vec<f64> = (0..200).map(|j| 1.0 + 0.01 * f64::from(j)).collect();
        let (fitted, judging) = (signs(6, 200, 3), signs(12, 200, 4));
        let seen = |e: &[f64]| 0.02 * together(e, &slopes);
        let found = fit(&probed(&fitted, seen), &probed(&judging, seen), &slopes, 1e-9);
        assert!((found.together - 0.02).abs() < 1e-12 && found.pairs.is_empty(), "{found:?}");
    }

    /// A fit that does not explain noise never replaces the fit without interactions.
    #[test]
    fn noise_is_left() {
        let (fitted, judging) = (signs(8, 30, 5), signs(12, 30, 6));
        // A product of four dimensions is not a pair.
        let seen = |e: &[f64]| e[0] * e[1] * e[2] * e[3];
        let found = fit(&probed(&fitted, seen), &probed(&judging, seen), &[1.0; 30], 1e-9);
        assert!(found.left <= 1.0);
    }
}
