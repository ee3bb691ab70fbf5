//! Distributions over the whole line whose sides are unlike.

pub(in crate::distribution) mod gumbel;
pub(in crate::distribution) mod split_normal;
