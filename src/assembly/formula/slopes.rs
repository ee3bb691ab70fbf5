//! Intervals with bounds of their slopes, which decide on which side of a box a formula is least.

use std::cmp::Ordering;

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::interval::Interval;
use crate::assembly::formula::scalar::{Scalar, Verdict};

/// Value over a box with its slope along each dimension that it depends on.
///
/// If the value is [whole](Interval::is_whole), the mean value theorem holds with these slopes. At a kink they enclose the slopes of both
/// sides. All other slopes are 0.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Sloped {
    pub(super) value: Interval,
    /// Slopes as (dimension, slope), ascending; empty for a value that does not depend on any dimension.
    pub(super) slopes: Vec<(usize, Interval)>,
}

impl Sloped {
    /// Returns a dimension.
    pub(super) fn variable(value: Interval, dimension: usize) -> Self {
        Self { value, slopes: vec![(dimension, Interval::constant(1.0))] }
    }

    /// Returns a value that does not depend on any dimension.
    pub(super) fn still(value: Interval) -> Self {
        Self { value, slopes: Vec::new() }
    }

    /// Returns `f(self)` from `f` and `f'`.
    fn through(&self, value: Interval, slope: Interval) -> Self {
        Self { value, slopes: self.slopes.iter().map(|(d, own)| (*d, certain(slope.multiply(own)))).collect() }
    }

    /// Combines the slopes of two values, with 0 for a value that does not depend on a dimension.
    fn from(value: Interval, a: &Self, b: &Self, slope: impl Fn(&Interval, &Interval) -> Interval) -> Self {
        let zero = Interval::constant(0.0);
        let mut slopes = Vec::with_capacity(a.slopes.len() + b.slopes.len());
        let mut add = |d: usize, of_a: &Interval, of_b: &Interval| slopes.push((d, certain(slope(of_a, of_b))));
        let (mut left, mut right) = (&a.slopes[..], &b.slopes[..]);
        while let ([(d, of_a), after_left @ ..], [(e, of_b), after_right @ ..]) = (left, right) {
            match d.cmp(e) {
                Ordering::Less => {
                    add(*d, of_a, &zero);
                    left = after_left;
                }
                Ordering::Greater => {
                    add(*e, &zero, of_b);
                    right = after_right;
                }
                Ordering::Equal => {
                    add(*d, of_a, of_b);
                    (left, right) = (after_left, after_right);
                }
            }
        }
        left.iter().for_each(|(d, of_a)| add(*d, of_a, &zero));
        right.iter().for_each(|(d, of_b)| add(*d, &zero, of_b));
        Self { value, slopes }
    }

    /// Returns `a + b`. A slope along a dimension that only one of them depends on is copied, because sums of many terms have many slopes.
    fn sum(value: Interval, a: &Self, b: &Self) -> Self {
        match a.ends_before(b) {
            true => Self { value, slopes: [&a.slopes[..], &b.slopes[..]].concat() },
            false => Self::from(value, a, b, Interval::add),
        }
    }

    /// Returns `a - b`, with copied slopes as in a sum.
    fn difference(value: Interval, a: &Self, b: &Self) -> Self {
        if !a.ends_before(b) {
            return Self::from(value, a, b, Interval::subtract);
        }
        let zero = Interval::constant(0.0);
        let mut slopes = Vec::with_capacity(a.slopes.len() + b.slopes.len());
        slopes.extend_from_slice(&a.slopes);
        slopes.extend(b.slopes.iter().map(|(d, slope)| (*d, zero.subtract(slope))));
        Self { value, slopes }
    }

    /// True if all dimensions of `self` come before those of `other`.
    fn ends_before(&self, other: &Self) -> bool {
        match (self.slopes.last(), other.slopes.first()) {
            (Some((last, _)), Some((first, _))) => last < first,
            _ => true,
        }
    }

    /// Returns a value whose slopes along the dimensions that an operand depends on are unknown.
    fn unknown(value: Interval, operands: &[&Self]) -> Self {
        let mut slopes: Vec<(usize, Interval)> =
            operands.iter().flat_map(|operand| &operand.slopes).map(|(d, _)| (*d, Interval::EVERYTHING)).collect();
        slopes.sort_unstable_by_key(|(d, _)| *d);
        slopes.dedup_by_key(|(d, _)| *d);
        Self { value, slopes }
    }

    fn power(&self, exponent: &Self, value: Interval) -> Self {
        let (x, c) = (&self.value, &exponent.value);
        if exponent.slopes.is_empty() {
            let less = c.subtract(&Interval::constant(1.0));
            return self.through(value, c.multiply(&Interval::binary(Binary::Power, x, &less)));
        }
        if x.lower() > 0.0 {
            let logarithm = Interval::unary(Unary::Ln, x);
            return Self::from(value, self, exponent, |of_x, of_c| {
                value.multiply(&of_c.multiply(&logarithm).add(&c.multiply(of_x).divide(x)))
            });
        }
        Self::unknown(value, &[self, exponent])
    }
}

/// Replaces an empty slope, which is no bound, by an unbounded one.
fn certain(slope: Interval) -> Interval {
    if slope.is_empty() { Interval::EVERYTHING } else { slope }
}

impl Scalar for Sloped {
    fn constant(value: f64) -> Self {
        Self::still(Interval::constant(value))
    }

    fn unary(function: Unary, a: &Self) -> Self {
        let (x, y) = (a.value, Interval::unary(function, &a.value));
        if a.slopes.is_empty() {
            return Self::still(y);
        }
        let one = Interval::constant(1.0);
        let slope = match function {
            Unary::Negate => Interval::constant(-1.0),
            Unary::Abs if x.lower() >= 0.0 => one,
            Unary::Abs if x.upper() <= 0.0 => Interval::constant(-1.0),
            Unary::Abs => Interval::between(-1.0, 1.0),
            Unary::Sqrt => Interval::constant(0.5).multiply(&y.reciprocal()),
            Unary::Exp => y,
            Unary::Ln => positive(&x).reciprocal(),
            Unary::Log10 => {
                let e = std::f64::consts::LOG10_E;
                Interval::between(e.next_down(), e.next_up()).multiply(&positive(&x).reciprocal())
            }
            Unary::Sin => x.cos(),
            Unary::Cos => Interval::unary(Unary::Negate, &x.sin()),
            Unary::Tan => one.add(&y.squared()),
            Unary::Asin | Unary::Acos => {
                let inverse = one.subtract(&x).multiply(&one.add(&x)).sqrt().reciprocal();
                if function == Unary::Asin { inverse } else { Interval::unary(Unary::Negate, &inverse) }
            }
            Unary::Atan => one.divide(&one.add(&x.squared())),
            Unary::Sinh => Interval::unary(Unary::Cosh, &x),
            Unary::Cosh => Interval::unary(Unary::Sinh, &x),
            Unary::Tanh => one.subtract(&y.squared()),
            Unary::Floor | Unary::Ceil | Unary::Sign if y.lower() == y.upper() => return Self::still(y),
            Unary::Floor | Unary::Ceil | Unary::Sign => Interval::EVERYTHING,
        };
        a.through(y, slope)
    }

    fn binary(function: Binary, a: &Self, b: &Self) -> Self {
        let y = Interval::binary(function, &a.value, &b.value);
        match function {
            _ if a.slopes.is_empty() && b.slopes.is_empty() => Self::still(y),
            Binary::Add => Self::sum(y, a, b),
            Binary::Subtract => Self::difference(y, a, b),
            Binary::Multiply => Self::from(y, a, b, |of_a, of_b| of_a.multiply(&b.value).add(&a.value.multiply(of_b))),
            // The slope follows from q b = a.
            Binary::Divide => Self::from(y, a, b, |of_a, of_b| of_a.subtract(&y.multiply(of_b)).divide(&b.value)),
            Binary::Power => a.power(b, y),
            Binary::Hypot => {
                let [cos, sin] = [&a.value, &b.value].map(|side| direction(side, &y));
                Self::from(y, a, b, |of_a, of_b| cos.multiply(of_a).add(&sin.multiply(of_b)))
            }
            Binary::Atan2 => {
                let square = a.value.squared().add(&b.value.squared());
                Self::from(y, a, b, |of_a, of_b| {
                    b.value.multiply(of_a).subtract(&a.value.multiply(of_b)).divide(&square)
                })
            }
            Binary::Min if a.value.upper() < b.value.lower() => Self { value: y, ..a.clone() },
            Binary::Min if b.value.upper() < a.value.lower() => Self { value: y, ..b.clone() },
            Binary::Max if a.value.lower() > b.value.upper() => Self { value: y, ..a.clone() },
            Binary::Max if b.value.lower() > a.value.upper() => Self { value: y, ..b.clone() },
            Binary::Min | Binary::Max => Self::from(y, a, b, Interval::hull),
            // A comparison with a certain result is constant.
            _ if y.lower() == y.upper() => Self::still(y),
            _ => Self::unknown(y, &[a, b]),
        }
    }

    fn square(a: &Self) -> Self {
        a.through(a.value.squared(), Interval::constant(2.0).multiply(&a.value))
    }

    fn verdict(&self) -> Verdict {
        self.value.verdict()
    }

    fn join(condition: &Self, then: Self, otherwise: Self) -> Self {
        let value = Interval::join(&condition.value, then.value, otherwise.value);
        Self::unknown(value, &[condition, &then, &otherwise])
    }
}

/// Returns the part of an interval that is not negative.
fn positive(x: &Interval) -> Interval {
    Interval::between(x.lower().max(0.0), x.upper().max(0.0))
}

/// Returns `side / length`, a sine or cosine.
fn direction(side: &Interval, length: &Interval) -> Interval {
    let ratio = side.divide(length);
    let (lower, upper) = (ratio.lower().max(-1.0), ratio.upper().min(1.0));
    if lower <= upper { Interval::between(lower, upper) } else { Interval::between(-1.0, 1.0) }
}
