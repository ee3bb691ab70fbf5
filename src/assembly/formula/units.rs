//! Units of formulas: the quantity that every part measures, and places where two units are incompatible.
//!
//! Numbers are used as they are written, so that a result is right only if units agree in kind and in scale. A name without a unit, and
//! every part that contains it, is compatible with any unit. A literal factor may be a conversion by hand (`25.4*shim`). One that is not a
//! common factor may hide a unit (`400*travel`). Radians may be dropped, but not introduced.

use std::ops::Range;

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::parser::{Formula, Node};
use crate::assembly::formula::quantity::{Quantity, near};
use crate::assembly::formula::set::{FormulaSet, Reference};
use sensitol_numeric::unit::Unit;

/// Advice on a unit that is unknown.
const UNKNOWN_UNIT: &str = "units are such as mm, um/(m*K), 1/K, degC and N.m/rad";

/// Role of a formula, which may determine its unit.
#[derive(Debug, Clone, PartialEq)]
pub enum Role {
    /// No restriction of the unit.
    Free,
    /// Value that must have this unit.
    Declared(Unit),
    /// Angle that must be in radians.
    Angle,
    /// Length that must be compatible with that of this formula.
    Like(usize),
    /// Result whose unit must be declared if it has one and units are converted.
    Result,
}

/// Finding that two units are incompatible.
#[derive(Debug, Clone, PartialEq)]
pub struct UnitFinding {
    /// Index of the formula.
    pub formula: usize,
    /// Range of the faulty part in its text.
    pub span: Range<usize>,
    /// Description of the fault.
    pub what: String,
    /// Text to write instead.
    pub remedy: String,
    /// True if a number without a unit could explain the finding.
    pub doubtful: bool,
}

/// Check of one formula. Only the first finding counts, because further ones follow from it.
struct Pass<'f> {
    formula: &'f Formula,
    index: usize,
    convert: bool,
    first: Option<UnitFinding>,
}

impl FormulaSet {
    /// Returns the first finding of incompatible units in every formula. `unit` gives the units of names from outside, `unread` the text of a
    /// unit that is unknown, and `role` the role of a formula. With `convert` all names are in SI.
    ///
    /// Cost: one pass over the formulas, and no evaluation.
    pub(crate) fn units(
        &self,
        unit: &dyn Fn(&str) -> Option<Unit>,
        unread: &dyn Fn(&str) -> Option<String>,
        role: &dyn Fn(usize) -> Role,
        convert: bool,
    ) -> Vec<UnitFinding> {
        let si = |unit: Unit| if convert { unit.in_si() } else { unit };
        let mut known: Vec<Option<Quantity>> = vec![None; self.len()];
        let mut findings = Vec::new();
        for &index in &self.order {
            let entry = &self.formulas[index];
            let of_name = |node: usize, name: &str| match entry.references[&node] {
                Reference::Outside(_) => unit(name).map(si).map(Quantity::of),
                Reference::Formula(formula) => known[formula].clone(),
            };
            let mut pass = Pass { formula: &entry.formula, index, convert, first: None };
            let found = pass.run(&of_name, unread);
            known[index] = match role(index) {
                Role::Free => found,
                Role::Declared(declared) => {
                    pass.declared(found.as_ref(), &si(declared.clone()));
                    Some(Quantity::of(si(declared)))
                }
                Role::Angle => {
                    pass.angle(found.as_ref(), entry.formula.nodes.len() - 1, "angle");
                    found
                }
                Role::Like(first) => {
                    if first != index
                        && let (Some(a), Some(b)) = (&known[first], &found)
                    {
                        pass.alike([Some(a), Some(b)], entry.formula.nodes.len() - 1, None, "a loop");
                    }
                    found
                }
                Role::Result => {
                    if convert {
                        pass.needs_unit(found.as_ref());
                    }
                    found
                }
            };
            findings.extend(pass.first);
        }
        findings
    }
}

impl Pass<'_> {
    fn fail(&mut self, node: usize, what: String, remedy: String, doubtful: bool) {
        let (formula, span) = (self.index, self.formula.nodes[node].1.clone());
        self.first.get_or_insert(UnitFinding { formula, span, what, remedy, doubtful });
    }

    /// Returns a part as it is written, with parentheses around a sum.
    fn text(&self, node: usize) -> String {
        let text = self.formula.text()[self.formula.nodes[node].1.clone()].trim();
        match self.formula.nodes[node].0 {
            Node::Binary(Binary::Add | Binary::Subtract, ..) if !text.starts_with('(') => format!("({text})"),
            _ => text.to_owned(),
        }
    }

    /// True if a node is the constant `deg`.
    fn is_deg(&self, node: usize) -> bool {
        matches!(self.formula.nodes[node].0, Node::Number(_))
            && self.formula.text()[self.formula.nodes[node].1.clone()].trim_matches(['(', ')', ' ']) == "deg"
    }

    /// Returns the quantity that the formula measures, or None if a unit is unknown.
    fn run(
        &mut self,
        of_name: &dyn Fn(usize, &str) -> Option<Quantity>,
        unread: &dyn Fn(&str) -> Option<String>,
    ) -> Option<Quantity> {
        let formula = self.formula;
        let mut all: Vec<Option<Quantity>> = Vec::with_capacity(formula.nodes.len());
        let mut unknown = None;
        for (index, (node, _)) in formula.nodes.iter().enumerate() {
            let own = match node {
                Node::Number(_) if formula.unit_of(index).is_some() => {
                    let unit = formula.unit_of(index).cloned().expect("it was just there");
                    Some(Quantity::of(if self.convert { unit.in_si() } else { unit }))
                }
                Node::Number(_) if self.is_deg(index) && !self.convert => {
                    // The constant has the unit radians per degree, so that degrees times `deg` are radians.
                    Some(Quantity::of(Unit::radians_of_a_degree()))
                }
                Node::Number(value) => Some(Quantity::number(*value)),
                Node::Name(name) => {
                    let found = of_name(index, name);
                    if found.is_none() {
                        unknown.get_or_insert(index);
                    }
                    found
                }
                Node::Unary(function, a) => {
                    self.one_temperature(&all[*a], *a);
                    self.unary(*function, all[*a].clone(), *a)
                }
                Node::Binary(function, a, b) => self.binary(*function, [&all[*a], &all[*b]], [*a, *b], index),
                Node::If(_, then, otherwise) => self.alike(
                    [all[*then].as_ref(), all[*otherwise].as_ref()],
                    index,
                    Some([*then, *otherwise]),
                    "branches of `if`",
                ),
            };
            all.push(own);
        }
        self.needs_all_units(unknown, &all, unread);
        let found = all.pop().flatten();
        self.one_temperature(&found, formula.nodes.len() - 1);
        found
    }

    /// Checks that a formula with conversion has the units of all its names, or of none.
    fn needs_all_units(
        &mut self,
        unknown: Option<usize>,
        all: &[Option<Quantity>],
        unread: &dyn Fn(&str) -> Option<String>,
    ) {
        let formula = self.formula;
        if let (true, Some(node)) = (self.convert, unknown) {
            let some = (formula.nodes.iter().zip(all))
                .any(|((node, _), found)| matches!(node, Node::Name(_)) && found.is_some());
            if some || !formula.has_no_units() {
                let name = self.text(node);
                let plain = match &formula.nodes[node].0 {
                    Node::Name(name) => name.as_str(),
                    _ => name.as_str(),
                };
                match unread(plain) {
                    Some(unit) => {
                        let what = format!("the unit `{unit}` of `{name}` is unknown: convert needs all of a formula");
                        self.fail(node, what, UNKNOWN_UNIT.to_owned(), false);
                    }
                    None => {
                        let remedy = "write its unit; that of a plain number is unit = \"1\"".to_owned();
                        self.fail(node, format!("`{name}` has no unit: convert needs all of a formula"), remedy, false);
                    }
                }
            }
        }
    }

    fn unary(&mut self, function: Unary, a: Option<Quantity>, node: usize) -> Option<Quantity> {
        match function {
            Unary::Negate | Unary::Abs | Unary::Floor | Unary::Ceil => a,
            Unary::Sqrt => a.map(|a| a.power(0.5)),
            Unary::Sign => Some(Quantity::of(Unit::one())),
            Unary::Sin | Unary::Cos | Unary::Tan => {
                let name = match function {
                    Unary::Sin => "sine",
                    Unary::Cos => "cosine",
                    _ => "tangent",
                };
                self.angle(a.as_ref(), node, name);
                Some(Quantity::of(Unit::one()))
            }
            _ => {
                self.plain(a.as_ref(), node, function);
                let inverse = matches!(function, Unary::Asin | Unary::Acos | Unary::Atan);
                Some(Quantity::of(if inverse { Unit::radian() } else { Unit::one() }))
            }
        }
    }

    /// Checks an argument that must be an angle in radians or a plain number.
    fn angle(&mut self, found: Option<&Quantity>, node: usize, of: &str) {
        let Some(found) = found.filter(|found| !found.literal) else { return };
        let what = if of == "angle" { "an angle".to_owned() } else { format!("{of} of") };
        let what = |unit: &str| if of == "angle" { format!("{what} in {unit}") } else { format!("{what} {unit}") };
        if !found.unit.is_plain() {
            let remedy = "its argument is an angle or a plain number".to_owned();
            let text = format!("{}, which is not an angle", what(&found.unit.to_string()));
            return self.fail(node, text, remedy, found.doubtful().is_some());
        }
        if self.convert || found.scales().iter().any(|scale| near(*scale, 1.0)) {
            return;
        }
        let degrees = near(found.unit.scale, std::f64::consts::PI / 180.0);
        let (unit, remedy) = match degrees {
            true => ("degrees".to_owned(), format!("write {}*deg", self.text(node))),
            false => (found.unit.to_string(), "convert it to radians".to_owned()),
        };
        self.fail(node, what(&unit), remedy, false);
    }

    /// Checks the argument of an exponential, logarithm or inverse function, which must be a plain number.
    fn plain(&mut self, found: Option<&Quantity>, node: usize, function: Unary) {
        let Some(found) = found.filter(|found| !found.literal) else { return };
        let scale = self.convert || found.scales().iter().any(|scale| near(*scale, 1.0));
        if found.unit.is_plain() && scale {
            return;
        }
        let name = format!("{function:?}").to_lowercase();
        let (what, doubtful) = (format!("`{name}` of a quantity in {}", found.unit), found.doubtful());
        let remedy = match doubtful {
            Some(factor) => hidden(factor, &Unit::one().over(&found.unit)),
            None => format!("divide by a reference in {}", found.unit),
        };
        self.fail(node, what, remedy, doubtful.is_some());
    }

    fn binary(
        &mut self,
        function: Binary,
        [a, b]: [&Option<Quantity>; 2],
        nodes: [usize; 2],
        node: usize,
    ) -> Option<Quantity> {
        let what = match function {
            Binary::Add => "a sum",
            Binary::Subtract => "a difference",
            Binary::Min => "`min`",
            Binary::Max => "`max`",
            Binary::Hypot => "`hypot`",
            Binary::Atan2 => "`atan2`",
            Binary::Multiply | Binary::Divide | Binary::Power => return self.product(function, [a, b], nodes, node),
            _ => "a comparison",
        };
        if let (Binary::Add | Binary::Subtract, Some(one), Some(other)) = (function, a, b)
            && (one.unit.point || other.unit.point)
        {
            return self.temperatures(function, one, other, node);
        }
        for (found, node) in [(a, nodes[0]), (b, nodes[1])] {
            self.one_temperature(found, node);
        }
        let joined = self.alike([a.as_ref(), b.as_ref()], node, Some(nodes), what);
        match function {
            Binary::Atan2 => Some(Quantity::of(Unit::radian())),
            Binary::Add | Binary::Subtract if a.is_none() || b.is_none() => None,
            Binary::Add | Binary::Subtract | Binary::Min | Binary::Max | Binary::Hypot => joined,
            _ => Some(Quantity::of(Unit::one())),
        }
    }

    /// Sum or difference with temperatures on a scale. A part that adds several up is a temperature again once it is their mean.
    fn temperatures(&mut self, function: Binary, a: &Quantity, b: &Quantity, node: usize) -> Option<Quantity> {
        let remedy = || "subtract their reference first".to_owned();
        let (point, other) = if a.unit.point { (a, b) } else { (b, a) };
        if !other.literal && !other.unit.same_kind(&point.unit) {
            self.fail(node, format!("a temperature and {}", other.unit), remedy(), false);
            return None;
        }
        if other.unit.point && !near(other.unit.zero, point.unit.zero) {
            let what = format!("temperatures in {} and {}, whose zeros differ", a.unit, b.unit);
            self.fail(node, what, format!("write both in {}", a.unit), false);
            return None;
        }
        if !self.convert && !other.literal && !near(other.unit.scale, point.unit.scale) {
            let what = format!("a temperature in {} and a difference in {}", point.unit, other.unit);
            self.fail(node, what, "write both in one unit, or units = \"convert\" at the top".to_owned(), false);
            return None;
        }
        if function == Binary::Subtract && !a.unit.point {
            self.fail(node, "a temperature subtracted from a difference".to_owned(), remedy(), false);
            return None;
        }
        let points = if function == Binary::Subtract { a.points - b.points } else { a.points + b.points };
        match near(1.0 + points, 1.0) {
            true => Some(Quantity::of(point.unit.difference())),
            false => Some(Quantity { points, ..point.clone() }),
        }
    }

    /// Checks that a part with temperatures on a scale is one temperature or their mean.
    fn one_temperature(&mut self, found: &Option<Quantity>, node: usize) {
        let Some(found) = found.as_ref().filter(|found| found.unit.point && !near(found.points, 1.0)) else { return };
        let (what, remedy) = match self.formula.nodes[node].0 {
            Node::Binary(Binary::Multiply | Binary::Divide, ..) => {
                (format!("a temperature in {} as a factor", found.unit), "subtract its reference first")
            }
            _ => ("a sum of two temperatures".to_owned(), "subtract their reference first, or divide by their number"),
        };
        self.fail(node, what, remedy.to_owned(), false);
    }

    fn product(
        &mut self,
        function: Binary,
        [a, b]: [&Option<Quantity>; 2],
        nodes: [usize; 2],
        node: usize,
    ) -> Option<Quantity> {
        if function == Binary::Power {
            return self.power(a.as_ref()?, b.as_ref(), node);
        }
        for (place, other) in [(nodes[0], b), (nodes[1], a)] {
            let Some(other) = other.as_ref().filter(|_| self.is_deg(place)) else { continue };
            if other.literal && function == Binary::Multiply {
                return Some(Quantity::of(Unit::radian()));
            }
            let radians = near(other.unit.radians, 1.0) && other.unit.is_plain();
            if function == Binary::Multiply && !self.convert && radians && near(other.unit.scale, 1.0) {
                self.fail(node, "radians already".to_owned(), "leave out deg".to_owned(), false);
                return None;
            }
            if self.convert && radians {
                let text = self.text(if place == nodes[0] { nodes[1] } else { nodes[0] });
                let (what, sign) =
                    (format!("{text} is converted already"), if function == Binary::Multiply { '*' } else { '/' });
                self.fail(node, what, format!("leave out {sign}deg"), false);
                return None;
            }
        }
        let (a, b) = (a.as_ref()?, b.as_ref()?);
        if a.unit.point || b.unit.point {
            let (point, other) = if a.unit.point { (a, b) } else { (b, a) };
            if other.literal && (a.unit.point || function == Binary::Multiply) {
                let number: f64 = other.factors.iter().product();
                let points = if function == Binary::Divide { point.points / number } else { point.points * number };
                return Some(Quantity { points, ..point.clone() });
            }
            let what = format!("a temperature in {} as a factor", point.unit);
            self.fail(node, what, "subtract its reference first".to_owned(), false);
            return None;
        }
        Some(a.combined(b, function == Binary::Divide))
    }

    fn power(&mut self, a: &Quantity, b: Option<&Quantity>, node: usize) -> Option<Quantity> {
        if a.literal {
            return Some(a.clone());
        }
        match b.filter(|b| b.literal) {
            Some(b) => Some(a.power(b.factors.iter().product())),
            None if a.unit.is_plain() => Some(Quantity::of(Unit::one())),
            None => {
                let what = format!("{} to a power that is not a number", a.unit);
                self.fail(node, what, "write the exponent as a number".to_owned(), false);
                None
            }
        }
    }

    /// Checks that two parts have the same unit, and returns the common quantity.
    fn alike(
        &mut self,
        [a, b]: [Option<&Quantity>; 2],
        node: usize,
        nodes: Option<[usize; 2]>,
        what: &str,
    ) -> Option<Quantity> {
        let (a, b) = match (a, b) {
            (Some(a), Some(b)) => (a, b),
            (one, other) => return one.or(other).filter(|found| !found.literal).cloned(),
        };
        if a.literal || b.literal {
            let (known, bare, place) = if a.literal { (b, a, 0) } else { (a, b, 1) };
            let zero = bare.factors.contains(&0.0);
            // A number beside an angle is in radians, like `pi`.
            let plain = known.unit.is_plain() && (known.unit.radians > 0.0 || known.unit.to_string() == "1");
            if self.convert && !known.literal && !zero && !plain {
                let number = nodes.map_or_else(|| "2".to_owned(), |nodes| self.text(nodes[place]));
                let text = format!("{what} of {} and a bare number", known.unit);
                self.fail(node, text, format!("write {number}[{}]", known.unit), false);
            }
            return Some(known.clone());
        }
        if !a.unit.same_kind(&b.unit) {
            let text = format!("{what} of {} and {}", a.unit, b.unit);
            let (doubt, needed) = match (a.doubtful(), b.doubtful()) {
                (Some(factor), _) => (Some(factor), b.unit.over(&a.unit)),
                (None, Some(factor)) => (Some(factor), a.unit.over(&b.unit)),
                (None, None) => (None, Unit::one()),
            };
            let remedy = match doubt {
                Some(factor) => hidden(factor, &needed),
                None => "correct the unit of one of them, or the formula".to_owned(),
            };
            self.fail(node, text, remedy, doubt.is_some());
            return None;
        }
        if !a.fits(b) && !self.convert {
            let factor = b.unit.scale / a.unit.scale;
            let text = format!("{what} of {} and {} (factor {})", a.unit, b.unit, shown(factor));
            let part = nodes.map_or_else(|| "it".to_owned(), |nodes| self.text(nodes[1]));
            let by = format!("{}[{}]", shown(factor), a.unit.over(&b.unit));
            self.fail(node, text, format!("write {by}*{part}, or units = \"convert\" at the top"), false);
            return None;
        }
        Some(a.clone())
    }

    /// Checks that the result of a formula has its declared unit.
    fn declared(&mut self, found: Option<&Quantity>, declared: &Unit) {
        let Some(found) = found.filter(|found| !found.literal) else { return };
        let node = self.formula.nodes.len() - 1;
        let said = format!("the formula gives {}, unit says {declared}", found.unit);
        if !found.unit.same_kind(declared) {
            let doubt = found.doubtful();
            let remedy = match doubt {
                Some(factor) => hidden(factor, &declared.over(&found.unit)),
                None => "correct the formula, or the unit".to_owned(),
            };
            return self.fail(node, said, remedy, doubt.is_some());
        }
        if !self.convert && !found.fits(&Quantity::of(declared.clone())) {
            let factor = found.unit.scale / declared.scale;
            let remedy = format!("write unit = \"{}\", or units = \"convert\" at the top", found.unit);
            self.fail(node, format!("{said}: factor {}", shown(factor)), remedy, false);
        }
    }

    /// Checks that a result with a unit declares it.
    fn needs_unit(&mut self, found: Option<&Quantity>) {
        let Some(found) = found.filter(|found| !found.literal && !found.unit.is_plain()) else { return };
        let (node, unit) = (self.formula.nodes.len() - 1, found.unit.clone());
        self.fail(
            node,
            format!("the formula gives {unit}, and no unit is asked for"),
            format!("write unit = \"{unit}\""),
            false,
        );
    }
}

/// Formats a factor with as many digits as it needs, twelve at most.
fn shown(factor: f64) -> String {
    let rounded: f64 = format!("{factor:.11e}").parse().unwrap_or(factor);
    if (1e-4..1e6).contains(&rounded.abs()) { rounded.to_string() } else { format!("{rounded:e}") }
}

/// Advises that a number may hide a unit.
fn hidden(factor: f64, unit: &Unit) -> String {
    format!("if the number {} has a unit, write it: {}[{unit}]", shown(factor), shown(factor))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::assembly::formula::set::Meaning;

    fn case(name: &str) -> serde_json::Map<String, serde_json::Value> {
        let text = std::fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/tests/data/elements.json")).unwrap();
        let cases: serde_json::Value = serde_json::from_str(&text).unwrap();
        let found = cases["cases"].as_array().unwrap().iter().find(|case| case["name"] == name).cloned().unwrap();
        found["printed"].as_object().unwrap().clone()
    }

    /// Returns the findings with the names of the case `units-check-accepts`, and `x` without a unit.
    fn findings(text: &str, role: Role, convert: bool) -> Vec<UnitFinding> {
        let named = [
            ("a", "mm"),
            ("l", "mm"),
            ("r", "mm"),
            ("b", "in"),
            ("th", "deg"),
            ("ph", "rad"),
            ("F", "N"),
            ("A", "mm^2"),
            ("E", "MPa"),
            ("al", "1/K"),
            ("T", "degC"),
            ("T0", "degC"),
            ("w", "rad/s"),
            ("x", "furlong"),
        ];
        let meanings = named.iter().enumerate().map(|(index, (name, _))| (*name, Meaning::Variable(index)));
        let set = FormulaSet::new(vec![("y".to_owned(), Formula::parse(text).unwrap())], meanings).unwrap();
        let unit = |name: &str| named.iter().find(|(known, _)| *known == name).and_then(|(_, unit)| Unit::parse(unit));
        set.units(&unit, &|_| None, &|_| role.clone(), convert)
    }

    #[test]
    fn what_goes_together_is_accepted_with_its_unit() {
        let accepted = case("units-check-accepts");
        assert_eq!(accepted.len(), 14);
        for (text, unit) in &accepted {
            let declared = Unit::parse(unit.as_str().unwrap()).unwrap();
            assert_eq!(findings(text, Role::Declared(declared), false), [], "{text}");
        }
        let percent = Unit::parse("%").unwrap();
        assert_eq!(findings("100*(2*a*pi/(4*l))", Role::Declared(percent), false), []);
        for text in
            ["a + x", "hypot(a, x) + F*x", "a^2.5/l^1.5 + a", "if(a > l, a, 0)", "a/2 + pi*l/4", "floor(a) - abs(-l)"]
        {
            assert_eq!(findings(text, Role::Declared(Unit::parse("mm").unwrap()), false), [], "{text}");
        }
    }

    #[test]
    fn what_does_not_go_together_is_refused() {
        let refused = case("units-check-refuses");
        assert_eq!(refused.len(), 11);
        for (text, words) in &refused {
            let found = findings(text, Role::Free, false);
            assert!(found.len() == 1 && !found[0].doubtful, "{text} {found:?}");
            let words = words.as_str().unwrap();
            let said = found[0].what.contains(words)
                || words == "a unit in exp" && found[0].what.starts_with("`exp` of")
                || words == "no angle" && found[0].what.ends_with("not an angle");
            assert!(said && !found[0].remedy.is_empty(), "{text} {found:?}");
        }
        assert_eq!(findings("a*sin(th)", Role::Free, false)[0].span, 6..8);
    }

    #[test]
    fn numbers_that_may_hide_a_unit_are_doubts() {
        let doubts = case("units-check-doubts");
        assert_eq!(doubts.len(), 3);
        for text in doubts.keys() {
            let found = findings(text, Role::Free, false);
            assert!(found.len() == 1 && found[0].doubtful, "{text} {found:?}");
        }
        assert_eq!(
            findings("400*a + F", Role::Free, false)[0].remedy,
            "if the number 400 has a unit, write it: 400[N/mm]"
        );
        assert_eq!(findings("400[N/mm]*a + F", Role::Free, false), []);
        // A common factor hides no unit.
        assert!(!findings("2*a + F", Role::Free, false)[0].doubtful);
    }

    #[test]
    fn conversion_wants_every_unit_and_no_conversion_by_hand() {
        for (text, what) in [
            ("a + b", None),
            ("a*sin(th)", None),
            ("a + x", Some("`x` has no unit: convert needs all of a formula")),
            ("a + 2", Some("a sum of mm and a bare number")),
            ("a + 2[mm] + max(b, 0)", None),
            ("a*sin(th*deg)", Some("th is converted already")),
            ("a*sin(30*deg)", None),
            ("a + F", Some("a sum of mm and N")),
            ("400*a + F", Some("a sum of mm and N")),
        ] {
            let found = findings(text, Role::Declared(Unit::parse("mm").unwrap()), true);
            assert_eq!(found.first().map(|found| found.what.as_str()), what, "{text}");
        }
        assert_eq!(findings("a + b", Role::Result, true)[0].remedy, "write unit = \"mm\"");
    }

    /// A mean of temperatures is a temperature; another combination of them is one only if its weights add up to 1.
    #[test]
    fn means_of_temperatures_are_temperatures() {
        let what = |text: &str, convert: bool| {
            findings(text, Role::Free, convert).first().map(|found| found.what.clone()).unwrap_or_default()
        };
        for text in ["(T + T0)/2", "0.5*(T + T0)", "T/2 + T0/2", "2*T - T0", "(T + T0)/2 - 20[degC]", "max(T, T0)"] {
            assert_eq!([what(text, false), what(text, true)], ["", ""], "{text}");
        }
        assert_eq!(what("al*((T + T0)/2 - T)*a", true), "");
        assert_eq!(what("max(T + T0, T)", true), "a sum of two temperatures");
        assert_eq!(what("2*T", true), "a temperature in degC as a factor");
        assert_eq!(what("T - 68[degF]", true), "temperatures in degC and degF, whose zeros differ");
    }

    #[test]
    fn declared_units_and_angles_are_held() {
        let declared = |text: &str, unit: &str| {
            let found = findings(text, Role::Declared(Unit::parse(unit).unwrap()), false);
            found.first().map(|found| format!("{}: {}", found.what, found.remedy))
        };
        assert_eq!(
            declared("F/A", "kPa").unwrap(),
            "the formula gives N/mm^2, unit says kPa: factor 1000: write unit = \"N/mm^2\", or units = \"convert\" at the top"
        );
        assert_eq!(declared("F/A", "MPa"), None);
        // The factor 1000 is a conversion by hand.
        assert_eq!(declared("1000*F/A", "kPa"), None);
        assert!(declared("F*a", "mm").unwrap().starts_with("the formula gives N.mm, unit says mm"));
        assert_eq!(findings("th", Role::Angle, false)[0].remedy, "write th*deg");
        assert_eq!(findings("th*deg + pi/2", Role::Angle, false), []);
    }
}
