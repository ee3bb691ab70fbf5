//! Surrogate of one characteristic near the means: univariate parts and products.
//!
//! ```text
//! y ~ centre + sum_j g_j(u_j) + sum_{j<k} A_jk u_j u_k          u_j = (x_j - mean_j)/sigma_j,  g_j(0) = 0
//! ```
//!
//! Difference plans fill it. Its moments are exact for any independent inputs, and for correlated normal ones with parabolas.

mod block_moments;
mod block_surface;
mod chaos;
mod correlated;
mod derivative_origin;
mod growth;
mod input_shape;
mod inputs;
mod parabolas;
mod relocation;
mod sampled_blocks;
mod sampled_remainder;
mod univariate;
mod values;

pub use crate::surrogate::block_moments::BlockMoments;
pub use crate::surrogate::input_shape::{InputShape, shapes};
pub use chaos::{Chaos, DEPENDENT, Places, Sparse};
pub use derivative_origin::DerivativeOrigin;
pub use inputs::Inputs;
pub use relocation::Relocation;
pub use univariate::Univariate;

use crate::moments::{Contributions, Interactions, Term, contributions, exact};
use crate::power::rescale;

/// Surrogate of one characteristic over N dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogate {
    /// Value of the characteristic at the means.
    pub centre: f64,
    /// Univariate part of every dimension. None if its derivatives could not be evaluated.
    pub parts: Vec<Option<Univariate>>,
    /// Products of two inputs.
    pub interactions: Interactions,
}

rescale!(Surrogate { centre, parts, interactions } without {});

impl Surrogate {
    /// Moments and contributions. Returns None if a part is unknown, or an input's tail makes its variance infinite.
    ///
    /// Exact if the inputs are independent, over blocks, and if the correlated inputs are normal and their parts parabolas. Otherwise
    /// sampled from the surrogate, with standard errors ([`Contributions::sampled`]).
    ///
    /// Shapes: `inputs` has length N, in the order of the parts.
    pub fn contributions(&self, inputs: &Inputs) -> Option<Contributions> {
        if let Some(correlation) = inputs.correlation() {
            if !correlation.blocks().is_empty() {
                return crate::surrogate::block_moments::pooled(self, inputs, correlation);
            }
            return correlated::correlated(self, inputs, correlation);
        }
        let found = contributions(self.centre, &self.terms(inputs)?, &self.interactions);
        Some(found).filter(|found| !found.moments.sigma().is_nan())
    }

    fn terms<'a>(&self, inputs: &'a Inputs) -> Option<Vec<Term<'a>>> {
        self.parts.iter().zip(inputs.shapes()).map(|(part, shape)| Some(part.as_ref()?.term(shape))).collect()
    }

    /// Variance and its standard error, which is 0 if the variance is exact. Returns None if a part is unknown or the variance infinite.
    ///
    /// Cost for independent inputs: one pass over the parts and products. All four moments take N^3 instead.
    pub fn variance(&self, inputs: &Inputs) -> Option<(f64, f64)> {
        if inputs.correlation().is_some() {
            let of = self.contributions(inputs)?;
            let (sigma, error) = (of.moments.sigma(), of.sampled.map_or(0.0, |sampled| sampled.sigma));
            return Some((sigma * sigma, 2.0 * sigma * error));
        }
        let terms = self.terms(inputs)?;
        let parts = terms.iter().map(|term| term.variance(1.0));
        let variance = exact(parts.chain([self.interactions.variance(1.0)]));
        (!variance.is_nan()).then_some((variance, 0.0))
    }
}
