//! Correlations of the characteristics of a cheap model, and their common rejects, from points of the model itself.

use serde::Serialize;

use crate::assembly::Run;
use crate::estimate::figures::moments;
use crate::estimate::normal_space::NormalSpace;
use crate::estimate::replicate_sums::ReplicateSums;
use crate::estimate::stratified_sample::REPLICATES;
use crate::estimate::verified::Verified;
use crate::evaluation::Evaluator;
use crate::problem::Problem;
use sensitol_numeric::characteristic::KeptLimits;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Normals, clopper_pearson};

/// Number of points of one randomisation.
const ROWS: usize = 1 << 10;
/// Greatest number of rounds of points for a rare condition: a million points, half a second of a formula. One in 10000 keeps it at a
/// hundred of them.
const ROUNDS: usize = 64;
/// Number of points keeping the condition that is enough: their share has an error of at most 1 %.
const ENOUGH: u64 = 2500;
/// Number of sums of a pair: points, first, second, their squares, their product.
const SUMS: usize = 6;

/// Correlation of two characteristics.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct OutputCorrelation {
    /// Names of the two characteristics.
    pub between: [String; 2],
    /// Coefficient of correlation; null if one of them does not vary, or is unknown.
    pub value: Option<f64>,
    /// Error of the coefficient; null if the model was not evaluated for it.
    pub error: Option<f64>,
}

impl OutputCorrelation {
    /// Greatest number of characteristics with a table of correlations, whose size grows with their square.
    pub(crate) const MOST: usize = 40;
}

/// Every pair of so many characteristics, in the order `(0, 1), (0, 2), ..., (1, 2), ...`.
pub(crate) fn pairs(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]))
}

/// Several characteristics of a cheap model at the same points of all dimensions that vary.
struct JointPoints<'p> {
    evaluator: Evaluator<'p>,
    outputs: Vec<usize>,
    space: NormalSpace<'p>,
    normals: Normals,
}

impl<'p> JointPoints<'p> {
    fn new(problem: &'p Problem, characteristics: impl Iterator<Item = usize>, seed: u64) -> Self {
        let varies = |&d: &usize| problem.dimensions()[d].sigma() > 0.0;
        let varying: Vec<usize> = (0..problem.dimensions().len()).filter(varies).collect();
        Self {
            evaluator: Evaluator::new(problem, &Run::to_the_end()),
            outputs: characteristics.map(|c| problem.outputs()[c]).collect(),
            space: NormalSpace::new(problem, &varying),
            normals: Normals::new(varying.len(), seed),
        }
    }

    /// Values of every characteristic at the points of one randomisation, NaN if there is none.
    fn values(&self, replicate: usize) -> Vec<Vec<f64>> {
        let z = self.normals.columns((1 << 34) + replicate as u64, ROWS);
        let out = self.evaluator.ask_outputs(&self.space.points(&z), &self.outputs);
        (0..self.outputs.len()).map(|output| out.column(output).to_vec()).collect()
    }
}

/// Coefficient of correlation of every pair of characteristics, over the points at which both have a value, in the order of [`pairs`].
/// Returns None if one of them does not vary.
///
/// 16 randomisations of 1024 Sobol' points of all dimensions that vary, errors by the jackknife and Student's quantile. Pure in
/// problem and seed. Accuracy: errors of some 1e-3 where the characteristics are smooth.
pub(crate) fn output_correlations(problem: &Problem, seed: u64) -> Vec<Option<Verified>> {
    let count = problem.characteristics().len();
    let points = JointPoints::new(problem, 0..count, seed);
    let pairs: Vec<[usize; 2]> = pairs(count).collect();
    // In units of the first randomisation, so that no mean is large compared to the scatter.
    let units: Vec<[f64; 2]> = points.values(0).iter().map(|column| unit(column)).collect();
    let rows: Vec<Vec<[f64; SUMS]>> = (0..REPLICATES)
        .into_par_iter()
        .map(|replicate| {
            let columns = points.values(replicate);
            pairs.iter().map(|&[a, b]| sums([&columns[a], &columns[b]], [units[a], units[b]])).collect()
        })
        .collect();
    (0..pairs.len())
        .map(|index| {
            let sums: Vec<[f64; SUMS]> = rows.iter().map(|row| row[index]).collect();
            let found = ReplicateSums::by_replicate(&sums).estimates(coefficient)[0];
            Some(found).filter(|found| found.value.is_finite() && found.error.is_finite())
        })
        .collect()
}

/// Evaluations of [`output_correlations`], and of [`common_rejects`], over this number of characteristics.
pub(crate) const fn most_points_together(characteristics: usize) -> usize {
    characteristics * ROWS * REPLICATES
}

/// Mean number of broken characteristics beyond the first, over the points with all values: rejects that a sum of reject rates counts
/// again. Returns None if no point has all values.
///
/// It uses the points of [`output_correlations`], with errors of the same kind. If no point is counted twice, the error is that of zero
/// hits among all points.
pub(crate) fn common_rejects(problem: &Problem, characteristics: &[usize], seed: u64) -> Option<Verified> {
    let points = JointPoints::new(problem, characteristics.iter().copied(), seed);
    let kept: Vec<KeptLimits> = characteristics.iter().map(|&c| problem.kept_limits(c)).collect();
    // Points with all values, and broken characteristics beyond the first.
    let count = |replicate: usize| -> [f64; 2] {
        let columns = points.values(replicate);
        let mut sums = [0.0; 2];
        for row in 0..columns.first().map_or(0, Vec::len) {
            let values = || columns.iter().map(|column| column[row]);
            if values().all(|value| value.is_finite()) {
                let broken = values().zip(&kept).filter(|(value, kept)| !kept.contains(*value)).count();
                sums[0] += 1.0;
                sums[1] += broken.saturating_sub(1) as f64;
            }
        }
        sums
    };
    let counts: Vec<[f64; 2]> = (0..REPLICATES).into_par_iter().map(count).collect();
    let sums = ReplicateSums::by_replicate(&counts);
    let points = sums.totals()[0];
    if points == 0.0 {
        return None;
    }
    let Verified { value, error: scatter } = sums.estimates(|total| vec![total[1] / total[0]])[0];
    let [_, unseen] = clopper_pearson(0.0, points);
    let error = if value > 0.0 { scatter } else { 0.5 * unseen };
    Some(Verified { value, error: error.max(1.0 / points) })
}

/// Greatest number of evaluations of [`counted_condition`].
pub(crate) const fn most_points_given() -> usize {
    2 * ROWS * REPLICATES * ROUNDS
}

/// Share of the points keeping the limits of the first characteristic among those keeping the limits of the second, with its 95 % interval.
/// Both have a value at the points that count. Returns None if no point keeps the limits of the second.
///
/// Up to 64 rounds of 16 randomisations of 1024 Sobol' points, fewer as soon as enough points count. The interval is that of independent
/// points (Clopper, Pearson 1934), which is wider than that of Sobol' points. Pure in problem and seed.
pub(crate) fn counted_condition(problem: &Problem, pair: [usize; 2], seed: u64) -> Option<(f64, [f64; 2])> {
    let points = JointPoints::new(problem, pair.into_iter(), seed);
    let [own, given] = pair.map(|c| problem.kept_limits(c));
    let count = |replicate: usize| -> [u64; 2] {
        let columns = points.values(replicate);
        let rows = columns[0].iter().zip(&columns[1]).filter(|(y, of)| y.is_finite() && given.contains(**of));
        rows.fold([0; 2], |[known, kept], (y, _)| [known + 1, kept + u64::from(own.contains(*y))])
    };
    let [mut known, mut kept] = [0; 2];
    for round in 0..ROUNDS {
        let first = round * REPLICATES;
        let counts: Vec<[u64; 2]> = (first..first + REPLICATES).into_par_iter().map(count).collect();
        for [more, of_more] in counts {
            (known, kept) = (known + more, kept + of_more);
        }
        if known >= ENOUGH {
            break;
        }
    }
    let (known, kept) = (known as f64, kept as f64);
    (known > 0.0).then(|| (kept / known, clopper_pearson(kept, known)))
}

/// Mean and sigma of the finite values, 0 and 1 if they are undefined.
fn unit(column: &[f64]) -> [f64; 2] {
    let valid: Vec<f64> = column.iter().copied().filter(|y| y.is_finite()).collect();
    let [mean, sigma, ..] = moments(&valid, &vec![1.0; valid.len()]);
    [if mean.is_finite() { mean } else { 0.0 }, if sigma > 0.0 { sigma } else { 1.0 }]
}

fn sums([first, second]: [&[f64]; 2], [of_first, of_second]: [[f64; 2]; 2]) -> [f64; SUMS] {
    let mut sums = [0.0; SUMS];
    for (a, b) in first.iter().zip(second).filter(|(a, b)| a.is_finite() && b.is_finite()) {
        let (a, b) = ((a - of_first[0]) / of_first[1], (b - of_second[0]) / of_second[1]);
        for (sum, term) in sums.iter_mut().zip([1.0, a, b, a * a, b * b, a * b]) {
            *sum += term;
        }
    }
    sums
}

fn coefficient(total: &[f64]) -> Vec<f64> {
    let [n, a, b, aa, bb, ab] = std::array::from_fn(|index| total[index]);
    let variances = (aa - a * a / n) * (bb - b * b / n);
    vec![if variances > 0.0 { ((ab - a * b / n) / variances.sqrt()).clamp(-1.0, 1.0) } else { f64::NAN }]
}
