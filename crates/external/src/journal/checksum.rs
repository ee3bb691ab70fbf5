//! Checksums of the journal's rows: a bit that a disk flips must not become a figure.

use sha2::{Digest, Sha256};

use super::content::Answer;

/// Checksum of an answer with its point and output: eight bytes of a SHA-256, which a flipped bit changes.
pub(super) fn of_answer(point: &[u8], output: &str, answer: &Answer) -> i64 {
    let (kind, content) = match answer {
        // SQLite keeps no sign of a zero.
        Ok(value) => (b"value", (value + 0.0).to_le_bytes().to_vec()),
        Err(error) => (b"error", error.clone().into_bytes()),
    };
    digest(&[point, output.as_bytes(), kind, &content])
}

/// Checksum of derivatives with their point and output.
pub(super) fn of_slopes(point: &[u8], output: &str, slopes: &[u8]) -> i64 {
    digest(&[point, output.as_bytes(), slopes])
}

/// Eight bytes of the SHA-256 of some parts, each with its length.
fn digest(parts: &[&[u8]]) -> i64 {
    let mut digest = Sha256::new();
    for part in parts {
        digest.update((part.len() as u64).to_le_bytes());
        digest.update(part);
    }
    let digest = digest.finalize();
    i64::from_le_bytes(digest[..8].try_into().expect("a digest has 32 bytes"))
}
