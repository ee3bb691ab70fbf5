//! The true worst case: the least and the greatest value of every characteristic in the box of the tolerance bands.
//!
//! The box is that of [`Dimension::reach`](crate::Dimension::reach): the tolerance bands, three sigma where there is none, within
//! the support of the distribution. The
//! derivatives that the method has found say where the extremes should be; the assembly function itself says where they are.
//!
//! Coordinates that share a zone stay within it: the disc of a position, a disc, rim or diamond of `[[joint]]`, and the rows of columns
//! that were measured on the same parts, where no drawing gives them a tolerance. Correlation plays no part: the worst case is what can
//! be, however rarely.
//!
//! 1. The surrogate is minimised and maximised over the box by coordinate search from several starts, which costs nothing.
//!    The extremes that it finds, the vertices of the signs of the slopes, and two points elsewhere are evaluated.
//! 2. Where the surrogate has foretold all of these values to a part in 10^9 of their range, this is the result.
//! 3. Otherwise a search goes on from the best two points of either side: every coordinate is moved to the other end of the
//!    box, to its middle and to the stationary point of a curve through the values on its line, one by one and several at
//!    once, until no move along a coordinate improves. Interior points are refined with shorter and shorter steps.
//!
//! Evaluations: four for a linear characteristic. Otherwise up to ten, and `2N` and some for every round of either side and
//! start, of which there are rarely more than three; coordinates that end within the box take up to four in a round, and two in
//! each of the rounds of refinement, where each pair of them takes one more while there are no more than eight.
//!
//! A search finds no certainty. An [`ExtremesProof`] is one: branch and bound with formulas in interval arithmetic, until no value can
//! lie beyond the extremes by more than a part in 10^9 of their range, and one in 10^12 of their size for rounding. It costs no
//! evaluation, and ends with the bounds that it has after 20000 boxes a side, fewer where there are more than ten dimensions.
//! Should it come upon a value beyond the extremes, the search goes on from there.

mod answers;
mod climb;
mod model;
mod proof;
mod sides;
mod start;
mod task;
mod zone;

pub use crate::warning::Ended;
pub use answers::Spent;
pub(crate) use model::{Model, Region};
pub(crate) use sides::keeps_by_proof;

use answers::Answers;
use climb::Climb;
use task::Task;

use serde::Serialize;

use crate::assembly::Run;
use crate::method::Outcome;
use crate::problem::Problem;
use sensitol_numeric::power::rescale;

/// A gain of this part of the range is none.
const GAIN: f64 = 1e-10;
/// Searches after each other, of which each begins at a point that branch and bound has found beyond the last one's extremes.
const REPEATED: usize = 4;

/// The extremes that the search found for every characteristic, and their cost.
#[derive(Debug, Clone, Default)]
#[non_exhaustive]
pub struct SearchedExtremes {
    /// In the problem's order; None where no point in the box has a value.
    pub extremes: Vec<Option<Extremes>>,
    /// The cost of the search.
    pub spent: Spent,
}

/// The least and the greatest value of one characteristic.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Extremes {
    /// The least value.
    pub least: Extreme,
    /// The greatest value.
    pub greatest: Extreme,
    /// Points that were evaluated for it; one that serves several characteristics counts for each.
    pub evaluations: usize,
    /// Points of the search at which it has no value.
    pub failed: usize,
    /// The first of them and why, in words.
    pub failure: Option<String>,
    /// How the search ended.
    pub ended: Ended,
    /// The bounds by interval arithmetic, where the characteristic is a formula.
    pub proof: Option<ExtremesProof>,
}

/// An interval that no assembly leaves.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct ExtremesProof {
    /// The interval.
    pub bounds: [f64; 2],
    /// Whether both of its ends are as near to the extremes as makes no difference.
    pub proven: bool,
    /// How far either end may lie beyond a value that exists.
    pub slack: [f64; 2],
    /// Boxes on which the formulas were evaluated in interval arithmetic; they are no evaluations.
    pub boxes: usize,
}

rescale!(Extremes { least, greatest, proof } without { evaluations, failed, failure, ended });
rescale!(Extreme { value } without { at });
rescale!(ExtremesProof { bounds, slack } without { proven, boxes });

impl Extremes {
    /// Whether it is proven that no assembly lies beyond them.
    pub fn proven(&self) -> bool {
        self.proof.as_ref().is_some_and(|proof| proof.proven)
    }
}

/// A value, and where it is.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The dimensions that vary and on which the characteristic can depend.
    pub at: Vec<Coordinate>,
}

/// One dimension of an extreme.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct Coordinate {
    /// The dimension.
    pub dimension: String,
    /// Its value.
    pub x: f64,
    /// Its band.
    pub band: [f64; 2],
    /// Where in the band it stands.
    pub place: Place,
}

/// Where in its band a dimension stands.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
#[non_exhaustive]
pub enum Place {
    /// At the lower end.
    Lower,
    /// At the upper end.
    Upper,
    /// Between them.
    Interior,
}

/// Searches the extremes of every characteristic, beginning with what a method has found out.
///
/// Evaluations: as the module says, no more than `budget`; a point that serves several characteristics is evaluated once. A
/// point at which the model fails is never used.
pub fn search(problem: &Problem, outcome: &Outcome, budget: Option<usize>, run: &Run<'_>) -> SearchedExtremes {
    let mut answers = Answers::new(problem, budget, run);
    let tasks: Vec<Task> = (0..problem.characteristics().len()).map(|c| Task::of(problem, outcome, c)).collect();
    tasks.iter().for_each(|task| task.learn_from(&mut answers, outcome));
    let mut asked = vec![0; tasks.len()];
    ask(&mut answers, &tasks, &mut asked, |t| tasks[t].starts.points().cloned().collect());
    let begin = |t: usize, answers: &Answers<'_>| {
        [1.0, -1.0].map(|sign| tasks[t].climbs(answers, sign).into_iter().map(move |climb| Ongoing { t, sign, climb }))
    };
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
    SearchedExtremes { extremes, spent: answers.spent }
}

/// An interval that no assembly of a characteristic leaves, by interval arithmetic alone; None where its function has no bounds.
///
/// `proven` says that values within `near` of both ends exist. Ends after 1000 boxes a side, fewer where there are more than ten
/// dimensions. No evaluation.
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

/// A search of one characteristic and side.
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

/// All searches side by side, until each has ended or nothing more can be asked.
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
            // Those of one characteristic and side that meet are one.
            let place = (ongoing.t, ongoing.sign, ongoing.climb.x.clone());
            let new = !places.contains(&place);
            places.push(place);
            new && !ongoing.climb.done()
        });
    }
}

/// Asks for the points that each task wants, and counts for each those that were not known.
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
