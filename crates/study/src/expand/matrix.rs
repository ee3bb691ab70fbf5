//! Expands `[model] matrix`: a table of influence coefficients becomes one linear formula for each of its rows.
//!
//! The first column names the outputs, and `unit` their units. Either `y0` is the value at zero inputs, `y = y0 + sum a_i x_i`, or
//! `nominal` the value at the nominal dimensions, `y = nominal + sum a_i (x_i - nominal_i)`. Every other column is one input.

use std::ops::Range;

use crate::data::{Data, DataFault, DataProblem, NumberedCells};
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Origin, Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol_numeric::names::nearest;

/// Key of the study that names the file.
const KEY: &str = "model.matrix";
/// Column with the value of an output at zero inputs.
const AT_ZERO: &str = "y0";
/// Column with the value of an output at the nominal dimensions.
const AT_NOMINAL: &str = "nominal";
/// Column with the unit of an output.
const UNIT: &str = "unit";

/// A table of influence coefficients.
struct Matrix {
    /// Name of the first column and its cells: outputs with their lines.
    outputs: NumberedCells,
    /// Units of the outputs; empty if none is given.
    units: Vec<String>,
    /// Values at zero inputs, or at the nominal dimensions if `centred`.
    constants: Vec<f64>,
    centred: bool,
    inputs: Vec<MatrixColumn>,
}

/// Coefficients of one input.
struct MatrixColumn {
    name: String,
    /// Unit of the input in the header, or else that of the study.
    unit: Option<String>,
    /// Unit of the input in the study, which is that of its nominal value.
    own_unit: Option<String>,
    /// Nominal value of the input. None if the study gives no number.
    nominal: Option<f64>,
    coefficients: Vec<f64>,
}

/// Replaces `[model] matrix` by formulas.
pub(super) fn expand(expanded: &mut Expanded, data: &mut Data<'_>) -> Result<(), Faults> {
    let Some(model) = expanded.tree.get("model") else { return Ok(()) };
    let Some(entry) = model.get("matrix") else { return Ok(()) };
    let Value::Text(file) = &entry.value else {
        return Err(wrong_type(entry, KEY.into(), "the name of a CSV file such as \"influence.csv\"").into());
    };
    alone(model)?;
    let (file, span) = (file.clone(), entry.span.clone());
    let matrix = read(&expanded.tree, &file, &span, data)?;
    covers(&expanded.tree, &matrix)?;
    for row in 0..matrix.outputs.len() {
        add(expanded, &matrix, row, &span).map_err(|found| fault(span.clone(), KEY, found))?;
    }
    if let Some(sections) = expanded.tree.entries_mut() {
        sections.retain(|(key, _)| key.name != "model");
    }
    Ok(())
}

/// Refuses other keys beside `matrix`.
fn alone(model: &Tree) -> Result<(), Faults> {
    let mut faults = Faults::default();
    for (key, value) in model.entries().iter().filter(|(key, _)| key.name != "matrix") {
        let conflict = |b| StudyFault::Conflict { a: "matrix", b, why: "are two models: leave one out".to_owned() };
        let foreign = |key| StudyFault::DoesNotApply { key, to: "a matrix".to_owned(), instead: "it is for a command" };
        let found = match key.name.as_str() {
            "builtin" => conflict("builtin"),
            "command" => conflict("command"),
            "inputs" => foreign("inputs"),
            "workers" => foreign("workers"),
            "timeout_s" => foreign("timeout_s"),
            "start_timeout_s" => foreign("start_timeout_s"),
            "retries" => foreign("retries"),
            "verify" => foreign("verify"),
            "files" => foreign("files"),
            // The deserializer would report an unknown key, but the section is removed before it.
            _ => StudyFault::UnknownKey { key: key.name.clone(), nearest: None, valid: vec!["matrix".to_owned()] },
        };
        faults.0.push(fault(value.span.clone(), format!("model.{}", key.name), found));
    }
    faults.none()
}

fn read(tree: &Tree, file: &str, span: &Range<usize>, data: &mut Data<'_>) -> Result<Matrix, Fault> {
    let at = |found| fault(span.clone(), KEY, StudyFault::Data(found));
    let (names, _) = data.texts(file, "").map_err(at)?;
    let problem = |line, column: &str, problem| DataFault {
        file: file.to_owned(),
        line,
        column: Some(column.to_owned()),
        problem: Box::new(problem),
    };
    // Two columns of one input would be added, whatever their units are.
    let same = |a: &String, b: &String| split(a).0 == split(b).0;
    if let Some(place) = (1..names.len()).find(|&place| names[..place].iter().any(|name| same(name, &names[place]))) {
        let twice = DataProblem::ColumnTwice { name: split(&names[place]).0.to_owned() };
        return Err(at(DataFault { column: None, ..problem(None, "", twice) }));
    }
    let texts = |data: &mut Data<'_>, name: &str| {
        data.texts(file, name).map(|(_, texts)| texts.unwrap_or_default()).map_err(at)
    };
    let outputs = texts(data, &names[0])?;
    let units = texts(data, UNIT)?.into_iter().map(|(_, unit)| unit).collect::<Vec<_>>();
    for (place, (line, name)) in outputs.iter().enumerate() {
        if name.is_empty() || outputs[..place].iter().any(|(_, earlier)| earlier == name) {
            let text = name.clone();
            let other = outputs[..place].iter().find(|(_, earlier)| earlier == name).map(|(line, _)| *line);
            return Err(at(problem(Some(*line), &names[0], DataProblem::OutputName { text, other })));
        }
    }
    if outputs.is_empty() {
        return Err(at(DataFault { column: None, ..problem(None, "", DataProblem::Empty) }));
    }
    let mut numbers = |name: &str| {
        let column = data.column(file, Some(name)).map_err(at)?;
        match column.missing.first() {
            Some(line) => Err(at(problem(Some(*line), name, DataProblem::EmptyCoefficient))),
            None => Ok(column.values),
        }
    };
    let has = |name: &str| names[1..].iter().any(|known| known == name);
    let centred = has(AT_NOMINAL);
    let missing = |instead: &str| {
        let key = format!("{AT_ZERO}` or `{AT_NOMINAL}");
        fault(span.clone(), KEY, StudyFault::MissingKey { key, instead: instead.to_owned() })
    };
    let constants = match (has(AT_ZERO), centred) {
        (true, false) => numbers(AT_ZERO)?,
        (false, true) => numbers(AT_NOMINAL)?,
        (true, true) => {
            let why = "are two columns for one constant: leave one out".to_owned();
            return Err(fault(span.clone(), KEY, StudyFault::Conflict { a: AT_ZERO, b: AT_NOMINAL, why }));
        }
        (false, false) => {
            return Err(missing(
                "add a column: y0 is the value of each output at zero inputs, nominal that at the nominal dimensions",
            ));
        }
    };
    let mut inputs = Vec::new();
    for header in names[1..].iter().filter(|name| ![AT_ZERO, AT_NOMINAL, UNIT].contains(&name.as_str())) {
        let coefficients = numbers(header)?;
        let (name, unit) = split(header);
        let source = input(tree, name).ok_or_else(|| fault(span.clone(), KEY, unknown(tree, name)))?;
        let own_unit = source.get("unit").and_then(text_of);
        let unit = unit.map(str::to_owned).or_else(|| own_unit.clone());
        inputs.push(MatrixColumn { name: name.to_owned(), unit, own_unit, nominal: nominal(source), coefficients });
    }
    Ok(Matrix { outputs, units, constants, centred, inputs })
}

/// Name and unit of a header such as `shim [mm]`.
fn split(header: &str) -> (&str, Option<&str>) {
    match header.strip_suffix(']').and_then(|rest| rest.rsplit_once('[')) {
        Some((name, unit)) => (name.trim(), Some(unit.trim())),
        None => (header, None),
    }
}

/// Dimension, constant or formula of this name.
fn input<'t>(tree: &'t Tree, name: &str) -> Option<&'t Tree> {
    ["dimensions", "constants", "formulas"].iter().find_map(|section| tree.get(section)?.get(name))
}

fn unknown(tree: &Tree, name: &str) -> StudyFault {
    let sections = ["dimensions", "constants", "formulas"].into_iter().filter_map(|section| tree.get(section));
    let known: Vec<String> =
        sections.flat_map(|section| section.entries().iter().map(|(key, _)| key.name.clone())).collect();
    let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
    StudyFault::UnknownWord { what: "dimension, constant or formula", found: name.to_owned(), nearest, known }
}

/// Nominal value of a dimension, or the value of a constant. Returns None if the study gives no number.
fn nominal(entry: &Tree) -> Option<f64> {
    let number = |tree: &Tree| match tree.value {
        Value::Number(number) => Some(number),
        Value::Integer(number) => Some(number as f64),
        _ => None,
    };
    match (entry.get("nominal").or_else(|| entry.get("value")), entry.get("limits").map(|limits| &limits.value)) {
        (Some(nominal), _) => number(nominal),
        (None, Some(Value::Array(limits))) if limits.len() == 2 => {
            Some(f64::midpoint(number(&limits[0])?, number(&limits[1])?))
        }
        _ => number(entry),
    }
}

fn text_of(tree: &Tree) -> Option<String> {
    match &tree.value {
        Value::Text(text) => Some(text.clone()),
        _ => None,
    }
}

/// Checks that every characteristic without a formula is a row of the matrix.
fn covers(tree: &Tree, matrix: &Matrix) -> Result<(), Faults> {
    let mut faults = Faults::default();
    let characteristics = tree.get("characteristics").map_or(&[][..], Tree::entries);
    let solved = |name: &str| tree.get("unknowns").is_some_and(|unknowns| unknowns.get(name).is_some());
    for (key, entry) in characteristics {
        let found = matrix.outputs.iter().any(|(_, output)| *output == key.name);
        if found || entry.get("formula").is_some() || solved(&key.name) {
            continue;
        }
        let known: Vec<String> = matrix.outputs.iter().map(|(_, name)| name.clone()).collect();
        let nearest = nearest(&key.name, known.iter().map(String::as_str)).map(str::to_owned);
        let what = "row of the matrix";
        let unknown = StudyFault::UnknownWord { what, found: key.name.clone(), nearest, known };
        faults.0.push(fault(key.span.clone(), format!("characteristics.{}", key.name), unknown));
    }
    faults.none()
}

/// Adds one row: the formula of a characteristic, or one of `[formulas]`.
fn add(expanded: &mut Expanded, matrix: &Matrix, row: usize, span: &Range<usize>) -> Result<(), StudyFault> {
    let name = &matrix.outputs[row].1;
    let own = matrix.units.get(row).filter(|unit| !unit.is_empty()).cloned();
    let taken = |by| Err(StudyFault::NameTaken { name: name.clone(), by });
    for (section, by) in [("dimensions", "a dimension"), ("constants", "a constant"), ("formulas", "a formula")] {
        if expanded.tree.get(section).is_some_and(|section| section.get(name).is_some()) {
            return taken(by);
        }
    }
    let at = |value: Value| Tree { span: span.clone(), value };
    let key = |name: &str| Key { span: span.clone(), name: name.to_owned() };
    let characteristic = expanded.tree.get("characteristics").and_then(|all| all.get(name));
    let asked = characteristic.and_then(|entry| entry.get("unit")).and_then(text_of);
    let unit = own.clone().or(asked.clone());
    let text = formula(matrix, row, unit.as_deref())?;
    let section = if characteristic.is_some() { "characteristics" } else { "formulas" };
    let origin = Origin { section, name: name.clone(), key: KEY.to_owned(), span: span.clone() };
    if let Some(entry) = expanded.tree.get_mut("characteristics").and_then(|all| all.get_mut(name)) {
        if entry.get("formula").is_some() {
            return taken("a characteristic with a formula");
        }
        let keys = entry.entries_mut().into_iter();
        keys.for_each(|keys| {
            keys.insert(0, (key("formula"), at(Value::Text(text.clone()))));
            let unit = own.clone().filter(|_| asked.is_none());
            keys.extend(unit.map(|unit| (key("unit"), at(Value::Text(unit)))));
        });
    } else {
        let entries = [("formula", Some(text)), ("unit", own)].into_iter();
        let entries = entries.filter_map(|(name, text)| Some((key(name), at(Value::Text(text?)))));
        let entry = at(Value::Table(entries.collect()));
        expanded.tree.section("formulas").into_iter().for_each(|formulas| formulas.push((key(name), entry.clone())));
        expanded.elements.made.push(name.clone());
    }
    expanded.origins.push(origin);
    Ok(())
}

/// Formula of a row. Coefficients carry the unit of the output over that of the input if both are given.
fn formula(matrix: &Matrix, row: usize, unit: Option<&str>) -> Result<String, StudyFault> {
    let with = |value: f64, unit: Option<String>| match unit {
        Some(unit) => format!("{:?}[{unit}]", value.abs()),
        None => format!("{:?}", value.abs()),
    };
    let constant = matrix.constants[row];
    let sign = if constant < 0.0 { "-" } else { "" };
    let mut text = format!("{sign}{}", with(constant, unit.map(str::to_owned)));
    for column in &matrix.inputs {
        let coefficient = column.coefficients[row];
        if coefficient == 0.0 {
            continue;
        }
        let ratio = match (unit, &column.unit) {
            (Some(unit), Some(of)) if unit == of => None,
            (Some(unit), Some(of)) => Some(format!("({unit})/({of})")),
            _ => None,
        };
        let name = quoted(&column.name);
        let factor = with(coefficient, ratio);
        let operator = if coefficient < 0.0 { '-' } else { '+' };
        text += &match (matrix.centred, column.nominal) {
            (false, _) => format!(" {operator} {factor}*{name}"),
            (true, Some(nominal)) => {
                let sign = if nominal < 0.0 { '+' } else { '-' };
                format!(" {operator} {factor}*({name} {sign} {})", with(nominal, column.own_unit.clone()))
            }
            (true, None) => {
                let instead =
                    format!("`{}` has no nominal value as a number: write one, or y0 in the matrix", column.name);
                return Err(StudyFault::MissingKey { key: "nominal".to_owned(), instead });
            }
        };
    }
    Ok(text)
}
