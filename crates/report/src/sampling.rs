//! Uncertainty from the size of measured samples, for readers.

use crate::document::number::{beside, index, shape, share, short};
use crate::document::{Blocks, Cell, DataTable, Section};
use sensitol_numeric::sampling::SamplingInterval;

/// Most samples that a sentence lists by name.
const SAMPLES: usize = 3;

/// Lists the samples with their sizes.
pub(super) fn samples(interval: &SamplingInterval) -> String {
    let named = interval.samples.iter().take(SAMPLES);
    let named: Vec<String> = named.map(|(name, count)| format!("{count} values of {}", short(name))).collect();
    let more = interval.samples.len().saturating_sub(SAMPLES);
    let more = if more > 0 { format!(" and {more} more samples") } else { String::new() };
    format!("{}{more}", named.join(", "))
}

/// Adds intervals side by side for a characteristic with sigma `scale`, those of yield and Cpk only if it is `limited`.
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
    let value = |ends| range(ends, &|value| beside(value, scale));
    let kept = interval.rejected.map(|[low, high]| [high, low]);
    let when = |shown: bool, name: &str, text: String| if shown { vec![name.to_owned(), text] } else { Vec::new() };
    let shapes = resampled || interval.skewness.is_some() || interval.kurtosis.is_some();
    let row = |first: (&str, Option<[f64; 2]>), second: (&str, Option<[f64; 2]>), third: (&str, String)| {
        let mut cells = when(true, first.0, value(first.1));
        cells.extend(when(shapes, second.0, range(second.1, &shape)));
        cells.extend(when(limited, third.0, third.1));
        // Every row has the same number of cells; cells without a figure are empty.
        cells.resize(6, String::new());
        <[String; 6]>::try_from(cells).unwrap_or_default()
    };
    let rows = [
        row(("mean", interval.mean), ("skewness", interval.skewness), ("yield", range(kept, &share))),
        row(("sigma", interval.sigma), ("kurtosis", interval.kurtosis), ("Cpk", range(interval.cpk, &index))),
    ];
    let labels: &[usize] = if shapes { &[2, 4] } else { &[2] };
    section.table(DataTable::untitled(rows.map(|row| row.map(Cell::text))).labelled_by(labels));
}
