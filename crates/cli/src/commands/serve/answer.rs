//! Responses of the server to a page.

use std::io::{Cursor, Write};

use serde_json::json;
use tiny_http::{Header, Request, Response, StatusCode};

/// Response that is sent as a whole.
pub(in crate::commands::serve) struct Answer {
    status: u16,
    kind: &'static str,
    text: String,
}

const JSON: &str = "application/json; charset=utf-8";

/// Headers of every response: no caching, no guessing of types, and no address with the token to other sites.
const HEADERS: [(&str, &str); 5] = [
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

    pub(in crate::commands::serve) fn not_found() -> Self {
        Self::refused(404, "there is nothing at this address")
    }

    /// Sends the response. A page that is gone is not an error.
    pub(in crate::commands::serve) fn send(self, request: Request) {
        let headers = HEADERS.iter().copied().chain([("Content-Type", self.kind)]);
        let headers = headers.map(|(name, value)| Header::from_bytes(name, value).expect("headers are ASCII"));
        let length = self.text.len();
        let response = Response::new(
            StatusCode(self.status),
            headers.collect(),
            Cursor::new(self.text.into_bytes()),
            Some(length),
            None,
        );
        let _ = request.respond(response);
    }
}

/// Response in lines, each sent at once in a chunk of its own: HTTP/1.1, section 7.1 of RFC 9112.
pub(in crate::commands::serve) struct Lines {
    writer: Box<dyn Write + Send>,
}

impl Lines {
    /// Begins the response. Returns None if the page is gone.
    pub(in crate::commands::serve) fn begin(request: Request) -> Option<Self> {
        let mut writer = request.into_writer();
        let mut head =
            String::from("HTTP/1.1 200 OK\r\nTransfer-Encoding: chunked\r\nContent-Type: application/x-ndjson\r\n");
        for (name, value) in HEADERS {
            head += &format!("{name}: {value}\r\n");
        }
        head += "\r\n";
        writer.write_all(head.as_bytes()).and_then(|()| writer.flush()).ok()?;
        Some(Self { writer })
    }

    /// Sends a line. Returns false if the page is gone.
    pub(in crate::commands::serve) fn line(&mut self, text: &str) -> bool {
        let sent = write!(self.writer, "{:x}\r\n{text}\n\r\n", text.len() + 1).and_then(|()| self.writer.flush());
        sent.is_ok()
    }

    pub(in crate::commands::serve) fn end(mut self) {
        let _ = self.writer.write_all(b"0\r\n\r\n").and_then(|()| self.writer.flush());
    }
}
