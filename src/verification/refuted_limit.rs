//! Limits at which check points refute a surface, and the likeliest points beyond them that the residuals show.

use crate::estimate::Columns;
use crate::estimate::strata::{dot, length};
use crate::verification::check_ray::Profile;
use crate::verification::checked_surface::CheckedSurface;
use crate::verification::far_effect::FarEffect;
use crate::verification::likeliest_point::FARTHEST;

/// Relative change of the share beyond a limit by a residual above which the surface is refuted there.
const REFUTING: f64 = 0.5;
/// Change of a share below which nothing is refuted.
const SELDOM: f64 = 1e-6;
/// Step along a ray, in sigmas.
const STEP: f64 = 0.1;
/// Square of the line's component across a ray below which no point is sought beside the ray.
const BESIDE: f64 = 1e-4;

/// Points in normal space beyond the limits that these residuals refute, one for every ray and limit, with the surface and the residual.
///
/// Shapes: `line` has length 1 and one component for every variable, `kept` the shares of the surface in the intervals of the effects: both
/// limits, the lower, the upper one. Returns None if no residual refutes the surface at a limit. The points may be none although one does:
/// the residual then leads away from the limit.
pub(super) fn refuted(
    surface: &CheckedSurface<'_>,
    line: &[f64],
    refuting: &[&FarEffect<'_>],
    kept: &[f64],
    limits: [f64; 2],
) -> Option<Vec<Vec<f64>>> {
    let (mut points, mut is_refuted) = (Vec::new(), false);
    for effect in refuting {
        let Profile::Residual(at) = &effect.profile else { continue };
        for (side, limit) in limits.into_iter().enumerate().filter(|(_, limit)| limit.is_finite()) {
            let (change, beyond) = (effect.shares[1 + side], 1.0 - kept[1 + side]);
            if change.abs() <= SELDOM.max(REFUTING * beyond) {
                continue;
            }
            is_refuted = true;
            if change < 0.0 {
                points.extend(likeliest(surface, line, (&effect.ray.direction, at), (limit, side == 1)));
            }
        }
    }
    is_refuted.then_some(points)
}

/// Nearest point beyond the limit at which the surface along the ray, with its residual and a step along the line, reaches the limit.
fn likeliest(
    surface: &CheckedSurface<'_>,
    line: &[f64],
    (direction, profile): (&[f64], &[[f64; 2]]),
    (limit, upper): (f64, bool),
) -> Option<Vec<f64>> {
    let sigma = surface.figures[1];
    let sign = if upper { 1.0 } else { -1.0 };
    let first = profile[0][0];
    let steps = ((FARTHEST - first) / STEP).max(0.0) as usize;
    let distances: Vec<f64> = (0..=steps).map(|step| first + STEP * step as f64).collect();
    let columns: Columns = direction.iter().map(|part| distances.iter().map(|t| t * part).collect()).collect();
    let along = dot(line, direction);
    let across: Vec<f64> = line.iter().zip(direction).map(|(part, on)| part - along * on).collect();
    let square = dot(&across, &across);
    let point = |(t, q): (&f64, f64)| {
        // Sigmas that the surface and the residual stay short of the limit. The surface rises by a sigma for each along the line.
        let short = (limit - q) / sigma - Profile::residual(profile, *t, FARTHEST);
        let by = if sign * short <= 0.0 { 0.0 } else { short / square };
        let found = direction.iter().zip(&across).map(|(on, part)| t * on + by * part).collect::<Vec<f64>>();
        (by == 0.0 || square > BESIDE).then_some(found)
    };
    let points = distances.iter().zip(surface.at(&columns)?).filter_map(point);
    points.min_by(|a, b| length(a).total_cmp(&length(b)))
}
