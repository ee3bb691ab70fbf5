//! Random normal and uniform values, a block at a time.

use std::sync::LazyLock;

use rand::{Rng, RngExt};
use rand_distr::Open01;

use crate::elementary::{Elementary, Exp, Ln, Work, on_this_processor};

/// Layers: the density is cut into as many pieces of one area.
const LAYERS: usize = 1024;
/// Where the tail begins, which with its rectangle is the first piece.
const TAIL: f64 = 4.038_849_846_109_504;
/// Fewer values than this are not worth a block.
const FEW: usize = 8;
/// Values that are looked over at once for doubtful ones.
const LOOK: usize = 32;
/// Random words that are drawn at once.
const WORDS: usize = 256;

/// Mean and sigma of the standard normal distribution.
pub(crate) const STANDARD: (f64, f64) = (0.0, 1.0);

/// Widths of the layers and the density at their ends.
struct Layers {
    width: [f64; LAYERS + 1],
    height: [f64; LAYERS + 1],
}

static NORMAL: LazyLock<Layers> = LazyLock::new(|| {
    let density = |x: f64| Exp::of(-0.5 * x * x);
    let beyond = (0.5 * std::f64::consts::PI).sqrt() * libm::erfc(TAIL * std::f64::consts::FRAC_1_SQRT_2);
    let area = TAIL * density(TAIL) + beyond;
    let mut width = [0.0; LAYERS + 1];
    (width[0], width[1]) = (area / density(TAIL), TAIL);
    for layer in 2..LAYERS {
        let height = area / width[layer - 1] + density(width[layer - 1]);
        width[layer] = (-2.0 * Ln::of(height)).sqrt();
    }
    Layers { width, height: width.map(density) }
});

/// Fills `out` with independent values of the normal distribution of a mean and sigma, by the ziggurat (Marsaglia and Tsang 2000) in the
/// form of Doornik (2005): a layer by ten bits of a word, a place in it by 52 others.
///
/// `rand_distr` has the same, one value after the other; most of the time is the call. Here one in 300 wants more than a table
/// and a comparison, and comes after the block.
pub(crate) fn normals(rng: &mut dyn Rng, (mean, sigma): (f64, f64), out: &mut [f64]) {
    let layers = &*NORMAL;
    let placed = |z: f64| mean + sigma * z;
    if out.len() < FEW {
        return out.iter_mut().for_each(|value| *value = placed(layers.draw(rng)));
    }
    let (mut words, mut widths) = ([[0; 8]; WORDS], [[0.0; WORDS]; 2]);
    let mut doubtful = [false; WORDS / LOOK];
    for out in out.chunks_mut(WORDS) {
        // All of them, so that the loops have a length that is known; what is not drawn is not read.
        let drawn = out.len();
        rng.fill_bytes(words[..drawn].as_flattened_mut());
        let mut rest = [0.0; WORDS];
        let whole = if drawn == WORDS { out.as_mut_array() } else { None };
        let values = whole.unwrap_or(&mut rest);
        on_this_processor(Inner {
            layers,
            words: &words,
            widths: &mut widths,
            place: (mean, sigma),
            out: &mut *values,
            doubtful: &mut doubtful,
        });
        for (chunk, _) in doubtful.iter().enumerate().filter(|(_, doubtful)| **doubtful) {
            for place in (LOOK * chunk..LOOK * (chunk + 1)).take_while(|&place| place < drawn) {
                let word = u64::from_le_bytes(words[place]);
                if !layers.holds(word) {
                    values[place] = placed(layers.settled(word, rng).unwrap_or_else(|| layers.draw(rng)));
                }
            }
        }
        if drawn < WORDS {
            out.copy_from_slice(&rest[..drawn]);
        }
    }
}

/// The values of words that lie in the inner part of their layer, and where some do not.
struct Inner<'a> {
    layers: &'a Layers,
    words: &'a [[u8; 8]; WORDS],
    /// Room for the outer and the inner width of every word's layer.
    widths: &'a mut [[f64; WORDS]; 2],
    place: (f64, f64),
    out: &'a mut [f64; WORDS],
    doubtful: &'a mut [bool; WORDS / LOOK],
}

impl Work for Inner<'_> {
    type Output = ();

    /// Tables first, one by one; then what goes side by side.
    #[inline(always)]
    fn work(self) {
        let Self { layers, words, widths: [outer, inner], place: (mean, sigma), out, doubtful } = self;
        for ((outer, inner), word) in outer.iter_mut().zip(inner.iter_mut()).zip(words) {
            let layer = (u64::from_le_bytes(*word) & (LAYERS as u64 - 1)) as usize;
            (*outer, *inner) = (layers.width[layer], layers.width[layer + 1]);
        }
        let looks = (words.as_chunks::<LOOK>().0.iter())
            .zip(outer.as_chunks::<LOOK>().0.iter().zip(inner.as_chunks::<LOOK>().0))
            .zip(out.as_chunks_mut::<LOOK>().0.iter_mut().zip(doubtful));
        for ((words, (outer, inner)), (out, doubtful)) in looks {
            let mut any = 0;
            for lane in 0..LOOK {
                let x = symmetric(u64::from_le_bytes(words[lane])) * outer[lane];
                any |= u64::from(x.abs() >= inner[lane]);
                out[lane] = mean + sigma * x;
            }
            *doubtful = any != 0;
        }
    }
}

impl Layers {
    #[inline(always)]
    fn place(&self, word: u64) -> (usize, f64) {
        let layer = (word & (LAYERS as u64 - 1)) as usize;
        (layer, symmetric(word) * self.width[layer])
    }

    /// Whether a word lies in the inner part of its layer.
    #[inline(always)]
    fn holds(&self, word: u64) -> bool {
        let (layer, x) = self.place(word);
        x.abs() < self.width[layer + 1]
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
            return (height < Exp::of(-0.5 * x * x)).then_some(x);
        }
        loop {
            // Marsaglia's (1964) tail.
            let beyond = -Ln::of(rng.sample(Open01)) / TAIL;
            if -2.0 * Ln::of(rng.sample(Open01)) >= beyond * beyond {
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

/// Fills `out` with independent numbers evenly spread about a mean.
pub(crate) fn uniforms(rng: &mut dyn Rng, (mean, half): (f64, f64), out: &mut [f64]) {
    let mut words = [[0; 8]; WORDS];
    for out in out.chunks_mut(WORDS) {
        let words = &mut words[..out.len()];
        rng.fill_bytes(words.as_flattened_mut());
        on_this_processor(Even { words, place: (mean, half), out });
    }
}

struct Even<'a> {
    words: &'a [[u8; 8]],
    place: (f64, f64),
    out: &'a mut [f64],
}

impl Work for Even<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        /// Half a step, so that -1 is as far as 1.
        const MIDDLE: f64 = 1.0 / (1u64 << 52) as f64;
        let (mean, half) = self.place;
        for (value, word) in self.out.iter_mut().zip(self.words) {
            *value = mean + half * (symmetric(u64::from_le_bytes(*word)) + MIDDLE);
        }
    }
}

/// Makes of every value `origin + scale * value`.
pub(crate) fn place(origin: f64, scale: f64, values: &mut [f64]) {
    on_this_processor(Placed { origin, scale, values });
}

struct Placed<'a> {
    origin: f64,
    scale: f64,
    values: &'a mut [f64],
}

impl Work for Placed<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        self.values.iter_mut().for_each(|value| *value = self.origin + self.scale * *value);
    }
}
