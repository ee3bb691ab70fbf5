//! Builds the problem from the parsed study file: names, model, formulas and characteristics are checked and put together.

use crate::build::inflation;
use std::collections::HashMap;
use std::sync::Arc;

use crate::build::compensators::{self, extreme};
use crate::build::correlation::correlated;
use crate::build::costs::{costs, holding, requirement};
use crate::build::driver as drive;
use crate::build::formula_text::{Named, Written};
use crate::build::implicit::{implicit, placed};
use crate::build::inspection::inspected;
use crate::build::loss::{losses, setups};
use crate::build::measured_rows as joint;
use crate::build::model::{ModelOf, model, process, signature};
use crate::build::units;
use crate::build::zone;
use crate::data::Data;
use crate::dimension;
use crate::entries::adjust_entry::MotionEntry;
use crate::entries::file::{CharacteristicEntry, Entries, StudyFile};
use crate::entries::spanned::Spanned;
use crate::entries::values::NominalEntry;
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Closing, Elements};
use crate::faults::compensator_fault::CompensatorFault;
use crate::files;
use crate::files::NamedFile;
use crate::source::{Source, in_formula};
use sensitol::allocation::{Priced, QualityLoss, SetUp};
use sensitol::assembly::formula::{Formula, FormulaError, FormulaFault, is_plain, is_reserved};
use sensitol::assembly::{AssemblyFunction, Composite, CompositeError, Input, Parts, Signature};
use sensitol::method::Options;
use sensitol::problem::Problem;
use sensitol::warning::{NameKind, Warning, aggregated};
use sensitol_external::Greeting;
use sensitol_models::Model;
use sensitol_numeric::characteristic::{Characteristic, LimitsError, SpecLimits};
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::{element, is_hidden, nearest};
use sensitol_numeric::requirement::Requirement;

/// The content of a study file.
pub(crate) struct Built {
    pub(crate) problem: Problem,
    pub(crate) options: Options,
    pub(crate) costs: Vec<Priced>,
    pub(crate) losses: Vec<QualityLoss>,
    pub(crate) setups: Vec<SetUp>,
    pub(crate) requirements: Vec<(String, Requirement)>,
    pub(crate) warnings: Vec<Warning>,
    /// Contents of the data files that the study reads.
    pub(crate) data: Vec<Arc<[u8]>>,
    /// These files with names and paths, and those of the model.
    pub(crate) files: Vec<NamedFile>,
    /// Program that answers, with its arguments.
    pub(crate) program: Option<Vec<String>>,
}

pub(crate) fn build(
    file: &StudyFile,
    source: &Source,
    mut data: Data<'_>,
    elements: &Elements,
) -> Result<Built, Faults> {
    let written = |entry: &CharacteristicEntry| entry.formula.is_some();
    let unknown = |name: &str| file.unknowns.0.iter().any(|(known, _)| known.get_ref() == name);
    let all = file.characteristics.0.iter();
    // A characteristic is `open` if neither a formula nor an unknown gives its value: then a model must.
    let made = |entry: &CharacteristicEntry| written(entry) || extreme(entry).is_some();
    let open = all.clone().any(|(name, of)| !made(of.get_ref()) && !unknown(name.get_ref()));
    let evaluated = model(file.model.as_ref(), open, source)?;
    let program = evaluated.as_ref().is_some_and(ModelOf::is_external);
    let model = evaluated.as_ref().and_then(ModelOf::built_in);
    // Sections that do not depend on each other are all read before the build stops, so that their faults are reported together.
    let mut faults = Faults::default();
    faults.take(names(file, model));
    let mut blocks = faults.take(joint::blocks(file, &mut data)).unwrap_or_default();
    blocks.extend(faults.take(zone::zones(file).map_err(Faults::from)).unwrap_or_default());
    let dimensions = faults.take(dimensions(file, model, &mut data)).unwrap_or_default();
    let dimensions = zone::zoned(dimensions, &blocks);
    let formulas = faults.take(formulas(file, source)).unwrap_or_default();
    faults.take(characteristics(file, model, program));
    for (what, empty) in
        [("dimension", file.dimensions.0.is_empty()), ("characteristic", file.characteristics.0.is_empty())]
    {
        if empty {
            faults.0.push(Fault { span: None, key: String::new(), fault: Box::new(StudyFault::Nothing { what }) });
        }
    }
    faults.none()?;
    // From here on each step needs the results of the previous ones, so the first fault ends the build.
    let implicit = implicit(file, &dimensions, source, elements)?;
    let written = Written { formulas, implicit };
    let used = |name: &str| written.names().any(|used| used == name);
    known_to_model(file, model, &used)?;
    drive::known_to_program(file, &used)?;
    let (characteristics, outputs) = characteristics(file, model, program)?;
    let composite = compose(file, evaluated.as_ref(), &dimensions, &written, outputs.clone(), source)?;
    // Units are checked on the formulas as written. A conversion changes the formulas, so they are composed again.
    let held = units::Units::of(file, model, &dimensions, &written, source)?;
    let of_units = held.check(&composite)?;
    let composite = match held.converted(&written) {
        None => composite,
        Some(converted) => {
            let again = compose(file, evaluated.as_ref(), &dimensions, &converted, outputs, source)?;
            again.with_factors(held.factors())
        }
    };
    let mut warnings = aggregated(std::mem::take(&mut data.warnings));
    warnings.extend(outside_limits(file));
    warnings.extend(of_units);
    warnings.extend(full_turns(&dimensions, &composite));
    warnings.extend(elements.closing.iter().map(|closing| interference(closing, &dimensions, &blocks)));
    idle_formula(program, &composite, &written, &elements.made)?;
    warnings.extend(unused(file, evaluated.as_ref(), &composite, &written, &used, &elements.made));
    // Costs and [analysis] may change dimensions: the end of the band that stays, and the factors of the RSS.
    let dimensions = inflation::taken(file, holding(file, dimensions)?)?;
    let problem = compensators::problem(file, dimensions, composite, characteristics, source)?;
    let (problem, of_rows) = correlated(problem, &file.correlation.0, &blocks)?;
    warnings.extend(of_rows);
    let problem = crate::build::options::products(&file.analysis, problem)?;
    let options = crate::build::options::options(&file.analysis, &problem)?;
    let costs = costs(file, source, &problem)?;
    let (losses, setups) = (losses(file, &problem)?, setups(file)?);
    let requirements = requirements(file, &problem)?;
    let problem = requiring(problem, &requirements)?;
    // Files of the model follow those of the dimensions.
    let mut files = data.files();
    files.extend(file.model.iter().flat_map(|entry| files::of_model(entry.get_ref(), source.place.path())));
    let started = evaluated.as_ref().filter(|_| !source.externals.elsewhere()).and_then(ModelOf::program);
    let program = started.map(<[String]>::to_vec);
    Ok(Built { problem, options, costs, losses, setups, requirements, warnings, data: data.bytes(), files, program })
}

/// Warning that a hole may be smaller than its pin, with the share of pairs for which it is. The share is None if it cannot be computed.
fn interference(closing: &Closing, dimensions: &[Dimension], blocks: &[joint::Block]) -> Warning {
    /// Quantiles of the pin at which the distribution function of the hole is averaged.
    const PLACES: u32 = 4096;
    let dimension = |name: &str| {
        let name = name.trim_matches('`');
        let alone = !blocks.iter().any(|block| block.dimensions.iter().any(|of| of == name));
        dimensions.iter().find(|dimension| dimension.name() == name && alone)
    };
    // A size that does not vary is a number.
    let fixed = |text: &str| match dimension(text) {
        Some(dimension) => dimension.distribution().is_none().then(|| dimension.nominal()),
        None => text.parse().ok(),
    };
    let law = |text: &str| dimension(text).and_then(|dimension| dimension.distribution()?.probability());
    let Closing { element, hole, pin } = closing;
    let share = match (fixed(hole), law(hole), fixed(pin), law(pin)) {
        (_, Some(hole), Some(pin), _) => Some(hole.cdf(pin)),
        (Some(hole), _, _, Some(pin)) => Some(pin.sf(hole)),
        (_, Some(hole), _, Some(pin)) => {
            let place = |index: u32| pin.quantile((f64::from(index) + 0.5) / f64::from(PLACES));
            Some((0..PLACES).map(|index| hole.cdf(place(index))).sum::<f64>() / f64::from(PLACES))
        }
        _ => None,
    };
    Warning::Interference { element: element.clone(), share }
}

/// Warning of dimensions that are uniform over whole turns inside a sine or cosine.
fn full_turns(dimensions: &[Dimension], composite: &Composite) -> Option<Warning> {
    /// Permitted difference to a whole number of turns: bands in degrees and a rounded pi are not exact.
    const OFF: f64 = 1e-4;
    let turns = |&(d, radians): &(usize, f64)| {
        let law = dimensions[d].distribution().filter(|law| law.name() == "uniform")?;
        let [low, high] = law.support();
        let turns = ((high - low) * radians).abs() / (2.0 * std::f64::consts::PI);
        (turns > 0.5 && (turns - turns.round()).abs() < OFF).then(|| dimensions[d].name().to_owned())
    };
    let mut found: Vec<String> = composite.turning().iter().filter_map(turns).collect();
    found.dedup();
    found.sort();
    found.dedup();
    (!found.is_empty()).then_some(Warning::PeriodicInput { dimensions: found })
}

/// Requirements of the characteristics that have one, by name.
fn requirements(file: &StudyFile, problem: &Problem) -> Result<Vec<(String, Requirement)>, Fault> {
    let mut requirements = Vec::new();
    for (characteristic, (name, entry)) in problem.characteristics().iter().zip(&file.characteristics.0) {
        let key = format!("characteristics.{}", name.get_ref());
        let required = requirement(characteristic, entry.get_ref(), &key)?;
        requirements.extend(required.map(|requirement| (name.get_ref().clone(), requirement)));
    }
    Ok(requirements)
}

/// Adds the requirements to the characteristics of the problem.
fn requiring(problem: Problem, requirements: &[(String, Requirement)]) -> Result<Problem, Fault> {
    let of = |one: &Characteristic| {
        let required = requirements.iter().find(|(name, _)| name == one.name());
        required.map_or(Ok(one.clone()), |(_, requirement)| one.clone().with_requirement(*requirement))
    };
    let fault = |error: Box<StudyFault>| Fault { span: None, key: String::new(), fault: error };
    let characteristics: Result<Vec<Characteristic>, _> = problem.characteristics().iter().map(of).collect();
    let characteristics = characteristics.map_err(|error| fault(Box::new(error.into())))?;
    problem.asking(characteristics).map_err(|error| fault(Box::new(error.into())))
}

/// Checks that every name is valid and means one thing only.
fn names(file: &StudyFile, model: Option<&Model>) -> Result<(), Faults> {
    let mut faults = Faults::default();
    let with_formula = file.characteristics.0.iter().filter(|(_, entry)| entry.get_ref().formula.is_some());
    let written = [file.formulas.names(), file.unknowns.names(), file.equations.names(), file.loops.names()];
    let formulas = written.iter().any(|names| !names.is_empty()) || with_formula.clone().next().is_some();
    let dimensions = dimension::names(&file.dimensions);
    let mut taken: HashMap<&str, &'static str> = HashMap::new();
    if let Some(model) = model {
        taken.extend(model.outputs.iter().map(|output| (output.name, "an output of the model")));
    }
    let all = [
        ("dimensions", "a dimension", dimensions.iter().collect()),
        ("constants", "a constant", file.constants.names()),
        ("formulas", "a formula", file.formulas.names()),
        ("unknowns", "an unknown", file.unknowns.names()),
        ("characteristics", "a characteristic", with_formula.map(|(name, _)| name).collect()),
    ];
    let all = all.into_iter().flat_map(|(section, by, names)| names.into_iter().map(move |name| (section, by, name)));
    for (section, by, name) in all {
        let text = name.get_ref();
        let at = |found| fault(name.span(), format!("{section}.{text}"), found);
        let found = if text.is_empty() {
            Some(StudyFault::EmptyName)
        } else if let Some(character) = text.chars().find(|&c| is_hidden(c)) {
            Some(StudyFault::HiddenCharacter { character })
        } else if is_reserved(text) && formulas {
            Some(StudyFault::ReservedName { name: text.clone() })
        } else {
            taken.insert(text, by).map(|earlier| match (earlier, by) {
                ("a dimension", "a formula") => StudyFault::DimensionAndFormula { name: text.clone() },
                (by, _) => StudyFault::NameTaken { name: text.clone(), by },
            })
        };
        faults.0.extend(found.map(at));
    }
    faults.none()
}

fn dimensions(file: &StudyFile, model: Option<&Model>, data: &mut Data<'_>) -> Result<Vec<Dimension>, Faults> {
    let input = |name: &str| model.and_then(|model| model.inputs.iter().find(|input| input.name == name));
    let with_unit = |dimension: Dimension| match (dimension.unit(), input(dimension.name())) {
        (None, Some(input)) => dimension.with_unit(input.unit),
        _ => dimension,
    };
    let (mut dimensions, mut faults) = (Vec::new(), Faults::default());
    for (name, entry) in &file.dimensions.0 {
        let of_model = |name: &str| input(name).map(|input| input.nominal);
        let of_line = dimension::dimensions(name, entry, &of_model, data).map_err(|found| {
            let below = if found.key.is_empty() { String::new() } else { format!(".{}", found.key) };
            // A fault without a place of its own within the line is shown at the dimension's name.
            let span = found.span.filter(|span| !span.is_empty()).unwrap_or_else(|| name.span());
            Fault {
                span: Some(span),
                key: format!("dimensions.{}{below}", element(name.get_ref())),
                fault: found.fault,
            }
        });
        dimensions.extend(faults.take(of_line).into_iter().flatten().map(with_unit));
    }
    faults.none().map(|()| dimensions)
}

fn formulas<'f>(file: &'f StudyFile, source: &Source) -> Result<Vec<Named<'f>>, Faults> {
    let mut faults = Faults::default();
    let own = file.formulas.0.iter().map(|(name, entry)| {
        let (span, text) = entry.get_ref().text(entry.span());
        let unit = entry.get_ref().unit.as_deref();
        (name, span, text, format!("formulas.{}", name.get_ref()), unit, false)
    });
    let of_characteristics = file.characteristics.0.iter().filter_map(|(name, entry)| {
        let text = entry.get_ref().formula.as_ref()?;
        let key = format!("characteristics.{}.formula", name.get_ref());
        Some((name, text.span(), text.get_ref().as_str(), key, entry.get_ref().unit.as_deref(), true))
    });
    let mut parsed: Vec<Named<'f>> = Vec::new();
    for (name, span, text, key, unit, result) in own.chain(of_characteristics) {
        let formula = Formula::parse(text)
            .map_err(|error| in_formula(source, span.clone(), key.clone(), of_several_words(file, text, error)));
        let formula = faults.take(formula);
        parsed.extend(formula.map(|formula| Named {
            name: name.get_ref().clone(),
            text,
            span,
            key,
            formula,
            unit,
            result,
        }));
    }
    faults.none().map(|()| parsed)
}

/// Checks that every dimension and constant is an input of the built-in model or is used by a formula.
fn known_to_model(file: &StudyFile, model: Option<&Model>, used: &dyn Fn(&str) -> bool) -> Result<(), Faults> {
    let Some(model) = model else { return Ok(()) };
    let mut faults = Faults::default();
    let dimensions = dimension::names(&file.dimensions);
    let names = (dimensions.iter().map(|name| ("dimensions", name)))
        .chain(file.constants.names().into_iter().map(|name| ("constants", name)));
    for (section, name) in names {
        let text = name.get_ref();
        if model.inputs.iter().any(|input| input.name == text) || used(text) {
            continue;
        }
        let known: Vec<String> = model.inputs.iter().map(|input| input.name.to_owned()).collect();
        let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown = StudyFault::UnknownInput { model: model.name.into(), name: text.clone(), nearest, known };
        faults.0.push(fault(name.span(), format!("{section}.{text}"), unknown));
    }
    faults.none()
}

type Outputs = Vec<(String, Option<String>)>;

fn characteristics(
    file: &StudyFile,
    model: Option<&Model>,
    program: bool,
) -> Result<(Vec<Characteristic>, Outputs), Faults> {
    let (mut characteristics, mut outputs, mut faults) = (Vec::new(), Vec::new(), Faults::default());
    for (name, entry) in &file.characteristics.0 {
        let (text, key) = (name.get_ref(), format!("characteristics.{}", name.get_ref()));
        let entry = entry.get_ref();
        let mut unit = entry.unit.clone();
        if let Some((motion, _)) = extreme(entry) {
            let unit = faults.take(unit_of_extreme(file, model, (entry, motion.get_ref()), &key));
            characteristics.extend(faults.take(characteristic(text, unit.flatten(), entry, &key)));
            continue;
        }
        // An external program states its outputs at its start, so they cannot be checked here.
        let unknowns = file.unknowns.names();
        if entry.formula.is_none() && !program && !unknowns.iter().any(|unknown| unknown.get_ref() == text) {
            let output = faults.take(offered(name, &key, model, &unknowns));
            unit = unit.or_else(|| Some(output?.unit.to_owned()));
        }
        outputs.push((text.clone(), unit.clone()));
        characteristics.extend(faults.take(characteristic(text, unit, entry, &key)));
    }
    faults.none().map(|()| (characteristics, outputs))
}

/// Unit of an extreme over a motion: that of the characteristic whose extreme it is.
fn unit_of_extreme(
    file: &StudyFile,
    model: Option<&Model>,
    (entry, motion): (&CharacteristicEntry, &MotionEntry),
    key: &str,
) -> Result<Option<String>, Fault> {
    let of = motion.of.get_ref();
    let own = file.characteristics.0.iter().find(|(name, _)| name.get_ref() == of);
    let own = own.and_then(|(_, entry)| entry.get_ref().unit.clone());
    let output = model.and_then(|model| model.outputs.iter().find(|output| output.name == of));
    let unit = own.or(output.map(|output| output.unit.to_owned()));
    match (&entry.unit, &unit) {
        (Some(given), unit) if Some(given) != unit.as_ref() => {
            let unit = unit.clone().unwrap_or_else(|| "which has none".to_owned());
            let found = CompensatorFault::ExtremeUnit { characteristic: of.clone(), unit };
            Err(fault(motion.of.span(), format!("{key}.unit"), found))
        }
        _ => Ok(unit),
    }
}

/// Output of the built-in model with the name of a characteristic that has no formula and is not an unknown.
fn offered<'m>(
    name: &Spanned<String>,
    key: &str,
    model: Option<&'m Model>,
    unknowns: &[&Spanned<String>],
) -> Result<&'m sensitol_models::ModelOutput, Fault> {
    let text = name.get_ref();
    let Some(model) = model else {
        if !unknowns.is_empty() {
            let known: Vec<String> = unknowns.iter().map(|unknown| unknown.get_ref().clone()).collect();
            let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
            let what = "formula or unknown";
            return Err(fault(name.span(), key, StudyFault::UnknownWord { what, found: text.clone(), nearest, known }));
        }
        let instead = "write what it is, such as formula = \"a + b - c\", or name a model below [model]".to_owned();
        return Err(fault(name.span(), key, StudyFault::MissingKey { key: "formula".into(), instead }));
    };
    model.outputs.iter().find(|output| output.name == text).ok_or_else(|| {
        let known: Vec<String> = model.outputs.iter().map(|output| output.name.to_owned()).collect();
        let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
        fault(name.span(), key, StudyFault::UnknownWord { what: "model output", found: text.clone(), nearest, known })
    })
}

fn characteristic(
    name: &str,
    unit: Option<String>,
    entry: &CharacteristicEntry,
    key: &str,
) -> Result<Characteristic, Fault> {
    let value = |limit: &Option<Spanned<f64>>| limit.as_ref().map(|limit| *limit.get_ref());
    let limits = SpecLimits::new(value(&entry.lower), value(&entry.upper)).map_err(|error| {
        let at = entry.upper.as_ref().or(entry.lower.as_ref()).expect("limits that exist are at fault");
        fault(at.span(), format!("{key}.upper"), error)
    })?;
    let mut characteristic = Characteristic::new(name).with_limits(limits).with_labels(entry.labels());
    if let Some(given) = &entry.given {
        characteristic = characteristic.with_given(given.get_ref());
    }
    if let Some(unit) = unit {
        characteristic = characteristic.with_unit(unit);
    }
    if let Some(target) = &entry.target_yield {
        let at = |error: LimitsError| fault(target.span(), format!("{key}.target_yield"), error);
        if !limits.exist() {
            let instead = "a target yield needs a limit: write lower, upper or both".to_owned();
            let missing = StudyFault::MissingKey { key: "lower".into(), instead };
            return Err(fault(target.span(), format!("{key}.target_yield"), missing));
        }
        characteristic = characteristic.with_target_yield(*target.get_ref()).map_err(at)?;
    }
    inspected(characteristic, entry, key)
}

fn compose(
    file: &StudyFile,
    model: Option<&ModelOf>,
    dimensions: &[Dimension],
    written: &Written<'_>,
    outputs: Outputs,
    source: &Source,
) -> Result<Composite, Faults> {
    let inputs: Vec<Input> = (dimensions.iter())
        .map(|dimension| Input { name: dimension.name().to_owned(), unit: dimension.unit().map(str::to_owned) })
        .collect();
    let constants: Vec<(String, f64)> =
        file.constants.0.iter().map(|(name, value)| (name.get_ref().clone(), value.get_ref().value)).collect();
    let nowhere = |found: StudyFault| Fault { span: None, key: String::new(), fault: Box::new(found) };
    let program = matches!(model, Some(ModelOf::Program(_)));
    if source.externals.points.is_some() && !program {
        return Err(nowhere(StudyFault::NothingExternal).into());
    }
    type Made = Result<Arc<dyn AssemblyFunction>, Fault>;
    let sent_to = |make: &dyn Fn(Signature, Greeting) -> Made| -> Result<_, Faults> {
        let sent = drive::of_program(file, dimensions, &constants, written, &outputs)?;
        let offered = asked_of_program(&inputs, &constants, written, &outputs);
        Ok((make(signature(&sent.inputs, offered), sent.greeting)?, sent.sources))
    };
    let model = match model {
        None => None,
        Some(ModelOf::BuiltIn(model)) => {
            let function: Arc<dyn AssemblyFunction> = Arc::new(model.function());
            Some((function, drive::of_built_in(model, dimensions, &constants, written)))
        }
        Some(ModelOf::Program(program)) => Some(sent_to(&|signature, greeting| {
            process(program, signature, greeting, (source, units::foreign(file))).map_err(nowhere)
        })?),
        Some(ModelOf::Host(host)) => Some(sent_to(&|signature, greeting| Ok(host.function(signature, greeting)))?),
    };
    let parts = Parts {
        inputs,
        constants,
        model,
        formulas: written.formulas.iter().map(|named| (named.name.clone(), named.formula.clone())).collect(),
        conditions: written.implicit.as_ref().map(|implicit| implicit.conditions.clone()),
        outputs,
    };
    let failed = |error: CompositeError| match error {
        CompositeError::Conditions(error) => placed(file, error),
        CompositeError::Driven { name, index, output } => {
            written.at(index, StudyFault::DrivenByOutput { name, output })
        }
        CompositeError::Formula { index, error, .. } => {
            let (text, key) = match index.checked_sub(written.formulas.len()) {
                None => (written.formulas[index].span.clone(), written.formulas[index].key.clone()),
                Some(index) => written.implicit.as_ref().expect("the formula came from here").places[index].clone(),
            };
            let formula = written.formulas.get(index).map_or("", |named| named.text);
            in_formula(source, text, key, of_several_words(file, formula, error))
        }
    };
    Composite::new(parts).map_err(|error| failed(error).into())
}

/// Replaces the fault of a formula by `FormulaFault::NeedsBackquotes` if the fault lies within a name that must stand in backquotes.
fn of_several_words(file: &StudyFile, formula: &str, error: FormulaError) -> FormulaError {
    let dimensions = dimension::names(&file.dimensions);
    let others = [file.constants.names(), file.formulas.names(), file.unknowns.names()].concat();
    let names = dimensions.iter().chain(others).map(Spanned::get_ref);
    let meant = names.filter(|name| !is_plain(name)).find_map(|name| {
        let mut places = formula.match_indices(name.as_str()).map(|(at, _)| at..at + name.len());
        places.find(|place| place.contains(&error.span.start)).map(|place| (name.clone(), place))
    });
    match meant {
        Some((name, span)) => {
            let mut named = error;
            (named.span, named.fault) = (span, FormulaFault::NeedsBackquotes { name });
            named
        }
        None => error,
    }
}

/// Outputs that a program must answer: characteristics without formula, and names in formulas that nothing else defines.
fn asked_of_program(
    inputs: &[Input],
    constants: &[(String, f64)],
    written: &Written<'_>,
    outputs: &Outputs,
) -> Outputs {
    let is_written = |name: &str| written.is_formula(name) || written.is_unknown(name);
    let mut asked: Outputs = outputs.iter().filter(|(name, _)| !is_written(name)).cloned().collect();
    for name in &written.names().collect::<Vec<_>>() {
        let known = is_written(name)
            || inputs.iter().any(|input| input.name == *name)
            || constants.iter().any(|(constant, _)| constant == name)
            || asked.iter().any(|(known, _)| known == name)
            || is_reserved(name);
        if !known {
            asked.push((name.clone(), None));
        }
    }
    asked
}

/// A dimension whose `same_as` names itself.
fn outside_limits(file: &StudyFile) -> Option<Warning> {
    let outside = file.dimensions.0.iter().filter_map(|(name, entry)| {
        let (Some(nominal), Some(limits)) = (&entry.get_ref().nominal, &entry.get_ref().limits) else { return None };
        let (NominalEntry::One(nominal), [lower, upper]) = (nominal.get_ref(), *limits.get_ref()) else { return None };
        (*nominal < lower || *nominal > upper).then(|| name.get_ref().clone())
    });
    let dimensions: Vec<String> = outside.collect();
    (!dimensions.is_empty()).then_some(Warning::NominalOutsideLimits { dimensions })
}

/// Refuses formulas that nothing needs in a study with a program. They were most likely meant to drive the program.
fn idle_formula(program: bool, composite: &Composite, written: &Written<'_>, made: &[String]) -> Result<(), Faults> {
    if !program {
        return Ok(());
    }
    let mut faults = Faults::default();
    for (index, _) in composite.used().0.iter().enumerate().filter(|(_, needed)| !**needed) {
        let name = written.formulas[index].name.clone();
        if made.contains(&name) {
            continue;
        }
        faults.0.push(written.at(index, StudyFault::IdleFormula { name }));
    }
    faults.none()
}

/// Warnings of constants, formulas and unknowns that no characteristic needs.
fn unused(
    file: &StudyFile,
    model: Option<&ModelOf>,
    composite: &Composite,
    written: &Written<'_>,
    used: &dyn Fn(&str) -> bool,
    made: &[String],
) -> Vec<Warning> {
    let (needed, solved) = composite.used();
    let idle_formulas = (written.formulas.iter().zip(needed))
        .filter(|(named, needed)| !needed && !made.contains(&named.name))
        .map(|(named, _)| named.name.clone());
    let idle_unknowns = (file.unknowns.names().into_iter()).filter(|_| !solved).map(|name| name.get_ref().clone());
    let is_input = |name: &str| match model {
        None => false,
        Some(ModelOf::BuiltIn(model)) => model.inputs.iter().any(|input| input.name == name),
        // A program refuses unknown inputs itself.
        Some(ModelOf::Program(_) | ModelOf::Host(_)) => true,
    };
    let idle_constants = (file.constants.names().into_iter())
        .filter(|name| !used(name.get_ref()) && !is_input(name.get_ref()))
        .map(|name| name.get_ref().clone());
    let idle = [
        (NameKind::Constant, idle_constants.collect::<Vec<_>>()),
        (NameKind::Formula, idle_formulas.collect()),
        (NameKind::Unknown, idle_unknowns.collect()),
    ];
    let some = idle.into_iter().filter(|(_, names)| !names.is_empty());
    some.map(|(kind, names)| Warning::UnusedName { kind, names }).collect()
}

impl<T> Entries<T> {
    pub(crate) fn names(&self) -> Vec<&Spanned<String>> {
        self.0.iter().map(|(name, _)| name).collect()
    }
}
