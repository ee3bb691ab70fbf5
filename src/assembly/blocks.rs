//! Parallel evaluation of cheap models: a batch is cut into blocks of rows.

use crate::assembly::{Points, Request, Responses, Run};
use sensitol_numeric::parallel::prelude::*;

/// Rows that one task evaluates: enough to hide the cost of a task, and few enough to stay in the cache.
pub(crate) const BLOCK: usize = 1024;

/// Returns the number of points whose values stay in a near cache, a power of two.
pub fn near_rows(dimensions: usize) -> usize {
    /// Number of values in two megabytes.
    const VALUES: usize = 1 << 18;
    1 << (VALUES / dimensions.max(1)).max(128).ilog2()
}

/// Evaluates `block` on blocks of about a thousand rows, in parallel on rayon's current pool.
///
/// `block` receives a range of rows of `points` and fills a response of its own, so that the answers do not depend on the number of
/// threads. It is for functions that are cheap and need no state. A process pool has threads of its own.
pub fn in_blocks(
    request: &Request<'_>,
    run: &Run<'_>,
    out: &mut Responses,
    block: impl Fn(&Points, std::ops::Range<usize>, &mut Responses) + Sync,
) {
    in_ranges(request.points.rows(), request.outputs.len(), run, out, |range, out| block(request.points, range, out));
}

/// Evaluates `block` on blocks of `rows` points with `outputs` outputs. The caller holds the points.
pub fn in_ranges(
    rows: usize,
    outputs: usize,
    run: &Run<'_>,
    out: &mut Responses,
    block: impl Fn(std::ops::Range<usize>, &mut Responses) + Sync,
) {
    let evaluate = |first: usize| {
        let range = first..(first + BLOCK).min(rows);
        let mut answers = Responses::open(range.len(), outputs);
        if !run.stopped() {
            block(range, &mut answers);
        }
        (first, answers)
    };
    if rows <= BLOCK {
        // An untouched response of the right shape can be filled as it is.
        if !out.is_untouched() || (out.rows(), out.outputs()) != (rows, outputs) {
            out.reopen(rows, outputs);
        }
        if !run.stopped() {
            block(0..rows, out);
        }
    } else {
        let starts: Vec<usize> = (0..rows).step_by(BLOCK).collect();
        let answered: Vec<_> = starts.into_par_iter().map(evaluate).collect();
        for (first, answers) in answered {
            out.adopt(first, answers);
        }
    }
    if !run.tells() {
        return;
    }
    let finished: Vec<usize> = (0..rows).filter(|&row| (0..outputs).all(|output| !out.is_open(row, output))).collect();
    run.finished(&finished, out);
}
