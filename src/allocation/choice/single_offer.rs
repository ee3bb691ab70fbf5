//! Cheapest tolerances when every group has one offer.
//!
//! Each constraint is replaced by the sum of powers with its value and slopes at the present tolerances
//! ([`Linearised::row`]). The resulting separable convex problem is solved exactly,
//! and the next one begins at its solution. Worst cases and sums of squares are such sums, so that one step is enough.
//! For second-order moments the steps shrink in proportion to the curvature's part of the variance. At the end the true
//! slopes fulfil the conditions of Karush, Kuhn and Tucker. Source: the idea of convex approximations, C. Fleury,
//! "Structural optimization: a new dual method using mixed variables", Int. J. Numerical Methods in Engineering 23
//! (1986).

use crate::allocation::choice::closed_form::closed_form;
use crate::allocation::cost::priced_group::Priced;
use crate::allocation::cost::setup_cost::SetUp;
use crate::allocation::requirement::constraint::{Constraint, kept};
use crate::allocation::requirement::linearised::Linearised;
use crate::allocation::requirement::quality_loss::{QualityLoss, losses_at};
use crate::allocation::result::solver_result::{Ends, Solved, Starts};
use crate::allocation::surface::response::Responses;
use sensitol_numeric::optimise::augmented_lagrangian::solve_separable;
use sensitol_numeric::optimise::minimise::minimise_by_swarm;
use sensitol_numeric::optimise::separable::{PowerRow, SeparableProblem};
use sensitol_numeric::parallel::prelude::*;

/// Problem of one search: constraints, costs, and the responses at the linearization point.
#[derive(Clone, Copy)]
pub(in crate::allocation) struct Setting<'a> {
    pub(in crate::allocation) responses: &'a Responses,
    pub(in crate::allocation) priced: &'a [Priced],
    pub(in crate::allocation) constraints: &'a [Constraint],
    /// Costs of deviations and rejects, in addition to those of the tolerances.
    pub(in crate::allocation) losses: &'a [QualityLoss],
    pub(in crate::allocation) setups: &'a [SetUp],
    pub(in crate::allocation) stopped: &'a (dyn Fn() -> bool + Sync),
    /// True if several starts are used in case there are several optima, false if only the given start is.
    pub(in crate::allocation) anywhere: bool,
}

/// Greatest number of steps of a search.
const STEPS: usize = 60;
/// Number of starts between the tightest and the loosest tolerances.
const BETWEEN: usize = 4;
/// Golden section. Its multiples, modulo 1, give starts without a pattern.
const GOLDEN: f64 = 0.618_033_988_749_894_9;
/// Greatest work for more starts: groups times requirements times the square of the dimensions. It takes some tenths of
/// a second.
const MOST_WORK: usize = 100_000;
/// Number of different ends above which a swarm search chooses the start.
const MOST_ENDS: usize = 2;
/// Relative difference between sums in another order.
const RESERVE: f64 = 1e-13;
/// Relative distance within which a tolerance is at its bound.
const AT_BOUND: f64 = 1e-9;
/// Residuals at which a search has converged: for slopes from formulas, and for slopes from differences, which are
/// right to 1e-10.
const STILL: [f64; 2] = [1e-11, 1e-9];
/// Residual that still counts as optimal, once steps lower it no more.
pub(in crate::allocation) const SMALL: f64 = 1e-8;
/// Number of steps within which a residual that still falls is at least halved.
const PATIENCE: usize = 3;
/// Number of steps without a halved residual after which a search ends. Shortened steps, of a tenth, need seven.
const ASTRAY: usize = 12;
/// Relative difference within which two solutions are the same.
const SAME: f64 = 1e-9;

impl Setting<'_> {
    /// Largest value of a constraint. All are kept if it is at most 1.
    pub(in crate::allocation) fn value(&self, at: &[f64]) -> f64 {
        let value = |constraint: &Constraint| constraint.value(self.responses, self.priced, at);
        self.constraints.iter().map(value).fold(0.0, f64::max)
    }

    /// Cost of the groups at half bands of their first offers, plus the losses there.
    pub(in crate::allocation) fn cost(&self, at: &[f64]) -> f64 {
        let held: f64 = self.priced.iter().zip(at).map(|(group, &t)| group.parts * group.offers[0].curve.cost(t)).sum();
        held + losses_at(self.losses, self.responses, self.priced, at)
    }

    /// Losses as sums of powers with their values and slopes at these half bands. Returns None if one is unknown.
    pub(in crate::allocation) fn loss_rows(&self, at: &[f64]) -> Option<Vec<PowerRow>> {
        let row = |loss: &QualityLoss| Some(loss.linearised(self.responses, self.priced, at)?.row(at));
        self.losses.iter().map(row).collect()
    }

    pub(in crate::allocation) fn linearised(&self, at: &[f64]) -> Option<Vec<Linearised>> {
        let (responses, priced) = (self.responses, self.priced);
        self.constraints.par_iter().map(|constraint| constraint.linearised(responses, priced, at)).collect()
    }

    /// True if sums of powers represent every requirement and loss exactly.
    pub(in crate::allocation) fn is_exact(&self) -> bool {
        let exact = |one: &Constraint| one.form().is_sum(one, self.responses);
        self.constraints.iter().all(exact) && self.losses.iter().all(|loss| loss.is_exact(self.responses))
    }

    /// True if cost and requirements are convex in the tolerances, so that the conditions of an optimum are sufficient.
    ///
    /// Convex requirements are worst cases of straight surfaces, roots of sums of squares with any correlation, and
    /// squares of deviations about fixed means.
    pub(in crate::allocation) fn is_convex(&self) -> bool {
        let rows = self.constraints.iter().all(|one| one.form().is_convex(one, self.responses));
        rows && self.losses.iter().all(|loss| loss.is_exact(self.responses)) && self.costs_are_convex()
    }

    /// True if every cost is convex in its tolerance.
    pub(in crate::allocation) fn costs_are_convex(&self) -> bool {
        let mut offers = self.priced.iter().flat_map(|group| &group.offers);
        offers.all(|offer| offer.curve.is_convex(offer.min, offer.max))
    }

    /// Tightest and loosest half band of every group.
    pub(in crate::allocation) fn bounds(&self) -> Vec<[f64; 2]> {
        self.priced.iter().map(|group| [group.tightest(), group.loosest()]).collect()
    }

    /// Cheapest tolerances that keep every constraint, from `start` and, if there may be several optima, from other
    /// starts. Returns None if none were found.
    pub(in crate::allocation) fn solve(&self, start: &[f64]) -> Option<Solved> {
        let bounds = self.bounds();
        let tight: Vec<f64> = bounds.iter().map(|&[low, _]| low).collect();
        let mut starts = vec![self.within(start)];
        let one_start = self.is_exact() && self.costs_are_convex();
        if !one_start {
            let loose: Vec<f64> = bounds.iter().map(|&[_, high]| high).collect();
            // If the loosest tolerances keep everything, nothing is cheaper. No slope need lead there.
            if self.losses.is_empty() && kept(self.value(&loose)) {
                let nothing = vec![0.0; self.constraints.len()];
                let solved = self.judged(&loose, &self.linearised(&loose)?, &nothing, false);
                return Some(Solved { converged: true, ..solved });
            }
            starts.push(self.within(&start.iter().map(|t| 0.3 * t).collect::<Vec<_>>()));
            starts.push(self.reached(&tight, &loose, 0.5));
            starts.extend(self.elsewhere(&tight, &loose));
        }
        // A search that ends at a greater cost than its start has left its valley.
        let left = |found: &Solved, start: &[f64]| {
            !one_start && found.cost > self.cost(start) * (1.0 + SAME) && kept(self.value(start))
        };
        let descend = |start: &[f64], ends: &Ends| {
            let found =
                self.usable(start, &tight).and_then(|(start, linearised)| self.descend(start, linearised, ends));
            let ended = |found: &Solved| found.converged && kept(found.value);
            let from = match &found {
                Some(found) if ended(found) && !left(found, start) => None,
                Some(found) if kept(found.value) && !left(found, start) => Some(&found.at[..]),
                _ => Some(start),
            };
            // Sums of powers lead nowhere from here, or did not converge.
            let finished = from.and_then(|from| self.finished(from, ends)).filter(ended);
            finished.or(found)
        };
        let mut ends = Ends::default();
        let mut starts = starts.into_iter();
        // Costs are convex. Another start may help if the constraints are not, and if the search did not converge.
        for start in starts.by_ref() {
            let end = descend(&start, &ends);
            ends.take(end);
            if ends.has_ended() || (self.stopped)() {
                break;
            }
        }
        // The other searches run in parallel. Each gets only the ends so far, so that the result does not depend on
        // their order.
        if self.anywhere && !one_start && !(self.stopped)() {
            let rest: Vec<Vec<f64>> = starts.collect();
            let found: Vec<Option<Solved>> = rest.par_iter().map(|start| descend(start, &ends)).collect();
            found.into_iter().for_each(|end| ends.take(end));
        }
        // If the starts disagree or find nothing, a swarm search chooses a start.
        let confused = !one_start && (!ends.is_feasible() || ends.different() > MOST_ENDS);
        if let Some(start) = confused.then(|| self.swarmed(&bounds)).flatten() {
            let end = descend(&start, &ends);
            ends.take(end);
        }
        ends.found().or_else(|| self.kept_at_least(start, &tight))
    }

    /// Other starts for several possible optima, if a search is short: the loosest and the tightest tolerances, and
    /// points between them without a pattern.
    fn elsewhere(&self, tight: &[f64], loose: &[f64]) -> Vec<Vec<f64>> {
        let n = self.responses.varying().len();
        let work = self.priced.len() * n * n * self.constraints.len();
        if !self.anywhere || work > MOST_WORK {
            return Vec::new();
        }
        let between = |index: usize| {
            let ends = tight.iter().zip(loose).enumerate();
            ends.map(|(g, (&low, &high))| {
                let part = ((index * self.priced.len() + g + 1) as f64 * GOLDEN).fract();
                libm::pow(low, 1.0 - part) * libm::pow(high, part)
            })
            .collect()
        };
        [loose.to_vec(), tight.to_vec()].into_iter().chain((0..BETWEEN).map(between)).collect()
    }

    /// Best point of a swarm search. Points that keep all constraints are compared by cost, the others by their worst
    /// constraint. Returns None for a search from one start only, and if the search would take long.
    fn swarmed(&self, bounds: &[[f64; 2]]) -> Option<Vec<f64>> {
        let n = self.responses.varying().len();
        let work = self.priced.len() * n * n * self.constraints.len();
        if !self.anywhere || work > MOST_WORK || (self.stopped)() {
            return None;
        }
        let tolerances = |x: &[f64]| x.iter().map(|x| libm::exp(*x)).collect::<Vec<f64>>();
        let dearest = self.cost(&bounds.iter().map(|&[low, _]| low).collect::<Vec<f64>>()).abs();
        let function = |x: &[f64]| {
            let at = tolerances(x);
            let value = self.value(&at);
            if kept(value) { self.cost(&at) } else { dearest.max(1.0) * value }
        };
        let logarithms: Vec<[f64; 2]> = bounds.iter().map(|bounds| bounds.map(libm::log)).collect();
        minimise_by_swarm(&function, &logarithms).map(|x| self.within(&tolerances(&x)))
    }

    /// Tolerances between the tightest ones and the start, as far towards the start as all constraints are kept.
    /// Nothing is proven. Returns None if the tightest tolerances break a constraint.
    fn kept_at_least(&self, start: &[f64], tight: &[f64]) -> Option<Solved> {
        if !kept(self.value(tight)) {
            return None;
        }
        let (mut inside, mut outside) = (0.0, 1.0);
        for _ in 0..40 {
            let middle = 0.5 * (inside + outside);
            if kept(self.value(&self.reached(tight, start, middle))) { inside = middle } else { outside = middle }
        }
        let at = self.within(&self.reached(tight, start, inside));
        let (cost, value) = (self.cost(&at), self.value(&at));
        let multipliers = vec![0.0; self.constraints.len()];
        let residual = f64::INFINITY;
        let starts = Starts::default();
        let solved = Solved {
            at,
            cost,
            multipliers,
            residual,
            value,
            closed: false,
            converged: false,
            sequential: false,
            starts,
        };
        kept(value).then_some(solved)
    }

    /// Half bands clamped to their bounds.
    pub(in crate::allocation) fn within(&self, at: &[f64]) -> Vec<f64> {
        at.iter().zip(self.bounds()).map(|(t, [low, high])| t.clamp(low, high)).collect()
    }

    /// Point on the way between two sets of half bands, in logarithms.
    fn reached(&self, from: &[f64], to: &[f64], part: f64) -> Vec<f64> {
        from.iter().zip(to).map(|(from, to)| libm::pow(*from, 1.0 - part) * libm::pow(*to, part)).collect()
    }

    /// Start, or the first point towards the tightest tolerances at which all constraints are finite, with their slopes
    /// there.
    fn usable(&self, start: &[f64], tight: &[f64]) -> Option<(Vec<f64>, Vec<Linearised>)> {
        let parts = [0.0, 0.25, 0.5, 0.75, 0.9, 1.0];
        let mut all = parts.iter().map(|&part| self.reached(start, tight, part));
        all.find_map(|at| self.linearised(&at).map(|linearised| (at, linearised)))
    }

    /// Runs one search. Returns its end, or the end of an earlier search that it approaches.
    fn descend(&self, mut at: Vec<f64>, first: Vec<Linearised>, ends: &Ends) -> Option<Solved> {
        let mut known = Some(first);
        let mut multipliers: Option<Vec<f64>> = None;
        let mut best: Option<Solved> = None;
        let (mut part, mut last_step, mut converged, mut closed) = (1.0f64, f64::INFINITY, false, false);
        let (mut least, mut in_vain, mut still_at_last) = (f64::INFINITY, 0, false);
        let exact = self.is_exact();
        let still = STILL[usize::from(!exact)];
        for step in 0..STEPS {
            let Some(linearised) = known.take().or_else(|| self.linearised(&at)) else { break };
            if let Some(multipliers) = &multipliers {
                let now = self.judged(&at, &linearised, multipliers, closed);
                in_vain = if now.residual < 0.5 * least { 0 } else { in_vain + 1 };
                least = least.min(now.residual);
                let done = now.residual <= still || now.residual <= SMALL && in_vain >= PATIENCE;
                if let Some(known) = ends.near(&now.at, now.residual).filter(|_| !done) {
                    return Some(known.clone());
                }
                keep(&mut best, now);
                if in_vain >= ASTRAY {
                    break;
                }
                if done {
                    (converged, still_at_last) = (true, true);
                    break;
                }
            }
            if (self.stopped)() {
                break;
            }
            let rows: Vec<PowerRow> = linearised.iter().map(|one| one.row(&at)).collect();
            let Some(losses) = self.loss_rows(&at) else { break };
            let problem = SeparableProblem { unknowns: self.priced, rows: &rows, losses: &losses };
            if step == 0 {
                let direct = closed_form(&problem);
                closed = direct.is_some() && exact;
                multipliers = Some(match direct {
                    Some((_, multipliers)) => multipliers,
                    None => solve_separable(&problem, &at).1,
                });
            }
            let (found, next) = problem.solve(&multipliers.take().unwrap_or_default());
            let length = at.iter().zip(&next).map(|(a, b)| libm::log(b / a).abs()).fold(0.0, f64::max);
            // A surface that is not a sum of squares may need shorter steps.
            if !exact && step > 3 && length > 0.7 * last_step {
                part = (0.5 * part).max(0.1);
            }
            last_step = length;
            at = if part == 1.0 { next } else { self.reached(&at, &next, part) };
            multipliers = Some(found);
            if exact && step > 0 && length <= 1e-14 {
                converged = true;
            }
        }
        // A converged search was judged at its last step.
        let open = multipliers.as_ref().filter(|_| !still_at_last);
        if let Some((multipliers, linearised)) = open.and_then(|of| Some((of, self.linearised(&at)?))) {
            let now = self.judged(&at, &linearised, multipliers, closed);
            converged |= now.residual <= SMALL;
            keep(&mut best, now);
        }
        let mut best = best?;
        best.converged = converged;
        self.tighten(&mut best);
        if closed {
            let rows: Vec<PowerRow> = self.linearised(&best.at)?.iter().map(|one| one.row(&best.at)).collect();
            let direct = closed_form(&SeparableProblem { unknowns: self.priced, rows: &rows, losses: &[] });
            let same = |direct: &Vec<f64>| direct.iter().zip(&best.at).all(|(a, b)| (a / b - 1.0).abs() <= SAME);
            best.closed = direct.is_some_and(|(direct, _)| same(&direct));
        }
        Some(best)
    }

    /// Tightens a solution that exceeds a constraint by rounding, so that it is kept for any order of summation.
    pub(in crate::allocation) fn tighten(&self, solved: &mut Solved) {
        if solved.value > 1.0 + 1e-6 {
            return;
        }
        // Exponentials of the logarithms differ from the bounds by rounding.
        for (t, group) in solved.at.iter_mut().zip(self.priced) {
            let near =
                [group.tightest(), group.loosest()].into_iter().find(|bound| (*t / bound - 1.0).abs() < AT_BOUND);
            *t = near.unwrap_or(*t);
        }
        for attempt in 0..20 {
            let excess = self.value(&solved.at) - (1.0 - RESERVE);
            if excess <= 0.0 {
                break;
            }
            tightened(&mut solved.at, self.priced, 1.0 - excess * f64::from(1 << attempt.min(8)) - 1e-15);
        }
        solved.value = self.value(&solved.at);
        solved.cost = self.cost(&solved.at);
    }

    /// Judges tolerances and multipliers by the conditions of an optimum.
    pub(in crate::allocation) fn judged(
        &self,
        at: &[f64],
        linearised: &[Linearised],
        multipliers: &[f64],
        closed: bool,
    ) -> Solved {
        let mut slopes: Vec<f64> = (self.priced.iter().zip(at))
            .map(|(group, &t)| group.parts * group.offers[0].curve.log_derivatives(t, libm::log(t))[0])
            .collect();
        let scale = slopes.iter().fold(f64::MIN_POSITIVE, |scale, slope| scale.max(slope.abs()));
        for loss in self.losses {
            match loss.linearised(self.responses, self.priced, at) {
                Some(of) => slopes.iter_mut().zip(&of.slopes).for_each(|(slope, of)| *slope += of),
                None => slopes.fill(f64::NAN),
            }
        }
        let mut residual: f64 = if slopes.iter().any(|slope| slope.is_nan()) { f64::INFINITY } else { 0.0 };
        for (g, (group, &t)) in self.priced.iter().zip(at).enumerate() {
            let slope = slopes[g] + uses_of(linearised, multipliers, g);
            let offer = &group.offers[0];
            let violation = match (t <= offer.min * (1.0 + AT_BOUND), t >= offer.max * (1.0 - AT_BOUND)) {
                (true, true) => 0.0,
                (true, false) => (-slope).max(0.0),
                (false, true) => slope.max(0.0),
                (false, false) => slope.abs(),
            };
            residual = residual.max(violation / scale);
        }
        let mut value: f64 = 0.0;
        for (one, &multiplier) in linearised.iter().zip(multipliers) {
            value = value.max(one.value);
            residual = residual
                .max(one.value - 1.0)
                .max((multiplier / scale * (one.value - 1.0)).abs().min((one.value - 1.0).abs()));
        }
        Solved {
            at: at.to_vec(),
            cost: self.cost(at),
            multipliers: multipliers.to_vec(),
            residual,
            value,
            closed,
            converged: false,
            sequential: false,
            starts: Starts::default(),
        }
    }

    /// Residual of the conditions of an optimum at these tolerances, with these multipliers. Returns None if processes
    /// compete, or a constraint is unknown.
    pub(in crate::allocation) fn residual(&self, at: &[f64], multipliers: &[f64]) -> Option<f64> {
        let free = self.priced.iter().all(|group| group.offers.len() == 1);
        let linearised = self.linearised(at).filter(|_| free)?;
        Some(self.judged(at, &linearised, multipliers, false).residual)
    }

    /// Saving per unit by which the bound of a tolerance is widened. None within the bounds, and if processes compete
    /// or slopes are unknown.
    pub(in crate::allocation) fn bound_prices(&self, at: &[f64], multipliers: &[f64]) -> Vec<Option<f64>> {
        let nothing = vec![None; at.len()];
        let (Some(linearised), Some(losses)) = (self.linearised(at), self.loss_rows(at)) else { return nothing };
        let price = |g: usize| {
            let [offer] = &self.priced[g].offers[..] else { return None };
            let t = at[g];
            let lost: f64 = losses.iter().map(|row| row.terms[g].power * row.terms[g].value(t)).sum();
            let slope = self.priced[g].parts * offer.curve.log_derivatives(t, libm::log(t))[0] + lost;
            let price = (slope + uses_of(&linearised, multipliers, g)) / t;
            match (t <= offer.min * (1.0 + AT_BOUND), t >= offer.max * (1.0 - AT_BOUND)) {
                (true, false) => Some(price.max(0.0)),
                (false, true) => Some((-price).max(0.0)),
                _ => None,
            }
        };
        (0..at.len()).map(price).collect()
    }

    /// Least value of a constraint alone within the bounds, and its half bands.
    pub(in crate::allocation) fn attainable(&self, constraint: &Constraint) -> (f64, Vec<f64>) {
        let bounds = self.bounds();
        let mut at: Vec<f64> = bounds.iter().map(|&[low, _]| low).collect();
        let mut least = constraint.value(self.responses, self.priced, &at);
        // Tighter is better, except if a wide tolerance moves the mean in the right direction.
        for _ in 0..3 {
            let before = least;
            for g in 0..at.len() {
                let [low, high] = bounds[g];
                for part in 1..=16 {
                    let kept = at[g];
                    at[g] = libm::pow(low, 1.0 - f64::from(part) / 16.0) * libm::pow(high, f64::from(part) / 16.0);
                    let value = constraint.value(self.responses, self.priced, &at);
                    if value < least * (1.0 - 1e-9) { least = value } else { at[g] = kept }
                }
            }
            if least >= before {
                break;
            }
        }
        (least, at)
    }
}

/// Slope of the constraints by `ln T` of a group, weighted with their multipliers.
fn uses_of(linearised: &[Linearised], multipliers: &[f64], g: usize) -> f64 {
    linearised.iter().zip(multipliers).map(|(one, multiplier)| multiplier * one.slopes[g]).sum()
}

/// Keeps the solution with the smallest residual.
fn keep(best: &mut Option<Solved>, found: Solved) {
    let better = |old: &Solved| found.residual < old.residual;
    if best.as_ref().is_none_or(better) {
        *best = Some(found);
    }
}

/// Tightens all free tolerances by a factor. Those at their upper bound stay there, unless all are.
pub(in crate::allocation) fn tightened(at: &mut [f64], priced: &[Priced], factor: f64) {
    let free = |group: &Priced, t: f64| group.offers.len() == 1 && t < group.loosest() * (1.0 - AT_BOUND);
    let any = priced.iter().zip(at.iter()).any(|(group, &t)| free(group, t));
    for (t, group) in at.iter_mut().zip(priced) {
        if !any && group.offers.len() == 1 || free(group, *t) {
            *t = (*t * factor).max(group.tightest());
        }
    }
}
