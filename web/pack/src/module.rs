//! The sections of a module. The binary format is that of the WebAssembly specification 2.0, chapter 5.

use super::streams::Tape;

pub const MAGIC: &[u8] = b"\0asm\x01\0\0\0";
/// Numbers of sections.
pub const IMPORTS: u8 = 2;
pub const FUNCTIONS: u8 = 3;
pub const EXPORTS: u8 = 7;
pub const START: u8 = 8;
pub const ELEMENTS: u8 = 9;
pub const CODE: u8 = 10;
pub const DATA: u8 = 11;

/// The sections of a module with their numbers; None where it is none.
pub fn sections(module: &[u8]) -> Option<Vec<(u8, &[u8])>> {
    let mut tape = Tape::of(module);
    tape.take(MAGIC.len()).filter(|magic| *magic == MAGIC)?;
    let mut sections = Vec::new();
    while !tape.is_at_end() {
        let section = tape.next()?;
        let size = tape.number()?;
        sections.push((section, tape.take(size)?));
    }
    Some(sections)
}

/// How many functions are imported: their indices come first.
pub fn imported(sections: &[(u8, &[u8])]) -> Option<usize> {
    let mut functions = 0;
    for (_, content) in sections.iter().filter(|(section, _)| *section == IMPORTS) {
        let mut tape = Tape::of(content);
        for _ in 0..tape.number()? {
            for _ in 0..2 {
                let length = tape.number()?;
                tape.take(length)?;
            }
            match tape.next()? {
                0 => {
                    functions += 1;
                    tape.number()?;
                }
                1 => {
                    tape.next()?;
                    limits(&mut tape)?;
                }
                2 => limits(&mut tape)?,
                3 => {
                    tape.take(2)?;
                }
                _ => return None,
            }
        }
    }
    Some(functions)
}

fn limits(tape: &mut Tape<'_>) -> Option<()> {
    let has_most = tape.next()? & 1 == 1;
    tape.digits()?;
    if has_most {
        tape.digits()?;
    }
    Some(())
}
