//! The standard error that independent replicates tell.

use crate::sampling::Summary;

/// The 97.5 % quantile of Student's distribution with 15 degrees of freedom: for 16 replicates.
const STUDENT: f64 = 2.131_449_545_559_323;

/// The standard error of the mean of independent replicates, widened so that two of it are Student's 95 %; None where one
/// has no value.
pub(super) fn of_replicates(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let summary = Summary::of(&values);
    (values.len() > 1).then(|| 0.5 * STUDENT * summary.sigma() / (values.len() as f64).sqrt())
}
