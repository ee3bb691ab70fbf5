//! Counts in fine bins: quantiles of any number of values in constant memory.

use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

use crate::elementary::{Work, on_this_processor};

/// Scale of the bins: equal widths from each power of two of `1 + |u|` to the next, with `u` in units of a spread about a middle. Bins are
/// fine in the centre, wider far out, and cover every value.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Scale {
    middle: f64,
    spread: f64,
}

/// Number of values in each bin. Counts are whole numbers, so that the order of the values does not change the last bit.
#[derive(Debug, Clone, PartialEq)]
pub struct Fine {
    scale: Scale,
    counts: Vec<u64>,
    total: u64,
}

/// Binary logarithm of the number of bins between two powers of two: a bin is 1/1024 of a spread at the middle.
const EVEN: u32 = 10;
/// Powers of two on either side. Values farther out than a million spreads count in the last bin.
const OCTAVES: usize = 20;
/// Number of bins on either side.
const SIDE: usize = OCTAVES << EVEN;

impl Scale {
    /// Scale about a middle with a spread, as estimated from the first values. A spread of 0 counts as 1.
    pub fn about(middle: f64, spread: f64) -> Self {
        Self { middle, spread: if spread > 0.0 && spread.is_finite() { spread } else { 1.0 } }
    }

    /// Bin of a value: exponent and first digits of `1 + |u|` in the bits of the double. A value on an edge belongs to the bin above it.
    #[inline(always)]
    pub fn bin(&self, value: f64) -> u32 {
        /// Bits of a mantissa below a bin.
        const UNUSED: u32 = f64::MANTISSA_DIGITS - 1 - EVEN;
        const ONE: i64 = (1.0f64.to_bits() >> UNUSED) as i64;
        let u = (value - self.middle) / self.spread;
        let below = u < 0.0;
        let place = (((1.0 + u.abs()).to_bits() - u64::from(below)) >> UNUSED) as i64 - ONE;
        let place = if below { -1 - place } else { place } as i32;
        (SIDE as i32 + place).clamp(0, 2 * SIDE as i32 - 1) as u32
    }

    /// Bins of several values.
    pub fn bins(&self, values: &[f64]) -> Vec<u32> {
        on_this_processor(Bins { scale: self, values })
    }

    /// Lower end of a bin, or for a fraction a point within it.
    fn edge(&self, place: f64) -> f64 {
        let even = f64::from(1u32 << EVEN);
        let from_middle = place - SIDE as f64;
        let octave = (from_middle.abs() / even).floor();
        let u = libm::exp2(octave) * (1.0 + from_middle.abs() / even - octave) - 1.0;
        self.middle + self.spread * u.copysign(from_middle)
    }

    fn width(&self, bin: usize) -> f64 {
        self.edge(bin as f64 + 1.0) - self.edge(bin as f64)
    }
}

struct Bins<'a> {
    scale: &'a Scale,
    values: &'a [f64],
}

impl Work for Bins<'_> {
    type Output = Vec<u32>;

    #[inline(always)]
    fn work(self) -> Vec<u32> {
        let mut bins = vec![0; self.values.len()];
        bins.iter_mut().zip(self.values).for_each(|(bin, &value)| *bin = self.scale.bin(value));
        bins
    }
}

/// Counts of the filled bins alone, for a file.
#[derive(Serialize, Deserialize)]
struct FilledBins {
    scale: Scale,
    /// Pairs of a bin and its count, ascending.
    bins: Vec<(u32, u64)>,
}

impl Serialize for Fine {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let filled = (0..).zip(&self.counts).filter(|&(_, &count)| count > 0);
        FilledBins { scale: self.scale, bins: filled.map(|(bin, &count)| (bin, count)).collect() }.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for Fine {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let FilledBins { scale, bins } = FilledBins::deserialize(deserializer)?;
        let mut fine = Self::new(scale);
        for (bin, count) in bins {
            let place =
                fine.counts.get_mut(bin as usize).ok_or_else(|| D::Error::custom("no such bin of a histogram"))?;
            *place = count;
            fine.total = fine.total.checked_add(count).ok_or_else(|| D::Error::custom("too many values in bins"))?;
        }
        Ok(fine)
    }
}

impl Fine {
    /// Scale of the bins.
    pub fn scale(&self) -> Scale {
        self.scale
    }

    /// Empty counts.
    pub fn new(scale: Scale) -> Self {
        Self { scale, counts: vec![0; 2 * SIDE], total: 0 }
    }

    /// Counts values in their bins.
    pub fn count(&mut self, bins: &[u32]) {
        let counts = &mut self.counts[..2 * SIDE];
        bins.iter().for_each(|&bin| counts[bin as usize] += 1);
        self.total += bins.len() as u64;
    }

    /// Adds the counts of another sample on the same scale.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!(self.scale, other.scale, "bins of one scale");
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, more)| *count += more);
        self.total += other.total;
    }

    /// Number of values.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// Every bin with values: its ends, and its count.
    pub fn filled(&self) -> impl Iterator<Item = ([f64; 2], u64)> + '_ {
        let ends = |bin: usize| [self.scale.edge(bin as f64), self.scale.edge(bin as f64 + 1.0)];
        self.counts.iter().enumerate().filter(|(_, count)| **count > 0).map(move |(bin, &count)| (ends(bin), count))
    }

    /// Value below which `rank` of the values lie, interpolated within its bin. Returns None if there are fewer values.
    pub fn at_rank(&self, rank: f64) -> Option<f64> {
        let (bin, below) = self.bin_of_rank(rank)?;
        Some(self.scale.edge(bin as f64 + (rank - below) / self.counts[bin] as f64))
    }

    /// Bin that holds this rank, and the number of values below it.
    fn bin_of_rank(&self, rank: f64) -> Option<(usize, f64)> {
        if self.total == 0 || !(0.0..=self.total as f64).contains(&rank) {
            return None;
        }
        let mut below = 0.0;
        for (bin, &count) in self.counts.iter().enumerate().filter(|&(_, &count)| count > 0) {
            if below + count as f64 >= rank {
                return Some((bin, below));
            }
            below += count as f64;
        }
        None
    }

    /// Greatest error of the interpolation at this rank. It is an eighth of the bin's width for a density that changes by its own size
    /// between neighbouring bins, and less if it changes less.
    pub fn blur(&self, rank: f64) -> f64 {
        let Some((bin, _)) = self.bin_of_rank(rank) else { return 0.0 };
        let density = |bin: usize| self.counts.get(bin).map_or(0.0, |&count| count as f64 / self.scale.width(bin));
        let [before, own, after] = [bin.checked_sub(1).map_or(0.0, density), density(bin), density(bin + 1)];
        let width = self.scale.width(bin);
        match before + after == 0.0 {
            true => width,
            false => width * 0.125 * ((after - before).abs() / own).min(8.0),
        }
    }

    /// About `bins` equal intervals from `low` to `high`, and the count of each. The first and the last one extend to the ends given. Inner
    /// edges are those of the fine bins, so that every value is counted in the right interval.
    pub fn histogram(&self, [least, greatest]: [f64; 2], [low, high]: [f64; 2], bins: usize) -> (Vec<f64>, Vec<u64>) {
        let (mut edges, mut counts) = (vec![least], Vec::new());
        let mut from = 0;
        for i in 1..bins {
            let to = self.scale.bin(low + (high - low) * i as f64 / bins as f64) as usize;
            let edge = self.scale.edge(to as f64);
            if to > from && edge > edges[edges.len() - 1] && edge < greatest {
                counts.push(self.counts[from..to].iter().sum());
                edges.push(edge);
                from = to;
            }
        }
        counts.push(self.counts[from..].iter().sum());
        edges.push(greatest);
        (edges, counts)
    }
}
