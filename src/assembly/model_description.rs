//! Description that an external model gives of itself, and observations of its answers.

use sensitol_numeric::dimension::Dimension;

/// Rounding of a coordinate by conversions of units and offsets of states, as a part of its size.
const ROUNDING: f64 = 1e-12;

/// Description that an external model gives of itself when it is ready.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelInfo {
    /// Name of the model, if it has one.
    pub name: Option<String>,
    /// Version of the model, if it has one.
    pub version: Option<String>,
    /// Greatest number of points that may be in progress in the model at once.
    pub window: usize,
    /// True if the answers of the model include derivatives.
    pub gradients: bool,
}

impl ModelInfo {
    /// Returns the description of a model with this window, without name and version.
    pub fn of_window(window: usize) -> Self {
        Self { window, ..Self::default() }
    }
}

/// Different answers of a model for the same point: the nominal point, or one that was evaluated again as a check.
#[derive(Debug, Clone, PartialEq)]
pub struct NonRepeatable {
    /// Name of the output.
    pub output: String,
    /// First value of the output; None if it had no value.
    pub expected: Option<f64>,
    /// Value of the output when the point was evaluated again.
    pub found: Option<f64>,
    /// Greatest observed variation of the output.
    pub spread: f64,
    /// Points whose answers are not trusted because of this.
    pub suspects: Vec<Vec<f64>>,
}

impl NonRepeatable {
    /// Creates the observation that an output was `expected` and is now `found`. It varies by `spread`, and the answers at `suspects` are
    /// not trusted.
    pub fn new(
        output: impl Into<String>,
        [expected, found]: [Option<f64>; 2],
        spread: f64,
        suspects: Vec<Vec<f64>>,
    ) -> Self {
        Self { output: output.into(), expected, found, spread, suspects }
    }
}

/// Point of an earlier run at which the model answered that an output has no value.
///
/// ```
/// use sensitol::Dimension;
/// use sensitol::assembly::RecordedFailure;
/// let dimensions = [Dimension::normal("a", 10.0, 0.1)?, Dimension::fixed("b", 5.0)?];
/// let failure = |a: f64| RecordedFailure { output: 0, point: vec![Some(a), None] };
/// assert!(failure(10.1).is_within(&dimensions) && !failure(10.2).is_within(&dimensions));
/// # Ok::<(), sensitol::Error>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct RecordedFailure {
    /// Index of the output in the function's signature.
    pub output: usize,
    /// Value of each input; None for an input that the model does not receive.
    pub point: Vec<Option<f64>>,
}

impl RecordedFailure {
    /// True if the point lies within the reach of every dimension, as [`Dimension::reach`] defines it.
    pub fn is_within(&self, dimensions: &[Dimension]) -> bool {
        self.point.iter().zip(dimensions).all(|(x, dimension)| {
            x.is_none_or(|x| {
                let [lower, upper] = dimension.reach().map(|end| dimension.nominal() + end);
                let rounding = ROUNDING * x.abs().max(lower.abs()).max(upper.abs());
                (lower - rounding..=upper + rounding).contains(&x)
            })
        })
    }

    /// True if the failure belongs to this point, within rounding.
    pub(crate) fn is_at(&self, point: &[f64]) -> bool {
        let near = |(own, x): (&Option<f64>, &f64)| own.is_none_or(|own| (own - x).abs() <= ROUNDING * x.abs());
        self.point.iter().zip(point).all(near)
    }
}
