//! Joint yield of the surrogates.

use serde::Serialize;

use crate::allocation::surface::response::Responses;
use crate::problem::Problem;
use sensitol_numeric::parallel::prelude::*;
use sensitol_numeric::sampling::{Draws, Portion, Sampler, wilson};

/// Joint yield from a sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct JointYield {
    /// Share of assemblies within all limits.
    #[serde(rename = "yield")]
    pub value: f64,
    /// Standard error of the share. None if all or no points lie within the limits.
    pub standard_error: Option<f64>,
    /// 95 % interval.
    pub interval: [f64; 2],
    /// Number of points of the surrogates. The model is not evaluated at them.
    pub samples: usize,
}

/// Points that are evaluated together.
const ROWS: usize = 1024;
/// Number of such portions.
const PORTIONS: usize = 32;

/// Joint yield of the surrogates at the tolerances of the problem. Returns None for fewer than two characteristics with
/// limits, and if a dimension cannot be sampled or a surrogate is unknown.
pub(in crate::allocation) fn joint(problem: &Problem, responses: &Responses, seed: u64) -> Option<JointYield> {
    let limits: Vec<usize> =
        (0..problem.characteristics().len()).filter(|&c| problem.characteristics()[c].limits().exist()).collect();
    if limits.len() < 2 {
        return None;
    }
    let draws = Draws::new(problem.dimensions(), problem.correlation(), Sampler::Random, seed).ok()?;
    let ones = vec![1.0; problem.dimensions().len()];
    let surrogates: Vec<_> = (limits.iter())
        .map(|&c| responses.relocated(c, &ones, None).map(|(surrogate, _)| surrogate))
        .collect::<Option<_>>()?;
    let varying = responses.varying();
    let within = |portion: usize| -> Option<usize> {
        let points = draws.points(Portion { replicate: 0, first: (portion * ROWS) as u64, rows: ROWS });
        let columns = problem.standardised(&points, varying);
        let mut keeps = vec![true; ROWS];
        for (k, &c) in limits.iter().enumerate() {
            let rises = surrogates[k].rises(&columns)?;
            let limits = problem.kept_limits(c);
            let values = rises.iter().map(|rise| surrogates[k].centre + rise);
            keeps.iter_mut().zip(values).for_each(|(keeps, value)| *keeps &= limits.contains(value));
        }
        Some(keeps.iter().filter(|keeps| **keeps).count())
    };
    let within: usize = (0..PORTIONS).into_par_iter().map(within).collect::<Option<Vec<_>>>()?.iter().sum();
    let samples = ROWS * PORTIONS;
    let value = within as f64 / samples as f64;
    Some(JointYield {
        value,
        standard_error: (within > 0 && within < samples).then(|| (value * (1.0 - value) / samples as f64).sqrt()),
        interval: wilson(within as f64, samples as f64),
        samples,
    })
}
