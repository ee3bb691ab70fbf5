//! Values of a composite at many points, block by block: the model's answers, the unknowns of conditions, and formulas of both.

use std::ops::Range;
use std::sync::Arc;

use super::{Composite, Needs, Origin};
use crate::assembly::implicit::{Anchor, RowSolution};
use crate::assembly::responses::all_finite;
use crate::assembly::{EvaluationError, Points, Request, Responses, Run, in_blocks};

/// Greatest number of parts of formulas that are evaluated to explain the failures of one block of rows. Explaining a failure costs an
/// evaluation of every part of all formulas, without the gain of a block.
const EXPLAINED: usize = 1 << 17;

impl Composite {
    /// Fills the requested outputs, with their cost.
    pub(super) fn evaluate_points(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let origins = self.origins(request.outputs);
        let needs: Vec<Needs> = origins.iter().map(|&origin| self.needs(origin)).collect();
        let Needs { answers: needed, unknowns, .. } = Needs::all(&needs);
        if self.answers_in_place(request.points, run, (&origins, &needed), out) {
            return;
        }
        let (anchor, spent) = if unknowns { self.anchor(run) } else { (None, 0) };
        let answers = self.ask_model(request.points, &run.quiet(), &needed);
        let evaluation = Evaluation::new(self, (origins, needs, needed), anchor, answers);

        // The answers of the model are not lost to a stop: only the model itself is stopped.
        let run = if evaluation.needed.is_empty() { *run } else { run.unstopped() };
        in_blocks(request, &run, out, |points, rows, out| Block::new(&evaluation, points, rows).fill(out));
        let Evaluation { origins, needed, answers, .. } = &evaluation;
        out.spent(spent + answers.extra() + answers.count_reused() as i64);
        out.reused(answers.count_reused());
        out.retried(answers.count_retried());
        out.leave_unchecked(answers.count_unchecked());
        out.note_non_repeatable(answers.non_repeatable().iter().cloned());
        answers.revoked().iter().for_each(|point| out.revoke(point.clone()));
        self.pass_gradients(request.points, origins, needed, answers, out);
    }

    /// Lets a built-in model write its outputs itself, if nothing else is requested and the order is its own. Returns false if it cannot.
    fn answers_in_place(
        &self,
        points: &Points,
        run: &Run<'_>,
        (origins, needed): (&[Origin], &[usize]),
        out: &mut Responses,
    ) -> bool {
        let own = |(origin, output): (&Origin, &usize)| matches!(origin, Origin::Model(of) if of == output);
        let alone = origins.len() == needed.len() && origins.iter().zip(needed).all(own);
        let Some(model) = &self.model else { return false };
        // A factor can make a value infinite, which is then an error.
        let as_it_is = model.factors[1].iter().all(|factor| *factor == 1.0);
        as_it_is && alone && !run.tells() && self.ask_in_place(model, points, &run.quiet(), needed, out)
    }
}

/// The answers that all blocks of an evaluation share.
struct Evaluation<'e> {
    composite: &'e Composite,
    /// The origin and the needs of every column of the responses.
    origins: Vec<Origin>,
    needs: Vec<Needs>,
    /// Outputs of the model, ascending, and its answers in this order.
    needed: Vec<usize>,
    answers: Responses,
    anchor: Option<Result<Arc<Anchor>, EvaluationError>>,
    /// The formulas that fill columns of the responses, and these columns.
    formulas: Vec<usize>,
    columns: Vec<usize>,
    /// Numbers of the dimensions, and of all variables that are not unknowns.
    dimensions: usize,
    given: usize,
}

impl<'e> Evaluation<'e> {
    /// Sorts the columns by their origin.
    fn new(
        composite: &'e Composite,
        (origins, needs, needed): (Vec<Origin>, Vec<Needs>, Vec<usize>),
        anchor: Option<Result<Arc<Anchor>, EvaluationError>>,
        answers: Responses,
    ) -> Self {
        let (columns, formulas): (Vec<usize>, Vec<usize>) = (origins.iter().enumerate())
            .filter_map(|(column, origin)| match origin {
                Origin::Formula(formula) => Some((column, *formula)),
                Origin::Model(_) | Origin::Unknown(_) => None,
            })
            .unzip();
        let (dimensions, given) = (composite.signature.inputs.len(), composite.given());
        Self { composite, origins, needs, needed, answers, anchor, formulas, columns, dimensions, given }
    }

    /// The column of the answers that has an output of the model.
    fn answer(&self, output: usize) -> usize {
        self.needed.binary_search(&output).expect("the model was asked for it")
    }
}

/// A block of rows of an evaluation.
struct Block<'b> {
    evaluation: &'b Evaluation<'b>,
    points: &'b Points,
    rows: Range<usize>,
    /// Solved unknowns. None if no unknowns are needed, or no nominal state of them is known.
    solved: Option<RowSolution>,
    /// Values of unknowns that are not solved.
    nothing: Vec<f64>,
}

impl<'b> Block<'b> {
    /// Solves the conditions in a block of rows.
    fn new(evaluation: &'b Evaluation<'b>, points: &'b Points, rows: Range<usize>) -> Self {
        let nothing = vec![f64::NAN; rows.len()];
        let mut block = Self { evaluation, points, rows, solved: None, nothing };
        let Evaluation { composite, anchor, given, .. } = evaluation;
        if let (Some(assembler), Some(Ok(anchor))) = (&composite.assembler, anchor) {
            let variable = |index: usize, row: usize| block.known(index)[row];
            let solver = (&**assembler, &*composite.formulas);
            block.solved = Some(RowSolution::of(solver, anchor, block.rows.len(), *given, variable));
        }
        block
    }

    /// Fills the responses: errors stand only in the rows and outputs that they concern.
    fn fill(&self, out: &mut Responses) {
        self.pass_values(out);
        self.evaluate_formulas(out);
    }

    /// The values of a dimension or of an output of the model.
    fn known(&self, index: usize) -> &[f64] {
        let Evaluation { answers, dimensions, .. } = self.evaluation;
        let column = match index.checked_sub(*dimensions) {
            None => self.points.column(index),
            Some(output) => answers.column(self.evaluation.answer(output)),
        };
        &column[self.rows.clone()]
    }

    /// The values of any variable, unknowns included.
    fn variable(&self, index: usize) -> &[f64] {
        match index.checked_sub(self.evaluation.given) {
            None => self.known(index),
            Some(unknown) => self.solved.as_ref().map_or(&self.nothing[..], |solved| &solved.columns[unknown]),
        }
    }

    /// Passes on the missing answer or unknown that an output needs. Returns false if none is missing.
    fn pass_missing(&self, out: &mut Responses, row: usize, column: usize) -> bool {
        let Evaluation { needs, answers, anchor, .. } = self.evaluation;
        let from = self.rows.start + row;
        // A missing answer decides the output: then it is that error, or still open.
        let lacks = |&&output: &&usize| answers.value(from, self.evaluation.answer(output)).is_none();
        if let Some(&output) = needs[column].answers.iter().find(lacks) {
            out.pass_on(row, column, answers, from, self.evaluation.answer(output));
            return true;
        }
        if !needs[column].unknowns {
            return false;
        }
        match (anchor, &self.solved) {
            (Some(Err(error)), _) => out.fail(row, column, error.clone()),
            (_, Some(solved)) => match &solved.errors[row] {
                Some(failure) => out.fail(row, column, failure.clone().into()),
                None => return false,
            },
            _ => {}
        }
        true
    }

    /// Passes on the answers of the model, and the unknowns.
    fn pass_values(&self, out: &mut Responses) {
        let Evaluation { origins, answers, given, .. } = self.evaluation;
        for (column, origin) in origins.iter().enumerate() {
            if let Origin::Model(output) = *origin
                && let values = &answers.column(self.evaluation.answer(output))[self.rows.clone()]
                && all_finite(values)
            {
                out.set_rows(0, column, values);
                continue;
            }
            for row in 0..self.rows.len() {
                match *origin {
                    Origin::Model(output) => {
                        out.pass_on(row, column, answers, self.rows.start + row, self.evaluation.answer(output));
                    }
                    Origin::Unknown(unknown) if !self.pass_missing(out, row, column) => {
                        out.set(row, column, self.variable(given + unknown)[row]);
                    }
                    Origin::Unknown(_) | Origin::Formula(_) => {}
                }
            }
        }
    }

    /// Evaluates the formulas, and explains their first failures.
    fn evaluate_formulas(&self, out: &mut Responses) {
        let Evaluation { composite, formulas, columns, .. } = self.evaluation;
        let set = &composite.formulas;
        let mut explained = (EXPLAINED / set.parts().max(1)).max(1);
        let variable = |index: usize| self.variable(index);
        set.evaluate_blocks(formulas, self.rows.len(), variable, |position, first, values| {
            let column = columns[position];
            if all_finite(values) {
                return out.set_rows(first, column, values);
            }
            for (row, &value) in (first..).zip(values) {
                if value.is_finite() {
                    out.set(row, column, value);
                } else if !self.pass_missing(out, row, column) {
                    let explain = || set.explain(formulas[position], |index| self.variable(index)[row]);
                    let failure = if explained > 0 { explain() } else { None };
                    explained = explained.saturating_sub(1);
                    let error =
                        failure.map_or(EvaluationError::NotFinite { value }, |failure| Box::new(failure).into());
                    out.fail(row, column, error);
                }
            }
        });
    }
}
