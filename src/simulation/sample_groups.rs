//! Points of a simulation, grouped by the rows or values of measured samples.

use std::collections::HashMap;

use serde::{Deserialize, Serialize};

use crate::assembly::{Points, Responses};
use crate::problem::Problem;
use sensitol_numeric::correlation::JointLaw;
use sensitol_numeric::distribution::{Distribution, Sample};
use sensitol_numeric::sampling::MeasuredSample;

/// Greatest number of groups of a measured sample.
const GROUPS: usize = 400;
/// Smallest number of points of a group on average.
const POINTS: u64 = 50;
/// Half-width of the range of a fitted distribution that is divided into groups, in sigmas.
const RANGE: f64 = 4.0;

/// Measured samples of a problem, each with its groups.
pub(super) struct MeasuredGroups<'p> {
    pub(super) problem: &'p Problem,
    pub(super) samples: Vec<Grouped<'p>>,
    /// Dependence of every characteristic on each dimension.
    pub(super) dependence: Vec<Vec<bool>>,
}

/// A measured sample with its groups.
pub(super) struct Grouped<'p> {
    pub(super) sample: MeasuredSample,
    groups: usize,
    by: Grouping<'p>,
    /// Divisor of the variance over groups that gives the variance of a mean over the sample.
    pub(super) divisor: f64,
}

/// Rule that assigns a point to its group.
enum Grouping<'p> {
    /// Rank of the value in the sample.
    Rank(&'p Sample),
    /// Place of the value within the range of a fitted distribution.
    Place { mean: f64, sigma: f64 },
    /// Row of the point, which is identified by the ranks of its values.
    Row { samples: Vec<&'p Sample>, groups: HashMap<Vec<usize>, usize> },
}

impl<'p> MeasuredGroups<'p> {
    /// Groups for a simulation with this number of points. Returns None if there are no measured inputs.
    pub(super) fn of(problem: &'p Problem, points: u64) -> Option<Self> {
        let found = MeasuredSample::all(problem.dimensions(), problem.correlation());
        let most = (points / POINTS).clamp(2, GROUPS as u64) as usize;
        let samples: Vec<Grouped<'p>> = found.into_iter().filter_map(|one| grouped(problem, one, most)).collect();
        let dependence = problem.dependence();
        (!samples.is_empty()).then_some(Self { problem, samples, dependence })
    }

    /// Group of every point, by sample.
    pub(super) fn groups(&self, points: &Points) -> Vec<Vec<usize>> {
        self.samples.iter().map(|one| one.find(points)).collect()
    }
}

/// Divides a sample into at most `most` groups. Returns None if the sample belongs to no distribution or block of rows.
fn grouped(problem: &Problem, sample: MeasuredSample, most: usize) -> Option<Grouped<'_>> {
    let law = |d: usize| problem.dimensions()[d].distribution();
    let measured = |d: usize| law(d).and_then(Distribution::measured).map(|of| of.sample());
    let size = sample.size as f64;
    let groups = most.min(sample.size);
    if let [d] = sample.dimensions[..] {
        let by = match sample.is_empirical {
            true => Grouping::Rank(measured(d)?),
            false => Grouping::Place { mean: law(d)?.mean(), sigma: law(d)?.sigma() },
        };
        return Some(Grouped { sample, groups, by, divisor: size });
    }
    let correlation = problem.correlation()?;
    let (block, _) = correlation.block_of(sample.dimensions[0])?;
    let block = &correlation.blocks()[block];
    let JointLaw::Rows(rows) = &block.law else { return None };
    let ranks = rows.ranks();
    // Rows are assigned in turn: a group is then a sample of all rows, not of neighbours, and its mean has the variance of such a sample.
    let row = |row: usize| (ranks.iter().map(|of| of[row]).collect(), row % groups);
    let samples = block.members.iter().map(|&d| measured(d)).collect::<Option<_>>()?;
    let by = Grouping::Row { samples, groups: (0..rows.len()).map(row).collect() };
    Some(Grouped { sample, groups, by, divisor: groups as f64 })
}

impl Grouped<'_> {
    fn find(&self, points: &Points) -> Vec<usize> {
        let column = |at: usize| points.column(self.sample.dimensions[at]);
        let last = self.groups - 1;
        match &self.by {
            Grouping::Rank(sample) => {
                let place = |value: &f64| {
                    let distinct = place(sample, *value);
                    let before = if distinct == 0 { 0 } else { sample.upto()[distinct - 1] };
                    // Rank of the middle of equal values.
                    let rank = before + (sample.upto()[distinct] - before) / 2;
                    (rank * self.groups / sample.len()).min(last)
                };
                column(0).iter().map(place).collect()
            }
            Grouping::Place { mean, sigma } => {
                let place = |value: &f64| {
                    let part = ((value - mean) / sigma / RANGE + 1.0) / 2.0;
                    ((part * self.groups as f64) as usize).min(last)
                };
                column(0).iter().map(place).collect()
            }
            Grouping::Row { samples, groups } => {
                let columns: Vec<&[f64]> = (0..samples.len()).map(column).collect();
                let mut key = vec![0; samples.len()];
                let mut find = |row: usize| {
                    let values = columns.iter().zip(samples);
                    key.iter_mut().zip(values).for_each(|(key, (column, sample))| *key = place(sample, column[row]));
                    groups.get(&key).copied().unwrap_or(0)
                };
                (0..points.rows()).map(&mut find).collect()
            }
        }
    }
}

/// Index of a value among the distinct ones of a sample.
fn place(sample: &Sample, value: f64) -> usize {
    sample.values().partition_point(|&other| other < value).min(sample.values().len() - 1)
}

/// Count, mean, sum of squares about the mean, and rejects of one group.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Group {
    pub(super) count: f64,
    pub(super) mean: f64,
    pub(super) square: f64,
    pub(super) rejects: f64,
}

impl Group {
    fn add(&mut self, value: f64, rejected: bool) {
        self.count += 1.0;
        let apart = value - self.mean;
        self.mean += apart / self.count;
        self.square += apart * (value - self.mean);
        self.rejects += f64::from(u8::from(rejected));
    }

    fn merge(&mut self, other: &Self) {
        let count = self.count + other.count;
        if count > 0.0 {
            let apart = other.mean - self.mean;
            self.mean += apart * other.count / count;
            self.square += other.square + apart * apart * self.count * other.count / count;
            self.count = count;
            self.rejects += other.rejects;
        }
    }
}

/// Groups of every sample for one characteristic.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct GroupSums(pub(super) Vec<Vec<Group>>);

impl GroupSums {
    /// Sums of values, NaN if there is none, by the group of every point for each sample.
    pub(super) fn of(of: &MeasuredGroups<'_>, groups: &[Vec<usize>], out: &Responses, c: usize) -> Self {
        let limits = of.problem.kept_limits(c);
        let sums = |(one, groups): (&Grouped<'_>, &Vec<usize>)| {
            let mut sums = vec![Group::default(); one.groups];
            for (&value, &group) in out.column(c).iter().zip(groups) {
                if !value.is_nan() {
                    sums[group].add(value, !limits.contains(value));
                }
            }
            sums
        };
        Self(of.samples.iter().zip(groups).map(sums).collect())
    }

    pub(super) fn merge(&mut self, other: &Self) {
        if self.0.is_empty() {
            self.0.clone_from(&other.0);
            return;
        }
        for (own, more) in self.0.iter_mut().flatten().zip(other.0.iter().flatten()) {
            own.merge(more);
        }
    }
}
