//! Certain bounds of an output over a box.

use crate::assembly::formula::Interval;
use sensitol_numeric::power::Power;

/// Bounds of an output over a box, and of its first derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct Bounds {
    /// Interval that holds every value in the box; empty if no point has a value.
    pub value: Interval,
    /// Bounds of the slope along every dimension. They bound the difference of two values only if the value [exists and is
    /// continuous](Interval::is_whole) in the whole box.
    pub slopes: Vec<Interval>,
}

impl Bounds {
    /// Returns the bounds of the output times a power of two.
    pub(crate) fn times(&self, power: Power) -> Self {
        Self { value: self.value.times(power), slopes: self.slopes.iter().map(|slope| slope.times(power)).collect() }
    }

    /// Returns the bounds of the output with its sign changed.
    pub(crate) fn negated(&self) -> Self {
        Self { value: self.value.negate(), slopes: self.slopes.iter().map(Interval::negate).collect() }
    }
}
