//! The uncertainty of a characteristic at a station.

use crate::analysis::CharacteristicAnalysis;
use sensitol_numeric::requirement::Requirement;

/// How far the bad ends of the intervals lie from the figures by which trial tolerances are judged; 0 where nothing is known of an
/// error.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Unknown {
    /// From the share that the surface law keeps, or the Pearson fit.
    pub(super) yield_: f64,
    pub(super) cpk: f64,
    pub(super) sigma: f64,
}

impl Unknown {
    pub(super) fn of(found: &CharacteristicAnalysis, by_law: bool) -> Self {
        let law = found.surface_law.as_ref().filter(|_| by_law).and_then(|law| law.yield_());
        let judged = law.or_else(|| found.pearson?.yield_());
        let yield_ = judged.zip(found.yield_interval()).map(|(value, [low, _])| value - low);
        // The target of a requirement does not change its interval.
        let cpk = found.judge(Requirement::Cpk(1.0));
        let sigma = found.judge(Requirement::Sigma(1.0));
        let of = |value: Option<f64>, end: Option<f64>| value.zip(end).map_or(0.0, |(value, end)| (value - end).abs());
        Self {
            yield_: yield_.unwrap_or(0.0),
            cpk: of(cpk.value, cpk.interval.map(|[low, _]| low)),
            sigma: of(sigma.value, sigma.interval.map(|[_, high]| high)),
        }
    }

    /// Both together.
    pub(super) fn and(self, other: Self) -> Self {
        Self { yield_: self.yield_ + other.yield_, cpk: self.cpk + other.cpk, sigma: self.sigma + other.sigma }
    }

    /// The greater of two, each by itself.
    pub(super) fn most(self, other: Self) -> Self {
        Self { yield_: self.yield_.max(other.yield_), cpk: self.cpk.max(other.cpk), sigma: self.sigma.max(other.sigma) }
    }
}
