//! Interval arithmetic: certain bounds of a formula over a box.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::assembly::formula::functions::{Binary, Unary};
use crate::assembly::formula::scalar::{Scalar, Verdict};
use sensitol_numeric::power::Power;

/// Interval of all values from `lower` to `upper`, both included; NaN for the empty interval.
///
/// The result of an operation encloses its value for every choice of its operands, including rounding. Sums, products, quotients and roots
/// are rounded outward by their exact errors. Values of a mathematical library are widened by four units in the last place, which exceeds
/// the error of every function in use. If an operation has a value for some operands only, the others are left out, like a point without
/// value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Interval {
    lower: f64,
    upper: f64,
    /// True if the operation, and all before it, are defined and continuous for every choice of their operands.
    whole: bool,
}

/// Error in units in the last place that is allowed for a function of `libm`. At 15,000 arguments for each function it was 1.84 at most,
/// for `tanh`.
const LIBRARY: usize = 4;
/// Size of an angle from which its place on the circle is not used any more.
const LOST: f64 = 1e8;
/// Size of a product below which its error is not representable as a double.
const TINY: f64 = 1e-280;

impl Interval {
    /// Creates the interval from one number to another.
    ///
    /// ```
    /// use sensitol::assembly::formula::interval::Interval;
    /// let band = Interval::between(-0.1, 0.3);
    /// assert_eq!((band.lower(), band.upper(), band.is_whole()), (-0.1, 0.3, true));
    /// ```
    pub fn between(lower: f64, upper: f64) -> Self {
        Self { lower, upper, whole: true }
    }

    fn point(value: f64) -> Self {
        match value {
            _ if value.is_nan() => Self::EMPTY,
            // An operation on an infinity depends on the origin of the infinity.
            _ if value.is_infinite() => Self::EVERYTHING,
            _ => Self::between(value, value),
        }
    }

    const EMPTY: Self = Self { lower: f64::NAN, upper: f64::NAN, whole: false };
    /// Interval of all numbers, with breaks.
    pub(super) const EVERYTHING: Self = Self { lower: f64::NEG_INFINITY, upper: f64::INFINITY, whole: false };

    /// Returns the least value.
    pub fn lower(&self) -> f64 {
        self.lower
    }

    /// Returns the greatest value.
    pub fn upper(&self) -> f64 {
        self.upper
    }

    /// True if the interval is empty.
    pub fn is_empty(&self) -> bool {
        self.lower.is_nan()
    }

    /// True if the value exists and is continuous for every choice of the operands that led to it.
    pub fn is_whole(&self) -> bool {
        self.whole
    }

    pub(super) fn contains(&self, value: f64) -> bool {
        self.lower <= value && value <= self.upper
    }

    fn is_point(&self) -> bool {
        self.lower == self.upper
    }

    /// Returns the same values, marked as not continuous.
    pub(crate) fn broken(self) -> Self {
        Self { whole: false, ..self }
    }

    /// Returns the interval, marked as not whole if an operand is not whole or an end is infinite.
    fn after(self, operands: &[&Self]) -> Self {
        let finite = self.lower.is_finite() && self.upper.is_finite();
        Self { whole: self.whole && finite && operands.iter().all(|operand| operand.whole), ..self }
    }

    /// Returns the smallest interval that contains both.
    pub(crate) fn hull(&self, other: &Self) -> Self {
        // `min` and `max` ignore NaN.
        let (lower, upper) = (self.lower.min(other.lower), self.upper.max(other.upper));
        Self { lower, upper, whole: self.whole && other.whole }
    }

    /// Returns the intersection with the interval from `lower` to `upper`.
    pub(crate) fn within(&self, lower: f64, upper: f64) -> Self {
        if self.is_empty() || self.lower > upper || self.upper < lower {
            return Self::EMPTY;
        }
        let whole = self.whole && lower <= self.lower && self.upper <= upper;
        Self { lower: self.lower.max(lower), upper: self.upper.min(upper), whole }
    }

    /// Applies an increasing function of a library.
    fn rising(&self, function: impl Fn(f64) -> f64) -> Self {
        Self { lower: down(function(self.lower)), upper: up(function(self.upper)), whole: true }.after(&[self])
    }

    /// Multiplies by a power of two. The result is exact, except for a step outward if an end loses digits among the least doubles, or
    /// exceeds the greatest.
    pub(crate) fn times(&self, power: Power) -> Self {
        let end = |end: f64, outwards: fn(f64) -> f64| match power.times(end) {
            product if power.inverse().times(product) == end => product,
            product => outwards(product),
        };
        Self { lower: end(self.lower, f64::next_down), upper: end(self.upper, f64::next_up), whole: self.whole }
    }

    pub(crate) fn negate(&self) -> Self {
        Self { lower: -self.upper, upper: -self.lower, whole: self.whole }
    }

    pub(crate) fn add(&self, other: &Self) -> Self {
        Self { lower: sum_down(self.lower, other.lower), upper: -sum_down(-self.upper, -other.upper), whole: true }
            .after(&[self, other])
    }

    pub(crate) fn subtract(&self, other: &Self) -> Self {
        self.add(&other.negate())
    }

    pub(crate) fn multiply(&self, other: &Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        let ends = [
            (self.lower, other.lower),
            (self.lower, other.upper),
            (self.upper, other.lower),
            (self.upper, other.upper),
        ];
        let lower = ends.iter().map(|&(a, b)| product_down(a, b)).fold(f64::INFINITY, f64::min);
        let upper = ends.iter().map(|&(a, b)| -product_down(-a, b)).fold(f64::NEG_INFINITY, f64::max);
        Self { lower, upper, whole: true }.after(&[self, other])
    }

    pub(super) fn divide(&self, other: &Self) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        if other.contains(0.0) {
            // The quotient is an infinity of either sign, because 0 has two signs.
            return Self::EVERYTHING;
        }
        let ends = [
            (self.lower, other.lower),
            (self.lower, other.upper),
            (self.upper, other.lower),
            (self.upper, other.upper),
        ];
        let lower = ends.iter().map(|&(a, b)| quotient_down(a, b)).fold(f64::INFINITY, f64::min);
        let upper = ends.iter().map(|&(a, b)| -quotient_down(-a, b)).fold(f64::NEG_INFINITY, f64::max);
        Self { lower, upper, whole: true }.after(&[self, other])
    }

    /// Returns `1/x` for `x` above 0. The lower end may be 0 itself.
    pub(super) fn reciprocal(&self) -> Self {
        let upper = if self.lower > 0.0 { -quotient_down(-1.0, self.lower) } else { f64::INFINITY };
        let lower = if self.upper > 0.0 { quotient_down(1.0, self.upper) } else { 0.0 };
        Self { lower, upper, whole: self.whole }
    }

    pub(super) fn abs(&self) -> Self {
        match self {
            _ if self.lower >= 0.0 => *self,
            _ if self.upper <= 0.0 => self.negate(),
            _ if self.is_empty() => Self::EMPTY,
            _ => Self { lower: 0.0, upper: self.upper.max(-self.lower), whole: self.whole },
        }
    }

    pub(crate) fn squared(&self) -> Self {
        let size = self.abs();
        size.multiply(&size)
    }

    pub(crate) fn sqrt(&self) -> Self {
        let x = self.within(0.0, f64::INFINITY);
        // The root of the upper end is rounded up if its square is too small.
        let upper = x.upper.sqrt();
        let short = upper.mul_add(upper, -x.upper) < 0.0 || x.upper < TINY && x.upper > 0.0;
        let upper = if upper.is_finite() && short { upper.next_up() } else { upper };
        Self { lower: root_down(x.lower), upper, whole: x.whole }
    }

    /// Returns the interval of `cos`, which is 1 at whole turns.
    pub(super) fn cos(&self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        if !(self.lower.abs() < LOST && self.upper.abs() < LOST) || self.upper - self.lower >= TAU {
            return Self { lower: -1.0, upper: 1.0, whole: self.whole && self.upper - self.lower < f64::INFINITY };
        }
        let [a, b] = [self.lower, self.upper].map(libm::cos);
        let upper = if self.passes(0.0, TAU) { 1.0 } else { up(a.max(b)).min(1.0) };
        let lower = if self.passes(PI, TAU) { -1.0 } else { down(a.min(b)).max(-1.0) };
        Self { lower, upper, whole: self.whole }
    }

    pub(super) fn sin(&self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        if !(self.lower.abs() < LOST && self.upper.abs() < LOST) || self.upper - self.lower >= TAU {
            return Self { lower: -1.0, upper: 1.0, whole: self.whole && self.upper - self.lower < f64::INFINITY };
        }
        let [a, b] = [self.lower, self.upper].map(libm::sin);
        let upper = if self.passes(FRAC_PI_2, TAU) { 1.0 } else { up(a.max(b)).min(1.0) };
        let lower = if self.passes(-FRAC_PI_2, TAU) { -1.0 } else { down(a.min(b)).max(-1.0) };
        Self { lower, upper, whole: self.whole }
    }

    pub(super) fn tan(&self) -> Self {
        if self.is_empty() {
            return Self::EMPTY;
        }
        let lost = !(self.lower.abs() < LOST && self.upper.abs() < LOST) || self.upper - self.lower >= PI;
        if lost || self.passes(FRAC_PI_2, PI) {
            return Self::EVERYTHING;
        }
        self.rising(libm::tan)
    }

    /// True if the interval contains `place` plus a whole number of periods, or may contain it within rounding.
    fn passes(&self, place: f64, period: f64) -> bool {
        let turns = |x: f64| (x - place) / period;
        let [from, to] = [self.lower, self.upper].map(turns);
        let rounding = 8.0 * f64::EPSILON * (1.0 + from.abs().max(to.abs()));
        (to + rounding).floor() >= (from - rounding).ceil()
    }

    fn power(&self, exponent: &Self) -> Self {
        if self.is_empty() || exponent.is_empty() {
            return Self::EMPTY;
        }
        let n = exponent.lower;
        if exponent.is_point() && n.is_finite() && n == n.trunc() {
            return self.whole_power(n).after(&[self, exponent]);
        }
        // Whole exponents within the interval have values for negative bases too. An infinite base is not bounded here.
        if self.lower == f64::NEG_INFINITY || self.lower < 0.0 && !(exponent.is_point() && n.is_finite()) {
            return Self::EVERYTHING;
        }
        let x = self.within(0.0, f64::INFINITY);
        if x.is_empty() {
            return Self::EMPTY;
        }
        // The power is monotonic in both arguments if the base is above 0.
        let ends = [
            (x.lower, exponent.lower),
            (x.lower, exponent.upper),
            (x.upper, exponent.lower),
            (x.upper, exponent.upper),
        ];
        let values = ends.map(|(x, y)| libm::pow(x, y));
        let one =
            if x.contains(1.0) || exponent.contains(0.0) { [1.0, 1.0] } else { [f64::INFINITY, f64::NEG_INFINITY] };
        let lower = values.iter().fold(one[0], |least, value| least.min(*value));
        let upper = values.iter().fold(one[1], |most, value| most.max(*value));
        // 0 to a power that is not above 0 is infinite or a jump.
        let whole = x.whole && (x.lower > 0.0 || exponent.lower > 0.0);
        Self { lower: down(lower).max(0.0), upper: up(not_lost(upper, x.upper)), whole }.after(&[exponent])
    }

    fn whole_power(&self, n: f64) -> Self {
        if n == 0.0 {
            return Self { lower: 1.0, upper: 1.0, whole: self.whole };
        }
        if n < 0.0 {
            return Self::point(1.0).divide(&self.whole_power(-n));
        }
        if n == 1.0 {
            return *self;
        }
        if n == 2.0 {
            return self.squared();
        }
        if n % 2.0 == 0.0 {
            let size = self.abs();
            let upper = not_lost(libm::pow(size.upper, n), size.upper);
            return Self { lower: down(libm::pow(size.lower, n)).max(0.0), upper: up(upper), whole: true }
                .after(&[self]);
        }
        self.rising(|x| not_lost(libm::pow(x, n), x))
    }

    fn atan2(&self, abscissa: &Self) -> Self {
        let (y, x) = (self, abscissa);
        if y.is_empty() || x.is_empty() {
            return Self::EMPTY;
        }
        if y.contains(0.0) && x.lower <= 0.0 {
            // The interval includes the cut, or the origin.
            return Self::between(down(-PI), up(PI)).broken();
        }
        let ends = [(y.lower, x.lower), (y.lower, x.upper), (y.upper, x.lower), (y.upper, x.upper)];
        let angles = ends.map(|(y, x)| libm::atan2(y, x));
        let lower = angles.iter().fold(f64::INFINITY, |least, angle| least.min(*angle));
        let upper = angles.iter().fold(f64::NEG_INFINITY, |most, angle| most.max(*angle));
        Self { lower: down(lower), upper: up(upper), whole: true }.after(&[y, x])
    }

    pub(super) fn hypot(&self, other: &Self) -> Self {
        let (a, b) = (self.abs(), other.abs());
        if a.is_empty() || b.is_empty() {
            return Self::EMPTY;
        }
        Self {
            lower: down(libm::hypot(a.lower, b.lower)).max(0.0),
            upper: up(libm::hypot(a.upper, b.upper)),
            whole: true,
        }
        .after(&[self, other])
    }

    /// Returns 1 if a comparison is certainly true, 0 if it is certainly false, and both otherwise.
    fn truth(&self, other: &Self, always: bool, never: bool) -> Self {
        if self.is_empty() || other.is_empty() {
            return Self::EMPTY;
        }
        match (always, never) {
            (true, _) => Self::point(1.0),
            (_, true) => Self::point(0.0),
            _ => Self::between(0.0, 1.0).broken(),
        }
        .after(&[self, other])
    }
}

impl Scalar for Interval {
    fn constant(value: f64) -> Self {
        Self::point(value)
    }

    fn unary(function: Unary, a: &Self) -> Self {
        let x = *a;
        let steps = |step: fn(f64) -> f64| {
            let (lower, upper) = (step(x.lower), step(x.upper));
            Self { lower, upper, whole: x.whole && lower == upper }
        };
        match function {
            Unary::Negate => x.negate(),
            Unary::Abs => x.abs(),
            Unary::Sqrt => x.sqrt(),
            Unary::Exp => {
                let Self { lower, upper, whole } = x.rising(|x| not_lost(libm::exp(x), 1.0));
                Self { lower: lower.max(0.0), upper, whole }.or_empty(&x)
            }
            Unary::Ln | Unary::Log10 => {
                let log = if function == Unary::Ln { libm::log } else { libm::log10 };
                // The logarithm of 0 is an infinity, which later operations may use.
                Self { whole: x.whole && x.lower > 0.0, ..x.within(0.0, f64::INFINITY).rising(log) }
            }
            Unary::Sin => x.sin(),
            Unary::Cos => x.cos(),
            Unary::Tan => x.tan(),
            Unary::Asin => x.within(-1.0, 1.0).rising(libm::asin),
            Unary::Acos => x.within(-1.0, 1.0).negate().rising(|x| libm::acos(-x)),
            Unary::Atan => x.rising(libm::atan),
            Unary::Sinh => x.rising(libm::sinh),
            Unary::Cosh => {
                let size = x.abs();
                Self { lower: down(libm::cosh(size.lower)).max(1.0), ..size.rising(libm::cosh) }.or_empty(&x)
            }
            Unary::Tanh => {
                let Self { lower, upper, whole } = x.rising(libm::tanh);
                Self { lower: lower.max(-1.0), upper: upper.min(1.0), whole }.or_empty(&x)
            }
            Unary::Floor => steps(f64::floor),
            Unary::Ceil => steps(f64::ceil),
            Unary::Sign => steps(|x| Unary::Sign.apply(x)),
        }
    }

    fn binary(function: Binary, a: &Self, b: &Self) -> Self {
        match function {
            Binary::Add => a.add(b),
            Binary::Subtract => a.subtract(b),
            Binary::Multiply => a.multiply(b),
            Binary::Divide => a.divide(b),
            Binary::Power => a.power(b),
            Binary::Atan2 => a.atan2(b),
            Binary::Hypot => a.hypot(b),
            Binary::Less => a.truth(b, a.upper < b.lower, a.lower >= b.upper),
            Binary::LessEqual => a.truth(b, a.upper <= b.lower, a.lower > b.upper),
            Binary::Greater => a.truth(b, a.lower > b.upper, a.upper <= b.lower),
            Binary::GreaterEqual => a.truth(b, a.lower >= b.upper, a.upper < b.lower),
            Binary::Equal => a.truth(b, a.is_point() && a.lower == b.lower && b.is_point(), apart(a, b)),
            Binary::NotEqual => a.truth(b, apart(a, b), a.is_point() && a.lower == b.lower && b.is_point()),
            Binary::Min | Binary::Max if a.is_empty() || b.is_empty() => Self::EMPTY,
            Binary::Min => {
                Self { lower: a.lower.min(b.lower), upper: a.upper.min(b.upper), whole: true }.after(&[a, b])
            }
            Binary::Max => {
                Self { lower: a.lower.max(b.lower), upper: a.upper.max(b.upper), whole: true }.after(&[a, b])
            }
        }
    }

    fn square(a: &Self) -> Self {
        a.squared()
    }

    fn verdict(&self) -> Verdict {
        match self {
            _ if self.is_empty() => Verdict::Undefined,
            _ if !self.whole => Verdict::Open,
            _ if !self.contains(0.0) => Verdict::Holds,
            _ if self.is_point() => Verdict::Fails,
            _ => Verdict::Open,
        }
    }

    fn join(_: &Self, then: Self, otherwise: Self) -> Self {
        then.hull(&otherwise).broken()
    }
}

impl Interval {
    /// Returns the empty interval for an empty operand, because `max` and `min` ignore NaN.
    fn or_empty(self, operand: &Self) -> Self {
        if operand.is_empty() { Self::EMPTY } else { self }
    }
}

fn apart(a: &Interval, b: &Interval) -> bool {
    a.upper < b.lower || b.upper < a.lower
}

/// Widens a library's value downward. The value 0 is exact, because no other argument gives it.
fn down(value: f64) -> f64 {
    if value == 0.0 { value } else { (0..LIBRARY).fold(value, |value, _| value.next_down()) }
}

/// Restores the sign of `like` in a value that underflowed to 0.
fn not_lost(value: f64, like: f64) -> f64 {
    if value == 0.0 && like != 0.0 { f64::from_bits(1).copysign(like) } else { value }
}

fn up(value: f64) -> f64 {
    -down(-value)
}

/// Returns the greatest double that is not above `a + b`.
fn sum_down(a: f64, b: f64) -> f64 {
    let sum = a + b;
    if sum.is_nan() && !a.is_nan() && !b.is_nan() {
        return f64::NEG_INFINITY;
    }
    if !sum.is_finite() {
        // Infinite operands are exact. A finite sum that overflows upward is at least the greatest double.
        return if a.is_finite() && b.is_finite() && sum > 0.0 { f64::MAX } else { sum };
    }
    // Knuth's two-sum gives the exact error of the addition.
    let of_b = sum - a;
    let error = (a - (sum - of_b)) + (b - of_b);
    if error < 0.0 || error.is_nan() { sum.next_down() } else { sum }
}

/// Returns the greatest double that is not above `a b`, or one less. 0 times an infinite end is 0.
fn product_down(a: f64, b: f64) -> f64 {
    if a == 0.0 || b == 0.0 {
        return 0.0;
    }
    let product = a * b;
    if !product.is_finite() {
        return if a.is_finite() && b.is_finite() && product > 0.0 { f64::MAX } else { product };
    }
    if product.abs() < TINY || a.mul_add(b, -product) < 0.0 { product.next_down() } else { product }
}

/// Returns the greatest double that is not above `a / b`, or one less, for `b` other than 0.
fn quotient_down(a: f64, b: f64) -> f64 {
    if a == 0.0 {
        return 0.0;
    }
    if b.is_infinite() {
        return if a.is_infinite() { f64::NEG_INFINITY } else { -f64::from_bits(1) };
    }
    let quotient = a / b;
    if !quotient.is_finite() {
        return if a.is_finite() && quotient > 0.0 { f64::MAX } else { quotient };
    }
    // The sign of a - q b is that of b times that of the error.
    let rest = quotient.mul_add(-b, a);
    let below = if b > 0.0 { rest < 0.0 } else { rest > 0.0 };
    if below || quotient.abs() < TINY || a.abs() < TINY { quotient.next_down() } else { quotient }
}

fn root_down(x: f64) -> f64 {
    let root = x.sqrt();
    if root.is_finite() && (root.mul_add(root, -x) > 0.0 || x < TINY && x > 0.0) { root.next_down() } else { root }
}
