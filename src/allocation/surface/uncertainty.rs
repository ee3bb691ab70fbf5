//! Uncertainty of a characteristic at a linearization point.

use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::requirement::Requirement;

/// Distances of the pessimistic ends of the intervals from the figures that judge trial tolerances. They are 0 if an
/// error is unknown.
#[derive(Debug, Clone, Copy, Default)]
pub(in crate::allocation) struct Unknown {
    /// Distance from the yield by the surface distribution, or by the Pearson fit.
    pub(in crate::allocation) yield_: f64,
    pub(in crate::allocation) cpk: f64,
    pub(in crate::allocation) sigma: f64,
}

impl Unknown {
    pub(in crate::allocation) fn of(found: &CharacteristicAnalysis, by_law: bool) -> Self {
        let law = found.surface_law.as_ref().filter(|_| by_law).and_then(|law| law.yield_());
        let judged = law.or_else(|| found.pearson?.yield_());
        let yield_ = judged.zip(found.yield_interval()).map(|(value, [low, _])| value - low);
        // The interval does not depend on the target of the requirement.
        let cpk = found.judge(Requirement::Cpk(1.0));
        let sigma = found.judge(Requirement::Sigma(1.0));
        let of = |value: Option<f64>, end: Option<f64>| value.zip(end).map_or(0.0, |(value, end)| (value - end).abs());
        Self {
            yield_: yield_.unwrap_or(0.0),
            cpk: of(cpk.value, cpk.interval.map(|[low, _]| low)),
            sigma: of(sigma.value, sigma.interval.map(|[_, high]| high)),
        }
    }

    /// Sum of two uncertainties.
    pub(in crate::allocation) fn and(self, other: Self) -> Self {
        Self { yield_: self.yield_ + other.yield_, cpk: self.cpk + other.cpk, sigma: self.sigma + other.sigma }
    }

    /// Greater of two uncertainties, for each figure.
    pub(in crate::allocation) fn most(self, other: Self) -> Self {
        Self { yield_: self.yield_.max(other.yield_), cpk: self.cpk.max(other.cpk), sigma: self.sigma.max(other.sigma) }
    }
}
