//! The problem: dimensions, an assembly function, and the characteristics asked of it.

use std::sync::{Arc, OnceLock};

use crate::assembly::{AssemblyFunction, Points, State, States};
use crate::magnitude::Magnitudes;
use crate::summary::EvaluatorSummary;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::correlation::{Block, Correlation, CorrelationError, Pair};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;
use sensitol_numeric::power::Power;

/// N dimensions, K characteristics, and the assembly function between them.
#[derive(Clone)]
pub struct Problem {
    dimensions: Vec<Dimension>,
    correlation: Option<Correlation>,
    characteristics: Vec<Characteristic>,
    /// For every characteristic, the output of the function that it is.
    outputs: Vec<usize>,
    function: Arc<dyn AssemblyFunction>,
    /// Pairs of dimensions, by name, whose product the function is known to have.
    products: Arc<[(String, String)]>,
    /// The sizes of the outputs, during a run that is about them.
    magnitudes: Option<Magnitudes>,
    /// For every characteristic its limits as computed values keep them, made when first asked for.
    kept: OnceLock<Vec<KeptLimits>>,
}

/// Why dimensions, function and characteristics do not fit together.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProblemError {
    /// There is no dimension.
    #[error("a problem needs at least one dimension")]
    NoDimension,
    /// There is no characteristic.
    #[error("a problem needs at least one characteristic")]
    NoCharacteristic,
    /// Two dimensions, or two characteristics, bear one name.
    #[error("the name `{name}` is given twice")]
    DuplicateName {
        /// The name.
        name: String,
    },
    /// The function has other inputs than the problem has dimensions.
    #[error("the assembly function's inputs are {expected}, the dimensions are {found}", expected = list(expected), found = list(found))]
    InputMismatch {
        /// The function's inputs.
        expected: Vec<String>,
        /// The problem's dimensions.
        found: Vec<String>,
    },
    /// A characteristic is not an output of the function.
    #[error("there is no characteristic `{name}`; known: {known}", known = list(known))]
    UnknownCharacteristic {
        /// The name asked for.
        name: String,
        /// The most similar one.
        nearest: Option<String>,
        /// The names that exist.
        known: Vec<String>,
    },
    /// A dimension varies otherwise in a state.
    #[error(
        "the tolerance of `{dimension}` is another one in `{state}`, and one tolerance must do for all: write it as a number, not as percent"
    )]
    StateTolerance {
        /// The dimension.
        dimension: String,
        /// The state.
        state: String,
    },
}

fn list(names: &[String]) -> String {
    names.join(", ")
}

impl std::fmt::Debug for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        // The function is a black box here too.
        let mut parts = f.debug_struct("Problem");
        parts
            .field("dimensions", &self.dimensions)
            .field("correlation", &self.correlation)
            .field("characteristics", &self.characteristics);
        parts.finish_non_exhaustive()
    }
}

impl Problem {
    /// With every output of the function as a characteristic without limits.
    ///
    /// # Errors
    /// When there is no dimension or output, a name stands twice, or the function names inputs that are not the
    /// dimensions in this order.
    pub fn new(
        dimensions: impl IntoIterator<Item = Dimension>,
        function: impl AssemblyFunction + 'static,
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
            function: Arc::new(function),
            products: Arc::new([]),
            magnitudes: None,
            kept: OnceLock::new(),
        };
        problem.checked()
    }

    /// With dimensions that vary together; without pairs, all independent.
    ///
    /// # Errors
    /// When these dimensions cannot be correlated so: see [`CorrelationError`].
    pub fn correlated(self, pairs: &[Pair]) -> Result<Self, CorrelationError> {
        self.jointly(pairs, Vec::new())
    }

    /// The same beside blocks of dimensions that vary together by rows or within a zone.
    pub fn jointly(mut self, pairs: &[Pair], blocks: Vec<Block>) -> Result<Self, CorrelationError> {
        self.correlation = match (pairs, &blocks[..]) {
            ([], []) => None,
            _ => Some(Correlation::with_blocks(&self.dimensions, pairs, blocks)?),
        };
        Ok(self)
    }

    /// With these characteristics instead: outputs of the function by name, with limits and targets.
    ///
    /// # Errors
    /// When there is none, one stands twice, or one is not an output of the function.
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

    /// With only those of its characteristics that bear one of these names, in the problem's order.
    ///
    /// # Errors
    /// When a name is none of its characteristics'.
    pub fn only(mut self, names: &[impl AsRef<str>]) -> Result<Self, ProblemError> {
        for name in names.iter().map(AsRef::as_ref) {
            if !self.characteristics.iter().any(|characteristic| characteristic.name() == name) {
                return Err(unknown(name, self.characteristics.iter().map(Characteristic::name)));
            }
        }
        let kept = |characteristic: &Characteristic| names.iter().any(|name| name.as_ref() == characteristic.name());
        let (outputs, characteristics) = (self.outputs.into_iter().zip(self.characteristics))
            .filter(|(_, characteristic)| kept(characteristic))
            .unzip();
        (self.outputs, self.characteristics) = (outputs, characteristics);
        self.checked()
    }

    /// With another dimension of the same name and kind in one place, and another function of the same signature.
    pub(crate) fn replacing(&self, place: usize, dimension: Dimension, function: Arc<dyn AssemblyFunction>) -> Self {
        let mut problem = self.with_function(function);
        // Correlation is of standardised variables: it does not see where a dimension is.
        problem.dimensions[place] = dimension;
        problem
    }

    /// Pairs of dimensions, by name, whose product the function is known to have.
    pub(crate) fn products(&self) -> &[(String, String)] {
        &self.products
    }

    /// Knows that these pairs of dimensions interact: every method of second order that takes differences takes in their exact mixed
    /// derivative, without an evaluation, where the function knows it.
    pub fn with_products(self, products: Vec<(String, String)>) -> Self {
        Self { products: products.into(), ..self }
    }

    /// As a run sees it first, which finds out how large the outputs are.
    pub(crate) fn watched(&self) -> Self {
        let magnitudes = Magnitudes::watching(self.function.signature().outputs.len());
        let function = magnitudes.wrapped(Arc::clone(&self.function));
        Self { function, magnitudes: Some(magnitudes), kept: OnceLock::new(), ..self.clone() }
    }

    /// With every output divided by its power of two, and the characteristics with it; `seen` are the magnitudes of the run that found them out.
    pub(crate) fn divided(&self, powers: Vec<Power>, seen: &Magnitudes) -> Self {
        let magnitudes = seen.known(powers);
        let function = magnitudes.wrapped(Arc::clone(&self.function));
        let divided = |(one, &output): (&Characteristic, &usize)| one.clone().times(magnitudes.power(output).inverse());
        let characteristics = self.characteristics.iter().zip(&self.outputs).map(divided).collect();
        Self { function, characteristics, magnitudes: Some(magnitudes), kept: OnceLock::new(), ..self.clone() }
    }

    /// The dimensions of another problem with characteristics and function of this one: what a run found, in the units in which it was asked.
    pub(crate) fn restored(&self, found: &Self) -> Self {
        Self {
            function: Arc::clone(&self.function),
            characteristics: self.characteristics.clone(),
            magnitudes: self.magnitudes.clone(),
            kept: OnceLock::new(),
            ..found.clone()
        }
    }

    /// The sizes of the outputs, during a run that is about them.
    pub(crate) fn magnitudes(&self) -> Option<&Magnitudes> {
        self.magnitudes.as_ref()
    }

    /// The power of two by which a characteristic is divided.
    pub(crate) fn power(&self, characteristic: usize) -> Power {
        self.magnitudes.as_ref().map_or(Power::ONE, |of| of.power(self.outputs[characteristic]))
    }

    /// The power of two by which the characteristic of this name is divided; 1 where there is none.
    pub(crate) fn power_of(&self, name: &str) -> Power {
        let place = self.characteristics.iter().position(|one| one.name() == name);
        place.map_or(Power::ONE, |place| self.power(place))
    }

    /// With another function for the outputs as they are undivided.
    pub(crate) fn with_undivided(&self, function: Arc<dyn AssemblyFunction>) -> Self {
        let function = match &self.magnitudes {
            Some(magnitudes) => magnitudes.wrapped(function),
            None => function,
        };
        self.with_function(function)
    }

    /// With another function of the same signature.
    pub(crate) fn with_function(&self, function: Arc<dyn AssemblyFunction>) -> Self {
        Self { function, kept: OnceLock::new(), ..self.clone() }
    }

    /// With other dimensions of the same names: other tolerances, other nominal values; what is correlated stays so.
    ///
    /// # Errors
    /// When these dimensions cannot be correlated so.
    ///
    /// # Panics
    /// When the names are others.
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

    /// The name of a characteristic in a state.
    pub fn in_state(characteristic: &str, state: &str) -> String {
        States::name(characteristic, state)
    }

    /// With every characteristic once in each state: problems of the same dimensions with other nominal values, or other functions.
    ///
    /// # Errors
    /// When a dimension varies otherwise about its nominal value in a state.
    pub fn in_states(&self, states: &[(&str, &Self)]) -> Result<Self, ProblemError> {
        /// The error of decimal numbers, relative to the half band and to the nominal value.
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
            let renamed = |one: &Characteristic| one.clone().renamed(Self::in_state(one.name(), name));
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

    /// Columns of points in sigmas off the means, of the dimensions at these places: what a surrogate is asked at.
    pub(crate) fn standardised(&self, points: &Points, places: &[usize]) -> Vec<Vec<f64>> {
        let column = |&d: &usize| {
            let (mean, sigma) = (self.dimensions[d].mean(), self.dimensions[d].sigma());
            points.column(d).iter().map(|x| (x - mean) / sigma).collect()
        };
        places.iter().map(column).collect()
    }

    /// The dimensions, in order.
    pub fn dimensions(&self) -> &[Dimension] {
        &self.dimensions
    }

    /// How the dimensions vary together; None when all are independent.
    pub fn correlation(&self) -> Option<&Correlation> {
        self.correlation.as_ref()
    }

    /// The characteristics asked for, in order.
    pub fn characteristics(&self) -> &[Characteristic] {
        &self.characteristics
    }

    /// The limits of a characteristic as computed values keep them.
    pub fn kept_limits(&self, characteristic: usize) -> KeptLimits {
        self.kept.get_or_init(|| self.all_kept_limits())[characteristic]
    }

    /// The terms of a characteristic are those at the means, or one sigma off them, where a sum about 0 has some: on the side where they are
    /// smaller, so that an exponential far out does not count.
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

    /// The largest input in the unit of a characteristic whose terms are unknown: of a stack in millimetres the largest part. 0 without unit.
    fn inputs_in_unit_of(&self, characteristic: &Characteristic) -> f64 {
        let same = |dimension: &&Dimension| dimension.unit().is_some() && dimension.unit() == characteristic.unit();
        let size = |dimension: &Dimension| dimension.mean().abs() + dimension.sigma();
        self.dimensions.iter().filter(same).map(size).fold(0.0, f64::max)
    }

    /// The assembly function.
    pub fn function(&self) -> &dyn AssemblyFunction {
        &*self.function
    }

    /// The account of the processes of an external model so far, in numbers; None where there is none.
    pub(crate) fn evaluator(&self) -> Option<EvaluatorSummary> {
        self.function.account().map(|account| account.counts)
    }

    /// The outputs of the assembly function that the characteristics are.
    pub fn outputs(&self) -> &[usize] {
        &self.outputs
    }

    /// For every characteristic, whether it can depend on each dimension; a black box may depend on all.
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
