//! Standard error from independent replicates.

use sensitol_numeric::sampling::{Summary, student_quantile};

/// Standard error of the mean of independent replicates. It is widened so that two of it are the 95 % interval of Student's distribution,
/// with one degree of freedom fewer than there are replicates. Returns None if one has no value.
pub(super) fn of_replicates(values: impl Iterator<Item = Option<f64>>) -> Option<f64> {
    let values: Vec<f64> = values.collect::<Option<_>>()?;
    let count = values.len() as f64;
    let student = (count > 1.0).then(|| student_quantile(0.975, count - 1.0))?;
    Some(0.5 * student * Summary::of(&values).sigma() / count.sqrt())
}
