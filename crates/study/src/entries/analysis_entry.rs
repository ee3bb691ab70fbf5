//! Types of the section `[analysis]` of a study file.

use std::fmt;

use serde::de::{SeqAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

#[cfg(feature = "schema")]
use crate::entries::schema_parts as registry;
use crate::entries::spanned::Spanned;
#[cfg(feature = "schema")]
use sensitol::method::{ACCURACY, Options};

/// Names of two dimensions whose product is a term of the surface.
pub(crate) type Product = (Spanned<String>, Spanned<String>);

/// `[analysis]`.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table of options")]
pub(crate) struct AnalysisEntry {
    /// The method.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::methods(), "default" = Options::default().method.name())))]
    pub(crate) method: Option<Spanned<String>>,
    /// Target relative error of sigma, for auto.
    #[cfg_attr(feature = "schema", schemars(extend("default" = ACCURACY)))]
    pub(crate) accuracy: Option<Spanned<f64>>,
    /// Target error of the skewness, for auto.
    pub(crate) accuracy_skewness: Option<Spanned<f64>>,
    /// Target error of the kurtosis, for auto.
    pub(crate) accuracy_kurtosis: Option<Spanned<f64>>,
    /// Target error of the yield, a share such as 1e-5, for auto.
    pub(crate) accuracy_yield: Option<Spanned<f64>>,
    /// Greatest number of evaluations. A method that needs more is an error; auto stays below. Unless given, a method may need 1000000.
    pub(crate) budget: Option<Spanned<u64>>,
    /// Evaluate at so many sigma on either side, in place of the nodes that suit each distribution.
    pub(crate) step: Option<Spanned<f64>>,
    /// The interactions that six-n examines: strongest, adjacent, or a list of pairs of names.
    pub(crate) pairs: Option<Spanned<PairsEntry>>,
    /// Pairs of dimensions whose product is in a formula, such as size and place of a bonus. Methods of second order use their exact mixed
    /// derivative without an evaluation. Geometric elements add their own pairs.
    pub(crate) products: Option<Spanned<Vec<Product>>>,
    /// Stencil by which six-n evaluates an interaction.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::stencils())))]
    pub(crate) stencil: Option<Spanned<String>>,
    /// Number of nodes that the quadrature rules of dimension-reduction have, univariate or bivariate.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = [3, 5, 7], "default" = 5)))]
    pub(crate) nodes: Option<Spanned<u64>>,
    /// Sensitivities of all dimensions, at two evaluations more for each without tolerance, or of the varying ones alone.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::sensitivities(), "default" = "varying")))]
    pub(crate) sensitivities: Option<Spanned<String>>,
    /// Source of derivatives, for sensitivities and moments alike. Left out: exact sensitivities where the model gives them,
    /// moments by differences.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::derivatives())))]
    pub(crate) derivatives: Option<Spanned<String>>,
    /// True if the extremes in the box of the tolerance bands are searched too.
    #[cfg_attr(feature = "schema", schemars(extend("default" = false)))]
    pub(crate) extremes: Option<bool>,
    /// Seed of the random numbers.
    #[cfg_attr(feature = "schema", schemars(extend("default" = Options::SEED)))]
    pub(crate) seed: Option<Spanned<u64>>,
    /// Least share of assemblies within the limits of all characteristics at once, between 0 and 1; --check judges it, and allocate keeps
    /// it.
    pub(crate) target_joint_yield: Option<Spanned<f64>>,
    /// Factor of the inflated RSS, or "modified": 1 + (W - R)/(2 R (sqrt n - 1)), with worst case W and RSS R.
    #[cfg_attr(feature = "schema", schemars(extend("default" = 1.5)))]
    pub(crate) rss_factor: Option<Spanned<FactorEntry>>,
    /// The part of every half band by which its mean may be off in the mean-shift RSS, from 0 to 1.
    #[cfg_attr(feature = "schema", schemars(extend("default" = 0.5)))]
    pub(crate) mean_shift: Option<Spanned<f64>>,
    /// Share of coverage intervals and expanded uncertainties, from 0.5 to below 1. Each characteristic then has the interval with equal
    /// tails and the shortest one.
    pub(crate) coverage: Option<Spanned<f64>>,
    /// Number of check points of a costly model, 0 for none; a cheap model is sampled instead. Unless given: 12 near the means, 6 to 18
    /// where decisions fall, and up to 8 more if they refute the surface.
    pub(crate) verify: Option<u64>,
}

/// `"strongest"`, `"adjacent"` or `[["a", "b"], ["c", "d"]]`.
#[derive(Debug)]
pub(crate) enum PairsEntry {
    Word(String),
    Listed(Vec<(String, String)>),
}

/// Factor of the inflated RSS: `1.5` or `"modified"`.
#[derive(Debug, Clone)]
pub(crate) enum FactorEntry {
    Number(f64),
    Word(String),
}

impl<'de> Deserialize<'de> for PairsEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Pairs;
        impl<'de> Visitor<'de> for Pairs {
            type Value = PairsEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("\"strongest\", \"adjacent\", or pairs of dimensions such as [[\"a\", \"b\"]],")
            }

            fn visit_str<E>(self, word: &str) -> Result<Self::Value, E> {
                Ok(PairsEntry::Word(word.to_owned()))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(value::SeqAccessDeserializer::new(seq)).map(PairsEntry::Listed)
            }
        }
        deserializer.deserialize_any(Pairs)
    }
}

impl<'de> Deserialize<'de> for FactorEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Factor;
        impl Visitor<'_> for Factor {
            type Value = FactorEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number such as 1.5, or \"modified\",")
            }

            fn visit_str<E>(self, word: &str) -> Result<Self::Value, E> {
                Ok(FactorEntry::Word(word.to_owned()))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
                Ok(FactorEntry::Number(number))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
                Ok(FactorEntry::Number(number as f64))
            }
        }
        deserializer.deserialize_any(Factor)
    }
}
