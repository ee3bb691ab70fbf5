//! `sensitol watch`: a result at each save, an error that is told, and a clean end.
//!
//! Oracle: sigma of a difference of two normal dimensions by hand.

#![cfg(unix)]

use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

/// Longest wait for a line, on a busy machine.
const PATIENCE: Duration = Duration::from_secs(120);

/// Study of `a - b` with half bands of `3 a` and `3 b`: sigma is `hypot(a, b)`.
fn study(a: f64, b: f64) -> String {
    format!(
        "[dimensions]\na = {{ nominal = 10, tolerance = {}, unit = \"mm\" }}\nb = {{ nominal = 4, tolerance = {}, unit = \"mm\" }}\n\
         [characteristics]\ngap = {{ formula = \"a - b\", unit = \"mm\" }}\n",
        // Rounded, because a product has digits that nobody wrote.
        (300.0 * a).round() / 100.0,
        (300.0 * b).round() / 100.0
    )
}

/// Process that watches a study, with its lines as they come.
struct Watching {
    run: Child,
    out: Receiver<String>,
    err: Receiver<String>,
}

fn lines(from: impl std::io::Read + Send + 'static) -> Receiver<String> {
    let (send, receive) = channel();
    std::thread::spawn(move || {
        for line in BufReader::new(from).lines().map_while(Result::ok) {
            let _ = send.send(line);
        }
    });
    receive
}

impl Watching {
    fn start(folder: &Path, arguments: &[&str]) -> Self {
        let mut run = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"))
            .args(["watch", "gap.toml"])
            .args(arguments)
            .current_dir(folder)
            .env("LC_ALL", "C.UTF-8")
            .env_remove("COLUMNS")
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        let (out, err) = (lines(run.stdout.take().unwrap()), lines(run.stderr.take().unwrap()));
        Self { run, out, err }
    }

    #[track_caller]
    fn says(&self, expected: &str) {
        let line = self.out.recv_timeout(PATIENCE).unwrap();
        assert_eq!(line, expected);
    }

    fn ends(mut self) -> (Option<i32>, Vec<String>) {
        let done = Command::new("kill").args(["-INT", &self.run.id().to_string()]).status().unwrap();
        assert!(done.success());
        let code = self.run.wait().unwrap().code();
        (code, self.out.iter().chain(self.err.iter()).collect())
    }
}

/// Replaces the study as an editor does: a new file takes its name.
fn save(folder: &Path, text: &str) {
    let new: PathBuf = folder.join("gap.toml.new");
    std::fs::write(&new, text).unwrap();
    std::fs::rename(&new, folder.join("gap.toml")).unwrap();
}

#[test]
fn each_save_gives_a_line_and_the_difference() {
    let folder = tempfile::tempdir().unwrap();
    save(folder.path(), &study(0.03, 0.04));
    let watching = Watching::start(folder.path(), &[]);
    assert_eq!(watching.err.recv_timeout(PATIENCE).unwrap(), "watching gap.toml: Ctrl-C ends it");
    watching.says("gap mean 6.00000, sigma 0.050000 mm, no limits; b 64 %, a 36 %");
    // sigma = hypot(0.12, 0.05) = 0.13.
    save(folder.path(), &study(0.12, 0.05));
    watching.says("gap mean 6.00000, sigma 0.13000 mm, no limits; a 85 %, b 15 %");
    watching.says("  a tolerance ± 0.09 -> ± 0.36, b tolerance ± 0.12 -> ± 0.15");
    watching.says("  gap: sigma 0.050000 -> 0.13000");
    // An error is told on stderr, and watching goes on.
    save(folder.path(), &study(0.12, 0.05).replace("a - b", "a - c"));
    let told = watching.err.recv_timeout(PATIENCE).unwrap();
    assert!(told.starts_with("error: "), "{told}");
    save(folder.path(), &(study(0.12, 0.05) + "# a comment\n"));
    watching.says("gap mean 6.00000, sigma 0.13000 mm, no limits; a 85 %, b 15 %");
    watching.says("  nothing changed");
    let (code, rest) = watching.ends();
    assert_eq!(code, Some(0));
    assert!(!rest.iter().any(|line| line.contains("interrupted") || line.contains("panicked")), "{rest:?}");
}

/// Measured values are watched too: the mean of the values is that of the dimension.
#[test]
fn a_file_that_the_study_reads_is_watched() {
    let folder = tempfile::tempdir().unwrap();
    let values =
        |mean: f64| (0..20).map(|i| format!("{}\n", mean + 0.01 * f64::from(i % 2 * 2 - 1))).collect::<String>();
    std::fs::write(folder.path().join("a.csv"), "a\n".to_owned() + &values(1.0)).unwrap();
    save(
        folder.path(),
        "[dimensions]\na = { measured = \"a.csv\", nominal = 1, unit = \"mm\" }\n[characteristics]\ny = { formula = \"a\", unit = \"mm\" }\n",
    );
    let watching = Watching::start(folder.path(), &["-q"]);
    let first = watching.out.recv_timeout(PATIENCE).unwrap();
    assert!(first.starts_with("y mean 1.0000"), "{first}");
    std::fs::write(folder.path().join("a.csv"), "a\n".to_owned() + &values(2.0)).unwrap();
    let second = watching.out.recv_timeout(PATIENCE).unwrap();
    assert!(second.starts_with("y mean 2.0000"), "{second}");
    assert_eq!(watching.ends().0, Some(0));
}

#[test]
fn a_study_that_is_not_there_is_refused() {
    let output = super::command::sensitol(&["watch", "nowhere.toml"]).output().unwrap();
    assert_eq!(output.status.code(), Some(2));
    assert!(output.stdout.is_empty() && output.stderr.starts_with(b"error: "));
}
