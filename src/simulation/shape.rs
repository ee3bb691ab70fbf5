//! Parts of a simulation that take another form in JSON.

use serde::{Serialize, Serializer};

use sensitol_numeric::sampling::{Estimate, Sampler};

/// A sampler as a method and as itself.
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

/// An estimate without its standard error, which stands elsewhere.
pub(super) fn value<S: Serializer>(estimate: &Option<Estimate>, serializer: S) -> Result<S::Ok, S::Error> {
    estimate.map(|estimate| estimate.value).serialize(serializer)
}

/// The effect of a surrogate as control variate, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct ControlShape {
    /// The method that it comes from.
    pub(super) method: &'static str,
    /// The evaluations that it took, of all characteristics together.
    pub(super) evaluations: usize,
    /// By how much standard errors have shrunk.
    pub(super) reduction: Reduction,
}

/// The standard error without the surrogate by that with it; null where that is unknown or 0.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub(super) struct Reduction {
    /// Of the mean.
    pub(super) mean: Option<f64>,
    /// Of sigma.
    pub(super) sigma: Option<f64>,
}
