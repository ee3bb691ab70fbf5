//! Unknowns and the conditions that determine them, as they are given.

use crate::assembly::formula::{Formula, FormulaSet};

/// A value that is found, not given.
#[derive(Debug, Clone, PartialEq)]
pub struct Unknown {
    name: String,
    start: f64,
    lower: f64,
    upper: f64,
}

/// A condition of the assembled state.
#[derive(Debug, Clone, PartialEq)]
pub enum Condition {
    /// A formula that is zero.
    Equation {
        /// Its name.
        name: String,
        /// The formula that is zero.
        formula: Formula,
    },
    /// Vectors that close: two equations.
    Loop {
        /// Its name.
        name: String,
        /// The vectors, one after the other.
        links: Vec<Link>,
    },
}

/// One vector of a loop.
#[derive(Debug, Clone, PartialEq)]
pub struct Link {
    /// Its length; a negative one points the other way.
    pub length: Formula,
    /// Its absolute angle in radians.
    pub angle: Formula,
}

/// As many conditions as unknowns, and where the search for the nominal state starts.
#[derive(Debug, Clone, PartialEq)]
pub struct Conditions {
    pub(super) unknowns: Vec<Unknown>,
    pub(super) conditions: Vec<Condition>,
    pub(super) nominal: Vec<f64>,
}

/// Why conditions determine no state.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConditionsError {
    /// The start lies outside its bounds, or the bounds are no interval.
    #[error("the start {start} of `{name}` does not lie between its bounds {lower} and {upper}")]
    StartOutside {
        /// The unknown.
        name: String,
        /// Where it starts.
        start: f64,
        /// The lower bound.
        lower: f64,
        /// The upper bound.
        upper: f64,
    },
    /// A loop without vectors.
    #[error("the loop `{name}` has no vectors")]
    EmptyLoop {
        /// The loop.
        name: String,
    },
    /// More equations than unknowns, or fewer.
    #[error(
        "{equations} for {unknowns}",
        equations = counted(equations, "equation"),
        unknowns = counted(unknowns, "unknown")
    )]
    Unbalanced {
        /// Every equation, a loop as two.
        equations: Vec<String>,
        /// Every unknown.
        unknowns: Vec<String>,
    },
    /// No condition says anything of an unknown.
    #[error("no equation and no loop depends on the unknown `{name}`")]
    Undetermined {
        /// The unknown.
        name: String,
    },
    /// A condition that no unknown can fulfil.
    #[error("the {what} `{name}` depends on no unknown: it holds or not, whatever they are")]
    WithoutUnknown {
        /// `equation` or `loop`.
        what: &'static str,
        /// Its name.
        name: String,
    },
}

fn counted(names: &[String], what: &str) -> String {
    let plural = if names.len() == 1 { "" } else { "s" };
    let list = if names.is_empty() { String::new() } else { format!(" ({})", names.join(", ")) };
    format!("{} {what}{plural}{list}", names.len())
}

impl Unknown {
    /// With bounds that it never leaves, infinite where there is none.
    ///
    /// # Errors
    /// When the start does not lie between them.
    pub fn new(name: impl Into<String>, start: f64, lower: f64, upper: f64) -> Result<Self, ConditionsError> {
        let name = name.into();
        if !(start.is_finite() && lower <= start && start <= upper && lower < upper) {
            return Err(ConditionsError::StartOutside { name, start, lower, upper });
        }
        Ok(Self { name, start, lower, upper })
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Where the search for the nominal state starts.
    pub(crate) fn start(&self) -> f64 {
        self.start
    }

    /// The bounds.
    pub(crate) fn bounds(&self) -> [f64; 2] {
        [self.lower, self.upper]
    }
}

impl Condition {
    /// The names of its equations, one or two.
    pub(crate) fn equations(&self) -> Vec<String> {
        match self {
            Self::Equation { name, .. } => vec![format!("equation `{name}`")],
            Self::Loop { name, .. } => vec![format!("loop `{name}` along x"), format!("loop `{name}` along y")],
        }
    }

    /// Its formulas, each with a name for errors.
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
    /// Unknowns that start from their assembled state near the `nominal` dimensions.
    ///
    /// # Errors
    /// When a loop is empty, or there are more equations than unknowns, or fewer.
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
        Ok(Self { unknowns, conditions, nominal })
    }

    /// The unknowns.
    pub fn unknowns(&self) -> &[Unknown] {
        &self.unknowns
    }

    /// The same conditions with every formula made another.
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

    /// For every formula of the conditions, in their order: its place within its loop, None of an equation. Even places are lengths,
    /// odd ones angles.
    pub fn places(&self) -> Vec<Option<usize>> {
        let of = |condition: &Condition| match condition {
            Condition::Equation { .. } => vec![None],
            Condition::Loop { links, .. } => (0..2 * links.len()).map(Some).collect(),
        };
        self.conditions.iter().flat_map(of).collect()
    }

    /// Every formula of the conditions, in order: an equation's one, a loop's lengths and angles in turn.
    pub fn formulas(&self) -> Vec<(String, Formula)> {
        self.conditions.iter().flat_map(Condition::formulas).collect()
    }

    /// Every unknown stands in some condition and every condition depends on some unknown, in formulas of `set` from
    /// `first` on with the unknowns as variables after the `given` ones.
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
