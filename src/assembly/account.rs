//! The description that an assembly function gives of itself, and observations of its answers: the same for every kind of
//! function.

/// The description that an external model gives of itself when it is ready.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct ModelInfo {
    /// Its name.
    pub name: Option<String>,
    /// Its version.
    pub version: Option<String>,
    /// Points that may be under way in it at once.
    pub window: usize,
    /// Whether its answers have derivatives.
    pub gradients: bool,
}

impl ModelInfo {
    /// A model that takes so many points at once, without name and version.
    pub fn of_window(window: usize) -> Self {
        Self { window, ..Self::default() }
    }
}

/// A model answered one point otherwise than before: the nominal point, or one that was asked again to see whether it repeats.
#[derive(Debug, Clone, PartialEq)]
pub struct NonRepeatable {
    /// The output.
    pub output: String,
    /// Its first value; None where it had no value.
    pub expected: Option<f64>,
    /// Its value now.
    pub found: Option<f64>,
    /// How far the output has been seen to vary.
    pub spread: f64,
    /// The points whose answers are not trusted for that.
    pub suspects: Vec<Vec<f64>>,
}

impl NonRepeatable {
    /// An output that varies by `spread` was `expected` and is now `found`, so that the answers at `suspects` are not trusted.
    pub fn new(
        output: impl Into<String>,
        [expected, found]: [Option<f64>; 2],
        spread: f64,
        suspects: Vec<Vec<f64>>,
    ) -> Self {
        Self { output: output.into(), expected, found, spread, suspects }
    }
}
