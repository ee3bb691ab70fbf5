//! The study file as it is written: one set of types for TOML and JSON.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{MapAccess, SeqAccess, Visitor, value};
use serde::{Deserialize, Deserializer};
use serde_spanned::Spanned;

/// A whole study file.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of sections")]
pub(super) struct StudyFile {
    pub(super) title: Option<String>,
    #[serde(default)]
    pub(super) dimensions: Entries<DimensionEntry>,
    #[serde(default)]
    pub(super) constants: Entries<f64>,
    #[serde(default)]
    pub(super) formulas: Entries<String>,
    #[serde(default)]
    pub(super) characteristics: Entries<CharacteristicEntry>,
    pub(super) model: Option<Spanned<ModelEntry>>,
    #[serde(default)]
    pub(super) analysis: AnalysisEntry,
}

/// Named entries in the order of the file, every name and entry with its place.
#[derive(Debug)]
pub(super) struct Entries<T>(pub(super) Vec<(Spanned<String>, Spanned<T>)>);

/// One line of `[dimensions]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { nominal = 10.0, tolerance = 0.3 }")]
pub(super) struct DimensionEntry {
    pub(super) nominal: Option<Spanned<f64>>,
    pub(super) tolerance: Option<Spanned<ToleranceEntry>>,
    pub(super) limits: Option<Spanned<[f64; 2]>>,
    pub(super) unit: Option<String>,
    pub(super) distribution: Option<Spanned<DistributionEntry>>,
    pub(super) sigma: Option<Spanned<f64>>,
    pub(super) sigmas: Option<Spanned<f64>>,
    pub(super) cp: Option<Spanned<f64>>,
    pub(super) shift: Option<Spanned<f64>>,
    pub(super) moments: Option<Spanned<[f64; 7]>>,
    pub(super) step: Option<Spanned<f64>>,
}

/// `0.3` or `[-0.1, 0.3]`.
#[derive(Debug, Clone, Copy)]
pub(super) enum ToleranceEntry {
    Half(f64),
    Deviations([f64; 2]),
}

/// `"uniform"` or `{ kind = "uniform" }`.
#[derive(Debug)]
pub(super) struct DistributionEntry {
    pub(super) kind: String,
}

/// One line of `[characteristics]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { formula = \"a - b\" }")]
pub(super) struct CharacteristicEntry {
    pub(super) formula: Option<Spanned<String>>,
    pub(super) unit: Option<String>,
    pub(super) lower: Option<Spanned<f64>>,
    pub(super) upper: Option<Spanned<f64>>,
    pub(super) target_yield: Option<Spanned<f64>>,
}

/// `[model]`.
#[derive(Debug, Deserialize)]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { builtin = \"engine-balance\" } or { command = [\"python3\", \"gap.py\"] }"
)]
pub(super) struct ModelEntry {
    pub(super) builtin: Option<Spanned<String>>,
    pub(super) command: Option<Spanned<Vec<String>>>,
    pub(super) workers: Option<Spanned<u64>>,
    pub(super) timeout_s: Option<Spanned<f64>>,
    pub(super) start_timeout_s: Option<Spanned<f64>>,
    pub(super) retries: Option<Spanned<u64>>,
    pub(super) files: Option<Vec<Spanned<String>>>,
}

/// `[analysis]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table of options")]
pub(super) struct AnalysisEntry {
    pub(super) method: Option<Spanned<String>>,
    pub(super) accuracy: Option<Spanned<f64>>,
    pub(super) budget: Option<Spanned<u64>>,
    pub(super) step: Option<Spanned<f64>>,
    pub(super) pairs: Option<Spanned<PairsEntry>>,
    pub(super) stencil: Option<Spanned<String>>,
    pub(super) sensitivities: Option<Spanned<String>>,
    pub(super) extremes: Option<bool>,
    pub(super) seed: Option<Spanned<u64>>,
}

/// `"strongest"`, `"adjacent"` or `[["a", "b"], ["c", "d"]]`.
#[derive(Debug)]
pub(super) enum PairsEntry {
    Word(String),
    Listed(Vec<(String, String)>),
}

impl<T> Default for Entries<T> {
    fn default() -> Self {
        Self(Vec::new())
    }
}

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Entries<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Table<T>(PhantomData<T>);
        impl<'de, T: Deserialize<'de>> Visitor<'de> for Table<T> {
            type Value = Entries<T>;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a table of names")
            }

            fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
                let mut entries = Vec::new();
                while let Some(entry) = map.next_entry()? {
                    entries.push(entry);
                }
                Ok(Entries(entries))
            }
        }
        deserializer.deserialize_map(Table(PhantomData))
    }
}

impl<'de> Deserialize<'de> for ToleranceEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Tolerance;
        impl<'de> Visitor<'de> for Tolerance {
            type Value = ToleranceEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a half band such as 0.3, or two deviations such as [-0.1, 0.3],")
            }

            fn visit_f64<E>(self, value: f64) -> Result<Self::Value, E> {
                Ok(ToleranceEntry::Half(value))
            }

            fn visit_i64<E>(self, value: i64) -> Result<Self::Value, E> {
                Ok(ToleranceEntry::Half(value as f64))
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                <[f64; 2]>::deserialize(value::SeqAccessDeserializer::new(seq)).map(ToleranceEntry::Deviations)
            }
        }
        deserializer.deserialize_any(Tolerance)
    }
}

impl<'de> Deserialize<'de> for DistributionEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            kind: String,
        }
        struct Distribution;
        impl<'de> Visitor<'de> for Distribution {
            type Value = DistributionEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a distribution such as \"uniform\", or { kind = \"uniform\" },")
            }

            fn visit_str<E>(self, kind: &str) -> Result<Self::Value, E> {
                Ok(DistributionEntry { kind: kind.to_owned() })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let Table { kind } = Table::deserialize(value::MapAccessDeserializer::new(map))?;
                Ok(DistributionEntry { kind })
            }
        }
        deserializer.deserialize_any(Distribution)
    }
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
