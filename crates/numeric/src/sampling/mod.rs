//! Points of the inputs' joint distribution, random or quasi-random, and what is estimated from them.

mod draws;
mod estimate;
mod fine;
mod joe_kuo;
mod joint;
mod normals;
mod ranks;
mod sobol;
mod stream;
mod summary;

pub use draws::{Draws, Portion, Sampler, SamplingError};
pub use draws::{Room, tails};
pub use estimate::{Estimate, wilson};
pub use estimate::{FEWEST, of_moments, one_error};
pub use fine::{Fine, Scale};
pub use joe_kuo::SOBOL_DIMENSIONS;
pub use joint::Joint;
pub use normals::Normals;
pub use ranks::rank_first;
pub use sobol::Sobol;
pub use summary::Summary;
