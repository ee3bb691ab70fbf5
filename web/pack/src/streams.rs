//! The form of the packed engine: a WebAssembly module in streams of like bytes, which compress to a seventh less than the module does.
//!
//! The contents of memory are one stream, the operators of functions another, and their operands many, by what they mean. Operators have
//! the bytes of WebAssembly 2.0 but for these, which it does not use:
//!
//! - 0xc5 to 0xcb, `local.get`, `local.set` and `local.tee` of one of the 3, 2 and 2 variables that were used last. The streams of these
//!   operators have the others, by how many others were used since, less 3, 2 and 2.
//! - 0xcc, an operator of memory that follows with its alignment; others are aligned as their types are.
//! - 0xd3 to 0xe9, the 23 operators of memory with the offset 0.
//!
//! Numbers of operands are in groups of 7 bits as in WebAssembly, but the highest first. A call of the function after this one and all that
//! were called before is 0, and others have their index and 1. `page/unpack.js` does the same backwards.

/// Streams, by the meaning of their bytes.
#[derive(Clone, Copy)]
pub enum Stream {
    /// The module without the bodies of its functions and the contents of its memory.
    Module,
    Data,
    Operator,
    /// Types of a function's local variables.
    Locals,
    Get,
    Set,
    Tee,
    Offset,
    /// Integers that are added next.
    Step,
    /// Integers followed by more operands.
    Argument,
    Integer,
    Long,
    Float,
    Callee,
    Branch,
    Block,
    Other,
}

/// How many streams a module has.
pub const STREAMS: usize = Stream::Other as usize + 1;

/// An operator of local variables.
pub struct Local {
    pub operator: u8,
    pub stream: Stream,
    /// How many of the variables used last stand in the operator's byte.
    pub within: usize,
    /// The byte for the last one.
    pub first: u8,
}

/// `local.get`, `local.set`, `local.tee`.
pub const LOCALS: [Local; 3] = [
    Local { operator: 0x20, stream: Stream::Get, within: 3, first: 0xc5 },
    Local { operator: 0x21, stream: Stream::Set, within: 2, first: 0xc8 },
    Local { operator: 0x22, stream: Stream::Tee, within: 2, first: 0xca },
];

/// The first of the operators that load and store, `i32.load`.
pub const MEMORY: u8 = 0x28;
/// The natural alignments of these operators, as powers of 2.
pub const ALIGNED: [u8; 23] = [2, 3, 2, 3, 0, 0, 1, 1, 0, 0, 1, 1, 2, 2, 2, 3, 2, 3, 0, 1, 0, 1, 2];
/// Before one with another alignment.
pub const UNALIGNED: u8 = 0xcc;
/// The first of those with the offset 0.
pub const WITHOUT_OFFSET: u8 = 0xd3;

/// Bytes that are read one after the other.
#[derive(Clone, Copy, Default)]
pub struct Tape<'b> {
    bytes: &'b [u8],
    pub place: usize,
}

impl<'b> Tape<'b> {
    pub fn of(bytes: &'b [u8]) -> Self {
        Self { bytes, place: 0 }
    }

    pub fn next(&mut self) -> Option<u8> {
        let byte = self.bytes.get(self.place).copied();
        self.place += 1;
        byte
    }

    /// A number as it stands: groups of 7 bits, the lowest first.
    pub fn digits(&mut self) -> Option<&'b [u8]> {
        let count = self.bytes.get(self.place..)?.iter().position(|&byte| byte < 0x80)?;
        self.take(count + 1)
    }

    /// An unsigned number of 32 bits.
    pub fn number(&mut self) -> Option<usize> {
        let digits = self.digits().filter(|digits| digits.len() <= 5)?;
        let number = digits.iter().rev().fold(0, |number, &byte| number << 7 | u64::from(byte & 0x7f));
        usize::try_from(number).ok()
    }

    pub fn take(&mut self, count: usize) -> Option<&'b [u8]> {
        let taken = self.bytes.get(self.place..self.place.checked_add(count)?);
        self.place += count;
        taken
    }

    pub fn is_at_end(&self) -> bool {
        self.place >= self.bytes.len()
    }
}

/// Writes a number as [`Tape::number`] reads it.
pub fn write_number(mut number: usize, to: &mut Vec<u8>) {
    while number >= 0x80 {
        to.push(number as u8 | 0x80);
        number >>= 7;
    }
    to.push(number as u8);
}
