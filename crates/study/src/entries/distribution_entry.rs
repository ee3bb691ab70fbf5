//! Type of `distribution` in a study file, for a dimension or a process.

use std::fmt;

use serde::de::{MapAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

use crate::entries::named_entries::Entries;
#[cfg(feature = "schema")]
use crate::entries::schema_parts as registry;
use crate::entries::spanned::Spanned;
use crate::entries::values::ToleranceEntry;

/// `"uniform"` or `{ kind = "beta", alpha = 2, beta = 5 }`: the parameters of all kinds.
#[derive(Debug, Clone, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct DistributionEntry {
    /// The kind of distribution.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::kinds())))]
    pub(crate) kind: String,
    /// Most probable value of a triangular distribution; the band's middle unless given.
    pub(crate) mode: Option<Spanned<f64>>,
    /// Share of the band of a trapezoidal distribution over which it is flat, from 0 to 1.
    pub(crate) top: Option<Spanned<f64>>,
    /// Exponent of a beta distribution at the lower end, above 0.
    pub(crate) alpha: Option<Spanned<f64>>,
    /// Exponent of a beta distribution at the upper end, above 0.
    pub(crate) beta: Option<Spanned<f64>>,
    /// Distance by which the two ends of the band of a curvilinear trapezoid may be off, above 0 and below half the band.
    pub(crate) inexactness: Option<Spanned<f64>>,
    /// Degrees of freedom of a student distribution, above 2.
    pub(crate) degrees: Option<Spanned<f64>>,
    /// Scale of a student distribution, in place of sigma: sigma is scale sqrt(degrees/(degrees - 2)). A standard uncertainty with
    /// degrees of freedom is a scale.
    pub(crate) scale: Option<Spanned<f64>>,
    /// Origin of a distribution with a tail.
    #[cfg_attr(feature = "schema", schemars(extend("default" = 0)))]
    pub(crate) origin: Option<Spanned<f64>>,
    /// The parts of a mixture by name.
    pub(crate) parts: Option<Spanned<Entries<PartEntry>>>,
    /// Sigma of a split normal distribution below the nominal; without it that of the lower deviation by sigmas.
    pub(crate) below: Option<Spanned<f64>>,
    /// Sigma of a split normal distribution above the nominal; without it that of the upper deviation by sigmas.
    pub(crate) above: Option<Spanned<f64>>,
    /// Normal scores of a table of quantiles, ascending: the value at the score z has the probability Phi(z) below it. Between two scores
    /// the value is a monotone cubic of the score.
    pub(crate) scores: Option<Spanned<Vec<f64>>>,
    /// Values of the dimension at the scores of a table of quantiles, ascending; the first and last are its ends. The dimension needs a
    /// nominal too. Its mean follows from the table.
    pub(crate) values: Option<Spanned<Vec<f64>>>,
    /// Least and greatest mean of an unknown distribution, as values of the dimension; the ends of the band unless given.
    pub(crate) mean: Option<Spanned<[f64; 2]>>,
    /// Greatest sigma of an unknown distribution.
    pub(crate) sigma_at_most: Option<Spanned<f64>>,
    /// True if an unknown distribution is symmetric about the middle of the band.
    #[cfg_attr(feature = "schema", schemars(extend("default" = false)))]
    pub(crate) symmetric: Option<Spanned<bool>>,
    /// True if the density of an unknown symmetric distribution falls on either side of the middle.
    #[cfg_attr(feature = "schema", schemars(extend("default" = false)))]
    pub(crate) unimodal: Option<Spanned<bool>>,
}

/// A part of a mixture: a weight, and the keys of a dimension that differ.
#[derive(Debug, Clone, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { weight = 0.6, shift = 0.02, sigma = 0.01 }")]
pub(crate) struct PartEntry {
    /// Weight, relative to those of the other parts.
    pub(crate) weight: Spanned<f64>,
    /// Nominal value; that of the dimension unless given.
    pub(crate) nominal: Option<Spanned<f64>>,
    /// Tolerance; that of the dimension unless given.
    pub(crate) tolerance: Option<Spanned<ToleranceEntry>>,
    /// Limits, in place of a tolerance.
    pub(crate) limits: Option<Spanned<[f64; 2]>>,
    /// Distribution: the name of a kind, or a table with its parameters.
    #[serde(default, deserialize_with = "distribution")]
    #[cfg_attr(feature = "schema", schemars(schema_with = "registry::distribution::<DistributionEntry>", extend("default" = "normal")))]
    pub(crate) distribution: Option<Spanned<DistributionEntry>>,
    /// Standard deviation.
    pub(crate) sigma: Option<Spanned<f64>>,
    /// Number of sigmas in half a tolerance band.
    pub(crate) sigmas: Option<Spanned<f64>>,
    /// Process capability: sigmas/3.
    pub(crate) cp: Option<Spanned<f64>>,
    /// Distance of the mean from the middle of the band.
    pub(crate) shift: Option<Spanned<f64>>,
}

/// Reads a text, which names the kind alone, or a table with parameters. For `deserialize_with`.
pub(crate) fn distribution<'de, D: Deserializer<'de>>(
    deserializer: D,
) -> Result<Option<Spanned<DistributionEntry>>, D::Error> {
    Option::<Spanned<WordOrTable>>::deserialize(deserializer)
        .map(|entry| entry.map(|entry| Spanned::new(entry.span(), entry.into_inner().0)))
}

struct WordOrTable(DistributionEntry);

impl<'de> Deserialize<'de> for WordOrTable {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Distribution;
        impl<'de> Visitor<'de> for Distribution {
            type Value = WordOrTable;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a distribution such as \"uniform\", or { kind = \"uniform\" },")
            }

            fn visit_str<E>(self, kind: &str) -> Result<Self::Value, E> {
                Ok(WordOrTable(DistributionEntry { kind: kind.to_owned(), ..Default::default() }))
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                DistributionEntry::deserialize(value::MapAccessDeserializer::new(map)).map(WordOrTable)
            }
        }
        deserializer.deserialize_any(Distribution)
    }
}
