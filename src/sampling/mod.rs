//! Points of the inputs' joint distribution, random or quasi-random, and what is estimated from them.

mod draws;
mod estimate;
mod fine;
mod joe_kuo;
mod joint;
mod largest;
mod measured;
mod normals;
mod ranks;
mod sampling_interval;
mod sobol;
mod stream;
mod summary;

pub use draws::{Draws, Portion, Sampler, SamplingError};
pub(crate) use draws::{Room, tails};
pub use estimate::{Estimate, clopper_pearson, wilson};
pub(crate) use estimate::{FEWEST, of_moments, one_error, weighted_interval};
pub use fine::{Fine, Scale};
pub use joe_kuo::SOBOL_DIMENSIONS;
pub(crate) use joint::Joint;
pub(crate) use largest::{LargestPoints, LargestShare, LargestTerms, settled};
pub(crate) use measured::{MeasuredBasis, MeasuredSample};
pub(crate) use normals::Normals;
pub use ranks::rank_first;
pub use sampling_interval::SamplingInterval;
pub use sobol::Sobol;
pub use summary::Summary;
