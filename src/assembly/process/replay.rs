//! Points again, by walks of small steps in a fresh child: whether an answer depends on what was asked before it.
//!
//! A solver that starts from its last solution flips on a long way and stays in the wrong branch until the next long way; sentinels
//! see only every second flip. A fresh child that goes from the nominal point in small steps has no long way. Where its answer differs
//! from the first one, a third child goes another way, one dimension after the other: two answers that agree are taken, three
//! different ones are none. After any difference every point of the batch is walked to.

use super::error::{ProcessError, ProcessFault, StderrTail};
use super::pool::Pool;
use super::sentinel::agree;
use super::suspicion::moved;
use crate::assembly::{EvaluationError, NonRepeatable, Points, Responses, Run};

/// Equal steps of a walk.
const STEPS: usize = 3;
/// Noise of the model, times this, is no difference.
const NOISY: f64 = 10.0;
/// Differences of the nominal point up to this part of the spread count as noise.
const NOISE: f64 = 1e-3;

/// The way from the nominal point to another one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Route {
    /// All dimensions at once.
    Straight,
    /// One dimension after the other.
    AxisByAxis,
}

impl Route {
    /// The points on the way, the last one included.
    fn points(self, from: &[f64], to: &[f64]) -> Vec<Vec<f64>> {
        let part = |start: &[f64], end: &[f64], step: usize, steps: usize| -> Vec<f64> {
            let between =
                |(&a, &b): (&f64, &f64)| if step == steps { b } else { a + (b - a) * step as f64 / steps as f64 };
            start.iter().zip(end).map(between).collect()
        };
        match self {
            _ if from == to => vec![to.to_vec()],
            Self::Straight => (1..=STEPS).map(|step| part(from, to, step, STEPS)).collect(),
            Self::AxisByAxis => {
                let moved = moved(from, to);
                // A single dimension has no other way: it is gone in smaller steps.
                let steps = if moved.len() == 1 { 2 * STEPS - 1 } else { STEPS.div_ceil(moved.len().max(1)).max(2) };
                let mut at = from.to_vec();
                let mut way = Vec::new();
                for d in moved.into_iter().rev() {
                    let mut next = at.clone();
                    next[d] = to[d];
                    way.extend((1..=steps).map(|step| part(&at, &next, step, steps)));
                    at = next;
                }
                way
            }
        }
    }
}

/// Values of one point, None where it has none.
type Values = Vec<Option<f64>>;

/// What came of one walk.
#[derive(Debug, Clone, PartialEq)]
enum Walked {
    /// A stop came before its end.
    Stopped,
    /// The process did not get there: it crashed, was too slow, or cannot be started any more. That says nothing of the answer.
    Lost,
    /// The nominal point was not as it should be when the walk began: the end does not count.
    Astray,
    /// The answers at its end.
    There(Values),
}

impl Walked {
    fn values(&self) -> Option<&Values> {
        match self {
            Self::There(values) => Some(values),
            _ => None,
        }
    }
}

/// Replays that differ, in three ways each, after which no more is tried: the model has another answer every time.
const HOPELESS: usize = 3;

impl Pool {
    /// Replays some answers of a batch, and all of them where one of these differs. Returns the rows whose answers were changed
    /// or taken away; None where a stop came before the end.
    pub(super) fn confirm(&mut self, points: &Points, out: &mut Responses, run: &Run<'_>) -> Option<Vec<usize>> {
        if !self.settings.sentinels || self.settings.verify == Some(0) {
            return Some(Vec::new());
        }
        let rows: Vec<Vec<f64>> = (0..points.rows()).map(|row| points.row(row)).collect();
        let values = |row: usize| (0..out.outputs()).map(|output| out.value(row, output)).collect();
        let all: Vec<Values> = (0..rows.len()).map(values).collect();
        let nominal = self.hello.nominal.clone();
        self.answers.learn(&rows, &all, &nominal);
        let mut chosen = self.answers.choose(&rows, &all, &nominal, self.settings.verify);
        if self.flips {
            chosen = (0..rows.len()).filter(|&row| all[row].iter().any(Option::is_some)).collect();
        }
        if self.hopeless {
            self.give_up(&chosen, &rows, &all, out);
            return Some(chosen);
        }
        if chosen.is_empty() {
            return Some(Vec::new());
        }
        match self.replayed(&rows, &all, &chosen, out, run) {
            // A stop came after a flip was found and before everything was confirmed.
            None if self.flips => {
                self.give_up(&(0..rows.len()).collect::<Vec<_>>(), &rows, &all, out);
                Some((0..rows.len()).collect())
            }
            changed => changed,
        }
    }

    /// Replays these rows, and where one differs all others.
    fn replayed(
        &mut self,
        rows: &[Vec<f64>],
        all: &[Values],
        chosen: &[usize],
        out: &mut Responses,
        run: &Run<'_>,
    ) -> Option<Vec<usize>> {
        let place = |rows_of: &[usize]| -> Vec<Vec<f64>> { rows_of.iter().map(|&row| rows[row].clone()).collect() };
        let first = self.walk(&place(chosen), Route::Straight, out, run)?;
        let suspicious = self.differing(chosen, &first, all);
        // What a process does not get to in small steps is no sign of a flip.
        if !suspicious.iter().any(|(_, walked)| walked.is_some()) {
            return Some(Vec::new());
        }
        self.flips = true;
        let mut changed = Vec::new();
        let unsettled = self.settle(rows, all, suspicious, out, run, &mut changed)?;
        let rest: Vec<usize> =
            (0..rows.len()).filter(|row| !chosen.contains(row) && all[*row].iter().any(Option::is_some)).collect();
        if unsettled >= HOPELESS && unsettled == changed.len() {
            self.hopeless = true;
            self.give_up(&rest, rows, all, out);
            changed.extend(rest);
            return Some(changed);
        }
        // Every other point as well: an even number of flips hides.
        let more = self.walk(&place(&rest), Route::Straight, out, run)?;
        let suspicious = self.differing(&rest, &more, all);
        self.settle(rows, all, suspicious, out, run, &mut changed)?;
        Some(changed)
    }

    /// Takes away the answers to rows: the model has another one every time.
    fn give_up(&mut self, of: &[usize], rows: &[Vec<f64>], all: &[Values], out: &mut Responses) {
        for &row in of {
            let nothing = vec![None; all[row].len()];
            self.replace(row, &rows[row], &all[row], &nothing, &nothing, out);
        }
    }

    /// The rows whose walk ended elsewhere than they were answered; None for a walk without an end.
    fn differing(&self, of: &[usize], walked: &[Walked], all: &[Values]) -> Vec<(usize, Option<Values>)> {
        let differs = |(&row, walked): (&usize, &Walked)| match walked.values() {
            Some(values) if self.alike(&all[row], values) => None,
            other => Some((row, other.cloned())),
        };
        of.iter().zip(walked).filter_map(differs).collect()
    }

    /// Goes another way to rows whose replay differs: two ways that agree settle the answer, otherwise there is none. Returns how many
    /// have none; None where a stop came before the end.
    fn settle(
        &mut self,
        rows: &[Vec<f64>],
        all: &[Values],
        suspicious: Vec<(usize, Option<Values>)>,
        out: &mut Responses,
        run: &Run<'_>,
        changed: &mut Vec<usize>,
    ) -> Option<usize> {
        let targets: Vec<Vec<f64>> = suspicious.iter().map(|(row, _)| rows[*row].clone()).collect();
        let other = self.walk(&targets, Route::AxisByAxis, out, run)?;
        let mut unsettled = 0;
        for ((row, walked), other) in suspicious.into_iter().zip(other) {
            let nothing = vec![None; all[row].len()];
            let (walked, other) = (walked.as_ref().unwrap_or(&nothing), other.values().unwrap_or(&nothing));
            unsettled += usize::from(self.replace(row, &rows[row], &all[row], walked, other, out));
            changed.push(row);
        }
        Some(unsettled)
    }

    /// Takes the answer on which two ways agree, or none; whether it is none.
    fn replace(
        &mut self,
        row: usize,
        point: &[f64],
        before: &Values,
        walked: &Values,
        other: &Values,
        out: &mut Responses,
    ) -> bool {
        let mut unsettled = false;
        for output in 0..before.len() {
            let (first, second, third) = (before[output], walked[output], other[output]);
            if first.is_none() || self.alike_at(output, first, second) {
                continue;
            }
            let spread = self.reference.spread(output);
            let name = self.hello.characteristics[output].clone();
            out.note_non_repeatable([NonRepeatable::new(name, [second, first], spread, vec![point.to_vec()])]);
            match second.filter(|_| self.alike_at(output, second, third)) {
                Some(value) => out.set(row, output, value),
                None => {
                    unsettled = true;
                    let fault = ProcessFault::TwoAnswers { first, second, third };
                    out.fail(row, output, Box::new(ProcessError { fault, stderr: StderrTail::default() }).into());
                }
            }
        }
        unsettled
    }

    fn alike(&self, a: &Values, b: &Values) -> bool {
        a.iter().zip(b).enumerate().all(|(output, (&a, &b))| self.alike_at(output, a, b))
    }

    fn alike_at(&self, output: usize, a: Option<f64>, b: Option<f64>) -> bool {
        let noise = self.noise.get(output).copied().unwrap_or(0.0);
        agree(a, b, self.reference.spread(output), NOISY * noise)
    }

    /// The answers at these points, each reached from the nominal one by a child that went no long way before; None where a stop
    /// came before the end.
    fn walk(&mut self, targets: &[Vec<f64>], route: Route, out: &mut Responses, run: &Run<'_>) -> Option<Vec<Walked>> {
        let mut found: Vec<Walked> = Vec::new();
        let mut truth: Option<Values> = None;
        while found.len() < targets.len() {
            // The way back to the nominal point is a long one: a child that it leads astray is replaced.
            self.renew();
            let begun = found.len();
            while found.len() < targets.len() {
                match self.walk_to(&targets[found.len()], route, &mut truth, out, run) {
                    Walked::Stopped => return None,
                    Walked::Astray if found.len() > begun => break,
                    walked => {
                        let lost = walked == Walked::Lost;
                        found.push(walked);
                        if lost {
                            break;
                        }
                    }
                }
            }
            if truth.is_none() {
                // No process can be had any more.
                found.resize(targets.len(), Walked::Lost);
            }
        }
        Some(found)
    }

    /// One walk in the child that there is.
    fn walk_to(
        &mut self,
        target: &[f64],
        route: Route,
        truth: &mut Option<Values>,
        out: &mut Responses,
        run: &Run<'_>,
    ) -> Walked {
        let mut way = vec![self.hello.nominal.clone()];
        way.extend(route.points(&way[0], target));
        let answers = match self.one_by_one(&way, out, run) {
            Ok(answers) => answers,
            Err(walked) => return walked,
        };
        match truth {
            Some(truth) => {
                if !self.settles(truth, &answers[0]) {
                    return Walked::Astray;
                }
            }
            None => {
                // A fresh child knows nothing but the way from its start: this is what the nominal point has.
                self.reference.trust(&answers[0]);
                *truth = Some(answers[0].clone());
            }
        }
        answers.last().map_or(Walked::Lost, |values| Walked::There(values.clone()))
    }

    /// Whether a nominal point is as before; small differences are noted as noise.
    fn settles(&mut self, expected: &Values, found: &Values) -> bool {
        self.noise.resize(expected.len(), 0.0);
        let mut same = true;
        for (output, (a, b)) in expected.iter().zip(found).enumerate() {
            match (a, b) {
                (Some(a), Some(b)) if (a - b).abs() <= NOISE * self.reference.spread(output) => {
                    self.noise[output] = self.noise[output].max((a - b).abs());
                }
                (None, None) => {}
                (Some(a), Some(b)) if a == b => {}
                _ => same = false,
            }
        }
        same
    }

    /// Answers to points in this order, one at a time, by one child.
    fn one_by_one(&mut self, way: &[Vec<f64>], out: &mut Responses, run: &Run<'_>) -> Result<Vec<Values>, Walked> {
        let mut answers = Responses::open(way.len(), out.outputs());
        let (stopped, abandoned) = (|| run.stop_reason(), || run.abandoned());
        let quiet = Run::to_the_end().stopping_when(&stopped).abandoning_when(&abandoned);
        self.walking = true;
        self.evaluate(&Points::from_rows(way), &quiet, &mut answers);
        self.walking = false;
        let answered = |row: &usize| (0..answers.outputs()).any(|output| !answers.is_open(*row, output));
        let sent = (0..way.len()).filter(answered).count();
        out.spent(sent as i64 + answers.extra());
        if sent < way.len() {
            return Err(Walked::Stopped);
        }
        let lost = |error: &EvaluationError| match error {
            EvaluationError::Process(error) => !matches!(error.fault, ProcessFault::NoValue { .. }),
            _ => true,
        };
        if answers.errors().any(|(.., error)| lost(error)) {
            return Err(Walked::Lost);
        }
        let values = |row: usize| (0..answers.outputs()).map(|output| answers.value(row, output)).collect();
        Ok((0..way.len()).map(values).collect())
    }
}
