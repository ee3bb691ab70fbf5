//! Means and covariances of several quantities observed together, which can be merged.

/// Count, means and sums of products about the means. Memory does not grow with the sample.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Joint<const M: usize> {
    count: u64,
    means: [f64; M],
    /// Sums of products `sum (a_i - mean_i)(a_k - mean_k)`.
    products: [[f64; M]; M],
}

impl<const M: usize> Default for Joint<M> {
    fn default() -> Self {
        Self { count: 0, means: [0.0; M], products: [[0.0; M]; M] }
    }
}

impl<const M: usize> Joint<M> {
    /// Sums of these rows, in two passes.
    pub fn of(rows: &[[f64; M]]) -> Self {
        let mut joint = Self { count: rows.len() as u64, ..Self::default() };
        let n = rows.len().max(1) as f64;
        for row in rows {
            joint.means.iter_mut().zip(row).for_each(|(mean, value)| *mean += value / n);
        }
        for row in rows {
            let apart: [f64; M] = std::array::from_fn(|i| row[i] - joint.means[i]);
            joint.add_products(&apart, 1.0);
        }
        joint
    }

    /// Adds another sample (Pébay 2008, equation 3.12).
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let apart: [f64; M] = std::array::from_fn(|i| other.means[i] - self.means[i]);
        for (row, more) in self.products.iter_mut().zip(&other.products) {
            row.iter_mut().zip(more).for_each(|(sum, more)| *sum += more);
        }
        self.add_products(&apart, a * b / (a + b));
        self.means.iter_mut().zip(apart).for_each(|(mean, apart)| *mean += apart * b / (a + b));
        self.count += other.count;
    }

    fn add_products(&mut self, apart: &[f64; M], factor: f64) {
        for (row, a) in self.products.iter_mut().zip(apart) {
            row.iter_mut().zip(apart).for_each(|(sum, b)| *sum += factor * a * b);
        }
    }

    /// Number of rows.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Means of the quantities.
    pub fn means(&self) -> &[f64; M] {
        &self.means
    }

    /// Sums of products `sum (a_i - mean_i)(a_k - mean_k)`.
    pub fn products(&self) -> &[[f64; M]; M] {
        &self.products
    }

    /// Standard error of the sum of the means times these factors. Returns None for fewer than two rows.
    pub fn standard_error(&self, by: &[f64; M]) -> Option<f64> {
        let n = self.count as f64;
        let sum: f64 = (0..M * M).map(|i| by[i / M] * by[i % M] * self.products[i / M][i % M]).sum();
        (self.count > 1).then(|| (sum.max(0.0) / (n - 1.0) / n).sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Merged parts equal the whole. For (1, 2), (3, 5), (4, -1), (0, 0) the products about the means (2, 1.5) are 10, 21 and 1 by hand.
    #[test]
    fn parts_merge_to_the_whole() {
        let rows = [[1.0, 2.0], [3.0, 5.0], [4.0, -1.0], [0.0, 0.0]];
        for cut in 0..=rows.len() {
            let mut joint = Joint::of(&rows[..cut]);
            joint.merge(&Joint::of(&rows[cut..]));
            assert_eq!(joint.count(), 4);
            // Tolerance: a few roundings of sums near 20.
            let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-13, "{found} for {expected}");
            near(joint.means()[0], 2.0);
            near(joint.means()[1], 1.5);
            near(joint.products[0][0], 10.0);
            near(joint.products[1][1], 21.0);
            near(joint.products[0][1], 1.0);
            near(joint.standard_error(&[1.0, 0.0]).unwrap(), (10.0f64 / 12.0).sqrt());
            near(joint.standard_error(&[1.0, -1.0]).unwrap(), (29.0f64 / 12.0).sqrt());
        }
    }
}
