//! Files of the NIST MBE PMI project. See `tests/data/README.md`.

use std::io::Read;
use std::path::Path;

/// Bytes of a file in `tests/data`, unpacked.
pub fn bytes(name: &str) -> Vec<u8> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(format!("{name}.stp.gz"));
    let packed = std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let mut found = Vec::new();
    flate2::read::GzDecoder::new(&packed[..]).read_to_end(&mut found).unwrap();
    found
}
