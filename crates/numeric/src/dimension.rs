//! Dimension: one input of the assembly function, with its tolerance and its distribution.

use std::sync::Arc;

use crate::distribution::{Distribution, DistributionError, Normal, Uniform, finite, positive};
use crate::fits::FixedEnd;
use crate::labels::Labels;

/// Half-width of a dimension without a tolerance band, in sigmas: it replaces the band in RSS and worst case.
const SIGMAS_OF_AN_UNBOUNDED_DIMENSION: f64 = 3.0;

/// One input of the assembly function: a name, a nominal value, and a distribution.
///
/// ```
/// use sensitol_numeric::dimension::Dimension;
/// let a = Dimension::normal("a", 10.0, 0.3)?.with_unit("mm");
/// assert_eq!((a.mean(), a.sigma(), a.half_band()), (10.0, 0.3 / 3.0, 0.3));
/// let b = Dimension::normal_between("b", 30.0, [-0.1, 0.3])?; // the band's middle is the mean
/// assert!((b.mean() - 30.1).abs() < 1e-12 && (b.half_band() - 0.2).abs() < 1e-15);
/// # Ok::<(), sensitol_numeric::dimension::DimensionError>(())
/// ```
#[derive(Debug, Clone)]
pub struct Dimension {
    name: String,
    unit: Option<String>,
    nominal: f64,
    /// Deviations from the nominal, not limits: at 1e10 ± 1 the difference of two limits has lost six digits.
    tolerance: Option<[f64; 2]>,
    distribution: Option<Arc<dyn Distribution>>,
    step: Option<f64>,
    zone: Option<Arc<str>>,
    held: Option<FixedEnd>,
    labels: Labels,
    convention: Convention,
}

/// Conventions of a dimension for the inflations of the RSS and for a budget of uncertainty, beside its tolerance band.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Convention {
    /// Factor of the dimension's part in the inflated RSS. None for the usual one.
    pub rss_factor: Option<RssFactor>,
    /// Greatest offset of the mean, as a part of the half band. None for the usual one.
    pub mean_shift: Option<f64>,
    /// Degrees of freedom of the standard uncertainty. None if they are not given.
    pub degrees: Option<f64>,
    /// Lots of the process. None if they follow from the distribution.
    pub lot: Option<Lot>,
    /// Facts of a distribution that is not known otherwise. The dimension's own distribution only stands in for it then.
    pub promise: Option<BandPromise>,
}

/// Facts of an unknown distribution within the tolerance band, in half bands from its middle.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct BandPromise {
    /// Range of the mean. None if it can lie anywhere in the band.
    pub mean: Option<[f64; 2]>,
    /// Greatest standard deviation. None if only the band bounds it.
    pub sigma: Option<f64>,
    /// True if the distribution is symmetric about the middle.
    pub symmetric: bool,
    /// True if the density of a symmetric distribution falls on either side of the middle.
    pub unimodal: bool,
}

/// Distribution of the parts in one lot of a process.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lot {
    /// Sigma of the parts in a lot, in half bands.
    pub sigma: f64,
    /// Distance of the mean of all lots from the middle, in half bands.
    pub off: f64,
    /// Further distance by which the mean of one lot may be off, in the dimension's unit. It is constant if the tolerance changes.
    pub further: f64,
}

/// Factor of a dimension in the inflated RSS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RssFactor {
    /// Given factor.
    Factor(f64),
    /// Factor that follows from the worst case and the RSS.
    Modified,
}

/// Error of a dimension that cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("dimension `{name}`: {fault}")]
#[non_exhaustive]
pub struct DimensionError {
    /// Name of the dimension.
    pub name: String,
    /// Fault of the dimension.
    pub fault: DimensionFault,
}

/// Fault of a dimension.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DimensionFault {
    /// The parameters of the distribution are impossible.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// A tolerance is below 0.
    #[error("the tolerance must not be negative, but is {value}")]
    NegativeTolerance {
        /// Tolerance given, below 0.
        value: f64,
    },
    /// The variation is lost to rounding beside the mean.
    #[error("sigma {sigma:e} is too small beside the mean {mean:e} to be told from 0 in double precision")]
    Unresolvable {
        /// Mean of the distribution, in the dimension's unit.
        mean: f64,
        /// Standard deviation, in the dimension's unit.
        sigma: f64,
    },
    /// The evaluation step is not a positive number.
    #[error("the step must be a number of sigmas above 0, but is {value}")]
    BadStep {
        /// Step given, in sigmas.
        value: f64,
    },
}

impl Dimension {
    /// Fixed value: it takes part in no statistics and costs no evaluation.
    pub fn fixed(name: impl Into<String>, nominal: f64) -> Result<Self, DimensionError> {
        Self::build(name.into(), nominal, None, Ok(None))
    }

    /// Normal dimension, nominal ± `tolerance`, with three sigma within the band. A tolerance of 0 makes it fixed.
    pub fn normal(name: impl Into<String>, nominal: f64, tolerance: f64) -> Result<Self, DimensionError> {
        if tolerance == 0.0 {
            return Self::fixed(name, nominal);
        }
        let distribution = checked(tolerance).and_then(|half| shared(Normal::new(nominal, half / 3.0)));
        Self::build(name.into(), nominal, Some([-tolerance, tolerance]), distribution)
    }

    /// Uniform dimension over nominal ± `tolerance`. A tolerance of 0 makes it fixed.
    pub fn uniform(name: impl Into<String>, nominal: f64, tolerance: f64) -> Result<Self, DimensionError> {
        if tolerance == 0.0 {
            return Self::fixed(name, nominal);
        }
        let distribution = checked(tolerance).and_then(|half| shared(Uniform::about(nominal, half)));
        Self::build(name.into(), nominal, Some([-tolerance, tolerance]), distribution)
    }

    /// Normal dimension with its mean in the middle of the band from `nominal + tolerance[0]` to `nominal + tolerance[1]`, and three sigma
    /// within it.
    pub fn normal_between(name: impl Into<String>, nominal: f64, tolerance: [f64; 2]) -> Result<Self, DimensionError> {
        let [lower, upper] = tolerance;
        let distribution = shared(Normal::new(nominal + 0.5 * (lower + upper), (upper - lower) / 6.0));
        Self::build(name.into(), nominal, Some(tolerance), distribution)
    }

    /// Dimension of any distribution. `tolerance` holds the deviations of the band from the nominal, if there is a band.
    pub fn distributed(
        name: impl Into<String>,
        nominal: f64,
        tolerance: Option<[f64; 2]>,
        distribution: Arc<dyn Distribution>,
    ) -> Result<Self, DimensionError> {
        Self::build(name.into(), nominal, tolerance, Ok(Some(distribution)))
    }

    fn build(
        name: String,
        nominal: f64,
        tolerance: Option<[f64; 2]>,
        distribution: Result<Option<Arc<dyn Distribution>>, DimensionFault>,
    ) -> Result<Self, DimensionError> {
        match check(nominal, tolerance, distribution) {
            Ok(distribution) => Ok(Self {
                name,
                unit: None,
                nominal,
                tolerance,
                distribution,
                step: None,
                zone: None,
                held: None,
                labels: Labels::default(),
                convention: Convention::default(),
            }),
            Err(fault) => Err(DimensionError { name, fault }),
        }
    }

    /// Sets the unit, which is shown and never converted.
    pub fn with_unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Sets the evaluation step: `step` sigma on either side of the mean, in place of the nodes that suit the distribution.
    pub fn with_step(mut self, step: f64) -> Result<Self, DimensionError> {
        if !(step.is_finite() && step > 0.0) {
            return Err(DimensionError { name: self.name, fault: DimensionFault::BadStep { value: step } });
        }
        self.step = Some(step);
        Ok(self)
    }

    /// Dimension with `factor` times the tolerance. Returns None if it does not vary, or if its distribution does not scale with the
    /// tolerance (see [`Distribution::scaled`]).
    ///
    /// The band opens and closes about its middle, which stays in place: a one-sided 0 to 0.2 halved is 0.05 to 0.15, and no mean moves
    /// because a tolerance does. If one end of the band is held, as for fits and by `fixed_side` in studies, that end stays, and the mean
    /// moves with the middle.
    ///
    /// # Errors
    /// If the factor is not a number above 0, or the distribution cannot have such a sigma.
    ///
    /// ```
    /// use sensitol_numeric::dimension::Dimension;
    /// let b = Dimension::normal_between("b", 30.0, [-0.25, 0.75])?;
    /// let half = b.scaled(0.5).expect("a normal dimension scales")?;
    /// assert_eq!(half.tolerance(), Some([0.0, 0.5]));
    /// assert!((half.mean() - 30.25).abs() < 1e-14 && (half.sigma() - 0.25 / 3.0).abs() < 1e-15);
    /// # Ok::<(), sensitol_numeric::dimension::DimensionError>(())
    /// ```
    pub fn scaled(&self, factor: f64) -> Option<Result<Self, DimensionError>> {
        let distribution = self.distribution()?;
        // A distribution that does not scale returns None at any factor, before the factor is checked.
        let way = self.lean() * self.half_band() * (factor - 1.0);
        let scaled = distribution.scaled(factor, way)?;
        let scaled = positive("factor", factor).and(scaled).map_err(DimensionFault::from);
        let tolerance = self.tolerance.map(|band| self.opened(band, factor));
        Some(match scaled.and_then(|scaled| check(self.nominal, tolerance, Ok(Some(scaled)))) {
            Ok(distribution) => Ok(Self { tolerance, distribution, ..self.clone() }),
            Err(fault) => Err(DimensionError { name: self.name.clone(), fault }),
        })
    }

    /// Band with `factor` times the width of `band`: about its middle, or from the end that is held.
    pub fn opened(&self, band: [f64; 2], factor: f64) -> [f64; 2] {
        let [lower, upper] = band;
        match self.held {
            Some(FixedEnd::Lower) => [lower, lower + factor * (upper - lower)],
            Some(FixedEnd::Upper) => [upper - factor * (upper - lower), upper],
            None => about_middle(band, factor),
        }
    }

    /// Dimension with the band and the distribution of another, and all else unchanged.
    pub fn remade(&self, other: Self) -> Self {
        Self { tolerance: other.tolerance, distribution: other.distribution, ..self.clone() }
    }

    /// Holds one end of the tolerance band. Without a band nothing is held.
    pub fn holding(mut self, end: FixedEnd) -> Self {
        self.held = self.tolerance.map(|_| end);
        self
    }

    /// Direction in which the middle of the band moves when its half-width grows, by the same amount: 1 up, -1 down, 0 for none.
    pub fn lean(&self) -> f64 {
        self.held.map_or(0.0, FixedEnd::lean)
    }

    /// Dimension about another nominal value, with its tolerance unchanged. Returns None if its distribution does not move with the
    /// nominal: measured values, and distributions with an origin.
    ///
    /// # Errors
    /// If the nominal is not a finite number, or so large that the tolerance vanishes beside it.
    ///
    /// ```
    /// use sensitol_numeric::dimension::Dimension;
    /// let b = Dimension::normal_between("b", 30.0, [-0.1, 0.3])?;
    /// let moved = b.moved(50.0).expect("a normal dimension moves")?;
    /// assert_eq!((moved.nominal(), moved.tolerance()), (50.0, Some([-0.1, 0.3])));
    /// assert!((moved.mean() - 50.1).abs() < 1e-12);
    /// # Ok::<(), sensitol_numeric::dimension::DimensionError>(())
    /// ```
    pub fn moved(&self, nominal: f64) -> Option<Result<Self, DimensionError>> {
        let by = nominal - self.nominal;
        let distribution = match self.distribution() {
            Some(distribution) if by != 0.0 => {
                let moved = distribution.scaled(1.0, by)?;
                let stays = |moved: &dyn Distribution| {
                    (moved.mean() - distribution.mean() - by).abs() > 1e-6 * distribution.sigma().max(by.abs())
                };
                if moved.as_ref().is_ok_and(|moved| stays(&**moved)) {
                    return None;
                }
                moved.map(Some).map_err(DimensionFault::from)
            }
            _ => Ok(self.distribution.clone()),
        };
        Some(match check(nominal, self.tolerance, distribution) {
            Ok(distribution) => Ok(Self { nominal, distribution, ..self.clone() }),
            Err(fault) => Err(DimensionError { name: self.name.clone(), fault }),
        })
    }

    /// Makes the dimension one coordinate of a point in a zone of this name. The deviations of all coordinates of the zone from the band
    /// middles then lie within one circle or sphere, rather than each within its own band.
    ///
    /// ```
    /// use sensitol_numeric::dimension::Dimension;
    /// let [x, y] = ["x", "y"].map(|name| Dimension::normal(name, 0.0, 0.1).unwrap().within_zone("hole"));
    /// // The worst case of 3 x + 4 y is then 0.1 hypot(3, 4), not 0.1 (3 + 4).
    /// assert_eq!((x.zone(), y.zone()), (Some("hole"), Some("hole")));
    /// ```
    pub fn within_zone(mut self, zone: impl Into<Arc<str>>) -> Self {
        self.zone = Some(zone.into());
        self
    }

    /// Sets the conventions for the inflations of the RSS.
    pub fn with_convention(self, convention: Convention) -> Self {
        Self { convention, ..self }
    }

    /// Conventions for the inflations of the RSS.
    pub fn convention(&self) -> &Convention {
        &self.convention
    }

    /// Sigma of a lot, and the greatest distance of its mean from the band middle, in half bands.
    pub fn lot(&self) -> [f64; 2] {
        let ([lower, upper], half) = (self.reach(), self.half_band());
        if half == 0.0 {
            return [0.0; 2];
        }
        match self.convention.lot {
            Some(lot) => [lot.sigma * half, lot.off + lot.further / half],
            None => [self.sigma(), (self.mean() - self.nominal - 0.5 * (lower + upper)).abs() / half],
        }
    }

    /// Name of the dimension.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit, if one was given.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// Value on the drawing.
    pub fn nominal(&self) -> f64 {
        self.nominal
    }

    /// Lower and upper deviation from the nominal. Returns None if there is no tolerance band.
    pub fn tolerance(&self) -> Option<[f64; 2]> {
        self.tolerance
    }

    /// Distribution of the dimension. Returns None if it is fixed.
    pub fn distribution(&self) -> Option<&dyn Distribution> {
        self.distribution.as_deref()
    }

    /// Distribution of the dimension, to be shared. Returns None if it is fixed.
    pub fn law(&self) -> Option<&Arc<dyn Distribution>> {
        self.distribution.as_ref()
    }

    /// Evaluation step in sigmas, if one was given.
    pub fn step(&self) -> Option<f64> {
        self.step
    }

    /// Sets texts for reports.
    pub fn with_labels(self, labels: Labels) -> Self {
        Self { labels, ..self }
    }

    /// Texts for reports.
    pub fn labels(&self) -> &Labels {
        &self.labels
    }

    /// Circular zone that the dimension shares with other coordinates, if any.
    pub fn zone(&self) -> Option<&str> {
        self.zone.as_deref()
    }

    /// Mean of the distribution: the nominal of a fixed dimension, the band middle for an asymmetric tolerance.
    pub fn mean(&self) -> f64 {
        self.distribution().map_or(self.nominal, Distribution::mean)
    }

    /// Standard deviation, 0 if the dimension is fixed.
    pub fn sigma(&self) -> f64 {
        self.distribution().map_or(0.0, Distribution::sigma)
    }

    /// Half the tolerance band: three sigma without a band, 0 if the dimension is fixed.
    pub fn half_band(&self) -> f64 {
        let [lower, upper] = self.reach();
        0.5 * (upper - lower)
    }

    /// Least and greatest deviation from the nominal in a worst case: the tolerance band, or without one three sigma about the mean.
    pub fn reach(&self) -> [f64; 2] {
        let (shift, reach) = (self.mean() - self.nominal, SIGMAS_OF_AN_UNBOUNDED_DIMENSION * self.sigma());
        self.tolerance.unwrap_or([shift - reach, shift + reach])
    }
}

fn checked(tolerance: f64) -> Result<f64, DimensionFault> {
    finite("tolerance", tolerance)?;
    if tolerance < 0.0 { Err(DimensionFault::NegativeTolerance { value: tolerance }) } else { Ok(tolerance) }
}

fn shared<D: Distribution + 'static>(
    distribution: Result<D, DistributionError>,
) -> Result<Option<Arc<dyn Distribution>>, DimensionFault> {
    Ok(Some(Arc::new(distribution?)))
}

fn check(
    nominal: f64,
    tolerance: Option<[f64; 2]>,
    distribution: Result<Option<Arc<dyn Distribution>>, DimensionFault>,
) -> Result<Option<Arc<dyn Distribution>>, DimensionFault> {
    finite("nominal", nominal)?;
    let distribution = distribution?;
    if let Some([lower, upper]) = tolerance {
        finite("the lower deviation", lower)?;
        finite("the upper deviation", upper)?;
        if lower >= upper {
            return Err(DistributionError::EmptyInterval { lower, upper }.into());
        }
    }
    if let Some(distribution) = &distribution {
        let (mean, sigma) = (distribution.mean(), distribution.sigma());
        if mean + 0.25 * sigma == mean || mean - 0.25 * sigma == mean {
            return Err(DimensionFault::Unresolvable { mean, sigma });
        }
    }
    Ok(distribution)
}

/// Band `factor` times as wide, about the same middle.
fn about_middle([lower, upper]: [f64; 2], factor: f64) -> [f64; 2] {
    if factor == 1.0 {
        return [lower, upper];
    }
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    [middle - factor * half, middle + factor * half]
}
