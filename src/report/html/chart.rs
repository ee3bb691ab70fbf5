//! Drawings as numbers: what the templates put into SVG.

use std::fmt::Write;

use serde::Serialize;

use super::super::number::{beside, plain, unsigned_zero};
use crate::pearson::Pearson;

/// Units of the drawing; the page scales it to its own width.
pub(super) const WIDTH: f64 = 640.0;
/// Below the axis there is room for its numbers.
const BASE: f64 = 180.0;
const POINTS: usize = 240;
const TICKS: usize = 6;

/// A horizontal scale.
#[derive(Debug, Clone, Copy)]
pub(super) struct Scale {
    pub(super) from: f64,
    pub(super) to: f64,
    width: f64,
}

impl Scale {
    /// Over all of these with a margin; None where there is no extent.
    pub(super) fn over(values: impl Iterator<Item = f64>, margin: f64, width: f64) -> Option<Self> {
        let (least, most) = values
            .filter(|value| value.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), value| (least.min(value), most.max(value)));
        let extent = most - least;
        (extent > 0.0 && extent.is_finite()).then_some(Self {
            from: least - margin * extent,
            to: most + margin * extent,
            width,
        })
    }

    pub(super) fn at(&self, value: f64) -> f64 {
        let share = (value - self.from) / (self.to - self.from);
        (1e3 * self.width * share).round() / 1e3
    }

    /// Round numbers along it.
    pub(super) fn ticks(&self) -> Vec<Tick> {
        let raw = (self.to - self.from) / TICKS as f64;
        let decade = 10f64.powf(raw.log10().floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade).into_iter().find(|&step| step >= raw);
        let step = step.unwrap_or(10.0 * decade);
        let first = (self.from / step).ceil();
        let decimals = (-step.log10().floor()).max(0.0) as usize;
        (0..=2 * TICKS)
            .map(|i| (i, (first + i as f64) * step))
            .take_while(|&(_, value)| value <= self.to)
            .map(|(i, value)| {
                let label = if decimals > 9 || value.abs() >= 1e9 {
                    plain(value)
                } else {
                    unsigned_zero(format!("{value:.decimals$}"))
                };
                Tick { x: self.at(value), label, odd: i % 2 == 1 }
            })
            .collect()
    }
}

/// A number at the axis.
#[derive(Debug, Serialize)]
pub(super) struct Tick {
    x: f64,
    label: String,
    /// Left out where the page is narrow.
    odd: bool,
}

/// A vertical line.
#[derive(Debug, Serialize)]
pub(super) struct Mark {
    pub(super) x: f64,
    /// `limit`, `mean` or `quantile`.
    pub(super) kind: &'static str,
    pub(super) label: String,
}

/// A bar of a histogram with the standard error of its height.
#[derive(Debug, Serialize)]
struct Bar {
    x: f64,
    width: f64,
    y: f64,
    height: f64,
    middle: f64,
    error: [f64; 2],
    /// Outside the limits.
    beyond: bool,
}

/// A sample in intervals: their edges, ascending, and the counts between them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Bins<'b> {
    pub(super) edges: &'b [f64],
    pub(super) counts: &'b [u64],
}

/// How values are distributed: a density, a histogram, or one over the other.
#[derive(Debug, Serialize)]
pub(super) struct Spread {
    line: Option<String>,
    /// Areas beyond the limits.
    beyond: Vec<String>,
    bars: Vec<Bar>,
    marks: Vec<Mark>,
    ticks: Vec<Tick>,
}

impl Bins<'_> {
    fn total(&self) -> f64 {
        self.counts.iter().sum::<u64>() as f64
    }

    /// Bins may differ in width: heights are densities.
    fn density(&self, i: usize, count: f64) -> f64 {
        count / self.total() / (self.edges[i + 1] - self.edges[i])
    }

    /// Of a count, as that of a binomial share.
    fn error(&self, count: u64) -> f64 {
        (count as f64 * (1.0 - count as f64 / self.total())).sqrt()
    }

    fn densest(&self) -> f64 {
        let tops = self.counts.iter().enumerate().map(|(i, &count)| self.density(i, count as f64 + self.error(count)));
        tops.filter(|density| density.is_finite()).fold(0.0, f64::max)
    }
}

/// Places that the law itself names.
pub(super) fn quantiles(law: &Pearson) -> Vec<(f64, &'static str, &'static str)> {
    vec![
        (law.quantile(0.00135), "quantile", "0.135 % quantile"),
        (law.quantile(0.5), "quantile", "median"),
        (law.upper_quantile(0.00135), "quantile", "99.865 % quantile"),
    ]
}

impl Spread {
    /// None where there is neither law nor sample, or no extent. `places` are marked where they lie within what is drawn.
    pub(super) fn of(
        law: Option<&Pearson>,
        bins: Option<Bins<'_>>,
        limits: [Option<f64>; 2],
        places: &[(f64, &'static str, &str)],
    ) -> Option<Self> {
        let bins = bins.filter(|bins| bins.counts.len() > 1 && bins.total() > 0.0);
        let of_law = law.map(|law| [law.quantile(1e-4), law.upper_quantile(1e-4)]);
        let of_bins = bins.map(|bins| [bins.edges[0], bins.edges[bins.counts.len()]]);
        let extents = || of_law.into_iter().chain(of_bins);
        let [low, high] = extents().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
        let near = limits.into_iter().flatten().filter(|x| x - high < high - low && low - x < high - low);
        let scale = Scale::over([low, high].into_iter().chain(near), 0.04, WIDTH)?;
        let place = |i: usize| scale.from + (scale.to - scale.from) * i as f64 / POINTS as f64;
        let points: Vec<(f64, f64)> =
            law.map_or(Vec::new(), |law| (0..=POINTS).map(|i| (place(i), law.pdf(place(i)))).collect());
        // A density that is infinite at its end is cut.
        let finite = points.iter().map(|&(_, density)| density).filter(|density| density.is_finite());
        let usual = of_law.map_or(f64::INFINITY, |[low, high]| 24.0 / (high - low));
        let most = finite.fold(0.0, f64::max).min(usual).max(bins.map_or(0.0, |bins| bins.densest()));
        let height = |density: f64| (1e3 * (BASE - 12.0) * (density / most).min(1.0)).round() / 1e3;
        let path = |points: &[(f64, f64)]| {
            let mut path = String::new();
            for (i, &(x, density)) in points.iter().enumerate() {
                let y = BASE - height(density);
                let _ = write!(path, "{}{:.2} {y:.2}", if i == 0 { "M" } else { "L" }, scale.at(x));
            }
            path
        };
        let area = |from: f64, to: f64| {
            let (law, from, to) = (law.filter(|_| bins.is_none())?, from.max(scale.from), to.min(scale.to));
            (from < to).then(|| {
                let mut inside = vec![(from, law.pdf(from))];
                inside.extend(points.iter().filter(|(x, _)| *x > from && *x < to));
                inside.push((to, law.pdf(to)));
                format!("{}L{:.2} {BASE}L{:.2} {BASE}Z", path(&inside), scale.at(to), scale.at(from))
            })
        };
        let [lower, upper] = limits;
        let beyond = [
            lower.and_then(|lower| area(f64::NEG_INFINITY, lower)),
            upper.and_then(|upper| area(upper, f64::INFINITY)),
        ];
        let bar = |bins: Bins<'_>, i: usize| {
            let (x, to) = (scale.at(bins.edges[i]), scale.at(bins.edges[i + 1]));
            let (count, error) = (bins.counts[i] as f64, bins.error(bins.counts[i]));
            let tall = height(bins.density(i, count));
            let ends = [-1.0, 1.0].map(|side| bins.density(i, (count + side * error).max(0.0)));
            let middle = 0.5 * (bins.edges[i] + bins.edges[i + 1]);
            Bar {
                x,
                width: (to - x).max(0.1),
                y: BASE - tall,
                height: tall,
                middle: 0.5 * (x + to),
                error: ends.map(|end| BASE - height(end)),
                beyond: lower.is_some_and(|lower| middle < lower) || upper.is_some_and(|upper| middle > upper),
            }
        };
        let of_limits = [(lower, "lower limit"), (upper, "upper limit")];
        let of_limits = of_limits.into_iter().filter_map(|(limit, name)| Some((limit?, "limit", name)));
        let marks = places.iter().copied().chain(of_limits).filter(|mark| mark.0 >= scale.from && mark.0 <= scale.to);
        Some(Self {
            line: law.map(|_| path(&points)),
            beyond: beyond.into_iter().flatten().collect(),
            bars: bins.map_or(Vec::new(), |bins| (0..bins.counts.len()).map(|i| bar(bins, i)).collect()),
            marks: marks
                .map(|(x, kind, name)| {
                    let label = format!("{name} {}", beside(x, 0.1 * (high - low)));
                    Mark { x: scale.at(x), kind, label }
                })
                .collect(),
            ticks: scale.ticks(),
        })
    }
}

/// An interval on a scale that it shares with others, 0 to 100.
#[derive(Debug, Serialize)]
pub(super) struct Span {
    pub(super) name: String,
    pub(super) x: f64,
    pub(super) width: f64,
    pub(super) from: String,
    pub(super) to: String,
    /// Whether it lies within the limits; null where that is unknown.
    pub(super) kept: Option<bool>,
}
