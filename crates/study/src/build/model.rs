//! Reads `[model]`: a built-in model or an external program.

use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

use crate::entries::file::ModelEntry;
use crate::entries::spanned::Spanned;
use crate::error::{Fault, StudyFault, fault};
use crate::external_settings::Host;
use crate::folder::UnreadableFile;
use crate::source::Source;
use sensitol::assembly::{AssemblyFunction, GivenAnswers, Input, Output, Signature};
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
use sensitol_external::process::Process;
use sensitol_external::{ForeignUnits, Greeting, Settings};
use sensitol_models::Model;
use sensitol_numeric::names::UnknownName;

/// Greatest number of workers. A greater one is most likely a typing error.
const WORKERS: u64 = 1024;

/// Model that a study evaluates beside its formulas.
pub(crate) enum ModelOf {
    BuiltIn(&'static Model),
    Program(Program),
    /// A function of the calling program.
    Host(Host),
}

pub(crate) struct Program {
    settings: Settings,
    /// Files that the program depends on, besides its arguments.
    files: Vec<PathBuf>,
}

impl ModelOf {
    pub(crate) fn built_in(&self) -> Option<&'static Model> {
        match self {
            Self::BuiltIn(model) => Some(model),
            Self::Program(_) | Self::Host(_) => None,
        }
    }

    /// Program with its arguments. Returns None for a model that starts none.
    pub(crate) fn program(&self) -> Option<&[String]> {
        match self {
            Self::Program(program) => Some(&program.settings.argv),
            Self::BuiltIn(_) | Self::Host(_) => None,
        }
    }

    /// True if the model must answer every name that the study does not define. Only built-in models have fixed outputs.
    pub(crate) fn is_external(&self) -> bool {
        self.built_in().is_none()
    }
}

/// Model of a study: the function of the calling program, or else that of `[model]`. If answers come from elsewhere, characteristics
/// without formula (`open`) need no `[model]`.
pub(crate) fn model(
    entry: Option<&Spanned<ModelEntry>>,
    open: bool,
    source: &Source,
) -> Result<Option<ModelOf>, Fault> {
    let host = source.externals.host.clone().map(ModelOf::Host);
    match entry {
        Some(entry) if host.is_some() && entry.get_ref().builtin.is_some() => {
            let to = "a study whose model is a function of the calling program".to_owned();
            let does_not =
                StudyFault::DoesNotApply { key: "builtin", to, instead: "leave out [model], or the function" };
            Err(fault(entry.span(), "model.builtin", does_not))
        }
        _ if host.is_some() => Ok(host),
        None if open && source.externals.elsewhere() => {
            // The settings need some command, which is never started.
            let settings = Settings::new(["elsewhere"]);
            Ok(Some(ModelOf::Program(Program { settings, files: Vec::new() })))
        }
        entry => entry.map(|entry| written(entry, source)).transpose(),
    }
}

fn written(entry: &Spanned<ModelEntry>, source: &Source) -> Result<ModelOf, Fault> {
    let (line, entry) = (entry.span(), entry.get_ref());
    match (&entry.builtin, &entry.command) {
        (None, None) => {
            let instead = "name a built-in model, such as builtin = \"engine-balance\", or a program, such as \
                           command = [\"python3\", \"gap.py\"]";
            Err(fault(line, "model", StudyFault::MissingKey { key: "builtin".into(), instead: instead.into() }))
        }
        (Some(_), Some(command)) => {
            let why = "are two models: leave one out".to_owned();
            Err(fault(command.span(), "model.command", StudyFault::Conflict { a: "builtin", b: "command", why }))
        }
        (Some(name), None) => {
            let of_programs: [(&'static str, Option<std::ops::Range<usize>>); 7] = [
                ("inputs", entry.inputs.as_ref().map(Spanned::span)),
                ("workers", entry.workers.as_ref().map(Spanned::span)),
                ("timeout_s", entry.timeout_s.as_ref().map(Spanned::span)),
                ("start_timeout_s", entry.start_timeout_s.as_ref().map(Spanned::span)),
                ("retries", entry.retries.as_ref().map(Spanned::span)),
                ("verify", entry.verify.as_ref().map(Spanned::span)),
                ("files", entry.files.as_ref().and_then(|files| files.first()).map(Spanned::span)),
            ];
            for (key, span) in of_programs {
                if let Some(span) = span {
                    let (to, instead) = ("a built-in model".to_owned(), "it is for a command");
                    return Err(fault(span, format!("model.{key}"), StudyFault::DoesNotApply { key, to, instead }));
                }
            }
            built_in(name).map(ModelOf::BuiltIn)
        }
        (None, Some(command)) => program(command, entry, source).map(ModelOf::Program),
    }
}

fn built_in(name: &Spanned<String>) -> Result<&'static Model, Fault> {
    name.get_ref().parse().map_err(|unknown: UnknownName| fault(name.span(), "model.builtin", unknown))
}

fn program(command: &Spanned<Vec<String>>, entry: &ModelEntry, source: &Source) -> Result<Program, Fault> {
    if command.get_ref().first().is_none_or(String::is_empty) {
        let expected = "a program and its arguments, such as [\"python3\", \"gap.py\"],".to_owned();
        let found = "an empty list".to_owned();
        return Err(fault(command.span(), "model.command", StudyFault::WrongType { expected, found }));
    }
    let seconds = |given: &Option<Spanned<f64>>, key: &str, default: Duration| match given {
        None => Ok(default),
        Some(given) => {
            let value = *given.get_ref();
            let duration = Duration::try_from_secs_f64(value).ok().filter(|duration| !duration.is_zero());
            let out = StudyFault::OutOfRange { value, range: "a time above 0, in seconds" };
            duration.ok_or_else(|| fault(given.span(), format!("model.{key}"), out))
        }
    };
    let count = |given: &Option<Spanned<u64>>, key: &str, default: u64, least: u64, most: u64, range: &'static str| {
        let Some(given) = given else { return Ok(default) };
        let value = *given.get_ref();
        if (least..=most).contains(&value) {
            Ok(value)
        } else {
            let out = StudyFault::OutOfRange { value: value as f64, range };
            Err(fault(given.span(), format!("model.{key}"), out))
        }
    };
    let file = |file: &Spanned<String>| {
        let missing = || StudyFault::MissingFile { path: source.place.path().join(file.get_ref()) };
        let found = match source.place.path_of(file.get_ref()) {
            Ok(path) if path.is_file() => Ok(path),
            Err(UnreadableFile::Outside { path }) => Err(StudyFault::OutsideFile { path }),
            Ok(_) | Err(_) => Err(missing()),
        };
        found.map_err(|found| fault(file.span(), "model.files", found))
    };
    let files = entry.files.iter().flatten().map(file).collect::<Result<_, _>>()?;
    let defaults = Settings::new(command.get_ref().iter());
    let settings = Settings {
        folder: source.place.path().to_owned(),
        workers: count(&entry.workers, "workers", 1, 1, WORKERS, "between 1 and 1024")? as usize,
        retries: count(&entry.retries, "retries", u64::from(defaults.retries), 0, 1000, "between 0 and 1000")? as u32,
        verify: match &entry.verify {
            None => None,
            given => Some(count(given, "verify", 0, 0, 1_000_000, "between 0 and 1000000")? as usize),
        },
        timeout: seconds(&entry.timeout_s, "timeout_s", defaults.timeout)?,
        start_timeout: seconds(&entry.start_timeout_s, "start_timeout_s", defaults.start_timeout)?,
        sentinels: source.externals.sentinels,
        listener: source.externals.listener.clone(),
        ..defaults
    };
    Ok(Program { settings, files })
}

/// Signature of a function of all inputs, with `outputs` by name and unit.
pub(crate) fn signature(inputs: &[Input], outputs: Vec<(String, Option<String>)>) -> Signature {
    let outputs = outputs.into_iter().map(|(name, unit)| Output { name, unit, depends_on: None }).collect();
    Signature { inputs: inputs.to_vec(), outputs, ..Signature::default() }
}

/// Assembly function that the program answers. Its answers are kept in a journal if the settings name one. `held` is the handling of its
/// units.
pub(crate) fn process(
    program: &Program,
    signature: Signature,
    greeting: Greeting,
    (source, held): (&Source, ForeignUnits),
) -> Result<Arc<dyn AssemblyFunction>, StudyFault> {
    if let Some(table) = &source.externals.points {
        let given = GivenAnswers::new(signature, Arc::clone(table));
        return Ok(Arc::new(given.map_err(StudyFault::MissingColumn)?));
    }
    started(program, signature, greeting, (source, held))
}

/// Starts nothing yet: makes the process, with a journal if the settings name one.
#[cfg(not(all(target_family = "wasm", target_os = "unknown")))]
fn started(
    program: &Program,
    signature: Signature,
    greeting: Greeting,
    (source, held): (&Source, ForeignUnits),
) -> Result<Arc<dyn AssemblyFunction>, StudyFault> {
    let settings = Settings { units: held, ..program.settings.clone() };
    let process = Process::new(signature, greeting, settings);
    if let Some(path) = source.externals.journal.path(&source.name) {
        return Ok(Arc::new(sensitol_external::journal::Journaled::new(process, path, program.files.clone())));
    }
    Ok(Arc::new(process))
}

/// Fails: a browser runs no programs.
#[cfg(all(target_family = "wasm", target_os = "unknown"))]
fn started(
    program: &Program,
    _: Signature,
    _: Greeting,
    _: (&Source, ForeignUnits),
) -> Result<Arc<dyn AssemblyFunction>, StudyFault> {
    let _ = &program.files;
    Err(StudyFault::NoPrograms { program: program.settings.argv.first().cloned().unwrap_or_default() })
}
