//! The proof that no assembly lies beyond a limit: of each side by itself, whatever the other one does.

use super::proof::least;
use crate::assembly::Bounds;
use crate::problem::Problem;
use sensitol_numeric::distribution::Distribution;

/// Boxes of a side, as long as there are few dimensions.
const BOXES: usize = 1000;
const FEW: usize = 10;

/// Of the sides that are `asked` for, whether interval arithmetic proves that no assembly is below the lower limit of a characteristic, and
/// none above the upper one.
///
/// Every dimension may be anywhere in the support of its distribution. A side is proven by the bounds over all supports, and where these are
/// finite by branch and bound until no box can lie beyond the limit. False without that limit, and where the function has no bounds. No
/// evaluation.
pub(crate) fn keeps_by_proof(problem: &Problem, c: usize, asked: [bool; 2]) -> [bool; 2] {
    if !asked.contains(&true) || !problem.characteristics()[c].limits().exist() {
        return [false; 2];
    }
    let (depends, output) = (problem.dependence().swap_remove(c), problem.outputs()[c]);
    let all: Vec<[f64; 2]> = (problem.dimensions().iter())
        .map(|dimension| dimension.distribution().map_or([dimension.mean(); 2], Distribution::support))
        .collect();
    let Some(whole) = problem.function().bounds(output, &all) else { return [false; 2] };
    let places: Vec<usize> = (0..all.len()).filter(|&d| depends[d] && all[d][0] < all[d][1]).collect();
    let region: Vec<[f64; 2]> = places.iter().map(|&d| all[d]).collect();
    let bounded = region.iter().flatten().all(|end| end.is_finite());
    let limit = BOXES * FEW / region.len().max(FEW);
    let side = |side: usize| {
        let sign = [1.0, -1.0][side];
        // The least that is kept: of the upper side of what has the other sign.
        let kept = sign * problem.kept_limits(c).ends()[side];
        let signed = |bounds: Bounds| if sign > 0.0 { bounds } else { bounds.negated() };
        if !asked[side] || !kept.is_finite() {
            return false;
        }
        let found = signed(whole.clone());
        if found.value.lower() >= kept {
            return true;
        }
        let bounds = |part: &[[f64; 2]]| {
            let mut ends = all.clone();
            places.iter().zip(part).for_each(|(&d, &end)| ends[d] = end);
            let mut bounds = problem.function().bounds(output, &ends).unwrap_or_else(|| whole.clone());
            bounds.slopes = places.iter().map(|&d| bounds.slopes[d]).collect();
            signed(bounds)
        };
        bounded && least(&bounds, &region, &[], kept, 0.0, limit, &|| false).lower >= kept
    };
    [side(0), side(1)]
}
