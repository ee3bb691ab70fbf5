//! Families of distributions, one file each; `unequal` holds those over the whole line whose sides are unlike.

pub(in crate::distribution) mod beta;
pub(in crate::distribution) mod central_moments;
pub(in crate::distribution) mod curvilinear_trapezoid;
pub(in crate::distribution) mod discretised;
pub(in crate::distribution) mod drifting;
pub(in crate::distribution) mod exponential;
pub(in crate::distribution) mod gamma;
pub(in crate::distribution) mod lognormal;
pub(in crate::distribution) mod measured;
pub(in crate::distribution) mod mixture;
pub(in crate::distribution) mod normal;
pub(in crate::distribution) mod one_sided;
pub(in crate::distribution) mod pearson;
pub(in crate::distribution) mod rayleigh;
pub(in crate::distribution) mod solid_coordinate;
pub(in crate::distribution) mod student;
pub(in crate::distribution) mod tabulated;
pub(in crate::distribution) mod trapezoidal;
pub(in crate::distribution) mod triangular;
pub(in crate::distribution) mod truncated_normal;
pub(in crate::distribution) mod two_values;
pub(in crate::distribution) mod u_shaped;
pub(in crate::distribution) mod unequal;
pub(in crate::distribution) mod uniform;
pub(in crate::distribution) mod weibull;
