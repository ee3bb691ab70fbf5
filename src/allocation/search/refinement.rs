//! Zones that refine others: the tolerance of an orientation is never wider than that of its location.
//!
//! Where the cheapest tolerances break this, both are one tolerance at the optimum, since the problem is convex. The
//! search is repeated with both as one, whose cost is the sum.

use std::ops::Range;

use crate::allocation::cost::cost_curve::Curve;
use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::cost::priced_group::{PricedZone, ZonePart};
use crate::allocation::result::allocation::Allocation;
use crate::allocation::task::AllocationTask;

/// Relative excess over the wider zone that counts as rounding.
const ROUNDING: f64 = 1e-9;

impl AllocationTask {
    /// Task with the tolerances that break a refinement as one. Returns None if none of them does.
    pub(in crate::allocation) fn refining(&self, found: &Allocation) -> Option<Self> {
        let after = |name: &str| {
            let row = found.tolerances.iter().find(|row| row.zone.as_ref().is_some_and(|zone| zone.name == name));
            row.map(|row| row.after)
        };
        let breaks = |&(inner, outer): &(usize, usize)| {
            let own = |g: usize| self.priced[g].zone.as_ref().and_then(|zone| after(&zone.parts[0].name));
            own(inner).zip(own(outer)).is_some_and(|(inner, outer)| inner > outer * (1.0 + ROUNDING))
        };
        let (inner, outer) = self.refinements().into_iter().find(breaks)?;
        let mut task = self.clone();
        match tied(&self.priced[outer], &self.priced[inner]) {
            Some(both) => {
                task.priced[outer] = both;
                task.priced.remove(inner);
            }
            None => {
                // Processes have tolerances of their own: those that the wider zone allows.
                let most = self.priced[outer].zone.as_ref().and_then(|zone| after(&zone.parts[0].name))?;
                task.priced[inner].offers.retain(|offer| offer.min <= most * (1.0 + ROUNDING));
                task.priced[inner].offers.iter_mut().for_each(|offer| offer.max = offer.max.min(most));
                task.priced[outer].offers.retain(|offer| offer.max >= most * (1.0 - ROUNDING));
                task.priced[outer].offers.iter_mut().for_each(|offer| offer.min = offer.min.max(most));
                if task.priced[inner].offers.is_empty() {
                    return None;
                }
            }
        }
        Some(task)
    }

    /// Groups whose zones refine others, each with the group of the wider zone.
    fn refinements(&self) -> Vec<(usize, usize)> {
        let group = |name: &str| {
            let is_own = |part: &ZonePart| part.name == name;
            self.priced.iter().position(|group| group.zone.as_ref().is_some_and(|zone| zone.parts.iter().any(is_own)))
        };
        let of = |(g, one): (usize, &Priced)| {
            let outer = group(one.zone.as_ref()?.within.as_ref()?)?;
            (outer != g).then_some((g, outer))
        };
        self.priced.iter().enumerate().filter_map(of).collect()
    }
}

/// Two groups as one tolerance. Returns None if one of them has a list of offers.
fn tied(outer: &Priced, inner: &Priced) -> Option<Priced> {
    let ([of_outer], [of_inner]) = (&outer.offers[..], &inner.offers[..]) else { return None };
    let (wide, tight) = (outer.zone.as_ref()?, inner.zone.as_ref()?);
    let count = outer.members.len();
    let shifted = |members: &Range<usize>| members.start + count..members.end + count;
    let priced = |part: &ZonePart, group: &Priced, zone: &PricedZone, offer: &Offer| ZonePart {
        cost: part.cost.clone().or_else(|| Some((group.parts / zone.parts.len() as f64, offer.curve.clone()))),
        ..part.clone()
    };
    let mut parts: Vec<ZonePart> = wide.parts.iter().map(|part| priced(part, outer, wide, of_outer)).collect();
    parts.extend(
        (tight.parts.iter())
            .map(|part| ZonePart { members: shifted(&part.members), ..priced(part, inner, tight, of_inner) }),
    );
    let curve = Curve::sum(vec![(outer.parts, of_outer.curve.clone()), (inner.parts, of_inner.curve.clone())]);
    let (min, max) = (of_outer.min.max(of_inner.min), of_outer.max.min(of_inner.max));
    let offer = Offer::between(curve, min, max).ok()?;
    let both = |a: &[usize], b: &[usize]| a.iter().chain(b).copied().collect();
    Some(Priced {
        members: both(&outer.members, &inner.members),
        parts: 1.0,
        offers: vec![offer],
        rounded: None,
        zone: Some(PricedZone {
            parts,
            shares: wide.shares.iter().chain(&tight.shares).copied().collect(),
            widths: wide.widths.iter().chain(&tight.widths).copied().collect(),
            within: wide.within.clone(),
        }),
    })
}
