//! Zones that some dimensions share. The worst case is taken over the zone, not over the box around it.
//!
//! ```text
//! disc      sum of u_j^2 <= 1          u_j: deviation from the middle of the band, in half bands
//! rim       sum of u_j^2  = 1
//! diamond   sum of |u_j| <= 1              likewise the octahedron, and the ball is a disc of three coordinates
//! bicone    |u_0| + hypot(u_1, u_2) <= 1
//! rows      the rows of measured parts, where no member has a tolerance of its own
//! ```
//!
//! The least value of a plane over a zone has a closed form: `-|g|` over a disc or rim, `-max |g_j|` over a diamond,
//! `-max(|g_0|, hypot(g_1, g_2))` over a bicone,
//! and the least of all rows. Branch and bound uses it to bound the tangent plane, so that a plane is proven in one
//! box. Source: R. T. Rockafellar, Convex Analysis (1970), section 13: support functions.

use crate::assembly::formula::Interval;
use crate::extremes::model::Region;
use crate::problem::Problem;
use sensitol_numeric::correlation::{JointLaw, SolidShape, SolidZone};

/// Tolerance of the distance from the middle of a zone, for tests of inside and outside: some roundings.
pub(super) const EDGE: f64 = 1e-12;
/// Greatest number of rows that are used. Beyond it the box around the rows is used, because every box of a proof is
/// compared with every row.
const MOST_ROWS: usize = 10_000;

#[derive(Debug, Clone)]
pub(super) struct Zone {
    /// Coordinates of the zone, as positions among the dimensions of the characteristic.
    places: Vec<usize>,
    shape: ZoneShape,
    /// Ends of the band of every coordinate.
    bands: Vec<[f64; 2]>,
}

/// Region of a zone in units of half bands.
#[derive(Debug, Clone)]
enum ZoneShape {
    Disc,
    Rim,
    Diamond,
    /// Double cone, with the position of the coordinate along its axis.
    Bicone(usize),
    /// Values of all coordinates, row by row.
    Rows(Vec<Vec<f64>>),
}

/// Zone or block that some coordinates of a characteristic share.
#[derive(PartialEq)]
enum Shared<'p> {
    Block(usize),
    Circle(&'p str),
}

/// Zones of these dimensions of a problem. Zones of measured rows shrink the box to the rows.
pub(super) fn zones(problem: &Problem, dimensions: &[usize], region: &mut Region) -> Vec<Zone> {
    let mut groups: Vec<(Shared<'_>, Vec<usize>)> = Vec::new();
    for (place, &d) in dimensions.iter().enumerate() {
        let block = problem.correlation().and_then(|of| Some(of.block_of(d)?.0));
        let shared = match (block, problem.dimensions()[d].zone()) {
            (Some(block), _) => Shared::Block(block),
            (None, Some(zone)) => Shared::Circle(zone),
            (None, None) => continue,
        };
        match groups.iter_mut().find(|(known, _)| *known == shared) {
            Some((_, places)) => places.push(place),
            None => groups.push((shared, vec![place])),
        }
    }
    let mut zones = Vec::new();
    for (shared, places) in groups {
        // A single coordinate of a zone has its full band, so that the zone adds nothing.
        if places.len() < 2 {
            continue;
        }
        let shape = match shared {
            Shared::Circle(_) => ZoneShape::Disc,
            Shared::Block(block) => match &problem.correlation().expect("it has a block").blocks()[block].law {
                JointLaw::Disc => ZoneShape::Disc,
                JointLaw::Rim => ZoneShape::Rim,
                JointLaw::Diamond => ZoneShape::Diamond,
                JointLaw::Solid(solid) => {
                    let correlation = problem.correlation().expect("it has a block");
                    let coordinate = |&place: &usize| correlation.block_of(dimensions[place]).map_or(0, |of| of.1);
                    solid_shape(
                        solid,
                        &places.iter().map(|place| solid.coordinate(coordinate(place))).collect::<Vec<_>>(),
                    )
                }
                JointLaw::Rows(_) => {
                    let Some(rows) = rows_of(problem, dimensions, &places, block) else { continue };
                    for (coordinate, &place) in places.iter().enumerate() {
                        let column = || rows.iter().map(|row| row[coordinate]);
                        region.lower[place] = column().fold(f64::INFINITY, f64::min);
                        region.upper[place] = column().fold(f64::NEG_INFINITY, f64::max);
                    }
                    if rows.len() > MOST_ROWS {
                        continue;
                    }
                    ZoneShape::Rows(rows)
                }
            },
        };
        let bands = places.iter().map(|&place| [region.lower[place], region.upper[place]]).collect();
        zones.push(Zone { places, shape, bands });
    }
    zones
}

/// Shape of these coordinates of a solid. Two of three make the projection of the solid.
fn solid_shape(solid: &SolidZone, coordinates: &[usize]) -> ZoneShape {
    match solid.shape() {
        SolidShape::Octahedron => ZoneShape::Diamond,
        SolidShape::Ball => ZoneShape::Disc,
        SolidShape::Bicone => match coordinates.iter().position(|&coordinate| coordinate == 0) {
            None => ZoneShape::Disc,
            Some(axis) => ZoneShape::Bicone(axis),
        },
    }
}

/// Measured rows of some coordinates. Returns None if a drawing gives one of them a tolerance, because the tolerance
/// also holds for parts that were not measured.
fn rows_of(problem: &Problem, dimensions: &[usize], places: &[usize], block: usize) -> Option<Vec<Vec<f64>>> {
    let correlation = problem.correlation()?;
    let JointLaw::Rows(rows) = &correlation.blocks()[block].law else { return None };
    let columns: Vec<Vec<f64>> = places
        .iter()
        .map(|&place| {
            let d = dimensions[place];
            let dimension = &problem.dimensions()[d];
            let (_, coordinate) = correlation.block_of(d)?;
            let (mean, sigma) = (dimension.mean(), dimension.sigma());
            let values = rows.column(coordinate).iter().map(|u| mean + sigma * u).collect();
            dimension.tolerance().is_none().then_some(values)
        })
        .collect::<Option<_>>()?;
    Some((0..rows.len()).map(|row| columns.iter().map(|column| column[row]).collect()).collect())
}

impl Zone {
    fn middle(&self, coordinate: usize) -> f64 {
        let [lower, upper] = self.bands[coordinate];
        0.5 * lower + 0.5 * upper
    }

    fn half(&self, coordinate: usize) -> f64 {
        let [lower, upper] = self.bands[coordinate];
        0.5 * upper - 0.5 * lower
    }

    /// Euclidean norm, for a diamond the sum of absolute values, for a bicone that of the axis and the radius.
    fn norm(&self, parts: impl Iterator<Item = f64>) -> f64 {
        match self.shape {
            ZoneShape::Diamond => parts.map(f64::abs).sum(),
            ZoneShape::Bicone(axis) => {
                let [along, across] = along_and_across(axis, parts);
                along + across
            }
            _ => parts.fold(0.0, libm::hypot),
        }
    }

    /// Distance of a point from the middle, in half bands.
    fn radius(&self, x: &[f64]) -> f64 {
        self.norm((self.places.iter().enumerate()).map(|(c, &place)| (x[place] - self.middle(c)) / self.half(c)))
    }

    /// Least and greatest distance of a box from the middle, in half bands.
    fn reach(&self, region: &[[f64; 2]]) -> [f64; 2] {
        let ends = |coordinate: usize| {
            let (middle, half) = (self.middle(coordinate), self.half(coordinate));
            region[self.places[coordinate]].map(|x| (x - middle) / half)
        };
        let near = |coordinate: usize| {
            let [from, to] = ends(coordinate);
            if from <= 0.0 && to >= 0.0 { 0.0 } else { from.abs().min(to.abs()) }
        };
        let far = |coordinate: usize| ends(coordinate).map(f64::abs).into_iter().fold(0.0, f64::max);
        let all = || 0..self.places.len();
        [self.norm(all().map(near)), self.norm(all().map(far))]
    }

    fn rows_in<'z>(&'z self, rows: &'z [Vec<f64>], region: &'z [[f64; 2]]) -> impl Iterator<Item = &'z Vec<f64>> {
        rows.iter().filter(|row| {
            self.places.iter().zip(*row).all(|(&place, x)| (region[place][0]..=region[place][1]).contains(x))
        })
    }

    /// True if no place of a box lies within the zone.
    pub(super) fn leaves_out(&self, region: &[[f64; 2]]) -> bool {
        match &self.shape {
            ZoneShape::Rows(rows) => self.rows_in(rows, region).next().is_none(),
            ZoneShape::Rim => {
                let [near, far] = self.reach(region);
                near > 1.0 + EDGE || far < 1.0 - EDGE
            }
            ZoneShape::Disc | ZoneShape::Diamond | ZoneShape::Bicone(_) => self.reach(region)[0] > 1.0 + EDGE,
        }
    }

    /// Shrinks a box to the rows within it.
    pub(super) fn shrink(&self, region: &mut [[f64; 2]]) {
        let ZoneShape::Rows(rows) = &self.shape else { return };
        let mut ends = vec![[f64::INFINITY, f64::NEG_INFINITY]; self.places.len()];
        for row in self.rows_in(rows, region) {
            ends.iter_mut().zip(row).for_each(|(end, &x)| *end = [end[0].min(x), end[1].max(x)]);
        }
        self.places.iter().zip(ends).for_each(|(&place, end)| region[place] = end);
    }

    /// True if a dimension can take either end of a box for all values of the others. That is so outside a zone, and if
    /// the zone holds the whole box.
    pub(super) fn frees(&self, place: usize, region: &[[f64; 2]]) -> bool {
        !self.places.contains(&place)
            || match self.shape {
                ZoneShape::Disc | ZoneShape::Diamond | ZoneShape::Bicone(_) => self.reach(region)[1] <= 1.0,
                ZoneShape::Rim | ZoneShape::Rows(_) => false,
            }
    }

    /// True if the zone holds the point, within rounding.
    pub(super) fn contains(&self, x: &[f64]) -> bool {
        match &self.shape {
            ZoneShape::Rows(rows) => {
                rows.iter().any(|row| self.places.iter().zip(row).all(|(&place, value)| x[place] == *value))
            }
            ZoneShape::Rim => (self.radius(x) - 1.0).abs() <= EDGE,
            ZoneShape::Disc | ZoneShape::Diamond | ZoneShape::Bicone(_) => self.radius(x) <= 1.0 + EDGE,
        }
    }

    /// Moves an outside point to the edge in its direction, or to the nearest row. `margin` keeps it off the edge.
    pub(super) fn enter(&self, x: &mut [f64], margin: f64) {
        let radius = self.radius(x);
        match &self.shape {
            ZoneShape::Rows(rows) => {
                let distance = |row: &Vec<f64>| {
                    let apart = row.iter().enumerate().map(|(c, value)| (value - x[self.places[c]]) / self.half(c));
                    apart.fold(0.0, libm::hypot)
                };
                let nearest = rows.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
                let nearest = nearest.expect("a block has rows").clone();
                self.places.iter().zip(nearest).for_each(|(&place, value)| x[place] = value);
            }
            // At the middle every direction is equally near, so the first axis is taken.
            ZoneShape::Rim if radius == 0.0 => x[self.places[0]] = self.bands[0][1],
            ZoneShape::Rim => self.scale(x, radius),
            ZoneShape::Disc | ZoneShape::Diamond | ZoneShape::Bicone(_) if radius > 1.0 => {
                self.scale(x, radius * (1.0 + margin))
            }
            ZoneShape::Disc | ZoneShape::Diamond | ZoneShape::Bicone(_) => {}
        }
    }

    fn scale(&self, x: &mut [f64], radius: f64) {
        for (coordinate, &place) in self.places.iter().enumerate() {
            let middle = self.middle(coordinate);
            x[place] = middle + (x[place] - middle) / radius;
        }
    }

    /// Coordinates of the zone, as positions among the dimensions of the characteristic.
    pub(super) fn places(&self) -> &[usize] {
        &self.places
    }

    /// Certain lower bound over the zone of a plane with these slopes that is 0 at `about`, and the place of the least
    /// value. The bound uses only the part of the zone within a box, as far as that is cheap.
    pub(super) fn lowest(&self, slopes: &[f64], about: &[f64], region: &[[f64; 2]]) -> (f64, Vec<f64>) {
        let exactly = |x: f64| Interval::between(x, x);
        let place = |coordinate: usize| self.places[coordinate];
        let all = || 0..self.places.len();
        let term = |c: usize, x: Interval| x.subtract(&exactly(about[place(c)])).multiply(&exactly(slopes[c]));
        let sum = |terms: &mut dyn Iterator<Item = Interval>| terms.fold(exactly(0.0), |sum, term| sum.add(&term));
        if let ZoneShape::Rows(rows) = &self.shape {
            let value = |row: &Vec<f64>| sum(&mut all().map(|c| term(c, exactly(row[c])))).lower();
            let least = self.rows_in(rows, region).map(|row| (value(row), row));
            let least = least.min_by(|a, b| a.0.total_cmp(&b.0));
            return least.map_or((f64::INFINITY, Vec::new()), |(value, row)| (value, row.clone()));
        }
        let half = |c: usize| {
            let [lower, upper] = self.bands[c];
            exactly(upper).subtract(&exactly(lower)).multiply(&exactly(0.5))
        };
        let middle = |c: usize| {
            let [lower, upper] = self.bands[c];
            exactly(upper).add(&exactly(lower)).multiply(&exactly(0.5))
        };
        let rise = |c: usize| half(c).multiply(&exactly(slopes[c]));
        // Support function of the zone: the largest fall of the plane from the middle.
        let greatest = match self.shape {
            ZoneShape::Diamond => {
                let size = |c: usize| rise(c).upper().max(-rise(c).lower());
                exactly(all().map(size).fold(0.0, f64::max))
            }
            ZoneShape::Bicone(axis) => {
                let along = rise(axis).upper().max(-rise(axis).lower());
                let across = sum(&mut all().filter(|&c| c != axis).map(|c| rise(c).squared())).sqrt();
                exactly(along.max(across.upper()))
            }
            _ => sum(&mut all().map(|c| rise(c).squared())).sqrt(),
        };
        let bound = sum(&mut all().map(|c| term(c, middle(c)))).subtract(&greatest).lower();
        (bound.max(self.lowest_at_edge(slopes, about, region)), self.lowest_place(slopes))
    }

    /// Lower bound over the part of a box on this side of the edge's tangent, by weak duality:
    ///
    /// ```text
    /// g (x - m) = (g + l n/h) (x - m) - l n (u - u_m)     n: normal of the edge in half bands h, u = x/h
    /// n u <= 1                                            in the zone; on a rim n u >= 1 - |u - n|^2/2 too
    /// ```
    ///
    /// Its error grows with the square of the width of a box, so that it separates boxes along the edge.
    fn lowest_at_edge(&self, slopes: &[f64], about: &[f64], region: &[[f64; 2]]) -> f64 {
        let exactly = |x: f64| Interval::between(x, x);
        let offset =
            |x: f64, c: usize| exactly(x).subtract(&exactly(self.middle(c))).multiply(&exactly(1.0 / self.half(c)));
        let parts: Vec<f64> =
            self.places.iter().enumerate().map(|(c, &d)| (about[d] - self.middle(c)) / self.half(c)).collect();
        let radius = self.norm(parts.iter().copied());
        if radius == 0.0 {
            return f64::NEG_INFINITY;
        }
        // The normal at the point of the edge in the direction of `about`.
        let normal: Vec<f64> = match self.shape {
            ZoneShape::Diamond => parts.iter().map(|part| part.signum()).collect(),
            ZoneShape::Bicone(axis) => {
                let [_, across] = along_and_across(axis, parts.iter().copied());
                let part = |(c, part): (usize, &f64)| match across > 0.0 {
                    _ if c == axis => part.signum(),
                    true => part / across,
                    false => 0.0,
                };
                parts.iter().enumerate().map(part).collect()
            }
            _ => parts.iter().map(|part| part / radius).collect(),
        };
        let square: f64 = normal.iter().map(|n| n * n).sum();
        let along: f64 = slopes.iter().zip(&normal).enumerate().map(|(c, (slope, n))| slope * self.half(c) * n).sum();
        // The multiplier that removes the part of the slopes along the normal, so that only the tangential part is
        // left.
        let multiplier = -along / square;
        let is_rim = matches!(self.shape, ZoneShape::Rim);
        // Within a disc or diamond the constraint is an upper bound, so that a negative multiplier gives no bound.
        if multiplier < 0.0 && !is_rim {
            return f64::NEG_INFINITY;
        }
        let (mut tangential, mut reached, mut apart) = (exactly(0.0), exactly(0.0), exactly(0.0));
        for (c, &d) in self.places.iter().enumerate() {
            let per_half = exactly(multiplier).multiply(&exactly(normal[c])).multiply(&exactly(1.0 / self.half(c)));
            let slope = exactly(slopes[c]).add(&per_half);
            let [lower, upper] = region[d].map(|x| exactly(x).subtract(&exactly(about[d])));
            tangential = tangential.add(&slope.multiply(&Interval::between(lower.lower(), upper.upper())));
            reached = reached.add(&offset(about[d], c).multiply(&exactly(normal[c])));
            let [from, to] = region[d].map(|x| offset(x, c).subtract(&exactly(normal[c])));
            apart = apart.add(&Interval::between(from.lower(), to.upper()).squared());
        }
        // Normals are unit vectors within rounding, and the edge has a tolerance too.
        let edge = match multiplier < 0.0 {
            true => exactly(1.0 - EDGE).subtract(&apart.multiply(&exactly(0.5))),
            false => exactly(1.0 + EDGE),
        };
        tangential.subtract(&edge.subtract(&reached).multiply(&exactly(multiplier))).lower()
    }

    /// Place of the least value of a plane with these slopes in a round zone or a diamond.
    fn lowest_place(&self, slopes: &[f64]) -> Vec<f64> {
        let rises: Vec<f64> = slopes.iter().enumerate().map(|(c, slope)| slope * self.half(c)).collect();
        let steepest = (0..rises.len()).max_by(|&a, &b| rises[a].abs().total_cmp(&rises[b].abs())).unwrap_or(0);
        let length = rises.iter().fold(0.0, |length, &rise| libm::hypot(length, rise));
        let bicone = match self.shape {
            ZoneShape::Bicone(axis) => Some((axis, along_and_across(axis, rises.iter().copied()))),
            _ => None,
        };
        let part = |c: usize| match self.shape {
            _ if length == 0.0 => {
                if c == 0 {
                    1.0
                } else {
                    0.0
                }
            }
            ZoneShape::Diamond if c != steepest => 0.0,
            ZoneShape::Diamond => -rises[c].signum(),
            ZoneShape::Bicone(_) => bicone.map_or(0.0, |(axis, [along, across])| match along >= across {
                true if c == axis => -rises[c].signum(),
                false if c != axis => -rises[c] / across,
                _ => 0.0,
            }),
            _ => -rises[c] / length,
        };
        (0..rises.len()).map(|c| self.middle(c) + part(c) * self.half(c)).collect()
    }
}

/// Absolute value of the part along an axis, and Euclidean norm of the others.
fn along_and_across(axis: usize, parts: impl Iterator<Item = f64>) -> [f64; 2] {
    parts.enumerate().fold([0.0, 0.0], |[along, across], (place, part)| match place == axis {
        true => [part.abs(), across],
        false => [along, libm::hypot(across, part)],
    })
}
