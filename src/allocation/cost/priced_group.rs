//! Dimensions that share a tolerance, the ways of making them, and the zone that they are the parts of.

use std::ops::Range;

use crate::allocation::cost::cost_curve::Curve;
use crate::allocation::cost::cost_error::CostError;
use crate::allocation::cost::process_option::Made;
use crate::problem::Problem;
use sensitol_numeric::dimension::Dimension;

/// Process option: one way of making a part, with its range of half bands and its cost.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Offer {
    /// Name of the process, if several compete.
    pub process: Option<String>,
    /// Cost curve.
    pub curve: Curve,
    /// Least half band.
    pub min: f64,
    /// Greatest half band.
    pub max: f64,
    /// Machine that the process needs, with a set-up cost of its own.
    pub machine: Option<String>,
    /// Dimensions with the distribution of the process, if the process gives one.
    pub made: Option<Made>,
}

impl Offer {
    /// Creates an offer from a curve between two half bands.
    pub fn between(curve: Curve, min: f64, max: f64) -> Result<Self, CostError> {
        for (name, value) in [("min", min), ("max", max)] {
            if !(value.is_finite() && value > 0.0) {
                return Err(CostError::Tolerance { name, value });
            }
        }
        if min > max {
            return Err(CostError::Swapped { min, max });
        }
        curve.check(min, max)?;
        Ok(Self { process: None, curve, min, max, machine: None, made: None })
    }

    /// Creates a process that holds one half band at one cost.
    pub fn process(name: impl Into<String>, tolerance: f64, cost: f64) -> Result<Self, CostError> {
        if !(tolerance.is_finite() && tolerance > 0.0) {
            return Err(CostError::Tolerance { name: "tolerance", value: tolerance });
        }
        let curve = Curve::fixed(cost).map_err(|_| CostError::Negative { name: "cost", value: cost })?;
        Ok(Self { process: Some(name.into()), ..Self::between(curve, tolerance, tolerance)? })
    }

    /// Sets the machine of the process. Its set-up cost is shared by all dimensions that need it.
    #[must_use]
    pub fn on(self, machine: impl Into<String>) -> Self {
        Self { machine: Some(machine.into()), ..self }
    }

    /// Sets the name of the process, if several compete.
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { process: Some(name.into()), ..self }
    }
}

/// Dimensions that share one tolerance and one process, and the ways of making them.
#[derive(Debug, Clone, PartialEq)]
pub struct Priced {
    /// Indices of the dimensions in the problem.
    pub members: Vec<usize>,
    /// Number of parts that are paid for: one for every member, but only one for the coordinates of one position.
    pub parts: f64,
    /// Ways of making each part. If there is only one, the tolerance is free within its range.
    pub offers: Vec<Offer>,
    /// Free tolerance whose steps or standard grades are the offers.
    pub rounded: Option<Offer>,
    /// Zone of a feature whose half width is the tolerance, if the members are its parts.
    pub zone: Option<PricedZone>,
}

impl Priced {
    /// Group of one dimension without a cost.
    pub(crate) fn without_cost(dimension: usize) -> Self {
        Self { members: vec![dimension], parts: 1.0, offers: Vec::new(), rounded: None, zone: None }
    }

    /// Creates a group of dimensions with one cost curve. Each part is paid for.
    ///
    /// # Errors
    ///
    /// If there is no dimension or no offer, and if a looser process costs more than a tighter one.
    pub fn new(members: Vec<usize>, offers: Vec<Offer>) -> Result<Self, CostError> {
        if members.is_empty() {
            return Err(CostError::NoMember);
        }
        if offers.is_empty() {
            return Err(CostError::NoProcess);
        }
        // A looser process with its own distribution may have a better mean, and cost more for it.
        let single = |offer: &Offer| {
            (offer.min == offer.max && offer.made.is_none()).then_some((offer.min, offer.curve.cost(offer.min)))
        };
        let mut points: Vec<(f64, f64)> = offers.iter().filter_map(single).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        if let Some(pair) = points.windows(2).find(|pair| pair[0].0 < pair[1].0 && pair[1].1 > pair[0].1) {
            return Err(CostError::Rising { loose: pair[1].0, tight: pair[0].0 });
        }
        Ok(Self { parts: members.len() as f64, members, offers, rounded: None, zone: None })
    }

    /// Sets the free tolerance whose steps or standard grades are the offers.
    pub fn rounding(self, rounded: Option<Offer>) -> Self {
        Self { rounded, ..self }
    }

    /// Cost to hold this half band, which need not be one of the offers. A process has the same cost at any tolerance
    /// that it holds, and a curve continues beyond its bounds. Returns None if nothing holds it.
    pub fn cost_to_hold(&self, t: f64) -> Option<f64> {
        self.holding(t).map(|(cost, _)| cost)
    }

    /// Cost to hold this half band, with the cheapest offer that holds it.
    pub(in crate::allocation) fn holding(&self, t: f64) -> Option<(f64, &Offer)> {
        let known = |curve: &Curve| curve.range().is_none_or(|[least, most]| (least..=most).contains(&t));
        let alone = self.offers.len() == 1;
        let holds = |offer: &&Offer| match alone && offer.min < offer.max {
            true => known(&offer.curve),
            false => offer.min <= t * (1.0 + 1e-12),
        };
        let at = |offer: &Offer| offer.curve.cost(if self.offers.len() == 1 { t } else { t.min(offer.max) });
        let costs = self.offers.iter().filter(holds).map(|offer| (self.parts * at(offer), offer));
        costs.reduce(|best, other| if other.0 < best.0 { other } else { best })
    }

    /// Sets the zone whose half width is the tolerance.
    #[must_use]
    pub fn of_zone(self, zone: PricedZone) -> Self {
        Self { zone: Some(zone), ..self }
    }

    /// Half band of the member at this place per unit of the tolerance. It is 1 unless the group is a zone.
    pub fn share(&self, place: usize) -> f64 {
        self.zone.as_ref().and_then(|zone| zone.shares.get(place)).copied().unwrap_or(1.0)
    }

    /// Members with their shares.
    pub(in crate::allocation) fn shared(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        self.members.iter().enumerate().map(|(place, &d)| (d, self.share(place)))
    }

    /// Present tolerance of the group: the half band of its first member by its share.
    pub(in crate::allocation) fn present(&self, dimensions: &[Dimension]) -> f64 {
        dimensions[self.members[0]].half_band() / self.share(0)
    }

    /// Tightest half band of the members in a problem, which their common process has to hold.
    pub fn tightest_member(&self, problem: &Problem) -> f64 {
        self.shared().map(|(d, share)| problem.dimensions()[d].half_band() / share).fold(f64::INFINITY, f64::min)
    }

    /// Least half band of all offers.
    pub(crate) fn tightest(&self) -> f64 {
        self.offers.iter().map(|offer| offer.min).fold(f64::INFINITY, f64::min)
    }

    /// Greatest half band of all offers.
    pub(crate) fn loosest(&self) -> f64 {
        self.offers.iter().map(|offer| offer.max).fold(0.0, f64::max)
    }
}

/// Zone of a feature whose half width is a tolerance with a cost, or several zones of one width.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct PricedZone {
    /// Zones of the group.
    pub parts: Vec<ZonePart>,
    /// Half band of every member per unit of the half width.
    pub shares: Vec<f64>,
    /// Dimensions without a tolerance that are proportional to the half width, with their factors. They are the widths
    /// in formulas, such as that of a zone with a bonus.
    pub widths: Vec<(usize, f64)>,
    /// Name of the zone that this one refines. Its tolerance is never below that of this one.
    pub within: Option<String>,
}

/// One zone of a group, or one dimension beside zones.
#[derive(Debug, Clone, PartialEq)]
pub struct ZonePart {
    /// Name in the study, such as `housing.bore.position`.
    pub name: String,
    /// Unit of the width.
    pub unit: Option<String>,
    /// Places of its dimensions among the members of the group.
    pub members: Range<usize>,
    /// Number of parts and their cost, if it is not that of the group.
    pub cost: Option<(f64, Curve)>,
}

/// Group that holds a dimension, with the share of the dimension in its tolerance.
pub(in crate::allocation) fn holder(priced: &[Priced], dimension: usize) -> Option<(usize, f64)> {
    let of = |(g, group): (usize, &Priced)| {
        let place = group.members.iter().position(|&d| d == dimension)?;
        Some((g, group.share(place)))
    };
    priced.iter().enumerate().find_map(of)
}
