//! Points of the sampled branch: polynomials of the surface along the direction, at scrambled Sobol' points of the other coordinates.

use crate::law::direction::{Direction, Terms};
use crate::law::exponential_tilt::{Proposal, Tilts};
use crate::law::polynomial::{MonotonePieces, Quartic};
use crate::parallel::prelude::*;
use crate::sampling::{SOBOL_DIMENSIONS, Sobol};

/// Number of replicates, whose scatter gives the error.
pub(super) const REPLICATES: usize = 16;
/// Number of standard errors of the mean of 16 replicates that bound the error. Student's distribution with 15 degrees of freedom leaves
/// 1 % beyond.
pub const QUANTILE: f64 = 2.95;
/// Share of the own distribution in the mixture of a proposal. No weight exceeds its inverse.
const OWN: f64 = 0.25;

/// Sampled points, one replicate after the other.
#[derive(Debug)]
pub(super) struct Sample {
    /// Surface about its centre as polynomials along the direction.
    pub(super) full: Vec<Quartic>,
    /// Control variate as polynomials along the direction; empty if there is none.
    pub(super) control: Vec<Quartic>,
    /// Monotone pieces of both along the direction, which all limits share; empty if there is no direction.
    pub(super) pieces: [Vec<MonotonePieces>; 2],
    /// Ratio of the own probability to that of the proposal; empty if the points follow the own distribution.
    pub(super) weights: Vec<f64>,
}

/// Surfaces that are evaluated at the points.
pub(super) struct Along<'a> {
    pub(super) direction: &'a Direction,
    pub(super) full: &'a Terms,
    /// Control variate with the direction over its own parts.
    pub(super) control: Option<(&'a Direction, &'a Terms)>,
}

impl Sample {
    /// Sample with this number of points in every replicate, a power of two.
    pub(super) fn of(along: &Along<'_>, tilts: &Tilts, proposal: Option<&Proposal>, points: usize, seed: u64) -> Self {
        let ends = along.direction.input().map(|input| input.ends);
        let rows = visit(along.direction, tilts, proposal, points, seed, |z, weight| {
            let full = along.direction.along(z, along.full);
            let control = along.control.map(|(direction, terms)| direction.along(z, terms));
            let pieces = [Some(full), control].map(|polynomial| Some(MonotonePieces::of(&polynomial?, ends?)));
            (full, control, weight, pieces)
        });
        Self {
            full: rows.iter().map(|row| row.0).collect(),
            control: rows.iter().filter_map(|row| row.1).collect(),
            pieces: [0, 1].map(|of| rows.iter().filter_map(|row| row.3[of]).collect()),
            weights: if proposal.is_some() { rows.iter().map(|row| row.2).collect() } else { Vec::new() },
        }
    }
}

/// Evaluates `f` at the inputs and the weight of every point, replicate after replicate. The coordinate of the direction is 0.
#[expect(clippy::needless_range_loop, reason = "a point is a row over all columns")]
pub(super) fn visit<T: Send>(
    direction: &Direction,
    tilts: &Tilts,
    proposal: Option<&Proposal>,
    points: usize,
    seed: u64,
    f: impl Fn(&[f64], f64) -> T + Sync,
) -> Vec<T> {
    let sampled = tilts.sampled();
    let own: Vec<Vec<f64>> = tilts.cells[..sampled.len()].iter().map(|cells| cells.masses().to_vec()).collect();
    let modes = proposal.map_or(&[][..], |proposal| &proposal.modes);
    let tilted = modes.iter().map(|mode| (mode.masses.as_slice(), (1.0 - OWN) * mode.share));
    // A share of the own distribution bounds every weight, so that a mode without a tilt of its own is still sampled.
    let own = std::iter::once((own.as_slice(), if modes.is_empty() { 1.0 } else { OWN }));
    let masses: Vec<(&[Vec<f64>], f64)> = tilted.chain(own).collect();
    // Cumulative masses of the cells, by mode and coordinate.
    let sums: Vec<Vec<Vec<f64>>> =
        masses.iter().map(|(masses, _)| masses.iter().map(|m| running(m)).collect()).collect();
    let dimensions = sampled.len() + usize::from(masses.len() > 1);
    let sobol = Sobol::new(dimensions.min(SOBOL_DIMENSIONS));
    let replicate = |replicate: usize| {
        let key = |dimension: usize| mixed(mixed(mixed(seed) ^ replicate as u64).wrapping_add(dimension as u64));
        let columns: Vec<Vec<f64>> = (0..dimensions)
            .map(|dimension| {
                let mut column = vec![0.0; points];
                match &sobol {
                    Some(sobol) if dimension < SOBOL_DIMENSIONS => {
                        sobol.column(dimension, 0, Some(key(dimension)), &mut column);
                    }
                    // Beyond the direction numbers take random coordinates. The joint effect of many coordinates averages out.
                    _ => column.iter_mut().enumerate().for_each(|(i, u)| {
                        *u = (mixed(key(dimension) ^ i as u64) >> 12) as f64 / (1u64 << 52) as f64;
                    }),
                }
                column
            })
            .collect();
        let mut rows = Vec::with_capacity(points);
        let (mut z, mut scratch) = (vec![0.0; direction.surface().len()], Vec::new());
        for point in 0..points {
            // Draw the mode by the last coordinate, then a cell of every coordinate by the masses of that mode.
            let mode = match masses.len() {
                1 => 0,
                modes => {
                    let mut left = columns[dimensions - 1][point];
                    masses
                        .iter()
                        .position(|(_, share)| {
                            left -= share;
                            left < 0.0
                        })
                        .unwrap_or(modes - 1)
                }
            };
            z.fill(0.0);
            // Logarithms are not needed: a proposal gives every cell at least a fiftieth of its own mass.
            let mut by_mode = vec![1.0; masses.len()];
            for (place, &coordinate) in sampled.iter().enumerate() {
                let (u, sums) = (columns[place][point], &sums[mode][place]);
                let total = sums[sums.len() - 1];
                let target = (u + 0.5f64.powi(53)) * total;
                let cell = sums.partition_point(|&sum| sum <= target).clamp(1, sums.len() - 1) - 1;
                let share = ((target - sums[cell]) / (sums[cell + 1] - sums[cell])).clamp(0.0, 1.0);
                let cells = &tilts.cells[place];
                z[coordinate] = cells.place(cell, share);
                if proposal.is_some() {
                    let own = cells.masses()[cell];
                    for (ratio, (masses, _)) in by_mode.iter_mut().zip(&masses) {
                        *ratio *= masses[place][cell] / own;
                    }
                }
            }
            let weight = 1.0 / by_mode.iter().zip(&masses).map(|(ratio, (_, share))| ratio * share).sum::<f64>();
            direction.mix(&mut z, &mut scratch);
            rows.push(f(&z, weight));
        }
        rows
    };
    (0..REPLICATES).into_par_iter().flat_map_iter(replicate).collect()
}

fn running(masses: &[f64]) -> Vec<f64> {
    let mut sum = 0.0;
    let sums = masses.iter().map(|mass| {
        sum += mass;
        sum
    });
    std::iter::once(0.0).chain(sums).collect()
}

/// Finaliser of SplitMix64 (Steele, Lea and Flood 2014).
pub(super) fn mixed(word: u64) -> u64 {
    let word = word.wrapping_add(0x9e37_79b9_7f4a_7c15);
    let word = (word ^ word >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let word = (word ^ word >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    word ^ word >> 31
}
