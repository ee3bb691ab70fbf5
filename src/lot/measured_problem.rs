//! The problem with the measured parts in the place of the assumed dimensions.

use std::sync::Arc;

use crate::lot::{CorrelationInLot, DimensionInLot, LotError};
use crate::problem::Problem;
use sensitol_numeric::correlation::Pair;
use sensitol_numeric::dimension::Dimension;
use sensitol_numeric::distribution::{Distribution, Normal, PearsonLaw};

/// Relative difference of mean and sigma, in sigmas, up to which a scaled distribution is the requested one.
const SAME: f64 = 1e-6;

/// Problem with the measured mean, sigma, shape and correlation of the parts.
pub(super) fn with_parts(
    problem: &Problem,
    measured: &[DimensionInLot],
    correlations: &[CorrelationInLot],
    level: f64,
) -> Result<Problem, LotError> {
    let in_block = |place: usize| problem.correlation().is_some_and(|of| of.block_of(place).is_some());
    let mut dimensions = Vec::new();
    for (place, dimension) in problem.dimensions().iter().enumerate() {
        let found = measured.iter().find(|one| one.name == dimension.name() && !in_block(place));
        dimensions.push(match found {
            Some(found) => remade(dimension, found, level)?,
            None => dimension.clone(),
        });
    }
    let replaced = problem.clone().with_dimensions(dimensions)?;
    let refuted: Vec<&CorrelationInLot> = correlations.iter().filter(|pair| pair.test.refutes(level)).collect();
    if refuted.is_empty() {
        return Ok(replaced);
    }
    let mut pairs: Vec<Pair> = Vec::new();
    let names: Vec<&str> = problem.dimensions().iter().map(Dimension::name).collect();
    for (a, first) in names.iter().enumerate().filter(|(a, _)| !in_block(*a)) {
        for (b, second) in names.iter().enumerate().skip(a + 1).filter(|(b, _)| !in_block(*b)) {
            let is_pair = |pair: &&&CorrelationInLot| pair.between.iter().all(|name| name == first || name == second);
            let assumed = problem.correlation().map_or(0.0, |of| of.of(a, b));
            let value = refuted.iter().find(is_pair).map_or(assumed, |pair| pair.value.value);
            if value != 0.0 {
                pairs.push(Pair { between: [(*first).to_owned(), (*second).to_owned()], value });
            }
        }
    }
    let blocks = problem.correlation().map_or(Vec::new(), |of| of.blocks().to_vec());
    Ok(replaced.jointly(&pairs, blocks)?)
}

/// Dimension with the measured mean and sigma: of the assumed shape, or by four moments of the values if that shape is refuted.
fn remade(dimension: &Dimension, found: &DimensionInLot, level: f64) -> Result<Dimension, LotError> {
    let (mean, sigma) = (found.mean.value, found.sigma.value);
    let refuted = found.shape_test.is_some_and(|test| test.refutes(level));
    let of_values =
        found.column.as_ref().filter(|_| refuted).and_then(|column| PearsonLaw::fitted(column.values()).ok());
    let law: Arc<dyn Distribution> = match (of_values, dimension.distribution()) {
        (Some(law), _) => Arc::new(law),
        (None, Some(assumed)) => match of_shape(assumed, mean, sigma) {
            Some(law) => law,
            None => Arc::new(Normal::new(mean, sigma)?),
        },
        (None, None) => Arc::new(Normal::new(mean, sigma)?),
    };
    Ok(dimension.remade(Dimension::distributed(dimension.name(), dimension.nominal(), dimension.tolerance(), law)?))
}

/// Distribution of the assumed shape with another mean and sigma. Returns None if the shape depends on them.
fn of_shape(assumed: &dyn Distribution, mean: f64, sigma: f64) -> Option<Arc<dyn Distribution>> {
    let factor = sigma / assumed.sigma();
    let widened = assumed.scaled(factor, 0.0)?.ok()?;
    let moved = assumed.scaled(factor, mean - widened.mean())?.ok()?;
    let near = |a: f64, b: f64| (a - b).abs() <= SAME * sigma;
    (near(moved.mean(), mean) && near(moved.sigma(), sigma)).then_some(moved)
}
