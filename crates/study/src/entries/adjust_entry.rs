//! Types of `[[adjust]]`, and of extremes over motions, in a study file.

use std::fmt;

use serde::de::{SeqAccess, Visitor, value};
use serde::{Deserialize, Deserializer};

#[cfg(feature = "schema")]
use crate::entries::schema_parts as registry;
use crate::entries::spanned::Spanned;
use crate::entries::vocabulary::ADJUSTMENTS;

/// Every `[[adjust]]`, in the order of the file.
#[derive(Debug, Default)]
pub(crate) struct Adjustments(pub(crate) Vec<Spanned<AdjustEntry>>);

/// One `[[adjust]]`.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[cfg_attr(feature = "schema", schemars(extend("oneOf" = registry::one_of(["values", "step"]))))]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { dimension = \"shim\", values = [0.9, 1.0, 1.1], to = \"gap\", target = 0.1 }"
)]
pub(crate) struct AdjustEntry {
    /// The dimension that is chosen: its nominal value is replaced, and its tolerance is that of a chosen part about its label.
    pub(crate) dimension: Spanned<String>,
    /// The values in stock, in any order.
    pub(crate) values: Option<Spanned<Vec<f64>>>,
    /// The step of the values in stock, over the range.
    pub(crate) step: Option<Spanned<f64>>,
    /// The least and the greatest value in stock, for a step.
    pub(crate) range: Option<Spanned<[f64; 2]>>,
    /// The characteristic that is measured on the assembly.
    pub(crate) to: Spanned<String>,
    /// Target of the characteristic; the middle of its limits unless given.
    pub(crate) target: Option<Spanned<f64>>,
    /// Form of the characteristic along the dimension: linear takes two values of the stock, monotone a bisection. Linear formulas do not
    /// need it.
    #[cfg_attr(feature = "schema", schemars(extend("enum" = registry::stock_responses(), "default" = registry::stock_responses()[0])))]
    pub(crate) response: Option<Spanned<String>>,
}

/// `minimum` or `maximum` of a characteristic.
#[derive(Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(
    deny_unknown_fields,
    expecting = "a table such as { of = \"gap\", over = \"theta\", from = 0, to = 360 } (a limit is `lower` or `upper`)"
)]
pub(crate) struct MotionEntry {
    /// The characteristic whose extreme it is.
    pub(crate) of: Spanned<String>,
    /// The dimension that moves. It has no tolerance, and its nominal value counts for all other characteristics.
    pub(crate) over: Spanned<String>,
    /// First value of the motion.
    pub(crate) from: Spanned<f64>,
    /// Last value of the motion.
    pub(crate) to: Spanned<f64>,
    /// Number of equal steps of the motion, before the lowest values are refined.
    #[cfg_attr(feature = "schema", schemars(extend("default" = sensitol::assembly::Motion::STEPS)))]
    pub(crate) steps: Option<Spanned<u64>>,
}

impl<'de> Deserialize<'de> for Adjustments {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct List;
        impl<'de> Visitor<'de> for List {
            type Value = Adjustments;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(ADJUSTMENTS)
            }

            fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Self::Value, A::Error> {
                Vec::deserialize(value::SeqAccessDeserializer::new(seq)).map(Adjustments)
            }
        }
        deserializer.deserialize_any(List)
    }
}
