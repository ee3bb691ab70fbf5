//! Quantiles of every result, keyed by the names of their probabilities.

use serde::{Serialize, Serializer};

use crate::capability::TAIL;
use crate::pearson::Pearson;
use crate::power::{Losable, Rescale, Rescaling};

/// Names of the probabilities of [`Quantiles`], lowest first.
pub const PROBABILITIES: [&str; 7] = ["0.00135", "0.01", "0.05", "0.5", "0.95", "0.99", "0.99865"];

/// One value for each probability of [`PROBABILITIES`]. Serialises as a map with their names as keys.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quantiles<T = f64>(pub [T; 7]);

/// A quantile and its error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct EstimatedQuantile {
    /// Value of the characteristic.
    pub value: f64,
    /// Error of the value: the true quantile lies within three of these. None if it is unknown.
    pub error: Option<f64>,
}

impl Rescale for EstimatedQuantile {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.value.rescale(by);
        self.error.rescale(by);
    }
}

impl Losable for EstimatedQuantile {
    fn is_unknown(&self) -> bool {
        self.value.is_nan()
    }
}

impl<T: Rescale> Rescale for Quantiles<T> {
    fn rescale(&mut self, by: &mut Rescaling) {
        self.0.iter_mut().for_each(|value| value.rescale(by));
    }
}

impl Quantiles {
    /// Quantiles of a Pearson distribution. Upper ones are computed from the share above, since `1 - p` would lose digits.
    pub fn of(law: &Pearson) -> Self {
        let [below, above] = [|law: &Pearson, p| law.quantile(p), |law: &Pearson, p| law.upper_quantile(p)];
        let all =
            [(TAIL, below), (0.01, below), (0.05, below), (0.5, below), (0.05, above), (0.01, above), (TAIL, above)];
        Self(all.map(|(p, side)| side(law, p)))
    }
}

impl<T> Quantiles<T> {
    /// Iterates over the values with the names of their probabilities.
    pub fn iter(&self) -> impl Iterator<Item = (&'static str, &T)> {
        PROBABILITIES.into_iter().zip(&self.0)
    }
}

impl<T: Serialize> Serialize for Quantiles<T> {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_map(self.iter())
    }
}

#[cfg(feature = "schema")]
impl<T: schemars::JsonSchema> schemars::JsonSchema for Quantiles<T> {
    fn inline_schema() -> bool {
        true
    }

    fn schema_name() -> std::borrow::Cow<'static, str> {
        format!("QuantilesOf{}", T::schema_name()).into()
    }

    fn json_schema(generator: &mut schemars::SchemaGenerator) -> schemars::Schema {
        std::collections::BTreeMap::<String, T>::json_schema(generator)
    }
}
