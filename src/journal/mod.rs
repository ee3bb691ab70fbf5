//! What external programs answered, kept on disk: an evaluation may have cost a minute of CAD time.
//!
//! Every answer is in the file before anything is made of it, so that a run that is killed goes on where it was, and a
//! repeated or enlarged one evaluates only what is new. An answer is known by the model (program and arguments, the contents
//! of its script and of the files that it depends on, what the adapter says of itself, constants, names and units of the
//! dimensions), the exact point, and the output. What a sentinel puts in doubt is forgotten at once, and kept again only when
//! another child has answered it in its right mind. What the program says has no value is kept too; a crash or a missed deadline is not: the next run tries again.

mod store;

pub use store::{Answer, JournalError, JournalFault, KnownModel, Store, StoredAnswer};

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use sha2::{Digest, Sha256};

use crate::assembly::process::{Process, ProcessFault, Settings};
use crate::assembly::{Ask, AssemblyFunction, EvaluationError, ModelInfo, Points, Progress, Responses, Run, Signature};
use crate::summary::StopReason;

/// A program whose answers are kept.
///
/// Evaluations: those that the file does not hold.
pub struct Journaled {
    process: Process,
    path: PathBuf,
    files: Vec<PathBuf>,
    open: Mutex<Option<Open>>,
}

struct Open {
    store: Store,
    model: i64,
}

impl Journaled {
    /// Keeps the answers of `process` in the journal at `path`; `files` are what it depends on beside its arguments.
    pub fn new(process: Process, path: PathBuf, files: Vec<PathBuf>) -> Self {
        Self { process, path, files, open: Mutex::new(None) }
    }

    /// What the answers of this model are known by.
    fn identity(&self, outputs: &[usize]) -> Result<String, EvaluationError> {
        let adapter = self.process.adapter(outputs).map_err(Box::new)?;
        let inputs = &self.signature().inputs;
        let hash = |file: &PathBuf| {
            let bytes = std::fs::read(file).map_err(|error| {
                let fault = JournalFault::ModelFile { file: file.clone(), reason: error.to_string() };
                not_kept(&JournalError { path: self.path.clone(), fault })
            })?;
            Ok(Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect::<String>())
        };
        // The name of a file is not its contents, and the study may have been moved: only hashes count. The first
        // file among the arguments is the script that answers; a later one may be its log.
        let Settings { argv, folder, .. } = self.process.settings();
        let script = argv.iter().map(|word| folder.join(word)).find(|path| path.is_file());
        let files: Vec<PathBuf> = script.into_iter().chain(self.files.iter().cloned()).collect();
        let files = files.iter().map(hash).collect::<Result<Vec<String>, EvaluationError>>()?;
        let constants: serde_json::Map<String, serde_json::Value> =
            self.process.greeting().constants.iter().map(|(name, value)| (name.clone(), (*value).into())).collect();
        let identity = serde_json::json!({
            "command": argv,
            "adapter": adapter.name,
            "version": adapter.version,
            "files": files,
            "constants": constants,
            "dimensions": inputs.iter().map(|input| &input.name).collect::<Vec<_>>(),
            "units": inputs.iter().map(|input| &input.unit).collect::<Vec<_>>(),
        });
        Ok(identity.to_string())
    }

    fn opened(&self, outputs: &[usize]) -> Result<Open, EvaluationError> {
        let identity = self.identity(outputs)?;
        let dimensions: Vec<String> = self.signature().inputs.iter().map(|input| input.name.clone()).collect();
        let store = Store::open(&self.path).map_err(|error| not_kept(&error))?;
        let model = store.model(&identity, &dimensions).map_err(|error| not_kept(&error))?;
        Ok(Open { store, model })
    }
}

fn not_kept(error: &JournalError) -> EvaluationError {
    EvaluationError::NotKept { message: error.to_string() }
}

impl AssemblyFunction for Journaled {
    fn signature(&self) -> &Signature {
        self.process.signature()
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        if open.is_none() {
            *open = Some(self.opened(outputs)?);
        }
        drop(open);
        self.process.prepare(outputs)
    }

    fn evaluate(&self, ask: &Ask<'_>, run: &Run<'_>, out: &mut Responses) {
        if let Err(error) = self.prepare(ask.outputs) {
            return refuse(out, &error);
        }
        let open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(Open { store, model }) = open.as_ref() else { return };
        let names: Vec<&str> =
            ask.outputs.iter().map(|&output| self.signature().outputs[output].name.as_str()).collect();
        let rows: Vec<Vec<f64>> = (0..ask.points.rows()).map(|row| ask.points.row(row)).collect();
        let (mut known, mut missing) = (Vec::new(), Vec::new());
        for (row, point) in rows.iter().enumerate() {
            let answers: Result<Option<Vec<Answer>>, JournalError> =
                names.iter().map(|name| store.answer(*model, point, name)).collect();
            match answers {
                Err(error) => return refuse(out, &not_kept(&error)),
                Ok(None) => missing.push(row),
                Ok(Some(answers)) => {
                    known.push(row);
                    for (output, answer) in answers.into_iter().enumerate() {
                        match answer {
                            Ok(value) => out.set(row, output, value),
                            Err(message) => out.fail(row, output, EvaluationError::Refused { message }),
                        }
                    }
                }
            }
        }
        out.reused(known.len());
        run.progressed(Progress { points: known.len(), failed: out.failed_among(&known), reused: known.len() });
        run.finished(&known, out);
        if missing.is_empty() {
            return;
        }
        let model = *model;
        drop(open);
        let points = Points::from_rows(&missing.iter().map(|&row| &rows[row]).collect::<Vec<_>>());
        let mut answers = Responses::open(missing.len(), out.outputs());
        let (told, failure) = (Mutex::new(out), Mutex::new(None));
        let finished = |finished: &[usize], answers: &Responses| {
            let kept: Vec<StoredAnswer> =
                finished.iter().flat_map(|&row| worth_keeping(&points, answers, row, &names)).collect();
            let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
            let stored = open.as_mut().map_or(Ok(()), |open| open.store.keep(model, &kept));
            if let Err(error) = stored {
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
            let mut out = told.lock().unwrap_or_else(PoisonError::into_inner);
            for &row in finished {
                for output in 0..answers.outputs() {
                    out.pass_on(missing[row], output, answers, row, output);
                }
            }
            let rows: Vec<usize> = finished.iter().map(|&row| missing[row]).collect();
            run.finished(&rows, &out);
        };
        let withdraw = |rows: &[usize]| {
            let points: Vec<Vec<f64>> = rows.iter().map(|&row| points.row(row)).collect();
            let mut open = self.open.lock().unwrap_or_else(PoisonError::into_inner);
            let done = open.as_mut().map_or(Ok(()), |open| open.store.withdraw(model, &points));
            if let Err(error) = done {
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        };
        // What cannot be kept is not paid for: no more is asked, and what is known already stays.
        let stop = || {
            let failed = || failure.lock().unwrap_or_else(PoisonError::into_inner).is_some();
            run.stop_reason().or_else(|| failed().then_some(StopReason::Requested))
        };
        let within = run.within(&finished, &stop).withdrawing(&withdraw);
        self.process.evaluate(&Ask { points: &points, ..*ask }, &within, &mut answers);
        let out = told.into_inner().unwrap_or_else(PoisonError::into_inner);
        out.spent(answers.extra());
        out.retried(answers.count_retried());
        out.note_non_repeatable(answers.non_repeatable().iter().cloned());
        if let Some(error) = failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            refuse(out, &not_kept(&error));
        }
    }
}

/// What is still open is not evaluated, for this reason.
fn refuse(out: &mut Responses, error: &EvaluationError) {
    let mut unsent = 0;
    for row in 0..out.rows() {
        let open: Vec<usize> = (0..out.outputs()).filter(|&output| out.is_open(row, output)).collect();
        unsent += i64::from(open.len() == out.outputs());
        for output in open {
            out.fail(row, output, error.clone());
        }
    }
    out.spent(-unsent);
}

/// Values, and reasons for none that the program gave itself.
fn worth_keeping(points: &Points, answers: &Responses, row: usize, names: &[&str]) -> Vec<StoredAnswer> {
    let kept = |(output, name): (usize, &&str)| {
        let answer = match (answers.value(row, output), answers.error(row, output)) {
            (Some(value), _) => Ok(value),
            (None, Some(EvaluationError::Process(error))) => match &error.fault {
                ProcessFault::NoValue { message } => Err(message.clone()),
                _ => return None,
            },
            _ => return None,
        };
        Some(StoredAnswer { point: points.row(row), output: (*name).to_owned(), answer })
    };
    names.iter().enumerate().filter_map(kept).collect()
}
