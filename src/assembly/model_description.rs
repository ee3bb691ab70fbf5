//! Description that an external model gives of itself, and observations of its answers.

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
