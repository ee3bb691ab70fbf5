//! Parts of the variance, independent of the method that they come from.

use crate::method::{Fitted, Integrated};
use sensitol_numeric::moments::{Contributions, Moments, Sampled};
use sensitol_numeric::surrogate::Inputs;

/// Moments and contributions, of a surrogate or of an integration without one.
pub(in crate::analysis) enum Shares {
    Surrogate(Contributions),
    Integrated(Integrated),
}

impl Shares {
    pub(in crate::analysis) fn of(fitted: &Fitted, inputs: &Inputs) -> Option<Self> {
        match &fitted.integrated {
            Some(integrated) => Some(Self::Integrated(integrated.clone())),
            None => fitted.surrogate.as_ref()?.contributions(inputs).map(Self::Surrogate),
        }
    }

    /// Adds an independent part with this variance.
    pub(in crate::analysis) fn beside(self, variance: Option<f64>) -> Self {
        match (self, variance) {
            (Self::Surrogate(contributions), Some(variance)) => Self::Surrogate(contributions.beside(variance.sqrt())),
            (shares, _) => shares,
        }
    }

    pub(in crate::analysis) fn moments(&self) -> Moments {
        match self {
            Self::Surrogate(contributions) => contributions.moments,
            Self::Integrated(integrated) => integrated.moments,
        }
    }

    pub(in crate::analysis) fn sampled(&self) -> Option<Sampled> {
        match self {
            Self::Surrogate(contributions) => contributions.sampled,
            Self::Integrated(_) => None,
        }
    }

    pub(in crate::analysis) fn linear(&self, position: usize) -> Option<f64> {
        match self {
            Self::Surrogate(contributions) => Some(contributions.linear[position]),
            Self::Integrated(integrated) => Some(integrated.own[position]?.linear),
        }
    }

    pub(in crate::analysis) fn curvature(&self, position: usize) -> Option<f64> {
        match self {
            Self::Surrogate(contributions) => Some(contributions.curvature[position]),
            Self::Integrated(integrated) => Some(integrated.own[position]?.curvature),
        }
    }

    pub(in crate::analysis) fn mean_shift(&self, position: usize) -> Option<f64> {
        match self {
            Self::Surrogate(contributions) => Some(contributions.mean_shift[position]),
            Self::Integrated(integrated) => integrated.own[position]?.mean_shift,
        }
    }

    /// Share of the pair at this place among the examined ones, with its coefficient.
    pub(in crate::analysis) fn pair(
        &self,
        index: usize,
        (j, k): (usize, usize),
        coefficient: Option<f64>,
    ) -> Option<f64> {
        match self {
            Self::Surrogate(contributions) => Some(contributions.share(j, k, coefficient?)),
            Self::Integrated(integrated) => Some(integrated.pairs[index]?.share),
        }
    }

    /// Mean shift by the pair at this place, with its coefficient and the correlation of the two.
    pub(in crate::analysis) fn pair_shift(&self, index: usize, coefficient: Option<f64>, together: f64) -> Option<f64> {
        match self {
            Self::Surrogate(_) => Some(coefficient? * together),
            Self::Integrated(integrated) => integrated.pairs[index]?.mean_shift,
        }
    }
}
