//! Blocks: inputs with one joint distribution, of rows of measured parts or of a zone.
//!
//! A block is a copula beside the distributions of its members, which do not change. For points it is a map from independent normal
//! variables to those behind its members. Thus all code that handles correlated inputs by their normal variables handles blocks too. For
//! the moments of a surface it is a finite set of weighted places, which integrates every polynomial of the needed degree exactly.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::correlation::atom::Atom;
use crate::correlation::solid_zone::SolidZone;
use crate::distribution::{Distribution, Rule, Uniform, standard_normal};

/// Inputs with one joint distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Positions of the members, in the order of the law's coordinates.
    pub members: Vec<usize>,
    /// Joint distribution of the members.
    pub law: JointLaw,
}

/// Joint distribution of the members of a block.
#[derive(Debug, Clone, PartialEq)]
pub enum JointLaw {
    /// Rows of measured parts, each with the same probability.
    Rows(Arc<Rows>),
    /// Uniform distribution within a circle.
    Disc,
    /// Uniform distribution on a circle.
    Rim,
    /// Uniform distribution over `|x| + |y| <= 1`.
    Diamond,
    /// Uniform distribution over a zone of three coordinates.
    Solid(SolidZone),
}

/// Rows of measured parts, one column for each member.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// Values of each member, in sigmas off its mean.
    standardised: Vec<Vec<f64>>,
    /// Values of the normal variable behind each member.
    scores: Vec<Vec<f64>>,
}

/// Sigma of a coordinate that is uniform in the unit circle.
const SIGMA_OF_DISC: f64 = 0.5;
/// Sigma of a coordinate that is uniform on the unit circle: `sqrt(1/2)`.
const SIGMA_OF_RIM: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// Sigma of a coordinate that is uniform in the unit diamond: `sqrt(1/6)`.
const SIGMA_OF_DIAMOND: f64 = 0.408_248_290_463_863;

impl Rows {
    /// Rows from columns of measured values, which must have equal lengths and vary.
    pub fn of(columns: &[Vec<f64>]) -> Self {
        let standardised = |column: &Vec<f64>| {
            let n = column.len() as f64;
            // Sum about the first value, so that a mean far from 0 costs no digits.
            let mean = column[0] + column.iter().map(|x| x - column[0]).sum::<f64>() / n;
            let sigma = (column.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n).sqrt();
            column.iter().map(|x| (x - mean) / sigma).collect()
        };
        Self {
            standardised: columns.iter().map(standardised).collect(),
            scores: columns.iter().map(|column| scores(column)).collect(),
        }
    }

    /// Number of rows.
    #[allow(clippy::len_without_is_empty, reason = "a block has at least one row")]
    pub fn len(&self) -> usize {
        self.standardised.first().map_or(0, Vec::len)
    }

    /// Values of a member, in sigmas off its mean.
    pub fn column(&self, coordinate: usize) -> &[f64] {
        &self.standardised[coordinate]
    }

    /// Rank of each value among the distinct values of its member, ascending, for every member and row.
    pub fn ranks(&self) -> Vec<Vec<usize>> {
        let ranks = |scores: &Vec<f64>| {
            let mut distinct = scores.clone();
            distinct.sort_unstable_by(f64::total_cmp);
            distinct.dedup();
            scores.iter().map(|score| distinct.partition_point(|other| other < score)).collect()
        };
        self.scores.iter().map(ranks).collect()
    }

    /// Row selected by a normal variable, all with the same probability.
    fn row(&self, z: f64) -> usize {
        let n = self.len();
        ((standard_normal::cdf(z) * n as f64) as usize).min(n - 1)
    }
}

/// Normal scores of values: quantiles at the middle of each value's step of the empirical distribution function.
fn scores(column: &[f64]) -> Vec<f64> {
    let mut sorted = column.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    let n = column.len() as f64;
    let score = |&x: &f64| {
        let below = sorted.partition_point(|&other| other < x) as f64;
        let upto = sorted.partition_point(|&other| other <= x) as f64;
        standard_normal::quantile(0.5 * (below + upto) / n)
    };
    column.iter().map(score).collect()
}

impl JointLaw {
    /// Joint distribution of the members at these coordinates. Returns None if a single one is left, which is independent then.
    fn kept(&self, coordinates: &[usize]) -> Option<Self> {
        match self {
            _ if coordinates.len() < 2 => None,
            Self::Rows(rows) => {
                let of = |columns: &[Vec<f64>]| coordinates.iter().map(|&c| columns[c].clone()).collect();
                Some(Self::Rows(Arc::new(Rows { standardised: of(&rows.standardised), scores: of(&rows.scores) })))
            }
            Self::Solid(solid) => Some(Self::Solid(solid.kept(coordinates))),
            zone => Some(zone.clone()),
        }
    }

    /// Correlation of two members.
    pub(super) fn correlation(&self, a: usize, b: usize) -> f64 {
        match self {
            Self::Rows(rows) => {
                let products = rows.standardised[a].iter().zip(&rows.standardised[b]).map(|(u, v)| u * v);
                (products.sum::<f64>() / rows.len() as f64).clamp(-1.0, 1.0)
            }
            Self::Disc | Self::Rim | Self::Diamond | Self::Solid(_) => 0.0,
        }
    }

    /// Maps independent normal variables to those behind the members, in place.
    fn apply(&self, z: &mut [f64]) {
        match self {
            Self::Rows(rows) => {
                let row = rows.row(z[0]);
                z.iter_mut().zip(&rows.scores).for_each(|(z, scores)| *z = scores[row]);
            }
            Self::Solid(solid) => solid.apply(z),
            zone => {
                let at = zone.unit_place(z);
                let tails = zone.tails(at);
                for ((z, place), tail) in z.iter_mut().zip(at).zip(tails) {
                    *z = standard_normal::upper_quantile(tail.max(f64::MIN_POSITIVE)).copysign(place);
                }
            }
        }
    }

    /// Maps independent normal variables to the members in sigmas off their means, in place.
    fn apply_standardised(&self, z: &mut [f64]) {
        match self {
            Self::Rows(rows) => {
                let row = rows.row(z[0]);
                z.iter_mut().zip(&rows.standardised).for_each(|(z, column)| *z = column[row]);
            }
            Self::Solid(solid) => solid.apply_standardised(z),
            zone => {
                let at = zone.unit_place(z);
                z.iter_mut().zip(at).for_each(|(z, place)| *z = place / zone.sigma());
            }
        }
    }

    /// Sigma of a coordinate of a unit zone of two coordinates.
    fn sigma(&self) -> f64 {
        match self {
            // Rows are standardised, and solids have a sigma for every coordinate.
            Self::Rows(_) | Self::Solid(_) => 1.0,
            Self::Disc => SIGMA_OF_DISC,
            Self::Rim => SIGMA_OF_RIM,
            Self::Diamond => SIGMA_OF_DIAMOND,
        }
    }

    /// Point of a unit zone of two coordinates for two normal variables. The maps preserve measure and are continuous (except at 0 for the rim), so that
    /// evenly distributed points stay so.
    fn unit_place(&self, z: &[f64]) -> [f64; 2] {
        let [x, y] = [z[0], z[1]];
        let radius = libm::hypot(x, y);
        match self {
            Self::Diamond => {
                let [p, q] = [x, y].map(|z| standard_normal::cdf(z) - standard_normal::sf(z));
                [0.5 * (p + q), 0.5 * (p - q)]
            }
            _ if radius == 0.0 => [if matches!(self, Self::Rim) { 1.0 } else { 0.0 }, 0.0],
            Self::Rim => [x / radius, y / radius],
            // A share `1 - exp(-r^2/2)` of all points lies within r, and a share `rho^2` of the disc within rho.
            _ => {
                let within = (-libm::expm1(-0.5 * radius * radius)).sqrt();
                [within * x / radius, within * y / radius]
            }
        }
    }

    /// Probability that a coordinate lies farther from 0 on the same side.
    fn tails(&self, at: [f64; 2]) -> [f64; 2] {
        match self {
            // (theta - sin theta cos theta)/pi with cos theta = |x|.
            Self::Rows(_) | Self::Disc | Self::Solid(_) => at.map(|x| {
                let twice = 2.0 * libm::acos(x.abs().min(1.0));
                let segment = match twice < 0.1 {
                    true => twice.powi(3) / 6.0 * (1.0 - twice * twice / 20.0 * (1.0 - twice * twice / 42.0)),
                    false => twice - libm::sin(twice),
                };
                0.5 * segment / PI
            }),
            Self::Rim => {
                [libm::atan2(at[1].abs(), at[0].abs()), libm::atan2(at[0].abs(), at[1].abs())].map(|angle| angle / PI)
            }
            Self::Diamond => at.map(|x| 0.5 * (1.0 - x.abs()).max(0.0).powi(2)),
        }
    }

    /// Places that integrate polynomials up to this degree exactly. For rows these are all rows.
    pub(crate) fn atoms(&self, degree: usize) -> Vec<Atom> {
        let around = |radius: f64, weight: f64, sigma: f64| {
            // One direction more than the degree suffices to integrate it. A multiple of four keeps the zone's symmetries.
            let count = (degree + 2).next_multiple_of(4);
            (0..count).map(move |i| {
                let angle = 2.0 * PI * (i as f64 + 0.5) / count as f64;
                let u = vec![radius * libm::cos(angle) / sigma, radius * libm::sin(angle) / sigma];
                Atom { weight: weight / count as f64, u }
            })
        };
        match self {
            Self::Rows(rows) => {
                let weight = 1.0 / rows.len() as f64;
                let u = |row: usize| rows.standardised.iter().map(|column| column[row]).collect();
                (0..rows.len()).map(|row| Atom { weight, u: u(row) }).collect()
            }
            // In s = r^2, which is uniform from 0 to 1, a polynomial has half the degree.
            Self::Disc => (uniform_rule(degree / 4 + 1).into_iter())
                .flat_map(|(t, weight)| around((0.5 * (1.0 + t)).sqrt(), weight, SIGMA_OF_DISC))
                .collect(),
            Self::Rim => around(1.0, 1.0, SIGMA_OF_RIM).collect(),
            Self::Solid(solid) => solid.atoms(degree),
            Self::Diamond => {
                let rule = uniform_rule(degree / 2 + 1);
                let place = |(p, first): (f64, f64), (q, second): (f64, f64)| {
                    let u = [p + q, p - q].map(|sum| 0.5 * sum / SIGMA_OF_DIAMOND);
                    Atom { weight: first * second, u: u.to_vec() }
                };
                rule.iter().flat_map(|&p| rule.iter().map(move |&q| place(p, q))).collect()
            }
        }
    }
}

/// Gauss-Legendre rule for a uniform variable from -1 to 1: places, and weights that sum to 1.
fn uniform_rule(nodes: usize) -> Vec<(f64, f64)> {
    let uniform = Uniform::new(-1.0, 1.0).expect("an interval");
    let Rule { nodes, weights } = Rule::of(&uniform, nodes);
    nodes.iter().zip(&weights).map(|(&u, &weight)| (u * uniform.sigma(), weight)).collect()
}

impl Block {
    /// Block among a subset of the inputs, with `place` as their new positions. Returns None if a single member is left.
    pub(crate) fn among(&self, place: &dyn Fn(usize) -> Option<usize>) -> Option<Self> {
        let kept: Vec<(usize, usize)> = (self.members.iter().enumerate())
            .filter_map(|(coordinate, &member)| Some((coordinate, place(member)?)))
            .collect();
        let coordinates: Vec<usize> = kept.iter().map(|&(coordinate, _)| coordinate).collect();
        let law = self.law.kept(&coordinates)?;
        Some(Self { members: kept.into_iter().map(|(_, place)| place).collect(), law })
    }

    /// Maps the members' entries of a row from independent normal variables to those behind the members, in place.
    pub fn apply(&self, row: &mut [f64], scratch: &mut Vec<f64>) {
        self.with(row, scratch, JointLaw::apply);
    }

    /// Maps the members' entries of a row from independent normal variables to sigmas off their means, in place.
    pub(crate) fn apply_standardised(&self, row: &mut [f64], scratch: &mut Vec<f64>) {
        self.with(row, scratch, JointLaw::apply_standardised);
    }

    fn with(&self, row: &mut [f64], scratch: &mut Vec<f64>, f: impl Fn(&JointLaw, &mut [f64])) {
        scratch.clear();
        scratch.extend(self.members.iter().map(|&member| row[member]));
        f(&self.law, scratch);
        self.members.iter().zip(scratch.iter()).for_each(|(&member, value)| row[member] = *value);
    }
}
