//! Assembly function in several states: each output once in every state.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

use crate::assembly::evaluator_account::EvaluatorAccount;
use crate::assembly::request::bits;
use crate::assembly::{
    AssemblyFunction, Bounds, Derivatives, Directions, EvaluationError, ModelInfo, NonRepeatable, Output, Points,
    Polynomial, RecordedFailure, Request, Responses, Run, Signature, Switches,
};
use crate::warning::Warning;

/// State: a function, and the offset of every input from the first state.
pub(crate) struct State {
    pub(crate) name: String,
    pub(crate) function: Arc<dyn AssemblyFunction>,
    pub(crate) moved: Vec<f64>,
    /// Requested outputs of the function.
    pub(crate) outputs: Vec<usize>,
    /// Points at which a costly function was evaluated, by the bits of the shifted point.
    asked: Mutex<HashMap<Vec<u64>, Vec<f64>>>,
}

/// Outputs of every state in turn, named `output [state]`, as functions of the inputs of the first state.
pub(crate) struct States {
    signature: Signature,
    states: Vec<State>,
    /// State of every output, and its index among the outputs of that state.
    places: Vec<(usize, usize)>,
}

impl States {
    pub(crate) fn new(states: Vec<State>) -> Self {
        let of_first = states.first().map(|state| state.function.signature().clone()).unwrap_or_default();
        let (mut outputs, mut places) = (Vec::new(), Vec::new());
        for (s, state) in states.iter().enumerate() {
            for &output in &state.outputs {
                let known: &Output = &state.function.signature().outputs[output];
                outputs.push(Output { name: Self::name(&known.name, &state.name), ..known.clone() });
                places.push((s, output));
            }
        }
        let all = |of: fn(&Signature) -> bool| states.iter().all(|state| of(state.function.signature()));
        let costly = !all(|signature| !signature.costly);
        let signature = Signature { outputs, costly, cheap: all(|signature| signature.cheap), ..of_first };
        Self { signature, states, places }
    }

    /// Returns the name of an output in a state.
    pub(crate) fn name(output: &str, state: &str) -> String {
        format!("{output} [{state}]")
    }

    /// Returns the states that have some of these outputs, each with the places among them and its own outputs.
    fn by_state(&self, outputs: &[usize]) -> impl Iterator<Item = (&State, Vec<usize>, Vec<usize>)> {
        let of = |(s, state)| {
            let own = outputs.iter().enumerate().filter(|&(_, &output)| self.places[output].0 == s);
            let (asked, own): (Vec<usize>, Vec<usize>) =
                own.map(|(place, &output)| (place, self.places[output].1)).unzip();
            (state, asked, own)
        };
        let all: Vec<_> = self.states.iter().enumerate().map(of).filter(|(_, asked, _)| !asked.is_empty()).collect();
        all.into_iter()
    }

    fn of(&self, output: usize) -> (&State, usize) {
        let (state, own) = self.places[output];
        (&self.states[state], own)
    }
}

impl State {
    pub(crate) fn new(name: &str, function: Arc<dyn AssemblyFunction>, moved: Vec<f64>, outputs: Vec<usize>) -> Self {
        Self { name: name.to_owned(), function, moved, outputs, asked: Mutex::default() }
    }

    fn remember(&self, points: &Points, of: &Points) {
        let mut asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        for row in 0..points.rows() {
            asked.entry(bits(&points.row(row))).or_insert_with(|| of.row(row));
        }
    }

    /// Returns the point of the first state at which this point was evaluated.
    fn asked_for(&self, point: &[f64]) -> Vec<f64> {
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        asked.get(&bits(point)).cloned().unwrap_or_else(|| point.to_vec())
    }

    /// Returns the point of the first state for a point of this one. A point that was asked is returned without rounding.
    fn unshifted(&self, point: &[Option<f64>]) -> Vec<Option<f64>> {
        let asked = self.asked.lock().unwrap_or_else(PoisonError::into_inner);
        let known = point.iter().copied().collect::<Option<Vec<f64>>>().and_then(|point| asked.get(&bits(&point)));
        match known {
            Some(known) => known.iter().copied().map(Some).collect(),
            None => point.iter().zip(&self.moved).map(|(x, by)| Some((*x)? - by)).collect(),
        }
    }

    fn points(&self, points: &Points) -> Points {
        Points::written(points.rows(), points.dimensions(), |d, column| {
            column.iter_mut().zip(points.column(d)).for_each(|(to, from)| *to = from + self.moved[d]);
        })
    }
}

impl States {
    /// Returns derivatives of outputs. `derivatives` gives those of a state at its shifted point.
    fn derivatives_of(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        derivatives: impl Fn(&State, &[usize], &Directions<'_>) -> Vec<Option<Derivatives>>,
    ) -> Vec<Option<Derivatives>> {
        let mut all = vec![None; outputs.len()];
        for (state, asked, own) in self.by_state(outputs) {
            let point: Vec<f64> = directions.point.iter().zip(&state.moved).map(|(x, by)| x + by).collect();
            let found = derivatives(state, &own, &Directions { point: &point, ..*directions });
            asked.into_iter().zip(found).for_each(|(place, found)| all[place] = found);
        }
        all
    }
}

impl AssemblyFunction for States {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let mut info = None;
        for (state, _, own) in self.by_state(outputs) {
            info = state.function.prepare(&own)?.or(info);
        }
        Ok(info)
    }

    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        let (state, own) = self.of(output);
        let moved: Vec<[f64; 2]> = region.iter().zip(&state.moved).map(|(ends, by)| ends.map(|end| end + by)).collect();
        state.function.bounds(own, &moved)
    }

    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        let mut found = vec![None; outputs.len()];
        for (state, asked, own) in self.by_state(outputs) {
            let moved: Vec<f64> = point.iter().zip(&state.moved).map(|(x, by)| x + by).collect();
            let magnitudes = state.function.magnitudes(&own, &moved);
            asked.into_iter().zip(magnitudes).for_each(|(place, magnitude)| found[place] = magnitude);
        }
        found
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let mut spent = 0;
        for (state, asked, own) in self.by_state(request.outputs) {
            let points = state.points(request.points);
            let mut answers = Responses::open(points.rows(), own.len());
            if self.signature.costly {
                state.remember(&points, request.points);
            }
            state.function.evaluate(&Request::values(&points, &own), run, &mut answers);
            spent += answers.answered().count() as i64 + answers.extra() + answers.count_reused() as i64;
            out.reused(answers.count_reused());
            out.retried(answers.count_retried());
            out.leave_unchecked(answers.count_unchecked());
            out.note_non_repeatable(answers.non_repeatable().iter().map(|doubt| NonRepeatable {
                suspects: doubt.suspects.iter().map(|point| state.asked_for(point)).collect(),
                ..doubt.clone()
            }));
            answers.revoked().iter().for_each(|point| out.revoke(state.asked_for(point)));
            for (column, &place) in asked.iter().enumerate() {
                for row in 0..points.rows() {
                    match (answers.value(row, column), answers.error(row, column)) {
                        (Some(value), _) => out.set(row, place, value),
                        (None, Some(error)) => out.fail(row, place, error.clone()),
                        (None, None) => {}
                    }
                }
            }
        }
        // A point of a costly model is one evaluation in every state. The states of a cheap one count as one evaluation.
        if self.signature.costly {
            out.spent(spent - out.answered().count() as i64);
        }
    }

    fn account(&self) -> Option<EvaluatorAccount> {
        self.states.iter().filter_map(|state| state.function.account()).reduce(EvaluatorAccount::and)
    }

    fn own_checks(&self, answers: usize) -> usize {
        self.states.iter().map(|state| state.function.own_checks(answers)).sum()
    }

    fn evaluations_per_point(&self, outputs: &[usize]) -> usize {
        self.by_state(outputs).map(|(state, _, own)| state.function.evaluations_per_point(&own)).max().unwrap_or(1)
    }

    fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
        let mut all = Vec::new();
        for (state, asked, own) in self.by_state(outputs) {
            // The journal holds the shifted point of the state.
            all.extend(state.function.recorded_failures(&own).into_iter().filter_map(|failure| {
                let place = own.iter().position(|&output| output == failure.output)?;
                Some(RecordedFailure { output: outputs[asked[place]], point: state.unshifted(&failure.point) })
            }));
        }
        all
    }

    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        self.derivatives_of(outputs, directions, |state, own, there| state.function.derivatives(own, there))
    }

    fn derivatives_per(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: &[i32],
    ) -> Vec<Option<Derivatives>> {
        self.derivatives_of(outputs, directions, |state, own, there| {
            state.function.derivatives_per(own, there, exponents)
        })
    }

    fn switches(&self, output: usize) -> Option<Switches> {
        let (state, own) = self.of(output);
        state.function.switches(own)
    }

    fn choice(&self, output: usize) -> Option<String> {
        let (state, own) = self.of(output);
        state.function.choice(own)
    }

    fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        let (state, own) = self.of(output);
        state.function.margins(own, &state.points(points))
    }

    fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
        let (state, own) = self.of(output);
        state.function.degree(own, varying)
    }

    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        let (state, own) = self.of(output);
        let centre: Vec<f64> = centre.iter().zip(&state.moved).map(|(x, by)| x + by).collect();
        state.function.polynomial(own, &centre, scale)
    }

    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        let mut all: Vec<Warning> = Vec::new();
        for (state, _, own) in self.by_state(outputs) {
            let more = state.function.warnings(&own).into_iter().filter(|one| !all.contains(one)).collect::<Vec<_>>();
            all.extend(more);
        }
        all
    }
}
