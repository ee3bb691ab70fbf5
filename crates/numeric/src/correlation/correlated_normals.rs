//! Dependence imposed on independent standard normal variables.

use faer::Mat;

use crate::correlation::{Block, Correlation};

/// Map from independent normal variables to those behind correlated inputs, by a factor of their matrix and by blocks (Nataf's
/// distribution).
pub struct Together {
    /// Positions of the members among all variables.
    members: Vec<usize>,
    factor: Mat<f64>,
    blocks: Vec<Block>,
}

impl Together {
    /// Map for a correlation among these variables.
    pub fn of(correlation: &Correlation) -> Self {
        Self {
            members: correlation.members().to_vec(),
            factor: correlation.factor(),
            blocks: correlation.blocks().to_vec(),
        }
    }

    /// Maps independent variables, one column each, to columns in which the members are dependent.
    pub fn apply(&self, normals: &[Vec<f64>]) -> Vec<Vec<f64>> {
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
        let rows = columns.first().map_or(0, Vec::len);
        for block in &self.blocks {
            let (mut place, mut scratch) = (vec![0.0; columns.len()], Vec::new());
            #[expect(clippy::needless_range_loop, reason = "a point is a row over several columns")]
            for row in 0..rows {
                block.members.iter().for_each(|&member| place[member] = columns[member][row]);
                block.apply(&mut place, &mut scratch);
                block.members.iter().for_each(|&member| columns[member][row] = place[member]);
            }
        }
        columns
    }
}
