//! `pack MODULE PACKED`: packs a WebAssembly module for the page of the workbench.

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [module, packed] = arguments.as_slice() else {
        eprintln!("usage: pack MODULE PACKED");
        return ExitCode::from(2);
    };
    let done = std::fs::read(module).and_then(|bytes| std::fs::write(packed, sensitol_pack::pack(&bytes)?));
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("pack: {module}: {error}");
            ExitCode::FAILURE
        }
    }
}
