//! The surrogate: what is known of one characteristic near the means, as univariate parts and products.
//!
//! ```text
//! y ~ centre + sum_j g_j(u_j) + sum_{j<k} A_jk u_j u_k          u_j = (x_j - mean_j)/sigma_j,  g_j(0) = 0
//! ```
//!
//! It is filled by difference plans; its moments are exact for any independent inputs, and for correlated normal ones.

mod chaos;
mod correlated;
mod derivative_origin;
mod drawn;
mod growth;
mod inputs;
mod parabolas;
mod pooled;
mod relocation;
mod sampled;
mod setting;
mod shape;
mod univariate;
mod values;

pub use chaos::{Chaos, DEPENDENT, Places, Sparse};
pub use derivative_origin::DerivativeOrigin;
pub use inputs::Inputs;
pub use pooled::Pooled;
pub use relocation::Relocation;
pub use shape::{InputShape, shapes};
pub use univariate::Univariate;

use crate::moments::{Contributions, Interactions, Term, contributions, exact};
use crate::power::rescale;

/// One characteristic's surrogate over N dimensions.
#[derive(Debug, Clone, PartialEq)]
pub struct Surrogate {
    /// The characteristic at the means.
    pub centre: f64,
    /// For every dimension its own part; None where no derivative could be had.
    pub parts: Vec<Option<Univariate>>,
    /// The products.
    pub interactions: Interactions,
}

rescale!(Surrogate { centre, parts, interactions } without {});

impl Surrogate {
    /// Moments and contributions; None when a part is unknown, or an input's tail makes its variance infinite.
    ///
    /// Exact where the inputs are independent, where those that are not are normal and their parts parabolas, and over blocks;
    /// sampled from the surrogate otherwise, with standard errors ([`Contributions::sampled`]).
    ///
    /// Shapes: `inputs` has length N, in the order of the parts.
    pub fn contributions(&self, inputs: &Inputs) -> Option<Contributions> {
        if let Some(correlation) = inputs.correlation() {
            if !correlation.blocks().is_empty() {
                return pooled::pooled(self, inputs, correlation);
            }
            return correlated::correlated(self, inputs, correlation);
        }
        let found = contributions(self.centre, &self.terms(inputs)?, &self.interactions);
        Some(found).filter(|found| !found.moments.sigma().is_nan())
    }

    fn terms<'a>(&self, inputs: &'a Inputs) -> Option<Vec<Term<'a>>> {
        self.parts.iter().zip(inputs.shapes()).map(|(part, shape)| Some(part.as_ref()?.term(shape))).collect()
    }

    /// The variance and its standard error, 0 where it is exact; None when a part is unknown or it is infinite.
    ///
    /// Of independent inputs it takes a pass over the parts and products, where all four moments take the cube of N.
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
