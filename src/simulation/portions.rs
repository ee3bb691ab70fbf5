//! Division of a sample into portions that are evaluated side by side.

use std::ops::Range;

use crate::assembly::near_rows;
use crate::simulation::shard_sums::Shard;
use crate::simulation::{COSTLY, REPLICATES, ROWS, SimulationOptions, TASKS};
use sensitol_numeric::sampling::{Portion, Sampler};

/// Points of a costly model that choose the bins of all shards.
const COSTLY_SCALE: usize = 64;

/// Portions of a sample, a batch at a time, with equal progress of all replicates.
pub(super) struct Portions {
    replicates: u64,
    rows: u64,
    /// Number of points in all replicates together.
    pub(super) total: u64,
    /// Number of points in each replicate.
    each: u64,
    done: u64,
    pub(super) costly: bool,
    /// Factor on the number of tasks of a batch.
    pub(super) at_once: usize,
    /// Shard of which the rows of every portion are evaluated. None for all rows.
    shard: Option<Shard>,
}

impl Portions {
    pub(super) fn new(options: &SimulationOptions, costly: bool, dimensions: usize) -> Self {
        let (replicates, each) = match options.sampler {
            Sampler::Random => (1, options.samples),
            Sampler::Sobol => (REPLICATES, options.samples.div_ceil(REPLICATES).next_power_of_two()),
        };
        let rows = if costly && replicates == 1 { COSTLY } else { ROWS.min(near_rows(dimensions)) } as u64;
        Self {
            replicates,
            rows: rows.min(each),
            total: replicates * each,
            each,
            done: 0,
            costly,
            at_once: 1,
            shard: None,
        }
    }

    /// Keeps the part of one shard. A cheap model has whole portions of its own. Of a costly one every shard has a slice of each portion, so
    /// that few points are divided evenly too.
    pub(super) fn of_shard(self, shard: Shard) -> Self {
        if self.costly {
            let slice = |rows: u64| {
                let [low, high] = shard.range(rows);
                high - low
            };
            let total = self.each / self.rows * slice(self.rows) + slice(self.each % self.rows);
            return Self { total, shard: Some(shard), ..self };
        }
        let [low, high] =
            shard.range(self.each.div_ceil(self.rows)).map(|portion| (portion * self.rows).min(self.each));
        Self { total: high - low, each: high, done: low, ..self }
    }

    /// Rows of a portion that are evaluated.
    pub(super) fn slice(&self, portion: Portion) -> Range<usize> {
        match self.shard {
            None => 0..portion.rows,
            Some(shard) => {
                let [low, high] = shard.range(portion.rows as u64);
                low as usize..high as usize
            }
        }
    }

    /// Portions from which the bins of a histogram are chosen, with their rows: the first batch of a cheap model, few points of a costly
    /// one.
    pub(super) fn first_batch(&self) -> Vec<(Portion, usize)> {
        let (most, rows) = if self.costly { (1, COSTLY_SCALE) } else { (TASKS as u64, usize::MAX) };
        let portion = |index: u64| {
            let first = index * self.rows;
            Portion { replicate: 0, first, rows: self.rows.min(self.each - first) as usize }
        };
        let portions = (0..self.each.div_ceil(self.rows).min(most)).map(portion);
        portions.map(|portion| (portion, portion.rows.min(rows))).collect()
    }

    pub(super) fn done(&self) -> bool {
        self.done >= self.each
    }

    pub(super) fn next_batch(&mut self) -> Vec<Portion> {
        let tasks = if self.costly { 1 } else { (self.at_once * TASKS) as u64 / self.replicates };
        let mut batch = Vec::new();
        for _ in 0..tasks {
            if self.done() {
                break;
            }
            let rows = self.rows.min(self.each - self.done) as usize;
            batch.extend((0..self.replicates).map(|replicate| Portion { replicate, first: self.done, rows }));
            self.done += rows as u64;
        }
        batch
    }
}
