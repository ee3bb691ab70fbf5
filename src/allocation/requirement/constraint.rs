//! One side of one requirement, as a value that must not exceed 1.
//!
//! The [form](crate::allocation::requirement::form::RequirementForm) of the requirement defines the value. Squares are
//! exact sums of squares of tolerances for a linear characteristic. For any other the slopes are those of the
//! second-order moments at the trial tolerances. Yield, Cpk and sigma are required of the pessimistic end of their
//! intervals at the linearization point: the uncertainty there is added to the requirement.

use crate::allocation::surface::response::Responses;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::requirement::Requirement;

/// Relative difference between sums in another order. Limits that are met to the last digit are kept.
pub(in crate::allocation) const KEPT: f64 = 1e-12;

/// True if a constraint with this value is kept.
pub(in crate::allocation) fn kept(value: f64) -> bool {
    value <= 1.0 + KEPT
}

/// Value of a constraint. It is infinite if it is unknown, so that the constraint is not kept.
pub(super) fn known_or_infinite(value: Option<f64>) -> f64 {
    value.filter(|value| !value.is_nan()).unwrap_or(f64::INFINITY)
}

/// One side of one requirement.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(in crate::allocation) struct Constraint {
    pub(in crate::allocation) characteristic: usize,
    pub(in crate::allocation) requirement: Requirement,
    pub(super) limits: SpecLimits,
    pub(super) side: Side,
    /// Part of the slack that rss and worst case may use.
    pub(in crate::allocation) part: f64,
}

/// Limits that a constraint holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Side {
    Below,
    Above,
    Both,
    /// Joint yield of all characteristics with limits.
    Joint,
}

impl Constraint {
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

    /// Indices of the characteristics that the constraint depends on.
    pub(in crate::allocation) fn characteristics(&self, responses: &Responses) -> Vec<usize> {
        if self.is_joint() { responses.limited() } else { vec![self.characteristic] }
    }

    /// Distances of the lower limit below a value and of the upper limit above it. None for a limit that is missing.
    pub(super) fn distances(&self, value: f64) -> [Option<f64>; 2] {
        [self.limits.lower().map(|l| value - l), self.limits.upper().map(|u| u - value)]
    }

    /// Distance from a value to the limit of this side, negative beyond it. Returns None for both sides together.
    pub(super) fn signed_slack(&self, value: f64) -> Option<f64> {
        match self.side {
            Side::Below => Some(value - self.limits.lower()?),
            Side::Above => Some(self.limits.upper()? - value),
            Side::Both | Side::Joint => None,
        }
    }

    /// Slack between a value and the limit on this side. Returns None if there is none.
    pub(super) fn slack_about(&self, value: f64) -> Option<f64> {
        self.signed_slack(value).filter(|slack| *slack > 0.0)
    }

    /// Divisor of the worst case: the distance from the nominal value to the limit.
    pub(super) fn nominal_slack(&self, responses: &Responses) -> Option<f64> {
        self.signed_slack(responses.of[self.characteristic].nominal?)
    }

    /// Size of a reach from a centre, for the scale of its excess. Rounding of the centre is the least size.
    pub(super) fn width_of_reach(&self, (centre, reach): (f64, f64)) -> f64 {
        reach.abs().max(4.0 * f64::EPSILON * centre.abs())
    }

    /// Excess of a reach from a centre over the limit of this side, in units of `width`.
    pub(super) fn excess_of_reach(&self, (centre, reach): (f64, f64), width: f64) -> Option<f64> {
        match self.side {
            Side::Above => Some((centre + reach - self.limits.upper()?) / width),
            _ => Some((self.limits.lower()? - centre + reach) / width),
        }
    }

    /// Constraint with both limits moved outwards. Returns None if nothing is left between them.
    pub(super) fn with_limits_moved(&self, by: f64) -> Option<Self> {
        let limits = SpecLimits::new(self.limits.lower().map(|l| l - by), self.limits.upper().map(|u| u + by));
        Some(Self { limits: limits.ok()?, ..*self })
    }

    /// Constraint with the lower and the upper limit moved outwards, or as it is if they would pass each other.
    pub(super) fn with_each_limit_moved(&self, [lower, upper]: [f64; 2]) -> Self {
        let limits = SpecLimits::new(self.limits.lower().map(|l| l - lower), self.limits.upper().map(|u| u + upper));
        Self { limits: limits.unwrap_or(self.limits), ..*self }
    }

    /// Half of the distance between the limits, or the size of the only one.
    pub(super) fn extent_of_limits(&self) -> Option<f64> {
        match (self.limits.lower(), self.limits.upper()) {
            (Some(lower), Some(upper)) => Some(0.5 * (upper - lower)),
            (lower, upper) => Some(lower.or(upper)?.abs()),
        }
    }

    /// Price of the limit on this side, in the order of [`prices`](Self::prices).
    pub(super) fn price_of_side(&self, price: f64) -> [Option<f64>; 3] {
        match self.side {
            Side::Below => [Some(price), None, None],
            _ => [None, Some(price), None],
        }
    }
}
