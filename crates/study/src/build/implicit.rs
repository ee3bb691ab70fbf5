//! Reads `[unknowns]`, `[equations]` and `[loops]`.

use std::ops::Range;

use crate::entries::file::{ContactsEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::error::{Fault, fault};
use crate::expand::Elements;
use crate::source::{Source, in_formula};
use sensitol::assembly::formula::Formula;
use sensitol::assembly::implicit::{Condition, Conditions, ConditionsError, Link, PressedJoint, Unknown};
use sensitol_numeric::dimension::Dimension;

/// Conditions of a study, with the places of their formulas.
pub(crate) struct Implicit {
    pub(crate) conditions: Conditions,
    /// Places and keys, in the order of [`Conditions::formulas`].
    pub(crate) places: Vec<(Range<usize>, String)>,
}

/// Conditions of a study, with the joints that `elements` has for their equations. Returns None if it has no unknowns, equations and loops.
pub(crate) fn implicit(
    file: &StudyFile,
    dimensions: &[Dimension],
    source: &Source,
    elements: &Elements,
) -> Result<Option<Implicit>, Fault> {
    if file.unknowns.0.is_empty() && file.equations.0.is_empty() && file.loops.0.is_empty() {
        return Ok(None);
    }
    let unknowns = file.unknowns.0.iter().map(|(name, entry)| {
        let (text, given) = (name.get_ref(), entry.get_ref());
        let (lower, upper) = (given.lower.unwrap_or(f64::NEG_INFINITY), given.upper.unwrap_or(f64::INFINITY));
        let at = |error: ConditionsError| fault(entry.span(), format!("unknowns.{text}"), error);
        Unknown::new(text, given.start, lower, upper).map_err(at)
    });
    let unknowns = unknowns.collect::<Result<Vec<_>, _>>()?;

    let mut places = Vec::new();
    let mut read = |span: Range<usize>, key: String, text: &str| {
        let formula = Formula::parse(text).map_err(|error| in_formula(source, span.clone(), key.clone(), error))?;
        places.push((span, key));
        Ok(formula)
    };
    let mut conditions = Vec::new();
    for (name, text) in &file.equations.0 {
        let name = name.get_ref().clone();
        let formula = read(text.span(), format!("equations.{name}"), text.get_ref())?;
        conditions.push(Condition::Equation { name, formula });
    }
    for (name, entries) in &file.loops.0 {
        let name = name.get_ref().clone();
        let mut links = Vec::new();
        for (index, entry) in entries.get_ref().iter().enumerate() {
            let key = |part: &str| format!("loops.{name}.[{}].{part}", index + 1);
            let length = read(entry.length.span(), key("length"), &entry.length.get_ref().0)?;
            let angle = read(entry.angle.span(), key("angle"), &entry.angle.get_ref().0)?;
            links.push(Link { length, angle });
        }
        conditions.push(Condition::Loop { name, links });
    }
    let nominal = dimensions.iter().map(Dimension::nominal).collect();
    let conditions = Conditions::new(unknowns, conditions, nominal).map_err(|error| placed(file, error))?;
    let conditions = conditions.with_subjects(elements.subjects.iter().cloned());
    let pressed = |(name, entry): &(Spanned<String>, Spanned<ContactsEntry>)| {
        let ContactsEntry { sets, changes } = entry.get_ref();
        PressedJoint { joint: name.get_ref().clone(), sets: sets.clone(), changes: changes.clone() }
    };
    let conditions = conditions.with_pressed(file.contacts.0.iter().map(pressed).collect());
    Ok(Some(Implicit { conditions, places }))
}

/// Fault of the conditions at the name that the error is about.
pub(crate) fn placed(file: &StudyFile, error: ConditionsError) -> Fault {
    let unknowns = || file.unknowns.names().into_iter().map(|name| ("unknowns", name));
    let equations = || file.equations.names().into_iter().map(|name| ("equations", name));
    let loops = || file.loops.names().into_iter().map(|name| ("loops", name));
    let place = match &error {
        ConditionsError::EmptyLoop { name } | ConditionsError::WithoutUnknown { what: "loop", name } => {
            loops().find(|(_, found)| found.get_ref() == name)
        }
        ConditionsError::WithoutUnknown { name, .. } => equations().find(|(_, found)| found.get_ref() == name),
        ConditionsError::Undetermined { name } => unknowns().find(|(_, found)| found.get_ref() == name),
        ConditionsError::Unbalanced { equations: given, unknowns: wanted } if given.len() < wanted.len() => {
            unknowns().next_back()
        }
        _ => equations().chain(loops()).next_back(),
    };
    match place {
        Some((section, name)) => fault(name.span(), format!("{section}.{}", name.get_ref()), error),
        None => Fault { span: None, key: "equations".into(), fault: Box::new(error.into()) },
    }
}
