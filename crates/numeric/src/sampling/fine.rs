//! Counts in fine bins: quantiles of any number of values in flat memory.

use crate::elementary::{Work, on_this_processor};

/// The bins: even from each power of two to the next of `1 + |u|`, `u` in units of a spread about a middle, so that they are
/// fine in the centre, wider far out, and reach as far as anything goes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scale {
    middle: f64,
    spread: f64,
}

/// How many values lie in each bin. Whole numbers, so that the order of the values does not matter to the last bit.
#[derive(Debug, Clone)]
pub struct Fine {
    scale: Scale,
    counts: Vec<u64>,
    total: u64,
}

/// Bins between two powers of two, as a power of two: 1/1024 of a spread at the middle.
const EVEN: u32 = 10;
/// Powers of two on either side; what is farther out than a million spreads counts in the last bin.
const OCTAVES: usize = 20;
/// Bins on either side.
const SIDE: usize = OCTAVES << EVEN;

impl Scale {
    /// About a middle with a spread, as a first look at the values gave them; where nothing is spread, 1 stands for it.
    pub fn about(middle: f64, spread: f64) -> Self {
        Self { middle, spread: if spread > 0.0 && spread.is_finite() { spread } else { 1.0 } }
    }

    /// The bin of a value: exponent and first digits of `1 + |u|` as they stand in the double. A value on an edge lies above it.
    #[inline(always)]
    pub fn bin(&self, value: f64) -> u32 {
        const UNUSED: u32 = f64::MANTISSA_DIGITS - 1 - EVEN;
        const ONE: i64 = (1.0f64.to_bits() >> UNUSED) as i64;
        let u = (value - self.middle) / self.spread;
        let below = u < 0.0;
        let place = (((1.0 + u.abs()).to_bits() - u64::from(below)) >> UNUSED) as i64 - ONE;
        let place = if below { -1 - place } else { place } as i32;
        (SIDE as i32 + place).clamp(0, 2 * SIDE as i32 - 1) as u32
    }

    /// The bins of some values.
    pub fn bins(&self, values: &[f64]) -> Vec<u32> {
        on_this_processor(Bins { scale: self, values })
    }

    /// The lower end of a bin, or a place within one.
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

impl Fine {
    /// Nothing yet.
    pub fn new(scale: Scale) -> Self {
        Self { scale, counts: vec![0; 2 * SIDE], total: 0 }
    }

    /// Counts values in their bins.
    pub fn count(&mut self, bins: &[u32]) {
        let counts = &mut self.counts[..2 * SIDE];
        bins.iter().for_each(|&bin| counts[bin as usize] += 1);
        self.total += bins.len() as u64;
    }

    /// Takes in the counts of another on the same scale.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!(self.scale, other.scale, "bins of one scale");
        self.counts.iter_mut().zip(&other.counts).for_each(|(count, more)| *count += more);
        self.total += other.total;
    }

    /// How many values.
    pub fn total(&self) -> u64 {
        self.total
    }

    /// Every bin with values: its ends, and how many.
    pub fn filled(&self) -> impl Iterator<Item = ([f64; 2], u64)> + '_ {
        let ends = |bin: usize| [self.scale.edge(bin as f64), self.scale.edge(bin as f64 + 1.0)];
        self.counts.iter().enumerate().filter(|(_, count)| **count > 0).map(move |(bin, &count)| (ends(bin), count))
    }

    /// The value below which `rank` of the values lie, interpolated within its bin; None where there are not as many.
    pub fn at_rank(&self, rank: f64) -> Option<f64> {
        let (bin, below) = self.bin_of_rank(rank)?;
        Some(self.scale.edge(bin as f64 + (rank - below) / self.counts[bin] as f64))
    }

    /// The bin that holds this rank, and how many values lie below it.
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

    /// How far the interpolation at this rank may be off: an eighth of the bin for a density that changes by all of itself from
    /// one neighbour to the other, and less as it changes less.
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

    /// About `bins` equal intervals from `low` to `high`, and how many values lie in each; the first and the last one reach
    /// to the ends given. Their inner edges are those of the fine bins, so that every value is counted where it is.
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
