//! Independent standard normal variables made to vary together.

use faer::Mat;

use super::Correlation;

/// The normal variables behind correlated inputs, as a factor of their matrix makes them of independent ones (Nataf's law).
pub(crate) struct Together {
    /// Their positions among all variables.
    members: Vec<usize>,
    factor: Mat<f64>,
}

impl Together {
    /// Of a correlation among these variables.
    pub(crate) fn of(correlation: &Correlation) -> Self {
        Self { members: correlation.members().to_vec(), factor: correlation.factor() }
    }

    /// Independent variables, a column each, with the members varying together.
    pub(crate) fn apply(&self, normals: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let mut columns = normals.to_vec();
        for (j, &member) in self.members.iter().enumerate() {
            let column = &mut columns[member];
            column.fill(0.0);
            for (k, &other) in self.members.iter().enumerate() {
                let by = self.factor[(j, k)];
                if by != 0.0 {
                    column.iter_mut().zip(&normals[other]).for_each(|(z, normal)| *z += by * normal);
                }
            }
        }
        columns
    }
}
