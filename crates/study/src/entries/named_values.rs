//! Types of constants and unknowns in a study file.

use std::fmt;

use serde::de::{MapAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

/// One line of `[unknowns]`: `59.0` or `{ start = 59.0, lower = 0.0 }`.
#[derive(Debug)]
pub(crate) struct UnknownEntry {
    pub(crate) start: f64,
    pub(crate) lower: Option<f64>,
    pub(crate) upper: Option<f64>,
    pub(crate) unit: Option<String>,
}

/// One line of `[constants]`: `205.0` or `{ value = 205.0, unit = "GPa" }`.
#[derive(Debug)]
pub(crate) struct ConstantEntry {
    pub(crate) value: f64,
    pub(crate) unit: Option<String>,
}

impl<'de> Deserialize<'de> for UnknownEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            start: f64,
            lower: Option<f64>,
            upper: Option<f64>,
            unit: Option<String>,
        }
        struct Unknown;
        impl<'de> Visitor<'de> for Unknown {
            type Value = UnknownEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a start value such as 59.0, or { start = 59.0, lower = 0.0, upper = 90.0 },")
            }

            fn visit_f64<E>(self, start: f64) -> Result<Self::Value, E> {
                Ok(UnknownEntry { start, lower: None, upper: None, unit: None })
            }

            fn visit_i64<E>(self, start: i64) -> Result<Self::Value, E> {
                Ok(UnknownEntry { start: start as f64, lower: None, upper: None, unit: None })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let Table { start, lower, upper, unit } = Table::deserialize(value::MapAccessDeserializer::new(map))?;
                Ok(UnknownEntry { start, lower, upper, unit })
            }
        }
        deserializer.deserialize_any(Unknown)
    }
}

impl<'de> Deserialize<'de> for ConstantEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            value: f64,
            unit: Option<String>,
        }
        struct Constant;
        impl<'de> Visitor<'de> for Constant {
            type Value = ConstantEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or { value = 205.0, unit = \"GPa\" },")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(ConstantEntry { value, unit: None })
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(ConstantEntry { value: value as f64, unit: None })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let Table { value, unit } = Table::deserialize(value::MapAccessDeserializer::new(map))?;
                Ok(ConstantEntry { value, unit })
            }
        }
        deserializer.deserialize_any(Constant)
    }
}
