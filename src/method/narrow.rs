//! Fitting on the narrower side: where many dimensions drive few inputs of a model, the surface is fitted over these inputs.
//!
//! With formulas `z(x)` a characteristic is `y(x) = F(z(x))`. Where N dimensions drive m < N inputs, the method runs over `z`, whose moments
//! follow from the formulas, and its surface `q(z)` stands for the model: `q(z(x))` is made of formulas, and the same method over `x` then
//! costs no evaluation. `full` takes `m^2 + m + 1` points in the place of `N^2 + N + 1`.
//!
//! Where two inputs are nearly alike (a correlation beyond 0.95), the surface is fitted along the principal axes of all of them.
//!
//! Check points, and whatever else looks at the result, ask the model itself.

use std::sync::Arc;

use super::principal::{Axes, STILL, Turned};
use super::{DerivativeSource, Method, MethodError, Options, Outcome};
use crate::assembly::{
    AssemblyFunction, Composite, EvaluationError, Input, ModelInfo, Points, Request, Responses, Run, Signature,
};
use crate::evaluation::{Evaluated, Restoration, Restore, at_any_size};
use crate::problem::Problem;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{Distribution, Normal, PearsonLaw};
use sensitol_numeric::power::{Rescale, Rescaling};
use sensitol_numeric::sampling::{Draws, Portion, Sampler, Summary};
use sensitol_numeric::surrogate::Surrogate;

/// Points at which the formulas that drive the model are evaluated, to know how its inputs vary.
const POINTS: usize = 1 << 13;
/// A nominal value so near to the mean, in sigmas, is where the surface is centred.
const NEAR: f64 = 0.01;

/// The problem over the inputs of the model.
pub struct Narrow<'p> {
    composite: &'p Composite,
    /// Its characteristics are the outputs of the model that are needed.
    pub problem: Problem,
    needed: Vec<usize>,
    /// The axes along which it is fitted, where inputs vary nearly alike.
    axes: Option<Arc<Axes>>,
    /// How many inputs of the model vary, or along how many axes, and how many dimensions.
    pub inputs: usize,
    pub dimensions: usize,
}

/// The outcome of a method over the inputs of the model, of which the surfaces and the cost are read.
struct OverInputs(Outcome);

impl Restore for OverInputs {
    fn restore(&mut self, back: &Restoration<'_>) {
        for (c, fitted) in self.0.fitted.iter_mut().enumerate() {
            fitted.surrogate.rescale(&mut Rescaling::by(back.power(c)));
        }
    }
}

/// A surface over the inputs, or none.
pub enum Narrowed {
    Fitted(Box<Outcome>),
    /// Nothing but evaluations.
    Spent(Box<Evaluated>),
}

impl<'p> Narrow<'p> {
    /// None where no model is driven, its inputs are no fewer than the dimensions, or the options want something of the
    /// dimensions themselves.
    pub fn of(problem: &'p Problem, options: &Options) -> Option<Self> {
        let composite = problem.function().driven()?;
        // Of a model that costs nothing `auto` samples what it does not find in few points.
        let samples = options.method == Method::Auto && !problem.function().signature().costly;
        let suits =
            !samples && matches!(options.method, Method::SecondOrder | Method::SixN | Method::Full | Method::Auto);
        let plain = options.step.is_none() && options.pairs.is_none() && options.stencil.is_none();
        let plain = plain && options.derivatives != Some(DerivativeSource::Exact) && !options.all_sensitivities;
        if !suits || !plain {
            return None;
        }
        let dependence = problem.dependence();
        let varies = |d: usize| problem.dimensions()[d].sigma() > 0.0 && dependence.iter().any(|row| row[d]);
        let dimensions = (0..problem.dimensions().len()).filter(|&d| varies(d)).count();
        let (model, needed) = composite.inner(problem.outputs())?;
        let model = problem.magnitudes().map_or_else(|| Arc::clone(&model), |of| of.remembering(Arc::clone(&model)));
        let names: Vec<String> = model.signature().inputs.iter().map(|input| input.name.clone()).collect();
        if needed.is_empty() || names.is_empty() {
            return None;
        }
        let sampler =
            if dimensions <= sensitol_numeric::sampling::SOBOL_DIMENSIONS { Sampler::Sobol } else { Sampler::Random };
        let draws = Draws::new(problem.dimensions(), problem.correlation(), sampler, Options::SEED).ok()?;
        let sent = composite.drivers(&draws.points(Portion { replicate: 0, first: 0, rows: POINTS }))?;
        let nominal: Vec<f64> = problem.dimensions().iter().map(|dimension| dimension.nominal()).collect();
        let nominal = composite.drivers(&Points::from_rows(&[nominal]))?;
        let axes = Axes::of(&sent, &nominal.row(0)).map(Arc::new);
        let (names, model): (Vec<String>, Arc<dyn AssemblyFunction>) = match &axes {
            None => (names, model),
            Some(axes) => {
                let names: Vec<String> = (1..=axes.directions()).map(|axis| format!("axis {axis}")).collect();
                let turned = Turned::new(model, Arc::clone(axes), &names);
                (names, Arc::new(turned))
            }
        };
        let [sent, nominal] = [sent, nominal].map(|points| match &axes {
            None => points,
            Some(axes) => axes.inward(&points),
        });
        let inputs: Vec<Dimension> = (names.iter().enumerate())
            .map(|(index, name)| input(name, nominal.column(index)[0], sent.column(index)))
            .collect::<Option<_>>()?;
        let varying = inputs.iter().filter(|input| input.sigma() > 0.0).count();
        if varying == 0 || varying >= dimensions {
            return None;
        }
        let outputs = &model.signature().outputs;
        let asked: Vec<Characteristic> =
            needed.iter().map(|&output| Characteristic::new(&outputs[output].name)).collect();
        let narrow = Problem::new(inputs, Passed(model)).ok()?.asking(asked).ok()?;
        Some(Self { composite, problem: narrow, needed, axes, inputs: varying, dimensions })
    }

    /// Runs the method over the inputs of the model, and again over the dimensions with the surface in the place of the model.
    ///
    /// Not where an output of the model has no surface, or no value at some point: the method over the dimensions then says at which of
    /// them, and what this one has spent is counted there.
    pub(crate) fn run(&self, problem: &Problem, options: &Options, run: &Run<'_>) -> Result<Narrowed, MethodError> {
        // Outputs of the model may be of extreme size where the characteristics are not.
        let over_inputs = at_any_size(&self.problem, run, |problem, run| {
            options.method.procedure().run(problem, options, run).map(OverInputs)
        });
        let OverInputs(over_inputs) = over_inputs?;
        let varying = over_inputs.plan.varying();
        let surrogates: Option<Vec<Surrogate>> = (over_inputs.fitted.iter())
            .map(|fitted| fitted.surrogate.clone().filter(|of| of.parts.iter().all(Option::is_some)))
            .collect();
        let failed = over_inputs.evaluated.known.errors().next().is_some();
        let Some(surrogates) = surrogates.filter(|_| !failed) else {
            return Ok(Narrowed::Spent(Box::new(over_inputs.evaluated)));
        };
        let place = |&d: &usize| {
            let input = &self.problem.dimensions()[d];
            (d, input.mean(), input.sigma())
        };
        let (model, _) = self.composite.inner(problem.outputs()).expect("a model that is driven");
        let surface = Surface {
            signature: Signature { costly: false, cheap: false, ..model.signature().clone() },
            outputs: self.needed.clone(),
            axes: self.axes.clone(),
            varying: varying.iter().map(place).collect(),
            surrogates,
        };
        let about = problem.with_undivided(Arc::new(self.composite.about(Arc::new(surface))));
        // Nothing that is evaluated now costs anything.
        let method = if options.method == Method::Auto { Method::Full } else { options.method };
        let free = Options { method, budget: None, ..options.clone() };
        let mut outcome = method.procedure().run(&about, &free, &Run::to_the_end())?;
        let (known, gradients) = (outcome.evaluated.known, outcome.evaluated.gradients);
        outcome.evaluated = over_inputs.evaluated;
        (outcome.evaluated.known, outcome.evaluated.gradients) = (known, gradients);
        outcome.asked = options.method;
        Ok(Narrowed::Fitted(Box::new(outcome)))
    }
}

/// An input of the model by its nominal value and the moments of its values.
fn input(name: &str, nominal: f64, values: &[f64]) -> Option<Dimension> {
    let summary = Summary::of(values);
    let (mean, sigma) = (summary.mean(), summary.sigma());
    if sigma <= STILL * mean.abs() || sigma == 0.0 {
        return Dimension::fixed(name, nominal).ok();
    }
    // The middle of the surface is a choice: one point is centre and nominal then.
    let mean = if (mean - nominal).abs() < NEAR * sigma { nominal } else { mean };
    let moments = summary.standardised()?;
    let fitted =
        PearsonLaw::new(mean, sigma, moments[3], moments[4] - 3.0).ok().filter(|law| law.probability().is_some());
    let law: Arc<dyn Distribution> = match fitted {
        Some(law) => Arc::new(law),
        None => Arc::new(Normal::new(mean, sigma).ok()?),
    };
    Dimension::distributed(name, nominal, None, law).ok()
}

/// A function that belongs to another one too.
struct Passed(Arc<dyn AssemblyFunction>);

impl AssemblyFunction for Passed {
    fn signature(&self) -> &Signature {
        self.0.signature()
    }

    fn prepare(&self, outputs: &[usize]) -> Result<Option<ModelInfo>, EvaluationError> {
        self.0.prepare(outputs)
    }

    fn evaluate(&self, request: &Request<'_>, run: &Run<'_>, out: &mut Responses) {
        self.0.evaluate(request, run, out);
    }

    fn sent(&self, points: &Points) -> Option<(Vec<Input>, Points)> {
        self.0.sent(points)
    }
}

/// Surfaces in the place of a model.
struct Surface {
    signature: Signature,
    /// The outputs of the model that have one.
    outputs: Vec<usize>,
    /// The axes of its inputs along which it was fitted.
    axes: Option<Arc<Axes>>,
    /// The inputs that vary, with mean and sigma.
    varying: Vec<(usize, f64, f64)>,
    surrogates: Vec<Surrogate>,
}

impl AssemblyFunction for Surface {
    fn signature(&self) -> &Signature {
        &self.signature
    }

    fn evaluate(&self, request: &Request<'_>, _: &Run<'_>, out: &mut Responses) {
        let along = self.axes.as_ref().map(|axes| axes.inward(request.points));
        let points: &Points = along.as_ref().unwrap_or(request.points);
        let column = |&(d, mean, sigma): &(usize, f64, f64)| -> Vec<f64> {
            points.column(d).iter().map(|x| (x - mean) / sigma).collect()
        };
        let columns: Vec<Vec<f64>> = self.varying.iter().map(column).collect();
        for (column, output) in request.outputs.iter().enumerate() {
            let found = self.outputs.binary_search(output).ok().map(|place| &self.surrogates[place]);
            let rises = found.and_then(|surrogate| Some((surrogate.centre, surrogate.rises(&columns)?)));
            for row in 0..points.rows() {
                match &rises {
                    Some((centre, rises)) => out.set(row, column, centre + rises[row]),
                    None => out.fail(row, column, EvaluationError::NotFinite { value: f64::NAN }),
                }
            }
        }
    }
}
