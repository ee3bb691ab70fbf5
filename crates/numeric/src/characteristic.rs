//! Key characteristic (KC): one output of the assembly function that a study requests.

use serde::Serialize;

use crate::inspection::{Inspection, InspectionError};
use crate::labels::Labels;
use crate::power::Power;
use crate::requirement::{Requirement, RequirementError};

/// Key characteristic: its name, its unit, and the limits it should keep.
///
/// ```
/// use sensitol_numeric::characteristic::{Characteristic, SpecLimits};
/// let gap = Characteristic::new("gap").with_unit("mm").with_limits(SpecLimits::new(Some(5.0), Some(7.0))?);
/// assert_eq!((gap.limits().lower(), gap.limits().upper()), (Some(5.0), Some(7.0)));
/// # Ok::<(), sensitol_numeric::characteristic::LimitsError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Characteristic {
    /// Name of the characteristic.
    name: String,
    /// Unit, which is shown and never converted.
    unit: Option<String>,
    #[serde(flatten)]
    limits: SpecLimits,
    /// Share of assemblies that must keep the limits.
    target_yield: Option<f64>,
    // Skipped: results hold the requirement together with its value.
    #[serde(skip)]
    requirement: Option<Requirement>,
    // Skipped: results hold the inspection together with its risks.
    #[serde(skip)]
    inspection: Option<Inspection>,
    // Skipped: results hold the condition together with the conditional yield.
    #[serde(skip)]
    given: Option<String>,
    #[serde(flatten)]
    labels: Labels,
}

impl Characteristic {
    /// Characteristic without unit, limits or target.
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            unit: None,
            limits: SpecLimits::default(),
            target_yield: None,
            requirement: None,
            inspection: None,
            given: None,
            labels: Labels::default(),
        }
    }

    /// Replaces the name.
    pub fn renamed(self, name: String) -> Self {
        Self { name, ..self }
    }

    /// Sets another characteristic whose limits decide which assemblies count: a target yield is that of the assemblies that keep them.
    pub fn with_given(self, given: impl Into<String>) -> Self {
        Self { given: Some(given.into()), ..self }
    }

    /// Name of the characteristic whose limits decide which assemblies count. None if all count.
    pub fn given(&self) -> Option<&str> {
        self.given.as_deref()
    }

    /// Sets texts for reports.
    pub fn with_labels(self, labels: Labels) -> Self {
        Self { labels, ..self }
    }

    /// Texts for reports.
    pub fn labels(&self) -> &Labels {
        &self.labels
    }

    /// Sets the unit, which is shown and never converted.
    pub fn with_unit(mut self, unit: impl Into<String>) -> Self {
        self.unit = Some(unit.into());
        self
    }

    /// Sets the specification limits.
    pub fn with_limits(mut self, limits: SpecLimits) -> Self {
        self.limits = limits;
        self
    }

    /// Sets the share of assemblies that must lie within the limits, above 0 and below 1.
    pub fn with_target_yield(mut self, target: f64) -> Result<Self, LimitsError> {
        if !(target > 0.0 && target < 1.0) {
            return Err(LimitsError::ImpossibleYield { value: target });
        }
        self.target_yield = Some(target);
        Ok(self)
    }

    /// Sets a requirement in addition to a target yield.
    ///
    /// # Errors
    /// If the number is impossible, or the requirement needs limits that are missing.
    ///
    /// ```
    /// use sensitol_numeric::characteristic::{Characteristic, SpecLimits};
    /// use sensitol_numeric::requirement::Requirement;
    /// let gap = Characteristic::new("gap").with_limits(SpecLimits::new(Some(5.0), Some(7.0))?);
    /// let gap = gap.with_target_yield(0.99)?.with_requirement(Requirement::Cpk(1.33))?;
    /// assert_eq!(gap.requirements(), [Requirement::Yield(0.99), Requirement::Cpk(1.33)]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn with_requirement(mut self, requirement: Requirement) -> Result<Self, RequirementError> {
        self.requirement = Some(requirement.checked(self.limits.exist())?);
        Ok(self)
    }

    /// Sets a gauge by which the limits are inspected.
    ///
    /// # Errors
    /// If there are no limits, or guard bands leave nothing between them.
    pub fn with_inspection(mut self, inspection: Inspection) -> Result<Self, InspectionError> {
        self.inspection = Some(inspection.checked([self.limits.lower, self.limits.upper])?);
        Ok(self)
    }

    /// Characteristic with all values in its unit multiplied by a power of two.
    pub fn times(self, power: Power) -> Self {
        Self {
            limits: self.limits.times(power),
            requirement: self.requirement.map(|requirement| requirement.times(power)),
            inspection: self.inspection.map(|inspection| inspection.times(power)),
            ..self
        }
    }

    /// Gauge by which the limits are inspected, if any.
    pub fn inspection(&self) -> Option<Inspection> {
        self.inspection
    }

    /// Name of the characteristic.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Unit, if one was given.
    pub fn unit(&self) -> Option<&str> {
        self.unit.as_deref()
    }

    /// Specification limits.
    pub fn limits(&self) -> SpecLimits {
        self.limits
    }

    /// All requirements: the target yield first, then the other one.
    pub fn requirements(&self) -> Vec<Requirement> {
        let target = self.target();
        target.into_iter().chain(self.requirement.filter(|other| Some(*other) != target)).collect()
    }

    /// Target yield as a requirement, if one was given.
    pub fn target(&self) -> Option<Requirement> {
        self.target_yield.map(Requirement::Yield)
    }

    /// Share of assemblies that must lie within the limits, if one was given.
    pub fn target_yield(&self) -> Option<f64> {
        self.target_yield
    }
}

/// Specification limits of a characteristic: two, one or none.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct SpecLimits {
    /// Lower limit.
    lower: Option<f64>,
    /// Upper limit.
    upper: Option<f64>,
}

/// Error of impossible limits or of an impossible target.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LimitsError {
    /// A limit is NaN or infinite.
    #[error("a limit must be a finite number, not {value}; leave out a limit that does not exist")]
    NotFinite {
        /// Limit given, NaN or infinite.
        value: f64,
    },
    /// The lower limit is not below the upper one.
    #[error("the lower limit {lower} must be below the upper limit {upper}")]
    Swapped {
        /// Lower limit as given.
        lower: f64,
        /// Upper limit as given.
        upper: f64,
    },
    /// The target yield is not a share.
    #[error("a target yield must lie between 0 and 1, both excluded, not {value}")]
    ImpossibleYield {
        /// Target yield as given.
        value: f64,
    },
}

impl SpecLimits {
    /// Limits from finite numbers, with `lower` below `upper` if both are given.
    pub fn new(lower: Option<f64>, upper: Option<f64>) -> Result<Self, LimitsError> {
        if let Some(value) = [lower, upper].into_iter().flatten().find(|limit| !limit.is_finite()) {
            return Err(LimitsError::NotFinite { value });
        }
        match (lower, upper) {
            (Some(lower), Some(upper)) if lower >= upper => Err(LimitsError::Swapped { lower, upper }),
            _ => Ok(Self { lower, upper }),
        }
    }

    /// Limits multiplied by a power of two. A limit beyond the range of doubles becomes the greatest double, since values beyond do not
    /// occur either. Two limits that become equal are kept apart.
    pub fn times(self, power: Power) -> Self {
        let times = |limit: f64| power.times(limit).clamp(-f64::MAX, f64::MAX);
        let (lower, upper) = (self.lower.map(times), self.upper.map(times));
        let upper = upper.map(|upper| if Some(upper) == lower { upper.next_up() } else { upper });
        Self { lower, upper }
    }

    /// Lower limit, if any.
    pub fn lower(&self) -> Option<f64> {
        self.lower
    }

    /// Upper limit, if any.
    pub fn upper(&self) -> Option<f64> {
        self.upper
    }

    /// True if there is any limit.
    pub fn exist(&self) -> bool {
        self.lower.is_some() || self.upper.is_some()
    }
}

/// Limits for computed values: those given, each moved outward by the possible rounding error of a value on it.
///
/// Only this type decides if a value keeps a limit. Points of the model, points of a surface and the steps of a discrete distribution are
/// all compared here. Thus a value on a limit is the same event everywhere: it keeps the limit.
///
/// ```text
/// kept       lower - a <= value <= upper + a
/// a          256 epsilon max(sum of the magnitudes of the terms of the value, |lower|, |upper|)
/// ```
///
/// Source: J. H. Wilkinson, Rounding Errors in Algebraic Processes (1963): the error of a sum is at most its number of terms times epsilon
/// times the sum of their magnitudes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KeptLimits {
    /// Lower and upper limit moved outward, infinite if there is none.
    ends: [f64; 2],
    rounding: f64,
}

impl KeptLimits {
    /// Greatest number of roundings of a value, each in the size of all of its terms: those of a sum of 256 terms.
    const ROUNDINGS: f64 = 256.0;

    /// Limits for values whose terms have magnitudes that sum to `terms`.
    pub fn new(limits: SpecLimits, terms: f64) -> Self {
        let largest = [limits.lower, limits.upper].into_iter().flatten().map(f64::abs).fold(terms, f64::max);
        Self::moved(limits, Self::rounding_of(largest))
    }

    /// Limits for values with a rounding error of at most `rounding`.
    pub(crate) fn moved(limits: SpecLimits, rounding: f64) -> Self {
        let lower = limits.lower.map_or(f64::NEG_INFINITY, |limit| limit - rounding);
        let upper = limits.upper.map_or(f64::INFINITY, |limit| limit + rounding);
        Self { ends: [lower, upper], rounding }
    }

    /// Greatest distance by rounding between a limit and a value on it.
    pub fn rounding_of(terms: f64) -> f64 {
        Self::ROUNDINGS * f64::EPSILON * terms
    }

    /// Distance by which the limits are moved outward.
    pub fn rounding(&self) -> f64 {
        self.rounding
    }

    /// Least and greatest value that keeps the limits, infinite if there is none.
    pub fn ends(&self) -> [f64; 2] {
        self.ends
    }

    /// True if there is any limit.
    pub fn exist(&self) -> bool {
        self.ends.iter().any(|end| end.is_finite())
    }

    /// True for a value below the lower limit, and for one above the upper limit.
    pub fn broken(&self, value: f64) -> [bool; 2] {
        [value < self.ends[0], value > self.ends[1]]
    }

    /// True if the value keeps both limits.
    pub fn contains(&self, value: f64) -> bool {
        self.ends[0] <= value && value <= self.ends[1]
    }

    /// Limits tightened by a guard on either side.
    pub(crate) fn tightened(&self, guard: f64) -> Self {
        Self { ends: [self.ends[0] + guard, self.ends[1] - guard], ..*self }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits(lower: f64, upper: f64) -> SpecLimits {
        SpecLimits::new(Some(lower), Some(upper)).unwrap()
    }

    /// The sum 0.1 + 0.2 is one unit in the last place above 0.3, and keeps it. So does 0.3 - 1e-10, and 0.3 + 1e-10 does not.
    #[test]
    fn a_value_that_rounding_puts_beyond_a_limit_keeps_it() {
        let kept = KeptLimits::new(limits(0.1, 0.3), 0.3);
        assert!(0.1 + 0.2 > 0.3 && kept.contains(0.1 + 0.2));
        assert_eq!(kept.broken(0.3 + 1e-10), [false, true]);
        assert_eq!(kept.broken(0.1 - 1e-10), [true, false]);
        assert_eq!(kept.broken(f64::NAN), [false, false]);
        assert!(!kept.contains(f64::NAN));
    }

    /// The difference 100.01 - 100.00 is off 0.01 by 5e-15: half a unit in the last place of 100, which does not follow from the size of
    /// the limit.
    #[test]
    fn the_terms_of_a_difference_say_how_it_is_rounded() {
        let value = 100.01 - 100.00;
        assert!(!KeptLimits::new(limits(0.0, 0.01), 0.0).contains(value));
        assert!(KeptLimits::new(limits(0.0, 0.01), 200.01).contains(value));
    }

    #[test]
    fn a_limit_that_is_missing_is_kept_by_all() {
        let kept = KeptLimits::new(SpecLimits::new(None, Some(1.0)).unwrap(), 1.0);
        assert_eq!(kept.broken(-1e300), [false, false]);
        assert_eq!(kept.tightened(0.5).broken(0.75), [false, true]);
    }
}
