//! Products of two inputs: the matrix `A`, symmetric with a zero diagonal.

use faer::Mat;

use crate::power::{Rescale, Rescaling};

/// Coefficients of `u_j u_k`, stored dense or sparse, whichever is cheaper.
#[derive(Debug, Clone, PartialEq)]
pub struct Interactions {
    dimensions: usize,
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Kind {
    /// Neighbours of each row with their coefficients, ascending.
    Sparse(Vec<Vec<(usize, f64)>>),
    Dense(Mat<f64>),
}

/// Products of one input with others.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Row<'a> {
    /// Products with these inputs, ascending.
    Sparse(&'a [(usize, f64)]),
    /// Products with every input, 0 if there is none.
    Dense(&'a [f64]),
}

impl Rescale for Interactions {
    fn rescale(&mut self, by: &mut Rescaling) {
        match &mut self.kind {
            Kind::Sparse(rows) => rows.iter_mut().flatten().for_each(|(_, value)| value.rescale(by)),
            Kind::Dense(matrix) => {
                (0..matrix.ncols()).for_each(|j| (0..matrix.nrows()).for_each(|k| matrix[(k, j)].rescale(by)));
            }
        }
    }
}

impl Interactions {
    /// Interactions of `dimensions` inputs without any product.
    pub fn none(dimensions: usize) -> Self {
        Self { dimensions, kind: Kind::Sparse(vec![Vec::new(); dimensions]) }
    }

    /// Interactions from pairs `(j, k, A_jk)`, each pair once, in any order.
    ///
    /// # Panics
    /// If an index is not below `dimensions`, or `j` is `k`.
    pub fn of_pairs(dimensions: usize, pairs: impl IntoIterator<Item = (usize, usize, f64)>) -> Self {
        let mut rows = vec![Vec::new(); dimensions];
        for (j, k, value) in pairs {
            assert!(j != k && j < dimensions && k < dimensions, "no pair of {dimensions} inputs: {j} and {k}");
            rows[j].push((k, value));
            rows[k].push((j, value));
        }
        // The sparse product costs the sum of squared degrees. Each such step takes about ten times as long as one of the N^3
        // multiplications of the dense product.
        let sparse: usize = rows.iter().map(|row| row.len() * row.len()).sum();
        if 10 * sparse <= dimensions * dimensions * dimensions || dimensions < 8 {
            rows.iter_mut().for_each(|row| row.sort_unstable_by_key(|&(k, _)| k));
            return Self { dimensions, kind: Kind::Sparse(rows) };
        }
        let mut matrix = Mat::zeros(dimensions, dimensions);
        for (j, row) in rows.iter().enumerate() {
            row.iter().for_each(|&(k, value)| matrix[(k, j)] = value);
        }
        Self { dimensions, kind: Kind::Dense(matrix) }
    }

    /// Number of inputs, N.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// All pairs with a coefficient that is not 0, as `(j, k, A_jk)` with `j < k`.
    pub fn pairs(&self) -> Vec<(usize, usize, f64)> {
        self.each_pair().collect()
    }

    /// Iterates over the pairs of [`pairs`](Self::pairs), without a list.
    pub fn each_pair(&self) -> impl Iterator<Item = (usize, usize, f64)> + '_ {
        let dense = matches!(self.kind, Kind::Dense(_));
        let of_row = move |j| self.neighbours(j).filter(move |&(k, _)| j < k).map(move |(k, value)| (j, k, value));
        (0..self.dimensions).flat_map(of_row).filter(move |&(_, _, value)| !dense || value != 0.0)
    }

    /// Products of one input, as `(k, A_jk)`.
    pub(crate) fn neighbours(&self, j: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let (sparse, dense) = match self.row(j) {
            Row::Sparse(row) => (row, &[][..]),
            Row::Dense(row) => (&[][..], row),
        };
        sparse.iter().copied().chain(dense.iter().copied().enumerate())
    }

    /// Products of one input in the form in which they are stored.
    pub(crate) fn row(&self, j: usize) -> Row<'_> {
        match &self.kind {
            Kind::Sparse(rows) => Row::Sparse(&rows[j]),
            Kind::Dense(matrix) => Row::Dense(matrix.col_as_slice(j)),
        }
    }

    /// Interactions with `by_j by_k A_jk` in place of `A_jk`.
    ///
    /// Shapes: `by` has length N.
    pub fn scaled(&self, by: &[f64]) -> Self {
        let kind = match &self.kind {
            Kind::Sparse(rows) => {
                let row = |(j, row): (usize, &Vec<(usize, f64)>)| {
                    row.iter().map(|&(k, value)| (k, by[j] * by[k] * value)).collect()
                };
                Kind::Sparse(rows.iter().enumerate().map(row).collect())
            }
            Kind::Dense(matrix) => {
                Kind::Dense(Mat::from_fn(self.dimensions, self.dimensions, |j, k| by[j] * by[k] * matrix[(j, k)]))
            }
        };
        Self { dimensions: self.dimensions, kind }
    }

    /// Rough number of multiplications that the moments of these products need.
    pub fn work(&self) -> usize {
        match &self.kind {
            Kind::Sparse(rows) => rows.iter().map(|row| row.len() * row.len()).sum(),
            Kind::Dense(_) => self.dimensions.saturating_pow(3),
        }
    }

    pub(super) fn kind(&self) -> &Kind {
        &self.kind
    }

    pub(super) fn largest(&self) -> f64 {
        self.fold(0.0, |largest, value| largest.max(value.abs()))
    }

    /// Variance of `factor` times all products.
    pub(crate) fn variance(&self, factor: f64) -> f64 {
        0.5 * self.fold(0.0, |sum, value| sum + (factor * value) * (factor * value))
    }

    /// Folds over the coefficients of both halves of the matrix.
    fn fold(&self, start: f64, mut step: impl FnMut(f64, f64) -> f64) -> f64 {
        let mut folded = start;
        match &self.kind {
            Kind::Sparse(rows) => rows.iter().flatten().for_each(|&(_, value)| folded = step(folded, value)),
            Kind::Dense(matrix) => {
                matrix.col_iter().for_each(|column| column.iter().for_each(|&value| folded = step(folded, value)));
            }
        }
        folded
    }
}
