//! Best result for a given cost: the level of a requirement whose least cost is just that.
//!
//! ```text
//! max b   with   min cost(T) <= limit   under   Cpk >= b/3, or rejected share <= 2 sf(b)
//! ```
//!
//! The least cost grows with the level. The level is therefore a root between one that costs less and one that costs
//! more or cannot be kept. For the greatest least Cpk of several characteristics, one level is required of all.

use crate::allocation::choice::machine::choose;
use crate::allocation::choice::selection::Choice;
use crate::allocation::choice::single_offer::Setting;
use crate::allocation::requirement::constraint::Constraint;
use crate::allocation::search::driver::Driver;
use crate::allocation::task::Goal;
use crate::problem::Problem;
use sensitol_numeric::distribution::standard_normal;
use sensitol_numeric::optimise::root::root;
use sensitol_numeric::requirement::Requirement;

/// Range of levels, in sigmas: from half of the assemblies within limits to the end of doubles.
const LEVELS: [f64; 2] = [0.7, 37.0];
/// Relative difference of costs within which they are the same.
const SAME: f64 = 1e-10;

impl Goal {
    /// Requirement of this level. Returns None for the least cost.
    pub(in crate::allocation) fn at(self, level: f64) -> Option<Requirement> {
        match self {
            Self::LeastCost => None,
            Self::MostCpk { .. } => Some(Requirement::Cpk(level / 3.0)),
            Self::FewestRejects { .. } => Some(Requirement::Yield(1.0 - 2.0 * standard_normal::sf(level))),
        }
    }

    /// Greatest amount that may be spent. Returns None for the least cost.
    pub(in crate::allocation) fn cost_limit(self) -> Option<f64> {
        match self {
            Self::LeastCost => None,
            Self::MostCpk { cost_limit } | Self::FewestRejects { cost_limit } => Some(cost_limit),
        }
    }
}

impl Driver<'_> {
    /// Requirements with those of the level that costs just the limit, at the derivatives of a setting. Returns None if
    /// even the lowest level costs more.
    pub(in crate::allocation) fn levelled(
        &self,
        setting: &Setting<'_>,
        problem: &Problem,
        at: &[f64],
    ) -> Option<Vec<Constraint>> {
        let goal = self.task.goal;
        let limit = goal.cost_limit()?;
        let of_level = |level: f64| -> Vec<Constraint> {
            let sought = problem
                .characteristics()
                .iter()
                .enumerate()
                .filter(|(c, one)| one.limits().exist() && self.task.requirements[*c].is_none());
            let rows = sought.flat_map(|(c, one)| goal.at(level).map(|of| Constraint::of(c, of, one.limits())));
            setting.constraints.iter().copied().chain(rows.flatten()).collect()
        };
        let dearer = |level: f64| {
            let constraints = of_level(level);
            match choose(&Setting { constraints: &constraints, anywhere: false, ..*setting }, at) {
                Choice::Found { solved, .. } => libm::log(solved.cost / limit),
                _ => f64::INFINITY,
            }
        };
        let [low, high] = LEVELS;
        // The level just below the root is one that was found to be kept.
        (dearer(low) <= SAME).then(|| of_level(root(dearer, [low, high], 0.1 * SAME) * (1.0 - SAME)))
    }
}
