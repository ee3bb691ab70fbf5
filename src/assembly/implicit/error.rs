//! Errors of the assembled state at one point.

use crate::assembly::formula::FormulaFailure;
use crate::assembly::implicit::subject::{OpenJoint, short};

/// Reason why the assembly does not close at a point, or closes on another branch than at the nominal dimensions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AssemblyFailure {
    /// No state was found that fulfils every condition.
    #[error("the assembly does not close{}: {worst} is off by {}{} at {}{}", if *.nominal { " at the nominal dimensions" } else { "" }, short(*.residual), begun(.start), state(.at), bounded(.bound) + &so_far(.followed))]
    Open {
        /// True for the nominal state, which is sought from the start values.
        nominal: bool,
        /// Condition with the greatest residual, relative to the size of its terms.
        worst: String,
        /// Residual of this condition, which should be 0.
        residual: f64,
        /// Residual of this condition at the start values, for the nominal state.
        start: Option<f64>,
        /// Unknowns at the best state found.
        at: Vec<(String, f64)>,
        /// Unknown that lies at its bound in this state, with the bound.
        bound: Option<(String, f64)>,
        /// Part of the way from the nominal dimensions to the point along which the state could be followed.
        followed: Option<f64>,
    },
    /// No position of rigid parts was found in which every joint closes.
    #[error("the joints do not close{}: {joint}{}", if *.nominal { " at the nominal dimensions" } else { "" }, so_far(.followed))]
    OpenJoint {
        /// True for the nominal state, which is sought from the start values.
        nominal: bool,
        /// Joint with the greatest residual in the best position found, relative to the size of its terms.
        joint: Box<OpenJoint>,
        /// Part of the way from the nominal dimensions to the point along which the state could be followed.
        followed: Option<f64>,
    },
    /// The conditions do not determine the unknowns: a position in which the assembly can move or jam.
    #[error("the assembly is singular{}: nothing holds `{unknown}`, and {worst} is off by {} at {}{}", if *.nominal { " at the nominal dimensions" } else { "" }, short(*.residual), state(.at), so_far(.followed))]
    Singular {
        /// True for the nominal state, which is sought from the start values.
        nominal: bool,
        /// Unknown that is determined least.
        unknown: String,
        /// Condition that fails to determine it.
        worst: String,
        /// Residual of this condition, which should be 0.
        residual: f64,
        /// Unknowns in this position.
        at: Vec<(String, f64)>,
        /// Part of the way from the nominal dimensions to the point along which the state could be followed.
        followed: Option<f64>,
    },
    /// The only state found belongs to another way of assembling.
    #[error("the assembly jumps to another branch: `{unknown}` would be {}, but can be followed from its nominal {} for {:.1} % of the way only", short(*.found), short(*.nominal), 100.0 * .followed)]
    OtherBranch {
        /// Unknown that differs most from its prediction.
        unknown: String,
        /// Value of this unknown at the nominal dimensions.
        nominal: f64,
        /// Value of this unknown in the state found.
        found: f64,
        /// Part of the way from the nominal dimensions to the point along which the state could be followed.
        followed: f64,
    },
    /// A formula of a condition has no value at the start of the search.
    #[error(transparent)]
    Formula(#[from] FormulaFailure),
}

fn begun(start: &Option<f64>) -> String {
    start.map_or(String::new(), |start| format!(" (from {} at the start values)", short(start)))
}

fn state(at: &[(String, f64)]) -> String {
    at.iter().map(|(name, value)| format!("{name} = {}", short(*value))).collect::<Vec<_>>().join(", ")
}

fn bounded(bound: &Option<(String, f64)>) -> String {
    bound.as_ref().map_or(String::new(), |(name, value)| format!("; `{name}` stands at its bound {value}"))
}

fn so_far(followed: &Option<f64>) -> String {
    followed
        .map_or(String::new(), |part| format!("; it was followed for {:.1} % of the way from nominal", 100.0 * part))
}
