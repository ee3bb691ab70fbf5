//! The common part of how results are written: parts that take another form in JSON than in Rust.
//!
//! Unknown values are null, so that every key is always there.

use std::fmt::Display;
use std::time::Duration;

use serde::{Serialize, Serializer};

/// Writes a value as what it turns into.
pub fn through<'v, T, V, S>(value: &'v V, serializer: S) -> Result<S::Ok, S::Error>
where
    T: From<&'v V> + Serialize,
    S: Serializer,
{
    T::from(value).serialize(serializer)
}

/// One of each of the four moments.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Four<T> {
    /// First moment.
    pub(crate) mean: T,
    /// Standard deviation.
    pub(crate) sigma: T,
    /// Third standardised moment.
    pub(crate) skewness: T,
    /// Fourth standardised moment, 3 for a normal.
    pub(crate) kurtosis: T,
}

impl<T: Copy> From<&[T; 4]> for Four<T> {
    fn from(&[mean, sigma, skewness, kurtosis]: &[T; 4]) -> Self {
        Self { mean, sigma, skewness, kurtosis }
    }
}

/// One of each side of the limits.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct Sides<T> {
    /// Below the lower limit.
    below: T,
    /// Above the upper limit.
    above: T,
}

impl<T: Copy> From<&[T; 2]> for Sides<T> {
    fn from(&[below, above]: &[T; 2]) -> Self {
        Self { below, above }
    }
}

/// Within which the rejects of either side are known.
#[derive(Serialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
pub struct RejectIntervals {
    /// The 95 % interval of the assemblies below the lower limit by themselves, per million; 0 to 0 where a proof excludes them, null where it
    /// is not known.
    ppm_below_interval: Option<[f64; 2]>,
    /// The same above the upper limit.
    ppm_above_interval: Option<[f64; 2]>,
}

impl From<&[Option<[f64; 2]>; 2]> for RejectIntervals {
    fn from(intervals: &[Option<[f64; 2]>; 2]) -> Self {
        let [ppm_below_interval, ppm_above_interval] = intervals.map(|of| of.map(|ends| ends.map(|end| 1e6 * end)));
        Self { ppm_below_interval, ppm_above_interval }
    }
}

/// The ends of an interval that there are.
pub fn ends([low, high]: [f64; 2]) -> [Option<f64>; 2] {
    [finite(low), finite(high)]
}

/// A number that can be written.
pub fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

/// A share in parts per million.
pub fn millionths<S: Serializer>(share: &Option<f64>, serializer: S) -> Result<S::Ok, S::Error> {
    share.map(|share| 1e6 * share).serialize(serializer)
}

/// In words.
pub fn text<S: Serializer>(value: &Option<impl Display>, serializer: S) -> Result<S::Ok, S::Error> {
    value.as_ref().map(ToString::to_string).serialize(serializer)
}

/// Pairs as a map from names.
pub fn by_name<S: Serializer>(pairs: &[(String, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(pairs.iter().map(|(name, value)| (name, value)))
}

/// A time in seconds.
pub fn seconds<S: Serializer>(duration: &Duration, serializer: S) -> Result<S::Ok, S::Error> {
    serializer.serialize_f64(duration.as_secs_f64())
}
