//! Responses of the server to a page.

use std::time::{Duration, Instant};

use serde_json::json;

use crate::commands::serve::connection::Connection;

/// Response that is sent as a whole.
#[derive(Debug)]
pub(in crate::commands::serve) struct Answer {
    status: u16,
    kind: &'static str,
    text: String,
}

const JSON: &str = "application/json; charset=utf-8";

/// Time in which a response is read as a whole: the page has 1.4 MB.
const WHOLE: Duration = Duration::from_secs(60);

/// Headers of every response: one response a connection, no caching, no guessing of types, and no address with the token to other sites.
const HEADERS: [(&str, &str); 6] = [
    ("Connection", "close"),
    ("Cache-Control", "no-store"),
    ("X-Content-Type-Options", "nosniff"),
    ("Referrer-Policy", "no-referrer"),
    ("X-Frame-Options", "DENY"),
    ("Cross-Origin-Resource-Policy", "same-origin"),
];

impl Answer {
    pub(in crate::commands::serve) fn page(text: &str) -> Self {
        Self { status: 200, kind: "text/html; charset=utf-8", text: text.to_owned() }
    }

    pub(in crate::commands::serve) fn json(text: String) -> Self {
        Self { status: 200, kind: JSON, text }
    }

    /// Response without content: nothing has changed.
    pub(in crate::commands::serve) fn nothing() -> Self {
        Self { status: 204, kind: JSON, text: String::new() }
    }

    /// Refusal with a reason that the page shows.
    pub(in crate::commands::serve) fn refused(status: u16, why: &str) -> Self {
        Self { status, kind: JSON, text: json!({ "refused": why }).to_string() }
    }

    #[cfg(test)]
    pub(in crate::commands::serve) fn status(&self) -> u16 {
        self.status
    }

    pub(in crate::commands::serve) fn not_found() -> Self {
        Self::refused(404, "there is nothing at this address")
    }

    /// Sends the response. A page that is gone is not an error.
    pub(in crate::commands::serve) fn send(self, connection: &Connection) {
        let (status, kind, length) = (self.status, self.kind, self.text.len());
        // Of nothing there is no length: section 8.6 of RFC 9110.
        let head = match status {
            204 => head(status, ""),
            _ => head(status, &format!("Content-Type: {kind}\r\nContent-Length: {length}\r\n")),
        };
        let end = Instant::now() + WHOLE;
        let _ = connection.write(&[head.as_bytes(), self.text.as_bytes()].concat(), end);
    }
}

/// Beginning of a response: status, these fields, and those of every response.
fn head(status: u16, fields: &str) -> String {
    // Browsers read the number alone, so that the reason stays empty.
    let mut head = format!("HTTP/1.1 {status} \r\n{fields}");
    for (name, value) in HEADERS {
        head += &format!("{name}: {value}\r\n");
    }
    head + "\r\n"
}

/// Response in lines, each sent at once in a chunk of its own: HTTP/1.1, section 7.1 of RFC 9112.
pub(in crate::commands::serve) struct Lines<'c> {
    connection: &'c Connection,
    /// True if a part could not be sent: the bytes after it would be read as another part.
    broken: bool,
}

impl<'c> Lines<'c> {
    pub(in crate::commands::serve) fn begin(connection: &'c Connection) -> Self {
        let mut lines = Self { connection, broken: false };
        lines.send(&head(200, "Transfer-Encoding: chunked\r\nContent-Type: application/x-ndjson\r\n"));
        lines
    }

    /// Sends a line. Returns false if the page is gone.
    pub(in crate::commands::serve) fn line(&mut self, text: &str) -> bool {
        self.send(&format!("{:x}\r\n{text}\n\r\n", text.len() + 1))
    }

    pub(in crate::commands::serve) fn end(mut self) {
        self.send("0\r\n\r\n");
    }

    fn send(&mut self, part: &str) -> bool {
        self.broken = self.broken || self.connection.write(part.as_bytes(), Instant::now() + WHOLE).is_err();
        !self.broken
    }
}
