//! `pack MODULE ORDERED PACKED`: packs the engine of the workbench for its page, which unpacks it by `page/unpack.js`: a WebAssembly module
//! split into streams of like bytes, each compressed by LZMA. A browser knows gzip only, which leaves a half more. ORDERED is the module
//! that is unpacked: its functions stand in the order of their calls where it has no names for people.

mod code;
mod module;
mod order;
mod packing;
mod split;
mod streams;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [module, ordered, packed] = arguments.as_slice() else {
        eprintln!("usage: pack MODULE ORDERED PACKED");
        return ExitCode::from(2);
    };
    let done = std::fs::read(module).and_then(|bytes| {
        let bytes = order::ordered(&bytes).unwrap_or(bytes);
        std::fs::write(packed, packing::pack(&bytes)?)?;
        std::fs::write(ordered, bytes)
    });
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("pack: {module}: {error}");
            ExitCode::FAILURE
        }
    }
}
