//! The law of a surface, as reports show it, and what the yield comes from.

use serde::Serialize;

use super::CharacteristicReport;
use super::distribution::{DistributionReport, NAMES, Quantiles};
use crate::analysis::{SurfaceShares, YieldSource};
use crate::document::number::{share, significant};
use crate::law::Branch;

/// The Pearson fit is named beside the yield where it has more than this part of what is rejected wrong.
const DIFFERENT: f64 = 0.01;

/// What the law of the fitted surface says.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SurfaceLawReport {
    /// `exact`, `single` or `sampled`: how it is computed.
    pub branch: &'static str,
    /// The share within the limits; null without any.
    #[serde(rename = "yield")]
    pub yield_: Option<f64>,
    /// Assemblies below the lower limit, per million.
    pub ppm_below: Option<f64>,
    /// Assemblies above the upper limit, per million.
    pub ppm_above: Option<f64>,
    /// The numerical error of the share within the limits: of the law of this surface, not of the surface.
    pub yield_error: Option<f64>,
    /// Quantiles; null where the law could only be counted at points.
    pub quantiles: Option<Quantiles>,
}

impl SurfaceLawReport {
    pub(super) fn of(law: &SurfaceShares) -> Self {
        let ppm = |figure: Option<crate::law::LawFigure>| figure.map(|figure| 1e6 * figure.value);
        Self {
            branch: match law.branch {
                Branch::Exact => "exact",
                Branch::Single => "single",
                Branch::Sampled => "sampled",
            },
            yield_: law.yield_(),
            ppm_below: ppm(law.below),
            ppm_above: ppm(law.above),
            yield_error: law.yield_().map(|_| law.error()),
            quantiles: law
                .quantiles
                .map(|all| Quantiles(NAMES.iter().zip(all).map(|(name, figure)| (*name, figure.value)).collect())),
        }
    }
}

/// What the yield comes from, how far it may be off, and the Pearson fit where that says something else.
pub(super) fn source(one: &CharacteristicReport) -> Option<String> {
    let source = one.yield_source?;
    let error = one.error_estimate.as_ref().and_then(|estimate| estimate.yield_);
    let error = match (source, error) {
        (_, Some(error)) if error > 0.0 => format!(", ± {} %", significant(100.0 * error, 2)),
        (YieldSource::Proof, _) | (_, Some(_)) => String::new(),
        (_, None) => ", error unknown".to_owned(),
    };
    let rejected = |below: Option<f64>, above: Option<f64>| 1e-6 * (below.unwrap_or(0.0) + above.unwrap_or(0.0));
    let own = rejected(one.ppm_below, one.ppm_above);
    let fit = one.pearson_fit.as_ref().map(|fit| rejected(fit.ppm_below, fit.ppm_above));
    let fit = fit.filter(|fit| source != YieldSource::Pearson && (fit - own).abs() > DIFFERENT * fit.max(own));
    let fit = fit.map_or(String::new(), |fit| format!("; Pearson fit {}", share(fit)));
    Some(format!("by {}{error}{fit}", source.words()))
}

impl CharacteristicReport {
    /// Its quantiles: by the law of its surface, where there is one, by the Pearson fit elsewhere.
    pub(super) fn quantiles(&self) -> Option<&Quantiles> {
        let own = self.surface_law.as_ref().and_then(|law| law.quantiles.as_ref());
        own.or(match &self.distribution {
            Some(DistributionReport::Pearson { quantiles, .. }) => Some(quantiles),
            _ => None,
        })
    }
}
