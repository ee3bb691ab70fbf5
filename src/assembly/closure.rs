//! A Rust closure as assembly function.

use crate::assembly::{AssemblyFunction, EvaluationError, Request, Responses, Run, Signature, in_blocks};

/// Points that are gathered into rows at once: some cache lines of every column.
const TILE: usize = 32;

type Answer = dyn Fn(&[f64], &mut [f64]) -> Result<(), EvaluationError> + Send + Sync;

/// Assembly function made of a closure, which receives one point and returns one value per output.
///
/// The inputs have no names of their own: they are the problem's dimensions in order. Several points are evaluated in parallel.
///
/// ```
/// use sensitol::{Closure, Dimension, Method, Problem, analyze};
/// let dimensions = [Dimension::normal("bore", 25.02, 0.01)?, Dimension::normal("pin", 25.0, 0.01)?];
/// let problem = Problem::new(dimensions, Closure::scalar("clearance", |x| x[0] - x[1]))?;
/// let clearance = &analyze(&problem, &Method::SecondOrder.into())?.characteristics[0];
/// assert!((clearance.moments.unwrap().sigma() - 0.01 * 2f64.sqrt() / 3.0).abs() < 1e-12);
/// # Ok::<(), sensitol::Error>(())
/// ```
pub struct Closure {
    signature: Signature,
    answer: Box<Answer>,
}

impl Closure {
    /// Creates a function with one output.
    pub fn scalar(output: &str, function: impl Fn(&[f64]) -> f64 + Send + Sync + 'static) -> Self {
        Self::new([output], move |x| [function(x)])
    }

    /// Creates a function with `K` outputs.
    pub fn new<const K: usize>(
        outputs: [&str; K],
        function: impl Fn(&[f64]) -> [f64; K] + Send + Sync + 'static,
    ) -> Self {
        Self::fallible(outputs, move |x| Ok(function(x)))
    }

    /// Creates a function with `K` outputs that can refuse points.
    ///
    /// ```
    /// use sensitol::assembly::{Closure, EvaluationError};
    /// let chain = Closure::fallible(["sum", "ratio"], |x| {
    ///     if x[1] == 0.0 {
    ///         return Err(EvaluationError::Refused { message: "b is 0".into() });
    ///     }
    ///     Ok([x[0] + x[1], x[0] / x[1]])
    /// });
    /// ```
    pub fn fallible<const K: usize>(
        outputs: [&str; K],
        function: impl Fn(&[f64]) -> Result<[f64; K], EvaluationError> + Send + Sync + 'static,
    ) -> Self {
        let answer = move |x: &[f64], y: &mut [f64]| {
            y.copy_from_slice(&function(x)?);
            Ok(())
        };
        Self { signature: Signature::of_names(Vec::<String>::new(), outputs), answer: Box::new(answer) }
    }
}

impl AssemblyFunction for Closure {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        in_blocks(request, run, out, |points, rows, out| {
            let mut y = vec![0.0; self.signature.outputs.len()];
            let mut tile = Vec::new();
            let first = rows.start;
            for r in rows.clone() {
                let (row, within) = (r - first, (r - first) % TILE);
                if within == 0 {
                    points.rows_to(r..rows.end.min(r + TILE), &mut tile);
                }
                let answered = (self.answer)(&tile[within * points.dimensions()..][..points.dimensions()], &mut y);
                for (column, &output) in request.outputs.iter().enumerate() {
                    match &answered {
                        Ok(()) => out.set(row, column, y[output]),
                        Err(error) => out.fail(row, column, error.clone()),
                    }
                }
            }
        });
    }
}
