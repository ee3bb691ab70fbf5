//! External programs: evaluations a second through one Python child, beside a lock-step pipe and a process per evaluation;
//! what the journal costs; windows and workers; a crash; a million points. A plain program: each figure is one run of seconds.

use std::path::Path;
use std::time::{Duration, Instant};

use sensitol::assembly::{AssemblyFunction, Points, Request, Responses, Run, Signature};
use sensitol_external::journal::Journaled;
use sensitol_external::process::Process;
use sensitol_external::{Greeting, Settings};

const MODEL: &str = "
import sys, time
sys.path.insert(0, sys.argv[1])
from sensitol_adapter import adapter

@adapter(window=int(sys.argv[2]))
def y(a, b):
    if len(sys.argv) > 3:
        time.sleep(float(sys.argv[3]))
    return a - b

y.serve()
";

/// Answers up to eight points at once after 50 ms, and dies once at the point that it is told.
const CRASH: &str = "
import json, os, sys, time
from concurrent.futures import ThreadPoolExecutor
at, folder = sys.argv[1:3]
hello = json.loads(sys.stdin.readline())
print(json.dumps({'ready': True, 'window': 64}), flush=True)
died = os.path.join(folder, 'died')
def answer(line):
    request = json.loads(line)
    time.sleep(0.05)
    a, b = request['x']
    if repr(a) == at and not os.path.exists(died):
        open(died, 'w').close()
        os._exit(9)
    sys.stdout.write(json.dumps({'id': request['id'], 'y': [a - b]}) + '\\n')
    sys.stdout.flush()
with ThreadPoolExecutor(8) as pool:
    for line in sys.stdin:
        pool.submit(answer, line)
";

fn process(script: &Path, window: usize, sleep: Option<&str>) -> Process {
    workers(script, (window, 1), sleep)
}

fn workers(script: &Path, (window, workers): (usize, usize), sleep: Option<&str>) -> Process {
    let sdk = concat!(env!("CARGO_MANIFEST_DIR"), "/adapters/python");
    let window = window.to_string();
    let words = ["python3", script.to_str().unwrap(), sdk, &window];
    let settings = Settings::new(words.into_iter().chain(sleep)).with_sentinels(false).with_workers(workers);
    let greeting = Greeting::new(vec![1.0, 2.0]);
    Process::new(Signature::of_names(["a", "b"], ["y"]), greeting, settings)
}

/// Seconds for this many points, after the start.
fn run(model: &dyn AssemblyFunction, count: usize) -> f64 {
    model.prepare(&[0]).unwrap();
    let rows: Vec<[f64; 2]> = (0..count).map(|row| [row as f64 * 0.001, 2.0]).collect();
    let points = Points::from_rows(&rows);
    let mut out = Responses::open(count, 1);
    let begun = Instant::now();
    model.evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut out);
    let took = begun.elapsed().as_secs_f64();
    assert_eq!(out.value(count - 1, 0), Some((count - 1) as f64 * 0.001 - 2.0));
    took
}

/// User and system time of this process, and the most memory that it has held, in MiB.
fn own() -> (f64, f64) {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<f64> = (stat.rsplit(')').next().unwrap_or_default().split_whitespace())
        .map(|field| field.parse().unwrap_or(0.0))
        .collect();
    let ticks = fields.get(11).unwrap_or(&0.0) + fields.get(12).unwrap_or(&0.0);
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let most = status.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap_or_default();
    let most: f64 = most.trim().trim_end_matches(" kB").parse().unwrap_or(f64::NAN);
    (ticks / 100.0, most / 1024.0)
}

fn main() {
    let folder = tempfile::tempdir().unwrap();
    let script = folder.path().join("model.py");
    std::fs::write(&script, MODEL).unwrap();

    let count = 200_000;
    let windowed = process(&script, 64, None);
    run(&windowed, 20_000);
    let (cpu, memory) = own();
    let seconds = run(&windowed, count);
    let (cpu_after, memory_after) = own();
    println!("window 64:               {:8.0} evaluations/s", count as f64 / seconds);
    println!("  engine's CPU           {:8.2} us an evaluation", 1e6 * (cpu_after - cpu) / count as f64);
    println!("  memory                 {memory:8.1} MiB before, {memory_after:.1} MiB after {count} points");

    let lockstep = process(&script, 1, None);
    run(&lockstep, 1000);
    println!("lock step:               {:8.0} evaluations/s", 10_000.0 / run(&lockstep, 10_000));

    let begun = Instant::now();
    for _ in 0..20 {
        run(&process(&script, 1, None), 1);
    }
    println!("a process an evaluation: {:8.1} evaluations/s", 20.0 / begun.elapsed().as_secs_f64());

    // A thousand evaluations a second: what keeping them costs.
    let pause = "0.00085";
    let without = run(&process(&script, 8, Some(pause)), 3000);
    let kept = Journaled::new(process(&script, 8, Some(pause)), folder.path().join("j.sqlite"), Vec::new());
    let with = run(&kept, 3000);
    println!("without journal:         {:8.0} evaluations/s", 3000.0 / without);
    println!(
        "with journal:            {:8.0} evaluations/s, {:.0} % more time",
        3000.0 / with,
        100.0 * (with / without - 1.0)
    );

    for window in [1, 8, 64, 512] {
        for many in [1, 2, 8] {
            let model = workers(&script, (window, many), None);
            // All processes are started by a batch that has work for them.
            run(&model, 8 * 512);
            let count = if window == 1 { 10_000 } else { 100_000 };
            println!("window {window:3}, workers {many}:   {:8.0} evaluations/s", count as f64 / run(&model, count));
        }
    }
    crash(folder.path());
    million(folder.path(), &script);
    std::thread::sleep(Duration::from_millis(10));
}

/// One crash among 211 points of 50 ms with a window of 64, beside the same points without it.
fn crash(folder: &Path) {
    let script = folder.join("crash.py");
    std::fs::write(&script, CRASH).unwrap();
    let timed = |at: &str| {
        let words = ["python3", script.to_str().unwrap(), at, folder.to_str().unwrap()];
        let settings = Settings::new(words).with_sentinels(false);
        let model = Process::new(Signature::of_names(["a", "b"], ["y"]), Greeting::new(vec![1.0, 2.0]), settings);
        run(&model, 211)
    };
    let (without, with) = (timed("never"), timed("0.1"));
    println!("211 points, window 64:   {without:8.2} s, and {with:.2} s with one crash");
}

/// A million evaluations with a journal, and a second run that has them all: time and memory.
fn million(folder: &Path, script: &Path) {
    let count = 1_000_000;
    for name in ["evaluated", "from the journal"] {
        let model = Journaled::new(workers(script, (512, 2), None), folder.join("million.sqlite"), Vec::new());
        let seconds = run(&model, count);
        println!("1e6 points, {name}: {seconds:.1} s, {:.0} MiB", own().1);
    }
}
