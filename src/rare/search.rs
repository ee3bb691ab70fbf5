//! Points drawn and weighted in stages.

use crate::estimate::Columns;
use crate::estimate::strata::dot;
use crate::problem::Problem;
use crate::rare::design_point::{FAINT, Place, unit};
use crate::rare::estimate::{ProbabilityEstimate, Weighed, best_parts};
use crate::rare::exploration::Explored;
use crate::rare::mixture::Mixture;
use crate::rare::model::{Answers, Model};
use crate::rare::plain_points::{PlainPoints, SurrogateShare};
use crate::rare::target::Target;
use crate::rare::unmet::Group;
use crate::rare::yield_estimate::within;
use crate::rare::{Beyond, DesignPoint, RareCharacteristic, correct, limit_point as border};
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::sampling::Estimate;

/// Greatest number of rejects that are kept to choose the parts of the components.
const GUIDES: usize = 2000;
/// Smallest number of rejects that show the place of the others.
const FEW: usize = 8;
/// Part of the components' first shares that is kept in every stage.
const KEPT: f64 = 0.25;

/// Greatest number of half-spaces of a target.
const HALF_SPACES: usize = 10;
/// Greatest ratio of a reject's weight to the probability for which the reject needs no place of its own.
const DENSE: f64 = 30.0;
/// Greatest number of steps from a surrogate's place.
const TURNS: usize = 3;
/// Distance beyond the place at which these steps begin, in sigmas.
const BESIDE: f64 = 3e-3;
/// Cosine above which two directions count as the same.
const ALIKE: f64 = 0.97;
/// Part of a sum that rejects outside all places may bear. Beyond it the earlier stages are dropped.
const STRAYED: f64 = 0.05;
/// Least part of a component without a place, relative to its first.
const WATCHING: f64 = 0.5;
/// Number of effective points below which weights are degenerate in many variables: the few heavy points decide, and
/// the interval does not show it.
const DEGENERATE: f64 = 8.0;
/// Number of variables above which places are judged after the first stage, because points drawn there seldom matter.
const MANY_VARIABLES: usize = 30;

/// Points drawn and evaluated so far, and the mixture for the next ones.
pub(super) struct Search<'a> {
    targets: &'a [Target<'a>],
    mixture: Mixture<'a>,
    weighed: Vec<Weighed>,
    /// Weighted points of assemblies beyond any limit. None for fewer than two characteristics with limits, and if the
    /// means lie beyond a limit.
    joint: Option<Weighed>,
    /// Points of the inputs' own density, counted for every target.
    plain: Vec<PlainPoints>,
    /// Points of the inputs' own density, counted for assemblies beyond any limit.
    plain_joint: PlainPoints,
    /// True for each target whose plain points give the narrower interval.
    falls_back: Vec<bool>,
    seed: u64,
    /// Some rejects for every target: the logarithms of their weights, and their normal variables.
    guides: Vec<Vec<(f64, Vec<f64>)>>,
    pub(super) points: u64,
    pub(super) stages: u64,
    /// Expected number of points in all.
    expected: u64,
}

/// Points of one stage. The components take turns, so that every first part of the stage has the same shares.
struct Drawn {
    /// Component of every point.
    from: Vec<usize>,
    normals: Columns,
    /// Natural logarithms of the heights of all components at every point.
    heights: Vec<Vec<f64>>,
}

impl<'a> Search<'a> {
    /// Search with an expected number of points.
    pub(super) fn new(targets: &'a [Target<'a>], places: Vec<Place>, (expected, seed): (u64, u64)) -> Self {
        let mixture = Mixture::new(targets, places, expected);
        let (weighed, guides) = (vec![Weighed::default(); targets.len()], vec![Vec::new(); targets.len()]);
        let mut characteristics: Vec<usize> = targets.iter().map(|target| target.characteristic).collect();
        characteristics.dedup();
        let several = characteristics.len() > 1 && !targets.iter().any(|target| target.kept);
        let joint = several.then(Weighed::default);
        Self {
            targets,
            mixture,
            weighed,
            joint,
            plain: vec![PlainPoints::default(); targets.len()],
            plain_joint: PlainPoints::default(),
            falls_back: vec![false; targets.len()],
            seed,
            guides,
            points: 0,
            stages: 0,
            expected,
        }
    }

    /// True for each target with a place at which its limit is crossed.
    pub(super) fn reached(&self) -> Vec<bool> {
        let places = self.mixture.places();
        let crossed = |target: usize| places.iter().any(|place| place.target == target && place.crossed());
        (0..self.targets.len()).map(crossed).collect()
    }

    /// Adds half-spaces beside explored rejects that the surrogate's components do not cover. Keeps bounds for targets
    /// without a reject.
    pub(super) fn learn(&mut self, explored: &Explored, budget: usize, model: &mut Model<'_>) {
        let mut found = Vec::new();
        let each = budget / self.targets.len().max(1);
        for (index, target) in self.targets.iter().enumerate() {
            self.plain[index] = explored.plain(target);
            let guards = self.guards(index, each, model);
            self.take(guards);
            found.extend(self.half_spaces(index, &explored.rejects(target), each, model));
        }
        self.take(found);
        let weights = self.mixture.place_weights(explored.normals());
        for (index, target) in self.targets.iter().enumerate() {
            let mine = |place: &&Place| place.target == index && place.crossed();
            let places: Vec<&Place> = self.mixture.places().iter().filter(mine).collect();
            let probability: f64 = places.iter().map(|place| place.probability()).sum();
            let dense: Vec<bool> = weights.iter().map(|&weight| weight <= libm::log(DENSE * probability)).collect();
            self.weighed[index].bound(explored.unmet(target, &places, &dense));
        }
    }

    /// Adds places for rejects of a target, the nearest to the means first, within a budget of evaluations.
    pub(super) fn place(&mut self, index: usize, rejects: &[Vec<f64>], budget: usize, model: &mut Model<'_>) {
        let found = self.half_spaces(index, rejects, budget, model);
        self.take(found);
    }

    /// Half-spaces in case the surrogate is wrong about the limit.
    ///
    /// One is at the surrogate's nearest place, in case the limit continues otherwise. The other is at the point to
    /// which the model leads from it, in case the surrogate gave a wrong direction.
    fn guards(&self, index: usize, budget: usize, model: &mut Model<'_>) -> Vec<Place> {
        let mine = self.mixture.places().iter().filter(|place| place.target == index && place.crossed());
        let Some(place) = mine.min_by(|a, b| a.distance.total_cmp(&b.distance)) else { return Vec::new() };
        // A little beyond, because the place itself may have been evaluated on the way to it.
        let point: Vec<f64> = place.direction.iter().map(|part| part * (place.distance + BESIDE)).collect();
        let steps = budget / border::step_cost(model.space.len());
        let turned = border::stepped(&self.targets[index], &point, steps.min(TURNS), model);
        let turned = turned.and_then(|point| Place::half_space(index, &point));
        let turned = turned.filter(|turned| dot(&turned.direction, &place.direction) < ALIKE);
        Place::half_space(index, &point).into_iter().chain(turned).collect()
    }

    /// Half-spaces for rejects, sorted with the nearest to the means first, within a budget of evaluations.
    fn half_spaces(&self, index: usize, rejects: &[Vec<f64>], budget: usize, model: &mut Model<'_>) -> Vec<Place> {
        let (target, allowed) = (&self.targets[index], model.answered + budget as u64);
        let mine = || self.mixture.places().iter().filter(|place| place.target == index && place.crossed());
        let held = |found: &[Place], point: &[f64]| {
            mine().any(|place| place.holds(point)) || found.iter().any(|place| place.holds(point))
        };
        let room = HALF_SPACES.saturating_sub(mine().filter(|place| place.is_shown()).count());
        let mut probability: f64 = mine().map(Place::probability).sum();
        let columns = (0..model.space.len()).map(|j| rejects.iter().map(|point| point[j]).collect()).collect();
        let weights = self.mixture.place_weights(&columns);
        let [cost, corner_cost] = [border::cost, border::corner_cost].map(|cost| cost(model.space.len()) as u64);
        let mut found: Vec<Place> = Vec::new();
        for (reject, weight) in rejects.iter().zip(weights) {
            let known =
                self.weighed[index].found().and_then(|found| found.probability).map_or(0.0, |known| known.value);
            let dense = weight <= libm::log(DENSE * probability.max(known));
            if dense || held(&found, reject) {
                continue;
            }
            if found.len() >= room || model.answered + corner_cost > allowed {
                break;
            }
            let point = border::bisected(target, reject, model);
            if held(&found, &point) {
                continue;
            }
            let steps = if model.answered + cost <= allowed { border::STEPS } else { 0 };
            let place = self.shown(index, point, steps, model);
            // A place that is a thousand times less likely adds nothing. The border on the way to a wide point says
            // little about that, because in many variables it lies far beyond the likeliest point.
            let place = place.filter(|place| place.probability() >= FAINT * probability);
            probability += place.as_ref().map_or(0.0, Place::probability);
            found.extend(place);
        }
        found
    }

    /// Place of the rejects near a point of the limit. A smooth limit has slopes that lead to its likeliest point. A
    /// jump or a kink has a corner.
    fn shown(&self, index: usize, point: Vec<f64>, steps: usize, model: &mut Model<'_>) -> Option<Place> {
        let target = &self.targets[index];
        if let Some(nearest) = border::stepped(target, &point, steps, model) {
            return Place::half_space(index, &nearest);
        }
        match border::corner(target, point.clone(), model) {
            Some(corner) => Place::corner(index, &corner),
            None => Place::half_space(index, &point),
        }
    }

    fn take(&mut self, more: Vec<Place>) {
        if !more.is_empty() {
            let places = self.mixture.places().iter().cloned().chain(more).collect();
            self.mixture = Mixture::new(self.targets, places, self.expected);
        }
    }

    /// Draws and weights a stage of points. Returns true if some of them were not answered.
    pub(super) fn stage(&mut self, points: usize, model: &mut Model<'_>) -> bool {
        let drawn = self.draw(points, mixed_seed(self.seed, self.stages));
        self.stages += 1;
        let answers = model.ask(&drawn.normals);
        self.weigh(&drawn, &answers);
        (0..points).any(|row| !answers.answered(row))
    }

    /// True if there are so many variables that places are judged after the first stage.
    pub(super) fn has_many_variables(&self) -> bool {
        self.targets.first().is_some_and(|target| target.space.len() > MANY_VARIABLES)
    }

    /// Switches a target to plain points if its interval is wider than that of a plain sample of as many points as were
    /// evaluated.
    ///
    /// Only many variables hide the places. With few variables wide intervals are caution, and places are found.
    pub(super) fn judge(&mut self, evaluated: u64) {
        if !self.has_many_variables() {
            return;
        }
        for (falls_back, weighed) in self.falls_back.iter_mut().zip(&self.weighed) {
            let Some(found) = weighed.found() else { continue };
            let value = found.probability.map_or(0.0, |probability| probability.value);
            *falls_back |= found.interval[1] - found.interval[0] > PlainPoints::width(evaluated as f64, value)
                || found.effective < DEGENERATE;
        }
    }

    /// True if only plain points are drawn.
    pub(super) fn is_plain(&self) -> bool {
        !self.falls_back.is_empty() && self.falls_back.iter().all(|&falls_back| falls_back)
    }

    /// Estimate of a target, from plain points if it has switched to them. Plain points are used without the surrogate
    /// here, because its share takes a while.
    fn found(&self, index: usize) -> Option<ProbabilityEstimate> {
        match self.falls_back[index] {
            true => self.plain[index].found(None),
            false => self.weighed[index].found(),
        }
    }

    /// Final estimates of all targets. Plain points use the surrogate as control variate.
    fn conclusions(&self) -> Vec<Option<ProbabilityEstimate>> {
        let beside = |index: usize| SurrogateShare::of(&self.targets[index], !self.seed);
        let conclusion = |index: usize| match self.falls_back[index] {
            true => self.plain[index].found(Some(beside(index))),
            false => self.weighed[index].found(),
        };
        (0..self.targets.len()).map(conclusion).collect()
    }

    /// Adds a place for every target whose rejects lie on average in a direction without one, and half-spaces for
    /// rejects outside all places.
    ///
    /// If such rejects bear much of the sum, the sum begins anew. The next stages are unbiased however their places
    /// were found, and the earlier ones did not draw where it matters.
    pub(super) fn follow(&mut self, budget: usize, model: &mut Model<'_>) {
        let mut places = self.mixture.places().to_vec();
        let before = places.len();
        for (index, guides) in self.guides.iter().enumerate().filter(|(_, guides)| guides.len() >= FEW) {
            let mut middle = vec![0.0; model.space.len()];
            let greatest = guides.iter().map(|guide| guide.0).fold(f64::NEG_INFINITY, f64::max);
            for (weight, normals) in guides {
                middle.iter_mut().zip(normals).for_each(|(sum, z)| *sum += libm::exp(weight - greatest) * z);
            }
            let Some(direction) = unit(middle) else { continue };
            let near = |place: &&Place| place.target == index && dot(&place.direction, &direction) > ALIKE;
            if !places.iter().any(|place| near(&place)) {
                places.push(Place::uncrossed(index, direction));
            }
        }
        let added = correct(places.split_off(before), self.targets, budget, model);
        places.extend(added.into_iter().filter(|place| place.crossed()));
        if places.len() > before {
            self.mixture = Mixture::new(self.targets, places, self.expected);
        }
        let mut found = Vec::new();
        for index in 0..self.targets.len() {
            let mut strayed: Vec<&Vec<f64>> = self.strayed(index);
            strayed.sort_by(|a, b| dot(a, a).total_cmp(&dot(b, b)));
            let strayed: Vec<Vec<f64>> = strayed.into_iter().cloned().collect();
            found.push(self.half_spaces(index, &strayed, budget / self.targets.len(), model));
        }
        for (index, places) in found.iter().enumerate().filter(|(_, places)| !places.is_empty()) {
            let part = |guide: &&(f64, Vec<f64>)| places.iter().any(|place| place.holds(&guide.1));
            let logarithms = self.guides[index].iter().filter(part).map(|guide| guide.0);
            if self.weighed[index].part(logarithms) > STRAYED {
                self.weighed[index].forget();
                self.joint.iter_mut().for_each(Weighed::forget);
            }
        }
        self.take(found.into_iter().flatten().collect());
    }

    /// Rejects drawn so far that lie outside all places.
    fn strayed(&self, index: usize) -> Vec<&Vec<f64>> {
        let held =
            |point: &Vec<f64>| self.mixture.places().iter().any(|place| place.target == index && place.holds(point));
        self.guides[index].iter().map(|guide| &guide.1).filter(|point| !held(point)).collect()
    }

    /// Shares of the components in the next points: the first shares, or those that fit the rejects found so far.
    fn parts(&self) -> Vec<f64> {
        let first = &self.mixture.parts;
        let mut parts = vec![0.0; first.len()];
        let plain: Vec<f64> = (0..first.len()).map(|component| f64::from(u8::from(component == 0))).collect();
        if self.is_plain() {
            return plain;
        }
        for (guides, &falls_back) in self.guides.iter().zip(&self.falls_back) {
            let best = match falls_back {
                true => plain.clone(),
                false if guides.len() < FEW => first.clone(),
                false => best_parts(&self.heights(guides), first),
            };
            parts.iter_mut().zip(best).for_each(|(part, best)| *part += best / self.guides.len() as f64);
        }
        let mut parts: Vec<f64> =
            parts.iter().zip(first).map(|(part, first)| (1.0 - KEPT) * part + KEPT * first).collect();
        for (part, first) in parts.iter_mut().zip(first).take(self.mixture.without_place()) {
            *part = part.max(WATCHING * first);
        }
        let total: f64 = parts.iter().sum();
        parts.into_iter().map(|part| part / total).collect()
    }

    /// Weights of the rejects with the heights of all components at them, all as logarithms.
    fn heights(&self, guides: &[(f64, Vec<f64>)]) -> Vec<(f64, Vec<f64>)> {
        let dimensions = guides.first().map_or(0, |guide| guide.1.len());
        let columns = (0..dimensions).map(|j| guides.iter().map(|guide| guide.1[j]).collect()).collect();
        guides.iter().map(|guide| guide.0).zip(self.mixture.heights(&columns)).collect()
    }

    fn draw(&self, points: usize, seed: u64) -> Drawn {
        let counts = shared_out(points, &self.parts());
        let mut order: Vec<(f64, usize)> = Vec::with_capacity(points);
        for (component, &count) in counts.iter().enumerate() {
            order.extend((0..count).map(|i| ((i as f64 + 0.5) / count as f64, component)));
        }
        let mut rows: Vec<usize> = (0..points).collect();
        rows.sort_by(|&a, &b| order[a].0.total_cmp(&order[b].0).then(a.cmp(&b)));
        let drawn = self.mixture.draw(&counts, seed);
        let normals = drawn.iter().map(|column| rows.iter().map(|&row| column[row]).collect()).collect();
        let heights = self.mixture.heights(&normals);
        Drawn { from: rows.iter().map(|&row| order[row].1).collect(), normals, heights }
    }

    /// Adds the answered points to all sums.
    ///
    /// Weights use the number of points that were answered. That is unbiased, because a point is answered or not
    /// independently of its value.
    fn weigh(&mut self, drawn: &Drawn, answers: &Answers) {
        let rows: Vec<usize> = (0..drawn.from.len()).filter(|&row| answers.answered(row)).collect();
        let mut counts = vec![0.0; self.mixture.len()];
        rows.iter().for_each(|&row| counts[drawn.from[row]] += 1.0);
        let total = rows.len() as f64;
        let weight = |&row: &usize| {
            let heights = &drawn.heights[row];
            let highest = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            let sum: f64 = counts.iter().zip(heights).map(|(count, height)| count * libm::exp(height - highest)).sum();
            libm::log(total) - highest - libm::log(sum)
        };
        let weights: Vec<f64> = rows.iter().map(weight).collect();
        self.points += rows.len() as u64;
        let plain: Vec<usize> = rows.iter().copied().filter(|&row| drawn.from[row] == 0).collect();
        let normals: Columns =
            drawn.normals.iter().map(|column| plain.iter().map(|&row| column[row]).collect()).collect();
        for (target, counted) in self.targets.iter().zip(&mut self.plain) {
            for (&row, margin) in plain.iter().zip(target.margins(&normals)) {
                let sought = answers.value(row, target.characteristic).map(|value| target.sought(value));
                counted.add(sought, margin > 0.0);
            }
        }
        if let Some(joint) = &mut self.joint {
            // One broken limit makes a reject, even if other values are unknown.
            let beyond = |row: usize| {
                let each =
                    |target: &Target<'_>| answers.value(row, target.characteristic).map(|value| target.sought(value));
                let all: Vec<Option<bool>> = self.targets.iter().map(each).collect();
                if all.contains(&Some(true)) { Some(true) } else { all.iter().all(Option::is_some).then_some(false) }
            };
            plain.iter().for_each(|&row| self.plain_joint.add(beyond(row), false));
            let points = rows.iter().zip(&weights).map(|(&row, &weight)| (drawn.from[row], weight, beyond(row)));
            joint.add(self.mixture.len(), &points.collect::<Vec<_>>());
        }
        for (target, (weighed, guides)) in self.targets.iter().zip(self.weighed.iter_mut().zip(&mut self.guides)) {
            let beyond = |row: usize| answers.value(row, target.characteristic).map(|value| target.sought(value));
            let points = rows.iter().zip(&weights).map(|(&row, &weight)| (drawn.from[row], weight, beyond(row)));
            weighed.add(self.mixture.len(), &points.collect::<Vec<_>>());
            for (component, scale) in self.mixture.widths().enumerate() {
                let valued = rows.iter().filter(|&&row| drawn.from[row] == component && beyond(row).is_some());
                weighed.watch(Group { scale, points: valued.count() as u64 });
            }
            let hits = rows.iter().zip(&weights).filter(|&(&row, _)| beyond(row) == Some(true));
            let room = GUIDES.saturating_sub(guides.len());
            guides.extend(
                hits.take(room)
                    .map(|(&row, &weight)| (weight, drawn.normals.iter().map(|column| column[row]).collect())),
            );
        }
    }

    /// Worst standard error relative to its probability.
    pub(super) fn shortfall(&self) -> f64 {
        let relative = |index: usize| {
            let probability = self.found(index).and_then(|found| found.probability);
            probability.map_or(f64::INFINITY, |Estimate { value, standard_error }| {
                standard_error.map_or(f64::INFINITY, |error| error / value)
            })
        };
        (0..self.targets.len()).map(relative).fold(0.0, f64::max)
    }

    /// True if the last stage alone confirms the standard errors of all targets. It is independent of the moment at
    /// which these became small.
    pub(super) fn confirmed(&self, wanted: f64) -> bool {
        // Plain points are independent of each other and need no confirmation.
        let confirmed = self.weighed.iter().zip(&self.falls_back);
        confirmed.into_iter().all(|(weighed, &falls_back)| falls_back || weighed.confirmed(wanted))
    }

    /// Joint yield and its 95 % interval, in which points without a value may all be rejects.
    ///
    /// The yield is None if no point lies beyond any limit.
    pub(super) fn within_all(&self, problem: &Problem) -> Option<(Option<f64>, [f64; 2])> {
        // Every limit has a target, except if its surrogate does not vary.
        let ends = |one: &Characteristic| [one.limits().lower(), one.limits().upper()].iter().flatten().count();
        let limits: usize = problem.characteristics().iter().map(ends).sum();
        let joint = self.joint.as_ref().filter(|_| limits == self.targets.len())?;
        let falls_back = self.falls_back.contains(&true);
        let found = if falls_back { self.plain_joint.found(None)? } else { joint.found()? };
        // Every characteristic may have a region that no point met.
        let unmet = self.weighed.iter().filter_map(|weighed| weighed.unmet()).map(|unmet| unmet.most);
        let unmet = if falls_back { 0.0 } else { unmet.fold(0.0, libm::hypot) };
        let value = found.probability.map_or(0.0, |found| found.value);
        let high = (value + libm::hypot(found.interval[1] - value, unmet)).min(1.0);
        let [low, high] = [found.interval[0], high.max(found.bounds[1])];
        Some((found.probability.map(|found| 1.0 - found.value), [1.0 - high, 1.0 - low]))
    }

    pub(super) fn characteristics(self, model: &Model<'_>, unfinished: bool) -> Vec<RareCharacteristic> {
        let space = model.space;
        let conclusions = self.conclusions();
        let beyond = |c: usize, sign: f64| {
            let same = |target: &Target<'_>| target.characteristic == c && target.side * sign > 0.0;
            let index = self.targets.iter().position(same)?;
            let found = conclusions[index]?;
            let found = if self.targets[index].kept { found.complement() } else { found };
            let mine = self.mixture.places().iter().filter(|place| place.target == index && place.crossed());
            let place = mine.min_by(|a, b| a.distance.total_cmp(&b.distance));
            let design_point = place.map(|place| {
                let normals = place.direction.iter().map(|part| vec![part * place.distance]).collect();
                DesignPoint { distance: place.distance, values: space.points(&normals).row(0) }
            });
            let plain = |Estimate { value, standard_error }: Estimate| {
                let error = standard_error.filter(|&error| error > 0.0)?;
                Some(value * (1.0 - value) / error / error).filter(|samples| samples.is_finite())
            };
            Some(Beyond {
                limit: self.targets[index].given,
                probability: found.probability.map(|of| of.value),
                standard_error: found.probability.and_then(|of| of.standard_error),
                ppm: found.probability.map(|of| 1e6 * of.value),
                interval: found.interval,
                bounds: (model.lost[c].0 > 0).then_some(found.bounds),
                hits: found.hits,
                effective_samples: found.effective,
                greatest_part: found.greatest_part,
                plain_samples: found.probability.and_then(plain),
                design_point,
                unmet: self.weighed[index].unmet().filter(|_| !self.falls_back[index]),
                plain_points: self.falls_back[index].then(|| self.plain[index].count()),
            })
        };
        let characteristic = |(c, characteristic): (usize, &Characteristic)| {
            let (below, above) = (beyond(c, -1.0), beyond(c, 1.0));
            let kept = self.targets.iter().enumerate().find_map(|(index, target)| {
                let mine = target.characteristic == c && target.kept;
                conclusions[index].filter(|_| mine).map(|found| (usize::from(target.side > 0.0), found))
            });
            let within = within(characteristic.limits(), [&below, &above], kept);
            RareCharacteristic {
                characteristic: characteristic.clone(),
                failed: model.lost[c].0,
                error: model.lost[c].1.clone(),
                below,
                above,
                yield_: within.and_then(|within| within.value),
                yield_interval: within.map(|within| within.interval),
                sampling: None,
                unfinished,
            }
        };
        model.problem().characteristics().iter().enumerate().map(characteristic).collect()
    }
}

/// Whole numbers in these proportions that sum to `points`: rounded down, and the largest remainders up.
fn shared_out(points: usize, parts: &[f64]) -> Vec<usize> {
    let mut counts: Vec<usize> = parts.iter().map(|part| (part * points as f64) as usize).collect();
    let mut order: Vec<usize> = (0..parts.len()).collect();
    let rest = |k: usize| parts[k] * points as f64 - counts[k] as f64;
    let rests: Vec<f64> = (0..parts.len()).map(rest).collect();
    order.sort_by(|&a, &b| rests[b].total_cmp(&rests[a]).then(a.cmp(&b)));
    let short = points.saturating_sub(counts.iter().sum());
    order.iter().cycle().take(short).for_each(|&k| counts[k] += 1);
    // The inputs' own density needs a point, because some places could otherwise never be drawn.
    if let Some(most) = (0..counts.len()).max_by_key(|&k| counts[k]).filter(|_| counts[0] == 0) {
        (counts[0], counts[most]) = (1, counts[most] - 1);
    }
    counts
}

fn mixed_seed(seed: u64, stage: u64) -> u64 {
    // Any odd constant keeps stages apart, because the generator mixes its seed.
    seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) ^ (stage + 1).wrapping_mul(0xD1B5_4A32_D192_ED03)
}
