//! Parts of a simulation that take another form in JSON.

use serde::{Serialize, Serializer};

use sensitol_numeric::sampling::{Estimate, Sampler};

/// Sampler in JSON, as a method and by its name.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct SamplerShape {
    /// `monte-carlo` or `quasi-monte-carlo`.
    method: &'static str,
    /// `random` or `sobol`.
    sampler: &'static str,
}

impl From<&Sampler> for SamplerShape {
    fn from(sampler: &Sampler) -> Self {
        Self { method: sampler.method(), sampler: sampler.name() }
    }
}

/// Serializes an estimate without its standard error, which is written elsewhere.
pub(super) fn value<S: Serializer>(estimate: &Option<Estimate>, serializer: S) -> Result<S::Ok, S::Error> {
    estimate.map(|estimate| estimate.value).serialize(serializer)
}

/// Effect of a surrogate as control variate, in JSON.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct ControlShape {
    /// Method of the surrogate.
    pub(super) method: &'static str,
    /// Evaluations of the surrogate, for all characteristics together.
    pub(super) evaluations: usize,
    /// Reduction of standard errors.
    pub(super) reduction: Reduction,
}

/// Ratios of the standard errors without and with the surrogate; null if unknown or if the denominator is 0.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Reduction {
    /// Ratio for the mean.
    pub(super) mean: Option<f64>,
    /// Ratio for sigma.
    pub(super) sigma: Option<f64>,
}
