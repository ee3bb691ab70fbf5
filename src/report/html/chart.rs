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

/// A density with what lies beyond its limits.
#[derive(Debug, Serialize)]
pub(super) struct Density {
    from: f64,
    to: f64,
    line: String,
    /// Areas beyond the limits.
    beyond: Vec<String>,
    marks: Vec<Mark>,
    ticks: Vec<Tick>,
}

impl Density {
    pub(super) fn of(law: &Pearson, limits: [Option<f64>; 2]) -> Option<Self> {
        let (mean, sigma) = (law.mean(), law.sigma());
        let [low, high] = [law.quantile(1e-4), law.upper_quantile(1e-4)];
        let shown = limits.into_iter().flatten().filter(|limit| (limit - mean).abs() < 12.0 * sigma);
        let scale = Scale::over([low, high].into_iter().chain(shown), 0.04, WIDTH)?;
        let place = |i: usize| scale.from + (scale.to - scale.from) * i as f64 / POINTS as f64;
        let points: Vec<(f64, f64)> = (0..=POINTS).map(|i| (place(i), law.pdf(place(i)))).collect();
        // A density that is infinite at its end is cut.
        let finite = || points.iter().map(|&(_, density)| density).filter(|density| density.is_finite());
        let usual = 3.0 / (high - low);
        let most = finite().fold(0.0, f64::max).min(8.0 * usual);
        let height = |density: f64| BASE - (BASE - 12.0) * (density / most).min(1.0);
        let path = |points: &[(f64, f64)]| {
            let mut path = String::new();
            for (i, &(x, density)) in points.iter().enumerate() {
                let _ = write!(path, "{}{:.2} {:.2}", if i == 0 { "M" } else { "L" }, scale.at(x), height(density));
            }
            path
        };
        let area = |from: f64, to: f64| {
            let (from, to) = (from.max(scale.from), to.min(scale.to));
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
        let inside = |x: f64| x >= scale.from && x <= scale.to;
        let mark = |x: f64, kind: &'static str, name: &str| {
            inside(x).then(|| Mark { x: scale.at(x), kind, label: format!("{name} {}", beside(x, sigma)) })
        };
        let marks = [
            mark(law.quantile(0.00135), "quantile", "0.135 % quantile"),
            mark(law.quantile(0.5), "quantile", "median"),
            mark(law.upper_quantile(0.00135), "quantile", "99.865 % quantile"),
            mark(mean, "mean", "mean"),
            lower.and_then(|lower| mark(lower, "limit", "lower limit")),
            upper.and_then(|upper| mark(upper, "limit", "upper limit")),
        ];
        Some(Self {
            from: scale.from,
            to: scale.to,
            line: path(&points),
            beyond: beyond.into_iter().flatten().collect(),
            marks: marks.into_iter().flatten().collect(),
            ticks: scale.ticks(),
        })
    }
}

/// A bar of a histogram with the standard error of its height.
#[derive(Debug, Serialize)]
pub(super) struct Bar {
    x: f64,
    width: f64,
    y: f64,
    height: f64,
    middle: f64,
    error: [f64; 2],
}

/// A histogram with what marks its limits.
#[derive(Debug, Serialize)]
pub(super) struct Bars {
    bars: Vec<Bar>,
    marks: Vec<Mark>,
    ticks: Vec<Tick>,
}

impl Bars {
    /// Bins of one width; the error of a count is that of a binomial share.
    pub(super) fn of(edges: &[f64], counts: &[u64], marks: &[(f64, &'static str, &str)]) -> Option<Self> {
        let total = counts.iter().sum::<u64>() as f64;
        let ends = [*edges.first()?, *edges.last()?];
        let extent = ends[1] - ends[0];
        let near = marks.iter().map(|mark| mark.0).filter(|x| (x - ends[0]).abs().min((x - ends[1]).abs()) < extent);
        let scale = Scale::over(ends.into_iter().chain(near), 0.03, WIDTH)?;
        // Bins may differ in width: heights are densities.
        let density = |i: usize, count: f64| count / (edges[i + 1] - edges[i]);
        let error = |count: u64| (count as f64 * (1.0 - count as f64 / total)).sqrt();
        let most = counts
            .iter()
            .enumerate()
            .map(|(i, &count)| density(i, count as f64 + error(count)))
            .filter(|density| density.is_finite())
            .fold(0.0, f64::max);
        let height = |density: f64| ((1e3 * (BASE - 12.0) * (density / most).min(1.0)).round()) / 1e3;
        let bars = counts.iter().enumerate().map(|(i, &count)| {
            let (x, to) = (scale.at(edges[i]), scale.at(edges[i + 1]));
            let tall = height(density(i, count as f64));
            let ends = [-1.0, 1.0].map(|side| density(i, (count as f64 + side * error(count)).max(0.0)));
            Bar {
                x,
                width: (to - x).max(0.1),
                y: BASE - tall,
                height: tall,
                middle: 0.5 * (x + to),
                error: ends.map(|end| BASE - height(end)),
            }
        });
        let inside = |x: f64| x >= scale.from && x <= scale.to;
        Some(Self {
            bars: bars.collect(),
            marks: (marks.iter().filter(|mark| inside(mark.0)))
                .map(|&(x, kind, name)| Mark {
                    x: scale.at(x),
                    kind,
                    label: format!("{name} {}", beside(x, 0.1 * extent)),
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
