//! Requirements as values that must not exceed 1, with their slopes.
//!
//! ```text
//! worst case       (reach beyond the nominal)/(U - nominal), linear in T where the surface is
//! rss              (R/s)^2 with R the rss and s the slack from the middle of the linear model to the limit
//! Cpk, sigma       (R/s)^2 with R sigma and s the sigma that just keeps the requirement at this mean
//! yield            (sigma/s)^2 with s the sigma at which mean and shape give just that yield, corrected by the surface distribution
//! joint yield      (b*/b)^2 with b the normal score of the reject rate, b* that of the allowed reject rate
//! ```
//!
//! The squares are exact sums of squares of tolerances for a linear characteristic. For any other the slopes are those
//! of the second-order moments at the trial tolerances. Yield, Cpk and sigma are required of the pessimistic end of
//! their intervals at the linearization point: the uncertainty there is added to the requirement.

use std::sync::Arc;

use crate::allocation::cost::cost_curve::Priced;
use crate::allocation::optimise::separable::{Row, Term};
use crate::allocation::surface::pearson_slack::YieldRoom;
use crate::allocation::surface::reject_rate::{of_scores, of_scores_with_slope};
use crate::allocation::surface::response::Responses;
use crate::allocation::surface::surface_slack::Correction;
use crate::allocation::surface::uncertainty::Unknown;
use sensitol_numeric::capability::{self, Capability, Law};
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::requirement::Requirement;

/// Relative difference between sums in another order. Limits that are met to the last digit are kept.
pub(in crate::allocation) const KEPT: f64 = 1e-12;

/// True if a constraint with this value is kept.
pub(in crate::allocation) fn kept(value: f64) -> bool {
    value <= 1.0 + KEPT
}

/// One side of one requirement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::allocation) struct Constraint {
    pub(in crate::allocation) characteristic: usize,
    pub(in crate::allocation) requirement: Requirement,
    limits: SpecLimits,
    side: Side,
    /// Part of the slack that rss and worst case may use.
    pub(in crate::allocation) part: f64,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Below,
    Above,
    Both,
    /// Joint yield of all characteristics with limits.
    Joint,
}

/// Value and slopes of a requirement at some tolerances. It is kept if `value` is at most 1.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct Linearised {
    pub(in crate::allocation) value: f64,
    /// Derivatives of the value by `ln T` of every group.
    pub(in crate::allocation) slopes: Vec<f64>,
    /// True if the value is linear in the tolerances, false if it is quadratic.
    linear: bool,
}

impl Constraint {
    /// Constraints of a requirement, one for each side.
    pub(in crate::allocation) fn of(characteristic: usize, requirement: Requirement, limits: SpecLimits) -> Vec<Self> {
        let one = |side| Self { characteristic, requirement, limits, side, part: 1.0 };
        match requirement {
            Requirement::Yield(_) | Requirement::Sigma(_) => vec![one(Side::Both)],
            _ => {
                let below = limits.lower().map(|_| one(Side::Below));
                below.into_iter().chain(limits.upper().map(|_| one(Side::Above))).collect()
            }
        }
    }

    /// Constraint of the joint yield of all characteristics with limits; `first` is named in messages.
    pub(in crate::allocation) fn joint(first: usize, least: f64, limits: SpecLimits) -> Self {
        let requirement = Requirement::Yield(least);
        Self { characteristic: first, requirement, limits, side: Side::Joint, part: 1.0 }
    }

    /// Constraint with another part of the slack for rss and worst case.
    pub(in crate::allocation) fn taking(self, part: f64) -> Self {
        Self { part, ..self }
    }

    /// True for the side of the upper limit.
    pub(in crate::allocation) fn is_above(&self) -> bool {
        self.side == Side::Above
    }

    /// True for the joint yield.
    pub(in crate::allocation) fn is_joint(&self) -> bool {
        self.side == Side::Joint
    }

    pub(in crate::allocation) fn characteristics(&self, responses: &Responses) -> Vec<usize> {
        if self.is_joint() { responses.limited() } else { vec![self.characteristic] }
    }

    /// Value alone. Infinite if the requirement cannot be kept, or is unknown.
    pub(in crate::allocation) fn value(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> f64 {
        let value = match self.requirement {
            Requirement::WorstCase => self.worst_case(responses, priced, at).map(|found| found.value),
            _ => self.ratio(responses, priced, at).map(|ratio| ratio * ratio),
        };
        value.filter(|value| !value.is_nan()).unwrap_or(f64::INFINITY)
    }

    /// Value and slopes. Returns None if they are unknown.
    pub(in crate::allocation) fn linearised(
        &self,
        responses: &Responses,
        priced: &[Priced],
        at: &[f64],
    ) -> Option<Linearised> {
        if self.requirement == Requirement::WorstCase {
            return self.worst_case(responses, priced, at);
        }
        if self.is_joint() {
            return self.joint_linearised(responses, priced, at);
        }
        let k = self.characteristic;
        let factors = responses.factors(priced, at);
        let (ratio, room) = match self.requirement {
            Requirement::Rss => (self.ratio_at(responses, priced, &factors, None)?, None),
            _ => {
                let moments = responses.moments(k, &factors)?;
                let room = self.room(&moments, self.target(responses))?;
                (self.ratio_in(responses, &moments, &room, &factors)?, Some(room))
            }
        };
        if !ratio.is_finite() {
            return None;
        }
        let value = ratio * ratio;
        if value == 0.0 {
            // Nothing varies here.
            return Some(Linearised { value, slopes: vec![0.0; priced.len()], linear: false });
        }
        let plain = responses.is_plain(k);
        // d ln(ratio) = d ln R - d ln s.
        let slopes = match self.requirement {
            Requirement::Rss => {
                let (square, slopes) = responses.rss_squared(k, priced, &factors)?;
                let room = self.room_about(responses.middle(k, &factors, None)?)?;
                let sign = if self.side == Side::Above { -1.0 } else { 1.0 };
                let moved = responses.middle_slopes(k, priced, &factors)?;
                slopes.iter().zip(moved).map(|(slope, moved)| 0.5 * slope / square - sign * moved / room).collect()
            }
            _ if plain => {
                // Sigma squared is the sum of the groups' squares.
                let (variance, squares) = responses.plain_squares(k, priced, &factors)?;
                squares.iter().map(|square| square / variance).collect()
            }
            _ => self.with_room(responses, priced, &room?, &factors)?,
        };
        let slopes = slopes.into_iter().map(|slope| 2.0 * value * slope).collect::<Vec<f64>>();
        slopes.iter().all(|slope| slope.is_finite()).then_some(Linearised { value, slopes, linear: false })
    }

    /// Slopes of `ln(sigma/s)` by `ln T` of every group.
    fn with_room(&self, responses: &Responses, priced: &[Priced], room: &Room, factors: &[f64]) -> Option<Vec<f64>> {
        let by = responses.moment_slopes(self.characteristic, priced, factors)?;
        let partial = room.slopes()?;
        let of = |by: &[f64; 4]| by[1] - partial[0] * by[0] - partial[1] * by[2] - partial[2] * by[3];
        let correction = self.correction(responses);
        let corrected = |group: &Priced| {
            let slopes = group.members.iter().map(|&d| correction.as_ref().map_or(0.0, |of| of.slope(d, factors)));
            slopes.sum::<f64>()
        };
        Some(by.iter().zip(priced).map(|(by, group)| of(by) - corrected(group)).collect())
    }

    /// Value and slopes of the joint yield.
    fn joint_linearised(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        let rejects = responses.rejects(&responses.limited());
        let Some((share, by)) = rejects.with_slopes(responses, priced, &responses.factors(priced, at)) else {
            return self.joint_by_differences(responses, priced, at);
        };
        let [ratio, by_share] = of_scores_with_slope(share, 1.0 - self.target(responses));
        let slopes: Vec<f64> = by.iter().map(|slope| 2.0 * ratio * by_share * slope).collect();
        let known = ratio.is_finite() && slopes.iter().all(|slope| slope.is_finite());
        known.then(|| Linearised::of_squares(ratio * ratio, slopes))
    }

    /// Value and slopes of the joint yield by differences, if the density of a fit ends too abruptly for formulas.
    fn joint_by_differences(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        /// Half of the difference in `ln T`. Truncation and rounding are both near 1e-9.
        const STEP: f64 = 3e-5;
        let value = self.ratio(responses, priced, at).filter(|ratio| ratio.is_finite())?.powi(2);
        let mut slopes = Vec::with_capacity(priced.len());
        let mut trial = at.to_vec();
        for g in 0..at.len() {
            let mut of = |step: f64| {
                trial[g] = at[g] * libm::exp(step);
                Some(self.ratio(responses, priced, &trial)?.powi(2))
            };
            let (up, down) = (of(STEP)?, of(-STEP)?);
            trial[g] = at[g];
            slopes.push((up - down) / (2.0 * STEP));
        }
        slopes.iter().all(|slope| slope.is_finite()).then(|| Linearised::of_squares(value, slopes))
    }

    /// Value of a worst case: the reach beyond the nominal divided by the slack of the limit.
    fn worst_case(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<Linearised> {
        let above = self.side == Side::Above;
        let nominal = responses.of[self.characteristic].nominal?;
        let room = match self.side {
            Side::Above => self.limits.upper()? - nominal,
            _ => nominal - self.limits.lower()?,
        };
        let (reach, slopes, linear) = match &responses.of[self.characteristic].worst {
            Some(worst) => {
                let (reach, by_dimension) = worst.reach(&responses.factors(priced, at), above);
                let of = |group: &Priced| {
                    by_dimension.iter().filter(|(d, _)| group.members.contains(d)).map(|(_, slope)| slope).sum()
                };
                (reach, priced.iter().map(of).collect(), false)
            }
            None => {
                let (constant, coefficients) = responses.worst_case(self.characteristic, priced, above)?;
                let slopes: Vec<f64> = coefficients.iter().zip(at).map(|(coefficient, t)| coefficient * t).collect();
                (constant + slopes.iter().sum::<f64>(), slopes, true)
            }
        };
        // A nominal value beyond the limit leaves no slack to divide by.
        let scale = if room > 0.0 { room } else { room.abs().max(reach.abs()).max(f64::MIN_POSITIVE) };
        let value = 1.0 + (reach - room * self.part) / scale;
        Some(Linearised { value, slopes: slopes.into_iter().map(|slope| slope / scale).collect(), linear })
    }

    /// Ratio of the variation to its slack.
    fn ratio(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        let factors = responses.factors(priced, at);
        self.ratio_at(responses, priced, &factors, None)
    }

    /// Ratio of the variation to its slack at any factors of all dimensions, with nominals moved by `shifts` sigmas.
    pub(in crate::allocation) fn ratio_at(
        &self,
        responses: &Responses,
        priced: &[Priced],
        factors: &[f64],
        shifts: Option<&[f64]>,
    ) -> Option<f64> {
        if self.is_joint() {
            let share = responses.rejects(&responses.limited()).share(responses, factors, shifts)?;
            return Some(of_scores(share, 1.0 - self.target(responses)));
        }
        if self.requirement == Requirement::Rss {
            let rss = responses.rss_squared(self.characteristic, priced, factors)?.0.sqrt();
            let room = self.room_about(responses.middle(self.characteristic, factors, shifts)?)?;
            return Some(by_room(rss, self.part * room));
        }
        let moments = responses.moments_shifted(self.characteristic, factors, shifts)?;
        self.ratio_in(responses, &moments, &self.room(&moments, self.target(responses))?, factors)
    }

    /// Ratio of sigma to its slack, corrected at these factors.
    fn ratio_in(&self, responses: &Responses, moments: &Moments, room: &Room, factors: &[f64]) -> Option<f64> {
        let factor = self.correction(responses).map_or(1.0, |of| of.factor(factors));
        Some(by_room(moments.sigma(), factor * room.sigma()))
    }

    /// Value with all dimensions at these factors of their tolerances. Infinite if it is unknown.
    pub(in crate::allocation) fn value_at(&self, responses: &Responses, factors: &[f64]) -> f64 {
        let value = match self.requirement {
            Requirement::WorstCase => self.worst_case_at(responses, factors),
            _ => self.ratio_at(responses, &[], factors, None).map(|ratio| ratio * ratio),
        };
        value.filter(|value| !value.is_nan()).unwrap_or(f64::INFINITY)
    }

    fn worst_case_at(&self, responses: &Responses, factors: &[f64]) -> Option<f64> {
        let all: Vec<Priced> = responses.every_dimension();
        let at: Vec<f64> = (all.iter())
            .map(|group| factors[group.members[0]] * responses.dimensions[group.members[0]].half_band())
            .collect();
        self.worst_case(responses, &all, &at).map(|found| found.value)
    }

    /// Constraint with both limits moved outwards, or a required sigma raised. Returns None if nothing is left of them.
    pub(in crate::allocation) fn widened(&self, by: f64) -> Option<Self> {
        if let Requirement::Sigma(most) = self.requirement {
            return (most + by > 0.0).then_some(Self { requirement: Requirement::Sigma(most + by), ..*self });
        }
        let limits = SpecLimits::new(self.limits.lower().map(|l| l - by), self.limits.upper().map(|u| u + by));
        Some(Self { limits: limits.ok()?, ..*self })
    }

    /// Length in the unit of the limits: half of the distance between them, or the size of the only one.
    pub(in crate::allocation) fn extent(&self) -> Option<f64> {
        let extent = match (self.requirement, self.limits.lower(), self.limits.upper()) {
            (Requirement::Sigma(most), ..) => most,
            (_, Some(lower), Some(upper)) => 0.5 * (upper - lower),
            (_, lower, upper) => lower.or(upper)?.abs(),
        };
        (extent > 0.0).then_some(extent)
    }

    /// Scale of [`excess`](Self::excess): three sigma, or the half-width that varies at the linearization point.
    pub(in crate::allocation) fn width(&self, responses: &Responses, ones: &[f64]) -> Option<f64> {
        let zero = vec![0.0; ones.len()];
        let width = match self.requirement {
            Requirement::Cpk(_) | Requirement::Rss | Requirement::WorstCase => {
                let (centre, reach) = self.reached(responses, ones, &zero)?;
                reach.abs().max(4.0 * f64::EPSILON * centre.abs())
            }
            Requirement::Sigma(_) | Requirement::Yield(_) => 1.0,
        };
        (width > 0.0).then_some(width)
    }

    /// Excess over the requirement in units of `width`. It is at most 0 if the requirement is kept, and smooth in
    /// factors and shifts if the surface is.
    pub(in crate::allocation) fn excess(
        &self,
        responses: &Responses,
        factors: &[f64],
        shifts: &[f64],
        width: f64,
    ) -> Option<f64> {
        let value = match self.requirement {
            Requirement::Sigma(_) => self.ratio_at(responses, &[], factors, Some(shifts))? - 1.0,
            Requirement::Yield(_) => self.ratio_at(responses, &[], factors, Some(shifts))?.powi(2) - 1.0,
            _ => {
                let (centre, reach) = self.reached(responses, factors, shifts)?;
                match self.side {
                    Side::Above => (centre + reach - self.limits.upper()?) / width,
                    _ => (self.limits.lower()? - centre + reach) / width,
                }
            }
        };
        value.is_finite().then_some(value)
    }

    /// Centre of a characteristic, and its reach from there on this side.
    fn reached(&self, responses: &Responses, factors: &[f64], shifts: &[f64]) -> Option<(f64, f64)> {
        let c = self.characteristic;
        match self.requirement {
            Requirement::Rss => {
                Some((responses.middle(c, factors, Some(shifts))?, responses.rss_squared(c, &[], factors)?.0.sqrt()))
            }
            Requirement::WorstCase => responses.worst_reach(c, factors, shifts, self.side == Side::Above),
            _ => {
                let moments = responses.moments_shifted(c, factors, Some(shifts))?;
                Some((moments.mean(), 3.0 * self.target(responses) * moments.sigma()))
            }
        }
    }

    /// Slack between a value and the limit on this side. Returns None if there is none.
    pub(in crate::allocation) fn room_about(&self, value: f64) -> Option<f64> {
        let room = match self.side {
            Side::Below => value - self.limits.lower()?,
            Side::Above => self.limits.upper()? - value,
            Side::Both | Side::Joint => return None,
        };
        (room > 0.0).then_some(room)
    }

    /// Required yield, Cpk or sigma, made stricter by the uncertainty at the linearization point.
    pub(in crate::allocation) fn target(&self, responses: &Responses) -> f64 {
        let reach = |of: fn(&Unknown) -> f64| of(&responses.of[self.characteristic].unknown);
        match self.requirement {
            Requirement::Yield(least) if self.is_joint() => 1.0 - Correction::allowed(least, responses.joint_unknown),
            Requirement::Yield(least) => 1.0 - Correction::allowed(least, reach(|of| of.yield_)),
            Requirement::Cpk(least) => least + reach(|of| of.cpk),
            Requirement::Sigma(most) => (most - reach(|of| of.sigma)).max(0.5 * most),
            Requirement::Rss | Requirement::WorstCase => f64::NAN,
        }
    }

    /// Computes the correction by the surface distribution, so that it is stored for later use.
    pub(in crate::allocation) fn prepare(&self, responses: &Responses) {
        if !self.is_joint() {
            let _: Option<Arc<Correction>> = self.correction(responses);
        }
    }

    /// Correction of the slack for a yield by the surface distribution.
    fn correction(&self, responses: &Responses) -> Option<Arc<Correction>> {
        let Requirement::Yield(least) = self.requirement else { return None };
        let target = self.target(responses);
        let room = |moments: &Moments| Some(self.room(moments, target)?.sigma());
        responses.correction(self.characteristic, least, &room, &|moments| self.room(moments, target)?.slopes())
    }

    /// Largest sigma that keeps the requirement with this mean and shape. Returns None if no sigma does, and if the
    /// requirement does not depend on the mean.
    pub(in crate::allocation) fn room(&self, moments: &Moments, target: f64) -> Option<Room> {
        let (below, above) =
            (self.limits.lower().map(|l| moments.mean() - l), self.limits.upper().map(|u| u - moments.mean()));
        let side = match self.side {
            Side::Below => below,
            Side::Above => above,
            Side::Both | Side::Joint => None,
        };
        let positive = |room: f64| (room > 0.0).then_some(room);
        match self.requirement {
            Requirement::Sigma(_) => Some(Room::Given { sigma: target, by_mean: 0.0 }),
            Requirement::Cpk(_) => {
                let sigma = positive(side? / (3.0 * target))?;
                let sign = if self.side == Side::Above { -1.0 } else { 1.0 };
                Some(Room::Given { sigma, by_mean: sign / (3.0 * target * sigma) })
            }
            Requirement::Rss | Requirement::WorstCase => None,
            Requirement::Yield(_) => YieldRoom::of(moments, [below, above], 1.0 - target).map(Room::Yield),
        }
    }

    /// Derivatives of the logarithm of the slack by an outward move of the lower and the upper limit, per unit.
    fn room_by_limits(&self, moments: &Moments, target: f64) -> Option<[f64; 2]> {
        let step = 1e-5 * self.room(moments, target)?.sigma();
        let moved = |lower: f64, upper: f64| {
            let limits =
                SpecLimits::new(self.limits.lower().map(|l| l - lower), self.limits.upper().map(|u| u + upper));
            Some(Self { limits: limits.unwrap_or(self.limits), ..*self }.room(moments, target)?.sigma())
        };
        let difference = |by: &dyn Fn(f64) -> Option<f64>| match (by(step), by(-step)) {
            (Some(up), Some(down)) => (libm::log(up) - libm::log(down)) / (2.0 * step),
            _ => 0.0,
        };
        Some([difference(&|step| moved(step, 0.0)), difference(&|step| moved(0.0, step))])
    }

    /// Divisor of the worst case: the distance from the nominal value to the limit.
    pub(in crate::allocation) fn nominal_room(&self, responses: &Responses) -> Option<f64> {
        let nominal = responses.of[self.characteristic].nominal?;
        match self.side {
            Side::Above => Some(self.limits.upper()? - nominal),
            Side::Below => Some(nominal - self.limits.lower()?),
            Side::Both | Side::Joint => None,
        }
    }
}

/// Largest sigma that keeps a requirement, at a mean and a shape.
pub(in crate::allocation) enum Room {
    /// Sigma that does not depend on the shape, with the derivative of its logarithm by the mean.
    Given {
        sigma: f64,
        by_mean: f64,
    },
    Yield(YieldRoom),
}

impl Room {
    pub(in crate::allocation) fn sigma(&self) -> f64 {
        match self {
            Self::Given { sigma, .. } => *sigma,
            Self::Yield(room) => room.sigma(),
        }
    }

    /// Derivatives of its logarithm by mean, skewness and excess.
    fn slopes(&self) -> Option<[f64; 3]> {
        match self {
            Self::Given { by_mean, .. } => Some([*by_mean, 0.0, 0.0]),
            Self::Yield(room) => room.slopes(),
        }
    }
}

/// Variation divided by its slack. No variation uses no slack.
fn by_room(own: f64, room: f64) -> f64 {
    match own == 0.0 {
        true if room > 0.0 => 0.0,
        true => f64::INFINITY,
        false => own / room,
    }
}

impl Linearised {
    /// Linearised requirement from its used part and the slopes of that.
    pub(in crate::allocation) fn of_uses(value: f64, slopes: Vec<f64>, linear: bool) -> Self {
        Self { value, slopes, linear }
    }

    /// Linearised requirement that grows with the squares of the tolerances.
    pub(in crate::allocation) fn of_squares(value: f64, slopes: Vec<f64>) -> Self {
        Self { value, slopes, linear: false }
    }

    /// Sum of powers of the tolerances with the same value and slopes at `at`. It is exact for worst cases and for sums
    /// of squares. A term that grows as a tolerance shrinks gets its inverse square, so that the sum is convex.
    pub(in crate::allocation) fn row(&self, at: &[f64]) -> Row {
        let mut constant = self.value;
        let terms = self.slopes.iter().zip(at).map(|(&slope, &t)| {
            let power = match (self.linear, slope < 0.0) {
                (true, _) => 1.0,
                (false, false) => 2.0,
                (false, true) => -2.0,
            };
            let coefficient = slope / power;
            constant -= coefficient;
            Term { coefficient, power, at: t }
        });
        let terms = terms.collect();
        Row { constant, terms }
    }
}

impl Constraint {
    /// Value of the requirement at these tolerances, in its own measure. Returns None if it is unknown.
    pub(in crate::allocation) fn measured(&self, responses: &Responses, priced: &[Priced], at: &[f64]) -> Option<f64> {
        let factors = responses.factors(priced, at);
        match self.requirement {
            Requirement::WorstCase => self.worst_case(responses, priced, at).map(|found| found.value),
            Requirement::Rss => self.ratio(responses, priced, at),
            Requirement::Sigma(_) => Some(responses.moments(self.characteristic, &factors)?.sigma()),
            Requirement::Cpk(_) => {
                let moments = responses.moments(self.characteristic, &factors)?;
                capability::cpk(moments.mean(), moments.sigma(), self.limits)
            }
            Requirement::Yield(_) if self.is_joint() => {
                Some(1.0 - responses.rejects(&responses.limited()).share(responses, &factors, None)?)
            }
            Requirement::Yield(_) => {
                let moments = responses.moments(self.characteristic, &factors)?;
                let law = Law::fit(&moments).ok()?;
                Capability::of(&law, moments.mean(), moments.sigma(), self.limits).yield_()
            }
        }
    }

    /// Dimensions without a cost that alone break the requirement, most harmful first. The list is empty if the
    /// requirement could be kept with all other tolerances at zero.
    pub(in crate::allocation) fn without_the_priced(
        &self,
        responses: &Responses,
        priced: &[Priced],
        factors: &[f64],
    ) -> Vec<String> {
        let is_priced = |d: usize| priced.iter().any(|group| group.members.contains(&d));
        let alone = |only: Option<usize>| -> Vec<f64> {
            (0..factors.len())
                .map(|d| match is_priced(d) || only.is_some_and(|only| only != d) {
                    true => 1e-9,
                    false => 1.0,
                })
                .collect()
        };
        if kept(self.value_at(responses, &alone(None))) {
            return Vec::new();
        }
        let mut harm: Vec<(f64, usize)> = (0..factors.len())
            .filter(|&d| !is_priced(d) && responses.dimensions[d].sigma() > 0.0)
            .map(|d| (responses.spread(self.characteristic, d), d))
            .filter(|(harm, _)| *harm > 0.0)
            .collect();
        harm.sort_by(|a, b| b.0.total_cmp(&a.0));
        harm.into_iter().map(|(_, d)| responses.dimensions[d].name().to_owned()).collect()
    }

    /// Saving per unit by which the lower limit goes down, the upper one up, or a required sigma grows.
    pub(in crate::allocation) fn prices(
        &self,
        responses: &Responses,
        priced: &[Priced],
        at: &[f64],
        multiplier: f64,
    ) -> Option<[Option<f64>; 3]> {
        if self.requirement == Requirement::WorstCase {
            // The reach stays, and the slack that it is divided by grows.
            let price = multiplier * self.value(responses, priced, at) / self.nominal_room(responses)?;
            return Some(match self.side {
                Side::Below => [Some(price), None, None],
                _ => [None, Some(price), None],
            });
        }
        let moments = responses.moments(self.characteristic, &responses.factors(priced, at))?;
        let doubled = 2.0 * multiplier * self.value(responses, priced, at);
        if let Requirement::Sigma(most) = self.requirement {
            return Some([None, None, Some(doubled / most)]);
        }
        if self.requirement == Requirement::Rss {
            let factors = responses.factors(priced, at);
            let price = doubled / self.room_about(responses.middle(self.characteristic, &factors, None)?)?;
            return Some(match self.side {
                Side::Below => [Some(price), None, None],
                _ => [None, Some(price), None],
            });
        }
        let [lower, upper] = self.room_by_limits(&moments, self.target(responses))?;
        let of = |exists: bool, by: f64| (exists && by != 0.0).then_some(doubled * by);
        Some([of(self.limits.lower().is_some(), lower), of(self.limits.upper().is_some(), upper), None])
    }
}
