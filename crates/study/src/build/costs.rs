//! Reads `[costs]` and `require`: the cost of tolerances and the requirements of characteristics.

use std::collections::HashMap;
use std::ops::Range;

use crate::build::grades::graded;
use crate::build::zone_cost;
use crate::dimension;
use crate::entries::cost_entry::{CostEntry, ProcessEntry, RequireEntry};
use crate::entries::file::{CharacteristicEntry, DimensionEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::REQUIREMENTS;
use crate::error::{Fault, StudyFault, fault};
use crate::faults::zone_fault::ZoneFault;
use crate::source::{Source, in_formula};
use sensitol::allocation::{CostError, Curve, CurveKind, Made, Offer, Priced};
use sensitol::assembly::formula::Formula;
use sensitol::problem::Problem;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::fits::{FixedEnd, held_end};
use sensitol_numeric::names::nearest;
use sensitol_numeric::requirement::Requirement;

/// Default bounds of the half-width: the present one divided by this factor, and multiplied by it.
const RANGE: f64 = 10.0;

/// Requirement of a characteristic: `target_cpk`, `require` or `target_yield`. Returns None if it has none of them.
pub(crate) fn requirement(
    characteristic: &Characteristic,
    entry: &CharacteristicEntry,
    key: &str,
) -> Result<Option<Requirement>, Fault> {
    if let Some(target) = &entry.target_cpk {
        let at = |found: StudyFault| fault(target.span(), format!("{key}.target_cpk"), found);
        if entry.require.is_some() {
            let why = "are two ways of saying what is required: leave one out".to_owned();
            return Err(at(StudyFault::Conflict { a: "require", b: "target_cpk", why }));
        }
        let requirement = Requirement::Cpk(*target.get_ref());
        return requirement.checked(characteristic.limits().exist()).map(Some).map_err(|error| at(error.into()));
    }
    let Some(require) = &entry.require else { return Ok(characteristic.target()) };
    let at = |span: Range<usize>, found: StudyFault| fault(span, format!("{key}.require"), found);
    let (span, requirement) = match require.get_ref() {
        RequireEntry::Word(word) => (
            require.span(),
            match word.as_str() {
                "worst-case" => Requirement::WorstCase,
                "rss" => Requirement::Rss,
                found => {
                    let nearest = nearest(found, REQUIREMENTS).map(str::to_owned);
                    let known = REQUIREMENTS.iter().map(|&word| word.to_owned()).collect();
                    let unknown =
                        StudyFault::UnknownWord { what: "requirement", found: found.to_owned(), nearest, known };
                    return Err(at(require.span(), unknown));
                }
            },
        ),
        RequireEntry::Table(table) => {
            type Make = fn(f64) -> Requirement;
            let forms: [(&'static str, &Option<Spanned<f64>>, Make); 3] = [
                ("yield", &table.yield_, Requirement::Yield),
                ("cpk", &table.cpk, Requirement::Cpk),
                ("sigma", &table.sigma, Requirement::Sigma),
            ];
            let mut given = forms.iter().filter_map(|(name, value, make)| Some((*name, value.as_ref()?, make)));
            let Some((first, value, make)) = given.next() else {
                let instead = "write one of { yield = 0.9973 }, { cpk = 1.33 } and { sigma = 0.05 }".to_owned();
                return Err(at(require.span(), StudyFault::MissingKey { key: "yield".into(), instead }));
            };
            if let Some((second, value, _)) = given.next() {
                let why = "cannot both be required of one characteristic: leave one out".to_owned();
                return Err(at(value.span(), StudyFault::Conflict { a: first, b: second, why }));
            }
            (value.span(), make(*value.get_ref()))
        }
    };
    requirement.checked(characteristic.limits().exist()).map(Some).map_err(|error| at(span, error.into()))
}

/// Dimensions that share a tolerance, with their cost.
struct Group<'f> {
    name: &'f Spanned<String>,
    members: Vec<usize>,
    parts: f64,
    offers: Offers,
}

/// Offers for a tolerance. `rounded` is the free tolerance that the offers are steps or grades of, if they are.
struct Offers {
    all: Vec<Offer>,
    rounded: Option<Offer>,
}

/// Groups of dimensions that share a tolerance, each with its cost, in the order of the file.
pub(crate) fn costs(file: &StudyFile, source: &Source, problem: &Problem) -> Result<Vec<Priced>, Fault> {
    let names: Vec<&str> = file.costs.0.iter().map(|(name, _)| name.get_ref().as_str()).collect();
    let mut groups: Vec<Group<'_>> = Vec::new();
    zone_cost::check(file)?;
    for (name, entry) in &file.costs.0 {
        let entry = entry.get_ref();
        let key = format!("costs.{}", name.get_ref());
        one_form(entry, name, &key)?;
        if entry.same_as.is_some() {
            continue;
        }
        let (members, parts) = members(file, problem, name, &key)?;
        once(&groups, name, &members, &key)?;
        let dimension = &problem.dimensions()[members[0]];
        // T of a zone is half its width, which its first dimension has by its share.
        let present = zone_cost::present(entry, name, problem)?.unwrap_or(dimension.half_band());
        let offers = offers(entry, source, name, &key, (dimension, present))?;
        groups.push(Group { name, members, parts, offers });
    }
    // `same_as` may name a dimension further down, so it is resolved when all groups exist.
    for (name, entry) in &file.costs.0 {
        let Some(other) = &entry.get_ref().same_as else { continue };
        let key = format!("costs.{}", name.get_ref());
        let at = |found: StudyFault| fault(other.span(), format!("{key}.same_as"), found);
        let (mut members, parts) = members(file, problem, name, &key)?;
        once(&groups, name, &members, &key)?;
        let target = other.get_ref();
        if target == name.get_ref() {
            return Err(at(StudyFault::SameAsItself { name: target.clone() }));
        }
        let Some(group) = groups.iter_mut().find(|group| group.name.get_ref() == target) else {
            let chained = file.costs.0.iter().find(|(other, _)| other.get_ref() == target);
            return Err(at(match chained.and_then(|(_, entry)| entry.get_ref().same_as.as_ref()) {
                Some(end) => StudyFault::SameAsChain { name: target.clone(), end: end.get_ref().clone() },
                None => {
                    let nearest = nearest(target, names.iter().copied()).map(str::to_owned);
                    let known = names.iter().map(|&name| name.to_owned()).collect();
                    StudyFault::UnknownWord { what: "dimension with a cost", found: target.clone(), nearest, known }
                }
            }));
        };
        group.members.append(&mut members);
        group.parts += parts;
    }
    // Process options are distributed like their members, which are complete only now.
    let priced = |Group { name, members, parts, offers }: Group<'_>| {
        let at = |error| fault(name.span(), format!("costs.{}", name.get_ref()), StudyFault::Cost(error));
        let Offers { mut all, rounded } = offers;
        let entry = file.costs.0.iter().find(|(other, _)| other.get_ref() == name.get_ref());
        if let Some(processes) = entry.and_then(|(_, entry)| entry.get_ref().processes.as_ref()) {
            let key = format!("costs.{}.processes", name.get_ref());
            made(&mut all, processes.get_ref(), &members, problem, &key)?;
        }
        let zone = zone_cost::zone(file, &members, problem);
        Priced::new(members, all).map(|priced| Priced { parts, zone, ..priced }.rounding(rounded)).map_err(at)
    };
    groups.into_iter().map(priced).collect()
}

/// Checks that no dimension of a cost has another one, such as that of its zone.
fn once(groups: &[Group<'_>], name: &Spanned<String>, members: &[usize], key: &str) -> Result<(), Fault> {
    let shares = |group: &&Group<'_>| members.iter().any(|member| group.members.contains(member));
    let Some(other) = groups.iter().find(shares) else { return Ok(()) };
    let two = ZoneFault::TwoCosts { zone: name.get_ref().clone(), other: other.name.get_ref().clone() };
    Err(fault(name.span(), key, StudyFault::Zone(two)))
}

/// Checks that a cost has exactly one form (model, formula, table, `same_as`, processes) and only the numbers of that form.
fn one_form(entry: &CostEntry, name: &Spanned<String>, key: &str) -> Result<(), Fault> {
    let forms: [(&'static str, Option<Range<usize>>); 5] = [
        ("model", entry.model.as_ref().map(Spanned::span)),
        ("formula", entry.formula.as_ref().map(Spanned::span)),
        ("table", entry.table.as_ref().map(Spanned::span)),
        ("same_as", entry.same_as.as_ref().map(Spanned::span)),
        ("processes", entry.processes.as_ref().map(Spanned::span)),
    ];
    let mut given = forms.into_iter().filter_map(|(form, span)| Some((form, span?)));
    let Some((first, _)) = given.next() else {
        let instead =
            "write model = \"reciprocal\" with a and b, a formula of T, a table, same_as = another dimension, or processes"
                .to_owned();
        return Err(fault(name.span(), key, StudyFault::MissingKey { key: "model".into(), instead }));
    };
    if let Some((second, span)) = given.next() {
        let why = "say two things: leave one out".to_owned();
        return Err(fault(span, format!("{key}.{second}"), StudyFault::Conflict { a: first, b: second, why }));
    }
    let numbers: [(&'static str, &Option<Spanned<f64>>); 7] = [
        ("a", &entry.a),
        ("b", &entry.b),
        ("k", &entry.k),
        ("c", &entry.c),
        ("min", &entry.min),
        ("max", &entry.max),
        ("step", &entry.step),
    ];
    let numbers = numbers.iter().filter_map(|(number, value)| Some((*number, value.as_ref()?.span())));
    let grades = entry.grades.as_ref().map(|grades| ("grades", grades.span()));
    let constant = |name: &str| ["a", "b", "k", "c"].contains(&name);
    let idle = |(name, _): &(&'static str, Range<usize>)| match first {
        "model" => false,
        "formula" | "table" => constant(name),
        _ => true,
    };
    if let Some((name, span)) = numbers.chain(grades).find(idle) {
        let (to, instead) = match first {
            "same_as" => ("a cost that is another's", "write it at the dimension that has the cost"),
            "processes" => ("a list of processes", "write it within a process"),
            "formula" => ("a cost that is a formula", "write the number into the formula"),
            _ => ("a cost that is a table", "write the costs into the table"),
        };
        let apart = StudyFault::DoesNotApply { key: name, to: to.to_owned(), instead };
        return Err(fault(span, format!("{key}.{name}"), apart));
    }
    if let (Some(_), Some(grades)) = (&entry.step, &entry.grades) {
        let why = "say two things: leave one out".to_owned();
        let two = StudyFault::Conflict { a: "step", b: "grades", why };
        return Err(fault(grades.span(), format!("{key}.grades"), two));
    }
    Ok(())
}

/// Indices of the dimension of this name, with the number of parts. Both coordinates of a position count as one part.
fn members(file: &StudyFile, problem: &Problem, name: &Spanned<String>, key: &str) -> Result<(Vec<usize>, f64), Fault> {
    let text = name.get_ref();
    let dimensions = problem.dimensions();
    if let Some((_, entry)) = file.costs.0.iter().find(|(other, _)| other.get_ref() == text)
        && let Some(of) = &entry.get_ref().of
    {
        return zone_cost::members(of, problem, key).map(|members| (members, 1.0));
    }
    let of_zone: Vec<usize> = (0..dimensions.len()).filter(|&d| dimensions[d].zone() == Some(text.as_str())).collect();
    if !of_zone.is_empty() {
        return Ok((of_zone, 1.0));
    }
    let Some(d) = dimensions.iter().position(|dimension| dimension.name() == text) else {
        let lines = file.dimensions.names();
        let known: Vec<String> = lines.iter().map(|name| name.get_ref().clone()).collect();
        let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown = StudyFault::UnknownWord { what: "dimension", found: text.clone(), nearest, known };
        return Err(fault(name.span(), key, unknown));
    };
    if let Some(zone) = dimensions[d].zone() {
        let unknown = StudyFault::UnknownWord {
            what: "cost of a single coordinate",
            found: text.clone(),
            nearest: Some(zone.to_owned()),
            known: dimension::names(&file.dimensions).into_iter().map(Spanned::into_inner).collect(),
        };
        return Err(fault(name.span(), key, unknown));
    }
    Ok((vec![d], 1.0))
}

/// Numbers of a cost entry or of a process, with their places.
struct Numbers<'e> {
    model: &'e Option<Spanned<String>>,
    a: &'e Option<Spanned<f64>>,
    b: &'e Option<Spanned<f64>>,
    k: &'e Option<Spanned<f64>>,
    c: &'e Option<Spanned<f64>>,
    min: &'e Option<Spanned<f64>>,
    max: &'e Option<Spanned<f64>>,
}

/// The offers of an entry: a curve, with steps or grades of it, or a list of processes.
fn offers(
    entry: &CostEntry,
    source: &Source,
    name: &Spanned<String>,
    key: &str,
    of: (&Dimension, f64),
) -> Result<Offers, Fault> {
    match &entry.processes {
        Some(processes) => process_offers(processes, key),
        None => curve_offers(entry, source, name, key, of),
    }
}

/// The offer of a cost curve, or its steps or grades.
fn curve_offers(
    entry: &CostEntry,
    source: &Source,
    name: &Spanned<String>,
    key: &str,
    (dimension, present): (&Dimension, f64),
) -> Result<Offers, Fault> {
    let CostEntry { model, a, b, k, c, min, max, .. } = entry;
    let numbers = Numbers { model, a, b, k, c, min, max };
    let offer = match written(entry, source, key)? {
        Some(curve) => numbers.offer_of(curve, key, &name.span(), present)?,
        None => numbers.offer(key, &name.span(), Some(present))?,
    };
    let all = match (&entry.step, &entry.grades) {
        (Some(step), _) => {
            let at = |error| fault(step.span(), format!("{key}.step"), error);
            stepped(&offer, *step.get_ref()).map_err(at)?
        }
        (None, Some(grades)) if entry.of.is_some() && dimension.zone().is_none() => {
            let instead = "a zone has no size: write step or a free tolerance";
            let apart = StudyFault::DoesNotApply { key: "grades", to: "a zone".into(), instead };
            return Err(fault(grades.span(), format!("{key}.grades"), apart));
        }
        (None, Some(grades)) => {
            let at = |error| fault(grades.span(), format!("{key}.grades"), error);
            let bounds = [min, max].map(|bound| bound.as_ref().map(|bound| *bound.get_ref()));
            graded(&offer.curve, grades.get_ref(), bounds, dimension).map_err(at)?
        }
        _ => return Ok(Offers { all: vec![offer], rounded: None }),
    };
    // Steps lie between the bounds; grades have bounds of their own.
    let rounded = match entry.step {
        Some(_) => Some(offer),
        None => {
            let least = all.iter().map(|one| one.min).fold(f64::INFINITY, f64::min);
            let most = all.iter().map(|one| one.max).fold(0.0, f64::max);
            Offer::between(offer.curve, least, most).ok()
        }
    };
    Ok(Offers { all, rounded })
}

/// The offers of a list of processes, the loosest first.
fn process_offers(processes: &Spanned<Vec<Spanned<ProcessEntry>>>, key: &str) -> Result<Offers, Fault> {
    if processes.get_ref().is_empty() {
        return Err(fault(processes.span(), format!("{key}.processes"), CostError::NoProcess));
    }
    let mut offers: Vec<Offer> = Vec::new();
    // Each process is one tolerance at one cost, or a curve between its own bounds.
    for (index, process) in processes.get_ref().iter().enumerate() {
        let (span, process) = (process.span(), process.get_ref());
        let key = format!("{key}.processes[{}]", index + 1);
        let named = process.name.get_ref();
        if offers.iter().any(|offer| offer.process.as_ref() == Some(named)) {
            let taken = StudyFault::NameTaken { name: named.clone(), by: "another process" };
            return Err(fault(process.name.span(), format!("{key}.name"), taken));
        }
        let offer = process_offer(process, span, key)?;
        offers.push(match &process.machine {
            Some(machine) => offer.on(machine.get_ref()),
            None => offer,
        });
    }
    // Loosest first, so that neighbours in the list have similar costs.
    offers.sort_by(|x, y| (y.max, y.min).partial_cmp(&(x.max, x.min)).unwrap_or(std::cmp::Ordering::Equal));
    Ok(Offers { all: offers, rounded: None })
}

/// The offer of one process: a cost model between bounds, or one tolerance at one cost.
fn process_offer(process: &ProcessEntry, span: Range<usize>, key: String) -> Result<Offer, Fault> {
    let ProcessEntry { model, a, b, k, c, min, max, .. } = process;
    let named = process.name.get_ref();
    match (&process.model, &process.tolerance, &process.cost) {
        (Some(_), None, None) => {
            let numbers = Numbers { model, a, b, k, c, min, max };
            for (bound, given) in [("min", min), ("max", max)] {
                if given.is_none() {
                    let instead = "a process with a model needs min and max, between which it is used".to_owned();
                    return Err(fault(span, key, StudyFault::MissingKey { key: bound.into(), instead }));
                }
            }
            Ok(numbers.offer(&key, &span, None)?.named(named))
        }
        (Some(_), Some(value), _) | (Some(_), _, Some(value)) => {
            let which = if process.tolerance.is_some() { "tolerance" } else { "cost" };
            let why = "say two things: leave one out".to_owned();
            Err(fault(value.span(), format!("{key}.{which}"), StudyFault::Conflict { a: "model", b: which, why }))
        }
        (None, Some(tolerance), Some(cost)) => {
            Offer::process(named, *tolerance.get_ref(), *cost.get_ref()).map_err(|error| match error {
                CostError::Tolerance { .. } => fault(tolerance.span(), format!("{key}.tolerance"), error),
                _ => fault(cost.span(), format!("{key}.cost"), error),
            })
        }
        (None, tolerance, _) => {
            let missing = if tolerance.is_none() { "tolerance" } else { "cost" };
            let instead = "a process is such as { name = \"grind\", tolerance = 0.002, cost = 19.4 }".to_owned();
            Err(fault(span, key, StudyFault::MissingKey { key: missing.into(), instead }))
        }
    }
}

/// Line of a dimension with the distribution keys of a process, and no others.
fn spread_of(process: &ProcessEntry) -> DimensionEntry {
    DimensionEntry {
        distribution: process.distribution.clone(),
        sigma: process.sigma.clone(),
        sigmas: process.sigmas.clone(),
        cp: process.cp.clone(),
        cpk: process.cpk.clone(),
        side: process.side.clone(),
        drift: process.drift.clone(),
        ..DimensionEntry::default()
    }
}

/// Adds to each offer the dimensions as its process makes them, if the processes state a distribution. In a list all processes state one or
/// none does.
fn made(
    offers: &mut [Offer],
    processes: &[Spanned<ProcessEntry>],
    members: &[usize],
    problem: &Problem,
    key: &str,
) -> Result<(), Fault> {
    if processes.iter().all(|process| process.get_ref().spread().is_none()) {
        return Ok(());
    }
    for (index, process) in processes.iter().enumerate() {
        let (line, process) = (process.span(), process.get_ref());
        let key = format!("{key}[{}]", index + 1);
        let Some((own, span)) = process.spread() else {
            let instead = "in a list where one process says how its parts lie, each does: cp = 1.0 is three sigma within the band";
            return Err(fault(line, key, StudyFault::MissingKey { key: "cp".into(), instead: instead.into() }));
        };
        let apart = |to: &str, instead| {
            let found = StudyFault::DoesNotApply { key: own, to: to.to_owned(), instead };
            fault(span.clone(), format!("{key}.{own}"), found)
        };
        if process.model.is_some() {
            return Err(apart("a process with a model", "give it one tolerance and one cost"));
        }
        let (Some(tolerance), Some(offer)) = (
            &process.tolerance,
            offers.iter_mut().find(|offer| offer.process.as_ref() == Some(process.name.get_ref())),
        ) else {
            continue;
        };
        let spread = spread_of(process);
        let of = |&d: &usize| {
            let old = &problem.dimensions()[d];
            if old.zone().is_some() {
                return Err(apart("a position", "write how its parts lie at the position itself"));
            }
            if old.tolerance().is_none() {
                return Err(apart("a dimension without a tolerance", "give the dimension a tolerance"));
            }
            dimension::made(old, &spread, *tolerance.get_ref(), line.clone()).map_err(|found| Fault {
                key: if found.key.is_empty() { key.clone() } else { format!("{key}.{}", found.key) },
                ..found
            })
        };
        offer.made = Some(Made::new(members.iter().map(of).collect::<Result<_, _>>()?));
    }
    Ok(())
}

/// Curve of a cost that is given as a formula or a table. Returns None if it is a model.
fn written(entry: &CostEntry, source: &Source, key: &str) -> Result<Option<Curve>, Fault> {
    if let Some(formula) = &entry.formula {
        let at = |error| in_formula(source, formula.span(), format!("{key}.formula"), error);
        return Formula::parse(formula.get_ref()).and_then(Curve::formula).map(Some).map_err(at);
    }
    let of_table = |table: &Spanned<Vec<[f64; 2]>>| {
        Curve::table(table.get_ref()).map_err(|error| fault(table.span(), format!("{key}.table"), error))
    };
    entry.table.as_ref().map(of_table).transpose()
}

/// Greatest number of steps between the bounds: a finer list is as good as a free tolerance.
const MOST_STEPS: f64 = 1000.0;

/// Whole multiples of a step within an offer, loosest first.
fn stepped(offer: &Offer, step: f64) -> Result<Vec<Offer>, StudyFault> {
    if !(step.is_finite() && step > 0.0) {
        return Err(CostError::Tolerance { name: "step", value: step }.into());
    }
    // The allowance of 1e-9 keeps a bound that is itself a multiple up to rounding.
    let (first, last) = ((offer.min / step - 1e-9).ceil().max(1.0), (offer.max / step + 1e-9).floor());
    if first > last {
        return Err(StudyFault::NoStep { step, min: offer.min, max: offer.max });
    }
    if last - first > MOST_STEPS {
        return Err(StudyFault::TooManySteps { step, count: last - first, most: MOST_STEPS });
    }
    let multiple = |index: usize| {
        let t = (last - index as f64) * step;
        Offer::between(Curve::fixed(offer.curve.cost(t))?, t, t)
    };
    (0..=(last - first) as usize).map(multiple).collect::<Result<_, CostError>>().map_err(StudyFault::from)
}

/// Dimensions with the end of the band that stays when the tolerance changes: `fixed_side` of the cost, and otherwise that of the fit.
pub(crate) fn holding(file: &StudyFile, mut dimensions: Vec<Dimension>) -> Result<Vec<Dimension>, Fault> {
    // Found by name, since a table of a spreadsheet has up to a million rows.
    let fits: HashMap<&str, FixedEnd> = (file.dimensions.0.iter())
        .filter_map(|(name, entry)| Some((name.get_ref().as_str(), held_end(entry.get_ref().fit.as_ref()?.get_ref())?)))
        .collect();
    let sides: HashMap<&str, &Spanned<String>> = (file.costs.0.iter())
        .filter_map(|(name, entry)| Some((name.get_ref().as_str(), entry.get_ref().fixed_side.as_ref()?)))
        .collect();
    for dimension in &mut dimensions {
        let of_fit = fits.get(dimension.name()).copied();
        let Some(side) = sides.get(dimension.name()).copied() else {
            if let Some(end) = of_fit {
                *dimension = dimension.clone().holding(end);
            }
            continue;
        };
        let key = format!("costs.{}.fixed_side", dimension.name());
        let end = match side.get_ref().as_str() {
            "lower" => FixedEnd::Lower,
            "upper" => FixedEnd::Upper,
            "middle" => continue,
            found => {
                let known = ["lower", "upper", "middle"];
                let nearest = nearest(found, known).map(str::to_owned);
                let known = known.map(str::to_owned).to_vec();
                let unknown = StudyFault::UnknownWord { what: "fixed side", found: found.to_owned(), nearest, known };
                return Err(fault(side.span(), key, unknown));
            }
        };
        if dimension.tolerance().is_none() {
            let instead = "a dimension without a band has no end that could stay: give it a tolerance";
            let to = "a dimension without a tolerance".to_owned();
            return Err(fault(side.span(), key, StudyFault::DoesNotApply { key: "fixed_side", to, instead }));
        }
        *dimension = dimension.clone().holding(end);
    }
    Ok(dimensions)
}

impl Numbers<'_> {
    /// Curve of a cost model over a range of half-widths. Missing bounds follow from the half-width `present`, if that is given.
    fn offer(&self, key: &str, line: &Range<usize>, present: Option<f64>) -> Result<Offer, Fault> {
        let model = self.model.as_ref().expect("a cost with a model");
        let Some(kind) = CurveKind::NAMED.iter().find(|(name, _)| name == model.get_ref()).map(|(_, kind)| *kind)
        else {
            let known: Vec<String> = CurveKind::NAMED.iter().map(|(name, _)| (*name).to_owned()).collect();
            let found = model.get_ref().clone();
            let nearest = nearest(&found, known.iter().map(String::as_str)).map(str::to_owned);
            let unknown = StudyFault::UnknownWord { what: "cost model", found, nearest, known };
            return Err(fault(model.span(), format!("{key}.model"), unknown));
        };
        let spare: &[(&'static str, &Option<Spanned<f64>>)] = match kind {
            CurveKind::ReciprocalPower => &[("c", self.c)],
            CurveKind::Exponential => &[("k", self.k)],
            _ => &[("k", self.k), ("c", self.c)],
        };
        if let Some((name, value)) = spare.iter().find_map(|(name, value)| Some((*name, value.as_ref()?))) {
            let (to, instead) = (
                format!("a cost of the model {}", model.get_ref()),
                "k is the exponent of reciprocal-power, c the half band of exponential",
            );
            return Err(fault(
                value.span(),
                format!("{key}.{name}"),
                StudyFault::DoesNotApply { key: name, to, instead },
            ));
        }
        let needed = |name: &'static str, value: &Option<Spanned<f64>>| match value {
            Some(value) => Ok(*value.get_ref()),
            None => {
                let instead = format!("a cost of the model {} needs {name}", model.get_ref());
                Err(fault(line.clone(), key, StudyFault::MissingKey { key: name.into(), instead }))
            }
        };
        let (a, b) = (self.a.as_ref().map_or(0.0, |a| *a.get_ref()), needed("b", self.b)?);
        let curve = match kind {
            CurveKind::ReciprocalPower => Curve::reciprocal_power(a, b, needed("k", self.k)?),
            CurveKind::Exponential => Curve::exponential(a, b, needed("c", self.c)?),
            _ => Curve::reciprocal(a, b),
        };
        let curve = curve.map_err(|error| self.at_number(error, key, line))?;
        self.between(curve, key, line, present)
    }

    /// Curve of a formula or a table with its bounds. The ends of a table are its default bounds.
    fn offer_of(&self, curve: Curve, key: &str, line: &Range<usize>, present: f64) -> Result<Offer, Fault> {
        let Some([least, greatest]) = curve.range() else { return self.between(curve, key, line, Some(present)) };
        let bound = |given: &Option<Spanned<f64>>, end: f64| given.as_ref().map_or(end, |given| *given.get_ref());
        Offer::between(curve, bound(self.min, least), bound(self.max, greatest))
            .map_err(|error| self.at_number(error, key, line))
    }

    /// Curve between the given bounds. Missing ones follow from the half-width `present`, if that is given.
    fn between(&self, curve: Curve, key: &str, line: &Range<usize>, present: Option<f64>) -> Result<Offer, Fault> {
        let bound = |given: &Option<Spanned<f64>>, factor: f64| {
            given.as_ref().map_or(present.unwrap_or(f64::NAN) * factor, |given| *given.get_ref())
        };
        // Allocation refuses a dimension without tolerance, so its bounds are not reported as faults here.
        let (mut min, mut max) = (bound(self.min, 1.0 / RANGE), bound(self.max, RANGE));
        if present == Some(0.0) {
            (min, max) = (1.0, 1.0);
        } else if self.min.is_none() {
            min = min.min(max);
        } else if self.max.is_none() {
            max = max.max(min);
        }
        Offer::between(curve, min, max).map_err(|error| self.at_number(error, key, line))
    }

    /// Fault at the number that the error names.
    fn at_number(&self, error: CostError, key: &str, line: &Range<usize>) -> Fault {
        let (name, value) = match error {
            CostError::Negative { name, .. } | CostError::NotPositive { name, .. } => (
                name,
                match name {
                    "a" => self.a,
                    "b" => self.b,
                    "k" => self.k,
                    _ => self.c,
                },
            ),
            CostError::Tolerance { name: "min", .. } | CostError::OutsideTable { name: "min", .. } => ("min", self.min),
            CostError::NoValue { .. } | CostError::BelowZero { .. } | CostError::Rising { .. } => {
                return fault(line.clone(), key, error);
            }
            _ => ("max", self.max),
        };
        fault(value.as_ref().map_or(line.clone(), Spanned::span), format!("{key}.{name}"), error)
    }
}
