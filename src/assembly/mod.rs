//! The black box: the assembly function, and how it is asked.
//!
//! With `N` inputs and `K` outputs, an assembly function maps points `x` in `R^N` to `y` in `R^K`. It is asked for a
//! whole batch of points at once and told which outputs are wanted; it answers with numbers or, per point and output,
//! with an error. Nothing else is known of it, so a formula, a closed-form model and a CAD system in another process
//! look the same from here.
//!
//! # A new kind of assembly function
//! One new file with a type that implements [`AssemblyFunction`].

mod account;
mod blocks;
mod bounds;
mod closure;
mod composite;
mod derivatives;
mod error;
mod evaluator_account;
pub mod formula;
mod given;
pub mod implicit;
mod polynomial;
mod process_error;
mod request;
mod responses;
mod run;
mod signature;
mod states;
mod switch;

pub use account::{ModelInfo, NonRepeatable};
pub use blocks::{in_blocks, in_ranges, near_rows};
pub use bounds::Bounds;
pub use closure::Closure;
pub use composite::{Composite, CompositeError, Parts, Source};
pub use derivatives::{Derivatives, Directions};
pub use error::{EvaluationError, NoColumn};
pub use evaluator_account::{EvaluatorAccount, OutdatedJournal};
pub use given::GivenAnswers;
pub use given::Table;
#[doc(hidden)]
pub use polynomial::Polynomial;
pub use process_error::{Exit, ProcessError, ProcessFault, Quoted, StderrTail};
pub use request::{Points, Request};
pub use responses::Responses;
pub(crate) use responses::all_finite;
pub use run::{Progress, Run};
pub use signature::{Input, Output, Signature};
pub(crate) use states::{State, States};
pub use switch::{Switch, SwitchKind, Switches};

use crate::warning::Warning;
use sensitol_numeric::power::Power;

/// The black box: object-safe, batch first, told what is asked, with an error per point and output.
pub trait AssemblyFunction: Send + Sync {
    /// Names and units of inputs and outputs, and what is known of the function beforehand.
    fn signature(&self) -> &Signature;

    /// Starts whatever must run before the first point, for these outputs, and tells what an external program says of
    /// itself. A failure here would occur at every point: nothing has been evaluated yet.
    ///
    /// # Errors
    /// When the function cannot be had at all, such as a program that does not exist.
    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        let _ = outputs;
        Ok(None)
    }

    /// Encloses an output over the box of these intervals, one for every input: a certainty, which no evaluation gives. None
    /// from a black box.
    fn bounds(&self, output: usize, region: &[[f64; 2]]) -> Option<Bounds> {
        let _ = (output, region);
        None
    }

    /// The sums of the magnitudes of the terms of `outputs` at a point, in the order asked: an output is rounded by parts of them. None for
    /// an output of which the function does not know its terms, and where it has no value. This is not an evaluation.
    fn magnitudes(&self, outputs: &[usize], point: &[f64]) -> Vec<Option<f64>> {
        let _ = point;
        vec![None; outputs.len()]
    }

    /// Answers `request.points` for `request.outputs` into `out`, whose rows are the points and whose columns are the asked
    /// outputs in the order asked.
    ///
    /// A point that cannot be answered is an error in `out`, not a panic. As rows become final they are told to
    /// [`Run::finished`]; between rows [`Run::stopped`] says when to return with the rest unanswered, which is no
    /// error.
    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses);

    /// [`evaluate`](Self::evaluate) of points whose columns stand apart, `rows` values in each, so that no copy is needed; `false`,
    /// and nothing done, where it takes no such points, as by default.
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

    /// Exact derivatives of `outputs` at a point, in the order asked; None for an output of which the function does not
    /// know them at any point.
    ///
    /// This is not an evaluation: a function that would have to evaluate points for it answers None, as it does by default.
    fn derivatives(&self, outputs: &[usize], directions: &Directions<'_>) -> Vec<Option<Derivatives>> {
        let _ = directions;
        vec![None; outputs.len()]
    }

    /// [`derivatives`](Self::derivatives) per unit of `2^exponent` of each input, so that those by inputs of extreme size are of ordinary size.
    ///
    /// Shapes: `exponents` has an element for every input. By default the derivatives per unit of 1, multiplied.
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

    /// The values that an external model is sent at these points, each point once, with the names of its inputs; None where it is
    /// sent the points themselves. This is not an evaluation.
    fn sent(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
        let _ = points;
        None
    }

    /// Itself, where formulas drive a costly model: whoever analyses it may fit what the model is sent. None of anything else.
    fn driven(&self) -> Option<&Composite> {
        None
    }

    /// The places at which an output changes its form; None from a black box.
    fn switches(&self, output: usize) -> Option<Switches> {
        let _ = output;
        None
    }

    /// How far points are from each of an output's [`switches`](Self::switches), in the order of their list: a margin changes its sign
    /// where the output changes its form, and is NaN where the switch has no part in the value. None where there are none to tell.
    ///
    /// Shapes: a column for every switch, a value for every point. This is not an evaluation of a costly model: such a one
    /// answers None.
    fn margins(&self, output: usize, points: &Points) -> Option<Vec<Vec<f64>>> {
        let _ = (output, points);
        None
    }

    /// The degree of an output as a polynomial in the inputs that `varying` flags, the others fixed; None where it is not one,
    /// or that is not known. A certainty, which no evaluation gives.
    fn degree(&self, output: usize, varying: &[bool]) -> Option<u32> {
        let _ = (output, varying);
        None
    }

    /// An output as a polynomial in `u`, where the inputs are `centre + scale u`: one with the scale 0 is fixed. None where it is not a
    /// polynomial of at most the fourth degree, or that is not known. A certainty, which no evaluation gives.
    ///
    /// Shapes: `centre` and `scale` have a value for every input.
    #[doc(hidden)]
    fn polynomial(&self, output: usize, centre: &[f64], scale: &[f64]) -> Option<Polynomial> {
        let _ = (output, centre, scale);
        None
    }

    /// The account of the processes of an external model so far; None for a function without any.
    fn account(&self) -> Option<EvaluatorAccount> {
        None
    }

    /// The function's own warnings about its answers for `outputs`, once some are given.
    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        let _ = outputs;
        Vec::new()
    }
}
