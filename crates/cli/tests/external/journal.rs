//! Answers of external models are never lost: killed runs, shared journals, full disks, broken files, Ctrl-C.

use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};
use std::time::{Duration, Instant};

use rand::{RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;
use sensitol::assembly::{AssemblyFunction, Points, Request, Responses, Run, Signature};
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};

use sensitol_external::journal::store::{Store, StoredAnswer};
use sensitol_external::journal::{JournalFault, Journaled};
use sensitol_testing::{interrupt, repository};

/// Study with a slow child, in a folder of its own.
struct Slow {
    folder: tempfile::TempDir,
    workers: usize,
    window: usize,
}

impl Slow {
    /// Returns a study of `n` dimensions: `full` evaluates n² + n points and the nominal one.
    fn new(n: usize, seconds: f64, workers: usize, window: usize) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let counter = folder.path().join("count").display().to_string();
        let script = repository("tests/children/counting.py").display().to_string();
        let dimensions: String = (0..n).map(|d| format!("x{d} = {{ nominal = {d}.5, tolerance = 0.1 }}\n")).collect();
        let study = format!(
            "[model]\ncommand = [\"python3\", {script:?}, {counter:?}, \"{seconds}\", \"{window}\"]\nworkers = {workers}\nverify = 0\n\
             [dimensions]\n{dimensions}[characteristics]\ny = {{ lower = 0.0 }}\n[analysis]\nmethod = \"full\"\nverify = 0\n"
        );
        std::fs::write(folder.path().join("study.toml"), study).unwrap();
        Self { folder, workers, window }
    }

    /// Adds a cost for every tolerance, and a requirement.
    fn with_costs(self) -> Self {
        let (study, n) = (self.path("study.toml"), 4);
        let text =
            std::fs::read_to_string(&study).unwrap().replace("lower = 0.0", "lower = 24.5, require = { cpk = 1 }");
        let costs: String = (0..n).map(|d| format!("x{d} = {{ model = \"reciprocal\", b = 1 }}\n")).collect();
        std::fs::write(study, format!("{text}[costs]\n{costs}")).unwrap();
        self
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn command(&self, more: &[&str]) -> Command {
        self.doing("analyze", more)
    }

    fn doing(&self, what: &str, more: &[&str]) -> Command {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        command.arg(what).arg(self.path("study.toml")).arg("--json").args(more);
        command.stdout(Stdio::piped()).stderr(Stdio::piped());
        command
    }

    fn run(&self, more: &[&str]) -> Output {
        self.command(more).output().unwrap()
    }

    /// Counts the evaluations of the children in all runs, without those of the nominal point.
    fn evaluations(&self) -> usize {
        std::fs::metadata(self.path("count")).map_or(0, |file| file.len() as usize)
    }
}

/// Returns a report without the values that differ between runs.
fn result(output: &Output) -> serde_json::Value {
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let mut report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    for key in ["wall_s", "in_model_s", "evaluations", "cached", "retried", "stages", "study_sha256", "evaluator"] {
        report[key] = serde_json::Value::Null;
    }
    report
}

fn field(output: &Output, key: &str) -> u64 {
    let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    report[key].as_u64().unwrap()
}

#[test]
fn nothing_is_evaluated_twice() {
    let study = Slow::new(5, 0.0, 2, 4);
    let first = study.run(&[]);
    assert_eq!((field(&first, "cached"), study.evaluations()), (0, 30));
    // One more evaluation for each child that a sentinel checked.
    assert!((32..=33).contains(&field(&first, "evaluations")));
    // Only the nominal point is evaluated again.
    let second = study.run(&[]);
    assert_eq!((field(&second, "evaluations"), field(&second, "cached"), study.evaluations()), (1, 31, 30));
    assert_eq!(result(&first), result(&second));
    // A smaller method needs no new points if its nodes are the same.
    let axes = study.run(&["--method", "second-order"]);
    assert_eq!((field(&axes, "evaluations"), field(&axes, "cached")), (1, 11));
    // Without a journal everything is evaluated, and no file is left behind.
    study.run(&["--journal", "none"]);
    assert_eq!(study.evaluations(), 60);
    let elsewhere = study.path("elsewhere.sqlite");
    study.run(&["--journal", elsewhere.to_str().unwrap()]);
    assert_eq!((study.evaluations(), elsewhere.is_file()), (90, true));
}

/// Another tolerance reuses the unchanged nodes. Another constant or file makes another model.
#[test]
fn answers_belong_to_their_model() {
    let study = Slow::new(3, 0.0, 1, 1);
    let text = std::fs::read_to_string(study.path("study.toml")).unwrap();
    let evaluated = |text: &str| {
        std::fs::write(study.path("study.toml"), text).unwrap();
        let before = study.evaluations();
        assert!(study.run(&[]).status.success());
        study.evaluations() - before
    };
    assert_eq!(evaluated(&text), 12);
    // The nodes of one dimension move: its two, and four of the six corners of pairs.
    assert_eq!(evaluated(&text.replacen("tolerance = 0.1", "tolerance = 0.2", 1)), 6);
    assert_eq!(evaluated(&text.replace("[dimensions]", "[constants]\ng = 1.0\n[dimensions]")), 12);
    std::fs::write(study.path("part.txt"), "one").unwrap();
    let with_file = text.replace("workers", "files = [\"part.txt\"]\nworkers");
    assert_eq!(evaluated(&with_file), 12);
    assert_eq!(evaluated(&with_file), 0);
    std::fs::write(study.path("part.txt"), "two").unwrap();
    assert_eq!(evaluated(&with_file), 12);
    // The first model's answers are still known.
    assert_eq!(evaluated(&text), 0);
}

/// `kill -9` of the engine at twenty random moments: the result is that of an undisturbed run, and only points under way are evaluated
/// twice.
#[test]
fn killed_runs_go_on_where_they_were() {
    let study = Slow::new(13, 0.02, 2, 2);
    let begun = Instant::now();
    let undisturbed = result(&study.run(&["--journal", "none"]));
    // Moments up to two fifths of a whole run, which covers slow starts and answers on a slow machine too.
    let latest = (begun.elapsed().as_millis() * 2 / 5) as u64;
    let before = study.evaluations();
    assert_eq!(before, 182);
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(4);
    let mut kills = 0;
    for _ in 0..20 {
        let mut engine = study.command(&[]).spawn().unwrap();
        std::thread::sleep(Duration::from_millis(rng.random_range(1..latest)));
        engine.kill().unwrap();
        engine.wait().unwrap();
        kills += 1;
    }
    let resumed = study.run(&[]);
    assert_eq!(result(&resumed), undisturbed);
    // A child of a killed engine ends when its stdin is closed. Until then it finishes its points.
    std::thread::sleep(Duration::from_millis(200));
    let evaluations = study.evaluations() - before;
    assert!(evaluations <= 182 + kills * study.workers * study.window, "{evaluations}");
    assert!(field(&resumed, "cached") > 0, "some of it was kept");
}

/// A doubtful answer does not stay in the journal. The point that flips the model also flips the fresh child, so every run evaluates it
/// again. All other answers are kept in their final form.
#[test]
fn doubtful_answers_are_not_kept() {
    let folder = tempfile::tempdir().unwrap();
    let script = repository("tests/children/child.py").display().to_string();
    let settings = || Settings::new(["python3", &script, "flips"]).with_sentinels(true);
    let model = || {
        let greeting = Greeting::new(vec![1.0, 2.0]);
        let process = Process::new(Signature::of_names(["a", "b"], ["sum", "product"]), greeting, settings());
        Journaled::new(process, folder.path().join("a.sqlite"), Vec::new())
    };
    let a = [1.0, 2.0, 3.0, 13.0, 4.0, 5.0];
    let points = Points::from_rows(&a.map(|a| [a, 2.0]));
    let ask = || {
        let mut out = Responses::open(a.len(), 2);
        model().evaluate(&Request::values(&points, &[0, 1]), &Run::to_the_end(), &mut out);
        out
    };
    let first = ask();
    assert!(!first.non_repeatable().is_empty());
    let mut store = Store::open(&folder.path().join("a.sqlite")).unwrap();
    let known = store.models().unwrap().remove(0);
    let kept = store.answers(known.id).unwrap();
    assert!(kept.iter().all(|kept| kept.point[0] != 13.0), "{kept:?}");
    assert_eq!(kept.len(), 2 * 5);
    assert!(kept.iter().filter(|kept| kept.output == "sum").all(|kept| kept.answer == Ok(kept.point[0] + 2.0)));
    store.withdraw(known.id, &[vec![5.0, 2.0]]).unwrap();
    let second = ask();
    assert_eq!((first.count_reused(), second.count_reused()), (0, 4));
}

/// Two simultaneous runs on one journal: both are right, and no point is evaluated twice.
#[test]
fn runs_share_a_journal() {
    let study = Slow::new(6, 0.02, 1, 1);
    let both = [study.command(&[]).spawn().unwrap(), study.command(&[]).spawn().unwrap()];
    let both = both.map(|run| run.wait_with_output().unwrap());
    assert_eq!(result(&both[0]), result(&both[1]));
    assert_eq!(study.evaluations(), 42);
    assert_eq!(field(&study.run(&[]), "evaluations"), 1);
}

/// A killed run leaves its claim behind, on this machine or another one. Other runs do not wait long for it.
#[test]
fn a_claim_of_the_dead_holds_nobody_up() {
    let study = Slow::new(3, 0.0, 1, 1);
    let first = result(&study.run(&["--method", "second-order"]));
    let connection = rusqlite::Connection::open(study.path("study.journal.sqlite")).unwrap();
    let points: Vec<u8> = vec![0; 8];
    for host in ["elsewhere", ""] {
        let add = "INSERT INTO claim (model, beat, host, pid, points) SELECT id, 7, ?1, 4000000, ?2 FROM model";
        connection.execute(add, rusqlite::params![host, points]).unwrap();
    }
    assert_eq!(result(&study.run(&["--method", "second-order"])), first);
    assert_eq!(result(&study.run(&[])), result(&study.run(&["--journal", "none"])));
}

/// A model that depends on something outside the study, which has changed: the nominal point shows it, and no old answer is used.
#[test]
fn a_model_that_changed_is_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let script = "import json, sys\nsys.path.insert(0, sys.argv[1])\nfrom part import factor\nhello = json.loads(sys.stdin.readline())\n\
        print(json.dumps({'ready': True}), flush=True)\nfor line in sys.stdin:\n    request = json.loads(line)\n    \
        print(json.dumps({'id': request['id'], 'y': [factor * sum(request['x'])]}), flush=True)\n";
    std::fs::write(path("model.py"), script).unwrap();
    let study = format!(
        "[model]\ncommand = [\"python3\", \"-B\", \"model.py\", {:?}]\n[dimensions]\na = {{ nominal = 10, tolerance = 0.1 }}\n\
         b = {{ nominal = 5, tolerance = 0.2 }}\n[characteristics]\ny = {{}}\n[analysis]\nmethod = \"full\"\nverify = 0\n",
        folder.path()
    );
    std::fs::write(path("study.toml"), study).unwrap();
    let run = |factor: &str| {
        std::fs::write(path("part.py"), format!("factor = {factor}\n")).unwrap();
        let study = path("study.toml");
        let output = super::command::sensitol(&["analyze", study.to_str().unwrap(), "--json"]).output().unwrap();
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        let sigma = report["characteristics"][0]["sigma"].as_f64().unwrap();
        let warned = String::from_utf8(output.stderr).unwrap().contains("[outdated-journal]");
        (sigma, report["cached"].as_u64().unwrap(), warned)
    };
    // Sigmas are a third of the tolerances, and the sum is linear.
    let sigma = (0.01f64 + 0.04).sqrt() / 3.0;
    // The model's present value at the nominal point is known before the plan needs it.
    for (factor, cached, warns) in [(1.0, 0, false), (1.0, 7, false), (2.0, 1, true), (2.0, 7, false)] {
        let found = run(&factor.to_string());
        // Rounding of sums of 15 over differences of 0.1.
        assert!((found.0 - factor * sigma).abs() < 1e-12, "{factor}: {found:?}");
        assert_eq!((found.1, found.2), (cached, warns), "{factor}");
    }
}

/// A commit reaches the disk if the option for it is set.
#[test]
fn a_journal_may_be_durable() {
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(&folder.path().join("a.sqlite")).unwrap();
    assert!(!store.is_durable());
    store.set_durable(true).unwrap();
    assert!(store.is_durable());
    store.set_durable(false).unwrap();
    assert!(!store.is_durable());
}

/// A journal of the first version, without stages and claims, can be read and continued.
#[test]
fn an_older_journal_goes_on() {
    let study = Slow::new(3, 0.0, 1, 1);
    study.run(&[]);
    let connection = rusqlite::Connection::open(study.path("study.journal.sqlite")).unwrap();
    connection.execute_batch("DROP TABLE claim; DROP TABLE stage; ALTER TABLE answer DROP COLUMN stage").unwrap();
    drop(connection);
    let again = study.run(&[]);
    assert_eq!((field(&again, "evaluations"), field(&again, "cached"), study.evaluations()), (1, 13, 12));
}

/// A journal that many processes open at the very beginning is one journal for all of them.
#[test]
fn a_journal_may_be_made_by_many_at_once() {
    for _ in 0..20 {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.sqlite");
        let begin = std::sync::Barrier::new(8);
        std::thread::scope(|scope| {
            let open = || {
                begin.wait();
                Store::open(&path).unwrap().model("one", &["a".to_owned()]).unwrap()
            };
            let all: Vec<_> = (0..8).map(|_| scope.spawn(open)).collect();
            let ids: Vec<i64> = all.into_iter().map(|one| one.join().unwrap()).collect();
            assert_eq!(ids, [1; 8]);
        });
    }
}

/// Full disk: known and new answers are in the report or in the file, and the error names the cause.
#[test]
#[cfg(unix)]
fn a_full_disk_is_an_error_that_loses_nothing() {
    let study = Slow::new(12, 0.0, 1, 1);
    study.run(&["--method", "second-order"]);
    assert_eq!(study.evaluations(), 24);
    // The shell limits files to 100 blocks of 512 or 1024 bytes. The index has 32 KiB, and the log of so many commits is larger. The
    // signal that announces the limit is ignored.
    let engine = study.command(&[]);
    let line: Vec<String> = std::iter::once(engine.get_program())
        .chain(engine.get_args())
        .map(|word| format!("'{}'", word.to_str().unwrap()))
        .collect();
    let script = format!("trap '' XFSZ; ulimit -f 100; exec {}", line.join(" "));
    let full = Command::new("sh").args(["-c", &script]).output().unwrap();
    let error = String::from_utf8_lossy(&full.stderr).into_owned();
    // Without kept answers there is no result: one line names the cause, and JSON has it as the only error.
    assert_eq!(full.status.code(), Some(2), "{error}");
    let report: serde_json::Value = serde_json::from_slice(&full.stdout).unwrap();
    let codes: Vec<&str> =
        report["errors"].as_array().unwrap().iter().map(|one| one["code"].as_str().unwrap()).collect();
    assert_eq!((codes, report.get("characteristics")), (vec!["not-kept"], None));
    assert!(error.contains("disk") && error.contains("the same command goes on from there"), "{error}");
    assert_eq!(error.trim_end().lines().count(), 1, "{error}");
    assert!(study.evaluations() < 24 + 132);
    // With space again, the kept answers are there.
    let before = study.evaluations();
    let again = study.run(&[]);
    let reused = field(&again, "cached");
    assert!(reused >= 25);
    assert_eq!((study.evaluations() - before) as u64 + reused, 157);
}

#[test]
fn files_that_are_no_journals() {
    let folder = tempfile::tempdir().unwrap();
    let fault = |name: &str, bytes: &[u8]| {
        let path = folder.path().join(name);
        std::fs::write(&path, bytes).unwrap();
        let error = Store::open(&path).err().unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), bytes, "{name} is not touched");
        error.fault
    };
    assert_eq!(fault("text", &b"[dimensions]\n".repeat(100)), JournalFault::NotAJournal);
    // A database of another program.
    let other = folder.path().join("other.sqlite");
    let connection = rusqlite::Connection::open(&other).unwrap();
    connection.execute_batch("CREATE TABLE parts (name TEXT)").unwrap();
    drop(connection);
    assert_eq!(Store::open(&other).err().unwrap().fault, JournalFault::NotAJournal);
    // A journal written by a later version.
    let later = folder.path().join("later.sqlite");
    drop(Store::open(&later).unwrap());
    rusqlite::Connection::open(&later).unwrap().pragma_update(None, "user_version", 99).unwrap();
    assert_eq!(Store::open(&later).err().unwrap().fault, JournalFault::Later { found: 99 });
    assert_eq!(Store::open_existing(Path::new("nowhere.sqlite")).err().unwrap().fault, JournalFault::Missing);
    // A broken journal: the error names the fault, and the file stays for repair.
    let broken = folder.path().join("broken.sqlite");
    let mut store = Store::open(&broken).unwrap();
    let model = store.model("{}", &["x".to_owned()]).unwrap();
    let kept = |x: i32| StoredAnswer { point: vec![f64::from(x)], output: "y".into(), answer: Ok(f64::from(x)) };
    store.keep(model, &(0..2000).map(kept).collect::<Vec<_>>()).unwrap();
    drop(store);
    let mut bytes = std::fs::read(&broken).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle..middle + 4096].fill(0xff);
    std::fs::write(&broken, &bytes).unwrap();
    let failed = Store::open(&broken).and_then(|store| store.answers(model)).unwrap_err();
    assert!(
        matches!(failed.fault, JournalFault::Failed { .. }) && failed.to_string().contains("malformed"),
        "{failed}"
    );
}

/// Doubles are read back exactly, and a failed point keeps its reason.
#[test]
fn answers_are_kept_exactly() {
    let folder = tempfile::tempdir().unwrap();
    let mut store = Store::open(&folder.path().join("j.sqlite")).unwrap();
    let model = store.model("{}", &["x".to_owned()]).unwrap();
    let values = [0.1 + 0.2, -0.0, 5e-324, f64::MAX, 1.0 / 3.0];
    let kept = |&value: &f64| StoredAnswer { point: vec![value], output: "y".into(), answer: Ok(value) };
    store.keep(model, &values.iter().map(kept).collect::<Vec<_>>()).unwrap();
    for value in values {
        assert_eq!(store.answer(model, &[value], "y").unwrap(), Some(Ok(value)));
    }
    // 0 and -0 are one point.
    assert!(store.answer(model, &[0.0], "y").unwrap().is_some());
    assert_eq!(store.answer(model, &[0.3], "y").unwrap(), None, "0.1 + 0.2 is another point");
    let reason = StoredAnswer { point: vec![0.3], output: "y".into(), answer: Err("face 7 is gone".into()) };
    store.keep(model, &[reason]).unwrap();
    assert_eq!(store.answer(model, &[0.3], "y").unwrap(), Some(Err("face 7 is gone".into())));
    assert_eq!((store.models().unwrap()[0].values, store.models().unwrap()[0].errors), (5, 1));
}

/// Ctrl-C stops cleanly: results so far are reported, all answers are kept, and the exit code is 130.
#[test]
#[cfg(unix)]
fn ctrl_c_keeps_everything() {
    let study = Slow::new(13, 0.02, 1, 1);
    let engine = study.command(&[]).spawn().unwrap();
    while study.evaluations() < 20 {
        std::thread::sleep(Duration::from_millis(5));
    }
    interrupt(engine.id());
    let output = engine.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    let done = study.evaluations();
    assert!(done < 182);
    assert_eq!(field(&output, "evaluations") as usize, done + 1);
    let resumed = study.run(&[]);
    assert_eq!((field(&resumed, "cached") as usize, study.evaluations()), (done + 1, 182));
}

/// An allocation that is interrupted at any time keeps all answers, and writes no file and leaves none behind.
#[test]
#[cfg(unix)]
fn ctrl_c_ends_an_allocation() {
    let study = Slow::new(4, 0.02, 1, 1).with_costs();
    let written = study.path("new.toml").display().to_string();
    let arguments = ["--write", &written];
    // During the first analysis, and during the one at the tolerances found.
    for enough in [10, 30] {
        let engine = study.doing("allocate", &arguments).spawn().unwrap();
        while study.evaluations() < enough {
            std::thread::sleep(Duration::from_millis(5));
        }
        interrupt(engine.id());
        let output = engine.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(130), "{output:?}");
        let report: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
        assert_eq!((&report["status"], &report["confirmed"]), (&"out-of-time".into(), &false.into()));
        let names = std::fs::read_dir(study.folder.path()).unwrap().map(|entry| entry.unwrap().file_name());
        let left: Vec<String> = names.map(|name| name.into_string().unwrap()).collect();
        let strange = |name: &&String| name.starts_with("new") || name.starts_with(".sensitol");
        assert_eq!(left.iter().find(strange), None, "{left:?}");
    }
    let done = study.evaluations();
    let resumed = study.doing("allocate", &arguments).output().unwrap();
    assert_eq!(resumed.status.code(), Some(0), "{resumed:?}");
    let report: serde_json::Value = serde_json::from_slice(&resumed.stdout).unwrap();
    assert_eq!((&report["status"], &report["confirmed"]), (&"local-optimum".into(), &true.into()));
    // The nominal point is kept too, but counted once, because all rounds share it.
    assert!(report["cached"].as_u64().unwrap() as usize > done, "{done} {}", report["cached"]);
    assert!(Path::new(&written).exists());
}

/// The second Ctrl-C does not wait for an evaluation of a minute.
#[test]
#[cfg(unix)]
fn ctrl_c_twice_gives_up_what_is_under_way() {
    let study = Slow::new(3, 60.0, 1, 1);
    let engine = study.command(&[]).spawn().unwrap();
    let started = Instant::now();
    while !study.path("study.journal.sqlite").exists() && started.elapsed() < Duration::from_secs(60) {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(500));
    let begun = Instant::now();
    interrupt(engine.id());
    std::thread::sleep(Duration::from_millis(200));
    interrupt(engine.id());
    let output = engine.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(130));
    assert!(begun.elapsed() < Duration::from_secs(20), "it did not wait for the minute");
}

/// The command `journal`: content as text and as a table, and deletion.
#[test]
fn the_journal_can_be_read() {
    let study = Slow::new(2, 0.0, 1, 1);
    study.run(&[]);
    let file = study.path("study.journal.sqlite").display().to_string();
    let journal = |arguments: &[&str]| {
        let output =
            Command::new(assert_cmd::cargo::cargo_bin!("sensitol")).arg("journal").args(arguments).output().unwrap();
        (
            output.status.code().unwrap(),
            String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap(),
        )
    };
    let (code, shown) = journal(&["show", &file]);
    assert!(
        code == 0 && shown.contains("adapter counting, version 1") && shown.contains("7 points, 7 values"),
        "{shown}"
    );
    let (code, table) = journal(&["export", &file]);
    assert!(code == 0 && table.starts_with("x0,x1,y,y error\n") && table.lines().count() == 8, "{table}");
    assert_eq!(journal(&["export", &file, "--model", "7"]).0, 2);
    assert_eq!(journal(&["show", "nowhere.sqlite"]).0, 2);
    assert_eq!(journal(&["forget"]).0, 2);
    // Without a terminal, answers that took hours are neither deleted by mistake nor overwritten.
    let (code, asked) = journal(&["forget", &file]);
    assert!(code == 2 && asked.contains("7 answers would be forgotten") && asked.contains("--yes"), "{asked}");
    let (code, kept) = journal(&["export", &file, "-o", &file]);
    assert!(code == 2 && kept.contains("is the journal itself, which would be lost"), "{kept}");
    assert!(journal(&["show", &file]).1.contains("7 points"));
    assert_eq!(journal(&["forget", &file, "--yes"]), (0, "7 answers forgotten\n".into()));
    study.run(&[]);
    assert_eq!(study.evaluations(), 12);
}

/// Points evaluated elsewhere: written, answered and read. No process starts, and rows that do not match are named.
#[test]
fn points_may_be_evaluated_elsewhere() {
    let study = Slow::new(3, 0.0, 1, 1);
    let sensitol = |arguments: &[&str]| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        command.arg(arguments[0]).arg(study.path("study.toml")).args(&arguments[1..]).output().unwrap()
    };
    let points = study.path("points.csv").display().to_string();
    assert!(sensitol(&["plan", "--write-points", &points]).status.success());
    let answered = study.path("answers.csv").display().to_string();
    let write = |rows: usize, digits: usize, more: &str| {
        let text = std::fs::read_to_string(&points).unwrap();
        let mut lines = text.lines();
        let mut table = format!("{},y\n", lines.next().unwrap());
        for line in lines.take(rows) {
            let x: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            let y = x[0] + 2.0 * x[1] + 3.0 * x[2] + 0.01 * x[0] * x[1];
            let cells: Vec<String> = x.iter().map(|x| format!("{x:.digits$}")).collect();
            table += &format!("{},{y}\n", cells.join(","));
        }
        std::fs::write(&answered, table + more).unwrap();
    };
    write(99, 17, "");
    let all = sensitol(&["analyze", "--json", "--points", &answered]);
    assert_eq!((field(&all, "evaluations"), field(&all, "cached"), study.evaluations()), (0, 13, 0));
    assert_eq!(result(&all)["characteristics"], result(&study.run(&[]))["characteristics"]);
    // Fifteen digits, as in a spreadsheet, and a point that the plan does not contain.
    write(99, 14, "9,9,9,1\n");
    let rounded = sensitol(&["analyze", "--points", &answered]);
    let error = String::from_utf8_lossy(&rounded.stderr).into_owned();
    assert!(rounded.status.success() && error.contains("unmatched-points") && error.contains("line 15"), "{error}");
    // Some answers are missing.
    write(9, 17, "");
    let counted = sensitol(&["analyze", "--json", "--points", &answered]);
    assert_eq!((field(&counted, "evaluations"), field(&counted, "cached")), (0, 9));
    let few = sensitol(&["analyze", "--points", &answered]);
    let error = String::from_utf8_lossy(&few.stderr).into_owned();
    assert!(error.contains("4 points have no answer") && error.contains("no answer is given"), "{error}");
    // Tables that are invalid.
    let refused = |table: &str| {
        std::fs::write(&answered, table).unwrap();
        let output = sensitol(&["analyze", "--points", &answered]);
        assert_eq!(output.status.code(), Some(2));
        String::from_utf8(output.stderr).unwrap()
    };
    assert!(refused("x0,x1,y\n1,2,3\n").contains("no column `x2`"));
    assert!(refused("x0,x1,x2,x0\n1,2,3,4\n").contains("column `x0` stands twice"));
    assert!(refused("x0,x1,x2,y\n1,2,3,many\n").contains("line 2, column `y`: `many` is not a finite number"));
    assert!(refused("x0,x1,x2,y\n1,2\n").contains("answers.csv"));
    // A column that does not match the characteristic is an error.
    assert!(refused("x0,x1,x2,Y\n1,2,3,4\n").contains("no column `y`; there is `Y`"));
    assert!(refused("x0,x1,x2,weight\n1,2,3,4\n").contains("no column `y`"));
    assert!(refused("x0,x1,x3,y\n1,2,3,4\n").contains("no column `x2`; there is `x"));
    // Points without any matching answer are counted as points.
    std::fs::write(&answered, "x0,x1,x2,y\n9,9,9,1\n").unwrap();
    let none = sensitol(&["analyze", "--points", &answered]);
    let error = String::from_utf8_lossy(&none.stderr).into_owned();
    let told = error.split("`y` has no value at ").nth(1).unwrap_or_else(|| panic!("{error}"));
    let counts: Vec<usize> = told.split(' ').filter_map(|word| word.parse().ok()).take(2).collect();
    assert!(counts[0] >= 13 && counts[0] == counts[1], "{error}");
}

/// All stages evaluated elsewhere: missing points are written, answered and appended until none is missing. There is no sampling, and the
/// result is that of the function.
#[test]
fn all_stages_may_be_evaluated_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let rest = "[dimensions]\na = { nominal = 1, tolerance = 0.6 }\nb = { nominal = 2, tolerance = 0.6 }\n\
                c = { nominal = 3, tolerance = 0.6, distribution = \"uniform\" }\n[characteristics]\n";
    let y = |x: &[f64]| (0.4 * x[0]).exp() * x[1] + x[1] * x[2];
    let elsewhere = format!("[model]\ncommand = [\"nobody-starts-this\"]\n{rest}y = {{}}\n");
    std::fs::write(at("elsewhere.toml"), elsewhere).unwrap();
    let sensitol = |arguments: &[&str]| {
        let output = Command::new(assert_cmd::cargo::cargo_bin!("sensitol")).args(arguments).output().unwrap();
        let error = String::from_utf8_lossy(&output.stderr).into_owned();
        (output, error)
    };
    let (points, answers, next) = (at("points.csv"), at("answers.csv"), at("next.csv"));
    let wanted = ["--accuracy", "1e-5"];
    let answered = |path: &str| -> Vec<String> {
        let text = std::fs::read_to_string(path).unwrap();
        assert_eq!(text.lines().next(), Some("a,b,c"));
        let answer = |line: &str| {
            let x: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            format!("{line},{}", y(&x))
        };
        text.lines().skip(1).map(answer).collect()
    };
    let (planned, error) =
        sensitol(&[&["plan", &at("elsewhere.toml"), "--write-points", &points][..], &wanted].concat());
    assert!(planned.status.success() && error.contains("--write-missing"), "{error}");
    let mut table = vec!["a,b,c,y".to_owned()];
    table.extend(answered(&points));
    let study = at("elsewhere.toml");
    let analyze = [&["analyze", &study, "--points", &answers, "--json"][..], &wanted].concat();
    let missing = |count: usize| {
        if count == 1 { "1 point has no answer.".to_owned() } else { format!("{count} points have no answer.") }
    };
    let mut rounds = 0;
    let last = loop {
        std::fs::write(&answers, table.join("\n") + "\n").unwrap();
        let (told, error) = sensitol(&analyze);
        let (output, written) = sensitol(&[&analyze[..], &["--write-missing", &next]].concat());
        let more = answered(&next);
        if more.is_empty() {
            assert!(!error.contains("missing-points") && told.status.success(), "{error}");
            break output;
        }
        assert!(error.contains(&missing(more.len())) && error.contains("--write-missing"), "{error}");
        assert!(written.contains(&format!("append the answers to the points of {next}")), "{written}");
        table.extend(more);
        rounds += 1;
        assert!(rounds < 30, "it comes to an end");
    };
    assert!(rounds >= 1, "one stage was not all of it");
    // All requested points were used, and no row belongs to a point that was not requested.
    assert_eq!(field(&last, "cached") as usize, table.len() - 1);
    // Exact by hand: b (exp(0.4 a) + c) with independent factors: a normal with mean 1 and sigma 0.2, b normal with 2 and 0.2, c uniform.
    let (first, second) = (0.4032f64.exp(), 0.8128f64.exp());
    let mean = 2.0 * (first + 3.0);
    let sigma = (4.04 * (second + 6.0 * first + 9.12) - mean * mean).sqrt();
    let report: serde_json::Value = serde_json::from_slice(&last.stdout).unwrap();
    let of = |key: &str| report["characteristics"][0][key].as_f64().unwrap();
    // Five points of each dimension and every pair leave out products of three and higher powers.
    assert!((of("mean") - mean).abs() < 1e-4 * sigma, "{} {mean}", of("mean"));
    assert!((of("sigma") - sigma).abs() < 1e-3 * sigma, "{} {sigma}", of("sigma"));
    // `--write-missing` requires --points, and overwrites nothing.
    assert_eq!(sensitol(&["analyze", &at("elsewhere.toml"), "--write-missing", &next]).0.status.code(), Some(2));
    let onto = sensitol(&[&analyze[..], &["--write-missing", &answers]].concat());
    assert!(
        onto.0.status.code() == Some(2) && onto.1.contains("is read by --points, which would be lost"),
        "{}",
        onto.1
    );
}

/// A study that is moved with its program and its journal is the same study, because paths start from its folder.
#[test]
fn a_study_may_be_moved() {
    let folder = tempfile::tempdir().unwrap();
    let (here, there) = (folder.path().join("here"), folder.path().join("there"));
    std::fs::create_dir(&here).unwrap();
    let text = std::fs::read_to_string(repository("adapters/PROTOCOL.md")).unwrap();
    let start = text.find("```python\n").unwrap() + 10;
    std::fs::write(here.join("gap.py"), &text[start..start + text[start..].find("```").unwrap()]).unwrap();
    let study = "[model]\ncommand = [\"python3\", \"gap.py\"]\n[dimensions]\na = { nominal = 3, tolerance = 0.3 }\n\
                 b = { nominal = 2, tolerance = 0.3 }\n[characteristics]\ngap = {}\n";
    std::fs::write(here.join("study.toml"), study).unwrap();
    let run = |folder: &Path| {
        let mut command = Command::new(assert_cmd::cargo::cargo_bin!("sensitol"));
        command.arg("analyze").arg(folder.join("study.toml")).args(["--json", "--method", "full"]).output().unwrap()
    };
    assert_eq!(field(&run(&here), "cached"), 0);
    std::fs::rename(&here, &there).unwrap();
    let moved = run(&there);
    // Seven points of the method, twelve check points near the means, and four where decisions fall: two of six would check the same as
    // others.
    assert_eq!((field(&moved, "evaluations"), field(&moved, "cached")), (1, 7 + 12 + 4));
    // Another program is another model.
    let script = there.join("gap.py");
    let changed = std::fs::read_to_string(&script).unwrap().replace(" - ", " + ");
    std::fs::write(&script, changed).unwrap();
    assert_eq!(field(&run(&there), "cached"), 0);
}
