//! Formulas of a study, with their places.

use std::ops::Range;

use crate::build::implicit::Implicit;
use crate::error::{Fault, StudyFault, fault};
use sensitol::assembly::formula::Formula;

/// A formula of `[formulas]` or of a characteristic.
#[derive(Clone)]
pub(crate) struct Named<'f> {
    pub(crate) name: String,
    /// Text of the formula. `span` is its place in the file, with its quotes.
    pub(crate) text: &'f str,
    pub(crate) span: Range<usize>,
    pub(crate) key: String,
    pub(crate) formula: Formula,
    /// Declared unit of its value.
    pub(crate) unit: Option<&'f str>,
    /// True if it is the formula of a characteristic.
    pub(crate) result: bool,
}

/// All formulas of a study, and its implicit conditions.
pub(crate) struct Written<'f> {
    pub(crate) formulas: Vec<Named<'f>>,
    pub(crate) implicit: Option<Implicit>,
}

impl Written<'_> {
    /// All names that formulas and conditions use.
    pub(crate) fn names(&self) -> impl Iterator<Item = String> {
        let of_conditions = self.implicit.iter().flat_map(|implicit| implicit.conditions.formulas());
        let all =
            self.formulas.iter().map(|named| named.formula.clone()).chain(of_conditions.map(|(_, formula)| formula));
        all.flat_map(|formula| formula.names().map(|(name, _)| name.to_owned()).collect::<Vec<_>>())
    }

    /// Fault at the formula with this index.
    pub(crate) fn at(&self, index: usize, found: StudyFault) -> Fault {
        let named = &self.formulas[index];
        fault(named.span.clone(), named.key.clone(), found)
    }

    /// Index of the formula with this name.
    pub(crate) fn place(&self, name: &str) -> Option<usize> {
        self.formulas.iter().position(|named| named.name == name)
    }

    pub(crate) fn is_formula(&self, name: &str) -> bool {
        self.formulas.iter().any(|named| named.name == name)
    }

    pub(crate) fn is_unknown(&self, name: &str) -> bool {
        self.implicit.iter().flat_map(|implicit| implicit.conditions.unknowns()).any(|unknown| unknown.name() == name)
    }
}
