//! Ranges of the sizes of features.

use crate::deserializer as de;
use crate::dimension;
use crate::entries::file::DimensionEntry;
use crate::error::Faults;
use crate::expand::Tree;
use crate::expand::geometry::line::{Line, as_number, unit_of};
use sensitol::assembly::formula::{Formula, FormulaSet, Meaning};

/// Least and greatest size of a dimension, with its unit. Returns None if it has no band. Faults of its line are reported where the line is
/// read.
pub(super) fn limits<'t>(study: &'t Tree, name: &str) -> Option<([f64; 2], Option<&'t str>)> {
    let line = study.get("dimensions")?.get(name)?;
    let read: Result<DimensionEntry, Faults> = de::read(line);
    Some((dimension::limits(&read.ok()?)?, unit_of(line)))
}

/// Range of a formula of dimensions and constants by interval arithmetic, in the unit of the line. Returns None if it is unknown.
pub(super) fn range(line: &Line<'_>, formula: &str) -> Option<[f64; 2]> {
    let study = line.study;
    let parsed = Formula::parse(formula).ok()?;
    let mut names: Vec<String> = parsed.names().map(|(name, _)| name.to_owned()).collect();
    names.sort();
    names.dedup();
    let band = |name: &String| {
        let constant = study.get("constants").and_then(|constants| constants.get(name));
        match constant.map(|entry| entry.get("value").unwrap_or(entry)) {
            Some(value) => as_number(value).map(|value| [value; 2]),
            // Sizes in other units are converted only later, so their range is unknown here.
            None => limits(study, name)
                .filter(|(_, unit)| !line.converted() || *unit == line.unit())
                .map(|(limits, _)| limits),
        }
    };
    let region = names.iter().map(band).collect::<Option<Vec<_>>>()?;
    let meanings = names.iter().enumerate().map(|(index, name)| (name.as_str(), Meaning::Variable(index)));
    let set = FormulaSet::new(vec![(String::new(), parsed)], meanings).ok()?;
    let value = set.bounds(0, &region).value;
    (!value.is_empty() && value.lower().is_finite() && value.upper().is_finite())
        .then(|| [value.lower(), value.upper()])
}
