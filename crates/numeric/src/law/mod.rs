//! Distribution of a surface: yields, tails and quantiles of the surface itself instead of those of its four moments.
//!
//! ```text
//! y = c + sum_j g_j(z_j) + sum_{j<k} b_jk z_j z_k        z_j: inputs about their means in units of their sigmas
//! ```
//!
//! This surface has a distribution that follows from the coefficients and the inputs' distributions, without an evaluation of the model.
//! Four moments do not determine it. The Pearson distribution with the exact moments is off by up to 0.04 in probability for quadratic
//! forms and by factors at 1 ppm. The structure of the surface selects one of three branches:
//!
//! | branch | surfaces | how | error |
//! |---|---|---|---|
//! | [exact](Branch::Exact) | sums of single inputs, trees of products, quadratic forms of normal inputs with any products and correlation | the transform, inverted along a contour through the saddle point | 1e-12 relative, in the tails too; 1e-9 with few inputs and no normal one |
//! | [single](Branch::Single) | one or two inputs | Gauss panels in the one, roots and distribution function of the other | 1e-12 relative |
//! | [sampled](Branch::Sampled) | everything else | one direction by its own distribution function, the others by scrambled Sobol' points, tilted in the tails | from 16 replicates |
//!
//! Every figure comes with its own numerical error. This is the error for the given surface. The difference between surface and model is
//! not included.

mod common_points;
mod direction;
mod discrete_law;
mod exponential_tilt;
mod input;
mod input_table;
mod inversion;
mod inverted_law;
mod joint_yield;
mod panels;
mod planar_zone;
mod polynomial;
mod quadrant;
mod quantile;
mod sampled_law;
mod sampled_points;
mod surface;
mod tail_choices;
mod tail_derivative;
mod tail_table;
mod two_inputs;

pub use crate::law::input_table::TabulatedInput;
pub use crate::law::joint_yield::joint_bounds;
pub use crate::law::joint_yield::joint_yield;
pub use crate::law::joint_yield::rejected;
pub use crate::law::sampled_points::QUANTILE;
pub use crate::law::tail_choices::TailChoices;
pub use quantile::Sought;

use std::sync::{Arc, OnceLock};

use serde::Serialize;

use crate::capability::TAIL;
use crate::characteristic::{KeptLimits, SpecLimits};
use crate::correlation::Correlation;
use crate::distribution::Distribution;
use crate::power::{Losable, Rescale, Rescaling};
use crate::surrogate::{Inputs, Surrogate, shapes};

use crate::law::discrete_law::Steps;
use crate::law::inversion::tail_inversion::Inversion;
use crate::law::inversion::transform::{Summed, Transform};
use crate::law::inverted_law::Exact;
use crate::law::planar_zone::{Straightened, Zone, straightened};
use crate::law::sampled_law::Sampled;
use crate::law::two_inputs::Single;
use direction::Direction;
use surface::Surface;

/// Computed number with its numerical error.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LawFigure {
    /// Computed number.
    pub value: f64,
    /// Estimated largest numerical error, in the unit of the number; 0 if it is exact.
    pub error: f64,
    /// True if the number is 0 or 1 because no value of the surface lies beyond the limit, or none within it.
    pub proven: bool,
}

impl Losable for LawFigure {
    fn is_unknown(&self) -> bool {
        self.value.is_nan()
    }
}

impl Rescale for LawFigure {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.value.rescale(by);
        self.error.rescale(by);
    }
}

impl LawFigure {
    const fn new(value: f64, error: f64) -> Self {
        Self { value, error, proven: false }
    }

    const fn proven(value: f64) -> Self {
        Self { value, error: 0.0, proven: true }
    }

    /// Figure from counted points.
    pub const fn counted(value: f64, error: f64) -> Self {
        Self::new(value, error)
    }

    fn complement(self) -> Self {
        Self { value: 1.0 - self.value, ..self }
    }

    fn clamped(self) -> Self {
        Self { value: self.value.clamp(0.0, 1.0), ..self }
    }
}

/// One tail of a distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LawTail {
    /// Values below a limit.
    Lower,
    /// Values above a limit.
    Upper,
}

/// Probabilities of the quantiles in reports, lowest first, each with the tail that it leaves.
pub const REPORTED_QUANTILES: [(LawTail, f64); 7] = [
    (LawTail::Lower, TAIL),
    (LawTail::Lower, 0.01),
    (LawTail::Lower, 0.05),
    (LawTail::Lower, 0.5),
    (LawTail::Upper, 0.05),
    (LawTail::Upper, 0.01),
    (LawTail::Upper, TAIL),
];

impl LawTail {
    /// Returns 1 for the upper tail, -1 for the lower one.
    pub fn sign(self) -> f64 {
        match self {
            Self::Lower => -1.0,
            Self::Upper => 1.0,
        }
    }

    fn other(self) -> Self {
        match self {
            Self::Lower => Self::Upper,
            Self::Upper => Self::Lower,
        }
    }
}

/// Method that computes the distribution of a surface.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Branch {
    /// Transform inverted along a contour. If every input consists of atoms, a list of values.
    Exact,
    /// One or two inputs: Gauss panels and roots.
    Single,
    /// Sampled points, with one direction integrated.
    Sampled,
}

/// Reason why a surface has no distribution.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// The number of inputs differs from the number of parts.
    #[error("a surface of {parts} parts needs as many inputs, not {inputs}")]
    Shapes {
        /// Parts of the surface.
        parts: usize,
        /// Inputs given.
        inputs: usize,
    },
    /// A part of the surface could not be fitted.
    #[error("the surface has no part for input {position}")]
    UnknownPart {
        /// Position of the input.
        position: usize,
    },
    /// Only the moments of an input are known.
    #[error("input {position} is known by its moments only, which do not determine the distribution of the surface")]
    MomentsOnly {
        /// Position of the input.
        position: usize,
    },
    /// The tail of an input falls so slowly that no panels resolve both it and the middle.
    #[error("input {position} has too long a tail for a transform")]
    LongTail {
        /// Position of the input among those with a part in the surface.
        position: usize,
    },
    /// A coefficient is not a finite number.
    #[error("a coefficient of the surface is not a finite number")]
    NotFinite,
    /// A decomposition of a matrix did not converge.
    #[error("the correlated inputs or the products of the surface have no eigenvalues")]
    NoEigenvalues,
    /// The variance is not a finite number above 0 although the surface depends on inputs.
    #[error("the surface has no finite variance")]
    NoVariance,
}

/// Options that bound the cost of a surface distribution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawOptions {
    /// Number of points if the distribution is sampled, in 16 replicates; rounded up to a power of two.
    pub points: usize,
    /// Seed of the points of the sampled branch.
    pub seed: u64,
    /// True if products that form a tree are inverted exactly. A limit then takes milliseconds, and quantiles of quartics of several inputs
    /// take half a second. If false, such surfaces belong to the sampled branch.
    pub trees: bool,
    /// Rounding error of a value of the surface. If the estimate from the surface's own coefficients is larger, that one is used.
    pub rounding: f64,
}

impl Default for LawOptions {
    /// Options with 2^13 points and with trees.
    fn default() -> Self {
        Self { points: 1 << 13, seed: 1, trees: true, rounding: 0.0 }
    }
}

/// Distribution of a surface.
///
/// ```
/// use std::sync::Arc;
/// use sensitol_numeric::distribution::{Distribution, Uniform};
/// use sensitol_numeric::law::{LawOptions, SurfaceLaw};
/// use sensitol_numeric::moments::Interactions;
/// use sensitol_numeric::surrogate::{Surrogate, Univariate};
/// // Three uniform inputs: the probability beyond a limit d below the greatest value sqrt(27) is d^3/(6 (2 sqrt 3)^3).
/// let uniform: Arc<dyn Distribution> = Arc::new(Uniform::new(-1.0, 1.0)?);
/// let parts = vec![Some(Univariate::of_coefficients(&[1.0])); 3];
/// let surrogate = Surrogate { centre: 0.0, parts, interactions: Interactions::none(3) };
/// let law = SurfaceLaw::of(&surrogate, &vec![uniform; 3], None, &LawOptions::default())?;
/// let found = law.above(27f64.sqrt() - 0.1);
/// let exact = 0.1f64.powi(3) / 6.0 / 12f64.powf(1.5);
/// assert!((found.value - exact).abs() <= found.error && found.error < 1e-8 * exact);
/// // Beyond the greatest value nothing lies.
/// assert!(law.above(5.2).value == 0.0 && law.above(5.2).proven);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct SurfaceLaw {
    surface: Arc<Surface>,
    /// Surface over its own inputs. It differs from `surface` if the coordinates of a zone were replaced.
    given: Arc<Surface>,
    zones: Vec<Zone>,
    /// Correlation of the own inputs.
    correlation: Option<Correlation>,
    kind: Kind,
    range: [f64; 2],
    mean: f64,
    sigma: f64,
    step: bool,
    /// Rounding error of a value of the surface.
    rounding: f64,
    /// Largest probability of a single value that is neither listed nor summed separately; 0 if there is none.
    jump: f64,
    /// Distance from the edge of a cluster of values within which a tail is not resolved. None if clusters are wide, or if there are none.
    blur: Option<f64>,
}

/// Greatest number of values with a probability of their own that are summed separately beside a density.
const MOST_JUMPS: usize = 1 << 12;

#[derive(Debug)]
enum Kind {
    /// Single value of a constant surface.
    Point(f64),
    Steps(Steps),
    Exact(Box<Exact>),
    Single(Box<Single>),
    Sampled(Box<Sampled>),
}

impl SurfaceLaw {
    /// Distribution of a fitted surface. `inputs` are in the order of its parts, `correlation` describes how they vary together.
    ///
    /// Cost: no evaluation of the model; eigenvalues if normal inputs interact, `O(N^3)`; panels of the other inputs.
    ///
    /// # Errors
    /// Returns an error if a part of the surface or the distribution of an input with a part is unknown, or if a coefficient is not finite.
    pub fn of(
        surrogate: &Surrogate,
        inputs: &[Arc<dyn Distribution>],
        correlation: Option<&Correlation>,
        options: &LawOptions,
    ) -> Result<Self, LawError> {
        // Replace the coordinates of zones by independent inputs where the surface allows it, and remember the given surface.
        if let Some(Straightened { surrogate: plain, inputs: others, correlation: left, zones }) =
            straightened(surrogate, inputs, correlation)
        {
            let given = Arc::new(Surface::of(surrogate, inputs, correlation)?);
            let law = Self::of(&plain, &others, left.as_ref(), options)?;
            return Ok(Self { given, zones, correlation: correlation.cloned(), ..law });
        }
        let surface = Arc::new(Surface::of(surrogate, inputs, correlation)?);
        let (given, zones) = (Arc::clone(&surface), Vec::new());
        let correlation = correlation.cloned();
        let rounding = options.rounding.max(KeptLimits::rounding_of(surface.magnitude()));
        let own = Arc::clone(&surface);
        let correlated = correlation.clone();
        let made = move |kind: Kind, range: [f64; 2], [mean, sigma]: [f64; 2], jump: f64| {
            let blur = crate::law::discrete_law::blur(&own, sigma);
            let step = own.inputs.iter().all(|input| input.is_discrete());
            let (surface, correlation) = (own, correlated);
            Self { surface, given, zones, correlation, kind, range, mean, sigma, step, rounding, jump, blur }
        };
        if surface.len() == 0 {
            let at = surface.centre;
            return Ok(made(Kind::Point(at), [at; 2], [at, 0.0], 0.0));
        }
        // Inputs that all consist of atoms give a list of values. Beside a density a few such values are summed separately.
        let discrete = surface.inputs.iter().all(|input| input.is_discrete());
        let jumps = match crate::law::discrete_law::atoms(&surface, rounding) {
            Some(values) if discrete => return Ok(Self::step_function(surface, correlation, rounding, values)),
            some => some.filter(|jumps| jumps.len() <= MOST_JUMPS),
        };
        let jump = if jumps.is_some() { 0.0 } else { crate::law::discrete_law::largest_jump(&surface) };
        let range = surface.range();
        let with = move |kind: Kind, [mean, sigma]: [f64; 2]| match sigma > 0.0 && sigma.is_finite() && mean.is_finite()
        {
            true => Ok(made(kind, range, [mean, sigma], jump)),
            false => Err(LawError::NoVariance),
        };
        // One or two inputs take panels and roots, unless a pair is a quadratic form of normal inputs, which is exact.
        let parabolas = (0..surface.len()).all(|j| surface.is_normal_parabola(j));
        if surface.len() <= 2 && !(parabolas && surface.len() == 2) {
            let members: Vec<usize> = (0..surface.len()).collect();
            if let Some(single) = Direction::of(&surface, &members).and_then(Single::of) {
                return with(Kind::Single(Box::new(single)), moments(surrogate, inputs, correlation.as_ref())?);
            }
        }
        if let Some(position) = surface.inputs.iter().position(|input| input.falls_as_a_power()) {
            return Err(LawError::LongTail { position });
        }
        // Invert the transform. If nodes do not resolve it, keep only single inputs in it and sample the other components.
        let components = surface.components();
        let summed = if options.trees { Summed::Trees } else { Summed::Perturbed };
        let jumps = jumps.unwrap_or_default();
        let inverted = |summed: Summed| {
            let (transform, left) = Transform::of(&surface, &components, summed);
            (Inversion::new(transform, surface.centre).with_jumps(jumps.iter().copied()), left)
        };
        let (mut inversion, mut left) = inverted(summed);
        if !inversion.is_resolved() {
            (inversion, left) = inverted(Summed::Singles);
        }
        if left.is_empty() {
            let moments = [inversion.mean(), inversion.sigma()];
            let exact = Exact { inversion, points: OnceLock::new(), options: *options };
            return with(Kind::Exact(Box::new(exact)), moments);
        }
        let [mean, sigma] = moments(surrogate, inputs, correlation.as_ref())?;
        let sampled =
            Sampled::of(&surface, inversion.transform, &left, sigma, options).ok_or(LawError::NoEigenvalues)?;
        with(Kind::Sampled(Box::new(sampled)), [mean, sigma])
    }

    /// List form of [`of`](Self::of), for inputs that all have values with probabilities of their own and few different sums, as on a grid.
    /// The number of combinations does not matter. Returns None for all other inputs.
    ///
    /// Cost: a list of at most 2^20 values for every component.
    pub fn of_list(
        surrogate: &Surrogate,
        inputs: &[Arc<dyn Distribution>],
        correlation: Option<&Correlation>,
        options: &LawOptions,
    ) -> Option<Self> {
        let surface = Arc::new(Surface::of(surrogate, inputs, correlation).ok()?);
        let rounding = options.rounding.max(KeptLimits::rounding_of(surface.magnitude()));
        let discrete = surface.len() > 0 && surface.inputs.iter().all(|input| input.is_discrete());
        let values = if discrete { crate::law::discrete_law::atoms(&surface, rounding)? } else { return None };
        Some(Self::step_function(surface, correlation.cloned(), rounding, values))
    }

    fn step_function(
        surface: Arc<Surface>,
        correlation: Option<Correlation>,
        rounding: f64,
        values: Vec<crate::law::discrete_law::Weighed>,
    ) -> Self {
        let steps = Steps::new(values);
        let ([mean, sigma], range, given) = (steps.moments(), steps.range(), Arc::clone(&surface));
        let (kind, zones) = (Kind::Steps(steps), Vec::new());
        Self {
            surface,
            given,
            zones,
            correlation,
            kind,
            range,
            mean,
            sigma,
            step: true,
            rounding,
            jump: 0.0,
            blur: None,
        }
    }

    /// Probability strictly below a limit. A value on the limit keeps it.
    pub fn below(&self, y: f64) -> LawFigure {
        self.tail(y, LawTail::Lower)
    }

    /// Probability strictly above a limit. A value on the limit keeps it.
    pub fn above(&self, y: f64) -> LawFigure {
        self.tail(y, LawTail::Upper)
    }

    /// Probability strictly beyond a limit, computed directly and not as a complement.
    ///
    /// The result is exactly 0 or 1, and marked as proven, if the limit lies outside the range. NaN gives NaN. A value that differs from
    /// the limit by no more than rounding counts as on it.
    pub fn tail(&self, y: f64, tail: LawTail) -> LawFigure {
        if y.is_nan() {
            return LawFigure::new(f64::NAN, f64::INFINITY);
        }
        let y = self.beyond(y, tail);
        let [least, most] = self.range;
        let (outside, whole) = match tail {
            LawTail::Lower => (y <= least, y > most),
            LawTail::Upper => (y >= most, y < least),
        };
        if outside || whole {
            return LawFigure::proven(f64::from(u8::from(whole)));
        }
        let found = self.inner_tail(y, tail);
        let Some(blur) = self.blur else { return found };
        // The tail falls outward, so that it lies between those on both sides of a cluster.
        let [inward, outward] = [-blur, blur].map(|off| self.inner_tail(y + tail.sign() * off, tail));
        LawFigure { error: found.error.max(inward.value - outward.value), ..found }
    }

    /// Tail at a limit inside the range.
    fn inner_tail(&self, y: f64, tail: LawTail) -> LawFigure {
        match &self.kind {
            Kind::Point(_) => LawFigure::proven(0.0),
            Kind::Steps(steps) => steps.tail(y, tail),
            Kind::Exact(exact) => {
                let found = exact.tail(&self.surface, y, tail);
                // A sum along a contour halves a jump at the limit.
                LawFigure { error: found.error + self.jump, ..found }
            }
            Kind::Single(single) => single.tail(y, tail),
            Kind::Sampled(sampled) => sampled.tail(y, tail, self.mean),
        }
    }

    /// Value beyond which a limit is exceeded. It is moved outward by the rounding error if values have probabilities of their own.
    fn beyond(&self, y: f64, tail: LawTail) -> f64 {
        let jumps = self.surface.inputs.iter().all(|input| !input.atoms.is_empty());
        if jumps { y + tail.sign() * self.rounding } else { y }
    }

    /// Limits with the rounding error of the surface allowed.
    fn kept(&self, limits: SpecLimits) -> KeptLimits {
        KeptLimits::moved(limits, self.rounding)
    }

    /// Density per unit of `y`. It is 0 if the law is a step function, and NaN if points are sampled and no direction can be integrated.
    pub fn density(&self, y: f64) -> LawFigure {
        let [least, most] = self.range;
        if y.is_nan() {
            return LawFigure::new(f64::NAN, f64::INFINITY);
        }
        if self.step || y < least || y > most {
            return LawFigure::proven(0.0);
        }
        match &self.kind {
            Kind::Point(_) | Kind::Steps(_) => LawFigure::proven(0.0),
            Kind::Exact(exact) => exact.density(&self.surface, y),
            Kind::Single(single) => single.density(y),
            Kind::Sampled(sampled) => sampled.density(y, self.mean),
        }
    }

    /// [`density`](Self::density) for a drawing. The sampled branch uses untilted points, which suffice where the density is visible.
    pub fn drawn_density(&self, y: f64) -> LawFigure {
        let [least, most] = self.range;
        match &self.kind {
            Kind::Sampled(sampled) if y >= least && y <= most && !self.step => sampled.plain_density(y),
            _ => self.density(y),
        }
    }

    /// Limit beyond which this tail has the probability `p`. Returns NaN if `p` is not a probability.
    ///
    /// `p` of 0 gives the end of the range on the side of the tail, which may be infinite; `p` of 1 gives the other end.
    pub fn quantile(&self, tail: LawTail, p: f64) -> LawFigure {
        if !(0.0..=1.0).contains(&p) {
            return LawFigure::new(f64::NAN, f64::INFINITY);
        }
        if let Kind::Point(at) = self.kind {
            return LawFigure::new(at, 0.0);
        }
        if let Kind::Steps(steps) = &self.kind {
            return LawFigure::new(steps.quantile(tail, p), 0.0);
        }
        let [least, most] = self.range;
        if p == 0.0 || p == 1.0 {
            let upper = (tail == LawTail::Upper) == (p == 0.0);
            return LawFigure::new(if upper { most } else { least }, 0.0);
        }
        match p <= 0.5 {
            true => quantile::quantile(self, tail, p),
            false => quantile::quantile(self, tail.other(), 1.0 - p),
        }
    }

    /// Several quantiles at once, each from an approximate starting value. The error is 1e-7 sigma, or a small part of the sampling error.
    ///
    /// Quantiles of one tail share a contour or points. Cost: three or four limits on it for each.
    pub fn quantiles(&self, sought: &[Sought]) -> Vec<LawFigure> {
        quantile::quantiles(self, sought)
    }

    /// Derivatives of a tail's probability by the logarithm of every input's tolerance, at fixed shape. The slope of input `j` scales with
    /// its tolerance, a curvature with the square, a product with both tolerances. Returns None if the law is a step function.
    ///
    /// ```text
    /// exact             d sf/d log T_j = 1/pi int Re[ exp(K - s y)/s dK/d log T_j ] dt
    /// single, sampled   d sf/d log T_j = E[ sum_roots f(w) z_j dy/dz_j / |dy/dw| ]
    /// ```
    ///
    /// The result has one entry for each part of the surrogate, 0 for an input without a part. Cost: about one limit for each input in the
    /// exact branch, one sample for all of them in the others.
    pub fn tail_derivatives(&self, y: f64, tail: LawTail) -> Option<Vec<LawFigure>> {
        crate::law::tail_derivative::tail_derivatives(self, y, tail)
    }

    /// Contour, points and proposals of this tail. Tails of other laws of the same structure that are computed with them are smooth in the
    /// coefficients.
    pub fn hold(&self, y: f64, tail: LawTail) -> TailChoices {
        TailChoices::of(self, y, tail)
    }

    /// Branch by which the distribution is computed.
    pub fn branch(&self) -> Branch {
        match self.kind {
            Kind::Point(_) | Kind::Steps(_) | Kind::Exact(_) => Branch::Exact,
            Kind::Single(_) => Branch::Single,
            Kind::Sampled(_) => Branch::Sampled,
        }
    }

    /// True if all inputs consist of atoms. Probabilities then jump from value to value and there is no density.
    pub fn is_step_function(&self) -> bool {
        self.step
    }

    /// Interval that contains every value of the surface; infinite if there is no bound.
    ///
    /// Without products it is the exact range. With products it may be wider.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Mean of the surface.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Standard deviation of the surface.
    pub fn sigma(&self) -> f64 {
        self.sigma
    }
}

/// Mean and sigma of a surface.
fn moments(
    surrogate: &Surrogate,
    inputs: &[Arc<dyn Distribution>],
    correlation: Option<&Correlation>,
) -> Result<[f64; 2], LawError> {
    let inputs = Inputs::new(shapes(inputs.iter().map(|law| law.as_ref())), correlation.cloned());
    let found = surrogate.contributions(&inputs).ok_or(LawError::NoVariance)?;
    Ok([found.moments.mean(), found.moments.sigma()])
}
