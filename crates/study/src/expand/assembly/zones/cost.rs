//! Costs of zones: a line of `[costs]` with the name of a zone becomes one of the dimensions that the zone makes.
//!
//! `"housing.bore.position"` names a zone, and `"housing.bore"` the only zone of a feature.

use std::ops::Range;

use super::entry::{ZONES, ZoneKind, ZonedFeature};
use super::frame::number;
use super::lines::{Lines, MadeZone, UNIT};
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Tree, Value, ZoneMembers, ZonePlace};
use crate::faults::zone_fault::{RefinedChoice, ZoneFault};
use crate::tree::Key;
use sensitol_numeric::names::nearest;

/// A line of `[costs]` for a zone.
pub(super) struct ZoneCost {
    /// Name of the line, as written.
    line: String,
    span: Range<usize>,
    /// Full name of the zone.
    pub(super) zone: String,
    place: ZonePlace,
}

/// A feature or a pattern with the keys of its zones, and the path of its entry.
struct Zoned {
    name: String,
    keys: Vec<&'static str>,
    path: Vec<String>,
}

/// Lines of `[costs]` that name zones.
pub(super) fn costs(study: &Tree, features: &[ZonedFeature<'_>]) -> Result<Vec<ZoneCost>, Faults> {
    let zoned = zoned(study, features);
    let is_dimension = |name: &str| study.get("dimensions").is_some_and(|all| all.get(name).is_some());
    let (mut found, mut faults) = (Vec::<ZoneCost>::new(), Faults::default());
    for (key, _) in study.get("costs").map_or(&[][..], Tree::entries) {
        if is_dimension(&key.name) {
            continue;
        }
        let Some(one) = faults.take(named(key, &zoned)).flatten() else { continue };
        if let Some(other) = found.iter().find(|other| other.zone == one.zone) {
            let taken = ZoneFault::TwoCosts { zone: one.zone.clone(), other: other.line.clone() };
            faults.0.push(refusal(key.span.clone(), format!("costs.{}", key.name), taken));
            continue;
        }
        found.push(one);
    }
    faults.none()?;
    Ok(found)
}

fn refusal(span: Range<usize>, key: String, found: ZoneFault) -> Fault {
    fault(span, key, StudyFault::Zone(found))
}

/// Features and patterns with their zones.
fn zoned(study: &Tree, features: &[ZonedFeature<'_>]) -> Vec<Zoned> {
    let of_feature = |feature: &ZonedFeature<'_>| Zoned {
        name: feature.full(),
        keys: feature.zones.iter().map(|zone| zone.key).collect(),
        path: vec![feature.part.to_owned(), feature.name.to_owned()],
    };
    let mut found: Vec<Zoned> = features.iter().map(of_feature).collect();
    for (part, tree) in study.get("parts").map_or(&[][..], Tree::entries) {
        for (pattern, tree) in tree.get("patterns").map_or(&[][..], Tree::entries) {
            found.push(Zoned {
                name: format!("{}.{}", part.name, pattern.name),
                keys: ["position", "within"].into_iter().filter(|key| tree.get(key).is_some()).collect(),
                path: vec![part.name.clone(), "patterns".to_owned(), pattern.name.clone()],
            });
        }
    }
    found
}

/// Zone that a line of `[costs]` names. Returns None if it names no feature.
fn named(key: &Key, zoned: &[Zoned]) -> Result<Option<ZoneCost>, Fault> {
    let refused = |found: ZoneFault| Err(refusal(key.span.clone(), format!("costs.{}", key.name), found));
    let of = |zoned: &Zoned, zone: &str| {
        let path = zoned.path.iter().cloned().chain([zone.to_owned()]).collect();
        Ok(Some(ZoneCost {
            line: key.name.clone(),
            span: key.span.clone(),
            zone: format!("{}.{zone}", zoned.name),
            place: ZonePlace { cost: key.name.clone(), path },
        }))
    };
    if let Some(one) = zoned.iter().find(|one| one.name == key.name) {
        let feature = one.name.clone();
        return match one.keys[..] {
            [] => refused(ZoneFault::CostWithoutZone { feature }),
            [zone] => of(one, zone),
            _ => refused(ZoneFault::CostOfSeveral { feature, zones: one.keys.clone() }),
        };
    }
    let split = key.name.rsplit_once('.');
    let Some((one, zone)) = split.and_then(|(name, zone)| Some((zoned.iter().find(|one| one.name == name)?, zone)))
    else {
        return Ok(None);
    };
    if one.keys.contains(&zone) {
        return of(one, zone);
    }
    // Other endings are those of the dimensions that a zone makes, such as `at`, which are like no zone.
    let all = ZONES.iter().map(|(known, ..)| *known).chain(["within"]);
    match nearest(zone, all) {
        Some(meant) => {
            // The zone that is meant comes first, since it is the one to write.
            let mut zones = one.keys.clone();
            zones.sort_by_key(|key| *key != meant);
            refused(ZoneFault::CostOfMissing { feature: one.name.clone(), zone: zone.to_owned(), zones })
        }
        None => Ok(None),
    }
}

/// Zones without a cost whose dimensions follow their widths by numbers alone.
///
/// A zone with a bonus is left out, since its width is a number in formulas, and so is each of two zones of a feature if the other one has no
/// dimensions that follow it: the tighter zone stays within the other.
pub(super) fn free(study: &Tree, features: &[ZonedFeature<'_>], costs: &[ZoneCost], lines: &Lines) -> Vec<ZoneMembers> {
    let follows = |made: &MadeZone| {
        let plain = !made.has_formula && !made.is_uneven && !made.members.is_empty();
        plain
            && made.label.half.is_some_and(|half| half > 0.0)
            && !made.members.iter().any(|(name, _)| name.ends_with(UNIT))
    };
    let with_cost = |name: &str| costs.iter().any(|cost| cost.zone == name);
    let of = |name: &str| lines.zones.iter().find(|made| made.label.name == name).filter(|made| follows(made));
    let mut found = Vec::new();
    for zoned in zoned(study, features) {
        let full = |key: &str| format!("{}.{key}", zoned.name);
        let feature = features.iter().find(|feature| feature.full() == zoned.name);
        let kind =
            |key: &str| feature.and_then(|of| of.zones.iter().find(|zone| zone.key == key)).map(|zone| zone.kind);
        for &key in zoned.keys.iter().filter(|key| !with_cost(&full(key))) {
            let Some(made) = of(&full(key)) else { continue };
            let is_bounding = |other: &&&str| {
                let pair = [kind(key), kind(other)].map(|kind| kind == Some(ZoneKind::Orientation));
                pair[0] != pair[1] && kind(key) != Some(ZoneKind::Form) && kind(other) != Some(ZoneKind::Form)
            };
            let other = zoned.keys.iter().find(is_bounding).map(|other| full(other));
            if other.as_ref().is_some_and(|other| with_cost(other) || of(other).is_none()) {
                continue;
            }
            let half = made.label.half.unwrap_or(1.0);
            let path = zoned.path.iter().cloned().chain([key.to_owned()]).collect();
            found.push(ZoneMembers {
                place: ZonePlace { cost: full(key), path },
                members: made.members.iter().map(|(name, band)| (name.clone(), band / half)).collect(),
                within: other.filter(|_| kind(key) == Some(ZoneKind::Orientation)),
            });
        }
    }
    found
}

/// Writes the dimensions of every zone with a cost into its line of `[costs]`, and the zones that it refines.
pub(super) fn write(
    tree: &mut Tree,
    costs: Vec<ZoneCost>,
    features: &[ZonedFeature<'_>],
    lines: &Lines,
) -> Result<Vec<ZonePlace>, Faults> {
    let mut faults = Faults::default();
    let mut places = Vec::new();
    let names: Vec<(String, String)> = costs.iter().map(|cost| (cost.zone.clone(), cost.line.clone())).collect();
    for cost in costs {
        let Some(made) = faults.take(made(&cost, lines)) else { continue };
        let Some(entry) = tree.get_mut("costs").and_then(|costs| costs.get_mut(&cost.line)) else { continue };
        let key = |name: &str| Key { span: cost.span.clone(), name: name.to_owned() };
        let plain = |value: Value| Tree { span: cost.span.clone(), value };
        let half = made.label.half.unwrap_or(1.0);
        let mut of: Vec<(Key, Tree)> =
            made.members.iter().map(|(name, band)| (key(name), plain(Value::Number(band / half)))).collect();
        of.extend(made.width.iter().map(|name| (key(name), plain(Value::Number(2.0)))));
        if faults.take(plain_keys(entry, &cost)).is_none() {
            continue;
        }
        let refinement = faults.take(refined(entry, &cost, features, &names)).flatten();
        let Some(keys) = entry.entries_mut() else { continue };
        keys.extend(refinement.map(|(name, value)| (key(name), plain(value))));
        keys.push((key("of"), plain(Value::Table(of))));
        keys.extend(lines.length_unit().map(|unit| (key("unit"), plain(Value::Text(unit)))));
        places.push(cost.place);
    }
    faults.none()?;
    Ok(places)
}

/// Lines that the zone of a cost has made.
fn made<'l>(cost: &ZoneCost, lines: &'l Lines) -> Result<&'l MadeZone, Fault> {
    let zone = cost.zone.clone();
    let refused = |found: ZoneFault| Err(refusal(cost.span.clone(), format!("costs.{}", cost.line), found));
    match lines.zones.iter().find(|made| made.label.name == zone) {
        None => refused(ZoneFault::CostOfIdle { zone }),
        Some(made) if made.label.half.is_none() => refused(ZoneFault::CostOfFormula { zone }),
        Some(made) if made.label.half == Some(0.0) => refused(ZoneFault::CostOfNothing { zone }),
        Some(made) if made.has_formula => refused(ZoneFault::CostOfFormulaArm { zone }),
        Some(made) if made.is_uneven || made.members.is_empty() => refused(ZoneFault::CostOfUneven { zone }),
        Some(made) => Ok(made),
    }
}

/// Checks that a line has no key that the zone gives.
fn plain_keys(entry: &Tree, cost: &ZoneCost) -> Result<(), Fault> {
    let given = ["of", "unit"].into_iter().find_map(|key| Some((key, entry.get(key)?)));
    given.map_or(Ok(()), |(key, tree)| Err(made_by_zone(cost, key, tree)))
}

fn made_by_zone(cost: &ZoneCost, key: &'static str, tree: &Tree) -> Fault {
    let to = "the cost of a zone of a feature".to_owned();
    let apart = StudyFault::DoesNotApply { key, to, instead: "the feature gives it: leave it out" };
    fault(tree.span.clone(), format!("costs.{}.{key}", cost.line), apart)
}

/// Bound that keeps an orientation within the location of its feature, as a key of its cost. A location without a cost
/// is a greatest half width of the orientation, and an orientation without one a least half width of the location.
fn refined(
    entry: &Tree,
    cost: &ZoneCost,
    features: &[ZonedFeature<'_>],
    names: &[(String, String)],
) -> Result<Option<(&'static str, Value)>, Fault> {
    let Some((feature, zone)) = features.iter().find_map(|feature| {
        let zone = feature.zones.iter().find(|zone| zone.label(&feature.full()).name == cost.zone)?;
        Some((feature, zone))
    }) else {
        return Ok(None);
    };
    let location = [ZoneKind::Location, ZoneKind::Eccentricity];
    let is_inner = zone.kind == ZoneKind::Orientation;
    let is_outer = location.contains(&zone.kind);
    let other = match (is_inner, is_outer) {
        (true, _) => feature.zone(&location),
        (_, true) => feature.zone(&[ZoneKind::Orientation]),
        _ => None,
    };
    let Some(other) = other else { return Ok(None) };
    let label = other.label(&feature.full());
    if let Some((_, line)) = names.iter().find(|(zone, _)| *zone == label.name) {
        return match entry.get("within").filter(|_| is_inner) {
            None => Ok(is_inner.then(|| ("within", Value::Text(line.clone())))),
            Some(within) if matches!(&within.value, Value::Text(own) if own == line) => Ok(None),
            Some(within) => Err(made_by_zone(cost, "within", within)),
        };
    }
    // A zone whose width is a formula, or that a bonus widens, sets no bound.
    let Some(bound) = label.half.filter(|_| other.table.is_none_or(|table| table.get("at").is_none())) else {
        return Ok(None);
    };
    let (inner, outer) = if is_inner { (zone.key, other.key) } else { (other.key, zone.key) };
    BoundedCost { cost, is_inner, inner, outer, bound }.key(entry)
}

/// Cost of one of two zones, the other of which has no cost and bounds it.
struct BoundedCost<'c> {
    cost: &'c ZoneCost,
    is_inner: bool,
    inner: &'static str,
    outer: &'static str,
    /// Half width of the zone without a cost.
    bound: f64,
}

impl BoundedCost<'_> {
    /// True if a half width breaks the refinement.
    fn is_beyond(&self, half: f64) -> bool {
        if self.is_inner { half > self.bound } else { half < self.bound }
    }

    /// Bound as a key of the cost. Returns None if the cost keeps it as written.
    fn key(&self, entry: &Tree) -> Result<Option<(&'static str, Value)>, Fault> {
        let (key, opposite) = if self.is_inner { ("max", "min") } else { ("min", "max") };
        for key in [opposite, key] {
            let Some((given, tree)) = entry.get(key).and_then(|tree| Some((number(tree)?, tree))) else { continue };
            if self.is_beyond(given) {
                return Err(self.refusal(tree, key, RefinedChoice::Bound { key, given }));
            }
        }
        let with_bound = Ok(Some((key, Value::Number(self.bound))));
        match (entry.get("processes"), entry.get("table")) {
            _ if entry.get(key).is_some() => Ok(None),
            (Some(list), _) => self.keeps_processes(list).map(|()| None),
            (_, Some(table)) => match self.ends(table) {
                Some([near, _]) if self.is_beyond(near) => {
                    Err(self.refusal(table, "table", RefinedChoice::Table { near }))
                }
                Some([_, far]) if self.is_beyond(far) => with_bound,
                _ => Ok(None),
            },
            _ if entry.get("model").is_some() || entry.get("formula").is_some() => with_bound,
            _ => Ok(None),
        }
    }

    /// Ends of a table of points, the one that may break the refinement last. Returns None if a point is none.
    fn ends(&self, table: &Tree) -> Option<[f64; 2]> {
        let Value::Array(points) = &table.value else { return None };
        let half = |point: &Tree| match &point.value {
            Value::Array(pair) => number(pair.first()?),
            _ => None,
        };
        let halves: Vec<f64> = points.iter().map(half).collect::<Option<_>>()?;
        let least = halves.iter().copied().reduce(f64::min)?;
        let most = halves.iter().copied().reduce(f64::max)?;
        Some(if self.is_inner { [least, most] } else { [most, least] })
    }

    /// Checks that no process of a list breaks the refinement.
    fn keeps_processes(&self, list: &Tree) -> Result<(), Fault> {
        let Value::Array(processes) = &list.value else { return Ok(()) };
        for (index, process) in processes.iter().enumerate() {
            let far = if self.is_inner { "max" } else { "min" };
            let given = ["tolerance", far].into_iter().find_map(|key| Some((key, process.get(key)?)));
            let Some((key, given, tree)) = given.and_then(|(key, tree)| Some((key, number(tree)?, tree))) else {
                continue;
            };
            if self.is_beyond(given) {
                let name = match process.get("name").map(|name| &name.value) {
                    Some(Value::Text(name)) => name.clone(),
                    _ => format!("{}", index + 1),
                };
                let choice = RefinedChoice::Process { name, given };
                return Err(self.refusal(tree, &format!("processes[{}].{key}", index + 1), choice));
            }
        }
        Ok(())
    }

    fn refusal(&self, tree: &Tree, key: &str, choice: RefinedChoice) -> Fault {
        let Self { cost, is_inner, inner, outer, bound } = *self;
        let found = ZoneFault::CostBeyondRefinement { choice, is_inner, inner, outer, bound };
        refusal(tree.span.clone(), format!("costs.{}.{key}", cost.line), found)
    }
}
