//! Outcome of a method.

use serde::Serialize;

use std::sync::Arc;

use crate::evaluation::Evaluated;
use crate::method::{AutoAccount, Basis, ExactDerivatives, Method, Order};
use crate::plan::{Mixed, Plan};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::power::rescale;
use sensitol_numeric::surrogate::{DerivativeOrigin, Surrogate, Univariate};

/// Outcome of a method: evaluations, surrogates and moments.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Outcome {
    /// Method that was requested.
    pub asked: Method,
    /// Method that was run.
    pub method: Method,
    /// Basis of the moments.
    pub basis: Basis,
    /// Plan that was evaluated.
    pub plan: Arc<dyn Plan>,
    /// Evaluations of the plan.
    pub evaluated: Evaluated,
    /// Order of the derivatives that the surrogates use.
    pub order: Order,
    /// Fit of every characteristic.
    pub fitted: Vec<Fitted>,
    /// Pairs that were examined, as positions among the varying dimensions.
    pub pairs: Vec<(usize, usize)>,
    /// Account of the refinement by `auto`; None for any other method.
    pub climbed: Option<AutoAccount>,
}

/// Fit of one characteristic.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Fitted {
    /// Value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Value with every dimension at its mean.
    pub centre: Option<f64>,
    /// Exact derivatives at the means; None if the assembly function has none, or was not asked for them.
    pub exact: Option<ExactDerivatives>,
    /// Univariate part of every dimension, in the problem's order; None if it is unknown or was not requested.
    pub parts: Vec<Option<Univariate>>,
    /// Mixed derivatives of the pairs examined, in sigmas; None if a derivative is lost or was not evaluated.
    pub mixed: Vec<Option<Mixed>>,
    /// Surrogate over the varying dimensions; None if there is no value at the means, and for a method without surrogate.
    pub surrogate: Option<Surrogate>,
    /// Moments of a method that integrates without a surrogate.
    pub integrated: Option<Integrated>,
    /// Reason why a method that is not a difference plan has no moments.
    pub lacking: Option<Lacking>,
    /// Residuals of a surrogate fitted by least squares, at the points of the fit.
    pub residual: Option<Residual>,
    /// Number of pairs whose mixed derivative was differentiated or evaluated.
    pub known_pairs: usize,
    /// Number of products of the surrogate that are estimates.
    pub screened: usize,
    /// Proof that the surrogate is the function; None if there is none.
    pub proof: Option<SurfaceProof>,
}

/// Proof that a surface is the function itself, with its rounding errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceProof {
    /// Degree of the polynomial that the function is.
    pub degree: u32,
    /// Rounding error of the mean: one rounding of every operation.
    pub mean: f64,
    /// Rounding error of sigma from the terms of the surface, in addition to the rounding of sigma itself.
    pub sigma: f64,
}

impl Fitted {
    /// Marks the parts of the fit as evaluated by the model.
    pub(super) fn evaluated(mut self) -> Self {
        let parts = self.surrogate.iter_mut().flat_map(|surrogate| &mut surrogate.parts).chain(&mut self.parts);
        parts.for_each(|part| *part = part.map(|part| part.with_origin(DerivativeOrigin::Evaluated)));
        self
    }
}

/// Moments that were integrated from values, with the effects of dimensions and pairs.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Integrated {
    /// Moments of the characteristic.
    pub moments: Moments,
    /// Effect of every varying dimension by itself; None for one that is correlated.
    pub own: Vec<Option<MainEffect>>,
    /// Joint effect of every examined pair; None if one of its dimensions is correlated.
    pub pairs: Vec<Option<InteractionEffect>>,
    /// Share of the variance that no contribution accounts for.
    pub left_out: Option<f64>,
    /// Number of nodes of the longest rule.
    pub nodes: usize,
}

/// Effect of one dimension by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MainEffect {
    /// Share of the variance that the best straight line explains.
    pub linear: f64,
    /// Share of the variance that the rest of the univariate part adds.
    pub curvature: f64,
    /// Shift of the mean by the univariate part; None if it cannot be separated from the effects of other dimensions.
    pub mean_shift: Option<f64>,
}

/// Joint effect of two dimensions, beyond the effects of each by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InteractionEffect {
    /// Share of the variance.
    pub share: f64,
    /// Shift of the mean by the joint effect; None if it cannot be separated from other effects.
    pub mean_shift: Option<f64>,
}

/// Reason why there are no moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lacking {
    /// Points of a quadrature have no value.
    Points {
        /// Number of points without a value.
        lost: usize,
        /// Number of all points of the quadrature.
        of: usize,
    },
    /// Too few points have a value for a fit of the surface.
    NotEstimable {
        /// Number of points with a value.
        left: usize,
        /// Number of coefficients of the surface.
        coefficients: usize,
    },
}

/// Residuals of a surrogate at the points that it was fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Residual {
    /// `sqrt(sum of squares / (points - coefficients))`, in the characteristic's unit; None if there are no more points than coefficients.
    #[serde(rename = "residual_standard_error")]
    pub standard_error: Option<f64>,
    /// Standard error of the mean that follows from the residuals; None if it is unknown or inputs are correlated.
    #[serde(rename = "mean_standard_error")]
    pub mean: Option<f64>,
    /// Standard error of sigma that follows from the residuals; None if it is unknown or inputs are correlated.
    #[serde(rename = "sigma_standard_error")]
    pub sigma: Option<f64>,
    /// Number of points of the fit.
    pub points: usize,
    /// Number of coefficients of the fit.
    pub coefficients: usize,
}

rescale!(Residual { standard_error, mean, sigma } without { points, coefficients });
