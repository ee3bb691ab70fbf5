//! The lines at the head of an allocation: result, effort and proof.

use super::super::allocation::AllocationReport;
use super::super::head;
use super::money;
use crate::document::number::{known, plural, short, significant};
use crate::document::{Blocks, Element, Line};
use sensitol::allocation::{AllocationSolver, CostBasis, Goal, Status};

/// A smaller residual is rounding.
const LEAST: f64 = 1e-12;

impl AllocationReport {
    /// Writes the status with its cost, the effort and the proof.
    pub(super) fn heading(&self, page: &mut Vec<Element>) {
        let status = Line::toned(self.status.name(), self.status_tone());
        page.line(status.and(format!(": {}", self.cost_change())));
        self.parts_of_cost(page);
        self.aim(page);
        self.effort(page);
        self.gap(page);
        self.optimality(page);
    }

    /// The cost after and before.
    fn cost_change(&self) -> String {
        match (self.cost_before, self.cost_after) {
            (before, Some(after)) => {
                let saved = before.map_or(String::new(), |before| {
                    let part = 100.0 * (1.0 - after / before);
                    let word = if part < 0.0 { "more" } else { "less" };
                    format!(" instead of {}, {} % {word}", money(before), significant(part.abs(), 3))
                });
                format!("cost {}{saved}", money(after))
            }
            (Some(before), None) => format!("cost {} before", money(before)),
            (None, None) => "nominal values moved".to_owned(),
        }
    }

    /// Writes the parts of the cost: losses, machines, steps and grades.
    fn parts_of_cost(&self, page: &mut Vec<Element>) {
        if let Some(loss) = self.loss.after {
            let before = self.loss.before.map(|loss| format!(", before {}", money(loss)));
            page.line(format!("of the cost {} is quality loss and scrap{}", money(loss), before.unwrap_or_default()));
        }
        if !self.setups.is_empty() {
            let named = self.setups.iter().map(|one| format!("{} {}", short(&one.machine), money(one.cost)));
            page.line(format!("of the cost, setting up: {}", named.collect::<Vec<_>>().join(", ")));
        }
        if let (Some(free), Some(cost)) = (self.cost_unrounded, self.cost_after) {
            let more = significant(100.0 * (cost / free - 1.0).max(0.0), 2);
            page.line(format!("steps and grades cost {more} % more than free tolerances, which cost {}", money(free)));
        }
    }

    /// Writes the goal in place of the least cost, and the basis of relative costs.
    fn aim(&self, page: &mut Vec<Element>) {
        match self.goal {
            Goal::LeastCost => {}
            Goal::MostCpk { cost_limit } => page.line(format!("the highest Cpk for a cost of {}", money(cost_limit))),
            Goal::FewestRejects { cost_limit } => {
                page.line(format!("the fewest rejects for a cost of {}", money(cost_limit)))
            }
        }
        let basis = match self.cost_basis {
            CostBasis::Given => "",
            CostBasis::ToleranceUnit => "",
            CostBasis::ConstantPrecision => "; the same grade everywhere",
            CostBasis::EqualShares => "; the same effect everywhere",
        };
        if self.cost_basis != CostBasis::Given {
            page.line(format!(
                "relative cost i/T, with i the tolerance unit of ISO 286 for the size, in mm unless the unit says otherwise; where there is no size, the tolerance as written{basis}"
            ));
        }
    }

    /// Writes the evaluations that it took.
    fn effort(&self, page: &mut Vec<Element>) {
        let sampled = self.confirmation.as_ref().map_or(0, |confirmation| confirmation.samples);
        // A round of the allocation may ask a program more than once.
        let batches = self
            .run
            .evaluator
            .map_or(String::new(), |_| format!(", sent in {}", plural(self.run.stages as usize, "batch", "batches")));
        page.line(format!(
            "{} in {}{batches}{}{}{}{}",
            plural(self.run.evaluations.saturating_sub(sampled) as usize, "evaluation", "evaluations"),
            plural(self.rounds, "round", "rounds"),
            head::beside(&self.run),
            match self.model_points {
                0 => String::new(),
                points => format!(", corrected by {points} points of the model"),
            },
            match self.status {
                Status::NoFeasiblePointFound => ", which end at tolerances that miss a requirement",
                Status::Inconclusive => ", which end at tolerances whose verdict is inconclusive",
                _ if self.proof.solver == Some(AllocationSolver::VerifiedSearch) => {
                    "; found by trials of the model"
                }
                // The tolerances before are the best that was found.
                _ if self.proof.residual.is_some_and(f64::is_infinite) => "",
                _ if self.confirmed && self.cost_after.is_some() => "; moments re-evaluated at the optimum: agree",
                _ => "",
            },
            if sampled > 0 { format!("; {sampled} more evaluations to confirm") } else { String::new() }
        ));
    }

    /// Writes the gap to the bound of every choice of processes.
    fn gap(&self, page: &mut Vec<Element>) {
        let proof = &self.proof;
        if let Some(gap) = proof.gap {
            let basis = if proof.bound_is_exact == Some(true) { "" } else { ", as far as a sample of choices tells" };
            let than = match gap <= 1e-9 {
                true => format!("{basis} ("),
                false => {
                    let (bound, gap) = (known(proof.bound, money), significant(100.0 * gap, 2));
                    format!(" than {bound}{basis}: a gap of {gap} % (")
                }
            };
            page.line(format!("no choice of processes costs less{than}{} nodes)", proof.nodes));
        }
    }

    /// Writes the residual of the conditions of an optimum, and the starts that reached it.
    fn optimality(&self, page: &mut Vec<Element>) {
        let proof = &self.proof;
        match proof.residual {
            Some(residual) if residual.is_finite() => {
                let closed = if proof.closed_form { ", Lagrange's solution in closed form" } else { "" };
                // The next power of ten, and no more than doubles tell.
                let within = 10f64.powi(libm::log10(residual.max(LEAST)).ceil() as i32);
                page.line(format!("KKT residual below {within:.0e}{closed}"));
            }
            Some(_) if self.cost_after.is_none() => {}
            Some(_) => page.line("KKT residual unknown: no cheaper tolerances were found"),
            None => {}
        }
        if let (Some(starts), Some(reached)) = (proof.starts, proof.reached) {
            let other = match proof.other_optimum {
                Some(cost) => format!("; the next cheapest optimum costs {}", money(cost)),
                None => String::new(),
            };
            page.line(format!("{reached} of {starts} starts end at this optimum, the cheapest found{other}"));
        }
    }
}
