//! What the size of measured samples leaves open, as reports show it.

use serde::Serialize;

use super::CharacteristicReport;
use super::number::{beside, share, unsigned_zero};
use super::page::{Grid, Page, clean, short};
use crate::analysis::SamplingInterval;

/// Measured dimensions that the text names.
const NAMED: usize = 3;

/// Intervals that cover the true results, as far as the size of measured samples decides.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[cfg_attr(feature = "cli", derive(schemars::JsonSchema))]
pub struct SamplingReport {
    /// Of the mean.
    pub mean: Option<[f64; 2]>,
    /// Of sigma.
    pub sigma: Option<[f64; 2]>,
    /// Of the skewness.
    pub skewness: Option<[f64; 2]>,
    /// Of the kurtosis.
    pub kurtosis: Option<[f64; 2]>,
    /// Of the share within the limits.
    #[serde(rename = "yield")]
    pub yield_: Option<[f64; 2]>,
    /// Of Cpk.
    pub cpk: Option<[f64; 2]>,
    /// The probability with which each covers the truth.
    pub level: f64,
    /// How many resamples they come from.
    pub resamples: usize,
    /// What they rest on, in words, to be printed.
    #[serde(skip)]
    pub basis: String,
    /// Of the share outside the limits, with digits that the yield has lost.
    #[serde(skip)]
    pub rejected: Option<[f64; 2]>,
    /// The measured dimensions with the number of their values, which were drawn anew (BCa bootstrap) with the surrogate kept.
    #[serde(serialize_with = "by_name")]
    #[cfg_attr(feature = "cli", schemars(with = "std::collections::BTreeMap<String, usize>"))]
    pub samples: Vec<(String, usize)>,
}

fn by_name<S: serde::Serializer>(samples: &[(String, usize)], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(samples.iter().map(|(name, count)| (name, count)))
}

impl SamplingReport {
    pub(super) fn of(interval: &SamplingInterval) -> Self {
        Self {
            mean: interval.mean,
            sigma: interval.sigma,
            skewness: interval.skewness,
            kurtosis: interval.kurtosis,
            yield_: interval.yield_(),
            cpk: interval.cpk,
            level: interval.level,
            resamples: interval.resamples,
            basis: interval.basis(),
            rejected: interval.rejected,
            samples: interval.samples.clone(),
        }
    }
}

/// The intervals beside one another, below what they belong to.
pub(super) fn sampling(page: &mut Page, one: &CharacteristicReport) {
    let Some(interval) = &one.sampling_interval else { return };
    let named: Vec<String> = interval
        .samples
        .iter()
        .take(NAMED)
        .map(|(name, count)| format!("{count} values of {}", short(&clean(name))))
        .collect();
    let more = interval.samples.len().saturating_sub(NAMED);
    let more = if more > 0 { format!(" and {more} more samples") } else { String::new() };
    page.line("");
    page.line(&format!(
        "  {} % intervals for {}{more}, by {} resamples",
        100.0 * interval.level,
        named.join(", "),
        interval.resamples
    ));
    let scale = one.sigma.unwrap_or(0.0);
    let limited = one.lower.is_some() || one.upper.is_some();
    let range = |ends: Option<[f64; 2]>, text: &dyn Fn(f64) -> String| match ends {
        Some([low, high]) => format!("{} .. {}", text(low), text(high)),
        None => "unknown".to_owned(),
    };
    let value = |ends| range(ends, &|value| beside(value, scale));
    let shape = |ends| range(ends, &|value| unsigned_zero(format!("{value:.4}")));
    let kept = interval.rejected.map(|[low, high]| [high, low]);
    let of_limits = |name: &str, text: String| if limited { [name.to_owned(), text] } else { Default::default() };
    let rows = [
        (
            ["mean", "skewness"],
            [value(interval.mean), shape(interval.skewness)],
            of_limits("yield", range(kept, &share)),
        ),
        (
            ["sigma", "kurtosis"],
            [value(interval.sigma), shape(interval.kurtosis)],
            of_limits("Cpk", range(interval.cpk, &|value| unsigned_zero(format!("{value:.3}")))),
        ),
    ];
    let mut table = Grid::new([""; 6], "<<<<<<");
    for ([a, b], [of_a, of_b], [c, of_c]) in rows {
        table.row([a.to_owned(), of_a, b.to_owned(), of_b, c, of_c]);
    }
    page.print(&table);
}
