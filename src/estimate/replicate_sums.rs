//! Sums over points, one for every randomisation, and functions of the sums with their errors.

use crate::estimate::figures::{jackknife, student, totals};
use crate::estimate::verified::Verified;

/// A row for every sum, with a column for every randomisation.
pub(crate) struct ReplicateSums(Vec<Vec<f64>>);

impl ReplicateSums {
    /// Sums that are all 0.
    pub(crate) fn new(sums: usize, replicates: usize) -> Self {
        Self(vec![vec![0.0; replicates]; sums])
    }

    /// Sums with a row for every sum.
    pub(crate) fn by_sum(rows: Vec<Vec<f64>>) -> Self {
        Self(rows)
    }

    /// Sums with a row for every randomisation.
    pub(crate) fn by_replicate(rows: &[impl AsRef<[f64]>]) -> Self {
        let sums = rows.first().map_or(0, |row| row.as_ref().len());
        Self((0..sums).map(|sum| rows.iter().map(|row| row.as_ref()[sum]).collect()).collect())
    }

    pub(crate) fn add(&mut self, sum: usize, replicate: usize, value: f64) {
        self.0[sum][replicate] += value;
    }

    /// Sums over all randomisations.
    pub(crate) fn totals(&self) -> Vec<f64> {
        totals(&self.0)
    }

    /// Functions of the sums, and their standard errors by the jackknife.
    pub(crate) fn jackknifed(&self, of: impl Fn(&[f64]) -> Vec<f64>) -> (Vec<f64>, Vec<f64>) {
        (of(&self.totals()), jackknife(of, &self.0))
    }

    /// Functions of the sums. The standard errors are widened by Student's factor, because there are few randomisations.
    pub(crate) fn estimates(&self, of: impl Fn(&[f64]) -> Vec<f64>) -> Vec<Verified> {
        let (values, errors) = self.jackknifed(of);
        let wide = student(self.0.first().map_or(0, Vec::len));
        values.into_iter().zip(errors).map(|(value, error)| Verified { value, error: wide * error }).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Both layouts of the sums of 1, 2, 3, 4 give the mean 2.5 with the standard error `sqrt(5/12)`, widened for 4 randomisations
    /// (Student's t(3) at 0.99865 is 9.22: JCGM 100:2008, table G.2).
    #[test]
    fn both_layouts_have_the_error_of_a_mean() {
        let mean = |total: &[f64]| vec![total[1] / total[0]];
        let layouts = [
            ReplicateSums::by_sum(vec![vec![1.0; 4], vec![1.0, 2.0, 3.0, 4.0]]),
            ReplicateSums::by_replicate(&[[1.0, 1.0], [1.0, 2.0], [1.0, 3.0], [1.0, 4.0]]),
        ];
        for sums in layouts {
            let [Verified { value, error }] = sums.estimates(mean)[..] else { panic!("one figure") };
            assert_eq!(value, 2.5);
            // The table has three digits.
            assert!((error - 9.22 / 3.0 * (5.0f64 / 12.0).sqrt()).abs() < 2e-3, "{error}");
        }
    }
}
