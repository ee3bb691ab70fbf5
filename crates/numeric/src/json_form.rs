//! Helpers for serialisation: parts of results that have another form in JSON than in Rust.
//!
//! Unknown values are null, so that every key always exists.

use std::fmt::Display;
use std::time::Duration;

use serde::{Serialize, Serializer};

/// Serialises a value after conversion into `T`.
pub fn through<'v, T, V, S>(value: &'v V, serializer: S) -> Result<S::Ok, S::Error>
where
    T: From<&'v V> + Serialize,
    S: Serializer,
{
    T::from(value).serialize(serializer)
}

/// Own fields of a result, followed by the figures that are concluded from them.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Concluded<O, C> {
    #[serde(flatten)]
    own: O,
    #[serde(flatten)]
    conclusion: C,
}

impl<O, C> Concluded<O, C> {
    /// Joins both parts.
    pub fn new(own: O, conclusion: C) -> Self {
        Self { own, conclusion }
    }
}

/// Implements `Serialize` for a result that derives it with `#[serde(remote = "Self")]`: its own fields, then those of the value that its
/// method `conclusion` returns. A flattened field describes both by `schemars(with = "Concluded<Field, Conclusion>")`.
#[macro_export]
macro_rules! serialize_with_conclusion {
    ($result:ty) => {
        impl serde::Serialize for $result {
            fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                struct OwnFields<'r>(&'r $result);
                impl serde::Serialize for OwnFields<'_> {
                    fn serialize<S: serde::Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                        <$result>::serialize(self.0, serializer)
                    }
                }
                let whole = $crate::json_form::Concluded::new(OwnFields(self), self.conclusion());
                serde::Serialize::serialize(&whole, serializer)
            }
        }
    };
}

/// Values for each of the four moments.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Four<T> {
    /// Value for the expected value.
    pub(crate) mean: T,
    /// Value for the standard deviation.
    pub(crate) sigma: T,
    /// Value for the third standardised moment.
    pub(crate) skewness: T,
    /// Value for the fourth standardised moment, which is 3 for a normal.
    pub(crate) kurtosis: T,
}

impl<T: Copy> From<&[T; 4]> for Four<T> {
    fn from(&[mean, sigma, skewness, kurtosis]: &[T; 4]) -> Self {
        Self { mean, sigma, skewness, kurtosis }
    }
}

/// Values for both sides of the limits.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sides<T> {
    /// Value below the lower limit.
    below: T,
    /// Value above the upper limit.
    above: T,
}

impl<T: Copy> From<&[T; 2]> for Sides<T> {
    fn from(&[below, above]: &[T; 2]) -> Self {
        Self { below, above }
    }
}

/// Confidence intervals of the rejects of either side.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RejectIntervals {
    /// 95 % interval of the assemblies below the lower limit alone, per million: 0 to 0 if a proof excludes them, null if it is unknown.
    ppm_below_interval: Option<[f64; 2]>,
    /// 95 % interval of the assemblies above the upper limit alone, per million, in the same form.
    ppm_above_interval: Option<[f64; 2]>,
}

impl From<&[Option<[f64; 2]>; 2]> for RejectIntervals {
    fn from(intervals: &[Option<[f64; 2]>; 2]) -> Self {
        let [ppm_below_interval, ppm_above_interval] = intervals.map(|of| of.map(|ends| ends.map(|end| 1e6 * end)));
        Self { ppm_below_interval, ppm_above_interval }
    }
}

/// Ends of an interval. An infinite end is None.
pub fn ends([low, high]: [f64; 2]) -> [Option<f64>; 2] {
    [finite(low), finite(high)]
}

/// Finite number. Returns None if it is infinite or NaN, which JSON cannot hold.
pub fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

/// Serialises a share in parts per million.
pub fn millionths<S: Serializer>(share: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    share.map(|share| 1e6 * share).serialize(serializer)
}

/// Serialises a value as text.
pub fn text<S: Serializer>(value: &Option<impl Display>, serializer: S) -> Result<S::Ok, S::Error> {
    value.as_ref().map(ToString::to_string).serialize(serializer)
}

/// Serialises pairs as a map with the names as keys.
pub fn by_name<S: Serializer>(pairs: &[(String, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}

/// Serialises a duration in seconds.
pub fn seconds<S: Serializer>(duration: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(duration.as_secs_f64())
}
