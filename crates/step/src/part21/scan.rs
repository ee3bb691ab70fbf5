//! Reads characters of a Part 21 file.

use super::error::{Part21Error, Part21Fault};

/// A place in the bytes of a file.
#[derive(Debug, Clone)]
pub(super) struct Cursor<'a> {
    bytes: &'a [u8],
    pub(super) at: usize,
}

impl<'a> Cursor<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    pub(super) fn peek(&self) -> Option<u8> {
        self.bytes.get(self.at).copied()
    }

    pub(super) fn advance(&mut self, by: usize) {
        self.at += by;
    }

    /// True if the text continues with `word`.
    pub(super) fn continues(&self, word: &str) -> bool {
        self.bytes.get(self.at..).is_some_and(|rest| rest.starts_with(word.as_bytes()))
    }

    /// Fault at this place.
    pub(super) fn error(&self, fault: Part21Fault) -> Part21Error {
        Part21Error { line: Some(line(self.bytes, self.at)), fault }
    }

    /// Fault of a text that the syntax does not have.
    pub(super) fn syntax(&self, expected: &'static str) -> Part21Error {
        let rest = self.bytes.get(self.at..).unwrap_or(&[]);
        if rest.is_empty() {
            return self.error(Part21Fault::CutOff);
        }
        let shown: String = (rest.iter().take(12).map(|&byte| char::from(byte)))
            .take_while(|c| *c != '\n')
            .map(|c| if c.is_control() { '?' } else { c })
            .collect();
        self.error(Part21Fault::Syntax { expected, found: shown })
    }

    /// Skips white space and comments.
    pub(super) fn skip_space(&mut self) -> Result<(), Part21Error> {
        while let Some(c) = self.peek() {
            if c <= b' ' {
                self.at += 1;
            } else if c == b'/' && self.bytes.get(self.at + 1) == Some(&b'*') {
                self.skip_comment()?;
            } else {
                break;
            }
        }
        Ok(())
    }

    fn skip_comment(&mut self) -> Result<(), Part21Error> {
        let rest = &self.bytes[self.at..];
        let end = rest.windows(2).skip(2).position(|two| two == b"*/");
        match end {
            Some(end) => self.at += end + 4,
            None => {
                self.at = self.bytes.len();
                return Err(self.error(Part21Fault::CutOff));
            }
        }
        Ok(())
    }

    pub(super) fn expect(&mut self, byte: u8, expected: &'static str) -> Result<(), Part21Error> {
        self.skip_space()?;
        if self.peek() != Some(byte) {
            return Err(self.syntax(expected));
        }
        self.at += 1;
        Ok(())
    }

    /// Letters, digits and underscores, empty if there are none.
    pub(super) fn keyword(&mut self) -> &'a str {
        let start = self.at;
        if self.peek() == Some(b'!') {
            self.at += 1;
        }
        while self.peek().is_some_and(|c| c.is_ascii_alphanumeric() || c == b'_' || c == b'-') {
            self.at += 1;
        }
        // OK because all bytes are ASCII.
        std::str::from_utf8(&self.bytes[start..self.at]).unwrap_or("")
    }

    /// Number after `#`.
    pub(super) fn number_of_entity(&mut self) -> Result<u64, Part21Error> {
        let start = self.clone();
        self.at += 1;
        let mut found: Option<u64> = None;
        while let Some(digit) = self.peek().filter(u8::is_ascii_digit) {
            let more = found.unwrap_or(0).checked_mul(10).and_then(|id| id.checked_add(u64::from(digit - b'0')));
            found = Some(more.ok_or_else(|| start.syntax("a number below 2^64 after `#`"))?);
            self.at += 1;
        }
        found.ok_or_else(|| start.syntax("a number after `#`"))
    }

    pub(super) fn number(&mut self) -> Result<f64, Part21Error> {
        let start = self.clone();
        while self.peek().is_some_and(|c| c.is_ascii_digit() || matches!(c, b'+' | b'-' | b'.' | b'E' | b'e')) {
            self.at += 1;
        }
        let text = std::str::from_utf8(&self.bytes[start.at..self.at]).unwrap_or("");
        text.parse().map_err(|_| start.syntax("a number"))
    }

    /// Text between quotes, with doubled quotes as they are.
    pub(super) fn quoted(&mut self, quote: u8) -> Result<&'a [u8], Part21Error> {
        self.at += 1;
        let start = self.at;
        loop {
            match self.peek() {
                None => return Err(self.error(Part21Fault::CutOff)),
                Some(c) if c == quote && self.bytes.get(self.at + 1) == Some(&quote) => self.at += 2,
                Some(c) if c == quote => {
                    self.at += 1;
                    return Ok(&self.bytes[start..self.at - 1]);
                }
                Some(_) => self.at += 1,
            }
        }
    }

    /// Skips to the end of a statement, after its `;`.
    pub(super) fn skip_statement(&mut self) -> Result<(), Part21Error> {
        loop {
            match self.peek() {
                None => return Err(self.error(Part21Fault::CutOff)),
                Some(b';') => {
                    self.at += 1;
                    return Ok(());
                }
                Some(quote @ (b'\'' | b'"')) => {
                    self.quoted(quote)?;
                }
                Some(b'/') if self.bytes.get(self.at + 1) == Some(&b'*') => self.skip_comment()?,
                Some(_) => self.at += 1,
            }
        }
    }

    /// Skips one list in parentheses.
    pub(super) fn skip_list(&mut self) -> Result<(), Part21Error> {
        let mut depth = 0_usize;
        loop {
            match self.peek() {
                None => return Err(self.error(Part21Fault::CutOff)),
                Some(b'(') => depth += 1,
                Some(b')') => depth = depth.saturating_sub(1),
                Some(b';') => return Err(self.syntax("`)`")),
                Some(quote @ (b'\'' | b'"')) => {
                    self.quoted(quote)?;
                    continue;
                }
                Some(b'/') if self.bytes.get(self.at + 1) == Some(&b'*') => {
                    self.skip_comment()?;
                    continue;
                }
                Some(_) => {}
            }
            self.at += 1;
            if depth == 0 {
                return Ok(());
            }
        }
    }
}

/// Line of a place, from 1.
pub(super) fn line(bytes: &[u8], at: usize) -> usize {
    1 + bytes[..at.min(bytes.len())].iter().filter(|&&byte| byte == b'\n').count()
}
