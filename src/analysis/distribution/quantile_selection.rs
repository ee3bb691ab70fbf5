//! Choice of the source of quantiles: the source of the yield, without the proofs that concern limits only.
//!
//! | source | condition | error |
//! |---|---|---|
//! | proof | nothing varies; or the formula's degree proves that the surface is the function, no input is measured, and its distribution is computed | that of the distribution, with rounding |
//! | samples | points of the model itself, with the surface distribution as control variate if that lowers the error | the sample's |
//! | surface law | a surface, verified at check points or not at all | distribution, and change by the errors of the moments |
//! | Pearson fit | only moments are known | change by the errors of the moments |
//!
//! The errors of the moments move a quantile by the first-order terms of the Cornish-Fisher expansion (`moment_shift`).

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::distribution::moment_shift::moment_shift;
use crate::analysis::distribution::surface_law::{GuardedLaw, of_pearson};
use crate::analysis::result::verification::{Verification, VerificationKind};
use crate::analysis::result::yield_source::YieldSource;
use crate::estimate::{SampleQuantile, Verified};
use sensitol_numeric::capability::{EstimatedQuantile, Law, Quantiles};
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::law::{Branch, LawFigure, LawTail, REPORTED_QUANTILES};
use sensitol_numeric::pearson::Pearson;

/// Source of the quantiles of one characteristic.
pub(in crate::analysis) enum QuantileSource<'a> {
    /// The single value of a characteristic that does not vary.
    Constant(f64),
    /// Quantiles of a sample that replaced the surface, and the Pearson distribution with its moments.
    SampledModel(&'a [Option<EstimatedQuantile>; 7], Option<&'a Pearson>),
    /// Sample of the verification, with the distribution of the surface if that was computed. Counts of the surface are no control variate:
    /// the sample is as accurate.
    Sample(&'a Verification, Option<&'a GuardedLaw>),
    /// Distribution of the surface. It is a proof if the surface is proven to be the function.
    Surface(&'a GuardedLaw, bool),
    /// Pearson distribution of the moments.
    Pearson(&'a Pearson),
}

/// Quantiles of one characteristic at any probability.
pub(in crate::analysis) struct QuantileSelection<'a> {
    one: &'a CharacteristicAnalysis,
    source: QuantileSource<'a>,
}

impl<'a> QuantileSelection<'a> {
    /// Chooses the source. Returns None if nothing is known of the distribution. `measured` is true if an input is known by a sample.
    pub(in crate::analysis) fn of(
        one: &'a CharacteristicAnalysis,
        law: Option<&'a GuardedLaw>,
        measured: bool,
    ) -> Option<Self> {
        let fit = one.evidence.law.as_ref().and_then(|law| law.as_ref().ok());
        let pearson = match fit {
            Some(Law::Pearson(fit)) => Some(fit.as_ref()),
            _ => None,
        };
        let verification = one.evidence.verification.as_ref();
        let sampled = verification.filter(|of| of.kind == VerificationKind::Sample);
        let proven = verification.is_some_and(|of| of.kind == VerificationKind::Exact);
        let computed = law.is_some_and(|law| law.shares.branch != Branch::Sampled);
        let source = match (fit, &one.evidence.model_sampled, sampled, law, pearson) {
            (Some(Law::Point { at }), ..) => QuantileSource::Constant(*at),
            (_, Some(sampled), ..) => QuantileSource::SampledModel(&sampled.quantiles, pearson),
            (_, _, Some(of), ..) if of.quantiles.iter().any(Option::is_some) => {
                QuantileSource::Sample(of, law.filter(|law| law.shares.counted.is_none()))
            }
            (_, _, _, Some(law), _) if one.moments.is_some() => {
                QuantileSource::Surface(law, proven && computed && !measured)
            }
            (.., Some(fit)) => QuantileSource::Pearson(fit),
            _ => return None,
        };
        Some(Self { one, source })
    }

    /// Source of the quantiles, as one of a yield.
    pub(in crate::analysis) fn source(&self) -> YieldSource {
        match self.source {
            QuantileSource::Constant(_) | QuantileSource::Surface(_, true) => YieldSource::Proof,
            QuantileSource::SampledModel(..) | QuantileSource::Sample(..) => YieldSource::Samples,
            QuantileSource::Surface(_, false) => YieldSource::SurfaceLaw,
            QuantileSource::Pearson(_) => YieldSource::Pearson,
        }
    }

    /// Quantiles of reports. None at a probability that the source does not resolve.
    pub(in crate::analysis) fn reported(&self) -> Quantiles<Option<EstimatedQuantile>> {
        let found = match &self.source {
            QuantileSource::SampledModel(quantiles, _) => quantiles.to_vec(),
            QuantileSource::Sample(of, law) => {
                with_law(of.quantiles, law.and_then(|law| law.shares.quantiles).as_ref().map(<[_; 7]>::as_slice))
            }
            QuantileSource::Surface(law, _) => match law.shares.quantiles {
                Some(all) => all.into_iter().map(|figure| self.of_law(figure)).collect(),
                None => vec![None; REPORTED_QUANTILES.len()],
            },
            _ => self.at(&REPORTED_QUANTILES),
        };
        Quantiles(found.try_into().unwrap_or([None; 7]))
    }

    /// Quantiles at any probabilities, at most one half each. None at one that the source does not resolve.
    pub(in crate::analysis) fn at(&self, tails: &[(LawTail, f64)]) -> Vec<Option<EstimatedQuantile>> {
        let fit = self.one.evidence.law.as_ref().and_then(|law| law.as_ref().ok());
        match &self.source {
            QuantileSource::Constant(value) => {
                vec![Some(EstimatedQuantile { value: *value, error: Some(0.0) }); tails.len()]
            }
            QuantileSource::SampledModel(quantiles, fit) => {
                tails.iter().map(|&tail| between_reported(quantiles, (*fit)?, tail)).collect()
            }
            QuantileSource::Sample(of, law) => {
                let Some(sample) = of.sample.as_deref() else { return vec![None; tails.len()] };
                with_law(sample.quantiles(tails), law.and_then(|law| law.quantiles(fit, tails)).as_deref())
            }
            QuantileSource::Surface(law, _) => match law.quantiles(fit, tails) {
                Some(found) => found.into_iter().map(|figure| self.of_law(figure)).collect(),
                None => vec![None; tails.len()],
            },
            QuantileSource::Pearson(fit) => {
                let quantile = |&tail: &(LawTail, f64)| {
                    let value = of_pearson(fit, tail);
                    Some(EstimatedQuantile { value, error: self.moved(value) }).filter(|of| of.value.is_finite())
                };
                tails.iter().map(quantile).collect()
            }
        }
    }

    /// Quantile of the surface distribution, with its error and that of the moments.
    fn of_law(&self, figure: LawFigure) -> Option<EstimatedQuantile> {
        let error = self.moved(figure.value).map(|moved| libm::hypot(figure.error, moved));
        Some(EstimatedQuantile { value: figure.value, error }).filter(|_| figure.value.is_finite())
    }

    /// Distance by which the errors of the moments move a quantile. Returns None if one of them is unknown.
    fn moved(&self, at: f64) -> Option<f64> {
        let (estimate, moments) = (self.one.error_estimate.as_ref()?, self.one.moments?);
        let errors = [estimate.mean?, estimate.sigma?, estimate.skewness?, estimate.kurtosis?];
        // An error of sigma as large as sigma leaves nothing known.
        (errors[1] < moments.sigma()).then(|| moment_shift(at, [moments.mean(), moments.sigma()], errors))
    }
}

/// Quantiles of a sample, with those of the surface distribution at the same probabilities as control variates.
fn with_law(
    found: impl IntoIterator<Item = Option<SampleQuantile>>,
    law: Option<&[LawFigure]>,
) -> Vec<Option<EstimatedQuantile>> {
    let mut all = Vec::new();
    for (index, quantile) in found.into_iter().enumerate() {
        all.push(quantile.map(|quantile| {
            let Verified { value, error } = quantile.with_law(law.map(|law| law[index]));
            EstimatedQuantile { value, error: Some(error) }
        }));
    }
    all
}

/// Quantile of a sample between two reported ones: that of the Pearson fit, corrected by the differences of sample and fit at its
/// neighbours. The corrections are interpolated by normal scores. Returns None outside of the reported quantiles that are known.
fn between_reported(
    reported: &[Option<EstimatedQuantile>; 7],
    fit: &Pearson,
    tail: (LawTail, f64),
) -> Option<EstimatedQuantile> {
    let score = |(tail, p): (LawTail, f64)| match tail {
        LawTail::Lower => -standard_normal::upper_quantile(p),
        LawTail::Upper => standard_normal::upper_quantile(p),
    };
    let known: Vec<(f64, EstimatedQuantile, f64)> = (REPORTED_QUANTILES.into_iter().zip(reported))
        .filter_map(|(at, found)| Some((score(at), (*found)?, of_pearson(fit, at))))
        .collect();
    let z = score(tail);
    let pair = known.windows(2).find(|pair| pair[0].0 <= z && z <= pair[1].0)?;
    let [(from, low, fit_low), (to, high, fit_high)] = [pair[0], pair[1]];
    let part = (z - from) / (to - from);
    let corrections = [low.value - fit_low, high.value - fit_high];
    let value = of_pearson(fit, tail) + corrections[0] + part * (corrections[1] - corrections[0]);
    // Allowance for a bend of the correction between the two: half of its change.
    let bent = 0.5 * (corrections[1] - corrections[0]);
    let error = low.error.zip(high.error).map(|(low, high)| libm::hypot(low.max(high), bent));
    Some(EstimatedQuantile { value, error })
}
