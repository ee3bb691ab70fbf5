//! How the moments of a surface grow with the tolerances.

use super::{Inputs, Surrogate};
use crate::moments::growths;

impl Surrogate {
    /// Derivatives of mean, `ln sigma`, skewness and excess by the logarithm of every input's scale, at fixed means. None where inputs are
    /// correlated, a part is unknown, nothing varies, or a moment is infinite.
    ///
    /// Cost: as the moments, about twice.
    pub(crate) fn growths(&self, inputs: &Inputs) -> Option<Vec<[f64; 4]>> {
        if inputs.correlation().is_some() {
            return None;
        }
        let grown = self.parts.iter().zip(inputs.shapes());
        let growth: Vec<Vec<f64>> =
            grown.map(|(part, shape)| Some(part.as_ref()?.growth_at(&shape.rule.nodes))).collect::<Option<_>>()?;
        growths(&self.terms(inputs)?, &growth, &self.interactions)
    }
}
