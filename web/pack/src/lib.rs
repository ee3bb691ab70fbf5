//! The engine of the workbench as its page holds it: a WebAssembly module split into streams of like bytes, each compressed by LZMA.
//!
//! A browser knows gzip only, which leaves a half more. `pack` of this crate packs; the same crate as WebAssembly unpacks in the page.

mod lzma;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod packing;
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
mod split;
mod streams;

#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
pub use packing::pack;

use lzma::decompress;
use streams::{STREAMS, Tape, join};

/// Far more than an engine has: damage asks for no more memory.
const LARGEST: usize = 1 << 26;

/// The module that was packed; None where `packed` is not what `pack` makes.
pub fn unpack(packed: &[u8]) -> Option<Vec<u8>> {
    let mut tape = Tape::of(packed);
    let mut streams: [Vec<u8>; STREAMS] = Default::default();
    for stream in &mut streams {
        let size = tape.number().filter(|&size| size <= LARGEST)?;
        let length = tape.number()?;
        let (before, place) = (tape.next()?, tape.next()?);
        *stream = decompress(tape.take(length)?, size, [before, place, place])?;
    }
    join(&streams)
}

/// [`unpack`] for a page; nothing where it fails.
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
#[wasm_bindgen::prelude::wasm_bindgen]
pub fn unpacked(packed: &[u8]) -> Option<Vec<u8>> {
    unpack(packed)
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::streams::write_number;
    use super::*;

    /// A module of one function of type `[] -> []`, by the binary format of the specification, with these local variables and operators.
    fn module(code: &[u8]) -> Vec<u8> {
        let mut module = b"\0asm\x01\0\0\0".to_vec();
        module.extend([1, 4, 1, 0x60, 0, 0]); // types
        module.extend([3, 2, 1, 0]); // functions
        let mut content = vec![1];
        write_number(code.len(), &mut content);
        content.extend(code);
        module.push(10);
        write_number(content.len(), &mut module);
        module.extend(content);
        module.extend([0, 3, 1, b'a', 7]); // a section of another's making
        module
    }

    const CODE: [u8; 58] = [
        2, 2, 0x7f, 1, 0x7c, // locals: 2 i32, 1 f64
        0x41, 0x80, 0x08, 0x22, 1, 0x41, 4, 0x6a, 0x21,
        0, // i32.const 1024, local.tee 1, i32.const 4, i32.add, local.set 0
        0x02, 0x40, 0x20, 1, 0x0d, 0, 0x03, 0x40, 0x20, 0, 0x0e, 1, 0, 1, 0x0b,
        0x0b, // block, br_if, loop, br_table
        0x20, 1, 0x28, 2, 0x90, 1, 0x10, 0, 0x11, 0, 0, // i32.load offset=144, call 0, call_indirect
        0x44, 0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0x21, 2, // f64.const 1, local.set 2
        0xfc, 11, 0, 0x42, 0x7f, // memory.fill, i64.const -1
    ];

    fn function() -> Vec<u8> {
        [&CODE[..], &[0x1a, 0x0b]].concat()
    }

    #[test]
    fn a_module_is_unpacked_as_it_was() {
        let module = module(&function());
        assert_eq!(unpack(&pack(&module).unwrap()).unwrap(), module);
    }

    #[test]
    fn what_is_no_module_is_not_packed() {
        let unknown = module(&[0, 0xfe, 0, 0, 0x0b]);
        let long = module(&[0, 0x20, 0x80, 0, 0x1a, 0x0b]);
        for wrong in [&b"\0asm"[..], &unknown, &long, &module(&function())[..40]] {
            assert!(pack(wrong).is_err(), "{wrong:?}");
        }
    }

    proptest! {
        #[test]
        fn damage_is_an_error_or_another_module(place in 0..200usize, byte: u8) {
            let mut packed = pack(&module(&function())).unwrap();
            let place = place % packed.len();
            packed[place] = byte;
            // Whatever it is, it ends.
            let _ = unpack(&packed);
            prop_assert_eq!(unpack(&packed[..place]), None);
        }
    }
}
