//! The facts about an assembly function that are known before it is evaluated.

/// Names, units and structure of an assembly function.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Signature {
    /// The inputs, in the order of a point's coordinates.
    pub inputs: Vec<Input>,
    /// The outputs that can be asked for.
    pub outputs: Vec<Output>,
    /// Whether an evaluation costs so much that answers are worth keeping on disk.
    pub costly: bool,
    /// Whether tens of thousands of evaluations go unnoticed, as with formulas: results are then verified by a sample of the function
    /// itself. Neither is known of a foreign function, such as a closure.
    pub cheap: bool,
}

/// One coordinate of a point.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Input {
    /// Its name.
    pub name: String,
    /// Its unit, where it has one.
    pub unit: Option<String>,
}

/// One value that can be asked for.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Output {
    /// Its name.
    pub name: String,
    /// Its unit, where it has one.
    pub unit: Option<String>,
    /// The inputs on which it can depend, ascending; None when that is unknown, as for a black box.
    pub depends_on: Option<Vec<usize>>,
}

impl Signature {
    /// Inputs and outputs by name alone, with nothing else known.
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

    /// Index of the output of this name.
    pub(crate) fn output(&self, name: &str) -> Option<usize> {
        self.outputs.iter().position(|output| output.name == name)
    }
}
