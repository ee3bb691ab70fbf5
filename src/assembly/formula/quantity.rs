//! Quantity that a part of a formula measures: its unit, its literal factors, and the temperatures in it.

use sensitol_numeric::unit::{SAME, Unit};

/// Greatest number of literal factors of a part that are followed.
const FOLLOWED: usize = 8;
/// Factors and divisors that hide no unit.
const SIMPLE: [f64; 7] = [1.0, 2.0, 3.0, 4.0, 6.0, 8.0, std::f64::consts::PI];

/// Quantity that a part of a formula measures.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Quantity {
    pub(super) unit: Unit,
    /// Literal factors of the part.
    pub(super) factors: Vec<f64>,
    /// True for a number without a unit.
    pub(super) literal: bool,
    /// Number of temperatures on a scale that are added up: 1 of a temperature and of a mean, 2 of a sum, 0 of anything else.
    pub(super) points: f64,
}

impl Quantity {
    pub(super) fn of(unit: Unit) -> Self {
        let points = if unit.point { 1.0 } else { 0.0 };
        Self { unit, factors: Vec::new(), literal: false, points }
    }

    pub(super) fn number(value: f64) -> Self {
        Self { factors: vec![value], literal: true, ..Self::of(Unit::one()) }
    }

    /// Returns the scale of the unit, and the scales that follow if some of the factors are conversions by hand.
    pub(super) fn scales(&self) -> Vec<f64> {
        let mut scales = vec![self.unit.scale];
        for factor in self.factors.iter().filter(|factor| **factor != 0.0) {
            scales.extend(scales.clone().iter().map(|scale| scale / factor));
        }
        scales
    }

    pub(super) fn fits(&self, other: &Self) -> bool {
        let others = other.scales();
        self.unit.same_kind(&other.unit) && self.scales().iter().any(|a| others.iter().any(|b| near(*a, *b)))
    }

    /// Returns a factor that may hide a unit.
    pub(super) fn doubtful(&self) -> Option<f64> {
        let simple = |x: f64| SIMPLE.iter().any(|simple| near(x.abs(), *simple) || near(1.0 / x.abs(), *simple));
        self.factors.iter().copied().find(|&factor| factor != 0.0 && !simple(factor))
    }

    pub(super) fn combined(&self, other: &Self, divides: bool) -> Self {
        let unit = if divides { self.unit.over(&other.unit) } else { self.unit.times(&other.unit) };
        let theirs = other.factors.iter().filter(|factor| **factor != 0.0);
        let theirs = theirs.map(|factor| if divides { 1.0 / factor } else { *factor });
        let factors = self.factors.iter().copied().chain(theirs).take(FOLLOWED).collect();
        Self { unit, factors, literal: self.literal && other.literal, points: 0.0 }
    }

    pub(super) fn power(&self, exponent: f64) -> Self {
        if self.literal {
            return self.clone();
        }
        let factors =
            self.factors.iter().filter(|factor| **factor > 0.0).map(|factor| libm::pow(*factor, exponent)).collect();
        Self { factors, ..Self::of(self.unit.to_the(exponent)) }
    }
}

pub(super) fn near(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.abs().max(b.abs())
}
