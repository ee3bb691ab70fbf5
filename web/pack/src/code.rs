//! The pieces of a function's body. The binary format is that of the WebAssembly specification 2.0, chapter 5.

use super::streams::{ALIGNED, LOCALS, Local, MEMORY, Stream, Tape};

/// A piece of a body as it stands there, and the stream that it belongs to.
pub enum Piece<'b> {
    Operator(u8),
    /// An operator of local variables, and the variable.
    Local(&'static Local, usize),
    /// An operator of memory with its alignment, the natural one of its type, and the offset.
    Memory {
        operator: u8,
        alignment: u8,
        aligned: u8,
        offset: &'b [u8],
    },
    /// A number that says how much follows.
    Count(Stream, &'b [u8]),
    Number(Stream, &'b [u8]),
    Bytes(Stream, &'b [u8]),
    /// The index of a function.
    Callee(usize),
}

/// Reads a body, and tells each piece with the place where the next one begins. None where it has an operator that is not known here, or
/// a piece is refused.
pub fn body<'b>(code: &mut Tape<'b>, each: &mut impl FnMut(Piece<'b>, usize) -> Option<()>) -> Option<()> {
    let mut walk = Walk { code, each };
    for _ in 0..walk.count(Stream::Locals)? {
        walk.count(Stream::Locals)?;
        walk.bytes(Stream::Locals, 1)?;
    }
    let mut depth = 1;
    while depth > 0 {
        let operator = walk.code.next()?;
        if let Some(local) = LOCALS.iter().find(|local| local.operator == operator) {
            let variable = walk.index()?;
            walk.tell(Piece::Local(local, variable))?;
            continue;
        }
        if let Some(&aligned) = operator.checked_sub(MEMORY).and_then(|place| ALIGNED.get(usize::from(place))) {
            let alignment = walk.code.next().filter(|&alignment| alignment < 0x80)?;
            let offset = walk.code.digits()?;
            walk.tell(Piece::Memory { operator, alignment, aligned, offset })?;
            continue;
        }
        walk.tell(Piece::Operator(operator))?;
        match operator {
            0x02..=0x04 => depth += 1,
            0x0b => depth -= 1,
            _ => {}
        }
        walk.operands(operator)?;
    }
    Some(())
}

struct Walk<'w, 'b, F> {
    code: &'w mut Tape<'b>,
    each: &'w mut F,
}

impl<'b, F: FnMut(Piece<'b>, usize) -> Option<()>> Walk<'_, 'b, F> {
    fn tell(&mut self, piece: Piece<'b>) -> Option<()> {
        (self.each)(piece, self.code.place)
    }

    fn count(&mut self, stream: Stream) -> Option<usize> {
        let count = self.code.clone().number()?;
        let digits = self.code.digits()?;
        self.tell(Piece::Count(stream, digits))?;
        Some(count)
    }

    fn number(&mut self, stream: Stream) -> Option<()> {
        let digits = self.code.digits()?;
        self.tell(Piece::Number(stream, digits))
    }

    fn bytes(&mut self, stream: Stream, count: usize) -> Option<()> {
        let bytes = self.code.take(count)?;
        self.tell(Piece::Bytes(stream, bytes))
    }

    /// A number in the fewest bytes: it is written anew on the way back.
    fn index(&mut self) -> Option<usize> {
        let index = self.code.clone().number()?;
        let digits = self.code.digits()?;
        (digits.len() == 1 || digits.last() != Some(&0)).then_some(index)
    }

    fn callee(&mut self) -> Option<()> {
        let function = self.index()?;
        self.tell(Piece::Callee(function))
    }

    /// The operands of an operator.
    fn operands(&mut self, operator: u8) -> Option<()> {
        match operator {
            0x00 | 0x01 | 0x05 | 0x0b | 0x0f | 0x1a | 0x1b | 0x45..=0xc4 | 0xd1 => {}
            0x02..=0x04 => self.number(Stream::Block)?,
            0x0c | 0x0d => self.number(Stream::Branch)?,
            0x0e => {
                for _ in 0..=self.count(Stream::Branch)? {
                    self.number(Stream::Branch)?;
                }
            }
            0x10 | 0x12 | 0xd2 => self.callee()?,
            0x11 | 0x13 => {
                self.number(Stream::Other)?;
                self.number(Stream::Other)?;
            }
            0x1c => {
                let types = self.count(Stream::Other)?;
                self.bytes(Stream::Other, types)?;
            }
            0x23..=0x26 | 0x3f | 0x40 | 0xd0 => self.number(Stream::Other)?,
            0x41 => {
                let mut ahead = *self.code;
                ahead.digits()?;
                self.number(match ahead.next()? {
                    // i32.add, i32.sub
                    0x6a | 0x6b => Stream::Step,
                    // call, local.get, i32.const
                    0x10 | 0x20 | 0x41 => Stream::Argument,
                    _ => Stream::Integer,
                })?;
            }
            0x42 => self.number(Stream::Long)?,
            0x43 => self.bytes(Stream::Float, 4)?,
            0x44 => self.bytes(Stream::Float, 8)?,
            0xfc => match self.count(Stream::Operator)? {
                0..8 => {}
                8 | 10 | 12 | 14 => {
                    self.number(Stream::Other)?;
                    self.number(Stream::Other)?;
                }
                9 | 11 | 13 | 15..18 => self.number(Stream::Other)?,
                _ => return None,
            },
            0xfd => match self.count(Stream::Operator)? {
                0..12 | 92 | 93 => self.vector()?,
                12 | 13 => self.bytes(Stream::Float, 16)?,
                21..35 => self.bytes(Stream::Other, 1)?,
                84..92 => {
                    self.vector()?;
                    self.bytes(Stream::Other, 1)?;
                }
                14..21 | 35..84 | 94..256 => {}
                _ => return None,
            },
            _ => return None,
        }
        Some(())
    }

    /// Alignment and offset of a vector.
    fn vector(&mut self) -> Option<()> {
        self.bytes(Stream::Operator, 1)?;
        self.number(Stream::Offset)
    }
}
