//! Inputs of the model: by name for a built-in model, and those of `[model] inputs` for a program.

use crate::build::formula_text::Written;
use crate::dimension;
use crate::entries::file::{ModelEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::error::{Fault, Faults, StudyFault, fault};
use sensitol::assembly::{
    self, AssemblyFunction, Composite, CompositeError, Input, Parts, Points, Request, Responses, Run,
};
use sensitol_external::Greeting;
use sensitol_models::{Model, ModelInput};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;

/// Values that a program is sent: names, their sources, and the greeting.
pub(crate) struct ToProgram {
    pub(crate) inputs: Vec<Input>,
    pub(crate) sources: Vec<assembly::Source>,
    pub(crate) greeting: Greeting,
}

/// Sources of the inputs of a built-in model: a dimension, a formula, a constant, or its own nominal value.
pub(crate) fn of_built_in(
    model: &Model,
    dimensions: &[Dimension],
    constants: &[(String, f64)],
    written: &Written<'_>,
) -> Vec<assembly::Source> {
    let source = |input: &ModelInput| {
        named(input.name, dimensions, constants, written).unwrap_or(assembly::Source::Fixed(input.nominal))
    };
    model.inputs.iter().map(source).collect()
}

/// Source of the dimension, formula or constant of this name. Returns None if there is none.
fn named(
    name: &str,
    dimensions: &[Dimension],
    constants: &[(String, f64)],
    written: &Written<'_>,
) -> Option<assembly::Source> {
    let dimension = dimensions.iter().position(|dimension| dimension.name() == name).map(assembly::Source::Dimension);
    let formula = || written.place(name).map(assembly::Source::Formula);
    let constant = || constants.iter().find(|(constant, _)| constant == name).map(|(_, value)| *value);
    dimension.or_else(formula).or_else(|| constant().map(assembly::Source::Fixed))
}

/// Inputs of a program: the names of `[model] inputs`, or else all dimensions. Constants are sent once, with the greeting.
pub(crate) fn of_program(
    file: &StudyFile,
    dimensions: &[Dimension],
    constants: &[(String, f64)],
    written: &Written<'_>,
    outputs: &[(String, Option<String>)],
) -> Result<ToProgram, Faults> {
    let input =
        |dimension: &Dimension| Input { name: dimension.name().to_owned(), unit: dimension.unit().map(str::to_owned) };
    let Some(names) = asked(file) else {
        let used = |name: &str| written.names().any(|used| used == name);
        let names = dimensions.iter().map(Dimension::name).chain(constants.iter().map(|(name, _)| name.as_str()));
        let greeting = Greeting {
            nominal: dimensions.iter().map(Dimension::nominal).collect(),
            constants: constants.to_vec(),
            optional: names.filter(|name| used(name)).map(str::to_owned).collect(),
        };
        let sources = (0..dimensions.len()).map(assembly::Source::Dimension).collect();
        return Ok(ToProgram { inputs: dimensions.iter().map(input).collect(), sources, greeting });
    };
    let mut faults = Faults::default();
    let mut sources = Vec::new();
    for (index, name) in names.get_ref().iter().enumerate() {
        let text = name.get_ref();
        let at = |found| fault(name.span(), format!("model.inputs[{}]", index + 1), found);
        if names.get_ref()[..index].iter().any(|earlier| earlier.get_ref() == text) {
            faults.0.push(at(StudyFault::DuplicateKey { key: text.clone() }));
            continue;
        }
        match named(text, dimensions, constants, written) {
            Some(source) => sources.push(source),
            None => {
                let known = (dimensions.iter().map(|dimension| dimension.name().to_owned()))
                    .chain(constants.iter().map(|(name, _)| name.clone()))
                    .chain(written.formulas.iter().map(|named| named.name.clone()));
                let known: Vec<String> = known.collect();
                let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
                let what = "dimension, constant or formula";
                faults.0.push(at(StudyFault::UnknownWord { what, found: text.clone(), nearest, known }));
            }
        }
    }
    faults.none()?;
    let value = |source: &assembly::Source| match *source {
        assembly::Source::Dimension(dimension) => Ok(dimensions[dimension].nominal()),
        assembly::Source::Fixed(value) => Ok(value),
        assembly::Source::Formula(formula) => nominal(formula, dimensions, constants, written, outputs),
    };
    let nominal = sources.iter().map(value).collect::<Result<Vec<f64>, Fault>>()?;
    let inputs = names.get_ref().iter().zip(&sources).map(|(name, source)| match *source {
        assembly::Source::Dimension(dimension) => input(&dimensions[dimension]),
        assembly::Source::Formula(formula) => {
            Input { name: name.get_ref().clone(), unit: written.formulas[formula].unit.map(str::to_owned) }
        }
        assembly::Source::Fixed(_) => Input { name: name.get_ref().clone(), unit: of_constant(file, name.get_ref()) },
    });
    let greeting = Greeting { nominal, constants: Vec::new(), optional: Vec::new() };
    Ok(ToProgram { inputs: inputs.collect(), sources, greeting })
}

fn of_constant(file: &StudyFile, name: &str) -> Option<String> {
    let constant = file.constants.0.iter().find(|(constant, _)| constant.get_ref() == name);
    constant.and_then(|(_, one)| one.get_ref().unit.clone())
}

/// Names of `[model] inputs`. Returns None if they are not given or the model is not a program.
fn asked(file: &StudyFile) -> Option<&Spanned<Vec<Spanned<String>>>> {
    let entry: &ModelEntry = file.model.as_ref()?.get_ref();
    entry.inputs.as_ref().filter(|_| entry.command.is_some())
}

/// The value of a formula that drives a program, at the nominal dimensions.
fn nominal(
    index: usize,
    dimensions: &[Dimension],
    constants: &[(String, f64)],
    written: &Written<'_>,
    outputs: &[(String, Option<String>)],
) -> Result<f64, Fault> {
    let name = written.formulas[index].name.clone();
    let (kept, conditions) = closure(index, written);
    let unknown = |name: &str| conditions && written.is_unknown(name);
    for &formula in &kept {
        let used = written.formulas[formula].formula.names();
        let answer = used.map(|(used, _)| used).find(|used| {
            named(used, dimensions, constants, written).is_none()
                && !unknown(used)
                && outputs.iter().any(|(output, _)| output == used)
        });
        if let Some(output) = answer {
            let output = output.to_owned();
            return Err(written.at(index, StudyFault::DrivenByOutput { name, output }));
        }
    }
    let parts = Parts {
        inputs: (dimensions.iter()).map(|dimension| Input { name: dimension.name().to_owned(), unit: None }).collect(),
        constants: constants.to_vec(),
        model: None,
        formulas: (kept.iter())
            .map(|&formula| (written.formulas[formula].name.clone(), written.formulas[formula].formula.clone()))
            .collect(),
        conditions: written.implicit.as_ref().filter(|_| conditions).map(|implicit| implicit.conditions.clone()),
        outputs: vec![(name.clone(), None)],
    };
    let failed = |reason: String| written.at(index, StudyFault::NoNominal { name: name.clone(), reason });
    let composite = Composite::new(parts).map_err(|error| match error {
        CompositeError::Formula { index, error, .. } if index < kept.len() => {
            written.at(kept[index], StudyFault::Formula(error.fault))
        }
        other => failed(other.to_string()),
    })?;
    let points = Points::from_rows(&[dimensions.iter().map(Dimension::nominal).collect::<Vec<_>>()]);
    let mut out = Responses::open(1, 1);
    composite.evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut out);
    out.value(0, 0).ok_or_else(|| failed(out.error(0, 0).map(ToString::to_string).unwrap_or_default()))
}

/// Indices of the formulas that one formula needs, itself included. True if it also needs the unknowns.
fn closure(index: usize, written: &Written<'_>) -> (Vec<usize>, bool) {
    let (mut kept, mut conditions, mut next) = (vec![index], false, 0);
    let take = |name: &str, kept: &mut Vec<usize>| {
        if let Some(place) = written.place(name).filter(|place| !kept.contains(place)) {
            kept.push(place);
        }
    };
    while next < kept.len() {
        let names: Vec<String> =
            written.formulas[kept[next]].formula.names().map(|(name, _)| name.to_owned()).collect();
        next += 1;
        for name in names {
            take(&name, &mut kept);
            if !conditions && written.is_unknown(&name) {
                conditions = true;
                let of_conditions = written.implicit.iter().flat_map(|implicit| implicit.conditions.formulas());
                let used: Vec<String> = of_conditions
                    .flat_map(|(_, formula)| formula.names().map(|(name, _)| name.to_owned()).collect::<Vec<_>>())
                    .collect();
                used.iter().for_each(|name| take(name, &mut kept));
            }
        }
    }
    kept.sort_unstable();
    (kept, conditions)
}

/// Checks that all dimensions and constants are in `[model] inputs` or are used by a formula.
pub(crate) fn known_to_program(file: &StudyFile, used: &dyn Fn(&str) -> bool) -> Result<(), Faults> {
    let (Some(names), Some(model)) = (asked(file), &file.model) else { return Ok(()) };
    let sent = |name: &str| names.get_ref().iter().any(|sent| sent.get_ref() == name);
    let mut faults = Faults::default();
    for name in dimension::names(&file.dimensions).iter().filter(|name| !sent(name.get_ref()) && !used(name.get_ref()))
    {
        let text = name.get_ref();
        let known: Vec<String> = names.get_ref().iter().map(|name| name.get_ref().clone()).collect();
        let command = model.get_ref().command.as_ref().map(|command| command.get_ref().join(" ")).unwrap_or_default();
        let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown = StudyFault::UnknownInput { model: command, name: text.clone(), nearest, known };
        faults.0.push(fault(name.span(), format!("dimensions.{text}"), unknown));
    }
    faults.none()
}
