//! Access control: a request needs the token, the server's own address as host, and an origin that is the page itself.

use std::net::SocketAddr;

use crate::commands::serve::answer::Answer;
use crate::commands::serve::request::Request;

/// Length of a token in bytes: 2^128 values are too many to try.
const TOKEN: usize = 16;

pub(in crate::commands::serve) struct Guard {
    token: String,
    at: SocketAddr,
}

/// Request with its name and parameters.
#[derive(Debug, PartialEq, Eq)]
pub(in crate::commands::serve) struct Query {
    /// Last part of the address, which names the request.
    pub(in crate::commands::serve) what: String,
    given: Vec<(String, String)>,
}

impl Query {
    pub(in crate::commands::serve) fn get(&self, name: &str) -> Option<&str> {
        self.given.iter().find(|(known, _)| known == name).map(|(_, value)| value.as_str())
    }
}

impl Guard {
    /// Draws a token from the system's random numbers.
    pub(in crate::commands::serve) fn new(at: SocketAddr) -> Result<Self, String> {
        let mut bytes = [0; TOKEN];
        getrandom::fill(&mut bytes)
            .map_err(|error| format!("the system has no random numbers for a token: {error}"))?;
        Ok(Self { token: bytes.iter().map(|byte| format!("{byte:02x}")).collect(), at })
    }

    /// Returns the address of the page for a browser.
    pub(in crate::commands::serve) fn address(&self) -> String {
        format!("http://{}/{}/", self.at, self.token)
    }

    /// Returns the query if the request is allowed. A page of another site has no token, and its origin or host is not this server's.
    pub(in crate::commands::serve) fn admits(&self, request: &Request) -> Result<Query, Answer> {
        if !request.field("Host").is_some_and(|host| self.is_own(host)) {
            return Err(Answer::refused(403, "the address is not that of this server"));
        }
        let foreign = (request.field("Origin"))
            .is_some_and(|origin| !origin.strip_prefix("http://").is_some_and(|host| self.is_own(host)));
        let site = request.field("Sec-Fetch-Site").unwrap_or("none");
        if foreign || !["none", "same-origin"].contains(&site) {
            return Err(Answer::refused(403, "a page of another site has no business here"));
        }
        let (path, query) = request.target.split_once('?').unwrap_or((&request.target, ""));
        let (token, what) = path.trim_start_matches('/').split_once('/').unwrap_or(("", ""));
        if !same(token.as_bytes(), self.token.as_bytes()) {
            return Err(Answer::refused(403, "the address needs the token that `sensitol serve` has printed"));
        }
        let given = query.split('&').filter_map(|pair| pair.split_once('='));
        let given = given.map(|(name, value)| Some((decoded(name)?, decoded(value)?))).collect::<Option<_>>();
        let given = given.ok_or_else(|| Answer::refused(400, "the address is not UTF-8"))?;
        Ok(Query { what: what.to_owned(), given })
    }

    /// True if the host is an address of this server. A foreign name that DNS points here is refused.
    fn is_own(&self, host: &str) -> bool {
        let port = self.at.port();
        host == self.at.to_string()
            || (self.at.ip().is_loopback() && host == format!("localhost:{port}"))
            // The server listens on all addresses of the machine: any IP address with the right port is accepted.
            || (self.at.ip().is_unspecified()
                && host.parse::<SocketAddr>().is_ok_and(|address| address.port() == port))
    }
}

/// Compares in a time that does not depend on the position of a difference.
fn same(a: &[u8], b: &[u8]) -> bool {
    a.len() == b.len() && a.iter().zip(b).fold(0, |differs, (a, b)| differs | (a ^ b)) == 0
}

/// Decodes percent signs such as `%20`. Returns None if the result is not UTF-8.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let [first, after @ ..] = rest {
        rest = after;
        if *first == b'%' {
            let digits = std::str::from_utf8(after.get(..2)?).ok()?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &after[2..];
        } else {
            bytes.push(*first);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percent_signs_are_decoded() {
        assert_eq!(decoded("a%20b%C3%A9").as_deref(), Some("a bé"));
        for wrong in ["%", "%2", "%zz", "%ff"] {
            assert_eq!(decoded(wrong), None, "{wrong}");
        }
    }

    #[test]
    fn only_its_own_names_are_this_server() {
        let guard = |at: &str| Guard { token: "t".into(), at: at.parse().unwrap() };
        let local = guard("127.0.0.1:80");
        assert!(local.is_own("127.0.0.1:80") && local.is_own("localhost:80"));
        assert!(!local.is_own("evil.example:80") && !local.is_own("127.0.0.1:81") && !local.is_own("localhost"));
        assert!(guard("0.0.0.0:80").is_own("10.0.0.7:80") && !guard("0.0.0.0:80").is_own("evil.example:80"));
    }
}
