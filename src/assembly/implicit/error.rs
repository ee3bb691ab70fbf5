//! Why there is no assembled state at one point.

use crate::assembly::formula::FormulaFailure;

/// A point at which the assembly does not close, or not as it does at the nominal dimensions.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AssemblyFailure {
    /// No state was found that fulfils every condition.
    #[error("the assembly does not close{}: {worst} is off by {}{} at {}{}", if *.nominal { " at the nominal dimensions" } else { "" }, short(*.residual), begun(.start), state(.at), bounded(.bound) + &so_far(.followed))]
    Open {
        /// Whether it is the nominal state, sought from the start values.
        nominal: bool,
        /// The condition that is worst off, relative to the size of its terms.
        worst: String,
        /// Its value, where it should be 0.
        residual: f64,
        /// Its value at the start, where the search for the nominal state began.
        start: Option<f64>,
        /// The unknowns at the best state found.
        at: Vec<(String, f64)>,
        /// An unknown that stands at its bound there.
        bound: Option<(String, f64)>,
        /// How far of the way from the nominal dimensions to the point the state could be followed.
        followed: Option<f64>,
    },
    /// The conditions do not determine the unknowns: a position in which the assembly can move or jam.
    #[error("the assembly is singular{}: nothing holds `{unknown}`, and {worst} is off by {} at {}{}", if *.nominal { " at the nominal dimensions" } else { "" }, short(*.residual), state(.at), so_far(.followed))]
    Singular {
        /// Whether it is the nominal state.
        nominal: bool,
        /// The unknown that is held least.
        unknown: String,
        /// The condition that fails to hold it.
        worst: String,
        /// Its value, where it should be 0.
        residual: f64,
        /// The unknowns there.
        at: Vec<(String, f64)>,
        /// How far of the way from the nominal dimensions to the point the state could be followed.
        followed: Option<f64>,
    },
    /// The only state found is another way of assembling.
    #[error("the assembly jumps to another branch: `{unknown}` would be {}, but can be followed from its nominal {} for {:.1} % of the way only", short(*.found), short(*.nominal), 100.0 * .followed)]
    OtherBranch {
        /// The unknown that differs most from what it should be near.
        unknown: String,
        /// Its value at the nominal dimensions.
        nominal: f64,
        /// Its value in the state found.
        found: f64,
        /// How far of the way from the nominal dimensions to the point the state could be followed.
        followed: f64,
    },
    /// A formula of a condition has no value where the search starts.
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

/// Six digits say where a state is.
fn short(value: f64) -> String {
    let text = format!("{value:.6e}");
    text.parse::<f64>().map_or(text, |value| value.to_string())
}
