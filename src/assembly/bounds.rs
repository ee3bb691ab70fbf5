//! Certain bounds of an output over a box.

use super::formula::Interval;
use sensitol_numeric::power::Power;

/// An enclosure of an output over a box, and of its first derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// No point of the box has a value outside; empty where none has a value.
    pub value: Interval,
    /// For every dimension its slope. Only where the value [exists and is continuous](Interval::is_whole) in the whole box do
    /// they bound how far apart two values can be.
    pub slopes: Vec<Interval>,
}

impl Bounds {
    /// Of the output times a power of two.
    pub(crate) fn times(&self, power: Power) -> Self {
        Self { value: self.value.times(power), slopes: self.slopes.iter().map(|slope| slope.times(power)).collect() }
    }

    /// Of the output with its sign changed.
    pub(crate) fn negated(&self) -> Self {
        Self { value: self.value.negate(), slopes: self.slopes.iter().map(Interval::negate).collect() }
    }
}
