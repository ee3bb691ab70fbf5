//! Condition number of the closure conditions, from the blocks that are solved one after the other.
//!
//! A chain of parts has a triangular matrix. The condition number of the whole grows with the number of parts, although each part is held
//! firmly by the one before: a change that grows along the chain is the lever arm of its parts. The blocks on the diagonal have no lever arm
//! of other parts.

use faer::Mat;

use crate::assembly::implicit::order::{Block, Structure};

/// Condition number, and the unknown and equation that the conditions determine least.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct ConditionNumber {
    /// Ratio of the largest to the smallest singular value of all blocks.
    pub(super) value: f64,
    /// Unknown that is determined least.
    pub(super) unknown: usize,
    /// Equation that should determine it.
    pub(super) equation: usize,
}

/// Extreme singular values of a block.
struct Extremes {
    largest: f64,
    smallest: f64,
    unknown: usize,
    equation: usize,
}

/// Largest entry of a scaled matrix that counts as 0. Entries are sums of some products of the order of 1.
const ROUNDING: f64 = 1e-14;

impl ConditionNumber {
    /// Computes the condition number of a scaled matrix from the diagonal blocks of its block-triangular order. A matrix without such an
    /// order is singular, and is taken as one block.
    pub(super) fn of(matrix: &Mat<f64>) -> Self {
        let n = matrix.nrows();
        let entries = |row: usize| (0..n).filter(|&column| matrix[(row, column)].abs() > ROUNDING).collect();
        let uses: Vec<Vec<usize>> = (0..n).map(entries).collect();
        let whole = || vec![Block { equations: (0..n).collect(), unknowns: (0..n).collect() }];
        let blocks = Structure { slopes: uses.clone(), uses }.blocks().unwrap_or_else(whole);
        let extremes: Vec<Extremes> = blocks.iter().map(|block| Extremes::of(matrix, block)).collect();
        let largest = extremes.iter().map(|block| block.largest).fold(0.0, f64::max);
        let Some(weakest) = extremes.iter().min_by(|a, b| a.smallest.total_cmp(&b.smallest)) else {
            return Self { value: 1.0, unknown: 0, equation: 0 };
        };
        let value = if weakest.smallest > 0.0 { largest / weakest.smallest } else { f64::INFINITY };
        Self { value, unknown: weakest.unknown, equation: weakest.equation }
    }
}

impl Extremes {
    fn of(matrix: &Mat<f64>, block: &Block) -> Self {
        let Block { equations, unknowns } = block;
        let n = equations.len();
        let Ok(svd) = Mat::from_fn(n, n, |i, j| matrix[(equations[i], unknowns[j])]).svd() else {
            return Self { largest: 1.0, smallest: 0.0, unknown: unknowns[0], equation: equations[0] };
        };
        let strongest =
            |part: &dyn Fn(usize) -> f64| (0..n).max_by(|&a, &b| part(a).abs().total_cmp(&part(b).abs())).unwrap_or(0);
        let s = svd.S().column_vector();
        Self {
            largest: s[0],
            smallest: s[n - 1],
            unknown: unknowns[strongest(&|j| svd.V()[(j, n - 1)])],
            equation: equations[strongest(&|i| svd.U()[(i, n - 1)])],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::ConditionNumber;
    use faer::Mat;
    use std::cmp::Ordering;

    /// Lower triangular matrix with 1 on the diagonal and -1 below it: its inverse has entries up to `2^(n - 2)` (Wilkinson 1965), and each
    /// unknown is determined by an equation of its own.
    #[test]
    fn a_chain_is_as_well_determined_as_its_links() {
        let entry = |i: usize, j: usize| match i.cmp(&j) {
            Ordering::Less => 0.0,
            Ordering::Equal => 1.0,
            Ordering::Greater => -1.0,
        };
        assert_eq!(ConditionNumber::of(&Mat::from_fn(30, 30, entry)).value, 1.0);
    }

    /// A ring is one block: `[[1, 1], [1, 1 + e]]` has the singular values 2 and e/2 to first order. The chain before it changes nothing.
    #[test]
    fn a_weak_block_is_found_within_a_chain() {
        let e = 1e-6;
        let matrix = Mat::from_fn(3, 3, |i, j| [[1.0, 0.0, 0.0], [0.7, 1.0, 1.0], [0.3, 1.0, 1.0 + e]][i][j]);
        let number = ConditionNumber::of(&matrix);
        // The second-order terms are e of the ratio, and rounding of the smallest singular value is 1e-16 / e.
        assert!((number.value * e / 4.0 - 1.0).abs() < 1e-5, "{number:?}");
        assert!(number.unknown > 0 && number.equation > 0, "{number:?}");
    }

    /// A single weak equation is measured by the largest singular value of all blocks, and an empty one is singular.
    #[test]
    fn a_weak_equation_is_found_beside_others() {
        let diagonal = |weak: f64| {
            Mat::from_fn(3, 3, |i, j| {
                if i != j {
                    0.0
                } else if i == 1 {
                    weak
                } else {
                    2.0
                }
            })
        };
        assert_eq!(
            ConditionNumber::of(&diagonal(1e-3)),
            ConditionNumber { value: 2.0 / 1e-3, unknown: 1, equation: 1 }
        );
        let none = ConditionNumber::of(&diagonal(0.0));
        assert_eq!((none.value, none.unknown, none.equation), (f64::INFINITY, 1, 1));
    }
}
