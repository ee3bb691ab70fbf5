//! Numbers that a study can give in several forms.

use std::fmt;

use serde::de::{self, SeqAccess, Unexpected, Visitor, value};
use serde::{Deserialize, Deserializer};

/// Nominal value: `50.0`, or `[50.0, 30.0]` of a position.
#[derive(Debug, Clone, Copy)]
pub(crate) enum NominalEntry {
    One(f64),
    Two([f64; 2]),
}

/// Tolerance: `0.3` or `[-0.1, 0.3]`, each a number or a percentage of the nominal.
#[derive(Debug, Clone, Copy)]
pub(crate) enum ToleranceEntry {
    Half(Deviation),
    Deviations([Deviation; 2]),
}

/// Deviation: `0.3` or `"2%"`.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Deviation {
    Value(f64),
    Percent(f64),
}

impl ToleranceEntry {
    /// True if the tolerance is 0.
    pub(crate) fn is_zero(&self) -> bool {
        let zero = |deviation: &Deviation| matches!(deviation, Deviation::Value(0.0) | Deviation::Percent(0.0));
        match self {
            Self::Half(half) => zero(half),
            Self::Deviations(both) => both.iter().all(zero),
        }
    }
}

impl<'de> Deserialize<'de> for ToleranceEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Tolerance;
        impl<'de> Visitor<'de> for Tolerance {
            type Value = ToleranceEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a half band such as 0.3 or \"2%\", or two deviations such as [-0.1, 0.3],")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(ToleranceEntry::Half(Deviation::Value(value)))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(ToleranceEntry::Half(Deviation::Value(value as f64)))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
                percent(text).map(ToleranceEntry::Half).ok_or_else(|| E::invalid_type(Unexpected::Str(text), &self))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                <[Deviation; 2]>::deserialize(value::SeqAccessDeserializer::new(seq)).map(ToleranceEntry::Deviations)
            }
        }
        deserializer.deserialize_any(Tolerance)
    }
}

impl<'de> Deserialize<'de> for Deviation {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct DeviationVisitor;
        impl Visitor<'_> for DeviationVisitor {
            type Value = Deviation;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a deviation such as 0.3 or \"2%\"")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(Deviation::Value(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(Deviation::Value(value as f64))
            }

            fn visit_str<E: de::Error>(self, text: &str) -> Result<Self::Value, E> {
                percent(text).ok_or_else(|| E::invalid_type(Unexpected::Str(text), &self))
            }
        }
        deserializer.deserialize_any(DeviationVisitor)
    }
}

/// Parses a finite number with a percent sign.
fn percent(text: &str) -> Option<Deviation> {
    let number = text.trim().strip_suffix('%')?.trim_end();
    number.parse().ok().filter(|value: &f64| value.is_finite()).map(Deviation::Percent)
}

impl<'de> Deserialize<'de> for NominalEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Nominal;
        impl<'de> Visitor<'de> for Nominal {
            type Value = NominalEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a number, or two such as [50.0, 30.0] with a position,")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(NominalEntry::One(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(NominalEntry::One(value as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                <[f64; 2]>::deserialize(value::SeqAccessDeserializer::new(seq)).map(NominalEntry::Two)
            }
        }
        deserializer.deserialize_any(Nominal)
    }
}
