//! What is to be allocated, and why it cannot be.

use super::cost::Priced;
use crate::dimension::Dimension;
use crate::method::{Method, MethodError, Options};
use crate::names::nearest;
use crate::problem::Problem;
use crate::requirement::Requirement;
use crate::simulation::{SimulationError, chosen};
use crate::warning::Advice;

/// Costs and requirements beside a problem.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct AllocationTask {
    /// The tolerances that may change, by groups; what no group has keeps its tolerance.
    pub priced: Vec<Priced>,
    /// For every characteristic of the problem, what it must keep.
    pub requirements: Vec<Option<Requirement>>,
}

impl AllocationTask {
    /// These costs, and for every characteristic of the problem what it must keep.
    pub fn new(priced: Vec<Priced>, requirements: Vec<Option<Requirement>>) -> Self {
        Self { priced, requirements }
    }
}

/// How tolerances are allocated.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AllocationOptions {
    /// How derivatives are taken; its budget is that of all evaluations together. [`Method::Auto`](crate::Method::Auto) stands for `full` where
    /// dimensions are few and for `six-n` where they are many: every round must ask the same.
    pub analysis: Options,
    /// Dimensions whose nominal values may move, by name.
    pub recentre: Vec<String>,
    /// Points of the front of cost against yield.
    pub front: Option<usize>,
    /// Points of the model at the tolerances found, by Monte Carlo.
    pub confirm: Option<u64>,
    /// The seed of what is drawn.
    pub seed: u64,
}

impl Default for AllocationOptions {
    fn default() -> Self {
        Self { analysis: Options::default(), recentre: Vec::new(), front: None, confirm: None, seed: Options::SEED }
    }
}

impl AllocationOptions {
    /// How derivatives of this problem are taken.
    pub(crate) fn derivatives(&self, problem: &Problem) -> Options {
        let model_figures = self.analysis.method == Method::Auto;
        Options { extremes: false, model_figures, ..chosen(problem, &self.analysis) }
    }

    /// With derivatives taken so.
    #[must_use]
    pub fn with_analysis(mut self, analysis: Options) -> Self {
        self.analysis = analysis;
        self
    }

    /// With nominal values of these dimensions that may move.
    #[must_use]
    pub fn with_recentre(mut self, names: Vec<String>) -> Self {
        self.recentre = names;
        self
    }

    /// With a front of cost against yield of so many points.
    #[must_use]
    pub fn with_front(mut self, points: usize) -> Self {
        self.front = Some(points);
        self
    }

    /// Confirmed by Monte Carlo at so many points of the model.
    #[must_use]
    pub fn with_confirm(mut self, points: u64) -> Self {
        self.confirm = Some(points);
        self
    }

    /// With this seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }
}

/// Why tolerances cannot be allocated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AllocateError {
    /// Nothing may change.
    #[error("there is nothing to choose: no tolerance has a cost, and no nominal value may move")]
    NothingToChoose,
    /// Nothing must be kept.
    #[error(
        "nothing is required: give a characteristic lower or upper and target_yield, or a require such as \"worst-case\""
    )]
    NothingRequired,
    /// A dimension with a cost has no tolerance to begin with.
    #[error("dimension `{dimension}` has a cost and no tolerance: write the present one, from which to start")]
    NoTolerance {
        /// The dimension.
        dimension: String,
    },
    /// A dimension with a cost does not follow its tolerance.
    #[error(
        "dimension `{dimension}` has a cost, but {why}: leave its cost out, or give it a distribution over its tolerance"
    )]
    DoesNotScale {
        /// The dimension.
        dimension: String,
        /// Why it does not.
        why: &'static str,
    },
    /// A dimension with two costs.
    #[error("dimension `{dimension}` has two costs")]
    TwoCosts {
        /// The dimension.
        dimension: String,
    },
    /// A dimension to be moved that is none.
    #[error("there is no dimension `{name}` to recentre{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownDimension {
        /// As given.
        name: String,
        /// The most similar one.
        nearest: Option<String>,
    },
    /// A dimension that cannot be moved.
    #[error("`{name}` cannot be recentred: {why}")]
    CannotMove {
        /// The dimension.
        name: String,
        /// Why not.
        why: &'static str,
    },
    /// No limits to be in the middle of.
    #[error("recentring needs a characteristic with limits")]
    NoLimits,
    /// A front of what is not required.
    #[error("a front of cost against yield needs costs, and a characteristic with a required yield or Cpk")]
    NoFront,
    /// As many points make no front.
    #[error("a front of cost against yield takes 2 to 200 points, not {points}")]
    FrontPoints {
        /// As given.
        points: usize,
    },
    /// A characteristic of which something is required has no moments.
    #[error("`{characteristic}` has no moments at the present tolerances: analyze says why")]
    NoMoments {
        /// The characteristic.
        characteristic: String,
    },
    /// A method that has nothing to follow tolerances on.
    #[error("{method} has no surface on which the search could follow the tolerances")]
    NoSurrogate {
        /// The method.
        method: &'static str,
    },
    /// The method does not fit the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// The problem cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Other tolerances do not go with the correlation.
    #[error(transparent)]
    Correlation(#[from] crate::correlation::CorrelationError),
    /// Other tolerances do not go with a distribution.
    #[error(transparent)]
    Dimension(#[from] crate::dimension::DimensionError),
}

impl AllocateError {
    /// What to do about it.
    pub(crate) fn advice(&self) -> Vec<Advice> {
        match self {
            Self::NothingToChoose => vec![Advice::WriteCosts, Advice::NameMovableDimensions],
            Self::NoSurrogate { .. } => {
                vec![Advice::UseMethod { methods: vec![Method::Full, Method::SixN, Method::SecondOrder] }]
            }
            Self::Method(error) => error.advice(),
            Self::Simulation(error) => error.advice(),
            _ => Vec::new(),
        }
    }
}

impl AllocationTask {
    /// Whether the task and the options fit the problem.
    pub(super) fn check(&self, problem: &Problem, options: &AllocationOptions) -> Result<(), AllocateError> {
        let dimensions = problem.dimensions();
        if !options.analysis.method.has_surrogate() {
            return Err(AllocateError::NoSurrogate { method: options.analysis.method.name() });
        }
        if self.priced.is_empty() && options.recentre.is_empty() {
            return Err(AllocateError::NothingToChoose);
        }
        if !self.priced.is_empty() && self.requirements.iter().all(Option::is_none) {
            return Err(AllocateError::NothingRequired);
        }
        let mut seen = vec![false; dimensions.len()];
        for &d in self.priced.iter().flat_map(|group| &group.members) {
            let dimension = dimensions[d].name().to_owned();
            if std::mem::replace(&mut seen[d], true) {
                return Err(AllocateError::TwoCosts { dimension });
            }
            if dimensions[d].sigma() == 0.0 {
                return Err(AllocateError::NoTolerance { dimension });
            }
            if let Some(why) = unscalable(&dimensions[d]) {
                return Err(AllocateError::DoesNotScale { dimension, why });
            }
        }
        self.check_recentre(problem, options)?;
        if let Some(points) = options.front {
            let wanted = |one: &Option<Requirement>| matches!(one, Some(Requirement::Yield(_) | Requirement::Cpk(_)));
            if self.priced.is_empty() || !self.requirements.iter().any(wanted) {
                return Err(AllocateError::NoFront);
            }
            if !(2..=200).contains(&points) {
                return Err(AllocateError::FrontPoints { points });
            }
        }
        Ok(())
    }

    fn check_recentre(&self, problem: &Problem, options: &AllocationOptions) -> Result<(), AllocateError> {
        let dimensions = problem.dimensions();
        for name in &options.recentre {
            let Some(dimension) = dimensions.iter().find(|dimension| dimension.name() == name) else {
                let nearest = nearest(name, dimensions.iter().map(Dimension::name)).map(str::to_owned);
                return Err(AllocateError::UnknownDimension { name: name.clone(), nearest });
            };
            let cannot = |why| AllocateError::CannotMove { name: name.clone(), why };
            if dimension.sigma() == 0.0 {
                return Err(cannot("it has no tolerance, so that its effect is not known; give it one"));
            }
            if dimension.moved(dimension.nominal() + dimension.half_band()).is_none() {
                return Err(cannot("its distribution does not go with its nominal value"));
            }
            if dimension.zone().is_some() {
                return Err(cannot("a position is moved by hand"));
            }
        }
        let limits = problem.characteristics().iter().any(|one| one.limits().exist());
        if !options.recentre.is_empty() && !limits {
            return Err(AllocateError::NoLimits);
        }
        Ok(())
    }
}

/// Why a dimension does not follow its tolerance.
fn unscalable(dimension: &Dimension) -> Option<&'static str> {
    let law = dimension.distribution()?;
    if law.measured().is_some() {
        return Some("it is measured, and its parts are as they are");
    }
    match dimension.scaled(1.0) {
        Some(_) => None,
        None if law.probability().is_none() => Some("it is known by its moments only"),
        None => Some("its distribution does not follow a tolerance"),
    }
}
