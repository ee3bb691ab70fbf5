//! Yield and capability: how a characteristic's distribution lies between its limits.

mod inspection_risks;
mod law;
mod quantiles;
mod risks;

pub use inspection_risks::{EstimatedShare, InspectionRisks};
pub use law::Law;
pub use quantiles::{PROBABILITIES, Quantiles};
pub use risks::{Risks, Tails, acceptance, guard_for, guard_reaching};

use std::sync::LazyLock;

use serde::{Serialize, Serializer};

use crate::characteristic::{KeptLimits, SpecLimits};
use crate::pearson::Pearson;

/// Half of the share that six sigma of a normal leave out: 1 - 0.9973 on both sides.
pub const TAIL: f64 = 0.001_349_898_031_630_094_6;

/// How a distribution keeps limits. Figures that do not exist, for want of a limit or because nothing varies, are None.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Capability {
    /// Share of assemblies below the lower limit.
    pub below: Option<f64>,
    /// Share of assemblies above the upper limit.
    pub above: Option<f64>,
    /// `(U - L) / 6 sigma`; needs both limits.
    pub cp: Option<f64>,
    /// `min(U - mean, mean - L) / 3 sigma`, of the limits that there are.
    pub cpk: Option<f64>,
    /// `(U - L)` by the width between the quantiles 0.00135 and 0.99865: Cp for any distribution.
    pub cp_percentile: Option<f64>,
    /// `min((U - median) / (q_0.99865 - median), (median - L) / (median - q_0.00135))`: Cpk for any distribution.
    pub cpk_percentile: Option<f64>,
}

/// How limits are kept, as it is written.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct CapabilityShape {
    /// The share of assemblies within the limits.
    #[serde(rename = "yield")]
    yield_: Option<f64>,
    /// Assemblies below the lower limit, per million.
    ppm_below: Option<f64>,
    /// Assemblies above the upper limit, per million.
    ppm_above: Option<f64>,
    /// Width of the limits by six sigma.
    cp: Option<f64>,
    /// Distance of the nearer limit by three sigma.
    cpk: Option<f64>,
    /// Width of the limits by that between the quantiles 0.00135 and 0.99865.
    cp_percentile: Option<f64>,
    /// Distance of the nearer limit from the median by that of the quantile on its side.
    cpk_percentile: Option<f64>,
    /// Sigmas of a normal beyond which, on one side, as many lie as are rejected.
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

/// `min(U - mean, mean - L) / 3 sigma` of the limits that there are, which needs no law; None where sigma is 0.
pub fn cpk(mean: f64, sigma: f64, limits: SpecLimits) -> Option<f64> {
    nearer(limits, mean, 3.0 * sigma, 3.0 * sigma)
}

/// Cp and Cpk by the quantiles 0.00135, 0.5 and 0.99865 of a law: [`Capability::cp_percentile`] and
/// [`Capability::cpk_percentile`].
pub fn percentiles([low, middle, high]: [f64; 3], limits: SpecLimits) -> [Option<f64>; 2] {
    let both = limits.upper().zip(limits.lower()).and_then(|(upper, lower)| width(upper - lower, high - low));
    [both, nearer(limits, middle, middle - low, high - middle)]
}

fn width(narrow: f64, wide: f64) -> Option<f64> {
    (wide > 0.0).then_some(narrow / wide)
}

/// The distance of the nearer limit, each in units of its own side.
fn nearer(limits: SpecLimits, middle: f64, down: f64, up: f64) -> Option<f64> {
    let below = limits.lower().map(|lower| width(middle - lower, down));
    let above = limits.upper().map(|upper| width(upper - middle, up));
    below.into_iter().chain(above).reduce(|a, b| Some(a?.min(b?))).flatten()
}

impl Capability {
    /// Of a law with this mean and sigma.
    ///
    /// Source: ISO 22514-2 (2017), which calls the percentile forms Pp and Ppk by its method M2.
    ///
    /// ```
    /// use crate::capability::{Capability, Law};
    /// use crate::characteristic::SpecLimits;
    /// use crate::moments::Moments;
    /// let moments = Moments::new(6.0, 0.25, 0.0, 0.0);
    /// let limits = SpecLimits::new(Some(5.0), Some(7.0))?;
    /// let capability = Capability::of(&Law::fit(&moments)?, 6.0, 0.25, limits);
    /// assert!((capability.cp.unwrap() - 4.0 / 3.0).abs() < 1e-12);
    /// assert!((capability.cpk_percentile.unwrap() - 4.0 / 3.0).abs() < 1e-12);
    /// // 4 sigma on both sides.
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

    /// The same, where a value that does not vary keeps a limit as computed values do.
    pub fn of_kept(law: &Law, mean: f64, sigma: f64, limits: SpecLimits, kept: KeptLimits) -> Self {
        let capability = Self::of(law, mean, sigma, limits);
        let Law::Point { at } = law else { return capability };
        let [below, above] = kept.broken(*at).map(|broken| f64::from(u8::from(broken)));
        Self { below: limits.lower().map(|_| below), above: limits.upper().map(|_| above), ..capability }
    }

    /// The figures that follow from mean and sigma alone: Cp and Cpk.
    pub fn of_moments(mean: f64, sigma: f64, limits: SpecLimits) -> Self {
        let cp = limits.upper().zip(limits.lower()).and_then(|(upper, lower)| width(upper - lower, 6.0 * sigma));
        let cpk = cpk(mean, sigma, limits);
        Self { below: None, above: None, cp, cpk, cp_percentile: None, cpk_percentile: None }
    }

    /// Share of assemblies outside the limits; None without any limit.
    pub fn rejected(&self) -> Option<f64> {
        match (self.below, self.above) {
            (None, None) => None,
            (below, above) => Some((below.unwrap_or(0.0) + above.unwrap_or(0.0)).min(1.0)),
        }
    }

    /// Share of assemblies within the limits; None without any limit.
    pub fn yield_(&self) -> Option<f64> {
        self.rejected().map(|rejected| 1.0 - rejected)
    }

    /// Assemblies below the lower limit, per million.
    pub fn ppm_below(&self) -> Option<f64> {
        self.below.map(|share| 1e6 * share)
    }

    /// Assemblies above the upper limit, per million.
    pub fn ppm_above(&self) -> Option<f64> {
        self.above.map(|share| 1e6 * share)
    }

    /// Sigmas from the mean of a normal beyond which, on one side, as many lie as are rejected: `-Phi^-1(rejected)`.
    /// Without the shift of 1.5 that some add. None where all or nothing is rejected.
    pub fn sigma_level(&self) -> Option<f64> {
        static NORMAL: LazyLock<Pearson> =
            LazyLock::new(|| Pearson::normal(0.0, 1.0).expect("the standard normal exists"));
        self.rejected().map(|rejected| NORMAL.upper_quantile(rejected)).filter(|level| level.is_finite())
    }
}
