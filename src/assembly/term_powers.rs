//! Powers that the terms of a polynomial have at most.

/// Bounds on the terms of a polynomial: the highest power of every input, and the highest degree of a term with several inputs.
///
/// ```
/// use sensitol::assembly::TermPowers;
/// let [a, b] = [0, 1].map(TermPowers::of_input);
/// // a^4 + a b
/// let sum = a.power(4).unwrap().plus(&a.times(&b).unwrap());
/// assert_eq!((sum.highest(0), sum.highest(1), sum.mixed()), (4, 1, 2));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct TermPowers {
    /// Inputs that occur, ascending, with their highest powers.
    own: Vec<(usize, u32)>,
    mixed: u32,
}

impl TermPowers {
    /// The powers of an input by itself.
    pub fn of_input(input: usize) -> Self {
        Self { own: vec![(input, 1)], mixed: 0 }
    }

    /// The powers of any polynomial of a degree in these inputs.
    pub fn of_degree(degree: u32, inputs: impl IntoIterator<Item = usize>) -> Self {
        if degree == 0 {
            return Self::default();
        }
        let own: Vec<(usize, u32)> = inputs.into_iter().map(|input| (input, degree)).collect();
        let mixed = if degree > 1 && own.len() > 1 { degree } else { 0 };
        Self { own, mixed }
    }

    /// Returns whether no input occurs.
    pub fn is_constant(&self) -> bool {
        self.own.is_empty()
    }

    /// Returns the highest power of an input, in whatever term.
    pub fn highest(&self, input: usize) -> u32 {
        self.own.binary_search_by_key(&input, |&(own, _)| own).map_or(0, |at| self.own[at].1)
    }

    /// Returns the highest degree of a term with several inputs; 0 without any.
    pub fn mixed(&self) -> u32 {
        self.mixed
    }

    /// Returns the degree of the polynomial.
    pub fn degree(&self) -> u32 {
        self.own.iter().map(|&(_, power)| power).fold(self.mixed, u32::max)
    }

    /// Returns the powers of a sum.
    #[must_use]
    pub fn plus(&self, other: &Self) -> Self {
        Self { own: self.merged(other, u32::max), mixed: self.mixed.max(other.mixed) }
    }

    /// Returns the powers of a product; None if they overflow.
    pub fn times(&self, other: &Self) -> Option<Self> {
        // No power of a product is larger than the sum of the degrees.
        let degree = self.degree().checked_add(other.degree())?;
        let beside = |a: &Self, b: &Self| if a.mixed > 0 && !b.is_constant() { a.mixed + b.degree() } else { a.mixed };
        let crossed = self.crossed(other);
        let mixed = beside(self, other).max(beside(other, self)).max(crossed).min(degree);
        Some(Self { own: self.merged(other, |a, b| a.saturating_add(b)), mixed })
    }

    /// Returns the powers of a whole power; None if they overflow.
    pub fn power(&self, exponent: u32) -> Option<Self> {
        let raise = |of: u32| of.checked_mul(exponent);
        if exponent == 0 {
            return Some(Self::default());
        }
        let own = self.own.iter().map(|&(input, power)| Some((input, raise(power)?))).collect::<Option<_>>()?;
        let several = exponent > 1 && self.own.len() > 1;
        let mixed = if several { raise(self.degree())? } else { raise(self.mixed)? };
        Some(Self { own, mixed })
    }

    /// The highest degree of a product of one power of each with different inputs; 0 where there is none.
    fn crossed(&self, other: &Self) -> u32 {
        let two = |of: &Self| -> [(usize, u32); 2] {
            let mut best = [(usize::MAX, 0); 2];
            for &(input, power) in &of.own {
                if power > best[0].1 {
                    best = [(input, power), best[0]];
                } else if power > best[1].1 {
                    best[1] = (input, power);
                }
            }
            best
        };
        let (first, second) = (two(self), two(other));
        let pairs = first.iter().flat_map(|a| second.iter().map(move |b| (a, b)));
        let apart = pairs.filter(|((a, p), (b, q))| a != b && *p > 0 && *q > 0);
        apart.map(|((_, p), (_, q))| p.saturating_add(*q)).max().unwrap_or(0)
    }

    /// The highest powers of either, joined where an input occurs in both.
    fn merged(&self, other: &Self, both: impl Fn(u32, u32) -> u32) -> Vec<(usize, u32)> {
        let mut merged = Vec::with_capacity(self.own.len().max(other.own.len()));
        let (mut left, mut right) = (self.own.iter().peekable(), other.own.iter().peekable());
        loop {
            let (a, b) = (left.peek().copied(), right.peek().copied());
            let (input, power) = match (a, b) {
                (None, None) => return merged,
                (Some(&(i, p)), Some(&(j, q))) if i == j => (i, both(p, q)),
                (Some(&(i, p)), Some(&(j, _))) if i < j => (i, p),
                (Some(&(i, p)), None) => (i, p),
                (_, Some(&(j, q))) => (j, q),
            };
            left.next_if(|(own, _)| *own == input);
            right.next_if(|(own, _)| *own == input);
            merged.push((input, power));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn input(index: usize) -> TermPowers {
        TermPowers::of_input(index)
    }

    #[test]
    fn a_square_of_a_sum_has_products() {
        let square = input(0).plus(&input(3)).power(2).unwrap();
        assert_eq!((square.highest(0), square.highest(3), square.highest(1), square.mixed()), (2, 2, 0, 2));
    }

    #[test]
    fn a_power_of_a_single_input_has_none() {
        let power = input(2).power(4).unwrap().plus(&input(1));
        assert_eq!((power.highest(2), power.mixed(), power.degree()), (4, 0, 4));
        // a (a + 1): no other input.
        let product = input(2).times(&input(2).plus(&TermPowers::default())).unwrap();
        assert_eq!((product.highest(2), product.mixed()), (2, 0));
    }

    #[test]
    fn products_add_degrees() {
        // (a^2 + b)(a b + 1): the highest terms are a^3 b of degree 4.
        let left = input(0).power(2).unwrap().plus(&input(1));
        let right = input(0).times(&input(1)).unwrap();
        let product = left.times(&right).unwrap();
        assert_eq!((product.highest(0), product.highest(1), product.mixed()), (3, 2, 4));
        // a^2 b: a mixed term of degree 3.
        assert_eq!(input(0).power(2).unwrap().times(&input(1)).unwrap().mixed(), 3);
    }

    #[test]
    fn constants_multiply_nothing() {
        let constant = TermPowers::default();
        assert_eq!(input(0).times(&constant), Some(input(0)));
        assert_eq!(constant.power(7), Some(TermPowers::default()));
        assert!(input(0).power(0).unwrap().is_constant());
    }

    #[test]
    fn what_overflows_is_unknown() {
        let large = input(0).power(u32::MAX).unwrap();
        assert_eq!(large.times(&large), None);
        assert_eq!(large.power(2), None);
    }
}
