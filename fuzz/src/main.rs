//! Driver for stable toolchains: `cargo run -p fuzz -- --seconds 60` mutates the corpora, `--replay` only replays them.
//!
//! An input that fails is kept in `fuzz/findings/TARGET`, and the exit code is 1.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use fuzz::{TARGETS, Target};
use rand::{Rng, RngExt, SeedableRng};
use rand_xoshiro::Xoshiro256PlusPlus;

/// Longest time for an input. Without optimisation, on a busy machine, an example of correlated dimensions takes a minute.
const SLOW: Duration = Duration::from_secs(if cfg!(debug_assertions) { 120 } else { 20 });
/// Pieces of text with a meaning for the parsers.
const WORDS: &[&str] = &[
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "=",
    ",",
    ".",
    "\n",
    "-",
    "e308",
    "1e-320",
    "nan",
    "inf",
    "0x",
    "\\u0000",
    "\u{202e}",
    "\u{2212}",
    "nominal",
    "tolerance",
    "limits",
    "sigma",
    "formula",
    "lower",
    "upper",
    "target_yield",
    "distribution",
    "kind",
    "mixture",
    "beta",
    "correlation",
    "between",
    "value",
    "min(",
    "max(",
    "if(",
    "sqrt(",
    "atan2(",
    "^",
    "`",
    "99999999999999999999",
    "--method",
    "full",
    "--samples",
    "100",
    "STUDY",
    "--check",
    "--json",
    "--rare",
    "{\"id\":0,\"y\":1}",
    "{\"ready\":true}",
    ";",
    "\t",
    "H7",
    "g6",
    "js5",
    "[parts.",
    "[joints]",
    "plane",
    "axis",
    "point",
    "frame",
    "normal",
    "along",
    "on",
    "against",
    "hole",
    "pin",
    "takes",
    "gap",
    "rod",
    "\"-z\"",
    "[0, 0, 0]",
];

struct Asked {
    seconds: u64,
    replay: bool,
    seed: u64,
    only: Option<String>,
}

fn asked() -> Result<Asked, String> {
    let mut asked = Asked { seconds: 60, replay: false, seed: 1, only: None };
    let mut words = std::env::args().skip(1);
    while let Some(word) = words.next() {
        let mut number =
            || words.next().and_then(|text| text.parse().ok()).ok_or(format!("{word} needs a whole number"));
        match word.as_str() {
            "--seconds" => asked.seconds = number()?,
            "--seed" => asked.seed = number()?,
            "--replay" => asked.replay = true,
            "--target" => asked.only = words.next(),
            other => return Err(format!("`{other}` is unknown: --seconds N, --seed N, --replay, --target NAME")),
        }
    }
    match &asked.only {
        Some(name) if TARGETS.iter().all(|target| target.name != name) => {
            Err(format!("there is no target `{name}`; there are {}", TARGETS.map(|target| target.name).join(", ")))
        }
        _ => Ok(asked),
    }
}

fn main() {
    let asked = asked().unwrap_or_else(|error| {
        eprintln!("{error}");
        std::process::exit(2)
    });
    std::panic::set_hook(Box::new(|_| {}));
    let folder = Path::new(env!("CARGO_MANIFEST_DIR"));
    let targets: Vec<&Target> =
        TARGETS.iter().filter(|target| asked.only.as_deref().is_none_or(|only| only == target.name)).collect();
    let mut broken = 0;
    for target in &targets {
        let corpus = corpus(folder, target.name);
        let seconds = if asked.replay { 0 } else { asked.seconds / targets.len() as u64 };
        let (runs, found) = drive(target, &corpus, seconds, asked.seed, folder);
        println!("{:<14} {:>5} of the corpus, {:>9} runs, {found} broken", target.name, corpus.len(), runs);
        broken += found;
    }
    std::process::exit(i32::from(broken > 0));
}

/// Returns the corpus of a target. For studies it includes the examples of the project.
fn corpus(folder: &Path, name: &str) -> Vec<Vec<u8>> {
    let files = |path: PathBuf| -> Vec<PathBuf> {
        let entries = std::fs::read_dir(path).into_iter().flatten().flatten();
        entries.map(|entry| entry.path()).collect()
    };
    let mut paths = files(folder.join("corpus").join(name));
    if name == "study_toml" {
        let examples = files(folder.join("../examples")).into_iter().flat_map(files);
        paths.extend(examples.filter(|path| path.extension().is_some_and(|ending| ending == "toml")));
    }
    paths.sort();
    paths.into_iter().filter_map(|path| std::fs::read(path).ok()).collect()
}

/// Runs a target for some seconds. Returns the numbers of inputs and of failures.
fn drive(target: &Target, corpus: &[Vec<u8>], seconds: u64, seed: u64, folder: &Path) -> (u64, u64) {
    let mut rng = Xoshiro256PlusPlus::seed_from_u64(seed ^ target.name.len() as u64);
    let (begun, mut runs, mut broken) = (Instant::now(), 0, 0);
    let mut check = |input: &[u8]| {
        runs += 1;
        let started = Instant::now();
        let result = std::panic::catch_unwind(|| (target.run)(input));
        let why = match result {
            Err(panic) => Some(words(&*panic)),
            Ok(()) if started.elapsed() > SLOW => Some(format!("it took {:?}", started.elapsed())),
            Ok(()) => None,
        };
        if let Some(why) = why {
            broken += 1;
            let kept = folder.join("findings").join(target.name);
            let file = kept.join(format!("{:016x}", hash(input)));
            let saved = std::fs::create_dir_all(&kept).and_then(|()| std::fs::write(&file, input));
            eprintln!("{}: {why}\n  kept in {} ({saved:?})", target.name, file.display());
        }
    };
    corpus.iter().for_each(|input| check(input));
    while begun.elapsed() < Duration::from_secs(seconds) {
        check(&mutated(corpus, &mut rng));
    }
    (runs, broken)
}

fn words(panic: &(dyn std::any::Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned())).unwrap_or_else(|| "a panic".to_owned())
}

/// Hashes bytes by FNV-1a.
fn hash(bytes: &[u8]) -> u64 {
    bytes.iter().fold(0xcbf2_9ce4_8422_2325, |hash, &byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
}

/// Returns an input of the corpus with random changes.
fn mutated(corpus: &[Vec<u8>], rng: &mut Xoshiro256PlusPlus) -> Vec<u8> {
    let pick = |rng: &mut Xoshiro256PlusPlus| match corpus.len() {
        0 => Vec::new(),
        n => corpus[rng.random_range(0..n)].clone(),
    };
    let mut input = pick(rng);
    for _ in 0..rng.random_range(1..=6) {
        let at = rng.random_range(0..=input.len());
        let end = (at + rng.random_range(1..=16)).min(input.len());
        match rng.random_range(0..7) {
            0 if at < input.len() => input[at] ^= 1 << rng.random_range(0..8),
            1 if at < input.len() => input[at] = rng.random_range(0..=255),
            2 => drop(input.splice(at..at, WORDS[rng.random_range(0..WORDS.len())].bytes())),
            3 => drop(input.drain(at..end)),
            4 => {
                let part = input[at..end].to_vec();
                drop(input.splice(at..at, part));
            }
            5 => {
                let other = pick(rng);
                let from = rng.random_range(0..=other.len());
                input.truncate(at);
                input.extend_from_slice(&other[from..]);
            }
            _ => {
                let mut bytes = [0; 8];
                rng.fill_bytes(&mut bytes);
                drop(input.splice(at..at, bytes));
            }
        }
        input.truncate(1 << 14);
    }
    input
}
