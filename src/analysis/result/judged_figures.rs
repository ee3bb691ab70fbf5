//! Figures of an analysis that judge requirements, and the bases of their certainty.

use crate::analysis::result::characteristic::CharacteristicAnalysis;
use crate::analysis::result::figure_basis::FigureBasis;
use crate::method::ErrorEstimate;
use sensitol_numeric::characteristic::SpecLimits;
use sensitol_numeric::requirement::{Requirement, RequirementFigures};
use sensitol_numeric::verdict::JudgedFigure;

impl RequirementFigures for CharacteristicAnalysis {
    type Figure = JudgedFigure;

    /// Yield with [its interval](CharacteristicAnalysis::yield_interval). Of a characteristic with a condition it is the yield of the
    /// assemblies that count.
    fn yield_(&self) -> JudgedFigure {
        if self.characteristic.given().is_some() {
            let known = self.distribution.conditional.as_ref();
            return JudgedFigure { value: known.map(|of| of.value), interval: known.and_then(|of| of.interval) };
        }
        // The worst distribution decides, not the one that stands in for it.
        let value = match &self.distribution.distribution_free_yield {
            Some(free) => free.interval.map(|[least, _]| least),
            None => self.distribution.capability.and_then(|of| of.yield_()),
        };
        JudgedFigure { value, interval: self.yield_interval() }
    }

    /// Cpk with the interval by the estimated errors of mean and sigma, and by the uncertainty of measured samples.
    fn cpk(&self) -> JudgedFigure {
        // It depends on the distribution that is not known.
        if self.distribution.distribution_free_yield.is_some() {
            return JudgedFigure::default();
        }
        let value = self.distribution.capability.and_then(|of| of.cpk);
        let Some(moments) = self.moments else { return JudgedFigure { value, interval: None } };
        let mean = (moments.mean(), self.error_of(|of| of.mean));
        let sigma = (moments.sigma(), self.error_of(|of| of.sigma));
        JudgedFigure::cpk(value, mean, sigma, self.characteristic.limits(), self.evidence.sampling.as_ref())
    }

    /// Sigma with the interval by its estimated error, and by the uncertainty of measured samples.
    fn sigma(&self) -> JudgedFigure {
        if self.distribution.distribution_free_yield.is_some() {
            return JudgedFigure::default();
        }
        let Some(moments) = self.moments else { return JudgedFigure::default() };
        let error = self.error_of(|of| of.sigma);
        JudgedFigure::sigma(moments.sigma(), error, self.evidence.sampling.as_ref())
    }

    /// Fraction of the limits that the RSS uses. It follows from the slopes, and has no error.
    fn rss(&self) -> JudgedFigure {
        let middle = self.linear.middle.zip(self.linear.rss);
        let value = middle.and_then(|(middle, rss)| used_part(self.characteristic.limits(), middle, [rss; 2]));
        JudgedFigure { value, interval: value.map(|value| [value; 2]) }
    }

    /// Fraction of the limits that the worst case uses. It lies between values that were found and the bounds of interval arithmetic.
    fn worst_case(&self) -> JudgedFigure {
        let found = self.worst_case_taken();
        found.map(|(value, interval)| JudgedFigure { value: Some(value), interval }).unwrap_or_default()
    }
}

/// Bases of the figures that judge requirements.
struct RequirementBases<'r>(&'r CharacteristicAnalysis);

impl RequirementFigures for RequirementBases<'_> {
    type Figure = Option<FigureBasis>;

    fn yield_(&self) -> Option<FigureBasis> {
        match &self.0.distribution.distribution_free_yield {
            Some(free) if free.proven => Some(FigureBasis::Proof),
            Some(free) => free.interval.map(|_| FigureBasis::Points),
            None => self.0.bases().yield_,
        }
    }

    fn cpk(&self) -> Option<FigureBasis> {
        self.0.basis_of_moments()
    }

    fn sigma(&self) -> Option<FigureBasis> {
        self.0.basis_of_moments()
    }

    fn rss(&self) -> Option<FigureBasis> {
        self.0.basis_of_moments()
    }

    fn worst_case(&self) -> Option<FigureBasis> {
        Some(if self.0.proof().is_some() { FigureBasis::Proof } else { FigureBasis::Surface })
    }
}

impl CharacteristicAnalysis {
    /// Basis of the verdict on a requirement. Returns None if the requirement is not judged.
    pub fn basis_of(&self, requirement: Requirement) -> Option<FigureBasis> {
        requirement.figure(&RequirementBases(self))
    }

    /// Estimated error of a moment. A constant has none.
    fn error_of(&self, of: fn(&ErrorEstimate) -> Option<f64>) -> Option<f64> {
        if self.constant { Some(0.0) } else { self.error_estimate.as_ref().and_then(of) }
    }

    /// Part of the distance to the limits that the worst case uses, and its interval.
    ///
    /// The interval lies between values that exist and the bounds of interval arithmetic, if the formula has bounds. It follows from the
    /// slopes if the function is proven to be linear, and otherwise from the surface.
    fn worst_case_taken(&self) -> Option<(f64, Option<[f64; 2]>)> {
        let (nominal, linear) = self.nominal.zip(self.range.worst_case)?;
        let part = |[low, high]: [f64; 2], more: f64| {
            let reach = [nominal - low, high - nominal].map(|reach| (reach + more).max(0.0));
            used_part(self.characteristic.limits(), nominal, reach)
        };
        let by_slopes = part(linear, 0.0)?;
        if self.constant {
            return Some((by_slopes, Some([by_slopes; 2])));
        }
        if let Some(proof) = self.proof().filter(|proof| proof.proven) {
            let ([low, high], [below, above]) = (proof.bounds, proof.slack);
            let most = part(proof.bounds, 0.0)?;
            let reached = part([low + below, high - above], 0.0)?;
            return Some((most, Some([reached.min(most), most])));
        }
        if self.is_proven_linear() {
            return Some((by_slopes, Some([by_slopes; 2])));
        }
        let found = self.range.extremes.as_ref().and_then(|found| part([found.least.value, found.greatest.value], 0.0));
        if let Some(proof) = self.proof() {
            let most = part(proof.bounds, 0.0)?;
            let least = found.unwrap_or(0.0).min(most);
            return Some((found.unwrap_or(by_slopes), Some([least, most])));
        }
        let around = self.range.curved.and_then(|curved| Some([part(linear, -curved)?, part(linear, curved)?]));
        Some(match found {
            // A search without a proof shows only values that are reached.
            Some(found) => (found, around.map(|[_, most]| [found, found.max(most)])),
            None => (by_slopes, around),
        })
    }
}

/// Greatest part of the distance between a value and the limits that is used, below and above it. Infinite if there is no distance.
fn used_part(limits: SpecLimits, from: f64, [below, above]: [f64; 2]) -> Option<f64> {
    // If the value is at its limit and nothing extends beyond it, nothing is used.
    let part = |reach: f64, room: f64| match room > 0.0 {
        true => reach / room,
        false if room == 0.0 && reach <= 4.0 * f64::EPSILON * from.abs() => 0.0,
        false => f64::INFINITY,
    };
    let below = limits.lower().map(|lower| part(below, from - lower));
    let above = limits.upper().map(|upper| part(above, upper - from));
    below.into_iter().chain(above).reduce(f64::max)
}
