//! Numbers of an assembly: texts and units, and their values at the nominal dimensions.

use crate::error::{Fault, Faults, StudyFault, fault};
use crate::expand::{Tree, Value, quoted, wrong_type};
use crate::tree::Key;
use sensitol::assembly::formula::Formula;
use sensitol_numeric::unit::Unit;
use sensitol_spatial::Quantity;

/// Values of the characteristics of a study at its nominal dimensions, in the units of formulas.
pub(crate) type NominalValues<'a> = &'a dyn Fn(&Tree) -> Result<Vec<f64>, Faults>;

/// Sections of a study that formulas of dimensions need. Of `[formulas]` they need a part only.
const NEEDED: [&str; 3] = ["units", "dimensions", "constants"];

/// Quantity that a number measures.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Measures {
    Length,
    /// An angle: a number is in degrees, a name in its unit, and a formula in radians.
    Angle,
    /// A part of a direction.
    Plain,
}

/// Collects the formulas of an assembly. Until they are evaluated, the value of a quantity with a formula is its number.
pub(super) struct Values<'t> {
    study: &'t Tree,
    converts: bool,
    /// Unit of lengths; None if the study names none.
    unit: Option<String>,
    /// Formulas with their keys, places and measured quantities.
    formulas: Vec<(String, Tree, Measures)>,
}

/// Values of all formulas.
pub(super) struct Nominal(Vec<f64>);

impl Nominal {
    /// Replaces the number of a formula by its value.
    pub(super) fn set(&self, quantity: &mut Quantity) {
        if quantity.formula.is_some() {
            quantity.value = self.0.get(quantity.value as usize).copied().unwrap_or(f64::NAN);
        }
    }
}

impl<'t> Values<'t> {
    pub(super) fn new(study: &'t Tree) -> Self {
        let mode = study.get("units").map(|mode| &mode.value);
        let converts = matches!(mode, Some(Value::Text(mode)) if mode == "convert");
        Self { study, converts, unit: length_unit(study), formulas: Vec::new() }
    }

    /// Reads a number or formula.
    pub(super) fn quantity(&mut self, tree: &Tree, key: &str, measures: Measures) -> Result<Quantity, Fault> {
        let given = match tree.value {
            Value::Number(value) => Some(value),
            Value::Integer(value) => Some(value as f64),
            _ => None,
        };
        if let Some(value) = given {
            if !value.is_finite() {
                return Err(fault(
                    tree.span.clone(),
                    key.to_owned(),
                    StudyFault::NotFinite { text: value.to_string() },
                ));
            }
            let unit = self.unit.clone().filter(|_| self.converts && measures == Measures::Length && value != 0.0);
            let Some(unit) = unit else { return Ok(Quantity::constant(value * self.factor(measures))) };
            // With converted units a length in a formula needs its unit.
            let text = format!("{:?}[{unit}]", value.abs());
            let text = if value < 0.0 { format!("(-{text})") } else { text };
            return Ok(self.asked(text, tree, key, measures));
        }
        let Value::Text(text) = &tree.value else {
            return Err(wrong_type(tree, key.to_owned(), "a number, the name of a dimension, or a formula in quotes"));
        };
        let name = quoted(text);
        let formula = match self.unit_of(text) {
            // A name is no formula, so that characters such as a hyphen are no operators.
            Some(unit) => match measures == Measures::Angle && !self.converts && is_degrees(unit) {
                true => format!("{name}*deg"),
                false => name,
            },
            None => match Formula::parse(text) {
                Ok(_) => text.clone(),
                Err(error) => return Err(fault(tree.span.clone(), key.to_owned(), StudyFault::Formula(error.fault))),
            },
        };
        Ok(self.asked(formula, tree, key, measures))
    }

    /// A formula whose value is requested.
    fn asked(&mut self, formula: String, tree: &Tree, key: &str, measures: Measures) -> Quantity {
        let number = self.formulas.len() as f64;
        let value = Tree { span: tree.span.clone(), value: Value::Text(formula.clone()) };
        self.formulas.push((key.to_owned(), value, measures));
        Quantity::formula(formula, number)
    }

    /// Unit of a pose or formula in the study; None if it has none.
    pub(super) fn made_unit(&self, is_length: bool) -> Option<String> {
        match (is_length, self.converts) {
            (true, _) => self.unknown_unit(),
            (false, true) => Some("1".to_owned()),
            (false, false) => None,
        }
    }

    /// Unit of lengths in the study; None if it names none.
    pub(super) fn length_unit(&self) -> Option<String> {
        self.unit.clone()
    }

    /// Unit of lengths in the study with its size in the unit of formulas; None if the study names none.
    pub(super) fn shown_unit(&self) -> Option<(String, f64)> {
        Some((self.unit.clone()?, self.length_factor()))
    }

    /// Unit that a constant length needs in a formula.
    pub(super) fn literal_unit(&self) -> Option<String> {
        self.unknown_unit().filter(|_| self.converts)
    }

    /// Reads a list of numbers or formulas.
    pub(super) fn list<const N: usize>(
        &mut self,
        tree: &Tree,
        key: &str,
        measures: Measures,
    ) -> Result<[Quantity; N], Fault> {
        let Value::Array(items) = &tree.value else {
            return Err(wrong_type(tree, key.to_owned(), &format!("a list of {N} numbers or formulas")));
        };
        let mut found = Vec::new();
        for (index, item) in items.iter().enumerate() {
            found.push(self.quantity(item, &format!("{key}.[{}]", index + 1), measures)?);
        }
        found.try_into().map_err(|_| wrong_type(tree, key.to_owned(), &format!("a list of {N} numbers or formulas")))
    }

    /// Unit of a dimension, constant or formula of this name, empty if it has none. Returns None if there is no such name.
    fn unit_of(&self, name: &str) -> Option<&'t str> {
        let entry =
            ["dimensions", "constants", "formulas"].iter().find_map(|section| self.study.get(section)?.get(name))?;
        match entry.get("unit").map(|unit| &unit.value) {
            Some(Value::Text(unit)) => Some(unit),
            _ => Some(""),
        }
    }

    /// Factor from a number of the assembly to the units of formulas.
    fn factor(&self, measures: Measures) -> f64 {
        match measures {
            Measures::Length if self.converts => {
                self.unit.as_deref().and_then(Unit::parse).map_or(1.0, |unit| unit.scale)
            }
            Measures::Angle => std::f64::consts::PI / 180.0,
            _ => 1.0,
        }
    }

    /// Factor from a length of the assembly to the units of formulas.
    pub(super) fn length_factor(&self) -> f64 {
        self.factor(Measures::Length)
    }

    /// Unit in which formulas give a number; None unless units are converted.
    fn formula_unit(&self, measures: Measures) -> Option<&'static str> {
        match measures {
            Measures::Length => self.unit.as_ref().filter(|_| self.converts).map(|_| "m"),
            Measures::Angle => self.converts.then_some("rad"),
            Measures::Plain => None,
        }
    }

    /// Unit of the unknown places; None if none is known.
    fn unknown_unit(&self) -> Option<String> {
        let unit = self.unit.clone()?;
        Some(if self.converts { "m".to_owned() } else { unit })
    }

    /// Formula of a measure in the unit of its characteristic.
    pub(super) fn result(&self, formula: String, is_angle: bool, unit: &str) -> String {
        match is_angle && !self.converts && is_degrees(unit) {
            true => format!("({formula})/deg"),
            false => formula,
        }
    }

    /// Evaluates all formulas.
    pub(super) fn evaluated(&self, nominal: NominalValues<'_>) -> Result<Nominal, Faults> {
        if self.formulas.is_empty() {
            return Ok(Nominal(Vec::new()));
        }
        let mut sections: Vec<(Key, Tree)> =
            (self.study.entries().iter()).filter(|(key, _)| NEEDED.contains(&key.name.as_str())).cloned().collect();
        let key = |tree: &Tree, name: &str| Key { span: tree.span.clone(), name: name.to_owned() };
        let formulas = Tree { span: self.study.span.clone(), value: Value::Table(self.needed_formulas()) };
        sections.push((key(self.study, "formulas"), formulas));
        let mut asked = Vec::new();
        for (index, (_, formula, measures)) in self.formulas.iter().enumerate() {
            let mut line = vec![(key(formula, "formula"), formula.clone())];
            if let Some(unit) = self.formula_unit(*measures) {
                let unit = Tree { span: formula.span.clone(), value: Value::Text(unit.to_owned()) };
                line.push((key(formula, "unit"), unit));
            }
            let line = Value::Table(line);
            asked.push((key(formula, &format!("{PREFIX}{index}")), Tree { span: formula.span.clone(), value: line }));
        }
        let asked = Tree { span: self.study.span.clone(), value: Value::Table(asked) };
        sections.push((key(self.study, "characteristics"), asked));
        let study = Tree { span: self.study.span.clone(), value: Value::Table(sections) };
        let found = nominal(&study).map_err(|faults| self.renamed(faults))?;
        let mut faults = Faults::default();
        for (value, (key, formula, _)) in found.iter().zip(&self.formulas) {
            if !value.is_finite() {
                let text = format!("{value}");
                faults.0.push(fault(formula.span.clone(), key.clone(), StudyFault::NotFinite { text }));
            }
        }
        faults.none()?;
        Ok(Nominal(found))
    }

    /// Formulas of the study that the numbers use, directly or through others. Further ones may use measures, which have no value yet.
    fn needed_formulas(&self) -> Vec<(Key, Tree)> {
        let all = self.study.get("formulas").map_or(&[][..], Tree::entries);
        let mut open: Vec<&Tree> = self.formulas.iter().map(|(_, formula, _)| formula).collect();
        let mut needed: Vec<&str> = Vec::new();
        while let Some(entry) = open.pop() {
            let Value::Text(text) = &entry.get("formula").unwrap_or(entry).value else { continue };
            // A formula that cannot be read is reported where it is read.
            let Ok(formula) = Formula::parse(text) else { continue };
            for (key, entry) in all.iter().filter(|(key, _)| formula.names().any(|(name, _)| name == key.name)) {
                if !needed.contains(&key.name.as_str()) {
                    needed.push(&key.name);
                    open.push(entry);
                }
            }
        }
        all.iter().filter(|(key, _)| needed.contains(&key.name.as_str())).cloned().collect()
    }

    /// Faults with the keys of the study.
    fn renamed(&self, mut faults: Faults) -> Faults {
        for found in &mut faults.0 {
            let index = found.key.strip_prefix("characteristics.").and_then(|rest| rest.strip_prefix(PREFIX));
            let index = index.and_then(|rest| rest.split('.').next()?.parse::<usize>().ok());
            if let Some((key, ..)) = index.and_then(|index| self.formulas.get(index)) {
                found.key.clone_from(key);
            }
        }
        faults
    }
}

/// Prefix of the characteristics that stand for numbers of the assembly.
const PREFIX: &str = "number of the assembly ";

fn is_degrees(unit: &str) -> bool {
    Unit::parse(unit).is_some_and(|unit| unit.same_kind(&Unit::radian()) && (unit.scale - 1.0).abs() > 1e-9)
}

/// The first unit of a length among dimensions, constants and characteristics.
pub(super) fn length_unit(study: &Tree) -> Option<String> {
    let metre = Unit::parse("m")?;
    for section in ["dimensions", "constants", "characteristics"] {
        for (_, entry) in study.get(section).map_or(&[][..], Tree::entries) {
            if let Some(Value::Text(unit)) = entry.get("unit").map(|unit| &unit.value)
                && Unit::parse(unit).is_some_and(|unit| unit.same_kind(&metre))
            {
                return Some(unit.clone());
            }
        }
    }
    None
}
