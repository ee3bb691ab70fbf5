//! Third and fourth cumulant of the whole from the cumulants of its parts.
//!
//! With `B = A∘A`, `C = A∘A∘A`, `W = A A`, `rho = B 1`, and the cumulants of the parts as vectors, all in units in which the variance of
//! the whole is 1:
//!
//! ```text
//! kappa3 = sum k3 + 3 p'A p + 3 q'rho + (1/2) s'C s + sum_jk A_jk W_jk
//! kappa4 = sum k4 + 12 w'A p + 6 c22'rho + 6 q'B q + 12 |A p|^2 + 4 c13'C s + 12 sum_j s_j rho_j (A p)_j
//!        + 12 sum_j q_j (sum_k A_jk W_jk) + 3 sum_jk W_jk^2 + 6 s'(B∘W) s + 3 sum_j k_j rho_j^2
//!        + (1/2) k'(B∘B) k
//! ```

use crate::parallel::prelude::*;
use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use crate::moments::interactions::{Interactions, Kind};
use crate::moments::part::JointCumulants;
use crate::moments::sum::exact;

/// Skewness and excess of the whole.
pub(super) struct Assembly {
    pub(super) skewness: f64,
    pub(super) excess: f64,
}

/// Sums over one row of the matrices in the formulas.
#[derive(Clone, Copy, Default)]
struct Row {
    rho: f64,
    ap: f64,
    aw: f64,
    ww: f64,
    /// Element j of the vectors `C s`, `B q`, `(B∘W) s` and `(B∘B) k`.
    cs: f64,
    bq: f64,
    bws: f64,
    bbk: f64,
}

impl Row {
    /// Adds column `k`, with the elements `a` and `w` of the matrices and the cumulants `part` of the input.
    #[inline]
    fn add(&mut self, a: f64, w: f64, part: &JointCumulants) {
        let b = a * a;
        self.rho += b;
        self.ap += a * part.p;
        self.aw += a * w;
        self.cs += b * a * part.s;
        self.bq += b * part.q;
        self.bws += b * w * part.s;
        self.bbk += b * b * part.k;
    }
}

impl Assembly {
    /// Assembles the cumulants. `factor` scales the interactions in the same way as the parts are scaled.
    pub(super) fn of(parts: &[JointCumulants], interactions: &Interactions, factor: f64) -> Self {
        let rows = match interactions.kind() {
            Kind::Sparse(rows) => sparse(parts, rows, factor),
            Kind::Dense(matrix) => dense(parts, matrix, factor),
        };
        let over = |term: &dyn Fn(&JointCumulants, &Row) -> f64| {
            exact(parts.iter().zip(&rows).map(|(part, row)| term(part, row)))
        };
        let skewness = [
            over(&|part, _| part.k3),
            3.0 * over(&|part, row| part.p * row.ap),
            3.0 * over(&|part, row| part.q * row.rho),
            0.5 * over(&|part, row| part.s * row.cs),
            over(&|_, row| row.aw),
        ];
        let excess = [
            over(&|part, _| part.k4),
            12.0 * over(&|part, row| part.w * row.ap),
            6.0 * over(&|part, row| part.c22 * row.rho),
            6.0 * over(&|part, row| part.q * row.bq),
            12.0 * over(&|_, row| row.ap * row.ap),
            4.0 * over(&|part, row| part.c13 * row.cs),
            12.0 * over(&|part, row| part.s * row.rho * row.ap),
            12.0 * over(&|part, row| part.q * row.aw),
            3.0 * over(&|_, row| row.ww),
            6.0 * over(&|part, row| part.s * row.bws),
            3.0 * over(&|part, row| part.k * row.rho * row.rho),
            0.5 * over(&|part, row| part.k * row.bbk),
        ];
        Self { skewness: exact(skewness), excess: exact(excess) }
    }
}

/// Sums of all rows, computed row by row so that only one row of `W` exists at a time.
fn sparse(parts: &[JointCumulants], rows: &[Vec<(usize, f64)>], factor: f64) -> Vec<Row> {
    let mut w = vec![0.0; rows.len()];
    let mut touched = Vec::new();
    let sums = rows.iter().map(|row| {
        for &(k, a) in row {
            for &(l, b) in &rows[k] {
                if w[l] == 0.0 {
                    touched.push(l);
                }
                w[l] += (factor * a) * (factor * b);
            }
        }
        let mut sums = Row::default();
        row.iter().for_each(|&(k, a)| sums.add(factor * a, w[k], &parts[k]));
        for l in touched.drain(..) {
            // An element that cancelled to 0 on the way is listed twice, and is 0 the second time.
            sums.ww += w[l] * w[l];
            w[l] = 0.0;
        }
        sums
    });
    sums.collect()
}

/// Columns of `W` in one block. Each column has the same bits as in one product of the whole matrices, for any number of threads.
const COLUMNS: usize = 256;

fn dense(parts: &[JointCumulants], matrix: &Mat<f64>, factor: f64) -> Vec<Row> {
    let n = parts.len();
    let a = Mat::from_fn(n, n, |j, k| factor * matrix[(j, k)]);
    let blocks = n.div_ceil(COLUMNS);
    let of_block = |block: usize| -> Vec<Row> {
        let (first, end) = (block * n / blocks, (block + 1) * n / blocks);
        let mut w = Mat::zeros(n, end - first);
        matmul(&mut w, Accum::Replace, &a, a.subcols(first, end - first), 1.0, Par::Seq);
        let of_column = |column: usize| {
            let mut sums = Row::default();
            let both = a.col_as_slice(first + column).iter().zip(w.col_as_slice(column));
            for ((&a, &w), part) in both.zip(parts) {
                sums.add(a, w, part);
                sums.ww += w * w;
            }
            sums
        };
        (0..end - first).map(of_column).collect()
    };
    let rows: Vec<Vec<Row>> = (0..blocks).into_par_iter().map(of_block).collect();
    rows.concat()
}
