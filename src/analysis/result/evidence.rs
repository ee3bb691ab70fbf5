//! Evidence of the figures of a characteristic: points of the model, the surface, and fitted distributions.

use serde::{Serialize, Serializer};

use crate::analysis::distribution::surface_law::SurfaceShares;
use crate::analysis::result::sampled_model::SampledModel;
use crate::analysis::result::sampled_tail::SampledTail;
use crate::analysis::result::verification::Verification;
use crate::method::Residual;
use sensitol_numeric::capability::{Capability, Law};
use sensitol_numeric::moments::Sampled;
use sensitol_numeric::pearson::PearsonError;
use sensitol_numeric::power::rescale;
use sensitol_numeric::sampling::SamplingInterval;

/// Sources of the figures of a characteristic, and those shown beside them.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Evidence {
    /// Standard errors of the moments from sampling the surrogate of correlated inputs. None if the moments are exact.
    #[serde(rename = "surrogate_sampling")]
    pub sampled: Option<Sampled>,
    /// Points of the model from which the moments follow, in place of a surrogate that was not trusted.
    #[serde(rename = "model_sampling")]
    pub model_sampled: Option<SampledModel>,
    /// Points of the model from which the yield follows, in tails at whose limits check points refute the surface.
    #[serde(rename = "tail_sampling")]
    pub tail_sampled: Option<SampledTail>,
    /// Verification of these results by the model itself. None if they were not verified.
    pub verification: Option<Verification>,
    /// Results of the surface distribution. None if the moments follow from no surface.
    pub surface_law: Option<SurfaceShares>,
    /// Density of the surface distribution as `[y, density, error]`, for drawing. None unless [requested](crate::Options::densities), and
    /// if the distribution has none.
    #[serde(skip)]
    pub density: Option<Vec<[f64; 3]>>,
    /// Residual of a fitted surface at the values that it was fitted to. None if nothing was fitted.
    #[serde(rename = "least_squares")]
    pub residual: Option<Residual>,
    /// Distribution of the Pearson system with these moments, or the reason why there is none.
    #[serde(rename = "distribution", serialize_with = "fitted")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<Law>"))]
    pub law: Option<Result<Law, PearsonError>>,
    /// Capability by the Pearson fit.
    #[serde(rename = "pearson_fit")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<sensitol_numeric::capability::CapabilityShape>"))]
    pub pearson: Option<Capability>,
    /// Capability by the normal distribution with the same mean and sigma.
    #[serde(rename = "normal_fit")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<sensitol_numeric::capability::CapabilityShape>"))]
    pub normal: Option<Capability>,
    /// Uncertainty of the results because measured dimensions are known by samples. None if there are no measured dimensions.
    #[serde(rename = "sampling_interval")]
    pub sampling: Option<SamplingInterval>,
}

rescale!(Evidence { sampled, model_sampled, verification, surface_law, residual, law, sampling } without {
    density, pearson, normal, tail_sampled,
});

/// Serializes the distribution that has the moments; null if there is none.
fn fitted<S: Serializer>(law: &Option<Result<Law, PearsonError>>, serializer: S) -> Result<S::Ok, S::Error> {
    law.as_ref().and_then(|law| law.as_ref().ok()).serialize(serializer)
}
