//! Choice of the next points of `auto`, from the answers so far. Nothing is evaluated here.

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::evaluation::Evaluator;
use crate::method::Options;
use crate::method::auto::characteristic_state::{View, skewed};
use crate::method::auto::chosen_points::{ChosenPoints, Probe};
use crate::method::auto::product::is_product;
use crate::method::auto_account::ClimbEnd;
use crate::method::exact_derivatives::ExactDerivatives;
use crate::method::polynomial_surface::PolynomialSurface;
use crate::plan::{DifferencePlan, KnownAnswers, Plan, Point, Purpose, Stage, scattered};
use crate::problem::Problem;

/// Mirrored pairs of points in a set of check points: twelve points.
const CHECKS: usize = 6;
/// Estimated error, as part of the requested one, above which a second set of check points confirms the estimate.
const CONFIRM: f64 = 0.1;
/// Smallest number of dimensions for which a second set confirms the estimate.
const CONFIRM_FROM: usize = 5;
/// Greatest number of sets of check points.
const SETS: usize = 3;
/// Greatest estimated error, as multiple of the requested one, that a further set may sharpen.
const NEAR: f64 = 2.0;
/// Share of even residuals, as part of the target error, above which further interactions are examined.
const PAIRS: f64 = 0.1;
/// Greatest number of characteristics that are examined far out along their steepest line.
const LINES: usize = 4;
/// Distance of these points from the means, in sigmas.
const FAR_OUT: f64 = 3.0;
/// Part of the distance from the mean to the end of the support that these points keep within.
const WITHIN: f64 = 0.98;
/// Share of the variance above which the line of the curvature gets points of its own.
const BENT: f64 = 1e-6;
/// Cosine of the angle between steepest and curved line above which the steepest line stands for both.
const PARALLEL: f64 = 0.9;
/// Distance of the points that measure scatter from the means, in sigmas of every dimension.
const NEXT_TO: f64 = 1e-3;
/// Greatest number of dimensions for which pairs are evaluated one by one: 2 x 18 probes would cost as much.
const DIRECT: usize = 12;
/// Smallest remaining budget that lets a costly model be sampled, in a quarter of it.
const SAMPLED: usize = 1024;
/// Number of probes that judge the fits.
const JUDGING: usize = 12;
/// Number of probes of the first fit.
const FITTED: usize = 6;
/// Share of odd residuals, as part of the target error, below which a probe needs no mirror image.
const ALONE: f64 = 0.1;
/// Factor by which the number of fitted probes grows.
const GROWTH: f64 = 1.25;
/// Finest error of sigma that is aimed at to reach the target error of another result.
const FINEST: f64 = 1e-7;
/// Greatest number of evaluations worth their price, as multiple of those of every second derivative.
const OVER_FULL: f64 = 1.3;
/// Evaluations that are added to this multiple.
const ON_TOP: usize = 16;
/// Errors of sigma that are reached one after the other. Their tenths, hundredths and so on follow.
const LEVELS: [f64; 3] = [0.1, 0.05, 0.02];
/// Share of the variance below which it is a rounding error.
const NOTHING: f64 = 1e-12;
/// Relative difference of scores below which pairs count as equal. Equal pairs are examined together or not at all.
const TWINS: f64 = 1e-6;
/// Seed of the signs of the probes. It is constant, so that all studies with as many dimensions have the same signs.
const KEY: u64 = 0x5e_75_17_02;

/// Returns the number of evaluations beyond which no derivative is evaluated. Replacements of failed points are not included.
pub(super) fn most(n: usize) -> usize {
    (OVER_FULL * (n * n + 3 * n + 1) as f64) as usize + ON_TOP
}

/// Returns the next smaller one of [`LEVELS`] and their tenths.
fn next_level(accuracy: f64) -> f64 {
    let mut unit = 1.0;
    loop {
        let level = LEVELS.iter().map(|level| level * unit).find(|&level| level < accuracy * (1.0 - TWINS));
        match level {
            Some(level) => return level,
            None => unit /= 10.0,
        }
    }
}

/// State of a refinement by `auto`.
pub(super) struct Climb<'p> {
    problem: &'p Problem,
    pub(super) plan: DifferencePlan,
    pub(super) bought: ChosenPoints,
    /// Accuracy of sigma to reach in the end.
    wanted: f64,
    /// Accuracy of sigma to reach next. It is lowered in fixed steps, so that a finer accuracy repeats the evaluations of a coarser one.
    accuracy: f64,
    budget: usize,
    /// Evaluations so far, and those that have been chosen since.
    spent: usize,
    /// True for a position with five points, and for one that cannot have five.
    pub(super) refined: Vec<bool>,
    sets: usize,
    looked_out: bool,
    /// True if pairs are evaluated at all four corners.
    squares: bool,
    /// True if probes are single points, without their mirror images.
    alone: bool,
    /// True if every interaction is evaluated by itself.
    pub(super) dense: bool,
    short_of_budget: bool,
    pub(super) rest: Option<ClimbEnd>,
}

impl<'p> Climb<'p> {
    pub(super) fn new(problem: &'p Problem, plan: DifferencePlan, accuracy: f64, options: &Options) -> Self {
        let refined = vec![false; plan.varying().len()];
        let budget = options.points(problem).unwrap_or(usize::MAX);
        let mut climb = Self {
            problem,
            plan,
            bought: ChosenPoints::default(),
            wanted: accuracy,
            accuracy: LEVELS[0].max(accuracy),
            budget,
            spent: 0,
            refined,
            sets: 0,
            looked_out: false,
            squares: false,
            alone: false,
            dense: false,
            short_of_budget: false,
            rest: None,
        };
        let known = ExactDerivatives::known_pairs(problem, &climb.plan, options);
        if !known.is_empty() {
            climb.bought.given = ExactDerivatives::mixed_of(problem, &climb.plan, &known);
        }
        climb.bought.polynomials = PolynomialSurface::all(problem, &climb.plan, options);
        climb.spent = climb.plan.cost().0;
        if !climb.plan.varying().is_empty() {
            climb.check();
            climb.listen();
        }
        climb.spent = 0;
        climb
    }

    /// Tightens the target error of sigma by a factor below 1. Returns true if that can lead to further evaluations.
    pub(super) fn tighten(&mut self, factor: f64) -> bool {
        let on = self.rest == Some(ClimbEnd::Reached) && self.wanted > FINEST;
        if on {
            self.rest = None;
            self.wanted = (self.wanted * factor.clamp(0.1, 0.5)).max(FINEST);
        }
        on
    }

    /// Returns the next points after those that the evaluator has in its ledger, or None if the refinement is over.
    pub(super) fn next(&mut self, known: &KnownAnswers, evaluator: &Evaluator<'_>) -> Option<Stage> {
        self.spent = evaluator.evaluations().div_ceil(self.problem.evaluations_per_point());
        loop {
            let mut stage = self.wanted(known);
            if !stage.points.is_empty() {
                let allowed = evaluator.remaining().unwrap_or(usize::MAX);
                if stage.points.len() > allowed {
                    // Replacements of failed points come in addition to the planned ones and may exceed the budget.
                    stage.points.truncate(allowed);
                    self.rest = Some(ClimbEnd::Budget);
                }
                return (!stage.points.is_empty()).then_some(stage);
            }
            if self.rest.is_some() || !self.choose(known) {
                return None;
            }
        }
    }

    /// Returns the view of every characteristic, or None if it has no value at the means.
    pub(super) fn views(&self, known: &KnownAnswers) -> Vec<Option<View>> {
        let characteristics = 0..self.problem.characteristics().len();
        characteristics.map(|c| View::of(&self.plan, known, &self.bought, c, self.accuracy)).collect()
    }

    /// Returns the points that have been chosen and are not evaluated yet.
    pub(super) fn wanted(&self, known: &KnownAnswers) -> Stage {
        let mut stage = self.plan.next(known).unwrap_or_default();
        let checks = self.bought.checks.iter().flatten().map(|point| (point, Purpose::Check));
        let noise = self.bought.noise.iter().flatten().map(|point| (point, Purpose::Noise));
        let tails = self.bought.tails.iter().flat_map(|(_, points)| points).map(|point| (point, Purpose::Check));
        let probes = self.bought.judging.iter().chain(&self.bought.fitted).flat_map(|probe| &probe.points);
        let probes = probes.map(|point| (point, Purpose::Probe));
        let mut seen: std::collections::HashSet<Point> = stage.points.iter().map(|(point, _)| point.clone()).collect();
        for (point, purpose) in checks.chain(noise).chain(tails).chain(probes) {
            if !known.tried(point) && seen.insert(point.clone()) {
                stage.points.push((point.clone(), purpose));
            }
        }
        stage
    }

    /// True if every mixed derivative of a characteristic is known.
    pub(super) fn knows_all_pairs(&self, c: usize) -> bool {
        self.bought.polynomial(c).is_some() || self.bought.known(c).len() == self.plan.possible_pairs()
    }

    /// Returns the number of pairs whose interactions are given by the formulas of all characteristics.
    pub(super) fn pairs_by_formulas(&self) -> usize {
        match self.bought.polynomials.iter().all(Option::is_some) {
            true => self.plan.possible_pairs(),
            false => 0,
        }
    }

    fn positions(&self) -> usize {
        self.plan.varying().len()
    }

    /// Returns the evaluations that are left of the budget, without those that have been chosen.
    fn remaining(&self) -> usize {
        self.budget.saturating_sub(self.spent)
    }

    /// Returns how many of `most` items of `each` evaluations the budget allows, and charges them.
    fn afford(&mut self, most: usize, each: usize) -> usize {
        let count = most.min(self.remaining() / each);
        self.short_of_budget |= count < most;
        self.spent += count * each;
        count
    }

    /// Chooses the evaluations that lower the error most. Returns true if there are any.
    fn choose(&mut self, known: &KnownAnswers) -> bool {
        self.short_of_budget = false;
        let views: Vec<View> = self.views(known).into_iter().flatten().collect();
        if !self.looked_out {
            self.looked_out = true;
            if self.look_out(&views) {
                return true;
            }
        }
        // Every estimate is within the error of this step: confirm it once if it is close, then go to the next step.
        // Points of the model give the figures of a costly choice from stock: no derivative follows its jumps.
        let refined = |view: &&View| !self.problem.follows_costly_choice(view.characteristic);
        let short: Vec<&View> = views.iter().filter(refined).filter(|view| view.error() > self.accuracy).collect();
        if short.is_empty() {
            let doubtful = views.iter().filter(refined).any(|view| view.error() > CONFIRM * self.accuracy);
            if doubtful && self.sets == 1 && self.positions() >= CONFIRM_FROM && self.check() {
                return true;
            }
            if self.descend() {
                return true;
            }
            self.rest = Some(ClimbEnd::Reached);
            return false;
        }
        // Interactions of a product are too many to examine, but a regression of its logarithm takes few points.
        if self.positions() > DIRECT && self.may_be_sampled() && short.iter().all(|view| self.multiplies(view, known)) {
            self.rest = Some(ClimbEnd::Exhausted);
            return false;
        }
        // Hidden terms and interactions are examined in one stage. Other evaluations follow only if these need none.
        let curved = self.refine_hidden(&short);
        let near = short.iter().all(|view| view.error() < NEAR * self.accuracy);
        let found = self.examine(&short, known)
            || curved
            || self.refine_rest(&short)
            || self.examine_rest(&short)
            || near && self.sets < SETS && self.spent + 2 * CHECKS <= most(self.positions()) && self.check();
        // No evaluation helps at this step. A finer step may still have some.
        if !found && !self.short_of_budget && self.descend() {
            return true;
        }
        if !found {
            self.rest = Some(if self.short_of_budget { ClimbEnd::Budget } else { ClimbEnd::Exhausted });
        }
        found
    }

    /// True if points of the model can be sampled if the surface is not accurate enough.
    fn may_be_sampled(&self) -> bool {
        let free = !self.problem.function().signature().costly;
        free || self.budget != usize::MAX && self.remaining() >= SAMPLED
    }

    fn multiplies(&self, view: &View, known: &KnownAnswers) -> bool {
        is_product(&self.plan, known, &self.bought, view, self.wanted)
    }

    /// Goes on to the next finer error on the way to the requested one. Returns true if there is one.
    fn descend(&mut self) -> bool {
        let on = self.accuracy > self.wanted * (1.0 + TWINS);
        if on {
            self.accuracy = next_level(self.accuracy).max(self.wanted);
        }
        on
    }

    /// Adds check points.
    fn check(&mut self) -> bool {
        let pairs = self.afford(CHECKS, 2);
        if pairs == 0 {
            return false;
        }
        let set = self.sets as u64;
        self.sets += 1;
        let points = scattered(&mut self.plan, self.problem.dimensions(), set, pairs);
        self.bought.checks.extend(points);
        true
    }

    /// Returns the number of points far out along the steepest lines, within the budget, if every characteristic has a slope.
    pub(super) fn looks_out(&self, characteristics: usize) -> usize {
        let wanted = if self.plan.varying().is_empty() { 0 } else { 2 * characteristics.min(LINES) };
        let begun = self.wanted(&KnownAnswers::nothing(characteristics)).points.len();
        wanted.min(self.budget.saturating_sub(begun) / 2 * 2)
    }

    /// Chooses two points far out along the steepest line of every characteristic. If the line of its curvature has another direction, two
    /// points along that line are added.
    fn look_out(&mut self, views: &[View]) -> bool {
        for view in views.iter().take(LINES) {
            let steepest: Vec<f64> = (0..self.positions()).map(|j| view.bends.slope(j)).collect();
            let bent: Vec<f64> = (0..self.positions()).map(|j| view.bends.bend(j)).collect();
            let size = |line: &[f64]| line.iter().fold(0.0, |size: f64, part| libm::hypot(size, *part));
            let along = steepest.iter().zip(&bent).map(|(a, b)| a * b).sum::<f64>().abs();
            let apart =
                size(&bent).powi(4) > BENT * view.variance() && along < PARALLEL * size(&steepest) * size(&bent);
            let lines = [(steepest, true), (bent, apart)];
            for (line, _) in lines.into_iter().filter(|(line, wanted)| *wanted && size(line) > 0.0) {
                if self.afford(1, 2) == 0 {
                    continue;
                }
                let size = size(&line);
                let points = [1.0, -1.0].map(|side| {
                    let at = self.plan.varying().iter().zip(&line).map(|(&d, part)| {
                        let dimension = &self.problem.dimensions()[d];
                        let (mean, sigma) = (dimension.mean(), dimension.sigma());
                        let [lower, upper] = dimension.distribution().map_or([mean; 2], |law| law.support());
                        let edge = |edge: f64| mean + WITHIN * (edge - mean);
                        let x = (mean + side * FAR_OUT * part / size * sigma).clamp(edge(lower), edge(upper));
                        (d, self.plan.axis(d).nearest_value(x))
                    });
                    let at: Vec<(usize, f64)> = at.collect();
                    self.plan.point_at(at)
                });
                self.bought.tails.push((view.characteristic, points));
            }
        }
        !self.bought.tails.is_empty()
    }

    /// Chooses two points next to the means, which measure the scatter of the answers.
    fn listen(&mut self) {
        if self.afford(1, 2) == 0 {
            return;
        }
        let signs = self.signs(0, 0);
        let varying = self.plan.varying().to_vec();
        let dimensions = self.problem.dimensions();
        let points = [1.0, -1.0].map(|side| {
            let at = varying.iter().zip(&signs).map(|(&d, sign)| {
                let dimension = &dimensions[d];
                (d, dimension.mean() + side * sign * NEXT_TO * dimension.sigma())
            });
            self.plan.point_at(at.collect::<Vec<_>>())
        });
        // If a mean is so large that no number lies this near to it, the scatter cannot be measured.
        self.bought.noise = points.iter().all(|point| *point != Point::Centre).then_some(points);
    }

    /// Returns the even and the odd part of the residuals, as shares of the variance.
    fn left(&self, view: &View) -> [f64; 2] {
        let Some(check) = &view.check else { return [0.0; 2] };
        if self.plan.inputs().shapes().iter().any(|shape| skewed(&shape.moments)) {
            return [view.share(check.variance); 2];
        }
        [view.share(check.even), view.share(check.odd)]
    }

    /// True if the odd residuals may be slopes that the check points do not show: twelve points show about a third of them.
    fn too_odd(&self, odd: f64) -> bool {
        odd > 4.0 * self.accuracy * self.accuracy
    }

    /// True if the even residuals may be curvatures that the check points do not show, as far as the surrogate is even itself.
    fn too_even(&self, view: &View) -> bool {
        let curved = view.check.as_ref().map_or(0.0, |check| check.curved);
        self.too_odd(self.left(view)[0] * curved)
    }

    /// True if odd residuals are left that belong to no axis, but to the corners of pairs.
    fn twisted(&self, view: &View) -> bool {
        let strong = |j: usize| view.shares[j][0] > 0.01;
        let axes = (0..self.positions()).all(|j| self.refined[j] || !strong(j));
        self.positions() <= DIRECT && axes && self.too_odd(self.left(view)[1])
    }

    /// Refines dimensions to five points if three hide too much.
    fn refine_hidden(&mut self, short: &[&View]) -> bool {
        let mut wanted = vec![false; self.positions()];
        for view in short {
            let [_, odd] = self.left(view);
            if view.truncation() <= self.accuracy / 3.0 && !self.too_odd(odd) {
                continue;
            }
            let mut order: Vec<(f64, usize)> = (0..self.positions())
                .filter(|&j| !self.refined[j])
                .map(|j| (0.5 * view.share(view.hidden[j]), j))
                .collect();
            order.sort_by(|a, b| b.0.total_cmp(&a.0));
            let mut rest: f64 = order.iter().map(|(hidden, _)| hidden).sum();
            for (hidden, j) in order {
                if rest <= 0.3 * self.accuracy {
                    break;
                }
                rest -= hidden;
                wanted[j] = true;
            }
        }
        self.refine(&wanted)
    }

    /// Refines the strongest dimensions with three points to five, if nothing else explains the residuals.
    fn refine_rest(&mut self, short: &[&View]) -> bool {
        let mut wanted = vec![false; self.positions()];
        for view in short {
            let [even, odd] = self.left(view);
            let curved = odd < 0.25 * even;
            // Corners of a kink may show all curvature, so that the axes show none.
            let straight = self.positions() <= DIRECT && view.shares.iter().all(|[_, curved]| *curved < NOTHING);
            let of = usize::from(curved && !straight);
            let strength = |j: usize| if self.refined[j] { 0.0 } else { view.shares[j][of] };
            let strongest = (0..self.positions()).map(strength).fold(0.0, f64::max);
            // Terms that a part hides are not larger than the part.
            if strongest > 0.01 * self.accuracy {
                (0..self.positions()).for_each(|j| wanted[j] |= strength(j) >= 0.3 * strongest);
            }
        }
        self.refine(&wanted)
    }

    fn refine(&mut self, wanted: &[bool]) -> bool {
        let mut found = false;
        for (j, &wanted) in wanted.iter().enumerate() {
            if !wanted || self.refined[j] || self.afford(1, 2) == 0 {
                continue;
            }
            self.refined[j] = true;
            let d = self.plan.varying()[j];
            found |= self.plan.refine(&self.problem.dimensions()[d], d);
        }
        found
    }

    /// Examines interactions if even residuals are left.
    fn examine(&mut self, short: &[&View], known: &KnownAnswers) -> bool {
        let lacking: Vec<&View> = short
            .iter()
            .copied()
            .filter(|view| self.left(view)[0] > 0.5 * self.accuracy || self.too_even(view) || self.twisted(view))
            .collect();
        if lacking.is_empty() || self.positions() < 2 {
            return false;
        }
        if self.positions() <= DIRECT || self.dense {
            let batch = if self.dense { usize::MAX } else { self.positions().max(3) };
            return self.examine_strongest(&lacking, batch);
        }
        self.screen(&lacking, known)
    }

    /// Examines further pairs of few dimensions, if nothing else is left to evaluate.
    fn examine_rest(&mut self, short: &[&View]) -> bool {
        let left = |view: &&View| self.left(view)[0] > PAIRS * self.accuracy;
        let lacking: Vec<&View> = short.iter().copied().filter(left).collect();
        !lacking.is_empty() && self.positions() <= DIRECT && self.examine_strongest(&lacking, self.positions().max(3))
    }

    /// Examines the pairs with the largest product of two shares that are not known yet.
    fn examine_strongest(&mut self, lacking: &[&View], most: usize) -> bool {
        let mut ranked: Vec<(f64, usize, usize)> = Vec::new();
        for j in 0..self.positions() {
            for k in j + 1..self.positions() {
                let score = |view: &&View| {
                    let c = view.characteristic;
                    let open = self.plan.joint(c, j, k) && !self.bought.knows(c, (j, k));
                    open.then(|| view.shares[j][0] * view.shares[k][0])
                };
                if let Some(score) = lacking.iter().filter_map(score).reduce(f64::max) {
                    ranked.push((score, j, k));
                }
            }
        }
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)).then(a.2.cmp(&b.2)));
        let twin = |score: f64| ranked.get(most.wrapping_sub(1)).is_some_and(|last| score >= last.0 * (1.0 - TWINS));
        let together = ranked.iter().take_while(|(score, ..)| twin(*score)).count();
        ranked.truncate(together.max(most));
        let square = |&(_, j, k): &(f64, usize, usize)| {
            lacking.iter().any(|view| view.bends.square(j, k) && self.plan.joint(view.characteristic, j, k))
        };
        if !self.dense && !self.squares && ranked.iter().any(square) {
            // Pairs that were evaluated at two corners get the other two as well.
            self.squares = self.afford(self.bought.direct.len().max(1), 2) >= self.bought.direct.len();
            if self.squares {
                self.plan.use_four_corners();
            }
        }
        let count = self.afford(ranked.len(), if self.squares { 4 } else { 2 });
        let pairs: Vec<(usize, usize)> = ranked.into_iter().take(count).map(|(_, j, k)| (j, k)).collect();
        self.plan.examine(pairs.iter().copied());
        self.bought.direct.extend(pairs);
        self.bought.direct.sort_unstable();
        count > 0
    }

    /// Evaluates probes: the first ones, then more, or every pair instead if that is nearly as cheap.
    fn screen(&mut self, lacking: &[&View], known: &KnownAnswers) -> bool {
        if self.bought.judging.is_empty() {
            // Axes show all effects of one dimension, so that a single point shows interactions of two and of three dimensions.
            self.alone = lacking.iter().all(|view| self.left(view)[1] <= ALONE * self.wanted);
            let judging = self.afford(JUDGING, self.points_of_probe());
            let fitted = if judging < JUDGING { 0 } else { self.afford(FITTED, self.points_of_probe()) };
            self.bought.judging = self.probes(known, 1, 0, judging);
            self.bought.fitted = self.probes(known, 2, 0, fitted);
            return fitted > 0;
        }
        // Half of the error that may be left is reserved for interactions that the screening does not find.
        let unfound = lacking.iter().any(|view| view.unscreened.is_some_and(|left| left > 0.5 * self.accuracy));
        if !unfound {
            return false;
        }
        let (n, m) = (self.positions(), self.bought.fitted.len());
        let most = most(n);
        let more = (m as f64 * GROWTH).ceil() as usize + 1 - m;
        let pairs = n * (n - 1);
        let each = self.points_of_probe();
        let within = self.spent + each * more + pairs <= most;
        let hopeless = m >= (2 * n).max((6 * n).min(pairs / 6)) && lacking.iter().any(|view| self.hopeless(view));
        if within && !hopeless {
            let more = self.afford(more, each);
            let probes = self.probes(known, 2, m, more);
            self.bought.fitted.extend(probes);
            return more > 0;
        }
        if self.remaining() < pairs {
            self.short_of_budget = true;
            return false;
        }
        self.dense = true;
        self.bought.judging.clear();
        self.bought.fitted.clear();
        self.examine_strongest(lacking, usize::MAX)
    }

    fn points_of_probe(&self) -> usize {
        if self.alone { 1 } else { 2 }
    }

    /// True if the fit leaves more than a tenth of the variance of all interactions.
    fn hopeless(&self, view: &View) -> bool {
        let found: f64 = view.products.values().map(|mixed| mixed.value.powi(2)).sum();
        view.unscreened.is_some_and(|left| left > 0.1 * (left + view.share(found)))
    }

    /// Returns the probes of one kind from number `first`.
    fn probes(&self, known: &KnownAnswers, kind: u64, first: usize, count: usize) -> Vec<Probe> {
        let corners = self.plan.corners(known);
        let probe = |index: usize| {
            let signs = self.signs(kind, index);
            let point = |side: &f64| {
                let end = |(ends, sign): (&[Option<(crate::plan::AtNode, f64)>; 2], &f64)| {
                    ends[usize::from(sign * side > 0.0)].map(|(at, _)| at)
                };
                Point::of(&corners.iter().zip(&signs).filter_map(end).collect::<Vec<_>>())
            };
            let points = [1.0, -1.0].iter().take(self.points_of_probe()).map(point).collect();
            Probe { signs, points }
        };
        (first..first + count).map(probe).collect()
    }

    fn signs(&self, kind: u64, index: usize) -> Vec<f64> {
        let mut rng = Xoshiro256PlusPlus::seed_from_u64(KEY ^ (kind << 56) ^ ((index as u64) << 8));
        (0..self.positions()).map(|_| if rng.random() { 1.0 } else { -1.0 }).collect()
    }
}
