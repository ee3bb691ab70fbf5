//! Basis of the moments, kept so that other tolerances and means can be tried without further evaluations.

use crate::analysis::CharacteristicAnalysis;
use crate::method::Outcome;
use sensitol_numeric::moments::Contributions;
use sensitol_numeric::power::rescale;
use sensitol_numeric::surrogate::{InputShape, Inputs, Relocation, Surrogate};

/// Surrogates of all characteristics over the dimensions that vary.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Surface {
    /// Indices of the varying dimensions among the problem's dimensions.
    pub varying: Vec<usize>,
    /// Shapes of the varying dimensions, in that order.
    pub shapes: Vec<InputShape>,
    /// Basis of the moments of every characteristic, or the reason why they follow from no surrogate.
    pub characteristics: Vec<Result<Fit, NoFit>>,
}

/// Basis of the moments of one characteristic.
#[derive(Debug, Clone, PartialEq)]
pub struct Fit {
    /// Surrogate, with a known part for every varying dimension.
    pub surrogate: Surrogate,
    /// Standard deviation of the part that the surrogate does not explain, as estimated at check points.
    pub unexplained_sigma: Option<f64>,
    /// Products of the surrogate that are screened guesses, without an evaluation of their own.
    pub screened: usize,
}

/// Reason why the moments of a characteristic are not available at other tolerances.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoFit {
    /// Dimensions vary together.
    #[error("dimensions are correlated")]
    Correlated,
    /// The method integrates values at fixed points.
    #[error("its method integrates the values themselves and has no surrogate")]
    Integrated,
    /// The moments come from points of the model.
    #[error("its moments come from points of the model, as its surrogate was not trusted")]
    Sampled,
    /// There are no moments.
    #[error("its moments are unknown")]
    Unknown,
}

rescale!(Fit { surrogate, unexplained_sigma } without { screened });

impl Surface {
    pub(in crate::analysis) fn of(outcome: &Outcome, characteristics: &[CharacteristicAnalysis]) -> Self {
        let inputs = outcome.plan.inputs();
        let of = |(c, one): (usize, &CharacteristicAnalysis)| {
            let fitted = &outcome.fitted[c];
            if inputs.correlation().is_some() {
                return Err(NoFit::Correlated);
            }
            if fitted.integrated.is_some() {
                return Err(NoFit::Integrated);
            }
            if one.evidence.model_sampled.is_some() || one.evidence.verification.as_ref().is_some_and(|of| of.replaced)
            {
                return Err(NoFit::Sampled);
            }
            let known = |surrogate: &&Surrogate| surrogate.parts.iter().all(Option::is_some) && one.moments.is_some();
            let surrogate = fitted.surrogate.as_ref().filter(known).ok_or(NoFit::Unknown)?.clone();
            let unexplained = outcome.climbed.as_ref().and_then(|climbed| climbed.unexplained(c));
            Ok(Fit { surrogate, unexplained_sigma: unexplained.map(f64::sqrt), screened: fitted.screened })
        };
        Self {
            varying: outcome.plan.varying().to_vec(),
            shapes: inputs.shapes().to_vec(),
            characteristics: characteristics.iter().enumerate().map(of).collect(),
        }
    }

    /// Moments and contributions of one characteristic if inputs have moved and keep their shapes. Returns None if they follow from no
    /// surrogate.
    ///
    /// The variance that the surrogate does not explain stays as it is.
    ///
    /// Shapes: `moved` has an element for every varying dimension. No evaluation. The error is that of the surrogate at this distance from
    /// its nodes.
    ///
    /// ```
    /// use sensitol::{Closure, Dimension, Method, Problem, analyze};
    /// use sensitol::analysis::Relocation;
    /// let dimensions = [Dimension::normal("width", 20.0, 0.3)?, Dimension::normal("height", 10.0, 0.3)?];
    /// let area = Problem::new(dimensions, Closure::scalar("area", |x| x[0] * x[1]))?;
    /// let analysis = analyze(&area, &Method::Full.into())?;
    /// // Half the tolerance of the width.
    /// let moved = [Relocation { shift: 0.0, stretch: 0.5 }, Relocation { shift: 0.0, stretch: 1.0 }];
    /// let moments = analysis.surface.at(0, &moved).unwrap().moments;
    /// let exact = (2.0f64.powi(2) + 0.5f64.powi(2) + 0.005f64.powi(2)).sqrt();
    /// assert!((moments.sigma() - exact).abs() < 1e-12);
    /// # Ok::<(), sensitol::Error>(())
    /// ```
    pub fn at(&self, characteristic: usize, moved: &[Relocation]) -> Option<Contributions> {
        let fit = self.characteristics[characteristic].as_ref().ok()?;
        let found = fit.surrogate.relocated(moved).contributions(&Inputs::independent(self.shapes.clone()))?;
        Some(match fit.unexplained_sigma {
            Some(sigma) => found.beside(sigma),
            None => found,
        })
    }
}
