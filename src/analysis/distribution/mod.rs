//! The distribution of a characteristic: surface distribution, its tests, coverage intervals, yield and inspection risks.

pub(in crate::analysis) mod conditional;
pub(in crate::analysis) mod counted_surface;
pub(in crate::analysis) mod coverage;
pub(in crate::analysis) mod distribution_free;
pub(in crate::analysis) mod inspection;
pub(in crate::analysis) mod law_guard;
pub(in crate::analysis) mod moment_basis;
pub(in crate::analysis) mod moment_shift;
pub(in crate::analysis) mod quantile_selection;
pub mod relocated_law;
pub mod surface_law;
pub(in crate::analysis) mod yield_selection;
