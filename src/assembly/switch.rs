//! Switches of an output, where it changes its form, and the margins of points from them.

use std::ops::Range;

/// Change of an output where the margin of a switch changes its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SwitchKind {
    /// Two slopes meet: `abs`, `min`, `max`.
    Kink,
    /// Another expression is computed after a comparison. The value may be the same on both sides.
    Branch,
    /// The value jumps: `floor`, `ceil`, `sign`, the cut of `atan2`.
    Jump,
    /// The value does not exist beyond: `sqrt`, `ln`, `log10`, a broken power, `asin`, `acos`, a solver that fails.
    Edge,
    /// The value grows without bound on either side: a divisor, `tan`.
    Pole,
    /// A part that is pressed rests on another set of contacts.
    Contact,
    /// Another value is chosen from a stock.
    Choice,
}

/// Sets of contacts on which a pressed part can rest.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ContactSets {
    /// Name of the joint.
    pub joint: String,
    /// Contacts that carry the force, for each set.
    pub sets: Vec<Vec<String>>,
    /// Places in the list of switches. Where the margin of the one of index k is positive, set k + 1 goes before all sets up to k.
    pub switches: Vec<usize>,
}

impl ContactSets {
    /// Returns the index of the set on which the part rests, by the margin of each switch of the output. Returns None at a point without a
    /// state.
    ///
    /// ```
    /// use sensitol::assembly::ContactSets;
    /// let sets = [["a", "b"], ["b", "c"], ["c", "a"]].map(|set| set.map(str::to_owned).to_vec());
    /// let stand = ContactSets { joint: "stand".into(), sets: sets.to_vec(), switches: vec![0, 2] };
    /// assert_eq!(stand.resting(|switch| [0.1, 7.0, -0.2][switch]), Some(1));
    /// assert_eq!(stand.resting(|_| f64::NAN), None);
    /// ```
    pub fn resting(&self, margin: impl Fn(usize) -> f64) -> Option<usize> {
        let margins: Vec<f64> = self.switches.iter().map(|&switch| margin(switch)).collect();
        let last = margins.iter().rposition(|&margin| margin > 0.0).map_or(0, |k| k + 1);
        (!margins.iter().any(|margin| margin.is_nan())).then_some(last)
    }
}

/// Place in a definition at which an output changes its form.
#[derive(Debug, Clone, PartialEq)]
pub struct Switch {
    /// Kind of the change.
    pub kind: SwitchKind,
    /// Part of the definition that causes the change, as it is written: `max(a, b)`.
    pub text: String,
    /// Name of the formula that contains the part; None if it is not in a formula.
    pub formula: Option<String>,
    /// Position of the part in the formula, in bytes.
    pub span: Range<usize>,
}

/// Switches of an output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Switches {
    /// Known switches, in the order of the formulas.
    pub list: Vec<Switch>,
    /// True if there are no others. A part of the output that is a black box may have any.
    pub complete: bool,
    /// Sets of contacts, for each joint that presses a part.
    pub contacts: Vec<ContactSets>,
}

impl Switch {
    /// Returns the name in a report: the text, and the formula if the output has another name.
    ///
    /// ```
    /// use sensitol::assembly::{Switch, SwitchKind};
    /// let text = "max(a, b)".to_owned();
    /// let switch = Switch { kind: SwitchKind::Kink, text, formula: Some("reach".into()), span: 4..13 };
    /// assert_eq!(switch.name("reach"), "`max(a, b)`");
    /// assert_eq!(switch.name("gap"), "`max(a, b)` in `reach`");
    /// ```
    pub fn name(&self, output: &str) -> String {
        match &self.formula {
            Some(formula) if formula != output => format!("`{}` in `{formula}`", self.text),
            Some(_) => format!("`{}`", self.text),
            None => self.text.clone(),
        }
    }
}
