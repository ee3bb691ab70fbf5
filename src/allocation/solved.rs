//! Where a search for the cheapest tolerances ended, and what the ends of several have in common.

use super::constraint::kept;
use super::result::Proof;

/// Ends whose costs differ by a smaller part are one.
const SAME_END: f64 = 1e-6;

/// Tolerances with what proves them.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Solved {
    /// Half bands of the groups.
    pub(super) at: Vec<f64>,
    pub(super) cost: f64,
    /// One for every constraint: what it would save to have `1 + d` in place of 1, per d.
    pub(super) multipliers: Vec<f64>,
    /// The largest violation of the conditions of Karush, Kuhn and Tucker; stationarity relative to the largest slope of the cost.
    pub(super) residual: f64,
    /// The largest value of a constraint.
    pub(super) value: f64,
    /// Whether Lagrange's condition had this solution in closed form.
    pub(super) closed: bool,
    /// Whether it ended by itself.
    pub(super) converged: bool,
    /// Whether sequential quadratic programming found it.
    pub(super) sequential: bool,
    pub(super) starts: Starts,
}

/// From where a search for the cheapest tolerances began.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(super) struct Starts {
    /// How many searches.
    pub(super) begun: usize,
    /// How many ended at the cheapest.
    pub(super) reached: usize,
    /// The cost of the next cheapest end.
    pub(super) other: Option<f64>,
}

/// Half bands this near to an end, in logarithms, with a residual as small, are on their way to it.
const NEAR_END: f64 = 1e-3;

/// The ends of several searches.
#[derive(Debug, Default)]
pub(super) struct Ends {
    best: Option<Solved>,
    /// Costs of the searches that ended by themselves,
    costs: Vec<f64>,
    /// and where they ended, each place once.
    places: Vec<Solved>,
    begun: usize,
}

impl Ends {
    /// The end of another search; None where it found no tolerances with values.
    pub(super) fn take(&mut self, found: Option<Solved>) {
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

    /// The end that a search is about to reach, if an earlier one ended there.
    pub(super) fn near(&self, at: &[f64], residual: f64) -> Option<&Solved> {
        let close = |end: &&Solved| end.at.iter().zip(at).all(|(a, b)| libm::log(b / a).abs() <= NEAR_END);
        self.places.iter().find(close).filter(|_| residual <= NEAR_END)
    }

    /// Whether the best keeps all constraints.
    pub(super) fn is_feasible(&self) -> bool {
        self.best.as_ref().is_some_and(|best| kept(best.value))
    }

    /// Whether the best keeps all constraints, and ended by itself.
    pub(super) fn has_ended(&self) -> bool {
        self.is_feasible() && self.best.as_ref().is_some_and(|best| best.converged)
    }

    /// How many different costs they have.
    pub(super) fn different(&self) -> usize {
        let mut costs = self.costs.clone();
        costs.sort_unstable_by(f64::total_cmp);
        costs.dedup_by(|high, low| *high <= *low * (1.0 + SAME_END));
        costs.len()
    }

    /// The best, if it keeps all constraints, with what the other searches found.
    pub(super) fn found(self) -> Option<Solved> {
        let best = self.best.filter(|best| kept(best.value))?;
        let same = best.cost * (1.0 + SAME_END);
        let reached = self.costs.iter().filter(|&&cost| cost <= same).count();
        let other = self.costs.iter().copied().filter(|&cost| cost > same).reduce(f64::min);
        Some(Solved { starts: Starts { begun: self.begun, reached, other }, ..best })
    }
}

/// Whether an end is better than the best so far: nearer to what is required, or cheaper.
fn cheaper(found: &Solved, best: Option<&Solved>) -> bool {
    best.is_none_or(|best| {
        (!kept(best.value) && found.value < best.value) || (kept(found.value) && found.cost < best.cost * (1.0 - 1e-9))
    })
}

/// Tolerances, the offer of every group, and what proves them.
pub(super) type Chosen = (Solved, Vec<usize>, Proof);
