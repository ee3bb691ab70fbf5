//! Zones of three coordinates with evenly spread points: octahedron, double cone and ball.
//!
//! ```text
//! octahedron   |x| + |y| + |z| <= 1          offset and tilts of a rectangular face
//! bicone       |z| + hypot(x, y) <= 1        offset and tilts of a round face
//! ball         x^2 + y^2 + z^2 <= 1          a point in a spherical zone
//! ```
//!
//! The maps from normal variables are those of Rosenblatt (1952): each coordinate follows from the ones before by its conditional
//! distribution. So two of the three coordinates keep their joint distribution without the third one.

use std::f64::consts::PI;

use crate::correlation::atom::Atom;
use crate::distribution::{Beta, Distribution, Rule, SolidAxis, standard_normal};

/// Shape of a zone of three coordinates.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum SolidShape {
    /// `|x| + |y| + |z| <= 1`.
    Octahedron,
    /// `|z| + hypot(x, y) <= 1`. The first coordinate is the one along the axis.
    Bicone,
    /// `x^2 + y^2 + z^2 <= 1`.
    Ball,
}

/// Uniform distribution over a zone of three coordinates, or the joint distribution of two of them.
#[derive(Debug, Clone, PartialEq)]
pub struct SolidZone {
    shape: SolidShape,
    /// Coordinates that are kept, ascending: all three or two of them.
    coordinates: Vec<usize>,
}

/// Sigma of a coordinate that is uniform in the unit ball: `sqrt(1/5)`.
const SIGMA_OF_BALL: f64 = 0.447_213_595_499_957_9;

impl SolidZone {
    /// All coordinates of a zone.
    pub fn new(shape: SolidShape) -> Self {
        Self { shape, coordinates: vec![0, 1, 2] }
    }

    /// Shape of the zone.
    pub fn shape(&self) -> SolidShape {
        self.shape
    }

    /// Coordinate of the zone that a member stands for.
    pub fn coordinate(&self, member: usize) -> usize {
        self.coordinates[member]
    }

    /// Joint distribution of some of its members.
    pub(super) fn kept(&self, members: &[usize]) -> Self {
        Self { shape: self.shape, coordinates: members.iter().map(|&member| self.coordinates[member]).collect() }
    }

    /// Sigma of a member in the unit zone.
    fn sigma(&self, member: usize) -> f64 {
        match (self.shape, self.coordinates[member]) {
            (SolidShape::Ball, _) => SIGMA_OF_BALL,
            (SolidShape::Bicone, 1 | 2) => SolidAxis::Bicone.variance().sqrt(),
            (SolidShape::Octahedron | SolidShape::Bicone, _) => SolidAxis::Octahedron.variance().sqrt(),
        }
    }

    /// Probability that a member lies farther from 0 on the same side.
    fn tail(&self, member: usize, place: f64) -> f64 {
        let place = place.abs().min(1.0);
        let end = 1.0 - place;
        match (self.shape, self.coordinates[member]) {
            (SolidShape::Ball, _) => 0.25 * end * end * (2.0 + place),
            (SolidShape::Bicone, 1 | 2) => SolidAxis::Bicone.tail(place, end),
            (SolidShape::Octahedron | SolidShape::Bicone, _) => SolidAxis::Octahedron.tail(place, end),
        }
    }

    /// Maps independent normal variables to those behind the members, in place.
    pub(super) fn apply(&self, z: &mut [f64]) {
        self.place(z);
        for (member, z) in z.iter_mut().enumerate() {
            let tail = self.tail(member, *z).max(f64::MIN_POSITIVE);
            *z = standard_normal::upper_quantile(tail).copysign(*z);
        }
    }

    /// Maps independent normal variables to the members in sigmas off their means, in place.
    pub(super) fn apply_standardised(&self, z: &mut [f64]) {
        self.place(z);
        z.iter_mut().enumerate().for_each(|(member, z)| *z /= self.sigma(member));
    }

    /// Maps normal variables to a point of the unit zone, in place. The maps preserve measure and are continuous.
    fn place(&self, z: &mut [f64]) {
        match (self.shape, &self.coordinates[..]) {
            (SolidShape::Octahedron, _) => {
                // What the coordinates before leave of the sum, with the powers of the tails of the conditional distributions.
                let mut left = 1.0;
                for (before, z) in z.iter_mut().enumerate() {
                    let outside = 2.0 * standard_normal::sf(z.abs());
                    let share = match before {
                        0 => libm::cbrt(outside),
                        1 => outside.sqrt(),
                        _ => outside,
                    };
                    *z = (left * (1.0 - share)).copysign(*z);
                    left *= share;
                }
            }
            (SolidShape::Ball, _) => {
                // A share `exp(-r^2/2)` lies outside of r, and a share `(1 - rho^2)^(3/2)` of the ball outside of a cylinder of rho.
                let square = z[0] * z[0] + z[1] * z[1];
                let radius = (-libm::expm1(-square / 3.0)).sqrt();
                if let Some(third) = z.get_mut(2) {
                    *third = libm::exp(-square / 6.0) * spread(*third);
                }
                turned(&mut z[..2], square, radius);
            }
            (SolidShape::Bicone, [0, 1, 2]) => {
                let square = z[1] * z[1] + z[2] * z[2];
                let end = end_of_cone(square);
                z[0] = end * spread(z[0]);
                turned(&mut z[1..], square, 1.0 - end);
            }
            (SolidShape::Bicone, [1, 2]) => {
                let square = z[0] * z[0] + z[1] * z[1];
                turned(z, square, 1.0 - end_of_cone(square));
            }
            (SolidShape::Bicone, _) => {
                let share = libm::cbrt(2.0 * standard_normal::sf(z[0].abs()));
                z[0] = (1.0 - share).copysign(z[0]);
                z[1] = share * across_disc(z[1]);
            }
        }
    }

    /// Places that integrate polynomials up to this degree exactly: products of Gauss rules of Jacobi for the parts of the zone.
    pub(super) fn atoms(&self, degree: usize) -> Vec<Atom> {
        let nodes = degree / 2 + 1;
        let mut atoms = Vec::new();
        let mut push = |weight: f64, place: [f64; 3]| {
            let u = self.coordinates.iter().enumerate();
            let u = u.map(|(member, &coordinate)| place[coordinate] / self.sigma(member)).collect();
            atoms.push(Atom { weight, u });
        };
        match self.shape {
            SolidShape::Octahedron => {
                for (x, first) in shares(1.0, 3.0, nodes) {
                    for (y, second) in shares(1.0, 2.0, nodes) {
                        for (z, third) in shares(1.0, 1.0, nodes) {
                            let place = [x, (1.0 - x) * y, (1.0 - x) * (1.0 - y) * z];
                            for side in 0..8usize {
                                let sign = |bit: usize| if side >> bit & 1 == 1 { -1.0 } else { 1.0 };
                                let place = [0, 1, 2].map(|bit| sign(bit) * place[bit]);
                                push(first * second * third / 8.0, place);
                            }
                        }
                    }
                }
            }
            SolidShape::Bicone => {
                for (height, first) in shares(1.0, 3.0, nodes) {
                    for (radius, second) in shares(2.0, 1.0, nodes) {
                        for ([x, y], third) in directions(degree) {
                            let radius = (1.0 - height) * radius;
                            for side in [1.0, -1.0] {
                                push(0.5 * first * second * third, [side * height, radius * x, radius * y]);
                            }
                        }
                    }
                }
            }
            SolidShape::Ball => {
                for (radius, first) in shares(3.0, 1.0, nodes) {
                    // By Archimedes, the height on a sphere is uniform.
                    for (height, second) in shares(1.0, 1.0, nodes) {
                        let height = 2.0 * height - 1.0;
                        let across = ((1.0 - height) * (1.0 + height)).sqrt();
                        for ([x, y], third) in directions(degree) {
                            let place = [across * x, across * y, height].map(|part| radius * part);
                            push(first * second * third, place);
                        }
                    }
                }
            }
        }
        atoms
    }
}

/// Uniform variable from -1 to 1 for a normal variable.
fn spread(z: f64) -> f64 {
    standard_normal::cdf(z) - standard_normal::sf(z)
}

/// Replaces two normal variables by the point of this radius in their direction. `square` is the sum of their squares.
fn turned(z: &mut [f64], square: f64, radius: f64) {
    let by = if square > 0.0 { radius / square.sqrt() } else { 0.0 };
    z.iter_mut().for_each(|z| *z *= by);
}

/// Distance from the rim of a point of the double cone, from two normal variables whose squares have this sum. A share `s^2 (3 - 2 s)` of
/// the double cone lies within a distance `s` of the rim.
fn end_of_cone(square: f64) -> f64 {
    let outside = libm::exp(-0.5 * square);
    // The root of a cubic by the sine of a third of an angle.
    (0.5 - libm::sin(libm::asin((1.0 - 2.0 * outside).clamp(-1.0, 1.0)) / 3.0)).max(0.0)
}

/// Coordinate of a point of the unit disc, from a normal variable.
fn across_disc(z: f64) -> f64 {
    /// Most Newton steps: convergence is cubic from the start, and at worst halves.
    const STEPS: usize = 60;
    // With the angle t from the end, a share (t - sin t cos t)/pi lies beyond.
    let tail = PI * standard_normal::sf(z.abs());
    let mut angle = libm::cbrt(1.5 * tail);
    for _ in 0..STEPS {
        let sine = libm::sin(angle);
        let segment = match angle < 0.05 {
            true => angle.powi(3) * (2.0 / 3.0) * (1.0 - angle * angle / 5.0 * (1.0 - 2.0 * angle * angle / 21.0)),
            false => angle - sine * libm::cos(angle),
        };
        let step = (segment - tail) / (2.0 * sine * sine).max(f64::MIN_POSITIVE);
        angle -= step;
        if step.abs() <= 4.0 * f64::EPSILON * angle {
            break;
        }
    }
    libm::cos(angle).copysign(z)
}

/// Gauss rule of a beta variable from 0 to 1: places, and weights that sum to 1.
fn shares(alpha: f64, beta: f64, nodes: usize) -> Vec<(f64, f64)> {
    let law = Beta::new(0.0, 1.0, alpha, beta).expect("exponents within their range");
    let Rule { nodes, weights } = Rule::of(&law, nodes);
    nodes.iter().zip(&weights).map(|(u, &weight)| (law.mean() + law.sigma() * u, weight)).collect()
}

/// Directions that integrate polynomials of a direction up to this degree exactly, with their weights.
fn directions(degree: usize) -> Vec<([f64; 2], f64)> {
    // One direction more than the degree suffices. A multiple of four keeps the zone's symmetries.
    let count = (degree + 2).next_multiple_of(4);
    let direction = |i: usize| {
        let angle = 2.0 * PI * (i as f64 + 0.5) / count as f64;
        ([libm::cos(angle), libm::sin(angle)], 1.0 / count as f64)
    };
    (0..count).map(direction).collect()
}
