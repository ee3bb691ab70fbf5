//! Exact derivatives: numbers that carry their derivatives along two directions.

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::scalar::{Scalar, Verdict};

/// Value with its first derivatives along two directions `u` and `v`, and the second derivative `D_u D_v`. For `u = v` this is the pure
/// one, for two unit vectors the mixed one. No digits are lost, as they would be in differences.
///
/// A derivative that does not exist is NaN and stays NaN: at the edge of a domain (`sqrt` at 0), at a kink (`abs` at 0, `min` of equals),
/// at a jump (`floor`, the cut of `atan2`), and beyond an infinity. If a value agrees on both sides to the second order, such as both
/// branches of an `if` at its limit, the derivative exists.
///
/// ```
/// use sensitol::assembly::formula::Formula;
/// use sensitol::assembly::formula::jet::Jet;
/// use sensitol::assembly::formula::set::{FormulaSet, Meaning};
/// let formulas = vec![("y".to_owned(), Formula::parse("a^2*b + abs(b - 3)")?)];
/// let names = [("a", Meaning::Variable(0)), ("b", Meaning::Variable(1))];
/// let set = FormulaSet::new(formulas, names).map_err(|(_, error)| error)?;
/// let x = [2.0, 3.0];
/// let along = |u: [f64; 2], v: [f64; 2]| set.jets(&[0], |d| Jet::variable(x[d], [u[d], v[d]]))[0];
/// let (a, b) = ([1.0, 0.0], [0.0, 1.0]);
/// assert_eq!((along(a, a).first(0), along(a, a).second()), (Some(12.0), Some(6.0)));
/// assert_eq!((along(b, b).first(0), along(b, b).second()), (None, None)); // a kink
/// # Ok::<(), sensitol::assembly::formula::FormulaError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jet {
    value: f64,
    /// First derivatives along `u` and along `v`.
    first: [f64; 2],
    /// Second derivative `D_u D_v`.
    second: f64,
    /// True if the value can change along the directions. A constant has no kink.
    moves: bool,
}

/// Relative difference below which the branches of an `if` are equal. It allows for rounding in both.
const MEET: f64 = 1e-12;
/// Smallest number from which all doubles are even (2^53).
const WHOLE: f64 = 9_007_199_254_740_992.0;

impl Jet {
    /// Creates a variable that moves by these amounts along the two directions.
    pub fn variable(value: f64, first: [f64; 2]) -> Self {
        Self { value, first, second: 0.0, moves: first != [0.0; 2] }
    }

    /// Creates a value with known derivatives, such as the solution of an equation.
    pub fn known(value: f64, first: [f64; 2], second: f64) -> Self {
        Self::moving(value, first, second)
    }

    /// Returns the value, which is NaN or infinite if it does not exist.
    pub fn value(&self) -> f64 {
        self.value
    }

    /// Returns the first derivative along the first (0) or second (1) direction, if it exists.
    pub fn first(&self, direction: usize) -> Option<f64> {
        Some(self.first[direction]).filter(|first| self.value.is_finite() && first.is_finite())
    }

    /// Returns the second derivative, once along each direction, if it exists.
    pub fn second(&self) -> Option<f64> {
        Some(self.second).filter(|second| self.value.is_finite() && second.is_finite())
    }

    /// True if the value can change along the directions.
    pub(super) fn moves(&self) -> bool {
        self.moves
    }

    fn moving(value: f64, first: [f64; 2], second: f64) -> Self {
        let known = |derivative: f64| {
            if value.is_finite() && derivative.is_finite() { derivative } else { f64::NAN }
        };
        let first = first.map(known);
        let second = if first.iter().any(|first| first.is_nan()) { f64::NAN } else { known(second) };
        Self { value, first, second, moves: true }
    }

    fn still(value: f64) -> Self {
        Self { value, first: [0.0; 2], second: 0.0, moves: false }
    }

    fn broken(value: f64) -> Self {
        Self { value, first: [f64::NAN; 2], second: f64::NAN, moves: true }
    }

    /// Returns `f(self)` from `f`, `f'` and `f''` at the value.
    fn through(&self, value: f64, slope: f64, curvature: f64) -> Self {
        let [u, v] = self.first;
        Self::moving(value, self.first.map(|first| slope * first), slope * self.second + curvature * u * v)
    }

    fn add(&self, other: &Self, sign: f64, value: f64) -> Self {
        let first = [0, 1].map(|d| self.first[d] + sign * other.first[d]);
        Self::moving(value, first, self.second + sign * other.second)
    }

    fn multiply(&self, other: &Self, value: f64) -> Self {
        let (a, b) = (self, other);
        let first = [0, 1].map(|d| a.first[d] * b.value + a.value * b.first[d]);
        let cross = a.first[0] * b.first[1] + a.first[1] * b.first[0];
        Self::moving(value, first, a.second * b.value + cross + a.value * b.second)
    }

    /// Differentiates `q b = a`, so that no square overflows.
    fn divide(&self, other: &Self, value: f64) -> Self {
        let (a, b) = (self, other);
        let first = [0, 1].map(|d| (a.first[d] - value * b.first[d]) / b.value);
        let cross = first[0] * b.first[1] + first[1] * b.first[0];
        Self::moving(value, first, (a.second - cross - value * b.second) / b.value)
    }

    fn sqrt(&self, value: f64) -> Self {
        let first = self.first.map(|first| 0.5 * first / value);
        Self::moving(value, first, (0.5 * self.second - first[0] * first[1]) / value)
    }

    fn ln(&self, value: f64, scale: f64) -> Self {
        let first = self.first.map(|first| first / self.value);
        let second = (self.second - first[0] * self.first[1]) / self.value;
        Self::moving(value, first.map(|first| scale * first), scale * second)
    }

    fn power(&self, exponent: &Self, value: f64) -> Self {
        let (x, c) = (self.value, exponent.value);
        if !exponent.moves {
            let whole = c == c.trunc();
            // A root has no value on the other side of 0. The sign of the power is unknown for exponents so large that all doubles are
            // even.
            return match c {
                0.0 => Self::still(value),
                1.0 => Self { value, ..*self },
                _ if x == 0.0 && !whole || x < 0.0 && c.abs() >= WHOLE => Self::broken(value),
                2.0 => self.through(value, 2.0 * x, 2.0),
                _ => self.through(value, c * libm::pow(x, c - 1.0), c * (c - 1.0) * libm::pow(x, c - 2.0)),
            };
        }
        if x > 0.0 {
            let logarithm = self.ln(libm::log(x), 1.0);
            let z = exponent.multiply(&logarithm, c * libm::log(x));
            return z.through(value, value, value);
        }
        // 0 to any power above 0 is constant. Any other base that is not positive has no value beside the whole exponents.
        if x == 0.0 && !self.moves && c > 0.0 { Self::still(value) } else { Self::broken(value) }
    }

    fn hypot(&self, other: &Self, value: f64) -> Self {
        let (a, b) = (self, other);
        let (cos, sin) = (a.value / value, b.value / value);
        let across = [0, 1].map(|d| cos * b.first[d] - sin * a.first[d]);
        let second = cos * a.second + sin * b.second + across[0] * (across[1] / value);
        Self::moving(value, [0, 1].map(|d| cos * a.first[d] + sin * b.first[d]), second)
    }

    /// Returns the angle of the point with the ordinate `self`.
    fn atan2(&self, abscissa: &Self, value: f64) -> Self {
        let (y, x) = (self, abscissa);
        if y.value == 0.0 && x.value < 0.0 && y.moves {
            return Self::broken(value); // from pi to -pi
        }
        let radius = libm::hypot(y.value, x.value);
        let (cos, sin) = (x.value / radius, y.value / radius);
        let outward = [0, 1].map(|d| cos * x.first[d] + sin * y.first[d]);
        let first = [0, 1].map(|d| (cos * y.first[d] - sin * x.first[d]) / radius);
        let cross = outward[0] * first[1] + outward[1] * first[0];
        Self::moving(value, first, (cos * y.second - sin * x.second - cross) / radius)
    }

    /// Returns one of two equal values, with the derivatives that both have in common.
    fn tie(&self, other: &Self, value: f64) -> Self {
        if self.first == other.first && self.second == other.second {
            return Self { value, ..*self };
        }
        if self.first == other.first {
            return Self::moving(value, self.first, f64::NAN);
        }
        Self::broken(value)
    }
}

impl Scalar for Jet {
    fn constant(value: f64) -> Self {
        Self::still(value)
    }

    fn unary(function: Unary, a: &Self) -> Self {
        let (x, y) = (a.value, function.apply(a.value));
        if !a.moves {
            return Self::still(y);
        }
        match function {
            Unary::Negate => a.through(y, -1.0, 0.0),
            Unary::Abs if x == 0.0 => a.tie(&Self::unary(Unary::Negate, a), y),
            Unary::Abs => a.through(y, x.signum(), 0.0),
            Unary::Sqrt => a.sqrt(y),
            Unary::Exp => a.through(y, y, y),
            Unary::Ln => a.ln(y, 1.0),
            Unary::Log10 => a.ln(y, std::f64::consts::LOG10_E),
            Unary::Sin => a.through(y, libm::cos(x), -y),
            Unary::Cos => a.through(y, -libm::sin(x), -y),
            Unary::Tan => {
                let slope = 1.0 + y * y;
                a.through(y, slope, 2.0 * y * slope)
            }
            Unary::Asin | Unary::Acos => {
                let sign = if function == Unary::Asin { 1.0 } else { -1.0 };
                let slope = 1.0 / ((1.0 - x) * (1.0 + x)).sqrt();
                a.through(y, sign * slope, sign * x * slope * slope * slope)
            }
            Unary::Atan => {
                let slope = 1.0 / (1.0 + x * x);
                a.through(y, slope, -2.0 * x * slope * slope)
            }
            Unary::Sinh => a.through(y, libm::cosh(x), y),
            Unary::Cosh => a.through(y, libm::sinh(x), y),
            Unary::Tanh => {
                let slope = libm::cosh(x).recip().powi(2);
                a.through(y, slope, -2.0 * y * slope)
            }
            Unary::Floor | Unary::Ceil if x == x.trunc() || y.is_nan() => Self::broken(y),
            Unary::Sign if x == 0.0 || y.is_nan() => Self::broken(y),
            Unary::Floor | Unary::Ceil | Unary::Sign => Self::still(y),
        }
    }

    fn binary(function: Binary, a: &Self, b: &Self) -> Self {
        let y = function.apply(a.value, b.value);
        if !a.moves && !b.moves {
            return Self::still(y);
        }
        let tied = a.value == b.value;
        match function {
            Binary::Add => a.add(b, 1.0, y),
            Binary::Subtract => a.add(b, -1.0, y),
            Binary::Multiply => a.multiply(b, y),
            Binary::Divide => a.divide(b, y),
            Binary::Power => a.power(b, y),
            Binary::Hypot => a.hypot(b, y),
            Binary::Atan2 => a.atan2(b, y),
            _ if y.is_nan() => Self::broken(y),
            Binary::Min | Binary::Max if tied => a.tie(b, y),
            Binary::Min | Binary::Max if y == a.value => *a,
            Binary::Min | Binary::Max => *b,
            // A comparison of equal values that move has another result next to this point.
            _ if tied => Self::broken(y),
            _ => Self::still(y),
        }
    }

    /// Returns the verdict. A condition that may have another result next to this point is open.
    fn verdict(&self) -> Verdict {
        match self.value.verdict() {
            Verdict::Undefined => Verdict::Undefined,
            Verdict::Fails if self.moves => Verdict::Open,
            _ if self.second.is_nan() => Verdict::Open,
            decided => decided,
        }
    }

    /// Returns the branch that is taken here, with the derivatives that it shares with the other one.
    fn join(condition: &Self, then: Self, otherwise: Self) -> Self {
        let (taken, other) = if condition.value != 0.0 { (then, otherwise) } else { (otherwise, then) };
        let meet = |a: f64, b: f64| (a - b).abs() <= MEET * a.abs().max(b.abs());
        if !meet(taken.value, other.value) || !(0..2).all(|d| meet(taken.first[d], other.first[d])) {
            return Self::broken(taken.value);
        }
        let second = if meet(taken.second, other.second) { taken.second } else { f64::NAN };
        Self::moving(taken.value, taken.first, second)
    }
}
