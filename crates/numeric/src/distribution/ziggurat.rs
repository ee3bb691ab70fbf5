//! Random normal and uniform values, computed in blocks.

use std::cell::RefCell;
use std::sync::LazyLock;

use rand::{Rng, RngExt};
use rand_distr::Open01;

use crate::elementary::{Elementary, Exp, Ln, Work, on_this_processor};

/// Number of layers of equal area into which the density is cut.
const LAYERS: usize = 1024;
/// Beginning of the tail, which together with its rectangle is the first layer.
const TAIL: f64 = 4.038_849_846_109_504;
/// Smallest number of values for which a block pays.
const FEW: usize = 8;
/// Values that are tested at once for lying outside the inner part of their layer.
const LOOK: usize = 32;
/// Random words that are drawn at once.
const WORDS: usize = 256;

/// Mean and sigma of the standard normal distribution.
pub(crate) const STANDARD: (f64, f64) = (0.0, 1.0);

/// Widths of the layers and the density at their edges.
struct Layers {
    width: [f64; LAYERS + 1],
    height: [f64; LAYERS + 1],
    /// Outer and inner width of every layer.
    both: [Both; LAYERS],
}

/// Two numbers that one load reads and that share a cache line.
#[derive(Clone, Copy)]
#[repr(align(16))]
struct Both([f64; 2]);

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
    let both = std::array::from_fn(|layer| Both([width[layer], width[layer + 1]]));
    Layers { width, height: width.map(density), both }
});

/// Fills `out` with independent values of the normal distribution with this mean and sigma. Method: the ziggurat (Marsaglia and Tsang 2000)
/// in the form of Doornik (2005), with the layer from ten bits of a word and the position in it from 52 others.
///
/// `rand_distr` implements it for one value at a time, where the call takes most of the time. Here one value in 300 needs more than a table
/// and a comparison, and these values are computed after the block.
pub(crate) fn normals(rng: &mut dyn Rng, (mean, sigma): (f64, f64), out: &mut [f64]) {
    let layers = &*NORMAL;
    if out.len() < FEW {
        return out.iter_mut().for_each(|value| *value = mean + sigma * layers.draw(rng));
    }
    ROOM.with_borrow_mut(|room| {
        let (whole, rest) = out.as_chunks_mut::<WORDS>();
        whole.iter_mut().for_each(|out| room.fill(rng, (mean, sigma), WORDS, out));
        if !rest.is_empty() {
            let mut out = [0.0; WORDS];
            room.fill(rng, (mean, sigma), rest.len(), &mut out);
            rest.copy_from_slice(&out[..rest.len()]);
        }
    });
}

thread_local! {
    /// One buffer for each thread, because a new one in every call would have to be cleared.
    static ROOM: RefCell<Room> =
        const { RefCell::new(Room { words: [[0; 8]; WORDS], widths: [[0.0; 2]; WORDS], doubtful: [0; WORDS / LOOK] }) };
}

/// Buffer in which a block of values is computed.
struct Room {
    words: [[u8; 8]; WORDS],
    /// Outer and inner width of every word's layer, side by side as in the table: one load and one store for both.
    widths: [[f64; 2]; WORDS],
    /// Bit mask for each group of `LOOK` words of those that lie outside the inner part of their layer.
    doubtful: [u32; WORDS / LOOK],
}

impl Room {
    /// Draws this number of values with a mean and sigma into the front of `out`. The values behind them have no meaning.
    fn fill(&mut self, rng: &mut dyn Rng, place: (f64, f64), drawn: usize, out: &mut [f64; WORDS]) {
        let layers = &*NORMAL;
        rng.fill_bytes(self.words[..drawn].as_flattened_mut());
        // Compute the whole block, so that the loops have a constant length.
        on_this_processor(Inner { layers, room: &mut *self, place, out: &mut *out });
        for (look, &doubtful) in self.doubtful.iter().enumerate() {
            let mut left = doubtful;
            while left != 0 {
                let index = LOOK * look + left.trailing_zeros() as usize;
                left &= left - 1;
                if index < drawn {
                    let word = u64::from_le_bytes(self.words[index]);
                    let value = layers.settled(word, rng).unwrap_or_else(|| layers.draw(rng));
                    out[index] = place.0 + place.1 * value;
                }
            }
        }
    }
}

/// Work item: the values of words inside the inner part of their layer, and a mask of the others.
struct Inner<'a> {
    layers: &'a Layers,
    room: &'a mut Room,
    place: (f64, f64),
    out: &'a mut [f64; WORDS],
}

impl Work for Inner<'_> {
    type Output = ();

    /// Reads the tables one by one first, then computes side by side.
    #[inline(always)]
    fn work(self) {
        let Self { layers, room: Room { words, widths, doubtful }, place: (mean, sigma), out } = self;
        for (widths, word) in widths.iter_mut().zip(words.iter()) {
            let layer = (u64::from_le_bytes(*word) & (LAYERS as u64 - 1)) as usize;
            *widths = layers.both[layer].0;
        }
        let looks = (words.as_chunks::<LOOK>().0.iter())
            .zip(widths.as_chunks::<LOOK>().0)
            .zip(out.as_chunks_mut::<LOOK>().0.iter_mut().zip(doubtful));
        for ((words, widths), (out, doubtful)) in looks {
            let place = |lane: usize| symmetric(u64::from_le_bytes(words[lane])) * widths[lane][0];
            let beyond = |x: f64, lane: usize| x.abs() >= widths[lane][1];
            let mut any = 0;
            for (lane, value) in out.iter_mut().enumerate() {
                let x = place(lane);
                any |= u64::from(beyond(x, lane));
                *value = mean + sigma * x;
            }
            // One group in ten has a bit set.
            *doubtful = 0;
            if any != 0 {
                *doubtful = (0..LOOK).fold(0, |all, lane| all | u32::from(beyond(place(lane), lane)) << lane);
            }
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

    /// Value of a word outside the inner part of its layer. Returns None if it is rejected.
    #[cold]
    fn settled(&self, word: u64, rng: &mut dyn Rng) -> Option<f64> {
        let (layer, x) = self.place(word);
        if layer > 0 {
            let [low, high] = [self.height[layer], self.height[layer + 1]];
            let height = low + (high - low) * rng.random::<f64>();
            return (height < Exp::of(-0.5 * x * x)).then_some(x);
        }
        loop {
            // Tail by the method of Marsaglia (1964).
            let beyond = -Ln::of(rng.sample(Open01)) / TAIL;
            if -2.0 * Ln::of(rng.sample(Open01)) >= beyond * beyond {
                return Some((TAIL + beyond).copysign(x));
            }
        }
    }
}

/// Number from -1 to below 1 in steps of 2^-51, from the upper bits of a word.
#[inline(always)]
fn symmetric(word: u64) -> f64 {
    f64::from_bits(word >> 12 | 0x4000_0000_0000_0000) - 3.0
}

/// Fills `out` with independent numbers, uniform within `half` about a mean.
pub(crate) fn uniforms(rng: &mut dyn Rng, (mean, half): (f64, f64), out: &mut [f64]) {
    // Write the random words into the memory of the numbers.
    rng.fill_bytes(bytemuck::cast_slice_mut(out));
    on_this_processor(Even { place: (mean, half), out });
}

struct Even<'a> {
    place: (f64, f64),
    out: &'a mut [f64],
}

impl Work for Even<'_> {
    type Output = ();

    #[inline(always)]
    fn work(self) {
        /// Half a step, which makes the interval symmetric.
        const MIDDLE: f64 = 1.0 / (1u64 << 52) as f64;
        let (mean, half) = self.place;
        for value in self.out {
            *value = mean + half * (symmetric(u64::from_le(value.to_bits())) + MIDDLE);
        }
    }
}
