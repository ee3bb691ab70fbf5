//! Powers of two as factors of values of extreme size, so that no power of such a value overflows or underflows.
//!
//! Multiplication by a power of two is exact: a figure computed from multiplied values is the figure itself, multiplied.

/// A power of two, `2^exponent`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Power {
    exponent: i32,
}

/// Greatest binary exponent of a value of ordinary size, and the least one with its sign turned. The standard error of a kurtosis takes
/// eighth powers: that of `2^64` is `2^512`, which leaves sums and long tails as many binary digits again.
const ORDINARY: i32 = 64;

impl Power {
    /// The power `2^0`, which changes nothing.
    pub const ONE: Self = Self { exponent: 0 };

    /// Power of two next below the size of a value: `ONE` for a value of ordinary size, and for 0.
    ///
    /// ```text
    /// 1e-200 -> 2^-665        3.0 -> 2^0        0.0 -> 2^0
    /// ```
    pub fn of(size: f64) -> Self {
        if size == 0.0 || !size.is_finite() {
            return Self::ONE;
        }
        let exponent = libm::ilogb(size);
        if exponent.abs() > ORDINARY { Self { exponent } } else { Self::ONE }
    }

    /// Power of two with this exponent.
    pub fn of_exponent(exponent: i32) -> Self {
        Self { exponent }
    }

    /// Exponent of the power.
    pub fn exponent(self) -> i32 {
        self.exponent
    }

    /// True if the power is `2^0`, which changes nothing.
    pub fn is_one(self) -> bool {
        self.exponent == 0
    }

    /// Inverse of the power.
    pub fn inverse(self) -> Self {
        Self { exponent: -self.exponent }
    }

    /// Product of two powers.
    pub fn and(self, other: Self) -> Self {
        Self { exponent: self.exponent + other.exponent }
    }

    /// Square of the power.
    pub fn squared(self) -> Self {
        self.and(self)
    }

    /// Value times this power. The product is exact unless it is infinite, or so small that it loses digits.
    pub fn times(self, value: f64) -> f64 {
        if self.is_one() { value } else { libm::ldexp(value, self.exponent) }
    }

    /// Finite value times this power. Returns None if the product is too large for a double, or rounds to 0.
    pub fn checked(self, value: f64) -> Option<f64> {
        let product = self.times(value);
        let lost = value.is_finite() && (!product.is_finite() || product == 0.0 && value != 0.0);
        (!lost).then_some(product)
    }
}

/// Number whose exponent has no bounds, for products and quotients of numbers of extreme size. It rounds as a double does.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wide {
    /// Mantissa with a size from 1/2 to 1, or 0, infinite or NaN.
    mantissa: f64,
    exponent: i32,
}

impl Wide {
    /// Converts a double.
    pub fn of(value: f64) -> Self {
        let (mantissa, exponent) = libm::frexp(value);
        if value == 0.0 || !value.is_finite() {
            return Self { mantissa: value, exponent: 0 };
        }
        Self { mantissa, exponent }
    }

    /// Product with another number.
    pub fn times(self, other: f64) -> Self {
        let other = Self::of(other);
        Self::normal(self.mantissa * other.mantissa, self.exponent + other.exponent)
    }

    /// Quotient by another number.
    pub fn over(self, other: f64) -> Self {
        let other = Self::of(other);
        Self::normal(self.mantissa / other.mantissa, self.exponent - other.exponent)
    }

    /// Product with a power of two.
    pub fn times_power(self, power: Power) -> Self {
        Self::normal(self.mantissa, self.exponent + power.exponent)
    }

    /// Absolute value.
    pub fn abs(self) -> Self {
        Self { mantissa: self.mantissa.abs(), ..self }
    }

    /// Nearest double: infinite or 0 if the number is outside the range of doubles.
    pub fn value(self) -> f64 {
        libm::ldexp(self.mantissa, self.exponent)
    }

    /// Nearest double. Returns None if the number is outside the range of doubles.
    pub fn checked(self) -> Option<f64> {
        Power::of_exponent(self.exponent).checked(self.mantissa)
    }

    fn normal(mantissa: f64, exponent: i32) -> Self {
        let Self { mantissa, exponent: more } = Self::of(mantissa);
        Self { mantissa, exponent: exponent + more }
    }
}

/// Conversion of results back into the unit of a characteristic.
#[derive(Debug)]
pub struct Rescaling {
    power: Power,
    /// True if a figure was outside the range of doubles.
    lost: bool,
}

impl Rescaling {
    /// Conversion by this power of two.
    pub fn by(power: Power) -> Self {
        Self { power, lost: false }
    }

    /// True if figures were lost: they are unknown since then.
    pub fn has_lost(&self) -> bool {
        self.lost
    }

    /// Multiplies a figure. Sets it to NaN if a double cannot hold it.
    pub fn multiply(&mut self, figure: &mut f64) {
        *figure = self.product(self.power, *figure);
    }

    /// Divides a figure that is per unit of the characteristic. Sets it to NaN if a double cannot hold it.
    pub fn divide(&mut self, figure: &mut f64) {
        *figure = self.product(self.power.inverse(), *figure);
    }

    fn product(&mut self, power: Power, figure: f64) -> f64 {
        power.checked(figure).unwrap_or_else(|| {
            self.lost = true;
            f64::NAN
        })
    }
}

/// Result with figures in the unit of one characteristic.
pub trait Rescale {
    /// Multiplies every such figure. A figure that a double cannot hold becomes unknown.
    fn rescale(&mut self, by: &mut Rescaling);
}

impl Rescale for f64 {
    fn rescale(&mut self, by: &mut Rescaling) {
        by.multiply(self);
    }
}

impl<T: Rescale + Losable> Rescale for Option<T> {
    fn rescale(&mut self, by: &mut Rescaling) {
        if let Some(value) = self {
            let known = !value.is_unknown();
            value.rescale(by);
            if known && value.is_unknown() {
                *self = None;
            }
        }
    }
}

impl<T: Rescale, const N: usize> Rescale for [T; N] {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.iter_mut().for_each(|one| one.rescale(by));
    }
}

impl<T: Rescale> Rescale for Vec<T> {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.iter_mut().for_each(|one| one.rescale(by));
    }
}

impl<T: Rescale, E> Rescale for Result<T, E> {
    fn rescale(&mut self, by: &mut Rescaling) {
        if let Ok(value) = self {
            value.rescale(by);
        }
    }
}

/// Result that may be lost as a whole.
pub trait Losable {
    /// True if the result is not a number. False for results of several figures, which lose them one by one.
    fn is_unknown(&self) -> bool {
        false
    }
}

impl Losable for f64 {
    fn is_unknown(&self) -> bool {
        self.is_nan()
    }
}

impl<T: Losable, const N: usize> Losable for [T; N] {
    fn is_unknown(&self) -> bool {
        self.iter().any(T::is_unknown)
    }
}

impl<T> Losable for Vec<T> {}

impl<T, E> Losable for Result<T, E> {}

/// Implements [`Rescale`] for a structure. Every field is named once, either as one with figures in the unit or as one without, so that a
/// new field does not compile until it is named.
#[macro_export]
macro_rules! rescale {
    ($type:ty { $($figure:ident),* $(,)? } without { $($other:ident),* $(,)? }) => {
        impl $crate::power::Rescale for $type {
            fn rescale(&mut self, by: &mut $crate::power::Rescaling) {
                let Self { $($figure,)* $($other: _,)* } = self;
                $($crate::power::Rescale::rescale($figure, by);)*
            }
        }
        impl $crate::power::Losable for $type {}
    };
}
pub use rescale;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ordinary_values_have_no_power() {
        for size in [0.0, 1.0, -3.0, 1e-15, 1e18, 6.626e-19, f64::NAN, f64::INFINITY] {
            assert!(Power::of(size).is_one(), "{size}");
        }
    }

    #[test]
    fn a_power_leads_into_the_middle_and_back() {
        for size in [1e-300, 5e-324, -1.7e-200, 6.6e-34, 1.9e30, -1e160, 1.7e308] {
            let power = Power::of(size);
            let middle = power.inverse().times(size);
            assert!((1.0..2.0).contains(&middle.abs()), "{size}: {middle}");
            assert_eq!(power.times(middle), size);
        }
    }

    /// Ordinary numbers give the same bits as doubles. Others keep values that doubles lose on the way.
    #[test]
    fn a_wide_number_rounds_as_a_double() {
        for (a, b) in [(0.1, 3.0), (-7.3e-5, 1.9e4), (2.0f64.sqrt(), 1e-30), (0.0, 2.0)] {
            assert_eq!(Wide::of(a).times(b).value(), a * b);
            assert_eq!(Wide::of(a).over(b).over(b).value(), a / b / b);
        }
        // Powers of two cause no rounding there and back.
        let tiny = 2.0f64.powi(-700);
        let far = Wide::of(3.0).over(tiny).over(tiny);
        assert_eq!((far.checked(), far.times(tiny).times(tiny).abs().checked()), (None, Some(3.0)));
        assert_eq!(Wide::of(f64::INFINITY).over(2.0).value(), f64::INFINITY);
    }

    /// A figure outside the range of doubles becomes unknown, neither infinite nor 0, and the loss is recorded.
    #[test]
    fn a_figure_without_a_place_is_lost() {
        let mut back = Rescaling::by(Power::of(1e200));
        let (mut sigma, mut far, mut density) = (Some(1.5), 1.5e120, 1.5);
        sigma.rescale(&mut back);
        back.divide(&mut density);
        assert!(sigma.is_some_and(|sigma| sigma > 1e199) && density > 0.0 && !back.has_lost());
        far.rescale(&mut back);
        assert!(far.is_nan() && back.has_lost());
        let mut back = Rescaling::by(Power::of(1e-300));
        let mut error = Some(1e-30);
        error.rescale(&mut back);
        assert_eq!((error, back.has_lost()), (None, true));
        // A figure that is 0 stays 0.
        let mut nothing = Some(0.0);
        nothing.rescale(&mut back);
        assert_eq!(nothing, Some(0.0));
    }
}
