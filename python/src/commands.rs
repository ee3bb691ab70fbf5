//! What a study can be asked for: the commands of the command line, with their options as JSON.

use std::sync::atomic::{AtomicU64, Ordering};

use sensitol::allocation::{AllocationOptions, CostBasis, Status, allocate_with};
use sensitol::assembly::Run;
use sensitol::compare::{CompareOptions, compare_with};
use sensitol::internals::{Draws, WhatIf, procedure};
use sensitol::rare::{RareOptions, rare_with};
use sensitol::report::{
    About, AllocationReport, CompareReport, RareReport, Report, SimulationReport, SweepReport, WrittenAnew,
};
use sensitol::simulation::{Pace, Sampler, SimulationOptions, simulate_with};
use sensitol::sweep::sweep_with;
use sensitol::{Error, Options, Study, analyze_with};
use serde::Deserialize;

use crate::outcome::{Found, Shown};

/// Points of a simulation unless the caller says otherwise, as the command line has it.
const SAMPLES: u64 = 100_000;
/// The same of rare events, of a cheap model and of a costly one.
const RARE_SAMPLES: [u64; 2] = [10_000, 1000];

/// What is asked.
#[derive(Debug, Deserialize)]
#[serde(tag = "command", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Asked {
    Analyze {},
    Simulate {
        samples: Option<u64>,
        sampler: Option<SamplerName>,
        until: Option<f64>,
        until_yield: Option<f64>,
        #[serde(default)]
        control_variate: bool,
    },
    Rare {
        samples: Option<u64>,
        until: Option<f64>,
    },
    Compare {
        samples: Option<u64>,
    },
    Sweep {
        over: String,
        values: Vec<f64>,
    },
    Allocate {
        #[serde(default)]
        recentre: Vec<String>,
        #[serde(default)]
        nominal_bounds: Vec<(String, [f64; 2])>,
        front: Option<usize>,
        confirm: Option<u64>,
        cost: Option<CostName>,
    },
}

/// Relative costs in place of the study's own.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum CostName {
    ToleranceUnit,
    ConstantPrecision,
    EqualShares,
}

/// How points are drawn.
#[derive(Debug, Clone, Copy, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub(crate) enum SamplerName {
    Random,
    Sobol,
}

impl Asked {
    /// The parameter of a sweep.
    pub(crate) fn swept(&self) -> Option<&str> {
        match self {
            Self::Sweep { over, .. } => Some(over),
            _ => None,
        }
    }
}

/// How far a run is: points answered, and how many it will take; 0 where that is not known.
#[derive(Debug, Default)]
pub(crate) struct Counter {
    pub(crate) points: AtomicU64,
    pub(crate) expected: AtomicU64,
}

impl Counter {
    fn pace(&self, pace: Pace) {
        self.points.store(pace.samples, Ordering::Relaxed);
        self.expected.store(pace.expected as u64, Ordering::Relaxed);
    }
}

/// Does what is asked of a study.
pub(crate) fn done(study: &Study, asked: &Asked, run: &Run<'_>, counter: &Counter) -> Result<Found, Box<Error>> {
    let problem = &study.problem;
    let about = || About { title: study.title.clone(), sha256: study.sha256.clone(), warnings: study.warnings.clone() };
    let seed = study.seed.or(study.options.seed).unwrap_or(Options::SEED);
    let pace = |pace: Pace| counter.pace(pace);
    if let Asked::Analyze {} | Asked::Sweep { .. } | Asked::Allocate { .. } = asked {
        expect(study, asked, counter);
    }
    Ok(match asked {
        Asked::Analyze {} => {
            let mut options = study.options.clone();
            options.densities = true;
            let found = analyze_with(problem, &options, run).map_err(boxed)?;
            let what_if = WhatIf::of(problem, &found, &study.lines, &study.costs);
            Found::of(Shown::Analysis(Box::new((Report::of(problem, &found, about()), what_if))))
        }
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
            let found = simulate_with(problem, &options, run, &pace).map_err(boxed)?;
            Found::of(Shown::Simulation(SimulationReport::of(problem, &found, about())))
        }
        Asked::Rare { samples, until } => {
            let costly = problem.function().signature().costly;
            let options = RareOptions::default()
                .with_samples(samples.unwrap_or(RARE_SAMPLES[usize::from(costly)]))
                .with_seed(seed)
                .with_surrogate(study.options.clone());
            let options = until.map_or(options.clone(), |until| options.with_until(until));
            let found = rare_with(problem, &options, run, &pace).map_err(boxed)?;
            Found::of(Shown::Rare(RareReport::of(problem, &found, about())))
        }
        Asked::Compare { samples } => {
            let mut options = CompareOptions::default().with_seed(seed);
            (options.budget, options.reference) = (study.options.budget, *samples);
            let found = compare_with(problem, &options, run).map_err(boxed)?;
            Found::of(Shown::Comparison(CompareReport::of(&found, about())))
        }
        Asked::Sweep { over, values } => {
            let found = sweep_with(problem, over, values, &study.options, run).map_err(boxed)?;
            Found::of(Shown::Sweep(SweepReport::of(problem, &found, about())))
        }
        Asked::Allocate { recentre, nominal_bounds, front, confirm, cost } => {
            let mut options = AllocationOptions::default().with_analysis(study.options.clone()).with_seed(seed);
            options.recentre.clone_from(recentre);
            options.nominal_bounds.clone_from(nominal_bounds);
            (options.front, options.confirm) = (*front, confirmed_by(study, *confirm));
            let task = study.allocation_task();
            // As on the command line: relative costs where there are none, unless nominal values alone are to move.
            let basis = match cost {
                Some(CostName::ToleranceUnit) => CostBasis::ToleranceUnit,
                Some(CostName::ConstantPrecision) => CostBasis::ConstantPrecision,
                Some(CostName::EqualShares) => CostBasis::EqualShares,
                None if task.priced.is_empty() && recentre.is_empty() => CostBasis::ToleranceUnit,
                None => CostBasis::Given,
            };
            let found = allocate_with(problem, &task.relative(problem, basis), &options, run).map_err(boxed)?;
            // What was stopped before the model had its say is no study yet.
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
            let report = AllocationReport::of(problem, &found, written.as_ref(), about());
            let study = anew.map(|anew| anew.text);
            Found { study, not_written, ..Found::of(Shown::Allocation(Box::new(report))) }
        }
    })
}

/// Points of the model that confirm an allocation: as asked, or some of a cheap model, as far as a budget leaves them.
fn confirmed_by(study: &Study, asked: Option<u64>) -> Option<u64> {
    let problem = &study.problem;
    let drawn = || Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, Options::SEED).is_ok();
    let cheap = !problem.function().signature().costly && study.options.budget.is_none() && drawn();
    asked.or(cheap.then_some(SAMPLES)).filter(|&points| points > 0)
}

fn boxed(error: impl Into<Error>) -> Box<Error> {
    Box::new(error.into())
}

/// How many points of a costly model are planned, at the least.
fn expect(study: &Study, asked: &Asked, counter: &Counter) {
    let plan = procedure(study.options.method).plan(&study.problem, &study.options);
    let times = match asked {
        Asked::Sweep { values, .. } => values.len(),
        Asked::Allocate { .. } => 2,
        _ => 1,
    };
    if let Ok(plan) = plan {
        counter.expected.store(plan.cost().0.saturating_mul(times) as u64, Ordering::Relaxed);
    }
}
