//! Messages that programs may send besides answers: heartbeats, starts, places, growing windows, withdrawn points. The child is
//! `tests/children/flips.c`, in another language than the SDK.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use sensitol::StopReason;
use sensitol::assembly::ProcessFault;
use sensitol::assembly::{AssemblyFunction, EvaluationError, Points, Request, Responses, Run, Signature};
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};
use sensitol_testing::{child_in_c, repository};

fn settings(mode: &str, more: &str) -> Settings {
    Settings::new([child_in_c(), mode.to_owned(), more.to_owned()]).with_sentinels(false).with_retries(0)
}

fn model(settings: Settings) -> Process {
    let greeting = Greeting::new(vec![1.0, 2.0]);
    Process::new(Signature::of_names(["a", "b"], ["y"]), greeting, settings)
}

fn at(model: &Process, a: &[f64], run: &Run<'_>) -> Responses {
    let rows: Vec<[f64; 2]> = a.iter().map(|&a| [a, 2.0]).collect();
    let mut out = Responses::open(rows.len(), 1);
    model.evaluate(&Request::values(&Points::from_rows(&rows), &[0]), run, &mut out);
    out
}

/// Returns the answers of a child without further messages, for the same seed.
fn plain(seed: &str, a: &[f64]) -> Vec<Option<f64>> {
    let out = at(&model(settings("plain", seed)), a, &Run::to_the_end());
    (0..a.len()).map(|row| out.value(row, 0)).collect()
}

fn points(count: usize) -> Vec<f64> {
    (0..count).map(|i| 1.0 + 0.01 * i as f64).collect()
}

/// Points in the program's own queue are not late as long as it sends heartbeats.
#[test]
fn a_queue_is_no_delay() {
    let a = points(10);
    // The first point waits for 3 s before it starts.
    let model = model(settings("queue", "1").with_timeout(Duration::from_millis(1500)));
    let out = at(&model, &a, &Run::to_the_end());
    assert_eq!((0..a.len()).map(|row| out.value(row, 0)).collect::<Vec<_>>(), plain("1", &a), "{:?}", out.error(0, 0));
    assert_eq!((model.account().unwrap().counts.starts, model.account().unwrap().counts.timeouts), (1, 0));
}

/// A started point has a time limit of its own, even if its program sends heartbeats.
#[test]
fn a_heartbeat_saves_no_point_that_hangs() {
    let model = model(settings("silent", "1").with_timeout(Duration::from_millis(500)));
    let out = at(&model, &[1.5], &Run::to_the_end());
    let Some(EvaluationError::Process(error)) = out.error(0, 0) else { panic!("{:?}", out.value(0, 0)) };
    assert!(matches!(error.fault, ProcessFault::TimedOut { .. }), "{error}");
    assert_eq!(model.account().unwrap().counts.timeouts, 1);
}

/// A program that accepts withdrawals loses only the point that hangs.
#[test]
fn a_point_that_hangs_is_taken_back() {
    let mut a = points(20);
    a[7] = 13.0;
    let model = model(settings("hangs", "2").with_timeout(Duration::from_millis(1500)));
    let out = at(&model, &a, &Run::to_the_end());
    for (row, expected) in plain("2", &a).into_iter().enumerate() {
        if row == 7 {
            assert!(out.error(row, 0).unwrap().to_string().contains("did not answer within 1.5 s"));
        } else {
            assert_eq!(out.value(row, 0), expected, "row {row}");
        }
    }
    assert_eq!((model.account().unwrap().counts.starts, model.account().unwrap().counts.timeouts), (1, 1));
}

/// After a crash of a program whose points are independent, all points under way are sent again, and none counts as failed. Its places
/// are known, and each of them evaluates the nominal point.
#[test]
fn places_and_a_crash() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("died").display().to_string();
    let notes = Arc::new(Mutex::new(Vec::new()));
    let heard = Arc::clone(&notes);
    let listener = move |line: &str| heard.lock().unwrap().push(line.to_owned());
    let settings = settings("cluster", &file).with_sentinels(true).with_verify(0).with_listener(Arc::new(listener));
    let model = model(settings);
    let a = points(60);
    let out = at(&model, &a, &Run::to_the_end());
    // Coefficients follow the second argument as a number. A path is not a number, which gives 0.
    assert_eq!((0..a.len()).map(|row| out.value(row, 0)).collect::<Vec<_>>(), plain("0", &a));
    let account = model.account().unwrap();
    assert_eq!(
        (account.counts.starts, account.counts.crashes, account.counts.timeouts, account.counts.garbage),
        (2, 1, 0, 0),
        "{account:?}"
    );
    // The points under way are sent again. The child read and answered some before it died.
    assert!((1..=8).contains(&account.counts.retried), "{account:?}");
    assert!(account.counts.lost_s > 0.0 && account.last.unwrap().to_string().contains("exit code 9"));
    let places: Vec<&str> = account.places.keys().map(String::as_str).collect();
    assert_eq!(places, ["east", "west"]);
    // Each point is answered once. At the end each place answers the nominal point, which counts as well.
    let (points, seconds) = account.places.values().fold((0, 0.0), |(p, s), (points, cost)| (p + points, s + cost));
    assert!(points >= 62 && seconds == 0.25 * points as f64, "{points} {seconds}");
    assert!(notes.lock().unwrap().iter().any(|note| note == "at east"));
}

/// A stop withdraws points that have not started. Late answers to them are ignored, and the program stays alive.
#[test]
fn a_stop_takes_points_back() {
    let model = model(settings("takes", "3"));
    let a = points(100);
    let answered = AtomicUsize::new(0);
    let finished = |rows: &[usize], _: &Responses| {
        answered.fetch_add(rows.len(), Ordering::Relaxed);
    };
    let stop = || (answered.load(Ordering::Relaxed) >= 10).then_some(StopReason::Requested);
    let out = at(&model, &a, &Run::to_the_end().telling(&finished).stopping_when(&stop));
    let expected = plain("3", &a);
    let known = (0..a.len()).filter(|&row| !out.is_open(row, 0)).count();
    assert!((10..100).contains(&known) && out.errors().count() == 0, "{known}");
    assert!((0..a.len()).all(|row| out.is_open(row, 0) || out.value(row, 0) == expected[row]));
    let out = at(&model, &a[50..], &Run::to_the_end());
    assert!((0..50).all(|row| out.value(row, 0) == expected[50 + row]));
    assert_eq!((model.account().unwrap().counts.starts, model.account().unwrap().counts.garbage), (1, 0));
}

/// One of many points under way crashes the child every time. Halving the set finds it, and the others are answered.
#[test]
fn halves_find_the_culprit() {
    let script = repository("tests/children/child.py").display().to_string();
    let argv = ["python3", &script, "crash-in-window", "64"];
    let greeting = Greeting::new(vec![1.0, 2.0]);
    let settings = Settings::new(argv).with_sentinels(false);
    let model = Process::new(Signature::of_names(["a", "b"], ["sum", "product"]), greeting, settings);
    let a: Vec<f64> = (0..200).map(f64::from).collect();
    let rows: Vec<[f64; 2]> = a.iter().map(|&a| [a, 2.0]).collect();
    let mut out = Responses::open(rows.len(), 2);
    model.evaluate(&Request::values(&Points::from_rows(&rows), &[0, 1]), &Run::to_the_end(), &mut out);
    for (row, &a) in a.iter().enumerate() {
        assert_eq!(out.value(row, 0), (row != 13).then_some(a + 2.0), "row {row}");
    }
    // 64 points need six halvings. The first crash, the culprit alone and its single retry come in addition.
    let account = model.account().unwrap();
    assert!(account.counts.crashes <= 6 + 3 && account.counts.starts == account.counts.crashes + 1, "{account:?}");
}

/// Returns the processes with this text in their command line.
#[cfg(target_os = "linux")]
fn living(text: &str) -> usize {
    let entries = std::fs::read_dir("/proc").into_iter().flatten().flatten();
    let told = |path: std::path::PathBuf| std::fs::read(path).unwrap_or_default();
    let named = |entry: &std::fs::DirEntry| {
        let command = String::from_utf8_lossy(&told(entry.path().join("cmdline"))).replace('\0', " ");
        // A zombie process has no command line.
        command.contains(text)
    };
    entries.filter(named).count()
}

/// A run whose model is busy with an endless point, and has started a process of its own.
#[cfg(target_os = "linux")]
struct Busy {
    _folder: tempfile::TempDir,
    run: std::process::Child,
    /// Word in the command lines of the model and of the process that it started.
    word: String,
}

#[cfg(target_os = "linux")]
impl Busy {
    fn start(name: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let word = format!("busy-{name}-{}", std::process::id());
        let script = "import json, subprocess, sys\nhello = sys.stdin.readline()\n\
            subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)', sys.argv[1]])\n\
            print(json.dumps({'ready': True}), flush=True)\nsys.stdin.readline()\nopen('busy', 'w').close()\nwhile True: pass\n";
        std::fs::write(folder.path().join("busy.py"), script).unwrap();
        let study = format!(
            "[model]\ncommand = [\"python3\", \"busy.py\", {word:?}]\ntimeout_s = 600\n\
             [dimensions]\na = {{ nominal = 1.0, tolerance = 0.1 }}\n[characteristics]\ny = {{}}\n"
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        let run = std::process::Command::new(assert_cmd::cargo::cargo_bin!("sensitol"))
            .args(["analyze", "study.toml", "--journal", "none"])
            .current_dir(folder.path())
            .stdout(std::process::Stdio::null())
            .stderr(std::process::Stdio::null())
            .spawn()
            .unwrap();
        let busy = folder.path().join("busy");
        until("the model is busy", || busy.exists());
        until("what it started is there", || living(&word) >= 2);
        Self { _folder: folder, run, word }
    }

    fn signal(&self, signal: &str) {
        let done = std::process::Command::new("kill").args([signal, &self.run.id().to_string()]).status();
        assert!(done.unwrap().success());
    }

    fn is_gone(&self) {
        until("nothing is left", || living(&self.word) == 0);
    }
}

/// Waits for an event that is certain to come, however busy the machine is.
#[cfg(target_os = "linux")]
fn until(what: &str, mut is: impl FnMut() -> bool) {
    let begun = std::time::Instant::now();
    while !is() {
        assert!(begun.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(20));
    }
}

/// `kill -9` of the engine ends a busy model and the process that it started.
#[test]
#[cfg(target_os = "linux")]
fn a_killed_engine_leaves_nothing_behind() {
    let mut busy = Busy::start("killed");
    busy.signal("-9");
    busy.run.wait().unwrap();
    busy.is_gone();
}

/// SIGTERM without a terminal waits a while for an endless point, then gives it up and reports the interruption.
#[test]
#[cfg(target_os = "linux")]
fn a_scheduler_need_not_kill() {
    for signal in ["-TERM", "-HUP"] {
        let mut busy = Busy::start(signal);
        busy.signal(signal);
        assert_eq!(busy.run.wait().unwrap().code(), Some(130), "{signal}");
        busy.is_gone();
    }
}
