//! Random normal and uniform values, a block at a time.

use std::sync::LazyLock;

use rand::{Rng, RngExt};
use rand_distr::Open01;

/// Layers: the density is cut into as many pieces of one area.
const LAYERS: usize = 256;
/// Where the tail begins, which with its rectangle is the first piece.
const TAIL: f64 = 3.654_152_885_361_008_8;
/// Random words that are drawn at once.
const WORDS: usize = 64;

/// Widths of the layers and the density at their ends.
struct Layers {
    width: [f64; LAYERS + 1],
    height: [f64; LAYERS + 1],
}

static NORMAL: LazyLock<Layers> = LazyLock::new(|| {
    let density = |x: f64| libm::exp(-0.5 * x * x);
    let beyond = (0.5 * std::f64::consts::PI).sqrt() * libm::erfc(TAIL * std::f64::consts::FRAC_1_SQRT_2);
    let area = TAIL * density(TAIL) + beyond;
    let mut width = [0.0; LAYERS + 1];
    (width[0], width[1]) = (area / density(TAIL), TAIL);
    for layer in 2..LAYERS {
        let height = area / width[layer - 1] + density(width[layer - 1]);
        width[layer] = (-2.0 * libm::log(height)).sqrt();
    }
    Layers { width, height: width.map(density) }
});

/// Fills `out` with independent values of the standard normal distribution, by the ziggurat (Marsaglia and Tsang 2000) in the
/// form of Doornik (2005): a layer by eight bits of a word, a place in it by 52 others.
///
/// `rand_distr` has the same, one value after the other; most of the time is the call. Here one in 80 wants more than a table
/// and a comparison, and comes after the block.
pub(crate) fn normals(rng: &mut dyn Rng, out: &mut [f64]) {
    let layers = &*NORMAL;
    let mut bytes = [[0; 8]; WORDS];
    let mut doubtful = [0; WORDS];
    for out in out.chunks_mut(WORDS) {
        let bytes = &mut bytes[..out.len()];
        rng.fill_bytes(bytes.as_flattened_mut());
        let mut doubts = 0;
        for (place, (value, bytes)) in out.iter_mut().zip(bytes.iter()).enumerate() {
            let (layer, x) = layers.place(u64::from_le_bytes(*bytes));
            *value = x;
            doubtful[doubts % WORDS] = place;
            doubts += usize::from(x.abs() >= layers.width[layer + 1]);
        }
        for &place in &doubtful[..doubts] {
            let word = u64::from_le_bytes(bytes[place]);
            out[place] = layers.settled(word, rng).unwrap_or_else(|| layers.draw(rng));
        }
    }
}

impl Layers {
    #[inline(always)]
    fn place(&self, word: u64) -> (usize, f64) {
        let layer = (word & (LAYERS as u64 - 1)) as usize;
        (layer, symmetric(word) * self.width[layer])
    }

    fn draw(&self, rng: &mut dyn Rng) -> f64 {
        loop {
            let word = rng.next_u64();
            let (layer, x) = self.place(word);
            if x.abs() < self.width[layer + 1] {
                return x;
            }
            if let Some(x) = self.settled(word, rng) {
                return x;
            }
        }
    }

    /// The value of a word that lies in no layer's inner part; None where it is rejected.
    #[cold]
    fn settled(&self, word: u64, rng: &mut dyn Rng) -> Option<f64> {
        let (layer, x) = self.place(word);
        if layer > 0 {
            let [low, high] = [self.height[layer], self.height[layer + 1]];
            let height = low + (high - low) * rng.random::<f64>();
            return (height < libm::exp(-0.5 * x * x)).then_some(x);
        }
        loop {
            // Marsaglia's (1964) tail.
            let beyond = -libm::log(rng.sample::<f64, _>(Open01)) / TAIL;
            if -2.0 * libm::log(rng.sample::<f64, _>(Open01)) >= beyond * beyond {
                return Some((TAIL + beyond).copysign(x));
            }
        }
    }
}

/// A number from -1 to below 1 in steps of 2^-51, by the upper bits of a word.
#[inline(always)]
fn symmetric(word: u64) -> f64 {
    f64::from_bits(word >> 12 | 0x4000_0000_0000_0000) - 3.0
}

/// Fills `out` with independent numbers evenly spread between -1 and 1.
pub(crate) fn uniforms(rng: &mut dyn Rng, out: &mut [f64]) {
    /// Half a step, so that -1 is as far as 1.
    const MIDDLE: f64 = 1.0 / (1u64 << 52) as f64;
    let mut bytes = [[0; 8]; WORDS];
    for out in out.chunks_mut(WORDS) {
        let bytes = &mut bytes[..out.len()];
        rng.fill_bytes(bytes.as_flattened_mut());
        out.iter_mut().zip(bytes).for_each(|(value, bytes)| *value = symmetric(u64::from_le_bytes(*bytes)) + MIDDLE);
    }
}
