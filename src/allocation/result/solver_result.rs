//! Result of a search for the cheapest tolerances, and the best of several searches.

use crate::allocation::requirement::constraint::kept;
use crate::allocation::result::allocation::Proof;

/// Relative difference of costs within which two ends are the same.
const SAME_END: f64 = 1e-6;

/// Tolerances with their evidence.
#[derive(Debug, Clone, PartialEq)]
pub(in crate::allocation) struct Solved {
    /// Half bands of the groups.
    pub(in crate::allocation) at: Vec<f64>,
    pub(in crate::allocation) cost: f64,
    /// Multiplier of every constraint: the saving if the bound `1` is widened to `1 + d`, per d.
    pub(in crate::allocation) multipliers: Vec<f64>,
    /// Largest violation of the conditions of Karush, Kuhn and Tucker. Stationarity is relative to the largest slope of
    /// the cost.
    pub(in crate::allocation) residual: f64,
    /// Largest value of a constraint.
    pub(in crate::allocation) value: f64,
    /// True if Lagrange's condition gave this solution in closed form.
    pub(in crate::allocation) closed: bool,
    /// True if the search converged.
    pub(in crate::allocation) converged: bool,
    /// True if sequential quadratic programming found it.
    pub(in crate::allocation) sequential: bool,
    pub(in crate::allocation) starts: Starts,
}

/// Numbers of searches from different starts.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(in crate::allocation) struct Starts {
    /// Number of searches.
    pub(in crate::allocation) begun: usize,
    /// Number that ended at the least cost.
    pub(in crate::allocation) reached: usize,
    /// Cost of the next cheapest end.
    pub(in crate::allocation) other: Option<f64>,
}

/// Greatest distance of half bands from an end, in logarithms, and greatest residual, for a search that is on its way
/// to it.
const NEAR_END: f64 = 1e-3;

/// Ends of several searches.
#[derive(Debug, Default)]
pub(in crate::allocation) struct Ends {
    best: Option<Solved>,
    /// Costs of the searches that converged.
    costs: Vec<f64>,
    /// Ends of these searches, each place once.
    places: Vec<Solved>,
    begun: usize,
}

impl Ends {
    /// Adds the end of a search. None means that it found no tolerances with values.
    pub(in crate::allocation) fn take(&mut self, found: Option<Solved>) {
        self.begun += 1;
        let Some(found) = found else { return };
        if found.converged && kept(found.value) {
            self.costs.push(found.cost);
            if self.near(&found.at, found.residual).is_none() {
                self.places.push(found.clone());
            }
        }
        if cheaper(&found, self.best.as_ref()) {
            self.best = Some(found);
        }
    }

    /// End of an earlier search that this one is about to reach.
    pub(in crate::allocation) fn near(&self, at: &[f64], residual: f64) -> Option<&Solved> {
        let close = |end: &&Solved| end.at.iter().zip(at).all(|(a, b)| libm::log(b / a).abs() <= NEAR_END);
        self.places.iter().find(close).filter(|_| residual <= NEAR_END)
    }

    /// True if the best end keeps all constraints.
    pub(in crate::allocation) fn is_feasible(&self) -> bool {
        self.best.as_ref().is_some_and(|best| kept(best.value))
    }

    /// True if the best end keeps all constraints and has converged.
    pub(in crate::allocation) fn has_ended(&self) -> bool {
        self.is_feasible() && self.best.as_ref().is_some_and(|best| best.converged)
    }

    /// Number of different costs of the ends.
    pub(in crate::allocation) fn different(&self) -> usize {
        let mut costs = self.costs.clone();
        costs.sort_unstable_by(f64::total_cmp);
        costs.dedup_by(|high, low| *high <= *low * (1.0 + SAME_END));
        costs.len()
    }

    /// Best end, with the numbers of the searches. Returns None if it breaks a constraint.
    pub(in crate::allocation) fn found(self) -> Option<Solved> {
        let best = self.best.filter(|best| kept(best.value))?;
        let same = best.cost * (1.0 + SAME_END);
        let reached = self.costs.iter().filter(|&&cost| cost <= same).count();
        let other = self.costs.iter().copied().filter(|&cost| cost > same).reduce(f64::min);
        Some(Solved { starts: Starts { begun: self.begun, reached, other }, ..best })
    }
}

/// True if an end is better than the best so far: nearer to the constraints, or cheaper.
fn cheaper(found: &Solved, best: Option<&Solved>) -> bool {
    best.is_none_or(|best| {
        (!kept(best.value) && found.value < best.value) || (kept(found.value) && found.cost < best.cost * (1.0 - 1e-9))
    })
}

/// Tolerances with their evidence, the offer of every group, and the proof.
pub(in crate::allocation) type Chosen = (Solved, Vec<usize>, Proof);
