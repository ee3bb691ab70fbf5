//! The law of a surface: yields, tails and quantiles that are those of the surface, not of four of its moments.
//!
//! ```text
//! y = c + sum_j g_j(z_j) + sum_{j<k} b_jk z_j z_k        z_j: inputs about their means in units of their sigmas
//! ```
//!
//! has a distribution that follows from the coefficients and the inputs' distributions, without an evaluation of the model.
//! Four moments do not determine it: the Pearson law with the exact moments is off by up to 0.04 in probability for
//! quadratic forms and by factors at 1 ppm. There are three branches, chosen by the structure of the surface:
//!
//! | branch | surfaces | how | error |
//! |---|---|---|---|
//! | [exact](Branch::Exact) | sums of single inputs, trees of products, quadratic forms of normal inputs with any products and correlation | the transform, inverted along a contour through the saddle point | 1e-12 relative, in the tails too; 1e-9 with few inputs and no normal one |
//! | [single](Branch::Single) | one or two inputs | Gauss panels in the one, roots and distribution function of the other | 1e-12 relative |
//! | [sampled](Branch::Sampled) | everything else | one direction by its own distribution function, the others by scrambled Sobol' points, tilted in the tails | from 16 replicates |
//!
//! Every figure comes with its own numerical error. That is the error of the law of this surface: how far the surface is from
//! the model is another question.

mod common_points;
mod complex;
mod contour;
mod derivative;
mod direction;
mod exact;
mod forms;
mod hats;
mod held;
mod input;
mod inversion;
mod joint;
mod panels;
mod perturbed_form;
mod points;
mod polynomial;
mod quadrant;
mod quantile;
mod sampled;
mod single;
mod single_sum;
mod steps;
mod surface;
mod table;
mod tabulated;
mod tilt;
mod transform;
mod tree;
mod zones;

pub use held::HeldTail;
pub use joint::joint_bounds;
pub use joint::joint_yield;
pub use joint::rejected;
pub use points::QUANTILE;
pub use quantile::Sought;
pub use tabulated::TabulatedInput;

use std::sync::{Arc, OnceLock};

use crate::characteristic::{KeptLimits, SpecLimits};
use crate::correlation::Correlation;
use crate::distribution::Distribution;
use crate::power::{Rescale, Rescaling, Unknown};
use crate::surrogate::{Inputs, Surrogate, shapes};

use direction::Direction;
use exact::Exact;
use inversion::Inversion;
use sampled::Sampled;
use single::Single;
use steps::Steps;
use surface::Surface;
use transform::{Summed, Transform};
use zones::{Straightened, Zone, straightened};

/// A number and what its computation leaves uncertain.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct LawFigure {
    /// The number.
    pub value: f64,
    /// Estimated largest numerical error, in the unit of the number; 0 where it is exact.
    pub error: f64,
    /// Whether the number is 0 or 1 because no value of the surface lies beyond the limit, or within it.
    pub proven: bool,
}

impl Unknown for LawFigure {
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

    /// Of points that were counted.
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

/// One end of a distribution.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub enum LawTail {
    /// Below a limit.
    Lower,
    /// Above a limit.
    Upper,
}

impl LawTail {
    /// 1 above, -1 below.
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

/// How a law is computed.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Branch {
    /// The transform inverted along a contour; also lists of values where every input consists of atoms.
    Exact,
    /// One or two inputs: Gauss panels and roots.
    Single,
    /// Points, with one direction integrated.
    Sampled,
}

/// Why a surface has no law.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LawError {
    /// Not as many inputs as parts.
    #[error("a surface of {parts} parts needs as many inputs, not {inputs}")]
    Shapes {
        /// Parts of the surface.
        parts: usize,
        /// Inputs given.
        inputs: usize,
    },
    /// A part that could not be fitted.
    #[error("the surface has no part for input {position}")]
    UnknownPart {
        /// Position of the input.
        position: usize,
    },
    /// An input of which only moments are known.
    #[error("input {position} is known by its moments only, which do not determine the distribution of the surface")]
    MomentsOnly {
        /// Position of the input.
        position: usize,
    },
    /// An input whose tail falls as a power: no panels resolve both it and the middle.
    #[error("input {position} has too long a tail for a transform")]
    LongTail {
        /// Position of the input among those that count.
        position: usize,
    },
    /// A coefficient that is not a finite number.
    #[error("a coefficient of the surface is not a finite number")]
    NotFinite,
    /// A decomposition of a matrix did not converge.
    #[error("the correlated inputs or the products of the surface have no eigenvalues")]
    NoEigenvalues,
    /// The variance is not a finite number above 0 although inputs count.
    #[error("the surface has no finite variance")]
    NoVariance,
}

/// The limits on the cost of a surface's law.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LawOptions {
    /// Points of the sampled branch, in 16 replicates; rounded up to a power of two.
    pub points: usize,
    /// Seed of its points.
    pub seed: u64,
    /// Whether products that form a tree are computed: a limit takes milliseconds, quantiles of quartics of several inputs half a second.
    /// Otherwise they belong to the sampled branch.
    pub trees: bool,
    /// By how much rounding may move a value of the surface; what its own coefficients say where that is more.
    pub rounding: f64,
}

impl Default for LawOptions {
    /// 2^13 points, and trees.
    fn default() -> Self {
        Self { points: 1 << 13, seed: 1, trees: true, rounding: 0.0 }
    }
}

/// The distribution of a surface.
///
/// ```
/// use std::sync::Arc;
/// use crate::distribution::{Distribution, Uniform};
/// use crate::law::{LawOptions, SurfaceLaw};
/// use crate::moments::Interactions;
/// use crate::surrogate::{Surrogate, Univariate};
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
    /// The surface over its own inputs, where the coordinates of a zone have been replaced.
    given: Arc<Surface>,
    zones: Vec<Zone>,
    /// Of the own inputs.
    correlation: Option<Correlation>,
    kind: Kind,
    range: [f64; 2],
    mean: f64,
    sigma: f64,
    step: bool,
    /// By how much rounding may move a value.
    rounding: f64,
    /// The largest probability of a single value that is neither listed nor summed apart; 0 where there is none.
    jump: f64,
}

/// Values with a probability of their own that are summed apart beside a density, at most.
const MOST_JUMPS: usize = 1 << 12;

#[derive(Debug)]
enum Kind {
    /// One value.
    Point(f64),
    Steps(Steps),
    Exact(Box<Exact>),
    Single(Box<Single>),
    Sampled(Box<Sampled>),
}

impl SurfaceLaw {
    /// Of a fitted surface, its inputs' distributions in the order of the parts, and how these vary together.
    ///
    /// Cost: no evaluation of the model. Eigenvalues where normal inputs interact, `O(N^3)`; panels of the other inputs.
    ///
    /// # Errors
    /// When a part of the surface or the distribution of an input that counts is unknown, or a coefficient is not finite.
    pub fn of(
        surrogate: &Surrogate,
        inputs: &[Arc<dyn Distribution>],
        correlation: Option<&Correlation>,
        options: &LawOptions,
    ) -> Result<Self, LawError> {
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
            let step = own.inputs.iter().all(|input| input.is_discrete());
            let (surface, correlation) = (own, correlated);
            Self { surface, given, zones, correlation, kind, range, mean, sigma, step, rounding, jump }
        };
        if surface.len() == 0 {
            let at = surface.centre;
            return Ok(made(Kind::Point(at), [at; 2], [at, 0.0], 0.0));
        }
        let discrete = surface.inputs.iter().all(|input| input.is_discrete());
        let jumps = match steps::atoms(&surface, rounding) {
            Some(values) if discrete => return Ok(Self::step_function(surface, correlation, rounding, values)),
            some => some.filter(|jumps| jumps.len() <= MOST_JUMPS),
        };
        let jump = if jumps.is_some() { 0.0 } else { steps::largest_jump(&surface) };
        let range = surface.range();
        let with = move |kind: Kind, [mean, sigma]: [f64; 2]| match sigma > 0.0 && sigma.is_finite() && mean.is_finite()
        {
            true => Ok(made(kind, range, [mean, sigma], jump)),
            false => Err(LawError::NoVariance),
        };
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

    /// [`of`](Self::of) of inputs that all have values with probabilities of their own, whose sums are few: such as those on a grid, however
    /// many combinations there are. None of anything else.
    ///
    /// Cost: a list of 2^20 values at most, for every component.
    pub fn of_list(
        surrogate: &Surrogate,
        inputs: &[Arc<dyn Distribution>],
        correlation: Option<&Correlation>,
        options: &LawOptions,
    ) -> Option<Self> {
        let surface = Arc::new(Surface::of(surrogate, inputs, correlation).ok()?);
        let rounding = options.rounding.max(KeptLimits::rounding_of(surface.magnitude()));
        let discrete = surface.len() > 0 && surface.inputs.iter().all(|input| input.is_discrete());
        let values = if discrete { steps::atoms(&surface, rounding)? } else { return None };
        Some(Self::step_function(surface, correlation.cloned(), rounding, values))
    }

    fn step_function(
        surface: Arc<Surface>,
        correlation: Option<Correlation>,
        rounding: f64,
        values: Vec<steps::Weighed>,
    ) -> Self {
        let steps = Steps::new(values);
        let ([mean, sigma], range, given) = (steps.moments(), steps.range(), Arc::clone(&surface));
        let (kind, zones) = (Kind::Steps(steps), Vec::new());
        Self { surface, given, zones, correlation, kind, range, mean, sigma, step: true, rounding, jump: 0.0 }
    }

    /// Probability strictly below a limit, so that a limit itself is kept.
    pub fn below(&self, y: f64) -> LawFigure {
        self.tail(y, LawTail::Lower)
    }

    /// Probability strictly above a limit.
    pub fn above(&self, y: f64) -> LawFigure {
        self.tail(y, LawTail::Upper)
    }

    /// Probability strictly beyond a limit, computed as what it is and not as a complement.
    ///
    /// Exactly 0 or 1, and said to be proven, where the limit lies outside of the range. NaN gives NaN. A value that only rounding
    /// separates from the limit is on it.
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
        match &self.kind {
            Kind::Point(_) => LawFigure::proven(0.0),
            Kind::Steps(steps) => steps.tail(y, tail),
            Kind::Exact(exact) => {
                let found = exact.tail(&self.surface, y, tail);
                // A sum over a contour halves a jump at the limit.
                LawFigure { error: found.error + self.jump, ..found }
            }
            Kind::Single(single) => single.tail(y, tail),
            Kind::Sampled(sampled) => sampled.tail(y, tail, self.mean),
        }
    }

    /// The place beyond which a value breaks a limit: farther off than rounding where values have a probability of their own.
    fn beyond(&self, y: f64, tail: LawTail) -> f64 {
        let jumps = self.surface.inputs.iter().all(|input| !input.atoms.is_empty());
        if jumps { y + tail.sign() * self.rounding } else { y }
    }

    /// The limits that values of the surface keep.
    fn kept(&self, limits: SpecLimits) -> KeptLimits {
        KeptLimits::moved(limits, self.rounding)
    }

    /// Density per unit of `y`; 0 where the law is a step function, NaN where points are drawn of which none can be integrated.
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

    /// [`density`](Self::density) for a drawing: where points are drawn, from those of the law itself, which do for where it is visible.
    pub fn drawn_density(&self, y: f64) -> LawFigure {
        let [least, most] = self.range;
        match &self.kind {
            Kind::Sampled(sampled) if y >= least && y <= most && !self.step => sampled.plain_density(y),
            _ => self.density(y),
        }
    }

    /// The limit beyond which this tail has the probability `p`; NaN where `p` is not a probability.
    ///
    /// At 0 the end of the range that the tail points to, which may be infinite; at 1 the other one.
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

    /// Several quantiles at once, each from a place that is nearly right: to 1e-7 sigma, or to a small part of what points leave open.
    ///
    /// Those of one tail share a contour or points. Cost: three or four limits on it for each.
    pub fn quantiles(&self, sought: &[Sought]) -> Vec<LawFigure> {
        quantile::quantiles(self, sought)
    }

    /// The derivatives of a tail's probability by the logarithm of every input's tolerance, at fixed shape: the slope of input
    /// `j` follows its tolerance, a curvature its square, a product both; None where the law is a step function.
    ///
    /// ```text
    /// exact             d sf/d log T_j = 1/pi int Re[ exp(K - s y)/s dK/d log T_j ] dt
    /// single, sampled   d sf/d log T_j = E[ sum_roots f(w) z_j dy/dz_j / |dy/dw| ]
    /// ```
    ///
    /// Shapes: as many as the surrogate has parts; 0 for an input that does not count. Cost: about that of one limit for each
    /// input of the exact branch, one sample for all of them in the others.
    pub fn tail_derivatives(&self, y: f64, tail: LawTail) -> Option<Vec<LawFigure>> {
        derivative::tail_derivatives(self, y, tail)
    }

    /// The contour, points and proposals with which this tail is computed, to compute those of other laws of the same
    /// structure with them: their figures then are smooth in the coefficients.
    pub fn hold(&self, y: f64, tail: LawTail) -> HeldTail {
        HeldTail::of(self, y, tail)
    }

    /// How the law is computed.
    pub fn branch(&self) -> Branch {
        match self.kind {
            Kind::Point(_) | Kind::Steps(_) | Kind::Exact(_) => Branch::Exact,
            Kind::Single(_) => Branch::Single,
            Kind::Sampled(_) => Branch::Sampled,
        }
    }

    /// Whether all inputs consist of atoms, so that probabilities jump from value to value and there is no density.
    pub fn is_step_function(&self) -> bool {
        self.step
    }

    /// An interval that no value of the surface leaves; infinite where there is no bound.
    ///
    /// Without products it is the range itself. With products it may be wider.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// The mean of the law.
    pub fn mean(&self) -> f64 {
        self.mean
    }

    /// Its standard deviation.
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
