//! Units in sums: units are never converted, so a sum of millimetres and degrees is a number without a meaning.
//!
//! The unit of a part follows from those of the variables. Signs, sums, `abs`, `min`, `max` and `hypot` keep it, and so does a factor
//! or divisor of 2; inverse trigonometric functions return radians. Every other product may convert, so its unit is unknown. An
//! unknown unit, that of a number included, fits every other.

use super::functions::{Binary, Unary};
use super::parser::{Formula, Node};
use super::set::{FormulaSet, Meaning, Reference};

/// The spellings of one unit, the usual one first. Units that are not listed are unknown.
const UNITS: [&[&str]; 33] = [
    &["nm"],
    &["um", "\u{b5}m", "\u{3bc}m"],
    &["mm"],
    &["cm"],
    &["dm"],
    &["m"],
    &["in", "inch", "\""],
    &["mil", "thou"],
    &["ft"],
    &["deg", "\u{b0}", "degree", "degrees"],
    &["rad"],
    &["mrad"],
    &["arcmin"],
    &["arcsec"],
    &["gon"],
    &["s"],
    &["ms"],
    &["min"],
    &["g"],
    &["kg"],
    &["lb"],
    &["N"],
    &["kN"],
    &["N.m", "Nm"],
    &["Pa"],
    &["kPa"],
    &["MPa"],
    &["GPa"],
    &["bar"],
    // Differences of temperature are the same in both.
    &["K", "degC", "\u{b0}C"],
    &["degF", "\u{b0}F"],
    &["Hz"],
    &["rpm"],
];

/// A formula that adds or compares two units, and the first part of it that does.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MixedUnits {
    /// The formula's name.
    pub(crate) formula: String,
    /// The sum or comparison, as written.
    pub(crate) part: String,
    /// The units on its two sides.
    pub(crate) units: [&'static str; 2],
}

impl FormulaSet {
    /// The formulas that add or compare different units, in their order; `unit` names the unit of a variable.
    ///
    /// Cost: one pass over the formulas.
    pub(crate) fn mixed_units<'u>(&self, unit: impl Fn(usize) -> Option<&'u str>) -> Vec<MixedUnits> {
        let mut known: Vec<Option<&'static str>> = vec![None; self.len()];
        let mut mixed: Vec<Option<MixedUnits>> = vec![None; self.len()];
        for &index in &self.order {
            let entry = &self.formulas[index];
            let of_name = |node: usize| match entry.references[&node] {
                Reference::Outside(Meaning::Variable(variable)) => unit(variable).and_then(usual),
                Reference::Outside(Meaning::Constant(_)) => None,
                Reference::Formula(formula) => known[formula],
            };
            let (own, first) = units_of(&entry.formula, of_name);
            known[index] = own;
            mixed[index] = first.map(|(node, units)| {
                let span = entry.formula.nodes[node].1.clone();
                let part = entry.formula.text().get(span).unwrap_or_default().trim().to_owned();
                MixedUnits { formula: entry.name.clone(), part, units }
            });
        }
        mixed.into_iter().flatten().collect()
    }
}

/// The usual spelling of a unit; None for one that is not listed.
fn usual(unit: &str) -> Option<&'static str> {
    UNITS.iter().find(|spellings| spellings.contains(&unit.trim())).map(|spellings| spellings[0])
}

type Mixed = (usize, [&'static str; 2]);

/// The unit of a formula, and the first node that joins two units.
fn units_of(
    formula: &Formula,
    of_name: impl Fn(usize) -> Option<&'static str>,
) -> (Option<&'static str>, Option<Mixed>) {
    let mut units: Vec<Option<&'static str>> = Vec::with_capacity(formula.nodes.len());
    let mut first = None;
    let is_two = |node: usize| matches!(formula.nodes[node].0, Node::Number(2.0));
    for (index, (node, _)) in formula.nodes.iter().enumerate() {
        let mut joined = |a: usize, b: usize| match (units[a], units[b]) {
            (Some(one), Some(other)) if one != other => {
                first.get_or_insert((index, [one, other]));
                None
            }
            (one, other) => one.or(other),
        };
        let own = match *node {
            Node::Number(_) => None,
            Node::Name(_) => of_name(index),
            Node::Unary(Unary::Negate | Unary::Abs, a) => units[a],
            Node::Unary(Unary::Asin | Unary::Acos | Unary::Atan, _) => Some("rad"),
            Node::Unary(..) => None,
            Node::Binary(Binary::Add | Binary::Subtract | Binary::Min | Binary::Max | Binary::Hypot, a, b) => {
                joined(a, b)
            }
            Node::Binary(Binary::Multiply, a, b) if is_two(a) => units[b],
            Node::Binary(Binary::Multiply | Binary::Divide, a, b) if is_two(b) => units[a],
            Node::Binary(Binary::Multiply | Binary::Divide | Binary::Power, ..) => None,
            Node::Binary(Binary::Atan2, a, b) => {
                joined(a, b);
                Some("rad")
            }
            Node::Binary(
                Binary::Less
                | Binary::LessEqual
                | Binary::Greater
                | Binary::GreaterEqual
                | Binary::Equal
                | Binary::NotEqual,
                a,
                b,
            ) => {
                joined(a, b);
                None
            }
            Node::If(_, then, otherwise) => joined(then, otherwise),
        };
        units.push(own);
    }
    (units.last().copied().flatten(), first)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The places found in formulas over `a`, `b` in mm, `inch` in in, `phi` in deg, `t` without a unit, `odd` in an unlisted one.
    fn found(text: &str) -> Option<(String, [&'static str; 2])> {
        let names = ["a", "b", "inch", "phi", "t", "odd"];
        let units = [Some("mm"), Some(" mm"), Some("inch"), Some("\u{b0}"), None, Some("furlong")];
        let formulas = vec![
            ("y".to_owned(), Formula::parse(text).unwrap()),
            ("angle".to_owned(), Formula::parse("phi/2").unwrap()),
        ];
        let meanings = names.iter().enumerate().map(|(index, name)| (*name, Meaning::Variable(index)));
        let set = FormulaSet::new(formulas, meanings).unwrap();
        set.mixed_units(|variable| units[variable]).pop().map(|mixed| (mixed.part, mixed.units))
    }

    #[test]
    fn sums_of_different_units_are_found() {
        for (text, part, units) in [
            ("a + phi", "a + phi", ["mm", "deg"]),
            ("2*(a - inch)", "(a - inch)", ["mm", "in"]),
            ("a*b + max(a, 2*phi)", "max(a, 2*phi)", ["mm", "deg"]),
            ("a + b + t + angle", "a + b + t + angle", ["mm", "deg"]),
            ("phi - atan2(a, b)", "phi - atan2(a, b)", ["deg", "rad"]),
            ("atan2(a, inch)", "atan2(a, inch)", ["mm", "in"]),
            ("if(a < phi, 1, 2)", "a < phi", ["mm", "deg"]),
            ("if(t, a, phi)", "if(t, a, phi)", ["mm", "deg"]),
            // The first of several.
            ("hypot(a, phi) + inch", "hypot(a, phi)", ["mm", "deg"]),
        ] {
            assert_eq!(found(text), Some((part.to_owned(), units)), "{text}");
        }
    }

    /// Products may convert, and what has no listed unit fits everything.
    #[test]
    fn sums_that_may_be_meant_are_not() {
        for text in [
            "a + b/2 - 2*abs(-a)",
            "a + 50*phi",
            "a + 25.4*inch",
            "phi*deg + atan(a/b)",
            "a + odd + t + 3",
            "a*sin(phi) + b",
            "a^2 + phi",
            "floor(a) + phi",
        ] {
            assert_eq!(found(text), None, "{text}");
        }
    }
}
