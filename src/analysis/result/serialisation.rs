//! Serialisation of results, with the figures that follow from them.

use crate::analysis::result::conclusion::{CharacteristicConclusion, ExtremesAt, WorstCase};
use crate::analysis::result::points_to_decide::points_to_decide;
use crate::analysis::{Analysis, CharacteristicAnalysis, FigureBases, FigureBasis, VerificationKind, YieldSource};
use crate::extremes::Extremes;
use crate::warning::serialize::warnings_last;
use sensitol_numeric::serialize_with_conclusion;

warnings_last!(Analysis);
serialize_with_conclusion!(CharacteristicAnalysis);

impl CharacteristicAnalysis {
    /// Verdicts, intervals and bases that follow from the figures.
    pub fn conclusion(&self) -> CharacteristicConclusion<'_> {
        CharacteristicConclusion {
            worst_case: worst_case(self),
            verdicts: self.verdicts(),
            basis: self.bases(),
            points_to_decide: self.points_to_decide(),
            yield_interval: self.yield_interval(),
            coefficient_of_variation: self.coefficient_of_variation(),
        }
    }

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

/// Intervals that no assembly leaves.
fn worst_case(one: &CharacteristicAnalysis) -> WorstCase<'_> {
    let found = one.range.extremes.as_ref();
    let proof = one.proof();
    WorstCase {
        linear: one.range.worst_case,
        extremes: found.map(|found| [found.least.value, found.greatest.value]),
        proven: found.map(Extremes::proven),
        at: found.map(|found| ExtremesAt { lower: &found.least.at, upper: &found.greatest.at }),
        bounds: proof.map(|proof| proof.bounds),
        bounds_reached: proof.map(|proof| proof.proven),
        evaluations: found.map(|found| found.evaluations),
    }
}
