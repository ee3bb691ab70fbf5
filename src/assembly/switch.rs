//! Where an output changes its form: switches, and how far a point is from each.

use std::ops::Range;

/// The change of an output where the margin of a switch changes its sign.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum SwitchKind {
    /// Two slopes meet: `abs`, `min`, `max`.
    Kink,
    /// Another expression is computed: a comparison. The value is the same on both sides, or it is not.
    Branch,
    /// The value jumps: `floor`, `ceil`, `sign`, the cut of `atan2`.
    Jump,
    /// There is no value beyond: `sqrt`, `ln`, `log10`, a broken power, `asin`, `acos`, a solver that fails.
    Edge,
    /// The value grows without bound on either side: a divisor, `tan`.
    Pole,
}

/// One place of a definition at which an output changes its form.
#[derive(Debug, Clone, PartialEq)]
pub struct Switch {
    /// The change there.
    pub kind: SwitchKind,
    /// The part of the definition that does it, as it is written: `max(a, b)`.
    pub text: String,
    /// The formula that this stands in; None where it is not a formula.
    pub formula: Option<String>,
    /// Where it stands there, in bytes.
    pub span: Range<usize>,
}

/// The switches of an output.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Switches {
    /// Those that are known, in the order of the formulas.
    pub list: Vec<Switch>,
    /// Whether there are no others: a part of the output that is a black box may have any.
    pub complete: bool,
}

impl Switch {
    /// Its name in a report: the text, and the formula where the output has another name.
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
