//! Common parts of the commands that evaluate: time limit, threads, and journal.

use std::path::Path;
use std::sync::{Arc, Once};
use std::time::{Duration, Instant};

use crate::calendar_date::today;
use crate::failure::{Exit, Failure};
use crate::interrupt;
use crate::output;
use crate::output::Look;
use sensitol::assembly::Table;
use sensitol::problem::Problem;
use sensitol::summary::{RunSummary, StopReason};
use sensitol::warning::{Counted, Warning};
use sensitol_external::Listener;
use sensitol_numeric::verdict::{self, Judged, Verdict};
use sensitol_report::About;
use sensitol_study::{Externals, JournalPlace, Study};

/// Start time of a command, and its time limit.
pub(super) struct Clock {
    begun: Instant,
    limit: Option<Duration>,
    /// Date of the report.
    date: Option<String>,
}

impl Clock {
    /// Starts the clock with a limit in seconds, and installs the handler of Ctrl-C. Fails if the requested date does not exist.
    pub(super) fn start(seconds: Option<f64>) -> Result<Self, Failure> {
        let date = today()?;
        interrupt::listen();
        start_threads();
        let limit = seconds.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
        Ok(Self { begun: Instant::now(), limit, date })
    }

    /// True if there is a time limit.
    pub(super) fn limited(&self) -> bool {
        self.limit.is_some()
    }

    /// Returns the stop reason: an interruption by the user, or the time limit.
    pub(super) fn stop(&self) -> Option<StopReason> {
        let over = || self.limit.is_some_and(|limit| self.begun.elapsed() >= limit);
        interrupt::reason().or_else(|| over().then_some(StopReason::TimeLimit))
    }

    /// Warns of a run that ended early, with the cause and the number of finished evaluations.
    pub(super) fn stopped(&self, run: &RunSummary, (done, planned): (u64, Option<u64>), counted: Counted, look: Look) {
        // An interruption after the last evaluation is reported as well.
        let Some(cause) = interrupt::reason().or(run.stopped) else { return };
        let limit_s = self.limit.filter(|_| cause == StopReason::TimeLimit).map(|limit| limit.as_secs_f64());
        look.warn(&Warning::Stopped { cause, limit_s, done, planned, counted });
    }

    /// Returns the facts about the study that a report shows beside the results.
    pub(super) fn about(&self, study: &Study) -> About {
        About {
            title: study.title.clone(),
            sha256: study.sha256.clone(),
            warnings: study.warnings.clone(),
            block: study.about.iter().cloned().chain(self.date.clone().map(|date| ("Date", date))).collect(),
            scene: study.scene(),
        }
    }
}

/// Returns the settings of external models: journal, listener, and given answers.
pub(super) fn externals(journal: Option<&Path>, look: Look, points: Option<Arc<Table>>) -> Externals {
    Externals { journal: JournalPlace::asked(journal), listener: listener(look), points, ..Externals::default() }
}

/// Returns a listener for the stderr lines of an external model, which prints them if `--verbose` is set.
pub(super) fn listener(look: Look) -> Option<Listener> {
    look.verbose.then(|| Arc::new(|line: &str| output::model_line(line)) as Listener)
}

/// Falls back to a single thread if the system refuses to start more.
fn start_threads() {
    static TRIED: Once = Once::new();
    TRIED.call_once(|| {
        if rayon::ThreadPoolBuilder::new().build().is_err() {
            let _ = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
        }
    });
}

/// Runs work on one of `threads` threads. A caller outside the pool would hand over every loop, sleep meanwhile, and keep memory of its
/// own.
pub(super) fn on_threads<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let Some(threads) = threads else { return Ok(rayon::scope(|_| work())) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build();
    Ok(pool.map_err(|error| Failure::Threads { threads, reason: error.to_string() })?.install(work))
}

/// Checks that every answer was kept and that the model has values. A run whose journal could not be written, or whose model fails at every
/// point, has no result.
pub(super) fn kept(problem: &Problem) -> Result<(), Failure> {
    let Some(account) = problem.function().account() else { return Ok(()) };
    if let Some(reason) = account.not_kept {
        return Err(Failure::NotKept { reason });
    }
    match account.fails_everywhere {
        Some(error) => Err(Failure::FailsEverywhere { error: Box::new(error) }),
        None => Ok(()),
    }
}

/// Worsens an exit code if answers of the run are not confirmed.
pub(super) fn confirmed(exit: Exit, run: &RunSummary) -> Exit {
    if run.unconfirmed() { exit.worse(Exit::NoResult) } else { exit }
}

/// Exit code of `--check`: planned points that are left open give no result, and every requirement must be met.
pub(super) fn checked(unfinished: bool, judged: impl IntoIterator<Item = Judged>) -> Exit {
    match verdict::worst(judged.into_iter().map(|one| one.verdict)) {
        _ if unfinished => Exit::NoResult,
        None | Some(Verdict::Met) => Exit::Done,
        Some(_) => Exit::Missed,
    }
}
