//! Mean and central moments of a sample up to the eighth, which can be merged.

use serde::{Deserialize, Serialize};

use crate::elementary::{Work, on_this_processor};

/// Highest moment: the standard error of a kurtosis needs the eighth.
const ORDER: usize = 8;

/// Count, mean and central sums of a sample. Memory does not grow with the sample.
///
/// Sums are about the sample's own mean and are merged pairwise (Pébay 2008, equation 2.1), so that a mean far from 0 costs no digits.
///
/// ```
/// use sensitol_numeric::sampling::Summary;
/// let mut sample = Summary::of(&[1.0, 2.0]);
/// sample.merge(&Summary::of(&[3.0, 4.0]));
/// assert_eq!((sample.count(), sample.mean(), sample.moment(2)), (4, 2.5, 1.25));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Summary {
    count: u64,
    mean: f64,
    /// Sums `sum (y - mean)^r` for r = 2 to 8.
    sums: [f64; ORDER - 1],
    least: f64,
    greatest: f64,
}

impl Summary {
    /// Sums of these values, in two passes.
    pub fn of(values: &[f64]) -> Self {
        let Some(&first) = values.first() else { return Self::default() };
        let mean = first + on_this_processor(Apart(values)) / values.len() as f64;
        let (blocks, rest) = values.as_chunks::<LANES>();
        let mut lanes = Lanes { sums: [[0.0; LANES]; ORDER - 1], least: [first; LANES], greatest: [first; LANES] };
        on_this_processor(Powers { blocks, mean, lanes: &mut lanes });
        let mut sums = lanes.sums.map(|lanes| lanes.iter().sum::<f64>());
        for value in rest {
            let deviation = value - mean;
            let mut power = deviation;
            for sum in &mut sums {
                power *= deviation;
                *sum += power;
            }
        }
        Self {
            count: values.len() as u64,
            mean,
            sums,
            least: lanes.least.iter().chain(rest).copied().fold(first, f64::min),
            greatest: lanes.greatest.iter().chain(rest).copied().fold(first, f64::max),
        }
    }

    /// Adds another sample.
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
            // Move each sample as a whole to the new mean, by the binomial theorem.
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

    /// Number of values.
    pub fn count(&self) -> u64 {
        self.count
    }

    /// Mean of the values.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Least and greatest value.
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

    /// Standardised moments `a_0 ..= a_8`. Returns None if the values do not vary.
    pub fn standardised(&self) -> Option<[f64; ORDER + 1]> {
        let sigma = self.moment(2).sqrt();
        if self.count < 2 || sigma <= 0.0 || !sigma.is_finite() {
            return None;
        }
        let mut moments = [1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        for (order, moment) in moments.iter_mut().enumerate().skip(3) {
            // Divide one power at a time, so that none leaves the range of a double.
            *moment = (0..order).fold(self.moment(order), |moment, _| moment / sigma);
        }
        Some(moments)
    }
}

/// Number of sums that run side by side. It is equal on every processor, because a sum depends on its order.
const LANES: usize = 8;

/// Work item: sum of values about the first of them, so that large values do not lose digits. There must be at least one value.
struct Apart<'a>(&'a [f64]);

impl Work for Apart<'_> {
    type Output = f64;

    #[inline(always)]
    fn work(self) -> f64 {
        let (pairs, rest) = self.0.as_chunks::<LANES>();
        let first = self.0[0];
        let mut total = [0.0; LANES];
        for pair in pairs {
            for lane in 0..LANES {
                total[lane] += pair[lane] - first;
            }
        }
        total.iter().sum::<f64>() + rest.iter().map(|value| value - first).sum::<f64>()
    }
}

/// Work item: powers of deviations from the mean, and least and greatest values, of every lane.
struct Powers<'a> {
    blocks: &'a [[f64; LANES]],
    mean: f64,
    lanes: &'a mut Lanes,
}

/// Sums of powers from the second on, and least and greatest values. The lanes are written in place: if they were summed within the work,
/// the compiler would transpose them at every block.
struct Lanes {
    sums: [[f64; LANES]; ORDER - 1],
    least: [f64; LANES],
    greatest: [f64; LANES],
}

impl Work for Powers<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        let Self { blocks, mean, lanes } = self;
        let mut sums = [[0.0; LANES]; ORDER - 1];
        for block in blocks {
            let deviation: [f64; LANES] = std::array::from_fn(|lane| block[lane] - mean);
            let mut power = deviation;
            for sum in &mut sums {
                for lane in 0..LANES {
                    power[lane] *= deviation[lane];
                    sum[lane] += power[lane];
                }
            }
        }
        lanes.sums = sums;
        let (mut least, mut greatest) = (lanes.least, lanes.greatest);
        for block in blocks {
            for lane in 0..LANES {
                least[lane] = if block[lane] < least[lane] { block[lane] } else { least[lane] };
                greatest[lane] = if block[lane] > greatest[lane] { block[lane] } else { greatest[lane] };
            }
        }
        (lanes.least, lanes.greatest) = (least, greatest);
    }
}
