//! Proposals for a tail. Every coordinate has its own distribution times `exp(theta h)`, with `h` the surface along it at a mean-field
//! centre.
//!
//! The centre is the mean under the proposal itself. `theta` is such that the surface's mean under the proposal equals the limit (Siegmund
//! 1976; Asmussen and Glynn 2007, VI). Tilting by `h` instead of shifting covers both ends of a parabola. The distributions are cells of
//! constant tilt between exact values of the distribution function, so that weights are exact.
//!
//! A mean field that starts from the middle misses a symmetric product, whose two signs are equally far out. Therefore it also starts from
//! both ends of the eigenvector of the products that leads farthest to this side. If several centres remain, the proposal is their mixture.

use std::sync::{Mutex, PoisonError};

use faer::{Mat, Side};

use crate::distribution::standard_normal;
use crate::elementary::{Elementary, Exp};
use crate::law::LawTail;
use crate::law::direction::{Direction, shifted};
use crate::law::input::Input;
use crate::law::polynomial::{Quartic, value};
use crate::law::surface::Surface;

/// Cells of a coordinate.
const CELLS: usize = 96;
/// Probability beyond the outermost inner edges.
const OUTER: f64 = 1e-16;
/// Share of the own distribution in every coordinate of a proposal.
const OWN: f64 = 0.02;
/// First tilt of the ladder, in units of one over sigma.
const FIRST: f64 = 0.4;
/// Ratio of neighbouring tilts of the ladder.
const STEP: f64 = 1.3;
/// Largest tilt, in units of one over sigma. Beyond it the mean cannot be moved to the limit.
const MOST: f64 = 3000.0;
/// Sweeps of a mean field over all coordinates.
const SWEEPS: usize = 8;
/// Difference of the logarithms of the mass to the best centre beyond which a centre is left out.
const NEGLIGIBLE: f64 = 7.0;

/// Distribution of a coordinate as cells.
#[derive(Debug, Clone)]
pub(super) struct Cells {
    /// Edges, one more than masses. Without a density they are the atoms.
    edges: Vec<f64>,
    masses: Vec<f64>,
    /// Logarithms of the masses.
    logs: Vec<f64>,
    /// Probability below each edge. `above` holds that above it.
    below: Vec<f64>,
    above: Vec<f64>,
    centres: Vec<f64>,
    /// Distribution of the coordinate; None for a normal variable behind an input.
    law: Option<std::sync::Arc<Input>>,
}

impl Cells {
    fn of(law: Option<std::sync::Arc<Input>>) -> Self {
        let quantile = |tail: f64| match &law {
            Some(law) => law.at_tail(tail),
            None if tail < 0.0 => standard_normal::upper_quantile(-tail),
            None => standard_normal::quantile(tail),
        };
        if let Some(input) = law.as_ref().filter(|law| law.is_discrete()) {
            let (edges, masses): (Vec<f64>, Vec<f64>) = input.atoms.iter().copied().unzip();
            let centres = edges.clone();
            let logs = masses.iter().map(|&mass| libm::log(mass)).collect();
            return Self { edges, masses, logs, below: Vec::new(), above: Vec::new(), centres, law };
        }
        let (low, high) = (quantile(OUTER), quantile(-OUTER));
        let mut edges: Vec<f64> = (0..=CELLS).map(|i| low + (high - low) * i as f64 / CELLS as f64).collect();
        let ends = law.as_ref().map_or([f64::NEG_INFINITY, f64::INFINITY], |law| law.ends);
        // Next to an end of the support, a tail occupies a small part of it and needs fine cells.
        for (end, sign) in [(ends[0], 1.0), (ends[1], -1.0)] {
            let support = law.as_ref().map_or(f64::INFINITY, |law| law.support[usize::from(sign < 0.0)]);
            if support.is_finite() {
                edges.extend((7..24).map(|k| end + sign * (high - low) * 0.5f64.powi(k)));
            }
        }
        edges.retain(|z| (ends[0]..=ends[1]).contains(z));
        edges.sort_unstable_by(f64::total_cmp);
        edges.insert(0, ends[0]);
        edges.push(ends[1]);
        edges.dedup();
        let cdf = |z: f64| law.as_ref().map_or_else(|| standard_normal::cdf(z), |law| law.cdf(z));
        let sf = |z: f64| law.as_ref().map_or_else(|| standard_normal::sf(z), |law| law.sf(z));
        let inner = |z: f64| z > ends[0] && z < ends[1];
        let below: Vec<f64> =
            edges.iter().map(|&z| if inner(z) { cdf(z) } else { f64::from(u8::from(z > 0.0)) }).collect();
        let above: Vec<f64> =
            edges.iter().map(|&z| if inner(z) { sf(z) } else { f64::from(u8::from(z < 0.0)) }).collect();
        let cells = edges.len() - 1;
        let mass = |c: usize| if edges[c] > 0.0 { above[c] - above[c + 1] } else { below[c + 1] - below[c] };
        let masses: Vec<f64> = (0..cells).map(mass).collect();
        let centre = |c: usize| 0.5 * (edges[c].max(low) + edges[c + 1].min(high));
        let logs = masses.iter().map(|&mass| libm::log(mass)).collect();
        Self { masses, logs, centres: (0..cells).map(centre).collect(), edges, below, above, law }
    }

    /// Value in a cell with this share of the cell's mass below it.
    pub(super) fn place(&self, cell: usize, share: f64) -> f64 {
        if self.below.is_empty() {
            return self.edges[cell];
        }
        let upper = self.edges[cell] > 0.0;
        let tail = match upper {
            true => -(self.above[cell] - share * self.masses[cell]).max(f64::MIN_POSITIVE),
            false => (self.below[cell] + share * self.masses[cell]).max(f64::MIN_POSITIVE),
        };
        match &self.law {
            Some(law) => law.at_tail(tail),
            None if upper => standard_normal::upper_quantile(-tail),
            None => standard_normal::quantile(tail),
        }
    }

    pub(super) fn masses(&self) -> &[f64] {
        &self.masses
    }
}

/// Proposal of one centre.
#[derive(Debug, Clone)]
pub(super) struct Mode {
    /// Masses of the cells of every sampled coordinate, which sum to 1 for each coordinate.
    pub(super) masses: Vec<Vec<f64>>,
    /// Share in the mixture.
    pub(super) share: f64,
    centre: Vec<f64>,
    log: f64,
}

/// Proposal of one tilt, with the mean of the surface under it.
#[derive(Debug, Clone)]
pub(super) struct Proposal {
    pub(super) modes: Vec<Mode>,
    mean: f64,
}

/// Proposals of one side, by growing tilts.
#[derive(Debug)]
struct Ladder {
    tail: LawTail,
    starts: Vec<Vec<f64>>,
    rungs: Mutex<Vec<std::sync::Arc<Proposal>>>,
}

/// Coordinates of a part of the surface, with everything needed to tilt them.
#[derive(Debug)]
pub(super) struct Tilts {
    /// Coordinates by their indices in the surface, the sampled ones first.
    coordinates: Vec<usize>,
    sampled: usize,
    pub(super) cells: Vec<Cells>,
    columns: Vec<Vec<(usize, f64)>>,
    /// `B d` of every column `d`. `squares` holds `d'B d/2`.
    images: Vec<Vec<(usize, f64)>>,
    squares: Vec<f64>,
    /// True for coordinates that do not enter linearly. They keep their own distribution.
    frozen: Vec<bool>,
    unit: f64,
    ladders: [Ladder; 2],
}

impl Tilts {
    pub(super) fn of(direction: &Direction, surface: &Surface, sigma: f64) -> Self {
        let mut coordinates = direction.rest();
        let sampled = coordinates.len();
        coordinates.extend(direction.coordinate());
        let cells = (coordinates.iter())
            .map(|&j| Cells::of((!direction.is_behind(j)).then(|| std::sync::Arc::clone(&surface.inputs[j]))))
            .collect();
        let columns: Vec<Vec<(usize, f64)>> = coordinates.iter().map(|&j| direction.column(j)).collect();
        let mut dense = vec![0.0; surface.len()];
        let (mut images, mut squares) = (Vec::new(), Vec::new());
        for column in &columns {
            dense.fill(0.0);
            for &(j, d) in column {
                surface.neighbours[j].iter().for_each(|&(k, b)| dense[k] += b * d);
            }
            squares.push(0.5 * column.iter().map(|&(j, d)| d * dense[j]).sum::<f64>());
            images.push(dense.iter().copied().enumerate().filter(|&(_, v)| v != 0.0).collect());
        }
        let frozen = coordinates.iter().map(|&j| direction.is_behind(j)).collect();
        let starts = starts(&columns, &images);
        let ladders = [LawTail::Lower, LawTail::Upper].map(|tail| {
            let [low, high] = &starts;
            let starts = if tail == LawTail::Lower { low } else { high };
            Ladder { tail, starts: starts.clone(), rungs: Mutex::default() }
        });
        Self { coordinates, sampled, cells, columns, images, squares, frozen, unit: 1.0 / sigma, ladders }
    }

    /// Coordinates that are sampled.
    pub(super) fn sampled(&self) -> &[usize] {
        &self.coordinates[..self.sampled]
    }

    /// First rung whose mean lies beyond a limit, or the last one if the mean cannot be moved there.
    ///
    /// `others` gives the tilted mean of the components that are not sampled.
    pub(super) fn proposal(
        &self,
        surface: &Surface,
        y: f64,
        tail: LawTail,
        others: impl Fn(f64) -> f64,
    ) -> Option<(usize, std::sync::Arc<Proposal>)> {
        let ladder = &self.ladders[usize::from(tail == LawTail::Upper)];
        let mut rungs = ladder.rungs.lock().unwrap_or_else(PoisonError::into_inner);
        for place in 0.. {
            let size = FIRST * STEP.powi(place as i32);
            if size > MOST {
                // The last rung moves the mean as far as possible.
                return rungs.last().map(|last| (rungs.len() - 1, std::sync::Arc::clone(last)));
            }
            if place == rungs.len() {
                let theta = ladder.tail.sign() * size * self.unit;
                let before = rungs.last().map(std::sync::Arc::clone);
                let before = before.as_ref().map(|before| before.modes.as_slice()).unwrap_or_default();
                let mut solved = self.solved(surface, theta, before, &ladder.starts);
                solved.mean += others(theta);
                rungs.push(std::sync::Arc::new(solved));
            }
            if tail.sign() * (rungs[place].mean - y) >= 0.0 {
                return Some((place, std::sync::Arc::clone(&rungs[place])));
            }
        }
        None
    }

    /// Centres of a tilt, from those of the previous tilt and from the starts.
    fn solved(&self, surface: &Surface, theta: f64, before: &[Mode], starts: &[Vec<f64>]) -> Proposal {
        let origin = vec![0.0; self.coordinates.len()];
        let from = match before.is_empty() {
            true => vec![origin],
            false => before.iter().map(|mode| mode.centre.clone()).collect(),
        };
        let mut found: Vec<(Mode, f64)> = Vec::new();
        for start in from.iter().chain(starts) {
            let (mode, mean) = self.field(surface, theta, start.clone());
            let near = |(other, _): &(Mode, f64)| {
                let both = other.centre.iter().zip(&mode.centre);
                both.map(|(a, b)| (a - b).abs()).fold(0.0, f64::max) < 0.5
            };
            if !found.iter().any(near) {
                found.push((mode, mean));
            }
        }
        let best = found.iter().map(|(mode, _)| mode.log).fold(f64::NEG_INFINITY, f64::max);
        found.retain(|(mode, _)| mode.log > best - NEGLIGIBLE);
        let total: f64 = found.iter().map(|(mode, _)| libm::exp(mode.log - best)).sum();
        let mean = found.iter().map(|(mode, mean)| mean * libm::exp(mode.log - best)).sum::<f64>() / total;
        // Every centre gets at least a tenth of an equal share.
        let floor = 0.1 / found.len() as f64;
        let share = |mode: &Mode| (libm::exp(mode.log - best) / total).max(floor);
        let sum: f64 = found.iter().map(|(mode, _)| share(mode)).sum();
        let modes = found.iter().map(|(mode, _)| Mode { share: share(mode) / sum, ..mode.clone() }).collect();
        Proposal { modes, mean }
    }

    /// Mean field from a start: its proposal, and the mean of the surface about its centre under it.
    fn field(&self, surface: &Surface, theta: f64, mut m: Vec<f64>) -> (Mode, f64) {
        let n = self.coordinates.len();
        let (mut z, mut image) = (vec![0.0; surface.len()], vec![0.0; surface.len()]);
        let add = |z: &mut [f64], image: &mut [f64], place: usize, by: f64| {
            self.columns[place].iter().for_each(|&(j, d)| z[j] += d * by);
            self.images[place].iter().for_each(|&(j, v)| image[j] += v * by);
        };
        (0..n).for_each(|place| add(&mut z, &mut image, place, m[place]));
        let mut masses: Vec<Vec<f64>> = self.cells.iter().map(|cells| cells.masses.clone()).collect();
        let (mut more, mut log) = (0.0, 0.0);
        for _ in 0..SWEEPS {
            (more, log) = (0.0, 0.0);
            for place in 0..n {
                if self.frozen[place] {
                    continue;
                }
                add(&mut z, &mut image, place, -m[place]);
                let h = self.along(surface, place, &z, &image);
                let cells = &self.cells[place];
                let values: Vec<f64> = cells.centres.iter().map(|&c| value(&h, c)).collect();
                let exponents: Vec<f64> = values.iter().zip(&cells.logs).map(|(h, log)| theta * h + log).collect();
                let most = exponents.iter().copied().fold(f64::NEG_INFINITY, f64::max);
                let own = &mut masses[place];
                own.iter_mut().zip(&exponents).for_each(|(own, e)| *own = Exp::of(e - most));
                let sum: f64 = own.iter().sum();
                own.iter_mut().for_each(|own| *own /= sum);
                let mean: f64 = own.iter().zip(&cells.centres).map(|(q, c)| q * c).sum();
                // Damped, because two coordinates that drive each other would oscillate.
                m[place] += 0.8 * (mean - m[place]);
                let at = value(&h, m[place]);
                more += own.iter().zip(&values).map(|(q, h)| q * h).sum::<f64>() - at;
                // Logarithm of the mass that the tilt gives to this coordinate, without the exponent at its centre.
                log += most + libm::log(sum) - theta * at;
                add(&mut z, &mut image, place, m[place]);
            }
        }
        let own: f64 = surface.parts.iter().zip(&z).map(|(part, &z)| value(part, z)).sum();
        let at = own + 0.5 * z.iter().zip(&image).map(|(z, v)| z * v).sum::<f64>();
        let mixed = |(tilted, cells): (&Vec<f64>, &Cells)| {
            tilted.iter().zip(&cells.masses).map(|(q, w)| (1.0 - OWN) * q + OWN * w).collect()
        };
        let masses = masses.iter().zip(&self.cells).take(self.sampled).map(mixed).collect();
        (Mode { masses, share: 1.0, centre: m, log: log + theta * at }, at + more)
    }

    /// Surface along a coordinate, up to a constant. `z` and `image` hold the other coordinates, with this one at 0.
    fn along(&self, surface: &Surface, place: usize, z: &[f64], image: &[f64]) -> Quartic {
        let mut c = [0.0; 5];
        for &(j, d) in &self.columns[place] {
            shifted(&surface.parts[j], z[j], d, &mut c);
            c[1] += d * image[j];
        }
        c[2] += self.squares[place];
        c
    }
}

/// Starts of mean fields to either side: both ends of the eigenvectors of the extreme eigenvalues that have the sign of the side.
fn starts(columns: &[Vec<(usize, f64)>], images: &[Vec<(usize, f64)>]) -> [Vec<Vec<f64>>; 2] {
    /// Greatest coordinate of a start, in sigmas.
    const REACH: f64 = 2.0;
    let n = columns.len();
    let size = images.iter().flatten().chain(columns.iter().flatten()).map(|&(j, _)| j + 1).max().unwrap_or(0);
    let mut dense = vec![0.0; size];
    let mut form = Mat::<f64>::zeros(n, n);
    for (b, image) in images.iter().enumerate() {
        dense.fill(0.0);
        image.iter().for_each(|&(j, v)| dense[j] = v);
        for (a, column) in columns.iter().enumerate().filter(|&(a, _)| a != b) {
            form[(a, b)] = column.iter().map(|&(j, d)| d * dense[j]).sum();
        }
    }
    let Ok(eigen) = form.self_adjoint_eigen(Side::Lower) else { return [Vec::new(), Vec::new()] };
    let both = |at: usize, sign: f64| -> Vec<Vec<f64>> {
        if n < 2 || sign * eigen.S()[at] <= 0.0 {
            return Vec::new();
        }
        let most = (0..n).map(|i| eigen.U()[(i, at)].abs()).fold(0.0, f64::max);
        [1.0, -1.0].map(|end| (0..n).map(|i| end * REACH * eigen.U()[(i, at)] / most).collect()).to_vec()
    };
    [both(0, -1.0), both(n.max(1) - 1, 1.0)]
}
