//! The study file as it is written: one set of types for TOML and JSON.

use std::fmt;
use std::marker::PhantomData;

use serde::de::{MapAccess, SeqAccess, Visitor, value};
use serde::{Deserialize, Deserializer};
use serde_spanned::Spanned;

use super::values::{NominalEntry, ToleranceEntry};

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
    pub(super) unknowns: Entries<UnknownEntry>,
    #[serde(default)]
    pub(super) equations: Entries<String>,
    #[serde(default)]
    pub(super) loops: Entries<Vec<LinkEntry>>,
    #[serde(default)]
    pub(super) characteristics: Entries<CharacteristicEntry>,
    #[serde(default)]
    pub(super) correlation: Correlations,
    pub(super) model: Option<Spanned<ModelEntry>>,
    #[serde(default)]
    pub(super) analysis: AnalysisEntry,
}

/// Named entries in the order of the file, every name and entry with its place.
#[derive(Debug, Clone)]
pub(super) struct Entries<T>(pub(super) Vec<(Spanned<String>, Spanned<T>)>);

/// One line of `[dimensions]`.
#[derive(Debug, Default, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { nominal = 10.0, tolerance = 0.3 }")]
pub(super) struct DimensionEntry {
    pub(super) nominal: Option<Spanned<NominalEntry>>,
    pub(super) tolerance: Option<Spanned<ToleranceEntry>>,
    pub(super) limits: Option<Spanned<[f64; 2]>>,
    pub(super) fit: Option<Spanned<String>>,
    pub(super) position: Option<Spanned<f64>>,
    pub(super) unit: Option<String>,
    #[serde(default, deserialize_with = "distribution")]
    pub(super) distribution: Option<Spanned<DistributionEntry>>,
    pub(super) sigma: Option<Spanned<f64>>,
    pub(super) sigmas: Option<Spanned<f64>>,
    pub(super) cp: Option<Spanned<f64>>,
    pub(super) shift: Option<Spanned<f64>>,
    pub(super) moments: Option<Spanned<[f64; 7]>>,
    pub(super) measured: Option<Spanned<String>>,
    pub(super) column: Option<Spanned<String>>,
    pub(super) model: Option<Spanned<String>>,
    pub(super) step: Option<Spanned<f64>>,
}

impl PartEntry {
    /// Its line, as if it were a dimension of its own.
    pub(super) fn as_dimension(&self) -> DimensionEntry {
        DimensionEntry {
            nominal: self
                .nominal
                .as_ref()
                .map(|nominal| Spanned::new(nominal.span(), NominalEntry::One(*nominal.get_ref()))),
            tolerance: self.tolerance.clone(),
            limits: self.limits.clone(),
            distribution: self.distribution.clone(),
            sigma: self.sigma.clone(),
            sigmas: self.sigmas.clone(),
            cp: self.cp.clone(),
            shift: self.shift.clone(),
            ..DimensionEntry::default()
        }
    }
}

/// `"uniform"` or `{ kind = "beta", alpha = 2, beta = 5 }`: the parameters of all kinds.
#[derive(Debug, Clone, Default, Deserialize)]
#[serde(deny_unknown_fields)]
pub(super) struct DistributionEntry {
    pub(super) kind: String,
    pub(super) mode: Option<Spanned<f64>>,
    pub(super) top: Option<Spanned<f64>>,
    pub(super) alpha: Option<Spanned<f64>>,
    pub(super) beta: Option<Spanned<f64>>,
    pub(super) origin: Option<Spanned<f64>>,
    pub(super) parts: Option<Spanned<Entries<PartEntry>>>,
}

/// A part of a mixture: a weight, and what of a dimension is its own.
#[derive(Debug, Clone, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { weight = 0.6, shift = 0.02, sigma = 0.01 }")]
pub(super) struct PartEntry {
    pub(super) weight: Spanned<f64>,
    pub(super) nominal: Option<Spanned<f64>>,
    pub(super) tolerance: Option<Spanned<ToleranceEntry>>,
    pub(super) limits: Option<Spanned<[f64; 2]>>,
    #[serde(default, deserialize_with = "distribution")]
    pub(super) distribution: Option<Spanned<DistributionEntry>>,
    pub(super) sigma: Option<Spanned<f64>>,
    pub(super) sigmas: Option<Spanned<f64>>,
    pub(super) cp: Option<Spanned<f64>>,
    pub(super) shift: Option<Spanned<f64>>,
}

/// One line of `[unknowns]`: `59.0` or `{ start = 59.0, lower = 0.0 }`.
#[derive(Debug)]
pub(super) struct UnknownEntry {
    pub(super) start: f64,
    pub(super) lower: Option<f64>,
    pub(super) upper: Option<f64>,
}

/// One vector of a loop.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a vector such as { length = \"R - r\", angle = \"phi\" }")]
pub(super) struct LinkEntry {
    pub(super) length: Spanned<TermEntry>,
    pub(super) angle: Spanned<TermEntry>,
}

/// A formula, or a number in its place.
#[derive(Debug)]
pub(super) struct TermEntry(pub(super) String);

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

/// Every `[[correlation]]`, in the order of the file.
#[derive(Debug, Default)]
pub(super) struct Correlations(pub(super) Vec<Spanned<CorrelationEntry>>);

/// One `[[correlation]]`.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields, expecting = "a table such as { between = [\"a\", \"b\"], value = 0.4 }")]
pub(super) struct CorrelationEntry {
    pub(super) between: Spanned<(String, String)>,
    pub(super) value: Spanned<f64>,
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
    pub(super) derivatives: Option<Spanned<String>>,
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

/// A text names the kind alone; a table may have parameters. To be used with `deserialize_with`.
pub(super) fn distribution<'de, D: Deserializer<'de>>(
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

impl<'de> Deserialize<'de> for Correlations {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct List;
        impl<'de> Visitor<'de> for List {
            type Value = Correlations;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a list, each pair of dimensions below its own [[correlation]],")
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(value::SeqAccessDeserializer::new(seq)).map(Correlations)
            }
        }
        deserializer.deserialize_any(List)
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

impl<'de> Deserialize<'de> for UnknownEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        #[derive(Deserialize)]
        #[serde(deny_unknown_fields)]
        struct Table {
            start: f64,
            lower: Option<f64>,
            upper: Option<f64>,
        }
        struct Unknown;
        impl<'de> Visitor<'de> for Unknown {
            type Value = UnknownEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a start value such as 59.0, or { start = 59.0, lower = 0.0, upper = 90.0 },")
            }

            fn visit_f64<E>(self, start: f64) -> Result<Self::Value, E> {
                Ok(UnknownEntry { start, lower: None, upper: None })
            }

            fn visit_i64<E>(self, start: i64) -> Result<Self::Value, E> {
                Ok(UnknownEntry { start: start as f64, lower: None, upper: None })
            }

            fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<Self::Value, A::Error> {
                let Table { start, lower, upper } = Table::deserialize(value::MapAccessDeserializer::new(map))?;
                Ok(UnknownEntry { start, lower, upper })
            }
        }
        deserializer.deserialize_any(Unknown)
    }
}

impl<'de> Deserialize<'de> for TermEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Term;
        impl<'de> Visitor<'de> for Term {
            type Value = TermEntry;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str("a formula such as \"R - r\", or a number")
            }

            fn visit_str<E>(self, formula: &str) -> Result<Self::Value, E> {
                Ok(TermEntry(formula.to_owned()))
            }

            fn visit_f64<E>(self, number: f64) -> Result<Self::Value, E> {
                Ok(TermEntry(format!("{number:?}")))
            }

            fn visit_i64<E>(self, number: i64) -> Result<Self::Value, E> {
                Ok(TermEntry(number.to_string()))
            }
        }
        deserializer.deserialize_any(Term)
    }
}
