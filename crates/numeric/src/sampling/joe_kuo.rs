//! Primitive polynomials and initial direction numbers for Sobol' sequences, by Joe and Kuo (2008).

use std::sync::LazyLock;

/// Notice of the authors, a byte 0, and the numbers. `tests/data/generators/joe_kuo.py` writes the file and describes its format.
const TABLE: &[u8] = include_bytes!("joe_kuo.bin");
/// Index of the first number in the table, behind the byte 0.
const NUMBERS: usize = {
    let mut place = 0;
    while TABLE[place] != 0 {
        place += 1;
    }
    place + 1
};

/// Number of dimensions with direction numbers. The first one takes none from the table.
pub const SOBOL_DIMENSIONS: usize = 2048;

/// Polynomial and initial numbers from which the direction numbers of a dimension follow.
#[derive(Clone, Copy)]
pub(super) struct Start {
    /// Degree of the polynomial, and number of initial numbers.
    pub(super) degree: usize,
    /// Coefficients of the polynomial between the first and the last, highest first.
    pub(super) middle: u64,
    /// Index of the first bit of the initial numbers.
    bits: usize,
}

impl Start {
    /// Start of a dimension of the table. Line 0 belongs to the second dimension.
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

    /// Initial number of a digit below the degree: odd, with one bit for each digit up to this one.
    pub(super) fn initial(self, digit: usize) -> u64 {
        let first = self.bits + digit * digit.saturating_sub(1) / 2;
        let bytes = &TABLE[NUMBERS + SOBOL_DIMENSIONS - 1..];
        let bit = |place: usize| bytes.get(place / 8).map_or(0, |byte| u64::from(byte >> (place % 8) & 1));
        (0..digit).fold(1, |number, place| number | bit(first + place) << (place + 1))
    }
}
