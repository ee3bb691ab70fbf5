//! Fits over the inputs of a model if many dimensions drive few inputs.
//!
//! With formulas `z(x)` a characteristic is `y(x) = F(z(x))`. If N dimensions drive m < N inputs, the method runs over `z`, whose moments
//! follow from the formulas. The surface `q(z)` then replaces the model: `q(z(x))` consists of formulas, so that the same method over `x`
//! costs no evaluation. `full` takes `m^2 + m + 1` points instead of `N^2 + N + 1`.
//!
//! If two inputs have a correlation beyond 0.95, the surface is fitted along the principal axes of all inputs.
//!
//! Check points and all later evaluations use the model itself.

use std::sync::Arc;

use crate::assembly::{
    AssemblyFunction, Composite, EvaluationError, Input, ModelInfo, Points, Request, Responses, Run, Signature,
};
use crate::evaluation::{Evaluated, Restoration, Restore, at_any_size};
use crate::method::principal_axes::{Axes, STILL, Turned};
use crate::method::{DerivativeSource, Method, MethodError, Options, Outcome};
use crate::problem::Problem;
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{Distribution, Normal, PearsonLaw};
use sensitol_numeric::power::{Rescale, Rescaling};
use sensitol_numeric::sampling::{Draws, Portion, Sampler, Summary};
use sensitol_numeric::surrogate::Surrogate;

/// Number of points at which the formulas that drive the model are evaluated, for the distribution of its inputs.
const POINTS: usize = 1 << 13;
/// Greatest distance between nominal value and mean, in sigmas, at which the surface is centred at the nominal value.
const NEAR: f64 = 0.01;

/// Problem over the inputs of the model.
pub struct ReducedInputs<'p> {
    composite: &'p Composite,
    /// The problem whose dimensions are the inputs, and whose characteristics are the needed outputs of the model.
    pub problem: Problem,
    needed: Vec<usize>,
    /// Axes along which the surface is fitted, if inputs are nearly proportional.
    axes: Option<Arc<Axes>>,
    /// Number of inputs of the model that vary, or of axes.
    pub inputs: usize,
    /// Number of dimensions that vary.
    pub dimensions: usize,
}

/// Outcome of a method over the inputs of the model. Only surfaces and cost are used.
struct OverInputs(Outcome);

impl Restore for OverInputs {
    fn restore(&mut self, back: &Restoration<'_>) {
        for (c, fitted) in self.0.fitted.iter_mut().enumerate() {
            fitted.surrogate.rescale(&mut Rescaling::by(back.power(c)));
        }
    }
}

/// Result of a fit over the inputs.
pub enum ReducedSurface {
    /// Outcome over the dimensions, with the surface in place of the model.
    Fitted(Box<Outcome>),
    /// Evaluations alone, because an output has no surface or a point has no value.
    Spent(Box<Evaluated>),
}

impl<'p> ReducedInputs<'p> {
    /// Returns the problem over the inputs of the model. Returns None if no model is driven, if its inputs are no fewer than the
    /// dimensions, or if an option concerns the dimensions themselves.
    pub fn of(problem: &'p Problem, options: &Options) -> Option<Self> {
        let composite = problem.function().driven()?;
        // If the model is cheap, `auto` samples it where few points are not enough.
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

    /// Runs the method over the inputs of the model, and again over the dimensions with the surface in place of the model.
    ///
    /// Returns the evaluations alone if an output of the model has no surface, or no value at some point. The method over the dimensions
    /// then reports the failed point, and includes these evaluations in its count.
    pub(crate) fn run(
        &self,
        problem: &Problem,
        options: &Options,
        run: &Run<'_>,
    ) -> Result<ReducedSurface, MethodError> {
        // Outputs of the model may be of extreme size even if the characteristics are not.
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
            return Ok(ReducedSurface::Spent(Box::new(over_inputs.evaluated)));
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
        // The surface replaces the model from here on, so that evaluations cost nothing.
        let method = if options.method == Method::Auto { Method::Full } else { options.method };
        let free = Options { method, budget: None, ..options.clone() };
        let mut outcome = method.procedure().run(&about, &free, &Run::to_the_end())?;
        let (known, gradients) = (outcome.evaluated.known, outcome.evaluated.gradients);
        outcome.evaluated = over_inputs.evaluated;
        (outcome.evaluated.known, outcome.evaluated.gradients) = (known, gradients);
        // The model has a value everywhere, while the formulas about it may fail.
        outcome.evaluated.ledger.run.failed = outcome.evaluated.known.failed_points() as u64;
        outcome.asked = options.method;
        Ok(ReducedSurface::Fitted(Box::new(outcome)))
    }
}

/// Returns an input of the model, with a distribution that has the moments of these values.
fn input(name: &str, nominal: f64, values: &[f64]) -> Option<Dimension> {
    let summary = Summary::of(values);
    let (mean, sigma) = (summary.mean(), summary.sigma());
    if sigma <= STILL * mean.abs() || sigma == 0.0 {
        return Dimension::fixed(name, nominal).ok();
    }
    // The centre of the surface can be chosen. At the nominal value one point serves as centre and as nominal.
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

/// Shared function, so that a problem can own it.
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

/// Surfaces that replace a model.
struct Surface {
    signature: Signature,
    /// Outputs of the model that have a surface.
    outputs: Vec<usize>,
    /// Axes of the inputs along which the surfaces were fitted.
    axes: Option<Arc<Axes>>,
    /// Inputs that vary, with mean and sigma.
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
