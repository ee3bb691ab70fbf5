//! Types of `[[correlation]]` and `[[joint]]` in a study file.

use std::fmt;

use serde::de::{SeqAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

#[cfg(feature = "schema")]
use crate::entries::schema_parts as registry;
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::{BLOCKS, CORRELATIONS};

/// Every `[[correlation]]`, in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct Correlations(pub(crate) Vec<Spanned<CorrelationEntry>>);

/// One `[[correlation]]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { between = [\"a\", \"b\"], value = 0.4 }")]
pub(crate) struct CorrelationEntry {
    /// The two dimensions.
    pub(crate) between: Spanned<(String, String)>,
    /// Coefficient of correlation, from -1 to 1.
    pub(crate) value: Spanned<f64>,
}

/// Every `[[joint]]`, in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct Joints(pub(crate) Vec<Spanned<JointEntry>>);

/// One `[[joint]]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(extend("oneOf" = registry::one_of(["measured", "law"]))))]
#[serde(deny_unknown_fields, expecting = "a table such as { of = [\"x\", \"y\"], law = \"disc\" }")]
pub(crate) struct JointEntry {
    /// The dimensions: two of a zone, two or more of a file.
    pub(crate) of: Spanned<Vec<Spanned<String>>>,
    /// A CSV file whose rows are one part each. A dimension without a `column` takes that of its own name.
    pub(crate) measured: Option<Spanned<String>>,
    /// Zone with an even probability. Two dimensions: a disc, its rim, or a diamond, |x|/X + |y|/Y <= 1. Three: an octahedron, a bicone about
    /// the first one, or a ball. Tolerances are half widths of the zone.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::zones())))]
    pub(crate) law: Option<Spanned<String>>,
}

impl<'de> Deserialize<'de> for Correlations {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct List;
        impl<'de> Visitor<'de> for List {
            type Value = Correlations;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(CORRELATIONS)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(value::SeqAccessDeserializer::new(seq)).map(Correlations)
            }
        }
        deserializer.deserialize_any(List)
    }
}

impl<'de> Deserialize<'de> for Joints {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct List;
        impl<'de> Visitor<'de> for List {
            type Value = Joints;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(BLOCKS)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(value::SeqAccessDeserializer::new(seq)).map(Joints)
            }
        }
        deserializer.deserialize_any(List)
    }
}
