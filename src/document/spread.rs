//! How a value is distributed, as SVG in a page: its style sheet has the colours.

use std::fmt::Write;

use super::chart::SpreadChart;
use super::number::{beside, plain, unsigned_zero};
use super::svg::escaped;
use crate::simulation::Histogram;

/// Units of the drawing; the page scales it to its own width.
const WIDTH: f64 = 640.0;
/// Below the axis there is room for its numbers.
const BASE: f64 = 180.0;
const POINTS: usize = 240;
const TICKS: usize = 6;

/// A horizontal scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) from: f64,
    pub(crate) to: f64,
    width: f64,
}

impl Extent {
    /// Over all of these with a margin; None where there is no extent.
    pub(crate) fn over(values: impl Iterator<Item = f64>, margin: f64, width: f64) -> Option<Self> {
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

    pub(crate) fn at(&self, value: f64) -> f64 {
        let share = (value - self.from) / (self.to - self.from);
        (1e3 * self.width * share).round() / 1e3
    }

    /// Round numbers along it.
    fn ticks(&self) -> Vec<Tick> {
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
struct Tick {
    x: f64,
    label: String,
    /// Left out where the page is narrow.
    odd: bool,
}

fn total(bins: &Histogram) -> f64 {
    bins.counts.iter().sum::<u64>() as f64
}

/// Intervals may differ in width: heights are densities.
fn density(bins: &Histogram, i: usize, count: f64) -> f64 {
    count / total(bins) / (bins.edges[i + 1] - bins.edges[i])
}

/// The standard error of a count, as that of a binomial share.
fn error(bins: &Histogram, count: u64) -> f64 {
    (count as f64 * (1.0 - count as f64 / total(bins))).sqrt()
}

fn densest(bins: &Histogram) -> f64 {
    let tops = bins.counts.iter().enumerate().map(|(i, &count)| density(bins, i, count as f64 + error(bins, count)));
    tops.filter(|density| density.is_finite()).fold(0.0, f64::max)
}

/// A tabulated density, a line from place to place; 0 beyond the table.
fn between(curve: &[[f64; 2]], x: f64) -> f64 {
    let after = curve.partition_point(|[at, _]| *at < x);
    match (after.checked_sub(1).and_then(|before| curve.get(before)), curve.get(after)) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * (x - a) / (b - a),
        (None, Some([at, density])) if *at == x => *density,
        _ => 0.0,
    }
}

/// A figure; nothing where there is neither density nor sample, or no extent. Places are marked where they lie within what is drawn.
pub(super) fn figure(of: &SpreadChart) -> Option<String> {
    let (law, limits) = (of.law.as_ref(), of.limits);
    let bins = of.bins.as_ref().filter(|bins| bins.counts.len() > 1 && total(bins) > 0.0);
    let curve = of.curve.as_deref().filter(|curve| curve.len() > 1);
    let of_law = match curve {
        Some([[from, _], .., [to, _]]) => Some([*from, *to]),
        _ => law.map(|law| [law.quantile(1e-4), law.upper_quantile(1e-4)]),
    };
    let of_bins = bins.map(|bins| [bins.edges[0], bins.edges[bins.counts.len()]]);
    let extents = || of_law.into_iter().chain(of_bins);
    let [low, high] = extents().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
    let near = limits.into_iter().flatten().filter(|x| x - high < high - low && low - x < high - low);
    let scale = Extent::over([low, high].into_iter().chain(near), 0.04, WIDTH)?;
    let place = |i: usize| scale.from + (scale.to - scale.from) * i as f64 / POINTS as f64;
    let along =
        |of: &dyn Fn(f64) -> f64| -> Vec<(f64, f64)> { (0..=POINTS).map(|i| (place(i), of(place(i)))).collect() };
    // The best density that there is, and the Pearson law beside a better one.
    let best = |x: f64| match curve {
        Some(curve) => between(curve, x),
        None => law.map_or(f64::NAN, |law| law.pdf(x)),
    };
    let points = if law.is_some() || curve.is_some() { along(&best) } else { Vec::new() };
    let fit = law.filter(|_| curve.is_some()).map(|law| along(&|x| law.pdf(x)));
    // A density that is infinite at its end is cut.
    let finite = points.iter().map(|&(_, density)| density).filter(|density| density.is_finite());
    let usual = of_law.map_or(f64::INFINITY, |[low, high]| 24.0 / (high - low));
    let most = finite.fold(0.0, f64::max).min(usual).max(bins.map_or(0.0, densest));
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
        let (from, to) = (from.max(scale.from), to.min(scale.to));
        (from < to && bins.is_none() && !points.is_empty()).then(|| {
            let mut inside = vec![(from, best(from))];
            inside.extend(points.iter().filter(|(x, _)| *x > from && *x < to));
            inside.push((to, best(to)));
            format!("{}L{:.2} {BASE}L{:.2} {BASE}Z", path(&inside), scale.at(to), scale.at(from))
        })
    };
    let mut svg = format!(
        "<figure>\n<svg class=\"density\" viewBox=\"0 0 {WIDTH} 200\" role=\"img\" aria-label=\"{}\">\n",
        escaped(&of.label)
    );
    let line = (!points.is_empty()).then(|| path(&points));
    if let (Some(line), None) = (&line, bins) {
        let _ = writeln!(svg, "<path class=\"area\" d=\"{line}L{WIDTH} {BASE}L0 {BASE}Z\"/>");
    }
    let [lower, upper] = limits;
    let beyond =
        [lower.and_then(|lower| area(f64::NEG_INFINITY, lower)), upper.and_then(|upper| area(upper, f64::INFINITY))];
    for area in beyond.into_iter().flatten() {
        let _ = writeln!(svg, "<path class=\"beyond\" d=\"{area}\"/>");
    }
    let outside = |x: f64| lower.is_some_and(|lower| x < lower) || upper.is_some_and(|upper| x > upper);
    for (bins, (i, &count)) in bins.iter().flat_map(|bins| bins.counts.iter().enumerate().map(move |bar| (bins, bar))) {
        let (x, to) = (scale.at(bins.edges[i]), scale.at(bins.edges[i + 1]));
        let (number, error) = (count as f64, error(bins, count));
        let tall = height(density(bins, i, number));
        let [low, high] = [-1.0, 1.0].map(|side| BASE - height(density(bins, i, (number + side * error).max(0.0))));
        let class = if outside(0.5 * (bins.edges[i] + bins.edges[i + 1])) { "bin out" } else { "bin" };
        let (y, wide, middle) = (BASE - tall, (to - x).max(0.1), 0.5 * (x + to));
        let _ = write!(svg, "<rect class=\"{class}\" x=\"{x}\" y=\"{y}\" width=\"{wide}\" height=\"{tall}\"/>");
        let _ = writeln!(svg, "<path class=\"error\" d=\"M{middle} {low}V{high}\"/>");
    }
    let of_limits = [(lower, "lower limit"), (upper, "upper limit")];
    let of_limits = of_limits.into_iter().filter_map(|(limit, name)| Some((limit?, "limit", name)));
    let marks = of.places.iter().copied().chain(of_limits).filter(|mark| mark.0 >= scale.from && mark.0 <= scale.to);
    let mut legend = String::new();
    for (x, kind, name) in marks {
        let (at, label) = (scale.at(x), format!("{name} {}", beside(x, 0.1 * (high - low))));
        let _ = writeln!(svg, "<path class=\"{kind}\" d=\"M{at} 8V{BASE}\"><title>{label}</title></path>");
        let _ = writeln!(legend, "<li class=\"{kind}\">{label}</li>");
    }
    if let Some(fit) = &fit {
        let _ = writeln!(svg, "<path class=\"fit\" d=\"{}\"><title>Pearson fit</title></path>", path(fit));
    }
    if let Some(line) = &line {
        let _ = writeln!(svg, "<path class=\"line\" d=\"{line}\"/>");
    }
    let _ = writeln!(svg, "<path class=\"axis\" d=\"M0 {BASE}H{WIDTH}\"/>");
    for Tick { x, label, odd } in scale.ticks() {
        let class = if odd { " class=\"odd\"" } else { "" };
        let _ = write!(svg, "<path class=\"axis\" d=\"M{x} {BASE}v4\"/>");
        let _ = writeln!(svg, "<text x=\"{x}\" y=\"197\" text-anchor=\"middle\"{class}>{label}</text>");
    }
    let words = escaped(&of.words);
    Some(format!("{svg}</svg>\n<figcaption>{words} <ul class=\"legend\">\n{legend}</ul></figcaption>\n</figure>\n"))
}
