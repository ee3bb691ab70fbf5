//! From a module to its streams. The binary format is that of the WebAssembly specification 2.0, chapter 5.

use super::streams::{ALIGNED, LOCALS, Local, MEMORY, STREAMS, Stream, Tape, UNALIGNED, WITHOUT_OFFSET, write_number};

const MAGIC: &[u8] = b"\0asm\x01\0\0\0";
/// The numbers of the sections of functions' bodies and of memory's contents.
const CODE: u8 = 10;
const DATA: u8 = 11;
/// As many variables as engines allow in a function: <https://webassembly.github.io/spec/js-api/#limits>.
const MOST_VARIABLES: usize = 50_000;

/// The streams of a module. None where it is none, or has operators that are not known here.
pub fn split(module: &[u8]) -> Option<[Vec<u8>; STREAMS]> {
    let mut tape = Tape::of(module);
    let mut split = Split::default();
    let mut rest = Vec::new();
    rest.extend(tape.take(MAGIC.len()).filter(|magic| *magic == MAGIC)?);
    while !tape.is_at_end() {
        let section = tape.next()?;
        let size = tape.number()?;
        let content = tape.take(size)?;
        rest.push(section);
        if section != CODE {
            let stream = if section == DATA { &mut split.streams[Stream::Data as usize] } else { &mut rest };
            write_number(size, stream);
            stream.extend(content);
            continue;
        }
        split.code = Tape::of(content);
        let functions = split.code.number()?;
        write_number(functions, &mut rest);
        for _ in 0..functions {
            let size = split.code.number()?;
            let end = split.code.place + size;
            split.body()?;
            (split.code.place == end).then_some(())?;
        }
        split.code.is_at_end().then_some(())?;
    }
    split.streams[Stream::Module as usize] = rest;
    Some(split.streams)
}

/// Code on its way to the streams.
#[derive(Default)]
struct Split<'b> {
    code: Tape<'b>,
    /// Local variables, the last one used first; those that were never used follow in order.
    recent: Vec<usize>,
    streams: [Vec<u8>; STREAMS],
}

impl Split<'_> {
    fn put(&mut self, stream: Stream, byte: u8) {
        self.streams[stream as usize].push(byte);
    }

    fn bytes(&mut self, stream: Stream, count: usize) -> Option<()> {
        self.streams[stream as usize].extend(self.code.take(count)?);
        Some(())
    }

    /// A number that the way back reads: its groups stand as they stood.
    fn number(&mut self, stream: Stream) -> Option<usize> {
        let digits = self.code.clone().digits()?;
        self.streams[stream as usize].extend(digits);
        self.code.number()
    }

    /// A number whose value does not matter, of up to 64 bits: the highest group first, since it is the easiest to expect.
    fn digits(&mut self, stream: Stream) -> Option<()> {
        let [rest @ .., highest] = self.code.digits()? else { return None };
        let stream = &mut self.streams[stream as usize];
        let Some((lowest, between)) = rest.split_first() else {
            stream.push(*highest);
            return Some(());
        };
        stream.push(highest | 0x80);
        stream.extend(between.iter().rev());
        stream.push(lowest & 0x7f);
        Some(())
    }

    fn local(&mut self, local: &Local) -> Option<()> {
        let variable = self.code.number().filter(|&variable| variable < MOST_VARIABLES)?;
        self.recent.extend(self.recent.len()..=variable);
        let place = self.recent.iter().position(|&known| known == variable)?;
        self.recent[..=place].rotate_right(1);
        if place < local.within {
            self.put(Stream::Operator, local.first + place as u8);
        } else {
            self.put(Stream::Operator, local.operator);
            write_number(place - local.within, &mut self.streams[local.stream as usize]);
        }
        Some(())
    }

    fn memory(&mut self, operator: u8, aligned: u8) -> Option<()> {
        let alignment = self.code.next().filter(|&alignment| alignment < 0x80)?;
        if alignment != aligned {
            self.streams[Stream::Operator as usize].extend([UNALIGNED, operator, alignment]);
        } else if self.code.clone().next()? == 0 {
            self.code.next()?;
            self.put(Stream::Operator, WITHOUT_OFFSET + (operator - MEMORY));
            return Some(());
        } else {
            self.put(Stream::Operator, operator);
        }
        self.digits(Stream::Offset)
    }

    /// The body of a function. None where it has an operator that is not known here.
    fn body(&mut self) -> Option<()> {
        self.recent.clear();
        for _ in 0..self.number(Stream::Locals)? {
            self.number(Stream::Locals)?;
            self.bytes(Stream::Locals, 1)?;
        }
        let mut depth = 1;
        while depth > 0 {
            let operator = self.code.next()?;
            if let Some(local) = LOCALS.iter().find(|local| local.operator == operator) {
                self.local(local)?;
                continue;
            }
            if let Some(&aligned) = operator.checked_sub(MEMORY).and_then(|place| ALIGNED.get(usize::from(place))) {
                self.memory(operator, aligned)?;
                continue;
            }
            self.put(Stream::Operator, operator);
            match operator {
                0x00 | 0x01 | 0x05 | 0x0f | 0x1a | 0x1b | 0x45..=0xc4 | 0xd1 => {}
                0x02..=0x04 => {
                    depth += 1;
                    self.digits(Stream::Block)?;
                }
                0x0b => depth -= 1,
                0x0c | 0x0d => self.digits(Stream::Branch)?,
                0x0e => {
                    for _ in 0..=self.number(Stream::Branch)? {
                        self.digits(Stream::Branch)?;
                    }
                }
                0x10 | 0x12 => self.digits(Stream::Callee)?,
                0x11 | 0x13 => {
                    self.digits(Stream::Other)?;
                    self.digits(Stream::Other)?;
                }
                0x1c => {
                    let types = self.number(Stream::Other)?;
                    self.bytes(Stream::Other, types)?;
                }
                0x23..=0x26 | 0x3f | 0x40 | 0xd0 | 0xd2 => self.digits(Stream::Other)?,
                0x41 => {
                    let mut ahead = self.code;
                    ahead.digits()?;
                    let stream = match ahead.next()? {
                        // i32.add, i32.sub
                        0x6a | 0x6b => Stream::Step,
                        // call, local.get, i32.const
                        0x10 | 0x20 | 0x41 => Stream::Argument,
                        _ => Stream::Integer,
                    };
                    self.digits(stream)?;
                }
                0x42 => self.digits(Stream::Long)?,
                0x43 => self.bytes(Stream::Float, 4)?,
                0x44 => self.bytes(Stream::Float, 8)?,
                0xfc => match self.number(Stream::Operator)? {
                    0..8 => {}
                    8 | 10 | 12 | 14 => {
                        self.digits(Stream::Other)?;
                        self.digits(Stream::Other)?;
                    }
                    9 | 11 | 13 | 15..18 => self.digits(Stream::Other)?,
                    _ => return None,
                },
                0xfd => match self.number(Stream::Operator)? {
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
        }
        Some(())
    }

    /// Alignment and offset of a vector.
    fn vector(&mut self) -> Option<()> {
        self.bytes(Stream::Operator, 1)?;
        self.digits(Stream::Offset)
    }
}
