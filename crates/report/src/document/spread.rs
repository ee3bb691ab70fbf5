//! Distribution of a value as SVG in a page, whose style sheet has the colours.

use std::fmt::Write;

use crate::document::chart::SpreadChart;
use crate::document::number::{beside, plain, power_of_ten, unsigned_zero};
use crate::document::svg::escaped;
use sensitol::simulation::Histogram;

/// Rejects of a limit beyond which nothing lies.
const NO_REJECTS: &str = "0 ppm";

/// Height of the density, in px.
const TALL: f64 = 150.0;
/// Distance between the density and the labels above, in px.
const ROOM: f64 = 8.0;
/// Height of a row of labels, in px.
const ROW: f64 = 14.0;
/// Height of the numbers at the axis, in px.
const NUMBERS: f64 = 22.0;
/// Height of a range below the axis, in px.
const RANGE: f64 = 18.0;
/// Width of a letter of a label (11.5 px font), in px. It is on the safe side for bold digits of a wide font.
const LETTER: f64 = 8.0;
/// Least distance between two labels, in px.
const APART: f64 = 6.0;
/// Greatest distance of a drawn range from the density, in extents of the density. A farther one would compress the density.
const FAR: f64 = 1.0;

/// Size of one of the two drawings of a figure. Text keeps its size, so the narrow one has fewer labels.
struct Frame {
    class: &'static str,
    width: f64,
    ticks: usize,
    points: usize,
}

/// Sizes of the drawings. A page shows the one that fits.
const FRAMES: [Frame; 2] = [
    Frame { class: "wide", width: 736.0, ticks: 8, points: 180 },
    Frame { class: "narrow", width: 358.0, ticks: 4, points: 110 },
];

/// A horizontal scale.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Extent {
    pub(crate) from: f64,
    pub(crate) to: f64,
    width: f64,
}

impl Extent {
    /// Returns the extent of these values with a margin. Returns None if all are equal.
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

    /// Returns round numbers along the scale, about `most` of them.
    fn ticks(&self, most: usize) -> Vec<Tick> {
        let raw = (self.to - self.from) / most as f64;
        let decade = power_of_ten(libm::log10(raw).floor());
        let step = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * decade).into_iter().find(|&step| step >= raw);
        let step = step.unwrap_or(10.0 * decade);
        let first = (self.from / step).ceil();
        let decimals = (-libm::log10(step).floor()).max(0.0) as usize;
        (0..=2 * most)
            .map(|i| (first + i as f64) * step)
            .take_while(|&value| value <= self.to)
            .map(|value| {
                let label = if decimals > 9 || value.abs() >= 1e9 {
                    plain(value)
                } else {
                    unsigned_zero(format!("{value:.decimals$}"))
                };
                Tick { x: self.at(value), label }
            })
            .collect()
    }
}

struct Tick {
    x: f64,
    label: String,
}

fn total(bins: &Histogram) -> f64 {
    bins.counts.iter().sum::<u64>() as f64
}

/// Returns the density of a bar. Intervals may differ in width, so heights are densities.
fn density(bins: &Histogram, i: usize, count: f64) -> f64 {
    count / total(bins) / (bins.edges[i + 1] - bins.edges[i])
}

/// Returns the standard error of a count, as that of a binomial share.
fn error(bins: &Histogram, count: u64) -> f64 {
    (count as f64 * (1.0 - count as f64 / total(bins))).sqrt()
}

fn densest(bins: &Histogram) -> f64 {
    let tops = bins.counts.iter().enumerate().map(|(i, &count)| density(bins, i, count as f64 + error(bins, count)));
    tops.filter(|density| density.is_finite()).fold(0.0, f64::max)
}

/// Interpolates a tabulated density linearly. Returns 0 beyond the table.
fn between(curve: &[[f64; 2]], x: f64) -> f64 {
    let after = curve.partition_point(|[at, _]| *at < x);
    match (after.checked_sub(1).and_then(|before| curve.get(before)), curve.get(after)) {
        (Some([a, low]), Some([b, high])) => low + (high - low) * (x - a) / (b - a),
        (None, Some([at, density])) if *at == x => *density,
        _ => 0.0,
    }
}

/// Side of a label relative to its place.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Side {
    Before,
    Over,
    After,
}

struct Label {
    class: &'static str,
    text: String,
    left: f64,
    row: usize,
    side: Side,
}

/// Rows of labels without overlap, each label as near to its place as the width allows.
#[derive(Default)]
struct Labels(Vec<Label>);

impl Labels {
    fn put(&mut self, class: &'static str, text: String, (x, side): (f64, Side), width: f64) {
        let wide = LETTER * text.chars().count() as f64;
        let left = match side {
            Side::Before => x - wide - APART,
            Side::Over => x - 0.5 * wide,
            Side::After => x + APART,
        };
        let left = left.min(width - wide).max(0.0);
        // The reserved width fits the widest font. Other fonts leave space around the text.
        let free = |row: usize| {
            self.0.iter().filter(|one| one.row == row).all(|one| {
                let end = one.left + LETTER * one.text.chars().count() as f64;
                left + wide + APART <= one.left || end + APART <= left
            })
        };
        let row = (0..=self.0.len()).find(|&row| free(row)).unwrap_or(0);
        self.0.push(Label { class, text, left, row, side });
    }

    fn rows(&self) -> usize {
        self.0.iter().map(|one| one.row + 1).max().unwrap_or(0)
    }

    fn svg(&self) -> String {
        let text = |one: &Label| {
            let (y, wide) = (ROW * (one.row + 1) as f64 - 3.0, LETTER * one.text.chars().count() as f64);
            let (part, anchor) = match one.side {
                Side::Before => (1.0, " text-anchor=\"end\""),
                Side::Over => (0.5, " text-anchor=\"middle\""),
                Side::After => (0.0, ""),
            };
            let (class, x, text) = (one.class, one.left + part * wide, escaped(&one.text));
            format!("<text class=\"{class}\" x=\"{x:.1}\" y=\"{y}\"{anchor}>{text}</text>\n")
        };
        self.0.iter().map(text).collect()
    }
}

/// Draws a figure with marks at the places within the drawn extent. Returns None if there is neither
/// density nor sample, or if the extent is zero.
pub(super) fn figure(of: &SpreadChart) -> Option<String> {
    let drawn: Option<String> = FRAMES.iter().map(|frame| drawing(of, frame)).collect();
    Some(format!("<figure>\n{}<figcaption>{}</figcaption>\n</figure>\n", drawn?, legend(of)))
}

/// Legend of the lines and areas that are drawn. Limits and ranges carry their names.
fn legend(of: &SpreadChart) -> String {
    let sigma = of.sigma.abs();
    let number = |x: f64| beside(x, if sigma > 0.0 { sigma } else { 1e-3 * x.abs() });
    let mut keys: Vec<(&str, String)> = Vec::new();
    if of.bins.is_some() {
        keys.push(("of-bins", "sample, each bar with one standard error".to_owned()));
    }
    match (&of.law, &of.curve) {
        (Some(_), Some(_)) => {
            keys.extend([("of-curve", of.curve_name.clone()), ("of-fit", of.law_name.clone())]);
        }
        (Some(_), None) => keys.push(("of-curve", of.law_name.clone())),
        (None, Some(_)) => keys.push(("of-curve", of.curve_name.clone())),
        (None, None) => {}
    }
    if of.rejects.iter().flatten().any(|rejected| !is_harmless(rejected)) {
        keys.push(("of-beyond", "beyond a limit".to_owned()));
    }
    let quantiles = of.places.iter().filter(|place| place.1 == "quantile");
    let quantiles: Vec<String> = quantiles.map(|(x, _, name)| format!("{name} {}", number(*x))).collect();
    if !quantiles.is_empty() {
        keys.push(("of-quantile", format!("quantiles: {}", quantiles.join(", "))));
    }
    keys.extend(of.nominal.map(|nominal| ("of-nominal", format!("nominal {}", number(nominal)))));
    let key = |(class, name): &(&str, String)| format!("<li class=\"{class}\">{}</li>", escaped(name));
    format!("<ul class=\"legend\">{}</ul>", keys.iter().map(key).collect::<String>())
}

/// True for rejects that are not known to exist: none, or a bound.
fn is_harmless(rejected: &str) -> bool {
    rejected == NO_REJECTS || rejected.starts_with('<')
}

/// Text of the chart for screen readers.
fn said(of: &SpreadChart) -> String {
    let near = of.sigma.abs();
    let number = |x: f64| if near > 0.0 { beside(x, near) } else { plain(x) };
    let mut parts = vec![of.label.clone()];
    parts.extend(of.places.iter().map(|(x, kind, name)| {
        let kind = if *kind == "quantile" && name.ends_with('%') { " quantile" } else { "" };
        format!("{name}{kind} {}", number(*x))
    }));
    for (limit, name, rejected) in
        [(of.limits[0], "lower limit", &of.rejects[0]), (of.limits[1], "upper limit", &of.rejects[1])]
    {
        let beyond = rejected.as_ref().map(|rejected| format!(" with {rejected} beyond it")).unwrap_or_default();
        parts.extend(limit.map(|limit| format!("{name} {}{beyond}", plain(limit))));
    }
    parts.extend(of.ranges.iter().map(|(name, _, [from, to])| format!("{name} {from} to {to}")));
    parts.join(", ")
}

/// Draws a figure at the width of a frame. None if it has no extent.
fn drawing(of: &SpreadChart, frame: &Frame) -> Option<String> {
    let plot = DensityPlot::new(of, frame)?;
    let labels = plot.labels();
    let drawing = DensityDrawing::new(plot, ROW * labels.rows() as f64 + ROOM);
    let (base, rows) = (drawing.base, drawing.plot.ranges.len());
    let tall = base + NUMBERS + RANGE * rows as f64;
    let mut svg = format!(
        "<svg class=\"density {}\" viewBox=\"0 0 {} {tall}\" role=\"img\" aria-label=\"{}\">\n",
        frame.class,
        frame.width,
        escaped(&said(of))
    );
    let line = (!drawing.points.is_empty()).then(|| drawing.path(&drawing.points));
    drawing.areas(&mut svg, line.as_deref());
    drawing.bars(&mut svg);
    drawing.places(&mut svg);
    drawing.curves(&mut svg, line.as_deref());
    drawing.limits(&mut svg);
    drawing.axis(&mut svg);
    drawing.nominal(&mut svg);
    for (row, (name, [from, to], _)) in drawing.plot.ranges.iter().enumerate() {
        let y = base + NUMBERS + RANGE * (row as f64 + 0.5);
        svg += &range(&drawing.plot.scale, of.limits, (name, [*from, *to]), y);
    }
    svg += &labels.svg();
    Some(svg + "</svg>\n")
}

/// The density, sample and ranges of a chart along the scale of a frame.
struct DensityPlot<'c> {
    of: &'c SpreadChart,
    frame: &'c Frame,
    bins: Option<&'c Histogram>,
    curve: Option<&'c [[f64; 2]]>,
    /// Ends of the density.
    law_ends: Option<[f64; 2]>,
    scale: Extent,
    /// Ranges that are near enough to be drawn.
    ranges: Vec<&'c (String, [f64; 2], [String; 2])>,
    /// The standard deviation or another length by which numbers are rounded.
    unit: f64,
}

impl<'c> DensityPlot<'c> {
    /// Chooses the scale. None if there is no extent.
    fn new(of: &'c SpreadChart, frame: &'c Frame) -> Option<Self> {
        let (law, limits) = (of.law.as_ref(), of.limits);
        let bins = of.bins.as_ref().filter(|bins| bins.counts.len() > 1 && total(bins) > 0.0);
        let curve = of.curve.as_deref().filter(|curve| curve.len() > 1);
        let law_ends = match curve {
            Some([[from, _], .., [to, _]]) => Some([*from, *to]),
            _ => law.map(|law| [law.quantile(1e-4), law.upper_quantile(1e-4)]),
        };
        let of_bins = bins.map(|bins| [bins.edges[0], bins.edges[bins.counts.len()]]);
        let extents = || law_ends.into_iter().chain(of_bins);
        let [low, high] = extents().reduce(|[a, b], [c, d]| [a.min(c), b.max(d)])?;
        let near = |x: &f64| *x - high < FAR * (high - low) && low - *x < FAR * (high - low);
        let ranges: Vec<&(String, [f64; 2], [String; 2])> =
            of.ranges.iter().filter(|range| range.1.iter().all(near)).collect();
        let others = limits.into_iter().flatten().chain(of.nominal).filter(near);
        let ends = [low, high].into_iter().chain(others).chain(ranges.iter().flat_map(|range| range.1));
        let scale = Extent::over(ends, 0.02, frame.width)?;
        let unit = if of.sigma > 0.0 { of.sigma } else { high - low };
        Some(Self { of, frame, bins, curve, law_ends, scale, ranges, unit })
    }

    /// The best density that there is.
    fn best(&self, x: f64) -> f64 {
        match self.curve {
            Some(curve) => between(curve, x),
            None => self.of.law.as_ref().map_or(f64::NAN, |law| law.pdf(x)),
        }
    }

    /// A density at evenly spaced places of the scale.
    fn along(&self, density: impl Fn(f64) -> f64) -> Vec<(f64, f64)> {
        let Extent { from, to, .. } = self.scale;
        let place = |i: usize| from + (to - from) * i as f64 / self.frame.points as f64;
        (0..=self.frame.points).map(|i| (place(i), density(place(i)))).collect()
    }

    /// Returns true for a value on the scale.
    fn marked(&self, x: f64) -> bool {
        x >= self.scale.from && x <= self.scale.to
    }

    /// The labels above the density: limits, rejects and mean.
    fn labels(&self) -> Labels {
        let (of, width) = (self.of, self.frame.width);
        let mut labels = Labels::default();
        for (limit, rejected, name, side, inside) in [
            (of.limits[0], &of.rejects[0], "lower", Side::Before, Side::After),
            (of.limits[1], &of.rejects[1], "upper", Side::After, Side::Before),
        ] {
            let Some(limit) = limit.filter(|limit| self.marked(*limit)) else { continue };
            let x = self.scale.at(limit);
            labels.put("name", format!("{name} {}", plain(limit)), (x, inside), width);
            if let Some(rejected) = rejected {
                // Where there is no room beyond the limit the text stands inside, and says on which side they are.
                let wide = LETTER * rejected.chars().count() as f64 + APART;
                let (text, side) = match (name, x) {
                    ("lower", x) if x < wide => (format!("{rejected} below"), inside),
                    ("upper", x) if x + wide > width => (format!("{rejected} above"), inside),
                    _ => (rejected.clone(), side),
                };
                // Nothing is bad about a limit that rejects nothing.
                let class = if is_harmless(rejected) { "" } else { "rejected" };
                labels.put(class, text, (x, side), width);
            }
        }
        let mean = of.places.iter().find(|place| place.1 == "mean").filter(|place| self.marked(place.0));
        if let Some((x, _, name)) = mean {
            let text = format!("{name} {}", beside(*x, self.unit));
            labels.put("of-mean", text, (self.scale.at(*x), Side::Over), width);
        }
        labels
    }
}

/// A plot with its heights: from `top` down to its axis at `base`.
struct DensityDrawing<'c> {
    plot: DensityPlot<'c>,
    /// The best density along the scale; empty if there is none.
    points: Vec<(f64, f64)>,
    /// The density at the top.
    most: f64,
    top: f64,
    base: f64,
}

impl<'c> DensityDrawing<'c> {
    /// Chooses the vertical scale.
    fn new(plot: DensityPlot<'c>, top: f64) -> Self {
        let known = plot.of.law.is_some() || plot.curve.is_some();
        let points = if known { plot.along(|x| plot.best(x)) } else { Vec::new() };
        // A density that is infinite at its end is cut.
        let finite = points.iter().map(|&(_, density)| density).filter(|density| density.is_finite());
        let usual = plot.law_ends.map_or(f64::INFINITY, |[low, high]| 24.0 / (high - low));
        let most = finite.fold(0.0, f64::max).min(usual).max(plot.bins.map_or(0.0, densest));
        Self { plot, points, most, top, base: top + TALL }
    }

    /// The height of a density above the axis.
    fn height(&self, density: f64) -> f64 {
        (1e2 * TALL * (density / self.most).min(1.0)).round() / 1e2
    }

    /// A line through points of a density.
    fn path(&self, points: &[(f64, f64)]) -> String {
        let mut path = String::new();
        for (i, &(x, density)) in points.iter().enumerate() {
            let y = self.base - self.height(density);
            let _ = write!(path, "{}{:.1} {y:.1}", if i == 0 { "M" } else { "L" }, self.plot.scale.at(x));
        }
        path
    }

    /// The area below the density between two values. None beside a sample, which has its own bars.
    fn area(&self, from: f64, to: f64) -> Option<String> {
        let (plot, base) = (&self.plot, self.base);
        let (from, to) = (from.max(plot.scale.from), to.min(plot.scale.to));
        (from < to && plot.bins.is_none() && !self.points.is_empty()).then(|| {
            let mut inside = vec![(from, plot.best(from))];
            inside.extend(self.points.iter().filter(|(x, _)| *x > from && *x < to));
            inside.push((to, plot.best(to)));
            format!("{}L{:.1} {base}L{:.1} {base}Z", self.path(&inside), plot.scale.at(to), plot.scale.at(from))
        })
    }

    /// Fills the density, and its parts beyond the limits.
    fn areas(&self, svg: &mut String, line: Option<&str>) {
        let (width, base) = (self.plot.frame.width, self.base);
        if let (Some(line), None) = (line, self.plot.bins) {
            let _ = writeln!(svg, "<path class=\"area\" d=\"{line}L{width} {base}L0 {base}Z\"/>");
        }
        let [lower, upper] = self.plot.of.limits;
        let beyond = [
            lower.and_then(|lower| self.area(f64::NEG_INFINITY, lower)),
            upper.and_then(|upper| self.area(upper, f64::INFINITY)),
        ];
        for area in beyond.into_iter().flatten() {
            let _ = writeln!(svg, "<path class=\"beyond\" d=\"{area}\"/>");
        }
    }

    /// Draws the bars of the sample with their standard errors.
    fn bars(&self, svg: &mut String) {
        let Some(bins) = self.plot.bins else { return };
        let (scale, base, [lower, upper]) = (&self.plot.scale, self.base, self.plot.of.limits);
        let outside = |x: f64| lower.is_some_and(|lower| x < lower) || upper.is_some_and(|upper| x > upper);
        for (i, &count) in bins.counts.iter().enumerate() {
            let (x, to) = (scale.at(bins.edges[i]), scale.at(bins.edges[i + 1]));
            let (number, error) = (count as f64, error(bins, count));
            let tall = self.height(density(bins, i, number));
            let [low, high] =
                [-1.0, 1.0].map(|side| base - self.height(density(bins, i, (number + side * error).max(0.0))));
            let class = if outside(0.5 * (bins.edges[i] + bins.edges[i + 1])) { "bin out" } else { "bin" };
            let (y, wide, middle) = (base - tall, (to - x).max(0.1), 0.5 * (x + to));
            let _ = write!(
                svg,
                "<rect class=\"{class}\" x=\"{x:.1}\" y=\"{y:.1}\" width=\"{wide:.1}\" height=\"{tall:.1}\"/>"
            );
            let _ = writeln!(svg, "<path class=\"error\" d=\"M{middle:.1} {low:.1}V{high:.1}\"/>");
        }
    }

    /// Marks the mean and quantiles.
    fn places(&self, svg: &mut String) {
        let Self { plot, top, base, .. } = self;
        for (x, kind, name) in plot.of.places.iter().filter(|place| plot.marked(place.0)) {
            let (at, label) = (plot.scale.at(*x), format!("{name} {}", beside(*x, plot.unit)));
            let _ = writeln!(svg, "<path class=\"{kind}\" d=\"M{at:.1} {top}V{base}\"><title>{label}</title></path>");
        }
    }

    /// Draws the density, and the Pearson law beside a better one.
    fn curves(&self, svg: &mut String, line: Option<&str>) {
        if let Some(law) = self.plot.of.law.as_ref().filter(|_| self.plot.curve.is_some()) {
            let fit = self.path(&self.plot.along(|x| law.pdf(x)));
            let _ = writeln!(svg, "<path class=\"fit\" d=\"{fit}\"><title>Pearson fit</title></path>");
        }
        if let Some(line) = line {
            let _ = writeln!(svg, "<path class=\"line\" d=\"{line}\"/>");
        }
    }

    /// Draws the limits from the top to the foot of the ranges.
    fn limits(&self, svg: &mut String) {
        let plot = &self.plot;
        let [lower, upper] = plot.of.limits;
        let foot = self.base + RANGE * plot.ranges.len() as f64;
        for (limit, name) in [(lower, "lower limit"), (upper, "upper limit")] {
            if let Some(limit) = limit.filter(|limit| plot.marked(*limit)) {
                let (at, label) = (plot.scale.at(limit), format!("{name} {}", plain(limit)));
                let _ = writeln!(
                    svg,
                    "<path class=\"limit\" d=\"M{at:.1} 0V{}\"><title>{label}</title></path>",
                    foot + NUMBERS
                );
            }
        }
    }

    /// Draws the axis with the numbers that have room at it.
    fn axis(&self, svg: &mut String) {
        let (base, frame) = (self.base, self.plot.frame);
        let width = frame.width;
        let _ = writeln!(svg, "<path class=\"base\" d=\"M0 {base}H{width}\"/>");
        let mut end = f64::NEG_INFINITY;
        for Tick { x, label } in self.plot.scale.ticks(frame.ticks) {
            let _ = write!(svg, "<path class=\"base\" d=\"M{x:.1} {base}v5\"/>");
            let half = 0.5 * LETTER * label.chars().count() as f64;
            if x - half < end.max(0.0) || x + half > width {
                continue;
            }
            end = x + half + APART;
            let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{}\" text-anchor=\"middle\">{label}</text>", base + 17.0);
        }
    }

    /// Marks the value at the nominal dimensions.
    fn nominal(&self, svg: &mut String) {
        let plot = &self.plot;
        if let Some(nominal) = plot.of.nominal.filter(|nominal| plot.marked(*nominal)) {
            let at = plot.scale.at(nominal);
            let _ = writeln!(
                svg,
                "<path class=\"nominal\" d=\"M{at:.1} {}l-4 7h8z\"><title>nominal {}</title></path>",
                self.base + 1.0,
                beside(nominal, plot.unit)
            );
        }
    }
}

/// A range as a dimension line, with its name in a gap of the line or beside it; parts beyond a limit stand out.
fn range(scale: &Extent, limits: [Option<f64>; 2], (name, [from, to]): (&str, [f64; 2]), y: f64) -> String {
    let [a, b] = [scale.at(from), scale.at(to)];
    let wide = LETTER * name.chars().count() as f64 + APART;
    let mut svg = String::new();
    let (text, line) = if b - a > wide + 24.0 {
        let middle = 0.5 * (a + b);
        let (before, after) = (middle - 0.5 * wide, middle + 0.5 * wide);
        ((middle, " text-anchor=\"middle\""), format!("M{a:.1} {y}H{before:.1}M{after:.1} {y}H{b:.1}"))
    } else {
        let text = if b + wide < scale.width { b + APART } else { (a - wide).max(0.0) };
        ((text, ""), format!("M{a:.1} {y}H{b:.1}"))
    };
    let _ = writeln!(svg, "<path class=\"range\" d=\"{line}M{a:.1} {}v8M{b:.1} {}v8\"/>", y - 4.0, y - 4.0);
    let [lower, upper] = limits.map(|limit| limit.map(|limit| scale.at(limit)));
    // Least visible length, in px: shorter parts are rounding.
    const SEEN: f64 = 0.5;
    for [from, to] in [lower.map(|lower| [a, b.min(lower)]), upper.map(|upper| [a.max(upper), b])].into_iter().flatten()
    {
        if to - from > SEEN {
            let _ = writeln!(svg, "<path class=\"over\" d=\"M{from:.1} {y}H{to:.1}\"/>");
        }
    }
    let (x, anchor) = text;
    let _ = writeln!(svg, "<text x=\"{x:.1}\" y=\"{:.1}\"{anchor}>{}</text>", y + 4.0, escaped(name));
    svg
}
