//! Source of the yield, in words.

use crate::document::number::{plain, short, significant, unrejected};
use crate::figures::Figures;
use sensitol::analysis::{CharacteristicAnalysis, DistributionFreeYield, FigureBasis, YieldSource};
use sensitol::summary::RunSummary;
use sensitol_numeric::capability::Capability;

/// Least relative difference of the reject rate of the Pearson fit that is worth mentioning.
const DIFFERENT: f64 = 0.01;

/// Seconds an evaluation from which on a model is slow.
const SLOW: f64 = 0.1;

/// Greatest error of the yield that counts as rounding.
pub(crate) const ROUNDING: f64 = 1e-12;

/// Sentence on the source of the yield and its error. A proof is exact in every printed digit, so its rounding is left out.
pub(crate) fn source(one: &CharacteristicAnalysis) -> Option<String> {
    let source = one.distribution.yield_source?;
    let error = one.error_estimate.as_ref().and_then(|estimate| estimate.yield_);
    let error = match (source, error) {
        // Rounding is negligible compared with the uncertainty of measured samples, and beside a proof.
        (YieldSource::Proof, Some(error)) if error < ROUNDING => String::new(),
        (_, Some(error)) if one.evidence.sampling.is_some() && error < ROUNDING => String::new(),
        (_, Some(error)) if error > 0.0 => format!(", ± {} %", significant(100.0 * error, 2)),
        (YieldSource::Proof, _) | (_, Some(_)) => String::new(),
        (_, None) => ", error unknown".to_owned(),
    };
    Some(format!("by {}{error}{}", source.words(), condition(one)))
}

/// Sentence on the Pearson fit, or None if its yield is the printed one or nearly so.
pub(crate) fn pearson_fit(one: &CharacteristicAnalysis) -> Option<String> {
    one.distribution.yield_source.filter(|source| *source != YieldSource::Pearson)?;
    let rejected = |below: Option<f64>, above: Option<f64>| 1e-6 * (below.unwrap_or(0.0) + above.unwrap_or(0.0));
    let own = rejected(one.ppm_below(), one.ppm_above());
    let fit = one.evidence.pearson.as_ref().map(|fit: &Capability| rejected(fit.ppm_below(), fit.ppm_above()))?;
    let differs = (fit - own).abs() > DIFFERENT * fit.max(own);
    let words = "its four moments do not determine the tails";
    differs.then(|| format!("a Pearson fit would say: yield {} ({words})", unrejected(fit)))
}

/// Price of a verdict by points of the model, in place of one by the surface. The time is stated for a slow model.
pub(crate) fn decision(one: &CharacteristicAnalysis, run: &RunSummary) -> Option<String> {
    let points = one.points_to_decide()?;
    let each = run.in_model.as_secs_f64() / run.evaluations.max(1) as f64;
    let time =
        if each < SLOW { String::new() } else { format!(", {} at the measured pace", time(each * points as f64)) };
    Some(format!("{points} plain points of the model would decide the target if this yield is right{time}"))
}

/// Time in a unit that readers use.
fn time(seconds: f64) -> String {
    match seconds {
        s if s < 120.0 => format!("{s:.0} s"),
        s if s < 7200.0 => format!("{:.0} min", s / 60.0),
        s if s < 172_800.0 => format!("{:.0} h", s / 3600.0),
        s => format!("{:.0} days", s / 86_400.0),
    }
}

/// Condition under which a yield by the surface holds. Empty for any other basis.
pub(crate) fn condition(one: &CharacteristicAnalysis) -> String {
    let checks = one.evidence.verification.as_ref().filter(|of| of.unseen.is_some());
    match (one.bases().yield_, checks) {
        (Some(FigureBasis::Surface), Some(checks)) if checks.lost_share.is_some_and(|lost| lost > 0.0) => {
            format!("; the model has no value at some of the {} check points", checks.points)
        }
        (Some(FigureBasis::Surface), Some(checks)) if checks.far_residual.is_some() => {
            format!("; the model leaves the surface at some of the {} check points", checks.points)
        }
        (Some(FigureBasis::Surface), Some(checks)) => {
            format!(", if the surface holds between the check points ({} of the model agree)", checks.points)
        }
        (Some(FigureBasis::Surface), None) => ", if the surface holds: no check point was evaluated".to_owned(),
        _ => String::new(),
    }
}

/// Steps of a printed bound of a yield: a ten-thousandth of a percent.
const BOUND_STEPS: f64 = 1e6;

/// Least yield over all distributions, such as `≥ 84.1344 %`. Returns None if it is unknown.
pub(crate) fn least_yield(of: &DistributionFreeYield) -> Option<String> {
    of.interval.map(|[least, _]| format!("≥ {} %", rounded_down(least)))
}

/// Bounds of a yield over all distributions of some dimensions. The ends are rounded outward, because each of them is a bound.
pub(crate) fn distribution_free(of: &DistributionFreeYield) -> String {
    let names = names(of);
    let Some([least, greatest]) = of.interval else {
        return format!(
            "unknown: the distribution of {names} is not given, and bounds need a linear formula or one such dimension"
        );
    };
    let most = match greatest < 1.0 {
        true => format!(", at most {} %", plain((BOUND_STEPS * greatest).ceil() / 1e4)),
        false => String::new(),
    };
    let checked = if of.proven { "" } else { " (at 65 of its values, not proven)" };
    format!("at least {} %{most}, whatever the distribution of {names}{checked}", rounded_down(least))
}

/// Sentence on the figures beside such a yield.
pub(crate) fn stand_in(of: &DistributionFreeYield) -> String {
    format!("all other figures take {} as uniform", names(of))
}

fn names(of: &DistributionFreeYield) -> String {
    of.dimensions.iter().map(|name| short(name)).collect::<Vec<String>>().join(", ")
}

fn rounded_down(least: f64) -> String {
    plain((BOUND_STEPS * least).floor() / 1e4)
}
