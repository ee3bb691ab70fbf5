//! Estimators of points of the model.

mod normal_space;

pub(crate) use crate::estimate::normal_space::{Columns, NormalSpace};
