//! One function for each surface of the program. A broken promise is a panic.

use std::path::Path;
use std::process::ExitCode;

use sensitol::assembly::formula::Formula;
use sensitol::fits::deviations;
use sensitol_external::journal::store::Store;

use sensitol::assembly::formula::jet::Jet;
use sensitol::assembly::formula::set::{FormulaSet, Meaning};
use sensitol::pearson::Pearson;
use sensitol::{Options, analyze};
use sensitol_study::Study;
use sensitol_study::import::{StepImportFault, StepRequest, step_study};

/// Surface of the program, with the function that checks it.
pub struct Target {
    /// Name of the target and of its corpus.
    pub name: &'static str,
    /// Function that receives an input.
    pub run: fn(&[u8]),
}

/// Every target.
pub const TARGETS: [Target; 12] = [
    Target { name: "study_toml", run: study_toml },
    Target { name: "study_json", run: study_json },
    Target { name: "assembly", run: assembly },
    Target { name: "formula", run: formula },
    Target { name: "measured_csv", run: measured_csv },
    Target { name: "protocol", run: protocol },
    Target { name: "journal", run: journal },
    Target { name: "pearson", run: pearson },
    Target { name: "fits", run: fits },
    Target { name: "command_line", run: command_line },
    Target { name: "import", run: import },
    Target { name: "step", run: step },
];

fn text(bytes: &[u8]) -> Option<&str> {
    std::str::from_utf8(bytes).ok()
}

/// Reads a number from every eight bytes.
fn numbers(bytes: &[u8]) -> Vec<f64> {
    bytes.as_chunks::<8>().0.iter().map(|chunk| f64::from_le_bytes(*chunk)).collect()
}

fn study_toml(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    read(Study::from_toml(text, "fuzz.toml"));
}

fn study_json(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    read(Study::from_json(text, "fuzz.json"));
}

/// Checks that a fault can be printed and has a place inside the text, and that a small study can be analysed.
fn read(study: Result<Study, sensitol_study::StudyError>) {
    match study {
        Err(error) => {
            for error in std::iter::once(&error).chain(&error.more) {
                let _ = (error.to_string(), error.help(), error.line_column());
                if let Some(span) = &error.span {
                    assert!(span.end <= error.text.len() && error.text.get(span.clone()).is_some(), "{error:?}");
                }
            }
        }
        Ok(study) if study.files.is_empty() && study.problem.dimensions().len() <= 8 => {
            // No verification, which would sample every study at 45 000 points.
            let mut options = Options::from(sensitol::Method::SecondOrder);
            options.verify = Some(0);
            if let Ok(analysis) = analyze(&study.problem, &options) {
                for one in &analysis.characteristics {
                    if let Some(moments) = &one.moments {
                        assert!(moments.sigma() >= 0.0, "{moments:?}");
                    }
                }
            }
        }
        Ok(_) => {}
    }
}

/// Checks the sections of an assembly in space, after some dimensions: a fault has a place, and what can be read is determined and expands to
/// a study that can be read.
fn assembly(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    let study = format!(
        "[dimensions]\na = {{ nominal = 10, tolerance = 0.1, unit = \"mm\" }}\nb = {{ nominal = 25, tolerance = 0.1, unit = \"mm\" }}\n\
         th = {{ nominal = 30, tolerance = 1, unit = \"deg\" }}\n{text}"
    );
    let found = Study::from_toml(&study, "fuzz.toml");
    if let Ok(study) = &found
        && let Some(mobility) = &study.mobility
    {
        assert_eq!(mobility.unknowns, mobility.equations + mobility.free.len(), "{mobility:?}");
        for pose in &study.poses {
            let parts = pose.rotation.iter().chain(&pose.translation);
            assert!(parts.clone().all(|part| part.is_finite()), "{pose:?}");
        }
        let again = Study::from_toml(&study.expanded, "expanded.toml");
        assert!(again.is_ok(), "the expanded study cannot be read: {again:?}\n{}", study.expanded);
    }
    read(found);
}

/// Checks that the value equals that of the derivative program, and lies within the bounds over a box around the point.
fn formula(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    let Ok(formula) = Formula::parse(text) else { return };
    let names: Vec<String> = formula.names().map(|(name, _)| name.to_owned()).collect();
    let mut known: Vec<&str> = names.iter().map(String::as_str).collect();
    known.sort_unstable();
    known.dedup();
    let meanings: Vec<(&str, Meaning)> =
        known.iter().enumerate().map(|(index, name)| (*name, Meaning::Variable(index))).collect();
    let Ok(set) = FormulaSet::new(vec![("y".to_owned(), formula)], meanings) else { return };
    let at = |index: usize| 0.25 + 1.75 * (index % 7) as f64;
    let columns: Vec<[f64; 1]> = (0..known.len()).map(|index| [at(index)]).collect();
    let mut value = f64::NAN;
    set.evaluate(&[0], 1, |index| &columns[index], |_, _, found| value = found);
    let jet = set.jets(&[0], |index| Jet::variable(at(index), [1.0, 0.0])).swap_remove(0);
    let same = value == jet.value() || (value.is_nan() && jet.value().is_nan());
    assert!(same, "{text}: {value} and {}", jet.value());
    let region: Vec<[f64; 2]> = (0..known.len()).map(|index| [at(index) - 0.01, at(index) + 0.01]).collect();
    let bounds = set.bounds(0, &region);
    if value.is_finite() {
        let held = bounds.value.lower() <= value && value <= bounds.value.upper();
        assert!(held, "{text}: {value} outside {:?}", bounds.value);
    }
    let _ = set.explain(0, at);
}

fn measured_csv(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("pin.csv"), bytes).expect("a file");
    let study = "[dimensions]\na = { measured = \"pin.csv\" }\nb = { measured = \"pin.csv\", column = \"b\" }\n\
                 [characteristics]\ny = { formula = \"a + b\" }\n";
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).expect("a file");
    if let Err(error) = Study::read(&path) {
        let _ = (error.to_string(), error.help());
    }
}

/// Checks a program that answers every request with these bytes.
fn protocol(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    std::fs::write(folder.path().join("answers"), bytes).expect("a file");
    let study = "[dimensions]\na = { nominal = 1, tolerance = 0.1 }\n[characteristics]\ny = {}\n\
                 [model]\ncommand = [\"cat\", \"answers\"]\ntimeout_s = 1\nstart_timeout_s = 1\nretries = 0\nworkers = 1\n[analysis]\nverify = 0\n";
    let path = folder.path().join("study.toml");
    std::fs::write(&path, study).expect("a file");
    let Ok(study) = Study::read(&path) else { return };
    if let Err(error) = analyze(&study.problem, &Options::from(sensitol::Method::Rss)) {
        let _ = error.to_string();
    }
}

/// Checks that a file that is not a journal is refused or read without a panic.
fn journal(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("answers.sensitol");
    std::fs::write(&path, bytes).expect("a file");
    let Ok(store) = Store::open_existing(&path) else { return };
    for model in store.models().unwrap_or_default() {
        let _ = store.answers(model.id);
    }
}

/// Checks that the distribution function rises, that quantiles invert it, and that both tails add up to one.
fn pearson(bytes: &[u8]) {
    let [skewness, kurtosis, x, p, ..] = numbers(bytes)[..] else { return };
    let (skewness, kurtosis) = (skewness % 8.0, kurtosis % 80.0);
    let Ok(law) = Pearson::new(0.0, 1.0, skewness, kurtosis) else { return };
    let (x, p) = (x % 50.0, p.abs() % 1.0);
    if !(x.is_finite() && p > 1e-12 && p < 1.0 - 1e-12) {
        return;
    }
    let (below, above) = (law.cdf(x), law.sf(x));
    assert!((0.0..=1.0).contains(&below) && (0.0..=1.0).contains(&above), "{law:?} at {x}: {below} {above}");
    assert!((below + above - 1.0).abs() < 1e-9, "{law:?} at {x}: {below} + {above}");
    assert!(law.cdf(x + 0.5) >= below - 1e-13, "{law:?} falls after {x}");
    let quantile = law.quantile(p);
    // Near two points, most of the probability may lie within one double of an end. The neighbours enclose it.
    let apart = 4.0 * f64::EPSILON * quantile.abs();
    let [low, high] = [quantile - apart, quantile + apart].map(|x| law.cdf(x));
    assert!(low - 1e-8 < p && p < high + 1e-8, "{law:?}: quantile of {p} is {quantile}, between {low} and {high}");
}

fn fits(bytes: &[u8]) {
    let Some((size, class)) = bytes.split_first_chunk::<8>() else { return };
    let (size, Some(class)) = (f64::from_le_bytes(*size), text(class)) else { return };
    match deviations(size, class) {
        Ok([lower, upper]) => assert!(lower < upper && (upper - lower) < 10.0, "{size} {class}: {lower} {upper}"),
        Err(error) => _ = (error.to_string(), error.help()),
    }
}

/// Checks a command line, one word a line. The word STUDY stands for the path of a study.
fn command_line(bytes: &[u8]) {
    let Some(text) = text(bytes) else { return };
    let folder = tempfile::tempdir().expect("a folder");
    let study = folder.path().join("study.toml");
    let written = "[dimensions]\na = { nominal = 10, tolerance = 0.3 }\nb = { nominal = 9, tolerance = 0.2 }\n\
                   [characteristics]\ngap = { formula = \"a - b + 0.1*a*b\", lower = 9, target_yield = 0.9 }\n\
                   [costs]\na = { model = \"reciprocal\", b = 0.1, min = 0.01, max = 1 }\n";
    std::fs::write(&study, written).expect("a file");
    let place = study.display().to_string();
    let words: Vec<&str> = text.lines().filter(|word| harmless(word)).take(24).collect();
    let [command, rest @ ..] = &words[..] else { return };
    // Commands that end by themselves and write only to the given files.
    if !["analyze", "simulate", "compare", "allocate", "plan", "check", "sweep", "pearson"].contains(command) {
        return;
    }
    let mut all = vec!["sensitol".to_owned(), (*command).to_owned()];
    all.extend(rest.iter().map(|word| word.replace("STUDY", &place)));
    all.extend(["--color", "never"].map(str::to_owned));
    if *command != "check" {
        all.extend(["-o".to_owned(), folder.path().join("report").display().to_string()]);
    }
    let _: ExitCode = sensitol_cli::run(all.into_iter().map(Into::into));
}

/// Checks that a table or a workbook is refused, or becomes a study that can be read.
fn import(bytes: &[u8]) {
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name).display().to_string();
    std::fs::write(at("table"), bytes).expect("a file");
    let words = ["sensitol", "import", &at("table"), "-o", &at("study.toml"), "--color", "never"].map(str::to_owned);
    let _: ExitCode = sensitol_cli::run(words.into_iter().map(Into::into));
    if Path::new(&at("study.toml")).exists() {
        assert!(Study::read(Path::new(&at("study.toml"))).is_ok(), "the imported study cannot be read");
    }
}

/// Checks that a STEP file is refused in one line, or becomes a study whose features can be read.
fn step(bytes: &[u8]) {
    let request = StepRequest { file: "part.stp".to_owned(), joints: true, ..StepRequest::default() };
    match step_study(bytes, &request) {
        Ok(study) => assert!(study.text.contains("[parts."), "a study without a part"),
        Err(StepImportFault::Written(error)) => panic!("the imported study cannot be read: {error}"),
        Err(error) => assert!(!error.to_string().contains('\n'), "{error}"),
    }
}

/// True if a word neither names another file nor is a number that takes hours.
fn harmless(word: &str) -> bool {
    let long = word.chars().filter(char::is_ascii_digit).count() > 4;
    let file = ["-o", "--out", "--csv", "--svg", "--html", "--xlsx", "--write", "--journal"]
        .iter()
        .any(|flag| word.starts_with(flag));
    let path = word.contains('/') && Path::new(word).parent().is_some_and(|parent| parent.components().count() > 0);
    !(long || file || path)
}
