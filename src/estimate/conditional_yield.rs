//! Yield of the assemblies that keep the limits of another characteristic.

use serde::Serialize;

use crate::problem::Problem;
use sensitol_numeric::verdict;

/// Yield of the assemblies that keep the limits of another characteristic: `P(both kept) / P(other kept)`.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[non_exhaustive]
pub struct ConditionalYield {
    /// Characteristic whose limits decide which assemblies count.
    pub given: String,
    /// Share of these assemblies that keep the own limits.
    #[serde(rename = "yield")]
    pub value: f64,
    /// 95 % interval of the share. None if the uncertainty of measured samples is unknown.
    pub interval: Option<[f64; 2]>,
}

/// Shares of rejects, with their interval by measured samples: None if nothing is measured, Some(None) if it is unknown.
pub(crate) type MeasuredRejects = (f64, Option<Option<[f64; 2]>>);

impl ConditionalYield {
    /// Yield with an interval that measured samples of both characteristics widen.
    pub(crate) fn new(given: &str, value: f64, own: [f64; 2], measured: [MeasuredRejects; 2]) -> Self {
        let mut interval = Some(own);
        for (rejected, ends) in measured {
            interval = match (interval, ends) {
                (known, None) => known,
                (Some(known), Some(Some([low, high]))) => {
                    let ends = [value - (high - rejected).max(0.0), value + (rejected - low).max(0.0)];
                    Some(verdict::joined(value, known, ends))
                }
                _ => None,
            };
        }
        Self { given: given.to_owned(), value, interval: interval.map(verdict::share) }
    }
}

/// Pairs of a characteristic and the one that it is given, by their places.
pub(crate) fn conditions(problem: &Problem) -> Vec<[usize; 2]> {
    let names = problem.characteristics();
    let of = |c: usize| Some([c, names.iter().position(|one| Some(one.name()) == names[c].given())?]);
    (0..names.len()).filter_map(of).collect()
}
