//! Displacements of an assembly at one sigma of each characteristic.

use crate::Report;
use sensitol::analysis::CharacteristicAnalysis;
use sensitol::assembly::{Points, Run};
use sensitol_study::{Study, StudyError};

impl Report {
    /// Adds the displacements of parts and features at one sigma of each characteristic, upward. A report of a study without an assembly
    /// in space stays as it is.
    ///
    /// The displacements are those at the most probable point at which the tangent plane of a characteristic has moved by one sigma: dimension i moves by `sum_j C_ij g_j / sqrt(g C g)`, with covariances C and slopes g.
    ///
    /// # Errors
    /// Fails like [`Study::scene_deviations`].
    ///
    /// # Cost
    /// One evaluation of the closure equations for each characteristic.
    pub fn with_deviations(mut self, study: &Study, run: &Run<'_>) -> Result<Self, StudyError> {
        if self.assembly.is_none() {
            return Ok(self);
        }
        let rows: Vec<Vec<f64>> = self.analysis.characteristics.iter().map(|one| self.at_one_sigma(one)).collect();
        let found = study.scene_deviations(&Points::from_rows(&rows), run)?;
        if let Some(assembly) = &mut self.assembly {
            assembly.deviations = found.unwrap_or_default();
        }
        Ok(self)
    }

    /// Most probable point at which a characteristic has moved by one sigma.
    fn at_one_sigma(&self, one: &CharacteristicAnalysis) -> Vec<f64> {
        let slopes: Vec<f64> = one.sensitivities.iter().map(|row| row.first.unwrap_or(0.0)).collect();
        // Covariance of each dimension with the tangent plane.
        let mut moves: Vec<f64> =
            self.dimensions.iter().zip(&slopes).map(|(of, slope)| of.sigma * of.sigma * slope).collect();
        let place = |name: &String| self.dimensions.iter().position(|dimension| dimension.name == *name);
        for pair in &self.correlation {
            let [Some(i), Some(j)] = [place(&pair.between[0]), place(&pair.between[1])] else { continue };
            let covariance = pair.value * self.dimensions[i].sigma * self.dimensions[j].sigma;
            moves[i] += covariance * slopes[j];
            moves[j] += covariance * slopes[i];
        }
        let sigma = moves.iter().zip(&slopes).map(|(moved, slope)| moved * slope).sum::<f64>().max(0.0).sqrt();
        let by = if sigma > 0.0 { 1.0 / sigma } else { 0.0 };
        self.dimensions.iter().zip(&moves).map(|(of, moved)| of.nominal + by * moved).collect()
    }
}
