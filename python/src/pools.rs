//! Threads for the engine: a pool for each run, kept for the next one.
//!
//! Runs share no pool. A model may analyse another study, and the outer run holds a thread while it waits for that. Pools belong to a
//! process: threads do not survive a fork, so a forked child leaves the pools that it inherited alone and makes its own.

use std::sync::Mutex;

use rayon::{ThreadPool, ThreadPoolBuildError, ThreadPoolBuilder};

/// Pools that nothing uses, with their number of threads as asked for, and the process that made them.
static IDLE: Mutex<Idle> = Mutex::new(Idle { process: 0, pools: Vec::new() });

/// Most pools that are kept.
const KEPT: usize = 4;

struct Idle {
    process: u32,
    pools: Vec<(usize, ThreadPool)>,
}

/// A pool of one run. It is given back when the run is over.
pub(crate) struct Pool {
    threads: usize,
    process: u32,
    pool: Option<ThreadPool>,
}

impl Pool {
    /// Of so many threads; 0 for as many as the machine has processors.
    pub(crate) fn of(threads: usize) -> Result<Self, ThreadPoolBuildError> {
        let process = std::process::id();
        let mut pool = None;
        // A fork may have come while another thread held the lock: then the list is out of reach for good.
        if let Ok(mut idle) = IDLE.try_lock() {
            if idle.process != process {
                // Their threads are those of the parent: to end them would be to wait for threads that are not there.
                std::mem::take(&mut idle.pools).into_iter().for_each(std::mem::forget);
                idle.process = process;
            }
            let found = idle.pools.iter().position(|(kept, _)| *kept == threads);
            pool = found.map(|place| idle.pools.swap_remove(place).1);
        }
        let pool = pool.map_or_else(|| ThreadPoolBuilder::new().num_threads(threads).build(), Ok)?;
        Ok(Self { threads, process, pool: Some(pool) })
    }

    /// Does the work on one of its threads.
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
