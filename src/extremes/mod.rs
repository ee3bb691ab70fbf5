//! The true worst case: the least and the greatest value of every characteristic in the box of the tolerance bands.
//!
//! The box is that of [`Dimension::reach`](crate::Dimension::reach): the tolerance bands, three sigma where there is none. The
//! derivatives that the method has found say where the extremes should be; the assembly function itself says where they are.
//!
//! 1. The surrogate is minimised and maximised over the box by coordinate search from several starts, which costs nothing.
//!    What it finds, the vertices of the signs of the slopes, and two points elsewhere are evaluated.
//! 2. Where the surrogate has foretold all of these values to a part in 10^9 of their range, this is the result.
//! 3. Otherwise a search goes on from the best two points of either side: every coordinate is moved to the other end of the
//!    box, to its middle and to the stationary point of a curve through the values on its line, one by one and several at
//!    once, until no move along a coordinate improves. Interior points are refined with shorter and shorter steps.
//!
//! Evaluations: four for a linear characteristic. Otherwise up to ten, and `2N + 7` for every round of either side and start,
//! of which there are rarely more than three; coordinates that end within the box take up to four in a round, and two in
//! each of the rounds of refinement, where each pair of them takes one more while there are no more than eight.
//!
//! A search finds no certainty. [`Proof`] is one: formulas evaluated in interval arithmetic.

mod answers;
mod climb;
mod model;
mod start;
mod task;

pub use crate::warning::Ended;
pub use answers::Spent;

use answers::Answers;
use climb::Climb;
use task::Task;

use crate::assembly::Run;
use crate::method::Outcome;
use crate::problem::Problem;

/// A gain of this part of the range is none.
const GAIN: f64 = 1e-10;

/// What the search found for every characteristic, and what it took.
#[derive(Debug, Clone, Default)]
pub struct Found {
    /// In the problem's order; None where no point in the box has a value.
    pub extremes: Vec<Option<Extremes>>,
    /// What it took.
    pub spent: Spent,
}

/// The least and the greatest value of one characteristic.
#[derive(Debug, Clone, PartialEq)]
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
    /// What interval arithmetic says, where the characteristic is a formula.
    pub proof: Option<Proof>,
}

/// An interval that no assembly leaves.
#[derive(Debug, Clone, PartialEq)]
pub struct Proof {
    /// The interval.
    pub bounds: [f64; 2],
    /// Whether both of its ends are as near to the extremes as makes no difference.
    pub proven: bool,
    /// Boxes on which the formulas were evaluated in interval arithmetic; they are no evaluations.
    pub boxes: usize,
}

impl Extremes {
    /// Whether it is proven that no assembly lies beyond them.
    pub fn proven(&self) -> bool {
        self.proof.as_ref().is_some_and(|proof| proof.proven)
    }
}

/// A value, and where it is.
#[derive(Debug, Clone, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: f64,
    /// The dimensions that vary and on which the characteristic can depend.
    pub at: Vec<Coordinate>,
}

/// One dimension of an extreme.
#[derive(Debug, Clone, PartialEq)]
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
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
pub fn search(problem: &Problem, outcome: &Outcome, budget: Option<usize>, run: &Run<'_>) -> Found {
    let mut answers = Answers::new(problem, budget, run);
    let tasks: Vec<Task> = (0..problem.characteristics().len()).map(|c| Task::of(problem, outcome, c)).collect();
    tasks.iter().for_each(|task| task.learn_from(&mut answers, outcome));
    let mut asked = vec![0; tasks.len()];
    ask(&mut answers, &tasks, &mut asked, |t| tasks[t].starts.points().cloned().collect());
    // Climbs of one characteristic and side that meet are one.
    let mut climbs: Vec<(usize, f64, Climb<'_>)> = Vec::new();
    for (t, task) in tasks.iter().enumerate().filter(|(_, task)| !task.foretold(&answers)) {
        for sign in [1.0, -1.0] {
            climbs.extend(task.climbs(&answers, sign).into_iter().map(|climb| (t, sign, climb)));
        }
    }
    while !answers.ended() && !climbs.is_empty() {
        let of = |t: usize, what: &dyn Fn(f64, &Climb<'_>) -> Vec<Vec<f64>>| -> Vec<Vec<f64>> {
            climbs.iter().filter(|climb| climb.0 == t).flat_map(|(_, sign, climb)| what(*sign, climb)).collect()
        };
        ask(&mut answers, &tasks, &mut asked, |t| of(t, &|_, climb| climb.samples()));
        let candidates = |t: usize| {
            of(t, &|sign, climb| climb.candidates(&|x: &[f64]| tasks[t].value(&answers, x).map(|value| sign * value)))
        };
        let candidates: Vec<Vec<Vec<f64>>> = (0..tasks.len()).map(candidates).collect();
        ask(&mut answers, &tasks, &mut asked, |t| candidates[t].clone());
        for (t, sign, climb) in &mut climbs {
            let task = &tasks[*t];
            let value = |x: &[f64]| task.value(&answers, x).map(|value| *sign * value);
            let tried = [climb.samples(), climb.candidates(&value)].concat();
            climb.advance(&tried, &value, GAIN * task.range(&answers));
        }
        climbs.retain(|(_, _, climb)| !climb.done());
        let mut places: Vec<(usize, f64, Vec<f64>)> = Vec::new();
        climbs.retain(|(t, sign, climb)| {
            let place = (*t, *sign, climb.x.clone());
            let new = !places.contains(&place);
            places.push(place);
            new
        });
    }
    let extremes = tasks.iter().zip(asked).map(|(task, asked)| task.result(problem, &answers, asked)).collect();
    Found { extremes, spent: answers.spent }
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
