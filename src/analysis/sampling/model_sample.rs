//! Fallback if a surrogate is not trusted: points of the model itself, with the surrogate as control variate.

use std::sync::Arc;

use crate::analysis::result::stage_figures::{ModelSampleFigures, MomentFigures};
use crate::analysis::result::yield_error::of_yield;
use crate::analysis::sampling::accuracy_target::{MORE, PART, excess};
use crate::analysis::sampling::cross_fit::{Beside, CrossFit, CrossFitFigures};
use crate::analysis::sampling::known_answers::KnownAnswersFunction;
use crate::analysis::sampling::recorded_points::RecordingModel;
use crate::analysis::{CharacteristicAnalysis, SampledModel};
use crate::estimate::{Share, carried_by, student};
use crate::evaluation::{Evaluator, Ledger};
use crate::method::{AutoAccount, ErrorEstimate, ErrorSource, Outcome};
use crate::simulation::{REPLICATES, SimulatedCharacteristic, SimulationOptions, simulate_beside};
use crate::warning::Figure;
use sensitol_numeric::capability::EstimatedQuantile;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::sampling::{Estimate, SOBOL_DIMENSIONS, Sampler, one_error};

/// Greatest number of points of a cheap model.
const MOST: u64 = 1 << 18;
/// Smallest number of points for which the sample of a costly model is useful.
pub(super) const FEWEST: u64 = 48;
/// Smallest number of points of the first sample.
const FIRST: u64 = 1 << 10;
/// Greatest number of points of strides with regressions. If the accuracy is not reached with them, a regression does not follow the model,
/// and each stride fits all regressions anew.
const STRIDES: usize = 512;
/// Part of a costly model's budget that strides may use (one in four), because the points of its sample are others.
const COSTLY_PART: usize = 4;

/// Figures of points of the model for the characteristics whose moments miss the requested accuracy, by their places, if the budget allows
/// it. The `kinked` characteristics, whose surfaces are wrong for certain, have them without a budget too: from as many points as the method
/// has evaluated.
pub(in crate::analysis) fn model_samples(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    kinked: &[usize],
    characteristics: &[CharacteristicAnalysis],
) -> Vec<(usize, ModelSampleFigures)> {
    let nothing = Vec::new();
    let (problem, run, seed) = (evaluator.problem(), evaluator.run(), evaluator.seed());
    let begun = evaluator.summary().evaluations;
    // In points, of which each may take several evaluations.
    let each = problem.evaluations_per_point() as u64;
    let spent = || (evaluator.summary().evaluations - begun).div_ceil(each);
    let Some(climbed) = outcome.climbed.as_ref().filter(|_| outcome.evaluated.stopped().is_none()) else {
        return nothing;
    };
    let is_open = |&c: &usize| characteristics[c].evidence.model_sampled.is_none();
    let is_short =
        |&c: &usize| is_open(&c) && (kinked.contains(&c) || shortfall(&characteristics[c], climbed, c).is_some());
    let short: Vec<usize> = (0..characteristics.len()).filter(is_short).collect();
    if short.is_empty() {
        return nothing;
    }
    let remembered;
    let costly = problem.function().signature().costly;
    // A costly model is sampled only within its budget.
    let most = match (costly, evaluator.remaining().map(|left| left as u64)) {
        (true, None) if kinked.is_empty() => 0,
        (true, None) => (begun / each).max(FEWEST),
        (true, Some(left)) => left,
        (false, left) => left.unwrap_or(MOST).min(MOST),
    };
    if most < FEWEST {
        return nothing;
    }
    let strided = if costly { most as usize / COSTLY_PART } else { most as usize }.min(STRIDES);
    // No regression follows a kink.
    let strided = if short.iter().all(|c| kinked.contains(c)) { 0 } else { strided };
    let problem = match stride(evaluator, outcome, climbed, strided, &short, characteristics) {
        Strided::Enough(found) => return found,
        Strided::Known(answers) => {
            // The sample begins with these points. They are not evaluated again.
            remembered = problem.replacing(0, problem.dimensions()[0].clone(), Arc::new(*answers));
            &remembered
        }
        Strided::Nothing => problem,
    };
    let needed = short.iter().filter_map(|&c| shortfall(&characteristics[c], climbed, c)).fold(0.0, f64::max);
    let finest =
        climbed.accuracies.wanted().into_iter().filter_map(|(_, wanted)| wanted).fold(climbed.accuracy, f64::min);
    let few = problem.dimensions().iter().filter(|dimension| dimension.sigma() > 0.0).count() <= SOBOL_DIMENSIONS;
    let sampler = if costly || !few { Sampler::Random } else { Sampler::Sobol };
    let few_scramblings = if sampler == Sampler::Sobol { student(REPLICATES as usize) } else { 1.0 };
    let mut samples = ((needed / (PART * finest)).powi(2) as u64).clamp(FIRST, MOST).min(most);
    // Points that were evaluated in strides are not evaluated again.
    let most = most + if sampler == Sampler::Sobol { spent() } else { 0 };
    let recorded = Arc::new(RecordingModel::new(problem));
    // A cheap model is evaluated again, and answers several batches at a time.
    let recording = costly.then(|| problem.with_function(recorded.clone()));
    let problem = recording.as_ref().unwrap_or(problem);
    while spent() + samples <= most {
        recorded.clear();
        // Sobol' points come in powers of two: the greatest power that is allowed.
        let points = if sampler == Sampler::Sobol { (samples + 1).next_power_of_two() / 2 } else { samples };
        let wish = SimulationOptions { samples: points.max(2), sampler, seed, ..SimulationOptions::default() };
        let Ok(found) = simulate_beside(problem, &wish, outcome, run) else { return nothing };
        evaluator.merge(Ledger { run: found.run, non_repeatable: found.non_repeatable.clone() });
        if found.run.unfinished() {
            return nothing;
        }
        let enough = short.iter().all(|&c| known(&found.characteristics[c], climbed));
        let last = enough || spent() + MORE as u64 * samples > most;
        if last {
            let of = |&c: &usize| {
                let ranks = recorded.ranks(c, &*outcome.plan);
                let found = (&found.characteristics[c], few_scramblings);
                let one = &characteristics[c];
                Some((c, of_simulation(one, Some(left(one, climbed, c)), found, ranks)?))
            };
            return short.iter().filter_map(of).collect();
        }
        samples *= MORE as u64;
    }
    nothing
}

/// Result of the attempt with strides.
enum Strided {
    /// Every figure has the requested accuracy. Empty if the run was stopped before.
    Enough(Vec<(usize, ModelSampleFigures)>),
    /// The requested accuracy was not reached. Contains the answers of the model.
    Known(Box<KnownAnswersFunction>),
    Nothing,
}

/// Samples in strides with sparse regressions as control variates. Takes their figures if all have the requested accuracy.
fn stride(
    evaluator: &Evaluator<'_>,
    outcome: &Outcome,
    climbed: &AutoAccount,
    most: usize,
    short: &[usize],
    characteristics: &[CharacteristicAnalysis],
) -> Strided {
    let strides =
        CrossFit::new(evaluator.problem(), outcome, evaluator.seed()).filter(|strides| strides.next(most) > 0);
    let Some(mut strides) = strides else { return Strided::Nothing };
    let mut beside: Vec<Vec<Beside<'_>>> = short.iter().map(|&c| strides.beside(c)).collect();
    while strides.next(most) > 0 {
        if !strides.draw(most, evaluator) {
            return Strided::Enough(Vec::new());
        }
        let found: Option<Vec<CrossFitFigures>> = (short.iter().zip(&mut beside))
            .map(|(&c, beside)| strides.found(c, beside, left(&characteristics[c], climbed, c)))
            .collect();
        if let Some(found) = found.filter(|found| found.iter().all(|found| found.is_known(climbed))) {
            let of = |(&c, found): (&usize, CrossFitFigures)| (c, model_sample_figures(&characteristics[c], found));
            return Strided::Enough(short.iter().zip(found).map(of).collect());
        }
    }
    Strided::Known(Box::new(strides.answers))
}

impl CrossFitFigures {
    /// True if two standard errors are within the requested accuracy, for sigma and all other requested figures.
    fn is_known(&self, climbed: &AutoAccount) -> bool {
        let within = |error: Option<f64>, wanted: f64| error.is_some_and(|error| error <= PART * wanted);
        let [_, sigma, skewness, kurtosis] = self.moments;
        let each = |(figure, wanted): (Figure, Option<f64>)| {
            let Some(wanted) = wanted else { return true };
            match figure {
                Figure::Sigma => true,
                Figure::Skewness => within(skewness.standard_error, wanted),
                Figure::Kurtosis => within(kurtosis.standard_error, wanted),
                Figure::Yield => {
                    let share = self.sampled.yield_.zip(self.sampled.yield_interval);
                    share.is_none_or(|(share, interval)| within(Some(one_error(share, interval)), wanted))
                }
            }
        };
        let sigma = within(sigma.standard_error, climbed.accuracy * sigma.value);
        sigma && climbed.accuracies.wanted().into_iter().all(each)
    }
}

/// Size of the residual as a part of sigma, if the accuracy of sigma or of another figure is missed. Returns None otherwise.
fn shortfall(one: &CharacteristicAnalysis, climbed: &AutoAccount, c: usize) -> Option<f64> {
    let (moments, check) = (one.moments?, climbed.checked[c].as_ref()?);
    let error = one.error_estimate.as_ref()?.sigma?;
    let variance = moments.variance();
    let short = error > climbed.accuracy * moments.sigma() || excess(one, &climbed.accuracies) > 1.0;
    // The part that the surrogate does not explain decides how many points a control variate needs.
    short.then(|| (check.variance / variance).sqrt().clamp(0.01, 1.0))
}

/// True if two standard errors are within the requested accuracy, for sigma and all other requested figures.
fn known(found: &SimulatedCharacteristic, climbed: &AutoAccount) -> bool {
    let within = |error: Option<f64>, wanted: f64| error.is_some_and(|error| error <= PART * wanted);
    let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
    let sigma = error(found.sigma).zip(found.sigma).map(|(error, sigma)| error / sigma.value);
    let each = |(figure, wanted): (Figure, Option<f64>)| {
        let Some(wanted) = wanted else { return true };
        match figure {
            Figure::Sigma => true,
            Figure::Skewness => within(error(found.skewness), wanted),
            Figure::Kurtosis => within(error(found.kurtosis), wanted),
            Figure::Yield => {
                found.yield_.is_none_or(|share| within(Some(one_error(share.value, share.interval)), wanted))
            }
        }
    };
    within(sigma, climbed.accuracy) && climbed.accuracies.wanted().into_iter().all(each)
}

/// Figures of a simulation, beside a surface that leaves the share `left` of the variance unexplained, or beside none. Returns None if a moment
/// is unknown.
pub(super) fn of_simulation(
    one: &CharacteristicAnalysis,
    left: Option<f64>,
    (found, few): (&SimulatedCharacteristic, f64),
    ranks: Vec<(usize, Share)>,
) -> Option<ModelSampleFigures> {
    let moments = [found.mean?, found.sigma?, found.skewness?, found.kurtosis?];
    // Widened as the errors of a verification are: few randomisations, and few points that carry a power, determine their own scatter
    // badly.
    let carried = found.control.map(|control| control.carried);
    let widths = carried.map_or([1.0; 4], |points| points.map(|points| few * carried_by(points)));
    let standard_errors = std::array::from_fn(|i| moments[i].standard_error.map(|error| widths[i] * error));
    let sampled = SampledModel {
        samples: found.samples,
        failed: found.failed,
        error: found.error.as_ref().map(ToString::to_string),
        left,
        standard_errors,
        yield_: found.yield_.map(|share| share.value),
        yield_interval: found.yield_.map(|share| share.interval),
        beyond: [found.below, found.above],
        intervals: found.reject_intervals,
        // Quantiles without an error are not resolved.
        quantiles: found.quantiles.map(|quantile| {
            let Estimate { value, standard_error } = quantile?;
            Some(EstimatedQuantile { value, error: Some(few * standard_error?) })
        }),
        histogram: found.histogram.clone(),
        ranks,
    };
    Some(model_sample_figures(one, CrossFitFigures { moments, sampled }))
}

/// Share of the variance that the surface does not explain, by the check points.
fn left(one: &CharacteristicAnalysis, climbed: &AutoAccount, c: usize) -> f64 {
    let variance = one.moments.map_or(0.0, |moments| moments.variance());
    let checked = climbed.checked[c].as_ref().map(|check| check.variance);
    checked.map_or(0.0, |off| if variance > 0.0 { (off / variance).min(1.0) } else { 1.0 })
}

/// Figures of points of the model with their errors.
fn model_sample_figures(
    one: &CharacteristicAnalysis,
    CrossFitFigures { moments, sampled }: CrossFitFigures,
) -> ModelSampleFigures {
    let [mean, sigma, skewness, kurtosis] = moments.map(|of| of.value);
    let limits = one.characteristic.limits();
    let moments = MomentFigures::of(Moments::new(mean, sigma, skewness, kurtosis - 3.0), limits);
    let sources = vec![ErrorSource::Sampled { points: sampled.samples }];
    let [mean, sigma, skewness, kurtosis] = sampled.standard_errors;
    let estimate = ErrorEstimate { mean, sigma, skewness, kurtosis, yield_: None, sources };
    // Error of the fit of four moments: its distance from the sample's yield, and the error of that yield.
    let of_fit =
        moments.capability.and_then(|capability| capability.yield_()).zip(sampled.yield_.zip(sampled.yield_interval));
    let off = of_fit.map(|(fit, (value, interval))| (fit - value).abs() + one_error(value, interval));
    let of_moments = of_yield(&estimate, &moments.moments, limits);
    let yield_ = of_moments.map(|error| error.max(off.unwrap_or(0.0)));
    ModelSampleFigures { moments, error_estimate: ErrorEstimate { yield_, ..estimate }, sampled }
}
