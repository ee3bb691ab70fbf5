//! Bases of the certainty of figures.

use serde::Serialize;

use crate::analysis::result::characteristic::CharacteristicAnalysis;
use crate::analysis::result::points_to_decide::points_to_decide;
use crate::analysis::result::verification::VerificationKind;
use crate::analysis::result::yield_source::YieldSource;

/// Basis of the certainty of a figure, best first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum FigureBasis {
    /// Proof: rounding is the only error.
    Proof,
    /// Points of the model that sample the whole distribution, or measured values in a proven surface.
    Points,
    /// The surface: its figures hold if the model follows it between the check points.
    Surface,
}

impl FigureBasis {
    /// Name of the basis in JSON and tables.
    pub fn name(self) -> &'static str {
        match self {
            Self::Proof => "proof",
            Self::Points => "points",
            Self::Surface => "surface",
        }
    }
}

/// The bases of the figures of a characteristic. None for a figure that is unknown.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct FigureBases {
    /// Basis of mean, sigma, skewness and kurtosis.
    pub moments: Option<FigureBasis>,
    /// Basis of the yield and of the reject rates.
    #[serde(rename = "yield")]
    pub yield_: Option<FigureBasis>,
    /// Basis of the quantiles.
    pub quantiles: Option<FigureBasis>,
}

impl CharacteristicAnalysis {
    /// Bases of the figures of this characteristic.
    pub fn bases(&self) -> FigureBases {
        let moments = self.basis_of_moments();
        let quantiles = self.distribution.quantiles.map(|of| match self.basis_of_source(of.source) {
            // A surface with a single value proves nothing about the model.
            FigureBasis::Proof if moments == Some(FigureBasis::Surface) => FigureBasis::Surface,
            basis => basis,
        });
        FigureBases { moments, yield_: self.distribution.yield_source.map(|of| self.basis_of_source(of)), quantiles }
    }

    /// Number of plain points of the model that would decide the target yield if the yield of the surface is right. Returns None for a
    /// refuted surface, for any other basis, without a target, and if no practicable number decides it.
    pub fn points_to_decide(&self) -> Option<u64> {
        let (target, rejected) = (self.characteristic.target_yield()?, self.distribution.capability?.rejected()?);
        let by_surface = self.bases().yield_ == Some(FigureBasis::Surface);
        let refuted = self.evidence.verification.as_ref().is_some_and(|of| of.far_residual.is_some());
        if by_surface && !refuted { points_to_decide(rejected, 1.0 - target) } else { None }
    }

    pub(super) fn basis_of_moments(&self) -> Option<FigureBasis> {
        self.moments?;
        Some(match self.evidence.verification.as_ref().map(|of| of.kind) {
            _ if self.constant => FigureBasis::Proof,
            _ if self.evidence.model_sampled.is_some() => FigureBasis::Points,
            Some(VerificationKind::Exact) if self.evidence.sampling.is_none() => FigureBasis::Proof,
            Some(VerificationKind::Exact | VerificationKind::Sample) => FigureBasis::Points,
            Some(VerificationKind::Checks) | None => FigureBasis::Surface,
        })
    }

    fn basis_of_source(&self, source: YieldSource) -> FigureBasis {
        let proven = self.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Exact);
        match source {
            YieldSource::Proof => FigureBasis::Proof,
            YieldSource::Samples => FigureBasis::Points,
            // Measured values in a surface that is proven to be the model.
            YieldSource::SurfaceLaw if proven => FigureBasis::Points,
            YieldSource::SurfaceLaw | YieldSource::Pearson => FigureBasis::Surface,
        }
    }
}
