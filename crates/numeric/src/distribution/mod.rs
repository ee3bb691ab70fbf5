//! Input distributions, one file each, behind one trait.
//!
//! The derivative methods need the mean, the sigma, the standardised moments and the support of a distribution. A [`Jacobi`] matrix gives
//! Gauss rules, which supply evaluation nodes and quadrature.
//!
//! # A new distribution
//! One new file with a type that implements [`Distribution`], one line in the list below, one arm where study files name distributions
//! (`crates/study/src/dimension/kinds.rs`), and one row in `crates/testing/src/densities.rs`.

mod ends;
mod error;
mod family;
mod inverse;
pub mod outliers;
mod probability;
pub mod rule;
pub mod sample;
mod score_table;
mod standard_moments;
pub mod standard_normal;
pub(crate) mod ziggurat;

pub use crate::distribution::family::beta::Beta;
pub use crate::distribution::family::central_moments::CentralMoments;
pub use crate::distribution::family::curvilinear_trapezoid::CurvilinearTrapezoid;
pub use crate::distribution::family::drifting::Drifting;
pub use crate::distribution::family::exponential::Exponential;
pub use crate::distribution::family::gamma::Gamma;
pub use crate::distribution::family::lognormal::Lognormal;
pub use crate::distribution::family::measured::Measured;
pub use crate::distribution::family::mixture::{Mixture, Part};
pub use crate::distribution::family::normal::Normal;
pub use crate::distribution::family::pearson::PearsonLaw;
pub use crate::distribution::family::rayleigh::Rayleigh;
pub use crate::distribution::family::solid_coordinate::{SolidAxis, SolidCoordinate};
pub use crate::distribution::family::student::Student;
pub use crate::distribution::family::tabulated::Tabulated;
pub use crate::distribution::family::trapezoidal::Trapezoidal;
pub use crate::distribution::family::triangular::Triangular;
pub use crate::distribution::family::truncated_normal::TruncatedNormal;
pub use crate::distribution::family::two_values::TwoValues;
pub use crate::distribution::family::u_shaped::UShaped;
pub use crate::distribution::family::unequal::gumbel::{ExtremeEnd, Gumbel};
pub use crate::distribution::family::unequal::split_normal::SplitNormal;
pub use crate::distribution::family::uniform::Uniform;
pub use crate::distribution::family::weibull::Weibull;
pub use error::DistributionError;
pub use outliers::outliers;
pub use probability::Probability;
pub use probability::behind_normal;
pub use rule::Jacobi;
pub use rule::Rule;
pub use sample::{Resample, Reweighted, Sample};
pub use score_table::ScoreTable;
pub use standard_moments::StandardMoments;

use error::{between, interval};
pub(crate) use error::{finite, positive};

use std::fmt::Debug;
use std::sync::Arc;

/// Distribution that follows from another one by scaling, or the error of its parameters.
pub type Scaled = Result<Arc<dyn Distribution>, DistributionError>;

/// Probability distribution of one dimension, with sigma above 0.
///
/// A dimension that does not vary has no distribution, so an implementation never divides by zero.
pub trait Distribution: Debug + Send + Sync {
    /// Name in study files, such as `normal`.
    fn name(&self) -> &'static str;

    /// Mean, in the dimension's own unit.
    fn mean(&self) -> f64;

    /// Standard deviation, in the dimension's own unit; finite and above 0.
    fn sigma(&self) -> f64;

    /// Moments 3 to 8 of `u = (x - mean)/sigma`, analytic wherever a closed form exists. Moments that do not exist are NaN, as those of
    /// Student's distribution of an order not below its degrees of freedom.
    fn standard_moments(&self) -> StandardMoments;

    /// Smallest and largest possible value, in the dimension's own unit; infinite if there is no bound or if it is unknown.
    fn support(&self) -> [f64; 2];

    /// Recurrence coefficients of the orthogonal polynomials of `u = (x - mean)/sigma` up to `order`, or as far as they are known. A
    /// distribution known by eight moments ends at order 4, one with `m` atoms at order `m`.
    fn jacobi(&self, order: usize) -> Jacobi;

    /// Density, probabilities, quantiles and samples. Returns None if only moments are known.
    fn probability(&self) -> Option<&dyn Probability>;

    /// Distribution of the same kind for a tolerance that is `factor` times as wide, with the band middle moved by `moved`. Returns None if
    /// the distribution does not follow from the tolerance.
    ///
    /// A normal distribution and those over the band keep their shape: widths scale, the middle moves, and a `shift` of the mean against it
    /// stays. Those with a tail get a sigma `factor` times as large at the same mean and origin, so their shape changes. Exponential and
    /// Rayleigh distributions have the mean as only parameter and do not scale. Those known by moments or by data do not scale either.
    ///
    /// # Errors
    /// Returns an error if the scaled parameters are out of range.
    fn scaled(&self, factor: f64, moved: f64) -> Option<Scaled> {
        let _ = (factor, moved);
        None
    }

    /// Measured values that the distribution was made from. Returns None if it was given by parameters.
    fn measured(&self) -> Option<&dyn Resample> {
        None
    }
}
