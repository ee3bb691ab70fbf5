//! Blocks: inputs that vary together as a whole, by rows of measured parts or by a zone.
//!
//! A block is a copula beside the distributions of its members, which stay what they are. For points it is a map from independent normal
//! variables to those behind its members, so that everything that knows correlated inputs by their normal variables knows blocks too. For
//! the moments of a surface it is a finite set of weighted places, which integrates every polynomial that is asked of it exactly.

use std::f64::consts::PI;
use std::sync::Arc;

use crate::distribution::{Distribution, Rule, Uniform, standard_normal};

/// Inputs that vary together as a whole.
#[derive(Debug, Clone, PartialEq)]
pub struct Block {
    /// Their positions, in the order of the law's coordinates.
    pub members: Vec<usize>,
    pub law: JointLaw,
}

/// How the members of a block vary together.
#[derive(Debug, Clone, PartialEq)]
pub enum JointLaw {
    /// Rows of measured parts, each with the same probability.
    Rows(Arc<Rows>),
    /// Uniform within a circle.
    Disc,
    /// Uniform on a circle.
    Rim,
    /// Uniform over `|x| + |y| <= 1`.
    Diamond,
}

/// Rows of measured parts: a column for every member.
#[derive(Debug, Clone, PartialEq)]
pub struct Rows {
    /// In sigmas off the mean.
    standardised: Vec<Vec<f64>>,
    /// Of the normal variable behind the member.
    scores: Vec<Vec<f64>>,
}

/// A place of a block and its probability.
pub struct Atom {
    pub(crate) weight: f64,
    /// Of every member in sigmas off its mean.
    pub(crate) u: Vec<f64>,
}

/// Sigmas of the unit zones, as parts of their half width.
const SIGMA_OF_DISC: f64 = 0.5;
const SIGMA_OF_RIM: f64 = std::f64::consts::FRAC_1_SQRT_2;
/// `sqrt(1/6)`.
const SIGMA_OF_DIAMOND: f64 = 0.408_248_290_463_863;

impl Rows {
    /// Of columns of measured values, which are as long as each other and vary.
    pub fn of(columns: &[Vec<f64>]) -> Self {
        let standardised = |column: &Vec<f64>| {
            let n = column.len() as f64;
            // About the first value, so that a mean far from 0 costs no digits.
            let mean = column[0] + column.iter().map(|x| x - column[0]).sum::<f64>() / n;
            let sigma = (column.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / n).sqrt();
            column.iter().map(|x| (x - mean) / sigma).collect()
        };
        Self {
            standardised: columns.iter().map(standardised).collect(),
            scores: columns.iter().map(|column| scores(column)).collect(),
        }
    }

    /// How many rows there are.
    pub fn len(&self) -> usize {
        self.standardised.first().map_or(0, Vec::len)
    }

    /// The values of a member, in sigmas off its mean.
    pub fn column(&self, coordinate: usize) -> &[f64] {
        &self.standardised[coordinate]
    }

    /// For every member and row, the place of its value among the distinct values of the member, ascending.
    pub fn ranks(&self) -> Vec<Vec<usize>> {
        let ranks = |scores: &Vec<f64>| {
            let mut distinct = scores.clone();
            distinct.sort_unstable_by(f64::total_cmp);
            distinct.dedup();
            scores.iter().map(|score| distinct.partition_point(|other| other < score)).collect()
        };
        self.scores.iter().map(ranks).collect()
    }

    /// The row of a normal variable, which picks it by its probability.
    fn row(&self, z: f64) -> usize {
        let n = self.len();
        ((standard_normal::cdf(z) * n as f64) as usize).min(n - 1)
    }
}

/// The normal scores of values: those of the middle of each value's step in the staircase that the values are.
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
    /// The law of some of the members only, by their coordinates; None where a single one is left, which is independent then.
    fn kept(&self, coordinates: &[usize]) -> Option<Self> {
        match self {
            _ if coordinates.len() < 2 => None,
            Self::Rows(rows) => {
                let of = |columns: &[Vec<f64>]| coordinates.iter().map(|&c| columns[c].clone()).collect();
                Some(Self::Rows(Arc::new(Rows { standardised: of(&rows.standardised), scores: of(&rows.scores) })))
            }
            zone => Some(zone.clone()),
        }
    }

    /// The correlation of two members.
    pub(super) fn correlation(&self, a: usize, b: usize) -> f64 {
        match self {
            Self::Rows(rows) => {
                let products = rows.standardised[a].iter().zip(&rows.standardised[b]).map(|(u, v)| u * v);
                (products.sum::<f64>() / rows.len() as f64).clamp(-1.0, 1.0)
            }
            Self::Disc | Self::Rim | Self::Diamond => 0.0,
        }
    }

    /// From independent normal variables to those behind the members, in place.
    fn apply(&self, z: &mut [f64]) {
        match self {
            Self::Rows(rows) => {
                let row = rows.row(z[0]);
                z.iter_mut().zip(&rows.scores).for_each(|(z, scores)| *z = scores[row]);
            }
            zone => {
                let at = zone.unit_place(z);
                let tails = zone.tails(at);
                for ((z, place), tail) in z.iter_mut().zip(at).zip(tails) {
                    *z = standard_normal::upper_quantile(tail.max(f64::MIN_POSITIVE)).copysign(place);
                }
            }
        }
    }

    /// From independent normal variables to the members in sigmas off their means, in place.
    fn apply_standardised(&self, z: &mut [f64]) {
        match self {
            Self::Rows(rows) => {
                let row = rows.row(z[0]);
                z.iter_mut().zip(&rows.standardised).for_each(|(z, column)| *z = column[row]);
            }
            zone => {
                let at = zone.unit_place(z);
                z.iter_mut().zip(at).for_each(|(z, place)| *z = place / zone.sigma());
            }
        }
    }

    /// Sigma of a coordinate of the unit zone.
    fn sigma(&self) -> f64 {
        match self {
            Self::Rows(_) => 1.0,
            Self::Disc => SIGMA_OF_DISC,
            Self::Rim => SIGMA_OF_RIM,
            Self::Diamond => SIGMA_OF_DIAMOND,
        }
    }

    /// The point of the unit zone for two normal variables. The maps keep measure and are continuous (but for the rim's at 0), so that even
    /// points stay even.
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

    /// The probability that a coordinate lies farther from 0 on the same side.
    fn tails(&self, at: [f64; 2]) -> [f64; 2] {
        match self {
            // (theta - sin theta cos theta)/pi with cos theta = |x|.
            Self::Rows(_) | Self::Disc => at.map(|x| {
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

    /// Places that integrate polynomials up to this degree exactly; of rows all of them.
    pub(crate) fn atoms(&self, degree: usize) -> Vec<Atom> {
        let around = |radius: f64, weight: f64, sigma: f64| {
            // As many directions as one more than the degree integrate it; an even number keeps the zone's symmetries.
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

/// Gauss and Legendre's rule of a uniform variable from -1 to 1: places, and weights that sum to 1.
fn uniform_rule(nodes: usize) -> Vec<(f64, f64)> {
    let uniform = Uniform::new(-1.0, 1.0).expect("an interval");
    let Rule { nodes, weights } = Rule::of(&uniform, nodes);
    nodes.iter().zip(&weights).map(|(&u, &weight)| (u * uniform.sigma(), weight)).collect()
}

impl Block {
    /// The same among these inputs, whose places are those in the list; None where a single one is left.
    pub(crate) fn among(&self, place: &dyn Fn(usize) -> Option<usize>) -> Option<Self> {
        let kept: Vec<(usize, usize)> = (self.members.iter().enumerate())
            .filter_map(|(coordinate, &member)| Some((coordinate, place(member)?)))
            .collect();
        let coordinates: Vec<usize> = kept.iter().map(|&(coordinate, _)| coordinate).collect();
        let law = self.law.kept(&coordinates)?;
        Some(Self { members: kept.into_iter().map(|(_, place)| place).collect(), law })
    }

    /// From independent normal variables to those behind the members: the members' places of a row, in place.
    pub fn apply(&self, row: &mut [f64], scratch: &mut Vec<f64>) {
        self.with(row, scratch, JointLaw::apply);
    }

    /// The same to the members in sigmas off their means.
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
