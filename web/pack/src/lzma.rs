//! The decoder of LZMA, for a page: of streams that fit in memory, whose sizes are known.
//!
//! Source: I. Pavlov, LZMA specification of 2015, in the public domain; its names are kept where it has them.

use super::streams::Tape;

/// Probabilities of a bit to be 0 are parts of 2048.
const EVEN: u16 = 1 << 10;
const STATES: usize = 12;
const POSITIONS: usize = 16;
/// The first state after a match.
const MATCHED: usize = 7;

/// Bits by their probabilities, which follow the bits.
struct RangeDecoder<'b> {
    input: Tape<'b>,
    range: u32,
    code: u32,
}

impl<'b> RangeDecoder<'b> {
    fn new(packed: &'b [u8]) -> Option<Self> {
        let mut input = Tape::of(packed);
        input.next().filter(|&first| first == 0)?;
        let code = u32::from_be_bytes(input.take(4)?.try_into().ok()?);
        Some(Self { input, range: u32::MAX, code })
    }

    fn normalize(&mut self) -> Option<()> {
        if self.range < 1 << 24 {
            self.range <<= 8;
            self.code = self.code << 8 | u32::from(self.input.next()?);
        }
        Some(())
    }

    fn bit(&mut self, probability: &mut u16) -> Option<usize> {
        let bound = (self.range >> 11) * u32::from(*probability);
        let bit = self.code >= bound;
        if bit {
            *probability -= *probability >> 5;
            self.code -= bound;
            self.range -= bound;
        } else {
            *probability += (2048 - *probability) >> 5;
            self.range = bound;
        }
        self.normalize()?;
        Some(bit.into())
    }

    /// Bits of even probability.
    fn direct(&mut self, count: u32) -> Option<usize> {
        let mut value = 0;
        for _ in 0..count {
            self.range >>= 1;
            let bit = self.code >= self.range;
            if bit {
                self.code -= self.range;
            }
            self.normalize()?;
            value = value << 1 | usize::from(bit);
        }
        Some(value)
    }

    /// A number of so many bits, the highest first, each with a probability for every beginning.
    fn tree(&mut self, probabilities: &mut [u16], bits: u32) -> Option<usize> {
        let mut node = 1;
        for _ in 0..bits {
            node = node << 1 | self.bit(probabilities.get_mut(node)?)?;
        }
        Some(node - (1 << bits))
    }

    /// The same, the lowest bit first; the probability of the first bit is the first one.
    fn reverse_tree(&mut self, probabilities: &mut [u16], bits: u32) -> Option<usize> {
        let (mut node, mut value) = (1, 0);
        for shift in 0..bits {
            let bit = self.bit(probabilities.get_mut(node - 1)?)?;
            node = node << 1 | bit;
            value |= bit << shift;
        }
        Some(value)
    }
}

/// Lengths of matches beyond 2.
struct Lengths {
    choices: [u16; 2],
    low: [[u16; 8]; POSITIONS],
    mid: [[u16; 8]; POSITIONS],
    high: [u16; 256],
}

impl Lengths {
    fn new() -> Self {
        let small = [[EVEN; 8]; POSITIONS];
        Self { choices: [EVEN; 2], low: small, mid: small, high: [EVEN; 256] }
    }

    fn next(&mut self, decoder: &mut RangeDecoder<'_>, position: usize) -> Option<usize> {
        if decoder.bit(&mut self.choices[0])? == 0 {
            return decoder.tree(&mut self.low[position], 3);
        }
        if decoder.bit(&mut self.choices[1])? == 0 {
            return Some(8 + decoder.tree(&mut self.mid[position], 3)?);
        }
        Some(16 + decoder.tree(&mut self.high, 8)?)
    }
}

/// How far back a match begins, less 1.
struct Distances {
    slots: [[u16; 64]; 4],
    special: [u16; 128],
    align: [u16; 16],
}

impl Distances {
    fn next(&mut self, decoder: &mut RangeDecoder<'_>, length: usize) -> Option<usize> {
        let slot = decoder.tree(&mut self.slots[length.min(3)], 6)?;
        if slot < 4 {
            return Some(slot);
        }
        let bits = (slot as u32 >> 1) - 1;
        let distance = (2 | slot & 1) << bits;
        if slot < 14 {
            let probabilities = &mut self.special[distance - slot..];
            return Some(distance + decoder.reverse_tree(probabilities, bits)?);
        }
        let middle = decoder.direct(bits - 4)? << 4;
        Some(distance + middle + decoder.reverse_tree(&mut self.align, 4)?)
    }
}

/// The `size` bytes of `packed`, which has no header and no end marker; `lc`, `lp` and `pb` as for the encoder. None where it is damaged.
pub fn decompress(packed: &[u8], size: usize, [lc, lp, pb]: [u8; 3]) -> Option<Vec<u8>> {
    if lc > 8 || lp > 4 || pb > 4 {
        return None;
    }
    let mut decoder = RangeDecoder::new(packed)?;
    let mut literals = vec![EVEN; 0x300 << (lc + lp)];
    let mut is_match = [[EVEN; POSITIONS]; STATES];
    let mut is_long = [[EVEN; POSITIONS]; STATES];
    let [mut is_repeated, mut is_older, mut is_older_than_1, mut is_older_than_2] = [[EVEN; STATES]; 4];
    let mut distances = Distances { slots: [[EVEN; 64]; 4], special: [EVEN; 128], align: [EVEN; 16] };
    let (mut lengths, mut repeated_lengths) = (Lengths::new(), Lengths::new());
    // Distances of the last four matches, less 1.
    let mut last = [0usize; 4];
    let mut state = 0;
    let mut out: Vec<u8> = Vec::with_capacity(size);
    while out.len() < size {
        let position = out.len() & ((1 << pb) - 1);
        let before = |distance: usize| out.len().checked_sub(distance + 1).map(|place| out[place]);
        if decoder.bit(&mut is_match[state][position])? == 0 {
            let place = out.len() & ((1 << lp) - 1);
            let context = (place << lc) + (usize::from(before(0).unwrap_or(0)) >> (8 - lc));
            let probabilities = &mut literals[0x300 * context..][..0x300];
            let mut symbol = 1;
            if state >= MATCHED {
                // The byte is probably not that which follows the match.
                let mut matched = usize::from(before(last[0])?);
                while symbol < 0x100 {
                    matched <<= 1;
                    let expected = matched >> 8 & 1;
                    let bit = decoder.bit(&mut probabilities[((1 + expected) << 8) + symbol])?;
                    symbol = symbol << 1 | bit;
                    if bit != expected {
                        break;
                    }
                }
            }
            while symbol < 0x100 {
                symbol = symbol << 1 | decoder.bit(&mut probabilities[symbol])?;
            }
            out.push(symbol as u8);
            state = match state {
                0..4 => 0,
                4..10 => state - 3,
                _ => state - 6,
            };
            continue;
        }
        let length;
        if decoder.bit(&mut is_repeated[state])? == 0 {
            length = lengths.next(&mut decoder, position)?;
            last.rotate_right(1);
            last[0] = distances.next(&mut decoder, length)?;
            state = if state < MATCHED { 7 } else { 10 };
        } else {
            if decoder.bit(&mut is_older[state])? == 0 {
                if decoder.bit(&mut is_long[state][position])? == 0 {
                    let byte = before(last[0])?;
                    out.push(byte);
                    state = if state < MATCHED { 9 } else { 11 };
                    continue;
                }
            } else {
                let older = match decoder.bit(&mut is_older_than_1[state])? {
                    0 => 1,
                    _ => 2 + decoder.bit(&mut is_older_than_2[state])?,
                };
                last[..=older].rotate_right(1);
            }
            length = repeated_lengths.next(&mut decoder, position)?;
            state = if state < MATCHED { 8 } else { 11 };
        }
        let from = out.len().checked_sub(last[0] + 1)?;
        // A match may reach into what it writes.
        for place in from..from + (length + 2).min(size - out.len()) {
            out.push(out[place]);
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use lzma_rust2::{LzmaOptions, LzmaWriter};
    use proptest::prelude::*;

    use super::*;

    proptest! {
        /// The encoder is another's. Few different bytes in repeated pieces, so that matches of every kind occur.
        #[test]
        fn what_was_encoded_is_decoded(
            pieces in prop::collection::vec(prop::collection::vec(0..5u8, 1..40), 1..8),
            order in prop::collection::vec(0..8usize, 0..400),
            [lc, lp, pb] in prop_oneof![Just([0, 0, 0]), Just([3, 0, 2]), Just([4, 0, 0]), Just([0, 3, 3])],
        ) {
            let data: Vec<u8> = order.iter().flat_map(|piece| pieces[piece % pieces.len()].clone()).collect();
            let mut options = LzmaOptions::with_preset(9);
            (options.lc, options.lp, options.pb) = (lc.into(), lp.into(), pb.into());
            let mut writer = LzmaWriter::new_no_header(Vec::new(), &options, false).unwrap();
            writer.write_all(&data).unwrap();
            let packed = writer.finish().unwrap();
            prop_assert_eq!(decompress(&packed, data.len(), [lc, lp, pb]), Some(data));
        }
    }
}
