//! From a module to its streams, where the engine is built.

use super::streams::{CODE, LOCALS, MAGIC, Mover, Recent, STREAMS, Stream, Tape, body, write_number};

impl Recent {
    /// How many others were used since this one.
    fn place_of(&mut self, variable: usize) -> Option<usize> {
        self.extend(variable)?;
        let place = self.order.iter().position(|&known| known == variable)?;
        self.order[..=place].rotate_right(1);
        Some(place)
    }
}

/// From code to streams.
struct Split<'b> {
    code: Tape<'b>,
    recent: Recent,
    streams: [Vec<u8>; STREAMS],
}

impl Mover for Split<'_> {
    fn begin(&mut self) {
        self.recent.order.clear();
    }

    fn operator(&mut self) -> Option<u8> {
        let operator = self.code.next()?;
        let operators = &mut self.streams[Stream::Operator as usize];
        let Some(local) = LOCALS.iter().find(|local| local.operator == operator) else {
            operators.push(operator);
            return Some(operator);
        };
        let place = self.recent.place_of(self.code.number()?)?;
        if place < local.within {
            operators.push(local.first + place as u8);
        } else {
            operators.push(operator);
            write_number(place - local.within, &mut self.streams[local.stream as usize]);
        }
        Some(operator)
    }

    fn byte(&mut self, stream: Stream) -> Option<u8> {
        let byte = self.code.next()?;
        self.streams[stream as usize].push(byte);
        Some(byte)
    }

    fn after_number(&self) -> Option<u8> {
        let mut ahead = self.code;
        while ahead.next()? >= 0x80 {}
        ahead.next()
    }
}

/// The streams of a module. None where it is none, or has operators that are not known here.
pub fn split(module: &[u8]) -> Option<[Vec<u8>; STREAMS]> {
    let mut tape = Tape::of(module);
    let mut mover = Split { code: Tape::default(), recent: Recent::default(), streams: Default::default() };
    let mut rest = Vec::new();
    rest.extend(tape.take(MAGIC.len()).filter(|magic| *magic == MAGIC)?);
    while !tape.is_at_end() {
        let section = tape.next()?;
        let size = tape.number()?;
        let content = tape.take(size)?;
        rest.push(section);
        if section != CODE {
            write_number(size, &mut rest);
            rest.extend(content);
            continue;
        }
        mover.code = Tape::of(content);
        let functions = mover.code.number()?;
        write_number(functions, &mut rest);
        for _ in 0..functions {
            let size = mover.code.number()?;
            let end = mover.code.place + size;
            body(&mut mover)?;
            (mover.code.place == end).then_some(())?;
        }
        mover.code.is_at_end().then_some(())?;
    }
    mover.streams[Stream::Module as usize] = rest;
    Some(mover.streams)
}
