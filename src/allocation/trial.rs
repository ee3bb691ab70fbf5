//! A trial: tolerances judged by the analysis that `analyze --check` makes of the same study.
//!
//! Derivatives say where to search. Whether a requirement is kept is said by the trial alone, so that an allocation and an analysis of what
//! it wrote end with the same verdict.

use super::cost::{Offer, Priced};
use super::driver::{Driver, cost, with_choice};
use super::loss::QualityLoss;
use super::rejects::of_scores;
use super::setup::needed;
use super::task::Goal;
use crate::analysis::{Analysis, Findings, analyze_keeping};
use crate::method::{Method, MethodError, Options};
use crate::problem::Problem;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::verdict::{Judged, Verdict, worst};

/// The excess over 1 of a use that is not kept for certain, where the use itself says otherwise.
const OPEN: f64 = 1e-9;

/// Tolerances, and how they keep what is required.
pub(super) struct Trial {
    pub(super) problem: Problem,
    /// Half bands of the groups, and the offer of each.
    pub(super) at: Vec<f64>,
    pub(super) offers: Vec<usize>,
    /// All costs, losses by the analysis included.
    pub(super) cost: f64,
    pub(super) loss: f64,
    pub(super) analysis: Analysis,
    /// The findings of the analysis; None where it is that of the station.
    pub(super) findings: Option<Findings>,
    /// Every requirement, the joint yield last.
    pub(super) judged: Vec<Judged>,
}

impl Trial {
    /// The worst verdict; met where nothing is required.
    pub(super) fn verdict(&self) -> Verdict {
        worst(self.judged.iter().map(|one| one.verdict)).unwrap_or(Verdict::Met)
    }

    /// Whether everything is kept.
    pub(super) fn is_kept(&self) -> bool {
        self.verdict() == Verdict::Met
    }

    /// Whether some requirement is inconclusive because nothing is known of an error, so that no other tolerances would say more.
    pub(super) fn is_unknown(&self) -> bool {
        self.verdict() == Verdict::Inconclusive
            && self.judged.iter().all(|one| one.verdict == Verdict::Met || one.interval.is_none())
    }

    /// The part of every requirement that is used, by the pessimistic end of its interval: at most 1 where it is kept.
    pub(super) fn uses(&self) -> Vec<f64> {
        self.judged.iter().map(use_of).collect()
    }

    /// The largest of these.
    pub(super) fn use_(&self) -> f64 {
        self.uses().into_iter().fold(0.0, f64::max)
    }
}

/// The part of a requirement that is used: of sums of normal dimensions a sum of squares of the tolerances, of a worst case a sum.
fn use_of(judged: &Judged) -> f64 {
    let Some([low, high]) = judged.interval else { return f64::INFINITY };
    let used = match judged.requirement {
        Requirement::Yield(target) => of_scores((1.0 - low).max(0.0), 1.0 - target).powi(2),
        Requirement::Cpk(target) if low > 0.0 => (target / low).powi(2),
        Requirement::Cpk(_) => f64::INFINITY,
        Requirement::Sigma(target) => (high / target).powi(2),
        Requirement::Rss => high * high,
        Requirement::WorstCase => high,
    };
    match judged.verdict {
        _ if used.is_nan() => f64::INFINITY,
        Verdict::Met => used.min(1.0),
        Verdict::Missed | Verdict::Inconclusive => used.max(1.0 + OPEN),
    }
}

/// The requirements of a task: what it says of every characteristic, and what `--check` asks of the same ones besides.
pub(super) fn required_of(problem: &Problem, requirements: &[Option<Requirement>]) -> Vec<(usize, Requirement)> {
    let mut all = Vec::new();
    for (c, primary) in requirements.iter().enumerate().filter_map(|(c, one)| Some((c, (*one)?))) {
        let others = problem.characteristics()[c].requirements();
        all.push((c, primary));
        all.extend(others.into_iter().filter(|other| *other != primary).map(|other| (c, other)));
    }
    all
}

impl Driver<'_> {
    /// Whether a trial costs nothing but time.
    pub(super) fn is_cheap(&self, problem: &Problem) -> bool {
        !problem.function().signature().costly && self.options.analysis.budget.is_none()
    }

    /// Whether stations are analysed as `analyze --check` does, so that a trial of one is known.
    pub(super) fn stations_are_trials(&self) -> bool {
        self.options.analysis.method != Method::Auto && !self.options.analysis.extremes
    }

    /// The requirements as an analysis judges them, the joint yield last.
    pub(super) fn judged_by(&self, analysis: &Analysis) -> Vec<Judged> {
        let of = |&(c, requirement): &(usize, Requirement)| analysis.characteristics[c].judge(requirement);
        let joint = analysis.joint_requirement.filter(|_| self.task.goal == Goal::LeastCost);
        self.required.iter().map(of).chain(joint).collect()
    }

    /// Whether an analysis keeps all that is required.
    pub(super) fn keeps_everything(&self, analysis: &Analysis) -> bool {
        self.judged_by(analysis).iter().all(|one| one.verdict == Verdict::Met)
    }

    /// A trial of tolerances that were analysed.
    pub(super) fn trial_of(
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

    /// Costs of tolerances with their processes and what machines cost to set up.
    pub(super) fn held_cost(&self, at: &[f64], offers: &[usize]) -> f64 {
        let chosen: Vec<&Offer> =
            self.task.priced.iter().zip(offers).map(|(group, &offer)| &group.offers[offer]).collect();
        let setups: f64 = needed(&self.task.setups, &chosen).iter().map(|setup| setup.cost).sum();
        cost(&self.task.priced, at, offers) + setups
    }

    /// The analysis that `analyze --check` makes; None where it cannot be made, or the budget does not reach.
    pub(super) fn checked(&mut self, problem: &Problem) -> Option<(Analysis, Findings)> {
        let costly = !self.is_cheap(problem);
        let spent = usize::try_from(self.spent.run.evaluations).unwrap_or(usize::MAX);
        let budget = self.options.analysis.budget.map(|budget| budget.saturating_sub(spent));
        let options = Options { budget, ..self.options.analysis.clone() };
        let found: Result<_, MethodError> = analyze_keeping(problem, &options, self.run);
        let (analysis, findings) = found.ok()?;
        if costly {
            self.spent.run = self.spent.run.and(&analysis.run);
        }
        self.spent.stopped |= analysis.run.unfinished();
        (!analysis.run.unfinished()).then_some((analysis, findings))
    }

    /// A trial of a problem with these half bands and offers.
    pub(super) fn trial(&mut self, base: &Problem, at: &[f64], offers: &[usize]) -> Option<Trial> {
        let problem = with_choice(base.clone(), &self.task.priced, at, offers).ok()?;
        let (analysis, findings) = self.checked(&problem)?;
        Some(self.trial_of(problem, (at.to_vec(), offers.to_vec()), analysis, Some(findings)))
    }

    /// Whether the study keeps everything as it is written, with the digits that stand in its file.
    pub(super) fn is_kept_as_written(&mut self, problem: &Problem) -> bool {
        let Some(written) = self.written.filter(|_| self.is_cheap(problem)) else { return true };
        // A study that cannot be written has nothing that could be checked.
        let Some(dimensions) = written(problem) else { return true };
        let Ok(problem) = problem.clone().with_dimensions(dimensions) else { return true };
        match self.checked(&problem) {
            Some((analysis, _)) => self.keeps_everything(&analysis),
            None => true,
        }
    }

    /// The offers that hold the tolerances of a problem at the least cost, with that cost; None where none does.
    pub(super) fn holding(&self, problem: &Problem) -> Option<Vec<usize>> {
        let of = |group: &Priced| {
            let (_, held) = group.holding(group.tightest_member(problem))?;
            group.offers.iter().position(|offer| std::ptr::eq(offer, held))
        };
        self.task.priced.iter().map(of).collect()
    }
}

impl QualityLoss {
    /// Its value by the figures of an analysis; None where one is unknown.
    pub(super) fn by_analysis(&self, analysis: &Analysis) -> Option<f64> {
        let one = &analysis.characteristics[self.characteristic];
        let moments = one.moments?;
        let squares = self.k * (moments.sigma().powi(2) + (moments.mean() - self.target).powi(2));
        let scrapped = match self.scrap {
            0.0 => 0.0,
            price => price * one.capability?.rejected()?,
        };
        Some(squares + scrapped)
    }
}

/// Whether every group may have its half band by the offers that there are.
pub(super) fn is_offered(priced: &[Priced], at: &[f64]) -> bool {
    /// A part of a bound that rounding may make.
    const ROUNDING: f64 = 1e-9;
    priced.iter().zip(at).all(|(group, &t)| match &group.offers[..] {
        [offer] => t >= offer.min * (1.0 - ROUNDING) && t <= offer.max * (1.0 + ROUNDING),
        _ => t >= group.tightest() * (1.0 - ROUNDING),
    })
}
