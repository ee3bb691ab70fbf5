//! Largest variation that keeps a requirement.

use crate::allocation::surface::pearson_slack::YieldSlack;

/// Largest sigma that keeps a requirement, at a mean and a shape.
pub(in crate::allocation) enum Slack {
    /// Sigma that does not depend on the shape, with the derivative of its logarithm by the mean.
    Given {
        sigma: f64,
        by_mean: f64,
    },
    Yield(YieldSlack),
}

impl Slack {
    pub(in crate::allocation) fn sigma(&self) -> f64 {
        match self {
            Self::Given { sigma, .. } => *sigma,
            Self::Yield(slack) => slack.sigma(),
        }
    }

    /// Derivatives of its logarithm by mean, skewness and excess.
    pub(super) fn slopes(&self) -> Option<[f64; 3]> {
        match self {
            Self::Given { by_mean, .. } => Some([*by_mean, 0.0, 0.0]),
            Self::Yield(slack) => slack.slopes(),
        }
    }
}

/// Variation divided by its slack. No variation uses no slack.
pub(super) fn by_slack(own: f64, slack: f64) -> f64 {
    match own == 0.0 {
        true if slack > 0.0 => 0.0,
        true => f64::INFINITY,
        false => own / slack,
    }
}
