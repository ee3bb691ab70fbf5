//! Requests of a page: a header and a text, both whole and of bounded length, or none at all.

use std::time::{Duration, Instant};

use httparse::{EMPTY_HEADER, Status};

use crate::commands::serve::answer::Answer;
use crate::commands::serve::connection::Connection;

/// Longest header, in bytes. Browsers send about 1 kB.
const HEADER: usize = 16 << 10;
/// Greatest number of fields of a header. Browsers send about 20.
const FIELDS: usize = 100;
/// Time in which a header arrives as a whole.
const HEADER_TIME: Duration = Duration::from_secs(10);
/// Longest text, in bytes.
const TEXT: u64 = 16 << 20;
/// Time in which a text arrives as a whole: the longest one, at 1 Mbit/s.
const TEXT_TIME: Duration = Duration::from_secs(140);
/// Bytes that are read at once. Memory follows what has arrived, not what the header says.
const BLOCK: usize = 64 << 10;
/// Fields that decide on access and length: a second one would be a matter of opinion.
const ALONE: [&str; 5] = ["Host", "Origin", "Sec-Fetch-Site", "Content-Length", "Transfer-Encoding"];

/// Request whose header has been read.
#[derive(Debug)]
pub(in crate::commands::serve) struct Request {
    pub(in crate::commands::serve) method: String,
    /// Path and parameters.
    pub(in crate::commands::serve) target: String,
    fields: Vec<(String, String)>,
    /// Length of the text; None if the header has none.
    length: Option<u64>,
    /// Bytes of the text that came with the header.
    begun: Vec<u8>,
}

impl Request {
    /// Reads a header. Returns None if the client ends or is too slow.
    pub(in crate::commands::serve) fn read(connection: &Connection) -> Result<Option<Self>, Answer> {
        let end = Instant::now() + HEADER_TIME;
        let mut bytes = vec![0; HEADER];
        let mut filled = 0;
        while filled < HEADER {
            match connection.read(&mut bytes[filled..], end) {
                Ok(0) | Err(_) => return Ok(None),
                Ok(more) => filled += more,
            }
            if let Some(request) = Self::parsed(&bytes[..filled])? {
                return Ok(Some(request));
            }
        }
        Err(Answer::refused(431, "the header of the request is longer than 16 kB"))
    }

    /// Returns the request of a header, or None if it goes on.
    fn parsed(bytes: &[u8]) -> Result<Option<Self>, Answer> {
        let mut fields = [EMPTY_HEADER; FIELDS];
        let mut header = httparse::Request::new(&mut fields);
        let length = match header.parse(bytes) {
            Ok(Status::Complete(length)) => length,
            Ok(Status::Partial) => return Ok(None),
            Err(httparse::Error::TooManyHeaders) => {
                return Err(Answer::refused(431, "the header of the request has more than 100 fields"));
            }
            Err(error) => return Err(Answer::refused(400, &format!("the request is not HTTP: {error}"))),
        };
        // Responses in chunks are not known to HTTP/1.0.
        if header.version != Some(1) {
            return Err(Answer::refused(505, "the server speaks HTTP/1.1"));
        }
        let text = |field: &httparse::Header<'_>| {
            (field.name.to_owned(), String::from_utf8_lossy(field.value).trim().to_owned())
        };
        let mut request = Self {
            method: header.method.unwrap_or_default().to_owned(),
            target: header.path.unwrap_or_default().to_owned(),
            fields: header.headers.iter().map(text).collect(),
            length: None,
            begun: bytes[length..].to_vec(),
        };
        request.length = request.declared()?;
        Ok(Some(request))
    }

    /// Returns the length that the header declares. Refuses what can be read in two ways.
    fn declared(&self) -> Result<Option<u64>, Answer> {
        for name in ALONE {
            if self.fields.iter().filter(|(known, _)| known.eq_ignore_ascii_case(name)).count() > 1 {
                return Err(Answer::refused(400, &format!("the request has more than one {name}")));
            }
        }
        if self.field("Transfer-Encoding").is_some() {
            return Err(Answer::refused(411, "the text comes as a whole, with its length as Content-Length"));
        }
        let Some(length) = self.field("Content-Length") else { return Ok(None) };
        // A sign is not part of a length, as it would be of a number of Rust.
        if length.is_empty() || !length.bytes().all(|byte| byte.is_ascii_digit()) {
            return Err(Answer::refused(400, "the Content-Length is not a number"));
        }
        // Digits that are no number are too many.
        Ok(Some(length.parse().unwrap_or(u64::MAX)))
    }

    /// Returns the value of a field of the header.
    pub(in crate::commands::serve) fn field(&self, name: &str) -> Option<&str> {
        let found = self.fields.iter().find(|(known, _)| known.eq_ignore_ascii_case(name));
        found.map(|(_, value)| value.as_str())
    }

    /// Reads the text: all of its bytes, or a refusal.
    pub(in crate::commands::serve) fn text(&mut self, connection: &Connection) -> Result<String, Answer> {
        let length = self.length.ok_or_else(|| Answer::refused(411, "the request needs a Content-Length"))?;
        let length = usize::try_from(length).ok().filter(|_| length <= TEXT);
        let length = length.ok_or_else(|| Answer::refused(413, "the text is longer than 16 MiB"))?;
        let cut = |reason: &str| Answer::refused(400, &format!("the text is not complete: {reason}"));
        let end = Instant::now() + TEXT_TIME;
        if self.field("Expect").is_some_and(|expected| expected.eq_ignore_ascii_case("100-continue")) {
            connection.write(b"HTTP/1.1 100 Continue\r\n\r\n", end).map_err(|error| cut(&error.to_string()))?;
        }
        let mut bytes = std::mem::take(&mut self.begun);
        bytes.truncate(length);
        let mut block = vec![0; BLOCK];
        while bytes.len() < length {
            let most = BLOCK.min(length - bytes.len());
            match connection.read(&mut block[..most], end) {
                Ok(0) => return Err(cut("the connection ended")),
                Ok(more) => bytes.extend_from_slice(&block[..more]),
                Err(error) => return Err(cut(&error.to_string())),
            }
        }
        String::from_utf8(bytes).map_err(|_| Answer::refused(400, "the text is not UTF-8"))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lengths_are_digits() {
        let length = |fields: &str| {
            let read = Request::parsed(format!("PUT / HTTP/1.1\r\n{fields}\r\nabc").as_bytes());
            read.map(|request| request.unwrap().length).map_err(|refusal| refusal.status())
        };
        assert_eq!(length(""), Ok(None));
        assert_eq!(length("Content-Length: 3\r\n"), Ok(Some(3)));
        assert_eq!(length("content-length:  18446744073709551616 \r\n"), Ok(Some(u64::MAX)));
        for wrong in ["x", "-1", "+3", "", "3, 3", "0x3", "3.0", "٣"] {
            assert_eq!(length(&format!("Content-Length: {wrong}\r\n")), Err(400), "{wrong}");
        }
        assert_eq!(length("Content-Length: 3\r\nContent-length: 3\r\n"), Err(400));
        assert_eq!(length("Host: a\r\nHOST: a\r\n"), Err(400));
        assert_eq!(length("Transfer-Encoding: chunked\r\n"), Err(411));
        assert_eq!(length("Transfer-Encoding: chunked\r\nContent-Length: 3\r\n"), Err(411));
        assert_eq!(length(&"A: b\r\n".repeat(FIELDS + 1)), Err(431));
    }

    #[test]
    fn a_header_is_whole_or_goes_on() {
        let whole = b"GET /a?b HTTP/1.1\r\nHost: h\r\n\r\n";
        for end in 0..whole.len() {
            assert!(matches!(Request::parsed(&whole[..end]), Ok(None)), "{end}");
        }
        let request = Request::parsed(whole).unwrap_or_else(|_| panic!("refused")).unwrap();
        assert_eq!(
            (request.method.as_str(), request.target.as_str(), request.field("host")),
            ("GET", "/a?b", Some("h"))
        );
        for wrong in ["GET / HTTP/1.0\r\n\r\n", "GET / HTTP/2.0\r\n\r\n", "\u{1}\r\n\r\n", "GET  \r\n\r\n"] {
            assert!(Request::parsed(wrong.as_bytes()).is_err(), "{wrong}");
        }
    }
}
