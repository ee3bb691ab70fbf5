//! Signals at random moments against runs with an external model and a journal: no corrupt journal, no orphan, no half file.
//!
//! `SENSITOL_STORM=400 cargo test -p sensitol-cli --test external storm` sends that many signals; without it a few.

use std::collections::BTreeMap;
use std::os::unix::process::ExitStatusExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol_external::journal::store::Store;
use sensitol_testing::repository;

/// Number of signals without `SENSITOL_STORM`: each of the four kinds three times.
const SIGNALS: usize = 12;
/// Longest time for a process to end. A run without a terminal waits 10 s for running evaluations, which take milliseconds here.
const PATIENCE: Duration = Duration::from_secs(60);
/// Number of dimensions: the method `full` evaluates `2n + 2n(n - 1) + 1` points.
const DIMENSIONS: usize = 9;

struct Storm {
    folder: tempfile::TempDir,
}

impl Storm {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        let children = folder.path().join("children");
        std::fs::create_dir(&children).unwrap();
        let script = repository("tests/children/storm.py").display().to_string();
        let dimensions: String =
            (0..DIMENSIONS).map(|d| format!("x{d} = {{ nominal = {d}.5, tolerance = 0.1 }}\n")).collect();
        let study = format!(
            "[model]\ncommand = [\"python3\", {script:?}, {:?}, \"0.005\"]\nworkers = 2\n[dimensions]\n{dimensions}\
             [characteristics]\ny = {{ lower = 0.0 }}\n[analysis]\nmethod = \"full\"\n",
            children.display().to_string()
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn run(&self, command: &str) -> Child {
        let mut run = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        run.arg(command).arg(self.path("study.toml")).args(["--json", "-o"]).arg(self.path("report.json"));
        match command {
            "simulate" => run.args(["--samples", "150", "--seed", "1", "--html"]).arg(self.path("page.html")),
            _ => run.arg("--csv").arg(self.path("tables")).arg("--html").arg(self.path("page.html")),
        };
        run.stdout(Stdio::null()).stderr(Stdio::piped()).spawn().unwrap()
    }

    /// Returns the processes that reported their id and still run the script.
    fn children(&self) -> Vec<u32> {
        let names = std::fs::read_dir(self.path("children")).unwrap().map(|entry| entry.unwrap().file_name());
        let pids = names.filter_map(|name| name.to_str()?.parse().ok());
        pids.filter(|&pid| runs_script(pid)).collect()
    }

    /// Returns the files of reports, tables and pages, and temporary ones.
    fn written(&self) -> BTreeMap<String, Vec<u8>> {
        let mut files = BTreeMap::new();
        for folder in [self.folder.path().to_owned(), self.path("tables")] {
            for entry in std::fs::read_dir(&folder).into_iter().flatten().map(Result::unwrap) {
                let name = entry.file_name().into_string().unwrap();
                let own = name.contains("journal") || name == "study.toml";
                if !own && entry.file_type().unwrap().is_file() {
                    files.insert(name, std::fs::read(entry.path()).unwrap());
                }
            }
        }
        files
    }
}

/// True if a process is alive and belongs to the test: its number may have been reused.
fn runs_script(pid: u32) -> bool {
    let said = Command::new("ps").args(["-o", "stat=,args=", "-p", &pid.to_string()]).output().unwrap();
    let text = String::from_utf8_lossy(&said.stdout).trim().to_owned();
    text.contains("storm.py") && !text.starts_with('Z')
}

fn ended(run: &mut Child) -> bool {
    let begun = Instant::now();
    while begun.elapsed() < PATIENCE {
        if run.try_wait().unwrap().is_some() {
            return true;
        }
        std::thread::sleep(Duration::from_millis(5));
    }
    run.kill().unwrap();
    false
}

/// Checks that a file is complete: it parses, or ends properly.
fn whole(name: &str, bytes: &[u8]) -> bool {
    let text = std::str::from_utf8(bytes).unwrap_or_default();
    match Path::new(name).extension().and_then(|ending| ending.to_str()) {
        Some("json") => serde_json::from_str::<serde_json::Value>(text).is_ok(),
        Some("html") => text.trim_end().ends_with("</html>"),
        // A table may have no rows, such as that of the warnings, and is empty if no section has it.
        Some("csv") => text.is_empty() || text.ends_with('\n'),
        _ => false,
    }
}

#[test]
fn no_signal_breaks_anything() {
    let signals = std::env::var("SENSITOL_STORM").ok().and_then(|text| text.parse().ok()).unwrap_or(SIGNALS);
    let storm = Storm::new();
    let journal = storm.path("study.journal.sqlite");
    // Duration of an undisturbed run, so that signals come at every stage of one.
    let begun = Instant::now();
    assert!(ended(&mut storm.run("analyze")));
    let latest = begun.elapsed().as_millis() as u64 * 6 / 5;
    let report =
        || -> serde_json::Value { serde_json::from_slice(&std::fs::read(storm.path("report.json")).unwrap()).unwrap() };
    let expected = report()["characteristics"].clone();
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(21);
    for round in 0..signals {
        let (signal, number) = [("INT", 2), ("TERM", 15), ("HUP", 1), ("KILL", 9)][round % 4];
        let command = ["analyze", "simulate"][round / 4 % 2];
        // Every third signal comes before the journal exists.
        if round % 3 == 0 {
            for entry in std::fs::read_dir(storm.folder.path()).unwrap().map(Result::unwrap) {
                if entry.file_name().to_string_lossy().contains("journal") {
                    std::fs::remove_file(entry.path()).unwrap();
                }
            }
        }
        storm.written().keys().for_each(|name| {
            let _ = std::fs::remove_file(storm.path(name))
                .or_else(|_| std::fs::remove_file(storm.path("tables").join(name)));
        });
        let mut run = storm.run(command);
        let after = rng.random_range(0..latest);
        let what = format!("SIG{signal} after {after} ms of {command}, round {round}");
        std::thread::sleep(Duration::from_millis(after));
        // A run that has ended gets no signal.
        let _ =
            Command::new("kill").args([&format!("-{signal}"), &run.id().to_string()]).stderr(Stdio::null()).status();
        assert!(ended(&mut run), "{what}: it does not end");
        let output = run.wait_with_output().unwrap();
        let said = String::from_utf8_lossy(&output.stderr).into_owned();
        // The run was finished, interrupted, or hit before it installed its handler.
        let by = output.status.signal();
        assert!(
            matches!(output.status.code(), Some(0 | 130)) || by == Some(number),
            "{what}: {:?}: {said}",
            output.status
        );
        assert!(!said.contains("panicked"), "{what}: {said}");
        let begun = Instant::now();
        while !storm.children().is_empty() {
            assert!(begun.elapsed() < PATIENCE, "{what}: {:?} are left", storm.children());
            std::thread::sleep(Duration::from_millis(10));
        }
        for (name, bytes) in storm.written() {
            // Only a killed process cannot remove its temporary files.
            if name.starts_with(".sensitol-") && by == Some(9) {
                std::fs::remove_file(storm.path(&name))
                    .or_else(|_| std::fs::remove_file(storm.path("tables").join(&name)))
                    .unwrap();
            } else {
                assert!(whole(&name, &bytes), "{what}: {name} is half a file: {}", String::from_utf8_lossy(&bytes));
            }
        }
        if journal.exists() {
            let connection = rusqlite::Connection::open(&journal).unwrap();
            let sound: String = connection.query_row("PRAGMA integrity_check", [], |row| row.get(0)).unwrap();
            assert_eq!(sound, "ok", "{what}");
            drop(connection);
            assert!(Store::open(&journal).is_ok(), "{what}: {:?}", Store::open(&journal).err());
        }
    }
    // The journal is valid after all signals.
    assert!(ended(&mut storm.run("analyze")));
    assert_eq!(report()["characteristics"], expected);
}
