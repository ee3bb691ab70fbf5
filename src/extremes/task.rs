//! Search of the extremes of one characteristic.

use std::collections::HashMap;

use crate::assembly::{Bounds, Run};
use crate::extremes::answers::Answers;
use crate::extremes::local_search::Climb;
use crate::extremes::model::{Model, Region};
use crate::extremes::start_points::Starts;
use crate::extremes::zone::{Zone, zones};
use crate::extremes::{Coordinate, Ended, Extreme, Extremes, ExtremesProof, Place, proof};
use crate::method::Outcome;
use crate::plan::Point;
use crate::problem::Problem;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::Distribution;
use sensitol_numeric::parallel::join;

/// Greatest error of a surrogate that has predicted a value, as a part of the range of the values.
const FORETOLD: f64 = 1e-9;
/// Searches of either side: from the best point, and from the best other start.
const CLIMBS: usize = 2;
/// Greatest distance of a start's value from the best for which a search from it is worthwhile, as a part of the range.
const STRONG: f64 = 0.5;

/// Greatest distance of a bound beyond an extreme for a proof, as a part of the range.
const PROVEN: f64 = 1e-9;
/// Allowance for rounding in the same distance, as a part of the size of the values.
const ROUNDING: f64 = 1e-12;
/// Boxes of either side for up to `FEW` dimensions.
const BOXES: usize = 20_000;
/// Boxes of either side if a proof is not requested: a twentieth of those of a search.
const ENCLOSING: usize = 1000;
/// Dimensions beyond which fewer boxes are examined, in inverse proportion: each box then takes more operations.
const FEW: usize = 10;
/// Factor of the number of boxes if there are zones. Their edges need more boxes, whose number grows with the root of
/// the accuracy.
const ROUND: usize = 4;
/// Accuracy of a proof without a search, as a part of the distance that is near enough. Printed bounds are then right
/// to the last digit.
const CLOSED: f64 = 1e-3;

/// Search of one characteristic: its box, zones, surrogate and starts.
pub(super) struct Task {
    characteristic: usize,
    /// Dimensions that vary and on which the characteristic can depend.
    dimensions: Vec<usize>,
    /// Values of all dimensions at the centre. The other dimensions stay there.
    centre: Vec<f64>,
    region: Region,
    /// Zones that some of the dimensions share.
    zones: Vec<Zone>,
    surrogate: Model,
    /// Value of the characteristic at the base of the surrogate.
    base: Option<f64>,
    pub(super) starts: Starts,
}

impl Task {
    pub(super) fn of(problem: &Problem, outcome: &Outcome, c: usize) -> Self {
        let (plan, fitted) = (&outcome.plan, &outcome.fitted[c]);
        let band = |d: usize| band(&problem.dimensions()[d]);
        let matters = |&d: &usize| plan.depends(c, d) && band(d)[0] < band(d)[1];
        let dimensions: Vec<usize> = plan.varying().iter().copied().filter(matters).collect();
        let mut region = Region {
            lower: dimensions.iter().map(|&d| band(d)[0]).collect(),
            upper: dimensions.iter().map(|&d| band(d)[1]).collect(),
        };
        let zones = zones(problem, &dimensions, &mut region);
        let places: HashMap<usize, usize> = dimensions.iter().enumerate().map(|(place, &d)| (d, place)).collect();
        let place = |position: usize| places.get(&plan.varying()[position]).copied();
        let mut products = vec![Vec::new(); dimensions.len()];
        for (&(j, k), mixed) in outcome.pairs.iter().zip(&fitted.mixed) {
            if let (Some(j), Some(k), Some(mixed)) = (place(j), place(k), mixed.filter(|mixed| mixed.value != 0.0)) {
                products[j].push((k, mixed.value));
                products[k].push((j, mixed.value));
            }
        }
        let part = |&d: &usize| fitted.parts[d].map_or([0.0; 4], |part| part.coefficients());
        let centre = plan.centre();
        let surrogate = Model {
            base: dimensions.iter().map(|&d| centre[d]).collect(),
            scale: dimensions.iter().map(|&d| plan.axis(d).scale).collect(),
            parts: dimensions.iter().map(part).collect(),
            products,
        };
        let starts = Starts::of(&surrogate, &region);
        Self { characteristic: c, dimensions, centre, region, zones, surrogate, base: fitted.centre, starts }
    }

    /// Point with all dimensions. A place outside a zone is moved to the edge in its direction, or to the nearest row,
    /// so that the box covers the zone.
    pub(super) fn point(&self, x: &[f64]) -> Vec<f64> {
        let mut own = x.to_vec();
        self.zones.iter().for_each(|zone| zone.enter(&mut own, 0.0));
        let mut point = self.centre.clone();
        self.dimensions.iter().zip(own).for_each(|(&d, x)| point[d] = x);
        point
    }

    /// True if the point lies in all zones, within rounding.
    fn within_zones(&self, x: &[f64]) -> bool {
        self.zones.iter().all(|zone| zone.contains(x))
    }

    fn own(&self, point: &[f64]) -> Vec<f64> {
        self.dimensions.iter().map(|&d| point[d]).collect()
    }

    pub(super) fn value(&self, answers: &Answers<'_>, x: &[f64]) -> Option<f64> {
        answers.value(&self.point(x), self.characteristic)
    }

    fn known<'a>(&'a self, answers: &'a Answers<'_>) -> impl Iterator<Item = (Vec<f64>, f64)> + 'a {
        (answers.known())
            .filter(|(_, values)| !values[self.characteristic].is_nan())
            .map(|(point, values)| (self.own(point), values[self.characteristic]))
            .filter(|(x, _)| self.region.contains(x) && self.within_zones(x))
    }

    /// Greatest known value minus the least.
    pub(super) fn range(&self, answers: &Answers<'_>) -> f64 {
        let [least, greatest] = self
            .known(answers)
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], (_, y)| [least.min(y), greatest.max(y)]);
        (greatest - least).max(0.0)
    }

    /// Adds the values that the method has evaluated: the points on the axes, and the points of the least and the
    /// greatest value within the box.
    pub(super) fn learn_from(&self, answers: &mut Answers<'_>, outcome: &Outcome) {
        let (plan, known) = (&outcome.plan, &outcome.evaluated.known);
        let within = |point: &Point| {
            point.at().iter().all(|at| {
                let x = plan.axis(at.dimension as usize).nodes[at.node as usize].x;
                let own = self.dimensions.iter().position(|&d| d == at.dimension as usize);
                own.is_none_or(|own| self.region.lower[own] <= x && x <= self.region.upper[own])
            })
        };
        let value = |point: &&Point| known.value(point, self.characteristic);
        let inside = || known.points().iter().filter(|point| value(point).is_some() && within(point));
        let by_value = |a: &&Point, b: &&Point| value(a).partial_cmp(&value(b)).unwrap_or(std::cmp::Ordering::Equal);
        let extremes = [inside().min_by(by_value), inside().max_by(by_value)];
        let axes = known.points().iter().filter(|point| point.at().len() <= 1);
        for point in axes.chain(extremes.into_iter().flatten()) {
            let mut x = self.centre.clone();
            for at in point.at() {
                x[at.dimension as usize] = plan.axis(at.dimension as usize).nodes[at.node as usize].x;
            }
            let values = (0..known.characteristics()).map(|c| known.value(point, c).unwrap_or(f64::NAN)).collect();
            answers.learn(&x, values);
        }
    }

    /// True if the surrogate has predicted the value of every start, within `FORETOLD` and rounding.
    pub(super) fn foretold(&self, answers: &Answers<'_>) -> bool {
        let Some(base) = self.base else { return false };
        let rounding = 16.0 * f64::EPSILON * self.region.len() as f64 * base.abs();
        let allowed = FORETOLD * self.range(answers) + rounding;
        let right = |x: &Vec<f64>| {
            self.value(answers, x).is_some_and(|value| (value - base - self.surrogate.rise(x)).abs() <= allowed)
        };
        self.starts.points().all(right)
    }

    /// Searches from the best known point and from the best other start of one side. `sign` 1 searches the least value,
    /// -1 the greatest.
    pub(super) fn climbs(&self, answers: &Answers<'_>, sign: f64) -> Vec<Climb<'_>> {
        let signed = |(x, y): (Vec<f64>, f64)| (x, sign * y);
        let Some((best, y)) = self.known(answers).map(signed).min_by(|a, b| a.1.total_cmp(&b.1)) else {
            return Vec::new();
        };
        let starts = if sign > 0.0 { &self.starts.least } else { &self.starts.greatest };
        let strong = y + STRONG * self.range(answers);
        let mut others: Vec<(Vec<f64>, f64)> = (starts.iter())
            .filter(|x| **x != best)
            .filter_map(|x| Some((x.clone(), sign * self.value(answers, x)?)))
            .filter(|&(_, y)| y <= strong)
            .collect();
        others.sort_by(|a, b| a.1.total_cmp(&b.1));
        let from = std::iter::once((best, y)).chain(others).take(CLIMBS);
        from.map(|(x, y)| Climb::new(&self.region, &self.surrogate, x, y)).collect()
    }

    /// Bounds the function over a part of the box by interval arithmetic. Returns None if the function has no bounds.
    fn bounds(&self, problem: &Problem, region: &[[f64; 2]]) -> Option<Bounds> {
        let mut all: Vec<[f64; 2]> = self.centre.iter().map(|&x| [x, x]).collect();
        self.dimensions.iter().zip(region).for_each(|(&d, &band)| all[d] = band);
        let mut bounds = problem.function().bounds(problem.outputs()[self.characteristic], &all)?;
        bounds.slopes = self.dimensions.iter().map(|&d| bounds.slopes[d]).collect();
        Some(bounds)
    }

    /// Bounds the function over a part of the box, or its negative if `sign` is -1. The bounds of the whole box are
    /// computed once and passed in.
    fn signed(
        &self,
        problem: &Problem,
        (region, whole): (&[[f64; 2]], &Bounds),
        part: &[[f64; 2]],
        sign: f64,
    ) -> Bounds {
        let of_part = || self.bounds(problem, part).expect("a function has bounds everywhere or nowhere");
        let bounds = if part == region { whole.clone() } else { of_part() };
        if sign > 0.0 { bounds } else { bounds.negated() }
    }

    /// Ends of the whole box.
    fn bands(&self) -> Vec<[f64; 2]> {
        (0..self.region.len()).map(|d| [self.region.lower[d], self.region.upper[d]]).collect()
    }

    /// Bounds both extremes by interval arithmetic alone, without any value of the model, as closely as boxes allow.
    /// They are proven if values within `near` of both exist. Returns None if the function has no bounds.
    pub(super) fn enclose(&self, problem: &Problem, near: f64, run: &Run<'_>) -> Option<ExtremesProof> {
        let region = self.bands();
        let whole = self.bounds(problem, &region)?;
        let round = if self.zones.is_empty() { 1 } else { ROUND };
        let limit = round * ENCLOSING * FEW / region.len().max(FEW);
        let side = |sign: f64| {
            let bounds = |part: &[[f64; 2]]| self.signed(problem, (&region, &whole), part, sign);
            proof::least(&bounds, &region, &self.zones, f64::INFINITY, CLOSED * near, limit, &|| run.stopped())
        };
        let (below, above) = join(|| side(1.0), || side(-1.0));
        let slack = [&below, &above].map(|least| (least.best - least.lower).max(0.0));
        Some(ExtremesProof {
            bounds: [below.lower, -above.lower],
            proven: slack.iter().all(|&slack| slack <= near),
            slack,
            boxes: below.boxes + above.boxes,
        })
    }

    /// Bounds both extremes by interval arithmetic, if the function has bounds. Also returns points beyond the known
    /// extremes, if it finds any.
    pub(super) fn prove(
        &self,
        problem: &Problem,
        answers: &Answers<'_>,
        run: &Run<'_>,
    ) -> (Option<ExtremesProof>, Vec<Vec<f64>>) {
        let region = self.bands();
        let values = self.known(answers).map(|(_, value)| value);
        let [least, greatest] =
            values.fold([f64::INFINITY, f64::NEG_INFINITY], |[least, greatest], y| [least.min(y), greatest.max(y)]);
        let known = !answers.evaluator.summary().unfinished() && least <= greatest;
        let Some(whole) = known.then(|| self.bounds(problem, &region)).flatten() else { return (None, Vec::new()) };
        let allowed = PROVEN * (greatest - least) + ROUNDING * least.abs().max(greatest.abs());
        let round = if self.zones.is_empty() { 1 } else { ROUND };
        let limit = round * BOXES * FEW / self.region.len().max(FEW);
        let side = |sign: f64, best: f64| {
            let bounds = |part: &[[f64; 2]]| self.signed(problem, (&region, &whole), part, sign);
            proof::least(&bounds, &region, &self.zones, sign * best, allowed, limit, &|| run.stopped())
        };
        let (below, above) = join(|| side(1.0, least), || side(-1.0, greatest));
        let bounds = [below.lower.min(least), (-above.lower).max(greatest)];
        let proof = ExtremesProof {
            bounds,
            proven: below.lower >= least - allowed && -above.lower <= greatest + allowed,
            slack: [least - bounds[0], bounds[1] - greatest],
            boxes: below.boxes + above.boxes,
        };
        (Some(proof), below.better.into_iter().chain(above.better).collect())
    }

    /// Returns the least and the greatest known value, with the proof.
    pub(super) fn result(
        &self,
        problem: &Problem,
        answers: &Answers<'_>,
        asked: usize,
        proof: Option<ExtremesProof>,
    ) -> Option<Extremes> {
        let least = self.known(answers).min_by(|a, b| a.1.total_cmp(&b.1))?;
        let greatest = self.known(answers).max_by(|a, b| a.1.total_cmp(&b.1))?;
        let failures = &answers.failures[self.characteristic];
        Some(Extremes {
            least: self.extreme(problem, least),
            greatest: self.extreme(problem, greatest),
            evaluations: asked,
            failed: failures.count,
            failure: failures.first.as_ref().map(ToString::to_string),
            ended: match answers.evaluator.stopped() {
                Some(reason) if reason.leaves_points_open() => Ended::Stopped,
                Some(_) => Ended::Budget,
                None => Ended::Converged,
            },
            proof,
        })
    }

    fn extreme(&self, problem: &Problem, (x, value): (Vec<f64>, f64)) -> Extreme {
        let coordinate = |(j, &x): (usize, &f64)| Coordinate {
            dimension: problem.dimensions()[self.dimensions[j]].name().to_owned(),
            x,
            band: [self.region.lower[j], self.region.upper[j]],
            place: match x {
                x if x == self.region.lower[j] => Place::Lower,
                x if x == self.region.upper[j] => Place::Upper,
                _ => Place::Interior,
            },
        };
        Extreme { value, at: x.iter().enumerate().map(coordinate).collect() }
    }
}

/// Interval of a dimension's possible values. Without a tolerance it ends at the support of the distribution, because
/// nothing can lie beyond it.
fn band(dimension: &Dimension) -> [f64; 2] {
    let [lower, upper] = dimension.reach().map(|reach| dimension.nominal() + reach);
    let [least, greatest] = dimension.distribution().map_or([f64::NEG_INFINITY, f64::INFINITY], Distribution::support);
    match dimension.tolerance() {
        Some(_) => [lower, upper],
        None => [lower.max(least), upper.min(greatest)],
    }
}
