//! Facts about a distribution that is not known otherwise.

use crate::dimension::{BandPromise, Dimension};

/// Band of an input, and further promises on its distribution.
#[derive(Debug, Clone, PartialEq)]
pub struct DistributionPromise {
    band: [f64; 2],
    mean: Option<[f64; 2]>,
    sigma: Option<f64>,
    symmetric: bool,
    unimodal: bool,
}

/// Fault of a promise.
#[derive(Debug, Clone, Copy, PartialEq, thiserror::Error)]
pub enum PromiseFault {
    /// The band is empty or not finite.
    #[error("the band must go from a lower to a higher finite value, not from {low} to {high}")]
    Band {
        /// Lower end.
        low: f64,
        /// Upper end.
        high: f64,
    },
    /// The mean is outside the band, or its range is reversed.
    #[error("the mean must lie in a range within the band, not from {low} to {high}")]
    Mean {
        /// Lower end of the range.
        low: f64,
        /// Upper end of the range.
        high: f64,
    },
    /// The sigma is not above 0.
    #[error("sigma must be at most a number above 0, not {sigma}")]
    Sigma {
        /// Value given.
        sigma: f64,
    },
    /// A symmetric distribution has its mean in the middle of the band, which the range of the mean excludes.
    #[error(
        "a symmetric distribution has its mean in the middle of the band, {middle}, which the range of the mean excludes"
    )]
    Symmetric {
        /// Middle of the band.
        middle: f64,
    },
}

impl DistributionPromise {
    /// Promises that all values lie within a band.
    ///
    /// # Errors
    /// If the band is empty or not finite.
    pub fn new([low, high]: [f64; 2]) -> Result<Self, PromiseFault> {
        match low < high && (high - low).is_finite() {
            true => Ok(Self { band: [low, high], mean: None, sigma: None, symmetric: false, unimodal: false }),
            false => Err(PromiseFault::Band { low, high }),
        }
    }

    /// Promises a mean within a range.
    ///
    /// # Errors
    /// If the range is reversed or leaves the band, or if it excludes the middle of a symmetric distribution.
    pub fn with_mean(mut self, [low, high]: [f64; 2]) -> Result<Self, PromiseFault> {
        if !(self.band[0] <= low && low <= high && high <= self.band[1]) {
            return Err(PromiseFault::Mean { low, high });
        }
        self.mean = Some([low, high]);
        self.checked()
    }

    /// Promises a standard deviation of at most `sigma`.
    ///
    /// # Errors
    /// If it is not above 0.
    pub fn with_sigma(mut self, sigma: f64) -> Result<Self, PromiseFault> {
        if !(sigma > 0.0 && sigma.is_finite()) {
            return Err(PromiseFault::Sigma { sigma });
        }
        self.sigma = Some(sigma);
        Ok(self)
    }

    /// Promises symmetry about the middle of the band.
    ///
    /// # Errors
    /// If the range of the mean excludes the middle.
    pub fn symmetric(mut self) -> Result<Self, PromiseFault> {
        self.symmetric = true;
        self.checked()
    }

    /// Promises symmetry about the middle of the band, and a density that falls on either side of it.
    ///
    /// # Errors
    /// If the range of the mean excludes the middle.
    pub fn symmetric_and_unimodal(mut self) -> Result<Self, PromiseFault> {
        (self.symmetric, self.unimodal) = (true, true);
        self.checked()
    }

    fn checked(self) -> Result<Self, PromiseFault> {
        let middle = self.middle();
        match self.symmetric && self.mean.is_some_and(|[low, high]| middle < low || middle > high) {
            true => Err(PromiseFault::Symmetric { middle }),
            false => Ok(self),
        }
    }

    /// Promise of a dimension, in its unit. Returns None if its distribution is known.
    ///
    /// # Errors
    /// If the promise contradicts itself.
    pub fn of(dimension: &Dimension) -> Option<Result<Self, PromiseFault>> {
        let band = dimension.reach().map(|deviation| dimension.nominal() + deviation);
        Some(Self::over(band, &dimension.convention().promise?))
    }

    /// Promise over a band, from facts in half bands.
    ///
    /// # Errors
    /// If the band is empty, or if the facts contradict each other.
    pub fn over(band: [f64; 2], facts: &BandPromise) -> Result<Self, PromiseFault> {
        let mut promise = Self::new(band)?;
        let (middle, half) = (promise.middle(), 0.5 * (band[1] - band[0]));
        if let Some(mean) = facts.mean {
            let [low, high] = mean.map(|of| (middle + of * half).clamp(band[0], band[1]));
            promise = promise.with_mean([low, high])?;
        }
        if let Some(sigma) = facts.sigma {
            promise = promise.with_sigma(sigma * half)?;
        }
        match (facts.symmetric, facts.unimodal) {
            (_, true) => promise.symmetric_and_unimodal(),
            (true, false) => promise.symmetric(),
            (false, false) => Ok(promise),
        }
    }

    /// Promise of a sum of independent inputs, each times a slope that is not 0.
    ///
    /// Bands and ranges of means are added, and sigmas as the root of the sum of squares. A sum is symmetric if all inputs are, and unimodal
    /// if all are symmetric and unimodal (Wintner 1938). Distributions other than sums keep this promise too, unless there is one input or
    /// bands alone are promised: the bounds of the yield hold, but need not be attained.
    ///
    /// # Errors
    /// If there is no input.
    pub fn of_sum(inputs: &[(f64, Self)]) -> Result<Self, PromiseFault> {
        let ends = |slope: f64, [low, high]: [f64; 2]| {
            if slope < 0.0 { [slope * high, slope * low] } else { [slope * low, slope * high] }
        };
        let (mut band, mut means, mut variance) = ([0.0; 2], [0.0; 2], Some(0.0));
        for (slope, input) in inputs {
            for (sum, end) in band.iter_mut().zip(ends(*slope, input.band)) {
                *sum += end;
            }
            for (sum, end) in means.iter_mut().zip(ends(*slope, input.means())) {
                *sum += end;
            }
            variance = variance.zip(input.sigma).map(|(sum, sigma)| sum + (slope * sigma).powi(2));
        }
        let sum = Self::new(band)?;
        let symmetric = inputs.iter().all(|(_, input)| input.symmetric);
        Ok(Self {
            mean: (!symmetric && inputs.iter().any(|(_, input)| input.mean.is_some())).then_some(means),
            sigma: variance.map(f64::sqrt),
            symmetric,
            unimodal: inputs.iter().all(|(_, input)| input.unimodal),
            ..sum
        })
    }

    /// True if nothing but the band is promised.
    pub fn is_band_alone(&self) -> bool {
        self.mean.is_none() && self.sigma.is_none() && !self.symmetric
    }

    /// Least and greatest value.
    pub fn band(&self) -> [f64; 2] {
        self.band
    }

    /// Middle of the band.
    pub fn middle(&self) -> f64 {
        f64::midpoint(self.band[0], self.band[1])
    }

    /// Range of the mean.
    pub(super) fn means(&self) -> [f64; 2] {
        match (self.symmetric, self.mean) {
            (true, _) => [self.middle(); 2],
            (false, Some(range)) => range,
            (false, None) => self.band,
        }
    }

    /// Greatest standard deviation.
    pub(super) fn sigma(&self) -> Option<f64> {
        self.sigma
    }

    pub(super) fn is_symmetric(&self) -> bool {
        self.symmetric
    }

    pub(super) fn is_unimodal(&self) -> bool {
        self.unimodal
    }

    /// Range of the variable of the program: the band, or half-widths about its middle.
    pub(super) fn range(&self) -> [f64; 2] {
        match self.symmetric {
            true => [0.0, 0.5 * (self.band[1] - self.band[0])],
            false => self.band,
        }
    }
}
