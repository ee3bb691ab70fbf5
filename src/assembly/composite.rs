//! Assembly function of a study: a model, formulas, or formulas on top of a model. Closure conditions may determine further values.

mod driven;
mod evaluate;
mod exact;
mod switches;

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use super::evaluator_account::EvaluatorAccount;
use super::formula::{Formula, FormulaError, FormulaSet, Meaning};
use super::formula::{Role, UnitFinding};
use super::implicit::{Anchor, Assembler, Conditions, ConditionsError};
use super::{
    AssemblyFunction, Bounds, Derivatives, Directions, EvaluationError, Input, ModelInfo, Output, Points, Polynomial,
    RecordedFailure, Request, Responses, Run, Signature, Switches,
};
use crate::warning::Warning;
use sensitol_numeric::unit::Unit;

/// Source of an input of the model.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// Dimension of this index.
    Dimension(usize),
    /// Constant value.
    Fixed(f64),
    /// Value of the formula of this index, of dimensions, constants and unknowns: the formula drives the model.
    Formula(usize),
}

/// Reason why parts do not form a composite.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum CompositeError {
    /// A formula that cannot be resolved.
    #[error("formula `{name}`: {error}")]
    Formula {
        /// Name of the faulty formula.
        name: String,
        /// Index among the formulas, which are followed by those of the conditions.
        index: usize,
        /// Fault in the formula.
        error: FormulaError,
    },
    /// Conditions that determine no state.
    #[error(transparent)]
    Conditions(#[from] ConditionsError),
    /// A formula that drives the model and needs its answer.
    #[error("formula `{name}` drives the model and needs its output `{output}`: a cycle")]
    Driven {
        /// Name of the driving formula.
        name: String,
        /// Index among the formulas.
        index: usize,
        /// Name of the output that the formula needs.
        output: String,
    },
}

/// Function from dimensions to formulas of dimensions, constants, outputs of a model and unknowns of closure conditions.
///
/// Only the parts that the asked outputs need are evaluated. A model is asked only for outputs that a formula or characteristic in question
/// uses. Conditions are solved only if an asked output depends on an unknown. A failure at a point concerns only the outputs that use the
/// failed part.
pub struct Composite {
    signature: Signature,
    /// Named formulas, followed by those of the conditions.
    formulas: Arc<FormulaSet>,
    named: usize,
    model: Option<Inner>,
    assembler: Option<Arc<Assembler>>,
    /// Formula, output of the model or unknown of every output.
    outputs: Vec<Origin>,
}

struct Inner {
    function: Arc<dyn AssemblyFunction>,
    inputs: Vec<Source>,
    /// Factors of the model's inputs and of its outputs; empty if there are none.
    factors: [Vec<f64>; 2],
    /// Block of each fixed input's value, one after the other.
    fixed: OnceLock<Vec<f64>>,
    /// Points for which a costly driven model received values, by the bits of these values.
    sent: Mutex<HashMap<Vec<u64>, Vec<f64>>>,
}

#[derive(Debug, Clone, Copy)]
enum Origin {
    Formula(usize),
    Model(usize),
    Unknown(usize),
}

/// Parts that an output is made of.
#[derive(Debug, Clone, Default)]
struct Needs {
    dimensions: Vec<usize>,
    /// Indices of the outputs of the model.
    answers: Vec<usize>,
    unknowns: bool,
}

impl Needs {
    /// Merges the needs of several outputs.
    fn all(needs: &[Self]) -> Self {
        let mut all = Self::default();
        for needs in needs {
            all.dimensions.extend(&needs.dimensions);
            all.answers.extend(&needs.answers);
            all.unknowns |= needs.unknowns;
        }
        for part in [&mut all.dimensions, &mut all.answers] {
            part.sort_unstable();
            part.dedup();
        }
        all
    }
}

/// Parts of a [`Composite`], before their names are resolved.
#[derive(Default)]
pub struct Parts {
    /// Dimensions, in order.
    pub inputs: Vec<Input>,
    /// Names that stand for numbers in formulas.
    pub constants: Vec<(String, f64)>,
    /// Model, with the source of each of its inputs.
    pub model: Option<(Arc<dyn AssemblyFunction>, Vec<Source>)>,
    /// Formulas in any order. Each name occurs once.
    pub formulas: Vec<(String, Formula)>,
    /// Conditions of the assembled state, and the unknowns that they determine.
    pub conditions: Option<Conditions>,
    /// Names and units of the outputs: formulas, unknowns, or outputs of the model.
    pub outputs: Vec<(String, Option<String>)>,
}

impl Composite {
    /// Resolves the formulas' names: first other formulas, then dimensions, constants, unknowns and outputs of the model.
    ///
    /// # Errors
    /// Fails for the first formula that uses an undefined name or needs itself, and for conditions that cannot determine the unknowns.
    ///
    /// # Panics
    /// Panics if an output is neither a formula nor an unknown nor an output of the model. The caller passes known names only.
    pub fn new(parts: Parts) -> Result<Self, CompositeError> {
        let Parts { inputs, constants, model, mut formulas, conditions, outputs } = parts;
        let named = formulas.len();
        formulas.extend(conditions.iter().flat_map(Conditions::formulas));
        let names: Vec<String> = formulas.iter().map(|(name, _)| name.clone()).collect();
        let model = model.map(|(function, inputs)| Inner {
            function,
            inputs,
            factors: Default::default(),
            fixed: OnceLock::new(),
            sent: Mutex::default(),
        });
        let offers = model.as_ref().map_or(&[][..], |model| &model.function.signature().outputs);
        let given = inputs.len() + offers.len();
        let unknowns = conditions.as_ref().map_or(&[][..], Conditions::unknowns);
        let dimensions =
            inputs.iter().enumerate().map(|(index, input)| (input.name.as_str(), Meaning::Variable(index)));
        let constants = constants.iter().map(|(name, value)| (name.as_str(), Meaning::Constant(*value)));
        let answers = offers
            .iter()
            .enumerate()
            .map(|(index, output)| (output.name.as_str(), Meaning::Variable(inputs.len() + index)));
        let found =
            (unknowns.iter().enumerate()).map(|(index, unknown)| (unknown.name(), Meaning::Variable(given + index)));
        let meanings = answers.chain(found).chain(constants).chain(dimensions);
        let formulas = FormulaSet::with_unnamed(formulas, named, meanings)
            .map_err(|(index, error)| CompositeError::Formula { name: names[index].clone(), index, error })?;
        let formulas = Arc::new(formulas);
        if let Some(conditions) = &conditions {
            conditions.check(&formulas, named, given)?;
        }

        let mut composite = Self {
            assembler: (conditions.as_ref())
                .map(|conditions| Arc::new(Assembler::new(conditions, &formulas, named, given))),
            signature: Signature {
                costly: model.as_ref().is_some_and(|model| model.function.signature().costly),
                cheap: model.as_ref().is_none_or(|model| model.function.signature().cheap),
                inputs,
                ..Signature::default()
            },
            formulas,
            named,
            model,
            outputs: Vec::with_capacity(outputs.len()),
        };
        composite.drives_without_circle(&names)?;
        for (name, unit) in outputs {
            let formula = names[..named].iter().position(|formula| *formula == name).map(Origin::Formula);
            let unknown = || unknowns.iter().position(|unknown| unknown.name() == name).map(Origin::Unknown);
            let offered = || composite.offered(&name).map(Origin::Model);
            let origin = formula.or_else(unknown).or_else(offered);
            let origin = origin.expect("an output is a formula, an unknown or the model's");
            let depends_on = composite.depends_on(origin);
            composite.outputs.push(origin);
            composite.signature.outputs.push(Output { name, unit, depends_on });
        }
        Ok(composite)
    }

    /// Returns the parts of formulas and conditions whose units are incompatible, as found by `FormulaSet::units`. `unread` gives the text of
    /// a unit that is unknown.
    pub fn units(
        &self,
        unit: &dyn Fn(&str) -> Option<Unit>,
        unread: &dyn Fn(&str) -> Option<String>,
        role: &dyn Fn(usize) -> Role,
        convert: bool,
    ) -> Vec<UnitFinding> {
        self.formulas.units(unit, unread, role, convert)
    }

    /// Returns the dimensions inside a sine or cosine of a formula, each with its radians per unit.
    pub fn turning(&self) -> Vec<(usize, f64)> {
        let dimensions = self.signature.inputs.len();
        self.formulas.turning().into_iter().filter(|&(variable, _)| variable < dimensions).collect()
    }

    /// Multiplies every input and every output of the model by a factor. Empty lists mean no factors.
    pub fn with_factors(mut self, factors: [Vec<f64>; 2]) -> Self {
        self.model.iter_mut().for_each(|model| model.factors.clone_from(&factors));
        self
    }

    /// Returns a flag for each formula that the outputs need, and true if they need the unknowns.
    pub fn used(&self) -> (Vec<bool>, bool) {
        let needs = self.all_needs(&self.outputs);
        let driving = if needs.answers.is_empty() { Vec::new() } else { self.driving() };
        let unknowns = needs.unknowns || driving.iter().any(|&formula| self.drives_by_unknowns(formula));
        let outputs = self.outputs.iter().filter_map(|origin| match origin {
            Origin::Formula(formula) => Some(*formula),
            _ => None,
        });
        let conditions = if unknowns { self.named..self.formulas.len() } else { 0..0 };
        let mut used = self.formulas.used(outputs.chain(conditions).chain(driving));
        used.truncate(self.named);
        (used, unknowns)
    }

    fn offered(&self, name: &str) -> Option<usize> {
        self.model.as_ref()?.function.signature().output(name)
    }

    /// Returns the dimensions that an output can depend on, or None if there is no model to ask.
    fn depends_on(&self, origin: Origin) -> Option<Vec<usize>> {
        let Needs { mut dimensions, answers, .. } = self.needs(origin);
        for answer in answers {
            let model = self.model.as_ref()?;
            let all = || (0..model.inputs.len()).collect();
            // A black box may depend on each of its inputs, but on no other dimension.
            let inputs: Vec<usize> = model.function.signature().outputs[answer].depends_on.clone().unwrap_or_else(all);
            inputs.iter().for_each(|&input| dimensions.extend(self.behind(model.inputs[input])));
        }
        dimensions.sort_unstable();
        dimensions.dedup();
        Some(dimensions)
    }

    /// Returns the needs of an output. An unknown needs everything that the conditions depend on.
    fn needs(&self, origin: Origin) -> Needs {
        let mut needs = match origin {
            Origin::Formula(formula) => self.split(self.formulas.variables(formula)),
            Origin::Model(output) => Needs { answers: vec![output], ..Needs::default() },
            Origin::Unknown(_) => Needs { unknowns: true, ..Needs::default() },
        };
        if let (true, Some(assembler)) = (needs.unknowns, &self.assembler) {
            let more = self.split(assembler.uses());
            needs.dimensions.extend(more.dimensions);
            needs.answers.extend(more.answers);
        }
        for part in [&mut needs.dimensions, &mut needs.answers] {
            part.sort_unstable();
            part.dedup();
        }
        needs
    }

    /// Splits variables of the formulas into dimensions, outputs of the model, and unknowns.
    fn split(&self, variables: &[usize]) -> Needs {
        let (dimensions, given) = (self.signature.inputs.len(), self.given());
        let of_model = variables.iter().filter(|&&index| (dimensions..given).contains(&index));
        Needs {
            dimensions: variables.iter().copied().filter(|&index| index < dimensions).collect(),
            answers: of_model.map(|index| index - dimensions).collect(),
            unknowns: variables.iter().any(|&index| index >= given),
        }
    }

    /// Returns the number of variables that are not unknowns.
    fn given(&self) -> usize {
        self.signature.inputs.len() + self.model.as_ref().map_or(0, |model| model.function.signature().outputs.len())
    }

    /// Returns the merged needs of these outputs.
    fn all_needs(&self, origins: &[Origin]) -> Needs {
        Needs::all(&origins.iter().map(|&origin| self.needs(origin)).collect::<Vec<_>>())
    }

    fn origins(&self, outputs: &[usize]) -> Vec<Origin> {
        outputs.iter().map(|&output| self.outputs[output]).collect()
    }

    /// Returns the nominal state of the conditions and the number of evaluations that it cost, or None if it cannot be sought now.
    ///
    /// If conditions use outputs of the model, the first call evaluates the model at the nominal point.
    fn anchor(&self, run: &Run<'_>) -> (Option<Result<Arc<Anchor>, EvaluationError>>, i64) {
        let Some(assembler) = &self.assembler else { return (None, 0) };
        let needed = self.split(assembler.uses()).answers;
        let mut given = assembler.nominal().to_vec();
        given.resize(self.given(), f64::NAN);
        let (mut missing, mut spent) = (None, 0);
        let anchor = assembler.anchor(&self.formulas, || {
            if !needed.is_empty() {
                let answers = self.ask_model(&Points::repeated(assembler.nominal(), 1), &run.quiet(), &needed);
                spent = answers.extra() + i64::from(!answers.is_open(0, 0));
                for (column, &output) in needed.iter().enumerate() {
                    let Some(value) = answers.value(0, column) else {
                        missing = answers.error(0, column).cloned().map(Err);
                        return None;
                    };
                    given[self.signature.inputs.len() + output] = value;
                }
            }
            Some(given)
        });
        (anchor.map(|anchor| anchor.map_err(EvaluationError::from)).or(missing), spent)
    }
}

impl AssemblyFunction for Composite {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let needs = self.all_needs(&self.origins(outputs));
        if let (true, Some(assembler)) = (needs.unknowns, &self.assembler)
            && self.split(assembler.uses()).answers.is_empty()
            && let (Some(Err(error)), _) = self.anchor(&Run::to_the_end())
        {
            return Err(error);
        }
        match &self.model {
            Some(model) if !needs.answers.is_empty() => {
                let info = model.function.prepare(&needs.answers)?;
                // A formula over the model's answers has no gradients, because only those of the model itself are passed on.
                let plain = self.origins(outputs).iter().all(|origin| matches!(origin, Origin::Model(_)));
                let plain = plain && !self.driving().into_iter().any(|formula| self.drives_by_unknowns(formula));
                Ok(info.map(|info| ModelInfo { gradients: info.gradients && plain, ..info }))
            }
            _ => Ok(None),
        }
    }

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        let origin = self.outputs[output];
        let Needs { answers, unknowns, .. } = self.needs(origin);
        match origin {
            Origin::Formula(formula) if answers.is_empty() && !unknowns => Some(self.formulas.bounds(formula, region)),
            _ => None,
        }
    }

    /// Returns magnitudes for formulas of the dimensions alone.
    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        let alone = |&output: &usize| {
            let Needs { answers, unknowns, .. } = self.needs(self.outputs[output]);
            match self.outputs[output] {
                Origin::Formula(formula) if answers.is_empty() && !unknowns => Some(formula),
                _ => None,
            }
        };
        let formulas: Vec<Option<usize>> = outputs.iter().map(alone).collect();
        let known: Vec<usize> = formulas.iter().flatten().copied().collect();
        let mut magnitudes = self.formulas.magnitudes(&known, |index| point[index]).into_iter();
        let of = |formula: Option<usize>| formula.and_then(|_| magnitudes.next()).filter(|terms| terms.is_finite());
        formulas.into_iter().map(of).collect()
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.evaluate_points(request, run, out);
    }

    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        self.exact(outputs, directions, None)
    }

    fn derivatives_per(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: &[i32],
    ) -> Vec<Option<Derivatives>> {
        let ordinary = exponents.iter().all(|&exponent| exponent == 0);
        self.exact(outputs, directions, Some(exponents).filter(|_| !ordinary))
    }

    fn sent(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
        self.model_points(points)
    }

    fn driven(&self) -> Option<&Composite> {
        (!self.driving().is_empty()).then_some(self)
    }

    fn switches(&self, output: usize) -> Option<Switches> {
        self.switches_of(output)
    }

    fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        self.margins_of(output, points)
    }

    fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
        self.degree_of(output, varying)
    }

    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        self.polynomial_of(output, centre, scale)
    }

    fn account(&self) -> Option<EvaluatorAccount> {
        self.model.as_ref()?.function.account()
    }

    fn own_checks(&self, answers: usize) -> usize {
        self.model.as_ref().map_or(0, |model| model.function.own_checks(answers))
    }

    /// Returns failures of a model that receives dimensions. The values of driving formulas belong to no single point: such failures are
    /// left out.
    fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
        let Some(model) = self.model.as_ref().filter(|model| model.driving().next().is_none()) else {
            return Vec::new();
        };
        let needs: Vec<Needs> = outputs.iter().map(|&output| self.needs(self.outputs[output])).collect();
        let of_model = model.function.recorded_failures(&Needs::all(&needs).answers);
        let mut failures = Vec::new();
        for failure in of_model {
            let Some(point) = model.dimensions_of(&failure.point, self.signature.inputs.len()) else { continue };
            // Every output that uses the answer has no value there.
            let lost = outputs.iter().zip(&needs).filter(|(_, needs)| needs.answers.contains(&failure.output));
            failures.extend(lost.map(|(&output, _)| RecordedFailure { output, point: point.clone() }));
        }
        failures
    }

    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        let Needs { unknowns, answers, .. } = self.all_needs(&self.origins(outputs));
        let singular = |assembler: &Assembler| assembler.known_anchor()?.nearly_singular(assembler);
        let found = self.assembler.as_deref().filter(|_| unknowns).and_then(singular);
        let found = found.map(|(unknown, condition)| Warning::NearSingular { unknown, condition });
        let of_model = self.model.as_ref().map(|model| model.function.warnings(&answers)).unwrap_or_default();
        found.into_iter().chain(of_model).collect()
    }
}
