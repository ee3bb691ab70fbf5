//! Figures of a characteristic together with the value of a further stage.
//!
//! A stage reads the figures and returns a value. Only this file puts the two together, as a new value:
//!
//! ```text
//! linear model    no slopes of a choice from stock
//! model sample    moments of points of the model, in place of those of a surface
//! extremes        searched extremes, or bounds by interval arithmetic
//! verification    errors of all figures, and the model's moments if the surface's are refuted
//! tail sample     yield by points of the model in tails at whose limits check points refute the surface
//! failures        failed points of earlier runs
//! distribution    quantiles, then the yield, then the risks of an inspection
//! interactions    list of interactions, bounds of the yield over all distributions, conditional yields, open points
//! samples         uncertainty of measured samples
//! indices         Sobol' indices
//! ```

use crate::analysis::result::characteristic::CharacteristicAnalysis;
use crate::analysis::result::contribution_figures::ContributionFigures;
use crate::analysis::result::coverage_intervals::CoverageIntervals;
use crate::analysis::result::distribution_figures::DistributionFigures;
use crate::analysis::result::evidence::Evidence;
use crate::analysis::result::interaction::InteractionList;
use crate::analysis::result::quantile_estimates::QuantileEstimates;
use crate::analysis::result::range_figures::{LinearFigures, RangeFigures};
use crate::analysis::result::sampled_model::SampledModel;
use crate::analysis::result::sampled_tail::SampledTail;
use crate::analysis::result::sobol_indices::SobolIndices;
use crate::analysis::result::verification::Verification;
use crate::analysis::result::yield_source::YieldSource;
use crate::analysis::{MissingPoints, Sensitivity, SurfaceShares};
use crate::estimate::{ConditionalYield, DistributionFreeYield};
use crate::extremes::{Extremes, ExtremesProof};
use crate::method::ErrorEstimate;
use sensitol_numeric::capability::{Capability, EstimatedShare, InspectionRisks, Law};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::pearson::PearsonError;
use sensitol_numeric::sampling::SamplingInterval;

/// Moments in place of those of a surface, with the distributions that have them.
pub(in crate::analysis) struct MomentFigures {
    pub(in crate::analysis) moments: Moments,
    law: Result<Law, PearsonError>,
    /// Capability by the Pearson fit. None if there is no fit.
    pub(in crate::analysis) capability: Option<Capability>,
    normal: Option<Capability>,
}

impl MomentFigures {
    pub(in crate::analysis) fn of(moments: Moments, limits: SpecLimits) -> Self {
        let capability = |law: &Law| Capability::of(law, moments.mean(), moments.sigma(), limits);
        let law = Law::fit(&moments);
        Self {
            moments,
            capability: law.as_ref().ok().map(capability),
            normal: Law::normal(&moments).ok().map(|law| capability(&law)),
            law,
        }
    }
}

/// Figures of points of the model in place of those of a surface that misses its accuracy.
pub(in crate::analysis) struct ModelSampleFigures {
    pub(in crate::analysis) moments: MomentFigures,
    pub(in crate::analysis) error_estimate: ErrorEstimate,
    pub(in crate::analysis) sampled: SampledModel,
}

/// Errors of the figures by the model itself.
pub(in crate::analysis) struct VerificationFigures {
    /// Moments of the model, if those of the surface are refuted.
    pub(in crate::analysis) moments: Option<MomentFigures>,
    pub(in crate::analysis) error_estimate: ErrorEstimate,
    pub(in crate::analysis) verification: Verification,
    /// Check points without a value.
    pub(in crate::analysis) without_value: usize,
    /// Points in normal space that the model probably rejects, if check points refute the surface at a limit.
    pub(in crate::analysis) refuted: Option<Vec<Vec<f64>>>,
}

impl VerificationFigures {
    /// Figures of a verification that has a value at every point and refutes no limit.
    pub(in crate::analysis) fn complete(
        moments: Option<MomentFigures>,
        error_estimate: ErrorEstimate,
        verification: Verification,
    ) -> Self {
        Self { moments, error_estimate, verification, without_value: 0, refuted: None }
    }
}

/// Yield by points of the model in refuted tails.
pub(in crate::analysis) struct TailFigures {
    pub(in crate::analysis) sampled: SampledTail,
    /// Share of the assemblies without a value by these points.
    pub(in crate::analysis) lost: f64,
}

/// Quantiles and the distribution that they follow from.
pub(in crate::analysis) struct QuantileFigures {
    pub(in crate::analysis) coverage: Option<CoverageIntervals>,
    pub(in crate::analysis) quantiles: Option<QuantileEstimates>,
    pub(in crate::analysis) density: Option<Vec<[f64; 3]>>,
    pub(in crate::analysis) surface_law: Option<SurfaceShares>,
}

/// Yield with its source.
pub(in crate::analysis) struct YieldFigures {
    pub(in crate::analysis) source: Option<YieldSource>,
    pub(in crate::analysis) capability: Option<Capability>,
    pub(in crate::analysis) reject_intervals: [Option<[f64; 2]>; 2],
    /// Error of the yield. None if it is unknown.
    pub(in crate::analysis) error: Option<f64>,
}

/// Uncertainty of measured samples, and the reject intervals with it.
pub(in crate::analysis) struct SamplingFigures {
    pub(in crate::analysis) sampling: SamplingInterval,
    pub(in crate::analysis) reject_intervals: [Option<[f64; 2]>; 2],
}

/// Sobol' indices of a characteristic and of single dimensions.
pub(in crate::analysis) struct IndexFigures {
    pub(in crate::analysis) indices: SobolIndices,
    /// First-order and total index by the place of the dimension.
    pub(in crate::analysis) single: Vec<(usize, Option<EstimatedShare>, Option<EstimatedShare>)>,
    /// True if the contributions of the surface differ from those of the model, and become unknown.
    pub(in crate::analysis) distrusted: bool,
}

/// Characteristics together with the values of a stage, which has one for some of them, by their places.
pub(in crate::analysis) fn with_stage<T>(
    characteristics: Vec<CharacteristicAnalysis>,
    found: impl IntoIterator<Item = (usize, T)>,
    with: fn(CharacteristicAnalysis, T) -> CharacteristicAnalysis,
) -> Vec<CharacteristicAnalysis> {
    let mut values: Vec<Option<T>> = characteristics.iter().map(|_| None).collect();
    found.into_iter().for_each(|(c, value)| values[c] = Some(value));
    let pairs = characteristics.into_iter().zip(values);
    pairs.map(|(one, value)| if let Some(value) = value { with(one, value) } else { one }).collect()
}

impl CharacteristicAnalysis {
    /// Leaves out slopes and the figures of a linear model if values are chosen from stock: difference quotients over jumps have any size
    /// and sign. A dimension that it does not depend on keeps its slope of 0.
    pub(in crate::analysis) fn without_linear(self, depends: &[bool]) -> Self {
        let sensitivities = self.sensitivities.into_iter().zip(depends).map(|(one, depends)| match depends {
            true => Sensitivity { first: None, second: None, rounding: None, exact: false, ..one },
            false => one,
        });
        Self {
            sensitivities: sensitivities.collect(),
            range: RangeFigures { worst_case: None, ..self.range },
            linear: LinearFigures {
                middle: self.linear.middle,
                rss: None,
                inflated_rss: None,
                mean_shift_rss: None,
                six_sigma: None,
            },
            ..self
        }
    }

    /// Leaves out the figures of a surface where none follows the model.
    pub(in crate::analysis) fn without_surface(self) -> Self {
        let without_shares = |one| Sensitivity {
            linear_share: None,
            curvature_share: None,
            mean_shift: None,
            first_order: None,
            total: None,
            ..one
        };
        Self {
            moments: None,
            error_estimate: None,
            sensitivities: self.sensitivities.into_iter().map(without_shares).collect(),
            distribution: DistributionFigures { capability: None, ..self.distribution },
            range: RangeFigures { curved: None, ..self.range },
            evidence: Evidence { sampled: None, residual: None, law: None, normal: None, ..self.evidence },
            ..self
        }
    }

    /// Replaces the moments, and the distributions that follow from them.
    fn with_moments(self, MomentFigures { moments, law, capability, normal }: MomentFigures) -> Self {
        Self {
            moments: Some(moments),
            distribution: DistributionFigures { capability, ..self.distribution },
            evidence: Evidence { law: Some(law), normal, sampled: None, ..self.evidence },
            ..self
        }
    }

    /// Replaces the surface's figures by the model's.
    pub(in crate::analysis) fn with_model_sample(self, found: ModelSampleFigures) -> Self {
        let ModelSampleFigures { moments, error_estimate, sampled } = found;
        let one = self.with_moments(moments);
        let without_value = one.missing.without_value + sampled.failed as usize;
        Self {
            error_estimate: Some(error_estimate),
            missing: MissingPoints { without_value, ..one.missing },
            evidence: Evidence { model_sampled: Some(sampled), ..one.evidence },
            ..one
        }
    }

    /// Adds searched extremes.
    pub(in crate::analysis) fn with_extremes(self, extremes: Option<Extremes>) -> Self {
        Self { range: RangeFigures { extremes, ..self.range }, ..self }
    }

    /// Adds bounds by interval arithmetic.
    pub(in crate::analysis) fn with_bounds(self, bounds: Option<ExtremesProof>) -> Self {
        Self { range: RangeFigures { bounds, ..self.range }, ..self }
    }

    /// Adds a verification, whose errors replace those of the method.
    pub(in crate::analysis) fn with_verification(self, found: VerificationFigures) -> Self {
        let VerificationFigures { moments, error_estimate, verification, without_value, .. } = found;
        let one = match moments {
            Some(moments) => self.with_moments(moments),
            None => self,
        };
        let without_value = one.missing.without_value + without_value;
        Self {
            error_estimate: Some(error_estimate),
            missing: MissingPoints { without_value, ..one.missing },
            evidence: Evidence { verification: Some(verification), ..one.evidence },
            ..one
        }
    }

    /// Adds points of the model in refuted tails.
    pub(in crate::analysis) fn with_tail_sample(self, TailFigures { sampled, lost }: TailFigures) -> Self {
        let one = self.with_failures(sampled.failed as usize);
        // Failed points in the tail weigh the assemblies without a value.
        let failed = sampled.failed > 0;
        let verification = one.evidence.verification.map(|of| match failed {
            true => Verification { lost_share: of.lost_share.map(|known| known.max(lost)), ..of },
            false => of,
        });
        Self { evidence: Evidence { verification, tail_sampled: Some(sampled), ..one.evidence }, ..one }
    }

    /// Adds points without a value.
    pub(in crate::analysis) fn with_failures(self, failed: usize) -> Self {
        let without_value = self.missing.without_value + failed;
        Self { missing: MissingPoints { without_value, ..self.missing }, ..self }
    }

    /// Adds quantiles. The capability so far is that of the Pearson fit, and stays as evidence.
    pub(in crate::analysis) fn with_quantiles(self, found: QuantileFigures) -> Self {
        let QuantileFigures { coverage, quantiles, density, surface_law } = found;
        let pearson = self.distribution.capability;
        Self {
            distribution: DistributionFigures { coverage, quantiles, ..self.distribution },
            evidence: Evidence { pearson, density, surface_law, ..self.evidence },
            ..self
        }
    }

    /// Replaces the capability of the Pearson fit by that of the source of the yield.
    pub(in crate::analysis) fn with_yield(self, found: YieldFigures) -> Self {
        let YieldFigures { source: yield_source, capability, reject_intervals, error } = found;
        Self {
            error_estimate: self.error_estimate.map(|estimate| ErrorEstimate { yield_: error, ..estimate }),
            distribution: DistributionFigures { yield_source, capability, reject_intervals, ..self.distribution },
            ..self
        }
    }

    /// Adds the risks of an inspection.
    pub(in crate::analysis) fn with_inspection(self, inspection: Option<InspectionRisks>) -> Self {
        Self { distribution: DistributionFigures { inspection, ..self.distribution }, ..self }
    }

    /// Adds the list of interactions.
    pub(in crate::analysis) fn with_interactions(self, interactions: InteractionList) -> Self {
        Self { contributions: ContributionFigures { interactions, ..self.contributions }, ..self }
    }

    /// Replaces the yield by bounds over all distributions of some dimensions. That of the distributions that stand in for them says nothing.
    pub(in crate::analysis) fn with_distribution_free_yield(self, free: DistributionFreeYield) -> Self {
        let capability = self.distribution.capability.map(|of| Capability { below: None, above: None, ..of });
        Self {
            error_estimate: self.error_estimate.map(|estimate| ErrorEstimate { yield_: None, ..estimate }),
            distribution: DistributionFigures {
                yield_source: None,
                capability,
                reject_intervals: [None; 2],
                inspection: None,
                distribution_free_yield: Some(free),
                ..self.distribution
            },
            ..self
        }
    }

    /// Adds a conditional yield.
    pub(in crate::analysis) fn with_conditional_yield(self, conditional: Option<ConditionalYield>) -> Self {
        Self { distribution: DistributionFigures { conditional, ..self.distribution }, ..self }
    }

    /// Marks figures of a run that was stopped before all planned points were evaluated.
    pub(in crate::analysis) fn with_open_points(self, unfinished: bool) -> Self {
        Self { missing: MissingPoints { unfinished, ..self.missing }, ..self }
    }

    /// Adds the uncertainty of measured samples.
    pub(in crate::analysis) fn with_sampling(self, found: SamplingFigures) -> Self {
        let SamplingFigures { sampling, reject_intervals } = found;
        Self {
            distribution: DistributionFigures { reject_intervals, ..self.distribution },
            evidence: Evidence { sampling: Some(sampling), ..self.evidence },
            ..self
        }
    }

    /// Adds Sobol' indices.
    pub(in crate::analysis) fn with_indices(self, found: IndexFigures) -> Self {
        let IndexFigures { indices, single, distrusted } = found;
        let one = if distrusted { self.without_contributions() } else { self };
        let mut sensitivities = one.sensitivities;
        for (d, first_order, total) in single {
            (sensitivities[d].first_order, sensitivities[d].total) = (first_order, total);
        }
        let contributions = ContributionFigures { indices: Some(indices), ..one.contributions };
        Self { sensitivities, contributions, ..one }
    }

    /// Sets contributions that differ from those of the model to unknown.
    fn without_contributions(self) -> Self {
        let sensitivities = self.sensitivities.into_iter();
        let sensitivities =
            sensitivities.map(|row| Sensitivity { linear_share: None, curvature_share: None, ..row }).collect();
        let interactions = self.contributions.interactions.without_shares();
        let contributions = ContributionFigures { interactions, left_out_share: None, ..self.contributions };
        Self { sensitivities, contributions, ..self }
    }
}
