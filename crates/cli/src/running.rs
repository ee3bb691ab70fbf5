//! The common part of the commands that evaluate: for how long, on how many threads, where answers are kept.

use std::path::Path;
use std::sync::{Arc, Once};
use std::time::{Duration, Instant};

use super::failure::{Exit, Failure};
use super::interrupt;
use super::output::{self, Look};
use sensitol::assembly::Table;
use sensitol::problem::Problem;
use sensitol::summary::{RunSummary, StopReason};
use sensitol::warning::{Counted, Warning};
use sensitol_external::Listener;
use sensitol_numeric::verdict::{self, Judged, Verdict};
use sensitol_report::About;
use sensitol_study::{Externals, JournalPlace, Study};

/// Since when a command runs, and for how long it may.
pub(super) struct Clock {
    begun: Instant,
    limit: Option<Duration>,
}

impl Clock {
    /// From now on, for so many seconds; from now on Ctrl-C is heard too.
    pub(super) fn start(seconds: Option<f64>) -> Self {
        interrupt::listen();
        start_threads();
        let limit = seconds.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
        Self { begun: Instant::now(), limit }
    }

    /// Whether it has a limit.
    pub(super) fn limited(&self) -> bool {
        self.limit.is_some()
    }

    /// Why to stop: the user said so, or the time is up.
    pub(super) fn stop(&self) -> Option<StopReason> {
        let over = || self.limit.is_some_and(|limit| self.begun.elapsed() >= limit);
        interrupt::reason().or_else(|| over().then_some(StopReason::TimeLimit))
    }

    /// Warns of a run that ended early: why, and how much of what was planned it did.
    pub(super) fn stopped(&self, run: &RunSummary, (done, planned): (u64, Option<u64>), counted: Counted, look: Look) {
        // A run that was interrupted when all was done is reported as interrupted too.
        let Some(cause) = interrupt::reason().or(run.stopped) else { return };
        let limit_s = self.limit.filter(|_| cause == StopReason::TimeLimit).map(|limit| limit.as_secs_f64());
        look.warn(&Warning::Stopped { cause, limit_s, done, planned, counted });
    }

    /// The facts about the study that a report shows beside the results.
    pub(super) fn about(&self, study: &Study) -> About {
        About {
            title: study.title.clone(),
            sha256: study.sha256.clone(),
            warnings: study.warnings.clone(),
            block: study.about.clone(),
        }
    }
}

/// Where the answers of an external model are kept, and who hears it.
pub(super) fn externals(journal: Option<&Path>, look: Look, points: Option<Arc<Table>>) -> Externals {
    Externals { journal: JournalPlace::asked(journal), listener: listener(look), points, ..Externals::default() }
}

/// Who shows what an external program writes to stderr: the terminal, when all details are asked for.
pub(super) fn listener(look: Look) -> Option<Listener> {
    look.verbose.then(|| Arc::new(|line: &str| output::model_line(line)) as Listener)
}

/// Where the system gives no more threads, everything is done by the one that there is.
fn start_threads() {
    static TRIED: Once = Once::new();
    TRIED.call_once(|| {
        if rayon::ThreadPoolBuilder::new().build().is_err() {
            let _ = rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build_global();
        }
    });
}

/// Does the work with as many threads as were asked for, on one of them: a thread beside them would hand every loop over and sleep until it is
/// done, and keep memory of its own.
pub(super) fn on_threads<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let Some(threads) = threads else { return Ok(rayon::scope(|_| work())) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build();
    Ok(pool.map_err(|error| Failure::Threads { threads, reason: error.to_string() })?.install(work))
}

/// That every answer could be kept: a run whose journal could not be written has no result.
pub(super) fn kept(problem: &Problem) -> Result<(), Failure> {
    match problem.function().account().and_then(|account| account.not_kept) {
        Some(reason) => Err(Failure::NotKept { reason }),
        None => Ok(()),
    }
}

/// How a run ends that would end like this, were all its answers confirmed.
pub(super) fn confirmed(exit: Exit, run: &RunSummary) -> Exit {
    if run.unconfirmed() { exit.worse(Exit::NoResult) } else { exit }
}

/// How `--check` ends: a run that left planned points open says nothing, and everything that is required must be met.
pub(super) fn checked(unfinished: bool, judged: impl IntoIterator<Item = Judged>) -> Exit {
    match verdict::worst(judged.into_iter().map(|one| one.verdict)) {
        _ if unfinished => Exit::NoResult,
        None | Some(Verdict::Met) => Exit::Done,
        Some(_) => Exit::Missed,
    }
}
