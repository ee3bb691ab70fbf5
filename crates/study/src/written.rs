//! The formulas of a study, with the place of each.

use std::ops::Range;

use super::error::{Fault, StudyFault, fault};
use super::implicit::Implicit;
use sensitol::assembly::formula::Formula;

/// A formula of the file: of `[formulas]` or of a characteristic.
#[derive(Clone)]
pub(super) struct Named<'f> {
    pub(super) name: String,
    /// Its text, and where that stands with its quotes in the file.
    pub(super) text: &'f str,
    pub(super) span: Range<usize>,
    pub(super) key: String,
    pub(super) formula: Formula,
    /// The unit that it is said to have.
    pub(super) unit: Option<&'f str>,
    /// Whether it is that of a characteristic.
    pub(super) result: bool,
}

/// Everything that is written as a formula.
pub(super) struct Written<'f> {
    pub(super) formulas: Vec<Named<'f>>,
    pub(super) implicit: Option<Implicit>,
}

impl Written<'_> {
    /// Every name that a formula or a condition uses.
    pub(super) fn names(&self) -> impl Iterator<Item = String> {
        let of_conditions = self.implicit.iter().flat_map(|implicit| implicit.conditions.formulas());
        let all =
            self.formulas.iter().map(|named| named.formula.clone()).chain(of_conditions.map(|(_, formula)| formula));
        all.flat_map(|formula| formula.names().map(|(name, _)| name.to_owned()).collect::<Vec<_>>())
    }

    /// A fault of the formula at this place.
    pub(super) fn at(&self, index: usize, found: StudyFault) -> Fault {
        let named = &self.formulas[index];
        fault(named.span.clone(), named.key.clone(), found)
    }

    /// Where a formula of this name stands.
    pub(super) fn place(&self, name: &str) -> Option<usize> {
        self.formulas.iter().position(|named| named.name == name)
    }

    pub(super) fn is_formula(&self, name: &str) -> bool {
        self.formulas.iter().any(|named| named.name == name)
    }

    pub(super) fn is_unknown(&self, name: &str) -> bool {
        self.implicit.iter().flat_map(|implicit| implicit.conditions.unknowns()).any(|unknown| unknown.name() == name)
    }
}
