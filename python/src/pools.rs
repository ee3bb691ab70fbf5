//! Thread pools for the engine: one for each run, kept for the next one.
//!
//! Runs share no pool: a model may analyse another study, and the outer run holds a thread while it waits. Pools belong to a process.
//! Threads do not survive a fork, so a forked child ignores the inherited pools and makes its own.

use std::sync::Mutex;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Idle pools with their requested number of threads, and the process that made them.
static IDLE: Mutex<Idle> = Mutex::new(Idle { process: 0, pools: Vec::new() });

/// Most idle pools that are kept.
const KEPT: usize = 4;

struct Idle {
    process: u32,
    pools: Vec<(usize, ThreadPool)>,
}

/// Pool of one run, which becomes idle when the run ends.
pub(crate) struct Pool {
    threads: usize,
    process: u32,
    pool: Option<ThreadPool>,
}

impl Pool {
    /// Returns a pool with so many threads; 0 for one per processor.
    pub(crate) fn of(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let process = std::process::id();
        let mut pool = None;
        // After a fork while another thread held the lock, the list is never available again.
        if let Ok(mut idle) = IDLE.try_lock() {
            if idle.process != process {
                // The threads exist in the parent only. Dropping the pools would wait for them forever.
                std::mem::take(&mut idle.pools).into_iter().for_each(std::mem::forget);
                idle.process = process;
            }
            let found = idle.pools.iter().position(|(kept, _)| *kept == threads);
            pool = found.map(|place| idle.pools.swap_remove(place).1);
        }
        let pool = pool.map_or_else(|| ThreadPoolBuilder::new().num_threads(threads).build(), Ok)?;
        Ok(Self { threads, process, pool: Some(pool) })
    }

    /// Runs work on a thread of the pool.
    pub(crate) fn spawn(&self, work: impl FnOnce() + Send + 'static) {
        if let Some(pool) = &self.pool {
            pool.spawn(work);
        }
    }
}

impl Drop for Pool {
    fn drop(&mut self) {
        let Some(pool) = self.pool.take() else { return };
        if self.process != std::process::id() {
            std::mem::forget(pool);
            return;
        }
        match IDLE.try_lock() {
            Ok(mut idle) if idle.process == self.process && idle.pools.len() < KEPT => {
                idle.pools.push((self.threads, pool));
            }
            _ => drop(pool),
        }
    }
}
