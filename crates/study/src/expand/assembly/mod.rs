//! Expands an assembly in space: `[parts]`, `[joints]` and measures become unknowns, equations and formulas.
//!
//! | entry | plain lines |
//! |---|---|
//! | part that moves | six unknowns: a half-angle vector and the place of its origin |
//! | joint | an equation for every freedom that it takes |
//! | measure of a characteristic | its formula |
//!
//! The joints are closed at the nominal sizes first. So a fault of the assembly has a message in terms of parts and joints.

pub(super) mod face_points;
mod joints;
mod measures;
mod parts;
mod press;
mod values;
mod written;
pub(super) mod zones;

use std::collections::BTreeMap;
use std::ops::Range;

use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Expanded, Origin, Tree, Value, wrong_type};
use crate::scene::{ExtentQuantity, SpatialFacts, in_unit};
use crate::tree::Key;
use sensitol::assembly::formula::Formula;
use sensitol::assembly::implicit::EquationSubject;
use sensitol_numeric::names::nearest;
use sensitol_spatial::{
    Assembly, ClosedAssembly, FeatureId, JointKind, NamedFormula, PartJoint, PartPose, Quantity, SpatialError, Subject,
};
use values::{Measures, Nominal, Values};

pub(crate) use values::NominalValues;
pub(crate) use written::WrittenAssembly;
use written::WrittenExtent;

/// An entry of the study: its full key and its place.
#[derive(Debug, Clone)]
struct Entry {
    key: String,
    span: Range<usize>,
}

/// Replaces the assembly by plain lines. `nominal` evaluates formulas at the nominal dimensions.
pub(super) fn expand(
    expanded: &mut Expanded,
    written: WrittenAssembly,
    nominal: NominalValues<'_>,
) -> Result<(), Faults> {
    let study = expanded.tree.clone();
    let measures = measures::entries(&study);
    if study.get("parts").is_none() && study.get("joints").is_none() && measures.is_empty() {
        return Ok(());
    }
    let parts = table(&study, "parts")?;
    let joints = table(&study, "joints")?;
    // First the texts of all numbers, then their values in one evaluation, then the geometry.
    let mut values = Values::new(&study);
    let mut read = read(parts, joints, &measures, &mut values)?;
    let mut extents = extents(&read.assembly, &written, &mut values)?;
    let found = values.evaluated(nominal)?;
    read.set(&found);
    let closed = read.assembly.close().map_err(|error| read.fault(&error))?;
    let factor = values.length_factor();
    for extent in extents.iter_mut().flat_map(ExtentQuantity::all) {
        found.set(extent);
        extent.value /= factor;
    }
    let placed = |pose: &PartPose| PartPose { translation: pose.translation.map(|at| at / factor), ..pose.clone() };
    let mut facts = SpatialFacts {
        assembly: in_unit(read.assembly.clone(), factor),
        extents,
        freedoms: freedoms(&read.assembly, &closed),
        mobility: closed.mobility.clone(),
        poses: closed.poses.iter().map(placed).collect(),
        length_unit: values.length_unit(),
        converts: values.literal_unit().is_some(),
        written: written.uses,
        open_zones: std::mem::take(&mut expanded.open_zones),
        general: std::mem::take(&mut expanded.general),
        makers: Vec::new(),
        formulas: BTreeMap::new(),
    };
    facts.formulas = formula_names(&study);
    write(expanded, &read, closed, &values);
    facts.makers = (expanded.origins.iter().filter(|origin| origin.section == "dimensions"))
        .map(|origin| (origin.name.clone(), origin.key.clone()))
        .filter(|(_, key)| key.starts_with("parts.") || key.starts_with("joints."))
        .collect();
    expanded.spatial = Some(facts);
    Ok(())
}

/// Extents of the features of all parts, as written.
fn extents(
    assembly: &Assembly,
    written: &WrittenAssembly,
    values: &mut Values<'_>,
) -> Result<Vec<ExtentQuantity<Quantity>>, Fault> {
    let mut extents = Vec::new();
    for part in &assembly.parts {
        for feature in &part.features {
            let name = format!("{}.{}", part.name, feature.name);
            let place = written.uses.features.iter().position(|entry| entry.name == name);
            let mut length =
                |tree: &Tree, key: &str| values.quantity(tree, &format!("parts.{name}.{key}"), Measures::Length);
            extents.push(match place.and_then(|place| written.extents.get(place)) {
                None | Some(WrittenExtent::Unknown) => ExtentQuantity::Unknown,
                Some(WrittenExtent::Length(tree)) => ExtentQuantity::Length(length(tree, "length")?),
                Some(WrittenExtent::Rectangle([x, y])) => {
                    ExtentQuantity::Rectangle([length(x, "size")?, length(y, "size")?])
                }
                Some(WrittenExtent::Round(tree)) => ExtentQuantity::Round(length(tree, "diameter")?),
            });
        }
    }
    Ok(extents)
}

/// Freedoms that each joint takes, in words.
fn freedoms(assembly: &Assembly, closed: &ClosedAssembly) -> Vec<Vec<String>> {
    let mut freedoms = vec![Vec::new(); assembly.joints.len()];
    for (equation, joint) in &closed.equations {
        let Some(index) = *joint else { continue };
        let prefix = format!("{}: ", assembly.joints[index].name);
        freedoms[index].push(equation.name.strip_prefix(&prefix).unwrap_or(&equation.name).to_owned());
    }
    freedoms
}

/// Formulas and characteristics by name, with the names that they use.
fn formula_names(study: &Tree) -> BTreeMap<String, Vec<String>> {
    let mut found = BTreeMap::new();
    for (key, entry) in
        ["formulas", "characteristics"].iter().flat_map(|of| study.get(of).map_or(&[][..], Tree::entries))
    {
        // A formula that cannot be read is reported where it is read.
        let Value::Text(text) = &entry.get("formula").unwrap_or(entry).value else { continue };
        found.insert(
            key.name.clone(),
            Formula::parse(text).map_or_else(|_| Vec::new(), |formula| written::names(&formula)),
        );
    }
    found
}

/// Entries of a section that an assembly needs.
fn table<'t>(study: &'t Tree, section: &'static str) -> Result<&'t [(Key, Tree)], Fault> {
    match study.get(section) {
        Some(tree) if matches!(tree.value, Value::Table(_)) => Ok(tree.entries()),
        Some(tree) => Err(wrong_type(tree, section.into(), "a table of entries")),
        None => {
            let instead = match section {
                "parts" => "a measure or a joint is of features: write them in [parts.NAME]".to_owned(),
                _ => "write how the parts are located in [joints]".to_owned(),
            };
            Err(Fault {
                span: None,
                key: section.into(),
                fault: Box::new(StudyFault::MissingKey { key: format!("[{section}]"), instead }),
            })
        }
    }
}

/// An assembly as read, with the places of its entries.
struct Read {
    assembly: Assembly,
    parts: Vec<Entry>,
    joints: Vec<Entry>,
    measures: Vec<Entry>,
}

fn read(
    parts: &[(Key, Tree)],
    joints: &[(Key, Tree)],
    measures: &[measures::MeasureEntry<'_>],
    values: &mut Values<'_>,
) -> Result<Read, Faults> {
    let mut faults = Faults::default();
    let entry = |section: &str, key: &Key| Entry { key: format!("{section}.{}", key.name), span: key.span.clone() };
    let mut read = Read {
        assembly: Assembly {
            parts: Vec::new(),
            joints: Vec::new(),
            measures: Vec::new(),
            length_unit: values.literal_unit(),
            shown_unit: values.shown_unit(),
        },
        parts: parts.iter().map(|(key, _)| entry("parts", key)).collect(),
        joints: joints.iter().map(|(key, _)| entry("joints", key)).collect(),
        measures: measures.iter().map(|one| entry("characteristics", one.key)).collect(),
    };
    for (key, tree) in parts {
        match parts::part(key, tree, values) {
            Ok(part) => read.assembly.parts.push(part),
            Err(found) => faults.0.extend(found.0),
        }
    }
    faults.none()?;
    let mut faults = Faults::default();
    if !read.assembly.parts.iter().any(|part| part.ground)
        && let Some(first) = read.assembly.parts.first_mut()
    {
        first.ground = true;
    }
    for (key, tree) in joints {
        match joints::joint(key, tree, &read.assembly, values) {
            Ok(joint) => read.assembly.joints.push(joint),
            Err(found) => faults.0.push(found),
        }
    }
    for measure in measures {
        match measures::measure(measure, &read.assembly, values) {
            Ok(found) => read.assembly.measures.push(found),
            Err(found) => faults.0.push(found),
        }
    }
    faults.none()?;
    Ok(read)
}

impl Read {
    /// Sets the values of all formulas, which are numbered in place of values until then.
    fn set(&mut self, found: &Nominal) {
        let assembly = &mut self.assembly;
        for part in &mut assembly.parts {
            part.features.iter_mut().for_each(|feature| parts::quantities(feature).for_each(|one| found.set(one)));
        }
        for joint in &mut assembly.joints {
            joint.value.iter_mut().for_each(|one| found.set(one));
            joint.offset.iter_mut().chain(&mut joint.tilt).flatten().for_each(|one| found.set(one));
        }
        for measure in &mut assembly.measures {
            if let sensitol_spatial::MeasureKind::Profile(points) = &mut measure.kind {
                points.iter_mut().flatten().for_each(|one| found.set(one));
            }
        }
    }

    /// Fault of the assembly at the entry that it is about.
    fn fault(&self, error: &SpatialError) -> Fault {
        let entry = match error.subject() {
            Some(Subject::Part(index)) => self.parts.get(index),
            Some(Subject::Joint(index)) => self.joints.get(index),
            Some(Subject::Measure(index)) => self.measures.get(index),
            None => self.parts.first(),
        };
        let found = StudyFault::Spatial(error.clone());
        match entry {
            Some(entry) => fault(entry.span.clone(), entry.key.clone(), found),
            None => Fault { span: None, key: "parts".into(), fault: Box::new(found) },
        }
    }
}

/// A feature by its full name, such as `housing.bore`.
fn feature(tree: &Tree, key: &str, assembly: &Assembly) -> Result<FeatureId, Fault> {
    let Value::Text(text) = &tree.value else {
        return Err(wrong_type(tree, key.to_owned(), "the name of a feature such as \"housing.bore\""));
    };
    let mut known = Vec::new();
    for (part, of) in assembly.parts.iter().enumerate() {
        for feature in 0..of.features.len() {
            let id = FeatureId { part, feature };
            if assembly.feature_name(id) == *text {
                return Ok(id);
            }
            known.push(assembly.feature_name(id));
        }
    }
    let nearest = nearest(text, known.iter().map(String::as_str)).map(str::to_owned);
    let unknown = StudyFault::UnknownWord { what: "feature", found: text.clone(), nearest, known };
    Err(fault(tree.span.clone(), key.to_owned(), unknown))
}

/// Key of a table that is not among the valid ones.
fn unknown_key(tree: &Tree, path: &str, valid: &[&str]) -> Result<(), Fault> {
    let Some((key, _)) = tree.entries().iter().find(|(key, _)| !valid.contains(&key.name.as_str())) else {
        return Ok(());
    };
    let nearest = nearest(&key.name, valid.iter().copied()).map(str::to_owned);
    let valid = valid.iter().map(|&key| key.to_owned()).collect();
    let unknown = StudyFault::UnknownKey { key: key.name.clone(), nearest, valid };
    Err(fault(key.span.clone(), format!("{path}.{}", key.name), unknown))
}

/// Joint that an equation belongs to, for failures at a point.
fn subject(joint: &PartJoint, equation: &NamedFormula, values: &Values<'_>) -> EquationSubject {
    let name = joint.name.clone();
    match joint.kind {
        JointKind::Rod => EquationSubject::Rod { name, unit: values.shown_unit() },
        _ => {
            let freedom = equation.name.strip_prefix(&format!("{name}: ")).unwrap_or(&equation.name).to_owned();
            let unit = values.shown_unit().filter(|_| equation.is_length);
            EquationSubject::Joint { name, freedom, rotation: !equation.is_length, unit }
        }
    }
}

/// Writes the plain lines in place of the assembly.
fn write(expanded: &mut Expanded, read: &Read, closed: ClosedAssembly, values: &Values<'_>) {
    let text = |span: &Range<usize>, text: String| Tree { span: span.clone(), value: Value::Text(text) };
    let key = |span: &Range<usize>, name: &str| Key { span: span.clone(), name: name.to_owned() };
    let mut origins = Vec::new();
    let mut origin = |section: &'static str, name: &str, entry: &Entry| {
        let (name, key, span) = (name.to_owned(), entry.key.clone(), entry.span.clone());
        origins.push(Origin { section, name, key, span });
    };
    if let Some(entries) = expanded.tree.entries_mut() {
        entries.retain(|(key, _)| key.name != "parts" && key.name != "joints");
    }
    let mut unknowns = Vec::new();
    for unknown in &closed.unknowns {
        let entry = &read.parts[unknown.part];
        origin("unknowns", &unknown.name, entry);
        let start = Tree { span: entry.span.clone(), value: Value::Number(unknown.start) };
        let mut keys = vec![(key(&entry.span, "start"), start)];
        if let Some(unit) = values.made_unit(unknown.is_length) {
            keys.push((key(&entry.span, "unit"), text(&entry.span, unit)));
        }
        unknowns.push((key(&entry.span, &unknown.name), Tree { span: entry.span.clone(), value: Value::Table(keys) }));
    }
    let mut formulas = Vec::new();
    for (formula, part) in closed.formulas {
        let entry = &read.parts[part];
        origin("formulas", &formula.name, entry);
        expanded.elements.made.push(formula.name.clone());
        let line = match values.literal_unit().and_then(|_| values.made_unit(formula.is_length)) {
            None => text(&entry.span, formula.formula),
            Some(unit) => {
                let keys = [("formula", formula.formula), ("unit", unit)];
                let keys = keys.map(|(name, value)| (key(&entry.span, name), text(&entry.span, value)));
                Tree { span: entry.span.clone(), value: Value::Table(keys.to_vec()) }
            }
        };
        formulas.push((key(&entry.span, &formula.name), line));
    }
    let mut pressed = Vec::new();
    for contacts in &closed.pressed {
        let (entry, joint) = (&read.joints[contacts.joint], &read.assembly.joints[contacts.joint].name);
        origin("contacts", joint, entry);
        let list = |items: Vec<Tree>| Tree { span: entry.span.clone(), value: Value::Array(items) };
        let texts = |items: &[String]| list(items.iter().map(|item| text(&entry.span, item.clone())).collect());
        let sets = list(contacts.sets.iter().map(|set| texts(set)).collect());
        let keys = vec![(key(&entry.span, "sets"), sets), (key(&entry.span, "changes"), texts(&contacts.changes))];
        pressed.push((key(&entry.span, joint), Tree { span: entry.span.clone(), value: Value::Table(keys) }));
    }
    let mut equations = Vec::new();
    for (equation, joint) in closed.equations {
        // A free motion belongs to the parts as a whole.
        let entry = joint.map_or(&read.parts[0], |joint| &read.joints[joint]);
        origin("equations", &equation.name, entry);
        if let Some(joint) = joint {
            let subject = subject(&read.assembly.joints[joint], &equation, values);
            expanded.elements.subjects.push((equation.name.clone(), subject));
        }
        equations.push((key(&entry.span, &equation.name), text(&entry.span, equation.formula)));
    }
    let sections = [("unknowns", unknowns), ("formulas", formulas), ("equations", equations), ("contacts", pressed)];
    // Greatest number of studies have no contacts, and their section is left out.
    for (section, lines) in sections.into_iter().filter(|(section, lines)| *section != "contacts" || !lines.is_empty())
    {
        if let Some(entries) = expanded.tree.section(section).filter(|_| !lines.is_empty()) {
            entries.extend(lines);
        }
    }
    for (measure, formula) in read.measures.iter().zip(closed.measures) {
        let name = measure.key.strip_prefix("characteristics.").unwrap_or(&measure.key);
        let Some(entry) = expanded.tree.get_mut("characteristics").and_then(|all| all.get_mut(name)) else { continue };
        let formula = values.result(formula, measures::is_angle(entry), measures::unit(entry));
        if let Some(keys) = entry.entries_mut() {
            keys.retain(|(key, _)| !measures::KEYS.contains(&key.name.as_str()));
            keys.insert(0, (key(&measure.span, "formula"), text(&measure.span, formula)));
        }
        origin("characteristics", name, measure);
    }
    expanded.origins.extend(origins);
}
