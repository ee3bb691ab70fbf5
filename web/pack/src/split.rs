//! From a module to its streams.

use super::code::{Piece, body};
use super::module::{CODE, DATA, MAGIC, imported, sections};
use super::streams::{MEMORY, STREAMS, Stream, Tape, UNALIGNED, WITHOUT_OFFSET, write_number};

/// As many variables as engines allow in a function: <https://webassembly.github.io/spec/js-api/#limits>.
const MOST_VARIABLES: usize = 50_000;

/// The streams of a module. None where it is none, or has operators that are not known here.
pub fn split(module: &[u8]) -> Option<[Vec<u8>; STREAMS]> {
    let sections = sections(module)?;
    let imports = imported(&sections)?;
    let mut split = Split { next: imports, ..Split::default() };
    let mut rest = MAGIC.to_vec();
    for (section, content) in sections {
        rest.push(section);
        if section != CODE {
            let stream = if section == DATA { &mut split.streams[Stream::Data as usize] } else { &mut rest };
            write_number(content.len(), stream);
            stream.extend(content);
            continue;
        }
        let mut code = Tape::of(content);
        let functions = code.number()?;
        write_number(functions, &mut rest);
        for function in 0..functions {
            let size = code.number()?;
            let end = code.place + size;
            split.recent.clear();
            split.next = split.next.max(imports + function + 1);
            body(&mut code, &mut |piece, _| split.put(piece))?;
            (code.place == end).then_some(())?;
        }
        code.is_at_end().then_some(())?;
    }
    split.streams[Stream::Module as usize] = rest;
    Some(split.streams)
}

#[derive(Default)]
struct Split {
    /// Local variables, the last one used first; those that were never used follow in order.
    recent: Vec<usize>,
    /// The function after this one and all that were called.
    next: usize,
    streams: [Vec<u8>; STREAMS],
}

impl Split {
    fn put(&mut self, piece: Piece<'_>) -> Option<()> {
        let operators = &mut self.streams[Stream::Operator as usize];
        match piece {
            Piece::Operator(operator) => operators.push(operator),
            Piece::Local(local, variable) => {
                let variable = Some(variable).filter(|&variable| variable < MOST_VARIABLES)?;
                self.recent.extend(self.recent.len()..=variable);
                let place = self.recent.iter().position(|&known| known == variable)?;
                self.recent[..=place].rotate_right(1);
                if place < local.within {
                    operators.push(local.first + place as u8);
                } else {
                    operators.push(local.operator);
                    write_number(place - local.within, &mut self.streams[local.stream as usize]);
                }
            }
            Piece::Memory { operator, alignment, aligned, offset: [0] } if alignment == aligned => {
                operators.push(WITHOUT_OFFSET + (operator - MEMORY));
            }
            Piece::Memory { operator, alignment, aligned, offset } => {
                match alignment == aligned {
                    true => operators.push(operator),
                    false => operators.extend([UNALIGNED, operator, alignment]),
                }
                highest_first(offset, &mut self.streams[Stream::Offset as usize]);
            }
            Piece::Count(stream, bytes) | Piece::Bytes(stream, bytes) => self.streams[stream as usize].extend(bytes),
            Piece::Number(stream, digits) => highest_first(digits, &mut self.streams[stream as usize]),
            Piece::Callee(function) => {
                let is_next = function == self.next;
                self.next += usize::from(is_next);
                write_number(if is_next { 0 } else { function + 1 }, &mut self.streams[Stream::Callee as usize]);
            }
        }
        Some(())
    }
}

/// Writes a number's groups with the highest first, since it is the easiest to expect.
fn highest_first(digits: &[u8], stream: &mut Vec<u8>) {
    let last = digits.len() - 1;
    stream.extend(
        digits.iter().rev().enumerate().map(|(place, digit)| if place < last { digit | 0x80 } else { digit & 0x7f }),
    );
}
