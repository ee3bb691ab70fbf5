//! Inspection of a characteristic before acceptance: a gauge with a measurement error, and limits that a guard band tightens.

use crate::power::Power;

/// A gauge and its guard bands.
///
/// A part is accepted if its measured value lies within the limits, tightened by the guard on both sides. The measured value is normal
/// about the true one, with sigma `gauge`.
///
/// ```
/// use sensitol_numeric::inspection::{Guard, Inspection};
/// use sensitol_numeric::characteristic::{Characteristic, SpecLimits};
/// let inspection = Inspection::new(0.015)?.with_guard(Guard::Width(0.01))?;
/// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(9.95), Some(10.05))?).with_inspection(inspection)?;
/// assert_eq!(gap.inspection().unwrap().gauge(), 0.015);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Inspection {
    gauge: f64,
    guard: Guard,
}

/// Amount by which the limits are tightened for acceptance.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Guard {
    /// Guard band of this width, in the unit of the characteristic.
    Width(f64),
    /// Guard band with which bad parts are accepted at this rate only, as a share of all parts.
    FalseAccept(f64),
}

/// Reason why an inspection is rejected as input.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum InspectionError {
    /// The standard deviation of the gauge is negative, infinite or NaN.
    #[error("the sigma of a gauge must be 0 or above, got {value}")]
    Gauge {
        /// Standard deviation of the gauge as given.
        value: f64,
    },
    /// The guard is negative, infinite or NaN.
    #[error("a guard band must be 0 or above, got {value}: it tightens the limits on every side")]
    Guard {
        /// Width of the guard band as given.
        value: f64,
    },
    /// The requested rate is 0 or less, or 1 or more.
    #[error("the share of bad parts that are accepted must lie between 0 and 1, both excluded, got {value}")]
    FalseAccept {
        /// Share of bad parts accepted, as given.
        value: f64,
    },
    /// The guard bands leave no interval of acceptance.
    #[error("guard {guard} leaves nothing between {lower} and {upper}")]
    NothingLeft {
        /// Guard on either side, in the unit of the characteristic.
        guard: f64,
        /// Lower limit, not yet tightened.
        lower: f64,
        /// Upper limit, not yet tightened.
        upper: f64,
    },
    /// The characteristic has no limits to inspect.
    #[error("a gauge needs limits to inspect for: give the characteristic a lower or an upper one")]
    NoLimits,
}

impl Inspection {
    /// Inspection by a gauge with this standard deviation, without guard bands.
    ///
    /// # Errors
    /// If the standard deviation is negative or not finite.
    pub fn new(gauge: f64) -> Result<Self, InspectionError> {
        match gauge.is_finite() && gauge >= 0.0 {
            true => Ok(Self { gauge, guard: Guard::Width(0.0) }),
            false => Err(InspectionError::Gauge { value: gauge }),
        }
    }

    /// Sets the guard bands.
    ///
    /// # Errors
    /// If a width is negative or not finite, or a rate does not lie between 0 and 1.
    pub fn with_guard(mut self, guard: Guard) -> Result<Self, InspectionError> {
        match guard {
            Guard::Width(value) if !(value.is_finite() && value >= 0.0) => {
                return Err(InspectionError::Guard { value });
            }
            Guard::FalseAccept(value) if !(value > 0.0 && value < 1.0) => {
                return Err(InspectionError::FalseAccept { value });
            }
            _ => {}
        }
        self.guard = guard;
        Ok(self)
    }

    /// Standard deviation of the gauge.
    pub fn gauge(&self) -> f64 {
        self.gauge
    }

    /// Guard bands of the inspection.
    pub fn guard(&self) -> Guard {
        self.guard
    }

    /// Inspection of a characteristic whose values are multiplied by a power of two.
    pub(crate) fn times(self, power: Power) -> Self {
        let times = |width: f64| power.times(width).min(f64::MAX);
        let guard = match self.guard {
            Guard::Width(width) => Guard::Width(times(width)),
            rate @ Guard::FalseAccept(_) => rate,
        };
        Self { gauge: times(self.gauge), guard }
    }

    /// Checks the inspection against the limits, the lower and the upper one.
    pub(crate) fn checked(self, limits: [Option<f64>; 2]) -> Result<Self, InspectionError> {
        match (self.guard, limits) {
            (_, [None, None]) => Err(InspectionError::NoLimits),
            (Guard::Width(guard), [Some(lower), Some(upper)]) if lower + guard >= upper - guard => {
                Err(InspectionError::NothingLeft { guard, lower, upper })
            }
            _ => Ok(self),
        }
    }
}
