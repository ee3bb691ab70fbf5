//! Statistics of a measured lot: figures with intervals, tests of the assumptions, and variance components.
//!
//! Intervals hold with 95 % each, by themselves. Tests have p-values, and [`holm`] makes a family of them hold one level together.
//! Values are in the order in which the parts were measured.

mod column;
mod column_tests;
mod components;
mod departure;
mod pair;
mod posterior;
mod prediction;
mod process_capability;
mod reference_law;
mod shape;
mod significance;
mod trend;

pub use column::LotSample;
pub use column_tests::ColumnTests;
pub use components::{GroupComparison, compare_groups};
pub use departure::{Departure, likeliest_departure};
pub use pair::{CorrelationEstimate, correlation_estimate};
pub use posterior::{NormalPrior, Posterior};
pub use prediction::{
    MeasuredPair, MeasuredPart, PredictedVariance, compare_means, compare_spreads, predicted_yield_interval,
};
pub use process_capability::{ProcessPerformance, performance};
pub use reference_law::{chi_squared_quantile, fisher_quantile, fisher_sf, student_two_sided};
pub use shape::{anderson_darling_normal, cramer_von_mises_of_shape};
pub use significance::{LotFigure, LotTest, holm};
pub use trend::{LotTrend, linear_trend};

/// Probability beyond either end of a 95 % interval.
pub(crate) const SIDE: f64 = 0.025;
