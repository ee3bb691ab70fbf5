//! Risks of an inspection, from the points of a sample.

use crate::estimate::{inspected_point, inspection_risks};
use crate::simulation::count::{Count, Replicate};
use crate::simulation::replicate_error::of_replicates;
use sensitol_numeric::capability::{EstimatedShare, InspectionRisks, guard_reaching};
use sensitol_numeric::characteristic::{Characteristic, KeptLimits};
use sensitol_numeric::inspection::Guard;
use sensitol_numeric::sampling::Fine;

/// A part of the sample between two values, without a limit in it.
struct Piece {
    /// Middle of the piece, which represents its values.
    at: f64,
    points: f64,
    good: bool,
}

/// Means over all points.
#[derive(Clone, Copy)]
struct Means {
    /// Shares of parts that are bad and accepted, good and rejected, and accepted.
    shares: [f64; 3],
    /// Mean squares of the contributions of every point to the shares.
    squares: [f64; 3],
}

/// Risks of the inspection of a characteristic with a gauge. Returns None if no point has a value.
pub(super) fn inspected(
    characteristic: &Characteristic,
    kept: KeptLimits,
    count: &Count,
    all: Option<&Fine>,
) -> Option<InspectionRisks> {
    let (inspection, limits) = (characteristic.inspection()?, characteristic.limits());
    let (all, gauge) = (all?, inspection.gauge());
    let outside = [0, 1].map(|side| count.replicates.iter().map(|replicate| replicate.outside[side]).sum());
    // The guard band is chosen for all points, and the scatter of the replicates gives the errors.
    let whole = pieces(all, kept, outside);
    let guard = match inspection.guard() {
        Guard::Width(width) => Some(width),
        Guard::FalseAccept(rate) => {
            let accepted = |guard: f64| means(&whole, kept, gauge, guard).map_or(0.0, |of| of.shares[0]);
            guard_reaching(&accepted, limits, gauge, rate)
        }
    };
    let found = guard.and_then(|guard| Some((means(&whole, kept, gauge, guard)?, guard)));
    let shares = found.map(|(of, guard)| {
        let each = |replicate: &Replicate| {
            let fine = replicate.fine.as_ref()?;
            means(&pieces(fine, kept, replicate.outside), kept, gauge, guard)
        };
        let replicates: Vec<Option<Means>> = match count.replicates.len() {
            1 => Vec::new(),
            _ => count.replicates.iter().map(each).collect(),
        };
        let n = all.total() as f64;
        let share = |index: usize| {
            let value = of.shares[index];
            let scatter = match replicates.is_empty() {
                true => Some(((of.squares[index] - value * value).max(0.0) / n).sqrt()),
                false => of_replicates(replicates.iter().map(|of| of.map(|of| of.shares[index]))),
            };
            // Without a hit, up to three are possible: the error is at least one point.
            EstimatedShare { value, error: scatter.map(|error| error.max(1.0 / n)) }
        };
        [0, 1, 2].map(share)
    });
    let shares = shares.map_or([None; 3], |shares| shares.map(Some));
    Some(inspection_risks((inspection, limits), guard, shares))
}

/// Bins of a sample, divided at the limits. The counts outside, which are exact, divide the points of such a bin.
fn pieces(fine: &Fine, limits: KeptLimits, outside: [u64; 2]) -> Vec<Piece> {
    let [lower, upper] = limits.ends();
    let beyond = |[from, to]: [f64; 2]| [to <= lower, from > upper];
    // Points outside in the bins that contain a limit.
    let mut left = outside;
    for (ends, count) in fine.filled() {
        for (left, beyond) in left.iter_mut().zip(beyond(ends)) {
            *left = left.saturating_sub(if beyond { count } else { 0 });
        }
    }
    let mut pieces = Vec::new();
    for (ends, count) in fine.filled() {
        let [below, above] = beyond(ends);
        let mut add = |[from, to]: [f64; 2], points: u64, good: bool| {
            pieces.extend((points > 0).then_some(Piece { at: 0.5 * (from + to), points: points as f64, good }));
        };
        if below || above {
            add(ends, count, false);
            continue;
        }
        let ([from, to], mut inside) = (ends, count);
        let low = Some(lower).filter(|lower| from < *lower);
        let high = Some(upper).filter(|upper| to > *upper);
        if let Some(low) = low {
            let points = left[0].min(inside);
            (left[0], inside) = (left[0] - points, inside - points);
            add([from, low], points, false);
        }
        if let Some(high) = high {
            let points = left[1].min(inside);
            (left[1], inside) = (left[1] - points, inside - points);
            add([high, to], points, false);
        }
        add([low.unwrap_or(from), high.unwrap_or(to)], inside, true);
    }
    pieces
}

/// Means over all points of the pieces. Returns None if there are no points.
fn means(pieces: &[Piece], limits: KeptLimits, gauge: f64, guard: f64) -> Option<Means> {
    let total: f64 = pieces.iter().map(|piece| piece.points).sum();
    let (mut shares, mut squares) = ([0.0; 3], [0.0; 3]);
    for piece in pieces {
        let parts = inspected_point(piece.at, piece.good, limits, gauge, guard);
        for (index, part) in parts.into_iter().enumerate() {
            shares[index] += piece.points * part / total;
            squares[index] += piece.points * part * part / total;
        }
    }
    (total > 0.0).then_some(Means { shares, squares })
}
