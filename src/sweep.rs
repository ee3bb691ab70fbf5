//! Sweep along a parameter: moments and quantiles of characteristics at many values of one dimension.
//!
//! Every value has its own analysis, and the requests of all analyses to the model are gathered. Each round runs all of them until they
//! need points, and evaluates the missing points as one batch. Analyses that are not done run again with the answers, which costs no
//! evaluation. A method of one stage thus needs one batch for any number of values.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use serde::Serialize;

use crate::analysis::{Analysis, analyze_with};
use crate::assembly::EvaluatorAccount;
use crate::assembly::{
    AssemblyFunction, Bounds, Derivatives, Directions, EvaluationError, ModelInfo, Points, RecordedFailure, Request,
    Responses, Run, Signature,
};
use crate::evaluation::{BATCH, Evaluator, Ledger, Restoration, Restore, at_any_size};
use crate::method::{MethodError, Options};
use crate::problem::Problem;
use crate::summary::RunSummary;
use crate::warning::Warning;
use sensitol_numeric::dimension::DimensionError;
use sensitol_numeric::names::nearest;
use sensitol_numeric::time::Instant;

/// Results of a problem along one of its dimensions.
#[derive(Debug, Clone, Serialize)]
pub struct Sweep {
    /// Index of the dimension in the problem.
    pub dimension: usize,
    /// Nominal values of the dimension, in the order given.
    pub values: Vec<f64>,
    /// Analysis at every value. None if the sweep was stopped before it was done.
    pub analyses: Vec<Option<Analysis>>,
    /// Points, each once for all values, time, and the reason for an early end.
    #[serde(flatten)]
    pub run: RunSummary,
}

/// Error of a sweep.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum SweepError {
    /// The dimension does not exist.
    #[error("there is no dimension `{name}` to sweep; known: {}{}", known.join(", "), nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownDimension {
        /// Name of the dimension that was requested.
        name: String,
        /// Most similar name, if any.
        nearest: Option<String>,
        /// Names that exist.
        known: Vec<String>,
    },
    /// There is no value.
    #[error("a sweep needs at least one value")]
    NoValue,
    /// A value is infinite or NaN.
    #[error("a sweep goes over finite numbers, not {value}")]
    NotFinite {
        /// Value as given.
        value: f64,
    },
    /// The distribution does not move with the nominal value.
    #[error(
        "`{name}` cannot be swept: its distribution ({distribution}) does not move with its nominal value; give it a tolerance instead"
    )]
    Unmoved {
        /// Name of the dimension.
        name: String,
        /// Name of its distribution.
        distribution: &'static str,
    },
    /// The dimension is impossible at a value.
    #[error(transparent)]
    Dimension(#[from] DimensionError),
    /// The method does not fit the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
}

/// Analyses a problem with the nominal of one dimension at each of `values`, and an unchanged tolerance.
///
/// Evaluations: those of the method at every value, each point once, in as many batches as the method has stages. If a method needs many
/// rounds, or requests thousands of points at once, its points are evaluated directly from then on. A budget is divided equally among all
/// values. Results are verified only if [`Options::verify`] is set, since a check at every value would cost more than the analysis.
///
/// # Errors
/// If the dimension or a value is impossible, or the options do not fit the problem. No point is evaluated then. A model that fails at some
/// value is no error: unknown figures are None there.
///
/// ```
/// use sensitol::sweep::sweep;
/// use sensitol::{Closure, Dimension, Method, Problem};
/// let dimensions = [Dimension::normal("width", 20.0, 0.3)?, Dimension::fixed("height", 10.0)?];
/// let area = Problem::new(dimensions, Closure::scalar("area", |x| x[0] * x[1]))?;
/// let swept = sweep(&area, "height", &[5.0, 10.0], &Method::SecondOrder.into())?;
/// let sigma = |at: usize| swept.analyses[at].as_ref().unwrap().characteristics[0].moments.unwrap().sigma();
/// assert!((sigma(0) - 0.5).abs() < 1e-12 && (sigma(1) - 1.0).abs() < 1e-12);
/// assert_eq!((swept.run.evaluations, swept.run.stages), (6, 1));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep(problem: &Problem, dimension: &str, values: &[f64], options: &Options) -> Result<Sweep, SweepError> {
    sweep_with(problem, dimension, values, options, &Run::to_the_end())
}

/// Runs [`sweep`], and stops early if `run` is stopped. Analyses that are not done are None then.
pub fn sweep_with(
    problem: &Problem,
    dimension: &str,
    values: &[f64],
    options: &Options,
    run: &Run<'_>,
) -> Result<Sweep, SweepError> {
    at_any_size(problem, run, |problem, run| swept(problem, dimension, values, options, run))
}

impl Restore for Sweep {
    fn restore(&mut self, back: &Restoration<'_>) {
        back.add_time(&mut self.run);
        self.analyses.iter_mut().flatten().for_each(|analysis| analysis.rescale(back));
    }
}

impl Restore for SweepError {
    fn restore(&mut self, back: &Restoration<'_>) {
        if let Self::Method(error) = self {
            error.restore(back);
        }
    }
}

fn swept(
    problem: &Problem,
    dimension: &str,
    values: &[f64],
    options: &Options,
    run: &Run<'_>,
) -> Result<Sweep, SweepError> {
    let begun = Instant::now();
    let place = place(problem, dimension)?;
    if values.is_empty() {
        return Err(SweepError::NoValue);
    }
    // Make a problem for every value. All share one gatherer in place of the model.
    let gatherer = Arc::new(Gatherer::over(problem));
    let problems: Vec<Problem> = values
        .iter()
        .map(|&value| {
            if !value.is_finite() {
                return Err(SweepError::NotFinite { value });
            }
            let swept = &problem.dimensions()[place];
            let distribution = swept.distribution().map_or("", |distribution| distribution.name());
            let unmoved = || SweepError::Unmoved { name: swept.name().to_owned(), distribution };
            let moved = swept.moved(value).ok_or_else(unmoved)??;
            Ok(problem.replacing(place, moved, Arc::clone(&gatherer) as _))
        })
        .collect::<Result<_, _>>()?;
    // Divide the budget equally.
    let budget = options.budget.map(|budget| budget / values.len());
    let options = &Options { budget, verify: options.verify.or(Some(0)), ..options.clone() };
    // Check every problem before anything is evaluated.
    for problem in &problems {
        options.method.procedure().fits(problem, options)?;
    }
    let mut analyses: Vec<Option<Analysis>> = vec![None; values.len()];
    let mut stopped = false;
    // Run the open analyses, then evaluate the points that they lack, until all are done.
    for round in 1.. {
        for (problem, analysis) in problems.iter().zip(&mut analyses).filter(|(_, analysis)| analysis.is_none()) {
            if run.stopped() {
                stopped = true;
                break;
            }
            gatherer.memory().lacks = false;
            let found = analyze_with(problem, options, run)?;
            let complete = !gatherer.memory().lacks;
            stopped |= complete && found.run.unfinished();
            *analysis = (complete && !found.run.unfinished()).then_some(found);
        }
        stopped |= run.stopped();
        if stopped || !gatherer.evaluate_lacking(run) {
            break;
        }
        gatherer.memory().at_once = round >= ROUNDS;
    }
    let memory = gatherer.memory();
    stopped |= memory.stopped;
    let budget = || analyses.iter().flatten().find_map(|found| found.run.stopped);
    let stopped = if stopped { Some(run.why_open()) } else { budget() };
    let seed = analyses.iter().flatten().find_map(|found| found.run.seed);
    Ok(Sweep {
        dimension: place,
        values: values.to_vec(),
        analyses,
        run: RunSummary { wall: begun.elapsed(), seed, stopped, evaluator: problem.evaluator(), ..memory.ledger.run },
    })
}

fn place(problem: &Problem, name: &str) -> Result<usize, SweepError> {
    let names = || problem.dimensions().iter().map(|dimension| dimension.name());
    names().position(|known| known == name).ok_or_else(|| SweepError::UnknownDimension {
        name: name.to_owned(),
        nearest: nearest(name, names()).map(str::to_owned),
        known: names().map(str::to_owned).collect(),
    })
}

/// Greatest number of gathered batches. Analyses that are not done after them evaluate directly, since every round runs them again from the
/// start.
const ROUNDS: usize = 24;
/// Number of points in one request that are evaluated directly: they keep every worker busy, and no method has such a stage.
const MANY: usize = 4096;

/// Answers to one point, in the order of the problem's outputs.
type Answers = Vec<Result<f64, EvaluationError>>;

/// Function that answers from known answers, and records requested points without one.
struct Gatherer {
    problem: Problem,
    memory: Mutex<Memory>,
}

#[derive(Default)]
struct Memory {
    known: HashMap<Vec<u64>, Answers>,
    wanted: Vec<Vec<f64>>,
    /// True if the last analysis requested a point without an answer.
    lacks: bool,
    /// True if points are evaluated directly on request.
    at_once: bool,
    ledger: Ledger,
    stopped: bool,
}

fn bits(point: &[f64]) -> Vec<u64> {
    point.iter().map(|x| x.to_bits()).collect()
}

impl Gatherer {
    fn over(problem: &Problem) -> Self {
        Self { problem: problem.clone(), memory: Mutex::default() }
    }

    fn memory(&self) -> MutexGuard<'_, Memory> {
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn function(&self) -> &dyn AssemblyFunction {
        self.problem.function()
    }

    /// Evaluates the recorded points. Returns false if there are none, or the run was stopped.
    fn evaluate_lacking(&self, run: &Run<'_>) -> bool {
        let mut wanted = std::mem::take(&mut self.memory().wanted);
        let mut seen = std::collections::HashSet::new();
        wanted.retain(|point| seen.insert(bits(point)));
        if wanted.is_empty() {
            return false;
        }
        let outputs = self.problem.outputs();
        for batch in wanted.chunks((BATCH / self.problem.dimensions().len()).max(1)) {
            let evaluator = Evaluator::new(&self.problem, run);
            let out = evaluator.ask(&Points::from_rows(batch));
            let mut memory = self.memory();
            memory.ledger.add(evaluator.into_ledger());
            for (row, point) in batch.iter().enumerate() {
                let answer = |output: usize| {
                    let error = || out.error(row, output).cloned().map(Err);
                    out.value(row, output).map(Ok).or_else(error)
                };
                match (0..outputs.len()).map(answer).collect::<Option<Answers>>() {
                    Some(answers) => drop(memory.known.insert(bits(point), answers)),
                    None => memory.stopped = true,
                }
            }
            if memory.stopped {
                return false;
            }
        }
        true
    }
}

impl AssemblyFunction for Gatherer {
    fn signature(&self) -> &Signature {
        self.function().signature()
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        self.function().prepare(outputs)
    }

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        self.function().bounds(output, region)
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        self.function().magnitudes(outputs, point)
    }

    fn choice(&self, output: usize) -> Option<String> {
        self.function().choice(output)
    }

    fn evaluations_per_point(&self, outputs: &[usize]) -> usize {
        self.function().evaluations_per_point(outputs)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let rows = request.points.rows();
        // Answers are stored for all outputs only, so other requests are evaluated directly.
        let foreign = request.outputs != self.problem.outputs();
        let at_once = {
            let memory = self.memory();
            let known = |row: usize| memory.known.contains_key(&bits(&request.points.row(row)));
            foreign || ((memory.at_once || rows >= MANY) && !(0..rows).all(known))
        };
        if at_once {
            let evaluator = Evaluator::new(&self.problem, run);
            evaluator.ask_into(request.points, request.outputs, out);
            self.memory().ledger.add(evaluator.into_ledger());
            return;
        }
        let mut memory = self.memory();
        for row in 0..rows {
            let point = request.points.row(row);
            let Some(answers) = memory.known.get(&bits(&point)) else {
                memory.wanted.push(point);
                memory.lacks = true;
                continue;
            };
            for (output, answer) in answers.iter().enumerate() {
                match answer {
                    Ok(value) => out.set(row, output, *value),
                    Err(error) => out.fail(row, output, error.clone()),
                }
            }
        }
    }

    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        self.function().derivatives(outputs, directions)
    }

    fn derivatives_per(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: &[i32],
    ) -> Vec<Option<Derivatives>> {
        self.function().derivatives_per(outputs, directions, exponents)
    }

    fn account(&self) -> Option<EvaluatorAccount> {
        self.function().account()
    }

    fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
        self.function().recorded_failures(outputs)
    }

    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        self.function().warnings(outputs)
    }
}
