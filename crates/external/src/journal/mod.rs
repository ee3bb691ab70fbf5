//! Journal of external programs: their answers on disk, since one evaluation may have cost a minute of CAD time.
//!
//! Every answer is in the file before it is used. So a killed run continues at the same place, and a repeated or enlarged one evaluates
//! only the new points. The key of an answer is the model, the exact point, and the output. The key of a model consists of program and
//! arguments, the contents of its script and of the files that it depends on, the adapter's own description, constants, and names and units
//! of the dimensions.
//!
//! Every run evaluates the nominal point again. If its value differs from the journal, the model has changed, and all its answers are
//! deleted. An answer that a sentinel puts in doubt is deleted at once, and kept again only after another, trusted process has given it. A
//! point for which the program itself reports no value is kept too. A crash or a missed deadline is not kept: the next run tries again.
//! Every row has a checksum, and a damaged answer counts as unknown.

mod checksum;
mod claims;
mod content;
mod error;
mod recollection;
pub mod store;

pub use error::{JournalError, JournalFault};
pub use store::{KnownModel, Store, StoredAnswer};

use std::collections::HashSet;
use std::path::PathBuf;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use sha2::{Digest, Sha256};

use self::claims::{BEAT, Watch};
use self::recollection::Recollection;
use crate::Settings;
use crate::process::{Process, Recheck};
use sensitol::assembly::{
    AssemblyFunction, EvaluationError, ModelInfo, Points, Progress, RecordedFailure, Request, Responses, Run, Signature,
};
use sensitol::assembly::{EvaluatorAccount, OutdatedJournal, ProcessFault};
use sensitol::summary::StopReason;

/// Time between two looks for the end of another run's claim.
const LOOK: Duration = Duration::from_millis(20);

/// An external program with its answers in a journal.
///
/// Evaluations: the points that the file does not hold.
pub struct Journaled {
    process: Process,
    path: PathBuf,
    files: Vec<PathBuf>,
    open: Mutex<Option<Open>>,
    /// Held while a batch is evaluated, since the stage and the claim of a run belong to one batch.
    turn: Mutex<()>,
}

struct Open {
    store: Store,
    model: i64,
    /// True if the model sends derivatives.
    gradients: bool,
    /// True if the nominal point has been evaluated in this run.
    rechecked: bool,
    /// True if the journal states that answers of the model depend on the points before them.
    flips: bool,
    /// Difference between the model and its answers in the journal; None if there is none.
    outdated: Option<OutdatedJournal>,
    /// Reason why nothing can be kept any more; None while the journal works.
    failure: Option<JournalError>,
}

impl Journaled {
    /// Keeps the answers of `process` in the journal at `path`. `files` are those that it depends on besides its arguments.
    pub fn new(process: Process, path: PathBuf, files: Vec<PathBuf>) -> Self {
        Self { process, path, files, open: Mutex::new(None), turn: Mutex::new(()) }
    }

    /// Key of the answers of this model.
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
        // Only hashes of contents count, since names say nothing about contents and the study may have been moved. The first file among the
        // arguments is the script. A later one may be its log.
        let Settings { argv, folder, .. } = self.process.settings();
        let script = argv.iter().map(|word| folder.join(word)).find(|path| path.is_file());
        let files: Vec<PathBuf> = script.into_iter().chain(self.files.iter().cloned()).collect();
        let files = files.iter().map(hash).collect::<Result<Vec<String>, EvaluationError>>()?;
        let constants: serde_json::Map<String, serde_json::Value> =
            self.process.greeting().constants.iter().map(|(name, value)| (name.clone(), (*value).into())).collect();
        let mut identity = serde_json::json!({
            "command": argv,
            "adapter": adapter.name,
            "version": adapter.version,
            "files": files,
            "constants": constants,
            "dimensions": inputs.iter().map(|input| &input.name).collect::<Vec<_>>(),
            "units": inputs.iter().map(|input| &input.unit).collect::<Vec<_>>(),
        });
        // With converted units the same point is sent as other numbers.
        if self.process.converts() {
            identity["units converted"] = true.into();
        }
        Ok(identity.to_string())
    }

    fn opened(&self, outputs: &[usize]) -> Result<Open, EvaluationError> {
        let identity = self.identity(outputs)?;
        let dimensions: Vec<String> = self.signature().inputs.iter().map(|input| input.name.clone()).collect();
        let store = Store::open(&self.path).map_err(|error| not_kept(&error))?;
        let model = store.model(&identity, &dimensions).map_err(|error| not_kept(&error))?;
        // A model without answers needs no recheck: only answers of runs at the same time can be reused.
        let rechecked = !store.has_answers(model).map_err(|error| not_kept(&error))?;
        let gradients = self.process.adapter(outputs).map_err(Box::new)?.gradients;
        let flips = store.flips(model).map_err(|error| not_kept(&error))?;
        if flips {
            self.process.expect_flips();
        }
        Ok(Open { store, model, gradients, rechecked, flips, outdated: None, failure: None })
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

    fn account(&self) -> Option<EvaluatorAccount> {
        let open = self.opened_store();
        let mut account = self.process.account();
        if let Some(open) = open.as_ref() {
            account.outdated.clone_from(&open.outdated);
            account.damaged = open.store.damaged();
            account.not_kept = open.failure.as_ref().map(ToString::to_string);
        }
        Some(account)
    }

    fn own_checks(&self, answers: usize) -> usize {
        self.process.own_checks(answers)
    }

    fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
        // Answers that no run has checked since the file was opened may belong to another model.
        let open = self.opened_store();
        let Some(open) = open.as_ref().filter(|open| open.rechecked && open.failure.is_none()) else {
            return Vec::new();
        };
        // A journal that cannot be read any more is reported by the next evaluation.
        let stored = open.store.failures(open.model).unwrap_or_default();
        let output = |name: &str| outputs.iter().copied().find(|&of| self.signature().outputs[of].name == name);
        let failure = |one: StoredAnswer| {
            Some(RecordedFailure { output: output(&one.output)?, point: one.point.into_iter().map(Some).collect() })
        };
        stored.into_iter().filter_map(failure).collect()
    }

    fn evaluate(&self, ask: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        if let Err(error) = self.prepare(ask.outputs) {
            return refuse(out, &error);
        }
        // The stage and the claim of a run belong to one batch.
        let _turn = self.turn.lock().unwrap_or_else(PoisonError::into_inner);
        if let Err(error) = self.evaluated(ask, run, out) {
            let message = not_kept(&error);
            if let Some(open) = self.opened_store().as_mut() {
                open.failure.get_or_insert(error);
            }
            refuse(out, &message);
        }
    }
}

/// Rows that a batch evaluates or checks.
struct Work {
    /// Rows without an answer.
    missing: Vec<usize>,
    /// Rows whose answers are known from a run that ended before their check.
    unchecked: Vec<usize>,
    /// Stages of these answers.
    stages: Vec<i64>,
}

/// Use of known answers after their check.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reuse {
    /// All may be used.
    All,
    /// Some were deleted, so that the others are read again.
    ReadAgain,
    /// A stop came before it was known whether the model is the same.
    Nothing,
}

impl Journaled {
    fn opened_store(&self) -> MutexGuard<'_, Option<Open>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Calls a function on the open journal. Fails if the journal has failed before.
    fn with<T>(&self, act: impl FnOnce(&mut Open) -> Result<T, JournalError>) -> Result<T, JournalError> {
        match self.opened_store().as_mut() {
            Some(Open { failure: Some(failure), .. }) => Err(failure.clone()),
            Some(open) => act(open),
            None => Err(JournalError { path: self.path.clone(), fault: JournalFault::Missing }),
        }
    }

    /// Answers all rows: known ones from the journal, and those of no other run by evaluation. Rows that another run has claimed are waited
    /// for.
    fn evaluated(&self, ask: &Request<'_>, run: &Run<'_>, out: &mut Responses) -> Result<(), JournalError> {
        let names: Vec<&str> =
            ask.outputs.iter().map(|&output| self.signature().outputs[output].name.as_str()).collect();
        let rows: Vec<Vec<f64>> = (0..ask.points.rows()).map(|row| ask.points.row(row)).collect();
        let mut wanted: Vec<usize> = (0..rows.len()).collect();
        let mut watch = Watch::default();
        let mut gone = Vec::new();
        while !wanted.is_empty() {
            let (mut found, version) = self.with(|open| {
                let version = open.store.version()?;
                Ok((Recollection::of(open, &names, &rows, &wanted)?, version))
            })?;
            let unsettled = found.unsettled();
            // An answer at which another run is working is not confirmed and may still change.
            let others: Vec<usize> = match unsettled.is_empty() {
                true => Vec::new(),
                false => self.with(|open| {
                    let points: Vec<Vec<f64>> = unsettled.iter().map(|&row| rows[row].clone()).collect();
                    let mine = open.store.claim(open.model, &points, &gone)?;
                    Ok(unsettled.iter().zip(mine).filter(|(_, mine)| !mine).map(|(&row, _)| row).collect())
                })?,
            };
            // A write by another run since the first look may have changed the answers, so they are read again.
            if !others.is_empty() || self.with(|open| open.store.version())? != version {
                let theirs: HashSet<usize> = others.iter().copied().collect();
                let own: Vec<usize> = wanted.iter().copied().filter(|row| !theirs.contains(row)).collect();
                found = self.with(|open| Recollection::of(open, &names, &rows, &own))?;
            }
            let done = self.known_or_evaluated(ask, (&names, &rows), found, run, out);
            let released = self.with(|open| open.store.release());
            done.and(released)?;
            wanted = others;
            if run.stopped() || run.abandoned() {
                return Ok(());
            }
            if !wanted.is_empty() {
                gone = self.wait(&mut watch, run)?;
            }
        }
        Ok(())
    }

    /// Waits until a claim of another run ends, or a run is gone. Returns the runs that are gone.
    fn wait(&self, watch: &mut Watch, run: &Run<'_>) -> Result<Vec<i64>, JournalError> {
        loop {
            let claimants = self.with(|open| open.store.claimants(open.model))?;
            let gone: Vec<i64> = claimants.iter().filter(|one| watch.is_gone(one)).map(|one| one.run).collect();
            if !gone.is_empty() || claimants.len() < watch.len() || claimants.is_empty() {
                watch.keep(&claimants);
                return Ok(gone);
            }
            if run.stopped() || run.abandoned() {
                return Ok(Vec::new());
            }
            std::thread::sleep(LOOK);
        }
    }

    /// Answers rows without claims of other runs: known ones from the journal, and the others by evaluation.
    fn known_or_evaluated(
        &self,
        ask: &Request<'_>,
        (names, rows): (&[&str], &[Vec<f64>]),
        mut found: Recollection,
        run: &Run<'_>,
        out: &mut Responses,
    ) -> Result<(), JournalError> {
        if !found.known.is_empty() {
            match self.rechecked(ask, names, rows, &found, run, out)? {
                Reuse::All => {}
                Reuse::ReadAgain => {
                    let own: Vec<usize> = found.rows();
                    found = self.with(|open| Recollection::of(open, names, rows, &own))?;
                }
                Reuse::Nothing => found = Recollection { missing: found.rows(), ..Recollection::default() },
            }
        }
        let stopped = run.stopped() || run.abandoned();
        if stopped {
            // Nothing checks them any more.
            found.drop_unconfirmed();
        }
        let known: Vec<usize> = found.known.iter().map(|(row, _)| *row).collect();
        // Without replays the answers are used as they are, and the mark stays for a run that checks them.
        let replays = self.process.settings().replays();
        let unchecked = if replays { found.unconfirmed_rows() } else { Vec::new() };
        if !known.is_empty() && replays {
            let (points, values) = found.confirmed_values(rows);
            self.process.remember(ask.outputs, &points, &values);
        }
        for (row, answers) in std::mem::take(&mut found.known) {
            for (output, answer) in answers.into_iter().enumerate() {
                match answer {
                    Ok(value) => {
                        out.set(row, output, value);
                        let kept = self.with(|open| match open.gradients {
                            true => open.store.gradient(open.model, &rows[row], names[output]),
                            false => Ok(None),
                        })?;
                        if let Some(slopes) = kept {
                            out.set_gradient(row, output, slopes);
                        }
                    }
                    Err(message) => out.fail(row, output, EvaluationError::Refused { message }),
                }
            }
        }
        out.reused(known.len());
        run.progressed(Progress { points: known.len(), failed: out.failed_among(&known), reused: known.len() });
        run.finished(&known, out);
        if stopped || (found.missing.is_empty() && unchecked.is_empty()) {
            return Ok(());
        }
        self.asked(ask, (names, rows), &Work { missing: found.missing, unchecked, stages: found.stages }, run, out)
    }

    /// Checks known answers against the model before their use: the nominal point, once in a run.
    fn rechecked(
        &self,
        ask: &Request<'_>,
        names: &[&str],
        rows: &[Vec<f64>],
        found: &Recollection,
        run: &Run<'_>,
        out: &mut Responses,
    ) -> Result<Reuse, JournalError> {
        if self.with(|open| Ok(open.rechecked))? {
            return Ok(Reuse::All);
        }
        if run.stopped() || run.abandoned() {
            return Ok(Reuse::Nothing);
        }
        let at = [self.process.greeting().nominal.clone()];
        let kept = self.with(|open| Recollection::of(open, names, &at, &[0]))?;
        let nominal: Option<Vec<Option<f64>>> = kept.values(&at).1.pop();
        let reuse = match self.process.recheck(ask.outputs, nominal.as_deref(), &found.values(rows).1, run, out) {
            Recheck::Stopped => return Ok(Reuse::Nothing),
            Recheck::Same(now) => self.with(|open| {
                if nominal.is_none() {
                    open.keep_nominal(names, &at[0], &now)?;
                }
                Ok(Reuse::All)
            })?,
            Recheck::Changed(now) => self.with(|open| {
                let before = nominal.unwrap_or_default();
                let differs = (0..names.len()).find(|&output| before.get(output) != now.get(output)).unwrap_or(0);
                let answers = open.store.forget_answers(open.model)?;
                open.outdated.get_or_insert(OutdatedJournal::new(
                    names[differs],
                    [before.get(differs).copied().flatten(), now.get(differs).copied().flatten()],
                    answers,
                ));
                open.keep_nominal(names, &at[0], &now).map(|()| Reuse::ReadAgain)
            })?,
        };
        self.with(|open| {
            open.rechecked = true;
            Ok(())
        })?;
        Ok(reuse)
    }

    /// Keeps the finding that answers of the model depend on the points before them.
    fn note_flips(&self) -> Result<(), JournalError> {
        if !self.process.flips() {
            return Ok(());
        }
        self.with(|open| {
            if !open.flips {
                open.flips = true;
                open.store.note_flips(open.model)?;
            }
            Ok(())
        })
    }

    /// Evaluates rows, and checks them together with answers of a run that ended before their check. Every answer is kept before it is
    /// returned.
    fn asked(
        &self,
        ask: &Request<'_>,
        (names, rows): (&[&str], &[Vec<f64>]),
        work: &Work,
        run: &Run<'_>,
        out: &mut Responses,
    ) -> Result<(), JournalError> {
        let model = self.with(|open| {
            open.store.open_stage(open.model)?;
            Ok(open.model)
        })?;
        // In the order of the request, like a run that was not ended.
        let mut asked: Vec<usize> = work.missing.iter().chain(&work.unchecked).copied().collect();
        asked.sort_unstable();
        let points = Points::from_rows(&asked.iter().map(|&row| &rows[row]).collect::<Vec<_>>());
        let mut answers = Responses::open(asked.len(), out.outputs());
        for (place, &row) in asked.iter().enumerate() {
            (0..out.outputs()).for_each(|output| answers.pass_on(place, output, out, row, output));
        }
        let (told, failure) = (Mutex::new(out), Mutex::new(None::<JournalError>));
        let note = |result: Result<(), JournalError>| {
            if let Err(error) = result {
                failure.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(error);
            }
        };
        let workers = self.process.settings().workers.max(1);
        let (begun, done) = (Instant::now(), AtomicUsize::new(0));
        let finished = |finished: &[usize], answers: &Responses| {
            let kept: Vec<StoredAnswer> =
                finished.iter().flat_map(|&row| worth_keeping(&points, answers, row, names)).collect();
            let all = done.fetch_add(finished.len(), Ordering::Relaxed) + finished.len();
            note(self.with(|open| {
                open.store.set_durable(is_slow(begun.elapsed(), workers, all))?;
                open.store.keep(model, &kept)?;
                open.keep_gradients(names, &points, answers, finished)
            }));
            let mut out = told.lock().unwrap_or_else(PoisonError::into_inner);
            for &row in finished {
                for output in 0..answers.outputs() {
                    out.pass_on(asked[row], output, answers, row, output);
                }
            }
            let rows: Vec<usize> = finished.iter().map(|&row| asked[row]).collect();
            run.finished(&rows, &out);
        };
        let withdraw = |rows: &[usize]| {
            let points: Vec<Vec<f64>> = rows.iter().map(|&row| points.row(row)).collect();
            note(self.with(|open| open.store.withdraw(model, &points)));
        };
        let beat = Mutex::new(Instant::now());
        // Once an answer cannot be kept, no more points are evaluated. Answers that are known stay.
        let stop = || {
            let mut beat = beat.lock().unwrap_or_else(PoisonError::into_inner);
            if beat.elapsed() >= BEAT {
                *beat = Instant::now();
                note(self.with(|open| open.store.beat()));
            }
            note(self.note_flips());
            let failed = || failure.lock().unwrap_or_else(PoisonError::into_inner).is_some();
            run.stop_reason().or_else(|| failed().then_some(StopReason::Requested))
        };
        let within = run.within(&finished, &stop).withdrawing(&withdraw);
        self.process.evaluate(&Request { points: &points, ..*ask }, &within, &mut answers);
        let out = told.into_inner().unwrap_or_else(PoisonError::into_inner);
        out.spent(answers.extra());
        out.retried(answers.count_retried());
        out.leave_unchecked(answers.count_unchecked());
        out.note_non_repeatable(answers.non_repeatable().iter().cloned());
        answers.revoked().iter().for_each(|point| out.revoke(point.clone()));
        if let Some(error) = failure.into_inner().unwrap_or_else(PoisonError::into_inner) {
            return Err(error);
        }
        self.note_flips()?;
        self.end_stage(names, rows, work, &answers, !run.stopped() && !run.abandoned())
    }

    /// Ends the stage of a batch. Its answers are marked as confirmed if the batch was done and checked.
    fn end_stage(
        &self,
        names: &[&str],
        rows: &[Vec<f64>],
        work: &Work,
        answers: &Responses,
        done: bool,
    ) -> Result<(), JournalError> {
        let checked = done && answers.count_unchecked() == 0;
        let confirmed = self.process.take_confirmed();
        self.with(|open| {
            if !answers.revoked().is_empty() {
                open.store.withdraw(open.model, answers.revoked())?;
            }
            if open.flips {
                open.store.confirm(open.model, &confirmed, names, &[])?;
            }
            if checked {
                let points: Vec<Vec<f64>> = work.unchecked.iter().map(|&row| rows[row].clone()).collect();
                open.store.confirm(open.model, &points, names, &work.stages)?;
            }
            open.store.close_stage(checked)
        })
    }
}

impl Open {
    /// Keeps the derivatives that came with answers.
    fn keep_gradients(
        &mut self,
        names: &[&str],
        points: &Points,
        answers: &Responses,
        rows: &[usize],
    ) -> Result<(), JournalError> {
        for &row in rows.iter().filter(|_| self.gradients) {
            for (output, name) in names.iter().enumerate() {
                if let Some(slopes) = answers.gradient(row, output) {
                    self.store.keep_gradient(self.model, &points.row(row), name, slopes)?;
                }
            }
        }
        Ok(())
    }

    /// Keeps the values of the nominal point.
    fn keep_nominal(&mut self, names: &[&str], at: &[f64], values: &[Option<f64>]) -> Result<(), JournalError> {
        let kept = |(name, value): (&&str, &Option<f64>)| {
            Some(StoredAnswer { point: at.to_vec(), output: (*name).to_owned(), answer: Ok((*value)?) })
        };
        let kept: Vec<StoredAnswer> = names.iter().zip(values).filter_map(kept).collect();
        self.store.keep(self.model, &kept)
    }
}

/// Time of an evaluation above which its answer is written through to the disk: it is then worth more than that write.
const SLOW: Duration = Duration::from_millis(100);

/// True if an evaluation is slow, given this time for so many answers of so many processes.
fn is_slow(elapsed: Duration, workers: usize, answers: usize) -> bool {
    elapsed * u32::try_from(workers).unwrap_or(u32::MAX) > SLOW * u32::try_from(answers).unwrap_or(u32::MAX)
}

/// Fails all points that are still open, with this error.
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

/// Answers to keep: values, and the program's own reports that there is none.
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Derivatives must be deleted with their answer. Otherwise they would count as those of the next answer at that point.
    #[test]
    fn derivatives_go_with_their_answer() {
        let folder = tempfile::tempdir().unwrap();
        let mut store = Store::open(&folder.path().join("a.sqlite")).unwrap();
        let model = store.model("{}", &["a".to_owned()]).unwrap();
        let kept = StoredAnswer { point: vec![1.0], output: "y".to_owned(), answer: Ok(2.0) };
        store.keep(model, &[kept]).unwrap();
        store.keep_gradient(model, &[1.0], "y", &[3.0]).unwrap();
        assert_eq!(store.gradient(model, &[1.0], "y").unwrap(), Some(vec![3.0]));
        store.withdraw(model, &[vec![1.0]]).unwrap();
        assert_eq!(store.gradient(model, &[1.0], "y").unwrap(), None);
    }

    /// Eight processes that take 0.2 s each give forty answers a second, and yet each evaluation is slow.
    #[test]
    fn what_is_slow_is_an_evaluation() {
        assert!(is_slow(Duration::from_secs(1), 8, 40));
        assert!(!is_slow(Duration::from_secs(1), 8, 400) && !is_slow(Duration::from_millis(90), 1, 1));
    }
}
