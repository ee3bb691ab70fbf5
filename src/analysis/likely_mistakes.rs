//! Results that a mistake in the study explains better than the assembly does.

use crate::analysis::CharacteristicAnalysis;
use crate::problem::Problem;
use crate::warning::Warning;

/// Share of the variance from which on one dimension is nearly all of it.
const NEARLY_ALL: f64 = 0.99;
/// Factor between its tolerance and the next one, in the same unit, from which on a misplaced point or unit is likely.
const FAR_WIDER: f64 = 100.0;

/// Warnings of likely mistakes in the lines of the study.
pub(super) fn likely_mistakes(problem: &Problem, characteristics: &[CharacteristicAnalysis]) -> Vec<Warning> {
    let missed: Vec<String> = (characteristics.iter())
        .filter(|analysis| misses_its_limits(analysis))
        .map(|analysis| analysis.characteristic.name().to_owned())
        .collect();
    let missed = (!missed.is_empty()).then_some(Warning::MeanOutsideLimits { characteristics: missed });
    let mut warnings: Vec<Warning> = missed.into_iter().collect();
    let mut named: Vec<usize> = Vec::new();
    for analysis in characteristics {
        if let Some((d, share, factor)) = dominant(problem, analysis).filter(|(d, ..)| !named.contains(d)) {
            named.push(d);
            warnings.push(Warning::DominantDimension {
                characteristic: analysis.characteristic.name().to_owned(),
                dimension: problem.dimensions()[d].name().to_owned(),
                share,
                factor,
            });
        }
    }
    warnings
}

/// True if the nominal value and the mean are both on the same wrong side of a limit. A sign that is reversed does that. A mean that
/// tolerances alone move out does not.
fn misses_its_limits(analysis: &CharacteristicAnalysis) -> bool {
    let (Some(nominal), Some(moments)) = (analysis.nominal, &analysis.moments) else { return false };
    let limits = analysis.characteristic.limits();
    let below = limits.lower().is_some_and(|lower| nominal < lower && moments.mean() < lower);
    let above = limits.upper().is_some_and(|upper| nominal > upper && moments.mean() > upper);
    below || above
}

/// Dimension with nearly all of the variance and by far the widest tolerance in its unit; with its share and the factor to the next
/// tolerance.
fn dominant(problem: &Problem, analysis: &CharacteristicAnalysis) -> Option<(usize, f64, f64)> {
    let share = |d: usize| {
        let sensitivity = &analysis.sensitivities[d];
        Some(sensitivity.linear_share? + sensitivity.curvature_share.unwrap_or(0.0))
    };
    let (d, share) = (0..analysis.sensitivities.len())
        .filter_map(|d| Some((d, share(d)?)))
        .find(|(_, share)| *share >= NEARLY_ALL)?;
    let dimensions = problem.dimensions();
    let wide = &dimensions[d];
    // Only dimensions on which this characteristic depends tell what is usual in it.
    let next = (dimensions.iter().zip(&analysis.sensitivities))
        .filter(|(other, sensitivity)| {
            other.name() != wide.name() && sensitivity.first.is_some_and(|first| first != 0.0)
        })
        .filter(|(other, _)| other.unit() == wide.unit())
        .map(|(other, _)| other.half_band())
        .fold(0.0, f64::max);
    let factor = wide.half_band() / next;
    (factor.is_finite() && factor >= FAR_WIDER).then_some((d, share, factor))
}
