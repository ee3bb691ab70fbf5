//! Surrogates of a problem and their exact moments, for use as control variates.

use crate::assembly::Run;
use crate::method::{Method, Options, Outcome};
use crate::problem::Problem;
use crate::simulation::SimulationError;
use sensitol_numeric::moments::Sampled;
use sensitol_numeric::surrogate::Surrogate;

/// Greatest number of varying dimensions for which every interaction is examined.
const FULL: usize = 20;

/// Surrogates, and the analysis that they come from.
pub(crate) struct Surrogates {
    pub(crate) outcome: Outcome,
    /// Surrogates of the characteristics. None if a surrogate does not vary. Empty if the analysis was stopped.
    pub(crate) known: Vec<Option<KnownSurrogate>>,
}

/// Surrogate of one characteristic with its exact moments.
pub(crate) struct KnownSurrogate {
    pub(crate) surrogate: Surrogate,
    pub(crate) moments: Shape,
    /// Standard errors of the moments, if correlated inputs permit no closed form.
    pub(crate) sampled: Option<Sampled>,
}

/// Four moments of a surrogate that varies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Shape {
    pub(crate) mean: f64,
    pub(crate) sigma: f64,
    pub(crate) skewness: f64,
    pub(crate) kurtosis: f64,
}

impl Surrogates {
    /// Analyses the problem for its surrogates. Returns an error if a characteristic has no surrogate.
    pub(crate) fn of(problem: &Problem, asked: &Options, run: &Run<'_>) -> Result<Self, SimulationError> {
        let asked = chosen(problem, asked);
        if let Some(first) = problem.characteristics().first().filter(|_| !asked.method.has_surrogate()) {
            return Err(SimulationError::NoSurrogate {
                characteristic: first.name().to_owned(),
                method: asked.method,
                reason: "the method integrates without one".to_owned(),
            });
        }
        let outcome = asked.method.procedure().run(problem, &asked, run)?;
        let mut surrogates = Self { known: Vec::new(), outcome };
        if surrogates.outcome.evaluated.stopped().is_none() {
            let known = (0..problem.characteristics().len()).map(|c| Self::of_one(problem, &surrogates.outcome, c));
            surrogates.known = known.collect::<Result<_, _>>()?;
        }
        Ok(surrogates)
    }

    /// Surrogates of an existing analysis by characteristic. Returns None if there is none.
    pub(crate) fn known_of(problem: &Problem, outcome: &Outcome) -> Vec<Option<KnownSurrogate>> {
        (0..problem.characteristics().len()).map(|c| Self::of_one(problem, outcome, c).ok().flatten()).collect()
    }

    fn of_one(problem: &Problem, outcome: &Outcome, c: usize) -> Result<Option<KnownSurrogate>, SimulationError> {
        let unknown = |reason: &str| SimulationError::NoSurrogate {
            characteristic: problem.characteristics()[c].name().to_owned(),
            method: outcome.method,
            reason: reason.to_owned(),
        };
        let lost = || {
            let error = outcome.evaluated.known.errors().find(|&(_, of, _)| of == c);
            unknown(&error.map_or_else(|| "a derivative is unknown".to_owned(), |(.., error)| error.to_string()))
        };
        let surrogate = outcome.fitted[c].surrogate.clone().ok_or_else(lost)?;
        let found = surrogate.contributions(outcome.plan.inputs()).ok_or_else(lost)?;
        let (mean, sigma) = (found.moments.mean(), found.moments.sigma());
        let Some((skewness, kurtosis)) = found.moments.skewness().zip(found.moments.kurtosis()) else {
            return Ok(None);
        };
        if ![mean, sigma, skewness, kurtosis].iter().all(|moment| moment.is_finite()) {
            return Err(unknown("its moments are not finite"));
        }
        let moments = Shape { mean, sigma, skewness, kurtosis };
        Ok(Some(KnownSurrogate { surrogate, moments, sampled: found.sampled }))
    }
}

/// Options with a method in place of `auto`: every interaction of few dimensions, the strongest of many.
pub(crate) fn chosen(problem: &Problem, asked: &Options) -> Options {
    if asked.method != Method::Auto {
        return asked.clone();
    }
    let dependence = problem.dependence();
    let varies = |&d: &usize| problem.dimensions()[d].sigma() > 0.0 && dependence.iter().any(|row| row[d]);
    let few = (0..problem.dimensions().len()).filter(varies).count() <= FULL;
    match few && asked.pairs.is_none() && asked.stencil.is_none() {
        true => Options { method: Method::Full, ..asked.clone() },
        false => Options { method: Method::SixN, ..asked.clone() },
    }
}
