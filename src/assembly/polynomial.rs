//! Polynomials in the inputs of a formula, term by term. Each coefficient has a bound of its rounding error.
//!
//! Every operation adds its own rounding to those of its operands (running error analysis, Higham 2002, section 3.3). With `u` the spacing
//! of doubles,
//!
//! ```text
//! e(a + b) = e(a) + e(b) + u |a + b|          e(a b) = |a| e(b) + |b| e(a) + e(a) e(b) + u |a b|
//! ```

use std::collections::BTreeMap;

use sensitol_numeric::power::Power;

/// Highest degree that is expanded: surfaces hold powers up to this one.
pub(crate) const DEGREE: usize = 4;
/// Greatest number of terms of a polynomial: all of a quadratic in a thousand inputs.
const TERMS: usize = 1 << 19;
/// Greatest number of products of two terms in one multiplication, a fraction of a second.
const PRODUCTS: usize = 1 << 21;
/// Marker for an unused place of a monomial.
const NONE: u32 = u32::MAX;

/// Inputs of a term in ascending order, each as often as its power. [`NONE`] fills the rest.
type Monomial = [u32; DEGREE];

/// Coefficient with a bound of its rounding error.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Coefficient {
    pub(crate) value: f64,
    pub(crate) error: f64,
}

/// Polynomial of at most the fourth degree.
#[doc(hidden)]
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Polynomial {
    terms: BTreeMap<Monomial, Coefficient>,
}

impl Coefficient {
    fn plus(self, other: Self) -> Self {
        let value = self.value + other.value;
        Self { value, error: self.error + other.error + f64::EPSILON * value.abs() }
    }

    fn times(self, other: Self) -> Self {
        let value = self.value * other.value;
        let [a, b] = [self, other].map(|of| of.value.abs());
        let error = a * other.error + b * self.error + self.error * other.error;
        Self { value, error: error + f64::EPSILON * value.abs() }
    }

    /// Returns the quotient. The relative error of the divisor adds to that of the dividend.
    fn over(self, other: Self) -> Self {
        let value = self.value / other.value;
        let error = (self.error + value.abs() * other.error) / other.value.abs();
        Self { value, error: error + f64::EPSILON * value.abs() }
    }
}

impl Polynomial {
    /// Returns the polynomial of a constant.
    pub(crate) fn constant(value: f64) -> Self {
        Self::of_coefficient(Coefficient { value, error: 0.0 })
    }

    pub(super) fn of_coefficient(of: Coefficient) -> Self {
        Self { terms: BTreeMap::from([([NONE; DEGREE], of)]) }
    }

    /// Returns the input of this index, `centre + scale u`. With the scale 0 it is a constant.
    pub(crate) fn input(index: usize, centre: f64, scale: f64) -> Self {
        let mut polynomial = Self::constant(centre);
        if scale != 0.0 {
            let mut monomial = [NONE; DEGREE];
            monomial[0] = u32::try_from(index).expect("fewer than four billion inputs");
            polynomial.terms.insert(monomial, Coefficient { value: scale, error: 0.0 });
        }
        polynomial
    }

    /// Returns the value of a constant polynomial, or None if it varies.
    pub(super) fn as_constant(&self) -> Option<Coefficient> {
        match self.terms.len() {
            0 => Some(Coefficient::default()),
            1 => self.terms.get(&[NONE; DEGREE]).copied(),
            _ => None,
        }
    }

    /// Iterates over the terms: the inputs, each as often as its power, and the coefficient.
    pub(crate) fn terms(&self) -> impl Iterator<Item = (&[u32], Coefficient)> {
        let inputs = |monomial: &Monomial| monomial.iter().position(|&input| input == NONE).unwrap_or(DEGREE);
        self.terms.iter().map(move |(monomial, &of)| (&monomial[..inputs(monomial)], of))
    }

    /// Returns the sum with `sign` times another. Returns None if it has too many terms.
    pub(super) fn plus(self, other: Self, sign: f64) -> Option<Self> {
        // The smaller polynomial is added to the larger one, so that a long sum takes one step for each term.
        let (mut sum, less, [of_sum, of_less]) = match self.terms.len() >= other.terms.len() {
            true => (self, other, [1.0, sign]),
            false => (other, self, [sign, 1.0]),
        };
        if of_sum < 0.0 {
            sum.terms.values_mut().for_each(|of| of.value = -of.value);
        }
        for (monomial, of) in less.terms {
            sum.add(monomial, Coefficient { value: of_less * of.value, ..of });
        }
        sum.is_small().then_some(sum)
    }

    /// Returns the product. Returns None beyond the highest degree, or if it has too many terms.
    pub(super) fn times(&self, other: &Self) -> Option<Self> {
        if self.terms.len().saturating_mul(other.terms.len()) > PRODUCTS {
            return None;
        }
        let mut product = Self::default();
        for (first, &a) in &self.terms {
            for (second, &b) in &other.terms {
                product.add(merged(first, second)?, a.times(b));
            }
        }
        product.is_small().then_some(product)
    }

    /// Returns every coefficient multiplied by a power of two, without rounding.
    pub(crate) fn times_power(mut self, power: Power) -> Self {
        for of in self.terms.values_mut() {
            (of.value, of.error) = (power.times(of.value), power.times(of.error));
        }
        self
    }

    /// Returns every coefficient divided by a number.
    pub(super) fn over(mut self, divisor: Coefficient) -> Self {
        self.terms.values_mut().for_each(|of| *of = of.over(divisor));
        self
    }

    fn add(&mut self, monomial: Monomial, more: Coefficient) {
        let of = self.terms.entry(monomial).or_insert(Coefficient { value: 0.0, error: 0.0 });
        *of = of.plus(more);
        // A term that cancels to the last bit is removed.
        if of.value == 0.0 && of.error == 0.0 {
            self.terms.remove(&monomial);
        }
    }

    fn is_small(&self) -> bool {
        self.terms.len() <= TERMS
    }
}

/// Merges the inputs of two terms. Returns None beyond the highest degree.
fn merged(first: &Monomial, second: &Monomial) -> Option<Monomial> {
    let mut both = first.iter().chain(second).copied().filter(|&input| input != NONE);
    let mut product = [NONE; DEGREE];
    for place in &mut product {
        let Some(input) = both.next() else { break };
        *place = input;
    }
    // The number of inputs is within the degree, so they are only sorted.
    if both.next().is_some() {
        return None;
    }
    product.sort_unstable();
    Some(product)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn values(of: &Polynomial) -> Vec<(Vec<u32>, f64)> {
        of.terms().map(|(inputs, of)| (inputs.to_vec(), of.value)).collect()
    }

    /// `(1 + 2 u0)(3 + u1) - 3 = 6 u0 + u1 + 2 u0 u1`, by hand.
    #[test]
    fn products_and_sums_by_hand() {
        let (a, b) = (Polynomial::input(0, 1.0, 2.0), Polynomial::input(1, 3.0, 1.0));
        let all = a.times(&b).unwrap().plus(Polynomial::constant(3.0), -1.0).unwrap();
        let terms: Vec<_> = values(&all).into_iter().filter(|(_, value)| *value != 0.0).collect();
        assert_eq!(terms, [(vec![0, 1], 2.0), (vec![0], 6.0), (vec![1], 1.0)]);
    }

    /// A difference keeps its signs if the subtrahend has more terms than the minuend.
    #[test]
    fn a_difference_keeps_its_signs() {
        let many = Polynomial::input(0, 1.0, 2.0).plus(Polynomial::input(1, 0.0, 3.0), 1.0).unwrap();
        let terms = values(&Polynomial::constant(5.0).plus(many, -1.0).unwrap());
        assert_eq!(terms, [(vec![0], -2.0), (vec![1], -3.0), (vec![], 4.0)]);
    }

    #[test]
    fn a_fifth_power_is_not_expanded() {
        let a = Polynomial::input(0, 0.0, 1.0);
        let square = a.times(&a).unwrap();
        let fourth = square.times(&square).unwrap();
        assert_eq!(values(&fourth).last(), Some(&(vec![0; 4], 1.0)));
        assert_eq!(fourth.times(&a), None);
    }

    /// The result of `(1e8 + 0.1)^2 - 1e16 - 2e7` is 0.01, which doubles near 1e16 cannot resolve. The error bound covers it.
    #[test]
    fn the_bound_of_rounding_reaches_a_cancellation() {
        let base = Polynomial::input(0, 1e8 + 0.1, 1.0);
        let rest = base.times(&base).unwrap().plus(Polynomial::constant(1e16 + 2e7), -1.0).unwrap();
        let of = rest.terms().find(|(inputs, _)| inputs.is_empty()).unwrap().1;
        assert!((of.value - 0.01).abs() <= of.error && of.error < 10.0, "{of:?}");
    }
}
