//! Problem: dimensions, an assembly function, and the requested characteristics.

use std::sync::{Arc, OnceLock};

use crate::assembly::{Adjusted, Adjustment, AssemblyFunction, Points, State, States};
use crate::magnitude::Magnitudes;
use crate::summary::EvaluatorSummary;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::correlation::{Block, Correlation, CorrelationError, Pair};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;
use sensitol_numeric::power::Power;

/// Problem of N dimensions, K characteristics, and the assembly function between them.
#[derive(Clone)]
pub struct Problem {
    dimensions: Vec<Dimension>,
    correlation: Option<Correlation>,
    characteristics: Vec<Characteristic>,
    /// Output of the function for every characteristic.
    outputs: Vec<usize>,
    function: Arc<dyn AssemblyFunction>,
    /// Pairs of dimensions, by name, whose product the function is known to contain.
    products: Arc<[(String, String)]>,
    /// Sizes of the outputs, during a run that determines or uses them.
    magnitudes: Option<Magnitudes>,
    /// Limits of every characteristic for computed values, computed on first use.
    kept: OnceLock<Vec<KeptLimits>>,
}

/// Error of dimensions, function and characteristics that do not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// There is no dimension.
    #[error("a problem needs at least one dimension")]
    NoDimension,
    /// There is no characteristic.
    #[error("a problem needs at least one characteristic")]
    NoCharacteristic,
    /// Two dimensions, or two characteristics, have the same name.
    #[error("the name `{name}` is given twice")]
    DuplicateName {
        /// Name that is given twice.
        name: String,
    },
    /// The inputs of the function differ from the dimensions of the problem.
    #[error("the assembly function's inputs are {expected}, the dimensions are {found}", expected = list(expected), found = list(found))]
    InputMismatch {
        /// Inputs of the function.
        expected: Vec<String>,
        /// Dimensions of the problem.
        found: Vec<String>,
    },
    /// A characteristic is not an output of the function.
    #[error("there is no characteristic `{name}`; known: {known}", known = list(known))]
    UnknownCharacteristic {
        /// Name of the characteristic that was requested.
        name: String,
        /// Most similar name, if any.
        nearest: Option<String>,
        /// Names that exist.
        known: Vec<String>,
    },
    /// The tolerance of a dimension differs in a state.
    #[error(
        "the tolerance of `{dimension}` is another one in `{state}`, and one tolerance must do for all: write it as a number, not as percent"
    )]
    StateTolerance {
        /// Name of the dimension.
        dimension: String,
        /// Name of the state.
        state: String,
    },
}

fn list(names: &[String]) -> String {
    names.join(", ")
}

impl std::fmt::Debug for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // The function has no Debug output.
        let mut parts = f.debug_struct("Problem");
        parts
            .field("dimensions", &self.dimensions)
            .field("correlation", &self.correlation)
            .field("characteristics", &self.characteristics);
        parts.finish_non_exhaustive()
    }
}

impl Problem {
    /// Problem with every output of the function as a characteristic without limits.
    ///
    /// # Errors
    /// If there is no dimension or output, a name appears twice, or the inputs of the function differ from the dimensions in this order.
    pub fn new(
        dimensions: impl IntoIterator<Item = Dimension>,
        function: impl AssemblyFunction + 'static,
    ) -> Result<Self, ProblemError> {
        Self::of_function(dimensions, Arc::new(function))
    }

    /// Problem of a function that others share, as [`new`](Self::new).
    pub fn of_function(
        dimensions: impl IntoIterator<Item = Dimension>,
        function: Arc<dyn AssemblyFunction>,
    ) -> Result<Self, ProblemError> {
        let dimensions: Vec<Dimension> = dimensions.into_iter().collect();
        let signature = function.signature();
        if dimensions.is_empty() {
            return Err(ProblemError::NoDimension);
        }
        let found: Vec<String> = dimensions.iter().map(|dimension| dimension.name().to_owned()).collect();
        distinct(&found)?;
        let expected: Vec<String> = signature.inputs.iter().map(|input| input.name.clone()).collect();
        if !expected.is_empty() && expected != found {
            return Err(ProblemError::InputMismatch { expected, found });
        }
        let characteristic = |output: &crate::assembly::Output| {
            let characteristic = Characteristic::new(&output.name);
            output.unit.iter().fold(characteristic, |characteristic, unit| characteristic.with_unit(unit))
        };
        let characteristics: Vec<Characteristic> = signature.outputs.iter().map(characteristic).collect();
        let outputs = (0..characteristics.len()).collect();
        let problem = Self {
            dimensions,
            correlation: None,
            characteristics,
            outputs,
            function,
            products: Arc::new([]),
            magnitudes: None,
            kept: OnceLock::new(),
        };
        problem.checked()
    }

    /// Sets correlations of dimensions. Without pairs, all are independent.
    ///
    /// # Errors
    /// If these dimensions cannot be correlated in this way: see [`CorrelationError`].
    pub fn correlated(self, pairs: &[Pair]) -> Result<Self, CorrelationError> {
        self.jointly(pairs, Vec::new())
    }

    /// Sets correlations of dimensions, and blocks of dimensions with a joint distribution of rows or a zone.
    pub fn jointly(mut self, pairs: &[Pair], blocks: Vec<Block>) -> Result<Self, CorrelationError> {
        self.correlation = match (pairs, &blocks[..]) {
            ([], []) => None,
            _ => Some(Correlation::with_blocks(&self.dimensions, pairs, blocks)?),
        };
        Ok(self)
    }

    /// Replaces the characteristics: outputs of the function by name, with limits and targets.
    ///
    /// # Errors
    /// If there is none, one appears twice, or one is not an output of the function.
    pub fn asking(mut self, characteristics: impl IntoIterator<Item = Characteristic>) -> Result<Self, ProblemError> {
        let outputs = &self.function.signature().outputs;
        self.characteristics = characteristics.into_iter().collect();
        self.outputs = (self.characteristics.iter())
            .map(|asked| {
                let index = outputs.iter().position(|output| output.name == asked.name());
                index.ok_or_else(|| unknown(asked.name(), outputs.iter().map(|output| &output.name)))
            })
            .collect::<Result<_, _>>()?;
        self.checked()
    }

    /// Sets dimensions that are chosen from a stock after the parts are made, one after the other. Every characteristic is then that
    /// after the choice.
    ///
    /// # Example
    /// A shim in steps of 0.1 leaves an error of at most 0.05.
    ///
    /// ```
    /// use sensitol::assembly::{Adjustment, StockResponse};
    /// use sensitol::simulation::{SimulationOptions, simulate};
    /// use sensitol::{Closure, Dimension, Problem};
    /// let dimensions = [Dimension::normal("room", 5.5, 0.6)?, Dimension::fixed("shim", 5.0)?];
    /// let play = Problem::new(dimensions, Closure::scalar("play", |x| x[0] - x[1]))?;
    /// let stock = (45..=65).map(|tenth| f64::from(tenth) / 10.0 - 0.5).collect();
    /// let shim = Adjustment { input: 1, nominal: 5.0, stock, to: 0, target: 0.5, response: StockResponse::Linear };
    /// let play = play.adjusted(vec![shim]);
    /// let sample = simulate(&play, &SimulationOptions::default())?;
    /// let sigma = sample.characteristics[0].sigma.unwrap().value;
    /// assert!((sigma - 0.1 / 12f64.sqrt()).abs() < 2e-4);
    /// # Ok::<(), sensitol::Error>(())
    /// ```
    pub fn adjusted(&self, adjustments: Vec<Adjustment>) -> Self {
        self.with_function(Arc::new(Adjusted::new(Arc::clone(&self.function), adjustments)))
    }

    /// Keeps only the characteristics with these names, in the order of the problem.
    ///
    /// # Errors
    /// If a name is not one of its characteristics.
    pub fn only(mut self, names: &[impl AsRef<str>]) -> Result<Self, ProblemError> {
        for name in names.iter().map(AsRef::as_ref) {
            if !self.characteristics.iter().any(|characteristic| characteristic.name() == name) {
                return Err(unknown(name, self.characteristics.iter().map(Characteristic::name)));
            }
        }
        let mut asked: Vec<String> = names.iter().map(|name| name.as_ref().to_owned()).collect();
        // A characteristic that decides which assemblies count is needed too.
        let mut next = 0;
        while let Some(name) = asked.get(next) {
            let of = self.characteristics.iter().find(|one| one.name() == name);
            let given = of.and_then(|one| one.given()).filter(|given| !asked.iter().any(|known| known == given));
            asked.extend(given.map(str::to_owned));
            next += 1;
        }
        let kept = |characteristic: &Characteristic| asked.iter().any(|name| name == characteristic.name());
        let (outputs, characteristics) = (self.outputs.into_iter().zip(self.characteristics))
            .filter(|(_, characteristic)| kept(characteristic))
            .unzip();
        (self.outputs, self.characteristics) = (outputs, characteristics);
        self.checked()
    }

    /// Replaces the dimension in one place by one of the same name and kind, and the function by one of the same signature.
    pub(crate) fn replacing(&self, place: usize, dimension: Dimension, function: Arc<dyn AssemblyFunction>) -> Self {
        let mut problem = self.with_function(function);
        // Correlation is that of standardised variables, so the place of a dimension does not affect it.
        problem.dimensions[place] = dimension;
        problem
    }

    /// Pairs of dimensions, by name, whose product the function is known to contain.
    pub(crate) fn products(&self) -> &[(String, String)] {
        &self.products
    }

    /// Sets pairs of dimensions that are known to interact. Every method of second order by differences then uses their exact mixed
    /// derivative without an evaluation, if the function has it.
    pub fn with_products(self, products: Vec<(String, String)>) -> Self {
        Self { products: products.into(), ..self }
    }

    /// Problem for the first part of a run, which determines the size of the outputs.
    pub(crate) fn watched(&self) -> Self {
        let magnitudes = Magnitudes::watching(self.function.signature().outputs.len());
        let function = magnitudes.wrapped(Arc::clone(&self.function));
        Self { function, magnitudes: Some(magnitudes), kept: OnceLock::new(), ..self.clone() }
    }

    /// Problem with every output and its characteristic divided by a power of two. `seen` are the magnitudes of the run that determined the
    /// powers.
    pub(crate) fn divided(&self, powers: Vec<Power>, seen: &Magnitudes) -> Self {
        let magnitudes = seen.known(powers);
        let function = magnitudes.wrapped(Arc::clone(&self.function));
        let divided = |(one, &output): (&Characteristic, &usize)| one.clone().times(magnitudes.power(output).inverse());
        let characteristics = self.characteristics.iter().zip(&self.outputs).map(divided).collect();
        Self { function, characteristics, magnitudes: Some(magnitudes), kept: OnceLock::new(), ..self.clone() }
    }

    /// Problem with the dimensions of `found`, and the characteristics and function of this one: the result of a run in the original units.
    pub(crate) fn restored(&self, found: &Self) -> Self {
        Self {
            function: Arc::clone(&self.function),
            characteristics: self.characteristics.clone(),
            magnitudes: self.magnitudes.clone(),
            kept: OnceLock::new(),
            ..found.clone()
        }
    }

    /// Sizes of the outputs, during a run that determines or uses them.
    pub(crate) fn magnitudes(&self) -> Option<&Magnitudes> {
        self.magnitudes.as_ref()
    }

    /// Power of two by which a characteristic is divided.
    pub(crate) fn power(&self, characteristic: usize) -> Power {
        self.magnitudes.as_ref().map_or(Power::ONE, |of| of.power(self.outputs[characteristic]))
    }

    /// Power of two by which the characteristic of this name is divided, 1 if there is none.
    pub(crate) fn power_of(&self, name: &str) -> Power {
        let place = self.characteristics.iter().position(|one| one.name() == name);
        place.map_or(Power::ONE, |place| self.power(place))
    }

    /// Replaces the function by another, whose outputs are not divided yet.
    pub(crate) fn with_undivided(&self, function: Arc<dyn AssemblyFunction>) -> Self {
        let function = match &self.magnitudes {
            Some(magnitudes) => magnitudes.wrapped(function),
            None => function,
        };
        self.with_function(function)
    }

    /// Replaces the function by one of the same signature.
    pub(crate) fn with_function(&self, function: Arc<dyn AssemblyFunction>) -> Self {
        Self { function, kept: OnceLock::new(), ..self.clone() }
    }

    /// Replaces the dimensions by others of the same names, with other tolerances or nominal values. Correlations are kept.
    ///
    /// # Errors
    /// If these dimensions cannot be correlated in this way.
    ///
    /// # Panics
    /// If the names differ.
    pub fn with_dimensions(mut self, dimensions: Vec<Dimension>) -> Result<Self, CorrelationError> {
        let names = |dimensions: &[Dimension]| dimensions.iter().map(|one| one.name().to_owned()).collect::<Vec<_>>();
        assert_eq!(names(&dimensions), names(&self.dimensions), "other dimensions");
        let pairs: Vec<Pair> = self.correlation.as_ref().map_or(Vec::new(), |correlation| {
            let members = correlation.members();
            let all = members.iter().enumerate().flat_map(|(i, &a)| members[i + 1..].iter().map(move |&b| (a, b)));
            let pair = |(a, b): (usize, usize)| Pair {
                between: [a, b].map(|d| dimensions[d].name().to_owned()),
                value: correlation.of(a, b),
            };
            let of_blocks =
                |&(a, b): &(usize, usize)| correlation.block_of(a).is_some() || correlation.block_of(b).is_some();
            all.filter(|ends| !of_blocks(ends)).map(pair).filter(|pair| pair.value != 0.0).collect()
        });
        let blocks = self.correlation.as_ref().map_or(Vec::new(), |correlation| correlation.blocks().to_vec());
        (self.dimensions, self.kept) = (dimensions, OnceLock::new());
        self.jointly(&pairs, blocks)
    }

    /// Name of a characteristic in a state.
    pub fn in_state(characteristic: &str, state: &str) -> String {
        States::name(characteristic, state)
    }

    /// Problem with every characteristic once in each state. States are problems of the same dimensions with other nominal values, or other
    /// functions.
    ///
    /// # Errors
    /// If the distribution of a dimension about its nominal value differs in a state.
    pub fn in_states(&self, states: &[(&str, &Self)]) -> Result<Self, ProblemError> {
        /// Rounding of decimal numbers, relative to the half band and to the nominal value.
        const SAME: [f64; 2] = [1e-9, 1e-13];
        let mut all = Vec::new();
        let mut characteristics = Vec::new();
        for &(name, problem) in states {
            let mut moved = Vec::new();
            for (own, there) in self.dimensions.iter().zip(&problem.dimensions) {
                let by = there.nominal() - own.nominal();
                let near = SAME[0] * own.half_band() + SAME[1] * own.nominal().abs().max(there.nominal().abs());
                let apart = |a: f64, b: f64| (a - b).abs() > near;
                if apart(own.half_band(), there.half_band())
                    || apart(own.sigma(), there.sigma())
                    || apart(own.mean() + by, there.mean())
                {
                    let (dimension, state) = (own.name().to_owned(), name.to_owned());
                    return Err(ProblemError::StateTolerance { dimension, state });
                }
                moved.push(by);
            }
            let (function, outputs) = (Arc::clone(&problem.function), problem.outputs.clone());
            all.push(State::new(name, function, moved, outputs));
            let renamed = |one: &Characteristic| {
                let renamed = one.clone().renamed(Self::in_state(one.name(), name));
                match one.given() {
                    Some(given) => renamed.with_given(Self::in_state(given, name)),
                    None => renamed,
                }
            };
            characteristics.extend(problem.characteristics.iter().map(renamed));
        }
        let outputs = (0..characteristics.len()).collect();
        let function = Arc::new(States::new(all));
        Self { characteristics, outputs, function, ..self.clone() }.checked()
    }

    fn checked(mut self) -> Result<Self, ProblemError> {
        self.kept = OnceLock::new();
        if self.characteristics.is_empty() {
            return Err(ProblemError::NoCharacteristic);
        }
        let names: Vec<String> = self.characteristics.iter().map(|asked| asked.name().to_owned()).collect();
        distinct(&names)?;
        Ok(self)
    }

    /// Columns of points in sigmas off the means, for the dimensions at these places: the inputs of a surrogate.
    pub(crate) fn standardised(&self, points: &Points, places: &[usize]) -> Vec<Vec<f64>> {
        let column = |&d: &usize| {
            let (mean, sigma) = (self.dimensions[d].mean(), self.dimensions[d].sigma());
            points.column(d).iter().map(|x| (x - mean) / sigma).collect()
        };
        places.iter().map(column).collect()
    }

    /// Dimensions in order.
    pub fn dimensions(&self) -> &[Dimension] {
        &self.dimensions
    }

    /// Correlation of the dimensions. Returns None if all are independent.
    pub fn correlation(&self) -> Option<&Correlation> {
        self.correlation.as_ref()
    }

    /// Characteristics requested, in order.
    pub fn characteristics(&self) -> &[Characteristic] {
        &self.characteristics
    }

    /// Limits of a characteristic for computed values, which allow for rounding.
    pub fn kept_limits(&self, characteristic: usize) -> KeptLimits {
        self.kept.get_or_init(|| self.all_kept_limits())[characteristic]
    }

    /// Limits of all characteristics for computed values. The magnitude of the terms is the larger of that at the means and that one sigma
    /// off them, where a sum about 0 has some. Off the means the smaller side counts, so that an exponential far out does not matter.
    fn all_kept_limits(&self) -> Vec<KeptLimits> {
        let at = |sigmas: f64| {
            let value = |dimension: &Dimension| {
                let [least, most] = dimension.distribution().map_or([dimension.mean(); 2], |law| law.support());
                (dimension.mean() + sigmas * dimension.sigma()).clamp(least, most)
            };
            self.function.magnitudes(&self.outputs, &self.dimensions.iter().map(value).collect::<Vec<f64>>())
        };
        let limited = self.characteristics.iter().any(|one| one.limits().exist());
        let nothing = || vec![None; self.outputs.len()];
        let [middle, up, down] = [0.0, 1.0, -1.0].map(|sigmas| if limited { at(sigmas) } else { nothing() });
        let of = |(c, one): (usize, &Characteristic)| {
            let sides = [up[c], down[c]].into_iter().flatten().reduce(f64::min);
            let terms = middle[c].into_iter().chain(sides).reduce(f64::max);
            let inputs = || self.power(c).inverse().times(self.inputs_in_unit_of(one));
            KeptLimits::new(one.limits(), terms.unwrap_or_else(inputs))
        };
        self.characteristics.iter().enumerate().map(of).collect()
    }

    /// Largest input with the unit of the characteristic, for unknown terms: the largest part of a stack in millimetres. 0 without unit.
    fn inputs_in_unit_of(&self, characteristic: &Characteristic) -> f64 {
        let same = |dimension: &&Dimension| dimension.unit().is_some() && dimension.unit() == characteristic.unit();
        let size = |dimension: &Dimension| dimension.mean().abs() + dimension.sigma();
        self.dimensions.iter().filter(same).map(size).fold(0.0, f64::max)
    }

    /// Assembly function of the problem.
    pub fn function(&self) -> &dyn AssemblyFunction {
        &*self.function
    }

    /// Counts of the processes of an external model so far. Returns None if there is no external model.
    pub(crate) fn evaluator(&self) -> Option<EvaluatorSummary> {
        self.function.account().map(|account| account.counts)
    }

    /// Output of the assembly function for each characteristic.
    pub fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    /// Choice from stock that a characteristic follows, in words. Returns None if it follows none.
    pub(crate) fn choice(&self, characteristic: usize) -> Option<String> {
        self.function.choice(self.outputs[characteristic])
    }

    /// True if a characteristic follows a choice from stock and its model is costly: it takes its figures from points of the model.
    pub fn follows_costly_choice(&self, characteristic: usize) -> bool {
        self.function.signature().costly && self.choice(characteristic).is_some()
    }

    /// Greatest number of counted evaluations of a point: several if a costly model is evaluated for every value of a stock that is tried, or
    /// at every step of a motion.
    pub(crate) fn evaluations_per_point(&self) -> usize {
        let costly = self.function.signature().costly;
        if costly { self.function.evaluations_per_point(&self.outputs).max(1) } else { 1 }
    }

    /// Row per characteristic, true for each dimension that it can depend on. A black box may depend on all.
    pub(crate) fn dependence(&self) -> Vec<Vec<bool>> {
        let outputs = &self.function.signature().outputs;
        let row = |&output: &usize| match &outputs[output].depends_on {
            None => vec![true; self.dimensions.len()],
            Some(dimensions) => (0..self.dimensions.len()).map(|d| dimensions.contains(&d)).collect(),
        };
        self.outputs.iter().map(row).collect()
    }
}

fn unknown(name: &str, known: impl Iterator<Item = impl AsRef<str>>) -> ProblemError {
    let known: Vec<String> = known.map(|name| name.as_ref().to_owned()).collect();
    let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
    ProblemError::UnknownCharacteristic { name: name.to_owned(), nearest, known }
}

fn distinct(names: &[String]) -> Result<(), ProblemError> {
    let mut seen = std::collections::HashSet::new();
    match names.iter().find(|name| !seen.insert(name.as_str())) {
        Some(name) => Err(ProblemError::DuplicateName { name: name.clone() }),
        None => Ok(()),
    }
}
