//! Account of `auto`: its findings, and the use of its points.

use std::fmt;

use serde::Serialize;

use crate::analysis::CharacteristicAnalysis;
use crate::method::{ClimbEnd, Outcome};
use crate::problem::Problem;

/// Greatest number of dimensions that are named in a sentence.
const NAMED: usize = 8;
/// Share of the variance below which a curvature counts as zero. It must be below it in every characteristic.
const STRAIGHT: f64 = 1e-8;

/// Shapes of the dimensions that `auto` found, and the use of its points. The text form is a sentence.
#[derive(Debug, Clone, PartialEq, Eq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct Account {
    /// Dimensions that vary and matter.
    pub varying: usize,
    /// Dimensions that act along straight lines: two points each.
    pub straight: Vec<String>,
    /// Dimensions that act along parabolas: two points each.
    pub curved: Vec<String>,
    /// Dimensions that need more than a parabola: four points each.
    pub refined: Vec<String>,
    /// Possible interactions.
    pub possible_interactions: usize,
    /// Interactions that were examined one by one.
    pub examined: usize,
    /// Interactions that are known from the formulas, in every characteristic.
    pub from_formulas: usize,
    /// Probes of one or two points that move all dimensions to search for interactions.
    pub probes: usize,
    /// Check points of the surrogate.
    pub checks: usize,
    /// Points of the model from which the moments follow, if the surrogate was not trusted.
    pub samples: Option<u64>,
    /// Evaluations of the search, without those of `samples`.
    pub evaluations: usize,
    /// Evaluations that every second derivative would take, `N² + N + 1`.
    pub full_evaluations: usize,
    /// Reason of the end of the search.
    pub rest: ClimbEnd,
}

impl Account {
    /// Returns None for other methods, and if nothing varies.
    pub(super) fn of(
        problem: &Problem,
        outcome: &Outcome,
        characteristics: &[CharacteristicAnalysis],
        evaluations: usize,
    ) -> Option<Self> {
        let climbed = outcome.climbed.as_ref()?;
        let plan = &outcome.plan;
        let n = plan.varying().len();
        if n == 0 {
            return None;
        }
        let straight = |j: usize| {
            let share = |one: &CharacteristicAnalysis| one.sensitivities[plan.varying()[j]].curvature_share;
            characteristics.iter().all(|one| share(one).is_some_and(|share| share < STRAIGHT))
        };
        let three: Vec<usize> = (0..n).filter(|j| !climbed.refined.contains(j)).collect();
        let (lines, parabolas): (Vec<usize>, Vec<usize>) = three.into_iter().partition(|&j| straight(j));
        let names = |positions: &[usize]| {
            let name = |&j: &usize| problem.dimensions()[plan.varying()[j]].name().to_owned();
            positions.iter().map(name).collect::<Vec<String>>()
        };
        Some(Self {
            varying: n,
            straight: names(&lines),
            curved: names(&parabolas),
            refined: names(&climbed.refined),
            possible_interactions: plan.possible_pairs(),
            examined: climbed.direct,
            from_formulas: climbed.from_formulas,
            probes: climbed.probes,
            checks: climbed.checks,
            samples: characteristics
                .iter()
                .filter_map(|one| one.evidence.model_sampled.as_ref())
                .map(|one| one.samples)
                .max(),
            evaluations,
            full_evaluations: n * n + n + 1,
            rest: climbed.rest,
        })
    }
}

fn list(names: &[String]) -> String {
    let named = names.iter().take(NAMED).map(String::as_str).collect::<Vec<_>>().join(", ");
    if names.len() > NAMED { format!("{named} and {} more", names.len() - NAMED) } else { named }
}

impl fmt::Display for Account {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let be = |names: &[String], one: &'static str, many: &'static str| if names.len() == 1 { one } else { many };
        let mut parts = Vec::new();
        if self.straight.len() == self.varying {
            parts.push("all dimensions act along straight lines: 2 points each".to_owned());
        } else if !self.straight.is_empty() {
            let act = be(&self.straight, "acts along a straight line", "act along straight lines");
            parts.push(format!("{} {act}: 2 points each", list(&self.straight)));
        }
        if !self.curved.is_empty() {
            let are = be(&self.curved, "is curved", "are curved");
            parts.push(format!("{} {are}: 2 points each", list(&self.curved)));
        }
        if !self.refined.is_empty() {
            let are = be(&self.refined, "is", "are");
            parts.push(format!("{} {are} more than a parabola: 4 points each", list(&self.refined)));
        }
        let possible = self.possible_interactions;
        parts.push(match (self.probes, self.examined) {
            _ if possible == 0 => "no interactions possible".to_owned(),
            (0, 0) if self.from_formulas == possible && self.straight.len() == self.varying => {
                "no interactions, by the formulas".to_owned()
            }
            (0, 0) if self.from_formulas == possible => format!("all {possible} interactions by the formulas"),
            (0, 0) if self.rest != ClimbEnd::Reached => format!("no interaction of {possible} examined"),
            (0, 0) => format!("no interactions of {possible} needed"),
            (0, direct) => format!("{direct} of {possible} interactions examined one by one"),
            (probes, 0) => format!("interactions sought by {probes} probes that move all dimensions"),
            (probes, direct) => format!("{probes} probes, {direct} of {possible} interactions examined one by one"),
        });
        parts.push(format!("{} points check", self.checks));
        parts.push(match self.samples {
            Some(samples) => format!("the model was sampled at {samples} points more"),
            None => format!(
                "{} evaluations where every second derivative takes {}",
                self.evaluations, self.full_evaluations
            ),
        });
        match self.rest {
            ClimbEnd::Budget => parts.push("the budget ended it".to_owned()),
            ClimbEnd::Stopped => parts.push("stopped before it was done".to_owned()),
            ClimbEnd::Reached | ClimbEnd::Exhausted => {}
        }
        f.write_str(&parts.join("; "))
    }
}
