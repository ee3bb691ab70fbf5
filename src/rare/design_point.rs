//! Places where the surrogate crosses a limit first: its design points, and the bend of the limit there.

use faer::{Mat, Side};

use crate::estimate::Columns;
use crate::estimate::strata::{dot, length};
use crate::rare::target::Target;
use sensitol_numeric::distribution::standard_normal;

/// Greatest distance in sigmas. Probabilities farther out are below the smallest double.
pub(super) const FARTHEST: f64 = 37.0;
/// Start of a half-space before its place, in sigmas. The place is known to some hundredths, and the limit may bend
/// towards the means.
pub(super) const BEFORE: f64 = 0.3;
/// Greatest number of places of one target.
const PLACES: usize = 12;
/// Least probability of a place relative to the nearest one: less likely places add nothing.
pub(super) const FAINT: f64 = 1e-3;
/// Greatest number of dimensions for which the bend of the limit is computed. Its cost is their square times that of the surrogate.
const BENT: usize = 40;
/// Number of axes along which places are searched in addition to the steepest way.
const AXES: usize = 8;
/// Number of pairs of dimensions along whose diagonals places are searched.
const DIAGONALS: usize = 4;

/// Origin of a place, which decides the density of its points.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum PlaceKind {
    /// Crossing of the surrogate: points follow the crossings on all lines.
    Surrogate,
    /// Way on which the surrogate only comes near the limit.
    Way,
    /// Crossing of the model itself: points are drawn from the half-space that begins a little before it.
    HalfSpace,
    /// Corner of the model's rejects: points are drawn about it, and beyond it in each of its coordinates.
    Corner,
}

/// Direction in which a limit is crossed.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub(super) target: usize,
    /// Unit vector from the means.
    pub(super) direction: Vec<f64>,
    /// Distance from the means, in sigmas.
    pub(super) distance: f64,
    pub(super) kind: PlaceKind,
    /// Margin of the surrogate at the crossing: 0 at its own, another value if the model crosses elsewhere.
    pub(super) offset: f64,
    /// Unit vectors across the direction in which points spread otherwise than the inputs, each with its factor.
    pub(super) spreads: Vec<(Vec<f64>, f64)>,
}

/// Places of a target. The list is empty if the means themselves lie beyond the limit.
pub(super) fn places(index: usize, target: &Target<'_>) -> Vec<Place> {
    let n = target.space.len();
    let (margin, gradient) = target.gradient(&vec![0.0; n]);
    if n == 0 || margin >= 0.0 {
        return Vec::new();
    }
    let mut found: Vec<Place> = Vec::new();
    for start in starts(target, &gradient) {
        let Some(point) = nearest(target, start) else { continue };
        let distance = length(&point);
        let direction: Vec<f64> = point.iter().map(|z| z / distance).collect();
        if !found.iter().any(|place| dot(&place.direction, &direction) > 0.9) {
            let spreads = spreads(target, &point, distance);
            let kind = PlaceKind::Surrogate;
            found.push(Place { target: index, direction, distance, kind, offset: 0.0, spreads });
        }
    }
    found.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    if let Some(first) = found.first().map(|place| place.distance) {
        let probability = standard_normal::sf;
        found.retain(|place| probability(place.distance) >= FAINT * probability(first));
        found.truncate(PLACES);
    }
    // The steepest way is added too, because the surrogate may be wrong about it.
    let way = if found.is_empty() { steepest(target, gradient) } else { unit(gradient) };
    if let Some(direction) = way.filter(|way| !found.iter().any(|place| dot(&place.direction, way) > 0.9)) {
        found.push(Place::uncrossed(index, direction));
    }
    found
}

impl Place {
    /// Way without a known crossing.
    pub(super) fn uncrossed(target: usize, direction: Vec<f64>) -> Self {
        Self { target, direction, distance: 0.0, kind: PlaceKind::Way, offset: 0.0, spreads: Vec::new() }
    }

    /// Half-space beside a point of the limit.
    pub(super) fn half_space(target: usize, point: &[f64]) -> Option<Self> {
        let distance = length(point);
        let direction = unit(point.to_vec())?;
        Some(Self { target, direction, distance, kind: PlaceKind::HalfSpace, offset: 0.0, spreads: Vec::new() })
    }

    /// Corner of the rejects at a point: all coordinates that are not 0 must be at least as far out.
    pub(super) fn corner(target: usize, point: &[f64]) -> Option<Self> {
        Some(Self { kind: PlaceKind::Corner, ..Self::half_space(target, point)? })
    }

    /// Distances of a corner in its coordinates: the index, the sign, and the distance in sigmas.
    pub(super) fn sides(&self) -> impl Iterator<Item = (usize, f64, f64)> + '_ {
        let coordinates = self.direction.iter().enumerate().filter(|(_, part)| **part != 0.0);
        coordinates.map(|(j, part)| (j, part.signum(), part.abs() * self.distance))
    }

    /// Probability beyond the place: of the half-space at its distance, or of its corner. 0 without a crossing.
    pub(super) fn probability(&self) -> f64 {
        match self.kind {
            PlaceKind::Way => 0.0,
            PlaceKind::Surrogate | PlaceKind::HalfSpace => standard_normal::sf(self.distance),
            PlaceKind::Corner => self.sides().map(|(_, _, distance)| standard_normal::sf(distance)).product(),
        }
    }

    /// True if the place comes from rejects of the model, not from the surrogate.
    pub(super) fn is_shown(&self) -> bool {
        matches!(self.kind, PlaceKind::HalfSpace | PlaceKind::Corner)
    }

    /// True if a limit is crossed at the place.
    pub(super) fn crossed(&self) -> bool {
        self.kind != PlaceKind::Way
    }

    /// True if a point lies in the half-space that begins a little before the place.
    pub(super) fn holds(&self, point: &[f64]) -> bool {
        self.crossed() && dot(&self.direction, point) > self.distance - BEFORE
    }

    /// Distances in sigmas at which the model is evaluated on the way to a place.
    pub(super) fn stations(&self) -> Vec<f64> {
        let mut stations = vec![1.5, 2.5, 3.5, 4.5, 5.5, 6.5, 8.0];
        if self.crossed() {
            stations.retain(|t| (t - self.distance).abs() > 0.25);
            stations.push(self.distance);
        }
        stations.sort_unstable_by(f64::total_cmp);
        stations
    }

    /// Distances of the second round, close to the crossing that the first round found.
    pub(super) fn closer(&self) -> Vec<f64> {
        [-0.4, 0.0, 0.4].iter().map(|by| self.distance + by).filter(|&t| t > 0.0).collect()
    }

    /// Moves the place to the crossing of the model with the limit on this way. Returns false, and moves nothing, if
    /// there is none.
    ///
    /// Between the stations the model is taken as the surrogate plus its error, which is interpolated linearly.
    ///
    /// Shapes: `values` has the model's value at every distance with one.
    pub(super) fn correct(&mut self, target: &Target<'_>, values: &[(f64, f64)]) -> bool {
        /// Step along the way, in sigmas.
        const STEP: f64 = 0.02;
        let margins = |at: &[f64]| {
            target.margins(&self.direction.iter().map(|part| at.iter().map(|t| t * part).collect()).collect())
        };
        let stations: Vec<f64> = values.iter().map(|value| value.0).collect();
        let off =
            values.iter().zip(margins(&stations)).map(|(&(t, value), margin)| (t, target.margin_of(value) - margin));
        // At the means the model and the surrogate agree.
        let off: Vec<(f64, f64)> = std::iter::once((0.0, 0.0)).chain(off).collect();
        let Some(&(last, _)) = off.last() else { return false };
        let ways: Vec<f64> = (1..=(last / STEP) as usize).map(|step| STEP * step as f64).collect();
        let along = margins(&ways);
        let residual = |t: f64| {
            let after = off.partition_point(|station| station.0 < t).clamp(1, off.len() - 1);
            let ((a, low), (b, high)) = (off[after - 1], off[after]);
            low + (high - low) * (t - a) / (b - a)
        };
        let crossing = ways.iter().zip(&along).position(|(&t, margin)| margin + residual(t) >= 0.0);
        if let Some(at) = crossing {
            (self.distance, self.offset, self.kind) = (ways[at], along[at], PlaceKind::Surrogate);
        }
        crossing.is_some()
    }
}

/// Starting points on the limit: on the steepest way, the axes of the surrogate's greatest rise, and the diagonals of the strongest
/// interactions.
fn starts(target: &Target<'_>, gradient: &[f64]) -> Vec<Vec<f64>> {
    /// Steps of a quarter sigma to which a way is followed.
    const REACH: usize = 40;
    let n = gradient.len();
    let steep = length(gradient);
    let mut ways = Vec::new();
    if steep > 0.0 {
        ways.push(gradient.iter().map(|slope| slope / steep).collect());
    }
    let along = |j: usize, sign: f64| {
        let mut way = vec![0.0; n];
        way[j] = sign;
        way
    };
    let mut axes: Vec<(f64, usize, f64)> = Vec::new();
    for sign in [1.0, -1.0] {
        let columns: Columns =
            (0..n).map(|j| (0..n).map(|row| if row == j { 3.0 * sign } else { 0.0 }).collect()).collect();
        axes.extend(target.margins(&columns).into_iter().enumerate().map(|(j, margin)| (margin, j, sign)));
    }
    axes.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    ways.extend(axes.iter().take(AXES).map(|&(_, j, sign)| along(j, sign)));
    let mut pairs = target.surrogate.interactions.pairs();
    pairs.sort_by(|a, b| b.2.abs().total_cmp(&a.2.abs()));
    for &(j, k, _) in pairs.iter().take(DIAGONALS) {
        for (a, b) in [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)] {
            let mut way = along(j, a * std::f64::consts::FRAC_1_SQRT_2);
            way[k] = b * std::f64::consts::FRAC_1_SQRT_2;
            ways.push(way);
        }
    }
    let crossing = |(index, way): (usize, Vec<f64>)| {
        let steps = || (1..=REACH).map(|step| 0.25 * step as f64);
        let columns: Columns = way.iter().map(|part| steps().map(|t| t * part).collect()).collect();
        let crossed = target.margins(&columns).iter().position(|&margin| margin >= 0.0);
        // The steepest way is kept even without a crossing, because a bent way may still lead to one.
        let t = crossed.map(|at| 0.25 * (at + 1) as f64).or((index == 0 && steep > 0.0).then_some(3.0))?;
        Some(way.into_iter().map(|part| t * part).collect())
    };
    ways.into_iter().enumerate().filter_map(crossing).collect()
}

/// Point of the limit nearest to the means, by the improved method of Hasofer, Lind, Rackwitz and Fiessler (Zhang and
/// Der Kiureghian 1995).
///
/// Each step goes to the nearest point of the tangent plane, shortened until it lowers the merit.
fn nearest(target: &Target<'_>, start: Vec<f64>) -> Option<Vec<f64>> {
    let mut z = start;
    let (mut margin, mut gradient) = target.gradient(&z);
    for _ in 0..100 {
        let steep = dot(&gradient, &gradient);
        if !(steep > 0.0 && steep.is_finite()) {
            return None;
        }
        let factor = (dot(&gradient, &z) - margin) / steep;
        let step: Vec<f64> = z.iter().zip(&gradient).map(|(z, slope)| factor * slope - z).collect();
        if margin.abs() < 1e-6 && length(&step) < 1e-4 {
            return (length(&z) > 0.0 && length(&z) <= FARTHEST).then_some(z);
        }
        let weight = 2.0 * length(&z) / steep.sqrt() + 1.0;
        let merit = |z: &[f64], margin: f64| 0.5 * dot(z, z) + weight * margin.abs();
        let before = merit(&z, margin);
        let mut part = 1.0;
        loop {
            let trial: Vec<f64> = z.iter().zip(&step).map(|(z, step)| z + part * step).collect();
            let (there, slopes) = target.gradient(&trial);
            if merit(&trial, there) < before || part < 1e-3 {
                (z, margin, gradient) = (trial, there, slopes);
                break;
            }
            part *= 0.5;
        }
    }
    None
}

/// Direction of the surrogate's nearest approach to a limit that it does not reach, at five sigmas.
fn steepest(target: &Target<'_>, gradient: Vec<f64>) -> Option<Vec<f64>> {
    /// Distance from the means at which the gradient is followed, in sigmas.
    const RADIUS: f64 = 5.0;
    let mut direction = gradient;
    for _ in 0..50 {
        let size = length(&direction);
        if size.is_nan() || size <= 0.0 {
            return None;
        }
        let point: Vec<f64> = direction.iter().map(|part| RADIUS * part / size).collect();
        direction = target.gradient(&point).1;
    }
    unit(direction)
}

/// Directions across in which the points beyond the limit spread otherwise than the inputs, with their factors.
///
/// If the limit bends away from the tangent plane by `k c^2/2` at a distance `c` across, the points beyond it spread by
/// `1/sqrt(1 + distance k)` (Breitung 1984). The spread is greater if the limit bends towards the means.
fn spreads(target: &Target<'_>, point: &[f64], distance: f64) -> Vec<(Vec<f64>, f64)> {
    /// Step of the second differences, in sigmas.
    const STEP: f64 = 0.1;
    let n = point.len();
    if !(2..=BENT).contains(&n) {
        return Vec::new();
    }
    let (_, gradient) = target.gradient(point);
    let steep = length(&gradient);
    let slopes = |j: usize, by: f64| {
        let mut moved = point.to_vec();
        moved[j] += by;
        target.gradient(&moved).1
    };
    let rows: Vec<Vec<f64>> = (0..n)
        .map(|j| slopes(j, STEP).iter().zip(slopes(j, -STEP)).map(|(up, down)| (up - down) / (2.0 * STEP)).collect())
        .collect();
    let normal: Vec<f64> = gradient.iter().map(|slope| slope / steep).collect();
    let across = Mat::from_fn(n, n, |j, k| f64::from(u8::from(j == k)) - normal[j] * normal[k]);
    let second = Mat::from_fn(n, n, |j, k| 0.5 * (rows[j][k] + rows[k][j]));
    let bent = &across * second * &across;
    let Ok(eigen) = bent.self_adjoint_eigen(Side::Lower) else { return Vec::new() };
    let mut spreads = Vec::new();
    for (index, &value) in eigen.S().column_vector().iter().enumerate() {
        let direction: Vec<f64> = (0..n).map(|j| eigen.U()[(j, index)]).collect();
        let square = 1.0 - distance * value / steep;
        let spread = if square > 0.25 { 1.0 / square.sqrt() } else { 2.0 };
        if dot(&direction, &normal).abs() < 1e-6 && !(0.95..=1.05).contains(&spread) {
            spreads.push((direction, spread.max(0.3)));
        }
    }
    spreads
}

/// Unit vector of a direction. Returns None if it has no length.
pub(super) fn unit(mut direction: Vec<f64>) -> Option<Vec<f64>> {
    let size = length(&direction);
    direction.iter_mut().for_each(|part| *part /= size);
    (size > 0.0 && size.is_finite()).then_some(direction)
}
