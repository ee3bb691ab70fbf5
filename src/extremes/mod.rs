//! True worst case: the least and the greatest value of every characteristic in the box of the tolerance bands.
//!
//! The box is that of [`Dimension::reach`](crate::Dimension::reach): the tolerance band of each dimension. A dimension
//! without a tolerance has three sigma, cut at the support of its distribution. The derivatives from the method predict
//! the places of the extremes. Evaluations of the assembly function confirm or correct them.
//!
//! Coordinates that share a zone stay within it. Zones are the disc of a position, and the disc, rim or diamond of
//! `[[joint]]`. Columns measured on the same parts stay on the measured rows, if no drawing gives them a tolerance.
//! Correlation plays no part: the worst case is every possible assembly, however rare.
//!
//! 1. A coordinate search from several starts minimises and maximises the surrogate over the box, without evaluations.
//!    The extremes that it finds, the vertices of the signs of the slopes, and two points elsewhere are evaluated.
//! 2. If the surrogate has predicted all of these values to a part in 10^9 of their range, this is the result.
//! 3. Otherwise a search goes on from the best two points of either side. Every coordinate is moved to the other end of
//!    the box, to its middle, and to the stationary point of a curve through the values on its line. Coordinates are
//!    moved one by one and several at once, until no move along a coordinate improves. Interior points are refined with
//!    shorter and shorter steps.
//!
//! Cost: four evaluations for a linear characteristic. Otherwise up to ten, and about `2N` for every round of either
//! side and start. There are rarely more than three rounds. Coordinates that end within the box take up to four
//! evaluations in a round, and two in each round of refinement. Each pair of them takes one more, while there are no
//! more than eight.
//!
//! A search gives no certainty. An [`ExtremesProof`] does: branch and bound with formulas in interval arithmetic. It
//! ends when no value can lie beyond the extremes by more than a part in 10^9 of their range, plus one in 10^12 of
//! their size for rounding. It costs no evaluation. It stops after 20000 boxes a side, fewer for more than ten
//! dimensions, with the bounds reached so far. If it finds a value beyond the extremes, the search goes on from there.

mod answers;
mod local_search;
mod model;
mod one_sided_proof;
mod proof;
mod start_points;
mod task;
mod zone;

pub(crate) use crate::extremes::one_sided_proof::keeps_by_proof;
pub use crate::warning::Ended;
pub(crate) use model::{Model, Region};

use crate::extremes::local_search::Climb;
use answers::Answers;
use task::Task;

use serde::Serialize;

use crate::assembly::Run;
use crate::evaluation::{Evaluator, Ledger};
use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::power::rescale;

/// Smallest gain of a move that counts, as a part of the range of the known values.
const GAIN: f64 = 1e-10;
/// Greatest number of successive searches. Each after the first begins at a point beyond the last extremes that branch
/// and bound has found.
const REPEATED: usize = 4;

/// Extremes of every characteristic, and the cost of the search.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct SearchedExtremes {
    /// Extremes in the order of the problem's characteristics. None if no point in the box has a value.
    pub extremes: Vec<Option<Extremes>>,
    /// Cost of the search. The budget is the reason for an early end if points were left out because of it.
    pub ledger: Ledger,
}

/// Least and greatest value of one characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Extremes {
    /// The least value.
    pub least: Extreme,
    /// The greatest value.
    pub greatest: Extreme,
    /// Number of points evaluated for this characteristic. A point that serves several characteristics counts for each.
    pub evaluations: usize,
    /// Number of points of the search without a value of this characteristic.
    pub failed: usize,
    /// First failed point and the reason, in words.
    pub failure: Option<String>,
    /// Reason why the search ended.
    pub ended: Ended,
    /// Bounds by interval arithmetic, if the characteristic is a formula.
    pub proof: Option<ExtremesProof>,
}

/// Interval that holds the values of all assemblies.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ExtremesProof {
    /// Lower and upper bound.
    pub bounds: [f64; 2],
    /// True if both bounds are within the allowed distance of the extremes.
    pub proven: bool,
    /// Greatest distance of each bound beyond a value that exists.
    pub slack: [f64; 2],
    /// Number of boxes on which the formulas were evaluated in interval arithmetic. These are no evaluations of the
    /// model.
    pub boxes: usize,
}

rescale!(Extremes { least, greatest, proof } without { evaluations, failed, failure, ended });
rescale!(Extreme { value } without { at });
rescale!(ExtremesProof { bounds, slack } without { proven, boxes });

impl Extremes {
    /// True if interval arithmetic proves that no assembly lies beyond the two values.
    pub fn proven(&self) -> bool {
        self.proof.as_ref().is_some_and(|proof| proof.proven)
    }
}

/// Value of an extreme, and its place.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Extreme {
    /// Value of the characteristic.
    pub value: f64,
    /// Coordinates: the dimensions that vary and on which the characteristic can depend.
    pub at: Vec<Coordinate>,
}

/// One dimension at an extreme.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Coordinate {
    /// Name of the dimension.
    pub dimension: String,
    /// Value of the dimension.
    pub x: f64,
    /// Ends of the dimension's band.
    pub band: [f64; 2],
    /// Place of the value in the band.
    pub place: Place,
}

/// Place of a dimension in its band.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Place {
    /// Lower end of the band.
    Lower,
    /// Upper end of the band.
    Upper,
    /// Values between the two ends.
    Interior,
}

/// Searches the extremes of every characteristic, beginning with the values that a method has evaluated.
///
/// Cost: as stated in the module, at most what remains of the evaluator's budget. Its ledger stays as it is. A point
/// that serves several characteristics is evaluated once. A point at which the model fails is never used.
pub fn search(evaluator: &Evaluator<'_>, outcome: &Outcome) -> SearchedExtremes {
    let (problem, run) = (evaluator.problem(), evaluator.run());
    let mut answers = Answers::new(evaluator.part());
    let tasks: Vec<Task> = (0..problem.characteristics().len()).map(|c| Task::of(problem, outcome, c)).collect();
    tasks.iter().for_each(|task| task.learn_from(&mut answers, outcome));
    let mut asked = vec![0; tasks.len()];
    ask(&mut answers, &tasks, &mut asked, |t| tasks[t].starts.points().cloned().collect());
    let begin = |t: usize, answers: &Answers<'_>| {
        [1.0, -1.0].map(|sign| tasks[t].climbs(answers, sign).into_iter().map(move |climb| Ongoing { t, sign, climb }))
    };
    // A characteristic that the surrogate has predicted needs no search. Branch and bound may start one later.
    let unsure = (0..tasks.len()).filter(|&t| !tasks[t].foretold(&answers));
    let mut climbs: Vec<Ongoing<'_>> = unsure.flat_map(|t| begin(t, &answers)).flatten().collect();
    let mut proofs = vec![None; tasks.len()];
    for _ in 0..REPEATED {
        go_on(&mut answers, &tasks, &mut asked, climbs);
        let better: Vec<Vec<Vec<f64>>> = (tasks.iter().zip(&mut proofs))
            .map(|(task, proof)| {
                let (found, better) = task.prove(problem, &answers, run);
                *proof = found;
                better
            })
            .collect();
        ask(&mut answers, &tasks, &mut asked, |t| better[t].clone());
        let surprised = (0..tasks.len()).filter(|&t| !better[t].is_empty());
        climbs = surprised.flat_map(|t| begin(t, &answers)).flatten().collect();
        if climbs.is_empty() || answers.ended() {
            break;
        }
    }
    let result = |((task, proof), asked)| Task::result(task, problem, &answers, asked, proof);
    let extremes = tasks.iter().zip(proofs).zip(asked).map(result).collect();
    SearchedExtremes { extremes, ledger: answers.evaluator.into_ledger() }
}

/// Bounds a characteristic over the box by interval arithmetic alone. Returns None if the assembly function has no
/// bounds.
///
/// `proven` is true if values within `near` of both ends exist. The proof stops after 1000 boxes a side, fewer for more
/// than ten dimensions. It costs no evaluation.
pub(crate) fn enclose(
    problem: &Problem,
    outcome: &Outcome,
    c: usize,
    near: f64,
    run: &Run<'_>,
) -> Option<ExtremesProof> {
    Task::of(problem, outcome, c)
        .enclose(problem, near, run)
        .filter(|proof| proof.bounds.iter().all(|end| end.is_finite()))
}

/// Search of one characteristic on one side.
struct Ongoing<'t> {
    t: usize,
    /// 1 for the least value, -1 for the greatest.
    sign: f64,
    climb: Climb<'t>,
}

impl Ongoing<'_> {
    fn value<'a>(&'a self, tasks: &'a [Task], answers: &'a Answers<'_>) -> impl Fn(&[f64]) -> Option<f64> + 'a {
        |x| tasks[self.t].value(answers, x).map(|value| self.sign * value)
    }
}

/// Runs all searches side by side, until each has ended or no more points can be evaluated.
fn go_on(answers: &mut Answers<'_>, tasks: &[Task], asked: &mut [usize], mut climbs: Vec<Ongoing<'_>>) {
    let of = |climbs: &[Ongoing<'_>], t: usize, what: &dyn Fn(&Ongoing<'_>) -> Vec<Vec<f64>>| -> Vec<Vec<f64>> {
        climbs.iter().filter(|ongoing| ongoing.t == t).flat_map(what).collect()
    };
    while !answers.ended() && !climbs.is_empty() {
        ask(answers, tasks, asked, |t| of(&climbs, t, &|ongoing| ongoing.climb.samples()));
        let candidates: Vec<Vec<Vec<f64>>> = (0..tasks.len())
            .map(|t| of(&climbs, t, &|ongoing| ongoing.climb.candidates(&ongoing.value(tasks, answers))))
            .collect();
        ask(answers, tasks, asked, |t| candidates[t].clone());
        let mut places: Vec<(usize, f64, Vec<f64>)> = Vec::new();
        climbs.retain_mut(|ongoing| {
            let value = |x: &[f64]| tasks[ongoing.t].value(answers, x).map(|value| ongoing.sign * value);
            let tried = [ongoing.climb.samples(), ongoing.climb.candidates(&value)].concat();
            ongoing.climb.advance(&tried, &value, GAIN * tasks[ongoing.t].range(answers));
            // Searches of one characteristic and side that meet at a point are merged.
            let place = (ongoing.t, ongoing.sign, ongoing.climb.x.clone());
            let new = !places.contains(&place);
            places.push(place);
            new && !ongoing.climb.done()
        });
    }
}

/// Evaluates the points that each task needs. Counts for each task the points that were not known before.
fn ask(answers: &mut Answers<'_>, tasks: &[Task], asked: &mut [usize], wanted: impl Fn(usize) -> Vec<Vec<f64>>) {
    let mut points = Vec::new();
    for (t, task) in tasks.iter().enumerate() {
        points.push(answers.unknown(wanted(t).iter().map(|x| task.point(x))));
    }
    answers.ask(points.concat());
    for (asked, points) in asked.iter_mut().zip(points) {
        *asked += points.len() - answers.unknown(points.into_iter()).len();
    }
}
