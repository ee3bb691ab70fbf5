//! Expands `[configurations]`: nominal values and constants of several sizes of one assembly.

use crate::data::{Cells, Data};
use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Tree, Value, wrong_type};
use sensitol_numeric::names::nearest;

/// A configuration: names of dimensions and constants, with their values.
struct Configuration {
    name: String,
    span: std::ops::Range<usize>,
    values: Vec<(String, Tree)>,
}

/// Checks every configuration, sets the nominal values and constants of the requested one, and removes the section.
pub(super) fn expand(expanded: &mut Expanded, asked: Option<&str>, data: &mut Data<'_>) -> Result<(), Faults> {
    let configurations = match expanded.tree.get("configurations") {
        Some(section) => read(section, data)?,
        None => Vec::new(),
    };
    let mut faults = Faults::default();
    for configuration in &configurations {
        for (name, value) in &configuration.values {
            faults.0.extend(checked(&expanded.tree, configuration, name, value));
        }
    }
    faults.none()?;
    expanded.configurations = configurations.iter().map(|one| one.name.clone()).collect();
    if let Some(asked) = asked {
        let Some(configuration) = configurations.into_iter().find(|one| one.name == asked) else {
            let known = expanded.configurations.clone();
            if known.is_empty() {
                return Err(
                    Fault { span: None, key: String::new(), fault: Box::new(StudyFault::NoConfigurations) }.into()
                );
            }
            let nearest = nearest(asked, known.iter().map(String::as_str)).map(str::to_owned);
            let unknown = StudyFault::UnknownWord { what: "configuration", found: asked.to_owned(), nearest, known };
            return Err(Fault { span: None, key: "configurations".to_owned(), fault: Box::new(unknown) }.into());
        };
        for (name, value) in configuration.values {
            set(&mut expanded.tree, &name, value);
        }
    }
    if let Some(sections) = expanded.tree.entries_mut() {
        sections.retain(|(key, _)| key.name != "configurations");
    }
    Ok(())
}

fn read(section: &Tree, data: &mut Data<'_>) -> Result<Vec<Configuration>, Faults> {
    let expected = "a table of configurations such as small = { L = 40, D = 8 }";
    let Value::Table(entries) = &section.value else {
        return Err(wrong_type(section, "configurations".into(), expected).into());
    };
    let mut configurations = Vec::new();
    let mut faults = Faults::default();
    for (key, entry) in entries {
        let at = format!("configurations.{}", key.name);
        match &entry.value {
            Value::Table(values) => configurations.push(Configuration {
                name: key.name.clone(),
                span: key.span.clone(),
                values: values.iter().map(|(name, value)| (name.name.clone(), value.clone())).collect(),
            }),
            Value::Text(file) if key.name == "file" => {
                faults.take(of_file(file, entry, data)).into_iter().for_each(|some| configurations.extend(some));
            }
            _ => faults.0.push(wrong_type(entry, at, "a table of values such as { L = 40, D = 8 }")),
        }
    }
    for (index, one) in configurations.iter().enumerate() {
        if configurations[..index].iter().any(|earlier| earlier.name == one.name) || one.name == "all" {
            let found = match one.name == "all" {
                true => StudyFault::ReservedConfiguration,
                false => StudyFault::DuplicateKey { key: one.name.clone() },
            };
            faults.0.push(fault(one.span.clone(), format!("configurations.{}", one.name), found));
        }
    }
    faults.none().map(|()| configurations)
}

/// Configurations of a file: one in each row, with its name in the first column.
fn of_file(file: &str, entry: &Tree, data: &mut Data<'_>) -> Result<Vec<Configuration>, Fault> {
    let at = |found| fault(entry.span.clone(), "configurations.file", StudyFault::Data(found));
    let Cells { names, rows } = data.cells(file).map_err(at)?;
    let configuration = |(name, cells): (String, Vec<Option<f64>>)| {
        let values = names.iter().zip(cells).filter_map(|(name, cell)| {
            let value = Tree { span: entry.span.clone(), value: Value::Number(cell?) };
            Some((name.clone(), value))
        });
        Configuration { name, span: entry.span.clone(), values: values.collect() }
    };
    Ok(rows.into_iter().map(configuration).collect())
}

fn checked(tree: &Tree, of: &Configuration, name: &str, value: &Tree) -> Option<Fault> {
    let at = |found| fault(value.span.clone(), format!("configurations.{}.{name}", of.name), found);
    let dimension = tree.get("dimensions").and_then(|dimensions| dimensions.get(name));
    let constant = tree.get("constants").and_then(|constants| constants.get(name));
    if dimension.is_none() && constant.is_none() {
        let names = ["dimensions", "constants"].into_iter().filter_map(|section| tree.get(section));
        let known: Vec<String> =
            names.flat_map(|section| section.entries().iter().map(|(key, _)| key.name.clone())).collect();
        let nearest = nearest(name, known.iter().map(String::as_str)).map(str::to_owned);
        let unknown =
            StudyFault::UnknownConfigured { configuration: of.name.clone(), name: name.to_owned(), nearest, known };
        return Some(at(unknown));
    }
    if dimension.is_some_and(|entry| entry.get("limits").is_some()) {
        return Some(at(StudyFault::ConfiguredLimits { configuration: of.name.clone(), name: name.to_owned() }));
    }
    let number = |tree: &Tree| matches!(tree.value, Value::Number(_) | Value::Integer(_));
    let place = dimension.is_some_and(|entry| entry.get("position").is_some());
    let fits = match &value.value {
        Value::Array(items) => place && items.len() == 2 && items.iter().all(number),
        _ => number(value) && !place,
    };
    let expected = if place { "a place such as [50.0, 30.0]" } else { "a number" };
    (!fits).then(|| wrong_type(value, format!("configurations.{}.{name}", of.name), expected))
}

/// Sets a nominal value or a constant.
fn set(tree: &mut Tree, name: &str, value: Tree) {
    if let Some(entry) = tree.get_mut("dimensions").and_then(|dimensions| dimensions.get_mut(name)) {
        if let Some(nominal) = entry.get_mut("nominal") {
            *nominal = value;
        } else if let Some(keys) = entry.entries_mut() {
            let key = crate::expand::Key { span: value.span.clone(), name: "nominal".to_owned() };
            keys.insert(0, (key, value));
        }
        return;
    }
    let constant = tree.get_mut("constants").and_then(|constants| constants.get_mut(name));
    match constant {
        Some(constant) if matches!(constant.value, Value::Table(_)) => {
            constant.get_mut("value").into_iter().for_each(|number| *number = value.clone());
        }
        Some(constant) => *constant = value,
        None => {}
    }
}
