//! Independent standard normal variables made to vary together.

use faer::Mat;

use super::{Block, Correlation};

/// The normal variables behind correlated inputs, as a factor of their matrix makes them of independent ones (Nataf's law).
pub struct Together {
    /// Their positions among all variables.
    members: Vec<usize>,
    factor: Mat<f64>,
    blocks: Vec<Block>,
}

impl Together {
    /// Of a correlation among these variables.
    pub fn of(correlation: &Correlation) -> Self {
        Self {
            members: correlation.members().to_vec(),
            factor: correlation.factor(),
            blocks: correlation.blocks().to_vec(),
        }
    }

    /// Independent variables, a column each, with the members varying together.
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
