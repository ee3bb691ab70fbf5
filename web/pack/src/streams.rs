//! A WebAssembly module in streams of like bytes, which compress to a seventh less than the module does: operators in one, and their
//! operands in others, by what they mean. One walk over the code does both ways: it moves every byte from its source to its target.
//!
//! The binary format is that of the WebAssembly specification 2.0, chapter 5.

/// What the bytes of a stream are.
#[derive(Clone, Copy)]
pub enum Stream {
    /// The module without the bodies of its functions.
    Module,
    /// With the alignments of memory, which follow from their operators for the most part.
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

pub const MAGIC: &[u8] = b"\0asm\x01\0\0\0";
/// The number of the section of functions' bodies.
pub const CODE: u8 = 10;

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

    /// An unsigned number in groups of 7 bits, the lowest first.
    pub fn number(&mut self) -> Option<usize> {
        number(|| self.next())
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

fn number(mut next: impl FnMut() -> Option<u8>) -> Option<usize> {
    let mut number = 0;
    for shift in (0..35).step_by(7) {
        let byte = next()?;
        number |= u64::from(byte & 0x7f) << shift;
        if byte < 0x80 {
            return usize::try_from(number).ok();
        }
    }
    None
}

/// Writes a number as [`Tape::number`] reads it.
pub fn write_number(mut number: usize, to: &mut Vec<u8>) {
    while number >= 0x80 {
        to.push(number as u8 | 0x80);
        number >>= 7;
    }
    to.push(number as u8);
}

/// Local variables, the last one used first: those that are used again soon have small numbers.
#[derive(Default)]
pub struct Recent {
    pub order: Vec<usize>,
}

impl Recent {
    /// As many as engines allow in a function: <https://webassembly.github.io/spec/js-api/#limits>.
    const MOST: usize = 50_000;

    /// The one at this place.
    fn at(&mut self, place: usize) -> Option<usize> {
        self.extend(place)?;
        self.order[..=place].rotate_right(1);
        self.order.first().copied()
    }

    /// Those that were never used follow in order.
    pub fn extend(&mut self, last: usize) -> Option<()> {
        (last < Self::MOST).then(|| self.order.extend(self.order.len()..=last))
    }
}

/// An operator of local variables. Those used last stand in its byte: `first` is that of the last one. A stream has the places of others.
pub struct Local {
    pub operator: u8,
    pub stream: Stream,
    /// How many stand in the byte.
    pub within: usize,
    pub first: u8,
}

/// `local.get`, `local.set`, `local.tee`; WebAssembly has no operators from 0xc5 to 0xcb.
pub const LOCALS: [Local; 3] = [
    Local { operator: 0x20, stream: Stream::Get, within: 3, first: 0xc5 },
    Local { operator: 0x21, stream: Stream::Set, within: 2, first: 0xc8 },
    Local { operator: 0x22, stream: Stream::Tee, within: 2, first: 0xca },
];

impl Local {
    /// That of a byte in the stream of operators.
    fn of(byte: u8) -> Option<&'static Self> {
        let within = |local: &&Self| {
            byte == local.operator
                || (usize::from(local.first)..usize::from(local.first) + local.within).contains(&byte.into())
        };
        LOCALS.iter().find(within)
    }
}

/// Moves bytes of code from where they stand to where they belong.
pub trait Mover {
    /// Begins with another function.
    fn begin(&mut self);

    /// Moves an operator, and says which it is; one of local variables with its variable.
    fn operator(&mut self) -> Option<u8>;

    /// Moves a byte, and says which it was.
    fn byte(&mut self, stream: Stream) -> Option<u8>;

    /// The operator that follows the number that comes next.
    fn after_number(&self) -> Option<u8>;

    fn number(&mut self, stream: Stream) -> Option<usize> {
        number(|| self.byte(stream))
    }

    /// A number whose value does not matter, of up to 64 bits.
    fn digits(&mut self, stream: Stream) -> Option<()> {
        while self.byte(stream)? >= 0x80 {}
        Some(())
    }

    fn bytes(&mut self, stream: Stream, count: usize) -> Option<()> {
        (0..count).try_for_each(|_| self.byte(stream).map(|_| ()))
    }

    fn address(&mut self) -> Option<()> {
        self.digits(Stream::Operator)?;
        self.digits(Stream::Offset)
    }
}

/// From streams to code.
struct Join<'b> {
    streams: [Tape<'b>; STREAMS],
    recent: Recent,
    code: Vec<u8>,
}

impl Mover for Join<'_> {
    fn begin(&mut self) {
        self.recent.order.clear();
        self.code.clear();
    }

    fn operator(&mut self) -> Option<u8> {
        let byte = self.streams[Stream::Operator as usize].next()?;
        let Some(local) = Local::of(byte) else {
            self.code.push(byte);
            return Some(byte);
        };
        let place = match byte == local.operator {
            true => self.streams[local.stream as usize].number()? + local.within,
            false => usize::from(byte - local.first),
        };
        self.code.push(local.operator);
        write_number(self.recent.at(place)?, &mut self.code);
        Some(local.operator)
    }

    fn byte(&mut self, stream: Stream) -> Option<u8> {
        let byte = self.streams[stream as usize].next()?;
        self.code.push(byte);
        Some(byte)
    }

    fn after_number(&self) -> Option<u8> {
        let byte = self.streams[Stream::Operator as usize].clone().next()?;
        Some(Local::of(byte).map_or(byte, |local| local.operator))
    }
}

/// The body of a function. None where it has an operator that is not known here.
pub fn body(mover: &mut impl Mover) -> Option<()> {
    mover.begin();
    for _ in 0..mover.number(Stream::Locals)? {
        mover.digits(Stream::Locals)?;
        mover.byte(Stream::Locals).filter(|kind| matches!(kind, 0x6f | 0x70 | 0x7b..=0x7f))?;
    }
    let mut depth = 1;
    while depth > 0 {
        match mover.operator()? {
            0x00 | 0x01 | 0x05 | 0x0f | 0x1a | 0x1b | 0x20..=0x22 | 0x45..=0xc4 | 0xd1 => {}
            0x02..=0x04 => {
                depth += 1;
                mover.digits(Stream::Block)?;
            }
            0x0b => depth -= 1,
            0x0c | 0x0d => mover.digits(Stream::Branch)?,
            0x0e => {
                for _ in 0..=mover.number(Stream::Branch)? {
                    mover.digits(Stream::Branch)?;
                }
            }
            0x10 | 0x12 => mover.digits(Stream::Callee)?,
            0x11 | 0x13 => {
                mover.digits(Stream::Other)?;
                mover.digits(Stream::Other)?;
            }
            0x1c => {
                let types = mover.number(Stream::Other)?;
                mover.bytes(Stream::Other, types)?;
            }
            0x23..=0x26 | 0x3f | 0x40 | 0xd0 | 0xd2 => mover.digits(Stream::Other)?,
            0x28..=0x3e => mover.address()?,
            0x41 => {
                let stream = match mover.after_number()? {
                    // i32.add, i32.sub
                    0x6a | 0x6b => Stream::Step,
                    // call, local.get, i32.const
                    0x10 | 0x20 | 0x41 => Stream::Argument,
                    _ => Stream::Integer,
                };
                mover.digits(stream)?;
            }
            0x42 => mover.digits(Stream::Long)?,
            0x43 => mover.bytes(Stream::Float, 4)?,
            0x44 => mover.bytes(Stream::Float, 8)?,
            0xfc => match mover.number(Stream::Operator)? {
                0..8 => {}
                8 | 10 | 12 | 14 => {
                    mover.digits(Stream::Other)?;
                    mover.digits(Stream::Other)?;
                }
                9 | 11 | 13 | 15..18 => mover.digits(Stream::Other)?,
                _ => return None,
            },
            0xfd => match mover.number(Stream::Operator)? {
                0..12 | 92 | 93 => mover.address()?,
                12 | 13 => mover.bytes(Stream::Float, 16)?,
                21..35 => mover.bytes(Stream::Other, 1)?,
                84..92 => {
                    mover.address()?;
                    mover.bytes(Stream::Other, 1)?;
                }
                14..21 | 35..84 | 94..256 => {}
                _ => return None,
            },
            _ => return None,
        }
    }
    Some(())
}

/// The module of these streams, its sizes in the fewest bytes. None where they are no module.
pub fn join(streams: &[Vec<u8>; STREAMS]) -> Option<Vec<u8>> {
    let tapes = std::array::from_fn(|stream| Tape::of(&streams[stream]));
    let mut mover = Join { streams: tapes, recent: Recent::default(), code: Vec::new() };
    let mut tape = mover.streams[Stream::Module as usize];
    let mut module = tape.take(MAGIC.len())?.to_vec();
    while !tape.is_at_end() {
        let section = tape.next()?;
        module.push(section);
        if section != CODE {
            let size = tape.number()?;
            write_number(size, &mut module);
            module.extend(tape.take(size)?);
            continue;
        }
        let functions = tape.number()?;
        let mut content = Vec::new();
        write_number(functions, &mut content);
        for _ in 0..functions {
            body(&mut mover)?;
            write_number(mover.code.len(), &mut content);
            content.extend(&mover.code);
        }
        write_number(content.len(), &mut module);
        module.extend(content);
    }
    Some(module)
}
