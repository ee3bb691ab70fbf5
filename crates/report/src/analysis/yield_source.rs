//! Source of the yield, in words.

use crate::document::number::{significant, unrejected};
use crate::figures::Figures;
use sensitol::analysis::{CharacteristicAnalysis, YieldSource};
use sensitol_numeric::capability::Capability;

/// Least relative difference of the reject rate of the Pearson fit that is worth mentioning.
const DIFFERENT: f64 = 0.01;

/// Greatest error of the yield that counts as rounding.
const ROUNDING: f64 = 1e-12;

/// Sentence with the source of the yield, its error, and the Pearson fit if that differs.
pub(crate) fn source(one: &CharacteristicAnalysis) -> Option<String> {
    let source = one.yield_source?;
    let error = one.error_estimate.as_ref().and_then(|estimate| estimate.yield_);
    let error = match (source, error) {
        // Rounding is negligible compared with the uncertainty of measured samples.
        (_, Some(error)) if one.sampling.is_some() && error < ROUNDING => String::new(),
        (_, Some(error)) if error > 0.0 => format!(", ± {} %", significant(100.0 * error, 2)),
        (YieldSource::Proof, _) | (_, Some(_)) => String::new(),
        (_, None) => ", error unknown".to_owned(),
    };
    let rejected = |below: Option<f64>, above: Option<f64>| 1e-6 * (below.unwrap_or(0.0) + above.unwrap_or(0.0));
    let own = rejected(one.ppm_below(), one.ppm_above());
    let fit = one.pearson.as_ref().map(|fit: &Capability| rejected(fit.ppm_below(), fit.ppm_above()));
    let fit = fit.filter(|fit| source != YieldSource::Pearson && (fit - own).abs() > DIFFERENT * fit.max(own));
    let fit = fit.map_or(String::new(), |fit| format!("; Pearson fit {}", unrejected(fit)));
    Some(format!("by {}{error}{fit}", source.words()))
}
