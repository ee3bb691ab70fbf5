//! Serialisation of samples, with the figures that follow from them: standard errors, the distribution and the verdicts.

use crate::simulation::conclusion::{Empirical, SimulatedConclusion, StandardErrors};
use crate::simulation::{SimulatedCharacteristic, Simulation};
use crate::warning::serialize::warnings_last;
use sensitol_numeric::capability::Quantiles;
use sensitol_numeric::json_form::Four;
use sensitol_numeric::sampling::Estimate;
use sensitol_numeric::serialize_with_conclusion;

warnings_last!(Simulation);
serialize_with_conclusion!(SimulatedCharacteristic);

impl SimulatedCharacteristic {
    /// Figures that follow from the estimates.
    pub fn conclusion(&self) -> SimulatedConclusion {
        let error = |estimate: Option<Estimate>| estimate.and_then(|estimate| estimate.standard_error);
        let moments = [self.mean, self.sigma, self.skewness, self.kurtosis].map(error);
        let value = |estimate: Option<Estimate>| estimate.map(|estimate| estimate.value);
        SimulatedConclusion {
            standard_error: StandardErrors {
                moments: Four::from(&moments),
                yield_: self.yield_.map(|share| share.interval),
                quantiles: Quantiles(self.quantiles.map(error)),
            },
            distribution: Empirical { family: "empirical", quantiles: Quantiles(self.quantiles.map(value)) },
            yield_interval: self.yield_interval(),
            yield_bounds: self.yield_bounds(),
            verdicts: self.verdicts(),
        }
    }
}
