//! Type of `guard` of a characteristic in a study file.

use std::fmt;

use serde::de::{Deserialize, Deserializer, Visitor, value};

use crate::entries::spanned::Spanned;

/// Guard band: `0.01`, or `{ false_accept = 0.001 }`.
#[derive(Debug)]
pub(crate) enum GuardEntry {
    Width(f64),
    Table(GuardTable),
}

/// The share that a guard is to reach.
#[derive(Debug, serde::Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(crate) struct GuardTable {
    /// The greatest share of all parts that may be bad and accepted.
    pub(crate) false_accept: Spanned<f64>,
}

impl<'de> Deserialize<'de> for GuardEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Of;
        impl<'de> Visitor<'de> for Of {
            type Value = GuardEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a guard band such as 0.01, or { false_accept = 0.001 },")
            }

            fn visit_f64<E>(self, width: f64) -> Result<Self::Value, E> {
                Ok(GuardEntry::Width(width))
            }

            fn visit_i64<E>(self, width: i64) -> Result<Self::Value, E> {
                Ok(GuardEntry::Width(width as f64))
            }

            fn visit_u64<E>(self, width: u64) -> Result<Self::Value, E> {
                Ok(GuardEntry::Width(width as f64))
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                GuardTable::deserialize(value::MapAccessDeserializer::new(map)).map(GuardEntry::Table)
            }
        }
        deserializer.deserialize_any(Of)
    }
}
