//! Reads the lines of `[costs]` whose tolerance is a zone: `of` lists the dimensions that the zone makes.

use std::ops::Range;

use crate::entries::cost_entry::CostEntry;
use crate::entries::file::StudyFile;
use crate::entries::named_entries::Entries;
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use crate::expand::ZoneMembers;
use sensitol::allocation::{Priced, PricedZone, ZonePart};
use sensitol::problem::Problem;
use sensitol_numeric::names::nearest;

/// Indices of the varying dimensions of a zone.
pub(crate) fn members(of: &Spanned<Entries<f64>>, problem: &Problem, key: &str) -> Result<Vec<usize>, Fault> {
    let dimensions = problem.dimensions();
    let mut found = Vec::new();
    for (name, share) in &of.get_ref().0 {
        let value = *share.get_ref();
        if !(value.is_finite() && value > 0.0) {
            let outside = StudyFault::OutOfRange { value, range: "above 0" };
            return Err(fault(share.span(), format!("{key}.of.{}", name.get_ref()), outside));
        }
        let own = named(problem, name.get_ref());
        if own.is_empty() {
            let known: Vec<String> = dimensions.iter().map(|one| one.zone().unwrap_or(one.name()).to_owned()).collect();
            let nearest = nearest(name.get_ref(), known.iter().map(String::as_str)).map(str::to_owned);
            let found = name.get_ref().clone();
            let unknown = StudyFault::UnknownWord { what: "dimension", found, nearest, known };
            return Err(fault(name.span(), format!("{key}.of"), unknown));
        }
        found.extend(own.into_iter().filter(|&d| dimensions[d].sigma() > 0.0));
    }
    if found.is_empty() {
        let instead = "name the dimensions that the zone makes, such as of = { hole = 1.0 }".to_owned();
        return Err(fault(of.span(), format!("{key}.of"), StudyFault::MissingKey { key: "of".into(), instead }));
    }
    Ok(found)
}

/// Dimensions of this name, or with this zone.
fn named(problem: &Problem, name: &str) -> Vec<usize> {
    let all = problem.dimensions().iter().enumerate();
    all.filter(|(_, one)| one.name() == name || one.zone() == Some(name)).map(|(d, _)| d).collect()
}

/// Groups of zones for relative costs: those with a cost of their own, and those of zones without one.
pub(crate) fn groups(free: &[ZoneMembers], costs: &[Priced], problem: &Problem) -> Vec<Priced> {
    let mut found: Vec<Priced> = costs.iter().filter(|group| group.zone.is_some()).cloned().collect();
    for zone in free {
        let (mut members, mut shares) = (Vec::new(), Vec::new());
        for (name, share) in &zone.members {
            for d in named(problem, name).into_iter().filter(|&d| problem.dimensions()[d].sigma() > 0.0) {
                members.push(d);
                shares.push(*share);
            }
        }
        let Some(&first) = members.first() else { continue };
        let unit = problem.dimensions()[first].unit().filter(|_| shares[0] == 1.0).map(str::to_owned);
        let part = ZonePart { name: zone.place.cost.clone(), unit, members: 0..members.len(), cost: None };
        let within = zone.within.clone();
        let zone = PricedZone { parts: vec![part], shares, widths: Vec::new(), within };
        found.push(Priced { members, parts: 1.0, offers: Vec::new(), rounded: None, zone: Some(zone) });
    }
    found
}

/// Checks that `within` names the cost of another zone, and that no end of a zone is held.
pub(crate) fn check(file: &StudyFile) -> Result<(), Fault> {
    let zones: Vec<&str> = (file.costs.0.iter())
        .filter(|(_, entry)| entry.get_ref().of.is_some())
        .map(|(name, _)| name.get_ref().as_str())
        .collect();
    for (name, entry) in &file.costs.0 {
        let (entry, key) = (entry.get_ref(), format!("costs.{}", name.get_ref()));
        let apart = |key: &'static str, to: &str, instead| StudyFault::DoesNotApply { key, to: to.to_owned(), instead };
        if let Some(within) = &entry.within {
            let at = |found| Err(fault(within.span(), format!("{key}.within"), found));
            if entry.of.is_none() {
                return at(apart("within", "the cost of a dimension", "a zone refines another one: leave it out"));
            }
            let outer = within.get_ref();
            if outer == name.get_ref() || !zones.contains(&outer.as_str()) {
                let others = || zones.iter().copied().filter(|zone| zone != name.get_ref());
                let nearest = nearest(outer, others()).map(str::to_owned);
                let known = others().map(str::to_owned).collect();
                let what = "other zone with a cost";
                return at(StudyFault::UnknownWord { what, found: outer.clone(), nearest, known });
            }
        }
        if let (Some(side), Some(_)) = (&entry.fixed_side, &entry.of) {
            let found = apart("fixed_side", "the cost of a zone", "a zone lies about its nominal place: leave it out");
            return Err(fault(side.span(), format!("{key}.fixed_side"), found));
        }
    }
    Ok(())
}

/// Half width of the zone of a cost. Returns None for other costs.
pub(crate) fn present(entry: &CostEntry, name: &Spanned<String>, problem: &Problem) -> Result<Option<f64>, Fault> {
    let Some(of) = &entry.of else { return Ok(None) };
    let key = format!("costs.{}", name.get_ref());
    let first = members(of, problem, &key)?[0];
    let share = share(of, first, problem).unwrap_or(1.0);
    Ok(Some(problem.dimensions()[first].half_band() / share))
}

/// Share of a dimension in a zone.
fn share(of: &Spanned<Entries<f64>>, d: usize, problem: &Problem) -> Option<f64> {
    let one = &problem.dimensions()[d];
    let is_own = |name: &str| one.name() == name || one.zone() == Some(name);
    of.get_ref().0.iter().find(|(name, _)| is_own(name.get_ref())).map(|(_, share)| *share.get_ref())
}

/// Zone of a group. Returns None if none of its costs is that of a zone.
pub(crate) fn zone(file: &StudyFile, members: &[usize], problem: &Problem) -> Option<PricedZone> {
    let zones = || file.costs.0.iter().filter_map(|(name, entry)| Some((name, entry, entry.get_ref().of.as_ref()?)));
    let mut found = PricedZone::default();
    let mut at = 0;
    let mut any = false;
    while at < members.len() {
        let d = members[at];
        let own = zones().find_map(|(name, entry, of)| Some((name, entry, of, share(of, d, problem)?)));
        let Some((name, entry, of, _)) = own else {
            let one = &problem.dimensions()[d];
            let unit = one.unit().map(str::to_owned);
            found.parts.push(ZonePart { name: one.name().to_owned(), unit, members: at..at + 1, cost: None });
            found.shares.push(1.0);
            at += 1;
            continue;
        };
        any = true;
        let begin = at;
        while let Some(share) = members.get(at).and_then(|&d| share(of, d, problem)) {
            found.shares.push(share);
            at += 1;
        }
        let range: Range<usize> = begin..at;
        let unit = entry.get_ref().unit.as_ref().map(|unit| unit.get_ref().clone());
        found.parts.push(ZonePart { name: name.get_ref().clone(), unit, members: range, cost: None });
        let within = entry.get_ref().within.as_ref().map(|within| within.get_ref().clone());
        found.within = found.within.or(within);
        let fixed = |(name, factor): &(Spanned<String>, Spanned<f64>)| {
            let d = named(problem, name.get_ref()).into_iter().find(|&d| problem.dimensions()[d].sigma() == 0.0)?;
            Some((d, *factor.get_ref()))
        };
        found.widths.extend(of.get_ref().0.iter().filter_map(fixed));
    }
    any.then_some(found)
}
