//! Results of the verification of a characteristic.

use std::sync::Arc;

use serde::Serialize;

use crate::verification::{FarResidual, FoundSwitch, SampleQuantile, SampleTails, Share, Verified, WeightedSample};
use sensitol_numeric::json_form::{Four, Sides, through};
use sensitol_numeric::power::{Losable, Rescale, Rescaling};

/// Kind of the verification of figures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum VerificationKind {
    /// Points of a cheap model.
    Sample,
    /// Check points of a costly model.
    Checks,
    /// Proof by the formula itself, a polynomial that the surface represents exactly.
    Exact,
}

/// Greatest unexplained share of the variance of a trusted surface. Above it the surface is no basis for tails or for an optimum.
pub(crate) const TRUSTED: f64 = 0.01;
/// Unexplained share of the variance above which a surface does not follow the model, and has no contributions to show.
pub(in crate::analysis) const UNTRUSTED: f64 = 0.05;

/// Results of the model itself for a characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Verification {
    /// Kind of the verification.
    pub kind: VerificationKind,
    /// Degree of the polynomial that the formula is. None for other kinds.
    pub degree: Option<u32>,
    /// Evaluated points of the model.
    pub points: usize,
    /// Check points without a value. A sample has `valid` instead.
    #[serde(skip)]
    pub(crate) failed: usize,
    /// Largest residual of the surface far from the means. None if no check point met one that changes a figure.
    pub far_residual: Option<FarResidual>,
    /// Greatest share of the assemblies without a value, by the places of the check points without one. 0 if all have a value, None without
    /// check points.
    pub lost_share: Option<f64>,
    /// Share of the assemblies that have a value. None if there is no sample.
    #[serde(rename = "valid_share")]
    pub valid: Option<Verified>,
    /// Share of the variance that the surface leaves unexplained.
    pub left: Option<f64>,
    /// Figures of the model itself.
    pub figures: VerifiedFigures,
    /// Weight of one point of a sample.
    #[serde(skip)]
    pub(crate) point: f64,
    /// Difference of the shares of model and surface within the limits, below and above them. None if there is no sample of both.
    pub difference: Option<[Verified; 3]>,
    /// Switches that were met. None if the model does not report where it changes its form.
    pub switches: Option<Vec<FoundSwitch>>,
    /// Greatest share of the assemblies that may behave differently although all points agree, at 95 %. None for a sample, which has many
    /// points.
    pub unseen: Option<f64>,
    /// Shares of the variance from the model, if the surface is not trusted.
    pub shares: Option<Vec<VarianceShare>>,
    /// Tails of the sample towards the limits. None if there are no limits.
    pub tails: Option<SampleTails>,
    /// True if figures of the characteristic are the model's, in place of the surface's.
    pub replaced: bool,
    /// Quantiles of the sample at the reported probabilities. None at one that it does not resolve, and without a sample.
    #[serde(skip)]
    pub(crate) quantiles: [Option<SampleQuantile>; 7],
    /// Sample, kept if an inspection, a coverage interval or a density needs its points.
    #[serde(skip)]
    pub(crate) sample: Option<Arc<WeightedSample>>,
}

/// Figures of a verification.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct VerifiedFigures {
    /// Mean, sigma, skewness and kurtosis by the model. None if there is no sample of it.
    #[serde(flatten, serialize_with = "through::<Four<Option<Verified>>, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Four<Option<Verified>>"))]
    pub moments: [Option<Verified>; 4],
    /// Share within the limits: by the sample, or by the surface with the error from check points.
    #[serde(rename = "yield")]
    pub yield_: Option<Verified>,
    /// Shares beyond the lower and the upper limit.
    #[serde(flatten, serialize_with = "through::<Sides<Option<Verified>>, _, _>")]
    #[cfg_attr(feature = "schema", schemars(with = "Sides<Option<Verified>>"))]
    pub beyond: [Option<Verified>; 2],
}

/// Part of the variance that a dimension explains, by the model itself.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct VarianceShare {
    /// Name of the dimension.
    pub dimension: String,
    /// Share of the dimension alone.
    pub first: Share,
    /// Share with all interactions of the dimension.
    pub total: Share,
}

impl Rescale for Verification {
    fn rescale(&mut self, by: &mut Rescaling) {
        let [mean, sigma, ..] = &mut self.figures.moments;
        mean.rescale(by);
        sigma.rescale(by);
        self.tails.rescale(by);
        self.quantiles.rescale(by);
        if let Some(sample) = &mut self.sample {
            Arc::make_mut(sample).rescale(by);
        }
    }
}

impl Losable for Verification {}

impl Verification {
    /// True if the surface leaves so little of the variance unexplained that its distribution is that of the model.
    pub fn follows_surface(&self) -> bool {
        self.left.is_some_and(|left| left <= TRUSTED)
    }

    /// Describes the verification in one line.
    pub fn words(&self) -> String {
        match self.kind {
            VerificationKind::Sample => format!("verified at {} points of the model", self.points),
            VerificationKind::Checks => {
                let unseen = 100.0 * self.unseen.unwrap_or(1.0);
                format!("verified at {} check points; up to {unseen:.0} % of the assemblies unseen", self.points)
            }
            VerificationKind::Exact => {
                format!("exact: the formula is a polynomial of degree {}", self.degree.unwrap_or(0))
            }
        }
    }
}
