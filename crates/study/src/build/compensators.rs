//! Reads `[[adjust]]`, extremes over motions and conditions.

use std::sync::Arc;

use crate::entries::adjust_entry::{AdjustEntry, MotionEntry};
use crate::entries::file::{CharacteristicEntry, StudyFile};
use crate::entries::spanned::Spanned;
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::faults::compensator_fault::CompensatorFault;
use crate::source::Source;
use sensitol::assembly::{Adjustment, AssemblyFunction, Composite, Motion, MotionEnd, MotionExtremes, StockResponse};
use sensitol::problem::Problem;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::names::nearest;

/// Greatest number of values of a stock. Each is a value of the characteristic at every point.
const MOST_VALUES: usize = 1000;
/// Rounding of the number of steps in a range, as a part of a step.
const STEP_ROUNDING: f64 = 1e-6;
/// Numbers of steps of a motion.
const STEPS: std::ops::RangeInclusive<u64> = 4..=10_000;

/// Motion and end of a characteristic that is an extreme. Returns None for any other.
pub(crate) fn extreme(entry: &CharacteristicEntry) -> Option<(&Spanned<MotionEntry>, MotionEnd)> {
    let minimum = entry.minimum.as_ref().map(|motion| (motion, MotionEnd::Minimum));
    minimum.or(entry.maximum.as_ref().map(|motion| (motion, MotionEnd::Maximum)))
}

/// Problem of a study, with its extremes over motions and its adjusted dimensions.
pub(crate) fn problem(
    file: &StudyFile,
    dimensions: Vec<Dimension>,
    composite: Composite,
    characteristics: Vec<Characteristic>,
    source: &Source,
) -> Result<Problem, Faults> {
    let special =
        !file.adjust.0.is_empty() || file.characteristics.0.iter().any(|(_, entry)| extreme(entry.get_ref()).is_some());
    let nowhere = |found: StudyFault| Fault { span: None, key: String::new(), fault: Box::new(found) };
    if special && source.externals.elsewhere() {
        return Err(nowhere(CompensatorFault::EvaluatedElsewhere.into()).into());
    }
    let function = with_extremes(file, &dimensions, Arc::new(composite))?;
    let problem = Problem::of_function(dimensions, function)
        .and_then(|problem| problem.asking(characteristics))
        .map_err(|error| nowhere(error.into()))?;
    given(file)?;
    let mut adjustments: Vec<Adjustment> = Vec::new();
    for (index, entry) in file.adjust.0.iter().enumerate() {
        let key = format!("adjust[{}]", index + 1);
        let adjustment = adjustment(&problem, entry.get_ref(), &key)?;
        if adjustments.iter().any(|known| known.input == adjustment.input) {
            let dimension = &entry.get_ref().dimension;
            let twice = CompensatorFault::AdjustedTwice { dimension: dimension.get_ref().clone() };
            return Err(fault(dimension.span(), format!("{key}.dimension"), twice).into());
        }
        adjustments.push(adjustment);
    }
    Ok(if adjustments.is_empty() { problem } else { problem.adjusted(adjustments) })
}

/// Place of a name in a list, or the fault of an unknown one.
fn place(known: &[&str], name: &Spanned<String>, what: &'static str, key: &str) -> Result<usize, Fault> {
    known.iter().position(|known| *known == name.get_ref()).ok_or_else(|| {
        let nearest = nearest(name.get_ref(), known.iter().copied()).map(str::to_owned);
        let known = known.iter().map(|&known| known.to_owned()).collect();
        let found = name.get_ref().clone();
        fault(name.span(), key, StudyFault::UnknownWord { what, found, nearest, known })
    })
}

/// True if an output of a function can depend on an input.
fn depends(function: &dyn AssemblyFunction, output: usize, input: usize) -> bool {
    function.signature().outputs[output].depends_on.as_ref().is_none_or(|all| all.contains(&input))
}

/// True if an output is a formula, or an extreme of one, and no program answers for it.
fn is_formula(function: &dyn AssemblyFunction, output: usize) -> bool {
    !function.signature().costly || function.switches(output).is_some_and(|switches| switches.complete)
}

/// Adds extremes over motions to the outputs of the composite.
fn with_extremes(
    file: &StudyFile,
    dimensions: &[Dimension],
    composite: Arc<Composite>,
) -> Result<Arc<dyn AssemblyFunction>, Faults> {
    let mut motions = Vec::new();
    let outputs: Vec<&str> = composite.signature().outputs.iter().map(|output| output.name.as_str()).collect();
    let inputs: Vec<&str> = dimensions.iter().map(Dimension::name).collect();
    for (name, entry) in &file.characteristics.0 {
        let entry = entry.get_ref();
        let Some((motion, end)) = extreme(entry) else { continue };
        let word = if end == MotionEnd::Minimum { "minimum" } else { "maximum" };
        let key = format!("characteristics.{}.{word}", name.get_ref());
        let at = motion.span();
        let conflict = |b: &'static str| {
            let why = "both say what it is: leave one out".to_owned();
            fault(at.clone(), key.clone(), StudyFault::Conflict { a: word, b, why })
        };
        if entry.formula.is_some() {
            return Err(conflict("formula").into());
        }
        if entry.minimum.is_some() && entry.maximum.is_some() {
            return Err(conflict(if word == "minimum" { "maximum" } else { "minimum" }).into());
        }
        let motion = motion.get_ref();
        let of_extreme = |(known, entry): &(Spanned<String>, Spanned<CharacteristicEntry>)| {
            known.get_ref() == motion.of.get_ref() && extreme(entry.get_ref()).is_some()
        };
        if file.characteristics.0.iter().any(of_extreme) {
            let characteristic = motion.of.get_ref().clone();
            let found = CompensatorFault::ExtremeOfExtreme { characteristic };
            return Err(fault(motion.of.span(), format!("{key}.of"), found).into());
        }
        let of = place(&outputs, &motion.of, "characteristic", &format!("{key}.of"))?;
        let over = place(&inputs, &motion.over, "dimension", &format!("{key}.over"))?;
        let adjusted = file.adjust.0.iter().any(|one| one.get_ref().dimension.get_ref() == motion.over.get_ref());
        let why = match adjusted {
            true => Some("is adjusted"),
            false => (dimensions[over].sigma() > 0.0).then_some("has a tolerance"),
        };
        let dimension = motion.over.get_ref().clone();
        if let Some(why) = why {
            let varies = CompensatorFault::MotionVaries { dimension, why };
            return Err(fault(motion.over.span(), format!("{key}.over"), varies).into());
        }
        if !depends(&*composite, of, over) {
            let found = CompensatorFault::NoEffect { dimension, characteristic: motion.of.get_ref().clone() };
            return Err(fault(motion.over.span(), format!("{key}.over"), found).into());
        }
        let range = range(&motion.from, &motion.to, &key)?;
        let steps = steps(motion, &key)?;
        motions.push(Motion { name: name.get_ref().clone(), of, over, range, end, steps });
    }
    Ok(if motions.is_empty() { composite } else { Arc::new(MotionExtremes::new(composite, motions)) })
}

fn range(from: &Spanned<f64>, to: &Spanned<f64>, key: &str) -> Result<[f64; 2], Fault> {
    let [lower, upper] = [*from.get_ref(), *to.get_ref()];
    if let Some(bad) = [from, to].into_iter().find(|end| !end.get_ref().is_finite()) {
        return Err(fault(bad.span(), key, StudyFault::NotFinite { text: bad.get_ref().to_string() }));
    }
    match lower < upper {
        true => Ok([lower, upper]),
        false => Err(fault(to.span(), format!("{key}.to"), CompensatorFault::EmptyMotion { lower, upper })),
    }
}

fn steps(motion: &MotionEntry, key: &str) -> Result<usize, Fault> {
    let Some(steps) = &motion.steps else { return Ok(Motion::STEPS) };
    match STEPS.contains(steps.get_ref()) {
        true => Ok(*steps.get_ref() as usize),
        false => {
            let found = StudyFault::OutOfRange { value: *steps.get_ref() as f64, range: "from 4 to 10000 steps" };
            Err(fault(steps.span(), format!("{key}.steps"), found))
        }
    }
}

/// Adjustment of an entry.
fn adjustment(problem: &Problem, entry: &AdjustEntry, key: &str) -> Result<Adjustment, Fault> {
    let inputs: Vec<&str> = problem.dimensions().iter().map(Dimension::name).collect();
    let input = place(&inputs, &entry.dimension, "dimension", &format!("{key}.dimension"))?;
    let names: Vec<&str> = problem.characteristics().iter().map(Characteristic::name).collect();
    let c = place(&names, &entry.to, "characteristic", &format!("{key}.to"))?;
    let (characteristic, to) = (&problem.characteristics()[c], problem.outputs()[c]);
    let dimension = entry.dimension.get_ref().clone();
    if !depends(problem.function(), to, input) {
        let found = CompensatorFault::NoEffect { dimension, characteristic: characteristic.name().to_owned() };
        return Err(fault(entry.dimension.span(), format!("{key}.dimension"), found));
    }
    let limits = characteristic.limits();
    let target = match (&entry.target, limits.lower(), limits.upper()) {
        (Some(target), lower, upper) => {
            let value = *target.get_ref();
            if !value.is_finite() {
                let found = StudyFault::NotFinite { text: value.to_string() };
                return Err(fault(target.span(), format!("{key}.target"), found));
            }
            if lower.is_some_and(|lower| value < lower) || upper.is_some_and(|upper| value > upper) {
                let characteristic = characteristic.name().to_owned();
                let found = CompensatorFault::TargetOutside { target: value, characteristic };
                return Err(fault(target.span(), format!("{key}.target"), found));
            }
            value
        }
        (None, Some(lower), Some(upper)) => 0.5 * (lower + upper),
        (None, ..) => {
            let instead = format!("write target = 0.1, or both limits of `{}`: their middle is the target", names[c]);
            let missing = StudyFault::MissingKey { key: "target".into(), instead };
            return Err(fault(entry.to.span(), format!("{key}.target"), missing));
        }
    };
    let response = match &entry.response {
        None => StockResponse::Any,
        Some(word) => {
            let (forms, key) = (StockResponse::ALL.map(StockResponse::name), format!("{key}.response"));
            let form = StockResponse::ALL[place(&forms, word, "form of a response", &key)?];
            if form != StockResponse::Any && is_formula(problem.function(), to) {
                let characteristic = characteristic.name().to_owned();
                return Err(fault(word.span(), key, CompensatorFault::ResponseOfFormula { characteristic }));
            }
            form
        }
    };
    let stock = stock(entry, key)?;
    let nominal = problem.dimensions()[input].nominal();
    Ok(Adjustment { input, nominal, stock, to, target, response })
}

/// Values in stock, ascending.
fn stock(entry: &AdjustEntry, key: &str) -> Result<Vec<f64>, Fault> {
    let at = entry.dimension.span();
    let dimension = entry.dimension.get_ref().clone();
    if let Some(values) = &entry.values {
        let key = format!("{key}.values");
        if let Some(other) = entry.step.as_ref().map(|_| "step").or(entry.range.as_ref().map(|_| "range")) {
            let why = "both say what is in stock: leave one out".to_owned();
            return Err(fault(values.span(), key, StudyFault::Conflict { a: "values", b: other, why }));
        }
        let mut stock = values.get_ref().clone();
        if stock.len() > MOST_VALUES {
            let long = CompensatorFault::LongStock { dimension, count: stock.len(), most: MOST_VALUES };
            return Err(fault(values.span(), key, long));
        }
        if let Some(value) = stock.iter().find(|value| !value.is_finite()) {
            return Err(fault(values.span(), key, StudyFault::NotFinite { text: value.to_string() }));
        }
        stock.sort_by(f64::total_cmp);
        if let Some(pair) = stock.windows(2).find(|pair| pair[0] == pair[1]) {
            return Err(fault(values.span(), key, CompensatorFault::RepeatedValue { value: pair[0] }));
        }
        return match stock.is_empty() {
            true => Err(fault(values.span(), key, CompensatorFault::EmptyStock { dimension })),
            false => Ok(stock),
        };
    }
    let Some(step) = &entry.step else {
        if let Some(range) = &entry.range {
            let instead = "write the distance of two values in stock, such as step = 0.1".to_owned();
            let missing = StudyFault::MissingKey { key: "step".into(), instead };
            return Err(fault(range.span(), format!("{key}.step"), missing));
        }
        return Err(fault(at, format!("{key}.values"), CompensatorFault::EmptyStock { dimension }));
    };
    let Some(range) = &entry.range else {
        let instead = "write the least and the greatest value in stock, such as range = [0.5, 1.5]".to_owned();
        let missing = StudyFault::MissingKey { key: "range".into(), instead };
        return Err(fault(step.span(), format!("{key}.range"), missing));
    };
    let (value, [lower, upper]) = (*step.get_ref(), *range.get_ref());
    if !(value > 0.0 && value.is_finite()) {
        return Err(fault(step.span(), format!("{key}.step"), StudyFault::OutOfRange { value, range: "above 0" }));
    }
    if lower >= upper || !(upper - lower).is_finite() {
        return Err(fault(range.span(), format!("{key}.range"), StudyFault::Swapped { lower, upper }));
    }
    let count = ((upper - lower) / value + STEP_ROUNDING).floor() + 1.0;
    if count > MOST_VALUES as f64 {
        let found = CompensatorFault::TooManyValues { step: value, count, most: MOST_VALUES };
        return Err(fault(step.span(), format!("{key}.step"), found));
    }
    Ok((0..count as usize).map(|index| lower + value * index as f64).collect())
}

/// Checks the conditions of all characteristics.
fn given(file: &StudyFile) -> Result<(), Fault> {
    let entries = &file.characteristics.0;
    let names: Vec<&str> = entries.iter().map(|(name, _)| name.get_ref().as_str()).collect();
    let limited = |c: usize| entries[c].1.get_ref().lower.is_some() || entries[c].1.get_ref().upper.is_some();
    for (c, (name, entry)) in entries.iter().enumerate() {
        let Some(given) = &entry.get_ref().given else { continue };
        let key = format!("characteristics.{}.given", name.get_ref());
        let characteristic = name.get_ref().clone();
        let condition = place(&names, given, "characteristic", &key)?;
        let found = if condition == c {
            Some(CompensatorFault::GivenItself { characteristic })
        } else if let Some(names) = circle(file, &names, c) {
            Some(CompensatorFault::GivenCircle { names })
        } else if !limited(condition) {
            let role = "they decide which assemblies count";
            Some(CompensatorFault::NoLimits { characteristic: given.get_ref().clone(), role })
        } else {
            let role = "there is no yield to state for the assemblies that count";
            (!limited(c)).then_some(CompensatorFault::NoLimits { characteristic, role })
        };
        if let Some(found) = found {
            return Err(fault(given.span(), key, found));
        }
    }
    Ok(())
}

/// Names of the characteristics whose conditions lead back to the first of them. Returns None if they end.
fn circle(file: &StudyFile, names: &[&str], start: usize) -> Option<Vec<String>> {
    let next = |c: usize| {
        let given = file.characteristics.0[c].1.get_ref().given.as_ref()?;
        names.iter().position(|name| *name == given.get_ref())
    };
    let (mut at, mut met) = (start, Vec::new());
    for _ in 0..names.len() {
        met.push(names[at].to_owned());
        at = next(at)?;
        if at == start {
            return Some(met);
        }
    }
    None
}
