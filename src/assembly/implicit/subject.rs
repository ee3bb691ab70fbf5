//! Joints of rigid parts that equations belong to, for failures in the words of the study.

use std::fmt;

/// Joint of rigid parts that an equation belongs to.
#[derive(Debug, Clone, PartialEq)]
pub enum EquationSubject {
    /// A freedom that a joint takes.
    Joint {
        /// Name of the joint.
        name: String,
        /// Freedom in words, such as `offset along x`.
        freedom: String,
        /// True if the freedom is a rotation, whose residual has no unit.
        rotation: bool,
        /// Name and size of the unit in which a failure shows its residual; None if it has none.
        unit: Option<(String, f64)>,
    },
    /// A rod between two points. Its equation is the distance of the points less the length of the rod.
    Rod {
        /// Name of the joint.
        name: String,
        /// Name and size of the unit in which a failure shows lengths; None if it has none.
        unit: Option<(String, f64)>,
    },
}

/// Joint that presses a part against contacts, by the formulas of the conditions.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct PressedJoint {
    /// Name of the joint.
    pub joint: String,
    /// Contacts that carry the force, for each set on which the part can rest.
    pub sets: Vec<Vec<String>>,
    /// Comparisons that choose, as written in the formulas. If the one of index k is true, set k + 1 precedes all sets up to k.
    pub changes: Vec<String>,
}

/// Joint that does not close at a point, with the amount.
#[derive(Debug, Clone, PartialEq)]
pub struct OpenJoint {
    /// The joint.
    pub subject: EquationSubject,
    /// Residual of its equation, which should be 0.
    pub residual: f64,
    /// Distance of the ends of a rod, and its length. None for other joints, or if the equation does not tell.
    pub lengths: Option<[f64; 2]>,
}

impl EquationSubject {
    /// True if the residual of the equation is that of a direction, and not a length.
    pub(super) fn is_direction(&self) -> bool {
        matches!(self, Self::Joint { rotation: true, .. })
    }
}

impl fmt::Display for EquationSubject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Joint { name, freedom, .. } => write!(f, "joint `{name}` ({freedom})"),
            Self::Rod { name, .. } => write!(f, "rod `{name}`"),
        }
    }
}

impl fmt::Display for OpenJoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (EquationSubject::Rod { unit, .. } | EquationSubject::Joint { unit, .. }) = &self.subject;
        let size = unit.as_ref().map_or(1.0, |(_, size)| *size);
        let unit = unit.as_ref().map_or_else(String::new, |(unit, _)| format!(" {unit}"));
        let short = |value: f64| short(value / size);
        let EquationSubject::Rod { name, .. } = &self.subject else {
            return write!(f, "{} is off by {}{unit}", self.subject, short(self.residual));
        };
        let reach = if self.residual > 0.0 { "cannot reach" } else { "is too long" };
        match self.lengths {
            Some([apart, length]) => {
                write!(f, "rod `{name}` ({}{unit}) {reach}: its ends are {}{unit} apart", short(length), short(apart))
            }
            None => {
                let farther = if self.residual > 0.0 { "farther apart" } else { "nearer" };
                write!(f, "rod `{name}` {reach}: its ends are {}{unit} {farther}", short(self.residual.abs()))
            }
        }
    }
}

/// Formats a value with six decimals of its mantissa, which are enough to identify a state.
pub(super) fn short(value: f64) -> String {
    let text = format!("{value:.6e}");
    text.parse::<f64>().map_or(text, |value| value.to_string())
}
