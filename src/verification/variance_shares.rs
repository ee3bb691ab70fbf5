//! Shares of the variance from the model itself, by exchanging single inputs between two sets of points.
//!
//! ```text
//! first-order  S_j = E[(b - m)(c_j - a)] / V          Saltelli and others 2010, table 2 (b), about the mean
//! total        T_j = E[(c_j - a)^2] / (2 V)           Jansen 1999
//! ```
//!
//! `a` and `b` are the model's values at two independent sets of points. `c_j` are the values at the points of the first set with input j
//! from the second. `S_j` is the share that the input explains alone, `T_j` adds all its interactions. Errors come from the jackknife over
//! 8 scramblings, widened by Student's quantile.

use crate::estimate::Columns;
use crate::verification::figures::{jackknife, student, totals};
use crate::verification::model::Model;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::Normals;

/// Number of evaluations of all scramblings together.
const EVALUATIONS: usize = 1 << 16;
/// Number of scramblings, which give the errors.
const REPLICATES: usize = 8;
/// Fewest points of a scrambling, with any number of inputs.
const FEWEST: usize = 64;
/// Greatest number of inputs: more would need too many random numbers.
const MOST: usize = 256;

/// A share of the variance with its error.
pub type Share = crate::verification::Verified;

/// Most evaluations over this number of inputs.
pub(super) fn most(inputs: usize) -> usize {
    EVALUATIONS.max(REPLICATES * FEWEST * (inputs + 2))
}

/// First-order and total shares of every factor, which is a variable or several that are exchanged together. Returns None with too many
/// variables, and if nothing varies.
pub(super) fn shares(model: &Model<'_>, factors: &[Vec<usize>], seed: u64) -> Option<Vec<[Share; 2]>> {
    let n = factors.len();
    if n == 0 || model.len() > MOST {
        return None;
    }
    let rows = (EVALUATIONS / (REPLICATES * (n + 2))).max(FEWEST);
    let rows = if rows.is_power_of_two() { rows } else { rows.next_power_of_two() / 2 };
    let normals = Normals::new(2 * model.len(), seed);
    let sums: Vec<Vec<f64>> =
        (0..REPLICATES).into_par_iter().map(|r| exchanged(model, factors, &normals, (r as u64, rows))).collect();
    let rows: Vec<Vec<f64>> = (0..1 + 2 * n).map(|sum| sums.iter().map(|of| of[sum]).collect()).collect();
    let of = |total: &[f64]| total[1..].iter().map(|sum| sum / total[0]).collect::<Vec<f64>>();
    let (values, errors, wide) = (of(&totals(&rows)), jackknife(of, &rows), student(REPLICATES));
    let share = |index: usize| Share { value: values[index], error: wide * errors[index] };
    values.iter().all(|value| value.is_finite()).then(|| (0..n).map(|j| [share(j), share(n + j)]).collect())
}

/// Variance, then the covariance of every factor alone, then half the mean square of the change by every factor.
fn exchanged(
    model: &Model<'_>,
    factors: &[Vec<usize>],
    normals: &Normals,
    (replicate, rows): (u64, usize),
) -> Vec<f64> {
    let n = factors.len();
    let mut first: Columns = normals.columns((1 << 34) + replicate, rows);
    let mut second: Columns = first.split_off(model.len());
    let (a, b) = (model.values(&first), model.values(&second));
    let both = || a.iter().chain(&b).filter(|y| y.is_finite());
    let count = both().count() as f64;
    let mean = both().sum::<f64>() / count;
    let variance = both().map(|y| (y - mean).powi(2)).sum::<f64>() / count;
    let mut sums = vec![variance; 1 + 2 * n];
    for (j, factor) in factors.iter().enumerate() {
        exchange(factor, &mut first, &mut second);
        let c = model.values(&first);
        exchange(factor, &mut first, &mut second);
        let valid = || a.iter().zip(&b).zip(&c).filter(|((a, b), c)| a.is_finite() && b.is_finite() && c.is_finite());
        let count = valid().count() as f64;
        sums[1 + j] = valid().map(|((a, b), c)| (b - mean) * (c - a)).sum::<f64>() / count;
        sums[1 + n + j] = valid().map(|((a, _), c)| 0.5 * (c - a).powi(2)).sum::<f64>() / count;
    }
    sums
}

fn exchange(factor: &[usize], first: &mut Columns, second: &mut Columns) {
    factor.iter().for_each(|&variable| std::mem::swap(&mut first[variable], &mut second[variable]));
}
