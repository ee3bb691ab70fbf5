//! The assembly function of a study: a model, formulas, or formulas on top of a model.

use std::sync::Arc;

use super::formula::{Formula, FormulaError, FormulaSet, Meaning};
use super::process::Adapter;
use super::{
    Ask, AssemblyFunction, Bounds, EvaluationError, Input, Output, Points, Responses, Run, Signature, in_blocks,
};

/// Where a model's input comes from.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Source {
    /// The dimension of this index.
    Dimension(usize),
    /// Always this value.
    Fixed(f64),
}

/// A formula that a [`Composite`] cannot resolve.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("formula `{name}`: {error}")]
pub struct CompositeError {
    /// The formula's name.
    pub name: String,
    /// What is wrong with it.
    pub error: FormulaError,
}

/// Dimensions in; formulas of dimensions, constants and the outputs of a model out.
///
/// Only what the asked outputs need is evaluated: a model is asked only for those of its outputs that a formula or
/// characteristic in question uses, and a point at which one of them fails costs just the outputs that use it.
pub struct Composite {
    signature: Signature,
    formulas: FormulaSet,
    model: Option<Inner>,
    /// For every output, the formula or the model's output that it is.
    outputs: Vec<Origin>,
}

struct Inner {
    function: Arc<dyn AssemblyFunction>,
    inputs: Vec<Source>,
}

#[derive(Debug, Clone, Copy)]
enum Origin {
    Formula(usize),
    Model(usize),
}

/// What a [`Composite`] is made of.
#[derive(Default)]
pub struct Parts {
    /// The dimensions, in order.
    pub inputs: Vec<Input>,
    /// Names that stand for numbers in formulas.
    pub constants: Vec<(String, f64)>,
    /// The model, with the source of each of its inputs.
    pub model: Option<(Arc<dyn AssemblyFunction>, Vec<Source>)>,
    /// Formulas in any order; each name once.
    pub formulas: Vec<(String, Formula)>,
    /// Names and units of what can be asked: formulas, or else outputs of the model.
    pub outputs: Vec<(String, Option<String>)>,
}

impl Composite {
    /// Resolves the formulas' names: first other formulas, then dimensions, constants and outputs of the model.
    ///
    /// # Errors
    /// The first formula that uses an undefined name or needs itself.
    ///
    /// # Panics
    /// When an output is neither a formula nor an output of the model: the caller knows both.
    pub fn new(parts: Parts) -> Result<Self, CompositeError> {
        let Parts { inputs, constants, model, formulas, outputs } = parts;
        let names: Vec<String> = formulas.iter().map(|(name, _)| name.clone()).collect();
        let model = model.map(|(function, inputs)| Inner { function, inputs });
        let offers = model.as_ref().map_or(&[][..], |model| &model.function.signature().outputs);
        let dimensions =
            inputs.iter().enumerate().map(|(index, input)| (input.name.as_str(), Meaning::Variable(index)));
        let constants = constants.iter().map(|(name, value)| (name.as_str(), Meaning::Constant(*value)));
        let answers = offers
            .iter()
            .enumerate()
            .map(|(index, output)| (output.name.as_str(), Meaning::Variable(inputs.len() + index)));
        let formulas = FormulaSet::new(formulas, answers.chain(constants).chain(dimensions))
            .map_err(|(index, error)| CompositeError { name: names[index].clone(), error })?;

        let mut composite = Self {
            signature: Signature {
                costly: model.as_ref().is_some_and(|model| model.function.signature().costly),
                inputs,
                ..Signature::default()
            },
            formulas,
            model,
            outputs: Vec::with_capacity(outputs.len()),
        };
        for (name, unit) in outputs {
            let origin = match names.iter().position(|formula| *formula == name) {
                Some(formula) => Origin::Formula(formula),
                None => Origin::Model(composite.offered(&name).expect("an output is a formula or the model's")),
            };
            let depends_on = composite.depends_on(origin);
            composite.outputs.push(origin);
            composite.signature.outputs.push(Output { name, unit, depends_on });
        }
        Ok(composite)
    }

    /// The formulas, for who wants to know what is used.
    pub fn formulas(&self) -> &FormulaSet {
        &self.formulas
    }

    fn offered(&self, name: &str) -> Option<usize> {
        self.model.as_ref()?.function.signature().output(name)
    }

    /// The dimensions that an output can depend on; None when the model does not say.
    fn depends_on(&self, origin: Origin) -> Option<Vec<usize>> {
        let (mut dimensions, answers) = match origin {
            Origin::Formula(formula) => self.split(self.formulas.variables(formula)),
            Origin::Model(output) => (Vec::new(), vec![output]),
        };
        for answer in answers {
            let model = self.model.as_ref()?;
            let all = || (0..model.inputs.len()).collect();
            // A black box may depend on every input it has, but on no dimension that is none of its inputs.
            let inputs: Vec<usize> = model.function.signature().outputs[answer].depends_on.clone().unwrap_or_else(all);
            dimensions.extend(inputs.iter().filter_map(|&input| match model.inputs[input] {
                Source::Dimension(dimension) => Some(dimension),
                Source::Fixed(_) => None,
            }));
        }
        dimensions.sort_unstable();
        dimensions.dedup();
        Some(dimensions)
    }

    /// Variables of the formulas as dimensions and outputs of the model.
    fn split(&self, variables: Vec<usize>) -> (Vec<usize>, Vec<usize>) {
        let dimensions = self.signature.inputs.len();
        let (of_dimensions, of_model): (Vec<_>, Vec<_>) = variables.into_iter().partition(|&index| index < dimensions);
        (of_dimensions, of_model.into_iter().map(|index| index - dimensions).collect())
    }

    /// The outputs of the model that `origins` need, ascending.
    fn needed(&self, origins: &[Origin]) -> Vec<usize> {
        let mut needed: Vec<usize> = origins
            .iter()
            .flat_map(|&origin| match origin {
                Origin::Formula(formula) => self.split(self.formulas.variables(formula)).1,
                Origin::Model(output) => vec![output],
            })
            .collect();
        needed.sort_unstable();
        needed.dedup();
        needed
    }

    /// Asks the model for just what `origins` need: its outputs, ascending, and its answers.
    fn ask_model(&self, ask: &Ask<'_>, run: &Run<'_>, origins: &[Origin]) -> (Vec<usize>, Responses) {
        let needed = self.needed(origins);
        let mut answers = Responses::open(ask.points.rows(), needed.len());
        if let (Some(model), false) = (&self.model, needed.is_empty()) {
            let rows = ask.points.rows();
            let columns: Vec<Vec<f64>> = (model.inputs.iter())
                .map(|source| match *source {
                    Source::Dimension(dimension) => ask.points.column(dimension).to_vec(),
                    Source::Fixed(value) => vec![value; rows],
                })
                .collect();
            let points = Points::from_columns(rows, &columns);
            model.function.evaluate(&Ask::values(&points, &needed), run, &mut answers);
        }
        (needed, answers)
    }
}

impl AssemblyFunction for Composite {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<Adapter>, EvaluationError> {
        let origins: Vec<Origin> = outputs.iter().map(|&output| self.outputs[output]).collect();
        let needed = self.needed(&origins);
        match &self.model {
            Some(model) if !needed.is_empty() => model.function.prepare(&needed),
            _ => Ok(None),
        }
    }

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        match self.outputs[output] {
            Origin::Formula(formula) if self.needed(&[self.outputs[output]]).is_empty() => {
                Some(self.formulas.bounds(formula, region))
            }
            _ => None,
        }
    }

    fn evaluate(&self, ask: &Ask<'_>, run: &Run<'_>, out: &mut Responses) {
        let origins: Vec<Origin> = ask.outputs.iter().map(|&output| self.outputs[output]).collect();
        let (needed, answers) = self.ask_model(ask, &run.quiet(), &origins);
        let answer = |output: usize| needed.binary_search(&output).expect("the model was asked for it");
        // Which formulas fill which columns of `out`.
        let (columns, formulas): (Vec<usize>, Vec<usize>) = (origins.iter().enumerate())
            .filter_map(|(column, origin)| match origin {
                Origin::Formula(formula) => Some((column, *formula)),
                Origin::Model(_) => None,
            })
            .unzip();
        let uses: Vec<Vec<usize>> =
            formulas.iter().map(|&formula| self.split(self.formulas.variables(formula)).1).collect();

        // What the model has answered is not lost to a stop: only the model itself is stopped.
        let run = if needed.is_empty() { *run } else { run.unstopped() };
        in_blocks(ask, &run, out, |points, rows, out| {
            let variable = |index: usize| -> &[f64] {
                let dimensions = self.signature.inputs.len();
                let column = match index.checked_sub(dimensions) {
                    None => points.column(index),
                    Some(output) => answers.column(answer(output)),
                };
                &column[rows.clone()]
            };
            for (column, origin) in origins.iter().enumerate() {
                if let Origin::Model(output) = *origin {
                    (rows.clone().enumerate())
                        .for_each(|(r, row)| out.pass_on(r, column, &answers, row, answer(output)));
                }
            }
            self.formulas.evaluate(&formulas, rows.len(), variable, |position, row, value| {
                let column = columns[position];
                if value.is_finite() {
                    out.set(row, column, value);
                    return;
                }
                // An answer that the formula needed is missing: then it is that answer's error, or still open.
                let missing =
                    uses[position].iter().find(|&&output| answers.value(rows.start + row, answer(output)).is_none());
                match missing {
                    Some(&output) => out.pass_on(row, column, &answers, rows.start + row, answer(output)),
                    None => {
                        let explained = self.formulas.explain(formulas[position], |index| variable(index)[row]);
                        let error =
                            explained.map_or(EvaluationError::NotFinite { value }, |failure| Box::new(failure).into());
                        out.fail(row, column, error);
                    }
                }
            });
        });
        out.spent(answers.extra() + answers.count_reused() as i64);
        out.reused(answers.count_reused());
        out.doubt(answers.doubts().iter().cloned());
    }
}
