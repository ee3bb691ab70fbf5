//! Packs the engine, where it is built.

use std::io::{Error, ErrorKind, Write};

use lzma_rust2::{LzmaOptions, LzmaWriter};

use super::split::split;
use super::streams::write_number;
use super::unpack;

/// The least dictionary that LZMA has.
const DICTIONARY: usize = 4096;
/// Bits of the previous byte and of the place by which LZMA expects the next byte; each stream takes those that pack it best.
const CONTEXTS: [[u32; 2]; 6] = [[0, 0], [1, 0], [2, 0], [3, 0], [4, 0], [0, 3]];

/// A module, packed. For each stream: its size and that of the packed one, how LZMA expects bytes, and the packed one.
///
/// # Errors
/// Where this is no module of WebAssembly 2.0, or its sizes are not in the fewest bytes.
pub fn pack(module: &[u8]) -> Result<Vec<u8>, Error> {
    let streams = split(module).ok_or_else(|| invalid("no module of WebAssembly 2.0"))?;
    let mut packed = Vec::new();
    for stream in &streams {
        let mut best: Option<([u32; 2], Vec<u8>)> = None;
        for contexts in CONTEXTS {
            let found = compressed(stream, contexts)?;
            if best.as_ref().is_none_or(|(_, best)| found.len() < best.len()) {
                best = Some((contexts, found));
            }
        }
        let ([before, place], best) = best.unwrap_or_default();
        write_number(stream.len(), &mut packed);
        write_number(best.len(), &mut packed);
        packed.extend([before as u8, place as u8]);
        packed.extend(best);
    }
    match unpack(&packed).as_deref() == Some(module) {
        true => Ok(packed),
        false => Err(invalid("a module whose sizes are not in the fewest bytes")),
    }
}

fn compressed(stream: &[u8], [before, place]: [u32; 2]) -> Result<Vec<u8>, Error> {
    let mut options = LzmaOptions::with_preset(9);
    (options.lc, options.lp, options.pb) = (before, place, place);
    options.nice_len = LzmaOptions::NICE_LEN_MAX;
    options.depth_limit = 512;
    options.dict_size = stream.len().max(DICTIONARY) as u32;
    let mut writer = LzmaWriter::new_no_header(Vec::new(), &options, false)?;
    writer.write_all(stream)?;
    writer.finish()
}

fn invalid(what: &str) -> Error {
    Error::new(ErrorKind::InvalidData, what)
}
