//! Saves are whole or not at all, and none is lost to another one.

use std::net::Shutdown;
use std::sync::Barrier;

use super::{STUDY, Server, status};

/// An upload that ends before its length leaves the file as it was.
#[test]
fn a_save_that_is_cut_short_saves_nothing() {
    let server = Server::with(&[("gap.toml", STUDY)]);
    let line = format!("PUT {} HTTP/1.1", server.at("study?path=gap.toml&overwrite=yes"));
    let host = format!("Host: {}", server.at);
    let text = format!("{STUDY}# {}\n", "long ".repeat(600_000));
    let length = format!("Content-Length: {}", text.len());
    let saved = || std::fs::read_to_string(server.studies().join("gap.toml")).unwrap();
    for sent in [0, 1, 458_752, text.len() - 1] {
        let mut stream = server.send(&[&line, &host, &length, ""], &text.as_bytes()[..sent]);
        stream.shutdown(Shutdown::Write).unwrap();
        assert_eq!(status(&mut stream), 400, "{sent} bytes");
        assert!(saved() == STUDY, "{sent} bytes");
    }
    // Bytes beyond the length are not part of the text.
    let mut stream = server.send(&[&line, &host, &length, ""], format!("{text}beyond").as_bytes());
    assert_eq!(status(&mut stream), 200);
    assert!(saved() == text);
}

/// Simultaneous saves of one version: one is accepted, and the others hear that the file has changed.
#[test]
fn simultaneous_saves_do_not_overwrite_each_other() {
    /// Rounds: each one alone loses a save more often than not, without a lock.
    const ROUNDS: usize = 10;
    /// Saves at once in a round: fewer than the connections of a server.
    const SAVES: usize = 20;
    let server = Server::with(&[("gap.toml", STUDY)]);
    for round in 0..ROUNDS {
        let hash = server.get("study?path=gap.toml").json()["hash"].as_str().unwrap().to_owned();
        let begin = Barrier::new(SAVES);
        let save = &|save: usize| {
            let text = format!("{STUDY}# Round {round}, save {save}.\n");
            begin.wait();
            let answer = server.put(&format!("study?path=gap.toml&hash={hash}"), &text);
            (text, answer.status)
        };
        let answers: Vec<(String, u16)> = std::thread::scope(|scope| {
            let saves: Vec<_> = (0..SAVES).map(|number| scope.spawn(move || save(number))).collect();
            saves.into_iter().map(|save| save.join().unwrap()).collect()
        });
        assert!(answers.iter().all(|(_, status)| [200, 409].contains(status)), "{answers:?}");
        let accepted: Vec<&String> = answers.iter().filter(|answer| answer.1 == 200).map(|answer| &answer.0).collect();
        assert_eq!(accepted.len(), 1, "round {round}");
        assert_eq!(&std::fs::read_to_string(server.studies().join("gap.toml")).unwrap(), accepted[0]);
    }
    // No other file is left beside the study.
    assert_eq!(std::fs::read_dir(server.studies()).unwrap().count(), 1);
}
