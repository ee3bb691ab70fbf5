//! Functions in the order in which they are first called: a call of one that was not called before is then the next one, which takes no
//! number. In a module of many functions that are called once or twice this is a sixth of what calls take.

use super::code::{Piece, body};
use super::module::{CODE, ELEMENTS, EXPORTS, FUNCTIONS, MAGIC, START, imported, sections};
use super::streams::{Tape, write_number};

/// The module in this order. None where it is none, or names its functions in a form that is not known here.
pub fn ordered(module: &[u8]) -> Option<Vec<u8>> {
    let sections = sections(module)?;
    let imports = imported(&sections)?;
    let content = |number: u8| sections.iter().find(|(section, _)| *section == number).map(|&(_, content)| content);
    // Names of functions for people go by their indices.
    let names = |(section, content): &(u8, &[u8])| *section == 0 && content.starts_with(b"\x04name");
    if sections.iter().any(names) {
        return None;
    }
    let bodies = bodies(content(CODE)?)?;
    let order = order(&bodies, &listed(content(ELEMENTS))?, imports)?;
    let mut places: Vec<usize> = (0..imports + bodies.len()).collect();
    order.iter().enumerate().for_each(|(place, &function)| places[imports + function] = imports + place);
    let place = |function: usize| places.get(function).copied();
    let mut out = MAGIC.to_vec();
    for &(section, content) in &sections {
        let made = match section {
            FUNCTIONS => types(content, &order)?,
            EXPORTS => exports(content, place)?,
            START => {
                let mut start = Vec::new();
                write_number(place(Tape::of(content).number()?)?, &mut start);
                start
            }
            ELEMENTS => elements(content, &mut |function, out| {
                write_number(place(function)?, out);
                Some(())
            })?,
            CODE => {
                let mut made = Vec::new();
                write_number(bodies.len(), &mut made);
                for &function in &order {
                    let body = bodies[function].with(place)?;
                    write_number(body.len(), &mut made);
                    made.extend(body);
                }
                made
            }
            _ => content.to_vec(),
        };
        out.push(section);
        write_number(made.len(), &mut out);
        out.extend(made);
    }
    Some(out)
}

/// A function's body with the indices of functions in it, and where each stands.
struct Body<'b> {
    bytes: &'b [u8],
    callees: Vec<(usize, std::ops::Range<usize>)>,
}

impl Body<'_> {
    fn with(&self, place: impl Fn(usize) -> Option<usize>) -> Option<Vec<u8>> {
        let (mut made, mut from) = (Vec::new(), 0);
        for (function, range) in &self.callees {
            made.extend(&self.bytes[from..range.start]);
            write_number(place(*function)?, &mut made);
            from = range.end;
        }
        made.extend(&self.bytes[from..]);
        Some(made)
    }
}

fn bodies(content: &[u8]) -> Option<Vec<Body<'_>>> {
    let mut code = Tape::of(content);
    let mut bodies = Vec::new();
    for _ in 0..code.number()? {
        let size = code.number()?;
        let start = code.place;
        let mut callees = Vec::new();
        body(&mut code, &mut |piece, end| {
            if let Piece::Callee(function) = piece {
                let mut digits = Vec::new();
                write_number(function, &mut digits);
                callees.push((function, end - digits.len() - start..end - start));
            }
            Some(())
        })?;
        (code.place == start + size).then_some(())?;
        bodies.push(Body { bytes: content.get(start..start + size)?, callees });
    }
    Some(bodies)
}

/// Every function after those that are called before it; those that no function calls follow as they are listed.
fn order(bodies: &[Body<'_>], listed: &[usize], imports: usize) -> Option<Vec<usize>> {
    let mut order: Vec<usize> = Vec::with_capacity(bodies.len());
    let mut is_placed = vec![false; bodies.len()];
    let mut others = listed.iter().filter_map(|function| function.checked_sub(imports)).chain(0..bodies.len());
    for place in 0..bodies.len() {
        if place == order.len() {
            let other = others.find(|&other| is_placed.get(other) == Some(&false))?;
            is_placed[other] = true;
            order.push(other);
        }
        let callees = bodies[order[place]].callees.iter().filter_map(|(function, _)| function.checked_sub(imports));
        for callee in callees {
            if !std::mem::replace(is_placed.get_mut(callee)?, true) {
                order.push(callee);
            }
        }
    }
    Some(order)
}

/// Types of functions.
fn types(content: &[u8], order: &[usize]) -> Option<Vec<u8>> {
    let mut tape = Tape::of(content);
    let types = (0..tape.number()?).map(|_| tape.number()).collect::<Option<Vec<usize>>>()?;
    let mut made = Vec::new();
    write_number(types.len(), &mut made);
    for &function in order {
        write_number(*types.get(function)?, &mut made);
    }
    Some(made)
}

fn exports(content: &[u8], place: impl Fn(usize) -> Option<usize>) -> Option<Vec<u8>> {
    let (mut tape, mut made) = (Tape::of(content), Vec::new());
    let count = tape.number()?;
    write_number(count, &mut made);
    for _ in 0..count {
        let length = tape.number()?;
        write_number(length, &mut made);
        made.extend(tape.take(length)?);
        let kind = tape.next()?;
        made.push(kind);
        let index = tape.number()?;
        write_number(if kind == 0 { place(index)? } else { index }, &mut made);
    }
    Some(made)
}

/// Lists of functions in a table from a place on, each written by `each`. None for lists of another kind.
fn elements(content: &[u8], each: &mut dyn FnMut(usize, &mut Vec<u8>) -> Option<()>) -> Option<Vec<u8>> {
    let (mut tape, mut made) = (Tape::of(content), Vec::new());
    let count = tape.number()?;
    write_number(count, &mut made);
    for _ in 0..count {
        // Of the first table, from a constant on.
        made.extend(tape.take(2).filter(|kind| *kind == [0, 0x41])?);
        made.extend(tape.digits()?);
        made.extend(tape.take(1).filter(|end| *end == [0x0b])?);
        let functions = tape.number()?;
        write_number(functions, &mut made);
        for _ in 0..functions {
            each(tape.number()?, &mut made)?;
        }
    }
    Some(made)
}

/// The functions that tables list.
fn listed(content: Option<&[u8]>) -> Option<Vec<usize>> {
    let mut listed = Vec::new();
    if let Some(content) = content {
        elements(content, &mut |function, _| {
            listed.push(function);
            Some(())
        })?;
    }
    Some(listed)
}
