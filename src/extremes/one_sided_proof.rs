//! Proof that no assembly lies beyond a limit, for each side of a characteristic independently of the other.

use crate::assembly::Bounds;
use crate::extremes::proof::least;
use crate::problem::Problem;
use sensitol_numeric::distribution::Distribution;

/// Boxes of a side for up to `FEW` dimensions.
const BOXES: usize = 1000;
/// Dimensions beyond which fewer boxes are examined, in inverse proportion: each box then takes more operations.
const FEW: usize = 10;

/// Proves for each side in `asked`, by interval arithmetic, that no assembly is below the lower or above the upper
/// limit.
///
/// Every dimension may be anywhere in the support of its distribution. A side is first tested with the bounds over all
/// supports. If these are finite, branch and bound follows until no box can lie beyond the limit. Returns false for a
/// side without a limit, and if the function has no bounds. It costs no evaluation.
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
        // The upper limit becomes a lower limit of the negated characteristic.
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
