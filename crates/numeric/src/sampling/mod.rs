//! Random and quasi-random points of the inputs' joint distribution, and estimates from them.

mod covariance;
mod critical;
mod draws;
mod estimate;
mod fine;
mod joe_kuo;
mod largest;
mod measured;
mod normals;
mod ranks;
mod sampling_interval;
mod sobol;
mod stream;
mod summary;

pub use crate::sampling::covariance::Joint;
pub(crate) use critical::beta_quantile;
pub use critical::student_quantile;
pub use draws::{Draws, Portion, Sampler, SamplingError, all_known};
pub use draws::{Room, tails};
pub use estimate::weighted_interval;
pub use estimate::{Estimate, FEWEST, clopper_pearson, of_moments, one_error, wilson};
pub use fine::{Fine, Scale};
pub use joe_kuo::SOBOL_DIMENSIONS;
pub use largest::{LargestPoints, LargestShare, LargestTerms, settled};
pub use measured::{MeasuredBasis, MeasuredSample};
pub use normals::Normals;
pub use ranks::rank_first;
pub use sampling_interval::SamplingInterval;
pub use sobol::Sobol;
pub use summary::Summary;
