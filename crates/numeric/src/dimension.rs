//! A dimension: one input of the assembly function, with its tolerance and its distribution.

use std::sync::Arc;

use crate::distribution::{Distribution, DistributionError, Normal, Uniform, finite, positive};
use crate::fits::HeldEnd;
use crate::labels::Labels;

/// Without a tolerance band, three sigma on either side take its place in RSS and worst case.
const SIGMAS_OF_AN_UNBOUNDED_DIMENSION: f64 = 3.0;

/// One input: a name, a nominal value, and how it varies.
///
/// ```
/// use crate::dimension::Dimension;
/// let a = Dimension::normal("a", 10.0, 0.3)?.with_unit("mm");
/// assert_eq!((a.mean(), a.sigma(), a.half_band()), (10.0, 0.3 / 3.0, 0.3));
/// let b = Dimension::normal_between("b", 30.0, [-0.1, 0.3])?; // the band's middle is the mean
/// assert!((b.mean() - 30.1).abs() < 1e-12 && (b.half_band() - 0.2).abs() < 1e-15);
/// # Ok::<(), crate::dimension::DimensionError>(())
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
    held: Option<HeldEnd>,
    labels: Labels,
    convention: Convention,
}

/// How the inflations of the RSS and a budget of uncertainty take a dimension beside its band.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Convention {
    /// The factor of its part; None for the usual one.
    pub rss_factor: Option<RssFactor>,
    /// The part of its half band by which its mean may be off; None for the usual one.
    pub mean_shift: Option<f64>,
    /// Degrees of freedom of its standard uncertainty; None where nothing is said of them.
    pub degrees: Option<f64>,
    /// The lots of its process; None where that follows from the distribution.
    pub lot: Option<Lot>,
}

/// How the parts of one lot of a process lie.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lot {
    /// Their sigma, in half bands.
    pub sigma: f64,
    /// How far the mean of all lots lies off the middle, in half bands.
    pub off: f64,
    /// How much further the mean of one lot may lie off, in the dimension's unit: it stays where the tolerance changes.
    pub further: f64,
}

/// The factor of a dimension in the inflated RSS.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum RssFactor {
    /// This.
    Factor(f64),
    /// As worst case and RSS suggest.
    Modified,
}

/// Why a dimension cannot be.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("dimension `{name}`: {fault}")]
#[non_exhaustive]
pub struct DimensionError {
    /// The dimension's name.
    pub name: String,
    /// The fault in it.
    pub fault: DimensionFault,
}

/// The faults of a dimension.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum DimensionFault {
    /// The distribution's parameters are impossible.
    #[error(transparent)]
    Distribution(#[from] DistributionError),
    /// A tolerance is below 0.
    #[error("the tolerance must not be negative, but is {value}")]
    NegativeTolerance {
        /// The tolerance given.
        value: f64,
    },
    /// The variation vanishes beside the value when both are doubles.
    #[error("sigma {sigma:e} is too small beside the mean {mean:e} to be told from 0 in double precision")]
    Unresolvable {
        /// The mean.
        mean: f64,
        /// The sigma.
        sigma: f64,
    },
    /// An evaluation step that is not a positive number.
    #[error("the step must be a number of sigmas above 0, but is {value}")]
    BadStep {
        /// The step given.
        value: f64,
    },
}

impl Dimension {
    /// A value that does not vary: it takes part in no statistics and costs no evaluation.
    pub fn fixed(name: impl Into<String>, nominal: f64) -> Result<Self, DimensionError> {
        Self::build(name.into(), nominal, None, Ok(None))
    }

    /// Normal, nominal ± `tolerance`, three sigma within the band; a tolerance of 0 makes it fixed.
    pub fn normal(name: impl Into<String>, nominal: f64, tolerance: f64) -> Result<Self, DimensionError> {
        if tolerance == 0.0 {
            return Self::fixed(name, nominal);
        }
        let distribution = checked(tolerance).and_then(|half| shared(Normal::new(nominal, half / 3.0)));
        Self::build(name.into(), nominal, Some([-tolerance, tolerance]), distribution)
    }

    /// Uniform over nominal ± `tolerance`; a tolerance of 0 makes it fixed.
    pub fn uniform(name: impl Into<String>, nominal: f64, tolerance: f64) -> Result<Self, DimensionError> {
        if tolerance == 0.0 {
            return Self::fixed(name, nominal);
        }
        let distribution = checked(tolerance).and_then(|half| shared(Uniform::about(nominal, half)));
        Self::build(name.into(), nominal, Some([-tolerance, tolerance]), distribution)
    }

    /// Normal with its mean in the middle of the band from `nominal + tolerance[0]` to `nominal + tolerance[1]`,
    /// three sigma within it.
    pub fn normal_between(name: impl Into<String>, nominal: f64, tolerance: [f64; 2]) -> Result<Self, DimensionError> {
        let [lower, upper] = tolerance;
        let distribution = shared(Normal::new(nominal + 0.5 * (lower + upper), (upper - lower) / 6.0));
        Self::build(name.into(), nominal, Some(tolerance), distribution)
    }

    /// Any distribution, with the tolerance band's deviations from the nominal where there is one.
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

    /// With a unit, which is shown and never converted.
    pub fn with_unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Evaluated at `step` sigma on either side of the mean instead of at the nodes that suit its distribution.
    pub fn with_step(mut self, step: f64) -> Result<Self, DimensionError> {
        if !(step.is_finite() && step > 0.0) {
            return Err(DimensionError { name: self.name, fault: DimensionFault::BadStep { value: step } });
        }
        self.step = Some(step);
        Ok(self)
    }

    /// The same dimension with `factor` times the tolerance; None where it does not vary, or its distribution does not
    /// scale with the tolerance ([`Distribution::scaled`] says which do and how).
    ///
    /// The band opens and closes about its middle, which stays where it is: a one-sided 0 to 0.2 halved is 0.05 to 0.15, and no
    /// mean moves because a tolerance does. Where one end of the band is held, as studies say of fits and by `fixed_side`, that end stays, and
    /// the mean moves with the middle.
    ///
    /// # Errors
    /// When the factor is not a number above 0, or the distribution cannot have such a sigma.
    ///
    /// ```
    /// use crate::dimension::Dimension;
    /// let b = Dimension::normal_between("b", 30.0, [-0.25, 0.75])?;
    /// let half = b.scaled(0.5).expect("a normal dimension scales")?;
    /// assert_eq!(half.tolerance(), Some([0.0, 0.5]));
    /// assert!((half.mean() - 30.25).abs() < 1e-14 && (half.sigma() - 0.25 / 3.0).abs() < 1e-15);
    /// # Ok::<(), crate::dimension::DimensionError>(())
    /// ```
    pub fn scaled(&self, factor: f64) -> Option<Result<Self, DimensionError>> {
        let distribution = self.distribution()?;
        // One that does not scale does not at any factor.
        let way = self.lean() * self.half_band() * (factor - 1.0);
        let scaled = distribution.scaled(factor, way)?;
        let scaled = positive("factor", factor).and(scaled).map_err(DimensionFault::from);
        let tolerance = self.tolerance.map(|band| self.opened(band, factor));
        Some(match scaled.and_then(|scaled| check(self.nominal, tolerance, Ok(Some(scaled)))) {
            Ok(distribution) => Ok(Self { tolerance, distribution, ..self.clone() }),
            Err(fault) => Err(DimensionError { name: self.name.clone(), fault }),
        })
    }

    /// A band of the dimension with `factor` times its width: about its middle, or from the end that is held.
    pub fn opened(&self, band: [f64; 2], factor: f64) -> [f64; 2] {
        let [lower, upper] = band;
        match self.held {
            Some(HeldEnd::Lower) => [lower, lower + factor * (upper - lower)],
            Some(HeldEnd::Upper) => [upper - factor * (upper - lower), upper],
            None => about_middle(band, factor),
        }
    }

    /// The same with the band and the distribution of another.
    pub fn remade(&self, other: Self) -> Self {
        Self { tolerance: other.tolerance, distribution: other.distribution, ..self.clone() }
    }

    /// With one end of its band held; without a band nothing is.
    pub fn holding(mut self, end: HeldEnd) -> Self {
        self.held = self.tolerance.map(|_| end);
        self
    }

    /// Where the middle of the band goes when its half width grows, by as much: 1 up, -1 down, 0 nowhere.
    pub fn lean(&self) -> f64 {
        self.held.map_or(0.0, HeldEnd::lean)
    }

    /// The same dimension about another nominal value, its tolerance kept; None where its distribution does not move with the
    /// nominal, as measured values and those with an origin do not.
    ///
    /// # Errors
    /// When the nominal is not a finite number, or so large that the tolerance vanishes beside it.
    ///
    /// ```
    /// use crate::dimension::Dimension;
    /// let b = Dimension::normal_between("b", 30.0, [-0.1, 0.3])?;
    /// let moved = b.moved(50.0).expect("a normal dimension moves")?;
    /// assert_eq!((moved.nominal(), moved.tolerance()), (50.0, Some([-0.1, 0.3])));
    /// assert!((moved.mean() - 50.1).abs() < 1e-12);
    /// # Ok::<(), crate::dimension::DimensionError>(())
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

    /// As one coordinate of a point that a zone of this name keeps: with all other coordinates of the zone, its deviations from
    /// the bands' middles lie within one circle, or a sphere, rather than each within its own band.
    ///
    /// ```
    /// use crate::dimension::Dimension;
    /// let [x, y] = ["x", "y"].map(|name| Dimension::normal(name, 0.0, 0.1).unwrap().within_zone("hole"));
    /// // The worst case of 3 x + 4 y is then 0.1 hypot(3, 4), not 0.1 (3 + 4).
    /// assert_eq!((x.zone(), y.zone()), (Some("hole"), Some("hole")));
    /// ```
    pub fn within_zone(mut self, zone: impl Into<Arc<str>>) -> Self {
        self.zone = Some(zone.into());
        self
    }

    /// Taken so by the inflations of the RSS.
    pub fn with_convention(self, convention: Convention) -> Self {
        Self { convention, ..self }
    }

    /// How they take it.
    pub fn convention(&self) -> &Convention {
        &self.convention
    }

    /// Sigma of a lot, and how far its mean may lie off the middle of the band, in half bands.
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

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its unit, where one was given.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// The value on the drawing.
    pub fn nominal(&self) -> f64 {
        self.nominal
    }

    /// Lower and upper deviation from the nominal, where there is a tolerance band.
    pub fn tolerance(&self) -> Option<[f64; 2]> {
        self.tolerance
    }

    /// How it varies; None when it is fixed.
    pub fn distribution(&self) -> Option<&dyn Distribution> {
        self.distribution.as_deref()
    }

    /// The same, to be shared.
    pub fn law(&self) -> Option<&Arc<dyn Distribution>> {
        self.distribution.as_ref()
    }

    /// Its step in sigmas, where one was given.
    pub fn step(&self) -> Option<f64> {
        self.step
    }

    /// With texts for reports.
    pub fn with_labels(self, labels: Labels) -> Self {
        Self { labels, ..self }
    }

    /// Its texts for reports.
    pub fn labels(&self) -> &Labels {
        &self.labels
    }

    /// The circular zone that it shares with other coordinates, where there is one.
    pub fn zone(&self) -> Option<&str> {
        self.zone.as_deref()
    }

    /// Mean of its distribution: the nominal when it is fixed, the band's middle for an asymmetric tolerance.
    pub fn mean(&self) -> f64 {
        self.distribution().map_or(self.nominal, Distribution::mean)
    }

    /// Standard deviation: 0 when it is fixed.
    pub fn sigma(&self) -> f64 {
        self.distribution().map_or(0.0, Distribution::sigma)
    }

    /// Half the tolerance band, three sigma where there is no band, 0 when it is fixed.
    pub fn half_band(&self) -> f64 {
        let [lower, upper] = self.reach();
        0.5 * (upper - lower)
    }

    /// The least and greatest deviation from the nominal in a worst case: the tolerance band, or three sigma about
    /// the mean where there is none.
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

/// A band `factor` times as wide about the same middle.
fn about_middle([lower, upper]: [f64; 2], factor: f64) -> [f64; 2] {
    if factor == 1.0 {
        return [lower, upper];
    }
    let (middle, half) = (0.5 * (lower + upper), 0.5 * (upper - lower));
    [middle - factor * half, middle + factor * half]
}
