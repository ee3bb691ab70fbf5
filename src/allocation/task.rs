//! Task and options of an allocation, and its errors.

use crate::allocation::cost::default_costs::{CostBasis, relative, unscalable};
use crate::allocation::cost::priced_group::Priced;
use crate::allocation::cost::setup_cost::{MOST as MOST_MACHINES, SetUp};
use crate::allocation::requirement::quality_loss::QualityLoss;
use crate::allocation::requirement::registry::form_of;
use serde::Serialize;

use crate::method::{Method, MethodError, Options};
use crate::problem::Problem;
use crate::simulation::{SimulationError, chosen};
use crate::warning::Advice;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;
use sensitol_numeric::requirement::Requirement;
use sensitol_numeric::sampling::{Draws, Sampler};

/// Default number of points that confirm the result for a cheap model.
const CONFIRM: u64 = 100_000;

/// Costs and requirements of an allocation.
#[derive(Debug, Clone, PartialEq, Default)]
#[non_exhaustive]
pub struct AllocationTask {
    /// Groups of tolerances that may change. Dimensions outside all groups keep their tolerances.
    pub priced: Vec<Priced>,
    /// Requirement of every characteristic of the problem. None if there is none.
    pub requirements: Vec<Option<Requirement>>,
    /// Origin of the costs.
    pub basis: CostBasis,
    /// Objective of the allocation.
    pub goal: Goal,
    /// Costs of deviations and rejects.
    pub losses: Vec<QualityLoss>,
    /// Set-up costs of the machines that processes need.
    pub setups: Vec<SetUp>,
    /// Groups of dimensions that follow one tolerance each, such as the parts of a zone, for relative costs. They need no offers.
    pub zones: Vec<Priced>,
    /// Dimensions that are not tolerances, such as the place of a pin in its hole. They get no relative cost.
    pub held: Vec<usize>,
}

/// Objective of an allocation.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Goal {
    /// Least cost that keeps every requirement.
    #[default]
    LeastCost,
    /// Greatest least Cpk for a given cost, over all characteristics with limits and without a required worst case or
    /// sigma.
    MostCpk {
        /// Greatest amount that may be spent.
        cost_limit: f64,
    },
    /// Fewest rejects of the one characteristic with limits, for a given cost.
    FewestRejects {
        /// Greatest amount that may be spent.
        cost_limit: f64,
    },
}

impl AllocationTask {
    /// Creates a task from costs and the requirement of every characteristic of the problem.
    pub fn new(priced: Vec<Priced>, requirements: Vec<Option<Requirement>>) -> Self {
        Self {
            priced,
            requirements,
            basis: CostBasis::Given,
            goal: Goal::LeastCost,
            losses: Vec::new(),
            setups: Vec::new(),
            zones: Vec::new(),
            held: Vec::new(),
        }
    }

    /// Adds quality losses and scrap to the cost.
    ///
    /// ```
    /// use sensitol::allocation::{AllocationOptions, AllocationTask, Curve, Offer, Priced, QualityLoss, allocate};
    /// use sensitol::{Characteristic, Closure, Dimension, Problem};
    /// let dimensions = [Dimension::normal("a", 10.0, 0.1)?, Dimension::normal("b", 6.0, 0.1)?];
    /// let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?.asking([Characteristic::new("gap")])?;
    /// let cost = |d| Priced::new(vec![d], vec![Offer::between(Curve::reciprocal(0.0, 0.1)?, 0.01, 1.0)?]);
    /// let task = AllocationTask::new(vec![cost(0)?, cost(1)?], vec![None]).with_losses(vec![QualityLoss::new(0, 40.0, 4.0)?]);
    /// let found = allocate(&problem, &task, &AllocationOptions::default())?;
    /// // b/T + k (T/3)^2 is least at T = (9 b/2 k)^(1/3).
    /// assert!((found.tolerances[0].after - (9.0f64 * 0.1 / 80.0).cbrt()).abs() < 1e-7);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn with_losses(mut self, losses: Vec<QualityLoss>) -> Self {
        self.losses = losses;
        self
    }

    /// Adds set-up costs of machines. Each is paid once for all dimensions whose processes need the machine.
    #[must_use]
    pub fn with_setups(mut self, setups: Vec<SetUp>) -> Self {
        self.setups = setups;
        self
    }

    /// Sets the costs as a front end does: from the basis `asked` for, or from a default. The default is the given
    /// costs. If there are none, and not only nominal values may move, the default is relative costs.
    #[must_use]
    pub fn relative_or_default(self, problem: &Problem, asked: Option<CostBasis>, recentring: bool) -> Self {
        let without = self.priced.is_empty() && !recentring;
        let default = if without { CostBasis::ToleranceUnit } else { CostBasis::Given };
        self.relative(problem, asked.unwrap_or(default))
    }

    /// Sets the objective. Unless it is the least cost, it replaces the yields, Cpk and rss required of
    /// characteristics.
    ///
    /// ```
    /// use sensitol::allocation::{AllocationOptions, AllocationTask, Curve, Goal, Offer, Priced, allocate};
    /// use sensitol::{Characteristic, Closure, Dimension, Problem, SpecLimits};
    /// let dimensions = [Dimension::normal("a", 10.0, 0.1)?, Dimension::normal("b", 6.0, 0.1)?];
    /// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(3.8), Some(4.2))?);
    /// let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?.asking([gap])?;
    /// let cost = |d| Priced::new(vec![d], vec![Offer::between(Curve::reciprocal(0.0, 0.1)?, 0.01, 1.0)?]);
    /// let task = AllocationTask::new(vec![cost(0)?, cost(1)?], vec![None]);
    /// let found = allocate(&problem, &task.towards(Goal::MostCpk { cost_limit: 2.0 }), &AllocationOptions::default())?;
    /// // Both cost 1: tolerances of 0.1, sigma 0.1 by 3 and the root of 2.
    /// let cpk = found.after.unwrap().characteristics[0].distribution.capability.unwrap().cpk.unwrap();
    /// assert!((cpk - 2.0 / 2f64.sqrt()).abs() < 1e-6);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn towards(mut self, goal: Goal) -> Self {
        if goal != Goal::LeastCost {
            let stays = |one: &Requirement| !form_of(one).is_replaced_by_goals();
            self.requirements.iter_mut().for_each(|one| *one = one.filter(stays));
        }
        self.goal = goal;
        self
    }

    /// Replaces the given costs by relative ones: every tolerance that can change gets one.
    ///
    /// ```
    /// use sensitol::allocation::{AllocationOptions, AllocationTask, CostBasis, allocate};
    /// use sensitol::{Characteristic, Closure, Dimension, Problem, Requirement, SpecLimits};
    /// let dimensions = [Dimension::normal("a", 200.0, 0.05)?, Dimension::normal("b", 8.0, 0.05)?];
    /// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(191.85), Some(192.15))?);
    /// let problem = Problem::new(dimensions, Closure::scalar("gap", |x| x[0] - x[1]))?.asking([gap])?;
    /// let task = AllocationTask::new(Vec::new(), vec![Some(Requirement::Rss)]);
    /// let found = allocate(&problem, &task.relative(&problem, CostBasis::ToleranceUnit), &AllocationOptions::default())?;
    /// // By Lagrange's condition T goes as the third root of the tolerance unit: 2.8959 um at 200 mm, 0.8981 um at 8 mm.
    /// let [a, b] = [0, 1].map(|g| found.tolerances[g].after);
    /// assert!((a / b - (2.895918f64 / 0.898130).cbrt()).abs() < 1e-5);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn relative(self, problem: &Problem, basis: CostBasis) -> Self {
        match basis {
            CostBasis::Given => self,
            _ => Self { priced: relative(problem, &self.zones, &self.held), basis, ..self },
        }
    }
}

/// Options of an allocation.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct AllocationOptions {
    /// Options of the analyses. Their budget holds for all evaluations together. [`Method::Auto`](crate::Method::Auto)
    /// means `full` for few dimensions and `six-n` for many, because every round must evaluate the same points.
    pub analysis: Options,
    /// Names of the dimensions whose nominal values may move.
    pub recentre: Vec<String>,
    /// Least and greatest nominal value of dimensions that may move, by name. The default is 30 sigmas on either side
    /// in one step.
    pub nominal_bounds: Vec<(String, [f64; 2])>,
    /// Number of points on the front of cost against yield. None if there is no front.
    pub front: Option<usize>,
    /// Number of model points for a confirmation by Monte Carlo. None if there is none.
    pub confirm: Option<u64>,
    /// Seed of random points.
    pub seed: u64,
}

impl Default for AllocationOptions {
    fn default() -> Self {
        Self {
            analysis: Options::default(),
            recentre: Vec::new(),
            nominal_bounds: Vec::new(),
            front: None,
            confirm: None,
            seed: Options::SEED,
        }
    }
}

impl AllocationOptions {
    /// Options of the analysis that gives the derivatives of this problem.
    pub fn derivatives(&self, problem: &Problem) -> Options {
        let model_figures = self.analysis.method == Method::Auto;
        Options { extremes: false, model_figures, ..chosen(problem, &self.analysis) }
    }

    /// Sets the options of the analyses.
    #[must_use]
    pub fn with_analysis(mut self, analysis: Options) -> Self {
        self.analysis = analysis;
        self
    }

    /// Sets the dimensions whose nominal values may move.
    #[must_use]
    pub fn with_recentre(mut self, names: Vec<String>) -> Self {
        self.recentre = names;
        self
    }

    /// Sets the bounds of nominal values that may move.
    #[must_use]
    pub fn with_nominal_bounds(mut self, bounds: Vec<(String, [f64; 2])>) -> Self {
        self.nominal_bounds = bounds;
        self
    }

    /// Asks for a front of cost against yield with this number of points.
    #[must_use]
    pub fn with_front(mut self, points: usize) -> Self {
        self.front = Some(points);
        self
    }

    /// Sets the number of confirming points as a front end does. A given number is used, with none for 0. The default
    /// is 100,000 points for a cheap model that can be sampled, without a budget.
    #[must_use]
    pub fn with_confirm_or_default(mut self, problem: &Problem, asked: Option<u64>) -> Self {
        let drawn = || Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, self.seed).is_ok();
        let cheap = !problem.function().signature().costly && self.analysis.budget.is_none() && drawn();
        self.confirm = asked.or(cheap.then_some(CONFIRM)).filter(|&points| points > 0);
        self
    }

    /// Sets the number of model points for a confirmation by Monte Carlo.
    #[must_use]
    pub fn with_confirm(mut self, points: u64) -> Self {
        self.confirm = Some(points);
        self
    }

    /// Sets the seed.
    #[must_use]
    pub fn with_seed(mut self, seed: u64) -> Self {
        self.seed = seed;
        self
    }
}

/// Reason why tolerances cannot be allocated.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AllocateError {
    /// No tolerance has a cost, and no nominal value may move.
    #[error("there is nothing to choose: no tolerance has a cost, and no nominal value may move")]
    NothingToChoose,
    /// No requirement is given.
    #[error(
        "nothing is required: give a characteristic lower or upper and target_yield, or a require such as \"worst-case\""
    )]
    NothingRequired,
    /// Dimension with a cost but without a tolerance to begin with.
    #[error("dimension `{dimension}` has a cost and no tolerance: write the present one, from which to start")]
    NoTolerance {
        /// Name of the dimension.
        dimension: String,
    },
    /// Dimension with a cost that does not follow its tolerance.
    #[error(
        "dimension `{dimension}` has a cost, but {why}: leave its cost out, or give it a distribution over its tolerance"
    )]
    DoesNotScale {
        /// Name of the dimension.
        dimension: String,
        /// Reason why it does not.
        why: &'static str,
    },
    /// Dimension with two costs.
    #[error("dimension `{dimension}` has two costs")]
    TwoCosts {
        /// Name of the dimension.
        dimension: String,
    },
    /// Name to recentre that is not a dimension.
    #[error("there is no dimension `{name}` to recentre{}", nearest.as_ref().map(|name| format!("; did you mean `{name}`?")).unwrap_or_default())]
    UnknownDimension {
        /// Name as given.
        name: String,
        /// Most similar name of a dimension.
        nearest: Option<String>,
    },
    /// Dimension whose nominal value cannot move.
    #[error("`{name}` cannot be recentred: {why}")]
    CannotMove {
        /// Name of the dimension.
        name: String,
        /// Reason why it cannot.
        why: &'static str,
    },
    /// Losses with relative costs, which have no unit of money.
    #[error("a loss is in the unit of the costs, and relative costs have none: give the tolerances costs")]
    LossWithoutCosts,
    /// Process that needs a machine without a set-up cost.
    #[error(
        "a process of `{dimension}` needs the machine `{machine}`, which has no set-up cost: write 0 where it has none"
    )]
    UnknownMachine {
        /// Name of the dimension.
        dimension: String,
        /// Name of the machine.
        machine: String,
    },
    /// Too many machines to examine every set of them.
    #[error("there are {count} machines with set-up costs, and {most} are the most")]
    TooManyMachines {
        /// Number of machines.
        count: usize,
        /// Greatest number of machines.
        most: usize,
    },
    /// Scrap cost of a characteristic without limits.
    #[error("scrap of `{characteristic}` has a cost, but it has no limit: give it lower or upper")]
    ScrapWithoutLimits {
        /// Name of the characteristic.
        characteristic: String,
    },
    /// Loss whose cost of a deviation leaves the range of doubles.
    #[error(
        "the loss of `{characteristic}` has k = {k}, and k times the square of its values lies outside the range of double-precision numbers: choose \
         a unit in which the values are of ordinary size"
    )]
    LossOutOfRange {
        /// Name of the characteristic.
        characteristic: String,
        /// Cost per square of the unit, as given.
        k: f64,
    },
    /// Bounds of a nominal value that are not an interval, or belong to a dimension that may not move.
    #[error(
        "the bounds of the nominal value of `{name}` must be two numbers, the lower first, of a dimension that may move, not {low} and {high}"
    )]
    NominalBounds {
        /// Name of the dimension.
        name: String,
        /// Lower bound.
        low: f64,
        /// Upper bound.
        high: f64,
    },
    /// Recentring without a characteristic with limits.
    #[error("recentring needs a characteristic with limits")]
    NoLimits,
    /// Zones of which no offers keep the refinement.
    #[error(
        "every cost of `{inner}` is for {least} or more, and of `{outer}`, which it refines, for {most} or less: give `{inner}` a tighter one"
    )]
    NeverRefined {
        /// Name of the zone that refines the other.
        inner: String,
        /// Name of the wider zone.
        outer: String,
        /// Least tolerance of the first zone.
        least: f64,
        /// Greatest tolerance of the second zone.
        most: f64,
    },
    /// Goal without a characteristic that it applies to, or with too many.
    #[error(
        "to seek {what} for a cost takes costs and {of} with limits of which neither worst case nor sigma is required; there are {count}"
    )]
    NoGoal {
        /// Objective, in words.
        what: &'static str,
        /// Number of characteristics that the objective takes, in words.
        of: &'static str,
        /// Number of characteristics that there are.
        count: usize,
    },
    /// Cost limit below the cost of the loosest tolerances.
    #[error("a cost limit of {limit} is too low: the loosest tolerances within their bounds cost {least}")]
    CostLimit {
        /// Limit as given.
        limit: f64,
        /// Least cost.
        least: f64,
    },
    /// Front without costs or without a requirement.
    #[error(
        "a front of cost against what is required needs costs, and a characteristic of which something is required"
    )]
    NoFront,
    /// Number of points that is too small or too large for a front.
    #[error("a front takes 2 to 200 points, not {points}")]
    FrontPoints {
        /// Number as given.
        points: usize,
    },
    /// Characteristic with a requirement but without moments.
    #[error("`{characteristic}` has no moments at the present tolerances: analyze says why")]
    NoMoments {
        /// Name of the characteristic.
        characteristic: String,
    },
    /// Required yield of the assemblies that keep another characteristic's limits.
    #[error(
        "`{characteristic}` is given `{given}`, and tolerances are chosen by the yield of all assemblies: leave `given` out"
    )]
    Given {
        /// Name of the characteristic.
        characteristic: String,
        /// Name of the one that decides which assemblies count.
        given: String,
    },
    /// Requirement of a characteristic that follows a choice from stock.
    #[error(
        "`{characteristic}` follows {choice}: its steps leave no surface to choose tolerances by; leave [[adjust]] out"
    )]
    Chosen {
        /// Name of the characteristic.
        characteristic: String,
        /// The choice, in words.
        choice: String,
    },
    /// Method without a surface for the search.
    #[error("{method} has no surface on which the search could follow the tolerances")]
    NoSurrogate {
        /// Name of the method.
        method: &'static str,
    },
    /// Method that does not fit the problem.
    #[error(transparent)]
    Method(#[from] MethodError),
    /// Problem that cannot be simulated.
    #[error(transparent)]
    Simulation(#[from] SimulationError),
    /// Tolerances that do not fit the correlation.
    #[error(transparent)]
    Correlation(#[from] sensitol_numeric::correlation::CorrelationError),
    /// Tolerances that do not fit a distribution.
    #[error(transparent)]
    Dimension(#[from] sensitol_numeric::dimension::DimensionError),
}

impl AllocateError {
    /// Actions that may help.
    pub fn advice(&self) -> Vec<Advice> {
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

/// Checks that the yields are those of all assemblies, and that no value is chosen from a stock.
fn check_conditions(problem: &Problem) -> Result<(), AllocateError> {
    for (c, one) in problem.characteristics().iter().enumerate() {
        let characteristic = one.name().to_owned();
        if let Some(given) = one.given() {
            return Err(AllocateError::Given { characteristic, given: given.to_owned() });
        }
        if let Some(choice) = problem.choice(c) {
            return Err(AllocateError::Chosen { characteristic, choice });
        }
    }
    Ok(())
}

impl AllocationTask {
    /// Checks that the task and the options fit the problem.
    pub(super) fn check(&self, problem: &Problem, options: &AllocationOptions) -> Result<(), AllocateError> {
        let dimensions = problem.dimensions();
        if !options.analysis.method.has_surrogate() {
            return Err(AllocateError::NoSurrogate { method: options.analysis.method.name() });
        }
        if self.priced.is_empty() && options.recentre.is_empty() {
            return Err(AllocateError::NothingToChoose);
        }
        let nothing = self.requirements.iter().all(Option::is_none)
            && self.losses.is_empty()
            && self.joint_target(problem, options).is_none();
        if !self.priced.is_empty() && nothing && self.goal == Goal::LeastCost {
            return Err(AllocateError::NothingRequired);
        }
        check_conditions(problem)?;
        self.check_goal(problem)?;
        self.check_losses(problem)?;
        self.check_setups(problem)?;
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
        self.check_refinements()?;
        self.check_recentre(problem, options)?;
        if let Some(points) = options.front {
            let required =
                self.requirements.iter().any(Option::is_some) || self.joint_target(problem, options).is_some();
            if self.priced.is_empty() || !required {
                return Err(AllocateError::NoFront);
            }
            if !(2..=200).contains(&points) {
                return Err(AllocateError::FrontPoints { points });
            }
        }
        Ok(())
    }

    /// Task for a problem whose characteristics are divided by powers of two.
    ///
    /// # Errors
    ///
    /// If the cost of a deviation leaves the range of doubles.
    pub(super) fn divided(&self, problem: &Problem) -> Result<Self, AllocateError> {
        let mut task = self.clone();
        for (c, required) in task.requirements.iter_mut().enumerate() {
            *required = required.map(|required| required.times(problem.power(c).inverse()));
        }
        for loss in &mut task.losses {
            let power = problem.power(loss.characteristic);
            let out_of_range = || AllocateError::LossOutOfRange {
                characteristic: problem.characteristics()[loss.characteristic].name().to_owned(),
                k: loss.k,
            };
            loss.k = power.squared().checked(loss.k).ok_or_else(out_of_range)?;
            loss.target = power.inverse().times(loss.target).clamp(-f64::MAX, f64::MAX);
        }
        Ok(task)
    }

    /// Required joint yield. An objective for a given cost replaces it.
    pub(super) fn joint_target(&self, problem: &Problem, options: &AllocationOptions) -> Option<f64> {
        let several = problem.characteristics().iter().filter(|one| one.limits().exist()).count() > 1;
        options.analysis.target_joint_yield.filter(|_| several && self.goal == Goal::LeastCost)
    }

    fn check_losses(&self, problem: &Problem) -> Result<(), AllocateError> {
        if !self.losses.is_empty() && self.basis != CostBasis::Given {
            return Err(AllocateError::LossWithoutCosts);
        }
        for loss in self.losses.iter().filter(|loss| loss.scrap > 0.0) {
            let one = &problem.characteristics()[loss.characteristic];
            if !one.limits().exist() {
                return Err(AllocateError::ScrapWithoutLimits { characteristic: one.name().to_owned() });
            }
        }
        Ok(())
    }

    fn check_setups(&self, problem: &Problem) -> Result<(), AllocateError> {
        if self.setups.len() > MOST_MACHINES {
            return Err(AllocateError::TooManyMachines { count: self.setups.len(), most: MOST_MACHINES });
        }
        for group in &self.priced {
            let known = |machine: &&String| self.setups.iter().any(|setup| setup.machine == **machine);
            let mut machines = group.offers.iter().filter_map(|offer| offer.machine.as_ref());
            if let Some(machine) = machines.find(|machine| !known(machine)) {
                let dimension = problem.dimensions()[group.members[0]].name().to_owned();
                return Err(AllocateError::UnknownMachine { dimension, machine: machine.clone() });
            }
        }
        Ok(())
    }

    fn check_goal(&self, problem: &Problem) -> Result<(), AllocateError> {
        let (what, of, most) = match self.goal {
            Goal::LeastCost => return Ok(()),
            Goal::MostCpk { .. } => ("the highest Cpk", "a characteristic", usize::MAX),
            Goal::FewestRejects { .. } => ("the fewest rejects", "one characteristic", 1),
        };
        let sought = problem.characteristics().iter().zip(&self.requirements);
        let count = sought.filter(|(one, required)| one.limits().exist() && required.is_none()).count();
        if self.priced.is_empty() || count == 0 || count > most {
            return Err(AllocateError::NoGoal { what, of, count });
        }
        let cheapest = |group: &Priced| {
            group.parts * group.offers.iter().map(|offer| offer.curve.cost(offer.max)).fold(f64::INFINITY, f64::min)
        };
        let least = self.priced.iter().map(cheapest).sum::<f64>();
        match self.goal.cost_limit().filter(|limit| *limit < least || !limit.is_finite()) {
            Some(limit) => Err(AllocateError::CostLimit { limit, least }),
            None => Ok(()),
        }
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
        for (name, [low, high]) in &options.nominal_bounds {
            let ordered = low.is_finite() && high.is_finite() && low < high;
            if !ordered || !options.recentre.contains(name) {
                return Err(AllocateError::NominalBounds { name: name.clone(), low: *low, high: *high });
            }
        }
        let limits = problem.characteristics().iter().any(|one| one.limits().exist()) || !self.losses.is_empty();
        if !options.recentre.is_empty() && !limits {
            return Err(AllocateError::NoLimits);
        }
        Ok(())
    }
}
