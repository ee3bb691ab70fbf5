//! Conversion of the entries of a study to a problem.

pub(crate) mod compensators;
pub(crate) mod correlation;
pub(crate) mod costs;
pub(crate) mod driver;
pub(crate) mod formula_text;
pub(crate) mod grades;
pub(crate) mod implicit;
pub(crate) mod inflation;
pub(crate) mod inspection;
pub(crate) mod loss;
pub(crate) mod measured_rows;
pub(crate) mod model;
pub(crate) mod options;
pub(crate) mod problem;
pub(crate) mod sweep;
pub(crate) mod units;
pub(crate) mod zone;
pub(crate) mod zone_cost;
