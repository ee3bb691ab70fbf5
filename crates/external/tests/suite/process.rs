//! External programs: their correct behaviour, and all their faults. The children are in `tests/children`.

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::{Duration, Instant};

use sensitol::assembly::{AssemblyFunction, EvaluationError, Points, Request, Responses, Run, Signature};
use sensitol::assembly::{Exit, ProcessFault};
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};

use sensitol::rare::{RareOptions, rare};
use sensitol::simulation::{SimulationOptions, simulate};
use sensitol::{Characteristic, Dimension, Problem, SpecLimits, StopReason};
use sensitol_testing::repository;

/// Longest wait of a test for an event that is sure to come, even on a busy machine.
const PATIENCE: Duration = Duration::from_secs(60);

/// Settings of a child in a mode. Only the slow modes reach the deadlines.
fn settings(mode: &str, more: &[&str]) -> Settings {
    let script = repository("tests/children/child.py").display().to_string();
    let argv = ["python3", &script, mode].into_iter().chain(more.iter().copied());
    // Without sentinels, whose evaluations would be counted too. They have tests of their own.
    let patient = Duration::from_secs(20);
    Settings::new(argv).with_timeout(patient).with_start_timeout(patient).with_sentinels(false)
}

fn model(settings: Settings) -> Process {
    let greeting = Greeting::new(vec![1.0, 2.0]);
    Process::new(Signature::of_names(["a", "b"], ["sum", "product"]), greeting, settings)
}

/// Both outputs at these values of `a`, with b = 2.
fn at(model: &Process, a: &[f64]) -> Responses {
    at_within(model, a, &Run::to_the_end())
}

fn at_within(model: &Process, a: &[f64], run: &Run<'_>) -> Responses {
    let rows: Vec<[f64; 2]> = a.iter().map(|&a| [a, 2.0]).collect();
    let points = Points::from_rows(&rows);
    let mut out = Responses::open(rows.len(), 2);
    model.evaluate(&Request::values(&points, &[0, 1]), run, &mut out);
    out
}

/// Asserts that all rows except `wrong` have the right values.
#[track_caller]
fn right_but(a: &[f64], out: &Responses, wrong: &[usize]) {
    for (row, &a) in a.iter().enumerate() {
        if !wrong.contains(&row) {
            let found = (out.value(row, 0), out.value(row, 1));
            assert_eq!(found, (Some(a + 2.0), Some(2.0 * a)), "row {row}: {:?}", out.error(row, 0));
        }
    }
}

/// The fault at an entry.
#[track_caller]
fn fault(out: &Responses, row: usize, output: usize) -> ProcessFault {
    match out.error(row, output) {
        Some(EvaluationError::Process(error)) => error.fault.clone(),
        other => panic!("row {row}, output {output}: {other:?}"),
    }
}

const POINTS: [f64; 5] = [1.0, 2.5, 13.0, 1e-300, -0.1];

#[test]
fn points_are_answered_exactly() {
    let model = model(settings("good", &[]));
    let out = at(&model, &POINTS);
    right_but(&POINTS, &out, &[]);
    assert_eq!(out.extra(), 0);
    let adapter = model.adapter(&[0, 1]).unwrap();
    assert_eq!(
        (adapter.name.as_deref(), adapter.version.as_deref(), adapter.window),
        (Some("test child"), Some("3"), 1)
    );
    // Numbers arrive as the same doubles: 0.1 + 0.2 is not 0.3.
    assert_eq!(at(&model, &[0.1 + 0.2]).value(0, 0), Some(0.1 + 0.2 + 2.0));
}

/// A child receives only the requested outputs. Other outputs need another child.
#[test]
fn a_child_is_asked_for_what_is_needed() {
    let model = model(settings("good", &[]));
    let points = Points::from_rows(&[[3.0, 4.0]]);
    let mut sum = Responses::open(1, 1);
    model.evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut sum);
    assert_eq!(sum.value(0, 0), Some(7.0));
    right_but(&POINTS, &at(&model, &POINTS), &[]);
}

#[test]
fn answers_may_come_in_any_order() {
    let a: Vec<f64> = (0..40).map(f64::from).chain([99.0]).collect();
    let out = at(&model(settings("out-of-order", &["8"])), &a);
    right_but(&a, &out, &[]);
}

/// Children work side by side. Every row is reported once, when it is final.
#[test]
fn workers_share_the_points() {
    let settings = settings("slow", &["0.01"]).with_workers(3);
    let model = model(settings);
    let a: Vec<f64> = (0..60).map(f64::from).collect();
    let points = Points::from_rows(&a.iter().map(|&a| [a, 2.0]).collect::<Vec<_>>());
    let told = AtomicUsize::new(0);
    let hear = |rows: &[usize], out: &Responses| {
        assert!(rows.iter().all(|&row| out.value(row, 0).is_some()));
        told.fetch_add(rows.len(), Ordering::Relaxed);
    };
    let mut out = Responses::open(a.len(), 2);
    model.evaluate(&Request::values(&points, &[0, 1]), &Run::to_the_end().telling(&hear), &mut out);
    right_but(&a, &out, &[]);
    assert_eq!(told.load(Ordering::Relaxed), 60);
}

/// A fault that prevents any use of a model is found before a point is sent.
#[test]
fn models_that_cannot_start() {
    let fault_of = |settings: Settings| match model(settings).prepare(&[0, 1]) {
        Err(EvaluationError::Process(error)) => *error,
        other => panic!("{other:?}"),
    };
    let error = fault_of(settings("crash-at-start", &[]));
    assert_eq!(error.fault, ProcessFault::EndedAtStart { exit: Exit::Code(7) });
    assert!(error.to_string().contains("licence server not found"), "{error}");
    let silent = fault_of(settings("silent-exit", &[]));
    assert_eq!(silent.fault, ProcessFault::EndedAtStart { exit: Exit::Code(0) });
    let never = settings("never-ready", &[]).with_start_timeout(Duration::from_millis(300));
    assert!(matches!(fault_of(never).fault, ProcessFault::SilentAtStart { .. }));
    let talks = fault_of(settings("talks-first", &[])).to_string();
    assert!(talks.contains("Loading CAD kernel 7.3"), "{talks}");
    assert!(talks.contains("stdout belongs to the protocol: print to stderr"), "{talks}");
    assert!(matches!(fault_of(settings("answers-first", &[])).fault, ProcessFault::NotReady { .. }));
    let refuses = fault_of(settings("refuses", &[])).to_string();
    assert!(refuses.contains("no dimension `b`; there are a, c"), "{refuses}");
    let version = fault_of(settings("other-version", &[])).to_string();
    assert!(version.contains("version 2"), "{version}");
    let program = |program: &str| fault_of(Settings::new([program]).with_folder(repository("tests"))).fault;
    assert!(matches!(program("no-such-program"), ProcessFault::NotFound { .. }));
    assert!(matches!(program("./no-such-program"), ProcessFault::NotFound { .. }));
    // The file is not a program.
    assert!(matches!(program("./children/child.py"), ProcessFault::NotStarted { .. }));
    let moved = settings("good", &[]).with_folder(PathBuf::from("/nowhere"));
    assert!(matches!(fault_of(moved).fault, ProcessFault::NotStarted { .. }));
}

/// A point with a fault of the child fails after one retry, with the right error. All other points have values.
#[test]
fn a_point_that_goes_wrong_takes_no_other_with_it() {
    type Is = fn(&ProcessFault) -> bool;
    let cases: [(&str, Is); 7] = [
        ("crash", |fault| matches!(fault, ProcessFault::Crashed { exit: Exit::Code(139) })),
        ("garbage", |fault| matches!(fault, ProcessFault::Garbage { line, .. } if line.0.contains("recompute failed"))),
        (
            "no-answer",
            |fault| matches!(fault, ProcessFault::Garbage { reason, .. } if reason.contains("neither y nor error")),
        ),
        ("wrong-length", |fault| *fault == ProcessFault::WrongLength { expected: 2, found: 3 }),
        ("wrong-gradients", |fault| *fault == ProcessFault::WrongGradients { rows: 2, columns: 2 }),
        ("wrong-id", |fault| matches!(fault, ProcessFault::UnknownPoint { .. })),
        ("huge-line", |fault| matches!(fault, ProcessFault::Oversized { .. })),
    ];
    for (mode, is) in cases {
        let model = model(settings(mode, &[]));
        let out = at(&model, &POINTS);
        right_but(&POINTS, &out, &[2]);
        for output in 0..2 {
            let fault = fault(&out, 2, output);
            assert!(is(&fault), "{mode}: {fault:?}");
            // The advice to print to stderr belongs to lines for people only.
            assert_eq!(fault.to_string().contains("print to stderr"), mode == "garbage", "{mode}: {fault}");
        }
        // One retry, which is counted. A complete line with the wrong number of values needs no retry.
        assert_eq!(out.extra(), if ["wrong-length", "wrong-gradients"].contains(&mode) { 0 } else { 1 }, "{mode}");
        // The model continues to work.
        right_but(&POINTS[..2], &at(&model, &POINTS[..2]), &[]);
    }
    let out = at(&model(settings("crash", &[])), &POINTS);
    assert!(out.error(2, 0).unwrap().to_string().contains("Segmentation fault in sketch solver"));
}

/// NaN and infinities, as Python's json writes them, count as no value. The process continues.
#[test]
fn numbers_that_are_not_finite_cost_no_restart() {
    let model = model(settings("nan-text", &[]));
    let out = at(&model, &POINTS);
    right_but(&POINTS, &out, &[2]);
    assert_eq!(fault(&out, 2, 0), ProcessFault::NoValue { message: "the model returned NaN or an infinity".into() });
    assert_eq!((out.value(2, 1), out.extra(), model.account().unwrap().counts.starts), (Some(1.0), 0, 1));
}

/// After a second answer to a point the first one counts. The child gets no further point.
#[test]
fn an_answer_given_twice() {
    let model = model(settings("twice", &[]).with_retries(0));
    let a = [1.0, 13.0, 3.0];
    let out = at(&model, &a);
    assert_eq!(out.value(1, 0), Some(15.0));
    right_but(&a[..1], &out, &[]);
    // The second answer was noticed either with the third point under way, which is charged with it, or before that was sent.
    if out.value(2, 0).is_none() {
        assert!(matches!(fault(&out, 2, 0), ProcessFault::AnsweredTwice { .. }));
    }
}

#[test]
fn what_fails_once_succeeds_the_second_time() {
    let folder = tempfile::tempdir().unwrap();
    for mode in ["crash-once", "garbage-once", "error-once"] {
        let memory = folder.path().join(mode);
        let out = at(&model(settings(mode, &[memory.to_str().unwrap()])), &POINTS);
        right_but(&POINTS, &out, &[]);
        assert_eq!(out.extra(), 1, "{mode}");
        let memory = folder.path().join(format!("{mode}-without-retries"));
        let once = settings(mode, &[memory.to_str().unwrap()]).with_retries(0);
        let out = at(&model(once), &POINTS);
        right_but(&POINTS, &out, &[2]);
        assert_eq!((out.value(2, 0), out.extra()), (None, 0), "{mode}");
    }
    let out = at(&model(settings("error-always", &[]).with_retries(3)), &POINTS);
    assert_eq!((fault(&out, 2, 0), out.extra()), (ProcessFault::Unable { message: "licence busy".into() }, 3));
}

/// A failure that the program itself reports is an error of that characteristic or point only, and is not retried.
#[test]
fn a_child_may_have_no_value() {
    let no_value = |message: &str| ProcessFault::NoValue { message: message.into() };
    let out = at(&model(settings("partial", &[])), &POINTS);
    right_but(&POINTS, &out, &[2]);
    assert_eq!((out.value(2, 0), fault(&out, 2, 1)), (Some(15.0), no_value("face 7 is gone")));
    let out = at(&model(settings("null", &[])), &POINTS);
    assert_eq!((fault(&out, 2, 0), out.value(2, 1)), (no_value("the model returned null"), Some(26.0)));
    let out = at(&model(settings("error", &[])), &POINTS);
    assert_eq!(fault(&out, 2, 1), no_value("sketch does not solve: redundant constraint 7"));
    assert_eq!(out.extra(), 0);
}

/// Deadlines hold for a child that hangs, that never reads, and that closes its stdout.
#[test]
fn children_that_say_nothing() {
    let short = |mode: &str| settings(mode, &[]).with_timeout(Duration::from_millis(300));
    let hang = model(short("hang"));
    let out = at(&hang, &POINTS);
    right_but(&POINTS, &out, &[2]);
    assert!(matches!(fault(&out, 2, 0), ProcessFault::TimedOut { .. }));
    let never = short("never-reads").with_retries(0);
    let out = at(&model(never), &POINTS[..2]);
    assert!((0..2).all(|row| matches!(fault(&out, row, 0), ProcessFault::TimedOut { .. })));
    let out = at(&model(short("closes-stdout").with_retries(0)), &POINTS[..2]);
    assert!((0..2).all(|row| fault(&out, row, 0) == ProcessFault::Crashed { exit: Exit::ClosedStdout }));
    let out = at(&model(short("dies-idle").with_retries(0)), &POINTS[..2]);
    assert!((0..2).all(|row| matches!(fault(&out, row, 0), ProcessFault::Crashed { .. })));
}

/// A line that drips for ever costs one timeout in all: no point is to blame, and a fresh child would write the same.
#[test]
fn an_endless_line_costs_one_timeout() {
    let model = model(settings("drip", &[]).with_timeout(Duration::from_millis(400)).with_retries(3));
    // The third point drips.
    for first in [2, 0] {
        let out = at(&model, &POINTS);
        let endless = |row: usize| matches!(fault(&out, row, 0), ProcessFault::EndlessLine { .. });
        assert!((first..POINTS.len()).all(endless), "{:?}", out.error(first, 0));
    }
    let counts = model.account().unwrap().counts;
    assert_eq!((counts.starts, counts.timeouts), (1, 1));
}

/// The fault of a child that was not sent a point is charged to none. After a few such children no more are started.
#[test]
fn children_that_never_take_a_point_are_given_up() {
    // One write, so that the engine reads both lines at once. The unrequested answer ends the child.
    let lines = r#"{"ready":true}\n{"id":7,"y":[1,2]}\n"#;
    let model = model(Settings::new(["printf", lines]).with_retries(0).with_sentinels(false));
    let out = at(&model, &POINTS[..2]);
    assert!((0..2).all(|row| fault(&out, row, 0) == ProcessFault::UnknownPoint { id: 7 }), "{:?}", out.error(0, 0));
    assert_eq!(model.account().unwrap().counts.starts, 4);
}

/// A deadline beyond the range of the clock never comes.
#[test]
fn deadlines_may_be_far_away() {
    let far = settings("good", &[]).with_timeout(Duration::MAX).with_start_timeout(Duration::MAX);
    right_but(&POINTS, &at(&model(far), &POINTS), &[]);
}

/// One of several points under way crashes the child or makes it hang. The others are answered all the same.
#[test]
fn the_culprit_in_a_window_is_found() {
    let a: Vec<f64> = (0..30).map(f64::from).collect();
    for (mode, timeout) in [("crash-in-window", 20.0), ("hang-in-window", 0.4)] {
        let settings = settings(mode, &["8"]).with_timeout(Duration::from_secs_f64(timeout));
        let out = at(&model(settings), &a);
        right_but(&a, &out, &[13]);
        let fault = fault(&out, 13, 0);
        assert!(matches!(fault, ProcessFault::Crashed { .. } | ProcessFault::TimedOut { .. }), "{mode}: {fault:?}");
    }
}

/// A stop leaves the rest open and waits for points under way, since their cost is already spent.
#[test]
fn a_stop_loses_nothing() {
    let model = model(settings("slow", &["0.02"]));
    let a: Vec<f64> = (0..500).map(f64::from).collect();
    let points = Points::from_rows(&a.iter().map(|&a| [a, 2.0]).collect::<Vec<_>>());
    // The child is started before the clock runs, so its start does not count.
    right_but(&POINTS[..1], &at(&model, &POINTS[..1]), &[]);
    let begun = Instant::now();
    let stop = || (begun.elapsed() > Duration::from_millis(400)).then_some(StopReason::TimeLimit);
    let mut out = Responses::open(a.len(), 2);
    model.evaluate(&Request::values(&points, &[0, 1]), &Run::to_the_end().stopping_when(&stop), &mut out);
    let answered = (0..a.len()).filter(|&row| !out.is_open(row, 0)).count();
    assert!(answered > 0 && answered < a.len());
    right_but(&a[..answered], &out, &[]);
    assert_eq!((out.extra(), out.errors().count()), (0, 0));
    // The stop does not affect later requests.
    right_but(&POINTS, &at(&model, &POINTS), &[]);
}

/// If a child gives another value at the nominal point, another child evaluates again all points that it has answered since.
#[test]
fn children_that_flip_are_found_out() {
    // Sentinels only, since replays have tests of their own.
    let guarded = |mode: &str, more: &[&str]| settings(mode, more).with_sentinels(true).with_verify(0);
    // The nominal point, some right answers, the flip, and wrong ones after it.
    let a = [1.0, 2.0, 3.0, 13.0, 4.0, 5.0];
    let out = at(&model(guarded("flips", &[])), &a);
    // The point that flips the model also flips the fresh child. Its own answer stays in doubt, and all others are right.
    right_but(&a, &out, &[3]);
    let [first, second] = out.non_repeatable() else { panic!("{:?}", out.non_repeatable()) };
    assert_eq!(
        (first.output.as_str(), first.expected, first.found, first.suspects.len()),
        ("sum", Some(3.0), Some(-3.0), 5)
    );
    assert_eq!((second.output.as_str(), &second.suspects), ("sum", &vec![vec![13.0, 2.0]]));
    // A sentinel follows every error, so the answers after it are right again.
    let a = [1.0, 2.0, 13.0, 4.0, 5.0];
    let out = at(&model(guarded("poisoned-by-errors", &[])), &a);
    right_but(&a, &out, &[2]);
    assert_eq!(fault(&out, 2, 0), ProcessFault::NoValue { message: "does not assemble".into() });
    assert_eq!((out.non_repeatable().len(), out.non_repeatable()[0].output.as_str()), (2, "product"));
    // An answer of another shape at the nominal point counts like another value.
    let a = [1.0, 2.0, 13.0, 4.0];
    let out = at(&model(guarded("misshapen-later", &[])), &a);
    right_but(&a, &out, &[]);
    let a = [1.0, 2.0, 13.0, 4.0, 5.0];
    // A model that never repeats itself ends all the same, and the result reports it.
    let out = at(&model(guarded("always-flips", &[])), &a);
    assert!(!out.non_repeatable().is_empty());
    // A model that repeats itself costs one more evaluation.
    let out = at(&model(guarded("good", &[])), &a);
    assert_eq!((out.non_repeatable().len(), out.extra()), (0, 1));
    right_but(&a, &out, &[]);
}

/// A simulation reports it too, random or rare, and an analysis reports it for its samples.
#[test]
fn samples_of_a_model_that_flips_are_doubted() {
    let of = |mode: &str| {
        let dimensions = [Dimension::normal("a", 1.0, 0.3).unwrap(), Dimension::normal("b", 2.0, 0.3).unwrap()];
        let limits = SpecLimits::new(None, Some(3.3)).unwrap();
        let model = model(settings(mode, &[]).with_sentinels(true));
        let problem = Problem::new(dimensions, model).unwrap();
        let problem = problem.asking([Characteristic::new("sum").with_limits(limits)]).unwrap();
        let random = simulate(&problem, &SimulationOptions::default().with_samples(200)).unwrap();
        let rare = rare(&problem, &RareOptions::default().with_samples(200));
        (random.non_repeatable, rare.map(|rare| rare.non_repeatable))
    };
    let (random, rare) = of("always-flips");
    assert!(!random.is_empty() && random.iter().all(|doubt| doubt.output == "sum"), "{random:?}");
    // Without any answer that repeats there is no estimate at all.
    assert!(rare.is_err() || rare.is_ok_and(|non_repeatable| !non_repeatable.is_empty()));
    let (random, rare) = of("good");
    assert!(random.is_empty() && rare.unwrap().is_empty(), "{random:?}");
}

/// A process with its parent and the time of its start, which distinguishes it from a later one with the same number.
#[cfg(target_os = "linux")]
#[derive(Debug, Clone, PartialEq)]
struct Seen {
    pid: String,
    state: String,
    parent: String,
    begun: String,
}

#[cfg(target_os = "linux")]
impl Seen {
    /// The process with this number, running or waiting to be reaped.
    fn of(pid: &str) -> Option<Self> {
        let stat = std::fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
        let fields: Vec<&str> = stat.rsplit(')').next()?.split_whitespace().collect();
        let field = |i: usize| fields.get(i).map(|field| (*field).to_owned());
        Some(Self { pid: pid.into(), state: field(0)?, parent: field(1)?, begun: field(19)? })
    }

    /// True if the process is gone, and is reaped if that is up to this process.
    fn gone(&self) -> bool {
        let dead = |now: &Self| now.state == "Z" && now.parent != std::process::id().to_string();
        Self::of(&self.pid).is_none_or(|now| now.begun != self.begun || dead(&now))
    }
}

/// Running processes with this text in their command line.
#[cfg(target_os = "linux")]
fn living(text: &str) -> Vec<Seen> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir("/proc").into_iter().flatten().flatten() {
        let command = std::fs::read(entry.path().join("cmdline")).unwrap_or_default();
        if String::from_utf8_lossy(&command).replace('\0', " ").contains(text) {
            found.extend(Seen::of(&entry.file_name().to_string_lossy()));
        }
    }
    found
}

/// Every process that a child started ends with the model, and none waits to be reaped.
#[test]
#[cfg(target_os = "linux")]
fn no_orphan_is_left() {
    let family = {
        // The same test may run at the same time on this machine.
        let forever = format!("300.{}", std::process::id());
        let model = model(settings("grandchild", &[&forever]));
        right_but(&POINTS, &at(&model, &POINTS), &[]);
        // A process that it started may still be on its way from `fork` to `exec`.
        let begun = Instant::now();
        let mut family = Vec::new();
        while family.len() < 3 {
            assert!(begun.elapsed() < PATIENCE, "the child has children: {family:?}");
            std::thread::sleep(Duration::from_millis(10));
            family = living(&format!("sleep {forever}"));
        }
        let parents: Vec<Seen> = family.iter().filter_map(|seen| Seen::of(&seen.parent)).collect();
        assert!(parents.iter().any(|seen| seen.parent == std::process::id().to_string()), "{parents:?}");
        family.extend(parents);
        family
    };
    let begun = Instant::now();
    while let Some(left) = family.iter().find(|seen| !seen.gone()) {
        assert!(begun.elapsed() < PATIENCE, "{left:?} of {family:?}");
        std::thread::sleep(Duration::from_millis(10));
    }
}

/// Processes that left the child's group end with the model too. A process that this program started itself stays.
#[test]
#[cfg(target_os = "linux")]
fn no_process_escapes() {
    let forever = format!("400.{}", std::process::id());
    let mut own = std::process::Command::new("sleep").arg(format!("{forever}5")).spawn().unwrap();
    let family = {
        let model = model(settings("escaped", &[&forever]));
        right_but(&POINTS, &at(&model, &POINTS), &[]);
        let begun = Instant::now();
        let mut family = Vec::new();
        while family.len() < 4 {
            assert!(begun.elapsed() < PATIENCE, "the child has children: {family:?}");
            std::thread::sleep(Duration::from_millis(10));
            family = living(&format!("sleep {forever} "));
        }
        family
    };
    let begun = Instant::now();
    while let Some(left) = family.iter().find(|seen| !seen.gone()) {
        assert!(begun.elapsed() < PATIENCE, "{left:?} of {family:?}");
        std::thread::sleep(Duration::from_millis(10));
    }
    assert!(own.try_wait().unwrap().is_none(), "a process of this program was ended");
    own.kill().unwrap();
    own.wait().unwrap();
}

/// Memory of a process in megabytes.
#[cfg(target_os = "linux")]
fn resident(pid: &str) -> f64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let kilobytes = status.lines().find_map(|line| line.strip_prefix("VmRSS:")).unwrap_or_default();
    kilobytes.trim().trim_end_matches(" kB").parse::<f64>().unwrap_or(f64::NAN) / 1024.0
}

/// A hundred thousand points through one child with many under way: none is lost or mixed up, and the memory of both sides does not grow.
#[test]
#[cfg(target_os = "linux")]
fn many_points_through_one_child() {
    let model = model(settings("echo", &["one-child-for-many-points", "64"]));
    let a: Vec<f64> = (100..10_100).map(f64::from).collect();
    right_but(&a, &at(&model, &a), &[]);
    let pid = &living("one-child-for-many-points").pop().unwrap().pid;
    let before = [resident("self"), resident(pid)];
    for _ in 0..9 {
        right_but(&a, &at(&model, &a), &[]);
    }
    // Other tests run in the same process. Memory that grows with the points would be hundreds of bytes for each.
    let after = [resident("self"), resident(pid)];
    assert!(after[0] - before[0] < 64.0 && after[1] - before[1] < 8.0, "{before:?} {after:?}");
}

/// A program that disappears before it is to be started again: open points fail, and answers stay.
#[test]
fn a_program_that_is_gone_ends_the_batch() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("gone.py");
    std::fs::copy(repository("tests/children/child.py"), &script).unwrap();
    let argv = ["python3", "gone.py", "crash-once-and-for-all"];
    let model = model(Settings::new(argv).with_folder(folder.path().to_owned()));
    let a = [1.0, 2.0, 13.0, 4.0];
    let out = at(&model, &a);
    right_but(&a, &out, &[2, 3]);
    assert!(
        (2..4).all(|row| matches!(fault(&out, row, 0), ProcessFault::EndedAtStart { .. })),
        "{:?}",
        out.error(3, 0)
    );
}

/// `kill -9` of the children at any time: every point is answered all the same.
#[test]
#[cfg(target_os = "linux")]
fn killed_children_lose_nothing() {
    let settings = settings("slow", &["0.02", "killed-children"]).with_workers(2).with_retries(3);
    let model = model(settings);
    // A model whose first start fails is given up at once.
    model.prepare(&[0, 1]).unwrap();
    let a: Vec<f64> = (0..200).map(f64::from).collect();
    let (done, answered) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let out = std::thread::scope(|scope| {
        scope.spawn(|| {
            let mut before = 0;
            for round in 0..6 {
                // Kills are not faster than starts, however busy the machine. A model without any start is given up.
                let ended = || done.load(Ordering::Relaxed) > 0;
                while answered.load(Ordering::Relaxed) < before + 12 && !ended() {
                    std::thread::sleep(Duration::from_millis(17));
                }
                std::thread::sleep(Duration::from_millis(17 * round));
                before = answered.load(Ordering::Relaxed);
                if ended() {
                    break;
                }
                if let Some(Seen { pid, .. }) = living("killed-children").pop() {
                    let _ = Command::new("kill").args(["-9", &pid]).status();
                }
            }
        });
        let finished = |rows: &[usize], _: &Responses| {
            answered.fetch_add(rows.len(), Ordering::Relaxed);
        };
        let out = at_within(&model, &a, &Run::to_the_end().telling(&finished));
        done.store(1, Ordering::Relaxed);
        out
    });
    right_but(&a, &out, &[]);
    // A kill costs the one point that the child had under way.
    assert!(out.extra() > 0 && out.extra() <= 6, "{}", out.extra());
}

fn python(script: &Path) -> Settings {
    Settings::new(["python3".to_owned(), script.display().to_string()])
}

/// The Python SDK: names, errors of a point and of a characteristic, and a library that prints to descriptor 1.
#[test]
fn the_sdk_serves() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("model.py");
    let sdk = repository("adapters/python").display().to_string();
    let source = format!(
        r#"
import os, sys
sys.path.insert(0, {sdk:?})
from sensitol_adapter import adapter, NoValue

@adapter(outputs=["sum", "product"], version="2")
def model(a, b, scale=1.0):
    print("progress", a)
    os.write(1, b"native library speaking\n")
    if a == 13:
        raise NoValue("does not assemble")
    if a == 14:
        return {{"sum": a + b}}
    if a == 15:
        return {{"sum": float("nan"), "product": a * b}}
    if a == 16:
        return 1 / 0
    return {{"sum": a + b, "product": scale * a * b}}

if __name__ == "__main__":
    model.serve()
"#
    );
    std::fs::write(&script, source).unwrap();
    let model = model(python(&script));
    let a = [1.0, 13.0, 14.0, 15.0, 16.0, 2.0];
    let out = at(&model, &a);
    right_but(&a, &out, &[1, 2, 3, 4]);
    let message = |row: usize, output: usize| fault(&out, row, output).to_string();
    assert_eq!((message(1, 0), message(1, 1)), ("does not assemble".into(), "does not assemble".into()));
    assert_eq!((out.value(2, 0), message(2, 1)), (Some(16.0), "the model returned no `product`".into()));
    assert_eq!((message(3, 0), out.value(3, 1)), ("the model returned nan".into(), Some(30.0)));
    assert_eq!(message(4, 0), "ZeroDivisionError: division by zero");
    assert_eq!(model.adapter(&[0, 1]).unwrap().version.as_deref(), Some("2"));
    // The SDK reports the names that it does not have.
    let unknown = |inputs: [&str; 2], outputs: [&str; 1]| {
        let greeting = Greeting::new(vec![0.0; 2]);
        let process = Process::new(Signature::of_names(inputs, outputs), greeting, python(&script));
        process.prepare(&[0]).unwrap_err().to_string()
    };
    assert!(unknown(["a", "c"], ["sum"]).contains("no dimension or constant `c`; there are a, b, scale"));
    assert!(unknown(["a", "scale"], ["sum"]).contains("`b` is needed"));
    assert!(unknown(["a", "b"], ["quotient"]).contains("no characteristic `quotient`; there are sum, product"));
}

/// A function of whole columns: one bad point in them does not affect the others.
#[test]
fn the_sdk_serves_batches() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("model.py");
    let sdk = repository("adapters/python").display().to_string();
    let source = format!(
        r#"
import sys
sys.path.insert(0, {sdk:?})
from sensitol_adapter import adapter

@adapter(batch=True, window=16)
def model(a, b):
    if 13 in a:
        raise RuntimeError("13")
    return {{"sum": [x + y for x, y in zip(a, b)], "product": [x * y for x, y in zip(a, b)]}}

model.serve()
"#
    );
    std::fs::write(&script, source).unwrap();
    let a: Vec<f64> = (0..50).map(f64::from).collect();
    let out = at(&model(python(&script)), &a);
    right_but(&a, &out, &[13]);
    assert_eq!(fault(&out, 13, 0).to_string(), "RuntimeError: 13");
}

/// Difference of two dimensions with the child programs printed in PROTOCOL.md: all of them work.
#[test]
fn the_children_of_the_documentation_work() {
    let text = std::fs::read_to_string(repository("adapters/PROTOCOL.md")).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (language, program, file) in [
        ("python", vec!["python3"], "gap.py"),
        ("sh", vec!["sh"], "gap.sh"),
        ("octave", vec!["octave-cli", "--quiet"], "gap.m"),
    ] {
        if Command::new(program[0]).arg("--version").output().is_err() {
            // A skipped language is reported in the log of the tests.
            eprintln!("skipped: {} is not installed", program[0]);
            continue;
        }
        let start = text.find(&format!("```{language}\n")).unwrap() + language.len() + 4;
        let block = &text[start..start + text[start..].find("```").unwrap()];
        std::fs::write(folder.path().join(file), block).unwrap();
        let argv = program.iter().copied().chain([file]);
        let settings = Settings::new(argv).with_folder(folder.path().to_owned());
        let greeting = Greeting::new(vec![10.0, 30.0]);
        let process = Process::new(Signature::of_names(["a", "b"], ["gap"]), greeting, settings);
        let points = Points::from_rows(&[[10.125, 30.0], [-1e-3, 2.5e10], [0.1, 0.3]]);
        let mut out = Responses::open(3, 1);
        process.evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut out);
        for (row, expected) in [10.125 - 30.0, -1e-3 - 2.5e10, 0.1 - 0.3].into_iter().enumerate() {
            assert_eq!(out.value(row, 0), Some(expected), "{language}: {:?}", out.error(row, 0));
        }
    }
}

/// The lines printed in PROTOCOL.md have the keys that the schema requires, and no others.
#[test]
fn the_schema_describes_the_lines() {
    let read = |path: &str| std::fs::read_to_string(repository(path)).unwrap();
    let schema: serde_json::Value = serde_json::from_str(&read("adapters/protocol.schema.json")).unwrap();
    let kinds = schema["$defs"].as_object().unwrap();
    let text = read("adapters/PROTOCOL.md");
    let lines: Vec<serde_json::Value> = (text.lines())
        .filter_map(|line| line.strip_prefix("> {").or(line.strip_prefix("< {")))
        .map(|line| serde_json::from_str(&format!("{{{line}")).unwrap())
        .collect();
    assert_eq!(lines.len(), 16);
    for line in lines {
        let line = line.as_object().unwrap();
        let fits = |kind: &&serde_json::Value| {
            let required = kind["required"].as_array().unwrap();
            required.iter().all(|key| line.contains_key(key.as_str().unwrap()))
                && line.keys().all(|key| kind["properties"].get(key).is_some())
        };
        assert_eq!(kinds.values().filter(fits).count(), 1, "{line:?}");
    }
}

/// Derivatives of the SDK have the form of the protocol, tested over the wire without the engine.
#[test]
fn the_sdk_sends_gradients() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("model.py");
    let sdk = repository("adapters/python").display().to_string();
    let source = format!(
        r#"
import sys
sys.path.insert(0, {sdk:?})
from sensitol_adapter import adapter

@adapter(gradients=True)
def model(a, b, c=1.0):
    return {{"sum": a + b, "product": a * b}}, {{"sum": {{"a": 1, "b": 1}}, "product": {{"b": a, "a": b}}}}

model.serve()
"#
    );
    std::fs::write(&script, source).unwrap();
    let mut child = Command::new("python3").arg(&script).stdin(Stdio::piped()).stdout(Stdio::piped()).spawn().unwrap();
    let hello = r#"{"sensitol":1,"dimensions":["b","c","a"],"units":[null,null,null],"nominal":[1,1,1],"constants":{},"characteristics":["product","sum"],"optional":[]}"#;
    let mut stdin = child.stdin.take().unwrap();
    let request = r#"{"id":7,"x":[3,9,2]}"#;
    writeln!(stdin, "{hello}\n{request}").unwrap();
    drop(stdin);
    let output = String::from_utf8(child.wait_with_output().unwrap().stdout).unwrap();
    let lines: Vec<serde_json::Value> = output.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert_eq!(lines[0]["gradients"], true);
    let expected = serde_json::json!({"id": 7, "y": [6.0, 5.0], "dy": [[2.0, 0.0, 3.0], [1.0, 0.0, 1.0]]});
    assert_eq!(lines[1], expected);
    // The engine accepts the answers like any others.
    right_but(&POINTS, &at(&model(python(&script)), &POINTS), &[]);
}
