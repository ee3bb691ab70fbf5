//! A key characteristic (KC): one output of the assembly function that the study asks for.

use serde::Serialize;

use crate::inspection::{Inspection, InspectionError};
use crate::labels::Labels;
use crate::power::Power;
use crate::requirement::{Requirement, RequirementError};

/// A key characteristic: its name, its unit, and the limits it should keep.
///
/// ```
/// use sensitol::{Characteristic, SpecLimits};
/// let gap = Characteristic::new("gap").with_unit("mm").with_limits(SpecLimits::new(Some(5.0), Some(7.0))?);
/// assert_eq!((gap.limits().lower(), gap.limits().upper()), (Some(5.0), Some(7.0)));
/// # Ok::<(), sensitol::LimitsError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct Characteristic {
    /// Its name.
    name: String,
    /// Its unit.
    unit: Option<String>,
    #[serde(flatten)]
    limits: SpecLimits,
    /// The share of assemblies that must keep the limits.
    target_yield: Option<f64>,
    // The requirement stands in results together with its value.
    #[serde(skip)]
    requirement: Option<Requirement>,
    // Stands in results with what it does.
    #[serde(skip)]
    inspection: Option<Inspection>,
    #[serde(flatten)]
    labels: Labels,
}

impl Characteristic {
    /// Without unit, limits or target.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: None,
            limits: SpecLimits::default(),
            target_yield: None,
            requirement: None,
            inspection: None,
            labels: Labels::default(),
        }
    }

    /// Under another name.
    #[cfg(feature = "study")]
    pub(crate) fn renamed(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// With texts for reports.
    #[cfg(feature = "study")]
    pub(crate) fn with_labels(self, labels: Labels) -> Self {
        Self { labels, ..self }
    }

    /// Its texts for reports.
    #[cfg(feature = "report")]
    pub(crate) fn labels(&self) -> &Labels {
        &self.labels
    }

    /// With a unit, which is shown and never converted.
    pub fn with_unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// With specification limits.
    pub fn with_limits(mut self, limits: SpecLimits) -> Self {
        self.limits = limits;
        self
    }

    /// With the share of assemblies that must lie within the limits, above 0 and below 1.
    pub fn with_target_yield(mut self, target: f64) -> Result<Self, LimitsError> {
        if !(target > 0.0 && target < 1.0) {
            return Err(LimitsError::ImpossibleYield { value: target });
        }
        self.target_yield = Some(target);
        Ok(self)
    }

    /// With something that it must keep, beside a target yield.
    ///
    /// # Errors
    /// When the number is impossible, or limits are missing that it speaks of.
    ///
    /// ```
    /// use sensitol::{Characteristic, Requirement, SpecLimits};
    /// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(5.0), Some(7.0))?);
    /// let gap = gap.with_target_yield(0.99)?.with_requirement(Requirement::Cpk(1.33))?;
    /// assert_eq!(gap.requirements(), [Requirement::Yield(0.99), Requirement::Cpk(1.33)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_requirement(mut self, requirement: Requirement) -> Result<Self, RequirementError> {
        self.requirement = Some(requirement.checked(self.limits.exist())?);
        Ok(self)
    }

    /// With a gauge by which its limits are inspected.
    ///
    /// # Errors
    /// When it has no limits, or guard bands leave nothing between them.
    pub fn with_inspection(mut self, inspection: Inspection) -> Result<Self, InspectionError> {
        self.inspection = Some(inspection.checked([self.limits.lower, self.limits.upper])?);
        Ok(self)
    }

    /// The same with everything in its unit times a power of two.
    pub(crate) fn times(self, power: Power) -> Self {
        Self {
            limits: self.limits.times(power),
            requirement: self.requirement.map(|requirement| requirement.times(power)),
            inspection: self.inspection.map(|inspection| inspection.times(power)),
            ..self
        }
    }

    /// The gauge by which its limits are inspected, where there is one.
    pub fn inspection(&self) -> Option<Inspection> {
        self.inspection
    }

    /// Its name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its unit, where one was given.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// Its specification limits.
    pub fn limits(&self) -> SpecLimits {
        self.limits
    }

    /// Everything that it must keep: its target yield, and what else is required of it.
    pub fn requirements(&self) -> Vec<Requirement> {
        let target = self.target_yield.map(Requirement::Yield);
        target.into_iter().chain(self.requirement.filter(|other| Some(*other) != target)).collect()
    }

    /// The share of assemblies that must lie within the limits, where one was given.
    pub(crate) fn target_yield(&self) -> Option<f64> {
        self.target_yield
    }
}

/// Specification limits of a characteristic: two, one or none.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SpecLimits {
    /// Lower limit.
    lower: Option<f64>,
    /// Upper limit.
    upper: Option<f64>,
}

/// Why limits or a target are impossible.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LimitsError {
    /// A limit is NaN or infinite.
    #[error("a limit must be a finite number, not {value}; leave out a limit that does not exist")]
    NotFinite {
        /// The limit given.
        value: f64,
    },
    /// The limits are the wrong way round, or the same.
    #[error("the lower limit {lower} must be below the upper limit {upper}")]
    Swapped {
        /// The lower limit given.
        lower: f64,
        /// The upper limit given.
        upper: f64,
    },
    /// A target yield that is not a share.
    #[error("a target yield must lie between 0 and 1, both excluded, not {value}")]
    ImpossibleYield {
        /// The target given.
        value: f64,
    },
}

impl SpecLimits {
    /// Both finite where given, and `lower` below `upper`.
    pub fn new(lower: Option<f64>, upper: Option<f64>) -> Result<Self, LimitsError> {
        if let Some(value) = [lower, upper].into_iter().flatten().find(|limit| !limit.is_finite()) {
            return Err(LimitsError::NotFinite { value });
        }
        match (lower, upper) {
            (Some(lower), Some(upper)) if lower >= upper => Err(LimitsError::Swapped { lower, upper }),
            _ => Ok(Self { lower, upper }),
        }
    }

    /// The same limits times a power of two. One that no double holds is the greatest double: values beyond do not occur either. Two that both are 0
    /// then stay apart.
    pub(crate) fn times(self, power: Power) -> Self {
        let times = |limit: f64| power.times(limit).clamp(-f64::MAX, f64::MAX);
        let (lower, upper) = (self.lower.map(times), self.upper.map(times));
        let upper = upper.map(|upper| if Some(upper) == lower { upper.next_up() } else { upper });
        Self { lower, upper }
    }

    /// The lower limit, where there is one.
    pub fn lower(&self) -> Option<f64> {
        self.lower
    }

    /// The upper limit, where there is one.
    pub fn upper(&self) -> Option<f64> {
        self.upper
    }

    /// Whether there is any limit.
    pub(crate) fn exist(&self) -> bool {
        self.lower.is_some() || self.upper.is_some()
    }

    /// Whether a value keeps the limits; a limit itself is kept.
    pub(crate) fn contains(&self, value: f64) -> bool {
        self.lower.is_none_or(|lower| lower <= value) && self.upper.is_none_or(|upper| value <= upper)
    }
}
