//! The outcome of a method.

use serde::Serialize;

use std::sync::Arc;

use super::{Basis, Climbed, ExactDerivatives, Method, Order};
use crate::evaluation::Evaluated;
use crate::plan::{Mixed, Plan};
use sensitol_numeric::moments::Moments;
use sensitol_numeric::power::rescale;
use sensitol_numeric::surrogate::{DerivativeOrigin, Surrogate, Univariate};

/// The outcome of a method.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Outcome {
    /// The method that was asked for.
    pub asked: Method,
    /// The method that was run.
    pub method: Method,
    /// The basis of the moments.
    pub basis: Basis,
    /// Its plan.
    pub plan: Arc<dyn Plan>,
    /// Its evaluations.
    pub evaluated: Evaluated,
    /// How much of it the surrogates use.
    pub order: Order,
    /// For every characteristic what is known of it.
    pub fitted: Vec<Fitted>,
    /// The pairs that were examined, as positions among the varying dimensions.
    pub pairs: Vec<(usize, usize)>,
    /// How `auto` came to its result; None for any other method.
    pub climbed: Option<Climbed>,
}

/// The fit of one characteristic.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct Fitted {
    /// Its value at the nominal dimensions.
    pub nominal: Option<f64>,
    /// Its value with every dimension at its mean.
    pub centre: Option<f64>,
    /// The derivatives at the means as the assembly function knows them; None where it does not, or was not asked.
    pub exact: Option<ExactDerivatives>,
    /// Every dimension's own part, in the problem's order; None where it is unknown or was not asked for.
    pub parts: Vec<Option<Univariate>>,
    /// The mixed derivatives of the pairs examined, in sigma units; None where lost or not differentiated.
    pub mixed: Vec<Option<Mixed>>,
    /// The surrogate over the varying dimensions; None without a value at the means, and where a method has none.
    pub surrogate: Option<Surrogate>,
    /// The moments of a method that integrates without a surrogate.
    pub integrated: Option<Integrated>,
    /// Why a method that is not a difference plan has no moments.
    pub lacking: Option<Lacking>,
    /// How far a surrogate of least squares misses the values that it was fitted to.
    pub residual: Option<Residual>,
    /// The number of pairs whose mixed derivative was differentiated or evaluated.
    pub known_pairs: usize,
    /// The number of products of the surrogate that are estimates.
    pub screened: usize,
    /// The proof that the surrogate is the function; None where there is none.
    pub proof: Option<SurfaceProof>,
}

/// Knowledge about a surface that is the function itself.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SurfaceProof {
    /// The degree of the polynomial.
    pub degree: u32,
    /// One rounding of every operation, in the mean.
    pub mean: f64,
    /// The same in sigma, beside that of sigma itself.
    pub sigma: f64,
}

impl Fitted {
    /// Returns the fit with its parts as answers of a model.
    pub(super) fn evaluated(mut self) -> Self {
        let parts = self.surrogate.iter_mut().flat_map(|surrogate| &mut surrogate.parts).chain(&mut self.parts);
        parts.for_each(|part| *part = part.map(|part| part.with_origin(DerivativeOrigin::Evaluated)));
        self
    }
}

/// Moments that were integrated from values, and what they are made of.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Integrated {
    /// The moments.
    pub moments: Moments,
    /// For every varying dimension what it does by itself; None for one that is correlated.
    pub own: Vec<Option<MainEffect>>,
    /// For every pair examined what the two do together; None where one of them is correlated.
    pub pairs: Vec<Option<InteractionEffect>>,
    /// The share of the variance that no contribution accounts for.
    pub left_out: Option<f64>,
    /// Nodes of the longest rule.
    pub nodes: usize,
}

/// The effect of one dimension by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct MainEffect {
    /// Share of the variance that the best straight line explains.
    pub linear: f64,
    /// Share that the rest of its own part adds.
    pub curvature: f64,
    /// How far its own part moves the mean; None where that is not known apart from what others do.
    pub mean_shift: Option<f64>,
}

/// The joint effect of two dimensions, beyond the effects of each by itself.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct InteractionEffect {
    /// Share of the variance.
    pub share: f64,
    /// How far it moves the mean; None where that is not known apart from what others do.
    pub mean_shift: Option<f64>,
}

/// Why there are no moments.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lacking {
    /// Points of a quadrature have no value.
    Points {
        /// How many.
        lost: usize,
        /// Of how many.
        of: usize,
    },
    /// Too few points are left to fit the surface.
    NotEstimable {
        /// How many are left.
        left: usize,
        /// How many coefficients there are.
        coefficients: usize,
    },
}

/// How far a surrogate misses the values that it was fitted to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Residual {
    /// `sqrt(sum of squares / (points - coefficients))`, in the characteristic's unit; None where there are no more points
    /// than coefficients.
    #[serde(rename = "residual_standard_error")]
    pub standard_error: Option<f64>,
    /// The standard error of the mean from that; None where it is unknown or inputs are correlated.
    #[serde(rename = "mean_standard_error")]
    pub mean: Option<f64>,
    /// The same of sigma.
    #[serde(rename = "sigma_standard_error")]
    pub sigma: Option<f64>,
    /// Points that were fitted.
    pub points: usize,
    /// Coefficients.
    pub coefficients: usize,
}

rescale!(Residual { standard_error, mean, sigma } without { points, coefficients });
