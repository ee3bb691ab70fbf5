//! Interface of assembly functions, and its implementations.
//!
//! An assembly function with `N` inputs and `K` outputs maps points `x` in `R^N` to `y` in `R^K`. It receives a batch of points and the
//! outputs that are requested. It returns a number or an error for each point and output. Callers use nothing else, so that a formula, a
//! closed-form model and a CAD system in another process look the same.
//!
//! # A new kind of assembly function
//! A new kind is one file with a type that implements [`AssemblyFunction`].

mod adjusted;
mod answer_table;
mod blocks;
mod bounds;
mod closure;
mod composite;
mod derivatives;
mod error;
mod evaluator_account;
pub mod formula;
pub mod implicit;
mod model_description;
mod motion;
mod polynomial;
mod process_error;
mod request;
mod responses;
mod run;
mod signature;
mod states;
mod switch;

pub(crate) use crate::assembly::adjusted::Adjusted;
pub use crate::assembly::adjusted::{Adjustment, StockResponse};
pub use crate::assembly::answer_table::GivenAnswers;
pub use crate::assembly::answer_table::Table;
pub use crate::assembly::model_description::{ModelInfo, NonRepeatable, RecordedFailure};
pub use crate::assembly::motion::{Motion, MotionEnd, MotionExtremes};
pub use blocks::{in_blocks, in_ranges, near_rows};
pub use bounds::Bounds;
pub use closure::Closure;
pub use composite::{Composite, CompositeError, Parts, Source};
pub use derivatives::{Derivatives, Directions};
pub use error::{EvaluationError, NoColumn};
pub use evaluator_account::{DamagedJournal, EvaluatorAccount, OutdatedJournal};
#[doc(hidden)]
pub use polynomial::Polynomial;
pub use process_error::{Exit, ProcessError, ProcessFault, Quoted, StderrTail};
pub use request::{Points, Request};
pub use responses::Responses;
pub(crate) use responses::all_finite;
pub use run::{Progress, Run};
pub use signature::{Input, Output, Signature};
pub(crate) use states::{State, States};
pub use switch::{ContactSets, Switch, SwitchKind, Switches};

use crate::warning::Warning;
use sensitol_numeric::power::Power;

/// Interface of an assembly function: object-safe, batches of points, the requested outputs, and an error per point and output.
pub trait AssemblyFunction: Send + Sync {
    /// Returns names and units of inputs and outputs, and facts about the function that are known before any evaluation.
    fn signature(&self) -> &Signature;

    /// Starts programs that these outputs need, and returns the description that an external program gives of itself. An error here would
    /// occur at every point, so it is reported before any evaluation.
    ///
    /// # Errors
    /// Fails if the function cannot be used at all, for example because a program does not exist.
    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let _ = outputs;
        Ok(None)
    }

    /// Returns certain bounds of an output over the box of these intervals, one for every input. No evaluation gives such bounds. Returns
    /// None for a black box.
    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        let _ = (output, region);
        None
    }

    /// Returns the sums of the magnitudes of the terms of `outputs` at a point, in the requested order. Rounding errors of an output are
    /// parts of this sum. Returns None for an output whose terms are unknown, or if it has no value. This is not an evaluation.
    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        let _ = point;
        vec![None; outputs.len()]
    }

    /// Evaluates `request.points` for `request.outputs` and writes the answers into `out`. Its rows are the points, and its columns are the
    /// outputs in the requested order.
    ///
    /// A point without an answer is an error in `out`, not a panic. Rows that are final are reported by [`Run::finished`]. Between rows,
    /// [`Run::stopped`] returns true if the function must return now. The remaining rows stay unanswered then, which is no error.
    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses);

    /// Evaluates points like [`evaluate`](Self::evaluate), but with separate columns of `rows` values each, so that no copy is needed.
    /// Returns `false` and does nothing if the function does not accept such points, as by default.
    #[doc(hidden)]
    fn evaluate_columns(
        &self,
        rows: usize,
        columns: &[&[f64]],
        outputs: &[usize],
        run: &Run<'_>,
        out: &mut Responses,
    ) -> bool {
        let _ = (rows, columns, outputs, run, out);
        false
    }

    /// Returns exact derivatives of `outputs` at a point, in the requested order. Returns None for an output without derivatives at any
    /// point.
    ///
    /// This is not an evaluation: a function that would have to evaluate points returns None, as by default.
    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        let _ = directions;
        vec![None; outputs.len()]
    }

    /// Returns [`derivatives`](Self::derivatives) per unit of `2^exponent` of each input, so that those by inputs of extreme size are of
    /// ordinary size.
    ///
    /// Shapes: `exponents` has an element for every input. By default the derivatives per unit of 1 are multiplied.
    #[doc(hidden)]
    fn derivatives_per(
        &self,
        outputs: &[usize],
        directions: &Directions<'_>,
        exponents: &[i32],
    ) -> Vec<Option<Derivatives>> {
        let unit = |input: usize| Power::of_exponent(exponents[input]);
        let per = |found: Option<Derivatives>| found.map(|found| found.per(directions, &unit));
        self.derivatives(outputs, directions).into_iter().map(per).collect()
    }

    /// Returns the values that an external model receives at these points, each point once, with the names of its inputs. Returns None if
    /// it receives the points themselves. This is not an evaluation.
    fn sent(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
        let _ = points;
        None
    }

    /// Returns this function as a composite if formulas drive a costly model, so that a surface can be fitted over the inputs of the model.
    /// Returns None for anything else.
    fn driven(&self) -> Option<&Composite> {
        None
    }

    /// Returns the switches of an output, where it changes its form. Returns None for a black box.
    fn switches(&self, output: usize) -> Option<Switches> {
        let _ = output;
        None
    }

    /// Returns the choice from stock that an output follows, in words. Returns None if it follows none. It is known of a black box too.
    fn choice(&self, output: usize) -> Option<String> {
        let _ = output;
        None
    }

    /// Returns the margins of points from each of an output's [`switches`](Self::switches), in the order of their list. A margin changes
    /// its sign where the output changes its form. It is NaN if the switch has no part in the value. Returns None if there are no switches.
    ///
    /// Shapes: a column for every switch, a value for every point. This is not an evaluation of a costly model, for which it returns None.
    fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        let _ = (output, points);
        None
    }

    /// Returns the degree of an output as a polynomial in the inputs that `varying` flags, with the others fixed. Returns None if it is not
    /// a polynomial, or if this is unknown. The degree is certain, which no evaluation can show.
    fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
        let _ = (output, varying);
        None
    }

    /// Returns an output as a polynomial in `u`, with inputs `centre + scale u`. An input with the scale 0 is fixed. Returns None if the
    /// output is not a polynomial of at most the fourth degree, or if this is unknown. The polynomial is certain, which no evaluation can
    /// show.
    ///
    /// Shapes: `centre` and `scale` have a value for every input.
    #[doc(hidden)]
    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        let _ = (output, centre, scale);
        None
    }

    /// Returns the account of the processes of an external model so far, or None for a function without processes.
    fn account(&self) -> Option<EvaluatorAccount> {
        None
    }

    /// Returns the greatest number of evaluations that the function adds to so many answers to check them itself: replays in fresh
    /// processes. Returns 0 for a function that checks nothing. This is not an evaluation.
    fn own_checks(&self, answers: usize) -> usize {
        let _ = answers;
        0
    }

    /// Returns the greatest number of evaluations for one point: more than 1 with a choice from stock or an extreme over a motion. This is
    /// not an evaluation.
    fn evaluations_per_point(&self, outputs: &[usize]) -> usize {
        let _ = outputs;
        1
    }

    /// Returns points of earlier runs at which the model answered that one of `outputs` has no value. Crashes and missed deadlines are
    /// left out, since another attempt may succeed. Returns none for a function without a journal. This is not an evaluation.
    fn recorded_failures(&self, outputs: &[usize]) -> Vec<RecordedFailure> {
        let _ = outputs;
        Vec::new()
    }

    /// Returns the warnings of the function about its answers for `outputs`, after it has given some.
    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        let _ = outputs;
        Vec::new()
    }
}
