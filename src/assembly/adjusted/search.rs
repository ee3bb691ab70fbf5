//! Search for the value of a stock that brings an output nearest its target.

use crate::assembly::adjusted::{Adjustment, Chosen, StockResponse};
use crate::assembly::{AssemblyFunction, EvaluationError, Request, Responses, Run};

/// Choice at one point.
#[derive(Debug, Clone)]
pub(super) enum Choice {
    /// Value of the stock, and the distance by which the next best one is farther from the target.
    Found {
        /// Place in the stock.
        place: usize,
        /// Distance by which the next best value is farther from the target than this one.
        ahead: f64,
    },
    /// No value of the stock could be judged.
    Failed(EvaluationError),
}

impl Choice {
    pub(super) fn place(&self) -> Option<usize> {
        match self {
            Self::Found { place, .. } => Some(*place),
            Self::Failed(_) => None,
        }
    }

    pub(super) fn failure(&self) -> Option<&EvaluationError> {
        match self {
            Self::Found { .. } => None,
            Self::Failed(error) => Some(error),
        }
    }

    /// Margin that changes its sign wherever the neighbouring value is chosen. NaN without a choice.
    pub(super) fn margin(&self) -> f64 {
        match self {
            Self::Found { place, ahead } if place % 2 == 0 => *ahead,
            Self::Found { ahead, .. } => -ahead,
            Self::Failed(_) => f64::NAN,
        }
    }
}

/// Distances of two values of the stock from the target: the best so far, and the next.
#[derive(Debug, Clone, Copy)]
struct Best {
    place: usize,
    distance: f64,
    next: f64,
}

impl Best {
    const NONE: Self = Self { place: 0, distance: f64::INFINITY, next: f64::INFINITY };

    fn consider(&mut self, place: usize, distance: f64) {
        if distance < self.distance {
            *self = Self { place, distance, next: self.distance };
        } else {
            self.next = self.next.min(distance);
        }
    }

    fn choice(self) -> Choice {
        // A stock of one value has no other.
        let ahead = if self.next.is_finite() { self.next - self.distance } else { f64::MAX };
        Choice::Found { place: self.place, ahead }
    }
}

/// Evaluations of the measured output at values of the stock.
struct Trials<'a, 'r> {
    function: &'a dyn AssemblyFunction,
    one: &'a Adjustment,
    run: &'a Run<'r>,
    found: &'a mut Chosen,
}

impl Trials<'_, '_> {
    /// Values of the measured output with the stock's value of this place in each row. Returns None if the run was stopped.
    fn at(&mut self, place: impl Fn(usize) -> usize) -> Option<Responses> {
        let points = &mut self.found.points;
        for (row, value) in points.column_mut(self.one.input).iter_mut().enumerate() {
            *value = self.one.stock[place(row)];
        }
        let mut answers = Responses::open(points.rows(), 1);
        self.function.evaluate(&Request::values(points, &[self.one.to]), self.run, &mut answers);
        self.found.spent += answers.answered().count() as i64 + answers.extra() + answers.count_reused() as i64;
        self.found.reused += answers.count_reused();
        (!answers.has_open_entries()).then_some(answers)
    }
}

/// Choice at every point, without a test of the line if the output is `proven` to be linear. Returns None if the run was stopped.
pub(super) fn choices(
    function: &dyn AssemblyFunction,
    one: &Adjustment,
    proven: bool,
    found: &mut Chosen,
    run: &Run<'_>,
) -> Option<Vec<Choice>> {
    let mut trials = Trials { function, one, run, found };
    match one.response {
        _ if one.stock.len() < 3 => every_value(&mut trials),
        StockResponse::Any => every_value(&mut trials),
        StockResponse::Monotone => bisected(&mut trials),
        StockResponse::Linear => {
            let (choices, lines) = on_a_line(&mut trials)?;
            if proven { Some(choices) } else { tested(&mut trials, choices, &lines) }
        }
    }
}

/// Tries every value. One without an answer is not chosen.
fn every_value(trials: &mut Trials<'_, '_>) -> Option<Vec<Choice>> {
    let rows = trials.found.points.rows();
    let mut best = vec![Best::NONE; rows];
    let mut errors: Vec<Option<EvaluationError>> = vec![None; rows];
    for place in 0..trials.one.stock.len() {
        let answers = trials.at(|_| place)?;
        for (row, best) in best.iter_mut().enumerate() {
            match answers.value(row, 0) {
                Some(value) => best.consider(place, (value - trials.one.target).abs()),
                None => errors[row] = answers.error(row, 0).cloned(),
            }
        }
    }
    let of = |(best, error): (Best, Option<EvaluationError>)| match error {
        Some(error) if best.distance.is_infinite() => Choice::Failed(error),
        _ => best.choice(),
    };
    Some(best.into_iter().zip(errors).map(of).collect())
}

/// Line through the values of the measured output at both ends of the stock.
#[derive(Debug, Clone, Copy)]
struct StockLine {
    ends: [f64; 2],
    slope: f64,
}

impl StockLine {
    /// Value on the line at a place of the stock.
    fn at(&self, one: &Adjustment, place: usize) -> f64 {
        self.ends[0] + self.slope * (one.stock[place] - one.stock[0])
    }

    /// Greatest distance of an answer from the line that leaves the choice right: half of the change by the nearest other value.
    fn allowed(&self, one: &Adjustment, place: usize) -> f64 {
        /// Rounding of an answer, as a part of it. Programs print some ten digits.
        const ROUNDED: f64 = 1e-9;
        let around = [place.saturating_sub(1), (place + 1).min(one.stock.len() - 1)];
        let steps =
            around.iter().filter(|&&other| other != place).map(|&other| (one.stock[other] - one.stock[place]).abs());
        let step = steps.fold(f64::INFINITY, f64::min);
        0.5 * (self.slope * step).abs() + ROUNDED * self.ends[0].abs().max(self.ends[1].abs())
    }
}

/// Tries both ends of the stock, and takes the value next to the one that meets the target on the line through them.
fn on_a_line(trials: &mut Trials<'_, '_>) -> Option<(Vec<Choice>, Vec<StockLine>)> {
    let one = trials.one;
    let last = one.stock.len() - 1;
    let [first, end] = [trials.at(|_| 0)?, trials.at(|_| last)?];
    let value = |of: &Responses, row: usize| of.value(row, 0).unwrap_or(f64::NAN);
    let line = |row: usize| {
        let ends = [value(&first, row), value(&end, row)];
        StockLine { ends, slope: (ends[1] - ends[0]) / (one.stock[last] - one.stock[0]) }
    };
    let lines: Vec<StockLine> = (0..first.rows()).map(line).collect();
    let of = |(row, line): (usize, &StockLine)| {
        if line.slope.is_nan() {
            let error = first.error(row, 0).or(end.error(row, 0)).cloned();
            return Choice::Failed(error.unwrap_or(EvaluationError::NotFinite { value: f64::NAN }));
        }
        let met = one.stock[0] + (one.target - line.ends[0]) / line.slope;
        let above = if met.is_finite() { one.stock.partition_point(|&value| value < met) } else { 0 };
        let mut best = Best::NONE;
        // The values on both sides of the one that meets the target, and one more on each side for the margin.
        for place in above.saturating_sub(2)..=(above + 1).min(last) {
            best.consider(place, (line.at(one, place) - one.target).abs());
        }
        best.choice()
    };
    let choices = lines.iter().enumerate().map(of).collect();
    Some((choices, lines))
}

/// Compares the answers at the chosen values with the lines. A choice by a line that the answer is off is none.
fn tested(trials: &mut Trials<'_, '_>, mut choices: Vec<Choice>, lines: &[StockLine]) -> Option<Vec<Choice>> {
    let one = trials.one;
    let answers = trials.at(|row| choices[row].place().unwrap_or(0))?;
    let output = &trials.function.signature().outputs[one.to].name;
    for (row, (choice, line)) in choices.iter_mut().zip(lines).enumerate() {
        let Some(place) = choice.place() else { continue };
        let Some(value) = answers.value(row, 0) else {
            let error = answers.error(row, 0).cloned();
            *choice = Choice::Failed(error.unwrap_or(EvaluationError::NotFinite { value: f64::NAN }));
            continue;
        };
        let off = (value - line.at(one, place)).abs();
        if off > line.allowed(one, place) {
            let chosen = one.stock[place];
            let message = format!(
                "`{output}` is not linear over the stock: at {chosen} it is {off:.2e} off the line through both ends. Leave `response` out"
            );
            *choice = Choice::Failed(EvaluationError::Refused { message });
        }
    }
    Some(choices)
}

/// Bisects the stock between the values on both sides of the target.
fn bisected(trials: &mut Trials<'_, '_>) -> Option<Vec<Choice>> {
    let one = trials.one;
    let last = one.stock.len() - 1;
    let [first, end] = [trials.at(|_| 0)?, trials.at(|_| last)?];
    let rows = first.rows();
    let mut failed: Vec<Option<EvaluationError>> = vec![None; rows];
    // Places on both sides of the target with the output's values there.
    let mut sides: Vec<[(usize, f64); 2]> = Vec::with_capacity(rows);
    for (row, failed) in failed.iter_mut().enumerate() {
        *failed = first.error(row, 0).or(end.error(row, 0)).cloned();
        let value = |of: &Responses| of.value(row, 0).unwrap_or(f64::NAN);
        sides.push([(0, value(&first)), (last, value(&end))]);
    }
    let rises: Vec<bool> = sides.iter().map(|[low, high]| low.1 <= high.1).collect();
    while sides.iter().any(|[low, high]| high.0 - low.0 > 1) {
        let middle: Vec<usize> = sides.iter().map(|[low, high]| low.0 + (high.0 - low.0) / 2).collect();
        let answers = trials.at(|row| middle[row])?;
        for (row, ends) in sides.iter_mut().enumerate().filter(|(_, [low, high])| high.0 - low.0 > 1) {
            let value = answers.value(row, 0).unwrap_or(f64::NAN);
            failed[row] = failed[row].take().or_else(|| answers.error(row, 0).cloned());
            let beyond = if rises[row] { value > one.target } else { value < one.target };
            ends[usize::from(beyond)] = (middle[row], value);
        }
    }
    let of = |(ends, failed): ([(usize, f64); 2], Option<EvaluationError>)| {
        if let Some(error) = failed {
            return Choice::Failed(error);
        }
        let mut best = Best::NONE;
        ends.iter().for_each(|&(place, value)| best.consider(place, (value - one.target).abs()));
        best.choice()
    };
    Some(sides.into_iter().zip(failed).map(of).collect())
}
