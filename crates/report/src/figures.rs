//! Figures that documents need from every result of a characteristic.

use sensitol::analysis::{CharacteristicAnalysis, DerivativeOrigin, Interaction, Missing};
use sensitol::rare::RareCharacteristic;
use sensitol::simulation::SimulatedCharacteristic;
use sensitol_numeric::capability::{Capability, Law};
use sensitol_numeric::characteristic::Characteristic;
use sensitol_numeric::moments::Moments;
use sensitol_numeric::sampling::Estimate;

/// Access to the characteristic of a result: name, unit, limits, target.
pub(super) trait Named {
    fn characteristic(&self) -> &Characteristic;

    fn name(&self) -> &str {
        self.characteristic().name()
    }

    fn unit(&self) -> Option<&str> {
        self.characteristic().unit()
    }

    fn lower(&self) -> Option<f64> {
        self.characteristic().limits().lower()
    }

    fn upper(&self) -> Option<f64> {
        self.characteristic().limits().upper()
    }

    fn limits(&self) -> [Option<f64>; 2] {
        [self.lower(), self.upper()]
    }

    fn limited(&self) -> bool {
        self.characteristic().limits().exist()
    }

    fn target(&self) -> Option<f64> {
        self.characteristic().target_yield()
    }
}

impl Named for Characteristic {
    fn characteristic(&self) -> &Characteristic {
        self
    }
}

impl Named for CharacteristicAnalysis {
    fn characteristic(&self) -> &Characteristic {
        &self.characteristic
    }
}

impl Named for SimulatedCharacteristic {
    fn characteristic(&self) -> &Characteristic {
        &self.characteristic
    }
}

impl Named for RareCharacteristic {
    fn characteristic(&self) -> &Characteristic {
        &self.characteristic
    }
}

/// Figures of a result. None if they are unknown.
pub(super) trait Figures {
    fn mean(&self) -> Option<f64>;
    fn sigma(&self) -> Option<f64>;
    fn skewness(&self) -> Option<f64>;
    fn kurtosis(&self) -> Option<f64>;
    fn yield_(&self) -> Option<f64>;
    fn ppm_below(&self) -> Option<f64>;
    fn ppm_above(&self) -> Option<f64>;
}

impl Figures for CharacteristicAnalysis {
    fn mean(&self) -> Option<f64> {
        self.moments.map(|of| of.mean())
    }

    fn sigma(&self) -> Option<f64> {
        self.moments.map(|of| of.sigma())
    }

    fn skewness(&self) -> Option<f64> {
        self.moments.as_ref().and_then(Moments::skewness)
    }

    fn kurtosis(&self) -> Option<f64> {
        self.moments.as_ref().and_then(Moments::kurtosis)
    }

    fn yield_(&self) -> Option<f64> {
        self.distribution.capability.as_ref().and_then(Capability::yield_)
    }

    fn ppm_below(&self) -> Option<f64> {
        self.distribution.capability.as_ref().and_then(Capability::ppm_below)
    }

    fn ppm_above(&self) -> Option<f64> {
        self.distribution.capability.as_ref().and_then(Capability::ppm_above)
    }
}

fn value(estimate: Option<Estimate>) -> Option<f64> {
    estimate.map(|estimate| estimate.value)
}

impl Figures for SimulatedCharacteristic {
    fn mean(&self) -> Option<f64> {
        value(self.mean)
    }

    fn sigma(&self) -> Option<f64> {
        value(self.sigma)
    }

    fn skewness(&self) -> Option<f64> {
        value(self.skewness)
    }

    fn kurtosis(&self) -> Option<f64> {
        value(self.kurtosis)
    }

    fn yield_(&self) -> Option<f64> {
        self.yield_.map(|share| share.value)
    }

    fn ppm_below(&self) -> Option<f64> {
        self.below.map(|share| 1e6 * share)
    }

    fn ppm_above(&self) -> Option<f64> {
        self.above.map(|share| 1e6 * share)
    }
}

/// Figures of the fitted distribution of a characteristic.
pub(crate) trait FittedFigures {
    /// Scale that sets the printed digits: sigma, or the RSS if sigma is 0.
    fn scale(&self) -> f64;

    /// Returns the distribution with the moments of the characteristic, or None if there is none.
    fn fitted(&self) -> Option<&Law>;

    /// Counts the interactions with evaluated points or exact values. Those that a stopped run left open and screened guesses do not
    /// count.
    fn examined(&self) -> usize;

    /// Interactions that are only screened guesses.
    fn screened(&self) -> impl Iterator<Item = Interaction<'_>>;
}

impl FittedFigures for CharacteristicAnalysis {
    fn scale(&self) -> f64 {
        self.sigma().filter(|&sigma| sigma > 0.0).or(self.linear.rss).unwrap_or(0.0)
    }

    fn fitted(&self) -> Option<&Law> {
        self.evidence.law.as_ref()?.as_ref().ok()
    }

    fn examined(&self) -> usize {
        let failed =
            self.contributions.interactions.iter().filter(|pair| pair.missing == Some(Missing::Failed)).count();
        self.contributions.examined_interactions + failed
    }

    fn screened(&self) -> impl Iterator<Item = Interaction<'_>> {
        self.contributions.interactions.iter().filter(|pair| pair.origin == Some(DerivativeOrigin::Screened))
    }
}

/// Names of the quantiles in the list of estimates.
pub(super) const QUANTILES: [&str; 7] = [
    "quantile 0.00135",
    "quantile 0.01",
    "quantile 0.05",
    "quantile 0.5",
    "quantile 0.95",
    "quantile 0.99",
    "quantile 0.99865",
];
