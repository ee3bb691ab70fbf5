//! Density as a few lines of text with marked limits, and histogram of bars.

use crate::document::number::{beside, plain, significant};
use crate::document::{Cell, Columns, DataTable};
use sensitol::simulation::Histogram;
use sensitol_numeric::pearson::Pearson;

/// Length of the longest bar of a histogram, in characters.
const BAR: usize = 50;

/// Greatest width of the picture, in columns.
const COLUMNS: usize = 64;
/// Height of the picture, in lines.
const LINES: usize = 5;
/// Probability of the quantile at each end of the picture.
const TAIL: f64 = 2e-4;
/// Greatest distance of a limit that extends the picture, as a part of its width.
const OUTSIDE: f64 = 0.6;
/// Characters that fill a line by eighths.
const BLOCKS: [char; 9] = [' ', '▁', '▂', '▃', '▄', '▅', '▆', '▇', '█'];
/// Characters that fill a line by thirds.
const PLAIN: [char; 4] = [' ', '.', ':', '#'];

/// Draws the density between its extreme quantiles, extended to limits that are near.
pub(super) fn sketch(law: &Pearson, limits: [Option<f64>; 2], width: usize, unicode: bool) -> Vec<String> {
    let columns = COLUMNS.min(width.saturating_sub(2)).max(1);
    let (from, to) = (law.quantile(TAIL), law.upper_quantile(TAIL));
    let width = to - from;
    let near = |limit: &&f64| **limit > from - OUTSIDE * width && **limit < to + OUTSIDE * width;
    let marks: Vec<f64> = limits.iter().flatten().filter(near).copied().collect();
    // One more column beyond a limit keeps its mark inside the picture.
    let low = marks.iter().fold(from, |low, limit| low.min(limit - width / columns as f64));
    let high = marks.iter().fold(to, |high, limit| high.max(limit + width / columns as f64));
    let step = (high - low) / columns as f64;
    if !(step > 0.0 && step.is_finite()) {
        return Vec::new();
    }
    // Heights are probabilities, because the density may be infinite at an end of the support.
    let below: Vec<[f64; 2]> =
        (0..=columns).map(|column| low + step * column as f64).map(|x| [law.cdf(x), law.sf(x)]).collect();
    let heights: Vec<f64> =
        below.windows(2).map(|edges| (edges[1][0] - edges[0][0]).min(edges[0][1] - edges[1][1]).max(0.0)).collect();
    let highest = heights.iter().copied().fold(0.0, f64::max);
    let column = |x: f64| (((x - low) / step) as usize).min(columns - 1);
    let bars: Vec<usize> = marks.iter().map(|&limit| column(limit)).collect();
    let (levels, bar): (&[char], char) = if unicode { (&BLOCKS, '│') } else { (&PLAIN, '|') };
    let full = levels.len() - 1;
    let row = |line: usize| {
        let cell = |(column, height): (usize, &f64)| {
            let filled = (height / highest * (LINES * full) as f64).round() as usize;
            match filled.saturating_sub(line * full).min(full) {
                0 if bars.contains(&column) => bar,
                level => levels[level],
            }
        };
        format!("  {}", heights.iter().enumerate().map(cell).collect::<String>())
    };
    let mut lines: Vec<String> = (0..LINES).rev().map(row).collect();
    let (rule, cross) = if unicode { ('─', '┴') } else { ('-', '+') };
    let axis: String = (0..columns).map(|column| if bars.contains(&column) { cross } else { rule }).collect();
    lines.extend([format!("  {axis}"), format!("  {}", labels(limits, [low, high], columns, column))]);
    lines
}

/// Draws the histogram of a sample with horizontal bars, each of `together` intervals.
pub(super) fn bars(bins: &Histogram, sigma: f64, together: usize) -> DataTable {
    let groups: Vec<(f64, f64)> = (bins.counts.chunks(together).zip(bins.edges.chunks(together)))
        .map(|(counts, edges)| (edges[0], counts.iter().sum::<u64>() as f64))
        .collect();
    let most = groups.iter().map(|&(_, count)| count).fold(1.0, f64::max);
    let total = bins.counts.iter().sum::<u64>() as f64;
    Columns::default()
        .shown("from", |&(edge, _): &(f64, f64)| Cell::number(edge, |edge| beside(edge, sigma)))
        .shown("%", |&(_, count)| Cell::number(count, |count| format!("{:.2}", 100.0 * count / total)))
        .shown("", |&(_, count)| Cell::text("█".repeat((BAR as f64 * count / most).round() as usize)))
        .table("", groups)
}

/// Writes the limits below their marks. Limits outside the picture stand at its edge with an arrow. Without limits, the ends are written.
fn labels(limits: [Option<f64>; 2], [low, high]: [f64; 2], columns: usize, column: impl Fn(f64) -> usize) -> String {
    let mut line = vec![' '; columns];
    let mut write = |text: &str, start: usize| {
        let start = start.min(columns.saturating_sub(text.chars().count()));
        for (cell, c) in line[start..].iter_mut().zip(text.chars()) {
            *cell = c;
        }
    };
    if limits == [None, None] {
        write(&significant(low, 4), 0);
        write(&significant(high, 4), columns);
    }
    for limit in limits.into_iter().flatten() {
        let text = plain(limit);
        match limit {
            _ if limit < low => write(&format!("< {text}"), 0),
            _ if limit > high => write(&format!("{text} >"), columns),
            _ => write(&text, column(limit).saturating_sub(text.chars().count() / 2)),
        }
    }
    line.into_iter().collect()
}
