//! Types of `[costs]`, `[loss]` and `require` in a study file.

use std::fmt;
use std::ops::Range;

use serde::de::{IgnoredAny, Visitor, value};
use serde::{Deserialize, Deserializer};

use crate::entries::distribution_entry::{DistributionEntry, distribution};
use crate::entries::named_entries::Entries;
#[cfg(feature = "schema")]
use crate::entries::schema_parts as registry;
use crate::entries::spanned::Spanned;

/// One line of `[costs]`.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(extend("oneOf" = registry::one_of(["model", "formula", "table", "same_as", "processes"]))))]
#[serde(deny_unknown_fields, expecting = "a table such as { model = \"reciprocal\", a = 1.0, b = 0.1 }")]
pub(crate) struct CostEntry {
    /// The cost over the half band T: reciprocal a + b/T, reciprocal-power a + b/T^k, exponential a + b exp(-T/c).
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::cost_models())))]
    pub(crate) model: Option<Spanned<String>>,
    /// Constant part of the cost.
    #[cfg_attr(feature = "schema", schemars(extend("default" = 0)))]
    pub(crate) a: Option<Spanned<f64>>,
    /// Factor of the part that falls with a wider tolerance.
    pub(crate) b: Option<Spanned<f64>>,
    /// Exponent of a reciprocal power.
    pub(crate) k: Option<Spanned<f64>>,
    /// Half band over which an exponential cost falls to 1/e.
    pub(crate) c: Option<Spanned<f64>>,
    /// The cost as a formula of T, the half band in the unit of the dimension, in place of a model: "0.02/T + 0.0004/T^2".
    pub(crate) formula: Option<Spanned<String>>,
    /// The cost as points [half band, cost], in place of a model; between two of them it is a straight line in 1/T.
    pub(crate) table: Option<Spanned<Vec<[f64; 2]>>>,
    /// Least half band; a tenth of the present one unless given, and the least of a table.
    pub(crate) min: Option<Spanned<f64>>,
    /// Greatest half band; ten times the present one unless given, and the greatest of a table.
    pub(crate) max: Option<Spanned<f64>>,
    /// Tolerances are whole multiples of this half band.
    pub(crate) step: Option<Spanned<f64>>,
    /// Tolerances are standard grades of ISO 286-1 for the nominal size, from the first to the last: ["IT6", "IT10"]; half bands are half of them.
    pub(crate) grades: Option<Spanned<[String; 2]>>,
    /// End of the band that does not move, `lower` or `upper`; unless given that of a fit, else the middle.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["lower", "upper", "middle"])))]
    pub(crate) fixed_side: Option<Spanned<String>>,
    /// The dimensions of a zone, each with its half band per unit of the half band T. The nominal value of a dimension without tolerance is
    /// this factor times T.
    pub(crate) of: Option<Spanned<Entries<f64>>>,
    /// The unit of T for a zone.
    pub(crate) unit: Option<Spanned<String>>,
    /// The wider zone that this one refines; T is never above the T of that zone.
    pub(crate) within: Option<Spanned<String>>,
    /// The dimension with which this one shares tolerance and process; each part costs.
    pub(crate) same_as: Option<Spanned<String>>,
    /// The processes that compete for it.
    pub(crate) processes: Option<Spanned<Vec<Spanned<ProcessEntry>>>>,
}

/// One line of `[loss]`.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { k = 40.0, target = 0.0 }")]
pub(crate) struct LossEntry {
    /// Cost per square of the deviation from the target: k (sigma^2 + (mean - target)^2).
    pub(crate) k: Option<Spanned<f64>>,
    /// The value from which deviations count; the middle of two limits unless given.
    pub(crate) target: Option<Spanned<f64>>,
    /// Cost of an assembly that breaks a limit.
    pub(crate) scrap: Option<Spanned<f64>>,
}

/// A process: one half band at one cost, or a range of them with a cost that follows.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a process such as { name = \"grind\", tolerance = 0.002, cost = 19.4 }")]
pub(crate) struct ProcessEntry {
    /// Name of the process.
    pub(crate) name: Spanned<String>,
    /// The half band that it holds.
    pub(crate) tolerance: Option<Spanned<f64>>,
    /// The cost of a part.
    pub(crate) cost: Option<Spanned<f64>>,
    /// Machine of the process; its cost in [setup] is paid once for all dimensions.
    pub(crate) machine: Option<Spanned<String>>,
    /// The cost over a range of half bands, as of a dimension.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::cost_models())))]
    pub(crate) model: Option<Spanned<String>>,
    /// Constant part of the cost.
    #[cfg_attr(feature = "schema", schemars(extend("default" = 0)))]
    pub(crate) a: Option<Spanned<f64>>,
    /// Factor of the part that falls with a wider tolerance.
    pub(crate) b: Option<Spanned<f64>>,
    /// Exponent of a reciprocal power.
    pub(crate) k: Option<Spanned<f64>>,
    /// Half band over which an exponential cost falls to 1/e.
    pub(crate) c: Option<Spanned<f64>>,
    /// Least half band that it holds.
    pub(crate) min: Option<Spanned<f64>>,
    /// Greatest half band that it holds.
    pub(crate) max: Option<Spanned<f64>>,
    /// A line of [processes] with the keys that are left out here.
    #[serde(default, rename = "process")]
    #[cfg_attr(feature = "schema", schemars(with = "Option<String>"))]
    pub(crate) _process: Option<IgnoredAny>,
    /// Distribution of its parts, as of a dimension; beside `tolerance`. If one process of a list has a distribution, each has its own, and
    /// that of the dimension is not used.
    #[serde(default, deserialize_with = "distribution")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::word_or_table"))]
    pub(crate) distribution: Option<Spanned<DistributionEntry>>,
    /// Standard deviation of its parts.
    pub(crate) sigma: Option<Spanned<f64>>,
    /// Number of sigmas in half its tolerance band.
    pub(crate) sigmas: Option<Spanned<f64>>,
    /// Capability: half band by three sigma.
    pub(crate) cp: Option<Spanned<f64>>,
    /// Capability with the place of the mean, as of a dimension.
    pub(crate) cpk: Option<Spanned<f64>>,
    /// Side of the mean beside cp and cpk, "+" or "-".
    #[cfg_attr(feature = "schema", schemars(extend("enum" = ["+", "-"])))]
    pub(crate) side: Option<Spanned<String>>,
    /// Greatest distance of the mean of a lot from the mean of all.
    pub(crate) drift: Option<Spanned<f64>>,
}

impl ProcessEntry {
    /// First key that states a distribution, with its place. Returns None if the process states none.
    pub(crate) fn spread(&self) -> Option<(&'static str, Range<usize>)> {
        let span = |of: &Option<Spanned<f64>>| of.as_ref().map(Spanned::span);
        [
            ("distribution", self.distribution.as_ref().map(Spanned::span)),
            ("sigma", span(&self.sigma)),
            ("sigmas", span(&self.sigmas)),
            ("cp", span(&self.cp)),
            ("cpk", span(&self.cpk)),
            ("side", self.side.as_ref().map(Spanned::span)),
            ("drift", span(&self.drift)),
        ]
        .into_iter()
        .find_map(|(key, span)| Some((key, span?)))
    }
}

/// `"worst-case"`, `"rss"`, or `{ yield = 0.9973 }`, `{ cpk = 1.33 }`, `{ sigma = 0.05 }`.
#[derive(Debug)]
pub(crate) enum RequireEntry {
    Word(String),
    Table(RequireTable),
}

/// A number that is required.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(extend("oneOf" = registry::one_of(["yield", "cpk", "sigma"]))))]
#[serde(deny_unknown_fields)]
pub(crate) struct RequireTable {
    /// The least share of assemblies within the limits.
    #[serde(rename = "yield")]
    pub(crate) yield_: Option<Spanned<f64>>,
    /// The least Cpk.
    pub(crate) cpk: Option<Spanned<f64>>,
    /// The greatest sigma.
    pub(crate) sigma: Option<Spanned<f64>>,
}

impl<'de> Deserialize<'de> for RequireEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Require;
        impl<'de> Visitor<'de> for Require {
            type Value = RequireEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a requirement such as \"worst-case\", \"rss\" or { cpk = 1.33 },")
            }

            fn visit_str<E>(self, word: &str) -> Result<Self::Value, E> {
                Ok(RequireEntry::Word(word.to_owned()))
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                RequireTable::deserialize(value::MapAccessDeserializer::new(map)).map(RequireEntry::Table)
            }
        }
        deserializer.deserialize_any(Require)
    }
}
