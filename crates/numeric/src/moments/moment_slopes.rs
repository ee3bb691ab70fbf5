//! Derivatives of the moments by the scales of the inputs, all from the matrices that the moments themselves need.
//!
//! The part of input `m` grows with the logarithm of the input's scale, and so do row and column `m` of `A`. The notation is that of
//! [`assemble`](crate::moments::cumulants), with a dot for the growth of the cumulants of the part. All is in units in which the variance of the
//! whole is 1:
//!
//! ```text
//! variance   2 p. p + curved. + 2 rho
//! kappa3     k3. + 6 (p. + p) Ap + 3 (q. + 2 q) rho + 6 Bq + 3 s Cs + 6 (A^3)_mm
//! kappa4     k4. + 12 [(w. + w) Ap + (p. + p) Aw] + 6 [(c22. + 2 c22) rho + 2 B c22] + 12 (q. + 2 q) Bq
//!            + 24 [(p. + p) AAp + (Ap)^2] + 4 [(c13. + 3 c13) Cs + 3 s C c13]
//!            + 12 [(p. + p) A(s rho) + 3 s rho Ap + 2 B(s Ap)] + 12 [(q. + 2 q) (A^3)_mm + 4 (A∘W) q] + 24 (A^4)_mm
//!            + 36 s (B∘W) s + 12 (A S B S A)_mm + 12 [k rho^2 + B(k rho)] + 4 k (B∘B) k
//! ```
//!
//! For normal inputs with parabolas these are the derivatives of the cumulants of a quadratic form: A. M. Mathai, S. B. Provost, "Quadratic
//! forms in random variables", Dekker (1992), section 3.2b.

use faer::linalg::matmul::matmul;
use faer::{Accum, Mat, Par};

use crate::moments::cumulants::Assembly;
use crate::moments::interactions::{Interactions, Kind};
use crate::moments::part::{JointCumulants, Term};
use crate::moments::unit_of;

/// Derivatives of mean, `ln sigma`, skewness and excess by the logarithm of every input's scale, at fixed means of the inputs. Returns None
/// if nothing varies, or a moment is infinite.
///
/// Shapes: `terms` and `growth` have length N. `growth` holds for each tabulated term the values of `u g'(u)` at the nodes of its rule.
/// Cost: that of the moments, and another product of N by N matrices if inputs are skewed.
pub(crate) fn growths(terms: &[Term<'_>], growth: &[Vec<f64>], interactions: &Interactions) -> Option<Vec<[f64; 4]>> {
    let (_, per_sigma) = unit_of(terms, interactions)?;
    let parts: Vec<JointCumulants> = terms.iter().map(|term| term.part(per_sigma)).collect();
    let whole = Assembly::of(&parts, interactions, per_sigma);
    let rows = rows(&parts, interactions, per_sigma);
    let slope = |m: usize| {
        let (part, d, row) = (&parts[m], terms[m].part_growth(per_sigma, &growth[m]), &rows[m]);
        let variance = 2.0 * d.p * part.p + d.curved + 2.0 * row.rho;
        let (p, q) = (d.p + part.p, d.q + 2.0 * part.q);
        let third =
            d.k3 + 6.0 * p * row.ap + 3.0 * q * row.rho + 6.0 * row.bq + 3.0 * part.s * row.cs + 6.0 * row.triangles;
        let fourth = d.k4
            + 12.0 * ((d.w + part.w) * row.ap + p * row.aw)
            + 6.0 * ((d.c22 + 2.0 * part.c22) * row.rho + 2.0 * row.bc22)
            + 12.0 * q * row.bq
            + 24.0 * (p * row.aap + row.ap * row.ap)
            + 4.0 * ((d.c13 + 3.0 * part.c13) * row.cs + 3.0 * part.s * row.cc13)
            + 12.0 * (p * row.asr + 3.0 * part.s * row.rho * row.ap + 2.0 * row.bsap)
            + 12.0 * (q * row.triangles + 4.0 * row.awq)
            + 24.0 * row.squares
            + 36.0 * part.s * row.bws
            + 12.0 * row.asbsa
            + 12.0 * (part.k * row.rho * row.rho + row.bkr)
            + 4.0 * part.k * row.bbk;
        [
            terms[m].mean_growth(&growth[m]),
            0.5 * variance,
            third - 1.5 * whole.skewness * variance,
            fourth - 2.0 * whole.excess * variance,
        ]
    };
    let slopes: Vec<[f64; 4]> = (0..parts.len()).map(slope).collect();
    slopes.iter().flatten().all(|slope| slope.is_finite()).then_some(slopes)
}

/// Sums over one row of the matrices.
#[derive(Debug, Clone, Copy, Default)]
struct Row {
    rho: f64,
    ap: f64,
    aw: f64,
    bq: f64,
    cs: f64,
    bc22: f64,
    cc13: f64,
    bbk: f64,
    /// Diagonal element `(A^3)_mm`.
    triangles: f64,
    /// Diagonal element `(A^4)_mm`.
    squares: f64,
    /// Element `((A∘W) q)_m`.
    awq: f64,
    /// Element `((B∘W) s)_m`.
    bws: f64,
    /// Elements `(A A p)_m`, `(A (s rho))_m`, `(B (s Ap))_m`, `(B (k rho))_m` and `(A S B S A)_mm`, in this order.
    aap: f64,
    asr: f64,
    bsap: f64,
    bkr: f64,
    asbsa: f64,
}

/// Sums over all rows of the matrices.
fn rows(parts: &[JointCumulants], interactions: &Interactions, factor: f64) -> Vec<Row> {
    let n = parts.len();
    let mut of = vec![Row::default(); n];
    let row = |j: usize| interactions.neighbours(j).map(|(k, a)| (k, factor * a));
    let product = Product::of(interactions, factor);
    let mut w = vec![0.0; n];
    for (j, sums) in of.iter_mut().enumerate() {
        product.row(j, &mut w);
        sums.squares = w.iter().map(|w| w * w).sum();
        for (k, a) in row(j) {
            let (part, b) = (&parts[k], a * a);
            sums.rho += b;
            sums.ap += a * part.p;
            sums.aw += a * part.w;
            sums.bq += b * part.q;
            sums.cs += a * b * part.s;
            sums.bc22 += b * part.c22;
            sums.cc13 += a * b * part.c13;
            sums.bbk += b * b * part.k;
            sums.triangles += a * w[k];
            sums.awq += a * w[k] * part.q;
            sums.bws += b * w[k] * part.s;
        }
    }
    let known: Vec<[f64; 2]> = of.iter().map(|row| [row.rho, row.ap]).collect();
    for (j, sums) in of.iter_mut().enumerate() {
        for (k, a) in row(j) {
            let (part, [rho, ap]) = (&parts[k], known[k]);
            sums.aap += a * ap;
            sums.asr += a * part.s * rho;
            sums.bsap += a * a * part.s * ap;
            sums.bkr += a * a * part.k * rho;
        }
    }
    if parts.iter().any(|part| part.s != 0.0) {
        of.iter_mut().zip(skewed(parts, interactions, factor)).for_each(|(sums, found)| sums.asbsa = found);
    }
    of
}

/// Product `W = A A`: all of it if `A` is dense, row by row if it is sparse.
enum Product<'a> {
    Sparse { rows: &'a [Vec<(usize, f64)>], factor: f64 },
    Dense(Mat<f64>),
}

impl<'a> Product<'a> {
    fn of(interactions: &'a Interactions, factor: f64) -> Self {
        match interactions.kind() {
            Kind::Sparse(rows) => Self::Sparse { rows, factor },
            Kind::Dense(matrix) => Self::Dense(times(matrix, matrix, factor * factor)),
        }
    }

    fn row(&self, j: usize, w: &mut [f64]) {
        match self {
            Self::Sparse { rows, factor } => {
                w.fill(0.0);
                for &(k, a) in &rows[j] {
                    rows[k].iter().for_each(|&(l, b)| w[l] += (factor * a) * (factor * b));
                }
            }
            Self::Dense(product) => w.copy_from_slice(product.col_as_slice(j)),
        }
    }
}

fn times(a: &Mat<f64>, b: &Mat<f64>, by: f64) -> Mat<f64> {
    let mut product = Mat::zeros(a.nrows(), b.ncols());
    matmul(&mut product, Accum::Replace, a, b, by, Par::Seq);
    product
}

/// Diagonal `(A S B S A)_mm`, with `S` the diagonal matrix of skewnesses and `B = A∘A`.
fn skewed(parts: &[JointCumulants], interactions: &Interactions, factor: f64) -> Vec<f64> {
    let n = parts.len();
    match interactions.kind() {
        Kind::Sparse(rows) => {
            let mut at = vec![0.0; n];
            let of = |row: &Vec<(usize, f64)>| {
                row.iter().for_each(|&(k, a)| at[k] = factor * a * parts[k].s);
                let through = |&(k, _): &(usize, f64)| {
                    let over: f64 = rows[k].iter().map(|&(l, b)| (factor * b).powi(2) * at[l]).sum();
                    at[k] * over
                };
                let sum: f64 = row.iter().map(through).sum();
                row.iter().for_each(|&(k, _)| at[k] = 0.0);
                sum
            };
            rows.iter().map(of).collect()
        }
        Kind::Dense(matrix) => {
            let through = Mat::from_fn(n, n, |k, m| factor * parts[k].s * matrix[(k, m)]);
            let squares = Mat::from_fn(n, n, |j, k| (factor * matrix[(j, k)]).powi(2));
            let product = times(&squares, &through, 1.0);
            let of = |m: usize| product.col_as_slice(m).iter().zip(through.col_as_slice(m)).map(|(a, b)| a * b).sum();
            (0..n).map(of).collect()
        }
    }
}
