//! Runs that a kill, a signal or a time limit ends at any moment, on models that flip: every later figure is right, or refused with a reason.

use std::io::Read;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::Duration;

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol_testing::child_in_c;
use serde_json::Value;

use super::command::sensitol;

/// Number of moments at which every kind of model is stopped.
const MOMENTS: usize = 40;
/// Number of dimensions.
const DIMENSIONS: usize = 4;
/// Commands that ask a model in different ways.
const COMMANDS: [&[&str]; 6] = [
    &["analyze", "--method", "full"],
    &["analyze", "--method", "auto"],
    &["analyze", "--method", "rss"],
    &["analyze", "--method", "second-order"],
    &["analyze", "--method", "classic"],
    &["simulate", "--samples", "40", "--seed", "1"],
];

/// End of a run before it was done.
#[derive(Debug, Clone, Copy)]
enum End {
    Kill,
    Terminate,
    TimeLimit,
}

struct Study {
    folder: tempfile::TempDir,
}

impl Study {
    /// A study of `flips.c`, whose answers take a millisecond each. Every answer of a model that errs by chance is replayed, since no wrong
    /// answer makes another one suspicious.
    fn new(mode: &str, seed: usize) -> Self {
        let verify = if mode == "stray" { "verify = 1000\n" } else { "" };
        let folder = tempfile::tempdir().unwrap();
        let dimensions: String =
            (0..DIMENSIONS).map(|d| format!("x{d} = {{ nominal = 1, tolerance = 0.3 }}\n")).collect();
        let study = format!(
            "[model]\ncommand = [{:?}, {mode:?}, \"{seed}\", \"1\"]\n{verify}[dimensions]\n{dimensions}[characteristics]\ny = {{ lower = -20, target_yield = 0.99 }}\n",
            child_in_c()
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Arguments of a command on the study, with its journal.
    fn arguments(&self, command: &[&str], more: &[&str]) -> Vec<String> {
        let study = self.path("study.toml").display().to_string();
        let words = [&command[..1], &[study.as_str(), "--json"], &command[1..], more].concat();
        words.into_iter().map(str::to_owned).collect()
    }

    /// Runs a command to its end.
    fn run(&self, command: &[&str], more: &[&str]) -> Output {
        sensitol(&self.arguments(command, more).iter().map(String::as_str).collect::<Vec<_>>()).output().unwrap()
    }

    /// Runs a command that ends after `after`. Returns its exit code and report, if it wrote one.
    fn end(&self, command: &[&str], end: End, after: Duration) -> (Option<i32>, Value) {
        if let End::TimeLimit = end {
            let output = self.run(command, &["--time", &after.as_secs_f64().to_string()]);
            return (output.status.code(), serde_json::from_slice(&output.stdout).unwrap_or_default());
        }
        let mut run = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        run.args(self.arguments(command, &[])).stdout(Stdio::piped()).stderr(Stdio::null());
        let mut run = run.spawn().unwrap();
        std::thread::sleep(after);
        let pid = run.id().to_string();
        let signal = if let End::Kill = end { "-KILL" } else { "-TERM" };
        Command::new("kill").args([signal, &pid]).stderr(Stdio::null()).status().unwrap();
        let mut text = String::new();
        run.stdout.take().unwrap().read_to_string(&mut text).unwrap();
        (run.wait().unwrap().code(), serde_json::from_str(&text).unwrap_or_default())
    }
}

/// Standard deviation in a report of `analyze` or `simulate`.
fn sigma(report: &Value) -> Option<f64> {
    report["characteristics"][0]["sigma"].as_f64()
}

fn report(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_default()
}

/// True if a figure with exit code 0 is that of the model without a memory.
fn is_right_or_refused(code: Option<i32>, report: &Value, expected: f64) -> bool {
    code != Some(0) || sigma(report).is_some_and(|found| (found - expected).abs() <= 1e-9 * expected)
}

/// Ends runs at many moments, and runs the same command three times more. Returns the silently wrong figures: of ended runs, and of later ones.
fn silently_wrong(mode: &str, moments: usize) -> Vec<String> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(52);
    let mut wrong = Vec::new();
    let mut undisturbed = 0;
    for moment in 0..moments {
        let command = COMMANDS[moment % COMMANDS.len()];
        let end = [End::Kill, End::Terminate, End::TimeLimit][moment % 3];
        let expected = sigma(&report(&Study::new("plain", moment).run(command, &[]))).unwrap();
        let study = Study::new(mode, moment);
        // Runs last 60 ms and more: 21 to 40 points, with replays of some or all of them.
        let after = Duration::from_micros(random.random_range(10_000..160_000));
        let (code, found) = study.end(command, end, after);
        undisturbed += usize::from(code == Some(0) && found["stopped"].is_null());
        if !is_right_or_refused(code, &found, expected) {
            wrong.push(format!(
                "{mode} {moment}: {command:?} ended by {end:?} after {after:?}: {:?} for {expected}",
                sigma(&found)
            ));
        }
        for again in 0..3 {
            let output = study.run(command, &[]);
            let found = report(&output);
            if !is_right_or_refused(output.status.code(), &found, expected) {
                wrong.push(format!(
                    "{mode} {moment}: {command:?} after {end:?} at {after:?}, run {again}: {:?} for {expected}",
                    sigma(&found)
                ));
            }
        }
    }
    assert!(undisturbed < moments / 2, "{mode}: {undisturbed} of {moments} runs were done before they were ended");
    wrong
}

#[test]
fn a_stop_never_makes_an_answer_true_of_a_model_that_toggles() {
    let wrong = silently_wrong("toggle", MOMENTS);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn a_stop_never_makes_an_answer_true_of_a_model_that_remembers() {
    let wrong = silently_wrong("pairs", MOMENTS);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// Answers that are wrong by chance, 3 in 100. No two wrong answers agree, so that a check of every answer finds each of them.
#[test]
fn a_stop_never_makes_an_answer_true_of_a_model_that_errs_by_chance() {
    let wrong = silently_wrong("stray", MOMENTS);
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A model without a memory loses nothing by a stop: the next run uses every answer of the journal.
#[test]
fn a_stop_loses_no_answer_of_a_model_without_memory() {
    let study = Study::new("plain", 1);
    let (code, _) = study.end(COMMANDS[0], End::Kill, Duration::from_millis(60));
    assert_eq!(code, None);
    let kept = kept_points(&study.path("study.journal.sqlite"));
    let found = report(&study.run(COMMANDS[0], &[]));
    assert_eq!(found["cached"].as_u64(), Some(kept));
}

/// Number of points with an answer in a journal.
fn kept_points(journal: &Path) -> u64 {
    let store = sensitol_external::journal::Store::open_existing(journal).unwrap();
    store.models().unwrap().iter().map(|model| model.points as u64).sum()
}

/// A stop during the replays leaves all answers of the batch without their check: a warning, the reason in JSON and text, exit code 3, and
/// no verdict.
#[test]
fn a_stop_during_the_check_is_told() {
    let study = Study::new("plain", 1);
    // 21 points take at least 21 ms, and the check of seven of them at least 28 ms more.
    let mut told = 0;
    for milliseconds in (30..120).step_by(6) {
        let _ = std::fs::remove_file(study.path("study.journal.sqlite"));
        let output = study.run(COMMANDS[0], &["--time", &(f64::from(milliseconds) / 1000.0).to_string(), "--check"]);
        let found = report(&output);
        if found["evaluator"]["unconfirmed"].as_u64().unwrap_or(0) == 0 {
            continue;
        }
        told += 1;
        let stderr = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(3), "{stderr}");
        assert_eq!(found["stopped"], "time-limit", "{found}");
        assert!(stderr.contains("[unconfirmed]") && stderr.contains("[stopped]"), "{stderr}");
        assert!(found["characteristics"][0]["met"].is_null(), "{found}");
    }
    assert!(told > 0, "no time limit fell into the check");
}

/// A flipped bit of a stored value never becomes a figure: the answer is evaluated again, and a warning names the file.
#[test]
fn a_flipped_bit_of_the_journal_is_noticed() {
    const BITS: usize = 50;
    let study = Study::new("plain", 1);
    let expected = sigma(&report(&study.run(COMMANDS[0], &[]))).unwrap();
    let journal = study.path("study.journal.sqlite");
    let whole = std::fs::read(&journal).unwrap();
    let store = sensitol_external::journal::Store::open_existing(&journal).unwrap();
    let values: Vec<f64> = store.answers(1).unwrap().into_iter().filter_map(|kept| kept.answer.ok()).collect();
    drop(store);
    let mut random = Xoshiro256PlusPlus::seed_from_u64(53);
    for _ in 0..BITS {
        // A database has its numbers with the highest byte first.
        let value = values[random.random_range(0..values.len())].to_be_bytes();
        let Some(place) = whole.windows(8).position(|bytes| bytes == value) else { continue };
        let mut damaged = whole.clone();
        damaged[place + random.random_range(0..8)] ^= 1 << random.random_range(0..8);
        std::fs::write(&journal, damaged).unwrap();
        let output = study.run(COMMANDS[0], &[]);
        let stderr = String::from_utf8_lossy(&output.stderr).into_owned();
        assert!(is_right_or_refused(output.status.code(), &report(&output), expected), "{stderr}");
        assert!(stderr.contains("study.journal.sqlite"), "{stderr}");
    }
}
