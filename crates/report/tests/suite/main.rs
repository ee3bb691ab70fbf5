//! Reports of studies.

mod conventions;
mod correlation;
