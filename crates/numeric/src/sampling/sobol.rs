//! Sobol' sequence with nested uniform scrambling.

use crate::elementary::{Work, on_this_processor};
use crate::sampling::joe_kuo::{SOBOL_DIMENSIONS, Start};

/// Binary digits of a coordinate, and of the index of a point.
const DIGITS: u32 = 52;
/// Digits that are scrambled one by one. The digits below share one hash, which makes no difference before the 2^42nd point.
const NESTED: u32 = 42;
/// Digits that take their random bits from one hash. A tree of six levels has 63 nodes.
const GROUP: u32 = 6;

/// Direction numbers of one dimension, with digits from the top of the word down.
type Directions = [u64; DIGITS as usize];

/// Sequence of points in the unit cube. Every aligned block of 2^m points is spread more evenly than random points.
///
/// Point `i` has the coordinates `v_1 i_1 xor v_2 i_2 xor ...`, with the binary digits of `i` and the direction numbers of Joe and Kuo
/// (2008), whose two-dimensional projections are good. Owen's nested uniform scrambling (1995) makes every point uniform and keeps the
/// balance: each digit is flipped by a random bit that depends on the digits before it.
///
/// ```
/// use sensitol_numeric::sampling::Sobol;
/// let plain = Sobol::new(3).expect("there are direction numbers for three dimensions");
/// let mut column = [0.0; 4];
/// plain.column(1, 0, None, &mut column);
/// assert_eq!(column, [0.0, 0.5, 0.75, 0.25]);
/// ```
#[derive(Debug, Clone)]
pub struct Sobol {
    directions: Vec<Directions>,
}

impl Sobol {
    /// Sequence in this number of dimensions. Returns None beyond [`SOBOL_DIMENSIONS`].
    pub fn new(dimensions: usize) -> Option<Self> {
        (dimensions <= SOBOL_DIMENSIONS).then(|| Self { directions: (0..dimensions).map(directions).collect() })
    }

    /// Coordinates of the points from `first` on in one dimension, from 0 to below 1. With a key they are scrambled.
    ///
    /// # Panics
    /// Panics if `first` is not a multiple of the least power of two that holds the points.
    pub fn column(&self, dimension: usize, first: u64, key: Option<u64>, out: &mut [f64]) {
        let mut digits = vec![0; out.len()];
        self.digits(dimension, first, &mut digits);
        on_this_processor(Coordinates { digits: &digits, key, out });
    }

    /// Coordinates as words that are not scrambled, with digits from the bottom up as scrambling needs them.
    pub(crate) fn digits(&self, dimension: usize, first: u64, out: &mut [u64]) {
        let directions = &self.directions[dimension];
        let block = out.len().next_power_of_two() as u64;
        assert_eq!(first % block, 0, "a block starts at a multiple of its size");
        let digits = (0..DIGITS).filter(|digit| first >> digit & 1 == 1);
        let start = digits.fold(0, |x, digit| x ^ directions[digit as usize]).reverse_bits();
        on_this_processor(Images { directions, start, out });
    }
}

/// Work item: points of a block. Every digit doubles them by the images of the previous points.
struct Images<'a> {
    directions: &'a Directions,
    start: u64,
    out: &'a mut [u64],
}

impl Work for Images<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Some(start) = self.out.first_mut() else { return };
        *start = self.start;
        let mut known = 1;
        for direction in self.directions {
            let Some((before, images)) = self.out.split_at_mut_checked(known) else { break };
            let direction = direction.reverse_bits();
            for (image, before) in images.iter_mut().zip(before) {
                *image = *before ^ direction;
            }
            known *= 2;
        }
    }
}

struct Coordinates<'a> {
    digits: &'a [u64],
    key: Option<u64>,
    out: &'a mut [f64],
}

impl Work for Coordinates<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let of = |digits: u64| (digits >> (64 - DIGITS)) as f64 / (1u64 << DIGITS) as f64;
        let points = self.out.iter_mut().zip(self.digits);
        // Plain loops: a closure over two iterators may not be inlined for the baseline processor.
        match self.key {
            Some(key) => {
                for (value, &digits) in points {
                    *value = of(nested(digits.reverse_bits(), key));
                }
            }
            None => {
                for (value, &digits) in points {
                    *value = of(digits.reverse_bits());
                }
            }
        }
    }
}

/// Direction numbers by the recurrence of the dimension's polynomial (Bratley and Fox 1988).
fn directions(dimension: usize) -> Directions {
    let mut v = [0; DIGITS as usize];
    let place = |digit: usize, m: u64| m << (63 - digit);
    let Some(start) = dimension.checked_sub(1).and_then(Start::of) else {
        // The first dimension is van der Corput's sequence.
        v.iter_mut().enumerate().for_each(|(digit, v)| *v = place(digit, 1));
        return v;
    };
    let (degree, polynomial) = (start.degree, start.middle);
    for digit in 0..DIGITS as usize {
        v[digit] = match digit < degree {
            true => place(digit, start.initial(digit)),
            false => {
                let middle = (1..degree).filter(|k| polynomial >> (degree - 1 - k) & 1 == 1);
                middle.fold(v[digit - degree] ^ v[digit - degree] >> degree, |x, k| x ^ v[digit - k])
            }
        };
    }
    v
}

/// Scrambles digits by a key of their dimension: each is flipped by a random bit that depends on those above it. This is exact and costs
/// five times as much as [`scrambled`]. It serves surface distributions, whose points are few and are reused.
///
/// The 63 bits of a tree of [`GROUP`] digits come from one hash of the digits above the tree.
#[inline(always)]
fn nested(digits: u64, key: u64) -> u64 {
    let mut flips = 0;
    for group in 0..NESTED / GROUP {
        let depth = group * GROUP;
        let hash = hashed(digits, depth, key);
        // Digits of this group below a marker bit. Shortened from the right, they number the nodes of the tree from 1 on.
        let own = digits << depth >> (64 - GROUP) | 1 << GROUP;
        let bits = (0..GROUP).fold(0, |bits, level| bits << 1 | hash >> (own >> (GROUP - level)) & 1);
        flips |= bits << (64 - GROUP - depth);
    }
    digits ^ flips ^ hashed(digits, NESTED, key) >> NESTED
}

/// Hash of the digits above a depth. A marker bit below them encodes their number.
#[inline(always)]
fn hashed(digits: u64, depth: u32, key: u64) -> u64 {
    let above = if depth == 0 { 0 } else { digits >> (64 - depth) << (64 - depth) };
    mixed(above ^ 1 << (63 - depth) ^ key)
}

/// Scrambles digits of large samples: each is flipped by a bit that depends on those above it. Digits come from the bottom up and are
/// returned from the top down.
///
/// Sums and products carry only from a bit to higher ones. In the reversed word a digit therefore depends only on those above it (Laine and
/// Karras 2011; Burley 2020, in 32 bits). There are two rounds with random summands and factors. In the digits after the first difference
/// two points then agree with even probability, as far as tests show. The variance formula needs this (Owen 1997).
#[inline(always)]
pub(crate) fn scrambled(digits: u64, key: u64) -> u64 {
    /// Even multipliers without a pattern.
    const EVEN: [u64; 4] = [0x9e37_79b9_7f4a_7c16, 0xbf58_476d_1ce4_e5b8, 0x94d0_49bb_1331_11ea, 0xd6e8_feb8_6659_fd92];
    let (first, factors, second) = (mixed(key ^ 1), mixed(key ^ 2), mixed(key ^ 3));
    let mut x = digits.wrapping_add(first);
    x ^= x.wrapping_mul(EVEN[0]);
    x = x.wrapping_mul(factors | 1);
    x ^= x.wrapping_mul(EVEN[1]);
    x = x.wrapping_add(second);
    x ^= x.wrapping_mul(EVEN[2]);
    x = x.wrapping_mul(factors >> 32 | 1);
    x ^= x.wrapping_mul(EVEN[3]);
    x.reverse_bits()
}

/// Step of SplitMix64: 2^64 divided by the golden ratio, rounded to odd.
pub(super) const GOLDEN: u64 = 0x9e37_79b9_7f4a_7c15;

/// Bijection of words without visible pattern: the finaliser of SplitMix64 (Steele, Lea and Flood 2014, after Stafford).
#[inline(always)]
pub(crate) fn mixed(word: u64) -> u64 {
    let word = word.wrapping_add(GOLDEN);
    let word = (word ^ word >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ word >> 31
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Two points with `i` common digits keep them and differ in the next one. In every later digit they agree for half of all keys, and in
    /// any two later digits for a quarter, as the variance of nested uniform scrambling requires (Owen 1997). Tested are words with few
    /// digits, like the first points, and words full of digits. Shares of 20,000 keys must be within 6 of their standard errors, 0.0035 and
    /// 0.0031. There are about 40,000 such shares.
    #[test]
    fn digits_after_the_first_difference_are_independent() {
        const KEYS: u64 = 20_000;
        let of = |digits: u64, key: u64| scrambled(digits.reverse_bits(), key);
        let tops = [0, 1 << 63, 3 << 62, 0x5555 << 48, 0x1234_5678_9abc_def0, u64::MAX];
        for (case, top) in tops.into_iter().enumerate() {
            for i in [0, 1, 2, 5, 11, 23, 40] {
                let other = top ^ 1 << (63 - i);
                let (mut agree, mut both) = ([0u32; 52], [[0u32; 52]; 52]);
                for key in 0..KEYS {
                    let apart = of(top, mixed(key << 8 | case as u64)) ^ of(other, mixed(key << 8 | case as u64));
                    assert_eq!(apart.leading_zeros(), i, "the digits in common");
                    let same: Vec<usize> =
                        (i as usize + 1..52).filter(|digit| apart >> (63 - digit) & 1 == 0).collect();
                    for (place, &j) in same.iter().enumerate() {
                        agree[j] += 1;
                        same[place + 1..].iter().for_each(|&k| both[j][k] += 1);
                    }
                }
                let share = |count: u32| f64::from(count) / KEYS as f64;
                for j in i as usize + 1..52 {
                    assert!((share(agree[j]) - 0.5).abs() < 0.021, "{top:x}, {i}, {j}: {}", share(agree[j]));
                    for (k, &count) in both[j].iter().enumerate().skip(j + 1) {
                        assert!((share(count) - 0.25).abs() < 0.019, "{top:x}, {i}, {j}, {k}: {}", share(count));
                    }
                }
            }
        }
    }
}
