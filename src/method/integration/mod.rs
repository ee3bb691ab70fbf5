//! Methods that integrate values by quadrature rules.

pub(in crate::method) mod bivariate_dimension_reduction;
pub(in crate::method) mod dimension_reduction;
pub(in crate::method) mod quadrature;
pub(in crate::method) mod three_point;
