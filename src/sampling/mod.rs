//! Points of the inputs' joint distribution, random or quasi-random, and what is estimated from them.

mod draws;
mod estimate;
mod fine;
mod joint;
mod sobol;
mod summary;

pub use draws::{Draws, Portion, Sampler, SamplingError};
pub(crate) use estimate::of_moments;
pub use estimate::{Estimate, wilson};
pub use fine::{Fine, Scale};
pub(crate) use joint::Joint;
pub use sobol::{SOBOL_DIMENSIONS, Sobol};
pub use summary::Summary;
