//! Warnings of surrogates that violate the assumptions of the moments.

use crate::analysis::result::verification::UNTRUSTED;
use crate::analysis::sampling::accuracy_target::beside_sigma;
use crate::analysis::sampling::axis_effect::{Shape, higher, shape};
use crate::analysis::{CharacteristicAnalysis, YieldSource};
use crate::method::{AutoAccount, ClimbEnd, Outcome};
use crate::plan::Point;
use crate::problem::Problem;
use crate::warning::{Figure, Warning};
use sensitol_numeric::verdict::ERRORS;

/// Second difference, as a part of sigma, below which a bend does not matter: its effect is far below any useful accuracy.
const BEND: f64 = 1e-3;
/// Share of the variance by powers beyond the second above which there is a warning, if the surrogate contains them.
const HELD: f64 = 0.01;
/// Scatter of the model's answers, as a part of sigma, above which there is a warning.
const SCATTER: f64 = 1e-4;
/// Unexplained share of the variance above which there is a warning.
const LEFT_OUT: f64 = 1e-3;

/// Difference of the reject rate of the Pearson fit, as a part of the rejects, above which there is a warning. It must also exceed the
/// interval of the yield and [`COUNTED`].
const APART: f64 = 0.01;
/// Smallest difference of reject rates that matters: a hundredth of a part per million.
const COUNTED: f64 = 1e-8;

/// Warnings of one characteristic about its surrogate and its Pearson fit.
pub(in crate::analysis) fn of(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    analysis: &CharacteristicAnalysis,
) -> Vec<Warning> {
    let Some(sigma) = analysis.moments.map(|moments| moments.sigma()).filter(|&sigma| sigma > 0.0) else {
        return Vec::new();
    };
    let mut warnings = axes(problem, outcome, c, sigma);
    // The switches of a formula, with their places, replace guesses from the axes.
    if analysis.evidence.verification.as_ref().is_some_and(|verification| verification.switches.is_some()) {
        let seen = |warning: &Warning| matches!(warning, Warning::Kink { .. } | Warning::Discontinuity { .. });
        warnings.retain(|warning| !seen(warning));
    }
    warnings.extend(pearson(analysis));
    if let Some(climbed) = &outcome.climbed {
        let mut found = climb(outcome, climbed, c, (analysis, sigma));
        // If answers of a formula scatter next to the means, there is a kink or a root that is not smooth.
        let formula = problem.function().switches(problem.outputs()[c]).is_some_and(|switches| switches.complete);
        if analysis.evidence.verification.is_some() {
            found.retain(|warning| match warning {
                Warning::Scatter { .. } => !formula,
                // The sample shows the unexplained share and its effect.
                Warning::UntrustedSurrogate { .. } | Warning::InteractionsLeftOut { .. } => false,
                _ => true,
            });
        }
        warnings.extend(found);
    }
    warnings
}

/// Warning of a Pearson fit that gives a wrong yield.
fn pearson(analysis: &CharacteristicAnalysis) -> Option<Warning> {
    let source = analysis.distribution.yield_source.filter(|source| *source != YieldSource::Pearson)?;
    let fit = analysis.evidence.pearson?.rejected()?;
    let rejected = analysis.distribution.capability?.rejected()?;
    // A proof without an estimate has no error.
    let error = match analysis.error_estimate.as_ref().and_then(|estimate| estimate.yield_) {
        None if source == YieldSource::Proof => 0.0,
        error => error?,
    };
    let apart = (fit - rejected).abs();
    let differs = apart > ERRORS * error && apart > APART * fit.max(rejected) && apart > COUNTED;
    let characteristic = analysis.characteristic.name().to_owned();
    differs.then_some(Warning::PearsonDiffers { characteristic, pearson: fit, rejected, error })
}

/// Warnings of kinks, jumps and higher powers along the axes that have five points.
fn axes(problem: &Problem, outcome: &Outcome, c: usize, sigma: f64) -> Vec<Warning> {
    // A formula that is a polynomial has no kink, and no power beyond those of its surface.
    if outcome.fitted[c].proof.is_some() {
        return Vec::new();
    }
    let plan = &outcome.plan;
    let characteristic = || problem.characteristics()[c].name().to_owned();
    let least = BEND * sigma + 64.0 * f64::EPSILON * outcome.fitted[c].centre.unwrap_or(0.0).abs();
    let mut warnings = Vec::new();
    for (position, &d) in plan.varying().iter().enumerate() {
        let Some(samples) = plan.samples(&outcome.evaluated.known, c, d).filter(|_| plan.depends(c, d)) else {
            continue;
        };
        let dimension = || problem.dimensions()[d].name().to_owned();
        match shape(&samples, least) {
            Some(Shape::Kink { slopes, between }) => {
                let slopes = slopes.map(|slope| slope / sigma);
                warnings.push(Warning::Kink {
                    characteristic: characteristic(),
                    dimension: dimension(),
                    slopes,
                    between,
                    others: Vec::new(),
                });
                continue;
            }
            Some(Shape::Jump { by, between }) => {
                let by = by / sigma;
                let at = Some(between.map(|u| plan.axis(d).mean + u * plan.axis(d).scale));
                warnings.push(Warning::Discontinuity {
                    characteristic: characteristic(),
                    dimension: dimension(),
                    by,
                    between,
                    at,
                    others: Vec::new(),
                });
                continue;
            }
            None => {}
        }
        let Some([third, fourth]) = outcome.fitted[c].parts[d].as_ref().and_then(higher) else { continue };
        let coefficients = [third / sigma, fourth / sigma];
        let rule = &plan.inputs().shapes()[position].rule;
        // Only the part that no parabola can represent: the powers without their best parabola.
        let share = rule.mean(|u| {
            (coefficients[0] * (u.powi(3) - 3.0 * u) + coefficients[1] * (u.powi(4) - 6.0 * u * u + 3.0)).powi(2)
        });
        if share > HELD {
            let (characteristic, dimension, others) = (characteristic(), dimension(), Vec::new());
            warnings.push(Warning::HigherOrder { characteristic, dimension, coefficients, held: true, others });
        }
    }
    warnings
}

/// Warnings from the findings of `auto` about its surrogate.
fn climb(
    outcome: &Outcome,
    climbed: &AutoAccount,
    c: usize,
    (analysis, sigma): (&CharacteristicAnalysis, f64),
) -> Vec<Warning> {
    let characteristic = || analysis.characteristic.name().to_owned();
    let mut warnings = Vec::new();
    if let Some(scatter) = climbed.noise[c].map(|scatter| scatter / sigma).filter(|&scatter| scatter > SCATTER) {
        // Scatter of a second difference is the root of six times that of a value.
        let drowned = |&&d: &&usize| {
            let samples = outcome.plan.samples(&outcome.evaluated.known, c, d).unwrap_or_default();
            let sum = |u: f64| samples.iter().find(|(node, _)| *node == u).map(|(_, rise)| rise / sigma);
            let inner = outcome
                .plan
                .axis(d)
                .inner
                .each_ref()
                .map(|slot| slot.as_ref().map(|slot| outcome.plan.axis(d).nodes[slot[0] as usize].u));
            let [Some(left), Some(right)] = inner else { return false };
            sum(left).zip(sum(right)).is_some_and(|(a, b)| (a + b).abs() < 2.0 * 6f64.sqrt() * scatter)
        };
        let drowned = outcome.plan.varying().iter().filter(|&&d| outcome.plan.depends(c, d)).filter(drowned).count();
        warnings.push(Warning::Scatter { characteristic: characteristic(), scatter, drowned });
    }
    let Some(check) = &climbed.checked[c] else { return warnings };
    let beyond = usize::from(climbed.tails[c].is_some_and(f64::is_infinite));
    let told = analysis.evidence.verification.as_ref().is_some_and(|verification| verification.failed > 0);
    if check.failed + beyond > 0 && !told && outcome.evaluated.known.value(&Point::Centre, c).is_some() {
        let (failed, points) = (check.failed + beyond, check.failed + check.points + beyond);
        warnings.push(Warning::DomainEdgeWithin { characteristic: characteristic(), failed, points, share: None });
    }
    let sampled = analysis.evidence.model_sampled.as_ref();
    if let Some((sampled, error)) = sampled.and_then(|sampled| Some((sampled, sampled.error.as_ref()?))) {
        warnings.push(Warning::FailedSamples {
            characteristic: characteristic(),
            failed: sampled.failed,
            samples: sampled.samples + sampled.failed,
            error: error.clone(),
        });
    }
    let share = sampled.map_or(check.variance / (sigma * sigma), |sampled| sampled.left.unwrap_or(1.0));
    if share > UNTRUSTED {
        let sampled = sampled.map(|sampled| sampled.samples);
        warnings.push(Warning::UntrustedSurrogate { characteristic: characteristic(), share, sampled });
    } else if share > LEFT_OUT && sampled.is_none() {
        warnings.push(Warning::InteractionsLeftOut { characteristic: characteristic(), share });
    }
    let error = analysis.error_estimate.as_ref().and_then(|estimate| Some(estimate.sigma? / sigma));
    let sigma = error.map(|error| (Figure::Sigma, error, climbed.accuracy));
    for (figure, error, wanted) in sigma.into_iter().chain(beside_sigma(analysis, &climbed.accuracies)) {
        if error > wanted {
            let (error, budget) = (Some(error).filter(|error| error.is_finite()), climbed.rest == ClimbEnd::Budget);
            warnings.push(Warning::UnderResolved { characteristic: characteristic(), figure, error, wanted, budget });
        }
    }
    warnings
}
