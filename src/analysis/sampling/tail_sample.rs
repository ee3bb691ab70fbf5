//! Yield of `auto` where check points refute the surface at a limit: importance samples of the model about the place.

use crate::analysis::result::stage_figures::TailFigures;
use crate::analysis::sampling::accuracy_target::beside_sigma;
use crate::analysis::{CharacteristicAnalysis, SampledTail};
use crate::evaluation::{Evaluator, Ledger};
use crate::method::{DerivativeSource, Method, Options, Outcome};
use crate::problem::Problem;
use crate::rare::{Beyond, MOST_TAIL_POINTS, RareCharacteristic, RefutedTail, sample_refuted};
use crate::summary::RunSummary;
use crate::warning::Figure;
use sensitol_numeric::sampling::clopper_pearson;
use sensitol_numeric::verdict::Verdict;

/// Greatest number of points within a budget: as many as `simulate` takes for rare events of an external program.
const MOST: usize = 1000;

/// Greatest number of points of the model in refuted tails, after `spent` points. Only `auto` of a costly model with limits has any.
pub fn most_tail_points(problem: &Problem, options: &Options, spent: usize) -> usize {
    let signature = problem.function().signature();
    let limited = (problem.characteristics().iter().enumerate())
        .any(|(c, one)| one.limits().exist() && !problem.follows_costly_choice(c));
    let verified = signature.costly && options.verify.is_none() && options.verifies(signature);
    let asked =
        options.sample_tails && options.method == Method::Auto && options.derivatives != Some(DerivativeSource::Exact);
    match asked && limited && verified {
        true => options.points(problem).map_or(MOST_TAIL_POINTS, |points| points.saturating_sub(spent).min(MOST)),
        false => 0,
    }
}

/// Decides the yields whose surfaces are refuted by points of the model, within the budget, and without one by at most
/// [`MOST_TAIL_POINTS`]. Nothing is evaluated for any other method, with a number of check points that was requested, and where the
/// interval of the check points suffices for the target or the requested accuracy.
pub(in crate::analysis) fn decide(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    options: &Options,
    refuted: &[RefutedTail],
    characteristics: &[CharacteristicAnalysis],
) -> Vec<(usize, TailFigures)> {
    let each = evaluator.problem().evaluations_per_point();
    let spent = outcome.evaluated.ledger.evaluations().div_ceil(each);
    let most = most_tail_points(evaluator.problem(), options, spent).min(evaluator.remaining().unwrap_or(usize::MAX));
    if most == 0 || evaluator.run().stopped() {
        return Vec::new();
    }
    let is_open = |tail: &&RefutedTail| is_open(&characteristics[tail.characteristic], options);
    let open: Vec<RefutedTail> = refuted.iter().filter(is_open).cloned().collect();
    let Some(found) = sample_refuted(evaluator, outcome, &open, most as u64) else {
        return Vec::new();
    };
    let each = found.characteristics.iter();
    let figures = each.filter_map(|(c, one)| Some((*c, taken(&characteristics[*c], one, found.points)?))).collect();
    evaluator.merge(Ledger { run: RunSummary { stopped: None, ..found.ledger.run }, ..found.ledger });
    figures
}

/// True if the check points leave a yield open: its target is not decided, and its requested accuracy is not reached.
fn is_open(one: &CharacteristicAnalysis, options: &Options) -> bool {
    let sampled = one.evidence.model_sampled.is_some();
    let decided = matches!(one.verdict(), Some(Verdict::Met | Verdict::Missed));
    let wanted = beside_sigma(one, &options.accuracies).into_iter().find(|(figure, ..)| *figure == Figure::Yield);
    !sampled && !decided && wanted.is_none_or(|(_, error, wanted)| error > wanted)
}

/// Shares of a sample. A side without a reject has that of the surface, as far as its interval allows. Returns None without an interval.
fn taken(one: &CharacteristicAnalysis, found: &RareCharacteristic, points: u64) -> Option<TailFigures> {
    let interval = found.yield_interval?;
    let law = one.distribution.capability;
    let of_law = [law.and_then(|of| of.below), law.and_then(|of| of.above)];
    let share = |beyond: &Option<Beyond>, of_law: Option<f64>| {
        let beyond = beyond.as_ref()?;
        let [low, high] = beyond.interval;
        beyond.probability.or(of_law.map(|share| share.clamp(low, high))).or(Some(0.5 * high))
    };
    let beyond = [share(&found.below, of_law[0]), share(&found.above, of_law[1])];
    let intervals = [&found.below, &found.above].map(|beyond| beyond.as_ref().map(|beyond| beyond.interval));
    let yield_ = (1.0 - beyond.iter().flatten().sum::<f64>()).clamp(0.0, 1.0);
    let sides = [&found.below, &found.above].into_iter().flatten();
    let drawn: f64 = sides.filter_map(|of| of.bounds).map(|[least, most]| most - least).sum();
    // Points that searched for the tail may fail where none is drawn. More points lie in the tail than assemblies.
    let unmet = if found.failed > 0 { clopper_pearson(0.0, points as f64)[1] } else { 0.0 };
    let lost = drawn.max(unmet).min(1.0);
    let sampled = SampledTail { points, failed: found.failed, yield_, interval, beyond, intervals };
    Some(TailFigures { sampled, lost })
}
