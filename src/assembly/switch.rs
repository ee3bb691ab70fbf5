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
