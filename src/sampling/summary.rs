//! Mean and central moments of a sample, up to the eighth, that can be merged.

use crate::elementary::{Work, on_this_processor};

/// Highest moment: the standard error of a kurtosis needs the eighth.
const ORDER: usize = 8;

/// Count, mean and central sums of a sample; flat in its size.
///
/// Sums are about the sample's own mean and merged pairwise (Pébay 2008, equation 2.1), so that a mean far from 0 costs no
/// digits.
///
/// ```
/// use sensitol::internals::Summary;
/// let mut sample = Summary::of(&[1.0, 2.0]);
/// sample.merge(&Summary::of(&[3.0, 4.0]));
/// assert_eq!((sample.count(), sample.mean(), sample.moment(2)), (4, 2.5, 1.25));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Summary {
    count: u64,
    mean: f64,
    /// `sum (y - mean)^r` for r = 2 to 8.
    sums: [f64; ORDER - 1],
    least: f64,
    greatest: f64,
}

impl Summary {
    /// Of these values, in two passes.
    pub fn of(values: &[f64]) -> Self {
        if values.is_empty() { Self::default() } else { on_this_processor(Sums(values)) }
    }

    /// Takes in another sample.
    pub fn merge(&mut self, other: &Self) {
        if other.count == 0 {
            return;
        }
        if self.count == 0 {
            *self = *other;
            return;
        }
        let (a, b) = (self.count as f64, other.count as f64);
        let n = a + b;
        let apart = other.mean - self.mean;
        let (down, up) = (-b * apart / n, a * apart / n);
        let sum = |of: &Self, order: usize| match order {
            0 => of.count as f64,
            1 => 0.0,
            _ => of.sums[order - 2],
        };
        let mut sums = [0.0; ORDER - 1];
        for order in 2..=ORDER {
            // About the new mean, each sample is moved as a whole.
            let moved = |of: &Self, by: f64| {
                let mut binomial = 1.0;
                let mut power = 1.0;
                let mut total = 0.0;
                for k in 0..=order {
                    total += binomial * power * sum(of, order - k);
                    binomial *= (order - k) as f64 / (k + 1) as f64;
                    power *= by;
                }
                total
            };
            sums[order - 2] = moved(self, down) + moved(other, up);
        }
        self.mean += b * apart / n;
        (self.count, self.sums) = (self.count + other.count, sums);
        (self.least, self.greatest) = (self.least.min(other.least), self.greatest.max(other.greatest));
    }

    /// How many values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Their mean.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// The least and the greatest value.
    pub fn range(&self) -> [f64; 2] {
        [self.least, self.greatest]
    }

    /// Central moment of an order from 2 to 8, the sum divided by the count.
    pub fn moment(&self, order: usize) -> f64 {
        self.sums[order - 2] / self.count as f64
    }

    /// Standard deviation, with `n - 1`; 0 for a single value.
    pub fn sigma(&self) -> f64 {
        (self.sums[0] / (self.count.max(2) - 1) as f64).sqrt()
    }

    /// Standardised moments `a_0 ..= a_8`; None where nothing varies.
    pub(crate) fn standardised(&self) -> Option<[f64; ORDER + 1]> {
        let sigma = self.moment(2).sqrt();
        if self.count < 2 || sigma <= 0.0 || !sigma.is_finite() {
            return None;
        }
        let mut moments = [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for (order, moment) in moments.iter_mut().enumerate().skip(3) {
            // One power at a time: none of them leaves the range of a double.
            *moment = (0..order).fold(self.moment(order), |moment, _| moment / sigma);
        }
        Some(moments)
    }
}

/// Sums that run beside each other, on any processor as many: a sum belongs to the order in which it is taken.
const LANES: usize = 4;

/// Values to be summed, at least one.
struct Sums<'a>(&'a [f64]);

impl Work for Sums<'_> {
    type Output = Summary;

    #[inline(always)]
    fn work(self) -> Summary {
        let (blocks, rest) = self.0.as_chunks::<LANES>();
        let first = self.0[0];
        // About the first value, so that the sum of large values does not round.
        let mut total = [[0.0; LANES]; 2];
        let (pairs, single) = blocks.as_chunks::<2>();
        for pair in pairs {
            for half in 0..2 {
                for lane in 0..LANES {
                    total[half][lane] += pair[half][lane] - first;
                }
            }
        }
        let left = single.as_flattened().iter().chain(rest).map(|value| value - first);
        let total = total.as_flattened().iter().sum::<f64>() + left.sum::<f64>();
        let mean = first + total / self.0.len() as f64;

        let mut sums = [[0.0; LANES]; ORDER - 1];
        let (mut least, mut greatest) = ([first; LANES], [first; LANES]);
        for block in blocks {
            let deviation: [f64; LANES] = std::array::from_fn(|lane| block[lane] - mean);
            let mut power = deviation;
            for sum in &mut sums {
                for lane in 0..LANES {
                    power[lane] *= deviation[lane];
                    sum[lane] += power[lane];
                }
            }
            for lane in 0..LANES {
                least[lane] = if block[lane] < least[lane] { block[lane] } else { least[lane] };
                greatest[lane] = if block[lane] > greatest[lane] { block[lane] } else { greatest[lane] };
            }
        }
        let mut sums = sums.map(|lanes| lanes.iter().sum::<f64>());
        for value in rest {
            let deviation = value - mean;
            let mut power = deviation;
            for sum in &mut sums {
                power *= deviation;
                *sum += power;
            }
        }
        Summary {
            count: self.0.len() as u64,
            mean,
            sums,
            least: least.iter().chain(rest).copied().fold(first, f64::min),
            greatest: greatest.iter().chain(rest).copied().fold(first, f64::max),
        }
    }
}
