//! Questions to a study: the commands of the command line, with their options as JSON.

use serde::Deserialize;

use crate::html::WhatIf;
use crate::task::answer::{Shown, TaskReport};
use crate::{About, AllocationReport, CompareReport, RareReport, Report, SimulationReport, SweepReport, WrittenAnew};
use sensitol::allocation::allocate_written;
use sensitol::allocation::{AllocationOptions, CostBasis, Goal, Status};
use sensitol::analysis::analyze_with;
use sensitol::assembly::Run;
use sensitol::compare::{CompareOptions, compare_with};
use sensitol::method::Options;
use sensitol::method::registry::procedure;
use sensitol::problem::Problem;
use sensitol::rare::{RareOptions, rare_with};
use sensitol::simulation::{Pace, Sampler, SimulationOptions, simulate_with};
use sensitol::sweep::sweep_with;
use sensitol_study::{AnyError, Study};

/// Default number of points of a simulation, as on the command line.
const SAMPLES: u64 = 100_000;
/// Default number of points for rare events: cheap model, costly model.
const RARE_SAMPLES: [u64; 2] = [10_000, 1000];

/// A question.
#[derive(Debug, Deserialize)]
#[serde(tag = "command", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Asked {
    /// Moments, yield, capability and sensitivities.
    Analyze {},
    /// The model itself at many points.
    Simulate {
        /// Number of points.
        samples: Option<u64>,
        /// Sampler that draws them.
        sampler: Option<SamplerName>,
        /// Target relative error of sigma.
        until: Option<f64>,
        /// Target error of the yield.
        until_yield: Option<f64>,
        /// True if the fitted surface is a control variate.
        #[serde(default)]
        control_variate: bool,
    },
    /// Small probabilities by importance sampling.
    Rare {
        /// Number of points for each characteristic.
        samples: Option<u64>,
        /// Target relative error of a probability.
        until: Option<f64>,
    },
    /// Every method beside a reference.
    Compare {
        /// Points of the reference.
        samples: Option<u64>,
    },
    /// An analysis along a parameter.
    Sweep {
        /// The parameter.
        over: String,
        /// Values of the parameter.
        values: Vec<f64>,
    },
    /// The cheapest tolerances that keep the requirements.
    Allocate {
        /// Dimensions whose nominal values may move.
        #[serde(default)]
        recentre: Vec<String>,
        /// Least and greatest of these values.
        #[serde(default)]
        nominal_bounds: Vec<(String, [f64; 2])>,
        /// Points of the front of cost against the requirements.
        front: Option<usize>,
        /// Points of the model that confirm the result.
        confirm: Option<u64>,
        /// Relative costs in place of the study's own.
        cost: Option<CostName>,
        /// The goal in place of the least cost.
        goal: Option<GoalName>,
        /// Greatest amount that may be spent on it.
        cost_limit: Option<f64>,
    },
}

/// Relative costs in place of the study's own.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum CostName {
    /// The tolerance unit of ISO 286 by the tolerance.
    ToleranceUnit,
    /// One grade for every tolerance.
    ConstantPrecision,
    /// The same effect of every tolerance.
    EqualShares,
}

impl CostName {
    /// The relative costs of this name.
    fn basis(self) -> CostBasis {
        match self {
            Self::ToleranceUnit => CostBasis::ToleranceUnit,
            Self::ConstantPrecision => CostBasis::ConstantPrecision,
            Self::EqualShares => CostBasis::EqualShares,
        }
    }
}

/// A goal in place of the least cost.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum GoalName {
    /// The fewest rejects.
    FewestRejects,
    /// The highest Cpk.
    MostCpk,
}

impl GoalName {
    /// Returns the goal with its cost limit.
    fn within(self, cost_limit: f64) -> Goal {
        match self {
            Self::FewestRejects => Goal::FewestRejects { cost_limit },
            Self::MostCpk => Goal::MostCpk { cost_limit },
        }
    }
}

/// Sampler of points.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum SamplerName {
    /// Pseudo-random numbers.
    Random,
    /// Sobol' points.
    Sobol,
}

impl Asked {
    /// Returns the parameter of a sweep, or None for other commands.
    pub fn swept(&self) -> Option<&str> {
        match self {
            Self::Sweep { over, .. } => Some(over),
            _ => None,
        }
    }
}

/// Callback for progress: answered points, and expected points (0 if unknown).
pub type Counted<'c> = &'c dyn Fn(u64, u64);

/// Runs a command on a study.
///
/// # Errors
/// Returns the reason if a question cannot be answered.
pub fn done(study: &Study, asked: &Asked, run: &Run<'_>, counted: Counted<'_>) -> Result<TaskReport, Box<AnyError>> {
    let seed = study.seed.or(study.options.seed).unwrap_or(Options::SEED);
    let task = StudyTask { study, run, counted, seed };
    if let Asked::Analyze {} | Asked::Sweep { .. } | Asked::Allocate { .. } = asked {
        expect(study, asked, counted);
    }
    match asked {
        Asked::Analyze {} => task.analyze(),
        Asked::Simulate { samples, sampler, until, until_yield, control_variate } => {
            let mut options = SimulationOptions::default().with_seed(seed);
            let wanted = until.is_some() || until_yield.is_some();
            options.samples = samples.unwrap_or(if wanted { 1 << 52 } else { SAMPLES });
            options.sampler = match sampler {
                Some(SamplerName::Sobol) => Sampler::Sobol,
                Some(SamplerName::Random) | None => Sampler::Random,
            };
            (options.until, options.until_yield) = (*until, *until_yield);
            options.control = control_variate.then(|| study.options.clone());
            task.simulate(&options)
        }
        Asked::Rare { samples, until } => task.rare(*samples, *until),
        Asked::Compare { samples } => task.compare(*samples),
        Asked::Sweep { over, values } => task.sweep(over, values),
        Asked::Allocate { recentre, nominal_bounds, front, confirm, cost, goal, cost_limit } => {
            let mut options = AllocationOptions::default().with_analysis(study.options.clone()).with_seed(seed);
            options.recentre.clone_from(recentre);
            options.nominal_bounds.clone_from(nominal_bounds);
            options.front = *front;
            let options = options.with_confirm_or_default(&study.problem, *confirm);
            let goal = goal.zip(*cost_limit).map_or(Goal::LeastCost, |(goal, limit)| goal.within(limit));
            task.allocate(&options, cost.map(CostName::basis), goal)
        }
    }
}

/// A study with the run and the seed of a question.
struct StudyTask<'s> {
    study: &'s Study,
    run: &'s Run<'s>,
    counted: Counted<'s>,
    seed: u64,
}

impl StudyTask<'_> {
    /// The title, warnings and drawings of the study.
    fn about(&self) -> About {
        let study = self.study;
        About {
            title: study.title.clone(),
            sha256: study.sha256.clone(),
            warnings: study.warnings.clone(),
            block: study.about.clone(),
            scene: study.scene(),
        }
    }

    /// Counts the points of a run that reports its pace.
    fn count(&self, pace: Pace) {
        (self.counted)(pace.samples, pace.expected as u64);
    }

    /// Analyses the study, with densities and the data of a what-if.
    fn analyze(&self) -> Result<TaskReport, Box<AnyError>> {
        let (study, problem) = (self.study, &self.study.problem);
        let mut options = study.options.clone();
        options.densities = true;
        let found = analyze_with(problem, &options, self.run).map_err(boxed)?;
        let what_if = WhatIf::of(problem, &found, &study.lines, &study.costs);
        let report = Report::keeping(problem, found, self.about()).with_deviations(study, self.run).map_err(boxed)?;
        Ok(TaskReport::of(Shown::Analysis(Box::new((report, what_if)))))
    }

    /// Simulates the model itself.
    fn simulate(&self, options: &SimulationOptions) -> Result<TaskReport, Box<AnyError>> {
        let problem = &self.study.problem;
        let found = simulate_with(problem, options, self.run, &|pace| self.count(pace)).map_err(boxed)?;
        Ok(TaskReport::of(Shown::Simulation(SimulationReport::of(problem, &found, self.about()))))
    }

    /// Seeks rare events by so many points, or until an error.
    fn rare(&self, samples: Option<u64>, until: Option<f64>) -> Result<TaskReport, Box<AnyError>> {
        let problem = &self.study.problem;
        let costly = problem.function().signature().costly;
        let options = RareOptions::default()
            .with_samples(samples.unwrap_or(RARE_SAMPLES[usize::from(costly)]))
            .with_seed(self.seed)
            .with_surrogate(self.study.options.clone());
        let options = until.map_or(options.clone(), |until| options.with_until(until));
        let found = rare_with(problem, &options, self.run, &|pace| self.count(pace)).map_err(boxed)?;
        Ok(TaskReport::of(Shown::Rare(RareReport::of(problem, &found, self.about()))))
    }

    /// Compares every method with samples.
    fn compare(&self, samples: Option<u64>) -> Result<TaskReport, Box<AnyError>> {
        let mut options = CompareOptions::default().with_seed(self.seed);
        (options.budget, options.reference) = (self.study.options.budget, samples);
        let found = compare_with(&self.study.problem, &options, self.run).map_err(boxed)?;
        Ok(TaskReport::of(Shown::Comparison(CompareReport::of(&found, self.about()))))
    }

    /// Analyses the study along the values of a parameter.
    fn sweep(&self, over: &str, values: &[f64]) -> Result<TaskReport, Box<AnyError>> {
        let problem = &self.study.problem;
        let found = sweep_with(problem, over, values, &self.study.options, self.run).map_err(boxed)?;
        Ok(TaskReport::of(Shown::Sweep(SweepReport::of(problem, &found, self.about()))))
    }

    /// Allocates tolerances, and writes the study anew with them.
    fn allocate(
        &self,
        options: &AllocationOptions,
        basis: Option<CostBasis>,
        goal: Goal,
    ) -> Result<TaskReport, Box<AnyError>> {
        let (study, problem) = (self.study, &self.study.problem);
        let recentred = !options.recentre.is_empty();
        let task = study.allocation_task().relative_or_default(problem, basis, recentred).towards(goal);
        let in_file = |problem: &Problem| study.written_dimensions(problem);
        let found = allocate_written(problem, &task, options, self.run, &in_file).map_err(boxed)?;
        // A run that was stopped before the model had its say is not a study yet.
        let confirmed = found.after.is_some() && found.status != Status::OutOfTime;
        let anew = confirmed.then(|| study.rewritten(&found.problem));
        let (anew, not_written) = match anew {
            Some(Ok(anew)) => (Some(anew), None),
            Some(Err(error)) => (None, Some(error.to_string())),
            None => (None, None),
        };
        let written = anew
            .as_ref()
            .map(|anew| WrittenAnew { entries: anew.entries.clone(), replaced_fits: anew.replaced_fits.clone() });
        let report = AllocationReport::of(problem, &found, written.as_ref(), self.about());
        let study = anew.map(|anew| anew.text);
        Ok(TaskReport { study, not_written, ..TaskReport::of(Shown::Allocation(Box::new(report))) })
    }
}

fn boxed(error: impl Into<AnyError>) -> Box<AnyError> {
    Box::new(error.into())
}

/// Reports the least number of points that a command plans.
fn expect(study: &Study, asked: &Asked, counted: Counted<'_>) {
    let plan = procedure(study.options.method).plan(&study.problem, &study.options);
    let times = match asked {
        Asked::Sweep { values, .. } => values.len(),
        Asked::Allocate { .. } => 2,
        _ => 1,
    };
    if let Ok(plan) = plan {
        counted(0, plan.cost().0.saturating_mul(times) as u64);
    }
}
