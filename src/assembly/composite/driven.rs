//! Inputs that a model receives: dimensions, fixed values, and formulas that drive it.
//!
//! With dimensions `x` and formulas `z(x)` a characteristic is `y(x) = F(z(x))`. By the chain rule `dy/dx = F_z z_x`, where `z_x` is exact.

use std::collections::HashMap;
use std::sync::{Arc, Mutex, OnceLock};

use crate::assembly::blocks::BLOCK;
use crate::assembly::composite::{Composite, CompositeError, Inner, Origin, Source};
use crate::assembly::formula::Jet;
use crate::assembly::implicit::RowSolution;
use crate::assembly::request::bits;
use crate::assembly::{
    AssemblyFunction, EvaluationError, Input, NonRepeatable, Points, Request, Responses, Run, Signature,
};

/// Values that a model receives at some points.
pub(super) struct Sent {
    /// Column for every input of the model, NaN if a formula has no value.
    pub(super) columns: Points,
    /// Error of every row that is not sent; empty if no formula can fail.
    errors: Vec<Option<EvaluationError>>,
}

impl Composite {
    /// Returns the formulas that drive the model, each once.
    pub(super) fn driving(&self) -> Vec<usize> {
        let mut driving: Vec<usize> = self.model.iter().flat_map(Inner::driving).collect();
        driving.sort_unstable();
        driving.dedup();
        driving
    }

    /// True if a formula needs the unknowns.
    pub(super) fn drives_by_unknowns(&self, formula: usize) -> bool {
        self.split(self.formulas.variables(formula)).unknowns
    }

    /// Checks that the formulas that drive the model do not need its answers.
    pub(super) fn drives_without_circle(&self, names: &[String]) -> Result<(), CompositeError> {
        for index in self.driving() {
            let mut needs = self.split(self.formulas.variables(index));
            if let (true, Some(assembler)) = (needs.unknowns, &self.assembler) {
                needs.answers.extend(self.split(assembler.uses()).answers);
            }
            if let (Some(&output), Some(model)) = (needs.answers.first(), &self.model) {
                let output = model.function.signature().outputs[output].name.clone();
                return Err(CompositeError::Driven { name: names[index].clone(), index, output });
            }
        }
        Ok(())
    }

    /// Returns the dimensions on which an input of the model depends.
    pub(super) fn behind(&self, source: Source) -> Vec<usize> {
        match source {
            Source::Dimension(dimension) => vec![dimension],
            Source::Fixed(_) => Vec::new(),
            Source::Formula(formula) => self.needs(Origin::Formula(formula)).dimensions,
        }
    }

    /// Returns the values that the model receives at these points.
    pub(super) fn sent(&self, points: &Points, run: &Run<'_>) -> Sent {
        let rows = points.rows();
        let driving = self.driving();
        let mut errors = vec![None; if driving.is_empty() { 0 } else { rows }];
        let Some(model) = &self.model else { return Sent { columns: Points::of_values(rows, 0, Vec::new()), errors } };
        let values = self.driven(&driving, points, run, &mut errors);
        let mut columns = Vec::with_capacity(rows * model.inputs.len());
        for source in &model.inputs {
            match *source {
                Source::Dimension(dimension) => columns.extend_from_slice(points.column(dimension)),
                Source::Fixed(value) => columns.resize(columns.len() + rows, value),
                Source::Formula(formula) => {
                    let place = driving.binary_search(&formula).expect("it drives the model");
                    columns.extend_from_slice(&values[place]);
                }
            }
        }
        let mut columns = Points::of_values(rows, model.inputs.len(), columns);
        for (input, factor) in model.factors[0].iter().enumerate().filter(|(_, factor)| **factor != 1.0) {
            columns.column_mut(input).iter_mut().for_each(|value| *value *= factor);
        }
        Sent { columns, errors }
    }

    /// Evaluates the formulas that drive the model, one column each. `errors` receives the failure of each row without a value.
    fn driven(
        &self,
        driving: &[usize],
        points: &Points,
        run: &Run<'_>,
        errors: &mut [Option<EvaluationError>],
    ) -> Vec<Vec<f64>> {
        let (rows, given) = (points.rows(), self.given());
        let mut values = vec![vec![f64::NAN; rows]; driving.len()];
        if driving.is_empty() {
            return values;
        }
        let mut unknowns = vec![vec![f64::NAN; rows]; self.assembler.as_ref().map_or(0, |of| of.len())];
        if let (Some(assembler), true) =
            (&self.assembler, driving.iter().any(|&formula| self.drives_by_unknowns(formula)))
        {
            match self.anchor(run).0 {
                Some(Ok(anchor)) => {
                    let variable = |index: usize, row: usize| points.column(index)[row];
                    let found = RowSolution::of((assembler, &self.formulas), &anchor, rows, given, variable);
                    let failed = found.errors.into_iter().map(|failure| failure.map(Into::into));
                    errors.iter_mut().zip(failed).for_each(|(error, failure)| *error = failure);
                    unknowns = found.columns;
                }
                Some(Err(error)) => errors.fill(Some(error)),
                None => {}
            }
        }
        let variable = |index: usize| match index.checked_sub(given) {
            None => points.column(index),
            Some(unknown) => &unknowns[unknown][..],
        };
        self.formulas.evaluate(driving, rows, variable, |position, row, value| {
            values[position][row] = value;
            if !value.is_finite() && errors[row].is_none() {
                let failure = self.formulas.explain(driving[position], |index| variable(index)[row]);
                errors[row] =
                    Some(failure.map_or(EvaluationError::NotFinite { value }, |failure| Box::new(failure).into()));
            }
        });
        values
    }

    /// Returns the model that formulas drive, and its outputs that these outputs need.
    pub(crate) fn inner(&self, outputs: &[usize]) -> Option<(Arc<dyn AssemblyFunction>, Vec<usize>)> {
        let needed = self.all_needs(&self.origins(outputs)).answers;
        Some((Arc::clone(&self.model.as_ref()?.function), needed))
    }

    /// Returns the values that the model would receive at these points, or None if a formula has no value at one of them.
    pub(crate) fn drivers(&self, points: &Points) -> Option<Points> {
        let Sent { columns, errors } = self.sent(points, &Run::to_the_end());
        errors.iter().all(Option::is_none).then_some(columns)
    }

    /// Replaces the model by another one with the same inputs and outputs, which costs no time. The formulas stay.
    pub(crate) fn about(&self, function: Arc<dyn AssemblyFunction>) -> Self {
        let inner = |model: &Inner| Inner {
            function,
            inputs: model.inputs.clone(),
            factors: model.factors.clone(),
            fixed: OnceLock::new(),
            sent: Mutex::default(),
        };
        Self {
            signature: Signature { costly: false, cheap: false, ..self.signature.clone() },
            formulas: Arc::clone(&self.formulas),
            named: self.named,
            model: self.model.as_ref().map(inner),
            assembler: self.assembler.clone(),
            outputs: self.outputs.clone(),
        }
    }

    /// Returns the names of the model's inputs and its values at these points, or None if it receives the points themselves.
    pub(super) fn model_points(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
        // A built-in model is part of this program, so nothing is sent.
        let model = self.model.as_ref().filter(|_| self.signature.costly)?;
        let same = |(index, source): (usize, &Source)| *source == Source::Dimension(index);
        if model.inputs.len() == points.dimensions() && model.inputs.iter().enumerate().all(same) {
            return None;
        }
        let Sent { columns, errors } = self.sent(points, &Run::to_the_end());
        let kept: Vec<Vec<f64>> = (0..columns.rows())
            .filter(|&row| errors.get(row).is_none_or(Option::is_none))
            .map(|row| columns.row(row))
            .collect();
        Some((model.function.signature().inputs.clone(), Points::from_rows(&kept)))
    }

    /// Evaluates these outputs of the model, in the units of the study.
    pub(super) fn ask_model(&self, points: &Points, run: &Run<'_>, needed: &[usize]) -> Responses {
        let mut answers = self.ask_as_it_is(points, run, needed);
        let factors = self.model.as_ref().map_or(&[][..], |model| &model.factors[1]);
        for (column, output) in needed.iter().enumerate() {
            if let Some(factor) = factors.get(*output).filter(|factor| **factor != 1.0) {
                answers.multiply(column, *factor);
            }
        }
        answers
    }

    /// Evaluates these outputs of the model, in its own units.
    fn ask_as_it_is(&self, points: &Points, run: &Run<'_>, needed: &[usize]) -> Responses {
        let rows = points.rows();
        let mut answers = Responses::open(rows, needed.len());
        let Some(model) = self.model.as_ref().filter(|_| !needed.is_empty()) else { return answers };
        if self.ask_in_place(model, points, run, needed, &mut answers) {
            return answers;
        }
        let Sent { columns, mut errors } = self.sent(points, run);
        let whole = model.function.signature().inputs.len() == points.dimensions();
        if errors.iter().all(Option::is_none) && (!self.signature.costly || whole && model.driving().next().is_none()) {
            model.function.evaluate(&Request::values(&columns, needed), run, &mut answers);
            return answers;
        }
        errors.resize(rows, None);
        // Points with the same inputs of the model are one evaluation.
        let mut place: HashMap<Vec<u64>, usize> = HashMap::new();
        let (mut distinct, mut rows_of): (Vec<Vec<f64>>, Vec<Option<usize>>) = (Vec::new(), Vec::with_capacity(rows));
        for (row, error) in errors.iter().enumerate() {
            rows_of.push(error.is_none().then(|| {
                let point = columns.row(row);
                *place.entry(bits(&point)).or_insert_with(|| {
                    distinct.push(point);
                    distinct.len() - 1
                })
            }));
        }
        let mut found = Responses::open(distinct.len(), needed.len());
        if !distinct.is_empty() {
            model.remember(&distinct, &rows_of, points);
            model.function.evaluate(&Request::values(&Points::from_rows(&distinct), needed), run, &mut found);
        }
        for (row, (error, from)) in errors.into_iter().zip(rows_of).enumerate() {
            for column in 0..needed.len() {
                match (&error, from) {
                    (Some(error), _) => answers.fail(row, column, error.clone()),
                    (None, Some(from)) => answers.pass_on(row, column, &found, from, column),
                    (None, None) => {}
                }
            }
        }
        // Counts evaluations of the model, not rows: rows that share a point, and rows without inputs, cost nothing.
        let unsent = answers.answered().count() as i64 - found.answered().count() as i64;
        answers.spent(found.extra() + found.count_reused() as i64 - unsent);
        answers.reused(found.count_reused());
        answers.retried(found.count_retried());
        answers.leave_unchecked(found.count_unchecked());
        answers.note_non_repeatable(found.non_repeatable().iter().map(|doubt| NonRepeatable {
            suspects: doubt.suspects.iter().map(|point| model.sent_for(point)).collect(),
            ..doubt.clone()
        }));
        found.revoked().iter().for_each(|point| answers.revoke(model.sent_for(point)));
        answers
    }

    /// Evaluates a model that accepts separate columns, without a copy. Returns false if the model is costly, if formulas drive it, or if a
    /// unit differs.
    pub(super) fn ask_in_place(
        &self,
        model: &Inner,
        points: &Points,
        run: &Run<'_>,
        needed: &[usize],
        answers: &mut Responses,
    ) -> bool {
        let formulas = model.driving().next().is_some();
        if self.signature.costly || formulas || model.factors[0].iter().any(|factor| *factor != 1.0) {
            return false;
        }
        let rows = points.rows();
        let of_more;
        let fixed = if rows > BLOCK {
            of_more = model.fixed(rows);
            &of_more
        } else {
            model.fixed.get_or_init(|| model.fixed(BLOCK))
        };
        let mut fixed = fixed.chunks(rows.max(BLOCK));
        let mut column = |source: &Source| match *source {
            Source::Dimension(dimension) => points.column(dimension),
            _ => &fixed.next().unwrap_or_default()[..rows],
        };
        let columns: Vec<&[f64]> = model.inputs.iter().map(&mut column).collect();
        model.function.evaluate_columns(rows, &columns, needed, run, answers)
    }

    /// Passes the derivatives of the model's own outputs on, by the dimensions that its inputs depend on.
    pub(super) fn pass_gradients(
        &self,
        points: &Points,
        origins: &[Origin],
        needed: &[usize],
        answers: &Responses,
        out: &mut Responses,
    ) {
        let Some(model) = &self.model else { return };
        let driving = self.driving();
        let by_unknowns = driving.iter().any(|&formula| self.drives_by_unknowns(formula));
        for (column, origin) in origins.iter().enumerate() {
            let Origin::Model(output) = origin else { continue };
            let Ok(answer) = needed.binary_search(output) else { continue };
            for row in 0..answers.rows() {
                let Some(gradient) = answers.gradient(row, answer).filter(|_| !by_unknowns) else { continue };
                let slopes = self.slopes_of(&driving, points, row);
                let mut passed = vec![0.0; self.signature.inputs.len()];
                for (input, (source, slope)) in model.inputs.iter().zip(gradient).enumerate() {
                    let slope = slope * model.factors[0].get(input).unwrap_or(&1.0);
                    match *source {
                        Source::Dimension(dimension) => passed[dimension] += slope,
                        Source::Fixed(_) => {}
                        Source::Formula(formula) => {
                            let place = driving.binary_search(&formula).expect("it drives the model");
                            passed.iter_mut().zip(&slopes[place]).for_each(|(sum, own)| *sum += slope * own);
                        }
                    }
                }
                if passed.iter().all(|slope| slope.is_finite()) {
                    out.set_gradient(row, column, passed);
                }
            }
        }
    }

    /// Returns the slopes of these formulas along every dimension, NaN if a slope does not exist.
    fn slopes_of(&self, formulas: &[usize], points: &Points, row: usize) -> Vec<Vec<f64>> {
        let dimensions = self.signature.inputs.len();
        let mut slopes = vec![vec![0.0; dimensions]; formulas.len()];
        if formulas.is_empty() {
            return slopes;
        }
        for d in 0..dimensions {
            let variable = |index: usize| match index < dimensions {
                true => Jet::variable(points.column(index)[row], [f64::from(u8::from(index == d)); 2]),
                false => Jet::variable(f64::NAN, [0.0; 2]),
            };
            let jets = self.formulas.jets(formulas, variable);
            slopes.iter_mut().zip(jets).for_each(|(of, jet)| of[d] = jet.first(0).unwrap_or(f64::NAN));
        }
        slopes
    }
}

impl Inner {
    /// Returns a column of `rows` values for every fixed input, one after the other.
    fn fixed(&self, rows: usize) -> Vec<f64> {
        let values = self.inputs.iter().filter_map(|source| match source {
            Source::Fixed(value) => Some(*value),
            _ => None,
        });
        values.flat_map(|value| std::iter::repeat_n(value, rows)).collect()
    }

    /// Returns the values of the dimensions for which the model receives these values, None for each that it does not receive. Returns
    /// None if a fixed input has another value now.
    pub(super) fn dimensions_of(&self, received: &[Option<f64>], dimensions: usize) -> Option<Vec<Option<f64>>> {
        let mut point = vec![None; dimensions];
        for (input, (source, &value)) in self.inputs.iter().zip(received).enumerate() {
            let factor = self.factors[0].get(input).copied().unwrap_or(1.0);
            match *source {
                Source::Dimension(dimension) => point[dimension] = value.map(|value| value / factor),
                Source::Fixed(fixed) if value.is_some_and(|value| value != fixed * factor) => return None,
                Source::Fixed(_) | Source::Formula(_) => {}
            }
        }
        Some(point)
    }

    /// Returns the formulas that drive the model.
    pub(super) fn driving(&self) -> impl Iterator<Item = usize> + '_ {
        self.inputs.iter().filter_map(|source| match source {
            Source::Formula(formula) => Some(*formula),
            _ => None,
        })
    }

    /// Stores the points for which these values are sent, so that remarks of the model about them can be stated in dimensions.
    fn remember(&self, distinct: &[Vec<f64>], rows_of: &[Option<usize>], points: &Points) {
        let mut sent = self.sent.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        for (row, from) in rows_of.iter().enumerate() {
            if let Some(from) = from {
                sent.entry(bits(&distinct[*from])).or_insert_with(|| points.row(row));
            }
        }
    }

    /// Returns the point for which these values were sent.
    fn sent_for(&self, point: &[f64]) -> Vec<f64> {
        let sent = self.sent.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        sent.get(&bits(point)).cloned().unwrap_or_else(|| point.to_vec())
    }
}
