//! Lines of a child's stdout, and whether it still writes at an unfinished one.

use std::io::{BufRead, ErrorKind, Result};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// Time of the last bytes of an unfinished line. None between lines.
#[derive(Debug, Clone, Default)]
pub(super) struct UnfinishedLine(Arc<Mutex<Option<Instant>>>);

impl UnfinishedLine {
    fn set(&self, last: Option<Instant>) {
        if let Ok(mut held) = self.0.lock() {
            *held = last;
        }
    }

    /// True if bytes of an unfinished line came within this time.
    pub(super) fn grew_within(&self, time: Duration) -> bool {
        self.0.lock().is_ok_and(|held| held.is_some_and(|last| last.elapsed() <= time))
    }
}

/// Reads a line with its end, or its beginning of more than `longest` bytes. Returns the number of bytes, 0 at the end of the stream.
pub(super) fn read_line(
    stream: &mut impl BufRead,
    longest: usize,
    line: &mut Vec<u8>,
    unfinished: &UnfinishedLine,
) -> Result<usize> {
    line.clear();
    loop {
        let bytes = match stream.fill_buf() {
            Ok(bytes) => bytes,
            Err(error) if error.kind() == ErrorKind::Interrupted => continue,
            Err(error) => return Err(error),
        };
        let end = bytes.iter().position(|&byte| byte == b'\n');
        let used = end.map_or(bytes.len(), |end| end + 1).min(longest + 1 - line.len());
        line.extend_from_slice(&bytes[..used]);
        let at_end = used == 0 || line.last() == Some(&b'\n') || line.len() > longest;
        stream.consume(used);
        unfinished.set((!at_end).then(Instant::now));
        if at_end {
            return Ok(line.len());
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::BufReader;

    #[test]
    fn lines_end_at_their_newline_or_at_the_limit() {
        let mut stream = BufReader::with_capacity(4, &b"one\nlonger line\nrest"[..]);
        let (mut line, unfinished) = (Vec::new(), UnfinishedLine::default());
        let mut next = |longest: usize| {
            let read = read_line(&mut stream, longest, &mut line, &unfinished).unwrap();
            (read, String::from_utf8(line.clone()).unwrap())
        };
        assert_eq!(next(100), (4, "one\n".to_owned()));
        assert_eq!(next(5), (6, "longer".to_owned()));
        assert_eq!(next(100), (6, " line\n".to_owned()));
        assert_eq!(next(100), (4, "rest".to_owned()));
        assert_eq!(next(100), (0, String::new()));
        assert!(!unfinished.grew_within(Duration::MAX));
    }
}
