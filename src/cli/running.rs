//! What the commands that evaluate have in common: for how long, on how many threads, where answers are kept.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::failure::Failure;
use super::interrupt;
use super::output::Look;
use crate::assembly::Table;
use crate::assembly::process::Listener;
use crate::report::About;
use crate::study::{Externals, JournalPlace, Study};
use crate::warning::{Counted, StopCause, Warning};

/// Since when a command runs, and for how long it may.
pub(super) struct Clock {
    begun: Instant,
    limit: Option<Duration>,
}

impl Clock {
    /// From now on, for so many seconds; from now on Ctrl-C is heard too.
    pub(super) fn start(seconds: Option<f64>) -> Self {
        interrupt::listen();
        let limit = seconds.map(|seconds| Duration::try_from_secs_f64(seconds).unwrap_or(Duration::MAX));
        Self { begun: Instant::now(), limit }
    }

    /// Whether it has a limit.
    pub(super) fn limited(&self) -> bool {
        self.limit.is_some()
    }

    /// Whether to stop: the time is up, or the user said so.
    pub(super) fn stop(&self) -> bool {
        interrupt::stopped() || self.limit.is_some_and(|limit| self.begun.elapsed() >= limit)
    }

    /// The warning that a run ended before all was done.
    pub(super) fn stopped(&self, done: u64, planned: Option<u64>, counted: Counted) -> Warning {
        let cause = match self.limit {
            Some(limit) if !interrupt::stopped() => StopCause::TimeLimit { limit_s: limit.as_secs_f64() },
            _ => StopCause::Interrupted,
        };
        Warning::Stopped { cause, done, planned, counted }
    }

    /// What a report says of the study beside the results.
    pub(super) fn about(&self, study: &Study, seed: Option<u64>) -> About {
        About {
            title: study.title.clone(),
            sha256: study.sha256.clone(),
            seed,
            wall_s: self.begun.elapsed().as_secs_f64(),
            warnings: study.warnings.clone(),
        }
    }
}

/// Where the answers of an external model are kept, and who hears it.
pub(super) fn externals(journal: Option<&Path>, look: Look, points: Option<Arc<Table>>) -> Externals {
    Externals { journal: JournalPlace::asked(journal), listener: listener(look), points, sentinels: true }
}

/// Who shows what an external program writes to stderr: somebody, when all details are asked for.
pub(super) fn listener(look: Look) -> Option<Listener> {
    look.verbose.then(|| Arc::new(|line: &str| anstream::eprintln!("model: {line}")) as Listener)
}

/// Does the work with as many threads as were asked for.
pub(super) fn on_threads<T: Send>(threads: Option<u16>, work: impl FnOnce() -> T + Send) -> Result<T, Failure> {
    let Some(threads) = threads else { return Ok(work()) };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(usize::from(threads)).build();
    Ok(pool.map_err(|error| Failure::Threads { threads, reason: error.to_string() })?.install(work))
}
