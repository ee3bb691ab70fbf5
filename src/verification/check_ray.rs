//! Residuals of a surface along straight lines from the means, through check points far from them.

use std::ops::Range;

use crate::estimate::strata::{dot, length, unit};
use crate::verification::check_points::{Design, ON_LINE};
use sensitol_numeric::distribution::standard_normal;

/// Part of a ray without a point of its own up to which the surface is taken to hold.
const HELD: f64 = 0.5;
/// Parts of the way to a point at which a large residual is located.
const PARTS: [f64; 4] = [1.0 / 3.0, 1.0 / 2.0, 2.0 / 3.0, 5.0 / 6.0];
/// Greatest number of rays on which a residual is located.
const LOCATED: usize = 2;
/// Residual in sigmas from which on it is located: at four sigmas it changes a reject rate by a factor of three.
const LARGE: f64 = 0.3;
/// Factor of the root mean square at the random points from which on a residual is sudden. At three sigmas the residuals of a parabola through
/// the nodes of a three-point rule are 7 times as large for a cubic, and 8 times for a quartic.
const SUDDEN: f64 = 10.0;
/// Part of the last residual below which an earlier one is no part of it.
const NOTHING: f64 = 0.02;
/// Component of a direction above which the ray is the axis of that input.
const ALONG_ONE: f64 = 0.99;
/// Greatest power with which a residual grows beyond the last point.
const STEEPEST: f64 = 6.0;
/// Factor of the distance of the last point beyond which a residual stays as it is.
const FARTHER: f64 = 1.5;
/// Residual in sigmas above which all are alike, those of points without a value included.
const MOST_SIGMAS: f64 = 10.0;

/// Greatest number of evaluations that locate residuals, if the surface does not hold.
pub const MOST_LOCATING: usize = LOCATED * PARTS.len();

/// A straight line from the means with check points.
#[derive(Debug, Clone)]
pub(super) struct CheckRay {
    /// Direction of length 1.
    pub(super) direction: Vec<f64>,
    /// Distance and row of every check point on it, the nearest first.
    stations: Vec<(f64, usize)>,
}

/// Residuals of one characteristic along a ray.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Profile {
    /// Distances and residuals in sigmas, from the last place at which the surface holds.
    Residual(Vec<[f64; 2]>),
    /// Distance of the last point with a value, and of the first one without.
    WithoutValue([f64; 2]),
}

/// Rays of a design and of the decision points after it.
pub(super) fn rays(design: &Design, decisions: &[Vec<f64>]) -> Vec<CheckRay> {
    let row_of = |row: usize| CheckRay::through(&design.points[row], row);
    let mut rays = Vec::new();
    // A line has two points on either side.
    for line in 0..design.lines.len() {
        for far in [2, 3] {
            let (near_row, far_row) = (4 * line + far - 2, 4 * line + far);
            let mut ray = row_of(far_row);
            ray.stations.insert(0, (ON_LINE[far - 2].abs(), near_row));
            rays.push(ray);
        }
    }
    rays.extend((4 * design.lines.len()..design.random()).map(row_of));
    let after = design.points.len();
    rays.extend(decisions.iter().enumerate().map(|(index, point)| CheckRay::through(point, after + index)));
    rays
}

/// Indices of the rays on which residuals are located: large and sudden ones, those with the greatest share of the assemblies beyond first.
///
/// Shapes: `residuals` has a column for every characteristic, with a row for every point; `random` are the rows of random points.
pub(super) fn to_locate(rays: &[CheckRay], residuals: &[Vec<f64>], random: Range<usize>) -> Vec<usize> {
    // Residuals up to which a characteristic has nothing to locate.
    let least: Vec<f64> = residuals.iter().map(|d| LARGE.max(SUDDEN * root_mean_square(&d[random.clone()]))).collect();
    let weight = |ray: &CheckRay| {
        let size_of = |(d, least): (&Vec<f64>, &f64)| match d[ray.last().1].abs() {
            last if !last.is_finite() => MOST_SIGMAS,
            last if last > *least => last.min(MOST_SIGMAS),
            _ => 0.0,
        };
        let size = residuals.iter().zip(&least).map(size_of).fold(0.0, f64::max);
        if ray.stations.len() == 1 { size * standard_normal::sf(HELD * ray.last().0) } else { 0.0 }
    };
    let mut found: Vec<(usize, f64)> =
        rays.iter().map(weight).enumerate().filter(|(_, weight)| *weight > 0.0).collect();
    found.sort_by(|a, b| b.1.total_cmp(&a.1));
    found.truncate(LOCATED);
    found.into_iter().map(|(index, _)| index).collect()
}

/// Root mean square of the residuals at points with a value. 0 without such points.
fn root_mean_square(d: &[f64]) -> f64 {
    let known: Vec<f64> = d.iter().copied().filter(|d| d.is_finite()).collect();
    length(&known) / (known.len().max(1) as f64).sqrt()
}

impl CheckRay {
    /// Evaluations that locate the residual of one ray.
    pub(super) const LOCATING: usize = PARTS.len();

    fn through(point: &[f64], row: usize) -> Self {
        Self { direction: unit(point.to_vec()), stations: vec![(length(point), row)] }
    }

    /// Ray without a point.
    pub(super) fn towards(direction: Vec<f64>) -> Self {
        Self { direction, stations: Vec::new() }
    }

    /// Adds a point at a distance, with its row.
    pub(super) fn add(&mut self, distance: f64, row: usize) {
        self.stations.push((distance, row));
        self.stations.sort_by(|a, b| a.0.total_cmp(&b.0));
    }

    pub(super) fn is_empty(&self) -> bool {
        self.stations.is_empty()
    }

    /// True if the ray has this direction, of length 1.
    pub(super) fn is_along(&self, direction: &[f64]) -> bool {
        dot(&self.direction, direction) > ALONG_ONE
    }

    /// True if the ray is the axis of one input.
    pub(super) fn is_of_one_input(&self) -> bool {
        self.direction.iter().any(|part| part.abs() > ALONG_ONE)
    }

    /// True if the farthest residual is large, and sudden or one of many that are large: a surface that follows the model has none. `d` has the
    /// residual of every row.
    pub(super) fn refutes(&self, d: &[f64], random: Range<usize>) -> bool {
        let (last, near) = (d[self.last().1].abs(), root_mean_square(&d[random]));
        last.is_finite() && last > LARGE && (last > SUDDEN * near || near > LARGE)
    }

    /// Farthest point on it.
    pub(super) fn end(&self) -> Vec<f64> {
        self.direction.iter().map(|part| part * self.last().0).collect()
    }

    fn last(&self) -> (f64, usize) {
        *self.stations.last().expect("a ray has a point")
    }

    /// Points that locate a residual, in rows from `row` on.
    pub(super) fn locate(&mut self, row: usize) -> Vec<Vec<f64>> {
        let distance = self.last().0;
        let at = PARTS.map(|part| part * distance);
        self.stations.extend(at.iter().enumerate().map(|(index, &t)| (t, row + index)));
        self.stations.sort_by(|a, b| a.0.total_cmp(&b.0));
        at.iter().map(|t| self.direction.iter().map(|part| t * part).collect()).collect()
    }

    /// Residuals along the ray. `d` has the residual in sigmas of every row, NaN without a value.
    pub(super) fn profile(&self, d: &[f64]) -> Profile {
        let at: Vec<[f64; 2]> = self.stations.iter().map(|&(t, row)| [t, d[row]]).collect();
        let alone = at.len() == 1;
        if let Some(first) = at.iter().position(|[_, d]| !d.is_finite()) {
            let last = if first > 0 { at[first - 1][0] } else { HELD * at[first][0] };
            return Profile::WithoutValue([last, at[first][0]]);
        }
        let end = at[at.len() - 1][1].abs();
        let start = if alone { [HELD * at[0][0], 0.0] } else { [0.0; 2] };
        // Places without a residual before the first one that counts are no part of the profile.
        let quiet = at.iter().take_while(|[_, d]| d.abs() <= NOTHING * end).count().min(at.len() - 1);
        let begin = if quiet > 0 { at[quiet - 1] } else { start };
        Profile::Residual(std::iter::once(begin).chain(at[quiet..].iter().copied()).collect())
    }
}

impl Profile {
    /// True if the model has no value at a point of the ray.
    pub(super) fn is_without_value(&self) -> bool {
        matches!(self, Self::WithoutValue(_))
    }

    /// Distance from which on the model may differ from the surface.
    pub(super) fn from(&self) -> f64 {
        match self {
            Self::Residual(at) => at[0][0],
            Self::WithoutValue([last, _]) => *last,
        }
    }

    /// Residual at a distance: linear between the points. Beyond the last one, up to `end`, a residual that grows follows the power of the
    /// distance through the last two points, and any other the line through them.
    pub(super) fn residual(at: &[[f64; 2]], t: f64, end: f64) -> f64 {
        let [last, _] = at[at.len() - 1];
        let t = t.min(end.max(last));
        let segment = at.windows(2).find(|pair| t <= pair[1][0]).unwrap_or(&at[at.len() - 2..]);
        let ([a, low], [b, high]) = (segment[0], segment[1]);
        let ratio = high / low;
        if t > last && a > 0.0 && ratio > 1.0 && ratio < 1.0 / NOTHING {
            let power = (libm::log(ratio) / libm::log(b / a)).min(STEEPEST);
            return high * libm::pow((t / b).min(FARTHER), power);
        }
        low + (high - low) * (t - a) / (b - a)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A contact from 2 sigmas on: the places before it are no part of the profile, and the residual grows on beyond the last point.
    #[test]
    fn a_profile_begins_where_the_surface_holds_last() {
        let mut ray = CheckRay::through(&[0.0, 3.0], 0);
        let at = ray.locate(1);
        assert_eq!(at[0], [0.0, 1.0]);
        assert_eq!(at.len(), PARTS.len());
        // Row 0 at 3 sigmas, rows 1 to 4 at 1, 1.5, 2 and 2.5.
        let Profile::Residual(profile) = ray.profile(&[2.0, 0.0, 0.0, 0.0, 1.0]) else { panic!("a value everywhere") };
        assert_eq!(profile, [[2.0, 0.0], [2.5, 1.0], [3.0, 2.0]]);
        assert_eq!(Profile::residual(&profile, 2.25, 4.5), 0.5);
        // Twice as much at 1.2 times the distance: the power ln 2/ln 1.2 = 3.8.
        let beyond = Profile::residual(&profile, 3.6, 4.5);
        assert!((beyond - 4.0).abs() < 1e-12, "{beyond}");
        assert_eq!(Profile::residual(&profile, 9.0, 4.5), Profile::residual(&profile, 4.5, 4.5));
    }

    /// A model and its mirror image have opposite residuals at every distance, whatever the shape of the profile.
    #[test]
    fn residuals_do_not_depend_on_the_sign_of_the_model() {
        let profiles: [&[[f64; 2]]; 4] = [
            &[[1.5, 0.0], [3.0, 3.2]],
            &[[2.0, 0.0], [2.5, 1.2], [3.0, 3.2]],
            &[[0.0, 0.0], [1.5, 0.4], [3.0, 0.1]],
            &[[1.0, 1e-17], [1.5, -1e-17], [3.0, 2.0]],
        ];
        for profile in profiles {
            let mirrored: Vec<[f64; 2]> = profile.iter().map(|[t, d]| [*t, -d]).collect();
            for t in [1.6, 2.9, 3.5, 4.5, 7.0] {
                assert_eq!(
                    Profile::residual(profile, t, 4.5),
                    -Profile::residual(&mirrored, t, 4.5),
                    "{profile:?} at {t}"
                );
            }
        }
        // From nothing at all the line goes on: twice as far beyond the start, twice the residual.
        assert!((Profile::residual(profiles[0], 4.5, 4.5) - 6.4).abs() < 1e-12);
    }

    #[test]
    fn a_point_without_a_value_lies_between_its_neighbours() {
        let mut ray = CheckRay::through(&[3.0], 0);
        assert_eq!(ray.profile(&[f64::NAN]), Profile::WithoutValue([1.5, 3.0]));
        ray.locate(1);
        let found = ray.profile(&[f64::NAN, 0.0, 0.0, f64::NAN, f64::NAN]);
        assert_eq!(found, Profile::WithoutValue([1.5, 2.0]));
    }
}
