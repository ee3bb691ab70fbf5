//! Facts about an assembly function that are known before it is evaluated.

/// Names, units and structure of an assembly function.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Signature {
    /// Inputs, in the order of a point's coordinates.
    pub inputs: Vec<Input>,
    /// Outputs that can be requested.
    pub outputs: Vec<Output>,
    /// True if an evaluation is so costly that answers are stored on disk.
    pub costly: bool,
    /// True if tens of thousands of evaluations take no noticeable time, as with formulas. Results are then verified by a sample of the
    /// function itself. A foreign function, such as a closure, is neither costly nor cheap.
    pub cheap: bool,
}

/// One coordinate of a point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Input {
    /// Name of the input.
    pub name: String,
    /// Unit of the input, if it has one.
    pub unit: Option<String>,
}

/// One value that can be requested.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Output {
    /// Name of the output.
    pub name: String,
    /// Unit of the output, if it has one.
    pub unit: Option<String>,
    /// Inputs on which the output can depend, ascending; None if they are unknown, as for a black box.
    pub depends_on: Option<Vec<usize>>,
}

impl Signature {
    /// Creates a signature from the names of inputs and outputs, without further facts.
    pub fn of_names<I, O>(inputs: I, outputs: O) -> Self
    where
        I: IntoIterator<Item: Into<String>>,
        O: IntoIterator<Item: Into<String>>,
    {
        Self {
            inputs: inputs.into_iter().map(|name| Input { name: name.into(), unit: None }).collect(),
            outputs: outputs.into_iter().map(|name| Output { name: name.into(), ..Output::default() }).collect(),
            ..Self::default()
        }
    }

    /// Returns the index of the output of this name.
    pub(crate) fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|output| output.name == name)
    }
}
