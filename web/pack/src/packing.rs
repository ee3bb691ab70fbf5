//! Compresses the streams of a module.

use std::io::{Error, ErrorKind, Write};

use lzma_rust2::{LzmaOptions, LzmaWriter};

use super::module::{imported, sections};
use super::split::split;
use super::streams::write_number;

/// The least dictionary that LZMA has.
const DICTIONARY: usize = 4096;
/// LZMA's `lc`, `lp` and `pb`: bits of the previous byte, and of the place, by which it expects the next byte. Each stream takes those
/// that pack it best.
const CONTEXTS: [[u32; 3]; 10] =
    [[0, 0, 0], [1, 0, 0], [2, 0, 0], [3, 0, 0], [4, 0, 0], [5, 0, 0], [6, 0, 0], [3, 0, 2], [0, 2, 2], [0, 3, 3]];

/// A module, packed: its size, how many functions it imports, and for each stream its size, that of the packed one, the byte of LZMA's
/// properties, and the packed one.
///
/// # Errors
/// Where this is no module of WebAssembly 2.0, or its indices are not in the fewest bytes.
pub fn pack(module: &[u8]) -> Result<Vec<u8>, Error> {
    let no_module =
        || Error::new(ErrorKind::InvalidData, "no module of WebAssembly 2.0 with indices in the fewest bytes");
    let streams = split(module).ok_or_else(no_module)?;
    let imports = sections(module).and_then(|sections| imported(&sections)).ok_or_else(no_module)?;
    let mut packed = Vec::new();
    write_number(module.len(), &mut packed);
    write_number(imports, &mut packed);
    for stream in &streams {
        let mut best: Option<([u32; 3], Vec<u8>)> = None;
        for contexts in CONTEXTS {
            let found = compressed(stream, contexts)?;
            if best.as_ref().is_none_or(|(_, best)| found.len() < best.len()) {
                best = Some((contexts, found));
            }
        }
        let ([lc, lp, pb], best) = best.unwrap_or_default();
        write_number(stream.len(), &mut packed);
        write_number(best.len(), &mut packed);
        packed.push(((pb * 5 + lp) * 9 + lc) as u8);
        packed.extend(best);
    }
    Ok(packed)
}

fn compressed(stream: &[u8], [lc, lp, pb]: [u32; 3]) -> Result<Vec<u8>, Error> {
    let mut options = LzmaOptions::with_preset(9);
    (options.lc, options.lp, options.pb) = (lc, lp, pb);
    options.nice_len = LzmaOptions::NICE_LEN_MAX;
    options.depth_limit = 512;
    options.dict_size = stream.len().max(DICTIONARY) as u32;
    let mut writer = LzmaWriter::new_no_header(Vec::new(), &options, false)?;
    writer.write_all(stream)?;
    writer.finish()
}
