//! Points in `N` dimensions.

/// Set of `R` points in `N` dimensions, stored one column per dimension.
///
/// ```
/// use sensitol_numeric::points::Points;
/// let points = Points::from_rows(&[[10.0, 30.0], [10.5, 30.0], [10.0, 30.0]]);
/// assert_eq!(points.column(0), [10.0, 10.5, 10.0]);
/// assert_eq!(points.row(1), [10.5, 30.0]);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Points {
    rows: usize,
    dimensions: usize,
    values: Vec<f64>,
}

impl Points {
    /// Points with `rows` copies of one point.
    pub fn repeated(point: &[f64], rows: usize) -> Self {
        let mut values = Vec::with_capacity(point.len() * rows);
        for &value in point {
            values.extend(std::iter::repeat_n(value, rows));
        }
        Self { rows, dimensions: point.len(), values }
    }

    /// Points with columns that `column` writes, given the index of the dimension.
    pub fn written(rows: usize, dimensions: usize, mut column: impl FnMut(usize, &mut [f64])) -> Self {
        let mut points = Self { rows, dimensions, values: vec![0.0; rows * dimensions] };
        (0..dimensions).for_each(|dimension| column(dimension, points.column_mut(dimension)));
        points
    }

    /// Resizes to this number of points. The values are undefined afterwards.
    pub fn resize(&mut self, rows: usize, dimensions: usize) {
        (self.rows, self.dimensions) = (rows, dimensions);
        self.values.resize(rows * dimensions, 0.0);
    }

    /// Points from all values, one column after the other.
    pub fn of_values(rows: usize, dimensions: usize, values: Vec<f64>) -> Self {
        assert_eq!(values.len(), rows * dimensions, "columns of different length");
        Self { rows, dimensions, values }
    }

    /// Points from one row per point. Every row must have the same length.
    pub fn from_rows<R: AsRef<[f64]>>(rows: &[R]) -> Self {
        let dimensions = rows.first().map_or(0, |row| row.as_ref().len());
        let mut points = Self { rows: rows.len(), dimensions, values: vec![0.0; rows.len() * dimensions] };
        for (r, row) in rows.iter().enumerate() {
            assert_eq!(row.as_ref().len(), dimensions, "points of different dimension");
            for (d, &value) in row.as_ref().iter().enumerate() {
                points.set(r, d, value);
            }
        }
        points
    }

    /// Points from one column per dimension. Every column must have `rows` values.
    pub fn from_columns<C: AsRef<[f64]>>(rows: usize, columns: &[C]) -> Self {
        let mut values = Vec::with_capacity(rows * columns.len());
        for column in columns {
            assert_eq!(column.as_ref().len(), rows, "columns of different length");
            values.extend_from_slice(column.as_ref());
        }
        Self { rows, dimensions: columns.len(), values }
    }

    /// Number of points.
    pub fn rows(&self) -> usize {
        self.rows
    }

    /// Number of dimensions, `N`.
    pub fn dimensions(&self) -> usize {
        self.dimensions
    }

    /// All values of one dimension.
    pub fn column(&self, dimension: usize) -> &[f64] {
        &self.values[dimension * self.rows..(dimension + 1) * self.rows]
    }

    /// Mutable values of one dimension.
    pub fn column_mut(&mut self, dimension: usize) -> &mut [f64] {
        &mut self.values[dimension * self.rows..(dimension + 1) * self.rows]
    }

    /// Coordinates of one point.
    pub fn row(&self, row: usize) -> Vec<f64> {
        (0..self.dimensions).map(|dimension| self.column(dimension)[row]).collect()
    }

    /// Writes some points to `out`, one after the other, and replaces its content.
    pub fn rows_to(&self, rows: std::ops::Range<usize>, out: &mut Vec<f64>) {
        /// Columns read side by side, so that a row is written a cache line at a time.
        const SIDE: usize = 8;
        let n = self.dimensions;
        out.resize(rows.len() * n, 0.0);
        for first in (0..n).step_by(SIDE) {
            let last = n.min(first + SIDE);
            for (row, at) in rows.clone().enumerate() {
                let own = &mut out[row * n + first..row * n + last];
                own.iter_mut().zip(first..last).for_each(|(x, dimension)| *x = self.values[dimension * self.rows + at]);
            }
        }
    }

    /// Changes one coordinate of one point.
    pub fn set(&mut self, row: usize, dimension: usize, value: f64) {
        self.values[dimension * self.rows + row] = value;
    }
}
