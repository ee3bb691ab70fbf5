//! Primitive polynomials and initial direction numbers for Sobol' sequences, of Joe and Kuo (2008).

use std::sync::LazyLock;

/// Their notice, a byte 0, and their numbers; `tests/data/generators/joe_kuo.py` writes it and says how.
const TABLE: &[u8] = include_bytes!("joe_kuo.bin");
/// Where the numbers begin.
const NUMBERS: usize = {
    let mut place = 0;
    while TABLE[place] != 0 {
        place += 1;
    }
    place + 1
};

/// The dimensions that there are direction numbers for. The first takes none of the table.
pub const SOBOL_DIMENSIONS: usize = 2048;

/// The polynomial and the initial numbers that the direction numbers of a dimension follow from.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// The degree of its polynomial: as many initial numbers.
    pub(super) degree: usize,
    /// Coefficients of the polynomial between the first and the last, highest first.
    pub(super) middle: u64,
    /// Where the bits of the initial numbers begin.
    bits: usize,
}

impl Start {
    /// Of a dimension of the table, the second from 0 on.
    pub(super) fn of(line: usize) -> Option<Self> {
        static STARTS: LazyLock<Vec<Start>> = LazyLock::new(|| {
            let (mut polynomial, mut bits) = (0, 0);
            let starts = TABLE[NUMBERS..].iter().take(SOBOL_DIMENSIONS - 1).map(|&step| {
                polynomial += u64::from(step);
                let degree = (u64::BITS - polynomial.leading_zeros()) as usize;
                let start = Start { degree, middle: polynomial ^ 1 << degree >> 1, bits };
                bits += degree * (degree - 1) / 2;
                start
            });
            starts.collect()
        });
        STARTS.get(line).copied()
    }

    /// The initial number of a digit below the degree: odd, with as many bits as there are digits up to this one.
    pub(super) fn initial(self, digit: usize) -> u64 {
        let first = self.bits + digit * digit.saturating_sub(1) / 2;
        let bytes = &TABLE[NUMBERS + SOBOL_DIMENSIONS - 1..];
        let bit = |place: usize| bytes.get(place / 8).map_or(0, |byte| u64::from(byte >> (place % 8) & 1));
        (0..digit).fold(1, |number, place| number | bit(first + place) << (place + 1))
    }
}
