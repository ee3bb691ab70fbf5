//! The study file as it is written: one set of types for TOML and JSON.

use std::fmt;
use std::marker::PhantomData;

#[cfg(feature = "cli")]
use super::schema;
use super::spanned::Spanned;
use serde::de::{MapAccess, SeqAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

/// A whole study file.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(title = "Study of sensitol", extend("required" = ["dimensions", "characteristics"])))]
#[serde(deny_unknown_fields, expecting = "a table of sections")]
pub(super) struct StudyFile {
    /// Where editors find the schema; it means nothing here.
    #[serde(rename = "$schema")]
    pub(super) _schema: Option<String>,
    /// What the study is about, in one line.
    pub(super) title: Option<String>,
    /// The inputs: each with its nominal value, its tolerance and its distribution.
    #[serde(default)]
    pub(super) dimensions: Entries<DimensionEntry>,
    /// Fixed numbers for formulas and models.
    #[serde(default)]
    pub(super) constants: Entries<f64>,
    /// Intermediate values by name, in any order, without cycles.
    #[serde(default)]
    pub(super) formulas: Entries<String>,
    /// The key characteristics: what is asked.
    #[serde(default)]
    pub(super) characteristics: Entries<CharacteristicEntry>,
    /// What is evaluated beside formulas: a built-in model or an external program.
    pub(super) model: Option<Spanned<ModelEntry>>,
    /// How the study is analysed; flags of the command line win.
    #[serde(default)]
    pub(super) analysis: AnalysisEntry,
}

/// Named entries in the order of the file, every name and entry with its place.
#[derive(Debug)]
pub(super) struct Entries<T>(pub(super) Vec<(Spanned<String>, Spanned<T>)>);

/// One line of `[dimensions]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { nominal = 10.0, tolerance = 0.3 }")]
pub(super) struct DimensionEntry {
    /// The value on the drawing; that of a built-in model where it is left out.
    pub(super) nominal: Option<Spanned<f64>>,
    /// Half the tolerance band, or lower and upper deviation from the nominal.
    pub(super) tolerance: Option<Spanned<ToleranceEntry>>,
    /// Lower and upper limit, in place of a tolerance.
    pub(super) limits: Option<Spanned<[f64; 2]>>,
    /// The unit, which is shown and never converted.
    pub(super) unit: Option<String>,
    /// How it is distributed: normal unless said otherwise.
    pub(super) distribution: Option<Spanned<DistributionEntry>>,
    /// Standard deviation.
    pub(super) sigma: Option<Spanned<f64>>,
    /// How many sigmas half a tolerance band has: 3 unless said otherwise.
    pub(super) sigmas: Option<Spanned<f64>>,
    /// Process capability: sigmas/3.
    pub(super) cp: Option<Spanned<f64>>,
    /// How far the mean lies off the middle of the band.
    pub(super) shift: Option<Spanned<f64>>,
    /// Central moments 2 to 8, where nothing else is known of the distribution.
    pub(super) moments: Option<Spanned<[f64; 7]>>,
    /// Evaluation step in sigmas, in place of the nodes that suit the distribution.
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
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table such as { formula = \"a - b\" }")]
pub(super) struct CharacteristicEntry {
    /// A formula of dimensions, constants, formulas and outputs of the model; without one it is an output of that name.
    pub(super) formula: Option<Spanned<String>>,
    /// The unit, which is shown and never converted.
    pub(super) unit: Option<String>,
    /// Lower limit.
    pub(super) lower: Option<Spanned<f64>>,
    /// Upper limit.
    pub(super) upper: Option<Spanned<f64>>,
    /// The share of assemblies that must keep the limits, between 0 and 1.
    pub(super) target_yield: Option<Spanned<f64>>,
}

/// `[model]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "cli", schemars(extend("oneOf" = schema::one_of(["builtin", "command"]))))]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { builtin = \"engine-balance\" } or { command = [\"python3\", \"gap.py\"] }"
)]
pub(super) struct ModelEntry {
    /// A built-in model, by name: `sensitol models` lists them.
    #[cfg_attr(feature = "cli", schemars(extend("enum" = schema::built_in_models())))]
    pub(super) builtin: Option<Spanned<String>>,
    /// A program and its arguments, run in the study's folder.
    pub(super) command: Option<Spanned<Vec<String>>>,
    /// Processes side by side.
    pub(super) workers: Option<Spanned<u64>>,
    /// Seconds that an evaluation may take.
    pub(super) timeout_s: Option<Spanned<f64>>,
    /// Seconds that the program may take to start.
    pub(super) start_timeout_s: Option<Spanned<f64>>,
    /// How often a point is tried again.
    pub(super) retries: Option<Spanned<u64>>,
    /// Files that the model depends on: other contents make other answers.
    pub(super) files: Option<Vec<Spanned<String>>>,
}

/// `[analysis]`.
#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields, expecting = "a table of options")]
pub(super) struct AnalysisEntry {
    /// The method.
    #[cfg_attr(feature = "cli", schemars(extend("enum" = schema::methods())))]
    pub(super) method: Option<Spanned<String>>,
    /// Wanted relative error of sigma, for auto.
    pub(super) accuracy: Option<Spanned<f64>>,
    /// Most evaluations that may be spent.
    pub(super) budget: Option<Spanned<u64>>,
    /// Evaluate at so many sigma on either side, in place of the nodes that suit each distribution.
    pub(super) step: Option<Spanned<f64>>,
    /// The interactions that six-n examines.
    pub(super) pairs: Option<Spanned<PairsEntry>>,
    /// How six-n evaluates an interaction.
    #[cfg_attr(feature = "cli", schemars(extend("enum" = schema::stencils())))]
    pub(super) stencil: Option<Spanned<String>>,
    /// Whether dimensions without tolerance get a sensitivity too.
    #[cfg_attr(feature = "cli", schemars(extend("enum" = schema::sensitivities())))]
    pub(super) sensitivities: Option<Spanned<String>>,
    /// Whether the true extremes in the box of the tolerance bands are searched too.
    pub(super) extremes: Option<bool>,
    /// Seed of random numbers.
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
