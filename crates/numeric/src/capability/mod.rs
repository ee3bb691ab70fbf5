//! Yield and capability of a characteristic: its distribution relative to its limits.

mod inspection_risks;
mod law;
mod quantiles;
mod risks;

pub use inspection_risks::{EstimatedShare, InspectionRisks};
pub use law::Law;
pub use quantiles::{EstimatedQuantile, PROBABILITIES, Quantiles};
pub use risks::{Risks, Tails, acceptance, guard_for, guard_reaching};

use std::sync::LazyLock;

use serde::{Serialize, Serializer};

use crate::characteristic::{KeptLimits, SpecLimits};
use crate::pearson::Pearson;

/// Share outside six sigma of a normal distribution on one side: half of 1 - 0.9973.
pub const TAIL: f64 = 0.001_349_898_031_630_094_6;

/// Capability of a distribution with limits. Figures are None if they do not exist, for want of a limit or because nothing varies.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capability {
    /// Share of assemblies below the lower limit.
    pub below: Option<f64>,
    /// Share of assemblies above the upper limit.
    pub above: Option<f64>,
    /// `(U - L) / 6 sigma`; needs both limits.
    pub cp: Option<f64>,
    /// `min(U - mean, mean - L) / 3 sigma`, over the limits that exist.
    pub cpk: Option<f64>,
    /// `(U - L)` divided by the width between the quantiles 0.00135 and 0.99865: Cp for any distribution.
    pub cp_percentile: Option<f64>,
    /// `min((U - median) / (q_0.99865 - median), (median - L) / (median - q_0.00135))`: Cpk for any distribution.
    pub cpk_percentile: Option<f64>,
}

/// Capability as serialised in results.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CapabilityShape {
    /// Share of assemblies within the limits.
    #[serde(rename = "yield")]
    yield_: Option<f64>,
    /// Assemblies below the lower limit, per million.
    ppm_below: Option<f64>,
    /// Assemblies above the upper limit, per million.
    ppm_above: Option<f64>,
    /// Width of the limits, divided by six sigma.
    cp: Option<f64>,
    /// Distance of the nearer limit, divided by three sigma.
    cpk: Option<f64>,
    /// Width of the limits, divided by the width between the quantiles 0.00135 and 0.99865.
    cp_percentile: Option<f64>,
    /// Distance of the nearer limit from the median, divided by that of the quantile on its side.
    cpk_percentile: Option<f64>,
    /// Distance from the mean of a normal distribution, in sigmas, beyond which one side holds the share of all rejects.
    sigma_level: Option<f64>,
}

impl From<&Option<Capability>> for CapabilityShape {
    fn from(of: &Option<Capability>) -> Self {
        let of = |figure: fn(&Capability) -> Option<f64>| of.as_ref().and_then(figure);
        Self {
            yield_: of(Capability::yield_),
            ppm_below: of(Capability::ppm_below),
            ppm_above: of(Capability::ppm_above),
            cp: of(|one| one.cp),
            cpk: of(|one| one.cpk),
            cp_percentile: of(|one| one.cp_percentile),
            cpk_percentile: of(|one| one.cpk_percentile),
            sigma_level: of(Capability::sigma_level),
        }
    }
}

impl Serialize for Capability {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        CapabilityShape::from(&Some(*self)).serialize(serializer)
    }
}

/// `min(U - mean, mean - L) / 3 sigma` over the limits that exist, without a distribution. Returns None if sigma is 0 or there is no limit.
pub fn cpk(mean: f64, sigma: f64, limits: SpecLimits) -> Option<f64> {
    nearer(limits, mean, 3.0 * sigma, 3.0 * sigma)
}

/// Cp and Cpk from the quantiles 0.00135, 0.5 and 0.99865 of a distribution: [`Capability::cp_percentile`] and
/// [`Capability::cpk_percentile`].
pub fn percentiles([low, middle, high]: [f64; 3], limits: SpecLimits) -> [Option<f64>; 2] {
    let both = limits.upper().zip(limits.lower()).and_then(|(upper, lower)| width(upper - lower, high - low));
    [both, nearer(limits, middle, middle - low, high - middle)]
}

/// Errors of [`percentiles`]: their changes if each quantile in turn is off by its error, combined as the root of the sum of squares. None
/// for an index that does not exist, and if the error of a quantile is unknown.
pub fn percentile_errors(quantiles: [EstimatedQuantile; 3], limits: SpecLimits) -> [Option<f64>; 2] {
    let values = quantiles.map(|quantile| quantile.value);
    let own = percentiles(values, limits);
    let mut squares = own.map(|index| index.map(|_| 0.0));
    for (moved, quantile) in quantiles.iter().enumerate() {
        let Some(error) = quantile.error else { return [None; 2] };
        let mut changes = [Some(0.0f64); 2];
        for side in [-error, error] {
            let mut other = values;
            other[moved] += side;
            let other = percentiles(other, limits);
            for (change, (index, other)) in changes.iter_mut().zip(own.into_iter().zip(other)) {
                *change =
                    change.zip(index.zip(other)).map(|(change, (index, other))| change.max((other - index).abs()));
            }
        }
        for (square, change) in squares.iter_mut().zip(changes) {
            *square = square.zip(change).map(|(square, change)| square + change * change);
        }
    }
    squares.map(|square| square.map(f64::sqrt))
}

fn width(narrow: f64, wide: f64) -> Option<f64> {
    (wide > 0.0).then_some(narrow / wide)
}

/// Distance of the nearer limit from `middle`, each in units of its own side. Returns None if there is no limit.
fn nearer(limits: SpecLimits, middle: f64, down: f64, up: f64) -> Option<f64> {
    let below = limits.lower().map(|lower| width(middle - lower, down));
    let above = limits.upper().map(|upper| width(upper - middle, up));
    below.into_iter().chain(above).reduce(|a, b| Some(a?.min(b?))).flatten()
}

impl Capability {
    /// Capability of a distribution with this mean and sigma.
    ///
    /// Source: ISO 22514-2 (2017), where the percentile forms are Pp and Ppk by its method M2.
    ///
    /// ```
    /// use sensitol_numeric::capability::{Capability, Law};
    /// use sensitol_numeric::characteristic::SpecLimits;
    /// use sensitol_numeric::moments::Moments;
    /// let moments = Moments::new(6.0, 0.25, 0.0, 0.0);
    /// let limits = SpecLimits::new(Some(5.0), Some(7.0))?;
    /// let capability = Capability::of(&Law::fit(&moments)?, 6.0, 0.25, limits);
    /// assert!((capability.cp.unwrap() - 4.0 / 3.0).abs() < 1e-12);
    /// assert!((capability.cpk_percentile.unwrap() - 4.0 / 3.0).abs() < 1e-12);
    /// // Both limits are 4 sigma off the mean.
    /// assert!((1e6 * (capability.below.unwrap() + capability.above.unwrap()) - 63.342).abs() < 1e-3);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn of(law: &Law, mean: f64, sigma: f64, limits: SpecLimits) -> Self {
        let (lower, upper) = (limits.lower(), limits.upper());
        let quantiles = [law.quantile(TAIL), law.quantile(0.5), law.upper_quantile(TAIL)];
        let [cp_percentile, cpk_percentile] = percentiles(quantiles, limits);
        Self {
            below: lower.map(|lower| law.below(lower)),
            above: upper.map(|upper| law.above(upper)),
            cp_percentile,
            cpk_percentile,
            ..Self::of_moments(mean, sigma, limits)
        }
    }

    /// Capability whose rejects allow for rounding: a value that does not vary keeps a limit if computed values do.
    pub fn of_kept(law: &Law, mean: f64, sigma: f64, limits: SpecLimits, kept: KeptLimits) -> Self {
        let capability = Self::of(law, mean, sigma, limits);
        let Law::Point { at } = law else { return capability };
        let [below, above] = kept.broken(*at).map(|broken| f64::from(u8::from(broken)));
        Self { below: limits.lower().map(|_| below), above: limits.upper().map(|_| above), ..capability }
    }

    /// Figures from mean and sigma alone: Cp and Cpk.
    pub fn of_moments(mean: f64, sigma: f64, limits: SpecLimits) -> Self {
        let cp = limits.upper().zip(limits.lower()).and_then(|(upper, lower)| width(upper - lower, 6.0 * sigma));
        let cpk = cpk(mean, sigma, limits);
        Self { below: None, above: None, cp, cpk, cp_percentile: None, cpk_percentile: None }
    }

    /// Share of assemblies outside the limits. Returns None if there is no limit.
    pub fn rejected(&self) -> Option<f64> {
        match (self.below, self.above) {
            (None, None) => None,
            (below, above) => Some((below.unwrap_or(0.0) + above.unwrap_or(0.0)).min(1.0)),
        }
    }

    /// Share of assemblies within the limits. Returns None if there is no limit.
    pub fn yield_(&self) -> Option<f64> {
        self.rejected().map(|rejected| 1.0 - rejected)
    }

    /// Assemblies below the lower limit, per million. Returns None if that limit does not exist.
    pub fn ppm_below(&self) -> Option<f64> {
        self.below.map(|share| 1e6 * share)
    }

    /// Assemblies above the upper limit, per million. Returns None if that limit does not exist.
    pub fn ppm_above(&self) -> Option<f64> {
        self.above.map(|share| 1e6 * share)
    }

    /// Distance from the mean of a normal distribution, in sigmas, beyond which one side holds the share of all rejects:
    /// `-Phi^-1(rejected)`. It has no shift of 1.5, which some add. Returns None if all or nothing is rejected.
    pub fn sigma_level(&self) -> Option<f64> {
        static NORMAL: LazyLock<Pearson> =
            LazyLock::new(|| Pearson::normal(0.0, 1.0).expect("the standard normal exists"));
        self.rejected().map(|rejected| NORMAL.upper_quantile(rejected)).filter(|level| level.is_finite())
    }
}
