//! Points that several surface distributions over the same inputs share, dense where a limit is exceeded.
//!
//! Inputs are functions of independent normal scores. A quarter of the points are drawn from the inputs' own distribution. The other points
//! are divided among the limits in proportion to their reject rates, and each of them lies beyond a cut near its limit:
//!
//! ```text
//! t = a'z beyond c          a: unit vector of covariances of the characteristic with the scores
//! c = R b - 3 sqrt(1 - R^2) b: normal score of the limit, R^2: the share of the variance that t explains
//! w(z) = 1 / (share of own points + sum over limits of share 1{t > c} / P(t > c))
//! ```
//!
//! A point beyond no cut has a weight of at most 4. A surface that no direction explains therefore loses at most a factor of 2 in its
//! error.
//!
//! Sources: a sample for each rare event in proportion to its probability, A. B. Owen, Y. Maximov and M. Chertkov, "Importance sampling the
//! union of rare events", Electronic Journal of Statistics 13 (2019); weights by the mixture, E. Veach and L. Guibas, "Optimally combining
//! sampling techniques", SIGGRAPH 1995, and A. Owen and Y. Zhou, Journal of the American Statistical Association 95 (2000). There the
//! events are half-spaces. Here each event is enclosed by a half-space.

use std::collections::BTreeMap;
use std::sync::Arc;

use faer::{Mat, Side};

use crate::characteristic::SpecLimits;
use crate::correlation::Block;
use crate::distribution::standard_normal;
use crate::law::discrete_law::Groups;
use crate::law::input::Input;
use crate::law::polynomial::value;
use crate::law::sampled_points::mixed;
use crate::law::{LawFigure, LawTail, SurfaceLaw};
use crate::sampling::{SOBOL_DIMENSIONS, Sobol, tails};

/// Points of each replicate.
pub(super) const POINTS: usize = 1 << 11;
/// Points of each replicate that are drawn from the inputs' own distribution.
const OWN: usize = POINTS / 4;
/// Seed of the points: any fixed number.
const SEED: u64 = 1;
/// Distance of a cut inside its limit, in standard deviations of the part that the direction does not explain. At three of them a
/// thousandth of the rejects lies before the cut and is left to the points of the own distribution.
const NEARER: f64 = 3.0;
/// Greatest number of surface values that are listed: for a hundred inputs and ten characteristics 2^14 combinations.
const LISTED: usize = 1 << 24;
/// Combinations that are evaluated together.
const ROWS: usize = 1 << 10;
/// Least share of the variance that a direction must explain for its cut to be used.
const LEAST_EXPLAINED: f64 = 0.25;

/// One side of the limits of a law.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limit {
    /// Index of the law among all characteristics.
    pub(super) of: usize,
    pub(super) side: LawTail,
}

/// Counts of exceeded limits in one replicate.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Counts {
    /// Mean number of exceeded limits.
    pub(super) broken: f64,
    /// Mean number of exceeded limits beyond the first.
    pub(super) beyond: f64,
    /// Sum over the points of the squared weight times the number of exceeded limits.
    pub(super) squares: f64,
}

/// All inputs that any of the laws depends on, ordered by their positions.
pub(super) struct CommonPoints<'a> {
    characteristics: &'a [(&'a SurfaceLaw, SpecLimits)],
    laws: Vec<(usize, Arc<Input>)>,
    /// Indices in `laws` of the correlated inputs. `factor` maps independent normal scores to their correlated normal variables.
    members: Vec<usize>,
    factor: Mat<f64>,
    /// Blocks of correlated inputs that have one joint distribution.
    blocks: Vec<Block>,
    sobol: Option<Sobol>,
    cuts: Vec<Cut>,
}

/// Half-space of the scores that holds nearly all points beyond a limit.
struct Cut {
    /// Unit vector by indices of `laws`, pointing beyond the limit.
    direction: Vec<f64>,
    score: f64,
    /// Probability of the half-space in the inputs' own distribution.
    probability: f64,
    /// Points of a replicate that are drawn beyond the cut.
    rows: std::ops::Range<usize>,
}

impl<'a> CommonPoints<'a> {
    pub(super) fn of(characteristics: &'a [(&'a SurfaceLaw, SpecLimits)], tails: &[(Limit, LawFigure)]) -> Self {
        let mut by_position: BTreeMap<usize, Arc<Input>> = BTreeMap::new();
        for (law, _) in characteristics {
            for (position, place) in law.given.places.iter().enumerate() {
                if let Some(place) = *place {
                    by_position.entry(position).or_insert_with(|| Arc::clone(&law.given.inputs[place]));
                }
            }
        }
        let laws: Vec<(usize, Arc<Input>)> = by_position.into_iter().collect();
        let (mut members, mut factor, mut blocks) = (Vec::new(), Mat::zeros(0, 0), Vec::new());
        if let Some(correlation) = characteristics.iter().find_map(|(law, _)| law.correlation.as_ref()) {
            let place = |position: usize| laws.binary_search_by_key(&position, |&(position, _)| position).ok();
            let known: Vec<(usize, usize)> = (correlation.members().iter().enumerate())
                .filter_map(|(member, &position)| Some((place(position)?, member)))
                .collect();
            let m = known.len();
            let matrix = Mat::from_fn(m, m, |a, b| correlation.normal()[(known[a].1, known[b].1)]);
            if let Ok(eigen) = matrix.self_adjoint_eigen(Side::Lower) {
                factor = Mat::from_fn(m, m, |a, b| eigen.U()[(a, b)] * eigen.S()[b].max(0.0).sqrt());
                members = known.into_iter().map(|(place, _)| place).collect();
            }
            blocks = correlation.blocks().iter().filter_map(|block| block.among(&place)).collect();
        }
        let sobol = Sobol::new(laws.len().min(SOBOL_DIMENSIONS));
        let mut points = Self { characteristics, laws, members, factor, blocks, sobol, cuts: Vec::new() };
        points.cuts = points.cuts(tails);
        points
    }

    /// Half-spaces about the limits. The points outside the own distribution are divided among them.
    fn cuts(&self, tails: &[(Limit, LawFigure)]) -> Vec<Cut> {
        let scores = self.scores(0);
        let directions: Vec<Option<(Vec<f64>, f64)>> =
            self.characteristics.iter().map(|(law, _)| self.direction(law, &scores)).collect();
        let mut cuts: Vec<(Cut, f64)> = Vec::new();
        for (limit, tail) in tails {
            let Some((direction, explained)) = &directions[limit.of] else { continue };
            let apart = NEARER * (1.0 - explained * explained).max(0.0).sqrt();
            let score = explained * standard_normal::upper_quantile(tail.value) - apart;
            // At a limit that half of all points or more exceed, the points of the own distribution suffice.
            if tail.value > 0.0 && score > 0.0 {
                let out = if limit.side == LawTail::Upper { 1.0 } else { -1.0 };
                let direction = direction.iter().map(|a| out * a).collect();
                let cut = Cut { direction, score, probability: standard_normal::sf(score), rows: 0..0 };
                cuts.push((cut, tail.value));
            }
        }
        let total: f64 = cuts.iter().map(|(_, probability)| probability).sum();
        let (mut first, mut sum) = (OWN, 0.0);
        for (cut, probability) in &mut cuts {
            sum += *probability;
            let end = OWN + ((POINTS - OWN) as f64 * (sum / total).min(1.0)).round() as usize;
            cut.rows = first..end;
            first = end;
        }
        cuts.into_iter().map(|(cut, _)| cut).collect()
    }

    /// Unit vector of the covariances of a law with the scores, and the correlation of the law with the score along it. Returns None if the
    /// direction explains too little variance. Products of independent inputs do not contribute.
    fn direction(&self, law: &SurfaceLaw, scores: &[Vec<f64>]) -> Option<(Vec<f64>, f64)> {
        let mut covariances = vec![0.0; self.laws.len()];
        for (place, (position, input)) in self.laws.iter().enumerate() {
            let Some(own) = law.given.places.get(*position).copied().flatten() else { continue };
            let part = &law.given.parts[own];
            let mut inputs = scores[place].clone();
            input.at_scores(&mut inputs);
            let each = scores[place].iter().zip(&inputs).map(|(score, &z)| score * value(part, z));
            covariances[place] = each.sum::<f64>() / POINTS as f64;
        }
        let by_member: Vec<f64> = self.members.iter().map(|&place| covariances[place]).collect();
        for (b, &place) in self.members.iter().enumerate() {
            covariances[place] = by_member.iter().enumerate().map(|(a, own)| self.factor[(a, b)] * own).sum();
        }
        let length = covariances.iter().map(|own| own * own).sum::<f64>().sqrt();
        let explained = (length / law.sigma).min(1.0);
        if explained * explained < LEAST_EXPLAINED {
            return None;
        }
        covariances.iter_mut().for_each(|own| *own /= length);
        Some((covariances, explained))
    }

    /// Counts the exceeded limits at the points of a replicate.
    pub(super) fn counts(&self, replicate: usize) -> Counts {
        let mut columns = self.scores(replicate);
        let weights = self.draw(&mut columns);
        self.inputs(&mut columns);
        let mut counts = Counts::default();
        let broken = self.broken(&columns, POINTS);
        for (broken, weight) in broken.into_iter().zip(weights).filter(|(broken, _)| *broken > 0) {
            counts.broken += broken as f64 * weight / POINTS as f64;
            counts.beyond += (broken - 1) as f64 * weight / POINTS as f64;
            counts.squares += broken as f64 * weight * weight / (POINTS * POINTS) as f64;
        }
        counts
    }

    /// Number of laws outside their limits at every point. `columns` has one column for every input.
    fn broken(&self, columns: &[Vec<f64>], points: usize) -> Vec<usize> {
        let mut broken = vec![0usize; points];
        for (law, limits) in self.characteristics {
            let mut own: Vec<&[f64]> = vec![&[]; law.given.len()];
            for ((position, _), column) in self.laws.iter().zip(columns) {
                if let Some(at) = law.given.places.get(*position).copied().flatten() {
                    own[at] = column;
                }
            }
            let kept = law.kept(*limits);
            for (broken, value) in broken.iter_mut().zip(law.given.values(&own, points)) {
                *broken += usize::from(!kept.contains(value));
            }
        }
        broken
    }

    /// Mean number of exceeded limits beyond the first, by summing over all combinations of values. Returns None if an input has a density
    /// or if there are too many combinations.
    pub(super) fn listed(&self) -> Option<LawFigure> {
        if !self.laws.iter().all(|(_, input)| input.is_discrete()) {
            return None;
        }
        let groups = Groups::of(self.laws.iter().map(|(_, input)| input.as_ref()), &self.members, &self.blocks)?;
        let terms: usize = self.characteristics.iter().map(|(law, _)| law.given.len()).sum();
        groups.count(LISTED / terms.max(1))?;
        let (mut columns, mut weights) = (vec![Vec::with_capacity(ROWS); self.laws.len()], Vec::with_capacity(ROWS));
        let mut sum = 0.0;
        let mut take = |columns: &mut Vec<Vec<f64>>, weights: &mut Vec<f64>| {
            let broken = self.broken(columns, weights.len());
            let beyond =
                broken.iter().zip(weights.iter()).map(|(broken, weight)| broken.saturating_sub(1) as f64 * weight);
            sum += beyond.sum::<f64>();
            columns.iter_mut().for_each(Vec::clear);
            weights.clear();
        };
        groups.each(&mut vec![0.0; self.laws.len()], |z, weight| {
            columns.iter_mut().zip(z).for_each(|(column, z)| column.push(*z));
            weights.push(weight);
            if weights.len() == ROWS {
                take(&mut columns, &mut weights);
            }
        });
        take(&mut columns, &mut weights);
        // Probabilities of the values are rounded, and so is every product of them.
        Some(LawFigure::new(sum, 4.0 * f64::EPSILON * (self.laws.len() + 1) as f64 * sum))
    }

    /// Independent normal scores of the own distribution, one column for every input.
    fn scores(&self, replicate: usize) -> Vec<Vec<f64>> {
        let mut digits = vec![0; POINTS];
        let column = |dimension: usize| {
            let key = mixed(mixed(mixed(SEED) ^ replicate as u64).wrapping_add(dimension as u64));
            match &self.sobol {
                Some(sobol) if dimension < SOBOL_DIMENSIONS => sobol.digits(dimension, 0, &mut digits),
                // Beyond the dimensions of the Sobol' sequence: random digits, scrambled like the others.
                _ => {
                    digits.iter_mut().enumerate().for_each(|(i, digits)| *digits = mixed(key ^ i as u64).reverse_bits())
                }
            }
            let mut column = vec![0.0; POINTS];
            tails(&digits, key, &mut column);
            standard_normal::quantiles(&mut column);
            column
        };
        (0..self.laws.len()).map(column).collect()
    }

    /// Moves the points of every cut beyond it and returns the weights of all points.
    fn draw(&self, scores: &mut [Vec<f64>]) -> Vec<f64> {
        let along = |scores: &[Vec<f64>], cut: &Cut, rows: std::ops::Range<usize>| {
            let mut t = vec![0.0; rows.len()];
            for (a, column) in cut.direction.iter().zip(scores).filter(|(a, _)| **a != 0.0) {
                t.iter_mut().zip(&column[rows.clone()]).for_each(|(t, z)| *t += a * z);
            }
            t
        };
        for cut in &self.cuts {
            // The score along the direction becomes the one of the same rank beyond the cut.
            let mut moves = along(scores, cut, cut.rows.clone());
            let beyond = |t: f64| standard_normal::upper_quantile(cut.probability * standard_normal::sf(t));
            moves.iter_mut().for_each(|t| *t = beyond(*t) - *t);
            for (a, column) in cut.direction.iter().zip(scores.iter_mut()).filter(|(a, _)| **a != 0.0) {
                column[cut.rows.clone()].iter_mut().zip(&moves).for_each(|(z, by)| *z += a * by);
            }
        }
        // Weight by the mixture: own density over the sum of the densities that points are drawn from.
        let cut_rows: usize = self.cuts.iter().map(|cut| cut.rows.len()).sum();
        let mut ratios = vec![(POINTS - cut_rows) as f64; POINTS];
        for cut in &self.cuts {
            let ratio = cut.rows.len() as f64 / cut.probability;
            let t = along(scores, cut, 0..POINTS);
            ratios.iter_mut().zip(t).filter(|(_, t)| *t > cut.score).for_each(|(sum, _)| *sum += ratio);
        }
        ratios.into_iter().map(|sum| POINTS as f64 / sum).collect()
    }

    /// Turns independent normal scores into standardised inputs, in place.
    fn inputs(&self, columns: &mut [Vec<f64>]) {
        if !self.members.is_empty() {
            self.correlate(columns);
        }
        for ((_, input), column) in self.laws.iter().zip(columns) {
            input.at_scores(column);
        }
    }

    /// Turns the independent normal scores of the correlated inputs into their correlated normal variables, in place.
    fn correlate(&self, columns: &mut [Vec<f64>]) {
        let (mut z, mut scratch) = (vec![0.0; self.laws.len()], Vec::new());
        for point in 0..POINTS {
            z.iter_mut().zip(columns.iter()).for_each(|(z, column)| *z = column[point]);
            let normals: Vec<f64> = self.members.iter().map(|&place| z[place]).collect();
            for (a, &place) in self.members.iter().enumerate() {
                z[place] = normals.iter().enumerate().map(|(b, v)| self.factor[(a, b)] * v).sum();
            }
            self.blocks.iter().for_each(|block| block.apply(&mut z, &mut scratch));
            self.members.iter().for_each(|&place| columns[place][point] = z[place]);
        }
    }
}
