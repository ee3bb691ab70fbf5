//! Uncertainty from the size of measured samples, for readers.

use crate::document::number::{carried_ends, index, shape, share, short};
use crate::document::{Blocks, Cell, DataTable, Section};
use sensitol_numeric::sampling::SamplingInterval;

/// Greatest number of samples that a sentence lists by name.
const SAMPLES: usize = 3;

/// Lists the samples with their sizes.
pub(super) fn samples(interval: &SamplingInterval) -> String {
    let named = interval.samples.iter().take(SAMPLES);
    let named: Vec<String> = named.map(|(name, count)| format!("{count} values of {}", short(name))).collect();
    let more = interval.samples.len().saturating_sub(SAMPLES);
    let more = if more > 0 { format!(" and {more} more samples") } else { String::new() };
    format!("{}{more}", named.join(", "))
}

/// Names of the indices of capability: of performance for measured values, of a process in control otherwise (ISO 22514-2).
pub(crate) fn index_names(measured: bool) -> [&'static str; 2] {
    if measured { ["Pp", "Ppk"] } else { ["Cp", "Cpk"] }
}

/// Adds intervals, one a row, for a characteristic with sigma `scale`, those of yield and Cpk only if it is `limited`.
pub(super) fn sampled(section: &mut Section, interval: &SamplingInterval, scale: f64, limited: bool) {
    let level = 100.0 * interval.level;
    let resampled = interval.resamples > 0;
    let by = if resampled { format!(", by {} resamples", interval.resamples) } else { String::new() };
    section.gap();
    section.note(format!("{level} % intervals for {}{by}", samples(interval)));
    let range = |ends: Option<[f64; 2]>, text: &dyn Fn(f64) -> String| match ends {
        Some([low, high]) => format!("{} .. {}", text(low), text(high)),
        None => "unknown".to_owned(),
    };
    let value =
        |ends: Option<[f64; 2]>| ends.map_or("unknown".to_owned(), |ends| carried_ends(ends, scale, None).join(" .. "));
    let mut rows = vec![("mean", value(interval.mean)), ("sigma", value(interval.sigma))];
    if resampled || interval.skewness.is_some() || interval.kurtosis.is_some() {
        rows.extend([("skewness", range(interval.skewness, &shape)), ("kurtosis", range(interval.kurtosis, &shape))]);
    }
    if limited {
        let kept = interval.rejected.map(|[low, high]| [high, low]);
        rows.extend([("yield", range(kept, &share)), (index_names(true)[1], range(interval.cpk, &index))]);
    }
    section.table(DataTable::untitled(rows.into_iter().map(|(name, ends)| [Cell::text(name), Cell::text(ends)])));
}
