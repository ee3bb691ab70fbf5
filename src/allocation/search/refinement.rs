//! Zones that refine others: the tolerance of an orientation is never wider than that of its location.
//!
//! Both are one tolerance at the optimum if the cheapest tolerances break this, and all are free with convex costs. Lists of offers are split until the cheapest tolerances keep it.

use std::ops::Range;

use crate::allocation::cost::cost_curve::Curve;
use crate::allocation::cost::priced_group::{Offer, Priced, PricedZone, ZonePart};
use crate::allocation::result::allocation::Allocation;
use crate::allocation::task::{AllocateError, AllocationTask, Goal};

/// Relative excess over the wider zone that counts as rounding.
const ROUNDING: f64 = 1e-9;

/// Tasks that exclude an optimum which breaks a refinement.
pub(in crate::allocation) struct Split {
    pub(in crate::allocation) tasks: Vec<AllocationTask>,
    /// True if the tasks hold an optimum of all tolerances that keep the refinement.
    pub(in crate::allocation) is_exact: bool,
}

/// Pair of groups whose tolerances break a refinement, with these tolerances.
struct Broken {
    inner: usize,
    outer: usize,
    tight: f64,
    wide: f64,
}

impl AllocationTask {
    /// Sets the groups that have one tolerance each in relative costs, and the dimensions that have none.
    #[must_use]
    pub fn with_zones(mut self, zones: Vec<Priced>, held: Vec<usize>) -> Self {
        (self.zones, self.held) = (zones, held);
        self
    }

    /// Checks that some tolerances of every pair of zones keep their refinement.
    pub(in crate::allocation) fn check_refinements(&self) -> Result<(), AllocateError> {
        for (inner, outer) in self.refinements() {
            let (least, most) = (self.priced[inner].tightest(), self.priced[outer].loosest());
            if least > most * (1.0 + ROUNDING) {
                let name = |g: usize| {
                    let zone = self.priced[g].zone.as_ref().and_then(|zone| zone.parts.first());
                    zone.map_or_else(String::new, |part| part.name.clone())
                };
                return Err(AllocateError::NeverRefined { inner: name(inner), outer: name(outer), least, most });
            }
        }
        Ok(())
    }

    /// True if the tolerances found break a refinement.
    pub(in crate::allocation) fn breaks_refinement(&self, found: &Allocation) -> bool {
        self.broken(found).is_some()
    }

    fn broken(&self, found: &Allocation) -> Option<Broken> {
        let after = |g: usize| {
            let name = &self.priced[g].zone.as_ref()?.parts.first()?.name;
            let row = found.tolerances.iter().find(|row| row.zone.as_ref().is_some_and(|zone| zone.name == *name));
            row.map(|row| row.after)
        };
        let broken = |(inner, outer): (usize, usize)| {
            let (tight, wide) = after(inner).zip(after(outer))?;
            (tight > wide * (1.0 + ROUNDING)).then_some(Broken { inner, outer, tight, wide })
        };
        self.refinements().into_iter().find_map(broken)
    }

    /// Tasks without the tolerances found, which break a refinement.
    pub(in crate::allocation) fn split(&self, found: &Allocation) -> Split {
        let Some(broken) = self.broken(found) else { return Split { tasks: Vec::new(), is_exact: false } };
        let Broken { inner, outer, tight, wide } = broken;
        let is_ranged = |g: &usize| {
            self.priced[*g].offers.len() > 1 && self.priced[*g].offers.iter().any(|offer| offer.min < offer.max)
        };
        let parts: Vec<Option<Self>> = if let Some(ranged) = [outer, inner].into_iter().find(is_ranged) {
            (0..self.priced[ranged].offers.len()).map(|offer| self.with_offer(ranged, offer)).collect()
        } else if self.priced[outer].offers.len() > 1 {
            let wider = self.priced[outer].offers.iter().map(|offer| offer.min);
            let wider = wider.filter(|&t| t > wide * (1.0 + ROUNDING)).fold(f64::INFINITY, f64::min);
            vec![
                self.clone().below(outer, wide).and_then(|task| task.below(inner, wide)),
                self.clone().above(outer, wider),
            ]
        } else if self.priced[inner].offers.len() > 1 {
            let tighter = self.priced[inner].offers.iter().map(|offer| offer.max);
            let tighter = tighter.filter(|&t| t < tight * (1.0 - ROUNDING)).fold(0.0, f64::max);
            vec![self.clone().below(inner, tighter), self.clone().above(outer, tight)]
        } else {
            return self.as_one(inner, outer);
        };
        let tasks = parts.into_iter().flatten().filter_map(Self::within_refinements).collect();
        Split { tasks, is_exact: true }
    }

    /// Task with two free tolerances as one. It holds the optimum if the other tolerances are free too.
    fn as_one(&self, inner: usize, outer: usize) -> Split {
        let free = self.priced.iter().all(|group| group.offers.len() == 1);
        let plain =
            |g: usize| self.priced[g].offers.iter().all(|offer| offer.machine.is_none() && offer.made.is_none());
        let ranges = [inner, outer].map(|g| (self.priced[g].tightest(), self.priced[g].loosest()));
        if ranges[0].0 > ranges[1].1 {
            return Split { tasks: Vec::new(), is_exact: true };
        }
        let is_exact = free && self.goal == Goal::LeastCost && self.setups.is_empty();
        if let Some(both) = tied(&self.priced[outer], &self.priced[inner]).filter(|_| plain(inner) && plain(outer)) {
            let mut task = self.clone();
            task.priced[outer] = both;
            task.priced.remove(inner);
            return Split { tasks: vec![task], is_exact };
        }
        // Processes with a machine or a distribution of their own stay apart, with a tolerance between both.
        let between = 0.5 * (ranges[0].0.max(ranges[1].0) + ranges[0].1.min(ranges[1].1));
        let task = self.clone().below(inner, between).and_then(|task| task.above(outer, between));
        Split { tasks: task.into_iter().collect(), is_exact: false }
    }

    /// Task with one offer of a group.
    fn with_offer(&self, group: usize, offer: usize) -> Option<Self> {
        let mut task = self.clone();
        task.priced[group].offers = vec![self.priced[group].offers[offer].clone()];
        Some(task)
    }

    /// Task with a greatest tolerance of a group. Returns None if no offer is left.
    fn below(mut self, group: usize, most: f64) -> Option<Self> {
        let offers = &mut self.priced[group].offers;
        offers.retain(|offer| offer.min <= most * (1.0 + ROUNDING));
        offers.iter_mut().for_each(|offer| offer.max = offer.max.min(most.max(offer.min)));
        (!self.priced[group].offers.is_empty()).then_some(self)
    }

    /// Task with a least tolerance of a group. Returns None if no offer is left.
    fn above(mut self, group: usize, least: f64) -> Option<Self> {
        let offers = &mut self.priced[group].offers;
        offers.retain(|offer| offer.max >= least * (1.0 - ROUNDING));
        offers.iter_mut().for_each(|offer| offer.min = offer.min.max(least.min(offer.max)));
        (!self.priced[group].offers.is_empty()).then_some(self)
    }

    /// Task without the offers that break a refinement with every offer of the other zone. Returns None if none is left.
    fn within_refinements(self) -> Option<Self> {
        let mut task = self;
        for (inner, outer) in task.refinements() {
            let (least, most) = (task.priced[inner].tightest(), task.priced[outer].loosest());
            task = task.below(inner, most)?.above(outer, least)?;
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
