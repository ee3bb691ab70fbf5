//! Replays points by walks of small steps in a fresh child, to find answers that depend on the points before them.
//!
//! A solver that starts from its last solution may flip on a long step, and stays in the wrong branch until the next long step. Sentinels
//! detect only every second flip. A fresh child that walks from the nominal point in small steps makes no long step. If its answer differs
//! from the first one, a third child takes another route, one dimension after the other. Two answers that agree are taken. Three different
//! ones count as none. After any difference, every point of the batch is replayed.

use super::pool::Pool;
use super::sentinel::{FLIP, Values, agree};
use super::walk::{Route, Walked};
use sensitol::assembly::{NonRepeatable, Points, Responses, Run};
use sensitol::assembly::{ProcessError, ProcessFault, StderrTail};

/// Factor on the noise of the model, up to which a difference counts as noise.
const NOISY: f64 = 10.0;

/// Number of replays that differ on every route, after which no more are tried: the model gives another answer every time.
const HOPELESS: usize = 3;

/// Result of the check of a batch by replays.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Confirmation {
    /// Rows whose answers were changed or removed.
    pub(super) changed: Vec<usize>,
    /// Number of rows whose check a stop cut off.
    pub(super) unchecked: usize,
}

impl Pool {
    /// Replays some answers of a batch, and all of them if one differs. Answers of a batch that was stopped are not confirmed. They are
    /// removed if the model is known to flip.
    pub(super) fn confirm(&mut self, points: &Points, out: &mut Responses, run: &Run<'_>) -> Confirmation {
        if !self.settings.replays() {
            return Confirmation::default();
        }
        let rows: Vec<Vec<f64>> = (0..points.rows()).map(|row| points.row(row)).collect();
        let values = |row: usize| (0..out.outputs()).map(|output| out.value(row, output)).collect();
        let all: Vec<Values> = (0..rows.len()).map(values).collect();
        let nominal = self.hello.nominal.clone();
        self.answers.learn(&rows, &all, &nominal);
        let mut chosen = self.answers.choose(&rows, &all, &nominal, self.settings.verify);
        let known: Vec<usize> = (0..rows.len()).filter(|&row| all[row].iter().any(Option::is_some)).collect();
        let stopped = run.stopped() || run.abandoned();
        if self.flips() && (self.hopeless || stopped) {
            self.give_up(&known, &rows, &all, out);
            return Confirmation { unchecked: if stopped { known.len() } else { 0 }, changed: known };
        }
        if self.flips() {
            // All rows will be replayed. A few come first, which suffice to recognise a model that never repeats itself.
            let more: Vec<usize> = known.iter().copied().filter(|row| !chosen.contains(row)).collect();
            chosen.extend(more.into_iter().take((2 * HOPELESS).saturating_sub(chosen.len())));
        }
        if chosen.is_empty() {
            return Confirmation::default();
        }
        let replayed = if stopped { None } else { self.replayed(&rows, &all, &chosen, out, run) };
        let confirmation = match replayed {
            Some(changed) => Confirmation { changed, unchecked: 0 },
            // A stop came after a flip was found and before everything was confirmed.
            None if self.flips() => {
                self.give_up(&known, &rows, &all, out);
                Confirmation { unchecked: known.len(), changed: known }
            }
            None => {
                let open = |row: &&usize| rows[**row] != nominal && !self.answers.is_confirmed(&rows[**row]);
                let unchecked = known.iter().filter(open).count();
                self.account.counts.unconfirmed += unchecked as u64;
                Confirmation { changed: Vec::new(), unchecked }
            }
        };
        if self.flips() {
            self.look_back(&rows, out, run);
        }
        confirmation
    }

    /// Replays the answers of earlier batches after a flip is found. Results may have been computed from them, so one that differs or is
    /// not reached counts as unconfirmed.
    fn look_back(&mut self, batch: &[Vec<f64>], out: &mut Responses, run: &Run<'_>) {
        let (earlier, forgotten) = self.answers.unconfirmed(batch);
        self.account.counts.unconfirmed += forgotten as u64;
        if earlier.is_empty() {
            return;
        }
        let (points, values): (Vec<Vec<f64>>, Vec<Values>) = earlier.into_iter().unzip();
        let walked = if self.hopeless { None } else { self.walk(&points, Route::Straight, out, run) };
        for (row, point) in points.iter().enumerate() {
            let found = walked.as_ref().and_then(|walked| walked[row].values());
            if found.is_some_and(|found| self.alike(&values[row], found)) {
                self.answers.confirm(point);
                continue;
            }
            self.account.counts.unconfirmed += 1;
            let nothing = vec![None; values[row].len()];
            let found = found.unwrap_or(&nothing);
            for output in 0..nothing.len() {
                if !self.alike_at(output, values[row][output], found[output]) {
                    let (name, spread) = (self.hello.characteristics[output].clone(), self.reference.spread(output));
                    let differ = [found[output], values[row][output]];
                    out.note_non_repeatable([NonRepeatable::new(name, differ, spread, vec![point.clone()])]);
                }
            }
            out.revoke(point.clone());
            self.answers.confirm(point);
        }
    }

    /// Values of the nominal point, and true if they agree with the kept ones. A model that does not repeat itself is evaluated three times
    /// and may differ by its noise. Returns None if a stop came first.
    pub(super) fn is_as_kept(
        &mut self,
        kept: Option<&[Option<f64>]>,
        out: &mut Responses,
        run: &Run<'_>,
    ) -> Option<(bool, Values)> {
        let nominal = self.hello.nominal.clone();
        let first = self.asked_once(&nominal, out, run)?;
        let Some(kept) = kept.map(<[Option<f64>]>::to_vec).filter(|kept| !self.alike(kept, &first)) else {
            return Some((true, first));
        };
        let more = [self.asked_once(&nominal, out, run)?, self.asked_once(&nominal, out, run)?];
        let near = |output: usize| {
            let all = (kept[output], first[output], more[0][output], more[1][output]);
            let (Some(kept), Some(a), Some(b), Some(c)) = all else {
                return kept[output].is_none() && first[output].is_none();
            };
            let noise = a.max(b).max(c) - a.min(b).min(c);
            let allowed = (NOISY * noise).max(if noise > 0.0 { FLIP * self.reference.spread(output) } else { 0.0 });
            self.alike_at(output, Some(kept), Some(a)) || (kept - a).abs() <= allowed
        };
        Some(((0..kept.len()).all(near), first))
    }

    /// Answer to one point. Returns None if a stop came first.
    fn asked_once(&mut self, point: &[f64], out: &mut Responses, run: &Run<'_>) -> Option<Values> {
        let mut answers = Responses::open(1, out.outputs());
        let (stopped, abandoned) = (|| run.stop_reason(), || run.abandoned());
        let quiet = Run::to_the_end().stopping_when(&stopped).abandoning_when(&abandoned);
        self.evaluate(&Points::from_rows(&[point]), &quiet, &mut answers);
        out.spent(answers.extra());
        if (0..answers.outputs()).all(|output| answers.is_open(0, output)) {
            return None;
        }
        out.spent(1);
        Some((0..answers.outputs()).map(|output| answers.value(0, output)).collect())
    }

    /// Adds answers of an earlier run, with which later ones are compared. That run confirmed each of them, or the usual part.
    pub(super) fn remember(&mut self, points: &[Vec<f64>], values: &[Values], each_confirmed: bool) {
        values.iter().for_each(|values| self.reference.learn(values));
        if values.iter().flatten().any(Option::is_some) {
            self.futility.note_value();
        }
        self.answers.remember(points, values, &self.hello.nominal, each_confirmed);
    }

    /// Replays these rows, and all others if one of them differs.
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
        self.confirm_others(chosen, &suspicious, rows);
        // A point that a process does not reach in small steps is no sign of a flip.
        if !self.flips() && !suspicious.iter().any(|(_, walked)| walked.is_some()) {
            return Some(Vec::new());
        }
        self.set_flips();
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
        // All other points are replayed too, since an even number of flips does not show.
        let more = self.walk(&place(&rest), Route::Straight, out, run)?;
        let suspicious = self.differing(&rest, &more, all);
        self.confirm_others(&rest, &suspicious, rows);
        self.settle(rows, all, suspicious, out, run, &mut changed)?;
        Some(changed)
    }

    /// Confirms the rows that are not among those that differ.
    fn confirm_others(&mut self, of: &[usize], differing: &[(usize, Option<Values>)], rows: &[Vec<f64>]) {
        for &row in of.iter().filter(|row| !differing.iter().any(|(other, _)| other == *row)) {
            self.answers.confirm(&rows[row]);
        }
    }

    /// Removes the answers to rows, since the model gives another one every time.
    fn give_up(&mut self, of: &[usize], rows: &[Vec<f64>], all: &[Values], out: &mut Responses) {
        for &row in of {
            let nothing = vec![None; all[row].len()];
            self.replace(row, &rows[row], &all[row], &nothing, &nothing, out);
        }
    }

    /// Rows whose walk ended with other values than their answer; None for a walk without an end.
    fn differing(&self, of: &[usize], walked: &[Walked], all: &[Values]) -> Vec<(usize, Option<Values>)> {
        let differs = |(&row, walked): (&usize, &Walked)| match walked.values() {
            Some(values) if self.alike(&all[row], values) => None,
            other => Some((row, other.cloned())),
        };
        of.iter().zip(walked).filter_map(differs).collect()
    }

    /// Takes another route to rows whose replay differs. Two routes that agree determine the answer, otherwise there is none. Returns the
    /// number of rows without an answer. Returns None if a stop came before the end.
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

    /// Stores the answer on which two routes agree, or none. Returns true if there is none.
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
        // The stored value is confirmed, or known to be none.
        self.answers.confirm(point);
        self.account.counts.unconfirmed += u64::from(unsettled);
        unsettled
    }

    fn alike(&self, a: &Values, b: &Values) -> bool {
        a.iter().zip(b).enumerate().all(|(output, (&a, &b))| self.alike_at(output, a, b))
    }

    fn alike_at(&self, output: usize, a: Option<f64>, b: Option<f64>) -> bool {
        let noise = self.noise.get(output).copied().unwrap_or(0.0);
        agree(a, b, self.reference.spread(output), NOISY * noise)
    }
}
