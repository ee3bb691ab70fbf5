//! Requests that are too long, too slow, or never end, and connections that ask nothing.

use std::io::{Read, Write};
use std::net::TcpStream;
use std::process::Command;
use std::time::Duration;

use super::{SILENCE, STUDY, Server, status};

/// Line and host of a request that saves over the study.
fn overwriting(server: &Server) -> [String; 2] {
    let target = server.at("study?path=gap.toml&overwrite=yes");
    [format!("PUT {target} HTTP/1.1"), format!("Host: {}", server.at)]
}

#[track_caller]
fn study_is_as_it_was(server: &Server) {
    assert_eq!(std::fs::read_to_string(server.studies().join("gap.toml")).unwrap(), STUDY);
}

/// Nothing is allocated or waited for because a header says so, with the token or without.
#[test]
fn a_length_is_a_number_that_is_kept_to() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let [line, host] = overwriting(&server);
    // Fields, and the status with the token and without.
    let cases: [(&[&str], [u16; 2]); 12] = [
        (&["Content-Length: 100000000000"], [413, 403]),
        (&["Content-Length: 18446744073709551615"], [413, 403]),
        (&["Content-Length: 18446744073709551616"], [413, 403]),
        (&["Content-Length: -1"], [400, 400]),
        (&["Content-Length: +3"], [400, 400]),
        (&["Content-Length: three"], [400, 400]),
        (&["Content-Length:"], [400, 400]),
        (&["Content-Length: 3", "Content-Length: 3"], [400, 400]),
        (&["Content-Length: 3", "Content-Length: 4"], [400, 400]),
        (&["Transfer-Encoding: chunked"], [411, 411]),
        (&["Transfer-Encoding: chunked", "Content-Length: 3"], [411, 411]),
        (&[], [411, 403]),
    ];
    for (fields, expected) in cases {
        let stranger = server.status("PUT /study?path=gap.toml HTTP/1.1", fields, b"");
        assert_eq!([server.status(&line, fields, b""), stranger], expected, "{fields:?}");
        assert_eq!(server.get("studies").status, 200, "{fields:?}");
    }
    study_is_as_it_was(&server);
    // Curl asks before it sends a long text.
    let length = format!("Content-Length: {}", STUDY.len());
    let mut stream = server.send(&[&line, &host, &length, "Expect: 100-continue", ""], b"");
    let mut asked = [0; 25];
    stream.read_exact(&mut asked).unwrap();
    assert_eq!(&asked, b"HTTP/1.1 100 Continue\r\n\r\n");
    stream.write_all(STUDY.as_bytes()).unwrap();
    assert_eq!(status(&mut stream), 200);
}

#[test]
fn a_header_is_http_of_bounded_length() {
    let server = Server::with(&[]);
    let line = format!("GET {} HTTP/1.1", server.at("studies"));
    let long = |length: usize| format!("A: {}", "b".repeat(length));
    assert_eq!(server.status(&line, &[&long(20_000)], b""), 431);
    assert_eq!(server.status(&line, &["A: b"; 200], b""), 431);
    assert_eq!(server.status(&line, &[&format!("Host: {}", server.at)], b""), 400);
    assert_eq!(server.status(&line, &["no field"], b""), 400);
    assert_eq!(server.status(&line.replace("/1.1", "/1.0"), &[], b""), 505);
    assert_eq!(server.status(&line, &[&long(10_000)], b""), 200);
}

/// Two hundred connections that ask nothing give way, also if the program has fewer descriptors than they are.
#[test]
fn idle_connections_do_not_close_the_door() {
    let mut few = Command::new("sh");
    few.args(["-c", "ulimit -n 48 && exec \"$0\" \"$@\"", env!("CARGO_BIN_EXE_sensitol")]);
    for server in [Server::started(&[("gap.toml", STUDY)], few), Server::with(&[("gap.toml", STUDY)])] {
        let idle: Vec<TcpStream> = (0..200).map(|_| TcpStream::connect(server.at).unwrap()).collect();
        assert_eq!(server.get("study?path=gap.toml").status, 200);
        drop(idle);
        assert_eq!(server.get("studies").status, 200);
    }
}

/// A client that sends a byte now and then is not served for ever.
#[test]
fn a_request_that_drips_ends() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let [line, host] = overwriting(&server);
    // This text stops half-way, and is refused after a pause.
    let mut stopped = server.send(&[&line, &host, "Content-Length: 100", ""], b"[dimensions]");
    let mut dripping = server.send(&[&line, &host], b"A: ");
    let pause = Duration::from_millis(200);
    let ended = (0..SILENCE.as_millis() / pause.as_millis()).any(|_| {
        std::thread::sleep(pause);
        dripping.write_all(b"b").is_err()
    });
    assert!(ended, "the header may drip for ever");
    assert_eq!(status(&mut stopped), 400);
    study_is_as_it_was(&server);
}

/// Requests that have not arrived as a whole do not keep the program from ending.
#[test]
fn ctrl_c_ends_it_with_requests_that_hang() {
    let mut server = Server::with(&[("gap.toml", STUDY)]);
    let [line, host] = overwriting(&server);
    let hanging = [
        server.send(&[], b"GET"),
        server.send(&[&line, &host], b"A: "),
        server.send(&[&line, &host, "Content-Length: 18446744073709551615", ""], b"[dimensions]"),
        server.send(&[&line, &host, "Content-Length: 100", ""], b"[dimensions]"),
        server.send(&["PUT / HTTP/1.1", &host, "Content-Length: 100", ""], b"[dimensions]"),
    ];
    assert_eq!(server.get("studies").status, 200);
    Command::new("kill").args(["-INT", &server.child.id().to_string()]).status().unwrap();
    assert_eq!(server.child.wait().unwrap().code(), Some(0));
    drop(hanging);
    study_is_as_it_was(&server);
}
