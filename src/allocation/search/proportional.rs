//! Tolerances in fixed proportions: only a common factor is chosen.

use std::rc::Rc;

use crate::allocation::cost::default_costs::{CostBasis, unit};
use crate::allocation::requirement::constraint::{Constraint, kept};
use crate::allocation::result::allocation::{AllocationSolver, Proof, Status};
use crate::allocation::result::solver_result::{Solved, Starts};
use crate::allocation::search::best_trial::{SearchEnd, SearchFailure, Searched};
use crate::allocation::search::common_factor::loosest_of;
use crate::allocation::search::driver::{Driver, Near, ROUNDS, cost, with_tolerances};
use crate::allocation::search::linearization_point::LinearizationPoint;
use crate::allocation::search::search_state::Ended;
use crate::allocation::task::AllocateError;
use crate::problem::Problem;

impl Driver<'_> {
    /// Loosest tolerances in the proportions of the task's basis that keep every requirement.
    pub(in crate::allocation) fn in_proportion(
        &mut self,
        original: &Problem,
        first: Rc<LinearizationPoint>,
        constraints: &[Constraint],
        failure: SearchFailure,
    ) -> Result<Searched, AllocateError> {
        let near = Near::of(original);
        let priced = &self.task.priced;
        let members: Vec<usize> = priced.iter().flat_map(|group| group.members.iter().copied()).collect();
        let mut at = self.proportions(&first);
        let mut ended = Ended { agreed: false, within_budget: true, at_rest: None };
        let mut station = match self.station(with_tolerances(first.problem.clone(), priced, &at)?)? {
            Some(there) => there,
            None => return Ok(Searched { end: None, failure }),
        };
        for _ in 0..ROUNDS {
            if self.spent.stopped || !station.answers(constraints) {
                break;
            }
            let Some(factor) = loosest_of(&station.responses, constraints, &members) else {
                let ones = vec![1.0; station.problem.dimensions().len()];
                // They are kept at any factor. The factor up to which they are is then not known.
                if constraints.iter().all(|one| kept(one.value_at(&station.responses, &ones))) {
                    break;
                }
                let failure = SearchFailure { status: Status::NoFeasiblePointFound, ..failure };
                return Ok(Searched { end: None, failure });
            };
            // The first factor is only as accurate as its search, so later ones must agree.
            if (factor - 1.0).abs() <= near.agree && factor >= 1.0 {
                ended.agreed = true;
                break;
            }
            at.iter_mut().for_each(|t| *t *= factor * (1.0 - near.margin));
            match self.station(with_tolerances(station.problem.clone(), priced, &at)?)? {
                Some(there) => station = there,
                None => {
                    ended.within_budget = false;
                    break;
                }
            }
        }
        let offers = vec![0; priced.len()];
        let solved = Solved {
            cost: cost(priced, &at, &offers),
            multipliers: vec![0.0; constraints.len()],
            residual: 0.0,
            value: 1.0,
            closed: false,
            converged: ended.agreed,
            sequential: false,
            starts: Starts::default(),
            at,
        };
        let proof = Proof { solver: Some(AllocationSolver::Root), ..Proof::default() };
        let (last, constraints) = (Some((solved, offers, proof)), constraints.to_vec());
        let end = SearchEnd { station: Rc::new(station), last, constraints, ended, trial: None, is_start: false };
        Ok(Searched { end: Some(end), failure })
    }

    /// Half bands in the proportions of the basis, with the same geometric mean as the present ones.
    fn proportions(&self, first: &LinearizationPoint) -> Vec<f64> {
        let dimensions = first.problem.dimensions();
        let present = |g: usize| self.task.priced[g].present(dimensions);
        let effect = |g: usize| {
            let of = |c: usize| -> f64 {
                let spread = |d: &usize| first.responses.spread(c, *d).powi(2);
                self.task.priced[g].members.iter().map(spread).sum::<f64>().sqrt()
            };
            (0..first.analysis.characteristics.len())
                .filter(|&c| self.task.requirements[c].is_some())
                .map(of)
                .fold(0.0, f64::max)
        };
        let all = 0..self.task.priced.len();
        let wanted: Vec<f64> = match self.task.basis {
            CostBasis::EqualShares => {
                all.map(|g| if effect(g) > 0.0 { present(g) / effect(g) } else { f64::NAN }).collect()
            }
            _ => all.map(|g| unit(&dimensions[self.task.priced[g].members[0]])).collect(),
        };
        let known = || wanted.iter().enumerate().filter(|(_, wanted)| wanted.is_finite());
        let count = known().count().max(1) as f64;
        let scale = libm::exp(known().map(|(g, wanted)| libm::log(present(g) / wanted)).sum::<f64>() / count);
        // A group without effect keeps its half band.
        wanted
            .iter()
            .enumerate()
            .map(|(g, wanted)| if wanted.is_finite() { wanted * scale } else { present(g) })
            .collect()
    }
}
