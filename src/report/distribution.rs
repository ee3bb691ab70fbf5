//! The fitted distribution, as reports show it.

use serde::{Serialize, Serializer};

use crate::capability::{Law, TAIL};
use crate::pearson::Pearson;

/// The probabilities whose quantiles every report has, by their names; the upper ones by what lies above, for `1 - p` would
/// lose digits.
const PROBABILITIES: [(&str, Tail); 7] = [
    (NAMES[0], Tail::Below(TAIL)),
    (NAMES[1], Tail::Below(0.01)),
    (NAMES[2], Tail::Below(0.05)),
    (NAMES[3], Tail::Below(0.5)),
    (NAMES[4], Tail::Above(0.05)),
    (NAMES[5], Tail::Above(0.01)),
    (NAMES[6], Tail::Above(TAIL)),
];

/// Their names.
pub(super) const NAMES: [&str; 7] = ["0.00135", "0.01", "0.05", "0.5", "0.95", "0.99", "0.99865"];

/// Their names as estimates.
pub(super) const QUANTILES: [&str; 7] = [
    "quantile 0.00135",
    "quantile 0.01",
    "quantile 0.05",
    "quantile 0.5",
    "quantile 0.95",
    "quantile 0.99",
    "quantile 0.99865",
];

#[derive(Clone, Copy)]
enum Tail {
    Below(f64),
    Above(f64),
}

/// The distribution that has a characteristic's moments.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(tag = "family", rename_all = "lowercase")]
pub enum DistributionReport {
    /// Every assembly has the same value.
    Point {
        /// The value.
        at: f64,
    },
    /// A member of the Pearson system.
    Pearson {
        /// Its type.
        #[serde(rename = "type")]
        kind: &'static str,
        /// Lower and upper end, where there are any.
        support: [Option<f64>; 2],
        /// Quantiles.
        quantiles: Quantiles,
    },
}

/// Quantiles by the names of their probabilities.
#[derive(Debug, Clone, PartialEq)]
pub struct Quantiles(pub Vec<(&'static str, f64)>);

impl Serialize for Quantiles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

/// Quantiles of which some may be unknown.
#[derive(Debug, Clone, PartialEq)]
pub struct OptionalQuantiles(pub Vec<(&'static str, Option<f64>)>);

impl Serialize for OptionalQuantiles {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.0.iter().copied())
    }
}

impl DistributionReport {
    pub(super) fn of(law: &Law) -> Self {
        match law {
            Law::Point { at } => Self::Point { at: *at },
            Law::Pearson(pearson) => Self::Pearson {
                kind: pearson.kind().name(),
                support: pearson.support().map(|end| Some(end).filter(|end| end.is_finite())),
                quantiles: Quantiles::of(pearson),
            },
        }
    }
}

impl Quantiles {
    pub(super) fn of(law: &Pearson) -> Self {
        let quantile = |tail| match tail {
            Tail::Below(p) => law.quantile(p),
            Tail::Above(p) => law.upper_quantile(p),
        };
        Self(PROBABILITIES.map(|(name, tail)| (name, quantile(tail))).to_vec())
    }
}
