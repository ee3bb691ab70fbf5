//! Correlations of characteristics.
//!
//! | source | condition | error |
//! |---|---|---|
//! | points of the model | the model is cheap and verified | jackknife over 16 randomisations |
//! | both surfaces | there is a surface of each | see below; none if the formulas' degree proves both surfaces |
//!
//! The covariance of two surfaces is exact, by the moments of their sum and their difference: `rho = (Var(q_1/s_1 + q_2/s_2) - Var(q_1/s_1
//! - q_2/s_2)) / 4`. The checks leave shares `U_1`, `U_2` of the variances unexplained. A residual hardly correlates with its own surface.
//! Its correlation with the other surface is `sqrt(1 - rho^2)` at most: `error = sqrt((1 - rho^2)(U_1 + U_2) + U_1 U_2)`.

use crate::analysis::CharacteristicAnalysis;
use crate::analysis::result::verification::VerificationKind;
use crate::analysis::sampling::sample_budget::SampleBudget;
use crate::estimate::{OutputCorrelation, Verified, most_points_together, output_correlations, pairs};
use crate::method::{Options, Outcome};
use crate::problem::Problem;
use sensitol_numeric::surrogate::Surrogate;

/// Correlations of every pair of characteristics. Empty with one characteristic, and with more than 40.
///
/// Evaluates a cheap model that is to be verified at 16 384 points if the budget allows it, and a costly one never.
pub(super) fn correlations(
    problem: &Problem,
    outcome: &Outcome,
    options: &Options,
    left: &mut SampleBudget,
    characteristics: &[CharacteristicAnalysis],
) -> Vec<OutputCorrelation> {
    let count = characteristics.len();
    if !(2..=OutputCorrelation::MOST).contains(&count) {
        return Vec::new();
    }
    let sampled = |one: &CharacteristicAnalysis| {
        one.evidence.verification.as_ref().is_some_and(|of| of.kind == VerificationKind::Sample)
    };
    let by_model = match characteristics.iter().any(sampled) && left.take(most_points_together(count)) {
        true => output_correlations(problem, options.seed.unwrap_or(Options::SEED)),
        false => Vec::new(),
    };
    let known = |index: usize, [a, b]: [usize; 2]| -> Option<(f64, Option<f64>)> {
        let ones = [&characteristics[a], &characteristics[b]];
        if let Some(by_model) = by_model.get(index).filter(|_| ones.iter().any(|one| sampled(one))) {
            return by_model.map(|Verified { value, error }| (value, Some(error)));
        }
        let (value, drawn) = of_surfaces(outcome, [a, b])?;
        let left = |one: &CharacteristicAnalysis| one.evidence.verification.as_ref().and_then(|of| of.left);
        let error = left(ones[0]).zip(left(ones[1])).map(|(u, v)| {
            let apart = (1.0 - value * value).max(0.0);
            (apart * (u + v) + u * v + drawn * drawn).sqrt().max(ROUNDING)
        });
        Some((value, error))
    };
    pairs(count)
        .enumerate()
        .map(|(index, pair)| {
            let (value, error) = known(index, pair).unzip();
            let between = pair.map(|c| characteristics[c].characteristic.name().to_owned());
            OutputCorrelation { between, value, error: error.flatten() }
        })
        .collect()
}

/// Least error of a coefficient: a value near 1 is a difference of variances near 4 and 0, each with a dozen roundings.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Correlation of the surfaces of two characteristics, with its standard error: 0 if it is exact, positive if moments are sampled.
/// Returns None if a surface is unknown or does not vary.
fn of_surfaces(outcome: &Outcome, [a, b]: [usize; 2]) -> Option<(f64, f64)> {
    let inputs = outcome.plan.inputs();
    let scaled = |c: usize| -> Option<(&Surrogate, f64)> {
        let surrogate = outcome.fitted[c].surrogate.as_ref()?;
        let sigma = surrogate.variance(inputs)?.0.sqrt();
        (sigma > 0.0).then_some((surrogate, 1.0 / sigma))
    };
    let ((first, by_first), (second, by_second)) = (scaled(a)?, scaled(b)?);
    let variance = |sign: f64| first.sum(by_first, second, sign * by_second)?.variance(inputs);
    let ((sum, of_sum), (difference, of_difference)) = (variance(1.0)?, variance(-1.0)?);
    Some(((0.25 * (sum - difference)).clamp(-1.0, 1.0), 0.25 * libm::hypot(of_sum, of_difference)))
}
