//! Trial: tolerances judged by the analysis that `analyze --check` makes of the same study.
//!
//! Derivatives only direct the search. The trial alone decides if a requirement is kept. An allocation and an analysis
//! of its result therefore end with the same verdict.

use crate::allocation::cost::priced_group::{Offer, Priced};
use crate::allocation::cost::setup_cost::needed;
use crate::allocation::requirement::quality_loss::QualityLoss;
use crate::allocation::requirement::registry::form_of;
use crate::allocation::search::driver::{Driver, cost, with_choice};
use crate::allocation::task::Goal;
use crate::analysis::{Analysis, Findings, analyze_keeping};
use crate::method::{Method, MethodError, Options};
use crate::problem::Problem;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::verdict::{Judged, Verdict, worst};

/// Excess over 1 that is given to a use of at most 1 if the verdict is not met.
const OPEN: f64 = 1e-9;

/// Tolerances, and their verdicts on all requirements.
pub(in crate::allocation) struct Trial {
    pub(in crate::allocation) problem: Problem,
    /// Half bands of the groups.
    pub(in crate::allocation) at: Vec<f64>,
    /// Offer of every group.
    pub(in crate::allocation) offers: Vec<usize>,
    /// Total cost, including losses by the analysis.
    pub(in crate::allocation) cost: f64,
    pub(in crate::allocation) loss: f64,
    pub(in crate::allocation) analysis: Analysis,
    /// Findings of the analysis. None if the analysis is that of the linearization point.
    pub(in crate::allocation) findings: Option<Findings>,
    /// Verdicts on all requirements, the joint yield last.
    pub(in crate::allocation) judged: Vec<Judged>,
}

impl Trial {
    /// Worst verdict. It is met if nothing is required.
    pub(in crate::allocation) fn verdict(&self) -> Verdict {
        worst(self.judged.iter().map(|one| one.verdict)).unwrap_or(Verdict::Met)
    }

    /// True if every requirement is kept.
    pub(in crate::allocation) fn is_kept(&self) -> bool {
        self.verdict() == Verdict::Met
    }

    /// True if some requirement is inconclusive because an error is unknown, so that no other tolerances would help.
    pub(in crate::allocation) fn is_unknown(&self) -> bool {
        self.verdict() == Verdict::Inconclusive
            && self.judged.iter().all(|one| one.verdict == Verdict::Met || one.interval.is_none())
    }

    /// Used part of every requirement, from the pessimistic end of its interval: at most 1 if it is kept.
    pub(in crate::allocation) fn uses(&self) -> Vec<f64> {
        self.judged.iter().map(use_of).collect()
    }

    /// Largest used part.
    pub(in crate::allocation) fn use_(&self) -> f64 {
        self.uses().into_iter().fold(0.0, f64::max)
    }
}

/// Used part of a requirement: at most 1 if its verdict is met, and above 1 if not.
fn use_of(judged: &Judged) -> f64 {
    let Some(interval) = judged.interval else { return f64::INFINITY };
    let used = form_of(&judged.requirement).used(judged.requirement.amount(), interval);
    match judged.verdict {
        _ if used.is_nan() => f64::INFINITY,
        Verdict::Met => used.min(1.0),
        Verdict::Missed | Verdict::Inconclusive => used.max(1.0 + OPEN),
    }
}

/// Requirements of a task: that of every characteristic, and the others that `--check` judges for the same
/// characteristics.
pub(in crate::allocation) fn required_of(
    problem: &Problem,
    requirements: &[Option<Requirement>],
) -> Vec<(usize, Requirement)> {
    let mut all = Vec::new();
    for (c, primary) in requirements.iter().enumerate().filter_map(|(c, one)| Some((c, (*one)?))) {
        let others = problem.characteristics()[c].requirements();
        all.push((c, primary));
        all.extend(others.into_iter().filter(|other| *other != primary).map(|other| (c, other)));
    }
    all
}

impl Driver<'_> {
    /// True if a trial costs only time: the model is cheap and there is no budget.
    pub(in crate::allocation) fn is_cheap(&self, problem: &Problem) -> bool {
        !problem.function().signature().costly && self.options.analysis.budget.is_none()
    }

    /// True if linearization points are analysed as `analyze --check` does, so that each is a trial too.
    pub(in crate::allocation) fn stations_are_trials(&self) -> bool {
        self.options.analysis.method != Method::Auto && !self.options.analysis.extremes
    }

    /// Verdicts of an analysis on the requirements, the joint yield last.
    pub(in crate::allocation) fn judged_by(&self, analysis: &Analysis) -> Vec<Judged> {
        let of = |&(c, requirement): &(usize, Requirement)| analysis.characteristics[c].judge(requirement);
        let joint = analysis.joint_requirement.filter(|_| self.task.goal == Goal::LeastCost);
        self.required.iter().map(of).chain(joint).collect()
    }

    /// True if an analysis keeps every requirement.
    pub(in crate::allocation) fn keeps_everything(&self, analysis: &Analysis) -> bool {
        self.judged_by(analysis).iter().all(|one| one.verdict == Verdict::Met)
    }

    /// Trial from tolerances and their analysis.
    pub(in crate::allocation) fn trial_of(
        &self,
        problem: Problem,
        (at, offers): (Vec<f64>, Vec<usize>),
        analysis: Analysis,
        findings: Option<Findings>,
    ) -> Trial {
        let loss: Option<f64> = self.task.losses.iter().map(|loss| loss.by_analysis(&analysis)).sum();
        let loss = loss.unwrap_or(f64::INFINITY);
        let judged = self.judged_by(&analysis);
        let cost = self.held_cost(&at, &offers) + loss;
        Trial { problem, at, offers, cost, loss, analysis, findings, judged }
    }

    /// Costs of tolerances with their processes and the set-up of machines.
    pub(in crate::allocation) fn held_cost(&self, at: &[f64], offers: &[usize]) -> f64 {
        let chosen: Vec<&Offer> =
            self.task.priced.iter().zip(offers).map(|(group, &offer)| &group.offers[offer]).collect();
        let setups: f64 = needed(&self.task.setups, &chosen).iter().map(|setup| setup.cost).sum();
        cost(&self.task.priced, at, offers) + setups
    }

    /// Runs the analysis of `analyze --check`. Returns None if it fails, is stopped, or exceeds the budget.
    pub(in crate::allocation) fn checked(&mut self, problem: &Problem) -> Option<(Analysis, Findings)> {
        let costly = !self.is_cheap(problem);
        let spent = usize::try_from(self.spent.run.evaluations).unwrap_or(usize::MAX);
        let budget = self.options.analysis.budget.map(|budget| budget.saturating_sub(spent));
        let options = Options { budget, sample_tails: false, ..self.options.analysis.clone() };
        let found: Result<_, MethodError> = analyze_keeping(problem, &options, self.run);
        let (analysis, findings) = found.ok()?;
        if costly {
            self.spent.run = self.spent.run.and(&analysis.run);
        }
        self.spent.stopped |= analysis.run.unfinished();
        (!analysis.run.unfinished()).then_some((analysis, findings))
    }

    /// Runs a trial of a problem with these half bands and offers.
    pub(in crate::allocation) fn trial(&mut self, base: &Problem, at: &[f64], offers: &[usize]) -> Option<Trial> {
        let problem = with_choice(base.clone(), &self.task.priced, at, offers).ok()?;
        let (analysis, findings) = self.checked(&problem)?;
        Some(self.trial_of(problem, (at.to_vec(), offers.to_vec()), analysis, Some(findings)))
    }

    /// True if the study keeps every requirement with the digits that stand in its file.
    pub(in crate::allocation) fn is_kept_as_written(&mut self, problem: &Problem) -> bool {
        let Some(written) = self.written.filter(|_| self.is_cheap(problem)) else { return true };
        // A study that cannot be written has nothing to check.
        let Some(dimensions) = written(problem) else { return true };
        let Ok(problem) = problem.clone().with_dimensions(dimensions) else { return true };
        match self.checked(&problem) {
            Some((analysis, _)) => self.keeps_everything(&analysis),
            None => true,
        }
    }

    /// Cheapest offer of every group that holds the tolerances of a problem. Returns None if some group has none.
    pub(in crate::allocation) fn holding(&self, problem: &Problem) -> Option<Vec<usize>> {
        let of = |group: &Priced| {
            let (_, held) = group.holding(group.tightest_member(problem))?;
            group.offers.iter().position(|offer| std::ptr::eq(offer, held))
        };
        self.task.priced.iter().map(of).collect()
    }
}

impl QualityLoss {
    /// Loss from the figures of an analysis. Returns None if one of them is unknown.
    pub(in crate::allocation) fn by_analysis(&self, analysis: &Analysis) -> Option<f64> {
        let one = &analysis.characteristics[self.characteristic];
        let moments = one.moments?;
        let squares = self.k * (moments.sigma().powi(2) + (moments.mean() - self.target).powi(2));
        let scrapped = match self.scrap {
            0.0 => 0.0,
            price => price * one.distribution.capability?.rejected()?,
        };
        Some(squares + scrapped)
    }
}

/// True if the offers allow every group its half band.
pub(in crate::allocation) fn is_offered(priced: &[Priced], at: &[f64]) -> bool {
    /// Greatest relative excess over a bound that counts as rounding.
    const ROUNDING: f64 = 1e-9;
    priced.iter().zip(at).all(|(group, &t)| match &group.offers[..] {
        [offer] => t >= offer.min * (1.0 - ROUNDING) && t <= offer.max * (1.0 + ROUNDING),
        _ => t >= group.tightest() * (1.0 - ROUNDING),
    })
}
