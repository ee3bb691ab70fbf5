//! Unknowns and the conditions that determine them, as given by the study.

use std::collections::BTreeMap;

use crate::assembly::formula::{Formula, FormulaSet};
use crate::assembly::implicit::subject::{EquationSubject, PressedJoint};

/// Value that closure conditions determine.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    name: String,
    start: f64,
    lower: f64,
    upper: f64,
}

/// Condition of the assembled state.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// A formula that must be zero.
    Equation {
        /// Name of the equation.
        name: String,
        /// Formula that must be zero.
        formula: Formula,
    },
    /// Loop of vectors that must close: two equations.
    Loop {
        /// Name of the loop.
        name: String,
        /// Vectors of the loop, one after the other.
        links: Vec<Link>,
    },
}

/// Vector of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Length of the vector; a negative one points the other way.
    pub length: Formula,
    /// Absolute angle in radians.
    pub angle: Formula,
}

/// Conditions and as many unknowns, with the start of the search for the nominal state.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditions {
    pub(super) unknowns: Vec<Unknown>,
    pub(super) conditions: Vec<Condition>,
    pub(super) nominal: Vec<f64>,
    /// Joints of rigid parts, by the names of their equations.
    pub(super) subjects: BTreeMap<String, EquationSubject>,
    /// Contacts of the joints that press a part.
    pub(super) pressed: Vec<PressedJoint>,
}

/// Reason why conditions determine no state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConditionsError {
    /// The start lies outside its bounds, or the bounds are not an interval.
    #[error("the start {start} of `{name}` does not lie between its bounds {lower} and {upper}")]
    StartOutside {
        /// Name of the unknown.
        name: String,
        /// Start value of the unknown.
        start: f64,
        /// Lower bound of the unknown.
        lower: f64,
        /// Upper bound of the unknown.
        upper: f64,
    },
    /// A loop has no vectors.
    #[error("the loop `{name}` has no vectors")]
    EmptyLoop {
        /// Name of the loop.
        name: String,
    },
    /// The numbers of equations and unknowns differ.
    #[error(
        "{equations} for {unknowns}",
        equations = counted(equations, "equation"),
        unknowns = counted(unknowns, "unknown")
    )]
    Unbalanced {
        /// Names of all equations, two for a loop.
        equations: Vec<String>,
        /// Names of all unknowns.
        unknowns: Vec<String>,
    },
    /// No condition depends on an unknown.
    #[error("no equation and no loop depends on the unknown `{name}`")]
    Undetermined {
        /// Name of the unknown.
        name: String,
    },
    /// A condition does not depend on any unknown.
    #[error("the {what} `{name}` depends on no unknown: it holds or not, whatever they are")]
    WithoutUnknown {
        /// Kind of the condition, `equation` or `loop`.
        what: &'static str,
        /// Name of the condition.
        name: String,
    },
}

fn counted(names: &[String], what: &str) -> String {
    let plural = if names.len() == 1 { "" } else { "s" };
    let list = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
    format!("{} {what}{plural}{list}", names.len())
}

impl Unknown {
    /// Creates an unknown with bounds that it never leaves; a missing bound is infinite.
    ///
    /// # Errors
    /// Fails if the start does not lie between the bounds.
    pub fn new(name: impl Into<String>, start: f64, lower: f64, upper: f64) -> Result<Self, ConditionsError> {
        let name = name.into();
        if !(start.is_finite() && lower <= start && start <= upper && lower < upper) {
            return Err(ConditionsError::StartOutside { name, start, lower, upper });
        }
        Ok(Self { name, start, lower, upper })
    }

    /// Returns the name of the unknown.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the start value of the search for the nominal state.
    pub(crate) fn start(&self) -> f64 {
        self.start
    }

    /// Returns the lower and the upper bound.
    pub(crate) fn bounds(&self) -> [f64; 2] {
        [self.lower, self.upper]
    }
}

impl Condition {
    /// Returns the names of the equations, one or two.
    pub(crate) fn equations(&self) -> Vec<String> {
        match self {
            Self::Equation { name, .. } => vec![format!("equation `{name}`")],
            Self::Loop { name, .. } => vec![format!("loop `{name}` along x"), format!("loop `{name}` along y")],
        }
    }

    /// Returns the formulas of the condition, each with a name for errors.
    pub(super) fn formulas(&self) -> Vec<(String, Formula)> {
        match self {
            Self::Equation { name, formula } => vec![(name.clone(), formula.clone())],
            Self::Loop { name, links } => (links.iter().enumerate())
                .flat_map(|(index, link)| {
                    let part = |part: &str, formula: &Formula| {
                        (format!("{part} {} of loop {name}", index + 1), formula.clone())
                    };
                    [part("length", &link.length), part("angle", &link.angle)]
                })
                .collect(),
        }
    }
}

impl Conditions {
    /// Creates conditions on unknowns, whose start values are near their assembled state at the `nominal` dimensions.
    ///
    /// # Errors
    /// Fails if a loop is empty, or if the numbers of equations and unknowns differ.
    pub fn new(unknowns: Vec<Unknown>, conditions: Vec<Condition>, nominal: Vec<f64>) -> Result<Self, ConditionsError> {
        for condition in &conditions {
            if let Condition::Loop { name, links } = condition
                && links.is_empty()
            {
                return Err(ConditionsError::EmptyLoop { name: name.clone() });
            }
        }
        let equations: Vec<String> = conditions.iter().flat_map(Condition::equations).collect();
        if equations.len() != unknowns.len() {
            let unknowns = unknowns.into_iter().map(|unknown| unknown.name).collect();
            return Err(ConditionsError::Unbalanced { equations, unknowns });
        }
        Ok(Self { unknowns, conditions, nominal, subjects: BTreeMap::new(), pressed: Vec::new() })
    }

    /// Sets the joints of rigid parts that equations belong to, by the names of the equations. Failures name the joints then.
    #[must_use]
    pub fn with_subjects(self, subjects: impl IntoIterator<Item = (String, EquationSubject)>) -> Self {
        Self { subjects: subjects.into_iter().collect(), ..self }
    }

    /// Sets the contacts of joints that press a part. Changes between their sets have names then.
    #[must_use]
    pub fn with_pressed(self, pressed: Vec<PressedJoint>) -> Self {
        Self { pressed, ..self }
    }

    /// Returns for every equation the joint that it belongs to, two entries for a loop.
    pub(super) fn subjects(&self) -> Vec<Option<EquationSubject>> {
        let of = |condition: &Condition| match condition {
            Condition::Equation { name, .. } => vec![self.subjects.get(name).cloned()],
            Condition::Loop { .. } => vec![None, None],
        };
        self.conditions.iter().flat_map(of).collect()
    }

    /// Returns the unknowns.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// Returns the same conditions with every formula replaced by `of`.
    pub fn with_formulas(&self, of: &dyn Fn(&Formula) -> Formula) -> Self {
        let condition = |condition: &Condition| match condition {
            Condition::Equation { name, formula } => Condition::Equation { name: name.clone(), formula: of(formula) },
            Condition::Loop { name, links } => Condition::Loop {
                name: name.clone(),
                links: links.iter().map(|link| Link { length: of(&link.length), angle: of(&link.angle) }).collect(),
            },
        };
        Self { conditions: self.conditions.iter().map(condition).collect(), ..self.clone() }
    }

    /// Returns for every formula of the conditions, in their order, its place within its loop, or None for an equation. Even places are
    /// lengths, odd ones angles.
    pub fn places(&self) -> Vec<Option<usize>> {
        let of = |condition: &Condition| match condition {
            Condition::Equation { .. } => vec![None],
            Condition::Loop { links, .. } => (0..2 * links.len()).map(Some).collect(),
        };
        self.conditions.iter().flat_map(of).collect()
    }

    /// Returns every formula of the conditions, in order: one for an equation, lengths and angles in turn for a loop.
    pub fn formulas(&self) -> Vec<(String, Formula)> {
        self.conditions.iter().flat_map(Condition::formulas).collect()
    }

    /// Checks that every unknown is in some condition and that every condition depends on some unknown. The formulas are in `set` from
    /// `first` on, with the unknowns as variables after the `given` ones.
    pub(in crate::assembly) fn check(
        &self,
        set: &FormulaSet,
        first: usize,
        given: usize,
    ) -> Result<(), ConditionsError> {
        let (mut next, mut used) = (first, vec![false; self.unknowns.len()]);
        for condition in &self.conditions {
            let count = condition.formulas().len();
            let of_condition: Vec<usize> = (next..next + count)
                .flat_map(|formula| set.variables(formula).iter().copied())
                .filter_map(|variable| variable.checked_sub(given))
                .collect();
            if of_condition.is_empty() {
                let (what, name) = match condition {
                    Condition::Equation { name, .. } => ("equation", name.clone()),
                    Condition::Loop { name, .. } => ("loop", name.clone()),
                };
                return Err(ConditionsError::WithoutUnknown { what, name });
            }
            of_condition.into_iter().for_each(|unknown| used[unknown] = true);
            next += count;
        }
        match used.iter().position(|used| !used) {
            Some(unknown) => Err(ConditionsError::Undetermined { name: self.unknowns[unknown].name.clone() }),
            None => Ok(()),
        }
    }
}
