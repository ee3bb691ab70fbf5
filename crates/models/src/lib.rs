//! Built-in closed-form models, each in its own file, and their registry.
//!
//! # A new model
//! One new file with a `pub static` [`Model`], one line in [`ALL`], a test in `tests/accuracy/published.rs` with reference values
//! from an independent source, and a study in `examples/`.

mod compression_clearance;
mod connecting_rod;
mod dual_mass_flywheel;
mod engine_balance;
mod gas;
mod inline_engine;
mod jet;
mod quick_return;
mod spot_weld;

use std::ops::Range;
use std::str::FromStr;
use std::sync::atomic::{AtomicBool, Ordering};

use sensitol::assembly::{AssemblyFunction, Input, Output, Request, Responses, Run, Signature, in_ranges};
use sensitol::warning::Warning;
use sensitol_numeric::names::UnknownName;

/// All built-in models, in the order of their list.
pub static ALL: &[&Model] = &[
    &engine_balance::ENGINE_BALANCE,
    &inline_engine::INLINE_ENGINE,
    &connecting_rod::CONNECTING_ROD,
    &dual_mass_flywheel::DUAL_MASS_FLYWHEEL,
    &compression_clearance::COMPRESSION_CLEARANCE,
    &quick_return::QUICK_RETURN,
    &spot_weld::SPOT_WELD,
];

/// A closed-form model: named inputs with documented nominal values, and named outputs.
#[derive(Debug)]
#[non_exhaustive]
pub struct Model {
    /// Name in study files.
    pub name: &'static str,
    /// Description in one line.
    pub title: &'static str,
    /// Author, year, equations, and departures from them.
    pub source: &'static str,
    /// Inputs, in the order in which `evaluate` receives them.
    pub inputs: &'static [ModelInput],
    /// Outputs, in the order of their indices in `evaluate`.
    pub outputs: &'static [ModelOutput],
    /// Function that evaluates a block of rows.
    pub(crate) evaluate: fn(&Block<'_>, &mut Responses),
    /// Bounds of outputs beyond which the formulas do not hold.
    pub(crate) bounds: &'static [Validity],
}

/// Bound of an output beyond which the formulas describe nothing real.
#[derive(Debug)]
pub(crate) struct Validity {
    /// Index of the output.
    output: usize,
    /// True if a value of the output at this row is beyond the bound.
    beyond: fn(&Block<'_>, usize, f64) -> bool,
    /// Text of the bound and of the part that does not hold beyond.
    reason: &'static str,
}

/// An input of a built-in model.
#[derive(Debug)]
pub struct ModelInput {
    /// Symbol.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Default value for studies that leave the input out.
    pub nominal: f64,
    /// Description.
    pub about: &'static str,
}

/// An output of a built-in model.
#[derive(Debug)]
#[non_exhaustive]
pub struct ModelOutput {
    /// Symbol.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Description.
    pub about: &'static str,
    /// Indices of the inputs that the output depends on, ascending.
    pub depends_on: &'static [usize],
}

/// Request to a model: some rows of points, and some of its outputs.
#[derive(Debug)]
pub(crate) struct Block<'a> {
    columns: &'a [&'a [f64]],
    rows: Range<usize>,
    outputs: &'a [usize],
}

impl Block<'_> {
    /// Values of one input in these rows.
    pub(crate) fn input(&self, index: usize) -> &[f64] {
        &self.columns[index][self.rows.clone()]
    }

    pub(crate) fn rows(&self) -> usize {
        self.rows.len()
    }

    /// Column of the responses for this output. Returns None if it is not requested.
    pub(crate) fn column(&self, output: usize) -> Option<usize> {
        self.outputs.iter().position(|&asked| asked == output)
    }
}

impl Model {
    /// The model as assembly function, with all its inputs as dimensions.
    ///
    /// ```
    /// use sensitol::assembly::{AssemblyFunction, Points, Request, Responses, Run};
    /// let engine: &sensitol_models::Model = "engine-balance".parse().unwrap();
    /// let nominal: Vec<f64> = engine.inputs.iter().map(|input| input.nominal).collect();
    /// let (points, mut force) = (Points::from_rows(&[nominal]), Responses::open(1, 1));
    /// engine.function().evaluate(&Request::values(&points, &[0]), &Run::to_the_end(), &mut force);
    /// assert!((force.value(0, 0).unwrap() - 12556.9361).abs() < 1e-4);
    /// ```
    pub fn function(&'static self) -> impl AssemblyFunction + use<> {
        let input = |input: &ModelInput| Input { name: input.name.to_owned(), unit: Some(input.unit.to_owned()) };
        let output = |output: &ModelOutput| Output {
            name: output.name.to_owned(),
            unit: Some(output.unit.to_owned()),
            depends_on: Some(output.depends_on.to_vec()),
        };
        let signature = Signature {
            inputs: self.inputs.iter().map(input).collect(),
            outputs: self.outputs.iter().map(output).collect(),
            cheap: true,
            ..Signature::default()
        };
        BuiltIn { model: self, signature, passed: self.bounds.iter().map(|_| AtomicBool::new(false)).collect() }
    }
}

/// A built-in model as assembly function.
struct BuiltIn {
    model: &'static Model,
    signature: Signature,
    /// True for each bound that some evaluated value has passed.
    passed: Vec<AtomicBool>,
}

impl AssemblyFunction for BuiltIn {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        let points = request.points;
        let columns: Vec<&[f64]> = (0..points.dimensions()).map(|dimension| points.column(dimension)).collect();
        self.evaluate_columns(points.rows(), &columns, request.outputs, run, out);
    }

    fn evaluate_columns(
        &self,
        rows: usize,
        columns: &[&[f64]],
        outputs: &[usize],
        run: &Run<'_>,
        out: &mut Responses,
    ) -> bool {
        in_ranges(rows, outputs.len(), run, out, |rows, out| {
            let block = Block { columns, rows, outputs };
            (self.model.evaluate)(&block, out);
            for (bound, passed) in self.model.bounds.iter().zip(&self.passed) {
                let Some(column) = block.column(bound.output) else { continue };
                let beyond = |row| out.value(row, column).is_some_and(|value| (bound.beyond)(&block, row, value));
                if (0..block.rows()).any(beyond) {
                    passed.store(true, Ordering::Relaxed);
                }
            }
        });
        true
    }

    fn warnings(&self, outputs: &[usize]) -> Vec<Warning> {
        let bounds = self.model.bounds.iter().zip(&self.passed);
        let passed = bounds.filter(|(bound, passed)| outputs.contains(&bound.output) && passed.load(Ordering::Relaxed));
        let warning = |(bound, _): (&Validity, _)| Warning::OutsideModel {
            output: self.model.outputs[bound.output].name.to_owned(),
            reason: bound.reason.to_owned(),
        };
        passed.map(warning).collect()
    }
}

/// Finds the model with this name.
impl FromStr for &'static Model {
    type Err = UnknownName;

    fn from_str(name: &str) -> Result<Self, UnknownName> {
        UnknownName::find("built-in model", name, ALL, |model| model.name)
    }
}
